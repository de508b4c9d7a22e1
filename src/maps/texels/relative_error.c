// SPDX-License-Identifier: MIT
#include "maps/texels/relative_error.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <string.h>

enum { TEXELS_PER_TICK = 1 << 16 };

// --- percentiles ---------------------------------------------------------------------------------

/// Bits of a float ≥ 0, which have the order of the floats.
static uint32_t ordered_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// The bucket of a histogram that holds the item of a rank. @param rank out: its rank in the bucket
static uint32_t find_bucket(const uint32_t *histogram, uint64_t *rank)
{
    uint32_t bucket = 0;
    while (bucket < UINT16_MAX && *rank >= histogram[bucket]) {
        *rank -= histogram[bucket++];
    }
    return bucket;
}

/// Counts the upper halves of the bits; with upper ≤ UINT16_MAX, the lower halves of the items that
/// have this upper half.
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
    if (order_count == 0) {
        return ALP_OK;
    }
    uint32_t *histogram = NULL;
    ALPI_TRY_NEW(context, histogram, UINT16_MAX + 1);
    const alp_result result =
        find_percentile(context, values, order, order_count, share, histogram, value);
    alpi_release(context, histogram);
    return result;
}

// --- the error of a map --------------------------------------------------------------------------

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
            sums[1] += fmin(fmax((double)job->lattice->values[t], 0.0), 1.0);
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
