// SPDX-License-Identifier: MIT
// A glTF document that is baked again and again stays as it was after the first time: our sets,
// images and copies take the place of those before, and what others made or read is as it was.
#include "quad_asset.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/gltf/gltf_accessor.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ASSET "{\"version\":\"2.0\"}"
#define SCENE                                                                                      \
    "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"images\":[{\"uri\":\"data:image/"     \
    "png;base64,AA==\",\"name\":\"mine\"}],\"textures\":[{\"source\":0,\"name\":\"mine\"}],"
#define BASE(set)                                                                                  \
    "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"texCoord\":" set "}}"
#define QUAD "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},\"indices\":6,"

/// A material that reads the artist's set, one that does not, and a primitive without any.
static const char rest[] = SCENE "\"materials\":[{\"name\":\"a\"," BASE(
    "0") ",\"extras\":{\"mine\":\"x\"}},"
         "{\"name\":\"b\"}],\"meshes\":[{\"primitives\":[" QUAD "\"material\":0}," QUAD
         "\"material\":1}," QUAD "\"extras\":[]}]}]";

/// What a bake writes.
typedef struct form {
    uint32_t sets;  // 0: kept ones; 1 or 3
    uint32_t pages; // the halves of a square lie on one or on two
    bool occlusion, light, at_vertices;
    bool parts; // the halves have coordinates of their own
} form;

/// Which half of its square a triangle is, wherever it has come to stand in the file.
static uint32_t half_of(const alp_scene *scene, uint32_t t)
{
    float sums[2] = {0.0f, 0.0f};
    for (int i = 0; i < 6; i++) {
        sums[i % 2] += scene->positions[scene->triangles[t][i / 2]][i % 2];
    }
    return sums[0] > sums[1] ? 0 : 1;
}

static void fill(const alp_scene *scene, const form *f, float (*uvs)[3][3][2])
{
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        for (int i = 0; i < 9; i++) { // eighths, which are exact; of each set others
            const int k = i / 3, corner = i % 3;
            const float *p = scene->positions[scene->triangles[t][corner]];
            uvs[t][k][corner][0] = p[0] * 0.125f + 0.125f * (float)k + (f->parts ? 0.5f : 0.0f);
            uvs[t][k][corner][1] =
                p[1] * 0.125f + (f->parts ? 0.125f * (float)half_of(scene, t) : 0.0f);
        }
    }
}

enum { TRIANGLES = 6 };

/// Bakes what stands at `from`.
static void bake(alp_context *context, const char *from, const char *to, const form *f)
{
    static const uint8_t *const pngs[] = {(const uint8_t *)"xxxx", (const uint8_t *)"yyy"};
    static const size_t sizes[] = {4, 3};
    static float scales[64], values[256];
    static float uvs[TRIANGLES][3][3][2];
    float corner_uvs[TRIANGLES][3][2];
    uint32_t pages[TRIANGLES];
    alp_scene *scene = NULL;
    ASSERT_OK(context, alpi_gltf_read_scene(context, from, &scene));
    assert_int_equal(scene->triangle_count, TRIANGLES);
    assert_true(scene->material_count < 64 && scene->vertex_count <= 256);
    fill(scene, f, uvs);
    for (int i = 0; i < 256; i++) {
        values[i] = 0.5f;
        scales[i % 64] = 1.0f;
    }
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        memcpy(corner_uvs[t], uvs[t][0], sizeof corner_uvs[t]);
        pages[t] = half_of(scene, t) % f->pages;
    }
    const alpi_light_patch light = {.form = ALPI_LIGHT_FORM_MOZ,
                                    .pages = pngs,
                                    .page_sizes = sizes,
                                    .ending = ".png",
                                    .scales = scales,
                                    .units = "irradiance"};
    const alpi_mesh_patch patch = {.page_count = f->pages,
                                   .triangle_pages = pages,
                                   .corner_uvs =
                                       f->sets > 0 ? (const float(*)[3][2])corner_uvs : NULL,
                                   .set_uvs = f->sets == 3 ? (const float(*)[3][3][2])uvs : NULL,
                                   .page_pngs = f->occlusion ? pngs : NULL,
                                   .page_png_sizes = f->occlusion ? sizes : NULL,
                                   .light = f->light ? &light : NULL,
                                   .vertex_values = f->at_vertices ? values : NULL,
                                   .vertex_attribute = ALPI_VERTEX_OCCLUSION,
                                   .occlusion_strength = 1.0f,
                                   .extras_json = "{}"};
    ASSERT_OK(context, alpi_scene_write_patched(scene, &patch, to, true));
    alp_scene_destroy(scene);
}

