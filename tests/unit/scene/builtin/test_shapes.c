// SPDX-License-Identifier: MIT
// Solids against the volumes they must have (that they are closed, test_builtin_sized says),
// counting against building, and the fineness that gives a wanted number.
#include "test_support.h"

#include "scene/builtin/shapes.h"

#include <math.h>

typedef void shape_fn(alpi_shaper *shaper);

static double volume_of(shape_fn *shape, double fineness)
{
    alp_context *context = test_context(1);
    alpi_builder builder;
    alpi_builder_start(&builder, context, "shape");
    vec3 grey = {0.5f, 0.5f, 0.5f}, dark = {0.0f, 0.0f, 0.0f};
    uint32_t material = alpi_builder_material(&builder, "grey", grey, dark);
    alpi_shaper shaper = alpi_shaper_start(&builder, fineness);
    alpi_shaper_surface(&shaper, "shape", material);
    alpi_shaper_place(&shaper, (vec3){0.5f, 0.25f, -1.0f}, 0.5 * ALPI_PI);
    shape(&shaper);
    alpi_shaper counted = alpi_shaper_start(NULL, fineness);
    shape(&counted);
    alp_scene *scene = NULL;
    ASSERT_OK(context, alpi_builder_finish(&builder, &scene));
    assert_int_equal(scene->triangle_count, counted.triangle_count);
    assert_int_equal(scene->triangle_count, shaper.triangle_count);
    assert_int_equal(scene->triangle_count, scene->usable_count);
    double volume = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        volume += (double)vec3_dot(c[0], vec3_cross(c[1], c[2])) / 6.0;
        vec3 face = vec3_triangle_normal(c[0], c[1], c[2], dark);
        for (int k = 0; k < 3; k++) {
            assert_true(vec3_dot(face, vec3_load(scene->normals[scene->triangles[t][k]])) > 0.5f);
        }
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return volume;
}

static void build_bevelled(alpi_shaper *shaper)
{
    alpi_shape_bevelled_box(shaper, (vec3){0.0f, 0.0f, 0.0f}, (vec3){1.0f, 2.0f, 3.0f}, 0.2f);
}

static bool is_not_corner(const void *user, uint32_t x, uint32_t y, uint32_t z)
{
    (void)user;
    return !(x == 1 && y == 1 && z == 0);
}

static void build_step(alpi_shaper *shaper)
{
    const float cuts[3] = {0.0f, 1.0f, 1.7f}, whole[2] = {0.0f, 2.0f};
    alpi_shape_blocks(shaper, &(alpi_blocks){.cuts = {cuts, cuts, whole},
                                             .counts = {3, 3, 2},
                                             .solid = is_not_corner,
                                             .edge = 0.5f});
}

/// A cylinder on a cone.
static void build_turned(alpi_shaper *shaper)
{
    const alpi_profile_point points[] = {
        {0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 0.0f}, {1.0f, 3.0f, 0.0f}, {0.0f, 3.0f, 0.0f}};
    alpi_shape_turned(shaper, points, 4, 100.0);
}

/// A bulging spindle: out = 4t(1−t)/2 over a height of 2, volume π ∫ r² dh = π · 2 · (1/4) · 8/15.
static void build_spindle(alpi_shaper *shaper)
{
    const alpi_profile_point points[] = {{0.0f, 0.0f, 0.25f}, {0.0f, 2.0f, 0.0f}};
    alpi_shape_turned(shaper, points, 2, 200.0);
}

