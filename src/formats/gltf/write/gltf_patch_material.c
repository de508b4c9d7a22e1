// SPDX-License-Identifier: MIT
// Materials: each (old material, page, coordinate set) in use needs one. The first of an old
// material is that material itself, unless something that gets no map uses it too.
#include "formats/gltf/write/gltf_patch_material.h"

#include "base/memory.h"
#include "base/plural.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_appends.h"
#include "formats/gltf/write/gltf_patch_plan.h"
#include "formats/gltf/write/gltf_patch_sets.h"
#include "formats/gltf/write/gltf_patch_users.h"

#include <stdio.h>
#include <string.h>

/// A material that the written file needs.
typedef struct need {
    size_t old;    // ALPI_GLTF_NONE = the primitive had none
    uint32_t page; // ALPI_NONE: packed into an image
    uint32_t sets[ALPI_GLTF_BLEND_SETS];
    bool occluded, lit, cleared;
    float light_scale; // what 1 in the light's image stands for
    size_t written;
} need;

typedef struct needs {
    need *items;
    size_t count, capacity;
    bool *has_other_users; // [materials of the document]
    bool *edited;          // [materials of the document] has become one of the needs
} needs;

// --- images and textures -------------------------------------------------------------------------

static size_t add_page_image(alpi_gltf_patcher *p, uint32_t page)
{
    char name[32];
    snprintf(name, sizeof name, "occlusion %u", page);
    return alpi_patcher_add_image(p, name, page, p->patch->page_pngs[page],
                                  p->patch->page_png_sizes[page]);
}

/// The texture of a page, made at its first use.
static size_t page_texture(alpi_gltf_patcher *p, uint32_t page)
{
    if (p->page_textures[page] == ALPI_GLTF_NONE) {
        p->page_textures[page] = alpi_patcher_add_texture(p, add_page_image(p, page));
    }
    return p->page_textures[page];
}

// --- materials -----------------------------------------------------------------------------------

static void print_texture(alpi_gltf_patcher *p, const need *n, alpi_bytes *value)
{
    alpi_bytes_print(value, "{\"index\":%zu", page_texture(p, n->page));
    if (n->sets[0] != 0) {
        alpi_bytes_print(value, ",\"texCoord\":%u", n->sets[0]);
    }
    if (p->patch->occlusion_strength != 1.0f) {
        alpi_bytes_print(value, ",\"strength\":");
        alpi_bytes_number(value, (double)p->patch->occlusion_strength, 9);
    }
    alpi_bytes_print(value, "}");
}

static alpi_gltf_light_use light_use(const need *n, const char *blend)
{
    return (alpi_gltf_light_use){n->old, n->page, n->sets[0], n->light_scale, blend};
}

/// Takes the occlusion map from a material of the document. A material that has nothing else gets a
/// member of its default value, because others may be added behind it.
static void clear_occlusion(alpi_gltf_patcher *p, size_t material, alpi_edits *edits)
{
    static const char *const names[] = {"occlusionTexture"};
    const alpi_json_span span = p->lists[ALPI_GLTF_MATERIALS].spans[material];
    alpi_json_cursor cursor = alpi_json_open(p->document->text, span);
    const bool first = alpi_json_next(&cursor);
    const alpi_json_span member = {cursor.key.begin, cursor.value.end};
    p->cleared_count++;
    if (first && !alpi_json_next(&cursor)) {
        alpi_edits_replace(edits, member, "\"doubleSided\":false");
    } else {
        alpi_edits_remove_all(edits, span, names, 1);
    }
}

/// Makes a material of the document read the map. The whole occlusionTexture is replaced, so that
/// no KHR_texture_transform of the old one remains.
static alp_result edit_material(alpi_gltf_patcher *p, const need *n, const char *blend,
                                alpi_edits *edits)
{
    const bool packed = n->page == ALPI_NONE;
    const alpi_gltf_maps replaced = {packed || n->occluded, !packed && n->lit, n->cleared};
    if (packed || blend == NULL) {
        alpi_patcher_unblend_material(p, n->old, replaced, edits);
    }
    if (packed) {
        return alpi_patcher_pack_material(p, n->old, edits);
    }
    const bool named = n->lit && p->patch->light->form == ALPI_LIGHT_FORM_EXTRAS; // with the light
    if (blend != NULL && !named) {
        alpi_patcher_blend_material(p, n->old, blend, edits);
    }
    if (n->occluded) {
        alpi_bytes value = alpi_bytes_create(p->context);
        print_texture(p, n, &value);
        p->data.failed |= value.failed;
        alpi_edits_set(edits, p->lists[ALPI_GLTF_MATERIALS].spans[n->old], "occlusionTexture",
                       value.bytes, value.size);
        alpi_bytes_destroy(&value);
    }
    if (n->cleared) {
        clear_occlusion(p, n->old, edits);
    }
    if (n->lit) {
        const alpi_gltf_light_use use = light_use(n, blend);
        alpi_patcher_light_material(p, &use, edits);
    }
    return ALP_OK;
}

