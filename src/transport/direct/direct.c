// SPDX-License-Identifier: MIT
#include "base/hash.h"
#include "base/memory.h"
#include "base/tiles/tiles.h"
#include "base/warp.h"
#include "scene/lights/triangle_light.h"
#include "transport/direct/direct_gather.h"
#include "transport/direct/direct_sums.h"
#include "transport/paths/hit.h"
#include "transport/paths/panes.h"

#include <string.h>

enum { R = ALPI_DIRECT_REPLICATES };
enum { STREAM_DIRECT = 6 };
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
    alpi_direct_halves halves;
    uint64_t *rays; // [blocks] that each block sent
} direct_job;

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

static void ask_surface(alpi_direct_gather *g, const alpi_emitter_view *view, uint32_t i)
{
    const alpi_receiver_point *p = &g->points[i];
    alpi_light_sample s;
    if (!(view->share > 0.0) ||
        !alpi_emitter_sample(view, alpi_direct_draw(g, ALPI_DIRECT_USE_PICK, i).x,
                             alpi_direct_draw(g, ALPI_DIRECT_USE_SURFACE, i), &s)) {
        return;
    }
    const float cosine = vec3_dot(s.direction, p->shading_normal);
    if (cosine > 0.0f) {
        const float met = view->share > NEAR_SHARE ? cosine_density(cosine) : 0.0f;
        const alpi_direct_way way = {view->point, s.direction, alpi_direct_reach(s.distance, p),
                                     ALPI_RAYS_PAIRED};
        alpi_direct_send(
            g, &way, s.light, cosine / (s.density + met),
            (alpi_direct_arrival){.part = part_of_triangle(g->direct, s.triangle),
                                  .replicate = (uint16_t)alpi_direct_replicate(i),
                                  .way = {.normal = p->shading_normal, .cosine = cosine}});
    }
}

