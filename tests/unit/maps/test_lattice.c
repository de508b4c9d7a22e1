// SPDX-License-Identifier: MIT
#include "base/context.h"
#include "maps/lattice.h"
#include "test_scenes.h"

#include <math.h>

enum { SIZE = 32 };

typedef struct lattice_setup {
    alp_context *context;
    alp_scene *scene;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_lattice lattice;
} lattice_setup;

/// A square that fills a page of SIZE² and one beside it that does not touch it.
static void set_up(lattice_setup *s)
{
    *s = (lattice_setup){.context = test_context(2)};
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){0, 0, 1}, (double[]){1, 0, 0});
    test_mesh_quad(mesh, (double[]){3, 0, 0}, (double[]){0, 0, 1}, (double[]){1, 0, 0});
    s->scene = test_mesh_scene(s->context, mesh, 1);
    alp_atlas_options options = alp_atlas_options_default();
    options.size = SIZE;
    options.texels_per_metre = SIZE;
    options.padding = 0;
    ASSERT_OK(s->context, alp_atlas_create(s->scene, &options, &s->atlas));
    ASSERT_OK(s->context, alpi_texels_create(s->atlas, &s->texels));
    ASSERT_OK(s->context, alpi_lattice_create(s->atlas, &s->texels, &s->lattice));
    assert_int_equal(s->texels.count, 2 * SIZE * SIZE);
}

