// SPDX-License-Identifier: MIT
#include "transport/sphere/sphere_moments.h"

#include "base/octahedral.h"

#include <math.h>
#include <string.h>

enum { SIDE = ALPI_SPHERE_MOMENT_SIDE, BINS = ALPI_MOMENT_BINS };
static const double QUARTER = 0.25, LONGEST = 1.2; // of the quartile

/// The bin of a share of the reach, (0, 1]: exponent and first two bits of the mantissa.
static int bin_of(float share)
{
    enum { BIN_BITS = 21, LAST = 0x3f800000 >> BIN_BITS };
    uint32_t bits;
    memcpy(&bits, &share, sizeof bits);
    const int bin = (int)(bits >> BIN_BITS) - LAST + BINS - 1;
    return bin < 0 ? 0 : bin < BINS ? bin : BINS - 1;
}

void alpi_sphere_moments_add(const alpi_sphere_packet *p, const alpi_hits *hits, float reach,
                             alpi_sphere_moments *moments)
{
    const float scale = 1.0f / reach;
    for (int i = 0; i < ALPI_PACKET; i++) {
        const vec3 direction = {p->rays.direction_x[i], p->rays.direction_y[i],
                                p->rays.direction_z[i]};
        const vec2 uv = alpi_octahedral_encode(direction);
        const int column = (int)(uv.x * SIDE), row = (int)(uv.y * SIDE);
        const int x = column < SIDE ? column : SIDE - 1, y = row < SIDE ? row : SIDE - 1;
        const float met = fminf(hits->distance[i], reach);
        double *sums = moments->sums[y * SIDE + x][bin_of(met * scale)];
        const double distance = (double)met, weight = (double)p->weight[i];
        sums[0] += weight;
        sums[1] += weight * distance;
        sums[2] += weight * distance * distance;
    }
}

/// The mean distance of the bin in which the lower quartile lies.
static double find_quartile(const double (*bins)[3], double weight)
{
    double below = 0.0;
    int bin = 0;
    for (; bin + 1 < BINS && below + bins[bin][0] < QUARTER * weight; bin++) {
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
        const double most = LONGEST * find_quartile(bins, weight);
        for (int b = 0; b < BINS; b++) {
            const bool beyond = bins[b][1] > most * bins[b][0];
            sum += beyond ? most * bins[b][0] : bins[b][1];
            squares += beyond ? most * most * bins[b][0] : bins[b][2];
        }
        found[i][0] = weight > 0.0 ? (float)(sum / weight) : reach;
        found[i][1] = weight > 0.0 ? (float)(squares / weight) : reach * reach;
    }
}
