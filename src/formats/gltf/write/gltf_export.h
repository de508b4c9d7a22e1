// SPDX-License-Identifier: MIT
// Between the files that make a GLB of a scene.
#ifndef ALPI_FORMATS_GLTF_EXPORT_H
#define ALPI_FORMATS_GLTF_EXPORT_H

#include "base/bytes.h"
#include "scene/scene.h"

/// Each root array is a text that grows; `counts` says how many elements it has.
typedef enum alpi_gltf_list {
    ALPI_LIST_ACCESSORS,
    ALPI_LIST_VIEWS,
    ALPI_LIST_IMAGES,
    ALPI_LIST_TEXTURES,
    ALPI_LIST_MATERIALS,
    ALPI_LIST_MESHES,
    ALPI_LIST_NODES,
    ALPI_LIST_CAMERAS,
    ALPI_LIST_LIGHTS,
    ALPI_LIST_SAMPLERS,
    ALPI_LIST_COUNT
} alpi_gltf_list;

typedef struct alpi_gltf_exporter {
    alp_context *context;
    const alp_scene *scene;
    alpi_bytes lists[ALPI_LIST_COUNT];
    size_t counts[ALPI_LIST_COUNT];
    alpi_bytes bin;
    size_t *images;  // [image_count] in the file, SIZE_MAX = left out
    size_t *gloss;   // [material_count] image of roughness and metalness, SIZE_MAX = none
    bool *normals;   // [image_count] holds normals
    bool keeps_sets; // writes a second set that is equal to the first
    bool has_emissive_strength, has_transmission, has_transform, has_ior, has_specular;
} alpi_gltf_exporter;

/// Begins an element: a comma where it is not the first.
alpi_bytes *alpi_export_begin(alpi_gltf_exporter *exporter, alpi_gltf_list which);
void alpi_export_numbers(alpi_bytes *text, const char *name, const float *values, size_t count);
void alpi_export_number(alpi_bytes *text, const char *name, float value);
/// @param target 0 = none @return its number
size_t alpi_export_view(alpi_gltf_exporter *exporter, const void *bytes, size_t size,
                        uint32_t target);

/// Pictures of materials that surfaces use.
alp_result alpi_export_images(alpi_gltf_exporter *exporter);
void alpi_export_materials(alpi_gltf_exporter *exporter);

#endif
