// SPDX-License-Identifier: MIT
// Patches and cells: where radiosity gathers light, and where rays read it.
//
// A patch is a group of up to 4 × 4 texels of one chart. It gathers bounced light, which is smooth,
// once for all its texels: the mean over its area. A cell is the radiance that leaves one side of
// one texel. A ray reads the cell of the texel that it hits, and never a texel of another chart.
// Based on: H. Elias. Radiosity (patches with emission, reflectance, incident and excident light).
#ifndef ALPI_MAPS_PATCHES_H
#define ALPI_MAPS_PATCHES_H

#include "maps/texels/lattice.h"
#include "maps/texels/validity.h"
#include "transport/gather/gather.h"

/// Sides of a patch. Only double-sided materials have backs.
typedef enum alpi_side { ALPI_FRONT = 0, ALPI_BACK = 1 } alpi_side;

/// Whether rays meet the back of a patch: only those backs gather light.
typedef enum alpi_back { ALPI_BACK_UNSEEN = 0, ALPI_BACK_SEEN, ALPI_BACK_LIT } alpi_back;

/// Maps barycentrics to pixels of a page: at + b1 along + b2 across. One record holds all that a
/// look-up reads of a triangle, since most look-ups miss every cache.
typedef struct alpi_patch_triangle {
    float at[2], along[2], across[2];
    uint32_t chart;
    uint32_t page; // ALPI_NONE: the triangle has no chart and is black
} alpi_patch_triangle;

/// The texel that a ray reads at a pixel. One record saves two look-ups that miss every cache.
typedef struct alpi_patch_place {
    uint32_t chart; // ALPI_NONE: no texel is there
    uint32_t texel; // itself, or the nearest of its chart with light of its own
} alpi_patch_place;

typedef struct alpi_patches {
    alp_context *context;
    const alp_scene *scene;
    const alp_atlas *atlas;
    const alpi_texels *texels;
    const alpi_lattice *lattice;
    const uint8_t *proximity;       // borrowed by alpi_patches_create, NULL after it
    alpi_patch_triangle *triangles; // [triangles of the scene]
    alpi_patch_place *places;       // [pages][height][width]
    uint32_t *chart_texels;         // [charts] a texel of each, ALPI_NONE where it has none
    float (*reflectances)[3];       // [texels] albedo, mean over the texel
    float *emissions; // [texels] radiance of the front, mean over the texel and channels
    uint32_t patch_count;
    uint32_t *patch_of;     // [texels] patch of each; ALPI_NONE: no light of its own
    uint32_t *patch_first;  // [patches + 1] where the texels of each begin in patch_texels
    uint32_t *patch_texels; // texels of all patches, one patch after the other
    float *patch_ends;      // share of a patch's area up to the end of each of those; the last is 1
    double *patch_areas;    // [patches] m²
    bool two_sided;      // any material is double-sided; cells and receivers of backs then follow
                         // those of fronts
    float (*cells)[4];   // [CELL_FIRST + sides × texels] reflected radiance W·sr⁻¹·m⁻²
    uint8_t *seen_backs; // [patches] alpi_back, if two_sided; look-ups set SEEN atomically
} alpi_patches;

enum { ALPI_PATCH_SIDE = 4 }; // texels

/// Bounced light changes fast near other surfaces: there, the side of patches is halved. It is 1
/// where a surface touches any of the texels, or any lies partly in a solid.
/// @param proximity [texels] alpi_proximity, or NULL: all are far
/// @param order [count] texels with light of their own, neighbours together
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_patches_create(const alpi_lattice *lattice, const alp_atlas *atlas,
                               const uint32_t *order, uint32_t count, const uint8_t *proximity,
                               alpi_patches *patches);
void alpi_patches_destroy(alpi_patches *patches);
/// Frees all but the data of look-ups: the patches, also as receivers, and materials.
/// @param relit whether cells will be lit again: patch_of and reflectances then stay
void alpi_patches_trim(alpi_patches *patches, bool relit);
/// Whether any material of a scene is double-sided.
bool alpi_patches_are_two_sided(const alp_scene *scene);

/// The texel that shows the light at a point; ALPI_NONE: none does.
uint32_t alpi_patches_find(const alpi_patches *patches, uint32_t triangle, float b1, float b2);

/// The light in the cells, for gatherers.
alpi_surface_light alpi_patches_light(const alpi_patches *patches);
static inline uint32_t alpi_patches_cell(const alpi_patches *patches, uint32_t texel,
                                         alpi_side side)
{
    return ALPI_CELL_FIRST + (side == ALPI_BACK ? patches->texels->count : 0) + texel;
}

/// Texels as receivers: fronts, then backs if two_sided.
alpi_receivers alpi_patches_texel_receivers(const alpi_patches *patches);
/// Patches as receivers, with points spread over their areas: fronts, then backs if two_sided.
alpi_receivers alpi_patches_receivers(const alpi_patches *patches);

#endif
