// SPDX-License-Identifier: MIT
// Seams between tiles: where they are, how long they are, and how far apart their sides are.
#include "maps/seams/seams.h"

#include "base/random.h"
#include "base/tasks.h"
#include "maps/seams/seam_edges.h"
#include "test_scenes.h"
#include "test_tiles.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 128 };

typedef struct fixture {
    alp_context *context;
    alp_scene *scene;
    alp_lightmap *lightmap;
    alpi_seams seams;
    float *page;
} fixture;

static void set_up(fixture *f, const test_tile *tiles, uint32_t count)
{
    *f = (fixture){.context = test_context(1)};
    f->scene = test_tiles_scene(f->context, tiles, count, SIZE);
    f->lightmap = test_tiles_lightmap(f->scene, SIZE);
    ASSERT_OK(f->context, alpi_seams_create(f->lightmap, NULL, &f->seams));
}

static void tear_down(fixture *f)
{
    free(f->page);
    alpi_seams_destroy(&f->seams);
    alp_lightmap_destroy(f->lightmap);
    alp_scene_destroy(f->scene);
    alp_context_destroy(f->context);
}

static alpi_seam_step measure(fixture *f, const test_tile *tiles, uint32_t count,
                              test_tile_paint *paint, const void *user)
{
    free(f->page);
    f->page = test_tiles_page(f->lightmap, tiles, count, paint, user);
    alpi_seam_step error;
    ASSERT_OK(f->context, alpi_seams_measure(f->lightmap, &f->seams, &f->page, &error));
    return error;
}

static float linear(const void *user, uint32_t tile, const double p[3])
{
    (void)user;
    (void)tile;
    return (float)(2.0 + 0.7 * p[0] - 0.4 * p[1] + 0.3 * p[2]);
}

static float constant(const void *user, uint32_t tile, const double p[3])
{
    (void)p;
    return ((const float *)user)[tile];
}

/// Two metres square, side by side along x = 1, as coarse as each other or not, one turned.
static const test_tile pair[2] = {
    {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {10.3f, 12.2f}, {0, 31}, {30, 0}},
    {{1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {80.7f, 20.1f}, {11, 13}, {13, -11}}};

TEST(a_linear_map_has_no_step)
{
    fixture f;
    set_up(&f, pair, 2);
    assert_int_equal(f.seams.count, 1);
    ASSERT_NEAR(f.seams.length, 1.0, 1e-6);
    assert_int_equal(f.seams.sample_count, 62); // two a texel of the finer side's 31
    const alpi_seam_step error = measure(&f, pair, 2, linear, NULL);
    // Values are floats below 4, weights and coordinates too: 31 texels of 1/50 each.
    ASSERT_NEAR(error.mean, 0.0, 2e-6);
    ASSERT_NEAR(error.p99, 0.0, 4e-6);
    tear_down(&f);
}

TEST(constants_differ_by_their_difference)
{
    fixture f;
    set_up(&f, pair, 2);
    const alpi_seam_step error = measure(&f, pair, 2, constant, (float[]){0.25f, 0.75f});
    ASSERT_NEAR(error.mean, 0.5, 1e-6);
    ASSERT_NEAR(error.p99, 0.5, 1e-6);
    tear_down(&f);
}

/// The mean of three channels, each by itself: differences of other signs do not cancel.
TEST(channels_are_averaged)
{
    fixture f;
    set_up(&f, pair, 2);
    measure(&f, pair, 2, constant, (float[]){0.0f, 1.0f});
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        f.page[4 * i + 1] *= -0.5f;
        f.page[4 * i + 2] = 0.3f;
    }
    alpi_seam_step error;
    ASSERT_OK(f.context, alpi_seams_measure(f.lightmap, &f.seams, &f.page, &error));
    ASSERT_NEAR(error.mean, 0.5, 1e-6);
    tear_down(&f);
}

static float rough(const void *user, uint32_t tile, const double p[3])
{
    (void)user;
    return (float)(0.5 + 0.5 * sin(40.0 * p[0] + 23.0 * p[2] + 9.0 * tile));
}

