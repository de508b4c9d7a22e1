// SPDX-License-Identifier: MIT
// What is told before the work: rays and memory, also of outputs that take more of it than what
// they are made from, viewers' own files and layers.
#include "bake/bake_memory.h"
#include "test_scenes.h"

#include <math.h>
#include <stdio.h>

static alp_bake_options light_options(uint32_t size)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = size;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.maps = ALP_MAP_LIGHT;
    options.light.samples = 32;
    options.overwrite = true;
    return options;
}

/// Bytes of ours that a bake of a scene took at its peak, the scene apart.
static double find_peak(alp_context *context, const alp_scene *scene,
                        const alp_bake_options *options, alp_bake_report *report)
{
    const double loaded = (double)alp_context_peak_memory(context);
    ASSERT_OK(context, alp_bake(scene, options, NULL, report));
    return (double)report->peak_memory_bytes - loaded;
}

/// The text of all pages as numbers is more than light takes while it is gathered.
static void memory_of_viewers_files_is_known_beforehand(void **state)
{
    (void)state;
    static const struct {
        const char *scene;
        uint32_t size;
        alp_lightmap_as as;
    } cases[] = {{"builtin:cornell", 128, ALP_LIGHTMAP_AS_THREE},
                 {"builtin:cornell", 512, ALP_LIGHTMAP_AS_THREE},
                 {"builtin:teapot-room", 256, ALP_LIGHTMAP_AS_THREE},
                 {"builtin:windows", 512, ALP_LIGHTMAP_AS_THREE},
                 {"builtin:cornell", 512, ALP_LIGHTMAP_AS_BABYLON},
                 {"builtin:teapot-room", 256, ALP_LIGHTMAP_AS_BABYLON}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const bool three = cases[i].as == ALP_LIGHTMAP_AS_THREE;
        alp_context *context = test_context(2);
        alp_scene *scene = NULL;
        alp_bake_report report;
        ASSERT_OK(context, alp_scene_load(context, cases[i].scene, &scene));
        alp_bake_options options = light_options(cases[i].size);
        options.light.bounces = 0; // the least that light takes
        options.lightmap_as = cases[i].as;
        options.output = test_path(test_folder(), three ? "a.json" : "a.babylon");
        const double peak = find_peak(context, scene, &options, &report);
        const double told = (double)alpi_bake_memory(&report.atlas, scene, &options);
        print_message("memory of %s: %s %u: peak %.1f MiB, over told %.3f\n",
                      three ? "three.js" : "Babylon.js", cases[i].scene, cases[i].size,
                      peak / 0x1p20, peak / told);
        ASSERT_NEAR(peak / told, 1.0, 0.2); // digits of numbers are a guess
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// What is told before the work holds the layers too.
static void memory_of_layers_is_estimated(void **state)
{
    (void)state;
    double told[2], peaks[2];
    for (int layers = 0; layers < 2; layers++) {
        alp_context *context = test_context(2);
        alp_scene *scene = NULL;
        alp_bake_work work;
        alp_bake_report report;
        ASSERT_OK(context, alp_scene_load(context, "builtin:windows", &scene));
        alp_bake_options options = light_options(256);
        options.light.bounces = 1;
        options.light.layers = layers != 0;
        options.light.lighting.sky.kind = ALP_SKY_CONSTANT;
        ASSERT_OK(context, alp_bake_estimate(scene, &options, &work));
        told[layers] = (double)work.bytes;
        peaks[layers] = find_peak(context, scene, &options, &report);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    print_message("memory of layers: told %.1f MiB, %.1f without; peak %.1f, %.1f without\n",
                  told[1] / 0x1p20, told[0] / 0x1p20, peaks[1] / 0x1p20, peaks[0] / 0x1p20);
    ASSERT_NEAR(peaks[1] / told[1], 1.0, 0.3);                          // the atlas is a guess too
    ASSERT_NEAR((peaks[1] - peaks[0]) / (told[1] - told[0]), 1.0, 0.4); // so are blocks
}

/// Rays and memory within a half of what they will be, in the mean over seeds where light is for an
/// error: its last round is a quarter of all rays, and chance whether it is needed. An even sky is
/// told two to three times as many, as it is less noise to a texel's rays than to the paths of a
/// pilot (25 times, before what lamps bring to these was left out). Seconds are the machine's.
static void work_is_known_within_a_half(void **state)
{
    (void)state;
    static const struct {
        const char *scene;
        uint32_t size;
        unsigned maps;
        float error;
        bool sky; // beside the scene's own light
    } cases[] = {{"builtin:cornell", 256, ALP_MAP_AO, 0.0f, false},
                 {"builtin:cornell", 512, ALP_MAP_AO, 0.0f, false},
                 {"builtin:teapot-room", 256, ALP_MAP_AO, 0.0f, false},
                 {"builtin:windows", 256, ALP_MAP_AO, 0.0f, false},
                 {"builtin:terrain", 256, ALP_MAP_AO, 0.0f, false},
                 {"builtin:cornell", 256, ALP_MAP_AO, 0.01f, false},
                 {"builtin:teapot-room", 256, ALP_MAP_AO, 0.015f, false},
                 {"builtin:torus-plane", 512, ALP_MAP_AO, 0.01f, false},
                 {"builtin:cornell", 256, ALP_MAP_LIGHT, 0.01f, false},
                 {"builtin:cornell", 512, ALP_MAP_LIGHT, 0.02f, false},
                 {"builtin:teapot-room", 256, ALP_MAP_LIGHT, 0.01f, false},
                 {"builtin:cornell", 256, ALP_MAP_LIGHT, 0.01f, true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_context *context = test_context(2);
        alp_scene *scene = NULL;
        alp_bake_work work;
        alp_bake_report report = {0};
        ASSERT_OK(context, alp_scene_load(context, cases[i].scene, &scene));
        alp_bake_options options = alp_bake_options_default();
        options.atlas.size = cases[i].size;
        options.maps = cases[i].maps;
        options.occlusion.samples = cases[i].error > 0.0f ? 65536 : 512;
        options.light.error = options.sampling.error = cases[i].error;
        options.light.lighting.sky.kind = cases[i].sky ? ALP_SKY_CONSTANT : ALP_SKY_NONE;
        ASSERT_OK(context, alp_bake_estimate(scene, &options, &work));
        const int seeds = cases[i].maps == ALP_MAP_LIGHT ? 2 : 1;
        double peak = 0.0, sent = 0.0;
        for (int k = 0; k < seeds; k++) {
            options.occlusion.seed = (uint64_t)k;
            peak = fmax(peak, find_peak(context, scene, &options, &report)); // of the first
            sent += (double)report.rays / seeds;
        }
        const double rays = (double)work.rays / sent;
        print_message("work: %s %u, maps %u: texels %.2f, rays %.2f, bytes %.2f of the truth\n",
                      cases[i].scene, cases[i].size, cases[i].maps,
                      (double)work.texels / (double)report.atlas.texels, rays,
                      (double)work.bytes / peak);
        assert_true(rays > 0.5 && rays < (cases[i].sky ? 4.0 : 1.5));
        ASSERT_NEAR((double)work.bytes / peak, 1.0, 0.5);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// An estimate is of what is asked for: finite, and as much more as there is to do.
static void estimates_follow_the_options(void **state)
{
    (void)state;
    alp_context *context = test_context(2);
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_load(context, "builtin:cornell", &scene));
    alp_bake_options plain = alp_bake_options_default();
    plain.atlas.size = 128;
    plain.maps = ALP_MAP_LIGHT;
    plain.light.error = 0.02f;
    enum { PLAIN, SKY_ALONE, PATHS, ONLY, OCCLUDERS, LIMITED, OPTIONS };
    alp_bake_options options[OPTIONS];
    alp_bake_work work[OPTIONS];
    for (int i = 0; i < OPTIONS; i++) {
        options[i] = plain;
    }
    options[SKY_ALONE].light.lighting.sky.kind = ALP_SKY_CONSTANT;
    options[SKY_ALONE].light.bounces = 0;
    options[SKY_ALONE].light.error = 0.0f;
    options[SKY_ALONE].light.samples = 256;
    options[PATHS].light.gather = ALP_GATHER_PATHS;
    options[PATHS].light.error = 0.0f;
    options[PATHS].light.samples = 64;
    options[ONLY].only = "*block*";
    options[OCCLUDERS].maps = ALP_MAP_AO; // light has no chosen occluders
    options[OCCLUDERS].occluders = "*block*";
    options[LIMITED].sampling.time_limit = 1e-3;
    for (int i = 0; i < OPTIONS; i++) {
        ASSERT_OK(context, alp_bake_estimate(scene, &options[i], &work[i]));
        assert_true(isfinite(work[i].seconds) && work[i].seconds > 0.0);
    }
    const double texels = (double)work[PLAIN].texels;
    // Each sample asks the sky and the lamp, whose rays above the horizon count.
    assert_true((double)work[SKY_ALONE].rays > 200.0 * texels);
    ASSERT_NEAR((double)work[PATHS].rays / texels, 64.0, 1e-3);
    assert_true(work[LIMITED].seconds < work[PLAIN].seconds);
    assert_true(work[LIMITED].rays < work[PLAIN].rays);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_of_viewers_files_is_known_beforehand),
        cmocka_unit_test(memory_of_layers_is_estimated),
        cmocka_unit_test(work_is_known_within_a_half),
        cmocka_unit_test(estimates_follow_the_options),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
