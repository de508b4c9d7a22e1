// SPDX-License-Identifier: MIT
#include "scene/blend_weights.h"

#include <math.h>
#include <string.h>

// Of the volume that the unit axes span: below, two of them or all lie near one plane.
static const float LEAST_VOLUME = 0.2f;

/// The unit axes of a surface's own object; false where the world's are to be used.
static bool own_axes(const alpi_surface *surface, bool world, vec3 axes[3])
{
    for (int k = 0; k < 3; k++) {
        axes[k] = vec3_normalize_or(vec3_load(surface->axes[k]), (vec3){0.0f, 0.0f, 0.0f});
    }
    const float volume = vec3_dot(axes[0], vec3_cross(axes[1], axes[2]));
    return !world && fabsf(volume) >= LEAST_VOLUME; // false for NaN
}

void alpi_surface_axes(const alpi_surface *surface, bool world, vec3 axes[3])
{
    static const vec3 of_world[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    if (!own_axes(surface, world, axes)) {
        memcpy(axes, of_world, sizeof of_world);
    }
}

void alpi_surface_normal_axes(const alpi_surface *surface, float axes[3][3])
{
    static const float of_world[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    vec3 unit[3];
    const bool own = own_axes(surface, false, unit);
    memcpy(axes, own ? surface->axes : of_world, sizeof of_world);
}

/// A normal of the world in the frame of the object. Its axes are taken with their lengths here, as
/// the file's own normals have them.
static vec3 object_normal(const alpi_surface *surface, bool world, vec3 n)
{
    vec3 axes[3];
    if (!own_axes(surface, world, axes)) {
        return n;
    }
    const vec3 turned = {vec3_dot(n, vec3_load(surface->axes[0])),
                         vec3_dot(n, vec3_load(surface->axes[1])),
                         vec3_dot(n, vec3_load(surface->axes[2]))};
    return vec3_normalize_or(turned, n);
}

void alpi_surface_weights(const alp_scene *scene, bool world, uint32_t triangle, float b1, float b2,
                          float weights[3])
{
    const alpi_surface *surface = &scene->surfaces[scene->triangle_surface[triangle]];
    const float shares[3] = {1.0f - b1 - b2, b1, b2};
    vec3 n = {0.0f, 0.0f, 0.0f};
    for (int k = 0; k < 3; k++) {
        const vec3 corner = vec3_load(scene->normals[scene->triangles[triangle][k]]);
        n = vec3_mad(n, shares[k], object_normal(surface, world, corner));
    }
    n = vec3_normalize_or(n, (vec3){0.0f, 1.0f, 0.0f});
    weights[0] = n.x * n.x;
    weights[1] = n.y * n.y;
    weights[2] = n.z * n.z;
}
