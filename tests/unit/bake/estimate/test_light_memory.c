// SPDX-License-Identifier: MIT
// Memory of a bake of light: known beforehand, and kept below a limit.
#include "bake/bake_memory.h"
#include "test_scenes.h"

#include <stdlib.h>
#include <string.h>

TEST(memory_of_light_is_known_beforehand)
{
    static const struct {
        const char *scene;
        uint32_t size;
        float error;
        alp_direct direct;
        bool denoise;
    } cases[] = {{"builtin:cornell", 128, 0.2f, ALP_DIRECT_ON, false},
                 {"builtin:cornell", 256, 0.0f, ALP_DIRECT_ON, false},
                 {"builtin:cornell", 256, 0.2f, ALP_DIRECT_APART, false},
                 {"builtin:furnace", 256, 0.2f, ALP_DIRECT_ON, false},
                 {"builtin:teapot-room", 256, 0.2f, ALP_DIRECT_ON, false},
                 {"builtin:cornell", 256, 0.2f, ALP_DIRECT_ON, true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_context *context = test_context(2);
        alp_scene *scene = test_load(context, cases[i].scene);
        const double loaded = (double)alp_context_peak_memory(context);
        alp_bake_options options = test_light_options(cases[i].size);
        options.light.samples = 32;
        options.light.error = cases[i].error;
        options.light.direct = cases[i].direct;
        options.light.denoise = cases[i].denoise;
        alp_bake_report report;
        alp_lightmap *lightmap = NULL;
        ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
        const double told = (double)alpi_bake_memory(&report.atlas, scene, &options);
        const double peak = (double)report.peak_memory_bytes - loaded;
        print_message("memory of light: %s %u: peak %.1f MiB, over told %.3f\n", cases[i].scene,
                      cases[i].size, peak / 0x1p20, peak / told);
        ASSERT_NEAR(peak / told, 1.0, 0.2); // blocks and pieces are a guess
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// The same bits, whether the rays of blocks are kept or traced every pass; never more than was
/// allowed; and what is not enough says what is.
TEST(memory_limit_is_kept)
{
    float *first = NULL;
    size_t size = 0;
    uint64_t fewest = 0; // rays, where all are kept
    int kept = 0, traced_again = 0, refused = 0;
    for (double limit = 6.0; limit > 1.0; limit *= 0.8) {
        alp_context *context = test_context(2);
        alp_scene *scene = test_load(context, "builtin:cornell");
        const double loaded = (double)alp_context_peak_memory(context);
        alp_bake_options options = test_light_options(128);
        options.light.samples = 256;
        options.sampling.memory_limit = (uint64_t)(limit * 0x1p20);
        alp_bake_report report;
        alp_lightmap *lightmap = NULL;
        const alp_result result = alp_bake(scene, &options, &lightmap, &report);
        if (result == ALP_ERROR_LIMIT) {
            assert_non_null(strstr(alp_context_message(context), "MiB"));
            refused++;
        } else {
            ASSERT_OK(context, result);
            const double peak = ((double)report.peak_memory_bytes - loaded) / 0x1p20;
            print_message("memory limit %.2f MiB: peak %.2f, %llu rays\n", limit, peak,
                          (unsigned long long)report.rays);
            assert_true(peak <= limit);
            uint32_t width, height;
            const float *page = alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, 0, &width, &height);
            if (first == NULL) {
                size = (size_t)4 * width * height * sizeof *first;
                first = malloc(size);
                assert_non_null(first);
                memcpy(first, page, size);
                fewest = report.rays;
            }
            assert_memory_equal(first, page, size);
            assert_true(report.rays >= fewest);
            *(report.rays == fewest ? &kept : &traced_again) += 1;
        }
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    free(first);
    assert_true(kept > 0 && traced_again > 0 && refused > 0);
}

/// With layers, which keep rays of every round, too.
TEST(memory_limit_is_kept_by_layers)
{
    uint64_t fewest = UINT64_MAX, most = 0; // rays: where all are kept, and where none are
    int refused = 0;
    for (double limit = 20.0; limit > 2.0; limit *= 0.6) {
        alp_context *context = test_context(2);
        alp_scene *scene = test_load(context, "builtin:cornell");
        const double loaded = (double)alp_context_peak_memory(context);
        alp_bake_options options = test_light_options(128);
        options.light.samples = 512;
        options.light.layers = true;
        options.sampling.memory_limit = (uint64_t)(limit * 0x1p20);
        alp_bake_report report;
        if (alp_bake(scene, &options, NULL, &report) == ALP_OK) {
            const double peak = ((double)report.peak_memory_bytes - loaded) / 0x1p20;
            print_message("memory limit %.2f MiB with layers: peak %.2f, %llu rays\n", limit, peak,
                          (unsigned long long)report.rays);
            assert_true(peak <= limit);
            fewest = report.rays < fewest ? report.rays : fewest;
            most = report.rays > most ? report.rays : most;
        } else {
            refused++;
        }
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    assert_true(fewest < most && refused > 0);
}
