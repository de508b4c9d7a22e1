// SPDX-License-Identifier: MIT
// Where the parts of a patched asset go: containers, files beside them, other folders, scenes that
// come from no file; and what is left when memory runs out.
#include "quad_asset.h"

#include <stdio.h>
#include <stdlib.h>

#define ASSET "{\"version\":\"2.0\"}"
#define ONE_NODE "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
#define MESH(primitives) "\"meshes\":[{\"primitives\":[" primitives "]}]"
#define QUAD "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":6,\"material\":0}"

// --- containers and files ------------------------------------------------------------------------

static const char plain[] = ONE_NODE "\"materials\":[{}]," MESH(QUAD);

TEST(files_beside_a_gltf)
{
    quad_bake bake = quad_open(quad_write_gltf(ASSET, plain), 2);
    bake.pages[1] = 1;
    quad_write(&bake, ".gltf");
    assert_string_equal(quad_text(&bake, "buffers/1/uri"), "\"quad%20baked.bake.bin\"");
    assert_string_equal(quad_text(&bake, "images/0/uri"), "\"quad%20baked.ao.png\"");
    assert_string_equal(quad_text(&bake, "images/1/uri"), "\"quad%20baked.ao.1.png\"");
    quad_require_corners(&bake, 0);
    quad_close(&bake);
    bake = quad_open(quad_write_glb(ASSET, plain), 1);
    quad_write(&bake, ".gltf");
    assert_string_equal(quad_text(&bake, "buffers/0/uri"), "\"quad%20baked.bin\"");
    quad_require_corners(&bake, 0);
    quad_close(&bake);
    bake = quad_open(quad_write_gltf(ASSET, plain), 1);
    quad_write(&bake, ".glb");
    assert_string_equal(quad_text(&bake, "buffers/0/uri"), "");
    assert_string_equal(quad_text(&bake, "buffers/1"), "");
    quad_require_corners(&bake, 0);
    quad_close(&bake);
}

/// A .gltf of two buffers and a picture, all of which a .glb holds in itself.
TEST(many_files_become_one_glb)
{
    quad_bake first = quad_open(quad_write_gltf(ASSET, plain), 1);
    quad_write(&first, ".gltf");
    quad_unmark(first.path); // or the second set would take the place of the first
    quad_bake second = quad_open(first.path, 1);
    quad_write(&second, ".glb");
    assert_string_equal(quad_text(&second, "buffers/0/uri"), "");
    assert_string_equal(quad_text(&second, "buffers/1"), "");
    assert_string_equal(quad_text(&second, "images/0/uri"), "");
    assert_string_equal(quad_text(&second, "images/0/mimeType"), "\"image/png\"");
    assert_int_not_equal(quad_number(&second, "images/0/bufferView"), -1);
    quad_require_corners(&second, 1);
    for (uint32_t t = 0; t < 2; t++) { // the set of the first bake, from the second buffer
        for (int k = 0; k < 3; k++) {
            assert_memory_equal(second.result->uvs[0][second.result->triangles[t][k]],
                                first.uvs[t][k], sizeof first.uvs[t][k]);
        }
    }
    quad_close(&second);
    quad_close(&first);
}

TEST(a_file_is_baked_over_itself)
{
    quad_bake bake = quad_open(quad_write_gltf(ASSET, plain), 1);
    const char *path = bake.path;
    assert_int_equal(alpi_gltf_check_output(bake.scene, 1, path, false), ALP_ERROR_IO);
    assert_int_equal(alpi_scene_write_patched(bake.scene, &bake.patch, path, false), ALP_ERROR_IO);
    for (int round = 0; round < 3; round++) { // each takes the place of the one before
        for (int i = 0; i < 6; i++) {
            bake.uvs[i / 3][i % 3][1] = 0.25f * (float)(round + 1);
        }
        ASSERT_OK(bake.context, alpi_gltf_check_output(bake.scene, 1, path, true));
        ASSERT_OK(bake.context, alpi_scene_write_patched(bake.scene, &bake.patch, path, true));
        alp_scene_destroy(bake.scene);
        ASSERT_OK(bake.context, alpi_gltf_read_scene(bake.context, path, &bake.scene));
        assert_int_equal(bake.scene->surfaces[0].uv_sets, 1);
        ASSERT_NEAR(bake.scene->uvs[0][0][1], 0.25 * (round + 1), 0.0);
    }
    quad_close(&bake);
}

