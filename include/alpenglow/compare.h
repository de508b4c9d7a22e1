// SPDX-License-Identifier: MIT
// Comparison of the maps of two baked assets on the surface that they share.
#ifndef ALPENGLOW_COMPARE_H
#define ALPENGLOW_COMPARE_H

#include <alpenglow/lightmap.h>
#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

typedef struct alp_map_compare_options {
    size_t struct_size;
    /// ALP_MAP_AO or ALP_MAP_LIGHT. 0 (default): AO if both assets have it, else LIGHT.
    alp_map map;
    uint32_t points; ///< points compared, [1, 2^24]; default 2^18
    double scale;    ///< s: values of the first asset are multiplied by it, ±1e30; default 1
} alp_map_compare_options;
ALP_API alp_map_compare_options alp_map_compare_options_default(void);

/// Differences over the points that have the map in both assets. Fields from rmse to p99 are
/// defined as in alp_image_difference.
typedef struct alp_map_difference {
    alp_map map; ///< the map that was compared
    /// Whether overlapping charts are blended anywhere in the asset.
    bool blended_first, blended_second;
    uint64_t points, only_first, only_second;
    double rmse, relative_rmse, bias, mean_first, mean_second, p99;
    double maximum;            ///< largest |s·a − b|
    uint32_t maximum_surface;  ///< its surface in the first scene; UINT32_MAX without any point
    float maximum_position[3]; ///< its position in the first scene, metres
} alp_map_difference;

/// Compares the maps of two scenes of the same triangles, at points of equal area. The first scene
/// and `points` alone decide the positions of the points.
///
/// Maps are read bilinearly, as a viewer reads them. The three values of overlapping charts are
/// blended by the squares of the unit normal's components. AO is the occlusion texture of each
/// material. LIGHT is MOZ_lightmap or the file of extras.lightmap, times its intensity; else the
/// emission from the front of materials with an emission texture. Units are those of the file.
///
/// Triangles match if they are listed in the same order, with corners no further apart than 1e-6 of
/// the size of the scene. In any order, they match if their corners are exactly equal. Triangles
/// without area are left out.
/// @param a, b scenes of one context
/// @return ALP_OK; INVALID_ARGUMENT; INVALID_DATA (other triangles, no such map, a NaN or infinity:
///         named); UNSUPPORTED (light in a KTX2 other than RGBA16F); IO; OUT_OF_MEMORY
/// Cost: one pass over the triangles, at most 16 bytes for each, and up to three reads a point.
ALP_API ALP_NODISCARD alp_result alp_scene_compare_maps(const alp_scene *a, const alp_scene *b,
                                                        const alp_map_compare_options *options,
                                                        alp_map_difference *difference);

ALP_END_DECLS

#endif
