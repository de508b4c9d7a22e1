// SPDX-License-Identifier: MIT
#include "fields.h"

#include "lighting.h"

#include <math.h>
#include <string.h>

static int read_bounds(const command_line *a, const double origin[3], alp_probe_options *o)
{
    enum { NUMBERS = 6 };
    const option_value *bounds = &a->values[OPTION_BOUNDS];
    double n[NUMBERS];
    if (!bounds->given) {
        return EXIT_DONE;
    }
    const char *end = number_parse_list(bounds->text, n, NUMBERS);
    if (end == NULL || *end != '\0') {
        return usage_error(a->command,
                           "--bounds: '%s' is no box; give X0,Y0,Z0,X1,Y1,Z1 in metres",
                           bounds->text);
    }
    for (int k = 0; k < 3; k++) {
        o->bounds_min[k] = (float)(fmin(n[k], n[k + 3]) - origin[k]);
        o->bounds_max[k] = (float)(fmax(n[k], n[k + 3]) - origin[k]);
    }
    return EXIT_DONE;
}

int probe_options_read(const command_line *a, const alp_lighting_options *lighting,
                       const double origin[3], alp_probe_options *o)
{
    const bool probes = a->command == COMMAND_PROBES;
    *o = alp_probe_options_default();
    o->lighting = *lighting;
    o->bounces = lighting_bounces(a);
    o->seed = a->values[OPTION_SEED].whole;
    o->direct = a->values[OPTION_DIRECT].choice == 1;
    if (a->values[OPTION_SPACING].choice < 0) { // a number
        o->spacing = (float)a->values[OPTION_SPACING].real;
    }
    if (probes) {
        o->basis = (alp_probe_basis)a->values[OPTION_BASIS].choice;
        o->visibility = a->values[OPTION_VISIBILITY].choice == 1;
        o->gradients = a->values[OPTION_GRADIENTS].given;
        o->layers = a->values[OPTION_LAYERS].given;
        o->rays = (uint32_t)a->values[OPTION_SAMPLES].whole;
    }
    return read_bounds(a, origin, o);
}

alp_result field_fit(session *s, const command_line *a, alp_ambient_model model,
                     const alp_lighting_options *lighting, field_source *source)
{
    alp_ambient_options o = alp_ambient_options_default();
    o.model = model;
    o.lighting = *lighting;
    o.bounces = lighting_bounces(a);
    o.direct = a->command == COMMAND_SAMPLE && a->values[OPTION_DIRECT].choice == 1;
    o.seed = a->values[OPTION_SEED].whole;
    o.progress = session_progress;
    o.progress_user = s;
    return alp_field_create_ambient(s->scene, &o, &source->field);
}

int field_probes(session *s, const command_line *a, const alp_lighting_options *lighting,
                 alp_probe_lookup lookup, field_source *source)
{
    const alp_scene_info info = alp_scene_get_info(s->scene);
    alp_probe_options o;
    const int code = probe_options_read(a, lighting, info.origin, &o);
    if (code != EXIT_DONE) {
        return code;
    }
    o.progress = session_progress;
    o.progress_user = s;
    alp_result result = alp_probes_bake(s->scene, &o, &source->probes);
    if (result == ALP_OK) {
        result = alp_field_create_probes(source->probes, lookup, info.origin, NULL,
                                         &source->field);
    }
    return result == ALP_OK ? EXIT_DONE : session_end(s, result);
}

void field_source_clear(field_source *source)
{
    alp_field_destroy(source->field);
    alp_probes_destroy(source->probes);
    *source = (field_source){NULL, NULL};
}
