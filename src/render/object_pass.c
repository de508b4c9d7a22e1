// SPDX-License-Identifier: MIT
#include "render/object_pass.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "fields/probes/probes.h"
#include "scene/builtin/mesh_builder.h"
#include "scene/origin.h"
#include "scene/receivers.h"
#include "transport/paths/hit.h"

#include <math.h>
#include <string.h>

enum { STREAM_OBJECT = 31, POINTS_AT_A_TIME = 1 << 16 };
enum { PROBE_SLICES = 16, PROBE_STACKS = 8 };
enum { PROBE_TRIANGLES = 2 * PROBE_SLICES * (PROBE_STACKS - 1), SHOWN_PROBES = 20000 };
static const float PROBE_SIZE = 0.08f; // radius, in cells

/// A point of an object that a camera ray meets.
typedef struct object_point {
    uint32_t pixel, probe; // ALPI_NONE: of no probe
    vec3 position, normal;
} object_point;

typedef struct object_job {
    const alpi_object_pass *pass;
    alp_scene *object;
    alpi_tracer *tracer; // of the object
    uint32_t *shown;     // [spheres] probe of each
    uint32_t shown_count;
    object_point *points; // [POINTS_AT_A_TIME]
    uint32_t count;
    float (*irradiance)[3];       // [POINTS_AT_A_TIME]
    alpi_reference_value *values; // the same by the reference
    alp_image *layer;             // sums of what points show, and how many there are
} object_job;

// --- shapes --------------------------------------------------------------------------------------

/// Square distance of a probe from the camera.
static float distance_of(const object_job *job, uint32_t probe, vec3 *place)
{
    double at[3];
    alp_probes_position(job->pass->probes, probe, at);
    const double *origin = job->pass->scene->origin;
    *place =
        (vec3){(float)(at[0] - origin[0]), (float)(at[1] - origin[1]), (float)(at[2] - origin[2])};
    const vec3 way = vec3_sub(*place, job->pass->view->origin);
    return vec3_dot(way, way);
}

/// A distance within which at most SHOWN_PROBES lie.
static float choose_reach(const object_job *job, uint32_t count)
{
    float low = 0.0f, high = 0.0f;
    vec3 place;
    for (uint32_t i = 0; i < count; i++) {
        high = fmaxf(high, distance_of(job, i, &place));
    }
    high = high * 1.001f + 1.0f;
    if (count <= SHOWN_PROBES) {
        return high;
    }
    for (int step = 0; step < 24; step++) {
        const float middle = 0.5f * (low + high);
        uint32_t within = 0;
        for (uint32_t i = 0; i < count; i++) {
            within += distance_of(job, i, &place) < middle;
        }
        *(within > SHOWN_PROBES ? &high : &low) = middle;
    }
    return low;
}

static alp_result build_probes(object_job *job)
{
    const alp_probes_info info = alp_probes_get_info(job->pass->probes);
    const vec3 white = {1.0f, 1.0f, 1.0f}, black = {0.0f, 0.0f, 0.0f};
    const vec3 size = vec3_sub(job->pass->scene->bounds_max, job->pass->scene->bounds_min);
    const float cell = info.is_list ? 0.1f * vec3_length(size) : info.spacing[0];
    const float reach = choose_reach(job, info.count);
    alpi_builder builder;
    ALPI_TRY_NEW(job->pass->scene->context, job->shown, info.count);
    alpi_builder_start(&builder, job->pass->scene->context, "probes");
    alpi_builder_surface(&builder, "probes",
                         alpi_builder_material(&builder, "white", white, black));
    for (uint32_t i = 0; i < info.count; i++) {
        vec3 place;
        if (distance_of(job, i, &place) < reach) {
            alpi_builder_ball(&builder, &(alpi_ball){.center = place,
                                                     .radius = PROBE_SIZE * cell,
                                                     .top = PROBE_SIZE * cell,
                                                     .slices = PROBE_SLICES,
                                                     .stacks = PROBE_STACKS});
            job->shown[job->shown_count++] = i;
        }
    }
    return alpi_builder_finish(&builder, &job->object);
}

// --- light at points -----------------------------------------------------------------------------

