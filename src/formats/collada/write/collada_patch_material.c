// SPDX-License-Identifier: MIT
// Materials that show a map: occlusion as the texture of <ambient>, which is the light that comes
// from all sides; light as the texture of <emission>, with <diffuse> black. An effect that all its
// users want with one page is edited; otherwise each page gets a copy.
#include "formats/collada/write/collada_patch.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

/// The kinds of map that a page brings.
typedef struct map_kind {
    const char *name, *member; // of ids; of the shader
    bool wanted;
} map_kind;

static void list_kinds(const alpi_collada_patcher *p, map_kind kinds[2])
{
    kinds[0] = (map_kind){"ao", "ambient", p->patch->page_pngs != NULL};
    kinds[1] = (map_kind){"light", "emission", p->patch->light != NULL};
}

static const xmlNode *effect_of(const alpi_collada_patcher *p, const xmlNode *material)
{
    const xmlNode *instance = alpi_xml_child(material, "instance_effect");
    const char *url = alpi_xml_attribute(instance, "url");
    const xmlNode *effect =
        alpi_collada_find(p->document, url != NULL && *url == '#' ? url + 1 : url);
    return alpi_xml_is(effect, "effect") && alpi_collada_shader(effect) != NULL ? effect : NULL;
}

static xmlNode *material_of(const alpi_collada_patcher *p, uint32_t surface)
{
    const uint32_t material = p->scene->surfaces[surface].material;
    return material == ALPI_NONE ? NULL : p->origin->materials[material];
}

static void note_page(uint32_t *of_effect, uint32_t page)
{
    const uint32_t mark = page == ALPI_NONE ? ALPI_COLLADA_SHARED : page + 1;
    *of_effect = *of_effect == 0 || *of_effect == mark ? mark : ALPI_COLLADA_SHARED;
}

alp_result alpi_collada_plan_effects(alpi_collada_patcher *p)
{
    ALPI_TRY_NEW(p->context, p->effect_pages, p->document->element_count);
    ALPI_TRY_NEW(p->context, p->effect_done, p->document->element_count);
    ALPI_TRY_NEW(p->context, p->effect_users, p->document->element_count);
    for (uint32_t s = 0; s < p->scene->surface_count; s++) {
        const alpi_surface *surface = &p->scene->surfaces[s];
        const xmlNode *effect = effect_of(p, material_of(p, s));
        const bool shown = p->baked[s] && p->placement_class[surface->node] != ALPI_NONE;
        if (effect != NULL) {
            note_page(&p->effect_users[alpi_xml_index(effect)], surface->material);
        }
        for (uint32_t i = 0; effect != NULL && i < surface->triangle_count; i++) {
            note_page(&p->effect_pages[alpi_xml_index(effect)],
                      shown ? p->pages[surface->first_triangle + i] : ALPI_NONE);
        }
    }
    return ALP_OK;
}

// --- effects -------------------------------------------------------------------------------------

/// The parameters of a sampler, after the manner of the version.
static void print_params(const alpi_collada_patcher *p, const char *kind, uint32_t page,
                         alpi_bytes *text)
{
    static const char clamp[] = "<wrap_s>CLAMP</wrap_s><wrap_t>CLAMP</wrap_t>"
                                "<minfilter>LINEAR</minfilter><magfilter>LINEAR</magfilter>";
    if (p->is_1_5) {
        alpi_bytes_print(text,
                         "<newparam sid=\"%s-%s-sampler\"><sampler2D><instance_image "
                         "url=\"#%s-%s-%u\"/>%s</sampler2D></newparam>",
                         p->prefix, kind, p->prefix, kind, page, clamp);
        return;
    }
    alpi_bytes_print(text,
                     "<newparam sid=\"%s-%s-surface\"><surface type=\"2D\"><init_from>%s-%s-%u"
                     "</init_from></surface></newparam>",
                     p->prefix, kind, p->prefix, kind, page);
    alpi_bytes_print(text,
                     "<newparam sid=\"%s-%s-sampler\"><sampler2D><source>%s-%s-surface</source>%s"
                     "</sampler2D></newparam>",
                     p->prefix, kind, p->prefix, kind, clamp);
}

static void print_texture(const alpi_collada_patcher *p, const map_kind *kind, alpi_bytes *text)
{
    alpi_bytes_print(text,
                     "<%s><texture texture=\"%s-%s-sampler\" texcoord=\"" ALPI_COLLADA_BAKED_UV
                     "\"/></%s>",
                     kind->member, p->prefix, kind->name, kind->member);
}

