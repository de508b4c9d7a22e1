// SPDX-License-Identifier: MIT
// Normal maps of the viewer: a plane with a map of one tilt has the light of the tilted normal.
#include "test_gl.h"
#include "test_gltf.h"

#include "base/memory.h"
#include "scene/scene.h"
#include "shaders/bindings.h"

#include <math.h>
#include <stdio.h>

static const uint8_t TILT[3] = {200, 90, 220}; // of every texel
static const double SCALE = 0.5;               // of the normal texture
enum { SIDE = 64 };

/// A square of 2 × 2 m about the origin, which faces +Z; u runs along +X, v along −Y.
typedef struct plane {
    float positions[4][3], normals[4][3], uvs[4][2];
    uint16_t indices[6];
} plane;

static const char TEXT[] =
    "{'asset':{'version':'2.0'},'buffers':[{'byteLength':140}],'bufferViews':["
    "{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':48},"
    "{'buffer':0,'byteOffset':96,'byteLength':32},{'buffer':0,'byteOffset':128,'byteLength':12}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3','min':[-1,-1,0],"
    "'max':[1,1,0]},{'bufferView':1,'componentType':5126,'count':4,'type':'VEC3'},"
    "{'bufferView':2,'componentType':5126,'count':4,'type':'VEC2'},"
    "{'bufferView':3,'componentType':5123,'count':6,'type':'SCALAR'}],"
    "'images':[{'uri':'tilt.png'}],'textures':[{'source':0}],"
    "'materials':[{'doubleSided':true,'normalTexture':{'index':0,'scale':0.5},"
    "'pbrMetallicRoughness':{'baseColorFactor':[0.5,0.5,0.5,1]}}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2},'indices':3,"
    "'material':0}]}],'nodes':[{'mesh':0}],'scenes':[{'nodes':[0]}],'scene':0}";

static alp_scene *load_plane(alp_context *context)
{
    static const float places[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const char *folder = test_folder();
    const alp_image_info info = {4, 4, 3, ALP_COMPONENT_U8};
    alp_image *image = NULL;
    plane p = {.indices = {0, 1, 2, 0, 2, 3}};
    size_t size = 0;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 2; k++) {
            p.positions[i][k] = places[i][k];
            p.uvs[i][k] = k == 0 ? 0.5f + 0.5f * places[i][k] : 0.5f - 0.5f * places[i][k];
        }
        p.normals[i][2] = 1.0f;
    }
    uint8_t *bytes = test_glb(context, TEXT, &p, sizeof p, &size);
    FILE *file = fopen(test_path(folder, "plane.glb"), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    alpi_release(context, bytes);
    ASSERT_OK(context, alp_image_create(context, info, &image));
    for (int i = 0; i < 4 * 4 * 3; i++) {
        alp_image_bytes(image)[i] = TILT[i % 3];
    }
    ASSERT_OK(context, alp_image_save(image, test_path(folder, "tilt.png"), true));
    alp_image_destroy(image);
    alp_scene *scene = test_load(context, test_path(folder, "plane.glb"));
    ASSERT_OK(context, alp_scene_load_normal_maps(scene));
    return scene;
}

/// Light that differs in all directions.
static alp_field *fit_environment(alp_context *context, const alp_scene *scene)
{
    alp_ambient_options fit = alp_ambient_options_default();
    alp_field *field = NULL;
    fit.model = ALP_AMBIENT_ENVIRONMENT;
    fit.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    fit.lighting.sky.up[0] = 3.0f;
    fit.lighting.sky.down[2] = 2.0f;
    fit.points = 64;
    fit.samples = 64;
    ASSERT_OK(context, alp_field_create_ambient(scene, &fit, &field));
    return field;
}

/// The light in the middle of the plane, which is seen from one side.
static void draw(const alp_scene *scene, mode_light light, const view_mode *mode, float z,
                 bool maps, float rgb[3])
{
    const alp_lighting_options lighting = alp_lighting_options_default();
    const drawing_options options = {.context = scene->context,
                                     .mode = mode,
                                     .light = light,
                                     .lighting = &lighting,
                                     .width = SIDE,
                                     .height = SIDE,
                                     .normal_maps = maps,
                                     .level_zero = true};
    const alp_camera camera = {
        .position = {0, 0, z}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov = 0.5f};
    alp_film_options film = alp_film_options_default();
    alp_image *developed = NULL, *drawn = NULL;
    drawing d;
    assert_int_equal(drawing_create(scene, &options, &d), EXIT_DONE);
    drawing_draw(&d, &camera);
    ASSERT_OK(scene->context, drawing_develop(&d, scene->context, &film, &developed, &drawn));
    for (int k = 0; k < 3; k++) {
        rgb[k] = alp_image_floats(drawn)[4 * (SIDE / 2 * SIDE + SIDE / 2) + k];
    }
    alp_image_destroy(developed);
    alp_image_destroy(drawn);
    drawing_destroy(&d);
    test_gl_check();
}

