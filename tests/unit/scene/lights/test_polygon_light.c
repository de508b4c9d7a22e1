// SPDX-License-Identifier: MIT
// The closed form of a polygon's light, against other closed forms and the oracle of the tests.
#include "test_scenes.h"

#include "base/random.h"
#include "scene/lights/polygon_light.h"

#include <math.h>

static const vec3 UP = {0.0f, 0.0f, 1.0f}, ORIGIN = {0.0f, 0.0f, 0.0f};

TEST(a_rectangle_over_its_corner)
{
    const double a = 1.5, b = 0.7, height = 2.0;
    // Counter-clockwise seen from below.
    const vec3 corners[4] = {{0, 0, 2}, {0, 0.7f, 2}, {1.5f, 0.7f, 2}, {1.5f, 0, 2}};
    double x = a / height, y = b / height;
    double expected = (x / sqrt(1 + x * x) * atan(y / sqrt(1 + x * x)) +
                       y / sqrt(1 + y * y) * atan(x / sqrt(1 + y * y))) /
                      (2.0 * ALPI_PI); // oracle 6
    // 0.7 as a float is right to 2e-8.
    ASSERT_NEAR(alpi_polygon_form_factor(ORIGIN, UP, corners, 4), expected, 1e-8);
    const vec3 back[4] = {corners[3], corners[2], corners[1], corners[0]};
    ASSERT_NEAR(alpi_polygon_form_factor(ORIGIN, UP, back, 4), -expected, 1e-8);
}

/// A wall of height 3 from −1 below the horizon: what is below counts nothing.
TEST(the_horizon_clips)
{
    const vec3 wall[4] = {{2, -1, -1}, {2, -1, 3}, {2, 4, 3}, {2, 4, -1}};
    const vec3 upper[4] = {{2, -1, 0}, {2, -1, 3}, {2, 4, 3}, {2, 4, 0}};
    const vec3 below[4] = {{2, -1, -4}, {2, -1, -1}, {2, 4, -1}, {2, 4, -4}};
    double expected = alpi_polygon_form_factor(ORIGIN, UP, upper, 4);
    assert_true(fabs(expected) > 0.05);
    for (int turn = 0; turn < 4; turn++) { // wherever the walk begins
        vec3 turned[4];
        for (int i = 0; i < 4; i++) {
            turned[i] = wall[(i + turn) % 4];
        }
        ASSERT_NEAR(alpi_polygon_form_factor(ORIGIN, UP, turned, 4), expected, 1e-15);
    }
    ASSERT_NEAR(alpi_polygon_form_factor(ORIGIN, UP, below, 4), 0.0, 0.0);
}

static float random_float(uint32_t i)
{
    return 2.0f * alpi_unit_float(alpi_hash32(i)) - 1.0f;
}

/// 2,000 triangles anywhere, half of them through the horizon.
TEST(as_the_oracle_says)
{
    for (uint32_t i = 0; i < 2000; i++) {
        vec3 corners[3];
        double exact[3][3];
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t key = (i * 3 + k) * 3;
            corners[k] = (vec3){random_float(key), random_float(key + 1), random_float(key + 2)};
            exact[k][0] = (double)corners[k].x;
            exact[k][1] = (double)corners[k].y;
            exact[k][2] = (double)corners[k].z;
        }
        double expected = test_polygon_form_factor((double[]){0, 0, 0}, (double[]){0, 0, 1},
                                                   (const double(*)[3])exact, 3);
        double got = alpi_polygon_form_factor(ORIGIN, UP, corners, 3);
        ASSERT_NEAR(fabs(got), expected, 1e-12); // rounding of near-zero triangles' planes
        vec3 front = vec3_triangle_normal(corners[0], corners[1], corners[2], UP);
        if (expected > 1e-6) {
            assert_true((got > 0.0) == (vec3_dot(front, corners[0]) < 0.0f));
        }
    }
}

TEST(points_in_the_plane_and_far_away)
{
    const vec3 corners[4] = {{-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}};
    const vec3 near[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {3, 0, 0}};
    for (int i = 0; i < 4; i++) { // in it, on an edge, on a corner, beside
        double f = alpi_polygon_form_factor(near[i], (vec3){1, 0, 0}, corners, 4);
        ASSERT_NEAR(f, 0.0, 1e-15);
    }
    // A hair below the middle: all of the sky.
    ASSERT_NEAR(alpi_polygon_form_factor((vec3){0, 0, -1e-6f}, UP, corners, 4), 1.0, 1e-6);
    // A hair below an edge: half of it.
    ASSERT_NEAR(alpi_polygon_form_factor((vec3){1, 0, -1e-6f}, UP, corners, 4), 0.5, 1e-6);
    const vec3 huge[3] = {{-1e15f, -1e15f, 1e15f}, {0, 1e15f, 1e15f}, {1e15f, -1e15f, 1e15f}};
    const vec3 small[3] = {{-1, -1, 1}, {0, 1, 1}, {1, -1, 1}};
    ASSERT_NEAR(alpi_polygon_form_factor(ORIGIN, UP, huge, 3),
                alpi_polygon_form_factor(ORIGIN, UP, small, 3), 1e-7); // 1e15 as a float
}
