// SPDX-License-Identifier: MIT
// Materials whose occlusion goes into the red channel of an image that they have already: they read
// a new version of that image. The old one stays for whoever else uses it.

#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_appends.h"
#include "formats/gltf/write/gltf_patch_material.h"

#include <stdio.h>

uint32_t alpi_patcher_packed(const alpi_gltf_patcher *p, size_t material)
{
    const uint32_t *packed = p->patch->material_packed;
    return packed == NULL || p->exported || material >= p->scene->material_count ? ALPI_NONE
                                                                                 : packed[material];
}

/// The new image, made at its first use.
static size_t packed_image(alpi_gltf_patcher *p, uint32_t packed)
{
    if (p->packed_images[packed] == ALPI_GLTF_NONE) {
        char name[64];
        snprintf(name, sizeof name, "occlusion, roughness, metalness %u", packed);
        p->packed_images[packed] = alpi_patcher_add_image(p, name, p->patch->page_count + packed,
                                                          p->patch->packed_images[packed].png,
                                                          p->patch->packed_images[packed].png_size);
    }
    return p->packed_images[packed];
}

/// A texture like an old one, with its sampler, that shows the new image.
static alp_result copy_texture(alpi_gltf_patcher *p, size_t texture, uint32_t packed,
                               const char *owner, size_t *copy)
{
    if (p->texture_copies[texture] == ALPI_GLTF_NONE) {
        size_t sampler;
        char text[128];
        ALP_TRY(alpi_gltf_index(p->document, alpi_gltf_item(p->document, "textures", texture),
                                "sampler", "samplers", owner, &sampler));
        size_t image = packed_image(p, packed);
        int length =
            sampler == ALPI_GLTF_NONE
                ? snprintf(text, sizeof text, "{\"source\":%zu," ALPI_GLTF_MAP_EXTRAS "}", image)
                : snprintf(text, sizeof text,
                           "{\"sampler\":%zu,\"source\":%zu," ALPI_GLTF_MAP_EXTRAS "}", sampler,
                           image);
        p->texture_copies[texture] =
            alpi_patcher_append(p, ALPI_GLTF_TEXTURES, text, (size_t)length);
    }
    *copy = p->texture_copies[texture];
    return ALP_OK;
}

/// The textureInfo that an occlusionTexture gets: coordinates as those of `info`, strength 1.
static alp_result print_info(const alpi_gltf_patcher *p, alpi_json_span info, json_t *object,
                             const char *owner, size_t texture, alpi_bytes *value)
{
    static const char name[] = "KHR_texture_transform";
    size_t uv_set;
    ALP_TRY(alpi_gltf_size_or(p->document, object, "texCoord", owner, 0, &uv_set));
    alpi_bytes_print(value, "{\"index\":%zu", texture);
    if (uv_set != 0) {
        alpi_bytes_print(value, ",\"texCoord\":%zu", uv_set);
    }
    alpi_json_span transform;
    if (alpi_gltf_extension(object, name) != NULL &&
        alpi_json_find(p->document->text, info, "extensions", &transform) &&
        alpi_json_find(p->document->text, transform, name, &transform)) {
        alpi_bytes_print(value, ",\"extensions\":{\"%s\":", name);
        alpi_bytes_add(value, p->document->text + transform.begin, transform.end - transform.begin);
        alpi_bytes_print(value, "}");
    }
    alpi_bytes_print(value, "}");
    return ALP_OK;
}

alp_result alpi_patcher_pack_material(alpi_gltf_patcher *p, size_t material, alpi_edits *edits)
{
    uint32_t packed = alpi_patcher_packed(p, material);
    const alpi_material *read = &p->scene->materials[material];
    bool in_metal = read->metallic_texture.image == p->patch->packed_images[packed].image;
    const char *path =
        in_metal ? "pbrMetallicRoughness/metallicRoughnessTexture" : "occlusionTexture";
    json_t *object = alpi_gltf_item(p->document, "materials", material);
    object = in_metal ? json_object_get(json_object_get(object, "pbrMetallicRoughness"),
                                        "metallicRoughnessTexture")
                      : json_object_get(object, "occlusionTexture");
    alpi_json_span span = p->lists[ALPI_GLTF_MATERIALS].spans[material], info;
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "material %zu", material);
    if (!alpi_json_at(p->document->text, span, path, &info)) {
        return alpi_gltf_fail(p->document, owner, "has no %s to pack occlusion into", path);
    }
    size_t old, texture;
    ALP_TRY(alpi_gltf_needed_index(p->document, object, "index", "textures", owner, &old));
    ALP_TRY(copy_texture(p, old, packed, owner, &texture));
    if (in_metal) {
        alpi_edits_set_index(edits, info, "index", texture);
    }
    alpi_bytes value = alpi_bytes_create(p->context);
    alp_result result = print_info(p, info, object, owner, texture, &value);
    alpi_edits_set(edits, span, "occlusionTexture", value.bytes, value.size);
    p->data.failed |= value.failed;
    alpi_bytes_destroy(&value);
    return result;
}
