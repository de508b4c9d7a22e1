// SPDX-License-Identifier: MIT
// The occlusion loop against its limit, the raw call on the very rays it sends, and against the
// natural loop, which puts eight samples of one point that follow each other into a packet.
#include "bench.h"

#include "raw_embree.h"
#include "recorded_rays.h"

#include "base/tasks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    BLOCK = 512,          // packets that fit the second-level cache
    TEXELS_PER_RUN = 512, // texels that follow each other
    WORKER_LIMIT = 2
};

/// What of Embree is called.
typedef enum raw_call { RAW_PACKETS, RAW_PAIRS, RAW_STREAM } raw_call;

typedef struct measured_case {
    const bench_scene *scene;
    alp_context *context; // with as many workers as are measured
    uint32_t workers;
    alpi_occlusion_setup setup;
    alpi_receivers receivers;
    uint32_t *list, list_count;
    uint32_t samples; // sent from each receiver
    alpi_occlusion_sums sums;
    raw_embree *raw; // by the same hierarchy
    const char *hierarchy;
    ray_record record, parallel;
    const ray_record *timed;
    raw_call call;
    double traced[WORKER_LIMIT];
    alpi_rays *blocks[WORKER_LIMIT]; // [BLOCK], or half as many pairs
} measured_case;

// --- what is measured ----------------------------------------------------------------------------

/// Raw calls on recorded packets. A call destroys its packet, so each block is copied to a place in
/// the cache first, which is not timed.
static alp_result run_raw_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    measured_case *c = user;
    for (uint32_t block = begin; block < end; block++) {
        const uint32_t first = block * BLOCK, left = c->timed->count - first;
        const uint32_t count = left < BLOCK ? left : BLOCK;
        const alpi_rays *packets = c->timed->packets + first;
        if (c->call == RAW_PAIRS) {
            raw_embree_lay_pairs(packets, count, (alpi_ray_pair *)c->blocks[worker]);
        } else {
            memcpy(c->blocks[worker], packets, count * sizeof *packets);
        }
        const double started = c->workers == 1 ? bench_thread_seconds() : alpi_seconds();
        if (c->call == RAW_PAIRS) {
            raw_embree_occluded_pairs(c->raw, (alpi_ray_pair *)c->blocks[worker], count / 2);
        } else if (c->call == RAW_STREAM) {
            raw_embree_occluded_stream(c->raw, c->blocks[worker], count);
        } else {
            raw_embree_occluded(c->raw, c->blocks[worker], count);
        }
        c->traced[worker] += (c->workers == 1 ? bench_thread_seconds() : alpi_seconds()) - started;
    }
    return ALP_OK;
}

/// Seconds of the calls alone, as if they scaled perfectly over the workers.
static double time_raw(measured_case *c, const ray_record *record, raw_call call)
{
    double sum = 0.0;
    memset(c->traced, 0, sizeof c->traced);
    c->timed = record;
    c->call = call;
    (void)!alpi_parallel_for(c->context, (record->count + BLOCK - 1) / BLOCK, 1, run_raw_range, c,
                             NULL);
    for (uint32_t w = 0; w < c->workers; w++) {
        sum += c->traced[w];
    }
    return sum / c->workers;
}

static double time_ours(measured_case *c)
{
    const double started = bench_seconds(c->workers);
    (void)!alpi_occlusion_add(&c->setup, &c->receivers, c->list, c->list_count, 0, c->samples,
                              c->setup.samples, NULL, &c->sums);
    return bench_seconds(c->workers) - started;
}

/// @param careful by the hierarchy that no ray slips through, else by the one that ours uses
static double time_natural(measured_case *c, bool careful, uint32_t *open)
{
    alpi_occlusion_setup setup = c->setup;
    setup.filter.quick = setup.filter.quick && !careful;
    natural_loop loop = {.setup = &setup,
                         .receivers = &c->receivers,
                         .list = c->list,
                         .count = c->samples,
                         .open = open};
    const double started = bench_seconds(c->workers);
    (void)!alpi_parallel_for(c->context, c->list_count, 64, natural_loop_range, &loop, NULL);
    return bench_seconds(c->workers) - started;
}

// --- one case ------------------------------------------------------------------------------------

static alpi_rays *new_packets(uint32_t count)
{
    return aligned_alloc(64, (count * sizeof(alpi_rays) + 63) / 64 * 64);
}

/// Sample `sample` of eight receivers that follow each other in one packet, all in the direction of
/// the first. @param first the first receiver's packets
static void make_parallel(const alpi_rays *first, uint32_t each, uint32_t sample, alpi_rays *to)
{
    const alpi_rays *leader = &first[sample / ALPI_PACKET];
    const uint32_t lane = sample % ALPI_PACKET;
    *to = *leader;
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        const alpi_rays *own = leader + i * each;
        to->origin_x[i] = own->origin_x[lane];
        to->origin_y[i] = own->origin_y[lane];
        to->origin_z[i] = own->origin_z[lane];
        to->direction_x[i] = leader->direction_x[lane];
        to->direction_y[i] = leader->direction_y[lane];
        to->direction_z[i] = leader->direction_z[lane];
        to->maximum[i] = leader->maximum[lane];
    }
}

