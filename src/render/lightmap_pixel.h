// SPDX-License-Identifier: MIT
// What a viewer shows of a baked lightmap.
#ifndef ALPI_RENDER_LIGHTMAP_PIXEL_H
#define ALPI_RENDER_LIGHTMAP_PIXEL_H

#include "render/camera_rays.h"
#include "transport/gather/gather.h"

/// Radiance Le + ρ/π · E of one pixel, with E from the map that `from` reads, through panes and
/// before sky and sun; a mean over `samples` camera rays. Panes cost rays and no noise.
/// @param key   of the pixel's random numbers
/// @param pixel out: colour over what is covered, and alpha: 1 with a sky, else the share of light
///              that surfaces keep from coming through
void alpi_lightmap_pixel(const alpi_gather_scene *from, const alpi_view *view, uint32_t samples,
                         uint32_t key, uint32_t index, float pixel[4]);

#endif
