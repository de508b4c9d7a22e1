// SPDX-License-Identifier: MIT
// Light that goes to and fro, through the path tracer, against what is known of it: two plates, the
// integrating sphere, the cube with a glowing ceiling, and means over closed rooms, which are taken
// evenly over whole surfaces.
#include "test_lit.h"
#include "test_scenes.h"

#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdio.h>

TEST_CONTEXT(2);

/// As seldom as 4 standard errors where 16 replicates measure the spread (Student's t).
static const double STANDARD_ERRORS = 5.5;

static uint32_t grey(alpi_builder *b, const char *name, double albedo, double emission)
{
    const float a = (float)albedo, e = (float)emission;
    return alpi_builder_material(b, name, (vec3){a, a, a}, (vec3){e, e, e});
}

static double error_of(const alpi_reference_value *v)
{
    return sqrt((double)v->variance[1]);
}

// --- plates --------------------------------------------------------------------------------------

/// Two plates a metre apart, 2 R wide.
static alp_scene *make_plates(double R, const double albedo[2], const double exitance[2])
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const float r = (float)R;
    alpi_builder_start(&b, context, "plates");
    alpi_builder_surface(&b, "lower", grey(&b, "lower", albedo[0], exitance[0] / ALPI_PI));
    alpi_builder_quad(&b, (const vec3[4]){{-r, 0, r}, {r, 0, r}, {r, 0, -r}, {-r, 0, -r}});
    alpi_builder_surface(&b, "upper", grey(&b, "upper", albedo[1], exitance[1] / ALPI_PI));
    alpi_builder_quad(&b, (const vec3[4]){{-r, 1, -r}, {r, 1, -r}, {r, 1, r}, {-r, 1, r}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// Oracle 13: B1 = (M1 + ρ1 M2) / (1 − ρ1 ρ2), which makes E1 = (M2 + ρ2 M1) / (1 − ρ1 ρ2); after n
/// bounces the first n + 1 terms of that. Beyond 500 m there is 1/500² = 4e-6 of the hemisphere, at
/// each way to and fro; the longest row here has ten that count.
TEST(two_plates)
{
    static const double albedos[3][2] = {{0.5, 0.8}, {0.2, 0.9}, {0.0, 0.7}};
    static const double exitances[3][2] = {{1.0, 3.0}, {2.0, 0.0}, {1.0, 1.0}};
    static const uint32_t bounces[] = {0, 1, 2, 3, ALPI_REFERENCE_BOUNCE_LIMIT};
    double worst = 0.0;
    for (int i = 0; i < 3; i++) {
        test_lit lit = test_lit_open(make_plates(500.0, albedos[i], exitances[i]), NULL);
        for (int n = 0; n < 5; n++) {
            double exact = 0.0, through = 1.0; // seen from the lower one: upper, lower, upper …
            for (uint32_t k = 0; k <= bounces[n] && k < 200; k++) {
                exact += through * exitances[i][(k + 1) % 2];
                through *= albedos[i][(k + 1) % 2];
            }
            if (n == 4) {
                const double *a = albedos[i], *m = exitances[i];
                ASSERT_NEAR(exact, (m[1] + a[1] * m[0]) / (1.0 - a[0] * a[1]), 1e-12);
            }
            for (int k = 0; k < 2; k++) {
                alpi_reference r = test_lit_reference(&lit, bounces[n], 32768);
                r.next_event = k == 0;
                const alpi_reference_value v =
                    test_lit_point(&r, (vec3){0.2f, 0, 0.3f}, (vec3){0, 1, 0});
                ASSERT_NEAR(v.mean[1], exact, STANDARD_ERRORS * error_of(&v) + 5e-5 * exact);
                assert_true(error_of(&v) <= 2e-3 * fmax(exact, 1.0));
                worst = fmax(worst, fabs((double)v.mean[1] - exact) / fmax(exact, 1.0));
            }
        }
        test_lit_close(&lit);
    }
    printf("accuracy: two plates, 3 pairs x 5 numbers of bounces: largest error %.1e\n", worst);
}

// --- the integrating sphere ----------------------------------------------------------------------

enum { SLICES = 96, STACKS = 48 };

/// A sphere of facets, seen from inside, r = 1; its lowest `glowing` rows are a surface of their
/// own that emits radiance 1 (0: there is none).
static alp_scene *make_sphere(double albedo, int glowing)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0, 0, 0}, 1.0, SLICES, STACKS, 1.0, 0);
    alpi_builder_start(&b, context, "sphere");
    const double edge = -cos(ALPI_PI * glowing / STACKS) + 1e-6;
    for (int part = 0; part < 2; part++) {
        alpi_builder_surface(&b, part == 0 ? "wall" : "lamp",
                             grey(&b, part == 0 ? "wall" : "lamp", albedo, part));
        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            vec3 c[3];
            double top = -2.0;
            for (int k = 0; k < 3; k++) {
                c[k] = vec3_load(mesh->positions[mesh->triangles[t][k]]);
                top = fmax(top, (double)c[k].y);
            }
            if ((glowing > 0 && top < edge) == (part == 1)) {
                const vec3 n = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0, 1, 0});
                const uint32_t a = alpi_builder_vertex(&b, c[0], n);
                alpi_builder_vertex(&b, c[1], n);
                alpi_builder_vertex(&b, c[2], n);
                alpi_builder_triangle(&b, a, a + 1, a + 2);
            }
        }
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// The middle of a facet of surface 0, and its normal.
static void facet(const alp_scene *scene, uint32_t i, vec3 *position, vec3 *normal)
{
    const alpi_surface *s = &scene->surfaces[0];
    vec3 c[3];
    alpi_triangle_corners(scene, s->first_triangle + i % s->triangle_count, c);
    *position = vec3_scale(vec3_add(vec3_add(c[0], c[1]), c[2]), 1.0f / 3.0f);
    *normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0, 1, 0});
}

