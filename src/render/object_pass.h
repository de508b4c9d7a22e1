// SPDX-License-Identifier: MIT
// Objects in a picture that are lit by the scene and do not light it: the one of
// alp_render_options.object, or small spheres that show probes.
#ifndef ALPI_RENDER_OBJECT_PASS_H
#define ALPI_RENDER_OBJECT_PASS_H

#include "render/camera_rays.h"
#include "render/field_light.h"

#include <alpenglow/render.h>

#define ALPI_OBJECT_ALBEDO 0.8f

/// A picture, and the light of its objects: one of the last three.
typedef struct alpi_object_pass {
    const alp_scene *scene;
    const alpi_tracer *tracer; // of the scene, which hides them
    const alpi_view *view;
    const alp_render_options *options;
    const alpi_field_light *field;   // or NULL
    const alpi_reference *reference; // or NULL: the field
    const alp_probes *probes;        // or NULL: the spheres of an overlay
} alpi_object_pass;

/// Draws over a finished picture, pixel by pixel by coverage.
/// @return ALP_OK; INVALID_ARGUMENT; OUT_OF_MEMORY; UNSUPPORTED; CANCELLED
alp_result alpi_object_pass_draw(const alpi_object_pass *pass, alp_image *image);

#endif
