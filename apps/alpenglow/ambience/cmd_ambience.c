// SPDX-License-Identifier: MIT
// alpenglow ambience: the live volume of light along a flight.
#include "ambience/ambience_error.h"
#include "ambience/ambience_pictures.h"
#include "ambience/ambience_report.h"
#include "commands/commands.h"
#include "interrupt.h"
#include "output.h"
#include "setup/lighting.h"
#include "views.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool prints_table(const command_line *a)
{
    return a->values[OPTION_CSV].text == NULL && !output_is_stdout(a->values[OPTION_JSON].text) &&
           !a->values[OPTION_QUIET].given;
}

static bool prints_summary(const command_line *a)
{
    return !output_is_stdout(a->values[OPTION_CSV].text) &&
           !output_is_stdout(a->values[OPTION_JSON].text) && !a->values[OPTION_QUIET].given;
}

/// A file of results must not replace what is read. @param name "--csv" or "--json"
static int check_result(const command_line *a, const char *name, const char *result)
{
    const char *path = a->values[OPTION_PATH].text;
    if (result == NULL) {
        return EXIT_DONE;
    }
    const bool is_path = path != NULL && output_is_same(result, path);
    if (!output_is_stdout(result) && (is_path || output_is_same(result, a->operands[0]))) {
        return usage_error(COMMAND_AMBIENCE, "%s %s: %s has the same name; give another", name,
                           result, is_path ? "--path" : "SCENE");
    }
    return output_check_json(result, a->values[OPTION_FORCE].given);
}

/// Refuses options of results that are not wanted.
static int check_needs(const command_line *a)
{
    static const struct {
        const char *name;
        option_id id;
    } of_pictures[] = {{"--preview", OPTION_PREVIEW}, {"--resolution", OPTION_RESOLUTION}};
    for (size_t i = 0; i < sizeof of_pictures / sizeof *of_pictures; i++) {
        if (a->values[of_pictures[i].id].given && !a->values[OPTION_PICTURES].given) {
            return usage_error(COMMAND_AMBIENCE, "%s: needs a folder; give --pictures DIR",
                               of_pictures[i].name);
        }
    }
    if (a->values[OPTION_REFERENCE_SAMPLES].given && a->values[OPTION_ERRORS].choice == 0) {
        return usage_error(COMMAND_AMBIENCE, "--reference-samples: does not apply to --errors off");
    }
    return EXIT_DONE;
}

static int check_options(const command_line *a)
{
    const char *csv = a->values[OPTION_CSV].text, *json = a->values[OPTION_JSON].text;
    uint32_t width, height;
    int code = flight_run_check(a);
    code = code == EXIT_DONE ? resolution_read(a, &width, &height) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    if (csv != NULL && json != NULL && output_is_same(csv, json)) {
        return usage_error(COMMAND_AMBIENCE, "--csv and --json name one file: %s", csv);
    }
    code = check_needs(a);
    code = code == EXIT_DONE ? check_result(a, "--csv", csv) : code;
    return code == EXIT_DONE ? check_result(a, "--json", json) : code;
}

// --- seconds -------------------------------------------------------------------------------------

/// Number of the second that a frame lies in, from 1.
static uint32_t second_of(const flight_run *run, uint64_t frame)
{
    return (uint32_t)floor((double)frame / run->fps + 1e-9) + 1;
}

/// Flies one second. @param last out: its last frame
static alp_result fly_second(flight_run *run, ambience_second *s, flight_frame *last)
{
    double seconds = 0.0;
    *s = (ambience_second){.number = second_of(run, run->frame), .error = (double)NAN};
    do {
        const alp_result result = flight_run_next(run, last);
        if (result != ALP_OK) {
            return result;
        }
        s->frames++;
        s->samples += last->work.samples;
        s->relit += last->work.relit;
        s->rays += last->work.rays;
        s->sampling += last->work.seconds;
        s->worst_ms = fmax(s->worst_ms, 1e3 * last->seconds);
        seconds += last->seconds;
    } while (run->frame < run->frame_count && second_of(run, run->frame) == s->number);
    s->update_ms = 1e3 * seconds / (double)s->frames;
    s->time = last->time;
    s->info = alp_ambience_get_info(run->ambience);
    const alp_scene_info info = alp_scene_get_info(run->session->scene);
    for (int k = 0; k < 3; k++) {
        s->position[k] = last->camera.position[k] + info.origin[k];
    }
    return ALP_OK;
}

