// SPDX-License-Identifier: MIT
// Layers of light: they add up to the whole, each is what its light gives alone, and they have
// names that files can have.
#include "base/image.h"
#include "base/memory.h"
#include "maps/lightmap.h"
#include "test_lit.h"
#include "test_scenes.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

enum { SIZE = 48 };

static alp_lamp lamp_at(float x, float y, float z, float candela, float red)
{
    alp_lamp lamp = alp_lamp_default();
    lamp.position[0] = x;
    lamp.position[1] = y;
    lamp.position[2] = z;
    lamp.intensity = candela;
    lamp.color[0] = red;
    return lamp;
}

static alp_bake_options layer_options(const alp_lamp *lamps, uint32_t lamp_count)
{
    alp_bake_options o = alp_bake_options_default();
    o.atlas.size = SIZE;
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.maps = ALP_MAP_LIGHT;
    o.light.samples = 64;
    o.light.layers = true;
    o.light.lighting.lamps = lamps;
    o.light.lighting.lamp_count = lamp_count;
    return o;
}

static alp_lightmap *bake(alp_context *context, const alp_scene *scene, const alp_bake_options *o)
{
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_bake(scene, o, &lightmap, NULL));
    return lightmap;
}

/// The largest difference between two pages, over the largest value of the first.
static double difference(const float *a, const float *b)
{
    double worst = 0.0, largest = 0.0;
    for (size_t i = 0; i < (size_t)4 * SIZE * SIZE; i++) {
        if (i % 4 != 3) {
            worst = fmax(worst, fabs((double)a[i] - (double)b[i]));
            largest = fmax(largest, fabs((double)a[i]));
        }
    }
    assert_true(largest > 0.0);
    return worst / largest;
}

/// Bit for bit, what lies beside the charts included.
static void check_sum(const alp_lightmap *lightmap)
{
    uint32_t lit = 0;
    for (uint32_t p = 0; p < alp_lightmap_page_count(lightmap); p++) {
        const float *all = alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, p, NULL, NULL);
        for (size_t i = 0; i < (size_t)4 * SIZE * SIZE; i++) {
            float sum = 0.0f;
            for (uint32_t l = 0; l < alp_lightmap_layer_count(lightmap); l++) {
                const float v = alp_lightmap_layer_page(lightmap, l, p, NULL, NULL)[i];
                assert_true(v >= 0.0f && (i % 4 != 3 || v == all[i]));
                sum += v;
            }
            assert_true(i % 4 == 3 || sum == all[i]);
            lit += sum > 0.0f;
        }
    }
    assert_true(lit > SIZE);
}

// --- sums ----------------------------------------------------------------------------------------

