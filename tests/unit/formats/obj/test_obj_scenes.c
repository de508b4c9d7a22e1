// SPDX-License-Identifier: MIT
// The OBJ files of others: as many triangles as independent tools count; and one mesh has the same
// occlusion whether it comes as OBJ or as glTF.
#include "test_gltf.h"
#include "test_obj.h"

#include "base/random.h"
#include "formats/formats.h"
#include "scene/area_points.h"

#include <math.h>
#include <stdio.h>

enum { POINTS = 512 };

/// Triangles after SOURCES.md beside the scenes.
static const struct {
    const char *file;
    uint32_t triangles, surfaces, materials;
    double extents[3];
} scenes[] = {
    {"architecture/gazebo.obj", 730, 1, 0, {0.893, 0.878, 0.893}},
    {"features/cornell_box.obj", 36, 8, 5, {556, 548.8, 559.2}},
    {"features/cornell_measured/cornell_box_measured.obj", 38, 4, 4, {556, 548.8, 559.2}},
};

TEST(triangle_counts)
{
    if (test_shared("scenes") == NULL) {
        skip();
    }
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = NULL;
        ASSERT_OK(context, alp_scene_load(context, test_path(test_shared("scenes"), scenes[i].file),
                                          &scene));
        assert_int_equal(scene->triangle_count, scenes[i].triangles);
        assert_int_equal(scene->usable_count, scenes[i].triangles);
        assert_int_equal(scene->surface_count, scenes[i].surfaces);
        assert_int_equal(scene->material_count, scenes[i].materials);
        const vec3 size = vec3_sub(scene->bounds_max, scene->bounds_min);
        ASSERT_NEAR(size.x, scenes[i].extents[0], 5e-4); // printed with three decimals
        ASSERT_NEAR(size.y, scenes[i].extents[1], 5e-4);
        ASSERT_NEAR(size.z, scenes[i].extents[2], 5e-4);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// Points on the first scene, `scale` times as far from the origin in the second.
static double occlusion_difference(const alp_scene *a, const alp_scene *b, float scale)
{
    static alpi_area_point points[POINTS];
    static float positions[2][POINTS][3], normals[POINTS][3], values[2][POINTS];
    assert_true(alpi_area_points(a, POINTS, points));
    for (uint32_t i = 0; i < POINTS; i++) {
        vec3 c[3];
        alpi_triangle_corners(a, points[i].triangle, c);
        vec3 p = vec3_mad(vec3_mad(c[0], points[i].b1, vec3_sub(c[1], c[0])), points[i].b2,
                          vec3_sub(c[2], c[0]));
        vec3 n = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
        vec3_store(positions[0][i], p);
        vec3_store(positions[1][i], vec3_scale(p, scale));
        vec3_store(normals[i], n);
    }
    alp_occlusion_options options = alp_occlusion_options_default();
    options.samples = 256;
    const alp_scene *both[2] = {a, b};
    for (int s = 0; s < 2; s++) {
        options.distance =
            0.2f * (s == 0 ? 1.0f : scale) * vec3_length(vec3_sub(a->bounds_max, a->bounds_min));
        ASSERT_OK(both[s]->context, alp_occlusion_at_points(both[s], POINTS, positions[s][0], NULL,
                                                            normals[0], &options, values[s]));
    }
    double sum = 0.0, least = 1.0, most = 0.0;
    for (int i = 0; i < POINTS; i++) {
        double difference = (double)values[0][i] - (double)values[1][i];
        sum += difference * difference;
        least = fmin(least, (double)values[0][i]);
        most = fmax(most, (double)values[0][i]);
    }
    assert_true(most - least > 0.2); // there is something to see
    return sqrt(sum / POINTS);
}

/// Baked to both formats and read again: coordinates are the same bits, so the same rays hit.
static void compare_formats(const char *path)
{
    alp_context *context = test_context(1);
    const char *folder = test_folder();
    alp_scene *scene = NULL, *back[2] = {NULL, NULL};
    ASSERT_OK(context, alp_scene_load(context, path, &scene));
    for (int f = 0; f < 2; f++) {
        const char *out = test_path(folder, f == 0 ? "a.obj" : "a.glb");
        alp_bake_options options = alp_bake_options_default();
        options.output = out;
        options.atlas.size = 128;
        options.occlusion.samples = 4;
        ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
        ASSERT_OK(context, alp_scene_load(context, out, &back[f]));
        assert_int_equal(back[f]->triangle_count, scene->triangle_count);
    }
    ASSERT_NEAR(occlusion_difference(scene, back[0], 1.0f), 0.0, 1e-4);
    ASSERT_NEAR(occlusion_difference(back[1], back[0], 1.0f), 0.0, 1e-4);
    alp_scene_destroy(back[0]);
    alp_scene_destroy(back[1]);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST_SLOW(same_occlusion)
{
    compare_formats("builtin:cornell");
    compare_formats("builtin:teapot-room");
    if (test_shared("scenes") == NULL) {
        skip();
    }
    compare_formats(test_shared("scenes/architecture/gazebo.obj"));
    compare_formats(test_shared("scenes/features/cornell_box.obj"));
}

/// The measured Cornell box, which others wrote as glTF in metres and as OBJ in millimetres.
TEST_WITH_CONTEXT(files_of_others, 1)
{
    if (test_shared("scenes") == NULL) {
        skip();
    }
    alp_scene *gltf = NULL, *obj = NULL;
    const char *folder = test_shared("scenes/features/cornell_measured");
    ASSERT_OK(context,
              alp_scene_load(context, test_path(folder, "cornell_box_measured.glb"), &gltf));
    ASSERT_OK(context,
              alp_scene_load(context, test_path(folder, "cornell_box_measured.obj"), &obj));
    // One ray in 256 of one point in 512 that passes an edge on its other side is 1.7e-4; rounding
    // to 1e-7 of the box leaves it to one in millions.
    ASSERT_NEAR(occlusion_difference(gltf, obj, 1000.0f), 0.0, 1e-4);
    alp_scene_destroy(gltf);
    alp_scene_destroy(obj);
}

/// Messages of coordinates name them as an OBJ does.
TEST_WITH_CONTEXT(words_of_the_file, 1)
{
    alp_scene *scene =
        test_obj_scene(context, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\n"
                                "vt 0 1\nf 1/1 2/2 3/3\nf 1/1 4/2 2/3\n");
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_KEEP;
    options.size = 64;
    alp_atlas *atlas = NULL;
    assert_int_equal(alp_atlas_create(scene, &options, &atlas), ALP_ERROR_INVALID_DATA);
    test_message_has(context, "the set of texture coordinates (vt) cannot hold a bake");
    assert_null(strstr(alp_context_message(context), "TEXCOORD"));
    alp_scene_destroy(scene);
}
