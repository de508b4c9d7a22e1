// SPDX-License-Identifier: MIT
// Baked assets: what was left out comes out as it went in, and instances go on sharing a mesh.
#include "boxes.h"
#include "quad_asset.h"
#include "test_gltf.h"

#include "base/memory.h"
#include "maps/lightmap.h"
#include "scene/scene.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct asset_data {
    float cube[8][3], floor[4][3];
    uint16_t sides[10][3], top[2][3], square[2][3];
} asset_data;

/// A floor, four boxes of one mesh with two primitives (mirrored, twice as large, below a floor of
/// their own), and one material for all. The path is static.
static const char *write_asset(alp_context *context)
{
    asset_data data = {.floor = {{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}},
                       .square = {{0, 1, 2}, {0, 2, 3}}};
    memcpy(data.cube, CUBE, sizeof CUBE);
    for (int i = 0, sides = 0, top = 0; i < 12; i++) {
        uint16_t *to = i == 2 || i == 3 ? data.top[top++] : data.sides[sides++];
        for (int k = 0; k < 3; k++) {
            to[k] = (uint16_t)CUBE_TRIANGLES[i][k];
        }
    }
    static const char json[] =
        "{'asset':{'version':'2.0'},'buffers':[{'byteLength':228}],'bufferViews':["
        "{'buffer':0,'byteLength':96,'target':34962},"
        "{'buffer':0,'byteOffset':96,'byteLength':48,'target':34962},"
        "{'buffer':0,'byteOffset':144,'byteLength':84,'target':34963}],'accessors':["
        "{'bufferView':0,'componentType':5126,'count':8,'type':'VEC3','min':[0,0,0],'max':[1,1,1]},"
        "{'bufferView':1,'componentType':5126,'count':4,'type':'VEC3','min':[-9,0,-9],'max':"
        "[9,0,9]},"
        "{'bufferView':2,'componentType':5123,'count':30,'type':'SCALAR'},"
        "{'bufferView':2,'byteOffset':60,'componentType':5123,'count':6,'type':'SCALAR'},"
        "{'bufferView':2,'byteOffset':72,'componentType':5123,'count':6,'type':'SCALAR'}],"
        "'materials':[{'name':'all'}],'meshes':["
        "{'primitives':[{'attributes':{'POSITION':0},'indices':2,'material':0},"
        "{'attributes':{'POSITION':0},'indices':3,'material':0}]},"
        "{'primitives':[{'attributes':{'POSITION':1},'indices':4,'material':0}]}],"
        "'nodes':[{'name':'Boden','mesh':1},{'name':'Kiste 1','mesh':0},"
        "{'name':'Kiste 2','mesh':0,'translation':[0.5,0.25,0],'scale':[-1,1,1]},"
        "{'name':'große Kiste','mesh':0,'translation':[4,0,0],'scale':[2,2,2]},"
        "{'name':'Kiste 4','mesh':0,'translation':[-4,0,0]}],"
        "'scenes':[{'nodes':[0,1,2,3,4]}],'scene':0}";
    static char path[700];
    snprintf(path, sizeof path, "%s/boxes.glb", quad_folder());
    size_t size;
    uint8_t *bytes = test_glb(context, json, &data, 228, &size);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
    alpi_release(context, bytes);
    return path;
}

static const alpi_gltf_document *document_of(const alp_scene *scene)
{
    return scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
}

/// The file beside `path` that a bake writes.
static const char *baked_path(const char *path)
{
    static char baked[720];
    snprintf(baked, sizeof baked, "%.*s baked.glb", (int)(strlen(path) - 4), path);
    return baked;
}

/// The value at a path of the document's JSON as compact text, static.
static const char *text_at(const alp_scene *scene, const char *kind, size_t index)
{
    static char texts[2][2048];
    static int next;
    char *text = json_dumps(alpi_gltf_item(document_of(scene), kind, index), JSON_COMPACT);
    assert_non_null(text);
    char *out = texts[next++ % 2];
    snprintf(out, sizeof texts[0], "%s", text);
    free(text);
    return out;
}

