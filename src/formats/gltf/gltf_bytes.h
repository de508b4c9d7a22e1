// SPDX-License-Identifier: MIT
// Where the bytes of a glTF asset come from: URIs (files beside it, base64) and buffer views.
#ifndef ALPI_FORMATS_GLTF_BYTES_H
#define ALPI_FORMATS_GLTF_BYTES_H

#include "formats/files/find_file.h"
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

/// The file of an image, found as formats/files/find_file.h does. *path is NULL for a data: URI,
/// and is released by the caller. Without a file the refusals are those above, or *path is not
/// there.
alp_result alpi_gltf_image_path(const alpi_gltf_document *document, const char *uri,
                                const char *owner, char **path, alpi_found *found);
/// The bytes of an image, as alpi_gltf_uri_read reads others.
alp_result alpi_gltf_image_read(const alpi_gltf_document *document, const char *uri,
                                const char *owner, uint8_t **bytes, size_t *size);
/// The path of one of "images", or of "buffers".
alp_result alpi_gltf_reference_path(const alpi_gltf_document *document, const char *kind,
                                    const char *uri, char **path);
/// Notes an image whose file was not found as named.
alp_result alpi_gltf_note_image(const alpi_gltf_document *document, const char *uri);

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
