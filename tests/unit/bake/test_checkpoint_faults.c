// SPDX-License-Identifier: MIT
// Faults of checkpoints of whole bakes: damage, a full disk and missing memory change no bit of the
// result, and a warning says so.
#include "checkpointed_bake.h"
#include "test_obj.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

static const checkpointed_kind light = {
    .name = "light", .maps = ALP_MAP_AO | ALP_MAP_LIGHT, .bounces = 2};

enum { EACH = 250 }; // first allocations of which each fails
static char folder[512];

static void new_folder(void)
{
    snprintf(folder, sizeof folder, "%s", test_folder());
    test_log_clear();
}

static uint64_t bake_whole(const checkpointed_kind *kind, uint32_t *stop_after)
{
    checkpointed_bake bake = {.kind = kind, .workers = 1};
    assert_int_equal(checkpointed_run(&bake), ALP_OK);
    *stop_after = bake.first + (bake.ranges - bake.first) * 9 / 10;
    return bake.files;
}

/// Stops a bake near its end. @return its log, malloc'ed
static unsigned char *stop_late(const checkpointed_kind *kind, uint32_t stop_after, size_t *size)
{
    checkpointed_bake bake = {
        .kind = kind, .workers = 1, .folder = folder, .every = 1000.0, .stop_after = stop_after};
    new_folder();
    assert_int_equal(checkpointed_run(&bake), ALP_ERROR_CANCELLED);
    return test_read_file(test_path(folder, "bake.tiles"), size);
}

/// Goes on from a log in a new folder. @return tiles that were read
static uint64_t go_on(const checkpointed_kind *kind, const unsigned char *log, size_t size,
                      uint64_t files)
{
    checkpointed_bake bake = {.kind = kind, .workers = 2, .folder = folder, .every = 1000.0};
    new_folder();
    test_write_file(test_path(folder, "bake.tiles"), log, size);
    assert_int_equal(checkpointed_run(&bake), ALP_OK);
    assert_true(bake.files == files);
    assert_true(test_log_has("checkpoint-damaged"));
    return bake.report.tiles_read;
}

TEST(damaged_logs)
{
    uint32_t stop_after;
    size_t size;
    const uint64_t files = bake_whole(&light, &stop_after);
    unsigned char *log = stop_late(&light, stop_after, &size);
    uint64_t former = 0;
    for (size_t k = 1; k < 16; k++) {
        const uint64_t read = go_on(&light, log, size * k / 16, files);
        assert_true(read >= former);
        former = read;
    }
    assert_true(former > 0);
    for (size_t k = 0; k < 30; k++) {
        const size_t at = k < 10 ? k * 8 : size * k / 30;
        log[at] ^= (unsigned char)(1u << k % 8);
        (void)go_on(&light, log, size, files);
        log[at] ^= (unsigned char)(1u << k % 8);
    }
    free(log);
}

/// A log with whole records of another loop's bytes, whose checksums are right.
TEST(records_of_other_loops)
{
    static const checkpointed_kind other = {
        .name = "other", .maps = ALP_MAP_AO | ALP_MAP_LIGHT, .bounces = 1};
    uint32_t stop_after, other_stop;
    size_t size, other_size;
    const uint64_t files = bake_whole(&light, &stop_after);
    (void)bake_whole(&other, &other_stop);
    unsigned char *log = stop_late(&light, stop_after, &size);
    unsigned char *foreign = stop_late(&other, other_stop, &other_size);
    assert_memory_not_equal(log, foreign, 24); // their keys differ
    assert_int_equal(go_on(&light, foreign, other_size, files), 0);
    free(log);
    free(foreign);
}

/// A limit on the size of files stands for the disk. The maps fit, and the log does not.
TEST(a_full_disk)
{
    static const checkpointed_kind large = {.name = "large",
                                            .maps = ALP_MAP_AO | ALP_MAP_LIGHT | ALP_MAP_SH,
                                            .bounces = 2,
                                            .size = 192}; // takes several intervals
    checkpointed_bake whole = {.kind = &large, .workers = 1};
    assert_int_equal(checkpointed_run(&whole), ALP_OK);
    struct rlimit limit, small;
    new_folder();
    checkpointed_bake bake = {.kind = &large, .workers = 2, .folder = folder, .every = 0.1};
    void (*former)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    small = limit;
    small.rlim_cur = whole.largest + 4096;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const alp_result result = checkpointed_run(&bake);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    signal(SIGXFSZ, former);
    if (result != ALP_OK) {
        fail_msg("%s", bake.message);
    }
    assert_true(bake.files == whole.files);
    assert_true(test_log_has("checkpoint-not-written"));
    assert_non_null(strstr(test_log_text(), "File too large"));
}

/// Each step-th allocation of a bake fails; the bake is then run again on what it left.
static void fail_each(const checkpointed_kind *kind, long step)
{
    uint32_t stop_after;
    const uint64_t files = bake_whole(kind, &stop_after);
    test_memory memory = {.failing = -1};
    checkpointed_bake bake = {.kind = kind, .folder = folder, .every = 1000.0, .memory = &memory};
    new_folder();
    assert_int_equal(checkpointed_run(&bake), ALP_OK);
    const long total = atomic_load(&memory.count);
    long harmless = 0;
    for (long i = 0; i < total; i += i < EACH ? step : 5 * step) {
        memory.failing = i;
        new_folder();
        const alp_result result = checkpointed_run(&bake);
        if (result != ALP_OK) {
            assert_int_equal(result, ALP_ERROR_OUT_OF_MEMORY);
            assert_non_null(strstr(bake.message, "memory"));
            memory.failing = -1;
            assert_int_equal(checkpointed_run(&bake), ALP_OK);
        }
        assert_true(bake.files == files);
        harmless += result == ALP_OK ? 1 : 0;
    }
    print_message("%s: some of %ld allocations failed, %ld of them harmless\n", kind->name, total,
                  harmless);
    assert_in_range(total, 200, 5000);
    assert_in_range(harmless, 0, 40); // the checkpoint warns and lacks tiles
}

TEST(each_allocation_fails)
{
    static const checkpointed_kind tiny = {.name = "occlusion", .maps = ALP_MAP_AO, .size = 8};
    fail_each(&tiny, TEST_STEP);
}

TEST(some_allocations_of_light_fail)
{
    static const checkpointed_kind tiny = {
        .name = "light", .maps = ALP_MAP_LIGHT, .bounces = 1, .size = 8};
    fail_each(&tiny, 29);
}
