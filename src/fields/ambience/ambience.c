// SPDX-License-Identifier: MIT
#include "fields/ambience/ambience.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { DEPTH_MOST = 10, ANCHORS_LEAST = 64, ANCHORS_MOST = 1 << 20 };
/// Nodes for each anchor that may be held, besides one chain of blocks.
enum { NODES_EACH = 3 };
/// Largest change of E per second that a fade makes, of the mean E. At 60 frames a second this is
/// half a per cent a frame. A renewal and a new finer anchor at the same place together make 1 %.
static const float FADE_RATE = 0.3f;

alp_ambience_options alp_ambience_options_default(void)
{
    return (alp_ambience_options){.struct_size = sizeof(alp_ambience_options),
                                  .size = 243.0,
                                  .depth = 5,
                                  .above = 1.5,
                                  .lifetime = 6.0,
                                  .fade = 1.0,
                                  .anchor_limit = 8192,
                                  .visibility = true};
}

// --- places --------------------------------------------------------------------------------------

void alpi_ambience_place(const alp_ambience *a, uint32_t level, const int32_t index[3],
                         double place[3])
{
    const double cell = alpi_ambience_cell(a, level);
    for (int k = 0; k < 3; k++) {
        place[k] = a->options.centre[k] + cell * (double)index[k];
    }
    if (a->options.flat) {
        const double ground = a->options.height != NULL
                                  ? a->options.height(a->options.height_user, place[0], place[2])
                                  : 0.0;
        place[1] = (isfinite(ground) ? ground : 0.0) + a->options.above;
    }
}

void alpi_anchor_place(const alp_ambience *a, const alpi_anchor *at, double place[3])
{
    const double cell = alpi_ambience_cell(a, at->level);
    for (int k = 0; k < 3; k++) {
        place[k] = a->options.centre[k] + cell * (double)at->index[k];
    }
    if (a->options.flat) {
        place[1] = (double)at->height;
    }
}

bool alpi_ambience_index(const alp_ambience *a, uint32_t level, const double place[3],
                         int32_t index[3])
{
    const double widest = (double)alpi_graph_width(ALPI_GRAPH_LEVELS - 1) / 2.0;
    for (int k = 0; k < 3; k++) {
        const double units = (place[k] - a->options.centre[k]) / a->unit;
        if (!(fabs(units) < widest)) { // NaN too
            return false;
        }
        index[k] = a->options.flat && k == 1
                       ? 0
                       : (int32_t)floor(units / (double)alpi_graph_width(level) + 0.5);
    }
    return true;
}

// --- life ----------------------------------------------------------------------------------------

static alp_result check_options(alp_context *context, const alp_ambience_options *o)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (o->struct_size != sizeof *o) {
        return alpi_fail(context, code, "ambience options are not from _default()");
    }
    if (!isfinite(o->centre[0]) || !isfinite(o->centre[1]) || !isfinite(o->centre[2])) {
        return alpi_fail(context, code, "ambience: the centre is not finite");
    }
    if (!(o->size > 0.0) || !isfinite(o->size) || o->depth < 1 || o->depth > DEPTH_MOST) {
        return alpi_fail(context, code, "ambience: size %g m, depth %u; need > 0 and 1 to %d",
                         o->size, o->depth, DEPTH_MOST);
    }
    if (!(o->lifetime > 0.0) || !isfinite(o->lifetime) || !(o->fade >= 0.0) || !isfinite(o->fade) ||
        !(o->above >= 0.0) || !isfinite(o->above)) {
        return alpi_fail(context, code,
                         "ambience: lifetime %g s, fade %g s, %g m above the ground; need a "
                         "lifetime > 0 and others ≥ 0",
                         o->lifetime, o->fade, o->above);
    }
    if (o->anchor_limit < ANCHORS_LEAST || o->anchor_limit > ANCHORS_MOST) {
        return alpi_fail(context, code, "ambience: at most %u anchors; need %d to %d",
                         o->anchor_limit, ANCHORS_LEAST, ANCHORS_MOST);
    }
    if ((uint32_t)o->lookup > ALP_AMBIENCE_CONFORMANCE) {
        return alpi_fail(context, code, "ambience: unknown look-up %d", (int)o->lookup);
    }
    return ALP_OK;
}

static alp_result create(alp_ambience *a)
{
    const alp_ambience_options *o = &a->options;
    const uint32_t chain = (o->depth + 2) * ALPI_GRAPH_CHILDREN;
    a->unit = o->size / (double)alpi_graph_width(o->depth);
    alpi_lights_open(a->context, o->visibility, &a->lights);
    alpi_lights_open(a->context, o->visibility, &a->nexts);
    a->free_anchor = ALPI_NO_ANCHOR;
    a->plan_age = UINT32_MAX / 2;
    a->fade_rate = FADE_RATE;
    a->rate = 1e6; // until it is measured
    for (int k = 0; k < 3; k++) {
        a->bounds_min[k] = -HUGE_VAL;
        a->bounds_max[k] = HUGE_VAL;
    }
    a->time = a->first_time = a->planned_time = (double)NAN;
    ALP_TRY(alpi_graph_create(a->context, o->flat, o->depth, NODES_EACH * o->anchor_limit + chain,
                              &a->graph));
    ALP_TRY(alpi_requests_create(a));
    return alpi_snapshot_publish(a); // readers may come before the first update
}

