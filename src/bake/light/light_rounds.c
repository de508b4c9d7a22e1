// SPDX-License-Identifier: MIT
// Rounds of rays: direct and bounced light are gathered apart, and get as many more samples as
// bring both together to the error that was asked for at the least cost: bounced light as many for
// each texel, direct light by its noise (light_more_direct.c). Then the texels that err most get
// more alone (light_next.c). Rounds have random numbers of their own; what they find is averaged by
// their numbers of samples.
//
// With shares wᵢ of the samples and errors bᵢ + eᵢ of the rounds, bᵢ the bias of interpolation and
// eᵢ noise, a texel's squared error is
//
//     E[(Σ wᵢ (bᵢ + eᵢ))²] = (Σ wᵢ bᵢ)² + Σ wᵢ² Var eᵢ
//
// Noise falls with the number of rounds. Bias does not: the same texels between the same others
// miss the same light in each. So what was ever interpolated cannot be told from the errors of
// single rounds: some texels, held out, are gathered beside the map in each round, x̂ = Σ wᵢ yᵢ, and
// the mean over them of (x − x̂)² − Var x̂ is the squared error of the whole, whatever it is made of.
#include "bake/layers.h"
#include "bake/light/light_rays.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/radiosity/final_gather.h"

#include <math.h>
#include <string.h>

enum {
    FIRST_DIRECT = 8, // samples, where there are rounds
    ROUND_LIMIT = 12,
    TIMED_ROUND_LIMIT = 64 // each adds about as much as there is, or ends with the time
};
// Of the time that is left, what a round may take: how long it takes is a guess.
static const double TIME_SHARE = 0.9;

/// Without rounds, as many as make direct light's error the smaller one of the two by a half:
/// measured on the Cornell box, 64 beside 128 rays, and 128 beside 512. Beside fewer rays fewer pay
/// there, and not where light comes through windows.
uint32_t alpi_light_first_direct(const alpi_bake_job *job)
{
    enum { DIRECT_SAMPLES = 64, MOST_DIRECT = 512, RAYS = 128 };
    uint32_t samples = DIRECT_SAMPLES;
    if (alpi_light_has_rounds(&job->options)) {
        return FIRST_DIRECT;
    }
    while (samples < MOST_DIRECT &&
           pow(samples * 2.0 / DIRECT_SAMPLES, 2.0) * RAYS <= job->options.light.samples) {
        samples *= 2;
    }
    return samples;
}

// --- one round -----------------------------------------------------------------------------------

/// Texels that send rays in this round.
static const uint32_t *senders(const alpi_light_round_state *r, uint32_t *count)
{
    const bool few = r->worst.count > 0;
    *count = few ? r->worst.count : r->task->count;
    return few ? r->worst.list : r->task->order;
}

/// Maps what the senders of this round gather, by texels that rays are traced from and others.
static alp_result map_bounced(alpi_light_round_state *r, const alpi_gather_job *gather,
                              const alpi_gatherer *beside)
{
    alpi_bake_job *job = r->job;
    const alpi_light_task *t = r->task;
    const bool all = r->worst.count == 0;
    const uint32_t rays = gather->gatherer->packet_count * ALPI_PACKET;
    uint8_t *states = all ? r->states : r->worst.marks;
    alpi_final_gather_options options = {
        .gather = gather,
        .proximity = job->gathering.validity.proximity,
        .adaptive = all && alpi_light_is_adaptive(&r->job->options),
        .straight = true,
        .held_out = all && (r->rays == 0 || r->held_out->count > 0) ? r->held_out : NULL,
        .independent = beside,
        .joined = r->fixed == NULL,
        .levels = alpi_bake_wants_occlusion(&job->options) ? NULL : t->lattice->values,
    };
    options.order = senders(r, &options.count);
    if (!all) { // none but those of the list has a state
        memset(states, 0, t->receivers->count);
    }
    // As in the round of all before.
    alpi_final_gather_report report = {.traced = job->report.light_traced, .factor = r->factor};
    const double began = alpi_seconds();
    ALP_TRY(alpi_final_gather(&options, t->lattice, &t->progress, states, &report));
    if (all) {
        const double sent = (double)rays * fmax((double)report.traced, 1.0);
        r->ray_seconds = (alpi_seconds() - began) / sent;
        r->factor = report.factor;
        r->sending = (double)report.traced;
        r->rays_power = ALPI_LIGHT_RAYS_POWER;
        job->report.light_traced = report.traced;
        job->report.light_interpolated = report.interpolated;
    }
    job->report.rays += report.rays;
    r->sent += (double)report.rays * (1.0 + job->layers.light.count);
    job->report.light_rounds++;
    return alpi_bake_gather_layers(job, r->solution, &options, t->lattice, states, r->rays_of, rays,
                                   &t->progress);
}

