// SPDX-License-Identifier: MIT
// Hits to light.
#include "transport/sphere/sphere_relight.h"

#include "base/random.h"
#include "transport/paths/panes.h"

#include <math.h>
#include <string.h>

enum { BATCH = ALPI_SPHERE_BATCH, USE_HIT = 11, USE_CHOICE = 12 };
static const float NEAR = 0.25f;        // of a cell: hits that share a call
static const float LEAST_COSINE = 0.9f; // between their normals

static vec3 lane_of(const float (*values)[ALPI_PACKET], int lane)
{
    return (vec3){values[0][lane], values[1][lane], values[2][lane]};
}

static void add_lane(float (*values)[ALPI_PACKET], int lane, vec3 v)
{
    values[0][lane] += v.x;
    values[1][lane] += v.y;
    values[2][lane] += v.z;
}

// --- surfaces ------------------------------------------------------------------------------------

/// Whether all rays of a packet left the scene.
static bool is_open(const alpi_sphere_hit hits[ALPI_PACKET])
{
    uint32_t all = ALPI_NONE;
    for (int i = 0; i < ALPI_PACKET; i++) {
        all &= hits[i].triangle;
    }
    return all == ALPI_NONE;
}

/// Reads what a packet met. @return bits of the lanes that met a side which is not black
static uint32_t find_surfaces(const alpi_sphere_hits_work *work, uint32_t packet,
                              const alpi_sphere_hit hits[ALPI_PACKET], const alpi_sphere_packet *p,
                              alpi_sphere_met *m)
{
    const alp_scene *scene = work->run->how->scene;
    uint32_t lit = 0;
    if (is_open(hits)) {
        memset(m->irradiance, 0, sizeof m->irradiance);
        memset(m->albedo, 0, sizeof m->albedo);
        return 0;
    }
    m->key = alpi_hash32(work->key ^ alpi_hash32(USE_HIT));
    m->first = packet * ALPI_PACKET;
    for (int i = 0; i < ALPI_PACKET; i++) {
        const alpi_sphere_hit *hit = &hits[i];
        const bool met = hit->triangle != ALPI_NONE;
        // Lanes that met nothing get a triangle too, so that their numbers are finite.
        const uint32_t *corners = scene->triangles[met ? hit->triangle : 0];
        for (int k = 0; k < 3; k++) {
            const float *corner = scene->positions[corners[k]];
            m->corners[k][0][i] = corner[0];
            m->corners[k][1][i] = corner[1];
            m->corners[k][2][i] = corner[2];
            m->albedo[k][i] = met ? (float)hit->albedo[k] : 0.0f;
        }
        m->distance[i] = met ? hit->distance : 0.0f;
        lit |= met && (hit->side & ALPI_HIT_SIDE) != ALPI_HIT_BLACK ? 1u << i : 0u;
    }
    work->run->hits_loops->place(p, m);
    return lit;
}

// --- light straight from lamps -------------------------------------------------------------------

/// Traces shadow rays. @return bits of the lanes that are open
static uint32_t trace_shadows(const alpi_sphere_hits_run *run, uint32_t active, alpi_rays *rays)
{
    uint32_t open = 0;
    alpi_trace_occluded(run->how->tracer, rays, 1, active, run->filter, ALPI_RAYS_NEAR);
    for (int i = 0; i < ALPI_PACKET; i++) {
        open |= rays->maximum[i] >= 0.0f ? 1u << i : 0u;
    }
    return open & active;
}

/// Adds light that arrives along shadow rays, dimmed by panes. @param light [ALPI_PACKET] E
static void add_open(const alpi_sphere_hits_run *run, uint32_t open, alpi_rays *rays,
                     const vec3 *light, alpi_sphere_met *m)
{
    vec3 left[ALPI_PACKET];
    for (int i = 0; i < ALPI_PACKET; i++) {
        left[i] = (vec3){1.0f, 1.0f, 1.0f};
    }
    if (run->filter.panes && open != 0) {
        alpi_panes_dim(run->how->scene, run->how->tracer, run->filter, open, rays, left);
    }
    for (; open != 0; open &= open - 1) {
        const int i = __builtin_ctz(open);
        const vec3 k = left[i];
        add_lane(m->irradiance, i, (vec3){light[i].x * k.x, light[i].y * k.y, light[i].z * k.z});
    }
}

