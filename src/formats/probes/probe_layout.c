// SPDX-License-Identifier: MIT
// Floats of probes in the texels of two textures of half floats.
#include "formats/probes/probe_layout.h"

#include "base/half.h"

#include <math.h>

enum { CHANNELS = 4, HALF_SIZE = 2, SIDE = ALPI_PROBE_MOMENT_SIDE };

// --- sizes ---------------------------------------------------------------------------------------

alpi_probe_slab alpi_probe_slab_of(const alpi_probe_volume *v, bool gradients)
{
    const uint32_t values = 3 * alpi_probe_basis_count(v->basis);
    const uint32_t row = v->count < ALPI_PROBE_ROW ? v->count : ALPI_PROBE_ROW;
    alpi_probe_slab slab = {.size = {v->size[0], v->size[1], v->size[2]},
                            .set = (values + CHANNELS - 1) / CHANNELS,
                            .set_count = 1 + v->layer_count + (gradients ? 3 : 0)};
    if (v->is_list) {
        slab.size[0] = row;
        slab.size[1] = (v->count + row - 1) / row;
        slab.size[2] = 1;
    }
    return slab;
}

alp_result alpi_probe_texture_shapes(const alpi_probe_volume *v, bool gradients,
                                     alpi_half_texture *coefficients, alpi_half_texture *moments)
{
    const alpi_probe_slab slab = alpi_probe_slab_of(v, gradients);
    const uint64_t slabs = (uint64_t)slab.set * slab.set_count + 1;
    const uint64_t depth = slabs * slab.size[2];
    *coefficients = (alpi_half_texture){
        .width = slab.size[0], .height = slab.size[1], .depth = (uint32_t)depth, .channels = 4};
    *moments = (alpi_half_texture){.width = SIDE * slab.size[0],
                                   .height = SIDE * slab.size[1],
                                   .depth = slab.size[2],
                                   .channels = 2};
    if (depth > UINT32_MAX || slab.size[0] > UINT32_MAX / SIDE ||
        slab.size[1] > UINT32_MAX / SIDE || alpi_half_texture_size(coefficients) == 0 ||
        alpi_half_texture_size(moments) == 0) {
        return alpi_fail(v->context, ALP_ERROR_LIMIT,
                         "%u probes with %u layers make a texture that is too large", v->count,
                         v->layer_count);
    }
    return ALP_OK;
}

// --- sets of coefficients ------------------------------------------------------------------------

/// A set: first float of probe 0, and floats from one probe to the next.
typedef struct value_set {
    float *values;
    size_t stride;
    uint32_t slab; // the first
} value_set;

static value_set set_at(const alpi_probe_volume *v, const alpi_probe_slab *slab, uint32_t index)
{
    const size_t width = (size_t)3 * v->coefficient_count;
    const uint32_t first = index * slab->set + (index > 0); // the second part is moves and states
    if (index == 0) {
        return (value_set){v->coefficients, width, first};
    }
    if (index <= v->layer_count) {
        return (value_set){v->layers[index - 1].coefficients, width, first};
    }
    return (value_set){v->gradients + (index - 1 - v->layer_count) * width, 3 * width, first};
}

static float largest_of(const float *values, size_t count)
{
    float most = 0.0f;
    for (size_t i = 0; i < count; i++) {
        most = fmaxf(most, fabsf(values[i]));
    }
    return most;
}

double alpi_probe_scale(const alpi_probe_volume *v)
{
    const float tiny = 0x1p-4f; // far enough from 2^-14, below which halves lose digits
    const size_t count = (size_t)v->count * v->coefficient_count * 3;
    float most = largest_of(v->coefficients, count);
    for (uint32_t i = 0; i < v->layer_count; i++) {
        most = fmaxf(most, largest_of(v->layers[i].coefficients, count));
    }
    if (v->gradients != NULL) {
        most = fmaxf(most, largest_of(v->gradients, 3 * count));
    }
    int exponent = 0; // most is in [½, 1) · 2^exponent
    const float part = frexpf(most, &exponent);
    const int above = part == 0.5f ? exponent - 1 : exponent; // most <= 2^above
    if (most > (float)ALPI_PROBE_STORED_MOST) {
        return ldexp(1.0, above - 15);
    }
    return most > 0.0f && most < tiny ? ldexp(1.0, above) : 1.0;
}

// --- texels --------------------------------------------------------------------------------------

static void put_half(uint8_t *at, float value)
{
    const uint16_t half = alpi_half_from_float(value);
    at[0] = (uint8_t)half;
    at[1] = (uint8_t)(half >> 8);
}

static float get_half(const uint8_t *at)
{
    return alpi_half_to_float((uint16_t)(at[0] | at[1] << 8));
}

/// The bytes of channel `value` % 4 of a probe, `value` / 4 slabs behind a slab.
static size_t place(size_t slab_texels, uint32_t slab, uint32_t probe, uint32_t value)
{
    const size_t texel = (slab + value / CHANNELS) * slab_texels + probe;
    return (texel * CHANNELS + value % CHANNELS) * HALF_SIZE;
}

static size_t slab_texels(const alpi_probe_slab *slab)
{
    return (size_t)slab->size[0] * slab->size[1] * slab->size[2];
}

