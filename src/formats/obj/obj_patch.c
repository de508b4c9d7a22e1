// SPDX-License-Identifier: MIT
// The OBJ that a scene was read from, with its bake. Statements are repeated word for word. New
// coordinates take the place of vt, and are written before the faces that use them first.
#include "formats/obj/obj_write.h"

#include "base/file.h"
#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// A coordinate that is written: a new one, or an old one by its number.
typedef struct uv_key {
    uint32_t is_old;
    uint32_t value[2]; // bits of u and v; or the number and 0
} uv_key;

typedef struct patcher {
    alpi_obj_writer *w;
    const alpi_obj_source *source;
    alpi_obj_text text;
    const char *copied;      // the source up to here is written
    bool replaces;           // coordinates are new
    bool has_library;        // an mtllib stands in the text
    bool library_named;      // … and was written
    alpi_bytes *out;         // the OBJ, or `run` behind its first face
    alpi_bytes run;          // faces without other statements between them
    alpi_json_span *old_uvs; // [old_uv_count] where each vt stands
    size_t old_uv_capacity;
    uint32_t old_uv_count, uvs_so_far; // of the source; of them before `text`
    uint32_t normal_count;             // of the source
    alpi_obj_names uvs;                // uv_key as bytes: those that are written
    uint32_t face;                     // the next
    bool is_named;                     // a material was named in the output
    alpi_obj_use current;              // that one
    bool *material_used;               // [materials of the scene]
    alpi_obj_word *words;              // corners of the face
    uint32_t *numbers;                 // [words] of the coordinates, 0 = none
    uv_key *keys;                      // [words]
    bool *known;                       // [words] has a key
    uint32_t *vertices;                // [words] of the scene, of one of the triangles there
    size_t word_capacity, number_capacity, key_capacity, known_capacity, vertex_capacity;
    uint32_t word_count, divided;
} patcher;

// --- copying -------------------------------------------------------------------------------------

static void copy_up_to(patcher *p, const char *end)
{
    if (end > p->copied) {
        alpi_bytes_add(p->out, p->copied, (size_t)(end - p->copied));
        p->copied = end;
    }
}

/// Begin of the line that a statement stands on.
static const char *line_begin(const patcher *p, const char *at)
{
    while (at > p->copied && at[-1] != '\n' && at[-1] != '\r') {
        at--;
    }
    return at;
}

/// Leaves out the statement that begins at `keyword`, with its line.
static void drop_line(patcher *p, const char *keyword)
{
    copy_up_to(p, line_begin(p, keyword));
    alpi_obj_end_line(&p->text);
    p->copied = p->text.at;
}

// --- materials -----------------------------------------------------------------------------------

/// A name that neither a material of the source nor a written one has.
static alp_result choose_name(patcher *p, alpi_obj_use use, uint32_t number)
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
static alp_result find_name(patcher *p, alpi_obj_use use, const char **name)
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

/// A statement that names the material of the next face, where it is not the current one.
static alp_result name_material(patcher *p, alpi_obj_use use)
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

// --- triangles of a face -------------------------------------------------------------------------

static alpi_obj_use use_of(const patcher *p, uint32_t triangle)
{
    const alpi_obj_writer *w = p->w;
    const uint32_t *pages = w->patch->triangle_pages;
    const alpi_surface *s = &w->scene->surfaces[w->scene->triangle_surface[triangle]];
    alpi_obj_use use = {s->material, pages != NULL ? pages[triangle] : 0};
    if (!alpi_obj_is_occluded(w, use) && !alpi_obj_is_lit(w, use)) {
        use.page = ALPI_NONE;
    }
    return use;
}

/// Material and page of a face by its first triangle with area. *flat: it has none.
static alpi_obj_use use_of_face(const patcher *p, uint32_t face, uint32_t triangles, bool *flat)
{
    const uint32_t first = p->source->face_triangles[face];
    for (uint32_t i = 0; i < triangles; i++) {
        if (p->w->scene->triangle_usable[first + i]) {
            *flat = false;
            return use_of(p, first + i);
        }
    }
    *flat = true;
    alpi_obj_use use = use_of(p, first);
    if (p->is_named && p->current.material == use.material) {
        use = p->current; // no new material for what nobody sees
    }
    return use;
}

static const uint32_t *corners_of(const patcher *p, uint32_t triangle)
{
    static const uint32_t own[3] = {0, 1, 2};
    return p->source->triangle_corners != NULL ? p->source->triangle_corners[triangle] : own;
}

