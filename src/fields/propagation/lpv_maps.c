// SPDX-License-Identifier: MIT
// Maps by rays: what each texel of a lamp's or a camera's view sees.
#include "fields/propagation/lpv_maps.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "transport/paths/hit.h"

#include <math.h>
#include <string.h>

enum { STREAM_TEXEL = 31 };
static const float ASPECT_LEAST = 1e-5f, ASPECT_MOST = 1e5f; // of a camera's view
/// Areas seen at a smaller cosine than this are taken as at it: they would be a few huge surfels.
static const float LEAST_COSINE = 0.02f;

// --- surfels -------------------------------------------------------------------------------------

static alp_result allocate(alp_context *context, uint32_t count, alpi_surfels *s)
{
    ALPI_TRY_NEW(context, s->positions, count);
    ALPI_TRY_NEW(context, s->normals, count);
    ALPI_TRY_NEW(context, s->flux, count);
    ALPI_TRY_NEW(context, s->albedo, count);
    ALPI_TRY_NEW(context, s->areas, count);
    ALPI_TRY_NEW(context, s->radii, count);
    return ALP_OK;
}

alp_result alpi_surfels_create(alp_context *context, uint32_t count, alpi_surfels *surfels)
{
    *surfels = (alpi_surfels){.count = count};
    const alp_result result = allocate(context, count, surfels);
    if (result != ALP_OK) {
        alpi_surfels_destroy(context, surfels);
        return result;
    }
    for (uint32_t i = 0; i < count; i++) {
        surfels->normals[i][1] = 1.0f;
    }
    return ALP_OK;
}

void alpi_surfels_destroy(alp_context *context, alpi_surfels *s)
{
    alpi_release(context, s->positions);
    alpi_release(context, s->normals);
    alpi_release(context, s->flux);
    alpi_release(context, s->albedo);
    alpi_release(context, s->areas);
    alpi_release(context, s->radii);
    *s = (alpi_surfels){.count = 0};
}

alp_lpv_surfels alpi_surfels_view(const alpi_surfels *s)
{
    return (alp_lpv_surfels){.count = s->count,
                             .positions = (const float(*)[3])s->positions,
                             .normals = (const float(*)[3])s->normals,
                             .flux = (const float(*)[3])s->flux,
                             .areas = s->areas,
                             .albedo = (const float(*)[3])s->albedo,
                             .radii = s->radii};
}

/// First surface of the object of surface `s`. @param last the same of surface s − 1
static uint32_t first_of_object(const alp_scene *scene, uint32_t s, uint32_t last)
{
    const alpi_surface *a = &scene->surfaces[s], *b = &scene->surfaces[last];
    return s > 0 && a->node == b->node && a->instance == b->instance ? last : s;
}

static void find_radii(const alp_scene *scene, vec3 (*bounds)[2], float *radii)
{
    for (uint32_t s = 0, first = 0; s < scene->surface_count; s++) {
        const alpi_surface *a = &scene->surfaces[s];
        first = first_of_object(scene, s, first);
        if (first == s) {
            bounds[s][0] = (vec3){INFINITY, INFINITY, INFINITY};
            bounds[s][1] = vec3_scale(bounds[s][0], -1.0f);
        }
        for (uint32_t v = 0; v < a->vertex_count; v++) {
            const vec3 p = vec3_load(scene->positions[a->first_vertex + v]);
            bounds[first][0] = vec3_min(bounds[first][0], p);
            bounds[first][1] = vec3_max(bounds[first][1], p);
        }
    }
    for (uint32_t s = 0, first = 0; s < scene->surface_count; s++) {
        first = first_of_object(scene, s, first);
        radii[s] = 0.5f * vec3_length(vec3_sub(bounds[first][1], bounds[first][0]));
    }
}

alp_result alpi_find_object_radii(const alp_scene *scene, float **radii)
{
    vec3(*bounds)[2] = alpi_allocate(scene->context, scene->surface_count, sizeof *bounds);
    *radii = bounds != NULL ? ALPI_NEW(scene->context, float, scene->surface_count) : NULL;
    if (*radii != NULL) {
        find_radii(scene, bounds, *radii);
    }
    alpi_release(scene->context, bounds);
    return *radii != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}

// --- views ---------------------------------------------------------------------------------------

