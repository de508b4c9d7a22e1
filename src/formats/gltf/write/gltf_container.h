// SPDX-License-Identifier: MIT
// Places of binary data: BIN chunk, file, data: URI.
#ifndef ALPI_FORMATS_GLTF_CONTAINER_H
#define ALPI_FORMATS_GLTF_CONTAINER_H

#include "formats/gltf/write/gltf_names.h"
#include "formats/gltf/write/gltf_patch.h"

/// The place of the data in the written file.
typedef enum alpi_gltf_home {
    ALPI_HOME_BIN,      // the BIN chunk of a GLB, behind what is there
    ALPI_HOME_MERGED,   // .gltf → .glb: all buffers in one BIN chunk, ours last
    ALPI_HOME_FILE,     // a .gltf: a file of its own
    ALPI_HOME_DATA_URI, // a .glb whose buffer 0 is another file: a data: URI
} alpi_gltf_home;
alpi_gltf_home alpi_gltf_choose_home(const alpi_gltf_document *document, bool to_glb);

/// Sets data_buffer and data_base of a patcher.
alp_result alpi_gltf_prepare_home(alpi_gltf_patcher *patcher, alpi_gltf_home home);
/// After alpi_patcher_run: embeds external images (MERGED), edits buffers and bufferViews, and puts
/// the bytes of the BIN chunk into `bin` (empty for a .gltf).
alp_result alpi_gltf_settle_home(alpi_gltf_patcher *patcher, alpi_gltf_home home,
                                 const alpi_gltf_names *names, alpi_bytes *bin);

#endif
