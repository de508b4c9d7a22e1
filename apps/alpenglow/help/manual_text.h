// SPDX-License-Identifier: MIT
// Texts of the manual pages beside the table of options.
#ifndef COMMAND_MANUAL_TEXT_H
#define COMMAND_MANUAL_TEXT_H

#include "options/options.h"

enum { MANUAL_PAIRS = 6 };

/// A file and its description; or the purpose of a command line, and the line.
typedef struct manual_pair {
    const char *name, *text;
} manual_pair;

typedef struct manual_text {
    const char *failed;              ///< causes of exit status 1, or NULL: a general text
    manual_pair files[MANUAL_PAIRS]; ///< up to the first without a name
    const char *environment;         ///< or NULL: no variable has an effect
    manual_pair examples[MANUAL_PAIRS];
} manual_text;

/// The text of a command; COMMAND_COUNT: of alpenglow itself.
const manual_text *manual_text_of(command_id command);

#endif
