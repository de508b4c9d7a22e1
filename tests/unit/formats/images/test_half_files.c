// SPDX-License-Identifier: MIT
// KTX2 byte by byte, as its specification has it, and half floats in OpenEXR.
#include "test_support.h"

#include "base/half.h"
#include "base/memory.h"
#include "formats/formats.h"

#include <stdio.h>
#include <stdlib.h>
#include <zstd.h>

enum { WIDTH = 37, HEIGHT = 11, PIXELS = WIDTH * HEIGHT };

static alp_image *make_image(alp_context *context)
{
    alp_image *image = NULL;
    const alp_image_info info = {WIDTH, HEIGHT, 4, ALP_COMPONENT_FLOAT};
    ASSERT_OK(context, alp_image_create(context, info, &image));
    float *pixels = alp_image_floats(image);
    for (uint32_t i = 0; i < 4 * PIXELS; i++) {
        pixels[i] = (float)(i * 2654435761u >> 8) * 0x1p-18f; // 0 to 64, more bits than a half
    }
    pixels[0] = ALPI_HALF_MAX;
    pixels[1] = 3e-7f; // not normal
    return image;
}

/// A little-endian number.
static uint64_t number(const uint8_t *bytes, int size)
{
    uint64_t value = 0;
    for (int i = 0; i < size; i++) {
        value |= (uint64_t)bytes[i] << 8 * i;
    }
    return value;
}

// --- KTX2 ----------------------------------------------------------------------------------------

typedef struct ktx2 {
    alp_context *context;
    alp_image *image;
    uint8_t *bytes;
    size_t size;
} ktx2;

static ktx2 encode(float scale)
{
    ktx2 k = {.context = test_context(1)};
    k.image = make_image(k.context);
    ASSERT_OK(k.context, alpi_ktx2_encode(k.image, scale, &k.bytes, &k.size));
    return k;
}

static void close_file(ktx2 *k)
{
    alpi_release(k->context, k->bytes);
    alp_image_destroy(k->image);
    alp_context_destroy(k->context);
}

TEST(the_header_says_what_it_is)
{
    ktx2 k = encode(1.0f);
    assert_memory_equal(k.bytes, "\xabKTX 20\xbb\r\n\x1a\n", 12);
    // vkFormat, typeSize, width, height, depth, layers, faces, levels, supercompression
    static const uint32_t header[] = {97, 2, WIDTH, HEIGHT, 0, 0, 1, 1, 2};
    for (size_t i = 0; i < sizeof header / sizeof *header; i++) {
        assert_int_equal(number(k.bytes + 12 + 4 * i, 4), header[i]);
    }
    assert_int_equal(number(k.bytes + 48, 4), 104); // descriptor: behind the only level
    assert_int_equal(number(k.bytes + 52, 4), 92);  // its size
    assert_int_equal(number(k.bytes + 56, 4), 196); // keys
    assert_int_equal(number(k.bytes + 64, 8), 0);   // no global data
    assert_int_equal(number(k.bytes + 72, 8), 0);
    const uint64_t keys = number(k.bytes + 60, 4), level = number(k.bytes + 80, 8);
    assert_int_equal(level, 196 + keys);
    assert_int_equal(number(k.bytes + 88, 8), k.size - level);
    assert_int_equal(number(k.bytes + 96, 8), 8 * PIXELS);
    close_file(&k);
}

TEST(the_descriptor_says_half_floats)
{
    static const uint8_t channels[] = {0, 1, 2, 15};
    ktx2 k = encode(1.0f);
    const uint8_t *d = k.bytes + 104;
    assert_int_equal(number(d, 4), 92);
    assert_int_equal(number(d + 4, 4), 0);   // Khronos, basic
    assert_int_equal(number(d + 8, 2), 2);   // version
    assert_int_equal(number(d + 10, 2), 88); // block
    assert_int_equal(d[12], 1);              // RGBSDA
    assert_int_equal(d[13], 1);              // BT.709
    assert_int_equal(d[14], 1);              // linear
    assert_int_equal(d[15], 0);              // straight alpha
    assert_int_equal(number(d + 16, 4), 0);  // block of 1 × 1 × 1 × 1
    assert_int_equal(number(d + 20, 8), 8);  // bytes of plane 0
    for (int i = 0; i < 4; i++) {
        const uint8_t *sample = d + 28 + 16 * i;
        assert_int_equal(number(sample, 2), 16 * i);
        assert_int_equal(sample[2], 15);                 // bits − 1
        assert_int_equal(sample[3], 0xc0 | channels[i]); // float, signed
        assert_int_equal(number(sample + 4, 4), 0);
        assert_int_equal(number(sample + 8, 4), 0xbf800000u);  // −1.0
        assert_int_equal(number(sample + 12, 4), 0x3f800000u); // 1.0
    }
    close_file(&k);
}

