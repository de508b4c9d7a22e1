// SPDX-License-Identifier: MIT
// Maps beside occlusion: bent normals, which its rays give, coloured obscurance and irradiance,
// which have rays of their own.
#include "bake/layers.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "transport/occlusion/obscurance.h"

#include <string.h>

enum {
    BY_DIRECTION = ALP_MAP_SH | ALP_MAP_DIRECTION,
    ALL_MAPS = ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_OBSCURANCE | ALP_MAP_LIGHT | BY_DIRECTION
};
enum { PATH_LIMIT = 65536 };

bool alpi_bake_lights_apart(const alpi_bake_job *job)
{
    return (job->options.maps & ALP_MAP_LIGHT) != 0 &&
           job->options.light.direct == ALP_DIRECT_APART;
}

/// Pixels tell neither layers nor what is outside of the surfaces that are baked.
static alp_result check_emitters(const alpi_bake_job *job)
{
    const alp_light_options *o = &job->options.light;
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if ((int)o->emitters < ALP_EMITTERS_ANALYTIC || o->emitters > ALP_EMITTERS_COUNTED) {
        return alpi_fail(job->context, code, "bake: unknown choice %d of emitters",
                         (int)o->emitters);
    }
    if (o->emitters == ALP_EMITTERS_ANALYTIC) {
        return ALP_OK;
    }
    if (o->gather != ALP_GATHER_HEMICUBE || o->bounces == 0) {
        return alpi_fail(job->context, code,
                         "bake: emitters are counted by the pixels of hemicubes, and with bounces");
    }
    if (o->layers || job->options.only != NULL) {
        return alpi_fail(
            job->context, code,
            "bake: pixels do not tell emitters apart, and count them for all surfaces; "
            "leave out %s",
            o->layers ? "layers" : "the choice of surfaces");
    }
    return ALP_OK;
}

static alp_result check_light(const alpi_bake_job *job)
{
    const alp_light_options *o = &job->options.light;
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if ((int)o->gather < ALP_GATHER_RAYS || o->gather > ALP_GATHER_PATHS ||
        (int)o->direct < ALP_DIRECT_ON || o->direct > ALP_DIRECT_APART) {
        return alpi_fail(job->context, code, "bake: unknown choice %d of gatherer or %d of light",
                         (int)o->gather, (int)o->direct);
    }
    if (o->direct != ALP_DIRECT_ON && o->gather == ALP_GATHER_PATHS) {
        return alpi_fail(job->context, code,
                         "bake: paths gather all light together; rays or hemicubes tell direct "
                         "light apart");
    }
    if ((job->options.maps & BY_DIRECTION) != 0 && o->gather == ALP_GATHER_PATHS) {
        return alpi_fail(job->context, code,
                         "bake: paths do not tell where light comes from; rays or hemicubes do");
    }
    if (o->direct != ALP_DIRECT_ON && o->bounces == 0) {
        return alpi_fail(job->context, code, "bake: without bounces all light is direct light");
    }
    const alp_sampling_options *s = &job->options.sampling;
    if (o->layers && (s->time_limit > 0.0 || s->keep_partial)) {
        return alpi_fail(
            job->context, code,
            "bake: layers are gathered to their end: no time limit, no partial result");
    }
    if (o->layers && job->options.only != NULL) {
        return alpi_fail(job->context, code,
                         "bake: layers are told apart where all surfaces are baked; leave out the "
                         "choice of surfaces, or the layers");
    }
    if (o->denoise && (o->gather != ALP_GATHER_RAYS || o->bounces == 0)) {
        return alpi_fail(job->context, code,
                         "bake: only bounced light that rays gather can be denoised");
    }
    if (o->gather == ALP_GATHER_HEMICUBE &&
        (o->hemicube < 2 || o->hemicube > 1024 || o->hemicube % 2 != 0)) {
        return alpi_fail(job->context, code,
                         "bake: hemicubes of %u pixels, need an even number from 2 to 1024",
                         o->hemicube);
    }
    return check_emitters(job);
}

alp_result alpi_bake_check_maps(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (o->maps == 0 || (o->maps & ~(unsigned)ALL_MAPS) != 0) {
        return alpi_fail(job->context, code, "bake: unknown maps 0x%x, need bits of alp_map",
                         o->maps);
    }
    if (o->atlas.mode == ALP_ATLAS_VERTEX && o->maps != ALP_MAP_AO) {
        return alpi_fail(job->context, code, "bake: only occlusion is baked at vertices");
    }
    if (o->output != NULL && (o->maps & ALP_MAP_AO) == 0 &&
        o->lightmap_as == ALP_LIGHTMAP_AS_NONE) {
        return alpi_fail(job->context, code,
                         "%s: glTF has a place for occlusion alone, and for light as lightmap_as "
                         "says; bake one of them too, or give no output",
                         o->output);
    }
    const bool in_one_go = (o->maps & ALP_MAP_OBSCURANCE) != 0;
    const bool light_in_one_go = (o->maps & ALP_MAP_LIGHT) != 0 &&
                                 (o->light.gather != ALP_GATHER_RAYS || o->light.bounces == 0);
    if ((in_one_go || light_in_one_go) &&
        (o->sampling.time_limit > 0.0 || o->sampling.keep_partial)) {
        return alpi_fail(job->context, code,
                         "bake: %s gathered in one go: no time limit, no partial result",
                         in_one_go                             ? "coloured obscurance is"
                         : o->light.bounces == 0               ? "direct light alone is"
                         : o->light.gather == ALP_GATHER_PATHS ? "light by paths is"
                                                               : "light by hemicubes is");
    }
    if ((o->maps & ALP_MAP_LIGHT) != 0 && o->occluders != NULL) {
        return alpi_fail(job->context, code,
                         "bake: light falls on all surfaces: no occluders are chosen for it");
    }
    if ((o->maps & ALP_MAP_LIGHT) != 0 && o->ao_self) {
        return alpi_fail(job->context, code,
                         "bake: light falls on the whole scene, not on each object alone");
    }
    if ((o->maps & BY_DIRECTION) != 0 && (o->maps & ALP_MAP_LIGHT) == 0) {
        return alpi_fail(job->context, code,
                         "bake: light by direction is of the irradiance; bake ALP_MAP_LIGHT too");
    }
    ALP_TRY(check_light(job));
    if ((o->maps & ALP_MAP_LIGHT) != 0 && (o->light.samples < 1 || o->light.samples > PATH_LIMIT)) {
        return alpi_fail(job->context, code, "bake: %u paths of a texel, need 1 to %d",
                         o->light.samples, PATH_LIMIT);
    }
    return ALP_OK;
}

alp_result alpi_bake_begin_side_maps(alpi_bake_job *job)
{
    const uint32_t count = job->lightmap->texels.count;
    if (alpi_bake_wants_occlusion(job)) {
        ALPI_TRY_NEW(job->context, job->lightmap->errors, count);
    }
    if ((job->options.maps & ALP_MAP_BENT) != 0) {
        ALPI_TRY_NEW(job->context, job->bent, count);
    }
    if ((job->options.maps & ALP_MAP_OBSCURANCE) != 0) {
        ALPI_TRY_NEW(job->context, job->obscurance, count);
    }
    if ((job->options.maps & BY_DIRECTION) != 0) {
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
    job->stage = told.stage = "obscurance";
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
