// SPDX-License-Identifier: MIT
// Material libraries: colours, pictures and their options, several libraries, and what is missing.
#include "test_gltf.h"
#include "test_obj.h"

#include "base/memory.h"
#include "formats/formats.h"

#include <stdio.h>
#include <sys/stat.h>

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.75\nvt 0 0\nf 1/1 2/2 3/2\n"

/// A picture of 2 × 2 texels: red, green above; blue, white below.
static void write_png(alp_context *context, const char *path)
{
    static const uint8_t texels[2][2][3] = {{{255, 0, 0}, {0, 255, 0}},
                                            {{0, 0, 255}, {255, 255, 255}}};
    alp_image *image = NULL;
    uint8_t *bytes = NULL;
    size_t size = 0;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){2, 2, 3, ALP_COMPONENT_U8}, &image));
    memcpy(image->pixels, texels, sizeof texels);
    ASSERT_OK(context, alpi_png_encode(image, &bytes, &size));
    test_write_file(path, bytes, size);
    alpi_release(context, bytes);
    alp_image_destroy(image);
}

/// The scene of an OBJ with this library.
static alp_scene *read_with(alp_context *context, const char *folder, const char *library,
                            const char *obj)
{
    alp_scene *scene = NULL;
    test_write_text(test_path(folder, "a.mtl"), library);
    test_log_clear();
    ASSERT_OK(context, test_obj_read(context, folder, obj, &scene));
    return scene;
}

static const alpi_material *material_of(const alp_scene *scene, uint32_t surface)
{
    assert_in_range(surface, 0, scene->surface_count - 1);
    assert_int_not_equal(scene->surfaces[surface].material, ALPI_NONE);
    return &scene->materials[scene->surfaces[surface].material];
}

static void check_color(const float *color, double r, double g, double b)
{
    ASSERT_NEAR(color[0], (float)r, 0.0);
    ASSERT_NEAR(color[1], (float)g, 0.0);
    ASSERT_NEAR(color[2], (float)b, 0.0);
}

