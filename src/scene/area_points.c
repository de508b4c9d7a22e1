// SPDX-License-Identifier: MIT
// Points spread evenly over the surface of a scene.
#include "scene/area_points.h"

#include "base/random.h"

enum { KEY = 0x41726561 }; // any number

static alpi_area_point place(uint32_t triangle, uint32_t index)
{
    const vec2 u = alpi_sample_2d(KEY, index);
    const float root = sqrtf(u.x);
    return (alpi_area_point){triangle, root * (1.0f - u.y), root * u.y};
}

bool alpi_area_points(const alp_scene *scene, uint32_t count, alpi_area_point *points)
{
    uint32_t made = 0, last = ALPI_NONE;
    double sum = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count && made < count; t++) {
        if (!scene->triangle_usable[t]) {
            continue;
        }
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        sum += vec3_triangle_area(c[0], c[1], c[2]);
        last = t;
        while (made < count && sum >= ((double)made + 0.5) / count * scene->area) {
            points[made] = place(t, made);
            made++;
        }
    }
    for (; last != ALPI_NONE && made < count; made++) { // rounding of the sum
        points[made] = place(last, made);
    }
    return made == count;
}
