// SPDX-License-Identifier: MIT
// Meshes that several nodes place.
#include "scene/select.h"

#include "base/memory.h"

#include <stdlib.h>

/// A chosen surface, for sorting: surfaces of a mesh, of those the ones of a node, by primitive.
typedef struct placed {
    uint32_t mesh, node, instance, primitive, surface, triangle_count;
} placed;

static int compare_placed(const void *left, const void *right)
{
    const placed *a = left, *b = right;
    const uint32_t keys[5][2] = {{a->mesh, b->mesh},
                                 {a->node, b->node},
                                 {a->instance, b->instance},
                                 {a->primitive, b->primitive},
                                 {a->surface, b->surface}};
    for (int k = 0; k < 5; k++) {
        if (keys[k][0] != keys[k][1]) {
            return keys[k][0] < keys[k][1] ? -1 : 1;
        }
    }
    return 0;
}

/// End of the run of one node, or of one of its instances, that begins at `first`.
static uint32_t node_end(const placed *list, uint32_t count, uint32_t first)
{
    uint32_t end = first + 1;
    while (end < count && list[end].mesh == list[first].mesh &&
           list[end].node == list[first].node && list[end].instance == list[first].instance) {
        end++;
    }
    return end;
}

static uint32_t count_usable(const alp_scene *scene, const placed *list, uint32_t first,
                             uint32_t end)
{
    uint32_t count = 0;
    for (uint32_t i = first; i < end; i++) {
        const alpi_surface *surface = &scene->surfaces[list[i].surface];
        for (uint32_t t = 0; t < surface->triangle_count; t++) {
            count += scene->triangle_usable[surface->first_triangle + t];
        }
    }
    return count;
}

/// Makes the run of a node instances of the run at `original`, if both hold the same primitives.
static void follow(const placed *list, uint32_t first, uint32_t end, uint32_t original,
                   uint32_t original_end, uint32_t *originals)
{
    bool same = end - first == original_end - original;
    for (uint32_t i = 0; same && i < end - first; i++) {
        same = list[first + i].primitive == list[original + i].primitive &&
               list[first + i].triangle_count == list[original + i].triangle_count;
    }
    for (uint32_t i = 0; same && i < end - first; i++) {
        originals[list[first + i].surface] = list[original + i].surface;
    }
}

/// The surfaces of one mesh, list[first] … list[end − 1].
static void join_instances(const alp_scene *scene, const placed *list, uint32_t first, uint32_t end,
                           uint32_t *originals)
{
    if (node_end(list, end, first) == end) {
        return;
    }
    uint32_t best = first, most = 0;
    for (uint32_t at = first; at < end; at = node_end(list, end, at)) {
        const uint32_t usable = count_usable(scene, list, at, node_end(list, end, at));
        if (usable > most || (usable == most && list[at].surface < list[best].surface)) {
            best = at;
            most = usable;
        }
    }
    for (uint32_t at = first; at < end; at = node_end(list, end, at)) {
        follow(list, at, node_end(list, end, at), best, node_end(list, end, best), originals);
    }
}

alp_result alpi_scene_instances(const alp_scene *scene, const bool *surfaces, uint32_t **originals)
{
    *originals = ALPI_NEW(scene->context, uint32_t, scene->surface_count);
    placed *list = ALPI_NEW(scene->context, placed, scene->surface_count);
    if (*originals == NULL || list == NULL) {
        alpi_release(scene->context, *originals);
        alpi_release(scene->context, list);
        *originals = NULL;
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    uint32_t count = 0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        (*originals)[s] = s;
        if (surfaces == NULL || surfaces[s]) {
            list[count++] = (placed){
                surface->mesh,          surface->node, surface->instance, surface->primitive, s,
                surface->triangle_count};
        }
    }
    qsort(list, count, sizeof *list, compare_placed);
    for (uint32_t first = 0, end; first < count; first = end) {
        for (end = first; end < count && list[end].mesh == list[first].mesh;) {
            end++;
        }
        join_instances(scene, list, first, end, *originals);
    }
    alpi_release(scene->context, list);
    return ALP_OK;
}
