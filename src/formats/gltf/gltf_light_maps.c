// SPDX-License-Identifier: MIT
// Maps of light that materials name for viewers, MOZ_lightmap and the file of extras.lightmap: read
// at request, because baking never needs them.
#include "base/half.h"
#include "base/memory.h"
#include "formats/gltf/gltf_bytes.h"
#include "formats/gltf/gltf_read.h"
#include "formats/gltf/gltf_scene.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/images/images.h"

#include <stdio.h>
#include <string.h>

/// Where an image of the list is from: one of the document's, or a file of its own.
typedef struct origin {
    size_t image;    // ALPI_GLTF_NONE: the file
    const char *uri; // borrowed from the document
} origin;

typedef struct reading {
    const alpi_gltf_reader *reader;
    alpi_light_maps *maps;
    origin *origins; // [maps->image_count]
    size_t origin_capacity, image_capacity;
} reading;

/// The four channels of a KTX2, whose scale is the intensity of the extras.
static alp_result read_ktx2(const alpi_gltf_document *document, const uint8_t *bytes, size_t size,
                            alp_image **image)
{
    alp_context *context = document->context;
    alpi_half_texture texture = {0};
    ALP_TRY(alpi_ktx2_read(context, document->path, bytes, size, &texture));
    const alp_image_info info = {texture.width, texture.height, 4, ALP_COMPONENT_FLOAT};
    alp_result result =
        texture.channels == 4 && texture.depth == 0
            ? alp_image_create(context, info, image)
            : alpi_fail(context, ALP_ERROR_UNSUPPORTED,
                        "%s: its light is a KTX2 of another form than RGBA16F in one layer",
                        document->path);
    const size_t count = (size_t)4 * texture.width * texture.height;
    float *values = result == ALP_OK ? alp_image_floats(*image) : NULL;
    for (size_t i = 0; values != NULL && i < count; i++) {
        const uint8_t *bits = texture.texels + 2 * i;
        values[i] = alpi_half_to_float((uint16_t)(bits[0] | bits[1] << 8));
    }
    alpi_release(context, texture.texels);
    return result;
}

/// A file beside the asset. What an EXR says of its scale is in what comes out.
static alp_result read_file(const alpi_gltf_document *document, const char *uri, const char *owner,
                            alp_image **image)
{
    static const uint8_t ktx2[] = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb};
    uint8_t *bytes = NULL;
    size_t size = 0;
    ALP_TRY(alpi_gltf_image_read(document, uri, owner, &bytes, &size));
    const bool is_ktx2 = size >= sizeof ktx2 && memcmp(bytes, ktx2, sizeof ktx2) == 0;
    const alp_result result =
        is_ktx2 ? read_ktx2(document, bytes, size, image)
                : alpi_image_decode(document->context, document->path, bytes, size, image);
    alpi_release(document->context, bytes);
    return result;
}

static alp_result add_image(reading *r, const origin *from, const char *owner)
{
    const alpi_gltf_document *document = r->reader->document;
    alpi_light_maps *maps = r->maps;
    void *origins = r->origins, *images = maps->images;
    alp_result result = alpi_grow(document->context, &origins, &r->origin_capacity,
                                  (size_t)maps->image_count + 1, sizeof *r->origins);
    r->origins = origins;
    ALP_TRY(result);
    result = alpi_grow(document->context, &images, &r->image_capacity,
                       (size_t)maps->image_count + 1, sizeof *maps->images);
    maps->images = images;
    ALP_TRY(result);
    alp_image *image = NULL;
    ALP_TRY(from->uri != NULL ? read_file(document, from->uri, owner, &image)
                              : alpi_gltf_decode_image(document, from->image, &image));
    r->origins[maps->image_count] = *from;
    maps->images[maps->image_count++] = image;
    return ALP_OK;
}

/// The place of an image in the list, which has as many as there are pages.
static alp_result find_image(reading *r, const origin *from, const char *owner, uint32_t *place)
{
    for (*place = 0; r->origins != NULL && *place < r->maps->image_count; ++*place) {
        const origin *known = &r->origins[*place];
        const bool same = from->uri == NULL
                              ? known->uri == NULL && known->image == from->image
                              : known->uri != NULL && strcmp(known->uri, from->uri) == 0;
        if (same) {
            return ALP_OK;
        }
    }
    return add_image(r, from, owner);
}

static alp_result read_moz(reading *r, json_t *material, const char *owner, alpi_light_map *map)
{
    json_t *moz = alpi_gltf_extension(material, "MOZ_lightmap");
    double intensity = 1.0;
    if (moz == NULL) {
        return ALP_OK;
    }
    ALP_TRY(alpi_gltf_read_texture(r->reader, json_object_get(material, "extensions"),
                                   "MOZ_lightmap", owner, &map->texture));
    ALP_TRY(alpi_gltf_number(r->reader->document, moz, "intensity", owner, &intensity));
    if (map->texture.image == ALPI_NONE) {
        return ALP_OK;
    }
    map->scale = alpi_gltf_float(intensity);
    alpi_gltf_blend_texture(material, "MOZ_lightmap", &map->texture);
    const origin from = {.image = map->texture.image};
    return find_image(r, &from, owner, &map->texture.image);
}

