// SPDX-License-Identifier: MIT
// Irradiance along a line in space, read from the anchors of one moment.
#ifndef AMBIENCE_LINE_BENCH_H
#define AMBIENCE_LINE_BENCH_H

#include "ambience_world.h"

enum { LINE_METRES = 20, LINE_STEPS = 1000 * LINE_METRES, LINE_TRUTHS = 41 };

/// E at each millimetre, mean of its channels.
typedef struct ambience_line {
    double (*positions)[3];    // [LINE_STEPS + 1]
    float (*normals)[3];       // [LINE_STEPS + 1]
    float *ours, *conformance; // [LINE_STEPS + 1]
    float truth[LINE_TRUTHS];  // at even distances
} ambience_line;

/// The way of the first flight about a moment, seen by a wall that faces the camera's right.
void ambience_line_open(const ambience_world *world, double time, ambience_line *line);
void ambience_line_close(ambience_line *line);
void ambience_line_read(const alp_ambience_snapshot *snapshot, ambience_line *line);
/// @param paths of each of its points
bool ambience_line_trace(const ambience_world *world, uint32_t paths, ambience_line *line);
/// The largest change of E in a step of a millimetre.
double ambience_line_jump(const float *values);

#endif
