// SPDX-License-Identifier: MIT
// The door to all light: options, classes, densities that agree, and input that is no light.
#include "test_lights.h"

#include "base/memory.h"
#include "scene/lights/triangle_light.h"

#include <math.h>

static const vec3 ORIGIN = {0, 0, 0}, UP = {0, 1, 0};

/// Three triangles over the origin, none behind another, one of them partly below the horizon.
static const vec3 TRIANGLES[3][3] = {{{0.5f, 1, 0.5f}, {-0.7f, 1, 0.6f}, {0, 1, -0.8f}},
                                     {{3, 2, 0}, {3, -1, 1}, {3, 2, 2}},
                                     {{-3, 2, -1}, {-4, 2, 2}, {-2, 3, 1.5f}}};

/// Bands around the sphere at which densities are summed: an even grid, 2 N × N in equal areas.
enum { BANDS = 700 };

static vec3 grid_direction(int i, int j)
{
    double z = (2.0 * j + 1.0) / BANDS - 1.0, phi = 2.0 * ALPI_PI * (i + 0.5) / (2 * BANDS);
    double s = sqrt(1.0 - z * z);
    return (vec3){(float)(s * cos(phi)), (float)z, (float)(s * sin(phi))};
}

/// The triangle a direction from the point meets, ALPI_NONE: none.
static uint32_t hit(vec3 point, vec3 direction)
{
    for (uint32_t t = 0; t < 3; t++) {
        double3 c[3], d = double3_from(direction);
        for (int k = 0; k < 3; k++) {
            c[k] = double3_between(point, TRIANGLES[t][k]);
        }
        double x = double3_dot(d, double3_cross(c[1], c[2]));
        double y = double3_dot(d, double3_cross(c[2], c[0]));
        double z = double3_dot(d, double3_cross(c[0], c[1]));
        bool inside = (x > 0 && y > 0 && z > 0) || (x < 0 && y < 0 && z < 0);
        double volume = double3_dot(c[0], double3_cross(c[1], c[2]));
        if (inside && volume * x > 0) { // ahead, not behind
            return t;
        }
    }
    return ALPI_NONE;
}

typedef struct stage {
    alp_context *context;
    alp_scene *scene;
    alpi_lighting *lighting;
} stage;

/// All four classes: the triangles, a lamp, a sun of 10° and a sky.
static stage start_all(void)
{
    stage s = {.context = test_context(1)};
    s.scene = test_emitter_scene(s.context, TRIANGLES, 3, (vec3){2, 1, 3});
    s.scene->materials[0].double_sided = true;
    s.scene->lights = ALPI_NEW(s.context, alpi_light, 1);
    s.scene->lights[0] = (alpi_light){.kind = ALP_LIGHT_POINT,
                                      .color = {1, 1, 1},
                                      .intensity = 3.0f,
                                      .position = {0, 2, 1},
                                      .range = INFINITY};
    s.scene->light_count = 1;
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_CONSTANT;
    o.sun.illuminance = 4.0f;
    o.sun.elevation = 0.3f;
    o.sun.size = 0.17f;
    ASSERT_OK(s.context, alpi_lighting_create(s.scene, &o, &s.lighting));
    return s;
}

