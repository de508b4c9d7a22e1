// SPDX-License-Identifier: MIT
#include "render/field_light.h"

#include "base/random.h"
#include "scene/receivers.h"
#include "transport/paths/hit.h"
#include "transport/paths/panes.h"

#include <math.h>
#include <string.h>

enum { DISK_SAMPLES = 4 };
/// Share of light that a dielectric mirrors head-on: a refractive index of 1.5.
static const float DIELECTRIC = 0.04f;

/// The bits of a position, which key the places on a sun's disk.
static uint32_t key_of(const float position[3])
{
    uint32_t bits[3];
    memcpy(bits, position, sizeof bits);
    return alpi_hash32(bits[0] ^ alpi_hash32(bits[1] ^ alpi_hash32(bits[2])));
}

/// A sample of a light at some points, as shadow rays.
typedef struct lamp_rays {
    alpi_rays rays;
    uint32_t active;
    vec3 light[ALPI_PACKET]; // that they bring
} lamp_rays;

static void aim_lamp(const alpi_field_light *l, uint32_t lamp, uint32_t sample, float share,
                     const alpi_field_points *points, lamp_rays *to)
{
    alpi_rays_clear(&to->rays);
    to->active = 0;
    for (uint32_t i = 0; i < points->count; i++) {
        alpi_light_sample s;
        const vec3 p = vec3_load(points->positions[i]), n = vec3_load(points->normals[i]);
        const vec2 u = alpi_sample_2d(key_of(points->positions[i]), sample);
        if (!alpi_lighting_sample_light(l->lamps, lamp, p, u, &s)) {
            continue;
        }
        const float offset = points->offsets[i];
        const float cosine = points->in_air ? 1.0f : vec3_dot(n, s.direction);
        const float reach = s.distance * (1.0f - 1e-5f) - 2.0f * offset;
        if (cosine > 0.0f && reach > 0.0f) {
            to->light[i] = vec3_scale(s.light, cosine * share / s.density);
            alpi_rays_set(&to->rays, (int)i, vec3_mad(p, offset, n), s.direction, reach);
            to->active |= 1u << i;
        }
    }
}

/// Adds the light of rays that nothing stops.
static void add_free(const alpi_field_light *l, lamp_rays *to, float (*irradiance)[3])
{
    alpi_trace_filter filter = l->filter;
    vec3 left[ALPI_PACKET];
    uint32_t open = 0;
    filter.panes = alpi_tracer_has_panes(l->tracer);
    if (to->active == 0) {
        return;
    }
    alpi_trace_occluded(l->tracer, &to->rays, 1, to->active, filter, ALPI_RAYS_NEAR);
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        left[i] = (vec3){1.0f, 1.0f, 1.0f};
        open |= (to->active >> i & 1u) != 0 && to->rays.maximum[i] >= 0.0f ? 1u << i : 0u;
    }
    if (filter.panes && open != 0) {
        alpi_panes_dim(l->scene, l->tracer, filter, open, &to->rays, left);
    }
    for (; open != 0; open &= open - 1) {
        const int i = __builtin_ctz(open);
        irradiance[i][0] += to->light[i].x * left[i].x;
        irradiance[i][1] += to->light[i].y * left[i].y;
        irradiance[i][2] += to->light[i].z * left[i].z;
    }
}

void alpi_field_light_add_lamps(const alpi_field_light *l, const alpi_field_points *points,
                                float (*irradiance)[3])
{
    const uint32_t lamps = l->lamps != NULL ? alpi_lighting_light_count(l->lamps) : 0;
    for (uint32_t k = 0; k < lamps; k++) {
        const bool disk = alpi_lighting_light(l->lamps, k)->size > 0.0f;
        const uint32_t samples = disk && !points->in_air ? DISK_SAMPLES : 1;
        for (uint32_t s = 0; s < samples; s++) {
            lamp_rays to;
            aim_lamp(l, k, s, 1.0f / (float)samples, points, &to);
            add_free(l, &to, irradiance);
        }
    }
}

void alpi_field_light_at(const alpi_field_light *l, const alpi_field_points *points,
                         float (*irradiance)[3])
{
    alp_field_irradiance(l->field, points->count, (const float(*)[3])points->positions,
                         (const float(*)[3])points->normals, irradiance);
    alpi_field_light_add_lamps(l, points, irradiance);
}

