// SPDX-License-Identifier: MIT
#include "fields/field.h"

#include <math.h>
#include <string.h>

void alp_field_destroy(alp_field *field)
{
    if (field != NULL) {
        field->kind->destroy(field);
    }
}

static bool all_finite(uint32_t count, const float (*v)[3])
{
    float sum = 0.0f; // of zeros, or NaN
    for (uint32_t i = 0; i < count; i++) {
        sum += 0.0f * v[i][0] + 0.0f * v[i][1] + 0.0f * v[i][2];
    }
    return sum == 0.0f;
}

static void clamp(uint32_t count, float (*irradiance)[3])
{
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            irradiance[i][k] = fmaxf(irradiance[i][k], 0.0f); // of NaN too
        }
    }
}

void alp_field_irradiance(const alp_field *field, uint32_t count, const float (*positions)[3],
                          const float (*normals)[3], float (*irradiance)[3])
{
    if (field == NULL || count == 0) {
        return;
    }
    if (all_finite(count, positions) && all_finite(count, normals)) {
        field->kind->irradiance(field, count, positions, normals, irradiance);
        clamp(count, irradiance);
        return;
    }
    for (uint32_t i = 0; i < count; i++) {
        memset(irradiance[i], 0, sizeof irradiance[i]);
        if (all_finite(1, &positions[i]) && all_finite(1, &normals[i])) {
            field->kind->irradiance(field, 1, &positions[i], &normals[i], &irradiance[i]);
            clamp(1, &irradiance[i]);
        }
    }
}

void alp_field_errors(const alp_field *field, uint32_t count, const float (*positions)[3],
                      const float (*normals)[3], float *errors)
{
    if (field == NULL || count == 0) {
        return;
    }
    for (uint32_t i = 0; i < count; i++) {
        errors[i] = field->error;
        if (field->kind->errors != NULL && all_finite(1, &positions[i]) &&
            all_finite(1, &normals[i])) {
            field->kind->errors(field, 1, &positions[i], &normals[i], &errors[i]);
        }
    }
}
