// SPDX-License-Identifier: MIT
// Projection of equirectangular images, with exact integrals of the basis over each texel.
//
// A texel is a product of an interval of azimuth and one of polar angle, and so are the functions.
// A row first gives five sums along the azimuth φ: of 1, cos φ, sin φ, cos 2φ and sin 2φ. The sums
// of rows are then combined in their order, so any number of workers gives the same bits.
#include "base/image.h"
#include "base/memory.h"
#include "base/tasks.h"
#include "sh/equirect.h"
#include "sh/sh9.h"

enum { WAVES = 5, ROWS = 4 }; // rows that a worker takes at once

static const double RADIANCE_LIMIT = 1e30;

/// Sums along one row, by channel.
typedef struct row_sums {
    double wave[WAVES][3];
} row_sums;

typedef struct projection_job {
    const float *pixels;
    uint32_t width, channels;
    double (*waves)[WAVES]; // [width] integrals over a column
    float brightest;        // stands in for what is infinite
    row_sums *rows;         // [height]
} projection_job;

alpi_equirect_row alpi_equirect_row_integrals(uint32_t row, uint32_t height)
{
    const double middle = ALPI_PI * (row + 0.5) / height, half = 0.5 * ALPI_PI / height;
    const double a = middle - half, b = middle + half;
    const double ca = cos(a), cb = cos(b), sa = sin(a), sb = sin(b);
    return (alpi_equirect_row){.one = 2.0 * sin(middle) * sin(half),
                               .up = 0.5 * (sb * sb - sa * sa),
                               .aside = half - 0.5 * (sb * cb - sa * ca),
                               .up_up = (ca * ca * ca - cb * cb * cb) / 3.0,
                               .up_aside = (sb * sb * sb - sa * sa * sa) / 3.0};
}

vec3 alpi_equirect_direction(uint32_t width, uint32_t height, uint32_t column, uint32_t row)
{
    const double azimuth = 2.0 * ALPI_PI * ((column + 0.5) / width - 0.5);
    const double polar = ALPI_PI * (row + 0.5) / height;
    return (vec3){(float)(sin(polar) * sin(azimuth)), (float)cos(polar),
                  (float)(-sin(polar) * cos(azimuth))};
}

// --- values --------------------------------------------------------------------------------------

static bool is_usable(float value)
{
    return value >= 0.0f && (double)value <= RADIANCE_LIMIT;
}

/// A value that counts as another: see alp_sh_project_image.
static double replacement(float value, float brightest)
{
    return value > 0.0f ? (double)brightest : 0.0;
}

/// Finds the brightest usable value and warns of the others.
static float examine(const alp_image *image)
{
    const alp_image_info info = image->info;
    const float *pixel = image->pixels;
    const size_t count = (size_t)info.width * info.height;
    size_t unusable = 0;
    float brightest = 0.0f;
    for (size_t i = 0; i < count; i++, pixel += info.channels) {
        for (int k = 0; k < 3; k++) {
            const bool usable = is_usable(pixel[k]);
            unusable += usable ? 0 : 1;
            brightest = usable && pixel[k] > brightest ? pixel[k] : brightest;
        }
    }
    if (unusable > 0) {
        alpi_warn(
            image->context, "sky-image", NULL,
            "%zu values of %u x %u pixels are negative, infinite or no numbers; they count as "
            "0, infinite ones as %g",
            unusable, info.width, info.height, (double)brightest);
    }
    return brightest;
}

// --- rows ----------------------------------------------------------------------------------------

/// Integrals of the waves over each column. φ = 0 is −Z, and φ grows towards +X.
static void fill_waves(projection_job *job)
{
    const double half = ALPI_PI / job->width;
    for (uint32_t x = 0; x < job->width; x++) {
        const double phi = 2.0 * ALPI_PI * ((x + 0.5) / job->width - 0.5);
        double *w = job->waves[x];
        w[0] = 2.0 * half;
        w[1] = 2.0 * sin(half) * cos(phi);
        w[2] = 2.0 * sin(half) * sin(phi);
        w[3] = sin(2.0 * half) * cos(2.0 * phi);
        w[4] = sin(2.0 * half) * sin(2.0 * phi);
    }
}

