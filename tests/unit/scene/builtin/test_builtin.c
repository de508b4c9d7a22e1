// SPDX-License-Identifier: MIT
// The built-in scenes: complete, facing the right way, as large as their closed forms, the same
// every time.
#include "test_support.h"

#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>

static const char *const NAMES[] = {"cornell",      "furnace",     "bowl",
                                    "sphere-plane", "torus-plane", "teapot-room",
                                    "windows",      "atrium",      "terrain"};
enum { NAME_COUNT = sizeof NAMES / sizeof *NAMES };

static alp_scene *create(alp_context *context, const char *name)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alpi_builtin_create(context, name, &scene));
    return scene;
}

static uint32_t find_surface(const alp_scene *scene, const char *name)
{
    for (uint32_t i = 0; i < scene->surface_count; i++) {
        if (strcmp(scene->surfaces[i].name, name) == 0) {
            return i;
        }
    }
    fail_msg("no surface \"%s\"", name);
    return 0;
}

static double surface_area(const alp_scene *scene, const char *name)
{
    const alpi_surface *s = &scene->surfaces[find_surface(scene, name)];
    double area = 0.0;
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        vec3 c[3];
        alpi_triangle_corners(scene, s->first_triangle + i, c);
        area += vec3_triangle_area(c[0], c[1], c[2]);
    }
    return area;
}

/// ∮ p·n dA / 3: the volume inside a closed surface that faces outside.
static double signed_volume(const alp_scene *scene, const char *name)
{
    const alpi_surface *s = &scene->surfaces[find_surface(scene, name)];
    double volume = 0.0;
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        vec3 c[3];
        alpi_triangle_corners(scene, s->first_triangle + i, c);
        volume += (double)vec3_dot(c[0], vec3_cross(c[1], c[2])) / 6.0;
    }
    return volume;
}

/// Whether every triangle of a surface faces the point (or, `away`, looks away from it).
static void assert_faces(const alp_scene *scene, const char *name, vec3 point, bool away)
{
    const alpi_surface *s = &scene->surfaces[find_surface(scene, name)];
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        vec3 c[3];
        alpi_triangle_corners(scene, s->first_triangle + i, c);
        vec3 normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 0.0f, 0.0f});
        float towards = vec3_dot(normal, vec3_sub(point, c[0]));
        if ((towards > 0.0f) == away) {
            fail_msg("%s: triangle %u faces the wrong way", name, i);
        }
    }
}

