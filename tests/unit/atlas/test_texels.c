// SPDX-License-Identifier: MIT
// Texels: areas add up, receivers lie on the surface, and nothing is too thin to have one.
#include "atlas_scenes.h"

#include <stdlib.h>

static void check_texels(alp_context *context, alp_scene *scene, uint32_t size, double density)
{
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_CHARTS;
    options.size = size;
    options.texels_per_metre = density;
    alp_atlas *atlas = NULL;
    alpi_texels texels;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    assert_int_equal(texels.count, alp_atlas_get_info(atlas).texels);
    double area = 0.0, coverage = 0.0, uv_area = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        uv_area += scene->triangle_usable[t] ? fmax(texel_area(atlas, t), 0.0) : 0.0;
    }
    for (uint32_t i = 0; i < texels.count; i++) {
        area += (double)texels.areas[i];
        coverage += (double)texels.coverages[i];
        assert_true(texels.coverages[i] > 0.0f && texels.coverages[i] <= 1.0f);
        if (i > 0) {
            uint64_t now = ((uint64_t)texels.pages[i] << 32) |
                           ((uint32_t)texels.pixels[i][1] << 16) | texels.pixels[i][0];
            uint64_t before = ((uint64_t)texels.pages[i - 1] << 32) |
                              ((uint32_t)texels.pixels[i - 1][1] << 16) | texels.pixels[i - 1][0];
            assert_true(now > before);
        }
    }
    ASSERT_NEAR(area, scene->area, 1e-4 * scene->area);
    ASSERT_NEAR(coverage, uv_area, 1e-4 * uv_area);
    for (uint32_t i = 0; i < texels.count; i++) {
        float b1 = texels.barycentrics[i][0], b2 = texels.barycentrics[i][1];
        assert_true(b1 >= 0.0f && b2 >= 0.0f && b1 + b2 <= 1.000001f);
        const float(*uv)[2] = (const float(*)[2])atlas->corner_uvs[texels.triangles[i]];
        double at[2]; // the point in the page lies in the texel
        for (int k = 0; k < 2; k++) {
            at[k] = (double)((1.0f - b1 - b2) * uv[0][k] + b1 * uv[1][k] + b2 * uv[2][k]) * size;
            ASSERT_NEAR(at[k], texels.pixels[i][k] + 0.5, 0.55 + 1e-3); // off an edge by .05
        }
        vec3 c[3];
        alpi_triangle_corners(scene, texels.triangles[i], c);
        vec3 normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0, 0, 0});
        alpi_receiver_point point;
        alpi_texels_point(&texels, i, &point);
        ASSERT_NEAR(vec3_dot(normal, vec3_sub(point.position, c[0])), 0.0, 1e-5);
        ASSERT_NEAR(vec3_dot(normal, point.geometric_normal), 1.0, 1e-5);
        ASSERT_NEAR(vec3_length(point.shading_normal), 1.0, 1e-5);
        assert_true(vec3_dot(point.geometric_normal, point.shading_normal) > 0.0f);
        ASSERT_NEAR(vec3_dot(point.shading_normal, vec3_load(texels.normals[i])), 1.0, 1e-6);
    }
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(areas_add_up, 1)
{
    check_texels(context, scene_cube(context), 64, 0.0);
    check_texels(context, scene_sphere(context, 12, 24), 128, 0.0);
    check_texels(context, scene_sphere(context, 12, 24), 33, 20.0); // several pages
    check_texels(context, scene_sphere(context, 60, 120), 16, 0.0); // triangles below a texel
    check_texels(context, scene_spiral(context, 3), 100, 0.0);
    check_texels(context, scene_confetti(context, 30), 64, 0.0);
}

TEST_WITH_CONTEXT(normals_that_point_inside_are_not_used, 1)
{
    // A square whose vertex normals are turned over: a hemisphere inside the surface sees nothing.
    const float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}};
    const float normals[4][3] = {{0, -1, 0}, {0, -1, 0}, {0, -1, 0}, {0, -1, 0}};
    const uint32_t indices[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const alp_mesh mesh = {.vertex_count = 4,
                           .positions = positions[0],
                           .normals = normals[0],
                           .triangle_count = 2,
                           .indices = indices[0]};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    check_texels(context, scene, 16, 0.0);
}

