// SPDX-License-Identifier: MIT
// Few triangles, laid out for the loops that meet them: corners and edges once, pairs of triangles
// that are flat and convex together as one polygon.
#include "trace/few.h"

#include "base/context.h"
#include "base/memory.h"
#include "scene/double3.h"

#include <math.h>
#include <string.h>

// --- corners and edges, each once ----------------------------------------------------------------

static vec3 corner_of(const alpi_few *few, uint32_t corner)
{
    return vec3_load(few->corner[corner]);
}

static uint16_t add_corner(alpi_few *few, const float at[3])
{
    uint32_t c = 0;
    while (c < few->corner_count && !(few->corner[c][0] == at[0] && few->corner[c][1] == at[1] &&
                                      few->corner[c][2] == at[2])) {
        c++;
    }
    if (c == few->corner_count) {
        memcpy(few->corner[few->corner_count++], at, sizeof few->corner[c]);
    }
    return (uint16_t)c;
}

/// @return the side of a polygon from one corner to another
static uint16_t add_side(alpi_few *few, uint16_t from, uint16_t to)
{
    const uint16_t low = from < to ? from : to, high = from < to ? to : from;
    uint32_t e = 0;
    while (e < few->edge_count && !(few->edge[e].from == low && few->edge[e].to == high)) {
        e++;
    }
    if (e == few->edge_count) {
        few->edge[few->edge_count++] = (alpi_few_edge){low, high};
    }
    return (uint16_t)(2 * e + (from < to ? 0 : 1));
}

// --- triangles -----------------------------------------------------------------------------------

/// A triangle on its way in.
typedef struct raw_triangle {
    const uint16_t *corners; // [3]
    uint32_t triangle;       // of the scene
    bool single_sided, taken;
} raw_triangle;

/// (b − a) × (c − a)
static vec3 normal_of(const alpi_few *few, const uint16_t corners[3])
{
    const vec3 a = corner_of(few, corners[0]);
    return vec3_cross(vec3_sub(corner_of(few, corners[1]), a),
                      vec3_sub(corner_of(few, corners[2]), a));
}

static void add_triangle(const alp_scene *scene, uint32_t triangle, alpi_few *few,
                         raw_triangle *raw)
{
    uint16_t *corners = few->corners[few->count++];
    for (int c = 0; c < 3; c++) {
        corners[c] = add_corner(few, scene->positions[scene->triangles[triangle][c]]);
    }
    *raw = (raw_triangle){corners, triangle, !alpi_surface_is_double_sided(scene, triangle), false};
}

/// Whether each triangle is wide enough for rays from anywhere in the scene to tell its edges
/// apart: from 10^7 times its width they are one in floats, and every ray would pass between them.
static bool are_plain(const alpi_few *few, const raw_triangle *raw, float far)
{
    // Of `far`; and metres, within which cubes of lengths are floats.
    static const float NARROWEST = 1e-4f, LEAST = 1e-6f, MOST = 1e6f;
    bool plain = far > LEAST && far < MOST;
    for (uint32_t t = 0; t < few->count; t++) {
        float longest = 0.0f;
        for (int c = 0; c < 3; c++) {
            const vec3 edge = vec3_sub(corner_of(few, raw[t].corners[(c + 1) % 3]),
                                       corner_of(few, raw[t].corners[c]));
            longest = fmaxf(longest, vec3_length(edge));
        }
        const float area = vec3_length(normal_of(few, raw[t].corners)); // twice
        plain = plain && area > 0.0f && area >= NARROWEST * far * longest;
    }
    return plain;
}

// --- polygons ------------------------------------------------------------------------------------

/// Two triangles that have an edge in common: corner i of the one and j of the other are apart.
typedef struct pair {
    int i, j;
    uint16_t corners[4]; // counter-clockwise, from the first's on
} pair;

static bool share_edge(const raw_triangle *a, const raw_triangle *b, pair *p)
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const uint16_t from = a->corners[(i + 1) % 3], to = a->corners[(i + 2) % 3];
            if (b->corners[(j + 1) % 3] == to && b->corners[(j + 2) % 3] == from) {
                *p = (pair){i, j, {a->corners[i], from, b->corners[j], to}};
                return true;
            }
        }
    }
    return false;
}

