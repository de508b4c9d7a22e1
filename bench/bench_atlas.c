// SPDX-License-Identifier: MIT
// Atlases: triangles per second, and how the time grows with triangles and with texels.
#include "bench.h"

#include "base/tasks.h"

static bool run_scene(const char *name, uint32_t size, const bench_options *options,
                      bench_table *table)
{
    enum { ROUNDS = 3 };
    double seconds[ROUNDS];
    bench_scene scene;
    uint64_t texels = 0;
    if (!bench_scene_open(name, 0, &scene)) {
        return false;
    }
    const int rounds = options->quick ? 1 : ROUNDS;
    bool good = true;
    for (int i = 0; i < rounds && good; i++) {
        alp_atlas_options o = alp_atlas_options_default();
        alp_atlas *atlas = NULL;
        alpi_texels t = {0};
        o.size = size;
        const double started = alpi_seconds();
        good = bench_good(&scene, alp_atlas_create(scene.scene, &o, &atlas)) &&
               bench_good(&scene, alpi_texels_create(atlas, &t));
        seconds[i] = alpi_seconds() - started;
        texels = t.count;
        alpi_texels_destroy(scene.context, &t);
        alp_atlas_destroy(atlas);
    }
    const uint32_t triangles = alp_scene_get_info(scene.scene).usable_triangles;
    const double median = bench_median(seconds, rounds);
    bench_table_add(table, "%s|%u|%u|%llu|%.3f|%.3f", name, triangles, size,
                    (unsigned long long)texels, median, 1e-6 * triangles / median);
    bench_scene_close(&scene);
    return good;
}

int bench_atlas(const bench_options *options)
{
    static const struct {
        const char *name;
        uint32_t size;
    } scenes[] = {{"builtin:teapot-room", 256},  {"builtin:teapot-room", 512},
                  {"builtin:teapot-room", 1024}, {"hills:70000", 1024},
                  {"hills:250000", 1024},        {"hills:1000000", 1024}};
    enum { SCENES = sizeof scenes / sizeof *scenes };
    bench_table table;
    bench_table_start(&table, "Atlas with its texels, all workers", NULL,
                      "scene|triangles|size|texels|seconds|million triangles/s");
    bool good = true;
    for (int i = 0; i < (options->quick ? 1 : SCENES) && good && options->scene == NULL; i++) {
        good = run_scene(scenes[i].name, options->quick ? 64 : scenes[i].size, options, &table);
    }
    if (options->scene != NULL) {
        good = run_scene(options->scene, 1024, options, &table);
    }
    if (good) {
        bench_table_print(&table, options);
    }
    return good ? 0 : 1;
}
