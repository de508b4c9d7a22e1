// SPDX-License-Identifier: MIT
// Materials and pictures of a scene as glTF 2.0 names them. Roughness and metalness that come from
// pictures of their own become green and blue of one (section 3.9.3).
#include "formats/gltf/write/gltf_export.h"

#include "base/memory.h"
#include "base/plural.h"
#include "formats/images/images.h"

#include <math.h>

static const float DEFAULT_INDEX = 1.5f; // of refraction, in glTF

/// A factor beside a texture, written where it is not 1.
typedef struct factor {
    const char *name;
    float value;
} factor;
static const factor ONE = {"", 1.0f};

// --- pictures ------------------------------------------------------------------------------------

/// Adds a picture that can be stored as PNG: one of bytes.
static alp_result add_image(alpi_gltf_exporter *e, const alp_image *image, size_t *number)
{
    *number = SIZE_MAX;
    if (image == NULL || image->info.component != ALP_COMPONENT_U8) {
        return ALP_OK;
    }
    uint8_t *png = NULL;
    size_t size = 0;
    ALP_TRY(alpi_png_encode(image, &png, &size));
    const size_t view = alpi_export_view(e, png, size, 0);
    alpi_release(e->context, png);
    alpi_bytes_print(alpi_export_begin(e, ALPI_LIST_IMAGES),
                     "{\"bufferView\":%zu,\"mimeType\":\"image/png\"}", view);
    *number = e->counts[ALPI_LIST_IMAGES] - 1;
    return ALP_OK;
}

/// Whether a picture holds normals: most texels are vectors of about length 1 that point outwards,
/// and few are grey, as those of heights are.
static bool holds_normals(const alp_image *image)
{
    enum { SIDE = 64 };
    const alpi_sampler sampler = {ALPI_WRAP_REPEAT, ALPI_WRAP_REPEAT, false};
    int unit = 0, grey = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int x = i % SIDE, y = i / SIDE;
        float c[4];
        alpi_image_sample(image, ((float)x + 0.5f) / SIDE, ((float)y + 0.5f) / SIDE, sampler, c);
        const vec3 n = {2.0f * c[0] - 1.0f, 2.0f * c[1] - 1.0f, 2.0f * c[2] - 1.0f};
        unit += n.z > 0.0f && fabsf(vec3_length(n) - 1.0f) < 0.2f;
        grey += fabsf(c[0] - c[2]) < 0.02f && fabsf(c[1] - c[2]) < 0.02f;
    }
    return unit > SIDE * SIDE * 9 / 10 && grey < SIDE * SIDE / 10;
}

static bool is_there(const alpi_gltf_exporter *e, const alpi_texture *texture)
{
    return texture->image != ALPI_NONE && texture->image < e->scene->image_count;
}

static void want(const alpi_gltf_exporter *e, const alpi_texture *texture, bool *wanted)
{
    if (is_there(e, texture)) {
        wanted[texture->image] = true;
    }
}

static bool has_one_gloss(const alpi_material *m)
{
    return m->shine.roughness_texture.image == m->metallic_texture.image;
}

/// Pictures that a material shows as they are.
static void want_images(const alpi_gltf_exporter *e, const alpi_material *m, bool *wanted)
{
    want(e, &m->base_color_texture, wanted);
    want(e, &m->emission_texture, wanted);
    want(e, &m->occlusion_texture, wanted);
    want(e, &m->transmission_texture, wanted);
    want(e, &m->normal_texture, wanted);
    want(e, &m->shine.specular_texture, wanted);
    if (has_one_gloss(m)) {
        want(e, &m->metallic_texture, wanted);
    }
}

static bool is_same_place(const alpi_texture *a, const alpi_texture *b)
{
    return a->uv_set == b->uv_set && a->wrap_u == b->wrap_u && a->wrap_v == b->wrap_v &&
           a->scale[0] == b->scale[0] && a->scale[1] == b->scale[1] &&
           a->offset[0] == b->offset[0] && a->offset[1] == b->offset[1] &&
           a->rotation == b->rotation;
}

static float channel_at(const alp_image *image, float u, float v, int channel)
{
    const alpi_sampler sampler = {ALPI_WRAP_REPEAT, ALPI_WRAP_REPEAT, false};
    float rgba[4];
    if (image == NULL) {
        return 1.0f;
    }
    alpi_image_sample(image, u, v, sampler, rgba);
    return fminf(fmaxf(rgba[channel], 0.0f), 1.0f);
}

