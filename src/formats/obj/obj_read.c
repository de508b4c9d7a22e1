// SPDX-License-Identifier: MIT
// The statements of an OBJ: v, vt, vn, f, o, g, usemtl, mtllib.
#include "formats/obj/obj.h"

#include "base/decimal.h"
#include "base/file.h"
#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { INDEX_LIMIT = 1 << 30 };

/// While statements are read.
typedef struct parser {
    alpi_obj *obj;
    alpi_obj_text text;
    alpi_obj_word object, group;
    uint32_t material; // of the last usemtl
    uint32_t surface;  // of the next face, ALPI_NONE = to be found
    alpi_obj_names keys;
    float largest_color; // component
    uint64_t lines_and_points, small_faces, unknown, bad_normals;
    char first_fault[256]; // of the normals
    char unknown_word[24];
} parser;

// --- values --------------------------------------------------------------------------------------

static alp_result too_many(const parser *p, const char *what)
{
    return alpi_fail(p->obj->context, ALP_ERROR_LIMIT,
                     "%s: line %llu: more than %d %s; split the file", p->obj->path,
                     (unsigned long long)p->text.line, INDEX_LIMIT, what);
}

/// Makes room for one more item of an array of the OBJ.
static alp_result grow(const parser *p, void **items, size_t *capacity, uint32_t count, size_t size,
                       const char *what)
{
    if (count >= INDEX_LIMIT) {
        return too_many(p, what);
    }
    return alpi_grow(p->obj->context, items, capacity, (size_t)count + 1, size);
}

/// A coordinate in double that rounds to the float nearest to its digits, also where rounding twice
/// would give the one beside it: its neighbour then.
static alp_result take_coordinate(parser *p, double *value)
{
    enum { LOST = 29 }; // bits that a double has more than a float
    alpi_obj_text again = p->text;
    uint64_t bits;
    float single = 0.0f;
    ALP_TRY(alpi_obj_take_double(&p->text, "v", value));
    memcpy(&bits, value, sizeof bits);
    if ((bits & ((1u << LOST) - 1u)) == 1u << (LOST - 1)) { // halfway between two floats
        ALP_TRY(alpi_obj_take_float(&again, "v", &single));
        if ((float)*value != single) {
            *value = nextafter(*value, (double)single);
        }
    }
    return ALP_OK;
}

/// Colours behind a position: three numbers, or four with an alpha, which is passed. One alone is a
/// weight, and so is the first of a pair. Vertices before the first coloured one are white.
static alp_result read_color(parser *p)
{
    alpi_obj *o = p->obj;
    float values[4] = {0.0f};
    int count = 0;
    while (count < 4 && alpi_obj_more(&p->text)) {
        const alpi_obj_word word = alpi_obj_take_word(&p->text);
        const char *end = word.text + word.size;
        if (alpi_decimal_float(word.text, end, &values[count]) != end || !isfinite(values[count])) {
            break;
        }
        count++;
    }
    if (count < 3 && o->colors == NULL) {
        return ALP_OK;
    }
    void *items = o->colors;
    const size_t before = o->colors == NULL ? 0 : o->position_count - 1;
    ALP_TRY(
        alpi_grow(o->context, &items, &o->color_capacity, o->position_count, sizeof *o->colors));
    o->colors = items;
    for (size_t i = before; i < o->position_count; i++) {
        o->colors[i][0] = o->colors[i][1] = o->colors[i][2] = 1.0f;
    }
    if (count >= 3) {
        memcpy(o->colors[o->position_count - 1], values, sizeof *o->colors);
    }
    for (int k = 0; k < 3 && count >= 3; k++) {
        p->largest_color = fmaxf(p->largest_color, values[k]);
    }
    return ALP_OK;
}

static alp_result read_position(parser *p)
{
    alpi_obj *o = p->obj;
    void *items = o->positions;
    ALP_TRY(grow(p, &items, &o->position_capacity, o->position_count, sizeof *o->positions,
                 "vertices"));
    o->positions = items;
    double *value = o->positions[o->position_count++];
    for (int k = 0; k < 3; k++) {
        ALP_TRY(take_coordinate(p, &value[k]));
    }
    return o->colors != NULL || alpi_obj_more(&p->text) ? read_color(p) : ALP_OK;
}

