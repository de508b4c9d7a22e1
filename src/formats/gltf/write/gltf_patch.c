// SPDX-License-Identifier: MIT
// The patcher: what a document gains. Elements are appended to root arrays, so that every index
// that was there before still means the same.
#include "formats/gltf/write/gltf_patch.h"

#include "base/hash.h"
#include "base/memory.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const kind_names[ALPI_GLTF_KIND_COUNT] = {[ALPI_GLTF_ACCESSORS] = "accessors",
                                                             [ALPI_GLTF_BUFFERS] = "buffers",
                                                             [ALPI_GLTF_BUFFER_VIEWS] =
                                                                 "bufferViews",
                                                             [ALPI_GLTF_IMAGES] = "images",
                                                             [ALPI_GLTF_MATERIALS] = "materials",
                                                             [ALPI_GLTF_MESHES] = "meshes",
                                                             [ALPI_GLTF_NODES] = "nodes",
                                                             [ALPI_GLTF_SAMPLERS] = "samplers",
                                                             [ALPI_GLTF_TEXTURES] = "textures"};

/// An accessor that the patcher made.
struct alpi_gltf_known {
    uint64_t hash;
    size_t accessor;
    alpi_gltf_array array; // without bytes
    size_t data_begin;     // inside the new data
    size_t stride;
};

// --- life ----------------------------------------------------------------------------------------

static alp_result find_elements(alpi_gltf_patcher *p, alpi_gltf_kind kind)
{
    alpi_gltf_list *list = &p->lists[kind];
    list->text = alpi_bytes_create(p->context);
    list->count = alpi_gltf_count(p->document, kind_names[kind]);
    ALPI_TRY_NEW(p->context, list->spans, list->count);
    alpi_json_span array = {0};
    alpi_json_find(p->document->text, p->root, kind_names[kind], &array);
    alpi_json_cursor cursor = alpi_json_open(p->document->text, array);
    size_t found = 0;
    while (found < list->count && alpi_json_next(&cursor)) {
        list->spans[found++] = cursor.value;
    }
    return found == list->count
               ? ALP_OK
               : alpi_fail(p->context, ALP_ERROR_INVALID_DATA,
                           "%s: %s: its text holds %zu elements, its tree %zu", p->document->path,
                           kind_names[kind], found, list->count);
}

static alp_result fill_patcher(alpi_gltf_patcher *p)
{
    const alpi_gltf_document *document = p->document;
    p->edits = alpi_edits_create(p->context, document->text);
    p->data = alpi_bytes_create(p->context);
    if (!alpi_json_value(document->text, 0, document->text_size, &p->root)) {
        return alpi_fail(p->context, ALP_ERROR_INVALID_DATA, "%s: the JSON is empty",
                         document->path);
    }
    for (int kind = 0; kind < ALPI_GLTF_KIND_COUNT; kind++) {
        ALP_TRY(find_elements(p, (alpi_gltf_kind)kind));
    }
    ALPI_TRY_NEW(p->context, p->page_textures, p->patch->page_count);
    ALPI_TRY_NEW(p->context, p->light_textures, p->patch->page_count);
    for (uint32_t i = 0; i < p->patch->page_count; i++) {
        p->page_textures[i] = p->light_textures[i] = ALPI_GLTF_NONE;
    }
    ALPI_TRY_NEW(p->context, p->packed_images, p->patch->packed_count);
    memset(p->packed_images, 0xff, p->patch->packed_count * sizeof *p->packed_images); // all NONE
    size_t textures = p->lists[ALPI_GLTF_TEXTURES].count;
    ALPI_TRY_NEW(p->context, p->texture_copies, textures);
    memset(p->texture_copies, 0xff, textures * sizeof *p->texture_copies);
    return ALP_OK;
}

alp_result alpi_patcher_create(const alp_scene *scene, const alpi_mesh_patch *patch,
                               const alpi_gltf_document *document, alpi_gltf_patcher *patcher)
{
    *patcher = (alpi_gltf_patcher){.context = scene->context,
                                   .scene = scene,
                                   .patch = patch,
                                   .document = document,
                                   .exported = document !=
                                               scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data};
    alp_result result = fill_patcher(patcher);
    if (result != ALP_OK) {
        alpi_patcher_destroy(patcher);
    }
    return result;
}

