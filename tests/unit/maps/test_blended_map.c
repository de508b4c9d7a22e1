// SPDX-License-Identifier: MIT
// Maps of overlapping charts: what is painted is read back, and where a chart ends the blend by the
// normal has no step to speak of; the plain average has.
#include "test_support.h"

#include "atlas/blend.h"
#include "base/memory.h"
#include "base/random.h"
#include "maps/lightmap.h"
#include "scene/adjacency.h"
#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdlib.h>

static alp_scene *smooth_sphere(alp_context *context)
{
    alpi_builder builder;
    alp_scene *scene = NULL;
    alpi_builder_start(&builder, context, "sphere");
    alpi_builder_surface(&builder, "sphere", ALPI_NONE);
    alpi_builder_ball(&builder,
                      &(alpi_ball){.radius = 1.0f, .top = 1.0f, .slices = 96, .stacks = 48});
    ASSERT_OK(context, alpi_builder_finish(&builder, &scene));
    return scene;
}

static alp_lightmap *make_map(const alp_scene *scene, uint32_t size)
{
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_BLEND;
    options.size = size;
    alp_atlas *atlas = NULL;
    ASSERT_OK(scene->context, alp_atlas_create(scene, &options, &atlas));
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(scene->context, alpi_lightmap_create(atlas, &lightmap));
    return lightmap;
}

static vec3 point_of(const alp_scene *scene, uint32_t triangle, float b1, float b2)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_mad(vec3_mad(vec3_scale(c[0], 1.0f - b1 - b2), b1, c[1]), b2, c[2]);
}

static float linear_at(vec3 p)
{
    return 0.5f + 0.2f * p.x - 0.1f * p.y + 0.15f * p.z;
}

TEST_WITH_CONTEXT(a_linear_function_is_read_back, 2)
{
    alp_scene *scene = smooth_sphere(context);
    alp_lightmap *lightmap = make_map(scene, 256);
    const alpi_texels *texels = &lightmap->texels;
    float *values = calloc(texels->count, sizeof *values);
    assert_non_null(values);
    for (uint32_t i = 0; i < texels->count; i++) {
        values[i] = linear_at(point_of(scene, texels->triangles[i], texels->barycentrics[i][0],
                                       texels->barycentrics[i][1]));
    }
    ASSERT_OK(context, alpi_lightmap_store(lightmap, values));
    free(values);
    double worst = 0.0, sum = 0.0;
    const uint32_t count = 20000;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t t = i % scene->triangle_count;
        float b1 = alpi_unit_float(alpi_random_key(1, i, 0));
        float b2 = (1.0f - b1) * alpi_unit_float(alpi_random_key(1, i, 1)), rgb[3];
        alpi_lightmap_sample(lightmap, t, b1, b2, rgb);
        const double off = fabs((double)rgb[0] - (double)linear_at(point_of(scene, t, b1, b2)));
        worst = fmax(worst, off);
        sum += off;
    }
    // Inside of a chart the look-up is right but for the curvature of the surface. At its rim
    // points of covered texels lie off their centres, and texels outside repeat their neighbours:
    // half a texel, 19 times as long there and seen with a weight of .0097, of a gradient of .27.
    const double texel = 1.0 / alp_atlas_get_info(lightmap->atlas).texels_per_metre;
    assert_true(worst < 0.5 * 19.0 * 0.0097 * 0.27 * texel);
    assert_true(sum / count < 0.01 * texel);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

/// The largest difference of look-ups at points of edges from the triangles on their two sides.
static double largest_step(const alp_scene *scene, const alp_lightmap *lightmap)
{
    uint32_t(*neighbours)[3] = NULL;
    ASSERT_OK(scene->context, alpi_adjacency_create(scene, &neighbours));
    double worst = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            const uint32_t other = neighbours[t][k];
            assert_int_not_equal(other, ALPI_NONE); // it is closed
            const uint32_t from = scene->triangles[t][k], to = scene->triangles[t][(k + 1) % 3];
            for (int i = 1; i < 8; i++) {
                const float at = 0.125f * (float)i;
                float weights[2][3] = {{0.0f}}, rgb[2][3];
                weights[0][k] = 1.0f - at;
                weights[0][(k + 1) % 3] = at;
                for (int c = 0; c < 3; c++) {
                    const uint32_t v = scene->triangles[other][c];
                    weights[1][c] = v == from ? 1.0f - at : v == to ? at : 0.0f;
                }
                alpi_lightmap_sample(lightmap, t, weights[0][1], weights[0][2], rgb[0]);
                alpi_lightmap_sample(lightmap, other, weights[1][1], weights[1][2], rgb[1]);
                worst = fmax(worst, fabs((double)rgb[0][0] - (double)rgb[1][0]));
            }
        }
    }
    alpi_release(scene->context, neighbours);
    return worst;
}

TEST_WITH_CONTEXT(charts_end_where_they_are_not_seen, 2)
{
    // Each chart in a value of its own, so that a step is the weight of a chart that ends.
    alp_scene *scene = smooth_sphere(context);
    alp_lightmap *lightmap = make_map(scene, 256);
    const alpi_texels *texels = &lightmap->texels;
    const uint32_t charts = alp_atlas_get_info(lightmap->atlas).charts;
    float *values = calloc(texels->count, sizeof *values);
    assert_non_null(values);
    assert_int_equal(charts, 6);
    for (uint32_t i = 0; i < texels->count; i++) {
        values[i] = (float)texels->charts[i] / (float)(charts - 1);
    }
    ASSERT_OK(context, alpi_lightmap_store(lightmap, values));
    free(values);
    // A chart ends between facets of 87°, whose corners lie half the diagonal of a cell from their
    // planes' normals, 2.65°: cos² 84.35° = .0097. Charts of two axes may end at one edge.
    assert_true(largest_step(scene, lightmap) < 2 * 0.0097);
    lightmap->blend = ALP_BLEND_AVERAGE;
    assert_true(largest_step(scene, lightmap) > 0.3); // one of two or three charts, up to 1 apart
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}
