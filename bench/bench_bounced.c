// SPDX-License-Identifier: MIT
// The final gather: cost and error of the lattice and of tracing every texel.
//
// All gather from the same solution, so direct light and patches do not affect the figures. The
// truth is two independent maps y₁ and y₂ that trace every texel by many rays. So the squared error
// of a map x is E[(x − y₁)(x − y₂)].
#include "lit_scene.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "maps/radiosity/final_gather.h"
#include "transport/gather/cosine_rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    TRUTH_RAYS = 1024,
    QUICK_TRUTH_RAYS = 64,
    QUICK_SIZE = 32,
    REPLICATES = 4,
    PATH_SIZE = 1024
};
enum { SEED_TRUTH = 900, SEED_MAPS = 10, SEEDS = 3 };
enum { TIMED_RAYS = 64 };

typedef struct bounced_scene {
    const char *name, *title;
    const char *sky; // a picture below $ALPENGLOW_SHARED, or NULL
    double texels_per_metre;
    uint32_t size; // of the page; 0: so many texels per metre
    bool shared;   // a file below $ALPENGLOW_SHARED
    bool clear;    // under a clear sky
} bounced_scene;

static const bounced_scene scenes[] = {
    {.name = "builtin:cornell", .title = "cornell", .size = 256},
    {.name = "builtin:teapot-room", .title = "teapot-room", .size = 256},
    {.name = "builtin:atrium", .title = "atrium", .size = 256, .clear = true},
    {.name = "scenes/architecture/living_room.glb",
     .title = "living_room",
     .shared = true,
     .texels_per_metre = 8.0,
     .sky = "scenes/hdr/spiaggia_di_mondello_1k.hdr"},
};
enum { SCENE_COUNT = sizeof scenes / sizeof *scenes };

typedef struct bounced_case {
    const bounced_scene *setup;
    lit_scene lit;
    alp_image *sky;
    alpi_reference_value *truth[2], *values; // [texels]
    uint8_t *states;
    double mean; // of the truth
} bounced_case;

// --- scenes --------------------------------------------------------------------------------------

static alp_result find_lighting(bounced_case *c, const char *sky, alp_lighting_options *options)
{
    *options = alp_lighting_options_default();
    if (sky != NULL) {
        ALP_TRY(alp_image_load(c->lit.scene.context, sky, &c->sky));
        options->sky.kind = ALP_SKY_IMAGE;
        options->sky.image = c->sky;
    } else if (c->setup->clear) {
        options->sky.kind = ALP_SKY_CLEAR;
        options->sun.azimuth = (float)(150.0 * ALPI_PI / 180.0);
        options->sun.elevation = (float)(40.0 * ALPI_PI / 180.0);
    }
    return ALP_OK;
}

/// A way to gather.
typedef struct bounced_way {
    const char *name;
    bool adaptive;
} bounced_way;

static bool gather(const bounced_case *c, const bounced_way *way, uint32_t rays, uint64_t seed,
                   alpi_reference_value *values, alpi_final_gather_report *report)
{
    const alpi_gather_scene from = alpi_radiosity_scene(&c->lit.solution);
    const alpi_cosine_rays cosine = {.context = c->lit.scene.context,
                                     .samples = alpi_cosine_rays_samples(rays, REPLICATES),
                                     .replicates = REPLICATES,
                                     .seed = alpi_hash64(seed)};
    const alpi_gatherer gatherer = alpi_cosine_rays_gatherer(&cosine);
    const alpi_gather_job job = {.context = c->lit.scene.context,
                                 .from = &from,
                                 .gatherer = &gatherer,
                                 .receivers = &c->lit.receivers,
                                 .values = values};
    const alpi_final_gather_options options = {.gather = &job,
                                               .order = c->lit.order,
                                               .count = c->lit.count,
                                               .proximity = c->lit.map.validity.proximity,
                                               .adaptive = way->adaptive};
    return bench_good(&c->lit.scene,
                      alpi_final_gather(&options, &c->lit.map.lattice, NULL, c->states, report));
}

static bool find_truth(bounced_case *c, bool quick)
{
    const bounced_way all = {.name = ""};
    const uint32_t texels = c->lit.map.texels.count;
    alpi_final_gather_report report = {0};
    double sum = 0.0;
    c->states = bench_allocate(texels, sizeof *c->states);
    c->values = bench_allocate(texels, sizeof *c->values);
    for (uint64_t k = 0; k < 2; k++) {
        c->truth[k] = bench_allocate(texels, sizeof *c->truth[k]);
        if (!gather(c, &all, quick ? QUICK_TRUTH_RAYS : TRUTH_RAYS, SEED_TRUTH + k, c->truth[k],
                    &report)) {
            return false;
        }
        for (uint32_t i = 0; i < c->lit.count; i++) {
            for (int ch = 0; ch < 3; ch++) {
                sum += (double)c->truth[k][c->lit.order[i]].mean[ch];
            }
        }
    }
    c->mean = fmax(sum / (6.0 * fmax(c->lit.count, 1.0)), 1e-30);
    return true;
}

