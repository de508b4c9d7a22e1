// SPDX-License-Identifier: MIT
// Radiance that leaves the surfaces of a lightmap.
#ifndef ALPI_MAPS_OUTGOING_H
#define ALPI_MAPS_OUTGOING_H

#include "maps/lightmap.h"

/// The radiance ρE/π + Lₑ that leaves the front of each covered texel of a page, with the E of
/// lightmap->irradiance_pages. ρ (alpi_surface_albedo, times the kept share of panes) and Lₑ are
/// means over the surface inside the texel, of 4 × 4 points if the page's size allows. Parts that a
/// mask cuts out do not count. Alpha of blended surfaces is not applied: the viewer applies it.
/// @param out [height][width][4] RGB, and A = 1 in covered texels; others are 0
alp_result alpi_lightmap_outgoing(const alp_lightmap *lightmap, uint32_t page, float *out);

#endif
