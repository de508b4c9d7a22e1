// SPDX-License-Identifier: MIT
#include "scene/origin.h"

#include <math.h>
#include <string.h>

static const double FAR_EXTENTS = 8.0, COARSE_SHARE = 1e-5;
static const double NEAR_EXTENTS = 2.0, COARSE_METRES = 1.0 / 1024.0;

alpi_world_box alpi_world_box_empty(void)
{
    return (alpi_world_box){{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
}

void alpi_world_box_add(alpi_world_box *box, const double point[3])
{
    const double limit = (double)ALPI_COORDINATE_LIMIT;
    if (!(fabs(point[0]) <= limit && fabs(point[1]) <= limit && fabs(point[2]) <= limit)) {
        return; // NaN too
    }
    for (int k = 0; k < 3; k++) {
        box->low[k] = fmin(box->low[k], point[k]);
        box->high[k] = fmax(box->high[k], point[k]);
    }
}

alpi_world_box alpi_world_box_of(const alp_scene *scene)
{
    alpi_world_box box = alpi_world_box_empty();
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        double world[3];
        alpi_origin_restore(scene, vec3_load(scene->positions[v]), world);
        alpi_world_box_add(&box, world);
    }
    return box;
}

static bool is_far(double distance, double extent)
{
    const float at = (float)distance;
    const double spacing = (double)nextafterf(at, INFINITY) - (double)at; // of floats
    return (extent > 0.0 && distance > FAR_EXTENTS * extent && spacing > COARSE_SHARE * extent) ||
           (distance > NEAR_EXTENTS * extent && spacing >= COARSE_METRES);
}

void alpi_origin_choose(const alpi_world_box *box, double origin[3])
{
    double distance = 0.0, extent = 0.0;
    origin[0] = origin[1] = origin[2] = 0.0;
    if (!(box->low[0] <= box->high[0])) {
        return;
    }
    for (int k = 0; k < 3; k++) {
        distance = fmax(distance, fabs(0.5 * (box->low[k] + box->high[k])));
        extent = fmax(extent, box->high[k] - box->low[k]);
    }
    if (!is_far(distance, extent)) {
        return;
    }
    const double grain = extent > 0.0 ? exp2(ceil(log2(extent))) : 1.0;
    for (int k = 0; k < 3; k++) {
        origin[k] = grain * round(0.5 * (box->low[k] + box->high[k]) / grain);
    }
}

bool alpi_origin_step(alp_scene *scene, const alp_scene *base, double step[3])
{
    const alpi_world_box box = alpi_world_box_of(scene);
    double origin[3];
    bool moved = false;
    alpi_origin_choose(&box, origin);
    if (base != NULL) {
        memcpy(origin, base->origin, sizeof origin);
    }
    for (int k = 0; k < 3; k++) {
        step[k] = origin[k] - scene->origin[k];
        scene->origin[k] = origin[k];
        moved = moved || step[k] != 0.0;
    }
    return moved;
}

void alpi_origin_note_rounding(alp_scene *scene, const mat4 *world)
{
    for (int k = 0; k < 3; k++) {
        scene->rounded_at = fmaxf(scene->rounded_at, fabsf((float)world->m[12 + k]));
    }
}
