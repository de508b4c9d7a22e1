// SPDX-License-Identifier: MIT
// Shadows of holes and panes, in closed form: a floor under a row of quads, lit from above.
#include "test_gl.h"
#include "test_gltf.h"

#include "base/memory.h"
#include "options/options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { STRIPS = 6, WIDTH = 10 * STRIPS, HEIGHT = 10 };

/// The cover of each strip of the floor.
typedef struct strip {
    const char *material;
    bool shadow;
} strip;
static const strip strips[STRIPS] = {
    {"'pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.1]}", true}, // opaque whatever its alpha
    {"'alphaMode':'MASK','alphaCutoff':0.5,'pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.4]}",
     false},
    {"'alphaMode':'MASK','alphaCutoff':0.5,'pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.6]}",
     true},
    {"'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.3]}", false},
    {"'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.9]}", true},
    {"'pbrMetallicRoughness':{'metallicFactor':0},'extensions':{'KHR_materials_transmission':{"
     "'transmissionFactor':0.9}}",
     false},
};

/// The floor at z = -1 with an albedo of .5 and strips of 1 × 1 m at z = 0, from x = 0 on.
static alp_scene *load_strips(alp_context *context)
{
    static const struct {
        float corners[4][3];
        uint16_t indices[6];
    } quad = {{{0, -0.5f, 0}, {1, -0.5f, 0}, {1, 0.5f, 0}, {0, 0.5f, 0}}, {0, 1, 2, 0, 2, 3}};
    enum { SIZE = 8192 };
    char *text = malloc(SIZE);
    int at;
    assert_non_null(text);
    at = snprintf(text, SIZE,
                  "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_materials_transmission'],"
                  "'buffers':[{'byteLength':60}],'bufferViews':[{'buffer':0,'byteLength':48},"
                  "{'buffer':0,'byteOffset':48,'byteLength':12}],'accessors':[{'bufferView':0,"
                  "'componentType':5126,'count':4,'type':'VEC3','min':[0,-0.5,0],'max':[1,0.5,0]},"
                  "{'bufferView':1,'componentType':5123,'count':6,'type':'SCALAR'}],'materials':["
                  "{'pbrMetallicRoughness':{'baseColorFactor':[0.5,0.5,0.5,1]}}");
    for (int i = 0; i < STRIPS; i++) {
        at += snprintf(text + at, (size_t)(SIZE - at), ",{%s}", strips[i].material);
    }
    at += snprintf(text + at, (size_t)(SIZE - at), "],'meshes':[");
    for (int i = 0; i <= STRIPS; i++) {
        at += snprintf(text + at, (size_t)(SIZE - at),
                       "%s{'primitives':[{'attributes':{'POSITION':0},'indices':1,'material':%d}]}",
                       i > 0 ? "," : "", i);
    }
    at += snprintf(text + at, (size_t)(SIZE - at),
                   "],'scene':0,'scenes':[{'nodes':[0,1,2,3,4,5,6]}],'nodes':["
                   "{'mesh':0,'translation':[0,0,-1],'scale':[%d,1,1]}",
                   STRIPS);
    for (int i = 0; i < STRIPS; i++) {
        at += snprintf(text + at, (size_t)(SIZE - at), ",{'mesh':%d,'translation':[%d,0,0]}", i + 1,
                       i);
    }
    snprintf(text + at, (size_t)(SIZE - at), "]}");
    size_t size = 0;
    const char *folder = test_folder();
    uint8_t *bytes = test_glb(context, text, &quad, 60, &size);
    FILE *file = fopen(test_path(folder, "strips.glb"), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    alpi_release(context, bytes);
    free(text);
    return test_load(context, test_path(folder, "strips.glb"));
}

/// Draws the floor from below the strips, and checks the middle of each strip.
/// @param radiance of the floor in full light at x of the strip's middle
static void check(const alp_scene *scene, const alp_lighting_options *lighting,
                  double (*radiance)(double x))
{
    command_line line = {.command = COMMAND_VIEW};
    line.values[OPTION_WITH].choice = 3; // direct
    const drawing_options options = {.context = scene->context,
                                     .mode = view_mode_of(&line),
                                     .lighting = lighting,
                                     .width = WIDTH,
                                     .height = HEIGHT,
                                     .direct = true,
                                     .level_zero = true};
    const alp_camera camera = {.position = {0.5f * STRIPS, 0, -0.1f},
                               .target = {0.5f * STRIPS, 0, -1},
                               .up = {0, 1, 0},
                               .vertical_fov = (float)(2.0 * atan(0.5 / 0.9))};
    drawing d;
    alp_film_options film = alp_film_options_default();
    alp_image *developed = NULL, *light = NULL;
    assert_int_equal(drawing_create(scene, &options, &d), EXIT_DONE);
    drawing_draw(&d, &camera);
    ASSERT_OK(scene->context, drawing_develop(&d, scene->context, &film, &developed, &light));
    test_gl_check();
    for (int i = 0; i < STRIPS; i++) {
        const int x = 10 * i + 5, y = HEIGHT / 2;
        const double expected = strips[i].shadow ? 0.0 : radiance((x + 0.5) / 10.0);
        ASSERT_NEAR((double)alp_image_floats(light)[4 * (y * WIDTH + x)], expected,
                    1e-5 * (expected + 1.0));
    }
    alp_image_destroy(developed);
    alp_image_destroy(light);
    drawing_destroy(&d);
}

static double of_sun(double x)
{
    (void)x;
    return 0.5 / M_PI * 10.0;
}

TEST_WITH_CONTEXT(holes_and_clear_panes_cast_no_shadow_of_suns, 1)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = load_strips(context);
    alp_lighting_options lighting = alp_lighting_options_default();
    lighting.sun.illuminance = 10.0f; // along -Z
    check(scene, &lighting, of_sun);
    alp_scene_destroy(scene);
}

/// Irradiance of 50 candela 9 m above the floor, over its middle: I cos^3 / h^2, with y = 0.05.
static double of_lamp(double x)
{
    const double aside = x - 0.5 * STRIPS, distance2 = 81.0 + aside * aside + 0.05 * 0.05;
    return 0.5 / M_PI * 50.0 * 9.0 / pow(distance2, 1.5);
}

TEST_WITH_CONTEXT(holes_and_clear_panes_cast_no_shadow_of_lamps, 1)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = load_strips(context);
    alp_lighting_options lighting = alp_lighting_options_default();
    alp_lamp lamp = alp_lamp_default();
    lamp.position[0] = 0.5f * STRIPS;
    lamp.position[2] = 8.0f;
    lamp.intensity = 50.0f;
    lighting.lamps = &lamp;
    lighting.lamp_count = 1;
    check(scene, &lighting, of_lamp);
    alp_scene_destroy(scene);
}
