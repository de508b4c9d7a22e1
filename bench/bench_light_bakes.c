// SPDX-License-Identifier: MIT
// Whole bakes of light: the gain of two workers, and growth of time with triangles and texels.
#include "bench.h"

#include "embree_clock.h"
#include "raw_embree.h"

#include "base/tasks.h"

#include <alpenglow/bake.h>

#include <stdlib.h>

enum { WORKERS = 2, ROUNDS = 3, FIXED_RAYS = 64 };
enum { RECORD_EVERY = 8, RECORD_LIMIT = 1 << 20, REPLAY_BATCH = 256 };
enum { QUICK_SIZE = 16, QUICK_RAYS = 32, GROWTH_SIZE = 512 };

// --- one bake ------------------------------------------------------------------------------------

typedef struct light_bake {
    const char *name;
    uint32_t size;
    uint32_t rays; // of a texel; 0: for an error of 1 %, as the command has it
    bool sky;      // a clear one and a sun
} light_bake;

/// Bakes in memory, on a newly loaded scene, so that the acceleration structure is built too.
static bool bake(const light_bake *setup, uint32_t workers, alp_bake_report *report)
{
    bench_scene scene;
    if (!bench_scene_load(setup->name, workers, &scene)) {
        return false;
    }
    alp_bake_options o = alp_bake_options_default();
    o.maps = ALP_MAP_LIGHT;
    o.atlas.size = setup->size;
    if (setup->rays > 0) {
        o.light.samples = setup->rays;
    } else {
        o.light.error = 0.01f;
    }
    if (setup->sky) {
        o.light.lighting.sky.kind = ALP_SKY_CLEAR;
        o.light.lighting.sun.elevation = 0.7f;
        o.light.lighting.sun.illuminance = 1e5f;
    }
    const bool good = bench_good(&scene, alp_bake(scene.scene, &o, NULL, report));
    bench_scene_close(&scene);
    return good;
}

// --- both cores ----------------------------------------------------------------------------------

enum { PARTS = 5 };

static void list_parts(const alp_bake_report *r, double parts[PARTS])
{
    parts[0] = r->seconds_total;
    parts[1] = r->seconds_atlas;
    parts[2] = r->seconds_build;
    parts[3] = r->seconds_bake;
    parts[4] = r->seconds_seams;
}

static bool measure_workers(const light_bake *setup, int rounds, bench_table *table)
{
    double seconds[WORKERS][PARTS][ROUNDS], gains[PARTS][ROUNDS], both[PARTS], gain[PARTS];
    alp_bake_report report;
    for (int i = 0; i < rounds; i++) {
        for (uint32_t w = 0; w < WORKERS; w++) {
            double parts[PARTS];
            if (!bake(setup, w + 1, &report)) {
                return false;
            }
            list_parts(&report, parts);
            for (int p = 0; p < PARTS; p++) {
                seconds[w][p][i] = parts[p];
            }
        }
        for (int p = 0; p < PARTS; p++) {
            gains[p][i] = seconds[0][p][i] / seconds[1][p][i];
        }
    }
    for (int p = 0; p < PARTS; p++) {
        both[p] = bench_median(seconds[1][p], rounds);
        gain[p] = bench_median(gains[p], rounds);
    }
    bench_table_add(table, "%s|%u²|%llu|%.2f|%.2f|%.2f|%.2f, %.2f|%.2f, %.2f|%.2f, %.2f|%.2f, %.2f",
                    setup->name, setup->size, (unsigned long long)report.atlas.texels,
                    bench_median(seconds[0][0], rounds), both[0], gain[0], both[1], gain[1],
                    both[2], gain[2], both[3], gain[3], both[4], gain[4]);
    return true;
}

