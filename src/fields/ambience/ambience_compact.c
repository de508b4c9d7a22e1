// SPDX-License-Identifier: MIT
// Memory of anchors that are gone is given back.
#include "base/memory.h"
#include "fields/ambience/ambience.h"

#include <string.h>

/// Share of the slots in use below which all are moved together.
static const double SPARSE = 0.75;
enum { FEW = 64 /* anchors that are not worth it */ };

static bool is_sparse(uint32_t count, uint32_t end)
{
    return end > FEW && (double)count < SPARSE * (double)end;
}

/// Moves anchors from the end of the pool to free places. Requests hold the numbers of pending
/// ones.
static alp_result compact_anchors(alp_ambience *a)
{
    uint32_t hole = 0;
    while (a->anchor_end > 0) {
        const uint32_t last = a->anchor_end - 1;
        alpi_anchor *from = &a->anchors[last];
        if (from->state == ALPI_ANCHOR_FREE) {
            a->anchor_end--;
            continue;
        }
        while (hole < last && a->anchors[hole].state != ALPI_ANCHOR_FREE) {
            hole++;
        }
        if (hole == last || from->pending) {
            break;
        }
        a->anchors[hole] = *from;
        a->anchors[hole].version = ++a->version_serial;
        alpi_graph_set_anchor(&a->graph, alpi_graph_find(&a->graph, from->level, from->index),
                              hole);
        from->state = ALPI_ANCHOR_FREE;
        a->anchor_end--;
    }
    a->free_anchor = ALPI_NO_ANCHOR;
    for (uint32_t i = a->anchor_end; i-- > 0;) {
        if (a->anchors[i].state == ALPI_ANCHOR_FREE) {
            a->anchors[i].next_free = a->free_anchor;
            a->free_anchor = i;
        }
    }
    return alpi_fit(a->context, (void **)&a->anchors, &a->anchor_capacity, a->anchor_end,
                    sizeof *a->anchors);
}

static alp_result compact_lights(alp_ambience *a, alpi_light_pool *pool, bool next)
{
    uint32_t count = 0, **slots = ALPI_NEW(a->context, uint32_t *, pool->count);
    if (slots == NULL) {
        return ALP_OK; // all stays
    }
    for (uint32_t i = 0; i < a->anchor_end; i++) {
        alpi_anchor *at = &a->anchors[i];
        uint32_t *slot = next ? &at->next : &at->slot;
        if (at->state != ALPI_ANCHOR_FREE && *slot != ALPI_NO_SLOT) {
            slots[count++] = slot;
            at->version = ++a->version_serial;
        }
    }
    const alp_result result = alpi_lights_compact(pool, slots, count);
    alpi_release(a->context, slots);
    return result;
}

alp_result alpi_ambience_compact(alp_ambience *a)
{
    if (is_sparse(a->anchor_count, a->anchor_end)) {
        ALP_TRY(compact_anchors(a));
    }
    if (is_sparse(a->graph.node_count, a->graph.node_end)) {
        ALP_TRY(alpi_graph_compact(&a->graph));
    }
    if (is_sparse(a->lights.count, a->lights.end)) {
        ALP_TRY(compact_lights(a, &a->lights, false));
    }
    return is_sparse(a->nexts.count, a->nexts.end) ? compact_lights(a, &a->nexts, true) : ALP_OK;
}
