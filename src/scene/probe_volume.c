// SPDX-License-Identifier: MIT
#include "scene/probe_volume.h"

#include "base/memory.h"

#include <string.h>

alp_result alpi_probe_volume_allocate(alp_context *context, bool gradients, bool moments,
                                      alpi_probe_volume *v)
{
    v->context = context;
    v->coefficient_count = alpi_probe_basis_count(v->basis);
    const size_t n = v->count, values = n * v->coefficient_count * 3;
    ALPI_TRY_NEW(context, v->moves, n);
    ALPI_TRY_NEW(context, v->states, n);
    ALPI_TRY_NEW(context, v->coefficients, values);
    if (v->is_list) {
        ALPI_TRY_NEW(context, v->places, n);
    }
    if (gradients) {
        ALPI_TRY_NEW(context, v->gradients, 3 * values);
    }
    if (moments) {
        const size_t side = ALPI_PROBE_MOMENT_SIDE;
        ALPI_TRY_NEW(context, v->moments, n * side * side);
    }
    if (v->layer_count > 0) {
        ALPI_TRY_NEW(context, v->layers, v->layer_count);
    }
    for (uint32_t i = 0; i < v->layer_count; i++) {
        ALPI_TRY_NEW(context, v->layers[i].coefficients, values);
    }
    return ALP_OK;
}

void alpi_probe_volume_destroy(alpi_probe_volume *v)
{
    if (v->context == NULL) {
        return;
    }
    alp_context *context = v->context;
    for (uint32_t i = 0; i < v->layer_count && v->layers != NULL; i++) {
        alpi_release(context, v->layers[i].name);
        alpi_release(context, v->layers[i].coefficients);
    }
    alpi_release(context, v->layers);
    alpi_release(context, v->places);
    alpi_release(context, v->moves);
    alpi_release(context, v->states);
    alpi_release(context, v->coefficients);
    alpi_release(context, v->gradients);
    alpi_release(context, v->moments);
    alpi_release(context, v->options);
    memset(v, 0, sizeof *v);
}
