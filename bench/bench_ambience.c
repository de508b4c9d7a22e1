// SPDX-License-Identifier: MIT
// Speed of the live ambience volume: anchors sampled and relit, against the raw calls on the very
// packets that sampling sends. Look-ups, updates, and the cost of keeping anchors current.
#include "ambience_world.h"
#include "raw_embree.h"

#include <alpenglow/field.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 5, READS = 8192, QUICK_READS = 64, EVERY = 8, PACKETS = 1 << 17 };
enum { FREE_POINTS = 64, UPDATES = 60 };

typedef struct speed_bench {
    ambience_world world;
    alp_ambience_camera camera;
    ambience_run run;
    raw_embree *raw;
    embree_record record;
    double time; // of the volume
    bool quick;
} speed_bench;

// --- set-up --------------------------------------------------------------------------------------

/// In the terrain where a flight begins, else at the free point nearest to the middle of the scene.
static bool place_camera(speed_bench *b)
{
    float positions[FREE_POINTS][3], normals[FREE_POINTS][3];
    if (b->world.ground != NULL) {
        ambience_world_fly(&b->world, 0, 0.0, &b->camera);
        return true;
    }
    const alp_scene *s = b->world.scene.scene;
    const vec3 middle = vec3_scale(vec3_add(s->bounds_min, s->bounds_max), 0.5f);
    float nearest = INFINITY;
    if (!bench_good(&b->world.scene,
                    alp_scene_free_points(s, 1, FREE_POINTS, positions, normals))) {
        return false;
    }
    for (int i = 0; i < FREE_POINTS; i++) {
        const vec3 away = vec3_sub(vec3_load(positions[i]), middle);
        if (vec3_dot(away, away) < nearest) {
            nearest = vec3_dot(away, away);
            for (int k = 0; k < 3; k++) {
                b->camera.position[k] = (double)positions[i][k];
            }
        }
    }
    return true;
}

/// All anchors with all their rays, before time moves. Small runs take a few.
static alp_result fill(speed_bench *b, const alp_ambience_options *options, bool keep_hits)
{
    alp_ambience_sampler_options o = alp_ambience_sampler_options_default();
    alp_ambience_work work = {.samples = 1};
    o.lighting = b->world.light;
    o.keep_hits = keep_hits;
    o.face = b->quick ? 4 : o.face;
    o.first_face = o.face;
    b->time = 0.0;
    ALP_TRY(alp_ambience_create(b->world.scene.context, options, &b->run.ambience));
    ALP_TRY(
        alp_ambience_sampler_create(b->run.ambience, b->world.scene.scene, &o, &b->run.sampler));
    for (int i = 0; i < (b->quick ? 1 : 8) && work.samples > 0; i++) {
        ALP_TRY(alp_ambience_update(b->run.ambience, 0.0));
        ALP_TRY(alp_ambience_sample(b->run.sampler, &b->camera, b->quick ? 64 : UINT32_MAX / 8, 0.0,
                                    &work));
    }
    return ALP_OK;
}

static bool open_bench(speed_bench *b, const char *name, bool quick)
{
    *b = (speed_bench){.quick = quick};
    return ambience_world_open(name, 1, quick, &b->world) && place_camera(b);
}

static void close_bench(speed_bench *b)
{
    ambience_run_close(&b->run);
    raw_embree_destroy(b->raw);
    free(b->record.packets);
    ambience_world_close(&b->world);
}

// --- sampling ------------------------------------------------------------------------------------

/// Samples all anchors anew, or relights them. @param seconds out, of processor
static uint32_t sample_all(speed_bench *b, bool traced, double *seconds)
{
    alp_ambience_work work = {0};
    alp_ambience_invalidate(b->run.ambience, traced, NULL, NULL);
    b->time += 1.0 / WORLD_FRAMES;
    alp_result result = alp_ambience_update(b->run.ambience, b->time);
    const double started = bench_thread_seconds();
    if (result == ALP_OK) {
        result = alp_ambience_sample(b->run.sampler, &b->camera, b->quick ? 32 : UINT32_MAX / 8,
                                     0.0, &work);
    }
    *seconds = bench_thread_seconds() - started;
    (void)bench_good(&b->world.scene, result);
    return traced ? work.samples : work.relit;
}

