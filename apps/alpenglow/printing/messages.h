// SPDX-License-Identifier: MIT
// Messages of the library. Those of one kind are printed in one line; warnings are kept for the
// report.
#ifndef COMMAND_MESSAGES_H
#define COMMAND_MESSAGES_H

#include "printing/alike.h"
#include "printing/progress.h"

#include <alpenglow/context.h>

#include <stdio.h>

typedef struct message {
    char *code, *object, *text;
} message;

/// Messages of one code whose texts are alike, printed in one line.
typedef struct message_kind {
    size_t first;       // the message whose text the others are compared with
    bool is_rest;       // the other kinds of a code that has too many
    bool printed;       // a message of it was
    alike_list waiting; // to be printed
    size_t text;        // the first message of those
} message_kind;

typedef struct message_list {
    message *items; // [count]
    size_t count, capacity;
    message_kind *kinds; // [kind_count]
    size_t kind_count, kind_capacity;
} message_list;

typedef struct message_log {
    bool quiet;                 // notes are not kept
    bool held;                  // nothing is printed: the command reports it
    bool gathered;              // messages wait for messages_flush, also the first of a kind
    progress_display *progress; // its line is cleared first; NULL = none
    message_list warnings, notes;
} message_log;

/// An alp_log_fn; `user` is a message_log.
void messages_log(void *user, const alp_log_message *logged);
/// Prints the messages that wait, one line a kind, unless they are held.
void messages_flush(message_log *messages);
/// Drops waiting messages of a code, which the command reports itself.
void messages_forget(message_log *messages, const char *code);
/// Prints the messages that were held and not forgotten.
void messages_print_held(message_log *messages);
void messages_release(message_log *messages);

/// Prints text from files without control characters, which could steer a terminal.
void print_clean(FILE *stream, const char *text);

/// "s" unless there is one.
const char *plural(uint64_t count);

/// Prints "alpenglow: text". @return EXIT_FAILED
int failure(const char *text);

/// Allocates memory, or ends the program with a message.
void *allocate_or_exit(void *old, size_t size);

#endif
