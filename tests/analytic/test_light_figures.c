// SPDX-License-Identifier: MIT
// Lights that have a shape, through the path tracer: disk, rectangle, wall, sphere and polygon,
// each from eight azimuths and about two normals, by asking for light and by meeting it. E = π L F.
#include "test_lights.h"
#include "test_lit.h"
#include "test_scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { TRIANGLE_LIMIT = 8192, AXES = 2, PLACINGS = 8 };
/// Paths of one placing; more where much of a light lies along the horizon, which makes noise.
enum { PATHS = 16384, MANY_PATHS = 4 * PATHS, CHANCE_PATHS = 8192 };

/// A light as the receiver sees it, which is at the origin with its normal along +y.
typedef struct figure {
    const char *name;
    vec3 (*triangles)[3];
    uint32_t count;
} figure;

static vec3 store[TRIANGLE_LIMIT][3], placed[TRIANGLE_LIMIT][3];
TEST_CONTEXT(2);

// --- figures -------------------------------------------------------------------------------------

/// A polygon that is seen all from its corner 0; counter-clockwise on the side that shines.
static figure polygon(const char *name, const vec3 *corners, uint32_t count)
{
    for (uint32_t i = 0; i + 2 < count; i++) {
        store[i][0] = corners[0];
        store[i][1] = corners[i + 1];
        store[i][2] = corners[i + 2];
    }
    return (figure){name, store, count - 2};
}

/// F by oracle 11, of every triangle whose front looks at the receiver. None may hide another.
static double form_factor(const figure *f)
{
    static const double origin[3] = {0, 0, 0}, up[3] = {0, 1, 0};
    double sum = 0.0;
    for (uint32_t i = 0; i < f->count; i++) {
        const vec3 *t = f->triangles[i];
        double corners[3][3];
        for (int k = 0; k < 3; k++) {
            corners[k][0] = (double)t[k].x;
            corners[k][1] = (double)t[k].y;
            corners[k][2] = (double)t[k].z;
        }
        const vec3 front = vec3_triangle_normal(t[0], t[1], t[2], (vec3){0.0f, 0.0f, 0.0f});
        if (vec3_dot(front, t[0]) < 0.0f) {
            sum += test_polygon_form_factor(origin, up, (const double(*)[3])corners, 3);
        }
    }
    return sum;
}

// --- placing -------------------------------------------------------------------------------------

/// Where a figure and its receiver go.
typedef struct placing {
    vec3 at, x, y, z; // y: the receiver's normal
} placing;

static placing place(uint32_t i)
{
    const vec3 axes[AXES] = {{0, 1, 0}, {0.48f, -0.6f, 0.64f}};
    const double azimuth = 2.0 * ALPI_PI * i / PLACINGS + 0.1;
    placing p = {.at = {0.3f, -0.2f, 0.5f}, .y = axes[i % AXES]};
    vec3 a, b;
    vec3_frame(p.y, &a, &b);
    p.x = vec3_add(vec3_scale(a, (float)cos(azimuth)), vec3_scale(b, (float)sin(azimuth)));
    p.z = vec3_cross(p.x, p.y);
    return p;
}

static test_lit light_figure(const figure *f, const placing *p)
{
    for (uint32_t i = 0; i < f->count; i++) {
        for (int k = 0; k < 3; k++) {
            const vec3 c = f->triangles[i][k];
            placed[i][k] = vec3_mad(vec3_mad(vec3_mad(p->at, c.x, p->x), c.y, p->y), c.z, p->z);
        }
    }
    return test_lit_open(
        test_emitter_scene(context, (const vec3(*)[3])placed, f->count, (vec3){2.0f, 1.0f, 0.5f}),
        NULL);
}

