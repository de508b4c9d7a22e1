// SPDX-License-Identifier: MIT
// Scenes with fewer triangles: shapes, borders, seams, and what is copied.
#include "test_support.h"

#include "base/memory.h"
#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

TEST_CONTEXT(1);

enum { CELLS = 24 };

static uint32_t grey(alpi_builder *b)
{
    return alpi_builder_material(b, "grey", (vec3){0.5f, 0.5f, 0.5f}, (vec3){0.0f, 0.0f, 0.0f});
}

/// Height of test ground: even, or with bumps of 30 cm.
static float height_at(float x, float z, bool bumps)
{
    return bumps ? 0.3f * sinf(2.0f * x) * cosf(2.3f * z) : 0.0f;
}

/// CELLS × CELLS quads of 24 m × 24 m from (x, z), seen from above, each with its own vertices.
static void build_ground(alpi_builder *b, float x, bool bumps)
{
    for (int i = 0; i < CELLS * CELLS; i++) {
        vec3 corners[4];
        for (int k = 0; k < 4; k++) {
            static const int order[4][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
            const float cx = x + (float)(i % CELLS + order[k][0]);
            const float cz = (float)(i / CELLS + order[k][1]);
            corners[k] = (vec3){cx, height_at(cx, cz, bumps), cz};
        }
        alpi_builder_quad(b, corners);
    }
}

static alp_scene *simplify(const alp_scene *scene, float error)
{
    alp_scene *simple = NULL;
    ASSERT_OK(context, alp_scene_simplify(scene, error, &simple));
    return simple;
}

TEST(even_ground_needs_few_triangles)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "ground");
    alpi_builder_surface(&b, "ground", grey(&b));
    build_ground(&b, 0.0f, false);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    alp_scene *simple = simplify(scene, 0.01f);
    assert_in_range(simple->triangle_count, 2, 8);
    ASSERT_NEAR(simple->area, scene->area, 1e-3);
    ASSERT_NEAR(simple->bounds_max.x, 24.0, 0.0);
    ASSERT_NEAR(simple->bounds_min.z, 0.0, 0.0);
    for (uint32_t v = 0; v < simple->vertex_count; v++) {
        ASSERT_NEAR(simple->normals[v][1], 1.0, 0.0);
    }
    assert_true(simple->vertex_count <= simple->triangle_count + 2);
    alp_scene_destroy(simple);
    alp_scene_destroy(scene);
}

/// Vertices of a simplified ball lie on it, sides near it, and it stays closed.
TEST(a_ball_stays_a_ball)
{
    static const float errors[] = {0.2f, 0.05f, 0.01f};
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "ball");
    alpi_builder_surface(&b, "ball", grey(&b));
    alpi_builder_ball(&b, &(alpi_ball){.radius = 2.0f, .top = 2.0f, .slices = 96, .stacks = 48});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    uint32_t last = 0;
    for (int i = 0; i < 3; i++) {
        alp_scene *simple = simplify(scene, errors[i]);
        double volume = 0.0;
        assert_in_range(simple->triangle_count, last + 8, scene->triangle_count / 4);
        last = simple->triangle_count;
        for (uint32_t t = 0; t < simple->triangle_count; t++) {
            vec3 c[3];
            alpi_triangle_corners(simple, t, c);
            const vec3 middle = vec3_scale(vec3_add(c[0], vec3_add(c[1], c[2])), 1.0f / 3.0f);
            for (int k = 0; k < 3; k++) {
                ASSERT_NEAR(vec3_length(c[k]), 2.0, 1e-3);
            }
            assert_true(vec3_length(middle) > 2.0f - 4.0f * errors[i]);
            volume += (double)vec3_dot(c[0], vec3_cross(c[1], c[2])) / 6.0;
        }
        const double whole = 4.0 / 3.0 * 3.14159265 * 8.0;
        assert_true(volume > whole * (1.0 - 3.0 * (double)errors[i]) && volume < whole);
        alp_scene_destroy(simple);
    }
    alp_scene_destroy(scene);
}

