// SPDX-License-Identifier: MIT
// Stitching: sides of seams agree, and nothing else moves further than it should.
#include "maps/seams/stitch.h"

#include "base/random.h"
#include "base/tasks.h"
#include "test_tiles.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 128, PIXELS = SIZE * SIZE };

typedef struct fixture {
    alp_context *context;
    alp_scene *scene;
    alp_lightmap *lightmap;
    alpi_seams seams;
    float *before, *page;
    float *errors; // [texels]
} fixture;

static void set_up(fixture *f, uint32_t workers, const test_tile tiles[2], test_tile_paint *paint,
                   const void *user)
{
    *f = (fixture){.context = test_context(workers)};
    f->scene = test_tiles_scene(f->context, tiles, 2, SIZE);
    f->lightmap = test_tiles_lightmap(f->scene, SIZE);
    ASSERT_OK(f->context, alpi_seams_create(f->lightmap, NULL, &f->seams));
    f->before = test_tiles_page(f->lightmap, tiles, 2, paint, user);
    f->page = test_tiles_page(f->lightmap, tiles, 2, paint, user);
    f->errors = calloc(f->lightmap->texels.count, sizeof *f->errors);
    assert_non_null(f->errors);
}

static void tear_down(fixture *f)
{
    free(f->before);
    free(f->page);
    free(f->errors);
    alpi_seams_destroy(&f->seams);
    alp_lightmap_destroy(f->lightmap);
    alp_scene_destroy(f->scene);
    alp_context_destroy(f->context);
}

static const alpi_stitch_options shares = {.channels = 1, .low = 0.0f, .high = 1.0f},
                                 grey = {.channels = 1, .low = -HUGE_VALF, .high = HUGE_VALF},
                                 colors = {.channels = 3, .low = -HUGE_VALF, .high = HUGE_VALF};

static alpi_stitch_change stitch(fixture *f, const alpi_stitch_options *options)
{
    alpi_stitch s;
    alpi_stitch_change change;
    ASSERT_OK(f->context,
              alpi_stitch_create(f->lightmap, &f->seams, &f->page, f->errors, NULL, &s));
    ASSERT_OK(f->context, alpi_stitch_apply(&s, options, &f->page, &change));
    alpi_stitch_destroy(&s);
    return change;
}

static double mean_step(fixture *f)
{
    alpi_seam_step step;
    ASSERT_OK(f->context, alpi_seams_measure(f->lightmap, &f->seams, &f->page, &step));
    return step.mean;
}

static bool is_in_footprint(const fixture *f, size_t pixel)
{
    for (uint32_t i = 0; i < f->seams.pixel_count; i++) {
        if (f->seams.pixels[i] == pixel) {
            return true;
        }
    }
    return false;
}

static float constant(const void *user, uint32_t tile, const double p[3])
{
    (void)p;
    return ((const float *)user)[tile];
}