/// Holds a figure to the form factor `exact`, from everywhere: within 4 standard errors and 1e-3 of
/// `largest`, that of the figures it is one of. Scrambled points have 16 replicates,
/// whose spread alone is a poor measure (Student's t: one in 900 is beyond 4 of it), so that of all
/// placings is taken together; what is not noise is the rounding of corners to floats, 1e-6.
static void check(const figure *f, double exact, double largest, uint32_t paths)
{
    alpi_reference_value with[PLACINGS], without[PLACINGS];
    double variance = 0.0, met = 0.0, met_variance = 0.0, worst = 0.0;
    for (uint32_t i = 0; i < PLACINGS; i++) {
        const placing p = place(i);
        test_lit lit = light_figure(f, &p);
        alpi_reference r = test_lit_reference(&lit, 0, paths);
        r.seed = i;
        with[i] = test_lit_point(&r, p.at, p.y);
        r.seed = 100 + i;
        r.next_event = false;
        r.samples = CHANCE_PATHS;
        without[i] = test_lit_point(&r, p.at, p.y);
        test_lit_close(&lit);
        variance += (double)with[i].variance[1] / PLACINGS;
        met += (double)without[i].mean[1] / PLACINGS;
        met_variance += (double)without[i].variance[1] / PLACINGS;
    }
    const double E = ALPI_PI * exact;
    for (uint32_t i = 0; i < PLACINGS; i++) {
        const double error = (double)with[i].mean[1] - E;
        ASSERT_NEAR(with[i].mean[1], E, 4.0 * sqrt(variance) + 1e-6 * E);
        ASSERT_NEAR(without[i].mean[1], E, 4.0 * sqrt(met_variance) + 1e-6 * E);
        ASSERT_NEAR(with[i].mean[0], 2.0 * (double)with[i].mean[1], 1e-6 * E);
        ASSERT_NEAR(with[i].mean[2], 0.5 * (double)with[i].mean[1], 1e-6 * E);
        worst = fmax(worst, fabs(error) / (ALPI_PI * largest));
    }
    ASSERT_NEAR(worst, 0.0, 1e-3);
    ASSERT_NEAR(met, E, 4.0 * sqrt(met_variance / PLACINGS) + 1e-6 * E);
    printf("accuracy: %s, F = %.4f, 8 azimuths: largest error %.1e, met by chance "
           "%+.1e\n",
           f->name, exact, worst, met / E - 1.0);
}

// --- closed forms --------------------------------------------------------------------------------

enum { RIM = 256 };

/// Oracle 5, over the middle and beside it. The polygon of 256 corners has the circle's area: what
/// its rim leaves out and adds cancels to (2π/256)²/10 = 6e-5 of it or better.
TEST(a_disk)
{
    const double h = 1.5, step = 2.0 * ALPI_PI / RIM, even = sqrt(step / sin(step));
    for (int k = 0; k < 2; k++) {
        const double a = k == 0 ? 0.0 : 2.0;
        vec3 corners[RIM];
        for (int i = 0; i < RIM; i++) {
            corners[i] =
                (vec3){(float)(a + even * cos(step * i)), (float)h, (float)(even * sin(step * i))};
        }
        const figure f = polygon(k == 0 ? "disk over its middle" : "disk aside", corners, RIM);
        double exact = 1.0 / (1.0 + h * h);
        if (k > 0) {
            const double H = h / a, P = 1.0 / a, Z = 1.0 + H * H + P * P;
            exact = (1.0 - (1.0 + H * H - P * P) / sqrt(Z * Z - 4.0 * P * P)) / 2.0;
        }
        ASSERT_NEAR(form_factor(&f), exact, 6e-5 * exact);
        check(&f, form_factor(&f), 1.0 / (1.0 + h * h), PATHS);
    }
}

/// Oracle 6: over its corner, and a wall that begins at the foot of its own.
TEST(a_rectangle_and_a_wall)
{
    const vec3 over[4] = {{0, 1, 0}, {3, 1, 0}, {3, 1, 2.5f}, {0, 1, 2.5f}};
    const figure rectangle = polygon("rectangle over its corner", over, 4);
    const double A = 3.0, B = 2.5, sa = sqrt(1.0 + A * A), sb = sqrt(1.0 + B * B);
    const double parallel = (A / sa * atan(B / sa) + B / sb * atan(A / sb)) / (2.0 * ALPI_PI);
    check(&rectangle, parallel, parallel, 2 * PATHS);
    const double X = 3.0, H = 2.5, s = sqrt(1.0 + H * H);
    const vec3 upright[4] = {{0, 0, 1}, {0, 2.5f, 1}, {3, 2.5f, 1}, {3, 0, 1}};
    const figure wall = polygon("wall from the foot of its corner", upright, 4);
    const double upright_factor = (atan(X) - atan(X / s) / s) / (2.0 * ALPI_PI);
    check(&wall, upright_factor, parallel, MANY_PATHS);
}

enum { SLICES = 80, STACKS = 40 };

/// Facets about the sphere, as large in surface: by Cauchy their outline then is as large as the
/// sphere's on the average over directions.
static figure sphere(const char *name, double x, double y, double radius)
{
    test_mesh *mesh = NULL;
    double scale = 1.0;
    for (int pass = 0; pass < 2; pass++) {
        double area = 0.0;
        mesh = test_mesh_start();
        test_mesh_sphere(mesh, (double[]){x, y, 0.0}, radius * scale, SLICES, STACKS, 1.0, 1);
        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            for (int k = 0; k < 3; k++) {
                store[t][k] = vec3_load(mesh->positions[mesh->triangles[t][k]]);
            }
            area += vec3_triangle_area(store[t][0], store[t][1], store[t][2]);
        }
        scale *= sqrt(4.0 * ALPI_PI * radius * radius / area);
    }
    return (figure){name, store, mesh->triangle_count};
}

