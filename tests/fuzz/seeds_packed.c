// SPDX-License-Identifier: MIT
// Inputs of the accessors' target: one grid, plain, quantised, sparse, in instances, with a skin
// and a target, and compressed by meshoptimizer and Draco.
#include "accessors_input.h"
#include "seeds.h"

#ifdef HAS_DRACO_ENCODER
#include "draco_encode.h"
#endif

#include <meshoptimizer.h>

#include <string.h>

enum { SIDE = 4, VERTICES = SIDE * SIDE, INDICES = 6 * (SIDE - 1) * (SIDE - 1) };
enum { BYTE = 0, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT = 5, FLOAT };
enum { SCALAR = 1, VEC2, VEC3, VEC4, MAT4 };

typedef struct seed {
    input head;
    uint8_t bin[1 << 14];
    size_t size;
} seed;

static struct {
    float positions[VERTICES][3], normals[VERTICES][3], uvs[VERTICES][2];
    uint16_t short_positions[VERTICES][4];
    int8_t byte_normals[VERTICES][4];
    uint8_t colors[VERTICES][4];
    uint32_t indices[INDICES];
    uint16_t short_indices[INDICES];
} grid;

static void make_grid(void)
{
    for (uint32_t i = 0; i < VERTICES; i++) {
        const uint32_t x = i % SIDE, y = i / SIDE;
        grid.positions[i][0] = grid.uvs[i][0] = (float)x / 4.0f;
        grid.positions[i][1] = grid.uvs[i][1] = (float)y / 4.0f;
        grid.positions[i][2] = (float)(x * y) / 16.0f;
        grid.normals[i][2] = 1.0f;
        grid.byte_normals[i][2] = 127;
        for (int k = 0; k < 3; k++) {
            grid.short_positions[i][k] = (uint16_t)(grid.positions[i][k] * 65535.0f);
            grid.colors[i][k] = (uint8_t)(50 + 10 * i);
        }
        grid.colors[i][3] = 255;
    }
    uint32_t *at = grid.indices;
    for (uint32_t i = 0; i < SIDE * (SIDE - 1); i++) {
        if (i % SIDE == SIDE - 1) {
            continue;
        }
        const uint32_t corners[6] = {i, i + 1, i + SIDE, i + 1, i + SIDE + 1, i + SIDE};
        memcpy(at, corners, sizeof corners);
        at += 6;
    }
    for (int i = 0; i < INDICES; i++) {
        grid.short_indices[i] = (uint16_t)grid.indices[i];
    }
}

/// Puts bytes behind the others. @return their view
static uint8_t add_view(seed *s, uint8_t view, const void *bytes, size_t size, uint8_t stride)
{
    s->head.views[view] =
        (input_view){.offset = (uint16_t)s->size, .length = (uint16_t)size, .stride = stride};
    memcpy(s->bin + s->size, bytes, size);
    s->size += (size + 3) / 4 * 4;
    return view;
}

static void set(seed *s, int accessor, int component_type, int type, uint8_t view, size_t count)
{
    s->head.accessors[accessor] = (input_accessor){.component_type = (uint8_t)component_type,
                                                   .type = (uint8_t)type,
                                                   .view = view,
                                                   .count = (uint16_t)count};
}

static seed start(int parts)
{
    seed s = {.head.head = {.parts = (uint8_t)parts, .mode = 4}};
    for (int i = 0; i < INPUT_ACCESSORS; i++) {
        set(&s, i, FLOAT, VEC3, 255, VERTICES);
    }
    return s;
}

static void put(const seed *s, const char *name)
{
    uint8_t bytes[sizeof s->head + sizeof s->bin];
    memcpy(bytes, &s->head, sizeof s->head);
    memcpy(bytes + sizeof s->head, s->bin, s->size);
    seed_put("accessors", name, bytes, sizeof s->head + s->size);
}

static void put_plain(void)
{
    seed s = start(INPUT_NORMALS | INPUT_UVS | INPUT_INDICES);
    set(&s, 0, FLOAT, VEC3, add_view(&s, 0, grid.positions, sizeof grid.positions, 0), VERTICES);
    set(&s, 1, FLOAT, VEC3, add_view(&s, 1, grid.normals, sizeof grid.normals, 12), VERTICES);
    set(&s, 2, FLOAT, VEC2, add_view(&s, 2, grid.uvs, sizeof grid.uvs, 0), VERTICES);
    set(&s, 4, UNSIGNED_INT, SCALAR, add_view(&s, 3, grid.indices, sizeof grid.indices, 0),
        INDICES);
    put(&s, "plain");
    s.head.head.mode = 5;
    s.head.accessors[0].flags = 2; // one vertex elsewhere
    s.head.accessors[0].sparse_count = 1;
    s.head.accessors[0].sparse_type = UNSIGNED_INT;
    s.head.accessors[0].sparse_indices = 3;
    s.head.accessors[0].sparse_values = 1;
    put(&s, "sparse_strip");
}

