// SPDX-License-Identifier: MIT
// What a shell may offer at each place of a command line, told by the table of options.
#ifndef COMMAND_COMPLETION_H
#define COMMAND_COMPLETION_H

#include "options.h"

enum { COMPLETION_TEXT_SIZE = 512 };

/// What may stand in one place. Words and endings have one blank between them; endings come without
/// their dot.
typedef struct completion {
    char words[COMPLETION_TEXT_SIZE];
    char endings[COMPLETION_TEXT_SIZE]; ///< of files; "": no files, unless any_file
    bool any_file, folders;
    bool list; ///< several of the words, with commas between
} completion;

/// What follows an option. Choices that are not built yet are not offered.
completion completion_of_option(const option *option);
/// What stands for SCENE, or A and B.
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
