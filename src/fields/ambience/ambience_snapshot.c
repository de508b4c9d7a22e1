// SPDX-License-Identifier: MIT
#include "fields/ambience/ambience_snapshot.h"

#include "base/memory.h"
#include "fields/ambience/ambience.h"

#include <math.h>
#include <string.h>

// A reader adds itself to the current snapshot, and checks that it still is the current one. The
// writer fills only snapshots that are not current and have no readers. So a reader that came too
// late reads nothing before it leaves again.

/// A snapshot that may be written; NULL with ALP_OK in *result: readers hold all.
static alp_ambience_snapshot *find_writable(alp_ambience *ambience, alp_result *result)
{
    alpi_snapshots *s = &ambience->snapshots;
    const uint32_t current = atomic_load(&s->current);
    *result = ALP_OK;
    for (uint32_t i = 0; i < s->count; i++) {
        if (i != current && atomic_load(&s->all[i]->readers) == 0) {
            return s->all[i];
        }
    }
    if (s->count == ALPI_AMBIENCE_SNAPSHOTS) {
        return NULL;
    }
    alp_ambience_snapshot *made = ALPI_NEW(ambience->context, alp_ambience_snapshot, 1);
    *result = made != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    if (made != NULL) {
        atomic_init(&made->readers, 0);
        s->all[s->count++] = made;
    }
    return made;
}

static alp_result make_room(const alp_ambience *a, alp_ambience_snapshot *s)
{
    alp_context *context = a->context;
    ALP_TRY(alpi_fit(context, (void **)&s->nodes, &s->node_capacity, a->graph.node_end,
                     sizeof *s->nodes));
    ALP_TRY(alpi_fit(context, (void **)&s->anchors, &s->anchor_capacity, a->anchor_end,
                     sizeof *s->anchors));
    ALP_TRY(
        alpi_fit(context, (void **)&s->light, &s->light_capacity, a->lights.end, sizeof *s->light));
    return a->lights.visibility ? alpi_fit(context, (void **)&s->moments, &s->moment_capacity,
                                           a->lights.end, sizeof *s->moments)
                                : ALP_OK;
}

static float confidence_of(const alp_ambience *a, uint32_t node)
{
    const uint32_t anchor = a->graph.nodes[node].anchor;
    return anchor != ALPI_NO_ANCHOR ? a->anchors[anchor].confidence : 0.0f;
}

static void copy_nodes(const alp_ambience *a, alp_ambience_snapshot *s)
{
    const uint32_t middle = alpi_graph_middle(a->options.flat);
    for (uint32_t i = 0; i < a->graph.node_end; i++) {
        const alpi_graph_node *from = &a->graph.nodes[i];
        s->nodes[i] = (alpi_read_node){from->child, from->anchor, 1.0f};
    }
    for (uint32_t i = 0; i < a->graph.node_end; i++) {
        const uint32_t block = a->graph.nodes[i].child;
        if (block == ALPI_NO_NODE || a->graph.nodes[block].parent != i ||
            a->graph.nodes[i].level > a->graph.depth) {
            continue; // without children, free, or above all anchors
        }
        float most = 0.0f;
        for (uint32_t k = 0; k < alpi_graph_child_count(a->options.flat); k++) {
            most = k != middle ? fmaxf(most, confidence_of(a, block + k)) : most;
        }
        s->nodes[block + middle].share = most;
    }
}

/// The least mean distance: nearer points are seen whole.
static float find_clear(const float (*moments)[2])
{
    float least = moments[0][0];
    for (int i = 1; i < ALPI_AMBIENCE_MOMENTS; i++) {
        least = moments[i][0] < least ? moments[i][0] : least;
    }
    return least;
}

