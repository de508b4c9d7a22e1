// SPDX-License-Identifier: MIT
#include "maps/radiosity/direct_map.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/texels/validity.h"

#include <math.h>

enum { TEXELS_PER_RANGE = 4096 };
static const double BEND_SHARE = 0.25; // of the error

typedef struct direct_map {
    const alpi_radiosity *radiosity;
    const alpi_direct_map_options *options;
    const alpi_task_progress *progress;
    alpi_direct_output *output;
    alpi_lattice lattice; // states and values are of this map
    const uint32_t *list; // [count] first + texel
    uint32_t count, first;
    uint32_t *some; // [count] those of the list that gather next
    uint32_t gathered;
    float bend, spread; // the most there may be
} direct_map;

static bool is_on_board(const direct_map *m, uint32_t texel)
{
    const uint16_t *p = m->lattice.texels->pixels[texel];
    return (p[0] + p[1]) % 2 == 0;
}

static alp_result gather(direct_map *m, const uint32_t *list, uint32_t count)
{
    const alpi_radiosity_options *o = &m->radiosity->options;
    m->gathered += count;
    return alpi_radiosity_direct(m->radiosity, list, count, o->direct_samples, o->seed, m->progress,
                                 m->output);
}

/// @param mean out: over the board
static alp_result gather_board(direct_map *m, double *mean)
{
    double sum = 0.0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < m->count; i++) {
        if (is_on_board(m, m->list[i] - m->first)) {
            m->some[count++] = m->list[i];
        }
    }
    ALP_TRY(gather(m, m->some, count));
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t texel = m->some[i] - m->first;
        m->lattice.states[texel] = ALPI_TEXEL_TRACED;
        m->lattice.values[texel] = alpi_reference_level(&m->output->values[m->some[i]]);
        sum += (double)m->lattice.values[texel];
    }
    *mean = sum / fmax(count, 1.0);
    return ALP_OK;
}

/// Gathers what could not be interpolated.
static alp_result gather_open(direct_map *m)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < m->count; i++) {
        if (m->lattice.states[m->list[i] - m->first] == ALPI_TEXEL_OPEN) {
            m->some[count++] = m->list[i];
        }
    }
    return gather(m, m->some, count);
}

static void mix_values(const direct_map *m, uint32_t texel, const alpi_stencil *s)
{
    alpi_reference_value *v = &m->output->values[m->first + texel];
    for (int k = 0; k < 3; k++) {
        v->mean[k] = 0.0f;
        v->variance[k] = s->bend * s->bend;
    }
    for (uint32_t i = 0; i < s->count; i++) {
        const alpi_reference_value *from = &m->output->values[m->first + s->texels[i]];
        const float w = s->weights[i];
        for (int k = 0; k < 3; k++) {
            v->mean[k] += w * from->mean[k];
            v->variance[k] += w * w * from->variance[k];
        }
    }
}

/// Of each layer, to which what is gathered is added.
static void mix_layers(const direct_map *m, uint32_t texel, const alpi_stencil *s)
{
    const alpi_light_layers *l = m->radiosity->options.layers;
    for (uint32_t layer = 0; l != NULL && layer < l->count; layer++) {
        float(*values)[3] = l->direct[layer] + m->first;
        for (uint32_t i = 0; i < s->count; i++) {
            for (int k = 0; k < 3; k++) {
                values[texel][k] += s->weights[i] * values[s->texels[i]][k];
            }
        }
    }
}

static void mix_directional(const direct_map *m, uint32_t texel, const alpi_stencil *s)
{
    alpi_directional *d = m->output->directional;
    if (d == NULL) {
        return;
    }
    d[texel] = (alpi_directional){0};
    for (uint32_t i = 0; i < s->count; i++) {
        alpi_directional_mix(&d[texel], 1.0f, &d[s->texels[i]], s->weights[i]);
    }
}

/// Interpolates the texels that may be. They read none but the board's.
static alp_result fill_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    const direct_map *m = user;
    const uint8_t *near = m->options->near;
    (void)worker;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t texel = m->list[i] - m->first;
        alpi_stencil s;
        if (is_on_board(m, texel) || (near != NULL && near[texel] == ALPI_TOUCHING) ||
            !alpi_lattice_board_stencil(&m->lattice, texel, &s) || s.bend > m->bend ||
            s.spread > m->spread) {
            continue;
        }
        mix_values(m, texel, &s);
        mix_layers(m, texel, &s);
        mix_directional(m, texel, &s);
        m->lattice.states[texel] = ALPI_TEXEL_INTERPOLATED;
    }
    return ALP_OK;
}

static alp_result run(direct_map *m)
{
    alp_context *context = m->lattice.context;
    const double error = m->options->error;
    double mean;
    ALPI_TRY_NEW(context, m->lattice.states, m->lattice.texels->count);
    ALPI_TRY_NEW(context, m->lattice.values, m->lattice.texels->count);
    ALPI_TRY_NEW(context, m->some, m->count);
    ALP_TRY(gather_board(m, &mean));
    m->bend = (float)(BEND_SHARE * error * mean);
    m->spread = (float)(sqrt(error) * mean);
    ALP_TRY(alpi_parallel_for(context, m->count, TEXELS_PER_RANGE, fill_range, m, NULL));
    return gather_open(m);
}

alp_result alpi_direct_map(const alpi_radiosity *radiosity, const alpi_direct_map_options *options,
                           const uint32_t *list, uint32_t count, const alpi_task_progress *progress,
                           alpi_direct_output *output, uint32_t *gathered)
{
    direct_map m = {.radiosity = radiosity,
                    .options = options,
                    .progress = progress,
                    .output = output,
                    .lattice = *options->lattice,
                    .list = list,
                    .count = count,
                    .first = options->backs ? options->lattice->texels->count : 0};
    m.lattice.states = NULL;
    m.lattice.values = NULL;
    m.lattice.straight = true;
    m.lattice.along_borders = true;
    const alp_result result = options->error > 0.0 ? run(&m) : gather(&m, list, count);
    alpi_release(m.lattice.context, m.lattice.states);
    alpi_release(m.lattice.context, m.lattice.values);
    alpi_release(m.lattice.context, m.some);
    *gathered = m.gathered;
    return result;
}
