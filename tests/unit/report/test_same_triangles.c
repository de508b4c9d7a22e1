// SPDX-License-Identifier: MIT
// Triangles of one scene found again in another: in order, in another order with other first
// corners, and not at all.
#include "test_scenes.h"

#include "report/same_triangles.h"

#include <math.h>

/// A row of triangles of different sizes, in this order, each beginning with this corner.
static alp_scene *row(alp_context *context, const uint32_t order[4], uint32_t first, double shift)
{
    test_mesh *mesh = test_mesh_start();
    for (int i = 0; i < 4; i++) {
        const double x = 10.0 * order[i] + shift, size = 1.0 + order[i];
        uint32_t corners[3];
        corners[0] = test_mesh_vertex(mesh, x, 0.0, 0.0);
        corners[1] = test_mesh_vertex(mesh, x + size, 0.0, 0.0);
        corners[2] = test_mesh_vertex(mesh, x, size, 0.0);
        test_mesh_triangle(mesh, corners[first], corners[(first + 1) % 3],
                           corners[(first + 2) % 3]);
    }
    return test_mesh_scene(context, mesh, 0);
}

TEST_WITH_CONTEXT(order_and_first_corner_do_not_matter, 1)
{
    static const uint32_t straight[4] = {0, 1, 2, 3}, mixed[4] = {2, 0, 3, 1};
    for (uint32_t first = 0; first < 3; first++) {
        alp_scene *a = row(context, straight, 0, 0.0), *b = row(context, mixed, first, 0.0);
        alpi_same_triangles same;
        ASSERT_OK(context, alpi_same_triangles_find(a, b, &same));
        for (uint32_t t = 0; t < 4; t++) {
            assert_int_equal(mixed[same.numbers[t]], t);
            for (uint32_t k = 0; k < 3; k++) {
                const uint32_t other = b->triangles[same.numbers[t]][(k + same.turns[t]) % 3];
                assert_memory_equal(a->positions[a->triangles[t][k]], b->positions[other],
                                    sizeof *a->positions);
            }
        }
        alpi_same_triangles_release(context, &same);
        alp_scene_destroy(a);
        alp_scene_destroy(b);
    }
}

/// The scene is some 35 m wide: 35 µm are the rounding of somebody's matrix, a millimetre is not.
TEST_WITH_CONTEXT(only_rounding_is_forgiven, 1)
{
    static const uint32_t straight[4] = {0, 1, 2, 3};
    alp_scene *a = row(context, straight, 0, 0.0), *near = row(context, straight, 0, 2e-5);
    alp_scene *far = row(context, straight, 0, 1e-3);
    alpi_same_triangles same;
    ASSERT_OK(context, alpi_same_triangles_find(a, near, &same));
    assert_int_equal(same.numbers[3], 3);
    alpi_same_triangles_release(context, &same);
    assert_int_equal(alpi_same_triangles_find(a, far, &same), ALP_ERROR_INVALID_DATA);
    assert_non_null(strstr(alp_context_message(context), "has a triangle in \"test\""));
    alpi_same_triangles_release(context, &same);
    alp_scene_destroy(far);
    alp_scene_destroy(near);
    alp_scene_destroy(a);
}

/// Copies of one triangle are told apart by their order, and one that is missing is missed though
/// the numbers agree.
TEST_WITH_CONTEXT(copies_are_counted, 1)
{
    static const uint32_t twice[4] = {1, 0, 1, 2}, turned[4] = {0, 1, 2, 1},
                          other[4] = {0, 0, 1, 2};
    alp_scene *a = row(context, twice, 0, 0.0), *b = row(context, turned, 1, 0.0);
    alp_scene *c = row(context, other, 0, 0.0);
    alpi_same_triangles same;
    ASSERT_OK(context, alpi_same_triangles_find(a, b, &same));
    assert_int_equal(same.numbers[0], 1);
    assert_int_equal(same.numbers[1], 0);
    assert_int_equal(same.numbers[2], 3);
    assert_int_equal(same.numbers[3], 2);
    alpi_same_triangles_release(context, &same);
    assert_int_equal(alpi_same_triangles_find(a, c, &same), ALP_ERROR_INVALID_DATA);
    alpi_same_triangles_release(context, &same);
    alp_scene_destroy(c);
    alp_scene_destroy(b);
    alp_scene_destroy(a);
}
