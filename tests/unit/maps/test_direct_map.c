// SPDX-License-Identifier: MIT
// Direct light on a chequerboard: which texels gather theirs, and what the others get.
#include "test_radiant.h"
#include "test_scenes.h"

#include "base/memory.h"
#include "maps/radiosity/direct_map.h"
#include "maps/texels/validity.h"

#include <math.h>

static const vec3 ZERO = {0, 0, 0}, HALF = {0.5f, 0.5f, 0.5f};
static const double ERROR = 0.02;
enum { LAYERS = 2 };

/// What is gathered of all texels, and what a map by the chequerboard makes of it.
typedef struct setting {
    alp_context *context;
    test_radiant r;
    uint32_t texels;
    alpi_reference_value *all, *values; // [2 × texels] of both sides
    alpi_directional *all_directional, *directional;
    float (*layers[LAYERS])[3];
    uint32_t gathered;
} setting;

/// A floor that is lit from above and from below, with a small plate over its middle. Lamps have
/// no neighbours to ask: what a texel gathers of them does not hang on who else does.
static void set_up(setting *s)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    *s = (setting){.context = test_context(2)};
    alpi_builder_start(&b, s->context, "floor");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "floor", HALF, ZERO));
    alpi_builder_quad(&b, (const vec3[4]){{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}});
    alpi_builder_surface(&b, "plate", alpi_builder_material(&b, "plate", HALF, ZERO));
    alpi_builder_quad(
        &b,
        (const vec3[4]){{-.2f, .3f, .2f}, {.2f, .3f, .2f}, {.2f, .3f, -.2f}, {-.2f, .3f, -.2f}});
    ASSERT_OK(s->context, alpi_builder_finish(&b, &scene));
    scene->materials[0].double_sided = scene->materials[1].double_sided = true;
    const alpi_light lamps[LAYERS] = {{.kind = ALP_LIGHT_POINT,
                                       .color = {1.0f, 0.25f, 0.125f},
                                       .intensity = 9.0f,
                                       .position = {0.1f, 1.5f, 0.2f},
                                       .range = INFINITY},
                                      {.kind = ALP_LIGHT_POINT,
                                       .color = {0.25f, 1.0f, 0.5f},
                                       .intensity = 5.0f,
                                       .position = {-0.4f, -2.0f, 0.3f},
                                       .range = INFINITY}};
    test_lit_set_lamps(scene, lamps, LAYERS);
    test_radiant_options o = test_radiant_default();
    o.size = 128;
    o.direct_samples = 8;
    o.bounces = 1;
    test_radiant_open(scene, &o, &s->r);
    s->texels = s->r.texels.count;
    s->all = ALPI_NEW(s->context, alpi_reference_value, 2 * s->texels);
    s->values = ALPI_NEW(s->context, alpi_reference_value, 2 * s->texels);
    s->all_directional = ALPI_NEW(s->context, alpi_directional, s->texels);
    s->directional = ALPI_NEW(s->context, alpi_directional, s->texels);
    for (int k = 0; k < LAYERS; k++) {
        s->layers[k] = alpi_allocate(s->context, 2 * s->texels, sizeof *s->layers[k]);
    }
}

static void tear_down(setting *s)
{
    alpi_release(s->context, s->all);
    alpi_release(s->context, s->values);
    alpi_release(s->context, s->all_directional);
    alpi_release(s->context, s->directional);
    for (int k = 0; k < LAYERS; k++) {
        alpi_release(s->context, s->layers[k]);
    }
    test_radiant_close(&s->r);
    alp_context_destroy(s->context);
}

/// Direct light of all texels of a side. @param error 0: all gather
static void map(setting *s, bool backs, double error, const uint8_t *near)
{
    static const uint32_t part_layers[LAYERS] = {0, 1};
    const bool all = error == 0.0;
    alpi_light_layers layers = {.context = s->context, .count = LAYERS, .part_layers = part_layers};
    for (int k = 0; k < LAYERS; k++) {
        layers.direct[k] = s->layers[k];
        memset(s->layers[k], 0, 2 * s->texels * sizeof *s->layers[k]);
    }
    const alpi_direct_map_options options = {&s->r.lattice, near, error, backs};
    alpi_direct_output output = {.values = all ? s->all : s->values};
    if (!backs) {
        output.directional = all ? s->all_directional : s->directional;
    }
    uint32_t *list = ALPI_NEW(s->context, uint32_t, s->texels);
    for (uint32_t i = 0; i < s->texels; i++) {
        list[i] = s->r.lattice.order[i] + (backs ? s->texels : 0);
    }
    s->r.solution.options.layers = &layers;
    ASSERT_OK(s->context, alpi_direct_map(&s->r.solution, &options, list, s->texels, NULL, &output,
                                          &s->gathered));
    s->r.solution.options.layers = NULL;
    alpi_release(s->context, list);
    assert_true(all == (s->gathered == s->texels) || near != NULL);
}

static double level(const alpi_reference_value *v)
{
    return ((double)v->mean[0] + (double)v->mean[1] + (double)v->mean[2]) / 3.0;
}

