// SPDX-License-Identifier: MIT
// PNG in memory ↔ 8-bit images, by libpng. Samples come as they are stored: gamma and colour chunks
// are ignored, as glTF asks. libpng reports errors by longjmp, so everything that must be released
// lives in a struct outside the function that it jumps to.
#include "base/memory.h"
#include "base/tasks.h"
#include "formats/images/images.h"

#include <png.h>

#include <setjmp.h>
#include <stdio.h>
#include <string.h>

/// How far deflate can go (1032 : 1, zlib's documentation).
enum { DEFLATE_MOST = 1032 };

typedef struct png_job {
    alp_context *context;
    png_structp png;
    png_infop info;
    char fault[160];
    alp_result code; // of the failure that made us jump
    // reading
    const uint8_t *bytes;
    size_t size, place;
    alp_image *image;
    png_bytep *rows;
    // writing
    uint8_t *out;
    size_t out_capacity, out_size;
    png_text *texts;
} png_job;

static void on_error(png_structp png, png_const_charp text)
{
    png_job *job = png_get_error_ptr(png);
    if (job->code == ALP_OK) {
        job->code = ALP_ERROR_INVALID_DATA;
    }
    snprintf(job->fault, sizeof job->fault, "%s", text);
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp text)
{
    (void)png; // what libpng can mend we need not tell
    (void)text;
}

static void release_job(png_job *job)
{
    alpi_release(job->context, job->rows);
    alp_image_destroy(job->image);
    alpi_release(job->context, job->out);
    alpi_release(job->context, job->texts);
}

// --- reading ------------------------------------------------------------------------------------

static void read_bytes(png_structp png, png_bytep data, size_t length)
{
    png_job *job = png_get_io_ptr(png);
    if (length > job->size - job->place) {
        png_error(png, "the data ends early");
    }
    memcpy(data, job->bytes + job->place, length);
    job->place += length;
}

/// Makes the image and its row pointers. False with job->code set.
static bool make_rows(png_job *job)
{
    alp_image_info info = {png_get_image_width(job->png, job->info),
                           png_get_image_height(job->png, job->info),
                           png_get_channels(job->png, job->info), ALP_COMPONENT_U8};
    job->code = alp_image_create(job->context, info, &job->image);
    if (job->code != ALP_OK) {
        return false;
    }
    job->rows = ALPI_NEW(job->context, png_bytep, info.height);
    if (job->rows == NULL) {
        job->code = ALP_ERROR_OUT_OF_MEMORY;
        return false;
    }
    for (uint32_t y = 0; y < info.height; y++) {
        job->rows[y] = alp_image_bytes(job->image) + (size_t)y * info.width * info.channels;
    }
    return true;
}

static void check_size(png_job *job)
{
    const uint32_t width = png_get_image_width(job->png, job->info);
    const uint32_t height = png_get_image_height(job->png, job->info);
    const uint64_t pixels = (uint64_t)width * height;
    char fault[100];
    if (pixels > ALPI_IMAGE_PIXEL_LIMIT) {
        job->code = ALP_ERROR_LIMIT;
        snprintf(fault, sizeof fault, "has %u x %u pixels, more than 2^28", width, height);
        png_error(job->png, fault);
    }
    const unsigned bits =
        png_get_bit_depth(job->png, job->info) * (unsigned)png_get_channels(job->png, job->info);
    if (pixels * bits / 8 / DEFLATE_MOST > job->size) { // a short file cannot ask for gigabytes
        snprintf(fault, sizeof fault, "%zu bytes cannot hold %u x %u pixels: it was cut off",
                 job->size, width, height);
        png_error(job->png, fault);
    }
}

