// SPDX-License-Identifier: MIT
// The bake of probes: solve the scene's light, sample it, and measure the result.
#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "base/tiles/rank_calls.h"
#include "base/warp.h"
#include "fields/probes/probe_layers.h"
#include "fields/probes/probe_ranks.h"
#include "fields/probes/probes.h"
#include "fields/truth.h"
#include "maps/radiosity/solution.h"
#include "scene/origin.h"
#include "transport/examine.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { RAYS_LEAST = 384, RAYS_MOST = 1572864, HELD_OUT = 2048, HELD_OUT_PATHS = 64 };
enum { STREAM_HELD_OUT = 24, LIST_LIMIT = 1 << 20 };

alp_probe_options alp_probe_options_default(void)
{
    return (alp_probe_options){.struct_size = sizeof(alp_probe_options),
                               .visibility = true,
                               .rays = 1536,
                               .lighting = alp_lighting_options_default(),
                               .bounces = ALP_BOUNCES_CONVERGE,
                               .atlas_size = 512};
}

// --- checks --------------------------------------------------------------------------------------

static alp_result check(const alp_scene *scene, const alp_probe_options *o)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (o->struct_size != sizeof *o) {
        return alpi_fail(scene->context, code, "probe options are not from _default()");
    }
    if (!(o->spacing >= 0.0f) || !isfinite(o->spacing)) {
        return alpi_fail(scene->context, code, "probes: spacing %g m, need a positive number",
                         (double)o->spacing);
    }
    if (o->rays < RAYS_LEAST || o->rays > RAYS_MOST) {
        return alpi_fail(scene->context, code, "probes: %u rays a probe, need %d to %d", o->rays,
                         RAYS_LEAST, RAYS_MOST);
    }
    if ((int)o->basis < 0 || o->basis > ALP_PROBE_AMBIENT_CUBE) {
        return alpi_fail(scene->context, code, "probes: unknown basis %d", (int)o->basis);
    }
    if (o->positions != NULL && o->position_count == 0) {
        return alpi_fail(scene->context, code, "probes: no positions");
    }
    if (o->positions != NULL && o->gradients) {
        return alpi_fail(scene->context, code, "probes: listed places have no gradients");
    }
    if (o->layers && o->gradients) {
        return alpi_fail(scene->context, code,
                         "probes: gradients are of all light, which layers part; leave one out");
    }
    if (o->positions != NULL && o->position_count > LIST_LIMIT) {
        return alpi_fail(scene->context, ALP_ERROR_LIMIT, "probes: %u positions, at most %d",
                         o->position_count, LIST_LIMIT);
    }
    for (uint32_t i = 0; i < o->position_count && o->positions != NULL; i++) {
        if (!vec3_is_finite(vec3_load(o->positions[i]))) {
            return alpi_fail(
                scene->context, code, "probes: position %u is %g %g %g: need finite numbers", i,
                (double)o->positions[i][0], (double)o->positions[i][1], (double)o->positions[i][2]);
        }
    }
    return alpi_lighting_refuse_darkness(scene, &o->lighting);
}

// --- the job -------------------------------------------------------------------------------------

typedef struct probe_job {
    const alp_scene *scene;
    const alp_probe_options *o;
    alpi_tracer *tracer;
    alpi_lighting *lighting;         // all light
    alpi_lighting *space;            // sky and emissive surfaces: what arrives directly
    alpi_lighting *soft, *spots;     // the same with the soft sky, and with its bright spots
    const alpi_surface_light *given; // NULL, or light that surfaces reflect
    alpi_solution *solution;         // NULL without bounces, or with light that is given
    alpi_surface_light known;        // of either
    alpi_probe_layers layers;
    alpi_probe_sampling sampling;
    alpi_probe_volume *volume;
} probe_job;