/// A probe's own light; probes in solids get a colour that no light has.
static void light_by_probe(const object_job *job, const object_point *p, float e[3])
{
    static const float filled[3] = {2.5f, 1.6f, 0.0f}, invalid[3] = {2.5f, 0.0f, 2.5f};
    const alp_probes *probes = job->pass->probes;
    const alp_probes_info info = alp_probes_get_info(probes);
    const float mean = info.mean > 0.0f ? info.mean : 1.0f;
    const uint8_t state = alp_probes_states(probes)[p->probe];
    float weights[ALPI_SH9_COUNT];
    for (int k = 0; k < 3; k++) {
        e[k] = mean * (state == ALP_PROBE_FILLED ? filled[k] : invalid[k]);
    }
    if (state == ALP_PROBE_FILLED || state == ALP_PROBE_INVALID) {
        return;
    }
    const float *c =
        alp_probes_coefficients(probes, UINT32_MAX) + (size_t)p->probe * info.coefficients * 3;
    alpi_probe_weights((alpi_probe_basis)info.basis, p->normal, weights);
    for (int k = 0; k < 3; k++) {
        e[k] = 0.0f;
        for (uint32_t i = 0; i < info.coefficients; i++) {
            e[k] += weights[i] * c[3 * i + (uint32_t)k];
        }
        e[k] = fmaxf(e[k], 0.0f);
    }
}

static alp_result light_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const object_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const object_point *p = &job->points[i];
        if (p->probe != ALPI_NONE) {
            light_by_probe(job, p, job->irradiance[i]);
            continue;
        }
        alpi_field_points at = {.count = 1};
        vec3_store(at.positions[0], p->position);
        vec3_store(at.normals[0], p->normal);
        at.offsets[0] = alpi_receiver_offset(p->position, NULL);
        alpi_field_light_at(job->pass->field, &at, &job->irradiance[i]);
    }
    return ALP_OK;
}

static void place_point(const void *user, uint32_t receiver, uint32_t count,
                        const float (*square)[2], alpi_receiver_point *out)
{
    (void)square;
    const object_point *p = &((const object_point *)user)[receiver];
    for (uint32_t i = 0; i < count; i++) {
        out[i] = (alpi_receiver_point){p->position, p->normal, p->normal,
                                       alpi_receiver_offset(p->position, NULL)};
    }
}

static alp_result light_points(object_job *job)
{
    const alpi_object_pass *pass = job->pass;
    const alpi_task_progress progress = {.callback = pass->options->progress,
                                         .user = pass->options->progress_user,
                                         .stage = "object"};
    if (pass->probes != NULL || pass->reference == NULL) {
        return alpi_parallel_for(pass->scene->context, job->count, 256, light_range, job,
                                 &progress);
    }
    const alpi_receivers receivers = {
        .count = job->count, .place = place_point, .user = job->points};
    ALP_TRY(
        alpi_reference_irradiance(pass->reference, &receivers, NULL, 0, &progress, job->values));
    for (uint32_t i = 0; i < job->count; i++) {
        memcpy(job->irradiance[i], job->values[i].mean, sizeof *job->irradiance);
    }
    return ALP_OK;
}

/// Adds the points that were collected to the layer.
static alp_result add_points(object_job *job)
{
    const float share =
        (job->pass->probes != NULL ? 1.0f : ALPI_OBJECT_ALBEDO) * (float)(1.0 / ALPI_PI);
    ALP_TRY(light_points(job));
    for (uint32_t i = 0; i < job->count; i++) {
        float *pixel = (float *)job->layer->pixels + 4 * (size_t)job->points[i].pixel;
        for (int k = 0; k < 3; k++) {
            pixel[k] += share * job->irradiance[i][k];
        }
        pixel[3] += 1.0f;
    }
    job->count = 0;
    return ALP_OK;
}

// --- camera rays ---------------------------------------------------------------------------------

