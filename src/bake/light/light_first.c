// SPDX-License-Identifier: MIT
// How many rays the first round sends. A round costs more than its rays: the lattice is judged
// anew, the solution shown anew, and what each misses by interpolation is in the mean of all. So a
// few texels try before how noisy the light is, and the first round sends what that asks for.
#include "bake/light/light_rays.h"

#include "base/random.h"
#include "base/tasks.h"

#include <math.h>

enum {
    PILOT_TEXELS = 256,
    LEAST_MAP = 32 * PILOT_TEXELS, // texels: on less the pilot costs more than it gains
    STREAM_PILOT = 12
};
/// Error of a map by as many rays, over that of texels that all have their own: the mean over it is
/// that of interpolated ones for the most part. Measured on the Cornell box, a sphere on a plane,
/// living_room, teapot-room: .78 to .86.
static const double MAP_SHARE = 0.85;
static const double SENDING_SHARE = 0.15; // of texels that send rays, as a guess

/// Some texels, one at random of each run of them that are as long. @return how many
static uint32_t choose(const alpi_light_round_state *r, uint32_t list[PILOT_TEXELS])
{
    const double each = (double)r->task->count / PILOT_TEXELS;
    uint32_t count = 0;
    for (uint32_t i = 0; i < PILOT_TEXELS; i++) {
        const float within = alpi_unit_float(alpi_random_key(r->task->count, i, STREAM_PILOT));
        const uint32_t t = r->task->order[(uint32_t)(each * (i + (double)within))];
        const bool hidden = (r->task->lattice->texels->flags[t] & ALPI_TEXEL_HIDDEN) != 0;
        list[count] = t;
        count += hidden ? 0 : 1;
    }
    return count;
}

/// Gathers light at listed texels twice, into the values of the task, where the first round will
/// write anew. Their variance is E[(x − y)²] / 2.
static alp_result try_texels(alpi_light_round_state *r, const uint32_t *list, uint32_t count)
{
    alpi_reference_value *values = r->task->values, found[PILOT_TEXELS];
    alpi_task_progress told = r->task->progress;
    alpi_light_rays by;
    alpi_light_rays_start(r, ALPI_LIGHT_FIRST_RAYS, alpi_hash64(alpi_light_round_seed(r, false)),
                          &by);
    by.gather.list = list;
    by.gather.count = count;
    by.gather.values = values;
    by.gather.skies = r->skies;
    told.units_total = 2.0 * count * ALPI_LIGHT_FIRST_RAYS;
    ALP_TRY(alpi_gather_irradiance(&by.gather, &told));
    for (uint32_t i = 0; i < count; i++) {
        found[i] = values[list[i]];
    }
    told.units_before = 0.5 * told.units_total;
    by.gather.gatherer = &by.beside;
    by.gather.skies = NULL; // those of the values that stay
    ALP_TRY(alpi_gather_irradiance(&by.gather, &told));
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            const float apart = values[list[i]].mean[k] - found[i].mean[k];
            found[i].variance[k] = 0.5f * apart * apart;
        }
        values[list[i]] = found[i];
    }
    r->job->report.rays += 2 * (uint64_t)count * ALPI_LIGHT_FIRST_RAYS;
    r->sent += 2.0 * count * ALPI_LIGHT_FIRST_RAYS;
    return ALP_OK;
}

/// Plans as for a round after one that found what the pilot did. @param rays out: of a texel
static alp_result plan(alpi_light_round_state *r, alpi_light_plan *p, double *rays)
{
    const bool adaptive = alpi_light_is_adaptive(&r->job->options);
    uint32_t list[PILOT_TEXELS];
    const uint32_t count = choose(r, list);
    r->sending = (adaptive ? SENDING_SHARE : 1.0) * r->task->count;
    r->rays_power = ALPI_LIGHT_FIRST_RAYS_POWER;
    alpi_light_clock_part(r->task->clock, false, r->sending / (2.0 * PILOT_TEXELS));
    ALP_TRY(try_texels(r, list, count));
    ALP_TRY(alpi_light_round_measure(r, list, count));
    r->bounced_error *= adaptive ? MAP_SHARE : 1.0;
    r->rays = ALPI_LIGHT_FIRST_RAYS;
    *rays = alpi_light_round_plan_all(r, p) ? r->rays + p->rays : ALPI_LIGHT_FIRST_RAYS;
    r->rays = 0; // there was no round yet
    return ALP_OK;
}

/// Direct light for the whole map, which the rays are shown then, and by which what is near them is
/// farther where light differs.
/// @param most samples of all texels together
static alp_result add_direct(alpi_light_round_state *r, double wanted, double most)
{
    const alpi_light_goal goal = {
        .wanted = wanted, .most = most, .seed = alpi_light_round_seed(r, true)};
    bool dealt;
    alpi_light_clock_part(r->task->clock, false, 1.0);
    ALP_TRY(alpi_light_more_direct(&r->direct, &goal, &dealt));
    return alpi_light_show(r->job, r->task, r->solution, 0, &r->solved_noise);
}

alp_result alpi_light_prepare_first(alpi_light_round_state *r, uint32_t *rays)
{
    const alp_bake_options *o = &r->job->options;
    // Who may end the bake before gets something whole first.
    const bool may_end = o->sampling.keep_partial || !isinf(r->task->clock->deadline);
    *rays = ALPI_LIGHT_FIRST_RAYS;
    if (!(o->light.error > 0.0f) || may_end || r->task->count < LEAST_MAP) {
        return ALP_OK;
    }
    alpi_light_plan p;
    double wanted;
    ALP_TRY(plan(r, &p, &wanted));
    // Half of the limit at most for each: later rounds see what is left of it.
    const double most = 0.5 * r->ray_limit;
    *rays = alpi_light_ray_count(fmax(fmin(wanted, most / r->sending), ALPI_LIGHT_FIRST_RAYS));
    return p.direct > 0.0 ? add_direct(r, p.for_direct * r->scale, most) : ALP_OK;
}
