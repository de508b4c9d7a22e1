// SPDX-License-Identifier: MIT
#include "corner_octree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TABLE = 1 << 20, CORNERS = 8, DEPTH_MOST = 10, BATCH = 256 };
/// Cells round the camera at each level, along an axis.
enum { AROUND = 4 };

typedef struct corner {
    int32_t at[3]; // of the lattice of leaves
    bool used, solid;
    alpi_sh9 light;
} corner;

struct corner_octree {
    double low[3], leaf; // metres: a corner of the root, and an edge of a leaf
    uint32_t depth;
    uint32_t used;
    corner *table; // [TABLE] by hash
};

corner_octree *corner_octree_create(const double centre[3], double size, uint32_t depth)
{
    corner_octree *o = bench_allocate(1, sizeof *o);
    o->depth = depth < DEPTH_MOST ? depth : DEPTH_MOST;
    o->leaf = size / (double)(1u << o->depth);
    o->table = bench_allocate(TABLE, sizeof *o->table);
    for (int k = 0; k < 3; k++) {
        o->low[k] = centre[k] - 0.5 * size;
    }
    return o;
}

void corner_octree_destroy(corner_octree *octree)
{
    if (octree != NULL) {
        free(octree->table);
    }
    free(octree);
}

/// The slot of a corner: its own, or the free one where it would be.
static corner *find_corner(const corner_octree *o, const int32_t at[3])
{
    uint32_t hash =
        (uint32_t)at[0] * 73856093u ^ (uint32_t)at[1] * 19349663u ^ (uint32_t)at[2] * 83492791u;
    hash ^= hash >> 15;
    for (;; hash++) {
        corner *c = &o->table[hash % TABLE];
        if (!c->used || memcmp(c->at, at, sizeof c->at) == 0) {
            return c;
        }
    }
}

/// Corner i of a cell. @param width of the cell, in leaves
static void corner_at(const int32_t cell[3], int32_t width, int i, int32_t at[3])
{
    for (int k = 0; k < 3; k++) {
        at[k] = (cell[k] + (i >> k & 1)) * width;
    }
}

static bool is_complete(const corner_octree *o, const int32_t cell[3], int32_t width)
{
    for (int i = 0; i < CORNERS; i++) {
        int32_t at[3];
        corner_at(cell, width, i, at);
        if (!find_corner(o, at)->used) {
            return false;
        }
    }
    return true;
}

// --- sampling ------------------------------------------------------------------------------------

typedef struct wanted_corners {
    int32_t at[BATCH][3];
    uint32_t count, most;
} wanted_corners;

/// Adds the missing corners of a cell.
static void want_cell(const corner_octree *o, const int32_t cell[3], int32_t width,
                      wanted_corners *w)
{
    for (int i = 0; i < CORNERS && w->count < w->most; i++) {
        int32_t at[3];
        bool known = false;
        corner_at(cell, width, i, at);
        for (uint32_t k = 0; k < w->count && !known; k++) {
            known = memcmp(w->at[k], at, sizeof at) == 0;
        }
        if (!known && !find_corner(o, at)->used) {
            memcpy(w->at[w->count++], at, sizeof at);
        }
    }
}

/// Cells of a level at most `around` from that of the camera, where they lie in the root.
static void want_level(const corner_octree *o, uint32_t level, const double camera[3],
                       int32_t around, wanted_corners *w)
{
    const int32_t width = (int32_t)(1u << (o->depth - level)), cells = (int32_t)(1u << level);
    int32_t first[3], last[3], cell[3];
    for (int k = 0; k < 3; k++) {
        const int32_t middle = (int32_t)floor((camera[k] - o->low[k]) / (o->leaf * (double)width));
        first[k] = middle - around > 0 ? middle - around : 0;
        last[k] = middle + around < cells - 1 ? middle + around : cells - 1;
    }
    for (cell[2] = first[2]; cell[2] <= last[2]; cell[2]++) {
        for (cell[1] = first[1]; cell[1] <= last[1]; cell[1]++) {
            for (cell[0] = first[0]; cell[0] <= last[0] && w->count < w->most; cell[0]++) {
                want_cell(o, cell, width, w);
            }
        }
    }
}

static bool sample_wanted(corner_octree *o, const ambience_world *world,
                          const alp_ambience_snapshot *bounced, const wanted_corners *w)
{
    double places[BATCH][3];
    alpi_sh9 lights[BATCH];
    bool solid[BATCH];
    for (uint32_t i = 0; i < w->count; i++) {
        for (int k = 0; k < 3; k++) {
            places[i][k] = o->low[k] + o->leaf * (double)w->at[i][k];
        }
    }
    if (!ambience_world_sample(world, bounced, w->count, (const double(*)[3])places, lights,
                               solid)) {
        return false;
    }
    for (uint32_t i = 0; i < w->count; i++) {
        corner *c = find_corner(o, w->at[i]);
        *c = (corner){.used = true, .solid = solid[i], .light = lights[i]};
        memcpy(c->at, w->at[i], sizeof c->at);
        o->used++;
    }
    return true;
}

