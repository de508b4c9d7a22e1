// SPDX-License-Identifier: MIT
#include "maps/texels/stated_error.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Random numbers of the held-out estimates, apart from the map's.
static const uint64_t PROBE_SEEDS[2] = {0x70726f6265000001u, 0x70726f6265000002u};
enum { STREAM_CHOICE = 3, TEXELS_PER_RANGE = 1 << 12, TEXELS_PER_TICK = 1 << 16 };

// --- held-out texels -----------------------------------------------------------------------------

static void place_probe(const void *user, uint32_t probe, uint32_t count, const float (*square)[2],
                        alpi_receiver_point *points)
{
    const alpi_probes *p = user;
    p->base->place(p->base->user, p->texels[probe], count, square, points);
}

static alp_result create(const alpi_occlusion_setup *setup, const uint32_t *order,
                         uint32_t order_count, alpi_probes *p)
{
    ALPI_TRY_NEW(p->context, p->texels, p->count);
    ALPI_TRY_NEW(p->context, p->list, p->count);
    const double stride = (double)order_count / p->count;
    for (uint32_t i = 0; i < p->count; i++) {
        const uint32_t key = alpi_random_key(setup->options.seed, i, STREAM_CHOICE);
        const uint32_t at = (uint32_t)(stride * ((double)i + (double)alpi_unit_float(key)));
        p->texels[i] = order[at < order_count ? at : order_count - 1];
        p->list[i] = i;
    }
    for (int k = 0; k < 2; k++) {
        ALP_TRY(alpi_occlusion_prepare_again(setup, setup->options.seed ^ PROBE_SEEDS[k],
                                             &p->setups[k]));
        ALP_TRY(alpi_occlusion_sums_create(p->context, p->count, false, &p->sums[k]));
    }
    return ALP_OK;
}

alp_result alpi_probes_create(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              const uint32_t *order, uint32_t order_count, uint32_t count,
                              alpi_probes *probes)
{
    *probes = (alpi_probes){.context = setup->context,
                            .base = receivers,
                            .count = count < order_count ? count : order_count};
    alp_result result = create(setup, order, order_count, probes);
    if (result != ALP_OK) {
        alpi_probes_destroy(probes);
    }
    return result;
}

void alpi_probes_deal(alpi_probes *probes, alpi_chart_deal *deal)
{
    alpi_chart_deal_clear(deal);
    for (uint32_t i = 0; i < probes->count; i++) {
        alpi_chart_deal_count(deal, probes->texels[i]);
    }
    (void)alpi_chart_deal_start(deal);
    for (uint32_t i = 0; i < probes->count; i++) {
        probes->list[alpi_chart_deal_place(deal, probes->texels[i])] = i;
    }
}

void alpi_probes_destroy(alpi_probes *probes)
{
    for (int k = 0; k < 2 && probes->context != NULL; k++) {
        if (probes->setups[k].context != NULL) {
            alpi_occlusion_release(&probes->setups[k]);
        }
        alpi_occlusion_sums_destroy(probes->context, &probes->sums[k]);
    }
    if (probes->context != NULL) {
        alpi_release(probes->context, probes->texels);
        alpi_release(probes->context, probes->list);
    }
    *probes = (alpi_probes){0};
}

alp_result alpi_probes_add(alpi_probes *probes, uint32_t first, uint32_t count, uint32_t total,
                           const alpi_task_progress *progress)
{
    const alpi_receivers receivers = {.count = probes->count,
                                      .extended = probes->base->extended,
                                      .place = place_probe,
                                      .user = probes};
    for (int k = 0; k < 2; k++) {
        ALP_TRY(alpi_occlusion_add(&probes->setups[k], &receivers, probes->list, probes->count,
                                   first, count, total, progress, &probes->sums[k]));
    }
    return ALP_OK;
}

// --- errors --------------------------------------------------------------------------------------

double alpi_spread_variance(const alpi_occlusion_sums *sums, uint32_t receiver)
{
    const uint32_t *open = sums->open[receiver];
    double mean = 0.0, squares = 0.0;
    for (int q = 0; q < ALPI_QUARTERS; q++) {
        mean += (double)open[q] / ALPI_QUARTERS;
    }
    for (int q = 0; q < ALPI_QUARTERS; q++) {
        squares += ((double)open[q] - mean) * ((double)open[q] - mean);
    }
    const double size = (double)sums->done[receiver] / ALPI_QUARTERS;
    return size > 0.0 ? squares / ((ALPI_QUARTERS - 1) * ALPI_QUARTERS) / (size * size) : 0.0;
}

/// Variance of a traced texel, up to the common factor: its own spread and that of the traced
/// texels around it, which has 3 degrees of freedom alone and some 20 together.
static double pool_variance(const alpi_lattice *l, const alpi_occlusion_sums *sums, uint32_t texel)
{
    uint32_t near[ALPI_NEIGHBOUR_LIMIT];
    const uint32_t count = alpi_lattice_traced_around(l, texel, near);
    double sum = alpi_spread_variance(sums, texel);
    for (uint32_t i = 0; i < count; i++) {
        sum += alpi_spread_variance(sums, near[i]);
    }
    return sum / (1.0 + count);
}

