// SPDX-License-Identifier: MIT
// Numbers that C and the shaders of light propagation share. This file is valid C and GLSL.
#ifndef VIEWER_LPV_BINDINGS_H
#define VIEWER_LPV_BINDINGS_H

#define LPV_GROUP_X 8
#define LPV_GROUP_Y 4
#define LPV_GROUP_Z 2
#define LPV_MAP_GROUP 8

#define LPV_CASCADES_MOST 8
#define LPV_NODE_TERMS 7              // four of opacity, albedo x opacity
#define LPV_OPACITY_UNIT 9.5367432e-7 // 2^-20
#define LPV_OPACITY_MOST 128.0        // of a surfel

// Textures.
#define TEXTURE_LPV_SUM 24

// Storage buffers.
#define BUFFER_LPV_COUNTS 0 // int [cascade][z][y][x][channel][term], in units
#define BUFFER_LPV_VIEW 1   // int [cascade][z][y][x][LPV_NODE_TERMS] of nodes, in units

// Uniforms of all passes: lpv_grid.glsl.
#define UNIFORM_LPV_SIZE 64     // ivec3, cells of a grid
#define UNIFORM_LPV_READ 65     // vec3, where faces are read: far, along, aside
#define UNIFORM_LPV_GIVE 66     // vec2, the lobe of a side face: along, aside
#define UNIFORM_LPV_OPACITY 67  // float, factor on blockers
#define UNIFORM_LPV_BY_ANGLE 68 // bool, whether blockers of one orientation stop light by its angle
#define UNIFORM_LPV_CASCADES 69 // int
// Uniforms of one pass.
#define UNIFORM_LPV_UNITS 70    // vec3, of the channels, W/sr
#define UNIFORM_LPV_BLOCKED 71  // bool, whether blockers stop light
#define UNIFORM_LPV_REFLECTS 72 // bool, whether they reflect it
#define UNIFORM_LPV_ONLY 73     // bool, whether a map is for its own grid alone
// Uniforms of passes that know where the grids are: lpv_cascades.glsl.
#define UNIFORM_LPV_CELL 74    // float, metres of the finest cell
#define UNIFORM_LPV_MAP 75     // int, the cascade of the map; -1: of all
#define UNIFORM_LPV_CORNERS 76 // vec3 [LPV_CASCADES_MOST], cells from the origin
#define UNIFORM_LPV_CENTRES 84 // vec3 [LPV_CASCADES_MOST], metres, before they are rounded
// Uniforms of surfaces and air that read a volume.
#define UNIFORM_LPV_GLOSS 92      // bool, whether surfaces mirror its light
#define UNIFORM_AIR_SCATTERING 93 // float, 1/metre
#define UNIFORM_AIR_LOW 94        // vec3, metres, bounds of the scene
#define UNIFORM_AIR_HIGH 95       // vec3

#endif