bool corner_octree_step(corner_octree *octree, const ambience_world *world,
                        const alp_ambience_snapshot *bounced, const double camera[3],
                        uint32_t samples)
{
    wanted_corners w = {.most = samples < BATCH ? samples : BATCH};
    if (octree->used + BATCH > TABLE / 2) {
        return true;
    }
    for (uint32_t level = 0; level <= octree->depth; level++) {
        want_level(octree, level, camera, 0, &w);
    }
    for (uint32_t level = 0; level <= octree->depth; level++) {
        want_level(octree, level, camera, AROUND, &w);
    }
    return sample_wanted(octree, world, bounced, &w);
}

// --- look-up -------------------------------------------------------------------------------------

/// Light of a cell at a place in it. @return false: all corners lie in solids
static bool read_cell(const corner_octree *o, const int32_t cell[3], int32_t width,
                      const double leaves[3], alpi_sh9 *light)
{
    double total = 0.0;
    memset(light, 0, sizeof *light);
    for (int i = 0; i < CORNERS; i++) {
        int32_t at[3];
        double weight = 1.0;
        corner_at(cell, width, i, at);
        for (int k = 0; k < 3; k++) {
            const double part = leaves[k] / (double)width - (double)cell[k];
            weight *= (i >> k & 1) != 0 ? part : 1.0 - part;
        }
        const corner *c = find_corner(o, at);
        if (!c->used || c->solid) {
            continue;
        }
        total += weight;
        for (int k = 0; k < ALPI_AMBIENCE_FLOATS; k++) {
            light->c[k / 3][k % 3] += (float)weight * c->light.c[k / 3][k % 3];
        }
    }
    for (int k = 0; k < ALPI_AMBIENCE_FLOATS && total > 0.0; k++) {
        light->c[k / 3][k % 3] /= (float)total;
    }
    return total > 1e-6;
}

static void read_place(const corner_octree *o, const double place[3], alpi_sh9 *light)
{
    double leaves[3];
    memset(light, 0, sizeof *light);
    for (int k = 0; k < 3; k++) {
        leaves[k] = (place[k] - o->low[k]) / o->leaf;
        if (!(leaves[k] >= 0.0 && leaves[k] < (double)(1u << o->depth))) {
            return;
        }
    }
    for (uint32_t level = 0; level <= o->depth; level++) {
        const int32_t width = (int32_t)(1u << (o->depth - level));
        int32_t cell[3];
        alpi_sh9 here;
        for (int k = 0; k < 3; k++) {
            cell[k] = (int32_t)(leaves[k] / (double)width);
        }
        if (!is_complete(o, cell, width)) {
            return;
        }
        if (read_cell(o, cell, width, leaves, &here)) {
            *light = here;
        }
    }
}

void corner_octree_read(const corner_octree *octree, uint32_t count, const double (*positions)[3],
                        const float (*normals)[3], float (*values)[3])
{
    for (uint32_t i = 0; i < count; i++) {
        alpi_sh9 light;
        read_place(octree, positions[i], &light);
        const vec3 e = alpi_sh9_irradiance(&light, vec3_load(normals[i]));
        vec3_store(values[i], (vec3){fmaxf(e.x, 0.0f), fmaxf(e.y, 0.0f), fmaxf(e.z, 0.0f)});
    }
}

/// Whether the cell at a corner of the lattice has children with all their corners.
static bool is_branched(const corner_octree *o, const int32_t cell[3], int32_t width)
{
    for (int i = 0; i < CORNERS; i++) {
        const int32_t child[3] = {2 * cell[0] + (i & 1), 2 * cell[1] + (i >> 1 & 1),
                                  2 * cell[2] + (i >> 2)};
        if (!is_complete(o, child, width / 2)) {
            return false;
        }
    }
    return true;
}

corner_octree_counts corner_octree_count(const corner_octree *octree)
{
    corner_octree_counts counts = {.corners = octree->used};
    for (uint32_t i = 0; i < TABLE; i++) {
        const corner *c = &octree->table[i];
        for (int32_t width = 2; c->used && width <= (int32_t)(1u << octree->depth); width *= 2) {
            const int32_t cell[3] = {c->at[0] / width, c->at[1] / width, c->at[2] / width};
            const bool own =
                c->at[0] % width == 0 && c->at[1] % width == 0 && c->at[2] % width == 0;
            counts.cells += own && is_branched(octree, cell, width) ? 1 : 0;
        }
    }
    return counts;
}
