// SPDX-License-Identifier: MIT
#include "base/context.h"
#include "maps/texels/lattice.h"
#include "maps/texels/validity.h"
#include "test_scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

TEST(every_texel_has_its_pass_and_its_turn)
{
    // Of 8 × 8 texels four are the lattice; 8 and 4 belong to spacing 4; 16, 16 and 16 to
    // spacing 2.
    static const uint32_t expected[ALPI_LATTICE_LEVELS] = {4, 8, 4, 16, 16, 16};
    uint32_t counts[ALPI_LATTICE_LEVELS] = {0};
    for (uint16_t y = 0; y < 8; y++) {
        for (uint16_t x = 0; x < 8; x++) {
            counts[alpi_lattice_level((uint16_t[]){x, y})]++;
        }
    }
    assert_memory_equal(counts, expected, sizeof counts);
    static const struct {
        uint16_t pixel[2];
        uint32_t level;
    } texels[] = {{{24, 8}, 0}, {{20, 8}, 0}, {{8, 12}, 0}, {{12, 4}, 0}, {{6, 4}, 1},
                  {{6, 10}, 2}, {{7, 8}, 3},  {{7, 10}, 4}, {{7, 9}, 5}};
    for (size_t i = 0; i < sizeof texels / sizeof *texels; i++) {
        assert_int_equal(alpi_lattice_level(texels[i].pixel), texels[i].level);
    }
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

static bool is_between_two(uint32_t level)
{
    return level == 1 || level == 3 || level == 4;
}

/// A polynomial of degree three in x plus one in y.
static float cubic(const uint16_t *p)
{
    const float x = (float)p[0] / SIZE, y = (float)p[1] / SIZE;
    return 0.3f + 0.4f * x - 0.9f * x * x + 0.8f * x * x * x + 0.2f * y * y * y - 0.1f * y;
}

TEST(cubics_are_interpolated_exactly)
{
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
        const uint32_t level = alpi_lattice_level(s.texels.pixels[i]);
        const uint32_t whole = is_between_two(level) ? 4 : 8;
        if (stencil.count == whole) {
            ASSERT_NEAR(alpi_lattice_interpolate(l, &stencil), cubic(s.texels.pixels[i]), 2e-6);
            cubic_count++;
        }
    }
    assert_true(cubic_count > SIZE * SIZE);
    tear_down(&s);
}

