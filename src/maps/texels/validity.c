// SPDX-License-Identifier: MIT
#include "maps/texels/validity.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/texels/inside.h"
#include "scene/sides.h"

#include <math.h>
#include <string.h>

enum {
    TEXELS_PER_RANGE = 512,
    TEXELS_PER_TICK = 1 << 16,
    STRATA = 16,
    NEAR_SAMPLES = 16,
    TOGETHER = 16,
    OCTAVE_LIMIT = 64
};

// Surfaces closer than this, in texels, cast shadows that a lattice of 4 may miss.
static const double NEAR_DISTANCE = 2.5;
// Share of the short rays that hit if a surface is within a texel.
static const float TOUCHING = 0.22f;
static const uint64_t NEAR_SEED = 0x6e656172;

typedef struct validity_job {
    const alpi_occlusion_setup *setup;
    const alpi_receivers *receivers;
    alpi_texels *texels;
    const alpi_lattice *lattice;
    const uint32_t *order;
    uint32_t order_count;
    alpi_validity *out;
    uint8_t *measured; // [texels] 1 + alpi_proximity if coarse, else 0; the scratch's marks
    uint16_t *inside;  // [texels] bit i: stratum i is inside other geometry; the scratch's
} validity_job;

// --- proximity -----------------------------------------------------------------------------------

static bool is_coarse(const alpi_texels *t, uint32_t texel)
{
    return alpi_lattice_is_coarse(t->pixels[texel]);
}

/// The octave of a texel's side. Rays from texels of one octave are equally long.
static int find_octave(const alpi_texels *t, uint32_t texel)
{
    const int octave = ilogbf(alpi_texels_side(t, texel));
    return octave < -OCTAVE_LIMIT ? -OCTAVE_LIMIT : octave > OCTAVE_LIMIT ? OCTAVE_LIMIT : octave;
}

/// Reports from a serial loop over the order, once in a while. @return ALP_OK; CANCELLED
static alp_result tick(const validity_job *job, uint32_t i)
{
    return i % TEXELS_PER_TICK == TEXELS_PER_TICK - 1
               ? alpi_tick(job->setup->context, "validity", i, job->order_count)
               : ALP_OK;
}

/// Lists the coarse texels of an octave.
static alp_result list_octave(const validity_job *job, int octave, uint32_t *list, uint32_t *count)
{
    *count = 0;
    for (uint32_t i = 0; i < job->order_count; i++) {
        const uint32_t t = job->order[i];
        if (is_coarse(job->texels, t) && find_octave(job->texels, t) == octave) {
            list[(*count)++] = t;
        }
        ALP_TRY(tick(job, i));
    }
    return ALP_OK;
}

/// Occlusion over a short distance, in mean sides of the listed texels. It takes no options of the
/// bake: the limit to which a map converges must depend neither on the seed nor on other maps.
static alp_result make_short_setup(const validity_job *job, const uint32_t *list, uint32_t count,
                                   alpi_occlusion_setup *setup)
{
    alp_occlusion_options o = alp_occlusion_options_default();
    double area = 0.0, coverage = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        area += (double)job->texels->areas[list[i]];
        coverage += (double)job->texels->coverages[list[i]];
    }
    o.distance = (float)(NEAR_DISTANCE * sqrt(area / fmax(coverage, 1e-30)));
    o.falloff = ALP_FALLOFF_NONE;
    o.samples = NEAR_SAMPLES;
    o.seed = NEAR_SEED;
    return alpi_occlusion_prepare(job->setup->scene, job->setup->tracer, &o, setup);
}

/// A texel is as near as the nearest of the coarse texels around it in its chart; without any it
/// touches.
static alp_result spread_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const validity_job *job = user;
    const alpi_texels *t = job->texels;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t texel = job->order[i];
        const uint32_t p[2] = {t->pixels[texel][0], t->pixels[texel][1]};
        uint8_t nearest = 0;
        for (uint32_t y = p[1] & ~1u; y <= p[1] + 1u; y += 2) {
            for (uint32_t x = p[0] & ~1u; x <= p[0] + 1u; x += 2) {
                const uint32_t n = alpi_lattice_texel(job->lattice, t->pages[texel], x, y);
                if (n != ALPI_NONE && t->charts[n] == t->charts[texel] &&
                    job->measured[n] > nearest) {
                    nearest = job->measured[n];
                }
            }
        }
        job->out->proximity[texel] = nearest > 0 ? nearest - 1 : ALPI_TOUCHING;
    }
    return ALP_OK;
}

/// Measures the proximity of listed texels, by short rays.
static alp_result measure_listed(validity_job *job, const uint32_t *list, uint32_t count,
                                 const alpi_task_progress *progress, alpi_occlusion_sums *sums)
{
    alpi_occlusion_setup setup;
    ALP_TRY(make_short_setup(job, list, count, &setup));
    alp_result result = alpi_occlusion_add(&setup, job->receivers, list, count, 0, NEAR_SAMPLES,
                                           NEAR_SAMPLES, progress, sums);
    for (uint32_t i = 0; i < count; i++) {
        const float closed = 1.0f - alpi_occlusion_value(sums, list[i]);
        job->measured[list[i]] = closed > TOUCHING ? 3 : closed > 0.0f ? 2 : 1;
    }
    job->out->rays += (uint64_t)count * NEAR_SAMPLES;
    alpi_occlusion_release(&setup);
    return result;
}

/// Measures the coarse texels, a quarter of all, then spreads their proximity.
static alp_result find_proximity(validity_job *job, const alpi_task_progress *progress)
{
    alp_context *context = job->setup->context;
    alpi_occlusion_sums *sums = &job->out->scratch->sums;
    bool octaves[2 * OCTAVE_LIMIT + 1] = {false};
    for (uint32_t i = 0; i < job->order_count; i++) {
        const uint32_t t = job->order[i];
        if (is_coarse(job->texels, t)) {
            octaves[OCTAVE_LIMIT + find_octave(job->texels, t)] = true;
        }
        ALP_TRY(tick(job, i));
    }
    uint32_t *list = ALPI_NEW(context, uint32_t, job->order_count);
    alp_result result = list != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    for (int k = -OCTAVE_LIMIT; k <= OCTAVE_LIMIT && result == ALP_OK; k++) {
        uint32_t count = 0;
        result = octaves[OCTAVE_LIMIT + k] ? list_octave(job, k, list, &count) : ALP_OK;
        result = result == ALP_OK && count > 0 ? measure_listed(job, list, count, progress, sums)
                                               : result;
    }
    alpi_release(context, list);
    ALP_TRY(result);
    return alpi_parallel_for(context, job->order_count, TEXELS_PER_RANGE, spread_range, job,
                             progress);
}

// --- texels --------------------------------------------------------------------------------------

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
                        .measured = validity->scratch->marks,
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
