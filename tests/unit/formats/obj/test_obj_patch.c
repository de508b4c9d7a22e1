// SPDX-License-Identifier: MIT
// An OBJ that was read, written with its bake: what is kept word for word, what the bake changes,
// and where its pictures go.
#include "test_gltf.h"
#include "test_obj.h"

#include "base/memory.h"
#include "formats/formats.h"
#include "formats/obj/obj.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { TRIANGLES = 64 };

/// A bake of in/test.obj; charts are the triangles' own corners in the plane, unless they are
/// moved.
typedef struct bake {
    alp_context *context;
    alp_scene *scene;
    alpi_mesh_patch patch;
    float uvs[TRIANGLES][3][2];
    uint32_t pages[TRIANGLES];
    uint8_t *pngs[2];
    size_t sizes[2];
    const char *folder;
} bake;

static uint8_t *make_png(alp_context *context, uint8_t value, size_t *size)
{
    alp_image *image = NULL;
    uint8_t *bytes = NULL;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){4, 4, 1, ALP_COMPONENT_U8}, &image));
    memset(image->pixels, value, 16);
    ASSERT_OK(context, alpi_png_encode(image, &bytes, size));
    alp_image_destroy(image);
    return bytes;
}

static const char *in(const bake *b, const char *name)
{
    char path[256];
    snprintf(path, sizeof path, "in/%s", name);
    return test_path(b->folder, path);
}

/// Coordinates (x, z) / 8 of each corner: the same where corners meet.
static void lay_out(bake *b)
{
    for (uint32_t t = 0; t < b->scene->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            const float *p = b->scene->positions[b->scene->triangles[t][k]];
            b->uvs[t][k][0] = p[0] / 8.0f;
            b->uvs[t][k][1] = -p[2] / 8.0f;
        }
    }
}

/// Reads an OBJ with this library, or none.
static void start(bake *b, const char *obj, const char *library)
{
    *b = (bake){.context = test_context(1), .folder = test_folder()};
    mkdir(test_path(b->folder, "in"), 0777);
    mkdir(test_path(b->folder, "out"), 0777);
    size_t size;
    uint8_t *png = make_png(b->context, 200, &size);
    test_write_file(in(b, "wood.png"), png, size);
    alpi_release(b->context, png);
    if (library != NULL) {
        test_write_text(in(b, "a.mtl"), library);
    }
    test_write_text(in(b, "test.obj"), obj);
    test_log_clear();
    ASSERT_OK(b->context, alp_scene_load(b->context, in(b, "test.obj"), &b->scene));
    assert_in_range(b->scene->triangle_count, 1, TRIANGLES);
    lay_out(b);
    for (int p = 0; p < 2; p++) {
        b->pngs[p] = make_png(b->context, (uint8_t)(100 + p), &b->sizes[p]);
    }
    b->patch = (alpi_mesh_patch){.page_count = 1,
                                 .corner_uvs = (const float(*)[3][2])b->uvs,
                                 .kept_uv_set = 1,
                                 .page_pngs = (const uint8_t *const *)b->pngs,
                                 .page_png_sizes = b->sizes,
                                 .occlusion_strength = 1.0f};
}

static void finish(bake *b)
{
    alp_scene_destroy(b->scene);
    alpi_release(b->context, b->pngs[0]);
    alpi_release(b->context, b->pngs[1]);
    alp_context_destroy(b->context);
}

/// Writes out/out.obj and compares both texts without their first lines.
static void check_texts(bake *b, const char *obj, const char *library)
{
    static const char head[] = "# Alpenglow 0.1.0\n";
    const char *names[2] = {"out/out.obj", "out/out.mtl"}, *wanted[2] = {obj, library};
    ASSERT_OK(b->context,
              alpi_scene_write_patched(b->scene, &b->patch, test_path(b->folder, names[0]), false));
    for (int i = 0; i < 2; i++) {
        size_t size;
        char *text = (char *)test_read_file(test_path(b->folder, names[i]), &size);
        assert_true(strncmp(text, head, sizeof head - 1) == 0);
        if (wanted[i] != NULL) {
            assert_string_equal(text + sizeof head - 1, wanted[i]);
        }
        free(text);
    }
}

static bool exists(const bake *b, const char *name)
{
    return access(test_path(b->folder, name), F_OK) == 0;
}

#define LIBRARY                                                                                    \
    "# by hand\nnewmtl steel\n  Kd 0.50 .4 0.3 # grey\nKs 0.9 0.9 0.9\nNs 250\nfoo bar\n"          \
    "map_Kd -s 1 1 1 wood.png\nmap_Ns wood.png\n\n# the other\nnewmtl idle\nKd 1 0 0\n"
