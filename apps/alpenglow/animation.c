// SPDX-License-Identifier: MIT
#include "animation.h"

#include <stdio.h>
#include <string.h>

/// Number of animations that a message lists.
enum { LISTED = 8 };

bool animation_is_none(const command_line *a)
{
    return strcmp(a->values[OPTION_ANIMATION].text, "none") == 0;
}

int animation_check(const command_line *a)
{
    const option_value *v = a->values;
    const bool timed = v[OPTION_ANIMATION_TIME].given, flown = v[OPTION_PICTURES].given;
    if (a->command == COMMAND_VIEW && flown) {
        return timed && animation_is_none(a)
                   ? usage_error(a->command, "--animation none: leave out --animation-time")
                   : EXIT_DONE;
    }
    if (v[OPTION_ANIMATION].given && animation_is_none(a)) {
        return usage_error(a->command, "--animation none: applies to the flights of view alone");
    }
    return v[OPTION_ANIMATION].given && !timed
               ? usage_error(a->command, "--animation: needs --animation-time")
               : EXIT_DONE;
}

/// Prints the animations that there are.
static int refuse(const session *s, const command_line *a, uint32_t count)
{
    char text[1024];
    size_t used = (size_t)snprintf(text, sizeof text, "%.300s: has no animation \"%.100s\"; %s",
                                   a->operands[0], a->values[OPTION_ANIMATION].text,
                                   count > 0 ? "there are " : "it has none");
    for (uint32_t i = 0; i < count && i < LISTED && used < sizeof text; i++) {
        const char *name = alp_scene_get_animation(s->scene, i).name;
        const char *quote = name[0] != '\0' ? "\"" : "";
        used +=
            (size_t)snprintf(text + used, sizeof text - used, "%s%u%s%s%.40s%s", i > 0 ? ", " : "",
                             i, name[0] != '\0' ? " " : "", quote, name, quote);
    }
    if (count > LISTED && used < sizeof text) {
        snprintf(text + used, sizeof text - used, " and %u more", count - LISTED);
    }
    return failure(text);
}

int animation_find(const session *s, const command_line *a, uint32_t *animation)
{
    *animation = alp_scene_find_animation(s->scene, a->values[OPTION_ANIMATION].text);
    return *animation != ALP_NONE ? EXIT_DONE
                                  : refuse(s, a, alp_scene_get_info(s->scene).animations);
}

int animation_pose(session *s, const command_line *a)
{
    const option_value *time = &a->values[OPTION_ANIMATION_TIME];
    uint32_t animation;
    if (!time->given) {
        return EXIT_DONE;
    }
    const int code = animation_find(s, a, &animation);
    if (code != EXIT_DONE) {
        return code;
    }
    alp_scene *posed = NULL;
    const alp_result result = alp_scene_pose(s->scene, animation, time->real, &posed);
    if (result != ALP_OK) {
        return session_end(s, result);
    }
    alp_scene_destroy(s->scene);
    s->scene = posed;
    return EXIT_DONE;
}
