// SPDX-License-Identifier: MIT
#include "base/random.h"
#include "base/warp.h"
#include "scene/triangle_light.h"
#include "transport/direct_sums.h"
#include "transport/hit.h"
#include "transport/panes.h"

#include <stdatomic.h>
#include <string.h>

// Uses of random numbers at one sample; each sun has its own.
enum { USE_PLACE, USE_PICK, USE_RAY, USE_SURFACE, USE_SKY, USE_SUN };
enum { STREAM_DIRECT = 6 };
enum {
    R = ALPI_DIRECT_REPLICATES,
    EVERY = R,  // a replicate: what holds for all of them
    CHUNK = 64, // samples whose points are placed at once; a multiple of R
    RAY_LIMIT = ALPI_TRACE_BATCH * ALPI_PACKET
};
_Static_assert(CHUNK % R == 0 && (R & (R - 1)) == 0, "replicates take turns, and halves are exact");
/// Emitters that fill more than this share of the hemisphere are met by cosine-distributed rays
/// too. Below, such rays cost more than what they find is worth.
static const double NEAR_SHARE = 1.0 / 16.0;

/// What one call has in common.
typedef struct direct_job {
    const alpi_direct *direct;
    const alpi_receivers *receivers;
    const uint32_t *list;
    uint32_t count; // of the list
    alpi_direct_output *output;
    _Atomic uint64_t rays;
} direct_job;

/// A ray under way: what it brings if nothing stops it.
typedef struct arrival {
    float light[3];
    uint16_t part, replicate;
    alpi_directional_way way; // its direction is that of the ray that is sent
} arrival;

/// The samples of one receiver, by one worker.
typedef struct gather {
    direct_job *job;
    const alpi_direct *direct;
    uint32_t keys[R];
    alpi_receiver_point points[CHUNK];
    uint32_t first, count; // samples of the chunk
    uint64_t rays;
    double sums[ALPI_DIRECT_PART_LIMIT][R][3];
    double horizon_width; // 0: light is not wanted by its direction
    alpi_directional_sums directional;
    uint32_t queued;
    arrival givens[RAY_LIMIT];
    alpi_rays packets[ALPI_TRACE_BATCH];
    alpi_polygon_gather polygons;
    alpi_emitter_choice choice;
} gather;

/// Sample i of the chunk, for one use; the replicates take turns.
static vec2 draw(const gather *g, uint32_t use, uint32_t i)
{
    const uint32_t sample = g->first + i;
    return alpi_sample_2d(alpi_hash32(g->keys[sample % R] ^ alpi_hash32(use + 1u)), sample / R);
}

static uint32_t replicate_of(uint32_t i)
{
    return i % R; // chunks begin with the first
}

static vec3 ray_start(const alpi_receiver_point *p)
{
    return vec3_mad(p->position, p->offset, p->geometric_normal);
}

// --- rays ----------------------------------------------------------------------------------------

static void add(gather *g, const arrival *given)
{
    const uint32_t each = g->direct->samples / R;
    if (g->horizon_width > 0.0 && given->way.cosine > 0.0f) {
        const double times = given->replicate == EVERY ? (double)g->direct->samples : 1.0;
        const double light[3] = {times * (double)given->light[0], times * (double)given->light[1],
                                 times * (double)given->light[2]};
        alpi_directional_add(&g->directional, light, &given->way);
    }
    for (int k = 0; k < 3; k++) {
        if (given->replicate != EVERY) {
            g->sums[given->part][given->replicate][k] += (double)given->light[k];
            continue;
        }
        for (int r = 0; r < R; r++) {
            g->sums[given->part][r][k] += (double)given->light[k] * each;
        }
    }
}

