// SPDX-License-Identifier: MIT
// The crafted and collected broken glTF files: refused with a message that names the file, or read
// with finite data and a named warning.
#include "test_gltf.h"

#include "base/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// What an odd file must be told about, beyond being readable.
static const struct {
    const char *file, *code;
} warnings[] = {
    {"albedo_out_of_range.glb", "material-range"},
    {"collinear_triangles.glb", "zero-area"},
    {"corrupt_png.glb", "image"},
    {"degenerate_indices.glb", "zero-area"},
    {"far_from_origin_6378km.glb", "precision"},
    {"huge_coordinates_1e30.glb", "bad-coordinates"},
    {"index_count_not_3n.glb", "leftover-indices"},
    {"inf_vertices.glb", "bad-coordinates"},
    {"nan_vertices.glb", "bad-coordinates"},
    {"points_only.glb", "not-triangles"},
    {"spot_inner_gt_outer.glb", "light"},
    {"zero_normals.glb", "bad-normals"},
    {"zero_scale.glb", "zero-area"},
    {"zero_size_scene.glb", "zero-area"},
    {"missing_normals.glb", "no-material"},
    {"material_index_out_of_range.glb", "missing"},
    {"mesh_index_out_of_range.glb", "missing"},
};

static void check_finite(const alp_scene *scene)
{
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        vec3 normal = vec3_load(scene->normals[v]);
        assert_true(vec3_is_finite(vec3_load(scene->positions[v])));
        ASSERT_NEAR(vec3_length(normal), 1.0, 1e-5);
        for (int set = 0; set < ALPI_UV_SET_LIMIT; set++) {
            assert_true(scene->uvs[set] == NULL ||
                        (isfinite(scene->uvs[set][v][0]) && isfinite(scene->uvs[set][v][1])));
        }
    }
    assert_true(isfinite(scene->area) && scene->area >= 0.0);
    assert_true(vec3_is_finite(scene->bounds_min) && vec3_is_finite(scene->bounds_max));
    for (uint32_t i = 0; i < scene->material_count; i++) {
        for (int k = 0; k < 4; k++) {
            float value = scene->materials[i].base_color[k];
            assert_true(value >= 0.0f && value <= 1.0f);
        }
    }
}

static void check_invalid(const char *path)
{
    alp_context *context = test_context(1);
    alp_scene *scene = NULL;
    alp_result result = alp_scene_load(context, path, &scene);
    if (result == ALP_OK) {
        fail_msg("%s was accepted", path);
    }
    assert_null(scene);
    test_message_has(context, alpi_path_name(path));
    assert_true(result == ALP_ERROR_INVALID_DATA || result == ALP_ERROR_UNSUPPORTED ||
                result == ALP_ERROR_IO);
    alp_context_destroy(context);
}

