// SPDX-License-Identifier: MIT
// Linear images as 8-bit sRGB pictures.
#ifndef ALPENGLOW_DISPLAY_H
#define ALPENGLOW_DISPLAY_H

#include <alpenglow/image.h>

ALP_BEGIN_DECLS

/// Converts a linear float image to an 8-bit sRGB picture. Values are clamped to [0, 1]. Alpha
/// below 1 mixes in a grey background (byte 96). The same as alp_film_develop with default options.
/// @param display out: 3 channels of 8 bits, which the caller destroys; NULL on failure
/// @return as alp_film_develop
ALP_API ALP_NODISCARD alp_result alp_image_to_display(const alp_image *linear, alp_image **display);

ALP_END_DECLS

#endif
