// SPDX-License-Identifier: MIT
// Points of a triangle. Where vertex normals describe a surface smoother than its facets, rays
// start on that surface: a facet's middle lies inside of it, and the facet's neighbours hide from
// it what the smooth surface sees. With corners p_i, their normals n_i and weights b_i, a point p
// moves to P' = Σ b_i (p − min(0, (p − p_i)·n_i) n_i): each corner lifts it to its tangent plane.
// Based on: J. Hanika. Hacking the Shadow Terminator. Ray Tracing Gems II, chapter 4, 2021.
#include "atlas/facet.h"

#include "scene/sides.h"

#include <math.h>

// Corner normals this near (their distance, squared) to the geometric one are the geometric one.
static const float SAME_NORMAL = 1e-10f;
// A corner this far above another's tangent plane counts, in lengths of the longest edge: the rays
// that start below a slope of it carry its square of the light.
static const float LEAST_HEIGHT = 5e-3f;
// How much of that lift is done. On quadratic surfaces one half leads to the surface exactly, and
// the whole as far beyond it again: a sphere that rests on a floor is lifted through the floor.
// Very coarse spheres (5 segments) need more than a half: at 2/3 a ray in thousands still
// hit.
static const float LIFT_SHARE = 0.7f;
// The longest lift, in lengths of the longest edge. On a sphere whose edges span an angle θ an edge
// needs up to θ/16, at a quarter of its length: 0.07 on an icosahedron. The formula gives more, and
// a third where normals are averaged over the creases of a cube, which describe no surface.
static const float LARGEST_LIFT = 0.125f;

// Which normals describe a smooth surface. On a quadric two corners lie as deep below each other's
// tangent planes, so depths that differ by more than a share of their edge are of a crease. A roof
// with one normal at its ridge: .6; with normals averaged at the eaves too: .16; spheres: 0. Facets
// of a sphere in 5 × 4 segments make 40° with the normals of their corners, those of a cube 55°.
// Between smooth and creased the lift is faded out.
static const float SMOOTH_DEPTHS = 0.05f, CREASED_DEPTHS = 0.15f;
static const float SMOOTH_COSINE = 0.755f, CREASED_COSINE = 0.707f; // 41° and 45°

static float larger(float a, float b)
{
    return a > b ? a : b; // fmaxf, which cares for NaN, is a call
}

/// alpi_receiver_offset for the whole triangle: it is convex there, and largest at a corner.
static float find_offset(const alpi_facet *f, const vec3 corner[3])
{
    float largest[3] = {0.0f, 0.0f, 0.0f}; // by axis: three short chains instead of a long one
    for (int k = 0; k < 3; k++) {
        largest[0] = larger(largest[0], fabsf(corner[k].x));
        largest[1] = larger(largest[1], fabsf(corner[k].y));
        largest[2] = larger(largest[2], fabsf(corner[k].z));
    }
    for (int axis = 0; axis < 3; axis++) {
        const double e1 = f->edges[0][axis], e2 = f->edges[1][axis];
        const float edge = larger((float)fabs(e1), (float)fabs(e2));
        largest[axis] = larger(largest[axis], larger(edge, (float)fabs(e2 - e1)));
    }
    return alpi_receiver_offset(vec3_load(largest), NULL);
}

static void load_shape(alpi_facet *f, const vec3 corner[3], vec3 normal)
{
    const vec3 first = corner[0];
    const double base[3] = {(double)first.x, (double)first.y, (double)first.z};
    for (int axis = 0; axis < 3; axis++) {
        f->corner[axis] = base[axis];
    }
    for (int k = 0; k < 2; k++) {
        const vec3 end = corner[k + 1];
        f->edges[k][0] = (double)end.x - base[0];
        f->edges[k][1] = (double)end.y - base[1];
        f->edges[k][2] = (double)end.z - base[2];
    }
    f->geometric = normal;
    f->offset = find_offset(f, corner);
}

/// 1 at `full` and beyond, 0 at `none` and beyond on its side, linear between.
static float fade(float value, float none, float full)
{
    const float share = (value - none) / (full - none);
    return share < 0.0f ? 0.0f : share > 1.0f ? 1.0f : share;
}

/// The share of the lift that the normals deserve: 1 where they describe a smooth surface.
/// @param heights set   @param squares of the edges between corners i and j
static float find_smoothness(const alpi_facet *f, float squares[3][3])
{
    float cosine = 1.0f, apart = 0.0f;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const float own = vec3_dot(vec3_load(f->normals[i]), f->geometric);
        const float depths = f->heights[i][j] - f->heights[j][i];
        cosine = own < cosine ? own : cosine;
        apart = larger(apart, depths * depths / squares[i][j]);
    }
    return fade(cosine, CREASED_COSINE, SMOOTH_COSINE) *
           fade(sqrtf(apart), CREASED_DEPTHS, SMOOTH_DEPTHS);
}

/// Heights of the corners above each other's tangent planes; whether any point must be lifted.
static void load_lift(alpi_facet *f, const vec3 corner[3])
{
    float square = 0.0f, lowest = 0.0f; // of the longest edge
    float squares[3][3];
    for (int i = 0; i < 3; i++) {
        const vec3 normal = vec3_load(f->normals[i]);
        for (int j = 0; j < 3; j++) {
            const vec3 edge = vec3_sub(corner[j], corner[i]);
            squares[i][j] = vec3_dot(edge, edge);
            f->heights[i][j] = j == i ? 0.0f : vec3_dot(edge, normal);
            square = larger(square, squares[i][j]);
            lowest = f->heights[i][j] < lowest ? f->heights[i][j] : lowest;
        }
    }
    const float longest = sqrtf(square);
    f->lift_limit = LARGEST_LIFT * longest;
    f->lift_share = LIFT_SHARE * find_smoothness(f, squares);
    f->lifted = lowest < -LEAST_HEIGHT * longest && f->lift_share > 0.0f && isfinite(longest);
}

