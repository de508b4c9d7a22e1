// SPDX-License-Identifier: MIT
// Whole atlases of new charts: nothing overlaps or is mirrored, lengths are kept, pages hold.
#include "atlas_scenes.h"

#include "base/memory.h"

#include <stdlib.h>

static alp_atlas *atlas_of(alp_context *context, const alp_scene *scene, uint32_t size,
                           double density, uint32_t padding)
{
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_CHARTS;
    options.size = size;
    options.texels_per_metre = density;
    options.padding = padding;
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    return atlas;
}

/// Every usable triangle has its place in [0, 1]², a chart and a page, and is not mirrored.
static void check_triangles(const alp_atlas *atlas)
{
    alp_atlas_info info = alp_atlas_get_info(atlas);
    assert_int_equal(info.mode, ALP_ATLAS_CHARTS);
    for (uint32_t t = 0; t < atlas->scene->triangle_count; t++) {
        for (int k = 0; k < 6; k++) {
            float value = alp_atlas_corner_uvs(atlas)[6 * (size_t)t + (size_t)k];
            assert_true(value >= 0.0f && value <= 1.0f);
        }
        assert_true(alp_atlas_triangle_pages(atlas)[t] < info.pages);
        if (atlas->scene->triangle_usable[t]) {
            assert_true(atlas->triangle_charts[t] < info.charts);
            assert_true(texel_area(atlas, t) >= -1e-3 * info.width * 1e-3);
        } else {
            assert_int_equal(atlas->triangle_charts[t], ALPI_NONE);
        }
    }
}

/// No texel of a chart is within `padding` of another chart's on its page.
static void check_padding(const alp_atlas *atlas)
{
    uint32_t size = atlas->info.width, padding = atlas->options.padding;
    alpi_texels texels;
    ASSERT_OK(atlas->context, alpi_texels_create(atlas, &texels));
    uint32_t *chart = ALPI_NEW(atlas->context, uint32_t, (size_t)size * size);
    assert_non_null(chart);
    for (uint32_t page = 0; page < atlas->info.pages; page++) {
        memset(chart, 0xff, (size_t)size * size * sizeof *chart);
        for (uint32_t i = texels.page_first[page]; i < texels.page_first[page + 1]; i++) {
            assert_int_equal(texels.pages[i], page);
            chart[texels.pixels[i][1] * size + texels.pixels[i][0]] = texels.charts[i];
        }
        for (uint32_t i = texels.page_first[page]; i < texels.page_first[page + 1]; i++) {
            uint32_t x = texels.pixels[i][0], y = texels.pixels[i][1];
            for (uint32_t v = y > padding ? y - padding : 0; v <= y + padding && v < size; v++) {
                for (uint32_t u = x > padding ? x - padding : 0; u <= x + padding && u < size;
                     u++) {
                    uint32_t other = chart[v * size + u];
                    assert_true(other == ALPI_NONE || other == texels.charts[i]);
                }
            }
        }
    }
    alpi_release(atlas->context, chart);
    alpi_texels_destroy(atlas->context, &texels);
}

