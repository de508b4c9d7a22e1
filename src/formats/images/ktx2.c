// SPDX-License-Identifier: MIT
// KTX2 textures: RGBA16F, two dimensions, one level, Zstandard.
// After: Khronos KTX File Format Specification 2.0; Khronos Data Format Specification 1.3.
#include "formats/images/images.h"

#include "base/half.h"
#include "base/memory.h"
#include "base/tasks.h"

#include <zstd.h>

#include <stdio.h>
#include <string.h>

enum {
    VK_FORMAT_R16G16B16A16_SFLOAT = 97,
    SCHEME_ZSTANDARD = 2,
    HEADER_SIZE = 104, // identifier 12, header 36, index 32, one level 24
    BLOCK_SIZE = 24 + 4 * 16,
    COMPRESSION = 9,
    PIXEL_SIZE = 8,
    TEXT_SIZE = 256
};

static const uint8_t identifier[12] = {0xab, 'K',  'T',  'X',  ' ',  '2',
                                       '0',  0xbb, '\r', '\n', 0x1a, '\n'};

/// Little-endian bytes that grow inside a buffer of known size.
typedef struct cursor {
    uint8_t *at;
} cursor;

static void put(cursor *to, uint64_t value, int size)
{
    for (int i = 0; i < size; i++) {
        *to->at++ = (uint8_t)(value >> 8 * i);
    }
}

/// The basic descriptor block: four channels of 16-bit signed floats, linear, Rec. 709.
static void put_descriptor(cursor *to)
{
    enum { RGBSDA = 1, BT709 = 1, LINEAR = 1, VERSION = 2, SIGNED_FLOAT = 0xc0 };
    static const uint8_t channels[4] = {0, 1, 2, 15}; // R, G, B, A
    put(to, 4 + BLOCK_SIZE, 4);
    put(to, 0, 4); // Khronos, basic format
    put(to, VERSION | BLOCK_SIZE << 16, 4);
    put(to, RGBSDA | BT709 << 8 | LINEAR << 16, 4); // alpha is straight
    put(to, 0, 4);                                  // a texel is a block of its own
    put(to, PIXEL_SIZE, 8);
    for (uint32_t k = 0; k < 4; k++) {
        put(to, 16 * k | 15u << 16 | (uint32_t)(SIGNED_FLOAT | channels[k]) << 24, 4);
        put(to, 0, 4);
        put(to, 0xbf800000u, 4); // −1
        put(to, 0x3f800000u, 4); // 1
    }
}

/// Length, key, value with their zeros, and zeros up to a multiple of 4. Returns the size.
static size_t add_pair(uint8_t *at, const char *key, const char *value)
{
    const size_t key_size = strlen(key) + 1, value_size = strlen(value) + 1;
    cursor to = {at};
    put(&to, key_size + value_size, 4);
    memcpy(to.at, key, key_size);
    memcpy(to.at + key_size, value, value_size);
    return (4 + key_size + value_size + 3) / 4 * 4;
}

/// Sorted by key, as the format asks. `text` is all zero. Returns the size.
static size_t make_pairs(uint8_t text[TEXT_SIZE], float scale)
{
    char number[64], writer[64];
    snprintf(number, sizeof number, "%.0f", (double)scale);
    snprintf(writer, sizeof writer, "Alpenglow %s", alp_version());
    size_t size = add_pair(text, "KTXorientation", "rd"); // the first row is v = 0, the top in glTF
    size += add_pair(text + size, "KTXwriter", writer);
    return size + add_pair(text + size, "alpenglowScale", number);
}

static void put_header(cursor *to, const alp_image *image, size_t pairs_size, size_t level_size)
{
    const uint32_t pairs = HEADER_SIZE + 4 + BLOCK_SIZE;
    memcpy(to->at, identifier, sizeof identifier);
    to->at += sizeof identifier;
    put(to, VK_FORMAT_R16G16B16A16_SFLOAT, 4);
    put(to, 2, 4); // bytes of a component
    put(to, image->info.width, 4);
    put(to, image->info.height, 4);
    put(to, 0, 4); // no depth
    put(to, 0, 4); // no array
    put(to, 1, 4); // faces
    put(to, 1, 4); // levels
    put(to, SCHEME_ZSTANDARD, 4);
    put(to, HEADER_SIZE, 4);
    put(to, 4 + BLOCK_SIZE, 4);
    put(to, pairs, 4);
    put(to, pairs_size, 4);
    put(to, 0, 8); // no global data
    put(to, 0, 8);
    put(to, pairs + pairs_size, 8);
    put(to, level_size, 8);
    put(to, (uint64_t)PIXEL_SIZE * image->info.width * image->info.height, 8);
}

static void fill_halves(const alp_image *image, uint8_t *bytes)
{
    const float *pixels = image->pixels;
    const size_t count = 4 * (size_t)image->info.width * image->info.height;
    cursor to = {bytes};
    for (size_t i = 0; i < count; i++) {
        put(&to, alpi_half_from_float(pixels[i]), 2);
    }
}

static alp_result compress(const alp_image *image, float scale, const uint8_t *halves,
                           uint8_t **bytes, size_t *size)
{
    const size_t raw = (size_t)PIXEL_SIZE * image->info.width * image->info.height;
    uint8_t text[TEXT_SIZE] = {0};
    const size_t pairs_size = make_pairs(text, scale);
    const size_t before = HEADER_SIZE + 4 + BLOCK_SIZE + pairs_size;
    const size_t room = ZSTD_compressBound(raw);
    ALPI_TRY_NEW(image->context, *bytes, before + room);
    const size_t packed = ZSTD_compress(*bytes + before, room, halves, raw, COMPRESSION);
    if (ZSTD_isError(packed)) {
        alpi_release(image->context, *bytes);
        *bytes = NULL;
        return alpi_fail(image->context, ALP_ERROR_OUT_OF_MEMORY, "writing a KTX2 texture: %s",
                         ZSTD_getErrorName(packed));
    }
    cursor to = {*bytes};
    put_header(&to, image, pairs_size, packed);
    put_descriptor(&to);
    memcpy(to.at, text, pairs_size);
    *size = before + packed;
    return ALP_OK;
}

alp_result alpi_ktx2_encode(const alp_image *image, float scale, uint8_t **bytes, size_t *size)
{
    *bytes = NULL;
    *size = 0;
    if (image->info.component != ALP_COMPONENT_FLOAT || image->info.channels != 4) {
        return alpi_fail(image->context, ALP_ERROR_INVALID_ARGUMENT,
                         "KTX2 is written from float images of four channels");
    }
    ALP_TRY(alpi_tick(image->context, "write", 0, 1));
    uint8_t *halves = ALPI_NEW(image->context, uint8_t,
                               (size_t)PIXEL_SIZE * image->info.width * image->info.height);
    if (halves == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    fill_halves(image, halves);
    const alp_result result = compress(image, scale, halves, bytes, size);
    alpi_release(image->context, halves);
    return result;
}
