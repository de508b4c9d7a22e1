// SPDX-License-Identifier: MIT
// The Utah teapot: Martin Newell, University of Utah, 1975; control points as published with
// F. C. Crow, "The Origins of the Teapot", IEEE Computer Graphics and Applications 7(1), 1987, and
// the bottom that was added to them. The published set lists 32 bicubic Bézier patches over 306
// points. 24 of the patches are quarter turns of two profiles, the others are two tubes of mirrored
// halves, and so they are written here: the same numbers, once each. Published z is up; here y is.
#include "scene/builtin/teapot.h"

#include <math.h>

enum { LID_ROWS = 7, BODY_ROWS = 13, TUBE_ROWS = 7 }; // neighbouring patches share a row

/// A ring of control points: (radius, height), and the arm of a quarter's inner points per radius.
typedef struct ring {
    double radius, height, arm;
} ring;

static const ring LID[LID_ROWS] = {
    {0.0, 3.15, 0.56}, {0.8, 3.15, 0.5625}, {0.0, 2.85, 0.56}, {0.2, 2.7, 0.56},
    {0.4, 2.55, 0.56}, {1.3, 2.55, 0.56},   {1.3, 2.4, 0.56},
};
static const ring BODY[BODY_ROWS] = {
    {1.4, 2.4, 0.56},    {1.3375, 2.53125, 0.56}, {1.4375, 2.53125, 0.56}, {1.5, 2.4, 0.56}, // rim
    {1.75, 1.875, 0.56}, {2.0, 1.35, 0.56},       {2.0, 0.9, 0.56},        {2.0, 0.45, 0.56},
    {1.5, 0.225, 0.56},  {1.5, 0.15, 0.56},       {1.5, 0.075, 0.56},      {1.425, 0.0, 0.56},
    {0.0, 0.0, 0.56}, // bottom
};

/// A section of a tube: two points of the middle plane, and how far its corners stand off it.
typedef struct section {
    double x0, y0, x1, y1, half_width;
} section;

static const section HANDLE[TUBE_ROWS] = {
    {-1.6, 2.025, -1.5, 2.25, 0.3}, {-2.3, 2.025, -2.5, 2.25, 0.3},
    {-2.7, 2.025, -3.0, 2.25, 0.3}, {-2.7, 1.8, -3.0, 1.8, 0.3},
    {-2.7, 1.575, -3.0, 1.35, 0.3}, {-2.5, 1.125, -2.65, 0.9375, 0.3},
    {-2.0, 0.9, -1.9, 0.6, 0.3},
};
static const section SPOUT[TUBE_ROWS] = {
    {1.7, 1.425, 1.7, 0.6, 0.66},       {2.6, 1.425, 3.1, 0.825, 0.66},
    {2.3, 2.1, 2.4, 2.025, 0.25},       {2.7, 2.4, 3.3, 2.4, 0.25},
    {2.8, 2.475, 3.525, 2.49375, 0.25}, {2.9, 2.475, 3.45, 2.5125, 0.15},
    {2.8, 2.4, 3.2, 2.4, 0.15},
};

typedef struct point {
    double x, y, z;
} point;

/// Control points: rows along u, columns along v.
typedef struct patch {
    point p[4][4];
} patch;

static point add(point a, point b)
{
    return (point){a.x + b.x, a.y + b.y, a.z + b.z};
}

static point scale(point a, double s)
{
    return (point){a.x * s, a.y * s, a.z * s};
}

