// SPDX-License-Identifier: MIT
#include "maps/neighbours.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"

#include <string.h>

enum { SIDES_PER_CELL = 8, EXPONENT_BIAS = 127, EXPONENT_LIMIT = 255, SITES_PER_TICK = 1 << 16 };

typedef struct cell {
    int64_t x, y, z;
    int octave;
} cell;

// --- cells ---------------------------------------------------------------------------------------

/// ⌊log₂ side⌋ + EXPONENT_BIAS, 0 for the smallest.
static int find_octave(float side)
{
    const int octave = ilogbf(side) + EXPONENT_BIAS;
    return octave < 0 ? 0 : octave >= EXPONENT_LIMIT ? EXPONENT_LIMIT - 1 : octave;
}

static double cell_size(int octave)
{
    return ldexp(SIDES_PER_CELL, octave - EXPONENT_BIAS);
}

static int64_t find_cell(double coordinate, double size)
{
    return (int64_t)floor(coordinate / size);
}

static uint32_t hash_cell(const alpi_neighbours *n, const cell *c)
{
    uint64_t h = alpi_hash64((uint64_t)c->x ^ (uint64_t)c->octave << 56);
    h = alpi_hash64(h ^ (uint64_t)c->y);
    return (uint32_t)(alpi_hash64(h ^ (uint64_t)c->z) >> 32) & n->mask;
}

static cell cell_of(const alpi_site *site)
{
    const int octave = find_octave(site->side);
    const double size = cell_size(octave);
    return (cell){.x = find_cell((double)site->position.x, size),
                  .y = find_cell((double)site->position.y, size),
                  .z = find_cell((double)site->position.z, size),
                  .octave = octave};
}

/// Sides that neither they nor their squares leave the range of floats, and coordinates that
/// count cells.
static bool has_place(const alpi_site *s)
{
    const float side_limit = 1e15f, cell_limit = 1e15f;
    const vec3 p = s->position;
    return s->side > 1.0f / side_limit && s->side < side_limit && vec3_is_finite(s->normal) &&
           fmaxf(fmaxf(fabsf(p.x), fabsf(p.y)), fabsf(p.z)) < cell_limit * s->side &&
           vec3_is_finite(p);
}

// --- sorting -------------------------------------------------------------------------------------

/// Bucket of a site; one behind all for those without a place.
static uint32_t bucket_of(const alpi_neighbours *n, const alpi_site *s)
{
    if (!has_place(s)) {
        return n->mask + 1;
    }
    const cell c = cell_of(s);
    return hash_cell(n, &c);
}

static alp_result tick(const alpi_neighbours *n, uint32_t i)
{
    return i % SITES_PER_TICK == SITES_PER_TICK - 1
               ? alpi_tick(n->context, "neighbours", i, n->count)
               : ALP_OK;
}

static alpi_site make_site(const float (*positions)[3], const float (*normals)[3],
                           const float *sides, uint32_t texel)
{
    return (alpi_site){.position = vec3_load(positions[texel]),
                       .normal = vec3_load(normals[texel]),
                       .side = sides[texel],
                       .texel = texel};
}

static alp_result sort(const float (*positions)[3], const float (*normals)[3], const float *sides,
                       alpi_neighbours *n, uint32_t *buckets)
{
    uint32_t *first = n->first;
    for (uint32_t i = 0; i < n->count; i++) {
        const alpi_site s = make_site(positions, normals, sides, i);
        buckets[i] = bucket_of(n, &s);
        first[buckets[i]]++;
        if (has_place(&s)) {
            n->octaves[find_octave(s.side)] = true;
        }
        ALP_TRY(tick(n, i));
    }
    uint32_t sum = 0;
    for (uint32_t b = 0; b <= n->mask + 1; b++) {
        sum += first[b];
        first[b] = sum; // the end, for now
    }
    for (uint32_t i = n->count; i-- > 0;) {
        n->sites[--first[buckets[i]]] = make_site(positions, normals, sides, i);
        ALP_TRY(tick(n, i));
    }
    return ALP_OK;
}

