// SPDX-License-Identifier: MIT
// Which decoder an image's first bytes ask for. Names and MIME types of files lie.
#include "formats/formats.h"

#include <string.h>

static bool starts_with(const uint8_t *bytes, size_t size, const char *signature, size_t length)
{
    return size >= length && memcmp(bytes, signature, length) == 0;
}

alp_result alpi_image_decode(alp_context *context, const char *name, const uint8_t *bytes,
                             size_t size, alp_image **image)
{
    *image = NULL;
    if (starts_with(bytes, size, "\x89PNG\r\n\x1a\n", 8)) {
        return alpi_png_decode(context, name, bytes, size, image);
    }
    if (starts_with(bytes, size, "\xff\xd8\xff", 3)) {
        return alpi_jpeg_decode(context, name, bytes, size, image);
    }
    if (starts_with(bytes, size, "\x76\x2f\x31\x01", 4)) {
        return alpi_exr_decode(context, name, bytes, size, image);
    }
    return alpi_fail(context, ALP_ERROR_INVALID_DATA, "%s: is no PNG, JPEG or EXR image", name);
}
