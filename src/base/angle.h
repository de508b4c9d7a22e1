// SPDX-License-Identifier: MIT
// Angles from sums, products, quotients and square roots alone, which IEEE 754 rounds alike
// everywhere: what is decided by them is the same on every machine. C libraries round their own
// functions as they like, and not alike on all processors.
#ifndef ALPI_BASE_ANGLE_H
#define ALPI_BASE_ANGLE_H

#include "base/vec.h"

/// Length of (x, y), for values whose squares are in range, as those of 32-bit floats are.
static inline double alpi_length2(double x, double y)
{
    return sqrt(x * x + y * y);
}

/// Arc tangent of t ∈ [0, 1] to 1e-15: halved twice by atan t = 2 atan(t / (1 + √(1 + t²))), then
/// the series t − t³/3 + t⁵/5 − …, whose first term left out is less than 1e-17.
static inline double alpi_arc_tangent_unit(double t)
{
    t /= 1.0 + sqrt(1.0 + t * t);
    t /= 1.0 + sqrt(1.0 + t * t); // tan(π / 16) at most
    double sum = 0.0;
    for (int n = 21; n > 0; n -= 2) {
        sum = 1.0 / n - t * t * sum;
    }
    return 4.0 * t * sum;
}

/// The angle of (x, y) from the x axis, in [−π, π], to 1e-15; 0 for (0, 0).
static inline double alpi_arc_tangent(double y, double x)
{
    const double ax = fabs(x), ay = fabs(y);
    if (!(ax + ay > 0.0)) {
        return 0.0;
    }
    double angle =
        ay <= ax ? alpi_arc_tangent_unit(ay / ax) : 0.5 * ALPI_PI - alpi_arc_tangent_unit(ax / ay);
    angle = x < 0.0 ? ALPI_PI - angle : angle;
    return y < 0.0 ? -angle : angle;
}

/// The angle in [0, π] whose cosine is c, to 1e-15; c beyond [−1, 1] counts as the end.
static inline double alpi_arc_cosine(double c)
{
    c = fmin(fmax(c, -1.0), 1.0);
    return 2.0 * alpi_arc_tangent(sqrt(1.0 - c), sqrt(1.0 + c));
}

/// Sine of an angle in [−π, π], to 1e-15, by its series about 0 up to π/2.
static inline double alpi_sine(double angle)
{
    const double a = fabs(angle), x = a > 0.5 * ALPI_PI ? ALPI_PI - a : a;
    double sum = 1.0;
    for (int n = 22; n > 0; n -= 2) {
        sum = 1.0 - sum * x * x / (n * (n + 1));
    }
    return angle < 0.0 ? -x * sum : x * sum;
}

/// Cosine of an angle in [−π/2, π], to 1e-15.
static inline double alpi_cosine(double angle)
{
    return alpi_sine(0.5 * ALPI_PI - angle);
}

#endif
