// SPDX-License-Identifier: MIT
#include "bake/light/light_plan.h"

#include "bake/light/light_gather.h"
#include "bake/light/light_samples.h"
#include "base/random.h"
#include "base/tasks.h"

#include <math.h>

/// Share of the time left that a round may take: its time is a guess.
static const double TIME_SHARE = 0.9;
/// The least share of the texels that samples of direct light are for. It is counted for one way to
/// split the error between direct and bounced light, but used for many.
static const double LEAST_NOISY = 0.05;

// --- the cheapest round --------------------------------------------------------------------------

/// Samples to add, over those before, until the error is the wanted one.
static double more_samples(double error, double wanted, double power)
{
    return error > wanted ? fmax(1.1 * pow(error / wanted, 1.0 / power) - 1.0, 0.25) : 0.0;
}

/// @param share of the squared error for bounced light
static alpi_light_plan plan_for(const alpi_light_effort *e, const alpi_light_noise *noise,
                                double aim, double share)
{
    // A ray of bounced light takes as long as two or three shadow rays (measured: 1.9 to 5).
    const double dear = 2.5 / e->draw;
    alpi_light_plan p = {.for_direct = sqrt(1.0 - share) * aim,
                         .listed = fmax(noise->noisy * e->texels, 1.0)};
    p.direct = more_samples(noise->direct, p.for_direct, e->direct_power) * e->direct;
    p.rays = more_samples(noise->bounced, sqrt(share) * aim, e->rays_power) * e->rays;
    p.cost = noise->noisy * e->texels * p.direct + dear * e->traced * p.rays;
    p.direct = fmin(p.direct, fmin(15.0 * e->direct, e->most - e->direct));
    p.rays = fmin(p.rays, fmin(15.0 * e->rays, e->most - e->rays));
    return p;
}

/// Tries many shares of the squared error, and the two that leave one kind of light as it is.
alpi_light_plan alpi_light_cheapest(const alpi_light_effort *effort, const alpi_light_noise *noise,
                                    double aim)
{
    enum { WAYS = 32 };
    const double b = noise->bounced / aim, d = noise->direct / aim;
    const double as_they_are[2] = {b * b, 1.0 - d * d};
    alpi_light_plan best = plan_for(effort, noise, aim, 0.5);
    for (int i = 1; i < WAYS + 2; i++) {
        const double share = i < WAYS ? (double)i / WAYS : as_they_are[i - WAYS];
        if (share > 0.0 && share < 1.0) {
            const alpi_light_plan p = plan_for(effort, noise, aim, share);
            best = p.cost < best.cost ? p : best;
        }
    }
    return best;
}

static alpi_light_plan cheapest(const alpi_light_rounds *r, const alpi_light_noise *noise,
                                double aim)
{
    const alpi_light_effort effort = {
        .direct = alpi_light_typical_samples(r),
        .rays = alpi_light_typical(r->light->values, r->rays.of_texels, r->worst.list,
                                   r->worst.count, r->rays.per_texel),
        .most = r->light->settings.most_rays,
        .texels = r->light->count,
        .direct_power = r->direct.power,
        .rays_power = r->rays.power,
        .draw = fmax(r->solution->direct_draw, 1.0),
        .traced = r->worst.count > 0 ? r->worst.count : r->rays.traced};
    return alpi_light_cheapest(&effort, noise, aim);
}

// --- all texels, or the worst --------------------------------------------------------------------

/// The error that the next round aims at: the part of the wanted error that the solution leaves,
/// and at least half of the wanted error. Without one, √½ of the error so far.
static double find_aim(const alpi_light_rounds *r)
{
    const double wanted = (double)r->light->job->options.light.error;
    const double left = wanted * wanted - r->errors.solved * r->errors.solved;
    return wanted > 0.0 ? sqrt(fmax(left, 0.25 * wanted * wanted))
                        : sqrt(0.5) * hypot(r->errors.direct, r->errors.bounced);
}

/// Plans a round of all texels. @return false: the map is good enough
static bool plan_for_all(const alpi_light_rounds *r, alpi_light_plan *plan)
{
    const double aim = find_aim(r);
    *plan = (alpi_light_plan){0};
    if (!(hypot(r->errors.direct, r->errors.bounced) > aim)) {
        return false;
    }
    const double half = sqrt(0.5) * aim * r->errors.scale; // about the error of direct light
    const double noisy = fmax(alpi_light_noisy_share(r, half), LEAST_NOISY);
    const alpi_light_noise noise = {r->errors.direct, r->errors.bounced, noisy};
    *plan = cheapest(r, &noise, aim);
    return true;
}

