// SPDX-License-Identifier: MIT
#include "maps/texels/bent.h"

#include "base/tasks.h"

enum { TEXELS_PER_RANGE = 1 << 12 };

typedef struct bent_job {
    const alpi_lattice *lattice;
    const alpi_occlusion_sums *sums;
    const uint32_t *order;
    float (*bent)[3];
    uint32_t pass; // of the lattice, or ALPI_LATTICE_PASSES: to unit length
} bent_job;

/// Weighs mean vectors, not unit ones: a texel that is nearly closed has little say. What a cubic
/// overshoots to below the surface is no direction.
static vec3 interpolate(const bent_job *job, uint32_t texel)
{
    const vec3 none = {0.0f, 0.0f, 0.0f};
    alpi_stencil stencil;
    vec3 sum = none;
    if (!alpi_lattice_stencil(job->lattice, texel, &stencil)) {
        return none;
    }
    for (uint32_t i = 0; i < stencil.count; i++) {
        sum = vec3_mad(sum, stencil.weights[i], vec3_load(job->bent[stencil.texels[i]]));
    }
    return vec3_dot(sum, vec3_load(job->lattice->texels->normals[texel])) > 0.0f ? sum : none;
}

static alp_result fill_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const bent_job *job = user;
    const alpi_lattice *l = job->lattice;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        const uint8_t state = l->states[t];
        if (job->pass == ALPI_LATTICE_PASSES && state != ALPI_TEXEL_OPEN) {
            vec3_store(job->bent[t], vec3_normalize_or(vec3_load(job->bent[t]),
                                                       vec3_load(l->texels->normals[t])));
        } else if (job->pass == 0 && state == ALPI_TEXEL_TRACED) {
            vec3_store(job->bent[t], alpi_occlusion_mean_vector(job->sums, t));
        } else if (state == ALPI_TEXEL_INTERPOLATED &&
                   alpi_lattice_pass(l->texels->pixels[t]) == job->pass) {
            vec3_store(job->bent[t], interpolate(job, t));
        }
    }
    return ALP_OK;
}

alp_result alpi_bent_normals(const alpi_lattice *lattice, const alpi_occlusion_sums *sums,
                             const uint32_t *order, uint32_t order_count,
                             const alpi_task_progress *progress, float (*bent)[3])
{
    bent_job job = {.lattice = lattice, .sums = sums, .order = order, .bent = bent};
    // The traced, then pass by pass as the values were found: a stencil reaches for coarser passes
    // and for traced texels alone.
    for (job.pass = 0; job.pass <= ALPI_LATTICE_PASSES; job.pass++) {
        ALP_TRY(alpi_parallel_for(lattice->context, order_count, TEXELS_PER_RANGE, fill_range, &job,
                                  progress));
    }
    return ALP_OK;
}
