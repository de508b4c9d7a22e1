// SPDX-License-Identifier: MIT
// The limit of rays of a default bake, and passes that mix the light of those before.
#include "test_support.h"

#include "scene/builtin/mesh_builder.h"

#include <math.h>

TEST_CONTEXT(2);

/// As many rays as the limit, and what it says then.
TEST_SLOW(a_bounded_bake_ends_by_its_rays)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_bake_options o = test_light_options(64);
    alp_bake_report report;
    o.light.error = 0.0002f;
    o.light.bounded = true;
    test_log_clear();
    ASSERT_OK(context, alp_bake(scene, &o, NULL, &report));
    print_message("%.3g million rays, stated error %.2f %%\n", 1e-6 * (double)report.rays,
                  100.0 * report.light_relative_error);
    assert_true(report.light_bounded);
    assert_true(report.light_relative_error > 0.0002);
    assert_true(test_log_has("ray-limit") && strstr(test_log_text(), "--error 0.02") != NULL);
    assert_true((double)report.rays < 1.5 * 0x1p27); // 1,024 rays for each of 2¹⁷ texels, about
    alp_scene_destroy(scene);
}

/// An error that is reached before says nothing.
TEST(a_bounded_bake_that_needs_few_rays_is_as_any_other)
{
    uint64_t rays[2];
    for (int i = 0; i < 2; i++) {
        alp_scene *scene = test_load(context, "builtin:cornell");
        alp_bake_options o = test_light_options(48);
        alp_bake_report report;
        o.light.error = 0.03f;
        o.light.bounded = i == 1;
        ASSERT_OK(context, alp_bake(scene, &o, NULL, &report));
        assert_false(report.light_bounded);
        rays[i] = report.rays;
        alp_scene_destroy(scene);
    }
    assert_int_equal(rays[0], rays[1]);
    assert_false(test_log_has("ray-limit"));
}

/// A closed room of albedo .9 with a pane, through which rays cannot be kept.
static alp_scene *make_room(void)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 dark = {0.0f, 0.0f, 0.0f};
    alpi_builder_start(&b, context, "room");
    const uint32_t white = alpi_builder_material(&b, "white", (vec3){0.9f, 0.9f, 0.9f}, dark);
    alpi_builder_surface(&b, "room", white);
    alpi_builder_box(&b, (vec3){1, 1, 1}, (vec3){-1, -1, -1}, ALPI_FACE_ALL); // seen from inside
    const uint32_t glass = alpi_builder_material(&b, "glass", (vec3){0.9f, 0.9f, 0.9f}, dark);
    b.scene->materials[glass].alpha_mode = ALPI_ALPHA_BLEND;
    b.scene->materials[glass].base_color[3] = 0.2f;
    b.scene->materials[glass].double_sided = true;
    alpi_builder_surface(&b, "pane", glass);
    alpi_builder_quad(&b, (const vec3[4]){{-0.5f, -0.5f, 0.1f},
                                          {0.5f, -0.5f, 0.1f},
                                          {0.5f, 0.5f, 0.1f},
                                          {-0.5f, 0.5f, 0.1f}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// Mixed passes find the light of many plain ones (a number of bounces has plain passes).
TEST(mixed_passes_find_the_light_of_plain_ones)
{
    double mean[2];
    uint32_t passes[2];
    for (int i = 0; i < 2; i++) {
        alp_scene *scene = make_room();
        alp_lamp lamp = alp_lamp_default();
        lamp.intensity = 10.0f;
        alp_bake_options o = test_light_options(24);
        alp_bake_report report;
        o.light.lighting.lamps = &lamp;
        o.light.lighting.lamp_count = 1;
        o.light.samples = 64;
        o.light.bounces = i == 0 ? 120 : ALP_BOUNCES_CONVERGE;
        ASSERT_OK(context, alp_bake(scene, &o, NULL, &report));
        mean[i] = report.light_mean;
        passes[i] = report.light_passes;
        alp_scene_destroy(scene);
    }
    print_message("%u plain passes: %.4f W/m2, %u mixed ones: %.4f\n", passes[0], mean[0],
                  passes[1], mean[1]);
    ASSERT_NEAR(mean[1], mean[0], 0.002 * mean[0]);
    assert_true(passes[1] < 30);
}
