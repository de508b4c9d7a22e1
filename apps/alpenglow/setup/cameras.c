// SPDX-License-Identifier: MIT
#include "setup/cameras.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CAMERA_NUMBERS = 7 };

static bool read_numbers(const char *text, double numbers[CAMERA_NUMBERS])
{
    const char *end = number_parse_list(text, numbers, CAMERA_NUMBERS);
    return end != NULL && *end == '\0';
}

/// @param origin of the scene in the world of its file
static bool place_camera(const double n[CAMERA_NUMBERS], const double origin[3], alp_camera *camera)
{
    double axis[3], length = 0.0;
    for (int i = 0; i < 3; i++) {
        camera->position[i] = (float)(n[i] - origin[i]);
        camera->target[i] = (float)(n[i + 3] - origin[i]);
        axis[i] = n[i + 3] - n[i];
        length += axis[i] * axis[i];
    }
    length = sqrt(length);
    // Looking straight up or down, +Y cannot be up.
    bool vertical = fabs(axis[1]) > 0.9999 * length;
    camera->up[0] = 0.0f;
    camera->up[1] = vertical ? 0.0f : 1.0f;
    camera->up[2] = vertical ? -1.0f : 0.0f;
    camera->vertical_fov = (float)(n[6] * (M_PI / 180.0));
    return length > 0.0 && n[6] >= 1e-3 && n[6] <= 179.0;
}

int camera_read(const command_line *a, const double origin[3], alp_render_options *o)
{
    const char *text = a->values[OPTION_CAMERA].text;
    uint64_t index = 0;
    double numbers[CAMERA_NUMBERS];
    number_result result = number_parse_whole(text, &index);
    if (strcmp(text, "auto") == 0) {
        o->camera_index = UINT32_MAX;
    } else if (result == NUMBER_OK && index < UINT32_MAX) {
        o->camera_index = (uint32_t)index;
    } else if (result != NUMBER_NONE || !read_numbers(text, numbers) ||
               !place_camera(numbers, origin, &o->camera)) {
        return usage_error(a->command,
                           "--camera: '%s' is not a camera; give a number from 0, auto, or "
                           "PX,PY,PZ,TX,TY,TZ,VFOV: position and another point as target in "
                           "metres, and VFOV 0.001 to 179 degrees",
                           text);
    }
    return EXIT_DONE;
}

int camera_find(const session *s, const command_line *a, alp_render_options *o)
{
    const alp_scene_info info = alp_scene_get_info(s->scene);
    const int code = camera_read(a, info.origin, o);
    if (code != EXIT_DONE) {
        return code;
    }
    uint32_t cameras = info.cameras;
    bool numbered = o->camera.vertical_fov <= 0.0f && o->camera_index != UINT32_MAX;
    if (a->values[OPTION_CAMERA].given && numbered && o->camera_index >= cameras) {
        char text[160];
        snprintf(text, sizeof text,
                 "--camera %u: the scene has %u camera%s, counted from 0; auto is a view of "
                 "everything",
                 o->camera_index, cameras, plural(cameras));
        return failure(text);
    }
    return EXIT_DONE;
}
