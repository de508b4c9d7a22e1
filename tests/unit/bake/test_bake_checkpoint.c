// SPDX-License-Identifier: MIT
// Bakes of every kind that are stopped at several moments and run again: the files have the bits of
// an undisturbed bake. Damaged checkpoints and full disks change no bit either.
#include "test_support.h"

#include "checkpointed_bake.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#define LIGHT_MAPS (ALP_MAP_LIGHT | ALP_MAP_SH | ALP_MAP_DIRECTION)

static const checkpointed_kind kinds[] = {
    {.name = "occlusion", .maps = ALP_MAP_AO | ALP_MAP_BENT},
    {.name = "occlusion with an error",
     .maps = ALP_MAP_AO,
     .accuracy = ALP_ADAPTIVE_AUTO,
     .error = .01f},
    {.name = "obscurance", .maps = ALP_MAP_AO | ALP_MAP_OBSCURANCE},
    {.name = "objects alone", .maps = ALP_MAP_AO | ALP_MAP_BENT, .ao_self = true},
    {.name = "light", .maps = ALP_MAP_AO | ALP_MAP_LIGHT, .bounces = 2},
    {.name = "light with an error",
     .maps = LIGHT_MAPS,
     .accuracy = ALP_ADAPTIVE_AUTO,
     .error = .4f,
     .bounces = ALP_BOUNCES_CONVERGE},
    {.name = "layers", .maps = LIGHT_MAPS, .layers = true, .error = .5f, .bounces = 2, .lamps = 2},
    {.name = "direct light apart",
     .maps = ALP_MAP_LIGHT,
     .direct = ALP_DIRECT_APART,
     .bounces = 2,
     .lamps = 1},
    {.name = "direct light alone", .maps = LIGHT_MAPS, .lamps = 20},
    {.name = "denoised",
     .scene = "builtin:sphere-plane",
     .maps = ALP_MAP_LIGHT,
     .denoise = true,
     .bounces = 2},
    {.name = "probes", .maps = ALP_MAP_LIGHT | ALP_MAP_PROBES, .bounces = 1},
    {.name = "sides and panes",
     .scene = CHECKPOINTED_PANES,
     .maps = LIGHT_MAPS,
     .error = .5f,
     .bounces = 2,
     .lamps = 1},
    {.name = "hemicubes", .maps = LIGHT_MAPS, .gather = ALP_GATHER_HEMICUBE, .bounces = 2},
    {.name = "paths", .maps = ALP_MAP_LIGHT, .gather = ALP_GATHER_PATHS, .bounces = 2},
    {.name = "one object", .maps = ALP_MAP_AO | ALP_MAP_LIGHT, .only = "*tall*", .bounces = 1},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

/// Stops a bake after a part of its ranges, runs it again and compares.
/// @return the share of tiles that it did not run again
static double stop_and_go_on(const checkpointed_kind *kind, uint64_t files, uint32_t stop_after)
{
    char folder[512];
    snprintf(folder, sizeof folder, "%s", test_folder());
    checkpointed_bake bake = {.kind = kind, .workers = 1, .folder = folder, .every = 1000.0};
    bake.stop_after = stop_after;
    assert_int_equal(checkpointed_run(&bake), ALP_ERROR_CANCELLED);
    bake.stop_after = 0;
    bake.workers = 2;
    assert_int_equal(checkpointed_run(&bake), ALP_OK);
    if (bake.files != files) {
        fail_msg("%s: stopped after %u ranges, it has other bits", kind->name, stop_after);
    }
    assert_int_equal(bake.report.resumed, bake.report.tiles_read > 0);
    return (double)bake.report.tiles_read /
           (double)(bake.report.tiles_read + bake.report.tiles_run);
}

TEST(stopped_bakes_have_the_same_bits)
{
    static const double parts[] = {.03, .3, .6, .9};
    for (int k = 0; k < KINDS; k++) {
        checkpointed_bake whole = {.kind = &kinds[k], .workers = 1};
        assert_int_equal(checkpointed_run(&whole), ALP_OK);
        double read = 0.0;
        for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
            const double ranges = parts[i] * (whole.ranges - whole.first);
            read = stop_and_go_on(&kinds[k], whole.files, whole.first + (uint32_t)ranges);
        }
        print_message("%s: %u ranges, %.2f of the tiles read\n", kinds[k].name,
                      whole.ranges - whole.first, read);
        assert_true(read > .3);
    }
}

/// Goes on with less memory, so that other rays are kept, and other loops run.
/// @return whether the memory was enough
static bool go_on_with(const checkpointed_kind *kind, uint64_t files, uint32_t stop_after,
                       uint64_t budget)
{
    char folder[512];
    snprintf(folder, sizeof folder, "%s", test_folder());
    checkpointed_bake bake = {.kind = kind, .workers = 1, .folder = folder, .every = 1000.0};
    bake.stop_after = stop_after;
    assert_int_equal(checkpointed_run(&bake), ALP_ERROR_CANCELLED);
    bake.stop_after = 0;
    bake.budget = budget;
    const alp_result result = checkpointed_run(&bake);
    if (result == ALP_OK && bake.files != files) {
        fail_msg("%s: after %u ranges, %llu bytes change bits", kind->name, stop_after,
                 (unsigned long long)budget);
    }
    assert_true(result == ALP_OK || result == ALP_ERROR_LIMIT);
    return result == ALP_OK;
}

TEST(machines_with_less_memory_go_on)
{
    uint32_t baked = 0;
    for (int k = 0; k < KINDS; k++) {
        checkpointed_bake whole = {.kind = &kinds[k], .workers = 1};
        if ((kinds[k].maps & ALP_MAP_LIGHT) == 0 || kinds[k].bounces == 0) {
            continue;
        }
        assert_int_equal(checkpointed_run(&whole), ALP_OK);
        for (uint64_t budget = 1 << 20; budget < 1 << 24; budget *= 2) {
            const uint32_t ranges = whole.ranges - whole.first;
            baked += go_on_with(&kinds[k], whole.files, whole.first + ranges * 9 / 10, budget);
        }
    }
    print_message("%u baked\n", baked);
    assert_true(baked > 20);
}

/// Between and within the passes, whose first fills the kept rays.
TEST(stopped_in_each_pass)
{
    enum { STOPS = 24 };
    static const checkpointed_kind passes = {.name = "passes", .maps = ALP_MAP_LIGHT, .bounces = 6};
    checkpointed_bake whole = {.kind = &passes, .workers = 1};
    assert_int_equal(checkpointed_run(&whole), ALP_OK);
    for (uint32_t i = 0; i < STOPS; i++) {
        (void)stop_and_go_on(&passes, whole.files,
                             whole.first + (whole.ranges - whole.first) * (i + 1) / (STOPS + 1));
    }
}