void alpi_patcher_destroy(alpi_gltf_patcher *p)
{
    for (int kind = 0; kind < ALPI_GLTF_KIND_COUNT; kind++) {
        alpi_release(p->context, p->lists[kind].spans);
        if (p->lists[kind].text.context != NULL) {
            alpi_bytes_destroy(&p->lists[kind].text);
        }
    }
    alpi_edits_destroy(&p->edits);
    alpi_bytes_destroy(&p->data);
    alpi_release(p->context, p->known);
    alpi_release(p->context, p->known_table);
    alpi_release(p->context, p->triangle_pages);
    alpi_release(p->context, p->plans);
    alpi_release(p->context, p->showings);
    alpi_release(p->context, p->pieces);
    alpi_release(p->context, p->instance_counts);
    alpi_release(p->context, p->instance_firsts);
    alpi_release(p->context, p->instances);
    alpi_release(p->context, p->page_textures);
    alpi_release(p->context, p->light_textures);
    alpi_release(p->context, p->packed_images);
    alpi_release(p->context, p->texture_copies);
    alpi_release(p->context, p->image_embedded);
    *p = (alpi_gltf_patcher){
        .context = p->context, .edits = {.context = p->context}, .data = {.context = p->context}};
}

// --- elements, views, accessors ------------------------------------------------------------------

size_t alpi_patcher_append(alpi_gltf_patcher *patcher, alpi_gltf_kind kind, const void *text,
                           size_t size)
{
    alpi_gltf_list *list = &patcher->lists[kind];
    if (list->added > 0) {
        alpi_bytes_add(&list->text, ",", 1);
    }
    alpi_bytes_add(&list->text, text, size);
    return list->count + list->added++;
}

size_t alpi_patcher_add_view(alpi_gltf_patcher *p, const void *bytes, size_t size, size_t stride,
                             uint32_t target)
{
    alpi_bytes_align(&p->data, '\0');
    size_t offset = p->data_base + p->data.size;
    alpi_bytes_add(&p->data, bytes, size);
    char text[256], stride_text[48] = "", target_text[32] = "";
    if (stride != 0) {
        snprintf(stride_text, sizeof stride_text, ",\"byteStride\":%zu", stride);
    }
    if (target != 0) {
        snprintf(target_text, sizeof target_text, ",\"target\":%u", target);
    }
    int length =
        snprintf(text, sizeof text, "{\"buffer\":%zu,\"byteOffset\":%zu,\"byteLength\":%zu%s%s}",
                 p->data_buffer, offset, size, stride_text, target_text);
    return alpi_patcher_append(p, ALPI_GLTF_BUFFER_VIEWS, text, (size_t)length);
}

/// Component as the number that min and max state (normalised integers as they are stored).
static double stored_number(const alpi_gltf_array *array, uint32_t element, uint32_t component)
{
    size_t size = array->element_size / array->components;
    const uint8_t *bytes =
        (const uint8_t *)array->bytes + element * array->element_size + component * size;
    uint32_t raw = 0;
    float real;
    memcpy(&raw, bytes, size); // little-endian, as the whole format
    memcpy(&real, &raw, sizeof real);
    switch (array->component_type) {
    case 5120:
        return (int8_t)raw;
    case 5122:
        return (int16_t)raw;
    case 5126:
        return (double)real;
    default:
        return raw;
    }
}

static void print_bounds(const alpi_gltf_array *array, alpi_bytes *text)
{
    double low[4], high[4];
    for (uint32_t k = 0; k < array->components; k++) {
        low[k] = DBL_MAX;
        high[k] = -DBL_MAX;
        for (uint32_t i = 0; i < array->count; i++) {
            double value = stored_number(array, i, k);
            if (isfinite(value)) {
                low[k] = fmin(low[k], value);
                high[k] = fmax(high[k], value);
            }
        }
        if (low[k] > high[k]) {
            low[k] = high[k] = 0.0;
        }
    }
    for (int side = 0; side < 2; side++) {
        alpi_bytes_print(text, side == 0 ? ",\"min\":[" : ",\"max\":[");
        for (uint32_t k = 0; k < array->components; k++) {
            alpi_bytes_print(text, "%s", k > 0 ? "," : "");
            alpi_bytes_number(text, side == 0 ? low[k] : high[k],
                              array->component_type == 5126 ? 9 : 17);
        }
        alpi_bytes_print(text, "]");
    }
}

