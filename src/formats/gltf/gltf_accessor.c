// SPDX-License-Identifier: MIT
// Accessors: typed arrays cut out of buffer views, with strides, sparse values and normalised
// integers (glTF 2.0, section 3.6.2). Everything is checked against the bytes that are there before
// memory is asked for.
#include "formats/gltf/gltf_accessor.h"

#include "base/memory.h"
#include "formats/gltf/gltf_bytes.h"
#include "formats/gltf/gltf_tree.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// An accessor without a buffer view is all zeros: nothing in the file bounds its size, so we do.
enum { ZEROS_LIMIT = 1 << 24 };

enum {
    COMPONENT_I8 = 5120,
    COMPONENT_U8 = 5121,
    COMPONENT_I16 = 5122,
    COMPONENT_U16 = 5123,
    COMPONENT_U32 = 5125,
    COMPONENT_FLOAT = 5126
};

static uint32_t component_size(size_t type)
{
    switch (type) {
    case COMPONENT_I8:
    case COMPONENT_U8:
        return 1;
    case COMPONENT_I16:
    case COMPONENT_U16:
        return 2;
    case COMPONENT_U32:
    case COMPONENT_FLOAT:
        return 4;
    default:
        return 0;
    }
}

static uint32_t component_count(const char *type)
{
    static const char *const names[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    for (uint32_t i = 0; type != NULL && i < 4; i++) {
        if (strcmp(type, names[i]) == 0) {
            return i + 1;
        }
    }
    return 0;
}

static bool is_index_type(size_t type)
{
    return type == COMPONENT_U8 || type == COMPONENT_U16 || type == COMPONENT_U32;
}

/// `count` elements of `size` bytes, `stride` apart, in a buffer view from `offset` on.
typedef struct byte_run {
    const uint8_t *bytes;
    size_t stride;
} byte_run;

static alp_result find_run(const alpi_gltf_document *document, json_t *object, const char *owner,
                           size_t count, size_t size, byte_run *run)
{
    size_t index, offset;
    ALP_TRY(alpi_gltf_needed_index(document, object, "bufferView", "bufferViews", owner, &index));
    ALP_TRY(alpi_gltf_size_or(document, object, "byteOffset", owner, 0, &offset));
    alpi_gltf_view view;
    ALP_TRY(alpi_gltf_view_read(document, index, &view));
    size_t stride = view.stride == 0 ? size : view.stride, needed;
    if (stride < size) {
        return alpi_gltf_fail(document, owner,
                              "bufferView %zu has byteStride %zu, less than an element (%zu bytes)",
                              index, stride, size);
    }
    if (count > 0 && (__builtin_mul_overflow(count - 1, stride, &needed) ||
                      __builtin_add_overflow(needed, size, &needed) ||
                      __builtin_add_overflow(needed, offset, &needed) || needed > view.size)) {
        return alpi_gltf_fail(document, owner,
                              "%zu elements of %zu bytes from byteOffset %zu do not fit into "
                              "bufferView %zu (%zu bytes)",
                              count, size, offset, index, view.size);
    }
    run->bytes = count > 0 ? view.bytes + offset : view.bytes;
    run->stride = stride;
    return ALP_OK;
}

/// Everything about an accessor, checked: what `values` will hold and where it comes from.
typedef struct layout {
    alpi_gltf_values values; // without bytes
    size_t element_size;
    byte_run base; // bytes NULL = zeros
    size_t sparse_count;
    uint32_t sparse_index_size;
    byte_run sparse_indices, sparse_values;
} layout;

static alp_result find_sparse(const alpi_gltf_document *document, json_t *accessor,
                              const char *owner, layout *found)
{
    json_t *sparse = json_object_get(accessor, "sparse");
    if (sparse == NULL) {
        return ALP_OK;
    }
    size_t type;
    json_t *indices = json_object_get(sparse, "indices");
    json_t *values = json_object_get(sparse, "values");
    ALP_TRY(alpi_gltf_size(document, sparse, "count", owner, &found->sparse_count));
    if (found->sparse_count > found->values.count) {
        return alpi_gltf_fail(document, owner, "%zu sparse values for %u elements",
                              found->sparse_count, found->values.count);
    }
    ALP_TRY(alpi_gltf_size(document, indices, "componentType", owner, &type));
    if (!is_index_type(type)) {
        return alpi_gltf_fail(document, owner,
                              "its sparse indices have componentType %zu, not an unsigned integer",
                              type);
    }
    found->sparse_index_size = component_size(type);
    ALP_TRY(find_run(document, indices, owner, found->sparse_count, found->sparse_index_size,
                     &found->sparse_indices));
    return find_run(document, values, owner, found->sparse_count, found->element_size,
                    &found->sparse_values);
}

static alp_result find_layout(const alpi_gltf_document *document, size_t index, const char *owner,
                              layout *found)
{
    json_t *accessor = alpi_gltf_item(document, "accessors", index);
    *found = (layout){0};
    size_t type, count;
    ALP_TRY(alpi_gltf_size(document, accessor, "componentType", owner, &type));
    ALP_TRY(alpi_gltf_size(document, accessor, "count", owner, &count));
    const char *shape = alpi_gltf_text(accessor, "type");
    found->values.components = component_count(shape);
    found->values.component_size = component_size(type);
    if (found->values.component_size == 0) {
        return alpi_gltf_fail(document, owner, "componentType %zu is not defined by glTF", type);
    }
    if (found->values.components == 0) {
        return alpi_gltf_fail(document, owner, "type \"%.20s\" where a scalar or vector is needed",
                              shape != NULL ? shape : "");
    }
    if (count > UINT32_MAX - 1) {
        return alpi_gltf_fail(document, owner, "%zu elements are too many", count);
    }
    found->values.count = (uint32_t)count;
    found->values.component_type = (uint32_t)type;
    found->values.normalized = json_is_true(json_object_get(accessor, "normalized")) &&
                               type != COMPONENT_FLOAT && type != COMPONENT_U32;
    found->element_size = found->values.components * (size_t)found->values.component_size;
    if (index < document->decoded_count && document->decoded[index].values.bytes != NULL) {
        found->values.count = document->decoded[index].values.count; // a strip comes as triangles
        found->base = (byte_run){document->decoded[index].values.bytes, found->element_size};
    } else if (json_object_get(accessor, "bufferView") != NULL) {
        ALP_TRY(find_run(document, accessor, owner, count, found->element_size, &found->base));
    } else if (count > ZEROS_LIMIT) {
        return alpi_fail(document->context, ALP_ERROR_LIMIT,
                         "%s: %s: %zu elements without a bufferView, more than the limit of %d",
                         document->path, owner, count, ZEROS_LIMIT);
    }
    return find_sparse(document, accessor, owner, found);
}

/// Little-endian unsigned integer of 1, 2 or 4 bytes.
static uint32_t load_unsigned(const uint8_t *bytes, uint32_t size)
{
    uint32_t value = bytes[0];
    for (uint32_t i = 1; i < size; i++) {
        value |= (uint32_t)bytes[i] << (8 * i);
    }
    return value;
}

static void copy_run(const byte_run *run, size_t count, size_t size, uint8_t *bytes)
{
    if (run->stride == size && count > 0) {
        memcpy(bytes, run->bytes, count * size);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        memcpy(bytes + i * size, run->bytes + i * run->stride, size);
    }
}

static alp_result put_sparse(const alpi_gltf_document *document, const char *owner,
                             const layout *found, uint8_t *bytes)
{
    for (size_t i = 0; i < found->sparse_count; i++) {
        uint32_t element =
            load_unsigned(found->sparse_indices.bytes + i * found->sparse_indices.stride,
                          found->sparse_index_size);
        if (element >= found->values.count) {
            return alpi_gltf_fail(document, owner, "sparse index %zu is %u of %u elements", i,
                                  element, found->values.count);
        }
        memcpy(bytes + element * found->element_size,
               found->sparse_values.bytes + i * found->sparse_values.stride, found->element_size);
    }
    return ALP_OK;
}

alp_result alpi_gltf_accessor_check(const alpi_gltf_document *document, size_t accessor,
                                    alpi_gltf_values *values)
{
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "accessor %zu", accessor);
    layout found;
    alp_result result = find_layout(document, accessor, owner, &found);
    *values = found.values;
    return result;
}

