// SPDX-License-Identifier: MIT
// Between the two files that take out what an earlier bake left: elements, and their bytes.
#ifndef ALPI_FORMATS_GLTF_TIDY_H
#define ALPI_FORMATS_GLTF_TIDY_H

#include "formats/gltf/write/gltf_references.h"

typedef struct alpi_gltf_tidying {
    alp_context *context;
    const char *text;
    alpi_json_span root;
    json_t *tree;
    alpi_gltf_references references;
    size_t counts[ALPI_GLTF_KIND_COUNT];
    alpi_json_span *spans[ALPI_GLTF_KIND_COUNT];
    bool *ours[ALPI_GLTF_KIND_COUNT];    // made by a bake
    bool *gone[ALPI_GLTF_KIND_COUNT];    // and read by nothing any more
    size_t *moved[ALPI_GLTF_KIND_COUNT]; // number that is left, of what stays
    alpi_edits edits;
} alpi_gltf_tidying;

/// Moves what stays of buffers that were made by bakes alone to the new data, so that those go.
/// Before it is decided which buffers go.
alp_result alpi_gltf_tidy_gather(alpi_gltf_tidying *tidying, const alpi_gltf_leftovers *from);
/// Cuts the bytes of views that go out of buffer 0, which `bin` holds.
alp_result alpi_gltf_tidy_bytes(alpi_gltf_tidying *tidying, alpi_bytes *bin);

#endif