/// What the facets stand off: their area is smaller than the sphere's by 1.3e-3 (n² π²/6 of them),
/// and E between neighbours varies by as much again.
static const double FACETS = 4e-3;

/// Oracle 15: a lamp of flux Φ = 4π I in the middle. Directly I/r² at the facet; indirectly
/// Φ ρ / ((1 − ρ) 4π r²) everywhere. Over all facets the mean is Φ / ((1 − ρ) A), exactly.
TEST(a_lamp_in_a_sphere)
{
    static const double albedos[] = {0.5, 0.8};
    for (int i = 0; i < 2; i++) {
        const double rho = albedos[i], intensity = 2.0;
        alp_scene *scene = make_sphere(rho, 0);
        test_lit_set_lamps(scene,
                           &(alpi_light){.kind = ALP_LIGHT_POINT,
                                         .color = {1, 1, 1},
                                         .intensity = (float)intensity,
                                         .range = INFINITY},
                           1);
        test_lit lit = test_lit_open(scene, NULL);
        alpi_reference r = test_lit_reference(&lit, ALPI_REFERENCE_BOUNCE_LIMIT, 65536);
        const alpi_reference_value mean = test_lit_mean(&r, ALPI_NONE);
        const double flux = 4.0 * ALPI_PI * intensity, exact = flux / ((1.0 - rho) * scene->area);
        ASSERT_NEAR(mean.mean[1], exact, STANDARD_ERRORS * error_of(&mean) + 1e-6 * exact);
        assert_true(error_of(&mean) < 1e-3 * exact);
        const double indirect = flux * rho / ((1.0 - rho) * 4.0 * ALPI_PI);
        double worst = 0.0;
        for (uint32_t k = 0; k < 3; k++) {
            vec3 p, n;
            facet(scene, 1000 + 1531 * k, &p, &n);
            r.samples = 16384;
            r.bounces = ALPI_REFERENCE_BOUNCE_LIMIT;
            const alpi_reference_value all = test_lit_point(&r, p, n);
            r.samples = 16;
            r.bounces = 0;
            const alpi_reference_value direct = test_lit_point(&r, p, n);
            const double d = (double)vec3_length(p), cosine = -(double)vec3_dot(p, n) / d;
            ASSERT_NEAR(direct.mean[1], intensity / (d * d) * cosine,
                        1e-5 * intensity); // rays start 1e-6 above
            const double apart = (double)all.mean[1] - (double)direct.mean[1] - indirect;
            ASSERT_NEAR(apart, 0.0, STANDARD_ERRORS * error_of(&all) + FACETS * indirect);
            assert_true(error_of(&all) < 3e-3 * indirect);
            worst = fmax(worst, fabs(apart / indirect));
        }
        printf("accuracy: integrating sphere, albedo %.1f: mean %+.1e, indirect light %.1e\n", rho,
               (double)mean.mean[1] / exact - 1.0, worst);
        test_lit_close(&lit);
    }
}

/// Form factor by oracle 11 of the facets of surface 1, which hide none of each other.
static double lamp_factor(const alp_scene *scene, vec3 position, vec3 normal)
{
    const double p[3] = {(double)position.x, (double)position.y, (double)position.z};
    const double n[3] = {(double)normal.x, (double)normal.y, (double)normal.z};
    double sum = 0.0;
    for (uint32_t t = 0; t < scene->surfaces[1].triangle_count; t++) {
        vec3 c[3];
        double corners[3][3];
        alpi_triangle_corners(scene, scene->surfaces[1].first_triangle + t, c);
        for (int k = 0; k < 3; k++) {
            corners[k][0] = (double)c[k].x;
            corners[k][1] = (double)c[k].y;
            corners[k][2] = (double)c[k].z;
        }
        sum += test_polygon_form_factor(p, n, (const double(*)[3])corners, 3);
    }
    return sum;
}

