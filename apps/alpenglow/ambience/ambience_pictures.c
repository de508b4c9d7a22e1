// SPDX-License-Identifier: MIT
#include "ambience/ambience_pictures.h"

#include "output.h"
#include "views.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_SIZE = 32, TILE_SIDE = 192 };

// --- files ---------------------------------------------------------------------------------------

static char *frame_path(const ambience_pictures *p, uint32_t second)
{
    char name[NAME_SIZE];
    snprintf(name, sizeof name, "frame_%04u", second);
    return pictures_path(p->folder, name);
}

static int check_path(const ambience_pictures *p, char *path)
{
    const int code = output_check(path, p->arguments->values[OPTION_FORCE].given);
    free(path);
    return code;
}

int ambience_pictures_open(flight_run *run, const command_line *a, uint32_t seconds,
                           ambience_pictures *p)
{
    *p = (ambience_pictures){.arguments = a,
                             .run = run,
                             .folder = a->values[OPTION_PICTURES].text,
                             .adapted = alp_film_adaptation_default(),
                             .seconds = seconds};
    if (p->folder == NULL) {
        return EXIT_DONE;
    }
    int code = resolution_read(a, &p->width, &p->height);
    code = code == EXIT_DONE ? pictures_folder(p->folder) : code;
    for (uint32_t i = 1; i <= seconds && code == EXIT_DONE; i++) {
        code = check_path(p, frame_path(p, i));
    }
    if (code == EXIT_DONE && a->values[OPTION_PREVIEW].given) {
        code = check_path(p, pictures_path(p->folder, "preview"));
    }
    return code;
}

void ambience_pictures_close(ambience_pictures *p)
{
    for (uint32_t i = 0; i < p->tile_count; i++) {
        alp_image_destroy(p->tiles[i]);
    }
    p->tile_count = 0;
    field_source_clear(&p->constant);
}

// --- pictures ------------------------------------------------------------------------------------

/// Options of a picture lit by a field.
static alp_render_options make_options(const ambience_pictures *p, const alp_field *field)
{
    alp_render_options o = alp_render_options_default();
    o.method = ALP_RENDER_FIELD;
    o.field = field;
    o.lighting = p->run->lighting;
    o.progress = flight_run_progress;
    o.progress_user = p->run;
    return o;
}

/// Renders with the volume's light of this moment.
static alp_result render_volume(const ambience_pictures *p, alp_render_options *o,
                                alp_image **image)
{
    alp_field *field = NULL;
    *image = NULL;
    alp_result result = alp_field_create_ambience(p->run->ambience, &field);
    o->field = field;
    if (result == ALP_OK) {
        result = alp_render(p->run->session->scene, o, image);
    }
    alp_field_destroy(field);
    return result;
}

/// Develops and saves. @param adapted NULL: the exposure fits this picture alone
static alp_result save(const ambience_pictures *p, const alp_image *linear, const char *path,
                       alp_film_adaptation *adapted)
{
    alp_film_options film = alp_render_film_options(ALP_RENDER_FIELD);
    alp_image *display = NULL;
    alp_result result = ALP_OK;
    if (adapted != NULL) {
        result = alp_film_adapt(adapted, linear, &film, 1.0, &film.exposure);
        film.auto_exposure = false;
    }
    if (result == ALP_OK) {
        result = alp_film_develop(linear, &film, &display, NULL);
    }
    if (result == ALP_OK) {
        result = alp_image_save(display, path, p->arguments->values[OPTION_FORCE].given);
    }
    alp_image_destroy(display);
    return result;
}

