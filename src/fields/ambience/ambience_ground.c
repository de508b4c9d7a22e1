// SPDX-License-Identifier: MIT
#include "fields/ambience/ambience_ground.h"

#include <math.h>

enum { PLACES = 8 };
static const double BESIDE = 2.0, THING = 3.0; // metres

double alpi_ground_height(const alp_scene *scene, const alpi_tracer *tracer, double x, double z)
{
    static const double around[PLACES][2] = {{0.0, 0.0},  {1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0},
                                             {0.0, -1.0}, {0.7, 0.7}, {-0.7, 0.7}, {0.7, -0.7}};
    const vec3 down = {0.0f, -1.0f, 0.0f};
    const float top = scene->bounds_max.y + 1.0f;
    alpi_rays rays;
    alpi_hits hits;
    double heights[PLACES], lowest = HUGE_VAL;
    alpi_rays_clear(&rays);
    for (int i = 0; i < PLACES; i++) {
        const vec3 from = {(float)(x + BESIDE * around[i][0]), top,
                           (float)(z + BESIDE * around[i][1])};
        alpi_rays_set(&rays, i, from, down, INFINITY);
    }
    alpi_trace_nearest(tracer, &rays, 0xffu, (alpi_trace_filter){.one_sided = true}, &hits);
    for (int i = 0; i < PLACES; i++) {
        const bool met = hits.triangle[i] != ALPI_NONE;
        heights[i] = (double)(met ? top - hits.distance[i] : scene->bounds_min.y);
        lowest = met ? fmin(lowest, heights[i]) : lowest;
    }
    return heights[0] - lowest > THING ? lowest : heights[0];
}
