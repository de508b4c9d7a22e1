// SPDX-License-Identifier: MIT
// Estimates of a bake's work: close to what the bake then takes, without a ray traced for them.
#include "test_scenes.h"

typedef struct estimate_case {
    const char *scene;
    uint32_t size;
    unsigned maps;
    float error; // 0: a number of samples
    alp_gather gather;
    uint32_t bounces;
} estimate_case;

static alp_bake_options options_of(const estimate_case *c)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = c->size;
    options.maps = c->maps;
    options.occlusion.samples = c->error > 0.0f ? 4096 : 256;
    options.light.error = options.sampling.error = c->error;
    options.light.gather = c->gather;
    options.light.samples = 64;
    options.light.hemicube = 8;
    options.light.bounces = c->bounces;
    return options;
}

/// By a number of samples rays come within a factor of three; with an error, there are no fewer
/// than half of the first round's.
TEST(rays_and_texels_are_estimated)
{
    static const uint32_t many = ALP_BOUNCES_CONVERGE;
    static const estimate_case cases[] = {
        {"builtin:cornell", 256, ALP_MAP_AO, 0.0f, ALP_GATHER_RAYS, many},
        {"builtin:teapot-room", 256, ALP_MAP_AO, 0.0f, ALP_GATHER_RAYS, many},
        {"builtin:terrain", 256, ALP_MAP_AO, 0.0f, ALP_GATHER_RAYS, many},
        {"builtin:torus-plane", 256, ALP_MAP_AO, 0.01f, ALP_GATHER_RAYS, many},
        {"builtin:cornell", 256, ALP_MAP_LIGHT, 0.0f, ALP_GATHER_RAYS, many},
        {"builtin:teapot-room", 256, ALP_MAP_LIGHT, 0.0f, ALP_GATHER_RAYS, many},
        {"builtin:cornell", 256, ALP_MAP_LIGHT, 0.0f, ALP_GATHER_RAYS, 0},
        {"builtin:cornell", 64, ALP_MAP_LIGHT, 0.0f, ALP_GATHER_PATHS, many},
        {"builtin:cornell", 64, ALP_MAP_LIGHT, 0.0f, ALP_GATHER_HEMICUBE, many},
        {"builtin:cornell", 256, ALP_MAP_LIGHT, 0.02f, ALP_GATHER_RAYS, many},
        {"builtin:windows", 256, ALP_MAP_LIGHT, 0.04f, ALP_GATHER_RAYS, many}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const estimate_case *c = &cases[i];
        alp_context *context = test_context(2);
        alp_scene *scene = test_load(context, c->scene);
        const alp_bake_options options = options_of(c);
        alp_bake_work work;
        alp_bake_report report;
        ASSERT_OK(context, alp_bake_estimate(scene, &options, &work));
        ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
        const double rays = (double)report.rays / (double)work.rays;
        const double texels = (double)report.atlas.texels / (double)work.texels;
        print_message("estimate: %s %u, maps %u: texels %.2f, rays %.2f times the estimate\n",
                      c->scene, c->size, c->maps, texels, rays);
        ASSERT_NEAR(texels, 1.0, 0.3);
        assert_int_equal(work.rays_at_least, c->error > 0.0f);
        assert_true(work.rays_at_least ? rays > 0.5 : rays > 1.0 / 3.0 && rays < 3.0);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

TEST_WITH_CONTEXT(estimates_follow_the_options, 2)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    enum { PLAIN, OCCLUSION, PATHS, ALL_TEXELS, ONLY, OCCLUDERS, LAYERS, LARGER, OPTIONS };
    const estimate_case plain = {
        .size = 128, .maps = ALP_MAP_LIGHT, .bounces = ALP_BOUNCES_CONVERGE};
    alp_bake_options options[OPTIONS];
    alp_bake_work work[OPTIONS];
    for (int i = 0; i < OPTIONS; i++) {
        options[i] = options_of(&plain);
    }
    options[PATHS].light.gather = ALP_GATHER_PATHS;
    options[ALL_TEXELS].sampling.accuracy = ALP_ADAPTIVE_OFF;
    options[ONLY].only = "*block*";
    options[ONLY].atlas.texels_per_metre = options[LARGER].atlas.texels_per_metre = 20.0;
    options[OCCLUSION].maps = options[OCCLUDERS].maps = ALP_MAP_AO; // light has no occluders
    options[OCCLUDERS].occluders = "*block*";
    options[LAYERS].light.layers = true;
    for (int i = 0; i < OPTIONS; i++) {
        ASSERT_OK(context, alp_bake_estimate(scene, &options[i], &work[i]));
        assert_false(work[i].rays_at_least);
        assert_true(work[i].texels > 0 && work[i].rays > 0 && work[i].bytes > 0);
    }
    assert_int_equal(work[PATHS].rays, 64 * work[PATHS].texels);
    assert_true(work[ALL_TEXELS].rays > work[PLAIN].rays);
    assert_true(work[ONLY].texels < work[LARGER].texels);
    assert_int_equal(work[OCCLUDERS].rays, work[OCCLUSION].rays);
    assert_true(work[LAYERS].rays > work[PLAIN].rays && work[LAYERS].bytes > work[PLAIN].bytes);
    options[PLAIN].only = "nothing of this name";
    assert_int_equal(alp_bake_estimate(scene, &options[PLAIN], &work[PLAIN]),
                     ALP_ERROR_INVALID_ARGUMENT);
    options[OCCLUSION].atlas.mode = ALP_ATLAS_VERTEX;
    ASSERT_OK(context, alp_bake_estimate(scene, &options[OCCLUSION], &work[OCCLUSION]));
    assert_int_equal(work[OCCLUSION].texels + work[OCCLUSION].rays + work[OCCLUSION].bytes, 0);
    assert_int_equal(alp_bake_estimate(NULL, NULL, &work[PLAIN]), ALP_ERROR_INVALID_ARGUMENT);
    alp_scene_destroy(scene);
}
