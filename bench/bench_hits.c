// SPDX-License-Identifier: MIT
// Kept hits of points in space: traced and lit, and relit, against the raw calls on the very
// packets that tracing sends.
#include "bench.h"
#include "raw_embree.h"

#include "transport/sphere/sphere_hits.h"

#include <alpenglow/field.h>

#include <stdlib.h>

enum { ROUNDS = 9, POINTS = 96, QUICK_POINTS = 4, FACES = 2 };

typedef struct hits_bench {
    bench_scene scene;
    alp_context *context; // of one worker
    alpi_lighting *lighting;
    raw_embree *raw;
    alpi_sphere_relight how;
    alpi_sphere_hits_point *points; // [count]
    alpi_sphere_hit *hits;
    uint32_t count, face;
    embree_record record;
} hits_bench;

static void bounce(const void *user, uint32_t count, const vec3 *points, const vec3 *normals,
                   vec3 *irradiance)
{
    (void)user;
    (void)points;
    for (uint32_t i = 0; i < count; i++) {
        const float e = 2.0f + normals[i].y;
        irradiance[i] = (vec3){e, e, e};
    }
}

static alp_result place_points(hits_bench *b, uint32_t count)
{
    float(*positions)[3] = bench_allocate(count, sizeof *positions);
    float(*normals)[3] = bench_allocate(count, sizeof *normals);
    b->points = bench_allocate(count, sizeof *b->points);
    b->hits = bench_allocate((size_t)count * alpi_sphere_hits_count(ALPI_HITS_FACE_MOST),
                             sizeof *b->hits);
    b->count = count;
    const alp_result result = alp_scene_free_points(b->scene.scene, 1, count, positions, normals);
    for (uint32_t i = 0; i < count && result == ALP_OK; i++) {
        b->points[i] = (alpi_sphere_hits_point){.point = vec3_load(positions[i]), .key = i};
    }
    free(positions);
    free(normals);
    return result;
}

static alp_result prepare(hits_bench *b, bool quick)
{
    alp_context_options one = alp_context_options_default();
    alp_lighting_options light = alp_lighting_options_default();
    one.worker_count = 1;
    light.sky.kind = ALP_SKY_CLEAR;
    light.sun.illuminance = 1e5f;
    light.sun.elevation = 0.7f;
    ALP_TRY(alp_context_create(&one, &b->context));
    ALP_TRY(alpi_lighting_create_quietly(b->scene.scene, &light, &b->lighting));
    b->how = (alpi_sphere_relight){.context = b->context,
                                   .scene = b->scene.scene,
                                   .tracer = b->scene.tracer,
                                   .lighting = b->lighting,
                                   .bounce_cell_scale = 0.3f,
                                   .seed = 1};
    return place_points(b, quick ? QUICK_POINTS : POINTS);
}

/// @param keep hits are kept   @param traced they are relit
static double time_points(hits_bench *b, bool keep, bool traced)
{
    for (uint32_t i = 0; i < b->count; i++) {
        b->points[i].face = b->face;
        b->points[i].reach = 1.0f;
        b->points[i].hits =
            keep ? b->hits + (size_t)i * alpi_sphere_hits_count(ALPI_HITS_FACE_MOST) : NULL;
        b->points[i].traced = traced;
    }
    const double started = bench_thread_seconds();
    (void)!alpi_sphere_hits_gather(&b->how, b->points, b->count, NULL);
    return bench_thread_seconds() - started;
}

static void record_calls(hits_bench *b)
{
    embree_record *r = &b->record;
    const uint32_t packets = b->count * alpi_sphere_hits_count(b->face) / ALPI_PACKET;
    *r = (embree_record){.capacity = 4 * packets + 64, .every = 1};
    r->packets = aligned_alloc(64, ((size_t)r->capacity * sizeof *r->packets + 63) / 64 * 64);
    if (r->packets == NULL) {
        fprintf(stderr, "alpenglow bench: out of memory\n");
        exit(1);
    }
    embree_record_to(r);
    (void)time_points(b, false, false);
    embree_record_to(NULL);
}

