// SPDX-License-Identifier: MIT
// Radiosity against closed forms: the furnace after every number of bounces, two plates, the cube
// with a glowing ceiling as patches and as texels, the integrating sphere.
#include "test_radiant.h"
#include "test_scenes.h"

#include <math.h>
#include <stdio.h>

static const vec3 ONE = {1, 1, 1}, ZERO = {0, 0, 0};
TEST_CONTEXT(2);

static double root(float variance)
{
    return sqrt((double)variance);
}

/// The unit cube from inside: floor, walls, ceiling.
static alp_scene *make_cube(double albedo, double radiance, double ceiling_albedo,
                            double ceiling_radiance)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const unsigned ends = ALPI_FACE_TOP | ALPI_FACE_BOTTOM;
    alpi_builder_start(&b, context, "cube");
    const uint32_t dull = test_grey(&b, "dull", albedo, radiance);
    alpi_builder_surface(&b, "floor", dull);
    alpi_builder_box(&b, ONE, ZERO, ALPI_FACE_BOTTOM);
    alpi_builder_surface(&b, "walls", dull);
    alpi_builder_box(&b, ONE, ZERO, ALPI_FACE_ALL & ~ends);
    alpi_builder_surface(&b, "ceiling", test_grey(&b, "ceiling", ceiling_albedo, ceiling_radiance));
    alpi_builder_box(&b, ONE, ZERO, ALPI_FACE_TOP);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

// --- the furnace ---------------------------------------------------------------------------------

/// Oracle 14: all surfaces emit M = 1; after n bounces E = (1 − ρ^(n+1)) / (1 − ρ) everywhere. What
/// errs is direct light: every ray of every pass meets something. A texel's error is its own direct
/// light's and a mean over many others', which is smaller.
TEST(furnaces_after_every_bounce)
{
    static const double albedos[] = {0.2, 0.5, 0.8, 0.95};
    static const uint32_t bounces[] = {1, 3, UINT32_MAX};
    for (int i = 0; i < 4; i++) {
        const double rho = albedos[i];
        double worst = 0.0;
        for (int n = 0; n < 3; n++) {
            test_radiant r;
            test_radiant_options o = test_radiant_default();
            o.bounces = bounces[n];
            o.direct_samples = 512;
            o.size = 32;
            test_radiant_open(make_cube(rho, 1.0 / ALPI_PI, rho, 1.0 / ALPI_PI), &o, &r);
            test_radiant_gather(&r, 64);
            const double exact = (1.0 - pow(rho, (double)bounces[n] + 1.0)) / (1.0 - rho);
            const double mean = test_radiant_mean(&r, ALPI_NONE, 0, NULL);
            for (uint32_t t = 0; t < r.texels.count; t++) {
                ASSERT_NEAR(r.values[t].mean[0], exact,
                            9.0 * root(r.values[t].variance[0]) + 2e-3 * exact);
            }
            ASSERT_NEAR(mean, exact, 2e-3 * exact);
            ASSERT_NEAR(test_radiant_solved_mean(&r, ALPI_NONE, 0), exact, 2e-3 * exact);
            assert_true(n == 2 || r.solution.passes == bounces[n]);
            worst = fmax(worst, fabs(mean / exact - 1.0));
            test_radiant_close(&r);
        }
        printf("accuracy: radiosity in a furnace of albedo %.2f, after 1, 3 and all bounces: "
               "mean %.1e\n",
               rho, worst);
    }
}

/// Each bounce leaves ρ^(n+1) / (1 − ρ^(n+1)) of all light so far to those after it: passes end
/// where that is below the tolerance, or with the bounces that are asked for.
TEST(passes_end_at_the_tolerance)
{
    static const struct {
        double tolerance;
        uint32_t bounces, passes;
    } cases[] = {{1.0 / 80, UINT32_MAX, 6}, {1.0 / 80, 40, 6}, {1.0 / 80, 4, 4},
                 {1.0 / 170, 40, 7},        {0.5, 40, 2},      {0.0, 10, 10}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        test_radiant r;
        test_radiant_options o = test_radiant_default();
        o.size = 32;
        o.bounces = cases[i].bounces;
        o.tolerance = cases[i].tolerance;
        test_radiant_open(make_cube(0.5, 1.0 / ALPI_PI, 0.5, 1.0 / ALPI_PI), &o, &r);
        assert_int_equal(r.solution.passes, cases[i].passes);
        test_radiant_close(&r);
    }
}

