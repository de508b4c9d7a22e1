// SPDX-License-Identifier: MIT
// Floors of several tiles under walls and shelves: stitching brings no light to the dark side.
#include "boxes.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 128, MESHES = 3 };

typedef struct box {
    float low[3], high[3];
} box;

typedef struct room {
    float corners[MESHES][8][3];
    alp_mesh meshes[MESHES];
    uint32_t count;
} room;

static void add(room *r, const float corners[][3], uint32_t vertices,
                const uint32_t (*triangles)[3], uint32_t count)
{
    alp_mesh *mesh = &r->meshes[r->count];
    memcpy(r->corners[r->count], corners, vertices * sizeof *corners);
    *mesh = (alp_mesh){.positions = &r->corners[r->count++][0][0],
                       .indices = &triangles[0][0],
                       .vertex_count = vertices,
                       .triangle_count = count,
                       .base_color = {0.7f, 0.7f, 0.7f}};
}

/// Two tiles of 2 m that meet at x = 0, and a box.
static void make_room(room *r, const box *wall)
{
    static const uint32_t quad[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const float first[4][3] = {{-2, 0, -1}, {-2, 0, 1}, {0, 0, 1}, {0, 0, -1}};
    const float second[4][3] = {{0, 0, -1}, {0, 0, 1}, {2, 0, 1}, {2, 0, -1}};
    float corners[8][3];
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 3; k++) {
            corners[i][k] = wall->low[k] + CUBE[i][k] * (wall->high[k] - wall->low[k]);
        }
    }
    *r = (room){.count = 0};
    add(r, first, 4, quad, 2);
    add(r, second, 4, quad, 2);
    add(r, (const float(*)[3])corners, 8, CUBE_TRIANGLES, 12);
}

/// A lamp hangs over the first tile.
static alp_lightmap *bake(alp_context *context, const alp_scene *scene, bool stitch,
                          alp_bake_report *report)
{
    alp_lamp lamp = alp_lamp_default();
    lamp.position[0] = -1.0f;
    lamp.position[1] = 1.0f;
    lamp.intensity = 100.0f;
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = SIZE;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.maps = ALP_MAP_LIGHT | ALP_MAP_AO;
    options.occlusion.samples = 64;
    options.light.bounces = 0;
    options.light.samples = 64;
    options.light.lighting.lamps = &lamp;
    options.light.lighting.lamp_count = 1;
    options.stitch = stitch;
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, report));
    return lightmap;
}

/// @return samples' length in metres that was stitched
static double expect_equal(alp_context *context, const alp_scene *scene, unsigned maps)
{
    alp_bake_report report;
    alp_lightmap *on = bake(context, scene, true, &report),
                 *off = bake(context, scene, false, &report);
    for (uint32_t page = 0; page < alp_lightmap_page_count(on); page++) {
        for (unsigned map = 1; map != 0 && map <= maps; map *= 2) {
            uint32_t width, height;
            if ((maps & map) == 0) {
                continue;
            }
            const float *a = alp_lightmap_map_page(on, (alp_map)map, page, &width, &height);
            const float *b = alp_lightmap_map_page(off, (alp_map)map, page, &width, &height);
            assert_memory_equal(a, b, sizeof(float) * 4 * width * height);
        }
    }
    alp_lightmap_destroy(on);
    alp_lightmap_destroy(off);
    return report.seams.length;
}

static double stitched_length(alp_context *context, const box *wall)
{
    room r;
    alp_scene *scene = NULL;
    make_room(&r, wall);
    ASSERT_OK(context, alp_scene_create_from_meshes(context, r.meshes, r.count, &scene));
    const double length = expect_equal(context, scene, ALP_MAP_LIGHT | ALP_MAP_AO);
    alp_scene_destroy(scene);
    return length;
}

TEST_WITH_CONTEXT(walls_part_their_floor, 2)
{
    // A texel is about 3 cm: walls thinner and thicker than that, on the seam and beside it.
    const box walls[] = {{{-0.005f, 0, -1.5f}, {0.005f, 2, 1.5f}},
                         {{-0.02f, 0, -1.5f}, {0.02f, 2, 1.5f}},
                         {{-0.05f, 0, -1.5f}, {0.05f, 2, 1.5f}},
                         {{0.01f, 0, -1.5f}, {0.03f, 2, 1.5f}},
                         {{-0.02f, 0, -1.5f}, {-0.01f, 2, 1.5f}}};
    for (size_t i = 0; i < sizeof walls / sizeof *walls; i++) {
        ASSERT_NEAR(stitched_length(context, &walls[i]), 0.0, 1e-9);
    }
}

/// A shelf 5 mm above the floor, over half of the seam: nobody sees the floor below.
TEST_WITH_CONTEXT(a_shelf_over_a_seam, 2)
{
    const box shelf = {{-0.2f, 0.005f, -1.5f}, {0.01f, 1, 0.0f}};
    room r;
    alp_scene *scene = NULL;
    make_room(&r, &shelf);
    ASSERT_OK(context, alp_scene_create_from_meshes(context, r.meshes, r.count, &scene));
    alp_bake_report report;
    alp_lightmap_destroy(bake(context, scene, true, &report));
    ASSERT_NEAR(report.seams.length, 1.0, 0.04); // the other half, but for a texel
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(the_reported_wall, 2)
{
    const char *path = test_shared("scenes/reports/wall_on_tiles.glb");
    if (path == NULL) {
        skip();
    }
    alp_scene *scene = test_load(context, path);
    ASSERT_NEAR(expect_equal(context, scene, ALP_MAP_LIGHT), 0.0, 1e-9);
    alp_scene_destroy(scene);
}
