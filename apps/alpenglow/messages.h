// SPDX-License-Identifier: MIT
// Messages of the library: printed at once; warnings are kept for the report.
#ifndef COMMAND_MESSAGES_H
#define COMMAND_MESSAGES_H

#include "progress.h"

#include <alpenglow/context.h>

#include <stdio.h>

typedef struct message {
    char *code, *object, *text;
} message;

typedef struct message_log {
    bool quiet;                 // notes are not printed
    bool held;                  // warnings are not printed: the command reports them itself
    progress_display *progress; // its line is cleared first; NULL = none
    message *warnings;          // [warning_count]
    size_t warning_count, capacity;
} message_log;

/// An alp_log_fn; `user` is a message_log.
void messages_log(void *user, const alp_log_message *logged);
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
