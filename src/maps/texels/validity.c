// SPDX-License-Identifier: MIT
#include "maps/texels/validity.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/texels/inside.h"
#include "scene/sides.h"

#include <math.h>
#include <string.h>

enum { TEXELS_PER_RANGE = 512, TEXELS_PER_TICK = 1 << 16, STRATA = 16, TOGETHER = 16 };

typedef struct validity_job {
    const alpi_occlusion_setup *setup;
    const alpi_receivers *receivers;
    alpi_texels *texels;
    const alpi_lattice *lattice;
    const uint32_t *order;
    uint32_t order_count;
    alpi_validity *out;
    uint16_t *inside; // [texels] bit i: stratum i is inside other geometry; the scratch's
} validity_job;

/// Reports from a serial loop over the order, once in a while. @return ALP_OK; CANCELLED
static alp_result tick(const validity_job *job, uint32_t i)
{
    return i % TEXELS_PER_TICK == TEXELS_PER_TICK - 1
               ? alpi_tick(job->setup->context, "validity", i, job->order_count)
               : ALP_OK;
}

// --- lifts ---------------------------------------------------------------------------------------

/// Middles of `count` strata.
static void find_middles(const uint8_t *strata, uint32_t count, float (*square)[2])
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t column = strata[i] % 4u, row = strata[i] / 4u;
        square[i][0] = ((float)column + 0.5f) / 4.0f;
        square[i][1] = ((float)row + 0.5f) / 4.0f;
    }
}

/// Aims a lane from one point to another. A lane without length stays clear.
static void aim_between(vec3 from, vec3 to, int lane, alpi_rays *rays)
{
    const vec3 way = vec3_sub(to, from);
    const float length = vec3_length(way);
    if (length > 0.0f) {
        alpi_rays_set(rays, lane, from, vec3_scale(way, 1.0f / length), length);
    }
}

static uint32_t occluded_lanes(const alpi_rays *rays)
{
    uint32_t occluded = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        occluded |= (rays->maximum[i] < 0.0f ? 1u : 0u) << i;
    }
    return occluded;
}

/// @param packets 4 at most   @return bits of the rays that hit, one packet after the other
static uint32_t find_occluded(const validity_job *job, alpi_rays *rays, uint32_t packets)
{
    uint32_t occluded = 0;
    alpi_trace_occluded(job->setup->tracer, rays, packets, 0xffu, (alpi_trace_filter){0},
                        ALPI_RAYS_PAIRED);
    for (uint32_t p = 0; p < packets; p++) {
        occluded |= occluded_lanes(&rays[p]) << ALPI_PACKET * p;
    }
    return occluded;
}

/// Whether a ledge lies above one of eight points: a lifted point would leave its shadow. Smooth
/// neighbours, at most 60° apart, belong to the lifted surface. @param reach metres
static bool finds_ledge(const validity_job *job, const alpi_receiver_point *points,
                        const vec3 low[ALPI_PACKET], float reach)
{
    static const float RISE = 0.25f; // slope of the rays against the triangle
    const alp_scene *scene = job->texels->atlas->scene;
    alpi_rays rays;
    alpi_hits hits;
    alpi_rays_clear(&rays);
    for (int i = 0; i < ALPI_PACKET; i++) {
        const vec3 n = points[i].geometric_normal;
        const float angle = 2.0f * (float)ALPI_PI * (float)i / ALPI_PACKET;
        vec3 t, b;
        vec3_frame(n, &t, &b);
        const vec3 along = vec3_add(vec3_scale(t, cosf(angle)), vec3_scale(b, sinf(angle)));
        alpi_rays_set(&rays, i, vec3_mad(low[i], points[i].offset, n),
                      vec3_normalize_or(vec3_mad(along, RISE, n), n), reach);
    }
    alpi_trace_nearest(job->setup->tracer, &rays, 0xffu, (alpi_trace_filter){0}, &hits);
    bool found = false;
    for (int i = 0; i < ALPI_PACKET; i++) {
        if (hits.triangle[i] != ALPI_NONE) {
            const vec3 normal = alpi_sides_normal(scene, hits.triangle[i]);
            found = found || vec3_dot(normal, points[i].geometric_normal) < 0.5f;
        }
    }
    return found;
}

