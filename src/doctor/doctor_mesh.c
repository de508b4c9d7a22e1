// SPDX-License-Identifier: MIT
// The doctor's look at geometry: what is there at all, twice, turned round, too large or too far.
#include "doctor/doctor.h"

#include "base/hash.h"
#include "base/memory.h"
#include "base/tasks.h"
#include "scene/sides.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Normals against their triangle count from this share of a surface on: less are modelling slips
/// at sharp points, which nobody sees.
static const double REVERSED_SHARE = 0.01;
/// A scene with a longer side may be in centimetres: few indoor scenes and buildings are longer.
/// One with a longest side below may be in kilometres or metres that were divided once too often.
static const double LARGEST_SIDE = 300.0, SMALLEST_SIDE = 0.02;
enum { TEXT_SIZE = 256 }; // of all units with their sizes

static const double NO_VALUE = (double)NAN;

// --- anything at all -----------------------------------------------------------------------------

static alp_result look_for_triangles(alp_diagnosis *d)
{
    const alp_scene *scene = d->scene;
    if (scene->usable_count > 0) {
        return ALP_OK;
    }
    const alpi_finding_facts facts = {
        .kind = ALP_FINDING_NO_TRIANGLES, .count = scene->triangle_count, .value = NO_VALUE};
    if (scene->triangle_count == 0) {
        return alpi_diagnosis_add(d, facts, "nothing to bake: there are no triangles");
    }
    return alpi_diagnosis_add(d, facts, "nothing to bake: none of %u triangle%s can be used",
                              scene->triangle_count, alpi_plural(scene->triangle_count));
}

/// One finding for all triangles without area, at the first surface that has any.
static alp_result look_for_flat(alp_diagnosis *d)
{
    const alp_scene *scene = d->scene;
    alpi_finding_facts facts = {
        .kind = ALP_FINDING_ZERO_AREA, .place = ALP_PLACE_SURFACE, .value = NO_VALUE};
    uint32_t surfaces = 0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        if (scene->surfaces[s].flat_count > 0) {
            facts.index = surfaces++ == 0 ? s : facts.index;
            facts.count += scene->surfaces[s].flat_count;
        }
    }
    if (surfaces == 0) {
        return ALP_OK;
    }
    const uint32_t first = scene->surfaces[facts.index].flat_count;
    const uint32_t of = scene->surfaces[facts.index].triangle_count;
    return surfaces == 1
               ? alpi_diagnosis_add(d, facts, "%u of %u triangle%s %s no area", first, of,
                                    alpi_plural(of), alpi_one_or_many(first, "has", "have"))
               : alpi_diagnosis_add(d, facts,
                                    "%u of %u triangle%s %s no area (%llu in %u surfaces)", first,
                                    of, alpi_plural(of), alpi_one_or_many(first, "has", "have"),
                                    (unsigned long long)facts.count, surfaces);
}

// --- the same place twice ------------------------------------------------------------------------

/// Corners of a triangle in one order, whatever the file's, and whether that turned it round.
typedef struct corners {
    float at[3][3];
    bool turned;
} corners;

static int compare_points(const float *a, const float *b)
{
    for (int k = 0; k < 3; k++) {
        if (a[k] != b[k]) {
            return a[k] < b[k] ? -1 : 1;
        }
    }
    return 0;
}

static bool are_same(const corners *a, const corners *b)
{
    return compare_points(a->at[0], b->at[0]) == 0 && compare_points(a->at[1], b->at[1]) == 0 &&
           compare_points(a->at[2], b->at[2]) == 0;
}

static void order_two(corners *c, int first, int second)
{
    if (compare_points(c->at[first], c->at[second]) > 0) {
        float keep[3];
        memcpy(keep, c->at[first], sizeof keep);
        memcpy(c->at[first], c->at[second], sizeof keep);
        memcpy(c->at[second], keep, sizeof keep);
        c->turned = !c->turned;
    }
}

