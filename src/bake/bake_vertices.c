// SPDX-License-Identifier: MIT
// A bake without an atlas: vertices → tracer → occlusion → fit → values → asset. It warns where
// triangles are too large for the occlusion on them.
#include "bake/bake_stages.h"

#include "bake/files/extras.h"
#include "bake/files/outputs.h"
#include "bake/objects.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "base/tiles/rank_calls.h"
#include "formats/formats.h"
#include "maps/vertex/vertex_detail.h"
#include "transport/occlusion/occlusion.h"

#include <math.h>

enum { NAMED_LIMIT = 8, POINTS_LEAST = 8 };
static const double COARSE = 0.05; // root mean square error above which a warning follows

/// The state of a bake at vertices.
typedef struct vertex_bake {
    alpi_vertex_map map;
    alpi_tracer *tracer, *owned;
    float *values; // [map.count]
} vertex_bake;

/// Finds the vertices that are receivers.
static alp_result map_vertices(alpi_bake_job *job, vertex_bake *v)
{
    const double started = alpi_seconds();
    ALP_TRY(alpi_bake_begin_stage(job, "vertices"));
    ALP_TRY(alpi_vertex_map_create(job->scene, &v->map));
    job->report.atlas = (alp_atlas_info){.mode = ALP_ATLAS_VERTEX};
    job->report.vertices = v->map.count;
    job->report.seconds_atlas = alpi_seconds() - started;
    ALPI_TRY_NEW(job->context, v->values, v->map.count);
    return ALP_OK;
}

static alp_result build_tracer(alpi_bake_job *job, vertex_bake *v)
{
    const double started = alpi_seconds();
    ALP_TRY(alpi_bake_begin_stage(job, "build"));
    ALP_TRY(alpi_bake_tracer(job, job->options.progress, job->options.progress_user, &v->tracer,
                             &v->owned));
    job->report.seconds_build = alpi_seconds() - started;
    return ALP_OK;
}

static alp_occlusion_options occlusion_options(const alpi_bake_job *job)
{
    alp_occlusion_options options = job->options.occlusion;
    options.progress = job->options.progress;
    options.progress_user = job->options.progress_user;
    return options;
}

static alp_result trace_occlusion(alpi_bake_job *job, vertex_bake *v)
{
    const alp_occlusion_options options = occlusion_options(job);
    alpi_occlusion_setup setup;
    ALP_TRY(alpi_occlusion_prepare(job->scene, v->tracer, &options, &setup));
    job->report.ao_distance = setup.distance;
    const alpi_receivers receivers = alpi_vertex_map_receivers(&v->map);
    const alp_result result =
        alpi_occlusion_gather(&setup, &receivers, NULL, v->map.count, v->values);
    job->report.rays = (uint64_t)v->map.count * setup.samples;
    job->report.ao_samples = setup.samples;
    alpi_occlusion_release(&setup);
    return result;
}

// --- triangles that are too large ----------------------------------------------------------------

/// The mean square error above which a warning follows. The noise of the values is no fault of the
/// triangles: its variance is at most 1/4 over the rays, times 3/2 by the fit, times 1/2 by
/// interpolation.
static double coarse_limit(const alpi_bake_job *job)
{
    return COARSE * COARSE + 0.1875 / (double)job->options.occlusion.samples;
}

/// The edge at which the error is half of COARSE, if errors shrink with the edge.
static double advised_edge(const alpi_vertex_detail *detail)
{
    return detail->edge * fmin(0.5 * COARSE / sqrt(detail->square), 0.5);
}

static void warn_of_surface(const alpi_bake_job *job, const char *name,
                            const alpi_vertex_detail *detail)
{
    alpi_warn(job->context, "coarse-vertices", name,
              "triangles are too large for their occlusion: between the vertices it errs by %.2f "
              "(root mean square); subdivide to edges of about %.2g m, or use --atlas charts",
              sqrt(detail->square), advised_edge(detail));
}

/// Warns of the worst surfaces first and counts the rest. Overwrites `details`.
static void warn_of_coarse(const alpi_bake_job *job, alpi_vertex_detail *details)
{
    uint32_t count = job->scene->surface_count;
    double limit = coarse_limit(job);
    alpi_vertex_detail small = {0}; // surfaces of too few points, together
    for (int named = 0; named < NAMED_LIMIT; named++) {
        uint32_t worst = ALPI_NONE;
        for (uint32_t s = 0; s < count; s++) {
            if (details[s].point_count >= POINTS_LEAST && details[s].square > limit &&
                (worst == ALPI_NONE || details[s].square > details[worst].square)) {
                worst = s;
            }
        }
        if (worst == ALPI_NONE) {
            break;
        }
        warn_of_surface(job, job->scene->surfaces[worst].name, &details[worst]);
        details[worst] = (alpi_vertex_detail){.point_count = POINTS_LEAST};
    }
    uint32_t more = 0;
    for (uint32_t s = 0; s < count; s++) {
        const alpi_vertex_detail *d = &details[s];
        more += d->point_count >= POINTS_LEAST && d->square > limit;
        if (d->point_count < POINTS_LEAST) {
            small.point_count += d->point_count;
            small.square += d->square * d->point_count;
            small.weight += d->weight;
            small.edge += d->weight * d->edge;
        }
    }
    if (more > 0) {
        alpi_warn(job->context, "coarse-vertices", job->scene->name,
                  "further objects with triangles too large: %u", more);
    }
    if (small.point_count >= POINTS_LEAST && small.weight > 0.0) {
        small.square /= small.point_count;
        small.edge /= small.weight;
        if (small.square > limit) {
            warn_of_surface(job, "small objects together", &small);
        }
    }
}

