// SPDX-License-Identifier: MIT
// Stretch, density spread, flipped and overlapping, against closed forms.
#include "atlas_scenes.h"

#include "atlas/stretch.h"

#include <math.h>

// Coordinates are rounded by half of 2⁻²⁴; on pages of 64 whose triangles have sides above 10
// texels that is under 10⁻⁶ of a side. Shape and density follow within a few times that.
static const double ROUNDING = 1e-5;
static const double BIN = 0.0014; // two bins of the density's histogram, each 2^(1/1024)

// --- one triangle --------------------------------------------------------------------------------

static const vec3 CORNERS[3] = {{1, 2, 3}, {2, 2, 3}, {1, 3, 3}};

/// Of the triangle above under the map whose derivatives by the texture are (a, b) and (c, d).
static double stretch_of(double a, double b, double c, double d)
{
    const double span = a * d - b * c; // the inverse takes the surface to the texture
    const double map[3][2] = {{5, 7}, {5 + d / span, 7 - b / span}, {5 - c / span, 7 + a / span}};
    return alpi_stretch_of(CORNERS, map);
}

TEST(a_triangle_has_the_stretch_of_its_map)
{
    const double cosine = cos(1.0), sine = sin(1.0);
    ASSERT_NEAR(stretch_of(1, 0, 0, 1), 1.0, 1e-14);
    ASSERT_NEAR(stretch_of(3, 0, 0, 3), 3.0, 1e-14);                  // a third of the density
    ASSERT_NEAR(stretch_of(cosine, sine, -sine, cosine), 1.0, 1e-14); // turned
    ASSERT_NEAR(stretch_of(-1, 0, 0, 1), 1.0, 1e-14);                 // mirrored
    ASSERT_NEAR(stretch_of(1, 0, 0.7, 1), sqrt(1.0 + 0.5 * 0.7 * 0.7), 1e-14); // sheared
    ASSERT_NEAR(stretch_of(1.0 / cosine, 0, 0, 1), sqrt(0.5 * (1.0 + 1.0 / (cosine * cosine))),
                1e-14); // projected on a plane at an angle of 1
    static const double flat[3][2] = {{0, 0}, {1, 1}, {2, 2}};
    assert_true(isinf(alpi_stretch_of(CORNERS, flat)));
}

// --- kept sets -----------------------------------------------------------------------------------

/// Two squares of 1 m at these places of the page.
typedef struct placed {
    float x, y, width, height;
} placed;

static alp_atlas_info info_of_squares(const placed squares[2])
{
    static const float p[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}};
    static const uint32_t indices[4][3] = {{0, 1, 2}, {2, 3, 0}, {4, 5, 6}, {6, 7, 4}};
    float uvs[8][2];
    for (int i = 0; i < 8; i++) {
        const placed *s = &squares[i / 4];
        uvs[i][0] = s->x + (i % 4 == 1 || i % 4 == 2 ? s->width : 0.0f);
        uvs[i][1] = s->y + (i % 4 >= 2 ? s->height : 0.0f);
    }
    alp_context *context = test_context(1);
    alp_scene *scene = scene_of(context, p, (const float(*)[2])uvs, 8, indices, 4);
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_KEEP;
    options.size = 64;
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    const alp_atlas_info info = alp_atlas_get_info(atlas);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return info;
}

TEST(equal_squares_have_a_stretch_of_one)
{
    static const placed squares[2] = {{0.1f, 0.1f, 0.3f, 0.3f}, {0.5f, 0.5f, 0.3f, 0.3f}};
    const alp_atlas_info info = info_of_squares(squares);
    ASSERT_NEAR(info.stretch_mean, 1.0, ROUNDING);
    ASSERT_NEAR(info.stretch_worst, 1.0, ROUNDING);
    ASSERT_NEAR(info.density_spread, 1.0, BIN);
    ASSERT_NEAR(info.texels_per_metre, 0.3 * 64.0, 64.0 * ROUNDING);
    assert_int_equal(info.flipped_triangles, 0);
    assert_int_equal(info.sliver_triangles, 0);
    assert_int_equal(info.overlapping_texels, 0);
}

TEST(projected_squares_have_that_of_their_angle)
{
    for (int i = 1; i < 7; i++) {
        const double cosine = cos(0.2 * i);
        const float low = (float)(0.4 * cosine);
        const placed squares[2] = {{0.1f, 0.1f, 0.4f, low}, {0.52f, 0.52f, low, 0.4f}};
        const alp_atlas_info info = info_of_squares(squares);
        const double stretch = sqrt(0.5 * (1.0 + 1.0 / (cosine * cosine)) * cosine);
        ASSERT_NEAR(info.stretch_mean, stretch, stretch * ROUNDING);
        ASSERT_NEAR(info.stretch_worst, stretch, stretch * ROUNDING);
        ASSERT_NEAR(info.density_spread, 1.0, BIN);
    }
}

/// Densities d and 2d over equal areas: the mean density is √2.5 d.
TEST(unlike_densities_are_seen)
{
    static const placed squares[2] = {{0.1f, 0.1f, 0.2f, 0.2f}, {0.5f, 0.5f, 0.4f, 0.4f}};
    const alp_atlas_info info = info_of_squares(squares);
    ASSERT_NEAR(info.stretch_mean, sqrt(0.5 * (2.5 + 2.5 / 4.0)), ROUNDING);
    ASSERT_NEAR(info.stretch_worst, sqrt(2.5), ROUNDING);
    ASSERT_NEAR(info.density_spread, 2.0, 2.0 * BIN);
}