static bool same_array(const alpi_gltf_patcher *p, const struct alpi_gltf_known *known,
                       const alpi_gltf_array *array)
{
    const alpi_gltf_array *old = &known->array;
    if (old->count != array->count || old->component_type != array->component_type ||
        old->element_size != array->element_size || old->normalized != array->normalized ||
        old->has_bounds != array->has_bounds || old->is_indices != array->is_indices ||
        strcmp(old->type, array->type) != 0 || strcmp(old->mark, array->mark) != 0) {
        return false;
    }
    const uint8_t *stored = p->data.bytes + known->data_begin, *bytes = array->bytes;
    for (uint32_t i = 0; i < array->count; i++) {
        if (memcmp(stored + i * known->stride, bytes + i * array->element_size,
                   array->element_size) != 0) {
            return false;
        }
    }
    return true;
}

static uint64_t hash_array(const alpi_gltf_array *array)
{
    return alpi_hash_bytes(ALPI_HASH_START, array->bytes, array->count * array->element_size);
}

static alp_result grow_known_table(alpi_gltf_patcher *p)
{
    if (p->known_table_size >= 2 * (p->known_count + 1)) {
        return ALP_OK;
    }
    size_t size = p->known_table_size == 0 ? 64 : 2 * p->known_table_size;
    alpi_release(p->context, p->known_table);
    p->known_table_size = 0;
    ALPI_TRY_NEW(p->context, p->known_table, size);
    p->known_table_size = size;
    memset(p->known_table, 0xff, size * sizeof *p->known_table);
    for (size_t i = 0; i < p->known_count; i++) {
        size_t slot = (size_t)p->known[i].hash & (size - 1);
        while (p->known_table[slot] != ALPI_NONE) {
            slot = (slot + 1) & (size - 1);
        }
        p->known_table[slot] = (uint32_t)i;
    }
    return ALP_OK;
}

/// Writes the array's bytes and its accessor; vertex elements begin at multiples of 4.
static size_t append_accessor(alpi_gltf_patcher *p, const alpi_gltf_array *array, size_t stride)
{
    size_t view;
    if (stride == array->element_size) {
        view = alpi_patcher_add_view(p, array->bytes, stride * array->count, 0,
                                     array->is_indices ? 34963 : 34962);
    } else {
        alpi_bytes padded = alpi_bytes_create(p->context);
        for (uint32_t i = 0; i < array->count; i++) {
            alpi_bytes_add(&padded, (const uint8_t *)array->bytes + i * array->element_size,
                           array->element_size);
            alpi_bytes_align(&padded, '\0');
        }
        p->data.failed |= padded.failed;
        view = alpi_patcher_add_view(p, padded.bytes, padded.size, stride, 34962);
        alpi_bytes_destroy(&padded);
    }
    alpi_bytes text = alpi_bytes_create(p->context);
    alpi_bytes_print(&text, "{\"bufferView\":%zu,\"componentType\":%u%s,\"count\":%u", view,
                     array->component_type, array->normalized ? ",\"normalized\":true" : "",
                     array->count);
    alpi_bytes_print(&text, ",\"type\":\"%s\"", array->type);
    if (array->has_bounds && array->components > 0) {
        print_bounds(array, &text);
    }
    alpi_bytes_print(&text, ",\"extras\":{\"alpenglow\":\"%s\"}}", array->mark);
    p->data.failed |= text.failed;
    size_t accessor = alpi_patcher_append(p, ALPI_GLTF_ACCESSORS, text.bytes, text.size);
    alpi_bytes_destroy(&text);
    return accessor;
}

