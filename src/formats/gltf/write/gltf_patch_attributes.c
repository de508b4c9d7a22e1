// SPDX-License-Identifier: MIT
// Attributes of a primitive whose vertices are split: their values at the new ones, raw.

#include "base/memory.h"
#include "formats/gltf/gltf_accessor.h"
#include "formats/gltf/gltf_bytes.h"
#include "formats/gltf/gltf_compression.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_appends.h"
#include "formats/gltf/write/gltf_patch_mesh.h"
#include "formats/gltf/write/gltf_patch_sets.h"

#include <stdio.h>
#include <string.h>

size_t alpi_patcher_read_index(const alpi_gltf_patcher *p, alpi_json_span span)
{
    json_t *number =
        json_loadb(p->document->text + span.begin, span.end - span.begin, JSON_DECODE_ANY, NULL);
    double value = json_number_value(number);
    bool fits = json_is_number(number) && value >= 0.0 &&
                value < (double)p->lists[ALPI_GLTF_ACCESSORS].count;
    json_decref(number);
    return fits ? (size_t)value : ALPI_GLTF_NONE;
}

/// Bytes of a matrix element: columns begin at multiples of 4 (glTF 2.0, section 3.6.2.4).
static size_t matrix_size(const char *type, uint32_t component_type)
{
    size_t side = type[3] >= '2' && type[3] <= '4' ? (size_t)(type[3] - '0') : 0;
    size_t component = component_type <= 5121 ? 1 : component_type <= 5123 ? 2 : 4;
    return side * ((side * component + 3) / 4 * 4);
}

/// A matrix for each vertex: only attributes of somebody's own ("_NAME") can be that. `packed` is
/// released by the caller.
static alp_result read_matrices(alpi_gltf_patcher *p, size_t accessor, alpi_gltf_array *array,
                                uint8_t **packed)
{
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "accessor %zu", accessor);
    json_t *object = alpi_gltf_item(p->document, "accessors", accessor);
    size_t index, offset, count, component;
    ALP_TRY(
        alpi_gltf_needed_index(p->document, object, "bufferView", "bufferViews", owner, &index));
    ALP_TRY(alpi_gltf_size_or(p->document, object, "byteOffset", owner, 0, &offset));
    ALP_TRY(alpi_gltf_size(p->document, object, "count", owner, &count));
    ALP_TRY(alpi_gltf_size(p->document, object, "componentType", owner, &component));
    alpi_gltf_view view;
    ALP_TRY(alpi_gltf_view_read(p->document, index, &view));
    array->type = alpi_gltf_text(object, "type");
    array->component_type = (uint32_t)component;
    size_t size = matrix_size(array->type, array->component_type);
    size_t stride = view.stride != 0 ? view.stride : size;
    if (size == 0 || stride < size || count == 0 || count > UINT32_MAX || offset > view.size ||
        view.size - offset < size || (view.size - offset - size) / stride < count - 1 ||
        json_object_get(object, "sparse") != NULL) {
        return alpi_gltf_fail(p->document, owner, "its matrices do not fit into bufferView %zu",
                              index);
    }
    ALPI_TRY_NEW(p->context, *packed, count * size);
    for (size_t i = 0; i < count; i++) {
        memcpy(*packed + i * size, view.bytes + offset + i * stride, size);
    }
    array->count = (uint32_t)count;
    array->element_size = size;
    array->normalized = json_is_true(json_object_get(object, "normalized"));
    return ALP_OK;
}

static alp_result read_attribute(alpi_gltf_patcher *p, size_t accessor, alpi_gltf_array *array,
                                 uint8_t **packed)
{
    const char *type = alpi_gltf_text(alpi_gltf_item(p->document, "accessors", accessor), "type");
    if (type != NULL && strncmp(type, "MAT", 3) == 0) {
        return read_matrices(p, accessor, array, packed);
    }
    alpi_gltf_values values;
    ALP_TRY(alpi_gltf_accessor_read(p->document, accessor, &values));
    *packed = values.bytes;
    array->count = values.count;
    array->components = values.components;
    array->component_type = values.component_type;
    array->element_size = (size_t)values.components * values.component_size;
    array->normalized = values.normalized;
    return ALP_OK;
}