static alp_result read_normal(parser *p)
{
    alpi_obj *o = p->obj;
    void *items = o->normals;
    ALP_TRY(grow(p, &items, &o->normal_capacity, o->normal_count, sizeof *o->normals, "normals"));
    o->normals = items;
    float *value = o->normals[o->normal_count++];
    for (int k = 0; k < 3; k++) {
        if (alpi_obj_take_float(&p->text, "vn", &value[k]) != ALP_OK) {
            memset(value, 0, sizeof *o->normals); // faces name those behind it by their numbers
            if (p->bad_normals++ == 0) {
                alpi_obj_copy_fault(&p->text, p->first_fault, sizeof p->first_fault);
            }
            break;
        }
    }
    return ALP_OK;
}

static alp_result read_uv(parser *p)
{
    alpi_obj *o = p->obj;
    void *items = o->uvs;
    double v = 0.0;
    ALP_TRY(grow(p, &items, &o->uv_capacity, o->uv_count, sizeof *o->uvs, "texture coordinates"));
    o->uvs = items;
    float *value = o->uvs[o->uv_count++];
    ALP_TRY(alpi_obj_take_float(&p->text, "vt", &value[0]));
    if (alpi_obj_more(&p->text)) {
        ALP_TRY(alpi_obj_take_double(&p->text, "vt", &v));
    }
    value[1] = (float)(1.0 - v); // OBJ counts from the bottom; one rounding
    return ALP_OK;
}

// --- faces ---------------------------------------------------------------------------------------

/// One index at *at: from 1, or negative from the last one there is now. `optional`: where there is
/// none yet, it becomes ALPI_OBJ_BEFORE_FIRST.
static const char *read_index(const char *at, const char *end, uint32_t count, bool optional,
                              uint32_t *index)
{
    bool negative = at < end && *at == '-';
    uint64_t value = 0;
    const char *digits = at + negative;
    for (at = digits; at < end && (unsigned)(*at - '0') < 10; at++) {
        value = value <= INDEX_LIMIT ? value * 10 + (unsigned)(*at - '0') : value;
    }
    if (at == digits || value == 0 || value > INDEX_LIMIT) {
        return NULL;
    }
    if (negative && optional && count == 0) {
        *index = ALPI_OBJ_BEFORE_FIRST;
        return at;
    }
    if (negative && value > count) {
        return NULL;
    }
    *index = (uint32_t)(negative ? count - value : value - 1);
    return at;
}

static alp_result fail_corner(const parser *p, alpi_obj_word word)
{
    enum { SHOWN = 40 };
    return alpi_obj_fail(
        &p->text,
        "f: \"%.*s\" is no corner: it must be v, v/vt, v//vn or v/vt/vn, each from "
        "1, or negative and not before the first",
        (int)(word.size < SHOWN ? word.size : SHOWN), word.text);
}

/// v, v/vt, v//vn or v/vt/vn
static alp_result read_corner(parser *p)
{
    alpi_obj *o = p->obj;
    void *items = o->corners;
    ALP_TRY(
        grow(p, &items, &o->corner_capacity, o->corner_count, sizeof *o->corners, "face corners"));
    o->corners = items;
    const uint32_t counts[3] = {o->position_count, o->uv_count, o->normal_count};
    uint32_t *corner = o->corners[o->corner_count];
    const alpi_obj_word word = alpi_obj_take_word(&p->text);
    const char *at = word.text, *end = word.text + word.size;
    corner[1] = corner[2] = ALPI_NONE;
    for (int k = 0; at != NULL && k < 3; k++) {
        if (k != 1 || at == end || *at != '/') { // v//vn has no vt
            at = read_index(at, end, counts[k], k > 0, &corner[k]);
        }
        if (at == NULL || at == end) {
            break;
        }
        at = *at == '/' && k < 2 ? at + 1 : NULL;
        if (at == end) { // "1/" and "1//", as some write it
            break;
        }
    }
    if (at != end) {
        return fail_corner(p, word);
    }
    o->corner_count++;
    return ALP_OK;
}

/// The name of the surfaces of what comes: object, group, or both with a slash between.
static alp_result name_object(parser *p, uint32_t *number)
{
    alpi_obj_word a = p->object, b = p->group;
    bool added;
    if (b.size == 0 || (a.size == b.size && memcmp(a.text, b.text, a.size) == 0)) {
        b = a;
        a.size = 0;
    }
    if (a.size == 0) {
        return alpi_obj_names_add(&p->obj->objects, b.text, b.size, number, &added);
    }
    alpi_bytes name = alpi_bytes_create(p->obj->context);
    alpi_bytes_add(&name, a.text, a.size);
    alpi_bytes_add(&name, "/", 1);
    alpi_bytes_add(&name, b.text, b.size);
    alp_result result =
        name.failed ? ALP_ERROR_OUT_OF_MEMORY
                    : alpi_obj_names_add(&p->obj->objects, name.bytes, name.size, number, &added);
    alpi_bytes_destroy(&name);
    return result;
}

