// SPDX-License-Identifier: MIT
// How two images differ: error figures over the pixels covered in both, and a picture of them.
#include "base/image.h"

#include "base/memory.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const double SCALE_LIMIT = 1e30; // so that no square overflows a double

typedef struct comparison {
    const alp_image *a, *b;
    double scale;
    uint32_t colors; // 1 when both are grey, else 3
} comparison;

typedef enum coverage { IN_NEITHER, IN_FIRST, IN_SECOND, IN_BOTH } coverage;

/// Coverage of a pixel and, where it is covered in both, s·a and b of each colour channel.
static coverage look(const comparison *c, uint32_t x, uint32_t y, double first[3], double second[3])
{
    float pa[4], pb[4];
    alpi_image_pixel(c->a, x, y, pa);
    alpi_image_pixel(c->b, x, y, pb);
    for (uint32_t k = 0; k < c->colors; k++) {
        first[k] = c->scale * (double)pa[k];
        second[k] = (double)pb[k];
    }
    return (coverage)((pa[3] > 0.5f ? IN_FIRST : 0) | (pb[3] > 0.5f ? IN_SECOND : 0));
}

static alp_result check_finite(const alp_image *image, const char *which)
{
    for (uint32_t y = 0; y < image->info.height; y++) {
        for (uint32_t x = 0; x < image->info.width; x++) {
            float pixel[4];
            alpi_image_pixel(image, x, y, pixel);
            for (int k = 0; k < 4; k++) {
                if (!isfinite(pixel[k])) {
                    return alpi_fail(image->context, ALP_ERROR_INVALID_DATA,
                                     "compare: pixel (%u, %u) of the %s image holds %s", x, y,
                                     which, isnan(pixel[k]) ? "NaN" : "infinity");
                }
            }
        }
    }
    return ALP_OK;
}

/// Sums row by row, so that rounding stays small in large images and never depends on threads.
static void sum_differences(const comparison *c, alp_image_difference *d)
{
    double squares = 0.0, differences = 0.0, firsts = 0.0, seconds = 0.0;
    d->maximum = -1.0;
    for (uint32_t y = 0; y < c->a->info.height; y++) {
        double row_squares = 0.0, row_differences = 0.0, row_firsts = 0.0, row_seconds = 0.0;
        for (uint32_t x = 0; x < c->a->info.width; x++) {
            double first[3], second[3];
            coverage covered = look(c, x, y, first, second);
            d->pixels += covered == IN_BOTH;
            d->only_first += covered == IN_FIRST;
            d->only_second += covered == IN_SECOND;
            for (uint32_t k = 0; covered == IN_BOTH && k < c->colors; k++) {
                double difference = first[k] - second[k];
                row_squares += difference * difference;
                row_differences += difference;
                row_firsts += first[k];
                row_seconds += second[k];
                if (fabs(difference) > d->maximum) {
                    d->maximum = fabs(difference);
                    d->maximum_x = x;
                    d->maximum_y = y;
                }
            }
        }
        squares += row_squares;
        differences += row_differences;
        firsts += row_firsts;
        seconds += row_seconds;
    }
    double values = (double)d->pixels * c->colors;
    if (d->pixels == 0) {
        d->maximum = 0.0;
        return;
    }
    d->rmse = sqrt(squares / values);
    d->bias = differences / values;
    d->mean_first = firsts / values;
    d->mean_second = seconds / values;
    d->relative_rmse = d->rmse == 0.0 ? 0.0 : d->rmse / d->mean_second;
}

// --- percentile ----------------------------------------------------------------------------------

enum { DIGIT_COUNT = 1 << 16 };

/// Counts |differences| by 16 bits of their float pattern, which orders positive floats as integers
/// are ordered: the upper 16 bits, or the lower ones of those whose upper bits are `upper`.
static void count_digits(const comparison *c, int64_t upper, uint64_t counts[DIGIT_COUNT])
{
    memset(counts, 0, DIGIT_COUNT * sizeof *counts);
    for (uint32_t y = 0; y < c->a->info.height; y++) {
        for (uint32_t x = 0; x < c->a->info.width; x++) {
            double first[3], second[3];
            bool both = look(c, x, y, first, second) == IN_BOTH;
            for (uint32_t k = 0; both && k < c->colors; k++) {
                float size = (float)fmin(fabs(first[k] - second[k]), (double)FLT_MAX);
                uint32_t bits = 0;
                memcpy(&bits, &size, sizeof bits);
                if (upper < 0) {
                    counts[bits >> 16]++;
                } else if (bits >> 16 == upper) {
                    counts[bits & 0xffff]++;
                }
            }
        }
    }
}

