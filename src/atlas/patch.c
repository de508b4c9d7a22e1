// SPDX-License-Identifier: MIT
// Triangles that are unwrapped together, and what their unwrapping is worth.
#include "atlas/patch.h"

#include "atlas/regions.h"

#include "base/angle.h"
#include "base/memory.h"

#include <math.h>

static uint32_t find(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

static void join(uint32_t *parent, uint32_t i, uint32_t j)
{
    const uint32_t a = find(parent, i), b = find(parent, j);
    parent[a < b ? b : a] = a < b ? a : b;
}

/// Index in `triangles`, or ALPI_NONE: the triangle is not of the patch.
static uint32_t find_slot(const alpi_patch_source *source, uint32_t triangle)
{
    if (triangle == ALPI_NONE) {
        return ALPI_NONE;
    }
    const uint32_t chart = source->charts[triangle];
    return chart == source->pair[0]   ? source->slots[triangle]
           : chart == source->pair[1] ? source->first_count + source->slots[triangle]
                                      : ALPI_NONE;
}

/// Joins the corners of triangles that share an edge, and numbers what comes out.
static void number_vertices(alpi_patch *patch, const alpi_patch_source *source, uint32_t *parent)
{
    for (uint32_t i = 0; i < 3 * patch->count; i++) {
        parent[i] = i;
    }
    for (uint32_t i = 0; i < patch->count; i++) {
        const uint32_t t = source->triangles[i];
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t j = find_slot(source, source->neighbours[t][k]);
            const bool inside = j != ALPI_NONE;
            patch->open[i] = patch->open[i] || !inside;
            if (inside && j > i) {
                const uint32_t back =
                    (uint32_t)alpi_edge_back(source->scene, source->neighbours, t, (int)k);
                join(parent, 3 * i + k, 3 * j + (back + 1) % 3);
                join(parent, 3 * i + (k + 1) % 3, 3 * j + back);
            }
        }
    }
    for (uint32_t i = 0; i < 3 * patch->count; i++) { // a vertex's first corner stands for it
        const uint32_t first = find(parent, i);
        patch->vertices[i / 3][i % 3] =
            first == i ? patch->vertex_count++ : patch->vertices[first / 3][first % 3];
    }
}

/// A triangle in a plane of its own.
static void flatten(const alp_scene *scene, uint32_t triangle, double flat[3])
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    const double u[3] = {(double)c[1].x - (double)c[0].x, (double)c[1].y - (double)c[0].y,
                         (double)c[1].z - (double)c[0].z};
    const double v[3] = {(double)c[2].x - (double)c[0].x, (double)c[2].y - (double)c[0].y,
                         (double)c[2].z - (double)c[0].z};
    const double long_u = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    flat[0] = long_u;
    flat[1] = flat[2] = 0.0;
    if (long_u > 0.0) {
        flat[1] = (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) / long_u;
        flat[2] = 2.0 * vec3_triangle_area(c[0], c[1], c[2]) / long_u;
    }
}

