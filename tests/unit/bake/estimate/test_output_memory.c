// SPDX-License-Identifier: MIT
// What is told before the work: memory, also of outputs that take more of it than what
// they are made from, viewers' own files and layers.
#include "bake/bake_memory.h"
#include "bake/job.h"
#include "test_scenes.h"

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
TEST(memory_of_viewers_files_is_known_beforehand)
{
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
TEST(memory_of_layers_is_estimated)
{
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