#define MESH                                                                                       \
    "mtllib a.mtl\no House\ng walls\ns 1\nv 0 0 0.000 1 0 0\nv 1.0 0 0\n"                          \
    "v 1 0 -1e0\nv 0 0 -1\nv 2 0 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"

/// With the file's own coordinates everything stays, and the bake is added.
TEST(kept_word_for_word)
{
    bake b;
    start(&b, MESH "usemtl steel\nf 1/1 2/2 3/3 4/4 # a quad\nl 1 2\nvp 1\n", LIBRARY);
    b.patch.corner_uvs = NULL;
    check_texts(&b,
                "mtllib out.mtl\no House\ng walls\ns 1\nv 0 0 0.000 1 0 0\nv 1.0 0 0\n"
                "v 1 0 -1e0\nv 0 0 -1\nv 2 0 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                "usemtl steel\nf 1/1 2/2 3/3 4/4 # a quad\nl 1 2\nvp 1\n",
                "# by hand\nnewmtl steel\n  Kd 0.50 .4 0.3 # grey\nKs 0.9 0.9 0.9\nNs 250\n"
                "foo bar\nmap_Kd -s 1 1 1 wood.png\nmap_Ns wood.png\nKa 1 1 1\n"
                "alpenglow_occlusion map_Ka\nmap_Ka out.ao.png\n\n# the other\nnewmtl idle\n"
                "Kd 1 0 0\n");
    assert_true(exists(&b, "out/wood.png") && exists(&b, "out/out.ao.png"));
    finish(&b);
}

/// New coordinates take the place of vt. An n-gon stays one, and pictures become comments.
TEST(new_coordinates)
{
    bake b;
    start(&b, MESH "usemtl steel\nf 1/1 2/2 3/3 4/4\nf -4/-1 -1/-1 -3/-1\nl 1/1 2/2\n", LIBRARY);
    check_texts(&b,
                "mtllib out.mtl\no House\ng walls\ns 1\nv 0 0 0.000 1 0 0\nv 1.0 0 0\n"
                "v 1 0 -1e0\nv 0 0 -1\nv 2 0 0\nusemtl steel\nvt 0 1\nvt 0.125 1\nvt 0.125 0.875\n"
                "vt 0 0.875\nvt 0.25 1\nf 1/1 2/2 3/3 4/4\nf -4/2 -1/5 -3/3\nl 1 2\n",
                "# by hand\nnewmtl steel\n  Kd 0.50 .4 0.3 # grey\nKs 0.9 0.9 0.9\nNs 250\n"
                "foo bar\n# map_Kd -s 1 1 1 wood.png\n# map_Ns wood.png\nKa 1 1 1\n"
                "alpenglow_occlusion map_Ka\nmap_Ka out.ao.png\nmap_Kd out.ao.png\n\n# the other\n"
                "newmtl idle\nKd 1 0 0\n");
    assert_true(test_log_has("texture-lost"));
    assert_false(exists(&b, "out/wood.png")); // nothing names it
    finish(&b);
}

/// Surfaces without a map keep their old coordinates, which get new numbers; a face in two charts
/// becomes triangles; a second page is a second material.
TEST(charts_and_pages)
{
    bake b;
    start(&b,
          "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nvt 9 9\nvt 5 5\nusemtl steel\n"
          "f 1 2 3 4\ng b\nf 1/2 2/2 3/1\ng c\nf 1 2 3\n",
          "newmtl steel\r\nKd 1 1 1");
    assert_int_equal(b.scene->triangle_count, 4);
    b.uvs[1][1][0] = 0.75f; // the second triangle of the quad lies elsewhere
    const uint32_t pages[4] = {0, 0, ALPI_NONE, 1};
    memcpy(b.pages, pages, sizeof pages);
    b.patch.page_count = 2;
    b.patch.triangle_pages = b.pages;
    ASSERT_OK(b.context, alpi_scene_write_patched(b.scene, &b.patch,
                                                  test_path(b.folder, "out/out.obj"), false));
    assert_true(test_log_has("divided-faces"));
    alp_scene *scene = NULL;
    ASSERT_OK(b.context, alp_scene_load(b.context, test_path(b.folder, "out/out.obj"), &scene));
    assert_int_equal(scene->triangle_count, 4);
    for (uint32_t t = 0; t < 4; t++) {
        float value;
        const bool found = alpi_surface_occlusion(scene, t, 0.3f, 0.3f, &value);
        assert_int_equal(found, t != 2);
        for (int k = 0; k < 3; k++) {
            const uint32_t v = scene->triangles[t][k], old = b.scene->triangles[t][k];
            assert_memory_equal(scene->positions[v], b.scene->positions[old], 12);
            const float *wanted = t != 2 ? b.uvs[t][k] : b.scene->uvs[0][old];
            ASSERT_NEAR(scene->uvs[0][v][0], wanted[0], 0.0);
            ASSERT_NEAR(scene->uvs[0][v][1], wanted[1], 0.0);
        }
        if (found) {
            ASSERT_NEAR(value, (t == 3 ? 101.0 : 100.0) / 255.0, 1e-6);
        }
    }
    alp_scene_destroy(scene);
    finish(&b);
}

