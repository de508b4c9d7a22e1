// SPDX-License-Identifier: MIT
// Runs benches: `alpenglow-bench [ROOM …] [--quick] [--markdown] [--pictures DIR]`. `alpenglow
// bench` starts this.
#include "bench.h"

#include <string.h>

static const struct {
    const char *name;
    bench_fn *run;
} benches[] = {
    {"trace", bench_trace},       {"transport", bench_transport},
    {"atlas", bench_atlas},       {"maps", bench_maps},
    {"accuracy", bench_accuracy}, {"truth", bench_against_truth},
    {"denoise", bench_denoise},   {"bounced", bench_bounced},
    {"light", bench_light},       {"sh", bench_sh},
    {"probes", bench_probes},     {"fields", bench_fields},
    {"ambience", bench_ambience}, {"lpv", bench_lpv},
    {"formats", bench_formats},
};
enum { BENCH_COUNT = sizeof benches / sizeof *benches, EXIT_USAGE = 2 };

/// Index of a bench, or −1.
static int find_bench(const char *name)
{
    for (int i = 0; i < BENCH_COUNT; i++) {
        if (strcmp(benches[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

int main(int count, char **words)
{
    if (count > 1 && strcmp(words[1], "measure-atlas") == 0) {
        return bench_measure_atlas(count - 2, words + 2);
    }
    if (count > 1 && strcmp(words[1], "record-tiles") == 0) {
        return bench_record_tiles(count - 2, words + 2);
    }
    bench_options options = {0};
    bool wanted[BENCH_COUNT] = {false}, any = false;
    for (int i = 1; i < count; i++) {
        const int bench = find_bench(words[i]);
        if (bench >= 0) {
            wanted[bench] = any = true;
        } else if (strcmp(words[i], "--quick") == 0) {
            options.quick = true;
        } else if (strcmp(words[i], "--markdown") == 0) {
            options.markdown = true;
        } else if (strcmp(words[i], "--scene") == 0 && i + 1 < count) {
            options.scene = words[++i];
        } else if (strcmp(words[i], "--pictures") == 0 && i + 1 < count) {
            options.pictures = words[++i];
        } else if (strcmp(words[i], "--technique") == 0 && i + 1 < count) {
            options.technique = words[++i];
        } else {
            fprintf(stderr,
                    "alpenglow bench: there is no '%s'; "
                    "trace, transport, atlas, maps, accuracy, truth, denoise, bounced, light, "
                    "sh, probes, fields, ambience, lpv, formats, --quick, "
                    "--markdown, --scene NAME, --pictures DIR, --technique NAME\n",
                    words[i]);
            return EXIT_USAGE;
        }
    }
    int code = 0;
    for (int i = 0; i < BENCH_COUNT && code == 0; i++) {
        code = wanted[i] || !any ? benches[i].run(&options) : 0;
    }
    return code;
}
