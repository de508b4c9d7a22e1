// SPDX-License-Identifier: MIT
// What goes to the materials of primitives and of their variants (KHR_materials_variants), and
// which materials something else uses too.
#include "formats/gltf/write/gltf_patch_users.h"

#include "base/memory.h"
#include "base/plural.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_patch_material.h"
#include "formats/gltf/write/gltf_patch_plan.h"

#include <stdio.h>
#include <string.h>

// --- which maps ----------------------------------------------------------------------------------

static bool has_occlusion(const alpi_gltf_patcher *p, size_t material)
{
    return material != ALPI_GLTF_NONE &&
           json_object_get(alpi_gltf_item(p->document, "materials", material),
                           "occlusionTexture") != NULL;
}

/// Whether the occlusion map goes to a material, or values at vertices to its primitives.
static bool gets_occlusion(const alpi_gltf_patcher *p, size_t material)
{
    const bool keeps = p->patch->existing_ao == ALPI_EXISTING_AO_KEEP && has_occlusion(p, material);
    return (p->patch->page_pngs != NULL || p->patch->vertex_values != NULL) && !keeps;
}

/// Whether the file's own occlusion map goes from a material that gets a light map. three.js would
/// multiply the light by it, and the light is occluded already.
static bool loses_occlusion(const alpi_gltf_patcher *p, const alpi_gltf_plan *plan)
{
    return plan->lit && p->patch->light->form != ALPI_LIGHT_FORM_EMISSIVE &&
           p->patch->page_pngs == NULL && p->patch->existing_ao != ALPI_EXISTING_AO_KEEP &&
           has_occlusion(p, plan->material);
}

void alpi_patcher_choose_maps(const alpi_gltf_patcher *p, alpi_gltf_plan *plan)
{
    plan->packed = alpi_patcher_packed(p, plan->material) != ALPI_NONE;
    plan->occluded = gets_occlusion(p, plan->material);
    plan->lit = alpi_patcher_is_lit(p, &p->scene->surfaces[plan->surface]);
    plan->cleared = loses_occlusion(p, plan);
}

// --- variants ------------------------------------------------------------------------------------

json_t *alpi_gltf_mappings(json_t *primitive)
{
    return json_object_get(alpi_gltf_extension(primitive, "KHR_materials_variants"), "mappings");
}

static size_t material_of(const alpi_gltf_patcher *p, json_t *object)
{
    json_t *index = json_object_get(object, "material");
    const double value = json_number_value(index);
    return json_is_number(index) && value >= 0.0 &&
                   value < (double)p->lists[ALPI_GLTF_MATERIALS].count
               ? (size_t)value
               : ALPI_GLTF_NONE;
}

size_t alpi_patcher_mapping(const alpi_gltf_patcher *p, json_t *mappings, size_t i)
{
    return material_of(p, json_array_get(mappings, i));
}

/// Emission holds the light of the material that was baked: a variant of another colour would show
/// the same. A map that is packed into an image of one material is not in that of another.
bool alpi_patcher_variant(const alpi_gltf_patcher *p, const alpi_gltf_plan *plan, size_t material,
                          alpi_gltf_plan *variant)
{
    *variant = *plan;
    variant->material = material;
    if (material == ALPI_GLTF_NONE || p->patch->vertex_values != NULL) {
        return false;
    }
    alpi_patcher_choose_maps(p, variant);
    const bool emits = plan->lit && p->patch->light->form == ALPI_LIGHT_FORM_EMISSIVE;
    return !emits && !plan->packed && !variant->packed && (variant->occluded || variant->lit);
}

/// Marks the materials of variants that are left without a map.
static void mark_left(const alpi_gltf_patcher *p, bool *left)
{
    for (size_t i = 0; i < p->plan_count; i++) {
        const alpi_gltf_plan *plan = &p->plans[i];
        json_t *mappings =
            alpi_gltf_mappings(alpi_gltf_primitive(p->document, plan->mesh, plan->primitive));
        const alpi_gltf_piece *piece = &p->pieces[plan->piece_first];
        for (size_t k = 0; plan->piece_count > 0 && k < json_array_size(mappings); k++) {
            const size_t material = alpi_patcher_mapping(p, mappings, k);
            const bool keeps = p->patch->existing_ao == ALPI_EXISTING_AO_KEEP && !plan->lit &&
                               has_occlusion(p, material);
            if (material != ALPI_GLTF_NONE && !keeps &&
                p->mapped[piece->mapped + k] == ALPI_GLTF_NONE) {
                left[material] = true;
            }
        }
    }
}