TEST_WITH_CONTEXT(colours, 1)
{
    const char *folder = test_folder();
    alp_scene *scene = read_with(
        context, folder,
        "# a library\r\nnewmtl two words \r\n\tKa 1 1 1\r\nKd 0.1 .2 \\\r\n3e-1\r\nKe 20 30 40\r\n"
        "Ks 9 9 9\r\nNs 10\r\nillum 2\r\nnewmtl one\nKd 0.25\nd 0.5\nnewmtl last\nTr 0.25\n"
        "newmtl halo\nd -halo 0.75\nKd spectral x.rfl\nnewmtl one\nKd 1 0 0\n",
        "mtllib a.mtl\n" TRIANGLE "usemtl two words\nf 1 2 3\nusemtl one\nf 1 2 3\nusemtl last\n"
        "f 1 2 3\nusemtl halo\nf 1 2 3\n");
    assert_int_equal(scene->material_count, 4);
    assert_int_equal(scene->surfaces[0].material, ALPI_NONE);
    const alpi_material *m = material_of(scene, 1);
    assert_string_equal(m->name, "two words");
    check_color(m->base_color, 0.1, 0.2, 0.3);
    check_color(m->emission, 20, 30, 40); // radiance as it stands
    assert_int_equal(m->alpha_mode, ALPI_ALPHA_OPAQUE);
    ASSERT_NEAR(m->metallic, 0.0, 0.0);
    m = material_of(scene, 2); // the first of two
    check_color(m->base_color, 0.25, 0.25, 0.25);
    assert_int_equal(m->alpha_mode, ALPI_ALPHA_BLEND);
    ASSERT_NEAR(m->base_color[3], 0.5, 0.0);
    m = material_of(scene, 3); // without a colour: as without a material
    check_color(m->base_color, 0.5, 0.5, 0.5);
    check_color(m->emission, 0, 0, 0);
    ASSERT_NEAR(m->base_color[3], 0.75, 0.0);
    ASSERT_NEAR(material_of(scene, 4)->base_color[3], 0.75, 0.0);
    assert_true(test_log_has("color"));
    assert_true(test_log_has("material")); // "one" twice
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(surfaces_without_a_material_are_noted, 1)
{
    static const char *const objs[2] = {"mtllib a.mtl\nusemtl a\n", ""};
    for (int i = 0; i < 2; i++) {
        char text[128];
        snprintf(text, sizeof text, "%sv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", objs[i]);
        alp_scene *scene = read_with(context, test_folder(), "newmtl a\nKd 1 1 1\n", text);
        assert_int_equal(strstr(test_log_text(), "without a material") != NULL, i);
        ASSERT_NEAR(alpi_surface_albedo(scene, 0, 0.3f, 0.3f).x, i == 1 ? 0.5 : 0.95, 1e-6);
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(pictures, 1)
{
    const char *folder = test_folder();
    mkdir(test_path(folder, "sub"), 0777);
    write_png(context, test_path(folder, "sub/my wood.png"));
    alp_scene *scene = read_with(
        context, folder,
        "newmtl a\nKd 0.5 1 1\nmap_Kd sub\\my wood.png\r\nmap_Ke ./sub/../sub/my wood.png\n"
        "newmtl b\nmap_Kd -blendu on -s 2 3 1 -o 0.5 0.25 -mm 0 1 -clamp on sub/my wood.png\n"
        "map_d sub/my wood.png\nmap_Ka sub/my wood.png\nmap_Bump gone.png\n"
        "newmtl unused\nmap_Kd gone.png\n",
        "mtllib a.mtl\nusemtl a\n" TRIANGLE "usemtl b\nf 1/1 2/2 3/2\n");
    const alpi_material *a = material_of(scene, 0), *b = material_of(scene, 1);
    assert_int_equal(a->base_color_texture.image, a->emission_texture.image); // one file
    assert_non_null(scene->images[a->base_color_texture.image]);
    assert_false(test_log_has("image")); // what no surface needs is not opened
    check_color(a->base_color, 0.5, 1, 1);
    check_color(a->emission, 1, 1, 1); // a map without Ke
    check_color(b->base_color, 1, 1, 1);
    assert_int_equal(b->alpha_mode, ALPI_ALPHA_MASK); // map_d is map_Kd: its alpha
    assert_int_equal(b->occlusion_texture.image, ALPI_NONE);
    assert_int_equal(b->base_color_texture.wrap_u, ALPI_WRAP_CLAMP);
    // (u, w) = (0.25, 0.75) is the middle of the texel at the upper left: red
    vec3 albedo = alpi_surface_albedo(scene, 0, 0.0f, 0.0f);
    ASSERT_NEAR(albedo.x, 0.5, 1e-6);
    ASSERT_NEAR(albedo.y, 0.0, 1e-6);
    // 0.5 + 2 · 0.25 = 1 and 0.25 + 3 · 0.75 = 2.5 from the bottom: −1.5 from the top
    vec2 at = alpi_texture_transform(&b->base_color_texture, (vec2){0.25f, 0.25f});
    ASSERT_NEAR(at.x, 1.0, 1e-6);
    ASSERT_NEAR(at.y, -1.5, 1e-6);
    alp_scene_destroy(scene);
}

/// Nothing outside the asset's folder is opened; a library below it may name what is above itself.
TEST_WITH_CONTEXT(paths, 1)
{
    static const struct {
        const char *name;
        bool inside;
    } cases[] = {{"w.png", true},
                 {"./w.png", true},
                 {".\\w.png", true},
                 {"../w.png", true},
                 {"..\\..\\w.png", false},
                 {"../../w.png", false},
                 {"/etc/w.png", false},
                 {"C:\\w.png", false},
                 {"\\\\host\\w.png", false},
                 {"a/../../w.png", true},
                 {"a/../../../w.png", false},
                 {"..", false},
                 {"w.png/", false},
                 {"-w.png", true}};
    const char *folder = test_folder();
    mkdir(test_path(folder, "sub"), 0777);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char library[256];
        alp_scene *scene = NULL;
        snprintf(library, sizeof library, "newmtl a\nmap_Kd %s\n", cases[i].name);
        test_write_text(test_path(folder, "sub/b.mtl"), library);
        test_log_clear();
        ASSERT_OK(context,
                  test_obj_read(context, folder, "mtllib sub/b.mtl\nusemtl a\n" TRIANGLE, &scene));
        // none of them is there: inside, that is said when it is opened
        const bool refused = strstr(test_log_text(), "leaves the asset's folder") != NULL;
        if (refused == cases[i].inside || !test_log_has("image")) {
            fail_msg("\"%s\": %s", cases[i].name, test_log_text());
        }
        alp_scene_destroy(scene);
    }
    test_log_clear();
    alp_scene *scene = NULL;
    ASSERT_OK(context, test_obj_read(context, folder, "mtllib ../b.mtl\n" TRIANGLE, &scene));
    assert_non_null(strstr(test_log_text(), "leaves the asset's folder"));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(libraries, 1)
{
    const char *folder = test_folder();
    alp_scene *scene = NULL;
    test_write_text(test_path(folder, "b.mtl"), "newmtl b\nKd 0 0 1\n");
    test_write_text(test_path(folder, "my own.mtl"), "newmtl c\nKd 0 1 0\nnewmtl b\nKd 1 1 1\n");
    scene = read_with(context, folder, "newmtl a\nKd 1 0 0\n",
                      "mtllib a.mtl b.mtl\nmtllib my own.mtl\nmtllib a.mtl\nusemtl a\n" TRIANGLE
                      "usemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\nusemtl d\nf 1 2 3\nusemtl\nf 1 2 3\n");
    check_color(material_of(scene, 0)->base_color, 1, 0, 0);
    check_color(material_of(scene, 1)->base_color, 0, 0, 1);
    check_color(material_of(scene, 2)->base_color, 0, 1, 0);
    assert_int_equal(scene->surfaces[3].material, ALPI_NONE);
    assert_int_equal(scene->surfaces[4].material, ALPI_NONE);
    assert_non_null(strstr(test_log_text(), "d: is in no material library"));
    const uint64_t hash = scene->input_hash;
    alp_scene_destroy(scene);
    scene = read_with(context, folder, "newmtl a\nKd 1 0 0.5\n", "mtllib a.mtl\n" TRIANGLE);
    assert_int_not_equal(scene->input_hash, hash);
    alp_scene_destroy(scene);
    test_log_clear();
    ASSERT_OK(context,
              test_obj_read(context, folder, "mtllib no.mtl a.mtl\nusemtl a\n" TRIANGLE, &scene));
    assert_non_null(strstr(test_log_text(), "mtllib no.mtl: is not there"));
    check_color(material_of(scene, 0)->base_color, 1, 0, 0.5);
    alp_scene_destroy(scene);
}

/// Our own mark: map_Ka is occlusion then, and map_Kd of the same file is for viewers.
TEST_WITH_CONTEXT(occlusion, 1)
{
    const char *folder = test_folder();
    write_png(context, test_path(folder, "o.png"));
    write_png(context, test_path(folder, "c.png"));
    alp_scene *scene =
        read_with(context, folder,
                  "newmtl a\nKd .5 .5 .5\nalpenglow_occlusion map_Ka\nmap_Ka o.png\nmap_Kd o.png\n"
                  "newmtl b\nalpenglow_occlusion map_Ka\nmap_Ka o.png\nmap_Kd c.png\n",
                  "mtllib a.mtl\nusemtl a\n" TRIANGLE "usemtl b\nf 1 2 3\n");
    const alpi_material *a = material_of(scene, 0), *b = material_of(scene, 1);
    float accessibility = -1.0f;
    assert_int_equal(a->base_color_texture.image, ALPI_NONE);
    assert_int_not_equal(b->base_color_texture.image, ALPI_NONE);
    assert_int_equal(a->occlusion_texture.image, b->occlusion_texture.image);
    assert_true(alpi_surface_occlusion(scene, 0, 0.0f, 0.0f, &accessibility));
    ASSERT_NEAR(accessibility, 1.0, 1e-6); // red
    alp_scene_destroy(scene);
}

/// A bad number costs its statement: the material is the one without it, and the rest is read.
TEST_WITH_CONTEXT(bad_numbers, 1)
{
    static const struct {
        const char *statement, *words;
    } cases[] = {{"Kd 1 nan 1", "line 2: Kd: \"nan\" is no"},
                 {"Kd red", "line 2: Kd: \"red\" is no"},
                 {"d", "line 2: d has too few numbers"},
                 {"d abc", "line 2: d: \"abc\" is no"},
                 {"Tr 1e39", "line 2: Tr: \"1e39\" is beyond"},
                 {"Ke 1 2 x", "line 2: Ke: \"x\" is no"},
                 {"Ns x", "line 2: Ns: \"x\" is no"},
                 {"Pr nan", "line 2: Pr: \"nan\" is no"},
                 {"illum two", "line 2: illum: \"two\" is no"},
                 {"map_Kd -s 1..2 wood.png", "line 2: -s: \"1..2\" is no"}};
    const char *folder = test_folder();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char library[256];
        snprintf(library, sizeof library, "newmtl a\n%s\nPm 0.25\nKd\n", cases[i].statement);
        test_log_clear();
        alp_scene *scene = read_with(context, folder, library, "mtllib a.mtl\nusemtl a\n" TRIANGLE);
        const alpi_material *m = material_of(scene, 0);
        check_color(m->base_color, 0.5, 0.5, 0.5);
        check_color(m->emission, 0, 0, 0);
        ASSERT_NEAR(m->base_color[3], 1.0, 0.0);
        ASSERT_NEAR(m->shine.roughness, 1.0, 0.0);
        ASSERT_NEAR(m->metallic, 0.25, 0.0);
        assert_int_equal(m->alpha_mode, ALPI_ALPHA_OPAQUE);
        assert_non_null(strstr(test_log_text(), cases[i].words));
        assert_non_null(strstr(test_log_text(), "such statements are left out: 2"));
        alp_scene_destroy(scene);
    }
    // before the first newmtl, and values out of range
    alp_scene *scene = read_with(context, folder, "Kd 1 nan 1\nnewmtl a\nKd 7 -1 1e38\nd 2\n",
                                 "mtllib a.mtl\nusemtl a\n" TRIANGLE);
    check_color(material_of(scene, 0)->base_color, 1, 0, 1);
    assert_true(test_log_has("material-range"));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(normal_maps_are_read_when_they_are_asked_for, 1)
{
    const char *folder = test_folder();
    write_png(context, test_path(folder, "a.png"));
    write_png(context, test_path(folder, "n.png"));
    alp_scene *scene = read_with(
        context, folder,
        "newmtl a\nmap_Kd a.png\nnorm -s 2 2 1 n.png\nnewmtl b\nmap_Kd a.png\nmap_Bump n.png\n"
        "newmtl c\nnorm absent.png\nnewmtl d\nnorm ../gone.png\nnewmtl e\nnorm a.png\n",
        "mtllib a.mtl\nusemtl a\n" TRIANGLE "usemtl b\nf 1/1 2/2 3/2\nusemtl c\nf 1/1 2/2 3/2\n"
        "usemtl d\nf 1/1 2/2 3/2\nusemtl e\nf 1/1 2/2 3/2\n");
    assert_false(test_log_has("image"));
    const alp_texture_info normal = alp_scene_get_material(scene, 0).normal_texture;
    assert_int_equal(normal.image, 1);
    ASSERT_NEAR(normal.transform[0][0], 2.0, 0.0);
    assert_int_equal(alp_scene_get_material(scene, 1).normal_texture.image, ALP_NONE);
    assert_non_null(alp_scene_get_image(scene, 0));
    assert_null(alp_scene_get_image(scene, 1));
    ASSERT_OK(context, alp_scene_load_normal_maps(scene));
    const alp_image *image = alp_scene_get_image(scene, 1);
    assert_non_null(image);
    assert_int_equal(((const uint8_t *)alp_image_pixels(image))[0], 255);
    assert_null(alp_scene_get_image(scene, alp_scene_get_material(scene, 2).normal_texture.image));
    assert_non_null(strstr(test_log_text(), "absent.png"));
    assert_non_null(strstr(test_log_text(), "image d: ")); // outside the folder
    assert_null(strstr(test_log_text(), "image a: "));
    assert_int_equal(alp_scene_get_material(scene, 4).normal_texture.image,
                     0); // light reads it too
    alp_scene *simple = NULL;
    ASSERT_OK(context, alp_scene_simplify(scene, 0.01f, &simple));
    ASSERT_OK(context, alp_scene_load_normal_maps(simple));
    assert_null(alp_scene_get_image(simple, 1));
    alp_scene_destroy(simple);
    alp_scene_destroy(scene);
}
