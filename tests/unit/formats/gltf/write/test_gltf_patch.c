// SPDX-License-Identifier: MIT
// What a patch does to small assets: which coordinate set, when vertices split, which materials and
// meshes are copied, and that the rest is byte for byte what it was.
#include "quad_asset.h"

#include "base/memory.h"
#include "formats/gltf/gltf_accessor.h"

#include <stdio.h>
#include <stdlib.h>

#define ASSET "{\"version\":\"2.0\"}"
#define ONE_NODE "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
#define MESH(primitives) "\"meshes\":[{\"primitives\":[" primitives "]}]"
#define QUAD "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":6,\"material\":0}"

/// Reads an accessor of the written file named at a path.
static alpi_gltf_values read_values(const quad_bake *bake, const char *path)
{
    alpi_gltf_values values;
    int accessor = quad_number(bake, path);
    assert_true(accessor >= 0);
    ASSERT_OK(bake->context, alpi_gltf_accessor_read(quad_new(bake), (size_t)accessor, &values));
    return values;
}

// --- text ----------------------------------------------------------------------------------------

TEST(strange_text_survives)
{
    const char *path = quad_write_glb(
        "{\"version\":\"2.0\" ,\"extras\" : {\"x\":[1.0e0, 1E2,-0.0,1e-5 ]} }",
        "\"extensionsUsed\":[\"EXT_none\"],\"extensions\":{\"EXT_none\":{\"a\":[ [ ] ,{ }]}},"
        "\"scenes\":[{\"nodes\":[0],\"name\":\"\\u0041\\\"\\\\\xc3\xa9\"}],\"scene\":0,"
        "\"nodes\":[{\"mesh\":0,\"extras\":7.50,\"scale\":[1.0e0,1E0,1.000]}],\n"
        "\"materials\" : [ {\"extras\":{\"deep\":{\"er\":[null,true ]}},\"name\":\"m\" } ],"
        "\"meshes\":[{\"extras\":\"}]\",\"primitives\":[ " QUAD " ] }],"
        "\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":"
        "\"translation\"}}],\"samplers\":[{\"input\":7,\"output\":7}]}]");
    quad_bake bake = quad_open(path, 1);
    quad_write(&bake, ".glb");
    assert_string_equal(quad_text(&bake, "asset/extras/x"), "[1.0e0, 1E2,-0.0,1e-5 ]");
    assert_string_equal(quad_text(&bake, "asset/extras/alpenglow"), "{\"version\":\"test\"}");
    assert_string_equal(quad_text(&bake, "scenes/0/name"), "\"\\u0041\\\"\\\\\xc3\xa9\"");
    quad_require_corners(&bake, 0);
    quad_close(&bake);
}

TEST(origin_is_stated)
{
    static const char *const assets[] = {
        ASSET, "{\"version\":\"2.0\",\"extras\":{}}",
        "{\"version\":\"2.0\",\"extras\":{\"alpenglow\":{\"old\":1},\"b\":2}}"};
    for (size_t i = 0; i < 3; i++) {
        quad_bake bake =
            quad_open(quad_write_glb(assets[i], ONE_NODE "\"materials\":[{}]," MESH(QUAD)), 1);
        quad_write(&bake, ".glb");
        assert_string_equal(quad_text(&bake, "asset/extras/alpenglow/version"), "\"test\"");
        assert_string_equal(quad_text(&bake, "asset/extras/alpenglow/old"), "");
        assert_string_equal(quad_text(&bake, "asset/extras/b"), i == 2 ? "2" : "");
        quad_close(&bake);
    }
    quad_bake bake = quad_open(quad_write_glb("{\"version\":\"2.0\",\"extras\":\"mine\"}",
                                              ONE_NODE "\"materials\":[{}]," MESH(QUAD)),
                               1);
    test_log_clear();
    quad_write(&bake, ".glb");
    assert_string_equal(quad_text(&bake, "asset/extras"), "\"mine\"");
    assert_true(test_log_has("extras"));
    quad_close(&bake);
}

// --- coordinates and vertices --------------------------------------------------------------------

