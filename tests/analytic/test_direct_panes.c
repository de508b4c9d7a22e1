// SPDX-License-Identifier: MIT
// Direct light through panes: of lamps, skies and emitters behind them, and of panes that emit.
#include "test_direct_stage.h"

#include <math.h>

static const vec3 UP = {0, 1, 0}, DARK = {0, 0, 0};
static const float ALPHA = 0.4f;
static const vec3 COLOR = {1.0f, 0.5f, 0.25f};
TEST_CONTEXT(2);

/// A level square of half side `half` that looks down.
static void add_lid(alpi_builder *b, float half, float height)
{
    const vec3 corners[4] = {
        {-half, height, -half}, {half, height, -half}, {half, height, half}, {-half, height, half}};
    alpi_builder_quad(b, corners);
}

/// A blended pane 1 m above a black floor, and an emitter of half side `lid` at 2 m (0: none).
static alp_scene *make_scene(float pane_emission, float lid)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "panes");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "floor", DARK, DARK));
    alpi_builder_quad(&b, (const vec3[4]){{-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50}});
    const uint32_t pane = alpi_builder_material(
        &b, "pane", COLOR, (vec3){pane_emission, pane_emission, pane_emission});
    b.scene->materials[pane].alpha_mode = ALPI_ALPHA_BLEND;
    b.scene->materials[pane].base_color[3] = ALPHA;
    b.scene->materials[pane].double_sided = true;
    alpi_builder_surface(&b, "pane", pane);
    add_lid(&b, 50.0f, 1.0f);
    if (lid > 0.0f) {
        alpi_builder_surface(&b, "lid",
                             alpi_builder_material(&b, "lid", DARK, (vec3){2.0f, 2.0f, 2.0f}));
        add_lid(&b, lid, 2.0f);
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// (1 − a) lerp(1, c, a).
static double through(int channel)
{
    const double c = channel == 0 ? (double)COLOR.x : channel == 1 ? (double)COLOR.y : 0.25;
    const double a = (double)ALPHA;
    return (1.0 - a) * (1.0 - a + a * c);
}

TEST(lamps_and_skies_are_dimmed)
{
    const test_patch p = test_point(DARK, UP);
    alpi_light lamp = test_lamp((vec3){0, 2, 0}, 8.0f);
    lamp.color = (vec3){1, 1, 1};
    test_stage s = test_stage_open(context, make_scene(0.0f, 0.0f), &lamp, 1, NULL);
    alpi_reference_value v = test_stage_direct(&s, &p, 8, 1, NULL);
    for (int k = 0; k < 3; k++) {
        ASSERT_NEAR(v.mean[k], 2.0 * through(k), 1e-5);
    }
    test_stage_close(&s);
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_CONSTANT;
    s = test_stage_open(context, make_scene(0.0f, 0.0f), NULL, 0, &o);
    v = test_stage_direct(&s, &p, 4096, 1, NULL);
    // The pane ends 50 m away, where 1/2501 of the light comes past it.
    const double rim = 1.0 / 2501.0;
    for (int k = 0; k < 3; k++) {
        ASSERT_NEAR(v.mean[k], ALPI_PI * through(k), ALPI_PI * 2.0 * rim);
    }
    test_stage_close(&s);
}

/// Four rectangles over their corners (oracle 6).
static double lid_factor(double a, double h)
{
    const double x = a / h, q = sqrt(1.0 + x * x);
    return 4.0 * 2.0 * (x / q * atan(x / q)) / (2.0 * ALPI_PI);
}

/// A small lid is asked alone, a large one met too; a pane that glows adds the share of its light
/// that its alpha covers, and dims what is behind it as before.
TEST(emitters_shine_through)
{
    static const float lids[] = {0.4f, 3.0f};
    const test_patch p = test_point(DARK, UP);
    for (int glow = 0; glow < 2; glow++) {
        for (int i = 0; i < 2; i++) {
            test_stage s =
                test_stage_open(context, make_scene(glow ? 0.5f : 0.0f, lids[i]), NULL, 0, NULL);
            const alpi_reference_value v = test_stage_direct(&s, &p, 16384, 1, NULL);
            const double own = glow ? (double)ALPHA * 0.5 * ALPI_PI * lid_factor(50.0, 1.0) : 0.0;
            for (int k = 0; k < 3; k++) {
                const double behind = 2.0 * ALPI_PI * lid_factor((double)lids[i], 2.0) * through(k);
                ASSERT_NEAR(v.mean[k], behind + own,
                            6.0 * sqrt((double)v.variance[k]) + 1e-5 * (behind + own));
                assert_true(sqrt((double)v.variance[k]) < 1e-2 * (behind + own));
            }
            test_stage_close(&s);
        }
    }
}