/// The tightest packets that neighbours make. They are no loop's that could be used: eight texels
/// would have their noise in common.
static bool record_parallel(measured_case *c)
{
    const uint32_t each = c->samples / ALPI_PACKET; // packets of a receiver
    if (c->record.count != c->list_count * each || c->list_count < ALPI_PACKET) {
        return false; // then a receiver's packets are not one after the other
    }
    c->parallel.packets = new_packets(c->record.count);
    for (uint32_t i = 0; i + ALPI_PACKET <= c->list_count && c->parallel.packets != NULL;
         i += ALPI_PACKET) {
        for (uint32_t s = 0; s < c->samples; s++) {
            make_parallel(c->record.packets + (size_t)i * each, each, s,
                          &c->parallel.packets[c->parallel.count++]);
        }
    }
    return c->parallel.packets != NULL;
}

static bool record_rays(measured_case *c)
{
    alpi_occlusion_setup recording = c->setup;
    recording.context = c->scene->context; // of one worker: in order
    recording.kernel = bench_recording_kernel;
    c->record.capacity = c->list_count * (c->samples / ALPI_PACKET);
    c->record.packets = new_packets(c->record.capacity);
    ray_record_use(&c->record);
    return c->record.packets != NULL &&
           alpi_occlusion_add(&recording, &c->receivers, c->list, c->list_count, 0, c->samples,
                              recording.samples, NULL, &c->sums) == ALP_OK &&
           record_parallel(c);
}

static void measure(measured_case *c, uint32_t rounds, bench_table *table)
{
    double ratios[BENCH_ROUND_LIMIT], limits[BENCH_ROUND_LIMIT], times[BENCH_ROUND_LIMIT];
    double natural[BENCH_ROUND_LIMIT], stream[BENCH_ROUND_LIMIT], parallel[BENCH_ROUND_LIMIT];
    double careful[BENCH_ROUND_LIMIT], pairs[BENCH_ROUND_LIMIT];
    uint32_t *open = bench_allocate(c->receivers.count, sizeof *open);
    for (uint32_t i = 0; i < rounds; i++) {
        limits[i] = time_raw(c, &c->record, RAW_PACKETS);
        times[i] = time_ours(c);
        natural[i] = careful[i] = time_natural(c, false, open);
        if (c->setup.filter.quick) {
            careful[i] = time_natural(c, true, open);
        }
        parallel[i] = natural[i] / time_raw(c, &c->parallel, RAW_PACKETS) * c->parallel.count /
                      c->record.count;
        natural[i] /= times[i];
        careful[i] /= times[i];
        pairs[i] = limits[i] / time_raw(c, &c->record, RAW_PAIRS);
        stream[i] = limits[i] / time_raw(c, &c->record, RAW_STREAM);
        limits[i] =
            0.5 * (limits[i] + time_raw(c, &c->record, RAW_PACKETS)); // before and after ours
        ratios[i] = limits[i] / times[i];
    }
    const double rays = 1e-6 * c->list_count * c->samples;
    bench_table_add(table, "%s|%u|%s|%u|%.1f|%.1f|%.2f|%.2f|%.2f|%.2f|%.2f|%.2f", c->scene->name,
                    alp_scene_get_info(c->scene->scene).usable_triangles, c->hierarchy, c->workers,
                    rays / bench_median(limits, (int)rounds),
                    rays / bench_median(times, (int)rounds), bench_median(ratios, (int)rounds),
                    bench_median(natural, (int)rounds), bench_median(careful, (int)rounds),
                    bench_median(parallel, (int)rounds), bench_median(pairs, (int)rounds),
                    bench_median(stream, (int)rounds));
    free(open);
}

static void release_case(measured_case *c)
{
    for (int w = 0; w < WORKER_LIMIT; w++) {
        free(c->blocks[w]);
    }
    free(c->list);
    free(c->record.packets);
    free(c->parallel.packets);
    alpi_occlusion_sums_destroy(c->scene->context, &c->sums);
    alpi_occlusion_release(&c->setup);
    raw_embree_destroy(c->raw);
}