/// Bounced light by `rays` more of each texel that sends any.
static alp_result gather_bounced(alpi_light_round_state *r, uint32_t rays,
                                 alpi_reference_value *values, float (*skies)[3],
                                 alpi_directional *directional)
{
    alpi_light_rays by;
    alpi_light_rays_start(r, rays, alpi_light_round_seed(r, false), &by);
    by.gather.values = values;
    by.gather.skies = skies;
    by.gather.directional = directional;
    return map_bounced(r, &by.gather, &by.beside);
}

void alpi_light_merge(alpi_reference_value *v, const alpi_reference_value *fresh, double had,
                      double more)
{
    const float a = (float)(had / (had + more)), b = (float)(more / (had + more));
    for (int k = 0; k < 3; k++) {
        v->mean[k] = a * v->mean[k] + b * fresh->mean[k];
        v->variance[k] = a * a * v->variance[k] + b * b * fresh->variance[k];
    }
}

/// The same of light by direction, where it is wanted.
static void mix(const alpi_light_round_state *r, alpi_directional *directional, uint32_t texel,
                double had, double more)
{
    if (directional != NULL) {
        alpi_directional_mix(&directional[texel], (float)(had / (had + more)),
                             &r->fresh_directional[texel], (float)(more / (had + more)));
    }
}

static void note_interpolated(const alpi_light_round_state *r)
{
    for (uint32_t i = 0; i < r->task->count; i++) {
        const uint32_t t = r->task->order[i];
        r->between[t] |= r->states[t] == ALPI_TEXEL_INTERPOLATED;
    }
}

/// States the squared error of what was ever interpolated; see above.
static void merge_held_out(const alpi_light_round_state *r, uint32_t rays)
{
    const alpi_held_out *h = r->held_out;
    float variance[3];
    note_interpolated(r);
    for (uint32_t i = 0; i < h->count; i++) {
        alpi_light_merge(&r->held[i], &h->values[i], r->rays, rays);
    }
    if (h->count == 0) { // nothing was in the first round: each round tells its own
        return;
    }
    alpi_held_out_error(h->texels, r->held, h->count, r->task->values, variance);
    for (uint32_t i = 0; i < r->task->count; i++) {
        const uint32_t t = r->task->order[i];
        if (r->between[t] != 0) {
            memcpy(r->task->values[t].variance, variance, sizeof variance);
        }
    }
}

static alp_result add_bounced(alpi_light_round_state *r, uint32_t rays)
{
    double noise;
    uint32_t count;
    const uint32_t *order = senders(r, &count);
    ALP_TRY(alpi_light_show(r->job, r->task, r->solution, r->rays, &noise));
    ALP_TRY(gather_bounced(r, rays, r->fresh, r->fresh_skies, r->fresh_directional));
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t t = order[i];
        const double had = r->rays_of[t];
        const float b = (float)(rays / (had + rays));
        alpi_light_merge(&r->task->values[t], &r->fresh[t], had, rays);
        mix(r, r->task->directional, t, had, rays);
        for (int k = 0; k < 3 && r->skies != NULL; k++) {
            r->skies[t][k] += b * (r->fresh_skies[t][k] - r->skies[t][k]);
        }
        r->rays_of[t] += rays;
        r->most_rays = r->rays_of[t] > r->most_rays ? r->rays_of[t] : r->most_rays;
    }
    if (r->worst.count == 0) {
        merge_held_out(r, rays);
        r->solved_noise += rays / ((double)r->rays + rays) * (noise - r->solved_noise);
        r->rays += rays;
        r->job->report.light_samples = r->rays;
    }
    return ALP_OK;
}

