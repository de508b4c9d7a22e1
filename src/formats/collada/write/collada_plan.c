// SPDX-License-Identifier: MIT
// What a bake changes in a COLLADA document: a geometry that is shown several times with maps of
// its own is copied, because its coordinates are part of it.
#include "formats/collada/write/collada_patch.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

/// Triangles without area follow their neighbour, so that no piece is made for them.
static void find_pages(alpi_collada_patcher *p, uint32_t surface)
{
    const alp_scene *scene = p->scene;
    const alpi_surface *s = &scene->surfaces[surface];
    uint32_t first = ALPI_NONE;
    for (uint32_t i = 0; i < s->triangle_count && first == ALPI_NONE; i++) {
        const uint32_t t = s->first_triangle + i;
        const uint32_t page = p->patch->triangle_pages == NULL ? 0 : p->patch->triangle_pages[t];
        first = scene->triangle_usable[t] ? page : ALPI_NONE;
    }
    uint32_t last = first;
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        const uint32_t t = s->first_triangle + i;
        const uint32_t page = p->patch->triangle_pages == NULL ? 0 : p->patch->triangle_pages[t];
        last = scene->triangle_usable[t] && page != ALPI_NONE ? page : last;
        p->pages[t] = last;
    }
    const bool keeps = p->patch->existing_ao == ALPI_EXISTING_AO_KEEP && s->material != ALPI_NONE &&
                       scene->materials[s->material].occlusion_texture.image != ALPI_NONE &&
                       p->patch->light == NULL;
    p->baked[surface] = first != ALPI_NONE && !keeps;
}

/// The placement whose coordinates a placement shows; ALPI_NONE: it gets no map.
static uint32_t find_key(const alpi_collada_patcher *p, uint32_t placement)
{
    for (uint32_t s = p->first_surfaces[placement]; s < p->first_surfaces[placement + 1]; s++) {
        if (p->baked[s]) {
            const uint32_t own = p->patch->originals != NULL ? p->patch->originals[s] : s;
            return p->scene->surfaces[own].node;
        }
    }
    return ALPI_NONE;
}

static void find_first_surfaces(alpi_collada_patcher *p)
{
    uint32_t s = 0;
    for (uint32_t i = 0; i < p->origin->placement_count; i++) {
        p->first_surfaces[i] = s;
        while (s < p->scene->surface_count && p->scene->surfaces[s].node == i) {
            s++;
        }
    }
    p->first_surfaces[p->origin->placement_count] = s;
}

/// The copy of a mesh that a skin deforms would need a copy of the skin: such are left out.
static void leave_out_controllers(const alpi_collada_patcher *p, const uint32_t *mesh_keys,
                                  uint32_t *keys)
{
    uint32_t left_out = 0;
    for (uint32_t i = 0; i < p->origin->placement_count; i++) {
        const uint32_t first = p->first_surfaces[i];
        if (first < p->first_surfaces[i + 1] && keys[i] != ALPI_NONE &&
            alpi_xml_is(p->origin->surfaces[first].instance, "instance_controller") &&
            mesh_keys[p->scene->surfaces[first].mesh] == ALPI_COLLADA_SHARED) {
            keys[i] = ALPI_NONE;
            left_out++;
        }
    }
    if (left_out > 0) {
        alpi_warn(p->context, "skin", p->document->path,
                  "deformed meshes with several instances whose maps differ, written without a "
                  "map: %u; bake them one by one with --only",
                  left_out);
    }
}

/// keys[i] of placements; mesh_keys: the only key of each mesh, SHARED = several.
static alp_result make_classes(alpi_collada_patcher *p, uint32_t *keys, uint32_t *mesh_keys,
                               uint32_t *class_of_key)
{
    const uint32_t count = p->origin->placement_count;
    const uint32_t none = ALPI_COLLADA_SHARED - 1;
    for (int pass = 0; pass < 2; pass++) { // what is left out in the first counts in the second
        memset(mesh_keys, 0, count * sizeof *mesh_keys);
        for (uint32_t i = 0; i < count; i++) {
            if (p->first_surfaces[i] < p->first_surfaces[i + 1]) {
                uint32_t *of_mesh = &mesh_keys[p->scene->surfaces[p->first_surfaces[i]].mesh];
                const uint32_t key = keys[i] == ALPI_NONE ? none : keys[i] + 1;
                *of_mesh = *of_mesh == 0 || *of_mesh == key ? key : ALPI_COLLADA_SHARED;
            }
        }
        if (pass == 0 && p->patch->corner_uvs != NULL) {
            leave_out_controllers(p, mesh_keys, keys);
        }
    }
    ALPI_TRY_NEW(p->context, p->classes, count);
    for (uint32_t i = 0; i < count; i++) {
        p->placement_class[i] = ALPI_NONE;
        if (keys[i] == ALPI_NONE) {
            continue;
        }
        uint32_t *class_of = &class_of_key[keys[i]];
        if (*class_of == 0) {
            const uint32_t first = p->first_surfaces[keys[i]];
            p->classes[p->class_count] = (alpi_collada_class){
                .geometry = p->origin->surfaces[first].geometry,
                .first_surface = first,
                .surface_end = p->first_surfaces[keys[i] + 1],
                .copied = mesh_keys[p->scene->surfaces[first].mesh] == ALPI_COLLADA_SHARED};
            *class_of = ++p->class_count;
        }
        p->placement_class[i] = *class_of - 1;
    }
    return ALP_OK;
}

