// SPDX-License-Identifier: MIT
// Metering: how bright a picture is, and of what colour, without its extremes.
// Based on: E. Reinhard, M. Stark, P. Shirley, J. Ferwerda. Photographic tone reproduction for
// digital images. SIGGRAPH 2002 (log-average luminance and key); G. Buchsbaum. A spatial processor
// model for object colour perception. J. Franklin Institute 310, 1980 (grey world).
#include "film/meter.h"

#include "base/image.h"
#include "base/memory.h"

#include <float.h>
#include <math.h>
#include <string.h>

/// A bin is what positive floats with the same upper 16 bits share: 128 to a doubling, and light
/// that doubles moves everything by 128 bins exactly.
enum { BIN_COUNT = 1 << 15, BIN_SHIFT = 16 };

/// Coloured light must not become a demand to amplify noise.
static const double AUTO_BALANCE_LIMIT = 4.0;

typedef struct meter_bin {
    uint64_t count;
    double log2_luminance; // sum
    double colour[3];      // sum
} meter_bin;

static void count_pixel(meter_bin *bins, const double rgb[3], const double weights[3])
{
    double luminance = rgb[0] * weights[0] + rgb[1] * weights[1] + rgb[2] * weights[2];
    if (!(luminance >= (double)FLT_MIN && luminance <= (double)FLT_MAX)) {
        return; // black, negative, infinite, not a number
    }
    const float key = (float)luminance;
    uint32_t bits = 0;
    memcpy(&bits, &key, sizeof bits);
    meter_bin *bin = &bins[bits >> BIN_SHIFT];
    bin->count++;
    bin->log2_luminance += log2(luminance);
    for (int k = 0; k < 3; k++) {
        bin->colour[k] += rgb[k];
    }
}

static void count_pixels(const alp_image *linear, const alpi_matrix3 *balance, meter_bin *bins)
{
    double weights[3];
    alpi_luminance_weights(weights);
    for (uint32_t y = 0; y < linear->info.height; y++) {
        for (uint32_t x = 0; x < linear->info.width; x++) {
            float rgba[4];
            alpi_image_pixel(linear, x, y, rgba);
            if (!(rgba[3] > 0.0f)) {
                continue;
            }
            double rgb[3] = {(double)rgba[0], (double)rgba[1], (double)rgba[2]};
            if (balance != NULL) {
                alpi_matrix3_apply(balance, rgb, rgb);
            }
            count_pixel(bins, rgb, weights);
        }
    }
}

/// Means over the pixels between two ranks; of a bin across a rank that share counts.
static void average(const meter_bin *bins, double first, double last, alpi_meter *meter)
{
    double rank = 0.0, weight = 0.0;
    for (int i = 0; i < BIN_COUNT; i++) {
        const double count = (double)bins[i].count;
        const double inside = fmin(rank + count, last) - fmax(rank, first);
        rank += count;
        if (count > 0.0 && inside > 0.0) {
            const double share = inside / count;
            weight += inside;
            meter->log2_luminance += share * bins[i].log2_luminance;
            for (int k = 0; k < 3; k++) {
                meter->colour[k] += share * bins[i].colour[k];
            }
        }
    }
    meter->log2_luminance /= weight;
    for (int k = 0; k < 3; k++) {
        meter->colour[k] /= weight;
    }
}

alp_result alpi_meter_image(const alp_image *linear, const alp_film_options *options,
                            const alpi_matrix3 *balance, alpi_meter *meter)
{
    *meter = (alpi_meter){0};
    meter_bin *bins = ALPI_NEW(linear->context, meter_bin, BIN_COUNT);
    if (bins == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    count_pixels(linear, balance, bins);
    for (int i = 0; i < BIN_COUNT; i++) {
        meter->pixels += bins[i].count;
    }
    if (meter->pixels > 0) {
        const double pixels = (double)meter->pixels;
        average(bins, pixels * (double)options->meter_low, pixels * (double)options->meter_high,
                meter);
    }
    alpi_release(linear->context, bins);
    return ALP_OK;
}

alp_result alpi_film_balance(const alp_image *linear, const alp_film_options *options,
                             alpi_matrix3 *balance, bool *balanced)
{
    *balanced = options->white_balance != ALP_WHITE_BALANCE_OFF;
    if (options->white_balance == ALP_WHITE_BALANCE_KELVIN) {
        double xy[2];
        alpi_kelvin_chromaticity((double)options->kelvin, xy);
        *balance = alpi_balance_for_chromaticity(xy);
    } else if (options->white_balance == ALP_WHITE_BALANCE_AUTO) {
        alpi_meter meter;
        ALP_TRY(alpi_meter_image(linear, options, NULL, &meter));
        *balanced = meter.pixels > 0;
        if (*balanced) {
            *balance = alpi_balance_for_colour(meter.colour, AUTO_BALANCE_LIMIT);
        }
    }
    return ALP_OK;
}

double alpi_film_exposure(const alp_film_options *options, double log2_luminance)
{
    const double exposure = log2((double)options->key) - log2_luminance;
    return fmin(fmax(exposure, -ALPI_EXPOSURE_LIMIT), ALPI_EXPOSURE_LIMIT);
}

alp_result alp_film_meter(const alp_image *linear, const alp_film_options *options,
                          double *log2_luminance, uint64_t *pixels)
{
    ALP_TRY(alpi_film_check(linear, options));
    const alp_film_options o = options != NULL ? *options : alp_film_options_default();
    if (log2_luminance == NULL) {
        return alpi_fail(linear->context, ALP_ERROR_INVALID_ARGUMENT,
                         "film: `log2_luminance` is NULL");
    }
    alpi_matrix3 balance;
    bool balanced = false;
    alpi_meter meter;
    ALP_TRY(alpi_film_balance(linear, &o, &balance, &balanced));
    ALP_TRY(alpi_meter_image(linear, &o, balanced ? &balance : NULL, &meter));
    if (pixels != NULL) {
        *pixels = meter.pixels;
    }
    if (meter.pixels > 0) {
        *log2_luminance = meter.log2_luminance;
    }
    return ALP_OK;
}
