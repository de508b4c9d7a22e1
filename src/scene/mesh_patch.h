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

/// A new version of an image of the scene, with occlusion in its red channel.
typedef struct alpi_packed_image {
    uint32_t image;     // index into scene.images
    const uint8_t *png; // ready to embed
    size_t png_size;
} alpi_packed_image;
typedef enum alpi_vertex_attribute {
    ALPI_VERTEX_COLOR = 0, // the first colour set: times what is there
    ALPI_VERTEX_OCCLUSION, // an attribute of its own
} alpi_vertex_attribute;

/// How a material comes to show baked light.
typedef enum alpi_light_form {
    ALPI_LIGHT_FORM_EMISSIVE = 0, // base colour 0, all light as emission
    ALPI_LIGHT_FORM_MOZ,          // MOZ_lightmap
    ALPI_LIGHT_FORM_EXTRAS,       // extras.lightmap names a file beside the asset
} alpi_light_form;

/// Light on the pages, read with the same coordinates as occlusion.
typedef struct alpi_light_patch {
    alpi_light_form form;
    const uint8_t *const *pages; // [page_count] PNGs; EXTRAS: files as they stand
    const size_t *page_sizes;    // [page_count]
    const char *ending;          // of their names: ".png", ".ktx2"
    const float *scales; // [material_count + 1] what 1 in the image stands for; last: no material
    const char *units;   // of value × scale
} alpi_light_patch;

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
    /// Coordinates of three sets, of charts that overlap, [triangle][set][corner], which a shader
    /// blends by the normal of the written mesh; NULL: one set, corner_uvs.
    const float (*set_uvs)[3][3][2]; // [triangle_count]
    /// [triangle_count] page of each; NULL = all on page 0. A surface whose triangles have
    /// ALPI_NONE gets no map and stays as it is.
    const uint32_t *triangle_pages;
    /// [surface_count] the surface whose coordinates and pages each one has too, itself where it
    /// has its own (see alpi_scene_instances); NULL = all their own. Such surfaces go on sharing a
    /// mesh.
    const uint32_t *originals;
    /// Occlusion map of each page, ready to embed. NULL: none is attached.
    const uint8_t *const *page_pngs; // [page_count]
    const size_t *page_png_sizes;    // [page_count]
    const alpi_light_patch *light;   // NULL: none; not together with packed images
    alpi_existing_ao existing_ao;
    /// Images that stand for maps: a material with material_packed[m] = i < packed_count reads its
    /// occlusion, and its roughness and metalness if they came from that image, from
    /// packed_images[i] at the coordinates it read the old image at (of metallic_texture, where it
    /// has that image, else of occlusion_texture). Its primitives gain no coordinates and no map.
    uint32_t packed_count;
    const alpi_packed_image *packed_images; // [packed_count]
    const uint32_t *material_packed;        // [scene.material_count] ALPI_NONE = not; NULL = none
    float occlusion_strength;               // 1
    /// A JSON object (text) that becomes asset.extras.alpenglow.
    const char *extras_json;
} alpi_mesh_patch;

#endif