alp_result alpi_gltf_accessor_matrices(const alpi_gltf_document *document, size_t accessor,
                                       uint32_t count, double (*matrices)[16])
{
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "accessor %zu", accessor);
    json_t *object = alpi_gltf_item(document, "accessors", accessor);
    const char *shape = alpi_gltf_text(object, "type");
    size_t type, stated;
    byte_run run;
    ALP_TRY(alpi_gltf_size(document, object, "componentType", owner, &type));
    ALP_TRY(alpi_gltf_size(document, object, "count", owner, &stated));
    if (shape == NULL || strcmp(shape, "MAT4") != 0 || type != COMPONENT_FLOAT || stated < count ||
        json_object_get(object, "sparse") != NULL) {
        return alpi_gltf_fail(document, owner,
                              "%zu elements of type %.20s where %u MAT4 of floats "
                              "are needed",
                              stated, shape != NULL ? shape : "none", count);
    }
    ALP_TRY(find_run(document, object, owner, count, 16 * sizeof(float), &run));
    for (size_t i = 0; i < count; i++) {
        float values[16];
        memcpy(values, run.bytes + i * run.stride, sizeof values);
        for (int k = 0; k < 16; k++) {
            matrices[i][k] = (double)values[k];
        }
    }
    return ALP_OK;
}

