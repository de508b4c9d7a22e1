// SPDX-License-Identifier: MIT
// The texts of an OBJ and its libraries, kept with its scene: the writer repeats them, and pictures
// that light does not need are read later.
#include "formats/obj/obj.h"
#include "formats/obj/obj_scene.h"

#include "base/memory.h"
#include "formats/text/utf16.h"

#include <string.h>

// --- texts ---------------------------------------------------------------------------------------

/// UTF-16 is known by its mark, or by the zeros beside the first two letters.
static bool is_wide(const uint8_t *bytes, size_t size, bool *big)
{
    if (size < 4) {
        return false;
    }
    *big = (bytes[0] == 0xfe && bytes[1] == 0xff) || (bytes[0] == 0 && bytes[2] == 0);
    return *big ? bytes[0] == 0xfe || (bytes[1] != 0 && bytes[3] != 0)
                : (bytes[0] == 0xff && bytes[1] == 0xfe) ||
                      (bytes[0] != 0 && bytes[1] == 0 && bytes[2] != 0 && bytes[3] == 0);
}

alp_result alpi_obj_file_take(alp_context *context, uint8_t *bytes, size_t size,
                              alpi_obj_file *file)
{
    bool big = false;
    *file = (alpi_obj_file){.bytes = bytes, .text = (const char *)bytes, .size = size};
    if (is_wide(bytes, size, &big)) {
        uint8_t *text = NULL;
        const alp_result result = alpi_utf16_decode(context, bytes, size, big, &text, &file->size);
        alpi_release(context, bytes);
        *file = (alpi_obj_file){
            .bytes = text, .text = (const char *)text, .size = result == ALP_OK ? file->size : 0};
        ALP_TRY(result);
    }
    if (file->size >= 3 && memcmp(file->text, "\xef\xbb\xbf", 3) == 0) { // a mark
        file->text += 3;
        file->size -= 3;
    }
    return ALP_OK;
}

void alpi_obj_file_destroy(alp_context *context, alpi_obj_file *file)
{
    alpi_release(context, file->name);
    alpi_release(context, file->folder);
    alpi_release(context, file->bytes);
    *file = (alpi_obj_file){0};
}

// --- kept with the scene -------------------------------------------------------------------------

static void destroy_source(alp_context *context, void *data)
{
    alpi_obj_source *s = data;
    alpi_release(context, s->folder);
    alpi_obj_file_destroy(context, &s->file);
    alpi_obj_names_destroy(&s->images);
    alpi_obj_names_destroy(&s->materials);
    for (uint32_t i = 0; i < s->library_count; i++) {
        alpi_obj_file_destroy(context, &s->libraries[i]);
    }
    alpi_release(context, s->libraries);
    alpi_release(context, s->face_triangles);
    alpi_release(context, s->triangle_corners);
    alpi_release(context, s);
}

const alpi_obj_source *alpi_obj_source_of(const alp_scene *scene)
{
    return scene->attachments[ALPI_ATTACHMENT_OBJ].data;
}

static alp_result read_picture(const alp_scene *scene, uint32_t index, alp_image **image)
{
    const alpi_obj_source *source = alpi_obj_source_of(scene);
    *image = NULL;
    if (source == NULL || index >= source->images.count) {
        return ALP_OK;
    }
    const alpi_obj obj = {.context = scene->context, .folder = source->folder};
    return alpi_obj_read_image(&obj, alpi_obj_name(&source->images, index), image);
}

alp_result alpi_obj_keep_source(alpi_obj *obj, alpi_obj_file *file, alpi_obj_names *images,
                                alp_scene *scene)
{
    alpi_obj_source *kept = ALPI_NEW(obj->context, alpi_obj_source, 1);
    if (kept == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *kept = (alpi_obj_source){.folder = obj->folder,
                              .file = *file,
                              .images = *images,
                              .materials = obj->materials,
                              .libraries = obj->read_libraries,
                              .library_count = obj->read_library_count,
                              .face_count = obj->face_count,
                              .face_triangles = obj->face_triangles,
                              .triangle_corners = obj->triangle_corners};
    obj->folder = NULL;
    *file = (alpi_obj_file){0};
    *images = alpi_obj_names_create(obj->context);
    obj->materials = alpi_obj_names_create(obj->context);
    obj->read_libraries = NULL;
    obj->read_library_count = 0;
    obj->face_triangles = NULL;
    obj->triangle_corners = NULL;
    scene->attachments[ALPI_ATTACHMENT_OBJ] = (alpi_attachment){kept, destroy_source};
    scene->read_image = read_picture;
    return ALP_OK;
}
