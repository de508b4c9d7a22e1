// SPDX-License-Identifier: MIT
// The loops over samples of eight receivers that ask for the light of a polygon.
#ifndef ALPI_TRANSPORT_DIRECT_POLYGON_KERNEL_H
#define ALPI_TRANSPORT_DIRECT_POLYGON_KERNEL_H

#include "transport/direct/direct.h"

enum { ALPI_POLYGON_CHUNK = ALPI_TRACE_BATCH }; // samples of each receiver at once
/// Of the replicates; each decides how many samples the other has, but of the fewest: there those
/// of neighbours do.
enum { ALPI_POLYGON_HALVES = 2, ALPI_POLYGON_HALF = ALPI_DIRECT_REPLICATES / ALPI_POLYGON_HALVES };

/// A triangle or parallelogram of even radiance.
typedef struct alpi_polygon {
    vec3 corner[4]; // counter-clockwise seen from its front; of a triangle the last is the first
    bool triangle;
    bool two_sided;
    vec3 radiance;
    uint32_t part;      // of the light
    vec3 along, across; // edges at corner 0
    vec3 normal;        // unit, of the front
    vec3 middle;
    float area;     // m²
    float diameter; // metres: as far as two of its corners are apart
} alpi_polygon;

/// Samples [0, count) of eight receivers side by side: lane i is receiver i.
// In the order of its use. NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding)
typedef struct alpi_polygon_wave {
    uint32_t count;
    uint32_t scouts;           // the last of them count in no sum
    uint32_t first_each, each; // samples that each replicate is to have: at first, and in all
    uint32_t begin;            // replicate of the first sample
    _Alignas(32) float position[3][ALPI_POLYGON_CHUNK][ALPI_PACKET]; // metres
    float normal[3][ALPI_POLYGON_CHUNK][ALPI_PACKET];                // unit, the hemisphere's axis
    float origin[3][ALPI_POLYGON_CHUNK][ALPI_PACKET];                // metres: where rays start
    float offset[ALPI_POLYGON_CHUNK][ALPI_PACKET];                   // metres
    float u[ALPI_POLYGON_CHUNK][ALPI_PACKET], v[ALPI_POLYGON_CHUNK][ALPI_PACKET]; // random, [0, 1)
    double factor[ALPI_POLYGON_CHUNK][ALPI_PACKET]; // form factor from each point
    float weight[ALPI_POLYGON_CHUNK][ALPI_PACKET]; // c: estimate of π × factor by one point of it
    uint32_t nears[ALPI_POLYGON_CHUNK];            // bit i: lane i is near the polygon
    _Alignas(32) float wanted[ALPI_POLYGON_HALVES][ALPI_PACKET]; // 1 or 0: samples of a half of the
                                                                 // replicates count
    bool any_wanted[ALPI_POLYGON_HALVES];                        // by any lane
    alpi_rays rays[ALPI_POLYGON_CHUNK];
} alpi_polygon_wave;

/// Sums over samples, of each replicate.
typedef struct alpi_polygon_tally {
    _Alignas(32) double factor[ALPI_DIRECT_REPLICATES][ALPI_PACKET];
    double weight[ALPI_DIRECT_REPLICATES][ALPI_PACKET];
    double seen[3][ALPI_DIRECT_REPLICATES][ALPI_PACKET]; // of the weights; the first alone where
                                                         // there are no panes
} alpi_polygon_tally;

/// The loops that are compiled for each instruction set.
typedef struct alpi_polygon_loops {
    /// u and v of samples from `first` on, for one use. The replicates take turns, and those of a
    /// half are one sequence.
    /// @param keys [ALPI_POLYGON_HALVES] of the receivers
    void (*draw)(alpi_polygon_wave *wave, const uint32_t (*keys)[ALPI_PACKET], uint32_t use,
                 uint32_t first);
    /// Form factors, weights and rays to the points of the polygon that u and v tell.
    void (*aim)(alpi_polygon_wave *wave, const alpi_polygon *polygon);
    /// Adds to the sums; rays that are free have maximum ≥ 0. Nothing to `seen` where there are
    /// panes: they see to it.
    void (*tally)(const alpi_polygon_wave *wave, bool panes, alpi_polygon_tally *tally);
} alpi_polygon_loops;

extern const alpi_polygon_loops alpi_polygon_loops_baseline, alpi_polygon_loops_v3;

#endif
