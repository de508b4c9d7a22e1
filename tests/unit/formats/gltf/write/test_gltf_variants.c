// SPDX-License-Identifier: MIT
// References to materials that are copied: variants get copies with the map, animations a channel
// for each copy. Light as emission goes to no variant, which is told.
#include "quad_asset.h"

#include <stdio.h>

#define ASSET "{\"version\":\"2.0\"}"
#define ATTRIBUTES "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":6,\"material\":"
#define MAPPINGS                                                                                   \
    "\"extensions\":{\"KHR_materials_variants\":{\"mappings\":[{\"material\":1,\"variants\":[0]}," \
    "{\"material\":2,\"variants\":[1]}]}}}"
#define VARIANTS                                                                                   \
    "\"extensionsUsed\":[\"KHR_materials_variants\"],\"extensions\":{\"KHR_materials_variants\":"  \
    "{\"variants\":[{\"name\":\"Red\"},{\"name\":\"Blue\"}]}},"
#define MATERIALS "\"materials\":[{\"name\":\"floor\"},{\"name\":\"red\"},{\"name\":\"blue\"}],"

/// A plain primitive, and one with two variants, in meshes of their own.
static const char rest[] = VARIANTS MATERIALS
    "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":1}],\"meshes\":["
    "{\"primitives\":[" ATTRIBUTES "0}]},{\"primitives\":[" ATTRIBUTES "1," MAPPINGS "]}]";

static const float scales[] = {1.0f, 1.0f, 1.0f, 1.0f};

/// The texture that a material reads its map from; −1: none.
static int map_of(const quad_bake *bake, int material, const char *map)
{
    char path[96];
    snprintf(path, sizeof path, "materials/%d/%s/index", material, map);
    return quad_number(bake, path);
}

static int mapping(const quad_bake *bake, int primitive, int i)
{
    char path[128];
    snprintf(path, sizeof path,
             "meshes/1/primitives/%d/extensions/KHR_materials_variants/mappings/%d/material",
             primitive, i);
    return quad_number(bake, path);
}

TEST(variants_get_the_map)
{
    quad_bake bake = quad_open(quad_write_glb(ASSET, rest), 1);
    test_log_clear();
    quad_write(&bake, ".glb");
    assert_int_equal(mapping(&bake, 0, 0), 1);
    assert_int_equal(mapping(&bake, 0, 1), 2);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(map_of(&bake, i, "occlusionTexture"), 0);
    }
    assert_int_equal(quad_number(&bake, "materials/3/occlusionTexture/index"), -1);
    assert_false(test_log_has("variants"));
    quad_close(&bake);
}

/// Each piece switches between materials of its own page.
TEST(variants_of_several_pages)
{
    quad_bake bake = quad_open(quad_write_glb(ASSET, rest), 2);
    bake.pages[3] = 1;
    quad_write(&bake, ".glb");
    for (int piece = 0; piece < 2; piece++) {
        char path[64];
        snprintf(path, sizeof path, "meshes/1/primitives/%d/material", piece);
        const int own = quad_number(&bake, path);
        assert_int_equal(mapping(&bake, piece, 0), own);
        const int texture = map_of(&bake, own, "occlusionTexture");
        assert_true(texture >= 0);
        assert_int_equal(map_of(&bake, mapping(&bake, piece, 1), "occlusionTexture"), texture);
        snprintf(path, sizeof path, "materials/%d/name", mapping(&bake, piece, 1));
        assert_string_equal(quad_text(&bake, path), "\"blue\"");
    }
    assert_int_not_equal(mapping(&bake, 0, 1), mapping(&bake, 1, 1));
    quad_close(&bake);
}

/// The variant's material is shown by a primitive too that gets no map: there it stays as it was.
TEST(variants_that_others_use_are_copied)
{
    static const char shared[] = VARIANTS MATERIALS
        "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":1}],\"meshes\":["
        "{\"primitives\":[" ATTRIBUTES "2}]},{\"primitives\":[" ATTRIBUTES "1," MAPPINGS "]}]";
    quad_bake bake = quad_open(quad_write_glb(ASSET, shared), 1);
    bake.pages[0] = bake.pages[1] = ALPI_NONE;
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/material"), 2);
    assert_int_equal(map_of(&bake, 2, "occlusionTexture"), -1);
    assert_int_equal(mapping(&bake, 0, 1), 3);
    assert_int_equal(map_of(&bake, 3, "occlusionTexture"), 0);
    quad_close(&bake);
}

TEST(variants_of_light)
{
    static const struct {
        alpi_light_form form;
        const char *map;
        bool told;
    } cases[] = {{ALPI_LIGHT_FORM_MOZ, "extensions/MOZ_lightmap", false},
                 {ALPI_LIGHT_FORM_EMISSIVE, "emissiveTexture", true}};
    for (int i = 0; i < 2; i++) {
        quad_bake bake = quad_open(quad_write_glb(ASSET, rest), 1);
        const alpi_light_patch light = {.form = cases[i].form,
                                        .pages = bake.patch.page_pngs,
                                        .page_sizes = bake.patch.page_png_sizes,
                                        .ending = ".png",
                                        .scales = scales,
                                        .units = "irradiance"};
        bake.patch.light = &light;
        bake.patch.page_pngs = NULL;
        test_log_clear();
        quad_write(&bake, ".gltf");
        assert_true(map_of(&bake, mapping(&bake, 0, 0), cases[i].map) >= 0);
        assert_int_equal(map_of(&bake, mapping(&bake, 0, 1), cases[i].map) < 0, cases[i].told);
        assert_int_equal(test_log_has("variants"), cases[i].told);
        assert_int_equal(strstr(test_log_text(), "2 (blue)") != NULL, cases[i].told);
        quad_close(&bake);
    }
}

