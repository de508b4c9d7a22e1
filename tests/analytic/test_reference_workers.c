// SPDX-License-Identifier: MIT
// The path tracer gives the same bits for any number of workers, and the same whatever else is in
// the list.
#include "test_support.h"

#include "transport/paths/reference.h"

#include <stdlib.h>

enum { POINTS = 128 }; // of 112 paths: four ranges of 36
static float positions[POINTS][3], normals[POINTS][3], offsets[POINTS];

typedef struct traced_scene {
    alp_scene *scene;
    alpi_tracer *tracer; // the scene's
} traced_scene;

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

static void gather_all(uint32_t workers, const void *stage, void *values)
{
    const traced_scene *s = stage;
    gather(s->scene, s->tracer, workers, NULL, POINTS, values);
}

TEST_WITH_CONTEXT(workers_change_nothing, 1)
{
    static alpi_reference_value listed[POINTS];
    traced_scene s = {NULL, NULL};
    ASSERT_OK(context, alp_scene_load(context, "builtin:cornell", &s.scene));
    ASSERT_OK(context, alpi_tracer_for_scene(s.scene, NULL, NULL, &s.tracer, NULL));
    for (uint32_t i = 0; i < POINTS; i++) {
        vec3_store(positions[i], (vec3){0.05f + 0.0035f * (float)i, 0.0f, -0.4f});
        vec3_store(normals[i], (vec3){0.0f, 1.0f, 0.0f});
        offsets[i] = 1e-6f;
    }
    alpi_reference_value *all = test_any_workers(gather_all, &s, POINTS * sizeof *all);
    assert_true(all[7].mean[0] > 0.0f && all[7].variance[0] > 0.0f);
    const uint32_t some[2] = {7, 3};
    gather(s.scene, s.tracer, 2, some, 2, listed);
    assert_memory_equal(&listed[7], &all[7], sizeof all[7]);
    assert_memory_equal(&listed[3], &all[3], sizeof all[3]);
    free(all);
    alp_scene_destroy(s.scene);
}
