// SPDX-License-Identifier: MIT
// The hierarchy of lights: probabilities that sum to 1, agree with what is drawn, and follow power
// and distance.
#include "test_support.h"

#include "base/random.h"
#include "scene/lights/light_tree.h"

#include <math.h>
#include <stdlib.h>

static float random_float(uint32_t *key)
{
    return alpi_unit_float(alpi_hash32(++*key));
}

/// Small lights in a box of 10 m, of all powers and directions, some two-sided.
static alpi_light_bound *make_bounds(uint32_t count)
{
    alpi_light_bound *bounds = calloc(count, sizeof *bounds);
    assert_non_null(bounds);
    uint32_t key = 0;
    for (uint32_t i = 0; i < count; i++) {
        alpi_light_bound *b = &bounds[i];
        b->low = (vec3){10 * random_float(&key), 10 * random_float(&key), 10 * random_float(&key)};
        b->high = vec3_add(b->low, (vec3){0.1f * random_float(&key), 0.1f, 0.0f});
        vec3 axis = {random_float(&key) - 0.5f, random_float(&key) - 0.5f, 0.2f};
        b->axis = vec3_normalize_or(axis, (vec3){0, 0, 1});
        b->cone = random_float(&key) < 0.3f ? random_float(&key) : 0.0f;
        b->reach = (float)(ALPI_PI / 2.0);
        b->two_sided = i % 5 == 0;
        b->power = exp(6.0 * (double)random_float(&key));
    }
    return bounds;
}

TEST_WITH_CONTEXT(probabilities_sum_to_one_and_are_those_drawn, 1)
{
    enum { COUNT = 1000, DRAWS = 20000 };
    alpi_light_bound *bounds = make_bounds(COUNT);
    alpi_light_tree *tree;
    ASSERT_OK(context, alpi_light_tree_create(context, bounds, COUNT, &tree));
    const vec3 points[] = {{5, 5, 20}, {5, 5, 5}, {-3, 4, 6}};
    const vec3 normals[] = {{0, 0, -1}, {0, 1, 0}, {0.6f, 0, 0.8f}};
    for (int p = 0; p < 3; p++) {
        double drawn_only = 0.0, sum = 0.0;
        for (uint32_t i = 0; i < COUNT; i++) {
            sum += alpi_light_tree_probability(tree, points[p], normals[p], i);
        }
        for (uint32_t i = 0; i < DRAWS; i++) {
            uint32_t light;
            double probability =
                alpi_light_tree_sample(tree, points[p], normals[p], (i + 0.5) / DRAWS, &light);
            if (probability > 0.0) {
                drawn_only += 1.0 / DRAWS;
                ASSERT_NEAR(alpi_light_tree_probability(tree, points[p], normals[p], light) /
                                probability,
                            1.0, 1e-12); // the same factors in the other order
            }
        }
        // What leads nowhere is drawn too: even draws count it to 1 light each at the ends.
        ASSERT_NEAR(sum, drawn_only, 2e-3);
        assert_true(sum > 0.5);
    }
    alpi_light_tree_destroy(context, tree);
    free(bounds);
}

/// No light that shines on the point may have the probability 0: a small patch anywhere in its box,
/// facing anywhere in its cone.
TEST_WITH_CONTEXT(none_that_shines_is_left_out, 1)
{
    enum { COUNT = 300 };
    alpi_light_bound *bounds = make_bounds(COUNT);
    alpi_light_tree *tree;
    ASSERT_OK(context, alpi_light_tree_create(context, bounds, COUNT, &tree));
    uint32_t key = 77;
    for (int p = 0; p < 200; p++) {
        vec3 point = {14 * random_float(&key) - 2, 14 * random_float(&key) - 2,
                      14 * random_float(&key) - 2};
        vec3 normal = vec3_normalize_or(
            (vec3){random_float(&key) - 0.5f, random_float(&key) - 0.5f, random_float(&key) - 0.5f},
            (vec3){0, 1, 0});
        for (uint32_t i = 0; i < COUNT; i++) {
            const alpi_light_bound *b = &bounds[i];
            vec3 to =
                vec3_sub(vec3_mad(b->low, random_float(&key), vec3_sub(b->high, b->low)), point);
            float there = -vec3_dot(to, b->axis);
            bool shines = (b->two_sided ? fabsf(there) : there) > 0.0f;
            if (shines && vec3_dot(to, normal) > 0.0f) {
                assert_true(alpi_light_tree_probability(tree, point, normal, i) > 0.0);
            }
        }
        assert_true(isfinite(alpi_light_tree_importance(tree, point, normal)));
    }
    alpi_light_tree_destroy(context, tree);
    free(bounds);
}

