// SPDX-License-Identifier: MIT
// Common-profile effects → what a bake of diffuse light needs: diffuse and emitted colour or
// texture, and how opaque. Colours are taken as linear numbers, as Blender writes and reads them.
#include "formats/collada/collada_read.h"

#include "base/memory.h"
#include "formats/collada/collada_marks.h"
#include "formats/collada/collada_numbers.h"
#include "formats/images/images.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// --- parameters ----------------------------------------------------------------------------------

/// Where a <newparam> of an effect may stand, from the inside out.
typedef struct scopes {
    const xmlNode *effect, *profile, *technique;
} scopes;

static const xmlNode *find_param(const scopes *in, const char *sid)
{
    const xmlNode *const places[] = {in->technique, in->profile, in->effect};
    for (size_t i = 0; sid != NULL && i < 3; i++) {
        const xmlNode *param = alpi_xml_child(places[i], "newparam");
        for (; param != NULL; param = alpi_xml_next(param, "newparam")) {
            const char *name = alpi_xml_attribute(param, "sid");
            if (name != NULL && strcmp(name, sid) == 0) {
                return param;
            }
        }
    }
    return NULL;
}

static alpi_wrap read_wrap(const xmlNode *sampler, const char *member)
{
    const char *text = alpi_xml_text(alpi_xml_child(sampler, member));
    return strstr(text, "CLAMP") != NULL || strstr(text, "BORDER") != NULL ? ALPI_WRAP_CLAMP
           : strstr(text, "MIRROR") != NULL                                ? ALPI_WRAP_MIRROR
                                                                           : ALPI_WRAP_REPEAT;
}

