// SPDX-License-Identifier: MIT
// The ambience volume as a field.
#include "base/memory.h"
#include "fields/ambience/ambience.h"
#include "fields/field.h"

typedef struct ambience_field {
    alp_field field;
    alp_ambience *ambience;
    const alp_ambience_snapshot *snapshot;
} ambience_field;

static void destroy(alp_field *field)
{
    ambience_field *f = (ambience_field *)field;
    alp_ambience_end_read(f->ambience, f->snapshot);
    alpi_release(field->context, f);
}

static void irradiance(const alp_field *field, uint32_t count, const float (*positions)[3],
                       const float (*normals)[3], float (*out)[3])
{
    const ambience_field *f = (const ambience_field *)field;
    for (uint32_t i = 0; i < count; i++) {
        const double place[1][3] = {
            {(double)positions[i][0], (double)positions[i][1], (double)positions[i][2]}};
        alp_ambience_irradiance(f->snapshot, 1, place, &normals[i], &out[i]);
    }
}

static const alpi_field_kind kind = {"ambience", irradiance, NULL, destroy};

alp_result alp_field_create_ambience(alp_ambience *ambience, alp_field **field)
{
    if (ambience == NULL || field == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *field = NULL;
    ambience_field *f = ALPI_NEW(ambience->context, ambience_field, 1);
    if (f == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    f->field = (alp_field){.context = ambience->context, .kind = &kind};
    f->ambience = ambience;
    f->snapshot = alp_ambience_begin_read(ambience);
    *field = &f->field;
    return ALP_OK;
}
