// SPDX-License-Identifier: MIT
#ifndef ALPI_BASE_IMAGE_H
#define ALPI_BASE_IMAGE_H

#include "base/context.h"

#include <alpenglow/image.h>

enum { ALPI_IMAGE_SIDE_LIMIT = 65536 };
#define ALPI_IMAGE_PIXEL_LIMIT ((uint64_t)1 << 28)

/// A text of an image.
typedef struct alpi_image_text {
    char *key, *text;
    struct alpi_image_text *next;
} alpi_image_text;

struct alp_image {
    alp_context *context;
    alp_image_info info;
    void *pixels;           // uint8_t or float, [height][width][channels]
    alpi_image_text *texts; // in their order; NULL without one
    uint32_t more_owners;   // beside the first
};

/// The same image for one more owner, who destroys it and does not change it. NULL stays NULL.
alp_image *alpi_image_share(alp_image *image);

/// Releases the texts of an image.
void alpi_image_release_texts(alp_image *image);

/// Wrapping of a texture coordinate, as glTF names it.
typedef enum alpi_wrap { ALPI_WRAP_REPEAT = 0, ALPI_WRAP_CLAMP, ALPI_WRAP_MIRROR } alpi_wrap;

/// How a look-up reads an image.
typedef struct alpi_sampler {
    alpi_wrap wrap_u, wrap_v;
    bool srgb; // decode red, green and blue from sRGB, each texel before the mean, as glTF says
} alpi_sampler;

/// Bilinear look-up at (u, v), v = 0 at the top row, as glTF defines it; texel centres at
/// ((x+½)/W, (y+½)/H). Missing channels are filled: grey to RGB, alpha 1.
/// Bytes come out as value/255. A non-finite coordinate reads as 0.
void alpi_image_sample(const alp_image *image, float u, float v, alpi_sampler sampler,
                       float rgba[4]);

/// One pixel with channels filled as above; x and y must be inside.
void alpi_image_pixel(const alp_image *image, uint32_t x, uint32_t y, float rgba[4]);

/// sRGB transfer (IEC 61966-2-1): encoded [0, 1] → linear.
float alpi_srgb_to_linear(float encoded);
/// Continues a hash (base/hash.h) over shape and pixels.
uint64_t alpi_image_hash(uint64_t hash, const alp_image *image);
/// Linear → encoded [0, 1]; the input is clamped to [0, 1].
float alpi_linear_to_srgb(float linear);

#endif