// --- what comes next -----------------------------------------------------------------------------

/// The rays that are left of those. A sample of direct light counts as one even where it aims at
/// nothing and traces none.
static double rays_left(const alpi_light_round_state *r)
{
    return fmax(r->ray_limit - r->sent - r->direct.drawn, 0.0);
}

/// Cuts a round to the rays that are left. @param listed, sending texels that get either
static void keep_ray_limit(alpi_light_round_state *r, double listed, double sending, double *direct,
                           double *rays)
{
    const double left = rays_left(r);
    const double wanted = listed * *direct + sending * *rays;
    if (wanted > left) {
        const double share = left / wanted;
        *direct = share * *direct >= 0.125 * alpi_light_typical_samples(&r->direct)
                      ? share * *direct
                      : 0.0;
        *rays = share * *rays >= 0.125 * r->rays ? share * *rays : 0.0;
        r->limited = true;
    }
}

/// As many of `samples` as there is time for; 0 where they would be too few to help those there
/// are.
static double affordable(const alpi_light_round_state *r, double samples, double seconds_each,
                         double there)
{
    const double left = TIME_SHARE * (r->task->clock->deadline - alpi_seconds());
    const double most = isinf(left) ? samples : fmin(samples, fmax(left, 0.0) / seconds_each);
    return most < samples && most < there / 8.0 ? 0.0 : most;
}

static alp_result measure(alpi_light_round_state *r)
{
    return alpi_light_round_measure(r, r->task->order, r->task->count);
}

/// One more round of what is too noisy.
/// @param done out: nothing is, or nothing helps, or the time is over
static alp_result improve(alpi_light_round_state *r, bool *done)
{
    alpi_light_plan p;
    ALP_TRY(alpi_light_round_plan(r, &p));
    double direct = p.direct, rays = p.rays;
    if (direct <= 0.0 && rays <= 0.0) {
        *done = true;
        return ALP_OK;
    }
    r->number++;
    const double listed = fmax(p.noisy * (double)r->task->count, 1.0); // texels, about
    uint32_t count;
    (void)senders(r, &count);
    const double sending = fmin(count, r->sending);
    keep_ray_limit(r, listed, sending, &direct, &rays);
    if (direct <= 0.0 && rays <= 0.0) {
        *done = true;
        return ALP_OK;
    }
    const double direct_asked = direct, rays_asked = rays;
    bool dealt = false;
    const double each = listed * r->direct.seconds * (rays > 0.0 ? 2.0 : 1.0);
    direct = affordable(r, direct, each, alpi_light_typical_samples(&r->direct));
    if (direct > 0.0) {
        const alpi_light_goal goal = {
            .wanted = p.for_direct * r->scale,
            .each = r->for_worst,
            .among = r->for_worst ? r->worst.marks : NULL,
            .most = isinf(r->task->clock->deadline) && !r->limited ? rays_left(r) : direct * listed,
            .seed = alpi_light_round_seed(r, true)};
        alpi_light_clock_part(r->task->clock, false, rays > 0.0 ? 1.0 : 0.0);
        ALP_TRY(alpi_light_more_direct(&r->direct, &goal, &dealt));
    }
    rays = affordable(r, rays, r->ray_seconds * sending, r->rays);
    if (rays > 0.0) {
        alpi_light_clock_part(r->task->clock, true, 0.0);
        ALP_TRY(add_bounced(r, alpi_light_ray_count(rays)));
    }
    if (direct < direct_asked || rays < rays_asked) { // the clock had a say
        r->cut_off = true;
    }
    if (direct <= 0.0 && rays <= 0.0) { // no time for more
        *done = r->cut_off = true;
    }
    *done = *done || (!dealt && rays <= 0.0); // all that are noisy have as many as they may
    const double before = r->direct_error * r->scale;
    ALP_TRY(measure(r));
    if (direct > 0.0 && !r->for_worst) {
        r->direct.power = alpi_light_power(r->direct.power, r->direct.foreseen / before,
                                           r->direct_error * r->scale / before);
    }
    return ALP_OK;
}

