// SPDX-License-Identifier: MIT
// Light of large objects and of patches of terrain.
#include "ambience_world.h"

#include <string.h>

TEST_CONTEXT(1);

enum { STEPS = 100 };

/// Radiance that is even in all directions: BRIGHT at x > 0, DARK at x < 0, their mean between.
static const float BRIGHT = 4.0f, DARK = 0.5f;

static alp_ambience *open_halves(void)
{
    alp_ambience *a = world_open(context, NULL);
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    bool more = true;
    for (int i = 0; i < 40 && more; i++) {
        alp_ambience_request request;
        ASSERT_OK(context, alp_ambience_update(a, 0.0));
        more = false;
        for (int k = 0; k < 200; k++) {
            ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
            if (request.id == 0) {
                break;
            }
            const double x = request.position[0];
            const float level = x > 0.0 ? BRIGHT : x < 0.0 ? DARK : 0.5f * (BRIGHT + DARK);
            const alp_sh9 light = {.c = {{level, level, level}}};
            ASSERT_OK(context, alp_ambience_submit(a, request.id, &light));
            more = true;
        }
    }
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    return a;
}

static double even_irradiance(float c0)
{
    return ALP_SH_A0 * ALP_SH_Y0 * (double)c0;
}

TEST(each_side_of_a_house_gets_the_light_that_it_faces)
{
    alp_ambience *a = open_halves();
    const double low[3] = {-3.5, -1.5, -2.0}, high[3] = {3.5, 1.5, 2.0};
    const double middle[2][3] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    const float sides[2][3] = {{1.0f, 0.0f, 0.0f}, {-1.0f, 0.0f, 0.0f}};
    float cube[6][3], one[2][3], e[3];
    const alp_ambience_snapshot *now = alp_ambience_begin_read(a);
    alp_ambience_object_cube(now, low, high, cube);
    alp_ambience_irradiance(now, 2, middle, sides, one);
    ASSERT_NEAR(one[0][1], one[1][1], 0.0); // one look-up: both sides the same
    ASSERT_NEAR(cube[0][1], even_irradiance(BRIGHT), 1e-4);
    ASSERT_NEAR(cube[1][1], even_irradiance(DARK), 1e-4);
    for (int i = 2; i < 6; i++) { // their middles lie between the halves
        assert_true(cube[i][1] > cube[1][1] && cube[i][1] < cube[0][1]);
    }
    alp_sh_ambient_cube_irradiance(cube[0], sides[1], e);
    ASSERT_NEAR(e[1], cube[1][1], 0.0);
    alp_ambience_end_read(a, now);
    alp_ambience_destroy(a);
}

/// Order +x −x +y −y +z −z, at the sides: light that grows along each axis.
TEST(sides_come_in_order)
{
    alp_ambience *a = world_open(context, NULL);
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    const double low[3] = {-2.0, -3.0, -4.0}, high[3] = {1.0, 2.0, 3.5};
    float cube[6][3];
    world_warm(a, &camera, -1e9);
    const alp_ambience_snapshot *now = alp_ambience_begin_read(a);
    alp_ambience_object_cube(now, low, high, cube);
    for (int i = 0; i < 6; i++) {
        double place[1][3];
        float normal[1][3] = {{0.0f, 0.0f, 0.0f}}, e[1][3];
        for (int k = 0; k < 3; k++) {
            place[0][k] = 0.5 * (low[k] + high[k]);
        }
        place[0][i / 2] = i % 2 == 0 ? high[i / 2] : low[i / 2];
        normal[0][i / 2] = i % 2 == 0 ? 1.0f : -1.0f;
        alp_ambience_irradiance(now, 1, (const double(*)[3])place, (const float(*)[3])normal, e);
        ASSERT_NEAR(cube[i][0], e[0][0], 0.0);
        assert_true(e[0][0] > 0.0f);
    }
    alp_ambience_end_read(a, now);
    alp_ambience_destroy(a);
}

static double ground_at(double x, double z)
{
    return 0.7 * sin(0.4 * x) + 0.3 * cos(0.9 * z);
}

/// A patch of 3 × 3 m of a curved ground, from (x, z). Normals depend on the corner alone.
static void make_patch(const alp_ambience_snapshot *now, double x, double z, float e[4][3])
{
    double corners[4][3];
    float normals[4][3];
    for (int i = 0; i < 4; i++) {
        double *c = corners[i];
        c[0] = x + 3.0 * (i % 2);
        c[2] = z + 3.0 * (i / 2);
        c[1] = ground_at(c[0], c[2]);
        const double slope = 0.28 * cos(0.4 * c[0]), across = -0.27 * sin(0.9 * c[2]);
        const double length = sqrt(1.0 + slope * slope + across * across);
        normals[i][0] = (float)(-slope / length);
        normals[i][1] = (float)(1.0 / length);
        normals[i][2] = (float)(-across / length);
    }
    alp_ambience_patch(now, (const double(*)[3])corners, (const float(*)[3])normals, e);
}

