// SPDX-License-Identifier: MIT
#include "picture_fields.h"

/// Flies, and takes light and, without --camera, the view of the last moment.
static int make_ambience(session *s, const command_line *a, alp_render_options *o,
                         field_source *source)
{
    const int code = field_ambience(s, a, &o->lighting, source);
    if (code == EXIT_DONE) {
        const flight_run *run = source->flight;
        const flight_camera camera = flight_run_camera(run);
        o->lighting = run->lighting;
        o->camera = a->values[OPTION_CAMERA].given ? o->camera : flight_view(&camera);
    }
    return code;
}

/// Finds the camera, which the grids follow.
static int find_camera(session *s, const command_line *a, alp_render_options *o)
{
    if (a->values[OPTION_SKY].given) {
        session_warn(s, "no-sky", "--sky",
                     "light propagation holds no sky, which is background only; --with probes "
                     "holds its light");
    }
    const alp_result result = alp_render_find_camera(s->scene, o, &o->camera);
    return result == ALP_OK ? EXIT_DONE : session_end(s, result);
}

int picture_field_open_lpv(session *s, const command_line *a, alp_render_options *o,
                           field_source *source)
{
    const int code = find_camera(s, a, o);
    return code == EXIT_DONE ? field_lpv_open(s, a, &o->lighting, &o->camera, source) : code;
}

/// Propagates light through grids that follow the camera of the picture.
static int make_lpv(session *s, const command_line *a, alp_render_options *o, field_source *source)
{
    int code = find_camera(s, a, o);
    code = code == EXIT_DONE ? field_lpv(s, a, &o->lighting, &o->camera, source) : code;
    o->lpv = source->lpv != NULL ? source->lpv->lpv : NULL;
    return code;
}

int picture_field_make(session *s, const command_line *a, picture_field field,
                       alp_render_options *o, field_source *source)
{
    alp_result result = ALP_OK;
    switch (field.model) {
    case FIELD_AMBIENCE:
        return make_ambience(s, a, o, source);
    case FIELD_LPV:
        return make_lpv(s, a, o, source);
    case FIELD_PROBES:
        return field_probes(s, a, &o->lighting, (alp_probe_lookup)a->values[OPTION_LOOKUP].choice,
                            source);
    default:
        result = field_fit(s, a, field.ambient, &o->lighting, source);
        return result == ALP_OK ? EXIT_DONE : session_end(s, result);
    }
}