static bool run_workers(const bench_options *options)
{
    static const light_bake bakes[] = {{.name = "builtin:cornell", .size = 256},
                                       {.name = "builtin:teapot-room", .size = 256},
                                       {.name = "hills:70000", .size = 512, .sky = true}};
    enum { BAKES = sizeof bakes / sizeof *bakes };
    bench_table table;
    bench_table_start(&table, "A bake of light by one worker and by two",
                      "Wall seconds for a stated error of 1 %, in turns; gain: those of one worker "
                      "over those of two. Behind them the parts: seconds of two workers, and their "
                      "gain. The structure is the ray tracer's and built by one worker.",
                      "scene|size|texels|one|two|gain|atlas|structure|light|seams");
    const size_t count = options->quick || options->scene != NULL ? 1 : BAKES;
    for (size_t i = 0; i < count; i++) {
        light_bake setup = bakes[i];
        if (options->scene != NULL) {
            setup = (light_bake){.name = options->scene, .size = 512, .sky = true};
        }
        if (options->quick) {
            setup.size = QUICK_SIZE;
            setup.rays = QUICK_RAYS;
        }
        if (!measure_workers(&setup, options->quick ? 1 : ROUNDS, &table)) {
            return false;
        }
    }
    bench_table_print(&table, options);
    return true;
}

// --- growth with triangles -----------------------------------------------------------------------

/// The recorded rays of a bake, for replay.
typedef struct sent_rays {
    light_bake setup;
    raw_embree *raw;
    embree_record record;
    double texels;
    double replayed[WORKERS]; // seconds of each worker
} sent_rays;

static bool record_rays(const light_bake *setup, sent_rays *sent)
{
    *sent =
        (sent_rays){.setup = *setup, .record = {.capacity = RECORD_LIMIT, .every = RECORD_EVERY}};
    const size_t size = sizeof *sent->record.packets * RECORD_LIMIT;
    bench_scene scene;
    alp_bake_report report = {0};
    sent->record.packets = aligned_alloc(64, size);
    if (sent->record.packets == NULL || !bench_scene_load(setup->name, 1, &scene)) {
        return false;
    }
    sent->raw = raw_embree_create(scene.scene, true);
    bench_scene_close(&scene);
    embree_record_to(&sent->record);
    const bool good = sent->raw != NULL && bake(setup, 1, &report);
    embree_record_to(NULL);
    sent->texels = (double)report.atlas.texels;
    return good;
}

static void release_rays(sent_rays *sent)
{
    raw_embree_destroy(sent->raw);
    free(sent->record.packets);
}

static alp_result replay_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    sent_rays *s = user;
    const uint32_t last = end * REPLAY_BATCH;
    s->replayed[worker] +=
        raw_embree_time_calls(s->raw, &s->record, begin * REPLAY_BATCH,
                              last < s->record.count ? last : s->record.count, alpi_seconds);
    return ALP_OK;
}

/// Microseconds a texel of all calls, by those that were kept, as if they scaled perfectly.
static double time_replay(sent_rays *s, alp_context *context, uint32_t workers)
{
    s->replayed[0] = s->replayed[1] = 0.0;
    (void)!alpi_parallel_for(context, (s->record.count + REPLAY_BATCH - 1) / REPLAY_BATCH, 1,
                             replay_range, s, NULL);
    const double all = (double)s->record.seen / (double)s->record.count;
    return 1e6 * all * (s->replayed[0] + s->replayed[1]) / workers / s->texels;
}

/// Times of one round with few and with many triangles, ours and raw.
typedef struct growth {
    double ours[2], raw[2];
} growth;

static bool measure_growth(sent_rays sent[2], uint32_t workers, growth *g)
{
    alp_context_options options = alp_context_options_default();
    alp_context *context = NULL;
    options.worker_count = workers;
    bool good = alp_context_create(&options, &context) == ALP_OK;
    for (int i = 0; i < 2 && good; i++) {
        alp_bake_report report = {0};
        g->raw[i] = time_replay(&sent[i], context, workers);
        good = bake(&sent[i].setup, workers, &report);
        g->ours[i] = 1e6 * report.seconds_bake / sent[i].texels;
        g->raw[i] = 0.5 * (g->raw[i] + time_replay(&sent[i], context, workers));
    }
    alp_context_destroy(context);
    return good;
}

