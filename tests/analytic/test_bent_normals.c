// SPDX-License-Identifier: MIT
// Bent normals against exact mean directions. At 2^15 stratified rays the sampling error is far
// below the tolerance, so what is seen here is bias.
#include "test_scenes.h"

#include <math.h>

static const double PI = 3.14159265358979323846;
static const double TOLERANCE = 1e-3; // of each coordinate of a unit vector
static const double FAR = 1e5;        // stands for infinite

TEST_CONTEXT(2);

static alp_occlusion_options open_options(void)
{
    alp_occlusion_options o = alp_occlusion_options_default();
    o.samples = 1u << 15;
    o.distance = INFINITY;
    o.falloff = ALP_FALLOFF_NONE;
    return o;
}

static void bent_normal(const alp_scene *scene, const double position[3], const double normal[3],
                        const alp_occlusion_options *options, double bent[3])
{
    float p[3], n[3], out[3];
    for (int k = 0; k < 3; k++) {
        p[k] = (float)position[k];
        n[k] = (float)normal[k];
    }
    ASSERT_OK(context, alp_bent_normals_at_points(scene, 1, p, NULL, n, options, out));
    for (int k = 0; k < 3; k++) {
        bent[k] = (double)out[k];
    }
    ASSERT_NEAR(sqrt(bent[0] * bent[0] + bent[1] * bent[1] + bent[2] * bent[2]), 1.0, 1e-6);
}

/// `direction` of any length.
static void assert_along(const double bent[3], const double direction[3], double tolerance)
{
    const double length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] +
                               direction[2] * direction[2]);
    for (int k = 0; k < 3; k++) {
        ASSERT_NEAR(bent[k], direction[k] / length, tolerance);
    }
}

static const double UP[3] = {0, 1, 0}, ORIGIN[3] = {0, 0, 0};

/// A wall in the plane x = 1, height y1, infinite along z.
static alp_scene *long_wall(double height)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){1, 0, -FAR}, (double[]){0, 0, 2 * FAR},
                   (double[]){0, height, 0});
    return test_mesh_scene(context, mesh, 0);
}

TEST(open_plane_keeps_its_normal)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){-3, 0, 1}, (double[]){5, 1, -2}, (double[]){1, 3, -7});
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    const double n[3] = {-1, 33, 14}, length = sqrt(1 + 33 * 33 + 14 * 14);
    const double unit[3] = {n[0] / length, n[1] / length, n[2] / length};
    alp_occlusion_options options = open_options();
    for (int falloff = ALP_FALLOFF_NONE; falloff <= ALP_FALLOFF_EXP; falloff++) {
        double bent[3];
        options.falloff = (alp_falloff)falloff;
        options.distance = falloff == ALP_FALLOFF_NONE ? INFINITY : 100.0f;
        bent_normal(scene, (double[]){0, 2, -3.5}, unit, &options, bent);
        assert_along(bent, n, TOLERANCE);
    }
    alp_scene_destroy(scene);
}

TEST(walls_of_any_height_push_away)
{
    // Along the wall (z) an angle β, around it ψ from the wall's foot: open where ψ > α, tan α =
    // height. ∫ ω (n·ω) dω = (4/3) (−sin²α / 2, (π − α) / 2 + sin 2α / 4, 0).
    const double heights[] = {0.25, 1.0, 2.0, FAR};
    for (int i = 0; i < 4; i++) {
        alp_scene *scene = long_wall(heights[i]);
        alp_occlusion_options options = open_options();
        const double a = atan(heights[i]);
        const double expected[3] = {-0.5 * sin(a) * sin(a), 0.5 * (PI - a) + 0.25 * sin(2.0 * a),
                                    0};
        double bent[3];
        bent_normal(scene, ORIGIN, UP, &options, bent);
        assert_along(bent, expected, TOLERANCE);
        alp_scene_destroy(scene);
    }
}

TEST(uniform_directions_count_the_same)
{
    // A quarter of the sphere: ∫ ω dω = (−π/2, π/2, 0), where the cosine gives (−2/3, π/3, 0).
    alp_scene *scene = long_wall(FAR);
    alp_occlusion_options options = open_options();
    double bent[3];
    bent_normal(scene, ORIGIN, UP, &options, bent);
    assert_along(bent, (double[]){-2, PI, 0}, TOLERANCE);
    options.distribution = ALP_DISTRIBUTION_UNIFORM;
    bent_normal(scene, ORIGIN, UP, &options, bent);
    assert_along(bent, (double[]){-1, 1, 0}, TOLERANCE);
    alp_scene_destroy(scene);
}