static alpi_light_map_units read_units(json_t *lightmap)
{
    const char *units = alpi_gltf_text(lightmap, "units");
    return units == NULL                         ? ALPI_LIGHT_MAP_IRRADIANCE
           : strcmp(units, "irradiance/pi") == 0 ? ALPI_LIGHT_MAP_IRRADIANCE_PI
           : strcmp(units, "radiance") == 0      ? ALPI_LIGHT_MAP_RADIANCE
                                                 : ALPI_LIGHT_MAP_IRRADIANCE;
}

static alp_result read_extras(reading *r, json_t *material, const char *owner, alpi_light_map *map)
{
    const alpi_gltf_document *document = r->reader->document;
    json_t *lightmap = json_object_get(json_object_get(material, "extras"), "lightmap");
    const char *uri = alpi_gltf_text(lightmap, "uri");
    size_t set = 0;
    double intensity = 1.0;
    if (uri == NULL) {
        return ALP_OK;
    }
    ALP_TRY(alpi_gltf_size_or(document, lightmap, "texCoord", owner, 0, &set));
    ALP_TRY(alpi_gltf_number(document, lightmap, "intensity", owner, &intensity));
    if (set >= ALPI_UV_SET_LIMIT) {
        alpi_warn(document->context, "uv-set", owner,
                  "its light uses TEXCOORD_%zu, only 0 to %d are read: it is left out", set,
                  ALPI_UV_SET_LIMIT - 1);
        return ALP_OK;
    }
    const origin from = {ALPI_GLTF_NONE, uri};
    const size_t length = strlen(uri);
    const bool stated = length > 4 && strcmp(uri + length - 4, ".exr") == 0;
    map->texture.uv_set = (uint32_t)set;
    map->texture.wrap_u = map->texture.wrap_v = ALPI_WRAP_CLAMP;
    map->scale = stated ? 1.0f : alpi_gltf_float(intensity);
    map->units = read_units(lightmap);
    alpi_gltf_blend_texture(material, "lightmap", &map->texture);
    return find_image(r, &from, owner, &map->texture.image);
}

static alp_result read_maps(reading *r, const alp_scene *scene)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        alpi_light_map *map = &r->maps->maps[i];
        json_t *material = alpi_gltf_item(r->reader->document, "materials", i);
        char owner[ALPI_GLTF_OWNER_SIZE];
        snprintf(owner, sizeof owner, "material %u", i);
        ALP_TRY(read_moz(r, material, owner, map));
        if (map->texture.image == ALPI_NONE) {
            ALP_TRY(read_extras(r, material, owner, map));
        }
    }
    return ALP_OK;
}

alp_result alpi_gltf_read_light_maps(const alp_scene *scene, alpi_light_maps *maps)
{
    *maps = (alpi_light_maps){0};
    ALPI_TRY_NEW(scene->context, maps->maps, scene->material_count);
    for (uint32_t i = 0; i < scene->material_count; i++) {
        maps->maps[i] = (alpi_light_map){alpi_texture_none(), 1.0f, ALPI_LIGHT_MAP_IRRADIANCE};
    }
    const alpi_gltf_document *document = scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
    if (document == NULL) {
        return ALP_OK;
    }
    const alpi_gltf_reader reader = {.context = scene->context, .document = document};
    reading r = {.reader = &reader, .maps = maps};
    const alp_result result = read_maps(&r, scene);
    alpi_release(scene->context, r.origins);
    return result;
}

void alpi_light_maps_release(alp_context *context, alpi_light_maps *maps)
{
    for (uint32_t i = 0; i < maps->image_count; i++) {
        alp_image_destroy(maps->images[i]);
    }
    alpi_release(context, maps->images);
    alpi_release(context, maps->maps);
    *maps = (alpi_light_maps){0};
}

static void destroy_kept(alp_context *context, void *data)
{
    alpi_light_maps_release(context, data);
    alpi_release(context, data);
}

alp_result alp_scene_read_light_maps(alp_scene *scene)
{
    if (scene == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    alpi_attachment *kept = &scene->attachments[ALPI_ATTACHMENT_LIGHT_MAPS];
    if (kept->data != NULL) {
        return ALP_OK;
    }
    alpi_light_maps *maps = NULL;
    ALPI_TRY_NEW(scene->context, maps, 1);
    const alp_result result = alpi_gltf_read_light_maps(scene, maps);
    if (result != ALP_OK) {
        destroy_kept(scene->context, maps);
        return result;
    }
    *kept = (alpi_attachment){maps, destroy_kept};
    return ALP_OK;
}
