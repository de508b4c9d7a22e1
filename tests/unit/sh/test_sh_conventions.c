// SPDX-License-Identifier: MIT
// Conventions: each is read back by its reader's own formula, and +Y is brighter under a sky.
#include "sh_directions.h"
#include "test_support.h"

/// E of a convention's numbers, by the formula of its reader, times what makes it irradiance.
static double read_as(alp_sh_convention convention, const float *v, int k, vec3 normal)
{
    const double x = (double)normal.x, y = (double)normal.y, z = (double)normal.z;
    double c[9];
    for (int i = 0; i < 9; i++) {
        c[i] = convention == ALP_SH_AMBIENT_CUBE && i > 5 ? 0.0 : (double)v[3 * i + k];
    }
    switch (convention) {
    case ALP_SH_THREE: // getIrradianceAt of LightProbe
        return c[0] * 0.886227 + c[1] * 2.0 * 0.511664 * y + c[2] * 2.0 * 0.511664 * z +
               c[3] * 2.0 * 0.511664 * x + c[4] * 2.0 * 0.429043 * x * y +
               c[5] * 2.0 * 0.429043 * y * z + c[6] * (0.743125 * z * z - 0.247708) +
               c[7] * 2.0 * 0.429043 * x * z + c[8] * 0.429043 * (x * x - y * y);
    case ALP_SH_FILAMENT: // Irradiance_SphericalHarmonics: E/π
        return ALPI_PI * (c[0] + c[1] * y + c[2] * z + c[3] * x + c[4] * y * x + c[5] * y * z +
                          c[6] * (3.0 * z * z - 1.0) + c[7] * z * x + c[8] * (x * x - y * y));
    case ALP_SH_UNITY: { // ShadeSH9 with SHA = (3, 1, 2, 0 − 6), SHB = (4, 5, 3 · 6, 7), SHC = 8
        const double linear = c[3] * x + c[1] * y + c[2] * z + c[0] - c[6];
        return ALPI_PI * (linear + c[4] * x * y + c[5] * y * z + 3.0 * c[6] * z * z + c[7] * z * x +
                          c[8] * (x * x - y * y));
    }
    case ALP_SH_GLTF: // Σ c Y with the Condon–Shortley sign
        return c[0] * 0.282095 - c[1] * 0.488603 * y + c[2] * 0.488603 * z - c[3] * 0.488603 * x +
               c[4] * 1.092548 * x * y - c[5] * 1.092548 * y * z +
               c[6] * 0.315392 * (3.0 * z * z - 1.0) - c[7] * 1.092548 * x * z +
               c[8] * 0.546274 * (x * x - y * y);
    case ALP_SH_GODOT: // lightmap_gi: E = π Σ A_l v Y
        return ALPI_PI * (3.141593 * c[0] * 0.282095 +
                          2.094395 * 0.488603 * (c[1] * y + c[2] * z + c[3] * x) +
                          0.785398 * (1.092548 * (c[4] * x * y + c[5] * y * z + c[7] * x * z) +
                                      0.315392 * c[6] * (3.0 * z * z - 1.0) +
                                      0.546274 * c[8] * (x * x - y * y)));
    case ALP_SH_AMBIENT_CUBE: {
        return x * x * c[x < 0.0 ? 1 : 0] + y * y * c[y < 0.0 ? 3 : 2] + z * z * c[z < 0.0 ? 5 : 4];
    }
    }
    return (double)NAN;
}

TEST(readers_get_the_same_irradiance)
{
    for (alp_sh_convention convention = ALP_SH_THREE; convention < ALP_SH_AMBIENT_CUBE;
         convention++) {
        for (int p = 0; p < 3; p++) {
            float values[9][3];
            assert_int_equal(alp_sh_convert(&test_probes[p], convention, values), ALP_OK);
            for (int i = 0; i < 300; i++) {
                const vec3 n = test_direction(i, 300);
                const vec3 e = alpi_sh9_irradiance(&test_probes[p], n);
                const float expected[3] = {e.x, e.y, e.z};
                for (int k = 0; k < 3; k++) {
                    ASSERT_NEAR(read_as(convention, &values[0][0], k, n), expected[k], 5e-6);
                }
            }
        }
    }
}

TEST(up_is_brighter_under_a_sky)
{
    const float up[3] = {0.2f, 0.5f, 1.0f}, down[3] = {0.1f, 0.05f, 0.0f};
    alp_sh9 sky = {{{0.0f}}};
    alp_sh_add_hemisphere(&sky, (const float[3]){0, 1, 0}, up, down);
    for (alp_sh_convention convention = ALP_SH_THREE; convention <= ALP_SH_AMBIENT_CUBE;
         convention++) {
        float values[9][3];
        assert_int_equal(alp_sh_convert(&sky, convention, values), ALP_OK);
        for (int k = 0; k < 3; k++) {
            const double top = read_as(convention, &values[0][0], k, (vec3){0, 1, 0});
            const double bottom = read_as(convention, &values[0][0], k, (vec3){0, -1, 0});
            ASSERT_NEAR(top, ALPI_PI * (double)up[k], 1e-5);
            ASSERT_NEAR(bottom, ALPI_PI * (double)down[k], 1e-5);
            for (int i = 0; i < 100; i++) {
                assert_true(read_as(convention, &values[0][0], k, test_direction(i, 100)) < top);
            }
        }
    }
}

TEST(conversions_come_back)
{
    for (alp_sh_convention convention = ALP_SH_THREE; convention < ALP_SH_AMBIENT_CUBE;
         convention++) {
        float values[9][3];
        alp_sh9 back;
        assert_int_equal(alp_sh_row_count(convention), 9);
        assert_int_equal(alp_sh_convert(&test_probes[0], convention, values), ALP_OK);
        assert_int_equal(alp_sh_from(convention, &values[0][0], &back), ALP_OK);
        for (int i = 0; i < 27; i++) {
            ASSERT_NEAR(back.c[i / 3][i % 3], test_probes[0].c[i / 3][i % 3], 1e-7);
        }
    }
}