/// Utilisation as conventions.md defines it, texel by texel.
static double plain_utilisation(const alp_atlas *atlas, const alpi_texels *texels, int padding)
{
    int size = (int)atlas->info.width;
    size_t room = (size_t)atlas->info.pages * (size_t)size * (size_t)size, taken = 0;
    bool *used = calloc(room, sizeof *used);
    assert_non_null(used);
    for (uint32_t i = 0; i < texels->count; i++) {
        int x = texels->pixels[i][0], y = texels->pixels[i][1];
        for (int v = y - padding; v <= y + padding; v++) {
            for (int u = x - padding; u <= x + padding; u++) {
                if (u >= 0 && v >= 0 && u < size && v < size) {
                    used[((size_t)texels->pages[i] * (size_t)size + (size_t)v) * (size_t)size +
                         (size_t)u] = true;
                }
            }
        }
    }
    for (size_t i = 0; i < room; i++) {
        taken += used[i];
    }
    free(used);
    return (double)taken / (double)room;
}

TEST_SLOW_WITH_CONTEXT(utilisation_counts_charts_and_padding, 1)
{
    alp_scene *scene = scene_confetti(context, 200);
    const uint32_t paddings[] = {0, 1, 2, 5, 13, 64};
    int several = 0;
    for (int i = 0; i < 24; i++) {
        alp_atlas_options options = alp_atlas_options_default();
        options.mode = ALP_ATLAS_CHARTS;
        options.size = i < 12 ? 64 : 150;
        options.padding = paddings[i % 12 / 2];
        options.texels_per_metre = i % 2 == 0 ? 0.0 : i < 12 ? 45.0 : 105.0; // one page, or several
        alp_atlas *atlas = NULL;
        alpi_texels texels;
        ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
        ASSERT_OK(context, alpi_texels_create(atlas, &texels));
        several += atlas->info.pages > 1;
        ASSERT_NEAR(atlas->info.utilisation,
                    plain_utilisation(atlas, &texels, (int)options.padding), 1e-12);
        alpi_texels_destroy(context, &texels);
        alp_atlas_destroy(atlas);
    }
    assert_true(several >= 10);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_center_is_the_receiver, 1)
{
    static const float p[4][3] = {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}};
    static const float uvs[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    static const uint32_t indices[2][3] = {{0, 1, 2}, {2, 3, 0}};
    alp_scene *scene = scene_of(context, p, uvs, 4, indices, 2);
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_KEEP;
    options.size = 8;
    alp_atlas *atlas = NULL;
    alpi_texels texels;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    assert_int_equal(texels.count, 64);
    for (uint32_t i = 0; i < 64; i++) { // one metre a texel
        alpi_receiver_point point;
        alpi_texels_point(&texels, i, &point);
        double dx = (double)point.position.x - texels.pixels[i][0] - 0.5;
        double dy = (double)point.position.y - texels.pixels[i][1] - 0.5;
        bool diagonal = texels.pixels[i][0] == texels.pixels[i][1];
        ASSERT_NEAR(hypot(dx, dy), diagonal ? 0.05 : 0.0, 1e-6); // not on the edge itself
        assert_true(!diagonal || dx > dy);                       // into the first triangle
        ASSERT_NEAR(texels.areas[i], 1.0, 1e-6);
        ASSERT_NEAR(texels.coverages[i], 1.0, 1e-6);
        // On the diagonal both triangles hold the centre: the first has it.
        assert_int_equal(texels.triangles[i], texels.pixels[i][1] > texels.pixels[i][0]);
    }
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

/// The texels of one triangle with these kept coordinates, in texels of a page of 8.
static void texels_of(alp_context *context, const double corner[3][2], alpi_texels *texels,
                      alp_scene **scene, alp_atlas **atlas)
{
    static const float p[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static const uint32_t index[1][3] = {{0, 1, 2}};
    float uvs[3][2];
    for (int k = 0; k < 6; k++) {
        uvs[k / 2][k % 2] = (float)(corner[k / 2][k % 2] / 8.0);
    }
    *scene = scene_of(context, p, (const float(*)[2])uvs, 3, index, 1);
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_KEEP;
    options.size = 8;
    ASSERT_OK(context, alp_atlas_create(*scene, &options, atlas));
    ASSERT_OK(context, alpi_texels_create(*atlas, texels));
}

TEST_WITH_CONTEXT(thin_triangles_have_texels, 1)
{
    static const double shapes[][3][2] = {
        {{1.1, 1.1}, {6.9, 1.1}, {6.9, 1.1001}},  // along a row, off the centres
        {{1.1, 1.0}, {6.9, 1.0}, {6.9, 1.00001}}, // along a border
        {{0.1, 0.3}, {7.6, 7.8}, {7.6, 7.80001}}, // a diagonal needle
        {{3.2, 3.2}, {3.2001, 3.2}, {3.2, 3.2001}},
    };
    const uint32_t counts[] = {6, 6, 15, 1};
    for (int i = 0; i < 4; i++) {
        alpi_texels texels;
        alp_scene *scene;
        alp_atlas *atlas;
        texels_of(context, shapes[i], &texels, &scene, &atlas);
        assert_int_equal(texels.count, counts[i]);
        double area = 0.0;
        for (uint32_t t = 0; t < texels.count; t++) {
            area += (double)texels.areas[t];
            float b1 = texels.barycentrics[t][0], b2 = texels.barycentrics[t][1];
            assert_true(b1 > 0.0f && b2 > 0.0f && b1 + b2 < 1.0f); // inside, not on the edge
        }
        ASSERT_NEAR(area, 0.5, 1e-3);
        alpi_texels_destroy(context, &texels);
        alp_atlas_destroy(atlas);
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(a_side_on_a_border_does_not_leak, 1)
{
    // 3 and 5 eighths are exact; a ninth is not, and its float may lie on either side.
    for (uint32_t size = 3; size < 200; size += 7) {
        static const float p[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
        static const uint32_t indices[2][3] = {{0, 1, 2}, {2, 3, 0}};
        float low = 1.0f / (float)size, high = (float)(size - 1) / (float)size;
        float uvs[4][2] = {{low, low}, {high, low}, {high, high}, {low, high}};
        alp_scene *scene = scene_of(context, p, (const float(*)[2])uvs, 4, indices, 2);
        alp_atlas_options options = alp_atlas_options_default();
        options.mode = ALP_ATLAS_KEEP;
        options.size = size;
        alp_atlas *atlas = NULL;
        ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
        assert_int_equal(alp_atlas_get_info(atlas).texels, (size - 2) * (size - 2));
        alp_atlas_destroy(atlas);
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(tiny_triangles_are_counted, 1)
{
    alp_scene *scene = scene_plane(context, 40); // 3200 triangles on 16 × 16 texels
    alp_atlas_options options = alp_atlas_options_default();
    options.size = 16;
    alp_atlas *atlas = NULL;
    test_log_clear();
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    assert_true(test_log_has("tiny-triangles"));
    assert_int_equal(alp_atlas_get_info(atlas).shared_triangles, 3200 - 256);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

/// The peer's scenes come with charts: the Cornell box's are aligned to the texels of 256².
TEST(peers_cover_the_same)
{
    const char *names[] = {"peers/blender/cornell.glb", "peers/blender/sphere_plane.glb"};
    const uint64_t low[] = {47290, 28242}, high[] = {47290, 28900};
    for (int i = 0; i < 2; i++) {
        const char *path = test_shared(names[i]);
        if (path == NULL) {
            skip();
        }
        alp_context *context = test_context(1);
        alp_scene *scene = NULL;
        ASSERT_OK(context, alp_scene_load(context, path, &scene));
        alp_atlas_options options = alp_atlas_options_default();
        options.mode = ALP_ATLAS_KEEP;
        options.size = 256;
        alp_atlas *atlas = NULL;
        ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
        assert_in_range(alp_atlas_get_info(atlas).texels, low[i], high[i]);
        alp_atlas_destroy(atlas);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}
