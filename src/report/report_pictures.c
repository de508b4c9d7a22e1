// SPDX-License-Identifier: MIT
// Pictures of a page of the atlas, small enough for a page of HTML.
#include "report/report_parts.h"

#include "base/random.h"
#include "base/vec.h"

#include <alpenglow/film.h>

#include <math.h>
#include <string.h>

void alpi_heat_color(float share, uint8_t rgb[3])
{
    // Night, violet, rose, amber, pale: each brighter than the one before.
    static const float stops[][4] = {{0.0f, 18.0f, 22.0f, 48.0f},
                                     {0.3f, 84.0f, 44.0f, 128.0f},
                                     {0.6f, 205.0f, 68.0f, 106.0f},
                                     {0.83f, 246.0f, 158.0f, 84.0f},
                                     {1.0f, 255.0f, 243.0f, 196.0f}};
    enum { LAST = sizeof stops / sizeof *stops - 1 };
    const float at = share > 0.0f ? fminf(share, 1.0f) : 0.0f;
    size_t i = 0;
    while (i + 1 < LAST && at > stops[i + 1][0]) {
        i++;
    }
    const float t = (at - stops[i][0]) / (stops[i + 1][0] - stops[i][0]);
    for (int k = 0; k < 3; k++) {
        rgb[k] = (uint8_t)lrintf(stops[i][k + 1] + t * (stops[i + 1][k + 1] - stops[i][k + 1]));
    }
}

void alpi_surface_tint(uint32_t surface, uint8_t rgb[3])
{
    // Steps of the golden section keep the hues of neighbours apart however many there are.
    const double golden = 0.61803398874989485, hue = (double)surface * golden + 0.58;
    for (int k = 0; k < 3; k++) {
        const double wave = cos(2.0 * ALPI_PI * (hue - k / 3.0));
        rgb[k] = (uint8_t)lrint(178.0 + 46.0 * wave);
    }
}

// --- values of texels ----------------------------------------------------------------------------

/// The page of values that a picture shows, or NULL: occlusion's errors are kept by texel.
static const float *values_of(const alp_lightmap *l, alpi_report_picture kind, uint32_t page)
{
    float *const *pages = kind == ALPI_PICTURE_BENT          ? l->bent_pages
                          : kind == ALPI_PICTURE_OBSCURANCE  ? l->obscurance_pages
                          : kind == ALPI_PICTURE_LIGHT       ? l->irradiance_pages
                          : kind == ALPI_PICTURE_LIGHT_ERROR ? l->irradiance_error_pages
                                                             : l->pages;
    return pages != NULL ? pages[page] : NULL;
}

/// Of one texel, RGB; errors as shares of the mean, in R. False where it has none of its own.
static bool find_value(const alpi_report_pictures *p, alpi_report_picture kind, uint32_t page,
                       uint32_t texel, float rgb[3])
{
    const alp_lightmap *l = p->lightmap;
    const uint16_t *at = l->texels.pixels[texel];
    if (kind == ALPI_PICTURE_LAYOUT) {
        uint8_t tint[3];
        alpi_surface_tint(p->scene->triangle_surface[l->texels.triangles[texel]], tint);
        const uint32_t hash = alpi_hash32(l->texels.charts[texel] + 1) & 255u;
        for (int k = 0; k < 3; k++) {
            rgb[k] = (float)tint[k] / 255.0f * (0.9f + 0.2f * (float)hash / 255.0f);
        }
        return true;
    }
    const float *pixel = values_of(l, kind, page) + 4 * ((size_t)at[1] * l->width + at[0]);
    if (!(pixel[3] > 0.0f)) {
        return false;
    }
    if (kind == ALPI_PICTURE_AO_ERROR) {
        rgb[0] = rgb[1] = rgb[2] = l->errors[texel];
    } else if (kind == ALPI_PICTURE_LIGHT_ERROR) {
        const float squares = pixel[0] * pixel[0] + pixel[1] * pixel[1] + pixel[2] * pixel[2];
        rgb[0] = rgb[1] = rgb[2] = sqrtf(squares / 3.0f);
    } else {
        memcpy(rgb, pixel, 3 * sizeof *rgb);
    }
    return isfinite(rgb[0]) && isfinite(rgb[1]) && isfinite(rgb[2]);
}

