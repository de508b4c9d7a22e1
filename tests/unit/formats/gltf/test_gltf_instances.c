// SPDX-License-Identifier: MIT
// EXT_mesh_gpu_instancing: where instances stand, and what a patch makes of them.
#include "pack_asset.h"
#include "test_gltf.h"

#include "base/memory.h"
#include "formats/formats.h"
#include "scene/select.h"

#include <math.h>
#include <stdio.h>

enum { COUNT = 4 };

/// Rotations are made unit once more when nodes are read: a float of up to 128 may round otherwise.
#define ROUNDING (1.7321 * 7.63e-6)

/// A triangle with a normal and four instances of it: moved, turned by bytes, scaled, mirrored.
static const char *write_instances(const char *node, const char *more)
{
    static const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
    static const float normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    static const float places[COUNT][3] = {{0, 0, 0}, {5, 0, 0}, {0, 6, 0}, {0, 0, 7}};
    static const int8_t turns[COUNT][4] = {
        {0, 0, 0, 127}, {0, 0, 90, 90}, {0, 0, 0, 127}, {0, 0, 0, -127}};
    static const float scales[COUNT][3] = {{1, 1, 1}, {1, 1, 1}, {2, 3, 4}, {-1, 1, 1}};
    char rest[2048];
    pack_asset *asset = pack_start();
    pack_accessor(asset, pack_view(asset, positions, sizeof positions, 0), 5126, 3, "VEC3",
                  ",'min':[0,0,0],'max':[1,2,0]");
    pack_accessor(asset, pack_view(asset, normals, sizeof normals, 0), 5126, 3, "VEC3", "");
    pack_accessor(asset, pack_view(asset, places, sizeof places, 0), 5126, COUNT, "VEC3", "");
    pack_accessor(asset, pack_view(asset, turns, sizeof turns, 0), 5120, COUNT, "VEC4",
                  ",'normalized':true");
    pack_accessor(asset, pack_view(asset, scales, sizeof scales, 0), 5126, COUNT, "VEC3", "");
    snprintf(rest, sizeof rest,
             "'extensionsUsed':['EXT_mesh_gpu_instancing'],"
             "'extensionsRequired':['EXT_mesh_gpu_instancing'],'scene':0,'scenes':[{'nodes':[0]}],"
             "'nodes':[{%s,'translation':[0,0,100]}%s],'meshes':[{'primitives':[{'attributes':{"
             "'POSITION':0,'NORMAL':1}}]}]",
             node, more);
    return pack_write(asset, rest);
}

#define INSTANCED                                                                                  \
    "'EXT_mesh_gpu_instancing':{'attributes':{'TRANSLATION':2,'ROTATION':3,'SCALE':4}}"

static void assert_corner(const alp_scene *scene, uint32_t surface, uint32_t vertex, double x,
                          double y, double z)
{
    const float *p = scene->positions[scene->surfaces[surface].first_vertex + vertex];
    ASSERT_NEAR(p[0], x, 1e-5);
    ASSERT_NEAR(p[1], y, 1e-5);
    ASSERT_NEAR(p[2], z, 1e-5);
}

TEST_WITH_CONTEXT(instances_stand, 1)
{
    alp_scene *scene = NULL;
    test_log_clear();
    ASSERT_OK(context,
              alp_scene_load(context, write_instances("'mesh':0,'extensions':{" INSTANCED "}", ""),
                             &scene));
    assert_true(test_log_has("instancing"));
    assert_int_equal(scene->surface_count, COUNT);
    for (uint32_t s = 0; s < COUNT; s++) {
        assert_int_equal(scene->surfaces[s].instance, s);
        assert_int_equal(scene->surfaces[s].node, 0);
        assert_int_equal(scene->surfaces[s].mirrored, s == 3);
        ASSERT_NEAR(scene->normals[scene->surfaces[s].first_vertex][2], 1.0, 1e-6);
    }
    assert_corner(scene, 0, 1, 1, 0, 100);
    assert_corner(scene, 1, 1, 5, 1, 100); // x turned to y
    assert_corner(scene, 1, 2, 3, 0, 100);
    assert_corner(scene, 2, 1, 2, 6, 100);
    assert_corner(scene, 2, 2, 0, 12, 100);
    assert_corner(scene, 3, 1, -1, 0, 107);
    uint32_t *originals = NULL; // all show one mesh
    ASSERT_OK(context, alpi_scene_instances(scene, NULL, &originals));
    for (uint32_t s = 0; s < COUNT; s++) {
        assert_int_equal(originals[s], 0);
    }
    alpi_release(context, originals);
    alp_scene_destroy(scene);
}

