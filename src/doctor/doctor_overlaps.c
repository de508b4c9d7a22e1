// SPDX-License-Identifier: MIT
// The doctor's look for faces that lie in one plane, look the same way and share a part of their
// place: which of them is seen is rounding. Those that share all corners are duplicates
// (doctor_mesh.c). Where there are very many, some are asked whether they are seen, the larger ones
// more likely.
// Based on: N. Duffield, C. Lund, M. Thorup. Priority Sampling for Estimation of Arbitrary Subset
// Sums. Journal of the ACM 54(6), 2007.
#include "doctor/doctor_pairs.h"
#include "doctor/doctor_rays.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "scene/double3.h"

#include <math.h>
#include <stdlib.h>

/// What is shared is narrower than this: of the shorter triangle's longest edge, and of the
/// rounding of coordinates. Edges that were meant to meet reach over each other by that much.
static const double NARROW_OF_EDGE = 1e-3, NARROW_OF_ROUNDING = 16.0;
/// Of a surface's area: less is what a square of a hundredth of its length has.
static const double WORTH_A_WORD = 1e-4;
/// Overlaps whose sight is asked; the others are not told, for most of so many lie where solids are
/// joined, and nobody sees them.
enum { SIGHT_LIMIT = 1 << 14, STREAM_OVERLAPS = 203, CORNERS = 6, SIGHTS_PER_TICK = 1 << 10 };

/// Of the rays of an overlap that nobody sees. Half, as of what is buried (doctor_sides.c), is more
/// than where solids are joined closely: on the columns of builtin:atrium most rays meet fronts of
/// what else is inside. In a good place it is a tenth (doctor_backs.c).
enum { BACKS_INSIDE = ALPI_DOCTOR_RAYS / 4 };

/// Convex, counter-clockwise, in a plane: of two triangles at most six corners.
typedef struct polygon {
    int count;
    double p[CORNERS + 1][2];
} polygon;

/// A triangle in double precision.
typedef struct facet {
    double3 c[3], normal;
    double longest; // edge
} facet;

typedef struct overlap {
    double area; // m²
    double3 at;  // middle
} overlap;

/// An overlap whose sight may be asked.
typedef struct candidate {
    overlap shared;
    uint32_t first, second; // triangles
    uint64_t order;         // of its finding
    double priority;        // those of the highest are asked
} candidate;

typedef struct search {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    candidate *kept; // [kept_count] a heap, the lowest priority first; in the end by order
    size_t kept_count, kept_capacity;
    uint64_t found;
    double *sizes;   // [surface_count] m², 0: not known yet
    uint8_t *flags;  // [triangle_count] 1: lies in another one
    double *areas;   // [surface_count] m² that lie in others
    double *largest; // [surface_count] of one pair
    uint32_t *worst; // [surface_count] the later triangle of that pair
    uint32_t *with;  // [surface_count] surface of the other one
    float (*at)[3];  // [surface_count]
    bool all;        // pairs were visited, and sights asked
} search;

// --- two triangles -------------------------------------------------------------------------------

static facet load_facet(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    facet f = {.longest = 0.0};
    alpi_triangle_corners(scene, triangle, c);
    for (int k = 0; k < 3; k++) {
        f.c[k] = double3_from(c[k]);
    }
    for (int k = 0; k < 3; k++) {
        f.longest = fmax(f.longest, double3_length(double3_sub(f.c[(k + 1) % 3], f.c[k])));
    }
    f.normal =
        double3_unit(double3_cross(double3_sub(f.c[1], f.c[0]), double3_sub(f.c[2], f.c[0])));
    return f;
}

/// Whether all corners of one are those of the other, in any order.
static bool is_twin(const facet *a, const facet *b)
{
    int same = 0;
    for (int j = 0; j < 3; j++) {
        for (int k = 0; k < 3; k++) {
            same += a->c[j].x == b->c[k].x && a->c[j].y == b->c[k].y && a->c[j].z == b->c[k].z;
        }
    }
    return same >= 3;
}

