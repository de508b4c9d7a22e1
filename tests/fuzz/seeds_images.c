// SPDX-License-Identifier: MIT
// Small images of every kind that is read, by our encoders and by those of the libraries.
#include "seeds.h"

#include "base/image.h"
#include "base/memory.h"
#include "formats/formats.h"

#include <openexr.h>
#include <png.h>
#include <webp/encode.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// libjpeg needs stdio.h before it
#include <jpeglib.h>

enum { WIDTH = 21, HEIGHT = 18 };

static uint8_t value_at(int x, int y, int channel)
{
    return (uint8_t)(x * 11 + y * (7 + 3 * channel) + channel * 50);
}

static alp_image *make_image(alp_context *context, uint32_t channels, alp_component component)
{
    alp_image *image = NULL;
    if (alp_image_create(context, (alp_image_info){WIDTH, HEIGHT, channels, component}, &image) !=
        ALP_OK) {
        seed_fail("no image");
    }
    for (uint32_t i = 0; i < WIDTH * HEIGHT * channels; i++) {
        const int pixel = (int)(i / channels);
        const uint8_t value = value_at(pixel % WIDTH, pixel / WIDTH, (int)(i % channels));
        if (component == ALP_COMPONENT_U8) {
            alp_image_bytes(image)[i] = value;
        } else {
            alp_image_floats(image)[i] = (float)value / 64.0f;
        }
    }
    return image;
}

static void put_ours(alp_context *context, const char *target, const char *name, uint32_t channels,
                     alp_result encode(const alp_image *, uint8_t **, size_t *))
{
    const bool bytes_only = encode == alpi_png_encode;
    alp_image *image =
        make_image(context, channels, bytes_only ? ALP_COMPONENT_U8 : ALP_COMPONENT_FLOAT);
    uint8_t *bytes = NULL;
    size_t size = 0;
    if (encode(image, &bytes, &size) != ALP_OK) {
        seed_fail(alp_context_message(context));
    }
    seed_put(target, name, bytes, size);
    alpi_release(context, bytes);
    alp_image_destroy(image);
}

// --- PNG -----------------------------------------------------------------------------------------

typedef struct output {
    uint8_t bytes[1 << 16];
    size_t size;
} output;

static void append(png_structp png, png_bytep data, size_t length)
{
    output *out = png_get_io_ptr(png);
    memcpy(out->bytes + out->size, data, length);
    out->size += length;
}

static void flush(png_structp png)
{
    (void)png;
}

/// Interlaced, with a palette and half a dozen chunks that say something else than pixels.
static void put_png(const char *name, int depth, int type)
{
    static output out;
    static uint8_t pixels[HEIGHT][8 * WIDTH];
    static const png_color palette[] = {{10, 20, 30}, {40, 50, 60}, {0, 0, 0}, {255, 255, 255}};
    static const png_byte alpha[] = {255, 128};
    png_bytep rows[HEIGHT];
    out.size = 0;
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < 8 * WIDTH; x++) {
            pixels[y][x] =
                type == PNG_COLOR_TYPE_PALETTE ? (uint8_t)(x % 4 * 64 + y % 4) : value_at(x, y, 0);
        }
        rows[y] = pixels[y];
    }
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &out, append, flush);
    png_set_IHDR(png, info, WIDTH, HEIGHT, depth, type, PNG_INTERLACE_ADAM7, 0, 0);
    if (type == PNG_COLOR_TYPE_PALETTE) {
        png_set_PLTE(png, info, palette, 4);
        png_set_tRNS(png, info, alpha, 2, NULL);
    }
    static char key[] = "Comment", value[] = "something that says nothing, nothing, nothing";
    png_text texts[2] = {{.compression = PNG_TEXT_COMPRESSION_zTXt, .key = key, .text = value},
                         {.compression = PNG_TEXT_COMPRESSION_NONE, .key = key, .text = value}};
    png_set_text(png, info, texts, 2);
    png_set_gAMA(png, info, 0.45455);
    png_write_info(png, info);
    png_write_image(png, rows);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    seed_put("png", name, out.bytes, out.size);
}

// --- JPEG ----------------------------------------------------------------------------------------

typedef struct jpeg_kind {
    const char *name;
    J_COLOR_SPACE space;
    int components;
    bool progressive, arithmetic, restarts;
} jpeg_kind;