alp_result alp_ambience_create(alp_context *context, const alp_ambience_options *options,
                               alp_ambience **ambience)
{
    if (context == NULL || ambience == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *ambience = NULL;
    const alp_ambience_options o = options ? *options : alp_ambience_options_default();
    ALP_TRY(check_options(context, &o));
    alp_ambience *a = ALPI_NEW(context, alp_ambience, 1);
    if (a == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    a->context = context;
    a->options = o;
    const alp_result result = create(a);
    if (result != ALP_OK) {
        alp_ambience_destroy(a);
        return result;
    }
    *ambience = a;
    return ALP_OK;
}

void alp_ambience_destroy(alp_ambience *a)
{
    if (a == NULL) {
        return;
    }
    for (uint32_t i = 0; i < a->anchor_end; i++) {
        if (a->drop_hits != NULL && a->anchors[i].hits != NULL) {
            a->drop_hits(a, &a->anchors[i]);
        }
    }
    alpi_snapshots_destroy(a);
    alpi_graph_destroy(&a->graph);
    alpi_release(a->context, a->anchors);
    alpi_lights_close(&a->lights);
    alpi_lights_close(&a->nexts);
    alpi_requests_destroy(a);
    alpi_release(a->context, a->wishes);
    alpi_release(a->context, a);
}

// --- update --------------------------------------------------------------------------------------

/// How many anchors a second the host samples. While it samples all that are wanted, more may be.
static void find_rate(alp_ambience *a, double step)
{
    if (!(step > 0.0)) {
        return;
    }
    const double keep = exp(-step), now = (double)a->taken / step;
    const bool starved = a->wish_count > 0;
    a->rate = starved ? keep * a->rate + (1.0 - keep) * now : fmax(a->rate * (1.0 + step), now);
    a->rate = fmin(a->rate, 1e6);
    a->taken = 0;
}

alp_result alp_ambience_update(alp_ambience *ambience, double time)
{
    alp_ambience *a = ambience;
    if (a == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (!isfinite(time) || time < a->time) {
        return alpi_fail(a->context, ALP_ERROR_INVALID_ARGUMENT,
                         "ambience: time %g s after %g s; need a finite time that does not run "
                         "backwards",
                         time, a->time);
    }
    const double step = isnan(a->time) ? 0.0 : time - a->time;
    const bool dark = !(alpi_ambience_published(a)->dawn > 0.0f);
    a->first_time = isnan(a->time) ? time : a->first_time;
    a->time = dark && !isnan(a->time) ? a->time : time; // no light is visible that could jump
    ALP_TRY(alpi_requests_collect(a));
    a->time = time;
    alpi_anchors_step(a, step);
    alpi_graph_prune(&a->graph);
    ALP_TRY(alpi_ambience_compact(a));
    alpi_ambience_find_base(a, step);
    find_rate(a, step);
    a->plan_age++;
    return alpi_snapshot_publish(a);
}

void alp_ambience_invalidate(alp_ambience *ambience, bool traced, const double box_min[3],
                             const double box_max[3])
{
    if (ambience == NULL) {
        return;
    }
    ambience->plan_age = UINT32_MAX / 2;
    ambience->stale_serial++;
    for (uint32_t i = 0; i < ambience->anchor_end; i++) {
        alpi_anchor *at = &ambience->anchors[i];
        double place[3];
        bool inside = true;
        alpi_anchor_place(ambience, at, place);
        for (int k = 0; k < 3 && box_min != NULL && box_max != NULL; k++) {
            inside = inside && place[k] >= box_min[k] && place[k] <= box_max[k];
        }
        if (inside && at->state != ALPI_ANCHOR_FREE) {
            at->stale_light = ambience->stale_serial;
            at->stale_trace = traced ? ambience->stale_serial : at->stale_trace;
        }
    }
}

alp_ambience_info alp_ambience_get_info(const alp_ambience *a)
{
    alp_ambience_info info = {0};
    if (a == NULL) {
        return info;
    }
    uint32_t finest = ALPI_GRAPH_LEVELS;
    for (uint32_t i = 0; i < a->anchor_end; i++) {
        info.anchors += a->anchors[i].state == ALPI_ANCHOR_LIT;
        info.solids += a->anchors[i].state == ALPI_ANCHOR_SOLID;
    }
    for (uint32_t i = 0; i < a->graph.node_end; i++) {
        const alpi_graph_node *node = &a->graph.nodes[i];
        const bool lit = node->anchor != ALPI_NO_ANCHOR &&
                         a->anchors[node->anchor].state == ALPI_ANCHOR_LIT &&
                         (node->parent != ALPI_NO_NODE || i == ALPI_GRAPH_ROOT);
        const bool own = lit && node->place != alpi_graph_middle(a->options.flat);
        finest = own && node->level < finest ? node->level : finest;
    }
    info.nodes = a->graph.node_count;
    info.levels = a->graph.nodes[ALPI_GRAPH_ROOT].level + 1u;
    info.open = alpi_requests_count(a);
    uint64_t distances = 0;
    const uint64_t shots = alpi_snapshots_bytes(a, &distances);
    const uint64_t own =
        (a->lights.moment_capacity + a->nexts.moment_capacity) * sizeof *a->lights.moments;
    info.bytes_visibility = distances + own;
    info.bytes_hits = a->hit_bytes;
    info.bytes = sizeof *a + shots + own + a->graph.node_capacity * sizeof *a->graph.nodes +
                 (a->lights.capacity + a->nexts.capacity) * sizeof *a->lights.light +
                 a->anchor_capacity * sizeof *a->anchors + a->wish_capacity * sizeof *a->wishes +
                 a->hit_bytes + alpi_requests_bytes();
    info.time = a->time;
    info.cell = finest < ALPI_GRAPH_LEVELS ? alpi_ambience_cell(a, finest) : 0.0;
    return info;
}