/// The options of a bake, as JSON.
static char *describe(const probe_job *job)
{
    static const char *const skies[] = {"none", "constant", "hemisphere", "image", "clear"};
    const alp_probe_options *o = job->o;
    const alp_sun_options *sun = &o->lighting.sun;
    char bounces[16] = "\"converge\"";
    if (o->bounces != ALP_BOUNCES_CONVERGE) {
        snprintf(bounces, sizeof bounces, "%u", o->bounces);
    }
    return alpi_format(job->scene->context,
                       "{\"bounces\":%s,\"sky\":\"%s\",\"sky_strength\":%.9g,\"sun_lux\":%.9g,"
                       "\"sun_azimuth\":%.9g,\"sun_elevation\":%.9g,\"lamps\":%u,"
                       "\"one_sided\":%s,\"metals_black\":%s,\"atlas\":%u}",
                       bounces, skies[o->lighting.sky.kind], (double)o->lighting.sky.strength,
                       (double)sun->illuminance, (double)sun->azimuth, (double)sun->elevation,
                       o->lighting.lamp_count, o->one_sided ? "true" : "false",
                       job->scene->metals_black ? "true" : "false", o->atlas_size);
}

static alp_result prepare_volume(probe_job *job)
{
    const alp_probe_options *o = job->o;
    alpi_probe_volume *v = job->volume;
    v->is_list = o->positions != NULL;
    v->basis = (alpi_probe_basis)o->basis;
    if (v->is_list) {
        v->count = v->size[0] = o->position_count;
        v->size[1] = v->size[2] = 1;
    } else {
        ALP_TRY(alpi_probe_lattice(job->scene, o, v));
    }
    v->layer_count = job->layers.count;
    ALP_TRY(alpi_probe_volume_allocate(job->scene->context, o->gradients,
                                       o->visibility && !v->is_list, v));
    ALP_TRY(alpi_probe_layers_name(job->lighting, &job->layers, v));
    for (uint32_t i = 0; i < v->count && v->is_list; i++) {
        for (int k = 0; k < 3; k++) {
            v->places[i][k] = (float)((double)o->positions[i][k] + job->scene->origin[k]);
        }
    }
    v->direct = o->direct;
    v->without_sky = alpi_lighting_sky(job->space) == NULL;
    v->without_emission = alpi_lighting_emitter_count(job->space) == 0;
    v->without_reflected = o->bounces == 0;
    v->scene_hash = job->scene->input_hash;
    v->seed = o->seed;
    v->options = describe(job);
    return v->options != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}

/// Places in the scene, and room for what is found there.
static alp_result prepare_sampling(probe_job *job)
{
    alp_context *context = job->scene->context;
    alpi_probe_sampling *s = &job->sampling;
    const alpi_probe_volume *v = job->volume;
    ALPI_TRY_NEW(context, s->points, v->count);
    ALPI_TRY_NEW(context, s->values, v->count);
    for (uint32_t i = 0; i < v->count; i++) {
        double place[3];
        alpi_probe_place(v, i, place);
        for (int k = 0; k < 3; k++) {
            s->points[i][k] =
                v->is_list ? job->o->positions[i][k] : (float)(place[k] - job->scene->origin[k]);
        }
    }
    return ALP_OK;
}

static alp_result solve(probe_job *job)
{
    const alp_probe_options *o = job->o;
    if (job->given != NULL) {
        job->known = *job->given;
    }
    if (o->bounces == 0 || job->given != NULL) {
        return ALP_OK;
    }
    alpi_solution_options options = {.scene = job->scene,
                                     .tracer = job->tracer,
                                     .lighting = job->lighting,
                                     .atlas = alp_atlas_options_default(),
                                     .one_sided = o->one_sided,
                                     .bounces = o->bounces,
                                     .tolerance = alpi_radiosity_tolerance(o->bounces),
                                     .layers = o->layers ? &job->layers.light : NULL,
                                     .seed = o->seed};
    options.atlas.size = o->atlas_size;
    ALP_TRY(alpi_solution_create(&options, o->progress, o->progress_user, &job->solution));
    job->known = alpi_solution_light(job->solution);
    return ALP_OK;
}

