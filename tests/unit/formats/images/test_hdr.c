// SPDX-License-Identifier: MIT
// Radiance pictures: what is written comes back; files of other writers, spelt out here byte by
// byte, are read in every storage and orientation; what is broken is refused by name.
#include "test_support.h"

#include "base/memory.h"
#include "formats/formats.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static uint32_t random_bits(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static alp_image *make_image(alp_context *context, uint32_t width, uint32_t height,
                             uint32_t channels)
{
    alp_image_info info = {width, height, channels, ALP_COMPONENT_FLOAT};
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &image));
    return image;
}

/// Values over 40 powers of two, with runs of equal pixels of all lengths.
static alp_image *noise(alp_context *context, uint32_t width, uint32_t height, uint32_t channels)
{
    alp_image *image = make_image(context, width, height, channels);
    float *pixels = alp_image_floats(image);
    uint32_t state = width + 7 * height, run = 0;
    for (size_t i = 0; i < (size_t)width * height; i++) {
        run = run > 0 ? run - 1 : random_bits(&state) % 5 == 0 ? random_bits(&state) % 300 : 0;
        for (uint32_t k = 0; k < channels; k++) {
            pixels[i * channels + k] =
                run > 0 && i > 0
                    ? pixels[(i - 1) * channels + k]
                    : ldexpf((float)random_bits(&state), (int)(random_bits(&state) % 40) - 40);
        }
    }
    return image;
}

static alp_image *decode(alp_context *context, const void *bytes, size_t size)
{
    alp_image *image = NULL;
    ASSERT_OK(context, alpi_hdr_decode(context, "test.hdr", bytes, size, &image));
    return image;
}

/// Half a step of eight bits at the pixel's exponent: the largest channel over 256.
static void check_close(const alp_image *image, const alp_image *again)
{
    alp_image_info info = alp_image_get_info(again);
    assert_int_equal(info.channels, 3);
    for (uint32_t i = 0; i < info.width * info.height; i++) {
        float a[4], b[4];
        alpi_image_pixel(image, i % info.width, i / info.width, a);
        alpi_image_pixel(again, i % info.width, i / info.width, b);
        float most = fmaxf(fmaxf(a[0], a[1]), a[2]);
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(b[k], a[k], most / 256.0f);
        }
    }
}

TEST_WITH_CONTEXT(what_is_written_comes_back, 1)
{
    const uint32_t sizes[][2] = {{1, 1},   {7, 3},   {8, 4},     {127, 5},   {128, 2},
                                 {129, 3}, {500, 9}, {32767, 1}, {32768, 1}, {1, 300}};
    for (int i = 0; i < 10; i++) {
        for (uint32_t channels = 1; channels <= 4; channels++) {
            alp_image *image = noise(context, sizes[i][0], sizes[i][1], channels);
            uint8_t *bytes = NULL, *twice = NULL;
            size_t size = 0, size_twice = 0;
            ASSERT_OK(context, alpi_hdr_encode(image, &bytes, &size));
            alp_image *again = decode(context, bytes, size);
            assert_int_equal(alp_image_get_info(again).width, sizes[i][0]);
            assert_int_equal(alp_image_get_info(again).height, sizes[i][1]);
            check_close(image, again);
            // What the format can hold it holds exactly.
            ASSERT_OK(context, alpi_hdr_encode(again, &twice, &size_twice));
            assert_int_equal(size_twice, size);
            assert_memory_equal(twice, bytes, size);
            alpi_release(context, bytes);
            alpi_release(context, twice);
            alp_image_destroy(image);
            alp_image_destroy(again);
        }
    }
}

TEST_WITH_CONTEXT(equal_pixels_take_little_room, 1)
{
    alp_image *image = make_image(context, 1000, 10, 3);
    for (int i = 0; i < 30000; i++) {
        alp_image_floats(image)[i] = 0.5f;
    }
    uint8_t *bytes = NULL;
    size_t size = 0;
    ASSERT_OK(context, alpi_hdr_encode(image, &bytes, &size));
    assert_in_range(size, 1, 10 * (4 + 4 * 2 * 8) + 60); // eight runs of 127 a channel
    alpi_release(context, bytes);
    alp_image_destroy(image);
}

