// SPDX-License-Identifier: MIT
// The pictures of a flight.
#include "ambience/flight.h"
#include "output.h"
#include "picture.h"
#include "view_job.h"
#include "views.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct flight_job {
    view_job *view;
    const flight *path;
    uint64_t count; // frames
    double step;    // seconds from one to the next
    alp_film_adaptation adaptation;
} flight_job;

/// Develops a frame. Automatic exposure adapts over the frames.
/// @param seconds since the frame before   @param exposure out: EV
static alp_result develop(flight_job *job, double seconds, alp_image **developed, double *exposure)
{
    const drawing *d = &job->view->drawing;
    alp_context *context = job->view->session.context;
    alp_film_options film = job->view->settings.film;
    alp_image *light = NULL;
    alp_result result = picture_read_light(context, &d->targets, &light);
    if (result == ALP_OK && film.auto_exposure) {
        result = alp_film_adapt(&job->adaptation, light, &film, seconds, &film.exposure);
        film.auto_exposure = false;
    }
    alp_image_destroy(light);
    if (result == ALP_OK) {
        result = view_develop(job->view, &film, developed, NULL);
    }
    *exposure = film.exposure;
    return result;
}

/// The flight of a volume that one of the modes reads, or NULL.
static const flight_run *find_run(const view_job *view)
{
    const flight_run *own = view->drawing.light.source.flight;
    return own != NULL ? own : view->beside.drawing.light.source.flight;
}

/// Updates the light of a mode for a time of the flight.
static int move_light(view_job *view, const view_mode *mode, drawing *d, double time,
                      const alp_camera *camera)
{
    return mode != NULL && mode->move != NULL ? mode->move(&view->session, time, camera, &d->light)
                                              : EXIT_DONE;
}

/// Gives a mode that shows lamps and suns those of this moment of the day.
static int move_sun(view_job *view, const view_mode *mode, drawing *d)
{
    const flight_run *run = find_run(view);
    return mode != NULL && (mode->uses & USES_DIRECT) != 0 && run != NULL && run->day > 0.0
               ? drawing_set_lighting(d, view->session.context, &run->lighting)
               : EXIT_DONE;
}

/// Moves the object to its place at a time of the flight.
static int move_object(const view_job *view, drawing *d, double time)
{
    float position[3];
    if (view->object_path.count == 0 || d->object.what.kind == ALP_OBJECT_NONE) {
        return EXIT_DONE;
    }
    const flight_camera at = flight_at(&view->object_path, time);
    for (int k = 0; k < 3; k++) {
        position[k] = (float)at.position[k];
    }
    return drawing_move_object(d, view->session.context, position);
}

/// Moves the nodes that an animation moves, in the light that the flight has so far.
static int move_nodes(view_job *view, double time)
{
    const flight_run *run = find_run(view);
    const bool day = run != NULL && run->day > 0.0;
    return view_pose_move(view, time, day ? &run->lighting : &view->settings.render.lighting);
}

/// Moves the nodes, the light and the objects of both modes.
static int move(view_job *view, double time, const alp_camera *camera)
{
    const view_mode *const modes[2] = {view->settings.mode, view->beside.mode};
    drawing *const drawings[2] = {&view->drawing, &view->beside.drawing};
    int code = move_nodes(view, time);
    for (int i = 0; i < 2 && code == EXIT_DONE; i++) {
        code = move_light(view, modes[i], drawings[i], time, camera);
    }
    for (int i = 0; i < 2 && code == EXIT_DONE; i++) { // a flight has moved the sun
        code = move_sun(view, modes[i], drawings[i]);
        code = code == EXIT_DONE ? move_object(view, drawings[i], time) : code;
    }
    return code;
}

static int draw_frame(flight_job *job, uint64_t frame, const char *file)
{
    view_job *view = job->view;
    const double time = flight_start(job->path) + job->step * (double)frame;
    const flight_camera at = flight_at(job->path, time);
    const alp_camera camera = flight_view(&at);
    alp_image *developed = NULL;
    double exposure = 0.0;
    const int moved = move(view, time, &camera);
    if (moved != EXIT_DONE) {
        return moved;
    }
    alp_result result = view_draw(view, &camera);
    if (result == ALP_OK) {
        result = develop(job, frame > 0 ? job->step : 0.0, &developed, &exposure);
    }
    const int code = result == ALP_OK ? view_save(view, &camera, exposure, developed, file)
                                      : session_end(&view->session, result);
    alp_image_destroy(developed);
    return code;
}

/// Draws a frame unless Ctrl-C has stopped the flight, or its file is there.
static int go_on(flight_job *job, uint64_t frame)
{
    const option_value *v = job->view->arguments->values;
    const alp_progress progress = {
        .stage = "draw", .done = frame, .total = job->count, .seconds_left = -1.0};
    char name[32];
    if (!session_progress(&job->view->session, &progress)) {
        return session_end(&job->view->session, ALP_ERROR_CANCELLED);
    }
    snprintf(name, sizeof name, "frame_%04llu", (unsigned long long)frame + 1);
    char *file = pictures_path(v[OPTION_PICTURES].text, name);
    int code = output_check(file, v[OPTION_FORCE].given);
    code = code == EXIT_DONE ? draw_frame(job, frame, file) : code;
    free(file);
    return code;
}

static int draw_frames(flight_job *job)
{
    const double start = clock_seconds();
    const double length = flight_end(job->path) - flight_start(job->path);
    job->step = job->count > 1 ? length / (double)(job->count - 1) : 0.0;
    int code = pictures_folder(job->view->arguments->values[OPTION_PICTURES].text);
    for (uint64_t i = 0; i < job->count && code == EXIT_DONE; i++) {
        code = go_on(job, i);
    }
    progress_clear(&job->view->session.progress);
    if (code == EXIT_DONE) {
        char what[64];
        snprintf(what, sizeof what, "%llu pictures", (unsigned long long)job->count);
        view_print_done(job->view, what, clock_seconds() - start);
    }
    return code;
}

int view_flight_read(view_job *view)
{
    const command_line *a = view->arguments;
    const alp_scene_info info = alp_scene_get_info(view->session.scene);
    if (view_mode_flies(a)) { // the volume reads it
        return EXIT_DONE;
    }
    const int code = flight_read(a->values[OPTION_PATH].text, info.origin, &view->path);
    if (code == EXIT_DONE) {
        const flight_camera first = flight_at(&view->path, flight_start(&view->path));
        view->settings.render.camera = flight_view(&first);
    }
    return code;
}

int view_flight(view_job *view)
{
    const flight_run *run = find_run(view);
    flight_job job = {.view = view,
                      .path = run != NULL ? &run->path : &view->path,
                      .count = view->arguments->values[OPTION_FRAMES].whole,
                      .adaptation = alp_film_adaptation_default()};
    return draw_frames(&job);
}