/// Records calls of a round. @return anchors that it sampled
static uint32_t record_round(speed_bench *b)
{
    double seconds;
    b->record = (embree_record){.capacity = PACKETS, .every = b->quick ? 1 : EVERY};
    b->record.packets = aligned_alloc(64, PACKETS * sizeof *b->record.packets);
    if (b->record.packets == NULL) {
        fprintf(stderr, "alpenglow bench: out of memory\n");
        exit(1);
    }
    embree_record_to(&b->record);
    const uint32_t anchors = sample_all(b, true, &seconds);
    embree_record_to(NULL);
    return anchors;
}

/// Seconds of the raw calls for an anchor.
static double time_raw(const speed_bench *b, uint32_t anchors)
{
    const double seconds =
        raw_embree_time_calls(b->raw, &b->record, 0, b->record.count, bench_thread_seconds);
    return seconds * (double)b->record.seen / fmax(b->record.count, 1.0) / fmax(anchors, 1.0);
}

static void measure_sampling(speed_bench *b, const char *name, bench_table *table)
{
    const int rounds = b->quick ? 1 : ROUNDS;
    const uint32_t recorded = record_round(b);
    double raw[ROUNDS], traced[ROUNDS], relit[ROUNDS], ratio[2][ROUNDS];
    uint32_t anchors = 0;
    for (int i = 0; i < rounds; i++) {
        double seconds;
        const double before = time_raw(b, recorded);
        anchors = sample_all(b, true, &seconds);
        traced[i] = seconds / fmax(anchors, 1.0);
        const uint32_t again = sample_all(b, false, &seconds);
        relit[i] = seconds / fmax(again, 1.0);
        raw[i] = 0.5 * (before + time_raw(b, recorded));
        ratio[0][i] = raw[i] / traced[i];
        ratio[1][i] = traced[i] / relit[i];
    }
    bench_table_add(table, "%s|%u|%u|%.0f|%.0f|%.0f|%.2f|%.2f", name,
                    alp_scene_get_info(b->world.scene.scene).usable_triangles, anchors,
                    1.0 / bench_median(raw, rounds), 1.0 / bench_median(traced, rounds),
                    1.0 / bench_median(relit, rounds), bench_median(ratio[0], rounds),
                    bench_median(ratio[1], rounds));
}

// --- look-ups and updates ------------------------------------------------------------------------

/// Seconds of a look-up, median of rounds.
static double time_reads(const speed_bench *b, ambience_view view, double reach)
{
    const uint32_t count = b->quick ? QUICK_READS : READS;
    double(*positions)[3] = bench_allocate(count, sizeof *positions), seconds[ROUNDS];
    float(*normals)[3] = bench_allocate(count, sizeof *normals);
    float(*values)[3] = bench_allocate(count, sizeof *values);
    uint64_t state = 1;
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            positions[i][k] =
                b->camera.position[k] + reach * (2.0 * ambience_world_draw(&state) - 1.0);
        }
        normals[i][i % 3] = 1.0f;
    }
    const alp_ambience_snapshot *now = alp_ambience_begin_read(b->run.ambience);
    for (int i = 0; i < ROUNDS; i++) {
        const double started = bench_thread_seconds();
        ambience_view_read(now, view, count, (const double(*)[3])positions,
                           (const float(*)[3])normals, values);
        seconds[i] = (bench_thread_seconds() - started) / count;
    }
    alp_ambience_end_read(b->run.ambience, now);
    free(positions);
    free(normals);
    free(values);
    return bench_median(seconds, ROUNDS);
}

static void measure_reads(const speed_bench *b, const char *name, bench_table *table)
{
    static const double reaches[3] = {2.0, 10.0, 50.0};
    for (int i = 0; i < 3; i++) {
        bench_table_add(table, "%s|%.0f|%.2f|%.2f|%.2f", name, reaches[i],
                        1e6 * time_reads(b, VIEW_OURS, reaches[i]),
                        1e6 * time_reads(b, VIEW_BLIND, reaches[i]),
                        1e6 * time_reads(b, VIEW_CONFORMANCE, reaches[i]));
    }
}

/// Milliseconds of an update, mean over a second.
static double time_updates(speed_bench *b)
{
    const double started = bench_thread_seconds();
    for (int i = 0; i < UPDATES; i++) {
        b->time += 1.0 / WORLD_FRAMES;
        (void)bench_good(&b->world.scene, alp_ambience_update(b->run.ambience, b->time));
    }
    return 1e3 * (bench_thread_seconds() - started) / UPDATES;
}

