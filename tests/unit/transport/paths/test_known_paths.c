// SPDX-License-Identifier: MIT
// Paths that end with light that is known, and go on where they meet it from near.
#include "test_scenes.h"

#include "scene/lights/lighting.h"
#include "transport/paths/paths.h"

#include <math.h>
#include <string.h>

enum { PATHS = 8, WAVES = 64 };
static const float RADIANCE = 3.0f, ALBEDO = 0.75f, SIDE = 0.25f;

/// The same light everywhere, in cells with sides of .25 m.
static void find(const void *user, const alpi_hits *hits, const uint32_t *met, uint32_t count,
                 uint32_t (*cells)[ALPI_PACKET])
{
    (void)user;
    for (uint32_t k = 0; k < count; k++) {
        for (int i = 0; i < ALPI_PACKET; i++) {
            if ((met[k] >> i & 1u) != 0) {
                assert_true(hits[k].triangle[i] != ALPI_NONE);
                cells[k][i] = ALPI_CELL_FIRST;
            }
        }
    }
}

/// Irradiance at the middle of the floor of a closed cube of 1 m, by paths that have bounced once.
static double gather(const alp_scene *scene, const alpi_tracer *tracer,
                     const alpi_lighting *lighting, uint32_t bounces, float reach, double *error)
{
    static alpi_path_wave w;
    const float cells[ALPI_CELL_FIRST + 1][4] = {
        {0.0f}, {0.0f}, {RADIANCE, RADIANCE, RADIANCE, SIDE}};
    const alpi_surface_light light = {.find = find, .cells = cells};
    const alpi_reference r = {.context = scene->context,
                              .scene = scene,
                              .tracer = tracer,
                              .lighting = lighting,
                              .bounces = bounces,
                              .known = &light,
                              .known_reach = reach};
    const alpi_receiver_point at = {.position = {0.5f, 0.0f, 0.5f},
                                    .geometric_normal = {0.0f, 1.0f, 0.0f},
                                    .shading_normal = {0.0f, 1.0f, 0.0f},
                                    .offset = 1e-5f};
    double sum = 0.0, squares = 0.0;
    for (uint32_t wave = 0; wave < WAVES; wave++) {
        w.count = PATHS;
        for (uint32_t i = 0; i < PATHS; i++) {
            alpi_paths_place(&w, i, &at);
            w.key[i] = 7;
            w.sample[i] = wave * PATHS + i;
            w.event[i] = 0;
            w.depth[i] = 1;
            w.slot[i] = w.block[i] = i;
            w.lanes[i] = 1;
            w.throughput.x[i] = w.throughput.y[i] = w.throughput.z[i] = 1.0f;
        }
        alpi_paths_run(&r, &w);
        for (uint32_t i = 0; i < PATHS; i++) {
            const double value = (double)alpi_paths_light(&w, i).x;
            sum += value;
            squares += value * value;
        }
    }
    const double mean = sum / (WAVES * PATHS);
    *error = sqrt(fmax(squares / (WAVES * PATHS) - mean * mean, 0.0) / (WAVES * PATHS));
    return mean;
}

/// Of a path that went on n times there is left ρⁿ of π L.
TEST_WITH_CONTEXT(near_light_is_passed, 1)
{
    alp_scene *scene = NULL;
    alpi_tracer *tracer = NULL;
    alpi_lighting *lighting = NULL;
    ASSERT_OK(context, alp_scene_load(context, "builtin:furnace", &scene));
    for (uint32_t m = 0; m < scene->material_count; m++) {
        for (int k = 0; k < 3; k++) {
            scene->materials[m].base_color[k] = ALBEDO;
            scene->materials[m].emission[k] = 0.0f;
        }
    }
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    ASSERT_OK(context, alpi_lighting_create_quietly(scene, NULL, &lighting));
    double error;
    const double all = ALPI_PI * (double)RADIANCE, rho = (double)ALBEDO;
    const double never = gather(scene, tracer, lighting, 4, 0.0f, &error);
    ASSERT_NEAR(never, all, 1e-6 * all);
    // From the floor the ceiling is 1 m away or more, and walls .5 m or more.
    const double some = gather(scene, tracer, lighting, 4, 4.0f, &error);
    print_message("E/πL: %.4f never, %.4f of 4 sides\n", never / all, some / all);
    assert_true(some < all * 0.99 && some > all * 0.7);
    for (uint32_t bounces = 2; bounces <= 5; bounces++) {
        const double always = gather(scene, tracer, lighting, bounces, 100.0f, &error);
        const double wanted = all * pow(rho, bounces - 2);
        print_message("%u bounces: %.5f, wanted %.5f, +- %.5f\n", bounces, always, wanted, error);
        ASSERT_NEAR(always, wanted, 4.0 * error + 1e-5 * wanted);
        assert_true(error < 0.02 * wanted);
    }
    alpi_lighting_destroy(context, lighting);
    alp_scene_destroy(scene);
}
