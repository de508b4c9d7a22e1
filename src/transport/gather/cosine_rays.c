// SPDX-License-Identifier: MIT
#include "transport/gather/cosine_rays.h"

#include "base/random.h"
#include "transport/paths/paths.h"

#include <math.h>
#include <string.h>

enum { STREAM_COSINE_RAYS = 8 };
/// Packets of a replicate that follow each other leave from the same points, lane by lane, up to
/// four rays from each. Placing every ray for itself is a tenth of the time where texels have many
/// triangles, and four from one point err as four from four do (cornell, teapot-room, a sphere on a
/// plane; eight err by an eighth more in teapot-room at 64 rays).
enum { PACKETS_OF_POINTS = 4 };
_Static_assert(ALPI_GATHER_BATCH *ALPI_PACKET <= ALPI_WAVE, "a batch is a wave at most");

uint32_t alpi_cosine_rays_samples(uint32_t samples, uint32_t replicates)
{
    const uint32_t step = ALPI_PACKET * replicates, steps = samples / step;
    return (steps + (steps * step < samples || steps == 0 ? 1 : 0)) * step;
}

/// Where a packet is among those of its receiver.
typedef struct packet_place {
    uint32_t replicate, own; // packet `own` of the replicate
    uint32_t key;            // of the replicate's sequence
    uint32_t before;         // packets of the sequence that are of replicates before
    uint32_t group;          // of the sequence's groups of packets from the same points
} packet_place;

static packet_place find_place(const alpi_cosine_rays *r, uint32_t receiver, uint32_t packet)
{
    const uint32_t each = r->samples / ALPI_PACKET / r->replicates; // packets of a replicate
    const uint32_t groups = (each + PACKETS_OF_POINTS - 1) / PACKETS_OF_POINTS;
    const uint32_t replicate = packet / each, own = packet % each;
    const uint32_t key = alpi_random_key(r->seed, receiver, STREAM_COSINE_RAYS);
    return (packet_place){
        .replicate = replicate,
        .own = own,
        .key = alpi_hash32(key ^ alpi_hash32(r->joined ? 1u : replicate + 1u)),
        .before = r->joined ? replicate * each : 0,
        .group = (r->joined ? replicate * groups : 0) + own / PACKETS_OF_POINTS,
    };
}

static void number(alpi_path_wave *w, uint32_t i, uint32_t key, uint32_t sample)
{
    w->key[i] = key;
    w->sample[i] = sample;
    w->event[i] = 0;
}

/// Places the rays of some packets.
static void place_rays(const alpi_cosine_rays *r, const alpi_receivers *receivers,
                       uint32_t receiver, const packet_place *places, uint32_t count,
                       alpi_path_wave *w)
{
    float square[ALPI_WAVE][2];
    alpi_receiver_point points[ALPI_WAVE];
    uint32_t groups = 0, group[ALPI_GATHER_BATCH]; // of this batch
    for (uint32_t k = 0; k < count; k++) {
        const bool again = k > 0 && places[k].group == places[k - 1].group &&
                           places[k].replicate == places[k - 1].replicate;
        groups += again ? 0 : 1;
        group[k] = groups - 1;
        for (uint32_t lane = 0; lane < ALPI_PACKET && !again; lane++) {
            number(w, group[k] * ALPI_PACKET + lane, places[k].key,
                   places[k].group * ALPI_PACKET + lane);
        }
    }
    w->count = groups * ALPI_PACKET;
    ALPI_COMPILED_FOR(r->context, alpi_wave_loops).draw(w, ALPI_USE_PLACE, 0);
    for (uint32_t i = 0; i < w->count; i++) {
        square[i][0] = w->u[i];
        square[i][1] = w->v[i];
    }
    const uint32_t point_count = receivers->extended ? w->count : 1;
    receivers->place(receivers->user, receiver, point_count, (const float(*)[2])square, points);
    for (uint32_t i = 0; i < count * ALPI_PACKET; i++) {
        const uint32_t point = group[i / ALPI_PACKET] * ALPI_PACKET + i % ALPI_PACKET;
        alpi_paths_place(w, i, &points[receivers->extended ? point : 0]);
    }
}

/// Draws the rays' directions.
static void aim_rays(const alpi_cosine_rays *r, const packet_place *places, uint32_t count,
                     alpi_path_wave *w)
{
    const alpi_wave_loops *loops = &ALPI_COMPILED_FOR(r->context, alpi_wave_loops);
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t first = (places[k].before + places[k].own) * ALPI_PACKET;
        for (uint32_t lane = 0; lane < ALPI_PACKET; lane++) {
            number(w, k * ALPI_PACKET + lane, places[k].key, first + lane);
        }
    }
    w->count = count * ALPI_PACKET;
    loops->draw(w, ALPI_USE_RAY, 0);
    loops->aim(w);
}

static void fill_packet(const alpi_path_wave *w, uint32_t first, alpi_gather_packet *packet)
{
    const size_t size = ALPI_PACKET * sizeof(float);
    alpi_rays *rays = &packet->rays;
    alpi_rays_clear(rays);
    memcpy(rays->origin_x, w->start.x + first, size);
    memcpy(rays->origin_y, w->start.y + first, size);
    memcpy(rays->origin_z, w->start.z + first, size);
    memcpy(rays->direction_x, w->direction.x + first, size);
    memcpy(rays->direction_y, w->direction.y + first, size);
    memcpy(rays->direction_z, w->direction.z + first, size);
    for (int i = 0; i < ALPI_PACKET; i++) {
        rays->maximum[i] = INFINITY;
    }
    packet->active = 0xffu;
}

static void fill_ways(const alpi_path_wave *w, uint32_t first, alpi_gather_ways *ways)
{
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        const uint32_t k = first + i;
        ways->normals[i] = (vec3){w->normal.x[k], w->normal.y[k], w->normal.z[k]};
        ways->cosines[i] = (float)ALPI_PI * w->density[k];
    }
}

static void aim(const void *user, const alpi_receivers *receivers, uint32_t receiver,
                uint32_t first, uint32_t count, alpi_gather_packet *packets, alpi_gather_ways *ways)
{
    const alpi_cosine_rays *r = user;
    packet_place places[ALPI_GATHER_BATCH];
    alpi_path_wave w;
    for (uint32_t k = 0; k < count; k++) {
        places[k] = find_place(r, receiver, first + k);
    }
    place_rays(r, receivers, receiver, places, count, &w);
    aim_rays(r, places, count, &w);
    for (uint32_t k = 0; k < count; k++) {
        fill_packet(&w, k * ALPI_PACKET, &packets[k]);
    }
    for (uint32_t k = 0; k < count && ways != NULL; k++) {
        fill_ways(&w, k * ALPI_PACKET, &ways[k]);
    }
}

alpi_gatherer alpi_cosine_rays_gatherer(const alpi_cosine_rays *rays)
{
    return (alpi_gatherer){.aim = aim,
                           .user = rays,
                           .packet_count = rays->samples / ALPI_PACKET,
                           .replicates = rays->replicates,
                           .seed = rays->seed};
}