/// Leaves the points of a texel on their triangles if the lift of any of eight passes through a
/// surface, or leaves the shadow of a ledge.
static void keep_low_if_blocked(const validity_job *job, uint32_t texel)
{
    static const uint8_t chosen[ALPI_PACKET] = {0, 2, 5, 7, 8, 10, 13, 15}; // every other cell
    static const float LEDGE_REACH = 16.0f;                                 // lifts
    alpi_receiver_point lifted[ALPI_PACKET];
    vec3 low[ALPI_PACKET];
    float square[ALPI_PACKET][2];
    alpi_rays rays;
    float most = 0.0f; // metres
    bool any = false;
    alpi_rays_clear(&rays);
    find_middles(chosen, ALPI_PACKET, square);
    alpi_texels_lifts(job->texels, texel, ALPI_PACKET, (const float(*)[2])square, lifted, low);
    for (int i = 0; i < ALPI_PACKET; i++) {
        const alpi_receiver_point *point = &lifted[i];
        const vec3 from = vec3_mad(low[i], point->offset, point->geometric_normal);
        const vec3 to = vec3_add(from, vec3_sub(point->position, low[i]));
        const float lift = vec3_length(vec3_sub(to, from));
        most = fmaxf(most, lift);
        if (lift > point->offset) { // else it hits its own surface
            aim_between(from, to, i, &rays);
            any = true;
        }
    }
    if (any &&
        (find_occluded(job, &rays, 1) != 0 || finds_ledge(job, lifted, low, LEDGE_REACH * most))) {
        job->texels->flags[texel] |= ALPI_TEXEL_NO_LIFT;
    }
}

// --- texels inside solids ------------------------------------------------------------------------

/// Which strata of a texel lie inside other geometry. Strata that the middle sees are outside if it
/// is; the others are tested.
static uint16_t find_inside(const validity_job *job, uint32_t texel,
                            const alpi_receiver_point *middle, bool middle_inside)
{
    static const uint8_t all[STRATA] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    alpi_receiver_point points[STRATA];
    alpi_rays rays[STRATA / ALPI_PACKET];
    float sides[STRATA], square[STRATA][2];
    const float side = alpi_texels_side(job->texels, texel);
    const vec3 above = alpi_ring_origin(middle, side);
    find_middles(all, STRATA, square);
    job->receivers->place(job->receivers->user, texel, STRATA, (const float(*)[2])square, points);
    for (int i = 0; i < STRATA; i++) {
        alpi_rays *packet = &rays[i / ALPI_PACKET];
        sides[i] = side;
        if (i % ALPI_PACKET == 0) {
            alpi_rays_clear(packet);
        }
        aim_between(above, alpi_ring_origin(&points[i], side), i % ALPI_PACKET, packet);
    }
    const uint32_t tested =
        middle_inside ? (1u << STRATA) - 1u : find_occluded(job, rays, STRATA / ALPI_PACKET);
    return (uint16_t)alpi_are_inside(job->setup->tracer, job->texels->atlas->scene, points, sides,
                                     tested);
}

/// Neighbours whose rays are traced together.
typedef struct group {
    uint32_t count;
    uint32_t texels[TOGETHER];
    alpi_receiver_point middles[TOGETHER];
    float sides[TOGETHER];
} group;