static ambience_second *add_second(ambience_record *r, uint32_t *room)
{
    if (r->count == *room) {
        *room = *room > 0 ? 2 * *room : 64;
        r->seconds = allocate_or_exit(r->seconds, *room * sizeof *r->seconds);
    }
    return &r->seconds[r->count++];
}

static void print_second(const command_line *a, const ambience_second *s)
{
    if (output_is_stdout(a->values[OPTION_CSV].text)) {
        ambience_print_csv(stdout, s);
    } else if (prints_table(a)) {
        ambience_print_second(s);
    }
    fflush(stdout);
}

static int fly(flight_run *run, const command_line *a, ambience_pictures *pictures,
               ambience_record *record)
{
    const ambience_error measure = {.direct = a->values[OPTION_DIRECT].choice == 1,
                                    .samples = (uint32_t)a->values[OPTION_REFERENCE_SAMPLES].whole,
                                    .seed = a->values[OPTION_SEED].whole};
    uint32_t room = 0;
    int code = EXIT_DONE;
    if (output_is_stdout(a->values[OPTION_CSV].text)) {
        ambience_print_csv_names(stdout);
    } else if (prints_table(a)) {
        ambience_print_names();
    }
    while (run->frame < run->frame_count && code == EXIT_DONE) {
        flight_frame last;
        ambience_second *s = add_second(record, &room);
        alp_result result = fly_second(run, s, &last);
        if (result == ALP_OK && a->values[OPTION_ERRORS].choice == 1) {
            result = ambience_error_measure(&measure, run, &last, s->number, &s->error);
        }
        code = session_end(run->session, result);
        if (code == EXIT_DONE) {
            print_second(a, s);
            code = ambience_pictures_add(pictures, &last, s->number);
        }
    }
    return code;
}

// --- results -------------------------------------------------------------------------------------

static int write_csv(const command_line *a, const ambience_record *record)
{
    const char *path = a->values[OPTION_CSV].text;
    char *text = NULL;
    size_t size = 0;
    if (path == NULL || output_is_stdout(path)) {
        return EXIT_DONE;
    }
    FILE *stream = open_memstream(&text, &size);
    if (stream == NULL) {
        return failure("out of memory");
    }
    ambience_print_csv_names(stream);
    for (uint32_t i = 0; i < record->count; i++) {
        ambience_print_csv(stream, &record->seconds[i]);
    }
    const bool whole = fclose(stream) == 0;
    const int code = whole ? output_write_text(text, path, a->values[OPTION_FORCE].given)
                           : failure("out of memory");
    free(text);
    return code;
}

static int write_json(const flight_run *run, const command_line *a, const ambience_record *record)
{
    const char *path = a->values[OPTION_JSON].text;
    if (path == NULL) {
        return EXIT_DONE;
    }
    json_t *document = ambience_json(run, a, record);
    const int code = document == NULL
                         ? failure("out of memory")
                         : output_write_json(document, path, a->values[OPTION_FORCE].given);
    json_decref(document);
    return code;
}

static int ambience(session *s, const command_line *a, const alp_lighting_options *lighting)
{
    flight_run run;
    ambience_pictures pictures = {0};
    ambience_record record = {0};
    interrupt_defer();
    int code = flight_run_open(s, a, lighting, &run);
    if (code == EXIT_DONE) {
        code = ambience_pictures_open(&run, a, second_of(&run, run.frame_count - 1), &pictures);
    }
    code = code == EXIT_DONE ? fly(&run, a, &pictures, &record) : code;
    code = code == EXIT_DONE ? ambience_pictures_finish(&pictures) : code;
    code = code == EXIT_DONE ? write_csv(a, &record) : code;
    code = code == EXIT_DONE ? write_json(&run, a, &record) : code;
    if (code == EXIT_DONE && prints_summary(a)) {
        ambience_print_summary(&record);
    }
    ambience_pictures_close(&pictures);
    flight_run_close(&run);
    free(record.seconds);
    return code == EXIT_DONE ? session_judge_warnings(s) : code;
}

int command_ambience(const command_line *a)
{
    alp_lighting_options lighting;
    lamp_list lamps;
    alp_image *sky;
    session s;
    int code = check_options(a);
    code = code == EXIT_DONE ? lighting_read(a, &lighting, &lamps) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    code = lighting_open(&s, a, &lighting, &lamps, &sky);
    code = code == EXIT_DONE ? ambience(&s, a, &lighting) : code;
    alp_image_destroy(sky);
    session_close(&s);
    return code;
}
