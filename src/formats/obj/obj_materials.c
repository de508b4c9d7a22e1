// SPDX-License-Identifier: MIT
// MTL files → materials: Kd, Ke, d, Tr, map_Kd, map_Ke and map_d. What only shines (Ka, Ks, Ns, …)
// has no part in diffuse light.
#include "formats/obj/obj.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "formats/files/outside.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define LIBRARY_LIMIT ((uint64_t)256 << 20) // bytes

/// While libraries are read.
typedef struct reader {
    alpi_obj *obj;
    alp_scene *scene;
    alpi_obj_names *images; // paths in the asset's folder
    alpi_obj_names names;   // of scene.materials
    alpi_obj_names read;    // paths of libraries, in the asset's folder: each is read once
    size_t capacity;        // of scene.materials
    char *folder;           // of the library, in the asset's
    bool skipping;          // a material that is there already
    bool has_color;         // the material said Kd
    bool has_emission;      // … and Ke
    bool occlusion;         // map_Ka holds occlusion (our own files say so)
    uint32_t map_d;         // image, ALPI_NONE = none
} reader;

// --- paths ---------------------------------------------------------------------------------------

/// Drops the last part of a path that ends in a slash. Where there is none it climbs out, or, where
/// that is not allowed, false.
static bool climb(char *path, size_t *size, bool outside)
{
    if (*size == 1 && path[0] == '/') {
        return outside; // nothing is above the root
    }
    const bool climbed = *size >= 3 && memcmp(path + *size - 3, "../", 3) == 0;
    if (*size == 0 || climbed) {
        memcpy(path + *size, "../", 3);
        *size += 3;
        return outside;
    }
    do {
        --*size;
    } while (*size > 0 && path[*size - 1] != '/');
    return true;
}

/// Appends the parts of a name to a path of *size bytes; false where it leaves the folder and may
/// not (`outside`).
static bool walk(char *path, size_t *size, alpi_obj_word name, bool outside)
{
    size_t at = 0;
    if (name.size == 0 || (name.text[0] == '/' && !outside) || name.text[0] == '\\' ||
        (name.size > 1 && name.text[1] == ':') || memchr(name.text, '\0', name.size) != NULL) {
        return false;
    }
    if (name.text[0] == '/') {
        path[0] = '/';
        *size = 1;
    }
    while (at < name.size) {
        size_t length = 0;
        while (at + length < name.size && name.text[at + length] != '/' &&
               name.text[at + length] != '\\') { // as Windows writes them
            length++;
        }
        const char *part = name.text + at;
        bool last = at + length >= name.size;
        at += length + 1;
        if (length == 2 && part[0] == '.' && part[1] == '.') {
            if (!climb(path, size, outside)) {
                return false;
            }
        } else if (length > 0 && !(length == 1 && part[0] == '.')) {
            memcpy(path + *size, part, length);
            *size += length;
            path[*size] = '/';
            *size += !last;
        }
    }
    path[*size] = '\0';
    return *size > 0 && path[*size - 1] != '/';
}

