// SPDX-License-Identifier: MIT
#include "transport/direct/direct_polygons.h"

#include "base/random.h"
#include "transport/direct/direct_polygon_aim.h"
#include "transport/paths/panes.h"

#include <math.h>
#include <string.h>

enum { STREAM_POLYGON = 13, USE_PLACE = 0, USE_POLYGON = 1 };
enum { R = ALPI_DIRECT_REPLICATES, CHUNK = ALPI_POLYGON_CHUNK, SCOUTS = 8 };
enum { FEWEST = 8, FEW = 16 };
enum { MISSED = 16 }; // rays of those that met nothing
_Static_assert(CHUNK % R == 0 && SCOUTS % R == 0 && MISSED % R == 0, "replicates take turns");
/// Means of form factors over a half's replicates are uneven where their range is more of their
/// mean than this over the root of all samples.
static const double UNEVEN = 0.25;

// --- samples -------------------------------------------------------------------------------------

static void place_lane(alpi_polygon_gather *g, uint32_t receiver, int lane)
{
    alpi_polygon_wave *w = &g->wave;
    float square[CHUNK][2];
    for (uint32_t s = 0; s < w->count; s++) {
        square[s][0] = w->u[s][lane];
        square[s][1] = w->v[s][lane];
    }
    g->receivers->place(g->receivers->user, receiver, w->count, (const float(*)[2])square,
                        g->placed);
    for (uint32_t s = 0; s < w->count; s++) {
        const alpi_receiver_point *p = &g->placed[s];
        w->position[0][s][lane] = p->position.x;
        w->position[1][s][lane] = p->position.y;
        w->position[2][s][lane] = p->position.z;
        w->normal[0][s][lane] = p->shading_normal.x;
        w->normal[1][s][lane] = p->shading_normal.y;
        w->normal[2][s][lane] = p->shading_normal.z;
        w->origin[0][s][lane] = p->position.x + p->offset * p->geometric_normal.x;
        w->origin[1][s][lane] = p->position.y + p->offset * p->geometric_normal.y;
        w->origin[2][s][lane] = p->position.z + p->offset * p->geometric_normal.z;
        w->offset[s][lane] = p->offset;
    }
}

/// Adds what a free ray brings by its direction. @param left of the light, after panes
static void add_direction(alpi_polygon_gather *g, uint32_t polygon, uint32_t s, uint32_t lane,
                          vec3 left)
{
    const alpi_polygon_wave *w = &g->wave;
    const alpi_rays *rays = &w->rays[s];
    const vec3 light = vec3_scale(g->polygons[polygon].radiance, w->weight[s][lane]);
    alpi_directional_found *to = &g->directional[lane][polygon];
    alpi_directional_way way = {
        .direction = {rays->direction_x[lane], rays->direction_y[lane], rays->direction_z[lane]},
        .normal = {w->normal[0][s][lane], w->normal[1][s][lane], w->normal[2][s][lane]}};
    way.cosine = vec3_dot(way.direction, way.normal);
    if (way.cosine > 0.0f) {
        const double irradiance[3] = {(double)(light.x * left.x), (double)(light.y * left.y),
                                      (double)(light.z * left.z)};
        alpi_directional_add(&to->sums, irradiance, &way);
        for (int k = 0; k < 3; k++) {
            to->irradiance[k] += irradiance[k];
        }
    }
}

static void add_directions(alpi_polygon_gather *g, uint32_t polygon)
{
    const alpi_polygon_wave *w = &g->wave;
    for (uint32_t s = 0; s < w->count - w->scouts; s++) {
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            if (w->weight[s][i] > 0.0f && w->rays[s].maximum[i] >= 0.0f) {
                add_direction(g, polygon, s, i, (vec3){1.0f, 1.0f, 1.0f});
            }
        }
    }
}

