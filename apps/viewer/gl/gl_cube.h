// SPDX-License-Identifier: MIT
// A cube map of the radiance around a point, drawn by the passes of a mode, and its projection to
// spherical harmonics on the graphics card.
#ifndef VIEWER_GL_CUBE_H
#define VIEWER_GL_CUBE_H

#include "drawing.h"

#include <alpenglow/sh.h>

typedef struct gl_cube {
    uint32_t side;          // texels
    uint32_t parts;         // groups of rows that are summed apart
    GLuint faces;           // RGBA32F array of 6 in the order of alp_cube_face, as gl_targets.light
    GLuint part_sums, sums; // BUFFER_SH_PARTS, BUFFER_SH
    GLuint project, reduce; // programs
} gl_cube;

/// @param side [8, 4096]
/// @return EXIT_DONE, or EXIT_FAILED after a message; gl_cube_destroy in both cases
int gl_cube_create(uint32_t side, gl_cube *cube);
void gl_cube_destroy(gl_cube *cube);
/// Draws the six faces.
/// @param d its targets are side x side
void gl_cube_draw(const gl_cube *cube, drawing *d, const float point[3]);
/// Projects the faces as alp_sh_project_cube, to within rounding. The same faces give the same
/// bits.
void gl_cube_project(const gl_cube *cube, alp_sh9 *radiance);

#endif
