// SPDX-License-Identifier: MIT
// PNG and JPEG in memory: what is encoded comes back, and files of every colour kind are read.
#include "test_support.h"

#include "base/memory.h"
#include "formats/formats.h"

#include <stdio.h>
#include <stdlib.h>

// libjpeg needs stdio.h before it
#include <jpeglib.h>
#include <png.h>

TEST_WITH_CONTEXT(png_round_trip, 1)
{
    for (uint32_t channels = 1; channels <= 4; channels++) {
        alp_image *image, *again;
        uint8_t *bytes;
        size_t size;
        alp_image_info info = {37, 23, channels, ALP_COMPONENT_U8};
        ASSERT_OK(context, alp_image_create(context, info, &image));
        for (uint32_t i = 0; i < 37 * 23 * channels; i++) {
            alp_image_bytes(image)[i] = (uint8_t)(i * 7 + i / 64);
        }
        ASSERT_OK(context, alpi_png_encode(image, &bytes, &size));
        ASSERT_OK(context, alpi_image_decode(context, "x.png", bytes, size, &again));
        alp_image_info read = alp_image_get_info(again);
        assert_memory_equal(&read, &info, sizeof info);
        assert_memory_equal(alp_image_bytes(again), alp_image_bytes(image), 37 * 23 * channels);
        alp_image_destroy(again);
        for (size_t cut = 0; cut < size; cut += 5) {
            assert_int_equal(alpi_png_decode(context, "x.png", bytes, cut, &again),
                             ALP_ERROR_INVALID_DATA);
            assert_null(again);
        }
        alpi_release(context, bytes);
        alp_image_destroy(image);
    }
}

typedef struct png_bytes {
    const uint8_t *bytes;
    size_t place;
} png_bytes;

static void take(png_structp png, png_bytep data, size_t length)
{
    png_bytes *from = png_get_io_ptr(png);
    memcpy(data, from->bytes + from->place, length);
    from->place += length;
}

static void read_texts(const uint8_t *bytes, png_structp *png, png_infop *info, png_textp *texts,
                       int *count)
{
    png_bytes from = {bytes, 0};
    *png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    *info = png_create_info_struct(*png);
    png_set_read_fn(*png, &from, take);
    png_read_info(*png, *info); // texts stand before the pixels
    png_get_text(*png, *info, texts, count);
}

static alp_image *small_image(alp_context *context)
{
    alp_image *image = NULL;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){2, 2, 3, ALP_COMPONENT_U8}, &image));
    return image;
}

TEST_WITH_CONTEXT(png_carries_texts, 1)
{
    alp_image *image = small_image(context);
    uint8_t *bytes;
    size_t size;
    png_structp png;
    png_infop info;
    png_textp texts;
    int count = 0;
    ASSERT_OK(context, alp_image_add_text(image, "Command", "view caf\xc3\xa9.glb"));
    ASSERT_OK(context, alp_image_add_text(image, "Camera", ""));
    ASSERT_OK(context, alpi_png_encode(image, &bytes, &size));
    read_texts(bytes, &png, &info, &texts, &count);
    assert_int_equal(count, 2);
    assert_string_equal(texts[0].key, "Command");
    assert_string_equal(texts[0].text, "view caf\xc3\xa9.glb");
    assert_string_equal(texts[1].key, "Camera");
    assert_string_equal(texts[1].text, "");
    png_destroy_read_struct(&png, &info, NULL);
    alpi_release(context, bytes);
    alp_image_destroy(image);
}

TEST_WITH_CONTEXT(keys_that_png_does_not_know_are_refused, 1)
{
    static const char *const wrong[] = {"", " a", "a ", "a\n", "caf\xc3\xa9"};
    char longest[81] = {0};
    alp_image *image = small_image(context);
    memset(longest, 'k', 79);
    ASSERT_OK(context, alp_image_add_text(image, longest, "text"));
    longest[79] = 'k';
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    assert_int_equal(alp_image_add_text(image, longest, "text"), code);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(alp_image_add_text(image, wrong[i], "text"), code);
    }
    assert_int_equal(alp_image_add_text(image, NULL, "text"), code);
    assert_int_equal(alp_image_add_text(image, "key", NULL), code);
    assert_int_equal(alp_image_add_text(NULL, "key", "text"), code);
    alp_image_destroy(image);
}