// --- all of them ---------------------------------------------------------------------------------

/// What samples of direct light take that are added to those of the solution.
static alp_result start_direct(alpi_light_round_state *r)
{
    alp_context *context = r->job->context;
    const uint32_t texels = r->task->receivers->count;
    ALPI_TRY_NEW(context, r->fresh, texels);
    if (r->task->directional != NULL) {
        ALPI_TRY_NEW(context, r->fresh_directional, texels);
    }
    ALPI_TRY_NEW(context, r->direct.counts, texels);
    r->direct.fresh = r->fresh;
    r->direct.fresh_directional = r->fresh_directional;
    for (uint32_t i = 0; i < r->task->count; i++) {
        r->direct.counts[r->task->order[i]] = r->direct.most;
    }
    return ALP_OK;
}

/// The first round, without which there is nothing.
static alp_result begin(alpi_light_round_state *r)
{
    alp_context *context = r->job->context;
    const uint32_t texels = r->task->receivers->count;
    const uint32_t direct = r->solution->options.direct_samples;
    const bool rounds = alpi_light_has_rounds(&r->job->options);
    uint32_t rays = alpi_light_round_most_rays(&r->job->options.light);
    const bool more = rounds && rays > ALPI_LIGHT_FIRST_RAYS;
    ALPI_TRY_NEW(context, r->task->values, texels);
    if (alpi_radiosity_scene(r->solution).sky) {
        ALPI_TRY_NEW(context, r->skies, texels);
    }
    ALPI_TRY_NEW(context, r->states, texels);
    ALPI_TRY_NEW(context, r->held_out, 1);
    r->solved_noise = 1.0 / sqrt((double)r->solution->options.gatherer->packet_count * ALPI_PACKET);
    r->direct = (alpi_light_direct){.job = r->job,
                                    .task = r->task,
                                    .solution = r->solution,
                                    .values = r->solution->direct,
                                    .most = direct,
                                    .limit = rays,
                                    .power = ALPI_LIGHT_FIRST_POWER,
                                    .seconds = r->solution->direct_seconds /
                                               (direct * fmax(r->task->count, 1.0))};
    if (rounds) {
        ALP_TRY(start_direct(r));
    }
    if (more) {
        ALP_TRY(alpi_light_prepare_first(r, &rays));
    }
    const bool planned = r->sending > 0.0; // to be the last one
    alpi_light_clock_part(r->task->clock, true, more && !planned ? 1.0 : 0.0);
    ALP_TRY(gather_bounced(r, rays, r->task->values, r->skies, r->task->directional));
    r->rays = r->most_rays = rays;
    r->job->report.light_samples = r->fixed != NULL ? r->fixed->packet_count * ALPI_PACKET : rays;
    return measure(r);
}

static alp_result go_on(alpi_light_round_state *r)
{
    alp_context *context = r->job->context;
    const uint32_t texels = r->task->receivers->count;
    const bool timed = !(r->job->options.light.error > 0.0f);
    const uint32_t limit = timed ? TIMED_ROUND_LIMIT : ROUND_LIMIT;
    if (r->skies != NULL) {
        ALPI_TRY_NEW(context, r->fresh_skies, texels);
    }
    ALPI_TRY_NEW(context, r->between, texels);
    ALPI_TRY_NEW(context, r->rays_of, texels);
    if (!timed) {
        ALPI_TRY_NEW(context, r->worst.marks, texels);
        ALPI_TRY_NEW(context, r->worst.list, r->task->count + 1);
    }
    ALPI_TRY_NEW(context, r->held, r->held_out->count);
    memcpy(r->held, r->held_out->values, r->held_out->count * sizeof *r->held);
    note_interpolated(r);
    for (uint32_t i = 0; i < r->task->count; i++) {
        r->rays_of[r->task->order[i]] = r->rays;
    }
    for (bool done = false; !done && r->number < limit;) {
        ALP_TRY(improve(r, &done));
    }
    return ALP_OK;
}

