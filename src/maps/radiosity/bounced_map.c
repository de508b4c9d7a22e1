// SPDX-License-Identifier: MIT
#include "maps/radiosity/bounced_map.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "maps/texels/pooled_variance.h"
#include "maps/texels/validity.h"

#include <math.h>
#include <string.h>

enum { TEXELS_PER_RANGE = 1 << 9 }; // few, as some passes are short
enum { FLOOD_ROUNDS = 4, STREAM_HELD_OUT = 10, STREAM_PROBES = 11 };
enum { LIST_LIMIT = 1 << 16 }; // texels traced in one go: as many as keep all workers busy

// In standard deviations of the noise, as of occlusion (occlusion_map.c).
static const float BEND_LIMIT = 1.0f, SPREAD_LIMIT = 20.0f, KINK_LIMIT = 2.0f;
/// Share of the spread near another surface: docs/how/light.md, "The final gather".
static const float NEAR_SPREAD = 0.3f;

typedef struct texel_list {
    const uint32_t *texels;
    uint32_t count;
} texel_list;

typedef struct bounced_job {
    const alpi_bounced_options *options;
    alpi_lattice lattice; // states and values are of this map
    alpi_task_progress progress;
    alpi_bounced_report *report;
    uint8_t *wanted;   // [texels] to be traced next
    uint32_t *by_pass; // [count] the order, pass by pass; NULL where not adaptive
    uint32_t pass_first[ALPI_LATTICE_PASSES + 1];
    texel_list now; // what is gone through
    uint32_t *list; // [LIST_LIMIT], or count if that is less
    float noise;  // standard deviation of the mean of the channels, over the root mean square light
    float level;  // mean light
    float factor; // true variances over those that replicates state
    uint32_t pass;
    bool flood;
    uint64_t gathered, expected; // texels, those held out too
} bounced_job;

static texel_list all_texels(const bounced_job *job)
{
    return (texel_list){job->options->order, job->options->count};
}

static texel_list texels_of(const bounced_job *job, uint32_t pass)
{
    const uint32_t first = job->pass_first[pass];
    return (texel_list){job->by_pass + first, job->pass_first[pass + 1] - first};
}

static alp_result for_texels(bounced_job *job, texel_list texels, alpi_task_fn *body)
{
    alpi_task_progress told = job->progress;
    told.units_total = 0.0;
    job->now = texels;
    return alpi_parallel_for(job->lattice.context, texels.count, TEXELS_PER_RANGE, body, job,
                             &told);
}

// --- rays ----------------------------------------------------------------------------------------

static void scale_variance(const bounced_job *job, alpi_reference_value *v)
{
    for (int k = 0; k < 3; k++) {
        v->variance[k] *= job->factor;
    }
}

/// Traces `count` texels of the list. @param gather what is written
static alp_result gather_list(bounced_job *job, uint32_t count, alpi_gather_job gather)
{
    gather.list = job->list;
    gather.count = count;
    const double rays = (double)gather.gatherer->packet_count * ALPI_PACKET;
    alpi_task_progress told = job->progress;
    told.units_before = (double)job->report->rays;
    told.units_total = fmax((double)job->expected, (double)job->gathered + count) * rays;
    job->report->rays += (uint64_t)(count * rays);
    job->gathered += count;
    return alpi_gather_irradiance(&gather, &told);
}

/// Traces the texels of the list.
static alp_result trace_listed(bounced_job *job, uint32_t count)
{
    const alpi_gather_job *g = job->options->gather;
    ALP_TRY(gather_list(job, count, *g));
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t t = job->list[i];
        job->lattice.states[t] = ALPI_TEXEL_TRACED;
        job->lattice.values[t] = alpi_reference_level(&g->values[t]);
        scale_variance(job, &g->values[t]);
    }
    return ALP_OK;
}

/// Traces those of the texels that are wanted, so many at a time.
static alp_result trace_wanted(bounced_job *job, texel_list texels)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < texels.count; i++) {
        const uint32_t t = texels.texels[i];
        if (job->wanted[t] != 0) {
            job->wanted[t] = 0;
            job->list[count++] = t;
        }
        if (count == LIST_LIMIT) {
            ALP_TRY(trace_listed(job, count));
            count = 0;
        }
    }
    return trace_listed(job, count);
}

