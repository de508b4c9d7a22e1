// SPDX-License-Identifier: MIT
// Ambient occlusion against exact answers. At 2^16 stratified rays the sampling error is far below
// the tolerance of 1e-3, so what is seen here is bias. Oracle numbers are those of
// docs/measured/accuracy.md.
#include "test_scenes.h"

#include <math.h>

static const double PI = 3.14159265358979323846;
static const double TOLERANCE = 1e-3;
static const double FAR = 1e5; // stands for infinite: what it cuts off is below 1e-5

/// Asserts and remembers the largest error, which report() prints: the accuracy table of the
/// README.
#define CLOSED_FORM(actual, expected) closed_form((actual), (expected), #actual, __FILE__, __LINE__)

TEST_CONTEXT(2);
static double largest_error;
static int point_count;

static void closed_form(double actual, double expected, const char *text, const char *file,
                        int line)
{
    test_assert_near(actual, expected, TOLERANCE, text, file, line);
    largest_error = fmax(largest_error, fabs(actual - expected));
    point_count++;
}

static void report(const char *what)
{
    print_message("accuracy: %-55s %4d points, largest error %.1e\n", what, point_count,
                  largest_error);
    largest_error = 0.0;
    point_count = 0;
}

static alp_occlusion_options open_options(void)
{
    alp_occlusion_options o = alp_occlusion_options_default();
    o.samples = 1u << 16;
    o.distance = INFINITY;
    o.falloff = ALP_FALLOFF_NONE;
    return o;
}

/// A wall in the plane x = `at`, facing −x, from z0 to z1 and y0 to y1.
static void add_wall(test_mesh *mesh, double at, double z0, double z1, double y0, double y1)
{
    test_mesh_quad(mesh, (double[]){at, y0, z0}, (double[]){0, 0, z1 - z0},
                   (double[]){0, y1 - y0, 0});
}

static void add_floor(test_mesh *mesh, double half)
{
    test_mesh_quad(mesh, (double[]){-half, 0, half}, (double[]){2 * half, 0, 0},
                   (double[]){0, 0, -2 * half});
}

TEST(open_plane_is_exactly_one)
{
    // Oracle 2 at tilt 0, on a plane in general position, near and far from the origin.
    const double far_from_origin[] = {0.0, 1.0, 1e4};
    for (int i = 0; i < 3; i++) {
        test_mesh *mesh = test_mesh_start();
        double o = far_from_origin[i];
        test_mesh_quad(mesh, (double[]){o - 3, o, o + 1}, (double[]){5, 1, -2},
                       (double[]){1, 3, -7});
        alp_scene *scene = test_mesh_scene(context, mesh, 0);
        double n[3] = {1 * -7.0 - -2 * 3.0, -2 * 1.0 - 5 * -7.0, 5 * 3.0 - 1 * 1.0};
        double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int k = 0; k < 3; k++) {
            n[k] /= length;
        }
        alp_occlusion_options options = open_options();
        for (int falloff = ALP_FALLOFF_NONE; falloff <= ALP_FALLOFF_EXP; falloff++) {
            options.falloff = (alp_falloff)falloff;
            options.distance = falloff == ALP_FALLOFF_NONE ? INFINITY : 100.0f;
            options.samples = 1u << 14;
            for (int point = 0; point < 20; point++) {
                double u = 0.05 + 0.045 * point, v = 0.9 - 0.04 * point;
                double p[3] = {o - 3 + 5 * u + v, o + u + 3 * v, o + 1 - 2 * u - 7 * v};
                assert_true(test_occlusion(scene, p, n, &options) == 1.0);
            }
        }
        alp_scene_destroy(scene);
    }
}

TEST(wide_planes_do_not_shade_themselves)
{
    // Near the origin of a wide plane a position is exact and its triangle's corners are far: only
    // the triangle's size tells how far a ray must be lifted.
    for (double wide = 1.0; wide < 1e6; wide *= 100.0) {
        const double u[3] = {0.81 * wide, 0.1 * wide, -0.3 * wide};
        const double v[3] = {0.1 * wide, 0.31 * wide, -0.72 * wide};
        double corner[3], n[3];
        for (int k = 0; k < 3; k++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            corner[k] = -0.4 * u[k] - 0.3 * v[k];
            n[k] = (u[i] * v[j] - u[j] * v[i]) / wide;
        }
        double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int k = 0; k < 3; k++) {
            n[k] /= length;
        }
        test_mesh *mesh = test_mesh_start();
        test_mesh_quad(mesh, corner, u, v);
        alp_scene *scene = test_mesh_scene(context, mesh, 0);
        alp_occlusion_options options = open_options();
        options.samples = 256;
        for (int point = 0; point < 50; point++) { // within a metre of the origin
            double s = 0.01 * point / wide, t = (0.3 - 0.013 * point) / wide, p[3];
            for (int k = 0; k < 3; k++) {
                p[k] = s * u[k] + t * v[k];
            }
            assert_true(test_occlusion(scene, p, n, &options) == 1.0);
        }
        alp_scene_destroy(scene);
    }
}

