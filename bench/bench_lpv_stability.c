// SPDX-License-Identifier: MIT
// Changes of E from frame to frame at fixed points of the atrium, while the sun turns and the
// camera moves.
#include "lpv_parts.h"

#include "fields/propagation/lpv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 1000, FRAMES_MOST = 30 };

typedef struct walk {
    const char *what;
    double step, turn;         // metres and degrees a frame
    uint32_t map_size, frames; // texels along a side
} walk;

typedef struct changes {
    float positions[POINTS][3], normals[POINTS][3], last[POINTS][3], now[POINTS][3];
    float all[FRAMES_MOST * POINTS]; // over the mean
    uint32_t count;
} changes;

static void add_frame(changes *c, const alp_field *field, bool first)
{
    double mean = 0.0;
    alp_field_irradiance(field, POINTS, (const float(*)[3])c->positions,
                         (const float(*)[3])c->normals, c->now);
    for (int i = 0; i < POINTS; i++) {
        mean += (double)c->now[i][0] / POINTS;
    }
    for (int i = 0; i < POINTS && !first; i++) {
        const double change = fabs((double)c->now[i][0] - (double)c->last[i][0]);
        c->all[c->count++] = (float)(change / fmax(mean, 1e-30));
    }
    memcpy(c->last, c->now, sizeof c->now);
}

static int by_size(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/// The change in % of the mean below which a share of the changes is.
static double quantile(changes *c, double share)
{
    qsort(c->all, c->count, sizeof *c->all, by_size);
    return 100.0 * (double)c->all[(size_t)((double)(c->count - 1) * share)];
}

/// Three grids of 32³ and .25 m round the middle of the scene, which the points are near.
static alp_result run_walk(const bench_scene *s, const walk *w, changes *c)
{
    alp_lpv_options o = alp_lpv_options_for_scene(s->scene, 32, 3);
    alp_lpv_scene_options so = alp_lpv_scene_options_default();
    alp_lpv *lpv = NULL;
    alp_field *field = NULL;
    const float middle[3] = {(float)o.centre[0] + 4.0f, (float)o.centre[1], (float)o.centre[2]};
    o.cell = 0.25;
    so.map_size = w->map_size;
    so.lighting.sun.illuminance = 10.0f;
    so.lighting.sun.elevation = 0.9f;
    c->count = 0;
    ALP_TRY(
        alp_scene_free_points_near(s->scene, middle, 6.0f, 3, POINTS, c->positions, c->normals));
    ALP_TRY(alp_lpv_create(s->context, &o, &lpv));
    alp_result result = alp_field_create_lpv(lpv, &field);
    for (uint32_t i = 0; i < w->frames && result == ALP_OK; i++) {
        const double ahead[3] = {1.0, 0.0, 0.0};
        const double eye[3] = {o.centre[0] + w->step * i - 0.28, o.centre[1], o.centre[2]};
        so.lighting.sun.azimuth = (float)(0.3 + w->turn * i * ALPI_PI / 180.0);
        result = alp_lpv_follow(lpv, eye, ahead);
        if (result == ALP_OK) {
            result = alp_lpv_light_scene(lpv, s->scene, &so, NULL);
        }
        if (result == ALP_OK) {
            add_frame(c, field, i == 0);
        }
    }
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
    return result;
}

alp_result lpv_measure_stability(const bench_options *options, lpv_figures *figures)
{
    static const walk walks[] = {
        {"sun", 0.0, 0.1, 256, 30},  {"camera", 0.01, 0.0, 256, 30},  {"both", 0.01, 0.1, 256, 30},
        {"sun", 0.0, 0.1, 1024, 10}, {"camera", 0.01, 0.0, 1024, 10}, {"both", 0.01, 0.1, 1024, 10},
        {"sun", 0.0, 0.1, 4096, 2},
    };
    static changes c;
    bench_scene s;
    bench_table table;
    bench_table_start(&table, "Stability",
                      "Changes of E from frame to frame at 1,000 fixed points of the atrium, in % "
                      "of the mean. The sun turns by 0.1 degrees a frame, the camera moves by 1 "
                      "cm; three grids of 32³. Maps of 4096² texels show how the light itself "
                      "changes.",
                      "what moves|map|frames|median|99.9 %|largest");
    if (!bench_scene_open("builtin:atrium", 0, &s)) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    alp_result result = ALP_OK;
    const int count = options->quick ? 1 : (int)(sizeof walks / sizeof *walks);
    for (int i = 0; i < count && result == ALP_OK; i++) {
        walk w = walks[i];
        w.map_size = options->quick ? 16 : w.map_size;
        w.frames = options->quick ? 2 : w.frames;
        result = run_walk(&s, &w, &c);
        const double usual = result == ALP_OK ? quantile(&c, 0.999) : 0.0;
        const double most = result == ALP_OK ? quantile(&c, 1.0) : 0.0;
        const double median = result == ALP_OK ? quantile(&c, 0.5) : 0.0;
        bench_table_add(&table, "%s|%u²|%u|%.3f|%.2f|%.2f", w.what, w.map_size, w.frames, median,
                        usual, most);
        if (i == 2) { // both, with maps of the default size
            figures->usual = usual;
            figures->most = most;
        }
    }
    (void)bench_good(&s, result);
    bench_scene_close(&s);
    bench_table_print(&table, options);
    return result;
}