static alpi_light_bound point_light(vec3 position, double power)
{
    return (alpi_light_bound){.low = position,
                              .high = position,
                              .axis = {0, 1, 0},
                              .cone = (float)ALPI_PI,
                              .reach = (float)(ALPI_PI / 2.0),
                              .power = power};
}

TEST_WITH_CONTEXT(two_points_by_power_and_distance, 1)
{
    const alpi_light_bound bounds[2] = {point_light((vec3){0, 1, 0}, 3.0),
                                        point_light((vec3){0, 2, 0}, 5.0)};
    alpi_light_tree *tree;
    ASSERT_OK(context, alpi_light_tree_create(context, bounds, 2, &tree));
    const vec3 origin = {0, 0, 0};
    // 3/1 against 5/4.
    ASSERT_NEAR(alpi_light_tree_probability(tree, origin, (vec3){0, 1, 0}, 0), 3.0 / 4.25, 1e-9);
    ASSERT_NEAR(alpi_light_tree_importance(tree, origin, (vec3){0, -1, 0}), 0.0, 0.0);
    // The very place of a light, and 1e15 m away: numbers still.
    assert_true(isfinite(alpi_light_tree_importance(tree, bounds[0].low, (vec3){0, 1, 0})));
    ASSERT_NEAR(alpi_light_tree_probability(tree, (vec3){0, -1e15f, 0}, (vec3){0, 1, 0}, 0),
                3.0 / 8.0, 1e-6);
    alpi_light_tree_destroy(context, tree);
}

/// All in one place, or each ten times as far as the one before: neither may break the build.
TEST_WITH_CONTEXT(odd_sets_are_built, 1)
{
    enum { COUNT = 2000 };
    static alpi_light_bound bounds[COUNT];
    for (int kind = 0; kind < 2; kind++) {
        for (int i = 0; i < COUNT; i++) {
            float place = kind == 0 ? 1.0f : powf(10.0f, (float)(i % 50) - 35.0f);
            bounds[i] = point_light((vec3){place, 0, 0}, 1.0);
        }
        alpi_light_tree *tree;
        ASSERT_OK(context, alpi_light_tree_create(context, bounds, COUNT, &tree));
        double sum = 0.0;
        for (uint32_t i = 0; i < COUNT; i++) {
            sum += alpi_light_tree_probability(tree, (vec3){0, -1, 0}, (vec3){0, 1, 0}, i);
        }
        ASSERT_NEAR(sum, kind == 0 ? 1.0 : sum, 1e-9);
        assert_true(sum > 0.99);
        alpi_light_tree_destroy(context, tree);
    }
}

TEST(memory_may_run_out)
{
    alpi_light_bound *bounds = make_bounds(100);
    for (int allocations = 0; allocations < 5; allocations++) {
        int left = 1000;
        alp_context *context = test_context_failing(&left);
        alpi_light_tree *tree;
        left = allocations;
        assert_int_equal(alpi_light_tree_create(context, bounds, 100, &tree),
                         ALP_ERROR_OUT_OF_MEMORY);
        assert_null(tree);
        left = 1000;
        alp_context_destroy(context);
    }
    free(bounds);
}