/// What is not given is 0, no turn and 1; a skinned mesh stands once, where its joints are.
TEST_WITH_CONTEXT(parts_left_out, 1)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_load(context,
                                      write_instances("'mesh':0,'extensions':{'EXT_mesh_gpu_"
                                                      "instancing':{'attributes':{'TRANSLATION':2}}"
                                                      "}",
                                                      ""),
                                      &scene));
    assert_int_equal(scene->surface_count, COUNT);
    assert_corner(scene, 1, 1, 6, 0, 100);
    assert_corner(scene, 2, 2, 0, 8, 100);
    alp_scene_destroy(scene);
    ASSERT_OK(context,
              alp_scene_load(context,
                             write_instances("'mesh':0,'extensions':{'EXT_mesh_gpu_instancing':{"
                                             "'attributes':{'SCALE':4}}}",
                                             ""),
                             &scene));
    assert_corner(scene, 2, 2, 0, 6, 100);
    alp_scene_destroy(scene);
    ASSERT_OK(context, alp_scene_load(context,
                                      write_instances("'mesh':0,'skin':0,'extensions':{" INSTANCED
                                                      "}}],'skins':[{'joints':[0]}],'more':[{'a':0",
                                                      ""),
                                      &scene));
    assert_int_equal(scene->surface_count, 1);
    alp_scene_destroy(scene);
}

