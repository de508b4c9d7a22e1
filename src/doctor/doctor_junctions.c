// SPDX-License-Identifier: MIT
// The doctor's look for T-junctions: vertices that lie within an open edge of another triangle of
// the same object, of whatever material, which therefore does not know that it goes on there.
#include "doctor/doctor.h"

#include "atlas/atlas.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "scene/double3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// From the line through an edge, of the surface's diagonal and of the edge: files that hold six
/// digits are right to the first. Less than a few float steps of its coordinates nobody can ask.
static const double NEAR_OF_BOX = 1e-5, NEAR_OF_EDGE = 1e-3, STEPS = 4.0 * 0x1p-23;
/// Within an edge: so much of it away from both ends.
static const double FROM_ENDS = 0.01;
/// Sine up to which two edges run along one line.
static const double ALONG = 2e-3;
/// Cosine between the triangles, seen along the edge, up to which the one goes on from the other: a
/// box's corner, not two sheets that lie upon each other.
static const double UNFOLDED = 0.5;
/// Cells are as long as a surface's mean open edge, so that there are about as many as edges; no
/// less than this share of its box.
static const double LEAST_CELL = 1e-9;
/// Pairs that are looked at; where vertices crowd in a few cells there would be too many.
static const uint64_t LOOK_LIMIT = (uint64_t)1 << 27;

typedef struct edge {
    uint32_t half; // 3·triangle + k: from corner k to corner k + 1
    uint32_t object;
} edge;

/// The open edges of an object: of all primitives of a mesh, where it is shown once. Those that two
/// of them share, where the material changes, are not open.
typedef struct outline {
    double3 low, high; // of its open edges
    double length;     // of them together
    double cell;       // metres
    uint32_t count;    // open edges
} outline;

/// An end of an edge in a cell.
typedef struct entry {
    uint32_t edge, next; // next: of the same slot, ALPI_NONE = last
    bool second;
} entry;

typedef struct search {
    const alp_scene *scene;
    alp_context *context;
    edge *edges; // [edge_count]
    uint32_t edge_count;
    uint32_t *objects; // [surface_count] the first surface of its object
    outline *outlines; // [surface_count] by objects
    entry *entries;    // [entry_count]
    size_t entry_count, entry_capacity;
    uint32_t *slots; // [mask + 1]
    size_t mask;
    uint64_t looks;
    double *found;   // [surface_count] open edges with a vertex of another triangle in them
    double *longest; // [surface_count] of them
    uint32_t *worst_edge, *worst_other; // [surface_count] half-edge; vertex
} search;

static size_t table_size(size_t count)
{
    size_t size = 16;
    while (size < 2 * count) {
        size *= 2;
    }
    return size;
}

static uint32_t start_of(const search *s, uint32_t half)
{
    return s->scene->triangles[half / 3][half % 3];
}

static uint32_t end_of(const search *s, uint32_t half)
{
    return s->scene->triangles[half / 3][(half + 1) % 3];
}

static double3 point_of(const search *s, uint32_t vertex)
{
    return double3_from(vec3_load(s->scene->positions[vertex]));
}

// --- objects -------------------------------------------------------------------------------------

static bool is_same_object(const alpi_surface *a, const alpi_surface *b)
{
    return a->node == b->node && a->mesh == b->mesh && a->instance == b->instance;
}

