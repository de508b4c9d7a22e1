// SPDX-License-Identifier: MIT
// Edits to a text.
#include "formats/text/text_edits.h"

#include "base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

alpi_edits alpi_edits_create(alp_context *context, const char *text)
{
    return (alpi_edits){.context = context, .text = text, .inserted = alpi_bytes_create(context)};
}

void alpi_edits_destroy(alpi_edits *edits)
{
    alpi_release(edits->context, edits->items);
    alpi_bytes_destroy(&edits->inserted);
    *edits = (alpi_edits){.context = edits->context};
}

/// Notes an edit; its text is what was added to `inserted` since `text_begin`.
static void note_edit(alpi_edits *edits, alpi_json_span span, size_t text_begin)
{
    void *items = edits->items;
    if (edits->inserted.failed || alpi_grow(edits->context, &items, &edits->capacity,
                                            edits->count + 1, sizeof(alpi_edit)) != ALP_OK) {
        edits->inserted.failed = true;
        return;
    }
    edits->items = items;
    edits->items[edits->count] = (alpi_edit){.span = span,
                                             .text_begin = text_begin,
                                             .text_end = edits->inserted.size,
                                             .order = edits->count};
    edits->count++;
}

void alpi_edits_replace(alpi_edits *edits, alpi_json_span span, const char *format, ...)
{
    size_t begin = edits->inserted.size;
    va_list arguments;
    va_start(arguments, format);
    alpi_bytes_print_arguments(&edits->inserted, format, arguments);
    va_end(arguments);
    note_edit(edits, span, begin);
}

static bool was_added_at(const alpi_edits *edits, size_t at)
{
    for (size_t i = 0; i < edits->count; i++) {
        if (edits->items[i].span.begin == at && edits->items[i].span.end == at) {
            return true;
        }
    }
    return false;
}

void alpi_edits_add(alpi_edits *edits, alpi_json_span container, const char *name,
                    const void *value, size_t size)
{
    size_t at = container.begin + 1; // just inside an empty container
    bool empty = true;
    alpi_json_cursor cursor = alpi_json_open(edits->text, container);
    while (alpi_json_next(&cursor)) {
        at = cursor.value.end;
        empty = false;
    }
    size_t begin = edits->inserted.size;
    if (!empty || was_added_at(edits, at)) {
        alpi_bytes_add(&edits->inserted, ",", 1);
    }
    if (name != NULL) {
        alpi_bytes_quote(&edits->inserted, name);
        alpi_bytes_add(&edits->inserted, ":", 1);
    }
    alpi_bytes_add(&edits->inserted, value, size);
    note_edit(edits, (alpi_json_span){at, at}, begin);
}

void alpi_edits_set(alpi_edits *edits, alpi_json_span object, const char *name, const void *value,
                    size_t size)
{
    alpi_json_span old;
    if (alpi_json_find(edits->text, object, name, &old)) {
        size_t begin = edits->inserted.size;
        alpi_bytes_add(&edits->inserted, value, size);
        note_edit(edits, old, begin);
    } else {
        alpi_edits_add(edits, object, name, value, size);
    }
}

void alpi_edits_set_index(alpi_edits *edits, alpi_json_span object, const char *name, size_t index)
{
    char digits[32];
    int length = snprintf(digits, sizeof digits, "%zu", index);
    alpi_edits_set(edits, object, name, digits, (size_t)length);
}

static bool key_is_one_of(const char *text, alpi_json_span key, const char *const *names,
                          size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (alpi_json_key_is(text, key, names[i])) {
            return true;
        }
    }
    return false;
}

void alpi_edits_remove_all(alpi_edits *edits, alpi_json_span object, const char *const *names,
                           size_t count)
{
    alpi_json_cursor cursor = alpi_json_open(edits->text, object);
    alpi_json_span gone = {0};
    size_t kept_end = 0; // of the last member that stays
    bool going = false;  // neighbours go together, so that no comma goes twice
    while (alpi_json_next(&cursor)) {
        if (key_is_one_of(edits->text, cursor.key, names, count)) {
            gone.begin = going ? gone.begin : cursor.key.begin;
            gone.end = cursor.value.end;
            going = true;
            continue;
        }
        if (going) {
            alpi_edits_replace(edits, (alpi_json_span){gone.begin, cursor.key.begin}, "%s", "");
        }
        going = false;
        kept_end = cursor.value.end;
    }
    if (going) {
        gone.begin = kept_end > 0 ? kept_end : gone.begin;
        alpi_edits_replace(edits, gone, "%s", "");
    }
}

void alpi_edits_remove(alpi_edits *edits, alpi_json_span object, const char *name)
{
    alpi_edits_remove_all(edits, object, &name, 1);
}

static int compare_edits(const void *left, const void *right)
{
    const alpi_edit *a = left, *b = right;
    if (a->span.begin != b->span.begin) {
        return a->span.begin < b->span.begin ? -1 : 1;
    }
    bool a_replaces = a->span.end > a->span.begin, b_replaces = b->span.end > b->span.begin;
    if (a_replaces != b_replaces) {
        return a_replaces ? 1 : -1; // insertions come before what follows them
    }
    return a->order < b->order ? -1 : a->order > b->order;
}

alp_result alpi_edits_apply(alpi_edits *edits, alpi_json_span range, alpi_bytes *out)
{
    if (edits->inserted.failed) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    if (edits->count > 0) {
        qsort(edits->items, edits->count, sizeof *edits->items, compare_edits);
    }
    size_t at = range.begin;
    for (size_t i = 0; i < edits->count; i++) {
        const alpi_edit *edit = &edits->items[i];
        if (edit->span.begin < at || edit->span.end > range.end) {
            return alpi_fail(edits->context, ALP_ERROR_INVALID_DATA,
                             "byte %zu of the JSON text would be changed twice: a member name "
                             "appears twice in one object",
                             edit->span.begin);
        }
        alpi_bytes_add(out, edits->text + at, edit->span.begin - at);
        alpi_bytes_add(out, edits->inserted.bytes + edit->text_begin,
                       edit->text_end - edit->text_begin);
        at = edit->span.end;
    }
    alpi_bytes_add(out, edits->text + at, range.end - at);
    return out->failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}