/// A part of the sphere that glows gives the same to every point of it, directly too (M F, of
/// facets nearly so): E = M F + Φ ρ / ((1 − ρ) 4π r²).
TEST(a_glowing_cap_of_a_sphere)
{
    const double rho = 0.5;
    alp_scene *scene = make_sphere(rho, 10);
    double lamp = 0.0;
    for (uint32_t t = 0; t < scene->surfaces[1].triangle_count; t++) {
        vec3 c[3];
        alpi_triangle_corners(scene, scene->surfaces[1].first_triangle + t, c);
        lamp += vec3_triangle_area(c[0], c[1], c[2]);
    }
    test_lit lit = test_lit_open(scene, NULL);
    for (int way = 0; way < 2; way++) {
        alpi_reference r = test_lit_reference(&lit, ALPI_REFERENCE_BOUNCE_LIMIT, 131072);
        r.next_event = way == 0;
        const alpi_reference_value mean = test_lit_mean(&r, ALPI_NONE);
        const double exact = ALPI_PI * lamp / ((1.0 - rho) * scene->area);
        ASSERT_NEAR(mean.mean[1], exact, STANDARD_ERRORS * error_of(&mean) + 1e-6 * exact);
        assert_true(error_of(&mean) < (way == 0 ? 2e-3 : 1e-2) * exact);
        double worst = 0.0;
        for (uint32_t k = 0; k < 3; k++) {
            vec3 p, n;
            facet(scene, 1000 + 1031 * k, &p, &n);
            r.samples = 16384;

            const alpi_reference_value v = test_lit_point(&r, p, n);
            const double direct = ALPI_PI * lamp_factor(lit.scene, p, n);
            ASSERT_NEAR(direct, (1.0 - rho) * exact, 0.02 * exact);
            const double sum = direct + rho * exact;
            ASSERT_NEAR(v.mean[1], sum, STANDARD_ERRORS * error_of(&v) + FACETS * exact);
            assert_true(error_of(&v) < (way == 0 ? 3e-3 : 2e-2) * exact);
            worst = fmax(worst, fabs((double)v.mean[1] / sum - 1.0));
        }
        printf("accuracy: glowing cap of a sphere, %s: mean %+.1e, points %.1e\n",
               way == 0 ? "asked" : "met", (double)mean.mean[1] / exact - 1.0, worst);
    }
    test_lit_close(&lit);
}

// --- boxes ---------------------------------------------------------------------------------------

enum { FLOOR = 0, WALLS = 1, CEILING = 2 };