/// Adds what is seen of the polygon through panes, per channel.
static void tally_panes(alpi_polygon_gather *g, uint32_t polygon)
{
    alpi_polygon_tally *t = &g->tallies[polygon];
    alpi_polygon_wave *w = &g->wave;
    for (uint32_t s = 0; s < w->count - w->scouts; s++) {
        vec3 left[ALPI_PACKET] = {{0.0f, 0.0f, 0.0f}};
        uint32_t free = 0;
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            free |= w->weight[s][i] > 0.0f && w->rays[s].maximum[i] >= 0.0f ? 1u << i : 0u;
        }
        alpi_panes_dim(g->options->scene, g->options->tracer, g->options->filter, free, &w->rays[s],
                       left);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            if ((free >> i & 1u) != 0) {
                const double weight = (double)w->weight[s][i];
                const uint32_t r = (w->begin + s) % R;
                t->seen[0][r][i] += weight * (double)left[i].x;
                t->seen[1][r][i] += weight * (double)left[i].y;
                t->seen[2][r][i] += weight * (double)left[i].z;
                if (g->by_direction) {
                    add_direction(g, polygon, s, i, left[i]);
                }
            }
        }
    }
}

/// Traces the packets that bring anything; `maximum` of the others says free, which weighs nothing.
static void trace(alpi_polygon_gather *g, uint32_t active)
{
    alpi_polygon_wave *w = &g->wave;
    const alpi_direct_options *o = g->options;
    uint32_t run = 0; // packets before this one, not traced yet
    for (uint32_t s = 0; s <= w->count; s++) {
        uint32_t sent = 0;
        for (uint32_t i = 0; i < ALPI_PACKET && s < w->count; i++) {
            sent += (active >> i & 1u) != 0 && w->rays[s].maximum[i] > 0.0f;
        }
        g->rays += sent;
        if (sent > 0) {
            run++;
        } else if (run > 0) {
            alpi_trace_occluded(o->tracer, &w->rays[s - run], run, active, o->filter,
                                ALPI_RAYS_PAIRED);
            run = 0;
        }
    }
}

/// Which samples of a polygon count from now on. @return whether any does
static bool want(alpi_polygon_gather *g, uint32_t polygon)
{
    alpi_polygon_wave *w = &g->wave;
    for (uint32_t h = 0; h < ALPI_POLYGON_HALVES; h++) {
        w->any_wanted[h] = g->wanted[polygon][h] != 0;
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            w->wanted[h][i] = (g->wanted[polygon][h] >> i & 1u) != 0 ? 1.0f : 0.0f;
        }
    }
    return w->any_wanted[0] || w->any_wanted[1];
}

/// Numbers as drawn for the use, from sample `first` on; of scouts from the corners of the square,
/// which the lanes share out.
/// @param turn of which corner the first scout is
static void draw(alpi_polygon_gather *g, uint32_t use, uint32_t first, uint32_t turn)
{
    alpi_polygon_wave *w = &g->wave;
    g->loops->draw(w, (const uint32_t(*)[ALPI_PACKET])g->keys, use, first);
    for (uint32_t k = 0; k < w->scouts; k++) {
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            const uint32_t number = k + i, corner = (number + turn * (number / 4)) % 4;
            w->u[w->count - w->scouts + k][i] = (corner == 1 || corner == 2) ? 0.98f : 0.02f;
            w->v[w->count - w->scouts + k][i] = corner >= 2 ? 0.98f : 0.02f;
        }
    }
}

/// Notes whether any scout was free, and any stopped.
static void note_scouts(const alpi_polygon_wave *w, uint8_t scouts[2])
{
    for (uint32_t s = w->count - w->scouts; s < w->count; s++) {
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            if (w->weight[s][i] > 0.0f) {
                scouts[w->rays[s].maximum[i] >= 0.0f ? 0 : 1] = 1;
            }
        }
    }
}

static void ask(alpi_polygon_gather *g, uint32_t polygon, uint32_t first, uint32_t active)
{
    alpi_polygon_wave *w = &g->wave;
    const alpi_polygon *p = &g->polygons[polygon];
    const bool panes = g->options->filter.panes;
    draw(g, USE_POLYGON + polygon, first, 1);
    g->loops->aim(w, p);
    for (uint32_t s = 0; s < w->count; s++) {
        for (uint32_t i = 0; w->nears[s] >> i != 0; i++) {
            if ((w->nears[s] >> i & 1u) != 0 && w->factor[s][i] > 0.0) {
                alpi_polygon_aim_near(w, p, s, i);
            }
        }
    }
    for (uint32_t s = 0; s < w->count && g->above; s++) {
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            if (w->factor[s][i] > 0.0) {
                alpi_polygon_aim_above(w, p, s, i);
            }
        }
    }
    trace(g, active);
    note_scouts(w, g->scouts[polygon]);
    g->loops->tally(w, panes, &g->tallies[polygon]);
    if (panes) {
        tally_panes(g, polygon);
    } else if (g->by_direction) {
        add_directions(g, polygon);
    }
}

