// SPDX-License-Identifier: MIT
// A bake keeps within its memory limit or fails with the stage and what to do; whatever the limit,
// a bake that succeeds gives the same bits. The large arrays are forecast.
#include "bake/bake_memory.h"
#include "test_scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct limit_case {
    const char *scene;
    uint32_t size; // of the page
    unsigned maps;
    float error;
    alp_direct direct;
    bool sky, counted, denoise, layers, written;
    alp_lightmap_as as;
} limit_case;

static const limit_case cases[] = {
    {.scene = "builtin:furnace", .size = 256, .maps = ALP_MAP_AO},
    {.scene = "builtin:furnace",
     .size = 256,
     .maps = ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_OBSCURANCE,
     .written = true},
    {.scene = "builtin:cornell", .size = 128, .maps = ALP_MAP_LIGHT},
    {.scene = "builtin:cornell",
     .size = 128,
     .maps = ALP_MAP_LIGHT,
     .error = 0.2f,
     .sky = true,
     .written = true},
    {.scene = "builtin:cornell",
     .size = 128,
     .maps = ALP_MAP_LIGHT | ALP_MAP_AO,
     .error = 0.2f,
     .direct = ALP_DIRECT_APART},
    {.scene = "builtin:teapot-room", .size = 192, .maps = ALP_MAP_LIGHT, .error = 0.2f},
    {.scene = "builtin:cornell", .size = 64, .maps = ALP_MAP_LIGHT, .counted = true},
    {.scene = "builtin:cornell",
     .size = 128,
     .maps = ALP_MAP_LIGHT | ALP_MAP_SH | ALP_MAP_DIRECTION},
    {.scene = "builtin:cornell",
     .size = 128,
     .maps = ALP_MAP_LIGHT,
     .error = 0.2f,
     .denoise = true},
    {.scene = "builtin:windows", .size = 128, .maps = ALP_MAP_LIGHT, .layers = true, .sky = true},
    {.scene = "builtin:cornell", .size = 256, .maps = ALP_MAP_LIGHT, .as = ALP_LIGHTMAP_AS_THREE},
};
enum { CASES = sizeof cases / sizeof *cases };

static alp_bake_options options_of(const limit_case *c)
{
    alp_bake_options o = alp_bake_options_default();
    o.atlas.size = c->size;
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.maps = c->maps;
    o.occlusion.samples = 16;
    o.light.samples = 8;
    o.light.error = c->error;
    o.light.direct = c->direct;
    o.light.denoise = c->denoise;
    o.light.layers = c->layers;
    o.lightmap_as = c->as;
    o.output = c->as == ALP_LIGHTMAP_AS_THREE ? test_path(test_folder(), "a.json") : NULL;
    o.maps_folder = c->written ? test_folder() : NULL;
    o.overwrite = true;
    if (c->counted) {
        o.light.gather = ALP_GATHER_HEMICUBE;
        o.light.emitters = ALP_EMITTERS_COUNTED;
        o.light.hemicube = 8;
        o.light.bounces = 1; // hemicubes are slow
    }
    if (c->sky) {
        o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
        vec3_store(o.light.lighting.sky.up, (vec3){1.0f, 1.0f, 1.0f});
    }
    return o;
}

/// What a bake came to.
typedef struct limited_bake {
    alp_result result;
    char message[512];
    uint64_t peak, rays, forecast; // bytes beside the scene
    size_t size;
    float *page; // of light, else of occlusion; released by the caller
} limited_bake;

