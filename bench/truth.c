// SPDX-License-Identifier: MIT
#include "truth.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool bench_truth_open(const bench_scene *scene, const bench_map *map,
                      const alp_occlusion_options *options, uint32_t samples, bench_truth *truth)
{
    const alpi_receivers receivers = alpi_texels_receivers(&map->texels);
    const uint32_t count = map->texels.count;
    *truth = (bench_truth){0};
    for (uint64_t k = 0; k < 2; k++) {
        alp_occlusion_options many = *options;
        many.samples = samples;
        many.seed = 0x7472757468u + k;
        truth->values[k] = bench_allocate(count, sizeof(float));
        alpi_occlusion_setup setup;
        alp_result result = alpi_occlusion_prepare(scene->scene, scene->tracer, &many, &setup);
        if (result == ALP_OK) {
            result = alpi_occlusion_gather(&setup, &receivers, map->lattice.order, count,
                                           truth->values[k]);
            alpi_occlusion_release(&setup);
        }
        if (!bench_good(scene, result)) {
            bench_truth_close(truth);
            return false;
        }
        for (uint32_t i = 0; i < count; i++) {
            truth->mean += 0.5 * (double)truth->values[k][i] / count;
        }
    }
    return true;
}

void bench_truth_close(bench_truth *truth)
{
    free(truth->values[0]);
    free(truth->values[1]);
    *truth = (bench_truth){0};
}

void bench_judge(const bench_map *map, const float *values, const bench_truth *truth,
                 bench_result *result)
{
    double squares = 0.0, sum = 0.0, largest = 0.0;
    for (uint32_t i = 0; i < map->texels.count; i++) {
        const double a = (double)values[i] - (double)truth->values[0][i];
        const double b = (double)values[i] - (double)truth->values[1][i];
        squares += a * b;
        sum += 0.5 * (a + b);
        largest = fmax(largest, fabs(0.5 * (a + b)));
    }
    result->rmse = sqrt(fmax(squares, 0.0) / map->texels.count);
    result->bias = sum / map->texels.count;
    result->largest = largest;
}

/// Mean and spread of error over stated error.
static void find_z(const bench_map *map, const float *errors, const bench_truth *truth,
                   bench_result *result)
{
    double sum = 0.0, squares = 0.0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < map->texels.count; i++) {
        if (errors[i] > 0.0f) {
            const double x = (double)map->lattice.values[i], e = (double)errors[i];
            const double a = (x - (double)truth->values[0][i]) / e;
            const double b = (x - (double)truth->values[1][i]) / e;
            sum += 0.5 * (a + b);
            squares += a * b;
            count++;
        }
    }
    result->z_mean = count > 0 ? sum / count : 0.0;
    result->z_spread = count > 0 ? sqrt(fmax(squares, 0.0) / count) : 0.0;
}

bool bench_bake(const bench_scene *scene, bench_map *map, const alp_occlusion_options *options,
                float accuracy, const bench_truth *truth, bench_result *result)
{
    const alpi_receivers receivers = alpi_texels_receivers(&map->texels);
    float *errors = bench_allocate(map->texels.count, sizeof *errors);
    alpi_occlusion_setup setup;
    alpi_scratch scratch = {0};
    const alpi_occlusion_task task = {.setup = &setup,
                                      .receivers = &receivers,
                                      .order = map->lattice.order,
                                      .count = map->texels.count,
                                      .proximity = map->validity.proximity,
                                      .lattice = &map->lattice,
                                      .errors = errors,
                                      .scratch = &scratch,
                                      .accuracy = accuracy,
                                      .deadline = HUGE_VAL};
    memset(map->lattice.states, 0, map->texels.count);
    *result = (bench_result){0};
    const double started = alpi_seconds();
    alp_result code = alpi_occlusion_prepare(scene->scene, scene->tracer, options, &setup);
    if (code == ALP_OK) {
        code = alpi_scratch_create(setup.context, map->texels.count, false, &scratch);
        code = code == ALP_OK ? alpi_occlusion_rounds(&task, &result->report) : code;
        alpi_scratch_destroy(&scratch);
        alpi_occlusion_release(&setup);
    }
    result->seconds = alpi_seconds() - started;
    if (code == ALP_OK && truth != NULL) {
        bench_judge(map, map->lattice.values, truth, result);
        find_z(map, errors, truth, result);
    }
    free(errors);
    return bench_good(scene, code);
}
