// SPDX-License-Identifier: MIT
// Encodes the maps of the maps folder in the format asked for.
#include "bake/files/map_files.h"

#include "base/half.h"
#include "base/memory.h"
#include "formats/formats.h"

#include <math.h>
#include <string.h>

const char *alpi_bake_map_ending(const alp_bake_options *options)
{
    static const char *const endings[] = {[ALP_MAPS_EXR] = ".exr",
                                          [ALP_MAPS_EXR_HALF] = ".exr",
                                          [ALP_MAPS_HDR] = ".hdr",
                                          [ALP_MAPS_KTX2] = ".ktx2"};
    return endings[options->maps_format];
}

/// Finds the least power of two, 1 or more, that makes all colours finite half floats.
static float find_scale(const alp_image *image)
{
    const float *pixels = image->pixels;
    const size_t count = (size_t)image->info.width * image->info.height;
    float most = 0.0f, scale = 1.0f;
    for (size_t i = 0; i < 4 * count; i++) {
        most = i % 4 == 3 || isinf(pixels[i]) ? most : fmaxf(most, fabsf(pixels[i]));
    }
    while (most / scale > ALPI_HALF_MAX && scale < 0x1p127f) {
        scale *= 2.0f;
    }
    return scale;
}

static alp_result encode_halves(const alpi_bake_job *job, const alp_image *image, float scale,
                                alpi_map_file *file)
{
    return job->options.maps_format == ALP_MAPS_KTX2
               ? alpi_ktx2_encode(image, scale, &file->bytes, &file->size)
               : alpi_exr_encode_half(image, scale, true, &file->bytes, &file->size);
}

/// Divides the colours by the scale. Coverage stays as it is.
static alp_result encode_scaled(const alpi_bake_job *job, const alp_image *image, float scale,
                                alpi_map_file *file)
{
    const size_t count = 4 * (size_t)image->info.width * image->info.height;
    const float *pixels = image->pixels;
    float *copy = ALPI_NEW(job->context, float, count);
    if (copy == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (size_t i = 0; i < count; i++) {
        copy[i] = i % 4 == 3 ? pixels[i] : pixels[i] / scale;
    }
    const alp_image scaled = {.context = job->context, .info = image->info, .pixels = copy};
    const alp_result result = encode_halves(job, &scaled, scale, file);
    alpi_release(job->context, copy);
    return result;
}

alp_result alpi_bake_encode_map(const alpi_bake_job *job, const alp_image *image, const char *name,
                                uint32_t page, alpi_map_file *file)
{
    switch (job->options.maps_format) {
    case ALP_MAPS_EXR:
        return alpi_exr_encode(image, &file->bytes, &file->size);
    case ALP_MAPS_HDR:
        return alpi_hdr_encode(image, &file->bytes, &file->size);
    default:
        break;
    }
    const float scale = find_scale(image);
    if (scale == 1.0f) {
        return encode_halves(job, image, scale, file);
    }
    alpi_note(job->context, "maps-scaled", job->scene->name,
              "%s, page %u: values exceed 65504, the limit of half floats; they are stored divided "
              "by %.0f, which the file states as alpenglowScale",
              name, page, (double)scale);
    return encode_scaled(job, image, scale, file);
}
