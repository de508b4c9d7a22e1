// SPDX-License-Identifier: MIT
// Bent normals and coloured obscurance as a bake writes them and hands them out.
#include "bake/bake_memory.h"
#include "test_scenes.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

enum { SIZE = 64, ALL = ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_OBSCURANCE };

static alp_bake_options small_options(unsigned maps)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = SIZE;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.occlusion.samples = 64;
    options.maps = maps;
    return options;
}

static bool is_there(const char *folder, const char *name)
{
    return access(test_path(folder, name), F_OK) == 0;
}

/// The .exr is the page; the .png is scale · value + offset.
static void check_files(alp_context *context, const char *folder, const char *name,
                        const float *page, double scale, double offset)
{
    char file[32];
    alp_image *image = NULL;
    snprintf(file, sizeof file, "%s.exr", name);
    ASSERT_OK(context, alp_image_load(context, test_path(folder, file), &image));
    assert_memory_equal(alp_image_floats(image), page, sizeof(float) * SIZE * SIZE * 4);
    alp_image_destroy(image);
    snprintf(file, sizeof file, "%s.png", name);
    ASSERT_OK(context, alp_image_load(context, test_path(folder, file), &image));
    const alp_image_info info = alp_image_get_info(image);
    assert_int_equal(info.channels, 3);
    const uint8_t *bytes = alp_image_bytes(image);
    for (size_t i = 0; i < (size_t)3 * SIZE * SIZE; i++) {
        ASSERT_NEAR(bytes[i] / 255.0, scale * (double)page[i / 3 * 4 + i % 3] + offset,
                    0.501 / 255.0);
    }
    alp_image_destroy(image);
}

