// SPDX-License-Identifier: MIT
// Image files: the kind is known by the first bytes on reading, by the ending on writing.
#include "formats/images/images.h"

#include "base/file.h"
#include "base/memory.h"

#include <string.h>

/// Four floats for each pixel of the largest image, and some room for headers.
#define FILE_SIZE_LIMIT (ALPI_IMAGE_PIXEL_LIMIT * 16 + (1u << 24))

static bool begins_with(const uint8_t *bytes, size_t size, const char *magic, size_t length)
{
    return size >= length && memcmp(bytes, magic, length) == 0;
}

alp_result alpi_image_decode(alp_context *context, const char *name, const uint8_t *bytes,
                             size_t size, alp_image **image)
{
    *image = NULL;
    if (begins_with(bytes, size, "\x89PNG\r\n\x1a\n", 8)) {
        return alpi_png_decode(context, name, bytes, size, image);
    }
    if (begins_with(bytes, size, "\xff\xd8\xff", 3)) {
        return alpi_jpeg_decode(context, name, bytes, size, image);
    }
    if (begins_with(bytes, size, "RIFF", 4) && size >= 12 && memcmp(bytes + 8, "WEBP", 4) == 0) {
        return alpi_webp_decode(context, name, bytes, size, image);
    }
    if (begins_with(bytes, size, "\x76\x2f\x31\x01", 4)) {
        return alpi_exr_decode(context, name, bytes, size, image);
    }
    if (begins_with(bytes, size, "#?", 2)) {
        return alpi_hdr_decode(context, name, bytes, size, image);
    }
    return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                     "%s: is not a PNG, JPEG, WebP, OpenEXR or Radiance (.hdr) image (by its "
                     "first bytes)",
                     name);
}

alp_result alp_image_load(alp_context *context, const char *path, alp_image **image)
{
    if (image != NULL) {
        *image = NULL;
    }
    if (context == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (path == NULL || image == NULL) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT, "load image: %s is NULL",
                         path == NULL ? "the path" : "the output pointer");
    }
    uint8_t *bytes = NULL;
    size_t size = 0;
    ALP_TRY(alpi_file_read(context, path, FILE_SIZE_LIMIT, &bytes, &size));
    alp_result result = alpi_image_decode(context, path, bytes, size, image);
    alpi_release(context, bytes);
    return result;
}

static alp_result encode(const alp_image *image, const char *path, uint8_t **bytes, size_t *size)
{
    bool png = alpi_path_has_ending(path, ".png"), exr = alpi_path_has_ending(path, ".exr");
    if (!png && !exr && !alpi_path_has_ending(path, ".hdr")) {
        return alpi_fail(image->context, ALP_ERROR_INVALID_ARGUMENT,
                         "%s: images are written as .png, .exr or .hdr", path);
    }
    if (png != (image->info.component == ALP_COMPONENT_U8)) {
        return alpi_fail(image->context, ALP_ERROR_INVALID_ARGUMENT,
                         png ? "%s: a float image is saved as .exr or .hdr; convert it to 8 bits"
                               " for .png"
                             : "%s: an 8-bit image is saved as .png, a float one as .exr or .hdr",
                         path);
    }
    return png   ? alpi_png_encode(image, bytes, size)
           : exr ? alpi_exr_encode(image, bytes, size)
                 : alpi_hdr_encode(image, bytes, size);
}

alp_result alp_image_save(const alp_image *image, const char *path, bool overwrite)
{
    if (image == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (path == NULL) {
        return alpi_fail(image->context, ALP_ERROR_INVALID_ARGUMENT,
                         "save image: the path is NULL");
    }
    ALP_TRY(alpi_file_check_writable(image->context, path, overwrite));
    uint8_t *bytes = NULL;
    size_t size = 0;
    ALP_TRY(encode(image, path, &bytes, &size));
    alp_result result = alpi_file_write(image->context, path, overwrite, bytes, size);
    alpi_release(image->context, bytes);
    return result;
}
