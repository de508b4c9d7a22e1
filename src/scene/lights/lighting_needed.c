// SPDX-License-Identifier: MIT
// Scenes that nothing lights: a warning, or a refusal.
#include "scene/lights/lighting.h"

void alpi_lighting_warn(const alp_scene *scene, const alpi_lighting *lighting)
{
    if (alpi_lighting_is_dark(lighting)) {
        alpi_warn(scene->context, "no-light", scene->name,
                  "there is no light: no lamp, no emissive material and no sky; give one (--sky,"
                  " --sun, --lamp)");
    }
}

static bool shines(float intensity, vec3 color)
{
    return intensity > 0.0f && (color.x > 0.0f || color.y > 0.0f || color.z > 0.0f);
}

/// Whether a lamp or a sun alone lights the scene.
static bool has_lamp(const alp_scene *scene, const alp_lighting_options *options)
{
    bool found = shines(options->sun.illuminance, vec3_load(options->sun.color));
    for (uint32_t i = 0; i < scene->light_count && !found; i++) {
        found = shines(scene->lights[i].intensity, scene->lights[i].color);
    }
    for (uint32_t i = 0; i < options->lamp_count && !found; i++) {
        found = shines(options->lamps[i].intensity, vec3_load(options->lamps[i].color));
    }
    return found;
}

alp_result alpi_lighting_refuse_darkness(const alp_scene *scene,
                                         const alp_lighting_options *options)
{
    if (has_lamp(scene, options)) {
        return ALP_OK;
    }
    alpi_lighting *lighting = NULL;
    ALP_TRY(alpi_lighting_create_quietly(scene, options, &lighting));
    const bool dark = alpi_lighting_is_dark(lighting);
    alpi_lighting_destroy(scene->context, lighting);
    return !dark ? ALP_OK
                 : alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                             "%s: nothing lights the scene: no lamp shines, no material emits and "
                             "there is no sky; add light, for example --sky 1,1,1",
                             scene->name);
}
