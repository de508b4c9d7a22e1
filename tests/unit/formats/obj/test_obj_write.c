// SPDX-License-Identifier: MIT
// A scene written as OBJ and read again: the same mesh bit by bit, baked coordinates in the place
// of vt, materials and pictures; and what is refused, kept or left alone.
#include "test_gltf.h"
#include "test_obj.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/random.h"
#include "formats/formats.h"
#include "formats/obj/obj.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { CORNERS = 3 * 64 };

/// A scene with a patch of one or more pages.
typedef struct bake {
    alp_context *context;
    alp_scene *scene;
    alpi_mesh_patch patch;
    float (*uvs)[3][2];
    uint32_t *pages;
    uint8_t *pngs[2];
    size_t sizes[2];
    const char *folder;
} bake;

static float draw(uint64_t *seed)
{
    *seed = alpi_hash64(*seed);
    return (float)(*seed >> 40) * 0x1p-24f;
}

static uint8_t *make_png(alp_context *context, uint8_t value, size_t *size)
{
    alp_image *image = NULL;
    uint8_t *bytes = NULL;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){8, 8, 1, ALP_COMPONENT_U8}, &image));
    memset(image->pixels, value, 64);
    ASSERT_OK(context, alpi_png_encode(image, &bytes, size));
    alp_image_destroy(image);
    return bytes;
}

/// As a scene that came from no OBJ: all of it is written.
static void forget_source(alp_scene *scene)
{
    alpi_attachment *kept = &scene->attachments[ALPI_ATTACHMENT_OBJ];
    kept->destroy(scene->context, kept->data);
    *kept = (alpi_attachment){0};
}

static void start(bake *b, const char *text)
{
    *b = (bake){.context = test_context(1), .folder = test_folder()};
    ASSERT_OK(b->context, test_obj_read(b->context, b->folder, text, &b->scene));
    forget_source(b->scene);
    const uint32_t count = b->scene->triangle_count;
    uint64_t seed = 5;
    b->uvs = alpi_allocate(b->context, count, sizeof *b->uvs);
    b->pages = alpi_allocate(b->context, count, sizeof *b->pages);
    for (uint32_t t = 0; t < count; t++) {
        for (int k = 0; k < 6; k++) { // also values near 0, where 1 − v is long
            b->uvs[t][k / 2][k % 2] = draw(&seed) * (t % 3 == 0 ? 1e-4f : 1.0f);
        }
    }
    for (int p = 0; p < 2; p++) {
        b->pngs[p] = make_png(b->context, (uint8_t)(100 + p), &b->sizes[p]);
    }
    b->patch = (alpi_mesh_patch){.page_count = 1,
                                 .corner_uvs = (const float(*)[3][2])b->uvs,
                                 .kept_uv_set = 1,
                                 .page_pngs = (const uint8_t *const *)b->pngs,
                                 .page_png_sizes = b->sizes,
                                 .occlusion_strength = 1.0f,
                                 .extras_json = "{\"version\":\"x\"}"};
}

static void finish(bake *b)
{
    alp_scene_destroy(b->scene);
    alpi_release(b->context, b->uvs);
    alpi_release(b->context, b->pages);
    alpi_release(b->context, b->pngs[0]);
    alpi_release(b->context, b->pngs[1]);
    alp_context_destroy(b->context);
}

static const char *out_path(const bake *b)
{
    return test_path(b->folder, "out.obj");
}

static alp_scene *write_and_read(bake *b)
{
    const alpi_output_images images = {.occlusion = b->patch.page_count};
    alp_scene *scene = NULL;
    ASSERT_OK(b->context, alpi_scene_check_outputs(b->scene, &images, out_path(b), false));
    ASSERT_OK(b->context, alpi_scene_write_patched(b->scene, &b->patch, out_path(b), false));
    ASSERT_OK(b->context, alp_scene_load(b->context, out_path(b), &scene));
    return scene;
}

/// Every corner of every triangle has the same position, normal and name of surface and material.
static void check_same(const alp_scene *a, const alp_scene *b)
{
    assert_int_equal(a->triangle_count, b->triangle_count);
    assert_int_equal(a->surface_count, b->surface_count);
    for (uint32_t t = 0; t < a->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            const uint32_t i = a->triangles[t][k], j = b->triangles[t][k];
            assert_memory_equal(a->positions[i], b->positions[j], sizeof *a->positions);
            for (int axis = 0; axis < 3; axis++) { // made unit once more: one rounding
                ASSERT_NEAR(a->normals[i][axis], b->normals[j][axis], 0x1p-23);
            }
        }
        assert_int_equal(a->triangle_surface[t], b->triangle_surface[t]);
    }
    for (uint32_t s = 0; s < a->surface_count; s++) {
        assert_string_equal(a->surfaces[s].name, b->surfaces[s].name);
        assert_int_equal(a->surfaces[s].normals_generated, b->surfaces[s].normals_generated);
    }
}

