// SPDX-License-Identifier: MIT
// The path tracer against closed forms: furnaces of any number of bounces and an even sky; whether
// its standard error is true.
#include "test_lit.h"

#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdio.h>

static const double PI = 3.14159265358979323846;

TEST_CONTEXT(2);

/// The unit cube from inside; its ceiling is a surface of its own.
static alp_scene *make_cube(float albedo, float emission, float ceiling_albedo,
                            float ceiling_emission)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 high = {1.0f, 1.0f, 1.0f}, low = {0.0f, 0.0f, 0.0f};
    alpi_builder_start(&b, context, "cube");
    const uint32_t walls = alpi_builder_material(&b, "walls", (vec3){albedo, albedo, albedo},
                                                 (vec3){emission, emission, emission});
    const uint32_t ceiling =
        alpi_builder_material(&b, "ceiling", (vec3){ceiling_albedo, ceiling_albedo, ceiling_albedo},
                              (vec3){ceiling_emission, ceiling_emission, ceiling_emission});
    alpi_builder_surface(&b, "walls", walls);
    alpi_builder_box(&b, high, low, ALPI_FACE_ALL & ~(unsigned)ALPI_FACE_TOP);
    alpi_builder_surface(&b, "ceiling", ceiling);
    alpi_builder_box(&b, high, low, ALPI_FACE_TOP);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

// --- furnaces ------------------------------------------------------------------------------------

/// Oracle 14: with M = πLe and albedo ρ, E = M Σ ρ^k over k = 0 … n after n bounces.
TEST(furnace_after_n_bounces)
{
    static const float albedos[] = {0.2f, 0.5f, 0.8f, 0.95f};
    static const uint32_t bounces[] = {0, 1, 2, 5, 15, ALPI_REFERENCE_BOUNCE_LIMIT};
    double worst = 0.0;
    for (size_t a = 0; a < 4; a++) {
        test_lit l = test_lit_open(make_cube(albedos[a], 1.0f, albedos[a], 1.0f), NULL);
        for (size_t n = 0; n < 6; n++) {
            const double rho = (double)albedos[a];
            const double exact = PI * (1.0 - pow(rho, bounces[n] + 1.0)) / (1.0 - rho);
            alpi_reference r = test_lit_reference(&l, bounces[n], 1u << 13);
            alpi_reference_value v =
                test_lit_point(&r, (vec3){0.3f, 0.0f, 0.4f}, (vec3){0.0f, 1.0f, 0.0f});
            // 5 standard errors (of 15 degrees of freedom: one of 6000 is further off, and there
            // are 48), and a millionth for single precision
            ASSERT_NEAR(v.mean[1], exact, 5.0 * sqrt((double)v.variance[1]) + 1e-6 * exact);
            // every ray brings the same: only roulette makes noise, and little in a few bounces
            r.samples = bounces[n] < 5 ? 1u << 14 : 1u << 18;
            r.next_event = false;
            v = test_lit_point(&r, (vec3){0.3f, 0.0f, 0.4f}, (vec3){0.0f, 1.0f, 0.0f});
            ASSERT_NEAR(v.mean[1], exact, 5.0 * sqrt((double)v.variance[1]) + 1e-5 * exact);
            const double error = fabs((double)v.mean[1] / exact - 1.0);
            worst = fmax(worst, error);
            assert_true(error <= 1e-3);
        }
        test_lit_close(&l);
    }
    printf("accuracy: furnace, 4 albedos x 6 numbers of bounces, largest relative error: %.1e\n",
           worst);
}

/// Oracle 1: under an even sky an open plane gets E = πL, and the sky is white behind it.
TEST(even_sky_over_a_plane)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_CONSTANT;
    o.sky.strength = 3.0f;
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "plane");
    alpi_builder_surface(
        &b, "plane",
        alpi_builder_material(&b, "grey", (vec3){0.5f, 0.5f, 0.5f}, (vec3){0.0f, 0.0f, 0.0f}));
    alpi_builder_quad(&b,
                      (const vec3[4]){{-9, 0.0f, 9}, {9, 0.0f, 9}, {9, 0.0f, -9}, {-9, 0.0f, -9}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    test_lit l = test_lit_open(scene, &o);
    const alpi_reference r = test_lit_reference(&l, 8, 4096);
    const alpi_reference_value v =
        test_lit_point(&r, (vec3){0.1f, 0.0f, 0.2f}, (vec3){0.0f, 1.0f, 0.0f});
    ASSERT_NEAR(v.mean[2], 3.0 * PI, 4.0 * sqrt((double)v.variance[2]) + 1e-5);
    assert_true(sqrt((double)v.variance[2]) < 0.02 * 3.0 * PI);
    test_lit_close(&l);
}

// --- statistics ----------------------------------------------------------------------------------

/// Over seeds, error over standard error has mean 0 and spread 1.
TEST(standard_error_is_true)
{
    test_lit l = test_lit_open(make_cube(0.5f, 0.0f, 0.5f, 1.0f), NULL);
    const vec3 at = {0.2f, 0.0f, 0.7f}, up = {0.0f, 1.0f, 0.0f};
    alpi_reference many = test_lit_reference(&l, 4, 1u << 18);
    many.seed = 999;
    const double truth = (double)test_lit_point(&many, at, up).mean[0];
    double mean = 0.0, squares = 0.0;
    enum { SEEDS = 256 };
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        alpi_reference r = test_lit_reference(&l, 4, 256);
        r.seed = seed;
        const alpi_reference_value v = test_lit_point(&r, at, up);
        const double z = ((double)v.mean[0] - truth) / sqrt((double)v.variance[0]);
        mean += z / SEEDS;
        squares += z * z / SEEDS;
    }
    // Student's t of 15 degrees of freedom has the spread √(15/13) = 1.07; 4 standard errors of
    // 256 draws are .25 and .19.
    ASSERT_NEAR(mean, 0.0, 0.27);
    ASSERT_NEAR(sqrt(squares), 1.07, 0.2);
    printf("accuracy: reference, error over standard error, 256 seeds: mean %+.2f, spread %.2f\n",
           mean, sqrt(squares));
    test_lit_close(&l);
}
