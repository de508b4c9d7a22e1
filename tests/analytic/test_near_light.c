// SPDX-License-Identifier: MIT
// Light from what is within a texel: the foot of a wall is in the shadow, and the shadow ends in
// the middle of a texel. A strip of floor along it, narrower than a texel, sees the dark half of
// that texel from close by, and little of the lit half.
#include "test_scenes.h"

#include "base/image.h"
#include "maps/lightmap.h"
#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Metres: a texel's side, the strip, the shadow's edge, and the wall.
static const double SIDE = 0.05, STRIP = 0.02, EDGE = 0.025, HEIGHT = 1.0, HALF_WIDTH = 2.0;
static const double ALBEDO = 0.8;

TEST_CONTEXT(2);

/// Half of what the strip could see is a wall that a level sun shines on, above a black box's
/// shadow. Only the wall reflects, and sees nothing that does: what the strip gets has bounced
/// once.
static alp_scene *make_wall(void)
{
    const vec3 black = {0, 0, 0}, grey = {(float)ALBEDO, (float)ALBEDO, (float)ALBEDO};
    const float x = (float)STRIP, y = (float)HEIGHT, z = (float)HALF_WIDTH;
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "wall");
    const uint32_t dark = alpi_builder_material(&b, "black", black, black);
    alpi_builder_surface(&b, "strip", dark);
    alpi_builder_quad(&b, (const vec3[4]){{0, 0, z}, {x, 0, z}, {x, 0, -z}, {0, 0, -z}});
    alpi_builder_surface(&b, "wall", alpi_builder_material(&b, "grey", grey, black));
    alpi_builder_quad(&b, (const vec3[4]){{0, 0, z}, {0, 0, -z}, {0, y, -z}, {0, y, z}});
    alpi_builder_surface(&b, "box", dark);
    alpi_builder_box(&b, (vec3){3, -1, -4}, (vec3){3.1f, (float)EDGE, 4}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

static alp_bake_options wall_options(void)
{
    alp_bake_options o = alp_bake_options_default();
    o.maps = ALP_MAP_LIGHT;
    o.light.samples = 1024;
    o.light.bounces = ALP_BOUNCES_CONVERGE;
    o.light.lighting.sun.azimuth = (float)(ALPI_PI / 2.0);
    o.light.lighting.sun.elevation = 0.0f;
    o.light.lighting.sun.illuminance = 1.0f;
    o.light.lighting.sun.size = 0.0f;
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.atlas.texels_per_metre = 1.0 / SIDE;
    return o;
}

/// Oracle 6: what a floor point at a distance d sees of a wall h high and w wide, to one side of
/// it.
static double wall_factor(double d, double h, double w)
{
    const double a = w / d, b = sqrt(1.0 + h * h / (d * d));
    return (atan(a) - atan(a / b) / b) / (2.0 * ALPI_PI);
}

/// E of the strip at z, mean over its width.
static double exact_light(double z)
{
    enum { STEPS = 64 };
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++) {
        const double d = (i + 0.5) / STEPS * STRIP;
        for (int side = -1; side <= 1; side += 2) {
            const double w = HALF_WIDTH + side * z;
            sum += wall_factor(d, HEIGHT, w) - wall_factor(d, EDGE, w);
        }
    }
    return ALBEDO * sum / STEPS;
}

/// Light of the strip's texels, their errors, and where they are; @return how many
static uint32_t bake_strip(const alp_scene *scene, const alp_bake_options *o, double found[][3])
{
    enum { CHANNEL = 1 };
    alp_lightmap *l = NULL;
    uint32_t count = 0;
    ASSERT_OK(context, alp_bake(scene, o, &l, NULL));
    const alpi_texels *t = &l->texels;
    for (uint32_t i = 0; i < t->count; i++) {
        if (scene->triangle_surface[t->triangles[i]] != 0) {
            continue;
        }
        uint32_t width = 0;
        const float *page = alp_lightmap_map_page(l, ALP_MAP_LIGHT, t->pages[i], &width, NULL);
        const size_t at = 4 * ((size_t)t->pixels[i][1] * width + t->pixels[i][0]) + CHANNEL;
        alpi_receiver_point point;
        alpi_texels_point(t, i, &point);
        if (fabs((double)point.position.z) < 0.9 * HALF_WIDTH) { // none is cut by its end
            found[count][0] = (double)page[at];
            found[count][1] = (double)l->irradiance_error_pages[t->pages[i]][at];
            found[count++][2] = (double)point.position.z;
        }
    }
    alp_lightmap_destroy(l);
    return count;
}

