// SPDX-License-Identifier: MIT
// alpenglow bake: loads, bakes, reports.
#include "bake_defaults.h"
#include "bake_options.h"
#include "commands/commands.h"
#include "interrupt.h"
#include "output.h"
#include "printing/findings.h"
#include "printing/report.h"
#include "printing/report_page.h"
#include "printing/work.h"
#include "scale/checkpoints.h"
#include "session.h"
#include "setup/fields.h"
#include "setup/lighting.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int write_json(const session *s, const alp_lightmap *lightmap, const alp_bake_report *r,
                      const alp_diagnosis *diagnosis, const command_line *a)
{
    json_t *document = report_make(s, lightmap, r, diagnosis);
    int code = document == NULL ? failure("out of memory")
                                : output_write_json(document, a->values[OPTION_JSON].text,
                                                    a->values[OPTION_FORCE].given);
    json_decref(document);
    return code;
}

/// Writes the summary and the reports that were requested, with the doctor's findings.
static int report(session *s, const alp_lightmap *lightmap, const alp_bake_report *r,
                  const command_line *a)
{
    const bool wants_json = a->values[OPTION_JSON].text != NULL;
    const bool wants_page = a->values[OPTION_REPORT].text != NULL;
    alp_diagnosis *diagnosis = NULL;
    int code = EXIT_DONE;
    if (wants_json || wants_page) {
        code = findings_look(s, r, &diagnosis);
    }
    if (code == EXIT_DONE && wants_json) {
        code = write_json(s, lightmap, r, diagnosis, a);
    }
    if (code == EXIT_DONE && wants_page) {
        code = report_page_write(s, lightmap, r, diagnosis, a);
    }
    alp_diagnosis_destroy(diagnosis);
    return code;
}

/// Reports a shard, which writes no outputs.
static int end_shard(const session *s, const command_line *a, const alp_bake_options *o,
                     const alp_bake_report *r)
{
    if (!a->values[OPTION_QUIET].given) {
        printf(
            "shard      %u of %u is in %s, after %.1f s, %.0f %% of it for work that every shard "
            "repeats; 'alpenglow merge %s' writes the result\n",
            o->checkpoint.shard, o->checkpoint.shards, o->checkpoint.folder, r->seconds_total,
            100.0 * r->shard_repeated_share, o->checkpoint.folder);
    }
    return session_judge_warnings(s);
}

/// @param note of a choice that was made, or NULL
static int bake(session *s, const command_line *a, alp_bake_options *o, const char *note)
{
    if (note != NULL) {
        messages_log(&s->messages,
                     &(alp_log_message){ALP_LOG_NOTE, "lightmap-as", o->output, note});
    }
    alp_lightmap *lightmap = NULL;
    alp_bake_report told;
    o->progress = session_progress;
    o->progress_user = s;
    interrupt_defer();
    alp_bake_work work;
    if (!a->values[OPTION_QUIET].given && o->atlas.mode != ALP_ATLAS_VERTEX &&
        alp_bake_estimate(s->scene, o, &work) == ALP_OK && work.texels > 0) {
        progress_clear(&s->progress); // on failure, the bake reports the reason
        work_print(stderr, &work);
    }
    alp_probe_options probes;
    int code = session_meet(
        probe_options_read(a, &o->light.lighting, alp_scene_get_info(s->scene).origin, &probes));
    if (code != EXIT_DONE) {
        return code;
    }
    o->probes = &probes;
    code = session_end(s, alp_bake(s->scene, o, &lightmap, &told));
    o->probes = NULL;
    if (code == EXIT_DONE && told.shard_done) {
        alp_lightmap_destroy(lightmap);
        return end_shard(s, a, o, &told);
    }
    if (code == EXIT_DONE && session_writes()) {
        code = report(s, lightmap, &told, a);
    }
    const bool is_told = output_is_stdout(a->values[OPTION_JSON].text);
    if (code == EXIT_DONE && !a->values[OPTION_QUIET].given && !is_told) {
        bake_summary_print(s, a, lightmap, o, &told);
    }
    alp_lightmap_destroy(lightmap);
    if (code == EXIT_DONE && told.cut_off && interrupt_asked()) {
        failure("interrupted; the partial result is written (--keep-partial)");
        return EXIT_INTERRUPTED;
    }
    return code == EXIT_DONE ? session_judge_warnings(s) : code;
}

/// The report must not overwrite the scene that was read or baked.
static int check_report(const command_line *a, const char *output)
{
    const char *json = a->values[OPTION_JSON].text;
    if (json == NULL) {
        return EXIT_DONE;
    }
    if ((output != NULL && output_is_same(json, output)) || output_is_same(json, a->operands[0])) {
        return usage_error(COMMAND_BAKE, "--json %s: %s has the same name; give another", json,
                           output != NULL && output_is_same(json, output) ? "-o" : "SCENE");
    }
    return output_check_json(json, a->values[OPTION_FORCE].given);
}

/// Refuses an OUT that is there before the scene is read, which may take long. The bake checks the
/// files beside it.
static int check_output(const command_line *a, const char *output)
{
    char text[512];
    const bool overwrite = a->values[OPTION_FORCE].given;
    if (output == NULL) {
        return EXIT_DONE;
    }
    if (overwrite || !output_is_same(output, a->operands[0]) || access(output, F_OK) != 0) {
        return output_check(output, overwrite);
    }
    snprintf(text, sizeof text,
             "%.300s: is SCENE itself, and would be overwritten by the baked scene; name another "
             "file (-o OUT%s), or force it (-f)",
             output, strrchr(output, '.') != NULL ? strrchr(output, '.') : "");
    return failure(text);
}

/// @param note of a choice that was made, or NULL
static int run(const command_line *a, const char *note)
{
    alp_bake_options options;
    lamp_list lamps;
    char *restart = NULL;
    int code = bake_options_read(a, &options, &lamps);
    code = code == EXIT_DONE ? checkpoint_read(a, &options, &restart) : code;
    interrupt_decide(code == EXIT_DONE && options.checkpoint.folder != NULL &&
                     !options.checkpoint.merge);
    code = code == EXIT_DONE ? probe_file_check(a) : code;
    code = code == EXIT_DONE ? check_output(a, options.output) : code;
    if (code == EXIT_DONE) {
        code = check_report(a, options.output);
    }
    if (code == EXIT_DONE) {
        code = report_page_check(a);
    }
    if (code != EXIT_DONE) {
        free(restart);
        return code;
    }
    session s;
    alp_image *sky;
    code = lighting_open(&s, a, &options.light.lighting, &lamps, &sky);
    if (code == EXIT_DONE) {
        code = bake(&s, a, &options, note);
    }
    alp_image_destroy(sky);
    session_close(&s);
    free(restart);
    return code;
}

int command_bake(const command_line *a)
{
    command_line filled = *a;
    const char *note = NULL;
    char *output = bake_defaults_fill(&filled, &note);
    const int code = run(&filled, note);
    free(output);
    return code;
}
