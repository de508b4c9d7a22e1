// SPDX-License-Identifier: MIT
#include "maps/radiosity/patch_lookup.h"

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
