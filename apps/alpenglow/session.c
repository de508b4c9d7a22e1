// SPDX-License-Identifier: MIT
// Session of a command that loads a scene: context, messages, progress, exit code.
#include "session.h"

#include "animation.h"
#include "interrupt.h"

#include <math.h>

static session_ranks together;

void session_set_ranks(const session_ranks *ranks)
{
    together = *ranks;
}

bool session_writes(void)
{
    return together.ranks == NULL || together.ranks->rank == 0;
}

int session_meet(int code)
{
    return together.meet != NULL ? together.meet(code) : code;
}

int session_open(session *s, const command_line *a)
{
    const option_value *values = a->values;
    bool quiet = values[OPTION_QUIET].given || !session_writes();
    progress_mode mode = (progress_mode)values[OPTION_PROGRESS].choice;
    bool unasked = !session_writes() || (quiet && !values[OPTION_PROGRESS].given);
    *s = (session){
        .messages = {.quiet = quiet},
        .progress = progress_start(unasked ? PROGRESS_OFF : mode),
        .warnings_as_errors = values[OPTION_WARNINGS_AS_ERRORS].given,
    };
    s->messages.progress = &s->progress;
    alp_context_options options = alp_context_options_default();
    if (values[OPTION_THREADS].choice < 0) {
        options.worker_count = (uint32_t)values[OPTION_THREADS].whole;
    }
    options.read_outside = values[OPTION_ALLOW_OUTSIDE].given;
    options.log = messages_log;
    options.log_user = &s->messages;
    options.ranks = together.ranks;
    options.max_isa = together.max_isa;
    alp_result result = alp_context_create(&options, &s->context);
    return result == ALP_OK ? EXIT_DONE : failure(alp_result_name(result));
}

/// Refuses outputs that are files of the scene: its pictures, buffers and material libraries.
static int spare_files(const session *s, const command_line *a)
{
    static const option_id outputs[] = {OPTION_OUTPUT, OPTION_JSON, OPTION_REPORT, OPTION_CSV};
    for (size_t i = 0; i < sizeof outputs / sizeof *outputs; i++) {
        const char *path = a->values[outputs[i]].text;
        if (path != NULL && alp_scene_refers_to(s->scene, path)) {
            char text[512];
            snprintf(text, sizeof text,
                     "%.300s: is a file that the scene refers to, which is never overwritten; give "
                     "the output another name",
                     path);
            return failure(text);
        }
    }
    return EXIT_DONE;
}

int session_load(session *s, const command_line *a)
{
    double start = clock_seconds();
    int code = animation_check(a);
    if (code != EXIT_DONE) {
        return code;
    }
    s->messages.gathered = true;
    alp_result result =
        alp_scene_load_choice(s->context, a->operands[0], a->values[OPTION_SCENE].text, &s->scene);
    alp_scene_set_metals(s->scene, (alp_metals)a->values[OPTION_METALS].choice);
    code = result == ALP_OK ? animation_pose(s, a) : session_end(s, result);
    s->load_seconds = clock_seconds() - start;
    s->messages.gathered = false;
    messages_flush(&s->messages);
    code = code == EXIT_DONE ? spare_files(s, a) : code;
    return code == EXIT_DONE ? session_judge_warnings(s) : code;
}

void session_close(session *s)
{
    progress_clear(&s->progress);
    messages_flush(&s->messages);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
    messages_release(&s->messages);
}

static bool has_failed_by_warning(const session *s)
{
    return s->warnings_as_errors && s->messages.warnings.count > 0;
}

bool session_progress(void *user, const alp_progress *state)
{
    session *s = user;
    if (interrupt_asked() || has_failed_by_warning(s)) {
        return false;
    }
    progress_show(&s->progress, state);
    return true;
}

void session_warn(session *s, const char *code, const char *object, const char *text)
{
    messages_log(&s->messages, &(alp_log_message){ALP_LOG_WARNING, code, object, text});
}

int session_end(session *s, alp_result result)
{
    progress_clear(&s->progress);
    messages_flush(&s->messages);
    if (result == ALP_OK) {
        return EXIT_DONE;
    }
    // Ranks that wait for others give up when they are told to stop.
    const bool gave_up = together.ranks != NULL && result == ALP_ERROR_IO && interrupt_asked();
    if (result == ALP_ERROR_CANCELLED || gave_up) {
        if (interrupt_stops()) {
            failure(gave_up ? "told to stop, and another rank is gone; the checkpoint keeps the "
                              "work, and the same command goes on from it with any number of ranks"
                            : "stopped; the checkpoint keeps the work, and the same command goes "
                              "on from it");
            return EXIT_STOPPED;
        }
        if (interrupt_asked()) {
            failure(interrupt_keeps_work() ? "interrupted; the checkpoint keeps the work, and the "
                                             "same command goes on from it"
                    : s->has_written       ? "interrupted"
                                           : "interrupted; nothing was written");
            return EXIT_INTERRUPTED;
        }
        if (together.ranks == NULL || has_failed_by_warning(s)) {
            return session_judge_warnings(s);
        }
        failure(alp_context_message(s->context)); // another rank was told to stop
        return interrupt_keeps_work() ? EXIT_STOPPED : EXIT_INTERRUPTED;
    }
    const char *text = alp_context_message(s->context);
    return failure(text[0] != '\0' ? text : alp_result_name(result));
}

int session_judge_warnings(const session *s)
{
    return has_failed_by_warning(s) ? failure("stopped at a warning (--warnings-as-errors)")
                                    : EXIT_DONE;
}

int occlusion_read(const command_line *a, alp_occlusion_options *o)
{
    enum { DISTANCE_AUTO = 0, DISTANCE_INFINITE = 1 }; // the choices of --ao-distance
    const double radians = M_PI / 180.0;
    const option_value *distance = &a->values[OPTION_AO_DISTANCE];
    const option_value *falloff = &a->values[OPTION_AO_FALLOFF];
    *o = alp_occlusion_options_default();
    o->samples = (uint32_t)a->values[OPTION_AO_SAMPLES].whole;
    o->distance = distance->choice == DISTANCE_AUTO       ? 0.0f
                  : distance->choice == DISTANCE_INFINITE ? INFINITY
                                                          : (float)distance->real;
    o->falloff = (alp_falloff)falloff->choice;
    if (distance->choice == DISTANCE_INFINITE && o->falloff != ALP_FALLOFF_NONE) {
        if (falloff->given) {
            return usage_error(a->command,
                               "--ao-falloff %s needs a distance; with --ao-distance inf there "
                               "is only none",
                               falloff->text);
        }
        o->falloff = ALP_FALLOFF_NONE;
    }
    o->cone = (float)(a->values[OPTION_AO_CONE].real * radians);
    o->distribution = (alp_distribution)a->values[OPTION_AO_DISTRIBUTION].choice;
    o->one_sided = a->values[OPTION_ONE_SIDED].given;
    o->seed = a->values[OPTION_SEED].whole;
    return EXIT_DONE;
}
