// SPDX-License-Identifier: MIT
// A caller reads a folder of checkpoints: shards that are missing, and killed processes.
#include "test_support.h"

#include "base/tiles/checkpoint_state.h"
#include "test_obj.h"

#include <alpenglow/alpenglow.h>

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

TEST_CONTEXT(1);
static char folder[512];

static void write_state(uint32_t shard, uint32_t count, const char *phase)
{
    char path[600];
    const alpi_checkpoint_state state = {.phase = phase,
                                         .stage = "light",
                                         .shard = shard,
                                         .count = count,
                                         .restart = "",
                                         .settings = "alpenglow 1\n"};
    snprintf(path, sizeof path, "%s/shard-%u.state", folder, shard + 1);
    assert_true(alpi_checkpoint_state_write(context, path, &state));
}

static void new_folder(void)
{
    snprintf(folder, sizeof folder, "%s", test_folder());
}

static void assert_missing(size_t room, const char *wanted)
{
    char text[900];
    alp_checkpoint_info *info;
    memset(text, '#', sizeof text);
    ASSERT_OK(context, alp_checkpoint_read(context, folder, &info));
    alp_checkpoint_missing(info, text, room);
    alp_checkpoint_info_destroy(info);
    assert_int_equal(text[room], '#');
    if (room > 0) {
        assert_string_equal(text, wanted);
    }
}

TEST(missing_shards)
{
    new_folder();
    write_state(2, 9, "complete");
    assert_missing(100, "1-2,4-9");
    write_state(4, 9, "stopped");
    assert_missing(100, "1-2,4-9");
    write_state(7, 9, "complete");
    assert_missing(100, "1-2,4-7,9");
    for (uint32_t i = 0; i < 9; i++) {
        write_state(i, 9, "complete");
    }
    assert_missing(100, "");
}

/// A long list ends after a whole entry.
TEST(long_lists)
{
    new_folder();
    for (uint32_t i = 1; i < 41; i += 2) {
        write_state(i, 41, "complete");
    }
    assert_missing(0, "");
    assert_missing(1, "");
    assert_missing(7, "1, ...");
    assert_missing(8, "1, ...");
    assert_missing(9, "1,3, ...");
    assert_missing(16, "1,3,5,7,9, ...");
    assert_missing(17, "1,3,5,7,9, ...");
    assert_missing(18, "1,3,5,7,9,11, ...");
}

static const char *phase_of_first(void)
{
    static char phase[32];
    uint32_t count;
    alp_checkpoint_info *info;
    ASSERT_OK(context, alp_checkpoint_read(context, folder, &info));
    snprintf(phase, sizeof phase, "%s", alp_checkpoint_processes(info, &count)->phase);
    alp_checkpoint_info_destroy(info);
    return phase;
}

/// A process that runs holds the lock of its tiles.
TEST(killed_processes)
{
    new_folder();
    write_state(0, 2, "running");
    assert_string_equal(phase_of_first(), "running"); // no tiles, so nothing is known
    const int file = open(test_path(folder, "shard-1.tiles"), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    assert_string_equal(phase_of_first(), "killed");
    assert_int_equal(flock(file, LOCK_EX), 0);
    assert_string_equal(phase_of_first(), "running");
    close(file);
    assert_string_equal(phase_of_first(), "killed");
    write_state(0, 2, "stopped");
    assert_string_equal(phase_of_first(), "stopped");
}