TEST(patches_agree_on_a_border_bit_for_bit)
{
    alp_ambience *a = world_open(context, NULL);
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    float patches[3][4][3];
    world_warm(a, &camera, -1e9);
    const alp_ambience_snapshot *now = alp_ambience_begin_read(a);
    make_patch(now, -1.7, 0.6, patches[0]);
    make_patch(now, 1.3, 0.6, patches[1]);  // beside it along x
    make_patch(now, -1.7, 3.6, patches[2]); // beside it along z
    for (int i = 0; i <= STEPS; i++) {
        const float t = (float)i / (float)STEPS;
        float here[3], there[3];
        alp_ambience_patch_irradiance((const float(*)[3])patches[0], 1.0f, t, here);
        alp_ambience_patch_irradiance((const float(*)[3])patches[1], 0.0f, t, there);
        assert_memory_equal(here, there, sizeof here);
        alp_ambience_patch_irradiance((const float(*)[3])patches[0], t, 1.0f, here);
        alp_ambience_patch_irradiance((const float(*)[3])patches[2], t, 0.0f, there);
        assert_memory_equal(here, there, sizeof here);
        assert_true(here[0] > 0.0f);
    }
    alp_ambience_end_read(a, now);
    alp_ambience_destroy(a);
}

/// The same of corners that differ by any factor, so that differences are not exact.
TEST(patches_agree_on_a_border_of_any_light)
{
    uint64_t state = 40;
    for (int i = 0; i < 10000; i++) {
        float left[4][3], right[4][3], below[4][3], here[3], there[3];
        const float t = (float)world_random(&state);
        for (int k = 0; k < 12; k++) {
            left[k / 3][k % 3] = (float)exp(20.0 * world_random(&state) - 10.0);
            right[k / 3][k % 3] = (float)exp(20.0 * world_random(&state) - 10.0);
            below[k / 3][k % 3] = (float)exp(20.0 * world_random(&state) - 10.0);
        }
        memcpy(right[0], left[1], sizeof right[0]);
        memcpy(right[2], left[3], sizeof right[2]);
        memcpy(below[0], left[2], 2 * sizeof below[0]);
        alp_ambience_patch_irradiance((const float(*)[3])left, 1.0f, t, here);
        alp_ambience_patch_irradiance((const float(*)[3])right, 0.0f, t, there);
        assert_memory_equal(here, there, sizeof here);
        alp_ambience_patch_irradiance((const float(*)[3])left, t, 1.0f, here);
        alp_ambience_patch_irradiance((const float(*)[3])below, t, 0.0f, there);
        assert_memory_equal(here, there, sizeof here);
    }
}

TEST(a_patch_is_bilinear)
{
    static const float corners[4][3] = {
        {1.0f, 0.0f, 5.0f}, {2.0f, 0.0f, 5.0f}, {4.0f, 1.0f, 5.0f}, {8.0f, 1.0f, 5.0f}};
    float e[3];
    for (int i = 0; i < 4; i++) {
        alp_ambience_patch_irradiance(corners, (float)(i % 2), (float)(i / 2), e);
        assert_memory_equal(e, corners[i], sizeof e);
    }
    alp_ambience_patch_irradiance(corners, 0.25f, 0.5f, e);
    ASSERT_NEAR(e[0], 0.5 * (0.75 * 1.0 + 0.25 * 2.0) + 0.5 * (0.75 * 4.0 + 0.25 * 8.0), 1e-6);
    ASSERT_NEAR(e[1], 0.5, 1e-6);
    alp_ambience_patch_irradiance(corners, NAN, 2.0f, e); // held to 0 and 1
    assert_memory_equal(e, corners[2], sizeof e);
}

TEST(what_is_not_finite_is_black)
{
    alp_ambience *a = world_open(context, NULL);
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    const double low[3] = {-1.0, (double)NAN, -1.0}, high[3] = {1.0, 1.0, 1.0}, far = HUGE_VAL;
    const double corners[4][3] = {
        {(double)NAN, 0.0, 0.0}, {1.0, far, 0.0}, {0.0, 0.0, 1.0}, {1.0, 0.0, 1.0}};
    const float normals[4][3] = {
        {0.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, NAN, 0.0f}, {0.0f, 1.0f, 0.0f}};
    float cube[6][3], e[4][3];
    world_warm(a, &camera, -1e9);
    const alp_ambience_snapshot *now = alp_ambience_begin_read(a);
    alp_ambience_object_cube(now, low, high, cube);
    alp_ambience_patch(now, corners, normals, e);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 6; i++) {
            ASSERT_NEAR(cube[i][k] > 0.0f, i == 2, 0.0); // the top alone is somewhere
        }
        for (int i = 0; i < 4; i++) {
            ASSERT_NEAR(e[i][k] > 0.0f, i == 3, 0.0);
        }
    }
    alp_ambience_object_cube(NULL, low, high, cube);
    alp_ambience_patch(NULL, corners, normals, e);
    ASSERT_NEAR(cube[2][0], 0.0, 0.0);
    ASSERT_NEAR(e[3][0], 0.0, 0.0);
    alp_ambience_end_read(a, now);
    alp_ambience_destroy(a);
}