static uint32_t count_at(const alp_scene *scene, uint32_t surface, float x)
{
    const alpi_surface *s = &scene->surfaces[surface];
    bool seen[CELLS + 1] = {false};
    uint32_t count = 0;
    for (uint32_t v = s->first_vertex; v < s->first_vertex + s->vertex_count; v++) {
        const float *p = scene->positions[v];
        const int z = (int)(p[2] + 0.5f);
        if (p[0] == x && !seen[z]) {
            seen[z] = true;
            count++;
        }
    }
    return count;
}

/// Two grounds that touch at x = 24 m keep all places there, so no gap opens; far ones do not.
TEST(borders_that_touch_stay)
{
    for (int apart = 0; apart < 2; apart++) {
        alpi_builder b;
        alp_scene *scene = NULL;
        alpi_builder_start(&b, context, "grounds");
        const uint32_t material = grey(&b);
        alpi_builder_surface(&b, "west", material);
        build_ground(&b, 0.0f, true);
        alpi_builder_surface(&b, "east", material);
        build_ground(&b, apart != 0 ? 25.0f : 24.0f, true);
        ASSERT_OK(context, alpi_builder_finish(&b, &scene));
        alp_scene *simple = simplify(scene, 0.5f);
        const uint32_t west = count_at(simple, 0, 24.0f);
        const uint32_t east = count_at(simple, 1, apart != 0 ? 25.0f : 24.0f);
        if (apart != 0) {
            assert_true(west < CELLS / 2 && east < CELLS / 2);
        } else {
            assert_int_equal(west, CELLS + 1);
            assert_int_equal(east, CELLS + 1);
        }
        assert_true(simple->triangle_count < scene->triangle_count / 2);
        assert_int_equal(simple->surfaces[1].first_triangle, simple->surfaces[0].triangle_count);
        alp_scene_destroy(simple);
        alp_scene_destroy(scene);
    }
}

/// A thousand closed leaves smaller than the error hold back light together.
TEST(leaves_keep_most_of_their_area)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "leaves");
    alpi_builder_surface(&b, "leaves", grey(&b));
    for (int i = 0; i < 1000; i++) {
        const vec3 at = {0.3f * (float)(i % 10), 0.3f * (float)(i / 10 % 10),
                         0.3f * (float)(i / 100)};
        alpi_builder_ball(
            &b, &(alpi_ball){.center = at, .radius = 0.1f, .top = 0.1f, .slices = 8, .stacks = 6});
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    alp_scene *simple = simplify(scene, 1.0f);
    assert_true(simple->area >= 0.8 * scene->area);
    alp_scene_destroy(simple);
    alp_scene_destroy(scene);
}

/// Sides of a box keep their own normals, though its corners are one vertex for the simplifier.
TEST(edges_stay_sharp)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "box");
    alpi_builder_surface(&b, "box", grey(&b));
    alpi_builder_box(&b, (vec3){-3.0f, -3.0f, -3.0f}, (vec3){3.0f, 3.0f, 3.0f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    alp_scene *simple = simplify(scene, 0.1f);
    assert_int_equal(simple->triangle_count, 12);
    for (uint32_t t = 0; t < 12; t++) {
        vec3 c[3];
        alpi_triangle_corners(simple, t, c);
        const vec3 face = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 0.0f, 0.0f});
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(vec3_dot(face, vec3_load(simple->normals[simple->triangles[t][k]])), 1.0,
                        1e-6);
        }
    }
    alp_scene_destroy(simple);
    alp_scene_destroy(scene);
}

/// Ground whose texture coordinates jump at x = 12 m: (x, z) on one side, (x + 100, z) on the
/// other.
static alp_scene *seamed_ground(bool textured)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "ground");
    alpi_builder_surface(&b, "ground", grey(&b));
    build_ground(&b, 0.0f, false);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    scene->uvs[0] = alpi_allocate(context, scene->vertex_count, sizeof *scene->uvs[0]);
    assert_non_null(scene->uvs[0]);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        const bool east = (c[0].x + c[1].x + c[2].x) / 3.0f > 12.0f;
        for (int k = 0; k < 3; k++) {
            float *uv = scene->uvs[0][scene->triangles[t][k]];
            uv[0] = c[k].x + (east ? 100.0f : 0.0f);
            uv[1] = c[k].z;
        }
    }
    scene->materials[0].base_color_texture.image = textured ? 0 : ALPI_NONE;
    return scene;
}

