// SPDX-License-Identifier: MIT
// Faces of an OBJ with new coordinates, which are written before the faces that use them first.
#include "formats/obj/obj_patch.h"

#include "base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// --- triangles of a face -------------------------------------------------------------------------

static alpi_obj_use use_of(const alpi_obj_patcher *p, uint32_t triangle)
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

alpi_obj_use alpi_obj_use_of_face(const alpi_obj_patcher *p, uint32_t face, uint32_t triangles,
                                  bool *flat)
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

static const uint32_t *corners_of(const alpi_obj_patcher *p, uint32_t triangle)
{
    static const uint32_t own[3] = {0, 1, 2};
    return p->source->triangle_corners != NULL ? p->source->triangle_corners[triangle] : own;
}

static alpi_obj_uv_key new_key(const float uv[2])
{
    alpi_obj_uv_key key = {0};
    memcpy(key.value, uv, sizeof key.value);
    return key;
}

/// New coordinates of the corners of a face. False where its triangles disagree: they lie in
/// several charts or on several pages.
static bool find_new_keys(alpi_obj_patcher *p, uint32_t face, alpi_obj_use use)
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
            const alpi_obj_uv_key key = new_key(p->w->patch->corner_uvs[t][k]);
            if (p->known[corners[k]] && memcmp(&key, &p->keys[corners[k]], sizeof key) != 0) {
                return false;
            }
            p->keys[corners[k]] = key;
            p->known[corners[k]] = true;
        }
    }
    return true;
}

static void key_uv(const alpi_obj_uv_key *key, float uv[2])
{
    memcpy(uv, key->value, sizeof key->value);
}

/// Between two corners that have coordinates, gives each the share of its way along the edge.
static void fill_between(alpi_obj_patcher *p, uint32_t before, uint32_t after)
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
static void fill_keys(alpi_obj_patcher *p)
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
static alp_result find_number(alpi_obj_patcher *p, const alpi_obj_uv_key *key, uint32_t *number)
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
static void print_corner(alpi_obj_patcher *p, alpi_obj_word word, uint32_t number)
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
static bool find_old_key(const alpi_obj_patcher *p, alpi_obj_word word, alpi_obj_uv_key *key)
{
    alpi_obj_word parts[3];
    split_word(word, parts);
    const long long value = parts[1].size > 0 ? strtoll(parts[1].text, NULL, 10) : 0;
    const long long index = value < 0 ? (long long)p->uvs_so_far + value : value - 1;
    *key = (alpi_obj_uv_key){.is_old = 1, .value = {(uint32_t)index, 0}};
    return value != 0 && index >= 0 && index < (long long)p->old_uv_count;
}

// --- faces ---------------------------------------------------------------------------------------

static alp_result grow_words(alpi_obj_patcher *p)
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

alp_result alpi_obj_take_words(alpi_obj_patcher *p)
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

void alpi_obj_print_words(alpi_obj_patcher *p)
{
    for (uint32_t i = 0; i < p->word_count; i++) {
        alpi_obj_copy_up_to(p, p->words[i].text);
        print_corner(p, p->words[i], p->numbers[i]);
        p->copied = p->words[i].text + p->words[i].size;
    }
}

/// A face whose triangles lie in several charts, as triangles.
static alp_result divide_face(alpi_obj_patcher *p, uint32_t face, const char *keyword)
{
    const uint32_t first = p->source->face_triangles[face];
    alpi_obj_copy_up_to(p, alpi_obj_line_begin(p, keyword));
    for (uint32_t i = 0; i + 2 < p->word_count; i++) {
        const uint32_t t = first + i, *corners = corners_of(p, t);
        const alpi_obj_use use = use_of(p, t);
        if (!p->w->scene->triangle_usable[t]) {
            continue;
        }
        ALP_TRY(alpi_obj_name_material(p, use));
        alpi_bytes_print(p->out, "f");
        for (int k = 0; k < 3; k++) {
            alpi_obj_uv_key key = new_key(p->w->patch->corner_uvs[t][k]);
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
static alp_result find_numbers(alpi_obj_patcher *p, alpi_obj_use use, bool flat)
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

alp_result alpi_obj_patch_face(alpi_obj_patcher *p, const char *keyword)
{
    bool flat = false;
    ALP_TRY(alpi_obj_take_words(p));
    const bool rewritten = p->replaces || p->normal_count == 0 || p->old_uv_count == 0;
    if (p->word_count < 3 || p->face >= p->source->face_count) {
        if (rewritten) {
            alpi_obj_print_words(p);
        }
        return ALP_OK;
    }
    const uint32_t face = p->face++;
    const alpi_obj_use use = alpi_obj_use_of_face(p, face, p->word_count - 2, &flat);
    if (p->out == &p->w->obj) { // the run begins
        alpi_obj_copy_up_to(p, alpi_obj_line_begin(p, keyword));
        p->out = &p->run;
    }
    if (p->replaces && use.page != ALPI_NONE && !flat && !find_new_keys(p, face, use)) {
        return divide_face(p, face, keyword);
    }
    alpi_obj_copy_up_to(p, alpi_obj_line_begin(p, keyword));
    ALP_TRY(alpi_obj_name_material(p, use));
    if (p->replaces) {
        ALP_TRY(find_numbers(p, use, flat));
    }
    if (rewritten) {
        alpi_obj_print_words(p);
    }
    return ALP_OK;
}