/// The <image> that a texture="" means: sampler → surface → image, or one of these left out.
static alp_result find_image(const alpi_collada_reader *reader, const scopes *in,
                             const char *texture, alpi_collada_slot *slot, xmlNode **image)
{
    const alpi_collada_document *document = reader->document;
    const xmlNode *sampler = alpi_xml_child(find_param(in, texture), "sampler2D");
    const xmlNode *instance = alpi_xml_child(sampler, "instance_image"); // 1.5
    char *name = NULL;
    if (sampler != NULL) {
        slot->wrap_u = read_wrap(sampler, "wrap_s");
        slot->wrap_v = read_wrap(sampler, "wrap_t");
        const char *url = alpi_xml_attribute(instance, "url");
        name = instance != NULL
                   ? alpi_copy_string(reader->context, url != NULL && *url == '#' ? url + 1 : "")
                   : alpi_xml_copy_text(reader->context, alpi_xml_child(sampler, "source"));
    } else {
        name = alpi_copy_string(reader->context, texture);
    }
    if (name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const xmlNode *surface = alpi_xml_child(find_param(in, name), "surface");
    if (surface != NULL) {
        alpi_release(reader->context, name);
        const xmlNode *from = alpi_xml_child(surface, "init_from");
        from = from != NULL ? from : alpi_xml_child(alpi_xml_child(surface, "init_as_2D"), NULL);
        name = alpi_xml_copy_text(reader->context, from);
        if (name == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
    }
    *image = alpi_collada_find(document, name);
    *image = alpi_xml_is(*image, "image") ? *image : NULL;
    alpi_release(reader->context, name);
    return ALP_OK;
}

static alp_result use_image(alpi_collada_reader *reader, xmlNode *element, uint32_t *index)
{
    uint32_t *slot = &reader->slots[alpi_xml_index(element)];
    if (*slot == 0) {
        ALP_TRY(alpi_collada_grow(reader->context, &reader->images, &reader->image_capacity,
                                  reader->image_count + 1, sizeof *reader->images));
        reader->images[reader->image_count++] = (alpi_collada_image){.element = element};
        *slot = reader->image_count;
    }
    *index = *slot - 1;
    return ALP_OK;
}

static alp_result read_texture(alpi_collada_reader *reader, const scopes *in,
                               const xmlNode *element, alpi_collada_slot *slot)
{
    const char *texture = alpi_xml_attribute(element, "texture");
    xmlNode *image = NULL;
    if (texture != NULL) {
        ALP_TRY(find_image(reader, in, texture, slot, &image));
    }
    if (image == NULL) {
        char owner[ALPI_COLLADA_OWNER_SIZE];
        alpi_collada_owner(reader->document, element, owner);
        alpi_warn(reader->context, "image", owner,
                  "texture=\"%.60s\" names no image: white is used",
                  texture != NULL ? texture : "");
        return ALP_OK;
    }
    slot->texcoord = alpi_xml_attribute(element, "texcoord");
    return use_image(reader, image, &slot->image);
}

/// <color>, <texture> or <param> of a member of the shader.
static alp_result read_slot(alpi_collada_reader *reader, const scopes *in, const xmlNode *shader,
                            const char *member, alpi_collada_slot *slot)
{
    *slot = (alpi_collada_slot){.color = {1, 1, 1, 1}, .image = ALPI_NONE};
    const xmlNode *element = alpi_xml_child(shader, member);
    const xmlNode *color = alpi_xml_child(element, "color");
    const xmlNode *texture = alpi_xml_child(element, "texture");
    const xmlNode *param = alpi_xml_child(element, "param");
    slot->present = color != NULL || texture != NULL || param != NULL;
    if (texture != NULL) {
        return read_texture(reader, in, texture, slot);
    }
    if (param != NULL) {
        const xmlNode *named = find_param(in, alpi_xml_attribute(param, "ref"));
        color = alpi_xml_child(named, "float4");
        color = color != NULL ? color : alpi_xml_child(named, "float3");
    }
    if (color == NULL) {
        return ALP_OK;
    }
    double rgba[4] = {0, 0, 0, 1};
    const char *at = alpi_xml_text(color);
    at += strspn(at, " \t\r\n");
    for (int k = 0; k < 4 && *at != '\0'; k++) { // three where a fourth is of no interest
        if (!alpi_text_number(&at, &rgba[k]) || !isfinite(rgba[k])) {
            return alpi_collada_fail(reader->document, color, "must hold three or four numbers");
        }
    }
    memcpy(slot->color, rgba, sizeof rgba);
    return ALP_OK;
}

static alp_result read_number(const alpi_collada_reader *reader, const scopes *in,
                              const xmlNode *shader, const char *member, double *value)
{
    const xmlNode *element = alpi_xml_child(shader, member);
    const xmlNode *number = alpi_xml_child(element, "float");
    const xmlNode *param = alpi_xml_child(element, "param");
    if (param != NULL) {
        number = alpi_xml_child(find_param(in, alpi_xml_attribute(param, "ref")), "float");
    }
    return number == NULL ? ALP_OK : alpi_collada_doubles(reader->document, number, 1, value);
}

// --- effects -------------------------------------------------------------------------------------

/// <technique> of profile_COMMON.
static const xmlNode *find_technique(const xmlNode *effect)
{
    static const char *const way[] = {"profile_COMMON", "technique", NULL};
    return alpi_xml_descend(effect, way);
}

xmlNode *alpi_collada_shader(const xmlNode *effect)
{
    static const char *const shaders[] = {"phong", "lambert", "blinn", "constant"};
    const xmlNode *technique = find_technique(effect);
    xmlNode *found = NULL;
    for (size_t i = 0; found == NULL && i < 4; i++) {
        found = alpi_xml_child(technique, shaders[i]);
    }
    return found;
}

/// <double_sided>1</double_sided> in an <extra> of the effect, its profile or its technique.
static bool find_double_sided(const scopes *in)
{
    const xmlNode *const places[] = {in->effect, in->profile, in->technique};
    for (size_t i = 0; i < 3; i++) {
        const xmlNode *extra = alpi_xml_child(places[i], "extra");
        for (; extra != NULL; extra = alpi_xml_next(extra, "extra")) {
            const xmlNode *technique = alpi_xml_child(extra, "technique");
            for (; technique != NULL; technique = alpi_xml_next(technique, "technique")) {
                const char *text = alpi_xml_text(alpi_xml_child(technique, "double_sided"));
                if (text[strspn(text, " \t\r\n")] == '1') {
                    return true;
                }
            }
        }
    }
    return false;
}

/// What a bake's image of light stands for: see the writer.
static double find_strength(const xmlNode *technique)
{
    static const char *const way[] = {"extra", "technique", "emission_strength", NULL};
    const char *at = alpi_xml_text(alpi_xml_descend(technique, way));
    double strength = 1.0;
    at += strspn(at, " \t\r\n");
    return alpi_text_number(&at, &strength) && strength >= 0.0 && isfinite(strength) ? strength
                                                                                     : 1.0;
}

static void read_opaque(const xmlNode *shader, alpi_collada_effect *effect)
{
    static const char *const names[] = {"A_ONE", "A_ZERO", "RGB_ONE", "RGB_ZERO"};
    const char *text = alpi_xml_attribute(alpi_xml_child(shader, "transparent"), "opaque");
    effect->opaque = ALPI_OPAQUE_A_ONE;
    for (int i = 0; text != NULL && i < 4; i++) {
        if (strcmp(text, names[i]) == 0) {
            effect->opaque = (alpi_collada_opaque)i;
            effect->opaque_given = true;
        }
    }
}

static alp_result fill_effect(alpi_collada_reader *reader, const xmlNode *element,
                              alpi_collada_effect *effect)
{
    const scopes in = {element, alpi_xml_child(element, "profile_COMMON"), find_technique(element)};
    const xmlNode *shader = alpi_collada_shader(element);
    if (shader == NULL) {
        char owner[ALPI_COLLADA_OWNER_SIZE];
        alpi_collada_owner(reader->document, element, owner);
        alpi_warn(reader->context, "effect", owner,
                  "has no supported common profile (phong, lambert, blinn, constant): a grey of "
                  "albedo 0.5 is used");
    }
    ALP_TRY(read_slot(reader, &in, shader, "diffuse", &effect->diffuse));
    ALP_TRY(read_slot(reader, &in, shader, "emission", &effect->emission));
    ALP_TRY(read_slot(reader, &in, shader, "transparent", &effect->transparent));
    ALP_TRY(read_slot(reader, &in, shader, "ambient", &effect->ambient));
    if (shader == NULL) {
        effect->diffuse.color[0] = effect->diffuse.color[1] = effect->diffuse.color[2] = 0.5;
        effect->diffuse.present = true;
    } else if (alpi_xml_is(shader, "constant")) { // reflects nothing
        effect->diffuse = (alpi_collada_slot){.color = {0, 0, 0, 1}, .image = ALPI_NONE};
        effect->diffuse.present = true;
    }
    effect->transparency = 1.0;
    read_opaque(shader, effect);
    ALP_TRY(read_number(reader, &in, shader, "transparency", &effect->transparency));
    effect->double_sided = find_double_sided(&in);
    for (int k = 0; k < 3 && effect->emission.image != ALPI_NONE; k++) {
        effect->emission.color[k] *= find_strength(in.technique);
    }
    const char *texcoord = effect->ambient.texcoord;
    effect->baked = texcoord != NULL && strcmp(texcoord, ALPI_COLLADA_BAKED_UV) == 0;
    return ALP_OK;
}

static alp_result read_effect(alpi_collada_reader *reader, const xmlNode *element,
                              const alpi_collada_effect **effect)
{
    uint32_t *slot = &reader->slots[alpi_xml_index(element)];
    if (*slot == 0) {
        ALP_TRY(alpi_collada_grow(reader->context, &reader->effects, &reader->effect_capacity,
                                  reader->effect_count + 1, sizeof *reader->effects));
        alpi_collada_effect made = {0};
        ALP_TRY(fill_effect(reader, element, &made));
        reader->effects[reader->effect_count++] = made;
        *slot = reader->effect_count;
    }
    *effect = &reader->effects[*slot - 1];
    return ALP_OK;
}

// --- materials -----------------------------------------------------------------------------------

/// How opaque the numbers say it is.
static double find_alpha(const alpi_collada_effect *effect)
{
    const double *c = effect->transparent.color;
    const double rgb = (c[0] + c[1] + c[2]) / 3.0, t = effect->transparency;
    const double kinds[] = {c[3] * t, 1.0 - c[3] * t, rgb * t, 1.0 - rgb * t};
    return fmin(fmax(kinds[effect->opaque], 0.0), 1.0);
}

static void set_texture(const alpi_collada_slot *slot, uint32_t set, alpi_texture *texture,
                        const alpi_collada_reader *reader)
{
    if (slot->image != ALPI_NONE && set != ALPI_NONE) {
        texture->image = slot->image;
        texture->uv_set = set;
        texture->wrap_u = slot->wrap_u;
        texture->wrap_v = slot->wrap_v;
        reader->images[slot->image].wanted = true;
    }
}

static void set_alpha(alpi_collada_reader *reader, const alpi_collada_effect *effect,
                      alpi_material *material)
{
    if (!effect->transparent.present && effect->transparency >= 1.0) {
        return;
    }
    const bool textured = effect->transparent.image != ALPI_NONE;
    const bool same = textured && effect->transparent.image == effect->diffuse.image;
    double alpha = textured ? fmin(fmax(effect->transparency, 0.0), 1.0) : find_alpha(effect);
    if (textured && !same) {
        alpi_warn(reader->context, "alpha", material->name,
                  "its transparency is in a separate image, which is not read: it counts as "
                  "opaque");
        return;
    }
    if (alpha == 0.0) { // exporters disagree on which end is opaque; nobody models the invisible
        reader->odd_alpha++;
        alpha = 1.0;
    }
    material->base_color[3] = (float)alpha;
    material->alpha_mode = same || alpha < 1.0 ? ALPI_ALPHA_BLEND : ALPI_ALPHA_OPAQUE;
}

static void fill_material(alpi_collada_reader *reader, const alpi_collada_effect *effect,
                          const uint32_t sets[4], alpi_material *material)
{
    if (effect->diffuse.present) {
        for (int k = 0; k < 3; k++) {
            material->base_color[k] = (float)effect->diffuse.color[k];
        }
    }
    for (int k = 0; k < 3 && effect->emission.present; k++) {
        material->emission[k] = (float)effect->emission.color[k];
    }
    set_texture(&effect->diffuse, sets[0], &material->base_color_texture, reader);
    set_texture(&effect->emission, sets[1], &material->emission_texture, reader);
    set_alpha(reader, effect, material);
    if (effect->baked) {
        set_texture(&effect->ambient, sets[3], &material->occlusion_texture, reader);
    }
    material->double_sided = effect->double_sided;
}

static bool bound_number(const xmlNode *bind, double *number)
{
    const char *set = alpi_xml_attribute(bind, "input_set");
    *number = 0.0;
    return set != NULL && alpi_text_number(&set, number);
}

/// Of a texture bound to a set that is not there, as an exporter writes that counts from 1: the
/// only set besides that of our own map. ALPI_NONE with none or several.
static uint32_t only_set(const alpi_collada_reader *reader, const xmlNode *binding,
                         const alpi_collada_part *part)
{
    double ours = -1.0;
    const xmlNode *bind = alpi_collada_bound_to(reader->document, binding, ALPI_COLLADA_BAKED_UV);
    const bool baked = bind != NULL && bound_number(bind, &ours);
    uint32_t found = ALPI_NONE, count = 0;
    for (uint32_t k = 0; k < part->inputs.uv_count; k++) {
        if (!baked || (double)part->inputs.uv_numbers[k] != ours) {
            found = k;
            count++;
        }
    }
    return count == 1 && part->inputs.uv_left_out == 0 ? found : ALPI_NONE;
}

/// Our set of the coordinates that an effect calls `texcoord`; the first where nothing is bound.
static uint32_t find_set(alpi_collada_reader *reader, const xmlNode *binding,
                         const alpi_collada_part *part, const alpi_collada_slot *slot)
{
    if (slot->image == ALPI_NONE) {
        return 0;
    }
    const xmlNode *bind = alpi_collada_bound_to(reader->document, binding, slot->texcoord);
    if (bind == NULL) {
        return part->inputs.uv_count > 0 ? 0 : ALPI_NONE;
    }
    double number = 0.0;
    if (!bound_number(bind, &number)) {
        number = 0.0;
    }
    for (uint32_t k = 0; k < part->inputs.uv_count; k++) {
        if ((double)part->inputs.uv_numbers[k] == number) {
            return k;
        }
    }
    const uint32_t only = only_set(reader, binding, part);
    if (only == ALPI_NONE) {
        reader->lost_set = reader->lost_sets++ == 0 ? bind : reader->lost_set;
    }
    return only;
}

/// Our set of a number of the file's; ALPI_NONE: it is not kept.
static uint32_t kept_set(const alpi_collada_part *part, double number)
{
    for (uint32_t k = 0; k < part->inputs.uv_count && k < ALPI_UV_SET_LIMIT; k++) {
        if ((double)part->inputs.uv_numbers[k] == number) {
            return k;
        }
    }
    return ALPI_NONE;
}

static void blend_texture(const uint8_t slots[3], alpi_texture *texture)
{
    texture->blended = texture->image != ALPI_NONE && texture->uv_set == slots[0];
    memcpy(texture->slots, slots, sizeof texture->slots);
}

/// Sets that an earlier bake bound as three that a shader blends: maps that are read with the first
/// are read with all of them, as far as all are kept.
static void read_blend(const alpi_collada_reader *reader, const xmlNode *binding,
                       const alpi_collada_part *part, alpi_material *material)
{
    static const char *const names[] = {ALPI_COLLADA_BAKED_UV, ALPI_COLLADA_BAKED_UV "_1",
                                        ALPI_COLLADA_BAKED_UV "_2"};
    uint8_t slots[3], bits = 0;
    bool all = true;
    for (int i = 0; i < 3; i++) {
        const xmlNode *bind = alpi_collada_bound_to(reader->document, binding, names[i]);
        double number = 0.0;
        if (bind == NULL || !bound_number(bind, &number)) {
            return;
        }
        const uint32_t set = kept_set(part, number);
        all = all && set != ALPI_NONE;
        slots[i] = (uint8_t)(set != ALPI_NONE ? set : 0);
        bits |= (uint8_t)(set != ALPI_NONE ? 1u << set : 0u);
    }
    material->blend_sets |= bits;
    if (all) {
        blend_texture(slots, &material->occlusion_texture);
        blend_texture(slots, &material->emission_texture);
    }
}

/// A scene material of that element and those sets: found again, or made.
static alp_result get_material(alpi_collada_reader *reader, xmlNode *element,
                               const alpi_collada_effect *effect, const uint32_t sets[4],
                               uint32_t *material)
{
    alp_scene *scene = reader->scene;
    uint32_t *slot = &reader->slots[alpi_xml_index(element)];
    for (uint32_t m = *slot == 0 ? ALPI_NONE : *slot - 1; m != ALPI_NONE;
         m = reader->materials[m].next) {
        if (memcmp(reader->materials[m].sets, sets, 4 * sizeof *sets) == 0) {
            *material = m;
            return ALP_OK;
        }
    }
    ALP_TRY(alpi_collada_grow(reader->context, &reader->materials, &reader->material_capacity,
                              reader->material_count + 1, sizeof *reader->materials));
    ALP_TRY(alpi_collada_grow(reader->context, &scene->materials, &reader->scene_material_capacity,
                              reader->material_count + 1, sizeof *scene->materials));
    char *name = alpi_collada_copy_name(reader->context, element, "");
    if (name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const uint32_t index = reader->material_count++;
    scene->material_count = reader->material_count;
    scene->materials[index] = alpi_material_default();
    scene->materials[index].name = name;
    fill_material(reader, effect, sets, &scene->materials[index]);
    reader->materials[index] = (alpi_collada_material){
        element, {sets[0], sets[1], sets[2], sets[3]}, *slot == 0 ? ALPI_NONE : *slot - 1};
    *slot = index + 1;
    *material = index;
    return ALP_OK;
}

alp_result alpi_collada_read_material(alpi_collada_reader *reader,
                                      const alpi_collada_placement *placement,
                                      const alpi_collada_part *part, uint32_t *material)
{
    const alpi_collada_document *document = reader->document;
    const xmlNode *binding = alpi_collada_bound_to(document, placement->instance, part->symbol);
    xmlNode *element = NULL, *effect_element = NULL;
    *material = ALPI_NONE;
    if (binding != NULL) {
        ALP_TRY(alpi_collada_resolve(document, binding, "target", "material", &element));
    } else if (part->symbol != NULL) { // some exporters write the id of the material as symbol
        element = alpi_collada_find(document, part->symbol);
        element = alpi_xml_is(element, "material") ? element : NULL;
    }
    const xmlNode *instance = alpi_xml_child(element, "instance_effect");
    if (instance != NULL) {
        ALP_TRY(alpi_collada_resolve(document, instance, "url", "effect", &effect_element));
    }
    if (element == NULL || effect_element == NULL) {
        reader->without_material++;
        return ALP_OK;
    }
    const alpi_collada_effect *effect = NULL;
    ALP_TRY(read_effect(reader, effect_element, &effect));
    const uint32_t sets[4] = {find_set(reader, binding, part, &effect->diffuse),
                              find_set(reader, binding, part, &effect->emission),
                              find_set(reader, binding, part, &effect->transparent),
                              find_set(reader, binding, part, &effect->ambient)};
    ALP_TRY(get_material(reader, element, effect, sets, material));
    read_blend(reader, binding, part, &reader->scene->materials[*material]);
    return ALP_OK;
}

// --- images --------------------------------------------------------------------------------------

static alp_result decode_image(const alpi_collada_reader *reader, const xmlNode *element,
                               alp_image **image)
{
    const xmlNode *from = alpi_xml_child(element, "init_from");
    const xmlNode *ref = alpi_xml_child(from, "ref"); // 1.5
    char *uri = alpi_xml_copy_text(reader->context, ref != NULL ? ref : from);
    if (uri == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    uint8_t *bytes = NULL;
    size_t size = 0;
    alp_result result = alpi_collada_file_read(reader->document, uri, &bytes, &size);
    if (result == ALP_OK) {
        char *name = alpi_format(reader->context, "%s: %s", reader->document->path, uri);
        result = name == NULL ? ALP_ERROR_OUT_OF_MEMORY
                              : alpi_image_decode(reader->context, name, bytes, size, image);
        alpi_release(reader->context, name);
    }
    alpi_release(reader->context, bytes);
    alpi_release(reader->context, uri);
    if (result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY) {
        return result;
    }
    char owner[ALPI_COLLADA_OWNER_SIZE];
    alpi_collada_owner(reader->document, element, owner);
    alpi_warn(reader->context, "image", owner, "%.400s; the materials that use it are white there",
              alp_context_message(reader->context));
    return ALP_OK;
}

alp_result alpi_collada_read_images(alpi_collada_reader *reader)
{
    alp_scene *scene = reader->scene;
    scene->images = ALPI_NEW(reader->context, alp_image *, reader->image_count);
    if (scene->images == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    scene->image_count = reader->image_count;
    for (uint32_t i = 0; i < reader->image_count; i++) {
        if (reader->images[i].wanted) {
            ALP_TRY(decode_image(reader, reader->images[i].element, &scene->images[i]));
        }
    }
    return ALP_OK;
}
