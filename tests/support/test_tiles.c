// SPDX-License-Identifier: MIT
#include "test_tiles.h"

#include <math.h>
#include <stdlib.h>

alp_scene *test_tiles_scene(alp_context *context, const test_tile *tiles, uint32_t count,
                            uint32_t size)
{
    static const uint32_t indices[2][3] = {{0, 1, 2}, {0, 2, 3}};
    static float positions[TEST_TILE_LIMIT][4][3], uvs[TEST_TILE_LIMIT][4][2];
    alp_mesh meshes[TEST_TILE_LIMIT];
    assert_in_range(count, 1, TEST_TILE_LIMIT);
    for (uint32_t i = 0; i < count; i++) {
        const test_tile *t = &tiles[i];
        for (int c = 0; c < 4; c++) {
            const float a = c == 1 || c == 2 ? 1.0f : 0.0f, b = c >= 2 ? 1.0f : 0.0f;
            for (int k = 0; k < 3; k++) {
                positions[i][c][k] = t->p[k] + a * t->u[k] + b * t->v[k];
            }
            for (int k = 0; k < 2; k++) {
                uvs[i][c][k] = (t->at[k] + a * t->du[k] + b * t->dv[k]) / (float)size;
            }
        }
        meshes[i] = (alp_mesh){.positions = &positions[i][0][0],
                               .uvs = &uvs[i][0][0],
                               .indices = &indices[0][0],
                               .vertex_count = 4,
                               .triangle_count = 2,
                               .base_color = {0.5f, 0.5f, 0.5f}};
    }
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, count, &scene));
    return scene;
}

alp_lightmap *test_tiles_lightmap(alp_scene *scene, uint32_t size)
{
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_KEEP;
    options.size = size;
    alp_atlas *atlas = NULL;
    ASSERT_OK(scene->context, alp_atlas_create(scene, &options, &atlas));
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(scene->context, alpi_lightmap_create(atlas, &lightmap));
    return lightmap;
}

/// Where the centre of a texel lies on a tile, in its sides. @return texels outside of it
static double place(const test_tile *t, uint32_t x, uint32_t y, double at[2])
{
    const double dx = x + 0.5 - (double)t->at[0], dy = y + 0.5 - (double)t->at[1];
    const double a = (double)t->du[0], b = (double)t->dv[0], c = (double)t->du[1],
                 d = (double)t->dv[1], area = a * d - b * c;
    at[0] = (dx * d - dy * b) / area;
    at[1] = (dy * a - dx * c) / area;
    const double sides[2] = {hypot(a, c), hypot(b, d)};
    double outside = 0.0;
    for (int k = 0; k < 2; k++) {
        outside = fmax(outside, fmax(-at[k], at[k] - 1.0) * sides[k]);
    }
    return outside;
}

float *test_tiles_page(const alp_lightmap *lightmap, const test_tile *tiles, uint32_t count,
                       test_tile_paint *paint, const void *user)
{
    const uint32_t w = lightmap->width, h = lightmap->height;
    float *page = calloc((size_t)w * h, 4 * sizeof *page);
    assert_non_null(page);
    for (uint32_t i = 0; i < w * h; i++) {
        float value = 1e3f;
        double nearest = 2.0, at[2];
        for (uint32_t t = 0; t < count; t++) {
            const double outside = place(&tiles[t], i % w, i / w, at);
            if (outside > nearest) {
                continue;
            }
            double point[3];
            for (int k = 0; k < 3; k++) {
                point[k] = (double)tiles[t].p[k] + at[0] * (double)tiles[t].u[k] +
                           at[1] * (double)tiles[t].v[k];
            }
            nearest = outside;
            value = paint(user, t, point);
        }
        float *pixel = page + 4 * (size_t)i;
        pixel[0] = pixel[1] = pixel[2] = value;
        pixel[3] = 1.0f;
    }
    return page;
}
