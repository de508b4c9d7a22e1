// SPDX-License-Identifier: MIT
// Charts larger than a page: how many pages their parts need, that each is connected, that none
// overlaps, and what density or page a triangle needs that fits none.
#include "atlas_scenes.h"

#include "atlas/box.h"
#include "base/memory.h"
#include "scene/adjacency.h"

#include <math.h>
#include <stdlib.h>

typedef struct wish {
    uint32_t size, padding, block, mips;
    double density;
} wish;

static alp_result cut(const alp_scene *scene, const wish *w, alp_atlas **atlas)
{
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_CHARTS;
    options.size = w->size;
    options.padding = w->padding;
    options.block = w->block > 0 ? w->block : 1;
    options.mips = w->mips;
    options.texels_per_metre = w->density;
    return alp_atlas_create(scene, &options, atlas);
}

static uint32_t root_of(const uint32_t *roots, uint32_t i)
{
    while (roots[i] != i) {
        i = roots[i];
    }
    return i;
}

/// Connected parts of all charts: as many as charts where each is connected.
static uint32_t count_parts(const alp_atlas *atlas)
{
    const uint32_t count = atlas->scene->triangle_count;
    uint32_t(*neighbours)[3], parts = 0;
    ASSERT_OK(atlas->context, alpi_adjacency_create(atlas->scene, &neighbours));
    uint32_t *roots = ALPI_NEW(atlas->context, uint32_t, count);
    assert_non_null(roots);
    for (uint32_t t = 0; t < count; t++) {
        roots[t] = t;
    }
    for (uint32_t i = 0; i < 3 * count; i++) {
        const uint32_t t = i / 3, across = neighbours[t][i % 3];
        if (across != ALPI_NONE && atlas->triangle_charts[t] == atlas->triangle_charts[across]) {
            roots[root_of(roots, t)] = root_of(roots, across);
        }
    }
    for (uint32_t t = 0; t < count; t++) {
        parts += roots[t] == t && atlas->scene->triangle_usable[t];
    }
    alpi_release(atlas->context, roots);
    alpi_release(atlas->context, neighbours);
    return parts;
}

static void check_atlas(const alp_atlas *atlas, double density)
{
    const alp_atlas_info info = alp_atlas_get_info(atlas);
    assert_int_equal(info.flipped_triangles, 0);
    assert_int_equal(info.overlapping_texels, 0);
    assert_int_equal(count_parts(atlas), info.charts);
    // Of a flat surface; coordinates are floats of a page.
    ASSERT_NEAR(info.texels_per_metre, density, 1e-4 * density);
    ASSERT_NEAR(info.stretch_worst, 1.0, 1e-3);
}

/// A square of n × n squares of `side` texels: a page of `size` holds m² of them, m = ⌊size /
/// side⌋, in one part. Of the n − m⌊n/m⌋ that are left on two sides, strips lie side by side in
/// further pages, ⌊(size + padding) / (strip + padding)⌋ of m or fewer squares' length.
static void check_square(uint32_t n, double side, uint32_t size)
{
    alp_context *context = test_context(1);
    alp_scene *scene = scene_plane(context, n); // 2 m
    const wish w = {.size = size, .padding = 2, .density = 0.5 * n * side};
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, cut(scene, &w, &atlas));
    check_atlas(atlas, w.density);
    const uint32_t m = (uint32_t)(size / side), whole = n / m, left = n % m;
    const uint32_t strip = (uint32_t)ceil(left * side), strips = left == 0 ? 0 : 2 * whole + 1;
    const uint32_t beside = left == 0 ? 1 : (size + 2) / (strip + 2);
    const uint32_t most = whole * whole + (strips + beside - 1) / beside;
    const uint32_t least = (uint32_t)ceil(n * n * side * side / ((double)size * size));
    assert_in_range(alp_atlas_get_info(atlas).pages, least, most);
    assert_true(alp_atlas_get_info(atlas).utilisation >= 0.75);
    assert_int_equal(alp_atlas_get_info(atlas).charts, whole * whole + strips);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(a_square_fills_its_pages)
{
    check_square(16, 12.5, 64);  // 9 pages of 5² squares and 7 strips of 13: 11 pages
    check_square(50, 20.0, 256); // 16 of 12² and 9 of 40
    check_square(50, 20.0, 128); // 64 of 6² and 17 of 40
    check_square(24, 8.0, 64);   // 9 of 8², nothing left
}

