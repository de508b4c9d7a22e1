// SPDX-License-Identifier: MIT
// Straightens the borders of regions: a triangle goes over to the region beside it that has most of
// its neighbourhood. Bottom-up gathering leaves borders ragged, as coarse as the regions of the
// rounds before, and ragged charts fit badly beside others and show more of a seam.
// After the threshold dynamics of B. Merriman, J. K. Bence, S. J. Osher (Motion of Multiple
// Junctions: A Level Set Approach. Journal of Computational Physics 112, 1994), here with a
// neighbourhood of the mesh for the diffusion and one triangle at a time.
#include "atlas/regions.h"

#include "base/angle.h"
#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>

enum {
    STEPS = 3,        // from the middle of a neighbourhood over edges to its rim
    MOST_AROUND = 22, // triangles in a neighbourhood: 1 + 3 + 6 + 12
    MOST_BESIDE = 8,  // regions that are told apart in one
    MOST_MOVES = 8,   // of one triangle
    MOST_TURNS = 64   // triangles around a corner
};
// By how much of its neighbourhood another region must have more.
static const float LEAST_GAIN = 1e-3f;

typedef struct straightener {
    const alp_scene *scene;
    const uint32_t (*neighbours)[3];
    float least_cosine; // of a normal to its region's plane
    alpi_regions *regions;
    float *areas;     // [triangle_count] m²
    float (*open)[3]; // [triangle_count] of an edge: 1 = the light goes on across it, 0 = must be a
                      // border
    uint32_t *queue;  // [triangle_count] triangles that may go over, in a ring
    uint32_t *seen;   // [triangle_count] the neighbourhood that last reached it
    uint8_t *moves;   // [triangle_count]
    bool *waiting;    // [triangle_count] in the queue
    uint32_t first, count, round;
} straightener;

static void enqueue(straightener *s, uint32_t triangle)
{
    if (triangle != ALPI_NONE && !s->waiting[triangle] && s->moves[triangle] < MOST_MOVES) {
        s->waiting[triangle] = true;
        s->queue[(s->first + s->count++) % s->scene->triangle_count] = triangle;
    }
}

static float openness(const straightener *s, uint32_t triangle, int k)
{
    const uint32_t across = s->neighbours[triangle][k];
    if (across == ALPI_NONE || !alpi_share_node(s->scene, triangle, across)) {
        return 0.0f;
    }
    const float crease = alpi_crease(s->scene, s->neighbours, triangle, k);
    return fmaxf(1.0f - crease / ALPI_SHARPEST_CREASE, 0.0f);
}

// --- the neighbourhood ---------------------------------------------------------------------------

typedef struct share {
    uint32_t region;
    float area; // m², less what lies behind creases
} share;

static void add_share(share shares[MOST_BESIDE], uint32_t region, float area)
{
    for (int i = 0; i < MOST_BESIDE; i++) {
        if (shares[i].region == region || shares[i].region == ALPI_NONE) {
            shares[i].region = region;
            shares[i].area += area;
            break;
        }
    }
}

/// Whose the surface around a triangle is, breadth-first.
static void look_around(straightener *s, uint32_t triangle, share shares[MOST_BESIDE])
{
    uint32_t members[MOST_AROUND], count = 1, begin = 0;
    float reached[MOST_AROUND] = {1.0f};
    members[0] = triangle;
    s->seen[triangle] = ++s->round;
    for (int i = 0; i < MOST_BESIDE; i++) {
        shares[i] = (share){.region = ALPI_NONE};
    }
    add_share(shares, s->regions->of_triangle[triangle], s->areas[triangle]);
    for (int step = 0; step < STEPS; step++) {
        const uint32_t end = count;
        for (uint32_t i = begin; i < end; i++) {
            const uint32_t t = members[i];
            for (int k = 0; k < 3 && count < MOST_AROUND; k++) {
                const uint32_t across = s->neighbours[t][k];
                if (s->open[t][k] > 0.0f && s->seen[across] != s->round) {
                    s->seen[across] = s->round;
                    reached[count] = reached[i] * s->open[t][k];
                    members[count] = across;
                    add_share(shares, s->regions->of_triangle[across],
                              reached[count++] * s->areas[across]);
                }
            }
        }
        begin = end;
    }
}

// --- going over ----------------------------------------------------------------------------------

static bool leans_little(const straightener *s, uint32_t triangle, uint32_t region)
{
    vec3 c[3];
    alpi_triangle_corners(s->scene, triangle, c);
    const vec3 plane = vec3_load(s->regions->planes[region]);
    return vec3_dot(vec3_triangle_normal(c[0], c[1], c[2], plane), plane) >= s->least_cosine;
}

