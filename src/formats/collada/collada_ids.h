// SPDX-License-Identifier: MIT
// The ids of a COLLADA document, and what its instances bind.
#ifndef ALPI_FORMATS_COLLADA_IDS_H
#define ALPI_FORMATS_COLLADA_IDS_H

#include "formats/collada/collada_document.h"

typedef struct alpi_collada_id {
    const char *name; // belongs to the tree
    uint32_t element;
} alpi_collada_id;

/// Sorts the ids of all elements, for alpi_collada_find. Of two that are the same the first holds.
alp_result alpi_collada_index_ids(alpi_collada_document *document);

/// Sorts what instances bind, for alpi_collada_bound_to.
alp_result alpi_collada_index_bindings(alpi_collada_document *document);

#endif
