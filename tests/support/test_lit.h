// SPDX-License-Identifier: MIT
// Scenes made ready for the path tracer, and its irradiance at points and over whole surfaces.
#ifndef TEST_LIT_H
#define TEST_LIT_H

#include "test_support.h"

#include "transport/paths/reference.h"

/// A scene with what the path tracer needs of it.
typedef struct test_lit {
    alp_scene *scene;
    alpi_tracer *tracer;
    alpi_lighting *lighting;
} test_lit;

/// Takes the scene over. `options` may be NULL: the scene's own light alone.
test_lit test_lit_open(alp_scene *scene, const alp_lighting_options *options);
void test_lit_close(test_lit *lit);

/// Gives the scene these lights in place of its own; it must not be lit yet.
void test_lit_set_lamps(alp_scene *scene, const alpi_light *lights, uint32_t count);

/// With next-event estimation, seed 1.
alpi_reference test_lit_reference(const test_lit *lit, uint32_t bounces, uint32_t samples);

enum { TEST_LIT_POINT_LIMIT = 4096 };
/// Irradiance at points, each with its normal, which start `offset` metres above.
void test_lit_irradiance(const alpi_reference *reference, const vec3 *positions,
                         const vec3 *normals, float offset, uint32_t count,
                         alpi_reference_value *values);
alpi_reference_value test_lit_point(const alpi_reference *reference, vec3 position, vec3 normal);

/// The area mean of irradiance over a surface (ALPI_NONE: over all): one receiver, whose points are
/// drawn evenly from it, so that nothing is lost between points.
alpi_reference_value test_lit_mean(const alpi_reference *reference, uint32_t surface);

/// `count` points drawn evenly from the scene's triangles, as far as they lie in the box from low
/// to high, with the normals of those.
void test_lit_scatter(const alp_scene *scene, vec3 low, vec3 high, uint32_t count, vec3 *positions,
                      vec3 *normals);

#endif
