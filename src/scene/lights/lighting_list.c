// SPDX-License-Identifier: MIT
#include "scene/lights/lighting_list.h"

#include "base/memory.h"
#include "scene/lights/lighting_options.h"

#include <math.h>
#include <stdio.h>

static bool is_strength(float value)
{
    return value >= 0.0f && isfinite(value);
}

/// A scene made by hand may hold what readers refuse.
static bool light_is_sound(const alpi_light *light)
{
    const alp_light_traits traits = alp_light_traits_of(light->kind);
    bool aimed = !traits.has_direction || fabsf(vec3_length(light->direction) - 1) < 1e-3f;
    bool placed = !traits.has_position || vec3_is_finite(light->position);
    return aimed && placed && is_strength(light->intensity) && is_strength(light->color.x) &&
           is_strength(light->color.y) && is_strength(light->color.z);
}

static alp_result add_sun(alp_context *context, const alp_sun_options *sun, alpi_light_list *list)
{
    if (!(sun->illuminance > 0.0f)) {
        return ALP_OK;
    }
    list->sun_name = alpi_copy_string(context, "sun");
    if (list->sun_name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    list->lights[list->count++] =
        (alpi_light){.name = list->sun_name,
                     .kind = ALP_LIGHT_DIRECTIONAL,
                     .color = vec3_load(sun->color),
                     .intensity = sun->illuminance,
                     .direction = vec3_scale(alpi_sun_direction(sun), -1.0f),
                     .range = INFINITY,
                     .size = sun->size};
    return ALP_OK;
}

static alp_result add_lamps(alp_context *context, const alp_lighting_options *options,
                            alpi_light_list *list)
{
    if (options->lamp_count == 0) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(context, list->lamp_names, options->lamp_count);
    for (uint32_t i = 0; i < options->lamp_count; i++) {
        snprintf(list->lamp_names[i], ALPI_LAMP_NAME_SIZE, "lamp %u", i);
        list->lights[list->count++] = alpi_lamp_light(&options->lamps[i], list->lamp_names[i]);
    }
    return ALP_OK;
}

alp_result alpi_light_list_gather(const alp_scene *scene, const alp_lighting_options *options,
                                  alpi_light_list *list)
{
    ALPI_TRY_NEW(scene->context, list->lights,
                 (size_t)scene->light_count + options->lamp_count + 1);
    for (uint32_t i = 0; i < scene->light_count; i++) {
        alpi_light *light = &list->lights[i];
        *light = scene->lights[i];
        if (alp_light_traits_of(light->kind).has_size && !(light->size > 0.0f)) {
            light->size = options->file_sun_size;
        }
        if (!light_is_sound(light)) {
            alpi_warn(scene->context, "light", light->name,
                      "light %u is left out: a value is negative or not a number", i);
            light->intensity = 0.0f;
        }
    }
    list->count = scene->light_count;
    ALP_TRY(add_lamps(scene->context, options, list));
    return add_sun(scene->context, &options->sun, list);
}

void alpi_light_list_clear(alp_context *context, alpi_light_list *list)
{
    alpi_release(context, list->lights);
    alpi_release(context, list->lamp_names);
    alpi_release(context, list->sun_name);
}
