// SPDX-License-Identifier: MIT
// What all clusters that grow over adjacency share: their members, and the check that these do not
// fold over themselves on the cluster's plane. Who grows them decides in what order.
#ifndef ALPI_ATLAS_GROWTH_H
#define ALPI_ATLAS_GROWTH_H

#include "atlas/fold.h"
#include "atlas/stages.h"

typedef struct alpi_growth {
    const alp_scene *scene; // borrowed, as neighbours and clusters are
    const uint32_t (*neighbours)[3];
    alpi_clusters *clusters; // out; the one that grows is clusters->count
    size_t plane_capacity;
    uint32_t *visited; // [triangle_count] cluster + 1 that last reached the triangle
    uint32_t *members; // [usable_count] of the cluster that grows, as they were reached
    // By member, for the fold check:
    alpi_flat *flats;
    size_t flat_capacity;
    bool *accepted;
    size_t accepted_capacity;
    alpi_fold fold;
} alpi_growth;

/// Makes room; every triangle is of no cluster. Set scene, neighbours and clusters before.
alp_result alpi_growth_begin(alpi_growth *g);
/// Releases all but the clusters.
void alpi_growth_end(alpi_growth *g);

/// How many members there are when folds are looked for next. A cluster is checked each time it has
/// doubled, so that a long spiral costs no more than what is kept of it.
uint32_t alpi_growth_limit(uint32_t kept);
/// Takes the members after the first `kept` into the cluster, in order, except those that overlap
/// one taken before, or that were reached only through one of those: these count as not visited.
/// @param count in: members; out: those that are left
/// @param folded out: whether not all were taken
alp_result alpi_growth_check(alpi_growth *g, const alpi_plane *plane, uint32_t kept,
                             uint32_t *count, bool *folded);
/// Ends the cluster that grows, and begins the next.
alp_result alpi_growth_close(alpi_growth *g, vec3 normal);

#endif
