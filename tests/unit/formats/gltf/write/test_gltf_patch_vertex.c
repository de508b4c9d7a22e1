// SPDX-License-Identifier: MIT
// Values at vertices in small assets: which attribute, what becomes of colours that are there, when
// vertices split and meshes are copied, and that the rest is byte for byte what it was.
#include "quad_asset.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>

#define ASSET "{\"version\":\"2.0\"}"
#define ONE_NODE "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
#define MESH(attributes)                                                                           \
    "\"materials\":[{\"name\":\"m\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{" attributes   \
    "},\"indices\":6,\"material\":0}]}]"
#define POINT "\"POSITION\":0,\"NORMAL\":1"
#define FIRST "meshes/0/primitives/0/"

enum { VALUE_LIMIT = 16 };
static float values[VALUE_LIMIT];

/// A patch of these values; vertex v of the scene has 0.1 + 0.05 v.
static quad_bake open_bake(const char *path, alpi_vertex_attribute attribute)
{
    quad_bake bake = quad_open(path, 1);
    assert_true(bake.scene->vertex_count <= VALUE_LIMIT);
    for (uint32_t v = 0; v < VALUE_LIMIT; v++) {
        values[v] = 0.1f + 0.05f * (float)v;
    }
    bake.patch = (alpi_mesh_patch){.vertex_values = values,
                                   .vertex_attribute = attribute,
                                   .extras_json = "{\"version\":\"test\"}"};
    return bake;
}

static alpi_gltf_values read_values(const quad_bake *bake, const char *path)
{
    alpi_gltf_values read;
    int accessor = quad_number(bake, path);
    assert_true(accessor >= 0);
    ASSERT_OK(bake->context, alpi_gltf_accessor_read(quad_new(bake), (size_t)accessor, &read));
    return read;
}

/// Every corner of the read scene has the colour of the wanted value, alpha 1, at its old position.
static void require_colors(const quad_bake *bake)
{
    const alp_scene *a = bake->scene, *b = bake->result;
    assert_non_null(b->colors);
    for (uint32_t t = 0; t < a->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            uint32_t va = a->triangles[t][k], vb = b->triangles[t][k];
            assert_memory_equal(a->positions[va], b->positions[vb], sizeof a->positions[va]);
            for (int c = 0; c < 3; c++) {
                ASSERT_NEAR(b->colors[vb][c], values[va], 0.51 / 65535.0);
            }
            ASSERT_NEAR(b->colors[vb][3], 1.0, 0.0);
        }
    }
}

TEST(colors_are_added)
{
    quad_bake bake = open_bake(quad_write_glb(ASSET, ONE_NODE MESH(POINT)), ALPI_VERTEX_COLOR);
    quad_write(&bake, ".glb");
    require_colors(&bake);
    alpi_gltf_values colors = read_values(&bake, FIRST "attributes/COLOR_0");
    assert_int_equal(colors.count, 4);
    assert_int_equal(colors.components, 4);
    assert_int_equal(colors.component_type, 5123);
    assert_true(colors.normalized);
    alpi_release(bake.context, colors.bytes);
    assert_int_equal(quad_number(&bake, FIRST "attributes/POSITION"), 0);
    assert_int_equal(quad_number(&bake, FIRST "indices"), 6);
    assert_string_equal(quad_text(&bake, "materials"), "[{\"name\":\"m\"}]");
    assert_string_equal(quad_text(&bake, "textures"), "");
    assert_string_equal(quad_text(&bake, "asset/extras/alpenglow"), "{\"version\":\"test\"}");
    quad_close(&bake);
}

TEST(containers_of_every_kind)
{
    static const char *const endings[] = {".glb", ".gltf"};
    for (int from = 0; from < 2; from++) {
        for (int to = 0; to < 2; to++) {
            const char *rest = ONE_NODE MESH(POINT);
            quad_bake bake =
                open_bake(from == 0 ? quad_write_glb(ASSET, rest) : quad_write_gltf(ASSET, rest),
                          ALPI_VERTEX_COLOR);
            quad_write(&bake, endings[to]);
            require_colors(&bake);
            quad_close(&bake);
        }
    }
}

TEST(byte_colors_are_multiplied)
{
    quad_bake bake =
        open_bake(quad_write_glb(ASSET, ONE_NODE MESH(POINT ",\"COLOR_0\":10")), ALPI_VERTEX_COLOR);
    quad_write(&bake, ".glb");
    alpi_gltf_values colors = read_values(&bake, FIRST "attributes/COLOR_0");
    assert_int_equal(colors.component_type, 5123);
    assert_int_equal(colors.components, 4);
    for (uint32_t v = 0; v < 4; v++) {
        for (uint32_t k = 0; k < 4; k++) {
            double old = (50.0 + 40.0 * v + 10.0 * k) / 255.0;
            ASSERT_NEAR(alpi_gltf_values_float(&colors, v, k),
                        k < 3 ? old * (double)values[v] : old, 1.1 / 65535.0);
        }
    }
    alpi_release(bake.context, colors.bytes);
    quad_close(&bake);
}

TEST(float_colors_stay_floats)
{
    // Three components, (0, 0, 1) each.
    quad_bake bake =
        open_bake(quad_write_glb(ASSET, ONE_NODE MESH(POINT ",\"COLOR_0\":1")), ALPI_VERTEX_COLOR);
    quad_write(&bake, ".glb");
    alpi_gltf_values colors = read_values(&bake, FIRST "attributes/COLOR_0");
    assert_int_equal(colors.component_type, 5126);
    assert_int_equal(colors.components, 3);
    for (uint32_t v = 0; v < 4; v++) {
        ASSERT_NEAR(alpi_gltf_values_float(&colors, v, 0), 0.0, 0.0);
        ASSERT_NEAR(alpi_gltf_values_float(&colors, v, 2), values[v], 0.51 / 65535.0);
    }
    alpi_release(bake.context, colors.bytes);
    assert_int_equal(quad_number(&bake, FIRST "attributes/NORMAL"), 1);
    quad_close(&bake);
}

