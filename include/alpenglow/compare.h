// SPDX-License-Identifier: MIT
// How the maps of two baked assets differ, on the surface that they share.
#ifndef ALPENGLOW_COMPARE_H
#define ALPENGLOW_COMPARE_H

#include <alpenglow/lightmap.h>
#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

typedef struct alp_map_compare_options {
    size_t struct_size;
    alp_map map; ///< ALP_MAP_AO or ALP_MAP_LIGHT; 0 (default): AO where both have it, else LIGHT
    uint32_t points; ///< places looked at, [1, 2^24]; default 2^18
    double scale;    ///< values of the first are multiplied by it, ±1e30; default 1
} alp_map_compare_options;
ALP_API alp_map_compare_options alp_map_compare_options_default(void);

/// Figures over the points that have the map in both; relative_rmse to p99 as in
/// alp_image_difference.
typedef struct alp_map_difference {
    alp_map map;                        ///< that was compared
    bool blended_first, blended_second; ///< whether charts that overlap are blended in it, anywhere
    uint64_t points, only_first, only_second;
    double rmse, relative_rmse, bias, mean_first, mean_second, p99;
    double maximum;            ///< largest |s·a − b|
    uint32_t maximum_surface;  ///< where: surface of the first scene, UINT32_MAX without any point
    float maximum_position[3]; ///< metres
} alp_map_difference;

/// Reads the maps of two scenes of the same triangles as a viewer does, bilinear, the three values
/// of overlapping charts blended by the squares of the unit normal's components, at points that
/// stand for equal areas; where they lie depends on the first scene and `points` alone.
///
/// AO is what the occlusion textures of materials say. LIGHT is MOZ_lightmap or the file of
/// extras.lightmap, times its intensity, else what a material with an emission texture emits from
/// its front, each in the units that the file has it in.
///
/// Triangles are the same where they are listed in the same order with corners as far apart as
/// rounding puts them, 1e-6 of the size of the scene; or, in any order, with the very same corners.
/// Those without area are left out.
/// @param a, b of one context
/// @return ALP_OK; INVALID_ARGUMENT; INVALID_DATA (other triangles, no such map, a NaN or infinity:
///         named); UNSUPPORTED (light in a KTX2); IO; OUT_OF_MEMORY
/// Cost: a look at each triangle, 16 bytes of memory for each at most, and up to three look-ups a
/// point.
ALP_API ALP_NODISCARD alp_result alp_scene_compare_maps(const alp_scene *a, const alp_scene *b,
                                                        const alp_map_compare_options *options,
                                                        alp_map_difference *difference);

ALP_END_DECLS

#endif
