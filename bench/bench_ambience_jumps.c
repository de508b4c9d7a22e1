// SPDX-License-Identifier: MIT
// Changes of light from frame to frame at fixed points while a camera flies by, and along a line in
// space. Sun and geometry stand still, so each jump is an artefact of the volume.
#include "ambience_line.h"
#include "plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SECONDS 5.0
enum { HALVES = 10, WAYS = 4, PATHS = 16, LINE_PATHS = 2048, FRAMES_MOST = 1024 };
enum { SERIES = 3 /* the first ways */ };
/// Fades of this many times the mean E in a second end within a frame.
static const float AT_ONCE = 1e6f;
static const char *const names[WAYS] = {"ours", "ours, no fade", "conformance",
                                        "conformance, no fade"};

typedef struct jumps_bench {
    const bench_options *options;
    ambience_world world;
    ambience_points points;
    float (*before[2])[3];             // E at the last frame, of both views
    double largest[WAYS][FRAMES_MOST]; // change of each frame, W·m⁻²
    double mean;                       // E of the first run
    float *series[SERIES];             // [points][frames] E: by the first ways
    ambience_line line;                // at half of the flight, with fade
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
        for (uint32_t i = 0; i < p->count && way < SERIES; i++) {
            const float *e = p->values[i];
            b->series[way][(int)i * b->frames + frame] = (e[0] + e[1] + e[2]) / 3.0f;
        }
        b->largest[way][frame] = frame > 0 ? most : 0.0;
        memcpy(b->before[view], p->values, p->count * sizeof *p->values);
    }
    if (fades && frame == b->frames / 2) {
        ambience_line_read(now, &b->line);
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
    if (good && !fades) {
        run.ambience->fade_rate = AT_ONCE;
    }
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

static void print_halves(const jumps_bench *b)
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

static double error_of(const ambience_line *line, const float *values)
{
    double apart = 0.0, sum = 0.0;
    for (int i = 0; i < LINE_TRUTHS; i++) {
        const int at = i * LINE_STEPS / (LINE_TRUTHS - 1);
        apart += fabs((double)values[at] - (double)line->truth[i]);
        sum += (double)line->truth[i];
    }
    return 100.0 * apart / sum;
}

static void print_line(const jumps_bench *b)
{
    static bench_table table;
    const ambience_line *l = &b->line;
    bench_table_start(&table, "Steps along a line of 20 m",
                      "Half a flight's way about its middle, anchors frozen: the largest change of "
                      "E in a step of 1 mm, in percent of the mean E, and the mean error at 41 "
                      "points.",
                      "look-up|largest step, %|error, %");
    bench_table_add(&table, "ours|%.3f|%.1f", 100.0 * ambience_line_jump(l->ours) / b->mean,
                    error_of(l, l->ours));
    bench_table_add(&table, "conformance|%.3f|%.1f",
                    100.0 * ambience_line_jump(l->conformance) / b->mean,
                    error_of(l, l->conformance));
    bench_table_print(&table, b->options);
}

// --- picture -------------------------------------------------------------------------------------

/// The point whose light jumps most in a frame without fade.
static int find_liveliest(const jumps_bench *b)
{
    float most = 0.0f;
    int found = 0;
    for (int i = 0; i < (int)b->points.count; i++) {
        const float *e = &b->series[1][i * b->frames];
        for (int frame = 1; frame < b->frames; frame++) {
            const float change = fabsf(e[frame] - e[frame - 1]);
            found = change > most ? i : found;
            most = fmaxf(most, change);
        }
    }
    return found;
}

static void scale(float *values, int count, double factor)
{
    for (int i = 0; i < count; i++) {
        values[i] *= (float)factor;
    }
}

/// Draws the series and the line, which it scales to percent.
static bool draw_plot(jumps_bench *b)
{
    char path[1024];
    ambience_line *l = &b->line;
    const double percent = 100.0 / b->mean;
    const int at = find_liveliest(b) * b->frames;
    for (int i = 0; i < SERIES; i++) {
        scale(&b->series[i][at], b->frames, percent);
    }
    scale(l->ours, LINE_STEPS + 1, percent);
    scale(l->conformance, LINE_STEPS + 1, percent);
    scale(l->truth, LINE_TRUTHS, percent);
    const plot_panel panels[2] = {
        {.title = "In time: irradiance at a fixed point, % of the mean",
         .across = "seconds of the flight",
         .high = SECONDS,
         .lines = {{.name = names[0], .values = &b->series[0][at], .count = b->frames},
                   {.name = names[1], .values = &b->series[1][at], .count = b->frames},
                   {.name = names[2], .values = &b->series[2][at], .count = b->frames}},
         .line_count = SERIES},
        {.title = "In space: irradiance along a line, % of the mean",
         .across = "metres",
         .high = LINE_METRES,
         .lines = {{.name = "ours", .values = l->ours, .count = LINE_STEPS + 1},
                   {.name = "conformance", .values = l->conformance, .count = LINE_STEPS + 1},
                   {.name = "truth", .values = l->truth, .count = LINE_TRUTHS, .dots = true}},
         .line_count = 3},
    };
    snprintf(path, sizeof path, "%s/ambience-jumps.svg", b->options->pictures);
    return plot_write(path, "Irradiance of the ambience volume in time and in space", panels, 2);
}

// --- all -----------------------------------------------------------------------------------------

static void open_series(jumps_bench *b)
{
    for (int i = 0; i < 2; i++) {
        b->before[i] = bench_allocate(b->points.count, sizeof *b->before[i]);
    }
    for (int i = 0; i < SERIES; i++) {
        b->series[i] =
            bench_allocate((size_t)b->points.count * (size_t)b->frames, sizeof *b->series[i]);
    }
    ambience_line_open(&b->world, WORLD_STANDS + 0.5 * SECONDS, &b->line);
}

static void close_bench(jumps_bench *b)
{
    for (int i = 0; i < 2; i++) {
        free(b->before[i]);
    }
    for (int i = 0; i < SERIES; i++) {
        free(b->series[i]);
    }
    ambience_line_close(&b->line);
    ambience_points_close(&b->points);
    ambience_world_close(&b->world);
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
    if (good) {
        open_series(&b);
    }
    good = good && fly(&b, true) && fly(&b, false) &&
           ambience_line_trace(&b.world, options->quick ? PATHS : LINE_PATHS, &b.line);
    if (good) {
        print_summary(&b);
        print_halves(&b);
        print_line(&b);
    }
    good = good && (options->pictures == NULL || draw_plot(&b));
    close_bench(&b);
    return good ? 0 : 1;
}
