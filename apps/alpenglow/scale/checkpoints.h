// SPDX-License-Identifier: MIT
// --checkpoint and --shard of bake, and the line by which merge runs a bake again.
#ifndef COMMAND_CHECKPOINTS_H
#define COMMAND_CHECKPOINTS_H

#include "options/options.h"

#include <alpenglow/alpenglow.h>

/// Reads --checkpoint, --checkpoint-every and --shard. A shard turns adaptive sampling off.
/// @param o the other options are read
/// @param restart out: owned text that `o` borrows, or NULL
/// @return EXIT_DONE, or EXIT_USAGE after a message
int checkpoint_read(const command_line *arguments, alp_bake_options *o, char **restart);

/// Reads the folder of operand 0, and runs a body on it. @return the body's code, or EXIT_FAILED
/// after a message
int checkpoint_run(const command_line *arguments,
                   int (*body)(const command_line *arguments, const alp_checkpoint_info *info));

/// The words of a bake's command from a restart text.
typedef struct restart_words {
    char *folder; // where the command ran
    char **words; // [count] after "bake"
    int count;
    int capacity;
} restart_words;
/// @return false: the text is none
bool restart_parse(const char *text, restart_words *words);
/// Appends a word.
void restart_add(restart_words *words, const char *word);
void restart_release(restart_words *words);

#endif
