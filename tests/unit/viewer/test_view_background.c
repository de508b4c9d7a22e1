// SPDX-License-Identifier: MIT
// Skies and suns behind the surfaces against those of render.
#include "test_gl.h"

#include <math.h>

enum { WIDTH = 160, HEIGHT = 90, SKY_WIDTH = 64 };

/// The bake of a light map that nobody sees: a tiny triangle behind the camera.
typedef struct empty_place {
    alp_scene *scene;
    alp_lightmap *lightmap;
    alp_render_options options;
} empty_place;

static empty_place make_place(alp_context *context)
{
    static const float corners[3][3] = {{0, 0, 9}, {0.1f, 0, 9}, {0, 0.1f, 9}};
    static const uint32_t triangle[3] = {0, 1, 2};
    const alp_mesh mesh = {.vertex_count = 3,
                           .positions = corners[0],
                           .triangle_count = 1,
                           .indices = triangle,
                           .base_color = {0.5f, 0.5f, 0.5f}};
    empty_place p = {.options = alp_render_options_default()};
    alp_bake_options bake = alp_bake_options_default();
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &p.scene));
    bake.maps = ALP_MAP_LIGHT;
    bake.atlas.size = 4;
    bake.light.samples = 4;
    bake.light.lighting.sky.kind = ALP_SKY_CONSTANT;
    ASSERT_OK(context, alp_bake(p.scene, &bake, &p.lightmap, NULL));
    p.options.method = ALP_RENDER_LIGHTMAP;
    p.options.lightmap = p.lightmap;
    p.options.width = WIDTH;
    p.options.height = HEIGHT;
    p.options.camera = (alp_camera){
        .position = {0, 0, 0}, .target = {0.3f, 0.1f, -1}, .up = {0, 1, 0}, .vertical_fov = 1.2f};
    return p;
}

static void leave_place(empty_place *p)
{
    alp_lightmap_destroy(p->lightmap);
    alp_scene_destroy(p->scene);
}

/// Share of the pixels whose light, or alpha, differs by more than `tolerance` of the mean.
static double share_of_differences(const empty_place *p, double tolerance)
{
    test_pair pair = test_gl_pair(p->scene, &p->options);
    const float *a = alp_image_floats(pair.drawn_light), *b = alp_image_floats(pair.rendered_light);
    const size_t count = (size_t)WIDTH * HEIGHT;
    double mean = 0.0;
    size_t differ = 0;
    for (size_t i = 0; i < 4 * count; i++) {
        mean += (double)b[i] / (4.0 * (double)count);
    }
    for (size_t i = 0; i < count; i++) {
        bool equal = true;
        for (size_t k = 4 * i; k < 4 * i + 4; k++) {
            equal = equal && fabs((double)a[k] - (double)b[k]) <= tolerance * mean;
        }
        differ += equal ? 0 : 1;
    }
    test_pair_destroy(&pair);
    return (double)differ / (double)count;
}

TEST_WITH_CONTEXT(skies_of_two_colours_part_at_the_horizon, 1)
{
    if (!test_gl_open()) {
        skip();
    }
    empty_place p = make_place(context);
    p.options.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    p.options.lighting.sky.down[2] = 0.3f;
    p.options.lighting.sky.strength = 3.0f;
    assert_true(share_of_differences(&p, 1e-6) == 0.0);
    leave_place(&p);
}

TEST_WITH_CONTEXT(without_a_sky_nothing_is_covered, 1)
{
    if (!test_gl_open()) {
        skip();
    }
    empty_place p = make_place(context);
    test_pair pair = test_gl_pair(p.scene, &p.options);
    assert_true(pair.alike_share == 1.0);
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        assert_true(alp_image_floats(pair.drawn_light)[4 * i + 3] == 0.0f);
        assert_int_equal(alp_image_bytes(pair.drawn)[3 * i], alp_image_bytes(pair.rendered)[3 * i]);
    }
    test_pair_destroy(&pair);
    leave_place(&p);
}

TEST_WITH_CONTEXT(images_of_skies_turn_as_in_render, 1)
{
    if (!test_gl_open()) {
        skip();
    }
    const alp_image_info info = {SKY_WIDTH, SKY_WIDTH / 2, 3, ALP_COMPONENT_FLOAT};
    alp_image *sky = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &sky));
    for (size_t i = 0; i < (size_t)3 * SKY_WIDTH * SKY_WIDTH / 2; i++) {
        alp_image_floats(sky)[i] = (float)((i * 7919) % 101) * 0.02f;
    }
    empty_place p = make_place(context);
    p.options.lighting.sky.kind = ALP_SKY_IMAGE;
    p.options.lighting.sky.image = sky;
    p.options.lighting.sky.strength = 0.5f;
    for (int i = 0; i < 4; i++) {
        p.options.lighting.sky.turn = -2.0f + 1.7f * (float)i; // one view has the picture's border
        assert_true(share_of_differences(&p, 1e-3) == 0.0);
    }
    leave_place(&p);
    alp_image_destroy(sky);
}

TEST_WITH_CONTEXT(suns_stand_in_clear_skies, 1)
{
    if (!test_gl_open()) {
        skip();
    }
    empty_place p = make_place(context);
    p.options.lighting.sky.kind = ALP_SKY_CLEAR;
    p.options.lighting.sun.azimuth = 3.0f;
    p.options.lighting.sun.elevation = 0.4f;
    p.options.lighting.sun.illuminance = 50000.0f;
    p.options.lighting.sun.size = 0.5f;
    // The rim of the disk has 1 % of the pixels, and the horizon two rows of 90.
    assert_true(share_of_differences(&p, 1e-3) < 0.04);
    leave_place(&p);
}
