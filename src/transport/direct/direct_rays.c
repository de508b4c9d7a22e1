// SPDX-License-Identifier: MIT
// The rays of direct light: a queue of them, and what the free ones bring.
#include "transport/direct/direct_gather.h"
#include "transport/paths/panes.h"

enum { R = ALPI_DIRECT_REPLICATES };

void alpi_direct_add(alpi_direct_gather *g, const alpi_direct_arrival *given)
{
    const uint32_t each = g->direct->samples / R;
    if (g->by_direction != NULL && given->way.cosine > 0.0f) {
        const double times =
            given->replicate == ALPI_DIRECT_EVERY ? (double)g->direct->samples : 1.0;
        const double light[3] = {times * (double)given->light[0], times * (double)given->light[1],
                                 times * (double)given->light[2]};
        alpi_directional_add(g->by_direction, light, &given->way);
    }
    for (int k = 0; k < 3; k++) {
        if (given->replicate != ALPI_DIRECT_EVERY) {
            g->sums[given->part][given->replicate][k] += (double)given->light[k];
            continue;
        }
        for (int r = 0; r < R; r++) {
            g->sums[given->part][r][k] += (double)given->light[k] * each;
        }
    }
}

/// Adds what the free rays of a packet bring, through panes.
static void add_free(alpi_direct_gather *g, uint32_t first, uint32_t count)
{
    const alpi_direct_options *o = &g->direct->options;
    alpi_rays *rays = &g->packets[first / ALPI_PACKET];
    uint32_t free = 0;
    vec3 left[ALPI_PACKET] = {{0.0f, 0.0f, 0.0f}};
    for (uint32_t i = 0; i < count; i++) {
        free |= rays->maximum[i] >= 0.0f ? 1u << i : 0u;
    }
    if (o->filter.panes) {
        alpi_panes_dim(o->scene, o->tracer, o->filter, free, rays, left);
    }
    for (uint32_t i = 0; i < count; i++) {
        alpi_direct_arrival *given = &g->givens[first + i];
        if (o->filter.panes) {
            given->light[0] *= left[i].x;
            given->light[1] *= left[i].y;
            given->light[2] *= left[i].z;
        }
        if ((free >> i & 1u) != 0) {
            alpi_direct_add(g, given);
        }
    }
}

void alpi_direct_flush(alpi_direct_gather *g, alpi_rays_spread spread)
{
    const alpi_direct_options *o = &g->direct->options;
    const uint32_t full = g->queued / ALPI_PACKET, rest = g->queued % ALPI_PACKET;
    if (full > 0) {
        alpi_trace_occluded(o->tracer, g->packets, full, (1u << ALPI_PACKET) - 1u, o->filter,
                            spread);
    }
    if (rest > 0) {
        alpi_trace_occluded(o->tracer, &g->packets[full], 1, (1u << rest) - 1u, o->filter, spread);
    }
    for (uint32_t first = 0; first < g->queued; first += ALPI_PACKET) {
        add_free(g, first, g->queued - first < ALPI_PACKET ? g->queued - first : ALPI_PACKET);
    }
    g->rays += g->queued;
    g->queued = 0;
}

void alpi_direct_send(alpi_direct_gather *g, const alpi_direct_way *way, vec3 light, float factor,
                      alpi_direct_arrival given)
{
    given.light[0] = light.x * factor;
    given.light[1] = light.y * factor;
    given.light[2] = light.z * factor;
    given.way.direction = way->direction;
    if (!isfinite(factor) || !(given.light[0] + given.light[1] + given.light[2] > 0.0f)) {
        return;
    }
    if (!(way->reach > 0.0f)) { // nothing fits in between
        alpi_direct_add(g, &given);
        return;
    }
    if (g->queued == ALPI_DIRECT_QUEUE) {
        alpi_direct_flush(g, way->spread);
    }
    const uint32_t lane = g->queued % ALPI_PACKET;
    alpi_rays *packet = &g->packets[g->queued / ALPI_PACKET];
    if (lane == 0) {
        alpi_rays_clear(packet);
    }
    alpi_rays_set(packet, (int)lane, way->origin, way->direction, way->reach);
    g->givens[g->queued++] = given;
}
