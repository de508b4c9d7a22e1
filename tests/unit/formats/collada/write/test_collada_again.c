// SPDX-License-Identifier: MIT
// A COLLADA document that is baked again and again stays as it was after the first time: our sets,
// images and copies take the place of those before, and what the artist made is as it was.
#include "test_collada.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/formats.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BIND                                                                                       \
    "<bind_material><technique_common><instance_material symbol='S' target='#m'/>"                 \
    "<instance_material symbol='T' target='#n'/></technique_common></bind_material>"
#define POLYLIST(symbol, inputs, corners)                                                          \
    "<polylist material='" symbol "' count='1'>" inputs TEST_COLLADA_INPUT "<vcount>4</vcount><p>" \
    "" corners "</p></polylist>"
#define EFFECT                                                                                     \
    "<effect id='e'><profile_COMMON><technique sid='t'><lambert><diffuse><color>1 0 0 1</color>"   \
    "</diffuse></lambert></technique></profile_COMMON></effect>"
#define ARTISTS_SET                                                                                \
    "<source id='t'><float_array id='ta' count='4'>0 0 1 1</float_array><technique_common>"        \
    "<accessor source='#ta' count='2' stride='2'><param name='S'/><param name='T'/></accessor>"    \
    "</technique_common></source>"
#define ARTISTS_INPUT "<input semantic='TEXCOORD' source='#t' offset='1' set='0'/>"

/// Two squares of two materials, which share an effect, shown at two places.
static const char inside[] =
    "<library_effects>" EFFECT "</library_effects>"
    "<library_materials><material id='m'><instance_effect url='#e'/></material>"
    "<material id='n'><instance_effect url='#e'/></material></library_materials>" TEST_COLLADA_MESH(
        "0 0 0 1 0 0 1 1 0 0 1 0 2 0 0 3 0 0 3 1 0 2 1 0", "24", "8",
        ARTISTS_SET POLYLIST("S", ARTISTS_INPUT, "0 0 1 1 2 0 3 1")
            POLYLIST("T", ARTISTS_INPUT,
                     "4 0 5 1 6 0 7 "
                     "1")) "<library_visual_scenes><visual_scene id='s'><node><instance_geometry "
                           "url='#g'>" BIND "</instance_geometry></node><node><translate>0 5 0"
                           "</translate><instance_geometry url='#g'>" BIND
                           "</instance_geometry></node></visual_scene></"
                           "library_visual_scenes>" TEST_COLLADA_SCENE;

/// What a bake writes.
typedef struct form {
    uint32_t sets;        // 1 or 3
    uint32_t pages, each; // triangle t lies on page t / each % pages
    bool ao, light;
    bool second_is_left_out; // of the materials
} form;

enum { TRIANGLES = 8 };

static void fill_uvs(const alp_scene *scene, float (*uvs)[3][3][2])
{
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        for (int i = 0; i < 9; i++) { // eighths, which are exact; of each set others
            const int k = i / 3, corner = i % 3;
            const float *p = scene->positions[scene->triangles[t][corner]];
            uvs[t][k][corner][0] = p[0] * 0.125f + 0.125f * (float)k;
            uvs[t][k][corner][1] = p[1] * 0.125f;
        }
    }
}

/// Bakes what stands at `path` and gives its new text.
static char *bake(alp_context *context, const char *path, const form *f, float (*uvs)[3][3][2])
{
    static const uint8_t *const pngs[] = {(const uint8_t *)"x", (const uint8_t *)"y"};
    static const size_t sizes[] = {1, 1};
    static const float scales[] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    float corner_uvs[TRIANGLES][3][2];
    uint32_t pages[TRIANGLES];
    alp_scene *scene = test_load(context, path);
    assert_int_equal(scene->triangle_count, TRIANGLES);
    fill_uvs(scene, uvs);
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        memcpy(corner_uvs[t], uvs[t][0], sizeof corner_uvs[t]);
        const float *p = scene->positions[scene->triangles[t][0]];
        pages[t] = f->second_is_left_out && p[0] >= 2.0f ? ALPI_NONE : t / f->each % f->pages;
    }
    const alpi_light_patch light = {
        .pages = pngs, .page_sizes = sizes, .ending = ".png", .scales = scales, .units = "nit"};
    const alpi_mesh_patch patch = {.page_count = f->pages,
                                   .triangle_pages = pages,
                                   .corner_uvs = (const float(*)[3][2])corner_uvs,
                                   .set_uvs = f->sets == 3 ? (const float(*)[3][3][2])uvs : NULL,
                                   .page_pngs = f->ao ? pngs : NULL,
                                   .page_png_sizes = f->ao ? sizes : NULL,
                                   .light = f->light ? &light : NULL,
                                   .extras_json = "{}"};
    ASSERT_OK(context, alpi_scene_write_patched(scene, &patch, path, true));
    alp_scene_destroy(scene);
    size_t size;
    return (char *)test_read_file(path, &size);
}

static void start(alp_context *context, const char *path)
{
    size_t size;
    char *text = test_collada_text(inside, &size);
    ASSERT_OK(context, alpi_file_write(context, path, true, text, size));
    free(text);
}

static uint32_t count(const char *text, const char *word)
{
    uint32_t found = 0;
    for (; (text = strstr(text, word)) != NULL; text++) {
        found++;
    }
    return found;
}