/// A material for a primitive without one. It looks like glTF's default material; the mark tells a
/// later reading that there was none.
static void print_new_material(alpi_gltf_patcher *p, const need *n, const char *blend,
                               alpi_bytes *text)
{
    alpi_bytes members = alpi_bytes_create(p->context);
    alpi_bytes_print(&members, "\"alpenglow\":\"" ALPI_GLTF_NO_MATERIAL "\"");
    if (blend != NULL) {
        alpi_bytes_print(&members, ",\"" ALPI_GLTF_BLEND "\":%s", blend);
    }
    const char *mark = members.failed ? "" : (const char *)members.bytes;
    p->data.failed |= members.failed;
    alpi_bytes_print(text, "{");
    if (n->occluded) {
        alpi_bytes_print(text, "\"occlusionTexture\":");
        print_texture(p, n, text);
        alpi_bytes_print(text, ",");
    }
    if (n->lit) {
        const alpi_gltf_light_use use = light_use(n, blend);
        alpi_patcher_print_light(p, &use, mark, text);
    } else {
        alpi_bytes_print(text, "\"extras\":{%s}", mark);
    }
    alpi_bytes_print(text, "}");
    alpi_bytes_destroy(&members);
}

static alp_result note_copy(alpi_gltf_patcher *p, size_t old, size_t written)
{
    void *items = p->copies;
    ALP_TRY(alpi_grow(p->context, &items, &p->copy_capacity, p->copy_count + 1, sizeof *p->copies));
    p->copies = items;
    p->copies[p->copy_count++] = (alpi_gltf_material_copy){old, written};
    return ALP_OK;
}

/// Puts the map into a material: the one of the document, a copy of it, or a new one.
static alp_result write_material(alpi_gltf_patcher *p, needs *all, need *n)
{
    alpi_bytes sets = alpi_bytes_create(p->context);
    if (p->patch->set_uvs != NULL) {
        const alpi_gltf_maps maps = {n->occluded, n->lit, n->cleared};
        alpi_patcher_print_blend(p, n->old, n->sets, maps, &sets);
    }
    const char *blend = sets.size > 0 ? (const char *)sets.bytes : NULL;
    alpi_bytes text = alpi_bytes_create(p->context);
    alp_result result = ALP_OK;
    if (n->old == ALPI_GLTF_NONE) {
        print_new_material(p, n, blend, &text);
        n->written = alpi_patcher_append(p, ALPI_GLTF_MATERIALS, text.bytes, text.size);
    } else {
        alpi_json_span span = p->lists[ALPI_GLTF_MATERIALS].spans[n->old];
        if (!all->has_other_users[n->old] && !all->edited[n->old]) {
            n->written = n->old;
            result = edit_material(p, n, blend, &p->edits);
        } else {
            alpi_edits copy = alpi_edits_create(p->context, p->document->text);
            result = edit_material(p, n, blend, &copy);
            result = result == ALP_OK ? alpi_edits_apply(&copy, span, &text) : result;
            result = result == ALP_OK ? alpi_patcher_mark_copy(p, n->old, &text) : result;
            n->written = alpi_patcher_append(p, ALPI_GLTF_MATERIALS, text.bytes, text.size);
            result = result == ALP_OK ? note_copy(p, n->old, n->written) : result;
            alpi_edits_destroy(&copy);
        }
        all->edited[n->old] = true;
    }
    p->data.failed |= text.failed || sets.failed;
    alpi_bytes_destroy(&text);
    alpi_bytes_destroy(&sets);
    return result;
}

static bool same_need(const need *a, const need *b)
{
    return a->old == b->old && a->page == b->page &&
           memcmp(a->sets, b->sets, sizeof a->sets) == 0 && a->light_scale == b->light_scale;
}

static alp_result find_material(alpi_gltf_patcher *p, needs *all, const need *wanted,
                                size_t *written)
{
    for (size_t i = 0; i < all->count; i++) {
        const need *n = &all->items[i];
        if (same_need(n, wanted)) {
            *written = n->written;
            return ALP_OK;
        }
    }
    void *items = all->items;
    ALP_TRY(alpi_grow(p->context, &items, &all->capacity, all->count + 1, sizeof *all->items));
    all->items = items;
    need *n = &all->items[all->count++];
    *n = *wanted;
    ALP_TRY(write_material(p, all, n));
    *written = n->written;
    return ALP_OK;
}