static json_t *read(alp_context *context, const char *path, size_t *data)
{
    alpi_gltf_document *document = NULL;
    ASSERT_OK(context, alpi_gltf_document_read(context, path, &document));
    json_t *root = json_incref(document->root);
    *data = 0;
    for (size_t i = 0; i < document->buffer_count; i++) {
        *data += document->buffers[i].size;
    }
    alpi_gltf_document_destroy(document);
    return root;
}

static const char *const kinds[] = {"accessors", "bufferViews", "images",  "textures",
                                    "samplers",  "materials",   "buffers", "meshes"};
enum { KINDS = sizeof kinds / sizeof *kinds };

static void assert_same_counts(json_t *a, json_t *b)
{
    for (size_t k = 0; k < KINDS; k++) {
        assert_int_equal(json_array_size(json_object_get(a, kinds[k])),
                         json_array_size(json_object_get(b, kinds[k])));
    }
}

/// Two files with as many of everything, and the same materials and attributes.
static void assert_same(json_t *a, json_t *b)
{
    assert_same_counts(a, b);
    assert_true(json_equal(json_object_get(a, "materials"), json_object_get(b, "materials")));
    assert_true(json_equal(json_object_get(a, "meshes"), json_object_get(b, "meshes")));
}

/// What the artist made stands where it stood; accessors and views are split, and those of before
/// go.
static void assert_artists(json_t *before, json_t *after)
{
    for (size_t k = 2; k < 4; k++) {
        json_t *list = json_object_get(before, kinds[k]);
        for (size_t i = 0; i < json_array_size(list); i++) {
            json_t *now = json_array_get(json_object_get(after, kinds[k]), i);
            assert_true(json_equal(json_array_get(list, i), now));
        }
    }
    json_t *material = json_array_get(json_object_get(after, "materials"), 0);
    assert_string_equal(json_string_value(json_object_get(material, "name")), "a");
    json_t *extras = json_object_get(material, "extras");
    assert_string_equal(json_string_value(json_object_get(extras, "mine")), "x");
}

static const char *start(const char *ending, const char *members)
{
    return strcmp(ending, ".glb") == 0 ? quad_write_glb(ASSET, members)
                                       : quad_write_gltf(ASSET, members);
}

TEST_WITH_CONTEXT(stays_the_same, 1)
{
    static const form forms[] = {
        {1, 1, true, false, false, false}, {3, 1, true, false, false, false},
        {1, 2, true, false, false, true},  {3, 2, true, true, false, true},
        {1, 1, false, true, false, true},  {0, 1, true, false, false, false},
        {0, 1, false, false, true, false}, {1, 2, false, true, false, false}};
    static const char *const endings[] = {".glb", ".gltf"};
    for (size_t i = 0; i < 2 * (sizeof forms / sizeof *forms); i++) {
        const char *first = start(endings[i % 2], rest);
        size_t data, once_data = 0;
        json_t *before = read(context, first, &data), *once = NULL, *first_time = NULL;
        char *path = alpi_format(context, "%.*s again%s", (int)(strrchr(first, '.') - first), first,
                                 endings[i % 2]);
        for (int round = 0; round < 4; round++) {
            bake(context, round == 0 ? first : path, path, &forms[i / 2]);
            json_t *now = read(context, path, &data);
            assert_artists(before, now);
            // Pieces of a primitive share vertices the first time, and have sets of their own then;
            // the order of accessors is another where vertices were parted the first time.
            if (round == 1) {
                once = json_incref(now);
                once_data = data;
            }
            if (round == 1 && forms[i / 2].pages == 1) {
                assert_same_counts(first_time, now);
            }
            if (round > 1) {
                assert_same(once, now);
                assert_int_equal(data, once_data);
            }
            first_time = first_time == NULL ? json_incref(now) : first_time;
            json_decref(now);
        }
        json_decref(before);
        json_decref(once);
        json_decref(first_time);
        alpi_release(context, path);
    }
}