/// Some texels of a state, evenly and at random, into the list. @param count that there are
/// @param most the list shall hold @return how many it holds
static uint32_t choose(const bounced_job *job, alpi_texel_state state, uint32_t count,
                       uint32_t most, uint32_t stream)
{
    uint32_t chosen = 0, seen = 0;
    const double step = fmax((double)count / most, 1.0);
    const float offset = alpi_unit_float(alpi_random_key(count, 0, stream));
    double next = (double)offset * step;
    for (uint32_t i = 0; i < job->options->count && chosen < most; i++) {
        const uint32_t t = job->options->order[i];
        const bool hidden = (job->lattice.texels->flags[t] & ALPI_TEXEL_HIDDEN) != 0;
        if (job->lattice.states[t] == state && !hidden && (double)seen++ >= next) {
            job->list[chosen++] = t;
            next += step;
        }
    }
    return chosen;
}

/// Rays of their own from the listed texels, which stay as they are. @param found [count] out
static alp_result gather_beside(bounced_job *job, uint32_t count, const alpi_gatherer *gatherer,
                                alpi_reference_value *found)
{
    alpi_reference_value *values = job->options->gather->values;
    for (uint32_t i = 0; i < count; i++) { // the rays write into the map, which gets them back
        found[i] = values[job->list[i]];
    }
    alpi_gather_job alone = *job->options->gather;
    alone.gatherer = gatherer;
    alone.skies = NULL;
    alone.directional = NULL;
    const alp_result result = gather_list(job, count, alone);
    for (uint32_t i = 0; i < count; i++) {
        const alpi_reference_value kept = found[i];
        found[i] = values[job->list[i]];
        scale_variance(job, &found[i]);
        values[job->list[i]] = kept;
    }
    return result;
}

// --- probes --------------------------------------------------------------------------------------

/// Σ (x − y)² / 2 over Σ Var as it is stated, over the channels of some texels; 1 where nothing is
/// stated.
static float compare_probes(const bounced_job *job, const alpi_reference_value *found,
                            uint32_t count)
{
    double squares = 0.0, stated = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const alpi_reference_value *x = &job->options->gather->values[job->list[i]];
        for (int k = 0; k < 3; k++) {
            const double apart = (double)x->mean[k] - (double)found[i].mean[k];
            squares += 0.5 * apart * apart;
            stated += 0.5 * ((double)x->variance[k] + (double)found[i].variance[k]);
        }
    }
    return stated > 0.0 ? (float)(squares / stated) : 1.0f;
}

static void scale_traced(const bounced_job *job)
{
    for (uint32_t i = 0; i < job->options->count; i++) {
        const uint32_t t = job->options->order[i];
        if (job->lattice.states[t] == ALPI_TEXEL_TRACED) {
            scale_variance(job, &job->options->gather->values[t]);
        }
    }
}

/// Finds how far the spread of joined replicates is from the truth, and makes it true.
static alp_result find_factor(bounced_job *job, uint32_t traced)
{
    enum { LEAST = 64, SHARE = 8 }; // a tenth of that error is chance, and an eighth of the rays
    if (traced < LEAST && job->report->factor > 0.0f) {
        job->factor = job->report->factor;
        scale_traced(job);
        return ALP_OK;
    }
    const uint32_t few = traced / SHARE > LEAST ? traced / SHARE : LEAST;
    const uint32_t most = few < ALPI_BOUNCED_PROBES ? few : ALPI_BOUNCED_PROBES;
    const uint32_t count = choose(job, ALPI_TEXEL_TRACED, traced, most, STREAM_PROBES);
    alpi_reference_value *found = ALPI_NEW(job->lattice.context, alpi_reference_value, count);
    if (found == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result = gather_beside(job, count, job->options->beside, found);
    if (result == ALP_OK) {
        job->factor = compare_probes(job, found, count);
        job->report->factor = job->factor;
        scale_traced(job);
    }
    alpi_release(job->lattice.context, found);
    return result;
}

// --- the lattice ---------------------------------------------------------------------------------

/// What differences of light may be called noise about a texel of this light. In part of the mean
/// over the map: in the dark it takes less to be good enough.
static float noise_at(const void *user, float level)
{
    const bounced_job *job = user;
    return job->noise * 0.5f * (fmaxf(level, 0.0f) + job->level);
}

static alp_result judge_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    bounced_job *job = user;
    const alpi_lattice_judge judge = {.lattice = &job->lattice,
                                      .order = job->now.texels,
                                      .near = job->options->near,
                                      .wanted = job->wanted,
                                      .spread = SPREAD_LIMIT,
                                      .bend = BEND_LIMIT,
                                      .kink = KINK_LIMIT,
                                      .noise = noise_at,
                                      .near_spread = NEAR_SPREAD,
                                      .near_bend = 1.0f,
                                      .user = job,
                                      .pass = job->pass,
                                      .flood = job->flood};
    alpi_lattice_judge_range(&judge, begin, end);
    return ALP_OK;
}

