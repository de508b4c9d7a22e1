// SPDX-License-Identifier: MIT
// Read-out: polynomial, matrix, clamping, two bands, windows, products, irradiance maps.
#include "sh_directions.h"
#include "test_support.h"

static const float WHITE[3] = {1.0f, 1.0f, 1.0f};

TEST(matrix_and_polynomial_agree_on_published_probes)
{
    for (int p = 0; p < 3; p++) {
        float vectors[12][4];
        alp_sh_shader_vectors(&test_probes[p], vectors);
        for (int i = 0; i < 2000; i++) {
            const vec3 n = test_direction(i, 2000);
            const float normal[3] = {n.x, n.y, n.z};
            float matrix[3], sum[3];
            const vec3 polynomial = alpi_sh9_irradiance_polynomial(&test_probes[p], n);
            alp_sh_shader_irradiance(&vectors[0][0], normal, matrix);
            alp_sh_irradiance(&test_probes[p], normal, ALP_SH_LINEAR, sum);
            const float other[3] = {polynomial.x, polynomial.y, polynomial.z};
            for (int k = 0; k < 3; k++) {
                ASSERT_NEAR(matrix[k], other[k], 1e-6);
                ASSERT_NEAR(sum[k], other[k], 1e-6);
            }
        }
    }
}

TEST(matrix_is_symmetric_and_the_paper_s)
{
    // Its corner elements for Grace Cathedral, red, by hand from the paper's formula.
    float v[12][4];
    alp_sh_shader_vectors(&test_probes[0], v);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 16; i++) {
            assert_true(v[4 * k + i / 4][i % 4] == v[4 * k + i % 4][i / 4]);
        }
    }
    ASSERT_NEAR(v[0][0], 0.429043 * 0.21205, 1e-6);
    ASSERT_NEAR(v[1][1], -0.429043 * 0.21205, 1e-6);
    ASSERT_NEAR(v[2][2], 0.743124 * -0.15570, 1e-6);
    ASSERT_NEAR(v[3][3], 0.886227 * 0.78908 + 0.247708 * 0.15570, 1e-6);
    ASSERT_NEAR(v[1][3], 0.511663 * 0.39499, 1e-6);
    ASSERT_NEAR(v[0][2], 0.429043 * 0.56014, 1e-6);
}

TEST(clamping_ends_at_0)
{
    // Two windows of light: E is negative sideways of strong opposite lobes.
    alp_sh9 c = {{{0.0f}}};
    c.c[0][0] = 1.0f;
    c.c[1][0] = 2.0f;
    const float down[3] = {0.0f, -1.0f, 0.0f}, up[3] = {0.0f, 1.0f, 0.0f};
    float linear[3], clamped[3];
    alp_sh_irradiance(&c, down, ALP_SH_LINEAR, linear);
    alp_sh_irradiance(&c, down, ALP_SH_CLAMPED, clamped);
    ASSERT_NEAR(linear[0], 0.886227 - 2.0 * 1.023328, 1e-5);
    assert_true(clamped[0] == 0.0f && clamped[1] == 0.0f);
    alp_sh_irradiance(&c, up, ALP_SH_LINEAR, linear);
    alp_sh_irradiance(&c, up, ALP_SH_CLAMPED, clamped);
    assert_true(linear[0] == clamped[0]);
}

TEST(two_bands_keep_energy_and_sign)
{
    // Constant: exactly πL. Directional: r = 1, so E = (√π/2) c₀ · 4 q³ = q³, which peaks at 1.
    alp_sh9 even = {{{0.0f}}}, one = {{{0.0f}}};
    even.c[0][1] = (float)(2.0 * sqrt(ALPI_PI));
    alp_sh_add_directional(&one, (const float[3]){0.6f, 0.0f, 0.8f}, WHITE);
    double mean = 0.0;
    for (int i = 0; i < 4000; i++) {
        const vec3 n = test_direction(i, 4000);
        const float normal[3] = {n.x, n.y, n.z};
        const double q = 0.5 + 0.5 * (double)(0.6f * n.x + 0.8f * n.z);
        float e[3];
        alp_sh_irradiance(&even, normal, ALP_SH_TWO_BANDS, e);
        ASSERT_NEAR(e[1], ALPI_PI, 1e-6);
        assert_true(e[0] == 0.0f);
        alp_sh_irradiance(&one, normal, ALP_SH_TWO_BANDS, e);
        ASSERT_NEAR(e[0], q * q * q, 1e-5);
        mean += (double)e[0] / 4000.0;
    }
    ASSERT_NEAR(mean, 0.25, 1e-4); // as the truth: the mean of max(0, cosine)
}

