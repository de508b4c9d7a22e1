// SPDX-License-Identifier: MIT
// Lights that reach what pixels see, by rays: shadow maps may err only near the edges of shadows.
#ifndef TEST_SHADOWS_H
#define TEST_SHADOWS_H

#include <alpenglow/render.h>

#include <stdint.h>

/// Bit i of a pixel: light i reaches the surface in its middle, from the front and past all others.
/// @param reached [height][width] out. Suns count as points.
void test_shadows_trace(const alp_scene *scene, const alp_render_options *options,
                        const alp_camera *camera, uint32_t *reached);

#endif
