// SPDX-License-Identifier: MIT
#include "maps/texels/occlusion_map.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/texels/bent.h"
#include "maps/texels/chart_deal.h"
#include "maps/texels/stated_error.h"
#include "maps/texels/validity.h"

#include <math.h>

enum {
    TEXELS_PER_RANGE = 1 << 12,
    TEXELS_PER_TICK = 1 << 16,
    FLOOD_ROUNDS = 4,
    FIRST_SAMPLES = 64, // of the first round of a bake that goes for an error
    LEAST_PROBES = 512,
    MOST_PROBES = 8192,
    TRACED_PER_PROBE = 16
};

// What is still interpolated, in standard deviations of the noise (by the spread of quarters, which
// makes about 1.8 of a true one): the bend of a stencil, the difference between its texels, and the
// kink at a texel beside a traced one. Chosen on cornell, teapot-room and torus-plane: with twice
// the bend a tenth fewer texels are traced and what is interpolated grows three times darker, with
// twice the others small shadows get lost.
static const float BEND_LIMIT = 1.0f, SPREAD_LIMIT = 40.0f, KINK_LIMIT = 2.0f;
// Shares of them near another surface: these cost the same error as tracing all of it there, and a
// quarter less time on cornell.
static const float NEAR_SPREAD = 0.1f, NEAR_BEND = 0.5f;

typedef struct map_job {
    const alpi_occlusion_setup *setup;
    const alpi_receivers *receivers;
    const uint32_t *order;
    uint32_t order_count;
    const alpi_occlusion_map_options *options;
    alpi_lattice *lattice;
    alpi_scratch *scratch;
    alpi_probes probes;
    float *errors;
    alpi_occlusion_map_report *report;
    uint8_t *wanted;      // [texels] to be traced next
    uint32_t *list;       // [order_count]
    alpi_chart_deal deal; // of the lists
    uint32_t samples;     // of this round
    uint32_t before;      // of the round before, 0 in the first
    double started;       // alpi_seconds()
    alp_progress told;    // last
    double asked;         // alpi_seconds() when the user was
    bool refused;         // by the user
    float noise;          // standard deviation of a traced texel by its spread, root mean square

    // Of the pass that runs.
    uint32_t pass;
    bool flood;
    float spread_limit, bend_limit, kink_limit;
} map_job;

// --- progress and the deadline -------------------------------------------------------------------

/// Asks the user, and the clock.
static bool go_on(void *user, const alp_progress *progress)
{
    map_job *job = user;
    alp_progress_fn *callback = job->options->progress;
    job->told = *progress;
    job->asked = alpi_seconds();
    if (callback != NULL && !callback(job->options->progress_user, progress)) {
        job->refused = true;
    }
    return !job->refused && alpi_seconds() < job->options->deadline;
}

/// Asks the user between rays, in work that is short and of no use by halves: not the clock, and
/// nobody where what there is will be kept.
static bool go_on_briefly(void *user, const alp_progress *progress)
{
    map_job *job = user;
    const double interval = 0.05; // seconds
    (void)progress;
    if (job->options->keep_partial || alpi_seconds() - job->asked < interval) {
        return true;
    }
    const alp_progress told = job->told;
    (void)go_on(job, &told);
    return !job->refused;
}

/// What loops over texels between the rays tell.
static alpi_task_progress brief(map_job *job)
{
    return (alpi_task_progress){.callback = go_on_briefly, .user = job, .stage = "occlusion"};
}

static alp_result for_texels(map_job *job, alpi_task_fn *body)
{
    const alpi_task_progress progress = brief(job);
    return alpi_parallel_for(job->setup->context, job->order_count, TEXELS_PER_RANGE, body, job,
                             &progress);
}

static alp_result sum_texels(map_job *job, alpi_sum_fn *body, double sums[ALPI_SUM_LIMIT])
{
    const alpi_task_progress progress = brief(job);
    return alpi_parallel_sum(job->setup->context, job->order_count, body, job, &progress, sums);
}

static alp_result tick(map_job *job)
{
    alp_result result =
        alpi_tick(job->setup->context, "occlusion", job->told.done, job->told.total);
    job->refused = job->refused || result == ALP_ERROR_CANCELLED;
    return result;
}

