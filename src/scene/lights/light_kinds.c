// SPDX-License-Identifier: MIT
#include "scene/lights/light_kinds.h"

#include <string.h>

/// Names are those of KHR_lights_punctual and of COLLADA's elements.
static const alp_light_traits KINDS[] = {
    [ALP_LIGHT_POINT] = {.name = "point", .unit = "candela", .has_position = true},
    [ALP_LIGHT_SPOT] = {.name = "spot",
                        .unit = "candela",
                        .has_position = true,
                        .has_direction = true,
                        .has_cone = true},
    [ALP_LIGHT_DIRECTIONAL] = {.name = "directional",
                               .unit = "lux",
                               .has_direction = true,
                               .has_size = true},
};
enum { KIND_COUNT = sizeof KINDS / sizeof KINDS[0] };

alp_light_traits alp_light_traits_of(alp_light_kind kind)
{
    const alp_light_traits none = {.name = "", .unit = ""};
    return (unsigned)kind < KIND_COUNT ? KINDS[kind] : none;
}

bool alpi_light_kind_named(const char *name, alp_light_kind *kind)
{
    for (int i = 0; i < KIND_COUNT; i++) {
        if (strcmp(KINDS[i].name, name) == 0) {
            *kind = (alp_light_kind)i;
            return true;
        }
    }
    return false;
}

bool alpi_light_place(alpi_light *light, const mat4 *world)
{
    const vec3 none = {0.0f, 0.0f, 0.0f}, along = {0.0f, 0.0f, -1.0f};
    light->position = mat4_transform_point(world, none);
    light->direction = vec3_normalize_or(mat4_transform_direction(world, along), none);
    return vec3_is_finite(light->position) &&
           (!KINDS[light->kind].has_direction || vec3_length(light->direction) > 0.5f);
}
