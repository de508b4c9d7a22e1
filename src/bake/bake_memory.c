// SPDX-License-Identifier: MIT
// The memory of a bake: a budget that its allocations are kept within, and a forecast of the large
// arrays, so that a hopeless bake fails before its rays are traced.
#include "bake/bake_memory.h"

#include "bake/light/light_settings.h"
#include "bake/settings.h"
#include "base/tiles/rank_calls.h"
#include "maps/radiosity/patches.h"

#include <stdio.h>
#include <unistd.h>

// Bytes of a texel.
enum {
    POINT_BYTES = 66,    // where it lies, its lattice and its states
    SHADE_BYTES = 32,    // while occlusion is gathered
    LIGHT_BYTES = 56,    // while light is gathered: values, variances, errors
    BOUNCE_BYTES = 36,   // of each side, for light that bounces
    ROUND_BYTES = 40,    // for rounds of light
    DENOISE_BYTES = 150, // while noise is taken off
    LAYER_BYTES = 25     // of each layer of light
};
// Bytes of a texel of a page, of each map or layer.
enum {
    PAGE_BYTES = 16, // a stored page: float RGBA
    TEXT_BYTES = 20  // all pages as text, of --lightmap-as three
};

/// "61.2 MiB", "1 MiB", "115 GiB".
typedef struct size_text {
    char text[32];
} size_text;

static size_text name_size(double bytes)
{
    const bool large = bytes >= 10.0 * 0x1p30;
    const double number = bytes / (large ? 0x1p30 : 0x1p20);
    size_text t;
    snprintf(t.text, sizeof t.text, "%.*g %s", number < 1000.0 ? 3 : 5, number,
             large ? "GiB" : "MiB");
    return t;
}

/// Name of the limit for messages.
static const char *name_limit(const alpi_bake_job *job)
{
    return job->options.sampling.memory_limit > 0 ? "--memory-limit"
           : alpi_context_ranks(job->context) != NULL
               ? "nine tenths of the memory of the smallest machine,"
               : "nine tenths of the machine's memory,";
}

static const char *advise(const alpi_bake_job *job)
{
    return job->options.atlas.mode == ALP_ATLAS_VERTEX
               ? "raise the limit, or split the scene"
               : "raise the limit, or use a smaller --size or --texels-per-metre";
}

// --- the budget ----------------------------------------------------------------------------------

/// Bytes, at least 1; UINT64_MAX: any.
static uint64_t find_limit(const alpi_bake_job *job)
{
    const uint64_t asked = job->options.sampling.memory_limit,
                   left = alpi_memory_left(job->context);
    const long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    const uint64_t limit = asked > 0 ? asked
                           : pages > 0 && page_size > 0
                               ? (uint64_t)pages / 10 * 9 * (uint64_t)page_size
                               : UINT64_MAX;
    const uint64_t least = limit < left ? limit : left;
    return least > 0 ? least : 1;
}

/// Sets the budget of the context. @return the one before
static alpi_budget set_limit(alpi_bake_job *job, uint64_t limit)
{
    const bool any = limit > UINT64_MAX - job->held;
    job->memory_limit = any ? 0 : limit;
    return alpi_set_budget(job->context, (alpi_budget){.limit = any ? 0 : job->held + limit});
}

void alpi_bake_begin_budget(alpi_bake_job *job)
{
    job->held = alpi_memory_held(job->context);
    job->budget = set_limit(job, find_limit(job));
}

alp_result alpi_bake_share_budget(alpi_bake_job *job)
{
    uint64_t limit = job->memory_limit > 0 ? job->memory_limit : UINT64_MAX;
    ALP_TRY(alpi_ranks_lowest(job->context, &limit));
    (void)set_limit(job, limit);
    return ALP_OK;
}

alp_result alpi_bake_end_budget(alpi_bake_job *job, alp_result result)
{
    const alpi_budget spent = alpi_set_budget(job->context, job->budget);
    if (result != ALP_ERROR_OUT_OF_MEMORY || spent.wanted == 0) {
        return result;
    }
    const uint64_t held = spent.held > job->held ? spent.held - job->held : 0;
    return alpi_fail(job->context, ALP_ERROR_LIMIT,
                     "bake: stage \"%s\" would need more than %s %s (it holds %s and wants %s "
                     "more); %s",
                     job->stage, name_limit(job), name_size((double)job->memory_limit).text,
                     name_size((double)held).text, name_size((double)spent.wanted).text,
                     advise(job));
}