static float light_scale(const alpi_gltf_patcher *p, const alpi_gltf_plan *plan)
{
    const uint32_t material = p->scene->surfaces[plan->surface].material;
    return !plan->lit ? 0.0f
                      : p->patch->light
                            ->scales[material == ALPI_NONE ? p->scene->material_count : material];
}

/// The material of a page with the map of a plan.
static alp_result material_of(alpi_gltf_patcher *p, needs *all, const alpi_gltf_plan *plan,
                              uint32_t page, size_t *written)
{
    need wanted = {.page = page,
                   .occluded = plan->occluded,
                   .lit = plan->lit,
                   .cleared = plan->cleared,
                   .light_scale = light_scale(p, plan)};
    memcpy(wanted.sets, plan->sets, sizeof wanted.sets);
    ALP_TRY(alpi_patcher_original(p, plan, &wanted.old));
    return find_material(p, all, &wanted, written);
}

static alp_result add_mapped(alpi_gltf_patcher *p, size_t material)
{
    void *items = p->mapped;
    ALP_TRY(
        alpi_grow(p->context, &items, &p->mapped_capacity, p->mapped_count + 1, sizeof *p->mapped));
    p->mapped = items;
    p->mapped[p->mapped_count++] = material;
    return ALP_OK;
}

/// The materials that variants of a piece can switch to.
static alp_result write_variants(alpi_gltf_patcher *p, needs *all, const alpi_gltf_plan *plan,
                                 alpi_gltf_piece *piece)
{
    json_t *mappings =
        alpi_gltf_mappings(alpi_gltf_primitive(p->document, plan->mesh, plan->primitive));
    piece->mapped = p->mapped_count;
    for (size_t i = 0; i < json_array_size(mappings); i++) {
        const size_t material = alpi_patcher_mapping(p, mappings, i);
        alpi_gltf_plan variant;
        size_t written = ALPI_GLTF_NONE;
        if (material == plan->material) {
            written = piece->material;
        } else if (alpi_patcher_variant(p, plan, material, &variant)) {
            ALP_TRY(material_of(p, all, &variant, piece->page, &written));
        }
        ALP_TRY(add_mapped(p, written));
    }
    return ALP_OK;
}

static alp_result write_materials(alpi_gltf_patcher *p, needs *all)
{
    size_t count = p->lists[ALPI_GLTF_MATERIALS].count;
    ALPI_TRY_NEW(p->context, all->has_other_users, count);
    ALPI_TRY_NEW(p->context, all->edited, count);
    ALP_TRY(alpi_patcher_other_users(p, all->has_other_users));
    for (size_t i = 0; i < p->plan_count; i++) {
        const alpi_gltf_plan *plan = &p->plans[i];
        for (size_t k = 0; k < plan->piece_count; k++) {
            alpi_gltf_piece *piece = &p->pieces[plan->piece_first + k];
            ALP_TRY(material_of(p, all, plan, piece->page, &piece->material));
            ALP_TRY(write_variants(p, all, plan, piece));
        }
    }
    return ALP_OK;
}

/// Viewers draw an unlit material in its base colour alone.
static void warn_of_unlit(const alpi_gltf_patcher *p, const needs *all)
{
    size_t count = 0;
    for (size_t i = 0; i < all->count; i++) {
        const need *n = &all->items[i];
        count += (n->occluded || n->page == ALPI_NONE) && !n->lit && n->old != ALPI_GLTF_NONE &&
                 alpi_gltf_extension(alpi_gltf_item(p->document, "materials", n->old),
                                     "KHR_materials_unlit") != NULL;
    }
    if (count > 0) {
        alpi_warn(p->context, "unlit", p->document->path,
                  "%zu material%s unlit (KHR_materials_unlit): viewers will not show the "
                  "occlusion map; take the extension out, or bake --atlas vertex",
                  count, alpi_one_or_many(count, " is", "s are"));
    }
}

alp_result alpi_patcher_materials(alpi_gltf_patcher *p)
{
    needs all = {0};
    alp_result result = write_materials(p, &all);
    if (result == ALP_OK) {
        warn_of_unlit(p, &all);
        alpi_patcher_warn_of_variants(p);
    }
    if (result == ALP_OK && p->cleared_count > 0) {
        alpi_note(p->context, "occlusion-removed", p->document->path,
                  "%zu material%s own occlusion map, by which viewers would darken the "
                  "light map again; --maps ao,light bakes one beside it",
                  p->cleared_count,
                  alpi_one_or_many(p->cleared_count, " loses its", "s lose their"));
    }
    alpi_release(p->context, all.items);
    alpi_release(p->context, all.has_other_users);
    alpi_release(p->context, all.edited);
    return result;
}
