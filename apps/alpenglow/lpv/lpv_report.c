// SPDX-License-Identifier: MIT
#include "lpv/lpv_report.h"

#include "output.h"
#include "printing/report.h"

#include <math.h>
#include <stdlib.h>

static const char *const stage_names[LPV_STAGES] = {"trace", "inject", "block", "propagate",
                                                    "frame"};

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void lpv_record_sort(lpv_record *r)
{
    for (int stage = 0; stage < LPV_STAGES; stage++) {
        qsort(r->milliseconds[stage], r->count, sizeof(double), compare);
    }
}

static double median_of(const lpv_record *r, int stage)
{
    const double *sorted = r->milliseconds[stage];
    return 0.5 * (sorted[(r->count - 1) / 2] + sorted[r->count / 2]);
}

static double worst_of(const lpv_record *r, int stage)
{
    return r->milliseconds[stage][r->count - 1];
}

void lpv_print(const lpv_run *run, const lpv_record *r)
{
    const alp_lpv_options *o = &run->options;
    const alp_lpv_report *last = &r->last;
    puts("stage      median ms   worst ms");
    for (int stage = 0; stage < LPV_STAGES; stage++) {
        printf("%-10s %9.3g  %9.3g\n", stage_names[stage], median_of(r, stage), worst_of(r, stage));
    }
    printf("frames     %u, %llu ray%s and %llu virtual light%s each\n", r->count,
           (unsigned long long)last->rays, plural(last->rays), (unsigned long long)last->lights,
           plural(last->lights));
    printf("memory     %.3g MB, %u grid%s of %u x %u x %u cells, the finest of %.3g m\n",
           1e-6 * (double)alp_lpv_memory(o), o->cascades, plural(o->cascades), o->size[0],
           o->size[1], o->size[2], o->cell);
    printf("flux       %.4g %.4g %.4g W injected, red, green and blue\n", last->flux[0],
           last->flux[1], last->flux[2]);
}

// --- JSON ----------------------------------------------------------------------------------------

static json_t *make_options(const lpv_run *run, const command_line *a, const lpv_record *r)
{
    const alp_lpv_options *o = &run->options;
    return json_pack(
        "{s:I, s:o, s:I, s:I, s:s, s:s, s:o, s:I, s:o, s:I, s:I}", "grid", (json_int_t)o->size[0],
        "cell", json_number(o->cell), "cascades", (json_int_t)o->cascades, "iterations",
        (json_int_t)alp_lpv_iterations(run->lpv), "mode", a->values[OPTION_MODE].text, "blockers",
        a->values[OPTION_BLOCKERS].text, "bounces",
        o->bounces == 1 ? json_integer(1) : json_string("converge"), "frames", (json_int_t)r->count,
        "sun_turn", json_number(r->sun_turn * (180.0 / M_PI)), "map_size",
        (json_int_t)run->frame.map_size, "points", (json_int_t)run->frame.points);
}

static json_t *make_milliseconds(const lpv_record *r)
{
    json_t *stages = json_object();
    for (int stage = 0; stage < LPV_STAGES; stage++) {
        json_object_set_new(stages, stage_names[stage],
                            json_pack("{s:o, s:o}", "median", json_number(median_of(r, stage)),
                                      "worst", json_number(worst_of(r, stage))));
    }
    return stages;
}

json_t *lpv_json(const lpv_run *run, const command_line *a, const lpv_record *r)
{
    const alp_scene_info info = alp_scene_get_info(run->session->scene);
    const alp_lpv_report *last = &r->last;
    return json_pack("{s:s, s:{s:I, s:I}, s:o, s:I, s:o, s:I, s:I, s:I, s:[o, o, o], s:o}",
                     "version", alp_version(), "scene", "triangles", (json_int_t)info.triangles,
                     "surfaces", (json_int_t)info.surfaces, "options", make_options(run, a, r),
                     "seed", (json_int_t)a->values[OPTION_SEED].whole, "milliseconds",
                     make_milliseconds(r), "rays", (json_int_t)last->rays, "lights",
                     (json_int_t)last->lights, "bytes", (json_int_t)alp_lpv_memory(&run->options),
                     "flux", json_number(last->flux[0]), json_number(last->flux[1]),
                     json_number(last->flux[2]), "warnings",
                     report_warnings(&run->session->messages));
}