static double time_raw(const hits_bench *b)
{
    return raw_embree_time_calls(b->raw, &b->record, 0, b->record.count, bench_thread_seconds);
}

enum { TRACED, KEPT, RELIT, BOUNCED, WAYS };

static void measure(hits_bench *b, uint32_t face, bool quick, bench_table *table)
{
    const int rounds = quick ? 1 : ROUNDS;
    double raw[ROUNDS], ours[WAYS][ROUNDS], ratios[WAYS][ROUNDS], ratio[WAYS];
    b->face = face;
    record_calls(b);
    for (int i = 0; i < rounds; i++) {
        const double before = time_raw(b);
        b->how.bounce = NULL;
        ours[TRACED][i] = time_points(b, false, false);
        ours[KEPT][i] = time_points(b, true, false);
        ours[RELIT][i] = time_points(b, true, true);
        b->how.bounce = bounce;
        ours[BOUNCED][i] = time_points(b, true, true);
        raw[i] = 0.5 * (before + time_raw(b));
        ratios[TRACED][i] = raw[i] / ours[TRACED][i];
        ratios[KEPT][i] = raw[i] / ours[KEPT][i];
        ratios[RELIT][i] = ours[KEPT][i] / ours[RELIT][i];
        ratios[BOUNCED][i] = ours[KEPT][i] / ours[BOUNCED][i];
    }
    for (int way = 0; way < WAYS; way++) {
        ratio[way] = bench_median(ratios[way], rounds);
    }
    bench_table_add(table, "%s|%u|6 × %u²|%.0f|%.0f|%.0f|%.2f|%.2f|%.2f|%.2f", b->scene.name,
                    alp_scene_get_info(b->scene.scene).usable_triangles, face,
                    b->count / bench_median(raw, rounds),
                    b->count / bench_median(ours[KEPT], rounds),
                    b->count / bench_median(ours[RELIT], rounds), ratio[TRACED], ratio[KEPT],
                    ratio[RELIT], ratio[BOUNCED]);
    free(b->record.packets);
}

static bool run_scene(const char *path, const char *name, bool quick, bench_table *table)
{
    static const uint32_t faces[FACES] = {8, 16};
    hits_bench b = {0};
    bool good = bench_scene_open(path, 0, &b.scene) && bench_good(&b.scene, prepare(&b, quick));
    b.scene.name = name;
    b.raw = good ? raw_embree_create(b.scene.scene, true) : NULL;
    good = b.raw != NULL;
    for (int i = 0; i < FACES && good; i++) {
        measure(&b, faces[i], quick, table);
    }
    raw_embree_destroy(b.raw);
    free(b.points);
    free(b.hits);
    if (b.scene.context != NULL) {
        alpi_lighting_destroy(b.scene.context, b.lighting);
        bench_scene_close(&b.scene);
    }
    alp_context_destroy(b.context);
    return good;
}

int bench_kept_hits(const bench_options *options)
{
    static bench_table table;
    const char *const house = bench_shared("scenes/architecture/zdm2.glb", "builtin:atrium");
    const char *const scenes[] = {options->quick ? "builtin:cornell" : "builtin:terrain", house};
    bool good = true;
    bench_table_start(&table, "Kept hits, one worker, points/s",
                      "Rays from free points under sun and clear sky, with a shadow ray from each "
                      "hit to each lamp that it faces. Limit: `rtcIntersect8` and `rtcOccluded8` "
                      "on the packets that ours sends, recorded. Ratio: limit's seconds over ours "
                      "without and with hits kept, median of the rounds'. Relit: relit points "
                      "over traced ones, without and with calls for light that bounced.",
                      "scene|triangles|rays|limit|traced|relit|ratio|kept|relit / traced|bounced");
    if (options->scene != NULL) {
        good = run_scene(options->scene, options->scene, options->quick, &table);
    }
    for (int i = 0; i < (options->quick ? 1 : 2) && good && options->scene == NULL; i++) {
        const char *slash = strrchr(scenes[i], '/');
        good = run_scene(scenes[i], slash != NULL ? slash + 1 : scenes[i], options->quick, &table);
    }
    if (good) {
        bench_table_print(&table, options);
    }
    return good ? 0 : 1;
}