/// What is compared is what alpi_lightmap_sample reads.
TEST(look_ups_are_those_of_the_lightmap)
{
    fixture f;
    set_up(&f, pair, 2);
    const alpi_seam_step error = measure(&f, pair, 2, rough, NULL);
    f.lightmap->pages = &f.page;
    double sum = 0.0;
    const uint32_t samples = 62;
    for (uint32_t i = 0; i < samples; i++) {
        // z = s on tile 0 along its edge p + v to p + u + v (triangle 1: corners 0, 2, 3), and on
        // tile 1 along p to p + u (triangle 2: corners 0, 1, 2).
        const float s = ((float)i + 0.5f) / (float)samples;
        float a[3], b[3];
        alpi_lightmap_sample(f.lightmap, 1, s, 1.0f - s, a);
        alpi_lightmap_sample(f.lightmap, 2, s, 0.0f, b);
        sum += fabs((double)a[0] - (double)b[0]);
    }
    f.lightmap->pages = NULL;
    assert_true(error.mean > 0.1);
    ASSERT_NEAR(error.mean, sum / samples, 1e-4); // coordinates are floats there
    tear_down(&f);
}

static uint32_t count_seams(const test_tile *tiles, uint32_t count, double *length)
{
    fixture f;
    set_up(&f, tiles, count);
    const uint32_t seams = f.seams.count;
    *length = f.seams.length;
    tear_down(&f);
    return seams;
}

/// Light steps at a crease by itself.
TEST(a_crease_is_no_seam)
{
    const double degree = 3.14159265358979 / 180.0, angles[] = {0.0, 2.9, 3.1, 30.0, 90.0};
    const uint32_t wanted[] = {1, 1, 0, 0, 0};
    for (int i = 0; i < 5; i++) {
        test_tile tiles[2] = {pair[0], pair[1]};
        tiles[1].v[0] = (float)cos(angles[i] * degree);
        tiles[1].v[1] = (float)sin(angles[i] * degree);
        double length = 0.0;
        assert_int_equal(count_seams(tiles, 2, &length), wanted[i]);
        ASSERT_NEAR(length, wanted[i], 1e-6);
    }
}

/// Two tiles at the long side of one, one of them beyond its end by 0.4 m: a T-junction.
TEST(partly_overlapping_edges_count_their_overlap)
{
    const test_tile tiles[3] = {{{0, 0, 0}, {0, 0, 2}, {1, 0, 0}, {4, 4}, {0, 60}, {30, 0}},
                                {{1, 0, 0.4f}, {0, 0, 1}, {1, 0, 0}, {40, 4}, {0, 25}, {25, 0}},
                                {{1, 0, 1.4f}, {0, 0, 1}, {1, 0, 0}, {80, 4}, {0, 25}, {25, 0}}};
    fixture f;
    set_up(&f, tiles, 3);
    assert_int_equal(f.seams.count, 3); // and the two along each other
    ASSERT_NEAR(f.seams.length, 1.0 + 0.6 + 1.0, 1e-5);
    // Steps of 1, 3 and 2 along 1 m, 0.6 m and 1 m.
    const alpi_seam_step error = measure(&f, tiles, 3, constant, (float[]){0.0f, 1.0f, 3.0f});
    ASSERT_NEAR(error.mean, (1.0 + 3.0 * 0.6 + 2.0) / 2.6, 1e-4);
    ASSERT_NEAR(error.p99, 3.0, 1e-6);
    tear_down(&f);
}

TEST(gaps_of_less_than_a_tenth_of_a_texel_are_none)
{
    const double texel = 1.0 / 31.0, gaps[] = {0.0, 0.09, 0.11, 1.0};
    const uint32_t wanted[] = {1, 1, 0, 0};
    for (int i = 0; i < 4; i++) {
        test_tile tiles[2] = {pair[0], pair[1]};
        tiles[1].p[0] += (float)(gaps[i] * texel);
        double length = 0.0;
        assert_int_equal(count_seams(tiles, 2, &length), wanted[i]);
    }
}

