// SPDX-License-Identifier: MIT
// Half floats: all of them come back, and every float goes to the nearest.
#include "test_support.h"

#include "base/half.h"

TEST(every_half_comes_back)
{
    for (uint32_t bits = 0; bits < 0x10000u; bits++) {
        const float value = alpi_half_to_float((uint16_t)bits);
        const uint16_t again = alpi_half_from_float(value);
        if (isnan(value)) {
            assert_true((again & 0x7c00u) == 0x7c00u && (again & 0x3ffu) != 0);
        } else {
            assert_int_equal(again, bits);
        }
    }
}

TEST(known_values)
{
    // of IEEE 754-2019: 1, the largest, the least normal and subnormal ones, −2, a third
    assert_true(alpi_half_to_float(0x3c00) == 1.0f);
    assert_true(alpi_half_to_float(0x7bff) == ALPI_HALF_MAX);
    assert_true(alpi_half_to_float(0x0400) == 0x1p-14f);
    assert_true(alpi_half_to_float(0x0001) == 0x1p-24f);
    assert_true(alpi_half_to_float(0xc000) == -2.0f);
    assert_int_equal(alpi_half_from_float(1.0f / 3.0f), 0x3555);
}

/// Between neighbours the nearer one; in the middle the even one.
TEST(floats_go_to_the_nearest)
{
    for (uint16_t low = 0; low < 0x7c00u; low++) {
        const uint16_t high = low + 1;
        const float a = alpi_half_to_float(low);
        const float b = high == 0x7c00u ? 65536.0f : alpi_half_to_float(high);
        const float middle = a + (b - a) / 2.0f; // exact: one bit more than a half has
        assert_int_equal(alpi_half_from_float(middle), low % 2 == 0 ? low : high);
        assert_int_equal(alpi_half_from_float(-middle), (low % 2 == 0 ? low : high) | 0x8000u);
        assert_int_equal(alpi_half_from_float(nextafterf(middle, 0.0f)), low);
        assert_int_equal(alpi_half_from_float(nextafterf(middle, INFINITY)), high);
    }
    assert_int_equal(alpi_half_from_float(3e38f), 0x7c00);
    assert_int_equal(alpi_half_from_float(-INFINITY), 0xfc00);
    assert_int_equal(alpi_half_from_float(1e-30f), 0);
}
