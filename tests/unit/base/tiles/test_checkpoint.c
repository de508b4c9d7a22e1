// SPDX-License-Identifier: MIT
// Checkpoints of loops: finished tiles are read instead of run, damaged ones run again, and folders
// of other bakes are refused by the name of the setting that differs.
#include "test_support.h"

#include "base/file.h"
#include "base/tasks.h"
#include "base/tiles/checkpoint.h"
#include "test_obj.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { ITEMS = 100, GRAIN = 8, TILES = 13, LOOPS = 3 };

TEST_CONTEXT(2);
static char folder[512];

/// A process that runs LOOPS loops, and fails at an item.
typedef struct process {
    alpi_checkpoint_options options;
    uint32_t stop;   // item of all loops that fails; UINT32_MAX: none
    double pause;    // seconds of an item
    uint32_t cached; // a loop that fills a cache; UINT32_MAX: none
    uint32_t loop;   // that runs
    bool chose;      // other loops, by a choice that it notes
    atomic_uint ran; // items
    bool resumed;
    uint32_t values[LOOPS][ITEMS];
} process;

static process start(const char *name, const char *settings)
{
    return (process){.options = {.folder = folder,
                                 .name = name,
                                 .settings = settings,
                                 .restart = "words",
                                 .every = 1000.0},
                     .stop = UINT32_MAX,
                     .cached = UINT32_MAX};
}

static alp_result fill(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    process *p = user;
    (void)worker;
    for (uint32_t i = begin; i < end; i++) {
        if (p->loop * ITEMS + i >= p->stop) {
            return ALP_ERROR_CANCELLED;
        }
        if (p->pause > 0.0) {
            nanosleep(&(struct timespec){.tv_nsec = (long)(1e9 * p->pause)}, NULL);
        }
        p->values[p->loop][i] = 1000 * p->loop + i;
        atomic_fetch_add(&p->ran, 1);
    }
    return ALP_OK;
}

static alp_result run_loops(process *p)
{
    for (p->loop = 0; p->loop < LOOPS; p->loop++) {
        const alpi_tile_output output = {
            .data = p->values[p->loop], .size = sizeof(uint32_t), .count = ITEMS};
        const alpi_tile_loop loop = {.name = "fill",
                                     .count = ITEMS,
                                     .grain = GRAIN,
                                     .body = fill,
                                     .user = p,
                                     .outputs = &output,
                                     .output_count = 1,
                                     .fills_cache = p->loop == p->cached};
        ALP_TRY(alpi_tile_loop_run(context, &loop));
    }
    return ALP_OK;
}

/// Opens the checkpoint, runs the loops, closes it. A bake that is done checks all values.
static alp_result run(process *p)
{
    alpi_tiles *tiles = alpi_context_tiles(context);
    const alpi_checkpoint_options *o = &p->options;
    *tiles = (alpi_tiles){.shard = o->shard,
                          .shards = o->shards,
                          .merging = o->merging,
                          .kind = o->shards > 0 ? ALPI_TILES_SPLIT : ALPI_TILES_WHOLE};
    bool missing[8] = {false};
    tiles->missing = missing;
    ALP_TRY(alpi_checkpoint_open(context, o, &tiles->checkpoint));
    p->resumed = alpi_checkpoint_resumes(tiles->checkpoint);
    if (p->chose) {
        alpi_tiles_note_choice(context, true);
    }
    const alp_result result = run_loops(p);
    alpi_checkpoint_close(tiles->checkpoint, result == ALP_OK);
    *tiles = (alpi_tiles){.checkpoint = NULL};
    for (uint32_t i = 0; i < LOOPS * ITEMS && result == ALP_OK; i++) {
        const bool others =
            o->shards > 0 && !o->merging && i % ITEMS / GRAIN % o->shards != o->shard;
        const uint32_t expected = 1000 * (i / ITEMS) + i % ITEMS;
        assert_int_equal(p->values[i / ITEMS][i % ITEMS], others ? 0 : expected);
    }
    return result;
}

