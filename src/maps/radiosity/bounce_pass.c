// SPDX-License-Identifier: MIT
// The bounce pass: relight the cells, gather at all receivers, measure the change. Passes repeat
// until the light that later ones would add is small enough.
#include "maps/radiosity/solver.h"

#include "base/tasks.h"

#include <math.h>
#include <string.h>

// A smaller relative change is rounding of floats.
static const double LEAST_CHANGE = 1e-7;

alp_result alpi_solver_gather(const alpi_solver *solver, alpi_reference_value *values)
{
    alpi_radiosity *r = solver->r;
    alpi_gather_job job = alpi_solver_job(solver, r->receivers, r->receiver_count);
    job.values = values;
    job.skies = NULL; // known since the first rays
    if (r->kept) {
        return alpi_kept_rays_gather(&job, &solver->kept, &solver->progress);
    }
    r->rays += (uint64_t)job.count * job.gatherer->packet_count * ALPI_PACKET;
    return alpi_gather_irradiance(&job, &solver->progress);
}

void alpi_solver_copy_means(const alpi_solver *solver, const alpi_reference_value *values,
                            float (*means)[3])
{
    const alpi_radiosity *r = solver->r;
    for (uint32_t i = 0; i < r->receiver_count; i++) {
        memcpy(means[r->receivers[i]], values[r->receivers[i]].mean, sizeof *means);
    }
}

static double sum_of(const float v[3])
{
    return (double)v[0] + (double)v[1] + (double)v[2];
}

/// Sums area · (E₀ + sky), which no pass changes.
static void sum_first_light(const void *user, uint32_t begin, uint32_t end,
                            double sums[ALPI_SUM_LIMIT])
{
    const alpi_radiosity *r = user;
    const alpi_patches *p = &r->patches;
    for (uint32_t i = begin; i < end; i++) {
        size_t back;
        const uint32_t b = alpi_receiver_patch(p, r->receivers[i], &back);
        sums[0] += p->patch_areas[b] * sum_of(r->skies[r->receivers[i]]);
        for (uint32_t k = p->patch_first[b]; k < p->patch_first[b + 1]; k++) {
            const uint32_t t = p->patch_texels[k];
            sums[0] += (double)alpi_texels_area(p->texels, t) *
                       sum_of(r->direct[back * p->texels->count + t].mean);
        }
    }
}

/// Sums area · |Eₖ − Eₖ₋₁| and area · Eₖ.
static void sum_changes(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const alpi_radiosity *r = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t receiver = r->receivers[i];
        size_t back;
        const double area =
            r->patches.patch_areas[alpi_receiver_patch(&r->patches, receiver, &back)];
        for (int k = 0; k < 3; k++) {
            const double change =
                (double)r->bounced[receiver].mean[k] - (double)r->before[receiver][k];
            sums[0] += area * fabs(change);
        }
        sums[1] += area * sum_of(r->bounced[receiver].mean);
    }
}

static alp_result measure_first_light(alpi_solver *s)
{
    double sums[ALPI_SUM_LIMIT] = {0.0};
    ALP_TRY(alpi_parallel_sum(s->r->options.context, s->r->receiver_count, sum_first_light, s->r,
                              &s->progress, sums));
    s->first_light = sums[0];
    return ALP_OK;
}

static alp_result measure_change(alpi_solver *s)
{
    alpi_radiosity *r = s->r;
    double sums[ALPI_SUM_LIMIT] = {0.0};
    ALP_TRY(alpi_parallel_sum(r->options.context, r->receiver_count, sum_changes, r, &s->progress,
                              sums));
    const double light = s->first_light + sums[1];
    s->former = s->change;
    s->change = light > 0.0 ? sums[0] / light : 0.0;
    if (r->passes < ALPI_RADIOSITY_CHANGES) {
        r->changes[r->passes] = (float)s->change;
    }
    return ALP_OK;
}

static alp_result run_pass(alpi_solver *s)
{
    if (s->accelerated && s->r->passes > 1) {
        ALP_TRY(alpi_acceleration_mix(&s->acceleration, s->r, &s->progress));
    }
    alpi_solver_copy_means(s, s->r->bounced, s->r->before);
    ALP_TRY(alpi_radiosity_relight(s->r, ALPI_NONE, NULL, &s->progress));
    ALP_TRY(alpi_solver_gather(s, s->r->bounced));
    ALP_TRY(measure_change(s));
    s->r->passes++;
    return ALP_OK;
}

/// The share of all light that later passes would add. Each adds the same ratio of the pass before,
/// as the last two show. Accelerated passes have no such ratio: .95 is assumed, as in a closed room
/// of the lightest material.
static double left_over(const alpi_solver *s)
{
    static const double ACCELERATED_RATIO = 0.95;
    if (s->r->passes > 0 && s->change <= LEAST_CHANGE) {
        return 0.0;
    }
    if (s->r->passes < 2) {
        return HUGE_VAL;
    }
    const double last = s->former > 0.0 ? fmin(s->change / s->former, 0.999) : 0.999;
    const double ratio = s->accelerated ? ACCELERATED_RATIO : last;
    return s->change * ratio / (1.0 - ratio);
}

/// Whether another pass would exceed the limit of rays. A few passes are always traced.
/// @param rays_before rays before the last pass
static bool exceeds_ray_limit(const alpi_solver *s, uint64_t rays_before)
{
    enum { FEWEST_PASSES = 6 };
    const alpi_radiosity *r = s->r;
    return r->options.ray_limit > 0.0 && r->passes >= FEWEST_PASSES &&
           (double)r->rays + (double)(r->rays - rays_before) > r->options.ray_limit;
}

/// Accelerates passes that trace their rays again because of panes, a property of the scene and not
/// of memory. Neither a number of bounces nor layers, which repeat the passes, allow it.
static alp_result choose_acceleration(alpi_solver *s, bool traced_again)
{
    const alpi_radiosity_options *o = &s->r->options;
    s->accelerated = o->bounces >= ALPI_RADIOSITY_PASS_LIMIT && traced_again && o->layers == NULL;
    return s->accelerated
               ? alpi_acceleration_create(
                     o->context, alpi_patches_sides(&s->r->patches) * s->r->patches.patch_count,
                     &s->acceleration)
               : ALP_OK;
}

alp_result alpi_solver_bounce(alpi_solver *solver)
{
    alpi_radiosity *r = solver->r;
    const uint32_t limit = r->options.bounces < ALPI_RADIOSITY_PASS_LIMIT
                               ? r->options.bounces
                               : ALPI_RADIOSITY_PASS_LIMIT;
    const bool traced_again = !alpi_gather_meets_cells(&solver->from);
    ALP_TRY(measure_first_light(solver));
    ALP_TRY(choose_acceleration(solver, traced_again));
    uint64_t rays_before = r->rays;
    while (r->passes < limit && left_over(solver) > r->options.tolerance) {
        if (traced_again && exceeds_ray_limit(solver, rays_before)) {
            r->missing = left_over(solver);
            break;
        }
        rays_before = r->rays;
        ALP_TRY(run_pass(solver));
    }
    return ALP_OK;
}