/// A corner on an edge, which only a triangle without area has, lies on the edge of the chart too.
TEST(corners_on_edges)
{
    bake b;
    start(&b, "v 0 0 0\nv 1 0 0\nv 4 0 0\nv 4 0 -4\nv 0 0 -4\nf 1 2 3 4 5\n", NULL);
    for (uint32_t t = 0; t < 3; t++) {
        if (!b.scene->triangle_usable[t]) {
            memset(b.uvs[t], 0, sizeof b.uvs[t]);
        }
    }
    check_texts(&b,
                "mtllib out.mtl\nv 0 0 0\nv 1 0 0\nv 4 0 0\nv 4 0 -4\nv 0 0 -4\nvt 0 1\n"
                "vt 0.125 1\nvt 0.5 1\nvt 0.5 0.5\nvt 0 0.5\nusemtl none\n"
                "f 1/1 2/2 3/3 4/4 5/5\n",
                NULL);
    finish(&b);
}

/// Light takes the place of colours; a bake of a bake replaces it and grows nothing.
TEST(light_and_again)
{
    bake b;
    start(&b, MESH "usemtl steel\nf 1/1 2/2 3/3\n", "newmtl steel\nKd 1 1 1\nKe 2 2 2\nNs 9\n");
    const float scales[2] = {2.0f, 3.0f};
    const alpi_light_patch light = {.form = ALPI_LIGHT_FORM_EMISSIVE,
                                    .pages = (const uint8_t *const *)b.pngs,
                                    .page_sizes = b.sizes,
                                    .ending = ".png",
                                    .scales = scales,
                                    .units = "radiance"};
    b.patch.extras_json = "{\"version\":\"x\"}";
    ASSERT_OK(b.context, alpi_scene_write_patched(b.scene, &b.patch,
                                                  test_path(b.folder, "out/first.obj"), false));
    alp_scene_destroy(b.scene);
    ASSERT_OK(b.context, alp_scene_load(b.context, test_path(b.folder, "out/first.obj"), &b.scene));
    b.patch.page_pngs = NULL;
    b.patch.light = &light;
    check_texts(&b, NULL,
                "newmtl steel\nNs 9\nKa 1 1 1\nKd 0 0 0\nKe 2 2 2\nmap_Ke out.light.png\n");
    size_t first_size, size;
    free(test_read_file(test_path(b.folder, "out/first.obj"), &first_size));
    free(test_read_file(test_path(b.folder, "out/out.obj"), &size));
    assert_int_equal(size, first_size - 2); // "first" is longer than "out"
    finish(&b);
}