/// Pixels along a face for a number of rays: a multiple of 4.
static uint32_t face_for(uint32_t rays)
{
    uint32_t face = 4;
    while (face < ALPI_SPHERE_FACE_MOST && ALPI_SPHERE_REPLICATES * 6 * face * face < rays) {
        face += 4;
    }
    return face;
}

/// Rays are aimed at emissive surfaces that are less than this share of all surfaces.
static const double AIMED_AREA = 0.1;

/// Sources that rays are aimed at; NULL: pixels meet all light well enough.
static const alpi_lighting *find_aimed(const probe_job *job)
{
    const double area = alpi_lighting_emitter_area(job->spots);
    const bool small = area > 0.0 && area < AIMED_AREA * job->scene->area;
    return small || alpi_lighting_sky(job->spots) != NULL ? job->spots : NULL;
}

static void aim(probe_job *job)
{
    const alpi_lighting *aimed = find_aimed(job);
    const alpi_probe_volume *v = job->volume;
    const vec3 cell = vec3_load(v->spacing);
    const vec3 size = vec3_sub(job->scene->bounds_max, job->scene->bounds_min);
    alpi_probe_sampling *s = &job->sampling;
    s->context = job->scene->context;
    s->options = job->o;
    s->rays = (alpi_sphere_rays){
        .context = s->context,
        .from = {.scene = job->scene,
                 .tracer = job->tracer,
                 .lighting = job->soft,
                 .filter = {.one_sided = job->o->one_sided},
                 .emitters = aimed == NULL,
                 .sky = true},
        .aimed = aimed,
        .face = face_for(job->o->rays),
        .replicates = ALPI_SPHERE_REPLICATES,
        // No look-up goes beyond the cell's diagonal and a move.
        .reach = v->is_list ? vec3_length(size) : 1.5f * vec3_length(cell),
        .seed = job->o->seed,
    };
    s->rays.from.light = job->known;
    job->volume->reach = s->rays.reach;
    job->volume->rays = alpi_sphere_rays_count(&s->rays);
}

// --- quality -------------------------------------------------------------------------------------

/// Mean E over normals is A₀ Y₀₀ c₀₀; mean square error over normals is Σ A_l² var(c_lm) / 4π.
static void state_noise(const probe_job *job)
{
    static const double square[3] = {ALPI_PI * ALPI_PI, 4.0 * ALPI_PI * ALPI_PI / 9.0,
                                     ALPI_PI * ALPI_PI / 16.0};
    alpi_probe_volume *v = job->volume;
    double sum = 0.0, variance = 0.0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < v->count; i++) {
        const alpi_sphere_light *light = &job->sampling.values[i];
        if (v->states[i] > ALPI_PROBE_MOVED) {
            continue; // not sampled
        }
        for (int k = 0; k < 3; k++) {
            sum += ALPI_PI * 0.28209479177387814 * (double)light->light.c[0][k];
            for (int c = 0; c < ALPI_SH9_COUNT; c++) {
                const int band = c == 0 ? 0 : c < 4 ? 1 : 2;
                variance += square[band] * (double)light->variance.c[c][k] / (4.0 * ALPI_PI);
            }
        }
        count += 3;
    }
    v->mean = count > 0 ? (float)(sum / count) : 0.0f;
    v->noise = count > 0 ? (float)sqrt(variance / count) : 0.0f;
    v->relative_error = sum > 0.0 ? (float)(sqrt(variance / count) / (sum / count)) : 0.0f;
}