TEST(the_first_free_set_is_taken)
{
    const char *path = quad_write_glb(
        ASSET, ONE_NODE "\"materials\":[{}],\"meshes\":[{\"primitives\":[" QUAD
                        ",{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2},\"material\":0},"
                        "{\"attributes\":{\"TEXCOORD_1\":2,\"POSITION\":0,\"TEXCOORD_0\":2},"
                        "\"indices\":6}]}]");
    quad_bake bake = quad_open(path, 1);
    quad_write(&bake, ".glb");
    assert_int_not_equal(quad_number(&bake, "meshes/0/primitives/0/attributes/TEXCOORD_0"), -1);
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/attributes/TEXCOORD_1"), -1);
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/1/attributes/TEXCOORD_0"), 2);
    assert_int_not_equal(quad_number(&bake, "meshes/0/primitives/1/attributes/TEXCOORD_1"), -1);
    assert_int_not_equal(quad_number(&bake, "meshes/0/primitives/2/attributes/TEXCOORD_2"), -1);
    // The sets differ, so the materials do; nothing needed a split.
    int first = quad_number(&bake, "meshes/0/primitives/0/material");
    int second = quad_number(&bake, "meshes/0/primitives/1/material");
    int third = quad_number(&bake, "meshes/0/primitives/2/material");
    assert_int_equal(first, 0);
    assert_int_equal(second, 1);
    assert_int_equal(third, 2);
    assert_string_equal(quad_text(&bake, "materials/0/occlusionTexture"), "{\"index\":0}");
    assert_string_equal(quad_text(&bake, "materials/1/occlusionTexture"),
                        "{\"index\":0,\"texCoord\":1}");
    assert_string_equal(quad_text(&bake, "materials/2"),
                        "{\"occlusionTexture\":{\"index\":0,\"texCoord\":2},"
                        "\"extras\":{\"alpenglow\":\"no material\"}}");
    // Read again it is the grey that the primitive was, not the metal that glTF's default is.
    alp_scene *again = bake.result;
    alp_scene_set_metals(again, ALP_METALS_BLACK);
    assert_int_equal(again->surface_count, 3);
    ASSERT_NEAR(alpi_surface_albedo(again, again->surfaces[0].first_triangle, 0.3f, 0.3f).x, 0, 0);
    ASSERT_NEAR(alpi_surface_albedo(again, again->surfaces[2].first_triangle, 0.3f, 0.3f).x, 0.5,
                1e-6);
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/indices"), 6);
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/attributes/POSITION"), 0);
    quad_close(&bake);
}

TEST(splits_carry_every_attribute)
{
    quad_bake bake = quad_open(quad_write_glb(ASSET, ONE_NODE MESH(RICH_QUAD)), 1);
    quad_part_triangles(&bake);
    quad_write(&bake, ".glb");
    quad_require_corners(&bake, 1);
    alpi_gltf_values indices = read_values(&bake, "meshes/0/primitives/0/indices");
    assert_int_equal(indices.count, 6);
    static const char *const names[] = {
        "attributes/POSITION",  "attributes/NORMAL", "attributes/TEXCOORD_0", "attributes/JOINTS_0",
        "attributes/WEIGHTS_0", "attributes/_MINE",  "targets/0/POSITION"};
    static const size_t accessors[] = {0, 1, 2, 3, 4, 5, 7};
    static const uint32_t corners[6] = {0, 1, 2, 0, 2, 3};
    for (size_t n = 0; n < 7; n++) {
        char path[128];
        snprintf(path, sizeof path, "meshes/0/primitives/0/%s", names[n]);
        alpi_gltf_values old, new = read_values(&bake, path);
        ASSERT_OK(bake.context, alpi_gltf_accessor_read(quad_old(&bake), accessors[n], &old));
        assert_int_equal(new.count, 6); // two vertices are shared by triangles that part
        assert_int_equal(new.component_type, old.component_type);
        size_t size = (size_t)old.components * old.component_size;
        for (uint32_t i = 0; i < 6; i++) {
            uint32_t vertex = alpi_gltf_values_index(&indices, i);
            assert_memory_equal(new.bytes + vertex *size, old.bytes + corners[i] * size, size);
        }
        alpi_release(bake.context, old.bytes);
        alpi_release(bake.context, new.bytes);
    }
    char path[64];
    snprintf(path, sizeof path, "accessors/%d/bufferView",
             quad_number(&bake, "meshes/0/primitives/0/attributes/_MINE"));
    snprintf(path, sizeof path, "bufferViews/%d/byteStride", quad_number(&bake, path));
    assert_int_equal(quad_number(&bake, path), 4); // three bytes, aligned
    snprintf(path, sizeof path, "accessors/%d/type",
             quad_number(&bake, "meshes/0/primitives/0/attributes/_MATRIX"));
    assert_string_equal(quad_text(&bake, path), "\"MAT2\"");
    alpi_release(bake.context, indices.bytes);
    quad_close(&bake);
}

