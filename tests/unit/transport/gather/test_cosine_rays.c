// SPDX-License-Identifier: MIT
// Cosine rays: how they are spread, form factors by them and by hemicubes, and that the error they
// state is the one they have.
#include "test_probe.h"

#include "transport/gather/cosine_rays.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const vec3 UP = {0, 1, 0};
TEST_CONTEXT(2);

TEST(samples_are_rounded_up)
{
    static const uint32_t cases[][3] = {{0, 1, 8},   {1, 1, 8},   {8, 1, 8},
                                        {9, 1, 16},  {64, 4, 64}, {65, 4, 96},
                                        {31, 4, 32}, {1, 8, 64},  {128, 8, 128}};
    for (int i = 0; i < 9; i++) {
        assert_int_equal(alpi_cosine_rays_samples(cases[i][0], cases[i][1]), cases[i][2]);
    }
}

// --- directions ----------------------------------------------------------------------------------

enum { PACKETS = 512, RAYS = PACKETS * ALPI_PACKET };

static void aim_all(const alpi_gatherer *g, const alpi_receivers *receivers, uint32_t batch,
                    alpi_gather_packet *packets)
{
    for (uint32_t first = 0; first < g->packet_count; first += batch) {
        const uint32_t left = g->packet_count - first;
        g->aim(g->user, receivers, 1, first, left < batch ? left : batch, packets + first, NULL);
    }
}

/// Two patches, of which the second slopes.
static alpi_receivers sloping(test_patches *all)
{
    static test_patch patches[2];
    const vec3 slope = {0, 0.6f, 0.8f};
    patches[0] = test_point((vec3){0, 0, 0}, UP);
    patches[1] = (test_patch){{1, 2, 3}, {2, 0, 0}, {0, 0.8f, -0.6f}, slope};
    *all = (test_patches){.count = 2, .patches = patches, .offset = 0.25f};
    return test_patches_receivers(all);
}

/// Directions lie evenly on the disk under the hemisphere, and starts over the patch: 32 cells of
/// each hold their share, better than random rays do.
TEST(rays_are_spread_evenly)
{
    static alpi_gather_packet packets[PACKETS];
    const vec3 slope = {0, 0.6f, 0.8f};
    test_patches all;
    const alpi_receivers receivers = sloping(&all);
    const alpi_cosine_rays rays = {.context = context, .samples = RAYS, .replicates = 1, .seed = 5};
    const alpi_gatherer g = alpi_cosine_rays_gatherer(&rays);
    uint32_t rings[32] = {0}, turns[32] = {0}, columns[32] = {0};
    assert_int_equal(g.packet_count, PACKETS);
    assert_true(g.replicates == 1 && g.weights == NULL && !g.coherent);
    aim_all(&g, &receivers, ALPI_GATHER_BATCH, packets);
    for (uint32_t i = 0; i < RAYS; i++) {
        const alpi_rays *r = &packets[i / ALPI_PACKET].rays;
        const uint32_t k = i % ALPI_PACKET;
        const vec3 d = {r->direction_x[k], r->direction_y[k], r->direction_z[k]};
        const double cosine = (double)vec3_dot(d, slope);
        const double across = (double)vec3_dot(d, (vec3){0, 0.8f, -0.6f});
        const double height =
            (double)vec3_dot(slope, (vec3){r->origin_x[k], r->origin_y[k], r->origin_z[k]});
        assert_int_equal(packets[i / ALPI_PACKET].active, 0xff);
        assert_true(r->maximum[k] == INFINITY && r->minimum[k] == 0.0f);
        ASSERT_NEAR(vec3_length(d), 1.0, 1e-6);
        ASSERT_NEAR(height, 0.6 * 2.0 + 0.8 * 3.0 + 0.25, 1e-5);
        assert_true(cosine > 0.0);
        rings[(int)(31.9999 * cosine * cosine)]++;
        turns[(int)(31.9999 * (atan2(across, (double)d.x) / (2.0 * ALPI_PI) + 0.5))]++;
        columns[(int)(31.9999 * ((double)r->origin_x[k] - 1.0) / 2.0)]++;
    }
    for (int i = 0; i < 32;
         i++) { // 128 in each; random rays would be off by 11, and 36 at the worst
        ASSERT_NEAR(rings[i], RAYS / 32, 11);
        ASSERT_NEAR(turns[i], RAYS / 32, 11);
        ASSERT_NEAR(columns[i], RAYS / 32, 11);
    }
}

