// SPDX-License-Identifier: MIT
// The refusals of options of light: how it is gathered, its layers, and its form in an asset.
#include "bake/check.h"

#include "bake/settings.h"
#include "scene/lights/lighting.h"

enum { PATH_LIMIT = 65536 };

static const alp_result INVALID = ALP_ERROR_INVALID_ARGUMENT;

/// Refuses counted emitters without hemicubes. Pixels count all emitters together, on all surfaces.
static alp_result check_emitters(const alpi_bake_job *job)
{
    const alp_light_options *o = &job->options.light;
    if ((int)o->emitters < ALP_EMITTERS_ANALYTIC || o->emitters > ALP_EMITTERS_COUNTED) {
        return alpi_fail(job->context, INVALID, "bake: unknown choice %d of emitters",
                         (int)o->emitters);
    }
    if (o->emitters == ALP_EMITTERS_ANALYTIC) {
        return ALP_OK;
    }
    if (o->gather != ALP_GATHER_HEMICUBE || o->bounces == 0) {
        return alpi_fail(job->context, INVALID,
                         "bake: counted emitters need hemicubes and bounces");
    }
    if (o->layers || job->options.only != NULL) {
        return alpi_fail(
            job->context, INVALID,
            "bake: counted emitters are counted together, for all surfaces; leave out %s",
            o->layers ? "layers" : "the choice of surfaces");
    }
    return ALP_OK;
}

/// Refuses a gatherer that cannot gather the light asked for.
static alp_result check_gatherer(const alpi_bake_job *job)
{
    const alp_light_options *o = &job->options.light;
    if ((int)o->gather < ALP_GATHER_RAYS || o->gather > ALP_GATHER_PATHS ||
        (int)o->direct < ALP_DIRECT_ON || o->direct > ALP_DIRECT_APART) {
        return alpi_fail(job->context, INVALID,
                         "bake: unknown choice %d of gatherer or %d of light", (int)o->gather,
                         (int)o->direct);
    }
    if (o->direct != ALP_DIRECT_ON && o->gather == ALP_GATHER_PATHS) {
        return alpi_fail(job->context, INVALID,
                         "bake: paths cannot separate direct light; gather by rays or hemicubes");
    }
    if ((job->options.maps & ALPI_MAPS_BY_DIRECTION) != 0 && o->gather == ALP_GATHER_PATHS) {
        return alpi_fail(job->context, INVALID,
                         "bake: paths keep no directions of light; gather by rays or hemicubes");
    }
    if (o->direct != ALP_DIRECT_ON && o->bounces == 0) {
        return alpi_fail(job->context, INVALID, "bake: without bounces all light is direct light");
    }
    if (o->denoise && (o->gather != ALP_GATHER_RAYS || o->bounces == 0)) {
        return alpi_fail(job->context, INVALID,
                         "bake: denoise applies to bounced light of rays only");
    }
    if (o->gather == ALP_GATHER_HEMICUBE &&
        (o->hemicube < 2 || o->hemicube > 1024 || o->hemicube % 2 != 0)) {
        return alpi_fail(job->context, INVALID,
                         "bake: hemicubes of %u pixels, need an even number from 2 to 1024",
                         o->hemicube);
    }
    if (alpi_bake_wants_light(&job->options) && (o->samples < 1 || o->samples > PATH_LIMIT)) {
        return alpi_fail(job->context, INVALID, "bake: %u samples of light, need 1 to %d",
                         o->samples, PATH_LIMIT);
    }
    return ALP_OK;
}

