// SPDX-License-Identifier: MIT
// What the files that bake irradiance share.
#ifndef ALPI_BAKE_LIGHT_H
#define ALPI_BAKE_LIGHT_H

#include "bake/job.h"
#include "bake/settings.h"
#include "maps/radiosity/radiosity.h"
#include "transport/directional.h"
#include "transport/paths/reference.h"

#include <math.h>

/// The stage of light: gathers irradiance at the texels, if a map of light is asked for, and fills
/// the report.
/// @return ALP_OK; LIMIT: the time was over before any texel had light; OUT_OF_MEMORY; CANCELLED
alp_result alpi_bake_light(alpi_bake_job *job);

/// The watch of the light: a progress callback and its user data. Time that is left is told by how
/// long the part that runs takes, and what comes after it in times of that part.
typedef struct alpi_light_clock {
    alp_progress_fn *callback; // the user's, or NULL
    void *user;
    const char *stage;
    double deadline;     // alpi_seconds(); HUGE_VAL: none
    bool until_deadline; // all the time there is will be used
    bool may_go_on;      // rounds follow until an error is reached
    bool refused;        // by the user
    bool ended;          // nobody is asked any more
    bool one_loop;       // of the part: its progress is told as that of one loop
    double began, part_began;
    double after;             // what comes after the part, over the part
    double base, share, loop; // of the part: done before this loop, done; of the loop: done
    double told;              // of all of it
} alpi_light_clock;

alpi_light_clock alpi_light_clock_start(const alpi_bake_job *job,
                                        const alpi_task_progress *progress);
/// Begins a part. @param after what comes after it, over the time it takes itself
void alpi_light_clock_part(alpi_light_clock *clock, bool one_loop, double after);
bool alpi_light_clock_is_late(const alpi_light_clock *clock);
/// The callback; `user` is the clock.
bool alpi_light_clock_goes_on(void *user, const alp_progress *progress);

/// Where light is gathered, and what it becomes.
typedef struct alpi_light_task {
    const alpi_lighting *lighting;
    const alpi_lighting *near_lighting; // NULL, or that of paths from near surfaces
    const alpi_tracer *tracer;
    const alpi_receivers *receivers; // texels of the job's atlas
    const uint32_t *order;           // [count] those with light of their own
    uint32_t count;
    const alpi_lattice *lattice;
    alpi_task_progress progress; // of the clock
    alpi_light_clock *clock;
    double emitted; // W·m⁻²: π × emitted radiance, root mean square over texels and channels
    alpi_reference_value *values;  // [receivers] out; made by who gathers, when it does
    alpi_directional *directional; // [receivers] out, or NULL
} alpi_light_task;

/// Finds the emission of a task's texels, at the middle of each.
/// @return ALP_OK; CANCELLED
alp_result alpi_light_find_emission(const alpi_bake_job *job, alpi_light_task *task);
/// The light that errors are relative to, W·m⁻²: E + max(0, M − 1500 E), E the mean irradiance and
/// M the root mean square of what the surfaces emit. Little of what nearly convex things emit
/// returns to them. Beside emission that much brighter no picture shows it, and no number of rays
/// would reach an error over so little. A room with small bright lamps has less: built-in windows
/// M = 1,180 E.
static inline double alpi_light_scale(const alpi_light_task *task, double mean)
{
    return mean + fmax(0.0, task->emitted - 1500.0 * mean);
}

/// Direct light and what surfaces make of it, by rays or hemicubes.
alp_result alpi_bake_radiosity(alpi_bake_job *job, alpi_light_task *task);

/// The rays that light may take; HUGE_VAL: any number (alp_light_options.bounded).
double alpi_light_ray_limit(const alpi_bake_job *job, uint32_t texels);
/// Rays of a block, on a map of so many texels.
uint32_t alpi_light_block_rays(const alp_light_options *options, uint64_t texels);
/// Samples of each light at a texel in the first round.
uint32_t alpi_light_first_direct(const alpi_bake_job *job);

/// Mean of two estimates by their numbers of samples.
void alpi_light_merge(alpi_reference_value *value, const alpi_reference_value *fresh, double had,
                      double more);

/// Gathers the last bounce at the texels, in rounds until the wanted error is stated or the time is
/// over, and takes what the rounds before gave where one is cut off; adds direct light, and fills
/// task->values and the report.
/// @param fixed the gatherer of texels, or NULL: cosine rays, as many as it takes
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_rounds(alpi_bake_job *job, alpi_light_task *task, const alpi_gatherer *fixed,
                             alpi_radiosity *solution);

/// Shows the rays of a round what is known by now. The few samples of direct light of the first
/// round make noise in corners, where a texel sees few others, that no number of rays takes off.
/// What texels gathered by as many rays is finer than what blocks did. With a number of bounces it
/// has one too many, and layers need it apart: there, blocks' light is shown. Where only some
/// surfaces are baked, rays meet other texels, and nothing is shown anew.
/// @param rays  of a texel, so far: task->values are what they brought
/// @param noise out: 1 / √ rays that a block's light is known by from now on
/// @return ALP_OK; CANCELLED
alp_result alpi_light_show(const alpi_bake_job *job, const alpi_light_task *task,
                           const alpi_radiosity *solution, uint32_t rays, double *noise);

/// Error of the solution, over the mean of the light: what rays meet has noise, alike for all of
/// them, that no number of rays tells. Root mean square over texels, as measured.
/// @param mean of all light; bounced: root mean square of bounced light, a soft sky's apart
/// @param noise 1 / √ rays that a block's light is known by
double alpi_light_solved_error(const alpi_radiosity *solution, double mean, double bounced,
                               double noise);

/// What the two make of the light so far, which stays as it is.
/// @param share error of the solution, over the bounced light of each texel: added to variances
/// @param whole [texels] out
/// @return ALP_OK
alp_result alpi_light_peek(const alpi_bake_job *job, const alpi_light_task *task,
                           const alpi_radiosity *solution, const float (*skies)[3], double share,
                           alpi_reference_value *whole);

/// Adds direct light to bounced light, and keeps them apart where that is asked for.
/// @param skies [texels] or NULL: what of the bounced light is a soft sky's
/// @param share as of alpi_light_peek
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_light_sum(alpi_bake_job *job, const alpi_light_task *task,
                          const alpi_radiosity *solution, const float (*skies)[3], double share);

/// Takes noise off task->values, and keeps the sky's share of them. Whoever ends the bake before,
/// or meanwhile, and keeps what there is, gets the light as it was gathered: no texel is changed
/// before all are known.
/// @param skies [texels] what of the values is a soft sky's
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_light_denoise(alpi_bake_job *job, const alpi_light_task *task, float (*skies)[3]);

/// Samples the probes of the bake, if it wants any. @param known NULL: their light is solved apart
/// @return ALP_OK; what alp_probes_bake returns
alp_result alpi_light_probes(alpi_bake_job *job, const alpi_surface_light *known);

#endif