TEST(corner_of_two_walls_points_out)
{
    // Azimuths of a quarter circle are open: ∫ = (1/3, π/6, 1/3), turned away from both.
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){1, 0, -FAR}, (double[]){0, 0, FAR + 2}, (double[]){0, FAR, 0});
    test_mesh_quad(mesh, (double[]){-FAR, 0, 2}, (double[]){FAR + 1, 0, 0}, (double[]){0, FAR, 0});
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    alp_occlusion_options options = open_options();
    double bent[3];
    bent_normal(scene, ORIGIN, UP, &options, bent);
    assert_along(bent, (double[]){-2, PI, -2}, TOLERANCE);
    ASSERT_NEAR(atan2(bent[2], bent[0]), -0.75 * PI, TOLERANCE);
    alp_scene_destroy(scene);
}

static double weight_linear(double t)
{
    return 1.0 - t;
}

static double weight_smooth(double t)
{
    return (1.0 - t) * (1.0 - t) * (1.0 + 2.0 * t);
}

static double weight_exp(double t)
{
    return (exp(-4.0 * t) - exp(-4.0)) / (1.0 - exp(-4.0));
}

TEST(falloff_weighs_directions)
{
    // In front of an infinite wall at 1 m the ray (β, ψ) goes 1 / (sin β cos ψ) far: ∫ (1 − w) ω
    // (n·ω) dω over both angles, midpoint rule.
    double (*const weights[])(double) = {NULL, weight_linear, weight_smooth, weight_exp};
    alp_scene *scene = long_wall(FAR);
    enum { STEPS = 1000 };
    for (int falloff = ALP_FALLOFF_LINEAR; falloff <= ALP_FALLOFF_EXP; falloff++) {
        alp_occlusion_options options = open_options();
        options.falloff = (alp_falloff)falloff;
        options.distance = 3.0f;
        double expected[3] = {0, 0, 0}, bent[3];
        for (int i = 0; i < STEPS * STEPS; i++) {
            const double beta = PI * (i % STEPS + 0.5) / STEPS;
            const double psi = PI * (floor((double)i / STEPS) + 0.5) / STEPS, s = sin(beta);
            const double t = psi < PI / 2.0 ? 1.0 / (s * cos(psi)) / 3.0 : 1.0;
            const double open = t < 1.0 ? 1.0 - weights[falloff](t) : 1.0;
            expected[0] += open * s * s * s * cos(psi) * sin(psi);
            expected[1] += open * s * s * s * sin(psi) * sin(psi);
        }
        bent_normal(scene, ORIGIN, UP, &options, bent);
        assert_along(bent, expected, TOLERANCE);
    }
    alp_scene_destroy(scene);
}

TEST(inside_of_a_bowl)
{
    // From a point of a sphere, (n·ω) dω = dA / 4 of the sphere's area that ω reaches: the mean
    // direction is that to the missing cap, uniform over its area. Facets cost what they cost
    // occlusion: .003.
    enum { STEPS = 400 };
    const double cuts[] = {0.0, 0.5, -0.3};
    for (int c = 0; c < 3; c++) {
        test_mesh *mesh = test_mesh_start();
        test_mesh_sphere(mesh, ORIGIN, 1.0, 256, 128, cuts[c], 0);
        alp_scene *scene = test_mesh_scene(context, mesh, 0);
        alp_occlusion_options options = open_options();
        for (double polar = 0.03; polar < 1.2; polar += 0.29) { // from the lowest point
            const double azimuth = 0.4 + 3.0 * polar;
            const double out[3] = {sin(polar) * cos(azimuth), -cos(polar),
                                   sin(polar) * sin(azimuth)};
            const double n[3] = {-out[0], -out[1], -out[2]};
            // in front of the facets, which are up to 4e-4 inside
            const double p[3] = {0.999 * out[0], 0.999 * out[1], 0.999 * out[2]};
            double expected[3] = {0, 0, 0}, bent[3];
            for (int i = 0; i < STEPS * STEPS; i++) {
                const double y = cuts[c] + (1.0 - cuts[c]) * (i % STEPS + 0.5) / STEPS;
                const double phi = 2.0 * PI * (floor((double)i / STEPS) + 0.5) / STEPS;
                const double r = sqrt(1.0 - y * y);
                const double d[3] = {r * cos(phi) - out[0], y - out[1], r * sin(phi) - out[2]};
                const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
                for (int k = 0; k < 3; k++) {
                    expected[k] += d[k] / length;
                }
            }
            bent_normal(scene, p, n, &options, bent);
            assert_along(bent, expected, 0.004);
        }
        alp_scene_destroy(scene);
    }
}

TEST(closed_rooms_keep_the_normal)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, ORIGIN, 1.0, 32, 16, 1.0, 0);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alp_occlusion_options options = open_options();
    options.samples = 256;
    double bent[3];
    const double n[3] = {0.6, 0.0, -0.8};
    bent_normal(scene, (double[]){0.1, 0.2, 0.3}, n, &options, bent);
    assert_along(bent, n, 1e-7);
    alp_scene_destroy(scene);
}
