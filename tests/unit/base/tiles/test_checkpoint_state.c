// SPDX-License-Identifier: MIT
// The state of a checkpoint: it comes back, a damaged one gives the one before, and a process that
// ends at any moment leaves one of both.
#include "test_support.h"

#include "base/tiles/checkpoint_state.h"
#include "test_obj.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

TEST_CONTEXT(1);
static char path[1024], fresh[1100], old[1100];

static void start(void)
{
    snprintf(path, sizeof path, "%s/bake.state", test_folder());
    snprintf(fresh, sizeof fresh, "%s.new", path);
    snprintf(old, sizeof old, "%s.old", path);
}

static void write_state(uint64_t done)
{
    const alpi_checkpoint_state state = {.phase = "running",
                                         .stage = "light",
                                         .done = done,
                                         .total = 900,
                                         .seconds = 12.25,
                                         .seconds_left = -1.0,
                                         .error = .0125,
                                         .tiles = 77,
                                         .written = 1700000000,
                                         .shard = 2,
                                         .count = 5,
                                         .restart = "{\"words\":[\"a b\"]}",
                                         .settings = "alpenglow 1\n--size 64\n"};
    assert_true(alpi_checkpoint_state_write(context, path, &state));
    assert_int_equal(access(fresh, F_OK), -1);
}

/// The `done` of the state that is read; −1: none.
static long read_done(bool *damaged)
{
    alpi_checkpoint_state s;
    *damaged = false;
    if (!alpi_checkpoint_state_read(context, path, &s, damaged)) {
        assert_null(s.text);
        return -1;
    }
    const long done = (long)s.done;
    assert_string_equal(s.phase, "running");
    assert_string_equal(s.stage, "light");
    assert_int_equal(s.total, 900);
    assert_true(s.seconds == 12.25 && s.seconds_left == -1.0 && s.error == .0125);
    assert_int_equal(s.tiles, 77);
    assert_int_equal(s.written, 1700000000);
    assert_int_equal(s.shard, 2);
    assert_int_equal(s.count, 5);
    assert_string_equal(s.restart, "{\"words\":[\"a b\"]}");
    assert_string_equal(s.settings, "alpenglow 1\n--size 64\n");
    alpi_checkpoint_state_clear(context, &s);
    return done;
}

TEST(a_state_comes_back)
{
    bool damaged = true;
    start();
    assert_int_equal(read_done(&damaged), -1);
    assert_false(damaged);
    write_state(1);
    assert_int_equal(read_done(&damaged), 1);
    assert_int_equal(access(old, F_OK), -1);
    write_state(2);
    assert_int_equal(read_done(&damaged), 2);
    assert_false(damaged);
    assert_int_equal(rename(old, path), 0); // the one before is kept
    assert_int_equal(read_done(&damaged), 1);
}

TEST(unknown_error_and_no_restart)
{
    alpi_checkpoint_state state = {
        .phase = "complete", .stage = "", .error = (double)NAN, .settings = ""};
    bool damaged = true;
    start();
    assert_true(alpi_checkpoint_state_write(context, path, &state));
    assert_true(alpi_checkpoint_state_read(context, path, &state, &damaged));
    assert_string_equal(state.phase, "complete");
    assert_string_equal(state.stage, "");
    assert_string_equal(state.restart, "");
    assert_string_equal(state.settings, "");
    assert_true(isnan(state.error));
    alpi_checkpoint_state_clear(context, &state);
}

/// Every truncation, and a flipped bit of every byte.
TEST(damage_gives_the_state_before)
{
    size_t size;
    bool damaged = false;
    start();
    write_state(1);
    write_state(2);
    unsigned char *bytes = test_read_file(path, &size);
    for (size_t i = 0; i < size; i++) {
        test_write_file(path, bytes, i);
        assert_int_equal(read_done(&damaged), 1);
        assert_true(damaged);
        bytes[i] ^= (unsigned char)(1u << i % 8);
        test_write_file(path, bytes, size);
        bytes[i] ^= (unsigned char)(1u << i % 8);
        assert_int_equal(read_done(&damaged), 1);
        assert_true(damaged);
    }
    test_write_text(old, "neither");
    test_write_file(path, bytes, size / 2);
    assert_int_equal(read_done(&damaged), -1);
    assert_true(damaged);
    free(bytes);
}

/// A kill leaves PATH.new before the first rename, and no PATH between the renames.
TEST(killed_between_write_and_rename)
{
    bool damaged = true;
    start();
    write_state(1);
    write_state(2);
    test_write_text(fresh, "alpenglow checkpoint 1\nphase run");
    assert_int_equal(read_done(&damaged), 2);
    assert_false(damaged);
    assert_int_equal(rename(path, old), 0);
    assert_int_equal(read_done(&damaged), 2);
    assert_false(damaged);
    write_state(3); // the next process takes the place of both
    assert_int_equal(read_done(&damaged), 3);
    assert_false(damaged);
}

/// A write that fails keeps the state and leaves no PATH.new.
TEST(a_failed_write_keeps_the_state)
{
    const alpi_checkpoint_state state = {.phase = "running", .stage = "", .settings = ""};
    bool damaged = true;
    start();
    write_state(1);
    assert_int_equal(mkdir(fresh, 0777), 0); // cannot be opened for writing
    assert_false(alpi_checkpoint_state_write(context, path, &state));
    assert_int_equal(rmdir(fresh), 0);
    assert_int_equal(read_done(&damaged), 1);
    assert_int_equal(mkdir(old, 0777), 0); // PATH cannot take its place
    assert_false(alpi_checkpoint_state_write(context, path, &state));
    assert_int_equal(access(fresh, F_OK), -1);
    assert_int_equal(read_done(&damaged), 1);
    rmdir(old);
}

TEST(each_allocation_fails)
{
    int left = 1000;
    alp_context *poor = test_context_failing(&left);
    const alpi_checkpoint_state state = {.phase = "running", .stage = "", .settings = ""};
    bool damaged = true, written = false;
    start();
    write_state(1);
    for (int i = 0; i < 100 && !written; i++) {
        left = i;
        written = alpi_checkpoint_state_write(poor, path, &state);
        assert_int_equal(access(fresh, F_OK), -1);
        if (!written) {
            assert_int_equal(read_done(&damaged), 1);
            assert_false(damaged);
        }
    }
    assert_true(written);
    alp_context_destroy(poor);
}

/// A path that is no file is no state, and does not stop the reader.
TEST(no_files)
{
    bool damaged = true;
    start();
    assert_int_equal(mkdir(path, 0777), 0);
    assert_int_equal(read_done(&damaged), -1);
    rmdir(path);
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_int_equal(read_done(&damaged), -1);
}

/// A host's locale with a comma leaves numbers as they are.
TEST(other_locales)
{
    static const char *const locales[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "sv_SE.UTF-8", "C.UTF-8"};
    bool damaged = true;
    start();
    for (size_t i = 0; i < sizeof locales / sizeof *locales; i++) {
        if (setlocale(LC_ALL, locales[i]) == NULL) {
            continue; // not installed
        }
        write_state(i);
        assert_int_equal(read_done(&damaged), i);
        setlocale(LC_ALL, "C");
        assert_int_equal(read_done(&damaged), i);
    }
}
