// SPDX-License-Identifier: MIT
// three.js Object JSON, format 4: geometries, materials, textures, images and the tree of objects,
// as ObjectLoader reads them. Names in place of UUIDs: the same scene gives the same bytes.
#include "base/look.h"
#include "formats/viewers/lightmap_parts.h"

#include "base/half.h"
#include "base/memory.h"
#include "formats/images/images.h"

#include <stdio.h>

/// Constants of three.js.
enum { WRAP_REPEAT = 1000, WRAP_CLAMP = 1001, WRAP_MIRROR = 1002 };
enum { FILTER_LINEAR = 1006, FILTER_MIPMAPS = 1008 };
enum { TYPE_HALF = 1016, FORMAT_RGBA = 1023 };
/// Sets of coordinates: texture.channel.
enum { CHANNEL_COLOR = 0, CHANNEL_LIGHT = 1, CHANNEL_EMISSION = 2 };

typedef struct writer {
    alp_context *context;
    const alp_scene *scene;
    const alpi_light_pages *light;
    alpi_lightmap_parts parts;
    float *scales;    // [page_count] lightMapIntensity
    bool *image_used; // [image_count]
    alpi_bytes text;
} writer;

// --- geometries ----------------------------------------------------------------------------------

static void begin_attribute(alpi_bytes *text, const char *before, const char *name, int width)
{
    alpi_bytes_print(text, "%s\"%s\":{\"itemSize\":%d,\"type\":\"Float32Array\",\"array\":[",
                     before, name, width);
}

static void end_attribute(alpi_bytes *text)
{
    alpi_bytes_print(text, "],\"normalized\":false}");
}

static void print_texture_uvs(writer *w, const alpi_lightmap_part *part, const char *name,
                              const alpi_texture *texture)
{
    if (alpi_lightmap_has_image(w->scene, texture)) {
        begin_attribute(&w->text, ",", name, 2);
        alpi_lightmap_print_uvs(&w->text, &w->parts, part, texture);
        end_attribute(&w->text);
    }
}

static void print_attributes(writer *w, const alpi_lightmap_part *part)
{
    const alpi_lightmap_slot *slot = &w->parts.slots[part->slot];
    const alpi_material material = alpi_lightmap_material(w->scene, slot);
    alpi_bytes *text = &w->text;
    begin_attribute(text, "", "position", 3);
    alpi_lightmap_print_vertices(text, &w->parts, part, w->scene->positions[0], 3);
    end_attribute(text);
    begin_attribute(text, ",", "normal", 3);
    alpi_lightmap_print_vertices(text, &w->parts, part, w->scene->normals[0], 3);
    end_attribute(text);
    if (slot->colored) {
        begin_attribute(text, ",", "color", 4);
        alpi_lightmap_print_vertices(text, &w->parts, part, w->scene->colors[0], 4);
        end_attribute(text);
    }
    print_texture_uvs(w, part, "uv", &material.base_color_texture);
    if (slot->page != ALPI_NONE) {
        begin_attribute(text, ",", "uv1", 2);
        alpi_lightmap_print_light_uvs(text, &w->parts, part);
        end_attribute(text);
    }
    print_texture_uvs(w, part, "uv2", &material.emission_texture);
}

static void print_geometries(writer *w)
{
    alpi_bytes_print(&w->text, ",\"geometries\":[");
    for (uint32_t i = 0; i < w->parts.part_count; i++) {
        alpi_bytes_print(&w->text,
                         "%s{\"uuid\":\"geometry %u\",\"type\":\"BufferGeometry\",\"data\":{"
                         "\"attributes\":{",
                         alpi_lightmap_comma(i), i);
        print_attributes(w, &w->parts.parts[i]);
        alpi_bytes_print(&w->text, "},\"index\":{\"type\":\"Uint32Array\",\"array\":[");
        alpi_lightmap_print_indices(&w->text, &w->parts, &w->parts.parts[i], false);
        alpi_bytes_print(&w->text, "]}}}");
    }
    alpi_bytes_print(&w->text, "]");
}

// --- materials -----------------------------------------------------------------------------------

/// 0xRRGGBB in sRGB, as Color.setHex takes it.
static uint32_t hex_color(vec3 linear)
{
    const float channels[3] = {linear.x, linear.y, linear.z};
    uint32_t hex = 0;
    for (int k = 0; k < 3; k++) {
        hex = hex << 8 | (uint32_t)(255.0f * alpi_linear_to_srgb(channels[k]) + 0.5f);
    }
    return hex;
}

