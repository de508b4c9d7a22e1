// SPDX-License-Identifier: MIT
// Messages of the library: printed at once; warnings are kept for the report.
#include "messages.h"

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

static void keep(message_log *m, const alp_log_message *logged)
{
    if (m->warning_count == m->capacity) {
        m->capacity = m->capacity == 0 ? 16 : m->capacity * 2;
        m->warnings = allocate_or_exit(m->warnings, m->capacity * sizeof *m->warnings);
    }
    m->warnings[m->warning_count++] =
        (message){copy_text(logged->code), copy_text(logged->object), copy_text(logged->text)};
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

void messages_log(void *user, const alp_log_message *logged)
{
    message_log *m = user;
    const bool warning = logged->level == ALP_LOG_WARNING;
    if (warning) {
        if (is_repeated(m, logged)) {
            return;
        }
        keep(m, logged);
    }
    if (warning ? !m->held : !m->quiet) {
        print_message(m, warning, logged->object, logged->text);
    }
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
