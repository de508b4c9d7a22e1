// SPDX-License-Identifier: MIT
// Neighbours: symmetric, by position, and only where the surface really goes on.
#include "scene/adjacency.h"

#include "base/memory.h"
#include "test_support.h"

#include <math.h>
#include <stdlib.h>

static alp_scene *scene_of(alp_context *context, const float (*positions)[3], uint32_t vertices,
                           const uint32_t (*indices)[3], uint32_t triangles)
{
    const alp_mesh mesh = {.positions = &positions[0][0],
                           .indices = &indices[0][0],
                           .vertex_count = vertices,
                           .triangle_count = triangles,
                           .base_color = {0.5f, 0.5f, 0.5f}};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    return scene;
}

/// 12 triangles that share 8 vertices.
static alp_scene *scene_cube(alp_context *context)
{
    static const uint32_t indices[12][3] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5},
                                            {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                            {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    float corners[8][3];
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 3; k++) {
            corners[i][k] = (i >> k & 1) != 0 ? 1.0f : -1.0f;
        }
    }
    return scene_of(context, (const float(*)[3])corners, 8, indices, 12);
}

static uint32_t links(const uint32_t neighbours[3])
{
    uint32_t count = 0;
    for (int k = 0; k < 3; k++) {
        count += neighbours[k] != ALPI_NONE;
    }
    return count;
}

/// Links of all triangles of a scene of loose corners: each triangle has three vertices of its own.
static uint32_t count_links(alp_context *context, const float (*corners)[3], uint32_t triangles)
{
    uint32_t indices[16][3];
    for (uint32_t t = 0; t < triangles; t++) {
        for (uint32_t k = 0; k < 3; k++) {
            indices[t][k] = 3 * t + k;
        }
    }
    alp_scene *scene =
        scene_of(context, corners, 3 * triangles, (const uint32_t(*)[3])indices, triangles);
    uint32_t(*neighbours)[3] = NULL, sum = 0;
    ASSERT_OK(context, alpi_adjacency_create(scene, &neighbours));
    for (uint32_t t = 0; t < triangles; t++) {
        sum += links(neighbours[t]);
    }
    alpi_release(context, neighbours);
    alp_scene_destroy(scene);
    return sum;
}

TEST_WITH_CONTEXT(a_cube_is_closed, 1)
{
    alp_scene *scene = scene_cube(context);
    uint32_t(*neighbours)[3] = NULL;
    ASSERT_OK(context, alpi_adjacency_create(scene, &neighbours));
    for (uint32_t t = 0; t < 12; t++) {
        assert_int_equal(links(neighbours[t]), 3);
        for (int k = 0; k < 3; k++) {
            const uint32_t *back = neighbours[neighbours[t][k]];
            assert_true(back[0] == t || back[1] == t || back[2] == t);
        }
    }
    alpi_release(context, neighbours);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(edges_are_matched_in_order, 1)
{
    static const float p[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    static const uint32_t indices[2][3] = {{0, 1, 2}, {2, 3, 0}};
    alp_scene *scene = scene_of(context, p, 4, indices, 2);
    uint32_t(*neighbours)[3] = NULL;
    ASSERT_OK(context, alpi_adjacency_create(scene, &neighbours));
    const uint32_t expected[2][3] = {{ALPI_NONE, ALPI_NONE, 1}, {ALPI_NONE, ALPI_NONE, 0}};
    assert_memory_equal(neighbours, expected, sizeof expected);
    alpi_release(context, neighbours);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(minus_zero_is_zero, 1)
{
    static const float corners[6][3] = {{0.0f, 0.0f, 0.0f},  {1.0f, 0.0f, -0.0f},
                                        {0.0f, 1.0f, 0.0f},  {1.0f, -0.0f, 0.0f},
                                        {1.0f, 1.0f, -0.0f}, {-0.0f, 1.0f, -0.0f}};
    assert_int_equal(count_links(context, corners, 2), 2);
}

TEST_WITH_CONTEXT(three_at_an_edge_are_none, 1)
{
    static const float corners[9][3] = {{0, 0, 0},  {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0},
                                        {0, -1, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 1}};
    assert_int_equal(count_links(context, corners, 2), 2);
    assert_int_equal(count_links(context, corners, 3), 0);
}

TEST_WITH_CONTEXT(turned_round_is_no_neighbour, 1)
{
    static const float corners[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                        {0, 0, 0}, {1, 0, 0}, {0, -1, 0}};
    assert_int_equal(count_links(context, corners, 2), 0);
}

TEST_WITH_CONTEXT(half_an_edge_is_no_edge, 1)
{
    static const float corners[9][3] = {{0, 0, 0},  {2, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 0, 0},
                                        {1, -1, 0}, {2, 0, 0}, {1, 0, 0}, {1, -1, 0}};
    assert_int_equal(count_links(context, corners, 3), 2); // the lower two, with each other
}

TEST_WITH_CONTEXT(a_twisted_band_breaks_once, 1)
{
    // Five squares in a ring whose last is joined to the first upside down: one edge of the ring
    // joins triangles that wind against each other.
    enum { N = 5 };
    float p[2 * N][3];
    uint32_t indices[2 * N][3];
    for (uint32_t i = 0; i < N; i++) {
        double angle = 2.0 * ALPI_PI * i / N;
        for (uint32_t side = 0; side < 2; side++) {
            double radius = 3.0 + (side == 0 ? -1.0 : 1.0) * cos(0.5 * angle);
            p[2 * i + side][0] = (float)(radius * cos(angle));
            p[2 * i + side][1] = (float)(radius * sin(angle));
            p[2 * i + side][2] = (float)((side == 0 ? -1.0 : 1.0) * sin(0.5 * angle));
        }
        uint32_t a = 2 * i, b = a + 1, c = (2 * i + 2) % (2 * N), d = (2 * i + 3) % (2 * N);
        if (i + 1 == N) { // the half turn
            c = 1;
            d = 0;
        }
        uint32_t two[2][3] = {{a, b, d}, {a, d, c}};
        memcpy(indices[2 * i], two, sizeof two);
    }
    alp_scene *scene =
        scene_of(context, (const float(*)[3])p, 2 * N, (const uint32_t(*)[3])indices, 2 * N);
    uint32_t(*neighbours)[3] = NULL, sum = 0;
    ASSERT_OK(context, alpi_adjacency_create(scene, &neighbours));
    for (uint32_t t = 0; t < 2 * N; t++) {
        sum += links(neighbours[t]);
    }
    assert_int_equal(sum, 2 * (2 * N - 1)); // 2N inner edges in the ring, one of them broken
    alpi_release(context, neighbours);
    alp_scene_destroy(scene);
}