/// Float RGBA: the mean over what is covered of each square of texels; A is 0 where nothing is.
static alp_result shrink(const alpi_report_pictures *p, alpi_report_picture kind, uint32_t page,
                         alp_image **small)
{
    const alp_lightmap *l = p->lightmap;
    const uint32_t longest = l->width > l->height ? l->width : l->height;
    const uint32_t step = (longest + ALPI_REPORT_SIDE - 1) / ALPI_REPORT_SIDE;
    const uint32_t width = (l->width + step - 1) / step, height = (l->height + step - 1) / step;
    const alp_image_info info = {width, height, 4, ALP_COMPONENT_FLOAT};
    ALP_TRY(alp_image_create(l->context, info, small));
    float *pixels = alp_image_floats(*small);
    for (uint32_t i = l->texels.page_first[page]; i < l->texels.page_first[page + 1]; i++) {
        const uint16_t *at = l->texels.pixels[i];
        float *pixel = pixels + 4 * ((size_t)(at[1] / step) * width + at[0] / step);
        float rgb[3];
        if (find_value(p, kind, page, i, rgb)) {
            for (int k = 0; k < 3; k++) {
                pixel[k] += rgb[k];
            }
            pixel[3] += 1.0f;
        }
    }
    for (size_t i = 0; i < (size_t)4 * width * height; i += 4) {
        for (size_t k = 0; pixels[i + 3] > 0.0f && k < 3; k++) {
            pixels[i + k] /= pixels[i + 3];
        }
        pixels[i + 3] = pixels[i + 3] > 0.0f ? 1.0f : 0.0f;
    }
    return ALP_OK;
}

// --- what they are shown by ----------------------------------------------------------------------

/// 1, 2 or 5 times a power of ten, `number` or more: what the end of a scale can be named.
static double round_up(double number)
{
    const double power = pow(10.0, floor(log10(number)));
    const double digit = number / power;
    return power * (digit <= 1.0001 ? 1.0 : digit <= 2.0001 ? 2.0 : digit <= 5.0001 ? 5.0 : 10.0);
}

/// Mean of a map over its texels and channels.
static double mean_of(const alpi_report_pictures *p, alpi_report_picture kind)
{
    double sum = 0.0, count = 0.0;
    const alpi_texels *texels = &p->lightmap->texels;
    for (uint32_t i = 0; i < texels->count; i++) {
        float rgb[3];
        if (find_value(p, kind, texels->pages[i], i, rgb)) {
            sum += ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3.0;
            count += 1.0;
        }
    }
    return count > 0.0 ? sum / count : 0.0;
}

static double largest_of(const alpi_report_pictures *p, alpi_report_picture kind)
{
    double largest = 0.0;
    const alpi_texels *texels = &p->lightmap->texels;
    for (uint32_t i = 0; i < texels->count; i++) {
        float rgb[3];
        if (find_value(p, kind, texels->pages[i], i, rgb)) {
            largest = fmax(largest, (double)rgb[0]);
        }
    }
    return largest;
}

/// @param p99 of the errors, as stated, over the mean: few texels reach beyond it; or NaN
static void measure_errors(alpi_report_pictures *p, alpi_report_picture map,
                           alpi_report_picture error, double p99)
{
    const double mean = mean_of(p, map);
    const double end = mean > 0.0 ? (p99 > 0.0 ? p99 : largest_of(p, error) / mean) : 0.0;
    p->means[error] = mean;
    p->tops[error] = end > 0.0 && isfinite(end) ? round_up(end) : 0.0;
}

