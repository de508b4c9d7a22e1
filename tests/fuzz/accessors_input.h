// SPDX-License-Identifier: MIT
// What an input of the accessors' target says, byte by byte: a GLB of one mesh, whose views and
// accessors are these, and whose BIN chunk is the rest.
#ifndef ACCESSORS_INPUT_H
#define ACCESSORS_INPUT_H

#include <stdint.h>

enum {
    INPUT_VIEWS = 6,
    // POSITION, NORMAL, TEXCOORD_0, COLOR_0, indices, a target's POSITION, JOINTS_0, WEIGHTS_0,
    // inverse bind matrices; instances: TRANSLATION, ROTATION, SCALE
    INPUT_ACCESSORS = 12
};

/// Bits of input_head.parts: what the mesh has besides positions.
enum {
    INPUT_NORMALS = 1,
    INPUT_UVS = 2,
    INPUT_COLORS = 4,
    INPUT_INDICES = 8,
    INPUT_TARGET = 16,
    INPUT_SKIN = 32,
    INPUT_INSTANCES = 64,
    INPUT_DRACO = 128
};

typedef struct input_head {
    uint8_t parts;
    uint8_t mode;       // of the primitive
    uint8_t draco_view; // of INPUT_DRACO: attributes have the numbers 0, 1, 2 …
    uint8_t reserved;
} input_head;

/// Sizes at and above this stand for 2^(value − it + 8) − 1: past every limit.
enum { INPUT_LARGE = 0xffc0 };

typedef struct input_view {
    uint16_t offset, length; // little-endian, as all here
    uint8_t stride;          // 0 = none
    uint8_t packing;         // 0 = plain, 1 to 3: meshopt's mode; + 4 × filter
    uint16_t packed_length, count;
} input_view;

typedef struct input_accessor {
    uint8_t component_type; // 5120 + this
    uint8_t type;           // 1 SCALAR … 4 VEC4, 5 MAT4
    uint8_t view;           // 255 = none
    uint8_t flags;          // 1 normalized, 2 sparse
    uint16_t count, offset;
    uint8_t sparse_count, sparse_type, sparse_indices, sparse_values;
} input_accessor;

typedef struct input {
    input_head head;
    input_view views[INPUT_VIEWS];
    input_accessor accessors[INPUT_ACCESSORS];
} input;

#endif
