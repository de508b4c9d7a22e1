// SPDX-License-Identifier: MIT
// Overlapping charts: who lies in which, without folds, the same for any number of workers; and the
// weights with which they are read.
#include "atlas_scenes.h"

#include "base/memory.h"

#include "atlas/blend.h"
#include "atlas/choice.h"
#include "scene/builtin/mesh_builder.h"

static alp_atlas *blend_of(alp_context *context, const alp_scene *scene, uint32_t size,
                           double density)
{
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_BLEND;
    options.size = size;
    options.texels_per_metre = density;
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    assert_int_equal(alp_atlas_get_info(atlas).mode, ALP_ATLAS_BLEND);
    return atlas;
}

static alp_scene *smooth_sphere(alp_context *context)
{
    alpi_builder builder;
    alp_scene *scene = NULL;
    alpi_builder_start(&builder, context, "sphere");
    alpi_builder_surface(&builder, "sphere", ALPI_NONE);
    alpi_builder_ball(&builder,
                      &(alpi_ball){.radius = 1.0f, .top = 1.0f, .slices = 48, .stacks = 24});
    ASSERT_OK(context, alpi_builder_finish(&builder, &scene));
    return scene;
}

static void corner_cosines(const alp_scene *scene, uint32_t triangle, double cosines[3])
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    const vec3 n = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0, 0, 0});
    cosines[0] = fabs((double)n.x);
    cosines[1] = fabs((double)n.y);
    cosines[2] = fabs((double)n.z);
}

