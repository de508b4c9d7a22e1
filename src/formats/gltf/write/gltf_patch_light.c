// SPDX-License-Identifier: MIT
// Materials that show baked light: as emission, by MOZ_lightmap, or by a file that their extras
// name.

#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_appends.h"
#include "formats/gltf/write/gltf_patch_material.h"
#include "formats/gltf/write/gltf_patch_sets.h"

#include <stdio.h>
#include <string.h>

/// Of extensions of a material, those that have no place beside all of its light as emission: they
/// say how it would look under other light, or take the emission's place.
static const char *const dropped_extensions[] = {"KHR_materials_emissive_strength",
                                                 "KHR_materials_unlit",
                                                 "KHR_materials_pbrSpecularGlossiness",
                                                 "KHR_materials_specular",
                                                 "KHR_materials_clearcoat",
                                                 "KHR_materials_sheen",
                                                 "KHR_materials_iridescence",
                                                 "KHR_materials_anisotropy"};

bool alpi_patcher_is_lit(const alpi_gltf_patcher *p, const alpi_surface *surface)
{
    const alpi_light_patch *light = p->patch->light;
    const bool clear = surface->material != ALPI_NONE &&
                       p->scene->materials[surface->material].transmission > 0.0f;
    return light != NULL && !(clear && light->form == ALPI_LIGHT_FORM_EMISSIVE);
}

// --- what all forms print ------------------------------------------------------------------------

/// The texture of a page, made at its first use.
static size_t light_texture(alpi_gltf_patcher *p, uint32_t page)
{
    if (p->light_textures[page] == ALPI_GLTF_NONE) {
        const alpi_light_patch *light = p->patch->light;
        const uint32_t first = p->patch->page_pngs != NULL ? p->patch->page_count : 0;
        char name[32];
        snprintf(name, sizeof name, "light %u", page);
        const size_t image = alpi_patcher_add_image(p, name, first + p->patch->packed_count + page,
                                                    light->pages[page], light->page_sizes[page]);
        p->light_textures[page] = alpi_patcher_add_texture(p, image);
    }
    return p->light_textures[page];
}

static void print_scale(alpi_bytes *text, const char *name, float scale)
{
    alpi_bytes_print(text, "\"%s\":", name);
    alpi_bytes_number(text, (double)scale, 9);
}

/// {"index", "texCoord"}, the set also where it is 0: readers of MOZ_lightmap take 1 for granted.
static void print_moz(alpi_gltf_patcher *p, const alpi_gltf_light_use *use, alpi_bytes *text)
{
    alpi_bytes_print(text, "{\"index\":%zu,\"texCoord\":%u,", light_texture(p, use->page),
                     use->uv_set);
    print_scale(text, "intensity", use->scale);
    alpi_bytes_print(text, "}");
}

static void print_file(alpi_gltf_patcher *p, const alpi_gltf_light_use *use, alpi_bytes *text)
{
    p->light_textures[use->page] = 0; // its file is needed
    alpi_bytes_print(text, "{\"uri\":");
    alpi_bytes_quote(text, p->light_uris[use->page]);
    alpi_bytes_print(text, ",\"texCoord\":%u,", use->uv_set);
    print_scale(text, "intensity", use->scale);
    alpi_bytes_print(text, ",\"units\":");
    alpi_bytes_quote(text, p->patch->light->units);
    alpi_bytes_print(text, "}");
}

static void print_emissive_strength(const alpi_gltf_light_use *use, alpi_bytes *text)
{
    alpi_bytes_print(text, "\"KHR_materials_emissive_strength\":{");
    print_scale(text, "emissiveStrength", use->scale);
    alpi_bytes_print(text, "}");
}

static void print_emissive_texture(alpi_gltf_patcher *p, const alpi_gltf_light_use *use,
                                   alpi_bytes *text)
{
    alpi_bytes_print(text, "{\"index\":%zu,\"texCoord\":%u}", light_texture(p, use->page),
                     use->uv_set);
}

// Of a metal of base colour 0 nothing is seen under other light but a rim: no diffuse, F0 = 0.
#define BLACK ",\"metallicFactor\":1,\"roughnessFactor\":1"

// --- materials of the document -------------------------------------------------------------------

/// Black, with the alpha that there was.
static void print_black(const alpi_gltf_patcher *p, size_t material, alpi_bytes *text)
{
    const alpi_material *m = &p->scene->materials[material];
    static const char *const paths[] = {
        "extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
        "pbrMetallicRoughness/baseColorTexture"};
    const alpi_json_span span = p->lists[ALPI_GLTF_MATERIALS].spans[material];
    alpi_json_span texture, glossiness;
    const bool glossy = alpi_json_at(p->document->text, span,
                                     "extensions/KHR_materials_pbrSpecularGlossiness", &glossiness);
    alpi_bytes_print(text, "{\"baseColorFactor\":[0,0,0,");
    alpi_bytes_number(text, (double)m->base_color[3], 9);
    alpi_bytes_print(text, "]" BLACK);
    if (m->alpha_mode != ALPI_ALPHA_OPAQUE &&
        alpi_json_at(p->document->text, span, paths[glossy ? 0 : 1], &texture)) {
        alpi_bytes_print(text, ",\"baseColorTexture\":");
        alpi_bytes_add(text, p->document->text + texture.begin, texture.end - texture.begin);
    }
    alpi_bytes_print(text, "}");
}

