// SPDX-License-Identifier: MIT
#include "transport/cosine_rays.h"

#include "base/random.h"
#include "transport/paths.h"

#include <math.h>
#include <string.h>

enum { STREAM_COSINE_RAYS = 8 };
_Static_assert(ALPI_GATHER_BATCH *ALPI_PACKET <= ALPI_WAVE, "a batch is a wave at most");

uint32_t alpi_cosine_rays_samples(uint32_t samples, uint32_t replicates)
{
    const uint32_t step = ALPI_PACKET * replicates, steps = samples / step;
    return (steps + (steps * step < samples || steps == 0 ? 1 : 0)) * step;
}

/// Which random numbers each ray draws.
static void number_rays(const alpi_cosine_rays *r, uint32_t receiver, uint32_t first,
                        alpi_path_wave *w)
{
    const uint32_t key = alpi_random_key(r->seed, receiver, STREAM_COSINE_RAYS);
    const uint32_t each = r->samples / ALPI_PACKET / r->replicates; // packets of a replicate
    for (uint32_t i = 0; i < w->count; i++) {
        const uint32_t packet = first + i / ALPI_PACKET, replicate = packet % r->replicates;
        const uint32_t own = packet / r->replicates + (r->joined ? replicate * each : 0);
        w->key[i] = alpi_hash32(key ^ alpi_hash32(r->joined ? 1u : replicate + 1u));
        w->sample[i] = own * ALPI_PACKET + i % ALPI_PACKET;
        w->event[i] = 0;
    }
}

static void place_rays(const alpi_receivers *receivers, uint32_t receiver, alpi_path_wave *w)
{
    float square[ALPI_WAVE][2];
    alpi_receiver_point points[ALPI_WAVE];
    for (uint32_t i = 0; i < w->count; i++) {
        square[i][0] = w->u[i];
        square[i][1] = w->v[i];
    }
    const uint32_t count = receivers->extended ? w->count : 1;
    receivers->place(receivers->user, receiver, count, (const float(*)[2])square, points);
    for (uint32_t i = 0; i < w->count; i++) {
        alpi_paths_place(w, i, &points[receivers->extended ? i : 0]);
    }
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
    const alpi_wave_loops *loops = alpi_wave_loops_for(r->context);
    alpi_path_wave w;
    w.count = count * ALPI_PACKET;
    number_rays(r, receiver, first, &w);
    loops->draw(&w, ALPI_USE_PLACE, 0);
    place_rays(receivers, receiver, &w);
    loops->draw(&w, ALPI_USE_RAY, 0);
    loops->aim(&w);
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
