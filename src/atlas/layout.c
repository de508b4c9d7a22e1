// SPDX-License-Identifier: MIT
// How many texels a metre gets and where each chart goes: the highest density at which all charts
// fit one page, or a given density and as many pages as that takes.
#include "atlas/stages.h"

#include "base/memory.h"

#include <math.h>

// A chart smaller than a texel has a texel of its own; it is drawn this large in it, so that its
// coordinates stay apart in 32-bit floats: the longer side and the shorter one, in texels.
static const double SMALLEST_LONGER_SIDE = 0.5;
static const double SMALLEST_SHORTER_SIDE = 1.0 / 16.0;

enum { PACKING_LIMIT = 20 }; // of the search for the density

typedef struct layout {
    alp_atlas *atlas;
    alpi_charts *charts;
    alpi_atlas_clock *clock;
    alpi_pack_item *items; // [chart_capacity]
    size_t item_capacity;
    uint32_t packings;
} layout;

static double longer_side(const alpi_chart *chart)
{
    return fmax(chart->width, chart->height);
}

/// Sides of a chart in texels; zero for a chart that is a line or a point to 32-bit floats.
static void chart_sides(const alpi_chart *chart, double density, double sides[2])
{
    sides[0] = sides[1] = 0.0;
    if (chart->width > 0.0 && chart->height > 0.0) {
        double scale = fmax(density, SMALLEST_LONGER_SIDE / longer_side(chart));
        sides[0] = fmax(chart->width * scale, SMALLEST_SHORTER_SIDE);
        sides[1] = fmax(chart->height * scale, SMALLEST_SHORTER_SIDE);
    }
}

static uint32_t whole_texels(double side)
{
    return side <= 1.0 ? 1 : (uint32_t)fmin(ceil(side - 1e-5), 1e9);
}

static alp_result size_items(layout *l, double density)
{
    ALP_TRY(alpi_grow(l->atlas->context, (void **)&l->items, &l->item_capacity, l->charts->count,
                      sizeof *l->items));
    for (uint32_t c = 0; c < l->charts->count; c++) {
        double sides[2];
        chart_sides(&l->charts->charts[c], density, sides);
        l->items[c] =
            (alpi_pack_item){.width = whole_texels(sides[0]), .height = whole_texels(sides[1])};
    }
    return ALP_OK;
}

static alp_result try_density(layout *l, double density, bool *fits)
{
    const alp_atlas_options *options = &l->atlas->options;
    ALP_TRY(alpi_atlas_tick(l->clock, "packing", l->packings++, PACKING_LIMIT));
    ALP_TRY(size_items(l, density));
    return alpi_pack_one_page(l->atlas->context, l->items, l->charts->count, options->size,
                              options->padding, fits);
}

/// Texels per metre at which the boxes of the charts would fill one page.
static double full_density(const layout *l, double *longest)
{
    double area = 0.0;
    *longest = 0.0;
    for (uint32_t c = 0; c < l->charts->count; c++) {
        area += l->charts->charts[c].width * l->charts->charts[c].height;
        *longest = fmax(*longest, longer_side(&l->charts->charts[c]));
    }
    double size = (double)l->atlas->options.size;
    double density = size / sqrt(fmax(area, 1e-300));
    return fmin(density, size / fmax(*longest, 1e-300));
}

/// The highest density that fits one page, to half a percent: bracketed, then bisected.
/// 0 = none does, not even a texel for each chart.
static alp_result search_density(layout *l, double *density)
{
    bool fits = false;
    *density = 0.0;
    ALP_TRY(try_density(l, 0.0, &fits));
    if (!fits) {
        return ALP_OK;
    }
    double longest, most = full_density(l, &longest);
    double low = 0.0, high = most * (1.0 + 1e-9), next = 0.9 * most, step = 0.85;
    ALP_TRY(try_density(l, high, &fits));
    if (fits) {
        *density = high;
        return ALP_OK;
    }
    while (l->packings < PACKING_LIMIT && (low == 0.0 || high > 1.005 * low)) {
        ALP_TRY(try_density(l, next, &fits));
        low = fits ? next : low;
        high = fits ? high : next;
        next = low > 0.0 ? sqrt(low * high) : high * step;
        step *= 0.9; // faster when the estimate was far off
    }
    *density = low > 0.0 ? low : fmin(high, 1.0 / longest); // there every chart is one texel
    return ALP_OK;
}

