// SPDX-License-Identifier: MIT
// Which maps materials of primitives and of their variants get, and who else uses them.
#ifndef ALPI_FORMATS_GLTF_PATCH_USERS_H
#define ALPI_FORMATS_GLTF_PATCH_USERS_H

#include "formats/gltf/write/gltf_patch.h"

/// Decides what goes to a plan's material: packed, occluded, lit, cleared.
void alpi_patcher_choose_maps(const alpi_gltf_patcher *patcher, alpi_gltf_plan *plan);

/// The mappings of a primitive's variants, NULL where it has none.
json_t *alpi_gltf_mappings(json_t *primitive);
/// The material of one, ALPI_GLTF_NONE where it names none.
size_t alpi_patcher_mapping(const alpi_gltf_patcher *patcher, json_t *mappings, size_t i);
/// Whether a material that a variant can switch to gets the map of a plan. @param variant the plan
/// as if it had that material
bool alpi_patcher_variant(const alpi_gltf_patcher *patcher, const alpi_gltf_plan *plan,
                          size_t material, alpi_gltf_plan *variant);
/// Names the materials of variants that got no map.
void alpi_patcher_warn_of_variants(alpi_gltf_patcher *patcher);

/// Marks materials that something uses which gets no map. @param marks [materials of the document]
alp_result alpi_patcher_other_users(const alpi_gltf_patcher *patcher, bool *marks);

#endif