/// A colour of at most 1 and what it is multiplied by.
static void print_emission(alpi_bytes *text, const float emission[3])
{
    float most = fmaxf(emission[0], fmaxf(emission[1], emission[2]));
    if (most > 0.0f) {
        vec3 color = vec3_scale(vec3_load(emission), 1.0f / most);
        alpi_bytes_print(text, ",\"emissive\":%u", hex_color(color));
        alpi_lightmap_print_float(text, "emissiveIntensity", most);
    }
}

static void print_alpha(alpi_bytes *text, const alpi_material *material)
{
    if (material->alpha_mode == ALPI_ALPHA_OPAQUE) {
        return;
    }
    alpi_lightmap_print_float(text, "opacity", material->base_color[3]);
    if (material->alpha_mode == ALPI_ALPHA_MASK) {
        alpi_lightmap_print_float(text, "alphaTest", material->alpha_cutoff);
    } else {
        alpi_bytes_print(text, ",\"transparent\":true");
    }
}

static void print_material(writer *w, uint32_t index)
{
    const alpi_lightmap_slot *slot = &w->parts.slots[index];
    const alpi_material material = alpi_lightmap_material(w->scene, slot);
    alpi_bytes *text = &w->text;
    alpi_bytes_print(text,
                     "{\"uuid\":\"material %u\",\"type\":\"MeshLambertMaterial\",\"name\":", index);
    alpi_bytes_quote(text, material.name != NULL ? material.name : "");
    alpi_bytes_print(text, ",\"color\":%u", hex_color(alpi_lightmap_albedo(w->scene, &material)));
    if (alpi_lightmap_has_image(w->scene, &material.base_color_texture)) {
        alpi_bytes_print(text, ",\"map\":\"color %u\"", slot->material);
    }
    print_emission(text, material.emission);
    if (alpi_lightmap_has_image(w->scene, &material.emission_texture)) {
        alpi_bytes_print(text, ",\"emissiveMap\":\"emission %u\"", slot->material);
    }
    if (slot->page != ALPI_NONE) {
        alpi_bytes_print(text, ",\"lightMap\":\"light %u\"", slot->page);
        alpi_lightmap_print_float(text, "lightMapIntensity", w->scales[slot->page]);
    }
    print_alpha(text, &material);
    alpi_bytes_print(text, "%s%s}", slot->colored ? ",\"vertexColors\":true" : "",
                     material.double_sided ? ",\"side\":2" : ""); // DoubleSide
}

static void print_materials(writer *w)
{
    alpi_bytes_print(&w->text, ",\"materials\":[");
    for (uint32_t i = 0; i < w->parts.slot_count; i++) {
        alpi_bytes_print(&w->text, "%s", alpi_lightmap_comma(i));
        print_material(w, i);
    }
    alpi_bytes_print(&w->text, "]");
}

// --- textures and images -------------------------------------------------------------------------

/// A texture of a material; those of the pages stand before it.
static void print_texture(writer *w, const char *kind, uint32_t material, int channel,
                          const alpi_texture *texture)
{
    static const int wraps[] = {[ALPI_WRAP_REPEAT] = WRAP_REPEAT,
                                [ALPI_WRAP_CLAMP] = WRAP_CLAMP,
                                [ALPI_WRAP_MIRROR] = WRAP_MIRROR};
    if (!alpi_lightmap_has_image(w->scene, texture)) {
        return;
    }
    w->image_used[texture->image] = true;
    alpi_bytes_print(&w->text,
                     ",{\"uuid\":\"%s %u\",\"image\":\"image %u\",\"channel\":%d,"
                     "\"wrap\":[%d,%d],\"minFilter\":%d,\"magFilter\":%d,"
                     "\"colorSpace\":\"srgb\",\"flipY\":false}",
                     kind, material, texture->image, channel, wraps[texture->wrap_u],
                     wraps[texture->wrap_v], FILTER_MIPMAPS, FILTER_LINEAR);
}

