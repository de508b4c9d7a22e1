// SPDX-License-Identifier: MIT
// What finishing a scene repairs, leaves out, clamps and says.
#include "test_support.h"

#include "base/image.h"
#include "base/memory.h"
#include "scene/builtin/mesh_builder.h"

#include <math.h>

static const vec3 UP = {0.0f, 1.0f, 0.0f};

static void start(alpi_builder *builder, alp_context *context)
{
    test_log_clear();
    alpi_builder_start(builder, context, "odd scene");
    uint32_t grey =
        alpi_builder_material(builder, "grey", (vec3){0.5f, 0.5f, 0.5f}, (vec3){0.0f, 0.0f, 0.0f});
    alpi_builder_surface(builder, "odd mesh", grey);
}

/// A right triangle in the plane y = 0 with legs of length `size`, normals as given.
static void add_triangle(alpi_builder *builder, float size, vec3 normal)
{
    uint32_t a = alpi_builder_vertex(builder, (vec3){0.0f, 0.0f, 0.0f}, normal);
    alpi_builder_vertex(builder, (vec3){0.0f, 0.0f, size}, normal);
    alpi_builder_vertex(builder, (vec3){size, 0.0f, 0.0f}, normal);
    alpi_builder_triangle(builder, a, a + 1, a + 2);
}

static alp_scene *finish(alpi_builder *builder)
{
    alp_scene *scene = NULL;
    ASSERT_OK(builder->context, alpi_builder_finish(builder, &scene));
    return scene;
}

