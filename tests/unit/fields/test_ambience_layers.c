// SPDX-License-Identifier: MIT
// Ambience volumes of single lamps: sums, strengths, wrong numbers.
#include "ambience_world.h"
#include "field_scenes.h"

TEST_CONTEXT(2);

enum { LAMPS = 2, ROUNDS = 8, POINTS = 12 };
static const alp_ambience_camera camera = {.position = {1.1, 0.9, 1.0}};

/// A volume of light in a glowing room, warm before time moves.
typedef struct warm_volume {
    alp_ambience *ambience;
    alp_ambience_sampler *sampler;
} warm_volume;

/// @param first, count which of the two lamps there are   @param light of the sampler's options
static warm_volume open_volume(const alp_scene *scene, uint32_t first, uint32_t count,
                               uint32_t light, bool direct)
{
    alp_lamp lamps[LAMPS] = {alp_lamp_default(), alp_lamp_default()};
    alp_ambience_options a = alp_ambience_options_default();
    alp_ambience_sampler_options o = alp_ambience_sampler_options_default();
    warm_volume v;
    for (int i = 0; i < LAMPS; i++) {
        lamps[i].intensity = i == 0 ? 5.0f : 2.0f;
        lamps[i].color[0] = i == 0 ? 1.0f : 0.25f;
        lamps[i].position[0] = i == 0 ? 0.5f : 1.6f;
        lamps[i].position[1] = i == 0 ? 0.6f : 1.5f;
        lamps[i].position[2] = 1.1f;
    }
    a.centre[0] = a.centre[1] = a.centre[2] = 1.0;
    a.size = 2.7;
    a.depth = 2;
    o.lighting.lamps = lamps + first;
    o.lighting.lamp_count = count;
    o.face = o.first_face = 8;
    o.light = light;
    o.direct = direct;
    ASSERT_OK(context, alp_ambience_create(context, &a, &v.ambience));
    ASSERT_OK(context, alp_ambience_sampler_create(v.ambience, scene, &o, &v.sampler));
    for (int i = 0; i < ROUNDS; i++) { // each adds a bounce
        ASSERT_OK(context, alp_ambience_update(v.ambience, 0.0));
        ASSERT_OK(context, alp_ambience_sample(v.sampler, &camera, 10000, 0.0, NULL));
        alp_ambience_invalidate(v.ambience, false, NULL, NULL);
    }
    ASSERT_OK(context, alp_ambience_update(v.ambience, 0.0));
    return v;
}

static void close_volume(warm_volume *v)
{
    alp_ambience_sampler_destroy(v->sampler);
    alp_ambience_destroy(v->ambience);
}

/// The room glows: there is other light than that of lamps.
static alp_scene *open_room(void)
{
    return field_room(context, (vec3){2.0f, 2.0f, 2.0f}, 0.6f, 0.05f);
}

static void place_point(int i, vec3 *p, vec3 *n)
{
    *p = (vec3){0.3f + 0.12f * (float)i, 0.9f + 0.05f * (float)(i % 4), 1.7f - 0.1f * (float)i};
    *n = field_tilted(0.4 * i, 1.7 * i);
}

static vec3 read_layers(alp_ambience *all, warm_volume layers[LAMPS], float first, float second,
                        int point)
{
    alp_ambience *const volumes[LAMPS] = {layers[0].ambience, layers[1].ambience};
    const float strengths[LAMPS] = {first, second};
    alp_field *field = NULL;
    vec3 p, n;
    place_point(point, &p, &n);
    ASSERT_OK(context, alp_field_create_ambience_layers(all, volumes, strengths, LAMPS, &field));
    const vec3 e = field_read(field, p, n);
    alp_field_destroy(field);
    return e;
}

/// Largest difference over the points, of E with the strengths to E of another volume, over its E.
static double find_apart(warm_volume *all, warm_volume layers[LAMPS], const float strengths[LAMPS],
                         warm_volume *other)
{
    double most = 0.0;
    for (int i = 0; i < POINTS; i++) {
        alp_field *field = NULL;
        vec3 p, n;
        place_point(i, &p, &n);
        ASSERT_OK(context, alp_field_create_ambience(other->ambience, &field));
        const vec3 is = field_read(field, p, n);
        const vec3 sum = read_layers(all->ambience, layers, strengths[0], strengths[1], i);
        alp_field_destroy(field);
        assert_true(is.x > 0.0f && is.y > 0.0f);
        most = fmax(most, fabs((double)sum.x - (double)is.x) / (double)is.x);
        most = fmax(most, fabs((double)sum.y - (double)is.y) / (double)is.y);
    }
    return most;
}

static void check_sums(bool direct)
{
    static const float both[] = {1.0f, 1.0f}, none[] = {0.0f, 0.0f}, second[] = {0.0f, 1.0f};
    static const float twice[] = {2.0f, 2.0f};
    alp_scene *scene = open_room();
    warm_volume all = open_volume(scene, 0, 2, UINT32_MAX, direct);
    warm_volume rest = open_volume(scene, 0, 0, UINT32_MAX, direct);
    warm_volume alone = open_volume(scene, 1, 1, UINT32_MAX, direct);
    warm_volume layers[LAMPS] = {open_volume(scene, 0, 2, 0, direct),
                                 open_volume(scene, 0, 2, 1, direct)};
    assert_true(alp_ambience_get_info(all.ambience).anchors > 100);
    assert_true(find_apart(&all, layers, both, &all) == 0.0);
    // All light is the rest and the layers.
    assert_true(find_apart(&rest, layers, twice, &all) < 2e-5);
    assert_true(find_apart(&all, layers, none, &rest) < 2e-3); // a small difference of large ones
    assert_true(find_apart(&all, layers, second, &alone) < 2e-3);
    // Lamps are most of the light.
    assert_true(find_apart(&rest, layers, both, &all) > 0.3);
    close_volume(&all);
    close_volume(&rest);
    close_volume(&alone);
    close_volume(&layers[0]);
    close_volume(&layers[1]);
    alp_scene_destroy(scene);
}