/// Adds what the free rays of a packet bring, through panes.
static void add_free(gather *g, uint32_t first, uint32_t count)
{
    const alpi_direct_options *o = &g->direct->options;
    alpi_rays *rays = &g->packets[first / ALPI_PACKET];
    uint32_t free = 0;
    vec3 left[ALPI_PACKET] = {{0.0f, 0.0f, 0.0f}};
    for (uint32_t i = 0; i < count; i++) {
        free |= rays->maximum[i] >= 0.0f ? 1u << i : 0u;
    }
    if (o->filter.panes) {
        alpi_panes_dim(o->scene, o->tracer, o->filter, free, rays, left);
    }
    for (uint32_t i = 0; i < count; i++) {
        arrival *given = &g->givens[first + i];
        if (o->filter.panes) {
            given->light[0] *= left[i].x;
            given->light[1] *= left[i].y;
            given->light[2] *= left[i].z;
        }
        if ((free >> i & 1u) != 0) {
            add(g, given);
        }
    }
}

/// Traces what is queued and adds what arrives, in the order of the queue.
static void flush(gather *g, alpi_rays_spread spread)
{
    const alpi_direct_options *o = &g->direct->options;
    const uint32_t full = g->queued / ALPI_PACKET, rest = g->queued % ALPI_PACKET;
    if (full > 0) {
        alpi_trace_occluded(o->tracer, g->packets, full, (1u << ALPI_PACKET) - 1u, o->filter,
                            spread);
    }
    if (rest > 0) {
        alpi_trace_occluded(o->tracer, &g->packets[full], 1, (1u << rest) - 1u, o->filter, spread);
    }
    for (uint32_t first = 0; first < g->queued; first += ALPI_PACKET) {
        add_free(g, first, g->queued - first < ALPI_PACKET ? g->queued - first : ALPI_PACKET);
    }
    g->rays += g->queued;
    g->queued = 0;
}

/// Where a ray goes.
typedef struct ray_way {
    vec3 origin, direction;
    float reach; // metres
    alpi_rays_spread spread;
} ray_way;

/// Light × factor arrives unless something is in between.
static void send(gather *g, const ray_way *way, vec3 light, float factor, arrival given)
{
    given.light[0] = light.x * factor;
    given.light[1] = light.y * factor;
    given.light[2] = light.z * factor;
    given.way.direction = way->direction;
    if (!isfinite(factor) || !(given.light[0] + given.light[1] + given.light[2] > 0.0f)) {
        return;
    }
    if (!(way->reach > 0.0f)) { // nothing fits in between
        add(g, &given);
        return;
    }
    if (g->queued == RAY_LIMIT) {
        flush(g, way->spread);
    }
    const uint32_t lane = g->queued % ALPI_PACKET;
    alpi_rays *packet = &g->packets[g->queued / ALPI_PACKET];
    if (lane == 0) {
        alpi_rays_clear(packet);
    }
    alpi_rays_set(packet, (int)lane, way->origin, way->direction, way->reach);
    g->givens[g->queued++] = given;
}

/// Short of what gives light, which would stop the ray itself.
static float reach_to(float distance, const alpi_receiver_point *p)
{
    return distance * (1.0f - 1e-5f) - 2.0f * p->offset;
}

// --- lamps and suns ------------------------------------------------------------------------------

/// Asks a lamp from sample i. @param factor 1 / the probability that it is asked
static void ask_lamp(gather *g, uint32_t light, uint32_t i, uint32_t replicate, float factor)
{
    const alpi_receiver_point *p = &g->points[i];
    const vec3 origin = ray_start(p);
    alpi_punctual_light at;
    if (!alpi_punctual_at(&g->direct->lights[light], origin, &at)) {
        return;
    }
    const float cosine = vec3_dot(at.direction, p->shading_normal);
    if (cosine > 0.0f) {
        const ray_way way = {origin, at.direction, reach_to(at.distance, p), false};
        send(g, &way, at.light, cosine * factor,
             (arrival){.part = (uint16_t)g->direct->light_parts[light],
                       .replicate = (uint16_t)replicate,
                       .way = {.normal = p->shading_normal, .cosine = cosine}});
    }
}

