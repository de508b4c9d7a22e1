// SPDX-License-Identifier: MIT
// Vertices that are one for the eye become one receiver, and its shares of the triangles around it
// become the image of the unit square.
#include "maps/vertex/vertex_map.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "scene/double3.h"
#include "scene/sides.h"

#include <math.h>
#include <string.h>

enum { TICK_TRIANGLES = 4096 };
// Steps of a normal's coordinates: files round them differently, by far less than this; a tenth of
// a degree is below what shading shows.
static const float NORMAL_STEPS = 512.0f;

// --- which vertices are one ----------------------------------------------------------------------

/// What makes vertices one: bits of the position, steps of the normal.
typedef struct vertex_key {
    uint32_t position[3];
    int32_t normal[3];
} vertex_key;

/// Receivers found so far, by key.
typedef struct finder {
    const alp_scene *scene;
    uint32_t *table;   // open addressing: receiver of each slot, ALPI_NONE = free
    size_t table_size; // a power of two, at least twice the vertices
    uint32_t *example; // [vertices] a vertex of each receiver
} finder;

static vertex_key key_of(const alp_scene *scene, uint32_t vertex)
{
    vertex_key key;
    for (int k = 0; k < 3; k++) {
        float value = scene->positions[vertex][k] + 0.0f; // −0 → 0
        memcpy(&key.position[k], &value, sizeof value);
        key.normal[k] = (int32_t)lrintf(scene->normals[vertex][k] * NORMAL_STEPS);
    }
    return key;
}

static size_t find_slot(const finder *f, const vertex_key *key)
{
    uint64_t hash = 0;
    for (int k = 0; k < 3; k++) {
        hash = alpi_hash64(hash ^ ((uint64_t)key->position[k] << 32 | (uint32_t)key->normal[k]));
    }
    size_t slot = (size_t)hash & (f->table_size - 1);
    for (; f->table[slot] != ALPI_NONE; slot = (slot + 1) & (f->table_size - 1)) {
        vertex_key other = key_of(f->scene, f->example[f->table[slot]]);
        if (memcmp(&other, key, sizeof other) == 0) {
            break;
        }
    }
    return slot;
}

/// The receiver of a vertex, a new one when there is none with its position and normal.
static uint32_t find_receiver(finder *f, uint32_t vertex, uint32_t *count)
{
    vertex_key key = key_of(f->scene, vertex);
    size_t slot = find_slot(f, &key);
    if (f->table[slot] == ALPI_NONE) {
        f->example[*count] = vertex;
        f->table[slot] = (*count)++;
    }
    return f->table[slot];
}

/// Numbers receivers in the order of the triangles, so that neighbours are near one another.
static alp_result number_receivers(alpi_vertex_map *map, finder *f)
{
    const alp_scene *scene = map->scene;
    for (f->table_size = 16; f->table_size < 2 * (size_t)scene->vertex_count;) {
        f->table_size *= 2;
    }
    ALPI_TRY_NEW(map->context, f->table, f->table_size);
    memset(f->table, 0xff, f->table_size * sizeof *f->table);
    ALPI_TRY_NEW(map->context, f->example, scene->vertex_count);
    ALPI_TRY_NEW(map->context, map->vertex_receivers, scene->vertex_count);
    memset(map->vertex_receivers, 0xff, scene->vertex_count * sizeof *map->vertex_receivers);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (t % TICK_TRIANGLES == 0) {
            ALP_TRY(alpi_tick(map->context, "vertices", t, scene->triangle_count));
        }
        for (int k = 0; scene->triangle_usable[t] && k < 3; k++) {
            uint32_t vertex = scene->triangles[t][k];
            if (map->vertex_receivers[vertex] == ALPI_NONE) {
                map->vertex_receivers[vertex] = find_receiver(f, vertex, &map->count);
            }
        }
    }
    return ALP_OK;
}

