// SPDX-License-Identifier: MIT
// Materials: what a bake of diffuse light needs — base colour, metalness, emission, alpha,
// transmission, existing occlusion — and what only drawing needs: normal maps.
// KHR_materials_pbrSpecularGlossiness gives its diffuse colour.
#include "formats/gltf/gltf_read.h"

#include "base/memory.h"
#include "formats/gltf/gltf_tree.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A material's JSON and its name for messages.
typedef struct source {
    const alpi_gltf_reader *reader;
    json_t *object;
    const char *owner;
    bool quiet; // no warnings of textures: alp_scene_load_normal_maps gives them
} source;

static alpi_wrap read_wrap(json_t *sampler, const char *member)
{
    enum { CLAMP_TO_EDGE = 33071, MIRRORED_REPEAT = 33648 };
    double value = json_number_value(json_object_get(sampler, member));
    return value == CLAMP_TO_EDGE     ? ALPI_WRAP_CLAMP
           : value == MIRRORED_REPEAT ? ALPI_WRAP_MIRROR
                                      : ALPI_WRAP_REPEAT;
}

static alp_result read_transform(const source *from, json_t *info, alpi_texture *texture,
                                 size_t *uv_set)
{
    const alpi_gltf_document *document = from->reader->document;
    json_t *transform = alpi_gltf_extension(info, "KHR_texture_transform");
    double offset[2] = {0.0, 0.0}, scale[2] = {1.0, 1.0}, rotation = 0.0;
    ALP_TRY(alpi_gltf_numbers(document, transform, "offset", from->owner, 2, offset));
    ALP_TRY(alpi_gltf_numbers(document, transform, "scale", from->owner, 2, scale));
    ALP_TRY(alpi_gltf_number(document, transform, "rotation", from->owner, &rotation));
    for (int k = 0; k < 2; k++) {
        texture->offset[k] = alpi_gltf_float(offset[k]);
        texture->scale[k] = alpi_gltf_float(scale[k]);
    }
    texture->rotation = alpi_gltf_float(rotation);
    return alpi_gltf_size_or(document, transform, "texCoord", from->owner, *uv_set, uv_set);
}

/// The image of a texture: of EXT_texture_webp first, which is what the file was made to show.
static alp_result find_image(const source *from, size_t index, const char *owner, size_t *image)
{
    const alpi_gltf_document *document = from->reader->document;
    json_t *texture = alpi_gltf_item(document, "textures", index);
    json_t *webp = alpi_gltf_extension(texture, "EXT_texture_webp");
    ALP_TRY(alpi_gltf_index(document, webp, "source", "images", owner, image));
    if (*image == ALPI_GLTF_NONE) {
        ALP_TRY(alpi_gltf_index(document, texture, "source", "images", owner, image));
    }
    if (*image == ALPI_GLTF_NONE && !from->quiet && !document->told_textures[index]) {
        document->told_textures[index] = true;
        alpi_warn(from->reader->context, "image", owner,
                  "has no PNG, JPEG or WebP image%s; its materials are read without this texture",
                  alpi_gltf_extension(texture, "KHR_texture_basisu") != NULL
                      ? " but one of KHR_texture_basisu, which is not read"
                      : "");
    }
    return ALP_OK;
}

/// The textureInfo `member` of an object; no texture when absent or not readable (with a warning).
static alp_result read_texture(const source *from, json_t *object, const char *member,
                               alpi_texture *texture)
{
    const alpi_gltf_document *document = from->reader->document;
    json_t *info = json_object_get(object, member);
    *texture = alpi_texture_none();
    if (info == NULL) {
        return ALP_OK;
    }
    if (!json_is_object(info)) {
        return alpi_gltf_fail(document, from->owner, "%s must be an object", member);
    }
    size_t index, image, sampler, uv_set;
    ALP_TRY(alpi_gltf_needed_index(document, info, "index", "textures", from->owner, &index));
    ALP_TRY(alpi_gltf_size_or(document, info, "texCoord", from->owner, 0, &uv_set));
    ALP_TRY(read_transform(from, info, texture, &uv_set));
    json_t *entry = alpi_gltf_item(document, "textures", index);
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "texture %zu", index);
    ALP_TRY(alpi_gltf_index(document, entry, "sampler", "samplers", owner, &sampler));
    ALP_TRY(find_image(from, index, owner, &image));
    texture->lost = image == ALPI_GLTF_NONE || uv_set >= ALPI_UV_SET_LIMIT;
    if (image == ALPI_GLTF_NONE) {
        return ALP_OK;
    }
    if (uv_set >= ALPI_UV_SET_LIMIT) {
        if (!from->quiet) {
            alpi_warn(from->reader->context, "uv-set", from->owner,
                      "%s uses TEXCOORD_%zu, only 0 to %d are read: the factor is used alone",
                      member, uv_set, ALPI_UV_SET_LIMIT - 1);
        }
        return ALP_OK;
    }
    json_t *wrap = sampler == ALPI_GLTF_NONE ? NULL : alpi_gltf_item(document, "samplers", sampler);
    texture->image = (uint32_t)image;
    texture->uv_set = (uint32_t)uv_set;
    texture->wrap_u = read_wrap(wrap, "wrapS");
    texture->wrap_v = read_wrap(wrap, "wrapT");
    return ALP_OK;
}

