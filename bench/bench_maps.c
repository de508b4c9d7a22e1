// SPDX-License-Identifier: MIT
// Error per second of whole maps: one setting for all scenes, with and without interpolation.
#include "truth.h"

#include <math.h>
#include <string.h>

typedef struct map_scene {
    const char *name, *shared; // a file below $ALPENGLOW_SHARED goes before the name
    uint32_t size;
    float distance; // 0 = auto, then with the smooth fall-off; else none
} map_scene;

static const map_scene scenes[] = {
    {"builtin:cornell", "peers/blender/cornell.glb", 256, 0.2f},
    {"builtin:sphere-plane", "peers/blender/sphere_plane.glb", 256, 0.5f},
    {"builtin:torus-plane", NULL, 256, 0.5f},
    {"builtin:teapot-room", NULL, 256, 0.0f},
};

/// The name without folders.
static const char *short_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

static bool measure(const bench_scene *scene, bench_map *map, const alp_occlusion_options *o,
                    float accuracy, const bench_truth *truth, const bench_options *options,
                    bench_table *table)
{
    enum { ROUNDS = 5 };
    double seconds[ROUNDS];
    bench_result r = {.seconds = 0.0};
    const int rounds = options->quick ? 1 : ROUNDS;
    for (int i = 0; i < rounds; i++) {
        if (!bench_bake(scene, map, o, accuracy, truth, &r)) {
            return false;
        }
        seconds[i] = r.seconds;
    }
    const double sampling = bench_median(seconds, rounds);
    const double before =
        map->atlas_seconds + map->texel_seconds + scene->build_seconds + map->validity_seconds;
    const uint32_t count = map->texels.count;
    bench_table_add(table, "%s|%u|%u|%s|%.0f %%|%.4f|%.4f|%.3f|%.3f|%.3f", short_name(scene->name),
                    count, o->samples, accuracy == ALP_ADAPTIVE_OFF ? "off" : "auto",
                    100.0 * (double)r.report.traced / count, r.rmse, r.largest, before, sampling,
                    before + sampling);
    return true;
}

static bool run_scene(const map_scene *s, const bench_options *options, bench_table *table)
{
    static const uint32_t samples[] = {256, 1024};
    bench_scene scene;
    bench_map map;
    bench_truth truth = {0};
    const char *name = options->scene != NULL ? options->scene
                       : s->shared != NULL    ? bench_shared(s->shared, s->name)
                                              : s->name;
    if (!bench_scene_open(name, 0, &scene)) {
        return false;
    }
    alp_occlusion_options o = alp_occlusion_options_default();
    o.distance = s->distance;
    o.falloff = s->distance > 0.0f ? ALP_FALLOFF_NONE : ALP_FALLOFF_SMOOTH;
    bool good = bench_map_open(&scene, options->quick ? 32 : s->size, &map);
    const bool mapped = good;
    good = good && bench_truth_open(&scene, &map, &o, options->quick ? 256 : 4096, &truth);
    o.seed = 1;
    for (size_t k = 0; k < 2 && good; k++) {
        o.samples = options->quick ? samples[k] / 8 : samples[k];
        good = measure(&scene, &map, &o, ALP_ADAPTIVE_OFF, &truth, options, table) &&
               measure(&scene, &map, &o, ALP_ADAPTIVE_AUTO, &truth, options, table);
    }
    bench_truth_close(&truth);
    if (mapped) {
        bench_map_close(&scene, &map);
    }
    bench_scene_close(&scene);
    return good;
}

// --- cost by size --------------------------------------------------------------------------------

static bool measure_size(const bench_scene *scene, uint32_t size, const bench_options *options,
                         bench_table *table)
{
    enum { ROUNDS = 3 };
    double seconds[ROUNDS];
    bench_map map;
    bench_result r = {.seconds = 0.0};
    const int rounds = options->quick ? 1 : ROUNDS;
    alp_occlusion_options o = alp_occlusion_options_default();
    o.samples = options->quick ? 16 : 256;
    if (!bench_map_open(scene, size, &map)) {
        return false;
    }
    bool good = true;
    for (int i = 0; i < rounds && good; i++) {
        good = bench_bake(scene, &map, &o, ALP_ADAPTIVE_OFF, NULL, &r);
        seconds[i] = r.seconds;
    }
    if (good) {
        const double median = bench_median(seconds, rounds);
        bench_table_add(table, "%s|%u|%u|%.3f|%.3f|%.3f", scene->name, size, map.texels.count,
                        map.atlas_seconds + map.texel_seconds, map.validity_seconds + median,
                        1e6 * (map.validity_seconds + median) / map.texels.count);
    }
    bench_map_close(scene, &map);
    return good;
}

/// Every texel traced, so that what is seen is the cost of a texel.
static bool run_sizes(const bench_options *options)
{
    static const uint32_t sizes[] = {256, 512, 1024, 2048};
    bench_scene scene;
    bench_table table;
    if (!bench_scene_open("builtin:teapot-room", 0, &scene)) {
        return false;
    }
    bench_table_start(&table, "Cost by size, all workers",
                      "256 rays from every texel. Linear in texels where the last column is even.",
                      "scene|size|texels|atlas s|rays s|microseconds a texel");
    bool good = true;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes && good; i++) {
        good = measure_size(&scene, options->quick ? sizes[i] / 16 : sizes[i], options, &table);
    }
    bench_scene_close(&scene);
    if (good) {
        bench_table_print(&table, options);
    }
    return good;
}

int bench_maps(const bench_options *options)
{
    enum { SCENES = sizeof scenes / sizeof *scenes };
    const int count = options->scene != NULL || options->quick ? 1 : SCENES;
    bench_table table;
    bench_table_start(
        &table, "Error per second, all workers",
        "Root mean square and largest error against a converged bake of the same "
        "texels. Before: seconds for atlas, texels, acceleration structure and the look "
        "around the texels; then "
        "sampling, stated errors included.",
        "scene|texels|rays|adaptive|traced|rmse|largest|before s|sampling s|all s");
    bool good = true;
    for (int i = 0; i < count && good; i++) {
        good = run_scene(&scenes[i], options, &table);
    }
    if (good) {
        bench_table_print(&table, options);
        good = options->scene != NULL || run_sizes(options);
    }
    return good ? 0 : 1;
}
