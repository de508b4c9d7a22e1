// SPDX-License-Identifier: MIT
// Dilation: every texel gets the value of the nearest covered one, coverage stays.
#include "test_support.h"

#include "maps/lightmap.h"

#include <stdlib.h>

enum { WIDTH = 23, HEIGHT = 17 };

TEST_WITH_CONTEXT(nearest_value_spreads, 1)
{
    static float page[HEIGHT][WIDTH][4];
    memset(page, 0, sizeof page);
    const int seeds[][2] = {{3, 4}, {20, 2}, {11, 15}};
    for (int s = 0; s < 3; s++) {
        float *pixel = page[seeds[s][1]][seeds[s][0]];
        pixel[0] = (float)(s + 1);
        pixel[1] = pixel[2] = 0.5f;
        pixel[3] = 1.0f;
    }
    ASSERT_OK(context, alpi_dilate(context, page[0][0], WIDTH, HEIGHT));
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            int best = 1000, value = (int)page[y][x][0] - 1;
            for (int s = 0; s < 3; s++) {
                int distance = abs(x - seeds[s][0]) + abs(y - seeds[s][1]);
                best = distance < best ? distance : best;
            }
            assert_in_range(value, 0, 2);
            assert_int_equal(abs(x - seeds[value][0]) + abs(y - seeds[value][1]), best);
            assert_true(page[y][x][1] == 0.5f && page[y][x][2] == 0.5f);
            assert_true((page[y][x][3] > 0.0f) == (best == 0));
        }
    }
}

TEST_WITH_CONTEXT(an_empty_page_stays_empty, 1)
{
    float page[4][4] = {{0}};
    page[2][0] = 3.0f; // a value without coverage is no seed
    ASSERT_OK(context, alpi_dilate(context, page[0], 2, 2));
    assert_true(page[0][0] == 0.0f && page[2][0] == 3.0f && page[3][3] == 0.0f);
}
