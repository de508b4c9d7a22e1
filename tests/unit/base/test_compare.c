// SPDX-License-Identifier: MIT
// Comparing images: constructed pairs whose figures are known exactly, and the stored references.
#include "test_support.h"

#include "formats/formats.h"

#include <math.h>
#include <stdlib.h>

static alp_image *image_of(alp_context *context, uint32_t width, uint32_t channels,
                           const float *values)
{
    alp_image *image = NULL;
    alp_image_info info = {width, 1, channels, ALP_COMPONENT_FLOAT};
    ASSERT_OK(context, alp_image_create(context, info, &image));
    memcpy(alp_image_floats(image), values, sizeof(float) * width * channels);
    return image;
}

TEST_WITH_CONTEXT(figures_are_exact, 1)
{
    const float va[] = {1, 2, 3, 1, 4, 4, 4, 1, 9, 9, 9, 0, 7, 7, 7, 1, 5, 5, 5, 0};
    const float vb[] = {1, 0, 3, 1, 4, 4, 0, 1, 8, 8, 8, 1, 2, 2, 2, 0, 6, 6, 6, 0.5f};
    alp_image *a = image_of(context, 5, 4, va), *b = image_of(context, 5, 4, vb);
    alp_image_difference d;
    ASSERT_OK(context, alp_image_compare(a, b, 1.0, &d, NULL));
    assert_int_equal(d.pixels, 2);
    assert_int_equal(d.only_first, 1);
    assert_int_equal(d.only_second, 1); // alpha of one half is not covered
    ASSERT_NEAR(d.rmse, sqrt((4.0 + 16.0) / 6.0), 1e-15);
    ASSERT_NEAR(d.bias, (2.0 + 4.0) / 6.0, 1e-15);
    ASSERT_NEAR(d.mean_first, 18.0 / 6.0, 1e-15);
    ASSERT_NEAR(d.mean_second, 12.0 / 6.0, 1e-15);
    ASSERT_NEAR(d.relative_rmse, sqrt(20.0 / 6.0) / 2.0, 1e-15);
    ASSERT_NEAR(d.maximum, 4.0, 0.0);
    assert_int_equal(d.maximum_x, 1);
    ASSERT_NEAR(d.p99, 2.0 + 0.95 * 2.0, 1e-12); // rank .99 · 5 = 4.95 of 0 0 0 0 2 4

    ASSERT_OK(context, alp_image_compare(a, b, 0.5, &d, NULL));
    ASSERT_NEAR(d.mean_first, 1.5, 1e-15); // the first image is scaled, not the second
    ASSERT_NEAR(d.mean_second, 2.0, 1e-15);
    alp_image_destroy(a);
    alp_image_destroy(b);
}

TEST_WITH_CONTEXT(grey_is_compared_with_color, 1)
{
    const float grey[] = {1, 2}, color[] = {1, 1, 4, 2, 2, 2};
    alp_image *a = image_of(context, 2, 1, grey), *b = image_of(context, 2, 3, color);
    alp_image_difference d;
    ASSERT_OK(context, alp_image_compare(a, b, 1.0, &d, NULL));
    assert_int_equal(d.pixels, 2);
    ASSERT_NEAR(d.rmse, sqrt(9.0 / 6.0), 1e-15);
    alp_image_destroy(b);
    const float with_alpha[] = {1.5f, 1, 100, 0};
    b = image_of(context, 2, 2, with_alpha);
    ASSERT_OK(context, alp_image_compare(a, b, 1.0, &d, NULL));
    assert_int_equal(d.pixels, 1);
    assert_int_equal(d.only_first, 1);
    ASSERT_NEAR(d.rmse, 0.5, 1e-15);
    alp_image_destroy(a);
    alp_image_destroy(b);
}

TEST_WITH_CONTEXT(nothing_in_common, 1)
{
    const float va[] = {1, 1, 1, 1}, vb[] = {1, 1, 1, 0};
    alp_image *a = image_of(context, 1, 4, va), *b = image_of(context, 1, 4, vb);
    alp_image_difference d;
    ASSERT_OK(context, alp_image_compare(a, b, 1.0, &d, NULL));
    assert_int_equal(d.pixels, 0);
    ASSERT_NEAR(d.rmse, 0.0, 0.0);
    ASSERT_NEAR(d.maximum, 0.0, 0.0);
    ASSERT_OK(context, alp_image_compare(a, a, 1.0, &d, NULL));
    ASSERT_NEAR(d.relative_rmse, 0.0, 0.0);
    alp_image_destroy(a);
    alp_image_destroy(b);
}

