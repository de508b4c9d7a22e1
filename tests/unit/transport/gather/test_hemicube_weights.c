// SPDX-License-Identifier: MIT
// Weights of hemicube pixels against integrals, and how pixels are laid out in packets and frames.
#include "test_support.h"

#include "transport/gather/hemicube.h"

#include <math.h>

TEST_CONTEXT(1);

static bool is_corner(uint32_t n, uint32_t column, uint32_t row)
{
    const bool beside = column < n / 2 || column >= n / 2 + n;
    return beside && (row < n / 2 || row >= n / 2 + n);
}

TEST(weights_sum_to_one)
{
    static const uint32_t resolutions[] = {2, 4, 6, 10, 64, 130, 512};
    for (int k = 0; k < 7; k++) {
        const uint32_t n = resolutions[k];
        double sum = 0.0;
        for (uint32_t row = 0; row < 2 * n; row++) {
            for (uint32_t column = 0; column < 2 * n; column++) {
                const double w = alpi_hemicube_weight(n, column, row);
                assert_true(is_corner(n, column, row) ? w == 0.0 : w > 0.0);
                sum += w;
            }
        }
        ASSERT_NEAR(sum, 1.0, 1e-12); // differences of numbers near .1 are right to 1e-17 each
    }
}

/// Eight mirror images of a pixel have the same bits.
TEST(weights_are_symmetric)
{
    const uint32_t n = 22, last = 2 * n - 1;
    for (uint32_t r = 0; r < 2 * n; r++) {
        for (uint32_t c = 0; c < 2 * n; c++) {
            const double w = alpi_hemicube_weight(n, c, r);
            assert_true(alpi_hemicube_weight(n, last - c, r) == w);
            assert_true(alpi_hemicube_weight(n, c, last - r) == w);
            assert_true(alpi_hemicube_weight(n, r, c) == w);
        }
    }
}

/// ∫ cosθ cosα / (π r²) dA, α at the face, which is z / (π r⁴): Gauss–Legendre of 5 points over 6
/// pieces along each axis. `u` and `v` are the pixel's middle in the cross.
static double integrate(double u, double v, double side)
{
    static const double at[5] = {-0.906179845938664, -0.538469310105683, 0.0, 0.538469310105683,
                                 0.906179845938664};
    static const double part[5] = {0.236926885056189, 0.478628670499366, 0.568888888888889,
                                   0.478628670499366, 0.236926885056189};
    const double piece = side / 6.0;
    double sum = 0.0;
    for (int i = 0; i < 30; i++) {
        for (int k = 0; k < 30; k++) {
            const double a = fabs(u - side / 2.0 + piece * (i / 5 + 0.5 + 0.5 * at[i % 5]));
            const double b = fabs(v - side / 2.0 + piece * (k / 5 + 0.5 + 0.5 * at[k % 5]));
            const double z = a > 1.0 ? 2.0 - a : (b > 1.0 ? 2.0 - b : 1.0);
            const double x = fmin(a, 1.0), y = fmin(b, 1.0), r2 = x * x + y * y + z * z;
            sum += z / (r2 * r2) * part[i % 5] * part[k % 5];
        }
    }
    return sum * piece * piece / 4.0 / ALPI_PI;
}

TEST(every_weight_is_the_integral_over_its_pixel)
{
    static const uint32_t resolutions[] = {2, 6, 16};
    for (int k = 0; k < 3; k++) {
        const uint32_t n = resolutions[k];
        for (uint32_t r = 0; r < 2 * n; r++) {
            for (uint32_t c = 0; c < 2 * n; c++) {
                const double side = 2.0 / n;
                const double u = -2.0 + (c + 0.5) * side, v = 2.0 - (r + 0.5) * side;
                const double expected = is_corner(n, c, r) ? 0.0 : integrate(u, v, side);
                ASSERT_NEAR(alpi_hemicube_weight(n, c, r), expected, 1e-13); // the rule's own
            }
        }
    }
}

