// SPDX-License-Identifier: MIT
// Primitives and nodes that are read in another way than the file states: a message for each kind.
#include "formats/gltf/gltf_read.h"

#include "formats/gltf/gltf_tree.h"

#include <stdio.h>

static void warn_of_empty(const alpi_gltf_reader *reader, const alpi_gltf_oddities *odd)
{
    if (odd->empty > 0) {
        char owner[ALPI_GLTF_OWNER_SIZE];
        snprintf(owner, sizeof owner, "mesh %u, primitive %u", odd->first_empty[0],
                 odd->first_empty[1]);
        alpi_warn(reader->context, "empty-geometry", owner,
                  "primitives without a triangle are left out, this one first: %u", odd->empty);
    }
}

void alpi_gltf_tell_oddities(const alpi_gltf_reader *reader, const alpi_gltf_oddities *odd)
{
    alp_context *context = reader->context;
    const char *path = reader->document->path;
    warn_of_empty(reader, odd);
    if (odd->not_triangles > 0) {
        alpi_note(context, "not-triangles", path, "primitives of points or lines left out: %u",
                  odd->not_triangles);
    }
    if (odd->without_position > 0) {
        alpi_note(context, "no-positions", path, "primitives without POSITION left out: %u",
                  odd->without_position);
    }
    if (odd->without_material > 0) {
        alpi_note(context, "no-material", path,
                  "primitives without a material, read as a grey of albedo 0.5: %u",
                  odd->without_material);
    }
    if (odd->hidden > 0) {
        alpi_note(context, "hidden", path,
                  "hidden nodes with meshes (KHR_node_visibility), which neither cast shadows nor "
                  "get a map, and stay in the file: %u",
                  odd->hidden);
    }
    if (odd->skinned > 0) {
        alpi_note(context, "skin", path, "skinned nodes, read in the pose of their joints: %u",
                  odd->skinned);
    }
    if (odd->morphed > 0) {
        alpi_note(context, "morph", path,
                  "primitives with morph targets, read with their default weights: %u",
                  odd->morphed);
    }
    if (odd->instanced > 0) {
        alpi_note(context, "instancing", path,
                  "nodes with instances of their mesh (EXT_mesh_gpu_instancing): %u, with %zu in "
                  "all",
                  odd->instanced, odd->placement_count);
    }
}
