// SPDX-License-Identifier: MIT
// What a viewer shows of a baked lightmap.
#ifndef ALPI_RENDER_LIGHTMAP_PIXEL_H
#define ALPI_RENDER_LIGHTMAP_PIXEL_H

#include "render/air.h"
#include "render/camera_rays.h"
#include "transport/gather/gather.h"

/// What a camera sees.
typedef struct alpi_shown {
    alpi_gather_scene surfaces;
    alpi_air air; // of a field; else without a medium
} alpi_shown;

/// Radiance Le + ρ/π · E of one pixel, with E from the map that `shown` reads, through air and
/// panes and before sky and sun; a mean over `samples` camera rays. Panes cost rays and no noise.
/// @param key   of the pixel's random numbers
/// @param pixel out: colour over what is covered, and alpha: 1 with a sky, else the share of light
///              that surfaces and air keep from coming through
void alpi_lightmap_pixel(const alpi_shown *shown, const alpi_view *view, uint32_t samples,
                         uint32_t key, uint32_t index, float pixel[4]);

#endif
