// SPDX-License-Identifier: MIT
// Names of the files that a written .gltf refers to: OUT.bin, OUT.bake.bin, OUT.ao.png,
// OUT.ao.1.png, OUT.orm.png, OUT.orm.1.png, OUT.light.png (or .ktx2 …), OUT.light.1.png. A file
// baked again over itself refers to such names already: then "OUT-2", "OUT-3" …
#include "formats/gltf/write/gltf_names.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/files/outside.h"
#include "formats/gltf/gltf_bytes.h"
#include "formats/gltf/gltf_tree.h"

#include <string.h>

/// Whether a buffer or image of the document is the file `name` in the document's folder.
static alp_result is_referenced(const alpi_gltf_document *document, const char *kind,
                                const char *name, bool *found)
{
    size_t count = alpi_gltf_count(document, kind);
    for (size_t i = 0; i < count && !*found; i++) {
        const char *uri = alpi_gltf_text(alpi_gltf_item(document, kind, i), "uri");
        char *path = NULL;
        if (uri == NULL) {
            continue;
        }
        if (alpi_gltf_reference_path(document, kind, uri, &path) == ALP_ERROR_OUT_OF_MEMORY) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        if (path != NULL) {
            const char *relative = path + strlen(document->folder);
            while (strncmp(relative, "./", 2) == 0) {
                relative += 2;
            }
            *found = strcmp(relative, name) == 0;
        }
        alpi_release(document->context, path);
    }
    return ALP_OK;
}

static uint32_t image_count(const alpi_gltf_names *names)
{
    return names->images.occlusion + names->images.packed + names->images.light;
}

/// "STEM.KIND.png" and "STEM.KIND.N.png"
static char *image_path(alp_context *context, const char *stem, const alpi_output_images *images,
                        uint32_t index)
{
    const uint32_t packed = images->occlusion, light = packed + images->packed;
    const char *kind = index >= light ? "light" : index >= packed ? "orm" : "ao";
    const char *ending = index >= light ? images->light_ending : ".png";
    const uint32_t number = index - (index >= light ? light : index >= packed ? packed : 0);
    return number == 0 ? alpi_format(context, "%s.%s%s", stem, kind, ending)
                       : alpi_format(context, "%s.%s.%u%s", stem, kind, number, ending);
}

static bool fill_names(alp_context *context, const char *stem, alpi_gltf_names *names)
{
    bool good = (names->bin = alpi_format(context, "%s.bin", stem)) != NULL &&
                (names->data = alpi_format(context, "%s.bake.bin", stem)) != NULL &&
                (names->bin_uri = alpi_uri_encode(context, alpi_path_name(names->bin))) != NULL &&
                (names->data_uri = alpi_uri_encode(context, alpi_path_name(names->data))) != NULL;
    for (uint32_t i = 0; good && i < image_count(names); i++) {
        names->pages[i] = image_path(context, stem, &names->images, i);
        good = names->pages[i] != NULL &&
               (names->page_uris[i] = alpi_uri_encode(context, alpi_path_name(names->pages[i]))) !=
                   NULL;
    }
    return good;
}

/// A .glb has no other files beside it than images.
static alp_result find_clash(const alpi_gltf_document *document, const alpi_gltf_names *names,
                             bool to_glb, bool *clash)
{
    const char *const files[] = {names->bin, names->data};
    *clash = false;
    for (size_t i = to_glb ? 2 : 0; i < 2 + (size_t)image_count(names) && !*clash; i++) {
        const char *name = alpi_path_name(i < 2 ? files[i] : names->pages[i - 2]);
        ALP_TRY(is_referenced(document, "buffers", name, clash));
        if (!*clash) {
            ALP_TRY(is_referenced(document, "images", name, clash));
        }
    }
    return ALP_OK;
}

static alp_result try_names(alp_context *context, const alpi_gltf_document *document,
                            const char *path, uint32_t attempt, alpi_gltf_names *names, bool *clash)
{
    const bool to_glb = alpi_path_has_ending(path, ".glb");
    int length = (int)(strlen(path) - strlen(to_glb ? ".glb" : ".gltf"));
    ALPI_TRY_NEW(context, names->pages, image_count(names));
    ALPI_TRY_NEW(context, names->page_uris, image_count(names));
    char *stem = attempt == 1 ? alpi_format(context, "%.*s", length, path)
                              : alpi_format(context, "%.*s-%u", length, path, attempt);
    bool good = stem != NULL && fill_names(context, stem, names);
    alpi_release(context, stem);
    *clash = false;
    if (!good) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    return document != NULL ? find_clash(document, names, to_glb, clash) : ALP_OK;
}

alp_result alpi_gltf_names_create(alp_context *context, const alpi_gltf_document *document,
                                  const char *path, const alpi_output_images *images,
                                  alpi_gltf_names *names)
{
    bool clash = true;
    *names = (alpi_gltf_names){0};
    for (uint32_t attempt = 1; clash; attempt++) { // ends: a document refers to finitely many
        alpi_gltf_names_destroy(context, names);
        names->images = *images;
        alp_result result = try_names(context, document, path, attempt, names, &clash);
        if (result != ALP_OK) {
            alpi_gltf_names_destroy(context, names);
            return result;
        }
    }
    return ALP_OK;
}

alpi_output_images alpi_gltf_patch_images(const alpi_mesh_patch *patch, bool to_glb)
{
    const alpi_light_patch *light = patch->light;
    const bool beside = light != NULL && light->form == ALPI_LIGHT_FORM_EXTRAS;
    return (alpi_output_images){
        .occlusion = to_glb || patch->page_pngs == NULL ? 0 : patch->page_count,
        .packed = to_glb ? 0 : patch->packed_count,
        .light = light == NULL || (to_glb && !beside) ? 0 : patch->page_count,
        .light_ending = light != NULL ? light->ending : NULL,
        .light_is_beside = beside};
}

void alpi_gltf_names_destroy(alp_context *context, alpi_gltf_names *names)
{
    for (uint32_t i = 0; i < image_count(names); i++) {
        if (names->pages != NULL) {
            alpi_release(context, names->pages[i]);
        }
        if (names->page_uris != NULL) {
            alpi_release(context, names->page_uris[i]);
        }
    }
    alpi_release(context, names->bin);
    alpi_release(context, names->data);
    alpi_release(context, names->bin_uri);
    alpi_release(context, names->data_uri);
    alpi_release(context, names->pages);
    alpi_release(context, names->page_uris);
    *names = (alpi_gltf_names){0};
}