static void measure_updates(speed_bench *b, const char *name, bench_table *table)
{
    double seconds;
    b->world.light.sun.azimuth += 0.3f;
    (void)bench_good(&b->world.scene,
                     alp_ambience_sampler_set_lighting(b->run.sampler, &b->world.light));
    sample_all(b, false, &seconds);
    const double fading = time_updates(b);
    time_updates(b); // fades end
    const double still = time_updates(b);
    const alp_ambience_info info = alp_ambience_get_info(b->run.ambience);
    const double thousands = fmax(info.anchors + info.solids, 1.0) / 1000.0;
    b->world.light.sun.azimuth -= 0.3f;
    bench_table_add(table, "%s|%u|%u|%u|%.3f|%.3f|%.3f|%.3f", name, info.anchors, info.solids,
                    info.nodes, fading, still, fading / thousands, still / thousands);
}

// --- kept current --------------------------------------------------------------------------------

typedef enum upkeep { UPKEEP_RENEWED, UPKEEP_SUN, UPKEEP_TRACED, UPKEEPS } upkeep;

/// Age of the oldest light, seconds.
static double find_oldest(const alp_ambience *a)
{
    double oldest = 0.0;
    for (uint32_t i = 0; i < a->anchor_end; i++) {
        if (a->anchors[i].state == ALPI_ANCHOR_LIT) {
            oldest = fmax(oldest, a->time - a->anchors[i].born);
        }
    }
    return oldest;
}

typedef struct upkeep_times {
    double update, sample, light, longest; // ms: of a frame, the same, of a change of light
    uint64_t samples;
    uint32_t lights;
} upkeep_times;

static void keep_frame(speed_bench *b, int frame, upkeep way, upkeep_times *t)
{
    alp_ambience_work work = {0};
    double at[4];
    alp_result result = ALP_OK;
    at[0] = bench_thread_seconds();
    if (way == UPKEEP_SUN && frame % 60 == 0) {
        b->world.light.sun.azimuth += 0.005f;
        result = alp_ambience_sampler_set_lighting(b->run.sampler, &b->world.light);
        t->lights++;
    }
    b->time += 1.0 / WORLD_FRAMES;
    at[1] = bench_thread_seconds();
    if (result == ALP_OK) {
        result = alp_ambience_update(b->run.ambience, b->time);
    }
    at[2] = bench_thread_seconds();
    const alp_ambience_info info = alp_ambience_get_info(b->run.ambience);
    const double each = (info.anchors + info.solids) / (6.0 * WORLD_FRAMES);
    const uint32_t samples = (uint32_t)ceil(each * (way == UPKEEP_TRACED ? 1.1 : 0.6));
    const double started = bench_thread_seconds();
    if (result == ALP_OK) {
        result = alp_ambience_sample(b->run.sampler, &b->camera, samples, 0.0, &work);
    }
    at[3] = bench_thread_seconds() - started;
    (void)bench_good(&b->world.scene, result);
    t->samples += work.samples + work.relit;
    t->light += 1e3 * (at[1] - at[0]);
    t->update += 1e3 * (at[2] - at[1]);
    t->sample += 1e3 * at[3];
    t->longest = fmax(t->longest, 1e3 * (at[2] - at[1] + at[3]));
}

/// Twelve seconds with a camera that stands still; the last six count.
static bool measure_upkeep(speed_bench *b, upkeep way, bench_table *table)
{
    static const char *const names[UPKEEPS] = {"renewed, hits kept", "sun moves each second",
                                               "renewed, traced again"};
    const alp_ambience_options o = alp_ambience_options_default();
    const int frames = b->quick ? 3 : (int)(6.0 * WORLD_FRAMES);
    upkeep_times t = {0};
    if (!bench_good(&b->world.scene, fill(b, &o, way != UPKEEP_TRACED))) {
        return false;
    }
    for (int i = 0; i < 2 * frames; i++) {
        if (i == frames) {
            memset(&t, 0, sizeof t);
        }
        keep_frame(b, i, way, &t);
    }
    const alp_ambience_info info = alp_ambience_get_info(b->run.ambience);
    const double each = (t.update + t.sample) / frames;
    bench_table_add(table, "%s|%u|%.1f|%.2f|%.2f|%.2f|%.2f|%.1f|%.2f", names[way],
                    info.anchors + info.solids, (double)t.samples / frames, t.update / frames,
                    t.sample / frames, 1000.0 * each / fmax(info.anchors + info.solids, 1.0),
                    t.longest, find_oldest(b->run.ambience), t.light / fmax(t.lights, 1.0));
    ambience_run_close(&b->run);
    return true;
}

