// SPDX-License-Identifier: MIT
// What is known of rounds of light so far, and what the next one is for.
#ifndef ALPI_BAKE_LIGHT_NEXT_H
#define ALPI_BAKE_LIGHT_NEXT_H

#include "bake/light/light_direct.h"
#include "bake/light/light_error.h"
#include "maps/radiosity/final_gather.h"

/// Replicates of a texel's rays, by whose spread their noise is known. The number of rays is a
/// multiple of as many packets.
enum { ALPI_LIGHT_REPLICATES = 4 };

/// Rounds of one bake.
typedef struct alpi_light_round_state {
    alpi_bake_job *job;
    alpi_light_task *task;
    const alpi_gatherer *fixed;
    alpi_radiosity *solution;
    float (*skies)[3]; // [texels] what of the bounced light is a soft sky's; NULL: there is none
    alpi_reference_value *fresh;         // [texels] of a later round
    float (*fresh_skies)[3];             // [texels], or NULL too
    alpi_directional *fresh_directional; // [texels]; NULL: not wanted
    uint8_t *states;                     // [texels]
    uint8_t *between;                    // [texels] whether ever interpolated
    alpi_held_out *held_out;             // by the rays of the last round
    alpi_reference_value *held;          // [held_out->count] by those of all rounds
    alpi_light_direct direct;
    uint32_t rays;           // of a texel so far, but of those that got more alone
    uint32_t *rays_of;       // [texels] of each
    alpi_light_worst worst;  // rays of this round: of the list; count 0: of all
    uint32_t number;         // of the round
    double ray_limit;        // rays that light may take
    double sent;             // rays of bounced light so far, with those of layers
    uint32_t most_rays;      // of any texel so far
    float factor;            // alpi_final_gather_report, of the last round of all texels
    double sending;          // texels that send rays in a round of all; a guess before there is one
    double rays_power;       // of rays, that the error of bounced light falls with
    double ray_seconds;      // of a ray more of a texel that sends any
    double mean;             // of all light
    double scale, map_scale; // what errors are relative to: see alpi_light_round_measure
    double direct_error, bounced_error; // root mean squares over a scale
    double bounced_rms;                 // of bounced light, a soft sky's apart
    double solved_error;                // of the solution that rays meet, over a scale too
    double solved_noise;                // 1 / √ rays that a block of it is known by, on average
    alpi_light_error map;               // as the map would be stated; see alpi_light_round_look
    bool for_worst;                     // the next round is for the worst texels alone
    bool limited;                       // by ray_limit
    bool cut_off;                       // by the clock, or by who watches
} alpi_light_round_state;

/// The most rays of a texel.
uint32_t alpi_light_round_most_rays(const alp_light_options *options);

/// Finds the errors so far, over alpi_light_scale of what the map will hold. If that is bounced
/// light alone, direct light is what others reflect, and errs over the scale of all.
/// @param list [count] texels whose bounced light is known: those of the task, or some of them
/// @return ALP_OK; CANCELLED
alp_result alpi_light_round_measure(alpi_light_round_state *round, const uint32_t *list,
                                    uint32_t count);
/// Error of the solution over the bounced light of a texel.
double alpi_light_round_solved_share(const alpi_light_round_state *round);
/// The map as it would be if this were all, in `fresh`, and its errors.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_round_look(alpi_light_round_state *round);

/// The fewest rays of the first round: by 32 the teapot room states .82 of its error, by 64 .90
/// (`alpenglow bench truth`, for 4 %).
enum { ALPI_LIGHT_FIRST_RAYS = 64 };
/// Finds how many rays the first round takes, so that it is the last one if it can be, and gives
/// texels the samples of direct light that they will need, so that rays meet it without its noise.
/// Values and skies of the task are written over; the round's scratch of direct light is there.
/// @param rays out: of a texel
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_prepare_first(alpi_light_round_state *round, uint32_t *rays);

/// Plans what the texels get together. @return whether they are not good enough yet; the plan may
/// be nothing even then, where nothing helps
bool alpi_light_round_plan_all(const alpi_light_round_state *round, alpi_light_plan *plan);
/// Plans the next round: for_worst and worst say whom it is for.
/// @param plan out: nothing, where there is nothing to do, or nothing helps
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_round_plan(alpi_light_round_state *round, alpi_light_plan *plan);

#endif