alp_result alpi_patch_create(alp_context *context, const alpi_patch_source *source,
                             alpi_patch *patch)
{
    *patch = (alpi_patch){.context = context, .count = source->count};
    ALPI_TRY_NEW(context, patch->vertices, source->count);
    ALPI_TRY_NEW(context, patch->open, source->count);
    ALPI_TRY_NEW(context, patch->flat, source->count);
    uint32_t *parent = ALPI_NEW(context, uint32_t, 3 * (size_t)source->count);
    if (parent == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    number_vertices(patch, source, parent);
    alpi_release(context, parent);
    for (uint32_t i = 0; i < source->count; i++) {
        flatten(source->scene, source->triangles[i], patch->flat[i]);
    }
    ALPI_TRY_NEW(context, patch->at, patch->vertex_count);
    return ALP_OK;
}

void alpi_patch_destroy(alpi_patch *patch)
{
    alpi_release(patch->context, patch->vertices);
    alpi_release(patch->context, patch->open);
    alpi_release(patch->context, patch->flat);
    alpi_release(patch->context, patch->at);
    *patch = (alpi_patch){0};
}

// --- what it is worth ----------------------------------------------------------------------------

/// Twice the area of a triangle in the world and as it is laid, and its L2 stretch: the root mean
/// square of the singular values of the map from the texture to the surface.
static double measure(const alpi_patch *patch, uint32_t i, double *world, double *laid)
{
    const double *flat = patch->flat[i];
    const double *p = patch->at[patch->vertices[i][0]], *q = patch->at[patch->vertices[i][1]];
    const double *r = patch->at[patch->vertices[i][2]];
    const double ax = q[0] - p[0], ay = q[1] - p[1], bx = r[0] - p[0], by = r[1] - p[1];
    *world = flat[0] * flat[2];
    *laid = ax * by - ay * bx;
    // Columns of that map: where a step along each axis of the texture leads in the flat triangle.
    const double xs = by * flat[0] - ay * flat[1], xt = ax * flat[1] - bx * flat[0];
    const double ys = -ay * flat[2], yt = ax * flat[2];
    return sqrt(0.5 * (xs * xs + xt * xt + ys * ys + yt * yt)) / *laid;
}

alpi_stretch alpi_patch_stretch(const alpi_patch *patch)
{
    alpi_stretch stretch = {0};
    double world_sum = 0.0, laid_sum = 0.0, square_sum = 0.0;
    for (uint32_t i = 0; i < patch->count; i++) {
        double world, laid;
        const double l2 = measure(patch, i, &world, &laid);
        if (!(laid > 0.0) || !(l2 < HUGE_VAL)) {
            stretch.flipped = true;
            return stretch;
        }
        stretch.worst = fmax(stretch.worst, l2);
        world_sum += world;
        laid_sum += laid;
        square_sum += l2 * l2 * world;
    }
    const double scale = sqrt(laid_sum / world_sum);
    stretch.worst *= scale;
    stretch.mean = scale * sqrt(square_sum / world_sum);
    return stretch;
}

/// Whether the triangles round an inner vertex go round it more than once.
static alp_result find_double_turns(const alpi_patch *patch, bool *found)
{
    double *turns = ALPI_NEW(patch->context, double, patch->vertex_count); // radians
    if (turns == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < patch->count; i++) {
        for (int k = 0; k < 3; k++) {
            const double *p = patch->at[patch->vertices[i][k]];
            const double *q = patch->at[patch->vertices[i][(k + 1) % 3]];
            const double *r = patch->at[patch->vertices[i][(k + 2) % 3]];
            const double ax = q[0] - p[0], ay = q[1] - p[1], bx = r[0] - p[0], by = r[1] - p[1];
            turns[patch->vertices[i][k]] += alpi_arc_tangent(ax * by - ay * bx, ax * bx + ay * by);
        }
    }
    *found = false;
    for (uint32_t v = 0; v < patch->vertex_count; v++) { // one turn, or less at an open edge
        *found = *found || turns[v] > 3.0 * ALPI_PI;
    }
    alpi_release(patch->context, turns);
    return ALP_OK;
}

static alp_result lies_over_itself(const alpi_patch *patch, alpi_flat *flats, bool *marked,
                                   bool *overlaps)
{
    for (uint32_t i = 0; i < patch->count; i++) {
        marked[i] = true;
        for (int k = 0; k < 3; k++) {
            flats[i].x[k] = patch->at[patch->vertices[i][k]][0];
            flats[i].y[k] = patch->at[patch->vertices[i][k]][1];
        }
    }
    alpi_fold fold = {.context = patch->context};
    const alp_result result = alpi_fold_build(&fold, flats, patch->count);
    for (uint32_t i = 0; result == ALP_OK && i < patch->count && !*overlaps; i++) {
        *overlaps = patch->open[i] && alpi_fold_overlaps(&fold, i, marked);
    }
    alpi_fold_destroy(&fold);
    return result;
}

alp_result alpi_patch_overlaps(const alpi_patch *patch, bool *overlaps)
{
    alp_context *context = patch->context;
    ALP_TRY(find_double_turns(patch, overlaps));
    if (*overlaps) {
        return ALP_OK;
    }
    alpi_flat *flats = ALPI_NEW(context, alpi_flat, patch->count);
    bool *marked = ALPI_NEW(context, bool, patch->count);
    const alp_result result = flats == NULL || marked == NULL
                                  ? ALP_ERROR_OUT_OF_MEMORY
                                  : lies_over_itself(patch, flats, marked, overlaps);
    alpi_release(context, flats);
    alpi_release(context, marked);
    return result;
}
