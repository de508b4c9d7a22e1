// SPDX-License-Identifier: MIT
// Lamps of the options: E = I cosθ / r², a spot's cone, their place among the lights, a bake by
// them, and values that are none.
#include "test_lights.h"

#include "base/memory.h"

#include <math.h>

static const vec3 ORIGIN = {0, 0, 0}, UP = {0, 1, 0};

/// A white square of 2 mm about the origin that faces up, in a scene without light.
static alp_scene *small_ground(alp_context *context)
{
    static const float corners[4][3] = {
        {-1e-3f, 0, 1e-3f}, {1e-3f, 0, 1e-3f}, {1e-3f, 0, -1e-3f}, {-1e-3f, 0, -1e-3f}};
    static const uint32_t quad[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const alp_mesh mesh = {.positions = corners[0],
                           .indices = quad[0],
                           .vertex_count = 4,
                           .triangle_count = 2,
                           .base_color = {1, 1, 1}};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    return scene;
}

/// 100 candela, 5 m from the origin, 4 m above its plane, in yellow.
static alp_lamp point_lamp(void)
{
    alp_lamp lamp = alp_lamp_default();
    lamp.position[0] = 3.0f;
    lamp.position[1] = 4.0f;
    lamp.intensity = 100.0f;
    lamp.color[1] = 0.5f;
    lamp.color[2] = 0.0f;
    return lamp;
}

/// 8 candela 2 m above the plane, straight down; the origin is `angle` from its axis.
static alp_lamp spot_lamp(double angle)
{
    alp_lamp lamp = alp_lamp_default();
    lamp.kind = ALP_LIGHT_SPOT;
    lamp.position[0] = (float)(-2.0 * tan(angle));
    lamp.position[1] = 2.0f;
    lamp.direction[1] = -7.0f; // its length has no meaning
    lamp.direction[2] = 0.0f;
    lamp.intensity = 8.0f;
    lamp.inner_cone = 0.3f;
    lamp.outer_cone = 0.6f;
    return lamp;
}

/// What that spot gives at the origin on a surface that faces it: KHR_lights_punctual.
static double spot_light(double angle)
{
    const double inner = cos(0.3), outer = cos(0.6), distance = 2.0 / cos(angle);
    const double ramp = fmin(fmax((cos(angle) - outer) / (inner - outer), 0.0), 1.0);
    return 8.0 / (distance * distance) * ramp * ramp;
}

static alp_lighting_options options_of(const alp_lamp *lamps, uint32_t count)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.lamps = lamps;
    o.lamp_count = count;
    return o;
}

TEST_WITH_CONTEXT(a_lamp_gives_intensity_over_distance_squared, 1)
{
    alp_scene *scene = small_ground(context);
    alp_lamp lamp = point_lamp();
    const alp_lighting_options o = options_of(&lamp, 1);
    alpi_lighting *lighting = NULL;
    ASSERT_OK(context, alpi_lighting_create(scene, &o, &lighting));
    lamp = alp_lamp_default(); // it was borrowed for the call alone
    assert_false(alpi_lighting_is_dark(lighting));
    alpi_light_sample s;
    assert_true(alpi_lighting_sample_light(lighting, 0, ORIGIN, (vec2){0, 0}, &s));
    ASSERT_NEAR(s.light.x, 100.0 / 25.0, 1e-6); // floats
    ASSERT_NEAR(s.light.y, 50.0 / 25.0, 1e-6);
    ASSERT_NEAR(s.light.z, 0.0, 0.0);
    ASSERT_NEAR(s.distance, 5.0, 1e-6);
    ASSERT_ESTIMATE(test_light_estimate(lighting, ORIGIN, UP, 10, 0), 4.0 * 0.8);
    // No range: at a thousand times the distance a millionth is left.
    assert_true(alpi_lighting_sample_light(lighting, 0, (vec3){3, -4996, 0}, (vec2){0, 0}, &s));
    ASSERT_NEAR((double)s.light.x / 4e-6, 1.0, 1e-6);
    alpi_lighting_destroy(context, lighting);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_spot_lights_its_cone, 1)
{
    alp_scene *scene = small_ground(context);
    for (int i = 0; i < 40; i++) {
        const double angle = 0.02 * i + 0.005; // not on an edge
        const alp_lamp lamp = spot_lamp(angle);
        const alp_lighting_options o = options_of(&lamp, 1);
        alpi_lighting *lighting = NULL;
        ASSERT_OK(context, alpi_lighting_create(scene, &o, &lighting));
        alpi_light_sample s;
        const bool lit = alpi_lighting_sample_light(lighting, 0, ORIGIN, (vec2){0, 0}, &s);
        assert_true(lit == (spot_light(angle) > 0.0));
        // 0.3 and 0.6 as floats, over a ramp of 0.13.
        ASSERT_NEAR(lit ? (double)s.light.x : 0.0, spot_light(angle), 4e-6);
        alpi_lighting_destroy(context, lighting);
    }
    alp_scene_destroy(scene);
}

