// SPDX-License-Identifier: MIT
// Texels near a texel in space, whatever their charts and pages: a hash grid over their positions.
//
// Texels are sorted into octaves of their sides, and each octave into cells of eight of its sides,
// so that a search looks at few cells and few strangers however uneven the density of a map is.
#ifndef ALPI_MAPS_NEIGHBOURS_H
#define ALPI_MAPS_NEIGHBOURS_H

#include "base/context.h"
#include "base/vec.h"

#include <stdint.h>

/// A texel as its neighbours see it.
typedef struct alpi_site {
    vec3 position;  // metres
    vec3 normal;    // unit
    float side;     // metres
    uint32_t texel; // its index in the arrays it came from
} alpi_site;

typedef struct alpi_neighbours {
    alp_context *context;
    uint32_t count;
    alpi_site *sites;  // [count] cell by cell: near in it is near in space
    uint32_t *first;   // [buckets + 1] where each bucket of the hash begins
    uint32_t mask;     // buckets − 1
    bool octaves[256]; // which there are, by the biased exponent of the side
} alpi_neighbours;

/// Sorts `count` texels; those whose position, normal or side is not finite, whose side is not
/// between 1e-15 and 1e15 m, or whose position is beyond 1e15 sides, stand last in `sites` and are
/// nobody's neighbours.
/// @param positions [count] metres   @param normals [count] unit   @param sides [count] metres
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED by who watches the context
alp_result alpi_neighbours_create(alp_context *context, uint32_t count, const float (*positions)[3],
                                  const float (*normals)[3], const float *sides,
                                  alpi_neighbours *neighbours);
void alpi_neighbours_destroy(alpi_neighbours *neighbours);

/// How many sites have a place: the rest are nobody's neighbours.
uint32_t alpi_neighbours_placed(const alpi_neighbours *neighbours);

/// Sites, the centre's own included, in an order that is always the same: within `radius` metres of
/// it and of its plane by one side, with a side half to twice as large.
/// @return how many, at most `limit`; where there are more, limit + 1, and `near` holds some
uint32_t alpi_neighbours_around(const alpi_neighbours *neighbours, const alpi_site *centre,
                                float radius, uint32_t limit, uint32_t *near);

#endif
