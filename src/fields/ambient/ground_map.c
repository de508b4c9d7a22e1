// SPDX-License-Identifier: MIT
#include "fields/ambient/ground_map.h"

#include "base/memory.h"
#include "scene/lights/lighting.h"
#include "transport/paths/hit.h"

#include <math.h>
#include <string.h>

enum { TEXELS = ALPI_GROUND_SIDE * ALPI_GROUND_SIDE };

/// Points on the ground, the texels that they light, and what their surfaces do to light.
typedef struct ground_points {
    uint32_t count;
    uint32_t texels[TEXELS];
    float positions[TEXELS][3], normals[TEXELS][3];
    vec3 albedos[TEXELS], emissions[TEXELS];
    alpi_reference_value values[TEXELS];
} ground_points;

static void keep_hits(const alp_scene *scene, const alpi_hits *hits, uint32_t first,
                      ground_points *ground)
{
    const vec3 down = {0.0f, -1.0f, 0.0f}, up = {0.0f, 1.0f, 0.0f};
    for (int i = 0; i < ALPI_PACKET; i++) {
        const uint32_t triangle = hits->triangle[i];
        if (triangle == ALPI_NONE) {
            continue;
        }
        const uint32_t at = ground->count++;
        const alpi_receiver_point p = alpi_hit_point(scene, hits, i, down, NULL);
        const float b1 = hits->b1[i], b2 = hits->b2[i];
        ground->texels[at] = first + (uint32_t)i;
        vec3_store(ground->positions[at], vec3_mad(p.position, p.offset, p.geometric_normal));
        vec3_store(ground->normals[at], p.shading_normal);
        ground->albedos[at] = alpi_surface_albedo(scene, triangle, b1, b2);
        ground->emissions[at] = alpi_surface_emission(scene, triangle, b1, b2, up);
    }
}

/// Rays straight down through the middles of texels. Backs of single-sided surfaces are open, so
/// that a ceiling without a roof does not hide its floor.
static alp_result find_ground(const alp_scene *scene, const alp_reference_options *o,
                              const alpi_ground_map *map, ground_points *ground)
{
    const vec3 size = vec3_sub(scene->bounds_max, scene->bounds_min);
    const float top = scene->bounds_max.y + 1e-3f * vec3_length(size);
    const alpi_trace_filter filter = {.one_sided = true};
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(scene, o->progress, o->progress_user, &tracer, NULL));
    for (uint32_t first = 0; first < TEXELS; first += ALPI_PACKET) {
        alpi_rays rays;
        alpi_hits hits;
        alpi_rays_clear(&rays);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            const uint32_t column = (first + i) % ALPI_GROUND_SIDE;
            const uint32_t row = (first + i) / ALPI_GROUND_SIDE;
            const vec3 from = {map->low[0] + ((float)column + 0.5f) / map->scale[0], top,
                               map->low[1] + ((float)row + 0.5f) / map->scale[1]};
            alpi_rays_set(&rays, (int)i, from, (vec3){0.0f, -1.0f, 0.0f}, INFINITY);
        }
        alpi_trace_nearest(tracer, &rays, 0xffu, filter, &hits);
        keep_hits(scene, &hits, first, ground);
    }
    return ALP_OK;
}

static alp_result light_ground(const alp_scene *scene, const alp_reference_options *options,
                               ground_points *ground, alpi_ground_map *map)
{
    alp_reference_options o = *options;
    o.direct = true; // all light that falls on the ground leaves it again
    ALP_TRY(find_ground(scene, &o, map, ground));
    ALP_TRY(alpi_truth_at_points(scene, &o, ground->count, (const float(*)[3])ground->positions,
                                 (const float(*)[3])ground->normals, "fit", ground->values));
    for (uint32_t i = 0; i < ground->count; i++) {
        const float *e = ground->values[i].mean;
        const vec3 a = ground->albedos[i], g = ground->emissions[i];
        const vec3 b = {a.x * e[0] + (float)ALPI_PI * g.x, a.y * e[1] + (float)ALPI_PI * g.y,
                        a.z * e[2] + (float)ALPI_PI * g.z};
        vec3_store(map->texels[ground->texels[i]], b);
    }
    return ALP_OK;
}

alp_result alpi_ground_map_make(const alp_scene *scene, const alp_reference_options *options,
                                alpi_ground_map *map)
{
    const vec3 low = scene->bounds_min, high = scene->bounds_max;
    const float least = 1e-6f * (1.0f + vec3_length(vec3_sub(high, low)));
    memset(map, 0, sizeof *map);
    map->low[0] = low.x;
    map->low[1] = low.z;
    map->scale[0] = ALPI_GROUND_SIDE / fmaxf(high.x - low.x, least);
    map->scale[1] = ALPI_GROUND_SIDE / fmaxf(high.z - low.z, least);
    ground_points *ground = ALPI_NEW(scene->context, ground_points, 1);
    if (ground == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result = light_ground(scene, options, ground, map);
    alpi_release(scene->context, ground);
    return result;
}

void alpi_ground_map_read(const alpi_ground_map *map, float x, float z, float radiosity[3])
{
    const float at[2] = {(x - map->low[0]) * map->scale[0] - 0.5f,
                         (z - map->low[1]) * map->scale[1] - 0.5f};
    int cell[2];
    float part[2];
    for (int k = 0; k < 2; k++) {
        const float clamped = fminf(fmaxf(at[k], 0.0f), (float)ALPI_GROUND_SIDE - 1.0f);
        cell[k] = clamped < ALPI_GROUND_SIDE - 2 ? (int)clamped : ALPI_GROUND_SIDE - 2;
        part[k] = clamped - (float)cell[k];
    }
    const float(*t)[3] = &map->texels[cell[1] * ALPI_GROUND_SIDE + cell[0]];
    for (int k = 0; k < 3; k++) {
        const float near = t[0][k] + part[0] * (t[1][k] - t[0][k]);
        const float far = t[ALPI_GROUND_SIDE][k] +
                          part[0] * (t[ALPI_GROUND_SIDE + 1][k] - t[ALPI_GROUND_SIDE][k]);
        radiosity[k] = near + part[1] * (far - near);
    }
}
