// SPDX-License-Identifier: MIT
// OpenEXR: what is written comes back bit for bit; files of other writers, built here byte by byte,
// are read; what is broken or not supported is refused by name.
#include "test_support.h"

#include "base/memory.h"
#include "formats/formats.h"

#include <math.h>
#include <stdlib.h>

static uint32_t random_bits(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static alp_image *noise(alp_context *context, uint32_t width, uint32_t height, uint32_t channels)
{
    alp_image_info info = {width, height, channels, ALP_COMPONENT_FLOAT};
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &image));
    float *pixels = alp_image_floats(image);
    uint32_t state = width + 7 * height;
    for (size_t i = 0; i < (size_t)width * height * channels; i++) {
        pixels[i] = (float)random_bits(&state) * 0x1p-20f - 3.0f;
    }
    pixels[0] = 1e-42f; // denormal, and values a half could not hold
    pixels[width * height * channels - 1] = -3e38f;
    return image;
}

TEST_WITH_CONTEXT(what_is_written_comes_back, 1)
{
    const uint32_t sizes[][2] = {{1, 1}, {3, 50}, {64, 16}, {130, 33}};
    for (uint32_t channels = 1; channels <= 4; channels++) {
        for (int i = 0; i < 4; i++) {
            alp_image *image = noise(context, sizes[i][0], sizes[i][1], channels), *again = NULL;
            uint8_t *bytes = NULL;
            size_t size = 0;
            ASSERT_OK(context, alpi_exr_encode(image, &bytes, &size));
            ASSERT_OK(context, alpi_exr_decode(context, "noise", bytes, size, &again));
            alp_image_info info = alp_image_get_info(again);
            assert_int_equal(info.width, sizes[i][0]);
            assert_int_equal(info.height, sizes[i][1]);
            assert_int_equal(info.channels, channels);
            assert_memory_equal(alp_image_floats(again), alp_image_floats(image),
                                sizeof(float) * info.width * info.height * channels);
            alpi_release(context, bytes);
            alp_image_destroy(image);
            alp_image_destroy(again);
        }
    }
}

TEST_WITH_CONTEXT(not_a_number_survives, 1)
{
    alp_image *image = noise(context, 2, 2, 1), *again = NULL;
    alp_image_floats(image)[1] = NAN;
    alp_image_floats(image)[2] = INFINITY;
    uint8_t *bytes = NULL;
    size_t size = 0;
    ASSERT_OK(context, alpi_exr_encode(image, &bytes, &size));
    ASSERT_OK(context, alpi_exr_decode(context, "nan", bytes, size, &again));
    assert_true(isnan(alp_image_floats(again)[1]));
    assert_true(isinf(alp_image_floats(again)[2]));
    alpi_release(context, bytes);
    alp_image_destroy(image);
    alp_image_destroy(again);
}

// --- files of another writer ---------------------------------------------------------------------

enum { PIXEL_UINT = 0, PIXEL_HALF = 1, PIXEL_FLOAT = 2, FILE_ROOM = 1 << 16 };

/// An uncompressed file of WIDTH × HEIGHT pixels written by hand after the layout of the OpenEXR
/// specification (little endian).
typedef struct file {
    unsigned char bytes[FILE_ROOM];
    size_t size;
} file;

static void put(file *f, const void *bytes, size_t size)
{
    assert_true(f->size + size <= FILE_ROOM);
    memcpy(f->bytes + f->size, bytes, size);
    f->size += size;
}

static void put_int(file *f, int32_t value)
{
    put(f, &value, 4);
}

static void put_attribute(file *f, const char *name, const char *type, const void *value,
                          int32_t size)
{
    put(f, name, strlen(name) + 1);
    put(f, type, strlen(type) + 1);
    put_int(f, size);
    put(f, value, (size_t)size);
}

typedef struct layout {
    const char *channels; // one letter each, sorted; "u" holds integers, "v" every second pixel
    int32_t pixel_type;
    int32_t min_x, min_y, width, height;
    int32_t tile; // 0 = scanlines
    unsigned char compression;
} layout;