/// Packets of a replicate that follow each other leave from the same eight points, up to four rays
/// of each; other points lie elsewhere.
TEST(packets_share_points)
{
    static const uint32_t samples[] = {64, 96, 256, 1280};
    alpi_gather_packet packets[160];
    test_patches all;
    const alpi_receivers receivers = sloping(&all);
    for (int joined = 0; joined < 8; joined++) {
        const alpi_cosine_rays rays = {.context = context,
                                       .samples = samples[joined / 2],
                                       .replicates = 4,
                                       .joined = joined % 2 != 0,
                                       .seed = 5};
        const alpi_gatherer g = alpi_cosine_rays_gatherer(&rays);
        const uint32_t each = g.packet_count / 4;
        aim_all(&g, &receivers, ALPI_GATHER_BATCH, packets);
        for (uint32_t p = 0; p < g.packet_count; p++) {
            const alpi_rays *r = &packets[p].rays;
            const uint32_t turn = p % each % 4; // of the packets from these points
            assert_int_equal(alpi_gather_replicate(&g, p), p / each);
            for (uint32_t i = 0; i < ALPI_PACKET; i++) {
                for (uint32_t before = 1; before <= turn; before++) {
                    const alpi_rays *s = &packets[p - before].rays;
                    assert_true(r->origin_x[i] == s->origin_x[i]);
                    assert_true(r->origin_z[i] == s->origin_z[i]);
                    assert_true(r->direction_x[i] != s->direction_x[i]);
                }
                assert_true(turn > 0 || p == 0 ||
                            r->origin_x[i] != packets[p - 1].rays.origin_x[i]);
            }
        }
    }
}

/// Packets are the same in whatever batches they are asked for, and others for other receivers,
/// seeds and replicates.
TEST(batches_change_nothing)
{
    static alpi_gather_packet packets[4][32];
    static const uint32_t batches[4] = {32, 5, 1, 32};
    test_patches all;
    const alpi_receivers receivers = sloping(&all);
    alpi_cosine_rays rays = {.context = context, .samples = 256, .replicates = 4, .seed = 5};
    const alpi_gatherer g = alpi_cosine_rays_gatherer(&rays);
    for (int i = 0; i < 4; i++) {
        rays.seed = i == 3 ? 6 : 5;
        memset(packets[i], 0, sizeof packets[i]);
        aim_all(&g, &receivers, batches[i], packets[i]);
    }
    assert_memory_equal(packets[1], packets[0], sizeof packets[0]);
    assert_memory_equal(packets[2], packets[0], sizeof packets[0]);
    for (int p = 0; p < 32; p++) {
        const float *x = packets[0][p].rays.direction_x;
        assert_memory_not_equal(packets[3][p].rays.direction_x, x,
                                sizeof packets[0][p].rays.direction_x);
        for (int q = 0; q < p; q++) {
            assert_memory_not_equal(packets[0][q].rays.direction_x, x,
                                    sizeof packets[0][p].rays.direction_x);
        }
    }
}

static int compare_rays(const void *a, const void *b)
{
    return memcmp(a, b, 3 * sizeof(float));
}

/// Directions of all rays of a receiver, in an order of their own.
static void sort_rays(const alpi_gatherer *g, const alpi_receivers *receivers, float (*rays)[3])
{
    static alpi_gather_packet packets[32];
    aim_all(g, receivers, 32, packets);
    for (uint32_t i = 0; i < g->packet_count * ALPI_PACKET; i++) {
        const alpi_rays *r = &packets[i / ALPI_PACKET].rays;
        rays[i][0] = r->direction_x[i % ALPI_PACKET];
        rays[i][1] = r->direction_y[i % ALPI_PACKET];
        rays[i][2] = r->direction_z[i % ALPI_PACKET];
    }
    qsort(rays, g->packet_count * ALPI_PACKET, sizeof *rays, compare_rays);
}

/// Joined, the replicates have the rays of one.
TEST(joined_replicates_are_one_sequence)
{
    static float one[256][3], four[256][3];
    test_patches all;
    const alpi_receivers receivers = sloping(&all);
    alpi_cosine_rays rays = {.context = context, .samples = 256, .replicates = 1, .seed = 5};
    const alpi_gatherer alone = alpi_cosine_rays_gatherer(&rays);
    sort_rays(&alone, &receivers, one);
    rays.replicates = 4;
    rays.joined = true;
    const alpi_gatherer dealt = alpi_cosine_rays_gatherer(&rays);
    sort_rays(&dealt, &receivers, four);
    assert_memory_equal(four, one, sizeof one);
    rays.joined = false;
    sort_rays(&dealt, &receivers, four);
    assert_memory_not_equal(four, one, sizeof one);
}

// --- light ---------------------------------------------------------------------------------------

