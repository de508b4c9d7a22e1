// SPDX-License-Identifier: MIT
#include "base/memory.h"
#include "fields/ambience/ambience.h"

#include <float.h>
#include <math.h>
#include <string.h>

/// Steepness of the fade of a solid: see solid_openness.
static const float SOLID_STEEPNESS = 8.0f, INVERSE_E = 0.36787944f;
/// Geometry changes seldom: solids are valid for so many lifetimes.
static const double SOLID_LIFETIMES = 4.0;
/// Change of E by new lighting, over the mean, from which an anchor is lit once more. Its bounced
/// light came from anchors that had the old light.
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

/// +x −x +y −y +z −z.
static vec3 axis_normal(int i)
{
    const float way = i % 2 == 0 ? 1.0f : -1.0f;
    return (vec3){i / 2 == 0 ? way : 0.0f, i / 2 == 1 ? way : 0.0f, i / 2 == 2 ? way : 0.0f};
}

static float largest_part(vec3 e)
{
    return fmaxf(fabsf(e.x), fmaxf(fabsf(e.y), fabsf(e.z)));
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
        largest = fmaxf(largest, largest_part(alpi_sh9_irradiance(&apart, axis_normal(i))));
    }
    return largest;
}

/// Before time moves, all light counts at once.
static bool is_first(const alp_ambience *a)
{
    return !(a->time > a->first_time);
}

