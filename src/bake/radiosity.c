// SPDX-License-Identifier: MIT
// The radiosity of a bake: solved on blocks of texels, then gathered once more from every texel.
#include "bake/light.h"

#include "base/random.h"
#include "base/tasks.h"
#include "maps/radiosity.h"
#include "transport/cosine_rays.h"
#include "transport/hemicube.h"

#include <math.h>

enum { BLOCK_CUBE = 16, REPLICATES = 4 };

/// How blocks gather, and how texels do.
typedef struct light_gatherers {
    alpi_cosine_rays block_rays, texel_rays;
    alpi_hemicube *block_cube, *texel_cube; // or NULL
    alpi_hemicube_options block_cubes, texel_cubes;
    alpi_gatherer blocks, texels;
} light_gatherers;

static alp_result make_hemicubes(const alpi_bake_job *job, uint64_t seed, light_gatherers *g)
{
    const uint32_t n = job->options.light.hemicube;
    ALP_TRY(alpi_hemicube_create(job->context, n, &g->texel_cube));
    ALP_TRY(alpi_hemicube_create(job->context, n < BLOCK_CUBE ? n : BLOCK_CUBE, &g->block_cube));
    g->texel_cubes = (alpi_hemicube_options){
        .context = job->context, .cube = g->texel_cube, .turned = true, .seed = seed};
    g->block_cubes = g->texel_cubes;
    g->block_cubes.cube = g->block_cube;
    g->block_cubes.scattered = true;
    g->blocks = alpi_hemicube_gatherer(&g->block_cubes);
    g->texels = alpi_hemicube_gatherer(&g->texel_cubes);
    return ALP_OK;
}

static alp_result make_gatherers(const alpi_bake_job *job, light_gatherers *g)
{
    const alp_light_options *o = &job->options.light;
    const uint64_t seed = job->options.occlusion.seed;
    *g = (light_gatherers){0};
    if (o->gather == ALP_GATHER_HEMICUBE) {
        return make_hemicubes(job, seed, g);
    }
    g->block_rays = (alpi_cosine_rays){.context = job->context,
                                       .samples = ALPI_RADIOSITY_BLOCK_RAYS,
                                       .replicates = 1,
                                       .seed = seed};
    g->texel_rays = (alpi_cosine_rays){.context = job->context,
                                       .samples = alpi_cosine_rays_samples(o->samples, REPLICATES),
                                       .replicates = REPLICATES,
                                       .seed = alpi_hash64(seed)};
    g->blocks = alpi_cosine_rays_gatherer(&g->block_rays);
    g->texels = alpi_cosine_rays_gatherer(&g->texel_rays);
    return ALP_OK;
}

static void report_solution(alpi_bake_job *job, const alpi_radiosity *solution)
{
    const alpi_energy *e = &solution->energy;
    alp_bake_report *r = &job->report;
    const uint32_t most = sizeof r->light_changes / sizeof *r->light_changes;
    r->rays += solution->rays;
    r->light_passes = solution->passes;
    r->light_energy = (alp_light_energy){e->known,   e->emitted,     e->absorbed,
                                         e->escaped, e->lost_behind, e->unshot};
    for (uint32_t i = 0; i < solution->passes && i < most; i++) {
        r->light_changes[i] = solution->changes[i];
    }
}

/// The last bounce, gathered from the texels themselves.
static alp_result gather_texels(alpi_bake_job *job, const alpi_light_task *t,
                                const alpi_gatherer *gatherer, const alpi_radiosity *solution)
{
    const alpi_gather_scene from = alpi_radiosity_scene(solution);
    const alpi_gather_job gather = {.context = job->context,
                                    .from = &from,
                                    .gatherer = gatherer,
                                    .receivers = t->receivers,
                                    .list = t->order,
                                    .count = t->count,
                                    .values = t->values};
    job->report.light_samples = gatherer->packet_count * ALPI_PACKET;
    job->report.rays += (uint64_t)t->count * job->report.light_samples;
    return alpi_gather_irradiance(&gather, &t->progress);
}

/// Adds direct light to bounced light, and keeps them apart where that is asked for.
static void add_direct(const alpi_bake_job *job, const alpi_light_task *t,
                       const alpi_radiosity *solution)
{
    const bool on = job->options.light.direct != ALP_DIRECT_OFF;
    for (uint32_t i = 0; i < t->count; i++) {
        const uint32_t texel = t->order[i];
        const alpi_reference_value *direct = &solution->direct[texel];
        alpi_reference_value *value = &t->values[texel];
        for (int k = 0; k < 3; k++) {
            if (job->direct != NULL) {
                job->direct[texel][k] = direct->mean[k];
                job->bounced[texel][k] = value->mean[k];
            }
            value->mean[k] += on ? direct->mean[k] : 0.0f;
            value->variance[k] += on ? direct->variance[k] : 0.0f;
        }
    }
}

static alp_result gather_light(alpi_bake_job *job, const alpi_light_task *t,
                               const light_gatherers *g)
{
    const alp_bake_options *o = &job->options;
    alpi_radiosity_options options = alpi_radiosity_options_default();
    options.context = job->context;
    options.scene = job->scene;
    options.tracer = t->tracer;
    options.lighting = t->lighting;
    options.filter = (alpi_trace_filter){.one_sided = o->occlusion.one_sided};
    options.gatherer = &g->blocks;
    options.bounces = o->light.bounces;
    options.seed = o->occlusion.seed;
    alpi_radiosity solution;
    ALP_TRY(alpi_radiosity_solve(&options, t->lattice, job->lightmap->atlas, t->order, t->count,
                                 &t->progress, &solution));
    report_solution(job, &solution);
    const alp_result result = gather_texels(job, t, &g->texels, &solution);
    if (result == ALP_OK) {
        add_direct(job, t, &solution);
    }
    alpi_radiosity_destroy(&solution);
    return result;
}

alp_result alpi_bake_radiosity(alpi_bake_job *job, const alpi_light_task *task)
{
    light_gatherers gatherers;
    alp_result result = make_gatherers(job, &gatherers);
    if (result == ALP_OK) {
        result = gather_light(job, task, &gatherers);
    }
    alpi_hemicube_destroy(gatherers.block_cube);
    alpi_hemicube_destroy(gatherers.texel_cube);
    return result;
}