/// Samples from `first` on, of the polygons and lanes that want any.
static void gather_chunk(alpi_polygon_gather *g, const uint32_t *receivers, uint32_t count,
                         uint32_t first)
{
    uint32_t lanes = 0;
    for (uint32_t k = 0; k < g->polygon_count; k++) {
        lanes |= g->wanted[k][0] | g->wanted[k][1];
    }
    draw(g, USE_PLACE, first, 0);
    for (uint32_t i = 0; i < count; i++) {
        if ((lanes >> i & 1u) != 0) {
            place_lane(g, receivers[i], (int)i);
        }
    }
    for (uint32_t k = 0; k < g->polygon_count; k++) {
        if (want(g, k)) {
            ask(g, k, first, lanes);
        }
    }
}

/// What the first samples found of a polygon: bit i, lane i by that half of its replicates.
typedef struct first_look {
    uint32_t free[ALPI_POLYGON_HALVES], hidden[ALPI_POLYGON_HALVES]; // by any ray
    uint32_t unclear[ALPI_POLYGON_HALVES]; // points of the receiver were of different minds about
                                           // how much light there is, or no ray went there
} first_look;

static void look_at(const alpi_polygon_gather *g, uint32_t polygon, uint32_t half, uint32_t lane,
                    first_look *look)
{
    const alpi_polygon_tally *t = &g->tallies[polygon];
    const double limit = UNEVEN / sqrt((double)g->samples) / ALPI_POLYGON_HALF;
    const double channels = g->options->filter.panes ? 3.0 : 1.0;
    double factor = 0.0, weight = 0.0, seen = 0.0, least = HUGE_VAL, most = 0.0;
    for (uint32_t r = half * ALPI_POLYGON_HALF; r < (half + 1) * ALPI_POLYGON_HALF; r++) {
        factor += t->factor[r][lane];
        least = fmin(least, t->factor[r][lane]);
        most = fmax(most, t->factor[r][lane]);
        weight += t->weight[r][lane];
        seen += t->seen[0][r][lane];
        for (int k = 1; k < 3 && g->options->filter.panes; k++) {
            seen += t->seen[k][r][lane];
        }
    }
    if (factor > 0.0) {
        const bool uneven = most - least > limit * factor;
        look->free[half] |= seen > 0.0 ? 1u << lane : 0u;
        look->hidden[half] |= seen < channels * weight * (1.0 - 1e-9) ? 1u << lane : 0u;
        look->unclear[half] |= uneven || weight == 0.0 ? 1u << lane : 0u;
    }
}

/// Lanes of a half of which something is unclear, by all rays but their own.
static uint32_t find_unclear(const first_look *l, const uint8_t scouts[2], uint32_t half,
                             uint32_t count)
{
    uint32_t found = l->unclear[1 - half];
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t own = 1u << i;
        const uint32_t free = l->free[1 - half] | (l->free[half] & ~own);
        const uint32_t hidden = l->hidden[1 - half] | (l->hidden[half] & ~own);
        found |= (free != 0 || scouts[0] != 0) && (hidden != 0 || scouts[1] != 0) ? own : 0u;
    }
    return found;
}

