// SPDX-License-Identifier: MIT
// Few triangles, laid out for the loops that meet them.
#include "trace/few.h"

#include "base/context.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

static const alpi_few_loops *choose_loops(alp_context *context)
{
#ifdef ALPI_HAS_V3_KERNEL
    if (alpi_context_has_v3(context)) {
        return &alpi_few_loops_v3;
    }
#endif
    (void)context;
    return &alpi_few_loops_baseline;
}

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
    bool single_sided, taken;
} raw_triangle;

/// (b − a) × (c − a)
static vec3 normal_of(const alpi_few *few, const uint16_t corners[3])
{
    const vec3 a = corner_of(few, corners[0]);
    return vec3_cross(vec3_sub(corner_of(few, corners[1]), a),
                      vec3_sub(corner_of(few, corners[2]), a));
}

static void store_over(float out[3], vec3 v, double over)
{
    out[0] = (float)((double)v.x / over);
    out[1] = (float)((double)v.y / over);
    out[2] = (float)((double)v.z / over);
}

static void add_triangle(const alp_scene *scene, uint32_t triangle, alpi_few *few,
                         raw_triangle *raw)
{
    uint16_t *corners = few->corners[few->count];
    alpi_few_triangle *t = &few->triangle[few->count++];
    for (int c = 0; c < 3; c++) {
        corners[c] = add_corner(few, scene->positions[scene->triangles[triangle][c]]);
    }
    *raw = (raw_triangle){corners, !alpi_surface_is_double_sided(scene, triangle), false};
    const vec3 a = corner_of(few, corners[0]), n = normal_of(few, corners);
    const double square =
        (double)n.x * (double)n.x + (double)n.y * (double)n.y + (double)n.z * (double)n.z;
    const double over = square > 0.0 ? square : 1.0; // such are refused
    t->triangle = triangle;
    vec3_store(t->corner, a);
    store_over(t->to_b1, vec3_cross(vec3_sub(corner_of(few, corners[2]), a), n), over);
    store_over(t->to_b2, vec3_cross(n, vec3_sub(corner_of(few, corners[1]), a)), over);
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
        plain = plain && area >= NARROWEST * far * longest;
    }
    return plain;
}

// --- polygons ------------------------------------------------------------------------------------

/// @param corners out: four, counter-clockwise; the edge is from the second to the fourth
static bool share_edge(const raw_triangle *a, const raw_triangle *b, uint16_t corners[4])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const uint16_t from = a->corners[(i + 1) % 3], to = a->corners[(i + 2) % 3];
            if (b->corners[(j + 1) % 3] == to && b->corners[(j + 2) % 3] == from) {
                const uint16_t both[4] = {a->corners[i], from, b->corners[j], to};
                memcpy(corners, both, sizeof both);
                return true;
            }
        }
    }
    return false;
}

/// Whether it lies in a plane, as far as its coordinates can tell, and has no corner that turns in.
static bool is_flat_and_convex(const alpi_few *few, const uint16_t corners[4])
{
    // Of a coordinate: a quarter of what rays are lifted by.
    static const float HALF_STEP = 0x1p-24f;
    const vec3 n = normal_of(few, (const uint16_t[]){corners[0], corners[1], corners[3]});
    const float length = vec3_length(n);
    float largest = 0.0f;
    bool convex = true;
    for (int c = 0; c < 4; c++) {
        const vec3 p = corner_of(few, corners[c]);
        const vec3 turn = normal_of(
            few, (const uint16_t[]){corners[c], corners[(c + 1) % 4], corners[(c + 3) % 4]});
        largest = fmaxf(largest, fmaxf(fabsf(p.x), fmaxf(fabsf(p.y), fabsf(p.z))));
        convex = convex && vec3_dot(turn, n) > 1e-5f * length * length;
    }
    const vec3 across = vec3_sub(corner_of(few, corners[2]), corner_of(few, corners[0]));
    return convex && fabsf(vec3_dot(n, across)) <= HALF_STEP * largest * length;
}

static void add_to_set(alpi_few_set *set, uint32_t member)
{
    set->words[member / 64] |= (uint64_t)1 << member % 64;
}

static void add_polygon(alpi_few *few, const uint16_t *corners, int count, alpi_few_polygon p)
{
    const uint32_t place = few->polygon_count++;
    p.corner = corners[0];
    for (int k = 0; k < 3; k++) {
        few->low[k][place] = INFINITY;
        few->high[k][place] = -INFINITY;
    }
    for (int c = 0; c < count; c++) {
        p.sides[c] = add_side(few, corners[c], corners[(c + 1) % count]);
        add_to_set(&p.edges, p.sides[c] / 2u);
        add_to_set(&p.corners, corners[c]);
        for (int k = 0; k < 3; k++) {
            few->low[k][place] = fminf(few->low[k][place], few->corner[corners[c]][k]);
            few->high[k][place] = fmaxf(few->high[k][place], few->corner[corners[c]][k]);
        }
    }
    few->polygon[place] = p;
}

/// The quadrilateral that a triangle makes with one after it, or the triangle itself.
static void add_polygon_of(alpi_few *few, raw_triangle *raw, uint32_t t)
{
    alpi_few_polygon p = {.triangles = {t, t}, .single_sided = raw[t].single_sided};
    for (uint32_t other = t + 1; other < few->count; other++) {
        uint16_t corners[4];
        if (!raw[other].taken && raw[other].single_sided == raw[t].single_sided &&
            share_edge(&raw[t], &raw[other], corners) && is_flat_and_convex(few, corners)) {
            raw[other].taken = true;
            p.triangles[1] = other;
            const vec3 middle = corner_of(few, corners[1]);
            const vec3 along = vec3_sub(corner_of(few, corners[3]), middle);
            const vec3 n =
                vec3_cross(vec3_sub(corner_of(few, corners[2]), corner_of(few, corners[0])), along);
            vec3_store(p.normal, n);
            vec3_store(p.middle, middle);
            vec3_store(p.to_first, vec3_cross(n, along));
            add_polygon(few, corners, 4, p);
            return;
        }
    }
    vec3_store(p.normal, normal_of(few, raw[t].corners));
    add_polygon(few, raw[t].corners, 3, p);
    few->polygon[few->polygon_count - 1].sides[3] = few->polygon[few->polygon_count - 1].sides[2];
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
    for (uint16_t i = 0; i < ALPI_FEW_EDGES; i++) {
        few->all.edges[i] = few->all.corners[i] = i;
        few->all.polygons[i % ALPI_FEW_LIMIT] = (uint16_t)(i % ALPI_FEW_LIMIT);
    }
}

// --- all of them ---------------------------------------------------------------------------------

/// @return the largest absolute coordinate
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
    made->loops = choose_loops(scene->context);
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

static uint32_t count_near(const alpi_few *few, vec3 p, float reach)
{
    const float at[3] = {p.x, p.y, p.z};
    uint32_t count = 0;
    for (uint32_t t = 0; t < few->polygon_count; t++) {
        bool near = true;
        for (int k = 0; k < 3; k++) {
            near = near && few->low[k][t] <= at[k] + reach && few->high[k][t] >= at[k] - reach;
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
