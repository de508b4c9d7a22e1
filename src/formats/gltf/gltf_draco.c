// SPDX-License-Identifier: MIT
// KHR_draco_mesh_compression: primitives whose accessors have no bytes of their own. Where they do
// (a fallback for other readers), those are used and nothing is decoded.
#include "formats/gltf/gltf_compression.h"

#include "base/memory.h"
#include "formats/gltf/draco_mesh.h"
#include "formats/gltf/gltf_bytes.h"
#include "formats/gltf/gltf_tree.h"

#include <stdio.h>
#include <string.h>

/// Of one compressed primitive: glTF's 32-bit indices, three a triangle, bound it anyway.
enum { VERTEX_LIMIT = 1 << 27, FACE_LIMIT = 1 << 27, MODE_TRIANGLES = 4, MODE_STRIP = 5 };

bool alpi_draco_is_built(void)
{
#ifdef ALPI_HAS_DRACO
    return true;
#else
    return false;
#endif
}

/// A compressed primitive.
typedef struct packed {
    char owner[ALPI_GLTF_OWNER_SIZE];
    json_t *primitive, *extension;
    size_t view, indices, mode;
} packed;

/// Whether any accessor that the extension names has no bytes of its own.
static alp_result needs_decoding(const alpi_gltf_document *document, const packed *from,
                                 bool *needed)
{
    json_t *attributes = json_object_get(from->primitive, "attributes");
    size_t accessor;
    *needed =
        from->indices != ALPI_GLTF_NONE &&
        json_object_get(alpi_gltf_item(document, "accessors", from->indices), "bufferView") == NULL;
    const char *name;
    json_t *id;
    json_object_foreach(json_object_get(from->extension, "attributes"), name, id)
    {
        ALP_TRY(alpi_gltf_index(document, attributes, name, "accessors", from->owner, &accessor));
        *needed |=
            accessor != ALPI_GLTF_NONE &&
            json_object_get(alpi_gltf_item(document, "accessors", accessor), "bufferView") == NULL;
    }
    return ALP_OK;
}

static alp_result find_packed(const alpi_gltf_document *document, packed *from, bool *needed)
{
    ALP_TRY(alpi_gltf_index(document, from->primitive, "indices", "accessors", from->owner,
                            &from->indices));
    ALP_TRY(alpi_gltf_size_or(document, from->primitive, "mode", from->owner, MODE_TRIANGLES,
                              &from->mode));
    ALP_TRY(needs_decoding(document, from, needed));
    if (!*needed) {
        return ALP_OK;
    }
    if (!alpi_draco_is_built()) {
        return alpi_fail(document->context, ALP_ERROR_UNSUPPORTED,
                         "%s: %s: is compressed by " ALPI_GLTF_DRACO
                         ", which this build does not read; build with libdraco, or export "
                         "without compression",
                         document->path, from->owner);
    }
    if (from->mode != MODE_TRIANGLES && from->mode != MODE_STRIP) {
        return alpi_gltf_fail(document, from->owner,
                              "is compressed by " ALPI_GLTF_DRACO " with mode %zu; only 4 and 5 "
                              "can be",
                              from->mode);
    }
    return alpi_gltf_needed_index(document, from->extension, "bufferView", "bufferViews",
                                  from->owner, &from->view);
}

#ifdef ALPI_HAS_DRACO

/// Whether an accessor was decoded before, from the same place; from another it is an error.
static alp_result was_decoded(const alpi_gltf_document *document, const packed *from,
                              size_t accessor, size_t attribute, bool *was)
{
    const alpi_gltf_decoded *there = &document->decoded[accessor];
    *was = there->values.bytes != NULL;
    if (*was && (there->view != from->view || there->attribute != attribute)) {
        return alpi_gltf_fail(document, from->owner,
                              "accessor %zu comes out of bufferView %zu here and out of "
                              "bufferView %zu elsewhere",
                              accessor, from->view, there->view);
    }
    return ALP_OK;
}

