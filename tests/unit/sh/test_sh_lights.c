// SPDX-License-Identifier: MIT
// Analytic lights against closed forms and integrals.
#include "sh_directions.h"
#include "test_support.h"

static const float WHITE[3] = {1.0f, 1.0f, 1.0f};

static double read(const alp_sh9 *c, vec3 n)
{
    float e[3];
    alp_sh_irradiance(c, (const float[3]){n.x, n.y, n.z}, ALP_SH_LINEAR, e);
    return (double)e[0];
}

TEST(directional_light_has_its_polynomial)
{
    // oracle 3: 3/32 + c/2 + (15/32) c²
    for (int l = 0; l < 20; l++) {
        const vec3 d = test_direction(l, 20);
        alp_sh9 c = {{{0.0f}}};
        alp_sh_add_directional(&c, (const float[3]){d.x, d.y, d.z}, WHITE);
        for (int i = 0; i < 200; i++) {
            const vec3 n = test_direction(i, 200);
            const double cosine = (double)vec3_dot(d, n);
            ASSERT_NEAR(read(&c, n), 3.0 / 32.0 + cosine / 2.0 + 15.0 / 32.0 * cosine * cosine,
                        1e-6);
        }
    }
}

TEST(errors_of_a_directional_light)
{
    // Largest .0938 and mean .0307 with nine coefficients; .25 with four.
    enum { STEPS = 20000 };
    alp_sh9 nine = {{{0.0f}}}, four;
    alp_sh_add_directional(&nine, (const float[3]){0.0f, 1.0f, 0.0f}, WHITE);
    four = nine;
    memset(four.c[4], 0, 5 * sizeof four.c[4]);
    double largest = 0.0, mean = 0.0, largest_of_four = 0.0;
    for (int i = 0; i <= STEPS; i++) {
        const double c = 2.0 * i / STEPS - 1.0;
        const vec3 n = {(float)sqrt(1.0 - c * c), (float)c, 0.0f};
        const double error = fabs(read(&nine, n) - fmax(c, 0.0));
        largest = fmax(largest, error);
        mean += error / (STEPS + 1);
        largest_of_four = fmax(largest_of_four, fabs(read(&four, n) - fmax(c, 0.0)));
    }
    ASSERT_NEAR(largest, 0.0938, 0.00006);
    ASSERT_NEAR(mean, 0.0307, 0.00006);
    ASSERT_NEAR(largest_of_four, 0.25, 1e-5);
}

TEST(hemisphere_is_exact)
{
    // oracle 2: E = πL (1 + cos t) / 2, and the other half below
    const float up[3] = {1.0f, 2.0f, 0.0f}, down[3] = {0.0f, 0.5f, 3.0f};
    for (int l = 0; l < 20; l++) {
        const vec3 d = test_direction(l, 20);
        alp_sh9 c = {{{0.0f}}};
        alp_sh_add_hemisphere(&c, (const float[3]){d.x, d.y, d.z}, up, down);
        for (int i = 0; i < 100; i++) {
            const vec3 n = test_direction(i, 100);
            const double cosine = (double)vec3_dot(d, n);
            float e[3];
            alp_sh_irradiance(&c, (const float[3]){n.x, n.y, n.z}, ALP_SH_LINEAR, e);
            for (int k = 0; k < 3; k++) {
                ASSERT_NEAR(
                    e[k],
                    ALPI_PI * ((double)up[k] * (1.0 + cosine) + (double)down[k] * (1.0 - cosine)) /
                        2.0,
                    5e-6);
            }
        }
    }
}

TEST(point_light_falls_with_the_square)
{
    alp_sh9 point = {{{0.0f}}}, directional = {{{0.0f}}}, none = {{{0.0f}}};
    alp_sh_add_point(&point, (const float[3]){0.0f, -1.8f, 2.4f},
                     (const float[3]){9.0f, 18.0f, 0.0f});
    alp_sh_add_directional(&directional, (const float[3]){0.0f, -0.6f, 0.8f},
                           (const float[3]){1.0f, 2.0f, 0.0f});
    for (int i = 0; i < 27; i++) {
        ASSERT_NEAR(point.c[i / 3][i % 3], directional.c[i / 3][i % 3], 1e-6);
    }
    alp_sh_add_point(&none, (const float[3]){0.0f, 0.0f, 0.0f}, WHITE);
    for (int i = 0; i < 27; i++) {
        assert_true(none.c[i / 3][i % 3] == 0.0f);
    }
}

TEST(disk_is_the_integral_over_its_cone)
{
    const vec3 d = {0.48f, 0.6f, -0.64f};
    const double angles[] = {0.05, 0.6, 1.4, 2.2, ALPI_PI};
    for (int a = 0; a < 5; a++) {
        enum { RINGS = 400, AROUND = 24 };
        alp_sh9 ours = {{{0.0f}}};
        double sum[9] = {0.0};
        vec3 t, b;
        vec3_frame(d, &t, &b);
        for (int i = 0; i < RINGS * AROUND; i++) {
            const double z0 = cos(angles[a]);
            const double z = z0 + (1.0 - z0) * (i / AROUND + 0.5) / RINGS;
            const double s = sqrt(1.0 - z * z), phi = 2.0 * ALPI_PI * (i % AROUND) / AROUND;
            const vec3 w = vec3_mad(vec3_mad(vec3_scale(d, (float)z), (float)(s * cos(phi)), t),
                                    (float)(s * sin(phi)), b);
            float basis[9];
            alpi_sh9_basis(w, basis);
            for (int k = 0; k < 9; k++) {
                sum[k] += (double)basis[k] * 2.0 * ALPI_PI * (1.0 - z0) / (RINGS * AROUND);
            }
        }
        alp_sh_add_disk(&ours, (const float[3]){d.x, d.y, d.z}, angles[a], WHITE);
        for (int k = 0; k < 9; k++) {
            ASSERT_NEAR(ours.c[k][2], sum[k], 2e-5);
        }
    }
}

TEST(small_disk_is_a_directional_light)
{
    alp_sh9 disk = {{{0.0f}}}, directional = {{{0.0f}}};
    const double angle = 0.001, solid_angle = ALPI_PI * angle * angle;
    const float radiance = (float)(1.0 / solid_angle), direction[3] = {0.0f, 0.8f, 0.6f};
    alp_sh_add_disk(&disk, direction, angle, (const float[3]){radiance, radiance, radiance});
    alp_sh_add_directional(&directional, direction, WHITE);
    for (int i = 0; i < 9; i++) {
        ASSERT_NEAR(disk.c[i][0], directional.c[i][0], 2e-6);
    }
}

TEST(half_disk_is_a_hemisphere)
{
    const float direction[3] = {0.6f, 0.0f, -0.8f}, dark[3] = {0.0f, 0.0f, 0.0f};
    alp_sh9 disk = {{{0.0f}}}, hemisphere = {{{0.0f}}};
    alp_sh_add_disk(&disk, direction, ALPI_PI / 2.0, WHITE);
    alp_sh_add_hemisphere(&hemisphere, direction, WHITE, dark);
    for (int i = 0; i < 9; i++) {
        ASSERT_NEAR(disk.c[i][1], hemisphere.c[i][1], 1e-6);
    }
}
