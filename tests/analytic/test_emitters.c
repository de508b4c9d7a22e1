// SPDX-License-Identifier: MIT
// Emissive triangles that nothing hides, against closed forms: irradiance is π L F.
#include "test_lights.h"

#include "base/image.h"
#include "base/memory.h"
#include "scene/lights/polygon_light.h"

#include <math.h>
#include <stdlib.h>

static const vec3 ORIGIN = {0, 0, 0}, UP = {0, 1, 0};

typedef struct stage {
    alp_context *context;
    alp_scene *scene;
    alpi_lighting *lighting;
} stage;

static stage start(const vec3 (*triangles)[3], uint32_t count, vec3 emission)
{
    stage s = {.context = test_context(1)};
    s.scene = test_emitter_scene(s.context, triangles, count, emission);
    ASSERT_OK(s.context, alpi_lighting_create(s.scene, NULL, &s.lighting));
    assert_int_equal(alpi_lighting_emitter_count(s.lighting), count);
    return s;
}

static void finish(stage *s)
{
    alpi_lighting_destroy(s->context, s->lighting);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

/// Turned by `angle` about the y axis.
static vec3 turned(vec3 p, double angle)
{
    double c = cos(angle), s = sin(angle);
    return (vec3){(float)(c * (double)p.x + s * (double)p.z), p.y,
                  (float)(c * (double)p.z - s * (double)p.x)};
}

/// Σ of what each triangle gives on its front.
static double closed_form(const vec3 (*triangles)[3], uint32_t count, vec3 point, vec3 normal)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        sum += ALPI_PI * fmax(alpi_polygon_form_factor(point, normal, triangles[i], 3), 0.0);
    }
    return sum;
}

TEST(one_triangle_from_any_side)
{
    for (int i = 0; i < 8; i++) {
        double angle = ALPI_PI / 4.0 * i + 0.1;
        // Above and beside, partly below the horizon of `tilted`.
        const vec3 triangle[1][3] = {{turned((vec3){1.0f, 0.8f, -0.5f}, angle),
                                      turned((vec3){1.2f, 1.0f, 0.9f}, angle),
                                      turned((vec3){0.2f, 1.6f, 0.0f}, angle)}};
        const vec3 tilted = turned((vec3){-0.6f, 0.48f, 0.64f}, angle);
        stage s = start(triangle, 1, (vec3){2, 1, 1});
        double expected = 2.0 * closed_form(triangle, 1, ORIGIN, UP);
        assert_true(expected > 0.1);
        test_estimate e = test_light_estimate(s.lighting, ORIGIN, UP, 200000, 1);
        ASSERT_ESTIMATE(e, expected);
        ASSERT_NEAR(e.error / expected, 0.0, 1e-3); // so the check above is one to 0.4 %
        ASSERT_ESTIMATE(test_light_estimate(s.lighting, ORIGIN, tilted, 200000, 2),
                        2.0 * closed_form(triangle, 1, ORIGIN, tilted));
        finish(&s);
    }
}

TEST(a_rectangle_is_two_triangles)
{
    // Over its corner (oracle 6), clipped where it dips below the horizon, and seen from behind.
    const vec3 lamp[2][3] = {{{0, 2, 0}, {1.5f, 2, 0}, {1.5f, 2, 0.7f}},
                             {{0, 2, 0}, {1.5f, 2, 0.7f}, {0, 2, 0.7f}}};
    stage s = start(lamp, 2, (vec3){3, 3, 3});
    double x = 0.75, y = 0.35;
    double f = (x / sqrt(1 + x * x) * atan(y / sqrt(1 + x * x)) +
                y / sqrt(1 + y * y) * atan(x / sqrt(1 + y * y))) /
               (2.0 * ALPI_PI);
    ASSERT_ESTIMATE(test_light_estimate(s.lighting, ORIGIN, UP, 200000, 2), 3.0 * ALPI_PI * f);
    const vec3 tilted = vec3_normalize_or((vec3){0.9f, -0.2f, 0.0f}, UP);
    double clipped = 3.0 * closed_form(lamp, 2, ORIGIN, tilted);
    assert_true(clipped > 0.01);
    ASSERT_ESTIMATE(test_light_estimate(s.lighting, ORIGIN, tilted, 200000, 3), clipped);
    ASSERT_NEAR(test_light_estimate(s.lighting, (vec3){0, 3, 0}, (vec3){0, -1, 0}, 1000, 4).mean,
                0.0, 0.0);
    s.scene->materials[0].double_sided = true;
    alpi_lighting_destroy(s.context, s.lighting);
    ASSERT_OK(s.context, alpi_lighting_create(s.scene, NULL, &s.lighting));
    ASSERT_ESTIMATE(test_light_estimate(s.lighting, (vec3){0, 4, 0}, (vec3){0, -1, 0}, 200000, 5),
                    3.0 * ALPI_PI * f);
    finish(&s);
}

