// SPDX-License-Identifier: MIT
// Directions to a triangle: as many in each part as its solid angle says.
#include "test_lights.h"

#include "scene/lights/triangle_light.h"

#include <math.h>

static const vec3 ORIGIN = {0.0f, 0.0f, 0.0f};

static double solid_angle(vec3 a, vec3 b, vec3 c)
{
    const vec3 corner[3] = {a, b, c};
    return alpi_triangle_view_from(ORIGIN, corner).solid_angle;
}

TEST(an_octant_is_an_eighth)
{
    ASSERT_NEAR(solid_angle((vec3){1, 0, 0}, (vec3){0, 2, 0}, (vec3){0, 0, 3}), ALPI_PI / 2, 1e-15);
    // A small one far away: area / distance².
    ASSERT_NEAR(solid_angle((vec3){0, 0, 1000}, (vec3){1, 0, 1000}, (vec3){0, 1, 1000}), 0.5e-6,
                1e-12);
}

/// Just small enough to be drawn from by area: their solid angles are those of the exact formula.
TEST(small_triangles_have_the_exact_angle)
{
    const vec3 triangles[][3] = {
        {{-0.6f, -0.4f, 50}, {0.8f, -0.4f, 50}, {0, 0.9f, 50}}, // faced
        {{0, 0, 48}, {1, 0, 49}, {0, 1, 49}},
        {{48, 1, 0}, {49, 1, 0}, {48, 1, 1}}, // grazed at a fiftieth
    };
    for (size_t i = 0; i < sizeof triangles / sizeof *triangles; i++) {
        const vec3 *c = triangles[i];
        const double3 at[3] = {double3_from(c[0]), double3_from(c[1]), double3_from(c[2])};
        double below = 1.0, lengths[3]; // of van Oosterom and Strackee's formula
        for (int k = 0; k < 3; k++) {
            lengths[k] = double3_length(at[k]);
            below *= lengths[k];
        }
        for (int k = 0; k < 3; k++) {
            below += double3_dot(at[k], at[(k + 1) % 3]) * lengths[(k + 2) % 3];
        }
        const double volume = double3_dot(at[0], double3_cross(at[1], at[2]));
        const double exact = 2.0 * atan2(fabs(volume), below);
        assert_true(alpi_triangle_view_from(ORIGIN, c).by_area);
        ASSERT_NEAR(solid_angle(c[0], c[1], c[2]) / exact, 1.0, 1e-3);
    }
}

/// From the triangle's area, a direction's density is distance² / (area cosθ): not the same all
/// over one that leans away, which the nearest are drawn from by solid angle instead.
TEST(densities_by_area_are_exact)
{
    const vec3 small[3] = {{0, 0, 33}, {0, 0, 34}, {0.1f, 0.1f, 33}};
    const vec3 near[3] = {{0, 0, 31}, {0, 0, 32}, {0.1f, 0.1f, 31}};
    const vec3 point = {0.2f, 0.0f, 0.0f};
    const alpi_triangle_view view = alpi_triangle_view_from(point, small);
    assert_false(alpi_triangle_view_from(point, near).by_area);
    assert_true(view.by_area);
    const double area = vec3_triangle_area(small[0], small[1], small[2]);
    const double height = 0.2 * sqrt(0.5); // of the point over the plane x = y
    double least = HUGE_VAL, most = 0.0;
    for (uint32_t i = 0; i < 1000; i++) {
        const double3 direction = alpi_triangle_sample(&view, test_draw_at(3, i).u);
        const double distance = alpi_triangle_hit_at(&view, direction).distance;
        const double exact = distance * distance * distance / (area * height);
        const double density = alpi_triangle_density(&view, direction);
        ASSERT_NEAR(density / exact, 1.0, 1e-5); // corners and point are floats
        least = fmin(least, density);
        most = fmax(most, density);
    }
    assert_true(most > 1.06 * least); // (34 / 33)³ is 1.09
}

/// Middle of two corners as seen from the point, so that four parts share the triangle.
static vec3 between(vec3 a, vec3 b)
{
    return vec3_mad(vec3_scale(a, 0.5f), 0.5f, b);
}

