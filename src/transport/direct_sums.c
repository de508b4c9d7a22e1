// SPDX-License-Identifier: MIT
#include "transport/direct_sums.h"

enum { R = ALPI_DIRECT_REPLICATES };

/// What rays found, scaled to what there is of it. @param light over the samples
static void add_directional(const alpi_polygon_directional *found, const double light[3],
                            alpi_directional_sums *sums)
{
    const double luminance = alpi_luminance(found->irradiance);
    const double scale = luminance > 0.0 ? alpi_luminance(light) / luminance : 0.0;
    for (int k = 0; k < 3; k++) {
        const double all = found->irradiance[k];
        for (int i = 0; i < ALPI_SH1_COUNT && all > 0.0; i++) {
            sums->sh[i][k] += found->sums.sh[i][k] * light[k] / all;
        }
        sums->toward[k] += scale * found->sums.toward[k];
    }
}

void alpi_direct_add_polygons(const alpi_polygon_gather *polygons, uint32_t lane,
                              double (*sums)[R][3], alpi_directional_sums *directional)
{
    for (uint32_t p = 0; p < polygons->polygon_count; p++) {
        const alpi_polygon *polygon = &polygons->polygons[p];
        const double light[3] = {(double)polygon->radiance.x, (double)polygon->radiance.y,
                                 (double)polygon->radiance.z};
        double all[3] = {0.0, 0.0, 0.0};
        for (int i = 0; i < 3 * R; i++) {
            const double one = ALPI_PI * light[i % 3] * polygons->sums[lane][p][i / 3][i % 3];
            sums[polygon->part][i / 3][i % 3] += one;
            all[i % 3] += one;
        }
        if (directional != NULL) {
            add_directional(&polygons->directional[lane][p], all, directional);
        }
    }
}

void alpi_direct_put(const alpi_direct *d, const double (*sums)[R][3], uint32_t receiver,
                     alpi_direct_output *output)
{
    const uint32_t each = d->samples / R;
    alpi_reference_value *value = &output->values[receiver];
    if (d->part_count == 1) {
        alpi_reference_mean(sums[0], R, each, value);
        alpi_direct_put_part(output, 1, 0, receiver, value);
        return;
    }
    double all[R][3] = {{0.0}};
    float mean[3] = {0.0f, 0.0f, 0.0f};
    for (uint32_t p = 0; p < d->part_count; p++) {
        alpi_reference_value part;
        alpi_reference_mean(sums[p], R, each, &part);
        for (int k = 0; k < 3; k++) {
            mean[k] += part.mean[k];
            for (int r = 0; r < R; r++) {
                all[r][k] += sums[p][r][k];
            }
        }
        alpi_direct_put_part(output, d->part_count, p, receiver, &part);
    }
    alpi_reference_mean((const double(*)[3])all, R, each, value);
    for (int k = 0; k < 3; k++) {
        value->mean[k] = mean[k];
    }
}