static bool open_case(const bounced_scene *setup, bool quick, bounced_case *c)
{
    char path[PATH_SIZE], sky[PATH_SIZE];
    *c = (bounced_case){.setup = setup};
    snprintf(path, sizeof path, "%s", setup->shared ? bench_shared(setup->name, "") : setup->name);
    snprintf(sky, sizeof sky, "%s", setup->sky != NULL ? bench_shared(setup->sky, "") : "");
    alp_lighting_options lighting;
    if (!bench_scene_open(path, 0, &c->lit.scene) ||
        !bench_good(&c->lit.scene, find_lighting(c, setup->sky != NULL ? sky : NULL, &lighting))) {
        return false;
    }
    alp_atlas_options options = alp_atlas_options_default();
    options.size = quick ? QUICK_SIZE : setup->size > 0 ? setup->size : options.size;
    options.texels_per_metre = quick ? 0.0 : setup->texels_per_metre;
    return lit_scene_make(&lighting, &options, &c->lit) && find_truth(c, quick);
}

static void close_case(bounced_case *c)
{
    free(c->states);
    free(c->values);
    free(c->truth[0]);
    free(c->truth[1]);
    alp_image_destroy(c->sky);
    lit_scene_close(&c->lit);
}

// --- errors --------------------------------------------------------------------------------------

typedef struct bounced_error {
    double squares, bias, stated, seconds, traced;
} bounced_error;

static void add_error(const bounced_case *c, bounced_error *e)
{
    double squares = 0.0, bias = 0.0, stated = 0.0;
    for (uint32_t i = 0; i < c->lit.count; i++) {
        const uint32_t t = c->lit.order[i];
        for (int k = 0; k < 3; k++) {
            const double x = (double)c->values[t].mean[k];
            const double a = x - (double)c->truth[0][t].mean[k];
            const double b = x - (double)c->truth[1][t].mean[k];
            squares += a * b;
            bias += 0.5 * (a + b);
            stated += (double)c->values[t].variance[k];
        }
    }
    const double all = 3.0 * fmax(c->lit.count, 1.0);
    e->squares += fmax(squares, 0.0) / all / (c->mean * c->mean);
    e->bias += bias / all / c->mean;
    e->stated += stated / all / (c->mean * c->mean);
}

static bool measure(const bounced_case *c, const bounced_way *way, uint32_t rays, int seeds,
                    bounced_error *e)
{
    *e = (bounced_error){0};
    double seconds[SEEDS];
    for (int s = 0; s < seeds; s++) {
        alpi_final_gather_report report = {0};
        const double began = bench_process_seconds();
        if (!gather(c, way, rays, SEED_MAPS + (uint64_t)s, c->values, &report)) {
            return false;
        }
        seconds[s] = bench_process_seconds() - began;
        add_error(c, e);
        e->traced += (double)report.traced / c->lit.count;
    }
    e->seconds = bench_median(seconds, seeds);
    e->squares /= seeds;
    e->bias /= seeds;
    e->stated /= seeds;
    e->traced /= seeds;
    return true;
}

static bool measure_ways(const bounced_case *c, const bench_options *options, bench_table *table)
{
    static const bounced_way ways[] = {{.name = "every texel"},
                                       {.name = "lattice", .adaptive = true}};
    enum { WAYS = sizeof ways / sizeof *ways };
    static const uint32_t rays[] = {64, 1024};
    for (int r = 0; r < (options->quick ? 1 : 2); r++) {
        bounced_error first = {0};
        for (int w = 0; w < WAYS; w++) {
            bounced_error e;
            if (!measure(c, &ways[w], rays[r], options->quick ? 1 : SEEDS, &e)) {
                return false;
            }
            first = w == 0 ? e : first;
            bench_table_add(table, "%s|%u|%s|%.1f %%|%.2f %%|%+.3f %%|%.2f|%.3f|%.2f",
                            c->setup->title, rays[r], ways[w].name, 100.0 * e.traced,
                            100.0 * sqrt(e.squares), 100.0 * e.bias, sqrt(e.stated / e.squares),
                            e.seconds, first.squares * first.seconds / (e.squares * e.seconds));
        }
    }
    return true;
}

// --- where the time goes -------------------------------------------------------------------------