alp_result alpi_gltf_read_texture(const alpi_gltf_reader *reader, json_t *object,
                                  const char *member, const char *owner, alpi_texture *texture)
{
    const source from = {reader, object, owner, false};
    return read_texture(&from, object, member, texture);
}

static alp_result read_color(const source *from, json_t *object, const char *member, float rgba[4])
{
    double values[4] = {1.0, 1.0, 1.0, 1.0};
    ALP_TRY(alpi_gltf_numbers(from->reader->document, object, member, from->owner, 4, values));
    for (int k = 0; k < 4; k++) {
        rgba[k] = alpi_gltf_float(values[k]);
    }
    return ALP_OK;
}

static alp_result read_metallic_roughness(const source *from, alpi_material *material)
{
    json_t *object = json_object_get(from->object, "pbrMetallicRoughness");
    double metallic = 1.0;
    ALP_TRY(read_color(from, object, "baseColorFactor", material->base_color));
    ALP_TRY(read_texture(from, object, "baseColorTexture", &material->base_color_texture));
    ALP_TRY(
        alpi_gltf_number(from->reader->document, object, "metallicFactor", from->owner, &metallic));
    material->metallic = alpi_gltf_float(metallic);
    double roughness = 1.0;
    ALP_TRY(alpi_gltf_number(from->reader->document, object, "roughnessFactor", from->owner,
                             &roughness));
    material->shine.roughness = fminf(fmaxf(alpi_gltf_float(roughness), 0.0f), 1.0f);
    ALP_TRY(read_texture(from, object, "metallicRoughnessTexture", &material->metallic_texture));
    material->metallic_assumed = json_object_get(object, "metallicFactor") == NULL &&
                                 material->metallic_texture.image == ALPI_NONE;
    material->shine.roughness_texture = material->metallic_texture;
    return ALP_OK;
}

/// Light does not need it, so nothing of it is warned of here.
static alp_result read_shine(const source *from, alpi_shine *shine)
{
    const alpi_gltf_document *document = from->reader->document;
    const source quiet = {from->reader, from->object, from->owner, true};
    json_t *ior = alpi_gltf_extension(from->object, "KHR_materials_ior");
    json_t *specular = alpi_gltf_extension(from->object, "KHR_materials_specular");
    double index = 0.0, factor = 1.0, color[3] = {1.0, 1.0, 1.0};
    ALP_TRY(alpi_gltf_number(document, ior, "ior", from->owner, &index));
    shine->index = alpi_gltf_float(index);
    if (specular == NULL) {
        return ALP_OK;
    }
    shine->has_specular = true;
    ALP_TRY(alpi_gltf_number(document, specular, "specularFactor", from->owner, &factor));
    ALP_TRY(alpi_gltf_numbers(document, specular, "specularColorFactor", from->owner, 3, color));
    for (int k = 0; k < 3; k++) {
        shine->specular[k] = fminf(fmaxf(alpi_gltf_float(factor * color[k]), 0.0f), 1.0f);
    }
    return read_texture(&quiet, specular, "specularColorTexture", &shine->specular_texture);
}

static alp_result read_specular_glossiness(const source *from, json_t *object,
                                           alpi_material *material)
{
    material->metallic = 0.0f;
    material->metallic_texture = alpi_texture_none();
    ALP_TRY(read_color(from, object, "diffuseFactor", material->base_color));
    return read_texture(from, object, "diffuseTexture", &material->base_color_texture);
}

static alp_result read_emission(const source *from, alpi_material *material)
{
    const alpi_gltf_document *document = from->reader->document;
    double factor[3] = {0.0, 0.0, 0.0}, strength = 1.0;
    json_t *extension = alpi_gltf_extension(from->object, "KHR_materials_emissive_strength");
    ALP_TRY(alpi_gltf_numbers(document, from->object, "emissiveFactor", from->owner, 3, factor));
    ALP_TRY(alpi_gltf_number(document, extension, "emissiveStrength", from->owner, &strength));
    for (int k = 0; k < 3; k++) {
        material->emission[k] = alpi_gltf_float(factor[k] * strength);
    }
    return read_texture(from, from->object, "emissiveTexture", &material->emission_texture);
}

