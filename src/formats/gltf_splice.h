// SPDX-License-Identifier: MIT
// Growing bytes, and edits to a text: spans replaced, members and elements inserted, all else kept.
//
// Both remember a failure (out of memory) and then do nothing, so that a long sequence of small
// steps is checked once at its end.
#ifndef ALPI_FORMATS_GLTF_SPLICE_H
#define ALPI_FORMATS_GLTF_SPLICE_H

#include "base/context.h"
#include "formats/json_spans.h"

// --- growing bytes -------------------------------------------------------------------------------

typedef struct alpi_bytes {
    alp_context *context;
    uint8_t *bytes; // [size], a zero after the end
    size_t size, capacity;
    bool failed;
} alpi_bytes;

static inline alpi_bytes alpi_bytes_create(alp_context *context)
{
    return (alpi_bytes){.context = context};
}
void alpi_bytes_destroy(alpi_bytes *bytes);
/// Makes room for `more` bytes and no others: what is added within them moves nothing.
void alpi_bytes_reserve(alpi_bytes *bytes, size_t more);
void alpi_bytes_add(alpi_bytes *bytes, const void *data, size_t size);
void alpi_bytes_print(alpi_bytes *bytes, const char *format, ...) ALP_PRINTF(2, 3);
/// A finite number with a point as decimal sign whatever the locale; `digits` significant.
void alpi_bytes_number(alpi_bytes *bytes, double value, int digits);
/// As many digits, 6 to 9, as bring the same float back.
void alpi_bytes_float(alpi_bytes *bytes, float value);
void alpi_bytes_base64(alpi_bytes *bytes, const uint8_t *data, size_t size);
/// A JSON string: quotes and escapes added; bytes that are no ASCII stay as they are (UTF-8).
void alpi_bytes_quote(alpi_bytes *bytes, const char *text);
void alpi_bytes_add_u32(alpi_bytes *bytes, uint32_t value); ///< little-endian
/// Fills with `filler` up to a multiple of 4.
void alpi_bytes_align(alpi_bytes *bytes, char filler);

// --- edits ---------------------------------------------------------------------------------------

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
