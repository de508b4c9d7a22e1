// SPDX-License-Identifier: MIT
// Occlusion in the red channel of the image that a material reads roughness and metalness from.
#include "orm_asset.h"

#include "formats/text/json_spans.h"
#include "maps/lightmap.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// Triangle and barycentrics of a point (s, t) of quad 0 (floor) or 1 (lid).
static uint32_t find_point(const orm_bake *p, int quad, double s, double t, float b[2])
{
    uint32_t first = p->scene->surfaces[quad].first_triangle;
    b[0] = (float)(s >= t ? s - t : s);
    b[1] = (float)(s >= t ? t : t - s);
    return s >= t ? first : first + 1;
}

/// The baked map at a texel's centre; false where it is not on the quad (range u0, v0, u1, v1).
static bool map_at(const orm_bake *p, int quad, const float *range, uint32_t x, uint32_t y,
                   float *value)
{
    double s = ((x + 0.5) / ORM_WIDTH - (double)range[0]) / (double)(range[2] - range[0]);
    double t = ((y + 0.5) / ORM_HEIGHT - (double)range[1]) / (double)(range[3] - range[1]);
    if (!(s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0)) {
        return false;
    }
    float b[2], rgb[3];
    uint32_t triangle = find_point(p, quad, s, t, b);
    alpi_lightmap_sample(p->lightmap, triangle, b[0], b[1], rgb);
    *value = rgb[0];
    return true;
}

/// Red is the map at the centres of texels that a quad covers, times 1 + strength (noise − 1).
static void check_red(const orm_bake *p, int quad, const float *range, float strength)
{
    const alp_image *image = orm_image(p, quad);
    int texels = 0, dark = 0;
    for (uint32_t y = 0; y < ORM_HEIGHT; y++) {
        for (uint32_t x = 0; x < ORM_WIDTH; x++) {
            float rgba[4], value = 0.0f;
            if (!map_at(p, quad, range, x, y, &value)) {
                continue;
            }
            alpi_image_pixel(image, x, y, rgba);
            double old = orm_asset_noise(x, y, 0) / 255.0;
            double wanted = (double)value * (1.0 + (double)strength * (old - 1.0));
            ASSERT_NEAR(rgba[0], wanted, 0.501 / 255.0); // rounding alone
            texels++;
            dark += value < 0.8f;
        }
    }
    assert_true(texels > 100);
    assert_true(quad == 1 || dark > 100); // the lid is there
}

/// Every channel but red is what it was, everywhere.
static void check_others(const orm_bake *p, int material, uint32_t channels)
{
    const alp_image *image = orm_image(p, material);
    uint32_t written = channels < 3 ? channels + 2 : channels;
    assert_int_equal(image->info.width, ORM_WIDTH);
    assert_int_equal(image->info.height, ORM_HEIGHT);
    assert_int_equal(image->info.channels, written);
    const uint8_t *pixels = image->pixels;
    for (uint32_t y = 0; y < ORM_HEIGHT; y++) {
        for (uint32_t x = 0; x < ORM_WIDTH; x++, pixels += written) {
            assert_int_equal(pixels[1], orm_asset_noise(x, y, channels < 3 ? 0 : 1));
            assert_int_equal(pixels[2], orm_asset_noise(x, y, channels < 3 ? 0 : 2));
            if (written == 4) {
                assert_int_equal(pixels[3], orm_asset_noise(x, y, channels - 1));
            }
        }
    }
}

// --- the image -----------------------------------------------------------------------------------

TEST(red_is_the_map_and_nothing_else_changes)
{
    for (uint32_t channels = 1; channels <= 4; channels++) {
        orm_asset asset = orm_asset_default();
        asset.channels = channels;
        orm_bake p = orm_start(&asset);
        orm_run(&p);
        assert_true(test_log_has("ao-packed"));
        assert_false(test_log_has("ao-not-packed"));
        check_red(&p, 0, asset.floor, 0.0f);
        check_red(&p, 1, asset.lid, 0.0f);
        check_others(&p, 0, channels);
        orm_check_meshes_kept(&p);
        assert_string_equal(orm_text(&p, "asset/extras/alpenglow/occlusion/ao_into"), "\"orm\"");
        // both materials read one new image, and nobody the old one, which goes
        assert_int_equal(p.result->image_count, 1);
        assert_string_equal(orm_text(&p, "materials/0/occlusionTexture"), "{\"index\":0}");
        assert_string_equal(orm_text(&p, "materials/1/occlusionTexture"), "{\"index\":0}");
        assert_string_equal(
            orm_text(&p, "materials/1/pbrMetallicRoughness/metallicRoughnessTexture/index"), "0");
        assert_string_equal(orm_text(&p, "textures/0"),
                            "{\"sampler\":0,\"source\":0,\"extras\":{\"alpenglow\":\"map\"}}");
        orm_stop(&p);
    }
}

