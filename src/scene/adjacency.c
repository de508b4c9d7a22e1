// SPDX-License-Identifier: MIT
// Which triangle lies across each edge. Vertices are welded by position through a hash table, then
// half-edges meet through a second one: linear time.
#include "scene/adjacency.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"

#include <math.h>
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
    uint32_t *slots; // [size] first half-edge of an edge + 1, 0 = empty
    uint32_t *next;  // [half-edges] along the same edge, in order, or ALPI_NONE
    uint32_t *last;  // [half-edges] of a first one: the last along its edge
} edge_table;

/// What is paired at one edge at most: of a star of more, nobody can say what goes on into what.
enum { CROWD_LIMIT = 16 };

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
            edges->next[edges->last[first]] = (uint32_t)half_edge;
            edges->last[first] = (uint32_t)half_edge;
            return;
        }
    }
    edges->slots[slot] = (uint32_t)half_edge + 1;
    edges->last[half_edge] = (uint32_t)half_edge;
}

static void join_half_edges(uint32_t first, uint32_t second, uint32_t (*neighbours)[3])
{
    neighbours[first / 3][first % 3] = second / 3;
    neighbours[second / 3][second % 3] = first / 3;
}

// --- edges of more than two triangles ------------------------------------------------------------

/// The half-edges along one edge.
typedef struct crowd {
    uint32_t half_edges[CROWD_LIMIT], nodes[CROWD_LIMIT]; // nodes: of the first with the same node
    bool forward[CROWD_LIMIT];
    uint32_t count;
} crowd;

static bool same_node(const alp_scene *scene, uint32_t a, uint32_t b)
{
    const alpi_surface *first = &scene->surfaces[scene->triangle_surface[a / 3]];
    const alpi_surface *second = &scene->surfaces[scene->triangle_surface[b / 3]];
    return first->node == second->node && first->instance == second->instance;
}

static vec3 normal_at(const alp_scene *scene, uint32_t half_edge)
{
    vec3 c[3];
    alpi_triangle_corners(scene, half_edge / 3, c);
    return vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
}

/// How likely two half-edges are of one sheet: they share their vertices, not only their places;
/// their surface; and then by the angle between them.
static float kinship(const edge_table *edges, uint32_t a, uint32_t b)
{
    const alp_scene *scene = edges->scene;
    const uint32_t *p = scene->triangles[a / 3], *q = scene->triangles[b / 3];
    const bool shared = p[a % 3] == q[(b + 1 - b / 3 * 3) % 3]; // its end, where a begins
    const bool surface = scene->triangle_surface[a / 3] == scene->triangle_surface[b / 3];
    return (surface ? 8.0f : 0.0f) + vec3_dot(normal_at(scene, a), normal_at(scene, b)) +
           (shared ? 0.01f : 0.0f);
}

/// Joins, of the half-edges of one node, each that runs forward with one that runs back, the
/// likeliest pair first. Only where there are as many of both: else one sheet ends here, and it
/// cannot be told which.
static void pair_node(const edge_table *edges, crowd *c, uint32_t node, uint32_t (*neighbours)[3])
{
    uint32_t forward = 0, all = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        all += c->nodes[i] == node;
        forward += c->nodes[i] == node && c->forward[i];
    }
    if (2 * forward != all) {
        return;
    }
    for (; forward > 0; forward--) {
        uint32_t best[2] = {0, 0};
        float most = -HUGE_VALF;
        for (uint32_t i = 0; i < c->count; i++) {
            for (uint32_t j = 0; j < c->count; j++) {
                if (c->nodes[i] != node || c->nodes[j] != node || !c->forward[i] || c->forward[j]) {
                    continue;
                }
                const float kin = kinship(edges, c->half_edges[i], c->half_edges[j]);
                if (kin > most) {
                    most = kin;
                    best[0] = i;
                    best[1] = j;
                }
            }
        }
        join_half_edges(c->half_edges[best[0]], c->half_edges[best[1]], neighbours);
        c->nodes[best[0]] = c->nodes[best[1]] = ALPI_NONE;
    }
}

/// Sheets that lie on each other or cross, and meshes that touch.
static void pair_crowd(const edge_table *edges, uint32_t first, uint32_t (*neighbours)[3])
{
    crowd c = {.count = 0};
    uint32_t a[2], b[2];
    half_edge_ends(edges, first, a);
    for (uint32_t h = first; h != ALPI_NONE; h = edges->next[h]) {
        if (c.count == CROWD_LIMIT) {
            return;
        }
        half_edge_ends(edges, h, b);
        uint32_t node = 0;
        while (node < c.count && !same_node(edges->scene, c.half_edges[node], h)) {
            node++;
        }
        c.half_edges[c.count] = h;
        c.nodes[c.count] = node;
        c.forward[c.count++] = a[0] == b[0];
    }
    for (uint32_t node = 0; node < c.count; node++) {
        if (c.nodes[node] == node) {
            pair_node(edges, &c, node, neighbours);
        }
    }
}

/// Joins the two triangles of every edge that has two, where they run along it in opposite
/// directions: else one of them is turned inside out, and no chart may hold both. Edges that have
/// more are sorted out.
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
        uint32_t second = edges->next[first], a[2], b[2];
        if (second == ALPI_NONE) {
            continue;
        }
        if (edges->next[second] != ALPI_NONE) {
            pair_crowd(edges, (uint32_t)first, neighbours);
            continue;
        }
        half_edge_ends(edges, first, a);
        half_edge_ends(edges, second, b);
        if (a[0] == b[1] && a[1] == b[0]) {
            join_half_edges((uint32_t)first, second, neighbours);
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
    ALPI_TRY_NEW(scene->context, edges->next, half_edges);
    ALPI_TRY_NEW(scene->context, edges->last, half_edges);
    for (size_t h = 0; h < half_edges; h++) {
        if (h % TICK_INTERVAL == 0) {
            ALP_TRY(alpi_tick(scene->context, "adjacency", h / 3, scene->triangle_count));
        }
        neighbours[h / 3][h % 3] = edges->next[h] = ALPI_NONE;
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
    alpi_release(scene->context, edges.next);
    alpi_release(scene->context, edges.last);
    alpi_release(scene->context, weld);
    if (code != ALP_OK) {
        alpi_release(scene->context, result);
        return code;
    }
    *neighbours = result;
    return ALP_OK;
}
