// SPDX-License-Identifier: MIT
// Triangles that are taken for dark show no light anywhere, however their texture wraps.
#include "test_lights.h"

#include "base/image.h"
#include "base/memory.h"
#include "base/random.h"
#include "scene/lights/black_emission.h"
#include "scene/lights/lighting_emitters.h"

#include <math.h>

enum { TRIANGLES = 400, WIDTH = 50, HEIGHT = 30 };

static float random_float(uint32_t *key)
{
    return alpi_unit_float(alpi_hash32(++*key));
}

/// Coordinates all over the picture, and beyond its borders.
static void fill_set(alp_scene *scene, uint32_t set, uint32_t key)
{
    scene->uvs[set] = alpi_allocate(scene->context, (size_t)3 * TRIANGLES, sizeof(float[2]));
    assert_non_null(scene->uvs[set]);
    for (int i = 0; i < TRIANGLES; i++) {
        float u = 4 * random_float(&key) - 2, v = 4 * random_float(&key) - 2;
        float size = i % 40 == 0 ? 3.0f : 0.2f; // some over more than all of it
        for (int k = 0; k < 3; k++) {
            scene->uvs[set][3 * i + k][0] = u + size * random_float(&key);
            scene->uvs[set][3 * i + k][1] = v + size * random_float(&key);
        }
    }
}

/// Triangles all over a picture, and beyond its borders, that is black but for a few texels.
static alp_scene *make_scene(alp_context *context)
{
    static vec3 triangles[TRIANGLES][3];
    for (int i = 0; i < TRIANGLES; i++) {
        const vec3 one[3] = {{(float)i, 0, 0}, {(float)i + 1, 0, 0}, {(float)i, 1, 0}};
        memcpy(triangles[i], one, sizeof one);
    }
    alp_scene *scene =
        test_emitter_scene(context, (const vec3(*)[3])triangles, TRIANGLES, (vec3){1, 1, 1});
    scene->images = ALPI_NEW(context, alp_image *, 1);
    scene->image_count = 1;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){WIDTH, HEIGHT, 3, ALP_COMPONENT_U8},
                               &scene->images[0]));
    uint8_t *pixels = alp_image_bytes(scene->images[0]);
    memset(pixels, 0, (size_t)WIDTH * HEIGHT * 3);
    const int bright[] = {0, WIDTH - 1, 10 * WIDTH + 20, (HEIGHT - 1) * WIDTH + 7};
    for (int i = 0; i < 4; i++) {
        pixels[3 * bright[i] + i % 3] = 255;
    }
    scene->materials[0].emission_texture.image = 0;
    fill_set(scene, 0, 5);
    return scene;
}

/// Of three blended sets, whose normals have a part of all axes.
static void blend(alp_scene *scene)
{
    alpi_texture *texture = &scene->materials[0].emission_texture;
    texture->blended = true;
    for (uint32_t set = 0; set < 3; set++) {
        texture->slots[set] = (uint8_t)set;
        if (set > 0) {
            fill_set(scene, set, 1000 * set);
        }
    }
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        scene->surfaces[s].uv_slots = 7;
    }
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        vec3_store(scene->normals[v], (vec3){0.57735f, 0.57735f, 0.57735f});
    }
}

/// A triangle over a texture of which one texel of 48² shines: its mean is found however small
/// that texel is on it. Each texel has 1/1152 of the triangle, and half of that at its slanted
/// side.
TEST(the_mean_of_small_spots_is_found)
{
    enum { SIDE = 48 };
    alp_context *context = test_context(1);
    const vec3 triangle[1][3] = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    alp_scene *scene = test_emitter_scene(context, triangle, 1, (vec3){1, 1, 1});
    scene->images = ALPI_NEW(context, alp_image *, 1);
    scene->image_count = 1;
    ASSERT_OK(context, alp_image_create(context, (alp_image_info){SIDE, SIDE, 3, ALP_COMPONENT_U8},
                                        &scene->images[0]));
    uint8_t *pixels = alp_image_bytes(scene->images[0]);
    scene->materials[0].emission_texture.image = 0;
    scene->uvs[0] = alpi_allocate(context, scene->vertex_count, sizeof(float[2]));
    assert_non_null(scene->uvs[0]);
    for (int k = 0; k < 3; k++) {
        scene->uvs[0][scene->triangles[0][k]][0] = k == 1 ? 1.0f : 0.0f;
        scene->uvs[0][scene->triangles[0][k]][1] = k == 2 ? 1.0f : 0.0f;
    }
    double sum = 0.0;
    for (int spot = 0; spot < 20; spot++) {
        const int x = 2 + spot, y = 3 + spot / 2 * 2; // well inside the triangle
        memset(pixels, 0, (size_t)3 * SIDE * SIDE);
        memset(pixels + 3 * (y * SIDE + x), 255, 3);
        const double found = alpi_emitters_radiance(scene, 0) * SIDE * SIDE / 2.0;
        assert_true(found > 0.4 && found < 1.8); // samples are about as wide as texels
        sum += found / 20.0;
    }
    ASSERT_NEAR(sum, 1.0, 0.1);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

static void check_dark(bool blended)
{
    alp_context *context = test_context(1);
    alp_scene *scene = make_scene(context);
    alpi_texture *texture = &scene->materials[0].emission_texture;
    if (blended) {
        blend(scene);
    }
    for (int wrap = 0; wrap < 9; wrap++) {
        static bool dark[TRIANGLES];
        memset(dark, 0, sizeof dark);
        texture->wrap_u = (alpi_wrap)(wrap % 3);
        texture->wrap_v = (alpi_wrap)(wrap / 3);
        texture->rotation = wrap > 4 ? 0.3f : 0.0f;
        ASSERT_OK(context, alpi_lighting_mark_dark(scene, dark));
        uint32_t marked = 0, missed = 0;
        for (uint32_t t = 0; t < TRIANGLES; t++) {
            bool lit = false;
            for (uint32_t i = 0; i < 300; i++) {
                vec2 u = test_draw_at(t, i).u;
                float root = sqrtf(u.x);
                vec3 l = alpi_surface_emission(scene, t, root * (1.0f - u.y), root * u.y,
                                               (vec3){0, 0, 1});
                lit = lit || l.x > 0.0f || l.y > 0.0f || l.z > 0.0f;
            }
            assert_false(dark[t] && lit);
            marked += dark[t];
            missed += !dark[t] && !lit;
        }
        print_message("wrap %d: %u of %d dark, %u not told\n", wrap, marked, TRIANGLES, missed);
        bool mirrors = texture->wrap_u == ALPI_WRAP_MIRROR || texture->wrap_v == ALPI_WRAP_MIRROR;
        assert_true(marked > (mirrors ? 20 : 100) / (blended ? 10 : 1)); // dark in all three
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(dark_ones_show_no_light)
{
    check_dark(false);
}

TEST(dark_ones_show_no_light_in_any_set)
{
    check_dark(true);
}

TEST_WITH_CONTEXT(what_cannot_be_told_is_not_dark, 1)
{
    alp_scene *scene = make_scene(context);
    static bool dark[TRIANGLES];
    scene->uvs[0][0][0] = NAN;
    scene->uvs[0][3][1] = INFINITY;
    scene->uvs[0][6][0] = scene->uvs[0][6][1] = 1e30f;
    ASSERT_OK(context, alpi_lighting_mark_dark(scene, dark));
    assert_false(dark[0] || dark[1] || dark[2]);
    alp_scene_destroy(scene);
}