static alp_result measure_detail(alpi_bake_job *job, const vertex_bake *v)
{
    const alp_occlusion_options options = occlusion_options(job);
    alpi_vertex_detail *details =
        ALPI_NEW(job->context, alpi_vertex_detail, job->scene->surface_count);
    if (details == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    uint64_t rays = 0;
    const alp_result result =
        alpi_vertex_map_measure(&v->map, v->tracer, &options, v->values, details, &rays);
    if (result == ALP_OK) {
        job->report.rays += rays;
        warn_of_coarse(job, details);
    }
    alpi_release(job->context, details);
    return result;
}

// --- values --------------------------------------------------------------------------------------

static double area_mean(const alpi_vertex_map *map, const float *means)
{
    double sum = 0.0, area = 0.0;
    for (uint32_t i = 0; i < map->count; i++) {
        sum += map->areas[i] * (double)means[i];
        area += map->areas[i];
    }
    return area > 0.0 ? sum / area : 0.0;
}

/// Turns means around the vertices into values at them.
static alp_result fit_values(alpi_bake_job *job, vertex_bake *v)
{
    job->report.ao_mean = area_mean(&v->map, v->values);
    return alpi_vertex_map_fit(&v->map, v->values);
}

/// Stores the values of receivers at the scene's vertices. Vertices without a triangle are open.
static alp_result store(alpi_bake_job *job, const vertex_bake *v)
{
    const uint32_t count = job->scene->vertex_count, *receivers = v->map.vertex_receivers;
    float *all = ALPI_NEW(job->context, float, count);
    if (all == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < count; i++) {
        all[i] = receivers[i] == ALPI_NONE ? 1.0f : v->values[receivers[i]];
    }
    return alpi_lightmap_create_vertices(job->scene, all, &job->lightmap);
}

// --- the asset -----------------------------------------------------------------------------------

/// Notes materials with an occlusion map of their own, which viewers apply besides.
static void note_maps(const alpi_bake_job *job)
{
    const alp_scene *scene = job->scene;
    uint32_t count = 0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        uint32_t material = scene->surfaces[s].material;
        count += material != ALPI_NONE &&
                 scene->materials[material].occlusion_texture.image != ALPI_NONE;
    }
    if (count > 0) {
        alpi_note(job->context, "occlusion-twice", scene->name,
                  "objects whose material also has an occlusion map, which viewers apply too: %u",
                  count);
    }
}

static alp_result write_asset(const alpi_bake_job *job)
{
    char *extras = alpi_bake_make_extras(job);
    if (extras == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    note_maps(job);
    alpi_mesh_patch patch = {
        .vertex_values = job->lightmap->vertex_values,
        .vertex_attribute = job->options.vertex_attribute == ALP_VERTEX_COLOR
                                ? ALPI_VERTEX_COLOR
                                : ALPI_VERTEX_OCCLUSION,
        .extras_json = extras,
    };
    alp_result result =
        alpi_scene_write_patched(job->scene, &patch, job->options.output, job->options.overwrite);
    alpi_release(job->context, extras);
    return result;
}

static alp_result write_stage(alpi_bake_job *job)
{
    const double started = alpi_seconds();
    ALP_TRY(alpi_bake_begin_stage(job, "write"));
    if (job->options.output != NULL && alpi_ranks_write(job->context)) {
        ALP_TRY(write_asset(job));
    }
    job->report.seconds_write = alpi_seconds() - started;
    return ALP_OK;
}

// --- all of it -----------------------------------------------------------------------------------

static alp_result gather(alpi_bake_job *job, vertex_bake *v)
{
    const double started = alpi_seconds();
    ALP_TRY(trace_occlusion(job, v));
    ALP_TRY(fit_values(job, v));
    ALP_TRY(measure_detail(job, v));
    alpi_bake_warn_of_darkness(job);
    job->report.seconds_bake = alpi_seconds() - started;
    return store(job, v);
}

static alp_result find_values(alpi_bake_job *job)
{
    vertex_bake v = {0};
    alp_result result = map_vertices(job, &v);
    result = result == ALP_OK ? build_tracer(job, &v) : result;
    result = result == ALP_OK ? gather(job, &v) : result;
    alpi_release(job->context, v.values);
    alpi_tracer_destroy(v.owned);
    if (v.map.context != NULL) {
        alpi_vertex_map_destroy(&v.map);
    }
    return result;
}

alp_result alpi_bake_vertices(alpi_bake_job *job)
{
    ALP_TRY(alpi_bake_check_outputs(job, 0));
    ALP_TRY(find_values(job));
    return write_stage(job);
}
