// SPDX-License-Identifier: MIT
// The OBJ that a scene was read from, with its bake. Statements are repeated word for word.
#include "formats/obj/obj_patch.h"

#include "base/file.h"
#include "base/memory.h"

#include <string.h>

// --- copying -------------------------------------------------------------------------------------

void alpi_obj_copy_up_to(alpi_obj_patcher *p, const char *end)
{
    if (end > p->copied) {
        alpi_bytes_add(p->out, p->copied, (size_t)(end - p->copied));
        p->copied = end;
    }
}

const char *alpi_obj_line_begin(const alpi_obj_patcher *p, const char *at)
{
    while (at > p->copied && at[-1] != '\n' && at[-1] != '\r') {
        at--;
    }
    return at;
}

/// Leaves out the statement that begins at `keyword`, with its line.
static void drop_line(alpi_obj_patcher *p, const char *keyword)
{
    alpi_obj_copy_up_to(p, alpi_obj_line_begin(p, keyword));
    alpi_obj_end_line(&p->text);
    p->copied = p->text.at;
}

// --- materials -----------------------------------------------------------------------------------

/// A name that neither a material of the source nor a written one has.
static alp_result choose_name(alpi_obj_patcher *p, alpi_obj_use use, uint32_t number)
{
    alpi_obj_writer *w = p->w;
    const bool first = use.material != ALPI_NONE && !p->material_used[use.material];
    const char *own =
        use.material == ALPI_NONE ? "none" : alpi_obj_name(&p->source->materials, use.material);
    char *name = alpi_copy_string(w->context, own);
    bool added = false;
    uint32_t at;
    for (uint32_t i = number;
         name != NULL && !first &&
         (alpi_obj_names_find(&p->source->materials, name, strlen(name)) != ALPI_NONE ||
          alpi_obj_names_find(&w->names, name, strlen(name)) != ALPI_NONE);
         i++) {
        alpi_release(w->context, name);
        name = alpi_format(w->context, "%s_%u", own, i);
    }
    const alp_result result = name == NULL
                                  ? ALP_ERROR_OUT_OF_MEMORY
                                  : alpi_obj_names_add(&w->names, name, strlen(name), &at, &added);
    alpi_release(w->context, name);
    if (use.material != ALPI_NONE) {
        p->material_used[use.material] = true;
    }
    return result;
}

/// The name of a use.
static alp_result find_name(alpi_obj_patcher *p, alpi_obj_use use, const char **name)
{
    uint32_t number;
    bool added;
    ALP_TRY(alpi_obj_names_add(&p->w->uses, &use, sizeof use, &number, &added));
    if (added) {
        ALP_TRY(choose_name(p, use, number));
    }
    *name = alpi_obj_name(&p->w->names, number);
    return ALP_OK;
}

alp_result alpi_obj_name_material(alpi_obj_patcher *p, alpi_obj_use use)
{
    const char *name;
    const bool bare = use.material == ALPI_NONE && use.page == ALPI_NONE;
    if (p->is_named ? memcmp(&p->current, &use, sizeof use) == 0 : bare) {
        return ALP_OK;
    }
    ALP_TRY(find_name(p, use, &name));
    alpi_bytes_print(p->out, "usemtl %s\n", name);
    p->current = use;
    p->is_named = true;
    return ALP_OK;
}

// --- other statements ----------------------------------------------------------------------------

/// Whether a face comes before another usemtl, and how many corners it has.
static uint32_t next_face(const alpi_obj_patcher *p)
{
    alpi_obj_text ahead = p->text;
    while (alpi_obj_next_line(&ahead)) {
        const alpi_obj_word key = alpi_obj_take_word(&ahead);
        uint32_t corners = 0;
        if (alpi_obj_word_is(key, "usemtl")) {
            return 0;
        }
        if (alpi_obj_word_is(key, "f") || alpi_obj_word_is(key, "fo")) {
            while (alpi_obj_take_word(&ahead).size > 0) {
                corners++;
            }
        }
        if (corners >= 3) {
            return corners;
        }
    }
    return 0;
}

/// Names the material as the next face needs it. One that no face follows stays.
static alp_result patch_usemtl(alpi_obj_patcher *p)
{
    const char *name;
    bool flat;
    const alpi_obj_word word = alpi_obj_take_rest(&p->text);
    const uint32_t corners = next_face(p);
    if (corners == 0 || p->face >= p->source->face_count) {
        p->is_named = false;
        return ALP_OK;
    }
    p->is_named = false; // a flat face does not take over the one before
    p->current = alpi_obj_use_of_face(p, p->face, corners - 2, &flat);
    p->is_named = true;
    if (p->current.material == ALPI_NONE && p->current.page == ALPI_NONE) {
        return ALP_OK; // a name that no library has, or none
    }
    ALP_TRY(find_name(p, p->current, &name));
    if (word.size == strlen(name) && memcmp(word.text, name, word.size) == 0) {
        return ALP_OK;
    }
    alpi_obj_copy_up_to(p, word.text);
    alpi_bytes_print(p->out, "%s%s", word.size == 0 ? " " : "", name);
    p->copied = word.text + word.size;
    return ALP_OK;
}

static void patch_mtllib(alpi_obj_patcher *p, const char *keyword)
{
    if (p->library_named) {
        drop_line(p, keyword);
        return;
    }
    const alpi_obj_word word = alpi_obj_take_rest(&p->text);
    alpi_obj_copy_up_to(p, word.text);
    alpi_bytes_print(p->out, "%s%s.mtl", word.size == 0 ? " " : "", alpi_path_name(p->w->stem));
    p->copied = word.text + word.size;
    p->library_named = true;
}