static void add_lamps(gather *g)
{
    const alpi_direct *d = g->direct;
    const bool extended = g->job->receivers->extended;
    for (uint32_t k = 0; k < d->lamp_count && !d->lamps_drawn; k++) {
        for (uint32_t i = 0; i < g->count && extended; i++) {
            ask_lamp(g, d->lamps[k], i, replicate_of(i), 1.0f);
        }
        if (!extended && g->first == 0) { // every sample would be the same
            ask_lamp(g, d->lamps[k], 0, EVERY, 1.0f);
        }
    }
    for (uint32_t i = 0; i < g->count && d->lamps_drawn; i++) {
        const alpi_receiver_point *p = &g->points[i];
        uint32_t light = 0;
        const double part = alpi_punctual_sample(&d->drawn, ray_start(p), p->shading_normal,
                                                 (double)draw(g, USE_PICK, i).y, &light);
        if (part > 0.0) {
            ask_lamp(g, light, i, replicate_of(i), (float)(1.0 / part));
        }
    }
    flush(g, false);
}

/// Asks a point of a sun's disk. @param factor 1 / the probability that the sun is asked
static void ask_sun(gather *g, const alpi_sun *sun, uint32_t i, uint32_t use, float factor)
{
    const alpi_receiver_point *p = &g->points[i];
    const ray_way way = {ray_start(p), alpi_sun_sample(sun, draw(g, use, i)), INFINITY, false};
    const float cosine = vec3_dot(way.direction, p->shading_normal);
    if (cosine > 0.0f) {
        send(g, &way, sun->radiance, cosine * factor / (float)alpi_sun_density(sun),
             (arrival){.part = (uint16_t)g->direct->light_parts[sun->light],
                       .replicate = (uint16_t)replicate_of(i),
                       .way = {.normal = p->shading_normal, .cosine = cosine}});
    }
}

/// One of many, in proportion to what it may give. @return its probability, 0: none
static double pick_sun(const alpi_direct *d, vec3 normal, double pick, const alpi_sun **picked)
{
    double sum = 0.0, chosen = 0.0;
    for (uint32_t k = 0; k < d->sun_count; k++) {
        sum += alpi_sun_importance(&d->suns[k], normal);
    }
    double rest = pick * sum;
    for (uint32_t k = 0; k < d->sun_count && rest >= 0.0; k++) {
        const double one = alpi_sun_importance(&d->suns[k], normal);
        if (one > 0.0) {
            *picked = &d->suns[k];
            chosen = one / sum;
        }
        rest -= one;
    }
    return chosen;
}

static void add_suns(gather *g)
{
    const alpi_direct *d = g->direct;
    for (uint32_t k = 0; k < d->sun_count && !d->suns_drawn; k++) {
        for (uint32_t i = 0; i < g->count; i++) {
            ask_sun(g, &d->suns[k], i, USE_SUN + k, 1.0f);
        }
    }
    for (uint32_t i = 0; i < g->count && d->suns_drawn; i++) {
        const alpi_sun *sun = NULL;
        const double pick = (double)draw(g, USE_SUN + 1, i).x;
        const double part = pick_sun(d, g->points[i].shading_normal, pick, &sun);
        if (part > 0.0 && sun != NULL) {
            ask_sun(g, sun, i, USE_SUN, (float)(1.0 / part));
        }
    }
    flush(g, false);
}

// --- surfaces and sky that are asked -------------------------------------------------------------

static uint16_t part_of_triangle(const alpi_direct *d, uint32_t triangle)
{
    const alp_scene *scene = d->options.scene;
    const uint32_t surface = scene->triangle_surface[triangle];
    return (uint16_t)d->material_parts[scene->surfaces[surface].material];
}

/// Density of the cosine-distributed rays in a direction.
static float cosine_density(float cosine)
{
    return cosine * (float)(1.0 / ALPI_PI);
}

static void ask_surface(gather *g, const alpi_emitter_view *view, uint32_t i)
{
    const alpi_receiver_point *p = &g->points[i];
    alpi_light_sample s;
    if (!(view->share > 0.0) ||
        !alpi_emitter_sample(view, draw(g, USE_PICK, i).x, draw(g, USE_SURFACE, i), &s)) {
        return;
    }
    const float cosine = vec3_dot(s.direction, p->shading_normal);
    if (cosine > 0.0f) {
        const float met = view->share > NEAR_SHARE ? cosine_density(cosine) : 0.0f;
        const ray_way way = {view->point, s.direction, reach_to(s.distance, p), false};
        send(g, &way, s.light, cosine / (s.density + met),
             (arrival){.part = part_of_triangle(g->direct, s.triangle),
                       .replicate = (uint16_t)replicate_of(i),
                       .way = {.normal = p->shading_normal, .cosine = cosine}});
    }
}

