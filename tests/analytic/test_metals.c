// SPDX-License-Identifier: MIT
// Metals in the furnace: a closed room of albedo .5 that emits radiance 1. Diffuse metals give the
// light of any other material, E = 2π. Black ones reflect nothing, E = π.
#include "test_support.h"

#include "base/vec.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

enum { SIZE = 16 };

TEST_CONTEXT(2);

static alp_scene *make_furnace(float metallic, alp_metals metals)
{
    alp_scene *scene = test_load(context, "builtin:furnace");
    for (uint32_t m = 0; m < scene->material_count; m++) {
        scene->materials[m].metallic = metallic;
    }
    alp_scene_set_metals(scene, metals);
    return scene;
}

static void bake(const alp_scene *scene, alp_gather gather, float page[SIZE * SIZE][4])
{
    alp_bake_options o = alp_bake_options_default();
    alp_lightmap *lightmap = NULL;
    o.maps = ALP_MAP_LIGHT;
    o.atlas.size = SIZE;
    o.light.samples = 64;
    o.light.hemicube = 32;
    o.light.gather = gather;
    ASSERT_OK(context, alp_bake(scene, &o, &lightmap, NULL));
    memcpy(page, alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, 0, NULL, NULL),
           sizeof(float[SIZE * SIZE][4]));
    alp_lightmap_destroy(lightmap);
}

static double mean_of(float page[SIZE * SIZE][4])
{
    double sum = 0.0;
    for (int i = 0; i < SIZE * SIZE; i++) { // texels between the charts hold a neighbour's value
        sum += (double)page[i][0] / (SIZE * SIZE);
    }
    return sum;
}

TEST(light_of_metal_walls)
{
    static float plain[SIZE * SIZE][4], diffuse[SIZE * SIZE][4], black[SIZE * SIZE][4];
    for (int gather = ALP_GATHER_RAYS; gather <= ALP_GATHER_PATHS; gather++) {
        alp_scene *scene = make_furnace(0.0f, ALP_METALS_BLACK);
        bake(scene, (alp_gather)gather, plain);
        alp_scene_destroy(scene);
        scene = make_furnace(1.0f, ALP_METALS_DIFFUSE);
        bake(scene, (alp_gather)gather, diffuse);
        assert_memory_equal(plain, diffuse, sizeof plain);
        alp_scene_set_metals(scene, ALP_METALS_BLACK);
        bake(scene, (alp_gather)gather, black);
        alp_scene_destroy(scene);
        // A hemicube of 32 pixels in the corner of a room of few texels sees parts of them. Eight
        // texels share 64 paths, whose lengths spread by .7 of their mean: 1 % is four errors.
        const double near = gather == ALP_GATHER_HEMICUBE ? 0.03 : 0.01;
        ASSERT_NEAR(mean_of(diffuse), 2.0 * ALPI_PI, near * 2.0 * ALPI_PI);
        ASSERT_NEAR(mean_of(black), ALPI_PI, near * ALPI_PI);
    }
}

TEST(half_metals_reflect_half)
{
    static float page[SIZE * SIZE][4];
    alp_scene *scene = make_furnace(0.5f, ALP_METALS_BLACK); // albedo .25: E = π / (1 − .25)
    bake(scene, ALP_GATHER_RAYS, page);
    ASSERT_NEAR(mean_of(page), ALPI_PI / 0.75, 0.002 * ALPI_PI / 0.75);
    alp_scene_destroy(scene);
}

TEST(pictures_and_obscurance)
{
    static const float point[3] = {0.5f, 0.5f, 0.5f}, up[3] = {0.0f, 1.0f, 0.0f};
    static const alp_render_method methods[] = {ALP_RENDER_ALBEDO, ALP_RENDER_HEMISPHERE};
    for (int black = 0; black < 2; black++) {
        const double albedo = black ? 0.0 : 0.5;
        alp_scene *scene = make_furnace(1.0f, (alp_metals)black);
        alp_occlusion_options occlusion = alp_occlusion_options_default();
        float rgb[3];
        occlusion.distance = INFINITY;
        occlusion.falloff = ALP_FALLOFF_NONE;
        ASSERT_OK(context, alp_obscurance_at_points(scene, 1, point, NULL, up, &occlusion, rgb));
        ASSERT_NEAR(rgb[0], albedo, 1e-6);
        for (int i = 0; i < 2; i++) {
            alp_image *image = NULL;
            alp_render_options o = alp_render_options_default();
            o.method = methods[i];
            o.width = o.height = 4;
            o.lighting.sky.kind = ALP_SKY_CONSTANT;
            ASSERT_OK(context, alp_render(scene, &o, &image));
            ASSERT_NEAR(alp_image_floats(image)[0], albedo, 1e-6);
            alp_image_destroy(image);
        }
        alp_scene_destroy(scene);
    }
}

TEST(odd_settings_change_nothing)
{
    alp_scene *scene = make_furnace(1.0f, ALP_METALS_BLACK);
    alp_scene_set_metals(scene, (alp_metals)2);
    alp_scene_set_metals(scene, (alp_metals)-1);
    alp_scene_set_metals(NULL, ALP_METALS_BLACK);
    ASSERT_NEAR(alpi_surface_albedo(scene, 0, 0.3f, 0.3f).x, 0.0, 0.0);
    alp_scene_destroy(scene);
}