/// Green of one picture and blue of the other, in the larger size; either may be NULL.
static alp_result join_gloss(alp_context *context, const alp_image *rough, const alp_image *metal,
                             alp_image **image)
{
    alp_image_info info = rough != NULL ? rough->info : metal->info;
    info.width = metal != NULL && metal->info.width > info.width ? metal->info.width : info.width;
    info.height =
        metal != NULL && metal->info.height > info.height ? metal->info.height : info.height;
    info.channels = 3;
    info.component = ALP_COMPONENT_U8;
    ALP_TRY(alp_image_create(context, info, image));
    uint8_t *texel = (*image)->pixels;
    for (uint32_t y = 0; y < info.height; y++) {
        for (uint32_t x = 0; x < info.width; x++, texel += 3) {
            const float u = ((float)x + 0.5f) / (float)info.width;
            const float v = ((float)y + 0.5f) / (float)info.height;
            texel[0] = 255;
            texel[1] = (uint8_t)(channel_at(rough, u, v, 1) * 255.0f + 0.5f);
            texel[2] = (uint8_t)(channel_at(metal, u, v, 2) * 255.0f + 0.5f);
        }
    }
    return ALP_OK;
}

/// The picture of roughness and metalness of a material that has them in two.
static alp_result add_gloss(alpi_gltf_exporter *e, const alpi_material *m, size_t *number)
{
    const alpi_texture *rough_at = &m->shine.roughness_texture, *metal_at = &m->metallic_texture;
    alp_image *rough = NULL, *metal = NULL, *joined = NULL;
    const bool both = is_there(e, rough_at) && is_there(e, metal_at);
    if (both && !is_same_place(rough_at, metal_at)) {
        alpi_note(e->context, "gloss", m->name,
                  "glTF reads roughness and metalness at the same coordinates: the picture of "
                  "metalness is left out");
        metal_at = NULL;
    }
    alp_result result =
        is_there(e, rough_at) ? alpi_scene_open_image(e->scene, rough_at->image, &rough) : ALP_OK;
    if (result == ALP_OK && metal_at != NULL && is_there(e, metal_at)) {
        result = alpi_scene_open_image(e->scene, metal_at->image, &metal);
    }
    if (result == ALP_OK && (rough != NULL || metal != NULL)) {
        result = join_gloss(e->context, rough, metal, &joined);
    }
    if (result == ALP_OK) {
        result = add_image(e, joined, number);
    }
    alp_image_destroy(rough);
    alp_image_destroy(metal);
    alp_image_destroy(joined);
    return result;
}

/// A relief that may be heights or normals: normals are kept, *heights counts the others.
static alp_result add_relief(alpi_gltf_exporter *e, const alpi_material *m, uint32_t *heights)
{
    const alpi_texture *bump = &m->shine.bump_texture;
    if (!is_there(e, bump) || m->normal_texture.image != ALPI_NONE) {
        *heights += bump->lost;
        return ALP_OK;
    }
    if (!e->normals[bump->image]) {
        alp_image *image = NULL;
        ALP_TRY(alpi_scene_open_image(e->scene, bump->image, &image));
        e->normals[bump->image] = image != NULL && holds_normals(image);
        alp_result result = ALP_OK;
        if (e->normals[bump->image] && e->images[bump->image] == SIZE_MAX) {
            result = add_image(e, image, &e->images[bump->image]);
        }
        alp_image_destroy(image);
        ALP_TRY(result);
    }
    *heights += !e->normals[bump->image];
    return ALP_OK;
}

/// Light has read some pictures; others are read here.
static alp_result add_images(alpi_gltf_exporter *e, const bool *used)
{
    const alp_scene *scene = e->scene;
    bool *wanted = ALPI_NEW(e->context, bool, scene->image_count);
    alp_result result = wanted == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    for (uint32_t i = 0; result == ALP_OK && i < scene->material_count; i++) {
        if (used[i]) {
            want_images(e, &scene->materials[i], wanted);
        }
    }
    for (uint32_t i = 0; result == ALP_OK && i < scene->image_count; i++) {
        alp_image *image = NULL;
        if (wanted[i]) {
            result = alpi_scene_open_image(scene, i, &image);
        }
        if (result == ALP_OK) {
            result = add_image(e, image, &e->images[i]);
        }
        alp_image_destroy(image);
    }
    alpi_release(e->context, wanted);
    return result;
}

static alp_result add_made_images(alpi_gltf_exporter *e, const bool *used)
{
    const alp_scene *scene = e->scene;
    uint32_t heights = 0;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const alpi_material *m = &scene->materials[i];
        if (used[i] && !has_one_gloss(m)) {
            ALP_TRY(add_gloss(e, m, &e->gloss[i]));
        }
        if (used[i]) {
            ALP_TRY(add_relief(e, m, &heights));
        }
    }
    if (heights > 0) {
        alpi_note(e->context, "mtl-lost", "map_Bump of heights",
                  "glTF has no place for it: %u material%s it; an .obj keeps it", heights,
                  alpi_one_or_many(heights, " loses", "s lose"));
    }
    return ALP_OK;
}

