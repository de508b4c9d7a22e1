// SPDX-License-Identifier: MIT
// The state of the rounds of occlusion, and the steps of a round.
#ifndef ALPI_BAKE_OCCLUSION_STATE_H
#define ALPI_BAKE_OCCLUSION_STATE_H

#include "bake/occlusion/occlusion_held_out.h"
#include "bake/occlusion/occlusion_rounds.h"
#include "maps/texels/chart_deal.h"

/// Progress, the deadline, and whether the user cancels.
typedef struct alpi_occlusion_clock {
    const alpi_occlusion_task *task; // its callback, deadline and keep_partial
    double started;                  // alpi_seconds()
    alp_progress last;               // report to the user
    double last_time;                // of it, alpi_seconds()
    bool cancelled;                  // by the user
} alpi_occlusion_clock;

typedef struct alpi_occlusion_state {
    const alpi_occlusion_task *task;
    alpi_occlusion_report *report;
    alpi_occlusion_clock clock;
    alpi_scratch *scratch;            // sums of the rays of traced texels
    uint8_t *marked;                  // [texels] to be traced next
    uint32_t *list;                   // [task->count] texels that are traced now, chart by chart
    alpi_chart_deal deal;             // of lists
    alpi_occlusion_held_out held_out; // measures the error
    uint32_t before;  // samples of a traced texel before this round; 0: this is the first
    uint32_t samples; // after it
} alpi_occlusion_state;

// --- occlusion_plan.c: rays of the next round ----------------------------------------------------

/// Samples of a traced texel in the first round.
uint32_t alpi_occlusion_first_samples(const alpi_occlusion_task *task);
/// Samples of a traced texel after the next round, those of the rounds before included.
/// @param report the map after the last round
/// @return 0: the error is reached, or all samples of the setup are spent
uint32_t alpi_occlusion_next_samples(const alpi_occlusion_task *task,
                                     const alpi_occlusion_report *report);

// --- occlusion_progress.c ------------------------------------------------------------------------

alpi_occlusion_clock alpi_occlusion_clock_start(const alpi_occlusion_task *task);
/// Progress of loops that trace rays. They end when the user cancels or the deadline passes.
alpi_task_progress alpi_occlusion_progress_of_rays(alpi_occlusion_clock *clock);
/// Progress of short loops over texels, useless unless complete. They ignore the deadline, and with
/// keep_partial the user too.
alpi_task_progress alpi_occlusion_progress_of_texels(alpi_occlusion_clock *clock);
/// Reports from a serial loop. @return ALP_OK; CANCELLED
alp_result alpi_occlusion_tick(alpi_occlusion_clock *clock);

// --- loops over the texels of the task -----------------------------------------------------------

alp_result alpi_occlusion_for_texels(alpi_occlusion_state *state, alpi_task_fn *body, void *user);
alp_result alpi_occlusion_sum_texels(alpi_occlusion_state *state, alpi_sum_fn *body,
                                     const void *user, double sums[ALPI_SUM_LIMIT]);

/// Whether a texel is to be traced next.
typedef bool alpi_occlusion_rule(const alpi_occlusion_task *task, uint32_t texel);
/// Sets the marks of all texels by a rule.
alp_result alpi_occlusion_mark(alpi_occlusion_state *state, alpi_occlusion_rule *rule);

// --- occlusion_lattice.c: which texels are traced, and which are interpolated --------------------

/// Traces every texel that has no rays yet.
alp_result alpi_occlusion_trace_all(alpi_occlusion_state *state);
/// Traces the lattice, and texels between whose neighbours disagree. Interpolates the others.
alp_result alpi_occlusion_trace_lattice(alpi_occlusion_state *state);
/// Interpolates texels without a value from any neighbours they have.
alp_result alpi_occlusion_fill_gaps(alpi_occlusion_state *state);

// --- occlusion_samples.c: rays of listed texels --------------------------------------------------

/// Traces the marked texels and clears the marks. @param count out: how many there were
alp_result alpi_occlusion_trace_marked(alpi_occlusion_state *state, uint32_t *count);
/// Traces the samples [before, samples) of texels that were traced in the round before.
alp_result alpi_occlusion_trace_more(alpi_occlusion_state *state);
/// Prepares the sums of listed receivers for more samples. If these are a multiple of those before,
/// the old quarters merge into the first. Otherwise each quarter gets its share of the new samples.
void alpi_occlusion_extend_quarters(alpi_occlusion_sums *sums, const uint32_t *list, uint32_t count,
                                    uint32_t before, uint32_t samples);

// --- occlusion_error.c: noise and stated error ---------------------------------------------------

/// Noise of a traced texel by the spread of its quarters, root mean square over the map. It is
/// about 1.8 times the true standard deviation.
/// @param traced out: number of traced texels
alp_result alpi_occlusion_measure_noise(alpi_occlusion_state *state, float *noise,
                                        uint32_t *traced);
/// Traces the held-out rays of this round, and fills task->errors and the errors of the report,
/// even where the rays were cut off.
alp_result alpi_occlusion_measure_error(alpi_occlusion_state *state);

#endif