/// A second bake takes the place of the first, in the variants too.
TEST(variants_again)
{
    quad_bake first = quad_open(quad_write_glb(ASSET, rest), 2);
    first.pages[3] = 1;
    quad_write(&first, ".glb");
    quad_bake second = quad_open(first.path, 2);
    second.pages[3] = 1;
    quad_write(&second, ".glb");
    static const char *const kinds[] = {"materials", "textures", "images"};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(alpi_gltf_count(quad_new(&second), kinds[i]),
                         alpi_gltf_count(quad_new(&first), kinds[i]));
    }
    assert_string_equal(quad_text(&second, "meshes/1/primitives/0/attributes/TEXCOORD_1"), "");
    quad_close(&second);
    quad_close(&first);
}

// --- animations ----------------------------------------------------------------------------------

#define POINTER(pointer)                                                                           \
    "{\"sampler\":0,\"target\":{\"path\":\"pointer\",\"extensions\":{\"KHR_animation_pointer\":"   \
    "{\"pointer\":\"" pointer "\"}}}}"
#define ANIMATED(primitives)                                                                       \
    "\"extensionsUsed\":[\"KHR_animation_pointer\"],\"materials\":[{\"name\":\"pulse\"}],"         \
    "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":1}],\"meshes\":["            \
    "{\"primitives\":[" primitives "]},{\"primitives\":[" ATTRIBUTES "0}]}],"                      \
    "\"animations\":[{\"samplers\":[{\"input\":7,\"output\":7}],\"channels\":[" POINTER(           \
        "/materials/0/pbrMetallicRoughness/baseColorFactor") "," POINTER("/nodes/0/scale") "]}]"

static const char *pointer(const quad_bake *bake, int channel)
{
    char path[160];
    snprintf(path, sizeof path,
             "animations/0/channels/%d/target/extensions/KHR_animation_pointer/pointer", channel);
    return quad_text(bake, path);
}

TEST(animations_follow_copies)
{
    quad_bake bake = quad_open(quad_write_glb(ASSET, ANIMATED(ATTRIBUTES "0}")), 1);
    bake.pages[2] = bake.pages[3] = ALPI_NONE; // the second mesh shows the material as it was
    quad_write(&bake, ".glb");
    assert_int_equal(quad_number(&bake, "meshes/0/primitives/0/material"), 1);
    assert_string_equal(pointer(&bake, 0), "\"/materials/0/pbrMetallicRoughness/baseColorFactor\"");
    assert_string_equal(pointer(&bake, 1), "\"/nodes/0/scale\"");
    assert_string_equal(pointer(&bake, 2), "\"/materials/1/pbrMetallicRoughness/baseColorFactor\"");
    assert_string_equal(pointer(&bake, 3), "");
    assert_int_equal(quad_number(&bake, "animations/0/channels/2/sampler"), 0);
    quad_close(&bake);
}

TEST(animations_of_materials_in_place_stay)
{
    quad_bake bake = quad_open(quad_write_glb(ASSET, ANIMATED(ATTRIBUTES "0}")), 1);
    quad_write(&bake, ".glb");
    assert_string_equal(pointer(&bake, 2), "");
    quad_close(&bake);
}

/// Pointers of an extension that nobody here knows stay as they are, which is told.
TEST(unknown_pointers_at_copies_are_told)
{
    static const char rest_of[] =
        "\"extensionsUsed\":[\"EXT_none\"],\"extensions\":{\"EXT_none\":{\"moves\":"
        "\"/materials/0/alphaCutoff\"}},\"materials\":[{}],\"scenes\":[{\"nodes\":[0,1]}],"
        "\"nodes\":[{\"mesh\":0},{\"mesh\":1}],\"meshes\":[{\"primitives\":[" ATTRIBUTES
        "0}]},{\"primitives\":[" ATTRIBUTES "0}]}]";
    for (int i = 0; i < 2; i++) {
        quad_bake bake = quad_open(quad_write_glb(ASSET, rest_of), 1);
        if (i == 0) { // else the one material is edited where it stands
            bake.pages[2] = bake.pages[3] = ALPI_NONE;
        }
        test_log_clear();
        quad_write(&bake, ".glb");
        assert_int_equal(test_log_has("copies"), i == 0);
        assert_string_equal(quad_text(&bake, "extensions/EXT_none/moves"),
                            "\"/materials/0/alphaCutoff\"");
        quad_close(&bake);
    }
}

// --- unlit ---------------------------------------------------------------------------------------

TEST(occlusion_of_unlit_materials_is_told)
{
    static const char unlit[] =
        "\"extensionsUsed\":[\"KHR_materials_unlit\"],\"materials\":[{\"extensions\":"
        "{\"KHR_materials_unlit\":{}}}],\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[" ATTRIBUTES "0}]}]";
    for (int i = 0; i < 2; i++) {
        quad_bake bake = quad_open(quad_write_glb(ASSET, i == 0 ? unlit : rest), 1);
        test_log_clear();
        quad_write(&bake, ".glb");
        assert_int_equal(test_log_has("unlit"), i == 0);
        quad_close(&bake);
    }
}