TEST(the_percentile_is_numpys)
{
    // |d| are 0 … 1000 in a shuffled order and of both signs: percentile 99 is 990 exactly.
    alp_context *context = test_context(1);
    static float va[1001], vb[1001];
    for (int i = 0; i < 1001; i++) {
        int size = i * 389 % 1001;
        va[i] = (float)(i % 2 ? size : -size);
    }
    alp_image *a = image_of(context, 1001, 1, va), *b = image_of(context, 1001, 1, vb);
    alp_image_difference d;
    ASSERT_OK(context, alp_image_compare(a, b, 1.0, &d, NULL));
    ASSERT_NEAR(d.p99, 990.0, 1e-9);
    ASSERT_OK(context, alp_image_compare(a, b, 0.001, &d, NULL));
    ASSERT_NEAR(d.p99, 0.990, 1e-7); // values are rounded to float
    alp_image_destroy(a);
    alp_image_destroy(b);
    alp_context_destroy(context);
}

TEST_WITH_CONTEXT(the_picture_shows_where, 1)
{
    const float va[] = {0, 0, 0, 1, 1, 1, 1, 1, 9, 9, 9, 1, 9, 9, 9, 0, 9, 9, 9, 0};
    const float vb[] = {0, 0, 0, 1, 1, 0, 1, 1, 9, 9, 9, 0, 9, 9, 9, 1, 9, 9, 9, 0};
    const uint8_t expected[] = {0, 0, 0, 255, 255, 255, 255, 0, 255, 255, 0, 255, 0, 0, 64};
    alp_image *a = image_of(context, 5, 4, va), *b = image_of(context, 5, 4, vb), *heat = NULL;
    alp_image_difference d;
    ASSERT_OK(context, alp_image_compare(a, b, 1.0, &d, &heat));
    assert_memory_equal(alp_image_bytes(heat), expected, sizeof expected);
    alp_image_destroy(heat);
    ASSERT_OK(context, alp_image_compare(a, a, 1.0, &d, &heat));
    assert_int_equal(alp_image_bytes(heat)[3], 0); // equal images: black, not white
    alp_image_destroy(heat);
    alp_image_destroy(a);
    alp_image_destroy(b);
}

TEST_WITH_CONTEXT(what_cannot_be_compared, 1)
{
    const float values[] = {1, 2, 3, 4, NAN, 6};
    alp_image *a = image_of(context, 2, 1, values), *b = image_of(context, 3, 1, values);
    alp_image *broken = image_of(context, 2, 3, values), *bytes = NULL, *heat = NULL;
    alp_image_info info = {2, 1, 1, ALP_COMPONENT_U8};
    ASSERT_OK(context, alp_image_create(context, info, &bytes));
    alp_image_difference d;
    assert_int_equal(alp_image_compare(a, b, 1.0, &d, &heat), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_image_compare(a, bytes, 1.0, &d, &heat), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_image_compare(a, a, (double)NAN, &d, &heat), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_image_compare(a, broken, 1.0, &d, &heat), ALP_ERROR_INVALID_DATA);
    assert_non_null(strstr(alp_context_message(context), "pixel (1, 0) of the second"));
    assert_null(heat);
    alp_image_destroy(a);
    alp_image_destroy(b);
    alp_image_destroy(broken);
    alp_image_destroy(bytes);
}

static alp_image *load_reference(alp_context *context, const char *path)
{
    size_t size = 0;
    unsigned char *bytes = test_read_file(path, &size);
    alp_image *image = NULL;
    ASSERT_OK(context, alpi_exr_decode(context, path, bytes, size, &image));
    free(bytes);
    return image;
}

/// The figures are what the compare.py stored beside these files prints (numpy, double).
TEST(stored_references_agree_with_numpy)
{
    const char *path = test_shared("peers/blender/ref_cornell_diffuse_256.exr");
    if (path == NULL) {
        skip();
    }
    alp_context *context = test_context(1);
    alp_image *a = load_reference(context, path);
    alp_image *b = load_reference(context, test_shared("peers/blender/ref_cornell_ao_256.exr"));
    alp_image_difference d;
    ASSERT_OK(context, alp_image_compare(a, b, 1.0, &d, NULL));
    assert_int_equal(d.pixels, 47290);
    assert_int_equal(d.only_first, 0);
    ASSERT_NEAR(d.rmse, 0.529125671666363, 1e-9);
    ASSERT_NEAR(d.relative_rmse, 0.8355351602196209, 1e-9);
    ASSERT_NEAR(d.bias, -0.4772878930070372, 1e-9);
    ASSERT_NEAR(d.mean_second, 0.6332775649169354, 1e-9);
    ASSERT_NEAR(d.p99, 0.9404271822376176, 1e-6);
    ASSERT_NEAR(d.maximum, 0.9778086058795452, 1e-9);
    alp_image_destroy(a);
    alp_image_destroy(b);
    alp_context_destroy(context);
}
