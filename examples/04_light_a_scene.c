// SPDX-License-Identifier: MIT
// Light: a wall on level ground under a clear sky with its sun, as irradiance of every texel, in
// all bounces. What lies in the wall's shadow has the sky's light alone.
//
//     cc 04_light_a_scene.c -o light $(pkg-config --cflags --libs alpenglow) -lm
#include <alpenglow/alpenglow.h>
#include <math.h>
#include <stdio.h>

static const float RADIANS = 0.0174532925f; // in a degree

/// A sun of 60,000 lux in the south-west, half way up, and the clear sky that goes with it. North
/// is −Z, so that the south is +Z and the west −X; azimuth is counted from +Z towards +X.
static alp_lighting_options make_lighting(void)
{
    alp_lighting_options lighting = alp_lighting_options_default();
    lighting.sky.kind = ALP_SKY_CLEAR;
    lighting.sun.azimuth = -45.0f * RADIANS;
    lighting.sun.elevation = 45.0f * RADIANS;
    lighting.sun.illuminance = 60000.0f;
    lighting.sun.color[2] = 0.85f; // a little warmer than the white of D65
    return lighting;
}

/// Ground of 8 × 8 m, and on it a wall along x, 2 m high, that is seen from both sides.
static alp_result make_scene(alp_context *context, alp_scene **scene)
{
    static const float ground[4][3] = {{-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}};
    static const float wall[4][3] = {{-2, 0, 0}, {2, 0, 0}, {2, 2, 0}, {-2, 2, 0}};
    static const uint32_t quad[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const alp_mesh meshes[] = {{.name = "ground",
                                .positions = ground[0],
                                .indices = quad[0],
                                .vertex_count = 4,
                                .triangle_count = 2,
                                .base_color = {0.5f, 0.5f, 0.5f}},
                               {.name = "wall",
                                .positions = wall[0],
                                .indices = quad[0],
                                .vertex_count = 4,
                                .triangle_count = 2,
                                .base_color = {0.8f, 0.3f, 0.2f},
                                .double_sided = true}};
    return alp_scene_create_from_meshes(context, meshes, 2, scene);
}

/// The darkest and the brightest covered texel of the map, by its green channel.
static void print_range(const alp_lightmap *lightmap)
{
    uint32_t width = 0, height = 0;
    const float *texels = alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, 0, &width, &height);
    float least = INFINITY, most = 0.0f;
    for (size_t i = 0; i < (size_t)width * height; i++) {
        const float *rgba = texels + 4 * i;
        if (rgba[3] > 0.5f) {
            least = fminf(least, rgba[1]);
            most = fmaxf(most, rgba[1]);
        }
    }
    printf("irradiance of a texel: %.0f to %.0f lux\n", (double)least, (double)most);
}

int main(void)
{
    alp_context *context = NULL;
    alp_scene *scene = NULL;
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    alp_result result = alp_context_create(NULL, &context);
    if (result == ALP_OK) {
        result = make_scene(context, &scene);
    }
    if (result == ALP_OK) {
        alp_bake_options options = alp_bake_options_default();
        options.maps = ALP_MAP_LIGHT;
        options.light.lighting = make_lighting();
        options.light.samples = 64; // bounces: as many as bring anything
        options.atlas.size = 64;    // maps_folder = "maps" would write irradiance.exr there
        result = alp_bake(scene, &options, &lightmap, &report);
    }
    if (result == ALP_OK) {
        printf("mean %.0f lux, standard error of a texel %.1f %%\n", report.light_mean,
               100.0 * report.light_relative_error);
        print_range(lightmap);
    }
    if (result != ALP_OK) {
        fprintf(stderr, "%s: %s\n", alp_result_name(result),
                context ? alp_context_message(context) : "no context");
    }
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return result == ALP_OK ? 0 : 1;
}