static void check_odd(const char *path)
{
    alp_context *context = test_context(1);
    alp_scene *scene = NULL;
    test_log_clear();
    ASSERT_OK(context, alp_scene_load(context, path, &scene));
    check_finite(scene);
    for (size_t i = 0; i < sizeof warnings / sizeof *warnings; i++) {
        if (strcmp(warnings[i].file, alpi_path_name(path)) == 0 &&
            !test_log_has(warnings[i].code)) {
            fail_msg("%s: no warning \"%s\" in \"%s\"", path, warnings[i].code, test_log_text());
        }
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(crafted_files)
{
    const char *table = test_shared("scenes/broken/crafted/EXPECT.tsv");
    if (table == NULL) {
        skip();
    }
    size_t size;
    char *text = (char *)test_read_file(table, &size);
    int checked = 0;
    for (char *rest = text, *line; (line = strtok_r(rest, "\n", &rest)) != NULL;) {
        char *fields = line;
        const char *file = strtok_r(fields, "\t", &fields), *kind = strtok_r(fields, "\t", &fields);
        bool is_gltf = alpi_path_has_ending(file, ".glb") || alpi_path_has_ending(file, ".gltf");
        // This file of the table carries its buffer in a data: URI, so nothing is missing in it;
        // test_gltf_accessor has a missing one.
        if (!is_gltf || strcmp(file, "missing_external_bin.gltf") == 0) {
            continue;
        }
        char name[256];
        snprintf(name, sizeof name, "scenes/broken/crafted/%s", file);
        // A reference to a material or mesh that is not there costs that reference alone.
        const bool missing = strcmp(file, "material_index_out_of_range.glb") == 0 ||
                             strcmp(file, "mesh_index_out_of_range.glb") == 0;
        if (strcmp(kind, "invalid") == 0 && !missing) {
            check_invalid(test_shared(name));
        } else {
            check_odd(test_shared(name));
        }
        checked++;
    }
    free(text);
    assert_in_range(checked, 45, 1000);
}

TEST(third_party_files)
{
    if (test_shared("scenes") == NULL) {
        skip();
    }
    check_odd(test_shared("scenes/broken/third_party/BoxBadNormals.glb"));
    check_invalid(test_shared("scenes/broken/third_party/RecursiveNodes.gltf"));
    check_invalid(test_shared("scenes/broken/third_party/IndexOutOfRange/IndexOutOfRange.gltf"));
    check_invalid(
        test_shared("scenes/broken/third_party/IndexOutOfRange/AllIndicesOutOfRange.gltf"));
}

#define ASSET "'asset':{'version':'2.0'}"

/// Structures that no table has.
TEST_WITH_CONTEXT(hostile_structures, 1)
{
    static const struct {
        const char *json, *words;
        alp_result code;
    } cases[] = {
        {"{" ASSET ",'nodes':[{'children':[1,2]},{'children':[2]},{}]}", "child 2 is a child of",
         ALP_ERROR_INVALID_DATA},
        {"{" ASSET ",'nodes':[{'children':[0]}]}", "node 0: is its own ancestor",
         ALP_ERROR_INVALID_DATA},
        {"{" ASSET ",'nodes':[{},{'children':[2]},{'children':[3]},{'children':[1]}]}",
         "form a cycle", ALP_ERROR_INVALID_DATA},
        {"{" ASSET ",'nodes':[{'children':['x']}]}", "node 0: its entry 0", ALP_ERROR_INVALID_DATA},
        {"{" ASSET ",'nodes':[{}],'scenes':[{'nodes':[0,0]}]}", "names node 0 twice",
         ALP_ERROR_INVALID_DATA},
        {"{" ASSET ",'nodes':[{'children':[1]},{}],'scenes':[{'nodes':[1]}]}", "is not a root",
         ALP_ERROR_INVALID_DATA},
        {"{" ASSET ",'scene':3,'scenes':[{}]}", "scene is 3, but there is only 1",
         ALP_ERROR_INVALID_DATA},
        {"{" ASSET ",'nodes':{'a':1}}", "nodes: must be an array", ALP_ERROR_INVALID_DATA},
        {"{" ASSET ",'meshes':[3]}", "meshes: element 0 must be an object", ALP_ERROR_INVALID_DATA},
        {"{" ASSET ",'nodes':[],'nodes':[]}", "duplicate", ALP_ERROR_INVALID_DATA},
        {"{'asset':{'version':'1.0'}}", "glTF version 1.0", ALP_ERROR_UNSUPPORTED},
        {"{}", "asset.version is missing", ALP_ERROR_INVALID_DATA},
        {"{" ASSET ",'extensionsRequired':['KHR_texture_basisu']}",
         "KHR_texture_basisu, which this build does not read; convert its textures",
         ALP_ERROR_UNSUPPORTED},
        {"{" ASSET
         ",'extensionsRequired':['KHR_meshopt_compression'],'buffers':[{'byteLength':4}]}",
         "KHR_meshopt_compression", ALP_ERROR_UNSUPPORTED},
        {"{" ASSET ",'nodes':[{'rotation':[0,0,0,0]}]}", "node 0: rotation",
         ALP_ERROR_INVALID_DATA},
        {"{" ASSET ",'nodes':[{'scale':[1,1]}]}", "scale must be an array of 3 numbers",
         ALP_ERROR_INVALID_DATA},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene;
        assert_int_equal(test_gltf_scene(context, cases[i].json, NULL, 0, &scene), cases[i].code);
        assert_null(scene);
        test_message_has(context, cases[i].words);
        test_message_has(context, "test.glb: ");
    }
}

/// An index past the end where vertices are copied one by one: without normals.
TEST_WITH_CONTEXT(index_without_normals, 1)
{
    static const float bin[16] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    alp_scene *scene;
    const char *json =
        "{" ASSET ",'buffers':[{'byteLength':64}],'bufferViews':[{'buffer':0,'byteLength':64}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'type':'VEC3','count':3},"
        "{'bufferView':0,'byteOffset':12,'componentType':5125,'type':'SCALAR','count':3}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}],"
        "'nodes':[{'mesh':0}]}";
    assert_int_equal(test_gltf_scene(context, json, bin, sizeof bin, &scene),
                     ALP_ERROR_INVALID_DATA);
    test_message_has(context, "mesh 0, primitive 0: index 0 is 1065353216, but there are 3");
}

/// A chain of nodes as long as the file: no recursion may follow it.
TEST_WITH_CONTEXT(deep_nodes, 1)
{
    enum { DEPTH = 100000 };
    char *json = malloc(DEPTH * 32 + 256);
    assert_non_null(json);
    char *end = json + sprintf(json, "{" ASSET ",'nodes':[");
    for (int i = 0; i < DEPTH; i++) {
        end += sprintf(end, "{'children':[%d]},", i + 1);
    }
    sprintf(end, "{}]}");
    alp_scene *scene;
    ASSERT_OK(context, test_gltf_scene(context, json, NULL, 0, &scene));
    alp_scene_destroy(scene);
    // and JSON nested deeper than a parser's stack should go
    memset(json, '[', DEPTH * 32);
    memcpy(json, "{'a':", 5);
    json[DEPTH * 32] = '\0';
    assert_int_equal(test_gltf_scene(context, json, NULL, 0, &scene), ALP_ERROR_LIMIT);
    test_message_has(context, "levels deep, the limit is 1000");
    free(json);
}

/// Each of these takes a hundred times its bytes in the parser's tree: 4 GB out of 50 MB.
TEST_WITH_CONTEXT(values_are_counted, 1)
{
    const size_t count = (1 << 24) - 1; // with the array and the whole, one too many
    char *json = malloc(3 * count + 64);
    assert_non_null(json);
    char *end = json + sprintf(json, "{'a':[");
    for (size_t i = 0; i < count; i++, end += 3) {
        memcpy(end, "{},", 3);
    }
    memcpy(end - 1, "]}", 3);
    alp_scene *scene;
    assert_int_equal(test_gltf_scene(context, json, NULL, 0, &scene), ALP_ERROR_LIMIT);
    test_message_has(context, "16777217 objects and arrays, 33554432 values; the limits are "
                              "16777216 and 67108864");
    free(json);
}

/// A few nodes that would place more triangles than we take: refused before memory is asked for.
TEST_WITH_CONTEXT(expansion_is_limited, 1)
{
    char *json = malloc(1 << 16);
    assert_non_null(json);
    char *end = json + sprintf(json, "{" ASSET ",'accessors':[{'componentType':5126,'type':'VEC3',"
                                     "'count':16000000}],'meshes':[{'primitives':["
                                     "{'attributes':{'POSITION':0}}]}],'nodes':[");
    for (int i = 0; i < 20; i++) {
        end += sprintf(end, "%s{'mesh':0}", i > 0 ? "," : "");
    }
    sprintf(end, "]}");
    alp_scene *scene;
    assert_int_equal(test_gltf_scene(context, json, NULL, 0, &scene), ALP_ERROR_LIMIT);
    test_message_has(context, "268435456");
    assert_in_range(alp_context_peak_memory(context), 1, 1 << 20);
    free(json);
}

TEST_WITH_CONTEXT(other_kinds, 1)
{
    alp_scene *scene;
    assert_int_equal(alp_scene_load(context, "absent.dae", &scene), ALP_ERROR_IO);
    test_message_has(context, "absent.dae");
    assert_int_equal(alp_scene_load(context, "x.OBJ", &scene), ALP_ERROR_IO);
    test_message_has(context, "x.OBJ");
    assert_int_equal(alp_scene_load(context, "absent.glb", &scene), ALP_ERROR_IO);
    test_message_has(context, "absent.glb");
    assert_int_equal(alp_scene_load(context, test_folder(), &scene), ALP_ERROR_IO);
    assert_int_equal(alp_scene_load(context, NULL, &scene), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_scene_load(NULL, "x", &scene), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(scene);
}
