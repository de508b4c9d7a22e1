// SPDX-License-Identifier: MIT
// Gathering: irradiance at receivers, by the rays of a gatherer.
#ifndef ALPI_TRANSPORT_GATHER_H
#define ALPI_TRANSPORT_GATHER_H

#include "base/tiles/tiles.h"
#include "scene/lights/lighting.h"
#include "scene/receivers.h"
#include "transport/directional.h"
#include "transport/paths/reference.h"
#include "transport/surface_light.h"

#include <assert.h>

/// Transmittance of a medium. Multiplies `left` by the share of light that goes through along each
/// ray, from its origin to its hit. Called by many threads.
/// @param active bit i: lane i has been traced
typedef void alpi_medium_fn(const void *user, const alpi_rays *rays, const alpi_hits *hits,
                            uint32_t active, vec3 left[ALPI_PACKET]);
typedef struct alpi_medium {
    alpi_medium_fn *dim; // NULL: there is no medium
    const void *user;    // what it reads
} alpi_medium;

/// The scene and the light that rays meet; all borrowed. Emissive surfaces and the sky count where
/// a ray meets them, or they are direct light, which has better samples (alpi_direct). Lamps and
/// suns always are direct light: no ray meets a point, and a sun's disk is smaller than the gaps
/// between rays. A sun in the picture of a sky belongs to the sky.
typedef struct alpi_gather_scene {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    const alpi_lighting *lighting; // NULL: no sky
    alpi_trace_filter filter;      // its panes are ignored: gathering handles them
    alpi_surface_light light;
    bool emitters, sky; // whether they count
    // Path tracer for rays that hit a cell closer than near_reach times its ALPI_CELL_SIDE
    // (near_rays.h); NULL disables it. Its paths have a few bounces, meet all light with sky and
    // emitters, and end in cells. Only for gather jobs whose `lost` is NULL.
    const alpi_reference *near;
    float near_reach;
    alpi_medium medium; // of alpi_gather_trace
} alpi_gather_scene;

/// Traces rays, through panes and medium, and returns the radiance of their hits. The light of a
/// pane is dimmed by the medium before it alone.
/// @param rays     unit directions; destroyed
/// @param active   bit i: lane i
/// @param coherent the rays of the packet leave in about one direction
/// @param radiance out; 0 of lanes that are not active
/// @param open     NULL, or out: transmittance of panes and medium along each ray that leaves the
///                 scene; 0 of the others
void alpi_gather_trace(const alpi_gather_scene *from, alpi_rays *rays, uint32_t active,
                       bool coherent, vec3 radiance[ALPI_PACKET], vec3 open[ALPI_PACKET]);

/// Rays of one packet, as a gatherer spreads them.
typedef struct alpi_gather_packet {
    alpi_rays rays; // unit directions
    uint32_t active;
} alpi_gather_packet;
/// How the rays of a packet leave their surface.
typedef struct alpi_gather_ways {
    vec3 normals[ALPI_PACKET];  // shading normals where they start
    float cosines[ALPI_PACKET]; // to them
} alpi_gather_ways;

/// Aims packets [first, first + count) of a receiver, at most ALPI_GATHER_BATCH. Called by many
/// threads. The receiver keys its random numbers.
/// @param packets, ways [count] out; ways may be NULL
typedef void alpi_aim_fn(const void *user, const alpi_receivers *receivers, uint32_t receiver,
                         uint32_t first, uint32_t count, alpi_gather_packet *packets,
                         alpi_gather_ways *ways);
enum { ALPI_GATHER_BATCH = ALPI_LIGHT_BATCH, ALPI_GATHER_REPLICATE_LIMIT = 8 };

/// Distribution of rays over the hemisphere, hemicube or cosine rays: E = π Σ weight · L.
typedef struct alpi_gatherer {
    alpi_aim_fn *aim;
    const void *user;                    // of aim
    uint32_t packet_count;               // of each receiver
    const float (*weights)[ALPI_PACKET]; // [packet_count], they sum to 1; NULL: all alike
    uint32_t replicates; // of the same number of packets, which divides packet_count, one after the
                         // other; 1: the error is not known
    bool coherent;       // the rays of a packet leave in about one direction
    uint64_t seed;       // of the paths of near rays
} alpi_gatherer;

