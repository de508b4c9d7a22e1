// SPDX-License-Identifier: MIT
// Growing bytes and edits to a text.
#include "formats/gltf_splice.h"

#include "base/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// --- growing bytes -------------------------------------------------------------------------------

void alpi_bytes_destroy(alpi_bytes *bytes)
{
    alpi_release(bytes->context, bytes->bytes);
    *bytes = (alpi_bytes){.context = bytes->context};
}

static bool make_room(alpi_bytes *bytes, size_t size)
{
    if (bytes->failed || size > SIZE_MAX - 1 - bytes->size) {
        bytes->failed = true;
        return false;
    }
    void *items = bytes->bytes;
    bytes->failed =
        alpi_grow(bytes->context, &items, &bytes->capacity, bytes->size + size + 1, 1) != ALP_OK;
    bytes->bytes = items;
    return !bytes->failed;
}

void alpi_bytes_reserve(alpi_bytes *bytes, size_t more)
{
    if (bytes->failed || more > SIZE_MAX - 1 - bytes->size ||
        bytes->size + more + 1 <= bytes->capacity) {
        return; // the size is known to be too much, or comes out where it is added
    }
    const size_t capacity = bytes->size + more + 1;
    void *moved = alpi_reallocate(bytes->context, bytes->bytes, capacity, 1);
    bytes->failed = moved == NULL;
    bytes->bytes = moved != NULL ? moved : bytes->bytes;
    bytes->capacity = moved != NULL ? capacity : bytes->capacity;
}

void alpi_bytes_add(alpi_bytes *bytes, const void *data, size_t size)
{
    if (make_room(bytes, size)) {
        if (size > 0) {
            memcpy(bytes->bytes + bytes->size, data, size);
        }
        bytes->size += size;
        bytes->bytes[bytes->size] = 0;
    }
}

static void print_arguments(alpi_bytes *bytes, const char *format, va_list arguments)
{
    va_list again;
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    if (length >= 0 && make_room(bytes, (size_t)length)) {
        // Both callers started it. NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized)
        vsnprintf((char *)bytes->bytes + bytes->size, (size_t)length + 1, format, arguments);
        bytes->size += (size_t)length;
    }
}

void alpi_bytes_print(alpi_bytes *bytes, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_arguments(bytes, format, arguments);
    va_end(arguments);
}

void alpi_bytes_number(alpi_bytes *bytes, double value, int digits)
{
    char text[64];
    snprintf(text, sizeof text, "%.*g", digits, value);
    for (char *p = text; *p != '\0'; p++) {
        *p = strchr("0123456789+-eE", *p) != NULL ? *p : '.'; // the locale's decimal sign
    }
    alpi_bytes_add(bytes, text, strlen(text));
}

void alpi_bytes_float(alpi_bytes *bytes, float value)
{
    char text[32];
    int digits = 5;
    do { // nine always do
        snprintf(text, sizeof text, "%.*g", ++digits, (double)value);
    } while (digits < 9 && strtof(text, NULL) != value);
    alpi_bytes_number(bytes, (double)value, digits);
}

void alpi_bytes_base64(alpi_bytes *bytes, const uint8_t *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        uint32_t bits = (uint32_t)data[i] << 16;
        bits |= left > 1 ? (uint32_t)data[i + 1] << 8 : 0;
        bits |= left > 2 ? (uint32_t)data[i + 2] : 0;
        char group[4] = {digits[bits >> 18], digits[bits >> 12 & 63],
                         left > 1 ? digits[bits >> 6 & 63] : '=',
                         left > 2 ? digits[bits & 63] : '='};
        alpi_bytes_add(bytes, group, sizeof group);
    }
}

void alpi_bytes_quote(alpi_bytes *bytes, const char *text)
{
    alpi_bytes_add(bytes, "\"", 1);
    for (; *text != '\0'; text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\') {
            alpi_bytes_print(bytes, "\\%c", c);
        } else if (c < 0x20) {
            alpi_bytes_print(bytes, "\\u%04x", (unsigned)c);
        } else {
            alpi_bytes_add(bytes, text, 1);
        }
    }
    alpi_bytes_add(bytes, "\"", 1);
}

void alpi_bytes_add_u32(alpi_bytes *bytes, uint32_t value)
{
    const uint8_t little[4] = {(uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16),
                               (uint8_t)(value >> 24)};
    alpi_bytes_add(bytes, little, sizeof little);
}

void alpi_bytes_align(alpi_bytes *bytes, char filler)
{
    while (!bytes->failed && bytes->size % 4 != 0) {
        alpi_bytes_add(bytes, &filler, 1);
    }
}

// --- edits ---------------------------------------------------------------------------------------

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
    print_arguments(&edits->inserted, format, arguments);
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
