// SPDX-License-Identifier: MIT
#include "checkpointed_bake.h"

#include "base/hash.h"
#include "base/memory.h"
#include "test_obj.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { LAMP_LIMIT = 20 };

// --- a host that stops in a loop -----------------------------------------------------------------

/// Progress is reported every 50 ms. A longer pause makes the range that follows be the last.
static const struct timespec PAUSE = {.tv_nsec = 55000000};
enum { PAUSE_EACH = 16 }; // some loops report none

typedef struct host {
    uint32_t ranges, first, stop_after;
    uint32_t traces; // reports of stages that trace rays
    bool stopped;
} host;

static void run_ranges(void *user, uint32_t count, uint32_t grain, alp_range_fn *body,
                       void *body_user)
{
    host *h = user;
    for (uint32_t begin = 0; begin < count; begin += grain) {
        const bool stops = h->stop_after > 0 && h->ranges >= h->stop_after && !h->stopped;
        if (stops && (h->ranges - h->stop_after) % PAUSE_EACH == 0) {
            nanosleep(&PAUSE, NULL);
        }
        h->ranges++;
        body(body_user, begin, count - begin < grain ? count : begin + grain, 0);
        if (count - begin <= grain) {
            break;
        }
    }
}

static bool goes_on(void *user, const alp_progress *progress)
{
    static const char *const traced[] = {"occlusion", "obscurance", "light", "probes"};
    host *h = user;
    bool before = true;
    for (size_t i = 0; i < sizeof traced / sizeof *traced; i++) {
        before = before && strcmp(progress->stage, traced[i]) != 0;
    }
    h->first = before && h->traces == 0 ? h->ranges : h->first;
    h->traces += before ? 0 : 1;
    h->stopped = h->stopped || (h->stop_after > 0 && h->ranges >= h->stop_after);
    return !h->stopped;
}

static alp_context *make_context(const checkpointed_bake *bake, host *h)
{
    alp_context_options options = alp_context_options_default();
    alp_context *context = NULL;
    if (bake->workers > 1) {
        return test_context(bake->workers);
    }
    options.worker_count = 1;
    options.parallel_for = run_ranges;
    options.parallel_user = h;
    assert_int_equal(alp_context_create(&options, &context), ALP_OK);
    return context;
}

// --- scenes and options --------------------------------------------------------------------------

