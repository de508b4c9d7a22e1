// SPDX-License-Identifier: MIT
// Surfaces by name, and which of them are one mesh placed several times.
#include "test_gltf.h"

#include "base/memory.h"
#include "scene/select.h"

static const float CORNERS[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}};
static const uint32_t TRIANGLES[2][3] = {{0, 1, 2}, {0, 2, 3}};

static alp_scene *named_squares(alp_context *context, const char *const *names, uint32_t count)
{
    alp_mesh meshes[16];
    assert_true(count <= 16);
    for (uint32_t i = 0; i < count; i++) {
        meshes[i] = (alp_mesh){.name = names[i],
                               .vertex_count = 4,
                               .positions = CORNERS[0],
                               .triangle_count = 2,
                               .indices = TRIANGLES[0]};
    }
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, count, &scene));
    return scene;
}

/// Selects and gives the surfaces as a word of 0 and 1, or "refused".
static const char *selected(const alp_scene *scene, const char *pattern)
{
    static char word[32];
    bool *surfaces = NULL;
    alp_result result = alpi_scene_select(scene, pattern, &surfaces);
    if (result == ALP_ERROR_INVALID_ARGUMENT) {
        assert_null(surfaces);
        return "refused";
    }
    ASSERT_OK(scene->context, result);
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        word[s] = surfaces[s] ? '1' : '0';
    }
    word[scene->surface_count] = '\0';
    alpi_release(scene->context, surfaces);
    return word;
}

TEST_WITH_CONTEXT(patterns_select_by_name, 1)
{
    static const char *const names[] = {"floor", "chair.001", "Stühle, rot", "chair.002", ""};
    alp_scene *scene = named_squares(context, names, 5);
    assert_string_equal(selected(scene, "floor"), "10000");
    assert_string_equal(selected(scene, "chair.*"), "01010");
    assert_string_equal(selected(scene, "floor,chair.002"), "10010");
    assert_string_equal(selected(scene, "St?hle\\, rot"), "00100");
    assert_string_equal(selected(scene, "*"), "11111");
    assert_string_equal(selected(scene, ""), "00001"); // names that are empty
    assert_string_equal(selected(scene, "floor,"), "10001");
    bool *surfaces = (bool *)&context;
    ASSERT_OK(context, alpi_scene_select(scene, NULL, &surfaces));
    assert_null(surfaces); // all
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_pattern_without_a_match_is_refused, 1)
{
    static const char *const names[] = {"a", "b", "c", "d", "e", "f", "g", "h", "floor", "Flur"};
    alp_scene *scene = named_squares(context, names, 10);
    assert_string_equal(selected(scene, "flor"), "refused");
    test_message_has(context, "\"flor\"");
    test_message_has(context, "\"floor\", \"Flur\", \"f\", \"a\", \"b\", \"c\", \"d\", \"e\", …");
    assert_string_equal(selected(scene, "floor,x,a"), "refused"); // each of them
    test_message_has(context, "\"x\"");
    assert_string_equal(selected(scene, ""), "refused");
    assert_string_equal(selected(scene, "floor,"), "refused");
    alp_scene_destroy(scene);

    char longest[700]; // a name that no message holds
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    const char *const long_names[] = {"a", longest};
    scene = named_squares(context, long_names, 2);
    assert_string_equal(selected(scene, "b"), "refused");
    test_message_has(context, "\"a\"");
    alp_scene_destroy(scene);

    ASSERT_OK(context, alp_scene_create_from_meshes(context, NULL, 0, &scene));
    assert_string_equal(selected(scene, "*"), "refused"); // nothing is there
    test_message_has(context, "none");
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(instances_follow_the_first_whole_one, 1)
{
    // Mesh 0 has two primitives. Node 0 flattens it to nothing, so node 1 is the original.
    static const float corners[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    alp_scene *scene = NULL;
    ASSERT_OK(
        context,
        test_gltf_scene(
            context,
            "{'asset':{'version':'2.0'},'buffers':[{'byteLength':36}],"
            "'bufferViews':[{'buffer':0,'byteLength':36}],"
            "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3',"
            "'min':[0,0,0],'max':[1,1,0]}],"
            "'meshes':[{'primitives':[{'attributes':{'POSITION':0}},{'attributes':{'POSITION':0}}]"
            "},{'primitives':[{'attributes':{'POSITION':0}}]}],"
            "'nodes':[{'mesh':0,'scale':[0,0,0]},{'mesh':0},{'mesh':1},{'mesh':0,'scale':[2,2,2]}],"
            "'scenes':[{'nodes':[0,1,2,3]}]}",
            corners, sizeof corners, &scene));
    assert_int_equal(scene->surface_count, 7);
    uint32_t *originals = NULL;
    ASSERT_OK(context, alpi_scene_instances(scene, NULL, &originals));
    const uint32_t expected[7] = {2, 3, 2, 3, 4, 2, 3};
    assert_memory_equal(originals, expected, sizeof expected);
    alpi_release(context, originals);

    bool chosen[7] = {false, false, false, false, true, true, true}; // nodes 2 and 3
    ASSERT_OK(context, alpi_scene_instances(scene, chosen, &originals));
    for (uint32_t s = 0; s < 7; s++) {
        assert_int_equal(originals[s], s);
    }
    alpi_release(context, originals);

    bool part[7] = {false, false, true, false, false, true, true}; // not the same primitives
    ASSERT_OK(context, alpi_scene_instances(scene, part, &originals));
    assert_int_equal(originals[2], 2);
    assert_int_equal(originals[5], 5);
    assert_int_equal(originals[6], 6);
    alpi_release(context, originals);
    alp_scene_destroy(scene);
}