static alp_result find_surface(parser *p)
{
    alpi_obj *o = p->obj;
    alpi_obj_surface surface = {.material = p->material};
    bool added;
    ALP_TRY(name_object(p, &surface.object));
    ALP_TRY(alpi_obj_names_add(&p->keys, &surface, sizeof surface, &p->surface, &added));
    if (added) {
        void *items = o->surfaces;
        ALP_TRY(grow(p, &items, &o->surface_capacity, o->surface_count, sizeof *o->surfaces,
                     "surfaces"));
        o->surfaces = items;
        o->surfaces[o->surface_count++] = surface;
    }
    return ALP_OK;
}

static alp_result read_face(parser *p)
{
    alpi_obj *o = p->obj;
    void *items = o->faces;
    const uint32_t first = o->corner_count;
    const uint64_t line = p->text.line;
    // One more than there are faces: the next begins where this one ends.
    ALP_TRY(alpi_grow(o->context, &items, &o->face_capacity, (size_t)o->face_count + 2,
                      sizeof *o->faces));
    o->faces = items;
    while (alpi_obj_more(&p->text)) {
        ALP_TRY(read_corner(p));
    }
    if (o->corner_count - first < 3) {
        o->corner_count = first;
        p->small_faces++;
        return ALP_OK;
    }
    if (p->surface == ALPI_NONE) {
        ALP_TRY(find_surface(p));
    }
    o->faces[o->face_count++] = (alpi_obj_face){first, p->surface, (uint32_t)line};
    o->faces[o->face_count].first_corner = o->corner_count;
    return ALP_OK;
}

// --- statements ----------------------------------------------------------------------------------

/// "a/b/chair.obj" → "chair": the name of faces in no object and no group.
static alpi_obj_word file_stem(const char *path)
{
    const char *name = alpi_path_name(path), *dot = strrchr(name, '.');
    return (alpi_obj_word){name, dot != NULL && dot > name ? (size_t)(dot - name) : strlen(name)};
}

static alp_result read_name(parser *p, alpi_obj_word keyword)
{
    const alpi_obj_word name = alpi_obj_take_rest(&p->text);
    bool added;
    p->surface = ALPI_NONE;
    if (keyword.size > 1) { // usemtl
        p->material = ALPI_NONE;
        return name.size == 0 ? ALP_OK
                              : alpi_obj_names_add(&p->obj->material_names, name.text, name.size,
                                                   &p->material, &added);
    }
    if (*keyword.text == 'o') {
        p->object = name.size > 0 ? name : file_stem(p->obj->path);
        p->group.size = 0;
    } else { // "default" is what the format calls no group
        p->group = alpi_obj_word_is(name, "default") ? (alpi_obj_word){name.text, 0} : name;
    }
    return ALP_OK;
}

static alp_result read_other(parser *p, alpi_obj_word keyword)
{
    bool added;
    uint32_t number;
    if (alpi_obj_word_is(keyword, "mtllib")) {
        const alpi_obj_word name = alpi_obj_take_rest(&p->text);
        return name.size == 0
                   ? ALP_OK
                   : alpi_obj_names_add(&p->obj->libraries, name.text, name.size, &number, &added);
    }
    if (alpi_obj_word_is(keyword, "usemtl")) {
        return read_name(p, keyword);
    }
    if (alpi_obj_word_is(keyword, "l") || alpi_obj_word_is(keyword, "p")) {
        p->lines_and_points++;
    } else if (!alpi_obj_word_is(keyword, "s") && p->unknown++ == 0) {
        snprintf(p->unknown_word, sizeof p->unknown_word, "%.*s",
                 (int)(keyword.size < 20 ? keyword.size : 20), keyword.text);
        for (char *c = p->unknown_word; *c != '\0'; c++) {
            *c = (unsigned char)*c < 0x20 || (unsigned char)*c >= 0x7f ? '?' : *c;
        }
    }
    return ALP_OK;
}