/// No less than rays from a triangle are lifted off it (alpi_receiver_offset), by where it is and
/// how long: in steps of a float at 1.
static double least_lift(const alpi_few *few, const uint16_t corners[3])
{
    double least = 0.0;
    for (int k = 0; k < 3; k++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int c = 0; c < 3; c++) {
            low = fmin(low, (double)few->corner[corners[c]][k]);
            high = fmax(high, (double)few->corner[corners[c]][k]);
        }
        least = fmax(least, fmax(0.5 * (high - low), fmax(low, -high)));
    }
    return 2.0 * least;
}

/// Whether a pair's plane, along both diagonals through one of them, is as good for rays from
/// either triangle as its own, and no corner turns in.
static bool is_flat_and_convex(const alpi_few *few, const pair *p, const raw_triangle *a,
                               const raw_triangle *b)
{
    static const double TURN = 1e-5; // sine of the least angle that a corner turns by
    double3 side[4];
    for (int k = 0; k < 4; k++) {
        side[k] =
            double3_between(corner_of(few, p->corners[k]), corner_of(few, p->corners[(k + 1) % 4]));
    }
    const double3 n = double3_cross(double3_add(side[0], side[1]), double3_add(side[1], side[2]));
    const double length = double3_length(n);
    bool convex = true;
    for (int k = 0; k < 4; k++) {
        const double3 *in = &side[(k + 3) % 4], *out = &side[k];
        const double least = TURN * double3_length(*in) * double3_length(*out) * length;
        convex = convex && double3_dot(double3_cross(*in, *out), n) > least;
    }
    const double lift = fmin(least_lift(few, a->corners), least_lift(few, b->corners));
    return convex && fabs(double3_dot(n, side[0])) <= 0.25 * 0x1p-23 * lift * length;
}

static void add_to_set(alpi_few_set *set, uint32_t member)
{
    set->words[member / 64] |= (uint64_t)1 << member % 64;
}

/// @param count 3 or 4  @return the polygon, of which the caller sets what is not its outline
static alpi_few_polygon *add_polygon(alpi_few *few, const uint16_t *corners, int count)
{
    const uint32_t place = few->polygon_count++;
    alpi_few_polygon *p = &few->polygon[place];
    p->corner = corners[0];
    for (int k = 0; k < 3; k++) {
        few->low[k][place] = INFINITY;
        few->high[k][place] = -INFINITY;
    }
    for (int c = 0; c < count; c++) {
        p->sides[c] = add_side(few, corners[c], corners[(c + 1) % count]);
        add_to_set(&p->edges, p->sides[c] / 2u);
        add_to_set(&p->corners, corners[c]);
        for (int k = 0; k < 3; k++) {
            few->low[k][place] = fminf(few->low[k][place], few->corner[corners[c]][k]);
            few->high[k][place] = fmaxf(few->high[k][place], few->corner[corners[c]][k]);
        }
    }
    if (count == 3) {
        p->sides[3] = p->sides[2];
    }
    return p;
}

static void add_pair(alpi_few *few, const pair *q, const raw_triangle *a, const raw_triangle *b)
{
    enum { DIAGONAL = 4 };
    alpi_few_polygon *p = add_polygon(few, q->corners, 4);
    vec3 c[4];
    for (int k = 0; k < 4; k++) {
        c[k] = corner_of(few, q->corners[k]);
    }
    vec3_store(p->normal, vec3_cross(vec3_sub(c[2], c[0]), vec3_sub(c[3], c[1])));
    p->single_sided = a->single_sided;
    p->diagonal = (alpi_few_edge){q->corners[1], q->corners[3]};
    p->triangles[0] = a->triangle;
    p->triangles[1] = b->triangle;
    // A corner weighs by the side across from it: those of the first are corners 0, 1 and 3.
    p->weights[0][q->i] = p->weights[1][q->j] = DIAGONAL;
    p->weights[0][(q->i + 1) % 3] = 3;
    p->weights[0][(q->i + 2) % 3] = 0;
    p->weights[1][(q->j + 1) % 3] = 1;
    p->weights[1][(q->j + 2) % 3] = 2;
}

static void add_alone(alpi_few *few, const raw_triangle *t)
{
    alpi_few_polygon *p = add_polygon(few, t->corners, 3);
    vec3_store(p->normal, normal_of(few, t->corners));
    p->single_sided = t->single_sided;
    p->diagonal = (alpi_few_edge){p->corner, p->corner};
    for (uint8_t k = 0; k < 2; k++) {
        p->triangles[k] = t->triangle;
        for (uint8_t c = 0; c < 3; c++) {
            p->weights[k][c] = (uint8_t)((c + 1) % 3);
        }
    }
}