/// Interpolates what may be of a pass, and traces what may not.
static alp_result run_pass(bounced_job *job, uint32_t pass)
{
    const texel_list texels = texels_of(job, pass);
    job->pass = pass;
    job->flood = false;
    ALP_TRY(for_texels(job, texels, judge_range));
    return trace_wanted(job, texels);
}

/// @param traced out: how many texels
static alp_result flood(bounced_job *job, uint64_t *traced)
{
    const uint64_t before = job->gathered;
    job->flood = true;
    ALP_TRY(for_texels(job, all_texels(job), judge_range));
    ALP_TRY(trace_wanted(job, all_texels(job)));
    *traced = job->gathered - before;
    return ALP_OK;
}

/// Wants the lattice traced, whose texels no stencil ends at, and what touches another surface, in
/// every second row every second, or all: light that bounced changes less at once than occlusion
/// does.
static alp_result want_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const bounced_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->now.texels[i];
        const uint16_t *pixel = job->lattice.texels->pixels[t];
        const uint8_t near = job->options->near != NULL ? job->options->near[t] : ALPI_FAR;
        job->wanted[t] = job->lattice.states[t] == ALPI_TEXEL_OPEN &&
                         (!job->options->adaptive || alpi_lattice_pass(pixel) == 0 ||
                          (near == ALPI_TOUCHING && alpi_lattice_is_coarse(pixel)));
    }
    return ALP_OK;
}

static void sum_noise(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const bounced_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->options->order[i];
        const alpi_reference_value *v = &job->options->gather->values[t];
        if (job->lattice.states[t] == ALPI_TEXEL_TRACED) {
            const double level = (double)alpi_reference_level(v);
            // Channels go up and down together.
            sums[0] +=
                ((double)v->variance[0] + (double)v->variance[1] + (double)v->variance[2]) / 3.0;
            sums[1] += level;
            sums[2] += level * level;
        }
    }
}

static alp_result measure_noise(bounced_job *job, uint32_t traced)
{
    double sums[ALPI_SUM_LIMIT] = {0.0};
    ALP_TRY(
        alpi_parallel_sum(job->lattice.context, job->options->count, sum_noise, job, NULL, sums));
    job->noise = sums[2] > 0.0 ? (float)sqrt(sums[0] / sums[2]) : 0.0f;
    job->level = traced > 0 ? (float)(sums[1] / traced) : 0.0f;
    return ALP_OK;
}

static uint32_t count_traced(const bounced_job *job)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->options->count; i++) {
        count += job->lattice.states[job->options->order[i]] == ALPI_TEXEL_TRACED;
    }
    return count;
}

// --- what is interpolated ------------------------------------------------------------------------

void alpi_bounced_interpolate(const alpi_gather_job *g, uint32_t t, const alpi_stencil *s)
{
    float light[3] = {0.0f, 0.0f, 0.0f}, sky[3] = {0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < s->count; i++) {
        for (int k = 0; k < 3; k++) {
            light[k] += s->weights[i] * g->values[s->texels[i]].mean[k];
            sky[k] += g->skies != NULL ? s->weights[i] * g->skies[s->texels[i]][k] : 0.0f;
        }
    }
    for (int k = 0; k < 3; k++) {
        g->values[t].mean[k] = fmaxf(light[k], 0.0f); // a cubic may overshoot
        if (g->skies != NULL) {
            g->skies[t][k] = fminf(fmaxf(sky[k], 0.0f), g->values[t].mean[k]);
        }
    }
}

