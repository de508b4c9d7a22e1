// SPDX-License-Identifier: MIT
// What a bake adds to a scene's meshes, in terms of the scene's triangles; a format's writer turns
// it into vertex splits, texture coordinate sets, images and materials of its own kind.
#ifndef ALPI_SCENE_MESH_PATCH_H
#define ALPI_SCENE_MESH_PATCH_H

#include "scene/scene.h"

typedef enum alpi_existing_ao {
    ALPI_EXISTING_AO_REPLACE = 0, // the material's occlusionTexture is replaced by ours
    ALPI_EXISTING_AO_KEEP,        // a material that has one keeps it; ours goes to the others
} alpi_existing_ao; // "multiply" is done in the map before it gets here, then it is REPLACE

typedef enum alpi_vertex_attribute {
    ALPI_VERTEX_COLOR = 0, // the first colour set: times what is there
    ALPI_VERTEX_OCCLUSION, // an attribute of its own
} alpi_vertex_attribute;

typedef struct alpi_mesh_patch {
    /// Accessibility at the scene's vertices, in [0, 1]: then there are no pages, no coordinates
    /// and no change of materials. NULL: maps.
    const float *vertex_values; // [vertex_count]
    alpi_vertex_attribute vertex_attribute;
    uint32_t page_count;
    /// Bake coordinates of each triangle's corners, in the winding of scene.triangles.
    /// NULL: the meshes' own set `kept_uv_set` is used and no vertex changes.
    const float (*corner_uvs)[3][2]; // [triangle_count]
    uint32_t kept_uv_set;
    /// [triangle_count] page of each; NULL = all on page 0. A surface whose triangles have
    /// ALPI_NONE gets no map and stays as it is.
    const uint32_t *triangle_pages;
    /// [surface_count] the surface whose coordinates and pages each one has too, itself where it
    /// has its own (see alpi_scene_instances); NULL = all their own. Such surfaces go on sharing a
    /// mesh.
    const uint32_t *originals;
    /// Occlusion map of each page, ready to embed.
    const uint8_t *const *page_pngs; // [page_count]
    const size_t *page_png_sizes;    // [page_count]
    alpi_existing_ao existing_ao;
    float occlusion_strength; // 1
    /// A JSON object (text) that becomes asset.extras.alpenglow.
    const char *extras_json;
} alpi_mesh_patch;

#endif
