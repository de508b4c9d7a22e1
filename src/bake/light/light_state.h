// SPDX-License-Identifier: MIT
// The light of one bake: what the files of this folder share.
#ifndef ALPI_BAKE_LIGHT_STATE_H
#define ALPI_BAKE_LIGHT_STATE_H

#include "bake/light/light_progress.h"
#include "bake/light/light_settings.h"
#include "maps/radiosity/final_gather.h"
#include "maps/texels/relative_error.h"

typedef struct alpi_light_bake {
    alpi_bake_job *job;
    alpi_light_settings settings;
    alpi_light_clock *clock;
    alpi_task_progress progress; // of the clock
    const alpi_lighting *lighting;
    alpi_light_sources sources;
    const alpi_tracer *tracer;
    const alpi_receivers *receivers; // texels of the map
    const alpi_lattice *lattice;
    const uint32_t *order; // [count] texels with light of their own, neighbours together
    uint32_t count;
    double emitted; // W·m⁻²: π × emitted radiance, root mean square over texels and channels
    alpi_reference_value *values;  // [receivers] bounced light, at the end all of the map
    alpi_directional *directional; // [receivers] the same by direction, or NULL
} alpi_light_bake;

// --- direct light --------------------------------------------------------------------------------

/// Samples of direct light so far. Texels have different numbers of them.
typedef struct alpi_light_direct {
    uint32_t *counts; // [texels] 0: no light of its own; NULL without rounds
    uint32_t most;    // of any texel
    double power;     // the error falls with samples^−power
    double predicted; // root mean square error after the last samples, W·m⁻²
    double seconds;   // of one more sample of a texel
    double drawn;     // of all rounds and texels
} alpi_light_direct;

// --- errors --------------------------------------------------------------------------------------

/// The stated error of a map. A texel's error is the root mean square over its channels.
typedef struct alpi_light_error {
    double mean;                    // of the light, over texels and channels
    double scale;                   // see alpi_light_scale
    alpi_relative_error over_scale; // NaN in the dark
} alpi_light_error;

/// Errors of the light so far.
typedef struct alpi_light_errors {
    double scale, map_scale; // errors are relative to these; map_scale: without direct light, if
                             // the map has none
    double direct, bounced;  // root mean squares over scale, and over map_scale
    double bounced_rms;      // root mean square of bounced light without the sky's
    double solved;           // error of the solution, over map_scale
    double solved_noise;     // 1 / √rays of a patch, mean over the rounds
    alpi_light_error map;    // stated if the map ended here; NaN until it is measured
} alpi_light_errors;

/// The worst texels: their squared error is above a quarter of the limit, as the gain of a round is
/// a guess.
typedef struct alpi_light_worst {
    uint8_t *marks; // [texels] 1 for the worst, else 0
    uint32_t *list; // [count] those with noisy bounced light that were never interpolated
    // 0: none, or most of the texels above the limit with noisy bounced light are interpolated.
    // Only rays of all texels help these.
    uint32_t count;
} alpi_light_worst;

// --- rounds --------------------------------------------------------------------------------------

/// Light that a round gathers, before it is merged.
typedef struct alpi_light_fresh {
    alpi_reference_value *values;  // [texels] scratch of direct light too
    float (*skies)[3];             // [texels] or NULL
    alpi_directional *directional; // [texels] or NULL
} alpi_light_fresh;

/// Rays of bounced light so far.
typedef struct alpi_light_rays {
    uint32_t per_texel;  // without the extra rays of the worst texels
    uint32_t *of_texels; // [texels] with them; NULL in the first round
    uint32_t most;       // of any texel
    double sent;         // of all texels, with those of layers and the pilot
    double traced;       // texels that trace rays in a round of all; a guess before the first
    double power;        // the error falls with rays^−power
    double seconds;      // of one more ray of a texel that traces any
    float factor;        // alpi_final_gather_report.factor of the last round of all texels
} alpi_light_rays;

/// Texels that any round interpolated. Their error is measured at texels that are held out.
typedef struct alpi_light_interpolated {
    uint8_t *marks;              // [texels]
    alpi_held_out *held_out;     // light of their own rays, in the last round
    alpi_reference_value *means; // [held_out->count] the same over all rounds
} alpi_light_interpolated;

typedef struct alpi_light_rounds {
    alpi_light_bake *light;
    alpi_radiosity *solution;
    const alpi_gatherer *fixed; // of texels: hemicubes; NULL: cosine rays
    float (*skies)[3];          // [texels] a soft sky's part of the bounced light; NULL: no sky
    uint8_t *states;            // [texels] alpi_texel_state of the last round of all texels
    alpi_light_direct direct;
    alpi_light_rays rays;
    alpi_light_fresh fresh;
    alpi_light_interpolated interpolated;
    alpi_light_errors errors;
    alpi_light_worst worst; // rays of this round: of its list; count 0: of all texels
    uint32_t number;        // of the round
    bool for_worst;         // the round is for the worst texels
    bool limited;           // by the limit of rays
    bool cut_off;           // by the clock or the user
} alpi_light_rounds;

#endif
