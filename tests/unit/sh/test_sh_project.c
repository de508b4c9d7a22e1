// SPDX-License-Identifier: MIT
// Projection of cube maps: weights, errors by size, rows in any order, every instruction set.
#include "sh_directions.h"
#include "test_support.h"

#include "base/context.h"
#include "sh/basis.h"
#include "sh/cube_map.h"
#include "sh/sh_project.h"

#include <stdlib.h>

typedef vec3 environment_fn(vec3 direction);

/// A cube map [6][size][size][3], which the caller frees.
static float *make_cube(uint32_t size, environment_fn *environment)
{
    float *pixels = malloc(sizeof(float) * 18 * size * size), *at = pixels;
    assert_non_null(pixels);
    for (int face = 0; face < 6; face++) {
        for (uint32_t y = 0; y < size; y++) {
            for (uint32_t x = 0; x < size; x++, at += 3) {
                vec3_store(at,
                           environment(alpi_cube_texel_direction((alp_cube_face)face, size, x, y)));
            }
        }
    }
    return pixels;
}

static alp_sh9 project(alp_context *context, uint32_t size, const float *pixels)
{
    alp_sh_projection *projection;
    alp_sh9 radiance;
    const float *faces[6];
    for (size_t f = 0; f < 6; f++) {
        faces[f] = pixels + f * 3 * size * size;
    }
    ASSERT_OK(context, alp_sh_projection_create(context, size, &projection));
    ASSERT_OK(context, alp_sh_project_cube(projection, faces, &radiance));
    alp_sh_projection_destroy(projection);
    return radiance;
}

/// Largest coefficient.
static double magnitude(const alp_sh9 *c)
{
    double largest = 0.0;
    for (int i = 0; i < 27; i++) {
        largest = fmax(largest, fabs((double)c->c[i / 3][i % 3]));
    }
    return largest;
}

static double difference(const alp_sh9 *a, const alp_sh9 *b)
{
    double largest = 0.0;
    for (int i = 0; i < 27; i++) {
        largest = fmax(largest, fabs((double)a->c[i / 3][i % 3] - (double)b->c[i / 3][i % 3]));
    }
    return largest;
}

/// Sum over texels of pixel × Y at the centre × exact solid angle, all in double.
static alp_sh9 naive(uint32_t size, const float *pixels)
{
    double c[9][3] = {{0.0}};
    alp_sh9 radiance;
    for (int face = 0; face < 6; face++) {
        for (uint32_t y = 0; y < size; y++) {
            for (uint32_t x = 0; x < size; x++, pixels += 3) {
                const vec3 d = alpi_cube_texel_direction((alp_cube_face)face, size, x, y);
                double basis[9];
                alpi_sh_basis(2, (const double[3]){(double)d.x, (double)d.y, (double)d.z}, basis);
                for (int i = 0; i < 27; i++) {
                    c[i / 3][i % 3] += basis[i / 3] * (double)pixels[i % 3] *
                                       alpi_cube_texel_solid_angle(size, x, y);
                }
            }
        }
    }
    for (int i = 0; i < 27; i++) {
        radiance.c[i / 3][i % 3] = (float)c[i / 3][i % 3];
    }
    return radiance;
}

static vec3 constant(vec3 direction)
{
    (void)direction;
    return (vec3){1.0f, 2.0f, 0.25f};
}

TEST(solid_angles_sum_to_4_pi)
{
    for (uint32_t size = 1; size <= 64; size++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < size * size; i++) {
            sum += alpi_cube_texel_solid_angle(size, i % size, i / size);
        }
        ASSERT_NEAR(6.0 * sum, 4.0 * ALPI_PI, 1e-12);
    }
    ASSERT_NEAR(alpi_cube_texel_solid_angle(1, 0, 0), 4.0 * ALPI_PI / 6.0, 1e-14);
}

TEST(solid_angles_near_their_approximation)
{
    // 4/n² (1 + s² + t²)^−1.5 gains .096 % at 16 and .38 % at 8: it is close, and not exact.
    static const double gain[2] = {0.00096, 0.0038};
    for (uint32_t k = 0; k < 2; k++) {
        const uint32_t size = 16 >> k;
        double sum = 0.0;
        for (uint32_t i = 0; i < size * size; i++) {
            const double s = 2.0 * (i % size + 0.5) / size - 1.0;
            const double t = 2.0 * (i / size + 0.5) / size - 1.0;
            sum += 4.0 / (size * size) * pow(1.0 + s * s + t * t, -1.5);
        }
        ASSERT_NEAR(6.0 * sum / (4.0 * ALPI_PI) - 1.0, gain[k], 0.00005);
    }
}

