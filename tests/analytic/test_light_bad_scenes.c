// SPDX-License-Identifier: MIT
// Light baked in scenes that are wrong, by rays and by hemicubes: every bake ends well, and no
// value is negative or no number.
#include "test_lit.h"
#include "test_scenes.h"

#include "maps/lightmap.h"
#include "scene/builtin/mesh_builder.h"

#include <math.h>

static const vec3 ONE = {1, 1, 1}, ZERO = {0, 0, 0};
TEST_CONTEXT(2);

static void put_lamp(alp_scene *scene, vec3 position)
{
    test_lit_set_lamps(scene,
                       &(alpi_light){.kind = ALP_LIGHT_POINT,
                                     .color = ONE,
                                     .intensity = 1.0f,
                                     .position = position,
                                     .range = INFINITY},
                       1);
}

/// What a bake found: the largest and the mean value of texels.
typedef struct found {
    double largest, mean;
    alp_bake_report report;
} found;

static alp_bake_options light_options(alp_gather gather)
{
    alp_bake_options o = alp_bake_options_default();
    o.maps = ALP_MAP_LIGHT;
    o.light.gather = gather;
    o.light.hemicube = 16;
    o.atlas.size = 48;
    return o;
}

/// Bakes, and holds every value to [0, ∞). The scene stays.
static found bake(const alp_scene *scene, const alp_bake_options *o)
{
    found f = {.largest = 0.0};
    alp_lightmap *map = NULL;
    test_log_clear();
    ASSERT_OK(context, alp_bake(scene, o, &map, &f.report));
    double area = 0.0;
    for (uint32_t t = 0; t < map->texels.count; t++) {
        uint32_t width;
        const float *page =
            alp_lightmap_map_page(map, ALP_MAP_LIGHT, map->texels.pages[t], &width, NULL);
        const uint16_t *at = map->texels.pixels[t];
        for (size_t k = 0; k < 3; k++) {
            const double v = (double)page[4 * ((size_t)at[1] * width + at[0]) + k];
            assert_true(isfinite(v) && v >= 0.0);
            f.largest = fmax(f.largest, v);
            f.mean += v * (double)map->texels.areas[t] / 3.0;
        }
        area += (double)map->texels.areas[t];
    }
    f.mean /= area;
    alp_lightmap_destroy(map);
    return f;
}

static alp_scene *make_box(float albedo, bool inside)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "box");
    alpi_builder_surface(&b, "box",
                         alpi_builder_material(&b, "box", vec3_scale(ONE, albedo), ZERO));
    alpi_builder_box(&b, inside ? ONE : ZERO, inside ? ZERO : ONE, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// A closed room that gives back all light or more would never grow dark: albedo is at most .95.
TEST_SLOW(albedo_of_one_and_more)
{
    for (int gather = 0; gather < 2; gather++) {
        for (int k = 0; k < 2; k++) {
            alp_scene *scene = make_box(k == 0 ? 1.0f : 7.0f, true);
            const alp_bake_options o = light_options((alp_gather)gather);
            put_lamp(scene, vec3_scale(ONE, 0.5f));
            const found f = bake(scene, &o);
            const double exact = 4.0 * ALPI_PI / (0.05 * 6.0);
            ASSERT_NEAR(f.mean, exact, 0.02 * exact); // twenty times what rays of the solver err
            assert_true(f.report.light_passes > 10 && f.report.light_passes < 1024);
            alp_scene_destroy(scene);
        }
    }
}

/// A bake that has no light at all is refused (test_light_limits); light may still come to nothing.
TEST(a_sky_outside_a_closed_room)
{
    for (int gather = 0; gather < 2; gather++) {
        alp_scene *scene = make_box(0.5f, true);
        alp_bake_options o = light_options((alp_gather)gather);
        o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
        const found f = bake(scene, &o); // a hemicube in a corner has pixels beyond the edge
        assert_true(gather == ALP_GATHER_HEMICUBE || f.largest == 0.0);
        assert_true(test_log_has("closed-room"));
        alp_scene_destroy(scene);
    }
}

/// A room that was modelled inside out: its walls are black from within, where nothing is baked,
/// and let light through where the user says that they have one side.
TEST(rooms_inside_out)
{
    for (int gather = 0; gather < 2; gather++) {
        alp_scene *scene = make_box(0.5f, false);
        alp_bake_options o = light_options((alp_gather)gather);
        put_lamp(scene, vec3_scale(ONE, 0.5f));
        assert_true(bake(scene, &o).largest == 0.0);
        o.occlusion.one_sided = true;
        bake(scene, &o);
        alp_scene_destroy(scene);
        scene = make_box(0.5f, false);
        o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
        for (int k = 0; k < 2; k++) {
            o.occlusion.one_sided = k == 1;
            const found f = bake(scene, &o);
            ASSERT_NEAR(f.mean, ALPI_PI, 1e-3 * ALPI_PI); // convex from outside: all of the sky
        }
        alp_scene_destroy(scene);
    }
}

/// Light that is shut in a solid reaches nothing outside it; on a surface and in a corner it gives
/// what it gives, in numbers.
TEST(lamps_in_walls)
{
    static const vec3 places[] = {{0.5f, 0.5f, 0.5f}, {0.5f, 1.0f, 0.5f}, {0, 0, 0}};
    for (int gather = 0; gather < 2; gather++) {
        for (int k = 0; k < 3; k++) {
            alp_scene *scene = make_box(0.5f, false);
            const alp_bake_options o = light_options((alp_gather)gather);
            put_lamp(scene, places[k]);
            const found f = bake(scene, &o);
            assert_true(k > 0 || f.largest == 0.0);
            assert_true(k > 0 || test_log_has("light-inside"));
            assert_true(k != 1 || test_log_has("light-on-surface") || test_log_has("light-inside"));
            alp_scene_destroy(scene);
            scene = make_box(0.5f, true);
            put_lamp(scene, places[k]);
            bake(scene, &o);
            alp_scene_destroy(scene);
        }
    }
}

/// Two meshes with the same coordinates for a lightmap: charts are made anew, unless the user keeps
/// what cannot be kept.
TEST(instances_that_share_coordinates)
{
    static const float uvs[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    static const float floor[4][3] = {{0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0}};
    static const float other[4][3] = {{2, 0, 1}, {3, 0, 1}, {3, 0, 0}, {2, 0, 0}};
    static const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    alp_mesh meshes[2] = {{.name = "a",
                           .positions = floor[0],
                           .uvs = uvs[0],
                           .indices = triangles[0],
                           .vertex_count = 4,
                           .triangle_count = 2,
                           .base_color = {0.5f, 0.5f, 0.5f}}};
    meshes[1] = meshes[0];
    meshes[1].name = "b";
    meshes[1].positions = other[0];
    for (int gather = 0; gather < 2; gather++) {
        alp_scene *scene = NULL;
        alp_bake_options o = light_options((alp_gather)gather);
        ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
        o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
        const found f = bake(scene, &o);
        ASSERT_NEAR(f.mean, ALPI_PI, 1e-3 * ALPI_PI);
        assert_int_equal(f.report.atlas.mode, ALP_ATLAS_CHARTS);
        o.atlas.mode = ALP_ATLAS_KEEP;
        assert_int_equal(alp_bake(scene, &o, NULL, NULL), ALP_ERROR_INVALID_DATA);
        alp_scene_destroy(scene);
    }
}
