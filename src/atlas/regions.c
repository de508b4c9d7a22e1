// SPDX-License-Identifier: MIT
// Regions, bottom-up: every triangle begins as one, and neighbours are merged in rounds, best pairs
// first. In a round a region grows at most fourfold, so that there are few rounds and all of a
// surface's regions grow alike.
// Based on: M. Garland, A. Willmott, P. S. Heckbert. Hierarchical Face Clustering on Polygonal
// Surfaces. I3D, 2001. There a heap takes one pair at a time and planes are fitted to points; here
// a cone of normals is kept, since it bounds the stretch of a projection.
#include "atlas/regions.h"

#include "base/angle.h"
#include "base/memory.h"
#include "base/tasks.h"

#include <stdlib.h>

// What a pair costs, in shares of the largest cone: a circle's outline adds SHAPE_COST, and a
// crease of one radian CREASE_COST.
static const double SHAPE_COST = 0.35, CREASE_COST = 1.2;
// A pair that others of its round have made dearer by this much waits for the next.
static const double COST_SLACK = 0.04;
// Rounds grow regions fourfold: 4^24 triangles are more than there can be.
enum { ROUND_LIMIT = 40, GROWTH = 4 };

typedef struct region {
    double area, most_area; // m²; what it may grow to in this round
    double outline;         // m
    double axis[3], angle;  // cone that holds all normals
} region;

/// Where two regions meet.
typedef struct meeting {
    uint32_t a, b; // triangles that stand for the regions, a < b
    float length;  // m
    float crease;  // ∫ radians dm
    double cost;
} meeting;

typedef struct gatherer {
    const alp_scene *scene;
    const uint32_t (*neighbours)[3];
    double max_angle;
    region *regions;  // [triangle_count] by the triangle that stands for it
    uint32_t *parent; // [triangle_count] of_triangle
    meeting *meetings;
    size_t count;
} gatherer;

static uint32_t find(uint32_t *parent, uint32_t t)
{
    while (parent[t] != t) {
        parent[t] = parent[parent[t]];
        t = parent[t];
    }
    return t;
}

// --- beginning -----------------------------------------------------------------------------------

static float edge_length(const alp_scene *scene, uint32_t triangle, int k)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_length(vec3_sub(c[(k + 1) % 3], c[k]));
}

static void begin_region(gatherer *g, uint32_t t)
{
    vec3 c[3];
    alpi_triangle_corners(g->scene, t, c);
    const vec3 n = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    region *r = &g->regions[t];
    *r = (region){.area = vec3_triangle_area(c[0], c[1], c[2]),
                  .axis = {(double)n.x, (double)n.y, (double)n.z}};
    for (int k = 0; k < 3; k++) {
        r->outline += (double)edge_length(g->scene, t, k);
    }
}

static alp_result begin(gatherer *g)
{
    const alp_scene *scene = g->scene;
    ALPI_TRY_NEW(scene->context, g->regions, scene->triangle_count);
    size_t edges = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        g->parent[t] = t;
        if (scene->triangle_usable[t]) {
            begin_region(g, t);
            for (int k = 0; k < 3; k++) {
                edges += g->neighbours[t][k] != ALPI_NONE && g->neighbours[t][k] > t;
            }
        }
    }
    ALPI_TRY_NEW(scene->context, g->meetings, edges);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        ALP_TRY(t % 4096 == 0 ? alpi_tick(scene->context, "clusters", 0, scene->triangle_count)
                              : ALP_OK);
        for (int k = 0; scene->triangle_usable[t] && k < 3; k++) {
            const uint32_t across = g->neighbours[t][k];
            if (across == ALPI_NONE || across < t || !alpi_share_node(scene, t, across)) {
                continue;
            }
            const float crease = alpi_crease(scene, g->neighbours, t, k);
            if (crease <= ALPI_SHARPEST_CREASE) {
                const float length = edge_length(scene, t, k);
                g->meetings[g->count++] = (meeting){t, across, length, length * crease, 0.0};
            }
        }
    }
    return ALP_OK;
}

// --- cones ---------------------------------------------------------------------------------------

