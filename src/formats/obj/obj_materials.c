// SPDX-License-Identifier: MIT
// MTL statements → materials: Kd, Ke, d, Tr and their maps; and gloss and relief (Ks, Ns, Ni, Pr,
// Pm, bump, norm), which have no part in diffuse light, for files that are written.
#include "formats/obj/obj_materials.h"

#include "base/memory.h"
#include "formats/files/outside.h"
#include "formats/text/utf8.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static alpi_material *last_material(const alpi_mtl_reader *r)
{
    return &r->scene->materials[r->scene->material_count - 1];
}

void alpi_mtl_show(alpi_obj_word word, char text[128])
{
    alpi_utf8_print(word.text, word.size, text, 128);
    for (char *c = text; *c != '\0'; c++) {
        *c = (unsigned char)*c < 0x20 || *c == 0x7f ? '?' : *c;
    }
}

// --- textures ------------------------------------------------------------------------------------

/// The texture of a statement; lost where the file that it names is outside.
static alp_result find_texture(alpi_mtl_reader *r, alpi_obj_text *t, alpi_texture *texture,
                               float *bump, char shown[128])
{
    alpi_mtl_picture picture;
    bool added;
    *texture = alpi_texture_none();
    alp_result result = alpi_mtl_take_picture(t, r->obj->folder, r->folder, &picture);
    if (result == ALP_OK && picture.name.size > 0) {
        *texture = picture.texture;
        alpi_mtl_show(picture.name, shown);
        texture->lost = picture.path == NULL;
        if (picture.path != NULL) {
            result = alpi_obj_names_add(r->images, picture.path, strlen(picture.path),
                                        &texture->image, &added);
            if (result == ALP_OK && added) {
                alpi_note_found(r->obj->context, shown, picture.path, picture.found);
            }
        }
    }
    if (bump != NULL) {
        *bump = picture.bump;
    }
    alpi_release(r->obj->context, picture.path);
    return result;
}

static alp_result read_texture(alpi_mtl_reader *r, alpi_obj_text *t, const char *what,
                               alpi_texture *texture)
{
    char shown[128];
    ALP_TRY(find_texture(r, t, texture, NULL, shown));
    if (texture->lost && alpi_path_is_foreign(shown)) {
        alpi_warn(r->obj->context, "image", last_material(r)->name,
                  "%s: line %llu: \"%s\" leaves the asset's folder, for a folder of another "
                  "machine; put the file beside the asset: the colour of %s is used alone",
                  t->path, (unsigned long long)t->line, shown, what + 4);
    } else if (texture->lost) {
        alpi_warn(r->obj->context, "image", last_material(r)->name,
                  "%s: line %llu: \"%s\" leaves the asset's folder; " ALPI_OUTSIDE_HINT ": "
                  "the colour of %s is used alone",
                  t->path, (unsigned long long)t->line, shown, what + 4);
    }
    return ALP_OK;
}

/// A texture that light does not read, so nothing is warned of here.
static alp_result read_quiet_texture(alpi_mtl_reader *r, alpi_obj_text *t, alpi_texture *texture,
                                     float *bump)
{
    char shown[128];
    return find_texture(r, t, texture, bump, shown);
}

// --- the end of a material -----------------------------------------------------------------------

static bool is_same_place(const alpi_texture *a, const alpi_texture *b)
{
    return a->wrap_u == b->wrap_u && a->wrap_v == b->wrap_v && a->scale[0] == b->scale[0] &&
           a->scale[1] == b->scale[1] && a->offset[0] == b->offset[0] &&
           a->offset[1] == b->offset[1];
}