alpi_map_view alpi_sun_view(const alp_scene *scene, vec3 travel, const double low[3],
                            const double high[3], uint32_t size)
{
    const vec3 bounds = vec3_sub(scene->bounds_max, scene->bounds_min);
    const vec3 middle = vec3_mad(scene->bounds_min, 0.5f, bounds);
    vec3 axes[2];
    double centre[2], half[2];
    uint32_t shift[2];
    vec3_frame(travel, &axes[0], &axes[1]);
    for (int a = 0; a < 2; a++) {
        const float along[3] = {axes[a].x, axes[a].y, axes[a].z};
        centre[a] = half[a] = 0.0;
        for (int k = 0; k < 3; k++) {
            centre[a] += 0.5 * (low[k] + high[k]) * (double)along[k];
            half[a] += 0.5 * (high[k] - low[k]) * fabs((double)along[k]);
        }
        // Texels stay where they are in the world when the box moves. The box is covered wherever
        // its centre lies within one.
        const double texel = 2.0 * half[a] / (size - 1), steps = floor(centre[a] / texel + 0.5);
        centre[a] = texel * steps;
        half[a] += 0.5 * texel;
        shift[a] = (uint32_t)(int64_t)fmod(steps, 0x1p32);
    }
    // The rectangle lies before the scene.
    const float back = vec3_dot(middle, travel) - 0.5f * vec3_length(bounds) * 1.01f;
    alpi_map_view v = {.parallel = true, .axis = travel, .size = size};
    v.origin = vec3_scale(travel, back);
    v.origin = vec3_mad(v.origin, (float)centre[0], axes[0]);
    v.origin = vec3_mad(v.origin, (float)centre[1], axes[1]);
    v.right = vec3_scale(axes[0], (float)half[0]);
    v.up = vec3_scale(axes[1], (float)half[1]);
    memcpy(v.shift, shift, sizeof v.shift);
    return v;
}

alpi_map_view alpi_cube_view(vec3 eye, uint32_t face, uint32_t size)
{
    const float s = face % 2 == 0 ? 1.0f : -1.0f;
    const uint32_t axis = face / 2;
    const vec3 forward = {axis == 0 ? s : 0.0f, axis == 1 ? s : 0.0f, axis == 2 ? s : 0.0f};
    return alpi_cone_view(eye, forward, (float)ALPI_PI / 4.0f, size);
}

alpi_map_view alpi_cone_view(vec3 eye, vec3 axis, float half, uint32_t size)
{
    alpi_map_view v = {.origin = eye, .axis = axis, .size = size};
    vec3_frame(axis, &v.right, &v.up);
    v.right = vec3_scale(v.right, tanf(half));
    v.up = vec3_scale(v.up, tanf(half));
    return v;
}

alp_result alpi_camera_map_view(alp_context *context, const alp_camera *c, float aspect,
                                uint32_t size, alpi_map_view *view)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    const vec3 none = {0.0f, 0.0f, 0.0f}, eye = vec3_load(c->position);
    const vec3 forward = vec3_normalize_or(vec3_sub(vec3_load(c->target), eye), none);
    const vec3 right = vec3_normalize_or(vec3_cross(forward, vec3_load(c->up)), none);
    const bool fov_is_valid = c->vertical_fov > 0.0f && c->vertical_fov < (float)ALPI_PI;
    if (!vec3_is_finite(eye) || !(vec3_length(right) > 0.0f) || !fov_is_valid) {
        return alpi_fail(context, code,
                         "lpv camera: its position must be finite and differ from the target, the "
                         "view not along up, the field of view inside (0, pi)");
    }
    if (!(aspect >= ASPECT_LEAST && aspect <= ASPECT_MOST)) {
        return alpi_fail(context, code, "lpv camera: an aspect of %g, need %g to %g",
                         (double)aspect, (double)ASPECT_LEAST, (double)ASPECT_MOST);
    }
    const float half = tanf(0.5f * c->vertical_fov);
    *view = (alpi_map_view){.origin = eye,
                            .axis = forward,
                            .right = vec3_scale(right, half * aspect),
                            .up = vec3_scale(vec3_cross(right, forward), half),
                            .size = size};
    return ALP_OK;
}

// --- tracing -------------------------------------------------------------------------------------

typedef struct view_job {
    const alpi_map_scene *in;
    const alpi_map_view *view;
    const alpi_lighting *lighting;
    uint32_t light, first;
    alpi_surfels *surfels;
} view_job;

typedef struct texel_ray {
    vec3 origin, direction;
    float area; // parallel: m² across the ray; else its solid angle
} texel_ray;

