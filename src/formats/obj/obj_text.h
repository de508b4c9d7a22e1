// SPDX-License-Identifier: MIT
// The lines of OBJ and MTL files: words, numbers, names. A line goes on behind a backslash at its
// end; blanks are spaces and tabs; CR, LF or both end it.
#ifndef ALPI_FORMATS_OBJ_TEXT_H
#define ALPI_FORMATS_OBJ_TEXT_H

#include "base/context.h"

typedef struct alpi_obj_text {
    alp_context *context;
    const char *path; // for messages
    const char *at, *end;
    uint64_t line; // of `at`, from 1
    bool started;  // a line was begun
} alpi_obj_text;

/// A piece of the text, not ended by a zero.
typedef struct alpi_obj_word {
    const char *text;
    size_t size; // 0 = none left on the line
} alpi_obj_word;

/// Passes what is left of the line that was begun, empty lines and comments. False at the end of
/// the text.
bool alpi_obj_next_line(alpi_obj_text *text);
/// Passes the rest of the line that was begun and its end: `at` is where the next line begins.
void alpi_obj_end_line(alpi_obj_text *text);
/// Goes to the next word of the line. False where there is none (or a comment).
bool alpi_obj_more(alpi_obj_text *text);
/// Takes the next word of the line.
alpi_obj_word alpi_obj_take_word(alpi_obj_text *text);
/// Takes the rest of the line without blanks around it: a name that may have spaces.
alpi_obj_word alpi_obj_take_rest(alpi_obj_text *text);
bool alpi_obj_word_is(alpi_obj_word word, const char *name);

/// Takes a finite number that a float can hold. `what` names
/// the statement, "v".
/// @return ALP_OK; INVALID_DATA (none there, or no number)
alp_result alpi_obj_take_float(alpi_obj_text *text, const char *what, float *value);
alp_result alpi_obj_take_double(alpi_obj_text *text, const char *what, double *value);

/// Copies the last fault for a warning: "line N: FAULT".
void alpi_obj_copy_fault(const alpi_obj_text *text, char *fault, size_t room);
/// "PATH: line N: FAULT" @return INVALID_DATA
alp_result alpi_obj_fail(const alpi_obj_text *text, const char *format, ...) ALP_PRINTF(2, 3);

#endif
