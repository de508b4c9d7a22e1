// SPDX-License-Identifier: MIT
// Two modes in one picture: one left of a line, one right of it.
#ifndef VIEWER_DIVIDER_H
#define VIEWER_DIVIDER_H

#include "drawing.h"

/// The column of the line. @param share of the width, [0, 1]
uint32_t divider_column(double share, uint32_t width);
/// Develops both parts by the numbers of the left picture. The right part of its light becomes that
/// of the right picture.
/// @param column of the line   @param film, developed, light as of drawing_develop
alp_result divider_develop(const drawing *left, const drawing *right, uint32_t column,
                           alp_context *context, alp_film_options *film, alp_image **developed,
                           alp_image **light);

#endif
