// SPDX-License-Identifier: MIT
// Messages of the library: printed at once, but for warnings like earlier ones, which are printed
// together; warnings are kept for the report.
#include "printing/messages.h"

#include "options/options.h"

#include <stdlib.h>
#include <string.h>

void *allocate_or_exit(void *old, size_t size)
{
    void *memory = realloc(old, size > 0 ? size : 1);
    if (memory == NULL) {
        fprintf(stderr, "alpenglow: out of memory\n");
        exit(EXIT_FAILED);
    }
    return memory;
}

void print_clean(FILE *stream, const char *text)
{
    const unsigned char *at = (const unsigned char *)text;
    for (; *at != '\0'; at++) {
        // C1 controls are U+0080 to U+009F, in UTF-8 C2 80 to C2 9F.
        bool c1 = at[0] == 0xC2 && at[1] >= 0x80 && at[1] <= 0x9F;
        if (*at < 0x20 || *at == 0x7F || c1) {
            fputc('?', stream);
            at += c1;
        } else {
            fputc(*at, stream);
        }
    }
}

int failure(const char *text)
{
    fputs("alpenglow: ", stderr);
    print_clean(stderr, text);
    fputc('\n', stderr);
    return EXIT_FAILED;
}

static char *copy_text(const char *text)
{
    size_t size = strlen(text) + 1;
    return memcpy(allocate_or_exit(NULL, size), text, size);
}

/// Chooses how a new warning is printed: at once, or with an earlier one of its text. The first
/// CODE_LIMIT warnings of each code are printed.
static int find_like(const message_log *m, const alp_log_message *logged)
{
    enum { CODE_LIMIT = 8 };
    int printed = 0;
    for (size_t i = 0; i < m->warning_count && printed < CODE_LIMIT; i++) {
        const message *w = &m->warnings[i];
        if (w->like != MESSAGE_PRINTED || strcmp(w->code, logged->code) != 0) {
            continue;
        }
        if (strcmp(w->text, logged->text) == 0) {
            return (int)i;
        }
        printed++;
    }
    return printed < CODE_LIMIT ? MESSAGE_PRINTED : MESSAGE_COUNTED;
}

/// @return whether it is to be printed now
static bool keep(message_log *m, const alp_log_message *logged)
{
    const int like = m->held ? MESSAGE_PRINTED : find_like(m, logged);
    if (m->warning_count == m->capacity) {
        m->capacity = m->capacity == 0 ? 16 : m->capacity * 2;
        m->warnings = allocate_or_exit(m->warnings, m->capacity * sizeof *m->warnings);
    }
    m->warnings[m->warning_count++] = (message){copy_text(logged->code), copy_text(logged->object),
                                                copy_text(logged->text), like};
    return like == MESSAGE_PRINTED;
}

static void print_message(const message_log *m, bool warning, const char *object, const char *text)
{
    if (m->progress != NULL) {
        progress_clear(m->progress);
    }
    fputs(warning ? "warning: " : "note: ", stderr);
    if (object[0] != '\0') {
        print_clean(stderr, object);
        fputs(": ", stderr);
    }
    print_clean(stderr, text);
    fputc('\n', stderr);
}

/// Whether the last warning was the same: pictures of one place have the same faults.
static bool is_repeated(const message_log *m, const alp_log_message *logged)
{
    const message *last = m->warning_count > 0 ? &m->warnings[m->warning_count - 1] : NULL;
    return last != NULL && strcmp(last->code, logged->code) == 0 &&
           strcmp(last->object, logged->object) == 0 && strcmp(last->text, logged->text) == 0;
}

/// The text without the path that it begins with, if the object names that file already.
static const char *without_path(const char *object, const char *text)
{
    const char *end = strstr(text, ": "), *name = end;
    if (end == NULL || end == text || memchr(text, '.', (size_t)(end - text)) == NULL) {
        return text;
    }
    while (name > text && name[-1] != '/') {
        name--;
    }
    const size_t length = strlen(object), whole = (size_t)(end - text), last = (size_t)(end - name);
    const bool begins = length > whole && strncmp(object, text, whole) == 0 && object[whole] == ':';
    const bool ends = length >= last && memcmp(object + length - last, name, last) == 0;
    return begins || ends ? end + 2 : text;
}

void messages_log(void *user, const alp_log_message *given)
{
    message_log *m = user;
    const alp_log_message cut = {given->level, given->code, given->object,
                                 without_path(given->object, given->text)};
    const alp_log_message *logged = &cut;
    const bool warning = logged->level == ALP_LOG_WARNING;
    if (warning) {
        if (is_repeated(m, logged)) {
            return;
        }
        if (!keep(m, logged)) {
            return;
        }
    }
    if (warning ? !m->held : !m->quiet) {
        print_message(m, warning, logged->object, logged->text);
    }
}

/// Prints the objects of warnings that have the text of warning `like`: "a, b and 3 more".
static void print_alike(const message_log *m, int like)
{
    enum { NAME_LIMIT = 8 };
    const char *last = "";
    size_t names = 0, more = 0;
    for (size_t i = m->flushed; i < m->warning_count; i++) {
        const message *w = &m->warnings[i];
        if (w->like != like) {
            continue;
        }
        if (names == NAME_LIMIT || strcmp(last, w->object) == 0) { // one object several times
            more++;
            continue;
        }
        fputs(names++ == 0 ? "warning: " : ", ", stderr);
        print_clean(stderr, w->object[0] != '\0' ? w->object : "the scene");
        last = w->object;
    }
    if (names > 0) {
        fprintf(stderr, more > 0 ? " and %zu more: " : ": ", more);
        print_clean(stderr, m->warnings[like].text);
        fputc('\n', stderr);
    }
}

/// Prints the number of warnings that were only counted, with the code of the first.
static void print_counted(const message_log *m, size_t first)
{
    size_t count = 0;
    for (size_t i = m->flushed; i < m->warning_count; i++) {
        const message *w = &m->warnings[i];
        const bool same =
            w->like == MESSAGE_COUNTED && strcmp(w->code, m->warnings[first].code) == 0;
        if (same && i < first) {
            return; // counted already
        }
        count += same;
    }
    fprintf(stderr, "warning: and %zu more of this kind [", count);
    print_clean(stderr, m->warnings[first].code);
    fputs("]\n", stderr);
}

void messages_flush(message_log *m)
{
    bool cleared = m->progress == NULL;
    if (m->held) {
        return;
    }
    for (size_t i = m->flushed; i < m->warning_count && !cleared; i++) {
        cleared = m->warnings[i].like != MESSAGE_PRINTED;
        if (cleared) {
            progress_clear(m->progress);
        }
    }
    for (size_t i = 0; i < m->warning_count; i++) {
        if (m->warnings[i].like == MESSAGE_PRINTED) {
            print_alike(m, (int)i);
        } else if (m->warnings[i].like == MESSAGE_COUNTED && i >= m->flushed) {
            print_counted(m, i);
        }
    }
    m->flushed = m->warning_count;
}

void messages_print_held(message_log *m)
{
    for (size_t i = 0; m->held && i < m->warning_count; i++) {
        print_message(m, true, m->warnings[i].object, m->warnings[i].text);
    }
    m->held = false;
}

void messages_release(message_log *m)
{
    for (size_t i = 0; i < m->warning_count; i++) {
        free(m->warnings[i].code);
        free(m->warnings[i].object);
        free(m->warnings[i].text);
    }
    free(m->warnings);
    *m = (message_log){0};
}
