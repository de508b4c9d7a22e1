// SPDX-License-Identifier: MIT
// The plan: which primitives get which coordinate set and pages, in place or in a copy.
#ifndef ALPI_FORMATS_GLTF_PATCH_PLAN_H
#define ALPI_FORMATS_GLTF_PATCH_PLAN_H

#include "formats/gltf/write/gltf_patch.h"

/// Fills plans, pieces and triangle_pages.
alp_result alpi_patcher_plan(alpi_gltf_patcher *patcher);
/// The JSON object of a primitive, NULL when there is none such.
json_t *alpi_gltf_primitive(const alpi_gltf_document *document, size_t mesh, size_t primitive);

#endif
