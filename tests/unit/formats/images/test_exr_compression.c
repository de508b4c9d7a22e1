// SPDX-License-Identifier: MIT
// OpenEXR files of each compression, half and float, pictures that compress and pictures that do
// not: read back bit for bit. Written here by OpenEXRCore itself, in blocks as its format says.
#include "test_support.h"

#include "base/random.h"
#include "formats/formats.h"

#include <math.h>
#include <openexr.h>
#include <stdlib.h>

enum { WIDTH = 203, HEIGHT = 75, CHANNELS = 4 }; // 2⅓ blocks of PIZ, 4⅔ of ZIP

/// Numbers that a half holds: smooth, or noise over many powers of two.
static float value_at(uint32_t x, uint32_t y, uint32_t channel, bool is_noise)
{
    if (!is_noise) {
        return (float)(x / 8) * 0.25f + (float)(y / 4) * 2.0f + (float)channel;
    }
    uint32_t bits = alpi_hash32(x + 1024 * y + (1u << 20) * channel);
    float value = ldexpf((float)(1024 + (bits & 1023)), (int)((bits >> 10) % 28) - 23);
    return bits >> 31 ? -value : value;
}

static float *make_pixels(bool is_noise)
{
    float *pixels = malloc(sizeof(float) * WIDTH * HEIGHT * CHANNELS);
    assert_non_null(pixels);
    for (uint32_t i = 0; i < WIDTH * HEIGHT * CHANNELS; i++) {
        uint32_t pixel = i / CHANNELS;
        pixels[i] = value_at(pixel % WIDTH, pixel / WIDTH, i % CHANNELS, is_noise);
    }
    return pixels;
}

#define ASSERT_EXR(call) assert_int_equal((call), EXR_ERR_SUCCESS)

static void write_lines(exr_context_t exr, float *pixels)
{
    static const char names[] = "RGBA";
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    int32_t lines = 0;
    ASSERT_EXR(exr_get_scanlines_per_chunk(exr, 0, &lines));
    for (int32_t y = 0; y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        ASSERT_EXR(exr_write_scanline_chunk_info(exr, 0, y, &chunk));
        if (y == 0) {
            ASSERT_EXR(exr_encoding_initialize(exr, 0, &chunk, &encode));
        } else {
            ASSERT_EXR(exr_encoding_update(exr, 0, &chunk, &encode));
        }
        for (int i = 0; i < encode.channel_count; i++) {
            exr_coding_channel_info_t *c = &encode.channels[i];
            const char *name = strchr(names, c->channel_name[0]);
            c->user_bytes_per_element = sizeof(float);
            c->user_data_type = EXR_PIXEL_FLOAT;
            c->user_pixel_stride = CHANNELS * sizeof(float);
            c->user_line_stride = WIDTH * CHANNELS * sizeof(float);
            float *first = pixels + (size_t)y * WIDTH * CHANNELS + (name - names);
            c->encode_from_ptr = (const uint8_t *)first;
        }
        if (y == 0) {
            ASSERT_EXR(exr_encoding_choose_default_routines(exr, 0, &encode));
        }
        ASSERT_EXR(exr_encoding_run(exr, 0, &encode));
    }
    ASSERT_EXR(exr_encoding_destroy(exr, &encode));
}

static void write_file(const char *path, float *pixels, exr_compression_t compression,
                       exr_pixel_type_t type)
{
    exr_context_t exr = NULL;
    exr_context_initializer_t options = EXR_DEFAULT_CONTEXT_INITIALIZER;
    int part = 0;
    ASSERT_EXR(exr_start_write(&exr, path, EXR_WRITE_FILE_DIRECTLY, &options));
    ASSERT_EXR(exr_add_part(exr, NULL, EXR_STORAGE_SCANLINE, &part));
    ASSERT_EXR(exr_initialize_required_attr_simple(exr, part, WIDTH, HEIGHT, compression));
    for (int k = 0; k < CHANNELS; k++) {
        const char name[2] = {"RGBA"[k], 0};
        ASSERT_EXR(exr_add_channel(exr, part, name, type, EXR_PERCEPTUALLY_LINEAR, 1, 1));
    }
    ASSERT_EXR(exr_write_header(exr));
    write_lines(exr, pixels);
    ASSERT_EXR(exr_finish(&exr));
}

static void check(exr_compression_t compression, exr_pixel_type_t type, bool is_noise)
{
    alp_context *context = test_context(1);
    const char *path = test_path(test_folder(), "a.exr");
    float *pixels = make_pixels(is_noise);
    write_file(path, pixels, compression, type);
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_load(context, path, &image));
    alp_image_info info = alp_image_get_info(image);
    assert_int_equal(info.width, WIDTH);
    assert_int_equal(info.height, HEIGHT);
    assert_int_equal(info.channels, CHANNELS);
    assert_memory_equal(alp_image_floats(image), pixels, sizeof(float) * WIDTH * HEIGHT * CHANNELS);
    alp_image_destroy(image);
    free(pixels);
    alp_context_destroy(context);
}

TEST(every_compression_without_loss)
{
    const exr_compression_t kinds[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,
                                       EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                                       EXR_COMPRESSION_PIZ};
    for (int i = 0; i < 5; i++) {
        check(kinds[i], EXR_PIXEL_HALF, false);
        check(kinds[i], EXR_PIXEL_HALF, true);
        check(kinds[i], EXR_PIXEL_FLOAT, false);
        check(kinds[i], EXR_PIXEL_FLOAT, true);
    }
}

/// Bytes of each compressed file changed: whatever comes out, nothing breaks (the sanitizer builds
/// look closer).
TEST_WITH_CONTEXT(broken_files_do_no_harm, 1)
{
    const exr_compression_t kinds[] = {EXR_COMPRESSION_RLE, EXR_COMPRESSION_ZIPS,
                                       EXR_COMPRESSION_PIZ};
    const char *path = test_path(test_folder(), "a.exr");
    float *pixels = make_pixels(false);
    for (int i = 0; i < 3; i++) {
        write_file(path, pixels, kinds[i], EXR_PIXEL_HALF);
        size_t size = 0;
        unsigned char *bytes = test_read_file(path, &size);
        for (uint32_t k = 0; k < 300; k++) {
            size_t place = alpi_hash32(k + 1) % size;
            unsigned char kept = bytes[place];
            bytes[place] = (unsigned char)alpi_hash32(k + 1000);
            alp_image *image = NULL;
            alp_result result = alpi_exr_decode(context, "broken", bytes, size, &image);
            assert_true((result == ALP_OK) == (image != NULL));
            alp_image_destroy(image);
            bytes[place] = kept;
        }
        free(bytes);
    }
    free(pixels);
}

/// The two skies as their makers store them are of a kind that is not read.
TEST_WITH_CONTEXT(lossy_skies_are_refused_by_name, 1)
{
    const char *const files[] = {"scenes/hdr/interior.exr", "scenes/hdr/sunset.exr"};
    if (test_shared(files[0]) == NULL) {
        skip();
    }
    alp_image *image = NULL;
    for (int i = 0; i < 2; i++) {
        assert_int_equal(alp_image_load(context, test_shared(files[i]), &image),
                         ALP_ERROR_UNSUPPORTED);
        assert_non_null(strstr(alp_context_message(context),
                               ".exr: DWAB compression is not supported; convert it to ZIP"));
    }
}