TEST_SLOW(layers_add_up_to_the_whole)
{
    enum { ADAPTIVE, EVERY_TEXEL, ROUNDS, HEMICUBES, DIRECT_ONLY, BOUNCED_ONLY, WAYS };
    alp_context *context = test_context(2), *alone = test_context(1);
    alp_scene *scene = test_load(context, "builtin:cornell"),
              *same = test_load(alone, "builtin:cornell");
    const alp_lamp lamps[] = {lamp_at(-0.2f, 0.1f, 0.2f, 0.4f, 0.5f)};
    for (int way = 0; way < WAYS; way++) {
        alp_bake_options o = layer_options(lamps, 1);
        o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
        o.sampling.accuracy = way == EVERY_TEXEL ? ALP_ADAPTIVE_OFF : ALP_ADAPTIVE_AUTO;
        o.light.error = way == ROUNDS ? 0.02f : 0.0f;
        o.light.gather = way == HEMICUBES ? ALP_GATHER_HEMICUBE : ALP_GATHER_RAYS;
        o.light.hemicube = 16;
        o.light.bounces = way == DIRECT_ONLY ? 0 : ALP_BOUNCES_CONVERGE;
        o.light.direct = way == BOUNCED_ONLY ? ALP_DIRECT_OFF : ALP_DIRECT_ON;
        alp_lightmap *layers = bake(context, scene, &o), *again = bake(alone, same, &o);
        assert_int_equal(alp_lightmap_layer_count(layers), 3);
        check_sum(layers);
        for (uint32_t l = 0; l < 3; l++) { // one worker or two
            assert_memory_equal(alp_lightmap_layer_page(layers, l, 0, NULL, NULL),
                                alp_lightmap_layer_page(again, l, 0, NULL, NULL),
                                sizeof(float) * 4 * SIZE * SIZE);
        }
        o.light.layers = false;
        alp_lightmap *whole = bake(context, scene, &o);
        assert_int_equal(alp_lightmap_layer_count(whole), 0);
        const double apart =
            difference(alp_lightmap_map_page(whole, ALP_MAP_LIGHT, 0, NULL, NULL),
                       alp_lightmap_map_page(layers, ALP_MAP_LIGHT, 0, NULL, NULL));
        printf("layers: way %d: %.1e of the largest from the map without layers\n", way, apart);
        // Floats; a cubic between texels whose light has an edge may fall below 0, and is cut off
        // there, of each layer apart: 8 texels of 1398 here. Later rounds see direct light that has
        // become better, within the error that was asked for. Without layers cosine rays go on from
        // what is near: other light and noise of its own where surfaces meet, in a texel of a
        // corner as much as an eighth of the largest that is bounced.
        const bool exact = way == HEMICUBES || way == DIRECT_ONLY;
        assert_true(apart < (exact ? 2e-6 : way == BOUNCED_ONLY ? 0.2 : 0.05));
        alp_lightmap_destroy(whole);
        alp_lightmap_destroy(again);
        alp_lightmap_destroy(layers);
    }
    alp_scene_destroy(scene);
    alp_scene_destroy(same);
    alp_context_destroy(context);
    alp_context_destroy(alone);
}

// --- each of them --------------------------------------------------------------------------------

/// Two panes of a corner and a third across, seen from both sides.
static alp_scene *make_corner(alp_context *context)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){0, 0, 2}, (double[]){2, 0, 0});
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){0, 2, 0}, (double[]){0, 0, 2});
    test_mesh_quad(mesh, (double[]){0.8, 0.1, 0.3}, (double[]){0.1, 0, 1}, (double[]){0.3, 1, 0});
    return test_mesh_scene(context, mesh, 1);
}

/// The layer is the bake in which nothing else shines: the same rays, and as many bounces.
TEST_WITH_CONTEXT(a_layer_is_its_light_alone, 2)
{
    enum { LAMP, OTHER, SKY, LIGHTS };
    alp_image *picture = NULL; // one bright half: too uneven to be gathered with what bounces
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){8, 4, 3, ALP_COMPONENT_FLOAT}, &picture));
    for (size_t i = 0; i < 3 * 32; i++) {
        alp_image_floats(picture)[i] = i / 3 % 8 == 2 ? 9.0f : 0.25f;
    }
    const float candela[2] = {1.5f, 0.75f};
    for (int uneven = 0; uneven < 2; uneven++) {
        alp_scene *scene = make_corner(context);
        alp_lamp lamps[] = {lamp_at(1.6f, 1.5f, 0.4f, candela[0], 0.25f),
                            lamp_at(0.3f, 0.7f, 1.7f, candela[1], 1.0f)};
        alp_bake_options o = layer_options(lamps, 2);
        o.sampling.accuracy = ALP_ADAPTIVE_OFF;
        o.light.bounces = 3;
        o.light.lighting.sky.kind = uneven ? ALP_SKY_IMAGE : ALP_SKY_HEMISPHERE;
        o.light.lighting.sky.image = uneven ? picture : NULL;
        alp_lightmap *all = bake(context, scene, &o);
        assert_int_equal(alp_lightmap_layer_count(all), LIGHTS);
        check_sum(all);
        for (uint32_t light = 0; light < LIGHTS; light++) {
            alp_bake_options one = o;
            one.light.layers = false;
            lamps[0].intensity = light == LAMP ? candela[0] : 0.0f;
            lamps[1].intensity = light == OTHER ? candela[1] : 0.0f;
            one.light.lighting.sky.kind = light == SKY ? o.light.lighting.sky.kind : ALP_SKY_NONE;
            alp_lightmap *lone = bake(context, scene, &one);
            const double apart =
                difference(alp_lightmap_map_page(lone, ALP_MAP_LIGHT, 0, NULL, NULL),
                           alp_lightmap_layer_page(all, light, 0, NULL, NULL));
            printf("layers: light %u: %.1e of the largest from it alone\n", light, apart);
            assert_true(apart < 2e-6); // sums of floats, in another order
            alp_lightmap_destroy(lone);
        }
        alp_lightmap_destroy(all);
        alp_scene_destroy(scene);
    }
    alp_image_destroy(picture);
}

