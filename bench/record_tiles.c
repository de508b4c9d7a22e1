// SPDX-License-Identifier: MIT
// Seconds of each tile of a bake, for scripts/replay_scale.py.
//   alpenglow-bench record-tiles SCENE FILE.csv [--size N] [--samples N] [--error E] [--light]
// The bake is rank 0 of two, whose other rank claims nothing. So it runs all tiles. Its calls come
// before each batch of blocks, after each tile and after each loop. One worker; CPU seconds, which
// other programs on the machine hardly change.
#include "bench.h"

#include <alpenglow/alpenglow.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RANKS = 2, EXIT_USAGE = 2 };

typedef struct recorder {
    FILE *file;
    bool in_loop;
    uint64_t loop;           // that runs
    uint64_t claimed[RANKS]; // blocks of each part
    uint64_t block;          // of the loop: the first that was claimed last
    double began;            // the tile that runs
    double ended;            // the loop before
    double between;          // seconds from that loop to this one
} recorder;

// --- calls between ranks -------------------------------------------------------------------------

static uint64_t claim(void *user, uint64_t loop, uint32_t part, uint64_t amount)
{
    recorder *r = user;
    if (!r->in_loop) {
        r->between = bench_thread_seconds() - r->ended;
        memset(r->claimed, 0, sizeof r->claimed);
        r->in_loop = true;
    }
    const uint64_t first = r->claimed[part];
    r->claimed[part] += amount;
    r->loop = loop;
    r->block = first * RANKS + part; // about its place: rows turn
    r->began = bench_thread_seconds();
    return first;
}

static void end_tile(void *user)
{
    recorder *r = user;
    fprintf(r->file, "%llu,%llu,%.9f,\n", (unsigned long long)r->loop, (unsigned long long)r->block,
            bench_thread_seconds() - r->began);
    r->began = bench_thread_seconds();
}

static bool exchange(void *user, const void *bytes, size_t size, alp_receive_fn *receive,
                     void *receiver)
{
    recorder *r = user;
    (void)bytes;
    (void)receive; // the other rank ran nothing
    (void)receiver;
    if (r->in_loop) {
        fprintf(r->file, "%llu,,%.9f,%zu\n", (unsigned long long)r->loop, r->between, size);
    }
    r->in_loop = false;
    r->ended = bench_thread_seconds();
    return true;
}

// --- the bake ------------------------------------------------------------------------------------

typedef struct wishes {
    const char *scene, *file;
    uint32_t size, samples;
    float error; // per cent; 0: one round
    bool light;
} wishes;

static bool read_wishes(int count, char **words, wishes *w)
{
    *w = (wishes){.size = 512, .samples = 256};
    for (int i = 0; i < count; i++) {
        const char *word = words[i], *value = i + 1 < count ? words[i + 1] : NULL;
        if (strcmp(word, "--light") == 0) {
            w->light = true;
            continue;
        }
        if (word[0] != '-' && (w->scene == NULL || w->file == NULL)) {
            *(w->scene == NULL ? &w->scene : &w->file) = word;
            continue;
        }
        if (strcmp(word, "--size") == 0 && value != NULL) {
            w->size = (uint32_t)strtoul(value, NULL, 10);
        } else if (strcmp(word, "--samples") == 0 && value != NULL) {
            w->samples = (uint32_t)strtoul(value, NULL, 10);
        } else if (strcmp(word, "--error") == 0 && value != NULL) {
            w->error = strtof(value, NULL);
        } else {
            fprintf(stderr, "alpenglow bench: record-tiles: '%s'?\n", word);
            return false;
        }
        i++;
    }
    if (w->file == NULL) {
        fputs("alpenglow bench: record-tiles: need SCENE and FILE.csv\n", stderr);
    }
    return w->file != NULL;
}

static alp_result bake(alp_context *context, const wishes *w, alp_bake_report *report)
{
    alp_scene *scene = NULL;
    alp_bake_options o = alp_bake_options_default();
    o.maps = w->light ? ALP_MAP_LIGHT : ALP_MAP_AO;
    o.atlas.size = w->size;
    o.occlusion.samples = w->samples;
    o.light.samples = w->samples;
    o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
    *(w->light ? &o.light.error : &o.sampling.error) = w->error / 100.0f;
    o.sampling.accuracy = w->error > 0.0f ? o.sampling.accuracy : ALP_ADAPTIVE_OFF;
    alp_result result = alp_scene_load(context, w->scene, &scene);
    if (result == ALP_OK) {
        result = alp_bake(scene, &o, NULL, report);
    }
    alp_scene_destroy(scene);
    return result;
}

/// The first line of the file is written last, over blanks.
static alp_result record(const wishes *w, recorder *r)
{
    enum { ROOM = 160 };
    alp_context *context = NULL;
    alp_bake_report report = {0};
    alp_ranks ranks = alp_ranks_default();
    ranks.count = RANKS;
    ranks.user = r;
    ranks.claim = claim;
    ranks.exchange = exchange;
    ranks.poll = end_tile;
    alp_context_options options = alp_context_options_default();
    options.worker_count = 1;
    options.ranks = &ranks;
    fprintf(r->file, "%*s\nloop,block,seconds,bytes\n", ROOM, "");
    alp_result result = alp_context_create(&options, &context);
    if (result == ALP_OK) {
        result = bake(context, w, &report);
    }
    if (result != ALP_OK) {
        fprintf(stderr, "alpenglow bench: %s\n",
                context != NULL ? alp_context_message(context) : alp_result_name(result));
    }
    alp_context_destroy(context);
    rewind(r->file);
    fprintf(r->file, "# %.80s, %s, texels %llu, error %g, samples %u", w->scene,
            w->light ? "light" : "occlusion",
            (unsigned long long)(w->light ? report.light_traced + report.light_interpolated
                                          : report.traced + report.interpolated),
            (double)w->error, w->samples);
    return result;
}

int bench_record_tiles(int count, char **words)
{
    wishes w;
    recorder r = {0};
    if (!read_wishes(count, words, &w)) {
        return EXIT_USAGE;
    }
    r.file = fopen(w.file, "w");
    if (r.file == NULL) {
        perror(w.file);
        return EXIT_FAILURE;
    }
    const alp_result result = record(&w, &r);
    const bool written = ferror(r.file) == 0;
    if (fclose(r.file) != 0 || !written) {
        perror(w.file);
        return EXIT_FAILURE;
    }
    return result == ALP_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