/// Collects the points of a pixel at which an object stands before the scene.
static void meet_object(object_job *job, uint32_t pixel, uint32_t lanes, alpi_rays *rays)
{
    const alpi_trace_filter filter = {.one_sided = true};
    const alpi_trace_filter behind = {.one_sided = job->pass->options->occlusion.one_sided};
    alpi_hits own, scene;
    alpi_trace_nearest_coherent(job->tracer, rays, (1u << lanes) - 1u, filter, &own);
    uint32_t met = 0;
    for (uint32_t i = 0; i < lanes; i++) {
        met |= own.triangle[i] != ALPI_NONE ? 1u << i : 0u;
    }
    if (met == 0) {
        return;
    }
    alpi_trace_nearest_coherent(job->pass->tracer, rays, met, behind, &scene);
    for (; met != 0; met &= met - 1) {
        const int i = __builtin_ctz(met);
        if (scene.triangle[i] != ALPI_NONE && scene.distance[i] < own.distance[i]) {
            continue;
        }
        const vec3 d = {rays->direction_x[i], rays->direction_y[i], rays->direction_z[i]};
        const alpi_receiver_point p = alpi_hit_point(job->object, &own, i, d, NULL);
        const uint32_t sphere = own.triangle[i] / PROBE_TRIANGLES;
        job->points[job->count++] =
            (object_point){.pixel = pixel,
                           .probe = job->pass->probes != NULL ? job->shown[sphere] : ALPI_NONE,
                           .position = p.position,
                           .normal = p.shading_normal};
    }
}

static alp_result trace_pixels(object_job *job)
{
    const alp_render_options *o = job->pass->options;
    const alpi_view *view = job->pass->view;
    alpi_rays rays;
    alpi_rays_clear(&rays);
    for (uint32_t pixel = 0; pixel < o->width * o->height; pixel++) {
        const uint32_t key = alpi_random_key(o->occlusion.seed, pixel, STREAM_OBJECT);
        for (uint32_t first = 0; first < o->samples; first += ALPI_PACKET) {
            const uint32_t rest = o->samples - first;
            const uint32_t lanes = rest < ALPI_PACKET ? rest : ALPI_PACKET;
            view->loops->packet(view, pixel, key, first, &rays);
            if (job->count + lanes > POINTS_AT_A_TIME) {
                ALP_TRY(add_points(job));
            }
            meet_object(job, pixel, lanes, &rays);
        }
        ALP_TRY(alpi_tick(job->pass->scene->context, "object", pixel, o->width * o->height));
    }
    return add_points(job);
}

static void compose(const object_job *job, alp_image *image)
{
    const alp_render_options *o = job->pass->options;
    for (size_t i = 0; i < (size_t)o->width * o->height; i++) {
        float *pixel = (float *)image->pixels + 4 * i;
        const float *own = (const float *)job->layer->pixels + 4 * i;
        const float cover = own[3] / (float)o->samples, behind = pixel[3] * (1.0f - cover);
        const float alpha = cover + behind;
        for (int k = 0; k < 3 && cover > 0.0f; k++) {
            pixel[k] = (own[k] / (float)o->samples + behind * pixel[k]) / alpha;
        }
        pixel[3] = cover > 0.0f ? alpha : pixel[3];
    }
}

static alp_result draw(object_job *job, alp_image *image)
{
    alp_context *context = job->pass->scene->context;
    const alp_render_options *o = job->pass->options;
    const alp_image_info info = {o->width, o->height, 4, ALP_COMPONENT_FLOAT};
    ALP_TRY(job->pass->probes != NULL ? build_probes(job)
                                      : alp_render_object_mesh(context, &o->object, &job->object));
    if (job->object->usable_count == 0) {
        return ALP_OK;
    }
    ALP_TRY(alpi_tracer_for_scene(job->object, NULL, NULL, &job->tracer, NULL));
    ALPI_TRY_NEW(context, job->points, POINTS_AT_A_TIME);
    ALPI_TRY_NEW(context, job->irradiance, POINTS_AT_A_TIME);
    ALPI_TRY_NEW(context, job->values, POINTS_AT_A_TIME);
    ALP_TRY(alp_image_create(context, info, &job->layer));
    ALP_TRY(trace_pixels(job));
    compose(job, image);
    return ALP_OK;
}

alp_result alpi_object_pass_draw(const alpi_object_pass *pass, alp_image *image)
{
    alp_context *context = pass->scene->context;
    object_job job = {.pass = pass};
    const alp_result result = draw(&job, image);
    alp_image_destroy(job.layer);
    alpi_release(context, job.values);
    alpi_release(context, job.irradiance);
    alpi_release(context, job.points);
    alpi_release(context, job.shown);
    alp_scene_destroy(job.object);
    return result;
}