/// At 100 and 1000 km floats are 8 and 63 mm apart, more than a texel: edges with the same ends
/// meet all the same, however short they are, and no others do that rounding cannot have moved
/// apart.
TEST(far_from_the_origin_edges_meet_by_their_ends)
{
    const float far[] = {1e5f, 1e6f};
    for (int i = 0; i < 2; i++) {
        const float x = far[i], side = 0.25f, step = nextafterf(x, 2.0f * x) - x;
        test_tile tiles[2] = {
            {{x, x, x}, {0, 0, side}, {side, 0, 0}, {10.3f, 12.2f}, {0, 31}, {30, 0}},
            {{x + side, x, x}, {0, 0, side}, {side, 0, 0}, {80.7f, 20.1f}, {11, 13}, {13, -11}}};
        double length = 0.0;
        assert_int_equal(count_seams(tiles, 2, &length), 1);
        ASSERT_NEAR(length, (double)side, 1e-6);
        for (int gap = 1; gap <= 4; gap++) { // 4e-7 of the coordinate are more than five steps
            tiles[1].p[0] = x + side + (float)gap * step;
            assert_int_equal(count_seams(tiles, 2, &length), 0);
        }
    }
}

/// Edges of which one is twice as long, with texels of 0.64 m, some steps of 1000 km apart: two are
/// 0.19 of a texel, as rounding may move them; near the origin it is a gap. Three are 0.29.
TEST(far_from_the_origin_rounding_is_less_than_a_quarter_of_a_texel)
{
    static const struct {
        float from, steps;
        uint32_t seams;
    } cases[] = {{1e6f, 2.0f, 1}, {1e6f, 3.0f, 0}, {0.0f, 2.0f, 0}, {0.0f, 1.0f, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const float x = cases[i].from, gap = cases[i].steps * 0.0625f;
        const test_tile tiles[2] = {
            {{x, 0, x}, {0, 0, 20}, {20, 0, 0}, {10, 12}, {0, 31}, {31, 0}},
            {{x + 20 + gap, 0, x}, {0, 0, 40}, {20, 0, 0}, {50, 12}, {0, 62}, {31, 0}}};
        double length = 0.0;
        assert_int_equal(count_seams(tiles, 2, &length), cases[i].seams);
        ASSERT_NEAR(length, 20.0 * cases[i].seams, 1e-5);
    }
}

/// Two layers, nearer to each other than a tenth of a texel: each goes on in itself alone. A wall
/// that shares the edge takes nothing away: beyond it is a crease.
TEST(edges_with_the_same_ends_need_no_others)
{
    test_tile tiles[4] = {pair[0], pair[1], pair[0], pair[1]};
    for (int i = 2; i < 4; i++) {
        tiles[i].p[1] = 0.001f; // 0.03 texels
        tiles[i].at[1] += 50.0f;
    }
    double length = 0.0;
    assert_int_equal(count_seams(tiles, 4, &length), 2);
    ASSERT_NEAR(length, 2.0, 1e-6);
    const test_tile wall = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {10, 62}, {0, 31}, {30, 0}};
    tiles[2] = wall; // of the first tile: the second one is moved off a little
    tiles[1].p[0] += 0.001f;
    assert_int_equal(count_seams(tiles, 3, &length), 1);
}

/// Surfaces over each other, face to face, or meeting in a corner do not go on into each other.
TEST(what_only_touches_is_no_seam)
{
    double length = 0.0;
    test_tile tiles[2] = {pair[0], pair[1]};
    tiles[1].p[0] = 0.5f; // over each other
    assert_int_equal(count_seams(tiles, 2, &length), 0);
    tiles[1].u[2] = -1.0f; // in one place, seen from below
    tiles[1].p[2] = 1.0f;
    tiles[1].p[0] = 0.0f;
    assert_int_equal(count_seams(tiles, 2, &length), 0);
    tiles[1] = pair[1];
    tiles[1].p[2] = 1.0f; // by the corner
    assert_int_equal(count_seams(tiles, 2, &length), 0);
}

/// Edges inside of tiles, whose coordinates go on, are none; neither are tiles that read one place
/// of the page from both sides.
TEST(coordinates_that_go_on_make_no_seam)
{
    double length = 0.0;
    test_tile tiles[2] = {pair[0], pair[0]};
    assert_int_equal(count_seams(tiles, 1, &length), 0);
    tiles[1].p[0] = 1.0f;
    tiles[1].at[0] += 30.0f;
    assert_int_equal(count_seams(tiles, 2, &length), 0);
}

