// SPDX-License-Identifier: MIT
// Geometry → meshes in the file's own space: sources, inputs, and the different corners of each
// primitive as vertices.
#include "formats/collada/collada_read.h"

#include "base/hash.h"
#include "base/memory.h"
#include "formats/collada/collada_numbers.h"

#include <string.h>

enum { STRIDE_LIMIT = 256, INPUT_LIMIT = 64 };

// --- sources -------------------------------------------------------------------------------------

/// Which numbers of an element are its components: those whose <param> has a name.
static void read_params(const xmlNode *accessor, alpi_collada_source *source)
{
    uint32_t place = 0;
    const xmlNode *param = alpi_xml_child(accessor, "param");
    for (; param != NULL; param = alpi_xml_next(param, "param"), place++) {
        const char *name = alpi_xml_attribute(param, "name");
        if (name != NULL && name[0] != '\0' && source->components < 4 && place < source->stride) {
            source->place[source->components++] = place;
        }
    }
    while (source->components == 0 || (place == 0 && source->components < source->stride &&
                                       source->components < 4)) { // no names at all: in order
        source->place[source->components] = source->components;
        source->components++;
    }
}

static alp_result read_accessor(const alpi_collada_reader *reader, const xmlNode *element,
                                alpi_collada_source *source, xmlNode **array)
{
    static const char *const way[] = {"technique_common", "accessor", NULL};
    const alpi_collada_document *document = reader->document;
    const xmlNode *accessor = alpi_xml_descend(element, way);
    *array = NULL;
    if (accessor == NULL) {
        return alpi_collada_fail(document, element, "has no <technique_common> with <accessor>");
    }
    ALP_TRY(alpi_collada_count(document, accessor, "stride", 1, 1 << 20, &source->stride));
    ALP_TRY(alpi_collada_count(document, accessor, "offset", 0, ALPI_NONE - 1, &source->first));
    ALP_TRY(alpi_collada_count(document, accessor, "count", 0, ALPI_NONE - 1, &source->count));
    if (source->stride == 0) {
        return alpi_collada_fail(document, accessor, "its stride is 0");
    }
    read_params(accessor, source);
    const char *url = alpi_xml_attribute(accessor, "source");
    if (url == NULL || alpi_collada_find(document, url[0] == '#' ? url + 1 : url) == NULL) {
        *array = alpi_xml_child(element, "float_array"); // as some exporters leave it
        if (*array != NULL) {
            return ALP_OK;
        }
    }
    return alpi_collada_resolve(document, accessor, "source", "float_array", array);
}

/// Elements that the array really holds; one that is short leaves the last ones out.
static void limit_count(alpi_collada_source *source, size_t value_count)
{
    uint32_t last = 0;
    for (uint32_t k = 0; k < source->components; k++) {
        last = source->place[k] > last ? source->place[k] : last;
    }
    const size_t needed = (size_t)source->first + last + 1;
    const size_t held = value_count < needed ? 0 : (value_count - needed) / source->stride + 1;
    source->count = held < source->count ? (uint32_t)held : source->count;
}

/// A <float_array>, read at its first use: many sources may name one.
static alp_result read_array(alpi_collada_reader *reader, xmlNode *element,
                             const alpi_collada_array **array)
{
    uint32_t *slot = &reader->slots[alpi_xml_index(element)];
    if (*slot == 0) {
        ALP_TRY(alpi_collada_grow(reader->context, &reader->arrays, &reader->array_capacity,
                                  reader->array_count + 1, sizeof *reader->arrays));
        alpi_collada_array *made = &reader->arrays[reader->array_count++];
        *made = (alpi_collada_array){.element =
                                         element}; // released with the reader, also after a failure
        ALP_TRY(alpi_collada_floats(reader->document, element, &made->values, &made->count));
        *slot = reader->array_count;
    }
    *array = &reader->arrays[*slot - 1];
    return ALP_OK;
}