static void put_header(file *f, const layout *l)
{
    put_int(f, 20000630);
    put_int(f, 2 | (l->tile ? 0x200 : 0));
    file list = {.size = 0};
    for (const char *c = l->channels; *c; c++) {
        const char name[2] = {*c, 0};
        put(&list, name, 2);
        put_int(&list, *c == 'u' ? PIXEL_UINT : l->pixel_type);
        put_int(&list, 0);
        put_int(&list, *c == 'v' ? 2 : 1);
        put_int(&list, 1);
    }
    put(&list, "", 1);
    put_attribute(f, "channels", "chlist", list.bytes, (int32_t)list.size);
    put_attribute(f, "compression", "compression", &l->compression, 1);
    int32_t window[4] = {l->min_x, l->min_y, l->min_x + l->width - 1, l->min_y + l->height - 1};
    put_attribute(f, "dataWindow", "box2i", window, 16);
    put_attribute(f, "displayWindow", "box2i", window, 16);
    put_attribute(f, "lineOrder", "lineOrder", "\0", 1);
    float one = 1.0f, center[2] = {0.0f, 0.0f};
    put_attribute(f, "pixelAspectRatio", "float", &one, 4);
    put_attribute(f, "screenWindowCenter", "v2f", center, 8);
    put_attribute(f, "screenWindowWidth", "float", &one, 4);
    if (l->tile) {
        unsigned char tiles[9] = {0};
        memcpy(tiles, &l->tile, 4);
        memcpy(tiles + 4, &l->tile, 4);
        put_attribute(f, "tiles", "tiledesc", tiles, 9);
    }
    put(f, "", 1);
}

/// Small whole numbers, exact in half: 10 per row, 1 per column, 70 per channel letter.
static int value_at(int x, int y, char channel)
{
    return x + 10 * y + 70 * (channel - 'A');
}

static void put_value(file *f, int32_t pixel_type, int value)
{
    float number = (float)value;
    uint32_t bits = 0;
    memcpy(&bits, &number, 4);
    // Normal numbers only: 5 bits of exponent about 15, 10 of mantissa.
    uint16_t half =
        value == 0 ? 0 : (uint16_t)((((bits >> 23) - 112) << 10) | ((bits >> 13) & 1023));
    if (pixel_type == PIXEL_HALF) {
        put(f, &half, 2);
    } else if (pixel_type == PIXEL_FLOAT) {
        put(f, &number, 4);
    } else {
        put_int(f, value);
    }
}

static void put_block(file *f, const layout *l, const int32_t from[2], const int32_t to[2])
{
    size_t start = f->size;
    put_int(f, 0);
    for (int32_t y = from[1]; y < to[1]; y++) {
        for (const char *c = l->channels; *c; c++) {
            int32_t step = *c == 'v' ? 2 : 1;
            for (int32_t x = from[0]; x < to[0]; x += step) {
                put_value(f, *c == 'u' ? PIXEL_UINT : l->pixel_type, value_at(x, y, *c));
            }
        }
    }
    int32_t size = (int32_t)(f->size - start - 4);
    memcpy(f->bytes + start, &size, 4);
}

