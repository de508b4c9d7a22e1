// SPDX-License-Identifier: MIT
// Bounce passes of each layer: light is linear, so each layer repeats the passes with its own
// direct light alone. All layers get as many passes as the whole, so that they add up to it.
#include "maps/radiosity/solver.h"

#include "base/memory.h"

static alp_result bounce_layer(const alpi_solver *s, uint32_t layer, alpi_reference_value *bounced)
{
    for (uint32_t passes = 1; passes < s->r->passes; passes++) {
        ALP_TRY(alpi_radiosity_relight(s->r, layer, NULL, &s->progress));
        ALP_TRY(alpi_solver_gather(s, bounced));
        alpi_solver_copy_means(s, bounced, s->r->options.layers->before[layer]);
    }
    return ALP_OK;
}

alp_result alpi_solver_bounce_layers(const alpi_solver *solver)
{
    const alpi_radiosity *r = solver->r;
    const alpi_layer_arrays *layers = r->options.layers;
    if (layers == NULL) {
        return ALP_OK;
    }
    alpi_reference_value *bounced =
        ALPI_NEW(r->options.context, alpi_reference_value,
                 alpi_patches_sides(&r->patches) * r->patches.patch_count);
    alp_result result = bounced != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    for (uint32_t layer = 0; layer < layers->count && result == ALP_OK; layer++) {
        result = bounce_layer(solver, layer, bounced);
    }
    alpi_release(r->options.context, bounced);
    return result == ALP_OK ? alpi_radiosity_relight(r, ALPI_NONE, NULL, &solver->progress)
                            : result;
}
