// SPDX-License-Identifier: MIT
// Messages of the library: printed at once, but for warnings like earlier ones, which are printed
// together; warnings are kept for the report.
#ifndef COMMAND_MESSAGES_H
#define COMMAND_MESSAGES_H

#include "printing/progress.h"

#include <alpenglow/context.h>

#include <stdio.h>

/// States of a warning.
enum { MESSAGE_PRINTED = -1, MESSAGE_COUNTED = -2 };

typedef struct message {
    char *code, *object, *text;
    int like; // PRINTED; COUNTED: one of many of its code; or the index of one with the same text,
              // with which it is still to be printed
} message;

typedef struct message_log {
    bool quiet;                 // notes are not printed
    bool held;                  // warnings are not printed: the command reports them itself
    progress_display *progress; // its line is cleared first; NULL = none
    message *warnings;          // [warning_count]
    size_t warning_count, capacity;
    size_t flushed; // warnings that messages_flush has seen
} message_log;

/// An alp_log_fn; `user` is a message_log.
void messages_log(void *user, const alp_log_message *logged);
/// Prints warnings that are like earlier ones: those of one text in one line, and for others of one
/// code their number.
void messages_flush(message_log *messages);
/// Prints the warnings that were held, if the command cannot report them.
void messages_print_held(message_log *messages);
void messages_release(message_log *messages);

/// Prints text from files without control characters, which could steer a terminal.
void print_clean(FILE *stream, const char *text);

/// Prints "alpenglow: text". @return EXIT_FAILED
int failure(const char *text);

/// Allocates memory, or ends the program with a message.
void *allocate_or_exit(void *old, size_t size);

#endif