/// What has an id of ours is named somewhere, and nothing is named that is not there.
static void assert_all_named(alp_context *context, const char *text)
{
    static const char *const kinds[] = {"<source id=\"", "<image id=\"", "<effect id=\"",
                                        "<material id=\""};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        const char *at = text;
        while ((at = strstr(at, kinds[k])) != NULL) {
            at += strlen(kinds[k]);
            char *url = alpi_format(context, "#%.*s\"", (int)strcspn(at, "\""), at);
            char *word = alpi_format(context, ">%.*s<", (int)strcspn(at, "\""), at);
            const bool ours = strncmp(at, "alpenglow", 9) == 0;
            assert_true(!ours || strstr(text, url) != NULL || strstr(text, word) != NULL);
            alpi_release(context, url);
            alpi_release(context, word);
        }
    }
    for (const char *at = text; (at = strstr(at, "=\"#")) != NULL; at++) {
        char *id = alpi_format(context, " id=\"%.*s\"", (int)strcspn(at + 3, "\""), at + 3);
        assert_non_null(strstr(text, id));
        alpi_release(context, id);
    }
}

/// The artist's set is where it was, and ours are the last.
static void assert_coordinates(alp_context *context, const char *path, const form *f,
                               float (*uvs)[3][3][2])
{
    alp_scene *scene = test_load(context, path);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const alpi_surface *surface = &scene->surfaces[scene->triangle_surface[t]];
        const bool left_out =
            f->second_is_left_out && scene->positions[scene->triangles[t][0]][0] >= 2.0f;
        assert_int_equal(surface->uv_sets, left_out ? 1 : 1 + f->sets);
        for (uint32_t i = 0; !left_out && i < 6 * f->sets; i++) {
            const uint32_t k = i / 6, corner = i % 6 / 2, axis = i % 2;
            const uint32_t v = scene->triangles[t][corner];
            ASSERT_NEAR(scene->uvs[1 + k][v][axis], uvs[t][k][corner][axis], 0.0);
        }
    }
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(stays_the_same, 1)
{
    static const form forms[] = {{1, 1, 1, true, false, false}, {3, 1, 1, true, false, false},
                                 {1, 1, 1, false, true, false}, {3, 1, 1, false, true, false},
                                 {3, 1, 1, true, true, false},  {1, 2, 1, true, true, false},
                                 {3, 2, 1, true, true, false},  {3, 2, 2, false, true, false},
                                 {3, 1, 1, true, false, true},  {1, 1, 1, true, true, true}};
    static float uvs[TRIANGLES][3][3][2];
    char *path = alpi_format(context, "%s/same.dae", test_folder());
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        const form *f = &forms[i];
        char *last = NULL;
        start(context, path);
        for (int round = 0; round < 3; round++) {
            char *text = bake(context, path, f, uvs);
            assert_coordinates(context, path, f, uvs);
            assert_all_named(context, text);
            assert_non_null(strstr(text, "<material id=\"n\"><instance_effect url=\"#e\"/>"));
            if (last != NULL) {
                assert_string_equal(text, last);
            }
            free(last);
            last = text;
        }
        free(last);
    }
    alpi_release(context, path);
}

/// The one atlas after the other: each brings back what it had before. Where their pages differ
/// too, primitives stay parted as both want it, and so the second time tells.
TEST_WITH_CONTEXT(one_after_the_other, 1)
{
    static const form turns[2][2] = {
        {{1, 1, 1, true, true, false}, {3, 1, 1, true, true, false}},
        {{1, 2, 1, true, true, false}, {3, 2, 2, true, true, false}},
    };
    static float uvs[TRIANGLES][3][3][2];
    char *path = alpi_format(context, "%s/turns.dae", test_folder());
    for (int i = 0; i < 2; i++) {
        char *texts[6];
        start(context, path);
        for (int round = 0; round < 6; round++) {
            const form *f = &turns[i][round % 2];
            texts[round] = bake(context, path, f, uvs);
            assert_coordinates(context, path, f, uvs);
            assert_all_named(context, texts[round]);
        }
        const int known = i == 0 ? 0 : 2;
        assert_string_equal(texts[known + 2], texts[known]);
        assert_string_equal(texts[known + 3], texts[known + 1]);
        for (int round = 0; round < 6; round++) {
            free(texts[round]);
        }
    }
    alpi_release(context, path);
}

/// Copies of materials whose pages are parted anew go, with what they hold; those of the artist
/// stay though nobody shows them.
TEST_WITH_CONTEXT(old_copies_go, 1)
{
    static const form first = {1, 1, 1, true, true, false}, second = {1, 2, 1, true, true, false};
    static float uvs[TRIANGLES][3][3][2];
    char *path = alpi_format(context, "%s/copies.dae", test_folder());
    start(context, path);
    char *text = bake(context, path, &first, uvs);
    assert_int_equal(count(text, "<material "), 2 + 2); // m and n share an effect: each a copy
    free(text);
    text = bake(context, path, &second, uvs);
    assert_all_named(context, text);
    assert_int_equal(count(text, "<material "), 2 + 4);
    assert_int_equal(count(text, "<effect "), 1 + 4);
    assert_int_equal(count(text, "<image "), 4); // of two pages, occlusion and light
    assert_int_equal(count(text, "<emission_strength>"), 4);
    assert_int_equal(count(text, "<newparam "), 4 * 4); // surface and sampler of both
    assert_non_null(strstr(text, "<color>1 0 0 1</color>"));
    free(text);
    alpi_release(context, path);
}

/// A file name that looks like an id of ours stays what it is.
TEST_WITH_CONTEXT(names_like_ours, 1)
{
    static const form f = {1, 1, 1, true, false, false};
    static float uvs[TRIANGLES][3][3][2];
    char *path = alpi_format(context, "%s/alpenglow2-room.dae", test_folder());
    start(context, path);
    for (int round = 0; round < 3; round++) {
        char *text = bake(context, path, &f, uvs);
        assert_non_null(strstr(text, "<image id=\"alpenglow-ao-0\""));
        assert_non_null(strstr(text, ">alpenglow2-room.ao.png<"));
        free(text);
    }
    alpi_release(context, path);
}