static void add_distant(const alpi_sphere_hits_run *run, const alpi_sphere_lamp *lamp, float scale,
                        uint32_t lit, alpi_sphere_met *m)
{
    alpi_rays rays;
    float cosines[ALPI_PACKET];
    const vec3 each = vec3_scale(lamp->light_each, scale);
    const uint32_t facing = run->hits_loops->aim(m, lamp, &rays, cosines) & lit;
    const uint32_t active = alpi_occluders_open(run->how->occluders, &rays, rays.maximum, facing);
    if (active == 0) {
        return;
    }
    if (!run->filter.panes) {
        alpi_trace_occluded(run->how->tracer, &rays, 1, active, run->filter, ALPI_RAYS_NEAR);
        run->hits_loops->add(&rays, active, cosines, each, m);
        return;
    }
    vec3 light[ALPI_PACKET];
    for (int i = 0; i < ALPI_PACKET; i++) {
        light[i] = vec3_scale(each, cosines[i]);
    }
    const uint32_t open = trace_shadows(run, active, &rays);
    add_open(run, open, &rays, light, m);
}

static void add_punctual(const alpi_sphere_hits_run *run, const alpi_sphere_lamp *lamp, float scale,
                         uint32_t lit, alpi_sphere_met *m)
{
    alpi_rays rays;
    vec3 light[ALPI_PACKET];
    uint32_t active = 0;
    alpi_rays_clear(&rays);
    for (; lit != 0; lit &= lit - 1) {
        const int i = __builtin_ctz(lit);
        const vec3 position = lane_of((const float(*)[ALPI_PACKET])m->position, i);
        const vec3 normal = lane_of((const float(*)[ALPI_PACKET])m->normal, i);
        alpi_light_sample s;
        if (!alpi_lighting_sample_light(run->how->lighting, lamp->light, position,
                                        (vec2){0.0f, 0.0f}, &s)) {
            continue;
        }
        const float cosine = vec3_dot(normal, s.direction);
        const float reach = s.distance * (1.0f - 1e-5f) - 2.0f * m->offset[i];
        if (cosine > 0.0f) {
            light[i] = vec3_scale(s.light, scale * cosine);
            alpi_rays_set(&rays, i, position, s.direction, fmaxf(reach, 0.0f));
            active |= 1u << i;
        }
    }
    active = alpi_occluders_open(run->how->occluders, &rays, rays.maximum, active);
    if (active != 0) {
        const uint32_t open = trace_shadows(run, active, &rays);
        add_open(run, open, &rays, light, m);
    }
}

static void add_lamp(const alpi_sphere_hits_run *run, const alpi_sphere_lamp *lamp, float scale,
                     uint32_t lit, alpi_sphere_met *m)
{
    if (lamp->distant) {
        add_distant(run, lamp, scale, lit, m);
    } else {
        add_punctual(run, lamp, scale, lit, m);
    }
}

/// Unshadowed E of a surface that faces the lamp, summed over the channels.
static double level_at(const alpi_sphere_hits_run *run, const alpi_sphere_lamp *lamp, vec3 place)
{
    alpi_light_sample s;
    vec3 light = lamp->light_each;
    if (!lamp->distant) {
        const bool there = alpi_lighting_sample_light(run->how->lighting, lamp->light, place,
                                                      (vec2){0.0f, 0.0f}, &s);
        light = there ? s.light : (vec3){0.0f, 0.0f, 0.0f};
    }
    return (double)light.x + (double)light.y + (double)light.z;
}

/// Draws ALPI_HITS_LAMPS of many lamps for a packet, evenly spread over the sum of their shares. A
/// share is three quarters the E of the lamp at one hit, one quarter the same for all, as other
/// lanes may be in its range.
static void draw_lamps(const alpi_sphere_hits_run *run, uint32_t lit, alpi_sphere_met *m)
{
    const uint32_t count = run->lamp_count;
    const vec3 place = lane_of((const float(*)[ALPI_PACKET])m->position, __builtin_ctz(lit));
    const uint32_t random = alpi_hash32(m->key ^ alpi_hash32(m->first ^ alpi_hash32(USE_CHOICE)));
    double sum = 0.0, end = 0.0, next = (double)alpi_unit_float(random) / ALPI_HITS_LAMPS;
    for (uint32_t i = 0; i < count; i++) {
        sum += level_at(run, &run->lamps[i], place);
    }
    for (uint32_t i = 0; i < count && next < 1.0; i++) {
        const double even = 1.0 / count;
        const double share =
            sum > 0.0 ? 0.75 * level_at(run, &run->lamps[i], place) / sum + 0.25 * even : even;
        uint32_t times = 0;
        for (end += share; next < end && next < 1.0; next += 1.0 / ALPI_HITS_LAMPS) {
            times++;
        }
        if (times > 0) {
            const double scale = times / (ALPI_HITS_LAMPS * share);
            add_lamp(run, &run->lamps[i], (float)scale, lit, m);
        }
    }
}