/// A parabola along x: the mean of two at ±h misses ½ E'' h² of it, and the cubic misses nothing.
TEST(straight_stencils_take_two_and_know_their_bend)
{
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
    for (uint32_t level = 1; level < ALPI_LATTICE_LEVELS; level++) {
        const uint32_t h = alpi_lattice_reach(level);
        const bool beside = level == 4; // rows of the lattice
        const uint32_t x = 16 - h, y = beside ? 18 : is_between_two(level) ? 16 : 16 - h;
        const uint32_t texel = l->grid[y * SIZE + x];
        assert_int_equal(alpi_lattice_level(s.texels.pixels[texel]), level);
        alpi_stencil stencil;
        assert_true(alpi_lattice_stencil(l, texel, &stencil));
        const uint32_t axes = is_between_two(level) ? 1 : 2;
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

/// A texel of the line that is the border, counted along it: of the last column, or the last row.
static uint32_t at_border(const alpi_lattice *l, bool row, uint32_t border, uint32_t along)
{
    return l->grid[row ? border * SIZE + along : along * SIZE + border];
}

/// Light that is a parabola along the border, and far from it beside it: of stencils that go along
/// it, what they miss is known, and they take no others, all of coarser levels.
static void hold_border(lattice_setup *s, bool row, uint32_t border)
{
    alpi_lattice *l = &s->lattice;
    const float bent = 0.01f;
    const int across = row ? 1 : 0;
    for (uint32_t i = 0; i < s->texels.count; i++) {
        const uint16_t *p = s->texels.pixels[i];
        const float along = (float)p[1 - across];
        l->values[i] = 0.5f * bent * along * along + (p[across] == border ? 0.0f : 100.0f);
        l->states[i] = p[across] <= border ? ALPI_TEXEL_TRACED : ALPI_TEXEL_OPEN;
    }
    for (uint32_t along = 8; along < SIZE - 8; along++) {
        const uint32_t texel = at_border(l, row, border, along);
        const uint32_t level = alpi_lattice_level(s->texels.pixels[texel]);
        alpi_stencil stencil;
        l->straight = false;
        const bool inside = alpi_lattice_stencil(l, texel, &stencil);
        l->straight = true;
        const bool found = alpi_lattice_stencil(l, texel, &stencil);
        // What is halfway has beyond the border nothing along it stands for, but of the last but
        // one.
        const bool goes_along = level == 2 || level == 4 || level == 5;
        assert_int_equal(found, inside || goes_along);
        if (!found || inside) {
            continue;
        }
        float weight = 0.0f;
        const float h = level == 5 ? 1.0f : 2.0f;
        const float missed = 0.5f * bent * h * h;
        if ((float)along + 3.0f * h >= SIZE) {
            continue; // no four in a row
        }
        assert_int_equal(stencil.count, 2);
        for (uint32_t k = 0; k < stencil.count; k++) {
            const uint16_t *p = s->texels.pixels[stencil.texels[k]];
            assert_int_equal(p[across], border);
            assert_true(alpi_lattice_level(p) < level);
            weight += stencil.weights[k];
        }
        ASSERT_NEAR(weight, 1.0f, 1e-6);
        ASSERT_NEAR(stencil.bend, missed, 2e-6);
        ASSERT_NEAR(stencil.spread, bent * (float)along * 2.0f * h, 1e-5);
        ASSERT_NEAR(alpi_lattice_interpolate(l, &stencil), l->values[texel] + missed, 2e-6);
    }
}

/// Where one of the four, or two, is missing, those along the border do.
TEST(at_a_border_stencils_go_along_it)
{
    // Odd, 2 beyond the lattice, and of it.
    static const uint32_t borders[] = {SIZE - 1, SIZE - 2, SIZE - 10, SIZE - 4};
    lattice_setup s;
    set_up(&s);
    alpi_lattice *l = &s.lattice;
    for (int k = 0; k < 8; k++) {
        hold_border(&s, k % 2 != 0, borders[k / 2]);
    }
    // Inside a chart the same texels have stencils.
    for (uint32_t i = 0; i < s.texels.count; i++) {
        l->states[i] = ALPI_TEXEL_TRACED;
    }
    for (uint32_t i = 0; i < 64; i++) {
        alpi_stencil stencil;
        const uint32_t texel = l->grid[(8 + i / 8) * SIZE + 8 + i % 8];
        l->straight = true;
        const bool found = alpi_lattice_stencil(l, texel, &stencil);
        l->straight = false;
        assert_int_equal(found, alpi_lattice_stencil(l, texel, &stencil));
    }
    tear_down(&s);
}

/// What is near another surface has limits of its own.
TEST(near_surfaces_the_judge_is_stricter)
{
    lattice_setup s;
    set_up(&s);
    alpi_lattice *l = &s.lattice;
    const uint32_t middle = l->grid[16 * SIZE + 18]; // of level 1, between x = 16 and 20
    uint8_t near[2 * SIZE * SIZE] = {0}, marked[2 * SIZE * SIZE] = {0};
    for (uint32_t i = 0; i < s.texels.count; i++) {
        const float x = (float)s.texels.pixels[i][0];
        const bool bent = x == 12.0f || x == 24.0f;
        l->values[i] = x + (bent ? 4.0f : 0.0f); // spread 4, bend a half
    }
    alpi_lattice_judge judge = {
        .lattice = l, .order = &middle, .proximity = near, .marked = marked, .level = 1};
    static const struct {
        float spread, bend, near_spread, near_bend;
        bool far_is_smooth, near_is_smooth;
    } cases[] = {{4.1f, 0.51f, 1.0f, 1.0f, true, true},   {3.9f, 0.51f, 1.0f, 1.0f, false, false},
                 {4.1f, 0.49f, 1.0f, 1.0f, false, false}, {8.1f, 0.51f, 0.5f, 1.0f, true, true},
                 {7.9f, 0.51f, 0.5f, 1.0f, true, false},  {4.1f, 1.01f, 1.0f, 0.5f, true, true},
                 {4.1f, 0.99f, 1.0f, 0.5f, true, false}};
    for (size_t i = 0; i < 2 * (sizeof cases / sizeof *cases); i++) {
        memset(l->states, ALPI_TEXEL_TRACED, s.texels.count);
        l->states[middle] = ALPI_TEXEL_OPEN;
        marked[middle] = 0;
        near[middle] = i % 2 == 0 ? ALPI_FAR : ALPI_NEAR;
        judge.spread = cases[i / 2].spread;
        judge.bend = cases[i / 2].bend;
        judge.near_spread = cases[i / 2].near_spread;
        judge.near_bend = cases[i / 2].near_bend;
        alpi_lattice_judge_range(&judge, 0, 1);
        const bool smooth = i % 2 == 0 ? cases[i / 2].far_is_smooth : cases[i / 2].near_is_smooth;
        assert_int_equal(marked[middle], !smooth);
        assert_int_equal(l->states[middle], smooth ? ALPI_TEXEL_INTERPOLATED : ALPI_TEXEL_OPEN);
    }
    tear_down(&s);
}

TEST(no_stencil_crosses_a_chart_or_takes_the_unknown)
{
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

TEST(kinks_are_found_beside_traced_texels_only)
{
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

typedef struct turns {
    const alpi_lattice *lattice;
    uint8_t counts[2 * SIZE * SIZE], early[2 * SIZE * SIZE]; // by texel
} turns;

static void take_turn(void *user, uint32_t texel, const alpi_stencil *stencil)
{
    turns *t = user;
    t->counts[texel]++;
    for (uint32_t k = 0; k < stencil->count; k++) {
        const uint32_t n = stencil->texels[k];
        const bool traced = t->lattice->states[n] == ALPI_TEXEL_TRACED;
        t->early[texel] |= !traced && t->counts[n] == 0 ? 1 : 0;
    }
}

/// Each interpolated texel has one turn, after the texels of its stencil.
TEST(stencils_take_their_turn_level_by_level)
{
    static turns t;
    lattice_setup s;
    set_up(&s);
    uint32_t interpolated = 0;
    t = (turns){.lattice = &s.lattice};
    memset(s.lattice.states, ALPI_TEXEL_TRACED, s.texels.count);
    for (uint32_t i = 0; i < s.texels.count; i++) {
        alpi_stencil stencil;
        if (i % 7 != 0 && alpi_lattice_stencil(&s.lattice, i, &stencil)) {
            s.lattice.states[i] = ALPI_TEXEL_INTERPOLATED;
            interpolated++;
        }
    }
    assert_true(interpolated > SIZE * SIZE);
    ASSERT_OK(s.context, alpi_lattice_for_stencils(&s.lattice, s.lattice.order, s.texels.count,
                                                   take_turn, &t, NULL));
    for (uint32_t i = 0; i < s.texels.count; i++) {
        assert_int_equal(t.counts[i], s.lattice.states[i] == ALPI_TEXEL_INTERPOLATED);
        assert_int_equal(t.early[i], 0);
    }
    tear_down(&s);
}

/// At corners, edges and inside: as many texels as the page has there, the middle among them.
TEST(around_a_texel_lie_up_to_nine)
{
    lattice_setup s;
    set_up(&s);
    static const struct {
        uint32_t x, y, count, itself;
    } cases[] = {{0, 0, 4, 0}, {5, 0, 6, 1}, {0, 5, 6, 2}, {5, 5, 9, 4}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint32_t around[ALPI_AROUND_LIMIT];
        const uint32_t texel = s.lattice.grid[cases[i].y * SIZE + cases[i].x];
        assert_int_equal(alpi_lattice_around(&s.lattice, texel, around), cases[i].count);
        assert_int_equal(around[cases[i].itself], texel);
        for (uint32_t k = 0; k < cases[i].count; k++) {
            const uint16_t *p = s.texels.pixels[around[k]];
            assert_true(abs((int)p[0] - (int)cases[i].x) <= 1 &&
                        abs((int)p[1] - (int)cases[i].y) <= 1);
            assert_true(k == 0 || around[k] > around[k - 1]);
        }
    }
    tear_down(&s);
}

static bool refuse(void *user, const alp_progress *progress)
{
    assert_string_equal(progress->stage, "build");
    ++*(int *)user;
    return false;
}

TEST(it_can_be_cancelled)
{
    lattice_setup s;
    set_up(&s);
    int asked = 0;
    alpi_lattice other;
    const alpi_watch before =
        alpi_set_watch(s.context, (alpi_watch){.callback = refuse, .user = &asked});
    assert_int_equal(alpi_lattice_create(s.atlas, &s.texels, &other), ALP_ERROR_CANCELLED);
    (void)alpi_set_watch(s.context, before);
    assert_int_equal(asked, 1);
    tear_down(&s);
}
