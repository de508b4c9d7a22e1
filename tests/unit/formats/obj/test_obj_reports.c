// SPDX-License-Identifier: MIT
// OBJ files as people and their programs write them: scenes/reports/EXPECT.tsv, row by row.
#include "test_gltf.h"
#include "test_obj.h"

#include "base/memory.h"
#include "formats/formats.h"
#include "scene/area_points.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { POINTS = 1024 };

static alp_scene *load(alp_context *context, const char *file)
{
    alp_scene *scene = NULL;
    test_log_clear();
    ASSERT_OK(context,
              alp_scene_load(context, test_path(test_shared("scenes/reports"), file), &scene));
    return scene;
}

/// Mean accessibility over a scene, or over its first surface alone.
static double mean_occlusion(const alp_scene *scene, bool first)
{
    static alpi_area_point points[POINTS];
    static float positions[POINTS][3], normals[POINTS][3], values[POINTS];
    assert_true(alpi_area_points(scene, POINTS, points));
    uint32_t count = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        vec3 c[3];
        if (first && scene->triangle_surface[points[i].triangle] != 0) {
            continue;
        }
        alpi_triangle_corners(scene, points[i].triangle, c);
        vec3_store(positions[count], vec3_mad(vec3_mad(c[0], points[i].b1, vec3_sub(c[1], c[0])),
                                              points[i].b2, vec3_sub(c[2], c[0])));
        vec3_store(normals[count++],
                   vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f}));
    }
    alp_occlusion_options options = alp_occlusion_options_default();
    options.samples = 256;
    options.distance = 0.2f * vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    ASSERT_OK(scene->context, alp_occlusion_at_points(scene, count, positions[0], NULL, normals[0],
                                                      &options, values));
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        sum += (double)values[i];
    }
    return sum / count;
}

static const alpi_material *material(const alp_scene *scene, uint32_t surface)
{
    return &scene->materials[scene->surfaces[surface].material];
}

TEST_WITH_CONTEXT(transparency, 1)
{
    if (test_shared("scenes/reports") == NULL) {
        skip();
    }
    static const char *const files[] = {"mtl_tr.obj", "mtl_tr_ok.obj"};
    for (int i = 0; i < 2; i++) {
        alp_scene *scene = load(context, files[i]);
        assert_int_equal(material(scene, 1)->alpha_mode, ALPI_ALPHA_OPAQUE);
        assert_int_equal(test_log_has("alpha"), i == 0);
        ASSERT_NEAR(mean_occlusion(scene, true), 0.42, 0.06); // under a roof, not 1
        alp_scene_destroy(scene);
    }
    alp_scene *scene = load(context, "mtl_mapd.obj"); // the mask is black everywhere
    assert_int_equal(material(scene, 1)->alpha_mode, ALPI_ALPHA_MASK);
    ASSERT_NEAR(mean_occlusion(scene, true), 1.0, 1e-6);
    vec3 albedo = alpi_surface_albedo(scene, 2, 0.0f, 0.0f);
    assert_true(albedo.x + albedo.y + albedo.z > 0.0f); // the colours are still there
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(textures, 1)
{
    if (test_shared("scenes/reports") == NULL) {
        skip();
    }
    static const struct {
        const char *file;
        bool noted;
    } cases[] = {{"mtl_option.obj", false}, {"mtl_winpath.obj", true}, {"mtl_case.obj", true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = load(context, cases[i].file);
        const uint32_t image = material(scene, 0)->base_color_texture.image;
        assert_int_not_equal(image, ALPI_NONE);
        assert_non_null(scene->images[image]);
        assert_int_equal(test_log_has("image-path"), cases[i].noted);
        assert_false(test_log_has("image"));
        assert_null(strstr(test_log_text(), "--allow-outside"));
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(statements, 1)
{
    if (test_shared("scenes/reports") == NULL) {
        skip();
    }
    static const struct {
        const char *file, *warning;
        uint32_t triangles;
    } cases[] = {{"obj_no_vt.obj", "missing-data", 2},
                 {"obj_no_vn.obj", "missing-data", 2},
                 {"obj_utf16.obj", NULL, 1},
                 {"obj_vcol.obj", NULL, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = load(context, cases[i].file);
        assert_int_equal(scene->usable_count, cases[i].triangles);
        assert_true(cases[i].warning == NULL || test_log_has(cases[i].warning));
        assert_int_equal(scene->colors != NULL, i == 3);
        if (i == 3) {
            ASSERT_NEAR(scene->colors[0][0], 1.0, 1e-6);
            ASSERT_NEAR(scene->colors[0][1], 0.0, 0.0);
        }
        alp_scene_destroy(scene);
    }
}

/// Bakes a file to an OBJ. @return its text, or that of its library; released by the caller
static char *bake(alp_context *context, const char *file, const char *ending)
{
    char name[64];
    size_t size;
    const char *folder = test_folder();
    alp_scene *scene = load(context, file);
    alp_bake_options options = alp_bake_options_default();
    const char *out = test_path(folder, "out.obj");
    options.output = out;
    options.atlas.size = 64;
    options.occlusion.samples = 4;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    alp_scene_destroy(scene);
    snprintf(name, sizeof name, "out%s", ending);
    return (char *)test_read_file(test_path(folder, name), &size);
}

/// Every line of a text from the start of one is in the other, in its order.
static void check_lines(const char *of, const char *in, const char *without)
{
    for (const char *line = of; *line != '\0';) {
        const size_t length = strcspn(line, "\n");
        char text[256];
        snprintf(text, sizeof text, "%.*s\n", (int)length, line);
        const char *found = strstr(in, text);
        if (strncmp(text, without, strlen(without)) != 0) {
            assert_non_null(found);
            in = found + length;
        }
        line += length + (line[length] == '\n');
    }
}

TEST_WITH_CONTEXT(kept, 1)
{
    if (test_shared("scenes/reports") == NULL) {
        skip();
    }
    static const char *const cases[][3] = {{"mtl_loss.obj", "mtl_loss.mtl", ".mtl"},
                                           {"mtl_loss.obj", "mtl_loss.obj", ".obj"},
                                           {"obj_vcol.obj", "obj_vcol.obj", ".obj"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        size_t size;
        char *text = bake(context, cases[i][0], cases[i][2]);
        char *source =
            (char *)test_read_file(test_path(test_shared("scenes/reports"), cases[i][1]), &size);
        check_lines(source, text, i == 2 ? "f " : "mtllib"); // f gets coordinates
        free(source);
        free(text);
    }
}

/// Coordinates of a national grid: the occlusion of the same scene near the origin, and the digits
/// of the file.
TEST_WITH_CONTEXT(far_from_the_origin, 1)
{
    if (test_shared("scenes/reports") == NULL) {
        skip();
    }
    alp_scene *far = load(context, "far_utm.obj"), *near = load(context, "far_utm.near.obj");
    const double mean = mean_occlusion(near, false);
    ASSERT_NEAR(mean, 0.938, 0.01); // of 1,024 points, not of texels
    ASSERT_NEAR(mean_occlusion(far, false), mean, 1e-4);
    alp_scene_destroy(far);
    alp_scene_destroy(near);
    char *text = bake(context, "far_utm.obj", ".obj");
    assert_non_null(strstr(text, "\nv 467121.250 112.500 -5712343.750\n"));
    assert_non_null(strstr(text, "\nv 467123.750 113.500 -5712346.250\n"));
    free(text);
}
