// SPDX-License-Identifier: MIT
#include "maps/radiosity/patches.h"

#include "base/memory.h"
#include "maps/radiosity/patch_create.h"

#include <string.h>

bool alpi_patches_are_two_sided(const alp_scene *scene)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        if (scene->materials[i].double_sided) {
            return true;
        }
    }
    return false;
}

static uint32_t count_charts(const alpi_patches *p)
{
    uint32_t count = 0;
    for (uint32_t t = 0; t < alpi_atlas_face_count(p->atlas); t++) {
        const uint32_t chart = p->atlas->triangle_charts[t];
        count = chart != ALPI_NONE && chart >= count ? chart + 1 : count;
    }
    return count;
}

/// Shrinks an array. @return ALP_OK; OUT_OF_MEMORY
static alp_result shrink(alp_context *context, void **items, size_t count, size_t size)
{
    void *fewer = alpi_reallocate(context, *items, count, size);
    if (fewer == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *items = fewer;
    return ALP_OK;
}

/// Allocates for as many patches as texels, the most there can be.
static alp_result allocate_most(alpi_patches *p, uint32_t count)
{
    const uint32_t texels = p->texels->count;
    const size_t pixels = (size_t)p->lattice->page_count * p->lattice->width * p->lattice->height;
    ALPI_TRY_NEW(p->context, p->places, pixels);
    memset(p->places, 0xff, pixels * sizeof *p->places);
    ALPI_TRY_NEW(p->context, p->patch_of, texels);
    ALPI_TRY_NEW(p->context, p->patch_first, (size_t)count + 1);
    ALPI_TRY_NEW(p->context, p->patch_texels, count);
    ALPI_TRY_NEW(p->context, p->patch_ends, count);
    ALPI_TRY_NEW(p->context, p->patch_areas, count);
    return ALP_OK;
}

/// Allocates the arrays whose size the number of patches decides.
static alp_result allocate_rest(alpi_patches *p)
{
    const size_t texels = p->texels->count, sides = p->two_sided ? 2 : 1;
    ALP_TRY(shrink(p->context, (void **)&p->patch_first, (size_t)p->patch_count + 1,
                   sizeof *p->patch_first));
    ALP_TRY(shrink(p->context, (void **)&p->patch_areas, p->patch_count, sizeof *p->patch_areas));
    ALPI_TRY_NEW(p->context, p->seen_backs, p->two_sided ? p->patch_count : 0);
    ALPI_TRY_NEW(p->context, p->reflectances, texels);
    ALPI_TRY_NEW(p->context, p->emissions, texels);
    ALPI_TRY_NEW(p->context, p->cells, ALPI_CELL_FIRST + sides * texels);
    return ALP_OK;
}

static alp_result create(alpi_patches *p, const uint32_t *order, uint32_t count)
{
    const uint32_t texels = p->texels->count, charts = count_charts(p);
    ALP_TRY(allocate_most(p, count));
    ALPI_TRY_NEW(p->context, p->chart_texels, charts);
    memset(p->patch_of, 0xff, texels * sizeof *p->patch_of);
    memset(p->chart_texels, 0xff, charts * sizeof *p->chart_texels);
    for (uint32_t i = 0; i < count; i++) {
        p->patch_of[order[i]] = 0; // not ALPI_NONE: to be grouped
    }
    ALP_TRY(alpi_patches_split(p));
    ALP_TRY(allocate_rest(p));
    ALP_TRY(alpi_patch_places_create(p));
    return alpi_patches_measure_materials(p);
}

alp_result alpi_patches_create(const alpi_lattice *lattice, const alp_atlas *atlas,
                               const uint32_t *order, uint32_t count, const uint8_t *proximity,
                               alpi_patches *patches)
{
    *patches = (alpi_patches){.context = lattice->context,
                              .scene = atlas->scene,
                              .atlas = atlas,
                              .texels = lattice->texels,
                              .lattice = lattice,
                              .proximity = proximity,
                              .two_sided = alpi_patches_are_two_sided(atlas->scene)};
    const alp_result result = create(patches, order, count);
    patches->proximity = NULL;
    if (result != ALP_OK) {
        alpi_patches_destroy(patches);
    }
    return result;
}

void alpi_patches_trim(alpi_patches *patches, bool relit)
{
    alp_context *context = patches->context;
    alpi_release(context, patches->emissions);
    alpi_release(context, patches->patch_first);
    alpi_release(context, patches->patch_texels);
    alpi_release(context, patches->patch_ends);
    alpi_release(context, patches->patch_areas);
    patches->patch_ends = patches->emissions = NULL;
    patches->patch_first = patches->patch_texels = NULL;
    patches->patch_areas = NULL;
    if (!relit) {
        alpi_release(context, patches->reflectances);
        patches->reflectances = NULL;
    }
    if (!relit && !patches->two_sided) { // look-ups of backs read patch_of
        alpi_release(context, patches->patch_of);
        patches->patch_of = NULL;
    }
}

void alpi_patches_destroy(alpi_patches *patches)
{
    alp_context *context = patches->context;
    if (context == NULL) {
        return;
    }
    alpi_release(context, patches->triangles);
    alpi_release(context, patches->places);
    alpi_release(context, patches->chart_texels);
    alpi_release(context, patches->reflectances);
    alpi_release(context, patches->emissions);
    alpi_release(context, patches->patch_of);
    alpi_release(context, patches->patch_first);
    alpi_release(context, patches->patch_texels);
    alpi_release(context, patches->patch_ends);
    alpi_release(context, patches->patch_areas);
    alpi_release(context, patches->seen_backs);
    alpi_release(context, patches->cells);
    *patches = (alpi_patches){0};
}
