// SPDX-License-Identifier: MIT
// Materials of the scene: an effect with the coordinate sets that an instance binds. Images that
// they use.
#include "formats/collada/collada_read.h"

#include "base/memory.h"
#include "formats/collada/collada_marks.h"
#include "formats/collada/collada_numbers.h"
#include "formats/collada/collada_scene.h"
#include "formats/images/images.h"

#include <math.h>
#include <string.h>

// --- from an effect ------------------------------------------------------------------------------

/// How opaque the numbers say it is.
static double find_alpha(const alpi_collada_effect *effect)
{
    const double *c = effect->transparent.color;
    const double rgb = (c[0] + c[1] + c[2]) / 3.0, t = effect->transparency;
    const double kinds[] = {c[3] * t, 1.0 - c[3] * t, rgb * t, 1.0 - rgb * t};
    return fmin(fmax(kinds[effect->opaque], 0.0), 1.0);
}

/// @return whether there is one
static bool set_texture(const alpi_collada_slot *slot, uint32_t set, alpi_texture *texture)
{
    const bool there = slot->image != ALPI_NONE && set != ALPI_NONE;
    if (there) {
        texture->image = slot->image;
        texture->uv_set = set;
        texture->wrap_u = slot->wrap_u;
        texture->wrap_v = slot->wrap_v;
        texture->scale[0] = slot->repeat[0];
        texture->scale[1] = slot->repeat[1];
        texture->offset[0] = slot->offset[0];
        texture->offset[1] = 1.0f - slot->offset[1] - slot->repeat[1]; // v from the top
    }
    return there;
}

