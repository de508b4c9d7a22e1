// SPDX-License-Identifier: MIT
// The doctor's look at lights. What takes rays to find, alp_scene_examine tells.
#include "doctor/doctor.h"

#include "base/tasks.h"
#include "scene/double3.h"

#include <math.h>
#include <string.h>

enum { LAMP_LIMIT = 64 }; // so many are looked for in surfaces: a look at each triangle for each
/// Candela: ten searchlights of a stadium (about 1e5 each). Lux: the sun outside of the air gives
/// 1.34e5 (the solar constant's illuminance, ASTM E490).
static const double STRONGEST_LAMP = 1e6, STRONGEST_SUN = 1.5e5;
/// Of the scene's diagonal: so near a lamp lies in a surface, as alp_scene_examine has it.
static const double TOUCHING = 1e-5;

static float largest(vec3 v)
{
    return fmaxf(fmaxf(v.x, v.y), v.z);
}

/// From a point to the scene's bounding box, metres; 0 inside.
static double distance_to_scene(const alp_scene *scene, vec3 p)
{
    const vec3 none = {0.0f, 0.0f, 0.0f};
    const vec3 below = vec3_max(vec3_sub(scene->bounds_min, p), none);
    const vec3 above = vec3_max(vec3_sub(p, scene->bounds_max), none);
    return (double)vec3_length(vec3_add(below, above));
}

static alp_result look_at_strength(alp_diagnosis *d, uint32_t index)
{
    const alpi_light *light = &d->scene->lights[index];
    const alp_light_traits traits = alp_light_traits_of(light->kind);
    const bool sun = !traits.has_position;
    const double strength = (double)light->intensity * (double)largest(light->color);
    alpi_finding_facts facts = {.place = ALP_PLACE_LIGHT, .index = index, .value = strength};
    if (!(strength > 0.0)) {
        facts.kind = ALP_FINDING_LIGHT_OFF;
        return alpi_diagnosis_add(d, facts, "its intensity or its colour is 0");
    }
    if (strength > (sun ? STRONGEST_SUN : STRONGEST_LAMP)) {
        facts.kind = ALP_FINDING_LIGHT_STRONG;
        return alpi_diagnosis_add(d, facts, "%.3g %s, more than any %s", strength, traits.unit,
                                  sun ? "sun on Earth" : "usual lamp");
    }
    return ALP_OK;
}

static alp_result look_at_range(alp_diagnosis *d, uint32_t index)
{
    const alpi_light *light = &d->scene->lights[index];
    if (!alp_light_traits_of(light->kind).has_position || d->scene->usable_count == 0) {
        return ALP_OK;
    }
    const double distance = distance_to_scene(d->scene, light->position);
    const alpi_finding_facts facts = {ALP_FINDING_LIGHT_RANGE, ALP_PLACE_LIGHT, index, 0, distance};
    return (double)light->range <= distance
               ? alpi_diagnosis_add(d, facts,
                                    "its range of %.3g m ends before the scene, %.3g m away",
                                    (double)light->range, distance)
               : ALP_OK;
}

// --- in a surface --------------------------------------------------------------------------------

static double distance_to_segment(double3 p, double3 a, double3 b)
{
    const double3 along = double3_sub(b, a), to = double3_sub(p, a);
    const double length = double3_dot(along, along);
    const double t = length > 0.0 ? fmin(fmax(double3_dot(to, along) / length, 0.0), 1.0) : 0.0;
    return double3_length(double3_sub(to, double3_scale(along, t)));
}

static double distance_to_triangle(vec3 point, const vec3 corner[3])
{
    const double3 p = double3_from(point);
    const double3 c[3] = {double3_from(corner[0]), double3_from(corner[1]),
                          double3_from(corner[2])};
    const double3 normal =
        double3_unit(double3_cross(double3_sub(c[1], c[0]), double3_sub(c[2], c[0])));
    bool inside = true;
    double edge = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const double3 a = c[k], b = c[(k + 1) % 3];
        inside = inside &&
                 double3_dot(double3_cross(double3_sub(b, a), double3_sub(p, a)), normal) >= 0.0;
        edge = fmin(edge, distance_to_segment(p, a, b));
    }
    return inside ? fabs(double3_dot(double3_sub(p, c[0]), normal)) : edge;
}

/// Whether the triangle's box is nearer than `reach`: most are not.
static bool may_reach(vec3 p, const vec3 c[3], float reach)
{
    const vec3 low = vec3_min(vec3_min(c[0], c[1]), c[2]);
    const vec3 high = vec3_max(vec3_max(c[0], c[1]), c[2]);
    return p.x >= low.x - reach && p.x <= high.x + reach && p.y >= low.y - reach &&
           p.y <= high.y + reach && p.z >= low.z - reach && p.z <= high.z + reach;
}

/// Whether alp_scene_examine has told it.
static bool is_told(const alp_diagnosis *d, const char *name)
{
    for (size_t i = 0; i < d->count; i++) {
        const alp_finding *f = &d->findings[i].view;
        if (f->kind == ALP_FINDING_LIGHT_ON_SURFACE && strcmp(f->name, name) == 0) {
            return true;
        }
    }
    return false;
}

static alp_result look_for_surface(alp_diagnosis *d, uint32_t index)
{
    const alp_scene *scene = d->scene;
    const alpi_light *light = &scene->lights[index];
    if (!alp_light_traits_of(light->kind).has_position || !(light->intensity > 0.0f) ||
        (light->name != NULL && is_told(d, light->name))) {
        return ALP_OK;
    }
    const double reach =
        TOUCHING * (double)vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        if (scene->triangle_usable[t] && may_reach(light->position, c, (float)reach) &&
            distance_to_triangle(light->position, c) <= reach) {
            const alpi_finding_facts facts = {ALP_FINDING_LIGHT_ON_SURFACE, ALP_PLACE_LIGHT, index,
                                              0, 0.0};
            return alpi_diagnosis_add(d, facts, "lies in the surface \"%.60s\"",
                                      scene->surfaces[scene->triangle_surface[t]].name);
        }
    }
    return ALP_OK;
}

alp_result alpi_doctor_look_at_lights(alp_diagnosis *diagnosis)
{
    for (uint32_t i = 0; i < diagnosis->scene->light_count; i++) {
        ALP_TRY(look_at_strength(diagnosis, i));
        ALP_TRY(look_at_range(diagnosis, i));
        ALP_TRY(i < LAMP_LIMIT ? look_for_surface(diagnosis, i) : ALP_OK);
        ALP_TRY(alpi_tick(diagnosis->context, "diagnose", i, diagnosis->scene->light_count));
    }
    return ALP_OK;
}
