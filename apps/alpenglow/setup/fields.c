// SPDX-License-Identifier: MIT
#include "setup/fields.h"

#include "setup/lighting.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
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
        return usage_error(a->command, "--bounds: '%s' is no box; give X0,Y0,Z0,X1,Y1,Z1 in metres",
                           bounds->text);
    }
    if (n[0] == n[3] && n[1] == n[4] && n[2] == n[5]) {
        return usage_error(a->command, "--bounds: '%s' has no extent; give two corners of a box",
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
    const bool here = a->command == COMMAND_PROBES || a->command == COMMAND_SAMPLE;
    o->direct = here && a->values[OPTION_DIRECT].choice == 1;
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

int probe_file_check(const command_line *a)
{
    if (a->values[OPTION_PROBES].given &&
        (a->values[OPTION_SPACING].given || a->values[OPTION_BOUNDS].given)) {
        return usage_error(a->command,
                           "--spacing and --bounds bake probes; leave them out with --probes");
    }
    // The file holds its light. A picture adds sky, sun and lamps of its own.
    static const struct {
        const char *name;
        option_id id;
        bool picture;
    } baked[] = {{"--bounces", OPTION_BOUNCES, true}, {"--direct", OPTION_DIRECT, false},
                 {"--sky", OPTION_SKY, false},        {"--sun", OPTION_SUN, false},
                 {"--lamp", OPTION_LAMP, false},      {"--spot", OPTION_SPOT, false},
                 {"--metals", OPTION_METALS, false},  {"--seed", OPTION_SEED, false}};
    const bool sampled = a->command == COMMAND_SAMPLE;
    for (size_t i = 0; i < sizeof baked / sizeof *baked && a->values[OPTION_PROBES].given; i++) {
        if (a->values[baked[i].id].given && (sampled || baked[i].picture) &&
            a->command != COMMAND_INFO) {
            return usage_error(a->command,
                               "%s: the probes of a file hold their light; leave it out "
                               "with --probes",
                               baked[i].name);
        }
    }
    alp_probe_options unused;
    return read_bounds(a, (const double[3]){0.0, 0.0, 0.0}, &unused);
}

int field_check(const command_line *a, unsigned models)
{
    const bool ambience = (models >> FIELD_AMBIENCE & 1u) != 0;
    const bool lpv = (models >> FIELD_LPV & 1u) != 0;
    int code = ambience ? flight_run_check(a) : flight_run_refuse(a);
    if (code == EXIT_DONE) {
        code = lpv ? lpv_run_check(a) : lpv_run_refuse(a);
    }
    if (code == EXIT_DONE && a->values[OPTION_CELL].given && !ambience && !lpv) {
        return usage_error(a->command, "--cell: does not apply to --with %s",
                           a->values[OPTION_WITH].text);
    }
    return code == EXIT_DONE ? probe_file_check(a) : code;
}

alp_result field_fit(session *s, const command_line *a, alp_ambient_model model,
                     const alp_lighting_options *lighting, field_source *source)
{
    alp_ambient_options o = alp_ambient_options_default();
    o.model = model;
    o.lighting = *lighting;
    o.bounces = lighting_bounces(a);
    o.direct = !command_is_picture(a->command) && a->values[OPTION_DIRECT].choice == 1;
    o.seed = a->values[OPTION_SEED].whole;
    o.progress = session_progress;
    o.progress_user = s;
    return alp_field_create_ambient(s->scene, &o, &source->field);
}

/// Loads probes, and warns where they are of another scene.
static alp_result load_probes(session *s, const char *path, const alp_scene_info *info,
                              alp_probes **probes)
{
    const alp_result result = alp_probes_load(s->context, path, probes);
    if (result == ALP_OK && alp_probes_get_info(*probes).scene_hash != info->hash) {
        session_warn(s, "other-scene", path,
                     "the probes were baked in another scene, or in this one before it changed; "
                     "bake them again");
    }
    return result;
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
    const option_value *file = &a->values[OPTION_PROBES];
    alp_result result = file->given ? load_probes(s, file->text, &info, &source->probes)
                                    : alp_probes_bake(s->scene, &o, &source->probes);
    if (result == ALP_OK) {
        result = alp_field_create_probes(source->probes, lookup, info.origin, NULL, &source->field);
    }
    return result == ALP_OK ? EXIT_DONE : session_end(s, result);
}

int field_ambience_open(session *s, const command_line *a, const alp_lighting_options *lighting,
                        field_source *source)
{
    source->flight = allocate_or_exit(NULL, sizeof *source->flight);
    return flight_run_open(s, a, lighting, source->flight);
}

alp_result field_ambience_reach(field_source *source, double time)
{
    flight_run *run = source->flight;
    alp_result result = flight_run_reach(run, time);
    alp_field_destroy(source->field);
    source->field = NULL;
    if (result == ALP_OK) { // what the last frame sampled counts from the next update on
        result = alp_ambience_update(run->ambience, fmin(time, run->end));
    }
    return result == ALP_OK ? alp_field_create_ambience(run->ambience, &source->field) : result;
}

int field_ambience(session *s, const command_line *a, const alp_lighting_options *lighting,
                   field_source *source)
{
    const int code = field_ambience_open(s, a, lighting, source);
    return code == EXIT_DONE ? session_end(s, field_ambience_reach(source, source->flight->end))
                             : code;
}

int field_lpv_open(session *s, const command_line *a, const alp_lighting_options *lighting,
                   const alp_camera *camera, field_source *source)
{
    source->lpv = allocate_or_exit(NULL, sizeof *source->lpv);
    return lpv_run_open(s, a, lighting, camera, source->lpv);
}

int field_lpv(session *s, const command_line *a, const alp_lighting_options *lighting,
              const alp_camera *camera, field_source *source)
{
    const int code = field_lpv_open(s, a, lighting, camera, source);
    if (code != EXIT_DONE) {
        return code;
    }
    alp_result result = lpv_run_light(source->lpv, NULL);
    if (result == ALP_OK) {
        result = alp_field_create_lpv(source->lpv->lpv, &source->field);
    }
    return session_end(s, result);
}

alp_result field_lpv_follow(field_source *source, const alp_camera *camera)
{
    const alp_result result = lpv_run_follow(source->lpv, camera);
    return result == ALP_OK ? lpv_run_light(source->lpv, NULL) : result;
}

void probes_print(const alp_probes *probes)
{
    const alp_probes_info info = alp_probes_get_info(probes), *i = &info;
    static const char *const bases[] = {"sh9", "sh4", "ambient-cube"};
    if (i->is_list) {
        printf("probes     %u at listed places", i->count);
    } else {
        printf("probes     %u = %u x %u x %u, %g m apart", i->count, i->size[0], i->size[1],
               i->size[2], (double)i->spacing[0]);
    }
    printf(", %s%s%s\n", bases[i->basis], i->direct ? ", direct light in them" : "",
           i->gradients ? ", gradients" : "");
    printf("states     %u valid, %u moved out of solids, %u filled in solids, %u black\n",
           i->states[ALP_PROBE_VALID], i->states[ALP_PROBE_MOVED], i->states[ALP_PROBE_FILLED],
           i->states[ALP_PROBE_INVALID]);
    for (uint32_t k = 0; k < i->layers; k++) {
        printf("%s%s%s", k == 0 ? "layers     " : ", ", alp_probes_layer_name(probes, k),
               k + 1 == i->layers ? "\n" : "");
    }
    printf("mean irradiance %.4g W/m2\n", (double)i->mean);
    printf("noise      %.2g %% of the mean, %u ray%s a probe\n", 100.0 * (double)i->error, i->rays,
           plural(i->rays));
    if (!i->is_list && i->mean > 0.0f && i->interpolation > 0.0f) {
        printf("between    %.2g %% of the mean, by points apart\n",
               100.0 * (double)i->interpolation / (double)i->mean);
    }
    printf("memory     %.3g MB, %.0f bytes a probe\n", (double)i->bytes * 1e-6,
           (double)i->bytes / (double)i->count);
}

void field_source_clear(field_source *source)
{
    alp_field_destroy(source->field);
    alp_probes_destroy(source->probes);
    if (source->flight != NULL) {
        flight_run_close(source->flight);
        free(source->flight);
    }
    if (source->lpv != NULL) {
        lpv_run_close(source->lpv);
        free(source->lpv);
    }
    *source = (field_source){0};
}