static corners ordered_corners(const alp_scene *scene, uint32_t triangle)
{
    corners c = {.turned = false};
    for (int k = 0; k < 9; k++) {
        c.at[k / 3][k % 3] = scene->positions[scene->triangles[triangle][k / 3]][k % 3] + 0.0f;
    }
    order_two(&c, 0, 1); // + 0: −0 becomes 0
    order_two(&c, 1, 2);
    order_two(&c, 0, 1);
    return c;
}

/// A triangle by its corners; part of their hash tells most others apart without a look at them.
typedef struct entry {
    uint32_t triangle, hash; // ALPI_NONE = free
} entry;

/// What lies in the place of others, surface by surface.
typedef struct twins {
    entry *table; // [mask + 1]
    size_t mask;
    uint32_t *same, *opposite; // [surface_count] triangles
    uint32_t *with;            // [surface_count] surface of the first twin
    uint32_t *first[2];        // [surface_count] triangle: the first of the same, of the opposite
} twins;

/// Finds the triangle that was there first, or puts this one in.
static uint32_t first_at(const alp_scene *scene, twins *w, uint32_t triangle, const corners *c,
                         bool *turned)
{
    size_t slot = (size_t)alpi_hash_bytes(ALPI_HASH_START, c->at, sizeof c->at);
    const uint32_t hash = (uint32_t)(slot >> 32);
    for (slot ^= slot >> 32;; slot++) {
        entry *there = &w->table[slot & w->mask];
        if (there->triangle == ALPI_NONE) {
            *there = (entry){triangle, hash};
            return ALPI_NONE;
        }
        if (there->hash != hash) {
            continue;
        }
        const corners other = ordered_corners(scene, there->triangle);
        if (are_same(&other, c)) {
            *turned = other.turned != c->turned;
            return there->triangle;
        }
    }
}

static alp_result find_twins(const alp_scene *scene, twins *w)
{
    size_t size = 16;
    while (size < 2 * (size_t)scene->usable_count) {
        size *= 2;
    }
    w->mask = size - 1;
    ALPI_TRY_NEW(scene->context, w->table, size);
    ALPI_TRY_NEW(scene->context, w->same, scene->surface_count);
    ALPI_TRY_NEW(scene->context, w->opposite, scene->surface_count);
    ALPI_TRY_NEW(scene->context, w->with, scene->surface_count);
    ALPI_TRY_NEW(scene->context, w->first[0], scene->surface_count);
    ALPI_TRY_NEW(scene->context, w->first[1], scene->surface_count);
    memset(w->table, 0xFF, size * sizeof *w->table);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        ALP_TRY(t % 65536 == 0 ? alpi_tick(scene->context, "diagnose", t, scene->triangle_count)
                               : ALP_OK);
        if (!scene->triangle_usable[t]) {
            continue;
        }
        bool turned = false;
        const corners c = ordered_corners(scene, t);
        const uint32_t there = first_at(scene, w, t, &c, &turned);
        const uint32_t s = scene->triangle_surface[t];
        if (there != ALPI_NONE) {
            if (w->same[s] + w->opposite[s] == 0) {
                w->with[s] = scene->triangle_surface[there];
            }
            uint32_t *count = turned ? &w->opposite[s] : &w->same[s];
            w->first[turned][s] = *count == 0 ? t : w->first[turned][s];
            *count += 1;
        }
    }
    return ALP_OK;
}

static alp_result tell_twins(alp_diagnosis *d, const twins *w)
{
    const alp_scene *scene = d->scene;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        const alpi_surface_label other = alpi_doctor_label(scene, w->with[s]);
        const char *with = w->with[s] == s ? "itself" : other.text;
        alpi_finding_facts facts = {
            .place = ALP_PLACE_SURFACE, .index = s, .value = surface->triangle_count};
        if (w->same[s] > 0) {
            facts.kind = ALP_FINDING_DUPLICATES;
            facts.count = w->same[s];
            facts.value = (double)w->same[s] / surface->triangle_count;
            ALP_TRY(alpi_diagnosis_add(d, facts, "%u of %u triangle%s %s exactly on others, of %s",
                                       w->same[s], surface->triangle_count,
                                       alpi_plural(surface->triangle_count),
                                       alpi_one_or_many(w->same[s], "lies", "lie"), with));
            alpi_diagnosis_mark_triangle(d, w->first[0][s]);
        }
        if (w->opposite[s] > 0) {
            facts.kind = ALP_FINDING_BACK_TO_BACK;
            facts.count = w->opposite[s];
            facts.value = (double)w->opposite[s] / surface->triangle_count;
            ALP_TRY(alpi_diagnosis_add(
                d, facts, "%u of %u triangle%s %s back to back with others, of %s", w->opposite[s],
                surface->triangle_count, alpi_plural(surface->triangle_count),
                alpi_one_or_many(w->opposite[s], "lies", "lie"), with));
            alpi_diagnosis_mark_triangle(d, w->first[1][s]);
        }
    }
    return ALP_OK;
}

