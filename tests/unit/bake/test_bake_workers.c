// SPDX-License-Identifier: MIT
// Whole bakes of every kind, small: the same bits for any workers, and nothing for the thread
// sanitizer to report, which is too slow for the larger tests of each map.
#include "test_support.h"

#include <stdlib.h>

// More texels than a range of a loop holds, and where there are rounds than one of a sum.
enum { SIZE = 40, SIZE_OF_ROUNDS = 80, LAMP_LIMIT = 20 };

typedef struct bake_kind {
    const char *name, *scene;
    unsigned maps;
    float accuracy, error; // error: of occlusion, and of light a tenth
    bool ao_self, layers, denoise;
    alp_gather gather;
    alp_direct direct;
    uint32_t bounces, lamps;
    uint32_t size; // or 0
} bake_kind;

#define OCCLUSION (ALP_MAP_AO | ALP_MAP_BENT)
#define BY_DIRECTION (ALP_MAP_LIGHT | ALP_MAP_SH | ALP_MAP_DIRECTION)

static const bake_kind kinds[] = {
    {.name = "occlusion in rounds",
     .scene = "builtin:cornell",
     .maps = OCCLUSION | ALP_MAP_OBSCURANCE,
     .accuracy = ALP_ADAPTIVE_AUTO,
     .error = 0.005f},
    {.name = "objects alone",
     .scene = "builtin:cornell",
     .maps = OCCLUSION | ALP_MAP_OBSCURANCE,
     .ao_self = true},
    {.name = "light in rounds",
     .scene = "builtin:cornell",
     .maps = BY_DIRECTION | ALP_MAP_AO,
     .accuracy = ALP_ADAPTIVE_AUTO,
     .error = 0.5f,
     .direct = ALP_DIRECT_APART,
     .bounces = ALP_BOUNCES_CONVERGE,
     .lamps = 1},
    {.name = "layers",
     .scene = "builtin:cornell",
     .maps = BY_DIRECTION,
     .accuracy = ALP_ADAPTIVE_AUTO,
     .error = 0.5f,
     .layers = true,
     .bounces = 2,
     .lamps = 2},
    {.name = "layers after a trial, as there are texels enough",
     .scene = "builtin:cornell",
     .maps = BY_DIRECTION,
     .accuracy = ALP_ADAPTIVE_AUTO,
     .error = 0.2f,
     .layers = true,
     .bounces = ALP_BOUNCES_CONVERGE,
     .lamps = 1,
     .size = 128},
    {.name = "denoised",
     .scene = "builtin:sphere-plane", // under the sky alone: is it a closed room?
     .maps = ALP_MAP_LIGHT,
     .denoise = true,
     .bounces = 2},
    {.name = "hemicubes",
     .scene = "builtin:cornell",
     .maps = BY_DIRECTION,
     .gather = ALP_GATHER_HEMICUBE,
     .bounces = 2},
    {.name = "paths",
     .scene = "builtin:cornell",
     .maps = ALP_MAP_LIGHT,
     .gather = ALP_GATHER_PATHS,
     .bounces = 2},
    {.name = "direct light", .scene = "builtin:cornell", .maps = BY_DIRECTION, .lamps = LAMP_LIMIT},
};

static uint32_t size_of(const bake_kind *kind)
{
    return kind->size > 0 ? kind->size : kind->error > 0.0f ? SIZE_OF_ROUNDS : SIZE;
}

/// @param lamps [LAMP_LIMIT], which the options point at
static alp_bake_options options_of(const bake_kind *kind, alp_lamp *lamps)
{
    alp_bake_options o = alp_bake_options_default();
    o.atlas.size = size_of(kind);
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.maps = kind->maps;
    o.occlusion.samples = kind->error > 0.0f ? 512 : 16;
    o.sampling.accuracy = kind->accuracy;
    o.sampling.error = kind->error;
    o.ao_self = kind->ao_self;
    o.light.samples = kind->error > 0.0f ? 64 : 16;
    o.light.error = kind->error / 10.0f;
    o.light.gather = kind->gather;
    o.light.hemicube = 8;
    o.light.direct = kind->direct;
    o.light.bounces = kind->bounces;
    o.light.layers = kind->layers;
    o.light.denoise = kind->denoise;
    o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
    for (uint32_t i = 0; i < kind->lamps; i++) {
        lamps[i] = alp_lamp_default();
        lamps[i].position[0] = 0.02f * (float)i - 0.2f;
        lamps[i].intensity = 0.4f;
        lamps[i].color[1] = 0.5f;
    }
    o.light.lighting.lamps = lamps;
    o.light.lighting.lamp_count = kind->lamps;
    return o;
}

