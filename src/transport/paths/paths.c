// SPDX-License-Identifier: MIT
#include "transport/paths/paths.h"

#include "base/context.h"
#include "transport/paths/hit.h"
#include "transport/paths/panes.h"

#include <math.h>
#include <string.h>

// Paths that bring less than this share of what they could at first play roulette. Measured on the
// Cornell box: of .1 and .4 the first takes 1.35 times as long for .95 of the error; 1 takes .69 of
// the time of .4 for 1.4 times the error. In a furnace roulette is all the noise there is.
static const float ROULETTE_SHARE = 0.25f;

static vec3 at(const alpi_wave_vec *v, uint32_t i)
{
    return (vec3){v->x[i], v->y[i], v->z[i]};
}

static void put(alpi_wave_vec *v, uint32_t i, vec3 a)
{
    v->x[i] = a.x;
    v->y[i] = a.y;
    v->z[i] = a.z;
}

static bool is_lit(vec3 v)
{
    return v.x > 0.0f || v.y > 0.0f || v.z > 0.0f;
}

void alpi_paths_place(alpi_path_wave *w, uint32_t i, const alpi_receiver_point *p)
{
    put(&w->origin, i, vec3_mad(p->position, p->offset, p->geometric_normal));
    put(&w->normal, i, p->shading_normal);
    put(&w->side, i, p->geometric_normal);
    w->offset[i] = p->offset;
}

void alpi_paths_draw_places(const alpi_reference *r, alpi_path_wave *w)
{
    ALPI_COMPILED_FOR(r->context, alpi_wave_loops).draw(w, ALPI_USE_PLACE, 0);
}

// --- light that is asked for ---------------------------------------------------------------------

/// The light that reaches vertices of a depth directly.
static const alpi_lighting *lighting_at(const alpi_reference *r, int32_t depth)
{
    return depth == 0 && r->direct != NULL ? r->direct : r->lighting;
}

/// Only the first vertex is worth the care: what is noise further on is where the path went.
static bool ask(const alpi_reference *r, const alpi_path_wave *w, uint32_t i, alpi_light_sample *s)
{
    const vec3 origin = at(&w->origin, i), normal = at(&w->normal, i);
    const vec2 u = {w->u[i], w->v[i]};
    return w->depth[i] <= 0
               ? alpi_lighting_sample(lighting_at(r, w->depth[i]), origin, normal, w->pick[i], u, s)
               : alpi_lighting_sample_by_area(r->lighting, origin, normal, w->pick[i], u, s);
}

/// Whether a direction goes into the surface that a path has met: the hemisphere of a smooth normal
/// reaches below its facet. That facet is what is met there, and a plane that glows does not light
/// itself. Where a path begins, its point may lie above the facet.
static bool goes_inside(const alpi_path_wave *w, uint32_t i, vec3 direction)
{
    return w->depth[i] > 0 && vec3_dot(direction, at(&w->side, i)) <= 0.0f;
}

/// What a light sample brings through a path if nothing is in between.
static bool weigh_sample(const alpi_path_wave *w, uint32_t i, const alpi_light_sample *s,
                         vec3 *given)
{
    const float cosine = vec3_dot(s->direction, at(&w->normal, i));
    const bool hit_by_chance = s->kind != ALPI_LIGHT_CLASS_PUNCTUAL;
    const float other = hit_by_chance ? cosine * (float)(1.0 / ALPI_PI) : 0.0f;
    const float factor = cosine / (s->density + other); // balance heuristic × 1 / density
    *given =
        (vec3){w->throughput.x[i] * s->light.x * factor, w->throughput.y[i] * s->light.y * factor,
               w->throughput.z[i] * s->light.z * factor};
    return cosine > 0.0f && isfinite(factor) && !goes_inside(w, i, s->direction);
}

static void bring(alpi_path_wave *w, uint32_t path, vec3 light)
{
    const uint32_t slot = w->slot[path];
    alpi_wave_vec *sum = w->depth[path] <= 0 ? &w->own : &w->tail;
    sum->x[slot] += light.x;
    sum->y[slot] += light.y;
    sum->z[slot] += light.z;
}