TEST(strips_stay_until_they_must_split)
{
    const char *primitive =
        ONE_NODE MESH("{\"attributes\":{\"POSITION\":0},\"indices\":8,\"mode\":5}");
    quad_bake bake = quad_open(quad_write_glb(ASSET, primitive), 1);
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/mode"), 5);
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/indices"), 8);
    quad_require_corners(&bake, 0);
    quad_close(&bake);
    bake = quad_open(quad_write_glb(ASSET, primitive), 1);
    quad_part_triangles(&bake);
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/mode"), 4);
    quad_require_corners(&bake, 0);
    quad_close(&bake);
    // Not indexed: a fan 0 1 2, 0 2 3.
    bake = quad_open(
        quad_write_glb(ASSET, ONE_NODE MESH("{\"mode\":6,\"attributes\":{\"POSITION\":0}}")), 1);
    quad_part_triangles(&bake);
    quad_write(&bake, ".glb");
    assert_int_not_equal(quad_number(&bake, "meshes/0/primitives/0/indices"), -1);
    quad_require_corners(&bake, 0);
    quad_close(&bake);
}

TEST(mirrored_nodes_keep_their_winding)
{
    quad_bake bake = quad_open(
        quad_write_glb(ASSET,
                       "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"scale\":[-1,1,1]}],"
                       "\"materials\":[{}]," MESH(QUAD)),
        1);
    assert_true(bake.scene->surfaces[0].mirrored);
    quad_part_triangles(&bake);
    for (int k = 0; k < 3; k++) {
        bake.uvs[0][k][0] = 0.3f + 0.1f * (float)k; // each corner its own
    }
    quad_write(&bake, ".glb");
    quad_require_corners(&bake, 0);
    quad_close(&bake);
}

TEST(triangles_without_area_part_nothing)
{
    quad_bake bake = quad_open(quad_write_glb(ASSET, ONE_NODE "\"materials\":[{}]," MESH(QUAD)), 2);
    bake.scene->triangle_usable[1] = false; // as if it had no area
    quad_part_triangles(&bake);
    bake.pages[1] = 1;
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/indices"), 6);
    assert_string_equal(quad_text(&bake, "meshes/0/primitives/1"), "");
    quad_close(&bake);
}

// --- pages, materials, meshes --------------------------------------------------------------------

TEST(pages_split_primitives_and_materials)
{
    quad_bake bake =
        quad_open(quad_write_glb(ASSET, ONE_NODE
                                 "\"materials\":[{\"name\":\"red\",\"extras\":1.50}]," MESH(QUAD)),
                  3);
    bake.pages[1] = 2;
    quad_part_triangles(&bake);
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/material"), 0);
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/1/material"), 1);
    assert_string_equal(quad_text(&bake, "materials/1"),
                        "{\"name\":\"red\",\"extras\":1.50,\"occlusionTexture\":{\"index\":1}}");
    assert_int_equal(quad_number(&bake, "textures/1/source"), 1);
    assert_string_equal(quad_text(&bake, "textures/2"), ""); // page 1 is not used
    quad_require_corners(&bake, 0);
    quad_close(&bake);
}

TEST(one_material_on_one_page_is_not_copied)
{
    quad_bake bake =
        quad_open(quad_write_glb(
                      ASSET, "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":1}],"
                             "\"materials\":[{},{}],\"meshes\":[{\"primitives\":[" QUAD "]},"
                             "{\"primitives\":[" QUAD "]}]"),
                  1);
    bake.patch.occlusion_strength = 0.5f;
    quad_write(&bake, ".glb");
    assert_string_equal(quad_text(&bake, "materials/0/occlusionTexture"),
                        "{\"index\":0,\"strength\":0.5}");
    assert_string_equal(quad_text(&bake, "materials/1"), "{}");
    assert_string_equal(quad_text(&bake, "materials/2"), "");
    quad_close(&bake);
}

TEST(users_without_a_map_keep_their_material)
{
    quad_bake bake = quad_open(
        quad_write_glb(ASSET, ONE_NODE
                       "\"materials\":[{\"name\":\"both\"}],\"meshes\":[{\"primitives\":[" QUAD
                       ",{\"attributes\":{\"POSITION\":0},\"mode\":0,\"material\":0}]}]"),
        1);
    quad_write(&bake, ".glb");
    assert_string_equal(quad_text(&bake, "materials/0"), "{\"name\":\"both\"}");
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/material"), 1);
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/1/material"), 0);
    quad_close(&bake);
}

