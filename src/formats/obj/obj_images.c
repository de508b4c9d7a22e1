// SPDX-License-Identifier: MIT
// Pictures that materials name. One that cannot be read costs a warning, because its material still
// has a colour.
#include "formats/obj/obj.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/images/images.h"

#include <stdio.h>

#define IMAGE_FILE_LIMIT ((uint64_t)1 << 30)

static void mark(const alpi_texture *texture, bool *needed)
{
    if (texture->image != ALPI_NONE) {
        needed[texture->image] = true;
    }
}

static void mark_images(const alp_scene *scene, bool *needed)
{
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        if (scene->surfaces[s].material != ALPI_NONE) {
            const alpi_material *m = &scene->materials[scene->surfaces[s].material];
            mark(&m->base_color_texture, needed);
            mark(&m->emission_texture, needed);
            mark(&m->occlusion_texture, needed);
        }
    }
}

alp_result alpi_obj_read_image(const alpi_obj *obj, const char *name, alp_image **image)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    char *path = alpi_obj_path(obj, name);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = alpi_file_read(obj->context, path, IMAGE_FILE_LIMIT, &bytes, &size);
    if (result == ALP_OK) {
        result = alpi_image_decode(obj->context, path, bytes, size, image);
    }
    alpi_release(obj->context, bytes);
    alpi_release(obj->context, path);
    if (result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY) {
        return result;
    }
    char reason[512];
    snprintf(reason, sizeof reason, "%s", alp_context_message(obj->context));
    alpi_warn(obj->context, "image", name, "%s; its materials are read without this texture",
              reason);
    return ALP_OK;
}

alp_result alpi_obj_read_images(const alpi_obj *obj, const alpi_obj_names *images, alp_scene *scene)
{
    bool *needed = ALPI_NEW(obj->context, bool, images->count);
    scene->images = ALPI_NEW(obj->context, alp_image *, images->count);
    alp_result result = needed == NULL || scene->images == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    if (result == ALP_OK) {
        scene->image_count = images->count;
        mark_images(scene, needed);
    }
    for (uint32_t i = 0; result == ALP_OK && i < images->count; i++) {
        if (needed[i]) {
            result = alpi_obj_read_image(obj, alpi_obj_name(images, i), &scene->images[i]);
        }
    }
    alpi_release(obj->context, needed);
    return result;
}
