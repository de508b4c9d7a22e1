// SPDX-License-Identifier: MIT
// Lines of numbers in a text file: points and flights.
#ifndef COMMAND_NUMBER_LINES_H
#define COMMAND_NUMBER_LINES_H

enum { NUMBER_LINE_COLUMNS = 8 };

/// One line.
typedef struct number_line {
    const char *text; // without blanks at its beginning
    const char *rest; // the text behind the last number
    double numbers[NUMBER_LINE_COLUMNS];
    int count; // of numbers, at most the columns that were wanted
} number_line;

/// Keeps a line. @return NULL, or its fault
typedef const char *number_line_fn(void *user, const number_line *line);

/// Reads a file line by line. Commas, semicolons, blanks and tabs part the numbers. Empty lines and
/// lines that begin with # are skipped, as are names before the first line of numbers.
/// @param path    "-" is standard input
/// @param columns 1 to NUMBER_LINE_COLUMNS: more numbers of a line are left in its rest
/// @param empty   fault of a file without a line of numbers
/// @return EXIT_DONE, or EXIT_FAILED after a message that names file and line
int number_lines_read(const char *path, int columns, const char *empty, number_line_fn *keep,
                      void *user);

#endif