static void find_no_cells(const void *user, const alpi_hits *hits, const uint32_t *met,
                          uint32_t count, uint32_t (*cells)[ALPI_PACKET])
{
    (void)user;
    (void)hits;
    for (uint32_t k = 0; k < count; k++) {
        for (int i = 0; i < ALPI_PACKET; i++) {
            cells[k][i] = (met[k] >> i & 1u) != 0 ? ALPI_CELL_FIRST : cells[k][i];
        }
    }
}

/// Processor seconds of the rays of all texels. @param look_up whether their hits read cells
static bool time_rays(const bounced_case *c, bool look_up, double *seconds)
{
    alpi_gather_scene from = alpi_radiosity_scene(&c->lit.solution);
    const alpi_cosine_rays cosine = {.context = c->lit.scene.context,
                                     .samples = TIMED_RAYS,
                                     .replicates = REPLICATES,
                                     .seed = 1};
    const alpi_gatherer gatherer = alpi_cosine_rays_gatherer(&cosine);
    if (!look_up) {
        from.light.find = find_no_cells;
    }
    const alpi_gather_job job = {.context = c->lit.scene.context,
                                 .from = &from,
                                 .gatherer = &gatherer,
                                 .receivers = &c->lit.receivers,
                                 .list = c->lit.order,
                                 .count = c->lit.count,
                                 .values = c->values};
    const double began = bench_process_seconds();
    const bool good = bench_good(&c->lit.scene, alpi_gather_irradiance(&job, NULL));
    *seconds = bench_process_seconds() - began;
    return good;
}

/// Processor seconds of the solution, and its number of passes.
static bool time_solution(const bounced_case *c, uint32_t bounces, double *seconds,
                          uint32_t *passes)
{
    alpi_radiosity solution;
    const double began = bench_process_seconds();
    if (!bench_good(&c->lit.scene, lit_scene_solve(&c->lit, bounces, &solution))) {
        return false;
    }
    *seconds = bench_process_seconds() - began;
    *passes = solution.passes;
    alpi_radiosity_destroy(&solution);
    return true;
}

static bool measure_times(const bounced_case *c, const bench_options *options, bench_table *table)
{
    enum { ROUNDS = 5 };
    double all[ROUNDS], blind[ROUNDS], solved[ROUNDS], once[ROUNDS];
    uint32_t passes = 0, one = 0;
    const int rounds = options->quick ? 1 : ROUNDS;
    for (int i = 0; i < rounds; i++) {
        if (!time_rays(c, true, &all[i]) || !time_rays(c, false, &blind[i]) ||
            !time_solution(c, UINT32_MAX, &solved[i], &passes) ||
            !time_solution(c, 1, &once[i], &one)) {
            return false;
        }
    }
    const double with = bench_median(all, rounds), without = bench_median(blind, rounds);
    const double whole = bench_median(solved, rounds), first = bench_median(once, rounds);
    bench_table_add(table, "%s|%.3f|%.3f|%.0f %%|%.3f|%u|%.3f|%.0f %%", c->setup->title, with,
                    without, 100.0 * (1.0 - without / with), whole, passes,
                    fmax(whole - first, 0.0), 100.0 * fmax(1.0 - first / whole, 0.0));
    return true;
}

// --- all -----------------------------------------------------------------------------------------

static bool is_chosen(const bounced_scene *setup, const bench_options *options)
{
    return (!setup->shared || bench_shared(setup->name, NULL) != NULL) &&
           (options->scene == NULL || strcmp(options->scene, setup->title) == 0);
}

int bench_bounced(const bench_options *options)
{
    bench_table errors, times;
    bench_table_start(&errors, "The final gather",
                      "Root mean square error over the mean. The truth traces every texel by twice "
                      "1,024 rays into the same solution. Processor seconds of all threads. Worth: "
                      "seconds for the same error by tracing every texel, over those of the way.",
                      "scene|rays|way|traced|error|bias|stated/true|s|worth");
    bench_table_start(&times, "Time of the final gather and of the solution",
                      "Processor seconds. Rays: 64 of every texel, with and without the look-up of "
                      "cells. Solution: direct light, the rays of patches, which are traced once, "
                      "and all passes. Later ones: all passes but the first.",
                      "scene|rays|no look-ups|look-ups|solution|passes|later ones|of it");
    bool good = true;
    for (int i = 0; i < SCENE_COUNT && good; i++) {
        if (!is_chosen(&scenes[i], options)) {
            continue;
        }
        bounced_case c;
        good = open_case(&scenes[i], options->quick, &c) && measure_times(&c, options, &times) &&
               measure_ways(&c, options, &errors);
        close_case(&c);
    }
    if (good) {
        bench_table_print(&errors, options);
        bench_table_print(&times, options);
    }
    return good ? 0 : 1;
}