static void sum_row(const projection_job *job, const float *pixel, row_sums *sums)
{
    for (uint32_t x = 0; x < job->width; x++, pixel += job->channels) {
        for (int k = 0; k < 3; k++) {
            const double value =
                is_usable(pixel[k]) ? (double)pixel[k] : replacement(pixel[k], job->brightest);
            for (int i = 0; i < WAVES; i++) {
                sums->wave[i][k] += job->waves[x][i] * value;
            }
        }
    }
}

static alp_result sum_rows(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    const projection_job *job = user;
    (void)worker;
    for (uint32_t y = begin; y < end; y++) {
        sum_row(job, job->pixels + (size_t)y * job->width * job->channels, &job->rows[y]);
    }
    return ALP_OK;
}

/// Adds a row: x = sinθ sinφ, y = cosθ, z = −sinθ cosφ.
static void add_row(const row_sums *sums, const alpi_equirect_row *r, double c[ALPI_SH9_COUNT][3])
{
    const double aside_aside = r->one - r->up_up; // ∫ sin³θ dθ
    for (int k = 0; k < 3; k++) {
        const double one = sums->wave[0][k], cos1 = sums->wave[1][k], sin1 = sums->wave[2][k];
        const double cos2 = sums->wave[3][k], sin2 = sums->wave[4][k];
        const double xx = 0.5 * aside_aside * (one - cos2), zz = 0.5 * aside_aside * (one + cos2);
        c[0][k] += ALP_SH_Y0 * r->one * one;
        c[1][k] += ALP_SH_Y1 * r->up * one;
        c[2][k] -= ALP_SH_Y1 * r->aside * cos1;
        c[3][k] += ALP_SH_Y1 * r->aside * sin1;
        c[4][k] += ALP_SH_Y2 * r->up_aside * sin1;
        c[5][k] -= ALP_SH_Y2 * r->up_aside * cos1;
        c[6][k] += ALP_SH_Y20 * (3.0 * zz - r->one * one);
        c[7][k] -= ALP_SH_Y2 * 0.5 * aside_aside * sin2;
        c[8][k] += ALP_SH_Y22 * (xx - r->up_up * one);
    }
}

static alp_result run(projection_job *job, const alp_image *image, alp_sh9 *radiance)
{
    const uint32_t height = image->info.height;
    double c[ALPI_SH9_COUNT][3] = {{0.0}};
    ALPI_TRY_NEW(image->context, job->waves, job->width);
    ALPI_TRY_NEW(image->context, job->rows, height);
    fill_waves(job);
    ALP_TRY(alpi_parallel_for(image->context, height, ROWS, sum_rows, job, NULL));
    for (uint32_t y = 0; y < height; y++) {
        const alpi_equirect_row integrals = alpi_equirect_row_integrals(y, height);
        add_row(&job->rows[y], &integrals, c);
    }
    for (int i = 0; i < ALPI_SH9_COUNT; i++) {
        for (int k = 0; k < 3; k++) {
            radiance->c[i][k] = (float)c[i][k];
        }
    }
    return ALP_OK;
}

alp_result alp_sh_project_image(const alp_image *image, alp_sh9 *radiance)
{
    if (image == NULL || radiance == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    const alp_image_info info = image->info;
    if (info.component != ALP_COMPONENT_FLOAT || info.channels < 3 ||
        info.width != 2 * info.height) {
        return alpi_fail(
            image->context, ALP_ERROR_INVALID_ARGUMENT,
            "environment of %u x %u pixels, %u channels of %s: give a float image with "
            "3 or 4 channels, twice as wide as high",
            info.width, info.height, info.channels,
            info.component == ALP_COMPONENT_FLOAT ? "floats" : "8 bits");
    }
    projection_job job = {.pixels = image->pixels,
                          .width = info.width,
                          .channels = info.channels,
                          .brightest = examine(image)};
    const alp_result result = run(&job, image, radiance);
    alpi_release(image->context, job.waves);
    alpi_release(image->context, job.rows);
    return result;
}
