// SPDX-License-Identifier: MIT
// Single samples aimed at a polygon with more care than the loops over all lanes take, which send
// rays to points of even density over its area.
#ifndef ALPI_TRANSPORT_DIRECT_POLYGON_AIM_H
#define ALPI_TRANSPORT_DIRECT_POLYGON_AIM_H

#include "transport/direct/direct_polygon_kernel.h"

/// Aims sample s of a lane anew, from its u and v: weight and ray. For a polygon that is near, of
/// whose area little counts then: a direction of even density over its solid angle.
void alpi_polygon_aim_near(alpi_polygon_wave *wave, const alpi_polygon *polygon, uint32_t s,
                           uint32_t lane);
/// For one that the horizon cuts: a point of even density over the area that is above.
void alpi_polygon_aim_above(alpi_polygon_wave *wave, const alpi_polygon *polygon, uint32_t s,
                            uint32_t lane);

#endif
