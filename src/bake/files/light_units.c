// SPDX-License-Identifier: MIT
// The light of an asset: converts it to the units asked for, divides it by a scale, encodes it.
#include "bake/files/light_units.h"

#include "bake/settings.h"
#include "base/dither.h"
#include "base/half.h"
#include "base/memory.h"
#include "formats/formats.h"
#include "maps/radiosity/outgoing.h"

#include <math.h>
#include <string.h>

static const float PI = 3.14159265f;

// --- the choice ----------------------------------------------------------------------------------

const char *alpi_bake_light_units_name(const alp_bake_options *options)
{
    static const char *const names[] = {[ALP_LIGHT_IRRADIANCE] = "irradiance",
                                        [ALP_LIGHT_IRRADIANCE_OVER_PI] = "irradiance/pi",
                                        [ALP_LIGHT_RADIANCE] = "radiance"};
    return names[alpi_bake_light_units(options)];
}

const char *alpi_bake_light_ending(const alp_bake_options *options)
{
    static const char *const endings[] = {
        [ALP_LIGHTMAP_KTX2] = ".ktx2", [ALP_LIGHTMAP_EXR] = ".exr", [ALP_LIGHTMAP_HDR] = ".hdr"};
    return options->lightmap_as == ALP_LIGHTMAP_AS_EXTRAS ? endings[options->lightmap_format]
                                                          : ".png";
}

// --- values --------------------------------------------------------------------------------------

/// Converts a page to its units. A = 1 where a texel covers the pixel.
static alp_result fill_page(const alpi_bake_job *job, uint32_t page, float *values)
{
    const alp_lightmap *l = job->lightmap;
    const alp_light_units units = alpi_bake_light_units(&job->options);
    if (units == ALP_LIGHT_RADIANCE) {
        return alpi_lightmap_outgoing(l, page, values);
    }
    const float factor = units == ALP_LIGHT_IRRADIANCE_OVER_PI ? 1.0f / PI : 1.0f;
    const size_t count = (size_t)l->width * l->height;
    for (size_t i = 0; i < 4 * count; i++) {
        values[i] = l->irradiance_pages[page][i] * (i % 4 == 3 ? 1.0f : factor);
    }
    return ALP_OK;
}

/// The place in `scales` of a texel's material.
static uint32_t scale_of(const alpi_bake_job *job, uint32_t texel)
{
    const alp_scene *scene = job->scene;
    const uint32_t triangle = job->lightmap->texels.triangles[texel];
    const uint32_t material = scene->surfaces[scene->triangle_surface[triangle]].material;
    return material == ALPI_NONE ? scene->material_count : material;
}

static float *pixel_of(const alpi_bake_job *job, float *const *values, uint32_t texel)
{
    const alpi_texels *t = &job->lightmap->texels;
    return values[t->pages[texel]] +
           4 * ((size_t)t->pixels[texel][1] * job->lightmap->width + t->pixels[texel][0]);
}

/// Scales each material by its brightest texel, so that 8 bits reach from there downwards; by 1
/// where all is dark.
static void find_scales(const alpi_bake_job *job, float *const *values, float *scales)
{
    for (uint32_t i = 0; i < job->lightmap->texels.count; i++) {
        const float *pixel = pixel_of(job, values, i);
        float *scale = &scales[scale_of(job, i)];
        *scale = fmaxf(*scale, fmaxf(pixel[0], fmaxf(pixel[1], pixel[2])));
    }
    for (uint32_t m = 0; m <= job->scene->material_count; m++) {
        scales[m] = scales[m] > 0.0f ? scales[m] : 1.0f;
    }
}

/// Finds the least power of two, 1 or more, that makes all values finite half floats.
static float find_half_scale(const alpi_bake_job *job, float *const *values)
{
    float most = 0.0f, scale = 1.0f;
    for (uint32_t i = 0; i < job->lightmap->texels.count; i++) {
        const float *pixel = pixel_of(job, values, i);
        most = fmaxf(most, fmaxf(pixel[0], fmaxf(pixel[1], pixel[2])));
    }
    while (most / scale > ALPI_HALF_MAX && scale < 0x1p100f) {
        scale *= 2.0f;
    }
    return scale;
}

static void choose_scales(alpi_bake_job *job, float *const *values)
{
    alpi_light_asset *asset = &job->light_asset;
    const alp_bake_options *o = &job->options;
    if (o->lightmap_as != ALP_LIGHTMAP_AS_EXTRAS) {
        find_scales(job, values, asset->scales);
    } else {
        const bool halves = o->lightmap_format != ALP_LIGHTMAP_HDR;
        const float scale = halves ? find_half_scale(job, values) : 1.0f;
        for (uint32_t m = 0; m <= job->scene->material_count; m++) {
            asset->scales[m] = scale;
        }
    }
    for (uint32_t i = 0; i < job->lightmap->texels.count; i++) {
        asset->scale = fmaxf(asset->scale, asset->scales[scale_of(job, i)]);
    }
}

// --- encoding ------------------------------------------------------------------------------------

enum { STREAM_DITHER = 40 }; // random numbers apart from those of samples