// --- names ---------------------------------------------------------------------------------------

enum { NAMED = 8 };

TEST_WITH_CONTEXT(names_are_fit_for_files, 2)
{
    static const struct {
        const char *light, *layer;
    } names[NAMED] = {{"Lamp.001", "Lamp_001"},
                      {"lamp_001", "lamp_001 2"}, // the same file where capitals do not count
                      {"../x", "___x"},
                      {"error", "error 2"}, // irradiance.error.exr is another map
                      {"", "light"},
                      {"1", "1 2"}, // irradiance.1.exr is a page
                      {"K\xC3\xBC"
                       "che\t",
                       "K\xC3\xBC"
                       "che_"},
                      {"sky", "sky"}};
    alp_scene *scene = make_corner(context);
    alpi_light lights[NAMED];
    for (int i = 0; i < NAMED; i++) {
        lights[i] = (alpi_light){.name = alpi_copy_string(context, names[i].light),
                                 .kind = ALP_LIGHT_POINT,
                                 .color = {1.0f, 1.0f, 1.0f},
                                 .intensity = 1.0f,
                                 .position = {1.0f + 0.1f * (float)i, 1.0f, 1.0f},
                                 .range = INFINITY};
    }
    test_lit_set_lamps(scene, lights, NAMED);
    const char *folder = test_folder();
    alp_bake_options o = layer_options(NULL, 0);
    o.light.bounces = 1;
    o.maps_folder = folder;
    o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
    alp_lightmap *lightmap = bake(context, scene, &o);
    assert_int_equal(alp_lightmap_layer_count(lightmap), NAMED + 1);
    assert_string_equal(alp_lightmap_layer_name(lightmap, NAMED), "sky 2");
    assert_null(alp_lightmap_layer_name(lightmap, NAMED + 1));
    assert_null(alp_lightmap_layer_page(lightmap, NAMED + 1, 0, NULL, NULL));
    for (uint32_t i = 0; i < NAMED; i++) {
        char file[64];
        alp_image *image = NULL;
        assert_string_equal(alp_lightmap_layer_name(lightmap, i), names[i].layer);
        snprintf(file, sizeof file, "irradiance.%s.exr", names[i].layer);
        ASSERT_OK(context, alp_image_load(context, test_path(folder, file), &image));
        assert_memory_equal(alp_image_floats(image),
                            alp_lightmap_layer_page(lightmap, i, 0, NULL, NULL),
                            sizeof(float) * 4 * SIZE * SIZE);
        alp_image_destroy(image);
    }
    alp_lightmap_destroy(lightmap);
    assert_int_equal(alp_bake(scene, &o, NULL, NULL), ALP_ERROR_IO); // files are not replaced
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(the_last_of_many_is_all_others, 2)
{
    enum { MANY = 20, LAYERS = 16 };
    alp_scene *scene = make_corner(context);
    alp_lamp lamps[MANY];
    for (int i = 0; i < MANY; i++) {
        lamps[i] = lamp_at(1.0f + 0.05f * (float)i, 1.0f, 1.0f, 1.0f, 1.0f);
    }
    alp_bake_options o = layer_options(lamps, MANY);
    o.light.bounces = 1;
    test_log_clear();
    alp_lightmap *lightmap = bake(context, scene, &o);
    assert_int_equal(alp_lightmap_layer_count(lightmap), LAYERS);
    assert_string_equal(alp_lightmap_layer_name(lightmap, LAYERS - 2), "lamp 14");
    assert_string_equal(alp_lightmap_layer_name(lightmap, LAYERS - 1), "others");
    assert_true(test_log_has("many-layers"));
    check_sum(lightmap);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

// --- other maps ---

/// The first round has the same rays with and without layers, and so the same directions of light.
TEST_WITH_CONTEXT(layers_change_no_direction, 2)
{
    alp_scene *scene = make_corner(context);
    const alp_lamp lamp = lamp_at(1.6f, 1.5f, 0.4f, 1.5f, 0.25f);
    alp_bake_options o = layer_options(&lamp, 1);
    uint32_t w, h;
    o.maps = ALP_MAP_LIGHT | ALP_MAP_SH;
    o.light.bounces = 2;
    o.sampling.accuracy = ALP_ADAPTIVE_OFF;
    o.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    alp_lightmap *with = bake(context, scene, &o);
    o.light.layers = false;
    alp_lightmap *without = bake(context, scene, &o);
    for (uint32_t i = 0; i < 4; i++) {
        const float *page = alp_lightmap_sh_page(without, i, 0, &w, &h);
        assert_true(difference(page, alp_lightmap_sh_page(with, i, 0, &w, &h)) < 1e-6);
    }
    alp_lightmap_destroy(with);
    alp_lightmap_destroy(without);
    alp_scene_destroy(scene);
}

// --- what is refused -----------------------------------------------------------------------------

TEST_WITH_CONTEXT(what_has_no_layers_is_refused, 1)
{
    alp_scene *scene = make_corner(context);
    alp_bake_options o = layer_options(NULL, 0);
    o.light.gather = ALP_GATHER_PATHS;
    assert_int_equal(alp_bake(scene, &o, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    o = layer_options(NULL, 0);
    o.light.denoise = true;
    assert_int_equal(alp_bake(scene, &o, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    o = layer_options(NULL, 0);
    o.maps = ALP_MAP_AO;
    assert_int_equal(alp_bake(scene, &o, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    alp_scene_destroy(scene);
}

/// Skies and lights are made for an estimate, for the plan of layers, for the bake and apart.
TEST_WITH_CONTEXT(warnings_are_told_once, 1)
{
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alpi_light lamp = {.kind = ALP_LIGHT_POINT, .intensity = -1.0f};
    test_lit_set_lamps(scene, &lamp, 1);
    const alp_image_info info = {8, 4, 3, ALP_COMPONENT_FLOAT};
    alp_image *picture = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &picture));
    for (uint32_t i = 0; i < 8 * 4 * 3; i++) {
        alp_image_floats(picture)[i] = i == 30 ? -1.0f : i == 36 ? 90.0f : 1.0f;
    }
    alp_bake_options o = layer_options(NULL, 0);
    o.light.lighting.sky.kind = ALP_SKY_IMAGE;
    o.light.lighting.sky.image = picture;
    alp_bake_work work;
    test_log_clear();
    ASSERT_OK(context, alp_bake_estimate(scene, &o, &work));
    alp_lightmap_destroy(bake(context, scene, &o));
    const char *expected[2] = {"sky-image", "light 0 is left out"};
    for (int i = 0; i < 2; i++) {
        const char *found = strstr(test_log_text(), expected[i]);
        assert_non_null(found);
        assert_null(strstr(found + 1, expected[i]));
    }
    alp_image_destroy(picture);
    alp_scene_destroy(scene);
}
