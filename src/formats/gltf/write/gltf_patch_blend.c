// SPDX-License-Identifier: MIT
// Three coordinate sets that a shader blends: their attributes, and what materials say of them.
#include "formats/gltf/write/gltf_patch_sets.h"
#include <string.h>

static const char OCCLUSION[] = "occlusionTexture";
/// The names in a list of "maps", less those of the maps that are replaced.
static size_t keep_maps(const alpi_gltf_patcher *p, alpi_json_span maps, alpi_gltf_maps replaced,
                        alpi_bytes *kept)
{
    const char *text = p->document->text;
    alpi_json_cursor cursor = alpi_json_open(text, maps);
    size_t count = 0;
    alpi_bytes_print(kept, "[");
    while (alpi_json_next(&cursor)) {
        const bool gone =
            ((replaced.occluded || replaced.cleared) &&
             alpi_json_key_is(text, cursor.value, OCCLUSION)) ||
            (replaced.lit && alpi_json_key_is(text, cursor.value, alpi_patcher_light_name(p)));
        if (!gone) {
            alpi_bytes_print(kept, "%s", count++ > 0 ? "," : "");
            alpi_bytes_add(kept, text + cursor.value.begin, cursor.value.end - cursor.value.begin);
        }
    }
    alpi_bytes_print(kept, "]");
    return count;
}

/// What a bake before said of its sets and maps, less the maps that are replaced.
/// @param count in, out: of the descriptions in `text`
static void print_kept(const alpi_gltf_patcher *p, alpi_json_span blend, alpi_gltf_maps replaced,
                       size_t *count, alpi_bytes *text)
{
    const char *document = p->document->text;
    alpi_json_span sets, maps;
    if (document[blend.begin] != '{' || !alpi_json_find(document, blend, "sets", &sets) ||
        !alpi_json_find(document, blend, "maps", &maps)) {
        return;
    }
    alpi_bytes kept = alpi_bytes_create(p->context);
    if (keep_maps(p, maps, replaced, &kept) > 0 && !kept.failed) {
        alpi_bytes_print(text, (*count)++ > 0 ? ",{\"sets\":" : "{\"sets\":");
        alpi_bytes_add(text, document + sets.begin, sets.end - sets.begin);
        alpi_bytes_print(text, ",\"maps\":");
        alpi_bytes_add(text, kept.bytes, kept.size);
        alpi_bytes_print(text, "}");
    }
    text->failed |= kept.failed;
    alpi_bytes_destroy(&kept);
}

static void print_earlier(const alpi_gltf_patcher *p, size_t material, alpi_gltf_maps replaced,
                          alpi_bytes *text)
{
    const char *document = p->document->text;
    alpi_json_span blend, earlier;
    if (material == ALPI_GLTF_NONE ||
        !alpi_json_at(document, p->lists[ALPI_GLTF_MATERIALS].spans[material],
                      "extras/" ALPI_GLTF_BLEND, &blend)) {
        return;
    }
    alpi_bytes kept = alpi_bytes_create(p->context);
    size_t count = 0;
    print_kept(p, blend, replaced, &count, &kept);
    if (alpi_json_find(document, blend, ALPI_GLTF_EARLIER, &earlier)) {
        alpi_json_cursor cursor = alpi_json_open(document, earlier);
        while (alpi_json_next(&cursor)) {
            print_kept(p, cursor.value, replaced, &count, &kept);
        }
    }
    if (count > 0) {
        alpi_bytes_print(text, ",\"" ALPI_GLTF_EARLIER "\":[");
        alpi_bytes_add(text, kept.bytes, kept.size);
        alpi_bytes_print(text, "]");
    }
    text->failed |= kept.failed;
    alpi_bytes_destroy(&kept);
}

void alpi_patcher_print_blend(const alpi_gltf_patcher *p, size_t material,
                              const uint32_t sets[ALPI_GLTF_BLEND_SETS], alpi_gltf_maps maps,
                              alpi_bytes *text)
{
    alpi_bytes_print(text, "{\"sets\":[");
    for (uint32_t k = 0; k < ALPI_GLTF_BLEND_SETS; k++) {
        char name[ALPI_GLTF_ATTRIBUTE_SIZE];
        alpi_patcher_set_name(sets[k], name);
        alpi_bytes_print(text, "%s\"%s\"", k > 0 ? "," : "", name);
    }
    alpi_bytes_print(text, "],\"weights\":\"n*n\",\"frame\":\"object\",\"maps\":[");
    if (maps.occluded) {
        alpi_bytes_print(text, "\"%s\"%s", OCCLUSION, maps.lit ? "," : "");
    }
    if (maps.lit) {
        alpi_bytes_quote(text, alpi_patcher_light_name(p));
    }
    alpi_bytes_print(text, "]");
    print_earlier(p, material, maps, text);
    alpi_bytes_print(text, "}");
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
                  "the extras of material %zu are not an object: they stay unchanged, and do not"
                  " name the blended sets",
                  material);
    }
}

static void take_maps(alpi_gltf_patcher *p, alpi_json_span blend, alpi_gltf_maps replaced,
                      alpi_edits *edits)
{
    alpi_json_span maps;
    if (!alpi_json_find(p->document->text, blend, "maps", &maps) ||
        p->document->text[maps.begin] != '[') {
        return;
    }
    alpi_bytes kept = alpi_bytes_create(p->context);
    keep_maps(p, maps, replaced, &kept);
    p->data.failed |= kept.failed;
    alpi_edits_replace(edits, maps, "%s", kept.failed ? "" : (const char *)kept.bytes);
    alpi_bytes_destroy(&kept);
}

void alpi_patcher_unblend_material(alpi_gltf_patcher *p, size_t material, alpi_gltf_maps replaced,
                                   alpi_edits *edits)
{
    const char *text = p->document->text;
    alpi_json_span blend, earlier;
    if (!alpi_json_at(text, p->lists[ALPI_GLTF_MATERIALS].spans[material],
                      "extras/" ALPI_GLTF_BLEND, &blend)) {
        return;
    }
    take_maps(p, blend, replaced, edits);
    if (alpi_json_find(text, blend, ALPI_GLTF_EARLIER, &earlier)) {
        alpi_json_cursor cursor = alpi_json_open(text, earlier);
        while (alpi_json_next(&cursor)) {
            take_maps(p, cursor.value, replaced, edits);
        }
    }
}
