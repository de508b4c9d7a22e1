// SPDX-License-Identifier: MIT
// The stated error of light: the noise of rays and samples, the error of interpolation, and the
// noise of the solution, which is the same for all rays of all texels.
#ifndef ALPI_BAKE_LIGHT_ERROR_H
#define ALPI_BAKE_LIGHT_ERROR_H

#include "bake/light/light_state.h"

#include <math.h>

/// Sets light->emitted, from the emission at the middle of each texel.
/// @return ALP_OK; CANCELLED
alp_result alpi_light_find_emission(alpi_light_bake *light);
/// Errors are relative to this, W·m⁻²: E + max(0, M − 1500 E), E the mean irradiance and M the root
/// mean square radiosity of the emission. Nearly convex emitters receive little of their own light.
/// No picture shows that light beside the emission, and no number of rays reaches its error.
/// builtin:windows has M = 1,180 E.
static inline double alpi_light_scale(const alpi_light_bake *light, double mean)
{
    return mean + fmax(0.0, light->emitted - 1500.0 * mean);
}

/// The stated error of values.
/// @param values [texels]
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_find_error(const alpi_light_bake *light, const alpi_reference_value *values,
                                 alpi_light_error *error);

/// Measures rounds->errors but for those of the map.
/// @param list [count] texels whose bounced light is known
/// @return ALP_OK; CANCELLED
alp_result alpi_light_measure(alpi_light_rounds *rounds, const uint32_t *list, uint32_t count);
/// Measures rounds->errors.map. The map is in rounds->fresh.values then.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_measure_map(alpi_light_rounds *rounds);

/// Error of the solution over the mean light. All rays read the same solution, so that no number of
/// rays shows its noise.
/// @param mean of all light   @param bounced root mean square, without a soft sky's
/// @param noise 1 / √rays of a patch
double alpi_light_solved_error(const alpi_radiosity *solution, double mean, double bounced,
                               double noise);
/// The same over the bounced light of a texel.
double alpi_light_solved_share(const alpi_light_rounds *rounds);

/// Joins bounced and direct light to the light of the map. Adds the error of the solution to the
/// variances.
/// @param skies [texels] a soft sky's part of the bounced light, or NULL
/// @param share see alpi_light_solved_share
/// @param whole [texels] out; may be light->values
/// @return ALP_OK
alp_result alpi_light_join(const alpi_light_bake *light, const alpi_radiosity *solution,
                           const float (*skies)[3], double share, alpi_reference_value *whole);

/// Errors of both kinds of light, over the scale: of the whole map, or of its worst texels.
typedef struct alpi_light_noise {
    double direct, bounced;
    double noisy; // share of the texels that more samples of direct light are for, about
} alpi_light_noise;

/// The light of a map, and its parts. Variances of `values` that neither part has are those of the
/// solution.
typedef struct alpi_light_whole {
    const alpi_reference_value *values, *bounced;
    const alpi_reference_value *direct; // NULL: the map has none
    const uint32_t *order;
    uint32_t count;
} alpi_light_whole;

/// Splits the error of a texel at the 99th percentile, in proportion to the squared errors of the
/// texels above a limit.
/// @param limit over the scale
/// @return the part of the solution, which no round lowers
double alpi_light_tail(const alpi_light_whole *whole, const alpi_light_error *error, double limit,
                       alpi_light_noise *noise);
/// Finds the worst texels.
/// @param texels of the map   @param limit over the scale
/// @param interpolated [texels] in any round
/// @param worst out: its arrays have room for all texels
void alpi_light_find_worst(const alpi_light_whole *whole, const alpi_light_error *error,
                           uint32_t texels, double limit, const uint8_t *interpolated,
                           alpi_light_worst *worst);

/// Warns of light that was cut off, or that misses the wanted error.
/// @param rays, direct samples of a texel
void alpi_light_warn(const alpi_bake_job *job, const alpi_relative_error *error, bool cut_off,
                     uint32_t rays, uint32_t direct);

#endif
