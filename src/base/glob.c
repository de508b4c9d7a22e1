// SPDX-License-Identifier: MIT
#include "base/glob.h"

#include <stdint.h>
#include <string.h>

/// The code point at `at`, and where the next one begins. A byte that begins none is passed as
/// itself beyond Unicode, so that it equals only itself.
static uint32_t next_character(const char *text, size_t size, size_t *at)
{
    const unsigned char first = (unsigned char)text[*at];
    const size_t length = first < 0x80                    ? 1
                          : first >= 0xc2 && first < 0xe0 ? 2
                          : first >= 0xe0 && first < 0xf0 ? 3
                          : first >= 0xf0 && first < 0xf5 ? 4
                                                          : 0;
    uint32_t code = length <= 1 ? first : first & (0xffu >> (length + 1));
    bool whole = length > 0 && length <= size - *at;
    for (size_t k = 1; whole && k < length; k++) {
        const unsigned char byte = (unsigned char)text[*at + k];
        whole = (byte & 0xc0u) == 0x80u;
        code = code << 6 | (byte & 0x3fu);
    }
    *at += whole ? length : 1;
    return whole ? code : 0x110000u + first;
}

/// Where the set that begins with the [ at `at` ends (behind its ]), or `at` when it never does. A
/// ] that comes first is part of the set.
static size_t set_end(const char *pattern, size_t size, size_t at)
{
    size_t i = at + 1;
    i += i < size && (pattern[i] == '!' || pattern[i] == '^');
    for (size_t first = i; i < size; i++) {
        if (pattern[i] == '\\' && i + 1 < size) {
            i++;
        } else if (pattern[i] == ']' && i > first) {
            return i + 1;
        }
    }
    return at;
}

static uint32_t set_character(const char *pattern, size_t size, size_t *at)
{
    *at += pattern[*at] == '\\' && *at + 1 < size;
    return next_character(pattern, size, at);
}

/// Whether the set pattern[at] … pattern[end − 1], brackets included, holds a character.
static bool set_holds(const char *pattern, size_t at, size_t end, uint32_t character)
{
    size_t i = at + 1, last = end - 1;
    const bool negated = pattern[i] == '!' || pattern[i] == '^';
    i += negated;
    bool held = false;
    while (i < last) {
        const uint32_t low = set_character(pattern, last, &i);
        uint32_t high = low;
        if (i + 1 < last && pattern[i] == '-') { // a - at the end stands for itself
            i++;
            high = set_character(pattern, last, &i);
        }
        held = held || (low <= character && character <= high);
    }
    return held != negated;
}

/// Matches one character by the pattern's element at *at, which is no *, and passes the element.
static bool match_one(const char *pattern, size_t size, size_t *at, uint32_t character)
{
    const char element = pattern[*at];
    if (element == '?') {
        ++*at;
        return true;
    }
    const size_t end = element == '[' ? set_end(pattern, size, *at) : *at;
    if (end != *at) {
        const bool held = set_holds(pattern, *at, end, character);
        *at = end;
        return held;
    }
    return set_character(pattern, size, at) == character;
}

bool alpi_glob_match(const char *pattern, size_t size, const char *name)
{
    const size_t name_size = strlen(name);
    size_t p = 0, n = 0;
    size_t star = SIZE_MAX, taken = 0; // behind the last *, and the end of what it has taken
    while (n < name_size) {
        size_t next_p = p, next_n = n;
        const uint32_t character = next_character(name, name_size, &next_n);
        if (p < size && pattern[p] == '*') {
            star = ++p;
            taken = n;
        } else if (p < size && match_one(pattern, size, &next_p, character)) {
            p = next_p;
            n = next_n;
        } else if (star != SIZE_MAX) { // the last * takes one more: earlier ones need not change
            next_character(name, name_size, &taken);
            p = star;
            n = taken;
        } else {
            return false;
        }
    }
    while (p < size && pattern[p] == '*') {
        p++;
    }
    return p == size;
}

size_t alpi_glob_length(const char *list)
{
    const size_t size = strlen(list);
    for (size_t i = 0; i < size;) {
        if (list[i] == ',') {
            return i;
        }
        const size_t end = list[i] == '[' ? set_end(list, size, i) : i;
        i = end != i ? end : i + (list[i] == '\\' && i + 1 < size ? 2 : 1);
    }
    return size;
}
