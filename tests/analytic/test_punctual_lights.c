// SPDX-License-Identifier: MIT
// Lamps and suns that nothing hides: E = I/r² and E = E⊥ cosθ.
#include "test_lights.h"

#include "base/memory.h"

#include <math.h>

static const vec3 ORIGIN = {0, 0, 0};

/// A scene with nothing but lights.
static alp_scene *light_scene(alp_context *context, const alpi_light *lights, uint32_t count)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alpi_scene_create(context, "lights", &scene));
    scene->triangle_usable = ALPI_NEW(context, bool, 1);
    scene->lights = ALPI_NEW(context, alpi_light, count);
    assert_non_null(scene->lights);
    memcpy(scene->lights, lights, count * sizeof *lights);
    scene->light_count = count;
    return scene;
}

static alpi_light lamp(vec3 position, float candela)
{
    return (alpi_light){.kind = ALP_LIGHT_POINT,
                        .color = {1.0f, 0.5f, 0.0f},
                        .intensity = candela,
                        .position = position,
                        .range = INFINITY};
}

static alpi_lighting *make(alp_scene *scene, alp_context *context,
                           const alp_lighting_options *options)
{
    alpi_lighting *lighting = NULL;
    ASSERT_OK(context, alpi_lighting_create(scene, options, &lighting));
    return lighting;
}

static void clear(alp_context *context, alp_scene *scene, alpi_lighting *lighting)
{
    alpi_lighting_destroy(context, lighting);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(a_lamp_gives_intensity_over_distance_squared)
{
    alp_context *context = test_context(1);
    const alpi_light light = lamp((vec3){0, 3, 4}, 100.0f);
    alp_scene *scene = light_scene(context, &light, 1);
    alpi_lighting *lighting = make(scene, context, NULL);
    alpi_light_sample s;
    assert_true(alpi_lighting_sample_light(lighting, 0, ORIGIN, (vec2){0, 0}, &s));
    ASSERT_NEAR(s.light.x, 100.0 / 25.0, 1e-6);
    ASSERT_NEAR(s.light.y, 50.0 / 25.0, 1e-6);
    ASSERT_NEAR(s.distance, 5.0, 1e-6);
    ASSERT_NEAR(s.density, 1.0, 0.0);
    // The cosine is the caller's: 3/5.
    ASSERT_ESTIMATE(test_light_estimate(lighting, ORIGIN, (vec3){0, 1, 0}, 10, 0), 4.0 * 0.6);
    assert_false(alpi_lighting_sample(lighting, ORIGIN, (vec3){0, -1, 0}, 0.5f, (vec2){0, 0}, &s));
    assert_false(alpi_lighting_sample_light(lighting, 0, light.position, (vec2){0, 0}, &s));
    assert_false(
        alpi_lighting_sample(lighting, light.position, (vec3){0, 1, 0}, 0.5f, (vec2){0, 0}, &s));
    clear(context, scene, lighting);
}

/// KHR_lights_punctual: clamp(1 − (d/range)⁴) / d².
TEST(a_range_ends_light_without_an_edge)
{
    alp_context *context = test_context(1);
    alpi_light light = lamp(ORIGIN, 16.0f);
    light.range = 4.0f;
    alp_scene *scene = light_scene(context, &light, 1);
    alpi_lighting *lighting = make(scene, context, NULL);
    alpi_light_sample s;
    assert_true(alpi_lighting_sample_light(lighting, 0, (vec3){0, 2, 0}, (vec2){0, 0}, &s));
    ASSERT_NEAR(s.light.x, 16.0 / 4.0 * (1.0 - 1.0 / 16.0), 1e-6);
    assert_false(alpi_lighting_sample_light(lighting, 0, (vec3){0, 4, 0}, (vec2){0, 0}, &s));
    assert_false(alpi_lighting_sample_light(lighting, 0, (vec3){9, 4, 0}, (vec2){0, 0}, &s));
    clear(context, scene, lighting);
}

TEST(a_spot_fades_between_its_cones)
{
    alp_context *context = test_context(1);
    alpi_light light = lamp((vec3){0, 2, 0}, 8.0f);
    light.kind = ALP_LIGHT_SPOT;
    light.direction = (vec3){0, -1, 0};
    light.inner_cone = 0.3f;
    light.outer_cone = 0.6f;
    alp_scene *scene = light_scene(context, &light, 1);
    alpi_lighting *lighting = make(scene, context, NULL);
    const double inner = cos(0.3), outer = cos(0.6);
    for (int i = 0; i < 40; i++) {
        double angle = 0.02 * i;
        vec3 point = {(float)(2.0 * tan(angle)), 0.0f, 0.0f};
        double ramp = fmin(fmax((cos(angle) - outer) / (inner - outer), 0.0), 1.0);
        double expected = 8.0 / (4.0 / (cos(angle) * cos(angle))) * ramp * ramp;
        alpi_light_sample s;
        bool lit = alpi_lighting_sample_light(lighting, 0, point, (vec2){0, 0}, &s);
        assert_true(lit == (expected > 0.0) || fabs(angle - 0.6) < 1e-6);
        // 0.3 and 0.6 as floats, over a ramp of 0.13.
        ASSERT_NEAR(lit ? (double)s.light.x : 0.0, expected, 4e-6);
    }
    assert_false(alpi_lighting_sample(lighting, (vec3){0, 5, 0}, (vec3){0, -1, 0}, 0.5f,
                                      (vec2){0, 0}, &(alpi_light_sample){0})); // behind it
    clear(context, scene, lighting);
}

/// inner = outer: an edge that is as wide as the extension's 0.001 of a cosine.
TEST(a_spot_of_one_cone_has_an_edge)
{
    alp_context *context = test_context(1);
    alpi_light light = lamp((vec3){0, 1, 0}, 1.0f);
    light.kind = ALP_LIGHT_SPOT;
    light.direction = (vec3){0, -1, 0};
    light.inner_cone = light.outer_cone = (float)(ALPI_PI / 4.0);
    alp_scene *scene = light_scene(context, &light, 1);
    alpi_lighting *lighting = make(scene, context, NULL);
    alpi_light_sample s;
    assert_true(alpi_lighting_sample_light(lighting, 0, (vec3){0.99f, 0, 0}, (vec2){0, 0}, &s));
    ASSERT_NEAR(s.light.x, 1.0 / (1.0 + 0.99 * 0.99), 1e-6);
    assert_false(alpi_lighting_sample_light(lighting, 0, (vec3){1.001f, 0, 0}, (vec2){0, 0}, &s));
    clear(context, scene, lighting);
}

/// A sun of `lux` towards azimuth, elevation (degrees).
static alp_lighting_options sun_options(double azimuth, double elevation, float size)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sun.azimuth = (float)(azimuth * ALPI_PI / 180.0);
    o.sun.elevation = (float)(elevation * ALPI_PI / 180.0);
    o.sun.illuminance = 1000.0f;
    o.sun.size = size;
    return o;
}