alp_result alpi_export_images(alpi_gltf_exporter *e)
{
    const alp_scene *scene = e->scene;
    ALPI_TRY_NEW(e->context, e->images, scene->image_count);
    ALPI_TRY_NEW(e->context, e->gloss, scene->material_count);
    ALPI_TRY_NEW(e->context, e->normals, scene->image_count);
    bool *used = ALPI_NEW(e->context, bool, scene->material_count);
    if (used == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        if (scene->surfaces[s].material != ALPI_NONE) {
            used[scene->surfaces[s].material] = true;
        }
    }
    for (uint32_t i = 0; i < scene->material_count; i++) {
        e->gloss[i] = SIZE_MAX;
    }
    alp_result result = add_images(e, used);
    if (result == ALP_OK) {
        result = add_made_images(e, used);
    }
    alpi_release(e->context, used);
    return result;
}

// --- materials -----------------------------------------------------------------------------------

/// A texture with its sampler, and the reference to it, with a comma before; nothing where there is
/// no image.
static void print_texture(alpi_gltf_exporter *e, alpi_bytes *text, const char *name,
                          const alpi_texture *texture, size_t image, factor beside)
{
    static const int wraps[] = {
        [ALPI_WRAP_REPEAT] = 10497, [ALPI_WRAP_CLAMP] = 33071, [ALPI_WRAP_MIRROR] = 33648};
    if (image == SIZE_MAX) {
        return;
    }
    alpi_bytes_print(alpi_export_begin(e, ALPI_LIST_SAMPLERS), "{\"wrapS\":%d,\"wrapT\":%d}",
                     wraps[texture->wrap_u], wraps[texture->wrap_v]);
    alpi_bytes_print(alpi_export_begin(e, ALPI_LIST_TEXTURES), "{\"sampler\":%zu,\"source\":%zu}",
                     e->counts[ALPI_LIST_SAMPLERS] - 1, image);
    alpi_bytes_print(text, ",\"%s\":{\"index\":%zu,\"texCoord\":%u", name,
                     e->counts[ALPI_LIST_TEXTURES] - 1, texture->uv_set);
    if (beside.value != 1.0f) {
        alpi_bytes_print(text, ",");
        alpi_export_number(text, beside.name, beside.value);
    }
    if (texture->offset[0] != 0.0f || texture->offset[1] != 0.0f || texture->scale[0] != 1.0f ||
        texture->scale[1] != 1.0f || texture->rotation != 0.0f) {
        e->has_transform = true;
        alpi_bytes_print(text, ",\"extensions\":{\"KHR_texture_transform\":{");
        alpi_export_numbers(text, "offset", texture->offset, 2);
        alpi_bytes_print(text, ",");
        alpi_export_numbers(text, "scale", texture->scale, 2);
        alpi_bytes_print(text, ",");
        alpi_export_number(text, "rotation", texture->rotation);
        alpi_bytes_print(text, "}}");
    }
    alpi_bytes_print(text, "}");
}

static void add_texture(alpi_gltf_exporter *e, alpi_bytes *text, const char *name,
                        const alpi_texture *texture, factor beside)
{
    print_texture(e, text, name, texture,
                  is_there(e, texture) ? e->images[texture->image] : SIZE_MAX, beside);
}

/// Material extensions: emissiveFactor is at most 1, what is brighter goes into
/// KHR_materials_emissive_strength.
static void print_extensions(alpi_gltf_exporter *e, alpi_bytes *text, const alpi_material *m,
                             float strength)
{
    const alpi_shine *shine = &m->shine;
    const bool bright = strength > 1.0f, clear = m->transmission > 0.0f;
    const bool bends = shine->index > 1.0f && shine->index != DEFAULT_INDEX;
    const char *before = ",\"extensions\":{";
    e->has_emissive_strength |= bright;
    e->has_transmission |= clear;
    e->has_ior |= bends;
    e->has_specular |= shine->has_specular;
    if (bright) {
        alpi_bytes_print(text, "%s\"KHR_materials_emissive_strength\":{", before);
        alpi_export_number(text, "emissiveStrength", strength);
        alpi_bytes_print(text, "}");
        before = ",";
    }
    if (clear) {
        alpi_bytes_print(text, "%s\"KHR_materials_transmission\":{", before);
        alpi_export_number(text, "transmissionFactor", m->transmission);
        add_texture(e, text, "transmissionTexture", &m->transmission_texture, ONE);
        alpi_bytes_print(text, "}");
        before = ",";
    }
    if (bends) {
        alpi_bytes_print(text, "%s\"KHR_materials_ior\":{", before);
        alpi_export_number(text, "ior", shine->index);
        alpi_bytes_print(text, "}");
        before = ",";
    }
    if (shine->has_specular) {
        alpi_bytes_print(text, "%s\"KHR_materials_specular\":{", before);
        alpi_export_numbers(text, "specularColorFactor", shine->specular, 3);
        add_texture(e, text, "specularColorTexture", &shine->specular_texture, ONE);
        alpi_bytes_print(text, "}");
        before = ",";
    }
    alpi_bytes_print(text, "%s", before[1] == '\0' ? "}" : "");
}

