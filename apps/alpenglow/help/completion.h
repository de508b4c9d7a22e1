// SPDX-License-Identifier: MIT
// Completions for each position of a command line, from the table of options.
#ifndef COMMAND_COMPLETION_H
#define COMMAND_COMPLETION_H

#include "options/options.h"

enum { COMPLETION_TEXT_SIZE = 512 };

/// Completions of one position. Words and endings have one blank between them; endings have no dot.
typedef struct completion {
    char words[COMPLETION_TEXT_SIZE];
    char endings[COMPLETION_TEXT_SIZE]; ///< of files; "": no files, unless any_file
    bool any_file, folders;
    bool list; ///< several of the words, with commas between
} completion;

/// Completions of an option's value, without choices that are not built yet.
completion completion_of_option(const option *option);
/// Completions of SCENE, or of A and B.
completion completion_of_operand(command_id command);

/// Whether the command has the option, and it is built.
bool completion_offers(command_id command, const option *option);

/// Writes the first sentence of an option's help, without its full stop.
void completion_describe(const option *option, char *text, size_t size);
/// Prints text with a backslash before each of the characters `special`.
void completion_put(const char *text, const char *special);

void completion_print_bash(void);
void completion_print_zsh(void);
void completion_print_fish(void);

#endif