TEST(keys_are_sorted_and_state_the_scale)
{
    ktx2 k = encode(1048576.0f);
    char writer[64];
    snprintf(writer, sizeof writer, "Alpenglow %s", alp_version());
    const char *const pairs[][2] = {
        {"KTXorientation", "rd"}, {"KTXwriter", writer}, {"alpenglowScale", "1048576"}};
    const uint8_t *at = k.bytes + 196;
    for (int i = 0; i < 3; i++) {
        const size_t length = number(at, 4), key = strlen(pairs[i][0]) + 1;
        assert_int_equal(length, key + strlen(pairs[i][1]) + 1);
        assert_memory_equal(at + 4, pairs[i][0], key);
        assert_memory_equal(at + 4 + key, pairs[i][1], length - key);
        for (at += 4 + length; (at - k.bytes) % 4 != 0; at++) {
            assert_int_equal(*at, 0);
        }
    }
    assert_ptr_equal(at, k.bytes + number(k.bytes + 80, 8));
    close_file(&k);
}

TEST(pixels_come_back_as_the_nearest_halves)
{
    ktx2 k = encode(1.0f);
    const uint64_t level = number(k.bytes + 80, 8);
    uint8_t *halves = malloc(8 * PIXELS);
    assert_non_null(halves);
    assert_int_equal(ZSTD_decompress(halves, 8 * PIXELS, k.bytes + level, k.size - level),
                     8 * PIXELS);
    for (int i = 0; i < 4 * PIXELS; i++) {
        assert_int_equal(number(halves + 2 * i, 2),
                         alpi_half_from_float(alp_image_floats(k.image)[i]));
    }
    free(halves);
    close_file(&k);
}

TEST_WITH_CONTEXT(other_images_are_refused, 1)
{
    const alp_image_info infos[] = {{4, 4, 3, ALP_COMPONENT_FLOAT}, {4, 4, 4, ALP_COMPONENT_U8}};
    for (int i = 0; i < 2; i++) {
        alp_image *image = NULL;
        uint8_t *bytes = NULL;
        size_t size = 1;
        ASSERT_OK(context, alp_image_create(context, infos[i], &image));
        assert_int_equal(alpi_ktx2_encode(image, 1.0f, &bytes, &size), ALP_ERROR_INVALID_ARGUMENT);
        assert_null(bytes);
        assert_int_equal(size, 0);
        alp_image_destroy(image);
    }
}

// --- OpenEXR -------------------------------------------------------------------------------------

/// Colours come back times the scale, alpha as it was.
TEST_WITH_CONTEXT(exr_holds_the_nearest_halves, 1)
{
    alp_image *image = make_image(context);
    for (int way = 0; way < 4; way++) {
        const bool alpha = way % 2 != 0;
        const int channels = alpha ? 4 : 3;
        const float scale = way < 2 ? 1.0f : 4096.0f;
        alp_image *again = NULL;
        uint8_t *bytes = NULL;
        size_t size = 0;
        ASSERT_OK(context, alpi_exr_encode_half(image, scale, alpha, &bytes, &size));
        ASSERT_OK(context, alpi_exr_decode(context, "half", bytes, size, &again));
        const alp_image_info info = alp_image_get_info(again);
        assert_int_equal(info.width, WIDTH);
        assert_int_equal(info.height, HEIGHT);
        assert_int_equal(info.channels, channels);
        for (int i = 0; i < channels * PIXELS; i++) {
            const float wanted = alp_image_floats(image)[i / channels * 4 + i % channels];
            const float half = alpi_half_to_float(alpi_half_from_float(wanted));
            assert_true(alp_image_floats(again)[i] == half * (i % channels < 3 ? scale : 1.0f));
        }
        alp_image_destroy(again);
        alpi_release(context, bytes);
    }
    alp_image_destroy(image);
}

/// name, zero, type, zero, size 4, the float.
TEST_WITH_CONTEXT(exr_states_a_scale, 1)
{
    static const char attribute[] = "alpenglowScale\0float\0\4\0\0\0\0\0\200E"; // 4096
    alp_image *image = make_image(context);
    for (int scaled = 0; scaled < 2; scaled++) {
        uint8_t *bytes = NULL;
        size_t size = 0;
        ASSERT_OK(context,
                  alpi_exr_encode_half(image, scaled ? 4096.0f : 1.0f, false, &bytes, &size));
        int found = 0;
        for (size_t i = 0; i + sizeof attribute <= size; i++) {
            found += memcmp(bytes + i, attribute, sizeof attribute - 1) == 0;
        }
        assert_int_equal(found, scaled);
        alpi_release(context, bytes);
    }
    alp_image_destroy(image);
}
