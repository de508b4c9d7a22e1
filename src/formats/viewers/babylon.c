// SPDX-License-Identifier: MIT
// .babylon: one JSON file of materials, meshes and cameras, with a Radiance picture a page beside
// it. Of Babylon.js' formats of high range only .hdr is read as linear from such a file.
#include "formats/viewers/lightmap_parts.h"

#include "base/memory.h"
#include "formats/images/images.h"

#include <stdio.h>

/// Constants of Babylon.js.
enum { WRAP_CLAMP = 0, WRAP_REPEAT = 1, WRAP_MIRROR = 2 };
enum { SAMPLING_BILINEAR = 2 };
/// Its reader (9.34) refuses pictures that are less than 8 wide, and loses the header of a file of
/// less than a hundred bytes: it shows a red picture instead.
enum { SIDE_LEAST = 8 };
/// Sets of coordinates: texture.coordinatesIndex.
enum { SET_COLOR = 0, SET_LIGHT = 1, SET_EMISSION = 2 };

typedef struct writer {
    alp_context *context;
    const alp_scene *scene;
    const alpi_light_pages *light;
    const char *const *page_names;
    alpi_lightmap_parts parts;
    alpi_bytes text;
} writer;

static void print_floats(alpi_bytes *text, const char *name, const float *values, size_t count)
{
    alpi_bytes_print(text, ",\"%s\":[", name);
    alpi_lightmap_print_floats(text, values, count);
    alpi_bytes_print(text, "]");
}

// --- materials -----------------------------------------------------------------------------------

static alp_result print_texture(writer *w, const char *name, int set, const alpi_texture *texture)
{
    static const int wraps[] = {[ALPI_WRAP_REPEAT] = WRAP_REPEAT,
                                [ALPI_WRAP_CLAMP] = WRAP_CLAMP,
                                [ALPI_WRAP_MIRROR] = WRAP_MIRROR};
    if (!alpi_lightmap_has_image(w->scene, texture)) {
        return ALP_OK;
    }
    const alp_image *image = w->scene->images[texture->image];
    bool has_alpha = image->info.channels == 2 || image->info.channels == 4;
    alpi_bytes_print(&w->text,
                     ",\"%s\":{\"name\":\"image %u\",\"coordinatesIndex\":%d,\"wrapU\":%d,"
                     "\"wrapV\":%d,\"hasAlpha\":%s,\"invertY\":false,\"base64String\":",
                     name, texture->image, set, wraps[texture->wrap_u], wraps[texture->wrap_v],
                     has_alpha ? "true" : "false");
    ALP_TRY(alpi_lightmap_print_image(&w->text, image));
    alpi_bytes_print(&w->text, "}");
    return ALP_OK;
}

/// The whole lit colour, which is white ambient light × albedo, is multiplied by the map. Babylon
/// turns a Radiance picture over, so its coordinates are turned too.
static void print_lightmap(writer *w, uint32_t page)
{
    alpi_bytes_print(&w->text, ",\"useLightmapAsShadowmap\":true,\"lightmapTexture\":{\"name\":");
    alpi_bytes_quote(&w->text, w->page_names[page]);
    alpi_bytes_print(
        &w->text,
        ",\"coordinatesIndex\":%d,\"vScale\":-1,\"vOffset\":1,\"wrapU\":%d,"
        "\"wrapV\":%d,\"noMipmap\":true,\"samplingMode\":%d,\"anisotropicFilteringLevel\":1}",
        SET_LIGHT, WRAP_CLAMP, WRAP_CLAMP, SAMPLING_BILINEAR);
}

static void print_alpha(alpi_bytes *text, const alpi_material *material)
{
    alpi_bytes_print(text, ",\"transparencyMode\":%d", (int)material->alpha_mode);
    if (material->alpha_mode != ALPI_ALPHA_OPAQUE) {
        alpi_lightmap_print_float(text, "alpha", material->base_color[3]);
        alpi_bytes_print(text, ",\"useAlphaFromAlbedoTexture\":true");
    }
    if (material->alpha_mode == ALPI_ALPHA_MASK) {
        alpi_lightmap_print_float(text, "alphaCutOff", material->alpha_cutoff);
    }
}