TEST(all_are_whole)
{
    for (int n = 0; n < NAME_COUNT; n++) {
        alp_context *context = test_context(1);
        test_log_clear();
        alp_scene *scene = create(context, NAMES[n]);
        alp_scene_info info = alp_scene_get_info(scene);
        assert_string_equal(test_log_text(), ""); // nothing odd was found
        assert_true(info.triangles > 0 && info.triangles == info.usable_triangles);
        assert_true(info.cameras >= 1);
        uint32_t vertices = 0, triangles = 0;
        for (uint32_t i = 0; i < info.surfaces; i++) {
            const alpi_surface *s = &scene->surfaces[i];
            assert_int_equal(s->first_vertex, vertices);
            assert_int_equal(s->first_triangle, triangles);
            assert_true(s->triangle_count > 0 && s->material < info.materials);
            vertices += s->vertex_count;
            triangles += s->triangle_count;
        }
        assert_int_equal(vertices, info.vertices);
        assert_int_equal(triangles, info.triangles);
        for (uint32_t i = 0; i < info.materials; i++) {
            const float *color = scene->materials[i].base_color;
            assert_true(color[0] > 0.0f && color[0] <= 0.95f && color[1] <= 0.95f);
        }
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

TEST(shading_normals_follow_the_winding)
{
    for (int n = 0; n < NAME_COUNT; n++) {
        alp_context *context = test_context(1);
        alp_scene *scene = create(context, NAMES[n]);
        for (uint32_t t = 0; t < scene->triangle_count; t++) {
            vec3 c[3];
            alpi_triangle_corners(scene, t, c);
            vec3 face = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 0.0f, 0.0f});
            for (int k = 0; k < 3; k++) {
                vec3 normal = vec3_load(scene->normals[scene->triangles[t][k]]);
                ASSERT_NEAR(vec3_length(normal), 1.0, 1e-6);
                if (vec3_dot(face, normal) < 0.3f) { // the lip of the spout is sharp
                    fail_msg("%s: triangle %u: normal turned away from the face", NAMES[n], t);
                }
            }
        }
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

TEST(the_same_every_time)
{
    uint64_t hashes[NAME_COUNT];
    for (int n = 0; n < NAME_COUNT; n++) {
        alp_context *one = test_context(1), *seven = test_context(7);
        alp_scene *a = create(one, NAMES[n]), *b = create(seven, NAMES[n]);
        hashes[n] = a->input_hash;
        assert_true(a->input_hash == b->input_hash);
        assert_memory_equal(a->positions, b->positions, a->vertex_count * sizeof *a->positions);
        assert_memory_equal(a->triangles, b->triangles, a->triangle_count * sizeof *a->triangles);
        for (int k = 0; k < n; k++) {
            assert_true(hashes[k] != hashes[n]);
        }
        alp_scene_destroy(a);
        alp_scene_destroy(b);
        alp_context_destroy(one);
        alp_context_destroy(seven);
    }
}

static void assert_bounds(const alp_scene *scene, const double low[3], const double high[3])
{
    alp_scene_info info = alp_scene_get_info(scene);
    for (int k = 0; k < 3; k++) {
        ASSERT_NEAR(info.bounds_min[k], low[k], 1e-6);
        ASSERT_NEAR(info.bounds_max[k], high[k], 1e-6);
    }
}

TEST_WITH_CONTEXT(closed_forms_hold, 1)
{
    alp_scene *scene = create(context, "furnace");
    ASSERT_NEAR(alp_scene_get_info(scene).area, 6.0, 1e-12);
    ASSERT_NEAR(signed_volume(scene, "furnace"), -1.0, 1e-6); // seen from inside
    assert_bounds(scene, (const double[3]){0, 0, 0}, (const double[3]){1, 1, 1});
    ASSERT_NEAR(scene->materials[0].emission[1], 1.0, 0.0);
    ASSERT_NEAR(scene->materials[0].base_color[1], 0.5, 0.0);
    alp_scene_destroy(scene);

    scene = create(context, "bowl"); // zone of a sphere: 2π r h
    ASSERT_NEAR(alp_scene_get_info(scene).area, 2.0 * ALPI_PI * 1.5, 2e-3);
    assert_faces(scene, "bowl", (vec3){0.0f, 0.0f, 0.0f}, false);
    assert_bounds(scene, (const double[3]){-1, -1, -1}, (const double[3]){1, 0.5, 1});
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        ASSERT_NEAR(vec3_length(vec3_load(scene->positions[v])), 1.0, 1e-6);
    }
    alp_scene_destroy(scene);

    scene = create(context, "sphere-plane");
    ASSERT_NEAR(surface_area(scene, "ground"), 16.0, 1e-12);
    ASSERT_NEAR(surface_area(scene, "sphere"), ALPI_PI, 3e-3);
    ASSERT_NEAR(signed_volume(scene, "sphere"), ALPI_PI / 6.0, 1e-3);
    assert_faces(scene, "sphere", (vec3){0.0f, 0.5f, 0.0f}, true);
    assert_faces(scene, "ground", (vec3){0.0f, 1.0f, 0.0f}, false);
    assert_bounds(scene, (const double[3]){-2, 0, -2}, (const double[3]){2, 1, 2});
    alp_scene_destroy(scene);

    scene = create(context, "torus-plane"); // Pappus: 4π² R r and 2π² R r²
    ASSERT_NEAR(surface_area(scene, "torus"), 4.0 * ALPI_PI * ALPI_PI * 0.6 * 0.25, 8e-3);
    ASSERT_NEAR(signed_volume(scene, "torus"), 2.0 * ALPI_PI * ALPI_PI * 0.6 * 0.0625, 2e-3);
    assert_bounds(scene, (const double[3]){-2, 0, -2}, (const double[3]){2, 0.5, 2});
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(the_cornell_box_is_the_measured_one, 1)
{
    alp_scene *scene = create(context, "cornell");
    assert_bounds(scene, (const double[3]){0, 0, 0}, (const double[3]){0.556, 0.5488, 0.5592});
    ASSERT_NEAR(surface_area(scene, "lamp"), 0.130 * 0.105, 1e-8);
    ASSERT_NEAR(surface_area(scene, "ceiling"), 0.556 * 0.5592 - 0.130 * 0.105, 1e-8);
    ASSERT_NEAR(surface_area(scene, "green wall"), 0.5592 * 0.5488, 5e-8);
    ASSERT_NEAR(surface_area(scene, "floor"), 0.5592 * (0.5528 + 0.5496) / 2.0, 1e-8);
    const vec3 middle = {0.278f, 0.5f, 0.2796f};
    const char *const inward[] = {"floor",      "ceiling",  "back wall",
                                  "green wall", "red wall", "lamp"};
    for (int i = 0; i < 6; i++) {
        assert_faces(scene, inward[i], middle, false);
    }
    assert_faces(scene, "short block", (vec3){0.1855f, 0.08f, 0.169f}, true);
    assert_faces(scene, "tall block", (vec3){0.3685f, 0.16f, 0.35125f}, true);

    // The red wall is on the left of the picture, the green one on its right.
    alp_camera camera = alp_scene_get_camera(scene, 0);
    vec3 eye = vec3_load(camera.position);
    vec3 right = vec3_cross(vec3_sub(vec3_load(camera.target), eye), vec3_load(camera.up));
    assert_true(vec3_dot(right, vec3_sub((vec3){0.556f, 0.3f, 0.3f}, eye)) < 0.0f);
    uint32_t red = scene->surfaces[find_surface(scene, "red wall")].first_triangle;
    vec3 corner[3];
    alpi_triangle_corners(scene, red, corner);
    assert_true(vec3_dot(right, vec3_sub(corner[0], eye)) < 0.0f);
    ASSERT_NEAR(alpi_surface_albedo(scene, red, 0.3f, 0.3f).x, 0.49389, 1e-6);
    ASSERT_NEAR((double)camera.vertical_fov * 180.0 / ALPI_PI, 39.3077, 1e-4);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(unknown_names_are_told_what_exists, 1)
{
    alp_scene *scene = NULL;
    assert_int_equal(alpi_builtin_create(context, "teapot", &scene), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(scene);
    for (int n = 0; n < NAME_COUNT; n++) {
        assert_non_null(strstr(alp_context_message(context), NAMES[n]));
    }
}

TEST(every_failed_allocation_is_reported)
{
    int allocations_left = 0;
    alp_context *context = test_context_failing(&allocations_left);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int allowed = 0;
    for (; result != ALP_OK; allowed++) {
        allocations_left = allowed;
        alp_scene *scene = NULL;
        result = alpi_builtin_create(context, "cornell", &scene);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_true((scene != NULL) == (result == ALP_OK));
        alp_scene_destroy(scene);
    }
    assert_in_range(allowed, 20, 200);
    alp_context_destroy(context);
}