// --- the forecast --------------------------------------------------------------------------------

static uint64_t larger(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/// Bytes of a texel while light is gathered.
static uint64_t find_light_bytes(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    const alp_light_options *l = &o->light;
    const uint64_t sides = alpi_patches_are_two_sided(job->scene) ? 2 : 1;
    const bool solved = l->bounces > 0 && l->gather != ALP_GATHER_PATHS;
    const bool directional = (o->maps & (ALP_MAP_SH | ALP_MAP_DIRECTION)) != 0;
    return LIGHT_BYTES + (solved ? BOUNCE_BYTES * sides : 0) +
           (l->denoise                             ? DENOISE_BYTES
            : alpi_light_is_in_rounds(o) && solved ? ROUND_BYTES
                                                   : 0) +
           (directional ? 2 * sizeof(alpi_directional) : 0) +
           LAYER_BYTES * (uint64_t)job->layers.light.count;
}

/// Maps of float RGBA, layers included.
static uint64_t count_maps(const alpi_bake_job *job)
{
    const unsigned maps = job->options.maps;
    const bool apart = alpi_bake_lights_apart(&job->options), light = (maps & ALP_MAP_LIGHT) != 0;
    return (alpi_bake_wants_occlusion(&job->options) ? 1u : 0u) +
           ((maps & ALP_MAP_BENT) != 0 ? 1u : 0u) + ((maps & ALP_MAP_OBSCURANCE) != 0 ? 1u : 0u) +
           (light ? apart ? 4u : 2u : 0u) + ((maps & ALP_MAP_SH) != 0 ? 4u : 0u) +
           ((maps & ALP_MAP_DIRECTION) != 0 ? 1u : 0u) + job->layers.light.count;
}

alpi_memory_forecast alpi_bake_forecast_memory(const alpi_bake_job *job,
                                               const alp_atlas_info *atlas)
{
    const alp_bake_options *o = &job->options;
    const uint64_t texels = atlas->texels, size = o->atlas.size;
    const uint64_t pixels = (uint64_t)atlas->width * atlas->height * atlas->pages;
    const bool light = (o->maps & ALP_MAP_LIGHT) != 0;
    const bool solved = o->light.bounces > 0 && o->light.gather != ALP_GATHER_PATHS;
    // With `only`, the light around is solved for on a page of its own.
    const uint64_t around = light && solved && job->only != NULL ? size * size : 0;
    const uint64_t shading = SHADE_BYTES * texels;
    const uint64_t lighting =
        light ? find_light_bytes(job) * texels + (POINT_BYTES + LIGHT_BYTES) * around : 0;
    const uint64_t text = o->lightmap_as == ALP_LIGHTMAP_AS_THREE ? TEXT_BYTES : 0;
    const uint64_t writing = (PAGE_BYTES * count_maps(job) + text) * pixels;
    const uint64_t most = larger(writing, larger(shading, lighting));
    return (alpi_memory_forecast){most == writing    ? "write"
                                  : most == lighting ? "light"
                                                     : "occlusion",
                                  POINT_BYTES * texels + most};
}

alp_result alpi_bake_check_memory(const alpi_bake_job *job, const alp_atlas_info *atlas)
{
    const alpi_memory_forecast forecast = alpi_bake_forecast_memory(job, atlas);
    if (job->memory_limit == 0 || forecast.bytes <= job->memory_limit) {
        return ALP_OK;
    }
    return alpi_fail(job->context, ALP_ERROR_LIMIT,
                     "bake: stage \"%s\" would need about %s for %llu texels, more than %s %s; %s",
                     forecast.stage, name_size((double)forecast.bytes).text,
                     (unsigned long long)atlas->texels, name_limit(job),
                     name_size((double)job->memory_limit).text, advise(job));
}