TEST_WITH_CONTEXT(instances_share_one_map, 2)
{
    const char *path = write_asset(context);
    alp_scene *scene = test_load(context, path);
    alp_bake_options options = small_options();
    options.ao_self = true;
    options.atlas.size = 128;
    options.output = baked_path(path);
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    test_log_clear();
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    assert_true(test_log_has("instance-size"));
    assert_non_null(strstr(test_log_text(), "große Kiste: 2 times"));
    assert_int_equal(report.surfaces_baked, 9);
    float low, high;
    find_range(lightmap, &low, &high);
    assert_true(low == 1.0f && high == 1.0f); // boxes that run through each other are alone too
    double area = 0.0;
    for (uint32_t i = 0; i < lightmap->texels.count; i++) {
        assert_true(lightmap->texels.triangles[i] < 2 + 12); // the floor and the first box
        area += (double)lightmap->texels.areas[i];
    }
    ASSERT_NEAR(area, 18.0 * 18.0 + 6.0, 1e-3); // and no other
    quad_list(path, options.output);

    alp_scene *baked = test_load(context, options.output);
    assert_int_equal(baked->triangle_count, scene->triangle_count);
    assert_int_equal(alpi_gltf_count(document_of(baked), "meshes"), 2);
    assert_int_equal(alpi_gltf_count(document_of(baked), "materials"), 1);
    for (size_t n = 0; n < 5; n++) {
        assert_string_equal(text_at(baked, "nodes", n), text_at(scene, "nodes", n));
    }
    const float *uvs = alp_atlas_corner_uvs(lightmap->atlas);
    for (uint32_t t = 0; t < baked->triangle_count; t++) { // mirrored ones are turned
        assert_int_equal(alp_atlas_triangle_pages(lightmap->atlas)[t], 0);
        for (int k = 0; k < 6; k++) {
            const float uv = baked->uvs[0][baked->triangles[t][k / 2]][k % 2];
            assert_true(uv == uvs[6 * (size_t)t + (size_t)k]);
        }
    }
    alp_scene_destroy(baked);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(what_is_not_baked_stays_as_it_was, 2)
{
    const char *path = write_asset(context);
    alp_scene *scene = test_load(context, path);
    alp_bake_options options = small_options();
    options.only = "Kiste [14]";
    options.occluders = "Boden";
    options.output = baked_path(path);
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    quad_list(path, options.output);
    alp_scene *baked = test_load(context, options.output);
    const alpi_gltf_document *before = document_of(scene), *after = document_of(baked);
    assert_string_equal(text_at(baked, "meshes", 0), text_at(scene, "meshes", 0));
    assert_string_equal(text_at(baked, "meshes", 1), text_at(scene, "meshes", 1));
    assert_string_equal(text_at(baked, "materials", 0), text_at(scene, "materials", 0));
    assert_int_equal(alpi_gltf_count(after, "meshes"), 4);
    assert_int_equal(alpi_gltf_count(after, "materials"), 2);
    static const bool is_baked[5] = {false, true, false, false, true};
    for (size_t n = 0; n < 5; n++) {
        assert_int_equal(strcmp(text_at(baked, "nodes", n), text_at(scene, "nodes", n)) != 0,
                         is_baked[n]);
    }
    assert_memory_equal(after->buffers[0].bytes, before->buffers[0].bytes, 228);
    for (uint32_t s = 0; s < baked->surface_count; s++) {
        const bool wanted = is_baked[baked->surfaces[s].node];
        const alpi_material *material = &baked->materials[baked->surfaces[s].material];
        assert_int_equal(baked->surfaces[s].uv_sets, wanted ? 1 : 0);
        assert_int_equal(material->occlusion_texture.image != ALPI_NONE, wanted);
    }
    json_t *extras = json_object_get(
        json_object_get(json_object_get(after->root, "asset"), "extras"), "alpenglow");
    assert_string_equal(json_string_value(json_object_get(extras, "only")), "Kiste [14]");
    assert_string_equal(json_string_value(json_object_get(extras, "occluders")), "Boden");
    json_t *names = json_object_get(extras, "surfaces");
    assert_int_equal(json_array_size(names), 2);
    assert_string_equal(json_string_value(json_array_get(names, 0)), "Kiste 1");
    assert_string_equal(json_string_value(json_array_get(names, 1)), "Kiste 4");
    alp_scene_destroy(baked);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_kept_set_is_judged_by_what_is_baked, 2)
{
    // Baked with one map for all boxes, the set overlaps itself for a bake of all of them.
    const char *path = write_asset(context);
    alp_scene *scene = test_load(context, path);
    alp_bake_options options = small_options();
    options.ao_self = true;
    options.atlas.size = 128;
    options.output = baked_path(path);
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    alp_scene_destroy(scene);
    scene = test_load(context, options.output);
    scene->uvs[1] = scene->uvs[0]; // as if it were the second set
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        scene->surfaces[s].uv_sets = 2;
    }
    options = small_options();
    options.atlas.mode = ALP_ATLAS_KEEP;
    options.atlas.size = 128;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_DATA);
    test_message_has(context, "overlap");
    options.only = "Kiste 4,Boden";
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
    assert_int_equal(report.atlas.mode, ALP_ATLAS_KEEP);
    options.only = NULL;
    options.ao_self = true;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
    assert_true(report.ao_mean == 1.0);
    scene->uvs[1] = NULL;
    alp_scene_destroy(scene);
}