/// Packets of a replicate.
static inline uint32_t alpi_gather_packets_each(const alpi_gatherer *gatherer)
{
    return gatherer->packet_count / gatherer->replicates;
}
/// Checks that all replicates have the same number of packets; otherwise light would be lost.
static inline void alpi_gather_check(const alpi_gatherer *gatherer)
{
    (void)gatherer;
    assert(gatherer->packet_count > 0 && gatherer->replicates > 0 &&
           gatherer->replicates <= ALPI_GATHER_REPLICATE_LIMIT &&
           gatherer->packet_count % gatherer->replicates == 0);
}
/// The replicate of a packet.
static inline uint32_t alpi_gather_replicate(const alpi_gatherer *gatherer, uint32_t packet)
{
    return gatherer->replicates == 1 ? 0 : packet / alpi_gather_packets_each(gatherer);
}

/// A gather job; all borrowed.
typedef struct alpi_gather_job {
    alp_context *context;
    const alpi_gather_scene *from;
    const alpi_gatherer *gatherer;
    const alpi_receivers *receivers;
    const uint32_t *list; // [count] receivers; NULL = all
    uint32_t count;
    // Out, of the receivers listed.
    alpi_reference_value *values;  // [receivers] E [W·m⁻²]; variance 0 with one replicate
    float (*skies)[3];             // [receivers] or NULL: the sky's part of E, if surface light is
                                   // in cells and there are no panes; else 0
    float (*lost)[2];              // [receivers] or NULL: weights of the rays that left the scene,
                                   // and of those that met a black back; under the same conditions
    alpi_directional *directional; // [receivers] or NULL
    bool directional_without_sky;  // under the same conditions
    uint8_t *marks;                // [mark_count] set as rays meet surface light, or NULL
    size_t mark_count;
} alpi_gather_job;

/// Fingerprint of the rays of a job, for its tile loops.
uint64_t alpi_gather_key(const alpi_gather_job *job);
enum { ALPI_GATHER_OUTPUTS = 4 };
/// The arrays of a job, as outputs of a loop over its receivers.
void alpi_gather_outputs(const alpi_gather_job *job, alpi_tile_output outputs[ALPI_GATHER_OUTPUTS]);

/// @return ALP_OK; CANCELLED; of alpi_tile_loop_run. The same bits for any number of workers.
alp_result alpi_gather_irradiance(const alpi_gather_job *job, const alpi_task_progress *progress);

/// Whether rays meet only surface light in cells and the sky.
bool alpi_gather_meets_cells(const alpi_gather_scene *from);
/// The cells that the rays of packets meet, at most ALPI_GATHER_BATCH. Needs
/// alpi_gather_meets_cells.
/// @param cells [count] out: CELL_BLACK of lanes that are not active
void alpi_gather_cells(const alpi_gather_scene *from, const alpi_gather_packet *packets,
                       uint32_t count, bool coherent, uint32_t (*cells)[ALPI_PACKET]);

/// Sums over the rays of one receiver, in their order.
typedef struct alpi_gather_sums {
    double light[ALPI_GATHER_REPLICATE_LIMIT][3]; // Σ weight · L
    double sky[3];                                // part of it
    double lost[2];
    alpi_directional_sums directional;
} alpi_gather_sums;
void alpi_gather_add(const alpi_gatherer *gatherer, uint32_t packet,
                     const vec3 radiance[ALPI_PACKET], alpi_gather_sums *sums);
/// Radiance of the sky along the rays that met nothing; black of others.
/// @param packets, cells [count], count at most ALPI_GATHER_BATCH   @param skies [count] out
void alpi_gather_find_skies(const alpi_gather_scene *from, const alpi_gather_packet *packets,
                            uint32_t count, const uint32_t (*cells)[ALPI_PACKET],
                            vec3 (*skies)[ALPI_PACKET]);
void alpi_gather_add_sky(const alpi_gatherer *gatherer, uint32_t packet,
                         const uint32_t cells[ALPI_PACKET], const vec3 skies[ALPI_PACKET],
                         alpi_gather_sums *sums);
void alpi_gather_add_cells(const alpi_gatherer *gatherer, uint32_t packet,
                           const uint32_t cells[ALPI_PACKET], const float (*light)[4],
                           alpi_gather_sums *sums);
/// Adds light by its direction; pixels of a hemicube, whose weights differ, have no horizon apart.
void alpi_gather_add_directional(const alpi_gatherer *gatherer, uint32_t packet,
                                 const alpi_gather_packet *aimed, const alpi_gather_ways *ways,
                                 const vec3 radiance[ALPI_PACKET], alpi_gather_sums *sums);
void alpi_gather_finish(const alpi_gatherer *gatherer, const alpi_gather_sums *sums,
                        alpi_reference_value *value);
/// Writes the sums of a receiver to the job's outputs.
void alpi_gather_write(const alpi_gather_job *job, uint32_t receiver, const alpi_gather_sums *sums);

#endif
