// SPDX-License-Identifier: MIT
// Which triangle of one scene is which of another: in their order, or, where a bake has cut
// primitives into those of several pages, by their corners.
#include "report/same_triangles.h"

#include "base/hash.h"
#include "base/memory.h"
#include "scene/origin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Positions of a matrix and those of another program that says the same.
static const float ROUNDING = 1e-6f;

// --- in order ------------------------------------------------------------------------------------

static bool are_near(const alp_scene *a, const alp_scene *b, uint32_t triangle, float tolerance)
{
    vec3 p[3], q[3];
    const vec3 apart = {(float)(b->origin[0] - a->origin[0]), (float)(b->origin[1] - a->origin[1]),
                        (float)(b->origin[2] - a->origin[2])};
    alpi_triangle_corners(a, triangle, p);
    alpi_triangle_corners(b, triangle, q);
    bool near = true;
    for (int k = 0; k < 3; k++) {
        near = near && vec3_length(vec3_sub(vec3_sub(p[k], q[k]), apart)) <= tolerance;
    }
    return near;
}

/// Size of the scene, and how far from the origin it lies, which is what its digits are for.
static float reach_of(const alp_scene *scene)
{
    const float across = vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    return across + fmaxf(vec3_length(scene->bounds_max), vec3_length(scene->bounds_min));
}

static bool find_in_order(const alp_scene *a, const alp_scene *b, alpi_same_triangles *same)
{
    const float tolerance = ROUNDING * reach_of(a);
    bool alike = a->triangle_count == b->triangle_count;
    for (uint32_t t = 0; t < a->triangle_count && alike; t++) {
        alike = a->triangle_usable[t] == b->triangle_usable[t] &&
                (!a->triangle_usable[t] || are_near(a, b, t, tolerance));
        same->numbers[t] = t;
        same->turns[t] = 0;
    }
    return alike;
}

// --- by corners ----------------------------------------------------------------------------------

typedef struct entry {
    uint64_t hash; // of the corners, whichever is first
    uint32_t triangle;
} entry;

/// Corners as they are compared: no negative zeros.
static void read_corners(const alp_scene *scene, uint32_t triangle, float corners[3][3])
{
    for (int i = 0; i < 9; i++) {
        corners[i / 3][i % 3] = scene->positions[scene->triangles[triangle][i / 3]][i % 3] + 0.0f;
    }
}

static bool is_before(const float a[3], const float b[3])
{
    int k = 0;
    while (k < 2 && a[k] == b[k]) {
        k++;
    }
    return a[k] < b[k];
}

static uint64_t hash_triangle(const alp_scene *scene, uint32_t triangle)
{
    float corners[3][3];
    read_corners(scene, triangle, corners);
    int first = 0;
    for (int k = 1; k < 3; k++) {
        first = is_before(corners[k], corners[first]) ? k : first;
    }
    uint64_t hash = ALPI_HASH_START;
    for (int k = 0; k < 3; k++) {
        hash = alpi_hash_bytes(hash, corners[(first + k) % 3], sizeof corners[0]);
    }
    return hash;
}

static int compare_entries(const void *left, const void *right)
{
    const entry *a = left, *b = right;
    return a->hash != b->hash           ? (a->hash < b->hash ? -1 : 1)
           : a->triangle != b->triangle ? (a->triangle < b->triangle ? -1 : 1)
                                        : 0;
}

/// The usable triangles, sorted; copies of one keep their order.
static alp_result list_triangles(const alp_scene *scene, entry **entries)
{
    uint32_t count = 0;
    ALPI_TRY_NEW(scene->context, *entries, scene->usable_count);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (scene->triangle_usable[t]) {
            (*entries)[count++] = (entry){hash_triangle(scene, t), t};
        }
    }
    qsort(*entries, count, sizeof **entries, compare_entries);
    return ALP_OK;
}

enum { OTHERS = 3 };
/// By how many places the corners of a triangle are turned in another.
static uint8_t find_turn(const alp_scene *a, uint32_t triangle, const alp_scene *b, uint32_t other)
{
    float p[3][3], q[3][3];
    read_corners(a, triangle, p);
    read_corners(b, other, q);
    for (uint32_t turn = 0; turn < OTHERS; turn++) {
        bool same = true;
        for (int i = 0; i < 9; i++) {
            same = same && p[i / 3][i % 3] == q[((uint32_t)i / 3 + turn) % 3][i % 3];
        }
        if (same) {
            return (uint8_t)turn;
        }
    }
    return OTHERS;
}

static alp_result fail_triangle(const alp_scene *in, uint32_t triangle, const alp_scene *missing)
{
    double at[3];
    alpi_origin_restore(in, vec3_load(in->positions[in->triangles[triangle][0]]), at);
    return alpi_fail(in->context, ALP_ERROR_INVALID_DATA,
                     "compare: %s has a triangle in \"%s\" with a corner at %g %g %g m that %s has "
                     "not; compare bakes of one scene",
                     in->name, in->surfaces[in->triangle_surface[triangle]].name, at[0], at[1],
                     at[2], missing->name);
}

static alp_result pair(const alp_scene *a, const alp_scene *b, const entry *of_a, const entry *of_b,
                       alpi_same_triangles *same)
{
    for (uint32_t i = 0; i < a->usable_count; i++) {
        const uint8_t turn = of_a[i].hash == of_b[i].hash
                                 ? find_turn(a, of_a[i].triangle, b, of_b[i].triangle)
                                 : OTHERS;
        if (turn == OTHERS) {
            return of_a[i].hash <= of_b[i].hash ? fail_triangle(a, of_a[i].triangle, b)
                                                : fail_triangle(b, of_b[i].triangle, a);
        }
        same->numbers[of_a[i].triangle] = of_b[i].triangle;
        same->turns[of_a[i].triangle] = turn;
    }
    return ALP_OK;
}

static alp_result find_by_corners(const alp_scene *a, const alp_scene *b, alpi_same_triangles *same)
{
    entry *of_a = NULL, *of_b = NULL;
    alp_result result = list_triangles(a, &of_a);
    if (result == ALP_OK) {
        result = list_triangles(b, &of_b);
    }
    if (result == ALP_OK) {
        result = pair(a, b, of_a, of_b, same);
    }
    alpi_release(a->context, of_a);
    alpi_release(a->context, of_b);
    return result;
}

// -------------------------------------------------------------------------------------------------

alp_result alpi_same_triangles_find(const alp_scene *a, const alp_scene *b,
                                    alpi_same_triangles *same)
{
    *same = (alpi_same_triangles){0};
    if (a->usable_count != b->usable_count) {
        return alpi_fail(a->context, ALP_ERROR_INVALID_DATA,
                         "compare: %s has %u triangles with area, %s has %u; compare bakes of one "
                         "scene",
                         a->name, a->usable_count, b->name, b->usable_count);
    }
    ALPI_TRY_NEW(a->context, same->numbers, a->triangle_count);
    ALPI_TRY_NEW(a->context, same->turns, a->triangle_count);
    return find_in_order(a, b, same) ? ALP_OK : find_by_corners(a, b, same);
}

void alpi_same_triangles_release(alp_context *context, alpi_same_triangles *same)
{
    alpi_release(context, same->numbers);
    alpi_release(context, same->turns);
    *same = (alpi_same_triangles){0};
}