static alpi_reference_value gather_one(const test_probe *p, const alpi_gatherer *g,
                                       const test_patch *patch)
{
    const test_patches all = {.count = 1, .patches = patch, .offset = 1e-6f};
    const alpi_receivers receivers = test_patches_receivers(&all);
    alpi_reference_value value = {{0.0f}, {0.0f}};
    const alpi_gather_job job = {.context = context,
                                 .from = &p->options.from,
                                 .gatherer = g,
                                 .receivers = &receivers,
                                 .count = 1,
                                 .values = &value};
    ASSERT_OK(context, alpi_gather_irradiance(&job, NULL));
    return value;
}

/// Unit squares a metre above the unit square at the origin, facing down, and beside it.
static const vec3 OPPOSITE[4] = {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}};
static const vec3 ADJACENT[4] = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
static const test_patch SQUARE = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}};

/// By hemicubes the mean over a square: one at the middle of each of 16 × 16 parts. Each is turned
/// in its own way.
static double hemicube_factor(test_probe *p)
{
    double sum = 0.0;
    p->options.turned = true;
    for (uint64_t i = 0; i < 256; i++) {
        const vec3 at = {((float)(i % 16) + 0.5f) / 16.0f, 0, ((float)(i / 16) + 0.5f) / 16.0f};
        const alpi_receiver_point point = test_probe_point(at, UP);
        sum += test_probe_gather(p, &point, i) / ALPI_PI;
    }
    return sum / 256.0;
}

/// Oracle 12, through both gatherers.
TEST(unit_squares)
{
    for (int k = 0; k < 2; k++) {
        const double exact = k == 0 ? 0.199824896 : 0.200043776;
        test_probe p = test_probe_open(
            context, test_probe_quad(context, k == 0 ? OPPOSITE : ADJACENT), NULL, 32);
        const alpi_cosine_rays rays = {
            .context = context, .samples = 65536, .replicates = 8, .seed = 1};
        const alpi_gatherer g = alpi_cosine_rays_gatherer(&rays);
        const alpi_reference_value v = gather_one(&p, &g, &SQUARE);
        const double by_rays = (double)v.mean[0] / ALPI_PI, by_cubes = hemicube_factor(&p);
        const double error = sqrt((double)v.variance[0]) / ALPI_PI;
        printf("accuracy: unit squares, %s: rays %+.1e, hemicubes %+.1e of %.9f\n",
               k == 0 ? "opposite" : "adjacent", by_rays / exact - 1.0, by_cubes / exact - 1.0,
               exact);
        ASSERT_NEAR(by_rays, exact, 6.0 * error); // Student's t of 7 degrees of freedom
        assert_true(error < 1e-2 * exact);
        // 16 × 16 points instead of all of the square, and whole pixels of 32; squares that touch
        // are uneven near the edge.
        ASSERT_NEAR(by_cubes, exact, (k == 0 ? 3e-3 : 1e-2) * exact);
        test_probe_close(&p);
    }
}

/// The factors of a closed cube's other faces sum to 1, ray for ray.
TEST(a_closed_cube_sums_to_one)
{
    alp_scene *scene = test_load(context, "builtin:furnace");
    test_probe p = test_probe_open(context, scene, NULL, 8);
    const alpi_cosine_rays rays = {.context = context, .samples = 64, .replicates = 4, .seed = 1};
    const alpi_gatherer g = alpi_cosine_rays_gatherer(&rays),
                        cubes = alpi_hemicube_gatherer(&p.options);
    const test_patch floor = {{-0.5f, -0.5f, -0.5f}, {1, 0, 0}, {0, 0, 1}, UP};
    const vec3 middle = vec3_scale(vec3_add(scene->bounds_min, scene->bounds_max), 0.5f);
    test_patch moved = floor;
    moved.corner = vec3_add(floor.corner, middle);
    const alpi_reference_value v = gather_one(&p, &g, &moved), c = gather_one(&p, &cubes, &moved);
    ASSERT_NEAR(v.mean[0], ALPI_PI, 4e-7 * ALPI_PI);
    ASSERT_NEAR(c.mean[0], ALPI_PI, 4e-7 * ALPI_PI);
    assert_true(v.variance[0] < 1e-12f);
    test_probe_close(&p);
}

/// What rays find of the opposite square, F.
typedef struct case_of_error {
    const char *name;
    test_patch patch;
    double exact;
    uint32_t samples, replicates;
    double least; // of random rays' variance that is left at most
} case_of_error;