static alp_result read_statement(parser *p)
{
    const alpi_obj_word keyword = alpi_obj_take_word(&p->text);
    const char first = keyword.text[0], second = keyword.size > 1 ? keyword.text[1] : '\0';
    if (first == 'v' && keyword.size == 1) {
        return read_position(p);
    }
    if (first == 'f' && (keyword.size == 1 || alpi_obj_word_is(keyword, "fo"))) {
        return read_face(p); // fo: its former name
    }
    if (first == 'v' && keyword.size == 2 && (second == 'n' || second == 't')) {
        return second == 'n' ? read_normal(p) : read_uv(p);
    }
    if ((first == 'o' || first == 'g') && keyword.size == 1) {
        return read_name(p, keyword);
    }
    return read_other(p, keyword);
}

static void report(const parser *p)
{
    alp_context *context = p->obj->context;
    const char *path = p->obj->path;
    if (p->small_faces > 0) {
        alpi_warn(context, "bad-faces", path, "%llu faces of less than three corners left out",
                  (unsigned long long)p->small_faces);
    }
    if (p->bad_normals > 0) {
        alpi_warn(context, "bad-normals", path, "%s; such normals are read as none: %llu",
                  p->first_fault, (unsigned long long)p->bad_normals);
    }
    if (p->lines_and_points > 0) {
        alpi_note(
            context, "not-triangles", path,
            "%llu statements of lines and points have no part in the bake; an .obj keeps them",
            (unsigned long long)p->lines_and_points);
    }
    if (p->unknown > 0) {
        alpi_note(context, "statements", path,
                  "%llu statements have no part in the bake, such as \"%s\": only v, vt, vn, f, o, "
                  "g, usemtl and mtllib are read; an .obj keeps them",
                  (unsigned long long)p->unknown, p->unknown_word);
    }
}

/// Colours of some programs end at 255.
static void scale_colors(const parser *p)
{
    alpi_obj *o = p->obj;
    if (o->colors == NULL || p->largest_color <= 1.0f) {
        return;
    }
    for (uint32_t i = 0; i < o->position_count; i++) {
        for (int k = 0; k < 3; k++) {
            o->colors[i][k] /= 255.0f;
        }
    }
    alpi_note(o->context, "vertex-colors", o->path,
              "colours of vertices are above 1: 255 is taken "
              "as the largest");
}

alp_result alpi_obj_parse(alp_context *context, const char *path, const char *text, size_t size,
                          alpi_obj *obj)
{
    *obj = (alpi_obj){.context = context,
                      .path = path,
                      .objects = alpi_obj_names_create(context),
                      .material_names = alpi_obj_names_create(context),
                      .libraries = alpi_obj_names_create(context),
                      .materials = alpi_obj_names_create(context)};
    parser p = {
        .obj = obj,
        .text = {.context = context, .path = path, .at = text, .end = text + size, .line = 1},
        .object = file_stem(path),
        .material = ALPI_NONE,
        .surface = ALPI_NONE,
        .keys = alpi_obj_names_create(context)};
    obj->folder = alpi_path_folder(context, path);
    alp_result result = obj->folder == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    while (result == ALP_OK && alpi_obj_next_line(&p.text)) {
        result = read_statement(&p);
    }
    alpi_obj_names_destroy(&p.keys);
    if (result == ALP_OK && obj->position_count == 0) {
        result = alpi_fail(context, ALP_ERROR_INVALID_DATA,
                           "%s: nothing to bake: it holds no vertices (lines \"v x y z\"); is it "
                           "an OBJ file?",
                           path);
    }
    if (result == ALP_OK) {
        scale_colors(&p);
        report(&p);
    }
    return result;
}

void alpi_obj_destroy(alpi_obj *obj)
{
    void *const arrays[] = {
        obj->folder,  obj->positions, obj->colors,   obj->normals,        obj->uvs,
        obj->corners, obj->faces,     obj->surfaces, obj->face_triangles, obj->triangle_corners};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        alpi_release(obj->context, arrays[i]);
    }
    alpi_obj_names_destroy(&obj->objects);
    alpi_obj_names_destroy(&obj->material_names);
    alpi_obj_names_destroy(&obj->libraries);
    alpi_obj_names_destroy(&obj->materials);
    for (uint32_t i = 0; i < obj->read_library_count; i++) {
        alpi_obj_file_destroy(obj->context, &obj->read_libraries[i]);
    }
    alpi_release(obj->context, obj->read_libraries);
    *obj = (alpi_obj){.context = obj->context};
}