/// Counts draws in the four parts between the middles of the edges: each by its share of the solid
/// angle, which is far from a fourth where the triangle is near.
static void check_parts(const vec3 corner[3])
{
    enum { COUNT = 200000 };
    alpi_triangle_view view = alpi_triangle_view_from(ORIGIN, corner);
    vec3 m01 = between(corner[0], corner[1]), m12 = between(corner[1], corner[2]),
         m20 = between(corner[2], corner[0]);
    const double share[4] = {
        solid_angle(corner[0], m01, m20) / view.solid_angle,
        solid_angle(corner[1], m12, m01) / view.solid_angle,
        solid_angle(corner[2], m20, m12) / view.solid_angle,
        solid_angle(m01, m12, m20) / view.solid_angle,
    };
    double weight[4] = {0}, total = 0.0;
    for (uint32_t i = 0; i < COUNT; i++) {
        double3 direction = alpi_triangle_sample(&view, test_draw_at(1, i).u);
        alpi_triangle_hit hit = alpi_triangle_hit_at(&view, direction);
        double b1 = (double)hit.b1, b2 = (double)hit.b2, b0 = 1.0 - b1 - b2;
        // Where it meets the plane is where it says.
        double3 place = double3_add(
            double3_add(double3_scale(view.corner[0], b0), double3_scale(view.corner[1], b1)),
            double3_scale(view.corner[2], b2));
        double3 miss = double3_sub(place, double3_scale(direction, hit.distance));
        // Barycentrics are floats: 6e-8 of sides up to 30 times the distance, twice.
        ASSERT_NEAR(double3_length(miss) / double3_length(place), 0.0, 1e-5);
        double one = 1.0 / (alpi_triangle_density(&view, direction) * view.solid_angle * COUNT);
        weight[b0 > 0.5 ? 0 : b1 > 0.5 ? 1 : b2 > 0.5 ? 2 : 3] += one;
        total += one;
    }
    for (int k = 0; k < 4; k++) {
        // Four standard errors of counting; by area weights are at most 4 times uneven here.
        double spread = view.by_area ? 8.0 : 4.0;
        ASSERT_NEAR(weight[k], share[k], spread * sqrt(share[k] / COUNT) + 1e-9);
    }
    ASSERT_NEAR(total, 1.0, view.by_area ? 0.02 : 1e-10); // sums
}

TEST(as_many_in_each_part)
{
    const vec3 triangles[][3] = {
        {{1, 0, 1}, {0, 1, 1}, {-1, -1, 1}},
        {{1, 0, 0.01f}, {-1, 1, 0.01f}, {-1, -1, 0.01f}},       // nearly half the sphere
        {{3, 0, 0.1f}, {0.1f, 0, 2}, {0, 0.1f, 0.1f}},          // one corner near
        {{1, 0, 20}, {0, 1, 20}, {0, 0, 21}},                   // 1e-3 sr
        {{1, 0, 60}, {0, 1, 60}, {0, 0, 61}},                   // 1e-4 sr: by area
        {{1, 0, 300}, {0, 1, 300}, {0, 0, 301}},                // 5e-6 sr
        {{1, 0, 3000}, {0, 1, 3000}, {0, 0, 3001}},             // 5e-8 sr
        {{100, 0, 0.001f}, {100, 1, 0.001f}, {101, 0, 0.001f}}, // grazed: 5e-10 sr
    };
    for (size_t i = 0; i < sizeof triangles / sizeof *triangles; i++) {
        check_parts(triangles[i]);
    }
}

TEST(the_point_in_the_plane_sees_nothing)
{
    const vec3 cases[][3] = {
        {{1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, // in it
        {{1, 0, 0}, {2, 1, 0}, {2, -1, 0}},   // beside it
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},    // its corner
        {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}},   // its edge
    };
    for (int i = 0; i < 4; i++) {
        alpi_triangle_view view = alpi_triangle_view_from(ORIGIN, cases[i]);
        for (uint32_t k = 0; k < 100; k++) {
            double3 direction = alpi_triangle_sample(&view, test_draw_at(2, k).u);
            ASSERT_NEAR(alpi_triangle_density(&view, direction), 0.0, 0.0);
        }
    }
}