/// Cuts off what is right of the line from `from` to `to`.
static void cut(polygon *shape, const double from[2], const double to[2])
{
    const double along[2] = {to[0] - from[0], to[1] - from[1]};
    double sides[CORNERS + 1];
    polygon kept = {.count = 0};
    for (int i = 0; i < shape->count; i++) {
        sides[i] = along[0] * (shape->p[i][1] - from[1]) - along[1] * (shape->p[i][0] - from[0]);
    }
    for (int i = 0; i < shape->count; i++) {
        const int next = (i + 1) % shape->count;
        if (sides[i] >= 0.0 && kept.count <= CORNERS) {
            kept.p[kept.count][0] = shape->p[i][0];
            kept.p[kept.count++][1] = shape->p[i][1];
        }
        if ((sides[i] >= 0.0) != (sides[next] >= 0.0) && kept.count <= CORNERS) {
            const double share = sides[i] / (sides[i] - sides[next]);
            for (int k = 0; k < 2; k++) {
                kept.p[kept.count][k] =
                    shape->p[i][k] + share * (shape->p[next][k] - shape->p[i][k]);
            }
            kept.count++;
        }
    }
    *shape = kept;
}

/// Whether a line along an edge of `a` has no corner of `b` farther to the left than `narrow`.
static bool is_beside(const polygon *a, const polygon *b, double narrow)
{
    for (int k = 0; k < 3; k++) {
        const double *from = a->p[k], *to = a->p[(k + 1) % 3];
        const double along[2] = {to[0] - from[0], to[1] - from[1]};
        const double limit =
            narrow > 0.0 ? narrow * sqrt(along[0] * along[0] + along[1] * along[1]) : 0.0;
        bool beside = true;
        for (int i = 0; i < 3; i++) {
            beside = beside &&
                     along[0] * (b->p[i][1] - from[1]) - along[1] * (b->p[i][0] - from[0]) <= limit;
        }
        if (beside) {
            return true;
        }
    }
    return false;
}

/// Area and middle. @return twice the area over the circumference: half the width of a long shape
static double measure(const polygon *shape, double *area, double middle[2])
{
    double sum = 0.0, around = 0.0, at[2] = {0.0, 0.0};
    for (int i = 0; i < shape->count; i++) {
        const double *p = shape->p[i], *q = shape->p[(i + 1) % shape->count], *o = shape->p[0];
        const double part = 0.5 * ((p[0] - o[0]) * (q[1] - o[1]) - (q[0] - o[0]) * (p[1] - o[1]));
        sum += part;
        around += hypot(q[0] - p[0], q[1] - p[1]);
        for (int k = 0; k < 2; k++) {
            at[k] += part * (p[k] + q[k] + o[k]) / 3.0;
        }
    }
    *area = sum;
    for (int k = 0; k < 2; k++) {
        middle[k] = sum > 0.0 ? at[k] / sum : 0.0;
    }
    return around > 0.0 ? 2.0 * sum / around : 0.0;
}

