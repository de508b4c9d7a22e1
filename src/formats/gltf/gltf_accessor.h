// SPDX-License-Identifier: MIT
// Asking about accessors and primitives without reading them, so that all sizes are known first.
#ifndef ALPI_FORMATS_GLTF_ACCESSOR_H
#define ALPI_FORMATS_GLTF_ACCESSOR_H

#include "formats/gltf/gltf_document.h"

/// Everything alpi_gltf_accessor_read checks but sparse indices; fills all but bytes.
alp_result alpi_gltf_accessor_check(const alpi_gltf_document *document, size_t accessor,
                                    alpi_gltf_values *values);

/// `count` matrices of four by four floats, column by column, from an accessor that has as many or
/// more.
alp_result alpi_gltf_accessor_matrices(const alpi_gltf_document *document, size_t accessor,
                                       uint32_t count, double (*matrices)[16]);

/// How many triangles alpi_gltf_primitive_triangles will give, and how many indices are left over.
/// *drawable is false for points and lines.
alp_result alpi_gltf_primitive_count(const alpi_gltf_document *document, json_t *primitive,
                                     const char *owner, uint32_t vertex_count,
                                     uint32_t *triangle_count, bool *drawable);

#endif
