// SPDX-License-Identifier: MIT
// Triangles and rays without order, for tests of tracers.
#ifndef SOUP_H
#define SOUP_H

#include "test_scenes.h"

#include "base/random.h"
#include "trace/trace.h"

#include <math.h>

/// A soup of triangles with sides of .02 m to about `largest` in a cube of 2 m.
static inline alp_scene *soup_make(alp_context *context, uint32_t triangles, float largest)
{
    test_mesh *mesh = test_mesh_start();
    for (uint32_t i = 0; i < triangles; i++) {
        float center[3], edge[2][3];
        float size = 0.02f + alpi_unit_float(alpi_hash32(7 * i)) * largest;
        for (uint32_t k = 0; k < 3; k++) {
            center[k] = alpi_unit_float(alpi_hash32(100 * i + k)) * 2.0f - 1.0f;
            edge[0][k] = size * (alpi_unit_float(alpi_hash32(100 * i + k + 10)) - 0.5f);
            edge[1][k] = size * (alpi_unit_float(alpi_hash32(100 * i + k + 20)) - 0.5f);
        }
        uint32_t v[3];
        for (int c = 0; c < 3; c++) {
            double p[3];
            for (int k = 0; k < 3; k++) {
                p[k] = (double)center[k] + (c > 0 ? (double)edge[c - 1][k] : 0.0);
            }
            v[c] = test_mesh_vertex(mesh, p[0], p[1], p[2]);
        }
        test_mesh_triangle(mesh, v[0], v[1], v[2]);
    }
    return test_mesh_scene(context, mesh, 0);
}

/// Rays from anywhere in a cube of 2 m to anywhere, every third to .7 m.
static inline void soup_rays(alpi_rays *rays, uint32_t packet)
{
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        uint32_t key = 1000 * packet + 10 * i;
        vec3 d = {alpi_unit_float(alpi_hash32(key)) - 0.5f,
                  alpi_unit_float(alpi_hash32(key + 1)) - 0.5f,
                  alpi_unit_float(alpi_hash32(key + 2)) - 0.5f};
        d = vec3_normalize_or(d, (vec3){0, 0, 1});
        rays->origin_x[i] = 2.0f * alpi_unit_float(alpi_hash32(key + 3)) - 1.0f;
        rays->origin_y[i] = 2.0f * alpi_unit_float(alpi_hash32(key + 4)) - 1.0f;
        rays->origin_z[i] = 2.0f * alpi_unit_float(alpi_hash32(key + 5)) - 1.0f;
        rays->direction_x[i] = d.x;
        rays->direction_y[i] = d.y;
        rays->direction_z[i] = d.z;
        rays->minimum[i] = rays->time[i] = 0.0f;
        rays->mask[i] = UINT32_MAX;
        rays->id[i] = rays->flags[i] = 0;
        rays->maximum[i] = i % 3 == 0 ? 0.7f : INFINITY;
    }
}

/// Turns the rays of a packet towards points of the edges of a scene.
static inline void soup_aim_at_edges(const alp_scene *scene, uint32_t packet, alpi_rays *rays)
{
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        const uint32_t key = 17 * (ALPI_PACKET * packet + i);
        const uint32_t *corners = scene->triangles[alpi_hash32(key) % scene->triangle_count];
        const vec3 a = vec3_load(scene->positions[corners[0]]);
        const vec3 b = vec3_load(scene->positions[corners[1]]);
        const vec3 at = vec3_mad(a, alpi_unit_float(alpi_hash32(key + 1)), vec3_sub(b, a));
        const vec3 from = {rays->origin_x[i], rays->origin_y[i], rays->origin_z[i]};
        const vec3 d = vec3_normalize_or(vec3_sub(at, from), (vec3){0, 0, 1});
        rays->direction_x[i] = d.x;
        rays->direction_y[i] = d.y;
        rays->direction_z[i] = d.z;
    }
}

#endif