/// The unit cube from inside, in three surfaces; with a box in it that stands in the way, or none.
static alp_scene *make_cube(double albedo, double ceiling_albedo, double ceiling_radiance, bool box)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 high = {1, 1, 1}, low = {0, 0, 0};
    alpi_builder_start(&b, context, "cube");
    const uint32_t dull = grey(&b, "dull", albedo, 0.0);
    const uint32_t top = grey(&b, "ceiling", ceiling_albedo, ceiling_radiance);
    alpi_builder_surface(&b, "floor", dull);
    alpi_builder_box(&b, high, low, ALPI_FACE_BOTTOM);
    alpi_builder_surface(&b, "walls", dull);
    alpi_builder_box(&b, high, low, ALPI_FACE_ALL & ~(unsigned)(ALPI_FACE_TOP | ALPI_FACE_BOTTOM));
    alpi_builder_surface(&b, "ceiling", top);
    alpi_builder_box(&b, high, low, ALPI_FACE_TOP);
    if (box) {
        alpi_builder_surface(&b, "box", dull);
        alpi_builder_box(&b, (vec3){0.2f, 0.3f, 0.1f}, (vec3){0.5f, 0.7f, 0.6f}, ALPI_FACE_ALL);
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// Oracle 16: ceiling M = 1 and ρ = 0, ρ = .5 elsewhere. B = ρ E is .1552 on the floor, .179 in its
/// middle and .1640 on the walls, known to the digits given; and all that is emitted is absorbed:
/// (1 − ρ) (E floor + 4 E walls) + E ceiling = 1, exactly.
TEST(a_cube_with_a_glowing_ceiling)
{
    test_lit lit = test_lit_open(make_cube(0.5, 0.0, 1.0 / ALPI_PI, false), NULL);
    alpi_reference r = test_lit_reference(&lit, ALPI_REFERENCE_BOUNCE_LIMIT, 65536);
    for (uint32_t i = 0; i < 3; i++) {
        const float *n = lit.scene->normals[lit.scene->surfaces[i].first_vertex];
        ASSERT_NEAR(n[1], i == FLOOR ? 1.0 : i == CEILING ? -1.0 : 0.0, 0.0);
    }
    const alpi_reference_value floor = test_lit_mean(&r, FLOOR);
    r.samples *= 2; // E is steep along the edges of the ceiling
    const alpi_reference_value walls = test_lit_mean(&r, WALLS);
    const alpi_reference_value ceiling = test_lit_mean(&r, CEILING);
    ASSERT_NEAR(0.5 * (double)floor.mean[1], 0.1552,
                5e-5 + 0.5 * STANDARD_ERRORS * error_of(&floor));
    ASSERT_NEAR(0.5 * (double)walls.mean[1], 0.1640,
                5e-5 + 0.5 * STANDARD_ERRORS * error_of(&walls));
    assert_true(error_of(&floor) < 6e-4 && error_of(&walls) < 6e-4 && error_of(&ceiling) < 6e-4);
    const double absorbed =
        0.5 * ((double)floor.mean[1] + 4.0 * (double)walls.mean[1]) + (double)ceiling.mean[1];
    ASSERT_NEAR(absorbed, 1.0,
                STANDARD_ERRORS *
                    sqrt(0.25 * (double)floor.variance[1] + 4.0 * (double)walls.variance[1] +
                         (double)ceiling.variance[1]));
    const alpi_reference_value middle = test_lit_point(&r, (vec3){0.5f, 0, 0.5f}, (vec3){0, 1, 0});
    ASSERT_NEAR(0.5 * (double)middle.mean[1], 0.179,
                5e-4 + 0.5 * STANDARD_ERRORS * error_of(&middle));
    assert_true(error_of(&middle) < 6e-4);
    printf("accuracy: unit cube, B of the floor %.5f, in its middle %.4f, of the walls %.5f; "
           "absorbed %.5f\n",
           0.5 * (double)floor.mean[1], 0.5 * (double)middle.mean[1], 0.5 * (double)walls.mean[1],
           absorbed);
    // Directly it is four squares ½ × ½ over their corners (oracle 6).
    const double side = 0.5, slant = sqrt(1.0 + side * side);
    const double direct = 4.0 * (2.0 * side / slant * atan(side / slant)) / (2.0 * ALPI_PI);
    r.bounces = 0;
    const alpi_reference_value seen = test_lit_point(&r, (vec3){0.5f, 0, 0.5f}, (vec3){0, 1, 0});
    ASSERT_NEAR(seen.mean[1], direct, STANDARD_ERRORS * error_of(&seen));
    assert_true(error_of(&seen) < 1e-3 * direct);
    test_lit_close(&lit);
}

/// In a closed room of one albedo the mean of E is Φ / ((1 − ρ) A): with a box in it that makes
/// shadows, lit by its ceiling and by a lamp.
TEST(the_mean_over_a_room_with_shadows)
{
    static const alpi_light lamp = {.kind = ALP_LIGHT_POINT,
                                    .color = {1, 1, 1},
                                    .intensity = 0.2f,
                                    .position = {0.8f, 0.4f, 0.3f},
                                    .range = INFINITY};
    for (int kind = 0; kind < 2; kind++) {
        const double rho = 0.7, radiance = kind == 0 ? 0.5 : 0.0;
        alp_scene *scene = make_cube(rho, rho, radiance, true);
        test_lit_set_lamps(scene, &lamp, kind == 0 ? 0 : 1);
        test_lit lit = test_lit_open(scene, NULL);
        const alpi_reference r = test_lit_reference(&lit, ALPI_REFERENCE_BOUNCE_LIMIT, 65536);
        const double flux = kind == 0 ? ALPI_PI * radiance : 4.0 * ALPI_PI * (double)lamp.intensity;
        const double exact = flux / ((1.0 - rho) * scene->area);
        const alpi_reference_value v = test_lit_mean(&r, ALPI_NONE);
        ASSERT_NEAR(v.mean[1], exact, STANDARD_ERRORS * error_of(&v));
        assert_true(error_of(&v) < 5e-3 * exact);
        printf("accuracy: mean over a room with a box, %s: %+.1e, standard error %.1e\n",
               kind == 0 ? "glowing ceiling" : "lamp", (double)v.mean[1] / exact - 1.0,
               error_of(&v) / exact);
        test_lit_close(&lit);
    }
}
