// SPDX-License-Identifier: MIT
// Light of lamps in layers of their own: sums, strengths, names.
#include "field_scenes.h"

TEST_CONTEXT(2);

enum { LAMPS = 2, NONE = 0, FIRST = 1, SECOND = 2, BOTH = 3 };

/// Probes in a room that glows a little, under some of two lamps.
static alp_probes *bake(const alp_scene *scene, int which, bool layers, bool direct)
{
    alp_lamp lamps[LAMPS] = {alp_lamp_default(), alp_lamp_default()};
    alp_probe_options o = alp_probe_options_default();
    alp_probes *probes = NULL;
    for (int i = 0; i < LAMPS; i++) {
        lamps[i].intensity = i == 0 ? 5.0f : 2.0f;
        lamps[i].color[0] = i == 0 ? 1.0f : 0.25f;
        lamps[i].position[0] = i == 0 ? 0.5f : 1.6f;
        lamps[i].position[1] = i == 0 ? 0.6f : 1.5f;
        lamps[i].position[2] = 1.1f;
    }
    o.lighting.lamps = which == SECOND ? lamps + 1 : lamps;
    o.lighting.lamp_count = which == BOTH ? 2 : which == NONE ? 0 : 1;
    o.spacing = 1.0f;
    o.atlas_size = 64;
    o.layers = layers;
    o.direct = direct;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    return probes;
}

static alp_scene *glowing_room(void)
{
    return field_room(context, (vec3){2.0f, 2.0f, 2.0f}, 0.6f, 0.05f);
}

/// RMS difference of two sums of coefficients over the RMS of the first.
static double apart(uint32_t count, const float *a, const float *b, const float *c)
{
    double squares = 0.0, all = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const double other = (double)b[i] + (c != NULL ? (double)c[i] : 0.0);
        squares += ((double)a[i] - other) * ((double)a[i] - other);
        all += (double)a[i] * (double)a[i];
    }
    return sqrt(squares / all);
}

static void check_sums(bool direct)
{
    alp_scene *scene = glowing_room();
    alp_probes *layered = bake(scene, BOTH, true, direct);
    alp_probes *rest = bake(scene, NONE, false, direct);
    alp_probes *first = bake(scene, FIRST, false, direct);
    const uint32_t count = alp_probes_get_info(layered).count * 27;
    float *sum = calloc(count, sizeof *sum);
    assert_non_null(sum);
    assert_int_equal(alp_probes_get_info(layered).layers, LAMPS);
    const float *one = alp_probes_coefficients(layered, 0),
                *two = alp_probes_coefficients(layered, 1);
    const float *other = alp_probes_coefficients(rest, UINT32_MAX);
    for (uint32_t i = 0; i < count; i++) {
        sum[i] = one[i] + two[i];
    }
    // All light is the rest and the layers; light of a lamp alone is its layer and the rest.
    assert_true(apart(count, alp_probes_coefficients(layered, UINT32_MAX), sum, other) < 0.01);
    assert_true(apart(count, alp_probes_coefficients(first, UINT32_MAX), one, other) < 0.01);
    assert_null(alp_probes_coefficients(layered, 2));
    free(sum);
    alp_probes_destroy(layered);
    alp_probes_destroy(rest);
    alp_probes_destroy(first);
    alp_scene_destroy(scene);
}

TEST(all_light_is_the_rest_and_the_layers)
{
    check_sums(false);
}

TEST(all_light_is_the_rest_and_the_layers_with_direct_light)
{
    check_sums(true);
}

TEST(layers_have_the_names_of_lamps)
{
    alp_scene *scene = glowing_room();
    alp_probes *probes = bake(scene, BOTH, true, false);
    assert_string_equal(alp_probes_layer_name(probes, 0), "lamp 0");
    assert_string_equal(alp_probes_layer_name(probes, 1), "lamp 1");
    assert_string_equal(alp_probes_layer_name(probes, 2), "");
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

static vec3 read_with(const alp_probes *probes, const float *strengths, vec3 p, vec3 n)
{
    alp_field *field = NULL;
    ASSERT_OK(context, alp_field_create_probes(probes, ALP_LOOKUP_OURS, NULL, strengths, &field));
    const vec3 e = field_read(field, p, n);
    alp_field_destroy(field);
    return e;
}

/// E is linear in the strengths; 0 leaves out all light of a lamp, 2 doubles it.
TEST(strengths_scale_the_light_of_lamps)
{
    static const float none[] = {0.0f, 0.0f}, ones[] = {1.0f, 1.0f}, second[] = {0.0f, 1.0f};
    static const float mixed[] = {2.0f, 0.0f};
    alp_scene *scene = glowing_room();
    alp_probes *layered = bake(scene, BOTH, true, false), *rest = bake(scene, NONE, false, false);
    alp_probes *alone = bake(scene, SECOND, false, false);
    for (int i = 0; i < 6; i++) {
        const vec3 p = {0.3f + 0.25f * (float)i, 0.9f, 1.7f - 0.2f * (float)i};
        const vec3 n = field_tilted(0.5 * i, 1.7 * i);
        const vec3 dark = read_with(layered, none, p, n), all = read_with(layered, ones, p, n);
        const vec3 plain = read_with(layered, NULL, p, n), two = read_with(layered, second, p, n);
        const vec3 double_first = read_with(layered, mixed, p, n);
        ASSERT_NEAR(all.x, plain.x, 1e-5 * (double)plain.x);
        ASSERT_NEAR(double_first.x, dark.x + 2.0f * (all.x - two.x), 1e-4 * (double)all.x);
        ASSERT_NEAR(dark.y, read_with(rest, NULL, p, n).y, 0.02 * (double)all.y);
        ASSERT_NEAR(two.y, read_with(alone, NULL, p, n).y, 0.02 * (double)all.y);
        assert_true(all.x > two.x && two.x > dark.x && dark.x > 0.0f);
    }
    alp_probes_destroy(layered);
    alp_probes_destroy(rest);
    alp_probes_destroy(alone);
    alp_scene_destroy(scene);
}

TEST(more_lamps_than_layers_are_warned_of)
{
    enum { MANY = 20 };
    alp_lamp lamps[MANY];
    alp_probe_options o = alp_probe_options_default();
    alp_probes *probes = NULL;
    alp_scene *scene = glowing_room();
    for (int i = 0; i < MANY; i++) {
        lamps[i] = alp_lamp_default();
        lamps[i].intensity = 1.0f;
        lamps[i].position[0] = 0.2f + 0.08f * (float)i;
        lamps[i].position[1] = lamps[i].position[2] = 1.0f;
    }
    o.lighting.lamps = lamps;
    o.lighting.lamp_count = MANY;
    o.layers = true;
    o.spacing = 1.0f;
    o.atlas_size = 64;
    o.rays = 384;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    assert_int_equal(alp_probes_get_info(probes).layers, 15);
    assert_true(test_log_has("many-layers"));
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}
