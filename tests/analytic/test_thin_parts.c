// SPDX-License-Identifier: MIT
// Light comes through no thin part: a sun straight above a gazebo of thin posts, rails and roof
// reaches exactly what rays of the brute force say it may.
#include "test_support.h"

#include "maps/lightmap.h"
#include "scene/builtin/mesh_builder.h"
#include "trace/trace.h"

#include <math.h>

enum { SIZE = 256, POINTS = 64, ILLUMINANCE = 10, EVERY = 7 };

/// What a point just above a surface has straight above it.
typedef enum above { ABOVE_SKY, ABOVE_FRONT, ABOVE_BACK } above;

static above look_up(const alp_scene *scene, vec3 position, vec3 normal, float offset)
{
    alpi_rays rays;
    alpi_hits hits;
    alpi_rays_clear(&rays);
    alpi_rays_set(&rays, 0, vec3_mad(position, offset, normal), (vec3){0, 1, 0}, INFINITY);
    alpi_brute_force_nearest(scene, &rays, 1u, (alpi_trace_filter){0}, &hits);
    if (hits.triangle[0] == ALPI_NONE) {
        return ABOVE_SKY;
    }
    vec3 c[3];
    alpi_triangle_corners(scene, hits.triangle[0], c);
    const vec3 none = {0, 0, 0};
    return vec3_triangle_normal(c[0], c[1], c[2], none).y > 0.0f ? ABOVE_BACK : ABOVE_FRONT;
}

/// Texels of a bake, by what they ought to be.
typedef struct tally {
    uint32_t away, hidden, open, partly;
} tally;

static void check_texel(const alp_lightmap *map, uint32_t t, tally *found)
{
    uint32_t width;
    const float *page =
        alp_lightmap_map_page(map, ALP_MAP_LIGHT, map->texels.pages[t], &width, NULL);
    const uint16_t *at = map->texels.pixels[t];
    const double value = (double)page[4 * ((size_t)at[1] * width + at[0])];
    const alpi_receivers receivers = alpi_texels_receivers(&map->texels);
    float square[POINTS][2];
    alpi_receiver_point points[POINTS];
    for (int i = 0; i < POINTS; i++) { // an even grid: independent of the bake's
        square[i][0] = ((float)(i % 8) + 0.5f) / 8.0f;
        square[i][1] = ((float)(i / 8) + 0.5f) / 8.0f;
    }
    receivers.place(receivers.user, t, POINTS, (const float(*)[2])square, points);
    double steepest = -1.0, flattest = 1.0;
    int open = 0;
    for (int i = 0; i < POINTS; i++) {
        const double up =
            fmin((double)points[i].geometric_normal.y, (double)points[i].shading_normal.y);
        steepest = fmax(steepest, up);
        flattest = fmin(flattest, up);
        const above what =
            look_up(map->scene, points[i].position, points[i].geometric_normal, points[i].offset);
        if (what == ABOVE_BACK) {
            return; // some of it is inside something, and takes after its neighbours
        }
        open += what == ABOVE_SKY;
    }
    if (steepest <= 0.0) {
        assert_true(value == 0.0); // turned away, by every point
        found->away++;
    } else if (open == 0) {
        // What the grid misses is less than a cell of it and its neighbours.
        assert_true(value <= 4.0 / POINTS * ILLUMINANCE);
        found->hidden++;
    } else if (open == POINTS && flattest > 0.0) {
        assert_true(value >= 0.8 * ILLUMINANCE * flattest); // no shadow either where none falls
        found->open++;
    } else {
        found->partly++;
    }
}

TEST_WITH_CONTEXT(no_light_through_a_gazebo, 2)
{
    const char *path = test_shared("scenes/architecture/gazebo.obj");
    if (path == NULL) {
        skip();
    }
    alp_scene *scene = test_load(context, path);
    alp_bake_options o = alp_bake_options_default();
    o.maps = ALP_MAP_LIGHT;
    o.atlas.size = SIZE;
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.light.bounces = 0;
    o.light.lighting.sun = (alp_sun_options){
        .elevation = (float)M_PI_2, .illuminance = ILLUMINANCE, .color = {1.0f, 1.0f, 1.0f}};
    alp_lightmap *map = NULL;
    ASSERT_OK(context, alp_bake(scene, &o, &map, NULL));
    tally found = {0};
    for (uint32_t t = 0; t < map->texels.count; t += EVERY) {
        check_texel(map, t, &found);
    }
    print_message("%u texels turned away, %u hidden, %u open, %u in part\n", found.away,
                  found.hidden, found.open, found.partly);
    assert_true(found.away > 1000 && found.hidden > 500 && found.open > 500);
    alp_lightmap_destroy(map);
    alp_scene_destroy(scene);
}
