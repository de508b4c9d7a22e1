// SPDX-License-Identifier: MIT
// WebP in memory → 8-bit images of three or four channels, by libwebp. The size is known and held
// against the limit before a pixel is decoded.
#include "base/memory.h"
#include "formats/images/images.h"

#include <webp/decode.h>

static alp_result fail(alp_context *context, const char *name, VP8StatusCode status)
{
    if (status == VP8_STATUS_OUT_OF_MEMORY) {
        return alpi_fail(context, ALP_ERROR_OUT_OF_MEMORY, "%s: WebP: no memory to decode it",
                         name);
    }
    return alpi_fail(context, ALP_ERROR_INVALID_DATA, "%s: WebP: %s", name,
                     status == VP8_STATUS_NOT_ENOUGH_DATA       ? "ends too early"
                     : status == VP8_STATUS_UNSUPPORTED_FEATURE ? "uses a feature that is not read"
                                                                : "is damaged");
}

static alp_result check(alp_context *context, const char *name,
                        const WebPBitstreamFeatures *features)
{
    uint64_t pixels = (uint64_t)features->width * (uint64_t)features->height;
    if (features->has_animation != 0) {
        return alpi_fail(context, ALP_ERROR_UNSUPPORTED,
                         "%s: WebP: is animated; only still images are read", name);
    }
    if (pixels > ALPI_IMAGE_PIXEL_LIMIT || features->width > ALPI_IMAGE_SIDE_LIMIT ||
        features->height > ALPI_IMAGE_SIDE_LIMIT) {
        return alpi_fail(context, ALP_ERROR_LIMIT,
                         "%s: WebP: has %d x %d pixels; the limits are 2^28, and %d in a row", name,
                         features->width, features->height, ALPI_IMAGE_SIDE_LIMIT);
    }
    return ALP_OK;
}

alp_result alpi_webp_decode(alp_context *context, const char *name, const uint8_t *bytes,
                            size_t size, alp_image **image)
{
    *image = NULL;
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config)) {
        return alpi_fail(context, ALP_ERROR_UNSUPPORTED, "%s: libwebp is of another version", name);
    }
    VP8StatusCode status = WebPGetFeatures(bytes, size, &config.input);
    if (status != VP8_STATUS_OK) {
        return fail(context, name, status);
    }
    ALP_TRY(check(context, name, &config.input));
    bool alpha = config.input.has_alpha != 0;
    alp_image_info info = {(uint32_t)config.input.width, (uint32_t)config.input.height,
                           alpha ? 4 : 3, ALP_COMPONENT_U8};
    alp_image *made = NULL;
    ALP_TRY(alp_image_create(context, info, &made));
    size_t row_size = (size_t)info.width * info.channels;
    config.output.colorspace = alpha ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA = (WebPRGBABuffer){
        .rgba = alp_image_bytes(made), .stride = (int)row_size, .size = row_size * info.height};
    status = WebPDecode(bytes, size, &config);
    WebPFreeDecBuffer(&config.output); // ours stays
    if (status != VP8_STATUS_OK) {
        alp_image_destroy(made);
        return fail(context, name, status);
    }
    *image = made;
    return ALP_OK;
}
