// SPDX-License-Identifier: MIT
// Meshes that no modeller should make get charts all the same: edges that many triangles share,
// triangles that are there twice, vertices that nothing uses, a hundred thousand separate pieces;
// and what cannot be has a message with its numbers.
#include "atlas_scenes.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

enum { PIECES = 100000, PATIENCE = 60 }; // a second; what is not linear takes many minutes

static alp_result mark_covered(void *user, const alpi_band *band)
{
    bool *covered = user; // one worker
    for (uint32_t i = 0; i < band->piece_count; i++) {
        covered[band->pieces[i].triangle] = true;
    }
    return ALP_OK;
}

/// Every triangle that can be baked has area in a texel, is not mirrored and overlaps no other.
static void check_atlas(const alp_atlas *atlas)
{
    const uint32_t count = atlas->scene->triangle_count;
    const alp_atlas_info info = alp_atlas_get_info(atlas);
    assert_int_equal(info.flipped_triangles, 0);
    assert_int_equal(info.overlapping_texels, 0);
    bool *covered = calloc(count, sizeof *covered);
    assert_non_null(covered);
    ASSERT_OK(atlas->context, alpi_raster(atlas, 0, info.pages, mark_covered, covered));
    for (uint32_t t = 0; t < count; t++) {
        assert_true(covered[t] || !atlas->scene->triangle_usable[t]);
    }
    free(covered);
}

/// @return the atlas's figures
static alp_atlas_info check_mesh(const float (*positions)[3], uint32_t vertex_count,
                                 const uint32_t (*indices)[3], uint32_t count, uint32_t size)
{
    alp_context *context = test_context(1);
    alp_scene *scene = scene_of(context, positions, NULL, vertex_count, indices, count);
    alp_atlas *atlas = charts_of_size(context, scene, size);
    check_atlas(atlas);
    const alp_atlas_info info = alp_atlas_get_info(atlas);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return info;
}

