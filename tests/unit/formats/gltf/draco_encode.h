// SPDX-License-Identifier: MIT
// Draco's encoder for tests in C.
#ifndef DRACO_ENCODE_H
#define DRACO_ENCODE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct draco_input {
    const float (*positions)[3], (*normals)[3], (*uvs)[2];
    uint32_t vertex_count;
    const uint32_t *indices;
    uint32_t index_count;
    int is_sequential; // else Edgebreaker, which orders vertices and triangles anew
    int position_bits; // 0 = floats as they are
    int has_metadata;
} draco_input;

/// Encodes; attributes get the numbers 0 (positions), 1 (normals) and 2 (coordinates).
/// @return bytes written, 0 on failure; *point_count: vertices in the stream
size_t draco_encode(const draco_input *input, uint8_t *bytes, size_t capacity,
                    uint32_t *point_count);

#ifdef __cplusplus
}
#endif

#endif
