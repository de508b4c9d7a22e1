// SPDX-License-Identifier: MIT
// Tables of the look-up: the texel that rays read at each pixel of a page.
#include "maps/radiosity/patch_lookup.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/radiosity/patch_create.h"

static alpi_patch_place *place_of(const alpi_patches *p, uint32_t texel)
{
    const uint16_t *pixel = p->texels->pixels[texel];
    return &p->places[alpi_lattice_pixel(p->lattice, p->texels->pages[texel], pixel[0], pixel[1])];
}

/// Whether a texel belongs to a chart and has light of its own.
static bool has_own_light(const alpi_patches *p, uint32_t texel, uint32_t chart)
{
    const alpi_patch_place *place = place_of(p, texel);
    return place->chart == chart && place->texel == texel;
}

/// The nearest texel of a chart with light of its own, up to `rings` pixels away; else ALPI_NONE.
static uint32_t find_nearest(const alpi_patches *p, uint32_t page, int64_t x, int64_t y,
                             uint32_t chart, int rings)
{
    uint32_t best = ALPI_NONE;
    int best_distance = INT32_MAX;
    for (int dy = -rings; dy <= rings; dy++) {
        for (int dx = -rings; dx <= rings; dx++) {
            const uint32_t t = alpi_lattice_texel(p->lattice, page, x + dx, y + dy);
            const int distance = dx * dx + dy * dy;
            if (t != ALPI_NONE && distance < best_distance && has_own_light(p, t, chart)) {
                best = t;
                best_distance = distance;
            }
        }
    }
    return best;
}

/// Fills the places of texels with light of their own, with themselves.
static alp_result find_own_places(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_patches *p = user;
    for (uint32_t t = begin; t < end; t++) {
        const bool lit = p->patch_of[t] != ALPI_NONE;
        *place_of(p, t) = (alpi_patch_place){p->texels->charts[t], lit ? t : ALPI_NONE};
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
        const uint16_t *pixel = texels->pixels[t];
        const uint32_t chart = texels->charts[t];
        if (p->patch_of[t] != ALPI_NONE) {
            continue;
        }
        alpi_patch_place *place = place_of(p, t);
        place->texel = find_nearest(p, texels->pages[t], pixel[0], pixel[1], chart, RINGS);
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

uint32_t alpi_patches_find_nearest(const alpi_patches *p, const alpi_patch_triangle *t, float b1,
                                   float b2)
{
    int32_t at[2];
    alpi_patches_pixel(t, b1, b2, at);
    const uint32_t nearest = find_nearest(p, t->page, at[0], at[1], t->chart, 1);
    return nearest != ALPI_NONE ? nearest : p->chart_texels[t->chart];
}
