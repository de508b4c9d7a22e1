// SPDX-License-Identifier: MIT
// Materials that read the maps.
#ifndef ALPI_FORMATS_GLTF_PATCH_MATERIAL_H
#define ALPI_FORMATS_GLTF_PATCH_MATERIAL_H

#include "formats/gltf/write/gltf_patch.h"

/// Decides the material of every piece and adds those that are needed.
alp_result alpi_patcher_materials(alpi_gltf_patcher *patcher);
/// The material that a plan's is a copy of, made by an earlier bake for another page, where the two
/// differ in nothing but maps that are replaced; else its own.
alp_result alpi_patcher_original(const alpi_gltf_patcher *patcher, const alpi_gltf_plan *plan,
                                 size_t *material);
/// Writes into a new copy what it is a copy of, where nothing is said there already.
alp_result alpi_patcher_mark_copy(alpi_gltf_patcher *patcher, size_t material, alpi_bytes *text);
/// Makes animations of materials (KHR_animation_pointer) move the copies too.
void alpi_patcher_follow_pointers(alpi_gltf_patcher *patcher);

/// A material that shows baked light.
typedef struct alpi_gltf_light_use {
    size_t material; // of the document, ALPI_GLTF_NONE = the primitive had none
    uint32_t page, uv_set;
    float scale;       // what 1 in the image stands for
    const char *blend; // what the extras say of the sets that are blended, or NULL
} alpi_gltf_light_use;
/// Edits a material of the document so that it does.
void alpi_patcher_light_material(alpi_gltf_patcher *patcher, const alpi_gltf_light_use *use,
                                 alpi_edits *edits);
/// The members of a new material that does. @param mark a member of its extras, which says that
/// the primitive had no material; left out where the new one does not look like that any more
void alpi_patcher_print_light(alpi_gltf_patcher *patcher, const alpi_gltf_light_use *use,
                              const char *mark, alpi_bytes *text);
/// Adds the extension that materials use to extensionsUsed and takes out what nothing uses any
/// more; after all else.
void alpi_patcher_state_extensions(alpi_gltf_patcher *patcher);
/// Whether light goes to a surface's material: not to one that light shines through.
bool alpi_patcher_is_lit(const alpi_gltf_patcher *patcher, const alpi_surface *surface);

/// Which packed image a material of the document reads its occlusion from; ALPI_NONE = none.
uint32_t alpi_patcher_packed(const alpi_gltf_patcher *patcher, size_t material);
/// Edits a material of the document so that it reads the packed image.
alp_result alpi_patcher_pack_material(alpi_gltf_patcher *patcher, size_t material,
                                      alpi_edits *edits);

#endif
