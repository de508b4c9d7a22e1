// SPDX-License-Identifier: MIT
// Where the bytes of a glTF asset come from: URIs (files beside it, base64) and buffer views.
#ifndef ALPI_FORMATS_GLTF_BYTES_H
#define ALPI_FORMATS_GLTF_BYTES_H

#include "formats/gltf/gltf_document.h"

/// No file that we read is larger than this.
#define ALPI_GLTF_FILE_LIMIT ((uint64_t)4 << 30)

/// Reads what a uri stands for: base64 of a data: URI, or a file below the asset's folder, percent
/// escapes decoded. Other schemes, absolute paths and ".." are refused. *bytes is released by the
/// caller.
alp_result alpi_gltf_uri_read(const alpi_gltf_document *document, const char *uri,
                              const char *owner, uint8_t **bytes, size_t *size);

/// The file a relative uri names: folder + decoded uri; released by the caller. NULL in *path for a
/// data: URI. The same refusals as above.
alp_result alpi_gltf_uri_path(const alpi_gltf_document *document, const char *uri,
                              const char *owner, char **path);

/// A buffer view inside its buffer.
typedef struct alpi_gltf_view {
    const uint8_t *bytes;
    size_t size;
    size_t stride; // 0 = tightly packed
} alpi_gltf_view;
/// `index` < count of bufferViews.
alp_result alpi_gltf_view_read(const alpi_gltf_document *document, size_t index,
                               alpi_gltf_view *view);

#endif