/// One exposure for all pages: that of the pixels of all of them.
static alp_result measure_exposure(alpi_report_pictures *p)
{
    double sum = 0.0, count = 0.0;
    for (uint32_t page = 0; page < p->page_count; page++) {
        alp_image *small = NULL;
        double log2_luminance = 0.0;
        uint64_t pixels = 0;
        alp_result result = shrink(p, ALPI_PICTURE_LIGHT, page, &small);
        if (result == ALP_OK) {
            result = alp_film_meter(small, NULL, &log2_luminance, &pixels);
        }
        alp_image_destroy(small);
        ALP_TRY(result);
        sum += log2_luminance * (double)pixels;
        count += (double)pixels;
    }
    const double key = (double)alp_film_options_default().key;
    const double exposure = count > 0.0 ? log2(key) - sum / count : 0.0;
    p->exposure = round(100.0 * fmax(-64.0, fmin(exposure, 64.0))) / 100.0;
    return ALP_OK;
}

alp_result alpi_report_measure(const alp_bake_report *report, alpi_report_pictures *p)
{
    const alp_lightmap *l = p->lightmap;
    if ((report->maps & (ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_OBSCURANCE)) != 0) {
        measure_errors(p, ALPI_PICTURE_AO, ALPI_PICTURE_AO_ERROR, report->ao_p99_error);
    }
    if (l->irradiance_pages == NULL) {
        return ALP_OK;
    }
    if (l->irradiance_error_pages != NULL) {
        measure_errors(p, ALPI_PICTURE_LIGHT, ALPI_PICTURE_LIGHT_ERROR, report->light_p99_error);
    }
    return measure_exposure(p);
}

/// Values → bytes of a picture's pixel, but for film.
static void color_pixel(const alpi_report_pictures *p, alpi_report_picture kind,
                        const float value[3], uint8_t rgb[3])
{
    if (kind == ALPI_PICTURE_AO_ERROR || kind == ALPI_PICTURE_LIGHT_ERROR) {
        alpi_heat_color((float)((double)value[0] / p->means[kind] / p->tops[kind]), rgb);
        return;
    }
    const float scale = kind == ALPI_PICTURE_BENT ? 0.5f : 1.0f;
    for (int k = 0; k < 3; k++) {
        const float shown = scale * value[k] + 1.0f - scale;
        rgb[k] = (uint8_t)lrintf(255.0f * fmaxf(0.0f, fminf(shown, 1.0f)));
    }
}

/// @param film NULL, or the same picture developed
static void color_picture(const alpi_report_pictures *p, alpi_report_picture kind,
                          const alp_image *small, const alp_image *film, uint8_t *bytes)
{
    const float *pixels = small->pixels;
    const size_t count = (size_t)small->info.width * small->info.height;
    for (size_t i = 0; i < count; i++) {
        if (!(pixels[4 * i + 3] > 0.0f)) {
            continue;
        }
        if (film != NULL) {
            memcpy(bytes + 4 * i, (const uint8_t *)film->pixels + 3 * i, 3);
        } else {
            color_pixel(p, kind, pixels + 4 * i, bytes + 4 * i);
        }
        bytes[4 * i + 3] = 255;
    }
}

static alp_result develop(const alpi_report_pictures *p, const alp_image *small, alp_image **film)
{
    alp_film_options options = alp_film_options_default();
    options.exposure = p->exposure;
    options.tone = ALP_TONE_FILM;
    return alp_film_develop(small, &options, film, NULL);
}

alp_result alpi_report_paint(const alpi_report_pictures *p, alpi_report_picture kind, uint32_t page,
                             alp_image **picture)
{
    alp_image *small = NULL, *film = NULL;
    *picture = NULL;
    alp_result result = shrink(p, kind, page, &small);
    if (result == ALP_OK && kind == ALPI_PICTURE_LIGHT) {
        result = develop(p, small, &film);
    }
    if (result == ALP_OK) {
        alp_image_info info = small->info;
        info.component = ALP_COMPONENT_U8;
        result = alp_image_create(p->lightmap->context, info, picture);
    }
    if (result == ALP_OK) {
        color_picture(p, kind, small, film, alp_image_bytes(*picture));
    }
    alp_image_destroy(small);
    alp_image_destroy(film);
    return result;
}