static void hold_error(const test_probe *p, const case_of_error *c)
{
    enum { SEEDS = 512 };
    double squares = 0.0, stated = 0.0, sum = 0.0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        const alpi_cosine_rays rays = {
            .context = context, .samples = c->samples, .replicates = c->replicates, .seed = seed};
        const alpi_gatherer g = alpi_cosine_rays_gatherer(&rays);
        const alpi_reference_value v = gather_one(p, &g, &c->patch);
        const double off = (double)v.mean[0] / ALPI_PI - c->exact;
        sum += off;
        squares += off * off;
        stated += (double)v.variance[0] / (ALPI_PI * ALPI_PI);
    }
    const double random = SEEDS * c->exact * (1.0 - c->exact) / c->samples;
    printf("accuracy: %u cosine rays in %u replicates, %s: error %.2f of what is stated, %.2f of "
           "random rays', bias %+.1e\n",
           c->samples, c->replicates, c->name, sqrt(squares / stated), sqrt(squares / random),
           sum / SEEDS / c->exact);
    // Squares of normal errors over S seeds spread by √(2/S), what n replicates state by
    // √(2/((n − 1) S)): together by 7 %, four times.
    ASSERT_NEAR(squares / stated, 1.0, 0.29);
    ASSERT_NEAR(sum / SEEDS, 0.0, 4.0 * sqrt(squares) / SEEDS);
    assert_true(squares < c->least * random);
}

/// The variance that replicates state is that of the mean, at a point and over a patch. At a point
/// strata of directions do their work; over a large patch what a place sees differs, and the two
/// are not stratified together.
TEST(the_stated_variance_is_true)
{
    const test_patch middle = test_point((vec3){0.5f, 0, 0.5f}, UP);
    const double side = 0.5, slant = sqrt(1.0 + side * side); // oracle 6, four times
    const double seen = 4.0 * (2.0 * side / slant * atan(side / slant)) / (2.0 * ALPI_PI);
    const case_of_error cases[] = {{"a point", middle, seen, 64, 4, 0.6},
                                   {"a point", middle, seen, 256, 8, 0.5},
                                   {"a point", middle, seen, 1024, 4, 0.3},
                                   {"a patch", SQUARE, 0.199824896, 64, 4, 1.0},
                                   {"a patch", SQUARE, 0.199824896, 256, 4, 1.0}};
    test_probe p = test_probe_open(context, test_probe_quad(context, OPPOSITE), NULL, 8);
    for (int i = 0; i < 5; i++) {
        hold_error(&p, &cases[i]);
    }
    test_probe_close(&p);
}

/// Form factor of a rectangle a metre above a point, which lies below a corner of it: oracle 6.
static double corner_factor(double a, double b)
{
    const double p = sqrt(1.0 + a * a), q = sqrt(1.0 + b * b);
    return (a / p * atan(b / p) + b / q * atan(a / q)) / (2.0 * ALPI_PI);
}

/// Joined replicates err less than those apart, and say that they err as much: what is off is their
/// variance alone, by a factor above 1. Not below the middle of the square, whose parts are alike.
TEST(joined_replicates_err_less)
{
    enum { SEEDS = 512 };
    const double x = 0.21, z = 0.37;
    const test_patch point = test_point((vec3){(float)x, 0, (float)z}, UP);
    const double seen = corner_factor(x, z) + corner_factor(1.0 - x, z) +
                        corner_factor(x, 1.0 - z) + corner_factor(1.0 - x, 1.0 - z);
    test_probe p = test_probe_open(context, test_probe_quad(context, OPPOSITE), NULL, 8);
    double squares[2] = {0.0, 0.0}, stated[2] = {0.0, 0.0}, sum = 0.0;
    for (uint64_t i = 0; i < 2 * SEEDS; i++) {
        const bool joined = i % 2 == 1;
        const alpi_cosine_rays rays = {
            .context = context, .samples = 64, .replicates = 4, .joined = joined, .seed = i};
        const alpi_gatherer g = alpi_cosine_rays_gatherer(&rays);
        const alpi_reference_value v = gather_one(&p, &g, &point);
        const double off = (double)v.mean[0] / ALPI_PI - seen;
        squares[joined] += off * off;
        stated[joined] += (double)v.variance[0] / (ALPI_PI * ALPI_PI);
        sum += joined ? off : 0.0;
    }
    printf("accuracy: 64 cosine rays in 4 replicates joined: squared error %.2f of that of those "
           "apart, %.2f of what is stated\n",
           squares[1] / squares[0], squares[1] / stated[1]);
    // N points of one sequence err as N^-3/4 about an edge, four of a quarter of them each as
    // √2 times that, of which half the gain is asked: a ratio of two sums over 512 seeds is known
    // to √(2 · 2 / 512) = 9 %, four times.
    assert_true(squares[1] < 0.75 * squares[0]);
    assert_true(stated[1] > 1.36 * squares[1]);
    ASSERT_NEAR(sum / SEEDS, 0.0, 4.0 * sqrt(squares[1]) / SEEDS);
    test_probe_close(&p);
}
