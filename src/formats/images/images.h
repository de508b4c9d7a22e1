// SPDX-License-Identifier: MIT
// Bytes ↔ image: PNG, JPEG, WebP, OpenEXR, Radiance HDR. KTX2 images are written only; KTX2
// textures of half floats are read and written.
#ifndef ALPI_FORMATS_IMAGES_H
#define ALPI_FORMATS_IMAGES_H

#include "base/image.h"

/// Decodes from memory; `name` is for messages. Limits: ALPI_IMAGE_PIXEL_LIMIT.
alp_result alpi_png_decode(alp_context *context, const char *name, const uint8_t *bytes,
                           size_t size, alp_image **image);
alp_result alpi_jpeg_decode(alp_context *context, const char *name, const uint8_t *bytes,
                            size_t size, alp_image **image);
/// Three channels, or four where it has alpha; animated ones are UNSUPPORTED.
alp_result alpi_webp_decode(alp_context *context, const char *name, const uint8_t *bytes,
                            size_t size, alp_image **image);
alp_result alpi_exr_decode(alp_context *context, const char *name, const uint8_t *bytes,
                           size_t size, alp_image **image);
/// Three channels; an exposure that the header states is taken out again.
alp_result alpi_hdr_decode(alp_context *context, const char *name, const uint8_t *bytes,
                           size_t size, alp_image **image);
/// By the first bytes.
alp_result alpi_image_decode(alp_context *context, const char *name, const uint8_t *bytes,
                             size_t size, alp_image **image);

/// Encodes to memory; *bytes is released by the caller. PNG takes bytes, EXR and HDR floats.
alp_result alpi_png_encode(const alp_image *image, uint8_t **bytes, size_t *size);
alp_result alpi_exr_encode(const alp_image *image, uint8_t **bytes, size_t *size);
/// Half floats of red, green and blue, and of alpha if wanted: nearest, ties to even. The header
/// says "alpenglowScale", what 1 of the colours stands for, where that is not 1; alpi_exr_decode
/// multiplies by it.
alp_result alpi_exr_encode_half(const alp_image *image, float scale, bool alpha, uint8_t **bytes,
                                size_t *size);
/// RGBA16F with the first row at the top, one level, Zstandard; halves as above, and so the key
/// "alpenglowScale", a power of two as text. Takes float images of four channels.
alp_result alpi_ktx2_encode(const alp_image *image, float scale, uint8_t **bytes, size_t *size);

/// Half floats in two or three dimensions, without mip levels.
typedef struct alpi_half_texture {
    uint32_t width, height, depth; // at least 1; depth 0: two dimensions
    uint32_t channels;             // 2 or 4
    uint8_t *texels;               // [depth][height][width][channels], little-endian halves
} alpi_half_texture;

/// Bytes of the texels; 0 if a size is 0 or the product does not fit.
size_t alpi_half_texture_size(const alpi_half_texture *texture);
/// KTX2 with RG16F or RGBA16F, one level, by Zstandard or as it is.
alp_result alpi_ktx2_write(alp_context *context, const alpi_half_texture *texture, bool zstandard,
                           uint8_t **bytes, size_t *size);
/// Reads such a file; others are UNSUPPORTED. The caller releases texture->texels.
/// @param name for messages
alp_result alpi_ktx2_read(alp_context *context, const char *name, const uint8_t *bytes, size_t size,
                          alpi_half_texture *texture);

/// Without alpha; what the format cannot hold is clamped, with a warning (hdr-range).
alp_result alpi_hdr_encode(const alp_image *image, uint8_t **bytes, size_t *size);

#endif