/// The one atlas after the other, also without words in between: from the second turn on each
/// brings back what it had. What parts vertices and primitives leaves them parted.
TEST_WITH_CONTEXT(one_after_the_other, 1)
{
    static const form turns[] = {
        {1, 1, true, false, false, true},  {3, 1, true, false, false, false},
        {1, 2, false, true, false, false}, {0, 1, false, false, true, false},
        {3, 2, true, true, false, true},   {0, 1, true, false, false, false}};
    enum { TURNS = sizeof turns / sizeof *turns };
    static const char *const endings[] = {".glb", ".gltf"};
    for (int i = 0; i < 2; i++) {
        const char *first = start(endings[i], rest);
        json_t *seen[3 * TURNS];
        size_t data[3 * TURNS], before_data;
        json_t *before = read(context, first, &before_data);
        char *path = alpi_format(context, "%.*s turns%s", (int)(strrchr(first, '.') - first), first,
                                 endings[i]);
        for (int round = 0; round < 3 * TURNS; round++) {
            bake(context, round == 0 ? first : path, path, &turns[round % TURNS]);
            seen[round] = read(context, path, &data[round]);
            assert_artists(before, seen[round]);
        }
        for (int round = 2 * TURNS; round < 3 * TURNS; round++) {
            assert_same(seen[round - TURNS], seen[round]);
            assert_int_equal(data[round - TURNS], data[round]);
        }
        for (int round = 0; round < 3 * TURNS; round++) {
            json_decref(seen[round]);
        }
        json_decref(before);
        alpi_release(context, path);
    }
}

static char *replaced(const char *text, size_t size, const char *from, const char *to)
{
    const size_t more = strlen(to), less = strlen(from);
    char *out = calloc(1, 2 * size + 1);
    assert_non_null(out);
    size_t at = 0, found = 0;
    for (size_t i = 0; i < size;) {
        if (size - i >= less && memcmp(text + i, from, less) == 0) {
            memcpy(out + at, to, more);
            at += more;
            i += less;
            found++;
        } else {
            out[at++] = text[i++];
        }
    }
    assert_true(found > 0);
    return out;
}

/// Edits a written .gltf as somebody else might.
static void change(alp_context *context, const char *path, const char *from, const char *to)
{
    size_t size;
    char *text = (char *)test_read_file(path, &size);
    char *out = replaced(text, size, from, to);
    ASSERT_OK(context, alpi_file_write(context, path, true, out, strlen(out)));
    free(out);
    free(text);
}

static double number_at(json_t *root, const char *kind, size_t index, const char *a, const char *b)
{
    json_t *item = json_array_get(json_object_get(root, kind), index);
    return json_number_value(json_object_get(json_object_get(item, a), b));
}

