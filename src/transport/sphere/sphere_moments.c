// SPDX-License-Identifier: MIT
#include "transport/sphere/sphere_moments.h"

enum { BINS = ALPI_MOMENT_BINS };
static const double LONGEST = 2.0; // medians

void alpi_sphere_moments_add(const alpi_sphere_loops *loops, const alpi_sphere_packet *packets,
                             const alpi_hits *hits, uint32_t count, float reach,
                             alpi_sphere_moments *moments)
{
    double(*sums)[3] = moments->sums[0];
    for (uint32_t k = 0; k < count; k++) {
        float distances[ALPI_PACKET];
        int32_t slots[ALPI_PACKET];
        loops->find_slots(&packets[k], &hits[k], reach, distances, slots);
        for (int i = 0; i < ALPI_PACKET; i++) {
            double *sum = sums[slots[i]];
            const double distance = (double)distances[i], weight = (double)packets[k].weight[i];
            sum[0] += weight;
            sum[1] += weight * distance;
            sum[2] += weight * distance * distance;
        }
    }
}

/// The mean distance of the bin in which the median lies.
static double find_median(const double (*bins)[3], double weight)
{
    double below = 0.0;
    int bin = 0;
    for (; bin + 1 < BINS && below + bins[bin][0] < 0.5 * weight; bin++) {
        below += bins[bin][0];
    }
    return bins[bin][0] > 0.0 ? bins[bin][1] / bins[bin][0] : 0.0;
}

void alpi_sphere_moments_finish(const alpi_sphere_moments *moments, float reach, float (*found)[2])
{
    for (int i = 0; i < ALPI_SPHERE_MOMENTS; i++) {
        const double(*bins)[3] = moments->sums[i];
        double weight = 0.0, sum = 0.0, squares = 0.0;
        for (int b = 0; b < BINS; b++) {
            weight += bins[b][0];
        }
        const double most = LONGEST * find_median(bins, weight);
        for (int b = 0; b < BINS; b++) {
            const bool beyond = bins[b][1] > most * bins[b][0];
            sum += beyond ? most * bins[b][0] : bins[b][1];
            squares += beyond ? most * most * bins[b][0] : bins[b][2];
        }
        found[i][0] = weight > 0.0 ? (float)(sum / weight) : reach;
        found[i][1] = weight > 0.0 ? (float)(squares / weight) : reach * reach;
    }
}
