// SPDX-License-Identifier: MIT
#include "view_run.h"

#include "ambience/flight.h"
#include "cameras.h"
#include "drawing.h"
#include "gl_context.h"
#include "interrupt.h"
#include "lighting.h"
#include "output.h"
#include "picture.h"
#include "view_options.h"
#include "views.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct view_job {
    const command_line *arguments;
    view_settings settings;
    session session;
    gl_context gl;
    drawing drawing;
    flight path;                    // of the camera; empty where the light has the flight
    alp_film_adaptation adaptation; // of a flight
    double prepare_seconds;
} view_job;

static bool overwrites(const view_job *job)
{
    return job->arguments->values[OPTION_FORCE].given;
}

/// Prints the summary of a run.
static void print_done(const view_job *job, const char *what, double draw_seconds)
{
    const alp_render_options *o = &job->settings.render;
    if (job->arguments->values[OPTION_QUIET].given) {
        return;
    }
    printf("wrote      %s, %u x %u, load %.2f s, prepare %.2f s, draw %.3f s\n", what, o->width,
           o->height, job->session.load_seconds, job->prepare_seconds, draw_seconds);
    printf("OpenGL     %s\n", job->gl.renderer);
}

// --- a picture -----------------------------------------------------------------------------------

/// Compares the picture with that of --reference.
static int compare(view_job *job, const alp_image *developed, const alp_image *light)
{
    const option_value *v = job->arguments->values;
    alp_image *reference = NULL;
    alp_image_difference difference = {0};
    if (!v[OPTION_REFERENCE].given) {
        return EXIT_DONE;
    }
    alp_result result = alp_image_load(job->session.context, v[OPTION_REFERENCE].text, &reference);
    if (result == ALP_OK) {
        const bool linear = alp_image_get_info(reference).component == ALP_COMPONENT_FLOAT;
        result = alp_image_compare(linear ? light : developed, reference, 1.0, &difference, NULL);
    }
    alp_image_destroy(reference);
    if (result != ALP_OK) {
        return session_end(&job->session, result);
    }
    printf("reference  rmse %.4g, bias %.4g, 99 %% below %.4g, most %.4g at %u, %u\n",
           difference.rmse, difference.bias, difference.p99, difference.maximum,
           difference.maximum_x, difference.maximum_y);
    if (v[OPTION_REFERENCE_THRESHOLD].given &&
        !(difference.pixels > 0 && difference.rmse <= v[OPTION_REFERENCE_THRESHOLD].real)) {
        return failure("the picture differs from the reference by more than the threshold");
    }
    return EXIT_DONE;
}

/// Writes what was drawn.
static alp_result save(view_job *job, const char *path, alp_image **developed, alp_image **light)
{
    alp_film_options *film = &job->settings.film;
    alp_result result =
        drawing_develop(&job->drawing, job->session.context, film, developed, light);
    if (result == ALP_OK) {
        const alp_image *picture = path_ends(path, ".png") ? *developed : *light;
        result = alp_image_save(picture, path, overwrites(job));
    }
    return result;
}

static int draw_picture(view_job *job)
{
    const char *output = job->arguments->values[OPTION_OUTPUT].text;
    alp_camera camera;
    alp_image *developed = NULL, *light = NULL;
    session *s = &job->session;
    alp_result result = alp_render_find_camera(s->scene, &job->settings.render, &camera);
    const double start = clock_seconds();
    if (result == ALP_OK) {
        drawing_draw(&job->drawing, &camera);
        result = save(job, output, &developed, &light);
    }
    int code = session_end(s, result);
    code = code == EXIT_DONE ? gl_context_check(&job->gl) : code;
    if (code == EXIT_DONE) {
        print_done(job, output, clock_seconds() - start);
        if (job->settings.film.auto_exposure && path_ends(output, ".png") &&
            !job->arguments->values[OPTION_QUIET].given) {
            printf("exposure   %.2f EV\n", job->settings.film.exposure);
        }
        code = compare(job, developed, light);
    }
    alp_image_destroy(developed);
    alp_image_destroy(light);
    return code;
}

// --- a flight ------------------------------------------------------------------------------------

/// Reads the flight, and takes the view of its beginning. The volume of ambience reads its own.
static int read_flight(view_job *job)
{
    const command_line *a = job->arguments;
    const alp_scene_info info = alp_scene_get_info(job->session.scene);
    if (!a->values[OPTION_PICTURES].given || view_mode_flies(a)) {
        return EXIT_DONE;
    }
    const int code = flight_read(a->values[OPTION_PATH].text, info.origin, &job->path);
    if (code == EXIT_DONE) {
        const flight_camera first = flight_at(&job->path, flight_start(&job->path));
        job->settings.render.camera = flight_view(&first);
    }
    return code;
}

/// Brings the light to a moment of the flight.
static int move_light(view_job *job, double time, const alp_camera *camera)
{
    const view_mode *mode = job->settings.mode;
    const flight_run *run = job->drawing.light.source.flight;
    int code = EXIT_DONE;
    if (mode->move != NULL) {
        code = mode->move(&job->session, time, camera, &job->drawing.light);
    }
    if (code == EXIT_DONE && run != NULL && run->day > 0.0) {
        code = drawing_set_lighting(&job->drawing, job->session.context, &run->lighting);
    }
    return code;
}

