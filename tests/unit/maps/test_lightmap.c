// SPDX-License-Identifier: MIT
// Maps over an atlas: what is stored at texels is read back at their points on the surface.
#include "test_scenes.h"

#include "maps/lightmap.h"

#include <math.h>

static alp_lightmap *make_lightmap(alp_scene *scene, uint32_t size)
{
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_CHARTS;
    options.size = size;
    alp_atlas *atlas = NULL;
    ASSERT_OK(scene->context, alp_atlas_create(scene, &options, &atlas));
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(scene->context, alpi_lightmap_create(atlas, &lightmap));
    return lightmap;
}

TEST_WITH_CONTEXT(a_linear_function_is_read_back, 1)
{
    // Bilinear look-up reproduces a function that is linear over a flat chart, away from its
    // border.
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 2}, (double[]){3, 0, 0}, (double[]){0, 0, -2});
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alp_lightmap *lightmap = make_lightmap(scene, 64);
    const alpi_texels *texels = &lightmap->texels;
    static float values[64 * 64];
    assert_in_range(texels->count, 64 * 30, 64 * 64);
    for (uint32_t i = 0; i < texels->count; i++) {
        alpi_receiver_point point;
        alpi_texels_point(texels, i, &point);
        values[i] = 0.1f + 0.2f * point.position.x + 0.05f * point.position.z;
    }
    ASSERT_OK(context, alpi_lightmap_store(lightmap, values));
    for (uint32_t t = 0; t < 2; t++) {
        for (int i = 1; i < 9; i++) {
            for (int j = 1; i + j < 10; j++) {
                float b1 = 0.1f * (float)i, b2 = 0.1f * (float)j, rgb[3];
                vec3 c[3];
                alpi_triangle_corners(scene, t, c);
                float x = c[0].x + b1 * (c[1].x - c[0].x) + b2 * (c[2].x - c[0].x);
                float z = c[0].z + b1 * (c[1].z - c[0].z) + b2 * (c[2].z - c[0].z);
                alpi_lightmap_sample(lightmap, t, b1, b2, rgb);
                ASSERT_NEAR(rgb[0], 0.1f + 0.2f * x + 0.05f * z, 1e-4);
                assert_true(rgb[0] == rgb[1] && rgb[1] == rgb[2]);
            }
        }
    }
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(values_go_to_their_own_page, 1)
{
    // Squares of one metre at 16 texels per metre, one to a page of 16.
    enum { SQUARES = 3 };
    test_mesh *mesh = test_mesh_start();
    for (int i = 0; i < SQUARES; i++) {
        test_mesh_quad(mesh, (double[]){2.0 * i, 0, 1}, (double[]){1, 0, 0}, (double[]){0, 0, -1});
    }
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_CHARTS;
    options.size = 16;
    options.texels_per_metre = 16.0;
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alpi_lightmap_create(atlas, &lightmap));
    assert_int_equal(alp_lightmap_page_count(lightmap), SQUARES);
    const alpi_texels *texels = &lightmap->texels;
    static float values[SQUARES * 16 * 16];
    assert_int_equal(texels->count, SQUARES * 16 * 16);
    for (uint32_t i = 0; i < texels->count; i++) {
        values[i] = 0.1f + 0.2f * (float)(texels->triangles[i] / 2);
    }
    ASSERT_OK(context, alpi_lightmap_store(lightmap, values));
    for (uint32_t t = 0; t < 2 * SQUARES; t++) {
        float rgb[3];
        alpi_lightmap_sample(lightmap, t, 0.3f, 0.3f, rgb);
        ASSERT_NEAR(rgb[0], 0.1f + 0.2f * (float)(t / 2), 1e-6);
    }
    for (uint32_t p = 0; p <= SQUARES; p++) { // texels are listed page by page
        assert_int_equal(texels->page_first[p], p * 16 * 16);
    }
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(pages_become_images, 1)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 1}, (double[]){1, 0, 0}, (double[]){0, 0, -1});
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alp_lightmap *lightmap = make_lightmap(scene, 16);
    static float values[16 * 16];
    const float stored[] = {0.0f, 0.25f, 0.5f, 1.0f};
    const int bytes[] = {0, 64, 128, 255}; // 255·v + ½, rounded down
    for (int i = 0; i < 4; i++) {
        for (uint32_t t = 0; t < lightmap->texels.count; t++) {
            values[t] = stored[i];
        }
        ASSERT_OK(context, alpi_lightmap_store(lightmap, values));
        alp_image *image = NULL;
        ASSERT_OK(context, alpi_lightmap_page_image(lightmap, 0, ALP_COMPONENT_U8, &image));
        assert_int_equal(image->info.channels, 1);
        for (int p = 0; p < 16 * 16; p++) {
            assert_int_equal(alp_image_bytes(image)[p], bytes[i]); // dilated everywhere
        }
        alp_image_destroy(image);
    }
    uint32_t width = 0, height = 0;
    const float *page = alp_lightmap_page(lightmap, 0, &width, &height);
    assert_non_null(page);
    assert_int_equal(width, 16);
    assert_int_equal(height, 16);
    assert_null(alp_lightmap_page(lightmap, 1, NULL, NULL));
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}
