// SPDX-License-Identifier: MIT
// Values of probes for a host: counts, states, places and light.
#include "fields/probes/probes.h"

alp_probes_info alp_probes_get_info(const alp_probes *probes)
{
    const alpi_probe_volume *v = &probes->volume;
    const uint32_t floats = (3 * v->coefficient_count + 3) / 4 * 4;
    alp_probes_info info = {.is_list = v->is_list,
                            .count = v->count,
                            .basis = (alp_probe_basis)v->basis,
                            .coefficients = v->coefficient_count,
                            .layers = v->layer_count,
                            .visibility = v->moments != NULL,
                            .gradients = v->gradients != NULL,
                            .direct = v->direct,
                            .error = v->relative_error,
                            .interpolation = v->interpolation,
                            .mean = v->mean,
                            .rays = v->rays,
                            .scene_hash = v->scene_hash};
    for (int k = 0; k < 3; k++) {
        info.size[k] = v->size[k];
        info.origin[k] = v->origin[k];
        info.spacing[k] = v->spacing[k];
    }
    for (uint32_t i = 0; i < v->count; i++) {
        info.states[v->states[i] & 3u]++;
    }
    info.bytes = (uint64_t)v->count * (floats * sizeof(float) * (v->gradients != NULL ? 4 : 1) +
                                       13 + (v->moments != NULL ? 100 * 2 * sizeof(float) : 0));
    return info;
}

const float *alp_probes_coefficients(const alp_probes *probes, uint32_t layer)
{
    const alpi_probe_volume *v = &probes->volume;
    return layer == UINT32_MAX      ? v->coefficients
           : layer < v->layer_count ? v->layers[layer].coefficients
                                    : NULL;
}

const char *alp_probes_layer_name(const alp_probes *probes, uint32_t layer)
{
    const alpi_probe_volume *v = &probes->volume;
    return layer < v->layer_count && v->layers[layer].name != NULL ? v->layers[layer].name : "";
}

const uint8_t *alp_probes_states(const alp_probes *probes)
{
    return probes->volume.states;
}

const float *alp_probes_moments(const alp_probes *probes)
{
    return probes->volume.moments != NULL ? probes->volume.moments[0] : NULL;
}

void alp_probes_position(const alp_probes *probes, uint32_t index, double position[3])
{
    const alpi_probe_volume *v = &probes->volume;
    alpi_probe_place(v, index, position);
    for (int k = 0; k < 3; k++) {
        position[k] += (double)v->moves[index][k];
    }
}