static int32_t smaller(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static void put_file(file *f, const layout *l)
{
    f->size = 0;
    put_header(f, l);
    int32_t step_x = l->tile ? l->tile : l->width, step_y = l->tile ? l->tile : 1;
    int32_t columns = (l->width + step_x - 1) / step_x, rows = (l->height + step_y - 1) / step_y;
    size_t table = f->size;
    f->size += 8 * (size_t)(columns * rows);
    for (int32_t i = 0; i < columns * rows; i++) {
        uint64_t offset = f->size;
        memcpy(f->bytes + table + 8 * (size_t)i, &offset, 8);
        int32_t from[2] = {i % columns * step_x, i / columns * step_y};
        int32_t to[2] = {smaller(from[0] + step_x, l->width), smaller(from[1] + step_y, l->height)};
        if (l->tile) {
            put_int(f, i % columns);
            put_int(f, i / columns);
            put_int(f, 0);
            put_int(f, 0);
        } else {
            put_int(f, l->min_y + from[1]);
        }
        put_block(f, l, from, to);
    }
}

static void check_file(const layout *l, const char *expected_channels)
{
    static file f;
    put_file(&f, l);
    alp_context *context = test_context(1);
    alp_image *image = NULL;
    ASSERT_OK(context, alpi_exr_decode(context, "built", f.bytes, f.size, &image));
    alp_image_info info = alp_image_get_info(image);
    assert_int_equal(info.width, l->width);
    assert_int_equal(info.height, l->height);
    assert_int_equal(info.channels, strlen(expected_channels));
    const float *pixel = alp_image_floats(image);
    for (int y = 0; y < l->height; y++) {
        for (int x = 0; x < l->width; x++) {
            for (const char *c = expected_channels; *c; c++) {
                ASSERT_NEAR(*pixel++, value_at(x, y, *c), 0.0);
            }
        }
    }
    alp_image_destroy(image);
    alp_context_destroy(context);
}

TEST(files_of_others_are_read)
{
    layout l = {.channels = "BGR", .pixel_type = PIXEL_FLOAT, .width = 9, .height = 7};
    check_file(&l, "RGB");
    l.pixel_type = PIXEL_HALF;
    check_file(&l, "RGB");
    l.channels = "ABGR";
    l.min_x = -4; // the data window is what is stored, wherever it lies
    l.min_y = -30;
    check_file(&l, "RGBA");
    l.channels = "ABGRXYZ"; // more than we want
    check_file(&l, "RGBA");
    l.channels = "Y";
    check_file(&l, "Y");
    l.channels = "AYZ";
    check_file(&l, "YA");
    l.channels = "ABGRu";
    check_file(&l, "RGBA");
    l.channels = "ABGRv";
    l.width = 8;
    check_file(&l, "RGBA");
    l.pixel_type = PIXEL_FLOAT;
    check_file(&l, "RGBA");
}

TEST(tiles_are_read)
{
    layout l = {.channels = "ABGR", .pixel_type = PIXEL_HALF, .width = 9, .height = 7, .tile = 4};
    check_file(&l, "RGBA");
    l.tile = 16; // one tile, larger than the image
    check_file(&l, "RGBA");
    l.tile = 1;
    l.pixel_type = PIXEL_FLOAT;
    check_file(&l, "RGBA");
}

static void refuse(const layout *l, alp_result expected, const char *word)
{
    static file f;
    put_file(&f, l);
    alp_context *context = test_context(1);
    alp_image *image = NULL;
    assert_int_equal(alpi_exr_decode(context, "odd.exr", f.bytes, f.size, &image), expected);
    assert_null(image);
    assert_non_null(strstr(alp_context_message(context), "odd.exr"));
    if (strstr(alp_context_message(context), word) == NULL) {
        fail_msg("\"%s\" is not in: %s", word, alp_context_message(context));
    }
    alp_context_destroy(context);
}

TEST(what_cannot_be_read_is_named)
{
    const layout good = {.channels = "BGR", .pixel_type = PIXEL_HALF, .width = 9, .height = 7};
    layout l = good;
    l.compression = 8;
    refuse(&l, ALP_ERROR_UNSUPPORTED, "DWAA");
    l.compression = 9;
    refuse(&l, ALP_ERROR_UNSUPPORTED, "DWAB");
    l = good;
    l.channels = "GR";
    refuse(&l, ALP_ERROR_UNSUPPORTED, "neither channels R, G, B nor Y");
    l = good;
    l.pixel_type = PIXEL_UINT;
    refuse(&l, ALP_ERROR_UNSUPPORTED, "integers");
}

TEST_WITH_CONTEXT(a_promise_that_cannot_be_kept, 1)
{
    static file f;
    layout l = {.channels = "BGR", .pixel_type = PIXEL_HALF, .width = 9, .height = 7};
    alp_image *image = NULL;
    put_file(&f, &l);
    int32_t *window = NULL;
    for (size_t i = 0; i + 10 < f.size && window == NULL; i++) {
        window =
            memcmp(f.bytes + i, "dataWindow", 10) == 0 ? (int32_t *)(void *)(f.bytes + i) : NULL;
    }
    assert_non_null(window);
    unsigned char *maximum = (unsigned char *)window + 11 + 6 + 4 + 8;
    const int32_t large[2] = {39999, 5999}, huge[2] = {99999, 99};
    memcpy(maximum, large, 8);
    assert_int_equal(alpi_exr_decode(context, "large", f.bytes, f.size, &image),
                     ALP_ERROR_INVALID_DATA);
    assert_non_null(strstr(alp_context_message(context), "cannot hold"));
    memcpy(maximum, huge, 8);
    assert_int_equal(alpi_exr_decode(context, "huge", f.bytes, f.size, &image), ALP_ERROR_LIMIT);
}

TEST_WITH_CONTEXT(broken_files_do_no_harm, 1)
{
    static file built;
    alp_image *image = noise(context, 40, 20, 4);
    uint8_t *bytes = NULL;
    size_t size = 0;
    ASSERT_OK(context, alpi_exr_encode(image, &bytes, &size));
    alp_image_destroy(image);
    layout l = {.channels = "BGR", .pixel_type = PIXEL_HALF, .width = 9, .height = 7, .tile = 4};
    put_file(&built, &l);
    const uint8_t *files[2] = {bytes, built.bytes};
    const size_t sizes[2] = {size, built.size};
    uint32_t random = 1;
    for (int i = 0; i < 2; i++) {
        uint8_t *copy = malloc(sizes[i]);
        assert_non_null(copy);
        for (int k = 0; k < 600; k++) {
            size_t length = k < 300 ? random_bits(&random) % sizes[i] : sizes[i];
            memcpy(copy, files[i], sizes[i]);
            for (int flips = k < 300 ? 0 : 3; flips > 0; flips--) {
                copy[random_bits(&random) % sizes[i]] ^= (uint8_t)(1u << random_bits(&random) % 8);
            }
            image = NULL;
            alp_result result = alpi_exr_decode(context, "broken", copy, length, &image);
            assert_true((result == ALP_OK) == (image != NULL));
            assert_true(k >= 300 || result != ALP_OK);
            alp_image_destroy(image);
        }
        free(copy);
    }
    alpi_release(context, bytes);
}

TEST(every_failed_allocation_is_reported)
{
    int allocations_left = 0;
    alp_context *context = test_context_failing(&allocations_left);
    alp_image *image = noise(context, 40, 40, 4), *again = NULL;
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    uint8_t *bytes = NULL;
    size_t size = 0;
    int allowed = 0;
    for (; result != ALP_OK; allowed++) {
        allocations_left = allowed;
        result = alpi_exr_encode(image, &bytes, &size);
        assert_true(result == ALP_OK || (result == ALP_ERROR_OUT_OF_MEMORY && bytes == NULL));
    }
    assert_in_range(allowed, 2, 60);
    result = ALP_ERROR_OUT_OF_MEMORY;
    for (allowed = 0; result != ALP_OK; allowed++) {
        allocations_left = allowed;
        result = alpi_exr_decode(context, "noise", bytes, size, &again);
        assert_true(result == ALP_OK || (result == ALP_ERROR_OUT_OF_MEMORY && again == NULL));
    }
    assert_in_range(allowed, 3, 10);
    alpi_release(context, bytes);
    alp_image_destroy(image);
    alp_image_destroy(again);
    alp_context_destroy(context);
}

TEST_WITH_CONTEXT(bytes_are_not_encoded, 1)
{
    alp_image_info info = {2, 2, 3, ALP_COMPONENT_U8};
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &image));
    uint8_t *bytes = NULL;
    size_t size = 0;
    assert_int_equal(alpi_exr_encode(image, &bytes, &size), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(bytes);
    alp_image_destroy(image);
}

TEST(the_stored_reference_is_read)
{
    const char *path = test_shared("peers/blender/ref_cornell_ao_256.exr");
    if (path == NULL) {
        skip();
    }
    size_t size = 0;
    unsigned char *bytes = test_read_file(path, &size);
    alp_context *context = test_context(1);
    alp_image *image = NULL;
    ASSERT_OK(context, alpi_exr_decode(context, path, bytes, size, &image));
    alp_image_info info = alp_image_get_info(image);
    assert_int_equal(info.width, 256);
    assert_int_equal(info.height, 256);
    assert_int_equal(info.channels, 4);
    alp_image_destroy(image);
    alp_context_destroy(context);
    free(bytes);
}