// --- patches -------------------------------------------------------------------------------------

/// One texel to each square of a metre, which is one patch: 65,536 rays from all over it.
static test_radiant_options patch_options(void)
{
    test_radiant_options o = test_radiant_default();
    o.texels_per_metre = 1.0;
    o.max_angle = 0.3f; // of charts that are not merged, however tiny
    o.rays = 65536;
    o.direct_samples = 65536;
    return o;
}

/// Random rays would count a face of share F = .2 right to √((1 − F)/(F N)) = 7.8e-3 of it;
/// stratified ones do to half of that, and face by face the errors even out.
static const double PATCH_ERROR = 4e-3;

/// Oracle 16 with one constant patch a face: its closed form is of such patches alone.
TEST(a_cube_of_six_patches)
{
    test_radiant r;
    test_radiant_options o = patch_options();
    test_radiant_open(make_cube(0.5, 0.0, 0.0, 1.0 / ALPI_PI), &o, &r);
    assert_int_equal(r.texels.count, 6);
    assert_int_equal(r.solution.patches.patch_count, 6);
    const double floor = 0.5 * test_radiant_solved_mean(&r, 0, 1);
    const double walls = 0.5 * test_radiant_solved_mean(&r, 1, 1);
    printf("accuracy: radiosity in the cube of six patches: floor %.6f, walls %.6f\n", floor,
           walls);
    ASSERT_NEAR(floor, 0.166600339, 0.166600339 * PATCH_ERROR);
    ASSERT_NEAR(walls, 0.166683245, 0.166683245 * PATCH_ERROR);
    test_radiant_close(&r);
}

