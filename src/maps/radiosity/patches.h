// SPDX-License-Identifier: MIT
// Light that leaves surfaces, kept on the texels of an atlas: the patches of radiosity.
//
// Each texel has a reflectance and, on each side that can be seen, a radiance, which rays look up
// where they hit: inside the chart of what they hit, never across its border. Light is gathered by
// blocks of texels of one chart, whose points lie all over the block: bounced light is smooth, and
// what is gathered for a block is the mean over it.
// Based on: H. Elias. Radiosity (patches with emission, reflectance, incident and excident light).
#ifndef ALPI_MAPS_PATCHES_H
#define ALPI_MAPS_PATCHES_H

#include "maps/texels/lattice.h"
#include "maps/texels/validity.h"
#include "transport/gather/gather.h"

/// Sides of a patch. Backs are those of double-sided materials.
typedef enum alpi_side { ALPI_FRONT = 0, ALPI_BACK = 1 } alpi_side;

/// Whether the backs of a block are seen, and so need light.
typedef enum alpi_back { ALPI_BACK_UNSEEN = 0, ALPI_BACK_SEEN, ALPI_BACK_LIT } alpi_back;

/// Where the points of a triangle are: in pixels at + b1 along + b2 across of its page. All that a
/// look needs of a triangle is here, side by side: most of them miss every cache.
typedef struct alpi_patch_triangle {
    float at[2], along[2], across[2];
    uint32_t chart;
    uint32_t page; // ALPI_NONE: it shows no light, as it has no chart
} alpi_patch_triangle;

/// What a ray finds at a pixel: one look instead of three, for most of them miss every cache.
typedef struct alpi_patch_place {
    uint32_t chart; // ALPI_NONE: no texel is there
    uint32_t texel; // whose light it shows: its own, or the nearest of its chart where it has none
} alpi_patch_place;

typedef struct alpi_patches {
    alp_context *context;
    const alp_scene *scene;
    const alp_atlas *atlas;
    const alpi_texels *texels;
    const alpi_lattice *lattice;
    const uint8_t *near;            // of the block rule, while blocks are made
    alpi_patch_triangle *triangles; // [triangles of the scene]
    alpi_patch_place *places;       // [pages][height][width]
    uint32_t *chart_texels;         // [charts] a texel of each, ALPI_NONE where it has none
    float (*reflectances)[3];       // [texels] albedo, mean over the texel
    float *emissions; // [texels] radiance of the front, mean over the texel and channels
    uint32_t block_count;
    uint32_t *blocks;                     // [texels] block of each; ALPI_NONE: no light of its own
    uint32_t *block_first, *block_texels; // texels of each block, one after the other
    float *block_ends;   // share of a block's area up to the end of each of those; the last is 1
    double *block_areas; // [blocks] m²
    bool two_sided; // some material is double-sided: then cells and receivers of backs follow those
                    // of fronts
    float (*cells)[4]; // [CELL_FIRST + sides × texels] radiance W·sr⁻¹·m⁻² that is reflected
    uint8_t *seen_backs; // [blocks] alpi_back, if two_sided; rays of many threads say SEEN
} alpi_patches;

/// How texels are put together.
typedef struct alpi_block_rule {
    uint32_t spacing;    // side of a block in texels, [1, 16]; 1: each texel is one
    const uint8_t *near; // [texels] alpi_nearness, or NULL. Near another surface bounced light
                         // changes fast: blocks are half as long there (texels, of an odd
                         // spacing), and texels where another surface touches one of theirs, or
                         // one lies in a solid in part
} alpi_block_rule;

/// @param order [count] texels with light of their own, neighbours together
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_patches_create(const alpi_lattice *lattice, const alp_atlas *atlas,
                               const uint32_t *order, uint32_t count, const alpi_block_rule *rule,
                               alpi_patches *patches);
void alpi_patches_destroy(alpi_patches *patches);
/// Keeps what it takes to look light up in the cells, and lets go of the rest: blocks, as receivers
/// too, and what texels reflect and emit.
/// @param lit_again whether the light in the cells will change: which block each texel is of, and
///     what it reflects, stay
void alpi_patches_settle(alpi_patches *patches, bool lit_again);
/// Whether those of a scene have backs.
bool alpi_patches_are_two_sided(const alp_scene *scene);

/// Texel, ALPI_NONE where there is none, that shows the light at a point.
uint32_t alpi_patches_find(const alpi_patches *patches, uint32_t triangle, float b1, float b2);

/// How gatherers see the light in `cells`.
alpi_surface_light alpi_patches_light(const alpi_patches *patches);
static inline uint32_t alpi_patches_cell(const alpi_patches *patches, uint32_t texel,
                                         alpi_side side)
{
    return ALPI_CELL_FIRST + (side == ALPI_BACK ? patches->texels->count : 0) + texel;
}

/// Texels as receivers: their fronts, then, if two_sided, their backs.
alpi_receivers alpi_patches_texel_receivers(const alpi_patches *patches);
/// Blocks as receivers, whose points are spread over their areas: fronts, then, if two_sided,
/// backs.
alpi_receivers alpi_patches_block_receivers(const alpi_patches *patches);

#endif
