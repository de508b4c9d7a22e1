// SPDX-License-Identifier: MIT
// A scene and its bake as an OBJ: world space, an object for each surface's name, positions,
// normals and coordinates that are alike written once a surface.
#include "formats/obj/obj_write.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/random.h"
#include "formats/obj/obj_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Rows of floats of which equal ones are written once.
typedef struct rows {
    float *values;     // [count][components]
    uint32_t *numbers; // [count] which of the different ones each is
    uint32_t *firsts;  // [different] row that was the first like it
    uint32_t count, components, different;
} rows;

/// A surface while it is written.
typedef struct part {
    const alpi_surface *surface;
    rows positions, normals, uvs; // positions with colours, if there are any; uvs: [3 · triangles]
    bool has_normals;
    bool *has_uv; // [triangles]
} part;

// --- equal rows ----------------------------------------------------------------------------------

static alp_result create_rows(alp_context *context, uint32_t count, uint32_t components, rows *r)
{
    r->count = count;
    r->components = components;
    ALPI_TRY_NEW(context, r->values, (size_t)count * components);
    ALPI_TRY_NEW(context, r->numbers, count);
    ALPI_TRY_NEW(context, r->firsts, count);
    return ALP_OK;
}

static void destroy_rows(alp_context *context, rows *r)
{
    alpi_release(context, r->values);
    alpi_release(context, r->numbers);
    alpi_release(context, r->firsts);
}

/// Numbers the rows that are used: equal bits, equal number, in the order of the rows.
static alp_result number_rows(alp_context *context, const bool *used, rows *r)
{
    size_t table_size = 64, size = r->components * sizeof *r->values;
    while (table_size < 2 * (size_t)r->count) {
        table_size *= 2;
    }
    uint32_t *table = ALPI_NEW(context, uint32_t, table_size);
    if (table == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    memset(table, 0xff, table_size * sizeof *table); // ALPI_NONE
    for (uint32_t i = 0; i < r->count; i++) {
        const float *row = r->values + (size_t)i * r->components;
        if (!used[i]) {
            continue;
        }
        size_t slot = (size_t)alpi_hash64(alpi_hash_bytes(ALPI_HASH_START, row, size));
        for (slot &= table_size - 1; table[slot] != ALPI_NONE;
             slot = (slot + 1) & (table_size - 1)) {
            if (memcmp(r->values + (size_t)r->firsts[table[slot]] * r->components, row, size) ==
                0) {
                break;
            }
        }
        if (table[slot] == ALPI_NONE) {
            table[slot] = r->different;
            r->firsts[r->different++] = i;
        }
        r->numbers[i] = table[slot];
    }
    alpi_release(context, table);
    return ALP_OK;
}

// --- what a triangle gets ------------------------------------------------------------------------

/// The material and page of a triangle.
static alpi_obj_use use_of(const alpi_obj_writer *w, const alpi_surface *surface, uint32_t triangle)
{
    const uint32_t *pages = w->patch->triangle_pages;
    alpi_obj_use use = {surface->material, pages != NULL ? pages[triangle] : 0};
    if (!alpi_obj_is_occluded(w, use) && !alpi_obj_is_lit(w, use)) {
        use.page = ALPI_NONE;
    }
    return use;
}

/// Coordinates of a triangle's corners; false where it has none.
static bool find_uvs(const alpi_obj_writer *w, const alpi_surface *surface, uint32_t triangle,
                     float uvs[3][2])
{
    const bool mapped = use_of(w, surface, triangle).page != ALPI_NONE;
    if (mapped && w->patch->corner_uvs != NULL) {
        memcpy(uvs, w->patch->corner_uvs[triangle], 3 * sizeof *uvs);
        return true;
    }
    const uint32_t set = mapped ? w->patch->kept_uv_set : 0;
    if (set >= surface->uv_sets || set >= ALPI_UV_SET_LIMIT || w->scene->uvs[set] == NULL) {
        return false;
    }
    for (int k = 0; k < 3; k++) {
        memcpy(uvs[k], w->scene->uvs[set][w->scene->triangles[triangle][k]], sizeof *uvs);
    }
    return true;
}

static bool has_colors(const alp_scene *scene, const alpi_surface *s)
{
    bool white = true;
    for (uint32_t v = 0; scene->colors != NULL && white && v < s->vertex_count; v++) {
        const float *color = scene->colors[s->first_vertex + v];
        white = color[0] == 1.0f && color[1] == 1.0f && color[2] == 1.0f;
    }
    return !white;
}

/// Colours as a screen shows them, which is how readers take them.
static void fill_positions(const alp_scene *scene, const alpi_surface *s, rows *r)
{
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        float *row = r->values + (size_t)v * r->components;
        memcpy(row, scene->positions[s->first_vertex + v], sizeof(float[3]));
        for (uint32_t k = 3; k < r->components; k++) {
            row[k] = alpi_linear_to_srgb(scene->colors[s->first_vertex + v][k - 3]);
        }
    }
}