void alpi_probe_pack(const alpi_probe_volume *v, double scale, alpi_half_texture *texture)
{
    const alpi_probe_slab slab = alpi_probe_slab_of(v, v->gradients != NULL);
    const size_t texels = slab_texels(&slab);
    for (uint32_t set = 0; set < slab.set_count; set++) {
        const value_set from = set_at(v, &slab, set);
        for (uint32_t i = 0; i < v->count; i++) {
            for (uint32_t k = 0; k < 3 * v->coefficient_count; k++) {
                put_half(texture->texels + place(texels, from.slab, i, k),
                         (float)((double)from.values[i * from.stride + k] / scale));
            }
        }
    }
    for (uint32_t i = 0; i < v->count; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            put_half(texture->texels + place(texels, slab.set, i, k), v->moves[i][k]);
        }
        put_half(texture->texels + place(texels, slab.set, i, 3), (float)v->states[i]);
    }
}

static alp_result unpack_set(const alpi_half_texture *texture, const char *name, double scale,
                             size_t texels, const alpi_probe_volume *v, value_set to)
{
    for (uint32_t i = 0; i < v->count; i++) {
        for (uint32_t k = 0; k < 3 * v->coefficient_count; k++) {
            const uint8_t *at = texture->texels + place(texels, to.slab, i, k);
            const float value = (float)((double)get_half(at) * scale);
            if (!isfinite(value)) {
                return alpi_fail(v->context, ALP_ERROR_INVALID_DATA,
                                 "%s: probe %u: value %u of slab %u is no finite number: the file "
                                 "is damaged, bake it again",
                                 name, i, k, to.slab);
            }
            to.values[i * to.stride + k] = value;
        }
    }
    return ALP_OK;
}

static alp_result unpack_states(const alpi_half_texture *texture, const char *name, size_t texels,
                                uint32_t slab, const alpi_probe_volume *v)
{
    for (uint32_t i = 0; i < v->count; i++) {
        float values[CHANNELS];
        for (uint32_t k = 0; k < CHANNELS; k++) {
            values[k] = get_half(texture->texels + place(texels, slab, i, k));
        }
        const float state = values[3];
        if (!(state >= 0.0f && state <= (float)ALPI_PROBE_INVALID && state == floorf(state))) {
            return alpi_fail(v->context, ALP_ERROR_INVALID_DATA,
                             "%s: probe %u: state %g is none of 0 to %d: the file is damaged, bake "
                             "it again",
                             name, i, (double)state, ALPI_PROBE_INVALID);
        }
        if (!vec3_is_finite(vec3_load(values))) {
            return alpi_fail(
                v->context, ALP_ERROR_INVALID_DATA,
                "%s: probe %u: its move is no finite number: the file is damaged, bake "
                "it again",
                name, i);
        }
        v->states[i] = (uint8_t)state;
        vec3_store(v->moves[i], vec3_load(values));
    }
    return ALP_OK;
}

alp_result alpi_probe_unpack(const alpi_half_texture *texture, const char *name, double scale,
                             alpi_probe_volume *v)
{
    const alpi_probe_slab slab = alpi_probe_slab_of(v, v->gradients != NULL);
    const size_t texels = slab_texels(&slab);
    for (uint32_t set = 0; set < slab.set_count; set++) {
        ALP_TRY(unpack_set(texture, name, scale, texels, v, set_at(v, &slab, set)));
    }
    return unpack_states(texture, name, texels, slab.set, v);
}

// --- moments -------------------------------------------------------------------------------------

/// The bytes of a direction's two values.
static size_t moment_place(const alpi_probe_slab *slab, uint32_t probe, uint32_t direction)
{
    const size_t width = slab->size[0], height = slab->size[1];
    const size_t x = probe % width * SIDE + direction % SIDE;
    const size_t y = probe / width % height * SIDE + direction / SIDE;
    const size_t z = probe / (width * height);
    return ((z * height * SIDE + y) * width * SIDE + x) * 2 * HALF_SIZE;
}

void alpi_probe_pack_moments(const alpi_probe_volume *v, alpi_half_texture *texture)
{
    const alpi_probe_slab slab = alpi_probe_slab_of(v, false);
    for (uint32_t i = 0; i < v->count; i++) {
        for (uint32_t d = 0; d < SIDE * SIDE; d++) {
            const float *from = v->moments[(size_t)i * SIDE * SIDE + d];
            uint8_t *at = texture->texels + moment_place(&slab, i, d);
            put_half(at, from[0] / v->reach);
            put_half(at + HALF_SIZE, from[1] / v->reach / v->reach);
        }
    }
}

alp_result alpi_probe_unpack_moments(const alpi_half_texture *texture, const char *name,
                                     alpi_probe_volume *v)
{
    const alpi_probe_slab slab = alpi_probe_slab_of(v, false);
    for (uint32_t i = 0; i < v->count; i++) {
        for (uint32_t d = 0; d < SIDE * SIDE; d++) {
            const uint8_t *at = texture->texels + moment_place(&slab, i, d);
            float *to = v->moments[(size_t)i * SIDE * SIDE + d];
            to[0] = get_half(at) * v->reach;
            to[1] = get_half(at + HALF_SIZE) * v->reach * v->reach;
            if (!isfinite(to[0]) || !isfinite(to[1]) || to[0] < 0.0f || to[1] < 0.0f) {
                return alpi_fail(
                    v->context, ALP_ERROR_INVALID_DATA,
                    "%s: probe %u: moment %u is no distance: the file is damaged, bake "
                    "it again",
                    name, i, d);
            }
        }
    }
    return ALP_OK;
}