/// Hands out what the free rays of a packet bring.
static void bring_free(const alpi_reference *r, alpi_path_wave *w, uint32_t first, uint32_t count)
{
    alpi_rays *rays = &w->rays[first / ALPI_PACKET];
    uint32_t free = 0;
    vec3 left[ALPI_PACKET] = {{0.0f, 0.0f, 0.0f}};
    for (uint32_t i = 0; i < count; i++) {
        free |= rays->maximum[i] >= 0.0f ? 1u << i : 0u;
    }
    if (r->filter.panes) {
        alpi_panes_dim(r->scene, r->tracer, r->filter, free, rays, left);
    }
    for (uint32_t i = 0; i < count; i++) {
        vec3 given = at(&w->given, first + i);
        if (r->filter.panes) {
            given = (vec3){given.x * left[i].x, given.y * left[i].y, given.z * left[i].z};
        }
        if ((free >> i & 1u) != 0) {
            bring(w, w->asker[first + i], given);
        }
    }
}

/// Traces `count` shadow rays and hands out what the free ones bring.
static void trace_shadow_rays(const alpi_reference *r, alpi_path_wave *w, uint32_t count)
{
    const uint32_t whole = count / ALPI_PACKET, rest = count % ALPI_PACKET;
    if (whole > 0) {
        alpi_trace_occluded(r->tracer, w->rays, whole, 0xffu, r->filter, ALPI_RAYS_SCATTERED);
    }
    if (rest > 0) {
        alpi_trace_occluded(r->tracer, w->rays + whole, 1, (1u << rest) - 1u, r->filter,
                            ALPI_RAYS_NEAR);
    }
    for (uint32_t first = 0; first < count; first += ALPI_PACKET) {
        bring_free(r, w, first, count - first < ALPI_PACKET ? count - first : ALPI_PACKET);
    }
}

/// Asks one light from each vertex.
static void add_next_event(const alpi_reference *r, alpi_path_wave *w)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < w->count; i++) {
        alpi_light_sample s;
        vec3 given;
        if (!ask(r, w, i, &s) || !weigh_sample(w, i, &s, &given)) {
            continue;
        }
        // Short of the emitter, which would stop the ray itself.
        const float reach = s.distance * (1.0f - 1e-5f) - 2.0f * w->offset[i];
        if (!(reach > 0.0f)) { // nothing fits in between
            bring(w, i, given);
            continue;
        }
        alpi_rays_set(&w->rays[count / ALPI_PACKET], (int)(count % ALPI_PACKET), at(&w->origin, i),
                      s.direction, reach);
        put(&w->given, count, given);
        w->asker[count++] = i;
    }
    trace_shadow_rays(r, w, count);
}

// --- light that is met ---------------------------------------------------------------------------

/// Adds radiance that a ray met, π times for its density cosθ / π, with its share of what the light
/// sampler would have found too.
/// @param triangle that was met at a distance from the vertex; ALPI_NONE: the ray left the scene
static void add_met(const alpi_reference *r, alpi_path_wave *w, uint32_t i, vec3 radiance,
                    uint32_t triangle, float distance)
{
    if (!is_lit(radiance) || goes_inside(w, i, at(&w->direction, i))) {
        return;
    }
    float weight = (float)ALPI_PI;
    if (w->density[i] >= 0.0f) {
        const vec3 origin = at(&w->origin, i), normal = at(&w->normal, i);
        const vec3 direction = at(&w->direction, i);
        const float asked = triangle != ALPI_NONE && w->depth[i] > 0
                                ? alpi_lighting_density_by_area(r->lighting, origin, normal,
                                                                direction, triangle, distance)
                                : alpi_lighting_density(lighting_at(r, w->depth[i]), origin, normal,
                                                        direction, triangle);
        weight *= w->density[i] / (w->density[i] + asked);
    }
    bring(w, i,
          (vec3){w->throughput.x[i] * weight * radiance.x, w->throughput.y[i] * weight * radiance.y,
                 w->throughput.z[i] * weight * radiance.z});
}

static void escape(const alpi_reference *r, alpi_path_wave *w, uint32_t i)
{
    const vec3 sky = alpi_lighting_escaped(lighting_at(r, w->depth[i]), at(&w->direction, i));
    if (w->depth[i] < 0 && !is_lit(sky)) { // not even a sun's disk: nothing but panes
        const vec3 t = at(&w->throughput, i);
        w->covered[w->slot[i]] = 1.0f - (t.x + t.y + t.z) / (3.0f * w->first);
    }
    add_met(r, w, i, sky, ALPI_NONE, INFINITY);
}