TEST_WITH_CONTEXT(what_it_cannot_hold_is_clamped_and_told, 1)
{
    alp_image *image = make_image(context, 3, 1, 3);
    const float values[9] = {-1.0f, NAN, 0.25f, INFINITY, 3e38f, 1.0f, 1e-42f, 0.0f, 1e-39f};
    memcpy(alp_image_floats(image), values, sizeof values);
    test_log_clear();
    uint8_t *bytes = NULL;
    size_t size = 0;
    ASSERT_OK(context, alpi_hdr_encode(image, &bytes, &size));
    assert_non_null(strstr(test_log_text(), "hdr-range"));
    assert_non_null(strstr(test_log_text(), "4 values"));
    alp_image *again = decode(context, bytes, size);
    const float *p = alp_image_floats(again);
    const float expected[9] = {0.0f, 0.0f, 0.25f, 0x1.fep126f, 0x1.fep126f, 0.0f, 0.0f, 0.0f, 0.0f};
    for (int i = 0; i < 9; i++) {
        ASSERT_NEAR(p[i], expected[i], 0.0);
    }
    alpi_release(context, bytes);
    alp_image_destroy(again);
    alp_image_destroy(image);
    image = NULL;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){2, 2, 3, ALP_COMPONENT_U8}, &image));
    assert_int_equal(alpi_hdr_encode(image, &bytes, &size), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(bytes);
    alp_image_destroy(image);
}

// --- files of other writers ----------------------------------------------------------------------

typedef struct file {
    uint8_t bytes[4096];
    size_t size;
} file;

static void put(file *f, const void *bytes, size_t size)
{
    assert_true(f->size + size <= sizeof f->bytes);
    memcpy(f->bytes + f->size, bytes, size);
    f->size += size;
}

static file begin(const char *header)
{
    file f = {.size = 0};
    put(&f, header, strlen(header));
    return f;
}

#define HEAD "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"

/// Mantissas m and exponent 2^e stand for m / 256 · 2^(byte − 128).
TEST_WITH_CONTEXT(the_numbers_are_ward_s, 1)
{
    file f = begin(HEAD "-Y 1 +X 4\n");
    put(&f,
        "\x80\x40\x00\x81"
        "\xff\x01\x00\x88"
        "\x10\x20\x30\x00"
        "\x80\x80\x80\x01",
        16);
    alp_image *image = decode(context, f.bytes, f.size);
    const float expected[12] = {1.0f, 0.5f, 0.0f, 255.0f,    1.0f,      0.0f,
                                0.0f, 0.0f, 0.0f, 0x1p-128f, 0x1p-128f, 0x1p-128f};
    for (int i = 0; i < 12; i++) {
        ASSERT_NEAR(alp_image_floats(image)[i], expected[i], 0.0);
    }
    alp_image_destroy(image);
}

/// Pixel i has red (i + 1) / 256: 128 is added to keep runs of ones away.
static void put_quad(file *f, int i)
{
    const uint8_t quad[4] = {(uint8_t)(i + 1), 128, 7, 128};
    put(f, quad, 4);
}

static void check_reds(alp_context *context, const file *f, uint32_t width, uint32_t height,
                       const int *order)
{
    alp_image *image = decode(context, f->bytes, f->size);
    assert_int_equal(alp_image_get_info(image).width, width);
    assert_int_equal(alp_image_get_info(image).height, height);
    for (uint32_t i = 0; i < width * height; i++) {
        ASSERT_NEAR(alp_image_floats(image)[3 * i], (float)(order[i] + 1) / 256.0f, 0.0);
        ASSERT_NEAR(alp_image_floats(image)[3 * i + 1], 0.5, 0.0);
    }
    alp_image_destroy(image);
}

