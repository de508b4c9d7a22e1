// SPDX-License-Identifier: MIT
// Fields of the viewer, by the places where they are read, against those of render.
#include "test_gl.h"

#include "options/options.h"
#include "scene/scene.h"
#include "shaders/bindings.h"

static alp_render_options small_picture(const alp_field *field)
{
    alp_render_options o = alp_render_options_default();
    o.method = ALP_RENDER_FIELD;
    o.width = 240;
    o.height = 135;
    o.without_direct = true;
    o.field = field;
    return o;
}

static void compare(const alp_scene *scene, const alp_render_options *o, mode_light light)
{
    test_pair pair = test_gl_pair_in("probes", light, scene, o);
    const double equal = test_pair_equal_share(&pair);
    if (!(pair.alike_share >= 0.8 && equal >= 0.99)) {
        fail_msg("%.4f of the pixels are alike, and %.4f of these equal", pair.alike_share, equal);
    }
    test_pair_destroy(&pair);
}

/// Draws a field read at some places, and compares.
static void check(const alp_scene *scene, const alp_field *field, GLint read)
{
    const alp_render_options o = small_picture(field);
    mode_light light = {0};
    assert_int_equal(gl_field_create(scene, read, o.width, o.height, &light.field), EXIT_DONE);
    light.field.workers = 2;
    gl_field_set(&light.field, field);
    compare(scene, &o, light);
}

/// The same of probes that the shader reads.
static void check_probes(const alp_scene *scene, const alp_probes *probes)
{
    const alp_scene_info info = alp_scene_get_info(scene);
    alp_field *field = NULL;
    ASSERT_OK(scene->context,
              alp_field_create_probes(probes, ALP_LOOKUP_OURS, info.origin, NULL, &field));
    const alp_render_options o = small_picture(field);
    mode_light light = {0};
    assert_int_equal(gl_field_create(scene, READ_PIXEL, o.width, o.height, &light.field),
                     EXIT_DONE);
    gl_field_set_probes(&light.field, probes, info.origin);
    assert_int_equal(light.field.read, READ_PROBES);
    compare(scene, &o, light);
    alp_field_destroy(field);
}

static alp_probes *bake_probes(alp_context *context, const alp_scene *scene, float spacing)
{
    alp_probe_options bake = alp_probe_options_default();
    alp_probes *probes = NULL;
    bake.spacing = spacing;
    bake.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    bake.atlas_size = 128;
    bake.rays = 384;
    ASSERT_OK(context, alp_probes_bake(scene, &bake, &probes));
    return probes;
}

static alp_field *fit_environment(alp_context *context, const alp_scene *scene)
{
    alp_ambient_options fit = alp_ambient_options_default();
    alp_field *field = NULL;
    fit.model = ALP_AMBIENT_ENVIRONMENT;
    fit.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    fit.lighting.sky.up[0] = 3.0f;
    fit.points = 64;
    fit.samples = 64;
    ASSERT_OK(context, alp_field_create_ambient(scene, &fit, &field));
    return field;
}

TEST_WITH_CONTEXT(fields_at_pixels_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    alp_probes *probes = bake_probes(context, scene, 0.5f);
    alp_field *field = NULL;
    ASSERT_OK(context, alp_field_create_probes(probes, ALP_LOOKUP_THREE,
                                               alp_scene_get_info(scene).origin, NULL, &field));
    check(scene, field, READ_PIXEL);
    alp_field_destroy(field);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(probes_in_the_shader_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    alp_probes *probes = bake_probes(context, scene, 0.5f);
    check_probes(scene, probes);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

/// The light of an environment is the same everywhere, so that flat faces have one value.
TEST_WITH_CONTEXT(fields_at_vertices_are_exact_where_light_is_even, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_field *field = fit_environment(context, scene);
    check(scene, field, READ_VERTEX);
    alp_field_destroy(field);
    alp_scene_destroy(scene);
}

/// Nine coefficients are exact for light of nine coefficients, at every normal.
TEST_WITH_CONTEXT(one_look_up_an_object_is_exact_for_nine_coefficients, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    alp_field *field = fit_environment(context, scene);
    check(scene, field, READ_OBJECT);
    alp_field_destroy(field);
    alp_scene_destroy(scene);
}
