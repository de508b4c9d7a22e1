// SPDX-License-Identifier: MIT
// alp_scene_load_normal_maps. Light does not need normal maps, and files often have more of them
// than of other images. So a host that draws loads them by a call of its own, which can fail for
// want of memory and warns as reading the file does. A const scene that decoded at the first use
// could do neither, and threads that read it would race.
#include "base/memory.h"
#include "scene/scene.h"

#include <alpenglow/geometry.h>

/// Marks the normal maps of materials that surfaces use. Warns of those that cannot be read.
static void mark_normal_maps(const alp_scene *scene, bool *used, bool *needed)
{
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const uint32_t index = scene->surfaces[s].material;
        if (index == ALPI_NONE || used[index]) {
            continue;
        }
        const alpi_material *m = &scene->materials[index];
        used[index] = true;
        if (m->normal_texture.image != ALPI_NONE) {
            needed[m->normal_texture.image] = true;
        }
        if (m->normal_texture.lost) {
            alpi_warn(scene->context, "image", m->name,
                      "the normal map of material %u is left out: it has no PNG, JPEG or WebP "
                      "image, a path outside the asset's folder, or a coordinate set above %d",
                      index, ALPI_UV_SET_LIMIT - 1);
        }
    }
}

static alp_result decode_normal_maps(const alp_scene *scene, alp_image **maps)
{
    bool *used = ALPI_NEW(scene->context, bool, scene->material_count);
    bool *needed = ALPI_NEW(scene->context, bool, scene->image_count);
    alp_result result = used == NULL || needed == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    if (result == ALP_OK) {
        mark_normal_maps(scene, used, needed);
    }
    for (uint32_t i = 0; result == ALP_OK && i < scene->image_count; i++) {
        if (needed[i] && scene->images[i] == NULL) {
            result = alpi_scene_open_image(scene, i, &maps[i]);
        }
    }
    alpi_release(scene->context, used);
    alpi_release(scene->context, needed);
    return result;
}

alp_result alp_scene_load_normal_maps(alp_scene *scene)
{
    if (scene == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (scene->normal_maps != NULL) {
        return ALP_OK;
    }
    alp_image **maps = ALPI_NEW(scene->context, alp_image *, scene->image_count);
    if (maps == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result = decode_normal_maps(scene, maps);
    if (result == ALP_OK) {
        scene->normal_maps = maps;
        return ALP_OK;
    }
    for (uint32_t i = 0; i < scene->image_count; i++) {
        alp_image_destroy(maps[i]);
    }
    alpi_release(scene->context, maps);
    return result;
}