/// Two metres square, side by side along x = 1.
static const test_tile pair[2] = {
    {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {10.3f, 12.2f}, {0, 31}, {30, 0}},
    {{1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {80.7f, 20.1f}, {11, 13}, {13, -11}}};
/// The same, the border between two columns of texels on both sides.
static const test_tile aligned[2] = {{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {10, 10}, {0, 50}, {50, 0}},
                                     {{1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {70, 10}, {0, 50}, {50, 0}}};

TEST(sides_agree_and_far_texels_stay)
{
    fixture f;
    set_up(&f, 1, pair, constant, (float[]){0.25f, 0.75f});
    ASSERT_NEAR(mean_step(&f), 0.5, 1e-6);
    stitch(&f, &grey);
    // The first tile's border reads .8 of texels that it covers by .3, which moves its side alone
    // by Σ w² / λ = .64 / (.15 · .3) for a step of one.
    assert_true(mean_step(&f) < 0.5 / (1.0 + 0.64 / 0.045));
    uint32_t moved = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        if (f.page[4 * i] != f.before[4 * i] || f.page[4 * i + 3] != f.before[4 * i + 3]) {
            assert_true(is_in_footprint(&f, i));
            moved++;
        }
        assert_true(f.page[4 * i] == f.page[4 * i + 1] && f.page[4 * i] == f.page[4 * i + 2]);
    }
    assert_in_range(moved, 31 * 3, 31 * 8);
    tear_down(&f);
}

/// In the middle of a straight border each look-up reads half a covered texel and half one of the
/// gap. There d = d₀ / (1 + Σ w² / λ) over the four, and a texel moves by d w / λ.
TEST(a_straight_border_moves_by_the_closed_form)
{
    fixture f;
    set_up(&f, 1, aligned, constant, (float[]){0.25f, 0.75f});
    const alpi_stitch_change change = stitch(&f, &shares);
    const double hold = 0.15, gap = 1e-4, step = 0.5 / (1.0 + 0.5 / hold + 0.5 / gap);
    const size_t row = 35 * SIZE;
    const float *covered = f.page + 4 * (row + 59), *free_one = f.page + 4 * (row + 60);
    // A thousandth of the change is what is left when the method stops, and of the border's ends.
    const double of_covered = step * 0.5 / hold, of_gap = step * 0.5 / gap;
    ASSERT_NEAR((double)covered[0] - 0.25, of_covered, 0.01 * of_covered + 1e-6);
    ASSERT_NEAR((double)free_one[0] - 0.25, of_gap, 0.01 * of_gap);
    const float *other = f.page + 4 * (row + 70);
    ASSERT_NEAR((double)other[0] - 0.75, -of_covered, 0.01 * of_covered + 1e-6);
    // No error is stated: a 500th of the mean, .5, counts.
    assert_true(change.largest >= of_covered / 0.001 * 0.99 && change.rms <= change.largest);
    tear_down(&f);
}

/// The first tile goes on into a wall that stands upright, in the same row of texels: the last but
/// one of them is three quarters floor, so that its faces' mean normal n has n² = 5/8 and λ is a
/// quarter; the border reads it by three quarters. The other tile reads half a texel of its gap.
TEST(texels_across_an_edge_move_further)
{
    const test_tile tiles[3] = {
        {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {10.75f, 10}, {0, 50}, {30, 0}},
        aligned[1],
        {{1, 0, 0}, {0, 0, 1}, {0, -2.0f / 3, 0}, {40.75f, 10}, {0, 50}, {20, 0}}};
    alp_context *context = test_context(1);
    fixture f = {.context = context, .scene = test_tiles_scene(context, tiles, 3, SIZE)};
    f.lightmap = test_tiles_lightmap(f.scene, SIZE);
    ASSERT_OK(context, alpi_seams_create(f.lightmap, NULL, &f.seams));
    assert_int_equal(f.seams.count, 1);
    f.page = test_tiles_page(f.lightmap, tiles, 3, constant, (float[]){0.25f, 0.75f, 0.5f});
    f.errors = calloc(f.lightmap->texels.count, sizeof *f.errors);
    float *floor = f.page + 4 * (35 * SIZE + 40), *wall = floor + 4;
    const double first = (double)floor[0], second = (double)wall[0];
    const double step = 0.75 * first + 0.25 * second - 0.75;
    stitch(&f, &grey);
    const double hold = 0.15;
    const double left =
        step / (1.0 + 0.5625 / (0.25 * hold) + 0.0625 / hold + 0.25 / hold + 0.25 / 1e-4);
    const double moved = -left * 0.75 / (0.25 * hold), wall_moved = -left * 0.25 / hold;
    ASSERT_NEAR((double)floor[0] - first, moved, 0.01 * fabs(moved) + 1e-6); // as above
    ASSERT_NEAR((double)wall[0] - second, wall_moved, 0.01 * fabs(wall_moved) + 1e-6);
    tear_down(&f);
}

/// Of two sides the noisier moves further: by λ ~ 1/σ² twice as far as the mean, here.
TEST(noisy_texels_move_further)
{
    fixture f;
    set_up(&f, 1, aligned, constant, (float[]){0.25f, 0.75f});
    for (uint32_t t = 0; t < f.lightmap->texels.count; t++) {
        f.errors[t] = f.lightmap->texels.pixels[t][0] < 64 ? 0.03f : 0.01f;
    }
    stitch(&f, &shares);
    const size_t row = 35 * SIZE;
    const double left = (double)f.page[4 * (row + 59)] - 0.25;
    const double right = 0.75 - (double)f.page[4 * (row + 70)];
    // The mean of σ² is 5e-4: λ is 5/9 of what it was for one side, and held to twice for the
    // other.
    ASSERT_NEAR(left / right, 2.0 * 9.0 / 5.0, 0.05);
    tear_down(&f);
}

static double truth(const double p[3])
{
    return 0.5 + 0.2 * p[0] + 0.15 * sin(3.0 * p[2]);
}

static float noisy(const void *user, uint32_t tile, const double p[3])
{
    const float *noise = user;
    uint64_t bits[2];
    memcpy(bits, (double[]){p[0], p[2]}, sizeof bits);
    const uint32_t hash = alpi_random_key(tile, bits[0], 1) ^ alpi_random_key(7, bits[1], 2);
    return (float)truth(p) + *noise * (alpi_unit_float(alpi_hash32(hash)) - 0.5f);
}

/// Squared error of look-ups over both tiles, at the border's side of `depth` metres.
static double find_error(fixture *f, float *page, float depth)
{
    f->lightmap->pages = &page;
    double sum = 0.0;
    enum { ALONG = 200, ACROSS = 8 };
    for (int i = 0; i < ALONG * ACROSS; i++) {
        // b1 belongs to p + u of triangle 2 and of triangle 0, and b2 to p + u + v; on tile 0 the
        // border is the edge p + u + v, p + v of triangle 1.
        const float z = ((float)(i / ACROSS) + 0.5f) / ALONG;
        const float x = depth * ((float)(i % ACROSS) + 0.5f) / ACROSS;
        float rgb[3];
        const float far = fminf(x, 0.99f * (z < 0.5f ? z : 1.0f - z)); // in its triangle
        alpi_lightmap_sample(f->lightmap, 2, z - far, far, rgb);       // (1 + far, z)
        const double a = (double)rgb[0] - truth((double[]){1.0 + (double)far, 0.0, (double)z});
        alpi_lightmap_sample(f->lightmap, 1, z, 1.0f - z - far, rgb); // (1 − far, z)
        const double b = (double)rgb[0] - truth((double[]){1.0 - (double)far, 0.0, (double)z});
        sum += a * a + b * b;
    }
    f->lightmap->pages = NULL;
    return sqrt(sum / (2.0 * ALONG * ACROSS));
}

TEST(a_smooth_map_comes_no_further_from_the_truth)
{
    const float noises[] = {0.0f, 0.02f, 0.1f}, depths[] = {1e-4f, 0.1f};
    for (int n = 0; n < 3; n++) {
        fixture f;
        set_up(&f, 1, pair, noisy, &noises[n]);
        for (uint32_t t = 0; t < f.lightmap->texels.count; t++) {
            f.errors[t] = noises[n] / sqrtf(12.0f);
        }
        stitch(&f, &colors);
        for (int d = 0; d < 2; d++) {
            const double was = find_error(&f, f.before, depths[d]);
            const double is = find_error(&f, f.page, depths[d]);
            assert_true(is <= was + 1e-5);                     // 1e-5: coordinates are floats
            assert_true(was < 0.3 * (double)noises[n] + 1e-3); // look-ups are where they should be
        }
        tear_down(&f);
    }
}

TEST(a_border_of_the_page_is_stitched)
{
    test_tile tiles[2] = {aligned[0], aligned[1]};
    tiles[0].at[0] = 78; // its border is that of the page: look-ups there are clamped
    tiles[1].at[0] = 10;
    fixture f;
    set_up(&f, 1, tiles, constant, (float[]){0.25f, 0.75f});
    stitch(&f, &grey);
    // Its gap goes to the other's .25 and no further; covered texels close a third of the rest.
    assert_true(mean_step(&f) < 0.5 / 8.0);
    tear_down(&f);
}

static float edge_of_range(const void *user, uint32_t tile, const double p[3])
{
    (void)user;
    return tile == 0 ? 0.0f : (float)fmod(fabs(7.0 * p[2]), 1.0);
}

TEST(values_stay_in_their_range)
{
    fixture f;
    set_up(&f, 1, pair, edge_of_range, NULL);
    stitch(&f, &shares);
    for (uint32_t i = 0; i < f.seams.pixel_count; i++) {
        const float value = f.page[4 * f.seams.pixels[i]];
        assert_true(value >= 0.0f && value <= 1.0f);
    }
    tear_down(&f);
}

TEST(unit_vectors_stay_unit)
{
    fixture f;
    set_up(&f, 1, pair, constant, (float[]){0.6f, 0.0f});
    for (uint32_t i = 0; i < PIXELS; i++) {
        float *v = f.page + 4 * i;
        v[1] = sqrtf(fmaxf(1.0f - v[0] * v[0], 0.0f));
        v[2] = 0.0f;
    }
    stitch(&f, &(alpi_stitch_options){.channels = 3, .low = -2.0f, .high = 2.0f, .unit = true});
    for (uint32_t i = 0; i < f.seams.pixel_count; i++) {
        const float *v = f.page + 4 * f.seams.pixels[i];
        ASSERT_NEAR(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], 1.0, 1e-6);
    }
    assert_true(mean_step(&f) < 0.5 * (0.6 + 0.2) / 3.0); // half: lengths are lost
    tear_down(&f);
}

