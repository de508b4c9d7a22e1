// SPDX-License-Identifier: MIT
// Nodes that show their mesh in instances.
#ifndef ALPI_FORMATS_GLTF_PATCH_INSTANCES_H
#define ALPI_FORMATS_GLTF_PATCH_INSTANCES_H

#include "formats/gltf/write/gltf_patch.h"

/// Counts the instances of the scene's nodes; before the plan.
alp_result alpi_patcher_find_instances(alpi_gltf_patcher *patcher);
/// The node that shows a surface: of the document, or an instance.
size_t alpi_patcher_node_of(const alpi_gltf_patcher *patcher, uint32_t surface);
/// The node of the document that it is, or is an instance of.
size_t alpi_patcher_file_node(const alpi_gltf_patcher *patcher, size_t node);
/// Makes it show another mesh.
void alpi_patcher_show(alpi_gltf_patcher *patcher, size_t node, size_t mesh);
/// Makes nodes of instances that differ; after the meshes.
alp_result alpi_patcher_expand_instances(alpi_gltf_patcher *patcher);

#endif
