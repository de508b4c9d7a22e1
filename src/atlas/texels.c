// SPDX-License-Identifier: MIT
// Covered texels as receivers: where each lies on the surface, and how much of it.
#include "atlas/stages.h"

#include "base/memory.h"

#include <math.h>

typedef struct texel_writer {
    const alp_atlas *atlas;
    alpi_texels *texels;
    uint32_t count;
} texel_writer;

/// Barycentrics of corners 1 and 2 at a point in texels, inside the triangle.
static void find_barycentrics(const alp_atlas *atlas, uint32_t triangle, double x, double y,
                              double b[2])
{
    const float(*uv)[2] = (const float(*)[2])atlas->corner_uvs[triangle];
    double p[3][2];
    for (int k = 0; k < 3; k++) {
        p[k][0] = (double)uv[k][0] * atlas->info.width;
        p[k][1] = (double)uv[k][1] * atlas->info.height;
    }
    double e1x = p[1][0] - p[0][0], e1y = p[1][1] - p[0][1];
    double e2x = p[2][0] - p[0][0], e2y = p[2][1] - p[0][1];
    double dx = x - p[0][0], dy = y - p[0][1];
    double area = e1x * e2y - e1y * e2x; // not 0: the triangle has a piece in the texel
    b[0] = fmin(fmax((dx * e2y - dy * e2x) / area, 0.0), 1.0);
    b[1] = fmin(fmax((e1x * dy - e1y * dx) / area, 0.0), 1.0);
    double sum = b[0] + b[1];
    if (sum > 1.0) {
        b[0] /= sum;
        b[1] /= sum;
    }
}

/// Position, geometric normal and shading normal at barycentrics of a triangle.
static void place_receiver(const alp_scene *scene, uint32_t triangle, const double b[2],
                           alpi_receivers *receivers, uint32_t index)
{
    const uint32_t *v = scene->triangles[triangle];
    const double weight[3] = {1.0 - b[0] - b[1], b[0], b[1]};
    double normal[3];
    for (int axis = 0; axis < 3; axis++) {
        double position = 0.0;
        normal[axis] = 0.0;
        for (int k = 0; k < 3; k++) {
            position += weight[k] * (double)scene->positions[v[k]][axis];
            normal[axis] += weight[k] * (double)scene->normals[v[k]][axis];
        }
        receivers->positions[index][axis] = (float)position;
    }
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    vec3 geometric = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    vec3 shading = {(float)normal[0], (float)normal[1], (float)normal[2]};
    shading = vec3_normalize_or(shading, geometric);
    if (!(vec3_dot(shading, geometric) > 0.0f)) {
        shading = geometric; // a hemisphere that points into the surface sees nothing
    }
    vec3_store(receivers->geometric_normals[index], geometric);
    vec3_store(receivers->shading_normals[index], shading);
}

static alp_result write_row(void *user, const alpi_row *row)
{
    texel_writer *w = user;
    alpi_texels *texels = w->texels;
    for (uint32_t x = row->first; x <= row->last; x++) {
        const alpi_cell *cell = &row->cells[x];
        if (cell->triangle == ALPI_NONE) {
            continue;
        }
        uint32_t i = w->count++;
        double b[2];
        find_barycentrics(w->atlas, cell->triangle, cell->x, cell->y, b);
        texels->pages[i] = row->page;
        texels->pixels[i][0] = (uint16_t)x;
        texels->pixels[i][1] = (uint16_t)row->y;
        texels->triangles[i] = cell->triangle;
        texels->barycentrics[i][0] = (float)b[0];
        texels->barycentrics[i][1] = (float)b[1];
        texels->areas[i] = (float)cell->area;
        texels->coverages[i] = (float)fmin(cell->coverage, 1.0);
        texels->charts[i] = w->atlas->triangle_charts[cell->triangle];
        texels->page_first[row->page + 1] = w->count;
        place_receiver(w->atlas->scene, cell->triangle, b, &texels->receivers, i);
    }
    return ALP_OK;
}

static alp_result create_texels(const alp_atlas *atlas, alpi_texels *texels)
{
    alp_context *context = atlas->context;
    if (atlas->info.texels >= UINT32_MAX) {
        return alpi_fail(context, ALP_ERROR_LIMIT,
                         "%s: %llu texels are more than 2^32; use fewer texels per metre",
                         atlas->scene->name, (unsigned long long)atlas->info.texels);
    }
    texels->count = (uint32_t)atlas->info.texels;
    ALPI_TRY_NEW(context, texels->pages, texels->count);
    ALPI_TRY_NEW(context, texels->pixels, texels->count);
    ALPI_TRY_NEW(context, texels->triangles, texels->count);
    ALPI_TRY_NEW(context, texels->barycentrics, texels->count);
    ALPI_TRY_NEW(context, texels->areas, texels->count);
    ALPI_TRY_NEW(context, texels->coverages, texels->count);
    ALPI_TRY_NEW(context, texels->charts, texels->count);
    ALPI_TRY_NEW(context, texels->page_first, (size_t)atlas->info.pages + 1);
    ALP_TRY(alpi_receivers_create(context, texels->count, &texels->receivers));
    texel_writer writer = {.atlas = atlas, .texels = texels};
    ALP_TRY(alpi_raster(atlas, 0, atlas->info.pages, write_row, &writer));
    for (uint32_t p = 0; p < atlas->info.pages; p++) { // pages without texels end where they begin
        if (texels->page_first[p + 1] < texels->page_first[p]) {
            texels->page_first[p + 1] = texels->page_first[p];
        }
    }
    return ALP_OK;
}

alp_result alpi_texels_create(const alp_atlas *atlas, alpi_texels *texels)
{
    *texels = (alpi_texels){0};
    alp_result result = create_texels(atlas, texels);
    if (result != ALP_OK) {
        alpi_texels_destroy(atlas->context, texels);
    }
    return result;
}

void alpi_texels_destroy(alp_context *context, alpi_texels *texels)
{
    alpi_release(context, texels->pages);
    alpi_release(context, texels->pixels);
    alpi_release(context, texels->triangles);
    alpi_release(context, texels->barycentrics);
    alpi_release(context, texels->areas);
    alpi_release(context, texels->coverages);
    alpi_release(context, texels->charts);
    alpi_release(context, texels->page_first);
    alpi_receivers_destroy(context, &texels->receivers);
    *texels = (alpi_texels){0};
}