/// The smallest cone that holds two.
static void join_cones(const region *a, const region *b, double axis[3], double *angle)
{
    const double dot = a->axis[0] * b->axis[0] + a->axis[1] * b->axis[1] + a->axis[2] * b->axis[2];
    const double apart = alpi_arc_cosine(dot);
    const region *wide = a->angle >= b->angle ? a : b, *other = wide == a ? b : a;
    for (int k = 0; k < 3; k++) {
        axis[k] = wide->axis[k];
    }
    *angle = wide->angle;
    if (apart + other->angle <= wide->angle || apart < 1e-6) {
        *angle = fmax(*angle, apart + other->angle);
        return;
    }
    *angle = 0.5 * (apart + a->angle + b->angle);
    const double turn = *angle - wide->angle; // from the wider axis to the other
    const double sine = alpi_sine(apart);
    const double of_wide = sine > 1e-9 ? alpi_sine(apart - turn) / sine : 1.0;
    const double of_other = sine > 1e-9 ? alpi_sine(turn) / sine : 0.0;
    double square = 0.0;
    for (int k = 0; k < 3; k++) {
        axis[k] = of_wide * wide->axis[k] + of_other * other->axis[k];
        square += axis[k] * axis[k];
    }
    for (int k = 0; k < 3; k++) {
        axis[k] /= sqrt(square);
    }
}

/// What it costs to merge two regions; HUGE_VAL: their cone would be too wide.
static double cost_of(const gatherer *g, const region *a, const region *b, const meeting *m)
{
    double axis[3], angle;
    join_cones(a, b, axis, &angle);
    if (angle > g->max_angle) {
        return HUGE_VAL;
    }
    const double outline = a->outline + b->outline - 2.0 * (double)m->length;
    const double round = sqrt(4.0 * ALPI_PI * (a->area + b->area)); // of a disc of that area
    const double crease = m->length > 0.0f ? (double)m->crease / (double)m->length : 0.0;
    return angle / g->max_angle + SHAPE_COST * outline / round + CREASE_COST * crease;
}

static void merge(gatherer *g, uint32_t a, uint32_t b, const meeting *m)
{
    region *into = &g->regions[a], *from = &g->regions[b];
    double axis[3], angle;
    join_cones(into, from, axis, &angle);
    for (int k = 0; k < 3; k++) {
        into->axis[k] = axis[k];
    }
    into->angle = angle;
    into->area += from->area;
    into->most_area = fmax(into->most_area, from->most_area);
    into->outline += from->outline - 2.0 * (double)m->length;
    g->parent[b] = a;
}

// --- rounds --------------------------------------------------------------------------------------

static int by_regions(const void *left, const void *right)
{
    const meeting *a = left, *b = right;
    if (a->a != b->a) {
        return a->a < b->a ? -1 : 1;
    }
    if (a->b != b->b) {
        return a->b < b->b ? -1 : 1;
    }
    if (a->length != b->length) { // sums in one order
        return a->length < b->length ? -1 : 1;
    }
    return (a->crease > b->crease) - (a->crease < b->crease);
}

static int by_cost(const void *left, const void *right)
{
    const meeting *a = left, *b = right;
    if (a->cost != b->cost) {
        return a->cost < b->cost ? -1 : 1;
    }
    return by_regions(left, right);
}

/// Meetings of what regions are now: one for each pair, none inside a region.
static void renew_meetings(gatherer *g)
{
    size_t kept = 0;
    for (size_t i = 0; i < g->count; i++) {
        meeting m = g->meetings[i];
        const uint32_t a = find(g->parent, m.a), b = find(g->parent, m.b);
        if (a != b) {
            m.a = a < b ? a : b;
            m.b = a < b ? b : a;
            g->meetings[kept++] = m;
        }
    }
    qsort(g->meetings, kept, sizeof *g->meetings, by_regions);
    g->count = 0;
    for (size_t i = 0; i < kept; i++) {
        const meeting *m = &g->meetings[i];
        meeting *last = g->count > 0 ? &g->meetings[g->count - 1] : NULL;
        if (last != NULL && last->a == m->a && last->b == m->b) {
            last->length += m->length;
            last->crease += m->crease;
        } else {
            g->meetings[g->count++] = *m;
        }
    }
}

