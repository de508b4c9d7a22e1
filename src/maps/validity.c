// SPDX-License-Identifier: MIT
#include "maps/validity.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/inside.h"

#include <math.h>
#include <string.h>

enum {
    TEXELS_PER_RANGE = 512,
    TEXELS_PER_TICK = 1 << 16,
    STRATA = 16,
    NEAR_SAMPLES = 16,
    OCTAVE_LIMIT = 64
};

// Surfaces closer than this, in texels, cast shadows that a lattice of 4 may miss.
static const double NEAR_DISTANCE = 2.5;
// Share of a scout's rays that end there where the surface is within a texel.
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
    uint8_t *scouts;  // [texels] 0: not one, else 1 + alpi_nearness; the scratch's marks
    uint16_t *inside; // [texels] bit i: stratum i is inside other geometry; the scratch's
} validity_job;

// --- what is near --------------------------------------------------------------------------------

/// Texels that are asked for all around them: every second of every second row.
static bool is_scout(const alpi_texels *t, uint32_t texel)
{
    return t->pixels[texel][0] % 2 == 0 && t->pixels[texel][1] % 2 == 0;
}

/// The octave of a texel's side: scouts of one octave look equally far.
static int find_octave(const alpi_texels *t, uint32_t texel)
{
    const int octave = ilogbf(alpi_texels_side(t, texel));
    return octave < -OCTAVE_LIMIT ? -OCTAVE_LIMIT : octave > OCTAVE_LIMIT ? OCTAVE_LIMIT : octave;
}

/// Asks the user whether to go on, once in a while; for loops over the order on one thread.
static alp_result tick(const validity_job *job, uint32_t i)
{
    return i % TEXELS_PER_TICK == TEXELS_PER_TICK - 1
               ? alpi_tick(job->setup->context, "validity", i, job->order_count)
               : ALP_OK;
}

/// Scouts of one octave.
static alp_result list_scouts(const validity_job *job, int octave, uint32_t *list, uint32_t *count)
{
    *count = 0;
    for (uint32_t i = 0; i < job->order_count; i++) {
        const uint32_t t = job->order[i];
        if (is_scout(job->texels, t) && find_octave(job->texels, t) == octave) {
            list[(*count)++] = t;
        }
        ALP_TRY(tick(job, i));
    }
    return ALP_OK;
}

/// Occlusion over a short distance, in mean sides of the listed texels. Nothing of it is the
/// bake's: which texels are looked at, and so what a map converges to, must not hang on the seed,
/// nor on what is asked of another map (its cone, how many rays, whether these are quick).
static alp_result make_short_setup(const validity_job *job, const uint32_t *list, uint32_t count,
                                   alpi_occlusion_setup *setup)
{
    alp_occlusion_options near = alp_occlusion_options_default();
    double area = 0.0, coverage = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        area += (double)job->texels->areas[list[i]];
        coverage += (double)job->texels->coverages[list[i]];
    }
    near.distance = (float)(NEAR_DISTANCE * sqrt(area / fmax(coverage, 1e-30)));
    near.falloff = ALP_FALLOFF_NONE;
    near.samples = NEAR_SAMPLES;
    near.seed = NEAR_SEED;
    return alpi_occlusion_prepare(job->setup->scene, job->setup->tracer, &near, setup);
}

/// A texel is near something when one of the scouts around it in its chart is, or there is none.
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
                    job->scouts[n] > nearest) {
                    nearest = job->scouts[n];
                }
            }
        }
        job->out->near[texel] = nearest > 0 ? nearest - 1 : ALPI_TOUCHING;
    }
    return ALP_OK;
}

/// A few short rays from each of the listed texels, by the occlusion kernel.
static alp_result send_scouts(validity_job *job, const uint32_t *list, uint32_t count,
                              const alpi_task_progress *progress, alpi_occlusion_sums *sums)
{
    alpi_occlusion_setup near;
    ALP_TRY(make_short_setup(job, list, count, &near));
    alp_result result = alpi_occlusion_add(&near, job->receivers, list, count, 0, NEAR_SAMPLES,
                                           NEAR_SAMPLES, progress, sums);
    for (uint32_t i = 0; i < count; i++) {
        const float closed = 1.0f - alpi_occlusion_value(sums, list[i]);
        job->scouts[list[i]] = closed > TOUCHING ? 3 : closed > 0.0f ? 2 : 1;
    }
    job->out->rays += (uint64_t)count * NEAR_SAMPLES;
    alpi_occlusion_release(&near);
    return result;
}

