// SPDX-License-Identifier: MIT
#include "maps/seams/jumps.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

enum { WINDOW = 4 };   // samples along the seam on each side: two texels
enum { SHORTEST = 8 }; // samples of a pair of edges that can be judged: four texels
static const double NOISE_LIMIT = 6.0, MEDIAN_LIMIT = 8.0, CHANGE_LIMIT = 4.0;

/// Values that a sample reads on both sides, means of the channels.
typedef struct reading {
    float sides[2];
    float difference; // absolute; of colours the mean of the channels
    float error;      // standard error of the difference
} reading;

/// A sample and the charts that its seam parts.
typedef struct member {
    uint32_t charts[2]; // the lower first
    float difference;
    uint32_t sample;
} member;

static reading read_sample(const alp_lightmap *l, const alpi_seams *s, uint32_t sample,
                           float *const *pages, const float *errors)
{
    const size_t page_size = (size_t)l->width * l->height;
    double sides[2] = {0.0, 0.0}, variances[2] = {0.0, 0.0}, weights[2] = {0.0, 0.0}, d[3];
    for (uint32_t i = s->first[sample]; i < s->first[sample + 1]; i++) {
        const size_t at = s->pixels[s->texels[i]];
        const float *v = pages[at / page_size] + 4 * (at % page_size);
        const int side = s->weights[i] > 0.0f ? 0 : 1;
        const double weight = fabs((double)s->weights[i]), error = (double)errors[s->texels[i]];
        sides[side] += weight * ((double)v[0] + (double)v[1] + (double)v[2]) / 3.0;
        if (s->owners[s->texels[i]] != ALPI_NONE) {
            variances[side] += weight * error * error;
            weights[side] += weight;
        }
    }
    alpi_seams_difference(l, s, sample, pages, d);
    double variance = 0.0; // gaps repeat the texels beside them, and so do their errors
    for (int i = 0; i < 2; i++) {
        variance += weights[i] > 0.0 ? variances[i] / weights[i] : 0.0;
    }
    return (reading){.sides = {(float)sides[0], (float)sides[1]},
                     .difference = (float)((fabs(d[0]) + fabs(d[1]) + fabs(d[2])) / 3.0),
                     .error = (float)sqrt(variance)};
}

static bool is_of_pair(const alpi_seams *s, uint32_t pair, int64_t sample)
{
    return sample >= 0 && sample < s->sample_count && s->pairs[sample] == pair;
}

/// Whether the difference exceeds all change along the seam nearby; false where the pair of edges
/// is too short.
static bool is_steady(const alpi_seams *s, const reading *readings, uint32_t sample)
{
    const uint32_t pair = s->pairs[sample];
    uint32_t count = 0;
    double change = 0.0;
    for (int64_t i = (int64_t)sample - SHORTEST; i <= (int64_t)sample + SHORTEST; i++) {
        if (!is_of_pair(s, pair, i)) {
            continue;
        }
        count++;
        for (int k = 0; k < 2 && llabs(i - (int64_t)sample) <= WINDOW; k++) {
            const double here = (double)readings[sample].sides[k];
            change = fmax(change, fabs((double)readings[i].sides[k] - here));
        }
    }
    return count >= SHORTEST && (double)readings[sample].difference > CHANGE_LIMIT * change;
}

static int compare_members(const void *a, const void *b)
{
    const member *x = a, *y = b;
    for (int k = 0; k < 2; k++) {
        if (x->charts[k] != y->charts[k]) {
            return x->charts[k] < y->charts[k] ? -1 : 1;
        }
    }
    if (x->difference != y->difference) {
        return x->difference < y->difference ? -1 : 1;
    }
    return (x->sample > y->sample) - (x->sample < y->sample);
}

static member make_member(const alp_lightmap *l, const alpi_seams *s, uint32_t sample,
                          float difference)
{
    const uint32_t *charts = l->atlas->triangle_charts;
    const uint32_t a = charts[s->triangles[sample][0]], b = charts[s->triangles[sample][1]];
    return (member){{a < b ? a : b, a < b ? b : a}, difference, sample};
}

static bool is_same_seam(const member *a, const member *b)
{
    return a->charts[0] == b->charts[0] && a->charts[1] == b->charts[1];
}

/// Judges the samples of one seam, sorted by their differences.
static void judge_seam(const alpi_seams *s, const reading *readings, const member *members,
                       size_t count, double least, uint8_t *jumps)
{
    const double median = (double)members[count / 2].difference;
    for (size_t i = 0; i < count; i++) {
        const uint32_t sample = members[i].sample;
        const double difference = (double)members[i].difference;
        const double error = fmax((double)readings[sample].error, least);
        jumps[sample] = difference > NOISE_LIMIT * error && difference > MEDIAN_LIMIT * median &&
                        is_steady(s, readings, sample);
    }
}

alp_result alpi_jumps_find(const alp_lightmap *lightmap, const alpi_seams *seams,
                           float *const *pages, const float *errors, double least, uint8_t *jumps)
{
    const uint32_t count = seams->sample_count;
    reading *readings = ALPI_NEW(seams->context, reading, count);
    member *members = ALPI_NEW(seams->context, member, count);
    const bool ready = readings != NULL && members != NULL;
    for (uint32_t i = 0; i < count && ready; i++) {
        readings[i] = read_sample(lightmap, seams, i, pages, errors);
        members[i] = make_member(lightmap, seams, i, readings[i].difference);
    }
    if (ready) {
        qsort(members, count, sizeof *members, compare_members);
    }
    for (size_t first = 0, end = 0; end < count && ready; first = end) {
        while (end < count && is_same_seam(&members[first], &members[end])) {
            end++;
        }
        judge_seam(seams, readings, members + first, end - first, least, jumps);
    }
    alpi_release(seams->context, readings);
    alpi_release(seams->context, members);
    return ready ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}
