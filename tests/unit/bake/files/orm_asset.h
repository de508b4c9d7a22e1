// SPDX-License-Identifier: MIT
// A floor and a lid above half of it, whose materials read roughness and metalness from an image.
#ifndef ORM_ASSET_H
#define ORM_ASSET_H

#include "quad_asset.h"

enum { ORM_WIDTH = 72, ORM_HEIGHT = 48 };

typedef struct orm_asset {
    const char *materials; // JSON array with ' for ", NULL: both read image 0
    const char *textures;  // the same; NULL: one texture, image 0
    const char *nodes;     // the same; NULL: floor and lid
    float floor[4];        // u0, v0, u1, v1 of the floor's coordinates
    float lid[4];
    int wrap;             // of the texture, as glTF numbers it
    uint32_t channels;    // of the image, 1 to 4
    const uint8_t *image; // encoded, instead of noise; or NULL
    size_t image_size;
} orm_asset;

orm_asset orm_asset_default(void);
/// Writes it as "asset.glb" in a new folder; gives the path (static).
const char *orm_asset_write(const orm_asset *asset);
/// The noise that image 0 holds.
uint8_t orm_asset_noise(uint32_t x, uint32_t y, uint32_t channel);
/// The noise as a JPEG of three channels, malloc'ed.
unsigned char *orm_asset_jpeg(size_t *size);

/// A bake of the asset into its own image.
typedef struct orm_bake {
    alp_context *context;
    alp_scene *scene, *result;
    alp_lightmap *lightmap;
    alp_bake_options options;
    char path[1024];
} orm_bake;
/// Writes and loads the asset; options may be changed before orm_run.
orm_bake orm_start(const orm_asset *asset);
/// Bakes to `path` and loads that.
void orm_run(orm_bake *bake);
void orm_stop(orm_bake *bake);
const alpi_gltf_document *orm_document(const alp_scene *scene);
/// A value of the written file, "" when absent (static).
const char *orm_text(const orm_bake *bake, const char *path);
/// The image that a material of the written file reads its occlusion from.
const alp_image *orm_image(const orm_bake *bake, int material);
/// Nothing of geometry was touched: not a byte of the meshes' text or of the old data.
void orm_check_meshes_kept(const orm_bake *bake);

#endif
