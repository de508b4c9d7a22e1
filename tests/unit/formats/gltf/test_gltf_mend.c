// SPDX-License-Identifier: MIT
// A reference to something that is not there costs that reference and a warning, in what is read
// and in the text that a writer starts from. Also: hidden nodes, backslashes, and extensions that a
// bake may pass over.
#include "test_gltf.h"

#include "base/memory.h"
#include "formats/formats.h"
#include "formats/gltf/gltf_read.h"

#include <stdio.h>
#include <string.h>

#define ASSET "'asset':{'version':'2.0'},"
#define QUAD                                                                                       \
    "'buffers':[{'byteLength':36}],'bufferViews':[{'buffer':0,'byteLength':36}],"                  \
    "'accessors':[{'bufferView':0,'componentType':5126,'type':'VEC3','count':3}],"
#define MESH "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]"
#define MESH_OF(material) "'meshes':[{'primitives':[{'attributes':{'POSITION':0}," material "}]}]"

static const float corners[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

static alp_scene *read(alp_context *context, const char *members)
{
    char json[4096];
    alp_scene *scene = NULL;
    snprintf(json, sizeof json, "{" ASSET QUAD "%s}", members);
    test_log_clear();
    ASSERT_OK(context, test_gltf_scene(context, json, corners, sizeof corners, &scene));
    return scene;
}

TEST_WITH_CONTEXT(missing_elements_cost_their_reference, 1)
{
    static const struct {
        const char *members, *warning, *gone; // words that are no more in the text
        uint32_t surfaces;
    } cases[] = {
        {"'nodes':[{'mesh':0},{'mesh':7,'name':'n'}]," MESH, "mesh is 7", "\"mesh\":7", 1},
        {"'nodes':[{'mesh':0,'camera':2}]," MESH, "camera is 2", "camera", 1},
        {"'nodes':[{'mesh':0,'skin':2}]," MESH, "skin is 2", "skin", 1},
        {"'nodes':[{'mesh':0,'skin':0}],'skins':[{'joints':[9]}]," MESH, "a joint of its skin",
         "\"skin\"", 1},
        {"'nodes':[{'mesh':0,'children':[1,9,8]},{'mesh':0}]," MESH, "one of its children is 9",
         "9,8", 2},
        {"'nodes':[{'mesh':0,'children':[9]}]," MESH, "one of its children is 9", "children", 1},
        {"'nodes':[{'mesh':0}],'scenes':[{'nodes':[0,3]}]," MESH, "one of its nodes is 3", "0,3",
         1},
        {"'nodes':[{'mesh':0,'extensions':{'KHR_lights_punctual':{'light':1}}}]," MESH,
         "light is 1", "light", 1},
        {"'nodes':[{'mesh':0}]," MESH_OF("'material':3"), "material is 3", "\"material\"", 1},
        {"'nodes':[{'mesh':0}]," MESH_OF("'material':-1"), "material is -1", "\"material\"", 1},
        {"'nodes':[{'mesh':0}],'materials':[{'pbrMetallicRoughness':{'baseColorTexture':"
         "{'index':4}}}]," MESH_OF("'material':0"),
         "baseColorTexture is 4", "baseColorTexture", 1},
        {"'nodes':[{'mesh':0}],'materials':[{'emissiveTexture':{'index':4},'extensions':"
         "{'KHR_materials_transmission':{'transmissionTexture':{'index':5}}}}]," MESH_OF(
             "'material':0"),
         "transmissionTexture is 5", "\"index\"", 1},
        {"'nodes':[{'mesh':0}],'textures':[{'source':6,'sampler':7}],'materials':[{"
         "'emissiveTexture':{'index':0}}]," MESH_OF("'material':0"),
         "source is 6", "\"source\"", 1},
        {"'nodes':[{'mesh':0}],'materials':[{}]," MESH_OF(
             "'extensions':{'KHR_materials_variants':{'mappings':[{'material':0,'variants':[0]},"
             "{'material':5,'variants':[1]}]}}"),
         "one of its mappings is 5", "\"material\":5", 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = read(context, cases[i].members);
        const alpi_gltf_document *document = scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
        char *text = alpi_format(context, "%.*s", (int)document->text_size, document->text);
        if (!test_log_has("missing") || strstr(test_log_text(), cases[i].warning) == NULL ||
            strstr(text, cases[i].gone) != NULL) {
            fail_msg("case %zu: \"%s\" in %s", i, test_log_text(), text);
        }
        assert_int_equal(scene->surface_count, cases[i].surfaces);
        alpi_release(context, text);
        alp_scene_destroy(scene);
    }
}

/// What is there is not touched: the text is that of the file.
TEST_WITH_CONTEXT(whole_files_stay, 1)
{
    alp_scene *scene = read(context, "'nodes':[{'mesh':0,'children':[1]},{}],'materials':[{}],"
                                     "'scenes':[{'nodes':[0]}]," MESH_OF("'material':0"));
    const alpi_gltf_document *document = scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
    assert_null(document->mended_text);
    assert_false(test_log_has("missing"));
    alp_scene_destroy(scene);
}

/// Data, and the default scene, are no references that a file can do without.
TEST_WITH_CONTEXT(faults_of_data_stay_refused, 1)
{
    static const char *const cases[][2] = {
        {"'nodes':[{'mesh':0}],'meshes':[{'primitives':[{'attributes':{'POSITION':3}}]}]",
         "POSITION is 3, but there is only 1 accessor"},
        {"'nodes':[{'mesh':0}],'scene':2,'scenes':[{'nodes':[0]}]," MESH, "scene is 2"},
        {"'nodes':[{'mesh':'x'}]," MESH, "mesh must be a non-negative integer"},
        {"'nodes':[{'mesh':0,'children':[0]}]," MESH, "is its own ancestor"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[4096];
        alp_scene *scene = NULL;
        snprintf(json, sizeof json, "{" ASSET QUAD "%s}", cases[i][0]);
        assert_int_equal(test_gltf_scene(context, json, corners, sizeof corners, &scene),
                         ALP_ERROR_INVALID_DATA);
        test_message_has(context, cases[i][1]);
    }
}

/// How often a word stands in the log.
static int count_in_log(const char *word)
{
    int count = 0;
    for (const char *at = strstr(test_log_text(), word); at != NULL; at = strstr(at + 1, word)) {
        count++;
    }
    return count;
}

/// One texture that is not there costs one warning, whatever reads it and however often.
TEST_WITH_CONTEXT(a_missing_texture_costs_one_warning, 1)
{
    static const char *const cases[] = {
        "'textures':[{'source':6}],",
        "'textures':[{}],",
        "'textures':[{'source':0}],'images':[{'uri':'none.png'}],",
        ("'textures':[{'source':0},{'source':1},{'source':2}],'images':[{'uri':'none.png'},"
         "{'uri':'none.png'},{'uri':'none.png'}],"),
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char members[2048];
        snprintf(members, sizeof members,
                 "'nodes':[{'mesh':0}],%s'materials':[{'emissiveTexture':{'index':0},"
                 "'occlusionTexture':{'index':%d},'pbrMetallicRoughness':{'baseColorTexture':"
                 "{'index':%d},'metallicRoughnessTexture':{'index':0}}}]," MESH_OF("'material':0"),
                 cases[i], i == 3 ? 1 : 0, i == 3 ? 2 : 0);
        alp_scene *scene = read(context, members);
        for (uint32_t k = 0; k < scene->image_count; k++) {
            alp_image *image = NULL;
            ASSERT_OK(context, scene->read_image(scene, k, &image)); // as conversions do
            assert_null(image);
        }
        const int told =
            count_in_log("missing ") + count_in_log("image image") + count_in_log("image texture");
        if (told != 1) {
            fail_msg("case %zu: %d warnings: %s", i, told, test_log_text());
        }
        alp_scene_destroy(scene);
    }
}

/// Empty primitives cost themselves: the mesh of the second node stays.
TEST_WITH_CONTEXT(empty_primitives_cost_themselves, 1)
{
    static const char *const cases[] = {
        "{}",
        "{'attributes':{}}",
        "{'attributes':{'POSITION':1}}",
        "{'attributes':{'POSITION':1,'NORMAL':0}}",
        "{'attributes':{'POSITION':1},'indices':2}",
        "{'attributes':{'POSITION':0},'indices':2}",
        "{'attributes':{'POSITION':1},'mode':0}",
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[2048];
        snprintf(json, sizeof json,
                 "{" ASSET "'buffers':[{'byteLength':36}],'bufferViews':[{'buffer':0,"
                 "'byteLength':36}],'accessors':[{'bufferView':0,'componentType':5126,"
                 "'type':'VEC3','count':3},{'bufferView':0,'componentType':5126,'type':'VEC3',"
                 "'count':0},{'bufferView':0,'componentType':5123,'type':'SCALAR','count':0}],"
                 "'nodes':[{'mesh':0},{'mesh':1}],'meshes':[{'primitives':[%s]},"
                 "{'primitives':[{'attributes':{'POSITION':0}}]}]}",
                 cases[i]);
        alp_scene *scene = NULL;
        test_log_clear();
        ASSERT_OK(context, test_gltf_scene(context, json, corners, sizeof corners, &scene));
        assert_int_equal(scene->surface_count, 1);
        assert_int_equal(scene->usable_count, 1);
        if (strstr(test_log_text(), "empty-geometry mesh 0, primitive 0: primitives without a "
                                    "triangle are left out, this one first: 1") == NULL) {
            fail_msg("case %zu: \"%s\"", i, test_log_text());
        }
        alp_scene_destroy(scene);
    }
}

// --- hidden nodes --------------------------------------------------------------------------------

#define HIDDEN(visible) "'extensions':{'KHR_node_visibility':{'visible':" visible "}}"

/// A node is hidden with all below it, its lights too, but not its cameras.
TEST_WITH_CONTEXT(hidden_nodes_show_nothing, 1)
{
    alp_scene *scene = read(
        context,
        "'extensionsRequired':['KHR_node_visibility'],'extensions':{'KHR_lights_punctual':"
        "{'lights':[{'type':'point'}]}},'cameras':[{'type':'perspective','perspective':{'yfov':1}}]"
        ",'scenes':[{'nodes':[0,1,4]}],'nodes':[{'mesh':0,'name':'seen'," HIDDEN(
            "true") "},"
                    "{'mesh':0,'children':[2,3]," HIDDEN("false") "},{'mesh':0,'camera':0," HIDDEN(
                        "true") "},"
                                "{'extensions':{'KHR_lights_punctual':{'light':0}}},"
                                "{'extensions':{'KHR_lights_punctual':{'light':0}}}]," MESH);
    assert_int_equal(scene->surface_count, 1);
    assert_string_equal(scene->surfaces[0].name, "seen");
    assert_int_equal(scene->light_count, 1);
    assert_int_equal(scene->camera_count, 1);
    assert_non_null(strstr(test_log_text(), "and stay in the file: 2"));
    alp_scene_destroy(scene);
}

// --- names ---------------------------------------------------------------------------------------

TEST_WITH_CONTEXT(backslashes_are_slashes, 1)
{
    const char *folder = test_folder();
    char path[1024];
    snprintf(path, sizeof path, "%s/corners.bin", folder);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fwrite(corners, 1, sizeof corners, file);
    fclose(file);
    static const struct {
        const char *uri;
        alp_result result;
    } cases[] = {{".\\\\corners.bin", ALP_OK},
                 {"a\\\\..\\\\..\\\\corners.bin", ALP_ERROR_INVALID_DATA},
                 {".%5Ccorners.bin", ALP_ERROR_IO}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = NULL;
        snprintf(path, sizeof path, "%s/scene%zu.gltf", folder, i);
        file = fopen(path, "wb");
        assert_non_null(file);
        fprintf(file,
                "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}],"
                "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":"
                "0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":3}],\"nodes\":[{\"mesh\":0}],"
                "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}",
                cases[i].uri);
        fclose(file);
        assert_int_equal(alpi_gltf_read_scene(context, path, &scene), cases[i].result);
        alp_scene_destroy(scene);
    }
}

// --- extensions ----------------------------------------------------------------------------------

TEST_WITH_CONTEXT(extensions_that_change_no_bake, 1)
{
    static const char *const names[] = {
        "KHR_materials_variants",  "KHR_animation_pointer", "KHR_xmp_json_ld", "EXT_mesh_features",
        "EXT_structural_metadata", "KHR_node_visibility",   "KHR_xmp"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char members[256];
        snprintf(members, sizeof members, "'extensionsRequired':['%s'],'nodes':[{'mesh':0}]," MESH,
                 names[i]);
        alp_scene *scene = read(context, members);
        assert_int_equal(scene->surface_count, 1);
        alp_scene_destroy(scene);
    }
}