/// Lists the texels that are wanted, or those that are traced already: chart by chart, in their
/// order.
static alp_result list_texels(map_job *job, bool traced, uint32_t *count)
{
    alpi_chart_deal_clear(&job->deal);
    for (uint32_t i = 0; i < job->order_count; i++) {
        const uint32_t t = job->order[i];
        if (traced) {
            job->wanted[t] = job->lattice->states[t] == ALPI_TEXEL_TRACED;
        }
        if (job->wanted[t] != 0) {
            alpi_chart_deal_count(&job->deal, t);
        }
        if (i % TEXELS_PER_TICK == TEXELS_PER_TICK - 1) {
            ALP_TRY(tick(job));
        }
    }
    *count = alpi_chart_deal_start(&job->deal);
    const uint32_t listed = *count;
    for (uint32_t i = 0; i < job->order_count && listed > 0; i++) {
        const uint32_t t = job->order[i];
        if (job->wanted[t] != 0) {
            job->wanted[t] = 0;
            job->list[alpi_chart_deal_place(&job->deal, t)] = t;
        }
        if (i % TEXELS_PER_TICK == TEXELS_PER_TICK - 1) {
            ALP_TRY(tick(job));
        }
    }
    return ALP_OK;
}

/// Samples [first, first + count) for the texels in job->list; they will have job->samples.
static alp_result trace_list(map_job *job, uint32_t list_count, uint32_t first, uint32_t count)
{
    const alpi_task_progress progress = {.callback = go_on,
                                         .user = job,
                                         .stage = "occlusion",
                                         .started = job->started,
                                         .units_before = (double)job->report->rays,
                                         .units_total = (double)job->report->rays +
                                                        (double)list_count * count};
    ALP_TRY(alpi_occlusion_add(job->setup, job->receivers, job->list, list_count, first, count,
                               job->samples, &progress, &job->scratch->sums));
    job->report->rays += (uint64_t)list_count * count;
    return ALP_OK;
}

static alp_result take_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const map_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->list[i];
        if (job->scratch->sums.done[t] > 0) {
            job->lattice->states[t] = ALPI_TEXEL_TRACED;
            job->lattice->values[t] = alpi_occlusion_value(&job->scratch->sums, t);
        }
    }
    return ALP_OK;
}

/// Traces the list and takes the values of those that got rays, be it in part.
static alp_result trace_and_take(map_job *job, uint32_t count, uint32_t before)
{
    const alp_result traced = trace_list(job, count, before, job->samples - before);
    const alp_result taken =
        alpi_parallel_for(job->setup->context, count, TEXELS_PER_RANGE, take_range, job, NULL);
    return traced != ALP_OK ? traced : taken;
}

/// @param count out: how many there were
static alp_result trace_wanted(map_job *job, uint32_t *count)
{
    ALP_TRY(list_texels(job, false, count));
    return trace_and_take(job, *count, 0);
}

// --- the lattice ---------------------------------------------------------------------------------

static alp_result judge_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const map_job *job = user;
    const alpi_lattice_judge judge = {.lattice = job->lattice,
                                      .order = job->order,
                                      .proximity = job->options->near,
                                      .wanted = job->wanted,
                                      .near_spread = NEAR_SPREAD,
                                      .near_bend = NEAR_BEND,
                                      .spread = job->spread_limit,
                                      .bend = job->bend_limit,
                                      .kink = job->kink_limit,
                                      .pass = job->pass,
                                      .flood = job->flood};
    alpi_lattice_judge_range(&judge, begin, end);
    return ALP_OK;
}

static alp_result judge(map_job *job, uint32_t pass, bool flood)
{
    job->pass = pass;
    job->flood = flood;
    return for_texels(job, judge_range);
}

/// Interpolates anew what is interpolated.
static alp_result renew_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const map_job *job = user;
    alpi_lattice *l = job->lattice;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        alpi_stencil stencil;
        if (l->states[t] == ALPI_TEXEL_INTERPOLATED &&
            alpi_lattice_pass(l->texels->pixels[t]) == job->pass &&
            alpi_lattice_stencil(l, t, &stencil)) {
            l->values[t] = alpi_lattice_interpolate(l, &stencil);
        }
    }
    return ALP_OK;
}