static bool is_dropped(const char *text, alpi_json_span key)
{
    for (size_t i = 0; i < sizeof dropped_extensions / sizeof *dropped_extensions; i++) {
        if (alpi_json_key_is(text, key, dropped_extensions[i])) {
            return true;
        }
    }
    return false;
}

/// The extensions that there were, less those that have no place now, and the strength.
static void print_extensions(const alpi_gltf_patcher *p, const alpi_gltf_light_use *use,
                             alpi_bytes *text)
{
    const char *source = p->document->text;
    alpi_json_span old;
    alpi_bytes_print(text, "{");
    if (alpi_json_find(source, p->lists[ALPI_GLTF_MATERIALS].spans[use->material], "extensions",
                       &old)) {
        alpi_json_cursor cursor = alpi_json_open(source, old);
        while (alpi_json_next(&cursor)) {
            if (!is_dropped(source, cursor.key)) {
                alpi_bytes_add(text, source + cursor.key.begin,
                               cursor.value.end - cursor.key.begin);
                alpi_bytes_print(text, ",");
            }
        }
    }
    print_emissive_strength(use, text);
    alpi_bytes_print(text, "}");
}

static void light_by_emission(alpi_gltf_patcher *p, const alpi_gltf_light_use *use,
                              alpi_edits *edits)
{
    static const char one[] = "[1,1,1]";
    const alpi_json_span span = p->lists[ALPI_GLTF_MATERIALS].spans[use->material];
    alpi_bytes black = alpi_bytes_create(p->context), texture = alpi_bytes_create(p->context);
    alpi_bytes extensions = alpi_bytes_create(p->context);
    print_black(p, use->material, &black);
    print_emissive_texture(p, use, &texture);
    print_extensions(p, use, &extensions);
    p->data.failed |= black.failed || texture.failed || extensions.failed;
    alpi_edits_set(edits, span, "pbrMetallicRoughness", black.bytes, black.size);
    alpi_edits_set(edits, span, "emissiveFactor", one, sizeof one - 1);
    alpi_edits_set(edits, span, "emissiveTexture", texture.bytes, texture.size);
    alpi_edits_set(edits, span, "extensions", extensions.bytes, extensions.size);
    alpi_json_span mark; // "no material" would bring the grey back that there was before
    if (alpi_json_at(p->document->text, span, "extras/alpenglow", &mark)) {
        alpi_edits_replace(edits, mark, "\"light\"");
    }
    alpi_bytes_destroy(&black);
    alpi_bytes_destroy(&texture);
    alpi_bytes_destroy(&extensions);
}

void alpi_patcher_light_material(alpi_gltf_patcher *p, const alpi_gltf_light_use *use,
                                 alpi_edits *edits)
{
    static const char *const moz = "MOZ_lightmap";
    const alpi_light_form form = p->patch->light->form;
    if (form == ALPI_LIGHT_FORM_EMISSIVE) {
        p->extension = "KHR_materials_emissive_strength";
        light_by_emission(p, use, edits);
        return;
    }
    alpi_bytes value = alpi_bytes_create(p->context);
    (form == ALPI_LIGHT_FORM_MOZ ? print_moz : print_file)(p, use, &value);
    p->data.failed |= value.failed;
    p->extension = form == ALPI_LIGHT_FORM_MOZ ? moz : NULL;
    const bool both = form == ALPI_LIGHT_FORM_EXTRAS && use->blend != NULL;
    const char *const names[] = {form == ALPI_LIGHT_FORM_MOZ ? moz : "lightmap", ALPI_GLTF_BLEND};
    const char *const values[] = {value.failed ? "" : (const char *)value.bytes, use->blend};
    const alpi_gltf_inside inside = {form == ALPI_LIGHT_FORM_MOZ ? "extensions" : "extras",
                                     both ? 2 : 1, names, values};
    if (!alpi_patcher_set_inside(p, use->material, &inside, edits)) {
        alpi_warn(p->context, "extras", p->document->path,
                  "the extras of material %zu are not an object: they stay unchanged, and do not"
                  " name its light",
                  use->material);
    }
    alpi_bytes_destroy(&value);
}

// --- new materials -------------------------------------------------------------------------------

void alpi_patcher_print_light(alpi_gltf_patcher *p, const alpi_gltf_light_use *use,
                              const char *mark, alpi_bytes *text)
{
    switch (p->patch->light->form) {
    case ALPI_LIGHT_FORM_EMISSIVE:
        p->extension = "KHR_materials_emissive_strength";
        alpi_bytes_print(text, "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,1]" BLACK "},"
                               "\"emissiveFactor\":[1,1,1],\"emissiveTexture\":");
        print_emissive_texture(p, use, text);
        alpi_bytes_print(text, ",\"extensions\":{");
        print_emissive_strength(use, text);
        alpi_bytes_print(text, "}");
        if (use->blend != NULL) {
            alpi_bytes_print(text, ",\"extras\":{\"" ALPI_GLTF_BLEND "\":%s}", use->blend);
        }
        break;
    case ALPI_LIGHT_FORM_MOZ:
        p->extension = "MOZ_lightmap";
        alpi_bytes_print(text, "\"extensions\":{\"MOZ_lightmap\":");
        print_moz(p, use, text);
        alpi_bytes_print(text, "},\"extras\":{%s}", mark);
        break;
    case ALPI_LIGHT_FORM_EXTRAS:
        alpi_bytes_print(text, "\"extras\":{%s,\"lightmap\":", mark);
        print_file(p, use, text);
        alpi_bytes_print(text, "}");
        break;
    }
}
