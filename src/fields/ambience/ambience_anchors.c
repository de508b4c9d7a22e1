// SPDX-License-Identifier: MIT
#include "base/memory.h"
#include "fields/ambience/ambience.h"

#include <float.h>
#include <math.h>
#include <string.h>

/// Largest change of E per second that a fade makes, of the mean E. At 60 frames a second this is
/// half a per cent a frame; a renewal and a new finer anchor at the same place together make one.
static const float FADE_RATE = 0.3f;
/// Weight of a solid, as a share of its places, from which its fade is even: see solid_openness.
static const float SOLID_SHARE = 0.2f;
/// Geometry changes seldom: solids are valid for so many lifetimes.
static const double SOLID_LIFETIMES = 4.0;
/// Change of E by new lighting, over the mean, from which an anchor is lit once more: what bounced
/// to it came from anchors that had the old light.
static const float BOUNCE_CHANGE = 0.01f;

// --- pool ----------------------------------------------------------------------------------------

alp_result alpi_anchor_create(alp_ambience *a, uint32_t node, uint32_t *anchor)
{
    *anchor = ALPI_NO_ANCHOR;
    if (a->anchor_count >= a->options.anchor_limit) {
        return ALP_OK;
    }
    uint32_t made = a->free_anchor;
    if (made == ALPI_NO_ANCHOR) {
        ALP_TRY(alpi_grow_tightly(a->context, (void **)&a->anchors, &a->anchor_capacity,
                                  (size_t)a->anchor_end + 1, sizeof *a->anchors));
        made = a->anchor_end++;
    } else {
        a->free_anchor = a->anchors[made].next_free;
    }
    const alpi_graph_node *top = &a->graph.nodes[alpi_graph_top(&a->graph, node)];
    alpi_anchor *new = &a->anchors[made];
    memset(new, 0, sizeof *new);
    new->version = ++a->version_serial;
    memcpy(new->index, top->index, sizeof new->index);
    new->level = top->level;
    new->state = ALPI_ANCHOR_EMPTY;
    new->slot = new->next = ALPI_NO_SLOT;
    new->open = 1.0f;
    new->wanted = a->time;
    double place[3];
    alpi_ambience_place(a, top->level, top->index, place);
    new->height = (float)place[1];
    a->anchor_count++;
    alpi_graph_set_anchor(&a->graph, node, made);
    *anchor = made;
    return ALP_OK;
}

void alpi_anchor_release(alp_ambience *a, uint32_t anchor)
{
    alpi_anchor *old = &a->anchors[anchor];
    const uint32_t node = alpi_graph_find(&a->graph, old->level, old->index);
    if (node != ALPI_NO_NODE) {
        alpi_graph_set_anchor(&a->graph, node, ALPI_NO_ANCHOR);
    }
    if (a->drop_hits != NULL && old->hits != NULL) {
        a->drop_hits(a, old);
    }
    alpi_lights_give(&a->lights, &old->slot);
    alpi_lights_give(&a->nexts, &old->next);
    old->state = ALPI_ANCHOR_FREE;
    old->next_free = a->free_anchor;
    a->free_anchor = anchor;
    a->anchor_count--;
}

// --- new light -----------------------------------------------------------------------------------

float alpi_ambience_mean(const float light[ALPI_AMBIENCE_FLOATS])
{
    return (float)(ALP_SH_A0 * ALP_SH_Y0) * (light[0] + light[1] + light[2]) / 3.0f;
}

/// Largest difference of E over six normals and the channels.
static float find_difference(const float a[ALPI_AMBIENCE_FLOATS],
                             const float b[ALPI_AMBIENCE_FLOATS])
{
    alpi_sh9 apart;
    float largest = 0.0f;
    for (int i = 0; i < ALPI_AMBIENCE_FLOATS; i++) {
        apart.c[i / 3][i % 3] = a[i] - b[i];
    }
    for (int i = 0; i < 6; i++) {
        const float way = i % 2 == 0 ? 1.0f : -1.0f;
        const vec3 e =
            alpi_sh9_irradiance(&apart, (vec3){i / 2 == 0 ? way : 0.0f, i / 2 == 1 ? way : 0.0f,
                                               i / 2 == 2 ? way : 0.0f});
        largest = fmaxf(largest, fmaxf(fabsf(e.x), fmaxf(fabsf(e.y), fabsf(e.z))));
    }
    return largest;
}

static const alp_ambience_snapshot *published(const alp_ambience *a)
{
    return a->snapshots.all[atomic_load(&a->snapshots.current)];
}

/// Before time moves, all light counts at once.
static bool is_first(const alp_ambience *a)
{
    return !(a->time > a->first_time);
}

