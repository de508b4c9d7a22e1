// SPDX-License-Identifier: MIT
// The one interface of fields. A kind of field embeds alp_field as its first member.
#ifndef ALPI_FIELDS_FIELD_H
#define ALPI_FIELDS_FIELD_H

#include "base/context.h"
#include "base/vec.h"

#include <alpenglow/field.h>

/// The operations of a kind of field.
typedef struct alpi_field_kind {
    const char *name;
    /// E at points whose positions and normals are finite. Called by many threads; allocates
    /// nothing. Values below 0 are allowed: the caller clamps.
    void (*irradiance)(const alp_field *field, uint32_t count, const float (*positions)[3],
                       const float (*normals)[3], float (*irradiance)[3]);
    /// Expected RMS error at such points; NULL: alp_field.error everywhere.
    void (*errors)(const alp_field *field, uint32_t count, const float (*positions)[3],
                   const float (*normals)[3], float *errors);
    void (*destroy)(alp_field *field);
} alpi_field_kind;

struct alp_field {
    alp_context *context;
    const alpi_field_kind *kind;
    bool direct; // light straight from punctual lamps and suns is in it
    float error; // expected RMS error of E [W·m⁻²], apart from its place; 0: not known
};

#endif