static alp_result read_alpha(const source *from, alpi_material *material)
{
    static const char *const names[] = {"OPAQUE", "MASK", "BLEND"};
    static const alpi_alpha_mode modes[] = {ALPI_ALPHA_OPAQUE, ALPI_ALPHA_MASK, ALPI_ALPHA_BLEND};
    double cutoff = 0.5;
    ALP_TRY(alpi_gltf_number(from->reader->document, from->object, "alphaCutoff", from->owner,
                             &cutoff));
    material->alpha_cutoff = alpi_gltf_float(cutoff);
    material->alpha_mode = ALPI_ALPHA_OPAQUE;
    json_t *mode = json_object_get(from->object, "alphaMode");
    for (size_t i = 0; mode != NULL && i < 3; i++) {
        if (json_is_string(mode) && strcmp(json_string_value(mode), names[i]) == 0) {
            material->alpha_mode = modes[i];
            return ALP_OK;
        }
    }
    return mode == NULL ? ALP_OK
                        : alpi_gltf_fail(from->reader->document, from->owner,
                                         "alphaMode must be OPAQUE, MASK or BLEND");
}

static alp_result read_occlusion(const source *from, alpi_material *material)
{
    double strength = 1.0;
    ALP_TRY(alpi_gltf_number(from->reader->document,
                             json_object_get(from->object, "occlusionTexture"), "strength",
                             from->owner, &strength));
    material->occlusion_strength = alpi_gltf_float(strength);
    return read_texture(from, from->object, "occlusionTexture", &material->occlusion_texture);
}

static alp_result read_transmission(const source *from, alpi_material *material)
{
    json_t *extension = alpi_gltf_extension(from->object, "KHR_materials_transmission");
    double factor = 0.0;
    ALP_TRY(alpi_gltf_number(from->reader->document, extension, "transmissionFactor", from->owner,
                             &factor));
    material->transmission = alpi_gltf_float(factor);
    return read_texture(from, extension, "transmissionTexture", &material->transmission_texture);
}

/// Light does not need it, so nothing of it is warned of here.
static alp_result read_normal(const source *from, alpi_material *material)
{
    const source quiet = {from->reader, from->object, from->owner, true};
    json_t *info = json_object_get(from->object, "normalTexture");
    double scale = 1.0;
    ALP_TRY(alpi_gltf_number(from->reader->document, info, "scale", from->owner, &scale));
    material->normal_scale = alpi_gltf_float(scale);
    return read_texture(&quiet, from->object, "normalTexture", &material->normal_texture);
}

/// Whether a bake made this material for a primitive that had none.
static bool stands_for_none(const source *from)
{
    json_t *mark = json_object_get(json_object_get(from->object, "extras"), "alpenglow");
    return json_is_string(mark) && strcmp(json_string_value(mark), ALPI_GLTF_NO_MATERIAL) == 0;
}

/// The slot that an attribute is kept in; ALPI_NONE: in none.
static uint32_t slot_of(const char *name)
{
    for (uint32_t slot = 0; slot < ALPI_UV_SLOT_COUNT && name != NULL; slot++) {
        char known[ALPI_GLTF_OWNER_SIZE];
        alpi_gltf_slot_name(slot, known, sizeof known);
        if (strcmp(name, known) == 0) {
            return slot;
        }
    }
    return ALPI_NONE;
}

static bool names_map(json_t *blend, const char *map)
{
    json_t *maps = json_object_get(blend, "maps");
    for (size_t i = 0; i < json_array_size(maps); i++) {
        const char *name = json_string_value(json_array_get(maps, i));
        if (name != NULL && strcmp(name, map) == 0) {
            return true;
        }
    }
    return false;
}

/// Three slots of one bake, a bit each. @return whether all of them are kept
static bool read_slots(json_t *blend, uint8_t slots[3], uint8_t *bits)
{
    json_t *sets = json_object_get(blend, "sets");
    bool known = true;
    for (size_t k = 0; k < 3; k++) {
        const uint32_t slot = slot_of(json_string_value(json_array_get(sets, k)));
        known = known && slot != ALPI_NONE;
        slots[k] = (uint8_t)(slot != ALPI_NONE ? slot : 0);
        *bits |= (uint8_t)(slot != ALPI_NONE ? 1u << slot : 0u);
    }
    return known;
}

/// What the extras of a material say of a bake with overlapping charts: the newest (number 0), or
/// one before it; NULL past the last.
static json_t *blend_of(json_t *material, size_t number)
{
    json_t *blend = json_object_get(json_object_get(material, "extras"), ALPI_GLTF_BLEND);
    return number == 0 ? blend
                       : json_array_get(json_object_get(blend, ALPI_GLTF_EARLIER), number - 1);
}