alp_result alpi_patcher_add_accessor(alpi_gltf_patcher *p, const alpi_gltf_array *array,
                                     size_t *accessor)
{
    static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    alpi_gltf_array own = *array;
    own.type = own.type != NULL ? own.type : types[own.components];
    own.mark = own.mark != NULL ? own.mark : ALPI_GLTF_COPY;
    ALP_TRY(grow_known_table(p));
    uint64_t hash = hash_array(&own);
    size_t slot = (size_t)hash & (p->known_table_size - 1);
    for (; p->known_table[slot] != ALPI_NONE; slot = (slot + 1) & (p->known_table_size - 1)) {
        const struct alpi_gltf_known *known = &p->known[p->known_table[slot]];
        if (known->hash == hash && same_array(p, known, &own)) {
            *accessor = known->accessor;
            return ALP_OK;
        }
    }
    void *items = p->known;
    ALP_TRY(
        alpi_grow(p->context, &items, &p->known_capacity, p->known_count + 1, sizeof *p->known));
    p->known = items;
    size_t stride = own.is_indices ? own.element_size : (own.element_size + 3) / 4 * 4;
    *accessor = append_accessor(p, &own, stride);
    if (p->data.failed) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    own.bytes = NULL;
    p->known_table[slot] = (uint32_t)p->known_count;
    p->known[p->known_count++] =
        (struct alpi_gltf_known){.hash = hash,
                                 .accessor = *accessor,
                                 .array = own,
                                 .data_begin = p->data.size - stride * own.count,
                                 .stride = stride};
    return ALP_OK;
}

// --- the whole sequence --------------------------------------------------------------------------

/// asset.extras.alpenglow; extras that are no object are somebody else's and stay.
static void state_origin(alpi_gltf_patcher *p)
{
    const char *text = p->document->text, *json = p->patch->extras_json;
    alpi_json_span asset, extras, old;
    if (json == NULL || !alpi_json_find(text, p->root, "asset", &asset)) {
        return;
    }
    if (!alpi_json_find(text, asset, "extras", &extras)) {
        alpi_bytes value = alpi_bytes_create(p->context);
        alpi_bytes_print(&value, "{\"alpenglow\":%s}", json);
        p->data.failed |= value.failed;
        alpi_edits_add(&p->edits, asset, "extras", value.bytes, value.size);
        alpi_bytes_destroy(&value);
    } else if (text[extras.begin] != '{') {
        alpi_note(p->context, "extras", p->document->path,
                  "asset.extras is not an object and stays unchanged: the file does not state "
                  "how it was baked");
    } else if (alpi_json_find(text, extras, "alpenglow", &old)) {
        alpi_edits_replace(&p->edits, old, "%s", json);
    } else {
        alpi_edits_add(&p->edits, extras, "alpenglow", json, strlen(json));
    }
}

alp_result alpi_patcher_run(alpi_gltf_patcher *patcher)
{
    ALP_TRY(alpi_patcher_find_instances(patcher));
    ALP_TRY(alpi_patcher_plan(patcher));
    if (patcher->patch->vertex_values == NULL) {
        ALP_TRY(alpi_patcher_materials(patcher));
    } else {
        alpi_patcher_warn_of_former(patcher);
    }
    ALP_TRY(alpi_patcher_meshes(patcher));
    ALP_TRY(alpi_patcher_expand_instances(patcher));
    alpi_patcher_state_extensions(patcher);
    state_origin(patcher);
    return patcher->data.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

alp_result alpi_patcher_finish(alpi_gltf_patcher *p, alpi_bytes *text)
{
    for (int kind = 0; kind < ALPI_GLTF_KIND_COUNT; kind++) {
        alpi_gltf_list *list = &p->lists[kind];
        if (list->text.failed) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        alpi_json_span array;
        if (list->added == 0) {
            continue;
        }
        if (alpi_json_find(p->document->text, p->root, kind_names[kind], &array)) {
            alpi_edits_add(&p->edits, array, NULL, list->text.bytes, list->text.size);
        } else {
            alpi_bytes value = alpi_bytes_create(p->context);
            alpi_bytes_add(&value, "[", 1);
            alpi_bytes_add(&value, list->text.bytes, list->text.size);
            alpi_bytes_add(&value, "]", 1);
            p->data.failed |= value.failed;
            alpi_edits_add(&p->edits, p->root, kind_names[kind], value.bytes, value.size);
            alpi_bytes_destroy(&value);
        }
    }
    if (p->data.failed) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    return alpi_edits_apply(&p->edits, (alpi_json_span){0, p->document->text_size}, text);
}
