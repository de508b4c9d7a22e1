// SPDX-License-Identifier: MIT
#include "view_options.h"

#include "output.h"
#include "setup/cameras.h"
#include "setup/film.h"
#include "setup/lighting.h"
#include "setup/objects.h"
#include "view_capture.h"
#include "views.h"

#include <string.h>

/// Kinds of output.
enum { PICTURE = 1, FLIGHT = 2, CAPTURE = 4 };

/// @return 0 after a message
static unsigned find_output(const command_line *a)
{
    const option_value *v = a->values;
    const unsigned given = (v[OPTION_OUTPUT].given ? PICTURE : 0u) |
                           (v[OPTION_PICTURES].given ? FLIGHT : 0u) |
                           (v[OPTION_CAPTURE].given ? CAPTURE : 0u);
    if (given == 0) {
        (void)usage_error(COMMAND_VIEW, "no output; give -o IMAGE.png for a picture, --path "
                                        "FLIGHT.csv --pictures DIR for a flight, or --capture "
                                        "X,Y,Z");
    } else if ((given & (given - 1)) != 0) {
        (void)usage_error(COMMAND_VIEW, "%s are two outputs; give one",
                          (given & CAPTURE) == 0   ? "-o and --pictures"
                          : (given & PICTURE) != 0 ? "-o and --capture"
                                                   : "--pictures and --capture");
        return 0;
    }
    return given;
}

/// Refuses outputs that are missing, and options of other kinds of output.
static int check_output(const command_line *a)
{
    static const struct {
        const char *name;
        option_id id;
        unsigned outputs;
    } read_by[] = {{"--frames", OPTION_FRAMES, FLIGHT},
                   {"--time", OPTION_TIME, PICTURE},
                   {"--path", OPTION_PATH, FLIGHT},
                   {"--object-path", OPTION_OBJECT_PATH, FLIGHT},
                   {"--camera", OPTION_CAMERA, PICTURE},
                   {"--resolution", OPTION_RESOLUTION, PICTURE | FLIGHT},
                   {"--exposure", OPTION_EXPOSURE, PICTURE | FLIGHT},
                   {"--tone", OPTION_TONE, PICTURE | FLIGHT},
                   {"--white-balance", OPTION_WHITE_BALANCE, PICTURE | FLIGHT},
                   {"--force", OPTION_FORCE, PICTURE | FLIGHT},
                   {"--convention", OPTION_CONVENTION, CAPTURE},
                   {"--beside", OPTION_BESIDE, PICTURE | FLIGHT},
                   {"--divider", OPTION_DIVIDER, PICTURE | FLIGHT},
                   {"--ssao", OPTION_SSAO, PICTURE | FLIGHT},
                   {"--ssao-radius", OPTION_SSAO_RADIUS, PICTURE | FLIGHT},
                   {"--reference", OPTION_REFERENCE, PICTURE},
                   {"--reference-threshold", OPTION_REFERENCE_THRESHOLD, PICTURE}};
    const option_value *v = a->values;
    const unsigned output = find_output(a);
    const bool frames = output == FLIGHT;
    const bool flies =
        v[OPTION_WITH].given && view_mode_flies(a); // the light, before a picture too
    for (size_t i = 0; i < sizeof read_by / sizeof *read_by && output != 0; i++) {
        const bool shared = read_by[i].id == OPTION_PATH && flies;
        if (v[read_by[i].id].given && (read_by[i].outputs & output) == 0 && !shared) {
            return usage_error(COMMAND_VIEW, "%s: does not apply to %s", read_by[i].name,
                               frames              ? "--pictures"
                               : output == PICTURE ? "-o"
                                                   : "--capture");
        }
    }
    if (frames && !v[OPTION_PATH].given && !flies) {
        return usage_error(COMMAND_VIEW, "no flight; give --path FLIGHT.csv, lines of "
                                         "t,px,py,pz,tx,ty,tz[,vfov]");
    }
    return output != 0 ? EXIT_DONE : EXIT_USAGE;
}