static alp_result fill_part(const alpi_obj_writer *w, part *p)
{
    const alp_scene *scene = w->scene;
    const alpi_surface *s = p->surface;
    const uint32_t vertices = s->vertex_count, triangles = s->triangle_count;
    if (triangles > UINT32_MAX / 3) {
        return alpi_fail(w->context, ALP_ERROR_LIMIT, "%s: %s: %u triangles are too many for .obj",
                         scene->name, s->name, triangles);
    }
    p->has_normals = !s->normals_generated;
    ALP_TRY(create_rows(w->context, vertices, has_colors(scene, s) ? 6 : 3, &p->positions));
    ALP_TRY(create_rows(w->context, vertices, 3, &p->normals));
    ALP_TRY(create_rows(w->context, 3 * triangles, 2, &p->uvs));
    ALPI_TRY_NEW(w->context, p->has_uv, triangles);
    bool *used = ALPI_NEW(w->context, bool, (size_t)vertices + 3 * (size_t)triangles);
    if (used == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    fill_positions(scene, s, &p->positions);
    memcpy(p->normals.values, scene->normals[s->first_vertex], vertices * sizeof(float[3]));
    for (uint32_t i = 0; i < triangles; i++) {
        const uint32_t t = s->first_triangle + i;
        float uvs[3][2];
        p->has_uv[i] = scene->triangle_usable[t] && find_uvs(w, s, t, uvs);
        for (uint32_t k = 0; k < 3 && scene->triangle_usable[t]; k++) {
            used[scene->triangles[t][k] - s->first_vertex] = true;
            used[vertices + 3 * i + k] = p->has_uv[i];
            if (p->has_uv[i]) {
                memcpy(p->uvs.values + 2 * (3 * (size_t)i + k), uvs[k], sizeof uvs[k]);
            }
        }
    }
    alp_result result = number_rows(w->context, used, &p->positions);
    if (result == ALP_OK && p->has_normals) {
        result = number_rows(w->context, used, &p->normals);
    }
    if (result == ALP_OK) {
        result = number_rows(w->context, used + vertices, &p->uvs);
    }
    alpi_release(w->context, used);
    return result;
}

static void destroy_part(alp_context *context, part *p)
{
    destroy_rows(context, &p->positions);
    destroy_rows(context, &p->normals);
    destroy_rows(context, &p->uvs);
    alpi_release(context, p->has_uv);
}

// --- text ----------------------------------------------------------------------------------------

/// A coordinate far from the origin, with as many digits as bring the scene's back: the digits that
/// its file had.
static void print_far(alpi_bytes *text, float coordinate, double origin)
{
    const double value = origin + (double)coordinate;
    int digits = 7;
    for (char number[40]; digits < 17; digits++) {
        snprintf(number, sizeof number, "%.*g", digits, value);
        if ((float)(strtod(number, NULL) - origin) == coordinate) {
            break;
        }
    }
    alpi_bytes_number(text, value, digits);
}

static void print_positions(alpi_bytes *text, const double origin[3], const rows *r)
{
    for (uint32_t i = 0; i < r->different; i++) {
        const float *row = r->values + (size_t)r->firsts[i] * r->components;
        alpi_bytes_add(text, "v", 1);
        for (uint32_t k = 0; k < r->components; k++) {
            alpi_bytes_add(text, " ", 1);
            if (k < 3 && origin[k] != 0.0) {
                print_far(text, row[k], origin[k]);
            } else if (k >= 3) {
                alpi_bytes_number(text, (double)row[k], 6); // more than 16 bits
            } else {
                alpi_bytes_float(text, row[k]);
            }
        }
        alpi_bytes_add(text, "\n", 1);
    }
}

static void print_uvs(alpi_bytes *text, const rows *r)
{
    for (uint32_t i = 0; i < r->different; i++) {
        alpi_obj_print_uv(text, r->values + (size_t)r->firsts[i] * r->components);
    }
}

static void print_normals(alpi_bytes *text, const rows *r)
{
    for (uint32_t i = 0; i < r->different; i++) {
        const float *row = r->values + (size_t)r->firsts[i] * r->components;
        alpi_bytes_add(text, "vn", 2);
        for (uint32_t k = 0; k < r->components; k++) {
            alpi_bytes_add(text, " ", 1);
            alpi_bytes_float(text, row[k]);
        }
        alpi_bytes_add(text, "\n", 1);
    }
}

static void print_triangle(alpi_obj_writer *w, const part *p, uint32_t index)
{
    char text[128];
    alpi_bytes_add(&w->obj, "f", 1);
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t corner = 3 * index + k;
        const uint32_t vertex =
            w->scene->triangles[p->surface->first_triangle + index][k] - p->surface->first_vertex;
        int length =
            snprintf(text, sizeof text, " %llu",
                     (unsigned long long)w->vertex_count + p->positions.numbers[vertex] + 1);
        if (p->has_uv[index]) {
            length += snprintf(text + length, sizeof text - (size_t)length, "/%llu",
                               (unsigned long long)w->uv_count + p->uvs.numbers[corner] + 1);
        }
        if (p->has_normals) {
            length +=
                snprintf(text + length, sizeof text - (size_t)length, "%s%llu",
                         p->has_uv[index] ? "/" : "//",
                         (unsigned long long)w->normal_count + p->normals.numbers[vertex] + 1);
        }
        alpi_bytes_add(&w->obj, text, (size_t)length);
    }
    alpi_bytes_add(&w->obj, "\n", 1);
}

