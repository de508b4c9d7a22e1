// SPDX-License-Identifier: MIT
// alpenglow sh: nine spherical harmonics of an environment, and its irradiance as an image.
#include "commands/commands.h"
#include "output.h"
#include "printing/messages.h"
#include "sh_values.h"

#include <alpenglow/alpenglow.h>

enum { MAP_WIDTH = 256 };

typedef struct projection {
    alp_context *context;
    alp_image *environment, *irradiance, *display;
    alp_sh9 radiance;
} projection;

static int check_output(const command_line *a)
{
    const char *output = a->values[OPTION_OUTPUT].text;
    if (output == NULL) {
        return EXIT_DONE;
    }
    if (!path_ends(output, ".hdr") && !path_ends(output, ".exr") && !path_ends(output, ".png")) {
        return usage_error(COMMAND_SH, "-o %s: the name must end in .hdr, .exr or .png", output);
    }
    if (output_is_same(output, a->operands[0])) {
        return usage_error(COMMAND_SH, "-o %s: is ENV itself; name another file", output);
    }
    return output_check(output, a->values[OPTION_FORCE].given);
}

/// Checks the environment, so that messages name its file.
static int check_environment(const char *path, const alp_image *image)
{
    const alp_image_info info = alp_image_get_info(image);
    char text[1024] = "";
    if (info.component != ALP_COMPONENT_FLOAT) {
        snprintf(text, sizeof text,
                 "%.700s: has 8 bits per channel, whatever its name, which cannot hold radiance;"
                 " give a float image (Radiance .hdr, OpenEXR)",
                 path);
    } else if (info.channels < 3) {
        snprintf(text, sizeof text, "%.700s: has %u channel%s; an environment needs R, G and B",
                 path, info.channels, plural(info.channels));
    } else if (info.width != 2 * info.height) {
        snprintf(text, sizeof text,
                 "%.700s: has %u x %u pixels; an environment is equirectangular, twice as wide as "
                 "high",
                 path, info.width, info.height);
    }
    return text[0] == '\0' ? EXIT_DONE : failure(text);
}

static alp_result write_map(projection *p, const char *path, bool overwrite)
{
    alp_result result = alp_sh_irradiance_image(p->context, &p->radiance, ALP_SH_CLAMPED, MAP_WIDTH,
                                                &p->irradiance);
    if (result == ALP_OK && path_ends(path, ".png")) {
        const alp_film_options film = alp_render_film_options(ALP_RENDER_REFERENCE);
        result = alp_film_develop(p->irradiance, &film, &p->display, NULL);
    }
    return result == ALP_OK
               ? alp_image_save(p->display != NULL ? p->display : p->irradiance, path, overwrite)
               : result;
}

static int run(projection *p, const command_line *a)
{
    const char *output = a->values[OPTION_OUTPUT].text;
    alp_result result = alp_image_load(p->context, a->operands[0], &p->environment);
    if (result == ALP_OK) {
        const int code = check_environment(a->operands[0], p->environment);
        if (code != EXIT_DONE) {
            return code;
        }
        result = alp_sh_project_image(p->environment, &p->radiance);
    }
    if (result == ALP_OK && output != NULL) {
        result = write_map(p, output, a->values[OPTION_FORCE].given);
    }
    if (result == ALP_OK) {
        result =
            sh_values_print(&p->radiance, (alp_sh_convention)a->values[OPTION_CONVENTION].choice);
    }
    return result == ALP_OK ? EXIT_DONE : failure(alp_context_message(p->context));
}

int command_sh(const command_line *arguments)
{
    int code = check_output(arguments);
    if (code != EXIT_DONE) {
        return code;
    }
    message_log messages = {0};
    projection p = {0};
    alp_context_options options = alp_context_options_default();
    options.log = messages_log;
    options.log_user = &messages;
    code = alp_context_create(&options, &p.context) == ALP_OK ? run(&p, arguments)
                                                              : failure("out of memory");
    alp_image_destroy(p.environment);
    alp_image_destroy(p.irradiance);
    alp_image_destroy(p.display);
    alp_context_destroy(p.context);
    messages_flush(&messages);
    messages_release(&messages);
    return code;
}