static void tear_down(lattice_setup *s)
{
    alpi_lattice_destroy(&s->lattice);
    alpi_texels_destroy(s->context, &s->texels);
    alp_atlas_destroy(s->atlas);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

static void every_texel_has_its_pass_and_its_turn(void **state)
{
    (void)state;
    // Of 4 × 4 texels one is the lattice; 2 and 1 belong to spacing 4; 4, 4 and 4 to spacing 2.
    uint32_t counts[ALPI_LATTICE_PASSES] = {0};
    for (uint16_t y = 0; y < 4; y++) {
        for (uint16_t x = 0; x < 4; x++) {
            counts[alpi_lattice_pass((uint16_t[]){x, y})]++;
        }
    }
    const uint32_t expected[ALPI_LATTICE_PASSES] = {1, 2, 1, 4, 4, 4};
    assert_memory_equal(counts, expected, sizeof counts);
    assert_int_equal(alpi_lattice_pass((uint16_t[]){6, 4}), 1);
    assert_int_equal(alpi_lattice_pass((uint16_t[]){6, 10}), 2);
    assert_int_equal(alpi_lattice_pass((uint16_t[]){7, 8}), 3);
    assert_int_equal(alpi_lattice_pass((uint16_t[]){7, 10}), 4);
    assert_int_equal(alpi_lattice_pass((uint16_t[]){7, 9}), 5);
    assert_true(alpi_lattice_is_coarse((uint16_t[]){6, 10}));
    assert_false(alpi_lattice_is_coarse((uint16_t[]){7, 8}));

    lattice_setup s;
    set_up(&s);
    static uint8_t seen[2 * SIZE * SIZE];
    memset(seen, 0, sizeof seen);
    for (uint32_t i = 0; i < s.texels.count; i++) {
        seen[s.lattice.order[i]]++;
    }
    for (uint32_t i = 0; i < s.texels.count; i++) {
        assert_int_equal(seen[i], 1);
    }
    for (uint32_t i = 0; i < 8; i++) { // the first eight are one block of 4 × 2
        assert_true(s.texels.pixels[s.lattice.order[i]][0] < 4);
        assert_true(s.texels.pixels[s.lattice.order[i]][1] < 2);
    }
    tear_down(&s);
}

static bool is_between_two(uint32_t pass)
{
    return pass == 1 || pass == 3 || pass == 4;
}

/// A polynomial of degree three in x plus one in y.
static float cubic(const uint16_t *p)
{
    const float x = (float)p[0] / SIZE, y = (float)p[1] / SIZE;
    return 0.3f + 0.4f * x - 0.9f * x * x + 0.8f * x * x * x + 0.2f * y * y * y - 0.1f * y;
}

static void cubics_are_interpolated_exactly(void **state)
{
    (void)state;
    lattice_setup s;
    set_up(&s);
    alpi_lattice *l = &s.lattice;
    uint32_t cubic_count = 0;
    for (uint32_t i = 0; i < s.texels.count; i++) {
        l->values[i] = cubic(s.texels.pixels[i]);
        l->states[i] = ALPI_TEXEL_TRACED;
    }
    for (uint32_t i = 0; i < s.texels.count; i++) {
        alpi_stencil stencil;
        if (!alpi_lattice_stencil(l, i, &stencil)) {
            continue; // of the lattice, or at the border
        }
        float weight = 0.0f;
        for (uint32_t k = 0; k < stencil.count; k++) {
            weight += stencil.weights[k];
        }
        ASSERT_NEAR(weight, 1.0f, 1e-6);
        const uint32_t pass = alpi_lattice_pass(s.texels.pixels[i]);
        const uint32_t whole = is_between_two(pass) ? 4 : 8;
        if (stencil.count == whole) {
            ASSERT_NEAR(alpi_lattice_interpolate(l, &stencil), cubic(s.texels.pixels[i]), 2e-6);
            cubic_count++;
        }
    }
    assert_true(cubic_count > SIZE * SIZE);
    tear_down(&s);
}

/// A parabola along x: the mean of two at ±h misses ½ E'' h² of it, and the cubic misses nothing.
static void straight_stencils_take_two_and_know_their_bend(void **state)
{
    (void)state;
    lattice_setup s;
    set_up(&s);
    alpi_lattice *l = &s.lattice;
    const float bent = 0.01f;
    l->straight = true;
    for (uint32_t i = 0; i < s.texels.count; i++) {
        const float x = (float)s.texels.pixels[i][0];
        l->values[i] = 0.5f * bent * x * x;
        l->states[i] = ALPI_TEXEL_TRACED;
    }
    for (uint32_t pass = 1; pass < ALPI_LATTICE_PASSES; pass++) {
        const uint32_t h = alpi_lattice_reach(pass);
        const uint32_t x = 16 + h, y = pass == 4 ? 18 : is_between_two(pass) ? 16 : 16 + h;
        const uint32_t texel = l->grid[y * SIZE + x];
        assert_int_equal(alpi_lattice_pass(s.texels.pixels[texel]), pass);
        alpi_stencil stencil;
        assert_true(alpi_lattice_stencil(l, texel, &stencil));
        const uint32_t axes = is_between_two(pass) ? 1 : 2;
        assert_int_equal(stencil.count, 2 * axes);
        for (uint32_t k = 0; k < stencil.count; k++) {
            assert_true(stencil.weights[k] == 0.5f / (float)axes);
        }
        const float missed = 0.5f * bent * (float)(h * h);
        ASSERT_NEAR(stencil.bend, missed, 1e-6); // rounding of values up to 5
        ASSERT_NEAR(alpi_lattice_interpolate(l, &stencil), l->values[texel] + missed / (float)axes,
                    1e-6);
    }
    tear_down(&s);
}

/// Where one of the four, or two, is missing, those along the border do; and no other ones.
static void at_a_border_stencils_go_along_it(void **state)
{
    (void)state;
    lattice_setup s;
    set_up(&s);
    alpi_lattice *l = &s.lattice;
    for (uint32_t i = 0; i < s.texels.count; i++) {
        const uint16_t *p = s.texels.pixels[i];
        l->values[i] = (float)p[1] + (p[0] == SIZE - 1 ? 0.0f : 100.0f);
        l->states[i] = ALPI_TEXEL_TRACED;
    }
    const uint32_t x = SIZE - 1; // odd: beyond it is another chart, or none
    for (uint32_t y = 4; y < SIZE - 4; y++) {
        const uint32_t texel = l->grid[y * SIZE + x];
        alpi_stencil stencil;
        l->borders = false;
        assert_false(alpi_lattice_stencil(l, texel, &stencil));
        l->borders = true;
        const bool found = alpi_lattice_stencil(l, texel, &stencil);
        assert_int_equal(found, y % 4 != 0); // pass 3 has none before it
        for (uint32_t k = 0; found && k < stencil.count; k++) {
            const uint16_t *p = s.texels.pixels[stencil.texels[k]];
            assert_int_equal(p[0], x);
            assert_true(alpi_lattice_pass(p) < alpi_lattice_pass(s.texels.pixels[texel]));
        }
        if (found) {
            ASSERT_NEAR(alpi_lattice_interpolate(l, &stencil), (float)y, 1e-5);
        }
    }
    // Inside a chart nothing changes.
    for (uint32_t y = 8; y < 12; y++) {
        for (uint32_t inner = 8; inner < 12; inner++) {
            alpi_stencil with, without;
            const uint32_t texel = l->grid[y * SIZE + inner];
            l->borders = true;
            const bool found = alpi_lattice_stencil(l, texel, &with);
            l->borders = false;
            assert_int_equal(found, alpi_lattice_stencil(l, texel, &without));
            assert_true(!found || with.count == without.count);
            assert_true(!found || with.weights[0] == without.weights[0]);
        }
    }
    tear_down(&s);
}

static void no_stencil_crosses_a_chart_or_takes_the_unknown(void **state)
{
    (void)state;
    lattice_setup s;
    set_up(&s);
    alpi_lattice *l = &s.lattice;
    for (uint32_t i = 0; i < s.texels.count; i++) {
        l->states[i] = ALPI_TEXEL_TRACED;
    }
    for (uint32_t i = 0; i < s.texels.count; i++) {
        alpi_stencil stencil;
        const bool found = alpi_lattice_stencil(l, i, &stencil);
        for (uint32_t k = 0; found && k < stencil.count; k++) {
            assert_int_equal(s.texels.charts[stencil.texels[k]], s.texels.charts[i]);
            assert_int_equal(s.texels.pages[stencil.texels[k]], s.texels.pages[i]);
        }
        l->states[i] = ALPI_TEXEL_OPEN; // what comes later must not use it
        for (uint32_t k = 0; found && k < stencil.count; k++) {
            assert_true(l->states[stencil.texels[k]] != ALPI_TEXEL_OPEN);
            assert_true(stencil.texels[k] != i);
        }
        l->states[i] = ALPI_TEXEL_TRACED;
    }
    // A crease between two texels stops interpolation across it.
    const uint32_t middle = l->grid[8 * SIZE + 10];
    alpi_stencil stencil;
    assert_true(alpi_lattice_stencil(l, middle, &stencil));
    s.texels.normals[l->grid[8 * SIZE + 12]][0] = 1.0f;
    s.texels.normals[l->grid[8 * SIZE + 12]][1] = 0.0f;
    assert_false(alpi_lattice_stencil(l, middle, &stencil));
    tear_down(&s);
}

static void kinks_are_found_beside_traced_texels_only(void **state)
{
    (void)state;
    lattice_setup s;
    set_up(&s);
    alpi_lattice *l = &s.lattice;
    for (uint32_t i = 0; i < s.texels.count; i++) {
        l->states[i] = ALPI_TEXEL_INTERPOLATED;
        l->values[i] = 0.01f * (float)s.texels.pixels[i][0]; // a slope is no kink
    }
    const uint32_t middle = l->grid[8 * SIZE + 10];
    assert_true(alpi_lattice_kink(l, middle) == 0.0f);
    l->states[l->grid[8 * SIZE + 11]] = ALPI_TEXEL_TRACED;
    ASSERT_NEAR(alpi_lattice_kink(l, middle), 0.0, 1e-6);
    l->values[l->grid[8 * SIZE + 11]] += 0.2f;
    ASSERT_NEAR(alpi_lattice_kink(l, middle), 0.05, 1e-6);
    const uint32_t corner = l->grid[0]; // two neighbours: half of its step
    l->states[l->grid[1]] = ALPI_TEXEL_TRACED;
    l->values[l->grid[1]] = 0.31f;
    ASSERT_NEAR(alpi_lattice_kink(l, corner), 0.155, 1e-6);
    tear_down(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_texel_has_its_pass_and_its_turn),
        cmocka_unit_test(cubics_are_interpolated_exactly),
        cmocka_unit_test(straight_stencils_take_two_and_know_their_bend),
        cmocka_unit_test(at_a_border_stencils_go_along_it),
        cmocka_unit_test(no_stencil_crosses_a_chart_or_takes_the_unknown),
        cmocka_unit_test(kinks_are_found_beside_traced_texels_only),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