static void finish(stage *s)
{
    alpi_lighting_destroy(s->context, s->lighting);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

/// Densities of all directions and the probability of the lamp make 1, and each triangle is drawn
/// as often as its densities say.
TEST(densities_make_one)
{
    stage s = start_all();
    double sum = 0.0, lamp = 0.0, share[3] = {0}, drawn[3] = {0};
    enum { DRAWS = 100000 };
    const double cell = 4.0 * ALPI_PI / (2.0 * BANDS * BANDS);
    for (int j = 0; j < BANDS; j++) {
        for (int i = 0; i < 2 * BANDS; i++) {
            vec3 direction = grid_direction(i, j);
            // Sky and sun are drawn as if nothing stood before them.
            sum += (double)alpi_lighting_density(s.lighting, ORIGIN, UP, direction, ALPI_NONE);
            uint32_t t = hit(ORIGIN, direction);
            if (t != ALPI_NONE) {
                share[t] +=
                    cell * (double)alpi_lighting_density(s.lighting, ORIGIN, UP, direction, t);
            }
        }
    }
    sum = sum * cell + share[0] + share[1] + share[2];
    for (uint32_t i = 0; i < DRAWS; i++) {
        alpi_light_sample sample;
        test_draw draw = test_draw_at(1, i);
        bool lit = alpi_lighting_sample(s.lighting, ORIGIN, UP, draw.pick, draw.u, &sample);
        if (lit && sample.kind == ALPI_LIGHT_CLASS_PUNCTUAL) {
            lamp = (double)sample.density;
        }
        if (sample.triangle != ALPI_NONE) {
            drawn[sample.triangle] += 1.0 / DRAWS;
        }
    }
    for (int t = 0; t < 3; t++) {
        assert_true(share[t] > 0.005);
        ASSERT_NEAR(drawn[t], share[t], 4.0 * sqrt(share[t] / DRAWS) + 5e-4); // cells, see below
    }
    assert_true(lamp > 0.05 && lamp < 0.5);
    // Cells at the edges of triangles and disk: a length of 20 rad of a million cells of 4e-3.
    ASSERT_NEAR(sum + lamp, 1.0, 1e-3);
    finish(&s);
}

TEST(what_is_drawn_has_its_density)
{
    stage s = start_all();
    uint32_t seen[ALPI_LIGHT_CLASS_COUNT] = {0};
    for (uint32_t i = 0; i < 20000; i++) {
        alpi_light_sample a, b;
        test_draw draw = test_draw_at(2, i);
        vec3 point = {(draw.pick - 0.5f) * 0.3f, (draw.u.x - 0.5f) * 0.3f, 0.1f};
        if (!alpi_lighting_sample(s.lighting, point, UP, draw.u.y, draw.u, &a)) {
            continue;
        }
        seen[a.kind]++;
        assert_true(alpi_lighting_sample(s.lighting, point, UP, draw.u.y, draw.u, &b));
        assert_memory_equal(&a.direction, &b.direction, sizeof a.direction);
        ASSERT_NEAR(a.density, b.density, 0.0);
        ASSERT_NEAR(vec3_length(a.direction), 1.0, 1e-6);
        if (a.kind == ALPI_LIGHT_CLASS_PUNCTUAL) {
            continue;
        }
        double density =
            (double)alpi_lighting_density(s.lighting, point, UP, a.direction, a.triangle);
        ASSERT_NEAR(density / (double)a.density, 1.0, 1e-4);
        if (a.kind == ALPI_LIGHT_CLASS_SURFACE) {
            // An edge is met or missed by rounding of the direction.
            vec3 place = vec3_mad(point, a.distance, a.direction);
            vec3 n = vec3_triangle_normal(TRIANGLES[a.triangle][0], TRIANGLES[a.triangle][1],
                                          TRIANGLES[a.triangle][2], UP);
            ASSERT_NEAR(vec3_dot(n, vec3_sub(place, TRIANGLES[a.triangle][0])), 0.0, 4e-6);
        } else {
            vec3 escaped = alpi_lighting_escaped(s.lighting, a.direction);
            ASSERT_NEAR(escaped.x, a.light.x, 0.0);
        }
    }
    for (int k = 0; k < ALPI_LIGHT_CLASS_COUNT; k++) {
        assert_true(seen[k] > 500);
    }
    // A triangle that does not emit is never drawn.
    ASSERT_NEAR(alpi_lighting_density(s.lighting, ORIGIN, UP, UP, 77), 0.0, 0.0);
    finish(&s);
}

/// With the sky behind them the classes still add up: π of sky, sun, lamp, triangles.
TEST(classes_add_up)
{
    stage s = start_all();
    test_estimate e = test_light_estimate(s.lighting, ORIGIN, UP, 400000, 3);
    double expected = ALPI_PI + 4.0 * sin(0.3) + 3.0 * 2.0 / pow(5.0, 1.5);
    double triangles = 0.0;
    for (int j = BANDS / 2; j < BANDS; j++) {
        for (int i = 0; i < 2 * BANDS; i++) {
            vec3 direction = grid_direction(i, j);
            triangles += hit(ORIGIN, direction) != ALPI_NONE ? 2.0 * (double)direction.y : 0.0;
        }
    }
    expected += triangles * 4.0 * ALPI_PI / (2.0 * BANDS * BANDS);
    ASSERT_NEAR(e.mean, expected, 4.0 * e.error + 2e-3); // cells at edges, see above
    print_message("all four: standard deviation of a draw %.3f of the mean\n",
                  sqrt(e.variance) / e.mean);
    finish(&s);
}

TEST_WITH_CONTEXT(darkness, 1)
{
    alp_scene *scene = test_emitter_scene(context, TRIANGLES, 3, (vec3){0, 0, 0});
    alpi_lighting *lighting;
    ASSERT_OK(context, alpi_lighting_create(scene, NULL, &lighting));
    assert_true(alpi_lighting_is_dark(lighting));
    assert_int_equal(alpi_lighting_light_count(lighting), 0);
    assert_null(alpi_lighting_sky(lighting));
    alpi_light_sample s;
    assert_false(alpi_lighting_sample(lighting, ORIGIN, UP, 0.5f, (vec2){0, 0}, &s));
    ASSERT_NEAR(alpi_lighting_density(lighting, ORIGIN, UP, UP, ALPI_NONE), 0.0, 0.0);
    ASSERT_NEAR(alpi_lighting_escaped(lighting, UP).x, 0.0, 0.0);
    alpi_lighting_destroy(context, lighting);
    alpi_lighting_destroy(context, NULL);
    alp_scene_destroy(scene);
}

TEST(options_out_of_range)
{
    stage s = start_all();
    const alp_lighting_options good = alp_lighting_options_default();
    alp_lighting_options bad[12];
    for (int i = 0; i < 12; i++) {
        bad[i] = good;
    }
    bad[0].struct_size = 1;
    bad[1].sun.azimuth = NAN;
    bad[2].sun.elevation = 1.6f;
    bad[3].sun.elevation = NAN;
    bad[4].sun.illuminance = -1.0f;
    bad[5].sun.illuminance = INFINITY;
    bad[6].sun.color[1] = NAN;
    bad[7].sun.color[2] = -1.0f;
    bad[8].sun.size = -0.1f;
    bad[9].sun.size = 1.6f;
    bad[10].file_sun_size = NAN;
    bad[11].file_sun_size = 4.0f;
    for (int i = 0; i < 12; i++) {
        alpi_lighting *lighting;
        assert_int_equal(alpi_lighting_create(s.scene, &bad[i], &lighting),
                         ALP_ERROR_INVALID_ARGUMENT);
        assert_null(lighting);
        assert_true(strlen(alp_context_message(s.context)) > 10);
    }
    finish(&s);
}

/// Draws from a few places: numbers, or nothing, always.
static void check_numbers(const alpi_lighting *lighting, vec3 point)
{
    const vec3 normals[] = {{0, 1, 0}, {0, -1, 0}, {0.6f, 0, 0.8f}};
    for (uint32_t i = 0; i < 3000; i++) {
        test_draw draw = test_draw_at(5, i);
        alpi_light_sample s;
        vec3 n = normals[i % 3];
        if (alpi_lighting_sample(lighting, point, n, draw.pick, draw.u, &s)) {
            assert_true(vec3_is_finite(s.direction) && vec3_is_finite(s.light));
            assert_true(s.density > 0.0f && isfinite(s.density));
            assert_true(s.distance > 0.0f);
            assert_true(s.light.x >= 0.0f && vec3_dot(s.direction, n) > 0.0f);
        }
        float density = alpi_lighting_density(lighting, point, n, n, i % 4);
        assert_true(density >= 0.0f && isfinite(density));
    }
}

TEST(hostile_emitters)
{
    const float far = 1e15f;
    const vec3 triangles[][3] = {
        {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}},                    // no area
        {{0, 1, 0}, {1, 1, 0}, {2, 1, 0}},                    // a line
        {{-far, far, -far}, {far, far, -far}, {0, far, far}}, // as large as it gets
        {{0, 2, 0}, {1e-12f, 2, 0}, {0, 2, 1e-12f}},          // as small
        {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},                    // the point is its corner
        {{-1, 0, -1}, {2, 0, -1}, {-1, 0, 2}},                // the point is on it
        {{0, NAN, 0}, {1, 1, 0}, {0, 1, 1}},                  // no number
        {{1, 1, 0}, {1, 2, 0}, {1, 1, 1}},                    // a plain one
    };
    const vec3 emissions[] = {{1, 2, 3}, {INFINITY, 1, 0}, {NAN, 1, 1}, {-1, 0, 2}, {3e38f, 0, 0}};
    for (int k = 0; k < 5; k++) {
        for (int set_later = 0; set_later < 2; set_later++) { // reading clamps, setting does not
            alp_context *context = test_context(1);
            alp_scene *scene =
                test_emitter_scene(context, triangles, 8, set_later ? UP : emissions[k]);
            vec3_store(scene->materials[0].emission, emissions[k]);
            scene->materials[0].double_sided = set_later != 0;
            alpi_lighting *lighting;
            ASSERT_OK(context, alpi_lighting_create(scene, NULL, &lighting));
            assert_in_range(alpi_lighting_emitter_count(lighting), 1, 5);
            const vec3 points[] = {{0, 0, 0},      {0.2f, 0, 0.2f}, {far, 0, 0},
                                   {0, 1e-30f, 0}, {1, 1, 0},       {0, -far, 0}};
            for (int p = 0; p < 6; p++) {
                check_numbers(lighting, points[p]);
            }
            alpi_lighting_destroy(context, lighting);
            alp_scene_destroy(scene);
            alp_context_destroy(context);
        }
    }
}

