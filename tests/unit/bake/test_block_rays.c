// SPDX-License-Identifier: MIT
// How many rays blocks gather by, told by what a trial found.
#include "test_support.h"

#include "bake/light/light.h"

/// A Cornell box, and a sphere on a plane under an even sky, both at 256².
static const alpi_trial_light BOX = {.blocks = 5205, .mean = 0.47, .rms = 0.63};
static const alpi_trial_light SPHERE = {.blocks = 2162, .mean = 0.077, .rms = 0.137};

/// Measured: half or twice as many take as long to a percent or two, four times as many longer.
static void rays_take_least_time(void **state)
{
    (void)state;
    assert_int_equal(alpi_light_least_block_rays(0.048, 47290, &BOX), 16);
    assert_int_equal(alpi_light_least_block_rays(0.01, 47290, &BOX), 64);
    assert_int_equal(alpi_light_least_block_rays(0.0055, 28684, &SPHERE), 64);
}

static void rays_are_fewer_where_less_bounces(void **state)
{
    (void)state;
    alpi_trial_light light = BOX;
    uint32_t before = 2048;
    for (int k = 0; k <= 20; k++) {
        const double share = 1.0 - 0.05 * k;
        light.mean = share * BOX.mean;
        light.rms = share * BOX.rms;
        const uint32_t rays = alpi_light_least_block_rays(0.002, 47290, &light);
        assert_true(rays <= before && rays >= 16 && (rays & (rays - 1)) == 0);
        before = rays;
    }
    assert_int_equal(before, 16); // where nothing bounces
}

static void rays_are_more_for_less_error(void **state)
{
    (void)state;
    static const uint32_t blocks[] = {2162, 5205, 100000};
    for (int k = 0; k < 6; k++) {
        alpi_trial_light light = k % 2 == 0 ? BOX : SPHERE;
        light.blocks = blocks[k / 2];
        uint32_t before = 16;
        for (double error = 0.1; error > 1e-6; error *= 0.7) {
            const uint32_t rays = alpi_light_least_block_rays(error, 6 * light.blocks, &light);
            assert_true(rays >= before && rays <= 1024);
            before = rays;
        }
        assert_int_equal(before, 1024);
    }
}

/// Few blocks together must send enough for the mean of the map, which no texel's rays make better.
static void few_blocks_send_more(void **state)
{
    (void)state;
    alpi_trial_light light = BOX;
    light.blocks = 100;
    const uint32_t rays = alpi_light_least_block_rays(0.02, 100, &light);
    assert_true(rays * 1.4143 >= (6.0 / 0.02) * (6.0 / 0.02) * 0.47 / 100.0);
    assert_true(rays < 1024);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_take_least_time),
        cmocka_unit_test(rays_are_fewer_where_less_bounces),
        cmocka_unit_test(rays_are_more_for_less_error),
        cmocka_unit_test(few_blocks_send_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
