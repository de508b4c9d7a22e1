// SPDX-License-Identifier: MIT
// Square to direction: the stated densities, held to closed forms and to even histograms.
#include "test_support.h"

#include "base/warp.h"

enum { GRID = 512 }; // sums over it err by about GRID^-1.5, where the hemisphere meets its rim
#define CONES 5
static const double CONE_COSINES[CONES] = {0.0, 0.25, 0.5, 0.9, 0.99};

/// Centre of cell (x, y) of a GRID × GRID square.
static vec2 grid_point(int x, int y)
{
    return (vec2){((float)x + 0.5f) / GRID, ((float)y + 0.5f) / GRID};
}

typedef struct moments {
    double x, y, z, zz;
} moments;

static moments moments_of(bool uniform, double cosine)
{
    moments m = {0.0, 0.0, 0.0, 0.0};
    float sin2 = (float)(1.0 - cosine * cosine);
    for (int y = 0; y < GRID; y++) {
        for (int x = 0; x < GRID; x++) {
            vec2 u = grid_point(x, y);
            vec3 d =
                uniform ? alpi_warp_uniform_cone(u, (float)cosine) : alpi_warp_cosine_cone(u, sin2);
            ASSERT_NEAR(vec3_length(d), 1.0, 1e-6);
            assert_true((double)d.z >= cosine - 1e-6);
            m.x += (double)d.x / (GRID * GRID);
            m.y += (double)d.y / (GRID * GRID);
            m.z += (double)d.z / (GRID * GRID);
            m.zz += (double)d.z * (double)d.z / (GRID * GRID);
        }
    }
    return m;
}

TEST(cosine_cones_have_their_moments)
{
    for (int i = 0; i < CONES; i++) {
        double c = CONE_COSINES[i];
        moments m = moments_of(false, c); // density cosθ / (π sin²θmax)
        ASSERT_NEAR(m.x, 0.0, 1e-6);
        ASSERT_NEAR(m.y, 0.0, 1e-6);
        ASSERT_NEAR(m.z, 2.0 / 3.0 * (1.0 - c * c * c) / (1.0 - c * c), 1e-4);
        ASSERT_NEAR(m.zz, (1.0 + c * c) / 2.0, 1e-4);
    }
}

TEST(uniform_cones_have_their_moments)
{
    for (int i = 0; i < CONES; i++) {
        double c = CONE_COSINES[i];
        moments m = moments_of(true, c); // density 1 / (2π (1 − cosθmax))
        ASSERT_NEAR(m.x, 0.0, 1e-6);
        ASSERT_NEAR(m.y, 0.0, 1e-6);
        ASSERT_NEAR(m.z, (1.0 + c) / 2.0, 1e-4);
        ASSERT_NEAR(m.zz, (1.0 + c + c * c) / 3.0, 1e-4);
    }
}

/// Counts directions in boxes of equal probability: `rank` is the share of the cone inside the
/// direction's own angle, and the azimuth is even.
static void assert_even(bool uniform, double cosine)
{
    enum { RINGS = 8, SECTORS = 16 };
    static int count[RINGS][SECTORS];
    memset(count, 0, sizeof count);
    double sin2 = 1.0 - cosine * cosine;
    for (int y = 0; y < GRID; y++) {
        for (int x = 0; x < GRID; x++) {
            vec3 d = uniform ? alpi_warp_uniform_cone(grid_point(x, y), (float)cosine)
                             : alpi_warp_cosine_cone(grid_point(x, y), (float)sin2);
            double across = (double)d.x * (double)d.x + (double)d.y * (double)d.y;
            double rank = uniform ? (1.0 - (double)d.z) / (1.0 - cosine) : across / sin2;
            int ring = (int)(rank * RINGS),
                sector = (int)((atan2((double)d.y, (double)d.x) / (2.0 * ALPI_PI) + 0.5) * SECTORS);
            count[ring < RINGS ? ring : RINGS - 1][sector < SECTORS ? sector : 0]++;
        }
    }
    const double expected = (double)GRID * GRID / (RINGS * SECTORS);
    for (int ring = 0; ring < RINGS; ring++) {
        for (int sector = 0; sector < SECTORS; sector++) {
            ASSERT_NEAR(count[ring][sector] / expected, 1.0, 0.06); // a grid cuts the borders
        }
    }
}

TEST(histograms_are_even)
{
    for (int i = 0; i < CONES; i++) {
        assert_even(false, CONE_COSINES[i]);
        assert_even(true, CONE_COSINES[i]);
    }
}

TEST(the_border_of_the_square_is_safe)
{
    const float edge[] = {0.0f, 0.25f, 0.5f, 1.0f - 0x1p-24f};
    for (int i = 0; i < 16; i++) {
        vec2 u = {edge[i % 4], edge[i / 4]};
        for (int k = 0; k < CONES; k++) {
            float c = (float)CONE_COSINES[k];
            vec3 a = alpi_warp_cosine_cone(u, 1.0f - c * c), b = alpi_warp_uniform_cone(u, c);
            ASSERT_NEAR(vec3_length(a), 1.0, 1e-6);
            ASSERT_NEAR(vec3_length(b), 1.0, 1e-6);
            assert_true(a.z >= 0.0f && b.z >= 0.0f);
        }
    }
}