TEST(references_follow_into_another_folder)
{
    quad_bake bake = quad_open(
        quad_write_gltf(ASSET, ONE_NODE
                        "\"images\":[{\"uri\":\"gone.png\"}],\"materials\":[{}]," MESH(QUAD)),
        1);
    const char *folder = test_folder();
    snprintf(bake.path, sizeof bake.path, "%s/out.gltf", folder);
    test_log_clear();
    ASSERT_OK(bake.context, alpi_scene_write_patched(bake.scene, &bake.patch, bake.path, false));
    assert_true(test_log_has("missing-file"));
    ASSERT_OK(bake.context, alpi_gltf_read_scene(bake.context, bake.path, &bake.result));
    quad_require_corners(&bake, 0);
    // The copied buffer is there already with the same bytes: that is no overwriting.
    snprintf(bake.path, sizeof bake.path, "%s/second.gltf", folder);
    ASSERT_OK(bake.context, alpi_gltf_check_output(bake.scene, 1, bake.path, false));
    ASSERT_OK(bake.context, alpi_scene_write_patched(bake.scene, &bake.patch, bake.path, false));
    // With other bytes it is.
    FILE *file = fopen(test_path(folder, "quad data.bin"), "wb");
    assert_non_null(file);
    fclose(file);
    snprintf(bake.path, sizeof bake.path, "%s/third.gltf", folder);
    assert_int_equal(alpi_gltf_check_output(bake.scene, 1, bake.path, false), ALP_ERROR_IO);
    assert_int_equal(alpi_scene_write_patched(bake.scene, &bake.patch, bake.path, false),
                     ALP_ERROR_IO);
    file = fopen(bake.path, "rb"); // all or nothing
    assert_null(file);
    quad_close(&bake);
}

/// A GLB without BIN chunk whose only buffer is a data: URI.
TEST(a_glb_without_a_chunk_of_its_own)
{
    const char *json =
        "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{"
        "\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
        "\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{"
        "\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";
    size_t length = strlen(json), padded = (length + 3) / 4 * 4;
    const char *path = test_path(quad_folder(), "data.glb");
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    uint32_t header[5] = {0x46546C67, 2, (uint32_t)(20 + padded), (uint32_t)padded, 0x4E4F534A};
    fwrite(header, 4, 5, file);
    fprintf(file, "%-*s", (int)padded, json);
    fclose(file);
    quad_bake bake = quad_open(path, 1);
    quad_write(&bake, ".glb");
    assert_int_equal(strncmp(quad_text(&bake, "buffers/1/uri"), "\"data:", 6), 0);
    quad_require_corners(&bake, 0);
    quad_close(&bake);
}

// --- scenes from no file -------------------------------------------------------------------------