/// A mask in a file of its own becomes the alpha of one picture with the colours: "COLOURS\nMASK".
static alp_result join_mask(alpi_mtl_reader *r, alpi_material *m)
{
    alpi_texture *base = &m->base_color_texture;
    bool added;
    if (base->image == r->mask.image) {
        return ALP_OK;
    }
    char *name = alpi_format(r->obj->context, "%s\n%s",
                             base->image == ALPI_NONE ? "" : alpi_obj_name(r->images, base->image),
                             alpi_obj_name(r->images, r->mask.image));
    if (name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result =
        alpi_obj_names_add(r->images, name, strlen(name), &r->mask.image, &added);
    alpi_release(r->obj->context, name);
    *base = r->mask;
    return result;
}

/// Alpha is d, else 1 − Tr; exporters disagree on the sign of Tr, and nobody models the invisible.
static alp_result finish_alpha(alpi_mtl_reader *r, alpi_material *m)
{
    if (!r->has_opacity && r->transparency >= 1.0f) {
        r->invisible++;
    } else if (!r->has_opacity) {
        m->base_color[3] = 1.0f - r->transparency;
    }
    const bool blends = m->base_color[3] < 1.0f;
    m->alpha_mode = blends ? ALPI_ALPHA_BLEND : ALPI_ALPHA_OPAQUE;
    if (r->mask.image == ALPI_NONE) {
        return ALP_OK;
    }
    if (m->base_color_texture.image != ALPI_NONE && m->base_color_texture.image != r->mask.image &&
        !is_same_place(&m->base_color_texture, &r->mask)) {
        alpi_warn(r->obj->context, "map-d", m->name,
                  "map_d has other -s, -o or -clamp than map_Kd, and is left out: the material is "
                  "read as opaque; give both the same");
        return ALP_OK;
    }
    ALP_TRY(join_mask(r, m));
    m->alpha_mode = blends ? ALPI_ALPHA_BLEND : ALPI_ALPHA_MASK;
    m->alpha_cutoff = 0.5f;
    return ALP_OK;
}

/// Roughness of a Blinn-Phong exponent: α² = 2 / (n + 2) (B. Walter, S. Marschner, H. Li and
/// K. Torrance. Microfacet Models for Refraction through Rough Surfaces, EGSR 2007), where glTF has
/// α = roughness². Without highlights an exponent means nothing.
static void finish_shine(const alpi_mtl_reader *r, alpi_shine *shine)
{
    const bool dull = r->model < 2 || (shine->has_specular && shine->specular[0] <= 0.0f &&
                                       shine->specular[1] <= 0.0f && shine->specular[2] <= 0.0f);
    if (!r->has_roughness && r->exponent >= 0.0f && !dull) {
        shine->roughness = powf(2.0f / (r->exponent + 2.0f), 0.25f);
    }
    if (!r->has_roughness && shine->roughness_texture.image != ALPI_NONE) {
        shine->roughness = 1.0f; // the map holds it
    }
    shine->roughness = fminf(fmaxf(shine->roughness, 0.0f), 1.0f);
    for (int k = 0; k < 3; k++) {
        shine->specular[k] = fminf(fmaxf(shine->specular[k], 0.0f), 1.0f);
    }
}

alp_result alpi_mtl_finish_material(alpi_mtl_reader *r)
{
    if (r->skipping || r->scene->material_count == 0) {
        return ALP_OK;
    }
    alpi_material *m = last_material(r);
    if (r->occlusion && m->base_color_texture.image == m->occlusion_texture.image) {
        m->base_color_texture = alpi_texture_none(); // an earlier bake put it there for viewers
    } else if (!r->occlusion) {
        m->occlusion_texture = alpi_texture_none(); // map_Ka alone means something else
    }
    if (!r->has_color && m->base_color_texture.image == ALPI_NONE) {
        m->base_color[0] = m->base_color[1] = m->base_color[2] = 0.5f; // as without a material
    }
    if (!r->has_emission && m->emission_texture.image != ALPI_NONE) {
        m->emission[0] = m->emission[1] = m->emission[2] = 1.0f; // else its picture means nothing
    }
    if (m->metallic_texture.image != ALPI_NONE && m->metallic == 0.0f) {
        m->metallic = 1.0f; // a map without Pm
    }
    finish_shine(r, &m->shine);
    const alp_result result = finish_alpha(r, m);
    r->mask = alpi_texture_none();
    return result;
}

// --- statements ----------------------------------------------------------------------------------

static alp_result start_material(alpi_mtl_reader *r, alpi_obj_text *t)
{
    alp_scene *s = r->scene;
    const alpi_obj_word name = alpi_obj_take_rest(t);
    uint32_t number;
    bool added;
    ALP_TRY(alpi_mtl_finish_material(r));
    ALP_TRY(alpi_obj_names_add(&r->names, name.text, name.size, &number, &added));
    r->skipping = !added;
    r->has_color = r->has_emission = r->has_opacity = r->has_roughness = r->occlusion = false;
    r->transparency = 0.0f;
    r->exponent = -1.0f;
    r->model = 2;
    r->mask = alpi_texture_none();
    if (!added) {
        char shown[128];
        alpi_mtl_show(name, shown);
        alpi_note(r->obj->context, "material", shown,
                  "%s: line %llu: there is a material of this name already, which is used", t->path,
                  (unsigned long long)t->line);
        return ALP_OK;
    }
    void *items = s->materials;
    ALP_TRY(alpi_grow(r->obj->context, &items, &r->capacity, (size_t)s->material_count + 1,
                      sizeof *s->materials));
    s->materials = items;
    alpi_material *m = &s->materials[s->material_count];
    *m = alpi_material_default();
    m->name = alpi_utf8_copy(r->obj->context, name.text, name.size);
    if (m->name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    s->material_count++;
    for (char *c = m->name; *c != '\0'; c++) {
        *c = (unsigned char)*c < 0x20 || *c == 0x7f ? '?' : *c;
    }
    return ALP_OK;
}

/// Three numbers, or one for all.
static alp_result take_color(alpi_obj_text *t, const char *what, float color[3])
{
    float values[3];
    ALP_TRY(alpi_obj_take_float(t, what, &values[0]));
    values[1] = values[2] = values[0];
    for (int k = 1; k < 3 && alpi_obj_more(t); k++) {
        ALP_TRY(alpi_obj_take_float(t, what, &values[k]));
    }
    memcpy(color, values, sizeof values);
    return ALP_OK;
}

/// A spectrum file and CIE XYZ are not read. *has: whether the material has the colour
static alp_result read_color(alpi_mtl_reader *r, alpi_obj_text *t, const char *what, float color[3],
                             bool *has)
{
    alpi_obj_text ahead = *t;
    const alpi_obj_word first = alpi_obj_take_word(&ahead);
    if (alpi_obj_word_is(first, "spectral") || alpi_obj_word_is(first, "xyz")) {
        *has = true; // of an unknown value
        alpi_note(r->obj->context, "color", last_material(r)->name,
                  "%s: line %llu: %s is read as red, green and blue only", t->path,
                  (unsigned long long)t->line, what);
        return ALP_OK;
    }
    ALP_TRY(take_color(t, what, color));
    *has = true;
    return ALP_OK;
}

/// A value that stays where there is no number.
static alp_result take_number(alpi_obj_text *t, const char *what, float *value)
{
    float number;
    ALP_TRY(alpi_obj_take_float(t, what, &number));
    *value = number;
    return ALP_OK;
}

static alp_result read_opacity(alpi_obj_text *t, const char *what, float *value)
{
    alpi_obj_text ahead = *t;
    if (alpi_obj_word_is(alpi_obj_take_word(&ahead), "-halo")) {
        *t = ahead;
    }
    return take_number(t, what, value);
}

static alp_result read_model(alpi_obj_text *t, int *model)
{
    float number;
    ALP_TRY(take_number(t, "illum", &number));
    *model = number >= 0.0f && number < 2.0f ? (int)number : 2;
    return ALP_OK;
}

/// Gloss and relief.
static alp_result read_shine(alpi_mtl_reader *r, alpi_obj_text *t, alpi_obj_word key)
{
    alpi_material *m = last_material(r);
    alpi_shine *shine = &m->shine;
    if (alpi_obj_word_is(key, "Ks")) {
        return read_color(r, t, "Ks", shine->specular, &shine->has_specular);
    }
    if (alpi_obj_word_is(key, "Ns")) {
        return take_number(t, "Ns", &r->exponent);
    }
    if (alpi_obj_word_is(key, "Ni")) {
        return take_number(t, "Ni", &shine->index);
    }
    if (alpi_obj_word_is(key, "Pr")) {
        ALP_TRY(take_number(t, "Pr", &shine->roughness));
        r->has_roughness = true;
    } else if (alpi_obj_word_is(key, "Pm")) {
        return take_number(t, "Pm", &m->metallic);
    } else if (alpi_obj_word_is(key, "illum")) {
        return read_model(t, &r->model);
    } else if (alpi_obj_word_is(key, "map_Ks")) {
        shine->has_specular = true;
        return read_quiet_texture(r, t, &shine->specular_texture, NULL);
    } else if (alpi_obj_word_is(key, "map_Pr")) {
        return read_quiet_texture(r, t, &shine->roughness_texture, NULL);
    } else if (alpi_obj_word_is(key, "map_Pm")) {
        return read_quiet_texture(r, t, &m->metallic_texture, NULL);
    } else if (alpi_obj_word_is(key, "norm") || alpi_obj_word_is(key, "map_Kn")) {
        return read_quiet_texture(r, t, &m->normal_texture, &m->normal_scale);
    } else if (alpi_obj_word_is(key, "map_Bump") || alpi_obj_word_is(key, "map_bump") ||
               alpi_obj_word_is(key, "bump")) { // heights or normals: the file does not state which
        return read_quiet_texture(r, t, &shine->bump_texture, &shine->bump_scale);
    }
    return ALP_OK;
}

alp_result alpi_mtl_read_statement(alpi_mtl_reader *r, alpi_obj_text *t)
{
    const alpi_obj_word key = alpi_obj_take_word(t);
    if (alpi_obj_word_is(key, "newmtl")) {
        return start_material(r, t);
    }
    if (r->scene->material_count == 0 || r->skipping) {
        return ALP_OK;
    }
    alpi_material *m = last_material(r);
    if (alpi_obj_word_is(key, "Kd")) {
        return read_color(r, t, "Kd", m->base_color, &r->has_color);
    }
    if (alpi_obj_word_is(key, "Ke")) {
        return read_color(r, t, "Ke", m->emission, &r->has_emission);
    }
    if (alpi_obj_word_is(key, "d")) {
        ALP_TRY(read_opacity(t, "d", &m->base_color[3]));
        r->has_opacity = true;
        return ALP_OK;
    }
    if (alpi_obj_word_is(key, "Tr")) {
        return read_opacity(t, "Tr", &r->transparency);
    }
    if (alpi_obj_word_is(key, "map_Kd")) {
        return read_texture(r, t, "map_Kd", &m->base_color_texture);
    }
    if (alpi_obj_word_is(key, "map_Ke")) {
        return read_texture(r, t, "map_Ke", &m->emission_texture);
    }
    if (alpi_obj_word_is(key, "map_Ka") && r->occlusion) {
        return read_texture(r, t, "map_Ka", &m->occlusion_texture);
    }
    if (alpi_obj_word_is(key, "map_d")) {
        return read_texture(r, t, "map_d", &r->mask);
    }
    r->occlusion = r->occlusion || alpi_obj_word_is(key, "alpenglow_occlusion");
    return read_shine(r, t, key);
}
