// SPDX-License-Identifier: MIT
// The libraries of an OBJ as one, word for word: a bake adds its maps at the end of a material, and
// a material with several pages is repeated. Pictures keep their paths from the OBJ, and are copied
// where it moves to another folder.
#include "formats/files/outside.h"
#include "formats/obj/obj_materials.h"
#include "formats/obj/obj_write.h"

#include "base/file.h"
#include "base/memory.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

typedef struct patcher {
    alpi_obj_writer *w;
    const alpi_obj_source *source;
    char *folder;         // of the written file, with its slash or ""
    bool moved;           // it is not that of the source
    alpi_obj_names seen;  // materials so far
    uint32_t *first_uses; // [materials of the scene] ALPI_NONE = none
    uint32_t *next_uses;  // [uses] of the same material
    const alpi_obj_file *library;
    uint32_t replaced_ambient; // map_Ka of others
} patcher;

/// A material of a library: from its newmtl to the next.
typedef struct block {
    const char *begin, *end;
    uint32_t material; // of the scene; ALPI_NONE: before the first
    bool is_repeated;  // the second of its name
} block;

/// The state of one writing of a block.
typedef struct writing {
    alpi_obj_use use;
    const char *name;   // NULL: its own
    const char *copied; // the library up to here is written
    const char *last;   // end of the last statement
    bool occluded, lit;
    bool loses_pictures;           // coordinates are new
    bool has_ambient, has_picture; // Ka; a map_Kd that stays
    bool ambient_is_occlusion;     // of an earlier bake
} writing;

// --- files ---------------------------------------------------------------------------------------

/// Copies a picture to the same path from the written file; one that cannot be read is missing
/// there too.
static alp_result copy_picture(patcher *p, const char *inner)
{
    alp_context *context = p->w->context;
    uint8_t *bytes = NULL;
    size_t size = 0;
    char *from = alpi_format(context, "%s%s", p->source->folder, inner);
    alp_result result = from == NULL ? ALP_ERROR_OUT_OF_MEMORY
                                     : alpi_file_read(context, from, UINT64_MAX, &bytes, &size);
    alpi_release(context, from);
    if (result == ALP_ERROR_IO || result == ALP_ERROR_LIMIT) {
        alpi_note(context, "missing-file", inner,
                  "a material names it, but it cannot be read: it is missing from the copy too");
        return ALP_OK;
    }
    ALP_TRY(result);
    return alpi_output_files_add_copy(p->w->files, alpi_format(context, "%s%s", p->folder, inner),
                                      bytes, size);
}