TEST_WITH_CONTEXT(maps_are_written_and_handed_out, 2)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    const char *folder = test_folder();
    alp_bake_options options = small_options(ALL);
    options.maps_folder = folder;
    options.output = test_path(test_folder(), "out.glb");
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    uint32_t width = 0, height = 0;
    const float *ao = alp_lightmap_map_page(lightmap, ALP_MAP_AO, 0, &width, &height);
    const float *bent = alp_lightmap_map_page(lightmap, ALP_MAP_BENT, 0, NULL, NULL);
    const float *color = alp_lightmap_map_page(lightmap, ALP_MAP_OBSCURANCE, 0, NULL, NULL);
    assert_true(width == SIZE && height == SIZE &&
                ao == alp_lightmap_page(lightmap, 0, NULL, NULL));
    assert_true(bent != NULL && color != NULL);
    assert_null(alp_lightmap_map_page(lightmap, ALP_MAP_BENT, report.atlas.pages, NULL, NULL));
    assert_null(alp_lightmap_map_page(lightmap, (alp_map)16, 0, NULL, NULL));
    uint32_t colored = 0;
    for (size_t i = 0; i < (size_t)SIZE * SIZE; i++) {
        const float *b = bent + 4 * i, *c = color + 4 * i, *a = ao + 4 * i;
        assert_true(b[3] == a[3] && c[3] == a[3]);
        // beside the charts too
        ASSERT_NEAR(sqrt((double)(b[0] * b[0] + b[1] * b[1] + b[2] * b[2])), 1.0, 1e-5);
        for (int k = 0; k < 3; k++) { // what occludes gives something back
            assert_true(c[k] >= 0.0f && c[k] <= 1.00001f);
        }
        colored += fabsf(c[0] - c[1]) > 0.02f;
    }
    assert_true(colored > SIZE);
    check_files(context, folder, "bent", bent, 0.5, 0.5);
    check_files(context, folder, "obscurance", color, 1.0, 0.0);
    assert_true(is_there(folder, "ao.exr") && is_there(folder, "ao.png"));
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(channels_are_x_y_z, 1)
{
    test_mesh *mesh = test_mesh_start(); // open, normal (1, 2, 3)
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){2, -1, 0}, (double[]){3, 0, -1});
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alp_bake_options options = small_options(ALP_MAP_BENT);
    options.occlusion.samples = 1024;
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
    const float *bent = alp_lightmap_map_page(lightmap, ALP_MAP_BENT, 0, NULL, NULL);
    for (size_t i = 0; i < (size_t)3 * SIZE * SIZE; i++) {
        ASSERT_NEAR(bent[i / 3 * 4 + i % 3], (double)(i % 3 + 1) / sqrt(14.0), 0.01);
    }
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(side_maps_leave_occlusion_as_it_is, 2)
{
    alp_scene *scene = test_load(context, "builtin:torus-plane");
    alp_lightmap *alone = NULL, *all = NULL;
    alp_bake_report reports[2];
    alp_bake_options options = small_options(ALP_MAP_AO);
    ASSERT_OK(context, alp_bake(scene, &options, &alone, &reports[0]));
    options.maps = ALL;
    ASSERT_OK(context, alp_bake(scene, &options, &all, &reports[1]));
    assert_int_equal(reports[1].rays - reports[0].rays,
                     (reports[0].atlas.texels - reports[0].dropped) * 64);
    assert_memory_equal(alp_lightmap_page(alone, 0, NULL, NULL),
                        alp_lightmap_page(all, 0, NULL, NULL), sizeof(float) * SIZE * SIZE * 4);
    assert_null(alp_lightmap_map_page(alone, ALP_MAP_BENT, 0, NULL, NULL));
    assert_null(alp_lightmap_map_page(alone, ALP_MAP_OBSCURANCE, 0, NULL, NULL));
    alp_lightmap_destroy(alone);
    alp_lightmap_destroy(all);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(objects_alone_see_no_other, 2)
{
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_bake_options options = small_options(ALL);
    options.ao_self = true;
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
    const float *bent = alp_lightmap_map_page(lightmap, ALP_MAP_BENT, 0, NULL, NULL);
    const float *color = alp_lightmap_map_page(lightmap, ALP_MAP_OBSCURANCE, 0, NULL, NULL);
    for (size_t i = 0; i < (size_t)SIZE * SIZE; i++) { // convex: nothing bleeds, all is bent
        const float *b = bent + 4 * i, *c = color + 4 * i;
        ASSERT_NEAR(sqrt((double)(b[0] * b[0] + b[1] * b[1] + b[2] * b[2])), 1.0, 1e-5);
        ASSERT_NEAR(c[0] + c[1] + c[2], 3.0, 1e-5);
    }
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(only_what_is_asked_for_is_written, 2)
{
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    const char *folder = test_folder();
    alp_bake_options options = small_options(ALP_MAP_BENT);
    options.maps_folder = folder;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    assert_true(is_there(folder, "bent.exr") && is_there(folder, "bent.png"));
    assert_false(is_there(folder, "ao.exr") || is_there(folder, "ao.png") ||
                 is_there(folder, "ao.error.exr") || is_there(folder, "obscurance.exr"));
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_IO); // it exists now
    options.maps = ALP_MAP_AO;                                             // this does not
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    assert_true(is_there(folder, "ao.exr"));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_map_cut_off_has_bent_normals_where_it_has_values, 2)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_bake_options options = small_options(ALP_MAP_AO | ALP_MAP_BENT);
    options.sampling.time_limit = 0.02;
    options.occlusion.samples = 65536;
    alp_lightmap *lightmap = NULL;
    alp_result result = alp_bake(scene, &options, &lightmap, NULL);
    while (result == ALP_ERROR_LIMIT) { // a machine too slow for a single texel in that time
        options.sampling.time_limit *= 2.0;
        result = alp_bake(scene, &options, &lightmap, NULL);
    }
    ASSERT_OK(context, result);
    const float *bent = alp_lightmap_map_page(lightmap, ALP_MAP_BENT, 0, NULL, NULL);
    for (size_t i = 0; i < (size_t)SIZE * SIZE; i++) {
        const float *b = bent + 4 * i;
        const double length = sqrt((double)(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]));
        assert_true(b[3] == 0.0f || fabs(length - 1.0) < 1e-5);
    }
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