static alp_result find_receivers(alpi_vertex_map *map)
{
    finder f = {.scene = map->scene};
    alp_result result = number_receivers(map, &f);
    alpi_release(map->context, f.table);
    alpi_release(map->context, f.example);
    return result;
}

// --- shares --------------------------------------------------------------------------------------

static uint32_t corner_receiver(const alpi_vertex_map *map, uint32_t triangle, uint32_t corner)
{
    return map->vertex_receivers[map->scene->triangles[triangle][corner]];
}

static double triangle_area(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_triangle_area(c[0], c[1], c[2]);
}

static void count_shares(alpi_vertex_map *map)
{
    const alp_scene *scene = map->scene;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        for (uint32_t k = 0; scene->triangle_usable[t] && k < 3; k++) {
            map->first_share[corner_receiver(map, t, k) + 1]++;
        }
    }
    for (uint32_t i = 0; i < map->count; i++) {
        map->first_share[i + 1] += map->first_share[i];
    }
}

/// Fills shares in triangle order; first_share[i] runs to the end of its own and is set back.
static alp_result list_shares(alpi_vertex_map *map)
{
    const alp_scene *scene = map->scene;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (t % TICK_TRIANGLES == 0) {
            ALP_TRY(alpi_tick(map->context, "vertices", t, scene->triangle_count));
        }
        for (uint32_t k = 0; scene->triangle_usable[t] && k < 3; k++) {
            uint32_t receiver = corner_receiver(map, t, k);
            map->areas[receiver] += triangle_area(scene, t) / 3.0;
            map->shares[map->first_share[receiver]++] = 3 * t + k;
        }
    }
    for (uint32_t i = map->count; i > 0; i--) {
        map->first_share[i] = map->first_share[i - 1];
    }
    map->first_share[0] = 0;
    return ALP_OK;
}

static alp_result sum_shares(alpi_vertex_map *map)
{
    for (uint32_t i = 0; i < map->count; i++) {
        if (i % TICK_TRIANGLES == 0) {
            ALP_TRY(alpi_tick(map->context, "vertices", i, map->count));
        }
        double sum = 0.0;
        for (uint32_t s = map->first_share[i]; s < map->first_share[i + 1]; s++) {
            sum += triangle_area(map->scene, map->shares[s] / 3) / 3.0;
            map->ends[s] = (float)(sum / map->areas[i]);
        }
    }
    return ALP_OK;
}

static alp_result find_shares(alpi_vertex_map *map)
{
    const alp_scene *scene = map->scene;
    if (scene->triangle_count > (ALPI_NONE - 1) / 3) {
        return alpi_fail(map->context, ALP_ERROR_LIMIT,
                         "%s: %u triangles are too many for a bake at vertices; split the scene",
                         scene->name, scene->triangle_count);
    }
    ALPI_TRY_NEW(map->context, map->first_share, (size_t)map->count + 1);
    ALPI_TRY_NEW(map->context, map->shares, 3 * (size_t)scene->usable_count);
    ALPI_TRY_NEW(map->context, map->ends, 3 * (size_t)scene->usable_count);
    ALPI_TRY_NEW(map->context, map->areas, map->count);
    count_shares(map);
    ALP_TRY(list_shares(map));
    return sum_shares(map);
}

alp_result alpi_vertex_map_create(const alp_scene *scene, alpi_vertex_map *map)
{
    *map = (alpi_vertex_map){.context = scene->context, .scene = scene};
    alp_result result = find_receivers(map);
    if (result == ALP_OK) {
        result = find_shares(map);
    }
    if (result != ALP_OK) {
        alpi_vertex_map_destroy(map);
    }
    return result;
}

void alpi_vertex_map_destroy(alpi_vertex_map *map)
{
    alpi_release(map->context, map->vertex_receivers);
    alpi_release(map->context, map->first_share);
    alpi_release(map->context, map->shares);
    alpi_release(map->context, map->ends);
    alpi_release(map->context, map->areas);
    *map = (alpi_vertex_map){.context = map->context};
}

