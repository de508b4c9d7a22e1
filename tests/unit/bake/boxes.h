// SPDX-License-Identifier: MIT
// What tests of baking objects share: a cube, options for small maps, the range of a map.
#ifndef BOXES_H
#define BOXES_H

#include "test_support.h"

#include <math.h>

/// The unit cube, wound to be seen from outside.
static const float CUBE[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1},
                                 {0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}};
static const uint32_t CUBE_TRIANGLES[12][3] = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6},
                                               {0, 4, 5}, {0, 5, 1}, {1, 5, 6}, {1, 6, 2},
                                               {2, 6, 7}, {2, 7, 3}, {3, 7, 4}, {3, 4, 0}};

static inline alp_bake_options small_options(void)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = 64;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.occlusion.samples = 64;
    options.occlusion.distance = 2.0f;
    return options;
}

/// Smallest and largest value of the covered texels.
static inline void find_range(const alp_lightmap *lightmap, float *low, float *high)
{
    uint32_t width, height;
    const float *page = alp_lightmap_page(lightmap, 0, &width, &height);
    *low = INFINITY;
    *high = -INFINITY;
    for (size_t i = 0; i < (size_t)width * height; i++) {
        if (page[4 * i + 3] > 0.0f) {
            *low = fminf(*low, page[4 * i]);
            *high = fmaxf(*high, page[4 * i]);
        }
    }
    assert_true(*low <= *high); // something was baked
}

#endif