/// Plans a round of the worst texels, whose 99th percentile may be too large in a map that is good
/// enough as a whole.
static alp_result plan_for_worst(alpi_light_rounds *r, alpi_light_plan *plan)
{
    const alpi_light_bake *light = r->light;
    const double limit = ALPI_P99_LIMIT * (double)light->job->options.light.error;
    ALP_TRY(alpi_light_measure_map(r));
    if (!(r->errors.map.over_scale.p99 > limit)) { // also in the dark
        return ALP_OK;
    }
    const bool direct = light->job->options.light.direct != ALP_DIRECT_OFF;
    const alpi_light_whole whole = {.values = r->fresh.values,
                                    .bounced = light->values,
                                    .direct = direct ? r->solution->direct : NULL,
                                    .order = light->order,
                                    .count = light->count};
    alpi_light_noise noise;
    const double solved = alpi_light_tail(&whole, &r->errors.map, limit, &noise);
    alpi_light_find_worst(&whole, &r->errors.map, light->receivers->count, limit,
                          r->interpolated.marks, &r->worst);
    *plan = cheapest(r, &noise, sqrt(fmax(limit * limit - solved * solved, 0.25 * limit * limit)));
    return ALP_OK;
}

// --- limits --------------------------------------------------------------------------------------

double alpi_light_rays_left(const alpi_light_rounds *r)
{
    return fmax(r->light->settings.ray_limit - r->rays.sent - r->direct.drawn, 0.0);
}

/// Cuts a plan to the rays that are left. Drops a part that would be an eighth of the samples
/// before, or less.
static void keep_ray_limit(alpi_light_rounds *r, alpi_light_plan *plan)
{
    uint32_t count;
    (void)alpi_light_tracing_texels(r, &count);
    const double wanted = plan->listed * plan->direct + fmin(count, r->rays.traced) * plan->rays;
    const double left = alpi_light_rays_left(r);
    if (wanted > left) {
        const double share = left / wanted;
        const double direct = share * plan->direct, rays = share * plan->rays;
        plan->direct = direct >= 0.125 * alpi_light_typical_samples(r) ? direct : 0.0;
        plan->rays = rays >= 0.125 * r->rays.per_texel ? rays : 0.0;
        r->limited = true;
    }
}

double alpi_light_affordable(const alpi_light_rounds *r, double samples, double seconds_each,
                             double before)
{
    const double left = TIME_SHARE * (r->light->clock->deadline - alpi_seconds());
    const double most = isinf(left) ? samples : fmin(samples, fmax(left, 0.0) / seconds_each);
    return most < samples && most < before / 8.0 ? 0.0 : most;
}

alp_result alpi_light_plan_round(alpi_light_rounds *r, alpi_light_plan *plan)
{
    const bool wanted = r->light->job->options.light.error > 0.0f;
    r->worst.count = 0;
    r->for_worst = !plan_for_all(r, plan) && wanted;
    if (r->for_worst) {
        ALP_TRY(plan_for_worst(r, plan));
    }
    if (plan->direct > 0.0 || plan->rays > 0.0) {
        keep_ray_limit(r, plan);
    }
    return ALP_OK;
}

// --- the pilot -----------------------------------------------------------------------------------

/// Error of a map over that of its traced texels with as many rays: interpolated texels are the
/// mean of several. Measured on the Cornell box, a sphere on a plane, living_room, teapot-room: .78
/// to .86.
static const double MAP_SHARE = 0.85;
/// Share of the texels that trace rays, as a guess.
static const double TRACED_SHARE = 0.15;
/// Power of the error with more rays than the pilot's, on a finer lattice too. Measured: .66 to
/// .90. The largest is taken, as plans ask for more samples than they need.
static const double PILOT_POWER = 0.9;
enum { STREAM_PILOT = 12 };