static alp_result print_material(writer *w, uint32_t index)
{
    const alpi_lightmap_slot *slot = &w->parts.slots[index];
    const alpi_material material = alpi_lightmap_material(w->scene, slot);
    const bool lit = slot->page != ALPI_NONE;
    const float ambient[3] = {lit, lit, lit};
    float albedo[3];
    vec3_store(albedo, alpi_lightmap_albedo(w->scene, &material));
    alpi_bytes *text = &w->text;
    alpi_bytes_print(text, "{\"customType\":\"BABYLON.PBRMaterial\",\"id\":\"material %u\"", index);
    alpi_bytes_print(text, ",\"name\":");
    alpi_bytes_quote(text, material.name != NULL ? material.name : "");
    print_floats(text, "albedo", albedo, 3);
    print_floats(text, "ambient", ambient, 3);
    print_floats(text, "emissive", material.emission, 3);
    alpi_bytes_print(text,
                     ",\"metallic\":0,\"roughness\":1,\"metallicF0Factor\":0,"
                     "\"backFaceCulling\":%s",
                     material.double_sided ? "false" : "true");
    print_alpha(text, &material);
    ALP_TRY(print_texture(w, "albedoTexture", SET_COLOR, &material.base_color_texture));
    ALP_TRY(print_texture(w, "emissiveTexture", SET_EMISSION, &material.emission_texture));
    if (lit) {
        print_lightmap(w, slot->page);
    }
    alpi_bytes_print(text, "}");
    return ALP_OK;
}

static alp_result print_materials(writer *w)
{
    alpi_bytes_print(&w->text, ",\"materials\":[");
    for (uint32_t i = 0; i < w->parts.slot_count; i++) {
        alpi_bytes_print(&w->text, "%s", alpi_lightmap_comma(i));
        ALP_TRY(print_material(w, i));
    }
    alpi_bytes_print(&w->text, "]");
    return ALP_OK;
}

// --- meshes and cameras --------------------------------------------------------------------------

static void print_uvs(writer *w, const alpi_lightmap_part *part, const char *name,
                      const alpi_texture *texture)
{
    if (alpi_lightmap_has_image(w->scene, texture)) {
        alpi_bytes_print(&w->text, ",\"%s\":[", name);
        alpi_lightmap_print_uvs(&w->text, &w->parts, part, texture);
        alpi_bytes_print(&w->text, "]");
    }
}

static void print_vertices(writer *w, const alpi_lightmap_part *part)
{
    const alpi_lightmap_slot *slot = &w->parts.slots[part->slot];
    const alpi_material material = alpi_lightmap_material(w->scene, slot);
    alpi_bytes *text = &w->text;
    alpi_bytes_print(text, ",\"positions\":[");
    alpi_lightmap_print_vertices(text, &w->parts, part, w->scene->positions[0], 3);
    alpi_bytes_print(text, "],\"normals\":[");
    alpi_lightmap_print_vertices(text, &w->parts, part, w->scene->normals[0], 3);
    alpi_bytes_print(text, "]");
    if (slot->colored) {
        alpi_bytes_print(text, ",\"colors\":[");
        alpi_lightmap_print_vertices(text, &w->parts, part, w->scene->colors[0], 4);
        alpi_bytes_print(text, "],\"hasVertexAlpha\":%s",
                         material.alpha_mode != ALPI_ALPHA_OPAQUE ? "true" : "false");
    }
    print_uvs(w, part, "uvs", &material.base_color_texture);
    if (slot->page != ALPI_NONE) {
        alpi_bytes_print(text, ",\"uvs2\":[");
        alpi_lightmap_print_light_uvs(text, &w->parts, part);
        alpi_bytes_print(text, "]");
    }
    print_uvs(w, part, "uvs3", &material.emission_texture);
}

static void print_point(writer *w, const char *name, const float point[3])
{
    alpi_bytes_print(&w->text, ",\"%s\":[", name);
    alpi_lightmap_print_point(&w->text, w->scene, point);
    alpi_bytes_print(&w->text, "]");
}

static void print_meshes(writer *w)
{
    alpi_bytes *text = &w->text;
    alpi_bytes_print(text, ",\"meshes\":[");
    for (uint32_t i = 0; i < w->parts.part_count; i++) {
        const alpi_lightmap_part *part = &w->parts.parts[i];
        const char *name = w->scene->surfaces[part->surface].name;
        alpi_bytes_print(text, "%s{\"id\":\"mesh %u\",\"name\":", alpi_lightmap_comma(i), i);
        alpi_bytes_quote(text, name != NULL ? name : "");
        alpi_bytes_print(text, ",\"materialId\":\"material %u\"", part->slot);
        print_point(w, "position", (const float[3]){0.0f, 0.0f, 0.0f});
        alpi_bytes_print(text, ",\"rotation\":[0,0,0],\"scaling\":[1,1,1],\"isVisible\":true,"
                               "\"isEnabled\":true");
        print_vertices(w, part);
        alpi_bytes_print(text, ",\"indices\":[");
        // In a right-handed scene too triangles of Babylon.js wind clockwise.
        alpi_lightmap_print_indices(text, &w->parts, part, true);
        alpi_bytes_print(text,
                         "],\"subMeshes\":[{\"materialIndex\":0,\"verticesStart\":0,"
                         "\"verticesCount\":%u,\"indexStart\":0,\"indexCount\":%u}]}",
                         part->vertex_count, part->index_count);
    }
    alpi_bytes_print(text, "]");
}

