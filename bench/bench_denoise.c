// SPDX-License-Identifier: MIT
// What the denoiser does to the true error of indirect light, scene by scene.
//
// Indirect light at the texels is that of the reference with all bounces less that with none from
// the same random numbers: the same first rays, so that what is direct falls out exactly. Some
// independent bakes give its mean and the variance of that; two more, with many paths, are the
// truth y₁, y₂, so that E[(x − y₁)(x − y₂)] is the squared error of x without their own.
#include "bench.h"

#include "base/tasks.h"
#include "maps/denoise.h"
#include "transport/paths/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BAKE_PATHS = 16, TRUTH_PATHS = 1024, QUICK_TRUTH_PATHS = 64, QUICK_SIZE = 32 };
enum { LEVELS = 2, SEEDS = 2, TRUTH_SEED = 5000 };
static const uint32_t BAKES[LEVELS] = {8, 32}; // × BAKE_PATHS

typedef struct denoise_scene {
    const char *name, *title;
    uint32_t size;
    bool clear; // under a clear sky
} denoise_scene;

static const denoise_scene scenes[] = {
    {"builtin:cornell", "cornell", 128, false},
    {"builtin:windows", "windows", 128, false},
    {"builtin:teapot-room", "teapot-room", 128, false},
    {"builtin:atrium", "atrium", 128, true},
};
enum { SCENE_COUNT = sizeof scenes / sizeof *scenes };

typedef float light[3];

/// A lit scene, its asked texels as arrays, and the truth of them.
typedef struct denoise_case {
    bench_scene scene;
    bench_map map;
    alpi_lighting *lighting;
    uint32_t count;
    uint32_t *list; // [count] texels that are not inside other geometry
    light *positions, *normals;
    float *sides;
    light *truth[2];
    double mean; // of the truth, over texels and channels
} denoise_case;

/// Error over the mean of the truth.
typedef struct error {
    double rms, largest, bias;
} error;

// --- light ---------------------------------------------------------------------------------------

static bool find_light(const denoise_case *c, uint32_t bounces, uint32_t paths, uint64_t seed,
                       alpi_reference_value *values)
{
    const alpi_receivers receivers = alpi_texels_receivers(&c->map.texels);
    const alpi_reference reference = {.context = c->scene.context,
                                      .scene = c->scene.scene,
                                      .tracer = c->scene.tracer,
                                      .lighting = c->lighting,
                                      .bounces = bounces,
                                      .samples = paths,
                                      .next_event = true,
                                      .seed = seed};
    return bench_good(&c->scene, alpi_reference_irradiance(&reference, &receivers, c->list,
                                                           c->count, NULL, values));
}

/// Indirect light of one bake. @param out [count]
static bool find_indirect(const denoise_case *c, uint32_t paths, uint64_t seed, light *out)
{
    const uint32_t texels = c->map.texels.count;
    alpi_reference_value *all = bench_allocate(texels, sizeof *all);
    alpi_reference_value *direct = bench_allocate(texels, sizeof *direct);
    const bool good = find_light(c, ALPI_REFERENCE_BOUNCE_LIMIT, paths, seed, all) &&
                      find_light(c, 0, paths, seed, direct);
    for (uint32_t i = 0; i < c->count && good; i++) {
        for (int k = 0; k < 3; k++) {
            out[i][k] = all[c->list[i]].mean[k] - direct[c->list[i]].mean[k];
        }
    }
    free(direct);
    free(all);
    return good;
}

