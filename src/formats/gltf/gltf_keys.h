// SPDX-License-Identifier: MIT
// Keys of an animation: values at times, and the curve through them.
#ifndef ALPI_FORMATS_GLTF_KEYS_H
#define ALPI_FORMATS_GLTF_KEYS_H

#include "formats/gltf/gltf_document.h"

typedef enum alpi_gltf_interpolation {
    ALPI_GLTF_LINEAR = 0,
    ALPI_GLTF_STEP,
    ALPI_GLTF_CUBIC // Hermite: incoming tangent, value and outgoing tangent of each key
} alpi_gltf_interpolation;

typedef struct alpi_gltf_keys {
    alpi_gltf_values times;  // [count] seconds, rising
    alpi_gltf_values values; // [count] of `width` numbers each, three times as many of a cubic
    uint32_t count, width;
    alpi_gltf_interpolation interpolation;
    bool rotations; // quaternions x y z w
} alpi_gltf_keys;

/// The fault of times or values that no curve goes through, or NULL. Sizes are right already.
/// @param key out: that has it
const char *alpi_gltf_keys_fault(const alpi_gltf_keys *keys, uint32_t *key);
/// Seconds of the last key.
double alpi_gltf_keys_end(const alpi_gltf_keys *keys);
/// The curve at a time. Before the first key it has the first value, after the last the last one.
/// @param value [width] out; a rotation has length 1
void alpi_gltf_keys_at(const alpi_gltf_keys *keys, double seconds, double *value);

#endif