static alp_result look_for_twins(alp_diagnosis *d)
{
    twins w = {0};
    alp_result result = find_twins(d->scene, &w);
    if (result == ALP_OK) {
        result = tell_twins(d, &w);
    }
    alpi_release(d->context, w.table);
    alpi_release(d->context, w.same);
    alpi_release(d->context, w.opposite);
    alpi_release(d->context, w.with);
    alpi_release(d->context, w.first[0]);
    alpi_release(d->context, w.first[1]);
    return result;
}

// --- normals -------------------------------------------------------------------------------------

/// Share of a surface's area on which all three normals look to the back of the triangle.
/// @param largest out: of those triangles, where there are any
static double reversed_share(const alp_scene *scene, const alpi_surface *surface, uint32_t *count,
                             uint32_t *largest)
{
    double area = 0.0, reversed = 0.0, most = 0.0;
    *count = 0;
    for (uint32_t i = 0; i < surface->triangle_count; i++) {
        const uint32_t t = surface->first_triangle + i;
        if (!scene->triangle_usable[t]) {
            continue;
        }
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        const vec3 face = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
        bool back = !alpi_sides_is_turned(scene, t); // else they point to the side of the map
        for (int k = 0; k < 3; k++) {
            back = back && vec3_dot(face, vec3_load(scene->normals[scene->triangles[t][k]])) < 0.0f;
        }
        const double own = vec3_triangle_area(c[0], c[1], c[2]);
        area += own;
        reversed += back ? own : 0.0;
        *largest = back && own > most ? t : *largest;
        most = back ? fmax(most, own) : most;
        *count += back;
    }
    return area > 0.0 ? reversed / area : 0.0;
}

static alp_result look_for_reversed(alp_diagnosis *d)
{
    for (uint32_t s = 0; s < d->scene->surface_count; s++) {
        const alpi_surface *surface = &d->scene->surfaces[s];
        uint32_t count, largest = ALPI_NONE;
        const double share = reversed_share(d->scene, surface, &count, &largest);
        if (share > REVERSED_SHARE) {
            const alpi_finding_facts facts = {ALP_FINDING_REVERSED_NORMALS, ALP_PLACE_SURFACE, s,
                                              count, share};
            ALP_TRY(alpi_diagnosis_add(d, facts,
                                       "the normals of %u of %u triangle%s, %.3g %% of the area, "
                                       "point to %s",
                                       count, surface->triangle_count,
                                       alpi_plural(surface->triangle_count), 100.0 * share,
                                       alpi_one_or_many(count, "its back", "their backs")));
            alpi_diagnosis_mark_triangle(d, largest);
        }
    }
    return ALP_OK;
}

/// Triangles of a surface of which the map holds the back, and their share of its area.
/// @param largest out: of those triangles, where there are any
static double turned_share(const alp_scene *scene, const alpi_surface *surface, uint32_t *count,
                           uint32_t *largest)
{
    double area = 0.0, turned = 0.0, most = 0.0;
    *count = 0;
    for (uint32_t i = 0; i < surface->triangle_count; i++) {
        const uint32_t t = surface->first_triangle + i;
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        const double own = scene->triangle_usable[t] ? vec3_triangle_area(c[0], c[1], c[2]) : 0.0;
        area += own;
        if (alpi_sides_is_turned(scene, t)) {
            turned += own;
            *largest = own > most ? t : *largest;
            most = fmax(most, own);
            ++*count;
        }
    }
    return area > 0.0 ? turned / area : 0.0;
}