/// One round; whether anything was merged.
static bool run_round(gatherer *g)
{
    size_t kept = 0;
    for (size_t i = 0; i < g->count; i++) {
        meeting m = g->meetings[i];
        region *a = &g->regions[m.a], *b = &g->regions[m.b];
        m.cost = cost_of(g, a, b, &m);
        if (m.cost < HUGE_VAL) { // cones only grow: what does not fit now never will
            g->meetings[kept++] = m;
            a->most_area = GROWTH * a->area;
            b->most_area = GROWTH * b->area;
        }
    }
    g->count = kept;
    qsort(g->meetings, kept, sizeof *g->meetings, by_cost);
    bool merged = false;
    for (size_t i = 0; i < kept; i++) {
        const meeting *m = &g->meetings[i];
        const uint32_t x = find(g->parent, m->a), y = find(g->parent, m->b);
        const uint32_t a = x < y ? x : y, b = x < y ? y : x;
        const region *r = &g->regions[a], *s = &g->regions[b];
        if (a == b || r->area + s->area > fmax(r->most_area, s->most_area) ||
            cost_of(g, r, s, m) > m->cost + COST_SLACK) {
            continue;
        }
        merge(g, a, b, m);
        merged = true;
    }
    return merged;
}

/// The mean normal is the better plane, where no triangle leans too far from it.
static alp_result choose_planes(gatherer *g, alpi_regions *regions)
{
    const alp_scene *scene = g->scene;
    double(*sums)[3] = alpi_allocate(scene->context, scene->triangle_count, sizeof *sums);
    float *least = ALPI_NEW(scene->context, float, scene->triangle_count); // cosine to the mean
    alp_result result = sums == NULL || least == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    for (int pass = 0; result == ALP_OK && pass < 3; pass++) {
        for (uint32_t t = 0; t < scene->triangle_count; t++) {
            const uint32_t r = g->parent[t] = find(g->parent, t);
            vec3 c[3];
            if (!scene->triangle_usable[t] || (pass == 2 && r != t)) {
                continue;
            }
            alpi_triangle_corners(scene, t, c);
            const vec3 n = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
            const float up[3] = {n.x, n.y, n.z};
            const double area = vec3_triangle_area(c[0], c[1], c[2]);
            // Not by floats: gcc 12 leaves out the way there and back, and rounds once.
            const double x = sums[r][0], y = sums[r][1], z = sums[r][2];
            const double length = sqrt(x * x + y * y + z * z);
            const vec3 mean =
                length > 0.0 ? (vec3){(float)(x / length), (float)(y / length), (float)(z / length)}
                             : n;
            for (int k = 0; pass == 0 && k < 3; k++) {
                sums[r][k] += area * (double)up[k] / g->regions[r].area;
            }
            if (pass == 1) {
                least[r] = fminf(least[r], vec3_dot(n, mean) - 1.0f); // from 0
            }
            if (pass == 2) {
                const double *axis = g->regions[r].axis;
                const bool good = (double)least[r] + 1.0 >= alpi_cosine(g->max_angle);
                vec3_store(regions->planes[r],
                           good ? mean : (vec3){(float)axis[0], (float)axis[1], (float)axis[2]});
            }
        }
    }
    alpi_release(scene->context, sums);
    alpi_release(scene->context, least);
    return result;
}

static alp_result gather(gatherer *g, alpi_regions *regions)
{
    const alp_scene *scene = g->scene;
    ALPI_TRY_NEW(scene->context, regions->of_triangle, scene->triangle_count);
    ALPI_TRY_NEW(scene->context, regions->planes, scene->triangle_count);
    g->parent = regions->of_triangle;
    ALP_TRY(begin(g));
    for (int round = 0; round < ROUND_LIMIT && run_round(g); round++) {
        ALP_TRY(alpi_tick(scene->context, "clusters", 0, scene->triangle_count));
        renew_meetings(g);
    }
    return choose_planes(g, regions);
}

alp_result alpi_regions_create(const alp_scene *scene, const uint32_t (*neighbours)[3],
                               float max_angle, alpi_regions *regions)
{
    *regions = (alpi_regions){0};
    gatherer g = {.scene = scene, .neighbours = neighbours, .max_angle = (double)max_angle};
    const alp_result result = gather(&g, regions);
    alpi_release(scene->context, g.regions);
    alpi_release(scene->context, g.meetings);
    if (result != ALP_OK) {
        alpi_regions_destroy(scene->context, regions);
    }
    return result;
}

void alpi_regions_destroy(alp_context *context, alpi_regions *regions)
{
    alpi_release(context, regions->of_triangle);
    alpi_release(context, regions->planes);
    *regions = (alpi_regions){0};
}
