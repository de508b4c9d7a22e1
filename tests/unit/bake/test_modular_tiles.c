// SPDX-License-Identifier: MIT
// A floor of modular tiles of three sizes with side walls, below a roof: baked, its borders match.
#include "test_tiles.h"

#include <math.h>

enum { SIZE = 256, SIDE = 4 };

/// Rows of tiles of 1, ½, 2 and ½ m, each row begun with another: borders of rows are T-junctions.
static uint32_t make_tiles(test_tile *tiles)
{
    static const float widths[SIDE] = {1.0f, 0.5f, 2.0f, 0.5f};
    const float texels = 24.0f, deep = 0.2f; // a metre
    uint32_t count = 0;
    for (int z = 0; z < SIDE; z++) {
        float x = 0.0f, u = 4.0f, walls = 130.0f;
        const float v = 4.0f + 34.0f * (float)z, zf = (float)z;
        for (int i = 0; i < SIDE; i++) {
            const float w = widths[(i + z) % SIDE];
            tiles[count++] =
                (test_tile){{x, 0, zf}, {0, 0, 1}, {w, 0, 0}, {u, v}, {0, texels}, {w * texels, 0}};
            tiles[count++] =
                (test_tile){{x, 0, zf}, {0, -deep, 0}, {0, 0, 1}, {walls, v}, {5, 0}, {0, texels}};
            tiles[count++] = (test_tile){{x + w, 0, zf},  {0, 0, 1},   {0, -deep, 0},
                                         {walls + 10, v}, {0, texels}, {5, 0}};
            x += w;
            u += w * texels + 6.0f;
            walls += 20.0f;
        }
    }
    tiles[count++] =
        (test_tile){{0.7f, 0.6f, 0.6f}, {2, 0, 0}, {0, 0, 2}, {4, 150}, {48, 0}, {0, 48}};
    return count;
}

TEST_WITH_CONTEXT(borders_match, 2)
{
    test_tile tiles[TEST_TILE_LIMIT];
    const uint32_t count = make_tiles(tiles);
    alp_scene *scene = test_tiles_scene(context, tiles, count, SIZE);
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = SIZE;
    options.occlusion.samples = 256;
    for (int mode = 0; mode < 2; mode++) {
        alp_bake_report r;
        options.atlas.mode = mode == 0 ? ALP_ATLAS_KEEP : ALP_ATLAS_CHARTS;
        options.stitch = true;
        ASSERT_OK(context, alp_bake(scene, &options, NULL, &r));
        print_message(
            "tiles: %u edges, %.3g m; %.3g %%, 99 %% within %.3g %%, stitched %.3g %% and "
            "%.3g %%\n",
            r.seams.count, r.seams.length, 100.0 * r.seams.ao.mean, 100.0 * r.seams.ao.p99,
            100.0 * r.seams.ao.stitched_mean, 100.0 * r.seams.ao.stitched_p99);
        assert_true(r.seams.stitched && r.seconds_seams > 0.0);
        assert_true(r.seconds_atlas + r.seconds_build + r.seconds_bake + r.seconds_seams +
                        r.seconds_write <=
                    r.seconds_total);
        assert_true(r.seams.length >= 24.0 - 1e-3); // 3 borders of each of 4 rows, 3 between rows
        assert_true(r.seams.ao.stitched_mean < 0.01 && r.seams.ao.mean > r.seams.ao.stitched_mean);
        const alp_seam_error was = r.seams.ao;
        options.stitch = false;
        ASSERT_OK(context, alp_bake(scene, &options, NULL, &r));
        assert_true(!r.seams.stitched && r.seams.ao.mean == was.mean);
    }
    alp_scene_destroy(scene);
}
