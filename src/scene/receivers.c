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
        largest = fmaxf(largest, largest_coordinate(vec3_sub(corners[k], position)));
    }
    return 2.0f * 0x1p-23f * largest; // one was enough wherever it was tried
}

alp_result alpi_receivers_create(alp_context *context, uint32_t count, alpi_receivers *receivers)
{
    *receivers = (alpi_receivers){.count = count};
    receivers->positions = alpi_allocate(context, count, sizeof *receivers->positions);
    receivers->geometric_normals =
        alpi_allocate(context, count, sizeof *receivers->geometric_normals);
    receivers->shading_normals = alpi_allocate(context, count, sizeof *receivers->shading_normals);
    receivers->offsets = ALPI_NEW(context, float, count);
    if (receivers->offsets == NULL || receivers->positions == NULL ||
        receivers->geometric_normals == NULL || receivers->shading_normals == NULL) {
        alpi_receivers_destroy(context, receivers);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    return ALP_OK;
}

void alpi_receivers_destroy(alp_context *context, alpi_receivers *receivers)
{
    alpi_release(context, receivers->positions);
    alpi_release(context, receivers->geometric_normals);
    alpi_release(context, receivers->shading_normals);
    alpi_release(context, receivers->offsets);
    *receivers = (alpi_receivers){0};
}
