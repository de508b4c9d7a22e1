// SPDX-License-Identifier: MIT
// Files that the asset of a scene names: its buffers, pictures and material libraries.
#include "formats/formats.h"

#include "base/memory.h"
#include "formats/collada/collada_read.h"
#include "formats/collada/write/collada_patch.h"
#include "formats/gltf/gltf_bytes.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/obj/obj.h"
#include "formats/obj/obj_write.h"

#include <string.h>
#include <sys/stat.h>

typedef struct listing {
    alp_context *context;
    alpi_guard *guard;
    const char *except; // the beginning of paths that stay out, or NULL
} listing;

/// Adds a path, and releases it.
static alp_result add_path(const listing *l, char *path)
{
    const bool out =
        l->except != NULL && path != NULL && strncmp(path, l->except, strlen(l->except)) == 0;
    const alp_result result = path == NULL ? ALP_ERROR_OUT_OF_MEMORY
                              : out        ? ALP_OK
                                           : alpi_guard_add(l->context, l->guard, path);
    alpi_release(l->context, path);
    return result;
}

/// An absolute name stands alone.
static alp_result add_name(const listing *l, const char *folder, const char *name)
{
    return add_path(l, alpi_format(l->context, "%s%s", name[0] == '/' ? "" : folder, name));
}

// --- glTF ----------------------------------------------------------------------------------------

static alp_result add_uris(const alpi_gltf_document *d, const char *kind, const listing *l)
{
    const size_t count = alpi_gltf_count(d, kind);
    for (size_t i = 0; i < count; i++) {
        const char *uri = alpi_gltf_text(alpi_gltf_item(d, kind, i), "uri");
        char *path = NULL;
        const alp_result result = uri != NULL ? alpi_gltf_uri_path(d, uri, kind, &path) : ALP_OK;
        if (result == ALP_ERROR_OUT_OF_MEMORY) {
            return result;
        }
        if (path != NULL) { // NULL: bytes in the text, or a place that is not read
            ALP_TRY(add_path(l, path));
        }
    }
    return ALP_OK;
}

// --- OBJ -----------------------------------------------------------------------------------------

static alp_result add_obj_files(const alpi_obj_source *s, const listing *l)
{
    for (uint32_t i = 0; i < s->library_count; i++) {
        ALP_TRY(add_name(l, s->folder, s->libraries[i].name));
    }
    for (uint32_t i = 0; i < s->images.count; i++) {
        ALP_TRY(add_name(l, s->folder, alpi_obj_name(&s->images, i)));
    }
    return ALP_OK;
}

// --- COLLADA -------------------------------------------------------------------------------------

static alp_result add_collada_files(const alpi_collada_document *d, const listing *l)
{
    for (uint32_t i = 0; d->archive == NULL && i < d->element_count; i++) {
        if (!alpi_xml_is(d->elements[i], "init_from")) {
            continue;
        }
        const xmlNode *ref = alpi_xml_child(d->elements[i], "ref"); // 1.5
        char *uri = alpi_xml_copy_text(d->context, ref != NULL ? ref : d->elements[i]);
        char *name = NULL;
        alp_result result = uri == NULL      ? ALP_ERROR_OUT_OF_MEMORY
                            : uri[0] != '\0' ? alpi_collada_file_name(d, uri, &name)
                                             : ALP_OK;
        if (result == ALP_OK && name != NULL) {
            result = add_name(l, d->folder, name);
        }
        alpi_release(d->context, name);
        alpi_release(d->context, uri);
        ALP_TRY(result);
    }
    return ALP_OK;
}

// -------------------------------------------------------------------------------------------------

alp_result alpi_scene_guard_files(const alp_scene *scene, const char *except, alpi_guard *guard)
{
    const alpi_gltf_document *gltf = scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
    const alpi_collada_origin *collada = scene->attachments[ALPI_ATTACHMENT_COLLADA].data;
    const alpi_obj_source *obj = alpi_obj_source_of(scene);
    const listing l = {scene->context, guard, except};
    if (gltf != NULL) {
        ALP_TRY(add_uris(gltf, "buffers", &l));
        ALP_TRY(add_uris(gltf, "images", &l));
    }
    if (obj != NULL) {
        ALP_TRY(add_obj_files(obj, &l));
    }
    return collada != NULL ? add_collada_files(collada->document, &l) : ALP_OK;
}

bool alp_scene_refers_to(const alp_scene *scene, const char *path)
{
    struct stat status;
    alpi_guard guard = {0};
    if (scene == NULL || path == NULL || stat(path, &status) != 0) {
        return false;
    }
    const alp_result result = alpi_scene_guard_files(scene, NULL, &guard);
    const bool held = alpi_guard_holds(&guard, (alpi_file_id){status.st_dev, status.st_ino});
    alpi_guard_destroy(scene->context, &guard);
    return held || result != ALP_OK;
}

bool alpi_scene_is_ours(const alp_scene *scene)
{
    const alpi_gltf_document *gltf = scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
    const alpi_collada_origin *collada = scene->attachments[ALPI_ATTACHMENT_COLLADA].data;
    const alpi_obj_source *obj = alpi_obj_source_of(scene);
    if (gltf != NULL) {
        const json_t *extras = json_object_get(json_object_get(gltf->root, "asset"), "extras");
        return json_object_get(extras, "alpenglow") != NULL;
    }
    return (collada != NULL && alpi_collada_was_baked(collada->document)) ||
           (obj != NULL && alpi_obj_skip_header(obj->file.text, obj->file.size) != obj->file.text);
}
