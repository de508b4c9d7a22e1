// SPDX-License-Identifier: MIT
// Numbers that C and the shaders of light propagation share. This file is valid C and GLSL.
#ifndef VIEWER_LPV_BINDINGS_H
#define VIEWER_LPV_BINDINGS_H

#define LPV_GROUP_X 8
#define LPV_GROUP_Y 4
#define LPV_GROUP_Z 2

// Storage buffers.
#define BUFFER_LPV_INJECTED 8 // int [cascade][z][y][x][channel][term], in units

// Uniforms of all passes: lpv_grid.glsl.
#define UNIFORM_LPV_SIZE 16     // ivec3, cells of a grid
#define UNIFORM_LPV_READ 17     // vec3, where faces are read: far, along, aside
#define UNIFORM_LPV_GIVE 18     // vec2, the lobe of a side face: along, aside
#define UNIFORM_LPV_OPACITY 19  // float, factor on blockers
#define UNIFORM_LPV_BY_ANGLE 20 // bool, whether blockers of one orientation stop light by its angle
#define UNIFORM_LPV_CASCADES 21 // int
// Of one pass.
#define UNIFORM_LPV_UNITS 22    // vec3, of the channels, W/sr
#define UNIFORM_LPV_BLOCKED 23  // bool, whether blockers stop light
#define UNIFORM_LPV_REFLECTS 24 // bool, whether they reflect it

#endif
