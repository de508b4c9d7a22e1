// SPDX-License-Identifier: MIT
// Draws of emissive triangles alone, for direct light.
#ifndef ALPI_TRANSPORT_DIRECT_EMITTERS_H
#define ALPI_TRANSPORT_DIRECT_EMITTERS_H

#include "scene/lights/lighting.h"
#include "scene/lights/lighting_emitters.h"
#include "scene/receivers.h"

/// Up to here form factors say how often each triangle is drawn, so that little is left to chance
/// but what hides them.
enum { ALPI_DIRECT_FEW = 8 };
/// Up to here each is weighed, by what a small one may give: where they are far, as the triangles
/// of a ball are, that too leaves little to chance, and it takes less time than some steps down the
/// hierarchy. More are drawn by that.
enum { ALPI_DIRECT_LISTED = 1024 };

/// Triangles as they are weighed, in the order of the emitters.
typedef struct alpi_emitter_list {
    float *centre[3], *normal[3]; // [count] metres; unit
    float *radius;                // [count] metres, about the centre
    float *power;                 // [count] radiance × area
    float *two_sided;             // [count] 1 or 0
} alpi_emitter_list;

typedef struct alpi_direct_emitters {
    const alp_scene *scene;
    alpi_emitters all;
    double radiance[ALPI_DIRECT_FEW]; // mean over the triangle and the channels, where few
    alpi_emitter_list list;           // where they are listed but not few
} alpi_direct_emitters;

/// What was made is released by alpi_direct_emitters_clear, also after a failure.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_direct_emitters_collect(const alp_scene *scene, alpi_direct_emitters *emitters);
void alpi_direct_emitters_clear(alpi_direct_emitters *emitters);

/// How triangles are drawn at some points, where they are listed: few as they look from some of
/// these, more as they look from one.
typedef struct alpi_emitter_choice {
    const alpi_direct_emitters *emitters;
    double upto[ALPI_DIRECT_LISTED]; // sums of the weights of the first triangles, of which one is
                                     // 0 only if it gives nothing at any of the points
    double sum;                      // the last of them
    double share;                    // of the hemisphere that they fill
} alpi_emitter_choice;
void alpi_emitter_choose(const alpi_direct_emitters *emitters, const alpi_receiver_point *points,
                         uint32_t count, alpi_emitter_choice *choice);

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