/// The triangles of a surface on one page, before the first of which its material is named. *next
/// is the page after it, ALPI_NONE = none.
static alp_result print_triangles(alpi_obj_writer *w, const part *p, uint32_t page, uint32_t *next)
{
    const alpi_surface *s = p->surface;
    bool named = false;
    *next = ALPI_NONE;
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        if (!w->scene->triangle_usable[s->first_triangle + i]) {
            continue;
        }
        const alpi_obj_use use = use_of(w, s, s->first_triangle + i);
        if (use.page != page) {
            *next = use.page > page && use.page < *next ? use.page : *next;
            continue;
        }
        if (!named) {
            uint32_t number;
            ALP_TRY(alpi_obj_write_material(w, use, &number));
            alpi_bytes_print(&w->obj, "usemtl %s\n", alpi_obj_name(&w->names, number));
            named = true;
        }
        print_triangle(w, p, i);
    }
    return ALP_OK;
}

static void print_name(alpi_obj_writer *w, const char *name)
{
    const size_t start = w->obj.size + 2, size = strlen(name);
    alpi_bytes_print(&w->obj, "o %s\n", size > 0 ? name : "object");
    for (size_t i = 0; !w->obj.failed && i < size; i++) {
        uint8_t *c = &w->obj.bytes[start + i];
        const bool edge = i == 0 || i + 1 == size; // readers trim blanks there
        *c = *c < 0x20 || *c == 0x7f || (edge && strchr(" \\", *c) != NULL) ? '_' : *c;
    }
}