static void add_lamps(const alpi_sphere_hits_run *run, uint32_t lit, alpi_sphere_met *m)
{
    if (lit == 0) {
        return;
    }
    if (run->lamp_count > ALPI_HITS_LAMPS) {
        draw_lamps(run, lit, m);
        return;
    }
    for (uint32_t i = 0; i < run->lamp_count; i++) {
        add_lamp(run, &run->lamps[i], 1.0f, lit, m);
    }
}

// --- light that bounced --------------------------------------------------------------------------

/// Places that hits of a batch share: the means of those hits.
typedef struct shared_places {
    uint32_t count;
    vec3 points[BATCH * ALPI_PACKET], normals[BATCH * ALPI_PACKET];
    uint8_t of[BATCH][ALPI_PACKET]; // place of each lane that is lit
} shared_places;
_Static_assert(BATCH *ALPI_PACKET <= 256, "places are numbered in a byte");

/// Hits of a packet that are near the first of them share a place.
static void share_places(const alpi_sphere_relight *how, uint32_t lit, const alpi_sphere_met *m,
                         uint8_t of[ALPI_PACKET], shared_places *places)
{
    while (lit != 0) {
        const int first = __builtin_ctz(lit);
        const vec3 point = lane_of(m->position, first), normal = lane_of(m->normal, first);
        const float cell = how->bounce_cell_scale * m->distance[first];
        const float limit = NEAR * (cell > how->bounce_cell_least ? cell : how->bounce_cell_least);
        vec3 points = point, normals = normal;
        float count = 1.0f;
        of[first] = (uint8_t)places->count;
        lit &= lit - 1;
        for (uint32_t others = limit > 0.0f ? lit : 0; others != 0; others &= others - 1) {
            const int i = __builtin_ctz(others);
            const vec3 p = lane_of(m->position, i), n = lane_of(m->normal, i);
            const vec3 apart = vec3_sub(p, point);
            if (vec3_dot(apart, apart) < limit * limit && vec3_dot(n, normal) > LEAST_COSINE) {
                points = vec3_add(points, p);
                normals = vec3_add(normals, n);
                count += 1.0f;
                of[i] = (uint8_t)places->count;
                lit &= ~(1u << i);
            }
        }
        if (count > 1.0f) {
            points = vec3_scale(points, 1.0f / count);
            normals = vec3_scale(normals, 1.0f / vec3_length(normals));
        }
        places->points[places->count] = points;
        places->normals[places->count++] = normals;
    }
}

static void add_bounces(const alpi_sphere_relight *how, uint32_t count, const uint32_t *lit,
                        alpi_sphere_met *met)
{
    shared_places places;
    vec3 irradiance[BATCH * ALPI_PACKET];
    places.count = 0;
    for (uint32_t k = 0; k < count; k++) {
        share_places(how, lit[k], &met[k], places.of[k], &places);
    }
    for (uint32_t first = 0; first < places.count; first += ALPI_PACKET) {
        const uint32_t left = places.count - first;
        how->bounce(how->bounce_user, left < ALPI_PACKET ? left : ALPI_PACKET,
                    places.points + first, places.normals + first, irradiance + first);
    }
    for (uint32_t k = 0; k < count; k++) {
        for (uint32_t lanes = lit[k]; lanes != 0; lanes &= lanes - 1) {
            const int i = __builtin_ctz(lanes);
            add_lane(met[k].irradiance, i, irradiance[places.of[k][i]]);
        }
    }
}

// --- emission and sky ----------------------------------------------------------------------------

