// SPDX-License-Identifier: MIT
// Elements that a document gains: they are appended to root arrays, so that every index that was
// there before still means the same.
#ifndef ALPI_FORMATS_GLTF_APPENDS_H
#define ALPI_FORMATS_GLTF_APPENDS_H

#include "formats/gltf/write/gltf_patch.h"

/// Appends an element to a root array and gives its index in the written file.
size_t alpi_patcher_append(alpi_gltf_patcher *patcher, alpi_gltf_kind kind, const void *text,
                           size_t size);

/// New binary data as a bufferView. @param target 34962 vertices, 34963 indices, 0 none
/// @param stride 0 = packed
size_t alpi_patcher_add_view(alpi_gltf_patcher *patcher, const void *bytes, size_t size,
                             size_t stride, uint32_t target);

/// Values for a new accessor, packed as in alpi_gltf_values.
typedef struct alpi_gltf_array {
    const void *bytes;
    uint32_t count, components, component_type;
    size_t element_size;
    bool normalized, has_bounds, is_indices;
    const char *type; // NULL: SCALAR … VEC4 by components
    const char *mark; // NULL: ALPI_GLTF_COPY
} alpi_gltf_array;
/// A new accessor, or an equal one made before.
alp_result alpi_patcher_add_accessor(alpi_gltf_patcher *patcher, const alpi_gltf_array *array,
                                     size_t *accessor);
/// The image of a PNG that the bake made, at its place `uri` of page_uris; its index.
size_t alpi_patcher_add_image(alpi_gltf_patcher *patcher, const char *name, uint32_t uri,
                              const uint8_t *png, size_t size);
/// A texture of an image that the bake made, read between texels and not repeated.
size_t alpi_patcher_add_texture(alpi_gltf_patcher *patcher, size_t image);

#endif
