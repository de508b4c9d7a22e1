// SPDX-License-Identifier: MIT
// Nothing is left in a written file that the bake made useless, and nothing goes that something may
// still name: known references get their new numbers, unknown numbers keep what they may mean.
#include "quad_asset.h"

#include "formats/gltf/write/gltf_references.h"

#include <stdio.h>
#include <stdlib.h>

#define ASSET "{\"version\":\"2.0\"}"
#define SCENE "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"materials\":[{}],"
#define MATERIAL_QUAD                                                                              \
    "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},\"indices\":6,\"material\":0}"
#define MESH "\"meshes\":[{\"primitives\":[" MATERIAL_QUAD "]}]"

/// Bakes with both triangles apart, so that all arrays of the primitive are written anew.
static quad_bake write_parted(const char *more, const char *ending)
{
    char rest[4096];
    snprintf(rest, sizeof rest, SCENE "%s" MESH, more);
    quad_bake bake = quad_open(quad_write_glb(ASSET, rest), 1);
    quad_part_triangles(&bake);
    quad_write(&bake, ending);
    return bake;
}

/// Elements of an array, read by something in the written file, among those that were read before.
static size_t count_unread(const quad_bake *bake, alpi_gltf_kind kind, const char *name)
{
    const alpi_gltf_document *document = quad_new(bake);
    alpi_gltf_references found = {.context = bake->context};
    alpi_json_span root;
    assert_true(alpi_json_value(document->text, 0, document->text_size, &root));
    ASSERT_OK(bake->context, alpi_gltf_references_find(document->text, root, &found));
    const size_t count = alpi_gltf_count(document, name);
    bool *read = calloc(count + 1, sizeof *read);
    for (size_t i = 0; i < found.count; i++) {
        if (found.items[i].kind == kind && found.items[i].index < count) {
            read[found.items[i].index] = true;
        }
    }
    size_t unread = 0;
    for (size_t i = 0; i < count; i++) {
        unread += !read[i];
    }
    free(read);
    alpi_gltf_references_destroy(&found);
    return unread;
}

/// The quad has eleven accessors, four of which the primitive reads: these are split, and go. The
/// seven that nothing read stay, with their views.
TEST(what_a_bake_made_useless_goes)
{
    quad_bake bake = write_parted("", ".glb");
    assert_int_equal(alpi_gltf_count(quad_new(&bake), "accessors"), 11 - 4 + 5);
    assert_int_equal(count_unread(&bake, ALPI_GLTF_ACCESSORS, "accessors"), 7);
    assert_int_equal(count_unread(&bake, ALPI_GLTF_BUFFER_VIEWS, "bufferViews"), 0);
    assert_true(quad_new(&bake)->buffers[0].size <
                quad_old(&bake)->buffers[0].size + 6 * (12 + 12 + 8 + 8) + 12 + 256);
    quad_require_corners(&bake, 1);
    quad_close(&bake);
}

/// The BIN chunk of a .glb whose arrays are all written anew: no empty buffer, and no file of it.
TEST(an_empty_buffer_goes)
{
    static const char *const rest =
        SCENE "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,"
              "\"TEXCOORD_0\":2,\"JOINTS_0\":3,\"WEIGHTS_0\":4,\"_MINE\":5,\"_MATRIX\":9,"
              "\"COLOR_0\":10},\"indices\":6,\"targets\":[{\"POSITION\":7}],\"material\":0},"
              "{\"attributes\":{\"POSITION\":0},\"indices\":8,\"mode\":5,\"material\":0}]}]";
    quad_bake bake = quad_open(quad_write_glb(ASSET, rest), 1);
    quad_part_triangles(&bake);
    quad_write(&bake, ".gltf");
    assert_int_equal(alpi_gltf_count(quad_new(&bake), "buffers"), 1);
    assert_true(quad_number(&bake, "buffers/0/byteLength") > 0);
    assert_int_equal(count_unread(&bake, ALPI_GLTF_ACCESSORS, "accessors"), 0);
    quad_close(&bake);
}