/// Oracle 4: from straight above down to where it touches the horizon, and resting on the plane.
/// The facets are within 1e-3 of the sphere (the square of half a facet's angle, π/80).
TEST(a_sphere)
{
    static const double elevations[] = {90.0, 45.0, 15.0};
    const double radius = 0.5, distance = 2.0;
    const figure resting = sphere("sphere on the plane", 0.8, radius, radius);
    const double largest = pow(radius, 3.0) / pow(0.8 * 0.8 + radius * radius, 1.5);
    ASSERT_NEAR(form_factor(&resting), largest, 1e-3 * largest);
    check(&resting, form_factor(&resting), largest, MANY_PATHS);
    for (int i = 0; i < 3; i++) {
        const double angle = elevations[i] * ALPI_PI / 180.0;
        char name[64];
        snprintf(name, sizeof name, "sphere at %.0f degrees", elevations[i]);
        const figure f = sphere(name, distance * cos(angle), distance * sin(angle), radius);
        const double exact = sin(angle) * radius * radius / (distance * distance);
        ASSERT_NEAR(form_factor(&f), exact, 1e-3 * exact);
        check(&f, form_factor(&f), largest, PATHS);
    }
}

/// Oracle 11: a pentagon that is turned through the horizon until little of it is left.
TEST(a_polygon_through_the_horizon)
{
    static const vec3 flat[5] = {
        {-0.9f, 0, 0.1f}, {-0.3f, 0, -0.8f}, {0.7f, 0, -0.6f}, {1.0f, 0, 0.4f}, {0.1f, 0, 0.9f}};
    double before = 1.0, largest = 0.0;
    for (int i = 0; i < 5; i++) {
        const double tilt = 25.0 * i * ALPI_PI / 180.0 + 0.05;
        vec3 corners[5];
        for (int k = 0; k < 5; k++) { // 1.2 m away, facing back
            const double x = (double)flat[k].x, z = (double)flat[k].z, c = cos(tilt), s = sin(tilt);
            corners[k] = (vec3){(float)(1.2 * s + x * c), (float)(1.2 * c - x * s), (float)z};
        }
        char name[64];
        snprintf(name, sizeof name, "pentagon %.0f degrees from the normal",
                 tilt * 180.0 / ALPI_PI);
        const figure f = polygon(name, corners, 5);
        const double exact = form_factor(&f);
        assert_true(exact > 0.001 && exact < before);
        before = exact;
        largest = fmax(largest, exact);
        check(&f, exact, largest, i < 2 ? 2 * PATHS : MANY_PATHS);
    }
}

/// An L: concave, in four triangles; and its back, which is dark whichever way light is found.
TEST(a_concave_polygon_and_its_back)
{
    const vec3 c[6] = {{0, 1, 0},       {1, 1, 0},    {1, 1, 0.4f},
                       {0.4f, 1, 0.4f}, {0.4f, 1, 1}, {0, 1, 1}};
    static const int parts[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    double whole[6][3];
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            store[i][k] = c[parts[i][k]];
        }
    }
    for (int i = 0; i < 6; i++) {
        whole[i][0] = (double)c[i].x;
        whole[i][1] = (double)c[i].y;
        whole[i][2] = (double)c[i].z;
    }
    const figure f = {"polygon like an L", store, 4};
    const double exact = test_polygon_form_factor((double[]){0, 0, 0}, (double[]){0, 1, 0},
                                                  (const double(*)[3])whole, 6);
    check(&f, exact, exact, MANY_PATHS);
    for (int i = 0; i < 4; i++) {
        const vec3 swap = store[i][1];
        store[i][1] = store[i][2];
        store[i][2] = swap;
    }
    for (uint32_t i = 0; i < PLACINGS; i++) {
        const placing p = place(i);
        test_lit lit = light_figure(&f, &p);
        alpi_reference r = test_lit_reference(&lit, 4, 256);
        ASSERT_NEAR(test_lit_point(&r, p.at, p.y).mean[1], 0.0, 0.0);
        r.next_event = false;
        ASSERT_NEAR(test_lit_point(&r, p.at, p.y).mean[1], 0.0, 0.0);
        test_lit_close(&lit);
    }
}