TEST(hostile_lamps)
{
    stage s = start_all();
    const alpi_light plain = s.scene->lights[0];
    alpi_light bad[6] = {plain, plain, plain, plain, plain, plain};
    bad[0].intensity = NAN;
    bad[1].intensity = -5.0f;
    bad[2].color.y = INFINITY;
    bad[3].position.x = NAN;
    bad[4].kind = ALP_LIGHT_SPOT; // no direction
    bad[5].kind = ALP_LIGHT_DIRECTIONAL;
    for (int i = 0; i < 6; i++) {
        alpi_lighting *lighting;
        s.scene->lights[0] = bad[i];
        test_log_clear();
        ASSERT_OK(s.context, alpi_lighting_create(s.scene, NULL, &lighting));
        assert_true(test_log_has("light"));
        assert_int_equal(alpi_lighting_light_count(lighting), 1); // left out of draws only
        check_numbers(lighting, ORIGIN);
        alpi_lighting_destroy(s.context, lighting);
    }
    s.scene->lights[0] = plain;
    s.scene->lights[0].intensity = 3e38f;
    alpi_lighting *lighting;
    ASSERT_OK(s.context, alpi_lighting_create(s.scene, NULL, &lighting));
    check_numbers(lighting, plain.position);
    check_numbers(lighting, vec3_add(plain.position, (vec3){1e-20f, 1e-20f, 0}));
    check_numbers(lighting, ORIGIN);
    alpi_lighting_destroy(s.context, lighting);
    s.scene->lights[0] = plain;
    finish(&s);
}