/// A texture of the artist's that came to read a set of ours keeps it, and a map of another bake
/// that he came to show as something else keeps its image.
TEST_WITH_CONTEXT(what_others_read_stays, 1)
{
    static const form f = {1, 1, true, false, false, false};
    static const struct {
        const char *from, *to;
        bool set_stays, image_stays;
    } cases[] = {
        {"\"name\":\"b\"", "\"name\":\"b\",\"emissiveTexture\":{\"index\":0,\"texCoord\":1}", true,
         false},
        {"\"name\":\"b\"", "\"name\":\"b\",\"emissiveTexture\":{\"index\":1}", false, true},
        {"\"name\":\"b\"",
         "\"name\":\"b\",\"extensions\":{\"EXT_who\":{\"knows\":{\"texCoord\":1}}}", true, false},
        {"\"name\":\"b\"", "\"name\":\"b\",\"extensions\":{\"EXT_who\":{\"image\":1,\"t\":1}}",
         false, true},
        {"\"extras\":[]", "\"extras\":[],\"extensions\":{\"EXT_who\":{\"a\":\"/images/1\"}}", false,
         true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *first = quad_write_gltf(ASSET, rest);
        char *path =
            alpi_format(context, "%.*s read.gltf", (int)(strrchr(first, '.') - first), first);
        bake(context, first, path, &f);
        change(context, path, cases[i].from, cases[i].to);
        for (int round = 0; round < 3; round++) {
            size_t data;
            bake(context, path, path, &f);
            json_t *now = read(context, path, &data);
            json_t *primitives =
                json_object_get(json_array_get(json_object_get(now, "meshes"), 0), "primitives");
            json_t *attributes =
                json_object_get(json_array_get(primitives, 1), "attributes"); // of material b
            const bool has_more = json_object_get(attributes, "TEXCOORD_2") != NULL;
            assert_int_equal(has_more, cases[i].set_stays);
            assert_int_equal((int)number_at(now, "materials", 1, "occlusionTexture", "texCoord"),
                             cases[i].set_stays ? 2 : 1);
            const size_t images = json_array_size(json_object_get(now, "images"));
            assert_true(cases[i].image_stays ? images >= 3 : images == 2);
            json_decref(now);
        }
        alpi_release(context, path);
    }
}

/// Copies of materials for further pages do not become copies of copies; one that somebody changed
/// stays.
TEST_WITH_CONTEXT(copies_of_materials, 1)
{
    static const form two = {1, 2, true, false, false, false},
                      one = {1, 1, true, false, false, false};
    const char *first = quad_write_gltf(ASSET, rest);
    char *path =
        alpi_format(context, "%.*s copies.gltf", (int)(strrchr(first, '.') - first), first);
    size_t data;
    bake(context, first, path, &two);
    json_t *now = read(context, path, &data);
    assert_int_equal(json_array_size(json_object_get(now, "materials")), 2 + 4); // none: two
    json_decref(now);
    bake(context, path, path, &one);
    now = read(context, path, &data);
    assert_int_equal(json_array_size(json_object_get(now, "materials")), 2 + 1);
    json_decref(now);
    bake(context, path, path, &two);
    change(context, path, "\"name\":\"b\",\"occlusionTexture\":{\"index\":2",
           "\"name\":\"b\",\"doubleSided\":true,\"occlusionTexture\":{\"index\":2");
    bake(context, path, path, &one);
    now = read(context, path, &data);
    assert_int_equal(json_array_size(json_object_get(now, "materials")), 2 + 1 + 1);
    json_decref(now);
    alpi_release(context, path);
}

/// A set without a mark stays, and its map goes once nothing reads it; the fifth set is one that
/// few read, which is told.
TEST_WITH_CONTEXT(without_marks_sets_stay, 1)
{
    static const form f = {1, 1, true, false, false, false};
    const char *first = quad_write_gltf(ASSET, rest);
    char *path = alpi_format(context, "%.*s old.gltf", (int)(strrchr(first, '.') - first), first);
    for (int round = 0; round < 4; round++) {
        size_t data;
        test_log_clear();
        bake(context, round == 0 ? first : path, path, &f);
        quad_unmark(path);
        json_t *now = read(context, path, &data);
        assert_int_equal(json_array_size(json_object_get(now, "images")), 2);
        assert_int_equal((int)number_at(now, "materials", 0, "occlusionTexture", "texCoord"),
                         1 + round);
        assert_int_equal(test_log_has("uv-sets"), round == 3);
        json_decref(now);
    }
    alpi_release(context, path);
}