/// Variance of an interpolated texel, up to the common factor: what its neighbours hand on, and the
/// chance that the truth bends between them otherwise than it seems.
static double stencil_variance(const alpi_lattice *l, const float *variances, uint32_t texel)
{
    alpi_stencil s;
    double variance = 0.0;
    if (!alpi_lattice_stencil(l, texel, &s)) {
        return 0.0;
    }
    for (uint32_t i = 0; i < s.count; i++) {
        variance += (double)(s.weights[i] * s.weights[i]) * (double)variances[s.texels[i]];
    }
    const double bend = (double)s.bend;
    return variance + 0.25 * bend * bend;
}

/// How many times its variance so far a texel in `state` errs: Σ (x − y₁)(x − y₂) over the probes
/// in that state, over Σ of their variances.
static double find_factor(const alpi_probes *p, const alpi_lattice *l, const float *variances,
                          alpi_texel_state state)
{
    const double usual = 0.3; // where there are too few probes to tell
    double squares = 0.0, expected = 0.0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        const uint32_t t = p->texels[i];
        if (l->states[t] != state || p->sums[0].done[i] == 0 || p->sums[1].done[i] == 0) {
            continue;
        }
        const double x = (double)l->values[t];
        squares += (x - (double)alpi_occlusion_value(&p->sums[0], i)) *
                   (x - (double)alpi_occlusion_value(&p->sums[1], i));
        expected += (double)variances[t];
        count++;
    }
    const bool enough = count >= 16 && expected > 0.0 && squares > 0.01 * expected;
    return enough ? squares / expected : usual;
}

typedef struct error_job {
    const alpi_lattice *lattice;
    const alpi_occlusion_sums *sums;
    const uint32_t *order;
    float *errors;
    uint32_t pass;                               // of the texels that are looked at
    double means[ALPI_TEXEL_INTERPOLATED + 1];   // of the variances, by state
    double factors[ALPI_TEXEL_INTERPOLATED + 1]; // by state
} error_job;

static alp_result find_traced(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const error_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        job->errors[t] = job->lattice->states[t] == ALPI_TEXEL_TRACED
                             ? (float)pool_variance(job->lattice, job->sums, t)
                             : 0.0f;
    }
    return ALP_OK;
}

static alp_result find_interpolated(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const error_job *job = user;
    const alpi_lattice *l = job->lattice;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        if (l->states[t] == ALPI_TEXEL_INTERPOLATED &&
            alpi_lattice_pass(l->texels->pixels[t]) == job->pass) {
            job->errors[t] = (float)stencil_variance(l, job->errors, t);
        }
    }
    return ALP_OK;
}

static void sum_variances(const void *user, uint32_t begin, uint32_t end,
                          double sums[ALPI_SUM_LIMIT])
{
    const error_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        sums[job->lattice->states[t]] += (double)job->errors[t];
    }
}

static void count_states(const void *user, uint32_t begin, uint32_t end,
                         double sums[ALPI_SUM_LIMIT])
{
    const error_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        sums[job->lattice->states[job->order[i]]] += 1.0;
    }
}

static alp_result level_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const error_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        float *variance = &job->errors[job->order[i]];
        const double mean = job->means[job->lattice->states[job->order[i]]];
        *variance = (float)(0.85 * (double)*variance + 0.15 * mean);
    }
    return ALP_OK;
}

/// Moves every variance a part of the way to the mean of its state: some twenty numbers per
/// texel say little where they happen to be equal, and a stated error of nearly 0 is wrong by many
/// times.
static alp_result level_variances(alp_context *context, uint32_t order_count,
                                  const alpi_task_progress *progress, error_job *job)
{
    static_assert((int)ALPI_TEXEL_INTERPOLATED < (int)ALPI_SUM_LIMIT, "one sum for each state");
    double sums[ALPI_SUM_LIMIT], counts[ALPI_SUM_LIMIT];
    ALP_TRY(alpi_parallel_sum(context, order_count, sum_variances, job, progress, sums));
    ALP_TRY(alpi_parallel_sum(context, order_count, count_states, job, progress, counts));
    for (int state = 0; state <= ALPI_TEXEL_INTERPOLATED; state++) {
        job->means[state] = counts[state] > 0.0 ? sums[state] / counts[state] : 0.0;
    }
    return alpi_parallel_for(context, order_count, TEXELS_PER_RANGE, level_range, job, progress);
}

static alp_result take_roots(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const error_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        const double factor = job->factors[job->lattice->states[t]];
        job->errors[t] = (float)sqrt(factor * (double)job->errors[t]);
    }
    return ALP_OK;
}

