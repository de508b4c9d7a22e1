// SPDX-License-Identifier: MIT
// Messages of the library. Those of one kind are printed in one line; warnings are kept for the
// report.
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

const char *plural(uint64_t count)
{
    return count == 1 ? "" : "s";
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

// --- kinds ---------------------------------------------------------------------------------------

/// The kind of a message that is about to be added. Kinds of one code are limited: others of that
/// code share the last one.
static message_kind *find_kind(message_list *list, const alp_log_message *logged)
{
    enum { CODE_LIMIT = 8 };
    size_t of_code = 0;
    for (size_t i = 0; i < list->kind_count; i++) {
        message_kind *kind = &list->kinds[i];
        const message *first = &list->items[kind->first];
        if (strcmp(first->code, logged->code) == 0) {
            if (kind->is_rest || texts_are_alike(first->text, logged->text)) {
                return kind;
            }
            of_code++;
        }
    }
    if (list->kind_count == list->kind_capacity) {
        list->kind_capacity = list->kind_capacity == 0 ? 16 : list->kind_capacity * 2;
        list->kinds = allocate_or_exit(list->kinds, list->kind_capacity * sizeof *list->kinds);
    }
    message_kind *kind = &list->kinds[list->kind_count++];
    *kind = (message_kind){.first = list->count, .is_rest = of_code == CODE_LIMIT};
    return kind;
}

/// Lets the last message of a list wait to be printed.
static void enqueue(const message_list *list, message_kind *kind)
{
    if (kind->waiting.count == 0) {
        kind->text = list->count - 1;
    }
    alike_add(&kind->waiting, list->items[list->count - 1].object);
}

// --- printing ------------------------------------------------------------------------------------

/// Prints the messages of a kind that wait.
static void print_kind(const message_log *m, const message_list *list, message_kind *kind)
{
    const message *first = &list->items[kind->text];
    if (m->progress != NULL) {
        progress_clear(m->progress);
    }
    fputs(list == &m->warnings ? "warning: " : "note: ", stderr);
    if (kind->is_rest) {
        fprintf(stderr, "and %zu more of other kinds [", kind->waiting.count);
        print_clean(stderr, first->code);
        fputs("]\n", stderr);
    } else {
        alike_print(stderr, &kind->waiting);
        print_clean(stderr, first->text);
        fputc('\n', stderr);
    }
    kind->printed = true;
    kind->waiting = (alike_list){0};
}

static void print_waiting(const message_log *m, message_list *list)
{
    for (size_t i = 0; i < list->kind_count; i++) {
        if (list->kinds[i].waiting.count > 0) {
            print_kind(m, list, &list->kinds[i]);
        }
    }
}

// --- the log -------------------------------------------------------------------------------------

static void add(message_list *list, const alp_log_message *logged)
{
    if (list->count == list->capacity) {
        list->capacity = list->capacity == 0 ? 16 : list->capacity * 2;
        list->items = allocate_or_exit(list->items, list->capacity * sizeof *list->items);
    }
    list->items[list->count++] =
        (message){copy_text(logged->code), copy_text(logged->object), copy_text(logged->text)};
}

/// Whether the last message was the same: pictures of one place have the same faults.
static bool is_repeated(const message_list *list, const alp_log_message *logged)
{
    const message *last = list->count > 0 ? &list->items[list->count - 1] : NULL;
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
    const alp_log_message logged = {given->level, given->code, given->object,
                                    without_path(given->object, given->text)};
    message_list *list = given->level == ALP_LOG_WARNING ? &m->warnings : &m->notes;
    if ((list == &m->notes && m->quiet) || is_repeated(list, &logged)) {
        return;
    }
    message_kind *kind = find_kind(list, &logged);
    add(list, &logged);
    enqueue(list, kind);
    if (!m->held && !m->gathered && !kind->printed && !kind->is_rest) {
        print_kind(m, list, kind);
    }
}

void messages_flush(message_log *m)
{
    if (!m->held) {
        print_waiting(m, &m->warnings);
        print_waiting(m, &m->notes);
    }
}

void messages_forget(message_log *m, const char *code)
{
    message_list *const lists[] = {&m->warnings, &m->notes};
    for (size_t k = 0; k < 2; k++) {
        for (size_t i = 0; i < lists[k]->kind_count; i++) {
            message_kind *kind = &lists[k]->kinds[i];
            if (strcmp(lists[k]->items[kind->first].code, code) == 0) {
                kind->waiting = (alike_list){0};
            }
        }
    }
}

void messages_print_held(message_log *m)
{
    m->held = false;
    messages_flush(m);
}

static void release_list(message_list *list)
{
    for (size_t i = 0; i < list->count; i++) {
        free(list->items[i].code);
        free(list->items[i].object);
        free(list->items[i].text);
    }
    free(list->items);
    free(list->kinds);
}

void messages_release(message_log *m)
{
    release_list(&m->warnings);
    release_list(&m->notes);
    *m = (message_log){0};
}