/// A box of 4 m seen from inside with two-sided walls, and a red pane across its middle.
static const char panes[] =
    "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0,\"name\":\"walls\"},"
    "{\"mesh\":1,\"name\":\"pane\"}],\"materials\":[{\"doubleSided\":true,"
    "\"pbrMetallicRoughness\":{\"metallicFactor\":0}},{\"doubleSided\":true,"
    "\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"metallicFactor\":0,"
    "\"baseColorFactor\":[0.9,0.3,0.3,0.5]}}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":0}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":2},\"indices\":3,\"material\":1}]}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":96},{\"buffer\":0,\"byteOffset\":96,"
    "\"byteLength\":36},{\"buffer\":0,\"byteOffset\":132,\"byteLength\":48},"
    "{\"buffer\":0,\"byteOffset\":180,\"byteLength\":6}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":8,"
    "\"min\":[-2,-2,-2],\"max\":[2,2,2]},"
    "{\"bufferView\":1,\"componentType\":5121,\"type\":\"SCALAR\",\"count\":36},"
    "{\"bufferView\":2,\"componentType\":5126,\"type\":\"VEC3\",\"count\":4,"
    "\"min\":[-1,0,-1],\"max\":[1,0,1]},"
    "{\"bufferView\":3,\"componentType\":5121,\"type\":\"SCALAR\",\"count\":6}],"
    "\"buffers\":[{\"byteLength\":188,\"uri\":\"data:application/octet-stream;base64,"
    "AAAAwAAAAMAAAADAAAAAwAAAAMAAAABAAAAAwAAAAEAAAADAAAAAwAAAAEAAAABAAAAAQAAAAMAAAADA"
    "AAAAQAAAAMAAAABAAAAAQAAAAEAAAADAAAAAQAAAAEAAAABAAAIDAAMBBQcGBQYEAQUEAQQAAgYHAgcD"
    "AAQGAAYCAwcFAwUBAACAvwAAAAAAAIA/AACAPwAAAAAAAIA/AACAPwAAAAAAAIC/AACAvwAAAAAAAIC/"
    "AAECAAIDAAA="
    "\"}]}";

static alp_scene *load(alp_context *context, const char *name)
{
    if (name == NULL || strcmp(name, CHECKPOINTED_PANES) != 0) {
        return test_load(context, name != NULL ? name : "builtin:cornell");
    }
    const char *path = test_path(test_folder(), "panes.gltf");
    test_write_text(path, panes);
    return test_load(context, path);
}

/// @param lamps [LAMP_LIMIT], which the options point at
static alp_bake_options options_of(const checkpointed_bake *bake, alp_lamp *lamps)
{
    const checkpointed_kind *k = bake->kind;
    alp_bake_options o = alp_bake_options_default();
    o.atlas.size = k->size > 0 ? k->size : k->error > 0.0f ? 64 : 32;
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.maps = k->maps;
    o.occlusion.samples = k->error > 0.0f ? 256 : 8;
    o.sampling.accuracy = k->accuracy;
    o.sampling.error = k->error;
    o.ao_self = k->ao_self;
    o.only = k->only;
    o.light.samples = k->error > 0.0f ? 64 : 8;
    o.light.error = k->error / 10.0f;
    o.light.gather = k->gather;
    o.light.hemicube = 8;
    o.light.direct = k->direct;
    o.light.bounces = k->bounces;
    o.light.layers = k->layers;
    o.light.denoise = k->denoise;
    o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
    for (uint32_t i = 0; i < k->lamps; i++) {
        lamps[i] = alp_lamp_default();
        lamps[i].position[0] = 0.02f * (float)i - 0.2f;
        lamps[i].position[1] = 0.4f;
        lamps[i].intensity = 0.4f;
        lamps[i].color[1] = 0.5f;
    }
    o.light.lighting.lamps = lamps;
    o.light.lighting.lamp_count = k->lamps;
    o.checkpoint.folder = bake->folder;
    o.checkpoint.every = bake->every > 0.0 ? bake->every : o.checkpoint.every;
    o.progress = goes_on;
    return o;
}

// --- results -------------------------------------------------------------------------------------

/// Hashes the names and bytes of all files of a folder.
static uint64_t hash_files(const char *folder, size_t *largest)
{
    struct dirent **entries = NULL;
    uint64_t hash = ALPI_HASH_START;
    const int count = scandir(folder, &entries, NULL, alphasort);
    assert_true(count > 2);
    for (int i = 0; i < count; i++) {
        const char *path = test_path(folder, entries[i]->d_name);
        struct stat about;
        assert_int_equal(stat(path, &about), 0);
        if (S_ISREG(about.st_mode)) {
            size_t size;
            unsigned char *bytes = test_read_file(path, &size);
            hash = alpi_hash_bytes(hash, entries[i]->d_name, strlen(entries[i]->d_name));
            hash = alpi_hash_bytes(hash, bytes, size);
            *largest = size > *largest ? size : *largest;
            free(bytes);
        }
        free(entries[i]);
    }
    free((void *)entries);
    return hash;
}

alp_result checkpointed_run(checkpointed_bake *bake)
{
    alp_lamp lamps[LAMP_LIMIT];
    char maps[512];
    host h = {.stop_after = bake->stop_after};
    const long failing = bake->memory != NULL ? bake->memory->failing : -1;
    if (bake->memory != NULL) {
        bake->memory->failing = -1;
    }
    alp_context *context =
        bake->memory != NULL ? test_memory_context(bake->memory, 1) : make_context(bake, &h);
    alp_scene *scene = load(context, bake->kind->scene);
    alp_bake_options options = options_of(bake, lamps);
    alp_probe_options probes = alp_probe_options_default();
    probes.spacing = 0.3f;
    probes.rays = 384;
    snprintf(maps, sizeof maps, "%s/maps", test_folder());
    h.ranges = 0; // of the bake alone
    if (bake->memory != NULL) {
        atomic_store(&bake->memory->count, 0);
        bake->memory->failing = failing;
    }
    if (bake->budget > 0) {
        alpi_set_budget(context, (alpi_budget){.limit = alpi_memory_held(context) + bake->budget});
    }
    options.progress_user = &h;
    options.maps_folder = maps;
    options.probes = bake->kind->maps & ALP_MAP_PROBES ? &probes : NULL;
    bake->report = (alp_bake_report){.maps = 0};
    const alp_result result = alp_bake(scene, &options, NULL, &bake->report);
    assert_int_equal(access(maps, F_OK) == 0, result == ALP_OK);
    if (result == ALP_OK) {
        bake->files = hash_files(maps, &bake->largest);
    } else if (result != ALP_ERROR_CANCELLED) {
        snprintf(bake->message, sizeof bake->message, "%s", alp_context_message(context));
    }
    bake->first = h.first;
    bake->ranges = h.ranges;
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    if (bake->memory != NULL) {
        assert_int_equal(atomic_load(&bake->memory->live), 0);
    }
    return result;
}
