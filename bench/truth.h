// SPDX-License-Identifier: MIT
// The truth to hold a map to: two bakes of the same texels with many rays each, independent of it
// and of each other, so that E[(x − y₁)(x − y₂)] is the squared error of x without their own.
#ifndef BENCH_TRUTH_H
#define BENCH_TRUTH_H

#include "bench.h"

typedef struct bench_truth {
    float *values[2]; // [texels]
    double mean;
} bench_truth;
bool bench_truth_open(const bench_scene *scene, const bench_map *map,
                      const alp_occlusion_options *options, uint32_t samples, bench_truth *truth);
void bench_truth_close(bench_truth *truth);

/// A map as the bake makes it, and how far it is from the truth.
typedef struct bench_result {
    alpi_occlusion_report report;
    double seconds, rmse, largest, bias;
    double z_mean, z_spread; // of error / stated error
} bench_result;
/// @param accuracy ALP_ADAPTIVE_AUTO or _OFF
bool bench_bake(const bench_scene *scene, bench_map *map, const alp_occlusion_options *options,
                float accuracy, const bench_truth *truth, bench_result *result);
/// Error of any values at the texels.
void bench_judge(const bench_map *map, const float *values, const bench_truth *truth,
                 bench_result *result);

#endif
