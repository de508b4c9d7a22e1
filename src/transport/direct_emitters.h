// SPDX-License-Identifier: MIT
// Draws of emissive triangles alone, for direct light.
#ifndef ALPI_TRANSPORT_DIRECT_EMITTERS_H
#define ALPI_TRANSPORT_DIRECT_EMITTERS_H

#include "scene/lighting.h"
#include "scene/lighting_emitters.h"
#include "scene/receivers.h"

/// Up to here form factors say how often each triangle is drawn, so that little is left to chance
/// but what hides them. More are drawn by their hierarchy.
enum { ALPI_DIRECT_FEW = 8 };

typedef struct alpi_direct_emitters {
    const alp_scene *scene;
    alpi_emitters all;
    double radiance[ALPI_DIRECT_FEW]; // mean over the triangle and the channels, where few
} alpi_direct_emitters;

/// What was made is released by alpi_direct_emitters_clear, also after a failure.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_direct_emitters_collect(const alp_scene *scene, alpi_direct_emitters *emitters);
void alpi_direct_emitters_clear(alpi_direct_emitters *emitters);

/// How triangles are drawn at some points, where there are few: as they look from some of these.
typedef struct alpi_emitter_choice {
    const alpi_direct_emitters *emitters;
    double weight[ALPI_DIRECT_FEW]; // 0 only of one that gives nothing at any of the points
    double sum;
    double share; // of the hemisphere that they fill
} alpi_emitter_choice;
alpi_emitter_choice alpi_emitter_choose(const alpi_direct_emitters *emitters,
                                        const alpi_receiver_point *points, uint32_t count);

/// The emitters as one of these points sees them.
typedef struct alpi_emitter_view {
    const alpi_emitter_choice *choice;
    vec3 point, normal;
    double share; // of the hemisphere's light that they may give, estimated; 0 only where they
                  // give nothing
} alpi_emitter_view;
/// @param point where its rays start
alpi_emitter_view alpi_emitter_view_from(const alpi_emitter_choice *choice, vec3 point,
                                         vec3 normal);

/// Draws a triangle and a direction in its solid angle, as alpi_lighting_sample does of all light.
/// @param pick [0,1), read where they are many   @param u [0,1)²
bool alpi_emitter_sample(const alpi_emitter_view *view, float pick, vec2 u,
                         alpi_light_sample *sample);
/// Density, per steradian, of drawing a direction that hits `triangle`.
double alpi_emitter_density(const alpi_emitter_view *view, vec3 direction, uint32_t triangle);

#endif