/// A mesh of random bits: some with normals, some flat, some corners shared.
TEST(random_meshes)
{
    char *text = malloc(1 << 16), *at = text;
    uint64_t seed = 11;
    for (int i = 0; i < CORNERS; i++) {
        float scale = powf(10.0f, 20.0f * draw(&seed) - 10.0f);
        at += sprintf(at, "v %.9g %.9g %.9g\n", (double)(scale * draw(&seed)), (double)-draw(&seed),
                      (double)(draw(&seed) / scale));
        float n[3] = {draw(&seed), draw(&seed) - 0.5f, draw(&seed)};
        at += sprintf(at, "vn %.9g %.9g %.9g\n", (double)n[0], (double)n[1], (double)n[2]);
    }
    for (int i = 1; i + 2 <= CORNERS; i += 2) {
        at += i % 64 == 1 ? sprintf(at, "g part%d\n", i / 64) : 0;
        at += i / 64 % 2
                  ? sprintf(at, "f %d %d %d\n", i, i + 1, i + 2)
                  : sprintf(at, "f %d//%d %d//%d %d//%d\n", i, i, i + 1, i + 1, i + 2, i + 2);
    }
    bake b;
    start(&b, text);
    alp_scene *scene = write_and_read(&b);
    check_same(b.scene, scene);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            assert_memory_equal(scene->uvs[0][scene->triangles[t][k]], b.uvs[t][k], 8);
        }
    }
    // and once more: what was written is read as it was written
    b.patch.corner_uvs = NULL;
    alp_scene *again = NULL;
    const char *second = test_path(b.folder, "second.obj");
    ASSERT_OK(b.context, alpi_scene_write_patched(scene, &b.patch, second, false));
    ASSERT_OK(b.context, alp_scene_load(b.context, second, &again));
    check_same(scene, again);
    assert_memory_equal(scene->uvs[0], again->uvs[0], scene->vertex_count * sizeof *scene->uvs[0]);
    alp_scene_destroy(again);
    alp_scene_destroy(scene);
    free(text);
    finish(&b);
}

#define FOUR_TRIANGLES                                                                             \
    "mtllib in.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"         \
    "o two words\nusemtl red\nf 1/1 2/2 3/3\no two\nusemtl textured\nf 2/1 4/2 3/3\n"              \
    "o three\nf 1/1 3/2 5/3\no four\nusemtl nowhere\nf 1/1 5/2 2/3\n"

static void write_library(const char *folder)
{
    alp_context *context = test_context(1);
    size_t size;
    uint8_t *png = make_png(context, 200, &size);
    test_write_file(test_path(folder, "wood.png"), png, size);
    alpi_release(context, png);
    alp_context_destroy(context);
    test_write_text(test_path(folder, "in.mtl"),
                    "newmtl red\nKd 0.75 0.1 0.2\nKe 3 0 0.5\nd 0.5\n"
                    "newmtl textured\nKd 0.5 0.5 0.5\nmap_Kd -s 2 2 1 -clamp on wood.png\n");
}

static const alpi_material *named(const alp_scene *scene, const char *name)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        if (strcmp(scene->materials[i].name, name) == 0) {
            return &scene->materials[i];
        }
    }
    fail_msg("no material %s", name);
    return NULL;
}

static bool exists(const bake *b, const char *name)
{
    return access(test_path(b->folder, name), F_OK) == 0;
}

/// start() makes the folder before the library can lie in it: read again.
static void start_with_library(bake *b)
{
    start(b, FOUR_TRIANGLES);
    write_library(b->folder);
    alp_scene_destroy(b->scene);
    ASSERT_OK(b->context, test_obj_read(b->context, b->folder, FOUR_TRIANGLES, &b->scene));
    forget_source(b->scene);
}

