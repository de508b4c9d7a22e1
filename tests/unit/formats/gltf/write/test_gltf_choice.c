// SPDX-License-Identifier: MIT
// Patches of some surfaces only, and of nodes that go on sharing a mesh.
#include "quad_asset.h"

#include "scene/scene.h"

#include <stdio.h>

#define ASSET "{\"version\":\"2.0\"}"
#define QUAD "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":6,\"material\":0}"
#define KEPT "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2},\"indices\":6,\"material\":0}"
#define MESH(primitives) "\"materials\":[{}],\"meshes\":[{\"primitives\":[" primitives "]}]"

static void leave_out(quad_bake *bake, uint32_t surface)
{
    const alpi_surface *s = &bake->scene->surfaces[surface];
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        bake->pages[s->first_triangle + i] = ALPI_NONE;
    }
}

/// Gives every surface the coordinates of its original: of a vertex, they differ in v alone.
static void share(quad_bake *bake, const uint32_t *originals)
{
    bake->patch.originals = originals;
    for (uint32_t s = 0; s < bake->scene->surface_count; s++) {
        const alpi_surface *to = &bake->scene->surfaces[s];
        const alpi_surface *from = &bake->scene->surfaces[originals[s]];
        for (uint32_t i = 0; i < 3 * to->triangle_count; i++) {
            bake->uvs[to->first_triangle + i / 3][i % 3][1] =
                bake->uvs[from->first_triangle + i / 3][0][1];
        }
    }
}

/// Every corner that has a page has the wanted coordinates in set `set` of the written file.
static void require_corners(const quad_bake *bake, uint32_t set)
{
    const alp_scene *b = bake->result;
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        for (int k = 0; k < 3 && bake->pages[t] != ALPI_NONE; k++) {
            assert_memory_equal(b->uvs[set][b->triangles[t][k]], bake->uvs[t][k],
                                sizeof bake->uvs[t][k]);
        }
    }
}

TEST(surfaces_without_pages_stay)
{
    quad_bake bake = quad_open(
        quad_write_glb(ASSET, "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":1}]"
                              ",\"materials\":[{ }],\"meshes\":[{\"primitives\":[" QUAD
                              "]},{\"primitives\":[ " QUAD " ]}]"),
        1);
    leave_out(&bake, 0);
    quad_write(&bake, ".glb");
    assert_string_equal(quad_text(&bake, "meshes/0"), "{\"primitives\":[" QUAD "]}");
    assert_string_equal(quad_text(&bake, "materials/0"), "{ }"); // it keeps its look
    assert_int_equal(quad_number(&bake, "meshes/1/primitives/0/material"), 1);
    assert_string_equal(quad_text(&bake, "materials/1/occlusionTexture"), "{\"index\":0}");
    assert_string_equal(quad_text(&bake, "meshes/2"), "");
    assert_int_equal(bake.result->surfaces[0].uv_sets, 0);
    require_corners(&bake, 0);
    quad_close(&bake);
}

TEST(a_mesh_is_copied_for_the_baked_node)
{
    for (int kept = 0; kept < 2; kept++) {
        quad_bake bake = quad_open(
            quad_write_glb(ASSET, kept ? "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},"
                                         "{\"mesh\":0}]," MESH(KEPT)
                                       : "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},"
                                         "{\"mesh\":0}]," MESH(QUAD)),
            1);
        leave_out(&bake, 0);
        bake.patch.corner_uvs = kept ? NULL : bake.patch.corner_uvs;
        quad_write(&bake, ".glb");
        assert_string_equal(quad_text(&bake, "meshes/0/primitives/0"), kept ? KEPT : QUAD);
        assert_string_equal(quad_text(&bake, "materials/0"), "{}");
        assert_int_equal(quad_number(&bake, "nodes/0/mesh"), 0);
        assert_int_equal(quad_number(&bake, "nodes/1/mesh"), 1);
        assert_int_equal(quad_number(&bake, "meshes/1/primitives/0/material"), 1);
        assert_string_equal(quad_text(&bake, "materials/1/occlusionTexture"), "{\"index\":0}");
        quad_close(&bake);
    }
}

TEST(instances_go_on_sharing_their_mesh)
{
    static const uint32_t originals[] = {0, 1, 0, 1}; // the second node is a mirror image
    quad_bake bake = quad_open(
        quad_write_glb(ASSET, "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":0,"
                              "\"scale\":[-1,1,1]}]," MESH(QUAD "," QUAD)),
        1);
    assert_true(bake.scene->surfaces[2].mirrored);
    share(&bake, originals);
    test_log_clear();
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, "nodes/0/mesh"), 0);
    assert_int_equal(quad_number(&bake, "nodes/1/mesh"), 0);
    assert_string_equal(quad_text(&bake, "meshes/1"), "");
    assert_string_equal(quad_text(&bake, "materials/1"), "");
    assert_false(test_log_has("shared-mesh")); // it was asked for
    require_corners(&bake, 0);
    quad_close(&bake);
}

TEST(instances_share_a_copy_where_one_is_left_out)
{
    static const uint32_t originals[] = {0, 1, 2, 1, 4, 4};
    quad_bake bake = quad_open(
        quad_write_glb(ASSET, "\"scenes\":[{\"nodes\":[0,1,2,3,4,5]}],\"nodes\":[{\"mesh\":0},"
                              "{\"mesh\":0},{\"mesh\":0},{\"mesh\":0},{\"mesh\":0},{\"mesh\":0}],"
                              "" MESH(QUAD)),
        1);
    leave_out(&bake, 0);
    leave_out(&bake, 2);
    share(&bake, originals);
    quad_write(&bake, ".glb");
    static const int meshes[] = {0, 1, 0, 1, 2, 2}; // of each node
    for (int node = 0; node < 6; node++) {
        char path[32];
        snprintf(path, sizeof path, "nodes/%d/mesh", node);
        assert_int_equal(quad_number(&bake, path), meshes[node]);
    }
    assert_string_equal(quad_text(&bake, "meshes/0/primitives/0"), QUAD);
    assert_string_equal(quad_text(&bake, "materials/0"), "{}");
    assert_string_equal(quad_text(&bake, "meshes/3"), "");
    assert_string_equal(quad_text(&bake, "materials/2"), ""); // both copies have one material
    require_corners(&bake, 0);
    quad_close(&bake);
}

TEST(half_a_surface_cannot_be_left_out)
{
    for (uint32_t t = 0; t < 2; t++) {
        quad_bake bake = quad_open(
            quad_write_glb(ASSET,
                           "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}]," MESH(QUAD)),
            1);
        bake.pages[t] = ALPI_NONE;
        assert_int_equal(alpi_scene_write_patched(bake.scene, &bake.patch,
                                                  test_path(test_folder(), "out.glb"), false),
                         ALP_ERROR_INVALID_ARGUMENT);
        quad_close(&bake);
    }
}