static const float CUBE[8][3] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                 {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
static const uint32_t SIDES[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                      {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                      {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

/// Leaves of a book: all share the edge of its back.
TEST(an_edge_of_many_triangles)
{
    enum { LEAVES = 64 };
    float p[2 + LEAVES][3] = {{0, 0, 0}, {0, 1, 0}};
    uint32_t indices[LEAVES][3];
    for (uint32_t i = 0; i < LEAVES; i++) {
        const double angle = 2.0 * ALPI_PI * i / LEAVES;
        p[2 + i][0] = (float)cos(angle);
        p[2 + i][1] = 0.5f;
        p[2 + i][2] = (float)sin(angle);
        memcpy(indices[i], (uint32_t[]){i % 2, 1 - i % 2, 2 + i}, sizeof indices[i]);
    }
    const alp_atlas_info info =
        check_mesh((const float(*)[3])p, 2 + LEAVES, (const uint32_t(*)[3])indices, LEAVES, 256);
    assert_int_equal(info.charts, LEAVES);
}

/// A cube, and again, and turned inside out: each copy has its own texels.
TEST(triangles_that_are_there_twice)
{
    uint32_t indices[36][3];
    for (int i = 0; i < 36; i++) {
        memcpy(indices[i], SIDES[i % 12], sizeof indices[i]);
        if (i >= 24) {
            indices[i][1] = SIDES[i % 12][2];
            indices[i][2] = SIDES[i % 12][1];
        }
    }
    check_mesh(CUBE, 8, SIDES, 12, 128);
    check_mesh(CUBE, 8, (const uint32_t(*)[3])indices, 24, 128);
    check_mesh(CUBE, 8, (const uint32_t(*)[3])indices, 36, 128);
}

/// One triangle a thousand times.
TEST(a_heap_of_one_triangle)
{
    static uint32_t indices[1000][3];
    for (int i = 0; i < 1000; i++) {
        memcpy(indices[i], SIDES[0], sizeof indices[i]);
    }
    const alp_atlas_info info = check_mesh(CUBE, 8, (const uint32_t(*)[3])indices, 1000, 256);
    assert_int_equal(info.charts, 1000);
    assert_int_equal(info.pages, 1);
}

TEST(vertices_that_nothing_uses)
{
    float p[1008][3];
    memcpy(p, CUBE, sizeof CUBE);
    for (int i = 8; i < 1008; i++) {
        for (int k = 0; k < 3; k++) {
            p[i][k] =
                (float)(i * (k + 1)) - 500.0f; // some at the cube's corners' distance, some far
        }
    }
    p[1007][0] = (float)NAN;
    const alp_atlas_info with = check_mesh((const float(*)[3])p, 1008, SIDES, 12, 128);
    const alp_atlas_info without = check_mesh(CUBE, 8, SIDES, 12, 128);
    assert_int_equal(with.texels, without.texels);
    ASSERT_NEAR(with.texels_per_metre, without.texels_per_metre, 0.0);
    assert_int_equal(with.charts, without.charts);
}

/// Triangles that touch nothing, as many meshes or as one.
static void check_pieces(uint32_t mesh_count)
{
    float(*positions)[3] = calloc(3 * (size_t)PIECES, sizeof *positions);
    uint32_t(*indices)[3] = calloc(PIECES, sizeof *indices);
    alp_mesh *meshes = calloc(mesh_count, sizeof *meshes);
    assert_true(positions != NULL && indices != NULL && meshes != NULL);
    for (uint32_t i = 0; i < 3 * PIECES; i++) {
        positions[i][0] = (float)(i / 3 % 1000) + (i % 3 == 1 ? 0.5f : 0.0f);
        positions[i][1] = (float)(i / 3000) + (i % 3 == 2 ? 0.5f : 0.0f);
        indices[i / 3][i % 3] = i % (3 * PIECES / mesh_count);
    }
    const uint32_t each = PIECES / mesh_count;
    for (uint32_t m = 0; m < mesh_count; m++) {
        meshes[m] = (alp_mesh){.vertex_count = 3 * each,
                               .positions = positions[3 * (size_t)m * each],
                               .triangle_count = each,
                               .indices = indices[(size_t)m * each]};
    }
    alp_context *context = test_context(1);
    alp_scene *scene = NULL;
    alarm(PATIENCE);
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, mesh_count, &scene));
    alp_atlas *atlas = charts_of_size(context, scene, 1024);
    alarm(0);
    check_atlas(atlas);
    assert_int_equal(alp_atlas_get_info(atlas).charts, PIECES);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    free(meshes);
    free(indices);
    free(positions);
}

TEST(a_hundred_thousand_pieces)
{
    check_pieces(1);
    check_pieces(PIECES);
}

// --- what cannot be ------------------------------------------------------------------------------

static alp_result try_density(alp_context *context, double density, alp_atlas_info *info)
{
    alp_scene *scene = scene_cube(context);
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_CHARTS;
    options.size = 64;
    options.texels_per_metre = density;
    alp_atlas *atlas = NULL;
    const alp_result result = alp_atlas_create(scene, &options, &atlas);
    if (result == ALP_OK) {
        check_atlas(atlas);
    }
    *info = alp_atlas_get_info(atlas);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    return result;
}

/// The half of a cube's side is 2 m wide and high: 200 texels at 100. What the message says is
/// possible is, and a percent more is not.
TEST_WITH_CONTEXT(a_triangle_larger_than_a_page_is_told, 1)
{
    static const char *const words[] = {"thing", "triangle 0", "100 texels per metre",
                                        "a page of 64 texels"};
    alp_atlas_info info;
    assert_int_equal(try_density(context, 100.0, &info), ALP_ERROR_LIMIT);
    const char *message = alp_context_message(context);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strstr(message, words[i]) == NULL) {
            fail_msg("'%s' is not in: %s", words[i], message);
        }
    }
    const char *most = strstr(message, "at most ");
    assert_non_null(most);
    const double density = strtod(most + strlen("at most "), NULL);
    assert_int_equal(try_density(context, 1.01 * density, &info), ALP_ERROR_LIMIT);
    ASSERT_OK(context, try_density(context, density, &info));
    ASSERT_NEAR(info.texels_per_metre, density, 1e-3 * density);
    assert_true(info.pages > 1); // 24 m², and a page has 4 m² at 32 texels per metre
}
