// SPDX-License-Identifier: MIT
// Many paths of light side by side, as plain arrays: each step of all of them is one loop. Paths
// that end leave at once, so that packets of rays stay full.
#ifndef ALPI_TRANSPORT_PATH_WAVE_H
#define ALPI_TRANSPORT_PATH_WAVE_H

#include "transport/paths/reference.h"

enum { ALPI_WAVE = 256, ALPI_WAVE_PACKETS = ALPI_WAVE / ALPI_PACKET };

/// A vector of each path.
typedef struct alpi_wave_vec {
    _Alignas(32) float x[ALPI_WAVE];
    float y[ALPI_WAVE], z[ALPI_WAVE];
} alpi_wave_vec;

/// Paths [0, count) go on. What a path has brought is kept by slot, the place it began at.
typedef struct alpi_path_wave {
    uint32_t count;
    float first; // throughput of a fresh path
    // At its vertex.
    alpi_wave_vec origin;     // where rays start, the offset included; metres
    alpi_wave_vec normal;     // unit, the hemisphere's axis
    alpi_wave_vec side;       // unit, of the triangle, on the side that the path came from
    float offset[ALPI_WAVE];  // metres
    alpi_wave_vec throughput; // multiplies the irradiance there
    // The ray that is traced next.
    alpi_wave_vec start; // metres: the origin, or behind a pane that was passed
    alpi_wave_vec direction;
    float density[ALPI_WAVE]; // per steradian, of drawing it; < 0: light was not asked
    // Two random numbers of each.
    float u[ALPI_WAVE], v[ALPI_WAVE];
    float pick[ALPI_WAVE]; // of the light to ask
    // Which path it is.
    uint32_t key[ALPI_WAVE];    // of its replicate's random numbers
    uint32_t sample[ALPI_WAVE]; // of its replicate
    uint32_t event[ALPI_WAVE];  // surfaces met; numbers the uses of random numbers
    int32_t depth[ALPI_WAVE];   // bounces behind it; −1: the ray comes from the eye
    uint32_t slot[ALPI_WAVE];
    // By slot: neighbours that share what their paths find are `lanes` slots from `block` on.
    uint32_t block[ALPI_WAVE], lanes[ALPI_WAVE];
    alpi_wave_vec base, base_normal;     // its first vertex
    alpi_wave_vec own;                   // brought by the first vertex
    alpi_wave_vec tail;                  // by later ones: shared out
    float share[ALPI_WAVE][ALPI_PACKET]; // of a tail, of each lane of its block
    float whole[ALPI_WAVE];              // largest throughput that roulette compares with
    float covered[ALPI_WAVE];            // share of its view, if from the eye, that something fills
    // Rays on their way.
    alpi_rays rays[ALPI_WAVE_PACKETS];
    alpi_hits hits[ALPI_WAVE_PACKETS];
    alpi_wave_vec given;       // what each shadow ray brings if it is free
    uint32_t asker[ALPI_WAVE]; // whose it is
} alpi_path_wave;

/// Uses of random numbers at one vertex of a path.
typedef enum alpi_path_use {
    ALPI_USE_PLACE,  // on the receiver or pixel
    ALPI_USE_LIGHT,  // on the light that is asked
    ALPI_USE_RAY,    // direction of the next ray
    ALPI_USE_CHOICE, // which light; whether the path goes on
    ALPI_USE_PANE,   // through a pane or not
    ALPI_USE_COUNT
} alpi_path_use;

/// The loops over a wave that are compiled for each instruction set.
typedef struct alpi_wave_loops {
    /// u and v: two numbers of [0, 1) for a use at `ahead` events from now.
    void (*draw)(alpi_path_wave *wave, alpi_path_use use, uint32_t ahead);
    /// Rays that start at the vertices in cosine-distributed directions, by u and v.
    void (*aim)(alpi_path_wave *wave);
} alpi_wave_loops;

extern const alpi_wave_loops alpi_wave_loops_baseline, alpi_wave_loops_v3;

#endif