/// What two triangles that look the same way share, seen along the normal of the first.
/// @param rounding how far apart they may be, metres
static bool find_overlap(const facet *a, const facet *b, double rounding, overlap *shared)
{
    const double3 u = double3_unit(double3_sub(a->c[1], a->c[0])), v = double3_cross(a->normal, u);
    const double lean = double3_dot(a->normal, b->normal);
    const double narrow =
        fmax(NARROW_OF_EDGE * fmin(a->longest, b->longest), NARROW_OF_ROUNDING * rounding);
    polygon shape = {.count = 3}, other = {.count = 3};
    for (int k = 0; k < 3; k++) {
        const double3 to = double3_sub(a->c[k], a->c[0]), there = double3_sub(b->c[k], a->c[0]);
        shape.p[k][0] = double3_dot(to, u);
        shape.p[k][1] = double3_dot(to, v);
        other.p[k][0] = double3_dot(there, u);
        other.p[k][1] = double3_dot(there, v);
    }
    if (!(lean > 0.0) || is_beside(&shape, &other, narrow) || is_beside(&other, &shape, narrow)) {
        return false;
    }
    for (int k = 0; k < 3 && shape.count > 0; k++) {
        cut(&shape, other.p[k], other.p[(k + 1) % 3]);
    }
    double middle[2];
    if (!(measure(&shape, &shared->area, middle) > narrow)) {
        return false;
    }
    for (int i = 0; i < shape.count; i++) { // how high b is above a
        const double3 at = double3_add(
            a->c[0], double3_add(double3_scale(u, shape.p[i][0]), double3_scale(v, shape.p[i][1])));
        const double height = double3_dot(double3_sub(b->c[0], at), b->normal) / lean;
        if (!(fabs(height) <= 2.0 * rounding)) { // either may be moved
            return false;
        }
    }
    shared->at =
        double3_add(a->c[0], double3_add(double3_scale(u, middle[0]), double3_scale(v, middle[1])));
    return true;
}

// --- sight ---------------------------------------------------------------------------------------

/// Whether an overlap is seen, as far as is asked: not inside of something, as surfaces are that
/// are buried.
static bool is_seen(const search *s, const candidate *o)
{
    uint32_t open = 0, backs = 0;
    vec3 c[3];
    alpi_triangle_corners(s->scene, o->second, c);
    const facet f = load_facet(s->scene, o->second);
    const double3 start =
        double3_add(o->shared.at, double3_scale(f.normal, 4.0 * alpi_doctor_rounding(c)));
    const alpi_doctor_eye eye = {double3_to_vec3(start), double3_to_vec3(f.normal),
                                 alpi_random_key(0, o->second, STREAM_OVERLAPS), true};
    for (uint32_t first = 0; first < ALPI_DOCTOR_RAYS && open == 0; first += ALPI_PACKET) {
        alpi_doctor_hit hits[ALPI_PACKET];
        alpi_doctor_look(s->scene, s->tracer, &eye, first, hits);
        for (int i = 0; i < ALPI_PACKET; i++) {
            open += hits[i].triangle == ALPI_NONE;
            backs += hits[i].back;
        }
    }
    return open > 0 || backs < BACKS_INSIDE;
}

// --- which are asked -----------------------------------------------------------------------------

static double surface_area(search *s, uint32_t index)
{
    const alpi_surface *surface = &s->scene->surfaces[index];
    if (s->sizes[index] > 0.0) {
        return s->sizes[index];
    }
    for (uint32_t t = surface->first_triangle;
         t < surface->first_triangle + surface->triangle_count; t++) {
        vec3 c[3];
        alpi_triangle_corners(s->scene, t, c);
        s->sizes[index] +=
            s->scene->triangle_usable[t] ? vec3_triangle_area(c[0], c[1], c[2]) : 0.0;
    }
    return s->sizes[index];
}

static bool is_lower(const candidate *a, const candidate *b)
{
    return a->priority != b->priority ? a->priority < b->priority : a->order > b->order;
}

static void swap(candidate *a, candidate *b)
{
    const candidate kept = *a;
    *a = *b;
    *b = kept;
}

/// Keeps one of those of the highest priority that were found so far.
static alp_result keep(search *s, const candidate *found)
{
    size_t at = 0;
    if (s->kept_count < SIGHT_LIMIT) {
        void *kept = s->kept;
        ALP_TRY(alpi_grow(s->scene->context, &kept, &s->kept_capacity, s->kept_count + 1,
                          sizeof *found));
        s->kept = kept;
        at = s->kept_count++;
        s->kept[at] = *found;
        for (; at > 0 && is_lower(&s->kept[at], &s->kept[(at - 1) / 2]); at = (at - 1) / 2) {
            swap(&s->kept[at], &s->kept[(at - 1) / 2]);
        }
        return ALP_OK;
    }
    if (is_lower(found, &s->kept[0])) {
        return ALP_OK;
    }
    s->kept[0] = *found;
    for (size_t low = 1; low < s->kept_count; low = 2 * at + 1) {
        low += low + 1 < s->kept_count && is_lower(&s->kept[low + 1], &s->kept[low]);
        if (!is_lower(&s->kept[low], &s->kept[at])) {
            break;
        }
        swap(&s->kept[low], &s->kept[at]);
        at = low;
    }
    return ALP_OK;
}