/// A floor of tiles with side walls, as modular sets have them: four triangles at every edge that
/// two tiles share. Walls of neighbours face each other and are no seams.
TEST(tiles_with_walls_meet_once)
{
    enum { SIDE = 3, FACES = 3 };
    test_tile tiles[SIDE * SIDE * FACES];
    uint32_t count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float x = (float)(i % SIDE), z = (float)(i / SIDE), down = 0.2f;
        const float at[2] = {4.0f + 40.0f * x, 4.0f + 40.0f * z};
        tiles[count++] =
            (test_tile){{x, 0, z}, {0, 0, 1}, {1, 0, 0}, {at[0], at[1]}, {0, 12}, {12, 0}};
        tiles[count++] =
            (test_tile){{x, 0, z}, {0, -down, 0}, {0, 0, 1}, {at[0] + 16, at[1]}, {0, 4}, {12, 0}};
        tiles[count++] = (test_tile){
            {x + 1, 0, z}, {0, 0, 1}, {0, -down, 0}, {at[0] + 16, at[1] + 16}, {12, 0}, {0, 4}};
    }
    double length = 0.0;
    // Tops meet along 12 edges of 1 m. Walls in one plane meet at their ends: 6 rows of walls, each
    // of 2 ends between 3 walls; in x between tiles, two walls back to back, whose like sides meet.
    assert_int_equal(count_seams(tiles, count, &length), 12 + 12);
    ASSERT_NEAR(length, 12.0 + 12.0 * 0.2, 1e-4);
}

static bool stop(void *user, const alp_progress *progress)
{
    (void)progress;
    return ++*(int *)user < 2;
}

TEST(it_can_be_cancelled)
{
    fixture f;
    set_up(&f, pair, 2);
    int asked = 1;
    const alpi_watch former =
        alpi_set_watch(f.context, (alpi_watch){.callback = stop, .user = &asked});
    alpi_seams seams;
    assert_int_equal(alpi_seams_create(f.lightmap, NULL, &seams), ALP_ERROR_CANCELLED);
    assert_null(seams.first);
    alpi_set_watch(f.context, former);
    tear_down(&f);
}

/// Which pairs were found, in which order.
typedef struct pair_log {
    uint64_t hash;
    uint32_t count;
} pair_log;

static alp_result log_pair(void *user, const alpi_seam_pair *found)
{
    pair_log *log = user;
    const uint64_t edges =
        (uint64_t)found->edges[0].half_edge << 32 | (uint64_t)found->edges[1].half_edge;
    log->hash = alpi_hash64(log->hash ^ edges);
    log->count++;
    return ALP_OK;
}

/// Thousands of facets, each a chart: more edges than are searched in one go.
static alp_lightmap *make_facets(alp_context *context, alp_scene **scene)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0, 0, 0}, 1.0, 64, 40, 1.0, 1);
    *scene = test_mesh_scene(context, mesh, 0);
    alp_atlas_options options = alp_atlas_options_default();
    options.size = 512;
    options.max_angle = 0.01f;
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, alp_atlas_create(*scene, &options, &atlas));
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alpi_lightmap_create(atlas, &lightmap));
    return lightmap;
}

/// Sixty-four tiles in two stacks: each edge where they meet has 32 partners, more in all than a
/// part of the search keeps.
static alp_lightmap *make_stacks(alp_context *context, alp_scene **scene)
{
    test_tile tiles[TEST_TILE_LIMIT];
    for (int i = 0; i < TEST_TILE_LIMIT; i++) {
        tiles[i] = pair[i / (TEST_TILE_LIMIT / 2)];
        tiles[i].at[0] = 16.0f * (float)(i % 8) + 2.3f;
        tiles[i].at[1] = 16.0f * (float)(i / 8) + 2.2f;
        tiles[i].du[0] = tiles[i].dv[1] = 0.0f;
        tiles[i].du[1] = tiles[i].dv[0] = 9.0f;
    }
    *scene = test_tiles_scene(context, tiles, TEST_TILE_LIMIT, SIZE);
    return test_tiles_lightmap(*scene, SIZE);
}