/// Also where images of materials are replaced: base colours under light as emission.
TEST(textures_of_replaced_colours_go)
{
    static const float scales[] = {1.0f, 1.0f};
    static const char rest[] =
        "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"images\":[{\"uri\":\"data:image/"
        "png;base64,AA==\"},{\"uri\":\"data:image/png;base64,AA==\",\"name\":\"kept\"}],"
        "\"textures\":[{\"source\":0},{\"source\":1}],\"samplers\":[{}],\"materials\":[{"
        "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}},"
        "\"normalTexture\":{\"index\":1}}]," MESH;
    quad_bake bake = quad_open(quad_write_glb(ASSET, rest), 1);
    const alpi_light_patch light = {.pages = bake.patch.page_pngs,
                                    .page_sizes = bake.patch.page_png_sizes,
                                    .ending = ".png",
                                    .scales = scales,
                                    .units = "radiance"};
    bake.patch.light = &light;
    bake.patch.page_pngs = NULL;
    bake.patch.existing_ao = ALPI_EXISTING_AO_REPLACE;
    alpi_gltf_document *written = NULL;
    char path[1100];
    snprintf(path, sizeof path, "%s.out.glb", bake.path);
    ASSERT_OK(bake.context, alpi_scene_write_patched(bake.scene, &bake.patch, path, true));
    ASSERT_OK(bake.context, alpi_gltf_document_read(bake.context, path, &written));
    assert_int_equal(alpi_gltf_count(written, "images"), 2); // the normal map's and the light
    json_t *material = alpi_gltf_item(written, "materials", 0);
    json_t *normal = json_object_get(json_object_get(material, "normalTexture"), "index");
    assert_int_equal(json_integer_value(normal), 0);
    json_t *image = alpi_gltf_item(written, "images", 0);
    assert_string_equal(json_string_value(json_object_get(image, "name")), "kept");
    alpi_gltf_document_destroy(written);
    quad_close(&bake);
}

/// A number in something unknown keeps all elements up to it.
TEST(unknown_numbers_keep_elements)
{
    quad_bake bake = write_parted("\"extensionsUsed\":[\"EXT_none\"],\"extensions\":"
                                  "{\"EXT_none\":{\"accessor\":6}},",
                                  ".glb");
    assert_int_equal(alpi_gltf_count(quad_new(&bake), "accessors"), 11 + 5);
    quad_close(&bake);
    bake = write_parted("\"extensionsUsed\":[\"EXT_none\"],\"extensions\":"
                        "{\"EXT_none\":{\"pointer\":\"/accessors/1/count\"}},",
                        ".glb");
    assert_int_equal(alpi_gltf_count(quad_new(&bake), "accessors"), 11 + 5);
    quad_close(&bake);
}

/// Numbers of metadata are known, and so are pointers of animations; a path in extras is no
/// pointer.
TEST(known_numbers_follow)
{
    quad_bake bake = write_parted(
        "\"extensionsUsed\":[\"EXT_structural_metadata\",\"KHR_animation_pointer\"],"
        "\"extras\":{\"file\":\"/home/me/accessors\"},"
        "\"animations\":[{\"samplers\":[{\"input\":7,\"output\":7}],\"channels\":[{\"sampler\":0,"
        "\"target\":{\"path\":\"pointer\",\"extensions\":{\"KHR_animation_pointer\":{\"pointer\":"
        "\"/materials/0/alphaCutoff\"}}}}]}],"
        "\"extensions\":{\"EXT_structural_metadata\":{\"schema\":{\"id\":\"s\",\"classes\":{\"c\":"
        "{\"properties\":{\"values\":{\"type\":\"SCALAR\",\"count\":100}}}}},\"propertyTables\":"
        "[{\"class\":\"c\",\"count\":4,\"properties\":{\"values\":{\"values\":5}}}]}},",
        ".glb");
    const int view = quad_number(
        &bake, "extensions/EXT_structural_metadata/propertyTables/0/properties/values/values");
    assert_int_equal(alpi_gltf_count(quad_new(&bake), "accessors"), 11 - 4 + 5);
    char path[64];
    snprintf(path, sizeof path, "bufferViews/%d/byteLength", view);
    const int length = quad_number(&bake, path);
    alpi_json_span root, span;
    const alpi_gltf_document *old = quad_old(&bake);
    assert_true(alpi_json_value(old->text, 0, old->text_size, &root));
    assert_true(alpi_json_at(old->text, root, "bufferViews/5/byteLength", &span));
    assert_int_equal(length, strtol(old->text + span.begin, NULL, 10));
    assert_int_not_equal(view, 5); // views before it went
    quad_close(&bake);
}
