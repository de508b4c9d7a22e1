// SPDX-License-Identifier: MIT
// Light at a receiver by the directions that it comes from.
//
// Cosine-distributed rays bring irradiance. Of the first band what lies along the normal is just
// that. For the rest each stands for 1 / cosθ times as much light: near the horizon without limit,
// a few of them for much of the hemisphere. So what they bring from the band cosθ < width is apart:
// its mean counts for the band's known solid angle 2π · width, weighed by 1 / cosθ above a quarter
// of the width, and below, where a ray in sixteen of the band lies, by the mean of that. A ratio of
// means: exact where light is the same all over the band, else its bias falls as 1 / rays.
#ifndef ALPI_TRANSPORT_DIRECTIONAL_H
#define ALPI_TRANSPORT_DIRECTIONAL_H

#include "sh/basis.h"

#include <stdbool.h>
#include <stdint.h>

/// Of light from the hemisphere about the shading normal, world space.
typedef struct alpi_directional {
    float sh[ALPI_SH1_COUNT][3]; // ∫ L Y_lm dω, W·m⁻²
    float toward[3]; // ∫ luminance cosθ ω dω, W·m⁻²: points to the mean direction
} alpi_directional;

typedef struct alpi_directional_sums {
    double sh[ALPI_SH1_COUNT][3], toward[3];
    double width;                                      // of the band; where to begin
    double horizon[ALPI_SH1_COUNT][3], horizon_weight; // of the band
} alpi_directional_sums;

/// Of linear Rec. 709.
static inline double alpi_luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/// Of the band, as a cosine: a quarter of the hemisphere, or as much as four of few rays fill.
double alpi_horizon_width(uint32_t rays);
/// Counts a ray of the band. @param weight as that of light, of radiance 1
void alpi_directional_count(alpi_directional_sums *sums, double weight, double cosine);

/// How light arrives.
typedef struct alpi_directional_way {
    vec3 direction, normal; // unit
    float cosine;           // between them, > 0
    bool horizon;           // of a ray that was counted
} alpi_directional_way;
/// @param irradiance L cosθ dω [W·m⁻²], any weight, the same in all calls
void alpi_directional_add(alpi_directional_sums *sums, const double irradiance[3],
                          const alpi_directional_way *way);
/// @param scale 1 / the weight of all
void alpi_directional_finish(const alpi_directional_sums *sums, double scale,
                             alpi_directional *directional);

/// What free rays brought, by its direction and together, with the same weight: their ratio counts
/// where what there is of the light is known better.
typedef struct alpi_directional_found {
    alpi_directional_sums sums;
    double irradiance[3];
} alpi_directional_found;
/// Adds what rays found, scaled to what there is of it. @param light as much as there is
void alpi_directional_add_found(const alpi_directional_found *found, const double light[3],
                                alpi_directional_sums *sums);

/// Means of two estimates: a · had + b · more, in `had`.
void alpi_directional_mix(alpi_directional *had, float a, const alpi_directional *more, float b);

#endif
