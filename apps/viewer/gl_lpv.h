// SPDX-License-Identifier: MIT
// A light propagation volume on the graphics card: the twin of alp_lpv (alpenglow/lpv.h).
#ifndef VIEWER_GL_LPV_H
#define VIEWER_GL_LPV_H

#include <alpenglow/lpv.h>

#include <epoxy/gl.h>

/// A volume. Textures have four floats an element. The grids of all cascades lie one behind the
/// other along z, first those of red, or of faces across x.
typedef struct gl_lpv {
    alp_lpv_options options;
    GLuint injected;           // buffer: int [cascade][z][y][x][channel][term], in units
    float units[3];            // of the channels, W/sr
    GLuint opacities, albedos; // of nodes, without channels: B(w) = p.x + p.yzw . w; albedo × p.x
    GLuint faces, colors;      // low faces: opacity, albedo
    GLuint light[2], sum;      // I(w) = p.x + p.yzw . w; light[0] travels next
    GLuint start, face, step;  // programs
} gl_lpv;

/// An empty volume.
/// @param options as alp_lpv_create takes them; `iterations` is 0 or a number
/// @return EXIT_DONE, or EXIT_FAILED after a message; gl_lpv_destroy in both cases
int gl_lpv_create(const alp_lpv_options *options, gl_lpv *volume);
void gl_lpv_destroy(gl_lpv *volume);
/// Lets what was injected travel: as alp_lpv_propagate.
void gl_lpv_propagate(gl_lpv *volume);

#endif
