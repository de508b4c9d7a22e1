// SPDX-License-Identifier: MIT
// EXT_meshopt_compression: buffer views that hold vertices or indices as meshoptimizer packs them.
// The decoders are libmeshoptimizer's; what they take for granted is checked here.
//
// Kapoulkine. EXT_meshopt_compression. Khronos glTF extension, 2020.
#include "formats/gltf/gltf_compression.h"

#include "base/memory.h"
#include "formats/gltf/gltf_tree.h"

#include <meshoptimizer.h>

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/// What the extension says of one view.
typedef struct packed {
    char owner[ALPI_GLTF_OWNER_SIZE];
    const uint8_t *bytes;
    size_t size, stride, count;
    const char *mode, *filter;
} packed;

alp_result alpi_gltf_count_decoded(alpi_gltf_document *document, const char *owner, uint64_t size)
{
    document->decoded_size += size;
    if (size > ALPI_GLTF_DECODED_LIMIT || document->decoded_size > ALPI_GLTF_DECODED_LIMIT) {
        return alpi_fail(document->context, ALP_ERROR_LIMIT,
                         "%s: %s: decodes to %" PRIu64 " bytes, and all that is compressed may "
                         "come to %" PRIu64,
                         document->path, owner, size, ALPI_GLTF_DECODED_LIMIT);
    }
    return ALP_OK;
}

bool alpi_gltf_accessor_is_compressed(const alpi_gltf_document *document, size_t accessor)
{
    if (accessor < document->decoded_count && document->decoded[accessor].values.bytes != NULL) {
        return true;
    }
    json_t *view = json_object_get(alpi_gltf_item(document, "accessors", accessor), "bufferView");
    double index = json_is_number(view) ? json_number_value(view) : -1.0;
    return index >= 0.0 && index < (double)document->decoded_view_count &&
           document->decoded_views[(size_t)index] != NULL;
}

static alp_result read_source(const alpi_gltf_document *document, json_t *extension, packed *from)
{
    size_t buffer, offset;
    ALP_TRY(alpi_gltf_needed_index(document, extension, "buffer", "buffers", from->owner, &buffer));
    ALP_TRY(alpi_gltf_size_or(document, extension, "byteOffset", from->owner, 0, &offset));
    ALP_TRY(alpi_gltf_size(document, extension, "byteLength", from->owner, &from->size));
    ALP_TRY(alpi_gltf_size(document, extension, "byteStride", from->owner, &from->stride));
    ALP_TRY(alpi_gltf_size(document, extension, "count", from->owner, &from->count));
    const alpi_gltf_buffer *source = &document->buffers[buffer];
    if (source->bytes == NULL) {
        return alpi_gltf_fail(document, from->owner,
                              "its compressed bytes lie in buffer %zu, which is a fallback for "
                              "other readers",
                              buffer);
    }
    if (offset > source->size || from->size > source->size - offset) {
        return alpi_gltf_fail(document, from->owner,
                              "its compressed bytes, byteOffset %zu + byteLength %zu, pass the end "
                              "of buffer %zu (%zu bytes)",
                              offset, from->size, buffer, source->size);
    }
    from->bytes = source->bytes + offset;
    from->mode = alpi_gltf_text(extension, "mode");
    from->mode = from->mode != NULL ? from->mode : "";
    from->filter = alpi_gltf_text(extension, "filter");
    from->filter = from->filter != NULL ? from->filter : "NONE";
    return ALP_OK;
}

/// The strides that mode and filter allow.
static bool stride_fits(const packed *from)
{
    const size_t stride = from->stride;
    if (strcmp(from->mode, "ATTRIBUTES") != 0) {
        return stride == 2 || stride == 4;
    }
    bool fits = stride > 0 && stride <= 256 && stride % 4 == 0;
    return strcmp(from->filter, "OCTAHEDRAL") == 0   ? stride == 4 || stride == 8
           : strcmp(from->filter, "QUATERNION") == 0 ? stride == 8
                                                     : fits;
}

static bool is_one_of(const char *name, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (strcmp(name, names[i]) == 0) {
            return true;
        }
    }
    return false;
}

/// The fewest bytes that `count` elements can be packed into: in groups of 16 bytes with 2 bits a
/// group, one byte a triangle, one byte an index. So a short file cannot ask for much memory.
static size_t least_size(const packed *from)
{
    const size_t blocks = from->count / 256; // a whole block of one byte is 16 groups: 4 bytes
    return strcmp(from->mode, "ATTRIBUTES") == 0  ? 1 + from->stride * (blocks * 4 + 1)
           : strcmp(from->mode, "TRIANGLES") == 0 ? 1 + from->count / 3
                                                  : 1 + from->count;
}