static void print_emission(alpi_gltf_exporter *e, alpi_bytes *text, const alpi_material *m)
{
    float strength = fmaxf(1.0f, fmaxf(m->emission[0], fmaxf(m->emission[1], m->emission[2])));
    float color[3];
    for (int k = 0; k < 3; k++) {
        color[k] = m->emission[k] / strength;
    }
    if (color[0] > 0.0f || color[1] > 0.0f || color[2] > 0.0f) {
        alpi_bytes_print(text, ",");
        alpi_export_numbers(text, "emissiveFactor", color, 3);
    }
    print_extensions(e, text, m, strength);
}

/// Roughness and metalness: as they are, or joined.
static void print_gloss(alpi_gltf_exporter *e, alpi_bytes *text, uint32_t index)
{
    const alpi_material *m = &e->scene->materials[index];
    const bool has_rough = is_there(e, &m->shine.roughness_texture);
    if (m->shine.roughness != 1.0f) {
        alpi_bytes_print(text, ",");
        alpi_export_number(text, "roughnessFactor", m->shine.roughness);
    }
    if (has_one_gloss(m)) {
        add_texture(e, text, "metallicRoughnessTexture", &m->metallic_texture, ONE);
    } else {
        print_texture(e, text, "metallicRoughnessTexture",
                      has_rough ? &m->shine.roughness_texture : &m->metallic_texture,
                      e->gloss[index], ONE);
    }
}

static void print_relief(alpi_gltf_exporter *e, alpi_bytes *text, const alpi_material *m)
{
    const alpi_texture *bump = &m->shine.bump_texture;
    const factor scale = {"scale", m->normal_scale}, bump_scale = {"scale", m->shine.bump_scale};
    if (m->normal_texture.image != ALPI_NONE) {
        add_texture(e, text, "normalTexture", &m->normal_texture, scale);
    } else if (is_there(e, bump) && e->normals[bump->image]) {
        add_texture(e, text, "normalTexture", bump, bump_scale);
    }
}

static void add_material(alpi_gltf_exporter *e, uint32_t index)
{
    const alpi_material *m = &e->scene->materials[index];
    const factor strength = {"strength", m->occlusion_strength};
    alpi_bytes *text = alpi_export_begin(e, ALPI_LIST_MATERIALS);
    alpi_bytes_print(text, "{\"name\":");
    alpi_bytes_quote(text, m->name != NULL ? m->name : "");
    alpi_bytes_print(text, ",\"pbrMetallicRoughness\":{");
    alpi_export_numbers(text, "baseColorFactor", m->base_color, 4);
    alpi_bytes_print(text, ",");
    alpi_export_number(text, "metallicFactor", m->metallic);
    add_texture(e, text, "baseColorTexture", &m->base_color_texture, ONE);
    print_gloss(e, text, index);
    alpi_bytes_print(text, "}");
    print_emission(e, text, m);
    add_texture(e, text, "emissiveTexture", &m->emission_texture, ONE);
    add_texture(e, text, "occlusionTexture", &m->occlusion_texture, strength);
    print_relief(e, text, m);
    if (m->alpha_mode != ALPI_ALPHA_OPAQUE) {
        alpi_bytes_print(text, ",\"alphaMode\":\"%s\"",
                         m->alpha_mode == ALPI_ALPHA_MASK ? "MASK" : "BLEND");
    }
    if (m->alpha_mode == ALPI_ALPHA_MASK) {
        alpi_bytes_print(text, ",");
        alpi_export_number(text, "alphaCutoff", m->alpha_cutoff);
    }
    alpi_bytes_print(text, "%s}", m->double_sided ? ",\"doubleSided\":true" : "");
}

void alpi_export_materials(alpi_gltf_exporter *e)
{
    for (uint32_t i = 0; i < e->scene->material_count; i++) {
        add_material(e, i);
    }
}