/// The path that the written library names a picture by; released by the caller.
static alp_result written_path(patcher *p, const char *inner, char **path)
{
    alp_context *context = p->w->context;
    if (p->moved && !alpi_path_stays_below(inner)) { // it is outside, and stays there
        char *full = alpi_format(context, "%s%s", inner[0] == '/' ? "" : p->source->folder, inner);
        char *real = full != NULL ? realpath(full, NULL) : NULL;
        *path = full == NULL ? NULL : alpi_copy_string(context, real != NULL ? real : inner);
        free(real);
        alpi_release(context, full);
    } else {
        *path = alpi_copy_string(context, inner);
        if (*path != NULL && p->moved) {
            ALP_TRY(copy_picture(p, inner));
        }
    }
    return *path == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

// --- statements ----------------------------------------------------------------------------------

static bool is_picture(alpi_obj_word key)
{
    static const char *const others[] = {"norm", "bump", "disp", "decal", "refl"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        if (alpi_obj_word_is(key, others[i])) {
            return true;
        }
    }
    return key.size > 4 && memcmp(key.text, "map_", 4) == 0 && !alpi_obj_word_is(key, "map_aat");
}

static void copy_up_to(patcher *p, writing *x, const char *end)
{
    if (end > x->copied) {
        alpi_bytes_add(&p->w->mtl, x->copied, (size_t)(end - x->copied));
        x->copied = end;
    }
}

static const char *line_begin(const block *b, const char *at)
{
    while (at > b->begin && at[-1] != '\n' && at[-1] != '\r') {
        at--;
    }
    return at;
}

/// Leaves out a statement, with its line.
static void drop(patcher *p, const block *b, writing *x, alpi_obj_text *t, const char *keyword)
{
    copy_up_to(p, x, line_begin(b, keyword));
    alpi_obj_end_line(t);
    x->copied = t->at;
}

/// Keeps the words of a statement as a comment: new charts take the coordinates of its picture. A
/// picture that is not there is no loss.
static alp_result comment_out(patcher *p, const block *b, writing *x, alpi_obj_text *t,
                              const char *keyword)
{
    alpi_mtl_picture picture;
    bool *lost = &p->w->texture_lost[b->material];
    copy_up_to(p, x, line_begin(b, keyword));
    alpi_bytes_print(&p->w->mtl, "# ");
    const alp_result result =
        alpi_mtl_take_picture(t, p->source->folder, p->library->folder, &picture);
    alpi_release(p->w->context, picture.path);
    if (result == ALP_OK && picture.found != ALPI_FOUND_NOTHING && !*lost) {
        alpi_warn(p->w->context, "texture-lost", p->w->scene->materials[b->material].name,
                  "its textures need the vt that new charts replace, and are comments in the .mtl; "
                  "write .glb, which holds both, or --atlas keep if the vt do not overlap");
        *lost = true;
    }
    return result == ALP_ERROR_INVALID_DATA ? ALP_OK : result;
}

/// A picture that stays, by a path that is valid from the written file.
static alp_result keep_picture(patcher *p, writing *x, alpi_obj_text *t)
{
    alpi_mtl_picture picture;
    char *path = NULL;
    alp_result result = alpi_mtl_take_picture(t, p->source->folder, p->library->folder, &picture);
    if (result == ALP_ERROR_INVALID_DATA) {
        return ALP_OK; // a bad number: the statement means nothing, and stays
    }
    if (result == ALP_OK && picture.found != ALPI_FOUND_NOTHING) {
        result = written_path(p, picture.path, &path);
    }
    if (result == ALP_OK && path != NULL &&
        (strlen(path) != picture.name.size ||
         memcmp(path, picture.name.text, picture.name.size) != 0)) {
        copy_up_to(p, x, picture.place.text);
        alpi_bytes_print(&p->w->mtl, "%s", path);
        x->copied = picture.place.text + picture.place.size;
    }
    alpi_release(p->w->context, path);
    alpi_release(p->w->context, picture.path);
    return result;
}

/// Whether our own maps take the place of a statement.
static bool is_replaced(const patcher *p, const writing *x, alpi_obj_word key)
{
    if (x->lit && (alpi_obj_word_is(key, "Kd") || alpi_obj_word_is(key, "Ke") ||
                   alpi_obj_word_is(key, "map_Kd") || alpi_obj_word_is(key, "map_Ke"))) {
        return true;
    }
    if (!x->occluded && !(x->lit && x->ambient_is_occlusion)) {
        return false;
    }
    const bool shown = x->ambient_is_occlusion && alpi_obj_word_is(key, "map_Kd") &&
                       p->w->scene->materials[x->use.material].base_color_texture.image ==
                           ALPI_NONE; // occlusion of an earlier bake
    return shown || alpi_obj_word_is(key, "map_Ka") || alpi_obj_word_is(key, "alpenglow_occlusion");
}

static alp_result write_statement(patcher *p, const block *b, writing *x, alpi_obj_text *t)
{
    const char *keyword = t->at;
    const alpi_obj_word key = alpi_obj_take_word(t);
    x->has_ambient |= alpi_obj_word_is(key, "Ka");
    if (alpi_obj_word_is(key, "newmtl")) {
        const alpi_obj_word name = alpi_obj_take_rest(t);
        if (x->name != NULL &&
            (name.size != strlen(x->name) || memcmp(name.text, x->name, name.size) != 0)) {
            copy_up_to(p, x, name.text);
            alpi_bytes_print(&p->w->mtl, "%s%s", name.size == 0 ? " " : "", x->name);
            x->copied = name.text + name.size;
        }
        return ALP_OK;
    }
    if (is_replaced(p, x, key)) {
        p->replaced_ambient += !x->ambient_is_occlusion && alpi_obj_word_is(key, "map_Ka");
        drop(p, b, x, t, keyword);
        return ALP_OK;
    }
    if (!is_picture(key)) {
        return ALP_OK;
    }
    if (x->loses_pictures && !alpi_obj_word_is(key, "refl")) {
        return comment_out(p, b, x, t, keyword);
    }
    x->has_picture |= alpi_obj_word_is(key, "map_Kd");
    return keep_picture(p, x, t);
}

/// Adds the maps of the bake.
static void write_maps(patcher *p, const writing *x)
{
    alpi_obj_writer *w = p->w;
    const uint32_t page = x->use.page;
    if (w->mtl.size > 0 && !w->mtl.failed && w->mtl.bytes[w->mtl.size - 1] != '\n') {
        alpi_bytes_print(&w->mtl, "\n");
    }
    if (x->lit) {
        alpi_bytes_print(&w->mtl, "Kd 0 0 0\nKe");
        for (int k = 0; k < 3; k++) {
            alpi_bytes_print(&w->mtl, " ");
            alpi_bytes_float(&w->mtl, w->patch->light->scales[x->use.material]);
        }
        alpi_bytes_print(&w->mtl, "\n");
        alpi_obj_print_page(w, "map_Ke", "light", page, w->patch->light->ending);
        w->light_used[page] = true;
    }
    if (x->occluded) {
        alpi_bytes_print(&w->mtl, "%salpenglow_occlusion map_Ka\n",
                         x->has_ambient ? "" : "Ka 1 1 1\n");
        alpi_obj_print_page(w, "map_Ka", "ao", page, ".png");
        w->page_used[page] = true;
    }
    if (x->occluded && !x->lit && !x->has_picture) { // most viewers know map_Kd alone
        alpi_obj_print_page(w, "map_Kd", "ao", page, ".png");
    }
}

// --- materials -----------------------------------------------------------------------------------

static alpi_obj_text text_of(const patcher *p, const block *b)
{
    return (alpi_obj_text){.context = p->w->context,
                           .path = p->w->scene->name,
                           .at = b->begin,
                           .end = b->end,
                           .line = 1};
}

static bool has_mark(const patcher *p, const block *b)
{
    alpi_obj_text t = text_of(p, b);
    bool marked = false;
    while (!marked && alpi_obj_next_line(&t)) {
        marked = alpi_obj_word_is(alpi_obj_take_word(&t), "alpenglow_occlusion");
    }
    return marked;
}

/// One writing of a material: with a page, or without. @param whole with the comments behind it
static alp_result write_block(patcher *p, const block *b, const alpi_obj_use *use, const char *name,
                              bool whole)
{
    writing x = {.name = name, .copied = b->begin, .last = b->begin};
    if (use != NULL) {
        x.use = *use;
        x.occluded = alpi_obj_is_occluded(p->w, *use);
        x.lit = alpi_obj_is_lit(p->w, *use);
        x.loses_pictures = use->page != ALPI_NONE && p->w->patch->corner_uvs != NULL;
        x.ambient_is_occlusion = has_mark(p, b);
    }
    alpi_obj_text t = text_of(p, b);
    while (alpi_obj_next_line(&t)) {
        ALP_TRY(write_statement(p, b, &x, &t));
        alpi_obj_text line = t; // to the end of the statement
        if (line.started) {
            alpi_obj_end_line(&line);
        }
        x.last = line.at;
    }
    copy_up_to(p, &x, x.last);
    if (use != NULL && use->page != ALPI_NONE) {
        write_maps(p, &x);
    }
    if (whole) {
        copy_up_to(p, &x, b->end);
    }
    return p->w->mtl.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

/// Lists the uses of each material in their order.
static alp_result list_uses(patcher *p)
{
    const alpi_obj_names *uses = &p->w->uses;
    ALPI_TRY_NEW(p->w->context, p->first_uses, p->w->scene->material_count);
    ALPI_TRY_NEW(p->w->context, p->next_uses, uses->count);
    memset(p->first_uses, 0xff, p->w->scene->material_count * sizeof *p->first_uses); // ALPI_NONE
    for (uint32_t i = uses->count; i-- > 0;) {
        alpi_obj_use use;
        memcpy(&use, alpi_obj_name(uses, i), sizeof use);
        if (use.material != ALPI_NONE) {
            p->next_uses[i] = p->first_uses[use.material];
            p->first_uses[use.material] = i;
        }
    }
    return ALP_OK;
}

static alp_result write_uses(patcher *p, const block *b)
{
    if (b->is_repeated) { // readers that take the last one would miss the bake
        return ALP_OK;
    }
    if (b->material == ALPI_NONE || p->first_uses[b->material] == ALPI_NONE) {
        return write_block(p, b, NULL, NULL, true);
    }
    const uint32_t first = p->first_uses[b->material];
    for (uint32_t i = first; i != ALPI_NONE; i = p->next_uses[i]) {
        alpi_obj_use use;
        memcpy(&use, alpi_obj_name(&p->w->uses, i), sizeof use);
        alpi_bytes_print(&p->w->mtl, "%s", i == first ? "" : "\n");
        ALP_TRY(write_block(p, b, &use, alpi_obj_name(&p->w->names, i), i == first));
    }
    return ALP_OK;
}

/// The next block of a library, which begins at `at`.
static alp_result find_block(patcher *p, const char *at, block *b)
{
    const char *end = p->library->text + p->library->size;
    *b = (block){.begin = at, .end = end, .material = ALPI_NONE};
    alpi_obj_text t = text_of(p, b);
    bool named = false;
    while (alpi_obj_next_line(&t)) {
        const char *keyword = t.at;
        if (!alpi_obj_word_is(alpi_obj_take_word(&t), "newmtl")) {
            continue;
        }
        if (named || line_begin(b, keyword) > at) {
            b->end = line_begin(b, keyword);
            break;
        }
        const alpi_obj_word name = alpi_obj_take_rest(&t);
        bool added;
        named = true;
        ALP_TRY(alpi_obj_names_add(&p->seen, name.text, name.size, &b->material, &added));
        b->is_repeated = !added;
    }
    return ALP_OK;
}

static alp_result write_library(patcher *p, const alpi_obj_file *library)
{
    p->library = library;
    const char *end = library->text + library->size;
    const char *at = alpi_obj_skip_header(library->text, library->size);
    while (at < end) {
        block b;
        ALP_TRY(find_block(p, at, &b));
        ALP_TRY(write_uses(p, &b));
        at = b.end;
    }
    if (p->w->mtl.size > 0 && !p->w->mtl.failed && p->w->mtl.bytes[p->w->mtl.size - 1] != '\n') {
        alpi_bytes_print(&p->w->mtl, "\n");
    }
    return ALP_OK;
}

/// Surfaces without a material that got a map.
static alp_result write_others(patcher *p)
{
    alpi_obj_writer *w = p->w;
    for (uint32_t i = 0; i < w->uses.count; i++) {
        alpi_obj_use use;
        memcpy(&use, alpi_obj_name(&w->uses, i), sizeof use);
        if (use.material == ALPI_NONE) {
            alpi_bytes_print(&w->mtl, "\nnewmtl %s\n", alpi_obj_name(&w->names, i));
            alpi_obj_print_material(w, use);
        }
    }
    return w->mtl.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

static alp_result start(patcher *p, const char *path)
{
    p->folder = alpi_path_folder(p->w->context, path);
    if (p->folder == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    p->moved = !alpi_same_folder(p->folder, p->source->folder);
    return ALP_OK;
}

alp_result alpi_obj_patch_libraries(alpi_obj_writer *w, const alpi_obj_source *source)
{
    patcher p = {.w = w, .source = source, .seen = alpi_obj_names_create(w->context)};
    alp_result result = start(&p, w->stem);
    if (result == ALP_OK) {
        result = list_uses(&p);
    }
    for (uint32_t i = 0; result == ALP_OK && i < source->library_count; i++) {
        result = write_library(&p, &source->libraries[i]);
    }
    if (result == ALP_OK) {
        result = write_others(&p);
    }
    if (result == ALP_OK && p.replaced_ambient > 0) {
        alpi_note(w->context, "map-ka", w->scene->name,
                  "occlusion takes the place of map_Ka of %u materials", p.replaced_ambient);
    }
    alpi_release(w->context, p.folder);
    alpi_release(w->context, p.first_uses);
    alpi_release(w->context, p.next_uses);
    alpi_obj_names_destroy(&p.seen);
    return result;
}

// --- before the long work ------------------------------------------------------------------------

/// A copy that would overwrite another file.
static alp_result check_copy(patcher *p, const char *inner, bool overwrite)
{
    alp_context *context = p->w->context;
    char *path = alpi_format(context, "%s%s", p->folder, inner);
    alp_result result = path == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    if (result == ALP_OK && access(path, F_OK) == 0) {
        result = copy_picture(p, inner); // not added where it has these bytes
        if (result == ALP_OK && p->w->files->count > 0) {
            result = alpi_file_check_writable(context, path, overwrite);
        }
        alpi_output_files_destroy(p->w->files);
    }
    alpi_release(context, path);
    return result;
}

alp_result alpi_obj_check_copies(const alp_scene *scene, const char *path, bool overwrite)
{
    const alpi_obj_source *source = alpi_obj_source_of(scene);
    if (source == NULL) {
        return ALP_OK;
    }
    alpi_output_files files = {.context = scene->context};
    alpi_obj_writer w = {.context = scene->context, .scene = scene, .files = &files};
    patcher p = {.w = &w, .source = source};
    alp_result result = start(&p, path);
    for (uint32_t i = 0; p.moved && result == ALP_OK && i < source->images.count; i++) {
        const char *inner = alpi_obj_name(&source->images, i);
        if (strchr(inner, '\n') == NULL && alpi_path_stays_below(inner)) {
            result = check_copy(&p, inner, overwrite);
        }
    }
    alpi_release(scene->context, p.folder);
    alpi_output_files_destroy(&files);
    return result;
}