static void build_cornice(alpi_shaper *shaper)
{
    const alpi_profile_point section[] = {
        {0.0f, 0.0f, 0.0f}, {0.5f, 0.0f, 0.0f}, {0.5f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
    alpi_shape_cornice(shaper, section, 4, 3.0f, 2.0f);
}

static void build_archivolt(alpi_shaper *shaper)
{
    const alpi_profile_point section[] = {
        {1.0f, 0.0f, 0.0f}, {1.5f, 0.0f, 0.0f}, {1.5f, 0.5f, 0.0f}, {1.0f, 0.5f, 0.0f}};
    alpi_shape_archivolt(shaper, section, 4, 0.3f, 2.0f);
}

static void build_arcade(alpi_shaper *shaper)
{
    alpi_shape_arcade(shaper, &(alpi_arcade){.start = -3.0f,
                                             .end = 3.5f,
                                             .first = -1.5f,
                                             .distance = 3.0f,
                                             .arch_count = 2,
                                             .radius = 1.25f,
                                             .thickness = 0.5f,
                                             .spring = 2.0f,
                                             .top = 4.0f});
}

static void build_ball(alpi_shaper *shaper)
{
    alpi_shape_blob(shaper, &(alpi_blob){.radius = 1.0f, .height_scale = 2.0f, .slices = 200.0});
}

static void build_leaf(alpi_shaper *shaper)
{
    alpi_shape_leaf(shaper, (vec3){0.0f, 0.0f, 0.0f}, (vec3){1.0f, 0.0f, 0.0f},
                    (vec3){0.0f, 0.0f, -0.5f}, 0.1f);
}

TEST(solids_have_their_volumes)
{
    // Of a bevel: a prism of b²/2 off each edge; of each corner's cube b³ one sixth stays.
    double bevelled = 6.0 - 2.0 * 0.04 * (0.6 + 1.6 + 2.6) - 8.0 * 0.008 * 5.0 / 6.0;
    ASSERT_NEAR(volume_of(build_bevelled, 1.0), bevelled, 1e-5);
    ASSERT_NEAR(volume_of(build_bevelled, 0.5), 6.0, 1e-5); // coarse: sharp
    ASSERT_NEAR(volume_of(build_step, 1.0), (1.7 * 1.7 - 0.7 * 0.7) * 2.0, 1e-5);
    ASSERT_NEAR(volume_of(build_step, 3.0), (1.7 * 1.7 - 0.7 * 0.7) * 2.0, 1e-5);
    // Circles of n sides: sin(2π/n)/(2π/n) of the area, 2π²/3n² less.
    double hundred = 50.0 * sin(2.0 * ALPI_PI / 100.0);
    ASSERT_NEAR(volume_of(build_turned, 1.0), hundred * (2.0 + 1.0 / 3.0), 1e-4);
    // One chord in three of the parabola is too coarse for the closed form at fineness 1.
    ASSERT_NEAR(volume_of(build_spindle, 20.0), ALPI_PI * 4.0 / 15.0, 2e-3);
    ASSERT_NEAR(volume_of(build_cornice, 1.0), 6.0 * 4.0 - 5.0 * 3.0, 1e-5);
    double fourteen = 7.0 * sin(ALPI_PI / 14.0); // half a polygon of 28 sides
    ASSERT_NEAR(volume_of(build_archivolt, 1.0), fourteen * 1.25 * 0.5, 1e-5);
    ASSERT_NEAR(volume_of(build_arcade, 1.0), (13.0 - 2.0 * fourteen * 1.5625) * 0.5, 1e-5);
    ASSERT_NEAR(volume_of(build_ball, 1.0), ALPI_PI * 8.0 / 3.0, 5e-3);
    ASSERT_NEAR(volume_of(build_leaf, 1.0), 0.1 / 3.0 * 1.24, 1e-5); // rim of 1.24 m²
}

static void build_many(alpi_shaper *shaper, const void *user)
{
    (void)user;
    shaper->triangle_count += 10 * (uint64_t)alpi_shaper_divide(shaper, 10.0, 2);
}

TEST(fineness_meets_a_number)
{
    static const uint64_t WANTED[] = {20, 100, 104, 106, 990, 1000, 5000};
    static const uint64_t NEAREST[] = {20, 100, 100, 110, 990, 1000, 1000};
    for (int i = 0; i < 7; i++) {
        double fineness = alpi_shaper_fit(build_many, NULL, 0.01, 10.0, WANTED[i]);
        alpi_shaper shaper = alpi_shaper_start(NULL, fineness);
        build_many(&shaper, NULL);
        assert_int_equal(shaper.triangle_count, NEAREST[i]);
    }
}
