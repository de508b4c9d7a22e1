// SPDX-License-Identifier: MIT
// Splits vertices where their triangles want different bake coordinates: one vertex per distinct
// pair (old vertex, bits of the coordinate).
#include "formats/gltf/write/gltf_split.h"

#include "base/memory.h"
#include "base/random.h"
#include "scene/scene.h"

#include <string.h>

/// A pair in use. The first pair of an old vertex takes its place; others come behind.
typedef struct vertex_pair {
    uint32_t source;
    float values[ALPI_GLTF_SPLIT_WIDTH]; // those behind the width are 0
    uint32_t index;                      // of the new vertex
} vertex_pair;

typedef struct splitter {
    alp_context *context;
    const alpi_gltf_split_input *input;
    vertex_pair *pairs;
    size_t pair_count, pair_capacity;
    uint32_t *table;      // open addressing: pair of each slot, ALPI_NONE = free
    size_t table_size;    // a power of two, more than twice the corners
    uint32_t *first_pair; // [vertex_count] ALPI_NONE = the vertex is not used yet
    uint32_t used_count;  // old vertices in use
} splitter;

/// The slot of a pair, or the free one where it belongs.
static size_t find_slot(const splitter *s, uint32_t source, const float *values)
{
    const size_t size = s->input->width * sizeof *values;
    uint64_t key = alpi_hash64(source);
    for (uint32_t i = 0; i < s->input->width; i += 2) {
        uint64_t bits;
        memcpy(&bits, values + i, sizeof bits);
        key = alpi_hash64(bits ^ key);
    }
    size_t slot = (size_t)(key & (s->table_size - 1));
    while (s->table[slot] != ALPI_NONE) {
        const vertex_pair *pair = &s->pairs[s->table[slot]];
        if (pair->source == source && memcmp(pair->values, values, size) == 0) {
            break;
        }
        slot = (slot + 1) & (s->table_size - 1);
    }
    return slot;
}

/// The pair of a corner, made where there is none. A triangle without area is content with any.
static alp_result corner_pair(splitter *s, uint32_t source, const float *values, bool usable,
                              uint32_t *pair)
{
    size_t slot = find_slot(s, source, values);
    *pair = s->table[slot];
    if (*pair == ALPI_NONE && !usable) {
        *pair = s->first_pair[source];
    }
    if (*pair != ALPI_NONE) {
        return ALP_OK;
    }
    void *pairs = s->pairs;
    ALP_TRY(alpi_grow(s->context, &pairs, &s->pair_capacity, s->pair_count + 1, sizeof *s->pairs));
    s->pairs = pairs;
    *pair = (uint32_t)s->pair_count++;
    s->pairs[*pair] = (vertex_pair){.source = source};
    memcpy(s->pairs[*pair].values, values, s->input->width * sizeof *values);
    s->table[slot] = *pair;
    if (s->first_pair[source] == ALPI_NONE) {
        s->first_pair[source] = *pair;
        s->used_count++;
    }
    return ALP_OK;
}

/// Pairs of all corners go to `corners`: first those of usable triangles, so that others can share.
static alp_result collect_pairs(splitter *s, uint32_t (*corners)[3])
{
    const alpi_gltf_split_input *input = s->input;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t t = 0; t < input->triangle_count; t++) {
            if (input->usable[t] == (pass == 0)) {
                for (int k = 0; k < 3; k++) {
                    const float *values =
                        input->values + (3 * (size_t)t + (size_t)k) * input->width;
                    ALP_TRY(corner_pair(s, input->indices[t][k], values, input->usable[t],
                                        &corners[t][k]));
                }
            }
        }
    }
    return ALP_OK;
}

/// Numbers the new vertices: the old ones keep their places, as long as most of them are used (a
/// vertex array may be shared by many primitives, of which each uses a part).
static void number_vertices(splitter *s, alpi_gltf_split *split)
{
    uint32_t old = s->input->vertex_count;
    split->changed = s->pair_count > s->used_count;
    bool keeps_places = !split->changed || s->used_count >= old / 2;
    uint32_t next = keeps_places ? old : 0;
    for (size_t i = 0; i < s->pair_count; i++) {
        vertex_pair *pair = &s->pairs[i];
        bool is_first = s->first_pair[pair->source] == i;
        pair->index = keeps_places && is_first ? pair->source : next++;
    }
    split->vertex_count = next;
}

static alp_result fill_split(splitter *s, alpi_gltf_split *split)
{
    ALPI_TRY_NEW(s->context, split->sources, split->vertex_count);
    const size_t width = s->input->width;
    ALPI_TRY_NEW(s->context, split->values, split->vertex_count * width);
    uint32_t old = s->input->vertex_count;
    for (uint32_t v = 0; v < split->vertex_count && v < old; v++) {
        split->sources[v] = v; // those that no triangle uses
    }
    for (size_t i = 0; i < s->pair_count; i++) {
        const vertex_pair *pair = &s->pairs[i];
        split->sources[pair->index] = pair->source;
        memcpy(split->values + pair->index * width, pair->values, width * sizeof *pair->values);
    }
    for (uint32_t t = 0; t < s->input->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            split->indices[t][k] = s->pairs[split->indices[t][k]].index;
        }
    }
    return ALP_OK;
}

static alp_result run_splitter(splitter *s, alpi_gltf_split *split)
{
    uint64_t corners = 3 * (uint64_t)s->input->triangle_count;
    if (corners + s->input->vertex_count >= ALPI_NONE) {
        return alpi_fail(s->context, ALP_ERROR_LIMIT,
                         "a primitive of %u triangles and %u vertices is too large to be split",
                         s->input->triangle_count, s->input->vertex_count);
    }
    for (s->table_size = 16; s->table_size < 2 * corners;) {
        s->table_size *= 2;
    }
    ALPI_TRY_NEW(s->context, s->table, s->table_size);
    memset(s->table, 0xff, s->table_size * sizeof *s->table);
    ALPI_TRY_NEW(s->context, s->first_pair, s->input->vertex_count);
    memset(s->first_pair, 0xff, s->input->vertex_count * sizeof *s->first_pair);
    ALPI_TRY_NEW(s->context, split->indices, s->input->triangle_count);
    ALP_TRY(collect_pairs(s, split->indices));
    number_vertices(s, split);
    return fill_split(s, split);
}

alp_result alpi_gltf_split_create(alp_context *context, const alpi_gltf_split_input *input,
                                  alpi_gltf_split *split)
{
    *split = (alpi_gltf_split){0};
    splitter s = {.context = context, .input = input};
    alp_result result = run_splitter(&s, split);
    alpi_release(context, s.pairs);
    alpi_release(context, s.table);
    alpi_release(context, s.first_pair);
    if (result != ALP_OK) {
        alpi_gltf_split_destroy(context, split);
    }
    return result;
}

void alpi_gltf_split_destroy(alp_context *context, alpi_gltf_split *split)
{
    alpi_release(context, split->sources);
    alpi_release(context, split->values);
    alpi_release(context, split->indices);
    *split = (alpi_gltf_split){0};
}
