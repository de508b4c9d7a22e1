// SPDX-License-Identifier: MIT
// Which polygons the emitters of a scene are.
#include "transport/direct/direct_polygons.h"

#include <math.h>
#include <string.h>

static bool is_even(const alp_scene *scene, uint32_t triangle)
{
    const alpi_material *m =
        &scene->materials[scene->surfaces[scene->triangle_surface[triangle]].material];
    return m->alpha_mode == ALPI_ALPHA_OPAQUE && (m->emission_texture.image == ALPI_NONE ||
                                                  scene->images[m->emission_texture.image] == NULL);
}

/// A triangle; false where it has no shape that floats can hold.
static bool start_polygon(const alp_scene *scene, uint32_t triangle, alpi_polygon *p)
{
    vec3 c[3];
    const vec3 none = {0.0f, 0.0f, 0.0f};
    alpi_triangle_corners(scene, triangle, c);
    *p = (alpi_polygon){.corner = {c[0], c[1], c[2], c[0]},
                        .triangle = true,
                        .two_sided = alpi_surface_is_double_sided(scene, triangle),
                        .normal = vec3_triangle_normal(c[0], c[1], c[2], none)};
    p->radiance = alpi_surface_emission(scene, triangle, 1.0f / 3.0f, 1.0f / 3.0f, p->normal);
    return vec3_length(p->normal) > 0.0f;
}

static bool same(vec3 a, vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/// Makes two triangles one where they share an edge of opposite ways, and the corners beyond it lie
/// as those of a parallelogram, to within rounding.
static bool join(alpi_polygon *p, const alpi_polygon *q)
{
    for (int i = 0; i < 3 && p->triangle; i++) {
        for (int j = 0; j < 3; j++) {
            // The edge from corner i to the next, with a opposite in p and b in q.
            const vec3 from = p->corner[i], to = p->corner[i + 1], a = p->corner[(i + 2) % 3];
            const vec3 b = q->corner[(j + 2) % 3];
            const vec3 apart = vec3_sub(vec3_add(a, b), vec3_add(from, to));
            const float size = vec3_length(from) + vec3_length(to) + vec3_length(vec3_sub(a, b));
            if (same(from, q->corner[j + 1]) && same(to, q->corner[j]) &&
                vec3_length(apart) <= 4.0f * 0x1p-23f * size &&
                vec3_dot(p->normal, q->normal) > 0.0f) {
                const vec3 corner[4] = {from, b, to, a};
                memcpy(p->corner, corner, sizeof corner);
                p->triangle = false;
                return true;
            }
        }
    }
    return false;
}

static void measure(alpi_polygon *p)
{
    const vec3 *c = p->corner;
    const vec3 third = p->triangle ? c[2] : c[3];
    p->along = vec3_sub(c[1], c[0]);
    p->across = vec3_sub(third, c[0]);
    p->area = (float)(vec3_triangle_area(c[0], c[1], third) * (p->triangle ? 1.0 : 2.0));
    p->middle = vec3_scale(vec3_add(c[0], c[2]), 0.5f);
    for (int k = 0; k < 4; k++) {
        for (int j = 0; j < k; j++) {
            p->diameter = fmaxf(p->diameter, vec3_length(vec3_sub(c[k], c[j])));
        }
    }
}

uint32_t alpi_polygons_collect(const alpi_direct_emitters *emitters, const uint32_t *parts,
                               alpi_polygon polygons[ALPI_POLYGON_LIMIT])
{
    const alp_scene *scene = emitters->scene;
    const alpi_emitters *all = &emitters->all;
    uint32_t count = 0, last_surface = ALPI_NONE;
    if (all->count > ALPI_POLYGON_LIMIT) {
        return 0;
    }
    for (uint32_t i = 0; i < all->count; i++) {
        alpi_polygon p;
        const uint32_t surface = scene->triangle_surface[all->triangles[i]];
        if (!is_even(scene, all->triangles[i]) || !start_polygon(scene, all->triangles[i], &p)) {
            return 0;
        }
        p.part = parts[scene->surfaces[surface].material];
        if (count == 0 || surface != last_surface || !join(&polygons[count - 1], &p)) {
            polygons[count++] = p;
        }
        last_surface = surface;
    }
    for (uint32_t i = 0; i < count; i++) {
        measure(&polygons[i]);
    }
    return count;
}
