// SPDX-License-Identifier: MIT
// Packets of rays through Embree 3.
#include "trace/embree.h"

#include "scene/sides.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

static alpi_trace_context start_context(const alpi_tracer *tracer, alpi_trace_filter filter)
{
    alpi_trace_context context = {.tracer = tracer, .panes = filter.panes, .backs = filter.backs};
    rtcInitIntersectContext(&context.embree);
    context.embree.filter = filter.one_sided ? alpi_embree_one_sided_filter : NULL;
    return context;
}

_Static_assert(sizeof(alpi_rays) == sizeof(struct RTCRay8) &&
                   offsetof(alpi_rays, direction_x) == offsetof(struct RTCRay8, dir_x) &&
                   offsetof(alpi_rays, maximum) == offsetof(struct RTCRay8, tfar) &&
                   offsetof(alpi_rays, flags) == offsetof(struct RTCRay8, flags),
               "alpi_rays is what Embree takes");
_Static_assert(sizeof(alpi_ray_pair) == sizeof(struct RTCRay16) &&
                   offsetof(alpi_ray_pair, direction_x) == offsetof(struct RTCRay16, dir_x) &&
                   offsetof(alpi_ray_pair, maximum) == offsetof(struct RTCRay16, tfar) &&
                   offsetof(alpi_ray_pair, flags) == offsetof(struct RTCRay16, flags),
               "alpi_ray_pair is what it takes of sixteen");
_Static_assert(sizeof(alpi_ray_pair) == 2 * sizeof(alpi_rays), "field by field twice as long");

enum { ALL_LANES = (1 << ALPI_PACKET) - 1 };

/// Of a packet, or of two.
static const _Alignas(64) int ALL_VALID[2 * ALPI_PACKET] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                            -1, -1, -1, -1, -1, -1, -1, -1};

/// Which lanes take part, as Embree wants it.
static const int *spread_bits(uint32_t active, int valid[ALPI_PACKET])
{
    if (active == ALL_LANES) {
        return ALL_VALID;
    }
    for (int i = 0; i < ALPI_PACKET; i++) {
        valid[i] = (active >> i & 1u) != 0 ? -1 : 0;
    }
    return valid;
}

// --- blocked or not ------------------------------------------------------------------------------

static RTCScene shadow_scene(const alpi_tracer *tracer, alpi_trace_filter filter)
{
    assert(!filter.quick || tracer->quick_scene != NULL);
    return filter.quick ? tracer->quick_scene : tracer->embree_scene;
}

bool alpi_tracer_takes_pairs(const alpi_tracer *tracer)
{
    return tracer->wide;
}

alpi_rays_spread alpi_tracer_random_spread(const alpi_tracer *tracer, alpi_trace_filter filter)
{
    // From about here rays that start in one packet part ways below the first levels of the
    // hierarchy, and streams overtake packets, a little later where these go in pairs through the
    // quick one: `alpenglow bench transport`.
    enum { STREAM_TRIANGLES = 40000, QUICK_STREAM_TRIANGLES = 60000 };
    const bool later = filter.quick && tracer->wide;
    const uint32_t least = later ? QUICK_STREAM_TRIANGLES : STREAM_TRIANGLES;
    return alpi_tracer_triangle_count(tracer) >= least ? ALPI_RAYS_SCATTERED : ALPI_RAYS_NEAR;
}

void alpi_trace_occluded_pairs(const alpi_tracer *tracer, alpi_ray_pair *pairs, uint32_t count,
                               alpi_trace_filter filter)
{
    assert(tracer->wide);
    alpi_trace_context context = start_context(tracer, filter);
    RTCScene scene = shadow_scene(tracer, filter);
    for (uint32_t i = 0; i < count; i++) {
        rtcOccluded16(ALL_VALID, scene, &context.embree, (struct RTCRay16 *)&pairs[i]);
    }
}

enum { PAIRS_TOGETHER = 4 };

/// Packets two at a time. Some are laid out before the first is traced: vectors of sixteen that are
/// read just after their halves were written wait for the memory.
static void trace_shadow_pairs(const alpi_tracer *tracer, alpi_rays *packets, uint32_t count,
                               alpi_trace_filter filter)
{
    alpi_ray_pair pairs[PAIRS_TOGETHER];
    for (uint32_t first = 0; first < count; first += PAIRS_TOGETHER) {
        const uint32_t some = count - first < PAIRS_TOGETHER ? count - first : PAIRS_TOGETHER;
        alpi_rays *rays = packets + 2 * (size_t)first;
        for (uint32_t i = 0; i < 2 * some; i++) {
            alpi_ray_pair_set(&pairs[i / 2], i % 2, &rays[i]);
        }
        alpi_trace_occluded_pairs(tracer, pairs, some, filter);
        for (uint32_t i = 0; i < 2 * some; i++) {
            memcpy(rays[i].maximum, pairs[i / 2].maximum + i % 2 * ALPI_PACKET,
                   sizeof rays->maximum);
        }
    }
}