static alp_result print_textures(writer *w)
{
    alpi_bytes *text = &w->text;
    alpi_bytes_print(text, ",\"textures\":[");
    for (uint32_t p = 0; p < w->light->page_count; p++) {
        alpi_bytes_print(text,
                         "%s{\"uuid\":\"light %u\",\"image\":\"page %u\",\"channel\":%d,"
                         "\"wrap\":[%d,%d],\"format\":%d,\"type\":%d,"
                         "\"colorSpace\":\"srgb-linear\",\"minFilter\":%d,\"magFilter\":%d,"
                         "\"generateMipmaps\":false,\"flipY\":false}",
                         alpi_lightmap_comma(p), p, p, CHANNEL_LIGHT, WRAP_CLAMP, WRAP_CLAMP,
                         FORMAT_RGBA, TYPE_HALF, FILTER_LINEAR, FILTER_LINEAR);
    }
    bool *seen = ALPI_NEW(w->context, bool, w->scene->material_count);
    if (seen == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < w->parts.slot_count; i++) {
        uint32_t m = w->parts.slots[i].material;
        if (m != ALPI_NONE && !seen[m]) {
            seen[m] = true;
            const alpi_material *material = &w->scene->materials[m];
            print_texture(w, "color", m, CHANNEL_COLOR, &material->base_color_texture);
            print_texture(w, "emission", m, CHANNEL_EMISSION, &material->emission_texture);
        }
    }
    alpi_release(w->context, seen);
    alpi_bytes_print(text, "]");
    return ALP_OK;
}

static float irradiance(const writer *w, uint32_t page, size_t value)
{
    float e = w->light->irradiance_per_unit * w->light->pages[page][value];
    return isfinite(e) && e > 0.0f ? e : 0.0f;
}

/// The least power of two, 1 or more, that brings a page into the range of a half.
static void find_scale(writer *w, uint32_t page)
{
    size_t texels = (size_t)w->light->width * w->light->height;
    float most = 0.0f, scale = 1.0f;
    for (size_t i = 0; i < 4 * texels; i++) {
        most = i % 4 == 3 ? most : fmaxf(most, irradiance(w, page, i));
    }
    while (most / scale > ALPI_HALF_MAX) {
        scale *= 2.0f;
    }
    w->scales[page] = scale;
}

static void print_page(writer *w, uint32_t page)
{
    const uint32_t one = 0x3c00;
    size_t texels = (size_t)w->light->width * w->light->height;
    alpi_bytes_print(&w->text,
                     "%s{\"uuid\":\"page %u\",\"url\":{\"width\":%u,\"height\":%u,"
                     "\"type\":\"Uint16Array\",\"data\":[",
                     alpi_lightmap_comma(page), page, w->light->width, w->light->height);
    for (size_t i = 0; i < texels; i++) {
        uint32_t half[3];
        for (size_t k = 0; k < 3; k++) {
            half[k] = alpi_half_from_float(irradiance(w, page, 4 * i + k) / w->scales[page]);
        }
        alpi_bytes_print(&w->text, "%s%u,%u,%u,%u", i > 0 ? "," : "", half[0], half[1], half[2],
                         one);
    }
    alpi_bytes_print(&w->text, "]}}");
}

static alp_result print_images(writer *w)
{
    alpi_bytes_print(&w->text, ",\"images\":[");
    for (uint32_t p = 0; p < w->light->page_count; p++) {
        print_page(w, p);
    }
    for (uint32_t i = 0; i < w->scene->image_count; i++) {
        if (w->image_used[i]) {
            alpi_bytes_print(&w->text, ",{\"uuid\":\"image %u\",\"url\":", i);
            ALP_TRY(alpi_lightmap_print_image(&w->text, w->scene->images[i]));
            alpi_bytes_print(&w->text, "}");
        }
    }
    alpi_bytes_print(&w->text, "]");
    return ALP_OK;
}

// --- objects -------------------------------------------------------------------------------------

static void print_camera(writer *w, uint32_t index)
{
    const alp_camera *camera = &w->scene->cameras[index];
    vec3 position = vec3_load(camera->position);
    float far = alpi_lightmap_far(w->scene, camera), matrix[16];
    alpi_look_matrix(position, vec3_sub(vec3_load(camera->target), position), vec3_load(camera->up),
                     matrix);
    alpi_bytes_print(&w->text,
                     "{\"uuid\":\"camera %u\",\"type\":\"PerspectiveCamera\","
                     "\"name\":\"camera %u\",\"aspect\":1",
                     index, index);
    alpi_lightmap_print_float(&w->text, "fov",
                              (float)((double)camera->vertical_fov * 180.0 / ALPI_PI));
    alpi_lightmap_print_float(&w->text, "near", far / 10000.0f);
    alpi_lightmap_print_float(&w->text, "far", far);
    alpi_bytes_print(&w->text, ",\"matrix\":[");
    alpi_lightmap_print_floats(&w->text, matrix, 12);
    alpi_bytes_print(&w->text, ",");
    alpi_lightmap_print_point(&w->text, w->scene, matrix + 12);
    alpi_bytes_print(&w->text, ",1]}");
}

