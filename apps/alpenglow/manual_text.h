// SPDX-License-Identifier: MIT
// What a manual page says that the table of options does not know.
#ifndef COMMAND_MANUAL_TEXT_H
#define COMMAND_MANUAL_TEXT_H

#include "options.h"

enum { MANUAL_PAIRS = 6 };

/// A file and what it is; or a command line and, first, what it is for.
typedef struct manual_pair {
    const char *name, *text;
} manual_pair;

typedef struct manual_text {
    const char *failed;              ///< when the exit status is 1, or NULL: the usual
    manual_pair files[MANUAL_PAIRS]; ///< up to the first without a name
    const char *environment;         ///< or NULL: nothing in it matters
    manual_pair examples[MANUAL_PAIRS];
} manual_text;

/// The text of a command; COMMAND_COUNT: of alpenglow itself.
const manual_text *manual_text_of(command_id command);

#endif