static void bake_within(const char *scene_name, alp_bake_options options, uint64_t limit,
                        uint32_t workers, limited_bake *b)
{
    *b = (limited_bake){.result = ALP_OK};
    alp_context *context = test_context(workers);
    alp_scene *scene = NULL;
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    ASSERT_OK(context, alp_scene_load(context, scene_name, &scene));
    const uint64_t loaded = alp_context_peak_memory(context), held = alpi_memory_held(context);
    options.sampling.memory_limit = limit;
    b->result = alp_bake(scene, &options, &lightmap, &report);
    strncpy(b->message, alp_context_message(context), sizeof b->message - 1);
    assert_int_equal(alpi_memory_left(context), UINT64_MAX); // the budget was the bake's alone
    if (b->result == ALP_OK) {
        const bool light = (options.maps & ALP_MAP_LIGHT) != 0;
        const alpi_bake_job job = {.scene = scene, .context = context, .options = options};
        uint32_t width, height;
        const float *page =
            alp_lightmap_map_page(lightmap, light ? ALP_MAP_LIGHT : ALP_MAP_AO, 0, &width, &height);
        b->size = (size_t)4 * width * height * sizeof *page;
        b->page = malloc(b->size);
        assert_non_null(b->page);
        memcpy(b->page, page, b->size);
        b->peak = alp_context_peak_memory(context);
        b->peak -= b->peak > loaded ? held : b->peak;
        b->rays = report.rays;
        b->forecast = alpi_bake_forecast_memory(&job, &report.atlas).bytes;
    }
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

static void check_refusal(const limited_bake *b)
{
    assert_int_equal(b->result, ALP_ERROR_LIMIT);
    assert_non_null(strstr(b->message, "stage \""));
    assert_non_null(strstr(b->message, "--memory-limit "));
    assert_non_null(strstr(b->message, "MiB"));
    assert_non_null(strstr(b->message, "raise the limit"));
}

TEST(the_measured_peak_is_enough_and_half_of_it_is_not)
{
    for (size_t i = 0; i < CASES; i++) {
        const alp_bake_options options = options_of(&cases[i]);
        limited_bake open, tight, half;
        bake_within(cases[i].scene, options, 0, 2, &open);
        assert_int_equal(open.result, ALP_OK);
        bake_within(cases[i].scene, options, open.peak + open.peak / 50, 2, &tight);
        // Rays of hemicubes are most of the peak, and are traced again instead.
        bake_within(cases[i].scene, options, open.peak / (cases[i].counted ? 8 : 2), 2, &half);
        print_message("%s: peak %.2f MiB; half of it: %s\n", cases[i].scene,
                      (double)open.peak / 0x1p20, half.message);
        assert_int_equal(tight.result, ALP_OK);
        assert_true(tight.peak <= open.peak + open.peak / 50);
        assert_memory_equal(tight.page, open.page, open.size);
        check_refusal(&half);
        free(open.page);
        free(tight.page);
    }
}

/// From above the peak down: once a limit is too low, all lower ones are. Every bake that succeeds
/// holds no more than it may and gives the same bits, whether rays of blocks were kept or traced
/// again, and by any number of workers.
static void lower_and_lower(const limit_case *c)
{
    static const double shares[] = {1.3, 1.1, 1.0, 0.9, 0.8, 0.7, 0.5, 0.3};
    alp_bake_options options = options_of(c);
    options.light.samples = 64;
    options.light.bounces = c->counted ? 1 : 2;
    limited_bake open;
    bake_within(c->scene, options, 0, 2, &open);
    assert_int_equal(open.result, ALP_OK);
    int kept = 0, traced_again = 0, refused = 0;
    double least = 0.0;
    for (size_t i = 0; i < sizeof shares / sizeof *shares; i++) {
        const uint64_t limit = (uint64_t)(shares[i] * (double)open.peak);
        limited_bake b;
        bake_within(c->scene, options, limit, 1 + (uint32_t)i % 2, &b);
        if (b.result == ALP_OK) {
            assert_int_equal(refused, 0);
            assert_true(b.peak <= limit);
            assert_memory_equal(b.page, open.page, open.size);
            assert_true(b.rays >= open.rays);
            *(b.rays == open.rays ? &kept : &traced_again) += 1;
            least = shares[i];
        } else {
            check_refusal(&b);
            refused++;
        }
        free(b.page);
    }
    print_message("%s: peak %.2f MiB, %.2f of it is enough: %d bakes kept their rays, %d traced "
                  "them again\n",
                  c->scene, (double)open.peak / 0x1p20, least, kept, traced_again);
    assert_true(kept > 0 && traced_again > 0 && (refused > 0 || c->counted));
    free(open.page);
}

TEST(rays_are_kept_in_what_the_budget_leaves)
{
    static const limit_case
        one_sided = {.scene = "builtin:cornell", .size = 64, .maps = ALP_MAP_LIGHT},
        two_sided = {.scene = "builtin:teapot-room", .size = 96, .maps = ALP_MAP_LIGHT},
        counted = {.scene = "builtin:teapot-room",
                   .size = 64,
                   .maps = ALP_MAP_LIGHT,
                   .counted = true},
        layers = {.scene = "builtin:cornell", .size = 64, .maps = ALP_MAP_LIGHT, .layers = true};
    lower_and_lower(&one_sided);
    lower_and_lower(&two_sided);
    lower_and_lower(&counted);
    lower_and_lower(&layers);
}

/// Small arrays and kept rays come on top of the forecast.
TEST(large_arrays_are_forecast)
{
    for (size_t i = 0; i < CASES; i++) {
        if (cases[i].counted) {
            continue; // its kept rays are most of the peak
        }
        const uint32_t sizes = i % 3 == 0 ? 2 : 1; // three at twice the size too
        for (uint32_t times = 1; times <= sizes; times++) {
            alp_bake_options options = options_of(&cases[i]);
            options.atlas.size *= times;
            options.light.layers = false; // their number is known to the job alone
            limited_bake b;
            bake_within(cases[i].scene, options, 0, 2, &b);
            assert_int_equal(b.result, ALP_OK);
            const double over = (double)b.peak / (double)b.forecast;
            print_message("%s %u, maps %u: peak %.2f MiB, %.2f of the forecast\n", cases[i].scene,
                          options.atlas.size, options.maps, (double)b.peak / 0x1p20, over);
            assert_true(over > 1.0 && over < 2.0);
            free(b.page);
        }
    }
}

static bool note_stage(void *user, const alp_progress *progress)
{
    bool *seen = user;
    *seen = *seen || strcmp(progress->stage, "build") == 0;
    return true;
}

TEST(a_hopeless_bake_fails_before_its_rays)
{
    bool built = false;
    limited_bake b;
    alp_bake_options options = options_of(&cases[2]);
    options.atlas.size = 512;
    options.progress = note_stage;
    options.progress_user = &built;
    options.maps_folder = test_path(test_folder(), "maps");
    bake_within("builtin:cornell", options, 1 << 20, 2, &b);
    check_refusal(&b);
    bake_within("builtin:cornell", options, 24 << 20, 2, &b);
    check_refusal(&b);
    assert_non_null(strstr(b.message, "stage \"light\" would need about"));
    assert_false(built);
    assert_int_not_equal(access(options.maps_folder, F_OK), 0);

    // A page that no machine holds is refused without a limit of the user's.
    alp_context *context = test_context(1);
    alp_scene *scene = test_load(context, "builtin:furnace");
    alpi_bake_job job = {.scene = scene, .context = context, .options = options_of(&cases[0])};
    const alp_atlas_info huge = {
        .pages = 4096, .width = 16384, .height = 16384, .texels = 1ull << 40};
    const alp_atlas_info small = {.pages = 1, .width = 64, .height = 64, .texels = 4096};
    alpi_bake_begin_budget(&job);
    assert_int_equal(alpi_bake_check_memory(&job, &huge), ALP_ERROR_LIMIT);
    assert_non_null(strstr(alp_context_message(context), "nine tenths of the machine's memory"));
    ASSERT_OK(context, alpi_bake_check_memory(&job, &small));
    assert_int_equal(alpi_bake_end_budget(&job, ALP_ERROR_OUT_OF_MEMORY), ALP_ERROR_OUT_OF_MEMORY);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}
