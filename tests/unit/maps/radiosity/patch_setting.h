// SPDX-License-Identifier: MIT
// Scenes with an atlas and patches on it, and points to look them up at.
#ifndef PATCH_SETTING_H
#define PATCH_SETTING_H

#include "test_scenes.h"

#include "base/random.h"
#include "maps/radiosity/patches.h"

#include <string.h>

/// An atlas of a scene and patches of it.
typedef struct setting {
    alp_context *context;
    alp_scene *scene;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_lattice lattice;
    alpi_patches patches;
} setting;

/// @param side of patches in texels: 1, 2 or 4
/// @param each 1 or 0: all texels have light of their own; n: those not divisible by n
static inline void open_on(setting *s, alp_scene *scene, const alp_atlas_options *options,
                           uint32_t side, uint32_t each)
{
    static uint32_t order[1u << 18];
    static uint8_t proximity[1u << 18];
    uint32_t count = 0;
    memset(proximity,
           side == 1   ? ALPI_TOUCHING
           : side == 2 ? ALPI_NEAR
                       : ALPI_FAR,
           sizeof proximity);
    *s = (setting){.context = scene->context, .scene = scene};
    ASSERT_OK(s->context, alp_atlas_create(scene, options, &s->atlas));
    ASSERT_OK(s->context, alpi_texels_create(s->atlas, &s->texels));
    ASSERT_OK(s->context, alpi_lattice_create(s->atlas, &s->texels, &s->lattice));
    assert_true(s->texels.count <= sizeof order / sizeof *order);
    for (uint32_t i = 0; i < s->texels.count; i++) {
        if (each <= 1 || s->lattice.order[i] % each != 0) {
            order[count++] = s->lattice.order[i];
        }
    }
    ASSERT_OK(s->context,
              alpi_patches_create(&s->lattice, s->atlas, order, count, proximity, &s->patches));
}

/// @param each 1: all texels have light of their own; n: those not divisible by n; 0: all, 5 to a
/// metre
static inline void open_setting(setting *s, alp_scene *scene, uint32_t size, float max_angle,
                                uint32_t side, uint32_t each)
{
    alp_atlas_options a = alp_atlas_options_default();
    a.size = size;
    a.texels_per_metre = each == 0 ? 5.0 : 0.0;
    a.max_angle = max_angle;
    open_on(s, scene, &a, side, each);
}

static inline void close_setting(setting *s)
{
    alp_context *context = s->context;
    alpi_patches_destroy(&s->patches);
    alpi_lattice_destroy(&s->lattice);
    alpi_texels_destroy(context, &s->texels);
    alp_atlas_destroy(s->atlas);
    alp_scene_destroy(s->scene);
    alp_context_destroy(context);
}

/// A ball of facets in a room: charts of one facet (thousands), or of many.
static inline alp_scene *make_ball(alp_context *context, int slices, int stacks)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0, 0, 0}, 1.0, slices, stacks, 1.0, 1);
    test_mesh_quad(mesh, (double[]){-2, -2, -2}, (double[]){0, 0, 4}, (double[]){4, 0, 0});
    return test_mesh_scene(context, mesh, 0);
}

/// A point of a triangle, `number` of them: its corners, its edges, then inside.
static inline void pick_point(uint32_t triangle, uint32_t number, float *b1, float *b2)
{
    const vec2 u = alpi_sample_2d(triangle, number);
    *b1 = u.x + u.y > 1.0f ? 1.0f - u.x : u.x;
    *b2 = u.x + u.y > 1.0f ? 1.0f - u.y : u.y;
    *b1 = number == 0 ? 0.0f : number == 1 ? 1.0f : number == 2 ? 0.0f : *b1;
    *b2 = number == 0 ? 0.0f : number == 1 ? 0.0f : number == 2 ? 1.0f : *b2;
    *b1 = number == 3 ? 0.0f : number == 4 ? 1.0f - *b2 : *b1;
    *b2 = number == 5 ? 0.0f : *b2;
}

#endif
