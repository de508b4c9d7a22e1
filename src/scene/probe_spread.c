// SPDX-License-Identifier: MIT
// Light of probes that hold none, for readers that interpolate between all probes of a cell.
#include "base/memory.h"
#include "scene/probe_volume.h"
#include "scene/scene.h"

/// Probes in the order in which they get light: `distance` counts steps to a probe that has some.
typedef struct spread {
    uint32_t *order, *distance; // [count]
    uint32_t found;
} spread;

/// Neighbour k of a probe; ALPI_NONE beyond the lattice.
static uint32_t neighbour(const alpi_probe_volume *v, uint32_t probe, int k)
{
    const uint32_t strides[3] = {1, v->size[0], v->size[0] * v->size[1]};
    const int axis = k / 2;
    const uint32_t at = probe / strides[axis] % v->size[axis];
    if (k % 2 == 0) {
        return at > 0 ? probe - strides[axis] : ALPI_NONE;
    }
    return at + 1 < v->size[axis] ? probe + strides[axis] : ALPI_NONE;
}

/// The mean of neighbours that are one step nearer to light.
static void mix_neighbours(const alpi_probe_volume *v, const spread *s, uint32_t probe,
                           uint32_t floats, float *light)
{
    float *own = light + (size_t)probe * floats;
    uint32_t count = 0;
    for (uint32_t i = 0; i < floats; i++) {
        own[i] = 0.0f;
    }
    for (int k = 0; k < 6; k++) {
        const uint32_t n = neighbour(v, probe, k);
        if (n == ALPI_NONE || s->distance[n] != s->distance[probe] - 1) {
            continue;
        }
        count++;
        for (uint32_t i = 0; i < floats; i++) {
            own[i] += light[(size_t)n * floats + i];
        }
    }
    for (uint32_t i = 0; i < floats && count > 0; i++) {
        own[i] /= (float)count;
    }
}

static alp_result spread_light(const alpi_probe_volume *v, uint32_t floats, float *light, spread *s)
{
    ALPI_TRY_NEW(v->context, s->order, v->count);
    ALPI_TRY_NEW(v->context, s->distance, v->count);
    for (uint32_t i = 0; i < v->count; i++) {
        s->distance[i] = v->states[i] == ALPI_PROBE_INVALID ? ALPI_NONE : 0;
        if (s->distance[i] == 0) {
            s->order[s->found++] = i;
        }
    }
    for (uint32_t i = 0; i < s->found; i++) {
        const uint32_t probe = s->order[i];
        if (s->distance[probe] > 0) {
            mix_neighbours(v, s, probe, floats, light);
        }
        for (int k = 0; k < 6; k++) {
            const uint32_t n = neighbour(v, probe, k);
            if (n != ALPI_NONE && s->distance[n] == ALPI_NONE) {
                s->distance[n] = s->distance[probe] + 1;
                s->order[s->found++] = n;
            }
        }
    }
    return ALP_OK;
}

alp_result alpi_probe_volume_spread(const alpi_probe_volume *v, uint32_t floats, float *light)
{
    spread s = {0};
    const alp_result result = spread_light(v, floats, light, &s);
    alpi_release(v->context, s.order);
    alpi_release(v->context, s.distance);
    return result;
}
