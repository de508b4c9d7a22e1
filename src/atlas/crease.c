// SPDX-License-Identifier: MIT
// How sharp the edge between two triangles is: light steps at a crease, so that a border of charts
// there does not show.
#include "atlas/regions.h"

#include "base/angle.h"

#include <math.h>

// Vertex normals that agree across a fold say that it stands for a round surface; beyond this they
// say so of the corners of a box.
static const float ROUND_FOLD = 0.55f;

bool alpi_share_node(const alp_scene *scene, uint32_t a, uint32_t b)
{
    const alpi_surface *first = &scene->surfaces[scene->triangle_surface[a]];
    const alpi_surface *second = &scene->surfaces[scene->triangle_surface[b]];
    return first->node == second->node && first->instance == second->instance;
}

int alpi_edge_back(const alp_scene *scene, const uint32_t (*neighbours)[3], uint32_t triangle,
                   int k)
{
    const uint32_t across = neighbours[triangle][k];
    int back = 0;
    for (int j = 0; j < 3; j++) {
        const float *end = scene->positions[scene->triangles[across][(j + 1) % 3]];
        const float *begin = scene->positions[scene->triangles[triangle][k]];
        if (neighbours[across][j] == triangle) {
            back = j;
            if (end[0] == begin[0] && end[1] == begin[1] && end[2] == begin[2]) {
                break;
            }
        }
    }
    return back;
}

static float angle_of(float cosine)
{
    return (float)alpi_arc_cosine((double)cosine);
}

static vec3 normal_of(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
}

float alpi_crease(const alp_scene *scene, const uint32_t (*neighbours)[3], uint32_t triangle, int k)
{
    const uint32_t across = neighbours[triangle][k];
    const int back = alpi_edge_back(scene, neighbours, triangle, k);
    const float fold = angle_of(vec3_dot(normal_of(scene, triangle), normal_of(scene, across)));
    float step = 0.0f;
    for (int end = 0; end < 2; end++) {
        const float *a = scene->normals[scene->triangles[triangle][(k + end) % 3]];
        const float *b = scene->normals[scene->triangles[across][(back + 1 - end) % 3]];
        step = fmaxf(step, angle_of(vec3_dot(vec3_load(a), vec3_load(b))));
    }
    step = step > 1e-3f ? step : 0.0f; // rounding of normals
    return fmaxf(fminf(step, fold + ROUND_FOLD), fold - ROUND_FOLD);
}
