// SPDX-License-Identifier: MIT
// Channels with faults: each costs itself and a warning. The other channels of its animation move.
#include "pack_asset.h"
#include "test_gltf.h"

#include <math.h>
#include <stdio.h>

/// Accessors: 0 positions, 1 times {0, 1}, 2 two vectors (1, 2, 3), 3 two unit quaternions, 4
/// falling times, 5 times with NaN, 6 two vectors with an infinity, 7 two quaternions, the second
/// 0, 8 times in shorts, 9 no times, 10 sparse times {0, 2}.
static const char *write_file(const char *channels, const char *samplers)
{
    static const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static const float times[2] = {0, 1}, falling[2] = {1, 1}, two = 2;
    const float broken[2] = {0, (float)NAN};
    static const float vectors[6][3] = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3},
                                        {1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
    const float infinite[2][3] = {{1, 2, 3}, {1, (float)INFINITY, 3}};
    static const float turns[2][4] = {{0, 0, 0, 1}, {0, 0, 0, 1}}, none[2][4] = {{0, 0, 0, 1}};
    static const int16_t shorts[2] = {0, 1};
    static const uint8_t second = 1;
    char rest[2048], sparse[160];
    pack_asset *asset = pack_start();
    pack_accessor(asset, pack_view(asset, positions, sizeof positions, 0), 5126, 3, "VEC3",
                  ",'min':[0,0,0],'max':[1,1,0]");
    pack_accessor(asset, pack_view(asset, times, sizeof times, 0), 5126, 2, "SCALAR", "");
    pack_accessor(asset, pack_view(asset, vectors, sizeof vectors, 0), 5126, 2, "VEC3", "");
    pack_accessor(asset, pack_view(asset, turns, sizeof turns, 0), 5126, 2, "VEC4", "");
    pack_accessor(asset, pack_view(asset, falling, sizeof falling, 0), 5126, 2, "SCALAR", "");
    pack_accessor(asset, pack_view(asset, broken, sizeof broken, 0), 5126, 2, "SCALAR", "");
    pack_accessor(asset, pack_view(asset, infinite, sizeof infinite, 0), 5126, 2, "VEC3", "");
    pack_accessor(asset, pack_view(asset, none, sizeof none, 0), 5126, 2, "VEC4", "");
    pack_accessor(asset, pack_view(asset, shorts, sizeof shorts, 0), 5122, 2, "SCALAR", "");
    pack_accessor(asset, -1, 5126, 0, "SCALAR", "");
    const int index = pack_view(asset, &second, sizeof second, 0);
    const int value = pack_view(asset, &two, sizeof two, 0);
    snprintf(sparse, sizeof sparse,
             ",'sparse':{'count':1,'indices':{'bufferView':%d,'componentType':5121},'values':{"
             "'bufferView':%d}}",
             index, value);
    pack_accessor(asset, -1, 5126, 2, "SCALAR", sparse);
    snprintf(rest, sizeof rest,
             "'scene':0,'scenes':[{'nodes':[0,1]}],'nodes':[{'mesh':0},{'matrix':[1,0,0,0,0,1,0,0,"
             "0,0,1,0,0,0,0,1]}],"
             "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
             "'animations':[{'channels':%s,'samplers':%s}]",
             channels, samplers);
    return pack_write(asset, rest);
}

/// The scene of an animation, and its triangle one second later.
static void check(alp_context *context, const char *path, uint32_t channels, double seconds,
                  const double place[3])
{
    alp_scene *scene = NULL, *posed = NULL;
    ASSERT_OK(context, alp_scene_load(context, path, &scene));
    const alp_animation_info a = alp_scene_get_animation(scene, 0);
    assert_int_equal(a.channels, channels);
    ASSERT_NEAR(a.seconds, seconds, 0);
    ASSERT_OK(context, alp_scene_pose(scene, 0, 1, &posed));
    for (int k = 0; k < 3; k++) {
        ASSERT_NEAR(posed->positions[0][k], place[k], 1e-6);
    }
    alp_scene_destroy(posed);
    alp_scene_destroy(scene);
}

#define GOOD "{'sampler':0,'target':{'node':0,'path':'translation'}}"
#define GOOD_SAMPLER "{'input':1,'output':2}"
#define TURN(sampler) "{'sampler':" sampler ",'target':{'node':0,'path':'rotation'}}"
#define SIZE "{'sampler':1,'target':{'node':0,'path':'scale'}}"

