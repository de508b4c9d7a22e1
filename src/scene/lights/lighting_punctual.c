// SPDX-License-Identifier: MIT
// Lights without extent, as KHR_lights_punctual tells
// (https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_lights_punctual).
#include "scene/lights/lighting_punctual.h"

#include "base/memory.h"
#include "scene/double3.h"

/// Up to here every light is asked what it gives, which is exact; more go into a tree.
enum { LIST_LIMIT = 16 };

// --- one light -----------------------------------------------------------------------------------

/// The spot's fall-off by the cosine between its axis and the way to the point.
static double spot_falloff(const alpi_light *light, double cosine)
{
    double inner = cos((double)light->inner_cone), outer = cos((double)light->outer_cone);
    double ramp = (cosine - outer) / fmax(0.001, inner - outer);
    ramp = fmin(fmax(ramp, 0.0), 1.0);
    return ramp * ramp;
}

/// The range is a hint where light has ended; the window reaches 0 there without an edge.
static double range_window(double range, double distance)
{
    double t = distance / range;
    return isfinite(range) ? fmin(fmax(1.0 - t * t * t * t, 0.0), 1.0) : 1.0;
}

bool alpi_punctual_at(const alpi_light *light, vec3 point, alpi_punctual_light *at)
{
    double strength = (double)light->intensity;
    if (light->kind == ALP_LIGHT_DIRECTIONAL) {
        at->direction = vec3_scale(light->direction, -1.0f);
        at->distance = INFINITY;
    } else {
        double3 to = double3_between(point, light->position);
        double distance = double3_length(to);
        double3 unit = double3_unit(to);
        at->direction = double3_to_vec3(unit);
        at->distance = (float)distance;
        strength /= distance * distance;
        strength *= range_window((double)light->range, distance);
        if (light->kind == ALP_LIGHT_SPOT) {
            strength *= spot_falloff(light, -double3_dot(unit, double3_from(light->direction)));
        }
    }
    at->light = (vec3){(float)(strength * (double)light->color.x),
                       (float)(strength * (double)light->color.y),
                       (float)(strength * (double)light->color.z)};
    return vec3_is_finite(at->light) &&
           (at->light.x > 0.0f || at->light.y > 0.0f || at->light.z > 0.0f);
}

/// What it gives on a surface, mean of the channels.
static double irradiance(const alpi_light *light, vec3 point, vec3 normal)
{
    alpi_punctual_light at;
    if (!alpi_punctual_at(light, point, &at)) {
        return 0.0;
    }
    double cosine = fmax((double)vec3_dot(at.direction, normal), 0.0);
    return cosine * ((double)at.light.x + (double)at.light.y + (double)at.light.z) / 3.0;
}

// --- all of them ---------------------------------------------------------------------------------

static alpi_light_bound bound_light(const alpi_light *light)
{
    bool spot = light->kind == ALP_LIGHT_SPOT;
    double color = (double)light->color.x + (double)light->color.y + (double)light->color.z;
    return (alpi_light_bound){.low = light->position,
                              .high = light->position,
                              .axis = spot ? light->direction : (vec3){0.0f, 1.0f, 0.0f},
                              .cone = spot ? light->inner_cone : (float)ALPI_PI,
                              .reach = spot ? fmaxf(light->outer_cone - light->inner_cone, 0.0f)
                                            : (float)(ALPI_PI / 2.0),
                              .power = (double)light->intensity * color / 3.0};
}

static alp_result make_tree(alp_context *context, alpi_punctual *punctual)
{
    alpi_light_bound *bounds = ALPI_NEW(context, alpi_light_bound, punctual->placed_count);
    if (bounds == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < punctual->placed_count; i++) {
        bounds[i] = bound_light(&punctual->lights[punctual->placed[i]]);
    }
    alp_result result =
        alpi_light_tree_create(context, bounds, punctual->placed_count, &punctual->tree);
    alpi_release(context, bounds);
    return result;
}

alp_result alpi_punctual_collect(alp_context *context, const alpi_light *lights,
                                 const uint32_t *indices, uint32_t count, alpi_punctual *punctual)
{
    *punctual = (alpi_punctual){.lights = lights};
    ALPI_TRY_NEW(context, punctual->list, count);
    ALPI_TRY_NEW(context, punctual->placed, count);
    uint32_t places = 0;
    for (uint32_t i = 0; i < count; i++) {
        places += alp_light_traits_of(lights[indices[i]].kind).has_position;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (places > LIST_LIMIT && alp_light_traits_of(lights[indices[i]].kind).has_position) {
            punctual->placed[punctual->placed_count++] = indices[i];
        } else {
            punctual->list[punctual->listed++] = indices[i];
        }
    }
    return punctual->placed_count > 0 ? make_tree(context, punctual) : ALP_OK;
}

void alpi_punctual_clear(alp_context *context, alpi_punctual *punctual)
{
    alpi_light_tree_destroy(context, punctual->tree);
    alpi_release(context, punctual->list);
    alpi_release(context, punctual->placed);
    *punctual = (alpi_punctual){0};
}

static double tree_importance(const alpi_punctual *punctual, vec3 point, vec3 normal)
{
    return punctual->tree == NULL ? 0.0 : alpi_light_tree_importance(punctual->tree, point, normal);
}

double alpi_punctual_importance(const alpi_punctual *punctual, vec3 point, vec3 normal)
{
    double sum = tree_importance(punctual, point, normal);
    for (uint32_t i = 0; i < punctual->listed; i++) {
        sum += irradiance(&punctual->lights[punctual->list[i]], point, normal);
    }
    return sum;
}

double alpi_punctual_sample(const alpi_punctual *punctual, vec3 point, vec3 normal, double pick,
                            uint32_t *light)
{
    double sum = alpi_punctual_importance(punctual, point, normal);
    double rest = pick * sum, chosen = 0.0;
    for (uint32_t i = 0; i < punctual->listed; i++) {
        double one = irradiance(&punctual->lights[punctual->list[i]], point, normal);
        if (one > 0.0) {
            chosen = one;
            *light = punctual->list[i];
            if (rest < one) {
                return one / sum;
            }
            rest -= one;
        }
    }
    double tree = tree_importance(punctual, point, normal);
    if (!(tree > 0.0)) { // rounding may lead past the last one
        return chosen > 0.0 ? chosen / sum : 0.0;
    }
    uint32_t place;
    double part = alpi_light_tree_sample(punctual->tree, point, normal,
                                         fmin(fmax(rest / tree, 0.0), 1.0 - 0x1p-53), &place);
    if (part > 0.0) {
        *light = punctual->placed[place];
    }
    return part * (tree / sum);
}