alp_result alpi_obj_resolve(alp_context *context, const char *folder, alpi_obj_word name,
                            char **path)
{
    size_t size = strlen(folder);
    *path = ALPI_NEW(context, char, size + name.size + 4); // a slash that ".." lacks, and 0
    if (*path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    memcpy(*path, folder, size);
    if (!walk(*path, &size, name, alpi_context_options(context)->read_outside)) {
        alpi_release(context, *path);
        *path = NULL;
    }
    return ALP_OK;
}

char *alpi_obj_path(const alpi_obj *obj, const char *inner)
{
    return alpi_format(obj->context, "%s%s", inner[0] == '/' ? "" : obj->folder, inner);
}

/// A copy of a word for messages, without control characters.
static void show(alpi_obj_word word, char text[128])
{
    snprintf(text, 128, "%.*s", (int)(word.size < 120 ? word.size : 120), word.text);
    for (char *c = text; *c != '\0'; c++) {
        *c = (unsigned char)*c < 0x20 || *c == 0x7f ? '?' : *c;
    }
}

// --- textures ------------------------------------------------------------------------------------

static bool word_is_number(alpi_obj_word word)
{
    return word.size > 0 &&
           (word.text[0] == '-' || word.text[0] == '+' || word.text[0] == '.' ||
            (unsigned)(word.text[0] - '0') < 10) &&
           !(word.text[0] == '-' && (word.size == 1 || (word.text[1] | 0x20) >= 'a'));
}

/// Takes one to three numbers of an option; those that are not there stay.
static alp_result take_numbers(alpi_obj_text *t, const char *what, float values[3])
{
    for (int k = 0; k < 3 && alpi_obj_more(t); k++) {
        alpi_obj_text ahead = *t;
        if (!word_is_number(alpi_obj_take_word(&ahead))) {
            break;
        }
        ALP_TRY(alpi_obj_take_float(t, what, &values[k]));
    }
    return ALP_OK;
}

/// Options before the file's name: -s, -o and -clamp count, others are passed.
static alp_result take_options(alpi_obj_text *t, alpi_texture *texture)
{
    static const struct {
        const char *name;
        int words;
    } others[] = {{"-blendu", 1}, {"-blendv", 1}, {"-cc", 1},      {"-mm", 2},  {"-bm", 1},
                  {"-boost", 1},  {"-texres", 1}, {"-imfchan", 1}, {"-type", 1}};
    float scale[3] = {1.0f, 1.0f, 1.0f}, offset[3] = {0.0f, 0.0f, 0.0f}, turbulence[3];
    while (alpi_obj_more(t) && *t->at == '-') {
        const alpi_obj_text start = *t;
        const alpi_obj_word option = alpi_obj_take_word(t);
        size_t other = 0;
        while (other < sizeof others / sizeof *others &&
               !alpi_obj_word_is(option, others[other].name)) {
            other++;
        }
        if (alpi_obj_word_is(option, "-s")) {
            ALP_TRY(take_numbers(t, "-s", scale));
        } else if (alpi_obj_word_is(option, "-o")) {
            ALP_TRY(take_numbers(t, "-o", offset));
        } else if (alpi_obj_word_is(option, "-t")) {
            ALP_TRY(take_numbers(t, "-t", turbulence));
        } else if (alpi_obj_word_is(option, "-clamp")) {
            bool on = alpi_obj_word_is(alpi_obj_take_word(t), "on");
            texture->wrap_u = texture->wrap_v = on ? ALPI_WRAP_CLAMP : ALPI_WRAP_REPEAT;
        } else if (other < sizeof others / sizeof *others) {
            for (int i = 0; i < others[other].words; i++) {
                (void)alpi_obj_take_word(t);
            }
        } else { // the file's name begins so
            *t = start;
            break;
        }
    }
    // The file says w = o + s·w of w = 1 − v; ours is v' = 1 − o − s + s·v.
    texture->scale[0] = scale[0];
    texture->offset[0] = offset[0];
    texture->scale[1] = scale[1];
    texture->offset[1] = 1.0f - offset[1] - scale[1];
    return ALP_OK;
}

/// The texture of a statement; lost where the file that it names is outside.
static alp_result find_texture(reader *r, alpi_obj_text *t, alpi_texture *texture, char shown[128])
{
    char *path = NULL;
    bool added;
    *texture = alpi_texture_none();
    ALP_TRY(take_options(t, texture));
    const alpi_obj_word name = alpi_obj_take_rest(t);
    if (name.size == 0) {
        return ALP_OK;
    }
    show(name, shown);
    ALP_TRY(alpi_obj_resolve(r->obj->context, r->folder, name, &path));
    if (path == NULL) {
        texture->lost = true;
        return ALP_OK;
    }
    alp_result result = alpi_obj_names_add(r->images, path, strlen(path), &texture->image, &added);
    alpi_release(r->obj->context, path);
    return result;
}

static alp_result read_texture(reader *r, alpi_obj_text *t, const char *what, alpi_texture *texture)
{
    char shown[128];
    ALP_TRY(find_texture(r, t, texture, shown));
    if (texture->lost) {
        alpi_warn(r->obj->context, "image", r->scene->materials[r->scene->material_count - 1].name,
                  "%s: line %llu: \"%s\" leaves the asset's folder; " ALPI_OUTSIDE_HINT ": "
                  "the colour of %s is used alone",
                  t->path, (unsigned long long)t->line, shown, what + 4);
    }
    return ALP_OK;
}

// --- statements ----------------------------------------------------------------------------------

/// What the statements of a material say together.
static void finish_material(reader *r)
{
    if (r->skipping || r->scene->material_count == 0) {
        return;
    }
    alpi_material *m = &r->scene->materials[r->scene->material_count - 1];
    if (r->occlusion && m->base_color_texture.image == m->occlusion_texture.image) {
        m->base_color_texture = alpi_texture_none(); // we put it there, for viewers to show
    } else if (!r->occlusion) {
        m->occlusion_texture = alpi_texture_none(); // map_Ka alone means something else
    }
    if (!r->has_color && m->base_color_texture.image == ALPI_NONE) {
        m->base_color[0] = m->base_color[1] = m->base_color[2] = 0.5f; // as without a material
    }
    if (!r->has_emission && m->emission_texture.image != ALPI_NONE) {
        m->emission[0] = m->emission[1] = m->emission[2] = 1.0f; // else its picture means nothing
    }
    if (m->base_color[3] < 1.0f) {
        m->alpha_mode = ALPI_ALPHA_BLEND;
    } else if (r->map_d != ALPI_NONE && r->map_d == m->base_color_texture.image) {
        m->alpha_mode = ALPI_ALPHA_MASK;
        m->alpha_cutoff = 0.5f;
    } else if (r->map_d != ALPI_NONE) {
        alpi_note(r->obj->context, "map-d", m->name,
                  "map_d is read only if it is the file of map_Kd, as its alpha; this material "
                  "is read as opaque");
    }
    r->map_d = ALPI_NONE;
}

static alp_result start_material(reader *r, alpi_obj_text *t)
{
    alp_scene *s = r->scene;
    const alpi_obj_word name = alpi_obj_take_rest(t);
    uint32_t number;
    bool added;
    finish_material(r);
    ALP_TRY(alpi_obj_names_add(&r->names, name.text, name.size, &number, &added));
    r->skipping = !added;
    r->has_color = r->has_emission = r->occlusion = false;
    r->map_d = ALPI_NONE;
    if (!added) {
        alpi_note(r->obj->context, "material", alpi_obj_name(&r->names, number),
                  "%s: line %llu: there is a material of this name already, which is used", t->path,
                  (unsigned long long)t->line);
        return ALP_OK;
    }
    void *items = s->materials;
    ALP_TRY(alpi_grow(r->obj->context, &items, &r->capacity, (size_t)s->material_count + 1,
                      sizeof *s->materials));
    s->materials = items;
    alpi_material *m = &s->materials[s->material_count];
    *m = alpi_material_default();
    m->name = alpi_copy_string(r->obj->context, alpi_obj_name(&r->names, number));
    if (m->name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    s->material_count++;
    for (char *c = m->name; *c != '\0'; c++) {
        *c = (unsigned char)*c < 0x20 || *c == 0x7f ? '?' : *c;
    }
    return ALP_OK;
}

/// Three numbers, or one that stands for all. A spectrum file and CIE XYZ are not read.
static alp_result read_color(reader *r, alpi_obj_text *t, const char *what, float color[3])
{
    alpi_obj_text ahead = *t;
    if (!word_is_number(alpi_obj_take_word(&ahead))) {
        alpi_note(r->obj->context, "color", r->scene->materials[r->scene->material_count - 1].name,
                  "%s: line %llu: %s is read as red, green and blue only", t->path,
                  (unsigned long long)t->line, what);
        return ALP_OK;
    }
    ALP_TRY(alpi_obj_take_float(t, what, &color[0]));
    color[1] = color[2] = color[0];
    for (int k = 1; k < 3 && alpi_obj_more(t); k++) {
        ALP_TRY(alpi_obj_take_float(t, what, &color[k]));
    }
    return ALP_OK;
}

static alp_result read_opacity(alpi_obj_text *t, bool inverse, float *alpha)
{
    float value = 1.0f;
    if (alpi_obj_more(t) && !word_is_number((alpi_obj_word){t->at, 1})) {
        (void)alpi_obj_take_word(t); // -halo
    }
    ALP_TRY(alpi_obj_take_float(t, inverse ? "Tr" : "d", &value));
    *alpha = inverse ? 1.0f - value : value;
    return ALP_OK;
}

static alp_result read_statement(reader *r, alpi_obj_text *t)
{
    const alpi_obj_word key = alpi_obj_take_word(t);
    if (alpi_obj_word_is(key, "newmtl")) {
        return start_material(r, t);
    }
    if (r->scene->material_count == 0 || r->skipping) {
        return ALP_OK;
    }
    alpi_material *m = &r->scene->materials[r->scene->material_count - 1];
    if (alpi_obj_word_is(key, "Kd")) {
        r->has_color = true;
        return read_color(r, t, "Kd", m->base_color);
    }
    if (alpi_obj_word_is(key, "Ke")) {
        r->has_emission = true;
        return read_color(r, t, "Ke", m->emission);
    }
    if (alpi_obj_word_is(key, "d") || alpi_obj_word_is(key, "Tr")) {
        return read_opacity(t, key.size == 2, &m->base_color[3]);
    }
    if (alpi_obj_word_is(key, "map_Kd")) {
        return read_texture(r, t, "map_Kd", &m->base_color_texture);
    }
    if (alpi_obj_word_is(key, "map_Ke")) {
        return read_texture(r, t, "map_Ke", &m->emission_texture);
    }
    if (alpi_obj_word_is(key, "map_Ka") && r->occlusion) {
        return read_texture(r, t, "map_Ka", &m->occlusion_texture);
    }
    if (alpi_obj_word_is(key,
                         "norm")) { // map_Bump may be heights or normals, which it does not say
        char shown[128];
        return find_texture(r, t, &m->normal_texture, shown);
    }
    if (alpi_obj_word_is(key, "map_d")) {
        alpi_texture texture;
        ALP_TRY(read_texture(r, t, "map_d", &texture));
        r->map_d = texture.image;
    }
    r->occlusion = r->occlusion || alpi_obj_word_is(key, "alpenglow_occlusion");
    return ALP_OK;
}

// --- libraries -----------------------------------------------------------------------------------

static alp_result read_library(reader *r, const char *path, const char *inner)
{
    alp_context *context = r->obj->context;
    uint8_t *bytes = NULL;
    size_t size = 0;
    ALP_TRY(alpi_file_read(context, path, LIBRARY_LIMIT, &bytes, &size));
    r->obj->hash = alpi_hash_bytes(r->obj->hash, bytes, size);
    const size_t mark = size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    alpi_obj_text text = {.context = context,
                          .path = path,
                          .at = (const char *)bytes + mark,
                          .end = (const char *)bytes + size,
                          .line = 1};
    r->folder = alpi_path_folder(context, inner);
    r->skipping = true; // until its first newmtl
    alp_result result = r->folder == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    while (result == ALP_OK && alpi_obj_next_line(&text)) {
        result = read_statement(r, &text);
    }
    if (result == ALP_OK) {
        finish_material(r);
    }
    alpi_release(context, r->folder);
    alpi_release(context, bytes);
    r->folder = NULL;
    return result;
}

/// One library; what cannot be read costs a warning. @param only_try nothing where it is not there
static alp_result try_library(reader *r, alpi_obj_word name, bool only_try, bool *found)
{
    alp_context *context = r->obj->context;
    char *inner = NULL, *path = NULL, shown[128], reason[512];
    *found = false;
    show(name, shown);
    ALP_TRY(alpi_obj_resolve(context, "", name, &inner));
    if (inner != NULL) {
        path = alpi_obj_path(r->obj, inner);
        if (path == NULL) {
            alpi_release(context, inner);
            return ALP_ERROR_OUT_OF_MEMORY;
        }
    }
    alp_result result = ALP_OK;
    if (path != NULL && access(path, F_OK) == 0) {
        uint32_t number;
        bool added = false;
        *found = true;
        result = alpi_obj_names_add(&r->read, inner, strlen(inner), &number, &added);
        if (result == ALP_OK && added) {
            result = read_library(r, path, inner);
        }
    }
    if (result == ALP_ERROR_IO || result == ALP_ERROR_LIMIT) {
        snprintf(reason, sizeof reason, "%s", alp_context_message(context));
        alpi_warn(context, "mtllib", shown, "%s; its materials are missing", reason);
        result = ALP_OK;
    } else if (result == ALP_OK && !*found && !only_try) {
        alpi_warn(context, "mtllib", shown,
                  path == NULL ? "leaves the asset's folder; " ALPI_OUTSIDE_HINT
                                 ": its materials are missing"
                               : "is not there: its materials are missing");
    }
    alpi_release(context, inner);
    alpi_release(context, path);
    return result;
}

/// The names of a line: one that has spaces, or several between spaces.
static alp_result read_libraries(reader *r, const char *line)
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
static alp_result match_names(reader *r, uint32_t **materials)
{
    const alpi_obj_names *used = &r->obj->material_names;
    ALPI_TRY_NEW(r->obj->context, *materials, used->count);
    for (uint32_t i = 0; i < used->count; i++) {
        const char *name = alpi_obj_name(used, i);
        (*materials)[i] = alpi_obj_names_find(&r->names, name, used->sizes[i]);
        if ((*materials)[i] == ALPI_NONE) {
            char shown[128];
            show((alpi_obj_word){name, used->sizes[i]}, shown);
            alpi_warn(r->obj->context, "material", shown,
                      "is in no material library: its surfaces are read as grey (albedo 0.5)");
        }
    }
    return ALP_OK;
}

alp_result alpi_obj_read_materials(alpi_obj *obj, alp_scene *scene, alpi_obj_names *images,
                                   uint32_t **scene_materials)
{
    reader r = {.obj = obj,
                .scene = scene,
                .images = images,
                .names = alpi_obj_names_create(obj->context),
                .read = alpi_obj_names_create(obj->context),
                .skipping = true,
                .map_d = ALPI_NONE};
    alp_result result = ALP_OK;
    *scene_materials = NULL;
    for (uint32_t i = 0; result == ALP_OK && i < obj->libraries.count; i++) {
        result = read_libraries(&r, alpi_obj_name(&obj->libraries, i));
    }
    if (result == ALP_OK) {
        result = match_names(&r, scene_materials);
    }
    alpi_obj_names_destroy(&r.names);
    alpi_obj_names_destroy(&r.read);
    return result;
}
