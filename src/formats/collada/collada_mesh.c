// SPDX-License-Identifier: MIT
// Geometry → meshes in the file's own space: inputs, and the different corners of each primitive as
// vertices.
#include "formats/collada/collada_read.h"

#include "base/hash.h"
#include "base/memory.h"
#include "formats/collada/collada_numbers.h"

#include <string.h>

enum { STRIDE_LIMIT = 256, INPUT_LIMIT = 64 };

// --- inputs --------------------------------------------------------------------------------------

/// A TEXCOORD goes among the others by its set; those past our limit are left out.
static void add_uv(alpi_collada_inputs *inputs, uint32_t number, uint32_t source, uint32_t offset)
{
    if (inputs->most_uv_number == ALPI_NONE || number > inputs->most_uv_number) {
        inputs->most_uv_number = number;
    }
    uint32_t at = inputs->uv_count;
    while (at > 0 && inputs->uv_numbers[at - 1] > number) {
        at--;
    }
    if (at >= ALPI_UV_SET_LIMIT) {
        inputs->uv_left_out++;
        return;
    }
    const bool full = inputs->uv_count == ALPI_UV_SET_LIMIT;
    inputs->uv_left_out += full;
    for (uint32_t k = full ? ALPI_UV_SET_LIMIT - 1 : inputs->uv_count; k > at; k--) {
        inputs->uv_numbers[k] = inputs->uv_numbers[k - 1];
        inputs->source[ALPI_COLLADA_UV + k] = inputs->source[ALPI_COLLADA_UV + k - 1];
        inputs->offset[ALPI_COLLADA_UV + k] = inputs->offset[ALPI_COLLADA_UV + k - 1];
    }
    inputs->uv_numbers[at] = number;
    inputs->source[ALPI_COLLADA_UV + at] = source;
    inputs->offset[ALPI_COLLADA_UV + at] = offset;
    inputs->uv_count += !full;
}

/// The source of an <input>, and the number of its set.
static alp_result read_input(alpi_collada_reader *reader, const xmlNode *input, uint32_t *source,
                             uint32_t *set)
{
    xmlNode *element = NULL;
    ALP_TRY(alpi_collada_resolve(reader->document, input, "source", "source", &element));
    if (element == NULL) {
        return alpi_collada_fail(reader->document, input, "its source lies in another document");
    }
    ALP_TRY(alpi_collada_read_source(reader, element, source));
    return alpi_collada_count(reader->document, input, "set", 0, 1 << 20, set);
}

/// An <input> that names a <source>. Without positions there is no mesh; one of others that cannot
/// be read is left out.
static alp_result add_input(alpi_collada_reader *reader, const xmlNode *input, uint32_t offset,
                            alpi_collada_inputs *inputs)
{
    static const char *const semantics[] = {"POSITION", "NORMAL", "COLOR", "TEXCOORD"};
    const char *semantic = alpi_xml_attribute(input, "semantic");
    uint32_t key = 0;
    while (key < 4 && (semantic == NULL || strcmp(semantic, semantics[key]) != 0)) {
        key++;
    }
    if (key == 4 || (key != ALPI_COLLADA_UV && inputs->source[key] != ALPI_NONE)) {
        return ALP_OK; // tangents and the like; a second set of colours
    }
    uint32_t source = 0, set = 0;
    const alp_result result = read_input(reader, input, &source, &set);
    if (result == ALP_ERROR_INVALID_DATA && key != ALPI_COLLADA_POSITION) {
        inputs->bad = inputs->bad != NULL ? inputs->bad : input;
        return ALP_OK;
    }
    ALP_TRY(result);
    if (key == ALPI_COLLADA_UV) {
        add_uv(inputs, set, source, offset);
    } else {
        inputs->source[key] = source;
        inputs->offset[key] = offset;
    }
    return ALP_OK;
}

/// semantic="VERTEX": the inputs of <vertices>, all with one index.
static alp_result add_vertices(alpi_collada_reader *reader, const xmlNode *input, uint32_t offset,
                               alpi_collada_inputs *inputs)
{
    xmlNode *vertices = NULL;
    ALP_TRY(alpi_collada_resolve(reader->document, input, "source", "vertices", &vertices));
    const xmlNode *inner = alpi_xml_child(vertices, "input");
    for (uint32_t count = 1; inner != NULL; inner = alpi_xml_next(inner, "input"), count++) {
        if (count > INPUT_LIMIT) {
            return alpi_collada_fail(reader->document, vertices, "has more than %d inputs",
                                     INPUT_LIMIT);
        }
        ALP_TRY(add_input(reader, inner, offset, inputs));
    }
    return ALP_OK;
}