/// Whether a round that was cut off may be left out.
static bool may_be_dropped(const alpi_light_round_state *r)
{
    const alpi_light_clock *c = r->task->clock;
    return c->refused ? r->job->options.sampling.keep_partial : alpi_light_clock_is_late(c);
}

static alp_result warn_of_error(alpi_light_round_state *r)
{
    const bool wanted = r->job->options.light.error > 0.0f;
    if (r->cut_off || (wanted && isnan(r->map.over_scale.p99))) {
        ALP_TRY(alpi_light_round_look(r));
    }
    r->job->report.cut_off = r->job->report.cut_off || r->cut_off;
    const alpi_relative_error *e = &r->map.over_scale;
    const double goal = (double)r->job->options.light.error;
    if (r->limited && (e->rms > goal || e->p99 > ALPI_P99_LIMIT * goal)) {
        r->job->report.light_bounded = true;
    }
    alpi_light_warn(r->job, &r->map.over_scale, r->cut_off, r->most_rays, r->direct.most);
    return ALP_OK;
}

static alp_result run_rounds(alpi_light_round_state *r)
{
    ALP_TRY(begin(r));
    if (!alpi_light_has_rounds(&r->job->options)) {
        return ALP_OK;
    }
    alp_result result = go_on(r);
    if (result == ALP_ERROR_CANCELLED && may_be_dropped(r)) {
        r->cut_off = true;
        r->task->clock->ended = true; // asked again it would cancel what it wanted kept
        result = measure(r);
    }
    if (result == ALP_OK) {
        const bool ended = r->task->clock->ended;
        r->task->clock->ended = true; // there are whole rounds, too late to lose them
        result = warn_of_error(r);
        r->task->clock->ended = ended;
    }
    return result;
}

// --- the end -------------------------------------------------------------------------------------

/// What only rounds need.
static void release_rounds(alpi_light_round_state *r)
{
    alp_context *context = r->job->context;
    alpi_release(context, r->fresh);
    alpi_release(context, r->fresh_skies);
    alpi_release(context, r->fresh_directional);
    alpi_release(context, r->direct.counts);
    alpi_release(context, r->between);
    alpi_release(context, r->rays_of);
    alpi_release(context, r->worst.marks);
    alpi_release(context, r->worst.list);
    alpi_release(context, r->held);
    alpi_release(context, r->held_out);
    r->between = NULL;
    r->rays_of = NULL;
    r->worst = (alpi_light_worst){0};
    r->held = NULL;
    r->held_out = NULL;
    r->fresh_directional = NULL;
    r->fresh = NULL;
    r->fresh_skies = NULL;
    r->direct.counts = NULL;
}

alp_result alpi_light_rounds(alpi_bake_job *job, alpi_light_task *task, const alpi_gatherer *fixed,
                             alpi_radiosity *solution)
{
    alpi_light_round_state r = {.job = job, .task = task, .fixed = fixed, .solution = solution};
    r.ray_limit = alpi_light_ray_limit(job, task->count);
    alp_result result = run_rounds(&r);
    release_rounds(&r);
    if (result == ALP_OK && job->options.light.denoise) {
        result = alpi_light_denoise(job, task, r.skies);
    }
    if (result == ALP_OK) {
        result = alpi_light_sum(job, task, solution, (const float(*)[3])r.skies,
                                alpi_light_round_solved_share(&r));
    }
    alpi_release(job->context, r.skies);
    alpi_release(job->context, r.states);
    return result;
}