TEST(texels_without_surface_take_the_nearest)
{
    orm_asset asset = orm_asset_default();
    orm_bake p = orm_start(&asset);
    orm_run(&p);
    const alp_image *image = orm_image(&p, 0);
    float far[4], near[4];
    alpi_image_pixel(image, 0, 0, far); // floor: from texel (7, 6) on
    alpi_image_pixel(image, 7, 6, near);
    assert_true(far[0] == near[0]);
    orm_stop(&p);
}

static void check_reader(int wrap)
{
    // v runs downwards from 0 to −1 and the texture repeats; the lid is three tiles off
    orm_asset asset = orm_asset_default();
    asset.wrap = wrap;
    asset.materials =
        "[{'pbrMetallicRoughness':{'metallicRoughnessTexture':{'index':0,'extensions':{"
        "'KHR_texture_transform':{'scale':[1,-1]}}}}},"
        "{'pbrMetallicRoughness':{'metallicRoughnessTexture':{'index':0}}}]";
    asset.lid[1] += 3.0f;
    asset.lid[3] += 3.0f;
    orm_bake p = orm_start(&asset);
    orm_run(&p);
    assert_string_equal(
        orm_text(&p, "materials/0/occlusionTexture"),
        "{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"scale\":[1,-1]}}}");
    double sum = 0.0;
    for (int i = 0; i < 2000; i++) {
        double s = 0.05 + 0.9 * (i % 50) / 49.0, t = 0.05 + 0.9 * (double)(i / 50 % 20) / 19.0;
        float b[2], rgb[3], seen;
        uint32_t triangle = find_point(&p, i / 1000, s, t, b);
        alpi_lightmap_sample(p.lightmap, triangle, b[0], b[1], rgb);
        assert_true(alpi_surface_occlusion(p.result, triangle, b[0], b[1], &seen));
        sum += fabs((double)(seen - rgb[0]));
        ASSERT_NEAR(seen, rgb[0], 0.15); // one texel of the edge of the lid's shadow
    }
    assert_true(sum / 2000.0 < 0.01); // noise of 64 rays, interpolated on two grids
    orm_stop(&p);
}

TEST(a_reader_sees_the_map)
{
    check_reader(10497); // repeat
    check_reader(33648); // mirrored repeat
}

TEST(a_texel_is_the_mean_of_finer_ones)
{
    orm_asset asset = orm_asset_default();
    orm_bake p = orm_start(&asset);
    p.options.atlas.size = 192;      // about 3 × 3 texels come to one of the image
    p.options.occlusion.samples = 4; // and differ
    p.options.sampling.accuracy = ALP_ADAPTIVE_OFF;
    orm_run(&p);
    const alp_image *image = orm_image(&p, 0);
    double squares = 0.0;
    int count = 0;
    for (uint32_t y = 8; y < 44; y++) {
        for (uint32_t x = 9; x < 49; x++, count++) {
            double sum = 0.0;
            for (int i = 0; i < 144; i++) {
                double u = (x + (i % 12 + 0.5) / 12.0) / ORM_WIDTH;
                double v = (y + (i / 12 + 0.5) / 12.0) / ORM_HEIGHT;
                float b[2], rgb[3];
                uint32_t triangle = find_point(&p, 0, (u - 0.1) / 0.6, (v - 0.125) / 0.8125, b);
                alpi_lightmap_sample(p.lightmap, triangle, b[0], b[1], rgb);
                sum += (double)rgb[0] / 144.0;
            }
            float rgba[4];
            alpi_image_pixel(image, x, y, rgba);
            squares += ((double)rgba[0] - sum) * ((double)rgba[0] - sum);
        }
    }
    // 1/255, as 9 points stand for 144; one point a texel gives the noise of single texels, 19/255
    assert_true(sqrt(squares / count) < 1.5 / 255.0);
    orm_stop(&p);
}