/// Mean of some bakes, and its variance by their spread.
static bool find_noisy(const denoise_case *c, uint32_t bakes, uint64_t seed, light *means,
                       light *variances)
{
    light *one = bench_allocate(c->count, sizeof *one);
    double(*sums)[6] = bench_allocate(c->count, sizeof *sums);
    bool good = true;
    for (uint32_t b = 0; b < bakes && good; b++) {
        good = find_indirect(c, BAKE_PATHS, seed * 1000 + b, one);
        for (uint32_t i = 0; i < c->count; i++) {
            for (int k = 0; k < 3; k++) {
                sums[i][k] += (double)one[i][k];
                sums[i][3 + k] += (double)one[i][k] * (double)one[i][k];
            }
        }
    }
    for (uint32_t i = 0; i < c->count; i++) {
        for (int k = 0; k < 3; k++) {
            const double mean = sums[i][k] / bakes;
            const double spread = fmax(sums[i][3 + k] / bakes - mean * mean, 0.0);
            means[i][k] = (float)mean;
            variances[i][k] = (float)(spread / (bakes - 1));
        }
    }
    free(sums);
    free(one);
    return good;
}

// --- scenes --------------------------------------------------------------------------------------

static alp_result light_case(denoise_case *c, bool clear)
{
    alp_lighting_options options = alp_lighting_options_default();
    if (clear) { // as in the truth table
        options.sky.kind = ALP_SKY_CLEAR;
        options.sun.azimuth = (float)(150.0 * ALPI_PI / 180.0);
        options.sun.elevation = (float)(40.0 * ALPI_PI / 180.0);
    }
    return alpi_lighting_create(c->scene.scene, &options, &c->lighting);
}

static void list_texels(denoise_case *c)
{
    const alpi_texels *t = &c->map.texels;
    c->list = bench_allocate(t->count, sizeof *c->list);
    c->positions = bench_allocate(t->count, sizeof *c->positions);
    c->normals = bench_allocate(t->count, sizeof *c->normals);
    c->sides = bench_allocate(t->count, sizeof *c->sides);
    for (uint32_t k = 0; k < t->count; k++) {
        const uint32_t i = c->map.lattice.order[k];
        if (c->map.validity.dropped[i]) {
            continue;
        }
        alpi_receiver_point point;
        alpi_texels_point(t, i, &point);
        vec3_store(c->positions[c->count], point.position);
        vec3_store(c->normals[c->count], point.shading_normal);
        c->sides[c->count] = sqrtf(t->areas[i] / fmaxf(t->coverages[i], 1e-6f));
        c->list[c->count++] = i;
    }
}

static bool find_truth(denoise_case *c, bool quick)
{
    double sum = 0.0;
    for (uint64_t k = 0; k < 2; k++) {
        c->truth[k] = bench_allocate(c->count, sizeof *c->truth[k]);
        if (!find_indirect(c, quick ? QUICK_TRUTH_PATHS : TRUTH_PATHS, TRUTH_SEED + k,
                           c->truth[k])) {
            return false;
        }
        for (uint32_t i = 0; i < c->count; i++) {
            sum +=
                (double)c->truth[k][i][0] + (double)c->truth[k][i][1] + (double)c->truth[k][i][2];
        }
    }
    c->mean = fmax(sum / (6.0 * fmax(c->count, 1.0)), 1e-30);
    return true;
}

static bool open_case(const denoise_scene *what, bool quick, denoise_case *c)
{
    *c = (denoise_case){0};
    if (!bench_scene_open(what->name, 0, &c->scene)) {
        return false;
    }
    if (!bench_good(&c->scene, light_case(c, what->clear)) ||
        !bench_map_open(&c->scene, quick ? QUICK_SIZE : what->size, &c->map)) {
        return false;
    }
    list_texels(c);
    return find_truth(c, quick);
}

static void close_case(denoise_case *c)
{
    free(c->list);
    free(c->positions);
    free(c->normals);
    free(c->sides);
    free(c->truth[0]);
    free(c->truth[1]);
    alpi_lighting_destroy(c->scene.context, c->lighting);
    if (c->map.atlas != NULL) {
        bench_map_close(&c->scene, &c->map);
    }
    bench_scene_close(&c->scene);
}

// --- errors --------------------------------------------------------------------------------------