TEST(a_sun_gives_its_lux_times_the_cosine)
{
    const float five = (float)(5.0 * ALPI_PI / 180.0);
    const float sizes[] = {0.0f, 0.0093f, five, 1e-6f, 1e-4f, (float)(ALPI_PI / 2.0)};
    for (int i = 0; i < 6; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = light_scene(context, &(alpi_light){0}, 1);
        scene->light_count = 0;
        alp_lighting_options o = sun_options(90.0, 50.0, sizes[i]); // 90°: towards +X
        alpi_lighting *lighting = make(scene, context, &o);
        assert_int_equal(alpi_lighting_light_count(lighting), 1);
        assert_string_equal(alpi_lighting_light(lighting, 0)->name, "sun");
        vec3 travels = alpi_lighting_light(lighting, 0)->direction;
        ASSERT_NEAR(travels.x, -cos(50.0 * ALPI_PI / 180.0), 1e-6);
        ASSERT_NEAR(travels.y, -sin(50.0 * ALPI_PI / 180.0), 1e-6);
        ASSERT_NEAR(travels.z, 0.0, 1e-6);
        // As long as all of the disk is above the horizon it is as if it were a point, whatever the
        // tilt: the cosine is linear.
        const vec3 normals[] = {{0, 1, 0}, vec3_scale(travels, -1.0f), {0.6f, 0.8f, 0.0f}};
        for (int k = 0; k < 3; k++) {
            test_estimate e = test_light_estimate(lighting, ORIGIN, normals[k], 40000, 3);
            double expected = -1000.0 * (double)vec3_dot(travels, normals[k]);
            bool whole = sizes[i] < 1.0f || k > 0;
            if (whole) {
                // A disk of 1e-4 is 1e-3 of it in floats wide at its edge.
                ASSERT_NEAR(e.mean, expected,
                            4.0 * e.error + (sizes[i] == 1e-4f ? 1e-3 : 1e-5) * expected);
                ASSERT_NEAR(e.error / expected, 0.0, 2e-3);
            }
        }
        clear(context, scene, lighting);
    }
}

