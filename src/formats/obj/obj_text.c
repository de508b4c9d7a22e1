// SPDX-License-Identifier: MIT
// The lines of OBJ and MTL files.
#include "formats/obj/obj_text.h"

#include "base/decimal.h"
#include "formats/text/utf8.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { SHOWN = 40 }; // bytes of a faulty word that a message repeats

alp_result alpi_obj_fail(const alpi_obj_text *text, const char *format, ...)
{
    char said[256], fault[2 * sizeof said];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(said, sizeof said, format, arguments);
    va_end(arguments);
    alpi_utf8_print(said, strlen(said), fault, sizeof fault);
    for (char *c = fault; *c != '\0'; c++) {
        *c = (unsigned char)*c < 0x20 || *c == 0x7f ? '?' : *c;
    }
    return alpi_fail(text->context, ALP_ERROR_INVALID_DATA, "%s: line %llu: %s", text->path,
                     (unsigned long long)text->line, fault);
}

void alpi_obj_copy_fault(const alpi_obj_text *text, char *fault, size_t room)
{
    const char *message = alp_context_message(text->context);
    const size_t size = strlen(text->path);
    const bool named = strncmp(message, text->path, size) == 0 && message[size] == ':';
    message += named ? size + 2 : 0;
    alpi_utf8_print(message, strlen(message), fault, room);
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0';
}

/// Bytes of the line end at `at`: 0, 1, or 2 for CR LF.
static size_t line_end(const char *at, const char *end)
{
    if (at >= end || (*at != '\n' && *at != '\r')) {
        return 0;
    }
    return *at == '\r' && end - at > 1 && at[1] == '\n' ? 2 : 1;
}

/// Bytes of a backslash and the line end behind it, else 0.
static size_t continuation(const char *at, const char *end)
{
    if (at >= end || *at != '\\') {
        return 0;
    }
    size_t size = line_end(at + 1, end);
    return size > 0 ? size + 1 : 0;
}

static void skip_blanks(alpi_obj_text *t)
{
    for (;;) {
        while (t->at < t->end && is_blank(*t->at)) {
            t->at++;
        }
        size_t size = continuation(t->at, t->end);
        if (size == 0) {
            return;
        }
        t->at += size;
        t->line++;
    }
}

/// A comment has no continuation: a backslash at its end is one of its signs.
static void skip_comment(alpi_obj_text *t)
{
    while (t->at < t->end && line_end(t->at, t->end) == 0) {
        t->at++;
    }
}

/// Passes the rest of the line and its end.
static void skip_line(alpi_obj_text *t)
{
    for (;;) {
        while (t->at < t->end && *t->at != '\\' && *t->at != '#' && line_end(t->at, t->end) == 0) {
            t->at++;
        }
        size_t size = continuation(t->at, t->end);
        if (size == 0 && t->at < t->end && *t->at == '\\') {
            t->at++;
            continue;
        }
        if (size == 0) {
            break;
        }
        t->at += size;
        t->line++;
    }
    skip_comment(t);
    t->at += line_end(t->at, t->end);
    t->line++;
}

void alpi_obj_end_line(alpi_obj_text *t)
{
    skip_line(t);
    t->started = false;
}

bool alpi_obj_next_line(alpi_obj_text *t)
{
    if (t->started) {
        skip_line(t);
    }
    t->started = true;
    for (;; skip_line(t)) {
        skip_blanks(t);
        if (t->at >= t->end) {
            return false;
        }
        if (*t->at != '#' && line_end(t->at, t->end) == 0) {
            return true;
        }
    }
}

bool alpi_obj_more(alpi_obj_text *t)
{
    skip_blanks(t);
    if (t->at < t->end && *t->at == '#') {
        skip_comment(t);
    }
    return t->at < t->end && line_end(t->at, t->end) == 0;
}

alpi_obj_word alpi_obj_take_word(alpi_obj_text *t)
{
    alpi_obj_word word = {t->at, 0};
    if (alpi_obj_more(t)) {
        word.text = t->at;
        while (t->at < t->end && !is_blank(*t->at) && *t->at != '\n' && *t->at != '\r' &&
               continuation(t->at, t->end) == 0) {
            t->at++;
        }
        word.size = (size_t)(t->at - word.text);
    }
    return word;
}

alpi_obj_word alpi_obj_take_rest(alpi_obj_text *t)
{
    skip_blanks(t);
    alpi_obj_word rest = {t->at, 0};
    while (t->at < t->end && line_end(t->at, t->end) == 0) {
        t->at++;
    }
    rest.size = (size_t)(t->at - rest.text);
    while (rest.size > 0 && is_blank(rest.text[rest.size - 1])) {
        rest.size--;
    }
    return rest;
}

bool alpi_obj_word_is(alpi_obj_word word, const char *name)
{
    return word.size == strlen(name) && memcmp(word.text, name, word.size) == 0;
}

// --- numbers -------------------------------------------------------------------------------------

/// Fails unless a number ends here as a word does ("1.#IND" is none) and a float holds it.
static alp_result check_number(alpi_obj_text *t, const char *what, const char *behind, bool fits)
{
    const bool ends = behind != NULL && (behind == t->end || is_blank(*behind) || *behind == '\n' ||
                                         *behind == '\r' || continuation(behind, t->end) > 0);
    if (ends && fits) {
        t->at = behind;
        return ALP_OK;
    }
    const alpi_obj_word word = alpi_obj_take_word(t);
    const int shown = (int)(word.size < SHOWN ? word.size : SHOWN);
    return word.size == 0 ? alpi_obj_fail(t, "%s has too few numbers", what)
           : ends ? alpi_obj_fail(t, "%s: \"%.*s\" is beyond 3.4e38, the largest number read", what,
                                  shown, word.text)
                  : alpi_obj_fail(t, "%s: \"%.*s\" is no finite decimal number", what, shown,
                                  word.text);
}

alp_result alpi_obj_take_float(alpi_obj_text *t, const char *what, float *value)
{
    skip_blanks(t);
    *value = 0.0f;
    const char *behind = alpi_decimal_float(t->at, t->end, value);
    return check_number(t, what, behind, fabsf(*value) <= FLT_MAX);
}

alp_result alpi_obj_take_double(alpi_obj_text *t, const char *what, double *value)
{
    skip_blanks(t);
    *value = 0.0;
    const char *behind = alpi_decimal_double(t->at, t->end, value);
    return check_number(t, what, behind, fabs(*value) <= (double)FLT_MAX);
}