/// Chooses texels, one at random of each run of the same length. @return how many
static uint32_t choose_texels(const alpi_light_bake *light, uint32_t list[ALPI_LIGHT_PILOT_TEXELS])
{
    const double each = (double)light->count / ALPI_LIGHT_PILOT_TEXELS;
    uint32_t count = 0;
    for (uint32_t i = 0; i < ALPI_LIGHT_PILOT_TEXELS; i++) {
        const float within = alpi_unit_float(alpi_random_key(light->count, i, STREAM_PILOT));
        const uint32_t t = light->order[(uint32_t)(each * (i + (double)within))];
        const bool hidden = (light->lattice->texels->flags[t] & ALPI_TEXEL_HIDDEN) != 0;
        list[count] = t;
        count += hidden ? 0 : 1;
    }
    return count;
}

/// Gathers light at listed texels twice, into light->values. Their variance is E[(x − y)²] / 2.
static alp_result gather_twice(alpi_light_rounds *r, const uint32_t *list, uint32_t count)
{
    alpi_reference_value *values = r->light->values, first[ALPI_LIGHT_PILOT_TEXELS];
    alpi_task_progress progress = r->light->progress;
    alpi_light_tracing tracing = {.near = {0}};
    alpi_light_tracing_start(r, ALPI_LIGHT_FIRST_RAYS, alpi_hash64(alpi_light_round_seed(r, false)),
                             &tracing);
    tracing.gather.list = list;
    tracing.gather.count = count;
    tracing.gather.values = values;
    tracing.gather.skies = r->skies;
    progress.units_total = 2.0 * count * ALPI_LIGHT_FIRST_RAYS;
    ALP_TRY(alpi_gather_irradiance(&tracing.gather, &progress));
    for (uint32_t i = 0; i < count; i++) {
        first[i] = values[list[i]];
    }
    progress.units_before = 0.5 * progress.units_total;
    tracing.gather.gatherer = &tracing.independent;
    tracing.gather.skies = NULL; // those of the first stay
    ALP_TRY(alpi_gather_irradiance(&tracing.gather, &progress));
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            const float apart = values[list[i]].mean[k] - first[i].mean[k];
            first[i].variance[k] = 0.5f * apart * apart;
        }
        values[list[i]] = first[i];
    }
    r->light->job->report.rays += 2 * (uint64_t)count * ALPI_LIGHT_FIRST_RAYS;
    r->rays.sent += 2.0 * count * ALPI_LIGHT_FIRST_RAYS;
    return ALP_OK;
}

/// Plans as after a round with the noise of the pilot. @param rays out: of a texel
static alp_result plan_first(alpi_light_rounds *r, alpi_light_plan *plan, double *rays)
{
    const alpi_light_bake *light = r->light;
    const bool adaptive = light->settings.adaptive;
    uint32_t list[ALPI_LIGHT_PILOT_TEXELS];
    const uint32_t count = choose_texels(light, list);
    r->rays.traced = (adaptive ? TRACED_SHARE : 1.0) * light->count;
    r->rays.power = PILOT_POWER;
    alpi_light_clock_part(light->clock, false, r->rays.traced / (2.0 * ALPI_LIGHT_PILOT_TEXELS));
    ALP_TRY(gather_twice(r, list, count));
    ALP_TRY(alpi_light_measure(r, list, count));
    r->errors.bounced *= adaptive ? MAP_SHARE : 1.0;
    r->rays.per_texel = ALPI_LIGHT_FIRST_RAYS;
    *rays = ALPI_LIGHT_FIRST_RAYS + (plan_for_all(r, plan) ? plan->rays : 0.0);
    r->rays.per_texel = 0; // the pilot is no round
    return ALP_OK;
}

alp_result alpi_light_run_pilot(alpi_light_rounds *r, uint32_t *rays)
{
    alpi_light_plan plan;
    double wanted;
    bool added;
    ALP_TRY(plan_first(r, &plan, &wanted));
    // Half of the limit at most for each; later rounds see the rest.
    const double most = 0.5 * r->light->settings.ray_limit;
    *rays = alpi_light_ray_count(fmax(fmin(wanted, most / r->rays.traced), ALPI_LIGHT_FIRST_RAYS));
    if (plan.direct <= 0.0) {
        return ALP_OK;
    }
    const alpi_light_goal goal = {.wanted = plan.for_direct * r->errors.scale,
                                  .most = most,
                                  .seed = alpi_light_round_seed(r, true)};
    alpi_light_clock_part(r->light->clock, false, 1.0);
    ALP_TRY(alpi_light_add_samples(r, &goal, &added));
    return alpi_light_relight(r, 0, &r->errors.solved_noise);
}
