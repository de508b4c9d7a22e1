// SPDX-License-Identifier: MIT
// Values at vertices as an attribute.
#ifndef ALPI_FORMATS_GLTF_PATCH_VERTEX_H
#define ALPI_FORMATS_GLTF_PATCH_VERTEX_H

#include "formats/gltf/write/gltf_patch.h"

/// "COLOR_0" or "_OCCLUSION".
const char *alpi_patcher_vertex_name(const alpi_gltf_patcher *patcher);

/// A warning when values go to the colours of a file that holds those of an earlier bake there.
void alpi_patcher_warn_of_former(const alpi_gltf_patcher *patcher);

/// The value of a scene's vertex as it is stored, [0, 65535]; NaN is 0.
uint16_t alpi_patcher_vertex_value(const alpi_gltf_patcher *patcher, uint32_t vertex);

/// Values of the vertices that a primitive is written with.
typedef struct alpi_gltf_vertex_input {
    json_t *primitive;       // of the document
    const char *owner;       // for messages
    uint32_t source_count;   // its vertices
    uint32_t count;          // written vertices
    const uint32_t *sources; // [count] vertex of the document that each was, NULL = itself
    const uint16_t *values;  // [count] 65535 is 1
} alpi_gltf_vertex_input;
/// Adds the accessor: normalised 16-bit values, times the colours that the primitive has.
alp_result alpi_patcher_add_vertex_values(alpi_gltf_patcher *patcher,
                                          const alpi_gltf_vertex_input *input, size_t *accessor);

#endif