TEST(mirrored_squares_are_flipped)
{
    static const placed squares[2] = {{0.1f, 0.1f, 0.3f, 0.3f}, {0.8f, 0.5f, -0.3f, 0.3f}};
    const alp_atlas_info info = info_of_squares(squares);
    assert_int_equal(info.flipped_triangles, 2);
    ASSERT_NEAR(info.stretch_mean, 1.0, ROUNDING);
}

/// Keeping refuses such a set, but the doctor wants to know of it.
TEST_WITH_CONTEXT(a_flat_triangle_has_no_end_of_stretch, 1)
{
    alp_scene *scene = scene_cube(context);
    alp_atlas *atlas = charts_of_size(context, scene, 64);
    memcpy(atlas->corner_uvs[5][1], atlas->corner_uvs[5][0], sizeof atlas->corner_uvs[5][0]);
    alpi_stretch_facts facts;
    ASSERT_OK(context, alpi_stretch_measure(atlas, &facts));
    assert_true(isinf(facts.worst) && isinf(facts.mean));
    assert_int_equal(facts.worst_triangle, 5);
    assert_int_equal(facts.flipped, 1);
    assert_int_equal(facts.first_flipped, 5);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

// --- new charts ----------------------------------------------------------------------------------

/// A cube's charts are its sides: no stretch. That of a sphere is above 1, as that of any map of a
/// curved surface (the mean square is at least the square mean).
TEST(charts_are_measured)
{
    alp_atlas_info info[2];
    for (int i = 0; i < 2; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = i == 0 ? scene_cube(context) : scene_sphere(context, 30, 60);
        alp_atlas *atlas = charts_of_size(context, scene, 128);
        info[i] = alp_atlas_get_info(atlas);
        assert_int_equal(info[i].flipped_triangles, 0);
        assert_int_equal(info[i].overlapping_texels, 0);
        alp_atlas_destroy(atlas);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    ASSERT_NEAR(info[0].stretch_mean, 1.0, ROUNDING);
    ASSERT_NEAR(info[0].stretch_worst, 1.0, ROUNDING);
    ASSERT_NEAR(info[0].density_spread, 1.0, BIN);
    assert_true(info[1].stretch_mean > 1.0 + ROUNDING);
    assert_true(info[1].stretch_mean < info[1].stretch_worst && info[1].stretch_worst < 2.0);
    assert_true(info[1].density_spread > 1.0 && info[1].density_spread < 2.0);
}

TEST_WITH_CONTEXT(slivers_are_counted_and_left_out, 1)
{
    static const float p[7][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},    {0, 1, 0},
                                  {2, 0, 0}, {3, 0, 0}, {3, 1e-6f, 0}};
    static const uint32_t indices[3][3] = {{0, 1, 2}, {2, 3, 0}, {4, 5, 6}};
    alp_scene *scene = scene_of(context, p, NULL, 7, indices, 3);
    alp_atlas *atlas = charts_of_size(context, scene, 64);
    const alp_atlas_info info = alp_atlas_get_info(atlas);
    assert_int_equal(info.sliver_triangles, 1);
    assert_int_equal(info.flipped_triangles, 0);
    // The sliver is drawn a sixteenth of a texel high: 1/600 of the square's area at most.
    ASSERT_NEAR(info.stretch_mean, 1.0, 2e-3);
    ASSERT_NEAR(info.stretch_worst, 1.0, 2e-3);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

/// What no texel shows is not stretched: 1, the least that there is.
TEST_WITH_CONTEXT(slivers_alone_are_not_stretched, 1)
{
    static const float p[3][3] = {{2, 0, 0}, {3, 0, 0}, {3, 1e-6f, 0}};
    static const uint32_t index[1][3] = {{0, 1, 2}};
    alp_scene *scene = scene_of(context, p, NULL, 3, index, 1);
    alp_atlas *atlas = charts_of_size(context, scene, 64);
    assert_int_equal(alp_atlas_get_info(atlas).sliver_triangles, 1);
    assert_true(alp_atlas_get_info(atlas).stretch_mean == 1.0);
    assert_true(alp_atlas_get_info(atlas).stretch_worst == 1.0);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(the_layout_of_a_page_of_one_texel_overlaps, 1)
{
    alp_scene *scene = scene_cube(context);
    alp_atlas *atlas = charts_of_size(context, scene, 1);
    assert_int_equal(alp_atlas_get_info(atlas).overlapping_texels, 1);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST(workers_change_no_figure)
{
    alp_atlas_info info[2];
    for (int i = 0; i < 2; i++) {
        alp_context *context = test_context(i == 0 ? 1 : 7);
        alp_scene *scene = scene_sphere(context, 20, 40);
        alp_atlas *atlas = charts_of_size(context, scene, 128);
        info[i] = alp_atlas_get_info(atlas);
        alp_atlas_destroy(atlas);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    assert_memory_equal(&info[0].stretch_mean, &info[1].stretch_mean, sizeof(double));
    assert_memory_equal(&info[0].stretch_worst, &info[1].stretch_worst, sizeof(double));
    assert_memory_equal(&info[0].density_spread, &info[1].density_spread, sizeof(double));
}