TEST(faces_are_those_of_graphics_interfaces)
{
    // Corners of row 0: the first and the last column.
    static const float first[6][3] = {{1, 1, 1},   {-1, 1, -1}, {-1, 1, -1},
                                      {-1, -1, 1}, {-1, 1, 1},  {1, 1, -1}};
    static const float last[6][3] = {{1, 1, -1}, {-1, 1, 1}, {1, 1, -1},
                                     {1, -1, 1}, {1, 1, 1},  {-1, 1, -1}};
    const double root3 = sqrt(3.0);
    for (int f = 0; f < 6; f++) {
        const vec3 a = alpi_cube_direction((alp_cube_face)f, -1.0, -1.0);
        const vec3 b = alpi_cube_direction((alp_cube_face)f, 1.0, -1.0);
        const float got[6] = {a.x, a.y, a.z, b.x, b.y, b.z};
        for (int i = 0; i < 6; i++) {
            ASSERT_NEAR((double)got[i] * root3, i < 3 ? first[f][i] : last[f][i - 3], 1e-6);
        }
    }
}

TEST_WITH_CONTEXT(constant_environment_is_its_first_coefficient, 1)
{
    // oracle 1: c₀ = 2√π L, the others 0
    static const uint32_t sizes[] = {1, 2, 3, 4, 5, 7, 15, 16, 17, 33, 64};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        float *pixels = make_cube(sizes[s], constant);
        const alp_sh9 c = project(context, sizes[s], pixels);
        for (int i = 0; i < 9; i++) {
            const float radiance[3] = {1.0f, 2.0f, 0.25f};
            for (int k = 0; k < 3; k++) {
                ASSERT_NEAR(c.c[i][k], i == 0 ? 2.0 * sqrt(ALPI_PI) * (double)radiance[k] : 0.0,
                            2e-6);
            }
        }
        float e[3];
        alp_sh_irradiance(&c, (const float[3]){0.6f, -0.8f, 0.0f}, ALP_SH_LINEAR, e);
        ASSERT_NEAR(e[1], 2.0 * ALPI_PI, 1e-5);
        free(pixels);
    }
}

TEST_WITH_CONTEXT(furnace_has_one_coefficient, 1)
{
    // oracle 14: a closed room of albedo ρ that emits M shows B / π everywhere, B = M / (1 − ρ)
    const float albedo[3] = {0.5f, 0.8f, 0.0f}, emitted = 1.5f;
    enum { SIZE = 16 };
    static float pixels[6 * SIZE * SIZE][3];
    for (int i = 0; i < 6 * SIZE * SIZE; i++) {
        for (int k = 0; k < 3; k++) {
            pixels[i][k] = emitted / (1.0f - albedo[k]) / (float)ALPI_PI;
        }
    }
    const alp_sh9 c = project(context, SIZE, &pixels[0][0]);
    for (int k = 0; k < 3; k++) {
        const double b = (double)emitted / (1.0 - (double)albedo[k]);
        ASSERT_NEAR(c.c[0][k], 2.0 * sqrt(ALPI_PI) * b / ALPI_PI, 3e-6 * b);
        for (int i = 1; i < 9; i++) {
            ASSERT_NEAR(c.c[i][k], 0.0, 1e-6 * b);
        }
    }
}

TEST_WITH_CONTEXT(projection_is_the_naive_sum, 1)
{
    static const uint32_t sizes[] = {3, 8, 16, 31, 48};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        const uint32_t size = sizes[s];
        float *pixels = make_cube(size, test_environment);
        const alp_sh9 ours = project(context, size, pixels), theirs = naive(size, pixels);
        // Centres stand for texels in the naive sum: an error of the order of 1/n².
        const double error = difference(&ours, &theirs);
        assert_true(error < 2.0 / (size * size));
        free(pixels);
    }
}

TEST_WITH_CONTEXT(a_small_cube_map_is_enough, 1)
{
    // 16² within .1 % of 256²
    float *large = make_cube(256, test_environment), *small = make_cube(16, test_environment);
    const alp_sh9 exact = project(context, 256, large), ours = project(context, 16, small);
    assert_true(difference(&exact, &ours) < 0.001 * magnitude(&exact));
    free(large);
    free(small);
}

