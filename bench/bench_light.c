// SPDX-License-Identifier: MIT
// Gathering by hemicubes and by cosine rays against its limit: the raw calls on the very packets
// that the gatherer sends.
#include "lit_scene.h"

#include "raw_embree.h"

#include "base/tasks.h"
#include "transport/gather/cosine_rays.h"
#include "transport/gather/hemicube.h"

#include <stdlib.h>

enum { WORKER_LIMIT = 2, ROUNDS = 7, BATCH = 256 };
enum { CUBE = 64, CUBES = 256, CUBES_PER_RUN = 8 };
enum { RAYS = 256, REPLICATES = 4, TEXELS = 12288, TEXELS_PER_RUN = 512 };
enum { QUICK_CUBES = 8, QUICK_TEXELS = 512, QUICK_SIZE = 32 };

typedef struct gather_case {
    const lit_scene *lit;
    const raw_embree *raw;
    const char *name; // of the gatherer
    alpi_gatherer gatherer;
    uint32_t *list, list_count; // texels
    alpi_reference_value *values;
    alpi_rays *packets; // of all of them
    uint32_t packet_count;
    alp_context *context; // with as many workers as are measured
    uint32_t workers;
    bool in_pairs; // the raw calls
    double traced[WORKER_LIMIT];
} gather_case;

// --- rays ----------------------------------------------------------------------------------------

/// The packets as the gatherer aims them, in the order of the list.
static bool record_packets(gather_case *c)
{
    const alpi_gatherer *g = &c->gatherer;
    const size_t all = (size_t)c->list_count * g->packet_count;
    c->packets = aligned_alloc(64, (all * sizeof *c->packets + 63) / 64 * 64);
    for (uint32_t i = 0; i < c->list_count && c->packets != NULL; i++) {
        for (uint32_t first = 0; first < g->packet_count; first += ALPI_GATHER_BATCH) {
            alpi_gather_packet batch[ALPI_GATHER_BATCH];
            const uint32_t left = g->packet_count - first;
            const uint32_t count = left < ALPI_GATHER_BATCH ? left : ALPI_GATHER_BATCH;
            g->aim(g->user, &c->lit->receivers, c->list[i], first, count, batch, NULL);
            for (uint32_t k = 0; k < count; k++) {
                c->packets[c->packet_count++] = batch[k].rays;
            }
        }
    }
    return c->packets != NULL;
}

static alp_result run_raw_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    gather_case *c = user;
    const uint32_t first = begin * BATCH, most = (end - begin) * BATCH;
    const uint32_t left = c->packet_count - first, some = left < most ? left : most;
    double (*clock)(void) = c->workers == 1 ? bench_thread_seconds : alpi_seconds;
    const alpi_rays *packets = c->packets + first;
    c->traced[worker] +=
        c->in_pairs ? raw_embree_time_pairs(c->raw, packets, some, clock)
                    : raw_embree_time_nearest(c->raw, packets, some, c->gatherer.coherent, clock);
    return ALP_OK;
}

/// Seconds of the calls alone, as if they scaled perfectly over the workers.
static double time_raw(gather_case *c, bool in_pairs)
{
    double sum = 0.0;
    c->in_pairs = in_pairs;
    for (int w = 0; w < WORKER_LIMIT; w++) {
        c->traced[w] = 0.0;
    }
    (void)!alpi_parallel_for(c->context, (c->packet_count + BATCH - 1) / BATCH, 1, run_raw_range, c,
                             NULL);
    for (int w = 0; w < WORKER_LIMIT; w++) {
        sum += c->traced[w];
    }
    return sum / c->workers;
}

static double time_ours(const gather_case *c)
{
    const alpi_gather_scene from = alpi_radiosity_scene(&c->lit->solution);
    const alpi_gather_job job = {.context = c->context,
                                 .from = &from,
                                 .gatherer = &c->gatherer,
                                 .receivers = &c->lit->receivers,
                                 .list = c->list,
                                 .count = c->list_count,
                                 .values = c->values};
    const double started = bench_seconds(c->workers);
    (void)!alpi_gather_irradiance(&job, NULL);
    return bench_seconds(c->workers) - started;
}

static void measure(gather_case *c, int rounds, bench_table *table)
{
    double limits[ROUNDS], times[ROUNDS], ratios[ROUNDS], pairs[ROUNDS], pair_ratios[ROUNDS];
    const bool coherent = c->gatherer.coherent;
    for (int i = 0; i < rounds; i++) {
        const double before = time_raw(c, false);
        const double pairs_before = coherent ? time_raw(c, true) : 0.0;
        times[i] = time_ours(c);
        pairs[i] = coherent ? 0.5 * (pairs_before + time_raw(c, true)) : 0.0;
        limits[i] = 0.5 * (before + time_raw(c, false));
        ratios[i] = limits[i] / times[i];
        pair_ratios[i] = pairs[i] / times[i];
    }
    const double rays = 1e-6 * c->packet_count * ALPI_PACKET;
    char by_pairs[64] = "–|–";
    if (coherent) {
        snprintf(by_pairs, sizeof by_pairs, "%.1f|%.2f", rays / bench_median(pairs, rounds),
                 bench_median(pair_ratios, rounds));
    }
    bench_table_add(table, "%s|%u|%s|%u|%.1f|%.1f|%.2f|%s", c->lit->scene.name,
                    alp_scene_get_info(c->lit->scene.scene).usable_triangles, c->name, c->workers,
                    rays / bench_median(limits, rounds), rays / bench_median(times, rounds),
                    bench_median(ratios, rounds), by_pairs);
}

