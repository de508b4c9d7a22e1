// SPDX-License-Identifier: MIT
#include "transport/paths/hit.h"

alpi_receiver_point alpi_hit_point(const alp_scene *scene, const alpi_hits *hits, int lane,
                                   vec3 direction, bool *from_behind)
{
    const uint32_t triangle = hits->triangle[lane];
    const float b1 = hits->b1[lane], b2 = hits->b2[lane], b0 = 1.0f - b1 - b2;
    const float weight[3] = {b0, b1, b2};
    vec3 c[3], shading = {0.0f, 0.0f, 0.0f};
    alpi_triangle_corners(scene, triangle, c);
    alpi_receiver_point p;
    p.position =
        vec3_add(vec3_add(vec3_scale(c[0], b0), vec3_scale(c[1], b1)), vec3_scale(c[2], b2));
    p.geometric_normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    for (int k = 0; k < 3; k++) {
        shading =
            vec3_mad(shading, weight[k], vec3_load(scene->normals[scene->triangles[triangle][k]]));
    }
    // A mean of unit vectors: no float overflows.
    const float length2 = vec3_dot(shading, shading);
    p.shading_normal =
        length2 > 1e-12f ? vec3_scale(shading, 1.0f / sqrtf(length2)) : p.geometric_normal;
    if (vec3_dot(p.shading_normal, p.geometric_normal) <= 0.0f) {
        p.shading_normal = p.geometric_normal;
    }
    const bool behind = vec3_dot(direction, p.geometric_normal) > 0.0f;
    if (behind) {
        p.geometric_normal = vec3_scale(p.geometric_normal, -1.0f);
        p.shading_normal = vec3_scale(p.shading_normal, -1.0f);
    }
    if (from_behind != NULL) {
        *from_behind = behind;
    }
    p.offset = alpi_receiver_offset(p.position, c);
    return p;
}
