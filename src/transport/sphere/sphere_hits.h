// SPDX-License-Identifier: MIT
// Light from all directions at points in space, by rays whose hits can be kept and relit.
//
// Rays are those of sphere_rays.h, of one replicate. Each hit keeps its triangle, distance and
// albedo. Its place follows from the point and the ray, which is a function of key and face. So
// light can change without tracing the rays again: shadow rays alone are traced. A diffuse surface
// that emits Le sends
//
//     L = Le + albedo/π · (E_lamps + E_bounce)
//
// E_lamps comes straight from punctual lights and suns: one shadow ray a hit to each of them, or to
// ALPI_HITS_LAMPS draws where there are more. A sun's disk is sampled. The caller provides
// E_bounce. Cosines are those of triangles, not of shading normals.
//
// Panes: a ray goes on behind a pane or ends there, by chance. Panes that it passed colour its
// albedo and the sky behind; emission is dimmed by the mean of the channels. Lamps shine through
// panes.
#ifndef ALPI_TRANSPORT_SPHERE_HITS_H
#define ALPI_TRANSPORT_SPHERE_HITS_H

#include "transport/sphere/sphere_rays.h"

enum {
    ALPI_HITS_FACE_MOST = 64,
    ALPI_HITS_LAMPS = 8, // lamps that light a hit at most
};

/// The `side` of a hit.
enum {
    ALPI_HIT_FRONT = 0,
    ALPI_HIT_BACK = 1,       // of a double-sided surface
    ALPI_HIT_BLACK = 2,      // back of a single-sided one
    ALPI_HIT_SIDE = 3,       // mask of these
    ALPI_HIT_EMITS = 4,      // flag: the material shines
    ALPI_HIT_LEVEL = 3,      // shift of the level that panes leave of emission, …
    ALPI_HIT_LEVEL_MOST = 31 // … in parts of this
};

/// The surface that one ray met. 12 bytes.
typedef struct alpi_sphere_hit {
    uint32_t triangle; // ALPI_NONE: the ray left the scene
    float distance;    // metres
    uint8_t albedo[3]; // square root of the albedo in 1/255; of rays that left: of the sky's share
    uint8_t side;
} alpi_sphere_hit;

/// E [W·m⁻²] of light that falls on surfaces, all but that straight from lamps and suns (what a
/// field holds). A point's value must not depend on those beside it. Called by many threads.
/// @param points metres, lifted off the surface   @param normals unit
/// @param count  at most ALPI_PACKET               @param irradiance [count] out
typedef void alpi_bounce_fn(const void *user, uint32_t count, const vec3 *points,
                            const vec3 *normals, vec3 *irradiance);

/// How hits are traced and lit; all borrowed.
typedef struct alpi_sphere_relight {
    alp_context *context;
    const alp_scene *scene;
    const alpi_tracer *tracer;
    alpi_trace_filter filter;      // panes are seen to here
    const alpi_lighting *lighting; // lamps, suns, emissive surfaces, sky
    // NULL, or sources that extra rays are aimed at (sphere_aimed.h): then rays that meet emission
    // by chance do not count it. `lighting` then has the soft part of a sky with spots.
    const alpi_lighting *aimed;
    // 0: all light; else 1 + the index of a lamp or sun of `lighting`. With a lamp alone, there is
    // no sky and no emission, `aimed` is NULL, and `bounce` gives the light of that lamp.
    uint32_t only_light;
    alpi_bounce_fn *bounce; // NULL: 0
    const void *bounce_user;
    // Hits of eight neighbouring rays that are near each other, and whose normals are within 25°,
    // share one call of `bounce`. Near is a quarter of the field's cell: `bounce_cell_scale` times
    // the distance of the hit, and at least `bounce_cell_least` metres. Both 0: none is shared.
    float bounce_cell_scale, bounce_cell_least;
    const alpi_occluders *occluders; // NULL: none
    uint64_t seed;
} alpi_sphere_relight;

/// A point, and the light found there.
typedef struct alpi_sphere_hits_point {
    vec3 point;
    uint32_t key;          // of its random numbers: the same key gives the same rays
    uint32_t face;         // pixels along a face: multiple of 4, [4, ALPI_HITS_FACE_MOST]
    alpi_sphere_hit *hits; // NULL, or [6 face²]: kept, packet by packet (alpi_sphere_place_of)
    bool traced;           // hits are those of the same point, key and face: only relight
    bool direct;           // light straight from lamps and suns is added (alpi_sphere_lamps_add)
    float reach;           // metres: larger distances count as this in moments
    // NULL, or [ALPI_SPHERE_MOMENTS] out, as of alpi_sphere_job. Not written if `traced`.
    float (*moments)[2];
    // Out. The variance is estimated from the two halves of a chequerboard of rays.
    alpi_sphere_light value;
} alpi_sphere_hits_point;

static inline uint32_t alpi_sphere_hits_count(uint32_t face)
{
    return 6 * face * face;
}

/// Traces and lights points, or relights them: the same bits either way, and for any number of
/// workers.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_sphere_hits_gather(const alpi_sphere_relight *how, alpi_sphere_hits_point *points,
                                   uint32_t count, const alpi_task_progress *progress);

#endif