static void read_image(png_job *job)
{
    if (setjmp(png_jmpbuf(job->png)) != 0) {
        return;
    }
    png_set_read_fn(job->png, job, read_bytes);
    png_set_user_limits(job->png, ALPI_IMAGE_SIDE_LIMIT, ALPI_IMAGE_SIDE_LIMIT);
    // Texts and profiles, which nobody here asks for, may inflate to much more than the pixels.
    png_set_keep_unknown_chunks(job->png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_read_info(job->png, job->info);
    check_size(job);
    png_set_expand(job->png);   // palettes, fewer than 8 bits, a transparent colour
    png_set_scale_16(job->png); // rounds
    png_set_interlace_handling(job->png);
    png_read_update_info(job->png, job->info);
    if (!make_rows(job)) {
        png_error(job->png, "its pixels do not fit into memory");
    }
    png_read_image(job->png, job->rows);
    png_read_end(job->png, NULL);
}

alp_result alpi_png_decode(alp_context *context, const char *name, const uint8_t *bytes,
                           size_t size, alp_image **image)
{
    *image = NULL;
    png_job job = {.context = context, .bytes = bytes, .size = size};
    job.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
    job.info = job.png != NULL ? png_create_info_struct(job.png) : NULL;
    if (job.info != NULL) {
        read_image(&job);
    } else {
        job.code = ALP_ERROR_OUT_OF_MEMORY;
    }
    png_destroy_read_struct(&job.png, &job.info, NULL);
    if (job.code == ALP_OK) {
        *image = job.image;
        job.image = NULL;
    } else {
        alpi_fail(context, job.code, "%s: PNG: %s", name,
                  job.fault[0] != '\0' ? job.fault : "out of memory");
    }
    release_job(&job);
    return job.code;
}

// --- writing ------------------------------------------------------------------------------------

static void write_bytes(png_structp png, png_bytep data, size_t length)
{
    png_job *job = png_get_io_ptr(png);
    void *out = job->out;
    job->code = alpi_grow(job->context, &out, &job->out_capacity, job->out_size + length, 1);
    job->out = out;
    if (job->code != ALP_OK) {
        png_error(png, "out of memory");
    }
    memcpy(job->out + job->out_size, data, length);
    job->out_size += length;
}

static void flush_bytes(png_structp png)
{
    (void)png;
}

/// Hands the texts of an image to libpng, which copies them.
static void set_texts(png_job *job, const alp_image *image)
{
    int count = 0;
    for (const alpi_image_text *t = image->texts; t != NULL; t = t->next) {
        count++;
    }
    job->texts = ALPI_NEW(job->context, png_text, (size_t)count + 1);
    if (job->texts == NULL) {
        job->code = ALP_ERROR_OUT_OF_MEMORY;
        png_error(job->png, "out of memory");
    }
    png_text *at = job->texts;
    for (const alpi_image_text *t = image->texts; t != NULL; t = t->next) {
        *at++ = (png_text){.compression = PNG_ITXT_COMPRESSION_NONE,
                           .key = t->key,
                           .text = t->text,
                           .itxt_length = strlen(t->text)};
    }
    png_set_text(job->png, job->info, job->texts, count);
}

static void write_image(png_job *job, const alp_image *image)
{
    static const int color_types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                      PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
    const alp_image_info *info = &image->info;
    if (setjmp(png_jmpbuf(job->png)) != 0) {
        return;
    }
    png_set_write_fn(job->png, job, write_bytes, flush_bytes);
    png_set_IHDR(job->png, job->info, info->width, info->height, 8, color_types[info->channels - 1],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (image->texts != NULL) {
        set_texts(job, image);
    }
    png_write_info(job->png, job->info);
    const uint8_t *pixels = image->pixels;
    size_t row_size = (size_t)info->width * info->channels;
    for (uint32_t y = 0; y < info->height; y++) {
        job->code = alpi_tick(job->context, "write", y, info->height);
        if (job->code != ALP_OK) {
            png_error(job->png, "cancelled");
        }
        png_write_row(job->png, pixels + y * row_size);
    }
    png_write_end(job->png, NULL);
}

alp_result alpi_png_encode(const alp_image *image, uint8_t **bytes, size_t *size)
{
    *bytes = NULL;
    *size = 0;
    if (image->info.component != ALP_COMPONENT_U8) {
        return alpi_fail(image->context, ALP_ERROR_INVALID_ARGUMENT,
                         "PNG holds 8-bit images; convert the float image first");
    }
    png_job job = {.context = image->context};
    job.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
    job.info = job.png != NULL ? png_create_info_struct(job.png) : NULL;
    if (job.info != NULL) {
        write_image(&job, image);
    } else {
        job.code = ALP_ERROR_OUT_OF_MEMORY;
    }
    png_destroy_write_struct(&job.png, &job.info);
    if (job.code == ALP_OK) {
        *bytes = job.out;
        *size = job.out_size;
        job.out = NULL;
    } else {
        alpi_fail(image->context, job.code, "writing a PNG: %s",
                  job.fault[0] != '\0' ? job.fault : "out of memory");
    }
    release_job(&job);
    return job.code;
}