static bool add_growth(sent_rays sent[2], uint32_t workers, int rounds, bench_table *table)
{
    double ours[2][ROUNDS], raw[2][ROUNDS], grown[ROUNDS], limit[ROUNDS], ratio[ROUNDS];
    for (int i = 0; i < rounds; i++) {
        growth g;
        if (!measure_growth(sent, workers, &g)) {
            return false;
        }
        for (int k = 0; k < 2; k++) {
            ours[k][i] = g.ours[k];
            raw[k][i] = g.raw[k];
        }
        grown[i] = g.ours[1] / g.ours[0];
        limit[i] = g.raw[1] / g.raw[0];
        ratio[i] = grown[i] / limit[i];
    }
    bench_table_add(table, "%s to %s|%u|%.2f|%.2f|%.2f|%.2f|%.2f|%.2f|%.2f", sent[0].setup.name,
                    sent[1].setup.name, workers, bench_median(ours[0], rounds),
                    bench_median(ours[1], rounds), bench_median(grown, rounds),
                    bench_median(raw[0], rounds), bench_median(raw[1], rounds),
                    bench_median(limit, rounds), bench_median(ratio, rounds));
    return true;
}

static bool run_triangles(const bench_options *options)
{
    const uint32_t size = options->quick ? QUICK_SIZE : GROWTH_SIZE;
    const light_bake bakes[2] = {
        {options->quick ? "hills:200" : "hills:70000", size, FIXED_RAYS, true},
        {options->quick ? "hills:800" : "hills:1000000", size, FIXED_RAYS, true}};
    bench_table table;
    bench_table_start(
        &table, "Light by triangles, microseconds a texel",
        "Wall time of sampling at 512², 64 rays of a texel, a clear sky and a sun, "
        "with few triangles and with many, and the growth. Limit: the calls of the "
        "ray tracer that these bakes make, recorded (an eighth of them; those of sixteen rays "
        "as two of eight), by themselves. Ratio: our growth over that of the limit. Growth and "
        "ratio: medians of the rounds'.",
        "scenes|workers|few|many|growth|limit, few|limit, many|growth|ratio");
    sent_rays sent[2] = {0};
    bool good = record_rays(&bakes[0], &sent[0]) && record_rays(&bakes[1], &sent[1]);
    for (uint32_t w = 1; w <= WORKERS && good; w++) {
        good = add_growth(sent, w, options->quick ? 1 : ROUNDS, &table);
    }
    release_rays(&sent[0]);
    release_rays(&sent[1]);
    if (good) {
        bench_table_print(&table, options);
    }
    return good;
}

// --- growth with texels --------------------------------------------------------------------------

static bool run_texels(const bench_options *options)
{
    static const uint32_t sizes[] = {256, 512, 1024};
    bench_table table;
    bench_table_start(&table, "Light by texels, all workers",
                      "64 rays of a texel. Traced: texels that are not interpolated. Linear in "
                      "texels where the last column is even.",
                      "scene|size|texels|traced|seconds|microseconds a texel");
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const light_bake setup = {.name = "builtin:teapot-room",
                                  .size = options->quick ? sizes[i] / 16 : sizes[i],
                                  .rays = FIXED_RAYS};
        double seconds[ROUNDS];
        alp_bake_report report = {0};
        const int rounds = options->quick ? 1 : ROUNDS;
        for (int r = 0; r < rounds; r++) {
            if (!bake(&setup, 0, &report)) {
                return false;
            }
            seconds[r] = report.seconds_bake;
        }
        const double texels = (double)report.atlas.texels, median = bench_median(seconds, rounds);
        bench_table_add(&table, "%s|%u|%.0f|%.0f %%|%.3f|%.3f", setup.name, setup.size, texels,
                        100.0 * (double)report.light_traced / texels, median,
                        1e6 * median / texels);
    }
    bench_table_print(&table, options);
    return true;
}

int bench_light_bakes(const bench_options *options)
{
    if (!run_workers(options)) {
        return 1;
    }
    return options->scene != NULL || (run_triangles(options) && run_texels(options)) ? 0 : 1;
}