static error find_error(const denoise_case *c, light *values)
{
    error e = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < c->count; i++) {
        for (int k = 0; k < 3; k++) {
            const double a = (double)values[i][k] - (double)c->truth[0][i][k];
            const double b = (double)values[i][k] - (double)c->truth[1][i][k];
            e.rms += a * b;
            e.bias += 0.5 * (a + b);
            e.largest = fmax(e.largest, fabs(0.5 * (a + b)));
        }
    }
    const double all = 3.0 * fmax(c->count, 1.0);
    return (error){.rms = sqrt(fmax(e.rms, 0.0) / all) / c->mean,
                   .largest = e.largest / c->mean,
                   .bias = e.bias / all / c->mean};
}

/// √ mean variance, over the mean of the truth.
static double find_stated(const denoise_case *c, light *variances)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < c->count; i++) {
        sum += (double)variances[i][0] + (double)variances[i][1] + (double)variances[i][2];
    }
    return sqrt(sum / (3.0 * fmax(c->count, 1.0))) / c->mean;
}

/// A row: both seeds together, rms and the larger of the largest.
static bool add_row(const denoise_case *c, const char *title, uint32_t bakes, bench_table *table)
{
    light *means = bench_allocate(c->count, sizeof *means);
    light *variances = bench_allocate(c->count, sizeof *variances);
    const alpi_denoise_texels texels = {.count = c->count,
                                        .means = (const light *)means,
                                        .variances = (const light *)variances,
                                        .positions = (const light *)c->positions,
                                        .normals = (const light *)c->normals,
                                        .sides = c->sides};
    double before = 0.0, after = 0.0, stated = 0.0, bias = 0.0, seconds = 0.0;
    double largest_before = 0.0, largest_after = 0.0;
    bool good = true;
    for (uint64_t seed = 1; seed <= SEEDS && good; seed++) {
        good = find_noisy(c, bakes, seed, means, variances);
        const error noisy = find_error(c, means);
        const double started = alpi_seconds();
        good = good && bench_good(&c->scene, alpi_denoise(c->scene.context, c->scene.tracer,
                                                          &texels, NULL, means, variances));
        seconds += (alpi_seconds() - started) / SEEDS;
        const error clean = find_error(c, means);
        const double said = find_stated(c, variances);
        before += noisy.rms * noisy.rms / SEEDS;
        after += clean.rms * clean.rms / SEEDS;
        stated += said * said / SEEDS;
        bias += clean.bias / SEEDS;
        largest_before = fmax(largest_before, noisy.largest);
        largest_after = fmax(largest_after, clean.largest);
    }
    bench_table_add(table, "%s, %u|%u|%.2f %%|%.2f %%|%.2f|%.1f %%|%.1f %%|%+.2f %%|%.2f|%.2f",
                    title, bakes * BAKE_PATHS, c->count, 100.0 * sqrt(before), 100.0 * sqrt(after),
                    sqrt(before / fmax(after, 1e-30)), 100.0 * largest_before,
                    100.0 * largest_after, 100.0 * bias, sqrt(stated / fmax(after, 1e-30)),
                    seconds);
    free(variances);
    free(means);
    return good;
}

int bench_denoise(const bench_options *options)
{
    bench_table table;
    bench_table_start(
        &table, "Indirect light before and after the denoiser",
        "Error of indirect irradiance against a bake with twice 1,024 paths, over the mean of the "
        "truth; two seeds together. The largest errors contain the truth's own. Bias of the mean "
        "includes the noise of the mean. Stated: the error that the denoiser says is left, over "
        "the true one.",
        "scene, paths|texels|before|after|ratio|largest before|after|bias|stated|seconds");
    const denoise_scene asked = {options->scene, options->scene, 128, false};
    const int count = options->scene != NULL || options->quick ? 1 : SCENE_COUNT;
    bool good = true;
    for (int i = 0; i < count && good; i++) {
        const denoise_scene *what = options->scene != NULL ? &asked : &scenes[i];
        denoise_case c;
        good = open_case(what, options->quick, &c);
        for (int level = 0; level < (options->quick ? 1 : LEVELS) && good; level++) {
            good = add_row(&c, what->title, BAKES[level], &table);
        }
        close_case(&c);
    }
    if (good) {
        bench_table_print(&table, options);
    }
    return good ? 0 : 1;
}