/// The matrix of a mesh whose vertices are far from the origin of the file; else nothing.
static void print_origin(writer *w)
{
    static const float zero[3] = {0.0f, 0.0f, 0.0f};
    const double *origin = w->scene->origin;
    if (origin[0] != 0.0 || origin[1] != 0.0 || origin[2] != 0.0) {
        alpi_bytes_print(&w->text, ",\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,");
        alpi_lightmap_print_point(&w->text, w->scene, zero);
        alpi_bytes_print(&w->text, ",1]");
    }
}

static void print_objects(writer *w)
{
    alpi_bytes *text = &w->text;
    alpi_bytes_print(text, ",\"object\":{\"uuid\":\"scene\",\"type\":\"Scene\",\"children\":[");
    for (uint32_t i = 0; i < w->parts.part_count; i++) {
        const alpi_lightmap_part *part = &w->parts.parts[i];
        const char *name = w->scene->surfaces[part->surface].name;
        alpi_bytes_print(
            text, "%s{\"uuid\":\"mesh %u\",\"type\":\"Mesh\",\"name\":", alpi_lightmap_comma(i), i);
        alpi_bytes_quote(text, name != NULL ? name : "");
        alpi_bytes_print(text, ",\"geometry\":\"geometry %u\",\"material\":\"material %u\"", i,
                         part->slot);
        print_origin(w);
        alpi_bytes_print(text, "}");
    }
    for (uint32_t i = 0; i < w->scene->camera_count; i++) {
        alpi_bytes_print(text, "%s", alpi_lightmap_comma(w->parts.part_count + i));
        print_camera(w, i);
    }
    alpi_bytes_print(text, "]}}");
}

// --- the whole file ------------------------------------------------------------------------------

static alp_result fill(writer *w)
{
    ALP_TRY(alpi_lightmap_parts_create(w->scene, w->light, &w->parts));
    ALPI_TRY_NEW(w->context, w->scales, w->light->page_count);
    ALPI_TRY_NEW(w->context, w->image_used, w->scene->image_count);
    for (uint32_t p = 0; p < w->light->page_count; p++) {
        find_scale(w, p);
    }
    alpi_lightmap_warn_of_metal(&w->parts);
    alpi_bytes_print(&w->text,
                     "{\"metadata\":{\"version\":4.7,\"type\":\"Object\","
                     "\"generator\":\"Alpenglow %s\"}",
                     alp_version());
    print_geometries(w);
    print_materials(w);
    ALP_TRY(print_textures(w));
    ALP_TRY(print_images(w));
    print_objects(w);
    return w->text.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

/// Four halves and their commas: between 0.03 and 65,504 they have five digits each.
static uint64_t text_size(const alp_scene *scene, uint64_t pixels)
{
    return alpi_lightmap_text_size(scene) + pixels * sizeof "15360,15360,15360,15360";
}

alp_result alpi_three_encode(const alp_scene *scene, const alpi_light_pages *light, uint8_t **bytes,
                             size_t *size)
{
    alp_context *context = scene->context;
    writer w = {.context = context,
                .scene = scene,
                .light = light,
                .parts = {.scene = scene},
                .text = alpi_bytes_create(context)};
    const uint64_t pixels = (uint64_t)light->width * light->height * light->page_count;
    alpi_bytes_reserve(&w.text, text_size(scene, pixels)); // moved, it would be there twice
    alp_result result = fill(&w);
    *bytes = result == ALP_OK ? w.text.bytes : NULL;
    *size = result == ALP_OK ? w.text.size : 0;
    if (result != ALP_OK) {
        alpi_bytes_destroy(&w.text);
    }
    alpi_lightmap_parts_destroy(&w.parts);
    alpi_release(context, w.scales);
    alpi_release(context, w.image_used);
    return result;
}
