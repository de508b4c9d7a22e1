// SPDX-License-Identifier: MIT
// Neighbours that share what their paths find: the same light on the whole, less noise at each, and
// no bias where they see different things. Long receivers hear when nobody waits any more.
#include "test_lit.h"
#include "test_support.h"

#include "base/tasks.h"
#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdio.h>

TEST_CONTEXT(2);

static test_lit open_builtin(const char *name)
{
    alp_scene *scene = test_load(context, name);
    return test_lit_open(scene, NULL);
}

enum { POINTS = 40, LANES = 8 };

/// Blocks of the Cornell box's floor and walls: close neighbours, then points around a corner of
/// the short block, of which some see a light side and some a dark one.
static void set_points(vec3 *positions, vec3 *normals)
{
    for (uint32_t i = 0; i < POINTS; i++) {
        const float step = 0.004f * (float)(i % LANES);
        positions[i] = (vec3){0.1f + 0.08f * (float)(i / LANES) + step, 0.0f, 0.02f + step};
        normals[i] = (vec3){0.0f, 1.0f, 0.0f};
        if (i / LANES == 4) { // one block with all six normals in the middle of the room
            static const vec3 around[6] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                           {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
            positions[i] = (vec3){0.25f + 2.0f * step, 0.4f, 0.25f};
            normals[i] = around[i % 6];
        }
    }
}

static void gather(const test_lit *lit, bool share, uint32_t samples, uint64_t seed,
                   alpi_reference_value values[POINTS])
{
    vec3 positions[POINTS], normals[POINTS];
    set_points(positions, normals);
    alpi_reference r = test_lit_reference(lit, 6, samples);
    r.share = share;
    r.seed = seed;
    test_lit_irradiance(&r, positions, normals, 1e-6f, POINTS, values);
}

TEST(a_block_keeps_its_light)
{
    test_lit lit = open_builtin("builtin:cornell");
    alpi_reference_value alone[POINTS], shared[POINTS];
    gather(&lit, false, 256, 1, alone);
    gather(&lit, true, 256, 1, shared);
    for (uint32_t block = 0; block < POINTS; block += LANES) {
        double sums[2] = {0.0, 0.0};
        for (uint32_t i = block; i < block + LANES; i++) {
            sums[0] += (double)alone[i].mean[1];
            sums[1] += (double)shared[i].mean[1];
        }
        // The same paths: only the order of sums and weights of single precision differ.
        ASSERT_NEAR(sums[1], sums[0], 1e-5 * sums[0]);
    }
    test_lit_close(&lit);
}

TEST(sharing_is_unbiased)
{
    test_lit lit = open_builtin("builtin:cornell");
    alpi_reference_value alone[POINTS], shared[POINTS];
    gather(&lit, false, 1u << 14, 1, alone);
    gather(&lit, true, 1u << 13, 2, shared);
    double squares = 0.0;
    for (uint32_t i = 0; i < POINTS; i++) {
        for (int k = 0; k < 3; k++) {
            const double error = sqrt((double)alone[i].variance[k] + (double)shared[i].variance[k]);
            const double z = ((double)shared[i].mean[k] - (double)alone[i].mean[k]) / error;
            // Of 15 degrees of freedom, one of 8000 is further off; there are 120.
            ASSERT_NEAR(z, 0.0, 5.2);
            squares += z * z / (3.0 * POINTS);
            assert_true(error < 0.02 * (double)alone[i].mean[k] + 2e-3);
        }
    }
    // Neighbours' errors are alike: of 120 squares about 15 are independent, 1.15 ± .45.
    assert_true(squares < 2.7);
    printf("accuracy: shared against unshared paths, %d receivers: mean Z² %.2f\n", POINTS,
           squares);
    test_lit_close(&lit);
}

/// Error against many paths, over seeds. Direct light is no one's to share: what is left of the
/// noise is more than an eighth of its square.
TEST(sharing_leaves_less_noise)
{
    test_lit lit = open_builtin("builtin:cornell");
    alpi_reference_value truth[POINTS], values[POINTS];
    double squares[2] = {0.0, 0.0}, stated = 0.0;
    gather(&lit, true, 1u << 14, 99, truth);
    enum { SEEDS = 16, NEAR = 32 };
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        for (int share = 0; share < 2; share++) {
            gather(&lit, share != 0, 64, seed, values);
            for (uint32_t i = 0; i < NEAR; i++) {
                const double error = (double)values[i].mean[1] - (double)truth[i].mean[1];
                squares[share] += error * error;
                stated += share != 0 ? (double)values[i].variance[1] : 0.0;
            }
        }
    }
    const double gain = squares[0] / squares[1], truthful = sqrt(stated / squares[1]);
    printf("accuracy: shared paths, squared error of unshared over shared %.1f; stated over true "
           "error %.2f\n",
           gain, truthful);
    assert_true(gain > 1.8);
    // 16 seeds of 4 blocks, each one error: 4 standard errors of their spread.
    ASSERT_NEAR(truthful, 1.0, 0.35);
    test_lit_close(&lit);
}