alp_result alpi_collada_read_inputs(alpi_collada_reader *reader, xmlNode *element,
                                    alpi_collada_inputs *inputs)
{
    *inputs = (alpi_collada_inputs){.most_uv_number = ALPI_NONE};
    for (uint32_t k = 0; k < ALPI_COLLADA_KEY_COUNT; k++) {
        inputs->source[k] = ALPI_NONE;
    }
    uint32_t count = 0;
    const xmlNode *input = alpi_xml_child(element, "input");
    for (; input != NULL; input = alpi_xml_next(input, "input")) {
        uint32_t offset = 0;
        ALP_TRY(
            alpi_collada_count(reader->document, input, "offset", 0, STRIDE_LIMIT - 1, &offset));
        if (++count > INPUT_LIMIT) {
            return alpi_collada_fail(reader->document, element, "has more than %d inputs",
                                     INPUT_LIMIT);
        }
        inputs->stride = offset + 1 > inputs->stride ? offset + 1 : inputs->stride;
        const char *semantic = alpi_xml_attribute(input, "semantic");
        const bool vertex = semantic != NULL && strcmp(semantic, "VERTEX") == 0;
        ALP_TRY(vertex ? add_vertices(reader, input, offset, inputs)
                       : add_input(reader, input, offset, inputs));
    }
    return ALP_OK;
}

// --- vertices ------------------------------------------------------------------------------------

typedef struct corner_table {
    uint32_t *slots; // [size] vertex, ALPI_NONE = free
    size_t size;
} corner_table;

static uint32_t find_vertex(alpi_collada_part *part, const corner_table *table,
                            const uint32_t key[ALPI_COLLADA_KEY_COUNT])
{
    const size_t bytes = sizeof part->vertices[0];
    uint64_t hash = ALPI_HASH_START;
    for (int k = 0; k < ALPI_COLLADA_KEY_COUNT; k++) {
        hash = (hash ^ key[k]) * 0x9e3779b97f4a7c15u; // 2^64 / golden ratio, Knuth
        hash ^= hash >> 29;
    }
    size_t slot = (size_t)hash & (table->size - 1);
    for (; table->slots[slot] != ALPI_NONE; slot = (slot + 1) & (table->size - 1)) {
        if (memcmp(part->vertices[table->slots[slot]], key, bytes) == 0) {
            return table->slots[slot];
        }
    }
    table->slots[slot] = part->vertex_count;
    memcpy(part->vertices[part->vertex_count], key, bytes);
    return part->vertex_count++;
}

/// Corners with the same indices are one vertex; triangles come to name vertices.
static alp_result join_corners(alp_context *context, const alpi_collada_faces *faces,
                               alpi_collada_part *part, corner_table *table)
{
    ALPI_TRY_NEW(context, part->vertices, faces->corner_count);
    ALPI_TRY_NEW(context, part->triangles, faces->triangle_count);
    table->size = 16;
    while (table->size < 2 * (size_t)faces->corner_count) {
        table->size *= 2;
    }
    ALPI_TRY_NEW(context, table->slots, table->size);
    memset(table->slots, 0xff, table->size * sizeof *table->slots);
    part->triangle_count = faces->triangle_count;
    for (uint32_t t = 0; t < faces->triangle_count; t++) {
        for (int c = 0; c < 3; c++) {
            const uint32_t *indices =
                faces->indices + (size_t)faces->triangles[t][c] * part->inputs.stride;
            uint32_t key[ALPI_COLLADA_KEY_COUNT];
            for (int k = 0; k < ALPI_COLLADA_KEY_COUNT; k++) {
                key[k] = part->inputs.source[k] == ALPI_NONE ? 0 : indices[part->inputs.offset[k]];
            }
            part->triangles[t][c] = find_vertex(part, table, key);
        }
    }
    return ALP_OK;
}

static void tell_oddities(const alpi_collada_reader *reader, const alpi_collada_part *part,
                          const alpi_collada_faces *faces)
{
    char owner[ALPI_COLLADA_OWNER_SIZE];
    if (part->inputs.bad != NULL) {
        const char *semantic = alpi_xml_attribute(part->inputs.bad, "semantic");
        alpi_collada_owner(reader->document, part->inputs.bad, owner);
        alpi_warn(reader->context, "bad-input", owner,
                  semantic != NULL
                      ? "its source is not there or cannot be read: the primitive has no %.20s"
                      : "its normals or colours are left out: indices lie outside of them%.0s",
                  semantic != NULL ? semantic : "");
    }
    if (faces->untidy + faces->dropped + part->inputs.uv_left_out == 0) {
        return;
    }
    alpi_collada_owner(reader->document, part->element, owner);
    if (faces->untidy > 0) {
        alpi_warn(reader->context, "crossed-faces", owner,
                  "polygons that cross themselves or have holes outside, so that their triangles "
                  "overlap: %u",
                  faces->untidy);
    }
    if (faces->dropped > 0) {
        alpi_warn(reader->context, "leftover-indices", owner,
                  "faces of fewer than three corners, or numbers left over, are ignored: %u",
                  faces->dropped);
    }
    if (part->inputs.uv_left_out > 0) {
        alpi_warn(reader->context, "uv-set", owner,
                  "texture coordinate sets left out, because %d are read: %u", ALPI_UV_SET_LIMIT,
                  part->inputs.uv_left_out);
    }
}

