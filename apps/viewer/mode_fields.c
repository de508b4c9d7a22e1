// SPDX-License-Identifier: MIT
#include "mode_fields.h"

/// Makes the field of a picture, or opens that of a flight, which begins without light.
static int make_field(session *s, const command_line *a, picture_field field, alp_render_options *o,
                      field_source *source)
{
    return field.model == FIELD_AMBIENCE && a->values[OPTION_PICTURES].given
               ? field_ambience_open(s, a, &o->lighting, source)
               : picture_field_make(s, a, field, o, source);
}

int mode_field_prepare(session *s, const command_line *a, alp_render_options *o, mode_light *light)
{
    const picture_field field = view_mode_of(a)->field;
    const int code = make_field(s, a, field, o, &light->source);
    if (code == EXIT_DONE) {
        gl_field_create(s->scene, a->values[OPTION_READ].choice, o->width, o->height,
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
    const alp_result result = field_lpv_follow(&light->source, camera);
    gl_field_set(&light->field, light->source.field);
    return session_end(s, result);
}