/// Light comes from the front, from behind a double-sided one, and not through what is cut away.
TEST(emission_has_sides_and_holes)
{
    stage s = start_all();
    const vec3 toward = {0, -1, 0}, away = {0, 1, 0};
    vec3 n = vec3_triangle_normal(TRIANGLES[0][0], TRIANGLES[0][1], TRIANGLES[0][2], UP);
    bool down = n.y < 0.0f;
    ASSERT_NEAR(alpi_surface_emission(s.scene, 0, 0.3f, 0.3f, away).z, 3.0, 0.0);
    ASSERT_NEAR(alpi_surface_emission(s.scene, 0, 0.3f, 0.3f, toward).z, 3.0, 0.0);
    alpi_material *m = &s.scene->materials[0];
    m->double_sided = false;
    ASSERT_NEAR(alpi_surface_emission(s.scene, 0, 0.3f, 0.3f, away).z, down ? 0.0 : 3.0, 0.0);
    ASSERT_NEAR(alpi_surface_emission(s.scene, 0, 0.3f, 0.3f, toward).z, down ? 3.0 : 0.0, 0.0);
    m->double_sided = true;
    m->alpha_mode = ALPI_ALPHA_MASK;
    m->base_color[3] = 0.3f;
    ASSERT_NEAR(alpi_surface_emission(s.scene, 0, 0.3f, 0.3f, toward).z, 0.0, 0.0);
    finish(&s);
}

TEST(memory_may_run_out)
{
    int left = 1000;
    alp_context *context = test_context_failing(&left);
    alp_scene *scene = test_emitter_scene(context, TRIANGLES, 3, (vec3){1, 1, 1});
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_CONSTANT;
    o.sun.illuminance = 1.0f;
    int needed = 0;
    for (alp_result result = ALP_ERROR_OUT_OF_MEMORY; result != ALP_OK; needed++) {
        alpi_lighting *lighting;
        left = needed;
        result = alpi_lighting_create(scene, &o, &lighting);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_true((lighting != NULL) == (result == ALP_OK));
        left = 1000;
        alpi_lighting_destroy(context, lighting);
    }
    assert_in_range(needed, 10, 100);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}
