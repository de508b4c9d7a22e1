// SPDX-License-Identifier: MIT
// The job without an atlas: vertices → acceleration structure → occlusion → values → the asset; and
// a word to the user where triangles are too large for what lies on them.
#include "bake/objects.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "formats/formats.h"
#include "maps/vertex/vertex_detail.h"
#include "transport/occlusion/occlusion.h"

#include <math.h>

enum { NAMED_LIMIT = 8, POINTS_LEAST = 8 };
static const double COARSE = 0.05; // root mean square error that is worth a warning

alp_result alpi_bake_check_vertex_options(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    bool at_vertices = o->atlas.mode == ALP_ATLAS_VERTEX;
    if ((int)o->vertex_attribute < ALP_VERTEX_COLOR || o->vertex_attribute > ALP_VERTEX_OCCLUSION) {
        return alpi_fail(job->context, code, "bake: unknown choice %d for the vertex attribute",
                         (int)o->vertex_attribute);
    }
    if (!at_vertices && o->vertex_attribute != ALP_VERTEX_COLOR) {
        return alpi_fail(job->context, code,
                         "bake: a vertex attribute needs the atlas mode for vertices");
    }
    if (at_vertices && o->maps_folder != NULL) {
        return alpi_fail(job->context, code,
                         "%s: a bake at vertices has no maps to write; give an output alone",
                         o->maps_folder);
    }
    if (at_vertices && (o->only != NULL || o->ao_self)) {
        return alpi_fail(job->context, code,
                         "bake: at vertices all surfaces are baked, and together: no only and no "
                         "ao_self");
    }
    const alp_sampling_options *sampling = &o->sampling;
    if (at_vertices && (sampling->accuracy > 0.0f || sampling->error != 0.0f ||
                        sampling->time_limit != 0.0 || sampling->keep_partial)) {
        return alpi_fail(job->context, code,
                         "bake: at vertices every receiver gets all its rays: no accuracy, wanted "
                         "error, time limit or partial result");
    }
    if (at_vertices && o->existing_ao != ALP_EXISTING_AO_REPLACE) {
        return alpi_fail(job->context, code,
                         "bake: a bake at vertices leaves the materials' occlusion maps alone");
    }
    return ALP_OK;
}

// --- triangles that are too large ----------------------------------------------------------------

/// Mean square error that is worth a warning. Noise of the values is no fault of the triangles: its
/// variance is at most 1/4 over the rays, times 3/2 by the fit, times 1/2 by interpolating.
static double coarse_limit(const alpi_bake_job *job)
{
    return COARSE * COARSE + 0.1875 / (double)job->options.occlusion.samples;
}

/// Where errors shrink with the edge, half of what is worth a warning is reached at this one.
static double advised_edge(const alpi_vertex_detail *detail)
{
    return detail->edge * fmin(0.5 * COARSE / sqrt(detail->square), 0.5);
}

static void warn_of_surface(const alpi_bake_job *job, const char *name,
                            const alpi_vertex_detail *detail)
{
    alpi_warn(job->context, "coarse-vertices", name,
              "triangles are too large for the occlusion on them: between the vertices it is off "
              "by %.2f (root mean square); subdivide to edges of about %.2g m, or use --atlas "
              "charts",
              sqrt(detail->square), advised_edge(detail));
}

/// Warns of the worst surfaces first and counts the rest; `details` is used up.
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
                  "objects with triangles as large, not named here: %u", more);
    }
    if (small.point_count >= POINTS_LEAST && small.weight > 0.0) {
        small.square /= small.point_count;
        small.edge /= small.weight;
        if (small.square > limit) {
            warn_of_surface(job, "small objects together", &small);
        }
    }
}

