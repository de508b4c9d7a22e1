// SPDX-License-Identifier: MIT
// The stated error of light.
#ifndef ALPI_BAKE_LIGHT_ERROR_H
#define ALPI_BAKE_LIGHT_ERROR_H

#include "bake/job.h"
#include "bake/light/light.h"
#include "bake/light/light_plan.h"
#include "maps/texels/stated_error.h"
#include "transport/paths/reference.h"

/// Of a map of light. An error of a texel is the root mean square of those of its channels.
typedef struct alpi_light_error {
    double mean;                    // of the light, over texels and channels
    double scale;                   // alpi_light_scale
    alpi_relative_error over_scale; // NaN where that is 0
} alpi_light_error;

/// @param values [texels]
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED by who watches the context
alp_result alpi_light_find_error(alp_context *context, const alpi_reference_value *values,
                                 const alpi_light_task *task, alpi_light_error *error);

/// Light as a map holds it, and the parts that rays and samples make better. What its variances
/// have beyond theirs is the solution's.
typedef struct alpi_light_whole {
    const alpi_reference_value *values, *bounced;
    const alpi_reference_value *direct; // NULL: the map has none
    const uint32_t *order;
    uint32_t count;
} alpi_light_whole;

/// What a texel at the 99th percentile errs by, its squared error shared out as that of the texels
/// above a limit is: those have to come down.
/// @param limit over the mean, below the 99th percentile
/// @return the part of the solution, which no round makes better
double alpi_light_tail(const alpi_light_whole *whole, const alpi_light_error *error, double limit,
                       alpi_light_noise *noise);

/// The texels that err most: by more than half of a limit. Those between half of it and all of it
/// too, since what more rays bring is a guess.
typedef struct alpi_light_worst {
    uint8_t *marks; // [texels] out: 1 of them, 0 of the others
    // [count] out: those of them whose bounced light is noisy and that always sent rays; room for
    // whole's count.
    uint32_t *list;
    // 0: none, or of those beyond the limit whose bounced light is noisy most are interpolated,
    // which only rays of all texels make better.
    uint32_t count;
} alpi_light_worst;
/// @param texels  of the map   @param limit over the mean
/// @param between [texels] whether they were ever interpolated
void alpi_light_find_worst(const alpi_light_whole *whole, const alpi_light_error *error,
                           uint32_t texels, double limit, const uint8_t *between,
                           alpi_light_worst *worst);

/// Warns of light that was cut off, or whose error is larger than wanted.
/// @param cut_off whether the light was   @param rays, direct samples of a texel
void alpi_light_warn(const alpi_bake_job *job, const alpi_relative_error *error, bool cut_off,
                     uint32_t rays, uint32_t direct);

#endif
