// SPDX-License-Identifier: MIT
// KTX2 textures of half floats, read: the kinds that ktx2.c writes. Any bytes may come.
// After: Khronos KTX File Format Specification 2.0.
#include "formats/images/ktx2_format.h"

#include "base/memory.h"

#include <zstd.h>

#include <string.h>

/// Zstandard makes at most one block of 128 KiB of 4 bytes.
#define ZSTANDARD_BLOCK ((uint64_t)128 << 10)
#define ZSTANDARD_BLOCK_LEAST 4

typedef struct header {
    uint32_t format, type_size, width, height, depth, layers, faces, levels, scheme;
    uint64_t level, level_size, raw_size;
} header;

static uint64_t number(const uint8_t *bytes, int size)
{
    uint64_t value = 0;
    for (int i = 0; i < size; i++) {
        value |= (uint64_t)bytes[i] << 8 * i;
    }
    return value;
}

size_t alpi_half_texture_size(const alpi_half_texture *texture)
{
    const uint32_t depth = texture->depth > 0 ? texture->depth : 1;
    size_t size = 2 * (size_t)texture->channels;
    if (__builtin_mul_overflow(size, texture->width, &size) ||
        __builtin_mul_overflow(size, texture->height, &size) ||
        __builtin_mul_overflow(size, depth, &size) || size > SIZE_MAX / 4) {
        return 0;
    }
    return size;
}

static header parse_header(const uint8_t *bytes)
{
    uint32_t words[9];
    for (int i = 0; i < 9; i++) {
        words[i] = (uint32_t)number(bytes + 12 + 4 * i, 4);
    }
    return (header){.format = words[0],
                    .type_size = words[1],
                    .width = words[2],
                    .height = words[3],
                    .depth = words[4],
                    .layers = words[5],
                    .faces = words[6],
                    .levels = words[7],
                    .scheme = words[8],
                    .level = number(bytes + 80, 8),
                    .level_size = number(bytes + 88, 8),
                    .raw_size = number(bytes + 96, 8)};
}

static alp_result check_kind(alp_context *context, const char *name, const header *h)
{
    if (h->format != ALPI_KTX2_RG16F && h->format != ALPI_KTX2_RGBA16F) {
        return alpi_fail(context, ALP_ERROR_UNSUPPORTED,
                         "%s: is KTX2 with vkFormat %u; only %d (RG16F) and %d (RGBA16F) are read",
                         name, h->format, ALPI_KTX2_RG16F, ALPI_KTX2_RGBA16F);
    }
    if (h->layers > 1 || h->faces != 1 || h->levels != 1) {
        return alpi_fail(
            context, ALP_ERROR_UNSUPPORTED,
            "%s: is KTX2 with %u layers, %u faces, %u levels; only one of each is read", name,
            h->layers, h->faces, h->levels);
    }
    if (h->scheme != ALPI_KTX2_PLAIN && h->scheme != ALPI_KTX2_ZSTANDARD) {
        return alpi_fail(context, ALP_ERROR_UNSUPPORTED,
                         "%s: is KTX2 with supercompression %u; only %d (none) and %d (Zstandard) "
                         "are read",
                         name, h->scheme, ALPI_KTX2_PLAIN, ALPI_KTX2_ZSTANDARD);
    }
    if (h->type_size != 2) {
        return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                         "%s: KTX2: typeSize is %u, for half floats it must be 2", name,
                         h->type_size);
    }
    return ALP_OK;
}

/// Sizes fit each other and the file, so that no more memory is taken than it can fill.
static alp_result check_sizes(alp_context *context, const char *name, const header *h, size_t size,
                              const alpi_half_texture *texture)
{
    const uint64_t raw = alpi_half_texture_size(texture);
    if (raw == 0) {
        return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                         "%s: KTX2: %u x %u x %u texels, which no texture has", name, h->width,
                         h->height, h->depth);
    }
    if (h->raw_size != raw) {
        return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                         "%s: KTX2: %llu bytes of texels are stated, the size of the texture gives "
                         "%llu",
                         name, (unsigned long long)h->raw_size, (unsigned long long)raw);
    }
    if (h->level < ALPI_KTX2_HEADER_SIZE || h->level > size || h->level_size > size - h->level) {
        return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                         "%s: KTX2: texels are at bytes %llu + %llu, the file has %zu: it is cut "
                         "off or damaged, copy it anew",
                         name, (unsigned long long)h->level, (unsigned long long)h->level_size,
                         size);
    }
    const uint64_t most = h->scheme == ALPI_KTX2_PLAIN
                              ? h->level_size
                              : (h->level_size / ZSTANDARD_BLOCK_LEAST + 1) * ZSTANDARD_BLOCK;
    if (raw > most || (h->scheme == ALPI_KTX2_PLAIN && raw != h->level_size)) {
        return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                         "%s: KTX2: %llu bytes cannot hold %llu bytes of texels", name,
                         (unsigned long long)h->level_size, (unsigned long long)raw);
    }
    return ALP_OK;
}

static alp_result fill(alp_context *context, const char *name, const header *h,
                       const uint8_t *bytes, alpi_half_texture *texture)
{
    const size_t raw = alpi_half_texture_size(texture), packed = (size_t)h->level_size;
    const uint8_t *level = bytes + h->level;
    if (h->scheme == ALPI_KTX2_ZSTANDARD && ZSTD_getFrameContentSize(level, packed) != raw) {
        return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                         "%s: KTX2: the Zstandard data does not state the size of the texels: the "
                         "file is damaged, copy it anew",
                         name);
    }
    ALPI_TRY_NEW(context, texture->texels, raw);
    if (h->scheme == ALPI_KTX2_PLAIN) {
        memcpy(texture->texels, level, raw);
        return ALP_OK;
    }
    const size_t done = ZSTD_decompress(texture->texels, raw, level, packed);
    if (ZSTD_isError(done) || done != raw) {
        return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                         "%s: KTX2: Zstandard: %s: the file is damaged, copy it anew", name,
                         ZSTD_isError(done) ? ZSTD_getErrorName(done) : "too few bytes");
    }
    return ALP_OK;
}

alp_result alpi_ktx2_read(alp_context *context, const char *name, const uint8_t *bytes, size_t size,
                          alpi_half_texture *texture)
{
    *texture = (alpi_half_texture){0};
    if (size < ALPI_KTX2_HEADER_SIZE ||
        memcmp(bytes, alpi_ktx2_identifier, ALPI_KTX2_IDENTIFIER_SIZE) != 0) {
        return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                         "%s: is not a KTX2 file (by its first bytes), or is cut off", name);
    }
    const header h = parse_header(bytes);
    ALP_TRY(check_kind(context, name, &h));
    alpi_half_texture read = {.width = h.width,
                              .height = h.height,
                              .depth = h.depth,
                              .channels = h.format == ALPI_KTX2_RG16F ? 2 : 4};
    ALP_TRY(check_sizes(context, name, &h, size, &read));
    const alp_result result = fill(context, name, &h, bytes, &read);
    if (result != ALP_OK) {
        alpi_release(context, read.texels);
        return result;
    }
    *texture = read;
    return ALP_OK;
}