static void expect_refused(const alp_scene *scene, const alp_bake_options *options)
{
    assert_int_equal(alp_bake(scene, options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
}

TEST_WITH_CONTEXT(senseless_combinations_are_refused, 1)
{
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_bake_options options = small_options(0);
    expect_refused(scene, &options);
    options.maps = 16;
    expect_refused(scene, &options);
    options = small_options(ALP_MAP_BENT); // nothing to put into an asset
    options.output = test_path(test_folder(), "out.glb");
    expect_refused(scene, &options);
    options = small_options(ALP_MAP_AO | ALP_MAP_OBSCURANCE);
    options.sampling.time_limit = 1.0;
    expect_refused(scene, &options);
    options.sampling.time_limit = 0.0;
    options.sampling.keep_partial = true;
    expect_refused(scene, &options);
    options = small_options(ALP_MAP_LIGHT);
    options.light.samples = 0;
    expect_refused(scene, &options);
    options = small_options(ALP_MAP_AO | ALP_MAP_SH); // of no light
    expect_refused(scene, &options);
    options = small_options(ALP_MAP_LIGHT | ALP_MAP_DIRECTION);
    options.light.gather = ALP_GATHER_PATHS;
    expect_refused(scene, &options);
    options = small_options(ALP_MAP_LIGHT);
    options.ao_self = true;
    expect_refused(scene, &options);
    options = small_options(ALP_MAP_LIGHT);
    options.sampling.keep_partial = true;
    options.light.gather = ALP_GATHER_HEMICUBE; // in one go
    expect_refused(scene, &options);
    options = small_options(ALP_MAP_AO | ALP_MAP_BENT);
    options.atlas.mode = ALP_ATLAS_VERTEX;
    expect_refused(scene, &options);
    alp_scene_destroy(scene);
}

/// A sun of E⊥ lux gives E⊥ cosθ where nothing is in its way, and 0 in the shadow; without other
/// light that is exact. Light alone: no occlusion is written.
TEST_WITH_CONTEXT(the_sun_on_a_plane, 2)
{
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_bake_options options = small_options(ALP_MAP_LIGHT);
    options.maps_folder = test_folder();
    options.light.bounces = 0;
    options.light.samples = 16;
    options.light.lighting.sun.illuminance = 1000.0f;
    options.light.lighting.sun.elevation = 0.5f;
    options.light.lighting.sun.size = 0.0f;
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    assert_true(access(test_path(options.maps_folder, "irradiance.exr"), F_OK) == 0);
    assert_true(access(test_path(options.maps_folder, "irradiance.error.exr"), F_OK) == 0);
    assert_true(access(test_path(options.maps_folder, "ao.exr"), F_OK) != 0);
    options.maps_folder = NULL;
    const float *page = alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, 0, NULL, NULL);
    const double exact = 1000.0 * sin(0.5);
    uint32_t lit = 0, dark = 0;
    for (size_t i = 0; i < (size_t)SIZE * SIZE; i++) {
        const float *pixel = page + 4 * i;
        assert_true(pixel[0] >= 0.0f && pixel[0] <= 1000.01f);
        lit += pixel[3] > 0.5f && fabs((double)pixel[0] / exact - 1.0) < 1e-4;
        dark += pixel[3] > 0.5f && pixel[0] == 0.0f;
    }
    assert_true(lit > 100 && dark > 10);
    assert_true(report.light_mean > 0.0 && report.light_relative_error < 0.2);
    // One light: a ray of each sample that faces it, and those that look for texels inside others.
    assert_true(report.light_direct && report.light_samples == 16);
    alp_lamp away = alp_lamp_default(); // high above, it lights the sky, and no texel traces a ray
    away.kind = ALP_LIGHT_SPOT;
    away.position[1] = 1000.0f;
    away.direction[1] = 1.0f;
    away.direction[2] = 0.0f;
    away.intensity = 1.0f;
    options.light.lighting.sun.illuminance = 0.0f;
    options.light.lighting.lamps = &away;
    options.light.lighting.lamp_count = 1;
    alp_bake_report darkness;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &darkness));
    assert_true(report.rays > darkness.rays &&
                report.rays - darkness.rays <= 16 * report.atlas.texels);
    options.light.bounces = 1;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &darkness));
    assert_false(darkness.light_direct);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

static bool stop_at_obscurance(void *user, const alp_progress *progress)
{
    (void)user;
    return strcmp(progress->stage, "obscurance") != 0;
}

TEST_WITH_CONTEXT(obscurance_can_be_cancelled, 2)
{
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_bake_options options = small_options(ALL);
    options.occlusion.samples = 1024; // long enough to be asked
    options.progress = stop_at_obscurance;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_CANCELLED);
    alp_scene_destroy(scene);
}

TEST(every_allocation_may_fail)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    left = 1 << 30;
    alp_scene *scene = test_load(context, "builtin:cornell"); // few triangles, few charts
    alp_bake_options options = small_options(ALL);
    options.atlas.size = 24;
    options.occlusion.samples = 4;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL)); // builds the tracer
    left = 1 << 30;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    const int needed = (1 << 30) - left;
    for (int i = 0; i < needed; i += i < needed - 60 ? 7 : 1) {
        left = i;
        assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_OUT_OF_MEMORY);
    }
    left = 1 << 30;
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}
