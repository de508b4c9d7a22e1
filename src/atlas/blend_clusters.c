// SPDX-License-Identifier: MIT
// Clusters of overlapping charts, grown over faces of one axis and side. A fold cuts where faces
// are steep: those that lie flatter are taken first.
// Based on: I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU, 2007,
// chapter 7.3.
#include "atlas/blend.h"

#include "atlas/growth.h"
#include "base/memory.h"

#include <stdlib.h>

enum { BANDS = 16 }; // of steepness

typedef struct seed {
    int band;
    double area;
    uint32_t face;
} seed;

/// Faces to look at next, a queue for each band of steepness.
typedef struct queues {
    uint32_t *next; // [faces] behind each in its queue
    uint32_t first[BANDS], last[BANDS];
} queues;

typedef struct grower {
    alpi_growth growth; // over faces
    const alpi_blend_face *faces;
    bool world;
    seed *seeds; // [usable_count] flattest band first, the largest of it first
    queues queues;
} grower;

/// 0 is the flattest.
static int band_of(const grower *g, uint32_t face)
{
    const float cosine = g->faces[face].cosine;
    const int band = (int)((1.0f - cosine * cosine) * (float)BANDS);
    return band < 0 ? 0 : band >= BANDS ? BANDS - 1 : band;
}

static int compare_seeds(const void *a, const void *b)
{
    const seed *s = a, *t = b;
    if (s->band != t->band) {
        return s->band < t->band ? -1 : 1;
    }
    if (s->area != t->area) {
        return s->area > t->area ? -1 : 1;
    }
    return s->face < t->face ? -1 : s->face > t->face;
}

static alp_result grower_create(grower *g)
{
    const alp_scene *view = g->growth.scene;
    alp_context *context = view->context;
    ALP_TRY(alpi_growth_begin(&g->growth));
    ALPI_TRY_NEW(context, g->seeds, view->usable_count);
    ALPI_TRY_NEW(context, g->queues.next, view->triangle_count);
    uint32_t count = 0;
    for (uint32_t f = 0; f < view->triangle_count; f++) {
        if (view->triangle_usable[f]) {
            vec3 c[3];
            alpi_triangle_corners(view, f, c);
            g->seeds[count++] = (seed){band_of(g, f), vec3_triangle_area(c[0], c[1], c[2]), f};
        }
    }
    qsort(g->seeds, count, sizeof *g->seeds, compare_seeds);
    return ALP_OK;
}

static void grower_destroy(grower *g)
{
    alp_context *context = g->growth.scene->context;
    alpi_release(context, g->seeds);
    alpi_release(context, g->queues.next);
    alpi_growth_end(&g->growth);
}

// --- queues --------------------------------------------------------------------------------------

static void clear_queues(queues *q)
{
    for (int i = 0; i < BANDS; i++) {
        q->first[i] = q->last[i] = ALPI_NONE;
    }
}

static void push(grower *g, uint32_t face)
{
    queues *q = &g->queues;
    const int band = band_of(g, face);
    q->next[face] = ALPI_NONE;
    if (q->first[band] == ALPI_NONE) {
        q->first[band] = face;
    } else {
        q->next[q->last[band]] = face;
    }
    q->last[band] = face;
    g->growth.visited[face] = g->growth.clusters->count + 1;
}

/// The face that lies flattest, or ALPI_NONE.
static uint32_t pop(queues *q)
{
    for (int i = 0; i < BANDS; i++) {
        const uint32_t face = q->first[i];
        if (face != ALPI_NONE) {
            q->first[i] = q->next[face];
            return face;
        }
    }
    return ALPI_NONE;
}

static void push_neighbours(grower *g, uint32_t face)
{
    for (int k = 0; k < 3; k++) {
        const uint32_t across = g->growth.neighbours[face][k];
        if (across != ALPI_NONE && g->growth.clusters->of_triangle[across] == ALPI_NONE &&
            g->growth.visited[across] != g->growth.clusters->count + 1) {
            push(g, across);
        }
    }
}

// --- growing -------------------------------------------------------------------------------------

/// Appends what can be reached, up to `limit` members.
static uint32_t reach(grower *g, uint32_t count, uint32_t limit)
{
    for (uint32_t face; count < limit && (face = pop(&g->queues)) != ALPI_NONE;) {
        g->growth.members[count++] = face;
        push_neighbours(g, face);
    }
    return count;
}

/// After a fold: what waits may have been reached through what was not taken.
static void restart_queues(grower *g, uint32_t count)
{
    for (uint32_t face; (face = pop(&g->queues)) != ALPI_NONE;) {
        g->growth.visited[face] = 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        push_neighbours(g, g->growth.members[i]);
    }
}

static alpi_plane plane_of(const grower *g, uint32_t seed_face, vec3 *normal)
{
    const alpi_blend_face *face = &g->faces[seed_face];
    vec3 axes[ALPI_BLEND_SETS], corners[3];
    const uint32_t surface = g->growth.scene->triangle_surface[seed_face];
    alpi_surface_axes(&g->growth.scene->surfaces[surface], g->world, axes);
    alpi_triangle_corners(g->growth.scene, seed_face, corners);
    *normal = vec3_scale(axes[face->axis], face->negative ? -1.0f : 1.0f);
    return alpi_plane_make(*normal, corners[0]);
}

static alp_result grow_cluster(grower *g, uint32_t seed_face)
{
    vec3 normal;
    const alpi_plane plane = plane_of(g, seed_face, &normal);
    clear_queues(&g->queues);
    push(g, seed_face);
    uint32_t count = 0, kept = 0;
    for (;;) {
        count = reach(g, count, alpi_growth_limit(kept));
        if (count == kept) {
            break;
        }
        bool folded = false;
        ALP_TRY(alpi_growth_check(&g->growth, &plane, kept, &count, &folded));
        kept = count;
        if (folded) {
            restart_queues(g, count);
        }
    }
    return alpi_growth_close(&g->growth, normal);
}

static alp_result grow_all(grower *g, alpi_atlas_clock *clock)
{
    ALP_TRY(grower_create(g));
    const uint32_t usable = g->growth.scene->usable_count;
    for (uint32_t i = 0; i < usable; i++) {
        if (i % 1024 == 0 && clock != NULL) {
            ALP_TRY(alpi_atlas_tick(clock, "clusters", i, usable));
        }
        if (g->growth.clusters->of_triangle[g->seeds[i].face] == ALPI_NONE) {
            ALP_TRY(grow_cluster(g, g->seeds[i].face));
        }
    }
    return ALP_OK;
}

alp_result alpi_blend_clusters(const alp_scene *view, const alpi_blend_faces *faces, bool world,
                               alpi_atlas_clock *clock, alpi_clusters *clusters)
{
    *clusters = (alpi_clusters){0};
    grower g = {.growth = {.scene = view,
                           .neighbours = (const uint32_t(*)[3])faces->neighbours,
                           .clusters = clusters},
                .faces = faces->faces,
                .world = world};
    const alp_result result = grow_all(&g, clock);
    grower_destroy(&g);
    if (result != ALP_OK) {
        alpi_clusters_destroy(view->context, clusters);
    }
    return result;
}