/// Finds the surfaces that are primitives of one mesh at one place.
static alp_result find_objects(search *s)
{
    const uint32_t count = s->scene->surface_count;
    const size_t mask = table_size(count) - 1;
    ALPI_TRY_NEW(s->context, s->objects, count);
    uint32_t *table = ALPI_NEW(s->context, uint32_t, mask + 1);
    if (table == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    memset(table, 0xFF, (mask + 1) * sizeof *table);
    for (uint32_t i = 0; i < count; i++) {
        const alpi_surface *own = &s->scene->surfaces[i];
        size_t slot = (size_t)alpi_hash64(((uint64_t)own->node << 32 | own->mesh) ^
                                          alpi_hash64(own->instance));
        while (table[slot & mask] != ALPI_NONE &&
               !is_same_object(own, &s->scene->surfaces[table[slot & mask]])) {
            slot++;
        }
        table[slot & mask] = table[slot & mask] == ALPI_NONE ? i : table[slot & mask];
        s->objects[i] = table[slot & mask];
    }
    alpi_release(s->context, table);
    return ALP_OK;
}

// --- open edges ----------------------------------------------------------------------------------

static bool same_place(const search *s, uint32_t a, uint32_t b)
{
    const float *p = s->scene->positions[a], *q = s->scene->positions[b];
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

static uint64_t hash_place(const search *s, uint32_t vertex)
{
    uint32_t bits[3];
    for (int k = 0; k < 3; k++) {
        const float value = s->scene->positions[vertex][k] + 0.0f; // −0 becomes 0
        memcpy(&bits[k], &value, sizeof value);
    }
    return alpi_hash64(alpi_hash64(((uint64_t)bits[0] << 32) | bits[1]) ^ bits[2]);
}

/// Leaves edges out that come twice: there are three triangles, or one is turned.
static void drop_repeated(search *s, uint8_t *repeated)
{
    memset(s->slots, 0xFF, (s->mask + 1) * sizeof *s->slots);
    for (uint32_t i = 0; i < s->edge_count; i++) {
        const uint32_t a = start_of(s, s->edges[i].half), b = end_of(s, s->edges[i].half);
        size_t slot = (size_t)(hash_place(s, a) + hash_place(s, b)); // either way round
        for (slot ^= slot >> 32; s->slots[slot & s->mask] != ALPI_NONE; slot++) {
            const uint32_t there = s->slots[slot & s->mask];
            const uint32_t c = start_of(s, s->edges[there].half);
            const uint32_t d = end_of(s, s->edges[there].half);
            if ((same_place(s, a, c) && same_place(s, b, d)) ||
                (same_place(s, a, d) && same_place(s, b, c))) {
                repeated[i] = repeated[there] = 1;
                break;
            }
        }
        if (repeated[i] == 0) {
            s->slots[slot & s->mask] = i;
        }
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->edge_count; i++) {
        s->edges[kept] = s->edges[i];
        kept += repeated[i] == 0;
    }
    s->edge_count = kept;
}

static void collect_edges(search *s, const uint32_t (*neighbours)[3])
{
    for (uint32_t t = 0; t < s->scene->triangle_count; t++) {
        for (uint32_t k = 0; k < 3 && s->scene->triangle_usable[t]; k++) {
            if (neighbours[t][k] == ALPI_NONE) {
                s->edges[s->edge_count++] =
                    (edge){3 * t + k, s->objects[s->scene->triangle_surface[t]]};
            }
        }
    }
}

static alp_result find_edges(search *s, const uint32_t (*neighbours)[3])
{
    uint32_t open = 0;
    for (uint32_t t = 0; t < s->scene->triangle_count; t++) {
        for (int k = 0; k < 3 && s->scene->triangle_usable[t]; k++) {
            open += neighbours[t][k] == ALPI_NONE;
        }
    }
    s->mask = table_size(open) - 1;
    s->edges = ALPI_NEW(s->context, edge, open);
    s->slots = ALPI_NEW(s->context, uint32_t, s->mask + 1);
    uint8_t *repeated = ALPI_NEW(s->context, uint8_t, open);
    const bool made = s->edges != NULL && s->slots != NULL && repeated != NULL;
    if (made) {
        collect_edges(s, neighbours);
        drop_repeated(s, repeated);
    }
    alpi_release(s->context, repeated);
    return made ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}

static void measure_outlines(search *s)
{
    for (uint32_t i = 0; i < s->edge_count; i++) {
        outline *o = &s->outlines[s->edges[i].object];
        const double3 a = point_of(s, start_of(s, s->edges[i].half));
        const double3 b = point_of(s, end_of(s, s->edges[i].half));
        if (o->count++ == 0) {
            o->low = o->high = a;
        }
        o->length += double3_length(double3_sub(b, a));
        o->low = (double3){fmin(o->low.x, fmin(a.x, b.x)), fmin(o->low.y, fmin(a.y, b.y)),
                           fmin(o->low.z, fmin(a.z, b.z))};
        o->high = (double3){fmax(o->high.x, fmax(a.x, b.x)), fmax(o->high.y, fmax(a.y, b.y)),
                            fmax(o->high.z, fmax(a.z, b.z))};
    }
    for (uint32_t i = 0; i < s->scene->surface_count; i++) {
        outline *o = &s->outlines[i];
        const double diagonal = double3_length(double3_sub(o->high, o->low));
        o->cell = fmax(o->length / fmax(o->count, 1.0), LEAST_CELL * diagonal);
    }
}

// --- cells ---------------------------------------------------------------------------------------

static double largest_coordinate(const outline *o)
{
    const double low = fmax(fabs(o->low.x), fmax(fabs(o->low.y), fabs(o->low.z)));
    return fmax(low, fmax(fabs(o->high.x), fmax(fabs(o->high.y), fabs(o->high.z))));
}

/// How near a vertex must be to an edge of that length.
static double nearness(const outline *o, double length)
{
    const double diagonal = double3_length(double3_sub(o->high, o->low));
    return fmax(fmin(NEAR_OF_BOX * diagonal, NEAR_OF_EDGE * length), STEPS * largest_coordinate(o));
}

static int64_t cell_of(double value, double low, double cell)
{
    return (int64_t)floor((value - low) / cell);
}

static size_t slot_of(const search *s, uint32_t object, const int64_t cell[3])
{
    uint64_t hash = alpi_hash64(object);
    for (int k = 0; k < 3; k++) {
        hash = alpi_hash64(hash ^ (uint64_t)cell[k]);
    }
    return (size_t)hash & s->mask;
}

/// An end into the cells that it is near to, mostly one.
static alp_result put_end(search *s, uint32_t index, bool second)
{
    const edge *e = &s->edges[index];
    const outline *o = &s->outlines[e->object];
    const double3 p = point_of(s, second ? end_of(s, e->half) : start_of(s, e->half));
    const double reach = 2.0 * nearness(o, HUGE_VAL); // room for rounding on the way
    const int64_t low[3] = {cell_of(p.x - reach, o->low.x, o->cell),
                            cell_of(p.y - reach, o->low.y, o->cell),
                            cell_of(p.z - reach, o->low.z, o->cell)};
    int64_t high[3] = {cell_of(p.x + reach, o->low.x, o->cell),
                       cell_of(p.y + reach, o->low.y, o->cell),
                       cell_of(p.z + reach, o->low.z, o->cell)};
    int64_t cell[3];
    for (int k = 0; k < 3; k++) { // a box of edges shorter than `reach`: its own cell and the next
        high[k] = high[k] > low[k] + 2 ? low[k] + 2 : high[k];
    }
    for (cell[0] = low[0]; cell[0] <= high[0]; cell[0]++) {
        for (cell[1] = low[1]; cell[1] <= high[1]; cell[1]++) {
            for (cell[2] = low[2]; cell[2] <= high[2]; cell[2]++) {
                ALP_TRY(alpi_grow(s->context, (void **)&s->entries, &s->entry_capacity,
                                  s->entry_count + 1, sizeof *s->entries));
                const size_t slot = slot_of(s, e->object, cell);
                s->entries[s->entry_count] = (entry){index, s->slots[slot], second};
                s->slots[slot] = (uint32_t)s->entry_count++;
            }
        }
    }
    return ALP_OK;
}

static alp_result put_ends(search *s)
{
    alpi_release(s->context, s->slots);
    s->mask = table_size(2 * (size_t)s->edge_count) - 1;
    s->slots = NULL;
    ALPI_TRY_NEW(s->context, s->slots, s->mask + 1);
    memset(s->slots, 0xFF, (s->mask + 1) * sizeof *s->slots);
    for (uint32_t i = 0; i < s->edge_count; i++) {
        if (s->outlines[s->edges[i].object].count > 3) { // one triangle has nobody to meet
            ALP_TRY(put_end(s, i, false));
            ALP_TRY(put_end(s, i, true));
        }
    }
    return ALP_OK;
}

// --- junctions -----------------------------------------------------------------------------------

/// The part of a vector that is across a unit direction.
static double3 across(double3 v, double3 direction)
{
    return double3_sub(v, double3_scale(direction, double3_dot(v, direction)));
}

/// Whether the end of another edge lies within this one, and that triangle goes on where this ends.
static bool is_junction(const search *s, const edge *e, const entry *other)
{
    const uint32_t half = e->half, there = s->edges[other->edge].half;
    const double3 a = point_of(s, start_of(s, half)), b = point_of(s, end_of(s, half));
    const double length = double3_length(double3_sub(b, a));
    const double3 direction = double3_unit(double3_sub(b, a));
    const double3 v = point_of(s, other->second ? end_of(s, there) : start_of(s, there));
    const double3 w = point_of(s, other->second ? start_of(s, there) : end_of(s, there));
    const double3 to = double3_sub(v, a), on = double3_sub(w, v);
    const double along = double3_dot(to, direction);
    if (half / 3 == there / 3 || !(along > FROM_ENDS * length) ||
        !(along < (1.0 - FROM_ENDS) * length) ||
        !(double3_length(across(to, direction)) <= nearness(&s->outlines[e->object], length)) ||
        !(double3_length(across(on, direction)) <=
          fmax(ALONG * double3_length(on), nearness(&s->outlines[e->object], length)))) {
        return false;
    }
    const double3 own = across(
        double3_sub(point_of(s, s->scene->triangles[half / 3][(half + 2) % 3]), a), direction);
    const double3 its = across(
        double3_sub(point_of(s, s->scene->triangles[there / 3][(there + 2) % 3]), v), direction);
    return double3_dot(own, its) <= UNFOLDED * double3_length(own) * double3_length(its);
}

/// @return the vertex within the edge, ALPI_NONE = none in this cell
static uint32_t look_in_cell(search *s, const edge *e, const int64_t cell[3])
{
    for (uint32_t i = s->slots[slot_of(s, e->object, cell)]; i != ALPI_NONE;
         i = s->entries[i].next) {
        const entry *other = &s->entries[i];
        const uint32_t there = s->edges[other->edge].half;
        if (++s->looks > LOOK_LIMIT) {
            return ALPI_NONE;
        }
        if (s->edges[other->edge].object == e->object && is_junction(s, e, other)) {
            return other->second ? end_of(s, there) : start_of(s, there);
        }
    }
    return ALPI_NONE;
}

/// Walks along the edge from cell to cell.
/// Based on: J. Amanatides, A. Woo. A Fast Voxel Traversal Algorithm for Ray Tracing. EG 1987.
static uint32_t walk(search *s, const edge *e)
{
    const outline *o = &s->outlines[e->object];
    const double3 a = point_of(s, start_of(s, e->half)), b = point_of(s, end_of(s, e->half));
    const double from[3] = {(a.x - o->low.x) / o->cell, (a.y - o->low.y) / o->cell,
                            (a.z - o->low.z) / o->cell};
    const double to[3] = {(b.x - o->low.x) / o->cell, (b.y - o->low.y) / o->cell,
                          (b.z - o->low.z) / o->cell};
    int64_t cell[3], left = 0;
    double next[3];
    for (int k = 0; k < 3; k++) {
        cell[k] = (int64_t)floor(from[k]);
        left += llabs((int64_t)floor(to[k]) - cell[k]);
        const double border = (double)cell[k] + (to[k] > from[k] ? 1.0 : 0.0);
        next[k] = to[k] != from[k] ? (border - from[k]) / (to[k] - from[k]) : HUGE_VAL;
    }
    for (;; left--) {
        const uint32_t found = look_in_cell(s, e, cell);
        if (found != ALPI_NONE || left <= 0 || s->looks > LOOK_LIMIT) {
            return found;
        }
        const int axis = next[0] <= next[1] && next[0] <= next[2] ? 0 : next[1] <= next[2] ? 1 : 2;
        cell[axis] += to[axis] > from[axis] ? 1 : -1;
        next[axis] += fabs(1.0 / (to[axis] - from[axis]));
    }
}

static alp_result look(search *s, const uint32_t (*neighbours)[3])
{
    ALPI_TRY_NEW(s->context, s->outlines, s->scene->surface_count);
    ALPI_TRY_NEW(s->context, s->found, s->scene->surface_count);
    ALPI_TRY_NEW(s->context, s->longest, s->scene->surface_count);
    ALPI_TRY_NEW(s->context, s->worst_edge, s->scene->surface_count);
    ALPI_TRY_NEW(s->context, s->worst_other, s->scene->surface_count);
    ALP_TRY(find_objects(s));
    ALP_TRY(find_edges(s, neighbours));
    measure_outlines(s);
    ALP_TRY(put_ends(s));
    for (uint32_t i = 0; i < s->edge_count; i++) {
        ALP_TRY(i % 65536 == 0 ? alpi_tick(s->context, "diagnose", i, s->edge_count) : ALP_OK);
        const edge *e = &s->edges[i];
        const uint32_t vertex = s->outlines[e->object].count > 3 ? walk(s, e) : ALPI_NONE;
        if (vertex == ALPI_NONE) {
            continue;
        }
        const uint32_t surface = s->scene->triangle_surface[e->half / 3];
        const double length = double3_length(
            double3_sub(point_of(s, end_of(s, e->half)), point_of(s, start_of(s, e->half))));
        s->found[surface]++;
        if (length > s->longest[surface]) {
            s->longest[surface] = length;
            s->worst_edge[surface] = e->half;
            s->worst_other[surface] = vertex;
        }
    }
    return ALP_OK;
}

static alp_result tell(alp_diagnosis *d, const search *s)
{
    uint32_t worst[ALPI_DOCTOR_SURFACES], all;
    const uint32_t count = alpi_doctor_choose_worst(d->scene, s->found, worst, &all);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t half = s->worst_edge[worst[i]];
        const alpi_surface *surface = &d->scene->surfaces[worst[i]];
        const uint64_t edges = (uint64_t)s->found[worst[i]];
        const alpi_finding_facts facts = {ALP_FINDING_T_JUNCTIONS, ALP_PLACE_SURFACE, worst[i],
                                          edges, s->longest[worst[i]]};
        ALP_TRY(alpi_diagnosis_add(d, facts,
                                   "%s%llu open edge%s a vertex of another triangle inside; the "
                                   "longest (%.3g m) belongs to triangle %u",
                                   s->looks > LOOK_LIMIT ? "at least " : "",
                                   (unsigned long long)edges,
                                   alpi_one_or_many(edges, " has", "s have"), s->longest[worst[i]],
                                   half / 3 - surface->first_triangle));
        alpi_diagnosis_mark(d, half / 3, vec3_load(d->scene->positions[s->worst_other[worst[i]]]),
                            NULL);
    }
    return ALP_OK;
}

alp_result alpi_doctor_look_at_junctions(alp_diagnosis *diagnosis)
{
    const alp_scene *scene = diagnosis->scene;
    if (scene->usable_count == 0) {
        return ALP_OK;
    }
    search s = {.scene = scene, .context = diagnosis->context};
    alp_result result = look(&s, (const uint32_t(*)[3])diagnosis->neighbours);
    if (result == ALP_OK) {
        result = tell(diagnosis, &s);
    }
    void *const own[] = {s.objects, s.edges,   s.outlines,   s.entries,    s.slots,
                         s.found,   s.longest, s.worst_edge, s.worst_other};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
        alpi_release(scene->context, own[i]);
    }
    return result;
}
