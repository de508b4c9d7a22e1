// SPDX-License-Identifier: MIT
// Lights without extent: what one gives at a point, and draws of one out of all.
#ifndef ALPI_SCENE_LIGHTING_PUNCTUAL_H
#define ALPI_SCENE_LIGHTING_PUNCTUAL_H

#include "scene/lights/light_tree.h"
#include "scene/scene.h"

/// Point, spot, and directional lights without size, by their index in `lights`.
typedef struct alpi_punctual {
    const alpi_light *lights; // borrowed
    uint32_t *list;           // [listed]: asked one by one
    uint32_t listed;
    uint32_t *placed; // [placed_count]: point and spot lights in the tree; none while they are
                      // few: then they are in the list
    uint32_t placed_count;
    alpi_light_tree *tree; // of them; NULL = none
} alpi_punctual;

/// What was made is released by alpi_punctual_clear, also after a failure.
/// @param indices [count] of `lights`, each with intensity × colour > 0
alp_result alpi_punctual_collect(alp_context *context, const alpi_light *lights,
                                 const uint32_t *indices, uint32_t count, alpi_punctual *punctual);
void alpi_punctual_clear(alp_context *context, alpi_punctual *punctual);

/// What one light gives at a point.
typedef struct alpi_punctual_light {
    vec3 direction; // unit, from the point
    float distance; // metres, INFINITY for a directional light
    vec3 light;     // E on a surface that faces it
} alpi_punctual_light;

/// E = I/d², times a spot's fall-off between its cones and a window of the range, both as
/// KHR_lights_punctual recommends: clamp((cosθ − cos outer)/max(.001, cos inner − cos outer))² and
/// clamp(1 − (d/range)⁴), clamped to [0, 1]. A directional light gives its lux.
/// @return false: out of its range or cone, or at the very place of the light
bool alpi_punctual_at(const alpi_light *light, vec3 point, alpi_punctual_light *at);

/// Estimate of the irradiance that all of them give on the side of `normal`; 0 only if none does.
double alpi_punctual_importance(const alpi_punctual *punctual, vec3 point, vec3 normal);
/// Draws one. @param light out: index in `lights` @return its probability, 0: none
double alpi_punctual_sample(const alpi_punctual *punctual, vec3 point, vec3 normal, double pick,
                            uint32_t *light);

#endif