/// What an accessor of a compressed primitive says of itself.
static alp_result read_shape(const alpi_gltf_document *document, size_t accessor,
                             alpi_gltf_values *values)
{
    static const uint32_t sizes[] = {1, 1, 2, 2, 0, 4, 4}; // 5120 … 5126
    static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    json_t *object = alpi_gltf_item(document, "accessors", accessor);
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "accessor %zu", accessor);
    size_t count, type;
    *values = (alpi_gltf_values){0};
    ALP_TRY(alpi_gltf_size(document, object, "count", owner, &count));
    ALP_TRY(alpi_gltf_size(document, object, "componentType", owner, &type));
    const char *shape = alpi_gltf_text(object, "type");
    for (uint32_t i = 1; shape != NULL && i <= 4; i++) {
        values->components = strcmp(shape, types[i]) == 0 ? i : values->components;
    }
    if (values->components == 0 || type < 5120 || type > 5126 || sizes[type - 5120] == 0) {
        return alpi_gltf_fail(document, owner,
                              "componentType %zu with type \"%.20s\" cannot be "
                              "decoded",
                              type, shape != NULL ? shape : "");
    }
    if (count > 3 * (size_t)FACE_LIMIT) {
        return alpi_fail(document->context, ALP_ERROR_LIMIT,
                         "%s: %s: %zu elements out of a compressed primitive, more than the limit "
                         "of %zu",
                         document->path, owner, count, 3 * (size_t)FACE_LIMIT);
    }
    values->count = (uint32_t)count;
    values->component_type = (uint32_t)type;
    values->component_size = sizes[type - 5120];
    return ALP_OK;
}