/// Cosines at the centres instead, which are known to be off by .013 % in sum and .065 % at most at
/// n = 64; and the map that looks right, with one cosine for perspective where there are three,
/// which is .65 of the truth ahead and 1.9 at the top corners once its sum is 1.
TEST(weights_at_centres_are_not_exact)
{
    const uint32_t n = 64;
    double sum = 0.0, seed_sum = 0.0, worst = 0.0, local[3];
    for (uint32_t r = 0; r < 2 * n; r++) {
        for (uint32_t c = 0; c < 2 * n; c++) {
            if (alpi_hemicube_pixel(n, c, r, local)) {
                const double r2 = local[0] * local[0] + local[1] * local[1] + local[2] * local[2];
                const double middle = local[2] / (r2 * r2) * 4.0 / ((double)n * n) / ALPI_PI;
                worst = fmax(worst, fabs(middle / alpi_hemicube_weight(n, c, r) - 1.0));
                sum += middle;
                seed_sum += local[2] / r2;
            }
        }
    }
    ASSERT_NEAR(sum, 1.00013, 5e-6);
    ASSERT_NEAR(worst, 0.00065, 5e-6);
    assert_true(alpi_hemicube_pixel(n, n, n, local));
    ASSERT_NEAR(1.0 / seed_sum / alpi_hemicube_weight(n, n, n), 0.65, 0.01);
    assert_true(alpi_hemicube_pixel(n, n / 2, n / 2, local));
    const double r2 = local[0] * local[0] + local[1] * local[1] + local[2] * local[2];
    ASSERT_NEAR(1.0 / r2 / seed_sum / alpi_hemicube_weight(n, n / 2, n / 2), 1.9, 0.05);
}

/// Each pixel of the five faces is in one packet, with its weight and its direction; pixels of a
/// packet are neighbours.
TEST(packets_hold_every_pixel_once)
{
    static const uint32_t resolutions[] = {2, 4, 6, 10, 32};
    static uint8_t seen[64 * 64];
    for (int k = 0; k < 5; k++) {
        const uint32_t n = resolutions[k];
        alpi_hemicube *cube = NULL;
        uint32_t count = 0;
        double sum = 0.0;
        memset(seen, 0, sizeof seen);
        ASSERT_OK(context, alpi_hemicube_create(context, n, &cube));
        for (uint32_t p = 0; p < cube->packet_count; p++) {
            const alpi_hemicube_packet *packet = &cube->packets[p];
            assert_true((packet->active & 1u) != 0);
            for (int i = 0; i < ALPI_PACKET; i++) {
                const uint32_t c = packet->column[i], r = packet->row[i];
                double d[3];
                if ((packet->active >> i & 1u) == 0) {
                    assert_true(cube->weights[p][i] == 0.0f);
                    continue;
                }
                assert_true(alpi_hemicube_pixel(n, c, r, d));
                assert_int_equal(seen[r * 2 * n + c]++, 0);
                assert_true(cube->weights[p][i] == (float)alpi_hemicube_weight(n, c, r));
                const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
                ASSERT_NEAR(packet->x[i], d[0] / length, 6e-8); // half a float step
                ASSERT_NEAR(packet->y[i], d[1] / length, 6e-8);
                ASSERT_NEAR(packet->z[i], d[2] / length, 6e-8);
                assert_true(c - packet->column[0] < 4 && r - packet->row[0] < 2);
                sum += (double)cube->weights[p][i];
                count++;
            }
        }
        assert_int_equal(count, 3 * n * n);
        ASSERT_NEAR(sum, 1.0, 6e-8); // as each weight
        alpi_hemicube_destroy(cube);
    }
}

/// Packets that are traced in pairs look through 4 × 4 pixels.
TEST(pairs_of_packets_are_squares)
{
    alpi_hemicube *cube = NULL;
    ASSERT_OK(context, alpi_hemicube_create(context, 64, &cube));
    assert_int_equal(cube->packet_count % 2, 0);
    for (uint32_t p = 0; p < cube->packet_count; p += 2) {
        const alpi_hemicube_packet *upper = &cube->packets[p], *lower = upper + 1;
        assert_int_equal(lower->column[0], upper->column[0]);
        assert_int_equal(lower->row[0], upper->row[0] + 2);
    }
    alpi_hemicube_destroy(cube);
}

