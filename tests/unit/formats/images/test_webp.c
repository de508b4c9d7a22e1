// SPDX-License-Identifier: MIT
// WebP, encoded by libwebp: pixels come back, in a glTF too (EXT_texture_webp), and what is
// damaged, moves or is too large is refused. KHR_texture_basisu is told by its name.
#include "pack_asset.h"
#include "test_gltf.h"

#include "base/memory.h"
#include "formats/formats.h"

#include <webp/encode.h>

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 13, HEIGHT = 7 };

/// A picture without loss. @param alpha whether it has any
static uint8_t *encode(int alpha, size_t *size)
{
    uint8_t pixels[HEIGHT][WIDTH][4], *bytes = NULL;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const uint8_t pixel[4] = {(uint8_t)(3 * i % 256), (uint8_t)(7 * i % 256),
                                  (uint8_t)(255 - i % 200), alpha ? (uint8_t)(1 + i % 255) : 255};
        memcpy(pixels[i / WIDTH][i % WIDTH], pixel, sizeof pixel);
    }
    *size = WebPEncodeLosslessRGBA(&pixels[0][0][0], WIDTH, HEIGHT, WIDTH * 4, &bytes);
    assert_true(*size > 0);
    return bytes;
}

TEST_WITH_CONTEXT(pixels_come_back, 1)
{
    for (int alpha = 0; alpha < 2; alpha++) {
        size_t size;
        uint8_t *bytes = encode(alpha, &size);
        alp_image *image = NULL;
        ASSERT_OK(context, alpi_image_decode(context, "a.webp", bytes, size, &image));
        assert_int_equal(image->info.width, WIDTH);
        assert_int_equal(image->info.height, HEIGHT);
        assert_int_equal(image->info.channels, alpha ? 4 : 3);
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            const uint8_t *p = alp_image_bytes(image) + i * image->info.channels;
            assert_int_equal(p[0], 3 * i % 256);
            assert_int_equal(p[1], 7 * i % 256);
            assert_int_equal(p[2], 255 - i % 200);
            assert_int_equal(alpha ? p[3] : 255, alpha ? 1 + i % 255 : 255);
        }
        alp_image_destroy(image);
        WebPFree(bytes);
    }
}

TEST_WITH_CONTEXT(damaged_ones, 1)
{
    size_t size;
    uint8_t *good = encode(1, &size), *bad = malloc(size);
    assert_non_null(bad);
    uint64_t seed = 1;
    alp_image *image = NULL;
    for (size_t cut = 0; cut < size; cut++) {
        uint8_t *copy = malloc(cut + 1); // as long as the data: a sanitizer looks on
        memcpy(copy, good, cut);
        assert_int_not_equal(alpi_webp_decode(context, "cut.webp", copy, cut, &image), ALP_OK);
        test_message_has(context, "cut.webp: WebP: ");
        free(copy);
    }
    for (int round = 0; round < 2000; round++) {
        memcpy(bad, good, size);
        for (int i = 0; i < 1 + round % 4; i++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u; // Knuth's MMIX
            bad[(seed >> 33) % size] = (uint8_t)(seed >> 20);
        }
        image = NULL;
        (void)!alpi_image_decode(context, "bad.webp", bad, size, &image);
        alp_image_destroy(image);
    }
    // A canvas of 16384 × 16385 pixels in an extended header; and one that moves.
    static const uint8_t large[30] = {'R', 'I', 'F', 'F', 22,  0,   0,  0, 'W', 'E',
                                      'B', 'P', 'V', 'P', '8', 'X', 10, 0, 0,   0,
                                      2,   0,   0,   0,   255, 63,  0,  0, 64,  0};
    assert_int_not_equal(alpi_webp_decode(context, "moves.webp", large, sizeof large, &image),
                         ALP_OK);
    test_message_has(context, "moves.webp: WebP: ");
    free(bad);
    WebPFree(good);
}

/// An extended header with the mark of frames that follow, as RIFF: that is all that is looked at.
TEST_WITH_CONTEXT(moving_ones, 1)
{
    static const uint8_t bytes[] = "RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\x02\0\0\0\x07\0\0\x07\0\0";
    alp_image *image = NULL;
    assert_int_equal(alpi_webp_decode(context, "a.webp", bytes, sizeof bytes - 1, &image),
                     ALP_ERROR_UNSUPPORTED);
    test_message_has(context, "a.webp: WebP: is animated");
}

/// A red factor times the texture; of `textures[0]` members are given.
static alp_scene *load_textured(alp_context *context, const char *texture)
{
    static const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static const float uvs[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    char rest[2048];
    size_t size;
    uint8_t *bytes = encode(0, &size);
    pack_asset *asset = pack_start();
    pack_accessor(asset, pack_view(asset, positions, sizeof positions, 0), 5126, 3, "VEC3",
                  ",'min':[0,0,0],'max':[1,1,0]");
    pack_accessor(asset, pack_view(asset, uvs, sizeof uvs, 0), 5126, 3, "VEC2", "");
    int view = pack_view(asset, bytes, size, 0);
    snprintf(rest, sizeof rest,
             "'images':[{'bufferView':%d,'mimeType':'image/webp'},{'uri':'none.png'}],"
             "'textures':[{%s}],'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{"
             "'index':0},'metallicFactor':0}}],'nodes':[{'mesh':0}],'meshes':[{'primitives':[{"
             "'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':0}]}]",
             view, texture);
    WebPFree(bytes);
    alp_scene *scene = NULL;
    test_log_clear();
    ASSERT_OK(context, alp_scene_load(context, pack_write(asset, rest), &scene));
    return scene;
}

TEST_WITH_CONTEXT(textures, 1)
{
    alp_scene *scene =
        load_textured(context, "'source':1,'extensions':{'EXT_texture_webp':{'source':0}}");
    assert_int_equal(scene->materials[0].base_color_texture.image, 0);
    assert_non_null(scene->images[0]);
    assert_int_equal(scene->images[0]->info.width, WIDTH);
    assert_false(test_log_has("image"));
    alpi_image_source source;
    ASSERT_OK(context, alpi_gltf_image_source(scene, 0, &source));
    assert_int_equal(source.encoding, ALPI_IMAGE_ENCODING_WEBP);
    alp_scene_destroy(scene);
    scene = load_textured(context, "'extensions':{'KHR_texture_basisu':{'source':0}}");
    assert_int_equal(scene->materials[0].base_color_texture.image, ALPI_NONE);
    assert_non_null(strstr(test_log_text(), "KHR_texture_basisu"));
    assert_non_null(strstr(test_log_text(), "its materials are read without this texture"));
    alp_scene_destroy(scene);
}