static alp_scene *make_plates(double half, const double albedo[2], const double exitance[2])
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const float r = (float)half;
    alpi_builder_start(&b, context, "plates");
    alpi_builder_surface(&b, "lower", test_grey(&b, "lower", albedo[0], exitance[0] / ALPI_PI));
    alpi_builder_quad(&b, (const vec3[4]){{-r, 0, r}, {r, 0, r}, {r, 0, -r}, {-r, 0, -r}});
    alpi_builder_surface(&b, "upper", test_grey(&b, "upper", albedo[1], exitance[1] / ALPI_PI));
    alpi_builder_quad(&b, (const vec3[4]){{-r, 1, -r}, {r, 1, -r}, {r, 1, r}, {-r, 1, r}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// Oracle 13, E1 = (M2 + ρ2 M1) / (1 − ρ1 ρ2), of plates a kilometre wide and a metre apart, in the
/// middle; and of two unit squares with a patch each, where all goes through the form factor F of
/// oracle 12: E1 = F (M2 + ρ2 F M1) / (1 − ρ1 ρ2 F²).
TEST(two_plates)
{
    static const double albedo[2] = {0.5, 0.8}, exitance[2] = {1.0, 3.0};
    for (int wide = 0; wide < 2; wide++) {
        test_radiant r;
        test_radiant_options o = patch_options();
        const double F = wide ? 1.0 : 0.199824896;
        if (wide) {
            o.texels_per_metre = 0.008;
            o.rays = 1024;
            o.side = 1;
            o.direct_samples = 4096;
        }
        test_radiant_open(make_plates(wide ? 500.0 : 0.5, albedo, exitance), &o, &r);
        for (uint32_t t = 0; t < r.texels.count; t++) {
            const vec3 p = test_radiant_position(&r, t);
            if (fabsf(p.x) > 250.0f || fabsf(p.z) > 250.0f) {
                continue; // 1/250² of what a texel sees there is beyond the edge
            }
            const uint32_t one = test_radiant_surface(&r, t), other = 1 - one;
            const double exact = F * (exitance[other] + albedo[other] * F * exitance[one]) /
                                 (1.0 - albedo[0] * albedo[1] * F * F);
            const double seen = (double)r.solution.direct[t].mean[1] +
                                (double)r.solution.bounced[r.solution.patches.patch_of[t]].mean[1];
            ASSERT_NEAR(seen, exact, exact * (wide ? 5e-3 : PATCH_ERROR));
        }
        const alpi_energy *e = &r.solution.energy;
        ASSERT_NEAR(e->absorbed + e->escaped + e->lost_behind + e->unshot, e->emitted,
                    PATCH_ERROR * e->emitted);
        if (!wide) {
            const double B[2] = {(exitance[0] + albedo[0] * F * exitance[1]) /
                                     (1.0 - albedo[0] * albedo[1] * F * F),
                                 (exitance[1] + albedo[1] * F * exitance[0]) /
                                     (1.0 - albedo[0] * albedo[1] * F * F)};
            ASSERT_NEAR(e->escaped, (1.0 - F) * (B[0] + B[1]), PATCH_ERROR * e->emitted);
        }
        test_radiant_close(&r);
    }
}

// --- texels --------------------------------------------------------------------------------------

/// Oracle 16, the continuous solution, known to the digits given. By rays and by hemicubes.
TEST(a_cube_of_texels)
{
    for (uint32_t cube = 0; cube <= 16; cube += 16) {
        test_radiant r;
        test_radiant_options o = test_radiant_default();
        double middle = 0.0, variance = 0.0;
        uint32_t count = 0;
        o.size = 64;
        o.rays = 256;
        o.hemicube = cube;
        o.side = 2;
        o.direct_samples = 1024;
        test_radiant_open(make_cube(0.5, 0.0, 0.0, 1.0 / ALPI_PI), &o, &r);
        test_radiant_gather(&r, 1024);
        const double floor = 0.5 * test_radiant_mean(&r, 0, 1, NULL);
        const double walls = 0.5 * test_radiant_mean(&r, 1, 1, NULL);
        for (uint32_t t = 0; t < r.texels.count; t++) {
            const vec3 p = test_radiant_position(&r, t);
            if (p.y < 1e-6f && fabsf(p.x - 0.5f) < 0.06f && fabsf(p.z - 0.5f) < 0.06f) {
                middle += 0.5 * (double)r.values[t].mean[1];
                variance += 0.25 * (double)r.values[t].variance[1];
                count++;
            }
        }
        printf("accuracy: radiosity in the cube of %u texels, %s: floor %.5f, its middle %.4f, "
               "walls %.5f\n",
               r.texels.count, cube > 0 ? "hemicubes" : "rays", floor, middle / count, walls);
        // Half a digit; noise; and the light of a patch's middle, not its own, in its corners.
        ASSERT_NEAR(floor, 0.1552, 5e-5 + 1e-3 * 0.1552);
        ASSERT_NEAR(walls, 0.1640, 5e-5 + 1e-3 * 0.1640);
        ASSERT_NEAR(middle / count, 0.179, 5e-4 + 4.0 * sqrt(variance) / count);
        test_radiant_close(&r);
    }
}

enum { SLICES = 96, STACKS = 48 };

/// Oracle 15: indirectly Φ ρ / ((1 − ρ) 4π r²) everywhere; E = Φ / ((1 − ρ) A) in the mean,
/// exactly. Each facet is a chart.
TEST(a_lamp_in_a_sphere)
{
    const double rho = 0.8, intensity = 2.0, flux = 4.0 * ALPI_PI * intensity;
    test_radiant r;
    test_radiant_options o = test_radiant_default();
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0, 0, 0}, 1.0, SLICES, STACKS, 1.0, 0);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    for (int k = 0; k < 3; k++) {
        scene->materials[0].base_color[k] = (float)rho;
    }
    test_lit_set_lamps(scene,
                       &(alpi_light){.kind = ALP_LIGHT_POINT,
                                     .color = {1, 1, 1},
                                     .intensity = (float)intensity,
                                     .range = INFINITY},
                       1);
    o.size = 256;
    o.direct_samples = 16;
    test_radiant_open(scene, &o, &r);
    test_radiant_gather(&r, 256);
    const double mean = test_radiant_mean(&r, ALPI_NONE, 1, NULL);
    const double exact = flux / ((1.0 - rho) * scene->area);
    const double indirect = flux * rho / ((1.0 - rho) * 4.0 * ALPI_PI);
    double worst = 0.0;
    for (uint32_t t = 0; t < r.texels.count; t++) {
        const double apart =
            (double)r.values[t].mean[1] - (double)r.solution.direct[t].mean[1] - indirect;
        worst = fmax(worst, fabs(apart / indirect));
    }
    printf("accuracy: radiosity in an integrating sphere of albedo %.1f, %u charts: mean "
           "%+.1e, indirect light %.1e at the worst\n",
           rho, alp_atlas_get_info(r.atlas).charts, mean / exact - 1.0, worst);
    ASSERT_NEAR(mean, exact, 1e-3 * exact);
    // What the facets stand off (4e-3), and that of a mean over 256 of them.
    assert_true(worst < 6e-3);
    assert_true(alp_atlas_get_info(r.atlas).charts > 4096);
    test_radiant_close(&r);
}