static void interpolate_directional(alpi_directional *values, uint32_t t, const alpi_stencil *s)
{
    alpi_directional made = {.toward = {0.0f, 0.0f, 0.0f}};
    for (uint32_t i = 0; i < s->count; i++) {
        const alpi_directional *v = &values[s->texels[i]];
        for (int k = 0; k < 3; k++) {
            for (int c = 0; c < ALPI_SH1_COUNT; c++) {
                made.sh[c][k] += s->weights[i] * v->sh[c][k];
            }
            made.toward[k] += s->weights[i] * v->toward[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        made.sh[0][k] = fmaxf(made.sh[0][k], 0.0f); // a cubic may overshoot
    }
    values[t] = made;
}

/// Interpolates the channels, and the level anew: what was traced since may be in its stencil.
static alp_result interpolate_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const bounced_job *job = user;
    const alpi_lattice *l = &job->lattice;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->now.texels[i];
        alpi_stencil stencil;
        if (l->states[t] == ALPI_TEXEL_INTERPOLATED && alpi_lattice_stencil(l, t, &stencil)) {
            l->values[t] = alpi_lattice_interpolate(l, &stencil);
            alpi_bounced_interpolate(job->options->gather, t, &stencil);
            if (job->options->gather->directional != NULL) {
                interpolate_directional(job->options->gather->directional, t, &stencil);
            }
        }
    }
    return ALP_OK;
}

static alp_result run_lattice(bounced_job *job)
{
    ALP_TRY(for_texels(job, all_texels(job), want_range));
    ALP_TRY(trace_wanted(job, all_texels(job)));
    const uint32_t traced = count_traced(job);
    if (job->options->joined) {
        ALP_TRY(find_factor(job, traced));
    }
    ALP_TRY(measure_noise(job, traced));
    if (!job->options->adaptive) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(job->lattice.context, job->by_pass, job->options->count);
    ALP_TRY(alpi_lattice_split(&job->lattice, job->options->order, job->options->count,
                               job->by_pass, job->pass_first));
    for (uint32_t pass = 1; pass < ALPI_LATTICE_PASSES; pass++) {
        ALP_TRY(run_pass(job, pass));
    }
    uint64_t last = 1;
    for (int round = 0; round < FLOOD_ROUNDS && last > 0; round++) {
        ALP_TRY(flood(job, &last));
    }
    for (uint32_t pass = 1; pass < ALPI_LATTICE_PASSES; pass++) {
        ALP_TRY(for_texels(job, texels_of(job, pass), interpolate_range));
    }
    alpi_release(job->lattice.context, job->by_pass); // errors take as much
    job->by_pass = NULL;
    return ALP_OK;
}

// --- errors --------------------------------------------------------------------------------------

void alpi_held_out_error(const uint32_t *texels, const alpi_reference_value *found, uint32_t count,
                         const alpi_reference_value *values, float variance[3])
{
    for (int k = 0; k < 3; k++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            const double apart = (double)values[texels[i]].mean[k] - (double)found[i].mean[k];
            sum += apart * apart - (double)found[i].variance[k];
        }
        variance[k] = (float)fmax(sum / fmax((double)count, 1.0), 0.0);
    }
}

