// SPDX-License-Identifier: MIT
// Rays against a scene: nearest hit, and whether anything is hit. embree.h and the files behind it
// alone know Embree; brute_force.c, in tests, tests every triangle.
#ifndef ALPI_TRACE_TRACE_H
#define ALPI_TRACE_TRACE_H

#include "scene/scene.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { ALPI_PACKET = 8, ALPI_TRACE_BATCH = 64 };

/// Eight rays, structure of arrays, laid out as the ray tracer wants them: it is copied only where
/// the nearest hit is asked for, which the tracer writes into its rays.
typedef struct alpi_rays {
    _Alignas(32) float origin_x[ALPI_PACKET];
    float origin_y[ALPI_PACKET], origin_z[ALPI_PACKET];
    float minimum[ALPI_PACKET]; // along the (unit) direction
    float direction_x[ALPI_PACKET], direction_y[ALPI_PACKET], direction_z[ALPI_PACKET];
    float time[ALPI_PACKET]; // the tracer's, 0
    float maximum[ALPI_PACKET];
    uint32_t mask[ALPI_PACKET];                   // all ones
    uint32_t id[ALPI_PACKET], flags[ALPI_PACKET]; // the tracer's
} alpi_rays;

/// Two packets side by side, for a tracer that takes sixteen rays at once: lanes 0 to 7 are those
/// of the first.
typedef struct alpi_ray_pair {
    _Alignas(64) float origin_x[2 * ALPI_PACKET];
    float origin_y[2 * ALPI_PACKET], origin_z[2 * ALPI_PACKET];
    float minimum[2 * ALPI_PACKET];
    float direction_x[2 * ALPI_PACKET], direction_y[2 * ALPI_PACKET], direction_z[2 * ALPI_PACKET];
    float time[2 * ALPI_PACKET];
    float maximum[2 * ALPI_PACKET];
    uint32_t mask[2 * ALPI_PACKET];
    uint32_t id[2 * ALPI_PACKET], flags[2 * ALPI_PACKET];
} alpi_ray_pair;

/// All fields as they are, masks too; each is twice as long there. @param half which of the two
static inline void alpi_ray_pair_set(alpi_ray_pair *pair, size_t half, const alpi_rays *rays)
{
    enum { FIELD = sizeof rays->origin_x, FIELDS = sizeof *rays / FIELD };
    for (size_t k = 0; k < FIELDS; k++) { // memcpy of a size that is known: one or two moves
        memcpy((char *)pair + (2 * k + half) * FIELD, (const char *)rays + k * FIELD, FIELD);
    }
}

/// Rays of no length in no direction, which the tracer may be given. Field by field: compilers make
/// an instruction of a whole struct of zeros that takes as long as the rest of aiming.
static inline void alpi_rays_clear(alpi_rays *rays)
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        rays->origin_x[i] = rays->origin_y[i] = rays->origin_z[i] = rays->minimum[i] = 0.0f;
        rays->direction_x[i] = rays->direction_y[i] = rays->direction_z[i] = 0.0f;
        rays->time[i] = rays->maximum[i] = 0.0f;
        rays->mask[i] = UINT32_MAX;
        rays->id[i] = rays->flags[i] = 0;
    }
}

/// Rays from one place that reach any distance; their directions are the caller's to set.
static inline void alpi_rays_start(alpi_rays *rays, vec3 origin)
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        rays->origin_x[i] = origin.x;
        rays->origin_y[i] = origin.y;
        rays->origin_z[i] = origin.z;
        rays->minimum[i] = rays->time[i] = 0.0f;
        rays->maximum[i] = INFINITY;
        rays->mask[i] = UINT32_MAX;
        rays->id[i] = rays->flags[i] = 0;
    }
}

/// Lane `lane` of a packet that was cleared. @param reach metres, the direction being unit
static inline void alpi_rays_set(alpi_rays *rays, int lane, vec3 origin, vec3 direction,
                                 float reach)
{
    rays->origin_x[lane] = origin.x;
    rays->origin_y[lane] = origin.y;
    rays->origin_z[lane] = origin.z;
    rays->direction_x[lane] = direction.x;
    rays->direction_y[lane] = direction.y;
    rays->direction_z[lane] = direction.z;
    rays->minimum[lane] = 0.0f;
    rays->maximum[lane] = reach;
}

typedef struct alpi_hits {
    _Alignas(32) float distance[ALPI_PACKET]; // INFINITY where nothing was hit
    uint32_t triangle[ALPI_PACKET];           // ALPI_NONE where nothing was hit
    float b1[ALPI_PACKET], b2[ALPI_PACKET];   // barycentric weights of corners 1 and 2
    uint32_t behind; // bit i: lane i met the back of its triangle, by the tracer's rounding. The
                     // back of solids that are wound inwards is the front (scene/sides.h)
} alpi_hits;

typedef struct alpi_tracer alpi_tracer;

/// What a ray may pass through, besides cut surfaces (alpha), which are always open.
typedef struct alpi_trace_filter {
    bool one_sided; // single-sided materials are open from behind
    bool panes; // the caller sees to panes (alpi_surface_is_pane): they do not stop shadow rays,
                // and meet other rays whatever their alpha. Else BLEND is cut at one half and
                // transmission opaque
    bool backs; // a back is met even where a front lies in its place (alpi_trace_place)
    bool quick; // rays of random directions that are only asked whether they are blocked: one that
                // meets the edge between two triangles may slip through. For a job of which
                // alpi_tracer_quicken says so, no other
} alpi_trace_filter;