/// Random points among the probes with random normals, those in solids left out.
static alp_result draw_held_out(const probe_job *job, alpi_point_array *points)
{
    const alpi_probe_volume *v = job->volume;
    const uint32_t plan = alpi_random_key(v->seed, 0, STREAM_HELD_OUT);
    const uint32_t height = alpi_random_key(v->seed, 1, STREAM_HELD_OUT);
    const uint32_t normal = alpi_random_key(v->seed, 2, STREAM_HELD_OUT);
    alpi_sphere_light *found = ALPI_NEW(job->scene->context, alpi_sphere_light, points->count);
    if (found == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < points->count; i++) {
        const vec2 at = alpi_sample_2d(plan, i), up = alpi_sample_2d(height, i);
        const float share[3] = {at.x, up.x, at.y};
        for (int k = 0; k < 3; k++) {
            const double cells = (double)share[k] * v->size[k] - 0.5;
            points->positions[i][k] =
                (float)(v->origin[k] - job->scene->origin[k] + (double)v->spacing[k] * cells);
        }
        const vec3 n = alpi_warp_uniform_cone(alpi_sample_2d(normal, i), -1.0f);
        vec3_store(points->shading_normals[i], n);
        vec3_store(points->geometric_normals[i], n);
        points->offsets[i] = alpi_receiver_offset(vec3_load(points->positions[i]), NULL);
    }
    const alpi_sphere_rays survey = alpi_probe_survey_rays(&job->sampling);
    const alpi_sphere_job sphere = {.rays = &survey,
                                    .points = (const float(*)[3])points->positions,
                                    .count = points->count,
                                    .values = found};
    const alp_result result = alpi_sphere_gather(&sphere, NULL);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < points->count && result == ALP_OK; i++) {
        if (found[i].behind <= ALPI_FREE_BACKS) {
            memcpy(points->positions[kept], points->positions[i], sizeof *points->positions);
            memcpy(points->shading_normals[kept], points->shading_normals[i],
                   sizeof *points->shading_normals);
            memcpy(points->geometric_normals[kept], points->geometric_normals[i],
                   sizeof *points->geometric_normals);
            points->offsets[kept++] = points->offsets[i];
        }
    }
    points->count = kept;
    alpi_release(job->scene->context, found);
    return result;
}

/// E at the points, by paths that end in the same solution.
static alp_result gather_held_out(const probe_job *job, const alpi_point_array *points,
                                  alpi_reference_value *values)
{
    const alp_probe_options *o = job->o;
    const uint32_t limit = ALPI_REFERENCE_BOUNCE_LIMIT;
    alpi_reference reference = {.context = job->scene->context,
                                .scene = job->scene,
                                .tracer = job->tracer,
                                .lighting = job->lighting,
                                .direct = o->direct ? job->lighting : job->space,
                                .filter = {.one_sided = o->one_sided},
                                .bounces = o->bounces < limit ? o->bounces : limit,
                                .samples = HELD_OUT_PATHS,
                                .next_event = true,
                                .seed = o->seed + 1};
    if (job->known.find != NULL) {
        reference.known = &job->known;
    }
    const alpi_receivers receivers = alpi_point_array_receivers(points);
    const alpi_task_progress progress = {
        .callback = o->progress, .user = o->progress_user, .stage = "probes"};
    return alpi_reference_irradiance(&reference, &receivers, NULL, 0, &progress, values);
}

static alp_result compare_held_out(const probe_job *job, const alpi_point_array *points,
                                   alpi_reference_value *values, float (*irradiance)[3])
{
    alp_field *field = NULL;
    double sum = 0.0, change = 0.0;
    ALP_TRY(gather_held_out(job, points, values));
    ALP_TRY(
        alpi_probe_field_create(job->volume, ALP_LOOKUP_OURS, job->scene->origin, NULL, &field));
    alp_field_irradiance(field, points->count, (const float(*)[3])points->positions,
                         (const float(*)[3])points->shading_normals, irradiance);
    const double noise = (double)job->volume->noise;
    for (uint32_t i = 0; i < points->count; i++) {
        change +=
            3.0 * alpi_probe_field_change(field, points->positions[i], points->shading_normals[i]);
        for (int k = 0; k < 3; k++) {
            const double apart = (double)irradiance[i][k] - (double)values[i].mean[k];
            sum += apart * apart - (double)values[i].variance[k];
        }
    }
    alp_field_destroy(field);
    const double between = sum - 3.0 * points->count * noise * noise;
    job->volume->factor = change > 0.0 ? (float)sqrt(fmax(between, 0.0) / change) : 0.0f;
    job->volume->interpolation =
        points->count > 0 ? (float)sqrt(fmax(sum, 0.0) / (3.0 * points->count)) : 0.0f;
    return ALP_OK;
}

