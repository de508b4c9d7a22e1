// SPDX-License-Identifier: MIT
// A scanner over JSON text (RFC 8259). Depth is a counter, not recursion.
#include "formats/text/json_spans.h"

#include <stdint.h>
#include <string.h>

static size_t skip_space(const char *text, size_t at, size_t end)
{
    while (at < end &&
           (text[at] == ' ' || text[at] == '\t' || text[at] == '\n' || text[at] == '\r')) {
        at++;
    }
    return at;
}

/// From an opening quote to the byte after the closing one.
static size_t skip_string(const char *text, size_t at, size_t end)
{
    for (at++; at < end && text[at] != '"'; at++) {
        at += text[at] == '\\'; // the escaped character cannot close the string
    }
    return at < end ? at + 1 : end;
}

static bool ends_scalar(char c)
{
    return c == ',' || c == ']' || c == '}' || c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// From an opening bracket to the byte after its partner.
static size_t skip_container(const char *text, size_t at, size_t end)
{
    size_t depth = 0;
    while (at < end) {
        char c = text[at];
        if (c == '"') {
            at = skip_string(text, at, end);
            continue;
        }
        at++;
        if (c == '{' || c == '[') {
            depth++;
        } else if ((c == '}' || c == ']') && --depth == 0) {
            break;
        }
    }
    return at;
}

alpi_json_size alpi_json_measure(const char *text, size_t size)
{
    alpi_json_size found = {.values = 1};
    size_t depth = 0;
    for (size_t at = 0; at < size;) {
        const char c = text[at];
        if (c == '"') {
            at = skip_string(text, at, size);
            continue;
        }
        at++;
        found.values += c == ','; // one before each, one in each container, and the whole
        if (c == '{' || c == '[') {
            found.containers++;
            found.values++;
            depth++;
            found.depth = depth > found.depth ? depth : found.depth;
        } else if (c == '}' || c == ']') {
            depth -= depth > 0;
        }
    }
    return found;
}

bool alpi_json_value(const char *text, size_t begin, size_t end, alpi_json_span *value)
{
    size_t at = skip_space(text, begin, end);
    value->begin = value->end = at;
    if (at >= end || text[at] == ',' || text[at] == ']' || text[at] == '}' || text[at] == ':') {
        return false;
    }
    if (text[at] == '"') {
        value->end = skip_string(text, at, end);
    } else if (text[at] == '{' || text[at] == '[') {
        value->end = skip_container(text, at, end);
    } else {
        while (at < end && !ends_scalar(text[at])) {
            at++;
        }
        value->end = at;
    }
    return true;
}

alpi_json_cursor alpi_json_open(const char *text, alpi_json_span container)
{
    alpi_json_cursor cursor = {.text = text, .at = container.end, .end = container.end};
    if (container.end - container.begin >= 2) {
        char first = text[container.begin];
        cursor.is_object = first == '{';
        if (first == '{' || first == '[') {
            cursor.at = container.begin + 1;
            cursor.end = container.end - 1; // the closing bracket
        }
    }
    return cursor;
}

static bool next_key(alpi_json_cursor *cursor)
{
    if (!alpi_json_value(cursor->text, cursor->at, cursor->end, &cursor->key) ||
        cursor->text[cursor->key.begin] != '"') {
        return false;
    }
    cursor->at = skip_space(cursor->text, cursor->key.end, cursor->end);
    if (cursor->at >= cursor->end || cursor->text[cursor->at] != ':') {
        return false;
    }
    cursor->at++;
    return true;
}

bool alpi_json_next(alpi_json_cursor *cursor)
{
    if (cursor->started) {
        cursor->at = skip_space(cursor->text, cursor->at, cursor->end);
        if (cursor->at >= cursor->end || cursor->text[cursor->at] != ',') {
            return false;
        }
        cursor->at++;
        cursor->index++;
    }
    cursor->started = true;
    if ((cursor->is_object && !next_key(cursor)) ||
        !alpi_json_value(cursor->text, cursor->at, cursor->end, &cursor->value)) {
        cursor->at = cursor->end;
        return false;
    }
    cursor->at = cursor->value.end;
    return true;
}

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    if (c >= 'a' && c <= 'f') {
        return c - 'a' + 10;
    }
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/// The UTF-16 unit of \uXXXX at `at` (which points behind the u), or −1.
static int32_t escaped_unit(const char *text, size_t at, size_t end)
{
    if (end - at < 4) {
        return -1;
    }
    int32_t unit = 0;
    for (size_t i = 0; i < 4; i++) {
        int digit = hex_digit(text[at + i]);
        if (digit < 0) {
            return -1;
        }
        unit = unit * 16 + digit;
    }
    return unit;
}

/// The character at *at inside a key, escapes resolved; steps over it. −1 for what is no ASCII.
static int32_t next_character(const char *text, size_t *at, size_t end)
{
    unsigned char c = (unsigned char)text[(*at)++];
    if (c != '\\') {
        return c < 0x80 ? c : -1;
    }
    if (*at >= end) {
        return -1;
    }
    char escaped = text[(*at)++];
    if (escaped == 'u') {
        int32_t unit = escaped_unit(text, *at, end);
        *at += unit < 0 ? 0 : 4;
        return unit < 0x80 ? unit : -1;
    }
    static const char letters[] = "bfnrt", characters[] = "\b\f\n\r\t";
    const char *letter = escaped == '\0' ? NULL : strchr(letters, escaped);
    return letter != NULL ? characters[letter - letters] : escaped;
}

bool alpi_json_key_is(const char *text, alpi_json_span key, const char *name)
{
    if (key.end - key.begin < 2) {
        return false;
    }
    size_t at = key.begin + 1, end = key.end - 1;
    for (; at < end; name++) {
        if (*name == '\0' || next_character(text, &at, end) != (unsigned char)*name) {
            return false;
        }
    }
    return *name == '\0';
}

bool alpi_json_find(const char *text, alpi_json_span object, const char *name,
                    alpi_json_span *value)
{
    bool found = false;
    alpi_json_cursor cursor = alpi_json_open(text, object);
    if (!cursor.is_object) {
        return false;
    }
    while (alpi_json_next(&cursor)) {
        if (alpi_json_key_is(text, cursor.key, name)) {
            *value = cursor.value;
            found = true;
        }
    }
    return found;
}

static bool find_element(const char *text, alpi_json_span array, const char *digits,
                         alpi_json_span *value)
{
    alpi_json_cursor cursor = alpi_json_open(text, array);
    size_t wanted = 0;
    for (const char *p = digits; *p != '\0'; p++) {
        if (*p < '0' || *p > '9' || wanted > SIZE_MAX / 10 - 9) {
            return false;
        }
        wanted = wanted * 10 + (size_t)(*p - '0');
    }
    while (!cursor.is_object && alpi_json_next(&cursor)) {
        if (cursor.index == wanted) {
            *value = cursor.value;
            return true;
        }
    }
    return false;
}

bool alpi_json_at(const char *text, alpi_json_span root, const char *path, alpi_json_span *value)
{
    *value = root;
    while (*path != '\0') {
        char name[64];
        size_t length = strcspn(path, "/");
        if (length == 0 || length >= sizeof name) {
            return false;
        }
        memcpy(name, path, length);
        name[length] = '\0';
        path += length + (path[length] == '/');
        bool is_object = value->end > value->begin && text[value->begin] == '{';
        if (!(is_object ? alpi_json_find(text, *value, name, value)
                        : find_element(text, *value, name, value))) {
            return false;
        }
    }
    return true;
}