TEST(tilted_receiver_over_a_plane)
{
    // Oracle 2: openness (1 + cos t) / 2.
    test_mesh *mesh = test_mesh_start();
    add_floor(mesh, FAR);
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    alp_occlusion_options options = open_options();
    for (double t = 0.0; t <= PI; t += PI / 8.0) {
        double expected = (1.0 + cos(t)) / 2.0;
        double p[3] = {0.3, 1.0, -0.2}, n[3] = {sin(t) * 0.6, cos(t), sin(t) * 0.8};
        CLOSED_FORM(test_occlusion(scene, p, n, &options), expected);
        options.distribution = ALP_DISTRIBUTION_UNIFORM; // solid angle of a lune: 1 − t/π
        CLOSED_FORM(test_occlusion(scene, p, n, &options), 1.0 - t / PI);
        options.distribution = ALP_DISTRIBUTION_COSINE;
    }
    alp_scene_destroy(scene);
    report("oracle 2, tilted receiver over a plane");
}

TEST(sphere_above_and_on_a_plane)
{
    // Oracle 4: F = c (r/d)² above the horizon; resting on the plane at lateral x, R³/(x²+R²)^1.5.
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0, 1, 0}, 1.0, 512, 256, 1.0, 1);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alp_occlusion_options options = open_options();
    double up[3] = {0, 1, 0};
    const double x[] = {0.3, 0.7, 1.0, 2.0, 5.0};
    for (int i = 0; i < 5; i++) {
        double expected = 1.0 - 1.0 / pow(x[i] * x[i] + 1.0, 1.5);
        CLOSED_FORM(test_occlusion(scene, (double[]){x[i], 0, 0}, up, &options), expected);
    }
    double below[3] = {0.5, -2.0, 0.25}; // all of the sphere above the horizon
    double d2 = 0.5 * 0.5 + 3.0 * 3.0 + 0.25 * 0.25, d = sqrt(d2);
    CLOSED_FORM(test_occlusion(scene, below, up, &options), 1.0 - 3.0 / d / d2);
    alp_scene_destroy(scene);
    report("oracle 4, sphere above and on a plane");
}

TEST(parallel_and_perpendicular_rectangles)
{
    // Oracle 6 and the table of reference values.
    alp_occlusion_options options = open_options();
    double up[3] = {0, 1, 0}, origin[3] = {0, 0, 0};
    test_mesh *mesh = test_mesh_start(); // 1 × 1 overhead at distance 1, over its corner
    test_mesh_quad(mesh, (double[]){0, 1, 0}, (double[]){1, 0, 0}, (double[]){0, 0, 1});
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    CLOSED_FORM(test_occlusion(scene, origin, up, &options), 1.0 - 0.138531606);
    CLOSED_FORM(test_occlusion(scene, (double[]){0.5, 0, 0.5}, up, &options), 1.0 - 0.239456470);
    alp_scene_destroy(scene);
    mesh = test_mesh_start(); // a = 2, b = .5 at c = .8
    test_mesh_quad(mesh, (double[]){0, 0.8, 0}, (double[]){2, 0, 0}, (double[]){0, 0, 0.5});
    scene = test_mesh_scene(context, mesh, 0);
    double a = 2 / 0.8, b = 0.5 / 0.8;
    double f = (a / sqrt(1 + a * a) * atan(b / sqrt(1 + a * a)) +
                b / sqrt(1 + b * b) * atan(a / sqrt(1 + b * b))) /
               (2 * PI);
    CLOSED_FORM(test_occlusion(scene, origin, up, &options), 1.0 - f);
    alp_scene_destroy(scene);
    mesh = test_mesh_start(); // perpendicular wall w = 1.5, h = 3 from the foot corner, at d = .7
    add_wall(mesh, 0.7, 0, 1.5, 0, 3);
    scene = test_mesh_scene(context, mesh, 0);
    double w = 1.5 / 0.7, h = 3 / 0.7, s = sqrt(1 + h * h);
    CLOSED_FORM(test_occlusion(scene, origin, up, &options),
                1.0 - (atan(w) - atan(w / s) / s) / (2 * PI));
    alp_scene_destroy(scene);
    report("oracle 6, parallel and perpendicular rectangles");
}

