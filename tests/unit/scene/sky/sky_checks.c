// SPDX-License-Identifier: MIT
#include "sky_checks.h"

#include "base/random.h"

#include <math.h>

enum { BANDS = 16, SECTORS = 32, BINS = BANDS * SECTORS };

alp_sky_options sky_options(alp_sky_kind kind)
{
    return (alp_sky_options){
        .kind = kind, .up = {1.0f, 1.0f, 1.0f}, .strength = 1.0f, .turbidity = 3.0f};
}

alpi_sky *sky_make(alp_context *context, const alp_sky_options *options, vec3 sun)
{
    alpi_sky *sky = NULL;
    ASSERT_OK(context, alpi_sky_create(context, options, sun, &sky));
    assert_non_null(sky);
    return sky;
}

void sky_refuse(alp_context *context, const alp_sky_options *options, vec3 sun, const char *word)
{
    alpi_sky *sky = NULL;
    assert_int_equal(alpi_sky_create(context, options, sun, &sky), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(sky);
    if (strstr(alp_context_message(context), word) == NULL) {
        fail_msg("\"%s\" is not in: %s", word, alp_context_message(context));
    }
}

vec3 sky_polar(double theta, double phi)
{
    return (vec3){(float)(sin(theta) * sin(phi)), (float)cos(theta),
                  (float)(-sin(theta) * cos(phi))};
}

double sky_luminance(vec3 radiance)
{
    return 0.2126 * (double)radiance.x + 0.7152 * (double)radiance.y + 0.0722 * (double)radiance.z;
}

void sky_irradiance_sum(const alpi_sky *sky, vec3 normal, int rows, double irradiance[3])
{
    irradiance[0] = irradiance[1] = irradiance[2] = 0.0;
    double step = ALPI_PI / rows;
    for (int j = 0; j < rows; j++) {
        double area = step * (cos(j * step) - cos((j + 1) * step));
        for (int i = 0; i < 2 * rows; i++) {
            vec3 d = sky_polar((j + 0.5) * step, (i + 0.5) * step);
            vec3 radiance = alpi_sky_radiance(sky, d);
            double weight = fmax((double)vec3_dot(d, normal), 0.0) * area;
            irradiance[0] += (double)radiance.x * weight;
            irradiance[1] += (double)radiance.y * weight;
            irradiance[2] += (double)radiance.z * weight;
        }
    }
}

/// Independent numbers: what is tested are the laws of chance, not the sequence.
static vec2 random_point(uint32_t i)
{
    uint64_t bits = alpi_hash64(i + 1);
    return (vec2){alpi_unit_float((uint32_t)bits), alpi_unit_float((uint32_t)(bits >> 32))};
}

void sky_irradiance_drawn(const alpi_sky *sky, vec3 normal, uint32_t count, double irradiance[3],
                          double error[3])
{
    double sum[3] = {0.0}, squares[3] = {0.0};
    for (uint32_t i = 0; i < count; i++) {
        float density = 0.0f;
        vec3 d = alpi_sky_sample(sky, random_point(i), &density);
        vec3 radiance = alpi_sky_radiance(sky, d);
        double weight = fmax((double)vec3_dot(d, normal), 0.0) / (double)density;
        const double value[3] = {(double)radiance.x * weight, (double)radiance.y * weight,
                                 (double)radiance.z * weight};
        for (int k = 0; k < 3; k++) {
            sum[k] += value[k];
            squares[k] += value[k] * value[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        irradiance[k] = sum[k] / count;
        double variance = squares[k] / count - irradiance[k] * irradiance[k];
        error[k] = sqrt(fmax(variance, 0.0) / count);
    }
}

/// Probability of each bin of equal sectors and bands of θ, by midpoints.
static double integrate_density(const alpi_sky *sky, int rows, double bins[BINS])
{
    double total = 0.0, step = ALPI_PI / rows;
    for (int j = 0; j < rows; j++) {
        double area = step * (cos(j * step) - cos((j + 1) * step));
        for (int i = 0; i < 2 * rows; i++) {
            vec3 d = sky_polar((j + 0.5) * step, (i + 0.5) * step);
            double share = (double)alpi_sky_density(sky, d) * area;
            bins[j * BANDS / rows * SECTORS + i * SECTORS / (2 * rows)] += share;
            total += share;
        }
    }
    return total;
}

static int bin_of(vec3 d)
{
    double theta = acos(fmax(fmin((double)d.y, 1.0), -1.0));
    double phi = atan2((double)d.x, -(double)d.z);
    int band = (int)(theta / ALPI_PI * BANDS);
    int sector = (int)((phi < 0.0 ? phi + 2.0 * ALPI_PI : phi) / (2.0 * ALPI_PI) * SECTORS);
    return (band < BANDS ? band : BANDS - 1) * SECTORS + (sector < SECTORS ? sector : SECTORS - 1);
}

void sky_check_density(const alpi_sky *sky, int rows)
{
    enum { COUNT = 100000 };
    double expected[BINS] = {0.0}, observed[BINS] = {0.0};
    // Midpoints of smooth or bilinear pieces: an error of the order of 1/rows².
    ASSERT_NEAR(integrate_density(sky, rows, expected), 1.0, 30.0 / ((double)rows * rows));
    for (uint32_t i = 0; i < COUNT; i++) {
        float density = 0.0f;
        vec3 d = alpi_sky_sample(sky, random_point(i), &density);
        ASSERT_NEAR(vec3_length(d), 1.0, 1e-6);
        assert_true(density > 0.0f && density == alpi_sky_density(sky, d));
        observed[bin_of(d)] += 1.0;
    }
    double chi2 = 0.0, rest_expected = 0.0, rest_observed = 0.0;
    int bins = 0;
    for (int i = 0; i < BINS; i++) {
        double mean = expected[i] * COUNT;
        if (mean >= 10.0) {
            chi2 += (observed[i] - mean) * (observed[i] - mean) / mean;
            bins++;
        } else {
            rest_expected += mean;
            rest_observed += observed[i];
        }
    }
    // Few hits in all the rest: Poisson, four standard deviations and one hit.
    ASSERT_NEAR(rest_observed, rest_expected, 4.0 * sqrt(rest_expected) + 1.0);
    // chi² has mean bins − 1 and variance twice that; four standard deviations.
    if (bins > 1 && chi2 > bins - 1 + 4.0 * sqrt(2.0 * (bins - 1))) {
        fail_msg("chi² is %g over %d bins", chi2, bins);
    }
}