static int check_image(const command_line *a)
{
    const char *output = a->values[OPTION_OUTPUT].text;
    if (output == NULL || path_ends(output, ".png")) {
        return EXIT_DONE;
    }
    if (!path_ends(output, ".exr") && !path_ends(output, ".hdr")) {
        return usage_error(COMMAND_VIEW, "-o %s: the name must end in .png, .exr or .hdr", output);
    }
    return film_refuse(a, output);
}

/// Refuses options that need another one.
static int check_needs(const command_line *a)
{
    if (a->values[OPTION_REFERENCE_THRESHOLD].given && !a->values[OPTION_REFERENCE].given) {
        return usage_error(COMMAND_VIEW, "--reference-threshold: needs --reference IMAGE");
    }
    if (a->values[OPTION_DIVIDER].given && !a->values[OPTION_BESIDE].given) {
        return usage_error(COMMAND_VIEW, "--divider: needs --beside MODE");
    }
    if (a->values[OPTION_SSAO_RADIUS].given && a->values[OPTION_SSAO].choice == 0) {
        return usage_error(COMMAND_VIEW, "--ssao-radius: needs --ssao on");
    }
    return EXIT_DONE;
}

/// --object and its path.
static int check_object(const command_line *a, alp_render_object *object)
{
    const option_value *path = &a->values[OPTION_OBJECT_PATH];
    if (path->given && !a->values[OPTION_OBJECT].given) {
        return usage_error(COMMAND_VIEW, "--object-path: needs --object");
    }
    if (path->given && strcmp(path->text, "-") == 0 && a->values[OPTION_PATH].given &&
        strcmp(a->values[OPTION_PATH].text, "-") == 0) {
        return usage_error(COMMAND_VIEW, "--path and --object-path: both are standard input; give "
                                         "a file for one");
    }
    return object_read(a, (const double[3]){0.0, 0.0, 0.0}, object);
}

static int read_light(const command_line *a, view_settings *s)
{
    alp_render_options *o = &s->render;
    *o = alp_render_options_default();
    o->method = s->mode->method;
    o->atlas.size = (uint32_t)a->values[OPTION_SIZE].whole;
    o->occluders = a->values[OPTION_OCCLUDERS].text;
    o->bounces = lighting_bounces(a);
    const int code = occlusion_read(a, &o->occlusion);
    return code == EXIT_DONE ? lighting_read(a, &o->lighting, &s->lamps) : code;
}

int view_settings_read(const command_line *a, view_settings *s)
{
    *s = (view_settings){0};
    int code = check_output(a);
    code = code == EXIT_DONE ? check_image(a) : code;
    code = code == EXIT_DONE ? check_needs(a) : code;
    if (code == EXIT_DONE && !a->values[OPTION_WITH].given) {
        code = usage_error(COMMAND_VIEW, "no mode; give --with lightmap, direct, hemisphere "
                                         "or another");
    }
    code = code == EXIT_DONE ? view_mode_check(a) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    s->mode = view_mode_of(a);
    code = read_light(a, s);
    if (code == EXIT_DONE) {
        code = resolution_read(a, &s->render.width, &s->render.height);
    }
    if (code == EXIT_DONE) {
        code = camera_read(a, (const double[3]){0.0, 0.0, 0.0}, &s->render);
    }
    if (code == EXIT_DONE && a->values[OPTION_CAPTURE].given) {
        if ((s->mode->uses & USES_PATHS) != 0) {
            return usage_error(COMMAND_VIEW, "--capture: does not apply to --with %s",
                               a->values[OPTION_WITH].text);
        }
        float point[3];
        s->render.width = s->render.height = CAPTURE_SIDE;
        code = capture_read(a, (const double[3]){0.0, 0.0, 0.0}, point);
    }
    code = code == EXIT_DONE ? check_object(a, &s->render.object) : code;
    s->film = film_read(a, s->mode->method);
    if (code == EXIT_DONE && a->values[OPTION_OUTPUT].given) {
        code = output_check(a->values[OPTION_OUTPUT].text, a->values[OPTION_FORCE].given);
    }
    return code;
}
