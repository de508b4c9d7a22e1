// SPDX-License-Identifier: MIT
#include "atlas_scenes.h"

#include "base/random.h"

#include <math.h>
#include <stdlib.h>

alp_scene *scene_of(alp_context *context, const float (*positions)[3], const float (*uvs)[2],
                    uint32_t vertex_count, const uint32_t (*indices)[3], uint32_t triangle_count)
{
    alp_mesh mesh = {.name = "thing",
                     .vertex_count = vertex_count,
                     .positions = &positions[0][0],
                     .uvs = uvs == NULL ? NULL : &uvs[0][0],
                     .triangle_count = triangle_count,
                     .indices = &indices[0][0],
                     .base_color = {0.5f, 0.5f, 0.5f}};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    return scene;
}

alp_scene *scene_cube(alp_context *context)
{
    float corner[8][3];
    for (int i = 0; i < 8; i++) {
        corner[i][0] = (i & 1) ? 1.0f : -1.0f;
        corner[i][1] = (i & 2) ? 1.0f : -1.0f;
        corner[i][2] = (i & 4) ? 1.0f : -1.0f;
    }
    static const uint32_t faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                          {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                          {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return scene_of(context, (const float(*)[3])corner, NULL, 8, faces, 12);
}

/// A lattice of (rows + 1) × (columns + 1) points, two triangles a square.
typedef struct lattice {
    uint32_t rows, columns;
    void (*place)(double row, double column, uint32_t extra, float position[3]);
    uint32_t extra;
} lattice;

static alp_scene *scene_of_lattice(alp_context *context, const lattice *l)
{
    uint32_t wide = l->columns + 1, vertices = wide * (l->rows + 1), count = 0;
    float(*positions)[3] = calloc(vertices, sizeof *positions);
    uint32_t(*indices)[3] = calloc(2 * (size_t)l->rows * l->columns, sizeof *indices);
    assert_true(positions != NULL && indices != NULL);
    for (uint32_t v = 0; v < vertices; v++) {
        l->place((double)(v / wide) / l->rows, (double)(v % wide) / l->columns, l->extra,
                 positions[v]);
    }
    for (uint32_t r = 0; r < l->rows; r++) {
        for (uint32_t c = 0; c < l->columns; c++) {
            uint32_t at = r * wide + c;
            uint32_t two[2][3] = {{at, at + wide, at + wide + 1}, {at, at + wide + 1, at + 1}};
            memcpy(indices[count], two, sizeof two);
            count += 2;
        }
    }
    alp_scene *scene = scene_of(context, (const float(*)[3])positions, NULL, vertices,
                                (const uint32_t(*)[3])indices, count);
    free(positions);
    free(indices);
    return scene;
}

static void place_on_sphere(double row, double column, uint32_t extra, float p[3])
{
    (void)extra;
    double theta = row * ALPI_PI, phi = (column < 1.0 ? column : 0.0) * 2.0 * ALPI_PI;
    double s = row > 0.0 && row < 1.0 ? sin(theta) : 0.0;
    p[0] = (float)(s * sin(phi));
    p[1] = (float)cos(theta);
    p[2] = (float)(s * cos(phi));
}

alp_scene *scene_sphere(alp_context *context, uint32_t rings, uint32_t segments)
{
    return scene_of_lattice(context, &(lattice){rings, segments, place_on_sphere, 0});
}

static void place_on_plane(double row, double column, uint32_t extra, float p[3])
{
    (void)extra;
    p[0] = (float)(2.0 * column - 1.0);
    p[1] = 0.0f;
    p[2] = (float)(2.0 * row - 1.0);
}

alp_scene *scene_plane(alp_context *context, uint32_t n)
{
    return scene_of_lattice(context, &(lattice){n, n, place_on_plane, 0});
}

static void place_on_spiral(double row, double column, uint32_t turns, float p[3])
{
    double angle = column * turns * 2.0 * ALPI_PI, radius = 2.0 - row;
    p[0] = (float)(radius * sin(angle));
    p[1] = (float)(0.3 * column * turns);
    p[2] = (float)(radius * cos(angle));
}

alp_scene *scene_spiral(alp_context *context, uint32_t turns)
{
    // From the outside inwards and counter-clockwise seen from above: the normals point up or down
    // together, and every turn lies over the one before.
    return scene_of_lattice(context, &(lattice){2, 16 * turns, place_on_spiral, turns});
}

alp_scene *scene_confetti(alp_context *context, uint32_t count)
{
    float(*positions)[3] = calloc(3 * (size_t)count, sizeof *positions);
    uint32_t(*indices)[3] = calloc(count, sizeof *indices);
    assert_true(positions != NULL && indices != NULL);
    for (uint32_t t = 0; t < count; t++) {
        double size = pow(10.0, -4.0 * keyed(t, 0));
        for (uint32_t k = 0; k < 3; k++) {
            for (uint32_t i = 0; i < 3; i++) {
                positions[3 * t + k][i] =
                    (float)(10.0 * keyed(t, 1 + i) + size * keyed(t, 10 + 3 * k + i));
            }
            indices[t][k] = 3 * t + k;
        }
    }
    alp_scene *scene = scene_of(context, (const float(*)[3])positions, NULL, 3 * count,
                                (const uint32_t(*)[3])indices, count);
    free(positions);
    free(indices);
    return scene;
}

alp_atlas *charts_of_size(alp_context *context, const alp_scene *scene, uint32_t size)
{
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_CHARTS;
    options.size = size;
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    return atlas;
}

void fill_point_grid(float (*square)[2])
{
    for (int i = 0; i < GRID_POINTS; i++) {
        square[i][0] = ((float)(i % POINT_GRID) + 0.5f) / POINT_GRID;
        square[i][1] = ((float)(i / POINT_GRID) + 0.5f) / POINT_GRID;
    }
}

double texel_area(const alp_atlas *atlas, uint32_t triangle)
{
    const float(*p)[2] = (const float(*)[2])atlas->corner_uvs[triangle];
    double ax = (double)p[1][0] - (double)p[0][0], ay = (double)p[1][1] - (double)p[0][1];
    double bx = (double)p[2][0] - (double)p[0][0], by = (double)p[2][1] - (double)p[0][1];
    return 0.5 * (ax * by - ay * bx) * atlas->info.width * atlas->info.height;
}

static alp_result count_overlaps(void *user, const alpi_band *band)
{
    uint32_t *count = user;
    for (uint32_t y = 0; y < band->end_row - band->first_row; y++) {
        for (uint32_t x = band->columns[y][0]; x < band->columns[y][1]; x++) {
            const alpi_cell *cell = &band->cells[(size_t)y * band->width + x];
            if (cell->triangle != ALPI_NONE && cell->other != ALPI_NONE) {
                __atomic_fetch_add(count, 1, __ATOMIC_RELAXED); // bands come from several workers
            }
        }
    }
    return ALP_OK;
}

uint32_t overlapping_texels(const alp_atlas *atlas)
{
    uint32_t count = 0;
    ASSERT_OK(atlas->context, alpi_raster(atlas, 0, atlas->info.pages, count_overlaps, &count));
    return count;
}

double keyed(uint32_t a, uint32_t b)
{
    return (double)alpi_unit_float(alpi_random_key(7, a, b));
}