static bool run_upkeep(const bench_options *options)
{
    static bench_table table;
    speed_bench b;
    bool good = open_bench(&b,
                           options->quick           ? "builtin:terrain,triangles=5000,trees=20"
                           : options->scene != NULL ? options->scene
                                                    : "builtin:terrain",
                           options->quick);
    bench_table_start(
        &table, "Anchors kept current, one worker, ms a frame",
        "60 frames a second, a lifetime of 6 s, a camera that stands still; anchors "
        "with light and solids. Each frame takes what a renewal in 6 s needs. "
        "Update and sample: processor ms a frame; sample includes the plan. Per 1,000: "
        "both, for a thousand anchors. Longest: frame. Oldest: light at the end, seconds. Light: "
        "ms of a "
        "change of the lighting, beside the frame.",
        "way|anchors|samples|update|sample|per 1,000|longest|oldest|light");
    for (int way = 0; way < UPKEEPS && good; way++) {
        good = measure_upkeep(&b, (upkeep)way, &table);
    }
    close_bench(&b);
    if (good) {
        bench_table_print(&table, options);
    }
    return good;
}

// --- all -----------------------------------------------------------------------------------------

typedef struct speed_tables {
    bench_table sampling, reads, updates;
} speed_tables;

static void start_tables(speed_tables *t)
{
    bench_table_start(&t->sampling, "Anchors, one worker, anchors/s",
                      "All anchors of a camera that stands still: rays through 6 × 16² pixels, a "
                      "shadow ray from each hit that faces the sun, light that bounced from the "
                      "volume, distances, projection. Relit: kept hits. Limit: the calls of Embree "
                      "on the packets that ours sends, one in eight blocks of 64 calls recorded. "
                      "Ratios: limit's seconds over ours, and traced over relit, medians of five "
                      "rounds.",
                      "scene|triangles|anchors|limit|traced|relit|ratio|traced / relit");
    bench_table_start(&t->reads, "Look-ups, one thread, µs a point",
                      "Irradiance at random points within so many metres of the camera along each "
                      "axis.",
                      "scene|within|ours|no visibility|conformance");
    bench_table_start(&t->updates, "Updates, one thread, ms",
                      "Fading: all light changes. Still: nothing does. Also per 1,000 anchors.",
                      "scene|anchors|solids|nodes|fading|still|fading / 1,000|still / 1,000");
}

static bool run_scene(const char *path, bool quick, speed_tables *tables)
{
    speed_bench b;
    const char *slash = strrchr(path, '/'), *name = slash != NULL ? slash + 1 : path;
    const alp_ambience_options o = alp_ambience_options_default();
    bool good = open_bench(&b, path, quick) && bench_good(&b.world.scene, fill(&b, &o, true));
    b.raw = good ? raw_embree_create(b.world.scene.scene, true) : NULL;
    good = b.raw != NULL;
    if (good) {
        measure_sampling(&b, name, &tables->sampling);
        measure_reads(&b, name, &tables->reads);
        measure_updates(&b, name, &tables->updates);
    }
    close_bench(&b);
    return good;
}

static bool run_speed(const bench_options *options)
{
    static speed_tables tables;
    const char *const scenes[] = {options->quick ? "builtin:terrain,triangles=5000,trees=20"
                                                 : "builtin:terrain",
                                  bench_shared("scenes/architecture/zdm2.glb", "builtin:atrium")};
    bool good = true;
    start_tables(&tables);
    if (options->scene != NULL) {
        good = run_scene(options->scene, options->quick, &tables);
    }
    for (int i = 0; i < (options->quick ? 1 : 2) && good && options->scene == NULL; i++) {
        good = run_scene(scenes[i], options->quick, &tables);
    }
    if (good) {
        bench_table_print(&tables.sampling, options);
        bench_table_print(&tables.reads, options);
        bench_table_print(&tables.updates, options);
    }
    return good;
}

int bench_ambience(const bench_options *options)
{
    if (!run_speed(options) || !run_upkeep(options)) {
        return 1;
    }
    if (options->scene != NULL) {
        return 0; // flights and places are those of the terrain
    }
    const int code = bench_ambience_quality(options);
    return code != 0 ? code : bench_ambience_jumps(options);
}
