// SPDX-License-Identifier: MIT
// Direct and bounced light are gathered apart. Each round adds samples or rays, whichever lowers
// the error at the lower cost (light_plan.c). Rounds have random numbers of their own; their
// results are averaged by their numbers of samples.
//
// With shares wᵢ of the samples and errors bᵢ + eᵢ of the rounds, bᵢ the bias of interpolation and
// eᵢ noise, the squared error of a texel is
//
//     E[(Σ wᵢ (bᵢ + eᵢ))²] = (Σ wᵢ bᵢ)² + Σ wᵢ² Var eᵢ
//
// Noise falls with the number of rounds. Bias does not: the same texels between the same neighbours
// have the same bias in each round. So some texels are held out: they trace rays of their own in
// each round, x̂ = Σ wᵢ yᵢ. The mean of (x − x̂)² − Var x̂ over them is the squared error of all
// interpolated texels.
#include "bake/light/light_rounds.h"

#include "bake/light/light_gather.h"
#include "bake/light/light_plan.h"
#include "bake/light/light_samples.h"
#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <string.h>

enum {
    ROUND_LIMIT = 12,
    TIMED_ROUND_LIMIT = 64 // each doubles the samples, or ends with the time
};

// --- one round -----------------------------------------------------------------------------------

static void note_interpolated(alpi_light_rounds *r)
{
    for (uint32_t i = 0; i < r->light->count; i++) {
        const uint32_t t = r->light->order[i];
        r->interpolated.marks[t] |= r->states[t] == ALPI_TEXEL_INTERPOLATED;
    }
}

/// Sets the variance of texels that any round interpolated; see above.
static void state_interpolated(alpi_light_rounds *r, uint32_t rays)
{
    const alpi_held_out *h = r->interpolated.held_out;
    float variance[3];
    note_interpolated(r);
    for (uint32_t i = 0; i < h->count; i++) {
        alpi_light_merge(&r->interpolated.means[i], &h->values[i], r->rays.per_texel, rays);
    }
    if (h->count == 0) { // the first round interpolated nothing: each states its own error
        return;
    }
    alpi_held_out_error(h->texels, r->interpolated.means, h->count, r->light->values, variance);
    for (uint32_t i = 0; i < r->light->count; i++) {
        const uint32_t t = r->light->order[i];
        if (r->interpolated.marks[t] != 0) {
            memcpy(r->light->values[t].variance, variance, sizeof variance);
        }
    }
}

/// Merges the light of the round at one texel.
static void merge_texel(alpi_light_rounds *r, uint32_t t, uint32_t rays)
{
    const double had = r->rays.of_texels[t], all = had + rays;
    const float a = (float)(had / all), b = (float)(rays / all);
    alpi_light_merge(&r->light->values[t], &r->fresh.values[t], had, rays);
    if (r->light->directional != NULL) {
        alpi_directional_mix(&r->light->directional[t], a, &r->fresh.directional[t], b);
    }
    for (int k = 0; k < 3 && r->skies != NULL; k++) {
        r->skies[t][k] += b * (r->fresh.skies[t][k] - r->skies[t][k]);
    }
    r->rays.of_texels[t] += rays;
    r->rays.most = r->rays.of_texels[t] > r->rays.most ? r->rays.of_texels[t] : r->rays.most;
}

static alp_result add_rays(alpi_light_rounds *r, uint32_t rays)
{
    double noise;
    uint32_t count;
    const uint32_t *list = alpi_light_tracing_texels(r, &count);
    alpi_light_clock_part(r->light->clock, true, 0.0);
    ALP_TRY(alpi_light_relight(r, r->rays.per_texel, &noise));
    ALP_TRY(alpi_light_gather(r, rays, &r->fresh));
    for (uint32_t i = 0; i < count; i++) {
        merge_texel(r, list[i], rays);
    }
    if (r->worst.count == 0) {
        const double share = rays / ((double)r->rays.per_texel + rays);
        state_interpolated(r, rays);
        r->errors.solved_noise += share * (noise - r->errors.solved_noise);
        r->rays.per_texel += rays;
        r->light->job->report.light_samples = r->rays.per_texel;
    }
    return ALP_OK;
}

