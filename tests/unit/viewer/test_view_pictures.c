// SPDX-License-Identifier: MIT
// Surfaces of the viewer against those of render, one sample a pixel.
#include "test_gl.h"

#include <math.h>

// The share of pixels within a byte, of those where both see the same triangles; and of these of
// all. The others lie at edges, where rounding decides.
static const double EQUAL = 0.97, ALIKE = 0.85;

static alp_render_options small_picture(alp_render_method method)
{
    alp_render_options o = alp_render_options_default();
    o.method = method;
    o.width = 240;
    o.height = 135;
    return o;
}

static void check_pair(const alp_scene *scene, const alp_render_options *o)
{
    test_pair pair = test_gl_pair(scene, o);
    const double equal = test_pair_equal_share(&pair);
    if (!(pair.alike_share >= ALIKE && equal >= EQUAL)) {
        fail_msg("%.4f of the pixels are alike, and %.4f of these equal", pair.alike_share, equal);
    }
    test_pair_destroy(&pair);
}

/// Bakes a small map, and compares.
static void check_lightmap(alp_context *context, const char *name, alp_atlas_mode mode)
{
    alp_scene *scene = test_load(context, name);
    alp_bake_options bake = alp_bake_options_default();
    alp_render_options o = small_picture(ALP_RENDER_LIGHTMAP);
    alp_lightmap *lightmap = NULL;
    o.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    o.lighting.sky.down[0] = 0.2f;
    bake.maps = ALP_MAP_LIGHT;
    bake.atlas.size = 128;
    bake.atlas.mode = mode;
    bake.light.samples = 8;
    bake.light.lighting = o.lighting;
    ASSERT_OK(context, alp_bake(scene, &bake, &lightmap, NULL));
    o.lightmap = lightmap;
    check_pair(scene, &o);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(light_maps_of_the_cornell_box_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    check_lightmap(context, "builtin:cornell", ALP_ATLAS_CHARTS);
}

TEST_WITH_CONTEXT(light_maps_of_overlapping_charts_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    check_lightmap(context, "builtin:torus-plane", ALP_ATLAS_BLEND);
}

TEST_SLOW_WITH_CONTEXT(light_maps_of_a_hall_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    check_lightmap(context, "builtin:atrium,triangles=20000", ALP_ATLAS_CHARTS);
}

TEST_WITH_CONTEXT(maps_of_occlusion_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    alp_bake_options bake = alp_bake_options_default();
    alp_render_options o = small_picture(ALP_RENDER_AO);
    alp_lightmap *lightmap = NULL;
    mode_light light = {0};
    bake.maps = ALP_MAP_AO;
    bake.atlas.size = 128;
    bake.atlas.mode = ALP_ATLAS_CHARTS;
    bake.occlusion.samples = 16;
    ASSERT_OK(context, alp_bake(scene, &bake, &lightmap, NULL));
    o.lightmap = lightmap;
    assert_int_equal(
        gl_lightmap_create(scene, lightmap, ALP_MAP_AO, ALP_BLEND_NORMAL, &light.lightmap),
        EXIT_DONE);
    test_pair pair = test_gl_pair_in("ao", light, scene, &o);
    assert_true(pair.alike_share >= ALIKE);
    assert_true(test_pair_equal_share(&pair) >= EQUAL);
    test_pair_destroy(&pair);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(albedos_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:terrain,triangles=5000");
    const alp_render_options o = small_picture(ALP_RENDER_ALBEDO);
    check_pair(scene, &o);
    alp_scene_destroy(scene);
}
