// SPDX-License-Identifier: MIT
// Compressed geometry: everything is decoded when the document is read, so that accessors and views
// are plain to whoever asks for them.
#ifndef ALPI_FORMATS_GLTF_COMPRESSION_H
#define ALPI_FORMATS_GLTF_COMPRESSION_H

#include "formats/gltf/gltf_document.h"

#define ALPI_GLTF_MESHOPT "EXT_meshopt_compression"
#define ALPI_GLTF_DRACO "KHR_draco_mesh_compression"

/// What all compressed geometry of one asset may decode to.
#define ALPI_GLTF_DECODED_LIMIT ((uint64_t)4 << 30)

/// gltf_meshopt.c: fills decoded_views.
alp_result alpi_gltf_decode_views(alpi_gltf_document *document);
/// gltf_draco.c: fills decoded.
alp_result alpi_gltf_decode_primitives(alpi_gltf_document *document);

/// Adds to decoded_size, before the memory is asked for.
/// @return ALP_OK; LIMIT
alp_result alpi_gltf_count_decoded(alpi_gltf_document *document, const char *owner, uint64_t size);

/// Whether Draco's decoder is part of this build.
bool alpi_draco_is_built(void);
/// Whether the values of an accessor came out of a compressed view or primitive.
bool alpi_gltf_accessor_is_compressed(const alpi_gltf_document *document, size_t accessor);

#endif
