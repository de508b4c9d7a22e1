// SPDX-License-Identifier: MIT
// Triangles that can share a chart: the parts of a region, grown breadth-first from its largest
// triangle as long as the projection on its plane does not fold over itself.
// Based on: I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU, 2007,
// chapter 7.3. There the planes are those of the axes and a folded cluster is not noticed.
#include "atlas/growth.h"
#include "atlas/regions.h"

#include "base/memory.h"

#include <stdlib.h>

typedef struct seed {
    double area;
    uint32_t triangle;
} seed;

typedef struct grower {
    alpi_growth growth;
    alpi_regions regions;
    seed *seeds; // [usable_count], largest first
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
    const alp_scene *scene = g->growth.scene;
    ALP_TRY(alpi_growth_begin(&g->growth));
    ALPI_TRY_NEW(scene->context, g->seeds, scene->usable_count);
    uint32_t count = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
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
    alp_context *context = g->growth.scene->context;
    alpi_regions_destroy(context, &g->regions);
    alpi_release(context, g->seeds);
    alpi_growth_end(&g->growth);
}

static bool may_join(const grower *g, uint32_t triangle, uint32_t seed_triangle)
{
    return triangle != ALPI_NONE && g->growth.clusters->of_triangle[triangle] == ALPI_NONE &&
           g->growth.visited[triangle] != g->growth.clusters->count + 1 &&
           g->regions.of_triangle[triangle] == g->regions.of_triangle[seed_triangle];
}

/// Appends what can be reached from the members, up to `limit` of them.
static uint32_t reach(grower *g, uint32_t count, uint32_t *scanned, uint32_t limit)
{
    while (*scanned < count && count < limit) {
        const uint32_t *across = g->growth.neighbours[g->growth.members[(*scanned)++]];
        for (int k = 0; k < 3; k++) {
            if (may_join(g, across[k], g->growth.members[0])) {
                g->growth.visited[across[k]] = g->growth.clusters->count + 1;
                g->growth.members[count++] = across[k];
            }
        }
    }
    return count;
}

static alp_result grow_cluster(grower *g, uint32_t seed_triangle)
{
    vec3 corner[3];
    alpi_triangle_corners(g->growth.scene, seed_triangle, corner);
    const float *normal = g->regions.planes[g->regions.of_triangle[seed_triangle]];
    alpi_plane plane = alpi_plane_make(vec3_load(normal), corner[0]);
    g->growth.members[0] = seed_triangle;
    g->growth.visited[seed_triangle] = g->growth.clusters->count + 1;
    uint32_t count = 1, kept = 0, scanned = 0;
    for (;;) {
        count = reach(g, count, &scanned, alpi_growth_limit(kept));
        if (count == kept) {
            break;
        }
        bool folded = false;
        ALP_TRY(alpi_growth_check(&g->growth, &plane, kept, &count, &folded));
        kept = count;
        scanned = folded ? 0 : scanned;
    }
    return alpi_growth_close(&g->growth, vec3_load(normal));
}

static alp_result grow_all(grower *g, float max_angle, alpi_atlas_clock *clock)
{
    ALP_TRY(alpi_regions_create(g->growth.scene, g->growth.neighbours, max_angle, &g->regions));
    ALP_TRY(alpi_regions_straighten(g->growth.scene, g->growth.neighbours, max_angle, &g->regions));
    ALP_TRY(grower_create(g));
    uint32_t usable = g->growth.scene->usable_count;
    for (uint32_t i = 0; i < usable; i++) {
        if (i % 1024 == 0 && clock != NULL) {
            ALP_TRY(alpi_atlas_tick(clock, "clusters", i, usable));
        }
        if (g->growth.clusters->of_triangle[g->seeds[i].triangle] == ALPI_NONE) {
            ALP_TRY(grow_cluster(g, g->seeds[i].triangle));
        }
    }
    return ALP_OK;
}

alp_result alpi_clusters_create(const alp_scene *scene, const uint32_t (*neighbours)[3],
                                float max_angle, alpi_atlas_clock *clock, alpi_clusters *clusters)
{
    *clusters = (alpi_clusters){0};
    grower g = {.growth = {.scene = scene, .neighbours = neighbours, .clusters = clusters}};
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