alp_result alpi_neighbours_create(alp_context *context, uint32_t count, const float (*positions)[3],
                                  const float (*normals)[3], const float *sides,
                                  alpi_neighbours *neighbours)
{
    uint32_t size = 1;
    while (size < count && size < 1u << 30) {
        size *= 2;
    }
    *neighbours = (alpi_neighbours){.context = context, .count = count, .mask = size - 1};
    neighbours->sites = ALPI_NEW(context, alpi_site, count);
    neighbours->first = ALPI_NEW(context, uint32_t, (size_t)size + 1);
    uint32_t *buckets = ALPI_NEW(context, uint32_t, count);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (neighbours->sites != NULL && neighbours->first != NULL && buckets != NULL) {
        result = sort(positions, normals, sides, neighbours, buckets);
    }
    alpi_release(context, buckets);
    if (result != ALP_OK) {
        alpi_neighbours_destroy(neighbours);
    }
    return result;
}

void alpi_neighbours_destroy(alpi_neighbours *neighbours)
{
    if (neighbours->context != NULL) {
        alpi_release(neighbours->context, neighbours->sites);
        alpi_release(neighbours->context, neighbours->first);
    }
    *neighbours = (alpi_neighbours){0};
}

uint32_t alpi_neighbours_placed(const alpi_neighbours *neighbours)
{
    return neighbours->first[neighbours->mask + 1];
}

// --- searching -----------------------------------------------------------------------------------

typedef struct search {
    const alpi_neighbours *neighbours;
    const alpi_site *centre;
    float radius;
    uint32_t limit, count;
    uint32_t *near;
} search;

static bool is_near(const search *s, const alpi_site *site)
{
    const vec3 away = vec3_sub(site->position, s->centre->position);
    return vec3_dot(away, away) <= s->radius * s->radius &&
           fabsf(vec3_dot(away, s->centre->normal)) <= s->centre->side &&
           site->side <= 2.0f * s->centre->side && site->side >= 0.5f * s->centre->side;
}

/// Whether a cell reaches to within one side of the centre's plane.
static bool meets_plane(const search *s, const cell *c, double size)
{
    const vec3 n = s->centre->normal, p = s->centre->position;
    const double middle = (((double)c->x + 0.5) * size - (double)p.x) * (double)n.x +
                          (((double)c->y + 0.5) * size - (double)p.y) * (double)n.y +
                          (((double)c->z + 0.5) * size - (double)p.z) * (double)n.z;
    const double reach = 0.5 * size * (fabs((double)n.x) + fabs((double)n.y) + fabs((double)n.z));
    return fabs(middle) <= 1.001 * reach + (double)s->centre->side;
}

/// Different cells may share a bucket: each site is taken in its own cell alone.
static void look_in(search *s, const cell *c)
{
    const alpi_neighbours *n = s->neighbours;
    const uint32_t bucket = hash_cell(n, c);
    for (uint32_t i = n->first[bucket]; i < n->first[bucket + 1]; i++) {
        if (!is_near(s, &n->sites[i])) {
            continue;
        }
        const cell own = cell_of(&n->sites[i]);
        if (own.x == c->x && own.y == c->y && own.z == c->z && own.octave == c->octave) {
            if (s->count < s->limit) {
                s->near[s->count] = i;
            }
            s->count++;
        }
    }
}

static void search_octave(search *s, int octave)
{
    const double size = cell_size(octave), r = (double)s->radius;
    const vec3 p = s->centre->position;
    const cell low = {find_cell((double)p.x - r, size), find_cell((double)p.y - r, size),
                      find_cell((double)p.z - r, size), octave};
    const cell high = {find_cell((double)p.x + r, size), find_cell((double)p.y + r, size),
                       find_cell((double)p.z + r, size), octave};
    cell c = {.octave = octave};
    for (c.z = low.z; c.z <= high.z; c.z++) {
        for (c.y = low.y; c.y <= high.y; c.y++) {
            for (c.x = low.x; c.x <= high.x && s->count <= s->limit; c.x++) {
                if (meets_plane(s, &c, size)) {
                    look_in(s, &c);
                }
            }
        }
    }
}

uint32_t alpi_neighbours_around(const alpi_neighbours *neighbours, const alpi_site *centre,
                                float radius, uint32_t limit, uint32_t *near)
{
    search s = {neighbours, centre, radius, limit, 0, near};
    const int own = find_octave(centre->side);
    for (int octave = own > 0 ? own - 1 : 0; octave <= own + 1; octave++) {
        if (neighbours->octaves[octave]) {
            search_octave(&s, octave);
        }
    }
    return s.count <= limit ? s.count : limit + 1;
}