static alp_result check_layers(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    if (!o->light.layers) {
        return ALP_OK;
    }
    if (!alpi_bake_wants_light(o)) {
        return alpi_fail(job->context, INVALID, "bake: layers need ALP_MAP_LIGHT");
    }
    if (o->sampling.time_limit > 0.0 || o->sampling.keep_partial) {
        return alpi_fail(
            job->context, INVALID,
            "bake: layers have no partial results; leave out time_limit and keep_partial");
    }
    if (o->only != NULL) {
        return alpi_fail(job->context, INVALID,
                         "bake: layers need a bake of all surfaces; leave out the choice of "
                         "surfaces, or the layers");
    }
    if (o->light.denoise) {
        return alpi_fail(job->context, INVALID,
                         "bake: layers do not add up to a denoised map; leave one of the two out");
    }
    if (o->light.gather == ALP_GATHER_PATHS && o->light.bounces > 0) {
        return alpi_fail(job->context, INVALID,
                         "bake: paths cannot separate layers; gather by rays or hemicubes");
    }
    return ALP_OK;
}

/// Finds the fault of the light in an asset, or NULL.
static const char *find_fault(const alp_bake_options *o)
{
    const alp_lightmap_as as = o->lightmap_as;
    if ((int)as < ALP_LIGHTMAP_AS_NONE || as > ALP_LIGHTMAP_AS_BABYLON ||
        (int)o->light_units < ALP_LIGHT_UNITS_AUTO || o->light_units > ALP_LIGHT_RADIANCE ||
        (int)o->lightmap_format < ALP_LIGHTMAP_KTX2 || o->lightmap_format > ALP_LIGHTMAP_HDR) {
        return "unknown form, units or format of light in an asset";
    }
    if (as == ALP_LIGHTMAP_AS_NONE) {
        return o->light_units == ALP_LIGHT_UNITS_AUTO && o->lightmap_format == ALP_LIGHTMAP_KTX2
                   ? NULL
                   : "units and format apply to light in an asset; set lightmap_as";
    }
    if (!alpi_bake_wants_light(o) || o->output == NULL) {
        return "light in an asset needs ALP_MAP_LIGHT and an output";
    }
    if (o->ao_into == ALP_AO_INTO_ORM) {
        return "light has its own coordinates, so occlusion beside it cannot be packed into "
               "images; set ao_into to SEPARATE";
    }
    if (as != ALP_LIGHTMAP_AS_EXTRAS && o->lightmap_format != ALP_LIGHTMAP_KTX2) {
        return "lightmap_format applies to ALP_LIGHTMAP_AS_EXTRAS; an image in glTF is a PNG";
    }
    if (alpi_bake_is_viewer_file(o) && o->light_units != ALP_LIGHT_UNITS_AUTO) {
        return "the viewer needs fixed units; set light_units to AUTO";
    }
    if (as == ALP_LIGHTMAP_AS_EMISSIVE && alpi_bake_light_units(o) != ALP_LIGHT_RADIANCE) {
        return "ALP_LIGHTMAP_AS_EMISSIVE stores radiance; set light_units to AUTO";
    }
    if (as == ALP_LIGHTMAP_AS_EMISSIVE && o->light.direct == ALP_DIRECT_OFF) {
        return "materials of ALP_LIGHTMAP_AS_EMISSIVE are black and reflect no direct light; bake "
               "direct light too";
    }
    if (as == ALP_LIGHTMAP_AS_MOZ && alpi_bake_light_units(o) == ALP_LIGHT_RADIANCE) {
        return "readers of MOZ_lightmap multiply by the albedo; set light_units to irradiance";
    }
    return NULL;
}

alp_result alpi_bake_check_lit(const alpi_bake_job *job)
{
    return alpi_bake_wants_light(&job->options)
               ? alpi_lighting_refuse_darkness(job->scene, &job->options.light.lighting)
               : ALP_OK;
}

alp_result alpi_bake_check_light(const alpi_bake_job *job)
{
    ALP_TRY(check_gatherer(job));
    ALP_TRY(check_emitters(job));
    ALP_TRY(check_layers(job));
    const char *fault = find_fault(&job->options);
    return fault == NULL ? ALP_OK : alpi_fail(job->context, INVALID, "bake: %s", fault);
}