enum { CORNERS = 64 };

/// A polygon of 64 corners about (a, h, 0), facing down.
static void make_disk(vec3 triangles[CORNERS][3], double a, double h, double radius)
{
    for (int i = 0; i < CORNERS; i++) {
        double from = 2.0 * ALPI_PI * i / CORNERS, to = 2.0 * ALPI_PI * (i + 1) / CORNERS;
        triangles[i][0] = (vec3){(float)a, (float)h, 0};
        triangles[i][1] =
            (vec3){(float)(a + radius * cos(from)), (float)h, (float)(radius * sin(from))};
        triangles[i][2] =
            (vec3){(float)(a + radius * cos(to)), (float)h, (float)(radius * sin(to))};
    }
}

TEST(a_disk_of_64_corners)
{
    static vec3 disk[CORNERS][3];
    // The polygon's area is sin(2π/64)/(2π/64) of the circle's: a radius larger by half of that has
    // its area; what is left at the rim cancels to 1e-4.
    const double even = 1.0 / sqrt(sin(2.0 * ALPI_PI / CORNERS) / (2.0 * ALPI_PI / CORNERS));
    for (int k = 0; k < 2; k++) {
        const double radius = 1.0, h = 1.5, a = k == 0 ? 0.0 : 2.0;
        make_disk(disk, a, h, radius * even);
        stage s = start((const vec3(*)[3])disk, CORNERS, (vec3){1, 1, 1});
        double f = radius * radius / (radius * radius + h * h); // oracle 5
        if (k > 0) {
            double height = h / a, p = radius / a, z = 1 + height * height + p * p;
            f = (1 - (1 + height * height - p * p) / sqrt(z * z - 4 * p * p)) / 2;
        }
        test_estimate e = test_light_estimate(s.lighting, ORIGIN, UP, 200000, 6);
        ASSERT_NEAR(e.mean, ALPI_PI * f, 4.0 * e.error + 1e-4 * ALPI_PI * f);
        ASSERT_ESTIMATE(e, closed_form((const vec3(*)[3])disk, CORNERS, ORIGIN, UP));
        finish(&s);
    }
}

/// Two lamps, one of 4,000 times the power, far away, one weak and near.
TEST(a_strong_and_a_weak_lamp)
{
    const vec3 lamps[2][3] = {{{0, 1, 0}, {0.1f, 1, 0}, {0, 1, 0.1f}},
                              {{20, 30, 0}, {21, 30, 0}, {20, 30, 1}}};
    stage s = start(lamps, 2, (vec3){1, 1, 1});
    s.scene->surfaces[0].triangle_count = 1;
    // A material of its own for the second.
    alpi_material *materials = ALPI_NEW(s.context, alpi_material, 2);
    alpi_surface *surfaces = ALPI_NEW(s.context, alpi_surface, 2);
    materials[0] = materials[1] = s.scene->materials[0];
    materials[1].name = alpi_copy_string(s.context, "strong");
    for (int k = 0; k < 3; k++) {
        materials[1].emission[k] = 40.0f;
    }
    surfaces[0] = surfaces[1] = s.scene->surfaces[0];
    surfaces[1].name = alpi_copy_string(s.context, "strong");
    surfaces[1].first_triangle = 1;
    surfaces[1].material = 1;
    alpi_release(s.context, s.scene->materials);
    alpi_release(s.context, s.scene->surfaces);
    s.scene->materials = materials;
    s.scene->surfaces = surfaces;
    s.scene->material_count = s.scene->surface_count = 2;
    s.scene->triangle_surface[1] = 1;
    alpi_lighting_destroy(s.context, s.lighting);
    ASSERT_OK(s.context, alpi_lighting_create(s.scene, NULL, &s.lighting));
    double weak = closed_form(&lamps[0], 1, ORIGIN, UP);
    double strong = 40.0 * closed_form(&lamps[1], 1, ORIGIN, UP);
    test_estimate e = test_light_estimate(s.lighting, ORIGIN, UP, 200000, 7);
    ASSERT_ESTIMATE(e, weak + strong);
    // Drawn evenly it would be 0.35 of the mean, by power alone 20.
    print_message("strong/weak %.1f, standard deviation of a draw %.3f of the mean\n",
                  strong / weak, sqrt(e.variance) / e.mean);
    ASSERT_NEAR(sqrt(e.variance) / e.mean, 0.0, 0.1);
    finish(&s);
}