/// Half of a disk on the horizon: E = E⊥/(π sin²h) ∫ of the upper half = L · 2h³/3 for a small
/// half-angle h, as the cosine above the horizon is y and ∫ y over half a disk is 2h³/3.
TEST(a_sun_on_the_horizon_gives_its_upper_half)
{
    alp_context *context = test_context(1);
    alp_scene *scene = light_scene(context, &(alpi_light){0}, 1);
    scene->light_count = 0;
    alp_lighting_options o = sun_options(0.0, 0.0, 0.04f);
    alpi_lighting *lighting = make(scene, context, &o);
    double expected = 1000.0 / (ALPI_PI * 0.02 * 0.02) * 2.0 * 0.02 * 0.02 * 0.02 / 3.0;
    test_estimate e = test_light_estimate(lighting, ORIGIN, (vec3){0, 1, 0}, 100000, 4);
    // The small angle: 0.02² of it.
    ASSERT_NEAR(e.mean, expected, 4.0 * e.error + 4e-4 * expected);
    clear(context, scene, lighting);
}

TEST(the_file_s_suns_get_a_size)
{
    alp_context *context = test_context(1);
    const alpi_light lights[2] = {{.kind = ALP_LIGHT_DIRECTIONAL,
                                   .color = {1, 1, 1},
                                   .intensity = 100.0f,
                                   .direction = {0, -1, 0}},
                                  {.kind = ALP_LIGHT_DIRECTIONAL,
                                   .color = {1, 1, 1},
                                   .intensity = 50.0f,
                                   .direction = {0, -1, 0}}};
    alp_scene *scene = light_scene(context, lights, 2);
    alp_lighting_options o = alp_lighting_options_default();
    o.file_sun_size = 0.1f;
    alpi_lighting *lighting = make(scene, context, &o);
    alpi_light_sample s;
    assert_true(alpi_lighting_sample_light(lighting, 0, ORIGIN, (vec2){0.3f, 0.7f}, &s));
    assert_int_equal(s.kind, ALPI_LIGHT_CLASS_SUN);
    double solid = 2.0 * ALPI_PI * (1.0 - cos(0.05)),
           radiance = 100.0 / ALPI_PI / pow(sin(0.05), 2);
    ASSERT_NEAR((double)s.density * solid, 1.0, 1e-6);
    ASSERT_NEAR((double)s.light.x / radiance, 1.0, 1e-6);
    // Both disks are seen where one is: 150 lux, whichever is drawn.
    ASSERT_NEAR((double)alpi_lighting_escaped(lighting, s.direction).x / radiance, 1.5, 1e-6);
    ASSERT_ESTIMATE(test_light_estimate(lighting, ORIGIN, (vec3){0, 1, 0}, 10000, 5), 150.0);
    clear(context, scene, lighting);
}

/// 16 are asked one by one, 17 stand in a tree, a directional one beside it: the sum is the same.
TEST(many_lamps_add_up)
{
    enum { LIMIT = 10000 };
    static alpi_light lights[LIMIT];
    const uint32_t counts[] = {2, 16, 18, LIMIT};
    for (int k = 0; k < 4; k++) {
        alp_context *context = test_context(1);
        double expected = 0.0;
        for (uint32_t i = 0; i < counts[k]; i++) {
            test_draw draw = test_draw_at(9, i);
            lights[i] = lamp((vec3){8 * draw.u.x - 4, 6 * draw.pick - 1, 8 * draw.u.y - 4}, 1.0f);
            lights[i].intensity = i % 100 == 0 ? 50.0f : 1.0f;
            if (i % 3 == 0) {
                lights[i].kind = ALP_LIGHT_SPOT;
                lights[i].direction = (vec3){0, -1, 0};
                lights[i].inner_cone = 0.5f;
                lights[i].outer_cone = 1.0f;
            }
        }
        lights[1].kind = ALP_LIGHT_DIRECTIONAL;
        lights[1].direction = (vec3){0, -1, 0};
        alp_scene *scene = light_scene(context, lights, counts[k]);
        alpi_lighting *lighting = make(scene, context, NULL);
        const vec3 normal = {0, 1, 0}, point = {0.5f, -2.0f, 0.3f};
        for (uint32_t i = 0; i < counts[k]; i++) {
            alpi_light_sample s;
            if (alpi_lighting_sample_light(lighting, i, point, (vec2){0, 0}, &s)) {
                expected += (double)s.light.x * fmax((double)s.direction.y, 0.0);
            }
        }
        test_estimate e = test_light_estimate(lighting, point, normal, 100000, 6);
        ASSERT_ESTIMATE(e, expected);
        print_message("%u lamps: standard deviation of a draw %.3f of the mean\n", counts[k],
                      sqrt(e.variance) / e.mean);
        if (counts[k] <= 16) {
            ASSERT_NEAR(e.variance / (expected * expected), 0.0, 1e-6); // drawn by what they give
        }
        clear(context, scene, lighting);
    }
}
