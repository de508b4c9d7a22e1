// SPDX-License-Identifier: MIT
// Files that the command itself writes: checked before the work, written completely or not at all.
#ifndef COMMAND_OUTPUT_H
#define COMMAND_OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

#include <jansson.h>

/// Whether `path` can be written, before long work. @return EXIT_DONE, or EXIT_FAILED and a message
int output_check(const char *path, bool overwrite);

/// The same for a JSON document, whose path may also be "-": standard output.
int output_check_json(const char *path, bool overwrite);
bool output_is_stdout(const char *path); ///< also of NULL: false

/// Whether two paths name one file: by their text, because both are there and are the same, or by
/// name and folder.
bool output_is_same(const char *a, const char *b);

/// Writes a JSON document: to standard output, or to a temporary file that is renamed when
/// complete.
/// @return EXIT_DONE, or EXIT_FAILED after a message
int output_write_json(const json_t *document, const char *path, bool overwrite);

/// Writes text whose lines end, in the same way, to a file.
int output_write_text(const char *text, const char *path, bool overwrite);

/// A JSON number, null if it is not finite. A JSON text, '?' for bytes that are not UTF-8.
json_t *json_number(double number);
json_t *json_text(const char *text);
/// Style of documents: "key": value, 2 blanks a level, 9 digits.
enum { JSON_STYLE = JSON_INDENT(2) | JSON_REAL_PRECISION(9) };

/// A number with two significant digits: "110", "0.0012"; by %g.
double two_digits(double value);
/// A share as percent with two digits: "1.2 %", "110 %"; "under 0.001 %" for less.
void print_percent(FILE *stream, double share);

/// Whether the path ends so, in any case of letters.
bool path_ends(const char *path, const char *ending);

#endif