/// The attribute's values at the split vertices, raw.
static alp_result gather(alpi_gltf_patcher *p, const alpi_gltf_rewrite *r, size_t accessor,
                         alpi_gltf_array *array, const uint8_t *packed, size_t *written)
{
    if (array->count != r->vertex_count) {
        return alpi_gltf_fail(p->document, r->owner, "accessor %zu has %u elements for %u vertices",
                              accessor, array->count, r->vertex_count);
    }
    size_t size = array->element_size;
    uint8_t *gathered = alpi_allocate(p->context, r->split.vertex_count, size);
    if (gathered == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t v = 0; v < r->split.vertex_count; v++) {
        memcpy(gathered + v * size, packed + r->split.sources[v] * size, size);
    }
    array->count = r->split.vertex_count;
    array->bytes = gathered;
    alp_result result = alpi_patcher_add_accessor(p, array, written);
    alpi_release(p->context, gathered);
    return result;
}

/// What an earlier bake made stays known as that.
static const char *known_mark(const char *mark)
{
    static const char *const marks[] = {ALPI_GLTF_SET, ALPI_GLTF_VALUES};
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        if (mark != NULL && strcmp(mark, marks[i]) == 0) {
            return marks[i];
        }
    }
    return NULL;
}

static alp_result split_attribute(alpi_gltf_patcher *p, alpi_gltf_rewrite *r, alpi_json_span span,
                                  bool is_position)
{
    size_t accessor = alpi_patcher_read_index(p, span);
    if (accessor == ALPI_GLTF_NONE) {
        return alpi_gltf_fail(p->document, r->owner, "an attribute names no accessor");
    }
    json_t *object = alpi_gltf_item(p->document, "accessors", accessor);
    const char *mark = alpi_gltf_mark(p->document, "accessors", accessor);
    alpi_gltf_array array = {.has_bounds = is_position || json_object_get(object, "min") != NULL,
                             .mark = known_mark(mark)};
    uint8_t *packed = NULL;
    ALP_TRY(read_attribute(p, accessor, &array, &packed));
    alpi_gltf_attribute_edit edit = {.span = span};
    alp_result result = gather(p, r, accessor, &array, packed, &edit.accessor);
    alpi_release(p->context, packed);
    ALP_TRY(result);
    void *items = r->attribute_edits;
    ALP_TRY(
        alpi_grow(p->context, &items, &r->attribute_capacity, r->attribute_count + 1, sizeof edit));
    r->attribute_edits = items;
    r->attribute_edits[r->attribute_count++] = edit;
    return ALP_OK;
}

alp_result alpi_patcher_split_attributes(alpi_gltf_patcher *p, alpi_gltf_rewrite *r,
                                         alpi_json_span object)
{
    const char *text = p->document->text;
    alpi_json_cursor cursor = alpi_json_open(text, object);
    while (alpi_json_next(&cursor)) {
        bool replaced = false;
        for (uint32_t k = 0; k < r->added_count && object.begin == r->attributes.begin; k++) {
            replaced |= alpi_json_key_is(text, cursor.key, r->added_names[k]);
        }
        replaced |= alpi_patcher_is_dropped(text, cursor.key, r->plan->dropped);
        bool stays = !r->parted && !alpi_gltf_accessor_is_compressed(
                                       p->document, alpi_patcher_read_index(p, cursor.value));
        if (!replaced && !stays) {
            ALP_TRY(split_attribute(p, r, cursor.value,
                                    alpi_json_key_is(text, cursor.key, "POSITION")));
        }
    }
    return ALP_OK;
}

alp_result alpi_patcher_split_targets(alpi_gltf_patcher *p, alpi_gltf_rewrite *r)
{
    alpi_json_span targets;
    if (!alpi_json_find(p->document->text, r->span, "targets", &targets)) {
        return ALP_OK;
    }
    alpi_json_cursor cursor = alpi_json_open(p->document->text, targets);
    while (alpi_json_next(&cursor)) {
        ALP_TRY(alpi_patcher_split_attributes(p, r, cursor.value));
    }
    return ALP_OK;
}