static void add_sky(gather *g)
{
    const alpi_direct *d = g->direct;
    for (uint32_t i = 0; i < g->count && d->sky_drawn; i++) {
        const alpi_receiver_point *p = &g->points[i];
        vec3 radiance;
        float density;
        ray_way way = {.origin = ray_start(p), .reach = INFINITY, .spread = ALPI_RAYS_SCATTERED};
        way.direction = alpi_sky_draw(d->sky, draw(g, USE_SKY, i), &radiance, &density);
        const float cosine = vec3_dot(way.direction, p->shading_normal);
        if (cosine > 0.0f) {
            const float met = d->sky_met ? cosine_density(cosine) : 0.0f;
            send(g, &way, radiance, cosine / (density + met),
                 (arrival){.part = (uint16_t)d->sky_part,
                           .replicate = (uint16_t)replicate_of(i),
                           .way = {.normal = p->shading_normal, .cosine = cosine}});
        }
    }
    flush(g, true);
}

// --- surfaces and sky that are met ---------------------------------------------------------------

/// π × the share of a cosine-distributed ray in what it meets.
static float met_factor(float density, double asked)
{
    return (float)(ALPI_PI * (double)density / ((double)density + asked));
}

static float sky_factor(const alpi_direct *d, vec3 direction, float density)
{
    return met_factor(density, d->sky_drawn ? (double)alpi_sky_density(d->sky, direction) : 0.0);
}

/// Of rays that nothing but an even sky counts for: what is asked too has no 1 / cosθ.
static bool is_horizon(const gather *g, float cosine)
{
    return g->direct->sky_met && !g->direct->sky_drawn && cosine < (float)g->horizon_width;
}

/// Eight cosine-distributed rays that may meet emitters.
typedef struct met_packet {
    alpi_rays rays;
    uint32_t count;
    const alpi_emitter_view *views[ALPI_PACKET];
    float densities[ALPI_PACKET], cosines[ALPI_PACKET];
    uint32_t samples[ALPI_PACKET];
} met_packet;

/// @param left of the light, after panes
static void add_hit(gather *g, const met_packet *m, const alpi_hits *hits, int lane, vec3 left)
{
    const alpi_direct *d = g->direct;
    const vec3 direction = {m->rays.direction_x[lane], m->rays.direction_y[lane],
                            m->rays.direction_z[lane]};
    const uint32_t triangle = hits->triangle[lane];
    arrival given = {.replicate = (uint16_t)replicate_of(m->samples[lane]),
                     .way = {.direction = direction,
                             .normal = m->views[lane]->normal,
                             .cosine = m->cosines[lane]}};
    vec3 light = {0.0f, 0.0f, 0.0f};
    float factor = 0.0f;
    if (triangle != ALPI_NONE) {
        if (alpi_emitters_find(&d->emitters.all, triangle) == ALPI_NONE) {
            return;
        }
        given.part = part_of_triangle(d, triangle);
        light = alpi_surface_emission(d->options.scene, triangle, hits->b1[lane], hits->b2[lane],
                                      vec3_scale(direction, -1.0f));
        factor = met_factor(m->densities[lane],
                            alpi_emitter_density(m->views[lane], direction, triangle));
    } else if (d->sky_met) {
        given.part = (uint16_t)d->sky_part;
        light = alpi_sky_radiance(d->sky, direction);
        factor = sky_factor(d, direction, m->densities[lane]);
        given.way.horizon = is_horizon(g, m->cosines[lane]);
    }
    given.light[0] = light.x * factor * left.x;
    given.light[1] = light.y * factor * left.y;
    given.light[2] = light.z * factor * left.z;
    add(g, &given);
}