/// A picture of three columns and two rows, stored in each of the eight orders.
TEST_WITH_CONTEXT(every_orientation, 1)
{
    static const struct {
        const char *size;
        int order[6]; // which stored pixel is at each place of the picture, row by row
    } cases[] = {
        {"-Y 2 +X 3\n", {0, 1, 2, 3, 4, 5}}, {"-Y 2 -X 3\n", {2, 1, 0, 5, 4, 3}},
        {"+Y 2 +X 3\n", {3, 4, 5, 0, 1, 2}}, {"+Y 2 -X 3\n", {5, 4, 3, 2, 1, 0}},
        {"+X 3 -Y 2\n", {0, 2, 4, 1, 3, 5}}, {"-X 3 -Y 2\n", {4, 2, 0, 5, 3, 1}},
        {"+X 3 +Y 2\n", {1, 3, 5, 0, 2, 4}}, {"-X 3 +Y 2\n", {5, 3, 1, 4, 2, 0}},
    };
    for (int c = 0; c < 8; c++) {
        file f = begin(HEAD);
        put(&f, cases[c].size, strlen(cases[c].size));
        for (int i = 0; i < 6; i++) {
            put_quad(&f, i);
        }
        check_reds(context, &f, 3, 2, cases[c].order);
    }
}

TEST_WITH_CONTEXT(old_and_new_runs, 1)
{
    // Old: pixel 0, three more of it, pixel 1, and 2 + 1 · 256 more of it.
    file f = begin(HEAD "-Y 1 +X 263\n");
    put_quad(&f, 0);
    put(&f, "\1\1\1\3", 4);
    put_quad(&f, 1);
    put(&f, "\1\1\1\2\1\1\1\1", 8);
    int order[263];
    for (int i = 0; i < 263; i++) {
        order[i] = i >= 4;
    }
    check_reds(context, &f, 263, 1, order);
    // New: ten pixels, red 0 0 0 0 0 0 1 2 3 4, then two lines stored flat as some writers mix
    // them.
    f = begin(HEAD "-Y 2 +X 10\n");
    put(&f,
        "\2\2\0\12"
        "\206\1\4\2\3\4\5"
        "\212\200"
        "\212\7"
        "\212\200",
        4 + 7 + 6);
    for (int i = 0; i < 10; i++) {
        put_quad(&f, i);
    }
    const int mixed[20] = {0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    check_reds(context, &f, 10, 2, mixed);
}

TEST_WITH_CONTEXT(headers_of_others, 1)
{
    static const struct {
        const char *header;
        float red, green;
    } good[] = {
        {"#?RGBE\n# a comment\nGAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\nFORMAT= 32-bit_rle_rgbe\n\n",
         1.0f, 0.5f},
        {"#?RADIANCE\n\n", 1.0f, 0.5f}, // no format: the only one there used to be
        {"#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n", 1.0f, 0.5f},
        {"#?RADIANCE\nEXPOSURE=2.0\nEXPOSURE= .25e+1\n\n", 0.2f, 0.1f},
        {"#?RADIANCE\nEXPOSURE=4\nCOLORCORR=0.5 1.0e0 10\n\n", 0.5f, 0.125f},
        {"#?RADIANCE\nEXPOSURE=1e-300\n\n", 0x1.fffffep127f, 0x1.fffffep127f},
    };
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        file f = begin(good[i].header);
        put(&f, "-Y 1 +X 1\n\x80\x40\x00\x81", 14);
        alp_image *image = decode(context, f.bytes, f.size);
        ASSERT_NEAR(alp_image_floats(image)[0], good[i].red, 1e-7f * good[i].red);
        ASSERT_NEAR(alp_image_floats(image)[1], good[i].green, 1e-7f * good[i].green);
        alp_image_destroy(image);
    }
}

// --- what cannot be read -------------------------------------------------------------------------

static void refuse(const void *bytes, size_t size, alp_result expected, const char *word)
{
    alp_context *context = test_context(1);
    alp_image *image = NULL;
    assert_int_equal(alpi_hdr_decode(context, "odd.hdr", bytes, size, &image), expected);
    assert_null(image);
    assert_non_null(strstr(alp_context_message(context), "odd.hdr: "));
    if (strstr(alp_context_message(context), word) == NULL) {
        fail_msg("\"%s\" is not in: %s", word, alp_context_message(context));
    }
    alp_context_destroy(context);
}

