// SPDX-License-Identifier: MIT
// The material libraries that an OBJ names, and its materials in them.
#include "formats/obj/obj_materials.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "formats/files/outside.h"

#include <stdio.h>
#include <string.h>

#define LIBRARY_LIMIT ((uint64_t)256 << 20) // bytes

/// Keeps the text of a library for the writer. Takes over `file`.
static alp_result keep_library(alpi_obj *obj, alpi_obj_file file)
{
    void *items = obj->read_libraries;
    if (alpi_grow(obj->context, &items, &obj->read_library_capacity,
                  (size_t)obj->read_library_count + 1, sizeof *obj->read_libraries) != ALP_OK) {
        alpi_obj_file_destroy(obj->context, &file);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    obj->read_libraries = items;
    obj->read_libraries[obj->read_library_count++] = file;
    return ALP_OK;
}

static alp_result read_statements(alpi_mtl_reader *r, const char *path, const alpi_obj_file *file)
{
    alpi_obj_text text = {.context = r->obj->context,
                          .path = path,
                          .at = file->text,
                          .end = file->text + file->size,
                          .line = 1};
    r->folder = file->folder;
    r->skipping = true; // until its first newmtl
    char first_fault[256];
    uint64_t faults = 0;
    while (alpi_obj_next_line(&text)) {
        const alp_result result = alpi_mtl_read_statement(r, &text);
        if (result == ALP_ERROR_INVALID_DATA && faults++ == 0) {
            alpi_obj_copy_fault(&text, first_fault, sizeof first_fault);
        } else if (result != ALP_OK && result != ALP_ERROR_INVALID_DATA) {
            return result;
        }
    }
    if (faults > 0) {
        alpi_warn(r->obj->context, "mtl-numbers", path, "%s; such statements are left out: %llu",
                  first_fault, (unsigned long long)faults);
    }
    return alpi_mtl_finish_material(r);
}

static alp_result read_library(alpi_mtl_reader *r, const char *path, const char *inner)
{
    alp_context *context = r->obj->context;
    alpi_obj_file file = {0};
    uint8_t *bytes = NULL;
    size_t size = 0;
    ALP_TRY(alpi_file_read(context, path, LIBRARY_LIMIT, &bytes, &size));
    r->obj->hash = alpi_hash_bytes(r->obj->hash, bytes, size);
    ALP_TRY(alpi_obj_file_take(context, bytes, size, &file));
    file.name = alpi_copy_string(context, inner);
    file.folder = alpi_path_folder(context, inner);
    if (file.name == NULL || file.folder == NULL) {
        alpi_obj_file_destroy(context, &file);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result = read_statements(r, path, &file);
    if (result != ALP_OK) {
        alpi_obj_file_destroy(context, &file);
        return result;
    }
    return keep_library(r->obj, file);
}

/// Finds a library: as named, in another case or by its own name beside the asset.
static alp_result find_library(const alpi_mtl_reader *r, alpi_obj_word name, char **inner,
                               bool *found)
{
    alpi_found how = ALPI_FOUND_NOTHING;
    *inner = NULL;
    *found = false;
    if (memchr(name.text, '\0', name.size) != NULL) {
        return ALP_OK;
    }
    const bool quoted = name.size > 2 && *name.text == '"' && name.text[name.size - 1] == '"';
    char *copy = alpi_format(r->obj->context, "%.*s", (int)(name.size - (quoted ? 2 : 0)),
                             name.text + quoted);
    if (copy == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result =
        alpi_find_file(r->obj->context, r->obj->folder, "", copy, inner, &how);
    *found = how != ALPI_FOUND_NOTHING;
    if (result == ALP_OK && *found) {
        char shown[128];
        alpi_mtl_show(name, shown);
        alpi_note_found(r->obj->context, shown, *inner, how);
    }
    alpi_release(r->obj->context, copy);
    return result;
}

/// One library; what cannot be read costs a warning. @param only_try nothing where it is not there
static alp_result try_library(alpi_mtl_reader *r, alpi_obj_word name, bool only_try, bool *found)
{
    alp_context *context = r->obj->context;
    char *inner = NULL, *path = NULL, shown[128], reason[512];
    alpi_mtl_show(name, shown);
    ALP_TRY(find_library(r, name, &inner, found));
    const bool outside = inner == NULL;
    alp_result result = ALP_OK;
    if (*found && !outside) {
        uint32_t number;
        bool added = false;
        result = alpi_obj_names_add(&r->read, inner, strlen(inner), &number, &added);
        path = result == ALP_OK ? alpi_obj_path(r->obj, inner) : NULL;
        result = path == NULL ? ALP_ERROR_OUT_OF_MEMORY
                 : added      ? read_library(r, path, inner)
                              : ALP_OK;
    }
    if (result == ALP_ERROR_IO || result == ALP_ERROR_LIMIT) {
        snprintf(reason, sizeof reason, "%s", alp_context_message(context));
        alpi_warn(context, "mtllib", shown, "%s; its materials are missing", reason);
        result = ALP_OK;
    } else if (result == ALP_OK && !*found && !only_try) {
        alpi_warn(context, "mtllib", shown,
                  outside ? "leaves the asset's folder; " ALPI_OUTSIDE_HINT
                            ": its materials are missing"
                          : "is not there: its materials are missing");
    }
    alpi_release(context, inner);
    alpi_release(context, path);
    return result;
}

/// The names of a line: one that has spaces, or several between spaces.
static alp_result read_libraries(alpi_mtl_reader *r, const char *line)
{
    const alpi_obj_word whole = {line, strlen(line)};
    bool found;
    const bool is_one = strpbrk(line, " \t") == NULL;
    ALP_TRY(try_library(r, whole, !is_one, &found));
    for (const char *at = line; !found && !is_one && *at != '\0';) {
        at += strspn(at, " \t");
        const alpi_obj_word word = {at, strcspn(at, " \t")};
        at += word.size;
        bool there;
        if (word.size > 0) {
            ALP_TRY(try_library(r, word, false, &there));
        }
    }
    return ALP_OK;
}

/// The scene's material of each name that usemtl gave.
static alp_result match_names(alpi_mtl_reader *r, uint32_t **materials)
{
    const alpi_obj_names *used = &r->obj->material_names;
    ALPI_TRY_NEW(r->obj->context, *materials, used->count);
    for (uint32_t i = 0; i < used->count; i++) {
        const char *name = alpi_obj_name(used, i);
        (*materials)[i] = alpi_obj_names_find(&r->names, name, used->sizes[i]);
        if ((*materials)[i] == ALPI_NONE) {
            char shown[128];
            alpi_mtl_show((alpi_obj_word){name, used->sizes[i]}, shown);
            alpi_warn(r->obj->context, "material", shown,
                      "is in no material library: its surfaces are read as grey (albedo 0.5)");
        }
    }
    return ALP_OK;
}

char *alpi_obj_path(const alpi_obj *obj, const char *inner)
{
    return alpi_format(obj->context, "%s%s", inner[0] == '/' ? "" : obj->folder, inner);
}

alp_result alpi_obj_read_materials(alpi_obj *obj, alp_scene *scene, alpi_obj_names *images,
                                   uint32_t **scene_materials)
{
    alpi_mtl_reader r = {.obj = obj,
                         .scene = scene,
                         .images = images,
                         .names = alpi_obj_names_create(obj->context),
                         .read = alpi_obj_names_create(obj->context),
                         .skipping = true,
                         .mask = alpi_texture_none()};
    alp_result result = ALP_OK;
    *scene_materials = NULL;
    for (uint32_t i = 0; result == ALP_OK && i < obj->libraries.count; i++) {
        result = read_libraries(&r, alpi_obj_name(&obj->libraries, i));
    }
    if (result == ALP_OK) {
        result = match_names(&r, scene_materials);
    }
    if (result == ALP_OK && r.invisible > 0) {
        alpi_warn(obj->context, "alpha", obj->path,
                  "materials with Tr 1 and without d, which some exporters write for opaque ones: "
                  "%u; read as opaque, say d if they are not",
                  r.invisible);
    }
    obj->materials = r.names; // which the writer needs
    alpi_obj_names_destroy(&r.read);
    return result;
}
