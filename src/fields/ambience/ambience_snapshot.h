// SPDX-License-Identifier: MIT
// One frame of the ambience volume, as readers see it.
//
// Light at a point p is read level by level, from the finest to level `depth`. The eight places of
// the lattice round p have trilinear weights t. An anchor there has confidence f (it fades in and
// out), openness o (0 in a solid), and visibility v (does it see p?). With w = t o (1 − f + f v):
//
//     S = Σ w,  F = Σ w f,  N = Σ w f c,  g = min(1, S / .004)
//     light += rest · g · N / S,   rest ← rest · (1 − g F / S)
//
// A node that shares its parent's anchor has at most the largest confidence among its siblings: so
// it comes and goes with them. A place without an anchor counts with f = 0, o = 1. So coarser
// levels provide the confidence that is missing, and solids count for nothing. After the last
// level, the rest is that of the mean of all anchors. The rest begins at 1, or less while the first
// light of the volume dawns. All weights are continuous in space and time.
#ifndef ALPI_FIELDS_AMBIENCE_SNAPSHOT_H
#define ALPI_FIELDS_AMBIENCE_SNAPSHOT_H

#include "base/context.h"
#include "base/vec.h"
#include "fields/ambience/ambience_graph.h"
#include "fields/ambience/ambience_lights.h"
#include "sh/sh9.h"

#include <alpenglow/ambience.h>

#include <stdatomic.h>

enum { ALPI_AMBIENCE_SNAPSHOTS = 16 };
_Static_assert((int)ALPI_AMBIENCE_FLOATS == 3 * (int)ALPI_SH9_COUNT, "nine coefficients");

/// An anchor as look-ups read it.
typedef struct alpi_read_anchor {
    uint32_t slot; // of its light; NO_SLOT: none
    float confidence, open, height;
    float clear;      // metres that it sees in all directions
    uint32_t version; // 0: never written
} alpi_read_anchor;

typedef struct alpi_read_node {
    uint32_t child, anchor;
    float share; // the most confidence that its anchor has there
} alpi_read_node;

typedef bool alpi_ambience_lookup_fn(const alp_ambience_snapshot *snapshot,
                                     const double position[3], const float *normal,
                                     float light[ALPI_AMBIENCE_FLOATS]);
alpi_ambience_lookup_fn alpi_ambience_lookup_baseline, alpi_ambience_lookup_v3;

struct alp_ambience_snapshot {
    alpi_ambience_lookup_fn *read;
    double centre[3], unit, inverse_unit;
    double level_scale[ALPI_GRAPH_LEVELS]; // 3^−level
    int32_t root_index[3];
    bool flat;
    alp_ambience_lookup lookup;
    uint32_t root_level, depth;
    alpi_read_node *nodes;
    size_t node_capacity;
    alpi_read_anchor *anchors;
    float (*light)[ALPI_AMBIENCE_FLOATS];       // c_lm by slot, coefficient and channel
    float (*moments)[ALPI_AMBIENCE_MOMENTS][2]; // NULL without visibility
    size_t anchor_capacity, light_capacity, moment_capacity;
    float base[ALPI_AMBIENCE_FLOATS], dawn;
    atomic_uint readers;
};

/// Snapshots; readers take the current one.
typedef struct alpi_snapshots {
    struct alp_ambience_snapshot *all[ALPI_AMBIENCE_SNAPSHOTS];
    uint32_t count;
    _Atomic(uint32_t) current;
} alpi_snapshots;

/// Copies the state to a snapshot without readers, and makes it the current one.
/// @return ALP_OK; OUT_OF_MEMORY; LIMIT (readers hold all): the current one stays
alp_result alpi_snapshot_publish(alp_ambience *ambience);
void alpi_snapshots_destroy(alp_ambience *ambience);
uint64_t alpi_snapshots_bytes(const alp_ambience *ambience, uint64_t *moments);

/// Radiance coefficients at a point.
/// @param normal NULL, or [3] unit, finite: anchors are seen or not from a quarter of their cell
///               above the surface there, so that those behind it do not count
/// @return false, with black: not finite, or beyond the lattice
bool alpi_ambience_read(const alp_ambience_snapshot *snapshot, const double position[3],
                        const float *normal, float light[ALPI_AMBIENCE_FLOATS]);
/// E [W·m⁻²] at a point with a normal, which may be below 0; black where either is not finite.
vec3 alpi_ambience_irradiance_at(const alp_ambience_snapshot *snapshot, const double position[3],
                                 vec3 normal);

#endif