static int compare_orders(const void *a, const void *b)
{
    const candidate *p = a, *q = b;
    return (p->order > q->order) - (p->order < q->order);
}

// --- all of them ---------------------------------------------------------------------------------

/// Whether two triangles that look about the same way have a line along an edge between them, or
/// touch there; seen along an axis, without any rounding. Most that meet a flat one do.
static bool is_apart(const alp_scene *scene, uint32_t a, uint32_t b)
{
    polygon seen[2] = {{.count = 3}, {.count = 3}};
    const uint32_t triangles[2] = {a, b};
    const float *p = scene->positions[scene->triangles[a][0]];
    const vec3 o = vec3_load(p),
               u = vec3_sub(vec3_load(scene->positions[scene->triangles[a][1]]), o),
               v = vec3_sub(vec3_load(scene->positions[scene->triangles[a][2]]), o);
    const vec3 normal = vec3_cross(u, v);
    const float x = fabsf(normal.x), y = fabsf(normal.y), z = fabsf(normal.z);
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const bool turned = (axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z) < 0.0f;
    const int first = (axis + (turned ? 2 : 1)) % 3, second = (axis + (turned ? 1 : 2)) % 3;
    for (int i = 0; i < 6; i++) {
        const float *c = scene->positions[scene->triangles[triangles[i / 3]][i % 3]];
        seen[i / 3].p[i % 3][0] = (double)c[first];
        seen[i / 3].p[i % 3][1] = (double)c[second];
    }
    return is_beside(&seen[0], &seen[1], 0.0) || is_beside(&seen[1], &seen[0], 0.0);
}

/// Called for pairs, the earlier triangle first.
static alp_result look_at_pair(void *user, uint32_t a, uint32_t b)
{
    search *s = user;
    if (is_apart(s->scene, a, b)) {
        return ALP_OK;
    }
    const facet first = load_facet(s->scene, a), second = load_facet(s->scene, b);
    vec3 c[3];
    overlap o;
    alpi_triangle_corners(s->scene, b, c);
    const double rounding = alpi_doctor_rounding(c);
    if (is_twin(&first, &second) || !find_overlap(&first, &second, rounding, &o)) {
        return ALP_OK;
    }
    const uint64_t pair = alpi_hash64(alpi_hash64(STREAM_OVERLAPS) ^ ((uint64_t)a << 32 | b));
    const double random = (double)((pair >> 11) + 1) * 0x1p-53; // (0, 1]
    const double share = o.area / surface_area(s, s->scene->triangle_surface[b]);
    const candidate found = {o, a, b, s->found++, share / random};
    return keep(s, &found);
}

/// Notes the overlaps that are seen, of those that were kept.
static alp_result look_at_kept(search *s)
{
    if (s->kept_count > 0) {
        qsort(s->kept, s->kept_count, sizeof *s->kept, compare_orders);
    }
    for (size_t i = 0; i < s->kept_count; i++) {
        const candidate *o = &s->kept[i];
        const uint32_t surface = s->scene->triangle_surface[o->second];
        if (i % SIGHTS_PER_TICK == SIGHTS_PER_TICK - 1) {
            ALP_TRY(alpi_tick(s->scene->context, "diagnose", i, s->kept_count));
        }
        if (!is_seen(s, o)) {
            continue;
        }
        s->flags[o->second] = 1;
        s->areas[surface] += o->shared.area;
        if (o->shared.area > s->largest[surface]) {
            s->largest[surface] = o->shared.area;
            s->worst[surface] = o->second;
            s->with[surface] = s->scene->triangle_surface[o->first];
            vec3_store(s->at[surface], double3_to_vec3(o->shared.at));
        }
    }
    s->all = s->all && s->found == s->kept_count;
    return ALP_OK;
}