static uv_key new_key(const float uv[2])
{
    uv_key key = {0};
    memcpy(key.value, uv, sizeof key.value);
    return key;
}

/// New coordinates of the corners of a face. False where its triangles disagree: they lie in
/// several charts or on several pages.
static bool find_new_keys(patcher *p, uint32_t face, alpi_obj_use use)
{
    const uint32_t first = p->source->face_triangles[face];
    for (uint32_t i = 0; i + 2 < p->word_count; i++) {
        const uint32_t t = first + i, *corners = corners_of(p, t);
        for (int k = 0; k < 3; k++) {
            p->vertices[corners[k]] = p->w->scene->triangles[t][k];
        }
        if (!p->w->scene->triangle_usable[t]) {
            continue;
        }
        if (use_of(p, t).page != use.page) {
            return false;
        }
        for (int k = 0; k < 3; k++) {
            const uv_key key = new_key(p->w->patch->corner_uvs[t][k]);
            if (p->known[corners[k]] && memcmp(&key, &p->keys[corners[k]], sizeof key) != 0) {
                return false;
            }
            p->keys[corners[k]] = key;
            p->known[corners[k]] = true;
        }
    }
    return true;
}

static void key_uv(const uv_key *key, float uv[2])
{
    memcpy(uv, key->value, sizeof key->value);
}

/// Between two corners that have coordinates, gives each the share of its way along the edge.
static void fill_between(patcher *p, uint32_t before, uint32_t after)
{
    const uint32_t count = p->word_count;
    float from[2], to[2];
    key_uv(&p->keys[before], from);
    key_uv(&p->keys[after], to);
    const vec3 start = vec3_load(p->w->scene->positions[p->vertices[before]]);
    const vec3 end = vec3_load(p->w->scene->positions[p->vertices[after]]);
    for (uint32_t c = (before + 1) % count; c != after; c = (c + 1) % count) {
        const vec3 at = vec3_load(p->w->scene->positions[p->vertices[c]]);
        const float a = vec3_length(vec3_sub(at, start)), b = vec3_length(vec3_sub(at, end));
        const float share = a + b > 0.0f ? a / (a + b) : 0.0f;
        const float uv[2] = {from[0] + share * (to[0] - from[0]),
                             from[1] + share * (to[1] - from[1])};
        p->keys[c] = new_key(uv);
    }
}

/// Corners that only triangles without area have lie on an edge: their coordinates are on it too.
static void fill_keys(patcher *p)
{
    const uint32_t count = p->word_count;
    uint32_t first = 0;
    while (!p->known[first]) {
        first++;
    }
    for (uint32_t before = first, i = 1; i <= count; i++) {
        const uint32_t c = (first + i) % count;
        if (p->known[c]) {
            fill_between(p, before, c);
            before = c;
        }
    }
}

// --- coordinates ---------------------------------------------------------------------------------

/// v counted from the bottom, with as many digits as bring v back by 1 − v.
void alpi_obj_print_uv(alpi_bytes *text, const float uv[2])
{
    const double turned = 1.0 - (double)uv[1];
    int digits = 9;
    for (char number[40]; digits < 17; digits += 4) {
        snprintf(number, sizeof number, "%.*g", digits, turned);
        if ((float)(1.0 - strtod(number, NULL)) == uv[1]) { // with the sign that printed it
            break;
        }
    }
    alpi_bytes_print(text, "vt ");
    alpi_bytes_float(text, uv[0]);
    alpi_bytes_print(text, " ");
    alpi_bytes_number(text, turned, digits);
    alpi_bytes_print(text, "\n");
}

/// The number of a coordinate; it is written where it is new, before the run of faces.
static alp_result find_number(patcher *p, const uv_key *key, uint32_t *number)
{
    bool added;
    ALP_TRY(alpi_obj_names_add(&p->uvs, key, sizeof *key, number, &added));
    alpi_bytes *obj = &p->w->obj;
    if (added && key->is_old) {
        const alpi_json_span span = p->old_uvs[key->value[0]];
        alpi_bytes_add(obj, p->source->file.text + span.begin, span.end - span.begin);
        alpi_bytes_print(obj, "\n");
    } else if (added) {
        float uv[2];
        key_uv(key, uv);
        alpi_obj_print_uv(obj, uv);
    }
    ++*number; // from 1
    return ALP_OK;
}