/// Ends a weak path by chance; those that go on make up for it. Paths from the eye play from the
/// second surface on: a dark first surface makes the pixel dark, so its paths are not weak.
static bool play_roulette(alpi_path_wave *w, uint32_t i, vec3 *throughput)
{
    const float most = fmaxf(throughput->x, fmaxf(throughput->y, throughput->z));
    float *whole = &w->whole[w->slot[i]];
    if (w->depth[i] < 0) {
        *whole = most;
        return true;
    }
    const float survival = most / (ROULETTE_SHARE * *whole);
    if (survival < 1.0f) {
        *throughput = vec3_scale(*throughput, 1.0f / survival);
        return w->v[i] < survival;
    }
    return true;
}

/// Makes path i of before path `to` ≤ i, at its next vertex.
static void move(alpi_path_wave *w, uint32_t to, uint32_t i, vec3 throughput,
                 const alpi_receiver_point *p)
{
    alpi_paths_place(w, to, p);
    put(&w->throughput, to, throughput);
    w->pick[to] = w->u[i];
    w->key[to] = w->key[i];
    w->sample[to] = w->sample[i];
    w->event[to] = w->event[i] + 1;
    w->depth[to] = w->depth[i] + 1;
    w->slot[to] = w->slot[i];
}

/// What a surface sends towards the path that meets it.
static void meet(const alpi_reference *r, alpi_path_wave *w, uint32_t i, uint32_t triangle,
                 float b1, float b2, float distance)
{
    const vec3 back = vec3_scale(at(&w->direction, i), -1.0f);
    add_met(r, w, i, alpi_surface_emission(r->scene, triangle, b1, b2, back), triangle, distance);
}

/// Whether path i, bounced once, ends with light that is known: it does but where it meets that
/// from so near that one light for a whole cell is too coarse, and may bounce there.
/// @param kept what alpi_panes_pass left of a pane's own share, which is in that light already
static bool meet_known(const alpi_reference *r, alpi_path_wave *w, uint32_t i, float kept,
                       float distance)
{
    const alpi_hits *hits = &w->hits[i / ALPI_PACKET];
    const int lane = (int)(i % ALPI_PACKET);
    const vec3 direction = at(&w->direction, i), throughput = at(&w->throughput, i);
    const uint32_t triangle = hits->triangle[lane], met = 1u << lane;
    uint32_t cells[1][ALPI_PACKET];
    bool behind = false;
    alpi_hit_point(r->scene, hits, lane, direction, &behind);
    if (behind && !alpi_surface_is_double_sided(r->scene, triangle)) {
        return true;
    }
    r->known->find(r->known->user, hits, &met, 1, cells);
    const float *cell = r->known->cells[cells[0][lane]];
    if (distance < r->known_reach * cell[ALPI_CELL_SIDE] && w->depth[i] + 1 < (int32_t)r->bounces) {
        return false;
    }
    if (r->filter.panes) {
        const float own =
            alpi_surface_pane(r->scene, triangle, hits->b1[lane], hits->b2[lane]).kept;
        kept = own > 0.0f ? kept / own : 0.0f;
    }
    const vec3 known = vec3_scale(vec3_load(cell), (float)ALPI_PI * kept);
    bring(w, i, (vec3){throughput.x * known.x, throughput.y * known.y, throughput.z * known.z});
    return true;
}

/// Path i meets a surface. @param to where it goes on @return false: it ends here
static bool arrive(const alpi_reference *r, alpi_path_wave *w, uint32_t i, uint32_t to)
{
    const alpi_hits *hits = &w->hits[i / ALPI_PACKET];
    const int lane = (int)(i % ALPI_PACKET);
    float kept = 1.0f, distance = hits->distance[lane];
    if (r->filter.panes) {
        kept = alpi_panes_pass(r, w, i, meet, &distance);
    }
    const uint32_t triangle = hits->triangle[lane];
    if (triangle == ALPI_NONE) {
        escape(r, w, i);
        return false;
    }
    const float b1 = hits->b1[lane], b2 = hits->b2[lane];
    meet(r, w, i, triangle, b1, b2, distance);
    if (w->depth[i] >= (int32_t)r->bounces) {
        return false;
    }
    if (r->known != NULL && w->depth[i] >= 0 && meet_known(r, w, i, kept, distance)) {
        return false;
    }
    const vec3 albedo = vec3_scale(alpi_surface_albedo(r->scene, triangle, b1, b2), kept);
    vec3 throughput = at(&w->throughput, i);
    throughput = (vec3){throughput.x * albedo.x, throughput.y * albedo.y, throughput.z * albedo.z};
    if (!is_lit(throughput) || !play_roulette(w, i, &throughput)) {
        return false;
    }
    bool behind = false;
    const alpi_receiver_point p =
        alpi_hit_point(r->scene, hits, lane, at(&w->direction, i), &behind);
    if (behind && !alpi_surface_is_double_sided(r->scene, triangle)) {
        return false; // a single-sided surface is black from behind
    }
    move(w, to, i, throughput, &p);
    return true;
}