/// After the first samples, only receivers go on that found a polygon uneven, or that are in its
/// penumbra: where any of those side by side finds it free, and any hidden. Scouts tell, which
/// count in no mean, neighbours, and each half of the replicates the other. What decides is
/// independent of what it decides about, so nothing is biased.
static bool choose(alpi_polygon_gather *g, uint32_t count)
{
    bool any = false;
    for (uint32_t k = 0; k < g->polygon_count; k++) {
        first_look look = {.free = {0}};
        for (uint32_t i = 0; i < count; i++) {
            for (uint32_t h = 0; h < ALPI_POLYGON_HALVES; h++) {
                look_at(g, k, h, i, &look);
            }
        }
        for (uint32_t h = 0; h < ALPI_POLYGON_HALVES; h++) {
            g->wanted[k][h] = find_unclear(&look, g->scouts[k], h, count);
            any = any || g->wanted[k][h] != 0;
        }
    }
    return any;
}

/// After one half of the fewest samples that there can be, whose points are of as many minds as
/// neighbours and scouts say. Who is alone among the clear with what it found has that half only,
/// and the error of it: nothing that a receiver itself found says whether it goes on, so nothing is
/// biased. @return whether any does
static bool choose_other_half(alpi_polygon_gather *g, uint32_t count)
{
    bool any = false;
    for (uint32_t k = 0; k < g->polygon_count; k++) {
        first_look look = {.free = {0}};
        uint32_t found = 0;
        for (uint32_t i = 0; i < count; i++) {
            look_at(g, k, 0, i, &look);
        }
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t others = ~(1u << i);
            const bool free = (look.free[0] & others) != 0 || g->scouts[k][0] != 0;
            const bool hidden = (look.hidden[0] & others) != 0 || g->scouts[k][1] != 0;
            found |= (free && hidden) || (look.unclear[0] & others) != 0 ? 1u << i : 0u;
        }
        g->wanted[k][0] = 0;
        g->wanted[k][1] = found;
        any = any || found != 0;
    }
    return any;
}

/// Takes the first half of the samples for the other too. @return whether it sees the polygon
static bool repeat_half(alpi_polygon_tally *t, uint32_t lane)
{
    double factor = 0.0;
    for (uint32_t r = 0; r < ALPI_POLYGON_HALF; r++) {
        factor += t->factor[r][lane];
        t->factor[r + ALPI_POLYGON_HALF][lane] = t->factor[r][lane];
        t->weight[r + ALPI_POLYGON_HALF][lane] = t->weight[r][lane];
        for (int k = 0; k < 3; k++) {
            t->seen[k][r + ALPI_POLYGON_HALF][lane] = t->seen[k][r][lane];
        }
    }
    return factor > 0.0;
}

/// Spreads replicates of which each is there twice as far as those of R have to be for the variance
/// of the mean of R / 2: Σ d² / (R/2 (R/2 − 1)) = Σ 2 (f d)² / (R (R − 1)).
static void widen(double sums[R][3], int channels)
{
    const double f = sqrt((R - 1.0) / (ALPI_POLYGON_HALF - 1.0));
    for (int k = 0; k < channels; k++) {
        double mean = 0.0;
        for (int r = 0; r < R; r++) {
            mean += sums[r][k] / R;
        }
        for (int r = 0; r < R; r++) {
            sums[r][k] = mean + f * (sums[r][k] - mean);
        }
    }
}

/// Makes sums over `few` samples those of `all`, alike.
static void scale_tally(alpi_polygon_tally *t, uint32_t half, uint32_t lane, double scale)
{
    for (uint32_t r = half * ALPI_POLYGON_HALF; r < (half + 1) * ALPI_POLYGON_HALF; r++) {
        t->factor[r][lane] *= scale;
        t->weight[r][lane] *= scale;
        for (int k = 0; k < 3; k++) {
            t->seen[k][r][lane] *= scale;
        }
    }
}

