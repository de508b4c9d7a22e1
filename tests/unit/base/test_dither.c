// SPDX-License-Identifier: MIT
// Rounding with noise: means are kept, ends stay, and a ramp has no steps.
#include "test_support.h"

#include "base/dither.h"

#include <math.h>

enum { SIDE = 256, COUNT = SIDE * SIDE };

static uint8_t dithered(float value, uint32_t index)
{
    return alpi_dither_byte(value, alpi_random_key(1, index, 0));
}

TEST(means_are_kept)
{
    static const float values[] = {0.0f, 0.01f, 0.3f, 0.5f, 1.0f, 3.3f, 10.5f, 100.75f, 254.6f};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        double sum = 0.0, squares = 0.0;
        for (uint32_t k = 0; k < COUNT; k++) {
            const double off = (double)dithered(values[i], k) - (double)values[i];
            assert_true(fabs(off) < 1.5);
            sum += off / COUNT;
            squares += off * off / COUNT;
        }
        // Triangular noise and rounding have a variance of 1/4 together: four standard errors.
        ASSERT_NEAR(sum, 0.0, 4.0 * 0.5 / sqrt(COUNT));
        const bool inside = values[i] >= 0.5f && values[i] <= 254.5f;
        ASSERT_NEAR(squares, inside ? 0.25 : squares, 0.01);
    }
}

TEST(ends_stay)
{
    for (uint32_t k = 0; k < COUNT; k++) {
        assert_int_equal(dithered(0.0f, k), 0);
        assert_int_equal(dithered(255.0f, k), 255);
        assert_true(dithered(254.99f, k) >= 254);
    }
}

/// A ramp of four codes across a map: its columns' means rise evenly, where rounding alone has
/// steps of 64 columns.
TEST(a_ramp_has_no_steps)
{
    const double noise = 0.5 / sqrt(8.0 * SIDE); // of the mean of eight columns
    for (uint32_t x = 0; x < SIDE; x += 8) {
        double sum = 0.0, exact = 0.0;
        for (uint32_t k = 0; k < 8 * SIDE; k++) {
            const uint32_t column = x + k % 8;
            const float value = 2.0f + 4.0f * (float)column / SIDE;
            sum += (double)dithered(value, k / 8 * SIDE + column) / (8.0 * SIDE);
            exact += (double)value / (8.0 * SIDE);
        }
        ASSERT_NEAR(sum, exact, 5.0 * noise); // of 32 means: five standard errors
    }
}
