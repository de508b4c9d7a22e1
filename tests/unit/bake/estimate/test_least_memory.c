// SPDX-License-Identifier: MIT
// The least memory of a bake of light: a bake that is refused says what would do, that does, the
// same bits come of it, and it is little.
#include "bake/bake_memory.h"
#include "test_scenes.h"

#include <stdlib.h>
#include <string.h>

typedef struct least_case {
    const char *scene;
    unsigned maps;
    float error;
    alp_direct direct;
    bool sky, counted, written;
    double most;   // bytes of a texel: a twentieth above what it is
    uint32_t size; // of the page
} least_case;

/// What a bake came to.
typedef struct least_bake {
    alp_result result;
    char message[512];
    double peak, texels; // bytes beside the scene
    size_t size;
    float *page; // irradiance; released by the caller
} least_bake;

static void bake_within(const least_case *c, double limit, least_bake *b)
{
    *b = (least_bake){.result = ALP_OK};
    alp_context *context = test_context(2);
    alp_scene *scene = NULL;
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_scene_load(context, c->scene, &scene));
    const double loaded = (double)alp_context_peak_memory(context);
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = c->size;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.maps = c->maps;
    options.occlusion.samples = 16;
    options.light.samples = 8;
    options.light.error = c->error;
    options.light.direct = c->direct;
    if (c->counted) {
        options.light.gather = ALP_GATHER_HEMICUBE;
        options.light.emitters = ALP_EMITTERS_COUNTED;
        options.light.hemicube = 8;
        options.light.bounces = 1; // hemicubes are slow
    }
    if (c->sky) {
        options.light.lighting.sky.kind = ALP_SKY_CONSTANT;
        vec3_store(options.light.lighting.sky.up, (vec3){1.0f, 1.0f, 1.0f});
    }
    options.maps_folder = c->written ? test_folder() : NULL;
    options.overwrite = true;
    options.sampling.memory_limit = (uint64_t)limit;
    alp_bake_report report;
    b->result = alp_bake(scene, &options, &lightmap, &report);
    strncpy(b->message, alp_context_message(context), sizeof b->message - 1);
    if (b->result == ALP_OK) {
        uint32_t width, height;
        const float *page = alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, 0, &width, &height);
        b->size = (size_t)4 * width * height * sizeof *page;
        b->page = malloc(b->size);
        assert_non_null(b->page);
        memcpy(b->page, page, b->size);
        b->peak = (double)report.peak_memory_bytes - loaded;
        b->texels = (double)report.atlas.texels;
    }
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

/// MiB that a refused bake says it needs.
static double told_need(const least_bake *b)
{
    assert_int_equal(b->result, ALP_ERROR_LIMIT);
    const char *need = strstr(b->message, "need ");
    assert_non_null(need);
    return strtod(need + strlen("need "), NULL);
}

TEST(what_is_told_to_do_does)
{
    const least_case cases[] = {
        {"builtin:cornell", ALP_MAP_LIGHT, 0.04f, ALP_DIRECT_ON, false, false, false, 253.0, 192},
        {"builtin:cornell", ALP_MAP_LIGHT, 0.0f, ALP_DIRECT_ON, false, false, false, 191.0, 192},
        {"builtin:cornell", ALP_MAP_LIGHT, 0.2f, ALP_DIRECT_ON, true, false, true, 279.0, 192},
        {"builtin:cornell", ALP_MAP_LIGHT | ALP_MAP_AO, 0.2f, ALP_DIRECT_APART, false, false, true,
         287.0, 192},
        {"builtin:teapot-room", ALP_MAP_LIGHT, 0.2f, ALP_DIRECT_ON, false, false, false, 294.0,
         192},
        {"builtin:cornell", ALP_MAP_LIGHT, 0.0f, ALP_DIRECT_ON, false, true, false, 216.0, 192},
        // So many texels to a face that what they share is kept.
        {"builtin:windows", ALP_MAP_LIGHT, 0.0f, ALP_DIRECT_ON, false, false, false, 221.0, 264},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        least_bake free_one, refused, least, below;
        bake_within(&cases[i], 0.0, &free_one);
        assert_int_equal(free_one.result, ALP_OK);
        bake_within(&cases[i], 1.0, &refused);
        const double need = told_need(&refused) * 0x1p20;
        bake_within(&cases[i], need, &least);
        print_message("%s: %.1f MiB would do, %.1f a texel; peak %.3f of it, %.3f without limit\n",
                      cases[i].scene, need / 0x1p20, need / free_one.texels, least.peak / need,
                      free_one.peak / need);
        assert_int_equal(least.result, ALP_OK);
        assert_true(least.peak <= need);
        assert_true(need < cases[i].most * free_one.texels);
        assert_memory_equal(least.page, free_one.page, least.size);
        bake_within(&cases[i], 0.98 * need, &below);
        assert_true(told_need(&below) * 0x1p20 == need);
        free(free_one.page);
        free(refused.page);
        free(least.page);
        free(below.page);
    }
}