/// Form factor × visibility of each replicate, linearised about that of all, so that their mean is
/// that of all: F_r V + F (S_r − V W_r) / W.
/// @param halved whether one half of the samples is there, twice
static void finish(const alpi_polygon_tally *t, bool panes, bool halved, int lane,
                   double sums[R][3])
{
    const int channels = panes ? 3 : 1;
    double factor = 0.0, weight = 0.0;
    for (int r = 0; r < R; r++) {
        factor += t->factor[r][lane];
        weight += t->weight[r][lane];
    }
    const double scale = weight > 0.0 ? 1.0 / weight : 0.0;
    for (int k = 0; k < channels; k++) {
        double seen = 0.0;
        for (int r = 0; r < R; r++) {
            seen += t->seen[k][r][lane];
        }
        const double visible = seen == weight ? 1.0 : seen * scale;
        for (int r = 0; r < R; r++) {
            const double apart = t->seen[k][r][lane] - visible * t->weight[r][lane];
            sums[r][k] = weight > 0.0 ? t->factor[r][lane] * visible + factor * apart * scale : 0.0;
        }
    }
    if (halved) {
        widen(sums, channels);
    }
    for (int r = 0; r < R && channels == 1; r++) {
        sums[r][1] = sums[r][2] = sums[r][0];
    }
}

/// Enough for the mean of what is even, and, with those of the neighbours, to find penumbrae.
/// Directions have no closed form, and may not change what is gathered: half of what is many.
static uint32_t first_samples(uint32_t samples)
{
    const uint32_t few = samples > 64 ? samples / 2 / R * R : samples > 32 ? FEW : FEWEST;
    return samples < few ? samples : few;
}

/// Whether a half of the samples comes first: of the fewest, where enough are side by side to tell
/// whether that will do.
static bool has_half_first(uint32_t samples, uint32_t receivers)
{
    return samples == R && receivers == ALPI_PACKET;
}

/// Of each receiver of a block, so that all corners of a polygon are seen.
static uint32_t scouts_of(uint32_t samples, uint32_t receivers)
{
    return first_samples(samples) < samples || has_half_first(samples, receivers)
               ? (SCOUTS + receivers - 1) / receivers
               : 0;
}

double alpi_polygon_rays(uint32_t samples, uint32_t receivers)
{
    // Only who met nothing sends those to what it missed.
    const double each = samples > MISSED ? samples : MISSED;
    return receivers > 0 ? receivers * (each + scouts_of(samples, receivers)) : 0.0;
}

/// @param scouts sent with the first of them
static alp_result gather_samples(alpi_polygon_gather *g, const uint32_t *receivers, uint32_t count,
                                 const uint32_t range[2], uint32_t scouts)
{
    alpi_polygon_wave *w = &g->wave;
    for (uint32_t first = range[0]; first < range[1]; first += w->count) {
        const uint32_t left = range[1] - first, room = CHUNK - (scouts > 0 ? SCOUTS : 0);
        w->scouts = scouts;
        w->begin = first % R;
        w->count = (left < room ? left : room) + scouts;
        gather_chunk(g, receivers, count, first);
        w->count -= scouts;
        scouts = 0;
        if (!alpi_loop_goes_on(g->options->context)) { // ten thousand samples may take seconds
            return ALP_ERROR_CANCELLED;
        }
    }
    return ALP_OK;
}

/// Which receivers see something of a polygon, but had no ray that went there: of a polygon that
/// the horizon cuts, a few points of its whole area may all lie below. @return whether any did
static bool find_missed(alpi_polygon_gather *g, uint32_t count)
{
    bool any = false;
    for (uint32_t k = 0; k < g->polygon_count; k++) {
        uint32_t missed = 0;
        for (uint32_t i = 0; i < count; i++) {
            double factor = 0.0, weight = 0.0;
            for (int r = 0; r < R; r++) {
                factor += g->tallies[k].factor[r][i];
                weight += g->tallies[k].weight[r][i];
            }
            missed |= factor > 0.0 && weight == 0.0 ? 1u << i : 0u;
        }
        g->missed[k] = missed;
        g->wanted[k][0] = g->wanted[k][1] = missed;
        any = any || missed != 0;
    }
    return any;
}

/// Sends those a few rays to what is above their horizon. Who gets them depends on no ray.
static alp_result gather_missed(alpi_polygon_gather *g, const uint32_t *receivers, uint32_t count)
{
    const uint32_t range[2] = {g->samples, g->samples + MISSED};
    g->above = true;
    const alp_result result = gather_samples(g, receivers, count, range, 0);
    g->above = false;
    for (uint32_t k = 0; k < g->polygon_count; k++) {
        for (uint32_t i = 0; i < count; i++) {
            for (uint32_t h = 0; h < ALPI_POLYGON_HALVES && (g->missed[k] >> i & 1u) != 0; h++) {
                scale_tally(&g->tallies[k], h, i,
                            (double)g->samples / (double)(g->samples + MISSED));
            }
        }
    }
    return result;
}

