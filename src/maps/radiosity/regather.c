// SPDX-License-Identifier: MIT
#include "maps/radiosity/regather.h"

#include "base/memory.h"
#include "maps/radiosity/final_gather_job.h"

static alpi_gather_job job_of(const alpi_regather *r)
{
    alpi_gather_job job = *r->options.gather;
    job.list = r->list;
    job.count = r->traced;
    job.skies = NULL;
    return job;
}

static void interpolate(void *user, uint32_t texel, const alpi_stencil *stencil)
{
    const alpi_regather *r = user;
    alpi_stencil_light(r->options.gather, texel, stencil);
}

static alp_result prepare(alpi_regather *r, uint64_t kept_limit, const alpi_task_progress *progress)
{
    alp_context *context = r->lattice.context;
    const uint32_t texels = r->lattice.texels->count;
    const alpi_gatherer *g = r->options.gather->gatherer;
    ALPI_TRY_NEW(context, r->list, r->options.count);
    ALPI_TRY_NEW(context, r->lattice.values,
                 texels); // stencils read them, although weights do not depend on them
    for (uint32_t i = 0; i < r->options.count; i++) {
        const uint32_t t = r->options.order[i];
        if (r->lattice.states[t] == ALPI_TEXEL_TRACED) {
            r->list[r->traced++] = t;
        }
    }
    if (!alpi_gather_meets_cells(r->options.gather->from) || r->traced == 0) {
        return ALP_OK;
    }
    bool fit;
    ALP_TRY(alpi_kept_rays_fit(context, alpi_kept_rays_size(g) * r->traced, kept_limit, &fit));
    if (!fit) {
        return ALP_OK;
    }
    const alpi_gather_job job = job_of(r);
    ALP_TRY(alpi_kept_rays_reserve(context, g, r->traced, &r->kept));
    r->kept.by_list = true;
    r->rays += (uint64_t)r->traced * g->packet_count * ALPI_PACKET;
    return alpi_kept_rays_trace(&job, progress, &r->kept);
}

alp_result alpi_regather_create(const alpi_final_gather_options *options,
                                const alpi_lattice *lattice, uint8_t *states, uint64_t kept_limit,
                                const alpi_task_progress *progress, alpi_regather *regather)
{
    *regather = (alpi_regather){.options = *options,
                                .lattice = alpi_final_gather_lattice(lattice, states, NULL)};
    const alp_result result = prepare(regather, kept_limit, progress);
    if (result != ALP_OK) {
        alpi_regather_destroy(regather);
    }
    return result;
}

void alpi_regather_destroy(alpi_regather *regather)
{
    if (regather->lattice.context == NULL) {
        return;
    }
    alpi_kept_rays_destroy(&regather->kept);
    alpi_release(regather->lattice.context, regather->list);
    alpi_release(regather->lattice.context, regather->lattice.values);
    *regather = (alpi_regather){0};
}

alp_result alpi_regather_run(alpi_regather *regather, const alpi_task_progress *progress)
{
    const alpi_gather_job job = job_of(regather);
    if (regather->kept.receivers > 0) {
        ALP_TRY(alpi_kept_rays_gather(&job, &regather->kept, progress));
    } else {
        ALP_TRY(alpi_gather_irradiance(&job, progress));
        regather->rays += (uint64_t)regather->traced * job.gatherer->packet_count * ALPI_PACKET;
    }
    return alpi_lattice_for_stencils(&regather->lattice, regather->options.order,
                                     regather->options.count, interpolate, regather, NULL);
}