// --- placing -------------------------------------------------------------------------------------

/// A chart without area in 32-bit floats: each of its triangles is drawn over half of its texel.
static void place_point_chart(alp_atlas *atlas, const alpi_chart *chart, const uint32_t *triangles,
                              const alpi_pack_item *item)
{
    static const double corner[3][2] = {{0.25, 0.25}, {0.75, 0.25}, {0.5, 0.75}};
    for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
        for (int k = 0; k < 3; k++) {
            float *uv = atlas->corner_uvs[triangles[i]][k];
            uv[0] = (float)((item->x + corner[k][0]) / atlas->options.size);
            uv[1] = (float)((item->y + corner[k][1]) / atlas->options.size);
        }
    }
}

/// Metres → page coordinates, the chart in the middle of its texels.
static void place_chart(alp_atlas *atlas, const alpi_chart *chart, const uint32_t *triangles,
                        const alpi_pack_item *item, double density)
{
    double size = (double)atlas->options.size, sides[2];
    chart_sides(chart, density, sides);
    double scale_x = sides[0] / chart->width, scale_y = sides[1] / chart->height;
    double rest_x =
        0.5 * ((item->turned ? item->height : item->width) - (item->turned ? sides[1] : sides[0]));
    double rest_y =
        0.5 * ((item->turned ? item->width : item->height) - (item->turned ? sides[0] : sides[1]));
    for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
        for (int k = 0; k < 3; k++) {
            float *uv = atlas->corner_uvs[triangles[i]][k];
            double x = (double)uv[0] * scale_x, y = (double)uv[1] * scale_y;
            double turned_x = item->turned ? sides[1] - y : x; // by 90°, never mirrored
            double turned_y = item->turned ? x : y;
            uv[0] = (float)fmin(fmax((item->x + rest_x + turned_x) / size, 0.0), 1.0);
            uv[1] = (float)fmin(fmax((item->y + rest_y + turned_y) / size, 0.0), 1.0);
        }
    }
}

static void place_all(layout *l, double density)
{
    for (uint32_t c = 0; c < l->charts->count; c++) {
        const alpi_chart *chart = &l->charts->charts[c];
        if (chart->width > 0.0 && chart->height > 0.0) {
            place_chart(l->atlas, chart, l->charts->triangles, &l->items[c], density);
        } else {
            place_point_chart(l->atlas, chart, l->charts->triangles, &l->items[c]);
        }
        for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
            l->atlas->triangle_pages[l->charts->triangles[i]] = l->items[c].page;
        }
    }
}

/// All charts on one page of one texel, one over the other.
static alp_result share_one_texel(layout *l)
{
    double longest;
    full_density(l, &longest);
    ALP_TRY(size_items(l, 0.0));
    place_all(l, 1.0 / fmax(longest, 1e-300));
    l->atlas->info.pages = 1;
    return ALP_OK;
}

static alp_result choose_and_place(layout *l)
{
    const alp_atlas_options *options = &l->atlas->options;
    double density = options->texels_per_metre;
    if (density == 0.0) {
        ALP_TRY(search_density(l, &density));
        if (density == 0.0 && options->size == 1) {
            return share_one_texel(l);
        }
        if (density == 0.0) { // more charts than a page has room for: pages are added
            double longest;
            density = full_density(l, &longest);
            alpi_note(l->atlas->context, "atlas-pages", l->atlas->scene->name,
                      "%u charts do not fit one page of %u texels: pages are added",
                      l->charts->count, options->size);
        }
    } else {
        ALP_TRY(alpi_charts_split(l->atlas, density, l->charts));
    }
    ALP_TRY(alpi_atlas_tick(l->clock, "packing", PACKING_LIMIT, PACKING_LIMIT));
    ALP_TRY(size_items(l, density));
    ALP_TRY(alpi_pack(l->atlas->context, l->items, l->charts->count, options->size,
                      options->padding, ALPI_ATLAS_PAGE_LIMIT, &l->atlas->info.pages));
    place_all(l, density);
    return ALP_OK;
}

alp_result alpi_layout(alp_atlas *atlas, alpi_charts *charts, alpi_atlas_clock *clock)
{
    layout l = {.atlas = atlas, .charts = charts, .clock = clock};
    alp_result result = choose_and_place(&l);
    alpi_release(atlas->context, l.items);
    return result;
}
