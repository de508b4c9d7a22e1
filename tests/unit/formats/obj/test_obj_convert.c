// SPDX-License-Identifier: MIT
// OBJ → glTF → OBJ: gloss, relief and colours of vertices come back, and losses are told once.
#include "test_gltf.h"
#include "test_obj.h"

#include "base/memory.h"
#include "formats/formats.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 8 };

/// A picture of one colour.
static void write_picture(alp_context *context, const char *path, const uint8_t color[3])
{
    alp_image *image = NULL;
    uint8_t *bytes = NULL;
    size_t size = 0;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){SIDE, SIDE, 3, ALP_COMPONENT_U8}, &image));
    for (int i = 0; i < SIDE * SIDE; i++) {
        memcpy((uint8_t *)image->pixels + 3 * (size_t)i, color, 3);
    }
    ASSERT_OK(context, alpi_png_encode(image, &bytes, &size));
    test_write_file(path, bytes, size);
    alpi_release(context, bytes);
    alp_image_destroy(image);
}

#define MESH "v 0 0 0 1 0.5 0\nv 1 0 0 1 0 0\nv 0 1 0 0.25 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
#define FACE "f 1/1 2/2 3/3\n"

static alp_scene *read_with(alp_context *context, const char *folder, const char *library,
                            const char *obj)
{
    static const uint8_t normal[3] = {128, 128, 255}, rough[3] = {64, 64, 64},
                         metal[3] = {191, 191, 191}, height[3] = {200, 200, 200};
    alp_scene *scene = NULL;
    write_picture(context, test_path(folder, "n.png"), normal);
    write_picture(context, test_path(folder, "r.png"), rough);
    write_picture(context, test_path(folder, "m.png"), metal);
    write_picture(context, test_path(folder, "h.png"), height);
    test_write_text(test_path(folder, "a.mtl"), library);
    test_log_clear();
    ASSERT_OK(context, test_obj_read(context, folder, obj, &scene));
    return scene;
}

/// Writes with a map in the file's own coordinates and reads again.
static alp_scene *through(alp_context *context, const alp_scene *scene, const char *folder,
                          const char *name)
{
    size_t size;
    uint8_t *png = test_read_file(test_path(folder, "r.png"), &size);
    const uint8_t *const pngs[] = {png};
    const alpi_mesh_patch patch = {.page_count = 1,
                                   .kept_uv_set = 1,
                                   .page_pngs = pngs,
                                   .page_png_sizes = &size,
                                   .occlusion_strength = 1.0f};
    alp_scene *back = NULL;
    ASSERT_OK(context, alpi_scene_write_patched(scene, &patch, test_path(folder, name), false));
    ASSERT_OK(context, alp_scene_load(context, test_path(folder, name), &back));
    free(png);
    return back;
}

static float texel(alp_context *context, const alp_scene *scene, const alpi_texture *texture,
                   int channel)
{
    float rgba[4];
    alp_image *image = NULL;
    assert_int_not_equal(texture->image, ALPI_NONE);
    ASSERT_OK(context, alpi_scene_open_image(scene, texture->image, &image));
    assert_non_null(image);
    alpi_image_pixel(image, 3, 3, rgba);
    alp_image_destroy(image);
    return rgba[channel];
}

static void check_material(alp_context *context, const alp_scene *scene)
{
    const alpi_material *m = &scene->materials[scene->surfaces[0].material];
    ASSERT_NEAR(m->shine.roughness, 0.5, 1e-6);
    ASSERT_NEAR(m->metallic, 0.75, 1e-6);
    ASSERT_NEAR(m->shine.index, 1.25, 1e-6);
    assert_true(m->shine.has_specular);
    ASSERT_NEAR(m->shine.specular[1], 0.25, 1e-6);
    ASSERT_NEAR(texel(context, scene, &m->shine.roughness_texture, 1), 64.0 / 255.0, 1e-6);
    ASSERT_NEAR(texel(context, scene, &m->metallic_texture, 2), 191.0 / 255.0, 1e-6);
    ASSERT_NEAR(texel(context, scene, &m->normal_texture, 2), 1.0, 1e-6);
    ASSERT_NEAR(m->normal_scale, 0.5, 1e-6);
    ASSERT_NEAR(texel(context, scene, &m->shine.specular_texture, 0), 64.0 / 255.0, 1e-6);
    assert_int_equal(m->shine.roughness_texture.wrap_u, ALPI_WRAP_CLAMP);
}