/// Develops a frame. Automatic exposure adapts over the frames.
/// @param seconds since the frame before
static alp_result develop_frame(view_job *job, double seconds, alp_image **developed)
{
    alp_film_options film = job->settings.film;
    alp_image *light = NULL;
    alp_context *context = job->session.context;
    alp_result result = picture_read_light(context, &job->drawing.targets, &light);
    if (result == ALP_OK && film.auto_exposure) {
        result = alp_film_adapt(&job->adaptation, light, &film, seconds, &film.exposure);
        film.auto_exposure = false;
    }
    alp_image_destroy(light);
    return result == ALP_OK ? drawing_develop(&job->drawing, context, &film, developed, NULL)
                            : result;
}

static int draw_frame(view_job *job, const flight *path, uint64_t frame, uint64_t count)
{
    session *s = &job->session;
    const double start = flight_start(path), length = flight_end(path) - start;
    const double step = count > 1 ? length / (double)(count - 1) : 0.0;
    const double time = start + step * (double)frame;
    const flight_camera at = flight_at(path, time);
    const alp_camera camera = flight_view(&at);
    char name[32];
    alp_image *developed = NULL;
    snprintf(name, sizeof name, "frame_%04llu", (unsigned long long)frame + 1);
    char *file = pictures_path(job->arguments->values[OPTION_PICTURES].text, name);
    int code = output_check(file, overwrites(job));
    code = code == EXIT_DONE ? move_light(job, time, &camera) : code;
    if (code == EXIT_DONE) {
        drawing_draw(&job->drawing, &camera);
        alp_result result = develop_frame(job, frame > 0 ? step : 0.0, &developed);
        if (result == ALP_OK) {
            result = alp_image_save(developed, file, overwrites(job));
            s->has_written |= result == ALP_OK;
        }
        code = session_end(s, result);
    }
    alp_image_destroy(developed);
    free(file);
    return code == EXIT_DONE ? gl_context_check(&job->gl) : code;
}

static int draw_frames(view_job *job, const flight *path)
{
    const uint64_t count = job->arguments->values[OPTION_FRAMES].whole;
    session *s = &job->session;
    const double start = clock_seconds();
    int code = pictures_folder(job->arguments->values[OPTION_PICTURES].text);
    for (uint64_t i = 0; i < count && code == EXIT_DONE; i++) {
        const alp_progress progress = {
            .stage = "draw", .done = i, .total = count, .seconds_left = -1.0};
        code = session_progress(s, &progress) ? draw_frame(job, path, i, count)
                                              : session_end(s, ALP_ERROR_CANCELLED);
    }
    progress_clear(&s->progress);
    if (code == EXIT_DONE) {
        char what[64];
        snprintf(what, sizeof what, "%llu pictures", (unsigned long long)count);
        print_done(job, what, clock_seconds() - start);
    }
    return code;
}

static int draw_flight(view_job *job)
{
    const flight_run *run = job->drawing.light.source.flight;
    job->adaptation = alp_film_adaptation_default();
    return draw_frames(job, run != NULL ? &run->path : &job->path);
}

// --- the whole -----------------------------------------------------------------------------------

/// Makes the light of the mode and all that draws.
static int prepare(view_job *job)
{
    view_settings *v = &job->settings;
    session *s = &job->session;
    const double start = clock_seconds();
    const bool direct =
        (v->mode->uses & USES_SWITCH) == 0 || job->arguments->values[OPTION_DIRECT].choice == 1;
    drawing_options options = {.context = s->context,
                               .mode = v->mode,
                               .lighting = &v->render.lighting,
                               .width = v->render.width,
                               .height = v->render.height,
                               .direct = direct,
                               .metals_black = job->arguments->values[OPTION_METALS].choice == 1};
    v->render.progress = session_progress;
    v->render.progress_user = s;
    interrupt_defer();
    int code = EXIT_DONE;
    if (v->mode->prepare != NULL) {
        code = v->mode->prepare(s, job->arguments, &v->render, &options.light);
    }
    if (code == EXIT_DONE) {
        code = drawing_create(s->scene, &options, &job->drawing);
    } else {
        mode_light_destroy(&options.light);
    }
    code = code == EXIT_DONE ? gl_context_check(&job->gl) : code;
    progress_clear(&s->progress);
    job->prepare_seconds = clock_seconds() - start;
    return code;
}

static int run_scene(view_job *job)
{
    const command_line *a = job->arguments;
    view_settings *v = &job->settings;
    alp_image *sky = NULL;
    int code = lighting_open(&job->session, a, &v->render.lighting, &v->lamps, &sky);
    code = code == EXIT_DONE ? camera_find(&job->session, a, &v->render) : code;
    code = code == EXIT_DONE ? read_flight(job) : code;
    code = code == EXIT_DONE ? prepare(job) : code;
    if (code == EXIT_DONE) {
        code = a->values[OPTION_PICTURES].given ? draw_flight(job) : draw_picture(job);
    }
    code = code == EXIT_DONE ? session_judge_warnings(&job->session) : code;
    drawing_destroy(&job->drawing);
    flight_clear(&job->path);
    alp_image_destroy(sky);
    session_close(&job->session);
    return code;
}

int view_run(const command_line *arguments)
{
    view_job job = {.arguments = arguments};
    int code = view_settings_read(arguments, &job.settings);
    if (code != EXIT_DONE) {
        return code;
    }
    code = gl_context_open(&job.gl); // before the work, which may take long
    if (code == EXIT_DONE) {
        code = run_scene(&job);
    }
    gl_context_close(&job.gl);
    return code;
}
