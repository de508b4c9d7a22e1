// SPDX-License-Identifier: MIT
// A glTF of one square with two coordinate sets, colours and an image, for tests of what is drawn.
#ifndef DRAWN_ASSET_H
#define DRAWN_ASSET_H

#include "test_gltf.h"

/// Images of the asset.
enum { DRAWN_IMAGE, DRAWN_BROKEN, DRAWN_SAME, DRAWN_IMAGE_COUNT };
/// Textures: of the image, clamped along u and mirrored along v; of the broken one; of the image
/// again, repeated; without an image.
enum { DRAWN_CLAMPED, DRAWN_OF_BROKEN, DRAWN_REPEATED, DRAWN_EMPTY };
enum { DRAWN_WIDTH = 4, DRAWN_HEIGHT = 3 };

/// Reads the asset. Its square lies in the xy plane, faces +z and has the corners 00 10 01 11.
/// TEXCOORD_0 shows an image upright; TEXCOORD_1 shows it mirrored along x.
/// @param materials JSON of the array, ' for "; the square has the first
alp_result drawn_asset_read(alp_context *context, const char *materials, alp_scene **scene);
/// The same, which must be read.
alp_scene *drawn_asset(alp_context *context, const char *materials);

#endif