/// Sets a member of the shader; the schema wants emission, ambient, diffuse in this order.
static void set_member(const alpi_collada_patcher *p, alpi_edits *edits, const xmlNode *shader,
                       const char *member, const char *value)
{
    const xmlNode *old = alpi_xml_child(shader, member);
    if (old != NULL) {
        alpi_xml_replace(p->document, edits, old, value);
        return;
    }
    const xmlNode *before = alpi_xml_child(shader, NULL);
    if (before == NULL) {
        alpi_xml_append(p->document, edits, shader, NULL, value);
        return;
    }
    const xmlNode *emission = alpi_xml_child(shader, "emission");
    const bool first = strcmp(member, "emission") == 0 || emission == NULL;
    const alpi_xml_span *span = alpi_xml_span_of(p->document, first ? before : emission);
    alpi_xml_insert(edits, first ? span->begin : span->end, value);
}

/// What 1 in the image of light stands for: the common profile has no place for it, an <extra> has.
static void print_strength(const alpi_collada_patcher *p, uint32_t material, alpi_bytes *text)
{
    const uint32_t index = material == ALPI_NONE ? p->scene->material_count : material;
    alpi_bytes_print(text, "<extra><technique profile=\"alpenglow\"><emission_strength>");
    alpi_bytes_float(text, p->patch->light->scales[index]);
    alpi_bytes_print(text, "</emission_strength></technique></extra>");
}

/// All that an effect gains for a page. One edit of an empty shader is all it can take: then
/// everything goes in at once.
static void edit_effect(const alpi_collada_patcher *p, const xmlNode *effect, uint32_t material,
                        uint32_t page, alpi_edits *edits)
{
    static const char black[] = "<diffuse><color>0 0 0 1</color></diffuse>";
    const xmlNode *shader = alpi_collada_shader(effect), *technique = shader->parent;
    const bool empty = alpi_xml_child(shader, NULL) == NULL;
    map_kind kinds[2];
    list_kinds(p, kinds);
    alpi_bytes params = alpi_bytes_create(p->context), all = alpi_bytes_create(p->context);
    for (int k = 1; k >= 0; k--) { // emission comes before ambient
        if (!kinds[k].wanted) {
            continue;
        }
        alpi_bytes text = alpi_bytes_create(p->context);
        print_params(p, kinds[k].name, page, &params);
        print_texture(p, &kinds[k], &text);
        alpi_bytes_add(&all, text.bytes, text.size);
        edits->inserted.failed |= text.failed;
        if (!empty && !text.failed) {
            set_member(p, edits, shader, kinds[k].member, (const char *)text.bytes);
        }
        alpi_bytes_destroy(&text);
    }
    if (kinds[1].wanted && !alpi_xml_is(shader, "constant")) {
        alpi_bytes_print(&all, "%s", black);
        const xmlNode *diffuse = alpi_xml_child(shader, "diffuse");
        if (!empty && diffuse != NULL) {
            alpi_xml_replace(p->document, edits, diffuse, black);
        }
    }
    if (kinds[1].wanted) {
        alpi_bytes extra = alpi_bytes_create(p->context);
        print_strength(p, material, &extra);
        edits->inserted.failed |= extra.failed;
        if (!extra.failed) {
            alpi_xml_insert(edits, alpi_xml_span_of(p->document, shader)->end,
                            (const char *)extra.bytes);
        }
        alpi_bytes_destroy(&extra);
    }
    edits->inserted.failed |= params.failed || all.failed;
    if (empty && !all.failed && all.size > 0) {
        alpi_xml_append(p->document, edits, shader, NULL, (const char *)all.bytes);
    }
    if (!params.failed && params.size > 0) {
        alpi_xml_insert(edits, alpi_xml_span_of(p->document, technique)->begin,
                        (const char *)params.bytes);
    }
    alpi_bytes_destroy(&params);
    alpi_bytes_destroy(&all);
}

/// A copy of an effect with another id, for library_effects.
static alp_result copy_effect(alpi_collada_patcher *p, const xmlNode *effect, uint32_t material,
                              uint32_t page, const char *id)
{
    const alpi_xml_span *span = alpi_xml_span_of(p->document, effect);
    alpi_edits edits = alpi_edits_create(p->context, p->document->text);
    alpi_json_span value;
    if (alpi_xml_find_value(p->document, effect, "id", &value)) {
        alpi_edits_replace(&edits, value, "%s", id);
    }
    alpi_collada_tidy_effect(p, effect, &edits, p->left_out);
    edit_effect(p, effect, material, page, &edits);
    const uint32_t begin = alpi_xml_index(effect), end = alpi_xml_end_index(p->document, effect);
    memset(p->left_out + begin, 0, (end - begin) * sizeof *p->left_out); // for the next copy
    alp_result result =
        alpi_edits_apply(&edits, (alpi_json_span){span->begin, span->end}, &p->effects);
    alpi_edits_destroy(&edits);
    return result;
}