TEST(a_jpeg_becomes_a_png_with_the_same_green_and_blue)
{
    size_t size;
    unsigned char *bytes = orm_asset_jpeg(&size);
    orm_asset asset = orm_asset_default();
    asset.image = bytes;
    asset.image_size = size;
    orm_bake p = orm_start(&asset);
    orm_run(&p);
    assert_non_null(strstr(test_log_text(), "is a JPEG and becomes a PNG"));
    check_red(&p, 0, asset.floor, 0.0f);
    const uint8_t *old = p.scene->images[0]->pixels, *new = orm_image(&p, 0)->pixels;
    for (size_t i = 0; i < 3 * (size_t)ORM_WIDTH * ORM_HEIGHT; i++) {
        assert_true(i % 3 == 0 || old[i] == new[i]);
    }
    orm_stop(&p);
    free(bytes);
}

// --- an old map ----------------------------------------------------------------------------------

static const char with_old_map[] =
    "[{'name':'floor','occlusionTexture':{'index':0,'strength':0.5},"
    "'pbrMetallicRoughness':{'metallicRoughnessTexture':{'index':0}}},"
    "{'name':'lid','pbrMetallicRoughness':{'metallicRoughnessTexture':{'index':0}}}]";

TEST(multiply_takes_the_old_red_where_it_was_occlusion)
{
    orm_asset asset = orm_asset_default();
    asset.materials = with_old_map;
    orm_bake p = orm_start(&asset);
    p.options.existing_ao = ALP_EXISTING_AO_MULTIPLY;
    orm_run(&p);
    check_red(&p, 0, asset.floor, 0.5f);
    check_red(&p, 1, asset.lid, 0.0f); // red was junk there
    check_others(&p, 0, 4);
    // the map itself is not multiplied, or the old values would count twice
    alp_bake_options options = p.options;
    options.existing_ao = ALP_EXISTING_AO_REPLACE;
    options.output = NULL;
    alp_lightmap *alone = NULL;
    ASSERT_OK(p.context, alp_bake(p.scene, &options, &alone, NULL));
    assert_memory_equal(alp_lightmap_page(p.lightmap, 0, NULL, NULL),
                        alp_lightmap_page(alone, 0, NULL, NULL), sizeof(float[64][64][4]));
    alp_lightmap_destroy(alone);
    assert_string_equal(orm_text(&p, "materials/0/occlusionTexture"), "{\"index\":0}");
    orm_stop(&p);
}

/// The old map is read at other coordinates: one texel of the image for all points.
TEST(multiply_looks_up_an_old_map_elsewhere)
{
    orm_asset asset = orm_asset_default();
    char materials[512];
    snprintf(materials, sizeof materials,
             "[{'occlusionTexture':{'index':0,'extensions':{'KHR_texture_transform':{'scale':[0,0],"
             "'offset':[%.9f,%.9f]}}},'pbrMetallicRoughness':{'metallicRoughnessTexture':{'index':"
             "0}}},{'name':'lid'}]",
             0.5 / ORM_WIDTH, 7.5 / ORM_HEIGHT);
    asset.materials = materials;
    orm_bake p = orm_start(&asset);
    p.options.existing_ao = ALP_EXISTING_AO_MULTIPLY;
    orm_run(&p);
    double old = orm_asset_noise(0, 7, 0) / 255.0;
    assert_true(old < 0.9);
    for (uint32_t y = 8; y < 44; y++) {
        for (uint32_t x = 9; x < 49; x++) {
            float rgba[4], value = 0.0f;
            assert_true(map_at(&p, 0, asset.floor, x, y, &value));
            alpi_image_pixel(orm_image(&p, 0), x, y, rgba);
            ASSERT_NEAR(rgba[0], (double)value * old, 0.501 / 255.0);
        }
    }
    orm_stop(&p);
}

TEST(replace_forgets_the_old_red)
{
    orm_asset asset = orm_asset_default();
    asset.materials = with_old_map;
    orm_bake p = orm_start(&asset);
    orm_run(&p);
    check_red(&p, 0, asset.floor, 0.0f);
    orm_stop(&p);
}

