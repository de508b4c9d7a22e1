// SPDX-License-Identifier: MIT
#include "maps/radiosity/patch_lookup.h"

/// Whether a texel belongs to a chart and has light of its own.
static bool has_own_light(const alpi_patches *p, uint32_t texel, uint32_t chart)
{
    const alpi_patch_place *place = alpi_patches_own_place(p, texel);
    return place->chart == chart && place->texel == texel;
}

uint32_t alpi_patches_search(const alpi_patches *p, uint32_t page, const int32_t at[2],
                             uint32_t chart, int rings)
{
    uint32_t best = ALPI_NONE;
    int best_distance = INT32_MAX;
    for (int dy = -rings; dy <= rings; dy++) {
        for (int dx = -rings; dx <= rings; dx++) {
            const uint32_t t =
                alpi_lattice_texel(p->lattice, page, (int64_t)at[0] + dx, (int64_t)at[1] + dy);
            const int distance = dx * dx + dy * dy;
            if (t != ALPI_NONE && distance < best_distance && has_own_light(p, t, chart)) {
                best = t;
                best_distance = distance;
            }
        }
    }
    return best;
}

uint32_t alpi_patches_find_nearest(const alpi_patches *p, const alpi_patch_triangle *t, float b1,
                                   float b2)
{
    int32_t at[2];
    alpi_patches_pixel(t, b1, b2, at);
    const uint32_t nearest = alpi_patches_search(p, t->page, at, t->chart, 1);
    return nearest != ALPI_NONE ? nearest : p->chart_texels[t->chart];
}

uint32_t alpi_patches_find(const alpi_patches *patches, uint32_t triangle, float b1, float b2)
{
    const alpi_patch_triangle *t = &patches->triangles[triangle];
    if (t->page == ALPI_NONE) {
        return ALPI_NONE;
    }
    const alpi_patch_place *place = alpi_patches_place_at(patches, t, b1, b2);
    return place != NULL && place->chart == t->chart
               ? place->texel
               : alpi_patches_find_nearest(patches, t, b1, b2);
}

static void read_cells(const void *user, const alpi_surface_point *points, uint32_t count,
                       vec3 *radiance)
{
    const alpi_patches *p = user;
    for (uint32_t i = 0; i < count; i++) {
        const alpi_surface_point *s = &points[i];
        const uint32_t texel = alpi_patches_find(p, s->triangle, s->b1, s->b2);
        radiance[i] = vec3_load(p->cells[alpi_patches_side_cell(p, texel, s->from_behind)]);
    }
}

alpi_surface_light alpi_patches_light(const alpi_patches *patches)
{
    return (alpi_surface_light){.reflected = read_cells,
                                .user = patches,
                                .find =
                                    ALPI_COMPILED_FOR(patches->context, alpi_patches_find_cells),
                                .cells = (const float(*)[4])patches->cells};
}