/// The texels `far` beside one, left, right, above, below. @return whether all are of its chart
static bool find_beside(const setting *s, uint32_t texel, int far, uint32_t beside[4])
{
    static const int ways[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    const uint16_t *p = s->r.texels.pixels[texel];
    for (int i = 0; i < 4; i++) {
        beside[i] = alpi_lattice_texel(&s->r.lattice, s->r.texels.pages[texel],
                                       p[0] + far * ways[i][0], p[1] + far * ways[i][1]);
        if (beside[i] == ALPI_NONE || s->r.texels.charts[beside[i]] != s->r.texels.charts[texel]) {
            return false;
        }
    }
    return true;
}

static bool is_same(const float a[3], const float b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

typedef struct board_texel {
    bool even, known; // of the board; with all eight neighbours that tell how much light bends
    uint32_t beside[4];
    double bend, spread;
} board_texel;

/// @param values of one side
static board_texel look_at(const setting *s, const alpi_reference_value *values, uint32_t texel)
{
    const uint16_t *p = s->r.texels.pixels[texel];
    uint32_t beyond[4];
    board_texel t = {.even = (p[0] + p[1]) % 2 == 0};
    t.known = find_beside(s, texel, 1, t.beside) && find_beside(s, texel, 3, beyond);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; i < 4 && t.known; i++) {
        low = fmin(low, level(&values[t.beside[i]]));
        high = fmax(high, level(&values[t.beside[i]]));
    }
    for (int i = 0; i < 4 && t.known; i += 2) {
        const double inner = level(&values[t.beside[i]]) + level(&values[t.beside[i + 1]]);
        const double outer = level(&values[beyond[i]]) + level(&values[beyond[i + 1]]);
        t.bend = fmax(t.bend, fabs(inner - outer) / 16.0);
    }
    t.spread = high - low;
    return t;
}

static double mean_of_board(const setting *s, const alpi_reference_value *values)
{
    double sum = 0.0, count = 0.0;
    for (uint32_t t = 0; t < s->texels; t++) {
        const uint16_t *p = s->r.texels.pixels[t];
        sum += (p[0] + p[1]) % 2 == 0 ? level(&values[t]) : 0.0;
        count += (p[0] + p[1]) % 2 == 0 ? 1.0 : 0.0;
    }
    return sum / count;
}

/// The mean of four floats that lie `stride` floats apart for each texel.
static double mean_beside(const board_texel *t, const float *first, size_t stride)
{
    double sum = 0.0;
    for (int i = 0; i < 4; i++) {
        sum += 0.25 * (double)first[t->beside[i] * stride];
    }
    return sum;
}

static void assert_interpolated(const setting *s, const board_texel *t, uint32_t texel, bool backs)
{
    enum {
        VALUE = sizeof *s->values / sizeof(float),
        WAY = sizeof *s->directional / sizeof(float)
    };
    const size_t first = backs ? s->texels : 0;
    for (int k = 0; k < 3; k++) {
        const float *mean = &s->values[first].mean[k], *variance = &s->values[first].variance[k];
        ASSERT_NEAR(mean[texel * VALUE], mean_beside(t, mean, VALUE), 1e-5);
        ASSERT_NEAR(variance[texel * VALUE],
                    0.25 * mean_beside(t, variance, VALUE) + t->bend * t->bend, 1e-7);
        for (int layer = 0; layer < LAYERS; layer++) {
            const float *light = &s->layers[layer][first][k];
            ASSERT_NEAR(light[texel * 3], mean_beside(t, light, 3), 1e-5);
        }
        if (!backs) {
            const float *sh = &s->directional->sh[2][k], *toward = &s->directional->toward[k];
            ASSERT_NEAR(sh[texel * WAY], mean_beside(t, sh, WAY), 1e-5);
            ASSERT_NEAR(toward[texel * WAY], mean_beside(t, toward, WAY), 1e-4);
        }
    }
}

/// The rule of direct_map.h, and that layers add up.
static void texels_between_are_means_where_light_is_even(void **state)
{
    (void)state;
    setting s;
    set_up(&s);
    for (int backs = 0; backs < 2; backs++) {
        const size_t first = backs ? s.texels : 0;
        uint32_t between = 0, bent = 0, spread = 0;
        map(&s, backs != 0, 0.0, NULL);
        map(&s, backs != 0, ERROR, NULL);
        const alpi_reference_value *all = s.all + first, *values = s.values + first;
        const double mean = mean_of_board(&s, all);
        const double most_bend = 0.25 * ERROR * mean, most_spread = sqrt(ERROR) * mean;
        for (uint32_t t = 0; t < s.texels; t++) {
            const board_texel b = look_at(&s, all, t);
            const bool may = b.bend < most_bend && b.spread < most_spread;
            const bool own = is_same(values[t].mean, all[t].mean);
            ASSERT_NEAR(s.layers[0][first + t][0] + s.layers[1][first + t][0], values[t].mean[0],
                        1e-5);
            if (b.even || (b.known && !may)) {
                assert_true(own);
            } else if (b.known) {
                assert_interpolated(&s, &b, t, backs != 0);
                ASSERT_NEAR(level(&values[t]), level(&all[t]), 0.5 * most_spread);
                between += !own;
            }
            bent += b.known && !b.even && b.bend > most_bend;
            spread += b.known && !b.even && b.spread > most_spread;
        }
        assert_true(between > s.texels / 4 && s.gathered <= s.texels - between);
        assert_true(backs != 0 || (bent > 20 && spread > 20)); // the shadow of the plate
    }
    tear_down(&s);
}

static void touching_texels_gather(void **state)
{
    (void)state;
    setting s;
    set_up(&s);
    uint8_t *near = ALPI_NEW(s.context, uint8_t, s.texels);
    map(&s, false, 0.0, NULL);
    memset(near, ALPI_NEAR, s.texels);
    map(&s, false, ERROR, near);
    assert_true(s.gathered < 3 * s.texels / 4);
    memset(near, ALPI_TOUCHING, s.texels);
    map(&s, false, ERROR, near);
    assert_int_equal(s.gathered, s.texels);
    for (uint32_t t = 0; t < s.texels; t++) {
        assert_true(is_same(s.values[t].mean, s.all[t].mean));
    }
    alpi_release(s.context, near);
    tear_down(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_between_are_means_where_light_is_even),
        cmocka_unit_test(touching_texels_gather),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
