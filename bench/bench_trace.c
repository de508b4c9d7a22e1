// SPDX-License-Identifier: MIT
// The acceleration structure: seconds to build it against Embree called directly.
#include "bench.h"

#include "raw_embree.h"

static bool run_scene(const char *name, const bench_options *options, bench_table *table)
{
    enum { ROUNDS = 5 };
    double ours[ROUNDS], limits[ROUNDS], ratios[ROUNDS];
    const int rounds = options->quick ? 1 : ROUNDS;
    uint32_t triangles = 0;
    for (int i = 0; i < rounds; i++) { // a scene keeps its structure, so each round loads it anew
        bench_scene scene;
        if (!bench_scene_open(name, 1, &scene)) {
            return false;
        }
        raw_embree *raw = raw_embree_create(scene.scene, true);
        if (raw == NULL) {
            bench_scene_close(&scene);
            return false;
        }
        triangles = alp_scene_get_info(scene.scene).usable_triangles;
        ours[i] = scene.build_seconds;
        limits[i] = raw_embree_build_seconds(raw);
        ratios[i] = limits[i] / ours[i];
        raw_embree_destroy(raw);
        bench_scene_close(&scene);
    }
    bench_table_add(table, "%s|%u|%.4f|%.4f|%.2f", name, triangles, bench_median(limits, rounds),
                    bench_median(ours, rounds), bench_median(ratios, rounds));
    return true;
}

int bench_trace(const bench_options *options)
{
    static const char *const names[] = {"builtin:teapot-room", "hills:70000", "hills:1000000"};
    enum { SCENES = sizeof names / sizeof *names };
    bench_table table;
    bench_table_start(&table, "Building the acceleration structure, seconds", NULL,
                      "scene|triangles|limit|ours|ratio");
    bool good = true;
    for (int i = 0; i < (options->quick || options->scene != NULL ? 1 : SCENES) && good; i++) {
        good = run_scene(options->scene != NULL ? options->scene : names[i], options, &table);
    }
    if (good) {
        bench_table_print(&table, options);
    }
    return good ? 0 : 1;
}