/// Bits of the texels with a surface within 1.6 texels of their middle, in eight directions. Others
/// are completely outside, or so far inside that no filter mixes them with a seen texel: it reads
/// one texel away, and the directions miss the nearest point by up to 22°.
static uint32_t find_crossed(const validity_job *job, const group *all)
{
    alpi_rays rays[TOGETHER];
    uint32_t crossed = 0;
    for (uint32_t k = 0; k < all->count; k++) {
        const float reach = 1.6f * all->sides[k];
        alpi_rays_clear(&rays[k]);
        alpi_ring_aim(&all->middles[k], reach, ALPI_RING_AXES, reach, 0, &rays[k]);
        alpi_ring_aim(&all->middles[k], reach, ALPI_RING_DIAGONALS, reach, 4, &rays[k]);
    }
    alpi_trace_occluded(job->setup->tracer, rays, all->count, 0xffu, (alpi_trace_filter){0},
                        ALPI_RAYS_PAIRED);
    for (uint32_t k = 0; k < all->count; k++) {
        crossed |= (occluded_lanes(&rays[k]) != 0 ? 1u : 0u) << k;
    }
    return crossed;
}

/// Finds the strata inside solids of crossed texels. A texel that touches a surface, with nothing
/// beside it, may be far inside: it touches the solid around it.
static void find_group(const validity_job *job, const group *all)
{
    const uint32_t crossed = find_crossed(job, all);
    uint32_t tested = crossed;
    for (uint32_t k = 0; k < all->count; k++) {
        tested |= (job->out->proximity[all->texels[k]] == ALPI_TOUCHING ? 1u : 0u) << k;
    }
    const uint32_t inside = alpi_are_inside(job->setup->tracer, job->texels->atlas->scene,
                                            all->middles, all->sides, tested);
    for (uint32_t k = 0; k < all->count; k++) {
        const uint32_t texel = all->texels[k];
        const bool middle_inside = (inside >> k & 1u) != 0;
        if ((crossed >> k & 1u) != 0) {
            job->inside[texel] = find_inside(job, texel, &all->middles[k], middle_inside);
        } else if (middle_inside) {
            job->texels->flags[texel] |= ALPI_TEXEL_HIDDEN;
        }
    }
}

static alp_result lower_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const validity_job *job = user;
    const alpi_texels *texels = job->texels;
    uint32_t last = ALPI_NONE; // most texels lie in the triangle of the one before
    bool lifted = false;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        texels->flags[t] = 0;
        if (texels->valid != NULL) {
            texels->valid[t] = 0; // of an earlier call; points would be placed by it
        }
        const bool whole = texels->piece_first[t] == texels->piece_first[t + 1];
        if (!whole || texels->triangles[t] != last) {
            lifted = alpi_texels_are_lifted(texels, t);
            last = whole ? texels->triangles[t] : ALPI_NONE;
        }
        if (lifted) {
            keep_low_if_blocked(job, t);
        }
    }
    return ALP_OK;
}

static alp_result find_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const validity_job *job = user;
    group all = {.count = 0};
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        if (job->out->proximity[t] != ALPI_FAR) {
            alpi_texels_point(job->texels, t, &all.middles[all.count]);
            all.sides[all.count] = alpi_texels_side(job->texels, t);
            all.texels[all.count++] = t;
        }
        if (all.count == TOGETHER || (i + 1 == end && all.count > 0)) {
            find_group(job, &all);
            all.count = 0;
        }
    }
    return ALP_OK;
}

/// Whether a texel of its chart that is not completely inside is beside it.
static bool is_beside_seen(const validity_job *job, uint32_t texel)
{
    const alpi_texels *t = job->texels;
    uint32_t around[ALPI_AROUND_LIMIT];
    const uint32_t count = alpi_lattice_around(job->lattice, texel, around);
    bool found = false;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t n = around[i];
        found = found || (t->charts[n] == t->charts[texel] && job->inside[n] != UINT16_MAX);
    }
    return found;
}