TEST_WITH_CONTEXT(a_fault_costs_its_channel, 1)
{
    static const struct {
        const char *channel, *sampler, *words;
    } cases[] = {
        {TURN("1"), "{'input':1,'output':2}", "its values are not numbers of floats or normalised"},
        {SIZE, "{'input':1,'output':3}", "its values are not VEC3 of floats"},
        {TURN("1"), "{'input':1,'output':3,'interpolation':'CUBICSPLINE'}",
         "it has 2 values for 2 keys"},
        {TURN("1"), "{'input':4,'output':3}", "key 1: its time is not after the one before"},
        {TURN("1"), "{'input':5,'output':3}", "key 1: its time is not finite"},
        {SIZE, "{'input':1,'output':6}", "key 1: its value is not finite"},
        {TURN("1"), "{'input':1,'output':7}", "key 1: its rotation is not a quaternion"},
        {TURN("1"), "{'input':8,'output':3}", "its times are not scalars of floats"},
        {TURN("1"), "{'input':3,'output':3}", "its times are not scalars of floats"},
        {TURN("1"), "{'input':9,'output':3}", "its times are not scalars of floats"},
        {TURN("1"), "{'input':0,'output':99}", "output is 99, but there are only 11 accessors"},
        {TURN("1"), "{'output':3}", "input is missing"},
        {TURN("1"), "{'input':1,'output':3,'interpolation':'CUBIC'}", "its interpolation is none"},
        {TURN("1"), "{'input':1,'output':3,'interpolation':7}", "its interpolation is none"},
        {TURN("1"), "7", "there is no sampler 1"},
        {TURN("9"), "{}", "there is no sampler 9"},
        {TURN("-1"), "{}", "sampler must be a non-negative integer"},
        {"{'sampler':1,'target':{'node':9,'path':'rotation'}}", "{'input':1,'output':3}",
         "node is 9, but there are only 2 nodes"},
        {"{'sampler':1,'target':{'node':1,'path':'rotation'}}", "{'input':1,'output':3}",
         "node 1 has a matrix"},
        {"{'sampler':1,'target':{'node':0,'path':'weights'}}", "{'input':1,'output':1}",
         "it has 2 values for 2 keys of 0 numbers"},
        {"{'sampler':0,'target':{'node':0,'path':'translation'}}", "{}",
         "a channel before it moves the same of node 0"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char channels[512], samplers[512];
        snprintf(channels, sizeof channels, "[" GOOD ",%s]", cases[i].channel);
        snprintf(samplers, sizeof samplers, "[" GOOD_SAMPLER ",%s]", cases[i].sampler);
        test_log_clear();
        check(context, write_file(channels, samplers), 1, 1, (const double[3]){1, 2, 3});
        assert_int_equal(test_log_has("animation"), 1); // once: the pose says nothing
        if (strstr(test_log_text(), cases[i].words) == NULL) {
            fail_msg("case %zu: \"%s\" is not in \"%s\"", i, cases[i].words, test_log_text());
        }
    }
}

/// Targets of extensions stay in the file: only a pose loses them, with one warning.
TEST_WITH_CONTEXT(channels_that_move_no_node, 1)
{
    const char *path = write_file("[" GOOD ",{'sampler':0,'target':{'path':'pointer'}},"
                                  "{'sampler':0,'target':{'node':0,'path':'colour'}},"
                                  "{'sampler':0}]",
                                  "[" GOOD_SAMPLER "]");
    alp_scene *scene = NULL;
    test_log_clear();
    ASSERT_OK(context, alp_scene_load(context, path, &scene));
    assert_false(test_log_has("animation"));
    alp_scene_destroy(scene);
    check(context, path, 1, 1, (const double[3]){1, 2, 3});
    assert_int_equal(test_log_has("animation"), 1);
    assert_non_null(strstr(test_log_text(), "neither transforms nor morph targets: 3"));
}

TEST_WITH_CONTEXT(animations_without_anything, 1)
{
    static const char *const channels[] = {"[]", "7", "[7]", "{}"};
    for (size_t i = 0; i < sizeof channels / sizeof *channels; i++) {
        check(context, write_file(channels[i], "[]"), 0, 0, (const double[3]){0, 0, 0});
    }
}

TEST_WITH_CONTEXT(sparse_times, 1)
{
    // Twice as long: the constant translation is the same, and the last key is at 2 s.
    check(context, write_file("[" GOOD "]", "[{'input':10,'output':2}]"), 1, 2,
          (const double[3]){1, 2, 3});
}

/// Very many channels that share one large accessor are left out beyond a limit.
TEST_WITH_CONTEXT(channels_that_multiply_an_accessor, 1)
{
    static char json[1 << 16];
    size_t used = (size_t)snprintf(
        json, sizeof json,
        "{'asset':{'version':'2.0'},'nodes':[{}],'accessors':[{'componentType':5126,'count':"
        "16777216,'type':'SCALAR'},{'componentType':5126,'count':16777216,'type':'VEC3'}],"
        "'animations':[");
    for (int i = 0; i < 300; i++) {
        used += (size_t)snprintf(json + used, sizeof json - used,
                                 "%s{'channels':[{'sampler':0,'target':{'node':0,'path':'scale'}}],"
                                 "'samplers':[{'input':0,'output':1}]}",
                                 i > 0 ? "," : "");
    }
    snprintf(json + used, sizeof json - used, "]}");
    alp_scene *scene = NULL;
    test_log_clear();
    ASSERT_OK(context, test_gltf_scene(context, json, NULL, 0, &scene));
    assert_non_null(strstr(test_log_text(), "the animations have more than 268435456 numbers"));
    assert_int_equal(alp_scene_get_info(scene).animations, 300);
    alp_scene_destroy(scene);
}
