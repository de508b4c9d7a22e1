// SPDX-License-Identifier: MIT
// Points in text: POINTS.csv of sample and probes.
#ifndef COMMAND_POINTS_H
#define COMMAND_POINTS_H

#include "session.h"

typedef struct point_list {
    uint32_t count;
    float (*positions)[3]; // [count] metres, positions in the scene
    float (*normals)[3];   // [count] unit; NULL: only positions were read
    char **texts;          // [count] the columns as they were given, without what follows
} point_list;

/// Reads lines of x,y,z or x,y,z,nx,ny,nz by number_lines_read.
/// @param path    "-" is standard input
/// @param normals whether three more columns are needed
/// @param origin  of the scene in the world of its file: subtracted
/// @return EXIT_DONE, or EXIT_FAILED after a message that names file and line
int points_read(const char *path, bool normals, const double origin[3], point_list *points);
void points_clear(point_list *points);

#endif
