// SPDX-License-Identifier: MIT
// Whether stated errors are true, and why a receiver has one sequence instead of some replicates.
#include "truth.h"

#include <math.h>
#include <stdlib.h>

typedef bool scene_fn(const bench_scene *scene, bench_map *map, const bench_options *options,
                      bench_table *table);

static bool with_scene(const char *name, uint32_t size, scene_fn *run, const bench_options *options,
                       bench_table *table)
{
    bench_scene scene;
    bench_map map;
    if (!bench_scene_open(name, 0, &scene)) {
        return false;
    }
    bool good = bench_map_open(&scene, options->quick ? 24 : size, &map);
    if (good) {
        good = run(&scene, &map, options, table);
        bench_map_close(&scene, &map);
    }
    bench_scene_close(&scene);
    return good;
}

// --- stated and true -----------------------------------------------------------------------------

/// Root mean squares over some seeds: half of one map's squared error may come from few texels.
static bool judge_stated(const bench_scene *scene, bench_map *map, uint32_t samples,
                         const bench_truth *truth, bench_table *table)
{
    enum { SEEDS = 4 };
    double stated = 0.0, real = 0.0, bias = 0.0, traced = 0.0;
    alp_occlusion_options o = alp_occlusion_options_default();
    o.samples = samples;
    bool good = true;
    for (o.seed = 1; o.seed <= SEEDS && good; o.seed++) {
        bench_result r;
        good = bench_bake(scene, map, &o, ALP_ADAPTIVE_AUTO, truth, &r);
        stated += r.report.relative * r.report.relative / SEEDS;
        real += r.rmse * r.rmse / (truth->mean * truth->mean) / SEEDS;
        bias += r.bias / SEEDS;
        traced += (double)r.report.traced / map->texels.count / SEEDS;
    }
    bench_table_add(table, "%s|%u|%.0f %%|%.2f %%|%.2f %%|%.2f|%+.4f", scene->name, samples,
                    100.0 * traced, 100.0 * sqrt(stated), 100.0 * sqrt(real), sqrt(stated / real),
                    bias);
    return good;
}

static bool run_stated(const bench_scene *scene, bench_map *map, const bench_options *options,
                       bench_table *table)
{
    static const uint32_t samples[] = {64, 256, 1024};
    const alp_occlusion_options o = alp_occlusion_options_default();
    bench_truth truth;
    if (!bench_truth_open(scene, map, &o, options->quick ? 256 : 4096, &truth)) {
        return false;
    }
    bool good = true;
    for (int k = 0; k < 3 && good; k++) {
        good =
            judge_stated(scene, map, options->quick ? samples[k] / 8 : samples[k], &truth, table);
    }
    bench_truth_close(&truth);
    return good;
}

// --- over seeds ----------------------------------------------------------------------------------

static bool judge_seeds(const bench_scene *scene, bench_map *map, float accuracy, uint64_t seeds,
                        const bench_truth *truth, bench_table *table)
{
    alp_occlusion_options o = alp_occlusion_options_default();
    double mean = 0.0, squares = 0.0, bias = 0.0;
    bool good = true;
    o.samples = 64;
    for (o.seed = 1; o.seed <= seeds && good; o.seed++) {
        bench_result r;
        good = bench_bake(scene, map, &o, accuracy, truth, &r);
        mean += r.z_mean / (double)seeds;
        squares += r.z_spread * r.z_spread / (double)seeds;
        bias += r.bias / (double)seeds;
    }
    bench_table_add(table, "%s|%u|%s|%.0f|%+.3f|%.3f|%+.5f", scene->name, map->texels.count,
                    accuracy == ALP_ADAPTIVE_OFF ? "off" : "auto", (double)seeds, mean,
                    sqrt(squares), bias);
    return good;
}

static bool run_seeds(const bench_scene *scene, bench_map *map, const bench_options *options,
                      bench_table *table)
{
    const uint64_t seeds = options->quick ? 4 : 64;
    const alp_occlusion_options o = alp_occlusion_options_default();
    bench_truth truth;
    if (!bench_truth_open(scene, map, &o, options->quick ? 256 : 4096, &truth)) {
        return false;
    }
    const bool good = judge_seeds(scene, map, ALP_ADAPTIVE_OFF, seeds, &truth, table) &&
                      judge_seeds(scene, map, ALP_ADAPTIVE_AUTO, seeds, &truth, table);
    bench_truth_close(&truth);
    return good;
}