/// @param quick by the hierarchy of maps with many rays (alpi_tracer_quicken), where `bake` would
///              take it for this map; else by the careful one
static bool run_case(const bench_scene *scene, const bench_map *map, bool quick,
                     const bench_options *options, bench_table *table)
{
    alp_occlusion_options o = alp_occlusion_options_default();
    measured_case c = {.scene = scene, .samples = 256};
    c.receivers = alpi_texels_receivers(&map->texels);
    if (!bench_good(scene, alpi_occlusion_prepare(scene->scene, scene->tracer, &o, &c.setup))) {
        return false;
    }
    const double rays = (double)map->texels.count * c.samples;
    bool taken = false;
    bool good =
        !quick || bench_good(scene, alpi_tracer_quicken(scene->tracer, rays, NULL, NULL, &taken));
    alpi_occlusion_be_quick(&c.setup, taken);
    if (!good || quick != taken) { // not for these rays
        release_case(&c);
        return good;
    }
    c.hierarchy = quick ? "quick" : "careful";
    c.raw = raw_embree_create(scene->scene, !quick);
    good = c.raw != NULL &&
           bench_good(scene, alpi_occlusion_sums_create(scene->context, map->texels.count, false,
                                                        &c.sums));
    for (int w = 0; w < WORKER_LIMIT; w++) {
        c.blocks[w] = aligned_alloc(64, BLOCK * sizeof(alpi_rays));
    }
    c.list_count = bench_pick_texels(map->lattice.order, map->texels.count,
                                     options->quick ? 1024 : 20480, TEXELS_PER_RUN, &c.list);
    good = good && c.blocks[0] != NULL && c.blocks[1] != NULL && record_rays(&c);
    for (c.workers = 1; c.workers <= WORKER_LIMIT && good; c.workers++) {
        alp_context_options context = alp_context_options_default();
        context.worker_count = c.workers;
        good = bench_good(scene, alp_context_create(&context, &c.context));
        c.setup.context = c.context;
        if (good) {
            measure(&c, options->quick ? 1 : 5, table);
        }
        alp_context_destroy(c.context);
    }
    c.setup.context = scene->context;
    release_case(&c);
    return good;
}

static bool run_scene(const char *name, uint32_t size, const bench_options *options,
                      bench_table *table)
{
    bench_scene scene;
    bench_map map;
    if (!bench_scene_open(name, 1, &scene)) {
        return false;
    }
    const bool mapped = bench_map_open(&scene, options->quick ? 64 : size, &map);
    const bool good = mapped && run_case(&scene, &map, false, options, table) &&
                      run_case(&scene, &map, true, options, table);
    if (mapped) {
        bench_map_close(&scene, &map);
    }
    bench_scene_close(&scene);
    return good;
}

int bench_transport(const bench_options *options)
{
    static const struct {
        const char *name;
        uint32_t size;
    } scenes[] = {{"builtin:cornell", 256}, {"builtin:teapot-room", 1024},
                  {"builtin:atrium", 1024}, {"builtin:atrium,triangles=1000000", 1024},
                  {"hills:70000", 1024},    {"hills:1000000", 1024}};
    static const char *const quick_scenes[] = {"builtin:cornell", "hills:500"};
    enum {
        SCENES = sizeof scenes / sizeof *scenes,
        QUICK_SCENES = sizeof quick_scenes / sizeof *quick_scenes
    };
    bench_table table;
    bench_table_start(&table, "Occlusion loop, Mrays/s",
                      "Hierarchy: careful, where no ray slips through the edge between two "
                      "triangles; quick, the second one that `bake` builds for maps of 500 rays a "
                      "triangle and more (of a sphere less than one ray in a million slips "
                      "through; building it is not counted here), which these maps are where it "
                      "is shown. Limit: `rtcOccluded8` by the same hierarchy, on the packets that "
                      "our loop sends, recorded. Ratio: limit's seconds over ours. Natural: "
                      "seconds of the loop with eight samples of one point, as they follow each "
                      "other, in a packet, over ours: by the same hierarchy, which is what our "
                      "packets, and pairs of them, gain, and by the careful one, which is what "
                      "these and the hierarchy gain together. Natural/parallel: the same loop "
                      "over the bare calls on packets of parallel rays from eight neighbouring "
                      "texels, which would err as one. Pairs and stream: the limit by "
                      "`rtcOccluded16`, of two packets that follow each other, which ours calls "
                      "too where the machine has vectors of sixteen, and by `rtcOccludedNM`: its "
                      "rate over the limit's.",
                      "scene|triangles|hierarchy|workers|limit|ours|ratio|natural/ours|"
                      "careful natural/ours|natural/parallel|pairs|stream");
    bool good = true;
    for (size_t i = 0; i < QUICK_SCENES && good && options->scene == NULL && options->quick; i++) {
        good = run_scene(quick_scenes[i], 64, options, &table);
    }
    for (size_t i = 0; i < SCENES && good && options->scene == NULL && !options->quick; i++) {
        if (!bench_scene_exists(scenes[i].name) && strncmp(scenes[i].name, "hills", 5) != 0) {
            bench_table_add(&table, "%s|not there", scenes[i].name);
            continue;
        }
        good = run_scene(scenes[i].name, scenes[i].size, options, &table);
    }
    if (options->scene != NULL) {
        good = run_scene(options->scene, 1024, options, &table);
    }
    if (good) {
        bench_table_print(&table, options);
    }
    return good && bench_direct(options) == 0 ? bench_path_tracer(options) : 1;
}
