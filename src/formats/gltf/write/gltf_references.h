// SPDX-License-Identifier: MIT
// Where the text of a glTF document names elements of its root arrays by their numbers.
#ifndef ALPI_FORMATS_GLTF_REFERENCES_H
#define ALPI_FORMATS_GLTF_REFERENCES_H

#include "formats/gltf/write/gltf_patch.h"

/// A number that names an element.
typedef struct alpi_gltf_reference {
    alpi_gltf_kind kind; // of what it names
    size_t index;
    alpi_json_span span;       // the number
    alpi_gltf_kind owner_kind; // of the root array that it stands in, KIND_COUNT: none of these
    size_t owner;              // element there
    bool changed;              // the text names another one still
} alpi_gltf_reference;

/// All of a document, and what may be one: extensions and extras that we do not know may mean
/// anything by a number.
typedef struct alpi_gltf_references {
    alp_context *context;
    alpi_gltf_reference *items;
    size_t count, capacity;
    size_t *pins; // numbers that may be those of elements
    size_t pin_count, pin_capacity;
    bool buffers_are_named;   // by something unknown
    bool has_pointers;        // unknown strings that may be JSON pointers: nothing is sure
    bool points_at_materials; // one of them is ("/materials/0/...")
} alpi_gltf_references;

/// Finds them in well-formed text; destroyed by the caller, on failure too.
alp_result alpi_gltf_references_find(const char *text, alpi_json_span root,
                                     alpi_gltf_references *found);
void alpi_gltf_references_destroy(alpi_gltf_references *references);

#endif