/// A picture of black and white squares, 8 × 8, over a triangle.
TEST(a_texture_is_as_its_sum)
{
    const vec3 lamp[1][3] = {{{-1, 1, -1}, {2, 1.2f, -1}, {-1, 1, 2}}};
    stage s = start(lamp, 1, (vec3){5, 5, 5});
    enum { SIDE = 8, CUTS = 1024 };
    s.scene->images = ALPI_NEW(s.context, alp_image *, 1);
    s.scene->image_count = 1;
    ASSERT_OK(s.context,
              alp_image_create(s.context, (alp_image_info){SIDE, SIDE, 3, ALP_COMPONENT_U8},
                               &s.scene->images[0]));
    uint8_t *pixels = alp_image_bytes(s.scene->images[0]);
    for (int i = 0; i < SIDE * SIDE * 3; i++) {
        int x = i / 3 % SIDE, y = i / 3 / SIDE;
        pixels[i] = x + y > 10 ? 255 : (x ^ y) & 1 ? 188 : 0; // most of it beyond the triangle
    }
    s.scene->uvs[0] = alpi_allocate(s.context, 3, sizeof(float[2]));
    s.scene->uvs[0][1][0] = s.scene->uvs[0][2][1] = 1.0f;
    s.scene->materials[0].emission_texture.image = 0;
    alpi_lighting_destroy(s.context, s.lighting);
    ASSERT_OK(s.context, alpi_lighting_create(s.scene, NULL, &s.lighting));
    double sum = 0.0, area = vec3_triangle_area(lamp[0][0], lamp[0][1], lamp[0][2]);
    vec3 front = vec3_triangle_normal(lamp[0][0], lamp[0][1], lamp[0][2], UP);
    for (int i = 0; i < CUTS * CUTS; i++) {
        float x = ((float)(i % CUTS) + 0.5f) / CUTS, y = ((float)(i / CUTS) + 0.5f) / CUTS;
        float b1 = x + y < 1.0f ? x : 1.0f - x, b2 = x + y < 1.0f ? y : 1.0f - y; // folded square
        vec3 p = vec3_mad(vec3_mad(lamp[0][0], b1, vec3_sub(lamp[0][1], lamp[0][0])), b2,
                          vec3_sub(lamp[0][2], lamp[0][0]));
        double d2 = (double)vec3_dot(p, p);
        vec3 l = alpi_surface_emission(s.scene, 0, b1, b2, vec3_scale(p, -1.0f));
        sum += (double)l.x * (double)p.y * -(double)vec3_dot(front, p) / (d2 * d2);
    }
    test_estimate e = test_light_estimate(s.lighting, ORIGIN, UP, 400000, 8);
    double expected = sum * area / (CUTS * CUTS);
    // A direct sum over a million cells of a continuous picture: better than 1e-5.
    ASSERT_NEAR(e.mean, expected, 4.0 * e.error + 1e-4 * expected);
    finish(&s);
}

