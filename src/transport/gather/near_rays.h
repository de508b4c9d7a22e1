// SPDX-License-Identifier: MIT
// Rays that meet something within a texel or so of where they start. What surface light keeps is
// the mean over a texel, and changes within it where surfaces meet, a shadow's edge falls, or part
// of it is covered: from afar nobody sees that, but who is near sees one end of the texel and not
// the other. So such rays go on from where they arrive by one path: light there is asked for, and
// what one further ray meets is looked up, or, where that is near too, the path goes on.
#ifndef ALPI_TRANSPORT_NEAR_RAYS_H
#define ALPI_TRANSPORT_NEAR_RAYS_H

#include "transport/gather/gather.h"
#include "transport/paths/path_wave.h"

/// Those of one batch of a receiver.
typedef struct alpi_near_rays {
    const alpi_gather_job *job;
    uint32_t receiver, first;                      // packet of the receiver: the batch's first
    vec3 radiance[ALPI_GATHER_BATCH][ALPI_PACKET]; // that they bring back; black of other rays
    alpi_path_wave wave;
    uint32_t places[ALPI_WAVE]; // of each path: ALPI_PACKET · packet of the batch + lane
    vec3 albedos[ALPI_WAVE];    // where it goes on
} alpi_near_rays;

void alpi_near_rays_start(const alpi_gather_job *job, uint32_t receiver, uint32_t first,
                          alpi_near_rays *near);
/// Takes the rays of packet `k` of the batch that met a cell nearer than from->near_reach of its
/// sides. Those cells become black. Called for each packet, in their order.
void alpi_near_rays_take(alpi_near_rays *near, uint32_t k, const alpi_gather_packet *packet,
                         const alpi_hits *hits, uint32_t cells[ALPI_PACKET]);
/// Finds what those that were taken bring back.
void alpi_near_rays_go_on(alpi_near_rays *near);

#endif
