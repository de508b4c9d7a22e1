// SPDX-License-Identifier: MIT
// Image files: the kind is known by the first bytes when reading, by the ending when writing.
#include "test_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

static alp_image *make(alp_context *context, alp_component component)
{
    alp_image_info info = {5, 3, 3, component};
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &image));
    for (int i = 0; i < 45; i++) {
        if (component == ALP_COMPONENT_U8) {
            alp_image_bytes(image)[i] = (uint8_t)(5 * i);
        } else {
            alp_image_floats(image)[i] = 0.37f * (float)i;
        }
    }
    return image;
}

TEST_WITH_CONTEXT(names_do_not_matter_when_reading, 1)
{
    const char *folder = test_folder();
    const char *png = test_path(folder, "a.PNG"), *exr = test_path(folder, "b.exr");
    const char *swapped = test_path(folder, "c.png");
    alp_image *bytes = make(context, ALP_COMPONENT_U8),
              *floats = make(context, ALP_COMPONENT_FLOAT);
    ASSERT_OK(context, alp_image_save(bytes, png, false));
    ASSERT_OK(context, alp_image_save(floats, exr, false));
    assert_int_equal(rename(exr, swapped), 0);
    alp_image *again = NULL;
    ASSERT_OK(context, alp_image_load(context, png, &again));
    assert_int_equal(alp_image_get_info(again).channels, 3);
    assert_memory_equal(alp_image_bytes(again), alp_image_bytes(bytes), 45);
    alp_image_destroy(again);
    ASSERT_OK(context, alp_image_load(context, swapped, &again));
    assert_memory_equal(alp_image_floats(again), alp_image_floats(floats), 45 * sizeof(float));
    alp_image_destroy(again);
    ASSERT_OK(context, alp_image_save(floats, test_path(folder, "d.HDR"), false));
    ASSERT_OK(context, alp_image_load(context, test_path(folder, "d.HDR"), &again));
    ASSERT_NEAR(alp_image_floats(again)[44], 0.37 * 44, 0.37 * 44 / 256.0); // eight bits
    alp_image_destroy(again);
    alp_image_destroy(bytes);
    alp_image_destroy(floats);
}

TEST_WITH_CONTEXT(endings_decide_when_writing, 1)
{
    const char *folder = test_folder();
    alp_image *bytes = make(context, ALP_COMPONENT_U8),
              *floats = make(context, ALP_COMPONENT_FLOAT);
    assert_int_equal(alp_image_save(floats, test_path(folder, "a.png"), true),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_image_save(bytes, test_path(folder, "a.exr"), true),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_image_save(bytes, test_path(folder, "a.hdr"), true),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_image_save(bytes, test_path(folder, "a.jpg"), true),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(alp_context_message(context), ".png, .exr or .hdr"));
    assert_int_equal(alp_image_save(bytes, NULL, true), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_image_save(NULL, "a.png", true), ALP_ERROR_INVALID_ARGUMENT);
    struct stat status;
    assert_int_not_equal(stat(test_path(folder, "a.png"), &status), 0); // nothing was written
    alp_image_destroy(bytes);
    alp_image_destroy(floats);
}

TEST_WITH_CONTEXT(nothing_is_overwritten_unasked, 1)
{
    const char *path = test_path(test_folder(), "a.exr");
    alp_image *image = make(context, ALP_COMPONENT_FLOAT), *again = NULL;
    ASSERT_OK(context, alp_image_save(image, path, false));
    alp_image_floats(image)[0] = 7.0f;
    assert_int_equal(alp_image_save(image, path, false), ALP_ERROR_IO);
    ASSERT_OK(context, alp_image_load(context, path, &again));
    ASSERT_NEAR(alp_image_floats(again)[0], 0.0, 0.0);
    alp_image_destroy(again);
    ASSERT_OK(context, alp_image_save(image, path, true));
    ASSERT_OK(context, alp_image_load(context, path, &again));
    ASSERT_NEAR(alp_image_floats(again)[0], 7.0, 0.0);
    alp_image_destroy(again);
    alp_image_destroy(image);
}

TEST_WITH_CONTEXT(what_is_no_image_is_named, 1)
{
    const char *folder = test_folder(), *path = test_path(folder, "text.png");
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs("hello", file);
    fclose(file);
    alp_image *image = NULL;
    assert_int_equal(alp_image_load(context, path, &image), ALP_ERROR_INVALID_DATA);
    assert_non_null(strstr(alp_context_message(context), "text.png"));
    assert_int_equal(alp_image_load(context, test_path(folder, "none.png"), &image), ALP_ERROR_IO);
    assert_int_equal(alp_image_load(context, folder, &image), ALP_ERROR_IO);
    assert_int_equal(alp_image_load(context, NULL, &image), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(image);
}