/// Largest departure of Σ Y_i Y_j dω from the unit matrix for weights and functions of texels.
/// @param kind 0: exact solid angles, 1: the approximation renormalised, 2: even weights
static double gram_error(uint32_t size, int kind)
{
    double gram[9][9] = {{0.0}}, total = 0.0, largest = 0.0;
    for (uint32_t i = 0; i < 6 * size * size; i++) {
        const uint32_t x = i % size, y = i / size % size;
        const double s = 2.0 * (x + 0.5) / size - 1.0, t = 2.0 * (y + 0.5) / size - 1.0;
        const double weight = kind == 0   ? alpi_cube_texel_solid_angle(size, x, y)
                              : kind == 1 ? pow(1.0 + s * s + t * t, -1.5)
                                          : 1.0;
        const vec3 d = alpi_cube_texel_direction((alp_cube_face)(i / size / size), size, x, y);
        double basis[9];
        alpi_sh_basis(2, (const double[3]){(double)d.x, (double)d.y, (double)d.z}, basis);
        total += weight;
        for (int k = 0; k < 81; k++) {
            gram[k / 9][k % 9] += weight * basis[k / 9] * basis[k % 9];
        }
    }
    for (int k = 0; k < 81; k++) {
        const double one = k / 9 == k % 9 ? 1.0 : 0.0;
        largest = fmax(largest, fabs(gram[k / 9][k % 9] * 4.0 * ALPI_PI / total - one));
    }
    return largest;
}

TEST(even_weights_are_far_off)
{
    ASSERT_NEAR(gram_error(16, 0), 0.00158, 0.00002);
    ASSERT_NEAR(gram_error(16, 1), 0.00072, 0.00002);
    ASSERT_NEAR(gram_error(128, 2), 0.2222, 0.0002);
}

TEST_WITH_CONTEXT(the_table_integrates_its_functions_exactly, 1)
{
    // Moments of each texel over the whole cube: Σ ∫ Y_i over texels of face size n is that of one
    // texel of size 1, and functions that are constant over texels have no error at all.
    alpi_cube_table table;
    for (uint32_t size = 1; size <= 40; size += 3) {
        double sums[ALPI_CUBE_MOMENTS] = {0.0};
        ASSERT_OK(context, alpi_cube_table_create(context, size, &table));
        for (uint32_t i = 0; i < table.half * table.blocks; i++) {
            for (int m = 0; m < ALPI_CUBE_MOMENTS; m++) {
                for (int lane = 0; lane < ALPI_CUBE_LANES; lane++) {
                    const bool middle = size % 2 == 1 && i / table.blocks == table.half - 1;
                    sums[m] += (middle ? 2.0 : 4.0) *
                               (double)table.weights[i * ALPI_CUBE_MOMENTS + (uint32_t)m].at[lane];
                }
            }
        }
        // ∫ 1 = 2π/3, and by symmetry between axes ∫ a² = ∫ b²; faces together give ∫ c² = 4π/3.
        ASSERT_NEAR(sums[0], 2.0 * ALPI_PI / 3.0, 1e-6);
        ASSERT_NEAR(sums[3], 0.0, 1e-6);
        const double cc = sums[2], aa = 0.5 * (sums[0] - cc);
        ASSERT_NEAR(2.0 * cc + 4.0 * aa, 4.0 * ALPI_PI / 3.0, 1e-6);
        // ∫ c dω over a face is an edge integral: 4 · (1/2) · 2 atan(1/√2) / √2
        ASSERT_NEAR(sums[1], 4.0 * atan(1.0 / sqrt(2.0)) / sqrt(2.0), 1e-6);
        alpi_cube_table_release(context, &table);
    }
}

TEST_WITH_CONTEXT(rows_come_in_any_order, 1)
{
    static const uint32_t sizes[] = {5, 16, 40};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        const uint32_t size = sizes[s];
        float *pixels = make_cube(size, test_environment);
        const alp_sh9 whole = project(context, size, pixels);
        for (uint32_t step = 1; step <= size; step += 3) {
            alp_sh_projection *p;
            alp_sh9 parts;
            ASSERT_OK(context, alp_sh_projection_create(context, size, &p));
            for (int face = 5; face >= 0; face--) {
                for (uint32_t end = size; end > 0;) {
                    const uint32_t count = end < step ? end : step;
                    end -= count;
                    ASSERT_OK(context, alp_sh_projection_add(
                                           p, (alp_cube_face)face, end, count,
                                           pixels + 3 * size * ((uint32_t)face * size + end)));
                }
            }
            ASSERT_OK(context, alp_sh_projection_finish(p, &parts));
            assert_true(difference(&whole, &parts) < 1e-6 * magnitude(&whole));
            alp_sh_projection_destroy(p);
        }
        free(pixels);
    }
}

