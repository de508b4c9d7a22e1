// SPDX-License-Identifier: MIT
#include "transport/direct/direct_sums.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <string.h>

enum { R = ALPI_DIRECT_REPLICATES };
/// As many blocks weigh as much as what would be taken to be true without any.
static const double FEW_BLOCKS = 0.25;

void alpi_direct_add_polygons(const alpi_polygon_gather *polygons, uint32_t lane,
                              double (*sums)[R][3], alpi_directional_sums *directional)
{
    for (uint32_t p = 0; p < polygons->polygon_count; p++) {
        const alpi_polygon *polygon = &polygons->polygons[p];
        const double light[3] = {(double)polygon->radiance.x, (double)polygon->radiance.y,
                                 (double)polygon->radiance.z};
        double all[3] = {0.0, 0.0, 0.0};
        for (int r = 0; r < R; r++) {
            for (int k = 0; k < 3; k++) {
                const double one = ALPI_PI * light[k] * polygons->sums[lane][p][r][k];
                sums[polygon->part][r][k] += one;
                all[k] += one;
            }
        }
        if (directional != NULL) {
            alpi_directional_add_found(&polygons->directional[lane][p], all, directional);
        }
    }
}

alp_result alpi_direct_halves_create(const alpi_direct *d, uint32_t count,
                                     alpi_direct_halves *halves)
{
    *halves = (alpi_direct_halves){NULL};
    ALPI_TRY_NEW(d->options.context, halves->sums, count / ALPI_PACKET + 1);
    return ALP_OK;
}

void alpi_direct_halves_release(const alpi_direct *d, alpi_direct_halves *halves)
{
    alpi_release(d->options.context, halves->sums);
}

/// @param sums of parts together, whose mean is `value`
static void compare_halves(const double (*sums)[3], uint32_t each,
                           const alpi_reference_value *value, float told[2])
{
    double halves[2][3] = {{0.0}}, apart = 0.0, variance = 0.0;
    for (int r = 0; r < R; r++) {
        for (int k = 0; k < 3; k++) {
            halves[r / ALPI_DIRECT_HALF][k] += sums[r][k];
        }
    }
    for (int k = 0; k < 3; k++) {
        const double difference = (halves[0][k] - halves[1][k]) / ((double)each * ALPI_DIRECT_HALF);
        apart += 0.25 * difference * difference;
        variance += (double)value->variance[k];
    }
    told[0] += (float)apart;
    told[1] += (float)variance;
}

/// How many parts repeat what one half of their samples found.
static uint32_t count_repeated(const alpi_direct *d, const alpi_polygon_gather *polygons,
                               uint32_t lane)
{
    uint32_t count = 0;
    for (uint32_t p = 0; p < d->part_count && polygons != NULL; p++) {
        count += alpi_polygons_repeat(polygons, lane, p);
    }
    return count;
}

/// Adds up the parts. @param polygons NULL, or those whose parts that repeat are left out
static void add_parts(const alpi_direct *d, const double (*sums)[R][3],
                      const alpi_polygon_gather *polygons, uint32_t lane, double out[R][3])
{
    memset(out, 0, R * sizeof *out);
    for (uint32_t p = 0; p < d->part_count; p++) {
        if (polygons != NULL && alpi_polygons_repeat(polygons, lane, p)) {
            continue;
        }
        for (int r = 0; r < R; r++) {
            for (int k = 0; k < 3; k++) {
                out[r][k] += sums[p][r][k];
            }
        }
    }
}

void alpi_direct_put(const alpi_direct *d, const double (*sums)[R][3], uint32_t receiver,
                     const alpi_polygon_gather *polygons, uint32_t lane, float told[2],
                     alpi_direct_output *output)
{
    const uint32_t each = d->samples / R;
    alpi_reference_value *value = &output->values[receiver], compared;
    double together[R][3];
    const double(*all)[3] = sums[0]; // of one part there is nothing to add up
    float mean[3] = {0.0f, 0.0f, 0.0f};
    for (uint32_t p = 0; p < d->part_count; p++) {
        alpi_reference_value part;
        alpi_reference_mean(sums[p], R, each, &part);
        for (int k = 0; k < 3; k++) {
            mean[k] += part.mean[k];
        }
        alpi_direct_put_part(output, d->part_count, p, receiver, &part);
        *value = part; // of one part: all there is
    }
    if (d->part_count != 1) {
        add_parts(d, sums, NULL, lane, together);
        all = (const double(*)[3])together;
        alpi_reference_mean(all, R, each, value);
        memcpy(value->mean, mean, sizeof mean);
    }
    const uint32_t repeated = count_repeated(d, polygons, lane);
    if (repeated == d->part_count) { // most receivers: their halves tell nothing
        return;
    }
    compared = *value;
    if (repeated > 0) {
        add_parts(d, sums, polygons, lane, together);
        all = (const double(*)[3])together;
        alpi_reference_mean(all, R, each, &compared);
    }
    compare_halves(all, each, &compared, told);
}

static void add_halves(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const alpi_direct_halves *halves = user;
    for (uint32_t i = begin; i < end; i++) {
        sums[0] += (double)halves->sums[i][0];
        sums[1] += (double)halves->sums[i][1];
        sums[2] += (double)halves->sums[i][1] * (double)halves->sums[i][1];
    }
}

/// F, of as many blocks as weigh.
static float find_scale(const double sums[ALPI_SUM_LIMIT])
{
    const double kept = FEW_BLOCKS * sums[2] / (sums[1] * sums[1]);
    const double scale = (sums[0] / sums[1] + kept) / (1.0 + kept);
    return isfinite(scale) ? (float)scale : 1.0f; // none has a variance, or it is infinite
}

static void scale_parts(const alpi_direct *d, uint32_t receiver, float scale,
                        alpi_direct_output *output)
{
    for (uint32_t p = 0; p < d->part_count && output->parts != NULL; p++) {
        float *v = output->parts[(size_t)receiver * d->part_count + p].variance;
        for (int k = 0; k < 3; k++) {
            v[k] *= scale;
        }
    }
}

alp_result alpi_direct_scale_variances(const alpi_direct *d, const uint32_t *list, uint32_t count,
                                       const alpi_direct_halves *halves, alpi_direct_output *output)
{
    double sums[ALPI_SUM_LIMIT] = {0.0};
    const uint32_t blocks = count / ALPI_PACKET + 1;
    ALP_TRY(alpi_parallel_sum(d->options.context, blocks, add_halves, halves, NULL, sums));
    const float scale = find_scale(sums);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t receiver = list != NULL ? list[i] : i;
        for (int k = 0; k < 3; k++) {
            output->values[receiver].variance[k] *= scale;
        }
        scale_parts(d, receiver, scale, output);
    }
    return ALP_OK;
}