TEST(an_ambient_cube_comes_back)
{
    // Its own six directions come back; of light without products of axes, everything does.
    const float cube[6][3] = {{1, 2, 3},    {0.5f, 4, 1}, {3, 2, 5},
                              {1, 1, 0.5f}, {2, 2, 2},    {1, 3, 4}};
    alp_sh9 c;
    float values[6][3];
    assert_int_equal(alp_sh_row_count(ALP_SH_AMBIENT_CUBE), 6);
    assert_int_equal(alp_sh_from(ALP_SH_AMBIENT_CUBE, &cube[0][0], &c), ALP_OK);
    assert_int_equal(alp_sh_convert(&c, ALP_SH_AMBIENT_CUBE, values), ALP_OK);
    for (int i = 0; i < 18; i++) {
        ASSERT_NEAR(values[i / 3][i % 3], cube[i / 3][i % 3], 1e-5);
    }
    alp_sh9 light = test_probes[1], back;
    memset(light.c[4], 0, sizeof light.c[4]);
    memset(light.c[5], 0, sizeof light.c[5]);
    memset(light.c[7], 0, sizeof light.c[7]);
    assert_int_equal(alp_sh_convert(&light, ALP_SH_AMBIENT_CUBE, values), ALP_OK);
    assert_int_equal(alp_sh_from(ALP_SH_AMBIENT_CUBE, &values[0][0], &back), ALP_OK);
    for (int i = 0; i < 27; i++) {
        ASSERT_NEAR(back.c[i / 3][i % 3], light.c[i / 3][i % 3], 1e-6);
    }
}

TEST(errors_of_an_ambient_cube)
{
    // The exact cube of a directional light with E = 1: .25 along an axis, .42 along a diagonal.
    double largest[2] = {0.0, 0.0};
    const float diagonal = (float)(1.0 / sqrt(3.0));
    const vec3 lights[2] = {{0.0f, 1.0f, 0.0f}, {diagonal, diagonal, diagonal}};
    for (int l = 0; l < 2; l++) {
        const float d[3] = {lights[l].x, lights[l].y, lights[l].z};
        float cube[6][3];
        for (int i = 0; i < 6; i++) {
            const float c = (i % 2 == 0 ? 1.0f : -1.0f) * d[i / 2];
            cube[i][0] = cube[i][1] = cube[i][2] = c > 0.0f ? c : 0.0f;
        }
        for (int i = 0; i < 20000; i++) {
            const vec3 n = test_direction(i, 20000);
            float e[3];
            alp_sh_ambient_cube_irradiance(&cube[0][0], (const float[3]){n.x, n.y, n.z}, e);
            const double truth = fmax(0.0, (double)vec3_dot(n, lights[l]));
            largest[l] = fmax(largest[l], fabs((double)e[2] - truth));
        }
    }
    ASSERT_NEAR(largest[0], 0.25, 1e-4);
    ASSERT_NEAR(largest[1], 1.0 - 1.0 / sqrt(3.0), 1e-3);
}

TEST(unknown_conventions_are_refused)
{
    float values[9][3] = {{0.0f}};
    alp_sh9 c = test_probes[0];
    assert_int_equal(alp_sh_row_count((alp_sh_convention)6), 0);
    assert_int_equal(alp_sh_row_count((alp_sh_convention)-1), 0);
    assert_int_equal(alp_sh_convert(&c, (alp_sh_convention)6, values), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_sh_from((alp_sh_convention)6, &values[0][0], &c),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_sh_convert(NULL, ALP_SH_THREE, values), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_sh_from(ALP_SH_THREE, NULL, &c), ALP_ERROR_INVALID_ARGUMENT);
    assert_memory_equal(&c, &test_probes[0], sizeof c);
}

/// The examples of docs/conventions.md: a sky of 1 above and 0 below.
TEST(the_examples_of_the_documentation)
{
    static const struct {
        alp_sh_convention convention;
        float zero, y; // of the first row and of that of y
    } examples[] = {{ALP_SH_THREE, 1.772454f, 1.534990f},
                    {ALP_SH_FILAMENT, 0.5f, 0.5f},
                    {ALP_SH_GLTF, 5.568328f, -3.214876f},
                    {ALP_SH_GODOT, 0.564190f, 0.488603f},
                    {ALP_SH_UNITY, 0.5f, 0.5f}};
    alp_sh9 sky = {{{0.0f}}};
    alp_sh_add_hemisphere(&sky, (const float[3]){0, 1, 0}, (const float[3]){1, 1, 1},
                          (const float[3]){0, 0, 0});
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        float v[9][3];
        assert_int_equal(alp_sh_convert(&sky, examples[i].convention, v), ALP_OK);
        ASSERT_NEAR(v[0][0], examples[i].zero, 1e-6);
        ASSERT_NEAR(v[1][0], examples[i].y, 1e-6);
        for (int k = 2; k < 9; k++) {
            ASSERT_NEAR(v[k][0], 0.0, 1e-6);
        }
    }
    float cube[6][3];
    const double expected[6] = {ALPI_PI / 2, ALPI_PI / 2, ALPI_PI, 0.0, ALPI_PI / 2, ALPI_PI / 2};
    assert_int_equal(alp_sh_convert(&sky, ALP_SH_AMBIENT_CUBE, cube), ALP_OK);
    for (int i = 0; i < 6; i++) {
        ASSERT_NEAR(cube[i][1], expected[i], 1e-6);
    }
}