void alpi_trace_occluded(const alpi_tracer *tracer, alpi_rays *packets, uint32_t count,
                         uint32_t active, alpi_trace_filter filter, alpi_rays_spread spread)
{
    _Alignas(32) int some[ALPI_PACKET];
    const int *valid = spread_bits(active, some);
    alpi_trace_context context = start_context(tracer, filter);
    RTCScene scene = shadow_scene(tracer, filter);
    if (valid == ALL_VALID && spread == ALPI_RAYS_SCATTERED) {
        rtcOccludedNM(scene, &context.embree, (struct RTCRayN *)packets, ALPI_PACKET, count,
                      sizeof *packets);
        return;
    }
    uint32_t paired = 0;
    if (valid == ALL_VALID && spread == ALPI_RAYS_PAIRED && tracer->wide) {
        trace_shadow_pairs(tracer, packets, count / 2, filter);
        paired = count / 2 * 2;
    }
    for (uint32_t i = paired; i < count; i++) {
        rtcOccluded8(valid, scene, &context.embree, (struct RTCRay8 *)&packets[i]);
    }
}

// --- what is hit ---------------------------------------------------------------------------------

static const _Alignas(32) uint32_t LANE_BITS[ALPI_PACKET] = {1, 2, 4, 8, 16, 32, 64, 128};

/// Eight lanes of what a packet of 8 or 16 met.
typedef struct found_lanes {
    const float *direction[3], *normal[3], *far, *u, *v;
    const unsigned *geometry, *primitive;
} found_lanes;

/// @param found pointer to a packet and its hits   @param at the first lane
#define FOUND_LANES(found, at)                                                                     \
    ((found_lanes){                                                                                \
        {(found)->ray.dir_x + (at), (found)->ray.dir_y + (at), (found)->ray.dir_z + (at)},         \
        {(found)->hit.Ng_x + (at), (found)->hit.Ng_y + (at), (found)->hit.Ng_z + (at)},            \
        (found)->ray.tfar + (at),                                                                  \
        (found)->hit.u + (at),                                                                     \
        (found)->hit.v + (at),                                                                     \
        (found)->hit.geomID + (at),                                                                \
        (found)->hit.primID + (at)})

/// Lanes whose ray goes along Embree's normal, (v1−v0)×(v2−v0).
static inline uint32_t find_behind(const found_lanes *found)
{
    const float *dx = found->direction[0], *dy = found->direction[1], *dz = found->direction[2];
    const float *nx = found->normal[0], *ny = found->normal[1], *nz = found->normal[2];
    float along[ALPI_PACKET]; // written first: else compilers do lane by lane
    uint32_t behind = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        along[i] = dx[i] * nx[i] + dy[i] * ny[i] + dz[i] * nz[i];
    }
    for (int i = 0; i < ALPI_PACKET; i++) {
        behind |= along[i] > 0.0f ? LANE_BITS[i] : 0u;
    }
    return behind;
}

/// Hits of the lanes that take part.
static void take_some(const alpi_tracer *tracer, const found_lanes *found, uint32_t active,
                      alpi_hits *hits)
{
    uint32_t hit_lanes = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        const uint32_t geometry = found->geometry[i];
        if ((active >> i & 1u) == 0) {
            continue;
        }
        const bool hit = geometry != RTC_INVALID_GEOMETRY_ID;
        hits->distance[i] = hit ? found->far[i] : INFINITY;
        hits->b1[i] = hit ? found->u[i] : 0.0f;
        hits->b2[i] = hit ? found->v[i] : 0.0f;
        hits->triangle[i] =
            hit ? alpi_embree_triangle(tracer, geometry, found->primitive[i]) : ALPI_NONE;
        hit_lanes |= hit ? 1u << i : 0u;
    }
    hits->behind = (hits->behind & ~active) | (find_behind(found) & hit_lanes);
}

