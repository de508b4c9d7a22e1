// SPDX-License-Identifier: MIT
#include "scene/receivers.h"

#include "base/memory.h"

alp_result alpi_receivers_create(alp_context *context, uint32_t count, alpi_receivers *receivers)
{
    *receivers = (alpi_receivers){.count = count};
    receivers->positions = alpi_allocate(context, count, sizeof *receivers->positions);
    receivers->geometric_normals =
        alpi_allocate(context, count, sizeof *receivers->geometric_normals);
    receivers->shading_normals = alpi_allocate(context, count, sizeof *receivers->shading_normals);
    if (receivers->positions == NULL || receivers->geometric_normals == NULL ||
        receivers->shading_normals == NULL) {
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
    *receivers = (alpi_receivers){0};
}
