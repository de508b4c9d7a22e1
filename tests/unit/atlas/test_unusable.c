// SPDX-License-Identifier: MIT
// Triangles that cannot be baked get a place all the same: on their own surface where it has one,
// and in linear time however many there are.
#include "atlas_scenes.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FLAT = 400000, PATIENCE = 30 }; // a walk to the surface's end for each would take minutes

static const float SQUARE[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}};

/// Two surfaces: a triangle; then FLAT triangles without area and, if asked, one with area.
static alp_scene *flat_scene(alp_context *context, bool with_own)
{
    uint32_t(*indices)[3] = calloc((size_t)FLAT + 1, sizeof *indices);
    assert_non_null(indices);
    memcpy(indices[FLAT], (uint32_t[]){0, 2, 3}, sizeof *indices);
    const uint32_t first[3] = {0, 1, 2};
    const alp_mesh meshes[] = {
        {.vertex_count = 4, .positions = SQUARE[0], .triangle_count = 1, .indices = first},
        {.vertex_count = 4,
         .positions = SQUARE[0],
         .triangle_count = with_own ? FLAT + 1 : FLAT,
         .indices = indices[0]}};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
    free(indices);
    return scene;
}

static void check_place(const alp_atlas *atlas, uint32_t triangle, uint32_t from)
{
    const float(*uv)[2] = (const float(*)[2])atlas->corner_uvs[from];
    for (int i = 0; i < 2; i++) {
        float middle = (uv[0][i] + uv[1][i] + uv[2][i]) / 3.0f;
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(atlas->corner_uvs[triangle][k][i], middle, 0.0);
        }
    }
    assert_int_equal(atlas->triangle_pages[triangle], atlas->triangle_pages[from]);
    assert_int_equal(atlas->triangle_charts[triangle], ALPI_NONE);
}

static void check_scene(bool with_own, uint32_t from)
{
    alp_context *context = test_context(1);
    alp_scene *scene = flat_scene(context, with_own);
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_CHARTS;
    options.size = 32;
    alp_atlas *atlas = NULL;
    alarm(PATIENCE);
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    alarm(0);
    check_place(atlas, 1, from);
    check_place(atlas, FLAT / 2, from);
    check_place(atlas, FLAT, from);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(their_own_surface_comes_first)
{
    check_scene(true, FLAT + 1);
}

TEST(a_surface_without_area_borrows_from_another)
{
    check_scene(false, 0);
}