TEST(windows_have_their_factors)
{
    alp_sh9 hanning, sinc, narrow;
    for (int i = 0; i < 27; i++) {
        hanning.c[i / 3][i % 3] = sinc.c[i / 3][i % 3] = narrow.c[i / 3][i % 3] = 1.0f;
    }
    alp_sh_window(&hanning, ALP_SH_HANNING, 4.0);
    alp_sh_window(&sinc, ALP_SH_SINC4, 4.0);
    alp_sh_window(&narrow, ALP_SH_HANNING, 2.0);
    ASSERT_NEAR(hanning.c[0][2], 1.0, 0.0);
    ASSERT_NEAR(hanning.c[3][0], 0.8535533906, 1e-7);
    ASSERT_NEAR(hanning.c[4][0], 0.5, 1e-7);
    ASSERT_NEAR(sinc.c[2][1], pow(sin(ALPI_PI / 4.0) / (ALPI_PI / 4.0), 4.0), 1e-7);
    ASSERT_NEAR(sinc.c[8][1], pow(2.0 / ALPI_PI, 4.0), 1e-7);
    ASSERT_NEAR(narrow.c[1][0], 0.5, 1e-7);
    assert_true(narrow.c[6][0] == 0.0f);
}

TEST(a_window_takes_ringing_away)
{
    alp_sh9 c = {{{0.0f}}};
    alp_sh_add_directional(&c, (const float[3]){0.0f, 1.0f, 0.0f}, WHITE);
    double before = 0.0, after = 0.0;
    alp_sh9 soft = c;
    alp_sh_window(&soft, ALP_SH_SINC4, 3.0);
    for (int i = 0; i < 1000; i++) {
        const vec3 n = test_direction(i, 1000);
        before = fmin(before, (double)alpi_sh9_irradiance(&c, n).x);
        after = fmin(after, (double)alpi_sh9_irradiance(&soft, n).x);
    }
    ASSERT_NEAR(before, 3.0 / 32.0 - 2.0 / 15.0, 1e-4); // at c = −8/15
    assert_true(after == 0.0);
}

TEST(product_with_a_cosine_lobe)
{
    for (int p = 0; p < 3; p++) {
        for (int l = 0; l < 10; l++) {
            enum { SAMPLES = 40000 };
            const vec3 n = test_direction(l, 10);
            const alp_sh9 *light = &test_probes[p];
            double sums[9] = {0.0};
            alp_sh9 product;
            alp_sh_multiply_cosine(light, (const float[3]){n.x, n.y, n.z}, &product);
            for (int i = 0; i < SAMPLES; i++) {
                const vec3 w = test_direction(i, SAMPLES);
                float basis[9];
                double radiance = 0.0;
                alpi_sh9_basis(w, basis);
                for (int k = 0; k < 9; k++) {
                    radiance += (double)(basis[k] * light->c[k][0]);
                }
                const double lobe = fmax(0.0, (double)vec3_dot(n, w)) * 4.0 * ALPI_PI / SAMPLES;
                for (int k = 0; k < 9; k++) {
                    sums[k] += radiance * lobe * (double)basis[k];
                }
            }
            for (int k = 0; k < 9; k++) {
                ASSERT_NEAR(product.c[k][0], sums[k], 1e-4);
            }
            const vec3 e = alpi_sh9_irradiance(light, n);
            ASSERT_NEAR(product.c[0][1] * (float)(2.0 * sqrt(ALPI_PI)), e.y, 2e-6);
        }
    }
}

TEST_WITH_CONTEXT(irradiance_map_holds_its_centres, 1)
{
    alp_image *map;
    ASSERT_OK(context, alp_sh_irradiance_image(context, &test_probes[1], ALP_SH_CLAMPED, 64, &map));
    const alp_image_info info = alp_image_get_info(map);
    assert_int_equal(info.width, 64);
    assert_int_equal(info.height, 32);
    assert_int_equal(info.channels, 3);
    // Row 0 is up. The middle is −Z; right of it +X. Between pixels the map is smooth.
    const float *pixels = alp_image_floats(map);
    const struct {
        int x, y;
        vec3 n;
    } places[] = {{0, 0, {0, 1, 0}},   {40, 31, {0, -1, 0}}, {32, 16, {0, 0, -1}},
                  {48, 16, {1, 0, 0}}, {16, 16, {-1, 0, 0}}, {0, 15, {0, 0, 1}}};
    for (int i = 0; i < 6; i++) {
        const vec3 e = alpi_sh9_irradiance(&test_probes[1], places[i].n);
        const float *pixel = pixels + 3 * (64 * places[i].y + places[i].x);
        ASSERT_NEAR(pixel[0], e.x, 0.03);
        ASSERT_NEAR(pixel[1], e.y, 0.03);
        ASSERT_NEAR(pixel[2], e.z, 0.03);
    }
    alp_image_destroy(map);
    assert_int_equal(alp_sh_irradiance_image(context, &test_probes[0], ALP_SH_CLAMPED, 63, &map),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_null(map);
}