enum { MOST = 256 };

/// Rays that arrive farther away than a texel's side find its mean, at the foot half the light of
/// what is above. By quadrature over them, strip, foot and the way along it, that is −5.3 %; with
/// the mean for all rays it would be +72.6 %.
static const double FAR_HITS = -0.053;

TEST(the_foot_of_a_wall)
{
    static double found[MOST][3];
    alp_scene *scene = make_wall();
    const alp_bake_options o = wall_options();
    const uint32_t count = bake_strip(scene, &o, found);
    double mean = 0.0, exact = 0.0, variance = 0.0;
    assert_in_range(count, 60, MOST);
    for (uint32_t i = 0; i < count; i++) {
        const double e = (1.0 + FAR_HITS) * exact_light(found[i][2]);
        ASSERT_NEAR(found[i][0], e, 9.0 * found[i][1] + 0.01 * e);
        mean += found[i][0] / count;
        exact += e / count;
        variance += found[i][1] * found[i][1] / count / count;
    }
    printf("accuracy: at the foot of a wall, %u texels: %+.1e, standard error %.1e\n", count,
           mean / exact - 1.0, sqrt(variance) / exact);
    ASSERT_NEAR(mean, exact, 4.0 * sqrt(variance) + 0.005 * exact);
    alp_scene_destroy(scene);
}

/// The sun's place taken by a lamp of a picture, of which paths from near surfaces draw: as paths
/// of the reference find it, but for what arrives from farther away than a texel's side.
TEST(under_a_lamp_of_the_sky)
{
    enum { WIDTH = 512, ROWS = WIDTH / 2 };
    static double found[MOST][3], truth[MOST][3];
    const alp_image_info info = {WIDTH, ROWS, 3, ALP_COMPONENT_FLOAT};
    alp_image *picture = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &picture));
    memset(alp_image_floats(picture), 0, sizeof(float) * 3 * WIDTH * ROWS);
    for (uint32_t i = 0; i < 4; i++) { // about +X, at the horizon
        const uint32_t x = WIDTH / 4 * 3 - 1 + i % 2, y = ROWS / 2 - 1 + i / 2;
        for (uint32_t k = 0; k < 3; k++) {
            alp_image_floats(picture)[3 * (y * WIDTH + x) + k] = 1000.0f;
        }
    }
    alp_scene *scene = make_wall();
    alp_bake_options o = wall_options();
    o.light.lighting.sun.illuminance = 0.0f;
    o.light.lighting.sky.kind = ALP_SKY_IMAGE;
    o.light.lighting.sky.image = picture;
    const uint32_t count = bake_strip(scene, &o, found);
    o.light.gather = ALP_GATHER_PATHS;
    o.light.samples = 1024;
    assert_int_equal(bake_strip(scene, &o, truth), count);
    double mean = 0.0, exact = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        mean += found[i][0] / count;
        exact += truth[i][0] / count;
    }
    printf("accuracy: at the foot of a wall, under a lamp of the sky: %+.1e\n", mean / exact - 1.0);
    ASSERT_NEAR(mean / exact, 1.0 + FAR_HITS, 0.06);
    alp_image_destroy(picture);
    alp_scene_destroy(scene);
}

/// The same bits where light by direction is wanted too, and for one worker.
TEST(whoever_asks)
{
    static double found[MOST][3], again[MOST][3];
    alp_scene *scene = make_wall();
    alp_bake_options o = wall_options();
    o.light.samples = 64;
    const uint32_t count = bake_strip(scene, &o, found);
    for (int k = 0; k < 2; k++) {
        o.maps = k == 0 ? ALP_MAP_LIGHT | ALP_MAP_SH : ALP_MAP_LIGHT;
        alp_context *two = context;
        if (k == 1) {
            alp_scene_destroy(scene);
            context = test_context(1);
            scene = make_wall();
        }
        assert_int_equal(bake_strip(scene, &o, again), count);
        assert_memory_equal(again, found, count * sizeof *found);
        if (k == 1) {
            alp_scene_destroy(scene);
            alp_context_destroy(context);
            context = two;
        }
    }
}
