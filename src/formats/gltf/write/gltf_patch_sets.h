// SPDX-License-Identifier: MIT
// Sets of coordinates: those of earlier bakes, free ones, and sets that are blended.
#ifndef ALPI_FORMATS_GLTF_PATCH_SETS_H
#define ALPI_FORMATS_GLTF_PATCH_SETS_H

#include "formats/gltf/write/gltf_patch.h"

/// The attribute of a set: TEXCOORD_n of n < 32, _ALPENGLOW_UV_n of 32 + n.
void alpi_patcher_set_name(uint32_t set, char name[ALPI_GLTF_ATTRIBUTE_SIZE]);
/// A bit for each set that there is an attribute of, or that a description of a blend names.
uint64_t alpi_gltf_sets_of(json_t *attributes);
uint64_t alpi_gltf_sets_named(json_t *blend);
/// The sets that textures and maps of a material read, whatever it says of blends.
alp_result alpi_gltf_sets_read(alp_context *context, json_t *material, uint64_t *sets);
/// Chooses the sets of a plan, of which all else must be known: those of an earlier bake that only
/// maps read which are replaced are free, and go where they do not become new ones.
alp_result alpi_patcher_choose_sets(alpi_gltf_patcher *patcher, json_t *primitive,
                                    const char *owner, alpi_gltf_plan *plan);
/// A warning where maps are read with sets that viewers do not know.
void alpi_patcher_warn_of_sets(const alpi_gltf_patcher *patcher);
/// Whether an attribute is among the dropped sets; their removal.
bool alpi_patcher_is_dropped(const char *text, alpi_json_span key, uint64_t dropped);
void alpi_patcher_drop_sets(alpi_edits *edits, alpi_json_span attributes, uint64_t dropped);
/// Members of an object inside a material, which may not be there yet.
typedef struct alpi_gltf_inside {
    const char *outer;
    uint32_t count;
    const char *const *names, *const *values; // [count]
} alpi_gltf_inside;
/// Sets them; false where the outer one is there and no object.
bool alpi_patcher_set_inside(alpi_gltf_patcher *patcher, size_t material,
                             const alpi_gltf_inside *inside, alpi_edits *edits);
/// Maps that a bake gives a material, or takes from it.
typedef struct alpi_gltf_maps {
    bool occluded, lit;
    bool cleared; // occlusion goes, and none comes
} alpi_gltf_maps;
/// What the extras of a material say of them, a JSON object: their names in the order of the axes
/// of the mesh, and which of its maps are read with them; and the same of bakes before, whose maps
/// the material keeps.
/// @param material of the document, or ALPI_GLTF_NONE
void alpi_patcher_print_blend(const alpi_gltf_patcher *patcher, size_t material,
                              const uint32_t sets[ALPI_GLTF_BLEND_SETS], alpi_gltf_maps maps,
                              alpi_bytes *text);
/// What the maps of light are called in it, in the form of the patch's.
const char *alpi_patcher_light_name(const alpi_gltf_patcher *patcher);
/// Adds it to a material of the document.
void alpi_patcher_blend_material(alpi_gltf_patcher *patcher, size_t material, const char *blend,
                                 alpi_edits *edits);
/// Takes maps from those that earlier bakes said were blended. Their sets stay named: they hold
/// charts that overlap all the same.
void alpi_patcher_unblend_material(alpi_gltf_patcher *patcher, size_t material,
                                   alpi_gltf_maps replaced, alpi_edits *edits);

#endif
