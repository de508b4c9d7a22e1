// SPDX-License-Identifier: MIT
// Direct light of lamps and suns, by shadow rays.
#include "transport/direct/direct_gather.h"

/// Asks a lamp from sample i. @param factor 1 / the probability that it is asked
static void ask_lamp(alpi_direct_gather *g, uint32_t light, uint32_t i, uint32_t replicate,
                     float factor)
{
    const alpi_receiver_point *p = &g->points[i];
    const vec3 origin = alpi_direct_start(p);
    alpi_punctual_light at;
    if (!alpi_punctual_at(&g->direct->lights[light], origin, &at)) {
        return;
    }
    const float cosine = vec3_dot(at.direction, p->shading_normal);
    if (cosine > 0.0f) {
        const alpi_direct_way way = {origin, at.direction, alpi_direct_reach(at.distance, p),
                                     ALPI_RAYS_PAIRED};
        alpi_direct_send(
            g, &way, at.light, cosine * factor,
            (alpi_direct_arrival){.part = (uint16_t)g->direct->light_parts[light],
                                  .replicate = (uint16_t)replicate,
                                  .way = {.normal = p->shading_normal, .cosine = cosine}});
    }
}

void alpi_direct_add_lamps(alpi_direct_gather *g)
{
    const alpi_direct *d = g->direct;
    const bool extended = g->receivers->extended;
    for (uint32_t k = 0; k < d->lamp_count && !d->lamps_drawn; k++) {
        for (uint32_t i = 0; i < g->count && extended; i++) {
            ask_lamp(g, d->lamps[k], i, alpi_direct_replicate(i), 1.0f);
        }
        if (!extended && g->first == 0) { // every sample would be the same
            ask_lamp(g, d->lamps[k], 0, ALPI_DIRECT_EVERY, 1.0f);
        }
    }
    for (uint32_t i = 0; i < g->count && d->lamps_drawn; i++) {
        const alpi_receiver_point *p = &g->points[i];
        uint32_t light = 0;
        const double part =
            alpi_punctual_sample(&d->drawn, alpi_direct_start(p), p->shading_normal,
                                 (double)alpi_direct_draw(g, ALPI_DIRECT_USE_PICK, i).y, &light);
        if (part > 0.0) {
            ask_lamp(g, light, i, alpi_direct_replicate(i), (float)(1.0 / part));
        }
    }
    alpi_direct_flush(g, ALPI_RAYS_PAIRED);
}

/// Asks a point of a sun's disk. @param factor 1 / the probability that the sun is asked
static void ask_sun(alpi_direct_gather *g, const alpi_sun *sun, uint32_t i, uint32_t use,
                    float factor)
{
    const alpi_receiver_point *p = &g->points[i];
    const alpi_direct_way way = {alpi_direct_start(p),
                                 alpi_sun_sample(sun, alpi_direct_draw(g, use, i)), INFINITY,
                                 ALPI_RAYS_PAIRED};
    const float cosine = vec3_dot(way.direction, p->shading_normal);
    if (cosine > 0.0f) {
        alpi_direct_send(
            g, &way, sun->radiance, cosine * factor / (float)alpi_sun_density(sun),
            (alpi_direct_arrival){.part = (uint16_t)g->direct->light_parts[sun->light],
                                  .replicate = (uint16_t)alpi_direct_replicate(i),
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

void alpi_direct_add_suns(alpi_direct_gather *g)
{
    const alpi_direct *d = g->direct;
    for (uint32_t k = 0; k < d->sun_count && !d->suns_drawn; k++) {
        for (uint32_t i = 0; i < g->count; i++) {
            ask_sun(g, &d->suns[k], i, ALPI_DIRECT_USE_SUN + k, 1.0f);
        }
    }
    for (uint32_t i = 0; i < g->count && d->suns_drawn; i++) {
        const alpi_sun *sun = NULL;
        const double pick = (double)alpi_direct_draw(g, ALPI_DIRECT_USE_SUN + 1, i).x;
        const double part = pick_sun(d, g->points[i].shading_normal, pick, &sun);
        if (part > 0.0 && sun != NULL) {
            ask_sun(g, sun, i, ALPI_DIRECT_USE_SUN, (float)(1.0 / part));
        }
    }
    alpi_direct_flush(g, ALPI_RAYS_PAIRED);
}
