// SPDX-License-Identifier: MIT
// Maps beside occlusion: bent normals, which its rays give, coloured obscurance and irradiance,
// which have rays of their own.
#include "bake/layers.h"
#include "bake/settings.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "transport/occlusion/obscurance.h"

#include <string.h>

alp_result alpi_bake_begin_side_maps(alpi_bake_job *job)
{
    const uint32_t count = job->lightmap->texels.count;
    if (alpi_bake_wants_occlusion(&job->options)) {
        ALPI_TRY_NEW(job->context, job->lightmap->errors, count);
    }
    if ((job->options.maps & ALP_MAP_BENT) != 0) {
        ALPI_TRY_NEW(job->context, job->bent, count);
    }
    if ((job->options.maps & ALP_MAP_OBSCURANCE) != 0) {
        ALPI_TRY_NEW(job->context, job->obscurance, count);
    }
    if ((job->options.maps & ALPI_MAPS_BY_DIRECTION) != 0) {
        ALPI_TRY_NEW(job->context, job->directional, count);
    }
    return ALP_OK;
}

void alpi_bake_end_side_maps(alpi_bake_job *job)
{
    alpi_release(job->context, job->irradiance);
    alpi_release(job->context, job->irradiance_errors);
    alpi_release(job->context, job->direct);
    alpi_release(job->context, job->bounced);
    alpi_release(job->context, job->directional);
    job->directional = NULL;
    job->irradiance = job->irradiance_errors = job->direct = job->bounced = NULL;
    alpi_release(job->context, job->bent);
    alpi_release(job->context, job->obscurance);
    job->bent = NULL;
    job->obscurance = NULL;
}

alp_result alpi_bake_obscurance(alpi_bake_job *job, const alpi_occlusion_setup *setup,
                                const alpi_receivers *receivers, const uint32_t *order,
                                uint32_t order_count, uint32_t samples,
                                const alpi_task_progress *progress)
{
    if (job->obscurance == NULL) {
        return ALP_OK;
    }
    alpi_task_progress told = *progress;
    told.stage = "obscurance";
    job->report.rays += (uint64_t)order_count * samples;
    ALP_TRY(alpi_scratch_clear(&job->scratch, order, order_count, &told));
    return alpi_obscurance_gather(setup, receivers, order, order_count, samples, &told,
                                  &job->scratch.sums, job->obscurance);
}

/// The mean direction of light, or the shading normal.
static void direction_of(const alp_lightmap *l, const alpi_directional *directional, uint32_t texel,
                         float direction[3])
{
    const float *n = l->texels.normals[texel], *d = directional->toward;
    const vec3 unit = vec3_normalize_or((vec3){d[0], d[1], d[2]}, (vec3){n[0], n[1], n[2]});
    direction[0] = unit.x;
    direction[1] = unit.y;
    direction[2] = unit.z;
}

/// Stores one of the four maps of spherical harmonics, or (ALPI_SH1_COUNT) the direction.
static alp_result store_directional(alpi_bake_job *job, uint32_t index, float (*values)[3])
{
    alp_lightmap *l = job->lightmap;
    for (uint32_t t = 0; t < l->texels.count; t++) {
        if (index < ALPI_SH1_COUNT) {
            memcpy(values[t], job->directional[t].sh[index], sizeof values[t]);
        } else {
            direction_of(l, &job->directional[t], t, values[t]);
        }
    }
    return alpi_lightmap_store_vectors(l, (const float(*)[3])values,
                                       index < ALPI_SH1_COUNT ? &l->sh_pages[index]
                                                              : &l->direction_pages);
}

static alp_result store_light_by_direction(alpi_bake_job *job)
{
    float(*values)[3] = alpi_allocate(job->context, job->lightmap->texels.count, sizeof *values);
    alp_result result = values != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; i <= ALPI_SH1_COUNT && result == ALP_OK; i++) {
        const alp_map map = i < ALPI_SH1_COUNT ? ALP_MAP_SH : ALP_MAP_DIRECTION;
        if ((job->options.maps & (unsigned)map) != 0) {
            result = store_directional(job, i, values);
        }
    }
    alpi_release(job->context, values);
    return result;
}

/// Stores one map and lets go of its values: pages and values of all maps at once would be more
/// than gathering them took.
static alp_result store_vectors(alpi_bake_job *job, float (**values)[3], float ***pages)
{
    if (*values == NULL) {
        return ALP_OK;
    }
    const alp_result result =
        alpi_lightmap_store_vectors(job->lightmap, (const float(*)[3]) * values, pages);
    alpi_release(job->context, *values);
    *values = NULL;
    return result;
}

alp_result alpi_bake_store_side_maps(alpi_bake_job *job)
{
    alp_lightmap *l = job->lightmap;
    ALP_TRY(store_vectors(job, &job->bent, &l->bent_pages));
    ALP_TRY(store_vectors(job, &job->obscurance, &l->obscurance_pages));
    ALP_TRY(store_vectors(job, &job->irradiance, &l->irradiance_pages));
    ALP_TRY(store_vectors(job, &job->irradiance_errors, &l->irradiance_error_pages));
    ALP_TRY(store_vectors(job, &job->direct, &l->direct_pages));
    ALP_TRY(store_vectors(job, &job->bounced, &l->bounced_pages));
    if (job->directional != NULL) {
        ALP_TRY(store_light_by_direction(job));
    }
    return alpi_bake_store_layers(job);
}
