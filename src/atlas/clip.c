// SPDX-License-Identifier: MIT
// Clipping of triangles against texels.
// Based on: I. E. Sutherland, G. W. Hodgman. Reentrant Polygon Clipping. CACM 17(1), 1974.
#include "atlas/clip.h"

#include <math.h>

void alpi_polygon_clip(const alpi_polygon *in, int axis, double at, bool keep_low,
                       alpi_polygon *out)
{
    out->count = 0;
    for (int i = 0; i < in->count; i++) {
        const double *a = in->p[i], *b = in->p[i + 1 == in->count ? 0 : i + 1];
        bool a_in = keep_low ? a[axis] <= at : a[axis] >= at;
        bool b_in = keep_low ? b[axis] <= at : b[axis] >= at;
        if (a_in) {
            out->p[out->count][0] = a[0];
            out->p[out->count++][1] = a[1];
        }
        if (a_in != b_in && a[axis] != at && b[axis] != at) {
            double s = (at - a[axis]) / (b[axis] - a[axis]);
            out->p[out->count][axis] = at;
            out->p[out->count][1 - axis] = a[1 - axis] + s * (b[1 - axis] - a[1 - axis]);
            out->count++;
        }
    }
}

void alpi_polygon_cut(alpi_polygon *shape, int axis, double at, bool keep_low)
{
    alpi_polygon in;
    in.count = shape->count;
    for (int i = 0; i < shape->count; i++) { // not those that are not there
        in.p[i][0] = shape->p[i][0];
        in.p[i][1] = shape->p[i][1];
    }
    alpi_polygon_clip(&in, axis, at, keep_low, shape);
}

double alpi_polygon_measure(const alpi_polygon *shape, double centroid[2])
{
    double area = 0.0, sx = 0.0, sy = 0.0;
    centroid[0] = centroid[1] = 0.0;
    const double *o = shape->p[0];
    for (int i = 1; i + 1 < shape->count; i++) {
        double ax = shape->p[i][0] - o[0], ay = shape->p[i][1] - o[1];
        double bx = shape->p[i + 1][0] - o[0], by = shape->p[i + 1][1] - o[1];
        double part = 0.5 * (ax * by - ay * bx);
        area += part;
        sx += part * (ax + bx);
        sy += part * (ay + by);
    }
    if (!(area > 0.0)) {
        return 0.0;
    }
    centroid[0] = o[0] + sx / (3.0 * area);
    centroid[1] = o[1] + sy / (3.0 * area);
    return area;
}

static void exchange(double a[2], double b[2])
{
    for (int i = 0; i < 2; i++) {
        double kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

bool alpi_page_triangle_load(const alp_atlas *atlas, uint32_t triangle, alpi_page_triangle *out)
{
    const double size[2] = {atlas->info.width, atlas->info.height};
    double(*p)[2] = out->p;
    for (int k = 0; k < 3; k++) {
        p[k][0] = (double)atlas->corner_uvs[triangle][k][0] * size[0];
        p[k][1] = (double)atlas->corner_uvs[triangle][k][1] * size[1];
    }
    double area = 0.5 * ((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) -
                         (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]));
    out->triangle = triangle;
    out->area = fabs(area);
    out->turned = area < 0.0;
    if (out->turned) {
        exchange(p[1], p[2]);
    }
    for (int i = 0; i < 2; i++) {
        out->low[i] = alpi_lesser(p[0][i], alpi_lesser(p[1][i], p[2][i]));
        out->high[i] = alpi_greater(p[0][i], alpi_greater(p[1][i], p[2][i]));
    }
    return out->area > 0.0;
}

bool alpi_page_triangle_range(const alpi_page_triangle *triangle, int axis, uint32_t size,
                              uint32_t *first, uint32_t *last)
{
    const double low = triangle->low[axis], high = triangle->high[axis];
    double margin = alpi_lesser(0x1p-23 * size + 1e-7, 0.25 * (high - low));
    double begin = floor(low + margin), end = ceil(high - margin) - 1.0;
    end = alpi_greater(begin, end);
    if (!(end >= 0.0) || !(begin <= (double)size)) {
        return false;
    }
    *first = (uint32_t)alpi_lesser(alpi_greater(begin, 0.0), (double)size - 1.0);
    *last = (uint32_t)alpi_lesser(alpi_greater(end, 0.0), (double)size - 1.0);
    return true;
}

void alpi_polygon_of_triangle(const alpi_page_triangle *t, alpi_polygon *shape)
{
    shape->count = 3;
    for (int k = 0; k < 3; k++) {
        shape->p[k][0] = t->p[k][0];
        shape->p[k][1] = t->p[k][1];
    }
}

void alpi_page_triangle_cut(const alpi_page_triangle *t, uint32_t x, uint32_t y,
                            alpi_polygon *shape)
{
    const double at[2] = {x, y};
    alpi_polygon_of_triangle(t, shape);
    for (int axis = 0; axis < 2; axis++) {
        if (t->low[axis] < at[axis]) {
            alpi_polygon_cut(shape, axis, at[axis], false);
        }
        if (t->high[axis] > at[axis] + 1.0) {
            alpi_polygon_cut(shape, axis, at[axis] + 1.0, true);
        }
    }
}

alpi_page_map alpi_page_triangle_map(const alpi_page_triangle *t)
{
    const double scale = 0.5 / t->area;
    const double e1[2] = {scale * (t->p[1][0] - t->p[0][0]), scale * (t->p[1][1] - t->p[0][1])};
    const double e2[2] = {scale * (t->p[2][0] - t->p[0][0]), scale * (t->p[2][1] - t->p[0][1])};
    alpi_page_map map; // chosen, not indexed: a store that its load must wait for
    map.by_x[0] = t->turned ? -e1[1] : e2[1];
    map.by_y[0] = t->turned ? e1[0] : -e2[0];
    map.by_x[1] = t->turned ? e2[1] : -e1[1];
    map.by_y[1] = t->turned ? -e2[0] : e1[0];
    map.corner[0] = t->p[0][0];
    map.corner[1] = t->p[0][1];
    return map;
}

alpi_facet_patch alpi_page_triangle_patch(const alpi_page_triangle *t, double x, double y)
{
    const alpi_page_map map = alpi_page_triangle_map(t);
    return alpi_page_map_from(&map, x, y);
}
