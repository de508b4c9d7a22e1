// SPDX-License-Identifier: MIT
// References to scenes' nodes, meshes, materials, textures, images, cameras and lights that are not
// in the file.
#ifndef ALPI_FORMATS_GLTF_MEND_H
#define ALPI_FORMATS_GLTF_MEND_H

#include "base/bytes.h"
#include "formats/gltf/gltf_document.h"

/// Appends to `text` the document's text without them, each with a warning ("missing"). *mended is
/// false, and `text` as it was, where there are none.
alp_result alpi_gltf_mend(const alpi_gltf_document *document, alpi_bytes *text, bool *mended);

#endif
