// SPDX-License-Identifier: MIT
// Angles: as the C library has them, to a few units in the last place of 1.
#include "test_support.h"

#include "base/angle.h"

enum { STEPS = 20000 };
static const double ROUNDING = 1.5e-15; // a few roundings of numbers up to pi

TEST(arcs_are_those_of_the_library)
{
    for (int i = -STEPS; i <= STEPS; i++) {
        const double c = (double)i / STEPS, angle = ALPI_PI * c;
        ASSERT_NEAR(alpi_arc_cosine(c), acos(c), ROUNDING);
        const double y = sin(angle), x = cos(angle), r = 1e-30 * (1.0 + i * i);
        ASSERT_NEAR(alpi_arc_tangent(r * y, r * x), atan2(y, x), ROUNDING);
    }
    // Near 1 the cosine says little; what it does say is kept.
    for (int i = 1; i < 52; i++) {
        const double c = 1.0 - ldexp(1.0, -i);
        ASSERT_NEAR(alpi_arc_cosine(c), acos(c), ROUNDING * acos(c));
    }
}

TEST(sines_are_those_of_the_library)
{
    for (int i = -STEPS; i <= STEPS; i++) {
        const double angle = ALPI_PI * i / STEPS;
        ASSERT_NEAR(alpi_sine(angle), sin(angle), ROUNDING);
        ASSERT_NEAR(alpi_cosine(fmax(angle, -0.5 * ALPI_PI)), cos(fmax(angle, -0.5 * ALPI_PI)),
                    ROUNDING);
    }
}

TEST(ends_are_exact)
{
    assert_true(alpi_arc_cosine(1.0) == 0.0 && alpi_arc_cosine(1.5) == 0.0);
    ASSERT_NEAR(alpi_arc_cosine(-1.0), ALPI_PI, 0.0);
    ASSERT_NEAR(alpi_arc_cosine(-2.0), ALPI_PI, 0.0);
    assert_true(alpi_arc_tangent(0.0, 0.0) == 0.0 && alpi_arc_tangent(0.0, 2.0) == 0.0);
    ASSERT_NEAR(alpi_arc_tangent(0.0, -2.0), ALPI_PI, 0.0);
    ASSERT_NEAR(alpi_arc_tangent(-3.0, 0.0), -0.5 * ALPI_PI, 0.0);
    assert_true(alpi_sine(0.0) == 0.0);
    assert_true(alpi_length2(3.0, -4.0) == 5.0);
}
