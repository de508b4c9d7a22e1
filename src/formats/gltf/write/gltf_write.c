// SPDX-License-Identifier: MIT
// Writes a patched document: collects the bytes of every file first, then adds them to the files
// that are put in their places together, the asset itself last.
#include "formats/gltf/write/gltf_write.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/files/outside.h"
#include "formats/gltf/gltf_bytes.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_container.h"
#include "formats/gltf/write/gltf_tidy.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

// --- files that the asset refers to --------------------------------------------------------------

/// Whether a file lies outside of the asset's folder: a copy would lie outside of the new one.
static bool is_outside(const alpi_output_files *files, const alpi_gltf_document *document,
                       const char *source, const char *uri)
{
    const size_t length = strlen(document->folder);
    const bool from_folder = strncmp(source, document->folder, length) == 0;
    if (from_folder && alpi_path_stays_below(source + length)) {
        return false;
    }
    if (!files->silent && from_folder && source[length] != '/') { // absolute ones stay right
        alpi_warn(files->context, "outside-file", source,
                  "the asset refers to it as \"%.200s\", outside of its folder: it is not "
                  "copied; put it at the same path from the new asset",
                  uri);
    }
    return true;
}

/// Adds the copy of one referenced file; a file that is there already with these bytes is kept.
static alp_result add_copy(alpi_output_files *files, const alpi_gltf_document *document,
                           const char *source, const char *folder)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    alp_result result = alpi_file_read(files->context, source, ALPI_GLTF_FILE_LIMIT, &bytes, &size);
    if (result != ALP_OK) {
        if (!files->silent) {
            alpi_warn(files->context, "missing-file", source,
                      "the asset refers to it, but it cannot be read: it is missing from the "
                      "copy too");
        }
        return result == ALP_ERROR_OUT_OF_MEMORY ? result : ALP_OK;
    }
    char *path = alpi_format(files->context, "%s%s", folder, source + strlen(document->folder));
    return alpi_output_files_add_copy(files, path, bytes, size);
}

/// @param fallbacks copy buffers only that are fallbacks: the others went into the asset
static alp_result add_copies(alpi_output_files *files, const alpi_gltf_document *document,
                             const char *kind, const bool *skipped, bool fallbacks,
                             const char *folder)
{
    size_t count = alpi_gltf_count(document, kind);
    for (size_t i = 0; i < count; i++) {
        const char *uri = alpi_gltf_text(alpi_gltf_item(document, kind, i), "uri");
        char *source = NULL;
        if (uri == NULL || (skipped != NULL && skipped[i]) ||
            (fallbacks && document->buffers[i].bytes != NULL)) {
            continue;
        }
        alp_result result = alpi_gltf_reference_path(document, kind, uri, &source);
        if (result == ALP_OK && source != NULL && !is_outside(files, document, source, uri)) {
            result = add_copy(files, document, source, folder);
        } else if (result != ALP_ERROR_OUT_OF_MEMORY) {
            result = ALP_OK; // data: inside the text, or an address elsewhere that stays right
        }
        alpi_release(files->context, source);
        ALP_TRY(result);
    }
    return ALP_OK;
}

