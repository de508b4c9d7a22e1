// SPDX-License-Identifier: MIT
// Interpolation of gathered light by the stencils of the lattice.
#include "maps/radiosity/final_gather_job.h"

#include <math.h>

void alpi_stencil_light(const alpi_gather_job *gather, uint32_t texel, const alpi_stencil *stencil)
{
    const alpi_gather_job *g = gather;
    const alpi_stencil *s = stencil;
    float light[3] = {0.0f, 0.0f, 0.0f}, sky[3] = {0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < s->count; i++) {
        for (int k = 0; k < 3; k++) {
            light[k] += s->weights[i] * g->values[s->texels[i]].mean[k];
            sky[k] += g->skies != NULL ? s->weights[i] * g->skies[s->texels[i]][k] : 0.0f;
        }
    }
    for (int k = 0; k < 3; k++) {
        g->values[texel].mean[k] = fmaxf(light[k], 0.0f); // a cubic may overshoot
        if (g->skies != NULL) {
            g->skies[texel][k] = fminf(fmaxf(sky[k], 0.0f), g->values[texel].mean[k]);
        }
    }
}

void alpi_stencil_directional(const alpi_gather_job *gather, uint32_t texel,
                              const alpi_stencil *stencil)
{
    if (gather->directional == NULL) {
        return;
    }
    alpi_directional sum = {.toward = {0.0f, 0.0f, 0.0f}};
    for (uint32_t i = 0; i < stencil->count; i++) {
        const alpi_directional *v = &gather->directional[stencil->texels[i]];
        for (int k = 0; k < 3; k++) {
            for (int c = 0; c < ALPI_SH1_COUNT; c++) {
                sum.sh[c][k] += stencil->weights[i] * v->sh[c][k];
            }
            sum.toward[k] += stencil->weights[i] * v->toward[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        sum.sh[0][k] = fmaxf(sum.sh[0][k], 0.0f); // a cubic may overshoot
    }
    gather->directional[texel] = sum;
}