TEST(workers_change_nothing)
{
    alpi_reference_value values[3][POINTS];
    static const uint32_t workers[3] = {1, 2, 7};
    for (int k = 0; k < 3; k++) {
        alp_context *other = test_context(workers[k]), *kept = context;
        context = other;
        alp_scene *scene = test_load(other, "builtin:cornell");
        test_lit lit = test_lit_open(scene, NULL);
        gather(&lit, true, 100, 1, values[k]);
        test_lit_close(&lit);
        alp_context_destroy(other);
        context = kept;
        assert_memory_equal(values[k], values[0], sizeof values[0]);
    }
}

/// A host that hands out ragged ranges, the last ones first.
static void ragged_parallel_for(void *user, uint32_t count, uint32_t grain, alp_range_fn *body,
                                void *body_user)
{
    (void)user;
    (void)grain;
    const uint32_t step = 3;
    for (uint32_t end = count; end > 0;) {
        const uint32_t begin = end > step ? end - step : 0;
        body(body_user, begin, end, 0);
        end = begin;
    }
}

TEST(a_host_changes_nothing)
{
    alpi_reference_value values[2][POINTS];
    for (int k = 0; k < 2; k++) {
        alp_context_options options = alp_context_options_default();
        options.worker_count = 1;
        options.parallel_for = k == 1 ? ragged_parallel_for : NULL;
        alp_context *other = NULL, *kept = context;
        assert_int_equal(alp_context_create(&options, &other), ALP_OK);
        context = other;
        test_lit lit = open_builtin("builtin:cornell");
        gather(&lit, true, 16, 1, values[k]);
        test_lit_close(&lit);
        alp_context_destroy(other);
        context = kept;
    }
    assert_memory_equal(values[1], values[0], sizeof values[0]);
}

/// A lit room with a wall in the middle whose back is open: a way from a receiver to where its
/// neighbour's path arrived may be open where the way back is not.
TEST(open_backs_are_open_one_way)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 dark = {0, 0, 0}, grey = {0.7f, 0.7f, 0.7f};
    alpi_builder_start(&b, context, "room");
    alpi_builder_surface(&b, "walls", alpi_builder_material(&b, "walls", grey, dark));
    alpi_builder_box(&b, (vec3){1, 1, 1}, dark, ALPI_FACE_ALL & ~(unsigned)ALPI_FACE_LEFT);
    alpi_builder_surface(&b, "lamp", alpi_builder_material(&b, "lamp", dark, (vec3){3, 3, 3}));
    alpi_builder_box(&b, (vec3){1, 1, 1}, dark, ALPI_FACE_LEFT);
    alpi_builder_surface(&b, "divider", alpi_builder_material(&b, "divider", grey, dark));
    alpi_builder_box(&b, (vec3){0.5f, 0, 0}, (vec3){0.5f, 0.8f, 1}, ALPI_FACE_RIGHT);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    test_lit lit = test_lit_open(scene, NULL);
    vec3 positions[LANES], normals[LANES];
    alpi_reference_value values[2][LANES];
    for (uint32_t i = 0; i < LANES; i++) { // four on each side, 1 cm apart
        positions[i] = (vec3){0.465f + 0.01f * (float)i, 0, 0.5f};
        normals[i] = (vec3){0, 1, 0};
    }
    for (int share = 0; share < 2; share++) {
        alpi_reference r = test_lit_reference(&lit, 6, 1u << 15);
        r.filter.one_sided = true;
        r.share = share != 0;
        r.seed = (uint64_t)share;
        test_lit_irradiance(&r, positions, normals, 1e-6f, LANES, values[share]);
    }
    for (uint32_t i = 0; i < LANES; i++) {
        const double error =
            sqrt((double)values[0][i].variance[1] + (double)values[1][i].variance[1]);
        ASSERT_NEAR(values[1][i].mean[1], values[0][i].mean[1], 5.2 * error);
        assert_true(error < 0.03 * (double)values[0][i].mean[1]);
    }
    test_lit_close(&lit);
}

typedef struct listener {
    uint32_t calls;
    uint64_t done, total;
} listener;

static bool refuse_second(void *user, const alp_progress *progress)
{
    listener *l = user;
    l->done = progress->done;
    l->total = progress->total;
    return ++l->calls < 2;
}

/// One receiver with paths for half a minute is left in the middle.
TEST(a_long_receiver_hears_the_end)
{
    test_lit lit = open_builtin("builtin:cornell");
    float positions[1][3] = {{0.2f, 0.0f, 0.1f}}, normals[1][3] = {{0.0f, 1.0f, 0.0f}};
    float offsets[1] = {1e-6f};
    const alpi_point_array array = {.count = 1,
                                    .positions = positions,
                                    .geometric_normals = normals,
                                    .shading_normals = normals,
                                    .offsets = offsets};
    const alpi_receivers receivers = alpi_point_array_receivers(&array);
    const alpi_reference r = test_lit_reference(&lit, 6, 1u << 24);
    alpi_reference_value value;
    listener l = {0};
    const alpi_task_progress progress = {.callback = refuse_second, .user = &l};
    assert_int_equal(alpi_reference_irradiance(&r, &receivers, NULL, 1, &progress, &value),
                     ALP_ERROR_CANCELLED);
    assert_int_equal(l.calls, 2);
    assert_true(l.done < l.total);
    test_lit_close(&lit);
}
