// SPDX-License-Identifier: MIT
// With and without next-event estimation the path tracer gives the same means, receiver by receiver
// and on the whole: rooms with lamps, a sun and a sky through windows, open country under a clear
// sky, a court, and a picture that glows.
#include "test_lit.h"

#include "base/memory.h"
#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdio.h>

enum { POINTS = 48 };

TEST_CONTEXT(2);

static const vec3 EVERYWHERE[2] = {{-1e9f, -1e9f, -1e9f}, {1e9f, 1e9f, 1e9f}};

// --- comparing -----------------------------------------------------------------------------------

/// A light that few rays meet gives a skewed mean and, where none or one did, too small a variance:
/// Z² of one receiver was 70 in one of ten runs. No one receiver counts more than this.
static const double SQUARE_LIMIT = 16.0;

/// Receivers of which both ways say something, one channel.
typedef struct comparison {
    double squares; // Σ Z², each up to SQUARE_LIMIT
    double z;       // of the sum
    double share;   // standard error of the sum, of the mean
    uint32_t count;
} comparison;

static comparison compare_channel(const alpi_reference_value *with,
                                  const alpi_reference_value *without, int k)
{
    comparison c = {.count = 0};
    double apart = 0.0, variance = 0.0, mean = 0.0;
    for (uint32_t i = 0; i < POINTS; i++) {
        const double a = (double)with[i].mean[k], b = (double)without[i].mean[k];
        const double v = (double)with[i].variance[k] + (double)without[i].variance[k];
        if (v > 0.0) {
            c.squares += fmin((a - b) * (a - b) / v, SQUARE_LIMIT);
            c.count++;
        } else { // inside of something both are dark
            ASSERT_NEAR(a, b, 0.0);
        }
        apart += a - b;
        variance += v;
        mean += a;
    }
    c.z = apart / sqrt(variance);
    c.share = sqrt(variance) / mean;
    return c;
}

/// Σ Z² of n receivers is at most its mean and 4 of its standard deviations: with 16 replicates to
/// tell a variance Z² is Fisher's F(1, 15) at worst, of mean 15/13 and variance 3.39. It is at
/// least 4 deviations below the n of χ², which it would be with a true variance, or the two ways
/// share random numbers. On the whole the two are within 4 standard errors, which are 2 % of the
/// mean at most, so that a difference of 8 % could not hide.
static void hold_alike(const comparison *c)
{
    const double n = (double)c->count;
    assert_true(c->count >= POINTS / 2);
    ASSERT_NEAR(fmax(c->squares - 15.0 / 13.0 * n, 0.0), 0.0, 4.0 * sqrt(3.39 * n));
    ASSERT_NEAR(fmax(n - c->squares, 0.0), 0.0, 4.0 * sqrt(2.0 * n));
    ASSERT_NEAR(c->z, 0.0, 4.0);
    ASSERT_NEAR(c->share, 0.0, 0.02);
}

/// Takes the scene over. At points anywhere in the box.
static void compare(const char *name, alp_scene *scene, const alp_lighting_options *options,
                    const vec3 box[2], uint32_t samples)
{
    static vec3 positions[POINTS], normals[POINTS];
    static alpi_reference_value with[POINTS], without[POINTS];
    test_lit lit = test_lit_open(scene, options);
    const vec3 size = vec3_sub(scene->bounds_max, scene->bounds_min);
    const float offset = 4e-7f * (size.x + size.y + size.z);
    test_lit_scatter(scene, box[0], box[1], POINTS, positions, normals);
    alpi_reference r = test_lit_reference(&lit, 6, samples);
    test_lit_irradiance(&r, positions, normals, offset, POINTS, with);
    r.next_event = false;
    r.seed = 2;
    r.samples = 4 * samples; // it is the noisier way
    test_lit_irradiance(&r, positions, normals, offset, POINTS, without);
    test_lit_close(&lit);
    for (int k = 0; k < 3; k++) {
        const comparison c = compare_channel(with, without, k);
        if (k == 1) {
            printf("accuracy: with against without next-event estimation, %s: chi2 %.0f of %u, "
                   "Z = %+.2f\n",
                   name, c.squares, c.count, c.z);
        }
        hold_alike(&c);
    }
}

// --- scenes --------------------------------------------------------------------------------------

TEST(rooms_with_lamps)
{
    compare("builtin:cornell", test_load(context, "builtin:cornell"), NULL, EVERYWHERE, 1024);
    compare("builtin:furnace", test_load(context, "builtin:furnace"), NULL, EVERYWHERE, 1024);
    const vec3 room[2] = {{-2.0f, 0.0f, -2.0f}, {2.0f, 2.7f, 2.0f}};
    compare("builtin:teapot-room", test_load(context, "builtin:teapot-room"), NULL, room, 1024);
}

