// SPDX-License-Identifier: MIT
#include "scene/receivers.h"

#include "base/memory.h"

static float largest_coordinate(vec3 v)
{
    return fmaxf(fmaxf(fabsf(v.x), fabsf(v.y)), fabsf(v.z));
}

float alpi_receiver_offset(vec3 position, const vec3 *corners)
{
    float largest = largest_coordinate(position);
    for (int k = 0; corners != NULL && k < 3; k++) {
        const float apart = largest_coordinate(vec3_sub(corners[k], position));
        largest = apart > largest ? apart : largest;
    }
    return 2.0f * 0x1p-23f * largest; // one was enough wherever it was tried
}

alp_result alpi_point_array_create(alp_context *context, uint32_t count, alpi_point_array *points)
{
    *points = (alpi_point_array){.count = count};
    points->positions = alpi_allocate(context, count, sizeof *points->positions);
    points->geometric_normals = alpi_allocate(context, count, sizeof *points->geometric_normals);
    points->shading_normals = alpi_allocate(context, count, sizeof *points->shading_normals);
    points->offsets = ALPI_NEW(context, float, count);
    if (points->offsets == NULL || points->positions == NULL || points->geometric_normals == NULL ||
        points->shading_normals == NULL) {
        alpi_point_array_destroy(context, points);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    return ALP_OK;
}

void alpi_point_array_destroy(alp_context *context, alpi_point_array *points)
{
    alpi_release(context, points->positions);
    alpi_release(context, points->geometric_normals);
    alpi_release(context, points->shading_normals);
    alpi_release(context, points->offsets);
    *points = (alpi_point_array){0};
}

static void place_point(const void *user, uint32_t receiver, uint32_t count,
                        const float (*square)[2], alpi_receiver_point *out)
{
    (void)square;
    const alpi_point_array *points = user;
    const alpi_receiver_point point = {
        .position = vec3_load(points->positions[receiver]),
        .geometric_normal = vec3_load(points->geometric_normals[receiver]),
        .shading_normal = vec3_load(points->shading_normals[receiver]),
        .offset = points->offsets[receiver],
    };
    for (uint32_t i = 0; i < count; i++) {
        out[i] = point;
    }
}

alpi_receivers alpi_point_array_receivers(const alpi_point_array *points)
{
    return (alpi_receivers){.count = points->count, .place = place_point, .user = points};
}
