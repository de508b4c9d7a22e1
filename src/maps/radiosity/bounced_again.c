// SPDX-License-Identifier: MIT
#include "maps/radiosity/bounced_again.h"

#include "base/memory.h"

#include <math.h>

static alpi_gather_job job_of(const alpi_bounced_again *a)
{
    alpi_gather_job job = *a->options.gather;
    job.list = a->list;
    job.count = a->traced;
    job.skies = NULL;
    return job;
}

static alp_result prepare(alpi_bounced_again *a, uint64_t kept_limit,
                          const alpi_task_progress *progress)
{
    alp_context *context = a->lattice.context;
    const uint32_t texels = a->lattice.texels->count;
    const alpi_gatherer *g = a->options.gather->gatherer;
    ALPI_TRY_NEW(context, a->list, a->options.count);
    ALPI_TRY_NEW(context, a->lattice.values, texels); // stencils read them, weights do not
    for (uint32_t i = 0; i < a->options.count; i++) {
        const uint32_t t = a->options.order[i];
        if (a->lattice.states[t] == ALPI_TEXEL_TRACED) {
            a->list[a->traced++] = t;
        }
    }
    if (!alpi_gather_meets_cells(a->options.gather->from) || a->traced == 0 ||
        alpi_kept_rays_size(g) * a->traced > alpi_kept_rays_limit(context, kept_limit)) {
        return ALP_OK;
    }
    const alpi_gather_job job = job_of(a);
    ALP_TRY(alpi_kept_rays_reserve(context, g, a->traced, &a->kept));
    a->kept.by_list = true;
    a->rays += (uint64_t)a->traced * g->packet_count * ALPI_PACKET;
    return alpi_kept_rays_trace(&job, progress, &a->kept);
}

alp_result alpi_bounced_again_create(const alpi_bounced_options *options,
                                     const alpi_lattice *lattice, uint8_t *states,
                                     uint64_t kept_limit, const alpi_task_progress *progress,
                                     alpi_bounced_again *again)
{
    *again = (alpi_bounced_again){.options = *options,
                                  .lattice = alpi_bounced_lattice(options, lattice, states, NULL)};
    const alp_result result = prepare(again, kept_limit, progress);
    if (result != ALP_OK) {
        alpi_bounced_again_destroy(again);
    }
    return result;
}

void alpi_bounced_again_destroy(alpi_bounced_again *again)
{
    if (again->lattice.context == NULL) {
        return;
    }
    alpi_kept_rays_destroy(&again->kept);
    alpi_release(again->lattice.context, again->list);
    alpi_release(again->lattice.context, again->lattice.values);
    *again = (alpi_bounced_again){0};
}

alp_result alpi_bounced_again_gather(alpi_bounced_again *again, const alpi_task_progress *progress)
{
    const alpi_gather_job job = job_of(again);
    if (again->kept.receivers > 0) {
        ALP_TRY(alpi_kept_rays_gather(&job, &again->kept, progress));
    } else {
        ALP_TRY(alpi_gather_irradiance(&job, progress));
        again->rays += (uint64_t)again->traced * job.gatherer->packet_count * ALPI_PACKET;
    }
    for (uint32_t pass = 1; pass < ALPI_LATTICE_PASSES; pass++) {
        for (uint32_t i = 0; i < again->options.count; i++) {
            const uint32_t t = again->options.order[i];
            alpi_stencil stencil;
            if (again->lattice.states[t] == ALPI_TEXEL_INTERPOLATED &&
                alpi_lattice_pass(again->lattice.texels->pixels[t]) == pass &&
                alpi_lattice_stencil(&again->lattice, t, &stencil)) {
                alpi_bounced_interpolate(again->options.gather, t, &stencil);
            }
        }
    }
    return ALP_OK;
}