/// Barycentric weights of corners 1 and 2 at a place of the triangle's plane.
static void find_weights(const alpi_sphere_met *m, int i, float weights[2])
{
    double u[3], v[3], w[3], uu = 0.0, uv = 0.0, vv = 0.0, wu = 0.0, wv = 0.0;
    for (int k = 0; k < 3; k++) {
        u[k] = (double)m->corners[1][k][i] - (double)m->corners[0][k][i];
        v[k] = (double)m->corners[2][k][i] - (double)m->corners[0][k][i];
        w[k] = (double)m->position[k][i] - (double)m->corners[0][k][i];
        uu += u[k] * u[k];
        uv += u[k] * v[k];
        vv += v[k] * v[k];
        wu += w[k] * u[k];
        wv += w[k] * v[k];
    }
    const double area = uu * vv - uv * uv;
    const double b1 = area > 0.0 ? (wu * vv - wv * uv) / area : 0.0;
    const double b2 = area > 0.0 ? (wv * uu - wu * uv) / area : 0.0;
    weights[0] = (float)fmin(fmax(b1, 0.0), 1.0);
    weights[1] = (float)fmin(fmax(b2, 0.0), 1.0 - (double)weights[0]);
}

static void add_emission(const alpi_sphere_hits_run *run, const alpi_sphere_hit *hits,
                         const alpi_sphere_met *m, uint32_t open, alpi_sphere_packet *p)
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        float weights[2];
        if ((open >> i & 1u) == 0 || hits[i].triangle == ALPI_NONE ||
            (hits[i].side & ALPI_HIT_EMITS) == 0) {
            continue;
        }
        find_weights(m, i, weights);
        const vec3 back = {-p->rays.direction_x[i], -p->rays.direction_y[i],
                           -p->rays.direction_z[i]};
        const float level = (float)(hits[i].side >> ALPI_HIT_LEVEL) / (float)ALPI_HIT_LEVEL_MOST;
        const vec3 e =
            alpi_surface_emission(run->how->scene, hits[i].triangle, weights[0], weights[1], back);
        add_lane(p->light, i, vec3_scale(e, level));
    }
}

static void add_sky(const alpi_sky *sky, const alpi_sphere_hit *hits, uint32_t open,
                    alpi_sphere_packet *p)
{
    vec3 directions[ALPI_PACKET], radiances[ALPI_PACKET];
    int lanes[ALPI_PACKET];
    uint32_t count = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((open >> i & 1u) != 0 && hits[i].triangle == ALPI_NONE) {
            directions[count] =
                (vec3){p->rays.direction_x[i], p->rays.direction_y[i], p->rays.direction_z[i]};
            lanes[count++] = i;
        }
    }
    if (count == 0) {
        return;
    }
    alpi_sky_radiances(sky, directions, count, radiances);
    for (uint32_t k = 0; k < count; k++) {
        const uint8_t *share = hits[lanes[k]].albedo;
        const float scale = 1.0f / 255.0f;
        const vec3 root = {(float)share[0] * scale, (float)share[1] * scale,
                           (float)share[2] * scale};
        add_lane(p->light, lanes[k],
                 (vec3){radiances[k].x * root.x * root.x, radiances[k].y * root.y * root.y,
                        radiances[k].z * root.z * root.z});
    }
}

/// Rays of a packet that no sphere stops before what they met.
static uint32_t find_open(const alpi_occluders *occluders, const alpi_sphere_hit *hits,
                          const alpi_sphere_packet *p)
{
    float reach[ALPI_PACKET];
    if (occluders == NULL || occluders->count == 0) {
        return 0xffu;
    }
    for (int i = 0; i < ALPI_PACKET; i++) {
        reach[i] = hits[i].distance;
    }
    return alpi_occluders_open(occluders, &p->rays, reach, 0xffu);
}

void alpi_sphere_hits_light(const alpi_sphere_hits_work *work, uint32_t first, uint32_t count,
                            const alpi_sphere_hit (*hits)[ALPI_PACKET], alpi_sphere_packet *packets)
{
    const alpi_sphere_hits_run *run = work->run;
    alpi_sphere_met met[BATCH];
    uint32_t lit[BATCH], open[BATCH];
    for (uint32_t k = 0; k < count; k++) {
        open[k] = find_open(run->how->occluders, hits[k], &packets[k]);
        lit[k] = find_surfaces(work, first + k, hits[k], &packets[k], &met[k]) & open[k];
        add_lamps(run, lit[k], &met[k]);
    }
    if (run->how->bounce != NULL) {
        add_bounces(run->how, count, lit, met);
    }
    for (uint32_t k = 0; k < count; k++) {
        run->hits_loops->reflect(&met[k], &packets[k]);
        if (run->how->aimed == NULL && run->how->only_light == 0) {
            add_emission(run, hits[k], &met[k], open[k], &packets[k]);
        }
        if (run->sky != NULL) {
            add_sky(run->sky, hits[k], open[k], &packets[k]);
        }
    }
}