/// The scene's tracer: built at the first call, kept with the scene. `seconds` (may be NULL) gets
/// the time this call spent building, 0 when it was there already.
alp_result alpi_tracer_for_scene(const alp_scene *scene, alp_progress_fn *progress,
                                 void *progress_user, alpi_tracer **tracer, double *seconds);

/// A tracer over some surfaces of a scene; it belongs to the caller and must be destroyed before
/// the scene. Hits tell triangles of the scene. Memory and time grow with those surfaces and with
/// what lies between the first and the last of them, not with the scene.
/// @param surfaces [surface_count], NULL = all; read by this call only
/// @return ALP_OK; OUT_OF_MEMORY; UNSUPPORTED (the ray tracer fails); CANCELLED
alp_result alpi_tracer_create(const alp_scene *scene, const bool *surfaces,
                              alp_progress_fn *progress, void *progress_user, alpi_tracer **tracer);
/// Readies a tracer for a job of so many rays, where they are worth a second hierarchy: some per
/// cent to a quarter less time. Of random rays less than one in a million slips through an edge (a
/// sphere of 40,000 triangles; counted), of those aimed at edges one in 20.
/// @param quick out: whether the job's rays may be quick (alpi_trace_filter). Depends on their
///              number alone, not on what the tracer was readied for before
/// @return ALP_OK; OUT_OF_MEMORY; UNSUPPORTED; CANCELLED: the tracer is what it was
alp_result alpi_tracer_quicken(alpi_tracer *tracer, double rays, alp_progress_fn *progress,
                               void *progress_user, bool *quick);
void alpi_tracer_destroy(alpi_tracer *tracer); ///< NULL does nothing

/// How many triangles stop its rays.
uint32_t alpi_tracer_triangle_count(const alpi_tracer *tracer);
/// Whether any of them is of a pane.
bool alpi_tracer_has_panes(const alpi_tracer *tracer);

/// How the rays of a packet leave: says nothing about what they meet, only how to find it fastest.
typedef enum alpi_rays_spread {
    ALPI_RAYS_NEAR,     // each packet by itself, ray by ray where they part
    ALPI_RAYS_PAIRED,   // the same, and those that follow each other are near each other too: two
                        // at a time, where the machine has vectors of sixteen
    ALPI_RAYS_SCATTERED // in different directions: one by one, as a stream; up to 1.4 times as
                        // fast
} alpi_rays_spread;

/// How packets of random rays that leave from neighbouring points are traced fastest.
alpi_rays_spread alpi_tracer_random_spread(const alpi_tracer *tracer, alpi_trace_filter filter);

/// Traces lane i of `active` (bit i) of each packet, at most ALPI_TRACE_BATCH; their masks must be
/// all ones. A lane that hits anything gets maximum = −∞, others are left alone. A quick ray
/// through the very edge of two triangles may be told either, by what it is with.
void alpi_trace_occluded(const alpi_tracer *tracer, alpi_rays *packets, uint32_t count,
                         uint32_t active, alpi_trace_filter filter, alpi_rays_spread spread);
/// Whether alpi_trace_occluded_pairs may be called; up to a sixth faster than packets of eight.
bool alpi_tracer_takes_pairs(const alpi_tracer *tracer);
/// The same of packets in pairs, of which all lanes take part. @param count of pairs
void alpi_trace_occluded_pairs(const alpi_tracer *tracer, alpi_ray_pair *pairs, uint32_t count,
                               alpi_trace_filter filter);
/// Surfaces lie in one place for a ray where their distances differ by a few steps of float. There
/// a front is met before a back, whatever the order of triangles.
/// @param normal of the triangle that was met at `distance`, of any length
/// @return m along the ray: 8 ε (|origin|∞ + distance) / cosine, cosine at least 1/64
static inline float alpi_trace_place(vec3 origin, vec3 direction, vec3 normal, float distance)
{
    const float cosine = fabsf(vec3_dot(direction, normal)) / vec3_length(normal);
    const float size = fmaxf(fmaxf(fabsf(origin.x), fabsf(origin.y)), fabsf(origin.z)) + distance;
    return 8.0f * FLT_EPSILON * size / fmaxf(cosine, 1.0f / 64.0f);
}

/// Lanes that are not active keep what `hits` holds.
void alpi_trace_nearest(const alpi_tracer *tracer, const alpi_rays *rays, uint32_t active,
                        alpi_trace_filter filter, alpi_hits *hits);
/// The same, faster where the rays of a packet leave from about one place in about one direction (a
/// camera's), and twice as slow where they do not.
void alpi_trace_nearest_coherent(const alpi_tracer *tracer, const alpi_rays *rays, uint32_t active,
                                 alpi_trace_filter filter, alpi_hits *hits);
/// The same of several packets, two that follow each other together where the machine has vectors
/// of sixteen: up to a fifth faster where they leave from about one place in about one direction
/// too. A ray through the very edge of two triangles may be told either, by what it is paired with.
/// Masks must be all ones, id and flags 0.
/// @param hits [count]
void alpi_trace_nearest_coherent_many(const alpi_tracer *tracer, const alpi_rays *const *packets,
                                      const uint32_t *active, uint32_t count,
                                      alpi_trace_filter filter, alpi_hits *hits);

/// The oracle: the same answers over all triangles in double precision, one ray at a time.
void alpi_brute_force_nearest(const alp_scene *scene, const alpi_rays *rays, uint32_t active,
                              alpi_trace_filter filter, alpi_hits *hits);

#endif
