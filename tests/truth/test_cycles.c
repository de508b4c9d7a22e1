// SPDX-License-Identifier: MIT
// Against Blender's Cycles on the same texels: the stored converged reference of the Cornell box.
// Ours takes the whole texel or its centre, Cycles the middle half of it, which alone is worth
// .0025 to .0033 (measured with both converged), so .006 leaves room for .005 of noise and nothing
// else. Its light: E/pi with 8 bounces, where the peer's noise is 1.2 % of the mean.
#include "test_support.h"

#include <math.h>

static alp_scene *load_cornell(alp_context *context)
{
    const char *path = test_shared("peers/blender/cornell.glb");
    alp_scene *scene = NULL;
    if (path == NULL) {
        alp_context_destroy(context);
        skip();
    }
    ASSERT_OK(context, alp_scene_load(context, path, &scene));
    return scene;
}

/// A page of ours against a stored one; ours is multiplied by `scale`.
static alp_image_difference compare(alp_context *context, const alp_lightmap *lightmap, alp_map map,
                                    const char *stored, double scale)
{
    uint32_t width = 0, height = 0;
    alp_image *ours = NULL, *reference = NULL;
    alp_image_difference difference;
    ASSERT_OK(context, alp_image_load(context, test_shared(stored), &reference));
    const float *page = alp_lightmap_map_page(lightmap, map, 0, &width, &height);
    ASSERT_OK(
        context,
        alp_image_create(context, (alp_image_info){width, height, 4, ALP_COMPONENT_FLOAT}, &ours));
    memcpy(alp_image_floats(ours), page, sizeof(float) * 4 * width * height);
    ASSERT_OK(context, alp_image_compare(ours, reference, scale, &difference, NULL));
    print_message("rmse %.5f, bias %+.5f, largest %.4f over %llu texels\n", difference.rmse,
                  difference.bias, difference.maximum, (unsigned long long)difference.pixels);
    assert_int_equal(difference.only_first, 0);
    assert_int_equal(difference.only_second, 0);
    alp_image_destroy(ours);
    alp_image_destroy(reference);
    return difference;
}

static alp_bake_options keep_256(void)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.mode = ALP_ATLAS_KEEP;
    options.atlas.size = 256;
    return options;
}

TEST_WITH_CONTEXT(cornell_box_occlusion, 2)
{
    alp_scene *scene = load_cornell(context);
    alp_bake_options options = keep_256();
    options.occlusion.distance = 0.2f;
    options.occlusion.falloff = ALP_FALLOFF_NONE;
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    assert_int_equal(report.atlas.texels, 47290); // as the peer covers
    const alp_image_difference d =
        compare(context, lightmap, ALP_MAP_AO, "peers/blender/ref_cornell_ao_256.exr", 1.0);
    assert_true(d.rmse <= 0.006);
    assert_true(d.bias > -0.001 && d.bias < 0.001);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

/// Means over the texels of both pictures, of each channel.
static void mean_channels(alp_context *context, const alp_lightmap *lightmap, const char *stored,
                          double scale, double ours[3], double theirs[3])
{
    uint32_t width = 0, height = 0;
    alp_image *reference = NULL;
    ASSERT_OK(context, alp_image_load(context, test_shared(stored), &reference));
    const float *a = alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, 0, &width, &height);
    const float *b = alp_image_floats(reference);
    double count = 0.0;
    memset(ours, 0, 3 * sizeof *ours);
    memset(theirs, 0, 3 * sizeof *theirs);
    for (size_t i = 0; i < (size_t)width * height; i++) {
        if (a[4 * i + 3] > 0.0f) {
            count += 1.0;
            for (int k = 0; k < 3; k++) {
                ours[k] += scale * (double)a[4 * i + (size_t)k];
                theirs[k] += (double)b[4 * i + (size_t)k];
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        ours[k] /= count;
        theirs[k] /= count;
    }
    alp_image_destroy(reference);
}

/// E/π after 8 bounces, by a gatherer: the mean of each channel within .5 %; and what is left of
/// the difference when both noises are taken off it within `most` of the mean: for paths 1 %, for
/// rays 2 %, as what they interpolate has errors alike in many texels. Ours is what the bakes state
/// of themselves, the peer's is 1.2 % (measured where it was made).
/// @param seeds bakes, of whose errors the mean square is taken
/// @param doubt how well the square of ours is known then: 2 % of one map by paths, of which a few
///              thousand blocks of eight texels have errors of their own; of eight by rays 10 %,
///              for the square that one states by a thousand texels varies by 30 %. Three times
///              that is allowed
static void hold_light(alp_gather gather, uint32_t seeds, double most, double doubt)
{
    const char *stored = "peers/blender/ref_cornell_diffuse_256.exr";
    const double scale = 1.0 / 3.14159265358979, peer = 0.012;
    double all = 0.0, own = 0.0, apart[3] = {0.0, 0.0, 0.0}; // mean squares; of means
    for (uint32_t seed = 0; seed < seeds; seed++) {
        alp_context *context = test_context(2);
        alp_scene *scene = load_cornell(context);
        alp_bake_options options = keep_256();
        options.maps = ALP_MAP_LIGHT;
        options.light.gather = gather;
        options.light.samples = 64;
        options.light.bounces = 8;
        options.occlusion.seed = seed;
        alp_lightmap *lightmap = NULL;
        alp_bake_report report;
        ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
        const alp_image_difference d = compare(context, lightmap, ALP_MAP_LIGHT, stored, scale);
        all += pow(d.rmse / d.mean_second, 2.0) / seeds;
        own += pow(report.light_relative_error, 2.0) / seeds;
        double ours[3], theirs[3];
        mean_channels(context, lightmap, stored, scale, ours, theirs);
        for (int k = 0; k < 3; k++) {
            apart[k] += (ours[k] / theirs[k] - 1.0) / seeds;
        }
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    const double rest = all - own - peer * peer, known = doubt * own;
    print_message("of the mean: difference %.2f %%, our noise %.2f %%, left %.2f %%\n",
                  100.0 * sqrt(all), 100.0 * sqrt(own), 100.0 * sqrt(fmax(rest, 0.0)));
    assert_true(rest < most * most + 3.0 * known && rest > -3.0 * known);
    for (int k = 0; k < 3; k++) {
        print_message("channel %d: %+.3f %%\n", k, 100.0 * apart[k]);
        assert_true(fabs(apart[k]) <= 0.005);
    }
}

TEST(cornell_box_light)
{
    hold_light(ALP_GATHER_PATHS, 1, 0.01, 0.02);
    hold_light(ALP_GATHER_RAYS, 8, 0.02, 0.1);
}