TEST_WITH_CONTEXT(there_and_back, 1)
{
    const char *folder = test_folder();
    alp_scene *obj = read_with(context, folder,
                               "newmtl a\nPr 0.5\nPm 0.75\nNi 1.25\nKs 0.5 0.25 0.125\n"
                               "map_Pr -clamp on r.png\nmap_Pm -clamp on m.png\nmap_Ks r.png\n"
                               "norm -bm 0.5 n.png\n",
                               "mtllib a.mtl\nusemtl a\n" MESH FACE);
    check_material(context, obj);
    alp_scene *gltf = through(context, obj, folder, "b.glb");
    assert_false(test_log_has("mtl-lost"));
    check_material(context, gltf);
    alp_scene *back = through(context, gltf, folder, "c.obj");
    check_material(context, back);
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 3; c++) { // 8 bits and more of sRGB
            const float *wanted = obj->colors[obj->triangles[0][k]];
            ASSERT_NEAR(gltf->colors[gltf->triangles[0][k]][c], wanted[c], 0.0);
            ASSERT_NEAR(back->colors[back->triangles[0][k]][c], wanted[c], 1e-5);
        }
    }
    alp_scene_destroy(obj);
    alp_scene_destroy(gltf);
    alp_scene_destroy(back);
}

/// α² = 2 / (n + 2): n = 126 gives α = 1/8, a roughness of its root.
TEST_WITH_CONTEXT(exponents, 1)
{
    const char *folder = test_folder();
    alp_scene *obj = read_with(context, folder,
                               "newmtl a\nNs 126\nKs 1 1 1\nnewmtl dull\nNs 126\nKs 0 0 0\n"
                               "newmtl flat\nNs 126\nillum 1\nnewmtl said\nNs 126\nPr 0.25\n"
                               "newmtl odd\nNs x\nPr nan\nPm\n",
                               "mtllib a.mtl\nusemtl a\n" MESH FACE "usemtl dull\n" FACE);
    static const double wanted[] = {0.35355339, 1.0, 1.0, 0.25, 1.0};
    for (uint32_t i = 0; i < 5; i++) {
        ASSERT_NEAR(obj->materials[i].shine.roughness, wanted[i], 1e-6);
    }
    alp_scene *gltf = through(context, obj, folder, "b.glb");
    alp_scene *back = through(context, gltf, folder, "c.obj");
    ASSERT_NEAR(back->materials[0].shine.roughness, wanted[0], 1e-6);
    alp_scene_destroy(obj);
    alp_scene_destroy(gltf);
    alp_scene_destroy(back);
}

/// A bump map of normals is kept, one of heights is told, and so is each other kind, once.
TEST_WITH_CONTEXT(losses, 1)
{
    const char *folder = test_folder();
    alp_scene *obj = read_with(context, folder,
                               "newmtl a\nmap_Bump -bm 0.25 n.png\nmap_Ns r.png\nTf 1 1 1\n"
                               "newmtl b\nbump h.png\nTf 1 1 1\nillum 7\nKs 1 1 1\nKa 1 1 1\n"
                               "newmtl dull\nillum 7\nKs 0 0 0\nnewmtl glossy\nillum 2\nKs 1 1 1\n"
                               "newmtl metal\nillum 3\nKs 1 1 1\nPm 1\n"
                               "newmtl unused\nillum 7\nKs 1 1 1\ndisp h.png\n",
                               "mtllib a.mtl\nusemtl a\n" MESH FACE "usemtl b\n" FACE
                               "usemtl dull\n" FACE "usemtl glossy\n" FACE "usemtl metal\n" FACE);
    alp_scene *gltf = through(context, obj, folder, "b.glb");
    const alpi_material *a = &gltf->materials[0], *b = &gltf->materials[1];
    ASSERT_NEAR(texel(context, gltf, &a->normal_texture, 2), 1.0, 1e-6);
    ASSERT_NEAR(a->normal_scale, 0.25, 1e-6);
    assert_int_equal(b->normal_texture.image, ALPI_NONE);
    static const char *const told[] = {
        "mtl-lost map_Ns: ", "mtl-lost Tf: ", "mtl-lost illum: ", "mtl-lost map_Bump of heights: "};
    for (size_t i = 0; i < sizeof told / sizeof *told; i++) {
        const char *found = strstr(test_log_text(), told[i]);
        assert_non_null(found);
        assert_null(strstr(found + 1, told[i]));
    }
    assert_non_null(strstr(test_log_text(), "2 statements"));
    assert_non_null(strstr(test_log_text(), "illum: glTF has no place for it: 1 statements"));
    assert_null(strstr(test_log_text(), "mtl-lost Ka"));
    assert_null(strstr(test_log_text(), "mtl-lost disp"));
    alp_scene_destroy(gltf);
    alp_scene_destroy(obj);
}