/// The parts of "v/vt/vn"; the last two may be empty.
static void split_word(alpi_obj_word word, alpi_obj_word parts[3])
{
    const char *at = word.text, *end = word.text + word.size;
    for (int k = 0; k < 3; k++) {
        const char *slash = at < end ? memchr(at, '/', (size_t)(end - at)) : NULL;
        slash = slash == NULL || k == 2 ? end : slash;
        parts[k] = (alpi_obj_word){at, (size_t)(slash - at)};
        at = slash < end ? slash + 1 : end;
    }
}

/// A corner that was read before, with another coordinate (0 = none). Normals that the file has
/// none of are left out.
static void print_corner(patcher *p, alpi_obj_word word, uint32_t number)
{
    alpi_obj_word parts[3];
    split_word(word, parts);
    const bool normal = parts[2].size > 0 && p->normal_count > 0;
    const bool kept = !p->replaces && parts[1].size > 0 && p->old_uv_count > 0;
    alpi_bytes_add(p->out, parts[0].text, parts[0].size);
    if (number > 0) {
        alpi_bytes_print(p->out, "/%u", number);
    } else if (kept) {
        alpi_bytes_print(p->out, "/");
        alpi_bytes_add(p->out, parts[1].text, parts[1].size);
    }
    if (normal) {
        alpi_bytes_print(p->out, number > 0 || kept ? "/" : "//");
        alpi_bytes_add(p->out, parts[2].text, parts[2].size);
    }
}

/// The old coordinate of a corner: its number, from 1 or from the last one so far.
static bool find_old_key(const patcher *p, alpi_obj_word word, uv_key *key)
{
    alpi_obj_word parts[3];
    split_word(word, parts);
    const long long value = parts[1].size > 0 ? strtoll(parts[1].text, NULL, 10) : 0;
    const long long index = value < 0 ? (long long)p->uvs_so_far + value : value - 1;
    *key = (uv_key){.is_old = 1, .value = {(uint32_t)index, 0}};
    return value != 0 && index >= 0 && index < (long long)p->old_uv_count;
}

// --- faces ---------------------------------------------------------------------------------------

static alp_result grow_words(patcher *p)
{
    alp_context *context = p->w->context;
    void *words = p->words, *numbers = p->numbers, *keys = p->keys, *known = p->known;
    void *vertices = p->vertices;
    const size_t needed = (size_t)p->word_count + 1;
    ALP_TRY(alpi_grow(context, &words, &p->word_capacity, needed, sizeof *p->words));
    p->words = words;
    ALP_TRY(alpi_grow(context, &numbers, &p->number_capacity, needed, sizeof *p->numbers));
    p->numbers = numbers;
    ALP_TRY(alpi_grow(context, &keys, &p->key_capacity, needed, sizeof *p->keys));
    p->keys = keys;
    ALP_TRY(alpi_grow(context, &known, &p->known_capacity, needed, sizeof *p->known));
    p->known = known;
    ALP_TRY(alpi_grow(context, &vertices, &p->vertex_capacity, needed, sizeof *p->vertices));
    p->vertices = vertices;
    return ALP_OK;
}

static alp_result take_words(patcher *p)
{
    p->word_count = 0;
    while (alpi_obj_more(&p->text)) {
        ALP_TRY(grow_words(p));
        p->known[p->word_count] = false;
        p->numbers[p->word_count] = 0;
        p->words[p->word_count++] = alpi_obj_take_word(&p->text);
    }
    return ALP_OK;
}

/// The words of a statement with the numbers that were found for them.
static void print_words(patcher *p)
{
    for (uint32_t i = 0; i < p->word_count; i++) {
        copy_up_to(p, p->words[i].text);
        print_corner(p, p->words[i], p->numbers[i]);
        p->copied = p->words[i].text + p->words[i].size;
    }
}

/// A face whose triangles lie in several charts, as triangles.
static alp_result divide_face(patcher *p, uint32_t face, const char *keyword)
{
    const uint32_t first = p->source->face_triangles[face];
    copy_up_to(p, line_begin(p, keyword));
    for (uint32_t i = 0; i + 2 < p->word_count; i++) {
        const uint32_t t = first + i, *corners = corners_of(p, t);
        const alpi_obj_use use = use_of(p, t);
        if (!p->w->scene->triangle_usable[t]) {
            continue;
        }
        ALP_TRY(name_material(p, use));
        alpi_bytes_print(p->out, "f");
        for (int k = 0; k < 3; k++) {
            uv_key key = new_key(p->w->patch->corner_uvs[t][k]);
            uint32_t number = 0;
            if (use.page != ALPI_NONE || find_old_key(p, p->words[corners[k]], &key)) {
                ALP_TRY(find_number(p, &key, &number));
            }
            alpi_bytes_print(p->out, " ");
            print_corner(p, p->words[corners[k]], number);
        }
        alpi_bytes_print(p->out, "\n");
    }
    alpi_obj_end_line(&p->text);
    p->copied = p->text.at;
    p->divided++;
    return ALP_OK;
}

