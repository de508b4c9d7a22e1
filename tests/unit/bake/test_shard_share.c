// SPDX-License-Identifier: MIT
// The share of a shard's time that every shard repeats (alp_bake_report.shard_repeated_share).
#include "test_support.h"

#include <alpenglow/alpenglow.h>

enum { RAYS = 2048 };

/// Bakes a shard of so many; shards 0: the whole.
static alp_bake_report bake(const char *folder, uint32_t shards)
{
    alp_context *context = test_context(1);
    alp_scene *scene = NULL;
    alp_bake_report report;
    alp_bake_options o = alp_bake_options_default();
    o.atlas.size = 48;
    o.occlusion.samples = RAYS;
    o.sampling.accuracy = ALP_ADAPTIVE_OFF;
    o.checkpoint.folder = folder;
    o.checkpoint.shards = shards;
    o.checkpoint.shard = shards > 0 ? 1 : 0;
    assert_int_equal(alp_scene_load(context, "builtin:cornell", &scene), ALP_OK);
    assert_int_equal(alp_bake(scene, &o, NULL, &report), ALP_OK);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return report;
}

TEST(a_bake_repeats_nothing)
{
    const alp_bake_report report = bake(NULL, 0);
    assert_false(report.shard_done);
    assert_true(report.shard_repeated_share == 0.0);
}

TEST(many_shards_repeat_a_larger_share)
{
    const char *folder = test_folder();
    const alp_bake_report one = bake(test_path(folder, "one"), 1);
    const alp_bake_report many = bake(test_path(folder, "many"), 1000);
    assert_true(one.shard_done && many.shard_done);
    assert_true(one.shard_repeated_share > 0.0);
    assert_true(one.shard_repeated_share < many.shard_repeated_share);
    assert_true(many.shard_repeated_share <= 1.0);
}

TEST(a_resumed_shard_traces_nothing)
{
    const char *folder = test_path(test_folder(), "kept");
    const alp_bake_report first = bake(folder, 1), again = bake(folder, 1);
    assert_true(first.tiles_run > 0 && first.tiles_read == 0 && !first.resumed);
    assert_true(again.tiles_run == 0 && again.tiles_read == first.tiles_run && again.resumed);
    assert_true(again.shard_repeated_share > first.shard_repeated_share);
}