/// Mean square error of what was interpolated, by channel: rays of their own from some of it.
static alp_result measure_interpolated(bounced_job *job, uint32_t interpolated, float variance[3])
{
    alp_context *context = job->lattice.context;
    const alpi_gather_job *g = job->options->gather;
    alpi_held_out *held = job->options->held_out;
    if (held != NULL && held->count > 0) {
        memcpy(job->list, held->texels, held->count * sizeof *job->list);
        return gather_beside(job, held->count, job->options->beside, held->values);
    }
    const uint32_t count =
        choose(job, ALPI_TEXEL_INTERPOLATED, interpolated, ALPI_HELD_OUT, STREAM_HELD_OUT);
    alpi_reference_value *found = ALPI_NEW(context, alpi_reference_value, count);
    if (found == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result = gather_beside(job, count, g->gatherer, found);
    if (result == ALP_OK) {
        alpi_held_out_error(job->list, found, count, g->values, variance);
    }
    if (result == ALP_OK && held != NULL) {
        held->count = count;
        memcpy(held->texels, job->list, count * sizeof *held->texels);
        memcpy(held->values, found, count * sizeof *held->values);
    }
    alpi_release(context, found);
    return result;
}

static alp_result state_errors(bounced_job *job)
{
    const uint32_t traced = count_traced(job), interpolated = job->options->count - traced;
    float variance[3] = {0.0f, 0.0f, 0.0f};
    job->report->traced = traced;
    job->report->interpolated = interpolated;
    ALP_TRY(alpi_pool_variances(&job->lattice, job->options->gather->values));
    const bool held = job->options->held_out != NULL && job->options->held_out->count > 0;
    if (interpolated > 0 || held) {
        ALP_TRY(measure_interpolated(job, interpolated, variance));
    }
    for (uint32_t i = 0; i < job->options->count; i++) {
        const uint32_t t = job->options->order[i];
        if (job->lattice.states[t] != ALPI_TEXEL_TRACED) {
            memcpy(job->options->gather->values[t].variance, variance, sizeof variance);
        }
    }
    return ALP_OK;
}

// --- the map -------------------------------------------------------------------------------------

/// What is hidden is known. Rays from within a solid would meet places that are hidden themselves,
/// but in texels that show what light falls on the rest of them.
static void start_texel(bounced_job *job, uint32_t texel)
{
    const bool hidden = (job->lattice.texels->flags[texel] & ALPI_TEXEL_HIDDEN) != 0;
    job->lattice.states[texel] = hidden ? ALPI_TEXEL_TRACED : ALPI_TEXEL_OPEN;
    if (hidden) {
        job->options->gather->values[texel] = (alpi_reference_value){0};
        job->lattice.values[texel] = 0.0f;
    }
}

static alp_result run(bounced_job *job)
{
    alp_context *context = job->lattice.context;
    const uint32_t texels = job->lattice.texels->count;
    ALPI_TRY_NEW(context, job->wanted, texels);
    ALPI_TRY_NEW(context, job->list,
                 job->options->count < LIST_LIMIT ? job->options->count : LIST_LIMIT);
    if (job->lattice.values == NULL) {
        ALPI_TRY_NEW(context, job->lattice.values, texels);
    }
    for (uint32_t i = 0; i < job->options->count; i++) {
        start_texel(job, job->options->order[i]);
    }
    ALP_TRY(run_lattice(job));
    return state_errors(job);
}

alpi_lattice alpi_bounced_lattice(const alpi_bounced_options *options, const alpi_lattice *lattice,
                                  uint8_t *states, float *values)
{
    alpi_lattice own = *lattice;
    own.states = states;
    own.values = values;
    own.straight = options->straight;
    own.along_borders = true;
    return own;
}

alp_result alpi_bounced_map(const alpi_bounced_options *options, const alpi_lattice *lattice,
                            const alpi_task_progress *progress, uint8_t *states,
                            alpi_bounced_report *report)
{
    const bool first = report->traced == 0 || !options->adaptive;
    bounced_job job = {.options = options, .report = report, .factor = 1.0f};
    job.expected = (first ? options->count : report->traced) + ALPI_HELD_OUT;
    *report = (alpi_bounced_report){.factor = report->factor};
    job.progress = progress != NULL ? *progress : (alpi_task_progress){0};
    job.lattice = alpi_bounced_lattice(options, lattice, states, options->levels);
    const alp_result result = run(&job);
    alpi_release(lattice->context, job.wanted);
    alpi_release(lattice->context, job.by_pass);
    alpi_release(lattice->context, job.list);
    if (options->levels == NULL) {
        alpi_release(lattice->context, job.lattice.values);
    }
    return result;
}