TEST(scenes_from_arrays_become_files)
{
    static const float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const float uvs[] = {0, 0, 1, 0, 1, 1, 0, 1};
    static const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
    alp_mesh mesh = {.name = "a \"quad\"",
                     .vertex_count = 4,
                     .positions = positions,
                     .uvs = uvs,
                     .triangle_count = 2,
                     .indices = indices,
                     .base_color = {0.5f, 0.25f, 0.125f},
                     .double_sided = true};
    alp_mesh meshes[2] = {mesh, mesh};
    alp_context *context = test_context(1);
    quad_bake bake = quad_open(quad_write_glb(ASSET, plain), 1); // for its pages
    alp_scene *scene = NULL, *again = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
    float corners[4][3][2];
    for (int i = 0; i < 24; i++) {
        corners[i / 6][i / 2 % 3][i % 2] = (float)i / 24.0f;
    }
    bake.patch.corner_uvs = (void *)corners;
    bake.patch.triangle_pages = NULL;
    const char *path = test_path(quad_folder(), "arrays.gltf");
    ASSERT_OK(context, alpi_gltf_check_output(scene, 1, path, false));
    ASSERT_OK(context, alpi_scene_write_patched(scene, &bake.patch, path, false));
    quad_list(bake.path, path); // the quad has no error, so this must have none
    ASSERT_OK(context, alpi_gltf_read_scene(context, path, &again));
    assert_int_equal(again->triangle_count, 4);
    assert_string_equal(again->surfaces[1].name, "a \"quad\"");
    const alpi_material *m = &again->materials[again->surfaces[0].material];
    assert_true(m->double_sided);
    ASSERT_NEAR(m->base_color[1], 0.25, 0.0);
    uint32_t set = again->surfaces[0].uv_sets - 1;
    assert_int_equal(m->occlusion_texture.uv_set, set);
    for (uint32_t t = 0; t < 4; t++) {
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = again->triangles[t][k];
            assert_memory_equal(again->positions[vertex],
                                &positions[3 * indices[3 * (t % 2) + (uint32_t)k]], 12);
            assert_memory_equal(again->uvs[set][vertex], corners[t][k], 8);
        }
    }
    alp_scene_destroy(again);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    quad_close(&bake);
}

// --- memory --------------------------------------------------------------------------------------

typedef struct failing_allocator {
    long left; // allocations until one fails
} failing_allocator;

static void *allocate_or_fail(void *user, size_t size)
{
    failing_allocator *allocator = user;
    return allocator->left-- == 0 ? NULL : malloc(size);
}

static void release(void *user, void *pointer)
{
    (void)user;
    free(pointer);
}

/// Patches with every allocation failing in turn: OUT_OF_MEMORY, no leak, and no file left behind.
TEST(every_allocation_may_fail)
{
    quad_bake bake =
        quad_open(quad_write_gltf(
                      ASSET, "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":0}],"
                             "\"images\":[{\"uri\":\"quad%20data.bin\"}],"
                             "\"meshes\":[{\"primitives\":[" RICH_QUAD "]}]"),
                  2);
    quad_part_triangles(&bake);
    bake.pages[1] = 1;
    failing_allocator allocator = {.left = -1};
    alp_context_options options = alp_context_options_default();
    options.allocate = allocate_or_fail;
    options.release = release;
    options.allocator_user = &allocator;
    options.worker_count = 1;
    alp_context *context = NULL;
    assert_int_equal(alp_context_create(&options, &context), ALP_OK);
    alp_scene *scene = NULL;
    ASSERT_OK(context, alpi_gltf_read_scene(context, bake.path, &scene));
    for (int glb = 0; glb < 2; glb++) {
        const char *path = test_path(test_folder(), glb ? "out.glb" : "out.gltf");
        alp_result result = ALP_ERROR_OUT_OF_MEMORY;
        for (long i = 0; result != ALP_OK; i++) {
            allocator.left = i;
            result = alpi_scene_write_patched(scene, &bake.patch, path, false);
            // the allocator reads it
            allocator.left = -1;
            if (result != ALP_OK) {
                assert_int_equal(result, ALP_ERROR_OUT_OF_MEMORY);
                assert_null(fopen(path, "rb"));
            }
        }
        alp_scene *again = NULL;
        ASSERT_OK(context, alpi_gltf_read_scene(context, path, &again));
        alp_scene_destroy(again);
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    quad_close(&bake);
}

TEST(other_endings_are_refused)
{
    quad_bake bake = quad_open(quad_write_glb(ASSET, plain), 1);
    assert_int_equal(alpi_scene_write_patched(bake.scene, &bake.patch, "x.stl", false),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alpi_gltf_check_output(bake.scene, 1, "x", false), ALP_ERROR_INVALID_ARGUMENT);
    bake.pages[0] = 1;
    assert_int_equal(alpi_scene_write_patched(bake.scene, &bake.patch, "x.glb", false),
                     ALP_ERROR_INVALID_ARGUMENT);
    quad_close(&bake);
}