static alp_result write_part(alpi_obj_writer *w, part *p)
{
    ALP_TRY(fill_part(w, p));
    print_positions(&w->obj, w->scene->origin, &p->positions);
    print_uvs(&w->obj, &p->uvs);
    print_normals(&w->obj, &p->normals); // none where they were generated
    for (uint32_t page = 0, next; page != ALPI_NONE; page = next) {
        ALP_TRY(print_triangles(w, p, page, &next));
    }
    uint32_t none;
    ALP_TRY(print_triangles(w, p, ALPI_NONE, &none)); // those without a map
    w->vertex_count += p->positions.different;
    w->uv_count += p->uvs.different;
    w->normal_count += p->normals.different;
    return w->obj.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

static alp_result write_surfaces(alpi_obj_writer *w)
{
    const char *last = NULL;
    for (uint32_t s = 0; s < w->scene->surface_count; s++) {
        part p = {.surface = &w->scene->surfaces[s]};
        if (last == NULL || strcmp(last, p.surface->name) != 0) {
            print_name(w, p.surface->name);
            last = p.surface->name;
        }
        alp_result result = write_part(w, &p);
        destroy_part(w->context, &p);
        ALP_TRY(result);
    }
    return ALP_OK;
}

// --- files ---------------------------------------------------------------------------------------

static char *stem_of(alp_context *context, const char *path)
{
    return alpi_format(context, "%.*s", (int)(strlen(path) - strlen(".obj")), path);
}

/// The library and the pictures are named after the .obj, and there is no way to write some names.
static alp_result check_name(alp_context *context, const char *path)
{
    const char *name = alpi_path_name(path);
    bool odd = name[0] == ' ';
    for (const char *c = name; *c != '\0'; c++) {
        odd |= (unsigned char)*c < 0x20 || *c == 0x7f || *c == '\\';
    }
    return odd ? alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                           "%s: an .obj cannot name files whose names begin with a blank or have "
                           "line breaks or backslashes, as those beside this one would; give "
                           "another",
                           path)
               : ALP_OK;
}

static alp_result check_patch(const alp_scene *scene, const alpi_mesh_patch *patch)
{
    if (patch->vertex_values != NULL || patch->packed_count > 0 ||
        (patch->light != NULL && patch->light->form != ALPI_LIGHT_FORM_EMISSIVE)) {
        return alpi_fail(scene->context, ALP_ERROR_UNSUPPORTED,
                         "%s: an .obj holds occlusion maps and light as emission, no values at "
                         "vertices, packed images or other light maps; write .glb or .gltf",
                         scene->name);
    }
    return patch->page_count > 0 ? ALP_OK
                                 : alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                                             "%s: a patch without pages", scene->name);
}

static alp_result add_text(const alpi_obj_writer *w, const char *ending, const alpi_bytes *text,
                           alpi_output_files *files)
{
    return alpi_output_files_add(
        files, (alpi_output_file){alpi_format(w->context, "%s%s", w->stem, ending), text->bytes,
                                  text->size, NULL});
}

static bool sets_are_equal(const alp_scene *scene, uint32_t set)
{
    return set < ALPI_UV_SET_LIMIT && scene->uvs[0] != NULL && scene->uvs[set] != NULL &&
           memcmp(scene->uvs[0], scene->uvs[set], scene->vertex_count * sizeof *scene->uvs[0]) == 0;
}

/// Begins both files: the version that wrote them, and the settings of the bake.
static void print_header(alpi_obj_writer *w)
{
    alpi_bytes_print(&w->mtl, "# Alpenglow %s\n", alp_version());
    alpi_bytes_print(&w->obj, "# Alpenglow %s\n", alp_version());
    if (w->patch->extras_json != NULL) {
        alpi_bytes_print(&w->obj, "# %s\n", w->patch->extras_json);
    }
}

/// The text that the scene was read from, or all of the scene.
static alp_result write_texts(alpi_obj_writer *w)
{
    const alpi_obj_source *source = alpi_obj_source_of(w->scene);
    if (source != NULL && source->materials.count == w->scene->material_count) {
        ALP_TRY(alpi_obj_patch(w, source));
        return alpi_obj_patch_libraries(w, source);
    }
    alpi_bytes_print(&w->obj, "mtllib %s.mtl\n", alpi_path_name(w->stem));
    alpi_obj_note_scene_losses(w->scene);
    return write_surfaces(w);
}

