// SPDX-License-Identifier: MIT
// alpenglow lpv: light that is propagated anew in each of some frames.
#include "commands/commands.h"
#include "interrupt.h"
#include "lpv/lpv_pictures.h"
#include "lpv/lpv_report.h"
#include "lpv/lpv_volume.h"
#include "output.h"
#include "setup/cameras.h"
#include "setup/lighting.h"
#include "views.h"

#include <math.h>
#include <stdlib.h>

static bool prints_table(const command_line *a)
{
    return !output_is_stdout(a->values[OPTION_JSON].text) && !a->values[OPTION_QUIET].given;
}

// --- options -------------------------------------------------------------------------------------

/// Refuses options of results that are not wanted.
static int check_needs(const command_line *a)
{
    static const struct {
        const char *name;
        option_id id;
    } of_pictures[] = {{"--resolution", OPTION_RESOLUTION},
                       {"--reference-samples", OPTION_REFERENCE_SAMPLES}};
    for (size_t i = 0; i < sizeof of_pictures / sizeof *of_pictures; i++) {
        if (a->values[of_pictures[i].id].given && !a->values[OPTION_PICTURES].given) {
            return usage_error(COMMAND_LPV, "%s: needs a folder; give --pictures DIR",
                               of_pictures[i].name);
        }
    }
    if (a->values[OPTION_SUN_TURN].given && !a->values[OPTION_SUN].given) {
        return usage_error(COMMAND_LPV, "--sun-turn: needs a sun; give --sun AZ,EL,LUX");
    }
    return EXIT_DONE;
}

static int check_json(const command_line *a)
{
    const char *json = a->values[OPTION_JSON].text;
    if (json == NULL) {
        return EXIT_DONE;
    }
    if (!output_is_stdout(json) && output_is_same(json, a->operands[0])) {
        return usage_error(COMMAND_LPV, "--json %s: SCENE has the same name; give another", json);
    }
    return output_check_json(json, a->values[OPTION_FORCE].given);
}

static int check_options(const command_line *a, alp_render_options *view)
{
    *view = alp_render_options_default();
    int code = check_needs(a);
    code = code == EXIT_DONE ? lpv_run_check(a) : code;
    code = code == EXIT_DONE ? resolution_read(a, &view->width, &view->height) : code;
    code = code == EXIT_DONE ? camera_read(a, (const double[3]){0.0, 0.0, 0.0}, view) : code;
    code = code == EXIT_DONE ? check_json(a) : code;
    return code == EXIT_DONE ? lpv_volume_check(a) : code;
}

// --- frames --------------------------------------------------------------------------------------

static bool show_progress(lpv_run *run, uint32_t done, uint32_t total, double start)
{
    const double left = (double)total - (double)done;
    const alp_progress state = {
        .stage = "frames",
        .done = done,
        .total = total,
        .seconds_left = done > 0 ? (clock_seconds() - start) * left / (double)done : -1.0};
    return session_progress(run->session, &state);
}

static alp_result light_frame(lpv_run *run, lpv_record *record, uint32_t frame)
{
    const double start = clock_seconds();
    const alp_result result = lpv_run_light(run, &record->last);
    const alp_lpv_report *r = &record->last;
    const double seconds[LPV_STAGES] = {r->trace, r->inject, r->block, r->propagate,
                                        clock_seconds() - start};
    for (int stage = 0; stage < LPV_STAGES; stage++) {
        record->milliseconds[stage][frame] = 1e3 * seconds[stage];
    }
    return result;
}

static alp_result light_frames(lpv_run *run, lpv_record *record)
{
    const double azimuth = (double)run->frame.lighting.sun.azimuth, start = clock_seconds();
    // The ray tracer builds its tree in the first call, which is not a part of a frame.
    alp_result result = lpv_run_light(run, NULL);
    for (uint32_t i = 0; i < record->count && result == ALP_OK; i++) {
        if (!show_progress(run, i, record->count, start)) {
            return ALP_ERROR_CANCELLED;
        }
        run->frame.lighting.sun.azimuth = (float)(azimuth + (double)i * record->sun_turn);
        result = light_frame(run, record, i);
    }
    return result;
}

// --- the command ---------------------------------------------------------------------------------

static lpv_record make_record(const command_line *a)
{
    lpv_record record = {.count = (uint32_t)a->values[OPTION_FRAMES].whole};
    const bool turns = a->values[OPTION_SUN].given;
    record.sun_turn = turns ? a->values[OPTION_SUN_TURN].real * (M_PI / 180.0) : 0.0;
    for (int stage = 0; stage < LPV_STAGES; stage++) {
        record.milliseconds[stage] = allocate_or_exit(NULL, record.count * sizeof(double));
    }
    return record;
}

static int write_json(const lpv_run *run, const command_line *a, const lpv_record *record)
{
    const char *path = a->values[OPTION_JSON].text;
    if (path == NULL) {
        return EXIT_DONE;
    }
    json_t *document = lpv_json(run, a, record);
    const int code = document == NULL
                         ? failure("out of memory")
                         : output_write_json(document, path, a->values[OPTION_FORCE].given);
    json_decref(document);
    return code;
}

static int run_frames(lpv_run *run, const command_line *a, alp_render_options *view)
{
    lpv_record record = make_record(a);
    int code = session_end(run->session, light_frames(run, &record));
    if (code == EXIT_DONE) {
        lpv_record_sort(&record);
        code = lpv_pictures_write(run, a, view);
    }
    code = code == EXIT_DONE ? lpv_volume_write(run, a) : code;
    code = code == EXIT_DONE ? write_json(run, a, &record) : code;
    if (code == EXIT_DONE && prints_table(a)) {
        lpv_print(run, &record);
    }
    for (int stage = 0; stage < LPV_STAGES; stage++) {
        free(record.milliseconds[stage]);
    }
    return code;
}

static int propagate(session *s, const command_line *a, const alp_lighting_options *lighting,
                     alp_render_options *view)
{
    lpv_run run = {0};
    interrupt_defer();
    view->progress = session_progress;
    view->progress_user = s;
    int code = camera_find(s, a, view);
    if (code == EXIT_DONE) {
        code = session_end(s, alp_render_find_camera(s->scene, view, &view->camera));
    }
    code = code == EXIT_DONE ? lpv_pictures_check(a) : code;
    code = code == EXIT_DONE ? lpv_run_open(s, a, lighting, &view->camera, &run) : code;
    code = code == EXIT_DONE ? run_frames(&run, a, view) : code;
    lpv_run_close(&run);
    return code == EXIT_DONE ? session_judge_warnings(s) : code;
}

int command_lpv(const command_line *a)
{
    alp_lighting_options lighting;
    alp_render_options view;
    lamp_list lamps;
    alp_image *sky;
    session s;
    int code = check_options(a, &view);
    code = code == EXIT_DONE ? lighting_read(a, &lighting, &lamps) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    code = lighting_open(&s, a, &lighting, &lamps, &sky);
    code = code == EXIT_DONE ? propagate(&s, a, &lighting, &view) : code;
    session_close(&s);
    return code;
}