static void trace_wave(const alpi_reference *r, alpi_path_wave *w)
{
    for (uint32_t first = 0; first < w->count; first += ALPI_PACKET) {
        const uint32_t left = w->count - first;
        const uint32_t active = left < ALPI_PACKET ? (1u << left) - 1u : 0xffu;
        const size_t size = ALPI_PACKET * sizeof(float);
        alpi_rays *rays = &w->rays[first / ALPI_PACKET];
        memcpy(rays->origin_x, w->start.x + first, size);
        memcpy(rays->origin_y, w->start.y + first, size);
        memcpy(rays->origin_z, w->start.z + first, size);
        memcpy(rays->direction_x, w->direction.x + first, size);
        memcpy(rays->direction_y, w->direction.y + first, size);
        memcpy(rays->direction_z, w->direction.z + first, size);
        for (int i = 0; i < ALPI_PACKET; i++) {
            rays->maximum[i] = INFINITY;
        }
        alpi_hits *hits = &w->hits[first / ALPI_PACKET];
        if (w->depth[first] < 0) {
            alpi_trace_nearest_coherent(r->tracer, rays, active, r->filter, hits);
        } else {
            alpi_trace_nearest(r->tracer, rays, active, r->filter, hits);
        }
    }
}

/// Asks memory for what all hits will read, in two steps as one points to the other: hits of
/// neighbouring paths lie anywhere in the scene.
static void fetch_hits(const alp_scene *scene, const alpi_path_wave *w)
{
    for (uint32_t i = 0; i < w->count; i++) {
        const uint32_t triangle = w->hits[i / ALPI_PACKET].triangle[i % ALPI_PACKET];
        if (triangle != ALPI_NONE) {
            __builtin_prefetch(&scene->triangles[triangle]);
            __builtin_prefetch(&scene->triangle_surface[triangle]);
        }
    }
    for (uint32_t i = 0; i < w->count; i++) {
        const uint32_t triangle = w->hits[i / ALPI_PACKET].triangle[i % ALPI_PACKET];
        for (int k = 0; k < 3 && triangle != ALPI_NONE; k++) {
            const uint32_t vertex = scene->triangles[triangle][k];
            __builtin_prefetch(&scene->positions[vertex]);
            __builtin_prefetch(&scene->normals[vertex]);
        }
    }
}

/// Traces the rays of all paths; those that go on are at their next vertices then.
static void step(const alpi_reference *r, const alpi_wave_loops *loops, alpi_path_wave *w)
{
    trace_wave(r, w);
    fetch_hits(r->scene, w);
    loops->draw(w, ALPI_USE_CHOICE, 1);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < w->count; i++) {
        kept += arrive(r, w, i, kept);
    }
    w->count = kept;
}

// --- what neighbours share -----------------------------------------------------------------------

/// Where a path arrived, receiver `slot` would have arrived too with this density, per area, if
/// nothing is in between. @param rays out, in `lane`: the way it would have come, which is not the
/// way back where backs of surfaces are open
static float arrival_density(const alpi_path_wave *w, uint32_t path, uint32_t slot, alpi_rays *rays,
                             int lane)
{
    const vec3 from = at(&w->base, slot), way = vec3_sub(at(&w->origin, path), from);
    const float distance = vec3_length(way);
    const vec3 direction = vec3_scale(way, 1.0f / distance);
    const float here = vec3_dot(direction, at(&w->base_normal, slot));
    const float there = -vec3_dot(direction, at(&w->side, path));
    const float density = here * there / (distance * distance);
    const bool faces = here > 0.0f && there > 0.0f && isfinite(density);
    alpi_rays_set(rays, lane, from, direction, faces ? distance * (1.0f - 1e-5f) : -1.0f);
    return faces ? density : 0.0f;
}