/// Whether one can walk round the corner at which edge k of a triangle begins, from the triangle
/// across it to that across the edge before, without leaving the region.
static bool joined_around(const straightener *s, uint32_t triangle, int k, uint32_t region)
{
    uint32_t t = triangle;
    for (int turn = 0; turn < MOST_TURNS; turn++) {
        const uint32_t across = s->neighbours[t][k];
        if (across == ALPI_NONE ||
            (across != triangle && s->regions->of_triangle[across] != region)) {
            return false;
        }
        if (across == triangle) {
            return turn > 0;
        }
        k = (alpi_edge_back(s->scene, s->neighbours, t, k) + 1) % 3;
        t = across;
    }
    return false;
}

/// Whether a region stays in one piece without the triangle, as far as can be seen from it.
static bool can_leave(const straightener *s, uint32_t triangle, uint32_t region)
{
    int inside = 0, missing = 0;
    for (int k = 0; k < 3; k++) {
        const uint32_t across = s->neighbours[triangle][k];
        const bool in = across != ALPI_NONE && s->regions->of_triangle[across] == region;
        inside += in;
        missing = in ? missing : k;
    }
    // Of two edges inside, the later begins where the other ends.
    return inside < 2 || (inside == 2 && joined_around(s, triangle, (missing + 2) % 3, region));
}

/// The region beside the triangle that has most of what is around it, else its own.
static uint32_t better_region(straightener *s, uint32_t triangle)
{
    const uint32_t *of = s->regions->of_triangle, own = of[triangle];
    bool border = false;
    for (int k = 0; k < 3; k++) {
        border = border || (s->open[triangle][k] > 0.0f && of[s->neighbours[triangle][k]] != own);
    }
    if (!border) {
        return own;
    }
    share shares[MOST_BESIDE];
    look_around(s, triangle, shares);
    uint32_t best = own;
    float most = 0.0f, all = 0.0f;
    for (int i = 0; i < MOST_BESIDE && shares[i].region != ALPI_NONE; i++) {
        most = shares[i].region == own ? shares[i].area : most;
        all += shares[i].area;
    }
    most += LEAST_GAIN * all;
    for (int i = 0; i < MOST_BESIDE && shares[i].region != ALPI_NONE; i++) {
        const uint32_t region = shares[i].region;
        bool beside = false;
        for (int k = 0; k < 3; k++) {
            beside =
                beside || (s->open[triangle][k] > 0.0f && of[s->neighbours[triangle][k]] == region);
        }
        if (beside && shares[i].area > most && leans_little(s, triangle, region)) {
            most = shares[i].area;
            best = region;
        }
    }
    return best != own && can_leave(s, triangle, own) ? best : own;
}

static alp_result run(straightener *s)
{
    const uint32_t triangles = s->scene->triangle_count;
    for (uint32_t t = 0; t < triangles; t++) {
        if (s->scene->triangle_usable[t]) {
            vec3 c[3];
            alpi_triangle_corners(s->scene, t, c);
            s->areas[t] = (float)vec3_triangle_area(c[0], c[1], c[2]);
            for (int k = 0; k < 3; k++) {
                s->open[t][k] = openness(s, t, k);
            }
            enqueue(s, t);
        }
    }
    for (uint32_t step = 0; s->count > 0; step++) {
        ALP_TRY(step % 65536 == 0 ? alpi_tick(s->scene->context, "clusters", 0, triangles)
                                  : ALP_OK);
        const uint32_t t = s->queue[s->first];
        s->first = (s->first + 1) % triangles;
        s->count--;
        s->waiting[t] = false;
        const uint32_t region = better_region(s, t);
        if (region != s->regions->of_triangle[t]) {
            s->regions->of_triangle[t] = region;
            s->moves[t]++;
            for (int k = 0; k < 3; k++) {
                enqueue(s, s->neighbours[t][k]);
            }
        }
    }
    return ALP_OK;
}

static alp_result straighten(straightener *s)
{
    const uint32_t triangles = s->scene->triangle_count;
    ALPI_TRY_NEW(s->scene->context, s->areas, triangles);
    ALPI_TRY_NEW(s->scene->context, s->open, triangles);
    ALPI_TRY_NEW(s->scene->context, s->queue, triangles);
    ALPI_TRY_NEW(s->scene->context, s->seen, triangles);
    ALPI_TRY_NEW(s->scene->context, s->moves, triangles);
    ALPI_TRY_NEW(s->scene->context, s->waiting, triangles);
    return run(s);
}

alp_result alpi_regions_straighten(const alp_scene *scene, const uint32_t (*neighbours)[3],
                                   float max_angle, alpi_regions *regions)
{
    straightener s = {.scene = scene,
                      .neighbours = neighbours,
                      .least_cosine = (float)alpi_cosine((double)max_angle),
                      .regions = regions};
    const alp_result result = straighten(&s);
    alpi_release(scene->context, s.areas);
    alpi_release(scene->context, s.open);
    alpi_release(scene->context, s.queue);
    alpi_release(scene->context, s.seen);
    alpi_release(scene->context, s.moves);
    alpi_release(scene->context, s.waiting);
    return result;
}
