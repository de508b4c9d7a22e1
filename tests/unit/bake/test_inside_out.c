// SPDX-License-Identifier: MIT
// Maps of double-sided solids that are wound inwards hold their outer side, as viewers show it.
#include "boxes.h"

#include "maps/lightmap.h"

#include <math.h>

enum { RINGS = 12, SEGMENTS = 24, VERTICES = (RINGS + 1) * SEGMENTS, SIZE = 128 };
enum { TRIANGLES = 2 * RINGS * SEGMENTS };

typedef struct sphere {
    float positions[VERTICES][3], normals[VERTICES][3];
    uint32_t triangles[TRIANGLES][3];
} sphere;

/// Triangles of the poles have no area, and are left out.
static alp_mesh make_sphere(sphere *s, float x, bool inwards)
{
    const double pi = acos(-1.0);
    for (int i = 0; i < VERTICES; i++) {
        const double up = pi * (i / SEGMENTS) / RINGS, turn = 2.0 * pi * (i % SEGMENTS) / SEGMENTS;
        const int pole = i / SEGMENTS == 0 || i / SEGMENTS == RINGS;
        const double wide = pole ? 0.0 : sin(up);
        const double n[3] = {wide * cos(turn), cos(up), wide * sin(turn)};
        for (int k = 0; k < 3; k++) {
            s->normals[i][k] = (float)(inwards ? -n[k] : n[k]);
            s->positions[i][k] = (float)(0.5 * n[k]) + (k == 0 ? x : k == 1 ? 0.8f : 0.0f);
        }
    }
    for (uint32_t q = 0; q < RINGS * SEGMENTS; q++) {
        const uint32_t right = q / SEGMENTS * SEGMENTS + (q + 1) % SEGMENTS;
        const uint32_t two[2][3] = {{q, right, right + SEGMENTS},
                                    {q, right + SEGMENTS, q + SEGMENTS}};
        for (uint32_t t = 0; t < 2; t++) {
            s->triangles[2 * q + t][0] = two[t][0];
            s->triangles[2 * q + t][1] = two[t][inwards ? 2 : 1];
            s->triangles[2 * q + t][2] = two[t][inwards ? 1 : 2];
        }
    }
    return (alp_mesh){.positions = &s->positions[0][0],
                      .normals = &s->normals[0][0],
                      .indices = &s->triangles[0][0],
                      .vertex_count = VERTICES,
                      .triangle_count = TRIANGLES,
                      .double_sided = true,
                      .base_color = {0.5f, 0.5f, 0.5f}};
}

static alp_bake_options sky_options(unsigned maps)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = SIZE;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.maps = maps;
    options.occlusion.samples = 64;
    options.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    options.light.lighting.sun.illuminance = 2.0f;
    options.light.lighting.sun.elevation = 0.8f;
    return options;
}

/// Means over the texels of a surface.
typedef struct means {
    double ao, light, direction[3];
} means;

static means mean_of(const alp_scene *scene, const alp_lightmap *lightmap, uint32_t surface)
{
    const alpi_texels *t = &lightmap->texels;
    means sum = {0.0, 0.0, {0.0, 0.0, 0.0}};
    double area = 0.0;
    for (uint32_t i = 0; i < t->count; i++) {
        const size_t at = 4 * ((size_t)t->pixels[i][1] * lightmap->width + t->pixels[i][0]);
        const uint32_t page = t->pages[i];
        if (scene->triangle_surface[t->triangles[i]] != surface) {
            continue;
        }
        const double a = (double)t->areas[i];
        area += a;
        sum.ao += a * (double)lightmap->pages[page][at];
        sum.light += a * (double)lightmap->irradiance_pages[page][at];
        for (int k = 0; k < 3; k++) {
            sum.direction[k] += a * (double)lightmap->direction_pages[page][at + (size_t)k];
        }
    }
    sum.ao /= area;
    sum.light /= area;
    for (int k = 0; k < 3; k++) {
        sum.direction[k] /= area;
    }
    return sum;
}

/// Bakes two meshes over a floor. @param bounces of light
static void bake_pair(alp_context *context, const alp_mesh pair[2], uint32_t bounces, means all[2],
                      double *floor)
{
    static const float corners[4][3] = {{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}};
    static const uint32_t quad[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const alp_mesh meshes[3] = {pair[0],
                                pair[1],
                                {.positions = &corners[0][0],
                                 .indices = &quad[0][0],
                                 .vertex_count = 4,
                                 .triangle_count = 2,
                                 .double_sided = true,
                                 .base_color = {0.8f, 0.8f, 0.8f}}};
    alp_scene *scene = NULL;
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 3, &scene));
    alp_bake_options options = sky_options(ALP_MAP_AO | ALP_MAP_LIGHT | ALP_MAP_DIRECTION);
    options.light.bounces = bounces;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
    for (uint32_t i = 0; i < 2; i++) {
        all[i] = mean_of(scene, lightmap, i);
    }
    *floor = mean_of(scene, lightmap, 2).light;
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

