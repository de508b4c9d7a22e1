// SPDX-License-Identifier: MIT
// Tangents of vertices for normal maps: the mean of the triangles' directions of u, weighted by
// angle.
#include "base/angle.h"
#include "scene/double3.h"
#include "scene/scene.h"

#include <alpenglow/geometry.h>

#include <math.h>
#include <string.h>

// Radians: a shorter sum is what rounding leaves of directions that cancel.
static const double LEAST_SUM = 1e-5;

/// u and v of b − a as the texture reads them. The offset cancels.
static void texture_step(const alpi_texture *t, const float a[2], const float b[2], double step[2])
{
    const double u = ((double)b[0] - (double)a[0]) * (double)t->scale[0];
    const double v = ((double)b[1] - (double)a[1]) * (double)t->scale[1];
    const double c = cos((double)t->rotation), s = sin((double)t->rotation);
    step[0] = c * u + s * v;
    step[1] = c * v - s * u;
}

/// The direction of growing u on a triangle, of any length. @return the sign of the area in the
/// texture: negative where the image is seen as it is, since v grows downwards; 0 = no direction
static int find_direction(const alp_scene *scene, uint32_t triangle, const alpi_texture *texture,
                          double3 *direction)
{
    const uint32_t *v = scene->triangles[triangle];
    const float(*uvs)[2] = (const float(*)[2])scene->uvs[texture->uv_set];
    double a[2], b[2];
    vec3 corner[3];
    alpi_triangle_corners(scene, triangle, corner);
    texture_step(texture, uvs[v[0]], uvs[v[1]], a);
    texture_step(texture, uvs[v[0]], uvs[v[2]], b);
    const double area = a[0] * b[1] - b[0] * a[1];
    const double3 along = double3_sub(double3_scale(double3_between(corner[0], corner[1]), b[1]),
                                      double3_scale(double3_between(corner[0], corner[2]), a[1]));
    *direction = double3_unit(double3_scale(along, area > 0.0 ? 1.0 : -1.0));
    const bool known = isfinite(area) && double3_dot(*direction, *direction) > 0.5; // not of NaN
    return !known || area == 0.0 ? 0 : area > 0.0 ? 1 : -1;
}

/// A triangle's direction at the normal of a vertex: unit and perpendicular to it, or 0.
static double3 project(double3 direction, double3 normal)
{
    return double3_unit(
        double3_sub(direction, double3_scale(normal, double3_dot(direction, normal))));
}

/// Adds what a triangle says to its corners: direction · angle, and the angle by its handedness.
static void add_triangle(const alp_scene *scene, uint32_t triangle, const alpi_texture *texture,
                         float (*sums)[4])
{
    double3 direction, edges[3];
    const int sign = find_direction(scene, triangle, texture, &direction);
    if (sign == 0) {
        return;
    }
    vec3 corner[3];
    alpi_triangle_corners(scene, triangle, corner);
    for (int k = 0; k < 3; k++) {
        edges[k] = double3_unit(double3_between(corner[k], corner[(k + 1) % 3]));
    }
    const double3 face = double3_cross(edges[0], edges[1]);
    for (int k = 0; k < 3; k++) {
        const uint32_t v = scene->triangles[triangle][k];
        const double3 normal = double3_from(vec3_load(scene->normals[v]));
        const double angle = alpi_arc_cosine(-double3_dot(edges[k], edges[(k + 2) % 3]));
        const double3 t = double3_scale(project(direction, normal), angle);
        const bool inside_out = double3_dot(face, normal) < 0.0;
        sums[v][0] += (float)t.x;
        sums[v][1] += (float)t.y;
        sums[v][2] += (float)t.z;
        sums[v][3] += (float)((inside_out ? sign : -sign) * angle);
    }
}

/// From the sums of a vertex to its tangent.
static void finish(vec3 normal, float tangent[4])
{
    const double3 sum = double3_from(vec3_load(tangent)), n = double3_from(normal);
    const double3 flat = double3_sub(sum, double3_scale(n, double3_dot(sum, n)));
    vec3 t, b;
    if (double3_length(flat) > LEAST_SUM) {
        vec3_store(tangent, double3_to_vec3(double3_unit(flat)));
    } else {
        vec3_frame(normal, &t, &b);
        vec3_store(tangent, t);
    }
    tangent[3] = tangent[3] < 0.0f ? -1.0f : 1.0f;
}

alp_result alp_scene_make_tangents(const alp_scene *scene, float (*tangents)[4])
{
    if (scene == NULL || tangents == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    memset(tangents, 0, scene->vertex_count * sizeof *tangents);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const uint32_t material = scene->surfaces[scene->triangle_surface[t]].material;
        const alpi_texture *texture =
            material == ALPI_NONE ? NULL : &scene->materials[material].normal_texture;
        if (texture != NULL && texture->image != ALPI_NONE && scene->triangle_usable[t] &&
            scene->uvs[texture->uv_set] != NULL) {
            add_triangle(scene, t, texture, tangents);
        }
    }
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        finish(vec3_load(scene->normals[v]), tangents[v]);
    }
    return ALP_OK;
}