TEST(seams_of_textures_stay)
{
    for (int textured = 0; textured < 2; textured++) {
        alp_scene *scene = seamed_ground(textured != 0), *simple = simplify(scene, 0.1f);
        uint32_t wrong = 0;
        for (uint32_t t = 0; t < simple->triangle_count; t++) {
            vec3 c[3];
            alpi_triangle_corners(simple, t, c);
            const bool east = (c[0].x + c[1].x + c[2].x) / 3.0f > 12.0f;
            for (int k = 0; k < 3; k++) {
                const float *uv = simple->uvs[0][simple->triangles[t][k]];
                wrong += fabsf(uv[0] - c[k].x - (east ? 100.0f : 0.0f)) > 1e-4f;
                wrong += fabsf(uv[1] - c[k].z) > 1e-4f;
            }
        }
        assert_true(simple->triangle_count <= 16);
        if (textured != 0) { // else nobody reads them
            assert_int_equal(wrong, 0);
        }
        alp_scene_destroy(simple);
        alp_scene_destroy(scene);
    }
}

TEST(all_else_is_copied)
{
    alp_scene *scene = test_load(context, "builtin:cornell"), *simple = NULL;
    const alp_image_info two = {.width = 2, .height = 1, .channels = 3};
    scene->images = alpi_allocate(context, 2, sizeof *scene->images); // the first is not there
    assert_non_null(scene->images);
    scene->image_count = 2;
    ASSERT_OK(context, alp_image_create(context, two, &scene->images[1]));
    memcpy(alp_image_bytes(scene->images[1]), "colour", 6);
    scene->unit_metres = 0.01;
    scene->origin[1] = 7.0;
    simple = simplify(scene, 1e-4f);
    const alp_scene_info a = alp_scene_get_info(scene), c = alp_scene_get_info(simple);
    assert_int_equal(c.surfaces, a.surfaces);
    assert_int_equal(c.materials, a.materials);
    assert_int_equal(c.cameras, a.cameras);
    assert_int_equal(c.lights, a.lights);
    assert_true(c.hash == a.hash && c.unit_metres == a.unit_metres && c.origin[1] == 7.0);
    ASSERT_NEAR(c.area, a.area, 1e-4 * a.area);
    for (uint32_t i = 0; i < a.surfaces; i++) {
        const alp_surface_info before = alp_scene_get_surface(scene, i);
        const alp_surface_info after = alp_scene_get_surface(simple, i);
        assert_string_equal(after.name, before.name);
        assert_string_equal(after.material, before.material);
        assert_memory_equal(after.emission, before.emission, sizeof after.emission);
    }
    assert_memory_equal(&simple->cameras[0], &scene->cameras[0], sizeof scene->cameras[0]);
    alp_scene_destroy(scene); // the other holds nothing of it
    assert_true(simple->image_count == 2 && simple->images[0] == NULL);
    assert_memory_equal(alp_image_bytes(simple->images[1]), "colour", 6);
    alp_scene_destroy(simple);
}

TEST(errors_that_are_none_are_refused)
{
    static const float bad[] = {0.0f, -1.0f, NAN, INFINITY};
    alp_scene *scene = test_load(context, "builtin:cornell"), *simple = scene;
    for (int i = 0; i < 4; i++) {
        assert_int_equal(alp_scene_simplify(scene, bad[i], &simple), ALP_ERROR_INVALID_ARGUMENT);
        assert_null(simple);
    }
    assert_int_equal(alp_scene_simplify(NULL, 1.0f, &simple), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_scene_simplify(scene, 1.0f, NULL), ALP_ERROR_INVALID_ARGUMENT);
    alp_scene_destroy(scene);
}

/// Each allocation fails once.
TEST(memory_that_runs_out)
{
    int left = 1 << 30;
    alp_context *failing = test_context_failing(&left);
    alp_scene *scene = test_load(failing, "builtin:cornell"), *simple = NULL;
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int steps = 0;
    for (; result != ALP_OK; steps++) {
        left = steps;
        result = alp_scene_simplify(scene, 0.1f, &simple);
        assert_true(result == ALP_OK || (result == ALP_ERROR_OUT_OF_MEMORY && simple == NULL));
    }
    assert_true(steps > 20);
    left = 1 << 30;
    alp_scene_destroy(simple);
    alp_scene_destroy(scene);
    alp_context_destroy(failing);
}