/// Each with a map of its own: they become nodes, whatever else their node has.
TEST_WITH_CONTEXT(baked_ones_become_nodes, 1)
{
    static const struct {
        const char *node, *more;
        size_t children;
    } cases[] = {
        {"'mesh':0,'extensions':{" INSTANCED "}", "", COUNT},
        {"'extensions':{" INSTANCED "},'mesh':0", "", COUNT},
        {"'children':[1],'mesh':0,'extensions':{" INSTANCED "}", ",{'name':'child'}", 1 + COUNT},
        {"'extensions':{" INSTANCED "},'mesh':0,'children':[1]", ",{'name':'child'}", 1 + COUNT},
        {"'name':'n','extensions':{'SOME_other':{}," INSTANCED "},'mesh':0", "", COUNT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        test_log_clear();
        alp_scene *scene =
            pack_patch(context, write_instances(cases[i].node, cases[i].more), ".glb", ROUNDING);
        assert_true(test_log_has("instancing"));
        assert_int_equal(scene->surface_count, COUNT);
        const alpi_gltf_document *document = scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
        json_t *node = alpi_gltf_item(document, "nodes", 0);
        assert_null(json_object_get(node, "mesh"));
        assert_int_equal(json_array_size(json_object_get(node, "children")), cases[i].children);
        assert_int_equal(json_object_get(node, "extensions") != NULL, i == 4);
        assert_null(json_object_get(document->root, "extensionsUsed"));
        assert_null(json_object_get(document->root, "extensionsRequired"));
        alp_scene_destroy(scene);
    }
}

/// Those that share a map go on as instances of one mesh.
TEST_WITH_CONTEXT(shared_maps_keep_them, 1)
{
    alp_scene *scene = NULL, *again = NULL;
    ASSERT_OK(context,
              alp_scene_load(context, write_instances("'mesh':0,'extensions':{" INSTANCED "}", ""),
                             &scene));
    float uvs[COUNT][3][2] = {{{0, 0}, {1, 0}, {0, 1}}};
    for (int i = 1; i < COUNT; i++) {
        memcpy(uvs[i], uvs[0], sizeof uvs[0]);
    }
    memcpy(uvs[3], (float[3][2]){{0, 0}, {0, 1}, {1, 0}}, sizeof uvs[3]); // turned on reading
    const uint32_t originals[COUNT] = {0};
    const uint8_t *pngs[1] = {(const uint8_t *)"png"};
    const size_t sizes[1] = {3};
    alpi_mesh_patch patch = {.page_count = 1,
                             .corner_uvs = (void *)uvs,
                             .originals = originals,
                             .page_pngs = pngs,
                             .page_png_sizes = sizes,
                             .occlusion_strength = 1.0f};
    const char *out = test_path(test_folder(), "shared.glb");
    ASSERT_OK(context, alpi_scene_write_patched(scene, &patch, out, true));
    ASSERT_OK(context, alp_scene_load(context, out, &again));
    assert_true(wave_distance(scene, again) == 0.0);
    assert_int_equal(again->surfaces[3].instance, 3);
    assert_int_equal(again->surfaces[3].uv_sets, 1);
    alp_scene_destroy(again);
    alp_scene_destroy(scene);
}

/// JSON has no infinity: what an instance has that is none must not be written as a node's.
static void check_instances_that_are_nowhere(alp_context *context)
{
    static const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
    static const float places[3][3] = {{0, 0, 0}, {INFINITY, 0, 0}, {0, 6, 0}};
    static const float scales[3][3] = {{1, 1, 1}, {1, 1, 1}, {1, NAN, 1}};
    pack_asset *asset = pack_start();
    pack_accessor(asset, pack_view(asset, positions, sizeof positions, 0), 5126, 3, "VEC3",
                  ",'min':[0,0,0],'max':[1,2,0]");
    pack_accessor(asset, pack_view(asset, places, sizeof places, 0), 5126, 3, "VEC3", "");
    pack_accessor(asset, pack_view(asset, scales, sizeof scales, 0), 5126, 3, "VEC3", "");
    const char *path =
        pack_write(asset, "'extensionsUsed':['EXT_mesh_gpu_instancing'],'scenes':[{'nodes':[0]}],"
                          "'nodes':[{'mesh':0,'extensions':{'EXT_mesh_gpu_instancing':{"
                          "'attributes':{'TRANSLATION':1,'SCALE':2}}}}],'meshes':[{'primitives':["
                          "{'attributes':{'POSITION':0}}]}]");
    test_log_clear();
    alp_scene *scene = NULL, *again = NULL;
    ASSERT_OK(context, alp_scene_load(context, path, &scene));
    assert_true(test_log_has("bad-coordinates"));
    assert_non_null(strstr(test_log_text(), "scale is not finite: 2"));
    assert_int_equal(scene->surface_count, 3);
    assert_int_equal(scene->usable_count, 1);
    float uvs[3][3][2] = {{{0.0f}}};
    const uint8_t *const pngs[] = {(const uint8_t *)"x"};
    const size_t sizes[] = {1};
    const alpi_mesh_patch patch = {.page_count = 1,
                                   .corner_uvs = (const float(*)[3][2])uvs,
                                   .page_pngs = pngs,
                                   .page_png_sizes = sizes,
                                   .occlusion_strength = 1.0f};
    const char *out = test_path(test_folder(), "out.glb");
    ASSERT_OK(context, alpi_scene_write_patched(scene, &patch, out, true));
    ASSERT_OK(context, alp_scene_load(context, out, &again));
    assert_int_equal(again->triangle_count, 3);
    assert_int_equal(again->usable_count, 1);
    alp_scene_destroy(again);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(broken_instances, 1)
{
    static const struct {
        const char *attributes, *words;
    } cases[] = {
        {"'TRANSLATION':99", "node 0: TRANSLATION is 99"},
        {"'TRANSLATION':3", "its instances' TRANSLATION (accessor 3) has 4 elements of 4"},
        {"'TRANSLATION':2,'SCALE':0", "its instances' SCALE (accessor 0) has 3 elements"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char node[256];
        alp_scene *scene = NULL;
        snprintf(node, sizeof node,
                 "'mesh':0,'extensions':{'EXT_mesh_gpu_instancing':{'attributes':{%s}}}",
                 cases[i].attributes);
        assert_int_equal(alp_scene_load(context, write_instances(node, ""), &scene),
                         ALP_ERROR_INVALID_DATA);
        test_message_has(context, cases[i].words);
    }
    check_instances_that_are_nowhere(context);
}

/// The sample of 125 boxes, in both containers.
TEST_WITH_CONTEXT(sample, 1)
{
    const char *path = test_shared("scenes/features/SimpleInstancing/SimpleInstancing.gltf");
    if (path == NULL) {
        skip();
    }
    for (int i = 0; i < 2; i++) {
        alp_scene *scene = pack_patch(context, path, i == 0 ? ".glb" : ".gltf", ROUNDING);
        assert_int_equal(scene->surface_count, 125);
        assert_int_equal(scene->triangle_count, 125 * 12);
        alp_scene_destroy(scene);
    }
}
