// SPDX-License-Identifier: MIT
// Look-up of light: from a hit to its pixel, its texel and its cell. patch_lookup.c also implements
// alpi_patches_find and alpi_patches_light of patches.h.
#ifndef ALPI_MAPS_PATCH_LOOKUP_H
#define ALPI_MAPS_PATCH_LOOKUP_H

#include "maps/radiosity/patches.h"

/// The pixel of a point of a triangle, which may be off the page.
static inline void alpi_patches_pixel(const alpi_patch_triangle *t, float b1, float b2,
                                      int32_t at[2])
{
    for (int k = 0; k < 2; k++) {
        at[k] = (int32_t)(t->at[k] + b1 * t->along[k] + b2 * t->across[k]);
    }
}

/// The place of a point; NULL: off the page, or on none.
static inline const alpi_patch_place *
alpi_patches_place_at(const alpi_patches *p, const alpi_patch_triangle *t, float b1, float b2)
{
    const alpi_lattice *l = p->lattice;
    int32_t at[2];
    alpi_patches_pixel(t, b1, b2, at);
    const uint32_t x = (uint32_t)at[0], y = (uint32_t)at[1]; // below 0: large
    const bool on = t->page != ALPI_NONE && x < l->width && y < l->height;
    return on ? &p->places[alpi_lattice_pixel(l, t->page, x, y)] : NULL;
}

/// The place at the pixel of a texel.
static inline alpi_patch_place *alpi_patches_own_place(const alpi_patches *p, uint32_t texel)
{
    const uint16_t *pixel = p->texels->pixels[texel];
    return &p->places[alpi_lattice_pixel(p->lattice, p->texels->pages[texel], pixel[0], pixel[1])];
}

/// The nearest texel of a chart with light of its own, up to `rings` pixels away; else ALPI_NONE.
uint32_t alpi_patches_search(const alpi_patches *p, uint32_t page, const int32_t at[2],
                             uint32_t chart, int rings);
/// The texel of a point whose pixel is off its chart. The chart may still cover a corner of it.
uint32_t alpi_patches_find_nearest(const alpi_patches *p, const alpi_patch_triangle *t, float b1,
                                   float b2);

/// The cell of a side of a texel. Marks a back as seen.
static inline uint32_t alpi_patches_side_cell(const alpi_patches *p, uint32_t texel, bool behind)
{
    if (texel == ALPI_NONE) {
        return ALPI_CELL_BLACK;
    }
    if (!behind) {
        return alpi_patches_cell(p, texel, ALPI_FRONT);
    }
    if (!p->two_sided) {
        return ALPI_CELL_BLACK;
    }
    uint8_t *seen = &p->seen_backs[p->patch_of[texel]];
    if (__atomic_load_n(seen, __ATOMIC_RELAXED) == ALPI_BACK_UNSEEN) {
        __atomic_store_n(seen, ALPI_BACK_SEEN, __ATOMIC_RELAXED);
    }
    return alpi_patches_cell(p, texel, ALPI_BACK);
}

/// Cells of packets (alpi_light_cells_fn), with the same result on every instruction set.
alpi_light_cells_fn alpi_patches_find_cells_baseline, alpi_patches_find_cells_v3;

#endif