/// The same of an image that light needs.
static void use_texture(alpi_collada_reader *reader, const alpi_collada_slot *slot, uint32_t set,
                        alpi_texture *texture)
{
    if (set_texture(slot, set, texture)) {
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

/// Gloss of effects that state an exponent n of Phong or Blinn: √(2 / (n + 2)) is the square of
/// roughness (B. Walter, S. Marschner, H. Li and K. Torrance. Microfacet Models for Refraction
/// through Rough Surfaces, EGSR 2007). Without specular colour an exponent means nothing.
static void set_shine(const alpi_collada_effect *effect, alpi_shine *shine)
{
    const float *c = effect->specular;
    if (effect->shininess < 0.0f) {
        return;
    }
    shine->has_specular = true;
    memcpy(shine->specular, c, sizeof shine->specular);
    if (c[0] + c[1] + c[2] > 0.0f) {
        shine->roughness = powf(2.0f / (effect->shininess + 2.0f), 0.25f);
    }
}

static void fill_material(alpi_collada_reader *reader, const alpi_collada_effect *effect,
                          const uint32_t sets[ALPI_COLLADA_SLOT_COUNT], alpi_material *material)
{
    if (effect->diffuse.present) {
        for (int k = 0; k < 3; k++) {
            material->base_color[k] = (float)effect->diffuse.color[k];
        }
    }
    for (int k = 0; k < 3 && effect->emission.present; k++) {
        material->emission[k] = (float)effect->emission.color[k];
    }
    use_texture(reader, &effect->diffuse, sets[0], &material->base_color_texture);
    use_texture(reader, &effect->emission, sets[1], &material->emission_texture);
    set_alpha(reader, effect, material);
    if (effect->baked) {
        use_texture(reader, &effect->ambient, sets[3], &material->occlusion_texture);
    }
    set_shine(effect, &material->shine);
    set_texture(&effect->normal, sets[4],
                &material->normal_texture); // decoded when it is asked for
}

static bool bound_number(const xmlNode *bind, double *number)
{
    const char *set = alpi_xml_attribute(bind, "input_set");
    *number = 0.0;
    return set != NULL && alpi_text_number(&set, number);
}

/// The only set besides that of our own map, for a texture that names a missing set. Exporters that
/// count from 1 name such sets. ALPI_NONE with none or several.
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

/// A scene material like that: found again, or made.
static alp_result get_material(alpi_collada_reader *reader, const alpi_collada_material *wanted,
                               const alpi_collada_effect *effect, uint32_t *material)
{
    alp_scene *scene = reader->scene;
    uint32_t *slot = &reader->slots[alpi_xml_index(wanted->element)];
    const uint32_t first = *slot == 0 ? ALPI_NONE : *slot - 1;
    for (uint32_t m = first; m != ALPI_NONE; m = reader->materials[m].next) {
        if (memcmp(reader->materials[m].sets, wanted->sets, sizeof wanted->sets) == 0 &&
            reader->materials[m].double_sided == wanted->double_sided) {
            *material = m;
            return ALP_OK;
        }
    }
    ALP_TRY(alpi_collada_grow(reader->context, &reader->materials, &reader->material_capacity,
                              reader->material_count + 1, sizeof *reader->materials));
    ALP_TRY(alpi_collada_grow(reader->context, &scene->materials, &reader->scene_material_capacity,
                              reader->material_count + 1, sizeof *scene->materials));
    char *name = alpi_collada_copy_name(reader->context, wanted->element, "");
    if (name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const uint32_t index = reader->material_count++;
    scene->material_count = reader->material_count;
    scene->materials[index] = alpi_material_default();
    scene->materials[index].name = name;
    scene->materials[index].double_sided = wanted->double_sided;
    fill_material(reader, effect, wanted->sets, &scene->materials[index]);
    reader->materials[index] = *wanted;
    reader->materials[index].next = first;
    *slot = index + 1;
    *material = index;
    return ALP_OK;
}

/// The <material> of a part at a placement and its <effect>; NULL without.
static alp_result find_material(alpi_collada_reader *reader, const xmlNode *binding,
                                const char *symbol, xmlNode **material, xmlNode **effect)
{
    *material = *effect = NULL;
    if (binding != NULL) {
        ALP_TRY(alpi_collada_refer(reader, binding, "target", "material", material));
    } else if (symbol != NULL) { // some exporters write the id of the material as symbol
        *material = alpi_collada_find(reader->document, symbol);
        *material = alpi_xml_is(*material, "material") ? *material : NULL;
    }
    const xmlNode *instance = alpi_xml_child(*material, "instance_effect");
    return instance == NULL ? ALP_OK
                            : alpi_collada_refer(reader, instance, "url", "effect", effect);
}

alp_result alpi_collada_read_material(alpi_collada_reader *reader,
                                      const alpi_collada_placement *placement,
                                      const alpi_collada_part *part, uint32_t *material)
{
    const xmlNode *binding =
        alpi_collada_bound_to(reader->document, placement->instance, part->symbol);
    xmlNode *element = NULL, *effect_element = NULL;
    *material = ALPI_NONE;
    ALP_TRY(find_material(reader, binding, part->symbol, &element, &effect_element));
    if (element == NULL || effect_element == NULL) {
        reader->without_material++;
        return ALP_OK;
    }
    const alpi_collada_effect *effect = NULL;
    ALP_TRY(alpi_collada_read_effect(reader, effect_element, &effect));
    const alpi_collada_material wanted = {
        .element = element,
        .sets = {find_set(reader, binding, part, &effect->diffuse),
                 find_set(reader, binding, part, &effect->emission),
                 find_set(reader, binding, part, &effect->transparent),
                 find_set(reader, binding, part, &effect->ambient),
                 find_set(reader, binding, part, &effect->normal)},
        .double_sided = effect->double_sided || reader->meshes[placement->mesh].double_sided,
        .next = ALPI_NONE};
    ALP_TRY(get_material(reader, &wanted, effect, material));
    read_blend(reader, binding, part, &reader->scene->materials[*material]);
    return ALP_OK;
}

// --- images --------------------------------------------------------------------------------------

static alp_result decode_image(const alpi_collada_document *document, const xmlNode *element,
                               alp_image **image)
{
    alp_context *context = document->context;
    const xmlNode *from = alpi_xml_child(element, "init_from");
    const xmlNode *ref = alpi_xml_child(from, "ref"); // 1.5
    char *uri = alpi_xml_copy_text(context, ref != NULL ? ref : from);
    if (uri == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    uint8_t *bytes = NULL;
    size_t size = 0;
    alp_result result = alpi_collada_note_file(document, uri);
    if (result == ALP_OK) {
        result = alpi_collada_file_read(document, uri, &bytes, &size);
    }
    if (result == ALP_OK) {
        char *name = alpi_format(context, "%s: %s", document->path, uri);
        result = name == NULL ? ALP_ERROR_OUT_OF_MEMORY
                              : alpi_image_decode(context, name, bytes, size, image);
        alpi_release(context, name);
    }
    alpi_release(context, bytes);
    alpi_release(context, uri);
    if (result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY) {
        return result;
    }
    char owner[ALPI_COLLADA_OWNER_SIZE];
    alpi_collada_owner(document, element, owner);
    alpi_warn(context, "image", owner, "%.400s; the materials that use it are white there",
              alpi_collada_reason(document));
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
            ALP_TRY(decode_image(reader->document, reader->images[i].element, &scene->images[i]));
        }
    }
    return ALP_OK;
}

alp_result alpi_collada_read_image(const alp_scene *scene, uint32_t index, alp_image **image)
{
    const alpi_collada_origin *origin = scene->attachments[ALPI_ATTACHMENT_COLLADA].data;
    return decode_image(origin->document, origin->images[index], image);
}
