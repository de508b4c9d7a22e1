// SPDX-License-Identifier: MIT
// Light at points that a camera sees, as a host shows a field: E of the field, and light straight
// from lamps and suns with shadows.
#ifndef ALPI_RENDER_FIELD_LIGHT_H
#define ALPI_RENDER_FIELD_LIGHT_H

#include "scene/lights/lighting.h"
#include "transport/surface_light.h"

#include <alpenglow/field.h>
#include <alpenglow/lpv.h>

typedef struct alpi_field_light {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    alpi_trace_filter filter;
    const alp_field *field;
    const alpi_lighting *lamps; // NULL, or whose punctual lights and suns shine
    const alp_lpv *gloss;       // NULL, or the volume that surfaces mirror
} alpi_field_light;

/// Points, at most a packet.
typedef struct alpi_field_points {
    uint32_t count;
    float positions[ALPI_PACKET][3], normals[ALPI_PACKET][3];
    float offsets[ALPI_PACKET]; // metres along the normals at which shadow rays start
    bool in_air;                // no surface is here: light from all sides counts in full
} alpi_field_points;
/// E [W·m⁻²] at points. @param irradiance [count] out
void alpi_field_light_at(const alpi_field_light *light, const alpi_field_points *points,
                         float (*irradiance)[3]);

/// Adds the light of lamps and suns to E, or in air to the fluence ∫ L dω [W·m⁻²].
void alpi_field_light_add_lamps(const alpi_field_light *light, const alpi_field_points *points,
                                float (*irradiance)[3]);

/// How gatherers see surfaces that reflect the light.
alpi_surface_light alpi_field_light_surfaces(const alpi_field_light *light);

#endif