alp_result alpi_collada_exact_values(alpi_collada_reader *reader, const alpi_collada_source *source,
                                     const double **values)
{
    alpi_collada_array *array = &reader->arrays[source->array];
    if (array->exact == NULL) {
        ALP_TRY(alpi_collada_exact(reader->document, array->element, &array->exact, &array->count));
    }
    *values = array->exact;
    return ALP_OK;
}

/// A <source>, read at its first use.
static alp_result read_source(alpi_collada_reader *reader, xmlNode *element, uint32_t *index)
{
    uint32_t *slot = &reader->slots[alpi_xml_index(element)];
    if (*slot != 0) {
        *index = *slot - 1;
        return ALP_OK;
    }
    ALP_TRY(alpi_collada_grow(reader->context, &reader->sources, &reader->source_capacity,
                              reader->source_count + 1, sizeof *reader->sources));
    alpi_collada_source *source = &reader->sources[reader->source_count];
    *source = (alpi_collada_source){0};
    xmlNode *array = NULL;
    ALP_TRY(read_accessor(reader, element, source, &array));
    if (array == NULL) {
        return alpi_collada_fail(reader->document, element, "has no <float_array>");
    }
    const alpi_collada_array *values = NULL;
    ALP_TRY(read_array(reader, array, &values));
    *index = reader->source_count++;
    source->array = (uint32_t)(values - reader->arrays);
    source->values = values->values; // stays where it is when the list of arrays grows
    const uint32_t stated = source->count;
    limit_count(source, values->count);
    if (source->count < stated) {
        char owner[ALPI_COLLADA_OWNER_SIZE];
        alpi_collada_owner(reader->document, element, owner);
        alpi_warn(reader->context, "short-array", owner,
                  "its array holds %u of the %u elements that the accessor states", source->count,
                  stated);
    }
    *slot = *index + 1;
    return ALP_OK;
}

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

/// An <input> that names a <source>.
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
    xmlNode *element = NULL;
    uint32_t source = 0, set = 0;
    ALP_TRY(alpi_collada_resolve(reader->document, input, "source", "source", &element));
    if (element == NULL) {
        return alpi_collada_fail(reader->document, input, "its source lies in another document");
    }
    ALP_TRY(read_source(reader, element, &source));
    ALP_TRY(alpi_collada_count(reader->document, input, "set", 0, 1 << 20, &set));
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
    if (faces->untidy + faces->dropped + part->inputs.uv_left_out == 0) {
        return;
    }
    alpi_collada_owner(reader->document, part->element, owner);
    if (faces->untidy > 0) {
        alpi_warn(reader->context, "crossed-faces", owner,
                  "%u polygons cross themselves or have holes outside: their triangles overlap",
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

static alp_result read_parts(alpi_collada_reader *reader, alpi_collada_mesh *mesh,
                             const xmlNode *element)
{
    uint32_t count = 0;
    for (const xmlNode *e = alpi_xml_child(element, NULL); e != NULL; e = alpi_xml_next(e, NULL)) {
        count += alpi_collada_is_primitive(e);
        reader->not_triangles += alpi_xml_is(e, "lines") || alpi_xml_is(e, "linestrips");
    }
    ALPI_TRY_NEW(reader->context, mesh->parts, count);
    for (xmlNode *e = alpi_xml_child(element, NULL); e != NULL; e = alpi_xml_next(e, NULL)) {
        if (alpi_collada_is_primitive(e)) {
            alpi_collada_part *part = &mesh->parts[mesh->part_count];
            part->element = e;
            part->primitive = mesh->part_count++;
            part->symbol = alpi_xml_attribute(e, "material");
            ALP_TRY(read_part(reader, part));
        }
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
    alpi_collada_mesh made = {.geometry = geometry, .index = reader->mesh_count};
    alp_result result = read_parts(reader, &made, element);
    reader->meshes[reader->mesh_count++] = made; // released with the reader, also after a failure
    *slot = reader->mesh_count;
    *mesh = made.index;
    return result;
}
