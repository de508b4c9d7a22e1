// SPDX-License-Identifier: MIT
// Edits to a text: spans replaced, members and elements inserted, all else kept.
//
// A failure (out of memory) is remembered and later edits do nothing, so that a long sequence is
// checked once, by alpi_edits_apply.
#ifndef ALPI_FORMATS_TEXT_EDITS_H
#define ALPI_FORMATS_TEXT_EDITS_H

#include "base/bytes.h"
#include "formats/text/json_spans.h"

typedef struct alpi_edit {
    alpi_json_span span;         // what goes away; empty for an insertion
    size_t text_begin, text_end; // what comes instead, inside alpi_edits.inserted
    size_t order;
} alpi_edit;

typedef struct alpi_edits {
    alp_context *context;
    const char *text; // the whole original text, which every span refers to
    alpi_edit *items;
    size_t count, capacity;
    alpi_bytes inserted;
} alpi_edits;

alpi_edits alpi_edits_create(alp_context *context, const char *text);
void alpi_edits_destroy(alpi_edits *edits);

void alpi_edits_replace(alpi_edits *edits, alpi_json_span span, const char *format, ...)
    ALP_PRINTF(3, 4);
/// Appends an element to an array, or a member (name not NULL) to an object, after its last item.
void alpi_edits_add(alpi_edits *edits, alpi_json_span container, const char *name,
                    const void *value, size_t size);
/// Replaces the value of a member, or adds the member.
void alpi_edits_set(alpi_edits *edits, alpi_json_span object, const char *name, const void *value,
                    size_t size);
void alpi_edits_set_index(alpi_edits *edits, alpi_json_span object, const char *name, size_t index);
/// Takes a member out of its object, with one comma. Not for an object that members are added to.
void alpi_edits_remove(alpi_edits *edits, alpi_json_span object, const char *name);
/// Several; members may be added to an object of which one stays.
void alpi_edits_remove_all(alpi_edits *edits, alpi_json_span object, const char *const *names,
                           size_t count);

/// Appends text[range] to `out` with the edits made. Every edit must lie in the range and no two
/// may overlap.
alp_result alpi_edits_apply(alpi_edits *edits, alpi_json_span range, alpi_bytes *out);

#endif