static void print_cameras(writer *w)
{
    alpi_bytes *text = &w->text;
    alpi_bytes_print(text, ",\"cameras\":[");
    for (uint32_t i = 0; i < w->scene->camera_count; i++) {
        const alp_camera *camera = &w->scene->cameras[i];
        float far = alpi_lightmap_far(w->scene, camera);
        alpi_bytes_print(text,
                         "%s{\"type\":\"FreeCamera\",\"id\":\"camera %u\",\"name\":\"camera %u\"",
                         alpi_lightmap_comma(i), i, i);
        print_point(w, "position", camera->position);
        print_point(w, "target", camera->target);
        print_floats(text, "upVector", camera->up, 3);
        alpi_lightmap_print_float(text, "fov", camera->vertical_fov);
        alpi_lightmap_print_float(text, "minZ", far / 10000.0f);
        alpi_lightmap_print_float(text, "maxZ", far);
        alpi_bytes_print(text, "}");
    }
    alpi_bytes_print(text, "]%s",
                     w->scene->camera_count > 0 ? ",\"activeCameraID\":\"camera 0\"" : "");
}

// --- the whole file ------------------------------------------------------------------------------

static alp_result fill(writer *w)
{
    if (w->light->width < SIDE_LEAST || w->light->height < SIDE_LEAST) {
        return alpi_fail(w->context, ALP_ERROR_UNSUPPORTED,
                         "%s: a map of %u × %u texels is too small for Babylon.js; make it %d or "
                         "more",
                         w->scene->name, w->light->width, w->light->height, SIDE_LEAST);
    }
    ALP_TRY(alpi_lightmap_parts_create(w->scene, w->light, &w->parts));
    alpi_lightmap_warn_of_metal(&w->parts);
    alpi_bytes_print(&w->text,
                     "{\"producer\":{\"name\":\"Alpenglow\",\"version\":\"%s\"},"
                     "\"autoClear\":true,\"clearColor\":[0,0,0],\"ambientColor\":[1,1,1],"
                     "\"useRightHandedSystem\":true,\"lights\":[]",
                     alp_version());
    print_cameras(w);
    ALP_TRY(print_materials(w));
    print_meshes(w);
    alpi_bytes_print(&w->text, "}");
    return w->text.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

alp_result alpi_babylon_encode(const alp_scene *scene, const alpi_light_pages *light,
                               const char *const *page_names, uint8_t **bytes, size_t *size)
{
    writer w = {.context = scene->context,
                .scene = scene,
                .light = light,
                .page_names = page_names,
                .parts = {.scene = scene},
                .text = alpi_bytes_create(scene->context)};
    alpi_bytes_reserve(&w.text, alpi_lightmap_text_size(scene)); // moved, it would be there twice
    alp_result result = fill(&w);
    *bytes = result == ALP_OK ? w.text.bytes : NULL;
    *size = result == ALP_OK ? w.text.size : 0;
    if (result != ALP_OK) {
        alpi_bytes_destroy(&w.text);
    }
    alpi_lightmap_parts_destroy(&w.parts);
    return result;
}

alp_result alpi_babylon_encode_page(const alp_scene *scene, const alpi_light_pages *light,
                                    uint32_t page, uint8_t **bytes, size_t *size)
{
    alp_image *image = NULL;
    alp_image_info info = {light->width, light->height, 3, ALP_COMPONENT_FLOAT};
    ALP_TRY(alp_image_create(scene->context, info, &image));
    float *pixels = alp_image_floats(image);
    const float scale = light->irradiance_per_unit / (float)ALPI_PI;
    size_t texels = (size_t)light->width * light->height;
    for (size_t i = 0; i < texels; i++) {
        for (size_t k = 0; k < 3; k++) {
            float value = scale * light->pages[page][4 * i + k];
            pixels[3 * i + k] = isfinite(value) ? value : 0.0f;
        }
    }
    alp_result result = alpi_hdr_encode(image, bytes, size);
    alp_image_destroy(image);
    return result;
}
