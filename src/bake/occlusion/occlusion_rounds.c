// SPDX-License-Identifier: MIT
// The rounds: trace, measure the error, plan the next round.
#include "bake/occlusion/occlusion_rounds.h"

#include "bake/bake_checkpoint.h"
#include "bake/occlusion/occlusion_error.h"
#include "bake/occlusion/occlusion_lattice.h"
#include "bake/occlusion/occlusion_plan.h"
#include "bake/occlusion/occlusion_samples.h"
#include "base/memory.h"
#include "base/tiles/tiles.h"
#include "maps/texels/bent.h"

#include <math.h>

// --- rounds --------------------------------------------------------------------------------------

static alp_result trace_round(alpi_occlusion_state *state)
{
    if (state->before > 0) {
        ALP_TRY(alpi_occlusion_trace_more(state));
    }
    return state->task->accuracy == ALP_ADAPTIVE_OFF ? alpi_occlusion_trace_all(state)
                                                     : alpi_occlusion_trace_lattice(state);
}

static alp_result trace_rounds(alpi_occlusion_state *state)
{
    uint32_t samples = alpi_occlusion_first_samples(state->task);
    while (samples > 0) {
        state->before = state->samples;
        state->samples = samples;
        ALP_TRY(trace_round(state));
        state->report->samples = samples;
        if (alpi_tiles_are_shards(state->task->setup->context)) {
            return ALP_OK; // the merge measures the error
        }
        (void)alpi_tiles_set_kind(state->task->setup->context, ALPI_TILES_MEASURE);
        const alp_result measured = alpi_occlusion_measure_error(state);
        (void)alpi_tiles_set_kind(state->task->setup->context, ALPI_TILES_WHOLE);
        ALP_TRY(measured);
        alpi_bake_note_error(state->task->setup->context, state->report->relative);
        samples = alpi_occlusion_next_samples(state->task, state->report);
    }
    return ALP_OK;
}

// --- the map -------------------------------------------------------------------------------------

/// Clamps the overshoots of cubic stencils, and counts the texels of each state.
static void clamp_and_count(const void *user, uint32_t begin, uint32_t end,
                            double counts[ALPI_SUM_LIMIT])
{
    const alpi_occlusion_state *state = user;
    const alpi_lattice *lattice = state->task->lattice;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = state->task->order[i];
        lattice->values[t] = fminf(fmaxf(lattice->values[t], 0.0f), 1.0f);
        counts[lattice->states[t]] += 1.0;
    }
}

static alp_result finish(alpi_occlusion_state *state, bool late)
{
    const alpi_occlusion_task *task = state->task;
    alpi_occlusion_report *report = state->report;
    double counts[ALPI_SUM_LIMIT];
    ALP_TRY(alpi_occlusion_sum_texels(&state->clock, clamp_and_count, state, counts));
    report->traced = (uint64_t)counts[ALPI_TEXEL_TRACED];
    report->interpolated = (uint64_t)counts[ALPI_TEXEL_INTERPOLATED];
    report->unknown = (uint64_t)counts[ALPI_TEXEL_OPEN];
    if (report->cut_off && report->traced == 0) {
        return alpi_fail(task->setup->context, late ? ALP_ERROR_LIMIT : ALP_ERROR_CANCELLED,
                         "sampling ended before any texel had a value; allow more time");
    }
    const alpi_task_progress progress = alpi_occlusion_progress_of_texels(&state->clock);
    return task->bent == NULL ? ALP_OK
                              : alpi_bent_normals(task->lattice, &state->scratch->sums, task->order,
                                                  task->count, &progress, task->bent);
}

static alp_result run(alpi_occlusion_state *state)
{
    const alpi_occlusion_task *task = state->task;
    alp_context *context = task->setup->context;
    ALPI_TRY_NEW(context, state->list, task->count);
    ALP_TRY(alpi_chart_deal_open(context, task->lattice->texels->charts, task->order, task->count,
                                 &state->deal));
    state->marked = state->scratch->marks;
    alp_result result = trace_rounds(state);
    const bool late = !state->clock.cancelled && alpi_seconds() >= task->deadline;
    if (result == ALP_ERROR_CANCELLED && (late || task->keep_partial)) {
        state->report->cut_off = true;
        result = alpi_occlusion_fill_gaps(state);
    }
    return result == ALP_OK ? finish(state, late) : result;
}

alp_result alpi_occlusion_rounds(const alpi_occlusion_task *task, alpi_occlusion_report *report)
{
    alp_context *context = task->setup->context;
    alpi_occlusion_state state = {.task = task,
                                  .report = report,
                                  .clock = alpi_occlusion_clock_start(task),
                                  .scratch = task->scratch};
    *report = (alpi_occlusion_report){.relative = (double)NAN, .p99 = (double)NAN};
    const alp_result result = run(&state);
    alpi_occlusion_held_out_destroy(&state.held_out);
    alpi_chart_deal_close(&state.deal);
    alpi_release(context, state.list);
    return result;
}
