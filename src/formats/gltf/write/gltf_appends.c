// SPDX-License-Identifier: MIT
#include "formats/gltf/write/gltf_appends.h"

#include "base/hash.h"
#include "base/memory.h"
#include "formats/gltf/gltf_tree.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/// An accessor that the patcher made.
struct alpi_gltf_known {
    uint64_t hash;
    size_t accessor;
    alpi_gltf_array array; // without bytes
    size_t data_begin;     // inside the new data
    size_t stride;
};

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

// --- images and textures -------------------------------------------------------------------------

size_t alpi_patcher_add_image(alpi_gltf_patcher *p, const char *name, uint32_t uri,
                              const uint8_t *png, size_t size)
{
    alpi_bytes image = alpi_bytes_create(p->context);
    alpi_bytes_print(&image, "{\"name\":\"%s\",", name);
    if (p->page_uris != NULL) {
        alpi_bytes_print(&image, "\"uri\":");
        alpi_bytes_quote(&image, p->page_uris[uri]);
        alpi_bytes_print(&image, "," ALPI_GLTF_MAP_EXTRAS "}");
    } else {
        size_t view = alpi_patcher_add_view(p, png, size, 0, 0);
        alpi_bytes_print(&image,
                         "\"bufferView\":%zu,\"mimeType\":\"image/png\"," ALPI_GLTF_MAP_EXTRAS "}",
                         view);
    }
    p->data.failed |= image.failed;
    size_t index = alpi_patcher_append(p, ALPI_GLTF_IMAGES, image.bytes, image.size);
    alpi_bytes_destroy(&image);
    return index;
}

/// Not mipmapped: charts are padded by few texels.
size_t alpi_patcher_add_texture(alpi_gltf_patcher *p, size_t image)
{
    alpi_gltf_list *samplers = &p->lists[ALPI_GLTF_SAMPLERS];
    static const char sampler[] =
        "{\"magFilter\":9729,\"minFilter\":9729,"                    // linear
        "\"wrapS\":33071,\"wrapT\":33071," ALPI_GLTF_MAP_EXTRAS "}"; // clamp to edge
    if (samplers->added == 0) {
        alpi_patcher_append(p, ALPI_GLTF_SAMPLERS, sampler, sizeof sampler - 1);
    }
    char texture[128];
    int length = snprintf(texture, sizeof texture,
                          "{\"sampler\":%zu,\"source\":%zu," ALPI_GLTF_MAP_EXTRAS "}",
                          samplers->count, image);
    return alpi_patcher_append(p, ALPI_GLTF_TEXTURES, texture, (size_t)length);
}
