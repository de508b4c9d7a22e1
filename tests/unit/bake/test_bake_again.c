// SPDX-License-Identifier: MIT
// What was baked before on a scene changes no bit: a large bake leaves a hierarchy through whose
// edges rays may slip, and that only large ones may use.
#include "test_scenes.h"

#include "scene/scene.h"

#include <math.h>

enum { CELLS = 32, SMALL = 40, LARGE = 48, POINTS = 400 };
/// Rays so long err by 1e-7 × 1000 m at the ceiling, a few thousandths of a cell: of a quarter of a
/// million some slip. The hierarchy is worth its while from 500 rays a triangle on.
static const double FAR = 1000.0, LEAST_RAYS = 500.0 * 2 * CELLS * CELLS;
static const float CONE = 2e-4f; // radians; .2 m at that distance

// Along the floor, and up: askew, for products of coordinates that are 0 have no rounding.
static const double ALONG[3] = {0.8, 0, -0.6}, ACROSS[3] = {-0.36, 0.8, -0.48},
                    UP[3] = {0.48, 0.6, 0.64};

static void place(double along, double across, double up, double p[3])
{
    for (int k = 0; k < 3; k++) {
        p[k] = along * ALONG[k] + across * ACROSS[k] + up * UP[k];
    }
}

/// A floor below a ceiling of many small cells, far away.
static alp_scene *make_scene(alp_context *context)
{
    static uint32_t vertices[CELLS + 1][CELLS + 1];
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, ALONG, ACROSS);
    for (int i = 0; i <= CELLS; i++) {
        for (int k = 0; k <= CELLS; k++) {
            double p[3];
            place(2.0 * i / CELLS - 0.5, 2.0 * k / CELLS - 0.5, FAR, p);
            vertices[i][k] = test_mesh_vertex(mesh, p[0], p[1], p[2]);
        }
    }
    for (int i = 0; i < CELLS; i++) {
        for (int k = 0; k < CELLS; k++) {
            const uint32_t a = vertices[i][k], b = vertices[i + 1][k], c = vertices[i + 1][k + 1];
            test_mesh_triangle(mesh, a, c, b);
            test_mesh_triangle(mesh, a, vertices[i][k + 1], c);
        }
    }
    return test_mesh_scene(context, mesh, 0);
}

static alp_lightmap *bake(alp_scene *scene, unsigned maps, uint32_t size, uint32_t samples,
                          double *rays)
{
    alp_bake_options o = alp_bake_options_default();
    alp_lightmap *made = NULL;
    alp_bake_report report;
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.atlas.size = size;
    o.maps = maps;
    o.occlusion.samples = samples;
    o.occlusion.distance = INFINITY;
    o.occlusion.cone = CONE;
    o.sampling.accuracy = ALP_ADAPTIVE_OFF;
    o.light.samples = 16;
    o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
    ASSERT_OK(scene->context, alp_bake(scene, &o, &made, &report));
    *rays = (double)report.rays;
    return made;
}

static void check_same(const alp_lightmap *a, const alp_lightmap *b, alp_map map)
{
    const float *pages[2] = {alp_lightmap_map_page(a, map, 0, NULL, NULL),
                             alp_lightmap_map_page(b, map, 0, NULL, NULL)};
    assert_true(pages[0] != NULL && pages[1] != NULL);
    assert_memory_equal(pages[0], pages[1], sizeof(float) * 4 * SMALL * SMALL);
}

static void ask_points(const alp_scene *scene, float values[POINTS])
{
    float positions[POINTS][3], normals[POINTS][3];
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        place(0.05 * (i % 20), 0.05 * (i / 20), 0.0, p);
        for (int k = 0; k < 3; k++) {
            positions[i][k] = (float)p[k];
            normals[i][k] = (float)UP[k];
        }
    }
    alp_occlusion_options o = alp_occlusion_options_default();
    o.distance = INFINITY;
    o.cone = CONE;
    ASSERT_OK(scene->context,
              alp_occlusion_at_points(scene, POINTS, positions[0], NULL, normals[0], &o, values));
}

TEST_WITH_CONTEXT(what_was_before_changes_no_bit, 2)
{
    enum { MAPS = 2 };
    static const alp_map maps[MAPS] = {ALP_MAP_AO, ALP_MAP_LIGHT};
    static float points[2][POINTS];
    alp_scene *scene = make_scene(context);
    alp_lightmap *small[2][MAPS], *large = NULL;
    double rays = 0.0;
    for (int after = 0; after < 2; after++) {
        for (int k = 0; k < MAPS; k++) {
            small[after][k] = bake(scene, maps[k], SMALL, 256, &rays);
            assert_true(rays < LEAST_RAYS);
        }
        ask_points(scene, points[after]);
        if (after == 0) {
            large = bake(scene, ALP_MAP_AO, LARGE, 4096, &rays);
            assert_true(rays > LEAST_RAYS);
        }
    }
    for (int k = 0; k < MAPS; k++) {
        check_same(small[0][k], small[1][k], maps[k]);
        alp_lightmap_destroy(small[0][k]);
        alp_lightmap_destroy(small[1][k]);
    }
    assert_memory_equal(points[0], points[1], sizeof points[0]);
    alp_lightmap_destroy(large);
    alp_scene_destroy(scene);
}
