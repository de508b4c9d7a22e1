// SPDX-License-Identifier: MIT
// alp_scene_pose: a moment of an animation.
#include "formats/gltf/gltf_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

uint32_t alp_scene_find_animation(const alp_scene *scene, const char *choice)
{
    if (scene == NULL || choice == NULL) {
        return ALP_NONE;
    }
    for (uint32_t i = 0; i < scene->animation_count; i++) {
        if (choice[0] != '\0' && strcmp(scene->animations[i].name, choice) == 0) {
            return i;
        }
    }
    char *end;
    const unsigned long long number = strtoull(choice, &end, 10);
    const bool whole = choice[0] >= '0' && choice[0] <= '9' && *end == '\0';
    return whole && number < scene->animation_count ? (uint32_t)number : ALP_NONE;
}

alp_result alp_scene_pose(const alp_scene *scene, uint32_t animation, double seconds,
                          alp_scene **posed)
{
    if (posed != NULL) {
        *posed = NULL;
    }
    if (scene == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (posed == NULL || !isfinite(seconds)) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "alp_scene_pose needs finite seconds and an output pointer");
    }
    if (animation >= scene->animation_count) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "%s: has no animation %u; there are %u", scene->name, animation,
                         scene->animation_count);
    }
    return alpi_gltf_read_pose(scene, animation, seconds, posed);
}