static void copy_anchors(const alp_ambience *a, alp_ambience_snapshot *s)
{
    for (uint32_t i = 0; i < a->anchor_end; i++) {
        const alpi_anchor *from = &a->anchors[i];
        alpi_read_anchor *to = &s->anchors[i];
        if (to->version == from->version) {
            continue;
        }
        to->slot = from->slot;
        to->confidence = from->confidence;
        to->open = from->open;
        to->height = from->height;
        to->version = from->version;
        if (from->slot == ALPI_NO_SLOT) {
            continue;
        }
        memcpy(s->light[from->slot], a->lights.light[from->slot], sizeof *s->light);
        if (a->lights.visibility) {
            memcpy(s->moments[from->slot], a->lights.moments[from->slot], sizeof *s->moments);
            to->clear = find_clear((const float(*)[2])s->moments[from->slot]);
        }
    }
}

alp_result alpi_snapshot_publish(alp_ambience *a)
{
    alp_result result;
    alp_ambience_snapshot *s = find_writable(a, &result);
    if (s == NULL) {
        return result != ALP_OK ? result : ALP_ERROR_LIMIT;
    }
    ALP_TRY(make_room(a, s));
    memcpy(s->centre, a->options.centre, sizeof s->centre);
    memcpy(s->base, a->base, sizeof s->base);
    s->dawn = a->dawn;
    s->read = &ALPI_COMPILED_FOR(a->context, alpi_ambience_lookup);
    s->unit = a->unit;
    s->inverse_unit = 1.0 / a->unit;
    for (uint32_t level = 0; level < ALPI_GRAPH_LEVELS; level++) {
        s->level_scale[level] = 1.0 / (double)alpi_graph_width(level);
    }
    s->flat = a->options.flat;
    s->lookup = a->options.lookup;
    s->root_level = a->graph.nodes[ALPI_GRAPH_ROOT].level;
    memcpy(s->root_index, a->graph.nodes[ALPI_GRAPH_ROOT].index, sizeof s->root_index);
    s->depth = a->graph.depth;
    copy_nodes(a, s);
    copy_anchors(a, s);
    for (uint32_t i = 0; i < a->snapshots.count; i++) {
        if (a->snapshots.all[i] == s) {
            atomic_store(&a->snapshots.current, i);
        }
    }
    return ALP_OK;
}

void alpi_snapshots_destroy(alp_ambience *a)
{
    for (uint32_t i = 0; i < a->snapshots.count; i++) {
        alp_ambience_snapshot *s = a->snapshots.all[i];
        alpi_release(a->context, s->nodes);
        alpi_release(a->context, s->anchors);
        alpi_release(a->context, s->light);
        alpi_release(a->context, s->moments);
        alpi_release(a->context, s);
    }
    a->snapshots.count = 0;
}

uint64_t alpi_snapshots_bytes(const alp_ambience *a, uint64_t *moments)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < a->snapshots.count; i++) {
        const alp_ambience_snapshot *s = a->snapshots.all[i];
        const uint64_t distances = s->moment_capacity * sizeof *s->moments;
        bytes += sizeof *s + s->node_capacity * sizeof *s->nodes +
                 s->anchor_capacity * sizeof *s->anchors + s->light_capacity * sizeof *s->light +
                 distances;
        *moments += distances;
    }
    return bytes;
}

const alp_ambience_snapshot *alp_ambience_begin_read(alp_ambience *ambience)
{
    if (ambience == NULL) {
        return NULL;
    }
    alpi_snapshots *s = &ambience->snapshots;
    for (;;) {
        const uint32_t current = atomic_load(&s->current);
        alp_ambience_snapshot *taken = s->all[current];
        atomic_fetch_add(&taken->readers, 1);
        if (atomic_load(&s->current) == current) {
            return taken;
        }
        atomic_fetch_sub(&taken->readers, 1);
    }
}

void alp_ambience_end_read(alp_ambience *ambience, const alp_ambience_snapshot *snapshot)
{
    for (uint32_t i = 0; ambience != NULL && i < ALPI_AMBIENCE_SNAPSHOTS; i++) {
        if (ambience->snapshots.all[i] == snapshot && snapshot != NULL) {
            atomic_fetch_sub(&ambience->snapshots.all[i]->readers, 1);
            return;
        }
    }
}