/// Coordinates of a face that stays one.
static alp_result find_numbers(patcher *p, alpi_obj_use use, bool flat)
{
    if (use.page != ALPI_NONE && !flat) {
        fill_keys(p);
    }
    for (uint32_t i = 0; i < p->word_count && !flat; i++) {
        if (use.page != ALPI_NONE || find_old_key(p, p->words[i], &p->keys[i])) {
            ALP_TRY(find_number(p, &p->keys[i], &p->numbers[i]));
        }
    }
    return ALP_OK;
}

static alp_result patch_face(patcher *p, const char *keyword)
{
    bool flat = false;
    ALP_TRY(take_words(p));
    const bool rewritten = p->replaces || p->normal_count == 0 || p->old_uv_count == 0;
    if (p->word_count < 3 || p->face >= p->source->face_count) {
        if (rewritten) {
            print_words(p);
        }
        return ALP_OK;
    }
    const uint32_t face = p->face++;
    const alpi_obj_use use = use_of_face(p, face, p->word_count - 2, &flat);
    if (p->out == &p->w->obj) { // the run begins
        copy_up_to(p, line_begin(p, keyword));
        p->out = &p->run;
    }
    if (p->replaces && use.page != ALPI_NONE && !flat && !find_new_keys(p, face, use)) {
        return divide_face(p, face, keyword);
    }
    copy_up_to(p, line_begin(p, keyword));
    ALP_TRY(name_material(p, use));
    if (p->replaces) {
        ALP_TRY(find_numbers(p, use, flat));
    }
    if (rewritten) {
        print_words(p);
    }
    return ALP_OK;
}

// --- other statements ----------------------------------------------------------------------------

/// Whether a face comes before another usemtl, and how many corners it has.
static uint32_t next_face(const patcher *p)
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
static alp_result patch_usemtl(patcher *p)
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
    p->current = use_of_face(p, p->face, corners - 2, &flat);
    p->is_named = true;
    if (p->current.material == ALPI_NONE && p->current.page == ALPI_NONE) {
        return ALP_OK; // a name that no library has, or none
    }
    ALP_TRY(find_name(p, p->current, &name));
    if (word.size == strlen(name) && memcmp(word.text, name, word.size) == 0) {
        return ALP_OK;
    }
    copy_up_to(p, word.text);
    alpi_bytes_print(p->out, "%s%s", word.size == 0 ? " " : "", name);
    p->copied = word.text + word.size;
    return ALP_OK;
}

static void patch_mtllib(patcher *p, const char *keyword)
{
    if (p->library_named) {
        drop_line(p, keyword);
        return;
    }
    const alpi_obj_word word = alpi_obj_take_rest(&p->text);
    copy_up_to(p, word.text);
    alpi_bytes_print(p->out, "%s%s.mtl", word.size == 0 ? " " : "", alpi_path_name(p->w->stem));
    p->copied = word.text + word.size;
    p->library_named = true;
}

static alp_result patch_statement(patcher *p)
{
    const char *keyword = p->text.at;
    const alpi_obj_word key = alpi_obj_take_word(&p->text);
    if (alpi_obj_word_is(key, "f") || alpi_obj_word_is(key, "fo")) {
        return patch_face(p, keyword);
    }
    if (p->out == &p->run) { // the run ends
        copy_up_to(p, line_begin(p, keyword));
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
        ALP_TRY(take_words(p)); // lines lose their coordinates
        print_words(p);
    }
    return ALP_OK;
}

// --- the whole text ------------------------------------------------------------------------------

static void start_text(patcher *p)
{
    const alpi_obj_file *file = &p->source->file;
    p->text = (alpi_obj_text){.context = p->w->context,
                              .path = p->w->scene->name,
                              .at = file->text,
                              .end = file->text + file->size,
                              .line = 1};
}

/// What must be known before the first statement is written.
static alp_result survey(patcher *p)
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

static alp_result patch_text(patcher *p)
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
    copy_up_to(p, p->text.end);
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
    patcher p = {.w = w,
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
