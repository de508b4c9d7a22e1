// SPDX-License-Identifier: MIT
// Seams under walls: nothing is stitched where the sides do not see each other, nor where light
// itself jumps.
#include "maps/seams/stitch.h"
#include "test_tiles.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 128, ALONG = 50 }; // texels of the seam

/// Two metres square, side by side along x = 1, the border between two columns of texels; and a
/// wall across a part of it.
static void make_tiles(test_tile tiles[3], float x, float z0, float z1, float bottom)
{
    const test_tile made[3] = {
        {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {10, 10}, {0, ALONG}, {ALONG, 0}},
        {{1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {70, 10}, {0, ALONG}, {ALONG, 0}},
        {{x, bottom, z0}, {0, 0, z1 - z0}, {0, 1, 0}, {10, 70}, {0, 50}, {50, 0}}};
    memcpy(tiles, made, sizeof made);
}

typedef struct fixture {
    alp_context *context;
    alp_scene *scene;
    alpi_tracer *tracer;
    alp_lightmap *lightmap;
    alpi_seams seams;
} fixture;

static void set_up(fixture *f, const test_tile *tiles, uint32_t count)
{
    *f = (fixture){.context = test_context(1)};
    f->scene = test_tiles_scene(f->context, tiles, count, SIZE);
    ASSERT_OK(f->context, alpi_tracer_for_scene(f->scene, NULL, NULL, &f->tracer, NULL));
    f->lightmap = test_tiles_lightmap(f->scene, SIZE);
    ASSERT_OK(f->context, alpi_seams_create(f->lightmap, f->tracer, &f->seams));
}

static void tear_down(fixture *f)
{
    alpi_seams_destroy(&f->seams);
    alp_lightmap_destroy(f->lightmap);
    alp_scene_destroy(f->scene);
    alp_context_destroy(f->context);
}

/// Samples that a wall leaves of the 100 of the seam.
static uint32_t count_left(float x, float z0, float z1, float bottom)
{
    test_tile tiles[3];
    fixture f;
    make_tiles(tiles, x, z0, z1, bottom);
    set_up(&f, tiles, 3);
    const uint32_t left = f.seams.sample_count;
    assert_int_equal(left + f.seams.blocked, 2 * ALONG);
    tear_down(&f);
    return left;
}

static const float texel = 1.0f / ALONG;

TEST(a_wall_on_the_seam_ends_it)
{
    assert_int_equal(count_left(1.0f, 0.0f, 1.0f, 0.0f), 0);
    assert_int_equal(count_left(1.0f, 0.25f, 0.75f, 0.0f), ALONG);
}

TEST(a_wall_within_a_texel_of_the_seam_ends_it)
{
    // Rays near the ends of an edge are shorter, as the triangles are narrow there.
    assert_in_range(count_left(1.0f + 0.8f * texel, 0.0f, 1.0f, 0.0f), 0, 8);
    assert_in_range(count_left(1.0f - 0.8f * texel, 0.0f, 1.0f, 0.0f), 0, 8);
    assert_int_equal(count_left(1.0f + 1.2f * texel, 0.0f, 1.0f, 0.0f), 2 * ALONG);
    assert_int_equal(count_left(1.0f - 1.2f * texel, 0.0f, 1.0f, 0.0f), 2 * ALONG);
}

TEST(a_wall_that_nearly_reaches_the_floor_ends_it)
{
    assert_int_equal(count_left(1.0f, 0.0f, 1.0f, 0.4f * texel), 0);
    assert_int_equal(count_left(1.0f, 0.0f, 1.0f, 0.6f * texel), 2 * ALONG);
}

/// @return how many samples there are
static uint32_t expect_none_blocked(const char *name, uint32_t size)
{
    alp_context *context = test_context(2);
    alp_scene *scene = test_load(context, name);
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_CHARTS;
    options.size = size;
    alp_atlas *atlas = NULL;
    alp_lightmap *lightmap = NULL;
    alpi_tracer *tracer = NULL;
    alpi_seams seams;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    ASSERT_OK(context, alpi_lightmap_create(atlas, &lightmap));
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    ASSERT_OK(context, alpi_seams_create(lightmap, tracer, &seams));
    const uint32_t count = seams.sample_count;
    assert_int_equal(seams.blocked, 0);
    alpi_seams_destroy(&seams);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return count;
}

/// Convex and concave seams, of triangles smaller and larger than a texel.
TEST_SLOW(curved_surfaces_do_not_block_their_own_seams)
{
    const char *const names[] = {"builtin:sphere-plane", "builtin:bowl"};
    for (int i = 0; i < 2; i++) {
        uint32_t count = 0;
        for (uint32_t size = 64; size <= 512; size *= 2) {
            count += expect_none_blocked(names[i], size);
        }
        assert_true(count > 100);
    }
}

TEST(hidden_sides_are_no_seam)
{
    test_tile tiles[3];
    fixture f;
    make_tiles(tiles, 1.0f, 0.0f, 1.0f, 0.0f);
    set_up(&f, tiles, 2);
    assert_int_equal(f.seams.sample_count, 2 * ALONG);
    alpi_seams_destroy(&f.seams);
    for (uint32_t t = 0; t < f.lightmap->texels.count; t++) { // the first tile ends in a solid
        if (f.lightmap->texels.pixels[t][0] == 59 && f.lightmap->texels.pixels[t][1] < 35) {
            f.lightmap->states[t] = ALPI_TEXEL_OPEN;
        }
    }
    ASSERT_OK(f.context, alpi_seams_create(f.lightmap, f.tracer, &f.seams));
    assert_in_range(f.seams.sample_count, ALONG, ALONG + 1); // one reads a texel of either half
    tear_down(&f);
}

static float half_dark(const void *user, uint32_t tile, const double p[3])
{
    return tile == 1 && p[2] > (double)*(const float *)user ? 0.1f : 0.5f;
}

/// Texels of the last column of the first tile that stitching moves.
static uint32_t count_moved(float from)
{
    test_tile tiles[3];
    fixture f;
    uint32_t moved = 0;
    make_tiles(tiles, 1.0f, 0.0f, 1.0f, 0.0f);
    set_up(&f, tiles, 2);
    float *page = test_tiles_page(f.lightmap, tiles, 2, half_dark, &from);
    alpi_stitch stitch;
    const alpi_stitch_options options = {.channels = 1, .low = 0.0f, .high = 1.0f};
    ASSERT_OK(f.context, alpi_stitch_create(f.lightmap, &f.seams, &page, NULL, NULL, &stitch));
    ASSERT_OK(f.context, alpi_stitch_apply(&stitch, &options, &page, NULL));
    for (uint32_t y = 10; y < 10 + ALONG; y++) {
        moved += fabsf(page[4 * (y * SIZE + 59)] - 0.5f) > 1e-4f ? 1 : 0;
    }
    alpi_stitch_destroy(&stitch);
    free(page);
    tear_down(&f);
    return moved;
}

/// A fifth of the seam parts light from dark, which no ray explains. Within two texels of where
/// that begins, the dark side changes along the seam, and is stitched.
TEST(a_jump_is_not_stitched)
{
    assert_in_range(count_moved(0.8f), 1, 5);
    assert_int_equal(count_moved(0.0f), ALONG); // all along the seam: a step that bakes make
    assert_int_equal(count_moved(1.0f), 0);
}