/// Of a geometry that only baked placements show, the first class keeps the geometry itself.
static void keep_first_classes(alpi_collada_patcher *p, const uint32_t *keys, uint32_t *mesh_marks)
{
    enum { UNSEEN, TAKEN };
    memset(mesh_marks, 0, p->origin->placement_count * sizeof *mesh_marks);
    for (uint32_t i = 0; i < p->origin->placement_count; i++) {
        if (keys[i] == ALPI_NONE && p->first_surfaces[i] < p->first_surfaces[i + 1]) {
            mesh_marks[p->scene->surfaces[p->first_surfaces[i]].mesh] = TAKEN;
        }
    }
    for (uint32_t c = 0; c < p->class_count; c++) {
        uint32_t *mark = &mesh_marks[p->scene->surfaces[p->classes[c].first_surface].mesh];
        p->classes[c].copied = *mark == TAKEN;
        *mark = TAKEN;
    }
}

alp_result alpi_collada_plan(alpi_collada_patcher *p)
{
    const alp_scene *scene = p->scene;
    const uint32_t count = p->origin->placement_count;
    ALPI_TRY_NEW(p->context, p->pages, scene->triangle_count);
    ALPI_TRY_NEW(p->context, p->baked, scene->surface_count);
    ALPI_TRY_NEW(p->context, p->first_surfaces, (size_t)count + 1);
    ALPI_TRY_NEW(p->context, p->placement_class, count);
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        find_pages(p, s);
    }
    find_first_surfaces(p);
    uint32_t *keys = ALPI_NEW(p->context, uint32_t, count);
    uint32_t *mesh_keys = ALPI_NEW(p->context, uint32_t, count); // every mesh has a placement
    uint32_t *class_of_key = ALPI_NEW(p->context, uint32_t, count);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (keys != NULL && mesh_keys != NULL && class_of_key != NULL) {
        for (uint32_t i = 0; i < count; i++) {
            keys[i] = find_key(p, i);
        }
        result = make_classes(p, keys, mesh_keys, class_of_key);
        if (result == ALP_OK) {
            keep_first_classes(p, keys, mesh_keys);
        }
    }
    alpi_release(p->context, keys);
    alpi_release(p->context, mesh_keys);
    alpi_release(p->context, class_of_key);
    return result;
}

alpi_collada_symbol *alpi_collada_get_symbol(alpi_collada_patcher *p, alpi_collada_class *c,
                                             const char *old, uint32_t page, uint32_t surface)
{
    bool taken = false;
    for (uint32_t i = 0; i < c->symbol_count; i++) {
        const char *other = c->symbols[i].old;
        if (old == NULL ? other == NULL : other != NULL && strcmp(other, old) == 0) {
            if (c->symbols[i].page == page) {
                return &c->symbols[i];
            }
            taken = true;
        }
    }
    if (alpi_collada_grow(p->context, &c->symbols, &c->symbol_capacity, c->symbol_count + 1,
                          sizeof *c->symbols) != ALP_OK) {
        return NULL;
    }
    char *name = old == NULL ? alpi_format(p->context, "%s-%u", p->prefix, page)
                 : taken     ? alpi_format(p->context, "%s-%s-%u", old, p->prefix, page)
                             : alpi_copy_string(p->context, old);
    if (name == NULL) {
        return NULL;
    }
    p->endings |= old == NULL || taken;
    c->symbols[c->symbol_count] =
        (alpi_collada_symbol){.old = old, .name = name, .page = page, .surface = surface};
    return &c->symbols[c->symbol_count++];
}