static void put_jpeg(const jpeg_kind *kind)
{
    struct jpeg_compress_struct encoder;
    struct jpeg_error_mgr errors;
    unsigned char *bytes = NULL;
    unsigned long size = 0;
    encoder.err = jpeg_std_error(&errors);
    jpeg_create_compress(&encoder);
    jpeg_mem_dest(&encoder, &bytes, &size);
    encoder.image_width = WIDTH;
    encoder.image_height = HEIGHT;
    encoder.input_components = kind->components;
    encoder.in_color_space = kind->space;
    jpeg_set_defaults(&encoder);
    jpeg_set_quality(&encoder, 60, TRUE);
    encoder.arith_code = kind->arithmetic ? TRUE : FALSE;
    encoder.restart_interval = kind->restarts ? 1 : 0;
    if (kind->progressive) {
        jpeg_simple_progression(&encoder);
    }
    jpeg_start_compress(&encoder, TRUE);
    while (encoder.next_scanline < HEIGHT) {
        uint8_t row[4 * WIDTH];
        for (int i = 0; i < WIDTH * kind->components; i++) {
            row[i] =
                value_at(i / kind->components, (int)encoder.next_scanline, i % kind->components);
        }
        JSAMPROW rows[1] = {row};
        jpeg_write_scanlines(&encoder, rows, 1);
    }
    jpeg_finish_compress(&encoder);
    jpeg_destroy_compress(&encoder);
    seed_put("jpeg", kind->name, bytes, size);
    free(bytes);
}

// --- WebP ----------------------------------------------------------------------------------------

static void put_webp(const char *name, bool lossless, bool with_alpha)
{
    uint8_t pixels[HEIGHT * WIDTH * 4], *bytes = NULL;
    for (int i = 0; i < HEIGHT * WIDTH * 4; i++) {
        pixels[i] = i % 4 == 3 && !with_alpha ? 255 : value_at(i / 4 % WIDTH, i / 4 / WIDTH, i % 4);
    }
    const size_t size = lossless ? WebPEncodeLosslessRGBA(pixels, WIDTH, HEIGHT, WIDTH * 4, &bytes)
                                 : WebPEncodeRGBA(pixels, WIDTH, HEIGHT, WIDTH * 4, 40.0f, &bytes);
    if (size == 0) {
        seed_fail(name);
    }
    seed_put("webp", name, bytes, size);
    WebPFree(bytes);
}

// --- OpenEXR -------------------------------------------------------------------------------------

static int64_t write_out(exr_const_context_t exr, void *user, const void *buffer, uint64_t size,
                         uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    (void)exr;
    (void)fail;
    output *out = user;
    memcpy(out->bytes + offset, buffer, size);
    out->size = offset + size > out->size ? offset + size : out->size;
    return (int64_t)size;
}

static void try_exr(exr_result_t code)
{
    if (code != EXR_ERR_SUCCESS) {
        seed_fail(exr_get_default_error_message(code));
    }
}

static void aim(exr_encode_pipeline_t *encode, float *first, int line_width)
{
    for (int i = 0; i < encode->channel_count; i++) {
        exr_coding_channel_info_t *c = &encode->channels[i];
        c->user_bytes_per_element = sizeof(float);
        c->user_data_type = EXR_PIXEL_FLOAT;
        c->user_pixel_stride = sizeof(float);
        c->user_line_stride = (int32_t)((size_t)line_width * sizeof(float));
        c->encode_from_ptr = (const uint8_t *)first;
    }
}

static void encode_chunk(exr_context_t exr, exr_encode_pipeline_t *encode,
                         const exr_chunk_info_t *chunk, float *first, bool is_first)
{
    try_exr(is_first ? exr_encoding_initialize(exr, 0, chunk, encode)
                     : exr_encoding_update(exr, 0, chunk, encode));
    aim(encode, first, WIDTH);
    if (is_first) {
        try_exr(exr_encoding_choose_default_routines(exr, 0, encode));
    }
    try_exr(exr_encoding_run(exr, 0, encode));
}