TEST(walls_corners_and_trenches)
{
    alp_occlusion_options options = open_options();
    double up[3] = {0, 1, 0}, origin[3] = {0, 0, 0};
    test_mesh *mesh = test_mesh_start(); // oracle 7: infinite wall of height H at x
    add_wall(mesh, 1.0, -FAR, FAR, 0, 2);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    CLOSED_FORM(test_occlusion(scene, origin, up, &options), 1.0 - 0.276393202);
    alp_scene_destroy(scene);

    mesh = test_mesh_start(); // oracle 7: a floor point in the corner of two infinite walls
    add_wall(mesh, 1.0, -FAR, 2.0, 0, FAR);
    test_mesh_quad(mesh, (double[]){-FAR, 0, 2}, (double[]){FAR + 1, 0, 0}, (double[]){0, FAR, 0});
    scene = test_mesh_scene(context, mesh, 1);
    CLOSED_FORM(test_occlusion(scene, origin, up, &options), 0.25);
    alp_scene_destroy(scene);

    const double width = 1.5, depth = 0.8; // oracle 9: trench
    mesh = test_mesh_start();
    add_wall(mesh, width, -FAR, FAR, 0, depth);
    add_wall(mesh, 0.0, -FAR, FAR, 0, depth);
    scene = test_mesh_scene(context, mesh, 1);
    for (double x = 0.1; x < width; x += 0.325) {
        double left = x, right = width - x;
        double expected = (left / hypot(left, depth) + right / hypot(right, depth)) / 2.0;
        CLOSED_FORM(test_occlusion(scene, (double[]){x, 0, 0}, up, &options), expected);
    }
    alp_scene_destroy(scene);
    report("oracle 7 and 9, infinite walls, corner, trench");
}

/// Oracle 8 and its fall-offs: E[w(d/D)] for an infinite wall at x, integrated over the distance at
/// which rays reach it. F(D) = (acos k − k √(1 − k²)) / π is the share of cosine-weighted
/// directions with a hit closer than D, so E[w] = ∫ w(t) dF(tD).
static double limited_wall(double x, double limit, double (*weight)(double))
{
    const int steps = 200000;
    double sum = 0.0, before = 0.0;
    for (int i = 0; i < steps; i++) {
        double t1 = x / limit + (1.0 - x / limit) * (i + 1) / steps;
        double t0 = x / limit + (1.0 - x / limit) * i / steps;
        double k = fmin(x / (t1 * limit), 1.0);
        double f = (acos(k) - k * sqrt(1.0 - k * k)) / PI;
        sum += weight(0.5 * (t0 + t1)) * (f - before);
        before = f;
    }
    return sum;
}