TEST(materials_and_pages)
{
    bake b;
    start_with_library(&b);
    const uint32_t pages[4] = {0, 1, 0, ALPI_NONE};
    memcpy(b.pages, pages, sizeof pages);
    b.patch.page_count = 2;
    b.patch.triangle_pages = b.pages;
    test_log_clear();
    alp_scene *scene = write_and_read(&b);
    check_same(b.scene, scene);
    assert_true(test_log_has("texture-lost"));
    const alpi_material *red = named(scene, "red");
    for (int k = 0; k < 4; k++) {
        ASSERT_NEAR(red->base_color[k], named(b.scene, "red")->base_color[k], 0.0);
    }
    ASSERT_NEAR(red->emission[0], 3.0, 0.0);
    assert_int_equal(red->alpha_mode, ALPI_ALPHA_BLEND);
    assert_int_equal(red->base_color_texture.image, ALPI_NONE);
    // page 0 is 100 / 255, page 1 101 / 255; the last surface has none and keeps its coordinates
    for (uint32_t t = 0; t < 4; t++) {
        float value = -1.0f;
        const bool found = alpi_surface_occlusion(scene, t, 0.3f, 0.3f, &value);
        assert_int_equal(found, t != 3);
        if (found) {
            ASSERT_NEAR(value, (100.0 + pages[t]) / 255.0, 1e-6);
        }
    }
    ASSERT_NEAR(scene->uvs[0][scene->triangles[3][2]][1], 0.0, 0.0); // vt 0 1
    assert_true(exists(&b, "out.mtl") && exists(&b, "out.ao.png") && exists(&b, "out.ao.1.png"));
    assert_false(exists(&b, "out.image.png"));
    size_t size;
    char *text = (char *)test_read_file(out_path(&b), &size);
    assert_non_null(strstr(text, "# {\"version\":\"x\"}\nmtllib out.mtl\no two words\n"));
    free(text);
    alp_scene_destroy(scene);
    finish(&b);
}

/// The reader has warned of pictures that are missing: the writer does not.
TEST(missing_pictures_are_no_loss)
{
    bake b;
    start_with_library(&b);
    b.scene->read_image = NULL;
    for (uint32_t i = 0; i < b.scene->image_count; i++) {
        alp_image_destroy(b.scene->images[i]);
        b.scene->images[i] = NULL;
    }
    test_log_clear();
    alp_scene_destroy(write_and_read(&b));
    assert_false(test_log_has("texture-lost"));
    finish(&b);
}

/// With the scene's own coordinates its textures stay, and map_Kd is theirs.
TEST(kept_coordinates)
{
    bake b;
    start_with_library(&b);
    b.patch.corner_uvs = NULL;
    test_log_clear();
    alp_scene *scene = write_and_read(&b);
    assert_false(test_log_has("texture-lost"));
    check_same(b.scene, scene);
    const alpi_material *m = named(scene, "textured"), *old = named(b.scene, "textured");
    const alpi_texture *texture = &m->base_color_texture;
    assert_int_not_equal(texture->image, ALPI_NONE);
    assert_int_equal(texture->wrap_u, ALPI_WRAP_CLAMP);
    for (int k = 0; k < 2; k++) {
        ASSERT_NEAR(texture->scale[k], old->base_color_texture.scale[k], 0.0);
        ASSERT_NEAR(texture->offset[k], old->base_color_texture.offset[k], 0.0);
    }
    assert_true(exists(&b, "out.image.png"));
    for (uint32_t t = 0; t < 4; t++) {
        vec3 was = alpi_surface_albedo(b.scene, t, 0.2f, 0.5f);
        vec3 is = alpi_surface_albedo(scene, t, 0.2f, 0.5f);
        ASSERT_NEAR(was.x, is.x, 0.0);
        float value = -1.0f;
        assert_true(alpi_surface_occlusion(scene, t, 0.3f, 0.3f, &value));
        ASSERT_NEAR(value, 100.0 / 255.0, 1e-6);
    }
    alp_scene_destroy(scene);
    finish(&b);
}

/// All light as emission: black, with what 1 in the picture stands for.
TEST(light)
{
    bake b;
    start_with_library(&b);
    const float scales[3] = {2.0f, 3.0f, 5.0f};
    const alpi_light_patch patch = {.form = ALPI_LIGHT_FORM_EMISSIVE,
                                    .pages = (const uint8_t *const *)b.pngs,
                                    .page_sizes = b.sizes,
                                    .ending = ".png",
                                    .scales = scales,
                                    .units = "radiance"};
    b.patch.page_pngs = NULL;
    b.patch.light = &patch;
    alp_scene *scene = write_and_read(&b);
    const alpi_material *m = named(scene, "textured");
    ASSERT_NEAR(m->base_color[0], 0.0, 0.0);
    ASSERT_NEAR(m->emission[1], 3.0, 0.0);
    assert_int_not_equal(m->emission_texture.image, ALPI_NONE);
    ASSERT_NEAR(named(scene, "none")->emission[2], 5.0, 0.0);
    assert_true(exists(&b, "out.light.png"));
    assert_false(exists(&b, "out.ao.png"));
    alp_scene_destroy(scene);
    static const alpi_light_form forms[] = {ALPI_LIGHT_FORM_MOZ, ALPI_LIGHT_FORM_EXTRAS};
    for (int i = 0; i < 2; i++) {
        alpi_light_patch other = patch;
        other.form = forms[i];
        b.patch.light = &other;
        assert_int_equal(alpi_scene_write_patched(b.scene, &b.patch, out_path(&b), true),
                         ALP_ERROR_UNSUPPORTED);
    }
    const float values[CORNERS] = {0};
    b.patch.light = NULL;
    b.patch.vertex_values = values;
    assert_int_equal(alpi_scene_write_patched(b.scene, &b.patch, out_path(&b), true),
                     ALP_ERROR_UNSUPPORTED);
    finish(&b);
}