static alp_result check_detail(alpi_bake_job *job, const alpi_vertex_map *map,
                               const alpi_tracer *tracer, const alp_occlusion_options *options,
                               const float *values)
{
    alpi_vertex_detail *details =
        ALPI_NEW(job->context, alpi_vertex_detail, job->scene->surface_count);
    if (details == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    uint64_t rays = 0;
    alp_result result = alpi_vertex_map_measure(map, tracer, options, values, details, &rays);
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

/// Values of receivers to values of the scene's vertices; those of no triangle are open.
static alp_result store(alpi_bake_job *job, const alpi_vertex_map *map, const float *values)
{
    uint32_t count = job->scene->vertex_count;
    float *all = ALPI_NEW(job->context, float, count);
    if (all == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t v = 0; v < count; v++) {
        all[v] = map->vertex_receivers[v] == ALPI_NONE ? 1.0f : values[map->vertex_receivers[v]];
    }
    return alpi_lightmap_create_vertices(job->scene, all, &job->lightmap);
}

static alp_result gather_with(alpi_bake_job *job, const alpi_vertex_map *map,
                              const alpi_tracer *tracer, float *values)
{
    double started = alpi_seconds();
    alp_occlusion_options options = job->options.occlusion;
    options.progress = job->options.progress;
    options.progress_user = job->options.progress_user;
    alpi_occlusion_setup setup;
    job->stage = "occlusion";
    ALP_TRY(alpi_occlusion_prepare(job->scene, tracer, &options, &setup));
    job->report.ao_distance = setup.distance;
    const alpi_receivers receivers = alpi_vertex_map_receivers(map);
    alp_result result = alpi_occlusion_gather(&setup, &receivers, NULL, map->count, values);
    job->report.rays = (uint64_t)map->count * setup.samples;
    job->report.ao_samples = setup.samples;
    alpi_occlusion_release(&setup);
    ALP_TRY(result);
    job->report.ao_mean = area_mean(map, values);
    ALP_TRY(alpi_vertex_map_fit(map, values));
    ALP_TRY(check_detail(job, map, tracer, &options, values));
    job->report.seconds_bake = alpi_seconds() - started;
    alpi_bake_warn_of_darkness(job);
    return store(job, map, values);
}

static alp_result gather(alpi_bake_job *job, const alpi_vertex_map *map, float *values)
{
    double started = alpi_seconds();
    ALP_TRY(alpi_bake_begin_stage(job, "build"));
    alpi_tracer *tracer = NULL, *owned = NULL;
    ALP_TRY(
        alpi_bake_tracer(job, job->options.progress, job->options.progress_user, &tracer, &owned));
    job->report.seconds_build = alpi_seconds() - started;
    alp_result result = gather_with(job, map, tracer, values);
    alpi_tracer_destroy(owned);
    return result;
}

static alp_result find_values(alpi_bake_job *job)
{
    double started = alpi_seconds();
    ALP_TRY(alpi_bake_begin_stage(job, "vertices"));
    alpi_vertex_map map;
    ALP_TRY(alpi_vertex_map_create(job->scene, &map));
    job->report.atlas = (alp_atlas_info){.mode = ALP_ATLAS_VERTEX};
    job->report.vertices = map.count;
    job->report.seconds_atlas = alpi_seconds() - started;
    float *values = ALPI_NEW(job->context, float, map.count);
    alp_result result = values == NULL ? ALP_ERROR_OUT_OF_MEMORY : gather(job, &map, values);
    alpi_release(job->context, values);
    alpi_vertex_map_destroy(&map);
    return result;
}

// --- the asset -----------------------------------------------------------------------------------

/// Viewers apply a material's own occlusion map besides.
static void tell_of_maps(const alpi_bake_job *job)
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
                  "objects whose material has an occlusion map too, which stays and is applied "
                  "besides: %u",
                  count);
    }
}

static alp_result write_asset(const alpi_bake_job *job)
{
    char *extras = alpi_bake_make_extras(job);
    if (extras == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    tell_of_maps(job);
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

alp_result alpi_bake_vertices(alpi_bake_job *job)
{
    double started = alpi_seconds();
    ALP_TRY(alpi_bake_check_outputs(job, 0));
    ALP_TRY(find_values(job));
    double write_started = alpi_seconds();
    ALP_TRY(alpi_bake_begin_stage(job, "write"));
    if (job->options.output != NULL) {
        ALP_TRY(write_asset(job));
    }
    job->report.seconds_write = alpi_seconds() - write_started;
    job->report.seconds_total = alpi_seconds() - started;
    return ALP_OK;
}
