// SPDX-License-Identifier: MIT
// The path tracer gives the same bits for any number of workers, and the same whatever else is in
// the list.
#include "test_support.h"

#include "transport/paths/reference.h"

enum { POINTS = 128 }; // of 112 paths: four ranges of 36
static float positions[POINTS][3], normals[POINTS][3], offsets[POINTS];

static void gather(const alp_scene *scene, const alpi_tracer *tracer, uint32_t workers,
                   const uint32_t *list, uint32_t list_count, alpi_reference_value *values)
{
    alp_context *context = test_context(workers);
    const alp_lighting_options options = alp_lighting_options_default();
    alpi_lighting *lighting = NULL;
    ASSERT_OK(context, alpi_lighting_create(scene, &options, &lighting));
    const alpi_point_array array = {.count = POINTS,
                                    .positions = positions,
                                    .geometric_normals = normals,
                                    .shading_normals = normals,
                                    .offsets = offsets};
    const alpi_receivers receivers = alpi_point_array_receivers(&array);
    const alpi_reference reference = {.context = context,
                                      .scene = scene,
                                      .tracer = tracer,
                                      .lighting = lighting,
                                      .bounces = 5,
                                      .samples = 100, // rounded up to 112
                                      .next_event = true};
    ASSERT_OK(context,
              alpi_reference_irradiance(&reference, &receivers, list, list_count, NULL, values));
    alpi_lighting_destroy(scene->context, lighting);
    alp_context_destroy(context);
}

TEST_WITH_CONTEXT(workers_change_nothing, 1)
{
    static alpi_reference_value values[5][POINTS];
    static const uint32_t workers[4] = {1, 2, 7, 32};
    alp_scene *scene = NULL;
    alpi_tracer *tracer = NULL;
    ASSERT_OK(context, alp_scene_load(context, "builtin:cornell", &scene));
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    for (uint32_t i = 0; i < POINTS; i++) {
        vec3_store(positions[i], (vec3){0.05f + 0.0035f * (float)i, 0.0f, -0.4f});
        vec3_store(normals[i], (vec3){0.0f, 1.0f, 0.0f});
        offsets[i] = 1e-6f;
    }
    for (int k = 0; k < 4; k++) {
        gather(scene, tracer, workers[k], NULL, POINTS, values[k]);
        assert_memory_equal(values[k], values[0], sizeof values[0]);
    }
    assert_true(values[0][7].mean[0] > 0.0f && values[0][7].variance[0] > 0.0f);
    const uint32_t some[2] = {7, 3};
    gather(scene, tracer, 2, some, 2, values[4]);
    assert_memory_equal(&values[4][7], &values[0][7], sizeof values[0][7]);
    assert_memory_equal(&values[4][3], &values[0][3], sizeof values[0][3]);
    alp_scene_destroy(scene);
}
