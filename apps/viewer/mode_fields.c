// SPDX-License-Identifier: MIT
#include "mode_fields.h"

#include "shaders/bindings.h"

/// Makes the field of a picture, or opens that of a flight, which begins without light.
static int make_field(session *s, const command_line *a, picture_field field, alp_render_options *o,
                      field_source *source)
{
    return field.model == FIELD_AMBIENCE && a->values[OPTION_PICTURES].given
               ? field_ambience_open(s, a, &o->lighting, source)
               : picture_field_make(s, a, field, o, source);
}

/// Makes the volume of a picture on the card.
static int prepare_volume(session *s, const command_line *a, alp_render_options *o,
                          mode_light *light)
{
    int code = picture_field_open_lpv(s, a, o, &light->source);
    if (code == EXIT_DONE) {
        const lpv_run *run = light->source.lpv;
        light->lpv = allocate_or_exit(NULL, sizeof *light->lpv);
        const alp_result result =
            lpv_frame_create(s->scene, &run->options, &run->frame, &code, light->lpv);
        code = result == ALP_OK ? code : session_end(s, result);
    }
    if (code == EXIT_DONE) {
        code = gl_field_create(s->scene, READ_PIXEL, 1, 1, &light->field);
        gl_field_set_volume(&light->field, &light->lpv->volume, a->values[OPTION_GLOSS].given);
        light->scattering = (float)a->values[OPTION_MEDIA].real;
    }
    return code;
}

int mode_field_prepare(session *s, const command_line *a, alp_render_options *o, mode_light *light)
{
    const picture_field field = view_mode_of(a)->field;
    if (field.model == FIELD_LPV && a->values[OPTION_READ].choice == READ_PIXEL) {
        return prepare_volume(s, a, o, light);
    }
    int code = make_field(s, a, field, o, &light->source);
    if (code == EXIT_DONE) {
        code = gl_field_create(s->scene, a->values[OPTION_READ].choice, o->width, o->height,
                               &light->field);
        light->field.workers = alp_context_worker_count(s->context);
        gl_field_set(&light->field, light->source.field);
    }
    if (code == EXIT_DONE && field.model == FIELD_PROBES &&
        a->values[OPTION_LOOKUP].choice == (int)ALP_LOOKUP_OURS) {
        gl_field_set_probes(&light->field, light->source.probes,
                            alp_scene_get_info(s->scene).origin);
    }
    return code;
}

void mode_field_bind(const mode_light *light, GLuint program)
{
    gl_field_bind(&light->field, program);
    mode_light_bind_ssao(light);
    gl_lights_bind(&light->lights);
}

int mode_ambience_move(session *s, double time, const alp_camera *camera, mode_light *light)
{
    (void)camera; // the volume flies along the same lines
    const alp_result result = field_ambience_reach(&light->source, time);
    gl_field_set(&light->field, light->source.field);
    return session_end(s, result);
}

int mode_lpv_move(session *s, double time, const alp_camera *camera, mode_light *light)
{
    (void)time;
    if (light->field.read == READ_LPV) {
        return EXIT_DONE; // each picture lights the volume
    }
    const alp_result result = field_lpv_follow(&light->source, camera);
    gl_field_set(&light->field, light->source.field);
    return session_end(s, result);
}