TEST(any_number_of_workers_gives_the_same_bits)
{
    const float noise = 0.1f;
    fixture one, three;
    set_up(&one, 1, pair, noisy, &noise);
    set_up(&three, 3, pair, noisy, &noise);
    stitch(&one, &colors);
    stitch(&three, &colors);
    assert_memory_equal(one.page, three.page, 4 * PIXELS * sizeof(float));
    assert_memory_not_equal(one.page, one.before, 4 * PIXELS * sizeof(float));
    tear_down(&one);
    tear_down(&three);
}

static bool refuse(void *user, const alp_progress *progress)
{
    (void)user;
    assert_string_equal(progress->stage, "seams");
    return false;
}

TEST(a_cancelled_map_stays)
{
    fixture f;
    set_up(&f, 1, pair, constant, (float[]){0.25f, 0.75f});
    alpi_stitch s;
    ASSERT_OK(f.context, alpi_stitch_create(f.lightmap, &f.seams, &f.page, NULL, NULL, &s));
    const alpi_watch former = alpi_set_watch(f.context, (alpi_watch){.callback = refuse});
    assert_int_equal(alpi_stitch_apply(&s, &shares, &f.page, NULL), ALP_ERROR_CANCELLED);
    alpi_set_watch(f.context, former);
    alpi_stitch_destroy(&s);
    assert_memory_equal(f.page, f.before, 4 * PIXELS * sizeof(float));
    tear_down(&f);
}

TEST(memory_that_ends_is_said)
{
    int left = 1000000;
    alp_context *context = test_context_failing(&left);
    alp_scene *scene = test_tiles_scene(context, pair, 2, SIZE);
    alp_lightmap *lightmap = test_tiles_lightmap(scene, SIZE);
    const float values[2] = {0.25f, 0.75f};
    float *page = test_tiles_page(lightmap, pair, 2, constant, values);
    alpi_seams seams;
    ASSERT_OK(context, alpi_seams_create(lightmap, NULL, &seams));
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int allocations = 0;
    for (; result == ALP_ERROR_OUT_OF_MEMORY; allocations++) {
        alpi_stitch s = {0};
        left = allocations;
        result = alpi_stitch_create(lightmap, &seams, &page, NULL, NULL, &s);
        if (result == ALP_OK) {
            result = alpi_stitch_apply(&s, &colors, &page, NULL);
        }
        alpi_stitch_destroy(&s);
    }
    ASSERT_OK(context, result);
    assert_true(allocations > 15);
    left = 1000000;
    free(page);
    alpi_seams_destroy(&seams);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}