/// The constant model: fitted once, or to the light of each moment of a day.
static alp_result fit_constant(ambience_pictures *p)
{
    if (p->constant.field != NULL && !(p->run->day > 0.0)) {
        return ALP_OK;
    }
    alp_ambient_options o = alp_ambient_options_default();
    field_source_clear(&p->constant);
    o.model = ALP_AMBIENT_CONSTANT;
    o.lighting = p->run->lighting;
    o.direct = p->arguments->values[OPTION_DIRECT].choice == 1;
    o.seed = p->arguments->values[OPTION_SEED].whole;
    o.progress = flight_run_progress;
    o.progress_user = p->run;
    return alp_field_create_ambient(p->run->session->scene, &o, &p->constant.field);
}

static alp_result write_frame(ambience_pictures *p, const flight_frame *frame, const char *path)
{
    alp_image *halves[2] = {NULL, NULL}, *joined = NULL;
    alp_result result = fit_constant(p);
    alp_render_options o = make_options(p, p->constant.field);
    o.camera = flight_view(&frame->camera);
    o.width = p->width;
    o.height = p->height;
    if (result == ALP_OK) {
        result = alp_render(p->run->session->scene, &o, &halves[1]);
    }
    if (result == ALP_OK) {
        result = render_volume(p, &o, &halves[0]);
    }
    if (result == ALP_OK) {
        result = images_join(p->run->session->context, halves, 2, &joined);
    }
    if (result == ALP_OK) {
        result = save(p, joined, path, &p->adapted);
    }
    alp_image_destroy(halves[0]);
    alp_image_destroy(halves[1]);
    alp_image_destroy(joined);
    return result;
}

// --- preview -------------------------------------------------------------------------------------

/// Whether a second is a moment of the preview: 8 of them, spread over the flight.
static bool is_moment(const ambience_pictures *p, uint32_t second)
{
    const uint64_t count = p->seconds < PREVIEW_LIMIT ? p->seconds : PREVIEW_LIMIT;
    return (second * count) / p->seconds > ((second - 1) * count) / p->seconds;
}

/// The object in front of the camera, as large as a fine cell.
static alp_result render_tile(ambience_pictures *p, const flight_frame *frame)
{
    const alp_ambience_options *volume = &p->run->options;
    const double radius = 0.5 * volume->size / pow(3.0, (double)volume->depth), away = 6.0 * radius;
    const flight_camera *c = &frame->camera;
    alp_render_options o = make_options(p, NULL);
    o.camera = flight_view(c);
    o.camera.vertical_fov = 0.6f;
    o.width = o.height = TILE_SIDE;
    o.object.kind =
        p->arguments->values[OPTION_PREVIEW].choice == 0 ? ALP_OBJECT_SPHERE : ALP_OBJECT_TEAPOT;
    o.object.radius = (float)radius;
    const double length = flight_distance(c->position, c->target);
    for (int k = 0; k < 3; k++) {
        const double forward = (c->target[k] - c->position[k]) / length;
        o.object.position[k] = (float)(c->position[k] + away * forward);
    }
    const alp_result result = render_volume(p, &o, &p->tiles[p->tile_count]);
    p->tile_count += result == ALP_OK ? 1 : 0;
    return result;
}

int ambience_pictures_add(ambience_pictures *p, const flight_frame *frame, uint32_t second)
{
    if (p->folder == NULL) {
        return EXIT_DONE;
    }
    char *path = frame_path(p, second);
    alp_result result = write_frame(p, frame, path);
    free(path);
    p->run->session->has_written |= result == ALP_OK;
    if (result == ALP_OK && p->arguments->values[OPTION_PREVIEW].given && is_moment(p, second)) {
        result = render_tile(p, frame);
    }
    return session_end(p->run->session, result);
}

int ambience_pictures_finish(ambience_pictures *p)
{
    if (p->tile_count == 0) {
        return EXIT_DONE;
    }
    alp_image *joined = NULL;
    char *path = pictures_path(p->folder, "preview");
    alp_result result = images_join(p->run->session->context, p->tiles, p->tile_count, &joined);
    if (result == ALP_OK) {
        result = save(p, joined, path, NULL);
    }
    alp_image_destroy(joined);
    free(path);
    return session_end(p->run->session, result);
}