/// Edges that share a tenth of their lengths, at their ends, and a short one at the end of a long.
TEST(ends_of_edges_meet)
{
    for (int kind = 0; kind < 2; kind++) {
        test_tile tiles[2] = {pair[0], pair[1]};
        tiles[1].p[2] = 0.9f;
        if (kind == 1) {
            tiles[1].p[2] = 0.95f;
            tiles[1].u[2] = 0.05f;
        }
        fixture f;
        set_up(&f, tiles, 2);
        assert_int_equal(f.seams.count, 1);
        ASSERT_NEAR(f.seams.length, kind == 0 ? 0.1 : 0.05, 1e-6);
        tear_down(&f);
    }
}

TEST(any_workers_find_the_same)
{
    static const uint32_t workers[] = {1, 2, 7};
    for (int kind = 0; kind < 2; kind++) {
        pair_log first = {0, 0};
        for (int w = 0; w < 3; w++) {
            alp_context *context = test_context(workers[w]);
            alp_scene *scene = NULL;
            alp_lightmap *lightmap =
                kind == 0 ? make_facets(context, &scene) : make_stacks(context, &scene);
            alpi_seam_edges edges;
            pair_log log = {0, 0};
            ASSERT_OK(context, alpi_seam_edges_create(lightmap, &edges));
            ASSERT_OK(context, alpi_seam_pairs_visit(scene, &edges, log_pair, &log));
            first = w == 0 ? log : first;
            assert_true(log.hash == first.hash);
            assert_int_equal(log.count, first.count);
            if (kind == 0) { // each edge has one partner: the ball is closed
                assert_true(edges.count > 2 * 4096);
                assert_int_equal(2 * log.count, edges.count);
            } else { // between the stacks, and across the diagonals of each
                assert_int_equal(log.count, 3 * 32 * 32);
            }
            alpi_seam_edges_destroy(&edges);
            alp_lightmap_destroy(lightmap);
            alp_scene_destroy(scene);
            alp_context_destroy(context);
        }
    }
}

typedef struct patience {
    int asked, limit;
} patience;

static bool lose_patience(void *user, const alp_progress *progress)
{
    (void)progress;
    patience *p = user;
    return ++p->asked < p->limit;
}

/// Whichever question is the last.
TEST_WITH_CONTEXT(the_search_can_be_cancelled, 2)
{
    alp_scene *scene = NULL;
    alp_lightmap *lightmap = make_facets(context, &scene);
    alpi_seam_edges edges;
    ASSERT_OK(context, alpi_seam_edges_create(lightmap, &edges));
    alp_result result = ALP_ERROR_CANCELLED;
    int cancelled = 0;
    for (int limit = 1; result != ALP_OK; limit++) {
        patience p = {0, limit};
        pair_log log = {0, 0};
        const alpi_watch former =
            alpi_set_watch(context, (alpi_watch){.callback = lose_patience, .user = &p});
        result = alpi_seam_pairs_visit(lightmap->scene, &edges, log_pair, &log);
        alpi_set_watch(context, former);
        assert_true(result == ALP_OK || result == ALP_ERROR_CANCELLED);
        cancelled += result != ALP_OK;
    }
    assert_true(cancelled >= 4); // sorting, settling, and the bands of the search
    alpi_seam_edges_destroy(&edges);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST(memory_that_ends_is_said)
{
    int left = 1000000;
    alp_context *context = test_context_failing(&left);
    alp_scene *scene = test_tiles_scene(context, pair, 2, SIZE);
    alp_lightmap *lightmap = test_tiles_lightmap(scene, SIZE);
    float *page = test_tiles_page(lightmap, pair, 2, linear, NULL);
    alpi_seams seams = {0};
    alpi_seam_step error;
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int allocations = 0;
    for (; result == ALP_ERROR_OUT_OF_MEMORY; allocations++) {
        left = allocations;
        result = alpi_seams_create(lightmap, NULL, &seams);
        if (result == ALP_OK) {
            result = alpi_seams_measure(lightmap, &seams, &page, &error);
        }
        alpi_seams_destroy(&seams);
    }
    ASSERT_OK(context, result);
    assert_true(allocations > 8);
    left = 1000000;
    free(page);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}