void alpi_facet_load(const alp_scene *scene, uint32_t triangle, bool lift, alpi_facet *facet)
{
    vec3 corner[3], normals[3];
    alpi_triangle_corners(scene, triangle, corner);
    alpi_sides_corner_normals(scene, triangle, normals);
    load_shape(facet, corner, alpi_sides_normal(scene, triangle));
    facet->smooth = facet->lifted = false;
    for (int k = 0; k < 3; k++) {
        const vec3 apart = vec3_sub(normals[k], facet->geometric);
        facet->smooth = facet->smooth || vec3_dot(apart, apart) > SAME_NORMAL;
        vec3_store(facet->normals[k], normals[k]);
    }
    if (facet->smooth && lift) {
        load_lift(facet, corner);
    }
}

vec3 alpi_facet_normal(const alpi_facet *f, const float w[3])
{
    if (!f->smooth) {
        return f->geometric;
    }
    vec3 n;
    n.x = w[0] * f->normals[0][0] + w[1] * f->normals[1][0] + w[2] * f->normals[2][0];
    n.y = w[0] * f->normals[0][1] + w[1] * f->normals[1][1] + w[2] * f->normals[2][1];
    n.z = w[0] * f->normals[0][2] + w[1] * f->normals[1][2] + w[2] * f->normals[2][2];
    const float square = vec3_dot(n, n);
    if (!(square > 1e-12f) || !(vec3_dot(n, f->geometric) > 0.0f)) {
        return f->geometric;
    }
    return vec3_scale(n, 1.0f / sqrtf(square));
}

static vec3 find_lift(const alpi_facet *f, const float w[3])
{
    vec3 lift = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < 3; i++) {
        const float *h = f->heights[i];
        const float height = w[0] * h[0] + w[1] * h[1] + w[2] * h[2];
        lift = vec3_mad(lift, -f->lift_share * w[i] * (height < 0.0f ? height : 0.0f),
                        vec3_load(f->normals[i]));
    }
    const float length = vec3_length(lift);
    return length > f->lift_limit ? vec3_scale(lift, f->lift_limit / length) : lift;
}

/// @param low NULL, or out: the position before any lift
static void find_point(const alpi_facet *f, const double b[2], alpi_receiver_point *point,
                       vec3 *low)
{
    point->position.x = (float)(f->corner[0] + b[0] * f->edges[0][0] + b[1] * f->edges[1][0]);
    point->position.y = (float)(f->corner[1] + b[0] * f->edges[0][1] + b[1] * f->edges[1][1]);
    point->position.z = (float)(f->corner[2] + b[0] * f->edges[0][2] + b[1] * f->edges[1][2]);
    point->geometric_normal = f->geometric;
    point->shading_normal = f->geometric;
    point->offset = f->offset;
    if (low != NULL) {
        *low = point->position;
    }
    if (f->smooth) {
        const float w[3] = {(float)(1.0 - b[0] - b[1]), (float)b[0], (float)b[1]};
        point->shading_normal = alpi_facet_normal(f, w);
        if (f->lifted) {
            point->position = vec3_add(point->position, find_lift(f, w));
        }
    }
}

void alpi_facet_point(const alpi_facet *facet, const double b[2], alpi_receiver_point *point,
                      vec3 *low)
{
    find_point(facet, b, point, low);
}

/// The same for a triangle that is flat: all but the position is one for all points.
static void find_flat_points(const alpi_facet *f, const alpi_facet_patch *patch, uint32_t count,
                             const float (*square)[2], alpi_receiver_point *points)
{
    double origin[3], by_x[3], by_y[3]; // metres
    for (int axis = 0; axis < 3; axis++) {
        const double e1 = f->edges[0][axis], e2 = f->edges[1][axis];
        origin[axis] = f->corner[axis] + patch->at[0] * e1 + patch->at[1] * e2;
        by_x[axis] = patch->by_x[0] * e1 + patch->by_x[1] * e2;
        by_y[axis] = patch->by_y[0] * e1 + patch->by_y[1] * e2;
    }
    alpi_receiver_point point = {
        .geometric_normal = f->geometric, .shading_normal = f->geometric, .offset = f->offset};
    for (uint32_t i = 0; i < count; i++) {
        const double x = (double)square[i][0], y = (double)square[i][1];
        point.position.x = (float)(origin[0] + x * by_x[0] + y * by_y[0]);
        point.position.y = (float)(origin[1] + x * by_x[1] + y * by_y[1]);
        point.position.z = (float)(origin[2] + x * by_x[2] + y * by_y[2]);
        points[i] = point;
    }
}

void alpi_facet_points(const alpi_facet *facet, const alpi_facet_patch *patch, uint32_t count,
                       const float (*square)[2], alpi_receiver_point *points, vec3 *lows)
{
    if (!facet->smooth) {
        find_flat_points(facet, patch, count, square, points);
        for (uint32_t i = 0; i < count && lows != NULL; i++) {
            lows[i] = points[i].position;
        }
        return;
    }
    const alpi_facet_patch p = *patch;
    for (uint32_t i = 0; i < count; i++) {
        const double x = (double)square[i][0], y = (double)square[i][1];
        const double b[2] = {p.at[0] + x * p.by_x[0] + y * p.by_y[0],
                             p.at[1] + x * p.by_x[1] + y * p.by_y[1]};
        find_point(facet, b, &points[i], lows != NULL ? &lows[i] : NULL);
    }
}
