// SPDX-License-Identifier: MIT
// JPEG in memory → 8-bit images, by libjpeg. Grey stays one channel, everything else becomes RGB.
// libjpeg reports errors by longjmp, so everything that must be released lives in a struct outside
// the function that it jumps to.
#include "base/memory.h"
#include "formats/images/images.h"

#include <setjmp.h>
#include <stdio.h>
#include <string.h>

// libjpeg needs stdio.h before it
#include <jerror.h>
#include <jpeglib.h>

/// A progressive file may repeat scans of nothing for ever; real ones have about ten.
enum { SCAN_LIMIT = 200 };

typedef struct jpeg_job {
    struct jpeg_decompress_struct decoder;
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf jump;
    char fault[JMSG_LENGTH_MAX];
    alp_context *context;
    size_t size; // of the file
    alp_result code;
    alp_image *image;
    uint8_t *cmyk_row; // NULL unless the file is CMYK
} jpeg_job;

static void give_up(jpeg_job *job, alp_result code, const char *fault)
{
    job->code = code;
    snprintf(job->fault, sizeof job->fault, "%s", fault);
    longjmp(job->jump, 1);
}

static void on_error(j_common_ptr common)
{
    jpeg_job *job = common->client_data;
    char text[JMSG_LENGTH_MAX];
    common->err->format_message(common, text);
    give_up(job,
            common->err->msg_code == JERR_OUT_OF_MEMORY ? ALP_ERROR_OUT_OF_MEMORY
                                                        : ALP_ERROR_INVALID_DATA,
            text);
}

/// Data that ends early would be filled with grey: that is an error here. Other warnings pass.
static void on_message(j_common_ptr common, int level)
{
    int code = common->err->msg_code;
    if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER)) {
        on_error(common);
    }
}

static void on_output(j_common_ptr common)
{
    (void)common;
}

static void on_progress(j_common_ptr common)
{
    jpeg_job *job = common->client_data;
    if (job->decoder.input_scan_number > SCAN_LIMIT) {
        give_up(job, ALP_ERROR_LIMIT, "has more than 200 scans");
    }
}

/// Huffman's code has a bit or more for each block of 8 × 8 samples, and at the oddest sampling
/// that the format allows (4 × 1 and 1 × 4) a block stands for 128 pixels. Arithmetic coding has no
/// such bound.
enum { MOST_PIXELS_PER_BYTE = 8 * 128 };

static void check_size(jpeg_job *job)
{
    const unsigned width = job->decoder.image_width, height = job->decoder.image_height;
    const uint64_t pixels = (uint64_t)width * height;
    char fault[JMSG_LENGTH_MAX];
    if (pixels > ALPI_IMAGE_PIXEL_LIMIT) {
        snprintf(fault, sizeof fault, "has %u x %u pixels, more than 2^28", width, height);
        give_up(job, ALP_ERROR_LIMIT, fault);
    }
    if (!job->decoder.arith_code && pixels / MOST_PIXELS_PER_BYTE > job->size) {
        snprintf(fault, sizeof fault, "%zu bytes cannot hold %u x %u pixels: it was cut off",
                 job->size, width, height);
        give_up(job, ALP_ERROR_INVALID_DATA, fault);
    }
}

static void start_decoder(jpeg_job *job)
{
    check_size(job);
    J_COLOR_SPACE space = job->decoder.jpeg_color_space;
    bool grey = space == JCS_GRAYSCALE;
    bool cmyk = space == JCS_CMYK || space == JCS_YCCK;
    job->decoder.out_color_space = grey ? JCS_GRAYSCALE : cmyk ? JCS_CMYK : JCS_RGB;
    alp_image_info info = {job->decoder.image_width, job->decoder.image_height, grey ? 1 : 3,
                           ALP_COMPONENT_U8};
    alp_result result = alp_image_create(job->context, info, &job->image);
    if (result == ALP_OK && cmyk) {
        job->cmyk_row = ALPI_NEW(job->context, uint8_t, 4 * (size_t)info.width);
        result = job->cmyk_row == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    }
    if (result != ALP_OK) {
        give_up(job, result, "its pixels do not fit into memory");
    }
    jpeg_start_decompress(&job->decoder);
}

/// Plain subtractive mixing. Adobe's files hold the complement of ink.
static void convert_cmyk(const jpeg_job *job, uint8_t *rgb)
{
    bool complement = job->decoder.saw_Adobe_marker;
    for (size_t x = 0; x < job->decoder.output_width; x++) {
        const uint8_t *ink = job->cmyk_row + 4 * x;
        unsigned light_k = complement ? ink[3] : 255u - ink[3];
        for (int k = 0; k < 3; k++) {
            unsigned light = complement ? ink[k] : 255u - ink[k];
            rgb[3 * x + (size_t)k] = (uint8_t)((light * light_k + 127) / 255);
        }
    }
}

static void read_image(jpeg_job *job, const uint8_t *bytes, size_t size)
{
    if (setjmp(job->jump) != 0) {
        return;
    }
    jpeg_create_decompress(&job->decoder);
    job->decoder.progress = &job->progress;
    jpeg_mem_src(&job->decoder, bytes, size);
    jpeg_read_header(&job->decoder, TRUE);
    start_decoder(job);
    size_t row_size = (size_t)job->image->info.width * job->image->info.channels;
    while (job->decoder.output_scanline < job->decoder.output_height) {
        uint8_t *row = alp_image_bytes(job->image) + job->decoder.output_scanline * row_size;
        JSAMPROW target = job->cmyk_row != NULL ? job->cmyk_row : row;
        jpeg_read_scanlines(&job->decoder, &target, 1);
        if (job->cmyk_row != NULL) {
            convert_cmyk(job, row);
        }
    }
    jpeg_finish_decompress(&job->decoder);
}

alp_result alpi_jpeg_decode(alp_context *context, const char *name, const uint8_t *bytes,
                            size_t size, alp_image **image)
{
    *image = NULL;
    jpeg_job job = {.context = context, .size = size};
    job.decoder.err = jpeg_std_error(&job.errors);
    job.decoder.client_data = &job;
    job.errors.error_exit = on_error;
    job.errors.emit_message = on_message;
    job.errors.output_message = on_output;
    job.progress.progress_monitor = on_progress;
    read_image(&job, bytes, size);
    jpeg_destroy_decompress(&job.decoder);
    alpi_release(context, job.cmyk_row);
    if (job.code != ALP_OK) {
        alp_image_destroy(job.image);
        return alpi_fail(context, job.code, "%s: JPEG: %s", name, job.fault);
    }
    *image = job.image;
    return ALP_OK;
}
