// SPDX-License-Identifier: MIT
// Ambient models of the viewer against those of render.
#include "test_gl.h"

static void check(const alp_scene *scene, const alp_render_options *o, const char *name)
{
    test_pair pair = test_gl_pair(scene, o);
    const double equal = test_pair_equal_share(&pair);
    if (!(pair.alike_share >= 0.8 && equal >= 0.99)) {
        fail_msg("%s: %.4f of the pixels are alike, and %.4f of these equal", name,
                 pair.alike_share, equal);
    }
    test_pair_destroy(&pair);
}

/// Fits each model to a room that a lamp and a sky light, and compares its pictures.
static void check_models(alp_context *context, bool direct)
{
    static const char *const names[ALP_AMBIENT_COUNT] = {"constant", "hemisphere", "ground-map",
                                                         "ambient-cube", "environment"};
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    alp_render_options o = alp_render_options_default();
    alp_ambient_options fit = alp_ambient_options_default();
    alp_lamp lamp = alp_lamp_default();
    lamp.position[0] = -0.5f;
    lamp.position[1] = 2.0f;
    lamp.intensity = 30.0f;
    o.method = ALP_RENDER_FIELD;
    o.width = 240;
    o.height = 135;
    o.without_direct = !direct;
    o.lighting.lamps = &lamp;
    o.lighting.lamp_count = 1;
    o.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    o.lighting.sky.up[0] = 2.0f;
    fit.lighting = o.lighting;
    fit.points = 128;
    fit.samples = 64;
    for (int i = 0; i < ALP_AMBIENT_COUNT; i++) {
        alp_field *field = NULL;
        fit.model = (alp_ambient_model)i;
        ASSERT_OK(context, alp_field_create_ambient(scene, &fit, &field));
        o.field = field;
        check(scene, &o, names[i]);
        alp_field_destroy(field);
    }
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(ambient_models_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    check_models(context, false);
}

TEST_WITH_CONTEXT(ambient_models_with_lamps_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    check_models(context, true);
}