void alpi_polygons_start(const alpi_direct_options *options, const alpi_receivers *receivers,
                         uint32_t samples, alpi_polygon_gather *g)
{
    g->options = options;
    g->receivers = receivers;
    g->samples = samples;
    g->loops = &ALPI_COMPILED_FOR(options->context, alpi_polygon_loops);
    g->rays = 0;
    g->above = false;
    memset(&g->wave, 0, sizeof g->wave); // lanes not in use are never set
    g->wave.each = samples / R;
    g->wave.first_each = first_samples(samples) / R;
    for (uint32_t s = 0; s < CHUNK; s++) {
        alpi_rays_clear(&g->wave.rays[s]);
    }
}

/// One half of the samples, and the other of those who need it.
static alp_result gather_fewest(alpi_polygon_gather *g, const uint32_t *receivers, uint32_t count)
{
    const uint32_t stages[3] = {0, ALPI_POLYGON_HALF, R};
    ALP_TRY(gather_samples(g, receivers, count, stages, scouts_of(g->samples, count)));
    if (choose_other_half(g, count)) {
        ALP_TRY(gather_samples(g, receivers, count, stages + 1, 0));
    }
    for (uint32_t k = 0; k < g->polygon_count; k++) {
        for (uint32_t i = 0; i < count; i++) {
            if ((g->wanted[k][1] >> i & 1u) == 0 && repeat_half(&g->tallies[k], i)) {
                g->halved[k] |= 1u << i;
            }
        }
    }
    return ALP_OK;
}

/// Some of each half, and all of those that need them.
static alp_result gather_most(alpi_polygon_gather *g, const uint32_t *receivers, uint32_t count)
{
    const uint32_t few = first_samples(g->samples);
    const uint32_t stages[3] = {0, few, g->samples};
    ALP_TRY(gather_samples(g, receivers, count, stages, scouts_of(g->samples, count)));
    if (few == g->samples) {
        return ALP_OK;
    }
    if (choose(g, count)) {
        ALP_TRY(gather_samples(g, receivers, count, stages + 1, 0));
    }
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < g->polygon_count; k++) {
            for (uint32_t h = 0; h < ALPI_POLYGON_HALVES; h++) {
                if ((g->wanted[k][h] >> i & 1u) == 0) {
                    scale_tally(&g->tallies[k], h, i, (double)g->samples / few);
                }
            }
        }
    }
    return ALP_OK;
}

alp_result alpi_polygons_gather(alpi_polygon_gather *g, const uint32_t *receivers, uint32_t count)
{
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        const uint32_t receiver = receivers[i < count ? i : count - 1];
        const uint32_t key = alpi_random_key(g->options->seed, receiver, STREAM_POLYGON);
        for (uint32_t h = 0; h < ALPI_POLYGON_HALVES; h++) {
            g->keys[h][i] = alpi_hash32(key ^ alpi_hash32(h + 1u));
        }
    }
    memset(g->tallies, 0, g->polygon_count * sizeof *g->tallies);
    if (g->by_direction) {
        memset(g->directional, 0, sizeof g->directional);
    }
    for (uint32_t k = 0; k < g->polygon_count; k++) {
        g->wanted[k][0] = g->wanted[k][1] = (1u << count) - 1u;
    }
    memset(g->scouts, 0, sizeof g->scouts);
    memset(g->halved, 0, sizeof g->halved);
    ALP_TRY(has_half_first(g->samples, count) ? gather_fewest(g, receivers, count)
                                              : gather_most(g, receivers, count));
    if (find_missed(g, count)) {
        ALP_TRY(gather_missed(g, receivers, count));
    }
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < g->polygon_count; k++) {
            const bool halved = ((g->halved[k] & ~g->missed[k]) >> i & 1u) != 0;
            finish(&g->tallies[k], g->options->filter.panes, halved, (int)i, g->sums[i][k]);
        }
    }
    return ALP_OK;
}