/// Names in Latin-1 are UTF-8 in the scene and in glTF. An OBJ keeps its bytes, and a picture may
/// have the name in either.
TEST_WITH_CONTEXT(names_in_latin_1, 1)
{
    static const char *const pictures[] = {"gr\xfcn.png", "gr\xc3\xbcn.png"};
    for (int i = 0; i < 2; i++) {
        static const uint8_t green[3] = {0, 255, 0};
        const char *folder = test_folder();
        write_picture(context, test_path(folder, pictures[i]), green);
        alp_scene *obj = read_with(context, folder,
                                   "newmtl gr\xfcn\nKd 1 1 1\nmap_Kd gr\xfcn.png\n"
                                   "newmtl gr\xfcn\n",
                                   "mtllib a.mtl\no D\xe4"
                                   "cher\nusemtl gr\xfcn\n" MESH FACE);
        assert_string_equal(obj->materials[0].name, "gr\xc3\xbcn");
        assert_string_equal(obj->surfaces[0].name, "D\xc3\xa4"
                                                   "cher");
        assert_false(test_log_has("image"));
        assert_non_null(strstr(test_log_text(), "material gr\xc3\xbcn: "));
        alp_scene *gltf = through(context, obj, folder, "b.glb");
        assert_string_equal(gltf->materials[0].name, "gr\xc3\xbcn");
        ASSERT_NEAR(texel(context, gltf, &gltf->materials[0].base_color_texture, 1), 1.0, 1e-6);
        alp_scene *back = through(context, obj, folder, "c.obj");
        ASSERT_NEAR(texel(context, back, &back->materials[0].base_color_texture, 1), 1.0, 1e-6);
        size_t size;
        uint8_t *text = test_read_file(test_path(folder, "c.obj"), &size);
        assert_non_null(strstr((const char *)text, "usemtl gr\xfcn\n"));
        free(text);
        alp_scene_destroy(obj);
        alp_scene_destroy(gltf);
        alp_scene_destroy(back);
    }
}

static size_t count_of(const char *text, const char *word)
{
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, word)) != NULL; at++) {
        count++;
    }
    return count;
}

/// The coordinates of an OBJ are both sets of its scene: with new charts glTF has them once, and
/// with kept ones its two sets have one accessor.
TEST_WITH_CONTEXT(coordinates_are_written_once, 1)
{
    static const float charts[1][3][2] = {{{0.1f, 0.1f}, {0.9f, 0.1f}, {0.1f, 0.9f}}};
    static const uint8_t white[3] = {255, 255, 255};
    for (int keeps = 0; keeps < 2; keeps++) {
        const char *folder = test_folder();
        alp_scene *obj = read_with(context, folder, "newmtl a\nmap_Kd h.png\n",
                                   "mtllib a.mtl\nusemtl a\n" MESH FACE);
        size_t size;
        write_picture(context, test_path(folder, "ao.png"), white);
        uint8_t *png = test_read_file(test_path(folder, "ao.png"), &size);
        const uint8_t *const pngs[] = {png};
        const alpi_mesh_patch patch = {.page_count = 1,
                                       .corner_uvs = keeps ? NULL : charts,
                                       .kept_uv_set = 1,
                                       .page_pngs = pngs,
                                       .page_png_sizes = &size,
                                       .occlusion_strength = 1.0f};
        ASSERT_OK(context,
                  alpi_scene_write_patched(obj, &patch, test_path(folder, "b.gltf"), false));
        uint8_t *text = test_read_file(test_path(folder, "b.gltf"), &size);
        assert_int_equal(count_of((const char *)text, "\"TEXCOORD_"), 2);
        assert_int_equal(count_of((const char *)text, "\"VEC2\""), keeps ? 1 : 2);
        free(text);
        free(png);
        alp_scene_destroy(obj);
    }
}