/// Directions of the faces' middles and of one pixel beside each edge of the front.
TEST(faces_lie_as_the_cross_shows)
{
    static const struct {
        uint32_t column, row;
        double local[3];
    } expected[] = {
        {3, 3, {-0.25, 0.25, 1.0}},  {4, 4, {0.25, -0.25, 1.0}}, {5, 3, {0.75, 0.25, 1.0}},
        {6, 3, {1.0, 0.25, 0.75}},   {7, 4, {1.0, -0.25, 0.25}}, {1, 3, {-1.0, 0.25, 0.75}},
        {0, 5, {-1.0, -0.75, 0.25}}, {3, 1, {-0.25, 1.0, 0.75}}, {4, 0, {0.25, 1.0, 0.25}},
        {3, 6, {-0.25, -1.0, 0.75}}, {5, 7, {0.75, -1.0, 0.25}}};
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++) {
        double local[3];
        assert_true(alpi_hemicube_pixel(4, expected[i].column, expected[i].row, local));
        for (int k = 0; k < 3; k++) {
            assert_true(local[k] == expected[i].local[k]);
        }
    }
    double local[3];
    assert_false(alpi_hemicube_pixel(4, 1, 1, local));
    assert_false(alpi_hemicube_pixel(4, 6, 7, local));
}

static void assert_frame(const alpi_hemicube_frame *f, vec3 normal)
{
    const vec3 right = vec3_cross(f->forward, f->up); // as seen by who looks forward
    ASSERT_NEAR(vec3_length(vec3_sub(right, f->right)), 0.0, 1e-6);
    assert_true(vec3_length(vec3_sub(f->forward, normal)) == 0.0f);
    ASSERT_NEAR(vec3_dot(f->right, f->up), 0.0, 1e-6);
    ASSERT_NEAR(vec3_length(f->up), 1.0, 1e-6);
}

TEST(frames_are_orthonormal_and_not_mirrored)
{
    static const vec3 normals[] = {
        {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {-1, 0, 0}, {0.48f, -0.6f, 0.64f}};
    for (int i = 0; i < 7; i++) {
        const alpi_hemicube_frame still = alpi_hemicube_frame_about(normals[i], 0.0f);
        const alpi_hemicube_frame turned = alpi_hemicube_frame_about(normals[i], 0.5f);
        const alpi_hemicube_frame upright = alpi_hemicube_frame_upright(normals[i]);
        assert_frame(&still, normals[i]);
        assert_frame(&turned, normals[i]);
        assert_frame(&upright, normals[i]);
        ASSERT_NEAR(vec3_dot(still.right, turned.right), cos(0.5), 1e-6);
        ASSERT_NEAR(vec3_dot(still.up, turned.right), sin(0.5), 1e-6);
        assert_true(fabsf(normals[i].y) == 1.0f ? upright.up.z == -1.0f : upright.up.y > 0.0f);
        ASSERT_NEAR(upright.right.y, 0.0, 1e-7);
    }
}

TEST(other_resolutions_are_refused)
{
    static const uint32_t resolutions[] = {0, 1, 7, 1026, UINT32_MAX};
    for (int i = 0; i < 5; i++) {
        alpi_hemicube *cube = NULL;
        assert_int_equal(alpi_hemicube_create(context, resolutions[i], &cube),
                         ALP_ERROR_INVALID_ARGUMENT);
        assert_null(cube);
        assert_non_null(strstr(alp_context_message(context), "even number from 2 to 1024"));
    }
    alpi_hemicube_destroy(NULL);
}

TEST(lack_of_memory_is_told)
{
    int left;
    alp_context *failing = test_context_failing(&left);
    alpi_hemicube *cube = NULL;
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int allowed = 0;
    for (; result != ALP_OK && allowed < 10; allowed++) {
        left = allowed;
        result = alpi_hemicube_create(failing, 6, &cube);
        assert_true(result == ALP_OK || (result == ALP_ERROR_OUT_OF_MEMORY && cube == NULL));
    }
    assert_true(result == ALP_OK && allowed == 5); // four allocations
    alpi_hemicube_destroy(cube);
    alp_context_destroy(failing);
}
