// SPDX-License-Identifier: MIT
// Vectors and matrices: frames, normals under any transform, numbers far from 1.
#include "test_support.h"

#include "base/random.h"
#include "base/vec.h"

/// Number i of a fixed sequence, in [−1, 1).
static float number(uint32_t i)
{
    return 2.0f * alpi_unit_float(alpi_hash32(i + 1)) - 1.0f;
}

static vec3 direction(uint32_t i)
{
    return vec3_normalize_or((vec3){number(3 * i), number(3 * i + 1), number(3 * i + 2)},
                             (vec3){0.0f, 0.0f, 1.0f});
}

static void assert_frame(vec3 n)
{
    vec3 t, b;
    vec3_frame(n, &t, &b);
    ASSERT_NEAR(vec3_length(t), 1.0, 1e-6);
    ASSERT_NEAR(vec3_length(b), 1.0, 1e-6);
    ASSERT_NEAR(vec3_dot(t, n), 0.0, 1e-6);
    ASSERT_NEAR(vec3_dot(b, n), 0.0, 1e-6);
    ASSERT_NEAR(vec3_dot(t, b), 0.0, 1e-6);
    ASSERT_NEAR(vec3_length(vec3_sub(vec3_cross(t, b), n)), 0.0, 2e-6);
}

TEST(frames_are_orthonormal_and_right_handed)
{
    for (uint32_t i = 0; i < 2000; i++) {
        assert_frame(direction(i));
    }
    for (int axis = 0; axis < 3; axis++) {
        for (float sign = -1.0f; sign <= 1.0f; sign += 2.0f) {
            float n[3] = {0.0f, 0.0f, 0.0f};
            n[axis] = sign;
            assert_frame(vec3_load(n));
            for (float tilt = 1e-7f; tilt < 1e-2f; tilt *= 10.0f) { // close to the poles
                vec3 tilted = {n[0] + tilt, n[1] - tilt, n[2] + tilt};
                assert_frame(vec3_normalize_or(tilted, tilted));
            }
        }
    }
    assert_frame((vec3){1.0f, 0.0f, -0.0f});
}

static mat4 random_matrix(uint32_t i)
{
    mat4 m = mat4_identity();
    for (uint32_t k = 0; k < 12; k++) {
        m.m[k + k / 3] = (double)number(100000 + 16 * i + k); // the last row stays 0 0 0 1
    }
    return m;
}

TEST(normals_stay_across_and_outside)
{
    int mirrors = 0;
    for (uint32_t i = 0; i < 2000; i++) {
        mat4 m = random_matrix(i);
        double determinant = mat4_determinant3(&m);
        if (fabs(determinant) < 0.02) {
            continue; // badly conditioned: the directions of the float result say little
        }
        mirrors += determinant < 0.0;
        vec3 n = direction(i), t, b;
        vec3_frame(n, &t, &b);
        vec3 moved = mat4_transform_normal(&m, n);
        ASSERT_NEAR(vec3_length(moved), 1.0, 1e-6);
        // The inverse transpose: tangents stay tangents, and what was outside is outside.
        ASSERT_NEAR(vec3_dot(moved, mat4_transform_direction(&m, t)), 0.0, 1e-5);
        ASSERT_NEAR(vec3_dot(moved, mat4_transform_direction(&m, b)), 0.0, 1e-5);
        assert_true(vec3_dot(moved, mat4_transform_direction(&m, n)) > 0.0f);
    }
    assert_true(mirrors > 300);
}

TEST(singular_and_huge_matrices_give_finite_normals)
{
    const double scales[] = {0.0, 1e-200, 1e-30, 1e30, 1e150, 1e200, HUGE_VAL, (double)NAN};
    for (size_t s = 0; s < sizeof scales / sizeof *scales; s++) {
        for (uint32_t i = 0; i < 50; i++) {
            mat4 all = random_matrix(i), one = random_matrix(i), flat = mat4_identity();
            for (int k = 0; k < 12; k++) {
                all.m[k] *= scales[s];
            }
            one.m[0] = one.m[1] = one.m[2] = scales[s];
            flat.m[5] = scales[s]; // squeezed along y
            vec3 n = direction(i);
            assert_true(vec3_is_finite(mat4_transform_normal(&all, n)));
            assert_true(vec3_is_finite(mat4_transform_normal(&one, n)));
            assert_true(vec3_is_finite(mat4_transform_normal(&flat, n)));
        }
    }
    mat4 flat = mat4_identity();
    flat.m[5] = 0.0;
    vec3 up = mat4_transform_normal(&flat, (vec3){0.6f, 0.8f, 0.0f});
    ASSERT_NEAR(fabsf(up.y), 1.0, 1e-6); // all that is left is the plane
}

TEST(products_apply_right_to_left)
{
    for (uint32_t i = 0; i < 200; i++) {
        mat4 a = random_matrix(2 * i), b = random_matrix(2 * i + 1), ab = mat4_multiply(&a, &b);
        vec3 p = direction(i), apart = mat4_transform_point(&a, mat4_transform_point(&b, p));
        ASSERT_NEAR(vec3_length(vec3_sub(mat4_transform_point(&ab, p), apart)), 0.0, 2e-6);
        vec3 far = mat4_transform_direction(&a, mat4_transform_direction(&b, p));
        ASSERT_NEAR(vec3_length(vec3_sub(mat4_transform_direction(&ab, p), far)), 0.0, 2e-6);
        ASSERT_NEAR(mat4_determinant3(&ab), mat4_determinant3(&a) * mat4_determinant3(&b), 1e-12);
    }
}

TEST(lengths_far_from_one_are_normalised)
{
    const vec3 fallback = {0.0f, 1.0f, 0.0f};
    const float scales[] = {1e-38f, 1e-30f, 1e-10f, 1e10f, 1e30f, 1e38f};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
        vec3 n = vec3_normalize_or((vec3){2.0f * scales[i], -1.0f * scales[i], 2.0f * scales[i]},
                                   fallback);
        ASSERT_NEAR(n.x, 2.0 / 3.0, 1e-6);
        ASSERT_NEAR(n.y, -1.0 / 3.0, 1e-6);
        float s = scales[i];
        vec3 normal = vec3_triangle_normal((vec3){0.0f, 0.0f, 0.0f}, (vec3){0.0f, 0.0f, s},
                                           (vec3){s, 0.0f, 0.0f}, (vec3){1.0f, 0.0f, 0.0f});
        ASSERT_NEAR(normal.y, 1.0, 1e-6);
        double area = vec3_triangle_area((vec3){0.0f, 0.0f, 0.0f}, (vec3){0.0f, 0.0f, s},
                                         (vec3){s, 0.0f, 0.0f});
        ASSERT_NEAR(area / (0.5 * (double)s * (double)s), 1.0, 1e-12);
    }
    const float odd[] = {0.0f, INFINITY, -INFINITY, NAN};
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        vec3 n = vec3_normalize_or((vec3){0.0f, odd[i], 0.0f}, fallback);
        assert_memory_equal(&n, &fallback, sizeof n);
    }
    vec3 line = vec3_triangle_normal((vec3){0.0f, 0.0f, 0.0f}, (vec3){1.0f, 1.0f, 1.0f},
                                     (vec3){2.0f, 2.0f, 2.0f}, fallback);
    assert_memory_equal(&line, &fallback, sizeof line);
}