static void new_folder(void)
{
    snprintf(folder, sizeof folder, "%s/checkpoint", test_folder());
    test_log_clear();
}

static bool has_file(const char *name)
{
    return access(test_path(folder, name), F_OK) == 0;
}

/// Stops a bake of these settings in the middle of a loop. @return items that it ran
static uint32_t stop_in_loop(const char *settings, uint32_t loop)
{
    process p = start("bake", settings);
    p.stop = loop * ITEMS + ITEMS / 2;
    assert_int_equal(run(&p), ALP_ERROR_CANCELLED);
    assert_false(p.resumed);
    return p.ran;
}

static uint32_t stop_bake(const char *settings)
{
    return stop_in_loop(settings, 1);
}

TEST(finished_tiles_are_read)
{
    new_folder();
    const uint32_t before = stop_bake("a 1\n");
    process p = start("bake", "a 1\n");
    ASSERT_OK(context, run(&p));
    assert_true(p.resumed);
    assert_true(test_log_has("resumed"));
    assert_true(before >= ITEMS);
    assert_true(p.ran + before <= LOOPS * ITEMS + 2 * GRAIN); // but tiles that were in the work
    assert_true(p.ran <= 2 * ITEMS);
    assert_false(has_file("bake.tiles") || has_file("bake.state.old") ||
                 has_file("bake.state.new"));
    assert_true(has_file("bake.state"));
}

/// A process that chose other loops reads no tiles, whose numbers may be those of other loops.
TEST(tiles_of_another_choice_run_again)
{
    new_folder();
    (void)stop_bake("a 1\n");
    process p = start("bake", "a 1\n");
    p.chose = true;
    ASSERT_OK(context, run(&p));
    assert_true(p.resumed);
    assert_int_equal(p.ran, LOOPS * ITEMS);
}

/// Loops that fill a cache run again; the others are read: here the first loop and a part of the
/// last run.
TEST(caches_are_filled_again)
{
    new_folder();
    (void)stop_in_loop("a 1\n", 2);
    process p = start("bake", "a 1\n");
    p.cached = 0;
    ASSERT_OK(context, run(&p));
    assert_true(p.ran > ITEMS && p.ran <= 2 * ITEMS);
}

TEST(other_settings_are_named)
{
    static const struct {
        const char *settings, *message;
    } cases[] = {{"a 2\nb x y\n", "a was 1 and is 2;"},
                 {"a 1\nb x z\n", "b was x y and is x z;"},
                 {"a 1\n", "b was x y and is none;"},
                 {"a 1\nb x y\nc 3\n", "c was none and is 3;"},
                 {"a 10\nb x\n", "a was 1 and is 10; b was x y and is x;"},
                 {"aa 1\nb x y\n", "aa was none and is 1; a was 1 and is none;"}};
    new_folder();
    (void)stop_bake("a 1\nb x y\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        process p = start("bake", cases[i].settings);
        assert_int_equal(run(&p), ALP_ERROR_INVALID_ARGUMENT);
        const char *message = alp_context_message(context);
        if (strstr(message, cases[i].message) == NULL || strstr(message, folder) == NULL) {
            fail_msg("%s: %s", cases[i].message, message);
        }
    }
    process p = start("bake", "a 1\nb x y\n"); // and the tiles are still there
    ASSERT_OK(context, run(&p));
    assert_true(p.resumed);
}

TEST(the_folder_of_a_complete_bake_is_free)
{
    new_folder();
    process p = start("bake", "a 1\n");
    ASSERT_OK(context, run(&p));
    assert_int_equal(p.ran, LOOPS * ITEMS);
    p = start("bake", "a 2\n");
    ASSERT_OK(context, run(&p));
    assert_false(p.resumed);
    assert_int_equal(p.ran, LOOPS * ITEMS);
    assert_false(test_log_has("checkpoint-damaged"));
}

