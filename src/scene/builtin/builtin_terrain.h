// SPDX-License-Identifier: MIT
// The ground of the terrain, and what stands on it where.
#ifndef ALPI_SCENE_BUILTIN_TERRAIN_H
#define ALPI_SCENE_BUILTIN_TERRAIN_H

#include "scene/builtin/shapes.h"

/// Metres. The ground is a square about the origin; the lake's level is y = 0.
#define ALPI_GROUND_HALF 120.0f
#define ALPI_GROUND_BOTTOM (-12.0f)
#define ALPI_LAKE_X (-22.0f)
#define ALPI_LAKE_Z 4.0f
#define ALPI_LAKE_RADIUS 30.0f // of its middle contour; the shore is nearer than the rim
#define ALPI_LAKE_RIM 39.0f

typedef struct alpi_house {
    float x, z, turn;    // middle; radians about +y
    float width, length; // along local x and z, the ridge
    float eaves, slope;  // height above the ground; rise over run
} alpi_house;
enum { ALPI_HOUSE_COUNT = 7 };
const alpi_house *alpi_terrain_houses(void); ///< [ALPI_HOUSE_COUNT]
/// Height of the level ground that a house stands on.
float alpi_terrain_pad(const alpi_house *house);

/// Heights at the vertices of a grid of cells × cells squares.
typedef struct alpi_ground {
    uint32_t cells;
    float *heights; // [cells + 1][cells + 1], row by row along z
} alpi_ground;
alp_result alpi_terrain_make_ground(alp_context *context, uint32_t cells, alpi_ground **ground);
void alpi_terrain_destroy_ground(alp_context *context, alpi_ground *ground); ///< NULL does nothing

/// The solid below the height field; `ground` may be NULL where triangles are counted.
void alpi_terrain_build_ground(alpi_shaper *shaper, const alpi_ground *ground, uint32_t cells);
/// Height of the triangles over a place inside the square.
float alpi_terrain_height(const alpi_ground *ground, float x, float z);
/// Foot of tree `tree`: on the triangles, not in the lake, not in a house.
vec3 alpi_terrain_tree(const alpi_ground *ground, uint32_t tree);

#endif
