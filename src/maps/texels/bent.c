// SPDX-License-Identifier: MIT
#include "maps/texels/bent.h"

enum { TEXELS_PER_RANGE = 1 << 12 };

typedef struct bent_job {
    const alpi_lattice *lattice;
    const alpi_occlusion_sums *sums;
    const uint32_t *order;
    float (*bent)[3];
} bent_job;

/// Weighs mean vectors, not unit ones, so that a nearly closed texel weighs little. A cubic may
/// overshoot to a direction below the surface, which counts as none.
static void interpolate(void *user, uint32_t texel, const alpi_stencil *stencil)
{
    const bent_job *job = user;
    const vec3 none = {0.0f, 0.0f, 0.0f};
    vec3 sum = none;
    for (uint32_t i = 0; i < stencil->count; i++) {
        sum = vec3_mad(sum, stencil->weights[i], vec3_load(job->bent[stencil->texels[i]]));
    }
    const bool above = vec3_dot(sum, vec3_load(job->lattice->texels->normals[texel])) > 0.0f;
    vec3_store(job->bent[texel], above ? sum : none);
}

static alp_result load_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const bent_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        if (job->lattice->states[t] == ALPI_TEXEL_TRACED) {
            vec3_store(job->bent[t], alpi_occlusion_mean_vector(job->sums, t));
        }
    }
    return ALP_OK;
}

static alp_result normalize_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const bent_job *job = user;
    const alpi_lattice *l = job->lattice;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        if (l->states[t] != ALPI_TEXEL_OPEN) {
            vec3_store(job->bent[t], vec3_normalize_or(vec3_load(job->bent[t]),
                                                       vec3_load(l->texels->normals[t])));
        }
    }
    return ALP_OK;
}

alp_result alpi_bent_normals(const alpi_lattice *lattice, const alpi_occlusion_sums *sums,
                             const uint32_t *order, uint32_t order_count,
                             const alpi_task_progress *progress, float (*bent)[3])
{
    bent_job job = {.lattice = lattice, .sums = sums, .order = order, .bent = bent};
    ALP_TRY(alpi_parallel_for(lattice->context, order_count, TEXELS_PER_RANGE, load_range, &job,
                              progress));
    ALP_TRY(alpi_lattice_for_stencils(lattice, order, order_count, interpolate, &job, progress));
    return alpi_parallel_for(lattice->context, order_count, TEXELS_PER_RANGE, normalize_range, &job,
                             progress);
}