/// Sends a quarter of the texels as scouts, then tells all.
static alp_result find_near(validity_job *job, const alpi_task_progress *progress)
{
    alp_context *context = job->setup->context;
    alpi_occlusion_sums *sums = &job->out->scratch->sums;
    bool octaves[2 * OCTAVE_LIMIT + 1] = {false};
    for (uint32_t i = 0; i < job->order_count; i++) {
        const uint32_t t = job->order[i];
        if (is_scout(job->texels, t)) {
            octaves[OCTAVE_LIMIT + find_octave(job->texels, t)] = true;
        }
        ALP_TRY(tick(job, i));
    }
    uint32_t *list = ALPI_NEW(context, uint32_t, job->order_count);
    alp_result result = list != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    for (int k = -OCTAVE_LIMIT; k <= OCTAVE_LIMIT && result == ALP_OK; k++) {
        uint32_t count = 0;
        result = octaves[OCTAVE_LIMIT + k] ? list_scouts(job, k, list, &count) : ALP_OK;
        result =
            result == ALP_OK && count > 0 ? send_scouts(job, list, count, progress, sums) : result;
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

/// Points at the middles of `count` strata.
static void place_strata(const validity_job *job, uint32_t texel, const uint8_t *strata,
                         uint32_t count, alpi_receiver_point *points)
{
    float square[STRATA][2];
    find_middles(strata, count, square);
    job->receivers->place(job->receivers->user, texel, count, (const float(*)[2])square, points);
}

/// Which of eight ways are blocked: lane i goes from `from` to `to`, unless it is shorter than
/// `least[i]`. @return bits of the lanes
static uint32_t find_blocked(const validity_job *job, const vec3 from[ALPI_PACKET],
                             const vec3 to[ALPI_PACKET], const float least[ALPI_PACKET])
{
    alpi_rays rays;
    uint32_t active = 0, blocked = 0;
    alpi_rays_clear(&rays);
    for (int i = 0; i < ALPI_PACKET; i++) {
        const vec3 way = vec3_sub(to[i], from[i]);
        const float length = vec3_length(way);
        alpi_rays_set(&rays, i, from[i], vec3_scale(way, length > 0.0f ? 1.0f / length : 0.0f),
                      length);
        active |= (length > least[i] ? 1u : 0u) << i;
    }
    if (active == 0) {
        return 0;
    }
    alpi_trace_occluded(job->setup->tracer, &rays, 1, active, (alpi_trace_filter){0},
                        ALPI_RAYS_NEAR);
    for (int i = 0; i < ALPI_PACKET; i++) {
        blocked |= ((active >> i & 1u) != 0 && rays.maximum[i] < 0.0f ? 1u : 0u) << i;
    }
    return blocked;
}

/// Leaves the points of a texel on their triangles where the lift of any of eight passes through
/// something.
static void keep_low_if_blocked(const validity_job *job, uint32_t texel)
{
    static const uint8_t chosen[ALPI_PACKET] = {0, 2, 5, 7, 8, 10, 13, 15}; // of a chequerboard
    alpi_receiver_point lifted[ALPI_PACKET];
    vec3 low[ALPI_PACKET], from[ALPI_PACKET], to[ALPI_PACKET];
    float square[ALPI_PACKET][2], least[ALPI_PACKET];
    find_middles(chosen, ALPI_PACKET, square);
    alpi_texels_lifts(job->texels, texel, ALPI_PACKET, (const float(*)[2])square, lifted, low);
    for (int i = 0; i < ALPI_PACKET; i++) {
        const alpi_receiver_point *point = &lifted[i];
        from[i] = vec3_mad(low[i], point->offset, point->geometric_normal);
        to[i] = vec3_add(from[i], vec3_sub(point->position, low[i]));
        least[i] = point->offset;
    }
    if (find_blocked(job, from, to, least) != 0) {
        job->texels->flags[texel] |= ALPI_TEXEL_NO_LIFT;
    }
}

static bool is_inside(const validity_job *job, const alpi_receiver_point *point, float side)
{
    return alpi_are_inside(job->setup->tracer, job->texels->atlas->scene, point, 1u, side) != 0;
}

/// Which strata of a texel lie inside other geometry: those that are seen from its middle, where
/// that is outside, are outside; the others are asked.
static uint16_t find_inside(const validity_job *job, uint32_t texel)
{
    const float side = alpi_texels_side(job->texels, texel);
    const float none[ALPI_PACKET] = {0.0f};
    const uint8_t all[STRATA] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    alpi_receiver_point points[STRATA], middle;
    alpi_texels_point(job->texels, texel, &middle);
    place_strata(job, texel, all, STRATA, points);
    const vec3 above = alpi_look_start(&middle, side);
    const bool middle_inside = is_inside(job, &middle, side);
    uint32_t asked = 0;
    for (int first = 0; first < STRATA; first += ALPI_PACKET) {
        vec3 from[ALPI_PACKET], to[ALPI_PACKET];
        for (int i = 0; i < ALPI_PACKET; i++) {
            from[i] = above;
            to[i] = alpi_look_start(&points[first + i], side);
        }
        const uint32_t hidden = middle_inside ? 0xffu : find_blocked(job, from, to, none);
        asked |= hidden << first;
    }
    return (uint16_t)alpi_are_inside(job->setup->tracer, job->texels->atlas->scene, points, asked,
                                     side);
}

/// Whether anything is within 1.6 texels of a texel's middle (a filter reads it up to one away, and
/// eight directions may miss the nearest by 22°): else it is wholly outside, or so far
/// inside that no filter reads it with one that is seen.
static bool is_suspicious(const validity_job *job, uint32_t texel)
{
    alpi_receiver_point point;
    alpi_rays rays;
    alpi_texels_point(job->texels, texel, &point);
    const float reach = 1.6f * alpi_texels_side(job->texels, texel);
    alpi_rays_clear(&rays);
    alpi_look_aim(&point, reach, ALPI_LOOK_ALONG, reach, 0, &rays);
    alpi_look_aim(&point, reach, ALPI_LOOK_BETWEEN, reach, 4, &rays);
    alpi_trace_occluded(job->setup->tracer, &rays, 1, 0xffu, (alpi_trace_filter){0},
                        ALPI_RAYS_NEAR);
    bool suspicious = false;
    for (int k = 0; k < ALPI_PACKET; k++) {
        suspicious = suspicious || rays.maximum[k] < 0.0f;
    }
    return suspicious;
}

/// Whether a texel with nothing beside it is far inside: what it touches is the solid around it.
static bool is_covered(const validity_job *job, uint32_t texel)
{
    alpi_receiver_point point;
    alpi_texels_point(job->texels, texel, &point);
    return is_inside(job, &point, alpi_texels_side(job->texels, texel));
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
            texels->valid[t] = 0; // of an earlier look, through which places would go
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

static alp_result judge_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const validity_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        if (job->out->near[t] == ALPI_FAR) {
            continue;
        }
        if (is_suspicious(job, t)) {
            job->inside[t] = find_inside(job, t);
        } else if (job->out->near[t] == ALPI_TOUCHING && is_covered(job, t)) {
            job->texels->flags[t] |= ALPI_TEXEL_HIDDEN;
        }
    }
    return ALP_OK;
}

/// Whether a texel that is not wholly inside is beside it in its chart.
static bool is_beside_seen(const validity_job *job, uint32_t texel)
{
    const alpi_texels *t = job->texels;
    const uint16_t *p = t->pixels[texel];
    for (int k = 0; k < 9; k++) {
        const uint32_t n = alpi_lattice_texel(job->lattice, t->pages[texel],
                                              (int64_t)p[0] + k % 3 - 1, (int64_t)p[1] + k / 3 - 1);
        if (n != ALPI_NONE && t->charts[n] == t->charts[texel] && job->inside[n] != UINT16_MAX) {
            return true;
        }
    }
    return false;
}

/// Texels partly inside keep their other strata; those wholly inside at the rim are dropped; those
/// farther in, which nobody sees, are called hidden.
static alp_result settle(validity_job *job)
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
    alpi_task_progress told = progress != NULL ? *progress : (alpi_task_progress){0};
    ALP_TRY(
        alpi_parallel_for(context, job->order_count, TEXELS_PER_RANGE, lower_range, job, &told));
    ALP_TRY(find_near(job, &told));
    ALP_TRY(
        alpi_parallel_for(context, job->order_count, TEXELS_PER_RANGE, judge_range, job, &told));
    ALP_TRY(settle(job));
    return alpi_scratch_clear(job->out->scratch, job->order, job->order_count, &told);
}

alp_result alpi_validity_open(alp_context *context, uint32_t texels, alpi_scratch *scratch,
                              alpi_validity *validity)
{
    *validity = (alpi_validity){.context = context, .scratch = scratch};
    validity->near = ALPI_NEW(context, uint8_t, texels);
    validity->dropped = ALPI_NEW(context, uint8_t, texels);
    if (validity->near == NULL || validity->dropped == NULL) {
        alpi_validity_destroy(validity);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    return ALP_OK;
}

alp_result alpi_validity_look(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
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
                        .scouts = validity->scratch->marks,
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
        result = alpi_validity_look(setup, receivers, texels, lattice, order, order_count, progress,
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
        alpi_release(validity->context, validity->near);
        alpi_release(validity->context, validity->dropped);
    }
    *validity = (alpi_validity){0};
}
