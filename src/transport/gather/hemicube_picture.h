// SPDX-License-Identifier: MIT
// Pictures of hemicubes: what a point sees, and what each pixel counts for.
#ifndef ALPI_TRANSPORT_HEMICUBE_PICTURE_H
#define ALPI_TRANSPORT_HEMICUBE_PICTURE_H

#include "base/image.h"
#include "transport/gather/hemicube.h"

/// Multipliers of a pixel.
typedef enum alpi_hemicube_map {
    ALPI_HEMICUBE_MAP_PERSPECTIVE, // cos³ of the angle to the axis of the pixel's face: what a
                                   // pixel is smaller, seen from the point, than one in the face's
                                   // middle
    ALPI_HEMICUBE_MAP_LAMBERT,     // cosine of the angle to the normal
    ALPI_HEMICUBE_MAP_WEIGHT       // both: the exact weight over that of a pixel straight ahead,
                                   // 4 / (π n²)
} alpi_hemicube_map;

/// The cross of 2n × 2n pixels as a float image of R, G, B and coverage: 1 on faces, 0 in corners.
/// The caller destroys it. @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_hemicube_draw_map(const alpi_hemicube *cube, alpi_hemicube_map map,
                                  alp_image **image);

/// Radiance seen from a point, likewise; below the surface itself black.
/// @param weighted multiplied by ALPI_HEMICUBE_MAP_WEIGHT: the sum of the pixels is E n² / 4
/// @return ALP_OK; CANCELLED; OUT_OF_MEMORY
alp_result alpi_hemicube_draw_view(const alpi_hemicube_options *options,
                                   const alpi_receiver_point *point,
                                   const alpi_hemicube_frame *frame, bool weighted,
                                   alp_image **image);

#endif
