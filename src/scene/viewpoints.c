// SPDX-License-Identifier: MIT
// Where one may stand to look at a scene of which nothing is known but its bounding box.
#include "scene/viewpoints.h"

#include <math.h>

static const vec3 OVER_CORNER = {0.8f, 0.55f, 1.0f};

/// Distance from the centre of a box, along `view`, at which a square picture of half-width
/// `tangent` at distance 1 just holds all its corners, with a margin of 5 %.
static float fitting_distance(vec3 size, vec3 view, float tangent)
{
    vec3 right = vec3_normalize_or(vec3_cross((vec3){0.0f, 1.0f, 0.0f}, view), view);
    vec3 up = vec3_cross(view, right);
    float distance = 1e-6f;
    for (int i = 0; i < 8; i++) {
        vec3 corner = {size.x * ((i & 1) ? 0.5f : -0.5f), size.y * ((i & 2) ? 0.5f : -0.5f),
                       size.z * ((i & 4) ? 0.5f : -0.5f)};
        float aside = fmaxf(fabsf(vec3_dot(corner, right)), fabsf(vec3_dot(corner, up)));
        distance = fmaxf(distance, vec3_dot(corner, view) + 1.05f * aside / tangent);
    }
    return distance;
}

/// From outside towards the centre, as far away as the picture needs to hold everything.
static alp_camera look_from_outside(const alp_scene *scene, vec3 direction)
{
    alp_camera camera = {.up = {0.0f, 1.0f, 0.0f}, .vertical_fov = 0.8f};
    const vec3 size = vec3_sub(scene->bounds_max, scene->bounds_min);
    const vec3 center = vec3_mad(scene->bounds_min, 0.5f, size);
    const vec3 view = vec3_normalize_or(direction, (vec3){0.0f, 0.0f, 1.0f});
    const float distance = fitting_distance(size, view, tanf(0.5f * camera.vertical_fov));
    vec3_store(camera.position, vec3_mad(center, distance, view));
    vec3_store(camera.target, center);
    return camera;
}

/// From inside, wide. `eye` and `target` in parts of the box.
static alp_camera look_from_inside(const alp_scene *scene, vec3 eye, vec3 target)
{
    alp_camera camera = {.up = {0.0f, 1.0f, 0.0f}, .vertical_fov = 1.2f};
    const vec3 low = scene->bounds_min, size = vec3_sub(scene->bounds_max, low);
    const vec3 from = {eye.x * size.x, eye.y * size.y, eye.z * size.z};
    const vec3 to = {target.x * size.x, target.y * size.y, target.z * size.z};
    vec3_store(camera.position, vec3_add(low, from));
    vec3_store(camera.target, vec3_add(low, to));
    return camera;
}

/// The place near an upper corner, towards the opposite lower one.
static alp_camera look_from_corner(const alp_scene *scene, bool left, bool behind)
{
    return look_from_inside(scene, (vec3){left ? 0.12f : 0.88f, 0.62f, behind ? 0.12f : 0.88f},
                            (vec3){left ? 0.65f : 0.35f, 0.35f, behind ? 0.75f : 0.25f});
}

static bool has_inside(const alp_scene *scene)
{
    const float flat = 0.05f; // thickness over the largest side
    const vec3 size = vec3_sub(scene->bounds_max, scene->bounds_min);
    return fminf(fminf(size.x, size.y), size.z) > flat * fmaxf(fmaxf(size.x, size.y), size.z);
}

alp_camera alpi_viewpoint_usual(const alp_scene *scene)
{
    const vec3 size = vec3_sub(scene->bounds_max, scene->bounds_min);
    const vec3 center = vec3_mad(scene->bounds_min, 0.5f, size);
    double front = 0.0, back = 0.0; // area that faces away from the centre, or towards it
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (scene->triangle_usable[t]) {
            vec3 c[3];
            alpi_triangle_corners(scene, t, c);
            // Away from the centre = the outside of an object; towards it = the inside of a room.
            vec3 normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 0.0f, 0.0f});
            double outward = vec3_triangle_area(c[0], c[1], c[2]) *
                             (double)vec3_dot(normal, vec3_sub(c[0], center));
            front += outward > 0.0 ? outward : 0.0;
            back -= outward < 0.0 ? outward : 0.0;
        }
    }
    return back > front && has_inside(scene) ? look_from_corner(scene, false, false)
                                             : look_from_outside(scene, OVER_CORNER);
}

uint32_t alpi_viewpoints(const alp_scene *scene, alp_camera cameras[ALPI_VIEWPOINT_LIMIT])
{
    // Where the middle of a side lies, from the centre: towards +z, +x, −x, −z.
    static const vec3 sides[4] = {
        {0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f}, {-1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}};
    uint32_t count = 0;
    cameras[count++] = alpi_viewpoint_usual(scene);
    for (int i = 0; i < 4; i++) {
        const vec3 corner = {(i & 1) != 0 ? -OVER_CORNER.x : OVER_CORNER.x, OVER_CORNER.y,
                             (i & 2) != 0 ? -OVER_CORNER.z : OVER_CORNER.z};
        cameras[count++] = look_from_outside(scene, corner);
    }
    for (int i = 0; i < 4; i++) {
        cameras[count++] = look_from_outside(scene, sides[i]);
    }
    cameras[count++] = look_from_outside(scene, (vec3){0.08f, 1.0f, 0.16f});
    for (int i = 0; has_inside(scene) && i < 4; i++) {
        cameras[count++] = look_from_corner(scene, (i & 1) != 0, (i & 2) != 0);
    }
    for (int i = 0; has_inside(scene) && i < 4; i++) {
        const vec3 eye = {0.5f + 0.42f * sides[i].x, 0.55f, 0.5f + 0.42f * sides[i].z};
        const vec3 target = {0.5f - 0.4f * sides[i].x, 0.4f, 0.5f - 0.4f * sides[i].z};
        cameras[count++] = look_from_inside(scene, eye, target);
    }
    return count;
}