static void trace_met(gather *g, met_packet *m)
{
    const alpi_direct_options *o = &g->direct->options;
    alpi_hits hits;
    if (m->count == 0) {
        return;
    }
    vec3 left[ALPI_PACKET] = {{0.0f, 0.0f, 0.0f}};
    uint32_t active = (1u << m->count) - 1u;
    for (int i = 0; i < ALPI_PACKET; i++) {
        left[i] = (vec3){1.0f, 1.0f, 1.0f};
    }
    for (int passed = 0; active != 0 && passed < ALPI_PANE_LIMIT; passed++) {
        alpi_trace_nearest(o->tracer, &m->rays, active, o->filter, &hits);
        for (int lane = 0; lane < ALPI_PACKET; lane++) {
            if ((active >> lane & 1u) != 0) {
                add_hit(g, m, &hits, lane, left[lane]);
            }
        }
        active = o->filter.panes ? alpi_panes_go_on(o->scene, &hits, active, &m->rays, left) : 0;
    }
    g->rays += m->count;
    m->count = 0;
}

/// A cosine-distributed ray: beside near emitters what it meets counts, else the sky alone.
static void aim(gather *g, const alpi_emitter_view *view, uint32_t i, met_packet *m)
{
    const alpi_direct *d = g->direct;
    const vec3 n = view->normal;
    const bool near = view->share > NEAR_SHARE;
    const vec3 local = alpi_warp_cosine_cone(draw(g, USE_RAY, i), 1.0f);
    if (!(local.z > 0.0f) || !(near || d->sky_met)) {
        return;
    }
    vec3 t, b;
    vec3_frame(n, &t, &b);
    const vec3 along = vec3_mad(vec3_mad(vec3_scale(t, local.x), local.y, b), local.z, n);
    ray_way way = {view->point, vec3_normalize_or(along, n), INFINITY, true};
    const float density = cosine_density(local.z);
    if (is_horizon(g, local.z)) {
        alpi_directional_count(&g->directional, ALPI_PI, (double)local.z);
    }
    if (!near) {
        send(g, &way, alpi_sky_radiance(d->sky, way.direction),
             sky_factor(d, way.direction, density),
             (arrival){.part = (uint16_t)d->sky_part,
                       .replicate = (uint16_t)replicate_of(i),
                       .way = {.normal = n, .cosine = local.z, .horizon = is_horizon(g, local.z)}});
        return;
    }
    if (m->count == 0) {
        alpi_rays_clear(&m->rays);
    }
    alpi_rays_set(&m->rays, (int)m->count, way.origin, way.direction, way.reach);
    m->views[m->count] = view;
    m->densities[m->count] = density;
    m->cosines[m->count] = local.z;
    m->samples[m->count++] = i;
    if (m->count == ALPI_PACKET) {
        trace_met(g, m);
    }
}

static void add_surfaces(gather *g)
{
    const alpi_direct *d = g->direct;
    const uint32_t count = g->count;
    alpi_emitter_view views[CHUNK];
    met_packet met;
    met.count = 0;
    if (d->emitters.all.count == 0 && !d->sky_met) {
        return;
    }
    alpi_emitter_choose(&d->emitters, g->points, g->job->receivers->extended ? count : 1,
                        &g->choice);
    for (uint32_t i = 0; i < count; i++) {
        const alpi_receiver_point *p = &g->points[i];
        views[i] = alpi_emitter_view_from(&g->choice, ray_start(p), p->shading_normal);
        ask_surface(g, &views[i], i);
    }
    flush(g, false);
    for (uint32_t i = 0; i < count; i++) {
        aim(g, &views[i], i, &met);
    }
    trace_met(g, &met);
    flush(g, true);
}

// --- receivers -----------------------------------------------------------------------------------

static void place_points(gather *g, uint32_t receiver)
{
    float square[CHUNK][2];
    const alpi_receivers *receivers = g->job->receivers;
    for (uint32_t i = 0; i < g->count; i++) {
        const vec2 u = draw(g, USE_PLACE, i);
        square[i][0] = u.x;
        square[i][1] = u.y;
    }
    receivers->place(receivers->user, receiver, g->count, (const float(*)[2])square, g->points);
}

