// SPDX-License-Identifier: MIT
// The number of workers changes no bit; another seed changes many.
#include "test_scenes.h"

#include <stdlib.h>

enum { POINTS = 3000 };

static void gather(uint32_t workers, uint64_t seed, uint32_t samples, float *values)
{
    static float positions[POINTS][3], normals[POINTS][3];
    alp_context *context = test_context(workers);
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){-2, 0, 2}, (double[]){4, 0, 0}, (double[]){0, 0, -4});
    test_mesh_sphere(mesh, (double[]){0, 0.5, 0}, 0.5, 32, 16, 1.0, 1);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    for (int i = 0; i < POINTS; i++) {
        positions[i][0] = -1.5f + 3.0f * (float)(i % 60) / 60.0f;
        positions[i][1] = 0.0f;
        positions[i][2] = -1.5f + 3.0f * (float)(i / 60) / 50.0f;
        normals[i][0] = normals[i][2] = 0.0f;
        normals[i][1] = 1.0f;
    }
    alp_occlusion_options options = alp_occlusion_options_default();
    options.samples = samples;
    options.seed = seed;
    options.distance = 1.0f;
    ASSERT_OK(context, alp_occlusion_at_points(scene, POINTS, positions[0], NULL, normals[0],
                                               &options, values));
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

static void gather_seed(uint32_t workers, const void *seed, void *values)
{
    gather(workers, *(const uint64_t *)seed, 64, values);
}

TEST(any_number_of_workers_gives_the_same_bits)
{
    free(test_any_workers(gather_seed, &(uint64_t){5}, POINTS * sizeof(float)));
}

TEST(another_seed_gives_other_bits)
{
    static float one[POINTS], other[POINTS];
    gather(2, 5, 64, one);
    gather(2, 6, 64, other);
    int different = 0;
    for (int i = 0; i < POINTS; i++) {
        different += one[i] != other[i];
    }
    assert_true(different > POINTS / 10);
}

TEST_WITH_CONTEXT(rounds_of_samples_add_up, 2)
{
    // More samples than one round holds: a prefix of the sequence of a longer run is not lost.
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 1, 0}, (double[]){1, 0, 0}, (double[]){0, 0, 1});
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    alp_occlusion_options options = alp_occlusion_options_default();
    options.distance = 1e30f;
    options.falloff = ALP_FALLOFF_NONE;
    options.samples = (1u << 17) + 12345;
    double value = test_occlusion(scene, (double[]){0, 0, 0}, (double[]){0, 1, 0}, &options);
    ASSERT_NEAR(value, 1.0 - 0.138531606, 1e-4);
    alp_scene_destroy(scene);
}
