// SPDX-License-Identifier: MIT
// Error per second of direct light: each light with samples of its own against the reference
// without bounces, which asks one light a path.
#include "bench.h"

#include "transport/direct/direct.h"

#include <math.h>
#include <stdlib.h>

enum { DIRECT_SAMPLES = 64, PATHS = 256 };

typedef struct light_case {
    const char *name;
    uint32_t size;
    bool sky; // a clear sky and a sun beside the scene's own light
} light_case;

typedef struct light_bench {
    const bench_scene *scene;
    alpi_lighting *lighting;
    alpi_receivers receivers;
    uint32_t *list, list_count;
    alpi_reference_value *values;
} light_bench;

/// Root of the mean of squared standard errors, over the mean: tests hold it to the true error.
static double relative_error(const light_bench *b)
{
    double squares = 0.0, mean = 0.0;
    for (uint32_t i = 0; i < b->list_count; i++) {
        for (int k = 0; k < 3; k++) {
            squares += (double)b->values[b->list[i]].variance[k];
            mean += (double)b->values[b->list[i]].mean[k];
        }
    }
    const double count = 3.0 * b->list_count;
    return sqrt(squares / count) / (mean / count);
}

static bool run_direct(const light_bench *b, uint32_t samples, double *seconds, double *error)
{
    const alpi_direct_options o = {.context = b->scene->context,
                                   .scene = b->scene->scene,
                                   .tracer = b->scene->tracer,
                                   .lighting = b->lighting,
                                   .samples = samples};
    alpi_direct_output output = {.values = b->values};
    alpi_direct *direct = NULL;
    const double started = alpi_seconds();
    bool good = bench_good(b->scene, alpi_direct_create(&o, &direct));
    good = good && bench_good(b->scene, alpi_direct_irradiance(direct, &b->receivers, b->list,
                                                               b->list_count, NULL, &output));
    *seconds = alpi_seconds() - started;
    alpi_direct_destroy(direct);
    *error = relative_error(b);
    return good;
}

static bool run_paths(const light_bench *b, uint32_t samples, double *seconds, double *error)
{
    const alpi_reference r = {.context = b->scene->context,
                              .scene = b->scene->scene,
                              .tracer = b->scene->tracer,
                              .lighting = b->lighting,
                              .samples = samples,
                              .next_event = true};
    const double started = alpi_seconds();
    const bool good =
        bench_good(b->scene, alpi_reference_irradiance(&r, &b->receivers, b->list, b->list_count,
                                                       NULL, b->values));
    *seconds = alpi_seconds() - started;
    *error = relative_error(b);
    return good;
}

/// In turns; the ratio is how many times as long the reference takes to the same error.
static bool measure(const light_case *c, const light_bench *b, const bench_options *options,
                    bench_table *table)
{
    enum { ROUNDS = 5 };
    double direct[ROUNDS], paths[ROUNDS], ratios[ROUNDS], errors[2] = {0.0, 0.0};
    const int rounds = options->quick ? 1 : ROUNDS;
    for (int i = 0; i < rounds; i++) {
        if (!run_direct(b, DIRECT_SAMPLES, &direct[i], &errors[0]) ||
            !run_paths(b, options->quick ? 16 : PATHS, &paths[i], &errors[1])) {
            return false;
        }
        ratios[i] = paths[i] * errors[1] * errors[1] / (direct[i] * errors[0] * errors[0]);
    }
    bench_table_add(table, "%s%s|%u|%.2f %%|%.3f|%.2f %%|%.3f|%.1f", b->scene->name,
                    c->sky ? " + sky, sun" : "", b->list_count, 100.0 * errors[0],
                    bench_median(direct, rounds), 100.0 * errors[1], bench_median(paths, rounds),
                    bench_median(ratios, rounds));
    return true;
}

static bool run_map(const light_case *c, const bench_scene *scene, const bench_map *map,
                    const bench_options *options, bench_table *table)
{
    alp_lighting_options o = alp_lighting_options_default();
    if (c->sky) {
        o.sky.kind = ALP_SKY_CLEAR;
        o.sun.illuminance = 1e5f;
    }
    const uint32_t count = map->texels.count;
    light_bench b = {.scene = scene, .receivers = alpi_texels_receivers(&map->texels)};
    b.list = bench_allocate(count, sizeof *b.list);
    b.values = bench_allocate(count, sizeof *b.values);
    for (uint32_t i = 0; i < count; i++) {
        if (!map->validity.dropped[map->lattice.order[i]]) {
            b.list[b.list_count++] = map->lattice.order[i];
        }
    }
    const bool good = bench_good(scene, alpi_lighting_create(scene->scene, &o, &b.lighting)) &&
                      measure(c, &b, options, table);
    alpi_lighting_destroy(scene->context, b.lighting);
    free(b.list);
    free(b.values);
    return good;
}

static bool run_case(const light_case *c, const bench_options *options, bench_table *table)
{
    bench_scene scene;
    bench_map map;
    if (!bench_scene_open(c->name, 0, &scene)) {
        return false;
    }
    bool good = bench_map_open(&scene, options->quick ? 24 : c->size, &map);
    if (good) {
        good = run_map(c, &scene, &map, options, table);
        bench_map_close(&scene, &map);
    }
    bench_scene_close(&scene);
    return good;
}

int bench_direct(const bench_options *options)
{
    static const light_case cases[] = {{"builtin:cornell", 256, false},
                                       {"builtin:teapot-room", 256, false},
                                       {"builtin:teapot-room", 256, true},
                                       {"builtin:windows", 256, false},
                                       {"builtin:atrium", 256, true}};
    enum { CASES = sizeof cases / sizeof *cases };
    bench_table table;
    bench_table_start(&table, "Direct light, all workers",
                      "64 samples of each light at a texel, and 256 paths of the reference without "
                      "bounces: stated error (root mean square over the mean) and seconds. Ratio: "
                      "the reference's seconds to the same error over ours.",
                      "scene|texels|error|s|reference|s|ratio");
    bool good = true;
    const int count = options->scene != NULL || options->quick ? 1 : CASES;
    for (int i = 0; i < count && good; i++) {
        light_case c = cases[i];
        c.name = options->scene != NULL ? options->scene : c.name;
        good = run_case(&c, options, &table);
    }
    if (good) {
        bench_table_print(&table, options);
    }
    return good ? 0 : 1;
}
