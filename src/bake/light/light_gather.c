// SPDX-License-Identifier: MIT
#include "bake/light/light_gather.h"

#include "bake/light/light_layers.h"
#include "bake/settings.h"
#include "base/random.h"
#include "base/tasks.h"
#include "maps/radiosity/patch_reach.h"

#include <math.h>
#include <string.h>

/// Rays go on as paths if they hit a surface nearer than this times the size of its cells
/// (patch_reach.h). On teapot-room at 1 %, 2 and 4 took longer and had no smaller error.
static const float NEAR_REACH = 1.0f;
/// Bounces of such a path, with the ray that hit: in corners it meets near surfaces again. On
/// builtin:windows 8 gain no accuracy.
enum { NEAR_BOUNCES = 4 };

// --- rays ----------------------------------------------------------------------------------------

/// Makes rays that hit near surfaces go on as paths (near_rays.h). Three exceptions:
/// - Layers: direct light at a hit is that of all lights, but layers must add up to the whole.
/// - A number of bounces: cells hold all bounces but the last, paths all but the last two.
/// - Hemicubes: their pixels have no noise; paths would add it.
static void start_near_rays(const alpi_light_rounds *r, alpi_gather_scene *from,
                            alpi_reference *near)
{
    const alpi_radiosity_options *o = &r->solution->options;
    if (r->fixed != NULL || o->layers != NULL || o->bounces <= ALPI_RADIOSITY_PASS_LIMIT ||
        o->direct_scene != NULL) {
        return;
    }
    *near = (alpi_reference){.context = r->light->job->context,
                             .scene = r->light->job->scene,
                             .tracer = r->light->tracer,
                             .lighting = r->light->sources.near,
                             .filter = o->filter,
                             .bounces = NEAR_BOUNCES,
                             .next_event = true,
                             .known = &from->light,
                             .known_reach = NEAR_REACH};
    from->near = near;
    from->near_reach = NEAR_REACH;
}

void alpi_light_tracing_start(const alpi_light_rounds *r, uint32_t rays, uint64_t seed,
                              alpi_light_tracing *t)
{
    const alpi_bake_job *job = r->light->job;
    t->from = alpi_radiosity_scene(r->solution);
    start_near_rays(r, &t->from, &t->near);
    t->cosine = (alpi_cosine_rays){
        .context = job->context,
        .samples = rays,
        .replicates = ALPI_LIGHT_REPLICATES,
        .joined = true,
        .seed = seed,
    };
    t->others = t->cosine;
    t->others.seed = alpi_hash64(~seed);
    t->own = alpi_cosine_rays_gatherer(&t->cosine);
    t->independent = alpi_cosine_rays_gatherer(&t->others);
    t->gather =
        (alpi_gather_job){.context = job->context,
                          .from = &t->from,
                          .gatherer = r->fixed != NULL ? r->fixed : &t->own,
                          .receivers = r->light->receivers,
                          .directional_without_sky = job->options.light.direct == ALP_DIRECT_OFF};
}

uint32_t alpi_light_ray_count(double rays)
{
    return alpi_cosine_rays_samples((uint32_t)ceil(rays), ALPI_LIGHT_REPLICATES);
}

uint64_t alpi_light_round_seed(const alpi_light_rounds *r, bool direct)
{
    enum { FIRST_OF_DIRECT = 1 << 16 };
    const uint32_t round = r->number + (direct ? FIRST_OF_DIRECT : 0);
    return alpi_hash64(alpi_hash64(r->light->job->options.occlusion.seed) + round);
}

// --- the light they read -------------------------------------------------------------------------

alp_result alpi_light_relight(const alpi_light_rounds *r, uint32_t rays, double *noise)
{
    const alpi_light_bake *light = r->light;
    const alpi_radiosity *solution = r->solution;
    const alpi_radiosity_options *o = &solution->options;
    alpi_task_progress silent = light->progress; // far shorter than the gather that follows
    silent.silent = true;
    const double by_patch = (double)o->gatherer->packet_count * ALPI_PACKET;
    const double by_texels = (double)rays * (double)light->job->report.light_traced /
                             fmax((double)solution->patches.patch_count, 1.0);
    const bool finer = solution->texels == NULL && o->layers == NULL &&
                       o->bounces > ALPI_RADIOSITY_PASS_LIMIT && by_texels >= by_patch;
    *noise = 1.0 / sqrt(finer ? by_texels : by_patch);
    if (solution->texels != NULL) {
        return ALP_OK;
    }
    ALP_TRY(alpi_radiosity_relight(solution, ALPI_NONE, finer ? light->values : NULL, &silent));
    return alpi_patches_set_reach(&solution->patches, &silent);
}

// --- a round -------------------------------------------------------------------------------------

const uint32_t *alpi_light_tracing_texels(const alpi_light_rounds *r, uint32_t *count)
{
    const bool few = r->worst.count > 0;
    *count = few ? r->worst.count : r->light->count;
    return few ? r->worst.list : r->light->order;
}

/// Notes the cost of a round of all texels.
static void note_round(alpi_light_rounds *r, const alpi_final_gather_report *report, uint32_t rays,
                       double seconds)
{
    r->rays.seconds = seconds / ((double)rays * fmax((double)report->traced, 1.0));
    r->rays.factor = report->factor;
    r->rays.traced = (double)report->traced;
    r->rays.power = ALPI_LIGHT_RAYS_POWER;
    r->light->job->report.light_traced = report->traced;
    r->light->job->report.light_interpolated = report->interpolated;
}

alp_result alpi_light_gather(alpi_light_rounds *r, uint32_t rays, const alpi_light_fresh *into)
{
    alpi_light_bake *light = r->light;
    alpi_bake_job *job = light->job;
    const bool all = r->worst.count == 0;
    uint8_t *states = all ? r->states : r->worst.marks;
    alpi_held_out *held_out = r->interpolated.held_out;
    alpi_light_tracing tracing = {.near = {0}};
    alpi_light_tracing_start(r, rays, alpi_light_round_seed(r, false), &tracing);
    tracing.gather.values = into->values;
    tracing.gather.skies = into->skies;
    tracing.gather.directional = into->directional;
    alpi_final_gather_options options = {
        .gather = &tracing.gather,
        .proximity = job->gathering.validity.proximity,
        .adaptive = all && light->settings.adaptive,
        .held_out = all && (r->rays.per_texel == 0 || held_out->count > 0) ? held_out : NULL,
        .independent = &tracing.independent,
        .joined = r->fixed == NULL,
        .means = alpi_bake_wants_occlusion(&job->options) ? NULL : light->lattice->values,
    };
    options.order = alpi_light_tracing_texels(r, &options.count);
    if (!all) {
        memset(states, 0, light->receivers->count);
    }
    alpi_final_gather_report report = {.traced = job->report.light_traced,
                                       .factor = r->rays.factor};
    const uint32_t sent = tracing.gather.gatherer->packet_count * ALPI_PACKET;
    const double began = alpi_seconds();
    ALP_TRY(alpi_final_gather(&options, light->lattice, &light->progress, states, &report));
    if (all) {
        note_round(r, &report, sent, alpi_seconds() - began);
    }
    job->report.rays += report.rays;
    r->rays.sent += (double)report.rays * (1.0 + job->layers.light.count);
    job->report.light_rounds++;
    return alpi_light_gather_layers(r, &options, states, sent);
}
