// SPDX-License-Identifier: MIT
// Images: storage, look-up, comparison.
#include "base/image.h"

#include "base/hash.h"
#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static size_t component_size(alp_component component)
{
    return component == ALP_COMPONENT_FLOAT ? sizeof(float) : 1;
}

alp_result alp_image_create(alp_context *context, alp_image_info info, alp_image **image)
{
    if (image == NULL || context == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *image = NULL;
    if (info.width == 0 || info.height == 0 || info.width > ALPI_IMAGE_SIDE_LIMIT ||
        info.height > ALPI_IMAGE_SIDE_LIMIT || info.channels < 1 || info.channels > 4 ||
        (info.component != ALP_COMPONENT_U8 && info.component != ALP_COMPONENT_FLOAT)) {
        return alpi_fail(
            context, ALP_ERROR_INVALID_ARGUMENT,
            "image of %u x %u pixels, %u channels: sides must be 1 to %d, channels 1 to 4",
            info.width, info.height, info.channels, ALPI_IMAGE_SIDE_LIMIT);
    }
    alp_image *i = ALPI_NEW(context, alp_image, 1);
    if (i == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    i->context = context;
    i->info = info;
    i->pixels = alpi_allocate(context, (size_t)info.width * info.height,
                              info.channels * component_size(info.component));
    if (i->pixels == NULL) {
        alpi_release(context, i);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *image = i;
    return ALP_OK;
}

alp_image *alpi_image_share(alp_image *image)
{
    if (image != NULL) {
        image->more_owners++;
    }
    return image;
}

void alp_image_destroy(alp_image *image)
{
    if (image != NULL && image->more_owners > 0) {
        image->more_owners--;
    } else if (image != NULL) {
        alpi_image_release_texts(image);
        alpi_release(image->context, image->pixels);
        alpi_release(image->context, image);
    }
}

alp_image_info alp_image_get_info(const alp_image *image)
{
    return image ? image->info : (alp_image_info){0};
}

uint8_t *alp_image_bytes(alp_image *image)
{
    return image && image->info.component == ALP_COMPONENT_U8 ? image->pixels : NULL;
}

float *alp_image_floats(alp_image *image)
{
    return image && image->info.component == ALP_COMPONENT_FLOAT ? image->pixels : NULL;
}

uint64_t alpi_image_hash(uint64_t hash, const alp_image *image)
{
    const alp_image_info i = image->info;
    const size_t size = i.component == ALP_COMPONENT_FLOAT ? sizeof(float) : 1;
    const uint32_t shape[] = {i.width, i.height, i.channels, (uint32_t)i.component};
    hash = alpi_hash_bytes(hash, shape, sizeof shape);
    return alpi_hash_bytes(hash, image->pixels, (size_t)i.width * i.height * i.channels * size);
}

const void *alp_image_pixels(const alp_image *image)
{
    return image != NULL ? image->pixels : NULL;
}

void alpi_image_pixel(const alp_image *image, uint32_t x, uint32_t y, float rgba[4])
{
    uint32_t channels = image->info.channels;
    size_t first = ((size_t)y * image->info.width + x) * channels;
    float c[4] = {0.0f, 0.0f, 0.0f, 1.0f};
    for (uint32_t k = 0; k < channels; k++) {
        c[k] = image->info.component == ALP_COMPONENT_FLOAT
                   ? ((const float *)image->pixels)[first + k]
                   : (float)((const uint8_t *)image->pixels)[first + k] / 255.0f;
    }
    bool grey = channels < 3;
    rgba[0] = c[0];
    rgba[1] = grey ? c[0] : c[1];
    rgba[2] = grey ? c[0] : c[2];
    rgba[3] = channels == 2 ? c[1] : channels == 4 ? c[3] : 1.0f;
}

/// Texel index of `i` in a row of n texels.
static uint32_t wrap_index(int64_t i, uint32_t n, alpi_wrap wrap)
{
    int64_t size = n;
    if (wrap == ALPI_WRAP_CLAMP) {
        return (uint32_t)(i < 0 ? 0 : i >= size ? size - 1 : i);
    }
    int64_t period = wrap == ALPI_WRAP_MIRROR ? 2 * size : size;
    int64_t r = i % period;
    r = r < 0 ? r + period : r;
    return (uint32_t)(r < size ? r : period - 1 - r);
}

static void sampled_pixel(const alp_image *image, uint32_t x, uint32_t y, bool srgb, float rgba[4])
{
    alpi_image_pixel(image, x, y, rgba);
    for (int k = 0; srgb && k < 3; k++) {
        rgba[k] = alpi_srgb_to_linear(rgba[k]);
    }
}

void alpi_image_sample(const alp_image *image, float u, float v, alpi_sampler sampler,
                       float rgba[4])
{
    // Coordinates far outside a 2^40-fold repeat have lost all their texels anyway.
    double limit = 0x1p40;
    double known_u = fabs((double)u) < limit ? (double)u : 0.0; // NaN is not below it either
    double known_v = fabs((double)v) < limit ? (double)v : 0.0;
    double x = known_u * image->info.width - 0.5, y = known_v * image->info.height - 0.5;
    double fx = floor(x), fy = floor(y);
    float wx = (float)(x - fx), wy = (float)(y - fy);
    uint32_t x0 = wrap_index((int64_t)fx, image->info.width, sampler.wrap_u);
    uint32_t x1 = wrap_index((int64_t)fx + 1, image->info.width, sampler.wrap_u);
    uint32_t y0 = wrap_index((int64_t)fy, image->info.height, sampler.wrap_v);
    uint32_t y1 = wrap_index((int64_t)fy + 1, image->info.height, sampler.wrap_v);
    float a[4], b[4], c[4], d[4];
    sampled_pixel(image, x0, y0, sampler.srgb, a);
    sampled_pixel(image, x1, y0, sampler.srgb, b);
    sampled_pixel(image, x0, y1, sampler.srgb, c);
    sampled_pixel(image, x1, y1, sampler.srgb, d);
    for (int k = 0; k < 4; k++) {
        float top = a[k] + wx * (b[k] - a[k]);
        float bottom = c[k] + wx * (d[k] - c[k]);
        rgba[k] = top + wy * (bottom - top);
    }
}

float alpi_srgb_to_linear(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f : powf((encoded + 0.055f) / 1.055f, 2.4f);
}

float alpi_linear_to_srgb(float linear)
{
    float l = linear > 0.0f ? (linear < 1.0f ? linear : 1.0f) : 0.0f;
    return l <= 0.0031308f ? 12.92f * l : 1.055f * powf(l, 1.0f / 2.4f) - 0.055f;
}