/// The small sun of the scene is met by one ray in 10,000: one that is 40° wide takes its place.
TEST(a_sun_and_a_sky_through_windows)
{
    alp_scene *scene = test_load(context, "builtin:windows");
    alp_lighting_options o = alp_lighting_options_default();
    for (uint32_t i = 0; i < scene->material_count; i++) {
        memset(scene->materials[i].emission, 0, sizeof scene->materials[i].emission);
    }
    o.sky.kind = ALP_SKY_HEMISPHERE;
    o.sky.up[2] = 2.0f;
    o.sky.down[0] = 0.5f;
    o.sun.azimuth = (float)(205.0 * ALPI_PI / 180.0);
    o.sun.elevation = (float)(33.0 * ALPI_PI / 180.0);
    o.sun.illuminance = 15.0f;
    o.sun.size = (float)(40.0 * ALPI_PI / 180.0);
    const vec3 room[2] = {{-4.0f, 0.0f, -3.0f}, {4.0f, 4.0f, 3.0f}};
    compare("builtin:windows", scene, &o, room, 2048);
}

TEST(a_clear_sky_over_open_country_and_a_court)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_CLEAR;
    o.sun.azimuth = 1.0f;
    o.sun.elevation = 0.7f;
    o.sun.illuminance = 40000.0f;
    o.sun.size = 0.5f;
    const vec3 above[2] = {{-100.0f, -1.0f, -100.0f}, {100.0f, 100.0f, 100.0f}};
    compare("builtin:terrain", test_load(context, "builtin:terrain,triangles=5000"), &o, above,
            1024);
    compare("builtin:atrium", test_load(context, "builtin:atrium,triangles=20000"), &o, EVERYWHERE,
            1024);
}

/// A room whose one wall shows a picture of 8 × 8 texels, most of them black, each channel
/// another's.
TEST(a_picture_that_glows)
{
    enum { SIDE = 8 };
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 high = {1, 1, 1}, low = {0, 0, 0};
    alpi_builder_start(&b, context, "picture");
    alpi_builder_surface(&b, "walls",
                         alpi_builder_material(&b, "walls", (vec3){0.6f, 0.7f, 0.5f}, low));
    alpi_builder_box(&b, high, low, ALPI_FACE_ALL & ~(unsigned)ALPI_FACE_LEFT);
    alpi_builder_surface(&b, "picture",
                         alpi_builder_material(&b, "picture", low, (vec3){4.0f, 4.0f, 4.0f}));
    alpi_builder_box(&b, high, low, ALPI_FACE_LEFT);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    scene->images = ALPI_NEW(context, alp_image *, 1);
    scene->image_count = 1;
    ASSERT_OK(context, alp_image_create(context, (alp_image_info){SIDE, SIDE, 3, ALP_COMPONENT_U8},
                                        &scene->images[0]));
    uint8_t *pixels = alp_image_bytes(scene->images[0]);
    for (int i = 0; i < SIDE * SIDE * 3; i++) {
        const int x = i / 3 % SIDE, y = i / 3 / SIDE;
        pixels[i] = (x * 3 + y * 5) % 7 == i % 3 ? 255 : 0;
    }
    scene->uvs[0] = alpi_allocate(context, scene->vertex_count, sizeof(float[2]));
    assert_non_null(scene->uvs[0]);
    for (uint32_t i = 0; i < scene->vertex_count; i++) {
        scene->uvs[0][i][0] = scene->positions[i][2];
        scene->uvs[0][i][1] = scene->positions[i][1];
    }
    scene->materials[1].emission_texture.image = 0;
    compare("a picture that glows", scene, NULL, EVERYWHERE, 1024);
}

/// A coarse ball of smooth normals that glows: from where its normals look below its facets, it
/// would light itself. It is convex, so that no bounce brings anything.
TEST(a_smooth_ball_does_not_light_itself)
{
    enum { PATHS = 1 << 14 };
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "ball");
    alpi_builder_surface(
        &b, "ball", alpi_builder_material(&b, "glow", (vec3){0.9f, 0.9f, 0.9f}, (vec3){1, 1, 1}));
    alpi_builder_ball(&b, &(alpi_ball){{0, 2, 0}, 1.0f, 1.0f, 8, 4, false});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    test_lit lit = test_lit_open(scene, NULL);
    for (int next_event = 0; next_event < 2; next_event++) {
        alpi_reference bounced = test_lit_reference(&lit, 8, PATHS), direct = bounced;
        bounced.next_event = direct.next_event = next_event == 1;
        direct.bounces = 0;
        const vec3 origin = {0, 0, 0}, up = {0, 1, 0};
        const alpi_reference_value all = test_lit_point(&bounced, origin, up);
        const alpi_reference_value first = test_lit_point(&direct, origin, up);
        assert_true(first.mean[0] > 0.5f);            // π/4 for a round one
        ASSERT_NEAR(all.mean[0], first.mean[0], 0.0); // by the same paths
    }
    test_lit_close(&lit);
}
