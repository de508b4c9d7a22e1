// SPDX-License-Identifier: MIT
#include "transport/gather/near_rays.h"

#include "base/random.h"
#include "transport/paths/hit.h"
#include "transport/paths/paths.h"

enum { STREAM_NEAR_RAYS = 15 };
_Static_assert(ALPI_GATHER_BATCH *ALPI_PACKET <= ALPI_WAVE, "a batch is a wave at most");

void alpi_near_rays_start(const alpi_gather_job *job, uint32_t receiver, uint32_t first,
                          alpi_near_rays *near)
{
    near->job = job;
    near->receiver = receiver;
    near->first = first;
    near->wave.count = 0;
}

/// A path from where lane `lane` of packet `k` arrived; its random numbers are those of its packet.
static void start_path(alpi_near_rays *n, uint32_t k, int lane, const alpi_rays *rays,
                       const alpi_hits *hits)
{
    const alpi_gather_scene *from = n->job->from;
    const alpi_gatherer *gatherer = n->job->gatherer;
    const uint32_t packet = n->first + k, replicate = alpi_gather_replicate(gatherer, packet);
    const uint32_t each = alpi_gather_packets_each(gatherer);
    const uint32_t key = alpi_random_key(gatherer->seed, n->receiver, STREAM_NEAR_RAYS);
    const vec3 direction = {rays->direction_x[lane], rays->direction_y[lane],
                            rays->direction_z[lane]};
    const alpi_receiver_point at = alpi_hit_point(from->scene, hits, lane, direction, NULL);
    alpi_path_wave *w = &n->wave;
    const uint32_t slot = w->count++;
    alpi_paths_place(w, slot, &at);
    w->key[slot] = alpi_hash32(key ^ alpi_hash32(replicate + 1u));
    w->sample[slot] = packet % each * ALPI_PACKET + (uint32_t)lane;
    w->event[slot] = 0;
    w->depth[slot] = 1; // has bounced once: light is asked by area, which takes less time
    w->slot[slot] = w->block[slot] = slot;
    w->lanes[slot] = 1;
    w->throughput.x[slot] = w->throughput.y[slot] = w->throughput.z[slot] = 1.0f;
    n->places[slot] = k * ALPI_PACKET + (uint32_t)lane;
    n->albedos[slot] =
        alpi_surface_albedo(from->scene, hits->triangle[lane], hits->b1[lane], hits->b2[lane]);
}

void alpi_near_rays_take(alpi_near_rays *near, uint32_t k, const alpi_gather_packet *packet,
                         const alpi_hits *hits, uint32_t cells[ALPI_PACKET])
{
    const alpi_gather_scene *from = near->job->from;
    for (int i = 0; i < ALPI_PACKET; i++) {
        near->radiance[k][i] = (vec3){0.0f, 0.0f, 0.0f};
        const float side = from->light.cells[cells[i]][ALPI_CELL_SIDE];
        if (cells[i] >= ALPI_CELL_FIRST && hits->distance[i] < from->near_reach * side) {
            start_path(near, k, i, &packet->rays, hits);
            cells[i] = ALPI_CELL_BLACK;
        }
    }
}

void alpi_near_rays_go_on(alpi_near_rays *near)
{
    const uint32_t count = near->wave.count;
    alpi_paths_run(near->job->from->near, &near->wave);
    for (uint32_t i = 0; i < count; i++) {
        const vec3 light = alpi_paths_light(&near->wave, i), albedo = near->albedos[i];
        const vec3 reflected = {albedo.x * light.x, albedo.y * light.y, albedo.z * light.z};
        near->radiance[near->places[i] / ALPI_PACKET][near->places[i] % ALPI_PACKET] =
            vec3_scale(reflected, (float)(1.0 / ALPI_PI));
    }
}
