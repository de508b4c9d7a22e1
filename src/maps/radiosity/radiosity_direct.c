// SPDX-License-Identifier: MIT
// Direct light of texels: lights, sky, and emissive surfaces that hemicubes count.
#include "maps/radiosity/counted_emitters.h"
#include "maps/radiosity/solver.h"

/// Adds the light of emissive surfaces that options.counted measures.
static alp_result add_counted(const alpi_radiosity *radiosity, const alpi_receivers *texels,
                              const uint32_t *list, uint32_t count,
                              const alpi_task_progress *progress, alpi_direct_output *output)
{
    const alpi_gather_scene from = alpi_radiosity_scene(radiosity);
    const alpi_gather_job job = {.context = radiosity->options.context,
                                 .from = &from,
                                 .gatherer = radiosity->options.counted,
                                 .receivers = texels,
                                 .list = list,
                                 .count = count,
                                 .values = output->values,
                                 .directional = output->directional};
    if (job.gatherer == NULL) {
        return ALP_OK;
    }
    output->rays += (uint64_t)count * job.gatherer->packet_count * ALPI_PACKET;
    return alpi_counted_emitters_add(&job, progress);
}

alp_result alpi_radiosity_direct(const alpi_radiosity *radiosity, const uint32_t *list,
                                 uint32_t count, uint32_t samples, uint64_t seed,
                                 const alpi_task_progress *progress, alpi_direct_output *output)
{
    const alpi_radiosity_options *o = &radiosity->options;
    const alpi_direct_options options = {.context = o->context,
                                         .scene =
                                             o->direct_scene != NULL ? o->direct_scene : o->scene,
                                         .tracer = o->tracer,
                                         .lighting = o->direct,
                                         .filter = o->filter,
                                         .samples = samples,
                                         .seed = seed};
    alpi_direct *direct = NULL;
    if (o->layers != NULL) {
        output->groups = o->layers->direct;
        output->part_groups = o->layers->part_layers;
    }
    const alpi_receivers texels = radiosity->texels != NULL
                                      ? *radiosity->texels
                                      : alpi_patches_texel_receivers(&radiosity->patches);
    ALP_TRY(alpi_direct_create(&options, &direct));
    alp_result result = alpi_direct_irradiance(direct, &texels, list, count, progress, output);
    alpi_direct_destroy(direct);
    if (result == ALP_OK) {
        result = add_counted(radiosity, &texels, list, count, progress, output);
    }
    return result;
}

alp_result alpi_solver_direct(const alpi_solver *solver, const uint32_t *list, uint32_t count,
                              alpi_directional *directional)
{
    alpi_radiosity *r = solver->r;
    alpi_direct_output output = {.values = r->direct, .directional = directional};
    const alp_result result = alpi_radiosity_direct(r, list, count, r->options.direct_samples,
                                                    r->options.seed, &solver->progress, &output);
    r->rays += output.rays;
    r->direct_draw = output.draw;
    return result;
}
