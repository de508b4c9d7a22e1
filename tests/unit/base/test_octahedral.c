// SPDX-License-Identifier: MIT
// The octahedral map: known points, there and back, no seams inside, equal areas on average.
#include "test_support.h"

#include "base/octahedral.h"

TEST(known_directions)
{
    static const float cases[][5] = {
        {0, 0, 1, 0.5f, 0.5f},       {1, 0, 0, 1.0f, 0.5f},     {-1, 0, 0, 0.0f, 0.5f},
        {0, 1, 0, 0.5f, 1.0f},       {0, -1, 0, 0.5f, 0.0f},    {0, 0, -1, 1.0f, 1.0f},
        {1, 1, 0, 0.75f, 0.75f},     {2, 1, -1, 0.875f, 0.75f}, {-2, 1, -1, 0.125f, 0.75f},
        {-2, -1, -1, 0.125f, 0.25f}, {1, 2, 1, 0.625f, 0.75f}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const vec2 uv = alpi_octahedral_encode(vec3_load(cases[i]));
        ASSERT_NEAR(uv.x, cases[i][3], 1e-6);
        ASSERT_NEAR(uv.y, cases[i][4], 1e-6);
    }
}

/// Every point of the square is a unit vector that maps back to it; at the rim, where two points
/// are one direction, the direction comes back.
TEST(there_and_back)
{
    enum { SIDE = 64 };
    for (int i = 0; i < SIDE * SIDE; i++) {
        const vec2 uv = {((float)(i % SIDE) + 0.5f) / SIDE, ((float)(i / SIDE) + 0.5f) / SIDE};
        const vec3 d = alpi_octahedral_decode(uv);
        const vec2 again = alpi_octahedral_encode(d);
        ASSERT_NEAR(vec3_length(d), 1.0, 1e-6);
        ASSERT_NEAR(again.x, uv.x, 1e-6);
        ASSERT_NEAR(again.y, uv.y, 1e-6);
    }
    for (int i = 0; i <= SIDE; i++) {
        const vec3 left = alpi_octahedral_decode((vec2){0.0f, (float)i / SIDE});
        const vec3 mirrored = alpi_octahedral_decode((vec2){0.0f, 1.0f - (float)i / SIDE});
        ASSERT_NEAR(vec3_length(vec3_sub(left, mirrored)), 0.0, 1e-6);
    }
}

/// The four corners are -z.
TEST(corners_are_below)
{
    for (int i = 0; i < 4; i++) {
        const vec3 d = alpi_octahedral_decode((vec2){(float)(i % 2), (float)(i / 2)});
        ASSERT_NEAR(d.z, -1.0, 1e-6);
    }
}
