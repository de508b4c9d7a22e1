// SPDX-License-Identifier: MIT
// Reading probes between their places.
//
// The eight probes round a point p are weighed by
//
//     w = trilinear · crush(visibility · (((n·ω + 1)/2)² + .2)),   ω: from p to the probe, unit
//
//     visibility = 1 at distances d ≤ m₁, else max(.05, (v / (v + (d − m₁)²))³), v = |m₂ − m₁²|
//     crush(w)   = w³ / .04 below .2, else w
//
// with m₁, m₂ the mean distance and the mean of its square that the probe met towards p, bilinear
// in its octahedral map. Without visibility the weights are trilinear alone. Probes in solids count
// only where no other does.
// Based on: Z. Majercik, J.-P. Guertin, D. Nowrouzezahrai, M. McGuire. Dynamic Diffuse Global
//           Illumination with Ray-Traced Irradiance Fields. JCGT 8(2), 2019.
#ifndef ALPI_FIELDS_PROBE_LOOKUP_H
#define ALPI_FIELDS_PROBE_LOOKUP_H

#include "fields/field.h"
#include "fields/probes/probes.h"

enum {
    ALPI_LOOKUP_SIDE = ALPI_PROBE_MOMENT_SIDE + 2, // with a border, which wraps round
    ALPI_LOOKUP_MOMENTS = ALPI_LOOKUP_SIDE * ALPI_LOOKUP_SIDE,
    ALPI_LOOKUP_STRIDE_MOST = 28
};

/// A lattice of probes as a look-up reads it.
typedef struct alpi_probe_field {
    alp_field field;
    alpi_probe_basis basis;
    uint32_t coefficient_count, stride; // floats of a probe, padded: 28, 12 or 20
    uint32_t count, size[3];
    float origin[3], spacing[3], inverse_spacing[3]; // metres, positions in the scene
    float *light;                                    // [count][stride]
    float *gradients;    // NULL, or [count][3][stride]: per metre from the probe's place
    float (*places)[3];  // [count] where each was sampled
    uint8_t *states;     // [count]
    float (*moments)[2]; // NULL, or [count][ALPI_LOOKUP_MOMENTS]
    float factor;        // alpi_probe_volume's
    bool along_normal;   // positions are moved half a cell along the normal: three.js
} alpi_probe_field;

typedef void alpi_probe_lookup_fn(const alp_field *field, uint32_t count,
                                  const float (*positions)[3], const float (*normals)[3],
                                  float (*irradiance)[3]);
alpi_probe_lookup_fn alpi_probe_lookup_baseline, alpi_probe_lookup_v3;

#endif