TEST(headers_that_are_refused)
{
    static const struct {
        const char *text, *word;
        alp_result result;
    } bad[] = {
        {"", "does not begin", ALP_ERROR_INVALID_DATA},
        {"hello\n\n", "does not begin", ALP_ERROR_INVALID_DATA},
        {"#?RADIANCE", "does not begin", ALP_ERROR_INVALID_DATA},
        {"#?RADIANCE\nA=1\n", "within its header", ALP_ERROR_INVALID_DATA},
        {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd", "32-bit_rle_xyze",
         ALP_ERROR_UNSUPPORTED},
        {"#?RADIANCE\nEXPOSURE=0\n\n", "EXPOSURE", ALP_ERROR_INVALID_DATA},
        {"#?RADIANCE\nEXPOSURE=-2\n\n", "EXPOSURE", ALP_ERROR_INVALID_DATA},
        {"#?RADIANCE\nEXPOSURE=nan\n\n", "EXPOSURE", ALP_ERROR_INVALID_DATA},
        {"#?RADIANCE\nEXPOSURE=1e999\n\n", "EXPOSURE", ALP_ERROR_INVALID_DATA},
        {"#?RADIANCE\nCOLORCORR=1 1\n\n", "COLORCORR", ALP_ERROR_INVALID_DATA},
        {HEAD, "-Y 256 +X 512", ALP_ERROR_INVALID_DATA},
        {HEAD "Y 1 X 1\nabcd", "-Y 256 +X 512", ALP_ERROR_INVALID_DATA},
        {HEAD "-Y 1 +Y 1\nabcd", "-Y 256 +X 512", ALP_ERROR_INVALID_DATA},
        {HEAD "-Y 1\nabcd", "-Y 256 +X 512", ALP_ERROR_INVALID_DATA},
        {HEAD "-Y 0 +X 1\nabcd", "-Y 256 +X 512", ALP_ERROR_INVALID_DATA},
        {HEAD "-Y -1 +X 1\nabcd", "-Y 256 +X 512", ALP_ERROR_INVALID_DATA},
        {HEAD "-Y 65537 +X 1\nabcd", "limit", ALP_ERROR_LIMIT},
        {HEAD "-Y 1 +X 99999999999999999999999\nabcd", "limit", ALP_ERROR_LIMIT},
        {HEAD "-Y 65536 +X 65536\nabcd", "limit", ALP_ERROR_LIMIT},
        {HEAD "-Y 16384 +X 16384\nabcdefghijkl", "cannot hold", ALP_ERROR_INVALID_DATA},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        refuse(bad[i].text, strlen(bad[i].text), bad[i].result, bad[i].word);
    }
}

