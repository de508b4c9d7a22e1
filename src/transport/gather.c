// SPDX-License-Identifier: MIT
#include "transport/gather.h"

#include "scene/double3.h"
#include "transport/panes.h"

/// Points that rays of a packet have met, and whose they are.
typedef struct met_points {
    uint32_t count;
    int lanes[ALPI_PACKET];
    alpi_surface_point points[ALPI_PACKET];
} met_points;

static bool is_behind(const alp_scene *scene, uint32_t triangle, vec3 direction)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    const double3 outside = double3_cross(double3_between(c[0], c[1]), double3_between(c[0], c[2]));
    return double3_dot(outside, double3_from(direction)) > 0.0;
}

static void add_light(vec3 *sum, vec3 light, vec3 left)
{
    sum->x += light.x * left.x;
    sum->y += light.y * left.y;
    sum->z += light.z * left.z;
}

static vec3 sky_radiance(const alpi_gather_scene *from, vec3 direction)
{
    const alpi_sky *sky =
        from->sky && from->lighting != NULL ? alpi_lighting_sky(from->lighting) : NULL;
    return sky != NULL ? alpi_sky_radiance(sky, direction) : (vec3){0.0f, 0.0f, 0.0f};
}

/// Lists what is not black, and adds sky to the rays that leave.
static void sort_hits(const alpi_gather_scene *from, const alpi_rays *rays, const alpi_hits *hits,
                      uint32_t active, met_points *met, const vec3 *left, vec3 *radiance)
{
    met->count = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((active >> i & 1u) == 0) {
            continue;
        }
        const vec3 direction = {rays->direction_x[i], rays->direction_y[i], rays->direction_z[i]};
        const uint32_t triangle = hits->triangle[i];
        if (triangle == ALPI_NONE) {
            add_light(&radiance[i], sky_radiance(from, direction), left[i]);
            continue;
        }
        const bool behind = is_behind(from->scene, triangle, direction);
        if (!behind || alpi_surface_is_double_sided(from->scene, triangle)) {
            met->lanes[met->count] = i;
            met->points[met->count++] = (alpi_surface_point){triangle, hits->b1[i], hits->b2[i],
                                                             vec3_scale(direction, -1.0f), behind};
        }
    }
}

static void add_surfaces(const alpi_gather_scene *from, const met_points *met, const vec3 *left,
                         vec3 *radiance)
{
    vec3 reflected[ALPI_PACKET];
    if (from->light.reflected != NULL && met->count > 0) {
        from->light.reflected(from->light.user, met->points, met->count, reflected);
    }
    for (uint32_t k = 0; k < met->count; k++) {
        const alpi_surface_point *p = &met->points[k];
        const int i = met->lanes[k];
        if (from->light.reflected != NULL) {
            add_light(&radiance[i], reflected[k], left[i]);
        }
        if (from->emitters) {
            const vec3 emitted =
                alpi_surface_emission(from->scene, p->triangle, p->b1, p->b2, p->toward);
            add_light(&radiance[i], emitted, left[i]);
        }
    }
}

void alpi_gather_look(const alpi_gather_scene *from, alpi_rays *rays, uint32_t active,
                      bool coherent, vec3 radiance[ALPI_PACKET])
{
    alpi_trace_filter filter = from->filter;
    filter.panes = alpi_tracer_has_panes(from->tracer);
    vec3 left[ALPI_PACKET];
    for (int i = 0; i < ALPI_PACKET; i++) {
        radiance[i] = (vec3){0.0f, 0.0f, 0.0f};
        left[i] = (vec3){1.0f, 1.0f, 1.0f};
    }
    for (int passed = 0; active != 0 && passed < ALPI_PANE_LIMIT; passed++) {
        alpi_hits hits;
        met_points met;
        if (coherent) {
            alpi_trace_nearest_coherent(from->tracer, rays, active, filter, &hits);
        } else {
            alpi_trace_nearest(from->tracer, rays, active, filter, &hits);
        }
        sort_hits(from, rays, &hits, active, &met, left, radiance);
        add_surfaces(from, &met, left, radiance);
        active = filter.panes ? alpi_panes_go_on(from->scene, &hits, active, rays, left) : 0;
    }
}
