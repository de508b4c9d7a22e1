// SPDX-License-Identifier: MIT
// Direct light of the viewer against that of render, which traces rays: away from the edges of
// shadows both are equal.
#include "test_gl.h"

#include "base/memory.h"
#include "fields/field.h"
#include "options/options.h"
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The share of pixels within a byte, of those that are alike; and of these of all.
static const double EQUAL = 0.99, ALIKE = 0.7;

static void irradiance_of_darkness(const alp_field *field, uint32_t count,
                                   const float (*positions)[3], const float (*normals)[3],
                                   float (*irradiance)[3])
{
    (void)field;
    (void)positions;
    (void)normals;
    memset(irradiance, 0, count * sizeof *irradiance);
}

/// A field without light: its picture is emission and direct light.
static const alp_field *dark_field(void)
{
    static const alpi_field_kind kind = {.name = "dark", .irradiance = irradiance_of_darkness};
    static const alp_field field = {.kind = &kind};
    return &field;
}

static alp_render_options small_picture(void)
{
    alp_render_options o = alp_render_options_default();
    o.method = ALP_RENDER_FIELD;
    o.field = dark_field();
    o.width = 240;
    o.height = 135;
    o.lighting.sun.size = 0.0f;
    return o;
}

/// @param least share of the pixels that some light makes brighter than black
static void check(const alp_scene *scene, const alp_render_options *o, double least)
{
    test_pair pair = test_gl_pair(scene, o);
    const double equal = test_pair_equal_share(&pair);
    const uint8_t *bytes = alp_image_bytes(pair.rendered);
    const size_t count = (size_t)o->width * o->height;
    size_t lit = 0;
    for (size_t i = 0; i < count; i++) {
        lit += bytes[3 * i] > 20 ? 1 : 0;
    }
    if (!(pair.alike_share >= ALIKE && equal >= EQUAL && (double)lit >= least * (double)count)) {
        fail_msg("%.4f of the pixels are alike, and %.4f of these equal; %.4f are lit",
                 pair.alike_share, equal, (double)lit / (double)count);
    }
    test_pair_destroy(&pair);
}

static alp_lamp lamp_at(float x, float y, float z, float intensity)
{
    alp_lamp lamp = alp_lamp_default();
    lamp.position[0] = x;
    lamp.position[1] = y;
    lamp.position[2] = z;
    lamp.intensity = intensity;
    lamp.color[1] = 0.8f;
    return lamp;
}

TEST_WITH_CONTEXT(point_lights_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    alp_render_options o = small_picture();
    const alp_lamp lamps[2] = {lamp_at(-0.5f, 2.0f, 0.5f, 30.0f), lamp_at(1.0f, 1.2f, -1.0f, 9.0f)};
    o.lighting.lamps = lamps;
    o.lighting.lamp_count = 2;
    check(scene, &o, 0.5);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(spot_lights_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    alp_render_options o = small_picture();
    alp_lamp lamps[2] = {lamp_at(-0.5f, 2.0f, 0.5f, 100.0f), lamp_at(1.5f, 2.0f, -1.0f, 60.0f)};
    for (int i = 0; i < 2; i++) {
        lamps[i].kind = ALP_LIGHT_SPOT;
        memcpy(lamps[i].direction, (const float[3]){0.4f, -2.0f, -0.3f}, sizeof lamps[i].direction);
    }
    lamps[0].inner_cone = 0.3f; // one view
    lamps[0].outer_cone = 0.7f;
    lamps[1].outer_cone = 1.5f; // six
    o.lighting.lamps = lamps;
    o.lighting.lamp_count = 2;
    check(scene, &o, 0.5);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(lamps_outside_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:atrium,triangles=20000");
    alp_render_options o = small_picture();
    alp_lamp lamps[2] = {lamp_at(6.0f, 70.0f, 3.0f, 1e5f), lamp_at(-2e3f, 4e3f, 1e3f, 1e9f)};
    lamps[1].kind = ALP_LIGHT_SPOT;
    memcpy(lamps[1].direction, (const float[3]){2, -4, -1}, sizeof lamps[1].direction);
    lamps[1].outer_cone = 0.9f;
    o.lighting.lamps = lamps;
    o.lighting.lamp_count = 2;
    check(scene, &o, 0.1);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(too_many_lamps_are_refused, 1)
{
    if (!test_gl_open()) {
        skip();
    }
    GLint layers = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_lighting_options lighting = alp_lighting_options_default();
    gl_lights lights;
    lighting.lamp_count = (uint32_t)layers / 6 + 1;
    alp_lamp *lamps = calloc(lighting.lamp_count, sizeof *lamps);
    assert_non_null(lamps);
    for (uint32_t i = 0; i < lighting.lamp_count; i++) {
        lamps[i] = lamp_at(0.1f, 0.2f, 0.3f, 1.0f);
    }
    lighting.lamps = lamps;
    assert_int_equal(gl_lights_create(scene, &lighting, &lights), EXIT_FAILED);
    gl_lights_destroy(&lights);
    test_gl_check();
    free(lamps);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(suns_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:atrium,triangles=20000");
    alp_render_options o = small_picture();
    o.lighting.sun.azimuth = 0.7f;
    o.lighting.sun.elevation = 0.9f;
    o.lighting.sun.illuminance = 100000.0f;
    check(scene, &o, 0.1);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(suns_of_terrains_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:terrain,triangles=5000");
    alp_render_options o = small_picture();
    o.lighting.sun.azimuth = 2.0f;
    o.lighting.sun.elevation = 0.2f;
    o.lighting.sun.illuminance = 10000.0f;
    check(scene, &o, 0.2);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(lights_of_files_are_those_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    const alpi_light lights[4] = {
        {.kind = ALP_LIGHT_POINT,
         .color = {1, 0.5f, 0.2f},
         .intensity = 40,
         .position = {-0.5f, 2, 0.5f},
         .range = 2.5f},
        {.kind = ALP_LIGHT_SPOT,
         .color = {0.2f, 0.5f, 1},
         .intensity = 60,
         .position = {1.5f, 2, -1},
         .direction = {0, -1, 0},
         .range = 4,
         .inner_cone = 0.6f,
         .outer_cone = 0.6f}, // a sharp edge
        {.kind = ALP_LIGHT_DIRECTIONAL,
         .color = {1, 1, 1},
         .intensity = 20,
         .direction = {0.6f, -0.8f, 0},
         .range = INFINITY},
        {.kind = ALP_LIGHT_POINT, .color = {1, 1, 1}, .intensity = NAN, .range = INFINITY}};
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    alp_render_options o = small_picture();
    assert_int_equal(scene->light_count, 0);
    scene->lights = ALPI_NEW(context, alpi_light, 4);
    assert_non_null(scene->lights);
    memcpy(scene->lights, lights, sizeof lights);
    scene->light_count = 4;
    check(scene, &o, 0.2);
    alp_scene_destroy(scene);
}