TEST_WITH_CONTEXT(wrong_rows_are_refused, 1)
{
    enum { SIZE = 4 };
    static float pixels[SIZE * SIZE * 3];
    alp_sh_projection *p;
    alp_sh9 c = {{{7.0f}}};
    assert_int_equal(alp_sh_projection_create(context, 0, &p), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(p);
    assert_int_equal(alp_sh_projection_create(context, 4097, &p), ALP_ERROR_INVALID_ARGUMENT);
    ASSERT_OK(context, alp_sh_projection_create(context, SIZE, &p));
    assert_int_equal(alp_sh_projection_add(p, (alp_cube_face)6, 0, 1, pixels),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_sh_projection_add(p, ALP_CUBE_POSITIVE_X, 0, 5, pixels),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_sh_projection_add(p, ALP_CUBE_POSITIVE_X, 5, 0, pixels),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_sh_projection_add(p, ALP_CUBE_POSITIVE_X, 0, 1, NULL),
                     ALP_ERROR_INVALID_ARGUMENT);
    ASSERT_OK(context, alp_sh_projection_add(p, ALP_CUBE_POSITIVE_X, 1, 2, pixels));
    assert_int_equal(alp_sh_projection_add(p, ALP_CUBE_POSITIVE_X, 2, 2, pixels),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(alp_context_message(context), "added before"));
    assert_int_equal(alp_sh_projection_finish(p, &c), ALP_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(alp_context_message(context), "22 of its 24 rows are missing"));
    assert_true(c.c[0][0] == 7.0f);
    alp_sh_projection_destroy(p);
    alp_sh_projection_destroy(NULL);
}

TEST_WITH_CONTEXT(a_projection_starts_anew, 1)
{
    enum { SIZE = 8 };
    float *pixels = make_cube(SIZE, test_environment);
    alp_sh_projection *p;
    alp_sh9 first, second;
    const float *faces[6];
    for (size_t f = 0; f < 6; f++) {
        faces[f] = pixels + f * 3 * SIZE * SIZE;
    }
    ASSERT_OK(context, alp_sh_projection_create(context, SIZE, &p));
    ASSERT_OK(context, alp_sh_project_cube(p, faces, &first));
    ASSERT_OK(context, alp_sh_projection_add(p, ALP_CUBE_NEGATIVE_Z, 2, 3, pixels));
    ASSERT_OK(context, alp_sh_project_cube(p, faces, &second));
    assert_memory_equal(&first, &second, sizeof first);
    alp_sh_projection_destroy(p);
    free(pixels);
}

TEST_WITH_CONTEXT(every_instruction_set_gives_the_same_bits, 1)
{
#ifdef ALPI_HAS_V3
    if (!alpi_context_has_v3(context)) {
        skip();
    }
    static const uint32_t sizes[] = {1, 4, 9, 16, 30, 64};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        const uint32_t size = sizes[s];
        float *pixels = make_cube(size, test_environment);
        alpi_cube_table table;
        alpi_cube_sums plain = {{{{0.0}}}}, wide = {{{{0.0}}}};
        ASSERT_OK(context, alpi_cube_table_create(context, size, &table));
        alpi_cube_add(&table, alpi_cube_sum_baseline, ALP_CUBE_POSITIVE_Z, 0, size, pixels, &plain);
        alpi_cube_add(&table, alpi_cube_sum_v3, ALP_CUBE_POSITIVE_Z, 0, size, pixels, &wide);
        assert_memory_equal(&plain, &wide, sizeof plain);
        alpi_cube_table_release(context, &table);
        free(pixels);
    }
#else
    (void)context;
    skip();
#endif
}

TEST(out_of_memory_is_reported)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    for (int allowed = 0; allowed < 4; allowed++) {
        alp_sh_projection *p;
        left = allowed;
        assert_int_equal(alp_sh_projection_create(context, 16, &p), ALP_ERROR_OUT_OF_MEMORY);
        assert_null(p);
    }
    alp_context_destroy(context);
}
