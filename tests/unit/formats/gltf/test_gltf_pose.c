// SPDX-License-Identifier: MIT
// Skins and morph targets at rest, and which of several scenes is read.
#include "pack_asset.h"
#include "test_gltf.h"

#include "formats/formats.h"

#include <math.h>
#include <stdio.h>

/// Vertices of one triangle: the first follows joint 0, the second joint 1, the third both.
/// Accessors: 0 POSITION, 1 NORMAL, 2 JOINTS_0, 3 WEIGHTS_0, 4 inverse bind matrices, 5 and 6 a
/// target's POSITION and NORMAL.
static const char *write_figure(const char *rest)
{
    static const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static const float normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    static const uint8_t joints[3][4] = {{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}};
    static const float weights[3][4] = {{1, 0, 0, 0}, {1, 0, 0, 0}, {0.25f, 0.75f, 0, 0}};
    static const float bind[2][16] = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}};
    static const float moved[3][3] = {{0, 0, 2}, {0, 0, 2}, {0, 0, 2}};
    static const float turned[3][3] = {{1, 0, -1}, {1, 0, -1}, {1, 0, -1}};
    pack_asset *asset = pack_start();
    pack_accessor(asset, pack_view(asset, positions, sizeof positions, 0), 5126, 3, "VEC3",
                  ",'min':[0,0,0],'max':[1,1,0]");
    pack_accessor(asset, pack_view(asset, normals, sizeof normals, 0), 5126, 3, "VEC3", "");
    pack_accessor(asset, pack_view(asset, joints, sizeof joints, 0), 5121, 3, "VEC4", "");
    pack_accessor(asset, pack_view(asset, weights, sizeof weights, 0), 5126, 3, "VEC4", "");
    pack_accessor(asset, pack_view(asset, bind, sizeof bind, 0), 5126, 2, "MAT4", "");
    pack_accessor(asset, pack_view(asset, moved, sizeof moved, 0), 5126, 3, "VEC3",
                  ",'min':[0,0,2],'max':[0,0,2]");
    pack_accessor(asset, pack_view(asset, turned, sizeof turned, 0), 5126, 3, "VEC3", "");
    return pack_write(asset, rest);
}

#define SKINNED "'attributes':{'POSITION':0,'NORMAL':1,'JOINTS_0':2,'WEIGHTS_0':3}"
/// Joint 1 stands at x = 1 where it was bound, moved up by 3 and turned by 90° about z.
#define JOINTS                                                                                     \
    "{'name':'root','translation':[0,0,5]},{'translation':[1,3,0],"                                \
    "'rotation':[0,0,0.70710678118654752,0.70710678118654752]}"

static void assert_at(const alp_scene *scene, uint32_t vertex, double x, double y, double z)
{
    ASSERT_NEAR(scene->positions[vertex][0], x, 1e-6);
    ASSERT_NEAR(scene->positions[vertex][1], y, 1e-6);
    ASSERT_NEAR(scene->positions[vertex][2], z, 1e-6);
}

/// The node of a skinned mesh places nothing: its joints do.
TEST_WITH_CONTEXT(skin_at_rest, 1)
{
    alp_scene *scene = NULL;
    const char *path = write_figure(
        "'scene':0,'scenes':[{'nodes':[0,1,2]}],'nodes':[{'mesh':0,'skin':0,'translation':"
        "[50,0,0]}," JOINTS "],'skins':[{'joints':[1,2],'inverseBindMatrices':4}],"
        "'meshes':[{'primitives':[{" SKINNED "}]}]");
    test_log_clear();
    ASSERT_OK(context, alp_scene_load(context, path, &scene));
    assert_true(test_log_has("skin"));
    assert_at(scene, 0, 0, 0, 5);
    assert_at(scene, 1, 1, 3, 0); // at joint 1
    // The third: by joint 0 (0, 1, 5); by joint 1 (−1, 1, 0) from it, turned (−1, −1): (0, 2, 0).
    assert_at(scene, 2, 0, 0.25 * 1 + 0.75 * 2, 0.25 * 5);
    ASSERT_NEAR(scene->normals[1][2], 1.0, 1e-6);
    alp_scene_destroy(scene);
    alp_scene_destroy(pack_patch(context, path, ".glb", 0.0));
}