static alp_result look_for_inside_out(alp_diagnosis *d)
{
    for (uint32_t s = 0; s < d->scene->surface_count && d->scene->sides != NULL; s++) {
        const alpi_surface *surface = &d->scene->surfaces[s];
        uint32_t count, largest = ALPI_NONE;
        const double share = turned_share(d->scene, surface, &count, &largest);
        if (count > 0) {
            const alpi_finding_facts facts = {ALP_FINDING_INSIDE_OUT, ALP_PLACE_SURFACE, s, count,
                                              share};
            ALP_TRY(alpi_diagnosis_add(d, facts,
                                       "%u of %u triangles, %.3g %% of the area, %s to "
                                       "double-sided solids that are wound inwards",
                                       count, surface->triangle_count, 100.0 * share,
                                       alpi_one_or_many(count, "belongs", "belong")));
            alpi_diagnosis_mark_triangle(d, largest);
        }
    }
    return ALP_OK;
}

typedef bool surface_test(const alpi_surface *surface);

static bool lacks_normals(const alpi_surface *surface)
{
    return surface->normals_generated && surface->triangle_count > 0;
}

static bool is_mirrored(const alpi_surface *surface)
{
    return surface->mirrored && surface->triangle_count > 0;
}

/// One finding for all surfaces with a property, at the first of them.
static alp_result count_surfaces(alp_diagnosis *d, alp_finding_kind kind, surface_test *has,
                                 const char *what)
{
    const alp_scene *scene = d->scene;
    alpi_finding_facts facts = {.kind = kind, .place = ALP_PLACE_SURFACE, .value = NO_VALUE};
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        if (has(&scene->surfaces[s])) {
            facts.index = facts.count++ == 0 ? s : facts.index;
        }
    }
    if (facts.count == 0) {
        return ALP_OK;
    }
    if (facts.count == 1) {
        return alpi_diagnosis_add(d, facts, "%s", what);
    }
    return alpi_diagnosis_add(d, facts, "%s (%llu of %u surfaces)", what,
                              (unsigned long long)facts.count, scene->surface_count);
}

// --- size ----------------------------------------------------------------------------------------

/// The same sizes as the line `unit` of info.
static alp_result look_at_size(alp_diagnosis *d)
{
    const double side = alpi_doctor_longest_side(d->scene);
    const alpi_finding_facts facts = {.kind = ALP_FINDING_SIZE, .value = side};
    if (!(side > LARGEST_SIDE) && !(side > 0.0 && side < SMALLEST_SIDE)) {
        return ALP_OK;
    }
    alp_unit_guess guesses[ALP_UNIT_LIMIT];
    const uint32_t count = alp_scene_guess_unit(d->scene, guesses);
    char sizes[TEXT_SIZE] = "";
    size_t used = 0;
    for (uint32_t i = 0; i < count && used < sizeof sizes; i++) {
        const int more = snprintf(sizes + used, sizeof sizes - used, "%s%.3g m (a unit of %s)",
                                  i == 0          ? "; it may be meant for "
                                  : i + 1 < count ? ", "
                                                  : " or ",
                                  guesses[i].longest_side, guesses[i].name);
        used += more > 0 ? (size_t)more : 0;
    }
    return alpi_diagnosis_add(d, facts, "the longest side is %.4g m%s", side, sizes);
}

alp_result alpi_doctor_look_at_mesh(alp_diagnosis *diagnosis)
{
    ALP_TRY(look_for_triangles(diagnosis));
    ALP_TRY(look_for_flat(diagnosis));
    ALP_TRY(look_for_twins(diagnosis));
    ALP_TRY(look_for_reversed(diagnosis));
    ALP_TRY(look_for_inside_out(diagnosis));
    ALP_TRY(count_surfaces(diagnosis, ALP_FINDING_NO_NORMALS, lacks_normals,
                           "no normals: flat ones were made"));
    ALP_TRY(count_surfaces(diagnosis, ALP_FINDING_MIRRORED, is_mirrored,
                           "placed by a matrix that mirrors"));
    return look_at_size(diagnosis);
}