/// Where not all sets of a map are kept, the first alone is read, which is a map too; and where the
/// texture is read with another set, somebody has put a map of his own there.
void alpi_gltf_blend_texture(json_t *material, const char *map, alpi_texture *texture)
{
    json_t *blend = blend_of(material, 0);
    for (size_t i = 0; blend != NULL && !names_map(blend, map);) {
        blend = blend_of(material, ++i);
    }
    uint8_t bits = 0;
    texture->blended = blend != NULL && read_slots(blend, texture->slots, &bits) &&
                       texture->slots[0] == texture->uv_set;
}

/// After the textures are read.
static void read_blend(const source *from, alpi_material *material)
{
    uint8_t slots[3];
    json_t *blend = blend_of(from->object, 0);
    for (size_t i = 0; blend != NULL;) {
        read_slots(blend, slots, &material->blend_sets);
        blend = blend_of(from->object, ++i);
    }
    alpi_gltf_blend_texture(from->object, "occlusionTexture", &material->occlusion_texture);
    alpi_gltf_blend_texture(from->object, "emissiveTexture", &material->emission_texture);
}

static alp_result read_material(const source *from, alpi_material *material)
{
    char *name = alpi_gltf_copy_name(from->reader->context, from->object);
    if (name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *material = alpi_material_default();
    material->name = name;
    material->double_sided = json_is_true(json_object_get(from->object, "doubleSided"));
    material->unlit = alpi_gltf_extension(from->object, "KHR_materials_unlit") != NULL;
    json_t *glossiness = alpi_gltf_extension(from->object, "KHR_materials_pbrSpecularGlossiness");
    ALP_TRY(glossiness != NULL ? read_specular_glossiness(from, glossiness, material)
                               : read_metallic_roughness(from, material));
    if (stands_for_none(from)) { // what the primitive was before: a grey, no metal
        material->metallic = 0.0f;
        material->base_color[0] = material->base_color[1] = material->base_color[2] = 0.5f;
    }
    ALP_TRY(read_emission(from, material));
    ALP_TRY(read_alpha(from, material));
    ALP_TRY(read_transmission(from, material));
    ALP_TRY(read_occlusion(from, material));
    ALP_TRY(read_normal(from, material));
    ALP_TRY(read_shine(from, &material->shine));
    read_blend(from, material);
    return ALP_OK;
}

/// Whether it names a map of light for viewers, which gltf_light_maps.c reads.
static bool names_light_map(json_t *material)
{
    json_t *lightmap = json_object_get(json_object_get(material, "extras"), "lightmap");
    return alpi_gltf_extension(material, "MOZ_lightmap") != NULL ||
           alpi_gltf_text(lightmap, "uri") != NULL;
}

alp_result alpi_gltf_read_materials(alpi_gltf_reader *reader)
{
    size_t count = alpi_gltf_count(reader->document, "materials");
    if (count >= ALPI_NONE || alpi_gltf_count(reader->document, "images") >= ALPI_NONE) {
        return alpi_fail(reader->context, ALP_ERROR_LIMIT, "%s: too many materials or images",
                         reader->document->path);
    }
    ALPI_TRY_NEW(reader->context, reader->material_used, count);
    ALPI_TRY_NEW(reader->context, reader->scene->materials, count);
    reader->scene->material_count = (uint32_t)count;
    for (size_t i = 0; i < count; i++) {
        char owner[ALPI_GLTF_OWNER_SIZE];
        snprintf(owner, sizeof owner, "material %zu", i);
        source from = {reader, alpi_gltf_item(reader->document, "materials", i), owner, false};
        ALP_TRY(read_material(&from, &reader->scene->materials[i]));
        reader->scene->light_map_count += names_light_map(from.object) ? 1 : 0;
    }
    return ALP_OK;
}

void alpi_gltf_check_sets(const alpi_gltf_reader *reader, const alpi_surface *surface,
                          const size_t accessors[ALPI_UV_SLOT_COUNT])
{
    if (surface->material == ALPI_NONE) {
        return;
    }
    const alpi_material *m = &reader->scene->materials[surface->material];
    const alpi_texture *textures[] = {&m->base_color_texture, &m->metallic_texture,
                                      &m->emission_texture, &m->occlusion_texture,
                                      &m->transmission_texture};
    for (size_t i = 0; i < sizeof textures / sizeof *textures; i++) {
        if (textures[i]->image != ALPI_NONE && accessors[textures[i]->uv_set] == ALPI_GLTF_NONE) {
            alpi_warn(reader->context, "no-uv", surface->name,
                      "its material \"%s\" reads a texture by TEXCOORD_%u, which it does not have",
                      m->name, textures[i]->uv_set);
            return;
        }
    }
}