TEST_WITH_CONTEXT(skins_that_do_not_hold, 1)
{
    static const struct {
        const char *scene, *skin, *words; // words NULL: a warning, and the node places the mesh
    } cases[] = {
        {"0", "{'joints':[1,2]}", NULL}, // joints outside the scene
        {"0,1,2", "{'joints':[]}", NULL},
        {"0,1,2", "{'joints':[1,99]}", NULL}, // one that is not there
        {"0,1,2", "{'joints':[1]}", "vertex 1 names a joint that its skin does not have"},
        {"0,1,2", "{'joints':[1,2],'inverseBindMatrices':0}", "where 2 MAT4 of floats are needed"},
        {"0,1,2", "{'joints':[1,2,1],'inverseBindMatrices':4}", "where 3 MAT4 of floats"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char rest[1024];
        alp_scene *scene = NULL;
        snprintf(
            rest, sizeof rest,
            "'scenes':[{'nodes':[%s]}],'nodes':[{'mesh':0,'skin':0,'translation':[50,0,0]}," JOINTS
            "],'skins':[%s],'meshes':[{'primitives':[{" SKINNED "}]}]",
            cases[i].scene, cases[i].skin);
        alp_result result = alp_scene_load(context, write_figure(rest), &scene);
        if (cases[i].words == NULL) {
            assert_int_equal(result, ALP_OK);
            assert_at(scene, 1, 51, 0, 0);
            alp_scene_destroy(scene);
        } else {
            assert_int_equal(result, ALP_ERROR_INVALID_DATA);
            test_message_has(context, cases[i].words);
        }
    }
}

/// Two sets of influences; weights that do not sum to 1, none at all, and a negative one.
TEST_WITH_CONTEXT(weights_of_all_kinds, 1)
{
    static const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static const uint8_t joints[2][3][4] = {{{0}, {0}, {0, 1, 0, 0}}, {{1}, {1}, {0}}};
    static const float weights[2][3][4] = {{{0.5f}, {0}, {0.5f, -1, 0, 0}}, {{0.5f}, {0}, {0}}};
    static const float bind[2][16] = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}};
    pack_asset *asset = pack_start();
    pack_accessor(asset, pack_view(asset, positions, sizeof positions, 0), 5126, 3, "VEC3",
                  ",'min':[0,0,0],'max':[1,1,0]");
    for (int set = 0; set < 2; set++) {
        pack_accessor(asset, pack_view(asset, joints[set], sizeof *joints, 0), 5121, 3, "VEC4", "");
        pack_accessor(asset, pack_view(asset, weights[set], sizeof *weights, 0), 5126, 3, "VEC4",
                      "");
    }
    pack_accessor(asset, pack_view(asset, bind, sizeof bind, 0), 5126, 2, "MAT4", "");
    alp_scene *scene = NULL;
    ASSERT_OK(context,
              alp_scene_load(
                  context,
                  pack_write(asset, "'scenes':[{'nodes':[0,1,2]}],'nodes':[{'mesh':0,'skin':0,"
                                    "'translation':[50,0,0]}," JOINTS
                                    "],'skins':[{'joints':[1,2],'inverseBindMatrices':5}],'meshes':"
                                    "[{'primitives':[{'attributes':{'POSITION':0,'JOINTS_0':1,"
                                    "'WEIGHTS_0':2,'JOINTS_1':3,'WEIGHTS_1':4}}]}]"),
                  &scene));
    // Joint 0 leads to (0, 0, 5), joint 1 to (−1, 0, 0) turned and moved: (1, 2, 0).
    assert_at(scene, 0, 0.5, 1.0, 2.5);
    assert_at(scene, 1, 51, 0, 0); // nothing moves it: its node
    assert_at(scene, 2, 0, 1, 5);  // of joint 0 alone
    alp_scene_destroy(scene);
}

/// Default weights of the mesh, and of a node, which come first.
TEST_WITH_CONTEXT(morph_targets, 1)
{
    static const struct {
        const char *node, *mesh;
        double weight;
    } cases[] = {
        {"", "", 0.0}, {"", ",'weights':[0.5]", 0.5}, {",'weights':[1]", ",'weights':[0.5]", 1.0}};
    for (size_t i = 0; i < 3; i++) {
        char rest[1024];
        alp_scene *scene = NULL;
        snprintf(rest, sizeof rest,
                 "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,'translation':[0,0,10]%s}],"
                 "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1},'targets':[{"
                 "'POSITION':5,'NORMAL':6}]}]%s}]",
                 cases[i].node, cases[i].mesh);
        const char *path = write_figure(rest);
        test_log_clear();
        ASSERT_OK(context, alp_scene_load(context, path, &scene));
        assert_true(test_log_has("morph"));
        assert_at(scene, 1, 1, 0, 10 + 2 * cases[i].weight);
        const double z = 1.0 - cases[i].weight, length = hypot(cases[i].weight, z);
        ASSERT_NEAR(scene->normals[0][0], cases[i].weight / length, 1e-6);
        ASSERT_NEAR(scene->normals[0][2], z / length, 1e-6);
        alp_scene_destroy(scene);
        alp_scene_destroy(pack_patch(context, path, ".glb", 0.0));
    }
}

TEST_WITH_CONTEXT(choice_of_a_scene, 1)
{
    static const struct {
        const char *choice;
        double x; // −1: refused
    } cases[] = {{NULL, 20}, {"0", 10},   {"1", 20},  {"bath", 30}, {"2", 30},
                 {"3", -1},  {"kit", -1}, {"-1", -1}, {"", -1}};
    char path[1024];
    snprintf(path, sizeof path, "%s",
             write_figure("'scene':1,'scenes':[{'name':'kitchen','nodes':[0]},{'nodes':[1]},"
                          "{'name':'bath','nodes':[2]}],'nodes':[{'mesh':0,'translation':[10,0,0]},"
                          "{'mesh':0,'translation':[20,0,0]},{'mesh':0,'translation':[30,0,0]}],"
                          "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1}}]}]"));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = NULL;
        test_log_clear();
        alp_result result = alp_scene_load_choice(context, path, cases[i].choice, &scene);
        if (cases[i].x < 0) {
            assert_int_equal(result, ALP_ERROR_INVALID_ARGUMENT);
            test_message_has(context,
                             "its scenes are numbered 0 to 2: 0 \"kitchen\", 1, 2 \"bath\"");
            continue;
        }
        assert_int_equal(result, ALP_OK);
        assert_int_equal(scene->surface_count, 1);
        assert_at(scene, 0, cases[i].x, 0, 0);
        assert_int_equal(test_log_has("scenes"), cases[i].choice == NULL);
        alp_scene_destroy(scene);
    }
    alp_scene *scene = NULL;
    assert_int_equal(alp_scene_load_choice(context, "builtin:cornell", "0", &scene),
                     ALP_ERROR_INVALID_ARGUMENT);
    test_message_has(context, "builtin:cornell: has one scene");
}