/// Sends a packet of rays from the receivers of its block to where each of `count` paths arrived.
static void share_some(const alpi_reference *r, alpi_path_wave *w, uint32_t first, uint32_t count)
{
    float density[ALPI_WAVE_PACKETS][ALPI_PACKET];
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t path = first + k, slot = w->slot[path], block = w->block[slot];
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            const uint32_t other = i < w->lanes[slot] ? block + i : slot;
            density[k][i] = arrival_density(w, path, other, &w->rays[k], (int)i);
            if (other == slot) { // it came this way; or there is no such lane
                w->rays[k].maximum[i] = -1.0f;
            }
        }
    }
    alpi_trace_occluded(r->tracer, w->rays, count, 0xffu, r->filter, ALPI_RAYS_NEAR);
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t slot = w->slot[first + k], own = slot - w->block[slot];
        float sum = 0.0f;
        for (uint32_t i = 0; i < w->lanes[slot]; i++) {
            const bool open = i == own || w->rays[k].maximum[i] >= 0.0f;
            density[k][i] = open ? density[k][i] : 0.0f;
            sum += density[k][i];
        }
        for (uint32_t i = 0; i < w->lanes[slot] && density[k][own] > 0.0f; i++) {
            w->share[slot][i] = density[k][i] / sum;
        }
    }
}

/// Shares what comes after the first bounce among the receivers of a block. Each would have found
/// the place where a path arrived with some density p; the path's light goes to all of them in
/// proportion to p: the balance heuristic over the ways to find it, π p_i L / Σ p for radiance L.
/// Diffuse surfaces look the same from everywhere, so one tail serves all.
/// Based on: P. Bekaert, M. Sbert, J. Halton. Accelerating Path Tracing by Re-Using Paths. EGWR
/// 2002.
static void share_tails(const alpi_reference *r, alpi_path_wave *w)
{
    for (uint32_t first = 0; first < w->count; first += ALPI_WAVE_PACKETS) {
        const uint32_t left = w->count - first;
        share_some(r, w, first, left < ALPI_WAVE_PACKETS ? left : ALPI_WAVE_PACKETS);
    }
}

vec3 alpi_paths_light(const alpi_path_wave *w, uint32_t slot)
{
    const uint32_t block = w->block[slot], lane = slot - block;
    vec3 light = at(&w->own, slot);
    for (uint32_t i = 0; i < w->lanes[slot]; i++) {
        light = vec3_mad(light, w->share[block + i][lane], at(&w->tail, block + i));
    }
    return light;
}

// --- paths ---------------------------------------------------------------------------------------

static void ready(alpi_path_wave *w)
{
    memset(&w->own, 0, sizeof w->own);
    memset(&w->tail, 0, sizeof w->tail);
    memset(w->share, 0, sizeof w->share);
    for (uint32_t i = 0; i < w->count; i++) {
        w->share[i][i - w->block[i]] = 1.0f;
        w->covered[i] = 1.0f;
        w->whole[i] = w->first;
    }
    for (uint32_t i = 0; i < ALPI_WAVE_PACKETS; i++) {
        alpi_rays_clear(&w->rays[i]);
    }
    w->base = w->origin;
    w->base_normal = w->normal;
}

static void bounce(const alpi_reference *r, const alpi_wave_loops *loops, alpi_path_wave *w)
{
    if (r->next_event) {
        loops->draw(w, ALPI_USE_LIGHT, 0);
        add_next_event(r, w);
    }
    loops->draw(w, ALPI_USE_RAY, 0);
    loops->aim(w);
    for (uint32_t i = 0; i < w->count && !r->next_event; i++) {
        w->density[i] = -1.0f;
    }
    step(r, loops, w);
}

void alpi_paths_run(const alpi_reference *r, alpi_path_wave *w)
{
    if (w->count == 0) {
        return;
    }
    const alpi_wave_loops *loops = &ALPI_COMPILED_FOR(r->context, alpi_wave_loops);
    w->first = w->throughput.x[0];
    ready(w);
    if (w->depth[0] < 0) {
        step(r, loops, w);
    } else {
        loops->draw(w, ALPI_USE_CHOICE, 0);
        memcpy(w->pick, w->u, sizeof w->pick);
        bounce(r, loops, w);
        if (r->share) {
            share_tails(r, w);
        }
    }
    while (w->count > 0) {
        bounce(r, loops, w);
    }
}