/// The bin that holds element `rank` counted from 0; *rank becomes its rank within the bin.
static uint32_t find_digit(const uint64_t counts[DIGIT_COUNT], uint64_t *rank)
{
    uint32_t digit = 0;
    while (digit < DIGIT_COUNT - 1 && *rank >= counts[digit]) {
        *rank -= counts[digit++];
    }
    return digit;
}

/// The |difference| of rank `rank`, rounded to float: two counting passes, no copy of the values.
static double select_rank(const comparison *c, uint64_t rank, uint64_t counts[DIGIT_COUNT])
{
    count_digits(c, -1, counts);
    uint32_t upper = find_digit(counts, &rank);
    count_digits(c, upper, counts);
    uint32_t bits = upper << 16 | find_digit(counts, &rank);
    float value = 0.0f;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

/// 99th percentile, linear between the two nearest ranks.
static alp_result find_p99(const comparison *c, alp_image_difference *d)
{
    if (d->pixels == 0) {
        return ALP_OK;
    }
    uint64_t *counts = ALPI_NEW(c->a->context, uint64_t, DIGIT_COUNT);
    if (counts == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    uint64_t last = d->pixels * c->colors - 1;
    double position = 0.99 * (double)last;
    uint64_t rank = (uint64_t)position;
    double low = select_rank(c, rank, counts);
    double high = rank < last ? select_rank(c, rank + 1, counts) : low;
    d->p99 = low + (position - (double)rank) * (high - low);
    alpi_release(c->a->context, counts);
    return ALP_OK;
}

// --- picture -------------------------------------------------------------------------------------

static uint8_t to_byte(double value)
{
    return (uint8_t)(fmin(fmax(value, 0.0), 1.0) * 255.0 + 0.5);
}

/// Black, red, yellow, white for t from 0 to 1.
static void store_heat(double t, uint8_t pixel[3])
{
    for (int k = 0; k < 3; k++) {
        pixel[k] = to_byte(3.0 * t - k);
    }
}

static alp_result draw_heatmap(const comparison *c, double white, alp_image **heatmap)
{
    static const uint8_t MAGENTA[3] = {255, 0, 255}, DARK_BLUE[3] = {0, 0, 64};
    alp_image_info info = {c->a->info.width, c->a->info.height, 3, ALP_COMPONENT_U8};
    ALP_TRY(alp_image_create(c->a->context, info, heatmap));
    uint8_t *pixel = alp_image_bytes(*heatmap);
    for (uint32_t y = 0; y < info.height; y++) {
        for (uint32_t x = 0; x < info.width; x++, pixel += 3) {
            double first[3], second[3], largest = 0.0;
            coverage covered = look(c, x, y, first, second);
            for (uint32_t k = 0; k < c->colors; k++) {
                largest = fmax(largest, fabs(first[k] - second[k]));
            }
            if (covered == IN_BOTH) {
                store_heat(largest >= white ? (largest > 0.0 ? 1.0 : 0.0) : largest / white, pixel);
            } else {
                memcpy(pixel, covered == IN_NEITHER ? DARK_BLUE : MAGENTA, 3);
            }
        }
    }
    return ALP_OK;
}

alp_result alp_image_compare(const alp_image *a, const alp_image *b, double scale,
                             alp_image_difference *difference, alp_image **heatmap)
{
    if (heatmap != NULL) {
        *heatmap = NULL;
    }
    if (a == NULL || b == NULL || difference == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *difference = (alp_image_difference){0};
    if (a->info.width != b->info.width || a->info.height != b->info.height ||
        a->info.component != b->info.component) {
        return alpi_fail(a->context, ALP_ERROR_INVALID_ARGUMENT,
                         "compare: %u x %u pixels of %s cannot be compared with %u x %u of %s",
                         a->info.width, a->info.height,
                         a->info.component == ALP_COMPONENT_U8 ? "8 bits" : "float", b->info.width,
                         b->info.height,
                         b->info.component == ALP_COMPONENT_U8 ? "8 bits" : "float");
    }
    if (!(fabs(scale) <= SCALE_LIMIT)) {
        return alpi_fail(a->context, ALP_ERROR_INVALID_ARGUMENT,
                         "compare: scale %g is not between -1e30 and 1e30", scale);
    }
    ALP_TRY(check_finite(a, "first"));
    ALP_TRY(check_finite(b, "second"));
    bool grey = a->info.channels < 3 && b->info.channels < 3;
    comparison c = {.a = a, .b = b, .scale = scale, .colors = grey ? 1 : 3};
    sum_differences(&c, difference);
    ALP_TRY(find_p99(&c, difference));
    return heatmap == NULL ? ALP_OK : draw_heatmap(&c, difference->p99, heatmap);
}
