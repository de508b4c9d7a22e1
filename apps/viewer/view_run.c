// SPDX-License-Identifier: MIT
#include "view_run.h"

#include "interrupt.h"
#include "output.h"
#include "picture_texts.h"
#include "setup/cameras.h"
#include "setup/lighting.h"
#include "setup/objects.h"
#include "view_capture.h"
#include "view_job.h"

#include <stdio.h>

void view_print_done(const view_job *job, const char *what, double draw_seconds)
{
    const alp_render_options *o = &job->settings.render;
    if (job->arguments->values[OPTION_QUIET].given) {
        return;
    }
    printf("wrote      %s, %u x %u, load %.2f s, prepare %.2f s, draw %.3f s\n", what, o->width,
           o->height, job->session.load_seconds, job->prepare_seconds, draw_seconds);
    printf("OpenGL     %s\n", job->gl.renderer);
}

int view_save(view_job *job, const alp_camera *camera, double exposure, alp_image *image,
              const char *path)
{
    session *s = &job->session;
    const picture_facts facts = {job->arguments, s->scene, camera, job->gl.renderer, exposure};
    alp_result result = ALP_OK;
    if (gl_context_check(&job->gl) != EXIT_DONE) {
        return EXIT_FAILED;
    }
    if (path_ends(path, ".png")) {
        result = picture_add_texts(image, &facts);
    }
    if (result == ALP_OK) {
        result = alp_image_save(image, path, job->arguments->values[OPTION_FORCE].given);
        s->has_written |= result == ALP_OK;
    }
    return session_end(s, result);
}

/// Radius of ambient occlusion where none is given, as a share of the scene's diagonal.
static const double SSAO_SHARE = 0.05;

/// @return metres, 0 without ambient occlusion
static float ssao_radius(const session *s, const command_line *a)
{
    const alp_scene_info info = alp_scene_get_info(s->scene);
    return a->values[OPTION_SSAO].choice == 0          ? 0.0f
           : a->values[OPTION_SSAO_RADIUS].choice >= 0 ? (float)(SSAO_SHARE * scene_diagonal(&info))
                                                       : (float)a->values[OPTION_SSAO_RADIUS].real;
}

/// Makes the light of a mode and all that draws it.
/// @param a whose --with is the mode
static int prepare_mode(view_job *job, const command_line *a, const view_mode *mode, drawing *d)
{
    alp_render_options *render = &job->settings.render;
    session *s = &job->session;
    const bool normal_maps =
        (mode->uses & USES_NORMALS) != 0 && a->values[OPTION_NORMAL_MAPS].choice == 1;
    drawing_options options = {.context = s->context,
                               .mode = mode,
                               .lighting = &render->lighting,
                               .width = render->width,
                               .height = render->height,
                               .direct = (mode->uses & USES_SWITCH) == 0 ||
                                         a->values[OPTION_DIRECT].choice == 1,
                               .normal_maps = normal_maps,
                               .metals_black = a->values[OPTION_METALS].choice == 1,
                               .ssao_radius = ssao_radius(s, a)};
    if ((mode->uses & USES_OBJECT) != 0) {
        options.object = render->object;
    }
    int code = normal_maps ? session_end(s, alp_scene_load_normal_maps(s->scene)) : EXIT_DONE;
    if (code == EXIT_DONE && mode->prepare != NULL) {
        code = mode->prepare(s, a, render, &options.light);
    }
    if (code == EXIT_DONE) {
        return drawing_create(s->scene, &options, d);
    }
    mode_light_destroy(&options.light);
    return code;
}

static int prepare_beside(view_job *job)
{
    view_beside *b = &job->beside;
    return b->mode != NULL ? prepare_mode(job, &b->arguments, b->mode, &b->drawing) : EXIT_DONE;
}

static int prepare(view_job *job)
{
    session *s = &job->session;
    view_beside *beside = &job->beside;
    const double start = clock_seconds();
    job->settings.render.progress = session_progress;
    job->settings.render.progress_user = s;
    interrupt_defer();
    int code = EXIT_DONE;
    if (job->arguments->values[OPTION_BESIDE].given) {
        beside->arguments = *job->arguments;
        beside->arguments.values[OPTION_WITH] = job->arguments->values[OPTION_BESIDE];
        beside->mode = view_mode_of(&beside->arguments);
    }
    // A flight comes first: it may set camera and sun of both.
    const bool flown = beside->mode != NULL && beside->mode->field.model == FIELD_AMBIENCE;
    code = flown ? prepare_beside(job) : code;
    if (code == EXIT_DONE) {
        code = prepare_mode(job, job->arguments, job->settings.mode, &job->drawing);
    }
    code = code == EXIT_DONE && !flown ? prepare_beside(job) : code;
    code = code == EXIT_DONE ? gl_context_check(&job->gl) : code;
    progress_clear(&s->progress);
    job->prepare_seconds = clock_seconds() - start;
    return code;
}

/// Loads the image of --reference, before the work.
static int load_reference(view_job *job)
{
    const option_value *reference = &job->arguments->values[OPTION_REFERENCE];
    session *s = &job->session;
    return reference->given
               ? session_end(s, alp_image_load(s->context, reference->text, &job->reference))
               : EXIT_DONE;
}

/// Places the object of --object in the scene that was loaded, and reads its path.
static int place_object(view_job *job)
{
    const command_line *a = job->arguments;
    const alp_scene_info info = alp_scene_get_info(job->session.scene);
    const int code = object_read(a, info.origin, &job->settings.render.object);
    return code == EXIT_DONE && a->values[OPTION_OBJECT_PATH].given
               ? flight_read_places(a->values[OPTION_OBJECT_PATH].text, info.origin,
                                    &job->object_path)
               : code;
}

static int run_scene(view_job *job)
{
    const command_line *a = job->arguments;
    view_settings *v = &job->settings;
    alp_image *sky = NULL;
    int code = lighting_open(&job->session, a, &v->render.lighting, &v->lamps, &sky);
    code = code == EXIT_DONE ? camera_find(&job->session, a, &v->render) : code;
    code = code == EXIT_DONE ? place_object(job) : code;
    code = code == EXIT_DONE ? load_reference(job) : code;
    code = code == EXIT_DONE && a->values[OPTION_PICTURES].given ? view_flight_read(job) : code;
    code = code == EXIT_DONE ? view_pose_find(job) : code;
    code = code == EXIT_DONE ? prepare(job) : code;
    if (code == EXIT_DONE) {
        code = a->values[OPTION_PICTURES].given  ? view_flight(job)
               : a->values[OPTION_CAPTURE].given ? view_capture(job)
                                                 : view_picture(job);
    }
    code = code == EXIT_DONE ? session_judge_warnings(&job->session) : code;
    drawing_destroy(&job->beside.drawing);
    drawing_destroy(&job->drawing);
    view_pose_end(job);
    flight_clear(&job->path);
    flight_clear(&job->object_path);
    alp_image_destroy(job->reference);
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