/// For what has no effect that is read: a grey.
static void add_grey_effect(alpi_collada_patcher *p, uint32_t page, const char *id)
{
    map_kind kinds[2];
    list_kinds(p, kinds);
    alpi_bytes_print(&p->effects, "<effect id=\"%s\"><profile_COMMON>", id);
    for (int k = 1; k >= 0; k--) {
        if (kinds[k].wanted) {
            print_params(p, kinds[k].name, page, &p->effects);
        }
    }
    alpi_bytes_print(&p->effects, "<technique sid=\"common\"><lambert>");
    for (int k = 1; k >= 0; k--) {
        if (kinds[k].wanted) {
            print_texture(p, &kinds[k], &p->effects);
        }
    }
    const char *grey = kinds[1].wanted ? "0 0 0 1" : "0.5 0.5 0.5 1";
    alpi_bytes_print(&p->effects, "<diffuse><color>%s</color></diffuse></lambert>", grey);
    if (kinds[1].wanted) {
        print_strength(p, ALPI_NONE, &p->effects);
    }
    alpi_bytes_print(&p->effects, "</technique></profile_COMMON></effect>");
}

// --- materials -----------------------------------------------------------------------------------

static alp_result add_material(alpi_collada_patcher *p, uint32_t surface, uint32_t page,
                               alpi_collada_made *made)
{
    const xmlNode *material = material_of(p, surface);
    const xmlNode *effect = effect_of(p, material);
    char effect_id[96];
    snprintf(effect_id, sizeof effect_id, "%s-effect-%u", p->prefix, p->made_count);
    made->id = alpi_format(p->context, "%s-material-%u", p->prefix, p->made_count);
    if (made->id == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    made->material = p->scene->surfaces[surface].material;
    made->page = page;
    if (effect != NULL) {
        ALP_TRY(copy_effect(p, effect, made->material, page, effect_id));
    } else {
        add_grey_effect(p, page, effect_id);
    }
    alpi_bytes_print(&p->materials, "<material id=\"%s\" name=\"", made->id);
    char *name = alpi_collada_copy_name(p->context, material, "no material");
    if (name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alpi_xml_print_text(&p->materials, name);
    alpi_release(p->context, name);
    alpi_bytes_print(&p->materials, "-%u\"><instance_effect url=\"#%s\"/></material>", page,
                     effect_id);
    return ALP_OK;
}

alp_result alpi_collada_get_material(alpi_collada_patcher *p, uint32_t surface, uint32_t page,
                                     const char **id)
{
    const xmlNode *material = material_of(p, surface), *effect = effect_of(p, material);
    const char *own = alpi_xml_attribute(material, "id");
    const uint32_t index = p->scene->surfaces[surface].material;
    p->page_used[page] = true;
    if (effect != NULL && own != NULL && p->effect_pages[alpi_xml_index(effect)] == page + 1 &&
        (p->patch->light == NULL || p->effect_users[alpi_xml_index(effect)] == index + 1)) {
        bool *done = &p->effect_done[alpi_xml_index(effect)];
        if (!*done) {
            alpi_collada_tidy_effect(p, effect, &p->edits, p->removed);
            edit_effect(p, effect, index, page, &p->edits);
            *done = true;
        }
        *id = own;
        p->named[alpi_xml_index(material)] = true;
        return ALP_OK;
    }
    for (uint32_t i = 0; i < p->made_count; i++) {
        if (p->made[i].material == index && p->made[i].page == page) {
            *id = p->made[i].id;
            return ALP_OK;
        }
    }
    ALP_TRY(alpi_collada_grow(p->context, &p->made, &p->made_capacity, p->made_count + 1,
                              sizeof *p->made));
    alp_result result = add_material(p, surface, page, &p->made[p->made_count]);
    *id = p->made[p->made_count].id;
    p->made_count++; // released with the others, also after a failure
    return result;
}

// --- images --------------------------------------------------------------------------------------

void alpi_collada_add_images(alpi_collada_patcher *p)
{
    map_kind kinds[2];
    list_kinds(p, kinds);
    for (uint32_t page = 0; page < p->patch->page_count; page++) {
        for (int k = 0; k < 2 && p->page_used[page]; k++) {
            if (!kinds[k].wanted) {
                continue;
            }
            const char *uri = k == 0 ? p->image_names[page] : p->light_names[page];
            alpi_bytes_print(&p->images, "<image id=\"%s-%s-%u\" name=\"%s-%s-%u\"><init_from>%s",
                             p->prefix, kinds[k].name, page, p->prefix, kinds[k].name, page,
                             p->is_1_5 ? "<ref>" : "");
            alpi_xml_print_text(&p->images, uri);
            alpi_bytes_print(&p->images, "%s</init_from></image>", p->is_1_5 ? "</ref>" : "");
        }
    }
}