TEST(meshes_of_several_nodes_are_copied)
{
    const char *rest = "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":0,"
                       "\"translation\":[3,0,0]}],\"materials\":[{}]," MESH(QUAD);
    quad_bake bake = quad_open(quad_write_glb(ASSET, rest), 1);
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, "nodes/0/mesh"), 0);
    assert_int_equal(quad_number(&bake, "nodes/1/mesh"), 1);
    assert_int_equal(quad_number(&bake, "meshes/1/primitives/0/attributes/POSITION"), 0);
    assert_int_equal(quad_number(&bake, "meshes/1/primitives/0/indices"), 6);
    assert_int_not_equal(quad_number(&bake, "meshes/0/primitives/0/attributes/TEXCOORD_0"),
                         quad_number(&bake, "meshes/1/primitives/0/attributes/TEXCOORD_0"));
    quad_require_corners(&bake, 0);
    quad_close(&bake);
    // With splits, equal attributes are still stored once.
    bake = quad_open(quad_write_glb(ASSET, rest), 1);
    quad_part_triangles(&bake);
    quad_write(&bake, ".glb");
    assert_int_not_equal(quad_number(&bake, "meshes/0/primitives/0/attributes/POSITION"), 0);
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/attributes/POSITION"),
                     quad_number(&bake, "meshes/1/primitives/0/attributes/POSITION"));
    quad_require_corners(&bake, 0);
    quad_close(&bake);
}

TEST(nodes_of_other_scenes_keep_their_mesh)
{
    quad_bake bake =
        quad_open(quad_write_glb(
                      ASSET, "\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1]}],\"nodes\":[{\"mesh\":0},"
                             "{\"mesh\":0}],\"materials\":[{}]," MESH(QUAD)),
                  1);
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, "nodes/0/mesh"), 1);
    assert_int_equal(quad_number(&bake, "nodes/1/mesh"), 0);
    assert_string_equal(quad_text(&bake, "meshes/0/primitives/0"), QUAD);
    assert_string_equal(quad_text(&bake, "materials/0"), "{}");
    quad_require_corners(&bake, 0);
    quad_close(&bake);
}

TEST(kept_coordinates_change_materials_only)
{
    const char *primitive = "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2},\"material\":0}";
    char rest[1024];
    snprintf(
        rest, sizeof rest,
        "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":0}],"
        "\"materials\":[{}],\"meshes\":[{\"primitives\":[%s,{\"attributes\":{\"POSITION\":0}}]}]",
        primitive);
    quad_bake bake = quad_open(quad_write_glb(ASSET, rest), 1);
    bake.patch.corner_uvs = NULL;
    test_log_clear();
    quad_write(&bake, ".glb");
    assert_string_equal(quad_text(&bake, "meshes/0/primitives/0"), primitive);
    assert_string_equal(quad_text(&bake, "meshes/1"), "");
    assert_string_equal(quad_text(&bake, "materials/0/occlusionTexture"), "{\"index\":0}");
    assert_true(test_log_has("shared-mesh"));
    assert_true(test_log_has("no-uv-set")); // the second primitive has none
    quad_close(&bake);
}

#define OLD_MAP                                                                                    \
    "{\"index\":0,\"texCoord\":0,\"strength\":0.2,\"extensions\":{\"KHR_texture_transform\":"      \
    "{\"scale\":[2,2]}}}"

TEST(existing_maps_are_replaced_or_kept)
{
    const char *rest = ONE_NODE "\"extensionsUsed\":[\"KHR_texture_transform\"],\"textures\":[{}],"
                                "\"materials\":[{\"occlusionTexture\":" OLD_MAP
                                ",\"name\":\"m\"},{}],\"meshes\":[{\"primitives\":[" QUAD
                                ",{\"attributes\":{\"POSITION\":0},\"material\":1}]}]";
    quad_bake bake = quad_open(quad_write_glb(ASSET, rest), 1);
    quad_write(&bake, ".glb");
    assert_string_equal(quad_text(&bake, "materials/0"),
                        "{\"occlusionTexture\":{\"index\":0},\"name\":\"m\"}");
    quad_close(&bake);
    bake = quad_open(quad_write_glb(ASSET, rest), 1);
    bake.patch.existing_ao = ALPI_EXISTING_AO_KEEP;
    quad_write(&bake, ".glb");
    assert_string_equal(quad_text(&bake, "materials/0/occlusionTexture"), OLD_MAP);
    assert_string_equal(quad_text(&bake, "meshes/0/primitives/0"), QUAD);
    assert_string_equal(quad_text(&bake, "materials/1/occlusionTexture"), "{\"index\":1}");
    quad_close(&bake);
}
