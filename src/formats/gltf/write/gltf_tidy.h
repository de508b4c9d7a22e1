// SPDX-License-Identifier: MIT
// Elements that nothing reads any more, and their removal.
#ifndef ALPI_FORMATS_GLTF_TIDY_H
#define ALPI_FORMATS_GLTF_TIDY_H

#include "formats/gltf/write/gltf_references.h"

/// Places to search for leftovers, besides the written text.
typedef struct alpi_gltf_leftovers {
    bool first_stays; // the first buffer, whatever reads it
    alpi_bytes *bin;  // its bytes, which are cut too; NULL: they stay
    alpi_bytes *data; // new data, if it is a file that the last buffer names; or NULL
    const alpi_gltf_document *document; // as it was read
    bool *images_gone;                  // [image_count] of the document: those that go are noted
    bool *buffers_gone;                 // [buffer_count]
    size_t image_count, buffer_count;
    size_t copy_count; // materials that this bake copied
} alpi_gltf_leftovers;
/// Removes from a written text what nothing reads any more: elements that bear the mark of a bake,
/// and elements of the document that something read there.
alp_result alpi_gltf_tidy(alp_context *context, const alpi_gltf_leftovers *from, alpi_bytes *text);

// --- between the two files that do so: elements (gltf_tidy.c), and their bytes (gltf_tidy_bytes.c)

typedef struct alpi_gltf_tidying {
    alp_context *context;
    const char *text;
    alpi_json_span root;
    json_t *tree;
    alpi_gltf_references references;
    size_t counts[ALPI_GLTF_KIND_COUNT];
    alpi_json_span *spans[ALPI_GLTF_KIND_COUNT];
    bool *ours[ALPI_GLTF_KIND_COUNT];    // made by a bake
    bool *read[ALPI_GLTF_KIND_COUNT];    // something read it in the document
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