static void print_names(const alpi_gltf_patcher *p, const bool *left, size_t *found,
                        alpi_bytes *names)
{
    enum { NAMED = 8 };
    for (size_t i = 0; i < p->lists[ALPI_GLTF_MATERIALS].count; i++) {
        if (left[i] && (*found)++ < NAMED) {
            char name[64];
            const char *text = alpi_gltf_text(alpi_gltf_item(p->document, "materials", i), "name");
            snprintf(name, sizeof name, "%s", text != NULL ? text : "");
            alpi_gltf_clean(name);
            alpi_bytes_print(names, "%s%zu%s%s%s", *found > 1 ? ", " : "", i,
                             text != NULL ? " (" : "", name, text != NULL ? ")" : "");
        }
    }
    alpi_bytes_print(names, "%s", *found > NAMED ? " and more" : "");
}

void alpi_patcher_warn_of_variants(alpi_gltf_patcher *p)
{
    bool *left = ALPI_NEW(p->context, bool, p->lists[ALPI_GLTF_MATERIALS].count);
    size_t found = 0;
    if (left == NULL) {
        p->data.failed = true;
        return;
    }
    alpi_bytes names = alpi_bytes_create(p->context);
    mark_left(p, left);
    print_names(p, left, &found, &names);
    if (found > 0 && !names.failed) {
        alpi_warn(p->context, "variants", p->document->path,
                  "%zu material%s of variants (KHR_materials_variants) without a map: %s; "
                  "occlusion with --ao-into separate, and light with --lightmap-as moz or extras, "
                  "go to all",
                  found, alpi_plural(found), (const char *)names.bytes);
    }
    p->data.failed |= names.failed;
    alpi_bytes_destroy(&names);
    alpi_release(p->context, left);
}

// --- who else uses a material --------------------------------------------------------------------

static void mark_user(const alpi_gltf_patcher *p, json_t *object, bool *marks)
{
    const size_t material = material_of(p, object);
    if (material != ALPI_GLTF_NONE) {
        marks[material] = true;
    }
}

/// Marks materials that variants of a primitive can switch to, where the map does not go to them.
/// @param plan of a primitive that is edited in place, or NULL
static void mark_variants(const alpi_gltf_patcher *p, json_t *primitive, const alpi_gltf_plan *plan,
                          bool *marks)
{
    json_t *mappings = alpi_gltf_mappings(primitive);
    for (size_t i = 0; i < json_array_size(mappings); i++) {
        json_t *mapping = json_array_get(mappings, i);
        const size_t material = material_of(p, mapping);
        alpi_gltf_plan variant;
        if (plan == NULL ||
            (material != plan->material && !alpi_patcher_variant(p, plan, material, &variant))) {
            mark_user(p, mapping, marks);
        }
    }
}

/// Marks the materials of primitives that will still be there unpatched. `patched` has for each
/// primitive, counted through all meshes, the plan that edits it in place, or NULL.
static void mark_other_users(const alpi_gltf_patcher *p, const alpi_gltf_plan *const *patched,
                             bool *marks)
{
    size_t at = 0, count = p->lists[ALPI_GLTF_MESHES].count;
    for (size_t m = 0; m < count; m++) {
        json_t *primitives =
            json_object_get(alpi_gltf_item(p->document, "meshes", m), "primitives");
        for (size_t i = 0; i < json_array_size(primitives); i++, at++) {
            json_t *primitive = json_array_get(primitives, i);
            if (patched[at] == NULL) {
                mark_user(p, primitive, marks);
            }
            mark_variants(p, primitive, patched[at], marks);
        }
    }
}

alp_result alpi_patcher_other_users(const alpi_gltf_patcher *p, bool *marks)
{
    size_t count = p->lists[ALPI_GLTF_MESHES].count, total = 0;
    size_t *first = ALPI_NEW(p->context, size_t, count);
    if (first == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (size_t m = 0; m < count; m++) {
        first[m] = total;
        total += json_array_size(
            json_object_get(alpi_gltf_item(p->document, "meshes", m), "primitives"));
    }
    const alpi_gltf_plan **patched = ALPI_NEW(p->context, const alpi_gltf_plan *, total);
    for (size_t i = 0; patched != NULL && i < p->plan_count; i++) {
        const alpi_gltf_plan *plan = &p->plans[i];
        if (!plan->in_a_copy) {
            patched[first[plan->mesh] + plan->primitive] = plan;
        }
    }
    if (patched != NULL) {
        mark_other_users(p, patched, marks);
    }
    alp_result result = patched == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    alpi_release(p->context, (void *)patched);
    alpi_release(p->context, first);
    return result;
}
