// SPDX-License-Identifier: MIT
// Points spread over a scene: as many on each part as its area says, everywhere in a triangle.
#include "test_scenes.h"

#include "scene/area_points.h"

#include <math.h>

TEST_WITH_CONTEXT(points_follow_area, 1)
{
    test_mesh *mesh = test_mesh_start();
    const double u[] = {1, 0, 0}, v[] = {0, 0, -1}, v3[] = {0, 0, -3}, low[] = {0, 0, 0},
                 up[] = {0, 5, 0};
    test_mesh_quad(mesh, low, u, v);
    test_mesh_triangle(mesh, 0, 1, 1); // without area
    test_mesh_quad(mesh, up, u, v3);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    enum { COUNT = 1024 };
    alpi_area_point points[COUNT];
    assert_true(alpi_area_points(scene, COUNT, points));
    uint32_t counts[5] = {0};
    double b1 = 0.0, b2 = 0.0;
    for (int i = 0; i < COUNT; i++) {
        assert_true(points[i].triangle < 5);
        counts[points[i].triangle]++;
        assert_true(points[i].b1 >= 0.0f && points[i].b2 >= 0.0f &&
                    points[i].b1 + points[i].b2 <= 1.0f + 1e-6f);
        b1 += (double)points[i].b1 / COUNT;
        b2 += (double)points[i].b2 / COUNT;
    }
    // Areas ½ ½ 0 1½ 1½: the parts are cut at whole numbers of points.
    assert_int_equal(counts[0], 128);
    assert_int_equal(counts[1], 128);
    assert_int_equal(counts[2], 0);
    assert_int_equal(counts[3], 384);
    assert_int_equal(counts[4], 384);
    // Uniform in a triangle: means of a third, standard deviation 1/√18; 4 errors of 1024 points.
    ASSERT_NEAR(b1, 1.0 / 3.0, 4.0 / sqrt(18.0 * COUNT));
    ASSERT_NEAR(b2, 1.0 / 3.0, 4.0 / sqrt(18.0 * COUNT));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(no_area_no_points, 1)
{
    test_mesh *mesh = test_mesh_start();
    for (int i = 0; i < 3; i++) {
        test_mesh_vertex(mesh, i, 0, 0);
    }
    test_mesh_triangle(mesh, 0, 1, 2);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alpi_area_point point;
    assert_false(alpi_area_points(scene, 1, &point));
    alp_scene_destroy(scene);
}