/// What was traced since may be in the stencils of what was interpolated before. Pass by pass: a
/// stencil holds texels of coarser passes alone.
static alp_result renew(map_job *job)
{
    for (job->pass = 1; job->pass < ALPI_LATTICE_PASSES; job->pass++) {
        ALP_TRY(for_texels(job, renew_range));
    }
    return ALP_OK;
}

/// Wants texels traced whatever their stencils say: those that touch another surface, and of those
/// near one every second of every second row. A contact shadow may be smaller than the lattice.
/// Ward's criterion: light changes over the distance to what is seen. G. J. Ward, F. M. Rubinstein,
/// R. D. Clear. A Ray Tracing Solution for Diffuse Interreflection. SIGGRAPH 1988.
static alp_result want_near(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const map_job *job = user;
    for (uint32_t i = begin; i < end && job->options->near != NULL; i++) {
        const uint32_t t = job->order[i];
        const uint8_t near = job->options->near[t];
        job->wanted[t] =
            near == ALPI_TOUCHING ||
            (near == ALPI_NEAR && alpi_lattice_is_coarse(job->lattice->texels->pixels[t]));
    }
    return ALP_OK;
}

static void sum_noise(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const map_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        if (job->lattice->states[t] == ALPI_TEXEL_TRACED) {
            sums[0] += alpi_spread_variance(&job->scratch->sums, t);
            sums[1] += 1.0;
        }
    }
}

/// Root mean square over the traced texels.
static alp_result measure_noise(map_job *job)
{
    double sums[ALPI_SUM_LIMIT];
    ALP_TRY(sum_texels(job, sum_noise, sums));
    job->noise = sums[1] > 0.0 ? (float)sqrt(sums[0] / sums[1]) : 0.0f;
    return ALP_OK;
}

/// Limits of a pass that interpolates over `spacing` texels: by the noise, or the seed's
/// Accuracy^Spacing for values in [0, 1], which looks at differences alone.
static void set_limits(map_job *job, float spacing)
{
    const float accuracy = job->options->accuracy;
    const bool automatic = accuracy < 0.0f;
    job->spread_limit = automatic ? SPREAD_LIMIT * job->noise : 1.0f - powf(accuracy, spacing);
    job->bend_limit = automatic ? BEND_LIMIT * job->noise : HUGE_VALF;
    job->kink_limit = automatic ? KINK_LIMIT * job->noise : 0.5f * (1.0f - accuracy);
}

static alp_result run_lattice(map_job *job)
{
    uint32_t count = 0, flooded = 0;
    ALP_TRY(judge(job, 0, false));
    ALP_TRY(trace_wanted(job, &count));
    ALP_TRY(measure_noise(job));
    for (uint32_t pass = 1; pass < ALPI_LATTICE_PASSES; pass++) {
        set_limits(job, 2.0f * (float)alpi_lattice_reach(pass));
        ALP_TRY(judge(job, pass, false));
        ALP_TRY(trace_wanted(job, &count));
    }
    count = 1;
    for (int round = 0; round < FLOOD_ROUNDS && count > 0; round++) {
        ALP_TRY(judge(job, 0, true));
        ALP_TRY(trace_wanted(job, &count));
        flooded += count;
    }
    return flooded > 0 ? renew(job) : ALP_OK;
}

static alp_result want_all(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const map_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        job->wanted[t] = job->lattice->states[t] != ALPI_TEXEL_TRACED;
    }
    return ALP_OK;
}

// --- rounds --------------------------------------------------------------------------------------

static alp_result requarter_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    map_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        alpi_occlusion_requarter(&job->scratch->sums, job->list[i], job->before, job->samples);
    }
    return ALP_OK;
}

/// Whether quarters grow by what this round adds; else, in the last one, each gets its share of
/// the new samples.
static bool quarters_grow(const map_job *job)
{
    return job->samples % job->before == 0;
}

