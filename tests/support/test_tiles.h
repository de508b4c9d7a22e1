// SPDX-License-Identifier: MIT
// Flat tiles, each an object of its own with a place of its own on the page: borders between them
// are seams of known length.
#ifndef TEST_TILES_H
#define TEST_TILES_H

#include "test_support.h"

#include "maps/lightmap.h"

enum { TEST_TILE_LIMIT = 64 };

/// A parallelogram p, p + u, p + u + v, p + v, seen from u × v.
typedef struct test_tile {
    float p[3], u[3], v[3];    // metres
    float at[2], du[2], dv[2]; // the same corners on the page, in texels
} test_tile;

/// A scene of these tiles that keeps their coordinates on a page of this size.
alp_scene *test_tiles_scene(alp_context *context, const test_tile *tiles, uint32_t count,
                            uint32_t size);
/// Its lightmap, without pages.
alp_lightmap *test_tiles_lightmap(alp_scene *scene, uint32_t size);

/// A value at a point, in metres, of a tile.
typedef float test_tile_paint(const void *user, uint32_t tile, const double point[3]);
/// A page of the lightmap on which every texel within two of a tile has the value of the paint at
/// its centre, where the tile's plane goes on; others 1e3. A is 1. The caller frees it.
float *test_tiles_page(const alp_lightmap *lightmap, const test_tile *tiles, uint32_t count,
                       test_tile_paint *paint, const void *user);

#endif
