// SPDX-License-Identifier: MIT
// The loops over the rays of a cube's pixels: the same bits by every instruction set.
#include "test_support.h"

#include "base/random.h"
#include "transport/sphere/sphere_moments.h"
#include "transport/sphere/sphere_relight.h"

TEST_CONTEXT(1);

#ifdef ALPI_HAS_V3

enum { PACKETS = 12, CELLS = 64 };

/// All that the loops make of some packets.
typedef struct results {
    alpi_sphere_packet packets[PACKETS];
    alpi_sphere_tallies tallies;
    alpi_sphere_moments moments;
    float nearest[ALPI_PACKET];
    uint32_t met[PACKETS];
} results;

static float cells[CELLS][4];
static alpi_hits hits[PACKETS];

static void draw(void)
{
    for (uint32_t i = 0; i < CELLS; i++) {
        for (uint32_t k = 0; k < 4; k++) {
            cells[i][k] = alpi_unit_float(alpi_hash32(4 * i + k));
        }
    }
    for (uint32_t i = 0; i < PACKETS * ALPI_PACKET; i++) {
        const bool open = i % 5 == 0;
        hits[i / ALPI_PACKET].triangle[i % ALPI_PACKET] = open ? ALPI_NONE : i;
        hits[i / ALPI_PACKET].distance[i % ALPI_PACKET] =
            open ? INFINITY : 3.0f * alpi_unit_float(alpi_hash32(i));
    }
}

static void run(const alpi_sphere_loops *loops, results *r)
{
    memset(r, 0, sizeof *r);
    for (int i = 0; i < ALPI_PACKET; i++) {
        r->nearest[i] = INFINITY;
    }
    for (uint32_t k = 0; k < PACKETS; k++) {
        uint32_t of[ALPI_PACKET];
        const alpi_sphere_place place = {.point = {0.1f, -2.0f, 30.0f},
                                         .key = 77,
                                         .face_side = 8,
                                         .face = k % 6,
                                         .column = k / 6 * 4,
                                         .row = k % 4 * 2};
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            of[i] = alpi_hash32(k * ALPI_PACKET + i) % CELLS;
        }
        loops->aim(&place, &r->packets[k]);
        loops->light((const float(*)[4])cells, of, &r->packets[k]);
        loops->find_nearest(&hits[k], r->nearest);
        r->met[k] = loops->find_met(&hits[k]);
    }
    loops->add(r->packets, PACKETS, &r->tallies);
    alpi_sphere_moments_add(loops, r->packets, hits, PACKETS, 1.5f, &r->moments);
}

TEST(instruction_sets_give_the_same_bits)
{
    static results a, b;
    draw();
    run(&alpi_sphere_loops_baseline, &a);
    for (uint32_t i = 0; i < PACKETS * ALPI_PACKET; i++) {
        assert_int_equal(a.met[i / ALPI_PACKET] >> i % ALPI_PACKET & 1u, i % 5 != 0);
    }
    if (alpi_context_has_v3(context)) {
        run(&alpi_sphere_loops_v3, &b);
        assert_memory_equal(&a, &b, sizeof a);
    }
}

// --- hits ----------------------------------------------------------------------------------------

typedef struct hits_results {
    alpi_sphere_packet packet;
    alpi_sphere_met met;
    alpi_rays rays;
    float cosines[ALPI_PACKET];
    uint32_t facing;
} hits_results;

/// Hits in triangles that are drawn about the rays' ends.
static void run_hits(const alpi_sphere_hits_loops *loops, uint32_t number, hits_results *r)
{
    static alpi_sphere_lamp lamp = {.mask = 3,
                                    .directions = {{0.0f, 1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}}};
    const alpi_sphere_place place = {
        .point = {0.1f, -2.0f, 30.0f}, .key = number, .face_side = 8, .face = number % 6};
    memset(r, 0, sizeof *r);
    alpi_sphere_loops_baseline.aim(&place, &r->packet);
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        for (uint32_t k = 0; k < 9; k++) {
            r->met.corners[k / 3][k % 3][i] =
                10.0f * alpi_unit_float(alpi_hash32(9 * (number * ALPI_PACKET + i) + k)) - 5.0f;
        }
        r->met.distance[i] = (float)(i + number);
        r->met.albedo[0][i] = r->met.albedo[1][i] = r->met.albedo[2][i] = (float)(20 * i);
    }
    r->met.key = number;
    loops->place(&r->packet, &r->met);
    r->facing = loops->aim(&r->met, &lamp, &r->rays, r->cosines);
    r->rays.maximum[3] = -INFINITY; // blocked
    loops->add(&r->rays, r->facing, r->cosines, (vec3){1.0f, 2.0f, 3.0f}, &r->met);
    loops->reflect(&r->met, &r->packet);
}

TEST(instruction_sets_place_hits_alike)
{
    static hits_results a, b;
    uint32_t facing = 0;
    for (uint32_t number = 0; number < 64 && alpi_context_has_v3(context); number++) {
        run_hits(&alpi_sphere_hits_loops_baseline, number, &a);
        run_hits(&alpi_sphere_hits_loops_v3, number, &b);
        assert_memory_equal(&a, &b, sizeof a);
        facing |= a.facing;
        assert_true(a.packet.light[1][3] == 0.0f);
    }
    assert_true(facing == 0xffu || !alpi_context_has_v3(context));
}

/// Each ray's weight, distance up to the reach and its square lie in some texel and bin.
TEST(moments_are_of_distances_up_to_the_reach)
{
    static results a;
    double sums[3] = {0.0, 0.0, 0.0}, expected[3] = {0.0, 0.0, 0.0};
    draw();
    run(&alpi_sphere_loops_baseline, &a);
    for (uint32_t i = 0; i < PACKETS * ALPI_PACKET; i++) {
        const double w = (double)a.packets[i / ALPI_PACKET].weight[i % ALPI_PACKET];
        const double d = fmin((double)hits[i / ALPI_PACKET].distance[i % ALPI_PACKET], 1.5);
        expected[0] += w;
        expected[1] += w * d;
        expected[2] += w * d * d;
    }
    for (uint32_t t = 0; t < ALPI_SPHERE_MOMENTS; t++) {
        for (int i = 0; i < 3 * ALPI_MOMENT_BINS; i++) {
            sums[i % 3] += a.moments.sums[t][i / 3][i % 3];
        }
    }
    for (int k = 0; k < 3; k++) {
        ASSERT_NEAR(sums[k], expected[k], 1e-6 * expected[k]);
    }
}

#endif