/// A picture 64 wide of which one texel shines, on 2 of 200 triangles: looks at 16 places miss it,
/// and the 190 that are far from it are no lights.
TEST_SLOW(a_spark_is_found_and_darkness_left_out)
{
    enum { PIECES = 200, SIDE = 64 };
    static vec3 strip[PIECES][3];
    for (int i = 0; i < PIECES; i++) {
        float x = (float)(i / 2) - 50.0f;
        const vec3 a = {x, 4, -1}, b = {x + 1, 4, -1}, c = {x + 1, 4, 1}, d = {x, 4, 1};
        const vec3 both[2][3] = {{a, b, c}, {a, c, d}};
        memcpy(strip[i], both[i % 2], sizeof both[0]);
    }
    stage s = start((const vec3(*)[3])strip, PIECES, (vec3){100, 100, 100});
    s.scene->images = ALPI_NEW(s.context, alp_image *, 1);
    s.scene->image_count = 1;
    ASSERT_OK(s.context,
              alp_image_create(s.context, (alp_image_info){SIDE, SIDE, 3, ALP_COMPONENT_U8},
                               &s.scene->images[0]));
    memset(alp_image_bytes(s.scene->images[0]), 0, SIDE * SIDE * 3);
    memset((uint8_t *)alp_image_bytes(s.scene->images[0]) + ((ptrdiff_t)33 * SIDE + 32) * 3, 255,
           3);
    s.scene->uvs[0] = alpi_allocate(s.context, (size_t)3 * PIECES, sizeof(float[2]));
    double place[2] = {0}; // of the spark, on the strip
    for (int i = 0; i < PIECES; i++) {
        for (int k = 0; k < 3; k++) { // a block of 20 × 20 pieces of the picture to each
            float *uv = s.scene->uvs[0][3 * i + k];
            uv[0] = ((float)(i / 2 % 10) + strip[i][k].x - ((float)(i / 2) - 50.0f)) / 10.0f;
            uv[1] = ((float)(i / 20) + 0.5f * (strip[i][k].z + 1.0f)) / 10.0f;
        }
    }
    // Texel (32, 33): u = 32.5/64 is 5.078 pieces along, v = 33.5/64 is row 5, .234 of it.
    place[0] = 55 - 50 + 0.078125;
    place[1] = -1.0 + 2.0 * 0.234375;
    s.scene->materials[0].emission_texture.image = 0;
    alpi_lighting_destroy(s.context, s.lighting);
    ASSERT_OK(s.context, alpi_lighting_create(s.scene, NULL, &s.lighting));
    assert_in_range(alpi_lighting_emitter_count(s.lighting), 2, 10);
    test_estimate e = test_light_estimate(s.lighting, ORIGIN, UP, 2000000, 11);
    // A texel is a tent of area 1 texel: 10/64 m × 20/64 m, small enough to be in one place, to 1 %
    // (its spread over the distance, squared).
    double d2 = place[0] * place[0] + 16.0 + place[1] * place[1];
    double expected = 100.0 * (10.0 / 64.0) * (20.0 / 64.0) * 16.0 / (d2 * d2);
    ASSERT_NEAR(e.mean, expected, 4.0 * e.error + 0.01 * expected);
    ASSERT_NEAR(e.error / expected, 0.0, 0.02);
    // All of it black is dark.
    memset(alp_image_bytes(s.scene->images[0]), 0, SIDE * SIDE * 3);
    alpi_lighting_destroy(s.context, s.lighting);
    ASSERT_OK(s.context, alpi_lighting_create(s.scene, NULL, &s.lighting));
    assert_true(alpi_lighting_is_dark(s.lighting));
    finish(&s);
}

/// 10,000 small squares in a ceiling, drawn by the hierarchy, against one lamp of the same outline
/// and power: the same light, and not much more noise.
TEST_SLOW(ten_thousand_are_as_one)
{
    enum { SIDE = 100, COUNT = SIDE * SIDE * 2 };
    vec3(*small)[3] = calloc(COUNT, sizeof *small);
    assert_non_null(small);
    const float size = 0.04f, fill = 0.5f; // 4 m wide in all
    for (int i = 0; i < SIDE * SIDE; i++) {
        float x = size * (float)(i % SIDE) - 2.0f, z = size * (float)(i / SIDE) - 2.0f;
        const vec3 a = {x, 0, z}, b = {x + fill * size, 0, z},
                   c = {x + fill * size, 0, z + fill * size}, d = {x, 0, z + fill * size};
        const vec3 both[2][3] = {{a, b, c}, {a, c, d}};
        memcpy(small[2 * (ptrdiff_t)i], both, sizeof both);
    }
    const vec3 large[2][3] = {{{-2, 0, -2}, {2, 0, -2}, {2, 0, 2}},
                              {{-2, 0, -2}, {2, 0, 2}, {-2, 0, 2}}};
    stage many = start((const vec3(*)[3])small, COUNT, (vec3){4, 4, 4});
    stage one = start(large, 2, (vec3){1, 1, 1});
    const vec3 points[] = {{0, -4, 0},       {1, -2, 0.5f},       {5, -3, 1},
                           {0.3f, -1, 0.2f}, {0.3f, -0.5f, 0.2f}, {1.3f, -0.2f, 0.2f}};
    for (int k = 0; k < 6; k++) {
        double expected = 4.0 * closed_form((const vec3(*)[3])small, COUNT, points[k], UP);
        test_estimate m = test_light_estimate(many.lighting, points[k], UP, 100000, 9);
        test_estimate o = test_light_estimate(one.lighting, points[k], UP, 100000, 9);
        ASSERT_ESTIMATE(m, expected);
        double noise = sqrt(m.variance) / m.mean, least = sqrt(o.variance) / o.mean;
        print_message("%.1f %.1f %.1f: standard deviation of a draw %.3f of the mean, of one "
                      "lamp's %.3f\n",
                      (double)points[k].x, (double)points[k].y, (double)points[k].z, noise, least);
        ASSERT_NEAR(noise * noise, 0.0, 2.0 * least * least);
    }
    finish(&many);
    finish(&one);
    free(small);
}
