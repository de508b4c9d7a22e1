// SPDX-License-Identifier: MIT
// What a point sees, as a hemicube about it does, and what its pixels count for.
#ifndef ALPI_RENDER_HEMICUBE_VIEW_H
#define ALPI_RENDER_HEMICUBE_VIEW_H

#include "trace/trace.h"

#include <alpenglow/render.h>

typedef struct alpi_hemicube_view {
    const alp_scene *scene;
    const alp_render_options *options;
    const alpi_tracer *tracer; // all borrowed
    vec3 position, forward;    // metres; unit
} alpi_hemicube_view;

/// Whether the picture is of multipliers, for which no light is needed.
bool alpi_hemicube_view_is_map(const alp_render_options *options);
/// @return ALP_OK; INVALID_ARGUMENT
alp_result alpi_hemicube_view_check(alp_context *context, const alp_render_options *options);
/// Solves a radiosity where light is seen, and draws the cross of 2n × 2n pixels.
/// @return ALP_OK; what alp_atlas_create returns; OUT_OF_MEMORY; CANCELLED
alp_result alpi_hemicube_view_draw(const alpi_hemicube_view *view, alp_image **image);

#endif