TEST(an_attribute_of_its_own_leaves_colors)
{
    quad_bake bake = open_bake(quad_write_glb(ASSET, ONE_NODE MESH(POINT ",\"COLOR_0\":10")),
                               ALPI_VERTEX_OCCLUSION);
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, FIRST "attributes/COLOR_0"), 10);
    alpi_gltf_values stored = read_values(&bake, FIRST "attributes/_OCCLUSION");
    assert_int_equal(stored.components, 1);
    assert_int_equal(stored.component_type, 5123);
    assert_true(stored.normalized);
    for (uint32_t v = 0; v < 4; v++) {
        ASSERT_NEAR(alpi_gltf_values_float(&stored, v, 0), values[v], 0.51 / 65535.0);
    }
    alpi_release(bake.context, stored.bytes);
    quad_close(&bake);
}

TEST(flat_triangles_part_where_values_differ)
{
    // Without normals the scene has three vertices a triangle.
    const char *rest = ONE_NODE MESH("\"POSITION\":0,\"COLOR_0\":10,\"TEXCOORD_0\":2");
    quad_bake bake = open_bake(quad_write_glb(ASSET, rest), ALPI_VERTEX_COLOR);
    assert_int_equal(bake.scene->vertex_count, 6);
    quad_write(&bake, ".glb");
    alpi_gltf_values colors = read_values(&bake, FIRST "attributes/COLOR_0");
    alpi_gltf_values indices = read_values(&bake, FIRST "indices");
    alpi_gltf_values uvs = read_values(&bake, FIRST "attributes/TEXCOORD_0");
    assert_int_equal(colors.count, 6);
    assert_int_equal(uvs.count, 6);
    static const uint32_t corners[6] = {0, 1, 2, 0, 2, 3};
    for (uint32_t i = 0; i < 6; i++) { // alpha: colours were not multiplied a second time
        uint32_t vertex = alpi_gltf_values_index(&indices, i);
        double old = (50.0 + 40.0 * corners[i]) / 255.0;
        ASSERT_NEAR(alpi_gltf_values_float(&colors, vertex, 0), old * (double)values[i],
                    1.1 / 65535.0);
        ASSERT_NEAR(alpi_gltf_values_float(&colors, vertex, 3), old + 30.0 / 255.0, 1.1 / 65535.0);
        ASSERT_NEAR(alpi_gltf_values_float(&uvs, vertex, 0), 0.25 * corners[i], 0.0);
    }
    alpi_release(bake.context, colors.bytes);
    alpi_release(bake.context, indices.bytes);
    alpi_release(bake.context, uvs.bytes);
    quad_close(&bake);
    // With equal values at the shared vertices nothing parts.
    bake = open_bake(quad_write_glb(ASSET, ONE_NODE MESH("\"POSITION\":0")), ALPI_VERTEX_COLOR);
    values[3] = values[0];
    values[4] = values[2];
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, FIRST "indices"), 6);
    assert_int_equal(quad_number(&bake, FIRST "attributes/POSITION"), 0);
    require_colors(&bake);
    quad_close(&bake);
}

TEST(meshes_of_several_nodes_are_copied)
{
    const char *rest = "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":0,"
                       "\"scale\":[-1,1,1]}]," MESH(POINT); // the second is mirrored
    quad_bake bake = open_bake(quad_write_glb(ASSET, rest), ALPI_VERTEX_COLOR);
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, "nodes/0/mesh"), 0);
    assert_int_equal(quad_number(&bake, "nodes/1/mesh"), 1);
    assert_int_equal(quad_number(&bake, "meshes/1/primitives/0/attributes/POSITION"), 0);
    require_colors(&bake);
    quad_close(&bake);
    // Equal values are stored once.
    bake = open_bake(quad_write_glb(ASSET, rest), ALPI_VERTEX_COLOR);
    for (int i = 0; i < 4; i++) {
        values[4 + i] = values[i];
    }
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/attributes/COLOR_0"),
                     quad_number(&bake, "meshes/1/primitives/0/attributes/COLOR_0"));
    require_colors(&bake);
    quad_close(&bake);
}

TEST(values_out_of_range_are_held)
{
    quad_bake bake = open_bake(quad_write_glb(ASSET, ONE_NODE MESH(POINT)), ALPI_VERTEX_COLOR);
    const float odd[4] = {NAN, -1.0f, 2.0f, 1.0f}, held[4] = {0.0f, 0.0f, 1.0f, 1.0f};
    memcpy(values, odd, sizeof odd);
    quad_write(&bake, ".glb");
    memcpy(values, held, sizeof held);
    require_colors(&bake);
    quad_close(&bake);
}

TEST(a_second_bake_into_colors_is_told)
{
    const char *asset = "{\"version\":\"2.0\",\"extras\":{\"alpenglow\":{\"occlusion\":"
                        "{\"vertex_attribute\":\"COLOR_0\"}}}}";
    const char *rest = ONE_NODE MESH(POINT ",\"COLOR_0\":10");
    for (int own = 0; own < 2; own++) {
        quad_bake bake =
            open_bake(quad_write_glb(asset, rest), own ? ALPI_VERTEX_OCCLUSION : ALPI_VERTEX_COLOR);
        test_log_clear();
        quad_write(&bake, ".glb");
        assert_int_equal(test_log_has("baked-twice"), !own);
        quad_close(&bake);
    }
}