// --- one case ------------------------------------------------------------------------------------

static bool run_gatherer(gather_case *c, const bench_options *options, bench_table *table)
{
    c->values = bench_allocate(c->lit->map.texels.count, sizeof *c->values);
    bool good = record_packets(c);
    for (c->workers = 1; c->workers <= WORKER_LIMIT && good; c->workers++) {
        alp_context_options context = alp_context_options_default();
        context.worker_count = c->workers;
        good = bench_good(&c->lit->scene, alp_context_create(&context, &c->context));
        if (good) {
            measure(c, options->quick ? 1 : ROUNDS, table);
        }
        alp_context_destroy(c->context);
    }
    free(c->values);
    free(c->packets);
    free(c->list);
    return good;
}

static bool run_hemicubes(const lit_scene *lit, const raw_embree *raw, const bench_options *options,
                          bench_table *table)
{
    alpi_hemicube *cube = NULL;
    if (!bench_good(&lit->scene, alpi_hemicube_create(lit->scene.context, CUBE, &cube))) {
        return false;
    }
    const alpi_hemicube_options cubes = {
        .context = lit->scene.context, .cube = cube, .turned = true};
    gather_case c = {
        .lit = lit, .raw = raw, .name = "hemicube", .gatherer = alpi_hemicube_gatherer(&cubes)};
    c.list_count = bench_pick_texels(lit->order, lit->count, options->quick ? QUICK_CUBES : CUBES,
                                     CUBES_PER_RUN, &c.list);
    const bool good = run_gatherer(&c, options, table);
    alpi_hemicube_destroy(cube);
    return good;
}

static bool run_cosine_rays(const lit_scene *lit, const raw_embree *raw,
                            const bench_options *options, bench_table *table)
{
    const alpi_cosine_rays rays = {
        .context = lit->scene.context, .samples = RAYS, .replicates = REPLICATES, .joined = true};
    gather_case c = {
        .lit = lit, .raw = raw, .name = "cosine", .gatherer = alpi_cosine_rays_gatherer(&rays)};
    c.list_count = bench_pick_texels(lit->order, lit->count, options->quick ? QUICK_TEXELS : TEXELS,
                                     TEXELS_PER_RUN, &c.list);
    return run_gatherer(&c, options, table);
}

static bool run_scene(const char *name, uint32_t size, bool sky, const bench_options *options,
                      bench_table *table)
{
    lit_scene lit = {0};
    if (!bench_scene_open(name, 0, &lit.scene)) {
        return false;
    }
    alp_lighting_options light = alp_lighting_options_default();
    light.sky.kind = sky ? ALP_SKY_CLEAR : ALP_SKY_NONE;
    light.sun.elevation = 0.7f;
    alp_atlas_options atlas = alp_atlas_options_default();
    atlas.size = options->quick ? QUICK_SIZE : size;
    raw_embree *raw =
        lit_scene_make(&light, &atlas, &lit) ? raw_embree_create(lit.scene.scene, true) : NULL;
    const bool good = raw != NULL && run_hemicubes(&lit, raw, options, table) &&
                      run_cosine_rays(&lit, raw, options, table);
    raw_embree_destroy(raw);
    lit_scene_close(&lit);
    return good;
}

int bench_light(const bench_options *options)
{
    static const struct {
        const char *name;
        uint32_t size;
        bool sky;
    } scenes[] = {{"builtin:cornell", 256, false},
                  {"builtin:teapot-room", 1024, false},
                  {"hills:70000", 1024, true},
                  {"hills:1000000", 1024, true}};
    enum { SCENES = sizeof scenes / sizeof *scenes };
    bench_table table;
    bench_table_start(&table, "Gathering, Mrays/s",
                      "Hemicubes of 64 × 64 pixels, 12,288 rays, at 256 texels, and 256 cosine "
                      "rays at each of 12,288 texels, which look up the light of a solution. "
                      "Limit: `rtcIntersect8`, of hemicubes with the coherent flag, on the packets "
                      "that the gatherer sends, recorded. Ratio: limit's seconds over ours, median "
                      "of the rounds'. Of 16: the same with pairs of packets through "
                      "`rtcIntersect16`, which is what ours calls for hemicubes on machines of 512 "
                      "bits.",
                      "scene|triangles|rays|workers|limit|ours|ratio|limit of 16|ratio");
    bool good = true;
    const size_t count = options->quick || options->scene != NULL ? 1 : SCENES;
    for (size_t i = 0; i < count && good; i++) {
        good = options->scene != NULL
                   ? run_scene(options->scene, 1024, true, options, &table)
                   : run_scene(scenes[i].name, scenes[i].size, scenes[i].sky, options, &table);
    }
    if (good) {
        bench_table_print(&table, options);
    }
    return good ? bench_light_bakes(options) : 1;
}
