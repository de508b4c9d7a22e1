// SPDX-License-Identifier: MIT
// What gathers the direct light of one receiver after another, by one worker: the samples of a
// receiver, what they came to, and the rays under way.
#ifndef ALPI_TRANSPORT_DIRECT_GATHER_H
#define ALPI_TRANSPORT_DIRECT_GATHER_H

#include "base/random.h"
#include "transport/direct/direct_polygons.h"
#include "transport/direct/direct_setup.h"
#include "transport/direct/direct_spots.h"

#include <math.h>

/// Uses of random numbers at one sample; each sun has its own.
enum {
    ALPI_DIRECT_USE_PLACE,
    ALPI_DIRECT_USE_PICK,
    ALPI_DIRECT_USE_RAY,
    ALPI_DIRECT_USE_SURFACE,
    ALPI_DIRECT_USE_SKY,
    ALPI_DIRECT_USE_SUN
};
enum {
    ALPI_DIRECT_EVERY = ALPI_DIRECT_REPLICATES, // a replicate: what holds for all of them
    ALPI_DIRECT_CHUNK = 64, // samples whose points are placed at once; a multiple of replicates
    ALPI_DIRECT_QUEUE = ALPI_TRACE_BATCH * ALPI_PACKET
};
_Static_assert(ALPI_DIRECT_CHUNK % ALPI_DIRECT_REPLICATES == 0 &&
                   (ALPI_DIRECT_REPLICATES & (ALPI_DIRECT_REPLICATES - 1)) == 0,
               "replicates take turns, and halves are exact");

/// A ray under way: what it brings if nothing stops it.
typedef struct alpi_direct_arrival {
    float light[3];
    uint16_t part, replicate;
    alpi_directional_way way; // its direction is that of the ray that is sent
} alpi_direct_arrival;

typedef struct alpi_direct_gather {
    alpi_rays packets[ALPI_TRACE_BATCH]; // of the queue
    alpi_polygon_gather polygons;
    const alpi_direct *direct;
    const alpi_receivers *receivers;
    alpi_direct_output *output;
    uint64_t rays;
    double horizon_width;                // 0: light is not wanted by its direction
    alpi_directional_sums *by_direction; // where to add what arrives; NULL: it is not wanted
    alpi_directional_sums directional;
    alpi_emitter_choice choice;
    alpi_spot_gather spots;
    double sums[ALPI_DIRECT_PART_LIMIT][ALPI_DIRECT_REPLICATES][3];
    uint32_t first, count; // samples of the chunk
    uint32_t queued;
    uint32_t keys[2]; // of the receiver, for each half of its samples
    alpi_receiver_point points[ALPI_DIRECT_CHUNK];
    alpi_direct_arrival givens[ALPI_DIRECT_QUEUE];
} alpi_direct_gather;

/// Sample i of the chunk, for one use; the replicates take turns, and those of a half are one
/// sequence.
static inline vec2 alpi_direct_draw(const alpi_direct_gather *g, uint32_t use, uint32_t i)
{
    const uint32_t sample = g->first + i, replicate = sample % ALPI_DIRECT_REPLICATES;
    const uint32_t each = g->direct->samples / ALPI_DIRECT_REPLICATES;
    const uint32_t key = g->keys[replicate / ALPI_DIRECT_HALF];
    return alpi_sample_2d(alpi_hash32(key ^ alpi_hash32(use + 1u)),
                          replicate % ALPI_DIRECT_HALF * each + sample / ALPI_DIRECT_REPLICATES);
}

static inline uint32_t alpi_direct_replicate(uint32_t i)
{
    return i % ALPI_DIRECT_REPLICATES; // chunks begin with the first
}

static inline vec3 alpi_direct_start(const alpi_receiver_point *p)
{
    return vec3_mad(p->position, p->offset, p->geometric_normal);
}

/// Short of what gives light, which would stop the ray itself.
static inline float alpi_direct_reach(float distance, const alpi_receiver_point *p)
{
    return distance * (1.0f - 1e-5f) - 2.0f * p->offset;
}

// --- rays ----------------------------------------------------------------------------------------

/// Where a ray goes.
typedef struct alpi_direct_way {
    vec3 origin, direction;
    float reach; // metres
    alpi_rays_spread spread;
} alpi_direct_way;

/// Adds what arrived.
void alpi_direct_add(alpi_direct_gather *gather, const alpi_direct_arrival *given);
/// Light × factor arrives unless something is in between. What is queued is traced when the queue
/// is full.
void alpi_direct_send(alpi_direct_gather *gather, const alpi_direct_way *way, vec3 light,
                      float factor, alpi_direct_arrival given);
/// Traces what is queued and adds what arrives, in the order of the queue.
void alpi_direct_flush(alpi_direct_gather *gather, alpi_rays_spread spread);

// --- what rays go to -----------------------------------------------------------------------------

/// Light of lamps and suns at the points of the chunk.
void alpi_direct_add_lamps(alpi_direct_gather *gather);
void alpi_direct_add_suns(alpi_direct_gather *gather);
/// Light of the sky's spots at the points of the chunk; and what that comes to, after the last one.
void alpi_direct_add_spots(alpi_direct_gather *gather);
void alpi_direct_finish_spots(alpi_direct_gather *gather);

#endif