TEST(keep_leaves_the_material_alone)
{
    orm_asset asset = orm_asset_default();
    asset.materials = with_old_map;
    orm_bake p = orm_start(&asset);
    p.options.existing_ao = ALP_EXISTING_AO_KEEP;
    orm_run(&p);
    assert_string_equal(orm_text(&p, "materials/0/occlusionTexture"),
                        "{\"index\":0,\"strength\":0.5}");
    assert_string_equal(
        orm_text(&p, "materials/0/pbrMetallicRoughness/metallicRoughnessTexture/index"), "0");
    assert_string_equal(orm_text(&p, "materials/1/occlusionTexture"), "{\"index\":1}");
    check_red(&p, 1, asset.lid, 0.0f);
    orm_check_meshes_kept(&p);
    orm_stop(&p);
}

TEST(an_occlusion_image_alone_will_do)
{
    orm_asset asset = orm_asset_default();
    asset.materials = "[{'occlusionTexture':{'index':0,'texCoord':0}},{'occlusionTexture':{"
                      "'index':0}}]";
    orm_bake p = orm_start(&asset);
    p.options.existing_ao = ALP_EXISTING_AO_MULTIPLY;
    orm_run(&p);
    check_red(&p, 0, asset.floor, 1.0f);
    check_others(&p, 0, 4);
    assert_string_equal(orm_text(&p, "materials/0/pbrMetallicRoughness"), "");
    orm_stop(&p);
}

// --- where it cannot be --------------------------------------------------------------------------

/// The floor is not packed, for a reason with these words.
static void check_refused(const orm_asset *asset, const char *words)
{
    orm_bake p = orm_start(asset);
    orm_run(&p);
    assert_true(test_log_has("ao-not-packed"));
    assert_non_null(strstr(test_log_text(), "material 0 (floor)"));
    assert_non_null(strstr(test_log_text(), "image 0 (orm)"));
    assert_non_null(strstr(test_log_text(), words));
    assert_string_not_equal(orm_text(&p, "meshes/0/primitives/0/attributes/TEXCOORD_1"), "");
    assert_string_equal(orm_text(&p, "materials/0/occlusionTexture/texCoord"), "1");
    assert_string_equal(
        orm_text(&p, "materials/0/pbrMetallicRoughness/metallicRoughnessTexture/index"), "0");
    float b[2], rgb[3], seen;
    uint32_t triangle = find_point(&p, 0, 0.5, 0.4, b);
    alpi_lightmap_sample(p.lightmap, triangle, b[0], b[1], rgb);
    assert_true(alpi_surface_occlusion(p.result, triangle, b[0], b[1], &seen));
    ASSERT_NEAR(seen, rgb[0], 1.0 / 255.0);
    orm_stop(&p);
}

TEST(what_cannot_be_packed_gets_a_map)
{
    orm_asset asset = orm_asset_default();
    asset.floor[2] = 2.5f;
    check_refused(&asset, "tiled: 2 triangles reach");
    asset = orm_asset_default();
    asset.floor[0] += 1.0f; // good where the texture repeats, but not where it is clamped
    asset.floor[2] += 1.0f;
    asset.wrap = 33071;
    check_refused(&asset, "tiled: 2 triangles reach");
    asset = orm_asset_default();
    asset.lid[0] = 0.6f; // a tenth of the image under both
    check_refused(&asset, "surfaces overlap");
    asset = orm_asset_default();
    asset.nodes = "'nodes':[{'mesh':0},{'mesh':0,'translation':[5,0,0]}],"
                  "'scenes':[{'nodes':[0,1]}],'scene':0";
    check_refused(&asset, "share one mesh");
    asset = orm_asset_default();
    asset.floor[2] = asset.floor[0];
    check_refused(&asset, "has no area in it");
    asset = orm_asset_default();
    asset.materials = "[{'name':'floor','pbrMetallicRoughness':{'metallicRoughnessTexture':{"
                      "'index':0,'texCoord':1}}},{'name':'lid'}]";
    check_refused(&asset, "has no TEXCOORD_1");
    asset = orm_asset_default();
    asset.floor[1] = -1e30f;
    check_refused(&asset, "tiled");
}