static double weight_none(double t)
{
    (void)t;
    return 1.0;
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

TEST(distance_limit_and_falloff)
{
    double (*const weights[])(double) = {weight_none, weight_linear, weight_smooth, weight_exp};
    test_mesh *mesh = test_mesh_start();
    add_wall(mesh, 1.0, -FAR, FAR, 0, FAR);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alp_occlusion_options options = open_options();
    double up[3] = {0, 1, 0}, origin[3] = {0, 0, 0};
    for (int falloff = 0; falloff < 4; falloff++) {
        options.falloff = (alp_falloff)falloff;
        const double limits[] = {1.1, 1.5, 4.0, 50.0};
        for (int i = 0; i < 4; i++) {
            options.distance = (float)limits[i];
            double expected = 1.0 - limited_wall(1.0, limits[i], weights[falloff]);
            CLOSED_FORM(test_occlusion(scene, origin, up, &options), expected);
        }
    }
    alp_scene_destroy(scene);
    report("oracle 8, distance limit and the four fall-offs");
}

TEST(cones_see_only_their_cone)
{
    // A coaxial disk of radius R at height h (oracle 5) seen in a cone of half-angle a: the share
    // is sin²θ / sin²a with θ the disk's half-angle; uniform directions (1 − cos θ) / (1 − cos a).
    test_mesh *mesh = test_mesh_start();
    const int sides = 512;
    uint32_t center = test_mesh_vertex(mesh, 0, 1, 0), first = center + 1;
    for (int i = 0; i < sides; i++) {
        double phi = 2.0 * PI * i / sides;
        test_mesh_vertex(mesh, 0.5 * cos(phi), 1, 0.5 * sin(phi));
    }
    for (int i = 0; i < sides; i++) {
        test_mesh_triangle(mesh, center, first + (uint32_t)i, first + (uint32_t)((i + 1) % sides));
    }
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    alp_occlusion_options options = open_options();
    double up[3] = {0, 1, 0}, origin[3] = {0, 0, 0};
    double theta = atan(0.5);
    CLOSED_FORM(test_occlusion(scene, origin, up, &options), 1.0 - 0.25 / 1.25);
    for (double a = 0.6; a < 1.58; a += 0.3) {
        options.cone = (float)a;
        options.distribution = ALP_DISTRIBUTION_COSINE;
        CLOSED_FORM(test_occlusion(scene, origin, up, &options), 1.0 - pow(sin(theta) / sin(a), 2));
        options.distribution = ALP_DISTRIBUTION_UNIFORM;
        CLOSED_FORM(test_occlusion(scene, origin, up, &options),
                    1.0 - (1 - cos(theta)) / (1 - cos(a)));
    }
    alp_scene_destroy(scene);
    report("oracle 5, disk seen in cones");
}

TEST(inside_of_a_cut_sphere)
{
    // Oracle 10: openness (1 − z_c)/2 at every point of the true sphere. A facet's exact answer is
    // the form factor of the rim polygon about the facet's normal (oracle 11); both are asked for.
    enum { SLICES = 256, STACKS = 128 };
    const double cuts[] = {0.0, 0.5, -0.3};
    for (int c = 0; c < 3; c++) {
        double cut = cuts[c];
        test_mesh *mesh = test_mesh_start();
        test_mesh_sphere(mesh, (double[]){0, 0, 0}, 1.0, SLICES, STACKS, cut, 0);
        static double rim[SLICES][3];
        for (int i = 0; i < SLICES; i++) {
            const float *v = mesh->positions[STACKS * SLICES + i];
            for (int k = 0; k < 3; k++) {
                rim[i][k] = (double)v[k];
            }
        }
        alp_scene *scene = test_mesh_scene(context, mesh, 0);
        alp_occlusion_options options = open_options();
        for (uint32_t t = 1000; t < mesh->triangle_count; t += 9173) {
            double v[3][3], p[3], n[3];
            for (int k = 0; k < 3; k++) {
                for (int axis = 0; axis < 3; axis++) {
                    v[k][axis] = (double)mesh->positions[mesh->triangles[t][k]][axis];
                }
            }
            for (int k = 0; k < 3; k++) {
                int i = (k + 1) % 3, j = (k + 2) % 3;
                p[k] = (v[0][k] + v[1][k] + v[2][k]) / 3.0;
                n[k] = (v[1][i] - v[0][i]) * (v[2][j] - v[0][j]) -
                       (v[1][j] - v[0][j]) * (v[2][i] - v[0][i]);
            }
            double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            for (int k = 0; k < 3; k++) {
                n[k] /= length;
            }
            double exact = test_polygon_form_factor(p, n, (const double(*)[3])rim, SLICES);
            CLOSED_FORM(test_occlusion(scene, p, n, &options), exact);
            ASSERT_NEAR(exact, (1.0 - cut) / 2.0, 0.004); // what facets cost, by physics.md .003
        }
        alp_scene_destroy(scene);
    }
    report("oracle 10 and 11, inside of a cut sphere");
}

TEST(closed_cube_and_opposite_squares)
{
    // Oracle 12: mean over a unit square of what an opposite / adjacent square takes: .199824896
    // and .200043776; a closed cube takes all. Mean over a 16 × 16 midpoint grid of receivers.
    enum { GRID = 16 };
    alp_occlusion_options options = open_options();
    options.samples = 1u << 12;
    double up[3] = {0, 1, 0};
    for (int kind = 0; kind < 3; kind++) {
        test_mesh *mesh = test_mesh_start();
        if (kind != 1) { // ceiling
            test_mesh_quad(mesh, (double[]){0, 1, 0}, (double[]){1, 0, 0}, (double[]){0, 0, 1});
        }
        if (kind != 0) {
            add_wall(mesh, 1.0, 0, 1, 0, 1);
        }
        if (kind == 2) {
            add_wall(mesh, 0.0, 0, 1, 0, 1);
            test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){1, 0, 0}, (double[]){0, 1, 0});
            test_mesh_quad(mesh, (double[]){0, 0, 1}, (double[]){1, 0, 0}, (double[]){0, 1, 0});
        }
        alp_scene *scene = test_mesh_scene(context, mesh, 1);
        double sum = 0.0;
        for (int i = 0; i < GRID * GRID; i++) {
            double p[3] = {(i % GRID + 0.5) / GRID, 0, (i / GRID + 0.5) / GRID};
            sum += 1.0 - test_occlusion(scene, p, up, &options);
        }
        const double expected[] = {0.199824896, 0.200043776, 1.0};
        // The midpoint rule itself is off by 2e-5 (opposite) and 6e-4 (adjacent: a kink at the
        // edge).
        CLOSED_FORM(sum / (GRID * GRID), expected[kind]);
        alp_scene_destroy(scene);
    }
    report("oracle 12, mean over squares of a cube");
}