static alp_result read_part(alpi_collada_reader *reader, alpi_collada_part *part)
{
    ALP_TRY(alpi_collada_read_inputs(reader, part->element, &part->inputs));
    const xmlNode *p = alpi_xml_child(part->element, "p");
    if (part->inputs.source[ALPI_COLLADA_POSITION] == ALPI_NONE) {
        return p == NULL && alpi_xml_child(part->element, "ph") == NULL // empty: nothing to place
                   ? ALP_OK
                   : alpi_collada_fail(reader->document, part->element,
                                       "no input gives its positions (VERTEX)");
    }
    alpi_collada_faces faces;
    corner_table table = {0};
    ALP_TRY(alpi_collada_read_faces(reader, part->element, &part->inputs, &faces));
    alp_result result = join_corners(reader->context, &faces, part, &table);
    tell_oddities(reader, part, &faces);
    alpi_release(reader->context, table.slots);
    alpi_collada_faces_destroy(reader->context, &faces);
    return result;
}

/// A primitive that cannot be read keeps its place without a triangle.
static alp_result read_part_or_none(alpi_collada_reader *reader, alpi_collada_part *part, bool *bad)
{
    char reason[ALPI_COLLADA_REASON_SIZE];
    alp_result result = read_part(reader, part);
    if (alpi_collada_survives(reader->document, &result, reason)) {
        if (reader->bad_parts++ < ALPI_COLLADA_TOLD_LIMIT) {
            alpi_warn(reader->context, "bad-faces", reader->document->path,
                      "%s; the primitive is left out", reason);
        }
        part->inputs = (alpi_collada_inputs){.most_uv_number = ALPI_NONE};
        memset(part->inputs.source, 0xff, sizeof part->inputs.source); // none
        part->vertex_count = part->triangle_count = 0;
        *bad = true;
    }
    return result;
}

static alp_result read_parts(alpi_collada_reader *reader, alpi_collada_mesh *mesh,
                             const xmlNode *element)
{
    uint32_t count = 0;
    uint64_t triangles = 0;
    bool other = false; // lines, or a primitive that is told of
    for (const xmlNode *e = alpi_xml_child(element, NULL); e != NULL; e = alpi_xml_next(e, NULL)) {
        const bool lines = alpi_xml_is(e, "lines") || alpi_xml_is(e, "linestrips");
        count += alpi_collada_is_primitive(e);
        reader->not_triangles += lines;
        other |= lines;
    }
    ALPI_TRY_NEW(reader->context, mesh->parts, count);
    for (xmlNode *e = alpi_xml_child(element, NULL); e != NULL; e = alpi_xml_next(e, NULL)) {
        if (alpi_collada_is_primitive(e)) {
            alpi_collada_part *part = &mesh->parts[mesh->part_count];
            part->element = e;
            part->primitive = mesh->part_count++;
            part->symbol = alpi_xml_attribute(e, "material");
            ALP_TRY(read_part_or_none(reader, part, &other));
            triangles += part->triangle_count;
        }
    }
    if (triangles == 0 && !other) { // else that is told
        reader->first_empty = reader->empty++ == 0 ? mesh->geometry : reader->first_empty;
    }
    return ALP_OK;
}

alp_result alpi_collada_read_mesh(alpi_collada_reader *reader, xmlNode *geometry, uint32_t *mesh)
{
    uint32_t *slot = &reader->slots[alpi_xml_index(geometry)];
    *mesh = ALPI_NONE;
    if (*slot != 0 && *slot != ALPI_NONE) {
        *mesh = *slot - 1;
        return ALP_OK;
    }
    const xmlNode *element = *slot == 0 ? alpi_xml_child(geometry, "mesh") : NULL;
    if (element == NULL) {
        *slot = ALPI_NONE; // not looked for again
        reader->not_meshes++;
        return ALP_OK;
    }
    ALP_TRY(alpi_collada_grow(reader->context, &reader->meshes, &reader->mesh_capacity,
                              reader->mesh_count + 1, sizeof *reader->meshes));
    alpi_collada_mesh made = {.geometry = geometry,
                              .double_sided =
                                  alpi_collada_is_double_sided(geometry) ||
                                  alpi_collada_is_double_sided(alpi_xml_child(geometry, "mesh")),
                              .index = reader->mesh_count};
    alp_result result = read_parts(reader, &made, element);
    reader->meshes[reader->mesh_count++] = made; // released with the reader, also after a failure
    *slot = reader->mesh_count;
    *mesh = made.index;
    return result;
}
