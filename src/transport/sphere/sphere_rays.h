// SPDX-License-Identifier: MIT
// Light from all directions at points in space, as nine spherical harmonics of radiance.
//
// Rays leave through the pixels of a cube about the point, one jittered ray a pixel. Pixels are
// even in angle: the face coordinates of (s, t) in [−1, 1]² are x = tan(πs/4), y = tan(πt/4). A ray
// stands for the solid angle
//
//     dω = (2/n)² (π/4)² (1 + x²)(1 + y²) / (1 + x² + y²)^1.5
//
// and those of a replicate are scaled to sum to 4π, so that even light counts exactly. Replicates
// have jitter of their own. The spread of their means gives the variance.
#ifndef ALPI_TRANSPORT_SPHERE_RAYS_H
#define ALPI_TRANSPORT_SPHERE_RAYS_H

#include "sh/sh9.h"
#include "transport/gather/gather.h"
#include "transport/sphere/sphere_occluders.h"

enum {
    ALPI_SPHERE_REPLICATES_LEAST = 2,
    ALPI_SPHERE_REPLICATES = 4, // default
    ALPI_SPHERE_REPLICATES_MOST = 64,
    ALPI_SPHERE_FACE = 8, // default: 4 × 6 × 8² = 1,536 rays
    ALPI_SPHERE_FACE_MOST = 256,
    ALPI_SPHERE_MOMENT_SIDE = 8,
    ALPI_SPHERE_MOMENTS = ALPI_SPHERE_MOMENT_SIDE * ALPI_SPHERE_MOMENT_SIDE,
    ALPI_MOMENT_BINS = 40, // of distances, four an octave, from reach / 1024 to reach
};

/// One point's light; values are means over the replicates.
typedef struct alpi_sphere_light {
    alpi_sh9 light;          // radiance coefficients [W·m⁻²]
    alpi_sh9 variance;       // of each mean
    float behind;            // share of the sphere that shows black backs of surfaces
    float back_distance;     // metres to the nearest such back, INFINITY without one
    float back_direction[3]; // towards it, unit
    float front_distance;    // metres to the nearest surface of another kind
} alpi_sphere_light;

typedef struct alpi_sphere_rays {
    alp_context *context;
    alpi_gather_scene from; // emitters and sky count as it says
    uint32_t face;          // n: pixels along an edge of a face, a multiple of 4, [4, FACE_MOST]
    uint32_t replicates;    // [LEAST, MOST]
    // NULL, or sources that rays are aimed at (sphere_aimed.h): without punctual lights and suns.
    // Then `from` counts no emitters.
    const alpi_lighting *aimed;
    // NULL, or spheres that stop rays at sources and lamps. Rays through pixels pass them.
    const alpi_occluders *occluders;
    float reach; // metres: larger distances count as this in moments
    uint64_t seed;
} alpi_sphere_rays;

/// Points and what is found there.
typedef struct alpi_sphere_job {
    const alpi_sphere_rays *rays;
    const float (*points)[3];  // metres
    const uint32_t *list;      // [count] points; NULL: all
    uint32_t count;            // of the list
    alpi_sphere_light *values; // [points] out
    // NULL, or [points][MOMENTS] out: mean of the distance to what rays meet [m], and of its square
    // [m²], by octahedral texel (base/octahedral.h), row by row.
    float (*moments)[2];
} alpi_sphere_job;

/// Rays of a point.
static inline uint32_t alpi_sphere_rays_count(const alpi_sphere_rays *rays)
{
    return rays->replicates * 6 * rays->face * rays->face;
}

/// The index of a point is its key for random numbers. The same bits for any number of workers.
/// @return ALP_OK; CANCELLED
alp_result alpi_sphere_gather(const alpi_sphere_job *job, const alpi_task_progress *progress);

// --- the loops that are compiled for each instruction set ----------------------------------------

/// Eight rays through neighbouring pixels of a face, 4 × 2, and what they bring.
typedef struct alpi_sphere_packet {
    alpi_rays rays;
    _Alignas(32) float weight[ALPI_PACKET]; // solid angle, before scaling
    float light[3][ALPI_PACKET];            // radiance by channel
} alpi_sphere_packet;

/// A packet's place: pixels (column … column + 3, row … row + 1) of a face.
typedef struct alpi_sphere_place {
    vec3 point;
    uint32_t key;                          // of the replicate's jitter at this point
    uint32_t face_side, face, column, row; // n; 0 … 5: +x −x +y −y +z −z
} alpi_sphere_place;

/// Packet `packet` of a replicate: face after face, row after row.
static inline alpi_sphere_place alpi_sphere_place_of(uint32_t face_side, vec3 point, uint32_t key,
                                                     uint32_t packet)
{
    const uint32_t across = face_side / 4, each = face_side * face_side / ALPI_PACKET;
    const uint32_t in_face = packet % each;
    return (alpi_sphere_place){.point = point,
                               .key = key,
                               .face_side = face_side,
                               .face = packet / each,
                               .column = 4 * (in_face % across),
                               .row = 2 * (in_face / across)};
}

enum { ALPI_SPHERE_BATCH = 16 }; // packets of a batch stay in the first cache

/// How packets of a cube's pixels are traced fastest.
typedef struct alpi_sphere_tracing {
    const alpi_tracer *tracer;
    alpi_trace_filter filter;
    bool coherent, in_pairs;
} alpi_sphere_tracing;
/// @param face_side pixels along a face
alpi_sphere_tracing alpi_sphere_tracing_for(const alpi_tracer *tracer, alpi_trace_filter filter,
                                            uint32_t face_side);
/// Nearest hits of at most ALPI_SPHERE_BATCH packets.
void alpi_sphere_trace(const alpi_sphere_tracing *tracing, uint32_t count,
                       const alpi_sphere_packet *packets, alpi_hits *hits);

/// Sums over packets, lane by lane.
typedef struct alpi_sphere_tallies {
    _Alignas(
        32) float light[3 * ALPI_SH9_COUNT][ALPI_PACKET]; // weight · Y · light: [3 i + channel]
    float weight[ALPI_PACKET];
} alpi_sphere_tallies;

typedef struct alpi_sphere_loops {
    void (*aim)(const alpi_sphere_place *place, alpi_sphere_packet *packet);
    /// Bits of the lanes that met something.
    uint32_t (*find_met)(const alpi_hits *hits);
    /// Lowers each lane's distance to that of its hit.
    void (*find_nearest)(const alpi_hits *hits, float nearest[ALPI_PACKET]);
    /// Sets the light of a packet to that of cells.
    void (*light)(const float (*cells)[4], const uint32_t of[ALPI_PACKET],
                  alpi_sphere_packet *packet);
    void (*add)(const alpi_sphere_packet *packets, uint32_t count, alpi_sphere_tallies *tallies);
    /// Distances, at most `reach`, and the slot of each: texel × ALPI_MOMENT_BINS + bin.
    void (*find_slots)(const alpi_sphere_packet *packet, const alpi_hits *hits, float reach,
                       float distance[ALPI_PACKET], int32_t slot[ALPI_PACKET]);
} alpi_sphere_loops;
extern const alpi_sphere_loops alpi_sphere_loops_baseline, alpi_sphere_loops_v3;

#endif
