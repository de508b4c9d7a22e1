// SPDX-License-Identifier: MIT
// Each allocation of a small bake fails once, for each kind of file: the bake says so, gives all
// memory back, and leaves the files that were there as they were.
#include "test_small_bake.h"

#include <unistd.h>

/// In place of a number of workers: one, in a host whose loops run backwards.
enum { BACKWARDS = 0 };

/// Between two allocations that fail, where the whole would take long: a prime, so that the
/// rounds of a loop do not repeat it.
enum { SOME = 23 };

static alp_context *make_context(test_memory *memory, uint32_t workers)
{
    memory->backwards = workers == BACKWARDS;
    return test_memory_context(memory, workers == BACKWARDS ? 1 : workers);
}

static long count_allocations(const test_small_bake *bake, uint32_t workers)
{
    test_memory memory = {.failing = -1};
    alp_context *context = make_context(&memory, workers);
    ASSERT_OK(context, test_small_bake_run(bake, context));
    alp_context_destroy(context);
    assert_int_equal(atomic_load(&memory.live), 0);
    test_small_bake_reset(bake);
    return atomic_load(&memory.count);
}

/// Whether the bake succeeded without that allocation.
static bool fail_one(const test_small_bake *bake, long failing, uint32_t workers)
{
    test_memory memory = {.failing = failing};
    alp_context *context = make_context(&memory, workers);
    const alp_result result = test_small_bake_run(bake, context);
    const test_small_bake_state state = test_small_bake_look(bake);
    if (result == ALP_OK) { // as if nothing had been
        assert_int_equal(state.new, bake->file_count);
        test_small_bake_reset(bake);
    } else {
        assert_int_equal(result, ALP_ERROR_OUT_OF_MEMORY);
        assert_int_equal(state.old, bake->file_count);
        assert_int_equal(state.others, 0);
        assert_non_null(strstr(alp_context_message(context), "memory"));
    }
    alp_context_destroy(context);
    assert_int_equal(atomic_load(&memory.live), 0);
    return result == ALP_OK;
}

static void fail_each(int kind, uint32_t workers, long step)
{
    test_small_bake bake = test_small_bake_open(kind);
    const long total = count_allocations(&bake, workers);
    // Reading and writing, where the kinds differ, lie in these many first and last allocations.
    const long first = TEST_STEP > 1 ? 40 : 200, last = TEST_STEP > 1 ? 30 : 150;
    long tried = 0, harmless = 0;
    for (long i = 0; i < total;
         i += i < first || i >= total - last || step > 1 ? step : TEST_STEP) {
        harmless += fail_one(&bake, i, workers);
        tried++;
    }
    print_message("%s, %u workers%s: %ld of %ld allocations failed in turn, %ld of them harmless\n",
                  bake.kind, workers, workers == BACKWARDS ? " (a host)" : "", tried, total,
                  harmless);
    assert_in_range(total, 300, 5000);
    // Threads that cannot be made leave the work to the one that asked for them.
    assert_in_range(harmless, 0, workers < 2 ? 0 : 2);
    test_small_bake_close(&bake);
}

TEST(gltf)
{
    fail_each(0, 1, 1);
}

TEST(collada)
{
    fail_each(1, 1, 1);
}

TEST(obj)
{
    fail_each(2, 1, 1);
}

/// Other ways to write; what comes before is the same.
TEST(other_outputs)
{
    for (int kind = 3; kind < TEST_SMALL_BAKE_KINDS; kind++) {
        fail_each(kind, 1, SOME);
    }
}

/// Ranges follow after one that failed, as they may with several workers: by chance there, here
/// always. What a worker keeps between ranges must bear that.
TEST(ranges_after_a_failure)
{
    fail_each(2, BACKWARDS, 1);
}

TEST(two_workers)
{
    for (int kind = 0; kind < 3; kind++) {
        fail_each(kind, 2, SOME);
    }
}

