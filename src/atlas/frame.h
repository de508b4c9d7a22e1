// SPDX-License-Identifier: MIT
// Where a chart lies in the box of whole texels that is packed.
#ifndef ALPI_ATLAS_FRAME_H
#define ALPI_ATLAS_FRAME_H

#include "atlas/stages.h"

/// Chart (metres) → texels of its box: scale · (x, y) + rest.
typedef struct alpi_frame {
    uint32_t width, height; // of the box, texels
    double scale[2], rest[2];
    bool point; // the chart has no area in 32-bit floats: each of its triangles is drawn over half
                // of the box's only texel
} alpi_frame;
/// The frame at `density` texels per metre, the chart in the middle of its box.
alpi_frame alpi_frame_of(const alpi_chart *chart, double density);

/// A corner of a chart's triangle in the box's texels.
void alpi_frame_corner(const alpi_frame *frame, const float uv[2], int corner, double p[2]);
/// The same once the box was turned by quarters.
void alpi_frame_turn(const alpi_frame *frame, uint32_t turns, double p[2]);

/// Marks the texels of the box that a chart's triangles reach: all that it will cover once its
/// corners are 32-bit floats on a page, and rarely one more.
/// @param mask [height][(width + 63) / 64], zero before
void alpi_frame_draw(const alp_atlas *atlas, const alpi_frame *frame, const alpi_chart *chart,
                     const uint32_t *triangles, uint64_t *mask);

#endif