/// A kill after the result was written and before its tiles were removed.
TEST(tiles_left_of_a_complete_bake)
{
    size_t size;
    new_folder();
    (void)stop_bake("a 1\n");
    unsigned char *tiles = test_read_file(test_path(folder, "bake.tiles"), &size);
    process p = start("bake", "a 1\n");
    ASSERT_OK(context, run(&p));
    test_write_file(test_path(folder, "bake.tiles"), tiles, size);
    free(tiles);
    p = start("bake", "a 2\n");
    ASSERT_OK(context, run(&p));
    assert_false(p.resumed);
    assert_int_equal(p.ran, LOOPS * ITEMS);
}

/// A bake whose log has one flipped bit or an early end: right values, and a warning.
static void go_on_from(const unsigned char *bytes, size_t size, bool warns)
{
    test_write_file(test_path(folder, "bake.tiles"), bytes, size);
    test_log_clear();
    process p = start("bake", "a 1\n");
    p.stop = LOOPS * ITEMS - 1; // the tiles stay
    assert_int_equal(run(&p), ALP_ERROR_CANCELLED);
    for (uint32_t i = 0; i < 2 * ITEMS; i++) {
        assert_int_equal(p.values[i / ITEMS][i % ITEMS], 1000 * (i / ITEMS) + i % ITEMS);
    }
    assert_int_equal(test_log_has("checkpoint-damaged"), warns);
}

TEST(damaged_logs)
{
    size_t size, state_size;
    new_folder();
    (void)stop_bake("a 1\n");
    unsigned char *bytes = test_read_file(test_path(folder, "bake.tiles"), &size);
    unsigned char *state = test_read_file(test_path(folder, "bake.state"), &state_size);
    for (size_t k = 1; k < 16; k++) {
        go_on_from(bytes, size * k / 16, true);
    }
    go_on_from(bytes, size, false);
    for (size_t i = 0; i < size; i += 11) {
        bytes[i] ^= (unsigned char)(1u << i % 8);
        go_on_from(bytes, size, true);
        bytes[i] ^= (unsigned char)(1u << i % 8);
    }
    for (size_t i = 0; i < state_size; i += 7) { // of the state: the one before it is taken
        state[i] ^= (unsigned char)(1u << i % 8);
        test_write_file(test_path(folder, "bake.state"), state, state_size);
        state[i] ^= (unsigned char)(1u << i % 8);
        go_on_from(bytes, size, true);
    }
    free(bytes);
    free(state);
}

/// Both states are damaged: the key in the log still tells bakes apart.
TEST(damaged_states)
{
    size_t size;
    new_folder();
    (void)stop_bake("a 1\n");
    unsigned char *bytes = test_read_file(test_path(folder, "bake.tiles"), &size);
    test_write_text(test_path(folder, "bake.state"), "x");
    test_write_text(test_path(folder, "bake.state.old"), "y");
    go_on_from(bytes, size, true);
    test_write_text(test_path(folder, "bake.state"), "x");
    test_write_text(test_path(folder, "bake.state.old"), "y");
    process p = start("bake", "a 2\n");
    ASSERT_OK(context, run(&p));
    assert_int_equal(p.ran, LOOPS * ITEMS);
    free(bytes);
}

/// The thread writes beside the loop: what it wrote survives a process that ends without a word.
TEST(tiles_are_written_at_intervals)
{
    size_t size = 0;
    new_folder();
    process p = start("bake", "a 1\n");
    p.options.every = 0.1;
    p.pause = 0.01;
    alpi_tiles *tiles = alpi_context_tiles(context);
    *tiles = (alpi_tiles){.kind = ALPI_TILES_WHOLE};
    ASSERT_OK(context, alpi_checkpoint_open(context, &p.options, &tiles->checkpoint));
    ASSERT_OK(context, run_loops(&p));
    unsigned char *bytes = test_read_file(test_path(folder, "bake.tiles"), &size);
    assert_true(has_file("bake.state"));
    alpi_checkpoint_close(tiles->checkpoint, false);
    *tiles = (alpi_tiles){.checkpoint = NULL};
    test_write_file(test_path(folder, "bake.tiles"), bytes, size);
    free(bytes);
    process again = start("bake", "a 1\n");
    ASSERT_OK(context, run(&again));
    assert_in_range(again.ran, 0, LOOPS * ITEMS / 2);
}