TEST(lines_that_are_refused)
{
#define LINE(text) (text), sizeof(text) - 1
    static const struct {
        const char *size, *data;
        size_t length;
        const char *word;
    } bad[] = {
        {"-Y 1 +X 3\n", LINE("abcdabcd"), "line 1 of 1: the file ends"},
        {"-Y 1 +X 3\n", LINE("\1\1\1\1abcdabcd"), "begins with a repetition"},
        {"-Y 2 +X 3\n", LINE("abcd\1\1\1\2abcd\1\1\1\3"), "line 2 of 2: a run is longer"},
        {"-Y 1 +X 3\n", LINE("abcd\1\1\1\0\1\1\1\0\1\1\1\0\1\1\1\1"), "a run is longer"},
        {"-Y 1 +X 8\n", LINE("\2\2\0\11\210a\210b\210c\210d"), "its length is not"},
        {"-Y 1 +X 8\n", LINE("\2\2\0\10\210a\210b\211c\210d"), "a run is longer"},
        {"-Y 1 +X 8\n", LINE("\2\2\0\10\210a\210b\11aaaaaaaaa\210d"), "a run is longer"},
        {"-Y 1 +X 8\n", LINE("\2\2\0\10\210a\210b\0\210d"), "no length"},
        {"-Y 1 +X 8\n", LINE("\2\2\0\10\210a\210b\210c\210"), "the file ends"},
        {"-Y 1 +X 8\n", LINE("\2\2\0\10\210a\210b\210c\10abc"), "the file ends"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        file f = begin(HEAD);
        put(&f, bad[i].size, strlen(bad[i].size));
        put(&f, bad[i].data, bad[i].length);
        refuse(f.bytes, f.size, ALP_ERROR_INVALID_DATA, bad[i].word);
    }
}

TEST_WITH_CONTEXT(broken_files_do_no_harm, 1)
{
    const uint32_t widths[] = {40, 5}; // in runs, and flat
    uint32_t random = 1;
    for (int i = 0; i < 2; i++) {
        alp_image *image = noise(context, widths[i], 20, 3);
        uint8_t *bytes = NULL;
        size_t size = 0;
        ASSERT_OK(context, alpi_hdr_encode(image, &bytes, &size));
        assert_true(size > 0);
        alp_image_destroy(image);
        for (size_t k = 0; size > 0 && k < size + 3000; k++) {
            size_t length = k < size ? k : size; // cut off everywhere, then changed
            // No longer than it is: sanitizers see a step past its end.
            uint8_t *copy = malloc(length > 0 ? length : 1);
            assert_non_null(copy);
            memcpy(copy, bytes, length);
            for (int flips = k < size ? 0 : 3; flips > 0; flips--) {
                copy[random_bits(&random) % size] = (uint8_t)random_bits(&random);
            }
            image = NULL;
            alp_result result = alpi_hdr_decode(context, "broken", copy, length, &image);
            assert_true((result == ALP_OK) == (image != NULL));
            assert_true(k >= size || result != ALP_OK);
            alp_image_destroy(image);
            free(copy);
        }
        alpi_release(context, bytes);
    }
}

TEST(every_failed_allocation_is_reported)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    alp_image *image = noise(context, 40, 40, 3), *again = NULL;
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    uint8_t *bytes = NULL;
    size_t size = 0;
    int allowed = 0;
    for (; result != ALP_OK; allowed++) {
        left = allowed;
        result = alpi_hdr_encode(image, &bytes, &size);
        assert_true(result == ALP_OK || (result == ALP_ERROR_OUT_OF_MEMORY && bytes == NULL));
    }
    assert_in_range(allowed, 2, 30);
    result = ALP_ERROR_OUT_OF_MEMORY;
    for (allowed = 0; result != ALP_OK; allowed++) {
        left = allowed;
        result = alpi_hdr_decode(context, "noise", bytes, size, &again);
        assert_true(result == ALP_OK || (result == ALP_ERROR_OUT_OF_MEMORY && again == NULL));
    }
    assert_int_equal(allowed, 4); // the image's two, a line, and one to see that it is enough
    left = 1000;
    alpi_release(context, bytes);
    alp_image_destroy(image);
    alp_image_destroy(again);
    alp_context_destroy(context);
}

TEST_WITH_CONTEXT(crafted_files, 1)
{
    if (test_shared("scenes/broken/crafted") == NULL) {
        skip();
    }
    alp_image *image = NULL;
    const char *const broken[] = {"scenes/broken/crafted/rle_overrun.hdr",
                                  "scenes/broken/crafted/truncated.hdr"};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(alp_image_load(context, test_shared(broken[i]), &image),
                         ALP_ERROR_INVALID_DATA);
        assert_non_null(strstr(alp_context_message(context), "line "));
    }
    ASSERT_OK(context,
              alp_image_load(context, test_shared("scenes/broken/crafted/flat_1.hdr"), &image));
    for (int i = 0; i < 8 * 4 * 3; i++) {
        ASSERT_NEAR(alp_image_floats(image)[i], 1.0, 0.0);
    }
    alp_image_destroy(image);
}