TEST(texts_survive_failed_allocations)
{
    int left = 1000;
    alp_context *context = test_context_failing(&left);
    alp_image *image = small_image(context);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    for (int allowed = 0; result != ALP_OK; allowed++) {
        left = allowed;
        result = alp_image_add_text(image, "key", "text");
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
    }
    left = 1000;
    alp_image_destroy(image);
    alp_context_destroy(context);
}

TEST_WITH_CONTEXT(floats_are_refused, 1)
{
    alp_image *image;
    uint8_t *bytes;
    size_t size;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){2, 2, 3, ALP_COMPONENT_FLOAT}, &image));
    assert_int_equal(alpi_png_encode(image, &bytes, &size), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(bytes);
    alp_image_destroy(image);
}

static void append(png_structp png, png_bytep data, size_t length)
{
    uint8_t **end = png_get_io_ptr(png);
    memcpy(*end, data, length);
    *end += length;
}

static void flush(png_structp png)
{
    (void)png;
}

/// One row of 4 pixels as a PNG of any kind.
static size_t write_png(uint8_t *bytes, int depth, int type, const uint8_t *row, int transparent)
{
    uint8_t *end = bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &end, append, flush);
    png_set_IHDR(png, info, 4, 1, depth, type, PNG_INTERLACE_ADAM7, 0, 0);
    if (type == PNG_COLOR_TYPE_PALETTE) {
        static const png_color palette[] = {{10, 20, 30}, {40, 50, 60}};
        static const png_byte alpha[] = {255, 128};
        png_set_PLTE(png, info, palette, 2);
        if (transparent) {
            png_set_tRNS(png, info, alpha, 2, NULL);
        }
    }
    png_write_info(png, info);
    png_bytep rows[1] = {malloc(64)};
    memcpy(rows[0], row, 32);
    png_write_image(png, rows);
    png_write_end(png, NULL);
    free(rows[0]);
    png_destroy_write_struct(&png, &info);
    return (size_t)(end - bytes);
}

static void check_png(const uint8_t *bytes, size_t size, uint32_t channels, const uint8_t *expected)
{
    alp_context *context = test_context(1);
    alp_image *image;
    ASSERT_OK(context, alpi_png_decode(context, "x.png", bytes, size, &image));
    assert_int_equal(alp_image_get_info(image).channels, channels);
    assert_memory_equal(alp_image_bytes(image), expected, 4 * (size_t)channels);
    alp_image_destroy(image);
    alp_context_destroy(context);
}

TEST(png_kinds)
{
    uint8_t bytes[4096];
    const uint8_t bits[32] = {0x50}; // 0 1 0 1
    // grey of 1 bit, interlaced
    size_t size = write_png(bytes, 1, PNG_COLOR_TYPE_GRAY, bits, 0);
    check_png(bytes, size, 1, (const uint8_t[]){0, 255, 0, 255});
    // palette, without and with transparency
    size = write_png(bytes, 1, PNG_COLOR_TYPE_PALETTE, bits, 0);
    check_png(bytes, size, 3, (const uint8_t[]){10, 20, 30, 40, 50, 60, 10, 20, 30, 40, 50, 60});
    size = write_png(bytes, 1, PNG_COLOR_TYPE_PALETTE, bits, 1);
    check_png(
        bytes, size, 4,
        (const uint8_t[]){10, 20, 30, 255, 40, 50, 60, 128, 10, 20, 30, 255, 40, 50, 60, 128});
    // 16 bits are rounded, not cut: 0x00ff → 1
    const uint8_t deep[32] = {0x00, 0xff, 0x80, 0x80, 0xff, 0xff, 0x12, 0x34};
    size = write_png(bytes, 16, PNG_COLOR_TYPE_GRAY, deep, 0);
    check_png(bytes, size, 1, (const uint8_t[]){1, 0x80, 0xff, 0x12});
}

