// SPDX-License-Identifier: MIT
// The steps of sphere_hits.h: rays to hits, and hits to light.
#ifndef ALPI_TRANSPORT_SPHERE_RELIGHT_H
#define ALPI_TRANSPORT_SPHERE_RELIGHT_H

#include "transport/sphere/sphere_hits.h"

/// Surfaces that the rays of a packet met, lane by lane.
typedef struct alpi_sphere_met {
    _Alignas(32) float corners[3][3][ALPI_PACKET]; // in: corner by axis, metres
    float distance[ALPI_PACKET];                   // in: metres, finite
    uint32_t key, first;                           // in: of random numbers, number of lane 0
    uint32_t random[ALPI_PACKET];                  // one number a ray
    _Alignas(32) float position[3][ALPI_PACKET];   // metres, lifted off the surface
    float normal[3][ALPI_PACKET];                  // unit, of the side that was met
    float offset[ALPI_PACKET];                     // metres that it was lifted
    float irradiance[3][ALPI_PACKET];              // in, out: sum of light that falls on it
    float albedo[3][ALPI_PACKET];                  // in: square root, in 1/255
} alpi_sphere_met;

enum { ALPI_DISK_DIRECTIONS = 256 };
/// A lamp, sampled from hits.
typedef struct alpi_sphere_lamp {
    uint32_t light; // of the lighting
    bool distant;   // then: light from `directions`; a hit samples a random one
    vec3 light_each;
    uint32_t mask; // of their number, which is a power of two
    float directions[ALPI_DISK_DIRECTIONS][3];
} alpi_sphere_lamp;

/// Shared by all points.
typedef struct alpi_sphere_hits_run {
    const alpi_sphere_relight *how;
    alpi_sphere_hits_point *points;
    const alpi_sphere_loops *loops;
    const struct alpi_sphere_hits_loops *hits_loops;
    alpi_trace_filter filter;
    const alpi_sky *sky; // NULL: black
    alpi_sphere_lamp *lamps;
    uint32_t lamp_count;
} alpi_sphere_hits_run;

/// The point in work.
typedef struct alpi_sphere_hits_work {
    const alpi_sphere_hits_run *run;
    vec3 point;
    uint32_t key;
    alpi_sphere_tracing tracing;
} alpi_sphere_hits_work;

/// Traces a batch of packets. @param first number of the first packet
void alpi_sphere_hits_trace(const alpi_sphere_hits_work *work, uint32_t first, uint32_t count,
                            const alpi_sphere_packet *packets,
                            alpi_sphere_hit (*hits)[ALPI_PACKET]);
/// Lights a batch: sets the light of packets whose rays are aimed.
void alpi_sphere_hits_light(const alpi_sphere_hits_work *work, uint32_t first, uint32_t count,
                            const alpi_sphere_hit (*hits)[ALPI_PACKET],
                            alpi_sphere_packet *packets);

// --- the loops that are compiled for each instruction set ----------------------------------------

typedef struct alpi_sphere_hits_loops {
    /// Places hits on their triangles.
    void (*place)(const alpi_sphere_packet *packet, alpi_sphere_met *met);
    /// Aims a ray from each hit at a distant lamp. @return bits of the lanes that face it
    uint32_t (*aim)(const alpi_sphere_met *met, const alpi_sphere_lamp *lamp, alpi_rays *rays,
                    float cosines[ALPI_PACKET]);
    /// Adds the light of lanes whose ray is open.
    void (*add)(const alpi_rays *rays, uint32_t active, const float cosines[ALPI_PACKET],
                vec3 light, alpi_sphere_met *met);
    /// Sets the light of the packet to what its hits reflect.
    void (*reflect)(const alpi_sphere_met *met, alpi_sphere_packet *packet);
} alpi_sphere_hits_loops;
extern const alpi_sphere_hits_loops alpi_sphere_hits_loops_baseline, alpi_sphere_hits_loops_v3;

#endif
