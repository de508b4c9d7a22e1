// SPDX-License-Identifier: MIT
// Linear light as a screen shows it.
#ifndef ALPENGLOW_DISPLAY_H
#define ALPENGLOW_DISPLAY_H

#include <alpenglow/image.h>

ALP_BEGIN_DECLS

/// 8-bit sRGB picture of a linear float image (values clamped to [0,1]), over a grey background
/// where alpha is 0.
ALP_API ALP_NODISCARD alp_result alp_image_to_display(const alp_image *linear, alp_image **display);

ALP_END_DECLS

#endif
