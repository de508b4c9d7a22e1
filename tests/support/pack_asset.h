// SPDX-License-Identifier: MIT
// GLBs put together piece by piece, with plain and compressed views; and one mesh to put into them.
#ifndef PACK_ASSET_H
#define PACK_ASSET_H

#include "test_support.h"

#include "scene/scene.h"

enum { PACK_BIN_LIMIT = 1 << 20, PACK_TEXT_LIMIT = 1 << 14 };

/// A GLB that grows. Buffer 0 is the BIN chunk; buffer 1 the fallback that compressed views name.
typedef struct pack_asset {
    uint8_t bin[PACK_BIN_LIMIT];
    size_t bin_size, fallback_size;
    char views[PACK_TEXT_LIMIT], accessors[PACK_TEXT_LIMIT];
    int view_count, accessor_count;
    bool as_gltf; // beside "packed.bin", with a fallback "none.bin" that is not there
} pack_asset;

/// An empty one, in static storage.
pack_asset *pack_start(void);
/// A view of these bytes; its index. @param stride 0 = none
int pack_view(pack_asset *asset, const void *bytes, size_t size, size_t stride);
/// A view that holds `encoded` in EXT_meshopt_compression. @param filter NULL = left out
int pack_meshopt(pack_asset *asset, const void *encoded, size_t size, const char *mode,
                 const char *filter, size_t count, size_t stride);
/// An accessor; its index. @param view −1 = none @param more members, with a comma before, or ""
int pack_accessor(pack_asset *asset, int view, int component_type, size_t count, const char *type,
                  const char *more);
/// Writes a GLB (or a .gltf) with these further members of the root ("'" stands for '"'); its path
/// (static).
const char *pack_write(pack_asset *asset, const char *rest);

/// A wavy grid over the square of side 1, with a wall along one side, so that corners are dark.
/// Coordinates are multiples of 2^-12: integers of 16 bits hold them exactly.
enum { WAVE_SIDE = 24, WAVE_VERTICES = 2 * WAVE_SIDE * WAVE_SIDE };
enum { WAVE_TRIANGLES = 2 * 2 * (WAVE_SIDE - 1) * (WAVE_SIDE - 1) };
typedef struct wave {
    float positions[WAVE_VERTICES][3], normals[WAVE_VERTICES][3], uvs[WAVE_VERTICES][2];
    uint32_t indices[3 * WAVE_TRIANGLES];
} wave;
const wave *wave_mesh(void);
/// The bounds of its positions as members of an accessor.
#define WAVE_BOUNDS ",'min':[0,0,0],'max':[1,1,1]"
/// A scene of it, read from a GLB of floats.
alp_scene *wave_scene(alp_context *context);

/// Largest distance between the positions of two scenes' triangles, corner by corner.
double wave_distance(const alp_scene *a, const alp_scene *b);
/// Root mean square difference of their occlusion at points above the wave.
double wave_occlusion_difference(const alp_scene *a, const alp_scene *b);

/// Patches a file with a map of its own for every triangle or chart, writes it, reads it again and
/// asks for its validation. Positions must be the same within `distance`. The scene that was
/// written.
alp_scene *pack_patch(alp_context *context, const char *path, const char *ending, double distance);

#endif