/// Texels partly inside keep their other strata. Those completely inside are dropped at the rim,
/// and hidden farther in.
static alp_result store(validity_job *job)
{
    alpi_texels *texels = job->texels;
    for (uint32_t i = 0; i < job->order_count; i++) {
        const uint32_t t = job->order[i];
        ALP_TRY(tick(job, i));
        job->out->dropped[t] = 0;
        if (job->inside[t] == UINT16_MAX) {
            job->out->dropped[t] = is_beside_seen(job, t);
            job->out->dropped_count += job->out->dropped[t];
            texels->flags[t] |= job->out->dropped[t] ? 0 : ALPI_TEXEL_HIDDEN;
        } else if (job->inside[t] != 0) {
            if (texels->valid == NULL) {
                ALPI_TRY_NEW(job->setup->context, texels->valid, texels->count);
            }
            texels->valid[t] = (uint16_t)~job->inside[t];
            job->out->moved_count++;
        }
        job->out->lowered_count += (texels->flags[t] & ALPI_TEXEL_NO_LIFT) != 0;
    }
    return ALP_OK;
}

// --- all texels ----------------------------------------------------------------------------------

static alp_result find_proximity(validity_job *job, const alpi_task_progress *progress)
{
    alpi_proximity_job near = {.setup = job->setup,
                               .receivers = job->receivers,
                               .lattice = job->lattice,
                               .order = job->order,
                               .count = job->order_count,
                               .scratch = job->out->scratch,
                               .proximity = job->out->proximity};
    const alp_result result = alpi_find_proximity(&near, progress);
    job->out->rays += near.rays;
    return result;
}

static alp_result run(validity_job *job, const alpi_task_progress *progress)
{
    alp_context *context = job->setup->context;
    alpi_task_progress p = progress != NULL ? *progress : (alpi_task_progress){0};
    ALP_TRY(alpi_parallel_for(context, job->order_count, TEXELS_PER_RANGE, lower_range, job, &p));
    ALP_TRY(find_proximity(job, &p));
    ALP_TRY(alpi_parallel_for(context, job->order_count, TEXELS_PER_RANGE, find_range, job, &p));
    ALP_TRY(store(job));
    return alpi_scratch_clear(job->out->scratch, job->order, job->order_count, &p);
}

alp_result alpi_validity_open(alp_context *context, uint32_t texels, alpi_scratch *scratch,
                              alpi_validity *validity)
{
    *validity = (alpi_validity){.context = context, .scratch = scratch};
    validity->proximity = ALPI_NEW(context, uint8_t, texels);
    validity->dropped = ALPI_NEW(context, uint8_t, texels);
    if (validity->proximity == NULL || validity->dropped == NULL) {
        alpi_validity_destroy(validity);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    return ALP_OK;
}

alp_result alpi_validity_find(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              alpi_texels *texels, const alpi_lattice *lattice,
                              const uint32_t *order, uint32_t order_count,
                              const alpi_task_progress *progress, alpi_validity *validity)
{
    validity->rays = validity->moved_count = 0;
    validity->dropped_count = validity->lowered_count = 0;
    validity_job job = {.setup = setup,
                        .receivers = receivers,
                        .texels = texels,
                        .lattice = lattice,
                        .order = order,
                        .order_count = order_count,
                        .inside = validity->scratch->inside,
                        .out = validity};
    return run(&job, progress);
}

alp_result alpi_validity_create(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                                alpi_texels *texels, const alpi_lattice *lattice,
                                const uint32_t *order, uint32_t order_count,
                                const alpi_task_progress *progress, alpi_validity *validity)
{
    alpi_scratch scratch;
    *validity = (alpi_validity){0};
    ALP_TRY(alpi_scratch_create(setup->context, texels->count, false, &scratch));
    alp_result result = alpi_validity_open(setup->context, texels->count, &scratch, validity);
    if (result == ALP_OK) {
        result = alpi_validity_find(setup, receivers, texels, lattice, order, order_count, progress,
                                    validity);
    }
    alpi_scratch_destroy(&scratch);
    validity->scratch = NULL;
    if (result != ALP_OK) {
        alpi_validity_destroy(validity);
    }
    return result;
}

void alpi_validity_destroy(alpi_validity *validity)
{
    if (validity->context != NULL) {
        alpi_release(validity->context, validity->proximity);
        alpi_release(validity->context, validity->dropped);
    }
    *validity = (alpi_validity){0};
}
