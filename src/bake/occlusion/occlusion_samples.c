// SPDX-License-Identifier: MIT
// Rays of a round: marks texels, lists the marked ones chart by chart, traces their samples, and
// stores the values.
#include "bake/occlusion/occlusion_samples.h"

enum { TEXELS_PER_RANGE = 1 << 12, TEXELS_PER_TICK = 1 << 16 };

typedef struct mark_job {
    const alpi_occlusion_state *state;
    alpi_occlusion_rule *rule;
} mark_job;

static alp_result mark_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const mark_job *job = user;
    const alpi_occlusion_task *task = job->state->task;
    for (uint32_t i = begin; i < end; i++) {
        job->state->marked[task->order[i]] = job->rule(task, task->order[i]);
    }
    return ALP_OK;
}

alp_result alpi_occlusion_mark(alpi_occlusion_state *state, alpi_occlusion_rule *rule)
{
    mark_job job = {state, rule};
    return alpi_occlusion_for_texels(&state->clock, mark_range, &job);
}

/// Moves the marked texels to state->list, chart by chart, each chart in the order of the task.
static alp_result list_marked(alpi_occlusion_state *state, uint32_t *count)
{
    const alpi_occlusion_task *task = state->task;
    alpi_chart_deal_clear(&state->deal);
    for (uint32_t i = 0; i < task->count; i++) {
        if (state->marked[task->order[i]] != 0) {
            alpi_chart_deal_count(&state->deal, task->order[i]);
        }
        ALP_TRY(i % TEXELS_PER_TICK == TEXELS_PER_TICK - 1 ? alpi_occlusion_tick(&state->clock)
                                                           : ALP_OK);
    }
    *count = alpi_chart_deal_start(&state->deal);
    for (uint32_t i = 0; *count > 0 && i < task->count; i++) {
        const uint32_t t = task->order[i];
        if (state->marked[t] != 0) {
            state->marked[t] = 0;
            state->list[alpi_chart_deal_place(&state->deal, t)] = t;
        }
        ALP_TRY(i % TEXELS_PER_TICK == TEXELS_PER_TICK - 1 ? alpi_occlusion_tick(&state->clock)
                                                           : ALP_OK);
    }
    return ALP_OK;
}

/// Traces samples [first, state->samples) of the listed texels.
static alp_result trace_list(alpi_occlusion_state *state, uint32_t count, uint32_t first)
{
    const alpi_occlusion_task *task = state->task;
    const uint32_t more = state->samples - first;
    alpi_task_progress progress = alpi_occlusion_progress_of_rays(&state->clock);
    progress.started = state->clock.started;
    progress.units_before = (double)state->report->rays;
    progress.units_total = progress.units_before + (double)count * more;
    ALP_TRY(alpi_occlusion_add(task->setup, task->receivers, state->list, count, first, more,
                               state->samples, &progress, &state->scratch->sums));
    state->report->rays += (uint64_t)count * more;
    return ALP_OK;
}

static alp_result store_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_occlusion_state *state = user;
    alpi_lattice *lattice = state->task->lattice;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = state->list[i];
        if (state->scratch->sums.done[t] > 0) {
            lattice->states[t] = ALPI_TEXEL_TRACED;
            lattice->values[t] = alpi_occlusion_value(&state->scratch->sums, t);
        }
    }
    return ALP_OK;
}

/// Traces the list and stores the values of texels that got rays, even where it was cut off.
static alp_result trace_and_store(alpi_occlusion_state *state, uint32_t count, uint32_t first)
{
    const alp_result traced = trace_list(state, count, first);
    const alp_result stored = alpi_parallel_for(state->task->setup->context, count,
                                                TEXELS_PER_RANGE, store_range, state, NULL);
    return traced != ALP_OK ? traced : stored;
}

alp_result alpi_occlusion_trace_marked(alpi_occlusion_state *state, uint32_t *count)
{
    ALP_TRY(list_marked(state, count));
    return trace_and_store(state, *count, 0);
}

static bool is_traced(const alpi_occlusion_task *task, uint32_t texel)
{
    return task->lattice->states[texel] == ALPI_TEXEL_TRACED;
}

void alpi_occlusion_extend_quarters(alpi_occlusion_sums *sums, const uint32_t *list, uint32_t count,
                                    uint32_t before, uint32_t samples)
{
    const bool merge = samples % before == 0;
    sums->parted = merge ? 0 : before;
    for (uint32_t i = 0; i < count && merge; i++) {
        alpi_occlusion_requarter(sums, list[i], before, samples);
    }
}

alp_result alpi_occlusion_trace_more(alpi_occlusion_state *state)
{
    uint32_t count = 0;
    ALP_TRY(alpi_occlusion_mark(state, is_traced));
    ALP_TRY(list_marked(state, &count));
    alpi_occlusion_extend_quarters(&state->scratch->sums, state->list, count, state->before,
                                   state->samples);
    return trace_and_store(state, count, state->before);
}