/// Turns values in [0, 1] into codes of 8 bits. Emission is dithered, because dim walls show every
/// step of its codes. Texels beside the charts get the codes of their neighbours afterwards.
static void quantise(const alpi_bake_job *job, float *page, uint32_t number)
{
    const bool emissive = job->options.lightmap_as == ALP_LIGHTMAP_AS_EMISSIVE;
    const uint64_t pixels = (uint64_t)job->lightmap->width * job->lightmap->height;
    for (uint64_t i = 0; i < 4 * pixels; i++) {
        if (i % 4 == 3 || !(page[i / 4 * 4 + 3] > 0.0f)) {
            continue;
        }
        const float value = fminf(fmaxf(page[i], 0.0f), 1.0f);
        const uint32_t key =
            alpi_random_key(job->options.occlusion.seed, 4 * pixels * number + i, STREAM_DITHER);
        page[i] = emissive ? (float)alpi_dither_byte(alpi_linear_to_srgb(value) * 255.0f, key)
                           : floorf(value * 255.0f + 0.5f);
    }
}

/// Encodes codes as 8-bit RGB. Two materials that meet inside a chart have scales of their own. A
/// filter that reads across their border mixes the scales, as it mixes the colours.
static alp_result encode_bytes(const alpi_bake_job *job, const float *page, uint32_t number)
{
    const alp_image_info info = {job->lightmap->width, job->lightmap->height, 3, ALP_COMPONENT_U8};
    alp_image *image = NULL;
    ALP_TRY(alp_image_create(job->context, info, &image));
    uint8_t *bytes = alp_image_bytes(image);
    for (size_t i = 0; i < 3 * (size_t)info.width * info.height; i++) {
        bytes[i] = (uint8_t)page[i / 3 * 4 + i % 3];
    }
    const alp_result result = alpi_png_encode(image, &job->light_asset.files[number],
                                              &job->light_asset.file_sizes[number]);
    alp_image_destroy(image);
    return result;
}

static alp_result encode_page(alpi_bake_job *job, float *page, uint32_t number)
{
    const alp_lightmap *l = job->lightmap;
    const bool bytes_are_wanted = job->options.lightmap_as != ALP_LIGHTMAP_AS_EXTRAS;
    if (bytes_are_wanted) {
        quantise(job, page, number);
    }
    ALP_TRY(alpi_dilate(job->context, page, l->width, l->height));
    if (bytes_are_wanted) {
        return encode_bytes(job, page, number);
    }
    const alp_image view = {.context = job->context,
                            .info = {l->width, l->height, 4, ALP_COMPONENT_FLOAT},
                            .pixels = page};
    uint8_t **bytes = &job->light_asset.files[number];
    size_t *size = &job->light_asset.file_sizes[number];
    switch (job->options.lightmap_format) {
    case ALP_LIGHTMAP_EXR:
        return alpi_exr_encode_half(&view, job->light_asset.scale, false, bytes, size);
    case ALP_LIGHTMAP_HDR:
        return alpi_hdr_encode(&view, bytes, size);
    default:
        return alpi_ktx2_encode(&view, job->light_asset.scale, bytes, size);
    }
}

static alp_result make_pages(alpi_bake_job *job, float **values)
{
    const alp_lightmap *l = job->lightmap;
    alpi_light_asset *asset = &job->light_asset;
    for (uint32_t p = 0; p < l->page_count; p++) {
        ALPI_TRY_NEW(job->context, values[p], 4 * (size_t)l->width * l->height);
        ALP_TRY(fill_page(job, p, values[p]));
    }
    choose_scales(job, values);
    for (uint32_t i = 0; i < l->texels.count; i++) {
        float *pixel = pixel_of(job, values, i);
        for (int k = 0; k < 3; k++) {
            pixel[k] /= asset->scales[scale_of(job, i)];
        }
    }
    for (uint32_t p = 0; p < l->page_count; p++) {
        ALP_TRY(encode_page(job, values[p], p));
    }
    return ALP_OK;
}

/// Notes materials that a viewer will not show as they were baked.
static void note_glass(const alpi_bake_job *job)
{
    for (uint32_t m = 0; m < job->scene->material_count; m++) {
        if (job->options.lightmap_as == ALP_LIGHTMAP_AS_EMISSIVE &&
            job->scene->materials[m].transmission > 0.0f) {
            alpi_note(
                job->context, "light-glass", job->scene->name,
                "material %u (%s) transmits light and stays unchanged: a black one would be opaque",
                m, job->scene->materials[m].name);
        }
    }
}

alp_result alpi_bake_make_light_asset(alpi_bake_job *job)
{
    if (job->options.lightmap_as == ALP_LIGHTMAP_AS_NONE ||
        alpi_bake_is_viewer_file(&job->options)) {
        return ALP_OK;
    }
    alpi_light_asset *asset = &job->light_asset;
    const uint32_t pages = job->lightmap->page_count;
    note_glass(job);
    ALPI_TRY_NEW(job->context, asset->files, pages);
    ALPI_TRY_NEW(job->context, asset->file_sizes, pages);
    ALPI_TRY_NEW(job->context, asset->scales, (size_t)job->scene->material_count + 1);
    float **values = ALPI_NEW(job->context, float *, pages);
    const alp_result result = values == NULL ? ALP_ERROR_OUT_OF_MEMORY : make_pages(job, values);
    for (uint32_t p = 0; values != NULL && p < pages; p++) {
        alpi_release(job->context, values[p]);
    }
    alpi_release(job->context, values);
    return result;
}

void alpi_bake_release_light_asset(alpi_bake_job *job)
{
    alpi_light_asset *asset = &job->light_asset;
    for (uint32_t p = 0; asset->files != NULL && p < job->lightmap->page_count; p++) {
        alpi_release(job->context, asset->files[p]);
    }
    alpi_release(job->context, asset->files);
    alpi_release(job->context, asset->file_sizes);
    alpi_release(job->context, asset->scales);
    *asset = (alpi_light_asset){0};
}
