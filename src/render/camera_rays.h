// SPDX-License-Identifier: MIT
// Rays of a pinhole camera through points of a picture.
#ifndef ALPI_RENDER_CAMERA_RAYS_H
#define ALPI_RENDER_CAMERA_RAYS_H

#include "transport/paths/reference.h"

/// A camera and its picture.
typedef struct alpi_view {
    vec3 origin, forward; // metres; unit
    vec3 right, up;       // half the picture's height at distance 1; right already times the aspect
    uint32_t width, height;
    bool centred;                          // packets go through the middle of their pixel
    const struct alpi_camera_loops *loops; // for this machine, unless the context asks for less
} alpi_view;

/// @return ALP_OK; INVALID_ARGUMENT: no place, no direction or no angle to look at
alp_result alpi_view_place(alp_context *context, const alp_camera *camera, uint32_t width,
                           uint32_t height, alpi_view *view);

/// An alpi_camera_fn whose user is an alpi_view.
void alpi_view_rays(const void *view, uint32_t count, const uint64_t *pixels, const float *u,
                    const float *v, const alpi_camera_rays *rays);

/// Compiled for each instruction set; the same bits.
typedef struct alpi_camera_loops {
    /// Eight rays: samples first … first + 7 of the sequence of `key` in one pixel (row by row from
    /// the upper left corner). Lanes must have been cleared once.
    void (*packet)(const alpi_view *view, uint32_t pixel, uint32_t key, uint32_t first,
                   alpi_rays *rays);
    /// Unit directions through points x, y (pixels from the upper left corner), `count` of each.
    void (*aim)(const alpi_view *view, uint32_t count, const float *x, const float *y,
                float *const direction[3]);
} alpi_camera_loops;

extern const alpi_camera_loops alpi_camera_loops_baseline, alpi_camera_loops_v3;

#endif