/// The same of all lanes, where triangle i is that of primitive i, but for `first`: without a
/// branch. Not within the loop over packets: there gcc takes the lanes apart before it sees that
/// they are a vector.
__attribute__((noinline)) static void take_all(uint32_t first, const found_lanes *found,
                                               alpi_hits *restrict hits)
{
    const unsigned *geometry = found->geometry, *primitive = found->primitive;
    uint32_t hit[ALPI_PACKET], hit_lanes = 0;
    float far[ALPI_PACKET], u[ALPI_PACKET], v[ALPI_PACKET]; // copies, which may be read unasked
    memcpy(far, found->far, sizeof far);
    memcpy(u, found->u, sizeof u);
    memcpy(v, found->v, sizeof v);
    for (int i = 0; i < ALPI_PACKET; i++) {
        hit[i] = geometry[i] != RTC_INVALID_GEOMETRY_ID ? UINT32_MAX : 0;
    }
    for (int i = 0; i < ALPI_PACKET; i++) {
        hit_lanes |= hit[i] & LANE_BITS[i];
        hits->triangle[i] = (first + primitive[i]) | ~hit[i]; // ALPI_NONE is all ones
    }
    for (int i = 0; i < ALPI_PACKET; i++) {
        hits->distance[i] = hit[i] != 0 ? far[i] : INFINITY;
        hits->b1[i] = hit[i] != 0 ? u[i] : 0.0f;
        hits->b2[i] = hit[i] != 0 ? v[i] : 0.0f;
    }
    hits->behind = find_behind(found) & hit_lanes;
}

/// Exchanges front and back of hits on solids that are wound inwards.
static void turn_over(const alpi_tracer *tracer, uint32_t active, alpi_hits *hits)
{
    for (; active != 0; active &= active - 1) {
        const int i = __builtin_ctz(active);
        if (hits->triangle[i] != ALPI_NONE &&
            alpi_sides_is_turned(tracer->scene, hits->triangle[i])) {
            hits->behind ^= 1u << i;
        }
    }
}

/// Whether all its triangles are solid, and one after the other in the scene too.
static bool is_in_row(const alpi_tracer *tracer)
{
    const uint32_t count = tracer->in_row[ALPI_GEOMETRY_SOLID];
    return count > 0 && count == alpi_tracer_triangle_count(tracer);
}

/// Field by field: see alpi_rays_clear.
static void copy_rays(const alpi_rays *rays, struct RTCRay8 *to)
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        to->org_x[i] = rays->origin_x[i];
        to->org_y[i] = rays->origin_y[i];
        to->org_z[i] = rays->origin_z[i];
        to->tnear[i] = rays->minimum[i];
        to->dir_x[i] = rays->direction_x[i];
        to->dir_y[i] = rays->direction_y[i];
        to->dir_z[i] = rays->direction_z[i];
        to->time[i] = rays->time[i];
        to->tfar[i] = rays->maximum[i];
        to->mask[i] = UINT32_MAX; // this build of Embree has ray masks on
        to->id[i] = to->flags[i] = 0;
    }
}

/// Traces the active lanes of `found`, whose rays are set.
static void intersect(const alpi_tracer *tracer, const int *valid, alpi_trace_context *context,
                      struct RTCRayHit8 *found)
{
    memset(found->hit.geomID, 0xff, sizeof found->hit.geomID); // RTC_INVALID_GEOMETRY_ID
    memset(found->hit.instID, 0xff, sizeof found->hit.instID);
    rtcIntersect8(valid, tracer->embree_scene, &context->embree, found);
}

/// Replaces hits of backs by fronts that lie in the same place (alpi_trace_place): which of the two
/// a ray meets first is a matter of rounding and of the order of triangles.
/// @param lanes where and how the hits were met
static void prefer_fronts(const alpi_tracer *tracer, const alpi_rays *rays,
                          const found_lanes *lanes, uint32_t active, alpi_trace_context *context,
                          alpi_hits *hits)
{
    const uint32_t behind = context->backs ? 0 : hits->behind & active;
    if (behind == 0) {
        return;
    }
    struct RTCRayHit8 found;
    _Alignas(32) int some[ALPI_PACKET];
    uint32_t fronts = 0;
    copy_rays(rays, &found.ray);
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((behind >> i & 1u) != 0) {
            const vec3 origin = {rays->origin_x[i], rays->origin_y[i], rays->origin_z[i]};
            const vec3 way = {lanes->direction[0][i], lanes->direction[1][i],
                              lanes->direction[2][i]};
            const vec3 normal = {lanes->normal[0][i], lanes->normal[1][i], lanes->normal[2][i]};
            const float near = alpi_trace_place(origin, way, normal, hits->distance[i]);
            found.ray.tnear[i] = fmaxf(hits->distance[i] - near, rays->minimum[i]);
            found.ray.tfar[i] = fminf(hits->distance[i] + near, rays->maximum[i]);
        }
    }
    alpi_trace_context own = *context;
    own.embree.filter = alpi_embree_front_filter;
    intersect(tracer, spread_bits(behind, some), &own, &found);
    for (int i = 0; i < ALPI_PACKET; i++) {
        const bool front = found.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        fronts |= front ? behind & LANE_BITS[i] : 0u;
    }
    const found_lanes instead = FOUND_LANES(&found, 0);
    take_some(tracer, &instead, fronts, hits);
    hits->behind &= ~fronts;
}