TEST(sixteen_bits_would_be_lost)
{
    static const uint8_t png[] = {
        // one pixel of three 16-bit channels
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
        0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x10, 0x02, 0x00, 0x00, 0x00, 0xc0,
        0xe7, 0x8f, 0x9d, 0x00, 0x00, 0x00, 0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x10,
        0x32, 0x09, 0xab, 0x98, 0xb5, 0x07, 0x00, 0x06, 0x27, 0x02, 0x6b, 0x0e, 0xde, 0xd5, 0x7a,
        0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    orm_asset asset = orm_asset_default();
    asset.image = png;
    asset.image_size = sizeof png;
    check_refused(&asset, "16 bits");
}

TEST(an_unreadable_image_is_left)
{
    orm_asset asset = orm_asset_default();
    asset.image = (const uint8_t *)"\xabKTX 20\xbb, say";
    asset.image_size = 13;
    char kept[600] = "";
    const char *written = getenv("ALPENGLOW_WRITTEN");
    snprintf(kept, sizeof kept, "%s", written != NULL ? written : "");
    assert_int_equal(unsetenv("ALPENGLOW_WRITTEN"), 0); // no validator likes that
    check_refused(&asset, "PNG, JPEG or WebP");
    assert_int_equal(kept[0] != '\0' ? setenv("ALPENGLOW_WRITTEN", kept, 1) : 0, 0);
}

/// One material is packed, the other is not: only the other's mesh gains coordinates.
TEST(each_material_goes_its_own_way)
{
    orm_asset asset = orm_asset_default();
    asset.materials = "[{'name':'floor','pbrMetallicRoughness':{'metallicRoughnessTexture':{"
                      "'index':0}}},{'name':'lid'}]";
    orm_bake p = orm_start(&asset);
    orm_run(&p);
    check_red(&p, 0, asset.floor, 0.0f);
    assert_string_equal(orm_text(&p, "meshes/0/primitives/0/attributes/TEXCOORD_1"), "");
    assert_string_not_equal(orm_text(&p, "meshes/1/primitives/0/attributes/TEXCOORD_1"), "");
    assert_string_equal(orm_text(&p, "materials/1/occlusionTexture/texCoord"), "1");
    orm_stop(&p);
}

/// A mesh that a node outside of the scene uses too is copied, and so is its material.
TEST(others_keep_the_old_image)
{
    orm_asset asset = orm_asset_default();
    asset.nodes = "'nodes':[{'mesh':0},{'mesh':1},{'mesh':0}],"
                  "'scenes':[{'nodes':[0,1]},{'nodes':[2]}],'scene':0";
    orm_bake p = orm_start(&asset);
    orm_run(&p);
    assert_string_equal(orm_text(&p, "meshes/0/primitives/0/material"), "0");
    assert_string_equal(orm_text(&p, "materials/0/occlusionTexture"), "");
    assert_string_equal(
        orm_text(&p, "materials/0/pbrMetallicRoughness/metallicRoughnessTexture/index"), "0");
    assert_string_equal(orm_text(&p, "nodes/0/mesh"), "2");
    assert_string_equal(orm_text(&p, "meshes/2/primitives/0/material"), "2");
    assert_string_equal(orm_text(&p, "materials/2/occlusionTexture"), "{\"index\":1}");
    orm_stop(&p);
}

TEST(nothing_to_pack_is_the_same_as_separate)
{
    orm_asset asset = orm_asset_default();
    asset.materials = "[{'name':'floor'},{'name':'lid'}]";
    orm_bake p = orm_start(&asset);
    orm_run(&p);
    assert_non_null(strstr(test_log_text(), "no baked material has an image"));
    size_t size, separate_size;
    unsigned char *bytes = test_read_file(p.path, &size);
    alp_bake_options options = p.options;
    options.ao_into = ALP_AO_INTO_SEPARATE;
    ASSERT_OK(p.context, alp_bake(p.scene, &options, NULL, NULL));
    unsigned char *separate = test_read_file(p.path, &separate_size);
    assert_int_equal(size, separate_size);
    assert_memory_equal(bytes, separate, size);
    free(bytes);
    free(separate);
    orm_stop(&p);
}

static bool note_rays(void *user, const alp_progress *progress)
{
    *(bool *)user |= strcmp(progress->stage, "build") == 0;
    return true;
}

TEST(a_gltf_gets_the_image_beside_it)
{
    orm_asset asset = orm_asset_default();
    orm_bake p = orm_start(&asset);
    snprintf(strrchr(p.path, '.'), 8, ".gltf");
    orm_run(&p);
    assert_string_equal(orm_text(&p, "images/0/uri"), "\"asset%20baked.orm.png\"");
    check_red(&p, 0, asset.floor, 0.0f);
    check_others(&p, 1, 4);
    // without leave to overwrite, the image stops the next bake before it begins
    alp_bake_options options = p.options;
    options.overwrite = false;
    char *ending = strrchr(p.path, '.');
    char image[1100];
    snprintf(image, sizeof image, "%.*s.orm.png", (int)(ending - p.path), p.path);
    assert_int_equal(remove(p.path), 0);
    snprintf(ending, 12, ".bake.bin");
    remove(p.path);
    snprintf(ending, 8, ".bin");
    assert_int_equal(remove(p.path), 0);
    snprintf(ending, 8, ".gltf");
    bool began = false;
    options.progress = note_rays;
    options.progress_user = &began;
    assert_int_equal(alp_bake(p.scene, &options, NULL, NULL), ALP_ERROR_IO);
    assert_false(began);
    assert_non_null(strstr(alp_context_message(p.context), ".orm.png"));
    assert_int_equal(remove(image), 0);
    ASSERT_OK(p.context, alp_bake(p.scene, &options, NULL, NULL));
    orm_stop(&p);
}

/// Whatever allocation fails, the bake says so, writes nothing, and loses no memory.
TEST(memory_may_run_out_anywhere)
{
    for (int refused = 0; refused < 2; refused++) {
        orm_asset asset = orm_asset_default();
        asset.floor[2] += refused ? 1.0f : 0.0f;
        orm_bake p = orm_start(&asset);
        p.options.output = p.path;
        p.options.atlas.size = 16;
        p.options.occlusion.samples = 1;
        int left = 1 << 20;
        alp_context *context = test_context_failing(&left);
        alp_scene *scene = NULL;
        ASSERT_OK(context, alp_scene_load(context, p.scene->name, &scene));
        alp_result result = ALP_ERROR_OUT_OF_MEMORY;
        for (int i = 0; result != ALP_OK; i += TEST_STEP) {
            assert_true(i < 10000);
            left = i;
            result = alp_bake(scene, &p.options, NULL, NULL);
            left = 1 << 20; // the allocator reads it
            FILE *file = fopen(p.path, "rb");
            assert_int_equal(file != NULL, result == ALP_OK);
            assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
            if (file != NULL) {
                fclose(file);
            }
        }
        alp_scene_destroy(scene);
        alp_context_destroy(context);
        orm_stop(&p);
    }
}

TEST(workers_do_not_change_a_bit)
{
    orm_asset asset = orm_asset_default();
    orm_bake p = orm_start(&asset);
    p.options.output = p.path;
    p.options.atlas.size = 192;
    p.options.occlusion.samples = 8;
    unsigned char *bytes[2];
    size_t sizes[2];
    for (int i = 0; i < 2; i++) {
        alp_context *context = test_context(i == 0 ? 1 : 7);
        alp_scene *scene = NULL;
        ASSERT_OK(context, alp_scene_load(context, p.scene->name, &scene));
        ASSERT_OK(context, alp_bake(scene, &p.options, NULL, NULL));
        bytes[i] = test_read_file(p.path, &sizes[i]);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(bytes[0], bytes[1], sizes[0]);
    free(bytes[0]);
    free(bytes[1]);
    orm_stop(&p);
}

TEST(an_unknown_choice_is_refused)
{
    orm_asset asset = orm_asset_default();
    orm_bake p = orm_start(&asset);
    p.options.ao_into = (alp_ao_into)7;
    assert_int_equal(alp_bake(p.scene, &p.options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    p.options.ao_into = ALP_AO_INTO_ORM; // vertices have no map
    p.options.output = p.path;
    p.options.atlas.mode = ALP_ATLAS_VERTEX;
    p.options.sampling.accuracy = ALP_ADAPTIVE_OFF;
    assert_int_equal(alp_bake(p.scene, &p.options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(alp_context_message(p.context), "no map to pack"));
    orm_stop(&p);
}