static alp_result run(alpi_obj_writer *w, const char *path)
{
    const uint32_t pages = w->patch->page_count;
    w->stem = stem_of(w->context, path);
    if (w->stem == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    ALPI_TRY_NEW(w->context, w->images, w->scene->image_count);
    for (int kind = 0; kind < ALPI_OBJ_PICTURE_COUNT; kind++) {
        ALPI_TRY_NEW(w->context, w->image_used[kind], w->scene->image_count);
    }
    ALPI_TRY_NEW(w->context, w->texture_lost, w->scene->material_count);
    ALPI_TRY_NEW(w->context, w->page_used, pages);
    ALPI_TRY_NEW(w->context, w->light_used, pages);
    w->kept_is_first = sets_are_equal(w->scene, w->patch->kept_uv_set);
    print_header(w);
    ALP_TRY(write_texts(w));
    ALP_TRY(alpi_obj_add_images(w, w->files));
    ALP_TRY(add_text(w, ".mtl", &w->mtl, w->files));
    ALP_TRY(alpi_output_files_add(w->files, (alpi_output_file){alpi_copy_string(w->context, path),
                                                               w->obj.bytes, w->obj.size, NULL}));
    return alpi_output_files_make_folders(w->files);
}

alp_result alpi_obj_add_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                const char *path, alpi_file_set *set)
{
    alp_context *context = scene->context;
    alpi_output_files files = {.context = context};
    alpi_obj_writer w = {.context = context,
                         .scene = scene,
                         .patch = patch,
                         .obj = alpi_bytes_create(context),
                         .mtl = alpi_bytes_create(context),
                         .uses = alpi_obj_names_create(context),
                         .names = alpi_obj_names_create(context),
                         .files = &files};
    ALP_TRY(check_patch(scene, patch));
    ALP_TRY(check_name(context, path));
    ALP_TRY(alpi_file_check_writable(context, path, set->overwrite));
    alp_result result = run(&w, path);
    if (result == ALP_OK) {
        result = alpi_output_files_add_to(&files, set);
    }
    alpi_output_files_destroy(&files);
    alpi_bytes_destroy(&w.obj);
    alpi_bytes_destroy(&w.mtl);
    alpi_obj_names_destroy(&w.uses);
    alpi_obj_names_destroy(&w.names);
    for (int kind = 0; kind < ALPI_OBJ_PICTURE_COUNT; kind++) {
        alpi_release(context, w.image_used[kind]);
    }
    for (uint32_t i = 0; w.images != NULL && i < scene->image_count; i++) {
        alp_image_destroy(w.images[i]);
    }
    alpi_release(context, w.images);
    alpi_release(context, w.texture_lost);
    alpi_release(context, w.page_used);
    alpi_release(context, w.light_used);
    alpi_release(context, w.stem);
    return result;
}

// --- before the long work ------------------------------------------------------------------------

static alp_result check_file(alp_context *context, char *path, bool overwrite)
{
    alp_result result =
        path == NULL ? ALP_ERROR_OUT_OF_MEMORY : alpi_file_check_writable(context, path, overwrite);
    alpi_release(context, path);
    return result;
}

static alp_result check_files(const alp_scene *scene, const alpi_output_images *images,
                              const char *stem, bool overwrite)
{
    alp_context *context = scene->context;
    ALP_TRY(check_file(context, alpi_format(context, "%s.mtl", stem), overwrite));
    for (uint32_t p = 0; p < images->occlusion; p++) {
        ALP_TRY(
            check_file(context, alpi_obj_image_path(context, stem, "ao", p, ".png"), overwrite));
    }
    for (uint32_t p = 0; p < images->light; p++) {
        ALP_TRY(check_file(context,
                           alpi_obj_image_path(context, stem, "light", p, images->light_ending),
                           overwrite));
    }
    for (uint32_t i = 0; alpi_obj_source_of(scene) == NULL && i < scene->image_count; i++) {
        if (scene->images[i] != NULL) { // it may be written
            ALP_TRY(check_file(context, alpi_obj_image_path(context, stem, "image", i, ".png"),
                               overwrite));
        }
    }
    return ALP_OK;
}

alp_result alpi_obj_check_outputs(const alp_scene *scene, const alpi_output_images *images,
                                  const char *path, bool overwrite)
{
    alp_context *context = scene->context;
    ALP_TRY(check_name(context, path));
    ALP_TRY(alpi_file_check_writable(context, path, overwrite));
    char *stem = stem_of(context, path);
    alp_result result =
        stem == NULL ? ALP_ERROR_OUT_OF_MEMORY : check_files(scene, images, stem, overwrite);
    alpi_release(context, stem);
    return result == ALP_OK ? alpi_obj_check_copies(scene, path, overwrite) : result;
}
