// SPDX-License-Identifier: MIT
// Rays of a round meet the light that is known by then, and go on from near surfaces.
#include "bake/light/light_rays.h"

#include "base/random.h"
#include "maps/radiosity/patch_reach.h"

#include <math.h>

/// Rays go on that meet something nearer than so many sides of its cells (patch_reach.h). Measured
/// on teapot-room for 1 %: 2 and 4 took longer and erred no less.
static const float NEAR_REACH = 1.0f;
/// Bounces of such a path, with the ray that arrived: in a corner it too meets near surfaces. 8
/// gain no accuracy on windows (docs/how/light.md, "Near surfaces").
enum { BOUNCES = 4 };

/// Has rays of texels go on from what is near (near_rays.h). Not
/// - of layers: the light of a point is asked of all lights together, and layers shall sum to it;
/// - of a number of bounces: cells hold all but the last, and from a point on it is the last but
/// one;
/// - by hemicubes: what their pixels see has no noise, and a path for each of the few that are near
///   would be all there is.
/// @param from what they meet; in these cases it is left as it is
/// @param near out: how they do; from then on of `from`
static void go_on_from_near(const alpi_bake_job *job, const alpi_light_task *task,
                            const alpi_radiosity *solution, alpi_gather_scene *from,
                            alpi_reference *near)
{
    const alpi_radiosity_options *o = &solution->options;
    if (o->layers != NULL || o->bounces <= ALPI_RADIOSITY_PASS_LIMIT || o->direct_scene != NULL) {
        return;
    }
    *near = (alpi_reference){.context = job->context,
                             .scene = job->scene,
                             .tracer = task->tracer,
                             .lighting =
                                 task->near_lighting != NULL ? task->near_lighting : task->lighting,
                             .filter = o->filter,
                             .bounces = BOUNCES,
                             .next_event = true,
                             .known = &from->light,
                             .known_reach = NEAR_REACH};
    from->near = near;
    from->near_reach = NEAR_REACH;
}

uint32_t alpi_light_ray_count(double rays)
{
    return alpi_cosine_rays_samples((uint32_t)ceil(rays), ALPI_LIGHT_REPLICATES);
}

void alpi_light_rays_start(const alpi_light_round_state *r, uint32_t rays, uint64_t seed,
                           alpi_light_rays *by)
{
    const alpi_bake_job *job = r->job;
    by->from = alpi_radiosity_scene(r->solution);
    if (r->fixed == NULL) {
        go_on_from_near(job, r->task, r->solution, &by->from, &by->near);
    }
    by->cosine = (alpi_cosine_rays){
        .context = job->context,
        .samples = rays,
        .replicates = ALPI_LIGHT_REPLICATES,
        .joined = true,
        .seed = seed,
    };
    by->others = by->cosine;
    by->others.seed = alpi_hash64(~seed);
    by->own = alpi_cosine_rays_gatherer(&by->cosine);
    by->beside = alpi_cosine_rays_gatherer(&by->others);
    by->gather =
        (alpi_gather_job){.context = job->context,
                          .from = &by->from,
                          .gatherer = r->fixed != NULL ? r->fixed : &by->own,
                          .receivers = r->task->receivers,
                          .directional_without_sky = job->options.light.direct == ALP_DIRECT_OFF};
}

uint64_t alpi_light_round_seed(const alpi_light_round_state *r, bool direct)
{
    enum { FIRST_OF_DIRECT = 1 << 16 };
    const uint32_t round = r->number + (direct ? FIRST_OF_DIRECT : 0);
    return alpi_hash64(alpi_hash64(r->job->options.occlusion.seed) + round);
}

alp_result alpi_light_show(const alpi_bake_job *job, const alpi_light_task *task,
                           const alpi_radiosity *solution, uint32_t rays, double *noise)
{
    const alpi_radiosity_options *o = &solution->options;
    const double by_block = (double)o->gatherer->packet_count * ALPI_PACKET;
    const double by_texels = (double)rays * (double)job->report.light_traced /
                             fmax((double)solution->patches.patch_count, 1.0);
    const bool finer = solution->texels == NULL && o->layers == NULL &&
                       o->bounces > ALPI_RADIOSITY_PASS_LIMIT && by_texels >= by_block;
    *noise = 1.0 / sqrt(finer ? by_texels : by_block);
    if (solution->texels != NULL) {
        return ALP_OK;
    }
    ALP_TRY(
        alpi_radiosity_relight(solution, ALPI_NONE, finer ? task->values : NULL, &task->progress));
    return alpi_patches_set_reach(&solution->patches, &task->progress);
}