/// Measures the error between probes at points that took no part.
static alp_result state_interpolation(const probe_job *job)
{
    alp_context *context = job->scene->context;
    alpi_point_array points;
    ALP_TRY(alpi_point_array_create(context, HELD_OUT, &points));
    alpi_reference_value *values = ALPI_NEW(context, alpi_reference_value, HELD_OUT);
    float(*irradiance)[3] = alpi_allocate(context, HELD_OUT, sizeof *irradiance);
    alp_result result = values != NULL && irradiance != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    if (result == ALP_OK) {
        result = draw_held_out(job, &points);
    }
    if (result == ALP_OK) {
        result = compare_held_out(job, &points, values, irradiance);
    }
    alpi_release(context, irradiance);
    alpi_release(context, values);
    alpi_point_array_destroy(context, &points);
    return result;
}

// --- the handle ----------------------------------------------------------------------------------

/// Light of each layer: what surfaces reflect of one lamp, and, as asked, that lamp itself.
static alp_result sample_layers(probe_job *job, const alpi_probe_light *all)
{
    alpi_probe_volume *v = job->volume;
    const alpi_task_progress progress = {
        .callback = job->o->progress, .user = job->o->progress_user, .stage = "layers"};
    alpi_probe_light one = *all;
    one.rays.aimed = NULL;
    one.rays.from.emitters = one.rays.from.sky = false;
    one.moments = NULL;
    one.stage = "layers";
    for (uint32_t i = 0; i < v->layer_count; i++) {
        one.lamp = job->layers.lamps[i];
        if (job->solution != NULL) {
            ALP_TRY(alpi_radiosity_relight(&job->solution->radiosity, i, NULL, &progress));
        }
        ALP_TRY(alpi_probes_light(&job->sampling, &one, v, v->layers[i].coefficients));
    }
    return v->layer_count > 0 && job->solution != NULL
               ? alpi_radiosity_relight(&job->solution->radiosity, ALPI_NONE, NULL, &progress)
               : ALP_OK;
}

/// Warns where probes hold no light because they lie in solids.
static void warn_of_solids(const probe_job *job)
{
    const alp_scene *scene = job->scene;
    const uint32_t count = job->volume->count, inside = count - job->sampling.free_count;
    if (inside == count) {
        alpi_warn(scene->context, "probes-inside", scene->name,
                  "all %u probes lie in solids or behind walls: their light is black; check the "
                  "bounds and the spacing",
                  count);
    } else if (job->volume->is_list && inside > 0) {
        alpi_warn(scene->context, "probes-inside", scene->name,
                  "%u of %u probes lie in solids or behind walls: their light is black", inside,
                  count);
    }
}

/// Warns where the lattice does not touch the scene.
static void warn_of_bounds(const probe_job *job)
{
    const alpi_probe_volume *v = job->volume;
    const alp_scene *scene = job->scene;
    const double low[3] = {(double)scene->bounds_min.x, (double)scene->bounds_min.y,
                           (double)scene->bounds_min.z};
    const double high[3] = {(double)scene->bounds_max.x, (double)scene->bounds_max.y,
                            (double)scene->bounds_max.z};
    bool outside = false;
    for (int k = 0; k < 3 && !v->is_list; k++) {
        const double first = v->origin[k] - scene->origin[k] - (double)v->spacing[k];
        const double last = first + (v->size[k] + 1.0) * (double)v->spacing[k];
        outside = outside || last < low[k] || first > high[k];
    }
    if (outside) {
        alpi_warn(scene->context, "probes-outside", scene->name,
                  "the grid lies outside of the scene, whose bounds are %g %g %g to %g %g %g m",
                  low[0] + scene->origin[0], low[1] + scene->origin[1], low[2] + scene->origin[2],
                  high[0] + scene->origin[0], high[1] + scene->origin[1],
                  high[2] + scene->origin[2]);
    }
}

