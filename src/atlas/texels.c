// SPDX-License-Identifier: MIT
// Covered texels as receivers: where each lies on the surface, and how much of it.
#include "atlas/stages.h"

#include "base/memory.h"

#include <math.h>

/// What all texels of one triangle share: neighbouring texels mostly lie on the same one.
typedef struct carrier {
    uint32_t triangle;
    double x, y, e1x, e1y, e2x, e2y, area; // corner 0, edges and twice the area in texels
    double heights[3];                     // of the corners above the edges opposite, in texels
    double corner[3][3], normal[3][3];     // positions and shading normals
    vec3 place[3];                         // the corners as they are
    vec3 geometric;
} carrier;

typedef struct texel_writer {
    const alp_atlas *atlas;
    alpi_texels *texels;
    uint32_t count;
    carrier carrier;
} texel_writer;

static carrier load_carrier(const alp_atlas *atlas, uint32_t triangle)
{
    const alp_scene *scene = atlas->scene;
    double width = atlas->info.width, height = atlas->info.height;
    const float(*uv)[2] = (const float(*)[2])atlas->corner_uvs[triangle];
    carrier c = {
        .triangle = triangle, .x = (double)uv[0][0] * width, .y = (double)uv[0][1] * height};
    c.e1x = (double)uv[1][0] * width - c.x;
    c.e1y = (double)uv[1][1] * height - c.y;
    c.e2x = (double)uv[2][0] * width - c.x;
    c.e2y = (double)uv[2][1] * height - c.y;
    c.area = c.e1x * c.e2y - c.e1y * c.e2x; // not 0: the triangle has a piece in a texel
    c.heights[0] = fabs(c.area) / hypot(c.e2x - c.e1x, c.e2y - c.e1y);
    c.heights[1] = fabs(c.area) / hypot(c.e2x, c.e2y);
    c.heights[2] = fabs(c.area) / hypot(c.e1x, c.e1y);
    for (int k = 0; k < 3; k++) {
        uint32_t vertex = scene->triangles[triangle][k];
        for (int axis = 0; axis < 3; axis++) {
            c.corner[k][axis] = (double)scene->positions[vertex][axis];
            c.normal[k][axis] = (double)scene->normals[vertex][axis];
        }
    }
    alpi_triangle_corners(scene, triangle, c.place);
    c.geometric =
        vec3_triangle_normal(c.place[0], c.place[1], c.place[2], (vec3){0.0f, 1.0f, 0.0f});
    return c;
}

/// Moves a point that lies on an edge, or nearly, into the triangle: a twentieth of a texel towards
/// its centroid. What stands on a surface often stands on its edges, and modelled on a grid both
/// run through texel centres: a ray that starts a hair above such a point starts inside of what
/// stands there. (A sphere that rests on the diagonal of a square: .97 at the point of contact,
/// instead of 0.)
static void leave_edges(const carrier *c, double b[2])
{
    const double margin = 0.05; // texels; costs as much of the gradient, far below the noise
    const double weights[3] = {1.0 - b[0] - b[1], b[0], b[1]};
    double nearest = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        nearest = fmin(nearest, weights[k] * c->heights[k]);
    }
    if (nearest >= margin) {
        return;
    }
    double to_1 = 1.0 / 3.0 - b[0], to_2 = 1.0 / 3.0 - b[1];
    double length = hypot(to_1 * c->e1x + to_2 * c->e2x, to_1 * c->e1y + to_2 * c->e2y);
    double share = length > margin ? margin / length : 1.0;
    b[0] += share * to_1;
    b[1] += share * to_2;
}

/// Barycentrics of corners 1 and 2 at a point in texels, held inside the triangle.
static void find_barycentrics(const carrier *c, double x, double y, double b[2])
{
    double dx = x - c->x, dy = y - c->y;
    b[0] = fmin(fmax((dx * c->e2y - dy * c->e2x) / c->area, 0.0), 1.0);
    b[1] = fmin(fmax((c->e1x * dy - c->e1y * dx) / c->area, 0.0), 1.0);
    double sum = b[0] + b[1];
    if (sum > 1.0) {
        b[0] /= sum;
        b[1] /= sum;
    }
    leave_edges(c, b);
}

/// Position, geometric normal and shading normal at barycentrics of a triangle.
static void place_receiver(const carrier *c, const double b[2], alpi_point_array *points,
                           uint32_t index)
{
    const double weight[3] = {1.0 - b[0] - b[1], b[0], b[1]};
    float normal[3];
    for (int axis = 0; axis < 3; axis++) {
        points->positions[index][axis] =
            (float)(weight[0] * c->corner[0][axis] + weight[1] * c->corner[1][axis] +
                    weight[2] * c->corner[2][axis]);
        normal[axis] = (float)(weight[0] * c->normal[0][axis] + weight[1] * c->normal[1][axis] +
                               weight[2] * c->normal[2][axis]);
    }
    vec3 shading = vec3_normalize_or(vec3_load(normal), c->geometric);
    if (!(vec3_dot(shading, c->geometric) > 0.0f)) {
        shading = c->geometric; // a hemisphere that points into the surface sees nothing
    }
    vec3_store(points->geometric_normals[index], c->geometric);
    vec3_store(points->shading_normals[index], shading);
    points->offsets[index] = alpi_receiver_offset(vec3_load(points->positions[index]), c->place);
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
        if (w->carrier.triangle != cell->triangle) {
            w->carrier = load_carrier(w->atlas, cell->triangle);
        }
        double b[2];
        find_barycentrics(&w->carrier, cell->x, cell->y, b);
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
        place_receiver(&w->carrier, b, &texels->points, i);
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
    ALP_TRY(alpi_point_array_create(context, texels->count, &texels->points));
    texel_writer writer = {.atlas = atlas, .texels = texels, .carrier.triangle = ALPI_NONE};
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
    alpi_point_array_destroy(context, &texels->points);
    *texels = (alpi_texels){0};
}
