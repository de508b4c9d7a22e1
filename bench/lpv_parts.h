// SPDX-License-Identifier: MIT
// Parts of the bench of light propagation, and the figures that its goals are held to.
#ifndef BENCH_LPV_PARTS_H
#define BENCH_LPV_PARTS_H

#include "bench.h"

typedef struct lpv_figures {
    double step, blocked,
        scatter;        // at 32³: over the floor; over the floor; plain scatter over step
    double frame;       // milliseconds of three cascades, without tracing
    double wall;        // % of the lit side behind a wall of one cell, the worst
    double usual, most; // % of the mean: 99.9 % of changes a frame, and the largest
} lpv_figures;

alp_result lpv_measure_steps(const bench_options *options, lpv_figures *figures);
alp_result lpv_measure_reach(const bench_options *options);
alp_result lpv_measure_walls(const bench_options *options, lpv_figures *figures);
alp_result lpv_measure_boxes(const bench_options *options);
alp_result lpv_measure_stability(const bench_options *options, lpv_figures *figures);

#endif