static void add_sky(alpi_direct_gather *g)
{
    const alpi_direct *d = g->direct;
    for (uint32_t i = 0; i < g->count && d->sky_drawn; i++) {
        const alpi_receiver_point *p = &g->points[i];
        float density;
        alpi_direct_way way = {
            .origin = alpi_direct_start(p), .reach = INFINITY, .spread = ALPI_RAYS_SCATTERED};
        way.direction =
            alpi_sky_sample(d->sky, alpi_direct_draw(g, ALPI_DIRECT_USE_SKY, i), &density);
        const float cosine = vec3_dot(way.direction, p->shading_normal);
        if (cosine > 0.0f) {
            alpi_direct_send(
                g, &way, alpi_sky_radiance(d->sky, way.direction),
                cosine / (density + cosine_density(cosine)),
                (alpi_direct_arrival){.part = (uint16_t)d->sky_part,
                                      .replicate = (uint16_t)alpi_direct_replicate(i),
                                      .way = {.normal = p->shading_normal, .cosine = cosine}});
        }
    }
    alpi_direct_flush(g, ALPI_RAYS_SCATTERED);
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
static bool is_horizon(const alpi_direct_gather *g, float cosine)
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
static void add_hit(alpi_direct_gather *g, const met_packet *m, const alpi_hits *hits, int lane,
                    vec3 left)
{
    const alpi_direct *d = g->direct;
    const vec3 direction = {m->rays.direction_x[lane], m->rays.direction_y[lane],
                            m->rays.direction_z[lane]};
    const uint32_t triangle = hits->triangle[lane];
    alpi_direct_arrival given = {.replicate = (uint16_t)alpi_direct_replicate(m->samples[lane]),
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
    alpi_direct_add(g, &given);
}

static void trace_met(alpi_direct_gather *g, met_packet *m)
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
static void aim(alpi_direct_gather *g, const alpi_emitter_view *view, uint32_t i, met_packet *m)
{
    const alpi_direct *d = g->direct;
    const vec3 n = view->normal;
    const bool near = view->share > NEAR_SHARE;
    const vec3 local = alpi_warp_cosine_cone(alpi_direct_draw(g, ALPI_DIRECT_USE_RAY, i), 1.0f);
    if (!(local.z > 0.0f) || !(near || d->sky_met)) {
        return;
    }
    vec3 t, b;
    vec3_frame(n, &t, &b);
    const vec3 along = vec3_mad(vec3_mad(vec3_scale(t, local.x), local.y, b), local.z, n);
    alpi_direct_way way = {view->point, vec3_normalize_or(along, n), INFINITY, ALPI_RAYS_SCATTERED};
    const float density = cosine_density(local.z);
    if (is_horizon(g, local.z)) {
        alpi_directional_count(&g->directional, ALPI_PI, (double)local.z);
    }
    if (!near) {
        alpi_direct_send(
            g, &way, alpi_sky_radiance(d->sky, way.direction),
            sky_factor(d, way.direction, density),
            (alpi_direct_arrival){
                .part = (uint16_t)d->sky_part,
                .replicate = (uint16_t)alpi_direct_replicate(i),
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

static void add_surfaces(alpi_direct_gather *g)
{
    const alpi_direct *d = g->direct;
    const uint32_t count = g->count;
    alpi_emitter_view views[ALPI_DIRECT_CHUNK];
    met_packet met;
    met.count = 0;
    if (d->emitters.all.count == 0 && !d->sky_met) {
        return;
    }
    alpi_emitter_choose(&d->emitters, g->points, g->receivers->extended ? count : 1, &g->choice);
    for (uint32_t i = 0; i < count; i++) {
        const alpi_receiver_point *p = &g->points[i];
        views[i] = alpi_emitter_view_from(&g->choice, alpi_direct_start(p), p->shading_normal);
        ask_surface(g, &views[i], i);
    }
    alpi_direct_flush(g, ALPI_RAYS_PAIRED);
    for (uint32_t i = 0; i < count; i++) {
        aim(g, &views[i], i, &met);
    }
    trace_met(g, &met);
    alpi_direct_flush(g, ALPI_RAYS_SCATTERED);
}

// --- receivers -----------------------------------------------------------------------------------

static void place_points(alpi_direct_gather *g, uint32_t receiver)
{
    float square[ALPI_DIRECT_CHUNK][2];
    const alpi_receivers *receivers = g->receivers;
    for (uint32_t i = 0; i < g->count; i++) {
        const vec2 u = alpi_direct_draw(g, ALPI_DIRECT_USE_PLACE, i);
        square[i][0] = u.x;
        square[i][1] = u.y;
    }
    receivers->place(receivers->user, receiver, g->count, (const float(*)[2])square, g->points);
}

static alp_result gather_receiver(alpi_direct_gather *g, uint32_t receiver, uint32_t lane,
                                  uint32_t place, const alpi_direct_halves *halves)
{
    const alpi_direct *d = g->direct;
    const uint32_t key = alpi_random_key(d->options.seed, receiver, STREAM_DIRECT);
    g->keys[0] = alpi_hash32(key ^ alpi_hash32(1u));
    g->keys[1] = alpi_hash32(key ^ alpi_hash32(2u));
    memset(g->sums, 0, d->part_count * sizeof *g->sums);
    g->directional = (alpi_directional_sums){.width = g->horizon_width};
    if (d->polygon_count > 0) {
        alpi_direct_add_polygons(&g->polygons, lane, g->sums, g->by_direction);
    }
    for (g->first = 0; g->first < d->samples && alpi_direct_has_others(d);
         g->first += ALPI_DIRECT_CHUNK) {
        const uint32_t left = d->samples - g->first;
        g->count = left < ALPI_DIRECT_CHUNK ? left : ALPI_DIRECT_CHUNK;
        place_points(g, receiver);
        alpi_direct_add_lamps(g);
        alpi_direct_add_suns(g);
        add_surfaces(g);
        add_sky(g);
        if (d->sky_spots) {
            alpi_direct_add_spots(g);
        }
        if (!alpi_loop_goes_on(d->options.context)) { // ten thousand samples may take seconds
            return ALP_ERROR_CANCELLED;
        }
    }
    if (d->sky_spots) {
        alpi_direct_finish_spots(g);
    }
    alpi_direct_put(d, (const double(*)[R][3])g->sums, receiver,
                    d->polygon_count > 0 ? &g->polygons : NULL, lane,
                    halves->sums[place / ALPI_PACKET], g->output);
    if (g->output->directional != NULL) {
        alpi_directional_finish(&g->directional, 1.0 / d->samples,
                                &g->output->directional[receiver]);
    }
    return ALP_OK;
}

/// Up to eight receivers, whose polygons are asked side by side.
/// @param place of the first in the list
static alp_result gather_block(alpi_direct_gather *g, const uint32_t *receivers, uint32_t count,
                               uint32_t place, const alpi_direct_halves *halves)
{
    if (g->direct->polygon_count > 0) {
        ALP_TRY(alpi_polygons_gather(&g->polygons, receivers, count));
    }
    for (uint32_t i = 0; i < count; i++) {
        ALP_TRY(gather_receiver(g, receivers[i], i, place + i, halves));
    }
    return ALP_OK;
}

static void start_gather(alpi_direct_gather *g, direct_job *job)
{
    const alpi_direct *d = job->direct;
    g->direct = d;
    g->receivers = job->receivers;
    g->output = job->output;
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
    g->by_direction = job->output->directional != NULL ? &g->directional : NULL;
    g->spots.choice.looks = NULL;
}

/// By blocks: who is beside whom may not depend on how a host's scheduler cuts the list.
static alp_result gather_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    direct_job *job = user;
    alpi_direct_gather g;
    (void)worker;
    start_gather(&g, job);
    alp_result result = ALP_OK;
    for (uint32_t b = begin; b < end && result == ALP_OK; b++) {
        uint32_t block[ALPI_PACKET], count = 0;
        for (uint32_t i = b * ALPI_PACKET; count < ALPI_PACKET && i < job->count; i++) {
            block[count++] = job->list != NULL ? job->list[i] : i;
        }
        const uint64_t before = g.rays + g.polygons.rays;
        result = gather_block(&g, block, count, b * ALPI_PACKET, &job->halves);
        job->rays[b] = g.rays + g.polygons.rays - before;
    }
    return result;
}

/// A sample's time in that of a plain shadow ray, as rounds of bakes showed: .04 µs of two cores
/// for the quad of the Cornell box, .12 to .19 for the skies of living_room and atrium, .32 for the
/// 528 triangles of windows. Beyond a list draws go down a hierarchy: taken to be as long as the
/// longest.
static double draw_time(const alpi_direct *direct)
{
    static const double SKY = 2.0, EACH_LISTED = 0.008;
    const uint32_t emitters = direct->emitters.all.count;
    const uint32_t listed = emitters < ALPI_DIRECT_LISTED ? emitters : ALPI_DIRECT_LISTED;
    const double surface = emitters > ALPI_DIRECT_FEW ? 1.0 + EACH_LISTED * listed : 1.0;
    return direct->sky_drawn || direct->sky_spots ? fmax(SKY, surface) : surface;
}

// --- the loop ------------------------------------------------------------------------------------

/// Groups of an output.
static uint32_t count_groups(const alpi_direct *direct, const alpi_direct_output *output)
{
    uint32_t count = 0;
    for (uint32_t p = 0; p < direct->part_count && output->groups != NULL; p++) {
        count = output->part_groups[p] >= count ? output->part_groups[p] + 1 : count;
    }
    return count;
}

/// The arrays that blocks write.
/// @param outputs [5 + groups] out   @return how many
static uint32_t list_outputs(const direct_job *job, uint32_t groups, alpi_tile_output *outputs)
{
    const alpi_direct_output *o = job->output;
    const uint32_t blocks = job->count / ALPI_PACKET + (job->count % ALPI_PACKET != 0);
    const alpi_tile_output each = {.list = job->list, .count = job->count, .each = ALPI_PACKET};
    uint32_t n = 0;
    outputs[n] = each;
    outputs[n].data = o->values;
    outputs[n++].size = sizeof *o->values;
    outputs[n] = each;
    outputs[n].data = o->parts;
    outputs[n++].size = job->direct->part_count * sizeof *o->parts;
    outputs[n] = each;
    outputs[n].data = o->directional;
    outputs[n++].size = sizeof *o->directional;
    for (uint32_t g = 0; g < groups; g++) {
        outputs[n] = each;
        outputs[n].data = o->groups[g];
        outputs[n++].size = sizeof *o->groups[g];
    }
    outputs[n++] = (alpi_tile_output){
        .data = job->halves.sums, .size = sizeof *job->halves.sums, .count = blocks};
    outputs[n++] =
        (alpi_tile_output){.data = job->rays, .size = sizeof *job->rays, .count = blocks};
    return n;
}

static alp_result run_blocks(direct_job *job, uint32_t blocks, const alpi_task_progress *progress)
{
    alp_context *context = job->direct->options.context;
    const uint32_t groups = count_groups(job->direct, job->output);
    alpi_tile_output *outputs = ALPI_NEW(context, alpi_tile_output, 5 + groups);
    if (outputs == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alpi_direct *d = job->direct;
    const uint64_t parts[] = {d->options.seed, d->samples, d->part_count, d->polygon_count};
    const alpi_tile_loop loop = {
        .name = "direct",
        .key = alpi_hash_bytes(ALPI_HASH_START, parts, sizeof parts),
        .count = blocks,
        .grain = (uint32_t)fmax(2048.0 / progress->units_per_item, 1.0), // about one millisecond
        .body = gather_range,
        .user = job,
        .progress = progress,
        .outputs = outputs,
        .output_count = list_outputs(job, groups, outputs)};
    const alp_result result = alpi_tile_loop_run(context, &loop);
    alpi_release(context, outputs);
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
    alp_result result = alpi_direct_halves_create(direct, job.count, &job.halves);
    job.rays = ALPI_NEW(direct->options.context, uint64_t, blocks);
    result = result == ALP_OK && job.rays == NULL ? ALP_ERROR_OUT_OF_MEMORY : result;
    result = result == ALP_OK ? run_blocks(&job, blocks, &told) : result;
    if (result == ALP_OK) {
        result = alpi_direct_scale_variances(direct, list, job.count, &job.halves, output);
    }
    alpi_direct_halves_release(direct, &job.halves);
    for (uint32_t b = 0; b < blocks && job.rays != NULL; b++) {
        output->rays += job.rays[b];
    }
    alpi_release(direct->options.context, job.rays);
    output->draw = draw_time(direct);
    return result;
}