/// The file's lights, then lamps, then the sun; each by its name.
TEST_WITH_CONTEXT(lamps_stand_between_file_and_sun, 1)
{
    alp_scene *scene = small_ground(context);
    scene->lights = ALPI_NEW(context, alpi_light, 1);
    assert_non_null(scene->lights);
    scene->lights[0] = (alpi_light){.kind = ALP_LIGHT_POINT,
                                    .color = {1, 1, 1},
                                    .intensity = 3.0f,
                                    .position = {0, 1, 0},
                                    .range = INFINITY};
    scene->light_count = 1;
    const alp_lamp lamps[2] = {point_lamp(), spot_lamp(0.1)};
    alp_lighting_options o = options_of(lamps, 2);
    o.sun.illuminance = 4.0f;
    o.sun.elevation = 0.5f;
    alpi_lighting *lighting = NULL;
    ASSERT_OK(context, alpi_lighting_create(scene, &o, &lighting));
    assert_int_equal(alpi_lighting_light_count(lighting), 4);
    ASSERT_NEAR(alpi_lighting_light(lighting, 0)->intensity, 3.0, 0.0);
    assert_string_equal(alpi_lighting_light(lighting, 1)->name, "lamp 0");
    assert_string_equal(alpi_lighting_light(lighting, 2)->name, "lamp 1");
    assert_int_equal(alpi_lighting_light(lighting, 2)->kind, ALP_LIGHT_SPOT);
    ASSERT_NEAR(alpi_lighting_light(lighting, 2)->direction.y, -1.0, 1e-7);
    assert_string_equal(alpi_lighting_light(lighting, 3)->name, "sun");
    const double sum = 3.0 + 4.0 * 0.8 + spot_light(0.1) * cos(0.1) + 4.0 * sin(0.5);
    ASSERT_ESTIMATE(test_light_estimate(lighting, ORIGIN, UP, 40000, 1), sum);
    alpi_lighting_destroy(context, lighting);
    alp_scene_destroy(scene);
}

/// Every texel of a bake of the small ground has what the lamp and the spot give at the origin.
TEST_WITH_CONTEXT(a_bake_has_their_light, 1)
{
    alp_scene *scene = small_ground(context);
    const alp_lamp lamps[2] = {point_lamp(), spot_lamp(0.45)};
    alp_bake_options o = alp_bake_options_default();
    o.maps = ALP_MAP_LIGHT;
    o.atlas.size = 64;
    o.light.samples = 8;
    o.light.bounces = 0;
    o.light.lighting = options_of(lamps, 2);
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &o, &lightmap, &report));
    const double spot = spot_light(0.45) * cos(0.45);
    const double expected[3] = {4.0 * 0.8 + spot, 2.0 * 0.8 + spot, spot};
    uint32_t width = 0, height = 0, covered = 0;
    const float *page = alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, 0, &width, &height);
    for (size_t i = 0; i < (size_t)width * height; i++) {
        if (page[4 * i + 3] < 0.5f) {
            continue;
        }
        covered++;
        for (int k = 0; k < 3; k++) {
            // An edge is 1 mm away along x, a metre of which changes the lamp by 9/25 of itself and
            // the spot by (3 tan + 2 sin/(ramp (cos inner − cos outer))) cos²/2 = 5.3 times itself.
            ASSERT_NEAR((double)page[4 * i + (size_t)k] / expected[k], 1.0, 5.5e-3);
        }
    }
    assert_true(covered > 100);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

typedef struct wrong_lamp {
    alp_lamp lamp;
    const char *said; // a part of the message
} wrong_lamp;

enum { WRONG_COUNT = 20 };