/// Pictures are found, and named by paths that are valid from the written file.
TEST(paths)
{
    bake b;
    start(&b, MESH "usemtl steel\nf 1/1 2/2 3/3\n", "newmtl steel\n");
    mkdir(in(&b, "sub"), 0777);
    mkdir(in(&b, "sub/maps"), 0777);
    size_t size;
    uint8_t *png = (uint8_t *)test_read_file(in(&b, "wood.png"), &size);
    test_write_file(in(&b, "sub/maps/My Wood.png"), png, size);
    free(png);
    test_write_text(in(&b, "sub/b.mtl"),
                    "newmtl steel\nmap_Kd -colorspace sRGB \"maps\\my wood.png\" -bm 0.5\n"
                    "norm C:\\Users\\x\\wood.png\nbump -bm 2 ../wood.png\ndisp gone.png\n"
                    "map_Ks maps/My Wood.png # shiny\n");
    test_write_text(in(&b, "test.obj"),
                    "mtllib sub/b.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 -1\nvt 0 0\nvt 1 0\nvt 0 1\n"
                    "usemtl steel\nf 1/1 2/2 3/3\n");
    alp_scene_destroy(b.scene);
    test_log_clear();
    ASSERT_OK(b.context, alp_scene_load(b.context, in(&b, "test.obj"), &b.scene));
    assert_true(test_log_has("image-path"));
    assert_false(test_log_has("image"));
    assert_non_null(b.scene->images[b.scene->materials[0].base_color_texture.image]);
    b.patch.corner_uvs = NULL;
    check_texts(&b, NULL,
                "newmtl steel\nmap_Kd -colorspace sRGB sub/maps/My Wood.png -bm 0.5\n"
                "norm wood.png\nbump -bm 2 wood.png\ndisp gone.png\n"
                "map_Ks sub/maps/My Wood.png # shiny\nKa 1 1 1\nalpenglow_occlusion map_Ka\n"
                "map_Ka out.ao.png\n");
    assert_true(exists(&b, "out/sub/maps/My Wood.png") && exists(&b, "out/wood.png"));
    // a picture of another kind is in the way
    const alpi_output_images images = {.occlusion = 1};
    test_write_text(test_path(b.folder, "out/wood.png"), "mine");
    assert_int_equal(
        alpi_scene_check_outputs(b.scene, &images, test_path(b.folder, "out/other.obj"), false),
        ALP_ERROR_IO);
    finish(&b);
}

TEST(failing_allocations)
{
    bake b;
    start(&b, MESH "usemtl steel\nf 1/1 2/2 3/3 4/4\nf 2 5 3\n", LIBRARY);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int allowed = 0;
    for (; result != ALP_OK; allowed++) {
        int left = 0;
        alp_context *context = test_context_failing(&left);
        alp_scene *scene = NULL;
        left = 1000000;
        ASSERT_OK(context, alp_scene_load(context, in(&b, "test.obj"), &scene));
        left = allowed;
        const char *path = test_path(b.folder, "out/out.obj");
        result = alpi_scene_write_patched(scene, &b.patch, path, false);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_int_equal(exists(&b, "out/out.obj"), result == ALP_OK);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    assert_in_range(allowed, 30, 10000);
    finish(&b);
}

/// New charts make comments of textures. The warning says so once a material, and not of a picture
/// that was missing before.
TEST(commented_textures)
{
    static const struct {
        const char *picture;
        bool told;
    } cases[] = {{"wood.png", true}, {"gone.png", false}, {"C:\\x\\gone.png", false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char library[256], wanted[256];
        bake b;
        snprintf(library, sizeof library, "newmtl steel\nKd 1 1 1\nmap_Kd %s\nmap_Ns %s\n",
                 cases[i].picture, cases[i].picture);
        start(&b, MESH "usemtl steel\nf 1/1 2/2 3/3 4/4\n", library);
        test_log_clear();
        check_texts(&b, NULL, NULL);
        const char *found = strstr(test_log_text(), "texture-lost steel: its textures need the vt");
        assert_int_equal(found != NULL, cases[i].told);
        assert_true(found == NULL || strstr(found + 1, "texture-lost") == NULL);
        assert_true(found == NULL || strstr(found, "write .glb") != NULL);
        size_t size;
        char *text = (char *)test_read_file(test_path(b.folder, "out/out.mtl"), &size);
        snprintf(wanted, sizeof wanted, "# map_Kd %s\n# map_Ns %s\n", cases[i].picture,
                 cases[i].picture);
        assert_non_null(strstr(text, wanted));
        free(text);
        finish(&b);
    }
}

/// A bad number costs a texture its meaning; the statement stays.
TEST(bad_options_stay)
{
    bake b;
    start(&b, MESH "usemtl steel\nf 1/1 2/2 3/3 4/4\n", "newmtl steel\nmap_Kd -s 1..2 wood.png\n");
    for (int keeps = 0; keeps < 2; keeps++) {
        const char *name = keeps ? "out/keep.obj" : "out/charts.obj";
        b.patch.corner_uvs = keeps ? NULL : (const float(*)[3][2])b.uvs;
        ASSERT_OK(b.context,
                  alpi_scene_write_patched(b.scene, &b.patch, test_path(b.folder, name), false));
        size_t size;
        char *text = (char *)test_read_file(
            test_path(b.folder, keeps ? "out/keep.mtl" : "out/charts.mtl"), &size);
        assert_non_null(strstr(text, "map_Kd -s 1..2 wood.png\n"));
        free(text);
    }
    finish(&b);
}
