// SPDX-License-Identifier: MIT
// Floats of probes in the texels of two textures of half floats. docs/manual/probe-format.md states
// the same for readers of other projects.
//
// Coefficients: RGBA. A slab holds one texel of every probe. The 3 C floats of a set of
// coefficients fill ceil(3 C / 4) slabs:
//
//     light | move x, y, z and state | layer 0 | layer 1 ... | change along x | along y | along z
//
// Moments: RG. Every probe has a tile of 8 x 8 texels: mean distance / reach, mean square / reach².
#ifndef ALPI_FORMATS_PROBE_LAYOUT_H
#define ALPI_FORMATS_PROBE_LAYOUT_H

#include "formats/images/images.h"
#include "scene/probe_volume.h"

enum {
    ALPI_PROBE_COUNT_LIMIT = (1 << 24) - 1, // in a file: UINT32_MAX / 256
    ALPI_PROBE_LIST_LIMIT = 1 << 20,        // in a file
    ALPI_PROBE_LAYER_LIMIT = 1 << 10,       // in a file
    ALPI_PROBE_ROW = 256,                   // probes in a row of the texture of a list
    ALPI_PROBE_STORED_MOST = 1 << 15        // magnitude of a stored coefficient
};

/// Places of probes in a slab. Probe i has texel i: x fastest, then y, then z.
typedef struct alpi_probe_slab {
    uint32_t size[3];   // texels
    uint32_t set;       // slabs of a set of coefficients
    uint32_t set_count; // the light, layers, three for gradients
} alpi_probe_slab;

/// From count, size, basis, layer_count.
alpi_probe_slab alpi_probe_slab_of(const alpi_probe_volume *volume, bool gradients);

/// Sizes of the textures, without texels. @return LIMIT where one would be too large
alp_result alpi_probe_texture_shapes(const alpi_probe_volume *volume, bool gradients,
                                     alpi_half_texture *coefficients, alpi_half_texture *moments);

/// The power of two over which coefficients are stored: 1 where the largest fits, and is not tiny.
double alpi_probe_scale(const alpi_probe_volume *volume);

/// Fills the texels, zero before, which the caller allocated.
void alpi_probe_pack(const alpi_probe_volume *volume, double scale, alpi_half_texture *texture);
void alpi_probe_pack_moments(const alpi_probe_volume *volume, alpi_half_texture *texture);

/// Fills the arrays of an allocated volume. @return INVALID_DATA (no number, no state)
/// @param name of the file, for messages
alp_result alpi_probe_unpack(const alpi_half_texture *texture, const char *name, double scale,
                             alpi_probe_volume *volume);
alp_result alpi_probe_unpack_moments(const alpi_half_texture *texture, const char *name,
                                     alpi_probe_volume *volume);

#endif
