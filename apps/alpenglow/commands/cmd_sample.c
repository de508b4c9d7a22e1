// SPDX-License-Identifier: MIT
// alpenglow sample: irradiance of a model of light at points of space.
#include "commands/commands.h"
#include "interrupt.h"
#include "setup/fields.h"
#include "setup/lighting.h"
#include "setup/points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Choices of --with, in its order; the ambient models stand first, in theirs.
enum { WITH_PROBES = ALP_AMBIENT_COUNT, WITH_REFERENCE, WITH_AMBIENCE, WITH_LPV };

static int check_options(const command_line *a)
{
    const option_value *with = &a->values[OPTION_WITH];
    static const struct {
        const char *name;
        option_id id;
        int with;
    } read_by[] = {{"--probes", OPTION_PROBES, WITH_PROBES},
                   {"--spacing", OPTION_SPACING, WITH_PROBES},
                   {"--bounds", OPTION_BOUNDS, WITH_PROBES},
                   {"--samples", OPTION_SAMPLES, WITH_REFERENCE}};
    if (!with->given) {
        return usage_error(COMMAND_SAMPLE,
                           "no model; give --with reference, probes, ambience, lpv, constant, "
                           "hemisphere, ground-map, ambient-cube or environment");
    }
    if (!a->values[OPTION_AT].given) {
        return usage_error(COMMAND_SAMPLE, "no points; give --at POINTS.csv, a line of "
                                           "x,y,z,nx,ny,nz each");
    }
    for (size_t i = 0; i < sizeof read_by / sizeof *read_by; i++) {
        if (a->values[read_by[i].id].given && with->choice != read_by[i].with) {
            return usage_error(COMMAND_SAMPLE, "%s: does not apply to --with %s", read_by[i].name,
                               with->text);
        }
    }
    if (with->choice == WITH_AMBIENCE && a->values[OPTION_PATH].given &&
        strcmp(a->values[OPTION_PATH].text, "-") == 0 &&
        strcmp(a->values[OPTION_AT].text, "-") == 0) {
        return usage_error(COMMAND_SAMPLE, "--path and --at are both standard input; give one of "
                                           "them a file");
    }
    const field_model model = with->choice == WITH_AMBIENCE ? FIELD_AMBIENCE
                              : with->choice == WITH_LPV    ? FIELD_LPV
                              : with->choice == WITH_PROBES ? FIELD_PROBES
                                                            : FIELD_OTHER;
    return field_check(a, 1u << model);
}

typedef struct sampled {
    float (*irradiance)[3];
    float (*deviations)[3]; // of the reference, by channel
    float *errors;          // RMS over the channels
} sampled;

static int trace_reference(session *s, const command_line *a, const alp_lighting_options *lighting,
                           const point_list *points, sampled *out)
{
    alp_reference_options o = alp_reference_options_default();
    o.lighting = *lighting;
    o.bounces = lighting_bounces(a);
    o.samples = (uint32_t)a->values[OPTION_SAMPLES].whole;
    o.direct = a->values[OPTION_DIRECT].choice == 1;
    o.seed = a->values[OPTION_SEED].whole;
    o.progress = session_progress;
    o.progress_user = s;
    const int code = session_end(s, alp_reference_irradiance(s->scene, &o, points->count,
                                                             (const float(*)[3])points->positions,
                                                             (const float(*)[3])points->normals,
                                                             out->irradiance, out->deviations));
    for (uint32_t i = 0; i < points->count; i++) {
        const float *d = out->deviations[i];
        out->errors[i] = sqrtf((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / 3.0f);
    }
    return code;
}

static int read_field(session *s, const command_line *a, const alp_lighting_options *lighting,
                      const point_list *points, sampled *out)
{
    const int with = a->values[OPTION_WITH].choice;
    field_source source = {0};
    int code = EXIT_DONE;
    if (with == WITH_PROBES) {
        code = field_probes(s, a, lighting, ALP_LOOKUP_OURS, &source);
    } else if (with == WITH_AMBIENCE) {
        code = field_ambience(s, a, lighting, &source);
    } else if (with == WITH_LPV) {
        code = field_lpv(s, a, lighting, NULL, &source);
    } else {
        code = session_end(s, field_fit(s, a, (alp_ambient_model)with, lighting, &source));
    }
    if (code == EXIT_DONE) {
        alp_field_irradiance(source.field, points->count, (const float(*)[3])points->positions,
                             (const float(*)[3])points->normals, out->irradiance);
        alp_field_errors(source.field, points->count, (const float(*)[3])points->positions,
                         (const float(*)[3])points->normals, out->errors);
        code = session_end(s, ALP_OK);
    }
    field_source_clear(&source);
    return code;
}

static void print_points(const point_list *points, const sampled *out)
{
    puts("x,y,z,nx,ny,nz,r,g,b,error");
    for (uint32_t i = 0; i < points->count; i++) {
        const float *e = out->irradiance[i];
        for (const char *c = points->texts[i]; *c != '\0'; c++) { // as CSV, however it was parted
            const bool parts = *c == ';' || *c == ' ' || *c == '\t';
            if (!parts) {
                putchar(*c);
            } else if (c[1] != ',' && c[1] != ';' && c[1] != ' ' && c[1] != '\t' &&
                       (c == points->texts[i] || c[-1] != ',')) {
                putchar(',');
            }
        }
        printf(",%.7g,%.7g,%.7g,%.3g\n", (double)e[0], (double)e[1], (double)e[2],
               (double)out->errors[i]);
    }
}

static int sample(session *s, const command_line *a, const alp_lighting_options *lighting,
                  const point_list *points)
{
    const size_t count = points->count;
    sampled out = {.irradiance = allocate_or_exit(NULL, count * sizeof *out.irradiance),
                   .deviations = allocate_or_exit(NULL, count * sizeof *out.deviations),
                   .errors = allocate_or_exit(NULL, count * sizeof *out.errors)};
    interrupt_defer();
    int code = a->values[OPTION_WITH].choice == WITH_REFERENCE
                   ? trace_reference(s, a, lighting, points, &out)
                   : read_field(s, a, lighting, points, &out);
    if (code == EXIT_DONE) {
        print_points(points, &out);
        code = session_judge_warnings(s);
    }
    free(out.irradiance);
    free(out.deviations);
    free(out.errors);
    return code;
}

int command_sample(const command_line *a)
{
    alp_lighting_options lighting;
    lamp_list lamps;
    point_list points = {0};
    alp_image *sky;
    session s;
    int code = check_options(a);
    code = code == EXIT_DONE ? lighting_read(a, &lighting, &lamps) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    code = lighting_open(&s, a, &lighting, &lamps, &sky);
    if (code == EXIT_DONE) {
        const alp_scene_info info = alp_scene_get_info(s.scene);
        code = points_read(a->values[OPTION_AT].text, true, info.origin, &points);
    }
    code = code == EXIT_DONE ? sample(&s, a, &lighting, &points) : code;
    alp_image_destroy(sky);
    points_clear(&points);
    session_close(&s);
    return code;
}
