// SPDX-License-Identifier: MIT
#include "setup/lamps.h"

#include <math.h>

bool color_set(const double numbers[3], float color[3])
{
    bool positive = true;
    for (int k = 0; k < 3; k++) {
        positive = positive && numbers[k] >= 0.0;
        color[k] = (float)numbers[k];
    }
    return positive;
}

/// Reads `count` numbers, and three more for an optional colour.
static bool read_numbers(const char *text, double *numbers, int count, float color[3])
{
    double rgb[3];
    const char *end = number_parse_list(text, numbers, count);
    if (end != NULL && *end == ',') {
        end = number_parse_list(end + 1, rgb, 3);
        if (end != NULL && !color_set(rgb, color)) {
            return false;
        }
    }
    return end != NULL && *end == '\0';
}

/// A point in the world of the file as one of the scene.
static void place(const double at[3], const double origin[3], float position[3])
{
    for (int k = 0; k < 3; k++) {
        position[k] = (float)(at[k] - origin[k]);
    }
}

static int read_lamp(const command_line *a, const char *text, const double origin[3],
                     alp_lamp *lamp)
{
    double numbers[4]; // X, Y, Z, CANDELA
    if (!read_numbers(text, numbers, 4, lamp->color) || numbers[3] < 0.0) {
        return usage_error(a->command,
                           "--lamp: '%s' is not a lamp; give X,Y,Z,CANDELA, such as "
                           "--lamp 0,2,0,100, or X,Y,Z,CANDELA,R,G,B: metres, -1e9 to 1e9, candela "
                           "and linear colour,"
                           " 0 to 1e9",
                           text);
    }
    place(numbers, origin, lamp->position);
    lamp->intensity = (float)numbers[3];
    return EXIT_DONE;
}

/// Unit vector towards the target. @return false: the target is the lamp's position
static bool aim(const double from[3], const double target[3], float direction[3])
{
    const double to[3] = {target[0] - from[0], target[1] - from[1], target[2] - from[2]};
    const double length = sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
    for (int k = 0; k < 3; k++) {
        direction[k] = length > 0.0 ? (float)(to[k] / length) : 0.0f;
    }
    return length > 0.0;
}

static int read_spot(const command_line *a, const char *text, const double origin[3],
                     alp_lamp *lamp)
{
    const double radians = M_PI / 180.0;
    double numbers[9]; // X, Y, Z, TX, TY, TZ, CANDELA, INNER, OUTER
    bool good = read_numbers(text, numbers, 9, lamp->color) && numbers[6] >= 0.0 &&
                numbers[7] >= 0.0 && numbers[8] <= 90.0 &&
                aim(numbers, numbers + 3, lamp->direction);
    if (good) {
        lamp->inner_cone = (float)(numbers[7] * radians);
        lamp->outer_cone = (float)(numbers[8] * radians);
        good = lamp->inner_cone < lamp->outer_cone; // as floats, which may be equal
    }
    if (!good) {
        return usage_error(a->command,
                           "--spot: '%s' is not a spot; give X,Y,Z,TX,TY,TZ,CANDELA,INNER,OUTER,"
                           " and R,G,B if it is not white: position and another point as target "
                           "in metres, -1e9 to 1e9, candela and linear colour, 0 to 1e9, and "
                           "degrees from the axis, 0 to 90, INNER below OUTER",
                           text);
    }
    lamp->kind = ALP_LIGHT_SPOT;
    place(numbers, origin, lamp->position);
    lamp->intensity = (float)numbers[6];
    return EXIT_DONE;
}

int lamps_read(const command_line *a, const double origin[3], lamp_list *list)
{
    list->count = 0;
    int code = EXIT_DONE;
    for (int i = 0; i < a->repeated_count && code == EXIT_DONE; i++) {
        const option_id id = a->repeated[i].id;
        if (id == OPTION_LAMP || id == OPTION_SPOT) {
            alp_lamp *lamp = &list->lamps[list->count++];
            *lamp = alp_lamp_default();
            code = id == OPTION_LAMP ? read_lamp(a, a->repeated[i].text, origin, lamp)
                                     : read_spot(a, a->repeated[i].text, origin, lamp);
        }
    }
    return code;
}
