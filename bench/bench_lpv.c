// SPDX-License-Identifier: MIT
// Light propagation: a frame of cascades by stage, and the goals that all parts are held to.
#include "lpv_parts.h"

#include "fields/propagation/lpv.h"

#include <math.h>

enum { ROUNDS = 9, MAP = 256 };

// --- a frame -------------------------------------------------------------------------------------

/// Medians of the stages over some frames of a scene under a sun that turns.
static alp_result measure_frame(const bench_scene *s, const char *what, uint32_t cascades,
                                uint32_t bounces, uint32_t points, int rounds, bench_table *table,
                                double *milliseconds)
{
    alp_lpv_scene_options so = alp_lpv_scene_options_default();
    const alp_camera camera = alp_scene_get_camera(s->scene, 0);
    double eye[3], forward[3];
    for (int k = 0; k < 3; k++) {
        eye[k] = (double)camera.position[k];
        forward[k] = (double)camera.target[k] - eye[k];
    }
    alp_lpv_options o = cascades > 1
                            ? alp_lpv_options_for_view(s->scene, 32, cascades, eye, forward)
                            : alp_lpv_options_for_scene(s->scene, 32, 1);
    double stages[4][ROUNDS], total[ROUNDS];
    alp_lpv *lpv = NULL;
    o.bounces = bounces;
    so.map_size = rounds > 1 ? MAP : 16;
    so.points = points;
    so.camera = &camera;
    so.lighting.sun.illuminance = 10.0f;
    so.lighting.sun.elevation = 0.9f;
    ALP_TRY(alp_lpv_create(s->context, &o, &lpv));
    alp_result result = cascades > 1 ? alp_lpv_follow(lpv, o.centre, forward) : ALP_OK;
    for (int r = 0; r < rounds && result == ALP_OK; r++) {
        alp_lpv_report report;
        so.lighting.sun.azimuth = 0.00175f * (float)r;
        result = alp_lpv_light_scene(lpv, s->scene, &so, &report);
        const double seconds[4] = {report.trace, report.inject, report.block, report.propagate};
        total[r] = 0.0;
        for (int i = 0; i < 4; i++) {
            stages[i][r] = 1e3 * seconds[i];
            total[r] += i > 0 ? 1e3 * seconds[i] : 0.0;
        }
    }
    if (result == ALP_OK) {
        *milliseconds = bench_median(total, rounds);
        bench_table_add(table, "%s|%.1f|%.1f|%.1f|%.1f|%.1f", what, bench_median(stages[0], rounds),
                        bench_median(stages[1], rounds), bench_median(stages[2], rounds),
                        bench_median(stages[3], rounds), *milliseconds);
    }
    alp_lpv_destroy(lpv);
    return result;
}

static alp_result measure_frames(const bench_options *options, lpv_figures *figures)
{
    bench_scene s;
    bench_table table;
    const int rounds = options->quick ? 1 : ROUNDS;
    double other = 0.0;
    const uint32_t all = ALP_BOUNCES_CONVERGE, points = options->quick ? 256 : 65536;
    bench_table_start(&table, "A frame on all cores",
                      "The atrium under a sun that turns, grids of 32³, milliseconds of the clock. "
                      "Three cascades follow the scene's camera and take 8 steps, one grid takes "
                      "32. Maps have 256² texels, one for "
                      "each cascade. Points: 65,536.",
                      "frame|trace maps|inject|blockers|propagate|all but tracing");
    if (!bench_scene_open("builtin:atrium", 0, &s)) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    alp_result result =
        measure_frame(&s, "3 cascades, views block", 3, 1, 0, rounds, &table, &figures->frame);
    if (result == ALP_OK) {
        result =
            measure_frame(&s, "3 cascades, points block", 3, 1, points, rounds, &table, &other);
    }
    if (result == ALP_OK) {
        result = measure_frame(&s, "the same with bounces", 3, all, points, rounds, &table, &other);
    }
    if (result == ALP_OK) {
        result = measure_frame(&s, "one grid with bounces", 1, all, points, rounds, &table, &other);
    }
    (void)bench_good(&s, result);
    bench_scene_close(&s);
    bench_table_print(&table, options);
    return result;
}

// --- goals ---------------------------------------------------------------------------------------

typedef struct goal {
    const char *what, *wanted;
    double value, bound;
    bool least; // the bound is
} goal;

static void print_goals(const bench_options *options, const lpv_figures *f)
{
    const goal goals[] = {
        {"step at 32³ / floor", "≤ 4", f->step, 4.0, false},
        {"the same with blockers", "≤ 6", f->blocked, 6.0, false},
        {"plain scatter / step", "≥ 20", f->scatter, 20.0, true},
        {"three cascades, views block, ms", "≤ 16", f->frame, 16.0, false},
        {"behind a wall of one cell, %", "≤ 5", f->wall, 5.0, false},
        {"99.9 % of changes a frame, %", "≤ 0.5", f->usual, 0.5, false},
        {"largest change a frame, %", "≤ 2", f->most, 2.0, false},
    };
    bench_table t;
    bench_table_start(&t, "Goals",
                      "Figures of the tables above, of the default mode. Changes a frame: sun and "
                      "camera, maps of 256². They include the change of the light itself.",
                      "goal|wanted|measured|verdict");
    for (size_t i = 0; i < sizeof goals / sizeof *goals; i++) {
        const goal *g = &goals[i];
        const bool met = g->least ? g->value >= g->bound : g->value <= g->bound;
        const char *verdict = options->quick ? "none" : met ? "met" : "missed";
        bench_table_add(&t, "%s|%s|%.2f|%s", g->what, g->wanted, g->value, verdict);
    }
    bench_table_print(&t, options);
}

int bench_lpv(const bench_options *options)
{
    lpv_figures f = {0};
    const bool good =
        lpv_measure_steps(options, &f) == ALP_OK && measure_frames(options, &f) == ALP_OK &&
        lpv_measure_reach(options) == ALP_OK && lpv_measure_walls(options, &f) == ALP_OK &&
        lpv_measure_boxes(options) == ALP_OK && lpv_measure_stability(options, &f) == ALP_OK;
    if (!good) {
        return 1;
    }
    print_goals(options, &f);
    return bench_lpv_truth(options);
}
