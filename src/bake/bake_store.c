// SPDX-License-Identifier: MIT
// The stage that stores: gathered values become pages of the lightmap.
#include "bake/bake_stages.h"

#include "bake/files/pack_orm.h"
#include "bake/gathering.h"
#include "bake/layer_plan.h"
#include "bake/settings.h"
#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <string.h>

// --- occlusion -----------------------------------------------------------------------------------

/// Makes every texel open where no map needs occlusion. Light used the array of values before.
static void skip_occlusion(alpi_bake_job *job)
{
    alpi_gathering *g = &job->gathering;
    for (uint32_t i = 0; i < g->valid_count; i++) {
        g->lattice.states[g->valid[i]] = ALPI_TEXEL_TRACED;
        g->lattice.values[g->valid[i]] = 1.0f;
    }
    job->report.traced = g->valid_count;
    job->report.ao_mean = g->valid_count > 0 ? 1.0 : 0.0;
    job->report.ao_relative_error = job->report.ao_p99_error = (double)NAN;
}

/// Multiplies each value by the occlusion map that the texel's material has already. Values that
/// are packed into an image are multiplied there.
static void multiply_existing(const alpi_bake_job *job, float *accessibility)
{
    const alpi_texels *texels = &job->lightmap->texels;
    for (uint32_t i = 0; i < texels->count; i++) {
        float old = 1.0f;
        if (!alpi_bake_is_packed(job, texels->triangles[i]) &&
            alpi_surface_occlusion(job->scene, texels->triangles[i], texels->barycentrics[i][0],
                                   texels->barycentrics[i][1], &old)) {
            accessibility[i] *= old;
        }
    }
}

// --- other maps ----------------------------------------------------------------------------------

/// Finds the mean direction of light, or the shading normal where there is none.
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

/// Stores one map and releases its values. Pages and values of all maps at once would take more
/// memory than gathering them.
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

static alp_result store_side_maps(alpi_bake_job *job)
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

// -------------------------------------------------------------------------------------------------

alp_result alpi_bake_store(alpi_bake_job *job)
{
    job->stage = "dilation";
    alp_lightmap *l = job->lightmap;
    const alpi_lattice *lattice = &job->gathering.lattice;
    const bool occlusion = alpi_bake_wants_occlusion(&job->options);
    if (!occlusion) {
        skip_occlusion(job);
    }
    alpi_gathering_end_rays(job);
    job->report.seconds_bake = alpi_seconds() - job->gathering.began - job->report.seconds_build;
    if (job->report.cut_off) { // a user who is asked again would cancel the values to be kept
        job->options.progress = NULL;
        alpi_set_watch(job->context, (alpi_watch){0});
    }
    memcpy(l->states, lattice->states, l->texels.count * sizeof *l->states);
    if (job->options.existing_ao == ALP_EXISTING_AO_MULTIPLY) {
        multiply_existing(job, lattice->values);
    }
    ALP_TRY(store_side_maps(job));
    ALP_TRY(occlusion ? alpi_lightmap_store(l, lattice->values) : ALP_OK);
    alpi_gathering_close(job);
    return ALP_OK;
}