/// A scene with two materials of one name, names that OBJ cannot hold, and no triangles somewhere.
TEST(names)
{
    bake b;
    start(&b, "v 0 0 0\nv 1 0 0\nv 0 1 0\no a\nf 1 2 3\no b\nf 1 2 3\nf 1 1 1\no c\nf 1 2 3\n");
    alp_scene *s = b.scene;
    s->materials = alpi_allocate(b.context, 3, sizeof *s->materials);
    s->material_count = 3;
    for (uint32_t i = 0; i < 3; i++) {
        s->materials[i] = alpi_material_default();
        s->materials[i].name = alpi_copy_string(b.context, i < 2 ? " twin\n\\" : "");
        s->materials[i].base_color[0] = 0.25f * (float)(i + 1);
        s->surfaces[i].material = i;
    }
    alpi_release(b.context, s->surfaces[0].name);
    s->surfaces[0].name = alpi_copy_string(b.context, "");
    alpi_release(b.context, s->surfaces[1].name);
    s->surfaces[1].name = alpi_copy_string(b.context, " x\ty\\");
    alp_scene *scene = write_and_read(&b);
    assert_int_equal(scene->triangle_count, 3); // the one without area is left out
    assert_string_equal(scene->surfaces[0].name, "object");
    assert_string_equal(scene->surfaces[1].name, "_x_y_");
    assert_int_equal(scene->material_count, 3);
    for (uint32_t i = 0; i < 3; i++) {
        const alpi_material *m = &scene->materials[scene->surfaces[i].material];
        ASSERT_NEAR(m->base_color[0], 0.25 * (i + 1), 0.0);
    }
    assert_string_equal(scene->materials[0].name, "_twin__");
    assert_string_equal(scene->materials[2].name, "material_2");
    alp_scene_destroy(scene);
    finish(&b);
}

/// Nothing is overwritten unless asked, and nothing is left of what failed.
TEST(files_in_the_way)
{
    static const char *const files[] = {"out.obj", "out.mtl", "out.ao.png"};
    const alpi_output_images images = {.occlusion = 1};
    for (int i = 0; i < 3; i++) {
        bake b;
        start(&b, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        test_write_text(test_path(b.folder, files[i]), "mine");
        assert_int_equal(alpi_scene_check_outputs(b.scene, &images, out_path(&b), false),
                         ALP_ERROR_IO);
        test_message_has(b.context, files[i]);
        assert_int_equal(alpi_scene_write_patched(b.scene, &b.patch, out_path(&b), false),
                         ALP_ERROR_IO);
        for (int k = 0; k < 3; k++) {
            assert_int_equal(exists(&b, files[k]), k == i);
        }
        size_t size;
        unsigned char *text = test_read_file(test_path(b.folder, files[i]), &size);
        assert_int_equal(size, 4);
        free(text);
        ASSERT_OK(b.context, alpi_scene_check_outputs(b.scene, &images, out_path(&b), true));
        ASSERT_OK(b.context, alpi_scene_write_patched(b.scene, &b.patch, out_path(&b), true));
        finish(&b);
    }
}

TEST(failing_allocations)
{
    bake b;
    start_with_library(&b);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int allowed = 0;
    for (; result != ALP_OK; allowed++) {
        int left = 0;
        alp_context *context = test_context_failing(&left);
        alp_scene *scene = NULL;
        left = 1000000;
        ASSERT_OK(context, test_obj_read(context, b.folder, FOUR_TRIANGLES, &scene));
        forget_source(scene);
        left = allowed;
        result = alpi_scene_write_patched(scene, &b.patch, out_path(&b), false);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_int_equal(exists(&b, "out.obj"), result == ALP_OK);
        assert_int_equal(exists(&b, "out.mtl"), result == ALP_OK);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    assert_in_range(allowed, 30, 10000);
    finish(&b);
}