/// Buffers and images that the written asset still refers to go where it looks for them.
static alp_result add_references(alpi_output_files *files, const alpi_gltf_document *document,
                                 const char *path, bool merged, const bool *image_embedded,
                                 const bool *buffers_gone)
{
    char *folder = alpi_path_folder(files->context, path);
    if (folder == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = ALP_OK;
    if (!alpi_same_folder(folder, document->folder)) {
        result = add_copies(files, document, "buffers", buffers_gone, merged, folder);
        if (result == ALP_OK) {
            result = add_copies(files, document, "images", image_embedded, false, folder);
        }
    }
    alpi_release(files->context, folder);
    return result;
}

// --- the asset itself ----------------------------------------------------------------------------

static void add_chunk(alpi_bytes *glb, const char type[4], const alpi_bytes *content, char filler)
{
    size_t padding = (4 - content->size % 4) % 4;
    alpi_bytes_add_u32(glb, (uint32_t)(content->size + padding));
    alpi_bytes_add(glb, type, 4);
    alpi_bytes_add(glb, content->bytes, content->size);
    alpi_bytes_align(glb, filler); // chunks begin at multiples of 4
}

static alp_result assemble_glb(const alpi_gltf_document *document, const alpi_bytes *text,
                               const alpi_bytes *bin, alpi_bytes *glb)
{
    bool has_bin = bin->size > 0 || document->bin != NULL;
    size_t more = document->is_glb ? document->more_chunks_size : 0;
    uint64_t size = 12 + 8 + ((uint64_t)text->size + 3) / 4 * 4 + more;
    size += has_bin ? 8 + ((uint64_t)bin->size + 3) / 4 * 4 : 0;
    if (size > UINT32_MAX) {
        return alpi_fail(document->context, ALP_ERROR_LIMIT,
                         "%s: the baked file would have %llu bytes, more than a .glb can hold; "
                         "write a .gltf",
                         document->path, (unsigned long long)size);
    }
    alpi_bytes_add(glb, "glTF", 4);
    alpi_bytes_add_u32(glb, 2);
    alpi_bytes_add_u32(glb, (uint32_t)size);
    add_chunk(glb, "JSON", text, ' ');
    if (has_bin) {
        add_chunk(glb, "BIN\0", bin, '\0');
    }
    alpi_bytes_add(glb, document->more_chunks, more);
    return glb->failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

/// A .gltf keeps its byte-order mark, if it had one.
static alp_result assemble_gltf(const alpi_gltf_document *document, const alpi_bytes *text,
                                alpi_bytes *gltf)
{
    if (!document->is_glb) {
        alpi_bytes_add(gltf, document->file_bytes, document->text_begin);
    } else if (document->more_chunks_size > 0) {
        alpi_note(document->context, "chunks", document->path,
                  "chunks after BIN are left out: a .gltf has no place for them");
    }
    alpi_bytes_add(gltf, text->bytes, text->size);
    return gltf->failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

// --- writing -------------------------------------------------------------------------------------

/// One writing: what is owned while it runs.
typedef struct writing {
    const alpi_gltf_document *document;
    const alpi_mesh_patch *patch;
    const char *path;
    bool to_glb;
    alpi_gltf_names names;
    alpi_gltf_patcher patcher;
    alpi_output_files files;
    alpi_bytes bin, text, asset;
    bool *buffers_gone; // [buffers of the document]
} writing;

static alp_result add_side_file(writing *w, const char *path, const void *bytes, size_t size)
{
    return alpi_output_files_add(
        &w->files, (alpi_output_file){alpi_copy_string(w->files.context, path), bytes, size, NULL});
}

static bool first_is_bin(const alpi_gltf_document *document)
{
    return document->bin != NULL && document->buffer_count > 0 &&
           document->buffers[0].bytes == document->bin;
}

/// The new files beside a .gltf.
static alp_result add_side_files(writing *w)
{
    const alpi_gltf_document *document = w->document;
    if (first_is_bin(document) && !w->buffers_gone[0]) {
        ALP_TRY(add_side_file(w, w->names.bin, w->bin.bytes, w->bin.size));
    }
    if (w->patcher.data.size > 0) {
        ALP_TRY(add_side_file(w, w->names.data, w->patcher.data.bytes, w->patcher.data.size));
    }
    for (uint32_t i = 0; i < w->names.images.occlusion; i++) {
        if (w->patcher.page_textures[i] != ALPI_GLTF_NONE) {
            ALP_TRY(add_side_file(w, w->names.pages[i], w->patch->page_pngs[i],
                                  w->patch->page_png_sizes[i]));
        }
    }
    for (uint32_t i = 0; i < w->patch->packed_count; i++) {
        if (w->patcher.packed_images[i] != ALPI_GLTF_NONE) {
            const alpi_packed_image *packed = &w->patch->packed_images[i];
            ALP_TRY(add_side_file(w, w->names.pages[w->names.images.occlusion + i], packed->png,
                                  packed->png_size));
        }
    }
    return ALP_OK;
}

/// Light that is not inside the asset.
static alp_result add_light_files(writing *w)
{
    const alpi_output_images *images = &w->names.images;
    for (uint32_t i = 0; i < images->light; i++) {
        if (w->patcher.light_textures[i] != ALPI_GLTF_NONE) {
            ALP_TRY(add_side_file(w, w->names.pages[images->occlusion + images->packed + i],
                                  w->patch->light->pages[i], w->patch->light->page_sizes[i]));
        }
    }
    return ALP_OK;
}

/// What nothing reads any more goes. Bytes are cut where they are written anew anyway; a file
/// beside a .gltf is dropped as a whole or stays.
static alp_result tidy(writing *w, alpi_gltf_home home)
{
    const alpi_gltf_document *document = w->document;
    ALPI_TRY_NEW(document->context, w->buffers_gone, document->buffer_count);
    const bool is_chunk = home == ALPI_HOME_BIN || home == ALPI_HOME_MERGED;
    const bool is_bin = is_chunk || (home == ALPI_HOME_FILE && first_is_bin(document));
    const bool has_file = home == ALPI_HOME_FILE && w->patcher.data.size > 0;
    const bool keeps_buffers = home != ALPI_HOME_MERGED; // else they are others now
    const alpi_gltf_leftovers from = {.first_stays = is_chunk || w->to_glb,
                                      .bin = is_bin ? &w->bin : NULL,
                                      .data = has_file ? &w->patcher.data : NULL,
                                      .document = document,
                                      .copy_count = w->patcher.copy_count,
                                      .images_gone = w->patcher.image_embedded,
                                      .buffers_gone = w->buffers_gone,
                                      .image_count = alpi_gltf_count(document, "images"),
                                      .buffer_count = keeps_buffers ? document->buffer_count : 0};
    return alpi_gltf_tidy(document->context, &from, &w->text);
}

/// The BIN chunk of a .glb that becomes a .gltf, without its padding.
static alp_result take_bin(writing *w)
{
    size_t size;
    ALP_TRY(alpi_gltf_size(w->document, alpi_gltf_item(w->document, "buffers", 0), "byteLength",
                           "buffer 0", &size));
    alpi_bytes_add(&w->bin, w->document->bin, size);
    return w->bin.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

static alp_result patch_text(writing *w, alpi_gltf_home home)
{
    const alpi_output_images *images = &w->names.images;
    w->patcher.page_uris = w->to_glb ? NULL : w->names.page_uris;
    w->patcher.light_uris = images->light > 0 && images->light_is_beside
                                ? w->names.page_uris + images->occlusion + images->packed
                                : NULL;
    ALP_TRY(alpi_gltf_prepare_home(&w->patcher, home));
    ALP_TRY(alpi_patcher_run(&w->patcher));
    ALP_TRY(alpi_gltf_settle_home(&w->patcher, home, &w->names, &w->bin));
    if (home == ALPI_HOME_FILE && first_is_bin(w->document)) {
        ALP_TRY(take_bin(w));
    }
    ALP_TRY(alpi_patcher_finish(&w->patcher, &w->text));
    return tidy(w, home);
}

static alp_result collect_files(writing *w, alpi_gltf_home home)
{
    ALP_TRY(w->to_glb ? assemble_glb(w->document, &w->text, &w->bin, &w->asset)
                      : assemble_gltf(w->document, &w->text, &w->asset));
    if (!w->to_glb) {
        ALP_TRY(add_side_files(w));
    }
    ALP_TRY(add_light_files(w));
    ALP_TRY(add_references(&w->files, w->document, w->path, home == ALPI_HOME_MERGED,
                           w->patcher.image_embedded, w->buffers_gone));
    return add_side_file(w, w->path, w->asset.bytes, w->asset.size);
}

static alp_result run_writing(writing *w, const alp_scene *scene, alpi_file_set *set)
{
    const alpi_output_images images = alpi_gltf_patch_images(w->patch, w->to_glb);
    if (!w->to_glb || images.light > 0) {
        ALP_TRY(alpi_gltf_names_create(scene->context, w->document, w->path, &images, &w->names));
    }
    ALP_TRY(alpi_patcher_create(scene, w->patch, w->document, &w->patcher));
    alpi_gltf_home home = alpi_gltf_choose_home(w->document, w->to_glb);
    alp_result result = patch_text(w, home);
    if (result == ALP_OK) {
        result = collect_files(w, home);
    }
    if (result == ALP_OK) {
        result = alpi_output_files_make_folders(&w->files);
    }
    if (result == ALP_OK) {
        result = alpi_output_files_add_to(&w->files, set);
    }
    alpi_patcher_destroy(&w->patcher);
    return result;
}

static alp_result choose_container(alp_context *context, const char *path, bool *to_glb)
{
    *to_glb = alpi_path_has_ending(path, ".glb");
    return *to_glb || alpi_path_has_ending(path, ".gltf")
               ? ALP_OK
               : alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                           "%s: a baked scene is written as .glb or .gltf", path);
}

static alp_result write_document(const alp_scene *scene, const alpi_gltf_document *document,
                                 const alpi_mesh_patch *patch, const char *path, alpi_file_set *set)
{
    alp_context *context = scene->context;
    writing w = {.document = document,
                 .patch = patch,
                 .path = path,
                 .files = {.context = context},
                 .bin = alpi_bytes_create(context),
                 .text = alpi_bytes_create(context),
                 .asset = alpi_bytes_create(context)};
    ALP_TRY(choose_container(context, path, &w.to_glb));
    ALP_TRY(alpi_file_check_writable(context, path, set->overwrite));
    alp_result result = run_writing(&w, scene, set);
    alpi_output_files_destroy(&w.files);
    alpi_gltf_names_destroy(context, &w.names);
    alpi_bytes_destroy(&w.bin);
    alpi_bytes_destroy(&w.text);
    alpi_bytes_destroy(&w.asset);
    alpi_release(context, w.buffers_gone);
    return result;
}

alp_result alpi_gltf_add_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                 const char *path, alpi_file_set *files)
{
    const alpi_gltf_document *document = scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
    if (document != NULL) {
        return write_document(scene, document, patch, path, files);
    }
    uint8_t *bytes = NULL;
    size_t size = 0;
    alpi_gltf_document *exported = NULL;
    ALP_TRY(alpi_gltf_export_scene(scene, patch->corner_uvs == NULL, &bytes, &size));
    ALP_TRY(alpi_gltf_document_parse(scene->context, scene->name, bytes, size, &exported));
    alp_result result = write_document(scene, exported, patch, path, files);
    alpi_gltf_document_destroy(exported);
    return result;
}

// --- before the long work ------------------------------------------------------------------------

/// Copies of referenced files, as far as their folders are there already.
static alp_result check_references(const alpi_gltf_document *document, const char *path,
                                   bool merged, bool overwrite)
{
    alpi_output_files files = {.context = document->context, .silent = true};
    alp_result result = ALP_OK;
    if (!merged) { // merging embeds all
        result = add_references(&files, document, path, merged, NULL, NULL);
    }
    for (size_t i = 0; result == ALP_OK && i < files.count; i++) {
        if (access(files.items[i].path, F_OK) == 0) {
            result = alpi_file_check_writable(files.context, files.items[i].path, overwrite);
        }
    }
    alpi_output_files_destroy(&files);
    return result;
}

alp_result alpi_gltf_check_output(const alp_scene *scene, uint32_t page_count, const char *path,
                                  bool overwrite)
{
    const alpi_output_images images = {.occlusion = page_count};
    return alpi_gltf_check_outputs(scene, &images, path, overwrite);
}

alp_result alpi_gltf_check_outputs(const alp_scene *scene, const alpi_output_images *images,
                                   const char *path, bool overwrite)
{
    alp_context *context = scene->context;
    const alpi_gltf_document *document = scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
    bool to_glb;
    ALP_TRY(choose_container(context, path, &to_glb));
    ALP_TRY(alpi_file_check_writable(context, path, overwrite));
    if (document != NULL) {
        ALP_TRY(check_references(document, path, to_glb && !document->is_glb, overwrite));
    }
    alpi_output_images beside = *images;
    if (to_glb) { // holds all but light that it only names
        beside.occlusion = beside.packed = 0;
        beside.light = images->light_is_beside ? images->light : 0;
    }
    const uint32_t count = beside.occlusion + beside.packed + beside.light;
    if (to_glb && count == 0) {
        return ALP_OK;
    }
    alpi_gltf_names names;
    ALP_TRY(alpi_gltf_names_create(context, document, path, &beside, &names));
    alp_result result = to_glb ? ALP_OK : alpi_file_check_writable(context, names.data, overwrite);
    if (result == ALP_OK && !to_glb && (document == NULL || document->is_glb)) {
        result = alpi_file_check_writable(context, names.bin, overwrite);
    }
    for (uint32_t i = 0; result == ALP_OK && i < count; i++) {
        result = alpi_file_check_writable(context, names.pages[i], overwrite);
    }
    alpi_gltf_names_destroy(context, &names);
    return result;
}
