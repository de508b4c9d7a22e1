// SPDX-License-Identifier: MIT
#include "setup/lighting.h"

#include "interrupt.h"
#include "output.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// "R,G,B", or one number for all three. @return the end, or NULL
static const char *read_color(const char *text, double color[3])
{
    const char *end = number_parse_list(text, color, 3);
    if (end == NULL) {
        end = number_parse_list(text, color, 1);
        color[1] = color[2] = color[0];
    }
    return end;
}

/// One colour, or two with a slash between. @return false: neither
static bool read_colors(const char *text, alp_sky_options *sky)
{
    double up[3], down[3];
    const char *end = read_color(text, up);
    if (end == NULL || !color_set(up, sky->up)) {
        return false;
    }
    sky->kind = ALP_SKY_CONSTANT;
    if (*end == '/') {
        sky->kind = ALP_SKY_HEMISPHERE;
        end = read_color(end + 1, down);
        if (end == NULL || !color_set(down, sky->down)) {
            return false;
        }
    }
    return *end == '\0';
}

static bool names_picture(const char *text)
{
    return path_ends(text, ".hdr") || path_ends(text, ".exr");
}

static int read_sky(const command_line *a, alp_sky_options *sky)
{
    const option_value *value = &a->values[OPTION_SKY];
    const double radians = M_PI / 180.0;
    sky->turn = (float)(a->values[OPTION_SKY_TURN].real * radians);
    sky->strength = (float)a->values[OPTION_SKY_STRENGTH].real;
    if (!value->given) {
        if (a->values[OPTION_SKY_TURN].given || a->values[OPTION_SKY_STRENGTH].given) {
            return usage_error(a->command, "--sky-turn and --sky-strength need a --sky");
        }
        return EXIT_DONE;
    }
    if (strcmp(value->text, "clear") == 0) {
        sky->kind = ALP_SKY_CLEAR;
        if (!a->values[OPTION_SUN].given) {
            return usage_error(a->command,
                               "--sky clear: needs a sun; give --sun AZ,EL,LUX, such as "
                               "--sun 150,40,60000");
        }
    } else if (names_picture(value->text)) {
        sky->kind = ALP_SKY_IMAGE;
    } else if (!read_colors(value->text, sky)) {
        return usage_error(a->command,
                           "--sky: '%s' is not a sky; give --sky 1,1,1 or another R,G,B, one "
                           "number, R,G,B/R,G,B (above and below the horizon), numbers 0 to 1e9, "
                           "a .hdr or .exr file, or clear",
                           value->text);
    }
    if (sky->kind != ALP_SKY_IMAGE && a->values[OPTION_SKY_TURN].given) {
        return usage_error(a->command, "--sky-turn: needs a sky image; give --sky FILE.hdr");
    }
    return EXIT_DONE;
}

static int read_sun(const command_line *a, alp_sun_options *sun)
{
    const option_value *value = &a->values[OPTION_SUN];
    const double radians = M_PI / 180.0;
    double numbers[3];
    if (!value->given) {
        return EXIT_DONE;
    }
    const char *end = number_parse_list(value->text, numbers, 3);
    if (end == NULL || *end != '\0' || fabs(numbers[0]) > 360.0 || fabs(numbers[1]) > 90.0 ||
        numbers[2] < 0.0) {
        return usage_error(a->command,
                           "--sun: '%s' is not a sun; give AZ,EL,LUX, such as --sun "
                           "150,40,60000: degrees from +Z towards +X, degrees above the horizon, "
                           "and lux, 0 to 1e9",
                           value->text);
    }
    sun->azimuth = (float)(numbers[0] * radians);
    sun->elevation = (float)(numbers[1] * radians);
    sun->illuminance = (float)numbers[2];
    return EXIT_DONE;
}

int lighting_read(const command_line *a, alp_lighting_options *options, lamp_list *lamps)
{
    const double radians = M_PI / 180.0;
    *options = alp_lighting_options_default();
    int code = read_sky(a, &options->sky);
    if (code == EXIT_DONE) {
        code = read_sun(a, &options->sun);
    }
    if (code == EXIT_DONE) {
        code = lamps_read(a, (const double[3]){0.0, 0.0, 0.0}, lamps);
        options->lamps = lamps->lamps;
        options->lamp_count = lamps->count;
    }
    if (a->values[OPTION_SUN_SIZE].given) { // of all suns, those of the file too
        options->sun.size = (float)(a->values[OPTION_SUN_SIZE].real * radians);
        options->file_sun_size = options->sun.size;
    }
    return code;
}