static alp_result gather_receiver(gather *g, uint32_t receiver, uint32_t lane)
{
    const alpi_direct *d = g->direct;
    const uint32_t key = alpi_random_key(d->options.seed, receiver, STREAM_DIRECT);
    for (uint32_t r = 0; r < R; r++) {
        g->keys[r] = alpi_hash32(key ^ alpi_hash32(r + 1u));
    }
    memset(g->sums, 0, d->part_count * sizeof *g->sums);
    g->directional = (alpi_directional_sums){.width = g->horizon_width};
    if (d->polygon_count > 0) {
        alpi_direct_add_polygons(&g->polygons, lane, g->sums,
                                 g->horizon_width > 0.0 ? &g->directional : NULL);
    }
    for (g->first = 0; g->first < d->samples && alpi_direct_has_others(d); g->first += CHUNK) {
        const uint32_t left = d->samples - g->first;
        g->count = left < CHUNK ? left : CHUNK;
        place_points(g, receiver);
        add_lamps(g);
        add_suns(g);
        add_surfaces(g);
        add_sky(g);
        if (!alpi_loop_goes_on(d->options.context)) { // ten thousand samples may take seconds
            return ALP_ERROR_CANCELLED;
        }
    }
    alpi_direct_put(d, (const double(*)[R][3])g->sums, receiver, g->job->output);
    if (g->job->output->directional != NULL) {
        alpi_directional_finish(&g->directional, 1.0 / d->samples,
                                &g->job->output->directional[receiver]);
    }
    return ALP_OK;
}

/// Up to eight receivers, whose polygons are asked side by side.
static alp_result gather_block(gather *g, const uint32_t *receivers, uint32_t count)
{
    if (g->direct->polygon_count > 0) {
        ALP_TRY(alpi_polygons_gather(&g->polygons, receivers, count));
    }
    for (uint32_t i = 0; i < count; i++) {
        ALP_TRY(gather_receiver(g, receivers[i], i));
    }
    return ALP_OK;
}

static void start_gather(gather *g, direct_job *job)
{
    const alpi_direct *d = job->direct;
    g->job = job;
    g->direct = d;
    g->rays = 0;
    g->queued = 0;
    if (d->polygon_count > 0) {
        alpi_polygons_start(&d->options, job->receivers, d->samples, &g->polygons);
        g->polygons.polygons = d->polygons;
        g->polygons.polygon_count = d->polygon_count;
        g->polygons.by_direction = job->output->directional != NULL;
    }
    g->polygons.rays = 0;
    g->horizon_width = job->output->directional != NULL ? alpi_horizon_width(d->samples) : 0.0;
}

/// By blocks: who is beside whom may not depend on how a host's scheduler cuts the list.
static alp_result gather_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    direct_job *job = user;
    gather g;
    (void)worker;
    start_gather(&g, job);
    alp_result result = ALP_OK;
    for (uint32_t b = begin; b < end && result == ALP_OK; b++) {
        uint32_t block[ALPI_PACKET], count = 0;
        for (uint32_t i = b * ALPI_PACKET; count < ALPI_PACKET && i < job->count; i++) {
            block[count++] = job->list != NULL ? job->list[i] : i;
        }
        result = gather_block(&g, block, count);
    }
    atomic_fetch_add_explicit(&job->rays, g.rays + g.polygons.rays, memory_order_relaxed);
    return result;
}

alp_result alpi_direct_irradiance(const alpi_direct *direct, const alpi_receivers *receivers,
                                  const uint32_t *list, uint32_t list_count,
                                  const alpi_task_progress *progress, alpi_direct_output *output)
{
    direct_job job = {.direct = direct, .receivers = receivers, .list = list, .output = output};
    job.count = list != NULL ? list_count : receivers->count;
    const uint32_t blocks = job.count / ALPI_PACKET + (job.count % ALPI_PACKET != 0);
    alpi_task_progress told = progress != NULL ? *progress : (alpi_task_progress){0};
    told.units_per_item = fmax(alpi_direct_most_rays(direct, receivers->extended, job.count), 1.0);
    const uint32_t grain = (uint32_t)fmax(8192.0 / told.units_per_item, 1.0); // some milliseconds
    const alp_result result =
        alpi_parallel_for(direct->options.context, blocks, grain, gather_range, &job, &told);
    output->rays += atomic_load(&job.rays);
    return result;
}