/// Triangles that are halves of squares of 0.65 of a page: of whole squares a page holds one, .42
/// of it. Four halves, laid round a square on their longest sides, are .84.
TEST_WITH_CONTEXT(halves_of_squares_fill_pages, 1)
{
    alp_scene *scene = scene_plane(context, 6);
    const wish w = {.size = 256, .padding = 2, .density = 3.0 * 0.65 * 256};
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, cut(scene, &w, &atlas));
    check_atlas(atlas, w.density);
    assert_int_equal(alp_atlas_get_info(atlas).pages, 18); // 72 of them
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

/// Gaps for blocks and mip levels are kept between parts, and these fill pages as well.
TEST_SLOW_WITH_CONTEXT(parts_keep_gaps, 1)
{
    static const wish wishes[] = {{64, 0, 0, 0, 150.0},
                                  {64, 2, 4, 0, 150.0},
                                  {64, 1, 0, 3, 150.0},
                                  {64, 5, 12, 2, 150.0},
                                  {100, 2, 0, 0, 220.0}};
    alp_scene *scenes[] = {scene_plane(context, 40), scene_sphere(context, 40, 80)};
    for (size_t i = 0; i < 2 * sizeof wishes / sizeof *wishes; i++) {
        alp_atlas *atlas = NULL;
        const wish *w = &wishes[i / 2];
        ASSERT_OK(context, cut(scenes[i % 2], w, &atlas));
        const alp_atlas_info info = alp_atlas_get_info(atlas);
        assert_int_equal(info.flipped_triangles, 0);
        assert_int_equal(info.overlapping_texels, 0);
        assert_int_equal(count_parts(atlas), info.charts);
        assert_true(info.pages > 1);
        alp_atlas_destroy(atlas);
    }
    alp_scene_destroy(scenes[0]);
    alp_scene_destroy(scenes[1]);
}

/// A comb of a row of 9 squares of 1 m, and 5 prongs of `length`.
static alp_scene *scene_comb(alp_context *context, uint32_t length)
{
    const uint32_t rows = length + 2, count = 2 * (9 + 5 * length);
    float(*positions)[3] = calloc(10 * (size_t)rows, sizeof *positions);
    uint32_t(*indices)[3] = calloc(count, sizeof *indices), filled = 0;
    assert_true(positions != NULL && indices != NULL);
    for (uint32_t i = 0; i < 10 * rows; i++) {
        positions[i][0] = (float)(i % 10);
        positions[i][1] = (float)(i / 10);
    }
    for (uint32_t y = 0; y <= length; y++) {
        for (uint32_t x = 0; x < 9; x += y == 0 ? 1 : 2) {
            const uint32_t v = 10 * y + x;
            const uint32_t pair[2][3] = {{v, v + 1, v + 11}, {v, v + 11, v + 10}};
            memcpy(indices[filled], pair, sizeof pair);
            filled += 2;
        }
    }
    assert_int_equal(filled, count);
    alp_scene *scene = scene_of(context, (const float(*)[3])positions, NULL, 10 * rows,
                                (const uint32_t(*)[3])indices, count);
    free(positions);
    free(indices);
    return scene;
}

/// What a strip holds of a comb is its prongs: each is a chart of its own.
TEST_WITH_CONTEXT(parts_are_connected, 1)
{
    alp_scene *scene = scene_comb(context, 40);
    for (uint32_t size = 32; size <= 256; size *= 2) {
        const wish w = {.size = size, .padding = 2, .density = 10.0};
        alp_atlas *atlas = NULL;
        ASSERT_OK(context, cut(scene, &w, &atlas));
        check_atlas(atlas, 10.0);
        assert_true(alp_atlas_get_info(atlas).charts >= 6);
        alp_atlas_destroy(atlas);
    }
    alp_scene_destroy(scene);
}

