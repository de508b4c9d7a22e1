// SPDX-License-Identifier: MIT
// How light at fixed points changes from frame to frame while a camera flies by: sun and geometry
// stand still, so each change is an artefact of the volume.
#include "ambience_world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SECONDS 5.0
enum { HALVES = 10, WAYS = 4, PATHS = 16, FRAMES_MOST = 1024 };
static const char *const names[WAYS] = {"ours", "ours, no fade", "conformance",
                                        "conformance, no fade"};

typedef struct jumps_bench {
    const bench_options *options;
    ambience_world world;
    ambience_points points;
    float (*before[2])[3];             // E at the last frame, of both views
    double largest[WAYS][FRAMES_MOST]; // change of each frame, W·m⁻²
    double mean;                       // E of the first run
    int frames;
    double rate;
} jumps_bench;

static void compare_frame(jumps_bench *b, const ambience_run *run, int frame, bool fades)
{
    const alp_ambience_snapshot *now = alp_ambience_begin_read(run->ambience);
    ambience_points *p = &b->points;
    for (int view = 0; view < 2; view++) {
        const int way = 2 * view + (fades ? 0 : 1);
        double most = 0.0;
        ambience_view_read(now, view == 0 ? VIEW_OURS : VIEW_CONFORMANCE, p->count,
                           (const double(*)[3])p->positions, (const float(*)[3])p->normals,
                           p->values);
        for (uint32_t i = 0; i < 3 * p->count; i++) {
            const double e = (double)p->values[i / 3][i % 3];
            most = fmax(most, fabs(e - (double)b->before[view][i / 3][i % 3]));
            b->mean += way == 0 ? e / (3.0 * p->count * b->frames) : 0.0;
        }
        b->largest[way][frame] = frame > 0 ? most : 0.0;
        memcpy(b->before[view], p->values, p->count * sizeof *p->values);
    }
    alp_ambience_end_read(run->ambience, now);
}

/// One flight: the volume is warm when it begins.
static bool fly(jumps_bench *b, bool fades)
{
    alp_ambience_options o = alp_ambience_options_default();
    ambience_run run;
    alp_ambience_camera camera;
    const int warm = (int)(WORLD_STANDS * b->rate);
    o.fade = fades ? o.fade : 0.0;
    bool good = ambience_run_open(&b->world, &o, &run);
    for (int frame = 0; frame < warm + b->frames && good; frame++) {
        const double time = frame / b->rate;
        ambience_world_fly(&b->world, 0, time, &camera);
        good = ambience_run_step(&b->world, &run, time, &camera,
                                 b->options->quick ? 8 : WORLD_SAMPLES);
        if (good && frame >= warm) {
            compare_frame(b, &run, frame - warm, fades);
        }
    }
    ambience_run_close(&run);
    return good;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print_summary(const jumps_bench *b)
{
    static bench_table table;
    static double sorted[FRAMES_MOST];
    bench_table_start(&table, "Changes from frame to frame",
                      "The largest change of E at 64 fixed points along a flight of five seconds "
                      "by rays, in percent of the mean E: over all frames, of the frame that 99 % "
                      "do not exceed, of the middle frame; and frames with a change above 1 %.",
                      "look-up|largest, %|of 99 %|of half|frames above 1 %");
    for (int way = 0; way < WAYS; way++) {
        int above = 0;
        memcpy(sorted, b->largest[way], (size_t)b->frames * sizeof *sorted);
        qsort(sorted, (size_t)b->frames, sizeof *sorted, compare);
        for (int i = 0; i < b->frames; i++) {
            above += sorted[i] > 0.01 * b->mean ? 1 : 0;
        }
        bench_table_add(&table, "%s|%.2f|%.2f|%.2f|%d", names[way],
                        100.0 * sorted[b->frames - 1] / b->mean,
                        100.0 * sorted[(b->frames - 1) * 99 / 100] / b->mean,
                        100.0 * sorted[b->frames / 2] / b->mean, above);
    }
    bench_table_print(&table, b->options);
}

static void print_plot(const jumps_bench *b)
{
    static bench_table table;
    bench_table_start(&table, "Largest change of a frame in each half second, %",
                      "The same flight, in percent of the mean E.",
                      "until s|ours|ours, no fade|conformance|conformance, no fade");
    for (int half = 0; half < HALVES; half++) {
        double most[WAYS] = {0.0};
        for (int way = 0; way < WAYS; way++) {
            for (int i = half * b->frames / HALVES; i < (half + 1) * b->frames / HALVES; i++) {
                most[way] = fmax(most[way], 100.0 * b->largest[way][i] / b->mean);
            }
        }
        bench_table_add(&table, "%.1f|%.2f|%.2f|%.2f|%.2f", SECONDS * (half + 1) / HALVES, most[0],
                        most[1], most[2], most[3]);
    }
    bench_table_print(&table, b->options);
}

int bench_ambience_jumps(const bench_options *options)
{
    static jumps_bench b;
    b = (jumps_bench){.options = options, .rate = options->quick ? 2.0 : WORLD_FRAMES};
    b.frames = (int)(SECONDS * b.rate);
    if (!ambience_world_open(options->quick ? "builtin:terrain,triangles=5000,trees=20"
                                            : "builtin:terrain",
                             0, options->quick, &b.world)) {
        return 1;
    }
    alp_ambience_camera middle;
    ambience_world_fly(&b.world, 0, WORLD_STANDS + 0.5 * SECONDS, &middle);
    bool good = ambience_points_open(&b.world, middle.position, WORLD_REACH, 7, PATHS, &b.points);
    for (int i = 0; i < 2 && good; i++) {
        b.before[i] = bench_allocate(b.points.count, sizeof *b.before[i]);
    }
    good = good && fly(&b, true) && fly(&b, false);
    if (good) {
        print_summary(&b);
        print_plot(&b);
    }
    free(b.before[0]);
    free(b.before[1]);
    ambience_points_close(&b.points);
    ambience_world_close(&b.world);
    return good ? 0 : 1;
}