static void put_quantised(void)
{
    seed s = start(INPUT_NORMALS | INPUT_UVS | INPUT_COLORS | INPUT_INDICES);
    const uint8_t view = add_view(&s, 0, grid.short_positions, sizeof grid.short_positions, 8);
    set(&s, 0, UNSIGNED_SHORT, VEC3, view, VERTICES);
    set(&s, 2, UNSIGNED_SHORT, VEC2, view, VERTICES);
    set(&s, 1, BYTE, VEC3, add_view(&s, 1, grid.byte_normals, sizeof grid.byte_normals, 4),
        VERTICES);
    set(&s, 3, UNSIGNED_BYTE, VEC4, add_view(&s, 2, grid.colors, sizeof grid.colors, 0), VERTICES);
    set(&s, 4, UNSIGNED_SHORT, SCALAR,
        add_view(&s, 3, grid.short_indices, sizeof grid.short_indices, 0), INDICES);
    for (int i = 0; i < 4; i++) {
        s.head.accessors[i].flags = 1;
    }
    put(&s, "quantised");
}

static void put_posed(void)
{
    static const float weights[VERTICES][4] = {{1, 0, 0, 0}, {0.5f, 0.5f, 0, 0}};
    static const float turns[2][4] = {{0, 0, 0, 1}, {0, 1, 0, 0}};
    static const float matrices[2][16] = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                          {2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}};
    seed s = start(INPUT_TARGET | INPUT_SKIN);
    const uint8_t view = add_view(&s, 0, grid.positions, sizeof grid.positions, 0);
    set(&s, 0, FLOAT, VEC3, view, VERTICES - 1);
    set(&s, 5, FLOAT, VEC3, view, VERTICES - 1);
    set(&s, 6, UNSIGNED_BYTE, VEC4, 255, VERTICES - 1);
    set(&s, 7, FLOAT, VEC4, add_view(&s, 1, weights, sizeof weights, 0), VERTICES - 1);
    set(&s, 8, FLOAT, MAT4, add_view(&s, 2, matrices, sizeof matrices, 0), 2);
    put(&s, "posed");
    s.head.head.parts = INPUT_INSTANCES;
    set(&s, 9, FLOAT, VEC3, view, 2);
    set(&s, 10, FLOAT, VEC4, add_view(&s, 3, turns, sizeof turns, 0), 2);
    set(&s, 11, FLOAT, VEC3, view, 2);
    s.head.accessors[11].offset = 12;
    put(&s, "instances");
}

/// Marks a view as packed by meshoptimizer. @param packing see accessors_input.h
static void pack(seed *s, uint8_t view, uint8_t packing, size_t count, uint8_t stride)
{
    input_view *v = &s->head.views[view];
    v->packing = packing;
    v->packed_length = v->length;
    v->count = (uint16_t)count;
    v->stride = stride;
    v->length = (uint16_t)(count * stride);
}

static void put_meshopt(void)
{
    uint8_t packed[4096];
    size_t size = meshopt_encodeVertexBuffer(packed, sizeof packed, grid.positions, VERTICES, 12);
    seed s = start(INPUT_NORMALS | INPUT_INDICES);
    set(&s, 0, FLOAT, VEC3, add_view(&s, 0, packed, size, 0), VERTICES);
    pack(&s, 0, 1, VERTICES, 12);
    meshopt_encodeFilterOct(grid.byte_normals, VERTICES, 4, 8, &grid.normals[0][0]);
    size = meshopt_encodeVertexBuffer(packed, sizeof packed, grid.byte_normals, VERTICES, 4);
    set(&s, 1, BYTE, VEC3, add_view(&s, 1, packed, size, 0), VERTICES);
    pack(&s, 1, 1 + 4 * 1, VERTICES, 4);
    s.head.accessors[1].flags = 1;
    size = meshopt_encodeIndexBuffer(packed, sizeof packed, grid.indices, INDICES);
    set(&s, 4, UNSIGNED_SHORT, SCALAR, add_view(&s, 2, packed, size, 0), INDICES);
    pack(&s, 2, 2, INDICES, 2);
    put(&s, "meshopt");
    size = meshopt_encodeIndexSequence(packed, sizeof packed, grid.indices, INDICES);
    set(&s, 4, UNSIGNED_INT, SCALAR, add_view(&s, 2, packed, size, 0), INDICES);
    pack(&s, 2, 3, INDICES, 4);
    put(&s, "meshopt_sequence");
}

#ifdef HAS_DRACO_ENCODER
static void put_draco(bool sequential, int bits, const char *name)
{
    uint8_t packed[8192];
    uint32_t points = 0;
    const draco_input from = {.positions = (const float(*)[3])grid.positions,
                              .normals = (const float(*)[3])grid.normals,
                              .uvs = (const float(*)[2])grid.uvs,
                              .vertex_count = VERTICES,
                              .indices = grid.indices,
                              .index_count = INDICES,
                              .is_sequential = sequential,
                              .position_bits = bits,
                              .has_metadata = sequential};
    const size_t size = draco_encode(&from, packed, sizeof packed, &points);
    if (size == 0) {
        seed_fail(name);
    }
    seed s = start(INPUT_DRACO | INPUT_NORMALS | INPUT_UVS | INPUT_INDICES);
    add_view(&s, 0, packed, size, 0);
    set(&s, 0, FLOAT, VEC3, 255, points);
    set(&s, 1, FLOAT, VEC3, 255, points);
    set(&s, 2, FLOAT, VEC2, 255, points);
    set(&s, 4, UNSIGNED_INT, SCALAR, 255, INDICES);
    put(&s, name);
}
#endif

void seeds_packed(void)
{
    make_grid();
    put_plain();
    put_quantised();
    put_posed();
    put_meshopt();
#ifdef HAS_DRACO_ENCODER
    put_draco(true, 0, "draco_sequential");
    put_draco(false, 11, "draco");
#endif
}