/// Gives the texels that were traced in the round before the rest.
static alp_result extend_traced(map_job *job)
{
    uint32_t count = 0;
    ALP_TRY(list_texels(job, true, &count));
    if (quarters_grow(job)) {
        ALP_TRY(alpi_parallel_for(job->setup->context, count, TEXELS_PER_RANGE, requarter_range,
                                  job, NULL));
    } else {
        job->scratch->sums.parted = job->before;
    }
    return trace_and_take(job, count, job->before);
}

static alp_result run_round(map_job *job)
{
    const bool adaptive = job->options->accuracy != ALP_ADAPTIVE_OFF;
    if (job->before > 0) {
        ALP_TRY(extend_traced(job));
    } else if (adaptive) {
        ALP_TRY(for_texels(job, want_near));
    } else {
        ALP_TRY(for_texels(job, want_all));
    }
    uint32_t count = 0;
    return adaptive ? run_lattice(job) : trace_wanted(job, &count);
}

/// Chooses the held-out texels, more of them the more are traced.
static alp_result choose_probes(map_job *job)
{
    double sums[ALPI_SUM_LIMIT];
    ALP_TRY(sum_texels(job, sum_noise, sums));
    uint32_t count = (uint32_t)sums[1] / TRACED_PER_PROBE;
    count = count < LEAST_PROBES ? LEAST_PROBES : count > MOST_PROBES ? MOST_PROBES : count;
    ALP_TRY(alpi_probes_create(job->setup, job->receivers, job->order, job->order_count, count,
                               &job->probes));
    alpi_probes_deal(&job->probes, &job->deal);
    return ALP_OK;
}

static void requarter_probes(map_job *job)
{
    for (int k = 0; k < 2; k++) {
        alpi_occlusion_sums *sums = &job->probes.sums[k];
        sums->parted = quarters_grow(job) ? 0 : job->before;
        for (uint32_t i = 0; i < job->probes.count && quarters_grow(job); i++) {
            alpi_occlusion_requarter(sums, i, job->before, job->samples);
        }
    }
}

/// Sends the held-out rays of this round and finds the errors, also where those were cut off.
static alp_result state_errors(map_job *job)
{
    if (job->before == 0) {
        ALP_TRY(choose_probes(job));
    } else {
        requarter_probes(job);
    }
    const alpi_task_progress progress = {.callback = go_on, .user = job, .stage = "occlusion"};
    const uint32_t more = job->samples - job->before;
    alp_result result = alpi_probes_add(&job->probes, job->before, more, job->samples, &progress);
    job->report->rays += 2 * (uint64_t)job->probes.count * more;
    if (job->refused && !job->options->keep_partial) {
        return result;
    }
    const alpi_task_progress between = brief(job);
    alpi_relative_error relative;
    ALP_TRY(alpi_state_errors(&job->probes, job->lattice, &job->scratch->sums, job->order,
                              job->order_count, &between, job->errors));
    ALP_TRY(alpi_find_relative_error(job->lattice, job->errors, job->order, job->order_count,
                                     &between, &relative));
    job->report->relative = relative.rms;
    job->report->p99 = relative.p99;
    return result;
}

/// How many times the samples the error asks for: 2, 3, 4, 6, 8 … The error of these sequences
/// falls as samples^−0.7, and a little more is cheaper than one more round.
static uint32_t next_factor(const map_job *job)
{
    const double wanted = (double)job->options->error;
    const double over =
        fmax(job->report->relative / wanted, job->report->p99 / (ALPI_P99_LIMIT * wanted));
    const double needed = pow(1.05 * over, 1.0 / 0.7);
    uint32_t factor = 2;
    while (factor < needed && factor < 64) {
        factor = factor % 3 == 0 ? factor / 3 * 4 : factor / 2 * 3;
    }
    return factor;
}

static alp_result run_rounds(map_job *job)
{
    const double wanted = (double)job->options->error;
    const bool rounds = wanted > 0.0 || job->options->deadline < HUGE_VAL;
    const uint32_t most = job->setup->samples;
    job->samples = rounds && most > FIRST_SAMPLES ? FIRST_SAMPLES : most;
    for (;;) {
        ALP_TRY(run_round(job));
        job->report->samples = job->samples;
        ALP_TRY(state_errors(job));
        const bool good =
            job->report->relative <= wanted && job->report->p99 <= ALPI_P99_LIMIT * wanted;
        if (!rounds || good || job->samples == most) {
            return ALP_OK;
        }
        const uint32_t factor = wanted > 0.0 ? next_factor(job) : 2;
        job->before = job->samples;
        job->samples = factor < most / job->before ? factor * job->before : most;
    }
}