/// 16 × 16 pixels of one colour as a JPEG.
static size_t write_jpeg(unsigned char **bytes, J_COLOR_SPACE space, const uint8_t *color,
                         int components)
{
    struct jpeg_compress_struct encoder;
    struct jpeg_error_mgr errors;
    unsigned long size = 0;
    encoder.err = jpeg_std_error(&errors);
    jpeg_create_compress(&encoder);
    *bytes = NULL;
    jpeg_mem_dest(&encoder, bytes, &size);
    encoder.image_width = encoder.image_height = 16;
    encoder.input_components = components;
    encoder.in_color_space = space;
    jpeg_set_defaults(&encoder);
    jpeg_set_quality(&encoder, 95, TRUE);
    jpeg_start_compress(&encoder, TRUE);
    uint8_t row[64];
    for (int i = 0; i < 64; i++) {
        row[i] = color[i % components];
    }
    JSAMPROW rows[1] = {row};
    while (encoder.next_scanline < 16) {
        jpeg_write_scanlines(&encoder, rows, 1);
    }
    jpeg_finish_compress(&encoder);
    jpeg_destroy_compress(&encoder);
    return (size_t)size;
}

static void check_jpeg(J_COLOR_SPACE space, const uint8_t *color, int components, uint32_t channels,
                       const uint8_t *expected)
{
    unsigned char *bytes;
    size_t size = write_jpeg(&bytes, space, color, components);
    alp_context *context = test_context(1);
    alp_image *image;
    ASSERT_OK(context, alpi_image_decode(context, "x.jpg", bytes, size, &image));
    alp_image_info info = alp_image_get_info(image);
    assert_int_equal(info.width, 16);
    assert_int_equal(info.height, 16);
    assert_int_equal(info.channels, channels);
    for (uint32_t i = 0; i < 256 * channels; i++) {
        ASSERT_NEAR(alp_image_bytes(image)[i], expected[i % channels], 3.0);
    }
    alp_image_destroy(image);
    for (size_t cut = 0; cut + 4 < size; cut += 7) { // the end marker alone may be missing
        assert_int_equal(alpi_jpeg_decode(context, "x.jpg", bytes, cut, &image),
                         ALP_ERROR_INVALID_DATA);
        assert_null(image);
        assert_non_null(strstr(alp_context_message(context), "x.jpg: JPEG"));
    }
    free(bytes);
    alp_context_destroy(context);
}

TEST(jpeg_kinds)
{
    check_jpeg(JCS_GRAYSCALE, (const uint8_t[]){90}, 1, 1, (const uint8_t[]){90});
    check_jpeg(JCS_RGB, (const uint8_t[]){200, 100, 50}, 3, 3, (const uint8_t[]){200, 100, 50});
    // libjpeg writes CMYK with Adobe's marker: values are complements of ink
    check_jpeg(JCS_CMYK, (const uint8_t[]){255, 128, 64, 200}, 4, 3,
               (const uint8_t[]){200, 100, 50});
}

TEST_WITH_CONTEXT(huge_images_are_refused, 1)
{
    alp_image *image;
    uint8_t bytes[4096];
    const uint8_t row[32] = {0};
    size_t size = write_png(bytes, 8, PNG_COLOR_TYPE_GRAY, row, 0);
    static const uint8_t sides[8] = {0, 0, 0xff, 0xff, 0, 0, 0xff, 0xff};
    memcpy(bytes + 16, sides, 8); // 65535², the check sum is now wrong
    assert_int_not_equal(alpi_png_decode(context, "x.png", bytes, size, &image), ALP_OK);
    assert_null(image);
    assert_in_range(alp_context_peak_memory(context), 0, 1 << 20);
    // a JPEG header has no check sum: the size is refused before memory is asked for
    unsigned char *jpeg;
    size = write_jpeg(&jpeg, JCS_GRAYSCALE, row, 1);
    for (size_t i = 0; i + 9 < size; i++) {
        if (jpeg[i] == 0xff && jpeg[i + 1] == 0xc0) { // start of frame: height, width at 5
            memset(jpeg + i + 5, 0xf0, 4);
        }
    }
    assert_int_equal(alpi_jpeg_decode(context, "x.jpg", jpeg, size, &image), ALP_ERROR_LIMIT);
    assert_in_range(alp_context_peak_memory(context), 0, 1 << 20);
    free(jpeg);
    assert_int_equal(alpi_image_decode(context, "x.gif", (const uint8_t *)"GIF89a", 6, &image),
                     ALP_ERROR_INVALID_DATA);
    assert_int_equal(alpi_image_decode(context, "x", NULL, 0, &image), ALP_ERROR_INVALID_DATA);
}