// --- replicates ----------------------------------------------------------------------------------

/// RMSE of the mean of `replicates` independent bakes with `samples` rays in all.
static bool judge_replicates(const bench_scene *scene, const bench_map *map,
                             alp_occlusion_options o, uint32_t samples, uint32_t replicates,
                             const bench_truth *truth, double *rmse)
{
    const uint32_t count = map->texels.count;
    const alpi_receivers receivers = alpi_texels_receivers(&map->texels);
    float *sum = bench_allocate(count, sizeof *sum), *one = bench_allocate(count, sizeof *one);
    bool good = true;
    for (uint32_t k = 0; k < replicates && good; k++) {
        alpi_occlusion_setup setup;
        o.samples = samples / replicates;
        o.seed = 100 + k;
        good = bench_good(scene, alpi_occlusion_prepare(scene->scene, scene->tracer, &o, &setup));
        if (good) {
            good = bench_good(
                scene, alpi_occlusion_gather(&setup, &receivers, map->lattice.order, count, one));
            alpi_occlusion_release(&setup);
        }
        for (uint32_t i = 0; i < count; i++) {
            sum[i] += one[i] / (float)replicates;
        }
    }
    bench_result r;
    bench_judge(map, sum, truth, &r);
    *rmse = r.rmse;
    free(sum);
    free(one);
    return good;
}

static bool run_replicates(const bench_scene *scene, bench_map *map, const bench_options *options,
                           bench_table *table)
{
    alp_occlusion_options o = alp_occlusion_options_default();
    bench_truth truth;
    if (!bench_truth_open(scene, map, &o, options->quick ? 256 : 4096, &truth)) {
        return false;
    }
    bool good = true;
    for (uint32_t samples = 256; samples <= 1024 && good; samples *= 4) {
        double rmse[3] = {0.0};
        for (uint32_t k = 0; k < 3 && good; k++) {
            good = judge_replicates(scene, map, o, samples, 1u << k, &truth, &rmse[k]);
        }
        bench_table_add(table, "%s|%u|%.4f|%.4f|%.4f", scene->name, samples, rmse[0], rmse[1],
                        rmse[2]);
    }
    bench_truth_close(&truth);
    return good;
}

// --- all -----------------------------------------------------------------------------------------

static bool run_all(scene_fn *run, const char *const *names, int count, uint32_t size,
                    const bench_options *options, bench_table *table)
{
    bool good = true;
    for (int i = 0; i < (options->quick || options->scene != NULL ? 1 : count) && good; i++) {
        const char *name = options->scene != NULL ? options->scene : names[i];
        good = with_scene(name, size, run, options, table);
    }
    if (good) {
        bench_table_print(table, options);
    }
    return good;
}

int bench_accuracy(const bench_options *options)
{
    static const char *const names[] = {"builtin:cornell",     "builtin:sphere-plane",
                                        "builtin:torus-plane", "builtin:teapot-room",
                                        "builtin:bowl",        "hills:2000"};
    bench_table table;
    bench_table_start(
        &table, "Stated error and true error",
        "Both over the mean of the map; adaptive sampling, smooth fall-off, automatic "
        "distance, four seeds. The true error is measured against a converged bake "
        "of the same texels.",
        "scene|rays|traced|stated|true|stated/true|bias");
    bool good = run_all(run_stated, names, 6, 128, options, &table);
    bench_table_start(&table, "Error over stated error, texel by texel, over seeds",
                      "64 rays a texel. The mean should be near 0 and the spread near 1.",
                      "scene|texels|adaptive|seeds|mean|spread|bias");
    good = good && run_all(run_seeds, names, 4, 64, options, &table);
    bench_table_start(&table, "One sequence or some replicates",
                      "Root mean square error with the same number of rays in all. Replicates "
                      "would give a standard error for nothing, and cost this much.",
                      "scene|rays|one|2 replicates|4 replicates");
    good = good && run_all(run_replicates, names, 4, 96, options, &table);
    return good ? 0 : 1;
}
