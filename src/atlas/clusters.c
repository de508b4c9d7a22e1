// SPDX-License-Identifier: MIT
// Triangles that can share a chart: the parts of a region, grown breadth-first from its largest
// triangle as long as the projection on its plane does not fold over itself.
// Based on: I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU, 2007,
// chapter 7.3. There the planes are those of the axes and a folded cluster is not noticed.
#include "atlas/fold.h"
#include "atlas/regions.h"
#include "atlas/stages.h"

#include "base/memory.h"

#include <stdlib.h>

// A cluster is checked for folds each time it has doubled, so that a long spiral costs no more than
// what is kept of it; and first when it has this many triangles.
enum { FIRST_CHECK = 256 };

typedef struct seed {
    double area;
    uint32_t triangle;
} seed;

typedef struct grower {
    const alp_scene *scene;
    const uint32_t (*neighbours)[3];
    alpi_regions regions;
    alpi_clusters *clusters;
    size_t plane_capacity;
    seed *seeds;       // [usable_count], largest first
    uint32_t *visited; // [triangle_count] cluster + 1 that last reached the triangle
    uint32_t *members; // [usable_count] of the cluster that grows, breadth-first
    // By member, for the fold check:
    alpi_flat *flats;
    size_t flat_capacity;
    bool *accepted;
    size_t accepted_capacity;
    alpi_fold fold;
} grower;

static int compare_seeds(const void *a, const void *b)
{
    const seed *s = a, *t = b;
    if (s->area != t->area) {
        return s->area > t->area ? -1 : 1;
    }
    return s->triangle < t->triangle ? -1 : 1;
}

static alp_result grower_create(grower *g)
{
    const alp_scene *scene = g->scene;
    alp_context *context = scene->context;
    ALPI_TRY_NEW(context, g->clusters->of_triangle, scene->triangle_count);
    ALPI_TRY_NEW(context, g->seeds, scene->usable_count);
    ALPI_TRY_NEW(context, g->visited, scene->triangle_count);
    ALPI_TRY_NEW(context, g->members, scene->usable_count);
    uint32_t count = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        g->clusters->of_triangle[t] = ALPI_NONE;
        if (scene->triangle_usable[t]) {
            vec3 c[3];
            alpi_triangle_corners(scene, t, c);
            g->seeds[count++] = (seed){vec3_triangle_area(c[0], c[1], c[2]), t};
        }
    }
    qsort(g->seeds, count, sizeof *g->seeds, compare_seeds);
    return ALP_OK;
}

static void grower_destroy(grower *g)
{
    alp_context *context = g->scene->context;
    alpi_regions_destroy(context, &g->regions);
    alpi_release(context, g->seeds);
    alpi_release(context, g->visited);
    alpi_release(context, g->members);
    alpi_release(context, g->flats);
    alpi_release(context, g->accepted);
    alpi_fold_destroy(&g->fold);
}

static bool may_join(const grower *g, uint32_t triangle, uint32_t seed_triangle)
{
    return triangle != ALPI_NONE && g->clusters->of_triangle[triangle] == ALPI_NONE &&
           g->visited[triangle] != g->clusters->count + 1 &&
           g->regions.of_triangle[triangle] == g->regions.of_triangle[seed_triangle];
}

/// Appends what can be reached from the members, up to `limit` of them.
static uint32_t reach(grower *g, uint32_t count, uint32_t *scanned, uint32_t limit)
{
    while (*scanned < count && count < limit) {
        const uint32_t *across = g->neighbours[g->members[(*scanned)++]];
        for (int k = 0; k < 3; k++) {
            if (may_join(g, across[k], g->members[0])) {
                g->visited[across[k]] = g->clusters->count + 1;
                g->members[count++] = across[k];
            }
        }
    }
    return count;
}

static bool touches_accepted(const grower *g, uint32_t triangle)
{
    for (int k = 0; k < 3; k++) {
        uint32_t across = g->neighbours[triangle][k];
        if (across != ALPI_NONE && g->clusters->of_triangle[across] == g->clusters->count) {
            return true;
        }
    }
    return false;
}