/// Memory for what an accessor decodes to; it belongs to the document at once.
static alp_result make_place(alpi_gltf_document *document, const packed *from, size_t accessor,
                             size_t attribute, const alpi_gltf_values *values)
{
    size_t size = (size_t)values->components * values->component_size;
    ALP_TRY(alpi_gltf_count_decoded(document, from->owner, (uint64_t)values->count * size));
    alpi_gltf_decoded *place = &document->decoded[accessor];
    *place = (alpi_gltf_decoded){*values, from->view, attribute};
    place->values.bytes = alpi_allocate(document->context, values->count, size);
    return place->values.bytes == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

static alp_result take_indices(alpi_gltf_document *document, const packed *from,
                               const alpi_draco_mesh *mesh)
{
    bool was;
    if (from->indices == ALPI_GLTF_NONE) {
        return alpi_gltf_fail(document, from->owner, "is compressed, but has no indices");
    }
    ALP_TRY(was_decoded(document, from, from->indices, ALPI_GLTF_NONE, &was));
    if (was) {
        return ALP_OK;
    }
    alpi_gltf_values values;
    ALP_TRY(read_shape(document, from->indices, &values));
    if (values.components != 1 || (values.component_type != 5121 && values.component_type != 5123 &&
                                   values.component_type != 5125)) {
        return alpi_gltf_fail(document, from->owner,
                              "its indices (accessor %zu) are not unsigned integer scalars",
                              from->indices);
    }
    uint32_t faces = alpi_draco_face_count(mesh);
    uint32_t(*corners)[3] = alpi_allocate(document->context, faces, sizeof *corners);
    if (corners == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alpi_draco_faces(mesh, corners);
    values.count = 3 * faces;
    alp_result result = make_place(document, from, from->indices, ALPI_GLTF_NONE, &values);
    uint8_t *bytes = document->decoded[from->indices].values.bytes;
    for (size_t i = 0; result == ALP_OK && i < values.count; i++) {
        memcpy(bytes + i * values.component_size, &corners[i / 3][i % 3], // little-endian
               values.component_size);
    }
    alpi_release(document->context, corners);
    return result;
}

static alp_result take_attribute(alpi_gltf_document *document, const packed *from,
                                 const alpi_draco_mesh *mesh, const char *name)
{
    size_t accessor, number;
    bool was;
    json_t *ids = json_object_get(from->extension, "attributes");
    ALP_TRY(alpi_gltf_index(document, json_object_get(from->primitive, "attributes"), name,
                            "accessors", from->owner, &accessor));
    if (accessor == ALPI_GLTF_NONE) {
        return ALP_OK; // nobody asks for it
    }
    ALP_TRY(alpi_gltf_size(document, ids, name, from->owner, &number));
    ALP_TRY(was_decoded(document, from, accessor, number, &was));
    if (was) {
        return ALP_OK;
    }
    alpi_gltf_values values;
    ALP_TRY(read_shape(document, accessor, &values));
    if (values.count != alpi_draco_vertex_count(mesh)) {
        return alpi_gltf_fail(document, from->owner,
                              "%.40s (accessor %zu) has %u elements, bufferView %zu decodes to %u "
                              "vertices",
                              name, accessor, values.count, from->view,
                              alpi_draco_vertex_count(mesh));
    }
    values.normalized = json_is_true(
        json_object_get(alpi_gltf_item(document, "accessors", accessor), "normalized"));
    ALP_TRY(make_place(document, from, accessor, number, &values));
    if (number > UINT32_MAX ||
        !alpi_draco_attribute(mesh, (uint32_t)number, values.components, values.component_type,
                              document->decoded[accessor].values.bytes)) {
        return alpi_gltf_fail(document, from->owner,
                              "bufferView %zu holds no attribute %zu like accessor %zu (%.40s)",
                              from->view, number, accessor, name);
    }
    return ALP_OK;
}

static alp_result take_all(alpi_gltf_document *document, const packed *from,
                           const alpi_draco_mesh *mesh)
{
    ALP_TRY(take_indices(document, from, mesh));
    const char *name;
    json_t *id;
    json_object_foreach(json_object_get(from->extension, "attributes"), name, id)
    {
        ALP_TRY(take_attribute(document, from, mesh, name));
    }
    return ALP_OK;
}

/// How many vertices and triangles the asset says there are.
static alp_result read_counts(const alpi_gltf_document *document, const packed *from,
                              alpi_draco_source *source)
{
    size_t position;
    alpi_gltf_values values;
    ALP_TRY(alpi_gltf_needed_index(document, json_object_get(from->primitive, "attributes"),
                                   "POSITION", "accessors", from->owner, &position));
    ALP_TRY(read_shape(document, position, &values));
    source->vertex_count = values.count;
    source->face_limit = FACE_LIMIT;
    if (from->indices != ALPI_GLTF_NONE) {
        ALP_TRY(read_shape(document, from->indices, &values));
        source->face_count = from->mode == MODE_TRIANGLES ? values.count / 3 : 0;
        source->face_limit = values.count; // a strip of n indices has n − 2 triangles
    }
    if (source->vertex_count > VERTEX_LIMIT) {
        return alpi_fail(document->context, ALP_ERROR_LIMIT,
                         "%s: %s: %u compressed vertices, more than the limit of %d",
                         document->path, from->owner, source->vertex_count, VERTEX_LIMIT);
    }
    return ALP_OK;
}

static alp_result decode_packed(alpi_gltf_document *document, const packed *from)
{
    alpi_gltf_view view;
    char fault[200] = "";
    ALP_TRY(alpi_gltf_view_read(document, from->view, &view));
    alpi_draco_source source = {.bytes = view.bytes, .size = view.size};
    ALP_TRY(read_counts(document, from, &source));
    alpi_draco_mesh *mesh = NULL;
    alpi_draco_result opened = alpi_draco_open(&source, &mesh, fault, sizeof fault);
    if (opened == ALPI_DRACO_OUT_OF_MEMORY) {
        return alpi_fail(document->context, ALP_ERROR_OUT_OF_MEMORY,
                         "%s: %s: no memory to decompress bufferView %zu", document->path,
                         from->owner, from->view);
    }
    if (opened != ALPI_DRACO_OK) {
        return alpi_gltf_fail(document, from->owner,
                              "the %zu compressed bytes of bufferView %zu cannot be decoded: %s "
                              "(%u vertices and %u triangles are stated)",
                              view.size, from->view, fault, source.vertex_count, source.face_count);
    }
    alp_result result = take_all(document, from, mesh);
    alpi_draco_close(mesh);
    return result;
}

#else

static alp_result decode_packed(alpi_gltf_document *document, const packed *from)
{
    (void)document, (void)from; // find_packed refused it
    return ALP_OK;
}

#endif

static alp_result decode_primitive(alpi_gltf_document *document, size_t mesh, size_t index,
                                   json_t *primitive)
{
    packed from = {.primitive = primitive,
                   .extension = alpi_gltf_extension(primitive, ALPI_GLTF_DRACO),
                   .view = ALPI_GLTF_NONE};
    bool needed = false;
    if (from.extension == NULL) {
        return ALP_OK;
    }
    snprintf(from.owner, sizeof from.owner, "mesh %zu, primitive %zu", mesh, index);
    ALP_TRY(find_packed(document, &from, &needed));
    if (!needed) {
        return ALP_OK;
    }
    if (document->decoded == NULL) {
        size_t count = alpi_gltf_count(document, "accessors");
        ALPI_TRY_NEW(document->context, document->decoded, count);
        document->decoded_count = count;
    }
    return decode_packed(document, &from);
}

alp_result alpi_gltf_decode_primitives(alpi_gltf_document *document)
{
    size_t count = alpi_gltf_count(document, "meshes");
    for (size_t m = 0; m < count; m++) {
        json_t *primitives = json_object_get(alpi_gltf_item(document, "meshes", m), "primitives");
        for (size_t i = 0; i < json_array_size(primitives); i++) {
            ALP_TRY(decode_primitive(document, m, i, json_array_get(primitives, i)));
        }
    }
    return ALP_OK;
}