TEST(workers_change_nothing)
{
    alp_atlas *atlases[2] = {NULL, NULL};
    alp_scene *scenes[2];
    alp_context *contexts[2];
    for (int i = 0; i < 2; i++) {
        contexts[i] = test_context(i == 0 ? 1 : 7);
        scenes[i] = scene_sphere(contexts[i], 40, 80);
        const wish w = {.size = 64, .padding = 2, .density = 100.0};
        ASSERT_OK(contexts[i], cut(scenes[i], &w, &atlases[i]));
    }
    assert_int_equal(atlases[0]->info.pages, atlases[1]->info.pages);
    assert_memory_equal(atlases[0]->corner_uvs, atlases[1]->corner_uvs,
                        scenes[0]->triangle_count * sizeof *atlases[0]->corner_uvs);
    for (int i = 0; i < 2; i++) {
        alp_atlas_destroy(atlases[i]);
        alp_scene_destroy(scenes[i]);
        alp_context_destroy(contexts[i]);
    }
}

// --- triangles -----------------------------------------------------------------------------------

static void check_side(const alpi_point triangle[3], double side)
{
    const alpi_box box = alpi_smallest_square(triangle);
    ASSERT_NEAR(fmax(box.width, box.height), side, 1e-12); // rounding
}

TEST(a_square_round_a_triangle)
{
    const double pi = ALPI_PI;
    check_side((const alpi_point[3]){{0, 0}, {1, 0}, {0, 1}}, 1.0);
    // Equilateral: turned by 15° two of its corners reach as far up as to the right.
    check_side((const alpi_point[3]){{0, 0}, {1, 0}, {0.5, sqrt(0.75)}}, cos(pi / 12.0));
    check_side((const alpi_point[3]){{0, 0}, {3, 4}, {0, 0}}, 5.0 / sqrt(2.0)); // its diagonal
    for (uint32_t i = 0; i < 100; i++) { // no other angle does it
        alpi_point p[3];
        for (uint32_t k = 0; k < 3; k++) {
            p[k] = (alpi_point){keyed(i, 2 * k), keyed(i, 2 * k + 1)};
        }
        const alpi_box box = alpi_smallest_square(p);
        for (int step = 0; step < 900; step++) {
            const double c = cos(step * pi / 1800.0), s = sin(step * pi / 1800.0);
            double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
            for (int k = 0; k < 3; k++) {
                const double at[2] = {c * p[k].x + s * p[k].y, c * p[k].y - s * p[k].x};
                for (int axis = 0; axis < 2; axis++) {
                    low[axis] = fmin(low[axis], at[axis]);
                    high[axis] = fmax(high[axis], at[axis]);
                }
            }
            assert_true(fmax(box.width, box.height) <=
                        fmax(high[0] - low[0], high[1] - low[1]) + 1e-12);
        }
    }
}

static double number_after(const char *text, const char *words)
{
    const char *at = strstr(text, words);
    if (at == NULL) {
        fail_msg("'%s' is not in: %s", words, text);
        return 0.0;
    }
    return strtod(at + strlen(words), NULL);
}

/// The numbers of the message are possible: that density, or a page of that size. A percent more or
/// less is not.
static void check_numbers(alp_context *context, alp_scene *scene, double density)
{
    wish w = {.size = 64, .padding = 2, .density = density};
    alp_atlas *atlas = NULL;
    assert_int_equal(cut(scene, &w, &atlas), ALP_ERROR_LIMIT);
    const double most = number_after(alp_context_message(context), "use at most ");
    const double size = number_after(alp_context_message(context), "metre or a page of ");
    assert_true(most < density && size > 64.0);
    w.density = most;
    ASSERT_OK(context, cut(scene, &w, &atlas));
    alp_atlas_destroy(atlas);
    w.density = 1.01 * most;
    assert_int_equal(cut(scene, &w, &atlas), ALP_ERROR_LIMIT);
    w = (wish){.size = (uint32_t)size, .padding = 2, .density = density};
    ASSERT_OK(context, cut(scene, &w, &atlas));
    alp_atlas_destroy(atlas);
    w.size = (uint32_t)(0.99 * size) - 1; // sizes are whole
    assert_int_equal(cut(scene, &w, &atlas), ALP_ERROR_LIMIT);
    alp_scene_destroy(scene);
}

TEST_SLOW_WITH_CONTEXT(what_is_possible_is_told, 1)
{
    check_numbers(context, scene_plane(context, 16), 1000.0); // not the first triangle's diagonal
    check_numbers(context, scene_cube(context), 45.3);        // nearly fits
    check_numbers(context, scene_sphere(context, 6, 12), 500.0);
    check_numbers(context, scene_spiral(context, 2), 700.0);
    check_numbers(context, scene_confetti(context, 40), 900.0); // of all sizes
}
