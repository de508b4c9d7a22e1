// SPDX-License-Identifier: MIT
// Probes: look-ups a second, and the gathering of their light against its limit, the raw calls on
// the very packets that it sends.
#include "bench.h"
#include "probe_floor.h"
#include "raw_embree.h"

#include "base/random.h"
#include "base/warp.h"
#include "fields/probes/probes.h"
#include "fields/truth.h"
#include "maps/radiosity/solution.h"

#include <math.h>
#include <stdlib.h>

enum { ROUNDS = 9, SIDE = 32, QUICK_SIDE = 8, POINTS = 4096 };
enum { DIRECTIONS = ALPI_PROBE_MOMENT_SIDE * ALPI_PROBE_MOMENT_SIDE };

// --- look-ups ------------------------------------------------------------------------------------

typedef struct lookup_bench {
    alp_context *context; // of one worker
    alpi_probe_volume volume;
    alp_field *field;
    float (*positions)[3], (*normals)[3], (*irradiance)[3]; // [POINTS]
} lookup_bench;

static float unit_float(uint32_t number)
{
    return alpi_unit_float(alpi_hash32(number));
}

static void fill_volume(alpi_probe_volume *v)
{
    const uint32_t floats = 3 * v->coefficient_count;
    for (uint32_t i = 0; i < v->count * floats; i++) {
        v->coefficients[i] = i % floats < 3 ? 2.0f + unit_float(i) : 0.5f * unit_float(i);
    }
    for (uint32_t i = 0; i < v->count * DIRECTIONS && v->moments != NULL; i++) {
        const float mean = v->reach * unit_float(i); // most probes are hidden in part
        v->moments[i][0] = mean;
        v->moments[i][1] = mean * mean * (1.0f + 0.1f * unit_float(i + 1));
    }
}

static alp_result make_volume(lookup_bench *b, uint32_t side, alpi_probe_basis basis,
                              bool visibility)
{
    alpi_probe_volume *v = &b->volume;
    *v = (alpi_probe_volume){
        .count = side * side * side, .basis = basis, .reach = visibility ? 3.5f : 0.0f};
    for (int k = 0; k < 3; k++) {
        v->size[k] = side;
        v->spacing[k] = 1.0f;
    }
    ALP_TRY(alpi_probe_volume_allocate(b->context, false, visibility, v));
    fill_volume(v);
    return alpi_probe_field_create(v, ALP_LOOKUP_OURS, NULL, NULL, &b->field);
}

static void draw_points(const lookup_bench *b)
{
    const float cells = (float)(b->volume.size[0] - 1);
    for (uint32_t i = 0; i < POINTS; i++) {
        const vec2 u = {unit_float(5 * i), unit_float(5 * i + 1)};
        vec3_store(b->normals[i], alpi_warp_uniform_cone(u, -1.0f));
        for (uint32_t k = 0; k < 3; k++) {
            b->positions[i][k] = cells * unit_float(5 * i + 2 + k);
        }
    }
}

/// Medians of seconds of a batch.
static void measure_lookup(const lookup_bench *b, bool quick, double *ours, double *least)
{
    const int rounds = quick ? 1 : ROUNDS, times = quick ? 1 : 32;
    double values[2][ROUNDS];
    volatile float sink = 0.0f;
    for (int round = 0; round < rounds; round++) {
        const double started = bench_thread_seconds();
        for (int i = 0; i < times; i++) {
            alp_field_irradiance(b->field, POINTS, (const float(*)[3])b->positions,
                                 (const float(*)[3])b->normals, b->irradiance);
        }
        const double between = bench_thread_seconds();
        for (int i = 0; i < times; i++) {
            sink = sink + bench_probes_read(&b->volume, (const float(*)[3])b->positions, POINTS);
        }
        values[0][round] = (between - started) / times;
        values[1][round] = (bench_thread_seconds() - between) / times;
    }
    *ours = bench_median(values[0], rounds);
    *least = bench_median(values[1], rounds);
}