/// Checks the sky's image, so that messages name its file.
static int check_picture(const char *path, const alp_image *image)
{
    const alp_image_info info = alp_image_get_info(image);
    char text[1024] = "";
    if (info.component != ALP_COMPONENT_FLOAT) {
        snprintf(text, sizeof text,
                 "%.700s: has 8 bits per channel, whatever its name, which cannot hold radiance;"
                 " give --sky a float image (Radiance .hdr, OpenEXR)",
                 path);
    } else if (info.channels < 3) {
        snprintf(text, sizeof text, "%.700s: has %u channel%s; a sky needs R, G and B", path,
                 info.channels, plural(info.channels));
    } else if (info.width != 2 * info.height) {
        snprintf(text, sizeof text,
                 "%.700s: has %u x %u pixels; a sky is equirectangular, twice as wide as high",
                 path, info.width, info.height);
    }
    return text[0] == '\0' ? EXIT_DONE : failure(text);
}

static int load_sky(session *s, const command_line *a, alp_lighting_options *options,
                    alp_image **image)
{
    if (options->sky.kind != ALP_SKY_IMAGE) {
        return EXIT_DONE;
    }
    const char *path = a->values[OPTION_SKY].text;
    const int code = session_end(s, alp_image_load(s->context, path, image));
    options->sky.image = *image;
    return code == EXIT_DONE ? check_picture(path, *image) : code;
}

/// Warns of a scene without triangles. bake refuses it.
static int warn_of_emptiness(session *s, const command_line *a)
{
    if (alp_scene_get_info(s->scene).triangles > 0 || a->command == COMMAND_BAKE) {
        return EXIT_DONE;
    }
    session_warn(s, "empty", a->operands[0], "it holds no triangles");
    return session_judge_warnings(s);
}

int lighting_open(session *s, const command_line *a, alp_lighting_options *options,
                  lamp_list *lamps, alp_image **sky)
{
    *sky = NULL;
    interrupt_install();
    int code = session_open(s, a);
    code = code == EXIT_DONE ? session_load(s, a) : code;
    code = code == EXIT_DONE ? warn_of_emptiness(s, a) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    const alp_scene_info info = alp_scene_get_info(s->scene);
    (void)lamps_read(a, info.origin, lamps); // lighting_read found no fault in them
    return load_sky(s, a, options, sky);
}

int error_read(const command_line *a, float *error)
{
    static const float of_quality[] = {0.04f, 0.01f, 0.004f};
    const option_value *quality = &a->values[OPTION_QUALITY], *wanted = &a->values[OPTION_ERROR];
    *error = quality->given  ? of_quality[quality->choice]
             : wanted->given ? (float)(wanted->real / 100.0)
                             : 0.0f;
    return quality->given && wanted->given
               ? usage_error(a->command, "--quality %s is --error %g; give one of them",
                             quality->text, 100.0 * (double)*error)
               : EXIT_DONE;
}

int error_check_light(const command_line *a, option_id samples)
{
    const option_value *values = a->values;
    const char *name = values[OPTION_QUALITY].given ? "--quality" : "--error";
    const int gather = values[OPTION_GATHER].choice;
    if (gather == (int)ALP_GATHER_HEMICUBE) {
        return usage_error(a->command,
                           "%s: not with --gather hemicube, which has no estimate of its error; "
                           "leave one of them out",
                           name);
    }
    if (values[samples].given) {
        return usage_error(a->command,
                           "%s: not with %s, which fixes the rays; leave one of them out", name,
                           option_name(a->command, samples));
    }
    if (gather == (int)ALP_GATHER_PATHS) {
        return usage_error(a->command,
                           "%s: not with --gather paths, whose number is fixed; give %s N instead",
                           name, option_name(a->command, samples));
    }
    const bool only = a->command == COMMAND_BAKE && values[OPTION_DIRECT].given &&
                      strcmp(values[OPTION_DIRECT].text, "only") == 0;
    if (only || lighting_bounces(a) == 0) {
        return usage_error(
            a->command, "%s: not with %s, whose samples are fixed; give %s N instead", name,
            only ? "--direct only" : "--bounces 0", option_name(a->command, samples));
    }
    return EXIT_DONE;
}

uint32_t lighting_bounces(const command_line *a)
{
    const option_value *value = &a->values[OPTION_BOUNCES];
    return value->choice >= 0 ? ALP_BOUNCES_CONVERGE : (uint32_t)value->whole;
}