/// The ray of a texel. Its place within it is the same in every frame, also where the map moved.
static texel_ray aim_texel(const view_job *job, uint32_t x, uint32_t y)
{
    const alpi_map_view *v = job->view;
    const uint64_t texel = (uint64_t)(y + v->shift[1]) << 32 | (x + v->shift[0]);
    const uint32_t key = alpi_random_key(job->in->seed, texel, STREAM_TEXEL);
    const vec2 u = alpi_sample_2d(key, 0);
    const float side = 2.0f / (float)v->size;
    const float across = ((float)x + u.x) * side - 1.0f, upward = ((float)y + u.y) * side - 1.0f;
    const float rectangle = vec3_length(v->right) * vec3_length(v->up) * side * side;
    const vec3 beside = vec3_mad(vec3_scale(v->right, across), upward, v->up);
    texel_ray ray = {v->origin, v->axis, rectangle};
    if (v->parallel) {
        ray.origin = vec3_add(v->origin, beside);
    } else {
        const vec3 d = vec3_add(v->axis, beside);
        const float length = vec3_length(d);
        ray.direction = vec3_scale(d, 1.0f / length);
        ray.area = rectangle / (length * length * length);
    }
    return ray;
}

/// Flux that the first surface of a texel reflects: albedo × E⊥ × area across the way of a sun,
/// albedo × E d² × solid angle of a lamp.
static vec3 find_flux(const view_job *job, const texel_ray *ray, float distance, vec3 position)
{
    const alpi_light *light = alpi_lighting_light(job->lighting, job->light);
    if (job->view->parallel) {
        return vec3_scale(light->color, light->intensity * ray->area);
    }
    alpi_light_sample s;
    const vec2 middle = {0.5f, 0.5f};
    if (!alpi_lighting_sample_light(job->lighting, job->light, position, middle, &s)) {
        return (vec3){0.0f, 0.0f, 0.0f};
    }
    return vec3_scale(s.light, distance * distance * ray->area);
}

static void fill_surfel(const view_job *job, const alpi_hits *hits, int lane, const texel_ray *ray,
                        uint32_t index)
{
    const alp_scene *scene = job->in->scene;
    const uint32_t triangle = hits->triangle[lane];
    const float b1 = hits->b1[lane], b2 = hits->b2[lane], distance = hits->distance[lane];
    bool behind;
    const alpi_receiver_point p = alpi_hit_point(scene, hits, lane, ray->direction, &behind);
    const bool black = behind && !alpi_surface_is_double_sided(scene, triangle);
    const vec3 rho = alpi_surface_albedo(scene, triangle, b1, b2);
    alpi_surfels *s = job->surfels;
    const float across = job->view->parallel ? ray->area : ray->area * distance * distance;
    const float cosine = -vec3_dot(ray->direction, p.geometric_normal);
    vec3_store(s->positions[index], p.position);
    vec3_store(s->normals[index], p.shading_normal);
    s->areas[index] = across / fmaxf(cosine, LEAST_COSINE);
    s->radii[index] = job->in->radii[scene->triangle_surface[triangle]];
    if (!black) {
        vec3_store(s->albedo[index], rho);
        if (job->light != ALPI_NONE) {
            const vec3 f = find_flux(job, ray, distance, p.position);
            vec3_store(s->flux[index], (vec3){rho.x * f.x, rho.y * f.y, rho.z * f.z});
        }
    }
}

/// Blocks of 4 × 2 texels, a packet each. Blocks at the edge have lanes beyond it.
static alp_result trace_blocks(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const view_job *job = user;
    const uint32_t size = job->view->size, wide = (size + 3) / 4;
    for (uint32_t block = begin; block < end; block++) {
        texel_ray texels[ALPI_PACKET];
        uint32_t index[ALPI_PACKET], active = 0;
        alpi_rays rays;
        alpi_hits hits;
        alpi_rays_clear(&rays);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            const uint32_t x = block % wide * 4 + i % 4, y = block / wide * 2 + i / 4;
            if (x < size && y < size) {
                texels[i] = aim_texel(job, x, y);
                alpi_rays_set(&rays, (int)i, texels[i].origin, texels[i].direction, INFINITY);
                index[i] = job->first + y * size + x;
                active |= 1u << i;
            }
        }
        alpi_trace_nearest_coherent(job->in->tracer, &rays, active, (alpi_trace_filter){0}, &hits);
        for (; active != 0; active &= active - 1) {
            const int i = __builtin_ctz(active);
            if (hits.triangle[i] != ALPI_NONE) {
                fill_surfel(job, &hits, i, &texels[i], index[i]);
            }
        }
    }
    return ALP_OK;
}

alp_result alpi_trace_view(const alpi_map_scene *in, const alpi_map_view *view,
                           const alpi_lighting *lighting, uint32_t light, uint32_t first,
                           alpi_surfels *surfels)
{
    enum { BLOCKS_A_TASK = 128 };
    view_job job = {in, view, lighting, light, first, surfels};
    const uint32_t blocks = (view->size + 3) / 4 * ((view->size + 1) / 2);
    return alpi_parallel_for(in->scene->context, blocks, BLOCKS_A_TASK, trace_blocks, &job, NULL);
}
