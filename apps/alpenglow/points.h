// SPDX-License-Identifier: MIT
// Points in text: POINTS.csv of sample and probes. Also parts that read other lines of numbers.
#ifndef COMMAND_POINTS_H
#define COMMAND_POINTS_H

#include "session.h"

typedef struct point_list {
    uint32_t count;
    float (*positions)[3]; // [count] metres, positions in the scene
    float (*normals)[3];   // [count] unit; NULL: only positions were read
    char **texts;          // [count] the columns as they were given, without what follows
} point_list;

/// Reads lines of x,y,z or x,y,z,nx,ny,nz. Commas, semicolons, blanks and tabs part the numbers.
/// Empty lines and lines that begin with # are skipped. A first line without numbers is a header.
/// @param path    "-" is standard input
/// @param normals whether three more columns are needed
/// @param origin  of the scene in the world of its file: subtracted
/// @return EXIT_DONE, or EXIT_FAILED after a message that names file and line
int points_read(const char *path, bool normals, const double origin[3], point_list *points);
void points_clear(point_list *points);

/// Numbers at the start of a line. Commas, semicolons, blanks and tabs part them.
/// @param numbers [wanted] out   @param end out: behind the last one   @return how many
int points_numbers(const char *line, double *numbers, int wanted, const char **end);
/// Whether a line has letters that are no number: names of columns.
bool points_are_names(const char *line);
/// Prints "path:line: text". @return EXIT_FAILED
int points_refuse(const char *path, unsigned long line, const char *text);

#endif
