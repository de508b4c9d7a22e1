// SPDX-License-Identifier: MIT
// Edits of meshes, and a primitive while it is rewritten: its text and its attributes.
#ifndef ALPI_FORMATS_GLTF_PATCH_MESH_H
#define ALPI_FORMATS_GLTF_PATCH_MESH_H

#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_patch.h"
#include "formats/gltf/write/gltf_split.h"

/// Edits the meshes of the plan and the nodes that use copies.
alp_result alpi_patcher_meshes(alpi_gltf_patcher *patcher);

/// An attribute whose accessor changes.
typedef struct alpi_gltf_attribute_edit {
    alpi_json_span span; // of the index
    size_t accessor;
} alpi_gltf_attribute_edit;

/// One primitive of the document and what becomes of it.
typedef struct alpi_gltf_rewrite {
    const alpi_gltf_plan *plan;
    const alpi_surface *surface;
    json_t *primitive;
    alpi_json_span span, attributes;
    char owner[ALPI_GLTF_OWNER_SIZE];
    uint32_t vertex_count;
    uint32_t (*indices)[3]; // of the file
    uint32_t triangle_count;
    uint32_t width;
    float *corner_values; // [triangle_count][3][width] in the file's order
    alpi_gltf_split split;
    bool parted;     // vertices were split
    bool compressed; // some of its accessors are, and none of them may stay so
    bool has_draco;  // its extension, that is
    // Attributes that are added; none: kept coordinates.
    uint32_t added_count;
    char added_names[ALPI_GLTF_BLEND_SETS][ALPI_GLTF_ATTRIBUTE_SIZE];
    size_t added_accessors[ALPI_GLTF_BLEND_SETS];
    alpi_gltf_attribute_edit *attribute_edits;
    size_t attribute_count, attribute_capacity;
} alpi_gltf_rewrite;

/// An index of an accessor in the text, read as the parser reads numbers.
size_t alpi_patcher_read_index(const alpi_gltf_patcher *patcher, alpi_json_span span);

/// What the split asks of the attributes in an object: their values at the new vertices.
alp_result alpi_patcher_split_attributes(alpi_gltf_patcher *patcher, alpi_gltf_rewrite *rewrite,
                                         alpi_json_span object);
/// The same of morph targets.
alp_result alpi_patcher_split_targets(alpi_gltf_patcher *patcher, alpi_gltf_rewrite *rewrite);

#endif
