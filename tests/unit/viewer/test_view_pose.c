// SPDX-License-Identifier: MIT
// A scene whose nodes have moved is drawn as the scene of that pose.
#include "pack_asset.h"
#include "test_gl.h"

#include "fields/field.h"
#include "options/options.h"
#include "picture.h"
#include "shaders/bindings.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 240, HEIGHT = 135, PIXELS = WIDTH * HEIGHT };

/// A floor, and a wall of 1 x 1 m with a lamp before it. In 2 s both slide from x = -1 to 1, and
/// the wall turns by a quarter about y. The wall glows.
static alp_scene *load_stage(alp_context *context)
{
    static const float floor[4][3] = {{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}};
    static const float wall[4][3] = {{-.5f, 0, 0}, {.5f, 0, 0}, {.5f, 1, 0}, {-.5f, 1, 0}};
    static const float up[4][3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
    static const float front[4][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    static const uint8_t corners[6] = {0, 1, 2, 0, 2, 3};
    static const float times[2] = {0, 2}, slide[2][3] = {{-1, 0.2f, 0}, {1, 0.2f, 0}};
    static const float turn[2][4] = {{0, 0, 0, 1}, {0, 0.70710678f, 0, 0.70710678f}};
    pack_asset *asset = pack_start();
    pack_accessor(asset, pack_view(asset, floor, sizeof floor, 0), 5126, 4, "VEC3",
                  ",'min':[-2,0,-2],'max':[2,0,2]");
    pack_accessor(asset, pack_view(asset, wall, sizeof wall, 0), 5126, 4, "VEC3",
                  ",'min':[-0.5,0,0],'max':[0.5,1,0]");
    pack_accessor(asset, pack_view(asset, up, sizeof up, 0), 5126, 4, "VEC3", "");
    pack_accessor(asset, pack_view(asset, front, sizeof front, 0), 5126, 4, "VEC3", "");
    pack_accessor(asset, pack_view(asset, corners, sizeof corners, 0), 5121, 6, "SCALAR", "");
    pack_accessor(asset, pack_view(asset, times, sizeof times, 0), 5126, 2, "SCALAR", "");
    pack_accessor(asset, pack_view(asset, slide, sizeof slide, 0), 5126, 2, "VEC3", "");
    pack_accessor(asset, pack_view(asset, turn, sizeof turn, 0), 5126, 2, "VEC4", "");
    return test_load(
        context,
        pack_write(
            asset,
            "'extensionsUsed':['KHR_lights_punctual'],"
            "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point','intensity':10}]}},"
            "'scene':0,'scenes':[{'nodes':[0,1]}],'nodes':[{'name':'floor','mesh':0},{'name':"
            "'wall','mesh':1,'children':[2],'translation':[-1,0.2,0]},{'translation':[0,1.2,1],"
            "'extensions':{'KHR_lights_punctual':{'light':0}}}],"
            "'materials':[{'pbrMetallicRoughness':{'metallicFactor':0},'doubleSided':true},"
            "{'pbrMetallicRoughness':{'metallicFactor':0},'doubleSided':true,"
            "'emissiveFactor':[0.3,0.2,0.1]}],"
            "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':2},'indices':4,"
            "'material':0}]},{'primitives':[{'attributes':{'POSITION':1,'NORMAL':3},'indices':4,"
            "'material':1}]}],"
            "'animations':[{'channels':[{'sampler':0,'target':{'node':1,'path':'translation'}},"
            "{'sampler':1,'target':{'node':1,'path':'rotation'}}],'samplers':[{'input':5,"
            "'output':6},{'input':5,'output':7}]}]"));
}

static alp_scene *pose(const alp_scene *scene, double seconds)
{
    alp_scene *posed = NULL;
    ASSERT_OK(scene->context, alp_scene_pose(scene, 0, seconds, &posed));
    return posed;
}

static const alp_camera camera = {.position = {-1.5f, 1.5f, 4.0f},
                                  .target = {0.0f, 0.5f, 0.0f},
                                  .up = {0.0f, 1.0f, 0.0f},
                                  .vertical_fov = 0.8f};

/// A mode, and the light that it keeps.
typedef struct pose_case {
    const char *mode;
    GLint read; // of a field
    const alp_field *field;
    const alp_lightmap *lightmap;
} pose_case;

static mode_light make_light(const alp_scene *scene, const pose_case *c)
{
    mode_light light = {0};
    if (c->lightmap != NULL) {
        assert_int_equal(gl_lightmap_create(scene, c->lightmap, ALP_MAP_LIGHT, ALP_BLEND_NORMAL,
                                            &light.lightmap),
                         EXIT_DONE);
    }
    if (strcmp(c->mode, "lpv") == 0) {
        alp_lpv_options o = alp_lpv_options_default();
        alp_lpv_scene_options frame = alp_lpv_scene_options_default();
        int code = EXIT_FAILED;
        o.cascades = 1;
        o.cell = 0.25;
        o.centre[1] = 1.0;
        o.blockers = true;
        light.lpv = malloc(sizeof *light.lpv);
        assert_non_null(light.lpv);
        ASSERT_OK(scene->context, lpv_frame_create(scene, &o, &frame, &code, light.lpv));
        assert_int_equal(code, EXIT_DONE);
    }
    if (light.lpv != NULL || c->field != NULL) {
        assert_int_equal(gl_field_create(scene, c->read, WIDTH, HEIGHT, &light.field), EXIT_DONE);
        light.field.workers = 2;
    }
    if (light.lpv != NULL) {
        gl_field_set_volume(&light.field, &light.lpv->volume, false);
    } else if (c->field != NULL) {
        gl_field_set(&light.field, c->field);
    }
    return light;
}

/// Overlapping charts are blended along the axes of the objects.
static void check_axes(const gl_scene *drawn, const alp_scene *scene)
{
    for (uint32_t i = 0; i < drawn->surface_count; i++) {
        const alp_surface_info surface = alp_scene_get_surface(scene, i);
        assert_memory_equal(drawn->surfaces[i].axes, surface.axes, sizeof surface.axes);
    }
}

/// Draws `scene`, and after it `posed`, where there is one. @return the last picture
static alp_image *draw(const alp_scene *scene, const alp_scene *posed, const pose_case *c)
{
    const alp_lighting_options lighting = alp_lighting_options_default();
    const drawing_options o = {.context = scene->context,
                               .mode = test_gl_mode(c->mode),
                               .light = make_light(scene, c),
                               .lighting = &lighting,
                               .width = WIDTH,
                               .height = HEIGHT,
                               .direct = true,
                               .level_zero = true};
    drawing d;
    alp_image *light = NULL;
    assert_int_equal(drawing_create(scene, &o, &d), EXIT_DONE);
    drawing_draw(&d, &camera);
    if (posed != NULL) {
        assert_int_equal(drawing_set_pose(&d, scene->context, posed, &lighting), EXIT_DONE);
        check_axes(&d.drawn, posed);
        drawing_draw(&d, &camera);
    }
    ASSERT_OK(scene->context, picture_read_light(scene->context, &d.targets, &light));
    test_gl_check();
    drawing_destroy(&d);
    return light;
}

/// Pixels that differ by more than rounding of floats.
static uint32_t count_different(alp_image *a, alp_image *b)
{
    const float *p = alp_image_floats(a), *q = alp_image_floats(b);
    uint32_t count = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        bool same = true;
        for (size_t k = 4 * i; k < 4 * i + 4; k++) {
            same = same && fabsf(p[k] - q[k]) <= 1e-5f * fmaxf(1.0f, fabsf(q[k]));
        }
        count += same ? 0 : 1;
    }
    return count;
}

/// Draws the pose after the rest, the pose alone, and the rest.
static void check_case(const alp_scene *scene, const pose_case *c)
{
    alp_scene *posed = pose(scene, 1.25);
    alp_image *moved = draw(scene, posed, c), *alone = draw(posed, NULL, c);
    alp_image *rest = draw(scene, NULL, c);
    const uint32_t wrong = count_different(moved, alone), far = count_different(rest, alone);
    print_message("%s: %u pixels differ from the pose, %u from the rest\n", c->mode, wrong, far);
    if (wrong > 0 || far < PIXELS / 50) {
        fail_msg("%s, read %d: %u pixels differ from the pose, %u from the rest", c->mode, c->read,
                 wrong, far);
    }
    alp_image_destroy(rest);
    alp_image_destroy(alone);
    alp_image_destroy(moved);
    alp_scene_destroy(posed);
}

TEST_WITH_CONTEXT(a_pose_is_drawn_as_a_scene_of_its_own, 2)
{
    static const char *const modes[] = {"albedo", "none", "direct", "lpv"};
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = load_stage(context);
    for (size_t i = 0; i < sizeof modes / sizeof *modes; i++) {
        check_case(scene, &(pose_case){.mode = modes[i], .read = READ_PIXEL});
    }
    alp_scene_destroy(scene);
}

/// One field lights both; it is read where the surfaces are.
TEST_WITH_CONTEXT(a_pose_reads_a_field_at_its_places, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = load_stage(context);
    alp_probe_options bake = alp_probe_options_default();
    alp_probes *probes = NULL;
    alp_field *field = NULL;
    bake.spacing = 0.5f;
    bake.atlas_size = 128;
    bake.rays = 384;
    ASSERT_OK(context, alp_probes_bake(scene, &bake, &probes));
    ASSERT_OK(context, alp_field_create_probes(probes, ALP_LOOKUP_OURS,
                                               alp_scene_get_info(scene).origin, NULL, &field));
    for (GLint read = READ_PIXEL; read <= READ_OBJECT; read++) {
        check_case(scene, &(pose_case){"probes", read, field, NULL});
    }
    alp_field_destroy(field);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_pose_keeps_the_texels_of_a_light_map, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = load_stage(context);
    alp_bake_options bake = alp_bake_options_default();
    alp_lightmap *lightmap = NULL;
    bake.maps = ALP_MAP_LIGHT;
    bake.atlas.size = 128;
    bake.atlas.mode = ALP_ATLAS_BLEND;
    bake.light.samples = 8;
    ASSERT_OK(context, alp_bake(scene, &bake, &lightmap, NULL));
    check_case(scene, &(pose_case){.mode = "blend", .lightmap = lightmap});
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

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

/// The light of a pose by shadow maps is that of render by rays.
TEST_WITH_CONTEXT(a_pose_is_lit_as_in_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = load_stage(context), *posed = pose(scene, 1.25);
    alp_render_options o = alp_render_options_default();
    o.method = ALP_RENDER_FIELD;
    o.width = WIDTH;
    o.height = HEIGHT;
    o.camera = camera;
    o.field = dark_field();
    test_pair pair = test_gl_pair(posed, &o);
    const double equal = test_pair_equal_share(&pair);
    print_message("%.4f alike, %.4f of these equal\n", pair.alike_share, equal);
    if (!(pair.alike_share >= 0.85 && equal >= 0.97)) { // as of other scenes
        fail_msg("%.4f of the pixels are alike, and %.4f of these equal", pair.alike_share, equal);
    }
    test_pair_destroy(&pair);
    alp_scene_destroy(posed);
    alp_scene_destroy(scene);
}
