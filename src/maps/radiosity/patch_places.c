// SPDX-License-Identifier: MIT
// Tables of the look-up: the texel that rays read at each pixel of a page.
#include "maps/radiosity/patch_lookup.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/radiosity/patch_create.h"

/// Fills the places of texels with light of their own, with themselves.
static alp_result find_own_places(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_patches *p = user;
    for (uint32_t t = begin; t < end; t++) {
        const bool lit = p->patch_of[t] != ALPI_NONE;
        *alpi_patches_own_place(p, t) =
            (alpi_patch_place){p->texels->charts[t], lit ? t : ALPI_NONE};
    }
    return ALP_OK;
}

/// Finds a texel of each chart, and fills the other places with the nearest texel of their chart.
static void find_other_places(const alpi_patches *p)
{
    enum { RINGS = 3 };
    const alpi_texels *texels = p->texels;
    for (uint32_t t = 0; t < texels->count; t++) {
        const uint32_t chart = texels->charts[t];
        if (chart != ALPI_NONE && p->chart_texels[chart] == ALPI_NONE &&
            p->patch_of[t] != ALPI_NONE) {
            p->chart_texels[chart] = t;
        }
    }
    for (uint32_t t = 0; t < texels->count; t++) {
        const int32_t pixel[2] = {texels->pixels[t][0], texels->pixels[t][1]};
        const uint32_t chart = texels->charts[t];
        if (p->patch_of[t] != ALPI_NONE) {
            continue;
        }
        alpi_patch_place *place = alpi_patches_own_place(p, t);
        place->texel = alpi_patches_search(p, texels->pages[t], pixel, chart, RINGS);
        if (place->texel == ALPI_NONE && chart != ALPI_NONE) {
            place->texel = p->chart_texels[chart];
        }
    }
}

static alp_result find_triangles(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_patches *p = user;
    const float size[2] = {(float)p->lattice->width, (float)p->lattice->height};
    for (uint32_t i = begin; i < end; i++) {
        const float(*uv)[2] = (const float(*)[2])p->atlas->corner_uvs[i];
        alpi_patch_triangle *t = &p->triangles[i];
        t->chart = p->atlas->triangle_charts[i];
        t->page = t->chart != ALPI_NONE ? p->atlas->triangle_pages[i] : ALPI_NONE;
        for (int k = 0; k < 2; k++) {
            t->at[k] = uv[0][k] * size[k];
            t->along[k] = (uv[1][k] - uv[0][k]) * size[k];
            t->across[k] = (uv[2][k] - uv[0][k]) * size[k];
        }
    }
    return ALP_OK;
}

alp_result alpi_patch_places_create(alpi_patches *patches)
{
    enum { TRIANGLES_PER_RANGE = 4096, TEXELS_PER_RANGE = 4096 };
    const alpi_task_progress progress = {.stage = "light"};
    const uint32_t triangles = patches->scene->triangle_count;
    ALPI_TRY_NEW(patches->context, patches->triangles, triangles);
    ALP_TRY(alpi_parallel_for(patches->context, patches->texels->count, TEXELS_PER_RANGE,
                              find_own_places, patches, NULL));
    find_other_places(patches);
    ALP_TRY(alpi_tick(patches->context, "light", 0, 1));
    return alpi_parallel_for(patches->context, triangles, TRIANGLES_PER_RANGE, find_triangles,
                             patches, &progress);
}