static alp_result check_packed(const alpi_gltf_document *document, json_t *view, const packed *from)
{
    static const char *const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
    static const char *const filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
    size_t length, stride, decoded;
    ALP_TRY(alpi_gltf_size(document, view, "byteLength", from->owner, &length));
    ALP_TRY(alpi_gltf_size_or(document, view, "byteStride", from->owner, from->stride, &stride));
    if (!is_one_of(from->mode, modes, 3) || !is_one_of(from->filter, filters, 4)) {
        return alpi_gltf_fail(document, from->owner,
                              "mode \"%.20s\" with filter \"%.20s\" is none "
                              "that " ALPI_GLTF_MESHOPT " knows",
                              from->mode, from->filter);
    }
    if (!stride_fits(from) || stride != from->stride) {
        return alpi_gltf_fail(document, from->owner,
                              "byteStride %zu (compressed: %zu) does not go with mode %s, filter "
                              "%s",
                              stride, from->stride, from->mode, from->filter);
    }
    if (__builtin_mul_overflow(from->count, from->stride, &decoded) || decoded != length) {
        return alpi_gltf_fail(document, from->owner,
                              "byteLength is %zu, but its %zu compressed elements have %zu bytes "
                              "each",
                              length, from->count, from->stride);
    }
    if (strcmp(from->mode, "TRIANGLES") == 0 && from->count % 3 != 0) {
        return alpi_gltf_fail(document, from->owner, "%zu compressed indices make no triangles",
                              from->count);
    }
    if (from->count > 0 && from->size < least_size(from)) {
        return alpi_gltf_fail(document, from->owner,
                              "%zu compressed bytes cannot hold %zu elements of %zu bytes",
                              from->size, from->count, from->stride);
    }
    return ALP_OK;
}

static int unpack(const packed *from, uint8_t *bytes)
{
    if (strcmp(from->mode, "TRIANGLES") == 0) {
        return meshopt_decodeIndexBuffer(bytes, from->count, from->stride, from->bytes, from->size);
    }
    if (strcmp(from->mode, "INDICES") == 0) {
        return meshopt_decodeIndexSequence(bytes, from->count, from->stride, from->bytes,
                                           from->size);
    }
    int fault =
        meshopt_decodeVertexBuffer(bytes, from->count, from->stride, from->bytes, from->size);
    if (fault != 0 || strcmp(from->filter, "NONE") == 0) {
        return fault;
    }
    if (strcmp(from->filter, "OCTAHEDRAL") == 0) {
        meshopt_decodeFilterOct(bytes, from->count, from->stride);
    } else if (strcmp(from->filter, "QUATERNION") == 0) {
        meshopt_decodeFilterQuat(bytes, from->count, from->stride);
    } else {
        meshopt_decodeFilterExp(bytes, from->count, from->stride);
    }
    return 0;
}

static alp_result decode_view(alpi_gltf_document *document, size_t index, json_t *extension)
{
    packed from;
    snprintf(from.owner, sizeof from.owner, "bufferView %zu", index);
    ALP_TRY(read_source(document, extension, &from));
    ALP_TRY(check_packed(document, alpi_gltf_item(document, "bufferViews", index), &from));
    ALP_TRY(alpi_gltf_count_decoded(document, from.owner, (uint64_t)from.count * from.stride));
    uint8_t *bytes = alpi_allocate(document->context, from.count, from.stride);
    if (bytes == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    document->decoded_views[index] = bytes;
    if (from.count > 0 && unpack(&from, bytes) != 0) {
        return alpi_gltf_fail(document, from.owner,
                              "its %zu compressed bytes (%s) are damaged, or of a version that is "
                              "not read",
                              from.size, from.mode);
    }
    return ALP_OK;
}

alp_result alpi_gltf_decode_views(alpi_gltf_document *document)
{
    size_t count = alpi_gltf_count(document, "bufferViews");
    for (size_t i = 0; i < count; i++) {
        json_t *view = alpi_gltf_item(document, "bufferViews", i);
        json_t *extension = alpi_gltf_extension(view, ALPI_GLTF_MESHOPT);
        if (extension == NULL) {
            continue;
        }
        if (document->decoded_views == NULL) {
            ALPI_TRY_NEW(document->context, document->decoded_views, count);
            document->decoded_view_count = count;
        }
        ALP_TRY(decode_view(document, i, extension));
    }
    return ALP_OK;
}
