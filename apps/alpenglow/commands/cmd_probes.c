// SPDX-License-Identifier: MIT
// alpenglow probes: light probes of a scene.
#include "commands/commands.h"
#include "interrupt.h"
#include "output.h"
#include "setup/fields.h"
#include "setup/lighting.h"
#include "setup/points.h"

#include <stdlib.h>
#include <string.h>

static int check_options(const command_line *a)
{
    const char *output = a->values[OPTION_OUTPUT].text;
    if (output == NULL) {
        return usage_error(COMMAND_PROBES, "no output; give -o OUT.probes.json");
    }
    if (!path_ends(output, ".probes.json")) {
        return usage_error(COMMAND_PROBES, "-o %s: the name must end in .probes.json", output);
    }
    const bool seen =
        a->values[OPTION_VISIBILITY].given && a->values[OPTION_VISIBILITY].choice == 1;
    if (a->values[OPTION_AT].given && (a->values[OPTION_GRADIENTS].given || seen)) {
        return usage_error(COMMAND_PROBES, "%s: needs a grid; leave out --at",
                           seen ? "--visibility on" : "--gradients");
    }
    if (a->values[OPTION_LAYERS].given && a->values[OPTION_GRADIENTS].given) {
        return usage_error(COMMAND_PROBES, "--gradients: are of all light, which --layers parts; "
                                           "leave one out");
    }
    if (a->values[OPTION_EXPORT_SCALE].given && !a->values[OPTION_EXPORT].given) {
        return usage_error(COMMAND_PROBES, "--export-scale: needs --export three");
    }
    if (a->values[OPTION_EXPORT].given &&
        (a->values[OPTION_AT].given || a->values[OPTION_BASIS].choice == ALP_PROBE_AMBIENT_CUBE)) {
        return usage_error(COMMAND_PROBES, "--export three: needs a grid of spherical harmonics; "
                                           "leave out --at and --basis ambient-cube");
    }
    if (a->values[OPTION_AT].given &&
        (a->values[OPTION_SPACING].given || a->values[OPTION_BOUNDS].given)) {
        return usage_error(COMMAND_PROBES,
                           "--at gives the places; leave out --spacing and --bounds");
    }
    return EXIT_DONE;
}

static void print_summary(const char *output, const alp_probes *probes, double seconds)
{
    probes_print(probes);
    printf("wrote      ");
    print_clean(stdout, output);
    printf(", %.2f s\n", seconds);
}

/// A file beside the output: its name without .probes.json, and another ending.
static char *path_beside(const command_line *a, const char *ending)
{
    const char *output = a->values[OPTION_OUTPUT].text;
    const size_t stem = strlen(output) - strlen(".probes.json");
    const size_t size = stem + strlen(ending) + 1;
    char *path = allocate_or_exit(NULL, size);
    snprintf(path, size, "%.*s%s", (int)stem, output, ending);
    return path;
}

/// Whether all files can be written, before the long work.
static int check_outputs(const command_line *a)
{
    static const char *const endings[] = {".probes.json", ".probes.ktx2", ".probes.moments.ktx2",
                                          ".three.mjs", ".three.ktx2"};
    const int count = a->values[OPTION_EXPORT].given ? 5 : 3;
    int code = EXIT_DONE;
    for (int i = 0; i < count && code == EXIT_DONE; i++) {
        char *path = path_beside(a, endings[i]);
        code = output_check(path, a->values[OPTION_FORCE].given);
        free(path);
    }
    return code;
}

/// Writes NAME.three.mjs and .ktx2 beside NAME.probes.json.
static alp_result export_probes(const command_line *a, const alp_probes *probes)
{
    if (!a->values[OPTION_EXPORT].given) {
        return ALP_OK;
    }
    char *path = path_beside(a, ".three.mjs");
    const alp_result result = alp_probes_export_three(
        probes, path, a->values[OPTION_EXPORT_SCALE].real, a->values[OPTION_FORCE].given);
    free(path);
    return result;
}

static int bake(session *s, const command_line *a, alp_probe_options *o)
{
    const char *output = a->values[OPTION_OUTPUT].text;
    const double start = clock_seconds();
    alp_probes *probes = NULL;
    o->progress = session_progress;
    o->progress_user = s;
    interrupt_defer();
    alp_result result = alp_probes_bake(s->scene, o, &probes);
    if (result == ALP_OK && session_writes()) { // first, for it may be refused
        result = export_probes(a, probes);
    }
    if (result == ALP_OK && session_writes()) {
        result = alp_probes_save(probes, output, a->values[OPTION_FORCE].given);
    }
    const int code = session_end(s, result);
    if (code == EXIT_DONE && !a->values[OPTION_QUIET].given) {
        print_summary(output, probes, clock_seconds() - start);
    }
    alp_probes_destroy(probes);
    return code == EXIT_DONE ? session_judge_warnings(s) : code;
}

int command_probes(const command_line *a)
{
    alp_lighting_options lighting;
    alp_probe_options options;
    lamp_list lamps;
    point_list points = {0};
    alp_image *sky;
    session s;
    alp_scene_info info = {0};
    int code = check_options(a);
    code = code == EXIT_DONE ? lighting_read(a, &lighting, &lamps) : code;
    code = code == EXIT_DONE ? probe_options_read(a, &lighting, info.origin, &options) : code;
    if (code == EXIT_DONE) {
        code = check_outputs(a);
    }
    if (code != EXIT_DONE) {
        return code;
    }
    code = lighting_open(&s, a, &lighting, &lamps, &sky);
    if (code == EXIT_DONE) {
        info = alp_scene_get_info(s.scene);
    }
    if (code == EXIT_DONE && a->values[OPTION_AT].given) {
        code = points_read(a->values[OPTION_AT].text, false, info.origin, &points);
    }
    if (code == EXIT_DONE) { // again, with the sky and in the scene's own positions
        code = probe_options_read(a, &lighting, info.origin, &options);
        options.positions = (const float(*)[3])points.positions;
        options.position_count = points.count;
    }
    code = code == EXIT_DONE ? session_meet(code) : code;
    code = code == EXIT_DONE ? bake(&s, a, &options) : code;
    alp_image_destroy(sky);
    points_clear(&points);
    session_close(&s);
    return code;
}