// --- points --------------------------------------------------------------------------------------

alpi_receiver_point alpi_vertex_map_point(const alp_scene *scene, uint32_t triangle, double b1,
                                          double b2)
{
    const double weights[3] = {1.0 - b1 - b2, b1, b2};
    double position[3] = {0.0, 0.0, 0.0};
    double3 normal = {0.0, 0.0, 0.0};
    vec3 c[3], normals[3];
    alpi_triangle_corners(scene, triangle, c);
    alpi_sides_corner_normals(scene, triangle, normals);
    for (int k = 0; k < 3; k++) {
        uint32_t vertex = scene->triangles[triangle][k];
        for (int axis = 0; axis < 3; axis++) {
            position[axis] += weights[k] * (double)scene->positions[vertex][axis];
        }
        normal = double3_add(normal, double3_scale(double3_from(normals[k]), weights[k]));
    }
    alpi_receiver_point point = {
        .position = {(float)position[0], (float)position[1], (float)position[2]},
        .geometric_normal = alpi_sides_normal(scene, triangle),
    };
    point.shading_normal = vec3_normalize_or(double3_to_vec3(normal), point.geometric_normal);
    if (!(vec3_dot(point.shading_normal, point.geometric_normal) > 0.0f)) {
        point.shading_normal = point.geometric_normal; // as at texels: not into the surface
    }
    point.offset = alpi_receiver_offset(point.position, c);
    return point;
}

/// The share that `u` falls on; what is left of u, in [0, 1], goes to *rest.
static uint32_t choose_share(const alpi_vertex_map *map, uint32_t receiver, double u, double *rest)
{
    uint32_t first = map->first_share[receiver], low = first;
    uint32_t high = map->first_share[receiver + 1] - 1;
    while (low < high) { // the first whose end is above u
        uint32_t middle = low + (high - low) / 2;
        if ((double)map->ends[middle] > u) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    double begin = low == first ? 0.0 : (double)map->ends[low - 1];
    double width = (double)map->ends[low] - begin;
    *rest = width > 0.0 ? fmin(fmax((u - begin) / width, 0.0), 1.0) : 0.5;
    return map->shares[low];
}

/// A uniform point of the share: it is two triangles of equal area, from the corner to the middle
/// of an edge and the centroid. Weights: of the corner itself, the edge's other end, the third.
static void place_in_share(double u, double v, double weights[3], bool *second)
{
    *second = u >= 0.5;
    double radius = sqrt(fmin(*second ? 2.0 * u - 1.0 : 2.0 * u, 1.0));
    double to_middle = radius * (1.0 - v), to_centroid = radius * v;
    weights[1] = to_middle / 2.0 + to_centroid / 3.0;
    weights[2] = to_centroid / 3.0;
    weights[0] = 1.0 - weights[1] - weights[2];
}

static void place_points(const void *user, uint32_t receiver, uint32_t count,
                         const float (*square)[2], alpi_receiver_point *points)
{
    const alpi_vertex_map *map = user;
    for (uint32_t i = 0; i < count; i++) {
        double rest, weights[3], b[3];
        bool second;
        uint32_t share = choose_share(map, receiver, (double)square[i][0], &rest);
        place_in_share(rest, (double)square[i][1], weights, &second);
        uint32_t corner = share % 3, other = (corner + (second ? 2 : 1)) % 3;
        b[corner] = weights[0];
        b[other] = weights[1];
        b[3 - corner - other] = weights[2];
        points[i] = alpi_vertex_map_point(map->scene, share / 3, b[1], b[2]);
    }
}

alpi_receivers alpi_vertex_map_receivers(const alpi_vertex_map *map)
{
    return (alpi_receivers){
        .count = map->count, .place = place_points, .user = map, .extended = true};
}
