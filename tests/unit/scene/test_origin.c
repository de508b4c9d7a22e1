// SPDX-License-Identifier: MIT
// Which scenes get an origin of their own, and where it lies.
#include "test_support.h"

#include "scene/origin.h"

#include <math.h>

/// A cube of this side about a centre on the diagonal of x and z.
static void choose(double centre, double side, double origin[3])
{
    alpi_world_box box = alpi_world_box_empty();
    const double half = 0.5 * side;
    alpi_world_box_add(&box, (const double[3]){centre - half, -half, centre - half});
    alpi_world_box_add(&box, (const double[3]){centre + half, half, centre + half});
    alpi_world_box_add(&box, (const double[3]){(double)NAN, 0.0, 0.0}); // left out
    alpi_world_box_add(&box, (const double[3]){0.0, 1e20, 0.0});
    alpi_origin_choose(&box, origin);
}

TEST(scenes_near_the_origin_keep_it)
{
    static const double near[][2] = {{0.0, 1.0},  {1.0, 2.0},    {50.0, 1.0},
                                     {5e3, 60.0}, {-8e3, 100.0}, {1e6, 1e6},
                                     {0.0, 0.0},  {100.0, 0.0},  {4e6, 5e6}};
    for (size_t i = 0; i < sizeof near / sizeof *near; i++) {
        double origin[3];
        choose(near[i][0], near[i][1], origin);
        assert_true(origin[0] == 0.0 && origin[1] == 0.0 && origin[2] == 0.0);
    }
    const alpi_world_box empty = alpi_world_box_empty();
    double origin[3];
    alpi_origin_choose(&empty, origin);
    assert_true(origin[0] == 0.0);
}

/// The rest is at most half a grain, which is at most twice the extent.
TEST(far_scenes_get_one)
{
    static const double far[][2] = {{4e6, 10.0},  {-4e6, 10.0}, {5e5, 1e4}, {4e6, 1e5},
                                    {200.0, 1.0}, {1.0, 1e-3},  {9e3, 1.0}, {1e5, 0.0}};
    for (size_t i = 0; i < sizeof far / sizeof *far; i++) {
        double origin[3], mantissa;
        int exponent;
        choose(far[i][0], far[i][1], origin);
        const double grain = far[i][1] > 0.0 ? exp2(ceil(log2(far[i][1]))) : 1.0;
        assert_true(origin[0] != 0.0 && origin[1] == 0.0 && origin[2] == origin[0]);
        assert_true(fabs(origin[0] - far[i][0]) <= 0.5 * grain);
        mantissa = frexp(origin[0], &exponent);
        assert_true(mantissa != 0.0 && fmod(origin[0], grain) == 0.0);
    }
}

TEST_WITH_CONTEXT(a_scene_moves_once, 1)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    double step[3], world[3];
    assert_false(alpi_origin_step(scene, NULL, step));
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        scene->positions[v][0] += 1048576.0f;
    }
    assert_true(alpi_origin_step(scene, NULL, step));
    assert_true(step[0] == 1048576.0 || step[0] == 1048577.0);
    assert_true(alp_scene_get_info(scene).origin[0] == step[0]);
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        scene->positions[v][0] -= (float)step[0];
    }
    assert_false(alpi_origin_step(scene, NULL, step));
    alpi_origin_restore(scene, (vec3){1.0f, 2.0f, 3.0f}, world);
    assert_true(world[0] == 1.0 + scene->origin[0] && world[1] == 2.0 && world[2] == 3.0);
    alp_scene_destroy(scene);
}
