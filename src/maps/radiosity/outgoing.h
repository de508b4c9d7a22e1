// SPDX-License-Identifier: MIT
// What leaves the surfaces of a lightmap, from what arrives there.
#ifndef ALPI_MAPS_OUTGOING_H
#define ALPI_MAPS_OUTGOING_H

#include "maps/lightmap.h"

/// The radiance ρE/π + Lₑ that leaves the front of each covered texel of a page, E being that of
/// lightmap->irradiance_pages. ρ (alpi_surface_albedo, of a pane what it keeps) and Lₑ are means
/// over the surface inside the texel, of 4 × 4 points as far as the page's size allows. Cut parts
/// count for nothing. Alpha of a blended surface is left to whoever shows it: what it covers is
/// told as if it covered all.
/// @param out [height][width][4] RGB, and A = 1 in covered texels; others are 0
alp_result alpi_lightmap_outgoing(const alp_lightmap *lightmap, uint32_t page, float *out);

#endif
