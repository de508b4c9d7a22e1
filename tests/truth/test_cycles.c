// SPDX-License-Identifier: MIT
// Against Blender's Cycles on the same texels: the stored converged reference of the Cornell box.
// Ours takes the whole texel or its centre, Cycles the middle half of it, which alone is worth
// .0025 to .0033 (measured with both converged), so .006 leaves room for .005 of noise and nothing
// else.
#include "test_support.h"

#include "base/image.h"

#include <stdio.h>
#include <unistd.h>

static void cornell_box_occlusion(void **state)
{
    (void)state;
    const char *scene_path = test_shared("peers/blender/cornell.glb");
    if (scene_path == NULL) {
        skip();
    }
    alp_context *context = test_context(2);
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_load(context, scene_path, &scene));
    alp_bake_options options = alp_bake_options_default();
    options.atlas.mode = ALP_ATLAS_KEEP;
    options.atlas.size = 256;
    options.occlusion.distance = 0.2f;
    options.occlusion.falloff = ALP_FALLOFF_NONE;
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    assert_int_equal(report.atlas.texels, 47290); // as the peer covers
    alp_image *reference = NULL;
    ASSERT_OK(context, alp_image_load(context, test_shared("peers/blender/ref_cornell_ao_256.exr"),
                                      &reference));
    uint32_t width = 0, height = 0;
    const float *page = alp_lightmap_page(lightmap, 0, &width, &height);
    alp_image *ours = NULL;
    ASSERT_OK(
        context,
        alp_image_create(context, (alp_image_info){width, height, 4, ALP_COMPONENT_FLOAT}, &ours));
    memcpy(alp_image_floats(ours), page, sizeof(float) * 4 * width * height);
    alp_image_difference difference;
    ASSERT_OK(context, alp_image_compare(ours, reference, 1.0, &difference, NULL));
    print_message("rmse %.5f, bias %+.5f, largest %.4f over %llu texels\n", difference.rmse,
                  difference.bias, difference.maximum, (unsigned long long)difference.pixels);
    assert_int_equal(difference.only_first, 0);
    assert_int_equal(difference.only_second, 0);
    assert_true(difference.rmse <= 0.006);
    assert_true(difference.bias > -0.001 && difference.bias < 0.001);
    alp_image_destroy(ours);
    alp_image_destroy(reference);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cornell_box_occlusion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
