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
    alpi_collada_read_placing(element, slot);
    return use_image(reader, image, &slot->image);
}

/// The numbers of a colour: its own, or those of the parameter that it names. NULL without.
static const xmlNode *find_color(const scopes *in, const xmlNode *element)
{
    const xmlNode *param = alpi_xml_child(element, "param");
    if (param == NULL) {
        return alpi_xml_child(element, "color");
    }
    const xmlNode *named = find_param(in, alpi_xml_attribute(param, "ref"));
    const xmlNode *color = alpi_xml_child(named, "float4");
    return color != NULL ? color : alpi_xml_child(named, "float3");
}

/// Three numbers, or four where the last is of interest. False at what is no number.
static bool read_color(const xmlNode *color, double rgba[4])
{
    const double none[4] = {0, 0, 0, 1};
    const char *at = alpi_xml_text(color);
    memcpy(rgba, none, sizeof none);
    at += strspn(at, " \t\r\n");
    for (int k = 0; k < 4 && *at != '\0'; k++) {
        if (!alpi_text_number(&at, &rgba[k]) || !isfinite(rgba[k])) {
            return false;
        }
    }
    return true;
}

/// <color>, <texture> or <param> of a member of the shader.
static alp_result read_slot(alpi_collada_reader *reader, const scopes *in, const xmlNode *shader,
                            const char *member, alpi_collada_slot *slot)
{
    *slot = (alpi_collada_slot){.color = {1, 1, 1, 1}, .image = ALPI_NONE, .repeat = {1.0f, 1.0f}};
    const xmlNode *element = alpi_xml_child(shader, member);
    const xmlNode *color = alpi_xml_child(element, "color");
    const xmlNode *texture = alpi_xml_child(element, "texture");
    const xmlNode *param = alpi_xml_child(element, "param");
    slot->present = color != NULL || texture != NULL || param != NULL;
    if (texture != NULL) {
        return read_texture(reader, in, texture, slot);
    }
    if (param != NULL) {
        color = find_color(in, element);
    }
    if (color == NULL) {
        return ALP_OK;
    }
    return read_color(color, slot->color)
               ? ALP_OK
               : alpi_collada_fail(reader->document, color, "must hold three or four numbers");
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

/// The normal map: <bump> in an <extra> of the technique, as Blender and three.js have it. One of
/// heights is none.
static alp_result read_normal(alpi_collada_reader *reader, const scopes *in,
                              alpi_collada_effect *effect)
{
    const xmlNode *bump = alpi_collada_find_extra(in->technique, "bump");
    const xmlNode *texture = alpi_xml_child(bump, "texture");
    const char *type = alpi_xml_attribute(bump, "bumptype");
    effect->normal = (alpi_collada_slot){.image = ALPI_NONE, .repeat = {1.0f, 1.0f}};
    if (texture == NULL) {
        return ALP_OK;
    }
    if (type != NULL && strncmp(type, "NORMAL", strlen("NORMAL")) != 0) {
        effect->has_heights = true;
        return ALP_OK;
    }
    return read_texture(reader, in, texture, &effect->normal);
}

static bool has_texture(const xmlNode *shader, const char *member)
{
    return alpi_xml_child(alpi_xml_child(shader, member), "texture") != NULL;
}

/// Gloss, which conversions carry. A bake can do without, so faults in it count as not stated.
static alp_result read_gloss(const alpi_collada_reader *reader, const scopes *in,
                             const xmlNode *shader, alpi_collada_effect *effect)
{
    const xmlNode *specular = find_color(in, alpi_xml_child(shader, "specular"));
    const xmlNode *reflective = find_color(in, alpi_xml_child(shader, "reflective"));
    double color[4], shininess = -1.0, reflectivity = 1.0;
    const alp_result result = read_number(reader, in, shader, "shininess", &shininess);
    const alp_result mirror = read_number(reader, in, shader, "reflectivity", &reflectivity);
    if (result == ALP_ERROR_OUT_OF_MEMORY || mirror == ALP_ERROR_OUT_OF_MEMORY) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    effect->shininess = result == ALP_OK ? (float)fmin(shininess, 1e6) : -1.0f;
    for (int k = 0; specular != NULL && read_color(specular, color) && k < 3; k++) {
        effect->specular[k] = (float)fmin(fmax(color[k], 0.0), 1.0);
    }
    effect->has_gloss_map = has_texture(shader, "specular") || has_texture(shader, "shininess");
    effect->has_mirror = mirror == ALP_OK && reflectivity > 0.0 &&
                         (has_texture(shader, "reflective") ||
                          (reflective != NULL && read_color(reflective, color) &&
                           color[0] + color[1] + color[2] > 0.0));
    return ALP_OK;
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
    const xmlNode *const places[] = {in.effect, in.profile, in.technique};
    for (size_t i = 0; i < 3; i++) {
        effect->double_sided |= alpi_collada_is_double_sided(places[i]);
    }
    ALP_TRY(read_normal(reader, &in, effect));
    ALP_TRY(read_gloss(reader, &in, shader, effect));
    for (int k = 0; k < 3 && effect->emission.image != ALPI_NONE; k++) {
        effect->emission.color[k] *= find_strength(in.technique);
    }
    const char *texcoord = effect->ambient.texcoord;
    effect->baked = texcoord != NULL && strcmp(texcoord, ALPI_COLLADA_BAKED_UV) == 0;
    return ALP_OK;
}

/// An effect that cannot be read is a grey.
static alp_result fill_effect_or_grey(alpi_collada_reader *reader, const xmlNode *element,
                                      alpi_collada_effect *effect)
{
    char reason[ALPI_COLLADA_REASON_SIZE];
    alp_result result = fill_effect(reader, element, effect);
    if (alpi_collada_survives(reader->document, &result, reason)) {
        alpi_warn(reader->context, "effect", reader->document->path,
                  "%s; a grey of albedo 0.5 is used", reason);
        const alpi_collada_slot none = {.color = {1, 1, 1, 1}, .image = ALPI_NONE};
        *effect = (alpi_collada_effect){
            none, none, none, none, none, .transparency = 1.0, .shininess = -1.0f};
        effect->diffuse = (alpi_collada_slot){true, {0.5, 0.5, 0.5, 1.0}, .image = ALPI_NONE};
    }
    return result;
}

alp_result alpi_collada_read_effect(alpi_collada_reader *reader, const xmlNode *element,
                                    const alpi_collada_effect **effect)
{
    uint32_t *slot = &reader->slots[alpi_xml_index(element)];
    if (*slot == 0) {
        ALP_TRY(alpi_collada_grow(reader->context, &reader->effects, &reader->effect_capacity,
                                  reader->effect_count + 1, sizeof *reader->effects));
        alpi_collada_effect made = {0};
        ALP_TRY(fill_effect_or_grey(reader, element, &made));
        reader->effects[reader->effect_count++] = made;
        *slot = reader->effect_count;
    }
    *effect = &reader->effects[*slot - 1];
    return ALP_OK;
}