TEST(one_sided_is_open_from_behind)
{
    test_mesh *mesh = test_mesh_start(); // a ceiling that faces up: seen from behind
    test_mesh_quad(mesh, (double[]){-1, 1, 1}, (double[]){2, 0, 0}, (double[]){0, 0, -2});
    double up[3] = {0, 1, 0}, origin[3] = {0, 0, 0};
    for (int double_sided = 0; double_sided <= 1; double_sided++) {
        alp_scene *scene = test_mesh_scene(context, mesh, double_sided);
        alp_occlusion_options options = open_options();
        double closed = 1.0 - 0.554126424;
        CLOSED_FORM(test_occlusion(scene, origin, up, &options), closed);
        options.one_sided = true;
        ASSERT_NEAR(test_occlusion(scene, origin, up, &options), double_sided ? closed : 1.0,
                    double_sided ? TOLERANCE : 0.0);
        options.falloff = ALP_FALLOFF_LINEAR; // the other kind of query
        options.distance = 1e9f;
        ASSERT_NEAR(test_occlusion(scene, origin, up, &options), double_sided ? closed : 1.0,
                    double_sided ? TOLERANCE : 0.0);
        alp_scene_destroy(scene);
    }
}

TEST(bad_arguments_are_refused)
{
    test_mesh *mesh = test_mesh_start();
    add_floor(mesh, 1.0);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    const float p[3] = {0, 0, 0}, n[3] = {0, 1, 0}, bad[3] = {NAN, 0, 0}, longer[3] = {0, 1.1f, 0};
    float out = 7.0f;
    alp_occlusion_options o = alp_occlusion_options_default();
    assert_int_equal(alp_occlusion_at_points(scene, 1, bad, NULL, n, &o, &out),
                     ALP_ERROR_INVALID_DATA);
    assert_int_equal(alp_occlusion_at_points(scene, 1, p, NULL, longer, &o, &out),
                     ALP_ERROR_INVALID_DATA);
    assert_int_equal(alp_occlusion_at_points(scene, 1, NULL, NULL, n, &o, &out),
                     ALP_ERROR_INVALID_ARGUMENT);
    o.samples = 0;
    assert_int_equal(alp_occlusion_at_points(scene, 1, p, NULL, n, &o, &out),
                     ALP_ERROR_INVALID_ARGUMENT);
    o = alp_occlusion_options_default();
    o.cone = 2.0f;
    assert_int_equal(alp_occlusion_at_points(scene, 1, p, NULL, n, &o, &out),
                     ALP_ERROR_INVALID_ARGUMENT);
    o = alp_occlusion_options_default();
    o.distance = NAN;
    assert_int_equal(alp_occlusion_at_points(scene, 1, p, NULL, n, &o, &out),
                     ALP_ERROR_INVALID_ARGUMENT);
    o.struct_size = 0;
    assert_int_equal(alp_occlusion_at_points(scene, 1, p, NULL, n, &o, &out),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_true(out == 7.0f);
    ASSERT_OK(context, alp_occlusion_at_points(scene, 0, NULL, NULL, NULL, NULL, NULL));
    alp_scene_destroy(scene);
}
