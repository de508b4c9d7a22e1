// SPDX-License-Identifier: MIT
// Three coordinate sets that a shader blends: their attributes, and what materials say of them.
#include "formats/gltf_patch.h"

#include <stdio.h>
#include <string.h>

enum { LAST_TEXCOORD = 3 }; // that viewers know; glTF 2.0 asks for two

void alpi_patcher_set_name(uint32_t first, uint32_t k, char name[ALPI_GLTF_ATTRIBUTE_SIZE])
{
    if (k == 0 || first + k <= LAST_TEXCOORD) {
        snprintf(name, ALPI_GLTF_ATTRIBUTE_SIZE, "TEXCOORD_%u", first + k);
    } else {
        snprintf(name, ALPI_GLTF_ATTRIBUTE_SIZE, "_ALPENGLOW_UV_%u", k);
    }
}

static const char OCCLUSION[] = "occlusionTexture";
static const char *const LIGHTS[] = {[ALPI_LIGHT_FORM_EMISSIVE] = "emissiveTexture",
                                     [ALPI_LIGHT_FORM_MOZ] = "MOZ_lightmap",
                                     [ALPI_LIGHT_FORM_EXTRAS] = "lightmap"};

void alpi_patcher_print_blend(const alpi_gltf_patcher *p, uint32_t first, bool occluded, bool lit,
                              alpi_bytes *text)
{
    alpi_bytes_print(text, "{\"sets\":[");
    for (uint32_t k = 0; k < ALPI_GLTF_BLEND_SETS; k++) {
        char name[ALPI_GLTF_ATTRIBUTE_SIZE];
        alpi_patcher_set_name(first, k, name);
        alpi_bytes_print(text, "%s\"%s\"", k > 0 ? "," : "", name);
    }
    alpi_bytes_print(text, "],\"weights\":\"n*n\",\"frame\":\"object\",\"maps\":[");
    if (occluded) {
        alpi_bytes_print(text, "\"%s\"%s", OCCLUSION, lit ? "," : "");
    }
    if (lit) {
        alpi_bytes_quote(text, LIGHTS[p->patch->light->form]);
    }
    alpi_bytes_print(text, "]}");
}

bool alpi_patcher_set_inside(alpi_gltf_patcher *p, size_t material, const alpi_gltf_inside *inside,
                             alpi_edits *edits)
{
    const alpi_json_span span = p->lists[ALPI_GLTF_MATERIALS].spans[material];
    alpi_json_span outer;
    if (alpi_json_find(p->document->text, span, inside->outer, &outer)) {
        const bool is_object = p->document->text[outer.begin] == '{';
        for (uint32_t i = 0; i < inside->count && is_object; i++) {
            alpi_edits_set(edits, outer, inside->names[i], inside->values[i],
                           strlen(inside->values[i]));
        }
        return is_object;
    }
    alpi_bytes object = alpi_bytes_create(p->context);
    for (uint32_t i = 0; i < inside->count; i++) {
        alpi_bytes_print(&object, "%s\"%s\":%s", i > 0 ? "," : "{", inside->names[i],
                         inside->values[i]);
    }
    alpi_bytes_print(&object, "}");
    p->data.failed |= object.failed;
    alpi_edits_set(edits, span, inside->outer, object.bytes, object.size);
    alpi_bytes_destroy(&object);
    return true;
}

void alpi_patcher_blend_material(alpi_gltf_patcher *p, size_t material, const char *blend,
                                 alpi_edits *edits)
{
    static const char *const names[] = {ALPI_GLTF_BLEND};
    const alpi_gltf_inside inside = {"extras", 1, names, &blend};
    if (!alpi_patcher_set_inside(p, material, &inside, edits)) {
        alpi_warn(p->context, "extras", p->document->path,
                  "the extras of material %zu are no object: they stay, and do not name the sets "
                  "that are blended",
                  material);
    }
}

/// The names that an earlier bake left in "maps", less those of the maps that this one replaces.
static size_t keep_maps(const alpi_gltf_patcher *p, alpi_json_span maps, alpi_gltf_maps replaced,
                        alpi_bytes *kept)
{
    const char *text = p->document->text;
    alpi_json_cursor cursor = alpi_json_open(text, maps);
    size_t count = 0;
    alpi_bytes_print(kept, "[");
    while (alpi_json_next(&cursor)) {
        const bool gone =
            (replaced.occluded && alpi_json_key_is(text, cursor.value, OCCLUSION)) ||
            (replaced.lit && alpi_json_key_is(text, cursor.value, LIGHTS[p->patch->light->form]));
        if (!gone) {
            alpi_bytes_print(kept, "%s", count++ > 0 ? "," : "");
            alpi_bytes_add(kept, text + cursor.value.begin, cursor.value.end - cursor.value.begin);
        }
    }
    alpi_bytes_print(kept, "]");
    return count;
}

void alpi_patcher_unblend_material(alpi_gltf_patcher *p, size_t material, alpi_gltf_maps replaced,
                                   bool named_anew, alpi_edits *edits)
{
    alpi_json_span maps;
    if (!alpi_json_at(p->document->text, p->lists[ALPI_GLTF_MATERIALS].spans[material],
                      "extras/" ALPI_GLTF_BLEND "/maps", &maps) ||
        p->document->text[maps.begin] != '[') {
        return;
    }
    alpi_bytes kept = alpi_bytes_create(p->context);
    const size_t count = keep_maps(p, maps, replaced, &kept);
    p->data.failed |= kept.failed;
    if (!named_anew) {
        alpi_edits_replace(edits, maps, "%s", kept.failed ? "" : (const char *)kept.bytes);
    } else if (count > 0 && !kept.failed) {
        alpi_warn(p->context, "blend", p->document->path,
                  "material %zu: %s of an earlier bake is read with one of its sets now, and shows "
                  "seams, since one material names the sets of one bake; bake all maps at once",
                  material, (const char *)kept.bytes);
    }
    alpi_bytes_destroy(&kept);
}
