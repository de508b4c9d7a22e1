// SPDX-License-Identifier: MIT
// alpenglow probes: light probes of a scene.
#include "fields.h"
#include "interrupt.h"
#include "lighting.h"
#include "output.h"
#include "points.h"

#include <string.h>

static int check_options(const command_line *a)
{
    const char *output = a->values[OPTION_OUTPUT].text;
    if (output == NULL) {
        return usage_error(COMMAND_PROBES, "no output; give -o OUT.probes.json");
    }
    if (!path_ends(output, ".json")) {
        return usage_error(COMMAND_PROBES, "-o %s: the name must end in .probes.json", output);
    }
    if (a->values[OPTION_AT].given &&
        (a->values[OPTION_SPACING].given || a->values[OPTION_BOUNDS].given)) {
        return usage_error(COMMAND_PROBES,
                           "--at gives the places; leave out --spacing and --bounds");
    }
    return EXIT_DONE;
}

static void print_summary(const char *output, const alp_probes_info *i, double seconds)
{
    if (i->is_list) {
        printf("probes     %u at listed places\n", i->count);
    } else {
        printf("probes     %u = %u x %u x %u, %g m apart\n", i->count, i->size[0], i->size[1],
               i->size[2], (double)i->spacing[0]);
    }
    printf("states     %u valid, %u moved out of solids, %u filled in solids, %u black\n",
           i->states[ALP_PROBE_VALID], i->states[ALP_PROBE_MOVED], i->states[ALP_PROBE_FILLED],
           i->states[ALP_PROBE_INVALID]);
    printf("mean irradiance %.4g W/m2\n", (double)i->mean);
    printf("noise      %.2g %% of the mean, %u rays a probe\n", 100.0 * (double)i->error, i->rays);
    if (!i->is_list && i->mean > 0.0f) {
        printf("between    %.2g %% of the mean, by points apart\n",
               100.0 * (double)i->interpolation / (double)i->mean);
    }
    printf("memory     %.3g MB, %.0f bytes a probe\n", (double)i->bytes * 1e-6,
           (double)i->bytes / (double)i->count);
    printf("wrote      %s, %.2f s\n", output, seconds);
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
    if (result == ALP_OK) {
        result = alp_probes_save(probes, output, a->values[OPTION_FORCE].given);
    }
    const int code = session_end(s, result);
    if (code == EXIT_DONE && !a->values[OPTION_QUIET].given) {
        const alp_probes_info info = alp_probes_get_info(probes);
        print_summary(output, &info, clock_seconds() - start);
    }
    alp_probes_destroy(probes);
    return code == EXIT_DONE ? session_judge_warnings(s) : code;
}

int command_probes(const command_line *a)
{
    alp_lighting_options lighting = alp_lighting_options_default();
    alp_probe_options options;
    lamp_list lamps;
    point_list points = {0};
    alp_image *sky = NULL;
    session s;
    alp_scene_info info = {0};
    int code = check_options(a);
    code = code == EXIT_DONE ? lighting_read(a, &lighting, &lamps) : code;
    code = code == EXIT_DONE ? probe_options_read(a, &lighting, info.origin, &options) : code;
    if (code == EXIT_DONE) {
        code = output_check(a->values[OPTION_OUTPUT].text, a->values[OPTION_FORCE].given);
    }
    if (code != EXIT_DONE) {
        return code;
    }
    interrupt_install();
    code = session_open(&s, a);
    code = code == EXIT_DONE ? session_load(&s, a) : code;
    if (code == EXIT_DONE) {
        info = alp_scene_get_info(s.scene);
        lighting_place(&s, a, &lamps);
        code = lighting_load_sky(&s, a, &lighting, &sky);
    }
    if (code == EXIT_DONE && a->values[OPTION_AT].given) {
        code = points_read(a->values[OPTION_AT].text, false, info.origin, &points);
    }
    if (code == EXIT_DONE) { // again, with the sky and in the scene's own positions
        code = probe_options_read(a, &lighting, info.origin, &options);
        options.positions = (const float(*)[3])points.positions;
        options.position_count = points.count;
    }
    code = code == EXIT_DONE ? bake(&s, a, &options) : code;
    alp_image_destroy(sky);
    points_clear(&points);
    session_close(&s);
    return code;
}