static alp_result patch_statement(alpi_obj_patcher *p)
{
    const char *keyword = p->text.at;
    const alpi_obj_word key = alpi_obj_take_word(&p->text);
    if (alpi_obj_word_is(key, "f") || alpi_obj_word_is(key, "fo")) {
        return alpi_obj_patch_face(p, keyword);
    }
    if (p->out == &p->run) { // the run ends
        alpi_obj_copy_up_to(p, alpi_obj_line_begin(p, keyword));
        alpi_bytes_add(&p->w->obj, p->run.bytes, p->run.size);
        p->w->obj.failed |= p->run.failed;
        p->run.size = 0;
        p->out = &p->w->obj;
    }
    if (alpi_obj_word_is(key, "vt")) {
        p->uvs_so_far++;
        if (p->replaces) {
            drop_line(p, keyword);
        }
    } else if (alpi_obj_word_is(key, "usemtl")) {
        return patch_usemtl(p);
    } else if (alpi_obj_word_is(key, "mtllib")) {
        patch_mtllib(p, keyword);
    } else if (p->replaces && alpi_obj_word_is(key, "l")) {
        ALP_TRY(alpi_obj_take_words(p)); // lines lose their coordinates
        alpi_obj_print_words(p);
    }
    return ALP_OK;
}

// --- the whole text ------------------------------------------------------------------------------

static void start_text(alpi_obj_patcher *p)
{
    const alpi_obj_file *file = &p->source->file;
    p->text = (alpi_obj_text){.context = p->w->context,
                              .path = p->w->scene->name,
                              .at = file->text,
                              .end = file->text + file->size,
                              .line = 1};
}

/// Counts what the first written statement depends on: libraries, normals and the places of vt.
static alp_result survey(alpi_obj_patcher *p)
{
    start_text(p);
    while (alpi_obj_next_line(&p->text)) {
        const char *begin = p->text.at;
        const alpi_obj_word key = alpi_obj_take_word(&p->text);
        p->has_library |= alpi_obj_word_is(key, "mtllib");
        p->normal_count += alpi_obj_word_is(key, "vn");
        if (!alpi_obj_word_is(key, "vt")) {
            continue;
        }
        void *items = p->old_uvs;
        ALP_TRY(alpi_grow(p->w->context, &items, &p->old_uv_capacity, (size_t)p->old_uv_count + 1,
                          sizeof *p->old_uvs));
        p->old_uvs = items;
        const char *end = p->text.at; // behind its last word
        while (alpi_obj_more(&p->text)) {
            (void)alpi_obj_take_word(&p->text);
            end = p->text.at;
        }
        p->old_uvs[p->old_uv_count++] = (alpi_json_span){(size_t)(begin - p->source->file.text),
                                                         (size_t)(end - p->source->file.text)};
    }
    start_text(p);
    return ALP_OK;
}

const char *alpi_obj_skip_header(const char *text, size_t size)
{
    static const char mark[] = "# Alpenglow ", state[] = "# {\"version\"";
    const char *end = text + size, *at = text;
    for (int line = 0; line < 2; line++) {
        const char *wanted = line == 0 ? mark : state;
        const size_t length = strlen(wanted);
        const char *stop = (size_t)(end - at) > length && memcmp(at, wanted, length) == 0
                               ? memchr(at, '\n', (size_t)(end - at))
                               : NULL;
        if (stop == NULL) {
            break;
        }
        at = stop + 1;
    }
    return at;
}

static alp_result patch_text(alpi_obj_patcher *p)
{
    alpi_obj_writer *w = p->w;
    ALPI_TRY_NEW(w->context, p->material_used, w->scene->material_count);
    ALP_TRY(survey(p));
    p->copied = alpi_obj_skip_header(p->source->file.text, p->source->file.size);
    if (!p->has_library) {
        alpi_bytes_print(&w->obj, "mtllib %s.mtl\n", alpi_path_name(w->stem));
    }
    while (alpi_obj_next_line(&p->text)) {
        ALP_TRY(patch_statement(p));
    }
    alpi_obj_copy_up_to(p, p->text.end);
    if (p->out == &p->run) {
        alpi_bytes_add(&w->obj, p->run.bytes, p->run.size);
    }
    if (w->obj.size > 0 && !w->obj.failed && w->obj.bytes[w->obj.size - 1] != '\n') {
        alpi_bytes_print(&w->obj, "\n");
    }
    if (p->divided > 0) {
        alpi_note(w->context, "divided-faces", w->scene->name,
                  "faces of more than three corners in several charts, written as triangles: %u",
                  p->divided);
    }
    return w->obj.failed || p->run.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

alp_result alpi_obj_patch(alpi_obj_writer *w, const alpi_obj_source *source)
{
    alpi_obj_patcher p = {.w = w,
                          .source = source,
                          .replaces = w->patch->corner_uvs != NULL,
                          .out = &w->obj,
                          .run = alpi_bytes_create(w->context),
                          .uvs = alpi_obj_names_create(w->context)};
    const alp_result result = patch_text(&p);
    void *const arrays[] = {p.old_uvs, p.material_used, p.words,   p.numbers,
                            p.keys,    p.known,         p.vertices};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        alpi_release(w->context, arrays[i]);
    }
    alpi_bytes_destroy(&p.run);
    alpi_obj_names_destroy(&p.uvs);
    return result;
}
