// SPDX-License-Identifier: MIT
// Probes of a bake, with the light that its map is gathered from.
#include "bake/light/light.h"
#include "fields/probes/probes.h"

alp_result alpi_light_probes(alpi_bake_job *job, const alpi_surface_light *known)
{
    const alp_bake_options *o = &job->options;
    if ((o->maps & ALP_MAP_PROBES) == 0) {
        return ALP_OK;
    }
    alp_probe_options options = o->probes != NULL ? *o->probes : alp_probe_options_default();
    options.lighting = o->light.lighting;
    options.bounces = o->light.bounces;
    options.one_sided = o->occlusion.one_sided;
    options.layers = false;
    options.seed = o->occlusion.seed;
    options.progress = o->progress;
    options.progress_user = o->progress_user;
    return alpi_probes_bake(job->scene, &options, known, &job->probes);
}
