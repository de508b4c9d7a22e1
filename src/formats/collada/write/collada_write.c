// SPDX-License-Identifier: MIT
// Writes a baked COLLADA document: the text as it was read, with what the bake adds spliced in, and
// the maps as PNG beside it. Temporary files first; they are renamed at the end, the document last.
#include "formats/collada/write/collada_patch.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/collada/write/collada_write.h"
#include "formats/files/outside.h"
#include "formats/text/utf16.h"

#include <string.h>

// --- names ---------------------------------------------------------------------------------------

/// "OUT.ao.png", "OUT.ao.1.png" … of OUT.dae. Released by the caller.
static char *image_path(alp_context *context, const char *path, const char *kind, uint32_t page)
{
    const int length = (int)(strlen(path) - strlen(".dae"));
    return page == 0 ? alpi_format(context, "%.*s.%s.png", length, path, kind)
                     : alpi_format(context, "%.*s.%s.%u.png", length, path, kind, page);
}

/// Files of one kind of map.
typedef struct image_files {
    char **paths, **uris; // [page_count]
    uint32_t count;
} image_files;

static alp_result name_files(alp_context *context, const char *path, const char *kind,
                             uint32_t count, image_files *files)
{
    ALPI_TRY_NEW(context, files->paths, count);
    ALPI_TRY_NEW(context, files->uris, count);
    files->count = count;
    for (uint32_t i = 0; i < count; i++) {
        files->paths[i] = image_path(context, path, kind, i);
        if (files->paths[i] == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        files->uris[i] = alpi_uri_encode(context, alpi_path_name(files->paths[i]));
        if (files->uris[i] == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
    }
    return ALP_OK;
}

static void image_files_destroy(alp_context *context, image_files *files)
{
    for (uint32_t i = 0; i < files->count; i++) {
        alpi_release(context, files->paths[i]);
        alpi_release(context, files->uris[i]);
    }
    alpi_release(context, files->paths);
    alpi_release(context, files->uris);
}

// --- the patcher ---------------------------------------------------------------------------------

static void patcher_destroy(alpi_collada_patcher *p)
{
    for (uint32_t c = 0; c < p->class_count; c++) {
        for (uint32_t i = 0; i < p->classes[c].symbol_count; i++) {
            alpi_release(p->context, p->classes[c].symbols[i].name);
        }
        alpi_release(p->context, p->classes[c].symbols);
    }
    for (uint32_t i = 0; i < p->made_count; i++) {
        alpi_release(p->context, p->made[i].id);
    }
    void *const owned[] = {p->pages,     p->baked,        p->first_surfaces, p->placement_class,
                           p->classes,   p->effect_pages, p->effect_done,    p->made,
                           p->page_used, p->effect_users, p->removed,        p->left_out,
                           p->rebound,   p->named};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) {
        alpi_release(p->context, owned[i]);
    }
    alpi_edits_destroy(&p->edits);
    alpi_bytes_destroy(&p->images);
    alpi_bytes_destroy(&p->effects);
    alpi_bytes_destroy(&p->materials);
    alpi_collada_reader_destroy(&p->reader);
}

/// Appends to a library, which is made before <scene> where there is none.
static void add_to_library(alpi_collada_patcher *p, const char *name, const alpi_bytes *items)
{
    const xmlNode *library = alpi_xml_child(p->document->root, name);
    if (items->failed || items->size == 0) {
        p->edits.inserted.failed |= items->failed;
        return;
    }
    if (library != NULL) {
        alpi_xml_append(p->document, &p->edits, library, NULL, (const char *)items->bytes);
        return;
    }
    alpi_bytes text = alpi_bytes_create(p->context);
    alpi_bytes_print(&text, "<%s>", name);
    alpi_bytes_add(&text, items->bytes, items->size);
    alpi_bytes_print(&text, "</%s>", name);
    p->edits.inserted.failed |= text.failed;
    const xmlNode *scene = alpi_xml_child(p->document->root, "scene");
    scene = scene != NULL ? scene : alpi_xml_child(p->document->root, "extra");
    if (!text.failed) {
        alpi_xml_append(p->document, &p->edits, p->document->root, scene, (const char *)text.bytes);
    }
    alpi_bytes_destroy(&text);
}

/// What made it, as an <extra> at the end of the document; that of an earlier bake goes.
static void state_origin(alpi_collada_patcher *p)
{
    const char *json = p->patch->extras_json;
    const xmlNode *extra = alpi_xml_child(p->document->root, "extra");
    for (; extra != NULL; extra = alpi_xml_next(extra, "extra")) {
        const char *type = alpi_xml_attribute(extra, "type");
        if (type != NULL && strcmp(type, "alpenglow") == 0) {
            const alpi_xml_span *span = alpi_xml_span_of(p->document, extra);
            const bool ends_line = p->document->text[span->end] == '\n'; // we wrote it, see below
            alpi_edits_replace(&p->edits, (alpi_json_span){span->begin, span->end + ends_line},
                               "%s", "");
        }
    }
    if (json == NULL) {
        return;
    }
    alpi_bytes text = alpi_bytes_create(p->context);
    alpi_bytes_print(&text, "<extra type=\"alpenglow\"><technique profile=\"alpenglow\"><bake>");
    alpi_xml_print_text(&text, json);
    alpi_bytes_print(&text, "</bake></technique></extra>\n");
    p->edits.inserted.failed |= text.failed;
    if (!text.failed) {
        alpi_xml_append(p->document, &p->edits, p->document->root, NULL, (const char *)text.bytes);
    }
    alpi_bytes_destroy(&text);
}

static alp_result run_patcher(alpi_collada_patcher *p)
{
    ALPI_TRY_NEW(p->context, p->page_used, p->patch->page_count);
    ALPI_TRY_NEW(p->context, p->removed, p->document->element_count);
    ALPI_TRY_NEW(p->context, p->left_out, p->document->element_count);
    ALPI_TRY_NEW(p->context, p->rebound, p->document->element_count);
    ALPI_TRY_NEW(p->context, p->named, p->document->element_count);
    ALP_TRY(alpi_collada_plan(p));
    ALP_TRY(alpi_collada_plan_effects(p));
    for (uint32_t c = 0; c < p->class_count; c++) {
        ALP_TRY(alpi_collada_patch_geometry(p, c));
    }
    ALP_TRY(alpi_collada_patch_instances(p));
    alpi_collada_tidy_copies(p);
    alpi_collada_tidy_images(p);
    alpi_collada_add_images(p);
    add_to_library(p, "library_images", &p->images);
    add_to_library(p, "library_effects", &p->effects);
    add_to_library(p, "library_materials", &p->materials);
    state_origin(p);
    return p->edits.inserted.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

/// The whole new file, in the encoding of the old one.
static alp_result print_document(alpi_collada_patcher *p, alpi_bytes *out)
{
    const alpi_collada_document *d = p->document;
    alpi_bytes text = alpi_bytes_create(p->context);
    uint8_t *wide = NULL;
    size_t size = 0;
    if (d->encoding == ALPI_XML_BYTES && d->has_mark) {
        alpi_bytes_add(&text, "\xEF\xBB\xBF", 3);
    }
    alp_result result = alpi_edits_apply(&p->edits, (alpi_json_span){0, d->text_size}, &text);
    if (result == ALP_OK) {
        alpi_collada_settle_prefix(p, &text);
    }
    if (result == ALP_OK && d->encoding == ALPI_XML_BYTES) {
        *out = text;
        return ALP_OK;
    }
    if (result == ALP_OK) {
        result = alpi_utf16_encode(p->context, (const char *)text.bytes, text.size,
                                   d->encoding == ALPI_XML_UTF16_BE, &wide, &size);
    }
    if (result == ALP_OK) {
        alpi_bytes_add(out, wide, size);
        result = out->failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    }
    alpi_release(p->context, wide);
    alpi_bytes_destroy(&text);
    return result;
}

// --- files ---------------------------------------------------------------------------------------

typedef struct writing {
    alp_context *context;
    const alpi_mesh_patch *patch;
    const char *path;
    image_files occlusion, light;
    alpi_output_files files;
    alpi_file_set *set;
} writing;

static alp_result add_file(writing *w, const char *path, const void *bytes, size_t size)
{
    return alpi_output_files_add(
        &w->files, (alpi_output_file){alpi_copy_string(w->context, path), bytes, size, NULL});
}

static alp_result add_maps(writing *w, const alpi_collada_patcher *p)
{
    for (uint32_t i = 0; i < w->patch->page_count; i++) {
        if (i < w->occlusion.count && p->page_used[i]) {
            ALP_TRY(add_file(w, w->occlusion.paths[i], w->patch->page_pngs[i],
                             w->patch->page_png_sizes[i]));
        }
        if (i < w->light.count && p->page_used[i]) {
            ALP_TRY(add_file(w, w->light.paths[i], w->patch->light->pages[i],
                             w->patch->light->page_sizes[i]));
        }
    }
    return ALP_OK;
}

/// The image that an <init_from> names goes where the new document looks for it.
static alp_result add_image_copy(writing *w, const alpi_collada_document *d, const char *uri,
                                 const char *folder)
{
    char *name = NULL;
    uint8_t *bytes = NULL;
    size_t size = 0;
    ALP_TRY(alpi_collada_file_name(d, uri, &name));
    if (name == NULL) {
        if (strncmp(uri, "..", 2) == 0) { // else an address that stays right
            alpi_warn(w->context, "images", w->path,
                      "names \"%.200s\" outside the document's folder, which is not copied; put "
                      "it at the same path from the new document",
                      uri);
        }
        return ALP_OK;
    }
    alp_result result = alpi_collada_file_read(d, uri, &bytes, &size);
    if (result == ALP_OK) {
        char *path = alpi_format(w->context, "%s%s", folder, name);
        result = alpi_output_files_add_copy(&w->files, path, bytes, size);
    } else if (result != ALP_ERROR_OUT_OF_MEMORY) {
        alpi_note(w->context, "missing-file", name,
                  "the document refers to it, but it cannot be read: it is missing from the copy"
                  " too");
        result = ALP_OK;
    }
    alpi_release(w->context, name);
    return result;
}

/// Images that the document names by relative paths go with it to another folder, as a .gltf's do;
/// those of an archive come out of it.
static alp_result add_image_copies(writing *w, const alpi_collada_patcher *p)
{
    const alpi_collada_document *d = p->document;
    char *folder = alpi_path_folder(w->context, w->path);
    if (folder == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const bool moved = d->archive != NULL || !alpi_same_folder(folder, d->folder);
    alp_result result = ALP_OK;
    for (uint32_t i = 0; moved && result == ALP_OK && i < d->element_count; i++) {
        if (!alpi_xml_is(d->elements[i], "image") || p->removed[i]) {
            continue;
        }
        const xmlNode *from = alpi_xml_child(d->elements[i], "init_from");
        const xmlNode *ref = alpi_xml_child(from, "ref"); // 1.5
        char *uri = alpi_xml_copy_text(w->context, ref != NULL ? ref : from);
        result = uri == NULL      ? ALP_ERROR_OUT_OF_MEMORY
                 : uri[0] != '\0' ? add_image_copy(w, d, uri, folder)
                                  : ALP_OK;
        alpi_release(w->context, uri);
    }
    alpi_release(w->context, folder);
    return result;
}

static alp_result write_files(writing *w, const alpi_collada_patcher *p, const alpi_bytes *text)
{
    ALP_TRY(add_maps(w, p));
    ALP_TRY(add_image_copies(w, p));
    ALP_TRY(add_file(w, w->path, text->bytes, text->size));
    ALP_TRY(alpi_output_files_make_folders(&w->files));
    return alpi_output_files_add_to(&w->files, w->set);
}

static alp_result patch_and_write(writing *w, const alp_scene *scene)
{
    const alpi_collada_origin *origin = scene->attachments[ALPI_ATTACHMENT_COLLADA].data;
    const char *version = alpi_xml_attribute(origin->document->root, "version");
    alpi_collada_patcher p = {.context = w->context,
                              .scene = scene,
                              .patch = w->patch,
                              .origin = origin,
                              .document = origin->document,
                              .edits = alpi_edits_create(w->context, origin->document->text),
                              .is_1_5 = version != NULL && strncmp(version, "1.5", 3) == 0,
                              .image_names = w->occlusion.uris,
                              .light_names = w->light.uris,
                              .images = alpi_bytes_create(w->context),
                              .effects = alpi_bytes_create(w->context),
                              .materials = alpi_bytes_create(w->context)};
    alpi_bytes text = alpi_bytes_create(w->context);
    alpi_collada_choose_prefix(&p);
    alp_result result = alpi_collada_reader_create(origin->document, &p.reader);
    if (result == ALP_OK) {
        result = run_patcher(&p);
    }
    if (result == ALP_OK) {
        result = print_document(&p, &text);
    }
    if (result == ALP_OK) {
        result = write_files(w, &p, &text);
    }
    alpi_bytes_destroy(&text);
    patcher_destroy(&p);
    return result;
}

static alp_result check_request(const alp_scene *scene, const char *path)
{
    if (scene->attachments[ALPI_ATTACHMENT_COLLADA].data == NULL) {
        return alpi_fail(scene->context, ALP_ERROR_UNSUPPORTED,
                         "%s: a .dae is written where the scene was read from one, and \"%s\" was "
                         "not; write .glb or .gltf",
                         path, scene->name);
    }
    return ALP_OK;
}

alp_result alpi_collada_check_outputs(const alp_scene *scene, const alpi_output_images *images,
                                      const char *path, bool overwrite)
{
    static const char *const kinds[] = {"ao", "light"};
    const uint32_t counts[] = {images->occlusion, images->light};
    ALP_TRY(check_request(scene, path));
    if (images->light > 0 &&
        (images->light_is_beside || strcmp(images->light_ending, ".png") != 0)) {
        return alpi_fail(scene->context, ALP_ERROR_UNSUPPORTED,
                         "%s: a .dae stores light as emission only; use --lightmap-as emissive, "
                         "or write .glb",
                         path);
    }
    ALP_TRY(alpi_file_check_writable(scene->context, path, overwrite));
    for (int kind = 0; kind < 2; kind++) {
        for (uint32_t i = 0; i < counts[kind]; i++) {
            char *image = image_path(scene->context, path, kinds[kind], i);
            alp_result result = image == NULL
                                    ? ALP_ERROR_OUT_OF_MEMORY
                                    : alpi_file_check_writable(scene->context, image, overwrite);
            alpi_release(scene->context, image);
            ALP_TRY(result);
        }
    }
    return ALP_OK;
}

alp_result alpi_collada_add_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                    const char *path, alpi_file_set *files)
{
    alp_context *context = scene->context;
    ALP_TRY(check_request(scene, path));
    if (patch->vertex_values != NULL ||
        (patch->light != NULL && patch->light->form != ALPI_LIGHT_FORM_EMISSIVE)) {
        return alpi_fail(context, ALP_ERROR_UNSUPPORTED,
                         "%s: a .dae is written with occlusion and emissive light as maps only; "
                         "write .glb",
                         path);
    }
    writing w = {.context = context,
                 .patch = patch,
                 .path = path,
                 .set = files,
                 .files = {.context = context}};
    const uint32_t count = patch->page_count;
    alp_result result =
        name_files(context, path, "ao", patch->page_pngs != NULL ? count : 0, &w.occlusion);
    if (result == ALP_OK) {
        result = name_files(context, path, "light", patch->light != NULL ? count : 0, &w.light);
    }
    if (result == ALP_OK) {
        result = patch_and_write(&w, scene);
    }
    alpi_output_files_destroy(&w.files);
    image_files_destroy(context, &w.occlusion);
    image_files_destroy(context, &w.light);
    return result;
}