TEST(shards_and_their_merge)
{
    new_folder();
    for (uint32_t i = 0; i < 3; i++) {
        char name[16];
        snprintf(name, sizeof name, "shard-%u", i + 1);
        process p = start(name, "a 1\n");
        p.options.shard = i;
        p.options.shards = 3;
        ASSERT_OK(context, run(&p));
        assert_false(p.resumed);                             // by the tiles of others
        assert_int_equal(p.ran, LOOPS * (i == 0 ? 36 : 32)); // 5 tiles, the last of 4 items; 4
    }
    process merge = start("merge", "a 1\n");
    merge.options.shards = 3;
    merge.options.merging = true;
    ASSERT_OK(context, run(&merge));
    assert_int_equal(merge.ran, 0);
    assert_true(has_file("shard-2.tiles")); // and may be merged again
    process other = start("bake", "a 2\n"); // would remove them
    assert_int_equal(run(&other), ALP_ERROR_INVALID_ARGUMENT);
    assert_true(has_file("shard-2.tiles"));
}

TEST(tiles_of_other_ranks)
{
    new_folder();
    for (uint32_t i = 0; i < 2; i++) {
        char name[16];
        snprintf(name, sizeof name, "rank-%u", i);
        process p = start(name, "a 1\n");
        p.options.rank = i;
        p.options.ranks = 2;
        p.stop = ITEMS * (1 + i);
        assert_int_equal(run(&p), ALP_ERROR_CANCELLED);
    }
    process p = start("bake", "a 1\n"); // one process goes on from both
    ASSERT_OK(context, run(&p));
    assert_int_equal(p.ran, ITEMS);
    assert_false(has_file("rank-0.tiles") || has_file("rank-0.state") || has_file("rank-1.tiles") ||
                 has_file("rank-1.state") || has_file("rank-1.state.old"));
}

TEST(folders_that_cannot_be_used)
{
    new_folder();
    test_write_text(folder, "a file");
    process p = start("bake", "a 1\n");
    assert_int_equal(run(&p), ALP_ERROR_IO);
    assert_non_null(strstr(alp_context_message(context), folder));
    snprintf(folder, sizeof folder, "%s/a/b", test_folder());
    p = start("bake", "a 1\n");
    ASSERT_OK(context, run(&p)); // made with its parents
    assert_true(has_file("bake.state"));
}

/// Makes a temporary file of OUT, as a process leaves it that is killed while it writes.
static const char *leave_part(const char *out, pid_t writer)
{
    static char name[2][1024];
    static uint32_t next;
    char *path = name[next++ % 2];
    snprintf(path, sizeof *name, "%s.part-%ld-0", out, (long)writer);
    test_write_text(path, "half");
    return path;
}

/// A bake with a checkpoint removes what dead processes left of its outputs, also of those that
/// nobody waited for, as in containers.
TEST(parts_of_dead_processes_are_removed)
{
    new_folder();
    process p = start("bake", "a 1\n");
    ASSERT_OK(context,
              alpi_checkpoint_open(context, &p.options, &alpi_context_tiles(context)->checkpoint));
    char out[600];
    snprintf(out, sizeof out, "%s/out.txt", test_folder());
    const pid_t dead = fork();
    if (dead == 0) {
        _exit(0);
    }
    siginfo_t ended;
    assert_int_equal(waitid(P_PID, (id_t)dead, &ended, WEXITED | WNOWAIT), 0); // a zombie stays
    const char *left = leave_part(out, dead), *alive = leave_part(out, getppid());
    ASSERT_OK(context, alpi_file_write(context, out, false, "text", 4));
    assert_int_equal(access(left, F_OK), -1);
    assert_int_equal(access(alive, F_OK), 0);
    assert_int_equal(waitpid(dead, NULL, 0), dead);
    alpi_checkpoint_close(alpi_context_tiles(context)->checkpoint, true);
    *alpi_context_tiles(context) = (alpi_tiles){.checkpoint = NULL};
}
