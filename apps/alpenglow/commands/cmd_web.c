// SPDX-License-Identifier: MIT
// alpenglow web: a baked scene as one HTML file, which needs neither a server nor a network.
#include "commands/commands.h"
#include "output.h"
#include "printing/messages.h"
#include "programs.h"
#include "web/web_report.h"
#include "web/web_scene.h"

#include <alpenglow/alpenglow.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// The place of the scene in the page.
static const char mark[] = "<!-- alpenglow: scene -->";

static int check_names(const command_line *a)
{
    const char *input = a->operands[0], *output = a->values[OPTION_OUTPUT].text;
    if (output == NULL) {
        return usage_error(COMMAND_WEB, "-o OUT.html is missing: the name of the page");
    }
    if (!path_ends(output, ".html") && !path_ends(output, ".htm")) {
        return usage_error(COMMAND_WEB, "-o %s: the name must end in .html", output);
    }
    if (output_is_same(output, input)) {
        return usage_error(COMMAND_WEB, "-o %s: is BAKED itself; name another file", output);
    }
    if (!path_ends(input, ".glb") && !path_ends(input, ".gltf")) {
        return usage_error(COMMAND_WEB,
                           "%s: a page holds a .glb or a .gltf; bake into one, as in alpenglow "
                           "bake SCENE -o baked.glb",
                           input);
    }
    const int code = web_report_check(a);
    return code == EXIT_DONE ? output_check(output, a->values[OPTION_FORCE].given) : code;
}

/// The page without a scene, which the build assembled. NULL after a message. @return malloc'ed
static char *read_page(void)
{
    char path[PROGRAM_PATH_SIZE];
    if (!file_find_beside("web", "page.html", path) &&
        !file_find_beside(ALP_WEB_FOLDER, "page.html", path)) {
        failure("the page of three.js is missing: this alpenglow was built without it; run npm ci "
                "--prefix web/viewer in its sources, then configure, build and install again");
        return NULL;
    }
    size_t size = 0;
    char *page = web_read_file(path, &size);
    if (page != NULL && (strlen(page) != size || strstr(page, mark) == NULL)) {
        failure("web/page.html is damaged; build or install alpenglow again");
        free(page);
        page = NULL;
    }
    return page;
}

/// Finds the bounds of the scene, and the camera that render takes for a square picture.
static alp_result measure_scene(const alp_scene *scene, web_scene *out)
{
    const alp_scene_info info = alp_scene_get_info(scene);
    alp_render_options options = alp_render_options_default();
    options.width = options.height = 512;
    alp_camera camera;
    const alp_result result = alp_render_find_camera(scene, &options, &camera);
    for (int k = 0; k < 3 && result == ALP_OK; k++) {
        out->bounds[0][k] = info.origin[k] + (double)info.bounds_min[k];
        out->bounds[1][k] = info.origin[k] + (double)info.bounds_max[k];
        out->eye[k] = info.origin[k] + (double)camera.position[k];
        out->target[k] = info.origin[k] + (double)camera.target[k];
        out->field_of_view = (double)camera.vertical_fov;
    }
    return result;
}

/// Mean of the light map of the scene over its surfaces, all channels. 0: it has none.
static double measure_light(const alp_scene *scene)
{
    alp_map_compare_options options = alp_map_compare_options_default();
    options.map = ALP_MAP_LIGHT;
    options.points = 16384;
    alp_map_difference same = {0};
    const alp_result result = alp_scene_compare_maps(scene, scene, &options, &same);
    return result == ALP_OK ? same.mean_first : 0.0;
}

/// Loads the scene as all commands do, so that faults have the same messages.
static int check_scene(const command_line *a, web_scene *out)
{
    alp_scene *scene = NULL;
    int code = web_scene_end(out, alp_scene_load(out->context, a->operands[0], &scene));
    code = code == EXIT_DONE ? web_scene_end(out, measure_scene(scene, out)) : code;
    if (code == EXIT_DONE && a->values[OPTION_MAPS_FOLDER].given) {
        out->light = measure_light(scene);
    }
    alp_scene_destroy(scene);
    return code;
}

static int write_page(const char *page, const web_scene *scene, const command_line *a)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (stream == NULL) {
        return failure("out of memory");
    }
    const char *at = strstr(page, mark);
    fwrite(page, 1, (size_t)(at - page), stream);
    web_scene_write(stream, scene);
    fputs(at + strlen(mark), stream);
    const bool good = ferror(stream) == 0;
    const bool closed = fclose(stream) == 0;
    const char *output = a->values[OPTION_OUTPUT].text;
    const int code = good && closed ? output_write_text(text, output, a->values[OPTION_FORCE].given)
                                    : failure("out of memory");
    if (code == EXIT_DONE && !a->values[OPTION_QUIET].given) {
        print_clean(stdout, output);
        printf(": %.1f MB, %.1f MB of it the scene\n", 1e-6 * (double)size,
               1e-6 * (double)(size - strlen(page)));
    }
    free(text);
    return code;
}

/// Reads all that the page holds.
static int read_scene(const command_line *a, message_log *messages, web_scene *scene)
{
    const option_value *values = a->values;
    int code = check_scene(a, scene);
    code = code == EXIT_DONE ? web_scene_read(scene, a->operands[0], messages) : code;
    if (code == EXIT_DONE && values[OPTION_MAPS_FOLDER].given) {
        code = web_scene_read_layers(scene, values[OPTION_MAPS_FOLDER].text, messages);
    }
    if (code == EXIT_DONE && values[OPTION_PROBES].given) {
        code = web_scene_read_probes(scene, values[OPTION_PROBES].text, messages);
    }
    if (code == EXIT_DONE && values[OPTION_VOLUME].given) {
        code = web_scene_read_volume(scene, values[OPTION_VOLUME].text, messages);
    }
    return code;
}

static int run(const command_line *a, message_log *messages)
{
    web_scene scene = {0};
    alp_context_options options = alp_context_options_default();
    options.log = messages_log;
    options.log_user = messages;
    if (alp_context_create(&options, &scene.context) != ALP_OK) {
        return failure("out of memory");
    }
    alp_context *context = scene.context;
    char *page = read_page();
    int code = page != NULL ? read_scene(a, messages, &scene) : EXIT_FAILED;
    if (code == EXIT_DONE) {
        web_report_compare(a, &scene, messages);
    }
    code = code == EXIT_DONE ? write_page(page, &scene, a) : code;
    code = code == EXIT_DONE ? web_report_write(a) : code;
    web_scene_release(&scene);
    alp_context_destroy(context);
    free(page);
    return code;
}

int command_web(const command_line *arguments)
{
    int code = check_names(arguments);
    if (code != EXIT_DONE) {
        return code;
    }
    message_log messages = {.quiet = arguments->values[OPTION_QUIET].given};
    code = run(arguments, &messages);
    messages_flush(&messages);
    messages_release(&messages);
    return code;
}
