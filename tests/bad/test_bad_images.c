// SPDX-License-Identifier: MIT
// Images whose headers promise what no file of that size can hold, or whose other parts inflate to
// more than their pixels: refused, or skipped, before memory is asked for.
#include "test_gltf.h"

#include "formats/formats.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <zlib.h>

typedef struct file {
    uint8_t bytes[1 << 20];
    size_t size;
} file;

static void put(file *f, const void *bytes, size_t size)
{
    assert_true(size <= sizeof f->bytes - f->size);
    memcpy(f->bytes + f->size, bytes, size);
    f->size += size;
}

static void put_u32(file *f, unsigned long value)
{
    const uint8_t bytes[4] = {(uint8_t)(value >> 24), (uint8_t)(value >> 16), (uint8_t)(value >> 8),
                              (uint8_t)value};
    put(f, bytes, 4);
}

static void put_chunk(file *f, const char *kind, const void *bytes, size_t size)
{
    put_u32(f, size);
    const uint8_t *begin = f->bytes + f->size;
    put(f, kind, 4);
    put(f, bytes, size);
    put_u32(f, crc32(0, begin, (unsigned)size + 4));
}

/// The signature and a header of 8 bits a channel. @param type 0 = grey, 6 = with colour and alpha
static void start_png(file *f, uint32_t width, uint32_t height, uint8_t type)
{
    const uint8_t header[13] = {(uint8_t)(width >> 24),
                                (uint8_t)(width >> 16),
                                (uint8_t)(width >> 8),
                                (uint8_t)width,
                                (uint8_t)(height >> 24),
                                (uint8_t)(height >> 16),
                                (uint8_t)(height >> 8),
                                (uint8_t)height,
                                8,
                                type};
    f->size = 0;
    put(f, "\x89PNG\r\n\x1a\n", 8);
    put_chunk(f, "IHDR", header, sizeof header);
}

/// Zeros, deflated, as the data of a picture and its end.
static void end_png(file *f, size_t raw_size)
{
    uint8_t *raw = calloc(raw_size, 1), *packed = malloc(compressBound(raw_size));
    uLongf size = compressBound(raw_size);
    assert_true(raw != NULL && packed != NULL);
    assert_int_equal(compress2(packed, &size, raw, raw_size, 9), Z_OK);
    put_chunk(f, "IDAT", packed, size);
    put_chunk(f, "IEND", "", 0);
    free(raw);
    free(packed);
}

static void check_refused(const file *f, alp_result expected, const char *words)
{
    alp_context *context = test_context(1);
    alp_image *image = NULL;
    assert_int_equal(alpi_image_decode(context, "a", f->bytes, f->size, &image), expected);
    assert_null(image);
    test_message_has(context, words);
    assert_in_range(alp_context_peak_memory(context), 0, 1 << 16);
    alp_context_destroy(context);
}

TEST_WITH_CONTEXT(sizes_that_no_file_holds, 1)
{
    static file f;
    start_png(&f, 16000, 16000, 6); // 1 GB of pixels
    end_png(&f, 100);
    check_refused(&f, ALP_ERROR_INVALID_DATA, "cannot hold 16000 x 16000 pixels: it was cut off");
    start_png(&f, 65536, 4097, 6);
    end_png(&f, 100);
    check_refused(&f, ALP_ERROR_LIMIT, "has 65536 x 4097 pixels, more than 2^28");
    // A frame header of 16000 × 16000 pixels, grey, with a table and a scan of nothing.
    static const uint8_t jpeg[] = {0xff, 0xd8, 0xff, 0xc0, 0,    11,   8,    0x3e, 0x80,
                                   0x3e, 0x80, 1,    1,    0x11, 0,    0xff, 0xda, 0,
                                   8,    1,    1,    0,    0,    0x3f, 0x00, 0xff, 0xd9};
    f.size = 0;
    put(&f, jpeg, sizeof jpeg);
    check_refused(&f, ALP_ERROR_INVALID_DATA, "27 bytes cannot hold 16000 x 16000 pixels");
    // An extended header of 2^20 × 16 pixels, as damage makes it; the format's own limit is 2^14.
    static const uint8_t webp[] = {'R', 'I', 'F',  'F', 40, 0, 0,   0,   'W', 'E', 'B', 'P',
                                   'V', 'P', '8',  'X', 10, 0, 0,   0,   0,   0,   0,   0,
                                   255, 255, 15,   15,  0,  0, 'V', 'P', '8', 'L', 10,  0,
                                   0,   0,   0x2f, 0,   0,  0, 0,   0,   0,   0,   0,   0};
    f.size = 0;
    put(&f, webp, sizeof webp);
    alp_image *image = NULL;
    alp_result result = alpi_image_decode(context, "a", f.bytes, f.size, &image);
    assert_true(result == ALP_ERROR_LIMIT || result == ALP_ERROR_INVALID_DATA);
}

/// What deflate packs best is still read: 2048² zeros in 16 KB.
TEST_WITH_CONTEXT(the_best_packed_is_read, 1)
{
    static file f;
    alp_image *image = NULL;
    start_png(&f, 2048, 2048, 6);
    end_png(&f, 2048 * (2048 * 4 + 1));
    print_message("%zu bytes\n", f.size);
    ASSERT_OK(context, alpi_image_decode(context, "a", f.bytes, f.size, &image));
    alp_image_destroy(image);
}

static long peak_kilobytes(void)
{
    struct rusage usage;
    assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
    return usage.ru_maxrss;
}

/// A hundred texts of nearly 8 MB each, which is what libpng believes: 800 MB out of 800 KB.
TEST_WITH_CONTEXT(texts_are_not_inflated, 1)
{
    enum { TEXT = 7900000, HEAD = 6, TEXTS = 100 };
    static file f;
    uint8_t *raw = calloc(TEXT, 1), *packed = malloc(HEAD + compressBound(TEXT));
    uLongf size = compressBound(TEXT);
    assert_true(raw != NULL && packed != NULL);
    memset(raw, 'a', TEXT);
    memcpy(packed, "abcd\0", HEAD); // its key and the kind of packing
    assert_int_equal(compress2(packed + HEAD, &size, raw, TEXT, 9), Z_OK);
    free(raw);
    start_png(&f, 1, 1, 0);
    for (int i = 0; i < TEXTS; i++) {
        put_chunk(&f, "zTXt", packed, HEAD + size);
    }
    end_png(&f, 2);
    free(packed);
    alp_image *image = NULL;
    const long before = peak_kilobytes();
    ASSERT_OK(context, alpi_image_decode(context, "a", f.bytes, f.size, &image));
    const long more = peak_kilobytes() - before;
    print_message("%zu bytes, %ld KB\n", f.size, more);
    assert_in_range(more, 0, 64 * 1024);
    alp_image_destroy(image);
}
