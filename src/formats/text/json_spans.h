// SPDX-License-Identifier: MIT
// Where values lie in a JSON text. A parsed tree says what is there; this says at which bytes, so
// that a writer can change one value and leave every other byte alone.
//
// The text must be well-formed (parse it first). On text that is not, nothing is read out of
// bounds, and things are just not found.
#ifndef ALPI_FORMATS_JSON_SPANS_H
#define ALPI_FORMATS_JSON_SPANS_H

#include <stdbool.h>
#include <stddef.h>

/// Bytes [begin, end) of the text. A string's span includes its quotes.
typedef struct alpi_json_span {
    size_t begin, end;
} alpi_json_span;

/// Walks over the members of an object or the elements of an array, in the order of the text.
typedef struct alpi_json_cursor {
    const char *text;
    size_t at, end;            // inside the container
    alpi_json_span key, value; // of the current item; key is empty in an array
    size_t index;              // of the current item
    bool is_object, started;
} alpi_json_cursor;

/// What a parser would have to keep of a text, well-formed or not: at most so many objects and
/// arrays, values with them, and levels.
typedef struct alpi_json_size {
    size_t containers, values, depth;
} alpi_json_size;
alpi_json_size alpi_json_measure(const char *text, size_t size);

/// The value at the first byte that is no white space; false when there is none.
bool alpi_json_value(const char *text, size_t begin, size_t end, alpi_json_span *value);

/// A cursor before the first item; a span that is no container has no items.
alpi_json_cursor alpi_json_open(const char *text, alpi_json_span container);
/// Steps to the next item; false at the end.
bool alpi_json_next(alpi_json_cursor *cursor);

/// Whether a key means `name` (ASCII): escapes count as the characters they stand for.
bool alpi_json_key_is(const char *text, alpi_json_span key, const char *name);

/// The value of a member; of several with one name the last, which is also what a parser keeps.
bool alpi_json_find(const char *text, alpi_json_span object, const char *name,
                    alpi_json_span *value);

/// The value at a path of names and indices, such as "materials/3/occlusionTexture". Names hold no
/// slash.
bool alpi_json_at(const char *text, alpi_json_span root, const char *path, alpi_json_span *value);

#endif