static alp_result sample(probe_job *job)
{
    alpi_probe_volume *v = job->volume;
    alpi_probe_sampling *s = &job->sampling;
    warn_of_bounds(job);
    ALP_TRY(alpi_probes_survey(s, v));
    warn_of_solids(job);
    const alpi_probe_light light = {.rays = s->rays,
                                    .lamps = job->o->direct ? job->lighting : NULL,
                                    .lamp = ALPI_NONE,
                                    .points = (const float(*)[3])s->points,
                                    .values = s->values,
                                    .moments = v->moments,
                                    .stage = "probes"};
    ALP_TRY(alpi_probes_light(s, &light, v, v->coefficients));
    state_noise(job);
    if (v->gradients != NULL) {
        ALP_TRY(alpi_probes_find_gradients(s, &light, v));
    }
    ALP_TRY(sample_layers(job, &light));
    return alpi_probes_fill(s, v);
}

static alp_result run(probe_job *job)
{
    const alp_probe_options *o = job->o;
    ALP_TRY(alpi_lighting_create(job->scene, &o->lighting, &job->lighting));
    if (o->layers) {
        ALP_TRY(alpi_probe_layers_plan(job->scene, job->lighting, &job->layers));
    }
    ALP_TRY(alpi_lighting_create_without_lamps(job->scene, &o->lighting, &job->space));
    ALP_TRY(prepare_volume(job));
    ALP_TRY(alpi_tracer_for_scene(job->scene, o->progress, o->progress_user, &job->tracer, NULL));
    ALP_TRY(alpi_examine_light(job->tracer, (alpi_trace_filter){.one_sided = o->one_sided},
                               job->scene, job->lighting, o->progress, o->progress_user));
    ALP_TRY(alpi_lighting_split_sky(job->space, &o->lighting, &job->soft, &job->spots));
    ALP_TRY(solve(job));
    ALP_TRY(prepare_sampling(job));
    aim(job);
    ALP_TRY(sample(job));
    return job->volume->is_list ? ALP_OK : state_interpolation(job);
}

alp_result alp_probes_bake(const alp_scene *scene, const alp_probe_options *options,
                           alp_probes **probes)
{
    if (scene == NULL || probes == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    bool began;
    alp_result result = alpi_probes_begin_ranks(scene, options, &began);
    *probes = NULL;
    if (result == ALP_OK) {
        result = alpi_probes_bake(scene, options, NULL, probes);
    }
    result = began ? alpi_ranks_end(scene->context, result) : result;
    if (result != ALP_OK) {
        alp_probes_destroy(*probes);
        *probes = NULL;
    }
    return result;
}

alp_result alpi_probes_bake(const alp_scene *scene, const alp_probe_options *options,
                            const alpi_surface_light *known, alp_probes **probes)
{
    *probes = NULL;
    const alp_probe_options o = options ? *options : alp_probe_options_default();
    ALP_TRY(check(scene, &o));
    alp_context *context = scene->context;
    alp_probes *made = ALPI_NEW(context, alp_probes, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    made->context = context;
    probe_job job = {.scene = scene, .o = &o, .given = known, .volume = &made->volume};
    const alpi_watch former =
        alpi_set_watch(context, (alpi_watch){.callback = o.progress, .user = o.progress_user});
    const alp_result result = run(&job);
    alpi_set_watch(context, former);
    alpi_release(context, job.sampling.points);
    alpi_release(context, job.sampling.values);
    alpi_release(context, job.sampling.free_probes);
    alpi_probe_layers_clear(context, &job.layers);
    alpi_solution_destroy(job.solution);
    alpi_lighting_destroy(context, job.spots);
    alpi_lighting_destroy(context, job.soft);
    alpi_lighting_destroy(context, job.space);
    alpi_lighting_destroy(context, job.lighting);
    if (result != ALP_OK) {
        alp_probes_destroy(made);
        return result;
    }
    *probes = made;
    return ALP_OK;
}

void alp_probes_destroy(alp_probes *probes)
{
    if (probes != NULL) {
        alpi_probe_volume_destroy(&probes->volume);
        alpi_release(probes->context, probes);
    }
}