/// n = ± normalize(s x, s y, z) of the texel, and (0, 0, ± 1) without maps.
static void find_normal(float side, bool maps, float normal[3])
{
    double n[3] = {0.0, 0.0, 1.0};
    for (int k = 0; k < 3 && maps; k++) {
        n[k] = (2.0 * TILT[k] / 255.0 - 1.0) * (k < 2 ? SCALE : 1.0);
    }
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++) {
        normal[k] = (float)((side > 0.0f ? n[k] : -n[k]) / length);
    }
}

/// Both sides of the plane, with and without its map.
static void check(const alp_scene *scene, const alp_field *field, GLint read)
{
    for (int i = 0; i < 4; i++) {
        const float z = i % 2 == 0 ? 3.0f : -3.0f, position[3] = {0.0f, 0.0f, 0.0f};
        const bool maps = i < 2;
        mode_light light = {0};
        float normal[3], expected[3], rgb[3];
        assert_int_equal(gl_field_create(scene, read, SIDE, SIDE, &light.field), EXIT_DONE);
        gl_field_set(&light.field, field);
        draw(scene, light, test_gl_mode("probes"), z, maps, rgb);
        find_normal(z, maps, normal);
        alp_field_irradiance(field, 1, &position, (const float(*)[3]) & normal, &expected);
        for (int k = 0; k < 3; k++) {
            const double e = 0.5 / 3.14159265358979 * (double)expected[k];
            assert_true(fabs((double)rgb[k] - e) <= 1e-4 * (0.1 + e));
        }
    }
}

TEST_WITH_CONTEXT(normal_maps_turn_the_normals_of_fields, 1)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = load_plane(context);
    alp_field *field = fit_environment(context, scene);
    check(scene, field, READ_PIXEL);
    check(scene, field, READ_OBJECT);
    alp_field_destroy(field);
    alp_scene_destroy(scene);
}

// --- light maps by direction ---------------------------------------------------------------------

/// One channel of a page, bilinear, clamped.
static double read_page(const float *page, const uint32_t size[2], const double uv[2], int channel)
{
    uint32_t low[2], high[2];
    double share[2], rows[2];
    for (int k = 0; k < 2; k++) {
        const double at = fmin(fmax(uv[k] * size[k] - 0.5, 0.0), size[k] - 1.0);
        low[k] = (uint32_t)at;
        high[k] = low[k] + 1 < size[k] ? low[k] + 1 : low[k];
        share[k] = at - low[k];
    }
    for (int row = 0; row < 2; row++) {
        const float *from = page + 4 * (size_t)size[0] * (row == 0 ? low[1] : high[1]) + channel;
        rows[row] =
            (1.0 - share[0]) * (double)from[4 * low[0]] + share[0] * (double)from[4 * high[0]];
    }
    return (1.0 - share[1]) * rows[0] + share[1] * rows[1];
}

/// E of the four maps at a normal, h to the right of the middle of the plane and h below it.
static double expect_sh(const alp_lightmap *lightmap, double h, const float n[3], int channel)
{
    const float *uvs = alp_atlas_corner_uvs(alp_lightmap_atlas(lightmap)); // of triangle 0
    const double s = 0.5 * (1.0 + h), t = 0.5 * (1.0 - h), weights[3] = {1.0 - s, s - t, t};
    double uv[2] = {0.0, 0.0}, c[4];
    for (int k = 0; k < 6; k++) {
        uv[k % 2] += weights[k / 2] * (double)uvs[k];
    }
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t size[2];
        const float *page = alp_lightmap_sh_page(lightmap, i, 0, &size[0], &size[1]);
        c[i] = read_page(page, size, uv, channel);
    }
    const double linear = (double)n[1] * c[1] + (double)n[2] * c[2] + (double)n[0] * c[3];
    return 3.14159265358979 * 0.28209479177 * c[0] + 2.09439510239 * 0.48860251190 * linear;
}

TEST_WITH_CONTEXT(light_maps_by_direction_are_read_at_mapped_normals, 1)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = load_plane(context);
    alp_bake_options bake = alp_bake_options_default();
    alp_lightmap *lightmap = NULL;
    bake.maps = ALP_MAP_LIGHT | ALP_MAP_SH;
    bake.atlas.size = 32;
    bake.atlas.mode = ALP_ATLAS_CHARTS;
    bake.light.samples = 32;
    bake.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    bake.light.lighting.sky.down[2] = 0.2f;
    ASSERT_OK(context, alp_bake(scene, &bake, &lightmap, NULL));
    for (int i = 0; i < 2; i++) {
        mode_light light = {0};
        float rgb[3], normal[3];
        assert_int_equal(
            gl_lightmap_create(scene, lightmap, ALP_MAP_SH, ALP_BLEND_NORMAL, &light.lightmap),
            EXIT_DONE);
        draw(scene, light, test_gl_mode("sh"), 3.0f, i == 1, rgb);
        find_normal(1.0f, i == 1, normal);
        for (int k = 0; k < 3; k++) {
            const double h = 3.0 * tan(0.25) / SIDE;
            const double e = 0.5 / 3.14159265358979 * expect_sh(lightmap, h, normal, k);
            assert_true(fabs((double)rgb[k] - e) <= 1e-4 * e);
        }
    }
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}