/// Lamps with one wrong value each.
static void make_wrong(wrong_lamp wrong[WRONG_COUNT])
{
    static const char *const said[WRONG_COUNT] = {"kind 2",
                                                  "kind 7",
                                                  "x is nan",
                                                  "y is inf",
                                                  "z is -2e+15",
                                                  "intensity -1",
                                                  "intensity",
                                                  "intensity",
                                                  "intensity",
                                                  "channel 0",
                                                  "channel 1",
                                                  "channel 2",
                                                  "direction",
                                                  "direction",
                                                  "cones -0.1",
                                                  "cones nan",
                                                  "cones 0.6 and 0.6",
                                                  "cones 0.7 and 0.6",
                                                  "cones 0.3 and 1.6",
                                                  "cones 0.3 and nan"};
    for (int i = 0; i < WRONG_COUNT; i++) {
        wrong[i] = (wrong_lamp){spot_lamp(0.1), said[i]};
    }
    wrong[0].lamp.kind = ALP_LIGHT_DIRECTIONAL;
    wrong[1].lamp.kind = (alp_light_kind)7;
    wrong[2].lamp.position[0] = NAN;
    wrong[3].lamp.position[1] = INFINITY;
    wrong[4].lamp.position[2] = -2e15f;
    wrong[5].lamp.intensity = -1.0f;
    wrong[6].lamp.intensity = NAN;
    wrong[7].lamp.intensity = INFINITY;
    wrong[8].lamp.intensity = 2e20f;
    wrong[9].lamp.color[0] = -1.0f;
    wrong[10].lamp.color[1] = NAN;
    wrong[11].lamp.color[2] = INFINITY;
    wrong[12].lamp.direction[1] = 0.0f;
    wrong[13].lamp.direction[0] = NAN;
    wrong[14].lamp.inner_cone = -0.1f;
    wrong[15].lamp.inner_cone = NAN;
    wrong[16].lamp.inner_cone = 0.6f;
    wrong[17].lamp.inner_cone = 0.7f;
    wrong[18].lamp.outer_cone = 1.6f;
    wrong[19].lamp.outer_cone = NAN;
}

static void check_refused(alp_context *context, const alp_scene *scene,
                          const alp_lighting_options *o, const char *said)
{
    alpi_lighting *lighting = NULL;
    assert_int_equal(alpi_lighting_create(scene, o, &lighting), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(lighting);
    if (strstr(alp_context_message(context), said) == NULL) {
        fail_msg("'%s' is not in: %s", said, alp_context_message(context));
    }
}

TEST_WITH_CONTEXT(wrong_values_are_refused, 1)
{
    alp_scene *scene = small_ground(context);
    wrong_lamp wrong[WRONG_COUNT];
    make_wrong(wrong);
    for (int i = 0; i < WRONG_COUNT; i++) {
        const alp_lamp lamps[2] = {point_lamp(), wrong[i].lamp};
        const alp_lighting_options o = options_of(lamps, 2);
        check_refused(context, scene, &o, wrong[i].said);
        assert_non_null(strstr(alp_context_message(context), "lamp 1"));
    }
    const alp_lighting_options none = options_of(NULL, 3);
    check_refused(context, scene, &none, "lamps is NULL");
    const alp_lamp lamp = point_lamp();
    const alp_lighting_options many = options_of(&lamp, 1000001);
    check_refused(context, scene, &many, "1000001 lamps");
    alp_scene_destroy(scene);
}

/// What a point lamp does not read may be anything; the ends of ranges are inside.
TEST_WITH_CONTEXT(ends_of_ranges_are_good, 1)
{
    alp_scene *scene = small_ground(context);
    alp_lamp lamps[4] = {point_lamp(), spot_lamp(0.1), spot_lamp(0.1), alp_lamp_default()};
    lamps[0].inner_cone = lamps[0].direction[0] = NAN;
    lamps[1].inner_cone = 0.0f;
    lamps[1].outer_cone = (float)(ALPI_PI / 2.0);
    lamps[2].direction[1] = -1e-45f; // the least float
    lamps[2].intensity = 1e20f;
    lamps[2].color[0] = 1e10f;
    lamps[2].position[2] = -1e15f;
    const alp_lighting_options o = options_of(lamps, 4);
    alpi_lighting *lighting = NULL;
    ASSERT_OK(context, alpi_lighting_create(scene, &o, &lighting));
    ASSERT_NEAR(alpi_lighting_light(lighting, 2)->direction.y, -1.0, 1e-7);
    const test_estimate e = test_light_estimate(lighting, ORIGIN, UP, 1000, 2);
    assert_true(isfinite(e.mean));
    alpi_lighting_destroy(context, lighting);
    const alp_lighting_options dark = options_of(&lamps[3], 1);
    ASSERT_OK(context, alpi_lighting_create(scene, &dark, &lighting));
    assert_true(alpi_lighting_is_dark(lighting)); // of 0 candela
    alpi_lighting_destroy(context, lighting);
    alp_scene_destroy(scene);
}

TEST(memory_may_run_out)
{
    int left = 1000;
    alp_context *context = test_context_failing(&left);
    alp_scene *scene = small_ground(context);
    const alp_lamp lamps[2] = {point_lamp(), spot_lamp(0.1)};
    alp_lighting_options o = options_of(lamps, 2);
    o.sun.illuminance = 1.0f;
    int needed = 0;
    for (alp_result result = ALP_ERROR_OUT_OF_MEMORY; result != ALP_OK; needed++) {
        alpi_lighting *lighting = NULL;
        left = needed;
        result = alpi_lighting_create(scene, &o, &lighting);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_true((lighting != NULL) == (result == ALP_OK));
        left = 1000;
        alpi_lighting_destroy(context, lighting);
    }
    assert_in_range(needed, 4, 100); // at least itself, its lights, their names and the sun's
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}
