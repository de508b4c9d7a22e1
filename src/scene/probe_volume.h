// SPDX-License-Identifier: MIT
// Probes as plain arrays: places in space, and the light that each holds. Files of probes are read
// and written as this, and look-ups read it.
#ifndef ALPI_SCENE_PROBE_VOLUME_H
#define ALPI_SCENE_PROBE_VOLUME_H

#include "base/context.h"
#include "base/vec.h"

/// Functions of direction that a probe holds.
typedef enum alpi_probe_basis {
    ALPI_PROBE_SH9 = 0,     // nine coefficients of radiance (sh/sh9.h) [W·m⁻²]
    ALPI_PROBE_SH4,         // the first four of them
    ALPI_PROBE_AMBIENT_CUBE // irradiance E at +x −x +y −y +z −z; E(n) = Σ n_i² E(±axis i)
} alpi_probe_basis;

/// How a probe came by its light.
typedef enum alpi_probe_state {
    ALPI_PROBE_VALID = 0, // sampled at its lattice place
    ALPI_PROBE_MOVED,     // sampled at its place + move, out of a solid
    ALPI_PROBE_FILLED,    // in a solid: mean of valid neighbours that it sees
    ALPI_PROBE_INVALID    // in a solid, without such neighbours: black, takes no part in look-ups
} alpi_probe_state;

/// Light of one switchable lamp, apart from all other light.
typedef struct alpi_probe_layer {
    char *name;
    float *coefficients; // [count][coefficient_count][3]
} alpi_probe_layer;

enum { ALPI_PROBE_MOMENT_SIDE = 8 };

typedef struct alpi_probe_volume {
    alp_context *context; // allocator of all arrays
    bool is_list;         // places are any, not a lattice
    uint32_t count;       // probes; at most UINT32_MAX / 256
    // Lattice: probe (x, y, z) has index x + size[0] (y + size[1] z).
    uint32_t size[3];   // probes along each axis; list: count, 1, 1
    double origin[3];   // metres, world of the scene's file: place of probe 0; list: 0
    float spacing[3];   // metres between neighbours, > 0; list: 0
    float (*places)[3]; // list: [count] metres, world of the scene's file; lattice: NULL
    float (*moves)[3];  // [count] metres from its place to where it was sampled; 0 unless MOVED
    uint8_t *states;    // [count] alpi_probe_state
    alpi_probe_basis basis;
    uint32_t coefficient_count; // 9, 4 or 6
    float *coefficients;        // [count][coefficient_count][3]
    float *gradients; // NULL, or [count][axis 3][coefficient_count][3]: change of each per metre
    uint32_t layer_count;
    alpi_probe_layer *layers; // [layer_count]
    // Visibility, or NULL: octahedral map of ALPI_PROBE_MOMENT_SIDE² directions, row by row, of the
    // mean distance to surfaces [m] and the mean of its square [m²], both of distances clamped to
    // `reach` and to twice the median of the texel.
    float (*moments)[2]; // [count][64]
    float reach;         // metres
    // Content.
    bool without_sky, without_emission, without_reflected; // false: that light is in it
    bool direct;          // light straight from punctual lamps and suns is in it
    uint64_t scene_hash;  // input_hash of the scene
    float relative_error; // stated: √(mean of squared standard errors of E) / mean E; 0 unknown
    float mean;           // E over probes that have light and normals, W·m⁻²
    float interpolation;  // RMS error of E between probes, W·m⁻², by points apart; 0 unknown
    float noise;          // RMS standard error of E at the probes, W·m⁻²
    float factor;         // of the change of E in a cell, for errors between probes; 0 unknown
    uint32_t rays;        // of each probe
    uint64_t seed;
    char *options; // JSON object: what made it, "" or NULL if not known
} alpi_probe_volume;

static inline uint32_t alpi_probe_basis_count(alpi_probe_basis basis)
{
    return basis == ALPI_PROBE_SH9 ? 9 : basis == ALPI_PROBE_SH4 ? 4 : 6;
}

/// Allocates the arrays, zeroed: moves, states, coefficients, and, as asked, places, gradients,
/// moments and layers without names. `count`, `is_list`, `basis` and `layer_count` are set before.
/// @return ALP_OK; OUT_OF_MEMORY, after which destroy is still right
alp_result alpi_probe_volume_allocate(alp_context *context, bool gradients, bool moments,
                                      alpi_probe_volume *volume);
/// Gives INVALID probes of a lattice the mean of their neighbours, nearest to light first.
/// @param light [count][floats] in, out
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_probe_volume_spread(const alpi_probe_volume *volume, uint32_t floats, float *light);
/// Releases the arrays, and leaves it zeroed. A zeroed volume is left alone.
void alpi_probe_volume_destroy(alpi_probe_volume *volume);

#endif