/// @return how many there are
static uint32_t pages_of(const alp_lightmap *l, const float *pages[24])
{
    uint32_t count = 0;
    for (uint32_t map = ALP_MAP_AO; map <= ALP_MAP_DIRECTION; map *= 2) {
        pages[count++] = alp_lightmap_map_page(l, (alp_map)map, 0, NULL, NULL);
    }
    for (uint32_t i = 0; i < 4; i++) {
        pages[count++] = alp_lightmap_sh_page(l, i, 0, NULL, NULL);
    }
    for (uint32_t i = 0; i < alp_lightmap_layer_count(l); i++) {
        pages[count++] = alp_lightmap_layer_page(l, i, 0, NULL, NULL);
    }
    return count;
}

/// @return of how many pages
static uint32_t check_same(const alp_lightmap *a, const alp_lightmap *b, uint32_t size)
{
    const float *pages_a[24], *pages_b[24];
    const uint32_t count = pages_of(a, pages_a);
    uint32_t made = 0;
    assert_int_equal(count, pages_of(b, pages_b));
    for (uint32_t i = 0; i < count; i++) {
        assert_true((pages_a[i] == NULL) == (pages_b[i] == NULL));
        if (pages_a[i] != NULL) {
            assert_memory_equal(pages_a[i], pages_b[i], sizeof(float) * 4 * size * size);
            made++;
        }
    }
    return made;
}

TEST(workers_change_no_bit)
{
    enum { WAYS = 3 };
    const int ways = test_is_quick() ? 1 : WAYS; // a sanitizer finds races in one
    static const uint32_t workers[] = {7, 2, 1};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        alp_context *contexts[WAYS];
        alp_scene *scenes[WAYS];
        alp_lightmap *lightmaps[WAYS];
        alp_lamp lamps[LAMP_LIMIT];
        const alp_bake_options options = options_of(&kinds[k], lamps);
        uint32_t pages = 0;
        for (int w = 0; w < ways; w++) {
            contexts[w] = test_context(workers[w]);
            ASSERT_OK(contexts[w], alp_scene_load(contexts[w], kinds[k].scene, &scenes[w]));
            ASSERT_OK(contexts[w], alp_bake(scenes[w], &options, &lightmaps[w], NULL));
            pages = check_same(lightmaps[0], lightmaps[w], size_of(&kinds[k]));
        }
        print_message("%s: %u pages\n", kinds[k].name, pages);
        assert_true(pages > 0);
        for (int w = 0; w < ways; w++) {
            alp_lightmap_destroy(lightmaps[w]);
            alp_scene_destroy(scenes[w]);
            alp_context_destroy(contexts[w]);
        }
    }
}

TEST(workers_change_no_vertex)
{
    static const uint32_t workers[] = {1, 2, 7};
    float *first = NULL;
    for (int w = 0; w < 3; w++) {
        alp_context *context = test_context(workers[w]);
        alp_scene *scene = test_load(context, "builtin:torus-plane");
        alp_bake_options options = alp_bake_options_default();
        options.atlas.mode = ALP_ATLAS_VERTEX;
        options.occlusion.samples = 8;
        alp_lightmap *lightmap = NULL;
        ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
        uint32_t count = 0;
        const float *values = alp_lightmap_vertex_values(lightmap, 0, &count);
        assert_true(values != NULL && count > 0);
        if (first == NULL) {
            first = malloc(((size_t)count + 1) * sizeof *first);
            assert_non_null(first);
            memcpy(first, values, count * sizeof *first);
        }
        assert_memory_equal(first, values, count * sizeof *first);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    free(first);
}