/// The polygon that a triangle makes with one after it, or by itself.
static void add_polygon_of(alpi_few *few, raw_triangle *raw, uint32_t t)
{
    for (uint32_t other = t + 1; other < few->count; other++) {
        pair p;
        if (!raw[other].taken && raw[other].single_sided == raw[t].single_sided &&
            share_edge(&raw[t], &raw[other], &p) &&
            is_flat_and_convex(few, &p, &raw[t], &raw[other])) {
            raw[other].taken = true;
            add_pair(few, &p, &raw[t], &raw[other]);
            return;
        }
    }
    add_alone(few, &raw[t]);
}

static void add_polygons(alpi_few *few, raw_triangle *raw)
{
    for (uint32_t t = 0; t < few->count; t++) {
        if (!raw[t].taken) {
            add_polygon_of(few, raw, t);
        }
    }
    for (uint32_t p = few->polygon_count; p < ALPI_FEW_LIMIT; p++) {
        for (int k = 0; k < 3; k++) {
            few->low[k][p] = INFINITY; // of none
            few->high[k][p] = -INFINITY;
        }
    }
    few->all.polygon_count = few->polygon_count;
    few->all.edge_count = few->edge_count;
    few->all.corner_count = few->corner_count;
    for (uint32_t i = 0; i < ALPI_FEW_LIMIT; i++) {
        few->all.polygons[i] = (uint16_t)i;
    }
    for (uint32_t i = 0; i < ALPI_FEW_EDGES; i++) {
        few->all.edges[i] = few->all.corners[i] = (uint16_t)i;
    }
}

// --- all of them ---------------------------------------------------------------------------------

/// Sets extent and slack. @return the largest absolute coordinate
static float find_extent(alpi_few *few)
{
    float far = 0.0f;
    for (int k = 0; k < 3; k++) {
        float low = INFINITY, high = -INFINITY;
        for (uint32_t c = 0; c < few->corner_count; c++) {
            low = fminf(low, few->corner[c][k]);
            high = fmaxf(high, few->corner[c][k]);
        }
        far = fmaxf(far, fmaxf(-low, high));
        few->extent = fmaxf(few->extent, high - low);
    }
    few->slack = 1e-4f * far;
    return far;
}

alp_result alpi_few_create(const alp_scene *scene, const uint32_t *triangles, uint32_t count,
                           alpi_few **few)
{
    raw_triangle raw[ALPI_FEW_LIMIT];
    *few = NULL;
    if (count == 0 || count > ALPI_FEW_LIMIT) {
        return ALP_OK;
    }
    alpi_few *made = ALPI_NEW(scene->context, alpi_few, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    made->loops = &ALPI_COMPILED_WIDE_FOR(scene->context, alpi_few_loops);
    for (uint32_t t = 0; t < count; t++) {
        add_triangle(scene, triangles[t], made, &raw[t]);
    }
    if (!are_plain(made, raw, find_extent(made))) {
        alpi_release(scene->context, made);
        return ALP_OK;
    }
    add_polygons(made, raw);
    *few = made;
    return ALP_OK;
}

static uint32_t count_near(const alpi_few *few, vec3 point, float reach)
{
    const float at[3] = {point.x, point.y, point.z};
    uint32_t count = 0;
    for (uint32_t p = 0; p < few->polygon_count; p++) {
        bool near = true;
        for (int k = 0; k < 3; k++) {
            near = near && few->low[k][p] <= at[k] + reach && few->high[k][p] >= at[k] - reach;
        }
        count += near;
    }
    return count;
}

float alpi_few_near(const alpi_few *few, float reach)
{
    enum { STEPS = 4 }; // middles of 10 of the 16 equal parts of a triangle
    double sum = 0.0, area = 0.0;
    for (uint32_t t = 0; t < few->count; t++) {
        const uint16_t *corners = few->corners[t];
        const vec3 a = corner_of(few, corners[0]);
        const vec3 e1 = vec3_sub(corner_of(few, corners[1]), a);
        const vec3 e2 = vec3_sub(corner_of(few, corners[2]), a);
        const double weight = (double)vec3_length(normal_of(few, corners));
        for (int i = 0; i < STEPS; i++) {
            for (int j = 0; j + i < STEPS; j++) {
                const float u = ((float)i + 1.0f / 3.0f) / STEPS;
                const float v = ((float)j + 1.0f / 3.0f) / STEPS;
                sum += weight * count_near(few, vec3_mad(vec3_mad(a, u, e1), v, e2), reach);
                area += weight;
            }
        }
    }
    return area > 0.0 ? (float)(sum / area) : 0.0f;
}
