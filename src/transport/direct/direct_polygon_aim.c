// SPDX-License-Identifier: MIT
#include "transport/direct/direct_polygon_aim.h"

#include "scene/lights/triangle_light.h"

enum { CORNERS = 4, CLIPPED = CORNERS + 1 }; // a convex polygon has one more where a plane cuts it

void alpi_polygon_aim_near(alpi_polygon_wave *w, const alpi_polygon *p, uint32_t s, uint32_t lane)
{
    const vec3 origin = {w->origin[0][s][lane], w->origin[1][s][lane], w->origin[2][s][lane]};
    const vec3 normal = {w->normal[0][s][lane], w->normal[1][s][lane], w->normal[2][s][lane]};
    const vec3 halves[2][3] = {{p->corner[0], p->corner[1], p->corner[2]},
                               {p->corner[0], p->corner[2], p->corner[3]}};
    alpi_triangle_view views[2];
    vec2 u = {w->u[s][lane], w->v[s][lane]};
    views[0] = alpi_triangle_view_from(origin, halves[0]);
    double chance = 1.0;
    uint32_t k = 0;
    if (!p->triangle) {
        views[1] = alpi_triangle_view_from(origin, halves[1]);
        const double both = views[0].solid_angle + views[1].solid_angle;
        const double first = both > 0.0 ? views[0].solid_angle / both : 0.5;
        k = (double)u.x >= first;
        chance = k == 0 ? first : 1.0 - first;
        u.x = (float)(((double)u.x - (k == 0 ? 0.0 : first)) / chance); // as even as it was
        u.x = fminf(fmaxf(u.x, 0.0f), 1.0f - 0x1p-24f);
    }
    const vec3 direction = double3_to_vec3(alpi_triangle_sample(&views[k], u));
    const double3 along = double3_from(direction);
    const float cosine = vec3_dot(direction, normal);
    const double density = chance * alpi_triangle_density(&views[k], along);
    const float weight = density > 0.0 ? (float)((double)cosine / density) : 0.0f;
    const bool gives = w->factor[s][lane] > 0.0 && weight > 0.0f && isfinite(weight);
    const float distance = (float)alpi_triangle_hit_at(&views[k], along).distance;
    const float reach = distance * (1.0f - 1e-5f) - 2.0f * w->offset[s][lane];
    w->weight[s][lane] = gives ? weight : 0.0f;
    alpi_rays_set(&w->rays[s], (int)lane, origin, direction, gives && reach > 0.0f ? reach : 0.0f);
}

// --- above the horizon ---------------------------------------------------------------------------

/// What of a polygon is above the horizon, relative to where rays start.
typedef struct upper_part {
    uint32_t count;
    double3 corner[CLIPPED + 1];
    double ends[CLIPPED]; // area of the fan's triangles up to the end of each
    double area;
} upper_part;

/// Sutherland and Hodgman's clipping, against one plane.
static void clip(const alpi_polygon *p, vec3 origin, double3 normal, upper_part *out)
{
    const uint32_t corners = p->triangle ? CORNERS - 1 : CORNERS;
    out->count = 0;
    for (uint32_t k = 0; k < corners; k++) {
        const double3 a = double3_between(origin, p->corner[k]);
        const double3 b = double3_between(origin, p->corner[(k + 1) % corners]);
        const double ha = double3_dot(a, normal), hb = double3_dot(b, normal);
        if (ha > 0.0) {
            out->corner[out->count++] = a;
        }
        if ((ha > 0.0) != (hb > 0.0)) {
            const double t = ha / (ha - hb);
            out->corner[out->count++] = double3_add(double3_scale(a, 1.0 - t), double3_scale(b, t));
        }
    }
    out->area = 0.0;
    for (uint32_t k = 0; k + 2 < out->count; k++) {
        const double3 first = double3_scale(out->corner[0], -1.0);
        out->area += 0.5 * double3_length(double3_cross(double3_add(out->corner[k + 1], first),
                                                        double3_add(out->corner[k + 2], first)));
        out->ends[k] = out->area;
    }
}

/// A point of even density over its area.
static double3 point_of(const upper_part *part, double u, double v)
{
    uint32_t k = 0;
    while (k + 3 < part->count && u * part->area >= part->ends[k]) {
        k++;
    }
    const double begin = k == 0 ? 0.0 : part->ends[k - 1], width = part->ends[k] - begin;
    const double inside = width > 0.0 ? (u * part->area - begin) / width : 0.0;
    const double root = sqrt(fmin(fmax(inside, 0.0), 1.0)); // as many as the triangle is wide
    const double weights[3] = {1.0 - root, root * (1.0 - v), root * v};
    return double3_add(double3_scale(part->corner[0], weights[0]),
                       double3_add(double3_scale(part->corner[k + 1], weights[1]),
                                   double3_scale(part->corner[k + 2], weights[2])));
}

void alpi_polygon_aim_above(alpi_polygon_wave *w, const alpi_polygon *p, uint32_t s, uint32_t lane)
{
    const vec3 origin = {w->origin[0][s][lane], w->origin[1][s][lane], w->origin[2][s][lane]};
    const vec3 axis = {w->normal[0][s][lane], w->normal[1][s][lane], w->normal[2][s][lane]};
    const double3 normal = double3_from(axis);
    upper_part part;
    clip(p, origin, normal, &part);
    const bool any = part.count >= 3 && part.area > 0.0;
    const double3 to = any ? point_of(&part, (double)w->u[s][lane], (double)w->v[s][lane])
                           : (double3){0.0, 0.0, 0.0};
    const double distance = double3_length(to);
    const double3 direction = double3_scale(to, distance > 0.0 ? 1.0 / distance : 0.0);
    const double there = fabs(double3_dot(direction, double3_from(p->normal)));
    const double cosine = double3_dot(direction, normal);
    const float weight =
        distance > 0.0 ? (float)(part.area * cosine * there / (distance * distance)) : 0.0f;
    const bool gives = weight > 0.0f && isfinite(weight);
    const float reach = (float)distance * (1.0f - 1e-5f) - 2.0f * w->offset[s][lane];
    w->weight[s][lane] = gives ? weight : 0.0f;
    alpi_rays_set(&w->rays[s], (int)lane, origin, double3_to_vec3(direction),
                  gives && reach > 0.0f ? reach : 0.0f);
}