/// Schlick's approximation of the share that a surface mirrors: .04 of a dielectric head-on, the
/// base colour of a metal.
/// Based on: C. Schlick. An Inexpensive BRDF Model for Physically-based Rendering. 1994.
static vec3 find_fresnel(vec3 albedo, float metallic, float cosine)
{
    const float dull = 1.0f - fminf(fmaxf(cosine, 0.0f), 1.0f);
    const float grazing = dull * dull * dull * dull * dull;
    const float base[3] = {albedo.x, albedo.y, albedo.z};
    float share[3];
    for (int k = 0; k < 3; k++) {
        const float ahead = DIELECTRIC + metallic * (base[k] - DIELECTRIC);
        share[k] = ahead + grazing * (1.0f - ahead);
    }
    return vec3_load(share);
}

/// Exchanges a share F of diffuse light for the light that comes along the mirrored ray. Metals
/// have no diffuse light: (1 − metallic)(1 − F) diffuse + F mirrored.
static void add_gloss(const alpi_field_light *l, const alpi_field_points *at,
                      const alpi_surface_point *points, vec3 *radiance)
{
    float directions[ALPI_PACKET][3], mirrored[ALPI_PACKET][3];
    for (uint32_t i = 0; i < at->count; i++) {
        const vec3 n = vec3_load(at->normals[i]), v = points[i].toward;
        vec3_store(directions[i], vec3_mad(vec3_scale(v, -1.0f), 2.0f * vec3_dot(n, v), n));
    }
    alp_lpv_radiance(l->gloss, at->count, (const float(*)[3])at->positions,
                     (const float(*)[3])directions, mirrored);
    for (uint32_t i = 0; i < at->count; i++) {
        const alpi_surface_point *p = &points[i];
        const vec3 color = alpi_surface_color(l->scene, p->triangle, p->b1, p->b2);
        const float cosine = vec3_dot(vec3_load(at->normals[i]), p->toward);
        const float metallic = alpi_surface_metallic(l->scene, p->triangle, p->b1, p->b2);
        const vec3 f = find_fresnel(color, metallic, cosine);
        const float kept = alpi_surface_pane(l->scene, p->triangle, p->b1, p->b2).kept;
        const float diffuse = l->scene->metals_black ? 1.0f : 1.0f - metallic; // or it has it
        radiance[i].x = diffuse * (1.0f - f.x) * radiance[i].x + f.x * kept * mirrored[i][0];
        radiance[i].y = diffuse * (1.0f - f.y) * radiance[i].y + f.y * kept * mirrored[i][1];
        radiance[i].z = diffuse * (1.0f - f.z) * radiance[i].z + f.z * kept * mirrored[i][2];
    }
}

static void reflect(const void *user, const alpi_surface_point *points, uint32_t count,
                    vec3 *radiance)
{
    const alpi_field_light *l = user;
    const alp_scene *scene = l->scene;
    alpi_field_points at = {.count = count};
    float e[ALPI_PACKET][3];
    for (uint32_t i = 0; i < count; i++) {
        alpi_hits hit;
        hit.triangle[0] = points[i].triangle;
        hit.b1[0] = points[i].b1;
        hit.b2[0] = points[i].b2;
        const alpi_receiver_point p =
            alpi_hit_point(scene, &hit, 0, vec3_scale(points[i].toward, -1.0f), NULL);
        vec3_store(at.positions[i], p.position);
        vec3_store(at.normals[i], p.shading_normal);
        at.offsets[i] = p.offset;
    }
    alpi_field_light_at(l, &at, e);
    for (uint32_t i = 0; i < count; i++) {
        const alpi_surface_point *p = &points[i];
        const vec3 albedo = alpi_surface_albedo(scene, p->triangle, p->b1, p->b2);
        const float kept = alpi_surface_pane(scene, p->triangle, p->b1, p->b2).kept;
        const float share = kept * (float)(1.0 / ALPI_PI);
        radiance[i] = (vec3){share * albedo.x * e[i][0], share * albedo.y * e[i][1],
                             share * albedo.z * e[i][2]};
    }
    if (l->gloss != NULL) {
        add_gloss(l, &at, points, radiance);
    }
}

alpi_surface_light alpi_field_light_surfaces(const alpi_field_light *light)
{
    return (alpi_surface_light){.reflected = reflect, .user = light};
}