/// Distances of an anchor without any: it sees everything.
static void see_all(alpi_light_pool *pool, uint32_t slot)
{
    for (int i = 0; i < ALPI_AMBIENCE_MOMENTS && pool->visibility; i++) {
        pool->moments[slot][i][0] = 1e9f;
        pool->moments[slot][i][1] = 1e18f;
    }
}

static void put(alpi_light_pool *pool, uint32_t slot, const alpi_sh9 *radiance,
                const float (*moments)[2])
{
    memcpy(pool->light[slot], radiance->c, sizeof *pool->light);
    if (pool->visibility && moments != NULL) {
        memcpy(pool->moments[slot], moments, sizeof *pool->moments);
    }
}

/// Largest difference of E between new light and what readers see at the anchor now.
static float find_jump(const alp_ambience *a, const alpi_anchor *at, const alpi_sh9 *radiance)
{
    float before[ALPI_AMBIENCE_FLOATS], now[ALPI_AMBIENCE_FLOATS];
    memcpy(now, radiance->c, sizeof now);
    if (at->slot != ALPI_NO_SLOT) {
        memcpy(before, a->lights.light[at->slot], sizeof before);
    } else {
        double place[3];
        alpi_anchor_place(a, at, place);
        alpi_ambience_read(published(a), place, NULL, before);
    }
    return find_difference(now, before);
}

/// Seconds that new light takes: longer for large changes, unless the lighting changed. A
/// fade under way goes on at its speed at least, or renewals of still light would never end it.
static float find_fade(const alp_ambience *a, const alpi_anchor *at, float jump)
{
    const float least = (float)a->options.fade, most = fmaxf(least, (float)a->options.lifetime);
    const float fade = fminf(fmaxf(at->change / FADE_RATE, least), most);
    if (is_first(a)) {
        return 0.0f;
    }
    if (at->stale_light) { // lamps or the sun moved
        return least;
    }
    if (at->next == ALPI_NO_SLOT) {
        return fade;
    }
    const float left = find_difference(a->nexts.light[at->next], a->lights.light[at->slot]);
    const float longer = left > 0.0f ? fmaxf(jump / left, 1.0f) : 1.0f;
    return fminf(fade, longer * at->fade_left);
}

/// Slots for new light. A first light takes the place of none.
static alp_result take_slots(alp_ambience *a, alpi_anchor *at, bool renewed)
{
    if (at->slot == ALPI_NO_SLOT) {
        ALP_TRY(alpi_lights_take(&a->lights, &at->slot));
        see_all(&a->lights, at->slot);
    }
    if (renewed && at->next == ALPI_NO_SLOT) {
        ALP_TRY(alpi_lights_take(&a->nexts, &at->next));
        if (a->lights.visibility) { // without new distances the old ones stay
            memcpy(a->nexts.moments[at->next], a->lights.moments[at->slot],
                   sizeof *a->nexts.moments);
        }
    }
    return ALP_OK;
}

alp_result alpi_anchor_light(alp_ambience *a, uint32_t anchor, const alpi_sh9 *radiance,
                             const float (*moments)[2])
{
    alpi_anchor *at = &a->anchors[anchor];
    const bool renewed = at->slot != ALPI_NO_SLOT && !is_first(a);
    const float jump = find_jump(a, at, radiance), mean = alpi_ambience_mean(a->base);
    at->pending = false;
    at->change = mean > 0.0f ? jump / mean : 0.0f;
    const float fade = find_fade(a, at, jump);
    ALP_TRY(take_slots(a, at, renewed));
    if (renewed && fade > 0.0f) {
        put(&a->nexts, at->next, radiance, moments);
        at->fade_left = fade;
    } else {
        put(&a->lights, at->slot, radiance, moments);
        alpi_lights_give(&a->nexts, &at->next);
        at->mean = alpi_ambience_mean(a->lights.light[at->slot]);
    }
    at->confidence = is_first(a) ? 1.0f : at->confidence;
    if (!(at->confidence_rate > 0.0f)) { // it comes, or comes back
        const float least = fmaxf((float)a->options.fade, 1e-3f);
        const float longest = fmaxf(least, (float)a->options.lifetime);
        at->confidence_rate = 1.0f / fminf(fmaxf(at->change / FADE_RATE, least), longest);
    }
    at->state = ALPI_ANCHOR_LIT;
    at->again = at->stale_light && at->change > BOUNCE_CHANGE;
    at->leaving = at->stale_light = at->stale_trace = false;
    at->born = a->time;
    at->open = 1.0f;
    at->version = ++a->version_serial;
    a->taken++;
    return ALP_OK;
}

