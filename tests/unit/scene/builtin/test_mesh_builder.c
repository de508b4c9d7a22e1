// SPDX-License-Identifier: MIT
// The shapes that scenes are built of: which way they face, how large they are, what is left out.
#include "test_support.h"

#include "scene/builtin/mesh_builder.h"

#include <math.h>

static alpi_builder start(alp_context *context)
{
    alpi_builder builder;
    alpi_builder_start(&builder, context, "shapes");
    vec3 grey = {0.5f, 0.5f, 0.5f}, dark = {0.0f, 0.0f, 0.0f};
    alpi_builder_surface(&builder, "shape", alpi_builder_material(&builder, "grey", grey, dark));
    return builder;
}

static alp_scene *finish(alpi_builder *builder)
{
    alp_scene *scene = NULL;
    ASSERT_OK(builder->context, alpi_builder_finish(builder, &scene));
    return scene;
}

static double signed_volume(const alp_scene *scene)
{
    double volume = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        volume += (double)vec3_dot(c[0], vec3_cross(c[1], c[2])) / 6.0;
    }
    return volume;
}

TEST_WITH_CONTEXT(each_face_of_a_box, 1)
{
    const vec3 low = {1.0f, 2.0f, 3.0f}, high = {2.0f, 4.0f, 6.0f};
    const float sides[6] = {low.x, high.x, low.y, high.y, low.z, high.z};
    for (int face = 0; face < 6; face++) {
        for (int inside = 0; inside < 2; inside++) {
            alpi_builder builder = start(context);
            alpi_builder_box(&builder, inside ? high : low, inside ? low : high, 1u << face);
            alp_scene *scene = finish(&builder);
            assert_int_equal(scene->triangle_count, 2);
            vec3 c[3];
            alpi_triangle_corners(scene, 0, c);
            vec3 n = vec3_triangle_normal(c[0], c[1], c[2], low);
            const float normal[3] = {n.x, n.y, n.z};
            float outward = (face & 1) == inside ? -1.0f : 1.0f;
            ASSERT_NEAR(normal[face / 2], outward, 0.0);
            for (uint32_t v = 0; v < 4; v++) {
                ASSERT_NEAR(scene->positions[v][face / 2], sides[face], 0.0);
                ASSERT_NEAR(scene->normals[v][face / 2], outward, 0.0);
            }
            alp_scene_destroy(scene);
        }
    }
    alpi_builder builder = start(context);
    alpi_builder_box(&builder, low, high, ALPI_FACE_ALL);
    alp_scene *scene = finish(&builder);
    ASSERT_NEAR(signed_volume(scene), 6.0, 1e-5);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_panel_has_a_hole, 1)
{
    static const float across[] = {0.0f, 1.0f, 3.0f}, up[] = {0.0f, 2.0f, 2.5f};
    alpi_panel panel = {.origin = {0.0f, 0.0f, 5.0f},
                        .u = {1.0f, 0.0f, 0.0f},
                        .v = {0.0f, 1.0f, 0.0f},
                        .u_cuts = across,
                        .v_cuts = up,
                        .u_count = 3,
                        .v_count = 3,
                        .hole_u = 1,
                        .hole_v = 0};
    alpi_builder builder = start(context);
    alpi_builder_panel(&builder, &panel);
    alp_scene *scene = finish(&builder);
    assert_int_equal(scene->triangle_count, 6);
    ASSERT_NEAR(scene->area, 3.0 * 2.5 - 2.0 * 2.0, 1e-12);
    ASSERT_NEAR(scene->normals[0][2], 1.0, 0.0); // u × v
    alp_scene_destroy(scene);
    panel.hole_u = panel.hole_v = ALPI_NONE;
    builder = start(context);
    alpi_builder_panel(&builder, &panel);
    scene = finish(&builder);
    ASSERT_NEAR(scene->area, 7.5, 1e-12);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_lathe_turns_a_cup, 1)
{
    // A closed cup: radius 2 and height 3 outside, radius 1 and depth 2 inside. The section of n
    // sides has the area n/2 sin(2π/n) r².
    static const float cup[][2] = {{0, 0}, {2, 0}, {2, 3}, {1, 3}, {1, 1}, {0, 1}};
    const uint32_t slices = 24;
    alpi_builder builder = start(context);
    alpi_builder_lathe(&builder, &(alpi_lathe){{10.0f, 0.0f, 0.0f}, cup, 6, slices});
    alp_scene *scene = finish(&builder);
    double section = 0.5 * slices * sin(2.0 * ALPI_PI / slices);
    ASSERT_NEAR(signed_volume(scene), section * (4.0 * 3.0 - 1.0 * 2.0), 1e-4);
    assert_int_equal(scene->triangle_count, slices * (1 + 2 + 2 + 2 + 1));
    assert_int_equal(scene->usable_count, scene->triangle_count);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        vec3 face = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 0.0f, 0.0f});
        for (int k = 0; k < 3; k++) {
            assert_true(vec3_dot(face, vec3_load(scene->normals[scene->triangles[t][k]])) > 0.98f);
        }
    }
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(balls_and_rings_converge, 1)
{
    double last = 1e30;
    for (uint32_t n = 8; n <= 128; n *= 2) {
        alpi_builder builder = start(context);
        alpi_builder_ball(&builder,
                          &(alpi_ball){.radius = 2.0f, .top = 2.0f, .slices = n, .stacks = n / 2});
        alp_scene *scene = finish(&builder);
        double error = 16.0 * ALPI_PI - scene->area; // the facets lie inside
        assert_true(error > 0.0 && error < 0.3 * last);
        last = error;
        alp_scene_destroy(scene);
    }
    last = 1e30;
    for (uint32_t n = 8; n <= 128; n *= 2) {
        alpi_builder builder = start(context);
        alpi_builder_ring(
            &builder,
            &(alpi_ring){.major_radius = 2.0f, .minor_radius = 0.5f, .slices = n, .sides = n});
        alp_scene *scene = finish(&builder);
        double error = fabs(4.0 * ALPI_PI * ALPI_PI * 2.0 * 0.5 - scene->area);
        assert_true(error < 0.3 * last);
        assert_true(signed_volume(scene) > 0.0);
        last = error;
        alp_scene_destroy(scene);
    }
}