TEST_SLOW(all_light_is_the_rest_and_the_layers)
{
    check_sums(false);
}

TEST(all_light_is_the_rest_and_the_layers_with_direct_light)
{
    check_sums(true);
}

/// A sun is the last light. The sky is in no layer.
TEST(a_layer_of_the_sun_has_no_sky)
{
    alp_scene *scene = open_room();
    alp_ambience_options a = alp_ambience_options_default();
    alp_ambience_sampler_options o = alp_ambience_sampler_options_default();
    warm_volume v;
    a.centre[1] = 100.0; // above the room's roof, whose outside is black
    a.size = 2.7;
    a.depth = 1;
    o.lighting.sky.kind = ALP_SKY_CONSTANT;
    o.lighting.sun.illuminance = 2.0f;
    o.lighting.sun.elevation = 1.5f;
    o.light = 0;
    o.direct = true;
    ASSERT_OK(context, alp_ambience_create(context, &a, &v.ambience));
    ASSERT_OK(context, alp_ambience_sampler_create(v.ambience, scene, &o, &v.sampler));
    ASSERT_OK(context, alp_ambience_update(v.ambience, 0.0));
    const alp_ambience_camera above = {.position = {0.0, 100.0, 0.0}};
    ASSERT_OK(context, alp_ambience_sample(v.sampler, &above, 1000, 0.0, NULL));
    ASSERT_OK(context, alp_ambience_update(v.ambience, 0.0));
    const alp_ambience_snapshot *now = alp_ambience_begin_read(v.ambience);
    alp_sh9 light;
    alp_ambience_coefficients(now, above.position, &light);
    alp_ambience_end_read(v.ambience, now);
    ASSERT_NEAR(light.c[0][1], 2.0 * ALP_SH_Y0, 1e-3);
    close_volume(&v);
    alp_scene_destroy(scene);
}

TEST(lamps_that_are_not_there_are_refused)
{
    alp_scene *scene = open_room();
    alp_lamp lamps[LAMPS] = {alp_lamp_default(), alp_lamp_default()};
    alp_ambience *a = world_open(context, NULL);
    alp_ambience_sampler_options o = alp_ambience_sampler_options_default();
    alp_ambience_sampler *sampler = NULL;
    lamps[0].intensity = lamps[1].intensity = 1.0f;
    o.lighting.lamps = lamps;
    o.lighting.lamp_count = LAMPS;
    o.light = 2;
    assert_int_equal(alp_ambience_sampler_create(a, scene, &o, &sampler),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_null(sampler);
    assert_non_null(strstr(alp_context_message(context), "light 2 of 2"));
    o.light = 1;
    ASSERT_OK(context, alp_ambience_sampler_create(a, scene, &o, &sampler));
    o.lighting.lamp_count = 1; // the lamp of the layer goes: the old light stays
    assert_int_equal(alp_ambience_sampler_set_lighting(sampler, &o.lighting),
                     ALP_ERROR_INVALID_ARGUMENT);
    alp_ambience_sampler_destroy(sampler);
    alp_ambience_destroy(a);
    alp_scene_destroy(scene);
}

TEST(strengths_that_are_none_are_refused)
{
    static const float bad[] = {-1.0f, NAN, INFINITY};
    alp_ambience *a = world_open(context, NULL);
    alp_ambience *const layers[1] = {a}, *const nothing[1] = {NULL};
    alp_field *field = NULL;
    const float one = 1.0f;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(alp_field_create_ambience_layers(a, layers, &bad[i], 1, &field),
                         ALP_ERROR_INVALID_ARGUMENT);
        assert_null(field);
    }
    assert_int_equal(alp_field_create_ambience_layers(a, nothing, &one, 1, &field),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_field_create_ambience_layers(NULL, layers, &one, 1, &field),
                     ALP_ERROR_INVALID_ARGUMENT);
    ASSERT_OK(context, alp_field_create_ambience_layers(a, NULL, NULL, 0, &field));
    alp_field_destroy(field);
    alp_ambience_destroy(a);
}

/// Each allocation fails once; snapshots are given back.
TEST(memory_of_layers_that_runs_out)
{
    static const float ones[2] = {1.0f, 1.0f};
    int left = 1 << 30, steps = 0;
    alp_context *failing = test_context_failing(&left);
    alp_ambience *a = world_open(failing, NULL);
    alp_ambience *const layers[2] = {a, a};
    alp_field *field = NULL;
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    for (; result != ALP_OK; steps++) {
        left = steps;
        result = alp_field_create_ambience_layers(a, layers, ones, 2, &field);
        assert_true(result == ALP_OK || (result == ALP_ERROR_OUT_OF_MEMORY && field == NULL));
    }
    left = 1 << 30;
    assert_int_equal(steps, 5);
    alp_field_destroy(field);
    for (uint32_t i = 0; i < a->snapshots.count; i++) {
        assert_int_equal(atomic_load(&a->snapshots.all[i]->readers), 0);
    }
    alp_ambience_destroy(a);
    alp_context_destroy(failing);
}