/// Shares of surfaces in the place of their areas. @param counts [surface_count] out: triangles
static void find_shares(const search *s, uint32_t *counts)
{
    for (uint32_t i = 0; i < s->scene->surface_count; i++) {
        const alpi_surface *surface = &s->scene->surfaces[i];
        for (uint32_t k = 0; k < surface->triangle_count && s->areas[i] > 0.0; k++) {
            counts[i] += s->flags[surface->first_triangle + k];
        }
        // Where three lie in one place the later ones are counted twice.
        const double share = s->sizes[i] > 0.0 ? fmin(s->areas[i] / s->sizes[i], 1.0) : 0.0;
        s->areas[i] = share >= WORTH_A_WORD ? share : 0.0;
    }
}

static alp_result tell(alp_diagnosis *d, const search *s, uint32_t *counts)
{
    uint32_t worst[ALPI_DOCTOR_SURFACES], all;
    find_shares(s, counts);
    const uint32_t told = alpi_doctor_choose_worst(d->scene, s->areas, worst, &all);
    for (uint32_t i = 0; i < told; i++) {
        const uint32_t surface = worst[i], with = s->with[surface];
        const alpi_finding_facts facts = {ALP_FINDING_COPLANAR, ALP_PLACE_SURFACE, surface,
                                          counts[surface], s->areas[surface]};
        ALP_TRY(alpi_diagnosis_add(
            d, facts,
            "%s%u of %u triangle%s %s in one plane with others and %s them in part, of %s, by "
            "%.2g m² at most",
            s->all ? "" : "at least ", counts[surface], d->scene->surfaces[surface].triangle_count,
            alpi_plural(d->scene->surfaces[surface].triangle_count),
            alpi_one_or_many(counts[surface], "lies", "lie"),
            alpi_one_or_many(counts[surface], "overlaps", "overlap"),
            with == surface ? "itself" : alpi_doctor_label(d->scene, with).text,
            s->largest[surface]));
        alpi_diagnosis_mark(d, s->worst[surface], vec3_load(s->at[surface]), NULL);
    }
    return ALP_OK;
}

static alp_result look(alp_diagnosis *d, search *s)
{
    const uint32_t count = d->scene->surface_count;
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(d->scene, NULL, NULL, &tracer, NULL));
    s->tracer = tracer;
    ALPI_TRY_NEW(d->context, s->flags, d->scene->triangle_count);
    ALPI_TRY_NEW(d->context, s->areas, count);
    ALPI_TRY_NEW(d->context, s->sizes, count);
    ALPI_TRY_NEW(d->context, s->largest, count);
    ALPI_TRY_NEW(d->context, s->worst, count);
    ALPI_TRY_NEW(d->context, s->with, count);
    ALPI_TRY_NEW(d->context, s->at, count);
    bool visited = true;
    ALP_TRY(alpi_doctor_visit_pairs(d->scene, look_at_pair, s, &visited));
    s->all = s->all && visited;
    ALP_TRY(look_at_kept(s));
    uint32_t *counts = ALPI_NEW(d->context, uint32_t, count);
    const alp_result result = counts != NULL ? tell(d, s, counts) : ALP_ERROR_OUT_OF_MEMORY;
    alpi_release(d->context, counts);
    return result;
}

alp_result alpi_doctor_look_at_overlaps(alp_diagnosis *diagnosis)
{
    if (diagnosis->scene->usable_count == 0) {
        return ALP_OK;
    }
    search s = {.scene = diagnosis->scene, .all = true};
    const alp_result result = look(diagnosis, &s);
    void *const own[] = {s.kept, s.sizes, s.flags, s.areas, s.largest, s.worst, s.with, s.at};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
        alpi_release(diagnosis->context, own[i]);
    }
    return result;
}