static alp_result run_lookup(alp_context *context, alpi_probe_basis basis, bool visibility,
                             bool quick, bench_table *table)
{
    static const char *const names[] = {"sh9", "sh4", "ambient-cube"};
    lookup_bench b = {.context = context};
    b.positions = bench_allocate(POINTS, sizeof *b.positions);
    b.normals = bench_allocate(POINTS, sizeof *b.normals);
    b.irradiance = bench_allocate(POINTS, sizeof *b.irradiance);
    const alp_result result = make_volume(&b, quick ? QUICK_SIDE : SIDE, basis, visibility);
    if (result == ALP_OK) {
        double ours, least;
        const alp_probes probes = {.context = context, .volume = b.volume};
        const alp_probes_info info = alp_probes_get_info(&probes);
        draw_points(&b);
        measure_lookup(&b, quick, &ours, &least);
        bench_table_add(table, "%s|%s|%u|%.0f|%.2f|%.2f|%.2f", names[basis],
                        visibility ? "yes" : "no", info.count, (double)info.bytes / info.count,
                        1e-6 * POINTS / ours, 1e-6 * POINTS / least, least / ours);
    }
    alp_field_destroy(b.field);
    alpi_probe_volume_destroy(&b.volume);
    free(b.positions);
    free(b.normals);
    free(b.irradiance);
    return result;
}

static bool run_lookups(const bench_options *options)
{
    static bench_table table;
    alp_context *context = NULL;
    alp_context_options one = alp_context_options_default();
    one.worker_count = 1;
    alp_result result = alp_context_create(&one, &context);
    bench_table_start(&table, "Look-ups of probes, one worker, M points/s",
                      "Random points and normals in batches of 4,096 on a lattice. Floor: a loop "
                      "that reads the eight probes round each point, and adds them: all "
                      "coefficients, and four texels of distances.",
                      "basis|visibility|probes|bytes a probe|ours|floor|ours / floor");
    for (int basis = 0; basis < 3; basis++) {
        for (int visibility = 0; visibility < 2 && result == ALP_OK; visibility++) {
            result = run_lookup(context, (alpi_probe_basis)basis, visibility == 1, options->quick,
                                &table);
        }
    }
    if (result == ALP_OK) {
        bench_table_print(&table, options);
    } else {
        fprintf(stderr, "alpenglow bench: %s\n",
                context != NULL ? alp_context_message(context) : "out of memory");
    }
    alp_context_destroy(context);
    return result == ALP_OK;
}

// --- gathering -----------------------------------------------------------------------------------

enum { PROBES = 256, QUICK_PROBES = 16, DRAWN = 4 /* points for each probe that is wanted */ };

typedef struct sphere_bench {
    bench_scene scene;
    alp_context *context;                           // of one worker
    alpi_lighting *lighting, *space, *soft, *spots; // as src/fields/probes/probe_bake.c
    alpi_solution *solution;
    raw_embree *raw;
    alpi_sphere_rays rays;
    const alpi_lighting *aimed;
    float (*points)[3]; // [count] outside solids
    alpi_sphere_light *values;
    float (*moments)[2];
    uint32_t count;
    embree_record record;
} sphere_bench;

static alp_result solve(sphere_bench *b, bool sky)
{
    alp_lighting_options light = alp_lighting_options_default();
    light.sky.kind = sky ? ALP_SKY_CLEAR : ALP_SKY_NONE;
    light.sun.elevation = 0.7f;
    const alp_scene *scene = b->scene.scene;
    ALP_TRY(alpi_lighting_create(scene, &light, &b->lighting));
    ALP_TRY(alpi_lighting_create_without_lamps(scene, &light, &b->space));
    ALP_TRY(alpi_lighting_split_sky(b->space, &light, &b->soft, &b->spots));
    alpi_solution_options options = {.scene = scene,
                                     .tracer = b->scene.tracer,
                                     .lighting = b->lighting,
                                     .atlas = alp_atlas_options_default(),
                                     .bounces = 2,
                                     .tolerance = alpi_radiosity_tolerance(2)};
    options.atlas.size = 512;
    return alpi_solution_create(&options, NULL, NULL, &b->solution);
}

