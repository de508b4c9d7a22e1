// SPDX-License-Identifier: MIT
// A scene with its light, and direct light at points and patches of it.
#ifndef TEST_DIRECT_STAGE_H
#define TEST_DIRECT_STAGE_H

#include "test_support.h"

#include "scene/builtin/mesh_builder.h"
#include "transport/direct/direct.h"

typedef struct test_stage {
    alp_context *context;
    alp_scene *scene; // destroyed with the stage
    alpi_tracer *tracer;
    alpi_lighting *lighting;
} test_stage;

/// @param lights [count] copied to the end of the scene's own   @param options NULL = defaults
test_stage test_stage_open(alp_context *context, alp_scene *scene, const alpi_light *lights,
                           uint32_t count, const alp_lighting_options *options);
void test_stage_close(test_stage *stage);

alpi_direct_options test_stage_options(const test_stage *stage, uint32_t samples);
alpi_reference test_stage_reference(const test_stage *stage, uint32_t samples); // 0 bounces

/// A parallelogram that receives light, or a point where u and v are 0.
typedef struct test_patch {
    vec3 corner, u, v, normal;
} test_patch;
/// The patches must outlive them.
typedef struct test_patches {
    uint32_t count;
    const test_patch *patches;
    float offset; // metres
} test_patches;
alpi_receivers test_patches_receivers(const test_patches *patches);

/// Direct light at patches, with a seed. @param values [patches] out  @return rays
uint64_t test_stage_gather(const test_stage *stage, const test_patches *patches, uint32_t samples,
                           uint64_t seed, alpi_reference_value *values);
/// The same at one patch, as one of many that are alike: one alone would not know its variance.
/// @param rays out, or NULL: of one of them
alpi_reference_value test_stage_direct(const test_stage *stage, const test_patch *patch,
                                       uint32_t samples, uint64_t seed, uint64_t *rays);
/// A point with a normal.
test_patch test_point(vec3 position, vec3 normal);

/// Lamp of (1, .5, .25) × candela.
alpi_light test_lamp(vec3 position, float candela);

/// Fails unless channel 0 is within six standard errors of expected, and of single precision. Error
/// over standard error of eight replicates is Student's t of 7 degrees of freedom: six are passed
/// once in 1,900 times.
#define ASSERT_LIGHT(value, expected)                                                              \
    do {                                                                                           \
        const alpi_reference_value v_ = (value);                                                   \
        const double x_ = (expected);                                                              \
        ASSERT_NEAR(v_.mean[0], x_, 6.0 * sqrt((double)v_.variance[0]) + 2e-6 * fabs(x_));         \
    } while (0)

#endif
