// SPDX-License-Identifier: MIT
// Probes as a field.
#include "base/memory.h"
#include "base/octahedral.h"
#include "fields/probes/probe_lookup.h"

#include <math.h>
#include <string.h>

static void destroy(alp_field *field)
{
    alpi_probe_field *f = (alpi_probe_field *)field;
    alp_context *context = field->context;
    alpi_release(context, f->light);
    alpi_release(context, f->gradients);
    alpi_release(context, f->places);
    alpi_release(context, f->states);
    alpi_release(context, f->moments);
    alpi_release(context, f);
}

static void read_lattice(const alp_field *field, uint32_t count, const float (*positions)[3],
                         const float (*normals)[3], float (*irradiance)[3])
{
    ALPI_COMPILED_FOR(field->context, alpi_probe_lookup)
    (field, count, positions, normals, irradiance);
}

/// v² + (.03 E)² at a point, mean over the channels: see alp_field_errors.
double alpi_probe_field_change(const alp_field *field, const float position[3],
                               const float normal[3])
{
    enum { PLACES = 7 };
    static const double TRUNCATION = 0.03;
    const alpi_probe_field *f = (const alpi_probe_field *)field;
    float p[PLACES][3], n[PLACES][3], e[PLACES][3];
    for (int i = 0; i < PLACES; i++) {
        memcpy(p[i], position, sizeof p[i]);
        memcpy(n[i], normal, sizeof n[i]);
    }
    for (int i = 1; i < PLACES; i++) {
        const int axis = (i - 1) / 2;
        p[i][axis] += (i % 2 == 0 ? -0.25f : 0.25f) * f->spacing[axis];
    }
    read_lattice(field, PLACES, (const float(*)[3])p, (const float(*)[3])n, e);
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const double own = (double)fmaxf(e[0][k], 0.0f);
        sum += TRUNCATION * TRUNCATION * own * own;
        for (int i = 1; i < PLACES; i++) {
            const double apart = (double)fmaxf(e[i][k], 0.0f) - own;
            sum += apart * apart / (PLACES - 1);
        }
    }
    return sum / 3.0;
}

static void find_errors(const alp_field *field, uint32_t count, const float (*positions)[3],
                        const float (*normals)[3], float *errors)
{
    const alpi_probe_field *f = (const alpi_probe_field *)field;
    const double noise = (double)field->error, factor = (double)f->factor;
    for (uint32_t i = 0; i < count; i++) {
        const double change = alpi_probe_field_change(field, positions[i], normals[i]);
        errors[i] = (float)sqrt(noise * noise + factor * factor * change);
    }
}

/// The nearest probes of a list, by inverse squares of their distances.
static void read_list(const alp_field *field, uint32_t count, const float (*positions)[3],
                      const float (*normals)[3], float (*irradiance)[3])
{
    enum { NEAREST = 4 };
    const alpi_probe_field *f = (const alpi_probe_field *)field;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t nearest[NEAREST], found = 0;
        float squares[NEAREST], weights[ALPI_SH9_COUNT], total = 0.0f;
        for (uint32_t p = 0; p < f->count; p++) {
            const vec3 way = vec3_sub(vec3_load(f->places[p]), vec3_load(positions[i]));
            const float square = vec3_dot(way, way);
            if (f->states[p] > ALPI_PROBE_MOVED ||
                (found == NEAREST && square >= squares[NEAREST - 1])) {
                continue;
            }
            uint32_t at = found < NEAREST ? found++ : NEAREST - 1;
            for (; at > 0 && squares[at - 1] > square; at--) {
                squares[at] = squares[at - 1];
                nearest[at] = nearest[at - 1];
            }
            squares[at] = square;
            nearest[at] = p;
        }
        alpi_probe_weights(f->basis, vec3_load(normals[i]), weights);
        memset(irradiance[i], 0, sizeof irradiance[i]);
        for (uint32_t n = 0; n < found; n++) {
            const float w = 1.0f / (squares[n] + 1e-12f);
            const float *light = f->light + (size_t)nearest[n] * f->stride;
            for (uint32_t c = 0; c < f->coefficient_count; c++) {
                for (uint32_t k = 0; k < 3; k++) {
                    irradiance[i][k] += w * weights[c] * light[3 * c + k];
                }
            }
            total += w;
        }
        for (int k = 0; k < 3 && total > 0.0f; k++) {
            irradiance[i][k] /= total;
        }
    }
}

static const alpi_field_kind lattice_kind = {"probes", read_lattice, find_errors, destroy};
static const alpi_field_kind list_kind = {"probes", read_list, NULL, destroy};

// --- filling -------------------------------------------------------------------------------------

/// Texel (x, y) of an octahedral map whose border continues round the sphere; x, y in [−1, side].
static uint32_t wrapped(int x, int y)
{
    enum { SIDE = ALPI_PROBE_MOMENT_SIDE };
    if (y < 0 || y >= SIDE) { // past the top or bottom: mirrored along it
        x = SIDE - 1 - x;
        y = y < 0 ? 0 : SIDE - 1;
    }
    if (x < 0 || x >= SIDE) {
        y = SIDE - 1 - y;
        x = x < 0 ? 0 : SIDE - 1;
    }
    return (uint32_t)(y * SIDE + x);
}

