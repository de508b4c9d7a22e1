// SPDX-License-Identifier: MIT
// Bytes ↔ image: PNG, JPEG, WebP, OpenEXR, Radiance HDR; KTX2 is written only.
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
/// Without alpha; what the format cannot hold is clamped, with a warning (hdr-range).
alp_result alpi_hdr_encode(const alp_image *image, uint8_t **bytes, size_t *size);

#endif