/// @param samples of a texel, within the time   @param rays whether rays follow
/// @param added out: whether any texel got samples
static alp_result add_samples(alpi_light_rounds *r, const alpi_light_plan *plan, double samples,
                              bool rays, bool *added)
{
    const bool whole = isinf(r->light->clock->deadline) && !r->limited;
    const alpi_light_goal goal = {.wanted = plan->for_direct * r->errors.scale,
                                  .each = r->for_worst,
                                  .among = r->for_worst ? r->worst.marks : NULL,
                                  .most = whole ? alpi_light_rays_left(r) : samples * plan->listed,
                                  .seed = alpi_light_round_seed(r, true)};
    alpi_light_clock_part(r->light->clock, false, rays ? 1.0 : 0.0);
    return alpi_light_add_samples(r, &goal, added);
}

/// Runs a planned round, as far as the time allows.
/// @param done out: nothing was added
static alp_result run_round(alpi_light_rounds *r, const alpi_light_plan *plan, bool *done)
{
    const double each = plan->listed * r->direct.seconds * (plan->rays > 0.0 ? 2.0 : 1.0);
    const double samples =
        alpi_light_affordable(r, plan->direct, each, alpi_light_typical_samples(r));
    const double before = r->errors.direct * r->errors.scale;
    uint32_t count;
    bool added = false;
    (void)alpi_light_tracing_texels(r, &count);
    r->number++;
    if (samples > 0.0) {
        ALP_TRY(add_samples(r, plan, samples, plan->rays > 0.0, &added));
    }
    const double rays = alpi_light_affordable(
        r, plan->rays, r->rays.seconds * fmin(count, r->rays.traced), r->rays.per_texel);
    if (rays > 0.0) {
        ALP_TRY(add_rays(r, alpi_light_ray_count(rays)));
    }
    r->cut_off = r->cut_off || samples < plan->direct || rays < plan->rays;
    *done = !added && rays <= 0.0;
    ALP_TRY(alpi_light_measure(r, r->light->order, r->light->count));
    if (samples > 0.0 && !r->for_worst) {
        r->direct.power = alpi_light_power(r->direct.power, r->direct.predicted / before,
                                           r->errors.direct * r->errors.scale / before);
    }
    return ALP_OK;
}

// --- the first round -----------------------------------------------------------------------------

/// Prepares samples of direct light beside those of the solution.
static alp_result start_direct(alpi_light_rounds *r)
{
    alpi_light_bake *light = r->light;
    alp_context *context = light->job->context;
    const uint32_t texels = light->receivers->count;
    const uint32_t samples = r->solution->options.direct_samples;
    r->direct = (alpi_light_direct){.most = samples,
                                    .power = ALPI_LIGHT_FIRST_POWER,
                                    .seconds = r->solution->direct_seconds /
                                               (samples * fmax(light->count, 1.0))};
    if (!light->settings.in_rounds) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(context, r->fresh.values, texels);
    if (light->directional != NULL) {
        ALPI_TRY_NEW(context, r->fresh.directional, texels);
    }
    ALPI_TRY_NEW(context, r->direct.counts, texels);
    for (uint32_t i = 0; i < light->count; i++) {
        r->direct.counts[light->order[i]] = samples;
    }
    return ALP_OK;
}

static alp_result run_first(alpi_light_rounds *r)
{
    alpi_light_bake *light = r->light;
    const alpi_light_settings *s = &light->settings;
    alp_context *context = light->job->context;
    const uint32_t texels = light->receivers->count;
    const alpi_gatherer *patches = r->solution->options.gatherer;
    const bool more = s->in_rounds && s->most_rays > ALPI_LIGHT_FIRST_RAYS;
    uint32_t rays = more ? ALPI_LIGHT_FIRST_RAYS : s->most_rays;
    ALPI_TRY_NEW(context, light->values, texels);
    if (alpi_radiosity_scene(r->solution).sky) {
        ALPI_TRY_NEW(context, r->skies, texels);
    }
    ALPI_TRY_NEW(context, r->states, texels);
    ALPI_TRY_NEW(context, r->interpolated.held_out, 1);
    r->errors.solved_noise = 1.0 / sqrt((double)patches->packet_count * ALPI_PACKET);
    ALP_TRY(start_direct(r));
    if (s->piloted) {
        ALP_TRY(alpi_light_run_pilot(r, &rays));
    }
    alpi_light_clock_part(light->clock, true, more && !s->piloted ? 1.0 : 0.0);
    const alpi_light_fresh into = {light->values, r->skies, light->directional};
    ALP_TRY(alpi_light_gather(r, rays, &into));
    r->rays.per_texel = r->rays.most = rays;
    light->job->report.light_samples =
        r->fixed != NULL ? r->fixed->packet_count * ALPI_PACKET : rays;
    return alpi_light_measure(r, light->order, light->count);
}

// --- the rounds after it -------------------------------------------------------------------------