/// The sun comes from +z: two places are alike by x = −x.
TEST_WITH_CONTEXT(spheres_are_alike_however_they_are_wound, 2)
{
    static sphere spheres[2];
    for (uint32_t bounces = 0; bounces < 4; bounces += 3) {
        means good[2], mixed[2];
        double floors[2];
        const alp_mesh outwards[2] = {make_sphere(&spheres[0], -1.0f, false),
                                      make_sphere(&spheres[1], 1.0f, false)};
        bake_pair(context, outwards, bounces, good, &floors[0]);
        const alp_mesh either[2] = {make_sphere(&spheres[0], -1.0f, false),
                                    make_sphere(&spheres[1], 1.0f, true)};
        bake_pair(context, either, bounces, mixed, &floors[1]);
        for (int i = 0; i < 2; i++) {
            // Noise of 64 rays in several thousand texels, and other charts.
            ASSERT_NEAR(mixed[i].ao, good[i].ao, 0.005);
            ASSERT_NEAR(mixed[i].light, good[i].light, 0.01 * good[i].light);
            for (int k = 0; k < 3; k++) {
                ASSERT_NEAR(mixed[i].direction[k], good[i].direction[k], 0.02);
            }
        }
        ASSERT_NEAR(floors[1], floors[0], 0.01 * floors[0]); // light that leaves the spheres
        assert_true(good[0].ao > 0.6 && good[0].light > 0.5);
    }
}

TEST_WITH_CONTEXT(vertices_of_spheres_are_alike, 2)
{
    static sphere spheres[2];
    const alp_mesh meshes[2] = {make_sphere(&spheres[0], -1.0f, false),
                                make_sphere(&spheres[1], 1.0f, true)};
    alp_scene *scene = NULL;
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
    alp_bake_options options = alp_bake_options_default();
    options.atlas.mode = ALP_ATLAS_VERTEX;
    options.occlusion.samples = 256;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
    double sums[2] = {0.0, 0.0};
    for (uint32_t v = 0; v < 2 * VERTICES; v++) {
        sums[v / VERTICES] += (double)lightmap->vertex_values[v] / VERTICES;
    }
    ASSERT_NEAR(sums[0], sums[1], 0.01); // noise
    assert_true(sums[0] > 0.9);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

/// A double-sided box that holds a lamp of the options is lit inside.
TEST_WITH_CONTEXT(a_room_with_a_lamp_is_lit, 2)
{
    uint32_t inwards[12][3];
    for (int t = 0; t < 12; t++) {
        inwards[t][0] = CUBE_TRIANGLES[t][0];
        inwards[t][1] = CUBE_TRIANGLES[t][2];
        inwards[t][2] = CUBE_TRIANGLES[t][1];
    }
    const alp_mesh mesh = {.positions = &CUBE[0][0],
                           .indices = &inwards[0][0],
                           .vertex_count = 8,
                           .triangle_count = 12,
                           .double_sided = true,
                           .base_color = {0.5f, 0.5f, 0.5f}};
    alp_scene *scene = NULL;
    alp_lamp lamp = alp_lamp_default();
    lamp.intensity = 1.0f;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    for (int inside = 0; inside < 2; inside++) {
        for (int k = 0; k < 3; k++) {
            lamp.position[k] = inside ? 0.5f : 2.0f;
        }
        alp_bake_options options = small_options();
        options.maps = ALP_MAP_LIGHT;
        options.light.bounces = 0;
        options.light.lighting.lamps = &lamp;
        options.light.lighting.lamp_count = 1;
        alp_lightmap *lightmap = NULL;
        uint32_t width, height, lit = 0, all = 0;
        ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
        const float *page = alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, 0, &width, &height);
        for (size_t i = 0; i < (size_t)width * height; i++) {
            all += page[4 * i + 3] > 0.0f ? 1 : 0;
            lit += page[4 * i + 3] > 0.0f && page[4 * i] > 0.0f ? 1 : 0;
        }
        assert_true(inside ? lit == all : lit > 0.4 * all && lit < 0.6 * all); // three faces
        alp_lightmap_destroy(lightmap);
    }
    alp_scene_destroy(scene);
}

/// Sheets are open: their maps hold their fronts.
TEST_WITH_CONTEXT(an_open_sheet_keeps_its_front, 2)
{
    static const uint32_t quads[2][2][3] = {{{0, 1, 2}, {0, 2, 3}}, {{0, 2, 1}, {0, 3, 2}}};
    static const float corners[4][3] = {{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}};
    static const float lid[4][3] = {{-9, -1, -9}, {-9, -1, 9}, {9, -1, 9}, {9, -1, -9}};
    for (int down = 0; down < 2; down++) {
        alp_mesh meshes[2] = {{.positions = &corners[0][0],
                               .indices = &quads[down][0][0],
                               .vertex_count = 4,
                               .triangle_count = 2,
                               .double_sided = true,
                               .base_color = {0.5f, 0.5f, 0.5f}},
                              {.positions = &lid[0][0],
                               .indices = &quads[0][0][0],
                               .vertex_count = 4,
                               .triangle_count = 2,
                               .base_color = {0.5f, 0.5f, 0.5f}}};
        alp_scene *scene = NULL;
        alp_lightmap *lightmap = NULL;
        ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
        alp_bake_options options = sky_options(ALP_MAP_AO | ALP_MAP_LIGHT | ALP_MAP_DIRECTION);
        options.occlusion.distance = INFINITY;
        ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
        const double ao = mean_of(scene, lightmap, 0).ao;
        assert_true(down ? ao < 0.1 : ao > 0.99);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(the_reported_boxes, 2)
{
    const char *path = test_shared("scenes/reports/insideout_ds.glb");
    if (path == NULL) {
        skip();
    }
    alp_scene *scene = test_load(context, path);
    alp_lightmap *lightmap = NULL;
    alp_bake_options options = sky_options(ALP_MAP_AO | ALP_MAP_LIGHT | ALP_MAP_DIRECTION);
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
    const means good = mean_of(scene, lightmap, 1), turned = mean_of(scene, lightmap, 2);
    print_message("boxes: occlusion %.4f and %.4f, light %.4f and %.4f\n", good.ao, turned.ao,
                  good.light, turned.light);
    ASSERT_NEAR(turned.ao, good.ao, 0.005); // as for spheres
    ASSERT_NEAR(turned.light, good.light, 0.01 * good.light);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}