alp_result alpi_gltf_accessor_read(const alpi_gltf_document *document, size_t accessor,
                                   alpi_gltf_values *values)
{
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "accessor %zu", accessor);
    *values = (alpi_gltf_values){0};
    layout found;
    ALP_TRY(find_layout(document, accessor, owner, &found));
    uint8_t *bytes = alpi_allocate(document->context, found.values.count, found.element_size);
    if (bytes == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    if (found.base.bytes != NULL) {
        copy_run(&found.base, found.values.count, found.element_size, bytes);
    }
    alp_result result = put_sparse(document, owner, &found, bytes);
    if (result != ALP_OK) {
        alpi_release(document->context, bytes);
        return result;
    }
    *values = found.values;
    values->bytes = bytes;
    return ALP_OK;
}

float alpi_gltf_values_float(const alpi_gltf_values *values, uint32_t element, uint32_t component)
{
    size_t size = values->component_size;
    const uint8_t *bytes =
        values->bytes + ((size_t)element * values->components + component) * size;
    uint32_t raw = load_unsigned(bytes, values->component_size);
    bool normalized = values->normalized;
    // Normalised signed values: max(c / 127, −1), glTF 2.0 section 3.6.2.2.
    switch (values->component_type) {
    case COMPONENT_I8: {
        float value = (float)(int8_t)raw;
        return normalized ? fmaxf(value / 127.0f, -1.0f) : value;
    }
    case COMPONENT_U8:
        return normalized ? (float)raw / 255.0f : (float)raw;
    case COMPONENT_I16: {
        float value = (float)(int16_t)raw;
        return normalized ? fmaxf(value / 32767.0f, -1.0f) : value;
    }
    case COMPONENT_U16:
        return normalized ? (float)raw / 65535.0f : (float)raw;
    case COMPONENT_U32:
        return (float)raw;
    default: {
        float value;
        memcpy(&value, &raw, sizeof value);
        return value;
    }
    }
}

uint32_t alpi_gltf_values_index(const alpi_gltf_values *values, uint32_t element)
{
    size_t offset = (size_t)element * values->components * values->component_size;
    return load_unsigned(values->bytes + offset, values->component_size);
}
