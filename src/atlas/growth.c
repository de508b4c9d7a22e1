// SPDX-License-Identifier: MIT
// Members of a cluster that grows, and the check for folds.
#include "atlas/growth.h"

#include "base/memory.h"

enum { FIRST_CHECK = 256 };

alp_result alpi_growth_begin(alpi_growth *g)
{
    const alp_scene *scene = g->scene;
    alp_context *context = scene->context;
    g->fold.context = context;
    ALPI_TRY_NEW(context, g->clusters->of_triangle, scene->triangle_count);
    ALPI_TRY_NEW(context, g->visited, scene->triangle_count);
    ALPI_TRY_NEW(context, g->members, scene->usable_count);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        g->clusters->of_triangle[t] = ALPI_NONE;
    }
    return ALP_OK;
}

void alpi_growth_end(alpi_growth *g)
{
    alp_context *context = g->scene->context;
    alpi_release(context, g->visited);
    alpi_release(context, g->members);
    alpi_release(context, g->flats);
    alpi_release(context, g->accepted);
    alpi_fold_destroy(&g->fold);
}

uint32_t alpi_growth_limit(uint32_t kept)
{
    return kept < FIRST_CHECK / 2 ? FIRST_CHECK : 2 * kept;
}

static bool touches_cluster(const alpi_growth *g, uint32_t triangle)
{
    for (int k = 0; k < 3; k++) {
        const uint32_t across = g->neighbours[triangle][k];
        if (across != ALPI_NONE && g->clusters->of_triangle[across] == g->clusters->count) {
            return true;
        }
    }
    return false;
}

static alp_result flatten_members(alpi_growth *g, uint32_t count, const alpi_plane *plane)
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

alp_result alpi_growth_check(alpi_growth *g, const alpi_plane *plane, uint32_t kept,
                             uint32_t *count, bool *folded)
{
    ALP_TRY(flatten_members(g, *count, plane));
    ALP_TRY(alpi_fold_build(&g->fold, g->flats, *count));
    for (uint32_t i = 0; i < *count; i++) {
        g->accepted[i] = i < kept;
    }
    uint32_t taken = kept;
    for (uint32_t i = kept; i < *count; i++) {
        const uint32_t t = g->members[i];
        if (i > 0 && !touches_cluster(g, t)) {
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

alp_result alpi_growth_close(alpi_growth *g, vec3 normal)
{
    alpi_clusters *clusters = g->clusters;
    ALP_TRY(alpi_grow(g->scene->context, (void **)&clusters->planes, &g->plane_capacity,
                      (size_t)clusters->count + 1, sizeof *clusters->planes));
    vec3_store(clusters->planes[clusters->count++], normal);
    return ALP_OK;
}