static alp_result start_rounds(alpi_light_rounds *r)
{
    const alpi_light_bake *light = r->light;
    alp_context *context = light->job->context;
    const uint32_t texels = light->receivers->count;
    const alpi_held_out *h = r->interpolated.held_out;
    if (r->skies != NULL) {
        ALPI_TRY_NEW(context, r->fresh.skies, texels);
    }
    ALPI_TRY_NEW(context, r->interpolated.marks, texels);
    ALPI_TRY_NEW(context, r->rays.of_texels, texels);
    if (light->job->options.light.error > 0.0f) {
        ALPI_TRY_NEW(context, r->worst.marks, texels);
        ALPI_TRY_NEW(context, r->worst.list, light->count + 1);
    }
    ALPI_TRY_NEW(context, r->interpolated.means, h->count);
    memcpy(r->interpolated.means, h->values, h->count * sizeof *h->values);
    note_interpolated(r);
    for (uint32_t i = 0; i < light->count; i++) {
        r->rays.of_texels[light->order[i]] = r->rays.per_texel;
    }
    return ALP_OK;
}

static alp_result run_others(alpi_light_rounds *r)
{
    const bool timed = !(r->light->job->options.light.error > 0.0f);
    const uint32_t limit = timed ? TIMED_ROUND_LIMIT : ROUND_LIMIT;
    ALP_TRY(start_rounds(r));
    for (bool done = false; !done && r->number < limit;) {
        alpi_light_plan plan;
        ALP_TRY(alpi_light_plan_round(r, &plan));
        if (plan.direct <= 0.0 && plan.rays <= 0.0) {
            return ALP_OK;
        }
        ALP_TRY(run_round(r, &plan, &done));
    }
    return ALP_OK;
}

/// Whether a round that was cut off may be dropped.
static bool may_be_dropped(const alpi_light_rounds *r)
{
    const alpi_light_clock *c = r->light->clock;
    return c->refused ? r->light->job->options.sampling.keep_partial : alpi_light_clock_is_late(c);
}

static alp_result warn_of_error(alpi_light_rounds *r)
{
    alpi_bake_job *job = r->light->job;
    const double goal = (double)job->options.light.error;
    const alpi_relative_error *e = &r->errors.map.over_scale;
    if (r->cut_off || (goal > 0.0 && isnan(e->p99))) {
        ALP_TRY(alpi_light_measure_map(r));
    }
    job->report.cut_off = job->report.cut_off || r->cut_off;
    if (r->limited && (e->rms > goal || e->p99 > ALPI_P99_LIMIT * goal)) {
        job->report.light_bounded = true;
    }
    alpi_light_warn(job, e, r->cut_off, r->rays.most, r->direct.most);
    return ALP_OK;
}

alp_result alpi_light_run_rounds(alpi_light_rounds *r)
{
    alpi_light_bake *light = r->light;
    ALP_TRY(run_first(r));
    if (!light->settings.in_rounds) {
        return ALP_OK;
    }
    alp_result result = run_others(r);
    if (result == ALP_ERROR_CANCELLED && may_be_dropped(r)) {
        r->cut_off = true;
        light->clock->ended = true; // the callback would cancel what is kept
        result = alpi_light_measure(r, light->order, light->count);
    }
    if (result == ALP_OK) {
        const bool ended = light->clock->ended;
        light->clock->ended = true; // whole rounds must not be lost now
        result = warn_of_error(r);
        light->clock->ended = ended;
    }
    return result;
}

// --- memory --------------------------------------------------------------------------------------

void alpi_light_rounds_trim(alpi_light_rounds *r)
{
    alp_context *context = r->light->job->context;
    void *const arrays[] = {r->states,
                            r->fresh.values,
                            r->fresh.skies,
                            r->fresh.directional,
                            r->direct.counts,
                            r->rays.of_texels,
                            r->worst.marks,
                            r->worst.list,
                            r->interpolated.marks,
                            r->interpolated.means,
                            r->interpolated.held_out};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        alpi_release(context, arrays[i]);
    }
    r->states = NULL;
    r->fresh = (alpi_light_fresh){0};
    r->direct = (alpi_light_direct){0};
    r->rays.of_texels = NULL;
    r->worst = (alpi_light_worst){0};
    r->interpolated = (alpi_light_interpolated){0};
}

void alpi_light_rounds_clear(alpi_light_rounds *r)
{
    alpi_light_rounds_trim(r);
    alpi_release(r->light->job->context, r->skies);
    r->skies = NULL;
}
