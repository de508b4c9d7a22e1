// SPDX-License-Identifier: MIT
// Names of the pictures of an OBJ, kept with its scene where some of them are read later.
#include "formats/obj/obj.h"
#include "formats/obj/obj_scene.h"

#include "base/memory.h"

typedef struct pictures {
    char *folder;
    alpi_obj_names names; // number = index of the image
} pictures;

static void destroy_pictures(alp_context *context, void *data)
{
    pictures *kept = data;
    alpi_release(context, kept->folder);
    alpi_obj_names_destroy(&kept->names);
    alpi_release(context, kept);
}

alp_result alpi_obj_keep_pictures(alpi_obj *obj, alpi_obj_names *images, alp_scene *scene)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        any = any || scene->materials[i].normal_texture.image != ALPI_NONE;
    }
    if (!any) {
        return ALP_OK;
    }
    pictures *kept = ALPI_NEW(obj->context, pictures, 1);
    if (kept == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *kept = (pictures){obj->folder, *images};
    obj->folder = NULL;
    *images = alpi_obj_names_create(obj->context);
    scene->read_image = alpi_obj_read_picture;
    scene->attachments[ALPI_ATTACHMENT_PICTURES] = (alpi_attachment){kept, destroy_pictures};
    return ALP_OK;
}

alp_result alpi_obj_read_picture(const alp_scene *scene, uint32_t index, alp_image **image)
{
    const pictures *kept = scene->attachments[ALPI_ATTACHMENT_PICTURES].data;
    *image = NULL;
    if (kept == NULL || index >= kept->names.count) {
        return ALP_OK;
    }
    const alpi_obj obj = {.context = scene->context, .folder = kept->folder};
    return alpi_obj_read_image(&obj, alpi_obj_name(&kept->names, index), image);
}