static void fill_moments(const alpi_probe_volume *v, alpi_probe_field *f)
{
    enum { MAP = ALPI_PROBE_MOMENT_SIDE * ALPI_PROBE_MOMENT_SIDE };
    for (uint32_t p = 0; p < v->count; p++) {
        for (int i = 0; i < ALPI_LOOKUP_MOMENTS; i++) {
            const uint32_t from = wrapped(i % ALPI_LOOKUP_SIDE - 1, i / ALPI_LOOKUP_SIDE - 1);
            memcpy(f->moments[(size_t)p * ALPI_LOOKUP_MOMENTS + (size_t)i],
                   v->moments[(size_t)p * MAP + from], sizeof *f->moments);
        }
    }
}

static void fill_light(const alpi_probe_volume *v, const float *strengths, alpi_probe_field *f)
{
    const uint32_t floats = 3 * v->coefficient_count;
    for (uint32_t p = 0; p < v->count; p++) {
        float *light = f->light + (size_t)p * f->stride;
        for (uint32_t i = 0; i < floats; i++) {
            light[i] = v->coefficients[(size_t)p * floats + i];
            for (uint32_t l = 0; l < v->layer_count; l++) {
                const float more = strengths != NULL ? strengths[l] - 1.0f : 0.0f;
                light[i] += more * v->layers[l].coefficients[(size_t)p * floats + i];
            }
        }
        for (uint32_t axis = 0; axis < 3 && f->gradients != NULL && v->gradients != NULL; axis++) {
            memcpy(f->gradients + ((size_t)p * 3 + axis) * f->stride,
                   v->gradients + ((size_t)p * 3 + axis) * floats, floats * sizeof(float));
        }
    }
}

static void fill_places(const alpi_probe_volume *v, const double origin[3], alpi_probe_field *f)
{
    for (int k = 0; k < 3; k++) {
        f->origin[k] = (float)(v->origin[k] - origin[k]);
        f->spacing[k] = v->spacing[k];
        f->inverse_spacing[k] = v->spacing[k] > 0.0f ? 1.0f / v->spacing[k] : 0.0f;
    }
    for (uint32_t p = 0; p < v->count; p++) {
        double place[3];
        alpi_probe_place(v, p, place);
        for (int k = 0; k < 3; k++) {
            f->places[p][k] = (float)(place[k] + (double)v->moves[p][k] - origin[k]);
        }
    }
    if (!f->along_normal) { // three.js knows no states: all count
        memcpy(f->states, v->states, v->count);
    }
}

static alp_result fill(const alpi_probe_volume *v, alp_probe_lookup lookup, const double origin[3],
                       const float *strengths, alpi_probe_field *f)
{
    alp_context *context = v->context;
    const size_t n = v->count;
    const bool three = lookup == ALP_LOOKUP_THREE;
    f->basis = v->basis;
    f->coefficient_count = v->coefficient_count;
    f->stride = (3 * v->coefficient_count + 3) / 4 * 4;
    f->count = v->count;
    memcpy(f->size, v->size, sizeof f->size);
    f->factor = v->factor;
    f->along_normal = three;
    ALPI_TRY_NEW(context, f->light, n * f->stride);
    ALPI_TRY_NEW(context, f->places, n);
    ALPI_TRY_NEW(context, f->states, n);
    if (v->gradients != NULL && !three) {
        ALPI_TRY_NEW(context, f->gradients, n * 3 * f->stride);
    }
    if (v->moments != NULL && !three && !v->is_list) {
        ALPI_TRY_NEW(context, f->moments, n * ALPI_LOOKUP_MOMENTS);
        fill_moments(v, f);
    }
    fill_light(v, strengths, f);
    if (three) { // as the export has them
        ALP_TRY(alpi_probe_volume_spread(v, f->stride, f->light));
    }
    fill_places(v, origin, f);
    return ALP_OK;
}

alp_result alpi_probe_field_create(const alpi_probe_volume *v, alp_probe_lookup lookup,
                                   const double origin[3], const float *strengths,
                                   alp_field **field)
{
    static const double zero[3] = {0.0, 0.0, 0.0};
    *field = NULL;
    if (v->is_list && lookup != ALP_LOOKUP_OURS) {
        return alpi_fail(v->context, ALP_ERROR_INVALID_ARGUMENT,
                         "probes at listed places have no lattice; three.js reads lattices alone");
    }
    alpi_probe_field *f = ALPI_NEW(v->context, alpi_probe_field, 1);
    if (f == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    f->field = (alp_field){.context = v->context,
                           .kind = v->is_list ? &list_kind : &lattice_kind,
                           .direct = v->direct,
                           .error = v->noise};
    const alp_result result = fill(v, lookup, origin != NULL ? origin : zero, strengths, f);
    if (result != ALP_OK) {
        destroy(&f->field);
        return result;
    }
    *field = &f->field;
    return ALP_OK;
}

alp_result alp_field_create_probes(const alp_probes *probes, alp_probe_lookup lookup,
                                   const double origin[3], const float *strengths,
                                   alp_field **field)
{
    if (probes == NULL || field == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    return alpi_probe_field_create(&probes->volume, lookup, origin, strengths, field);
}
