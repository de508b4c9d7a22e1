// SPDX-License-Identifier: MIT
// Clusters become charts: projected on their plane and turned to the tightest box.
#include "atlas/box.h"
#include "atlas/stages.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>

/// Scratch that is kept from chart to chart.
typedef struct turner {
    alp_context *context;
    alpi_point *points, *hull;
    size_t point_capacity, hull_capacity;
} turner;

static void turner_destroy(turner *t)
{
    alpi_release(t->context, t->points);
    alpi_release(t->context, t->hull);
}

static void project_chart(alp_atlas *atlas, const alpi_chart *chart, const uint32_t *triangles,
                          const float normal[3])
{
    vec3 corner[3];
    alpi_triangle_corners(atlas->scene, triangles[chart->first], corner);
    alpi_plane plane = alpi_plane_make(vec3_load(normal), corner[0]);
    for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
        alpi_triangle_corners(atlas->scene, triangles[i], corner);
        for (int k = 0; k < 3; k++) {
            double x, y;
            alpi_plane_project(&plane, corner[k], &x, &y);
            atlas->corner_uvs[triangles[i]][k][0] = (float)x;
            atlas->corner_uvs[triangles[i]][k][1] = (float)y;
        }
    }
}

/// Gives a chart the area in its plane that its triangles have in the world: so the density that is
/// asked for is that of the curved charts too, in the mean.
static void scale_chart(alp_atlas *atlas, const alpi_chart *chart, const uint32_t *triangles)
{
    double world = 0.0, laid = 0.0;
    for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
        const float(*p)[2] = (const float(*)[2])atlas->corner_uvs[triangles[i]];
        const double ax = (double)p[1][0] - (double)p[0][0], ay = (double)p[1][1] - (double)p[0][1];
        const double bx = (double)p[2][0] - (double)p[0][0], by = (double)p[2][1] - (double)p[0][1];
        vec3 c[3];
        alpi_triangle_corners(atlas->scene, triangles[i], c);
        world += vec3_triangle_area(c[0], c[1], c[2]);
        laid += 0.5 * (ax * by - ay * bx);
    }
    const double scale = laid > 0.0 ? sqrt(world / laid) : 1.0;
    for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
        for (int k = 0; k < 6; k++) {
            float *value = &atlas->corner_uvs[triangles[i]][k / 2][k % 2];
            *value = (float)((double)*value * scale);
        }
    }
}

/// The corners of a chart that its hull can have: those at edges with no triangle of the chart
/// across (neighbours NULL: all).
static alp_result collect_points(const alp_atlas *atlas, const uint32_t (*neighbours)[3],
                                 const alpi_chart *chart, const uint32_t *triangles, turner *turn,
                                 size_t *count)
{
    *count = 0;
    for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
        uint32_t t = triangles[i];
        ALP_TRY(alpi_grow(turn->context, (void **)&turn->points, &turn->point_capacity, *count + 6,
                          sizeof *turn->points));
        for (int k = 0; k < 3; k++) {
            uint32_t across = neighbours == NULL ? ALPI_NONE : neighbours[t][k];
            if (across != ALPI_NONE &&
                atlas->triangle_charts[across] == atlas->triangle_charts[t]) {
                continue;
            }
            for (int end = 0; end < 2; end++) {
                const float *uv = atlas->corner_uvs[t][(k + end) % 3];
                turn->points[(*count)++] = (alpi_point){(double)uv[0], (double)uv[1]};
            }
        }
    }
    return ALP_OK;
}

/// Turns the coordinates of a chart to its tightest box, whose corner becomes the origin.
static alp_result turn_chart(alp_atlas *atlas, const uint32_t (*neighbours)[3], alpi_chart *chart,
                             const uint32_t *triangles, turner *turn)
{
    size_t count = 0;
    ALP_TRY(collect_points(atlas, neighbours, chart, triangles, turn, &count));
    ALP_TRY(alpi_grow(turn->context, (void **)&turn->hull, &turn->hull_capacity, 2 * count + 2,
                      sizeof *turn->hull));
    alpi_box box = alpi_tightest_box(turn->points, count, turn->hull);
    for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
        for (int k = 0; k < 3; k++) {
            float *uv = atlas->corner_uvs[triangles[i]][k];
            double u = (double)uv[0], v = (double)uv[1];
            double x = box.axis.x * u + box.axis.y * v - box.low_x;
            double y = box.axis.x * v - box.axis.y * u - box.low_y;
            uv[0] = (float)fmin(fmax(x, 0.0), box.width);
            uv[1] = (float)fmin(fmax(y, 0.0), box.height);
        }
    }
    chart->width = box.width;
    chart->height = box.height;
    return ALP_OK;
}

/// Lists the triangles of each cluster together, in the order of the scene.
static alp_result group_triangles(alp_atlas *atlas, const alpi_clusters *clusters,
                                  alpi_charts *charts)
{
    const alp_scene *scene = atlas->scene;
    ALPI_TRY_NEW(atlas->context, charts->triangles, scene->usable_count);
    ALP_TRY(alpi_grow(atlas->context, (void **)&charts->charts, &charts->capacity, clusters->count,
                      sizeof *charts->charts));
    charts->count = clusters->count;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        atlas->triangle_charts[t] = clusters->of_triangle[t];
        if (clusters->of_triangle[t] != ALPI_NONE) {
            charts->charts[clusters->of_triangle[t]].count++;
        }
    }
    uint32_t first = 0;
    for (uint32_t c = 0; c < charts->count; c++) {
        charts->charts[c].first = first;
        first += charts->charts[c].count;
        charts->charts[c].count = 0;
    }
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (clusters->of_triangle[t] != ALPI_NONE) {
            alpi_chart *chart = &charts->charts[clusters->of_triangle[t]];
            charts->triangles[chart->first + chart->count++] = t;
        }
    }
    return ALP_OK;
}

alp_result alpi_charts_turn(alp_atlas *atlas, const uint32_t (*neighbours)[3], alpi_charts *charts)
{
    turner turn = {.context = atlas->context};
    alp_result result = ALP_OK;
    for (uint32_t c = 0; c < charts->count && result == ALP_OK; c++) {
        scale_chart(atlas, &charts->charts[c], charts->triangles);
        result = turn_chart(atlas, neighbours, &charts->charts[c], charts->triangles, &turn);
        if (result == ALP_OK) {
            result = alpi_tick(atlas->context, "charts", c, charts->count);
        }
    }
    turner_destroy(&turn);
    return result;
}

alp_result alpi_charts_create(alp_atlas *atlas, const uint32_t (*neighbours)[3],
                              const alpi_clusters *clusters, alpi_charts *charts)
{
    *charts = (alpi_charts){0};
    ALP_TRY(group_triangles(atlas, clusters, charts));
    for (uint32_t c = 0; c < charts->count; c++) {
        project_chart(atlas, &charts->charts[c], charts->triangles, clusters->planes[c]);
    }
    return alpi_charts_turn(atlas, neighbours, charts);
}

void alpi_charts_destroy(alp_context *context, alpi_charts *charts)
{
    alpi_release(context, charts->charts);
    alpi_release(context, charts->triangles);
    *charts = (alpi_charts){0};
}
