// SPDX-License-Identifier: MIT
// Surfels by rays through a scene: reflective shadow maps of lamps, light of emissive surfaces,
// views of a camera, and points spread over surfaces.
#ifndef ALPI_FIELDS_LPV_MAPS_H
#define ALPI_FIELDS_LPV_MAPS_H

#include "base/vec.h"
#include "scene/lights/lighting.h"
#include "trace/trace.h"

#include <alpenglow/lpv.h>

/// Owned arrays of surfels; elements that rays did not fill have no flux and no area.
typedef struct alpi_surfels {
    uint32_t count;
    float (*positions)[3], (*normals)[3], (*flux)[3], (*albedo)[3];
    float *areas, *radii;
} alpi_surfels;
/// @return ALP_OK; OUT_OF_MEMORY: nothing is left allocated
alp_result alpi_surfels_create(alp_context *context, uint32_t count, alpi_surfels *surfels);
void alpi_surfels_destroy(alp_context *context, alpi_surfels *surfels);
alp_lpv_surfels alpi_surfels_view(const alpi_surfels *surfels);

/// The scene that maps are traced in.
typedef struct alpi_map_scene {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    const float *radii; // [surface_count] metres, of the object that each surface belongs to
    uint64_t seed;
} alpi_map_scene;

/// Radii of bounding spheres, by surface. Surfaces of one node are one object.
alp_result alpi_find_object_radii(const alp_scene *scene, float **radii);

/// A map: texel (x, y) of size × size sees along one ray. Either all rays go along `axis` from a
/// rectangle, or they leave from one point. `right` and `up` reach from the centre to the edges.
typedef struct alpi_map_view {
    bool parallel;
    vec3 origin;          // centre of the rectangle, or the eye
    vec3 axis, right, up; // axis unit; of a point, right and up are tangents of the half-angles
    uint32_t size;
    uint32_t shift[2]; // added to x, y: the number of a texel that names its place in the world
} alpi_map_view;

/// A map of parallel light over a box of the world, its texels fixed to whole steps.
/// @param travel unit: the way of the light
alpi_map_view alpi_sun_view(const alp_scene *scene, vec3 travel, const double low[3],
                            const double high[3], uint32_t size);
/// Face 0 to 5 of a cube: +x, −x, +y, −y, +z, −z.
alpi_map_view alpi_cube_view(vec3 eye, uint32_t face, uint32_t size);
/// A square view along an axis. @param half radians, below π/2
alpi_map_view alpi_cone_view(vec3 eye, vec3 axis, float half, uint32_t size);
/// The view of a camera. @param aspect width / height
/// @return ALP_OK; INVALID_ARGUMENT: no place, no direction or no angle to look at, or no aspect
alp_result alpi_camera_map_view(alp_context *context, const alp_camera *camera, float aspect,
                                uint32_t size, alpi_map_view *view);

/// Traces a map into surfels [first, first + size²).
/// @param light index in `lighting` whose first reflection is the flux; ALPI_NONE: no flux
alp_result alpi_trace_view(const alpi_map_scene *in, const alpi_map_view *view,
                           const alpi_lighting *lighting, uint32_t light, uint32_t first,
                           alpi_surfels *surfels);

/// Points on emissive surfaces with the flux that they emit, in [0, count / 2), and what the first
/// surfaces that this light meets reflect of it, in [count / 2, count).
/// @return ALP_OK, with *found = whether anything emits; OUT_OF_MEMORY
alp_result alpi_trace_emitters(const alpi_map_scene *in, alpi_surfels *surfels, bool *found);

/// Points spread over all surfaces by area, with both sides of surfaces that are double-sided.
alp_result alpi_spread_points(const alpi_map_scene *in, alpi_surfels *surfels);

#endif
