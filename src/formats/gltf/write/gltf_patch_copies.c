// SPDX-License-Identifier: MIT
// Copies of materials, one for each further page. They say what they are copies of, and a later
// bake takes the original in their place, as long as they differ in nothing but maps that it
// replaces: so they do not become copies of copies, and what somebody changed in one stays.

#include "base/memory.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_patch_material.h"
#include "formats/gltf/write/gltf_patch_sets.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char copy_of[] = ALPI_GLTF_COPY " of ";

/// Which material one says it is a copy of; those of primitives without one are copies of the
/// first such one.
static size_t find_claimed(const alpi_gltf_patcher *p, size_t material)
{
    const char *mark = alpi_gltf_mark(p->document, "materials", material);
    const size_t count = p->lists[ALPI_GLTF_MATERIALS].count;
    if (mark != NULL && strncmp(mark, copy_of, sizeof copy_of - 1) == 0) {
        const char *digits = mark + sizeof copy_of - 1;
        const unsigned long long index = strtoull(digits, NULL, 10);
        return strchr("0123456789", *digits) != NULL && index < count ? (size_t)index : material;
    }
    for (size_t i = 0; mark != NULL && strcmp(mark, ALPI_GLTF_NO_MATERIAL) == 0 && i < material;
         i++) {
        const char *other = alpi_gltf_mark(p->document, "materials", i);
        if (other != NULL && strcmp(other, mark) == 0) {
            return i;
        }
    }
    return material;
}

static void strip_light(const alpi_gltf_patcher *p, json_t *material, json_t *extras)
{
    json_t *extensions = json_object_get(material, "extensions");
    switch (p->patch->light->form) {
    case ALPI_LIGHT_FORM_EMISSIVE:
        json_object_del(material, "emissiveTexture");
        json_object_del(extensions, "KHR_materials_emissive_strength");
        break;
    case ALPI_LIGHT_FORM_MOZ:
        json_object_del(extensions, "MOZ_lightmap");
        break;
    case ALPI_LIGHT_FORM_EXTRAS:
        json_object_del(extras, "lightmap");
        break;
    }
    if (json_object_size(extensions) == 0) {
        json_object_del(material, "extensions");
    }
}

/// Whether a description of a blend speaks of nothing but replaced maps.
static bool is_replaced(const alpi_gltf_patcher *p, json_t *blend, const alpi_gltf_plan *plan)
{
    json_t *maps = json_object_get(blend, "maps");
    bool all = true;
    for (size_t i = 0; i < json_array_size(maps); i++) {
        const char *name = json_string_value(json_array_get(maps, i));
        all &= name != NULL &&
               (((plan->occluded || plan->cleared) && strcmp(name, "occlusionTexture") == 0) ||
                (plan->lit && strcmp(name, alpi_patcher_light_name(p)) == 0));
    }
    return all;
}

/// A material without what a plan's bake replaces, and without our marks; NULL: no memory.
static json_t *strip(const alpi_gltf_patcher *p, size_t index, const alpi_gltf_plan *plan)
{
    json_t *material = json_deep_copy(alpi_gltf_item(p->document, "materials", index));
    json_t *extras = json_object_get(material, "extras");
    json_t *blend = json_object_get(extras, ALPI_GLTF_BLEND);
    json_t *earlier = json_object_get(blend, ALPI_GLTF_EARLIER);
    bool blend_goes = is_replaced(p, blend, plan);
    for (size_t i = 0; i < json_array_size(earlier); i++) {
        blend_goes &= is_replaced(p, json_array_get(earlier, i), plan);
    }
    if (blend_goes) {
        json_object_del(extras, ALPI_GLTF_BLEND);
    }
    if (json_is_string(json_object_get(extras, "alpenglow"))) {
        json_object_del(extras, "alpenglow");
    }
    if (plan->occluded || plan->cleared) {
        json_object_del(material, "occlusionTexture");
    }
    if (plan->lit) {
        strip_light(p, material, extras);
    }
    if (json_object_size(extras) == 0 && json_is_object(extras)) {
        json_object_del(material, "extras");
    }
    return material;
}

alp_result alpi_patcher_original(const alpi_gltf_patcher *p, const alpi_gltf_plan *plan,
                                 size_t *material)
{
    *material = plan->material;
    if (plan->material == ALPI_GLTF_NONE || plan->packed) {
        return ALP_OK;
    }
    const size_t claimed = find_claimed(p, plan->material);
    if (claimed == plan->material) {
        return ALP_OK;
    }
    json_t *copy = strip(p, plan->material, plan), *original = strip(p, claimed, plan);
    const bool known = copy != NULL && original != NULL;
    if (known && json_equal(copy, original)) {
        *material = claimed;
    }
    json_decref(copy);
    json_decref(original);
    return known ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}

alp_result alpi_patcher_mark_copy(alpi_gltf_patcher *p, size_t material, alpi_bytes *text)
{
    char mark[64];
    const int length = snprintf(mark, sizeof mark, "\"%s%zu\"", copy_of, material);
    const char *copy = (const char *)text->bytes;
    alpi_json_span root, extras, old;
    if (text->failed || !alpi_json_value(copy, 0, text->size, &root)) {
        return text->failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    }
    alpi_edits edits = alpi_edits_create(p->context, copy);
    if (!alpi_json_find(copy, root, "extras", &extras)) {
        char object[96];
        const int size = snprintf(object, sizeof object, "{\"alpenglow\":%s}", mark);
        alpi_edits_add(&edits, root, "extras", object, (size_t)size);
    } else if (copy[extras.begin] == '{' && !alpi_json_find(copy, extras, "alpenglow", &old)) {
        alpi_edits_add(&edits, extras, "alpenglow", mark, (size_t)length);
    }
    alpi_bytes marked = alpi_bytes_create(p->context);
    const alp_result result = alpi_edits_apply(&edits, root, &marked);
    alpi_edits_destroy(&edits);
    alpi_bytes_destroy(text);
    *text = marked;
    return result;
}
