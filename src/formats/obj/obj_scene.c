// SPDX-License-Identifier: MIT
// OBJ → scene: statements, libraries, meshes, pictures.
#include "formats/obj/obj_scene.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "formats/obj/obj.h"

#include <string.h>

#define FILE_LIMIT ((uint64_t)4 << 30) // as glTF's

static alp_result fill_scene(alpi_obj *obj, alpi_obj_file *file, alp_scene *scene)
{
    uint32_t *materials = NULL;
    alpi_obj_names images = alpi_obj_names_create(obj->context);
    alp_result result = alpi_obj_read_materials(obj, scene, &images, &materials);
    if (result == ALP_OK) {
        result = alpi_obj_fill_meshes(obj, materials, scene);
    }
    if (result == ALP_OK) {
        result = alpi_obj_read_images(obj, &images, scene);
    }
    if (result == ALP_OK) {
        result = alpi_obj_keep_source(obj, file, &images, scene);
    }
    alpi_release(obj->context, materials);
    alpi_obj_names_destroy(&images);
    scene->input_hash = obj->hash;
    return result == ALP_OK ? alpi_scene_finish(scene) : result;
}

/// From a text, which the scene takes over if it succeeds.
static alp_result read_text(alp_context *context, const char *path, alpi_obj_file *file,
                            uint64_t hash, alp_scene **scene)
{
    alpi_obj obj;
    alp_scene *made = NULL;
    alp_result result = alpi_obj_parse(context, path, file->text, file->size, &obj);
    obj.hash = hash;
    if (result == ALP_OK) {
        result = alpi_scene_create(context, path, &made);
    }
    if (result == ALP_OK) {
        made->unit_assumed = true; // an OBJ cannot state it
        result = fill_scene(&obj, file, made);
    }
    alpi_obj_destroy(&obj);
    if (result != ALP_OK) {
        alp_scene_destroy(made);
        return result;
    }
    alpi_note(context, "unit", path, "an OBJ states no unit of length: metres are assumed");
    *scene = made;
    return ALP_OK;
}

/// Takes over the bytes.
static alp_result read_bytes(alp_context *context, const char *path, uint8_t *bytes, size_t size,
                             alp_scene **scene)
{
    alpi_obj_file file = {0};
    const uint64_t hash = alpi_hash_bytes(ALPI_HASH_START, bytes, size);
    ALP_TRY(alpi_obj_file_take(context, bytes, size, &file));
    const alp_result result = read_text(context, path, &file, hash, scene);
    alpi_obj_file_destroy(context, &file);
    return result;
}

alp_result alpi_obj_scene_from_bytes(alp_context *context, const char *path, const uint8_t *bytes,
                                     size_t size, alp_scene **scene)
{
    *scene = NULL;
    uint8_t *copy = ALPI_NEW(context, uint8_t, size + 1); // a zero behind it
    if (copy == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    memcpy(copy, bytes, size);
    return read_bytes(context, path, copy, size, scene);
}

alp_result alpi_obj_read_scene(alp_context *context, const char *path, alp_scene **scene)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    *scene = NULL;
    ALP_TRY(alpi_file_read(context, path, FILE_LIMIT, &bytes, &size));
    return read_bytes(context, path, bytes, size, scene);
}