static void put_exr(const char *name, exr_compression_t compression, exr_pixel_type_t type,
                    bool tiled)
{
    static output out;
    static float pixels[HEIGHT * WIDTH];
    static const char *const channels[] = {"R", "G", "B", "A", "Z"};
    enum { TILE = 16 };
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        pixels[i] = (float)value_at(i % WIDTH, i / WIDTH, 0) / 64.0f;
    }
    exr_context_t exr = NULL;
    exr_context_initializer_t options = EXR_DEFAULT_CONTEXT_INITIALIZER;
    options.user_data = &out;
    options.write_fn = write_out;
    out.size = 0;
    int part = 0;
    try_exr(exr_start_write(&exr, "seed.exr", EXR_WRITE_FILE_DIRECTLY, &options));
    try_exr(exr_add_part(exr, NULL, tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part));
    try_exr(exr_initialize_required_attr_simple(exr, part, WIDTH, HEIGHT, compression));
    if (tiled) {
        try_exr(exr_set_tile_descriptor(exr, part, TILE, TILE, EXR_TILE_ONE_LEVEL,
                                        EXR_TILE_ROUND_DOWN));
    }
    for (int k = 0; k < 5; k++) {
        try_exr(exr_add_channel(exr, part, channels[k], k == 4 ? EXR_PIXEL_FLOAT : type,
                                EXR_PERCEPTUALLY_LINEAR, 1, 1));
    }
    try_exr(exr_attr_set_float(exr, part, "alpenglowScale", 2.0f));
    try_exr(exr_write_header(exr));
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t chunk;
    if (tiled) {
        for (int i = 0; i < 4; i++) {
            const int x = i % 2, y = i / 2;
            try_exr(exr_write_tile_chunk_info(exr, 0, x, y, 0, 0, &chunk));
            encode_chunk(exr, &encode, &chunk, pixels + (y * WIDTH + x) * TILE, i == 0);
        }
    } else {
        int32_t lines = 0;
        try_exr(exr_get_scanlines_per_chunk(exr, 0, &lines));
        for (int y = 0; y < HEIGHT; y += lines) {
            try_exr(exr_write_scanline_chunk_info(exr, 0, y, &chunk));
            encode_chunk(exr, &encode, &chunk, pixels + y * WIDTH, y == 0);
        }
    }
    try_exr(exr_encoding_destroy(exr, &encode));
    try_exr(exr_finish(&exr));
    seed_put("exr", name, out.bytes, out.size);
}

// --- Radiance ------------------------------------------------------------------------------------

static void put_hdr_by_hand(void)
{
    static const char flat[] = "#?RGBE\nEXPOSURE=2\nCOLORCORR=1 2 .5\n\n+X 2 -Y 3\n"
                               "\x10\x20\x30\x80\x01\x01\x01\x02\x40\x10\x20\x81\x01\x01\x01\x02";
    seed_put("hdr", "old_runs.hdr", flat, sizeof flat - 1);
}

void seeds_images(alp_context *context)
{
    static const jpeg_kind kinds[] = {{"colour.jpg", JCS_RGB, 3, false, false, false},
                                      {"grey.jpg", JCS_GRAYSCALE, 1, false, false, true},
                                      {"ink.jpg", JCS_CMYK, 4, false, false, false},
                                      {"progressive.jpg", JCS_RGB, 3, true, false, false},
                                      {"arithmetic.jpg", JCS_RGB, 3, false, true, false}};
    put_ours(context, "png", "colour.png", 3, alpi_png_encode);
    put_ours(context, "hdr", "new_runs.hdr", 3, alpi_hdr_encode);
    put_ours(context, "exr", "ours.exr", 4, alpi_exr_encode);
    put_png("palette.png", 2, PNG_COLOR_TYPE_PALETTE);
    put_png("bits.png", 1, PNG_COLOR_TYPE_GRAY);
    put_png("deep.png", 16, PNG_COLOR_TYPE_RGB_ALPHA);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        put_jpeg(&kinds[i]);
    }
    put_webp("lossless.webp", true, true);
    put_webp("lossy.webp", false, false);
    put_webp("lossy_alpha.webp", false, true);
    put_exr("none.exr", EXR_COMPRESSION_NONE, EXR_PIXEL_HALF, false);
    put_exr("rle.exr", EXR_COMPRESSION_RLE, EXR_PIXEL_HALF, false);
    put_exr("zips.exr", EXR_COMPRESSION_ZIPS, EXR_PIXEL_FLOAT, false);
    put_exr("piz.exr", EXR_COMPRESSION_PIZ, EXR_PIXEL_HALF, false);
    put_exr("pxr24.exr", EXR_COMPRESSION_PXR24, EXR_PIXEL_FLOAT, false);
    put_exr("b44.exr", EXR_COMPRESSION_B44, EXR_PIXEL_HALF, false);
    put_exr("tiles.exr", EXR_COMPRESSION_ZIP, EXR_PIXEL_HALF, true);
    put_hdr_by_hand();
}