TEST_WITH_CONTEXT(triangles_lie_in_the_charts_of_their_axes, 2)
{
    alp_scene *scene = smooth_sphere(context);
    alp_atlas *atlas = blend_of(context, scene, 256, 0.0);
    assert_int_equal(alp_atlas_get_info(atlas).charts, 6); // a cap about each end of each axis
    assert_int_equal(overlapping_texels(atlas), 0);
    uint32_t counts[4] = {0};
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        double cosines[3];
        corner_cosines(scene, t, cosines);
        const uint8_t members = atlas->set_members[t];
        counts[__builtin_popcount(members)]++;
        for (int k = 0; k < 3; k++) {
            // cos 87°; what lies within rounding of it may be either
            if (fabs(cosines[k] - 0.052336) > 1e-5) {
                assert_int_equal(members >> k & 1, cosines[k] > 0.052336);
            }
            for (int i = 0; i < 6; i++) {
                const float at = atlas->set_uvs[t][k][i / 2][i % 2];
                assert_true(at >= 0.0f && at <= 1.0f);
            }
        }
    }
    assert_int_equal(counts[0], 0);
    assert_true(counts[1] > 0 && counts[2] > 0 && counts[3] > 0);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(sets_that_a_triangle_is_not_in_repeat_its_strongest, 1)
{
    alp_scene *scene = scene_cube(context);
    alp_atlas *atlas = blend_of(context, scene, 64, 0.0);
    assert_int_equal(alp_atlas_get_info(atlas).charts, 6);
    const float *sets = alp_atlas_blend_uvs(atlas);
    for (uint32_t t = 0; t < 12; t++) {
        assert_int_equal(__builtin_popcount(atlas->set_members[t]), 1);
        for (int k = 0; k < 3; k++) {
            assert_memory_equal(sets + 18 * t + 6 * k, alp_atlas_corner_uvs(atlas) + 6 * t,
                                6 * sizeof *sets);
        }
    }
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(folds_are_cut, 2)
{
    alp_scene *scene = scene_spiral(context, 9);
    alp_atlas *atlas = blend_of(context, scene, 256, 0.0);
    assert_int_equal(overlapping_texels(atlas), 0);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        assert_true(atlas->set_members[t] != 0);
    }
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

/// The point of a texel lies on the triangle and in the texel that it names.
TEST_WITH_CONTEXT(texels_name_triangles_of_the_scene, 2)
{
    alp_scene *scene = smooth_sphere(context);
    alp_atlas *atlas = blend_of(context, scene, 128, 0.0);
    alpi_texels texels;
    for (int round = 0; round < 2; round++) { // those at hand, and made anew
        ASSERT_OK(context, alpi_texels_create(atlas, &texels));
        assert_int_equal(texels.count, alp_atlas_get_info(atlas).texels);
        double area = 0.0; // each place once, though it is in up to three charts
        for (uint32_t i = 0; i < texels.count; i++) {
            area += (double)alpi_texels_area(&texels, i);
        }
        ASSERT_NEAR(area, scene->area, 0.005 * scene->area); // weights are those of one point
        for (uint32_t i = 0; i < texels.count; i++) {
            assert_true(texels.triangles[i] < scene->triangle_count);
            const float(*uv)[2] = (const float(*)[2])atlas->corner_uvs[texels.faces[i]];
            for (int k = 0; k < 2; k++) {
                const double at =
                    (double)uv[0][k] +
                    (double)texels.barycentrics[i][0] * (double)(uv[1][k] - uv[0][k]) +
                    (double)texels.barycentrics[i][1] * (double)(uv[2][k] - uv[0][k]);
                // .05 texels: points are moved off edges by as much; the rest is rounding of floats
                ASSERT_NEAR(128.0 * at, texels.pixels[i][k] + 0.5, 0.5 + 0.05 + 1e-3);
            }
            // A point of a sphere of 48 slices is nearer than its facets' sag to it, and its normal
            // that of the place.
            alpi_receiver_point p;
            alpi_texels_point(&texels, i, &p);
            ASSERT_NEAR(vec3_length(p.position), 1.0, 0.01);
            assert_true(vec3_dot(p.shading_normal, p.position) > 0.98f);
        }
        alpi_texels_destroy(context, &texels);
    }
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

/// Balls of one mesh, each of its own size.
static alp_scene *scene_balls(alp_context *context, uint32_t count)
{
    alpi_builder builder;
    alp_scene *scene = NULL;
    alpi_builder_start(&builder, context, "balls");
    alpi_builder_surface(&builder, "balls", ALPI_NONE);
    for (uint32_t i = 0; i < count; i++) {
        const float radius = 0.25f + 0.5f * (float)keyed(3, i);
        alpi_builder_ball(&builder, &(alpi_ball){.center = {2.0f * (float)i, 0.0f, 0.0f},
                                                 .radius = radius,
                                                 .top = radius,
                                                 .slices = 24,
                                                 .stacks = 12});
    }
    ASSERT_OK(context, alpi_builder_finish(&builder, &scene));
    return scene;
}

/// Charts of what is connected lie on one page where one holds them, so that no triangle loses one.
TEST_WITH_CONTEXT(charts_of_one_piece_share_a_page, 2)
{
    alp_scene *scene = scene_balls(context, 8);
    alp_atlas *atlas = blend_of(context, scene, 128, 20.0); // a ball takes half a page at most
    const uint32_t pages = alp_atlas_get_info(atlas).pages;
    assert_true(pages > 1 && pages < 8);
    assert_int_equal(overlapping_texels(atlas), 0);
    for (uint32_t f = 0; f < atlas->face_count; f++) {
        assert_int_equal(atlas->triangle_pages[f], atlas->triangle_pages[atlas->face_triangles[f]]);
    }
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

/// A material has one map: on several pages all coordinates of a triangle lie on its own.
TEST_WITH_CONTEXT(pages_keep_triangles_together, 2)
{
    alp_scene *scene = smooth_sphere(context);
    alp_atlas *atlas = blend_of(context, scene, 64, 30.0);
    assert_true(alp_atlas_get_info(atlas).pages > 1);
    uint32_t apart = 0;
    for (uint32_t f = 0; f < atlas->face_count; f++) {
        const uint32_t t = atlas->face_triangles[f];
        const uint8_t k = atlas->face_axes[f];
        const bool together = atlas->triangle_pages[f] == atlas->triangle_pages[t];
        assert_int_equal(atlas->set_members[t] >> k & 1, together);
        assert_memory_equal(atlas->set_uvs[t][k], atlas->corner_uvs[together ? f : t],
                            sizeof atlas->corner_uvs[f]);
        apart += !together;
    }
    assert_true(apart > 0);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

/// Surfaces have the density that is asked for them, in whatever set their chart is.
TEST_WITH_CONTEXT(densities_are_kept, 1)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_load(context, "builtin:cornell", &scene));
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_BLEND;
    options.size = 256;
    options.texels_per_metre = 100.0;
    options.densities = "floor=2,lamp=.5";
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    int seen[3] = {0};
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const char *name = scene->surfaces[scene->triangle_surface[t]].name;
        const int kind = strcmp(name, "floor") == 0 ? 1 : strcmp(name, "lamp") == 0 ? 2 : 0;
        const double wanted = kind == 1 ? 200.0 : kind == 2 ? 50.0 : 100.0;
        vec3 c[3];
        double cosines[3];
        alpi_triangle_corners(scene, t, c);
        corner_cosines(scene, t, cosines);
        if (fmax(cosines[0], fmax(cosines[1], cosines[2])) < 0.9999) {
            continue; // projected askew
        }
        // Flat charts keep their lengths, to the rounding of coordinates (test_densities.c).
        ASSERT_NEAR(sqrt(texel_area(atlas, t) / vec3_triangle_area(c[0], c[1], c[2])), wanted,
                    1e-4 * wanted);
        seen[kind]++;
    }
    assert_true(seen[0] > 0 && seen[1] > 0 && seen[2] > 0);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

/// A cap of a sphere up to 87° has 2π (1 − cos 87°) of area and π sin² 87° of its plane: its chart
/// is enlarged by s = 1.9005. What is read of it has s Σ |n_k|³ times the texels that are asked
/// for, a sum that lies between 1/√3 and 1.
TEST_WITH_CONTEXT(what_is_read_is_as_dense_as_asked, 1)
{
    alp_scene *scene = smooth_sphere(context);
    alp_atlas *atlas = blend_of(context, scene, 256, 25.0);
    double least = HUGE_VAL, most = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        vec3 c[3];
        double cosines[3], density = 0.0;
        alpi_triangle_corners(scene, t, c);
        corner_cosines(scene, t, cosines);
        for (uint32_t f = 0; f < atlas->face_count; f++) {
            const double n = cosines[atlas->face_axes[f]];
            density += atlas->face_triangles[f] == t ? n * n * fabs(texel_area(atlas, f)) : 0.0;
        }
        density /= vec3_triangle_area(c[0], c[1], c[2]) * 25.0 * 25.0;
        least = fmin(least, density);
        most = fmax(most, density);
    }
    // A sphere of 48 slices has facets of 7.5°: their cap ends within 3.75° of 87°, where a cosine
    // is .065 more, of which the sum and s have the same share.
    ASSERT_NEAR(least, 1.9005 / sqrt(3.0), 0.07 * 1.9005 / sqrt(3.0));
    ASSERT_NEAR(most, 1.9005, 0.07 * 1.9005);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(weights_are_squares_of_the_normal, 1)
{
    alp_scene *scene = smooth_sphere(context);
    alp_atlas *atlas = blend_of(context, scene, 64, 0.0);
    for (uint32_t i = 0; i < 4000; i++) {
        const uint32_t t = i % scene->triangle_count;
        const float b1 = (float)keyed(i, 0), b2 = (1.0f - b1) * (float)keyed(i, 1);
        float w[3];
        alpi_blend_weights(atlas, t, b1, b2, w);
        ASSERT_NEAR(w[0] + w[1] + w[2], 1.0, 1e-6); // rounding
        vec3 p = {0, 0, 0}; // the normal of a unit sphere is the place, and so in between
        const float shares[3] = {1.0f - b1 - b2, b1, b2};
        for (int k = 0; k < 3; k++) {
            p = vec3_mad(p, shares[k], vec3_load(scene->positions[scene->triangles[t][k]]));
        }
        p = vec3_normalize_or(p, (vec3){0, 0, 0});
        ASSERT_NEAR(w[0], p.x * p.x, 2e-6);
        ASSERT_NEAR(w[1], p.y * p.y, 2e-6);
        ASSERT_NEAR(w[2], p.z * p.z, 2e-6);
    }
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

/// An object that stands askew is projected along its own axes, unless the world's are asked for.
TEST_WITH_CONTEXT(axes_are_those_of_the_object, 1)
{
    alp_scene *scene = scene_cube(context); // its faces along the world's axes
    const float c = 0.70710678f;
    const float askew[3][3] = {
        {2 * c, 0, -2 * c}, {0, 2, 0}, {2 * c, 0, 2 * c}}; // 45°, twice as large
    memcpy(scene->surfaces[0].axes, askew, sizeof askew);
    for (int world = 0; world < 2; world++) {
        alp_atlas_options options = alp_atlas_options_default();
        options.mode = ALP_ATLAS_BLEND;
        options.size = 64;
        const alpi_atlas_choice choice = {.world_axes = world != 0};
        alp_atlas *atlas = NULL;
        ASSERT_OK(context, alpi_atlas_create(scene, &options, &choice, &atlas));
        for (uint32_t t = 0; t < 12; t++) {
            double cosines[3];
            float w[3];
            corner_cosines(scene, t, cosines);
            alpi_blend_weights(atlas, t, 0.2f, 0.3f, w);
            const bool upright = cosines[1] > 0.5;
            ASSERT_NEAR(w[0] + w[1] + w[2], 1.0, 1e-6);
            ASSERT_NEAR(w[1], upright ? 1.0 : 0.0, 1e-6);
            ASSERT_NEAR(w[0], upright ? 0.0 : world ? cosines[0] * cosines[0] : 0.5, 1e-6);
            assert_int_equal(__builtin_popcount(atlas->set_members[t]), upright || world ? 1 : 2);
        }
        alp_atlas_destroy(atlas);
    }
    alp_scene_destroy(scene);
}

TEST(is_the_same_for_any_number_of_workers)
{
    alp_context *contexts[2] = {test_context(1), test_context(4)};
    alp_atlas *atlases[2];
    alp_scene *scenes[2];
    for (int i = 0; i < 2; i++) {
        ASSERT_OK(contexts[i], alp_scene_load(contexts[i], "builtin:teapot-room", &scenes[i]));
        atlases[i] = blend_of(contexts[i], scenes[i], 256, 0.0);
        assert_int_equal(overlapping_texels(atlases[i]), 0);
    }
    assert_int_equal(atlases[0]->info.texels, atlases[1]->info.texels);
    assert_memory_equal(atlases[0]->set_uvs, atlases[1]->set_uvs,
                        scenes[0]->triangle_count * sizeof *atlases[0]->set_uvs);
    for (int i = 0; i < 2; i++) {
        alp_atlas_destroy(atlases[i]);
        alp_scene_destroy(scenes[i]);
        alp_context_destroy(contexts[i]);
    }
}

TEST(running_out_of_memory_leaves_nothing)
{
    int left = 1 << 30;
    alp_context *context = test_context_failing(&left);
    alp_scene *scene = scene_cube(context); // the same steps as of more triangles, and few texels
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_BLEND;
    options.size = 16;
    options.texels_per_metre = 4.0; // on several pages
    for (int allowed = 0;; allowed++) {
        alp_atlas *atlas = NULL;
        left = allowed;
        const alp_result result = alp_atlas_create(scene, &options, &atlas);
        left = 1 << 30;
        alp_atlas_destroy(atlas);
        if (result == ALP_OK) {
            break;
        }
        assert_int_equal(result, ALP_ERROR_OUT_OF_MEMORY);
        assert_null(atlas);
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}