static void check_scene(alp_context *context, alp_scene *scene)
{
    const uint32_t sizes[] = {16, 100, 256};
    for (int i = 0; i < 3; i++) {
        for (int pages = 0; pages < 2; pages++) {
            double density = pages == 0 ? 0.0 : 0.4 * sizes[i];
            alp_atlas *atlas = atlas_of(context, scene, sizes[i], density, 2);
            check_triangles(atlas);
            assert_int_equal(overlapping_texels(atlas), 0);
            check_padding(atlas);
            alp_atlas_destroy(atlas);
        }
    }
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(nothing_overlaps, 1)
{
    check_scene(context, scene_cube(context));
    check_scene(context, scene_sphere(context, 12, 24));
    check_scene(context, scene_spiral(context, 5));
    check_scene(context, scene_plane(context, 3));
    check_scene(context, scene_confetti(context, 40));
}

TEST_WITH_CONTEXT(charts_have_the_area_of_their_triangles, 1)
{
    alp_scene *scene = scene_sphere(context, 10, 20);
    alp_atlas *atlas = atlas_of(context, scene, 512, 64.0, 2);
    double *areas = ALPI_NEW(context, double, 2 * (size_t)atlas->info.charts);
    assert_non_null(areas);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (scene->triangle_usable[t]) {
            vec3 c[3];
            alpi_triangle_corners(scene, t, c);
            areas[2 * atlas->triangle_charts[t]] += texel_area(atlas, t);
            areas[2 * atlas->triangle_charts[t] + 1] +=
                64.0 * 64.0 * vec3_triangle_area(c[0], c[1], c[2]);
        }
    }
    for (uint32_t i = 0; i < atlas->info.charts; i++) {
        // Coordinates are floats of a page: 1e-7 of 512 texels, in charts of some hundred across.
        ASSERT_NEAR(areas[2 * i], areas[2 * i + 1], 1e-5 * areas[2 * i + 1]);
    }
    alpi_release(context, areas);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_turned_square_gets_a_tight_box, 1)
{
    float p[4][3];
    for (int i = 0; i < 4; i++) {
        double angle = 0.3 + 0.5 * ALPI_PI * i;
        p[i][0] = (float)cos(angle);
        p[i][1] = (float)sin(angle);
        p[i][2] = 5.0f;
    }
    static const uint32_t indices[2][3] = {{0, 1, 2}, {2, 3, 0}};
    alp_scene *scene = scene_of(context, (const float(*)[3])p, NULL, 4, indices, 2);
    alp_atlas *atlas = atlas_of(context, scene, 64, 0.0, 2);
    alp_atlas_info info = alp_atlas_get_info(atlas);
    assert_int_equal(info.charts, 1);
    assert_int_equal(info.texels, 64 * 64);
    ASSERT_NEAR(info.texels_per_metre, 64.0 / sqrt(2.0), 0.01);
    ASSERT_NEAR(info.utilisation, 1.0, 1e-12);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(one_page_is_well_used, 1)
{
    alp_scene *scene = scene_sphere(context, 30, 60);
    alp_atlas *atlas = atlas_of(context, scene, 256, 0.0, 2);
    alp_atlas_info info = alp_atlas_get_info(atlas);
    assert_int_equal(info.pages, 1);
    assert_true(info.utilisation > 0.6 && info.utilisation <= 1.0);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_chart_larger_than_a_page_is_cut, 1)
{
    alp_scene *scene = scene_plane(context, 16); // 2 m; at 100 texels per metre 200 texels
    alp_atlas *atlas = atlas_of(context, scene, 64, 100.0, 2);
    assert_in_range(alp_atlas_get_info(atlas).pages, 10, 11); // 200² / 64² = 9.8; see test_cut
    ASSERT_NEAR(alp_atlas_get_info(atlas).texels_per_metre, 100.0, 0.01);
    check_triangles(atlas);
    assert_int_equal(overlapping_texels(atlas), 0);
    alp_atlas_destroy(atlas);
    alp_atlas_options options = alp_atlas_options_default();
    options.size = 64;
    options.texels_per_metre = 1000.0; // a triangle of 0.125 m has 125 texels
    assert_int_equal(alp_atlas_create(scene, &options, &atlas), ALP_ERROR_LIMIT);
    assert_non_null(strstr(alp_context_message(context), "larger than a page of 64"));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(sizes_at_their_ends, 1)
{
    alp_scene *scene = scene_cube(context);
    alp_atlas *atlas = atlas_of(context, scene, 1, 0.0, 64);
    assert_int_equal(alp_atlas_get_info(atlas).pages, 1);
    assert_int_equal(alp_atlas_get_info(atlas).texels, 1);
    check_triangles(atlas);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    scene = scene_confetti(context, 6);
    atlas = atlas_of(context, scene, 2, 0.0, 0); // 6 charts, 4 texels: two pages
    assert_int_equal(alp_atlas_get_info(atlas).pages, 2);
    assert_in_range(alp_atlas_get_info(atlas).texels, 6, 8);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(bad_options_are_refused, 1)
{
    alp_scene *scene = scene_cube(context);
    const alp_atlas_options good = alp_atlas_options_default();
    alp_atlas_options bad[] = {good, good, good, good, good, good, good, good};
    bad[0].size = 0;
    bad[1].size = 16385;
    bad[2].padding = 65;
    bad[3].max_angle = 0.0f;
    bad[4].max_angle = 1.21f;
    bad[5].texels_per_metre = -1.0;
    bad[6].texels_per_metre = (double)NAN;
    bad[7].struct_size = 0;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        alp_atlas *atlas = NULL;
        assert_int_equal(alp_atlas_create(scene, &bad[i], &atlas), ALP_ERROR_INVALID_ARGUMENT);
        assert_null(atlas);
    }
    alp_atlas_destroy(NULL);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(nothing_to_bake_is_said, 1)
{
    static const float p[3][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    static const uint32_t index[1][3] = {{0, 1, 2}};
    alp_scene *scene = scene_of(context, p, NULL, 3, index, 1);
    alp_atlas *atlas = NULL;
    assert_int_equal(alp_atlas_create(scene, NULL, &atlas), ALP_ERROR_INVALID_DATA);
    assert_non_null(strstr(alp_context_message(context), "nothing to bake"));
    alp_scene_destroy(scene);
}

static bool refuse(void *user, const alp_progress *progress)
{
    (void)user;
    assert_non_null(progress->stage);
    return false;
}

TEST_WITH_CONTEXT(progress_can_cancel, 1)
{
    alp_scene *scene = scene_cube(context);
    alp_atlas_options options = alp_atlas_options_default();
    options.progress = refuse;
    alp_atlas *atlas = NULL;
    assert_int_equal(alp_atlas_create(scene, &options, &atlas), ALP_ERROR_CANCELLED);
    alp_scene_destroy(scene);
}

TEST(workers_change_nothing)
{
    alp_atlas *atlases[2];
    alp_scene *scenes[2];
    alp_context *contexts[2];
    for (int i = 0; i < 2; i++) {
        contexts[i] = test_context(i == 0 ? 1 : 7);
        scenes[i] = scene_sphere(contexts[i], 20, 40);
        atlases[i] = atlas_of(contexts[i], scenes[i], 128, 0.0, 2);
    }
    assert_memory_equal(atlases[0]->corner_uvs, atlases[1]->corner_uvs,
                        scenes[0]->triangle_count * sizeof *atlases[0]->corner_uvs);
    for (int i = 0; i < 2; i++) {
        alp_atlas_destroy(atlases[i]);
        alp_scene_destroy(scenes[i]);
        alp_context_destroy(contexts[i]);
    }
}

/// Allocator that fails once its countdown is at zero.
TEST(every_allocation_may_fail)
{
    int left = 0, failures = 0;
    alp_context *context = test_context_failing(&left);
    alp_scene *scene = scene_sphere(context, 6, 12);
    alp_atlas_options options = alp_atlas_options_default();
    options.size = 16;
    options.texels_per_metre = 15.0; // several pages and cut charts
    for (bool done = false; !done; failures++) {
        alp_atlas *atlas = NULL;
        alpi_texels texels = {0};
        left = failures;
        alp_result result = alp_atlas_create(scene, &options, &atlas);
        result = result == ALP_OK ? alpi_texels_create(atlas, &texels) : result;
        // the allocator reads it
        left = 1 << 30;
        done = result == ALP_OK;
        assert_true(done || result == ALP_ERROR_OUT_OF_MEMORY);
        alpi_texels_destroy(context, &texels);
        alp_atlas_destroy(atlas);
    }
    assert_true(failures > 30);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST_WITH_CONTEXT(a_picture_shows_the_charts, 1)
{
    alp_scene *scene = scene_cube(context);
    alp_atlas *atlas = atlas_of(context, scene, 64, 0.0, 2);
    alp_image *image = NULL;
    ASSERT_OK(context, alp_atlas_picture(atlas, 0, &image));
    uint64_t lit = 0;
    for (uint32_t i = 0; i < 64 * 64; i++) {
        lit += alp_image_bytes(image)[3 * i] > 0;
    }
    assert_int_equal(lit, alp_atlas_get_info(atlas).texels);
    alp_image_destroy(image);
    assert_int_equal(alp_atlas_picture(atlas, 1, &image), ALP_ERROR_INVALID_ARGUMENT);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}