/// Each limit of a ladder fails somewhere else: the bake says in which stage, gives all memory
/// back, and leaves the files that were there as they were.
TEST(budgets)
{
    enum { LEAST = 1000, MOST = 4 << 20 };
    for (int kind = 0; kind < TEST_SMALL_BAKE_KINDS; kind++) {
        test_small_bake bake = test_small_bake_open(kind);
        int refused = 0, baked = 0;
        for (double limit = LEAST; limit < MOST && baked == 0;
             limit *= TEST_STEP > 1 ? 1.2 : 1.04) {
            test_memory memory = {.failing = -1};
            alp_context *context = make_context(&memory, 1 + (uint32_t)refused % 2);
            bake.memory_limit = (uint64_t)limit;
            const alp_result result = test_small_bake_run(&bake, context);
            const test_small_bake_state found = test_small_bake_look(&bake);
            if (result == ALP_OK) {
                assert_int_equal(found.new, bake.file_count);
                baked++;
            } else {
                assert_int_equal(result, ALP_ERROR_LIMIT);
                assert_non_null(strstr(alp_context_message(context), "stage \""));
                assert_int_equal(found.old, bake.file_count);
                assert_int_equal(found.others, 0);
                refused++;
            }
            alp_context_destroy(context);
            assert_int_equal(atomic_load(&memory.live), 0);
        }
        print_message("%s: %d limits were too low\n", bake.kind, refused);
        assert_true(refused > 10 && baked == 1);
        test_small_bake_reset(&bake);
        test_small_bake_close(&bake);
    }
}

/// Loads and estimates, without that allocation. @return the allocations there were
static long estimate_without(long failing, alp_result *result)
{
    test_memory memory = {.failing = failing};
    alp_context *context = test_memory_context(&memory, 1);
    alp_bake_options options = alp_bake_options_default();
    options.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    options.light.lighting.sky.up[2] = 1.0f;
    options.occluders = "*";
    alp_scene *scene = NULL;
    alp_bake_work work;
    *result = alp_scene_load(context, "builtin:cornell", &scene);
    if (*result == ALP_OK) {
        *result = alp_bake_estimate(scene, &options, &work);
    }
    if (*result == ALP_OK) { // light has no chosen occluders
        options.maps = ALP_MAP_AO | ALP_MAP_LIGHT;
        options.occluders = NULL;
        *result = alp_bake_estimate(scene, &options, &work);
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    assert_int_equal(atomic_load(&memory.live), 0);
    return atomic_load(&memory.count);
}

TEST(estimates)
{
    alp_result result;
    const long total = estimate_without(-1, &result);
    assert_int_equal(result, ALP_OK);
    for (long i = 0; i < total; i += TEST_STEP) {
        (void)estimate_without(i, &result);
        assert_int_equal(result, ALP_ERROR_OUT_OF_MEMORY);
    }
    print_message("estimate: %ld allocations, one in %d failed\n", total, TEST_STEP);
}

/// The page of a report, after a bake that went well.
TEST(report)
{
    const char *path = test_path(test_folder(), "page.html");
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    long failing = 0;
    for (; result != ALP_OK; failing += TEST_STEP) {
        test_memory memory = {.failing = -1};
        alp_context *context = test_memory_context(&memory, 1);
        alp_bake_options options = alp_bake_options_default();
        options.atlas.size = 16;
        options.occlusion.samples = 4;
        alp_scene *scene = NULL;
        alp_lightmap *lightmap = NULL;
        alp_bake_report made;
        ASSERT_OK(context, alp_scene_load(context, "builtin:sphere-plane", &scene));
        ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &made));
        memory.failing = atomic_load(&memory.count) + failing;
        result = alp_bake_write_report(scene, lightmap, &made, NULL, path);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_int_equal(result == ALP_OK, access(path, F_OK) == 0);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
        assert_int_equal(atomic_load(&memory.live), 0);
    }
    print_message("report: %ld allocations, one in %d failed\n", failing - TEST_STEP, TEST_STEP);
    assert_in_range(failing, 10, 1000);
}