static alp_result flatten_members(grower *g, uint32_t count, const alpi_plane *plane)
{
    alp_context *context = g->scene->context;
    ALP_TRY(alpi_grow(context, (void **)&g->flats, &g->flat_capacity, count, sizeof *g->flats));
    ALP_TRY(alpi_grow(context, (void **)&g->accepted, &g->accepted_capacity, count,
                      sizeof *g->accepted));
    for (uint32_t i = 0; i < count; i++) {
        vec3 c[3];
        alpi_triangle_corners(g->scene, g->members[i], c);
        for (int k = 0; k < 3; k++) {
            alpi_plane_project(plane, c[k], &g->flats[i].x[k], &g->flats[i].y[k]);
        }
    }
    return ALP_OK;
}

/// Takes the members after the first `kept` into the cluster, in order, except those that overlap
/// one taken before, or that were reached only through one of those. Returns how many members are
/// left in *count; *folded says that not all were taken.
static alp_result check_folds(grower *g, const alpi_plane *plane, uint32_t kept, uint32_t *count,
                              bool *folded)
{
    ALP_TRY(flatten_members(g, *count, plane));
    ALP_TRY(alpi_fold_build(&g->fold, g->flats, *count));
    for (uint32_t i = 0; i < *count; i++) {
        g->accepted[i] = i < kept;
    }
    uint32_t taken = kept;
    for (uint32_t i = kept; i < *count; i++) {
        uint32_t t = g->members[i];
        if (i > 0 && !touches_accepted(g, t)) {
            g->visited[t] = 0; // it may be reached another way later
        } else if (!alpi_fold_overlaps(&g->fold, i, g->accepted)) {
            g->accepted[i] = true;
            g->clusters->of_triangle[t] = g->clusters->count;
            g->members[taken++] = t;
        }
    }
    *folded = taken < *count;
    *count = taken;
    return ALP_OK;
}

static alp_result grow_cluster(grower *g, uint32_t seed_triangle)
{
    vec3 corner[3];
    alpi_triangle_corners(g->scene, seed_triangle, corner);
    const float *normal = g->regions.planes[g->regions.of_triangle[seed_triangle]];
    alpi_plane plane = alpi_plane_make(vec3_load(normal), corner[0]);
    g->members[0] = seed_triangle;
    g->visited[seed_triangle] = g->clusters->count + 1;
    uint32_t count = 1, kept = 0, scanned = 0;
    for (;;) {
        uint32_t limit = kept < FIRST_CHECK / 2 ? FIRST_CHECK : 2 * kept;
        count = reach(g, count, &scanned, limit);
        if (count == kept) {
            break;
        }
        bool folded = false;
        ALP_TRY(check_folds(g, &plane, kept, &count, &folded));
        kept = count;
        scanned = folded ? 0 : scanned;
    }
    ALP_TRY(alpi_grow(g->scene->context, (void **)&g->clusters->planes, &g->plane_capacity,
                      (size_t)g->clusters->count + 1, sizeof *g->clusters->planes));
    vec3_store(g->clusters->planes[g->clusters->count++], vec3_load(normal));
    return ALP_OK;
}

static alp_result grow_all(grower *g, float max_angle, alpi_atlas_clock *clock)
{
    ALP_TRY(alpi_regions_create(g->scene, g->neighbours, max_angle, &g->regions));
    ALP_TRY(grower_create(g));
    uint32_t usable = g->scene->usable_count;
    for (uint32_t i = 0; i < usable; i++) {
        if (i % 1024 == 0 && clock != NULL) {
            ALP_TRY(alpi_atlas_tick(clock, "clusters", i, usable));
        }
        if (g->clusters->of_triangle[g->seeds[i].triangle] == ALPI_NONE) {
            ALP_TRY(grow_cluster(g, g->seeds[i].triangle));
        }
    }
    return ALP_OK;
}

alp_result alpi_clusters_create(const alp_scene *scene, const uint32_t (*neighbours)[3],
                                float max_angle, alpi_atlas_clock *clock, alpi_clusters *clusters)
{
    *clusters = (alpi_clusters){0};
    grower g = {.scene = scene,
                .neighbours = neighbours,
                .clusters = clusters,
                .fold.context = scene->context};
    alp_result result = grow_all(&g, max_angle, clock);
    grower_destroy(&g);
    if (result != ALP_OK) {
        alpi_clusters_destroy(scene->context, clusters);
    }
    return result;
}

void alpi_clusters_destroy(alp_context *context, alpi_clusters *clusters)
{
    alpi_release(context, clusters->of_triangle);
    alpi_release(context, clusters->planes);
    *clusters = (alpi_clusters){0};
}
