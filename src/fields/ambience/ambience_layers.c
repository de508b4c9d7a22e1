// SPDX-License-Identifier: MIT
// Ambience volumes of all light and of single lamps, summed as a field. Coefficients are summed,
// not irradiance: that of one layer may be below 0.
#include "base/memory.h"
#include "fields/ambience/ambience.h"
#include "fields/field.h"

#include <math.h>

typedef struct layers_field {
    alp_field field;
    alp_ambience **volumes;                  // all light, then the layers
    const alp_ambience_snapshot **snapshots; // of each
    float *factors;                          // of each
    uint32_t count;
} layers_field;

static void destroy(alp_field *field)
{
    layers_field *f = (layers_field *)field;
    for (uint32_t i = 0; i < f->count; i++) {
        alp_ambience_end_read(f->volumes[i], f->snapshots[i]);
    }
    alpi_release(field->context, f->volumes);
    alpi_release(field->context, f->snapshots);
    alpi_release(field->context, f->factors);
    alpi_release(field->context, f);
}

static void irradiance(const alp_field *field, uint32_t count, const float (*positions)[3],
                       const float (*normals)[3], float (*out)[3])
{
    const layers_field *f = (const layers_field *)field;
    for (uint32_t i = 0; i < count; i++) {
        const double place[3] = {(double)positions[i][0], (double)positions[i][1],
                                 (double)positions[i][2]};
        alpi_sh9 sum = {0};
        for (uint32_t k = 0; k < f->count; k++) {
            float light[ALPI_AMBIENCE_FLOATS];
            alpi_ambience_read(f->snapshots[k], place, normals[i], light);
            for (int c = 0; c < ALPI_AMBIENCE_FLOATS; c++) {
                sum.c[c / 3][c % 3] += f->factors[k] * light[c];
            }
        }
        vec3_store(out[i], alpi_sh9_irradiance(&sum, vec3_load(normals[i])));
    }
}

static const alpi_field_kind kind = {"ambience layers", irradiance, NULL, destroy};

static alp_result check_layers(alp_context *context, alp_ambience *const *layers,
                               const float *strengths, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (layers[i] == NULL) {
            return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT, "ambience: layer %u is NULL", i);
        }
        if (!(strengths[i] >= 0.0f) || !isfinite(strengths[i])) {
            return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                             "ambience: strength %g of layer %u, need a finite one ≥ 0",
                             (double)strengths[i], i);
        }
    }
    return ALP_OK;
}

static alp_result fill(layers_field *f, alp_ambience *all, alp_ambience *const *layers,
                       const float *strengths, uint32_t count)
{
    ALPI_TRY_NEW(all->context, f->volumes, (size_t)count + 1);
    ALPI_TRY_NEW(all->context, f->snapshots, (size_t)count + 1);
    ALPI_TRY_NEW(all->context, f->factors, (size_t)count + 1);
    for (uint32_t i = 0; i <= count; i++) {
        f->volumes[i] = i == 0 ? all : layers[i - 1];
        f->factors[i] = i == 0 ? 1.0f : strengths[i - 1] - 1.0f;
        f->snapshots[i] = alp_ambience_begin_read(f->volumes[i]);
        f->count++;
    }
    return ALP_OK;
}

alp_result alp_field_create_ambience_layers(alp_ambience *all, alp_ambience *const *layers,
                                            const float *strengths, uint32_t count,
                                            alp_field **field)
{
    if (all == NULL || field == NULL || (count > 0 && (layers == NULL || strengths == NULL))) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *field = NULL;
    ALP_TRY(check_layers(all->context, layers, strengths, count));
    layers_field *f = ALPI_NEW(all->context, layers_field, 1);
    if (f == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    f->field = (alp_field){.context = all->context, .kind = &kind};
    const alp_result result = fill(f, all, layers, strengths, count);
    if (result != ALP_OK) {
        destroy(&f->field);
        return result;
    }
    *field = &f->field;
    return ALP_OK;
}
