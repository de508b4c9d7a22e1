// SPDX-License-Identifier: MIT
// Which triangle lies across each edge. Vertices are welded by position through a hash table, then
// half-edges meet through a second one: linear time.
#include "atlas/atlas.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"

#include <string.h>

/// Bits of a position in which −0 and +0 are the same.
static void position_bits(const float position[3], uint32_t bits[3])
{
    for (int k = 0; k < 3; k++) {
        float value = position[k] + 0.0f; // −0 + 0 = +0
        memcpy(&bits[k], &value, sizeof value);
    }
}

static uint64_t hash_position(const uint32_t bits[3])
{
    return alpi_hash64(alpi_hash64(((uint64_t)bits[0] << 32) | bits[1]) ^ bits[2]);
}

// Items between two questions whether to go on: well below a hundredth of a second.
enum { TICK_INTERVAL = 1 << 14 };

/// The smallest power of two that is at least `count` (and 16).
static size_t table_size(size_t count)
{
    size_t size = 16;
    while (size < count) {
        size *= 2;
    }
    return size;
}

/// weld[v] = the first vertex with the position of v.
static alp_result weld_vertices(const alp_scene *scene, uint32_t **weld_out)
{
    size_t size = table_size(2 * (size_t)scene->vertex_count);
    uint32_t *weld = ALPI_NEW(scene->context, uint32_t, scene->vertex_count);
    uint32_t *table = ALPI_NEW(scene->context, uint32_t, size); // vertex + 1, 0 = empty
    if (weld == NULL || table == NULL) {
        alpi_release(scene->context, weld);
        alpi_release(scene->context, table);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = ALP_OK;
    for (uint32_t v = 0; v < scene->vertex_count && result == ALP_OK; v++) {
        if (v % TICK_INTERVAL == 0) {
            result = alpi_tick(scene->context, "adjacency", 0, scene->triangle_count);
        }
        uint32_t bits[3], other[3];
        position_bits(scene->positions[v], bits);
        size_t slot = (size_t)hash_position(bits) & (size - 1);
        weld[v] = v;
        for (; table[slot] != 0; slot = (slot + 1) & (size - 1)) {
            position_bits(scene->positions[table[slot] - 1], other);
            if (memcmp(bits, other, sizeof bits) == 0) {
                weld[v] = table[slot] - 1;
                break;
            }
        }
        if (weld[v] == v) {
            table[slot] = v + 1;
        }
    }
    alpi_release(scene->context, table);
    if (result != ALP_OK) {
        alpi_release(scene->context, weld);
        return result;
    }
    *weld_out = weld;
    return ALP_OK;
}

/// Half-edge h = 3·triangle + k runs from corner k to corner k + 1 (mod 3).
typedef struct edge_table {
    const alp_scene *scene;
    const uint32_t *weld;
    size_t size;
    uint32_t *slots;  // [size] first half-edge of an edge + 1, 0 = empty
    uint32_t *second; // [half-edges] of a first one: the half-edge that meets it, or ALPI_NONE
    uint8_t *crowded; // [half-edges] of a first one: a third one came
} edge_table;

static void half_edge_ends(const edge_table *edges, size_t half_edge, uint32_t ends[2])
{
    const uint32_t *corner = edges->scene->triangles[half_edge / 3];
    ends[0] = edges->weld[corner[half_edge % 3]];
    ends[1] = edges->weld[corner[(half_edge + 1) % 3]];
}

static void insert_half_edge(edge_table *edges, size_t half_edge)
{
    uint32_t ends[2], other[2];
    half_edge_ends(edges, half_edge, ends);
    uint32_t low = ends[0] < ends[1] ? ends[0] : ends[1];
    uint32_t high = ends[0] < ends[1] ? ends[1] : ends[0];
    size_t slot = (size_t)alpi_hash64(((uint64_t)high << 32) | low) & (edges->size - 1);
    for (; edges->slots[slot] != 0; slot = (slot + 1) & (edges->size - 1)) {
        size_t first = edges->slots[slot] - 1;
        half_edge_ends(edges, first, other);
        if ((other[0] == low && other[1] == high) || (other[0] == high && other[1] == low)) {
            if (edges->second[first] == ALPI_NONE) {
                edges->second[first] = (uint32_t)half_edge;
            } else {
                edges->crowded[first] = 1;
            }
            return;
        }
    }
    edges->slots[slot] = (uint32_t)half_edge + 1;
    edges->second[half_edge] = ALPI_NONE;
}

/// Joins the two triangles of every edge that has two, where they run along it in opposite
/// directions: else one of them is turned inside out, and no chart may hold both.
static alp_result join_triangles(const edge_table *edges, uint32_t (*neighbours)[3])
{
    const alp_scene *scene = edges->scene;
    for (size_t slot = 0; slot < edges->size; slot++) {
        if (slot % TICK_INTERVAL == 0) {
            ALP_TRY(alpi_tick(scene->context, "adjacency", scene->triangle_count,
                              scene->triangle_count));
        }
        if (edges->slots[slot] == 0) {
            continue;
        }
        size_t first = edges->slots[slot] - 1;
        uint32_t second = edges->second[first];
        if (second == ALPI_NONE || edges->crowded[first]) {
            continue;
        }
        uint32_t a[2], b[2];
        half_edge_ends(edges, first, a);
        half_edge_ends(edges, second, b);
        if (a[0] == b[1] && a[1] == b[0]) {
            neighbours[first / 3][first % 3] = second / 3;
            neighbours[second / 3][second % 3] = (uint32_t)(first / 3);
        }
    }
    return ALP_OK;
}

static alp_result find_neighbours(edge_table *edges, uint32_t (*neighbours)[3])
{
    const alp_scene *scene = edges->scene;
    size_t half_edges = 3 * (size_t)scene->triangle_count;
    edges->size = table_size(half_edges + half_edges / 2);
    ALPI_TRY_NEW(scene->context, edges->slots, edges->size);
    ALPI_TRY_NEW(scene->context, edges->second, half_edges);
    ALPI_TRY_NEW(scene->context, edges->crowded, half_edges);
    for (size_t h = 0; h < half_edges; h++) {
        if (h % TICK_INTERVAL == 0) {
            ALP_TRY(alpi_tick(scene->context, "adjacency", h / 3, scene->triangle_count));
        }
        neighbours[h / 3][h % 3] = ALPI_NONE;
        if (scene->triangle_usable[h / 3]) {
            insert_half_edge(edges, h);
        }
    }
    return join_triangles(edges, neighbours);
}

alp_result alpi_adjacency_create(const alp_scene *scene, uint32_t (**neighbours)[3])
{
    *neighbours = NULL;
    if (scene->triangle_count > UINT32_MAX / 3 - 1) {
        return alpi_fail(scene->context, ALP_ERROR_LIMIT,
                         "%s: %u triangles are more than an atlas can hold; split the scene",
                         scene->name, scene->triangle_count);
    }
    uint32_t *weld = NULL;
    ALP_TRY(weld_vertices(scene, &weld));
    uint32_t(*result)[3] = alpi_allocate(scene->context, scene->triangle_count, sizeof *result);
    edge_table edges = {.scene = scene, .weld = weld};
    alp_result code = result == NULL ? ALP_ERROR_OUT_OF_MEMORY : find_neighbours(&edges, result);
    alpi_release(scene->context, edges.slots);
    alpi_release(scene->context, edges.second);
    alpi_release(scene->context, edges.crowded);
    alpi_release(scene->context, weld);
    if (code != ALP_OK) {
        alpi_release(scene->context, result);
        return code;
    }
    *neighbours = result;
    return ALP_OK;
}