alp_result alpi_state_errors(const alpi_probes *probes, const alpi_lattice *lattice,
                             const alpi_occlusion_sums *sums, const uint32_t *order,
                             uint32_t order_count, const alpi_task_progress *progress,
                             float *errors)
{
    // First variances up to a factor, pass by pass (an interpolated texel hands its own on to the
    // next pass), then the two factors, then errors.
    alp_context *context = probes->context;
    error_job job = {.lattice = lattice, .sums = sums, .order = order, .errors = errors};
    ALP_TRY(alpi_parallel_for(context, order_count, TEXELS_PER_RANGE, find_traced, &job, progress));
    for (job.pass = 1; job.pass < ALPI_LATTICE_PASSES; job.pass++) {
        ALP_TRY(alpi_parallel_for(context, order_count, TEXELS_PER_RANGE, find_interpolated, &job,
                                  progress));
    }
    ALP_TRY(level_variances(context, order_count, progress, &job));
    for (int state = ALPI_TEXEL_TRACED; state <= ALPI_TEXEL_INTERPOLATED; state++) {
        job.factors[state] = find_factor(probes, lattice, errors, (alpi_texel_state)state);
    }
    return alpi_parallel_for(context, order_count, TEXELS_PER_RANGE, take_roots, &job, progress);
}

// --- the error of a map --------------------------------------------------------------------------

/// Bits of a float ≥ 0: ordered as the floats are.
static uint32_t ordered_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// Where in a histogram the item of rank `*rank` lies; *rank becomes its rank in there.
static uint32_t find_bucket(const uint32_t *histogram, uint64_t *rank)
{
    uint32_t bucket = 0;
    while (bucket < UINT16_MAX && *rank >= histogram[bucket]) {
        *rank -= histogram[bucket++];
    }
    return bucket;
}

/// Counts the upper halves of the bits, or, with upper ≤ UINT16_MAX, the lower ones of those that
/// have that upper half.
static alp_result count_halves(alp_context *context, const float *values, const uint32_t *order,
                               uint32_t order_count, uint32_t upper, uint32_t *histogram)
{
    memset(histogram, 0, (UINT16_MAX + 1) * sizeof *histogram);
    for (uint32_t i = 0; i < order_count; i++) {
        const uint32_t bits = ordered_bits(values[order[i]]);
        if (upper > UINT16_MAX) {
            histogram[bits >> 16]++;
        } else if (bits >> 16 == upper) {
            histogram[bits & UINT16_MAX]++;
        }
        if (i % TEXELS_PER_TICK == TEXELS_PER_TICK - 1) {
            ALP_TRY(alpi_tick(context, "occlusion", 0, 0));
        }
    }
    return ALP_OK;
}

static alp_result find_percentile(alp_context *context, const float *values, const uint32_t *order,
                                  uint32_t order_count, double share, uint32_t *histogram,
                                  double *value)
{
    uint64_t rank = (uint64_t)(share * (order_count - 1));
    ALP_TRY(count_halves(context, values, order, order_count, UINT32_MAX, histogram));
    const uint32_t upper = find_bucket(histogram, &rank);
    ALP_TRY(count_halves(context, values, order, order_count, upper, histogram));
    const uint32_t bits = upper << 16 | find_bucket(histogram, &rank);
    float found;
    memcpy(&found, &bits, sizeof found);
    *value = (double)found;
    return ALP_OK;
}

alp_result alpi_percentile(alp_context *context, const float *values, const uint32_t *order,
                           uint32_t order_count, double share, double *value)
{
    *value = 0.0;
    uint32_t *histogram = ALPI_NEW(context, uint32_t, UINT16_MAX + 1);
    if (histogram == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = ALP_OK;
    if (order_count > 0) {
        result = find_percentile(context, values, order, order_count, share, histogram, value);
    }
    alpi_release(context, histogram);
    return result;
}

typedef struct relative_job {
    const alpi_lattice *lattice;
    const float *errors;
    const uint32_t *order;
} relative_job;

static void sum_known(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const relative_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        if (job->lattice->states[t] != ALPI_TEXEL_OPEN) {
            sums[0] += 1.0;
            sums[1] += fmin(fmax((double)job->lattice->values[t], 0.0), 1.0); // what it will be
            sums[2] += (double)job->errors[t] * (double)job->errors[t];
        }
    }
}

alp_result alpi_find_relative_error(const alpi_lattice *lattice, const float *errors,
                                    const uint32_t *order, uint32_t order_count,
                                    const alpi_task_progress *progress,
                                    alpi_relative_error *relative)
{
    alp_context *context = lattice->context;
    const relative_job job = {lattice, errors, order};
    double sums[ALPI_SUM_LIMIT], p99 = 0.0;
    ALP_TRY(alpi_parallel_sum(context, order_count, sum_known, &job, progress, sums));
    const double count = sums[0], mean = count > 0.0 ? fmax(sums[1] / count, 1e-30) : 1.0;
    // Texels without a value have error 0: they only move the rank.
    const double open = (double)order_count - count;
    const double rank = open + floor(0.99 * fmax(count - 1.0, 0.0));
    const double share = order_count > 1 ? fmin((rank + 0.5) / (order_count - 1.0), 1.0) : 0.0;
    ALP_TRY(alpi_percentile(context, errors, order, order_count, share, &p99));
    *relative = (alpi_relative_error){
        .rms = count > 0.0 ? sqrt(sums[2] / count) / mean : 0.0,
        .p99 = p99 / mean,
    };
    return ALP_OK;
}