void alpi_anchor_solid(alp_ambience *a, uint32_t anchor, float surface)
{
    alpi_anchor *at = &a->anchors[anchor];
    at->pending = at->stale_light = at->stale_trace = false;
    at->born = a->time;
    at->mean = surface;
    a->taken++;
    if (at->state != ALPI_ANCHOR_SOLID) {
        at->state = ALPI_ANCHOR_SOLID;
        at->solid_time = 0.0f;
        at->leaving = false;
        alpi_lights_give(&a->nexts, &at->next);
        at->confidence_rate = at->confidence > 0.0f ? -1.0f : 0.0f;
        if (is_first(a)) {
            at->open = at->confidence = 0.0f;
            at->solid_time = FLT_MAX;
        }
        at->version = ++a->version_serial;
    }
}

// --- time ----------------------------------------------------------------------------------------

/// Openness of a solid at a share u of its fade. If its places have the weight 1 − s, the others'
/// share grows evenly: s / (s + (1 − s) o) = s + (1 − s) u.
static float solid_openness(float u)
{
    return u >= 1.0f ? 0.0f : SOLID_SHARE * (1.0f - u) / (SOLID_SHARE + (1.0f - SOLID_SHARE) * u);
}

static void fade_light(alp_ambience *a, alpi_anchor *at, float step)
{
    if (step < at->fade_left) {
        alpi_lights_blend(&a->lights, at->slot, &a->nexts, at->next, step / at->fade_left);
        at->fade_left -= step;
    } else {
        alpi_lights_copy(&a->lights, at->slot, &a->nexts, at->next);
        alpi_lights_give(&a->nexts, &at->next);
        at->stale_light = at->stale_light || at->again; // light that bounced there changed too
        at->again = false;
    }
    at->mean = alpi_ambience_mean(a->lights.light[at->slot]);
    at->version = ++a->version_serial;
}

static void fade_confidence(alp_ambience *a, alpi_anchor *at, float step)
{
    const float limit = at->confidence_rate < 0.0f ? 0.0f : 1.0f;
    if (at->confidence_rate != 0.0f && at->confidence != limit) {
        const float moved = at->confidence + at->confidence_rate * step;
        at->confidence = limit > 0.0f ? fminf(moved, 1.0f) : fmaxf(moved, 0.0f);
        at->version = ++a->version_serial;
    }
}

/// How far light at an anchor is from that without it, over the mean.
static float loss_without(const alp_ambience *a, const alpi_anchor *at)
{
    const float mean = alpi_ambience_mean(a->base);
    return mean > 0.0f ? find_difference(a->lights.light[at->slot], a->base) / mean : 0.0f;
}

/// Closes a solid, or opens it again when it has not been renewed for long.
static void step_solid(alp_ambience *a, alpi_anchor *at, float step)
{
    const float fade = fmaxf((float)a->options.fade, 1.0f) * 2.0f;
    at->leaving = a->time - at->born > SOLID_LIFETIMES * a->options.lifetime;
    const float moved = at->solid_time + (at->leaving ? -step : step);
    const float now = fminf(fmaxf(moved, 0.0f), fade);
    if (now != at->solid_time) {
        at->solid_time = now;
        at->open = solid_openness(now / fade);
        at->version = ++a->version_serial;
    }
}

static void step_lit(const alp_ambience *a, alpi_anchor *at)
{
    if (!at->leaving && a->time - at->born > a->options.lifetime) {
        const float least = fmaxf((float)a->options.fade, 1e-3f);
        const float fade =
            fmaxf(least, fminf(loss_without(a, at) / FADE_RATE, (float)a->options.lifetime));
        at->leaving = true;
        at->confidence_rate = -1.0f / fade;
    }
}

void alpi_anchors_step(alp_ambience *a, double step)
{
    const float dt = (float)step;
    for (uint32_t i = 0; i < a->anchor_end; i++) {
        alpi_anchor *at = &a->anchors[i];
        if (at->state == ALPI_ANCHOR_FREE) {
            continue;
        }
        fade_confidence(a, at, dt);
        if (at->state == ALPI_ANCHOR_SOLID) {
            if (!(at->confidence > 0.0f)) {
                alpi_lights_give(&a->lights, &at->slot);
            }
            step_solid(a, at, dt);
        } else if (at->state == ALPI_ANCHOR_LIT) {
            if (at->next != ALPI_NO_SLOT) {
                fade_light(a, at, dt);
            }
            step_lit(a, at);
        }
        const bool gone =
            at->state == ALPI_ANCHOR_SOLID ? !(at->solid_time > 0.0f) : !(at->confidence > 0.0f);
        const bool dark = at->state == ALPI_ANCHOR_EMPTY || (at->leaving && gone);
        if (dark && !at->pending) {
            alpi_anchor_release(a, i);
        }
    }
}
