// SPDX-License-Identifier: MIT
// Estimates of light without a tracer, for scenes in which nothing hides anything.
#ifndef TEST_LIGHTS_H
#define TEST_LIGHTS_H

#include "test_support.h"

#include "scene/builtin/mesh_builder.h"
#include "scene/lights/lighting.h"

/// Mean of light · cosθ / density over draws, one channel, with its standard error and the variance
/// of one draw.
typedef struct test_estimate {
    double mean, error, variance;
} test_estimate;

/// Independent draws: their standard error is what it says.
test_estimate test_light_estimate(const alpi_lighting *lighting, vec3 point, vec3 normal,
                                  uint32_t count, uint32_t seed);

/// Random (pick, u) number `i` of `seed`.
typedef struct test_draw {
    float pick;
    vec2 u;
} test_draw;
test_draw test_draw_at(uint32_t seed, uint32_t i);

/// Fails unless mean is within four standard errors of expected, and of rounding (1e-6 of it).
#define ASSERT_ESTIMATE(estimate, expected)                                                        \
    do {                                                                                           \
        const test_estimate e_ = (estimate);                                                       \
        const double x_ = (expected);                                                              \
        ASSERT_NEAR(e_.mean, x_, 4.0 * e_.error + 1e-6 * fabs(x_));                                \
    } while (0)

/// A scene of one material's triangles, each with corners of its own.
alp_scene *test_emitter_scene(alp_context *context, const vec3 (*triangles)[3], uint32_t count,
                              vec3 emission);

#endif