/// Random points in the bounds of the scene that lie in no solid.
static alp_result draw_free_points(sphere_bench *b, uint32_t wanted)
{
    const vec3 low = b->scene.scene->bounds_min, high = b->scene.scene->bounds_max;
    const uint32_t drawn = DRAWN * wanted;
    b->points = bench_allocate(drawn, sizeof *b->points);
    b->values = bench_allocate(drawn, sizeof *b->values);
    b->moments = bench_allocate((size_t)drawn * DIRECTIONS, sizeof *b->moments);
    for (uint32_t i = 0; i < drawn; i++) {
        const vec3 u = {unit_float(3 * i), unit_float(3 * i + 1), unit_float(3 * i + 2)};
        const vec3 p = {low.x + u.x * (high.x - low.x), low.y + u.y * (high.y - low.y),
                        low.z + u.z * (high.z - low.z)};
        vec3_store(b->points[i], p);
    }
    alpi_sphere_rays survey = b->rays;
    survey.from.light = (alpi_surface_light){0};
    survey.face = 4;
    const alpi_sphere_job job = {.rays = &survey,
                                 .points = (const float(*)[3])b->points,
                                 .count = drawn,
                                 .values = b->values};
    ALP_TRY(alpi_sphere_gather(&job, NULL));
    for (uint32_t i = 0; i < drawn && b->count < wanted; i++) {
        if (b->values[i].behind <= ALPI_FREE_BACKS) {
            vec3_store(b->points[b->count++], vec3_load(b->points[i]));
        }
    }
    return b->count > 0 ? ALP_OK : ALP_ERROR_INVALID_DATA;
}

/// How much is gathered.
typedef enum gathering { LIGHT, MOMENTS, AIMED, GATHERINGS } gathering;

/// @param what LIGHT; MOMENTS: and distances; AIMED: and by aimed rays
static double time_gathering(const sphere_bench *b, gathering what)
{
    alpi_sphere_rays rays = b->rays;
    rays.aimed = what == AIMED ? b->aimed : NULL;
    const alpi_sphere_job job = {.rays = &rays,
                                 .points = (const float(*)[3])b->points,
                                 .count = b->count,
                                 .values = b->values,
                                 .moments = what != LIGHT ? b->moments : NULL};
    const double started = bench_thread_seconds();
    (void)!alpi_sphere_gather(&job, NULL);
    return bench_thread_seconds() - started;
}

/// The calls of a gathering, but those that look once more near a back.
static void record_calls(sphere_bench *b)
{
    embree_record *r = &b->record;
    const uint32_t packets = alpi_sphere_rays_count(&b->rays) / ALPI_PACKET + 64;
    *r = (embree_record){.capacity = 2 * b->count * packets, .every = 1};
    r->packets = aligned_alloc(64, ((size_t)r->capacity * sizeof *r->packets + 63) / 64 * 64);
    if (r->packets == NULL) {
        fprintf(stderr, "alpenglow bench: out of memory\n");
        exit(1);
    }
    embree_record_to(r);
    (void)time_gathering(b, LIGHT);
    embree_record_to(NULL);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        bool whole = true;
        for (int lane = 0; lane < ALPI_PACKET; lane++) {
            whole = whole && r->packets[i].valid[lane] != 0;
        }
        if (whole) {
            r->packets[kept++] = r->packets[i];
        }
    }
    r->count = kept;
}

static double time_raw(const sphere_bench *b)
{
    return raw_embree_time_calls(b->raw, &b->record, 0, b->record.count, bench_thread_seconds);
}

static void measure_gathering(sphere_bench *b, uint32_t face, uint32_t replicates, bool quick,
                              bench_table *table)
{
    const int rounds = quick ? 1 : ROUNDS;
    double raw[ROUNDS], ours[GATHERINGS][ROUNDS], ratios[GATHERINGS][ROUNDS];
    double each[GATHERINGS], ratio[GATHERINGS];
    b->rays.face = face;
    b->rays.replicates = replicates;
    record_calls(b);
    for (int i = 0; i < rounds; i++) {
        const double before = time_raw(b);
        for (int what = 0; what < GATHERINGS; what++) {
            ours[what][i] = time_gathering(b, (gathering)what);
        }
        raw[i] = 0.5 * (before + time_raw(b));
        for (int what = 0; what < GATHERINGS; what++) {
            ratios[what][i] = raw[i] / ours[what][i];
        }
    }
    for (int what = 0; what < GATHERINGS; what++) {
        each[what] = b->count / bench_median(ours[what], rounds);
        ratio[what] = bench_median(ratios[what], rounds);
    }
    bench_table_add(table, "%s|%u|%u × 6 × %u²|%.0f|%.0f|%.0f|%.0f|%.2f|%.2f|%.2f", b->scene.name,
                    alp_scene_get_info(b->scene.scene).usable_triangles, replicates, face,
                    b->count / bench_median(raw, rounds), each[LIGHT], each[MOMENTS], each[AIMED],
                    ratio[LIGHT], ratio[MOMENTS], ratio[AIMED]);
    free(b->record.packets);
}