/// Distances of an anchor without any: it sees all points that read it. In a volume they are within
/// a cell's diagonal, and a lift of a quarter of a cell. In a flat one they have any height.
static void see_all(alp_ambience *a, const alpi_anchor *at)
{
    const float cell = (float)alpi_ambience_cell(a, at->level);
    const float reach = a->options.flat ? 1e9f : 2.0f * cell;
    for (int i = 0; i < ALPI_AMBIENCE_MOMENTS && a->lights.visibility; i++) {
        a->lights.moments[at->slot][i][0] = reach;
        a->lights.moments[at->slot][i][1] = reach * reach;
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
    float now[ALPI_AMBIENCE_FLOATS], largest = 0.0f;
    memcpy(now, radiance->c, sizeof now);
    if (at->slot != ALPI_NO_SLOT) {
        return find_difference(now, a->lights.light[at->slot]);
    }
    const alp_ambience_snapshot *s = alpi_ambience_published(a);
    const float scale = s->dawn > 0.0f ? 1.0f / s->dawn : 0.0f; // all light dawns together
    double place[3];
    alpi_anchor_place(a, at, place);
    for (int i = 0; i < 6; i++) {
        const vec3 normal = axis_normal(i);
        const vec3 before = vec3_scale(alpi_ambience_irradiance_at(s, place, normal), scale);
        largest =
            fmaxf(largest, largest_part(vec3_sub(alpi_sh9_irradiance(radiance, normal), before)));
    }
    return largest;
}

/// How far light at an anchor is from that without it, over the mean.
static float loss_without(const alp_ambience *a, const alpi_anchor *at)
{
    return a->mean > 0.0f ? find_difference(a->lights.light[at->slot], a->base) / a->mean : 0.0f;
}

/// Seconds in which a change of E over the mean fades.
static float fade_seconds(const alp_ambience *a, float change)
{
    const float least = fmaxf((float)a->options.fade, 1e-3f);
    const float longest = fmaxf(least, (float)a->options.lifetime);
    return fminf(fmaxf(change / a->fade_rate, least), longest);
}

/// Levels on which an anchor is read.
static uint8_t count_levels(const alp_ambience *a, const alpi_anchor *at)
{
    uint32_t node = alpi_graph_find(&a->graph, at->level, at->index);
    uint8_t count = 0;
    while (node != ALPI_NO_NODE) {
        const uint32_t child = a->graph.nodes[node].child;
        node = child != ALPI_NO_NODE ? child + alpi_graph_middle(a->options.flat) : ALPI_NO_NODE;
        count++;
    }
    return count;
}

/// Levels at the place of an anchor whose light is less than half there, its own included. Fades of
/// levels add up, so new light gets its share of the rate of one.
static uint32_t count_fading_in(const alp_ambience *a, const alpi_anchor *at)
{
    uint32_t node = alpi_graph_find(&a->graph, at->level, at->index), count = 1;
    for (; node != ALPI_NO_NODE; node = a->graph.nodes[node].parent) {
        const uint32_t anchor = a->graph.nodes[node].anchor;
        const alpi_anchor *above = anchor != ALPI_NO_ANCHOR ? &a->anchors[anchor] : at;
        count += above != at && above->state == ALPI_ANCHOR_LIT && above->confidence < 0.5f;
    }
    return count;
}

/// Share of a solid's fade in a second. It moves weight between neighbours and coarser levels.
static float solid_rate(const alp_ambience *a, const alpi_anchor *at)
{
    const uint32_t node = alpi_graph_find(&a->graph, at->level, at->index);
    float loss = 0.0f;
    for (int d = 0; d < ALPI_GRAPH_DIRECTIONS && node != ALPI_NO_NODE; d++) {
        const uint32_t beside = a->graph.nodes[node].neighbour[d];
        const uint32_t other =
            beside != ALPI_NO_NODE ? a->graph.nodes[beside].anchor : ALPI_NO_ANCHOR;
        if (other != ALPI_NO_ANCHOR && a->anchors[other].slot != ALPI_NO_SLOT) {
            loss = fmaxf(loss, loss_without(a, &a->anchors[other]));
        }
    }
    return 1.0f / fade_seconds(a, INVERSE_E * SOLID_STEEPNESS * loss);
}

/// Seconds that new light takes: longer for large changes, unless the lighting changed. A
/// fade under way goes on at its speed at least, or renewals of still light would never end it.
static float find_fade(const alp_ambience *a, const alpi_anchor *at, float jump, bool relit)
{
    const float fade = fade_seconds(a, at->change);
    if (is_first(a)) {
        return 0.0f;
    }
    if (relit) {
        return fade_seconds(a, 0.0f);
    }
    if (at->next == ALPI_NO_SLOT) {
        return fade;
    }
    const float left = find_difference(a->nexts.light[at->next], a->lights.light[at->slot]);
    const float longer = left > 0.0f ? fmaxf(jump / left, 1.0f) : 1.0f;
    return fminf(fade, longer * at->fade_left);
}

/// Openness o of a solid at a share u of its fade. Other places of weight s have the share
/// s / (s + (1 − s) o) of a level. For each s above .004, one level's share rises by a quarter of
/// the steepness at most. That of several levels rises by 1/e of it.
static float solid_openness(float u)
{
    const float end = expf(-SOLID_STEEPNESS);
    return (expf(-SOLID_STEEPNESS * u) - end) / (1.0f - end);
}

static void set_closed(alpi_anchor *at, float closed)
{
    at->closed = closed;
    at->open = solid_openness(closed);
}

/// Slots for new light. A first light takes the place of none.
static alp_result take_slots(alp_ambience *a, alpi_anchor *at, bool renewed)
{
    if (at->slot == ALPI_NO_SLOT) {
        ALP_TRY(alpi_lights_take(&a->lights, &at->slot));
        see_all(a, at);
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

/// It has all changes up to a serial.
static void freshen(alpi_anchor *at, uint32_t serial)
{
    at->stale_light = at->stale_light <= serial ? 0 : at->stale_light;
    at->stale_trace = at->stale_trace <= serial ? 0 : at->stale_trace;
}

alp_result alpi_anchor_light(alp_ambience *a, uint32_t anchor, const alpi_sh9 *radiance,
                             const float (*moments)[2], uint32_t serial)
{
    alpi_anchor *at = &a->anchors[anchor];
    const bool relit = at->stale_light != 0 && at->stale_light <= serial;
    const bool renewed = at->slot != ALPI_NO_SLOT && !is_first(a);
    const float jump = find_jump(a, at, radiance);
    at->pending = false;
    at->change = a->mean > 0.0f ? jump / a->mean : 0.0f;
    const float fade = find_fade(a, at, jump, relit);
    const float loss = at->slot != ALPI_NO_SLOT ? loss_without(a, at) : at->change;
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
        at->confidence_rate = 1.0f / (fade_seconds(a, loss) * (float)count_fading_in(a, at));
        // A new anchor comes before those of finer levels, which fade it in.
        at->fade_levels = at->state == ALPI_ANCHOR_EMPTY ? 1 : count_levels(a, at);
    }
    if (at->state == ALPI_ANCHOR_SOLID) {
        at->solid_rate = solid_rate(a, at);
    }
    if (is_first(a)) {
        set_closed(at, 0.0f);
        a->dawn = 1.0f;
    }
    at->state = ALPI_ANCHOR_LIT;
    at->again = relit && at->change > BOUNCE_CHANGE;
    at->leaving = false;
    freshen(at, serial);
    at->born = a->time;
    at->version = ++a->version_serial;
    a->taken++;
    return ALP_OK;
}

void alpi_anchor_solid(alp_ambience *a, uint32_t anchor, float surface, uint32_t serial)
{
    alpi_anchor *at = &a->anchors[anchor];
    at->pending = false;
    freshen(at, serial);
    at->born = a->time;
    at->surface = surface;
    a->taken++;
    if (at->state != ALPI_ANCHOR_SOLID) {
        at->state = ALPI_ANCHOR_SOLID;
        at->leaving = false;
        alpi_lights_give(&a->nexts, &at->next);
        at->confidence_rate =
            at->slot != ALPI_NO_SLOT ? -1.0f / fade_seconds(a, loss_without(a, at)) : 0.0f;
        at->fade_levels = count_levels(a, at);
        at->solid_rate = solid_rate(a, at);
        if (is_first(a)) {
            at->confidence = 0.0f;
            set_closed(at, 1.0f);
        }
        at->version = ++a->version_serial;
    }
}

// --- time ----------------------------------------------------------------------------------------

static void fade_light(alp_ambience *a, alpi_anchor *at, float step)
{
    if (step < at->fade_left) {
        alpi_lights_blend(&a->lights, at->slot, &a->nexts, at->next, step / at->fade_left);
        at->fade_left -= step;
    } else {
        alpi_lights_copy(&a->lights, at->slot, &a->nexts, at->next);
        alpi_lights_give(&a->nexts, &at->next);
        at->stale_light = at->again ? a->stale_serial : at->stale_light; // it bounced there too
        at->again = false;
    }
    at->mean = alpi_ambience_mean(a->lights.light[at->slot]);
    at->version = ++a->version_serial;
}

/// How fast light at a place follows the confidence f of an anchor. On m levels, the anchor has the
/// share 1 − (1 − f)^m. It has fewer levels beside its place.
static float find_steepness(uint32_t levels, float confidence)
{
    float most = 1.0f, power = 1.0f;
    for (uint32_t m = 2; m <= levels; m++) {
        power *= 1.0f - confidence;
        most = fmaxf(most, (float)m * power);
    }
    return most;
}

/// Light at a place that was a solid waits until it is open.
static void fade_confidence(alp_ambience *a, alpi_anchor *at, float step)
{
    const float limit = at->confidence_rate < 0.0f ? 0.0f : 1.0f;
    const bool waits = limit > 0.0f && at->closed > 0.0f;
    if (at->confidence_rate != 0.0f && at->confidence != limit && !waits) {
        const float steepness = find_steepness(at->fade_levels, at->confidence);
        const float moved = at->confidence + at->confidence_rate * step / steepness;
        at->confidence = limit > 0.0f ? fminf(moved, 1.0f) : fmaxf(moved, 0.0f);
        at->version = ++a->version_serial;
    }
}

/// Closes a solid once its light is gone. Opens it when it has light, or has not been renewed for
/// long.
static void step_solid(alp_ambience *a, alpi_anchor *at, float step)
{
    const bool solid = at->state == ALPI_ANCHOR_SOLID;
    const bool expired = a->time - at->born > SOLID_LIFETIMES * a->options.lifetime;
    if (solid && at->leaving != expired) {
        at->leaving = expired;
        at->solid_rate = solid_rate(a, at);
    }
    const bool closes = solid && !expired && !(at->confidence > 0.0f);
    const float moved = at->closed + (closes ? step : -step) * at->solid_rate;
    const float now = fminf(fmaxf(moved, 0.0f), 1.0f);
    if (now != at->closed) {
        set_closed(at, now);
        at->version = ++a->version_serial;
    }
}

static void step_lit(const alp_ambience *a, alpi_anchor *at)
{
    if (!at->leaving && a->time - at->born > a->options.lifetime) {
        at->leaving = true;
        at->confidence_rate = -1.0f / fade_seconds(a, loss_without(a, at));
        at->fade_levels = count_levels(a, at);
    }
}

void alpi_anchors_step(alp_ambience *a, double step)
{
    const float dt = (float)step;
    a->stale_serial++;
    for (uint32_t i = 0; i < a->anchor_end; i++) {
        alpi_anchor *at = &a->anchors[i];
        if (at->state == ALPI_ANCHOR_FREE) {
            continue;
        }
        fade_confidence(a, at, dt);
        if (at->state == ALPI_ANCHOR_SOLID && !(at->confidence > 0.0f)) {
            alpi_lights_give(&a->lights, &at->slot);
        }
        if (at->state == ALPI_ANCHOR_LIT) {
            if (at->next != ALPI_NO_SLOT) {
                fade_light(a, at, dt);
            }
            step_lit(a, at);
        }
        step_solid(a, at, dt);
        const bool gone = !(at->confidence > 0.0f) && !(at->closed > 0.0f);
        const bool dark = at->state == ALPI_ANCHOR_EMPTY || (at->leaving && gone);
        if (dark && !at->pending) {
            alpi_anchor_release(a, i);
        }
    }
}

// --- light without anchors -----------------------------------------------------------------------

/// Mean of all anchors, by confidence and the volume of their cells. @return false: none has light
static bool find_mean(const alp_ambience *a, float mean[ALPI_AMBIENCE_FLOATS])
{
    double sums[ALPI_AMBIENCE_FLOATS] = {0.0}, total = 0.0;
    for (uint32_t i = 0; i < a->anchor_end; i++) {
        const alpi_anchor *at = &a->anchors[i];
        if (at->state == ALPI_ANCHOR_FREE || !(at->confidence > 0.0f) || at->slot == ALPI_NO_SLOT) {
            continue;
        }
        const double width = (double)alpi_graph_width(at->level);
        const double w = (double)at->confidence * width * width * (a->options.flat ? 1.0 : width);
        for (int k = 0; k < ALPI_AMBIENCE_FLOATS; k++) {
            sums[k] += w * (double)a->lights.light[at->slot][k];
        }
        total += w;
    }
    for (int k = 0; k < ALPI_AMBIENCE_FLOATS && total > 0.0; k++) {
        mean[k] = (float)(sums[k] / total);
    }
    return total > 0.0;
}

void alpi_ambience_find_base(alp_ambience *a, double step)
{
    float mean[ALPI_AMBIENCE_FLOATS] = {0.0f};
    if (!find_mean(a, mean)) {
        return;
    }
    const bool at_once = is_first(a) || !(a->mean > 0.0f);
    const float dt = (float)step, apart = find_difference(mean, a->base);
    a->mean = alpi_ambience_mean(mean);
    const float level = fmaxf(fmaxf(a->mean, alpi_ambience_mean(a->base)), FLT_MIN);
    const float seconds = fminf(apart / (a->fade_rate * level), (float)a->options.lifetime);
    const float share = at_once || dt >= seconds ? 1.0f : dt / seconds;
    for (int k = 0; k < ALPI_AMBIENCE_FLOATS; k++) {
        a->base[k] += share * (mean[k] - a->base[k]);
    }
    a->dawn = fminf(a->dawn + a->fade_rate * dt, 1.0f);
}