static point cross(point a, point b)
{
    return (point){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Σ w_k p_k, summed from both ends so that the curve is the same bits read backwards: patches that
/// share an edge agree on it.
static point combine(const point p[4], const double w[4])
{
    return add(add(scale(p[0], w[0]), scale(p[3], w[3])),
               add(scale(p[1], w[1]), scale(p[2], w[2])));
}

/// Bernstein polynomials of degree 3 and their derivatives.
static void bernstein(double t, double w[4], double derivative[4])
{
    double s = 1.0 - t;
    const double value[4] = {s * s * s, 3.0 * (s * s * t), 3.0 * (t * t * s), t * t * t};
    const double slope[4] = {-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t),
                             3.0 * t * t};
    for (int k = 0; k < 4; k++) {
        w[k] = value[k];
        derivative[k] = slope[k];
    }
}

/// Position and the normal direction ∂S/∂v × ∂S/∂u, which points outside with these control points.
static void evaluate(const patch *control, double u, double v, point *position, point *normal)
{
    double wu[4], du[4], wv[4], dv[4];
    bernstein(u, wu, du);
    bernstein(v, wv, dv);
    point rows[4], slopes[4];
    for (int k = 0; k < 4; k++) {
        rows[k] = combine(control->p[k], wv);
        slopes[k] = combine(control->p[k], dv);
    }
    *position = combine(rows, wu);
    *normal = cross(combine(slopes, wu), combine(rows, du));
}

// --- tessellation --------------------------------------------------------------------------------

static vec3 turned(const alpi_teapot *teapot, point p)
{
    double c = cos((double)teapot->turn), s = sin((double)teapot->turn);
    return (vec3){(float)(c * p.x + s * p.z), (float)p.y, (float)(c * p.z - s * p.x)};
}

static uint32_t add_vertex(alpi_builder *builder, const alpi_teapot *teapot, const patch *control,
                           uint32_t i, uint32_t j)
{
    double u = (double)i / teapot->segments, v = (double)j / teapot->segments;
    point position, normal, nearby;
    evaluate(control, u, v, &position, &normal);
    double length2 = normal.x * normal.x + normal.y * normal.y + normal.z * normal.z;
    if (length2 < 1e-20) { // a pole, where ∂S/∂v is 0: the limit, taken from just beside it
        evaluate(control, u + (u < 0.5 ? 1e-6 : -1e-6), v, &nearby, &normal);
        normal = scale(normal, 1e6);
    }
    double size = (double)teapot->height / (double)ALPI_TEAPOT_HEIGHT;
    return alpi_builder_vertex(builder,
                               vec3_add(teapot->foot, turned(teapot, scale(position, size))),
                               vec3_normalize_or(turned(teapot, normal), (vec3){0.0f, 1.0f, 0.0f}));
}

/// Whether a row of control points is one point.
static bool is_pole(const point row[4])
{
    bool pole = true;
    for (int k = 1; k < 4; k++) {
        pole &= row[k].x == row[0].x && row[k].y == row[0].y && row[k].z == row[0].z;
    }
    return pole;
}

static void add_patch(alpi_builder *builder, const alpi_teapot *teapot, const patch *control)
{
    uint32_t n = teapot->segments, first = 0;
    for (uint32_t i = 0; i <= n; i++) {
        for (uint32_t j = 0; j <= n; j++) {
            uint32_t vertex = add_vertex(builder, teapot, control, i, j);
            first = i == 0 && j == 0 ? vertex : first;
        }
    }
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t j = 0; j < n; j++) {
            uint32_t a = first + i * (n + 1) + j, d = a + n + 1;
            if (!(i == 0 && is_pole(control->p[0]))) {
                alpi_builder_triangle(builder, a, a + 1, d + 1);
            }
            if (!(i == n - 1 && is_pole(control->p[3]))) {
                alpi_builder_triangle(builder, a, d + 1, d);
            }
        }
    }
}

/// Patches of a profile: a quarter turn each, `quarter` counted from +x towards +z.
static void add_turned(alpi_builder *builder, const alpi_teapot *teapot, const ring *rings,
                       int patch_count)
{
    for (int part = 0; part < patch_count; part++) {
        for (int quarter = 0; quarter < 4; quarter++) {
            patch control;
            for (int i = 0; i < 4; i++) {
                const ring *r = &rings[3 * part + i];
                const double along[4][2] = {{1.0, 0.0}, {1.0, r->arm}, {r->arm, 1.0}, {0.0, 1.0}};
                for (int j = 0; j < 4; j++) {
                    double x = r->radius * along[j][0], z = r->radius * along[j][1];
                    for (int turn = 0; turn < quarter; turn++) {
                        double kept = x;
                        x = -z;
                        z = kept;
                    }
                    control.p[i][j] = (point){x, r->height, z};
                }
            }
            add_patch(builder, teapot, &control);
        }
    }
}

/// Two patches along a tube, each as two mirrored halves: z ≥ 0 and z ≤ 0.
static void add_tube(alpi_builder *builder, const alpi_teapot *teapot, const section *sections)
{
    for (int part = 0; part < 2; part++) {
        patch half, mirrored;
        for (int i = 0; i < 4; i++) {
            const section *s = &sections[3 * part + i];
            half.p[i][0] = (point){s->x0, s->y0, 0.0};
            half.p[i][1] = (point){s->x0, s->y0, s->half_width};
            half.p[i][2] = (point){s->x1, s->y1, s->half_width};
            half.p[i][3] = (point){s->x1, s->y1, 0.0};
            for (int j = 0; j < 4; j++) { // read backwards, so that it faces outside too
                mirrored.p[i][3 - j] = (point){half.p[i][j].x, half.p[i][j].y, -half.p[i][j].z};
            }
        }
        add_patch(builder, teapot, &half);
        add_patch(builder, teapot, &mirrored);
    }
}

void alpi_builder_teapot(alpi_builder *builder, const alpi_teapot *teapot)
{
    add_turned(builder, teapot, LID, (LID_ROWS - 1) / 3);
    add_turned(builder, teapot, BODY, (BODY_ROWS - 1) / 3);
    add_tube(builder, teapot, HANDLE);
    add_tube(builder, teapot, SPOUT);
}