static alp_result prepare(sphere_bench *b, bool sky, bool quick)
{
    alp_context_options one = alp_context_options_default();
    one.worker_count = 1;
    ALP_TRY(alp_context_create(&one, &b->context));
    ALP_TRY(solve(b, sky));
    const bool spots =
        alpi_lighting_sky(b->spots) != NULL || alpi_lighting_emitter_count(b->spots) > 0;
    b->rays = (alpi_sphere_rays){.context = b->context,
                                 .from = {.scene = b->scene.scene,
                                          .tracer = b->scene.tracer,
                                          .lighting = b->soft,
                                          .light = alpi_solution_light(b->solution),
                                          .sky = true},
                                 .replicates = ALPI_SPHERE_REPLICATES,
                                 .reach = 1.0f,
                                 .seed = 1};
    b->aimed = spots ? b->spots : NULL;
    return draw_free_points(b, quick ? QUICK_PROBES : PROBES);
}

static void close_bench(sphere_bench *b)
{
    raw_embree_destroy(b->raw);
    alpi_solution_destroy(b->solution);
    if (b->scene.context != NULL) {
        alpi_lighting_destroy(b->scene.context, b->lighting);
        alpi_lighting_destroy(b->scene.context, b->space);
        alpi_lighting_destroy(b->scene.context, b->soft);
        alpi_lighting_destroy(b->scene.context, b->spots);
        bench_scene_close(&b->scene);
    }
    alp_context_destroy(b->context);
    free(b->points);
    free(b->values);
    free(b->moments);
}

static bool run_scene(const char *name, bool sky, bool quick, bench_table *table)
{
    sphere_bench b = {.scene = {.name = name}};
    bool good =
        bench_scene_open(name, 0, &b.scene) && bench_good(&b.scene, prepare(&b, sky, quick));
    b.raw = good ? raw_embree_create(b.scene.scene, true) : NULL;
    good = b.raw != NULL;
    if (good) {
        measure_gathering(&b, ALPI_SPHERE_FACE, ALPI_SPHERE_REPLICATES, quick, table);
        measure_gathering(&b, 2 * ALPI_SPHERE_FACE, ALPI_SPHERE_REPLICATES_LEAST, quick, table);
    }
    close_bench(&b);
    return good;
}

int bench_probes(const bench_options *options)
{
    static bench_table table;
    static const struct {
        const char *name;
        bool sky;
    } scenes[] = {{"builtin:cornell", false}, {"hills:70000", true}, {"hills:1000000", true}};
    enum { SCENES = sizeof scenes / sizeof *scenes };
    bool good = run_lookups(options);
    bench_table_start(&table, "Light of probes, one worker, probes/s",
                      "Rays from free points, which look up the light of a solution. Limit: "
                      "`rtcIntersect8` on the packets that ours sends, recorded, with the coherent "
                      "flag if ours sets it. Ratio: limit's seconds over ours, median of the "
                      "rounds'. Moments: those of distances are gathered too. Aimed: with moments "
                      "and rays aimed at emitters and spots of the sky, which the limit lacks.",
                      "scene|triangles|rays|limit|ours|moments|aimed|ratio|moments|aimed");
    const size_t count = options->quick || options->scene != NULL ? 1 : SCENES;
    for (size_t i = 0; i < count && good; i++) {
        good = options->scene != NULL
                   ? run_scene(options->scene, true, options->quick, &table)
                   : run_scene(scenes[i].name, scenes[i].sky, options->quick, &table);
    }
    if (good) {
        bench_table_print(&table, options);
    }
    return good ? bench_kept_hits(options) : 1;
}