static void take(const alpi_tracer *tracer, const alpi_rays *rays, const found_lanes *lanes,
                 uint32_t active, alpi_trace_context *context, alpi_hits *hits)
{
    if (active == ALL_LANES && is_in_row(tracer)) {
        take_all(tracer->triangles[ALPI_GEOMETRY_SOLID][0], lanes, hits);
    } else {
        take_some(tracer, lanes, active, hits);
    }
    if (tracer->scene->sides != NULL) {
        turn_over(tracer, active, hits);
    }
    prefer_fronts(tracer, rays, lanes, active, context, hits);
}

static void trace_nearest(const alpi_tracer *tracer, const alpi_rays *rays, uint32_t active,
                          alpi_trace_context *context, alpi_hits *hits)
{
    struct RTCRayHit8 found;
    _Alignas(32) int some[ALPI_PACKET];
    copy_rays(rays, &found.ray);
    intersect(tracer, spread_bits(active, some), context, &found);
    const found_lanes lanes = FOUND_LANES(&found, 0);
    take(tracer, rays, &lanes, active, context, hits);
}

/// Packets of which all lanes take part, two at a time, laid out as trace_shadow_pairs does.
static void trace_pairs(const alpi_tracer *tracer, const alpi_rays *const *packets, uint32_t pairs,
                        alpi_trace_context *context, alpi_hits *hits)
{
    struct RTCRayHit16 found[PAIRS_TOGETHER];
    for (uint32_t p = 0; p < pairs; p++) {
        alpi_ray_pair_set((alpi_ray_pair *)&found[p].ray, 0, packets[2 * p]);
        alpi_ray_pair_set((alpi_ray_pair *)&found[p].ray, 1, packets[2 * p + 1]);
        memset(found[p].hit.geomID, 0xff, sizeof found[p].hit.geomID);
        memset(found[p].hit.instID, 0xff, sizeof found[p].hit.instID);
    }
    for (uint32_t p = 0; p < pairs; p++) {
        rtcIntersect16(ALL_VALID, tracer->embree_scene, &context->embree, &found[p]);
    }
    for (uint32_t i = 0; i < 2 * pairs; i++) {
        const found_lanes lanes = FOUND_LANES(&found[i / 2], i % 2 * ALPI_PACKET);
        take(tracer, packets[i], &lanes, ALL_LANES, context, &hits[i]);
    }
}

void alpi_trace_nearest(const alpi_tracer *tracer, const alpi_rays *rays, uint32_t active,
                        alpi_trace_filter filter, alpi_hits *hits)
{
    alpi_trace_context context = start_context(tracer, filter);
    trace_nearest(tracer, rays, active, &context, hits);
}

void alpi_trace_nearest_coherent(const alpi_tracer *tracer, const alpi_rays *rays, uint32_t active,
                                 alpi_trace_filter filter, alpi_hits *hits)
{
    alpi_trace_context context = start_context(tracer, filter);
    context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    trace_nearest(tracer, rays, active, &context, hits);
}

void alpi_trace_nearest_coherent_many(const alpi_tracer *tracer, const alpi_rays *const *packets,
                                      const uint32_t *active, uint32_t count,
                                      alpi_trace_filter filter, alpi_hits *hits)
{
    alpi_trace_context context = start_context(tracer, filter);
    context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (uint32_t p = 0; p < count;) {
        uint32_t pairs = 0;
        while (tracer->wide && pairs < PAIRS_TOGETHER && p + 2 * pairs + 1 < count &&
               (active[p + 2 * pairs] & active[p + 2 * pairs + 1]) == ALL_LANES) {
            pairs++;
        }
        if (pairs > 0) {
            trace_pairs(tracer, packets + p, pairs, &context, hits + p);
            p += 2 * pairs;
        } else {
            trace_nearest(tracer, packets[p], active[p], &context, &hits[p]);
            p++;
        }
    }
}
