// SPDX-License-Identifier: MIT
// KTX2 textures of half floats, written: RG16F or RGBA16F, two or three dimensions, one level.
// After: Khronos KTX File Format Specification 2.0; Khronos Data Format Specification 1.3.
#include "formats/images/ktx2_format.h"

#include "base/half.h"
#include "base/memory.h"
#include "base/tasks.h"

#include <zstd.h>

#include <stdio.h>
#include <string.h>

enum { COMPRESSION = 9, TEXT_SIZE = 256 };

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

/// The basic descriptor block: channels of 16-bit signed floats, linear, Rec. 709.
static void put_descriptor(cursor *to, uint32_t channel_count)
{
    enum { RGBSDA = 1, BT709 = 1, LINEAR = 1, VERSION = 2, SIGNED_FLOAT = 0xc0 };
    static const uint8_t channels[4] = {0, 1, 2, 15}; // R, G, B, A
    const uint32_t block = alpi_ktx2_descriptor_size(channel_count) - 4;
    put(to, 4 + block, 4);
    put(to, 0, 4); // Khronos, basic format
    put(to, VERSION | block << 16, 4);
    put(to, RGBSDA | BT709 << 8 | LINEAR << 16, 4); // alpha is straight
    put(to, 0, 4);                                  // a texel is a block of its own
    put(to, 2 * channel_count, 8);
    for (uint32_t k = 0; k < channel_count; k++) {
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

/// Pairs sorted by key, as the format wants them. `text` is all zero. Returns the size.
/// @param scale 0: the texture is no picture, and so has neither an orientation nor a scale
static size_t make_pairs(uint8_t text[TEXT_SIZE], float scale)
{
    char number[64], writer[64];
    snprintf(number, sizeof number, "%.0f", (double)scale);
    snprintf(writer, sizeof writer, "Alpenglow %s", alp_version());
    size_t size = 0;
    if (scale > 0.0f) { // the first row is v = 0, the top in glTF
        size += add_pair(text, "KTXorientation", "rd");
    }
    size += add_pair(text + size, "KTXwriter", writer);
    return scale > 0.0f ? size + add_pair(text + size, "alpenglowScale", number) : size;
}

/// Places in the file.
typedef struct plan {
    uint32_t pairs, pairs_size;
    size_t level, level_size;
} plan;

static void put_header(cursor *to, const alpi_half_texture *texture, bool zstandard, const plan *p)
{
    memcpy(to->at, alpi_ktx2_identifier, ALPI_KTX2_IDENTIFIER_SIZE);
    to->at += ALPI_KTX2_IDENTIFIER_SIZE;
    put(to, alpi_ktx2_format(texture->channels), 4);
    put(to, 2, 4); // bytes of a component
    put(to, texture->width, 4);
    put(to, texture->height, 4);
    put(to, texture->depth, 4);
    put(to, 0, 4); // no array
    put(to, 1, 4); // faces
    put(to, 1, 4); // levels
    put(to, zstandard ? ALPI_KTX2_ZSTANDARD : ALPI_KTX2_PLAIN, 4);
    put(to, ALPI_KTX2_HEADER_SIZE, 4);
    put(to, alpi_ktx2_descriptor_size(texture->channels), 4);
    put(to, p->pairs, 4);
    put(to, p->pairs_size, 4);
    put(to, 0, 8); // no global data
    put(to, 0, 8);
    put(to, p->level, 8);
    put(to, p->level_size, 8);
    put(to, alpi_half_texture_size(texture), 8);
}

/// The level, into `room` bytes. @return its size, or an error of Zstandard
static size_t put_level(const alpi_half_texture *texture, bool zstandard, uint8_t *at, size_t room)
{
    const size_t raw = alpi_half_texture_size(texture);
    if (zstandard) {
        return ZSTD_compress(at, room, texture->texels, raw, COMPRESSION);
    }
    memcpy(at, texture->texels, raw);
    return raw;
}

static alp_result write_texture(alp_context *context, const alpi_half_texture *texture,
                                bool zstandard, float scale, uint8_t **bytes, size_t *size)
{
    uint8_t text[TEXT_SIZE] = {0};
    const size_t raw = alpi_half_texture_size(texture);
    const size_t room = zstandard ? ZSTD_compressBound(raw) : raw;
    plan p = {.pairs = ALPI_KTX2_HEADER_SIZE + alpi_ktx2_descriptor_size(texture->channels)};
    p.pairs_size = (uint32_t)make_pairs(text, scale);
    p.level = p.pairs + p.pairs_size;
    if (!zstandard) { // texels begin at a multiple of their size
        p.level = (p.level + ALPI_KTX2_ALIGNMENT - 1) / ALPI_KTX2_ALIGNMENT * ALPI_KTX2_ALIGNMENT;
    }
    ALPI_TRY_NEW(context, *bytes, p.level + room);
    p.level_size = put_level(texture, zstandard, *bytes + p.level, room);
    if (ZSTD_isError(p.level_size)) {
        alpi_release(context, *bytes);
        *bytes = NULL;
        return alpi_fail(context, ALP_ERROR_OUT_OF_MEMORY, "writing a KTX2 texture: %s",
                         ZSTD_getErrorName(p.level_size));
    }
    cursor to = {*bytes};
    put_header(&to, texture, zstandard, &p);
    put_descriptor(&to, texture->channels);
    memcpy(to.at, text, p.pairs_size);
    *size = p.level + p.level_size;
    return ALP_OK;
}

alp_result alpi_ktx2_write(alp_context *context, const alpi_half_texture *texture, bool zstandard,
                           uint8_t **bytes, size_t *size)
{
    *bytes = NULL;
    *size = 0;
    if (alpi_half_texture_size(texture) == 0) {
        return alpi_fail(context, ALP_ERROR_LIMIT, "a texture of %u x %u x %u texels is too large",
                         texture->width, texture->height, texture->depth);
    }
    return write_texture(context, texture, zstandard, 0.0f, bytes, size);
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

alp_result alpi_ktx2_encode(const alp_image *image, float scale, uint8_t **bytes, size_t *size)
{
    *bytes = NULL;
    *size = 0;
    if (image->info.component != ALP_COMPONENT_FLOAT || image->info.channels != 4) {
        return alpi_fail(image->context, ALP_ERROR_INVALID_ARGUMENT,
                         "KTX2 is written from float images of four channels");
    }
    ALP_TRY(alpi_tick(image->context, "write", 0, 1));
    alpi_half_texture texture = {
        .width = image->info.width, .height = image->info.height, .channels = image->info.channels};
    ALPI_TRY_NEW(image->context, texture.texels, alpi_half_texture_size(&texture));
    fill_halves(image, texture.texels);
    const alp_result result = write_texture(image->context, &texture, true, scale, bytes, size);
    alpi_release(image->context, texture.texels);
    return result;
}