TEST_WITH_CONTEXT(a_good_scene_says_nothing, 1)
{
    alpi_builder builder;
    start(&builder, context);
    add_triangle(&builder, 2.0f, UP);
    alp_scene *scene = finish(&builder);
    assert_string_equal(test_log_text(), "");
    ASSERT_NEAR(scene->area, 2.0, 1e-15);
    ASSERT_NEAR(scene->bounds_max.x, 2.0, 0.0);
    ASSERT_NEAR(scene->bounds_min.y, 0.0, 0.0);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(triangles_without_area_are_left_out, 1)
{
    alpi_builder builder;
    start(&builder, context);
    add_triangle(&builder, 2.0f, UP);
    alpi_builder_triangle(&builder, 0, 1, 1);
    uint32_t far = alpi_builder_vertex(&builder, (vec3){0.0f, 0.0f, 9.0f}, UP);
    alpi_builder_triangle(&builder, 0, 1, far); // on one line: 0, 2, 9
    add_triangle(&builder, 1e-12f, UP);         // tiny is not degenerate
    alp_scene *scene = finish(&builder);
    assert_int_equal(scene->triangle_count, 4);
    assert_int_equal(scene->usable_count, 2);
    assert_true(scene->triangle_usable[0] && scene->triangle_usable[3]);
    assert_true(test_log_has("zero-area"));
    assert_non_null(strstr(test_log_text(), "have no area: 2 of 4, in 1 surface\n"));
    ASSERT_NEAR(scene->bounds_max.z, 2.0, 0.0); // the bounds do not see it
    alp_scene_destroy(scene);
}

TEST(coordinates_that_are_no_numbers)
{
    const float bad[] = {NAN, INFINITY, -INFINITY, 2e15f, -3e38f};
    for (int i = 0; i < 5; i++) {
        alp_context *context = test_context(1);
        alpi_builder builder;
        start(&builder, context);
        add_triangle(&builder, 2.0f, UP);
        uint32_t vertex = alpi_builder_vertex(&builder, (vec3){0.0f, bad[i], 0.0f}, UP);
        alpi_builder_triangle(&builder, 1, 2, vertex);
        alp_scene *scene = finish(&builder);
        assert_int_equal(scene->usable_count, 1);
        assert_false(scene->triangle_usable[1]);
        assert_true(test_log_has("bad-coordinates"));
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(scene->positions[vertex][k], 0.0, 0.0);
        }
        ASSERT_NEAR(scene->area, 2.0, 1e-15);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

TEST(bad_normals_become_the_triangles)
{
    const vec3 bad[] = {{0.0f, 0.0f, 0.0f}, {NAN, 0.0f, 1.0f}, {INFINITY, 0.0f, 0.0f}};
    for (int i = 0; i < 3; i++) {
        alp_context *context = test_context(1);
        alpi_builder builder;
        start(&builder, context);
        // The first triangle at the vertices has no area, so it must not be the one that is asked.
        add_triangle(&builder, 2.0f, bad[i]);
        builder.scene->triangles[0][2] = 1;
        alpi_builder_triangle(&builder, 0, 2, 1);
        alp_scene *scene = finish(&builder);
        for (uint32_t v = 0; v < 3; v++) {
            ASSERT_NEAR(scene->normals[v][1], -1.0, 0.0); // turned: it looks down
        }
        assert_true(test_log_has("bad-normals"));
        assert_non_null(strstr(test_log_text(), "3 normals"));
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

TEST_WITH_CONTEXT(normals_become_unit, 1)
{
    alpi_builder builder;
    start(&builder, context);
    add_triangle(&builder, 2.0f, (vec3){0.0f, 1e-30f, 0.0f});
    alpi_builder_vertex(&builder, UP, (vec3){NAN, NAN, NAN}); // of no triangle
    alp_scene *scene = finish(&builder);
    for (uint32_t v = 0; v < 4; v++) {
        ASSERT_NEAR(scene->normals[v][1], 1.0, 0.0);
    }
    assert_false(test_log_has("bad-normals"));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(materials_are_clamped, 1)
{
    alpi_builder builder;
    start(&builder, context);
    add_triangle(&builder, 2.0f, UP);
    alpi_material *material = &builder.scene->materials[0];
    material->base_color[0] = 1.5f;
    material->base_color[1] = -0.5f;
    material->base_color[2] = NAN;
    material->metallic = 2.0f;
    material->emission[0] = -1.0f;
    material->occlusion_strength = 7.0f;
    material->transmission = NAN;
    alp_scene *scene = finish(&builder);
    material = &scene->materials[0];
    ASSERT_NEAR(material->base_color[0], 1.0, 0.0);
    ASSERT_NEAR(material->base_color[1], 0.0, 0.0);
    ASSERT_NEAR(material->base_color[2], 0.0, 0.0);
    ASSERT_NEAR(material->metallic, 1.0, 0.0);
    ASSERT_NEAR(material->emission[0], 0.0, 0.0);
    ASSERT_NEAR(material->occlusion_strength, 1.0, 0.0);
    ASSERT_NEAR(material->transmission, 0.0, 0.0);
    assert_true(test_log_has("material-range"));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(albedo_has_a_limit, 1)
{
    alpi_builder builder;
    start(&builder, context);
    add_triangle(&builder, 2.0f, UP);
    builder.scene->materials[0].base_color[0] = 1.0f;
    alp_scene *scene = finish(&builder);
    assert_string_equal(test_log_text(), ""); // white is in range
    ASSERT_NEAR(alpi_surface_albedo(scene, 0, 0.2f, 0.2f).x, 0.95, 1e-7);
    scene->surfaces[0].material = ALPI_NONE;
    ASSERT_NEAR(alpi_surface_albedo(scene, 0, 0.2f, 0.2f).x, 0.5, 0.0);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(far_from_the_origin_is_said, 1)
{
    alpi_builder builder;
    start(&builder, context);
    add_triangle(&builder, 2.0f, UP);
    for (int v = 0; v < 3; v++) {
        builder.scene->positions[v][0] += 32000.0f;
    }
    alp_scene *scene = finish(&builder);
    assert_true(test_log_has("precision"));
    assert_non_null(strstr(test_log_text(), "are 0.002 m apart")); // 2^14 · 2^-23, up to 2^15
    alp_scene_destroy(scene);
}

TEST(indices_out_of_range_are_errors)
{
    for (int i = 0; i < 2; i++) {
        alp_context *context = test_context(1);
        alpi_builder builder;
        start(&builder, context);
        add_triangle(&builder, 2.0f, UP);
        if (i == 0) {
            builder.scene->triangles[0][1] = 3;
        } else {
            builder.scene->surfaces[0].material = 1;
        }
        alp_scene *scene = NULL;
        assert_int_equal(alpi_builder_finish(&builder, &scene), ALP_ERROR_INVALID_DATA);
        assert_null(scene);
        assert_non_null(strstr(alp_context_message(context), "odd scene"));
        alp_context_destroy(context);
    }
}

/// Metals by default are warned of, where they have a colour and more than half of the area.
TEST_WITH_CONTEXT(a_metal_scene_says_so, 1)
{
    static const struct {
        float metallic, color;
        bool assumed, told;
    } cases[] = {{0.9f, 1.0f, true, true},
                 {0.89f, 1.0f, true, false},
                 {0.9f, 0.0f, true, false},
                 {1.0f, 1.0f, false, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alpi_builder builder;
        start(&builder, context);
        add_triangle(&builder, 2.0f, UP);
        alp_scene *scene = finish(&builder);
        alpi_material *m = &scene->materials[0];
        m->metallic = cases[i].metallic;
        m->metallic_assumed = cases[i].assumed;
        m->base_color[0] = m->base_color[1] = m->base_color[2] = cases[i].color;
        test_log_clear();
        alpi_scene_warn_of_metal(scene);
        assert_int_equal(test_log_has("metal"), cases[i].told);
        alp_scene_destroy(scene);
    }
}
