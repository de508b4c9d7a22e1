// SPDX-License-Identifier: MIT
// Light at points that a camera sees, as a host shows a field: E of the field, and light straight
// from lamps and suns with shadows.
#ifndef ALPI_RENDER_FIELD_LIGHT_H
#define ALPI_RENDER_FIELD_LIGHT_H

#include "transport/surface_light.h"
#include "scene/lights/lighting.h"

#include <alpenglow/field.h>

typedef struct alpi_field_light {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    alpi_trace_filter filter;
    const alp_field *field;
    const alpi_lighting *lamps; // NULL, or whose punctual lights and suns shine
} alpi_field_light;

enum { ALPI_FIELD_BATCH = ALPI_PACKET };
/// E [W·m⁻²] at points. @param offsets metres along the normals at which shadow rays start
/// @param count at most ALPI_FIELD_BATCH
void alpi_field_light_at(const alpi_field_light *light, uint32_t count, const float (*positions)[3],
                         const float (*normals)[3], const float *offsets, float (*irradiance)[3]);

/// How gatherers see surfaces that reflect the light.
alpi_surface_light alpi_field_light_surfaces(const alpi_field_light *light);

#endif
