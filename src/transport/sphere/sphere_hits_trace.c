// SPDX-License-Identifier: MIT
// Rays to hits that can be kept.
#include "base/random.h"
#include "transport/paths/panes.h"
#include "transport/sphere/sphere_relight.h"

#include <math.h>

enum { BATCH = ALPI_SPHERE_BATCH, USE_PANE = 21 };

/// Shares of light that panes on the way of a packet leave.
typedef struct passed_panes {
    vec3 left[ALPI_PACKET];    // through panes, over the probability of the way
    float before[ALPI_PACKET]; // metres to the last pane
    float kept[ALPI_PACKET];   // share that the last surface reflects of its albedo, likewise
} passed_panes;

static float largest_of(vec3 v)
{
    return fmaxf(v.x, fmaxf(v.y, v.z));
}

/// Decides which rays of `active` go on behind what they met: in proportion to the most that
/// either way brings, so that nothing that is kept exceeds 1.
static uint32_t choose_way(const alp_scene *scene, const alpi_hits *hits, uint32_t active,
                           const uint32_t random[ALPI_PACKET], passed_panes *panes,
                           float chances[ALPI_PACKET])
{
    uint32_t on = 0;
    for (; active != 0; active &= active - 1) {
        const int i = __builtin_ctz(active);
        const uint32_t triangle = hits->triangle[i];
        if (triangle == ALPI_NONE ||
            !alpi_surface_is_pane(scene, scene->triangle_surface[triangle])) {
            continue;
        }
        const float b1 = hits->b1[i], b2 = hits->b2[i];
        const alpi_pane pane = alpi_surface_pane(scene, triangle, b1, b2);
        const float through = largest_of(pane.through);
        const float back = pane.kept * largest_of(alpi_surface_albedo(scene, triangle, b1, b2));
        chances[i] = through > 0.0f ? through / (through + back) : 0.0f;
        if (alpi_unit_float(random[i]) < chances[i]) {
            on |= 1u << i;
        } else {
            panes->kept[i] = chances[i] < 1.0f ? pane.kept / (1.0f - chances[i]) : 0.0f;
        }
    }
    return on;
}

/// Rays of a packet that met panes go on, or not.
static void pass_panes(const alpi_sphere_hits_work *work, uint32_t packet,
                       const alpi_sphere_packet *p, alpi_hits *hits, passed_panes *panes)
{
    const alpi_sphere_hits_run *run = work->run;
    alpi_rays rays = p->rays;
    uint32_t active = 0xffu;
    for (uint32_t passed = 0; active != 0 && passed < ALPI_PANE_LIMIT; passed++) {
        uint32_t random[ALPI_PACKET];
        float chances[ALPI_PACKET];
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            const uint32_t ray = alpi_hash32(packet * ALPI_PACKET + i);
            random[i] = alpi_hash32(work->key ^ alpi_hash32(ray ^ (USE_PANE + passed)));
        }
        const uint32_t chosen = choose_way(run->how->scene, hits, active, random, panes, chances);
        active = alpi_panes_go_on(run->how->scene, hits, chosen, &rays, panes->left);
        for (uint32_t left = chosen; left != 0; left &= left - 1) {
            const int i = __builtin_ctz(left);
            panes->left[i] = vec3_scale(panes->left[i], 1.0f / chances[i]);
            panes->before[i] += hits->distance[i];
        }
        if (active != 0) {
            alpi_trace_nearest(work->tracing.tracer, &rays, active, run->filter, hits);
        }
    }
}

static uint8_t encode(float albedo)
{
    return (uint8_t)(255.0f * sqrtf(fminf(fmaxf(albedo, 0.0f), 1.0f)) + 0.5f);
}

static bool shines(const alp_scene *scene, uint32_t triangle)
{
    const uint32_t material = scene->surfaces[scene->triangle_surface[triangle]].material;
    const float *e = material != ALPI_NONE ? scene->materials[material].emission : NULL;
    return e != NULL && (e[0] > 0.0f || e[1] > 0.0f || e[2] > 0.0f);
}

/// @param panes NULL: there are none
static void keep_hit(const alp_scene *scene, const alpi_hits *hits, int i,
                     const passed_panes *panes, alpi_sphere_hit *hit)
{
    static const vec3 one = {1.0f, 1.0f, 1.0f};
    const uint32_t triangle = hits->triangle[i];
    const vec3 left = panes != NULL ? panes->left[i] : one;
    unsigned side = 0;
    vec3 albedo = one;
    if (triangle != ALPI_NONE) {
        const bool behind = (hits->behind >> i & 1u) != 0;
        const bool black = behind && !alpi_surface_is_double_sided(scene, triangle);
        const float level = fminf((left.x + left.y + left.z) * (1.0f / 3.0f), 1.0f);
        side = black ? ALPI_HIT_BLACK : behind ? ALPI_HIT_BACK : ALPI_HIT_FRONT;
        side |= shines(scene, triangle) ? (unsigned)ALPI_HIT_EMITS : 0u;
        side |= (unsigned)(level * (float)ALPI_HIT_LEVEL_MOST + 0.5f) << ALPI_HIT_LEVEL;
        albedo = black ? (vec3){0.0f, 0.0f, 0.0f}
                       : alpi_surface_albedo(scene, triangle, hits->b1[i], hits->b2[i]);
        albedo = vec3_scale(albedo, panes != NULL ? panes->kept[i] : 1.0f);
    }
    *hit = (alpi_sphere_hit){
        .triangle = triangle,
        .distance = hits->distance[i] + (panes != NULL ? panes->before[i] : 0.0f),
        .albedo = {encode(albedo.x * left.x), encode(albedo.y * left.y), encode(albedo.z * left.z)},
        .side = (uint8_t)side};
}

void alpi_sphere_hits_trace(const alpi_sphere_hits_work *work, uint32_t first, uint32_t count,
                            const alpi_sphere_packet *packets, alpi_sphere_hit (*kept)[ALPI_PACKET])
{
    alpi_hits hits[BATCH];
    const alp_scene *scene = work->run->how->scene;
    alpi_sphere_trace(&work->tracing, count, packets, hits);
    for (uint32_t k = 0; k < count; k++) {
        passed_panes panes;
        const bool any = work->run->filter.panes;
        if (any) {
            for (int i = 0; i < ALPI_PACKET; i++) {
                panes.left[i] = (vec3){1.0f, 1.0f, 1.0f};
                panes.before[i] = 0.0f;
                panes.kept[i] = 1.0f;
            }
            pass_panes(work, first + k, &packets[k], &hits[k], &panes);
        }
        for (int i = 0; i < ALPI_PACKET; i++) {
            keep_hit(scene, &hits[k], i, any ? &panes : NULL, &kept[k][i]);
        }
    }
}
