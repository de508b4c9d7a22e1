// SPDX-License-Identifier: MIT
// Small glTF assets around one quad of four vertices, written by the writer's tests.
//
// Accessors: 0 POSITION, 1 NORMAL, 2 TEXCOORD_0 (float), 3 JOINTS_0 (u8×4), 4 WEIGHTS_0 (float),
// 5 three bytes a vertex, 6 indices 0 1 2 0 2 3 (u16), 7 a morph target's POSITION,
// 8 indices 0 1 3 2 of a strip (u8), 9 a MAT2 of bytes a vertex,
// 10 a colour of four normalised bytes a vertex: (50 + 40 vertex + 10 component) / 255.
#ifndef QUAD_ASSET_H
#define QUAD_ASSET_H

#include "formats/formats.h"
#include "formats/gltf/gltf_document.h"
#include "test_support.h"

/// One quad with everything, as a primitive's attributes.
#define QUAD_ATTRIBUTES "\"POSITION\":0,\"NORMAL\":1"

/// A new folder; with $ALPENGLOW_WRITTEN inside that, where the validator finds it.
const char *quad_folder(void);
/// Asks for both files to be validated, where somebody does that.
void quad_list(const char *before, const char *after);
/// Writes a GLB: `asset` is the value of "asset" and `rest` the root members behind the arrays that
/// the quad needs. Gives its path (static).
const char *quad_write_glb(const char *asset, const char *rest);
/// The same as a .gltf beside "quad data.bin", in a folder of its own.
const char *quad_write_gltf(const char *asset, const char *rest);

/// A scene being patched.
typedef struct quad_bake {
    alp_context *context;
    alp_scene *scene;   // as read
    alp_scene *result;  // as written and read again
    char path[1024];    // of the written file
    float (*uvs)[3][2]; // what was asked for
    uint32_t *pages;
    alpi_mesh_patch patch; // filled by quad_open, may be changed before quad_write
} quad_bake;

/// Reads the file and prepares a patch: corners have coordinates of their vertex (no split is
/// needed) on page 0 of `pages`.
quad_bake quad_open(const char *path, uint32_t pages);
/// Gives every triangle coordinates of its own.
void quad_part_triangles(quad_bake *bake);
/// Writes with the ending (".glb", ".gltf"), reads again, and checks triangles and old text.
void quad_write(quad_bake *bake, const char *ending);
void quad_close(quad_bake *bake);

/// Makes a written file one of a version without marks: nothing in it is known as ours.
void quad_unmark(const char *path);

/// Documents before and after.
const alpi_gltf_document *quad_old(const quad_bake *bake);
const alpi_gltf_document *quad_new(const quad_bake *bake);
/// The text of a value of the written file, "" when it is absent (static).
const char *quad_text(const quad_bake *bake, const char *path);
/// The integer there, −1 when absent.
int quad_number(const quad_bake *bake, const char *path);
/// A primitive of the quad with every kind of attribute, and a morph target.
#define RICH_QUAD                                                                                  \
    "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"JOINTS_0\":3,"                \
    "\"WEIGHTS_0\":4,\"_MINE\":5,\"_MATRIX\":9},\"indices\":6,\"targets\":[{\"POSITION\":7}]}"

/// The written quad's triangles have the old positions and the wanted coordinates in set `set`.
void quad_require_corners(const quad_bake *bake, uint32_t set);

#endif