// --- the map -------------------------------------------------------------------------------------

static alp_result want_none(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const map_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        job->wanted[job->order[i]] = 0;
    }
    return ALP_OK;
}

/// Ends a map that was cut off: what has no value takes one from its neighbours where it can.
static alp_result make_do(map_job *job)
{
    job->report->cut_off = true;
    job->spread_limit = job->bend_limit = HUGE_VALF;
    ALP_TRY(for_texels(job, want_none));
    for (uint32_t pass = 1; pass < ALPI_LATTICE_PASSES; pass++) {
        ALP_TRY(judge(job, pass, false));
    }
    return ALP_OK;
}

/// Cuts off what a cubic overshoots and counts the texels of each state.
static void settle(const void *user, uint32_t begin, uint32_t end, double counts[ALPI_SUM_LIMIT])
{
    const map_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        float *value = &job->lattice->values[job->order[i]];
        *value = fminf(fmaxf(*value, 0.0f), 1.0f);
        counts[job->lattice->states[job->order[i]]] += 1.0;
    }
}

static alp_result finish(map_job *job, bool late)
{
    alp_context *context = job->setup->context;
    double counts[ALPI_SUM_LIMIT];
    ALP_TRY(sum_texels(job, settle, counts));
    job->report->traced = (uint64_t)counts[ALPI_TEXEL_TRACED];
    job->report->interpolated = (uint64_t)counts[ALPI_TEXEL_INTERPOLATED];
    job->report->unknown = (uint64_t)counts[ALPI_TEXEL_OPEN];
    if (job->report->cut_off && job->report->traced == 0) {
        return alpi_fail(context, late ? ALP_ERROR_LIMIT : ALP_ERROR_CANCELLED,
                         "sampling ended before any texel had a value; allow more time");
    }
    const alpi_task_progress progress = brief(job);
    return job->options->bent == NULL
               ? ALP_OK
               : alpi_bent_normals(job->lattice, &job->scratch->sums, job->order, job->order_count,
                                   &progress, job->options->bent);
}

static alp_result run(map_job *job)
{
    alp_context *context = job->setup->context;
    ALPI_TRY_NEW(context, job->list, job->order_count);
    ALP_TRY(alpi_chart_deal_open(context, job->lattice->texels->charts, job->order,
                                 job->order_count, &job->deal));
    job->wanted = job->scratch->marks;
    alp_result result = run_rounds(job);
    const bool late = !job->refused && alpi_seconds() >= job->options->deadline;
    if (result == ALP_ERROR_CANCELLED && (late || job->options->keep_partial)) {
        result = make_do(job);
    }
    return result == ALP_OK ? finish(job, late) : result;
}

alp_result alpi_occlusion_map(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              const uint32_t *order, uint32_t order_count,
                              const alpi_occlusion_map_options *options, alpi_lattice *lattice,
                              float *errors, alpi_occlusion_map_report *report)
{
    *report = (alpi_occlusion_map_report){.relative = (double)NAN, .p99 = (double)NAN};
    map_job job = {.setup = setup,
                   .receivers = receivers,
                   .order = order,
                   .order_count = order_count,
                   .options = options,
                   .lattice = lattice,
                   .started = alpi_seconds(),
                   .asked = alpi_seconds(),
                   .told = {.stage = "occlusion", .seconds_left = -1.0},
                   .errors = errors,
                   .report = report};
    alpi_scratch own = {0};
    job.scratch = options->scratch;
    if (job.scratch == NULL) {
        ALP_TRY(alpi_scratch_create(setup->context, receivers->count, setup->bent, &own));
        job.scratch = &own;
    }
    alp_result result = run(&job);
    alpi_probes_destroy(&job.probes);
    alpi_scratch_destroy(&own);
    alpi_chart_deal_close(&job.deal);
    alpi_release(setup->context, job.list);
    return result;
}
