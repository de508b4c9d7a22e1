// SPDX-License-Identifier: MIT
// A light propagation volume on the graphics card: the twin of alp_lpv (alpenglow/lpv.h).
#ifndef VIEWER_GL_LPV_H
#define VIEWER_GL_LPV_H

#include <alpenglow/lpv.h>

#include "shaders/lpv_bindings.h"

#include <epoxy/gl.h>

enum {
    GL_LPV_LIGHT,
    GL_LPV_GATHER,
    GL_LPV_BLOCKERS,
    GL_LPV_MERGE,
    GL_LPV_FACES,
    GL_LPV_START,
    GL_LPV_STEP,
    GL_LPV_PASSES
};

/// A volume. Textures have four floats an element. The grids of all cascades lie one behind the
/// other along z, first those of red, or of faces across x.
typedef struct gl_lpv {
    alp_lpv_options options;
    GLuint counts;             // buffer: int [cascade][z][y][x][channel][term], of one map's light
    GLuint injected;           // as `sum`: the light of all maps
    GLuint opacities, albedos; // of nodes, without channels: B(w) = p.x + p.yzw . w; albedo × p.x
    GLuint faces, colors;      // low faces: opacity, albedo
    GLuint light[2], sum;      // I(w) = p.x + p.yzw . w; light[0] travels next
    GLuint view;               // buffer: int [cascade][z][y][x][LPV_NODE_TERMS] of nodes, in units
    GLuint programs[GL_LPV_PASSES];
    float corners[LPV_CASCADES_MOST][3], centres[LPV_CASCADES_MOST][3]; // cells; metres
} gl_lpv;

/// An empty volume. Its layers along z, three for each of a cascade's, must fit a texture.
/// @param options as alp_lpv_create takes them; `iterations` is 0 or a number
/// @return EXIT_DONE, or EXIT_FAILED after a message; gl_lpv_destroy in both cases
int gl_lpv_create(const alp_lpv_options *options, gl_lpv *volume);
void gl_lpv_destroy(gl_lpv *volume);
/// Moves the grids as alp_lpv_follow does. @param forward unit, or 0
void gl_lpv_follow(gl_lpv *volume, const double eye[3], const double forward[3]);

/// A map of surfels: textures of [height][width] texels of four floats.
typedef struct gl_lpv_map {
    GLuint positions; // metres; radius of the object, 0: any
    GLuint normals;   // unit, on the lit side; area [m²], 0: no surfel
    GLuint flux;      // W
    GLuint albedos;
    uint32_t width, height;
    int cascade; // whose map it is, −1: of all
} gl_lpv_map;
/// Takes all light and blockers out.
void gl_lpv_begin(const gl_lpv *volume);
/// Injects the light of a map.
/// @param flux the most that the map may hold, W by channel: light is counted in 2^-30 of it
void gl_lpv_add_light(const gl_lpv *volume, const gl_lpv_map *map, const float flux[3]);
/// Adds a map to the view that is being made.
/// @param only to the grid of the map alone; else to coarser ones too
void gl_lpv_add_blockers(const gl_lpv *volume, const gl_lpv_map *map, bool only);
/// Ends a view: views are merged, as they show the same surfaces.
void gl_lpv_end_view(const gl_lpv *volume);
/// Sets what shaders need that read the volume (lpv.glsl), in the current program.
void gl_lpv_bind(const gl_lpv *volume);
/// Lets what was injected travel: as alp_lpv_propagate.
void gl_lpv_propagate(gl_lpv *volume);

#endif
