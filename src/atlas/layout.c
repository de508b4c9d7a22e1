// SPDX-License-Identifier: MIT
// How many texels a metre gets and where each chart goes: the highest density at which all charts
// fit one page, or a given density and as many pages as that takes.
#include "atlas/blend.h"
#include "atlas/frame.h"
#include "atlas/pack.h"
#include "atlas/stages.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <string.h>

enum {
    PACKING_LIMIT = 20,    // of the search for the density
    SEARCHED_CHARTS = 512, // more of them fill their page in any order
    STALE_ROUNDS = 24,     // of other orders without a better one
    MOST_ROUNDS = 64,      // in all; fewer on large pages and with many charts:
    ROUND_CHARTS = 128,    // this many halve them
    MANY_CHARTS = 10000,   // each packing takes long
    CHARTS_PER_RANGE = 64,
    MOST_PARTS = 4,      // of a page's side, that charts are cut to
    MOST_WORDS = 1 << 25 // of rows looked at, after which no other cuts are tried
};

// Of the page, charts and gaps, at the first density that is tried.
static const double LIKELY_UTILISATION = 0.85;
static const double ROUND_TEXELS = 64.0 * 1024 * 1024; // of all rounds' pages
static const double FULL_PAGE = 0.85;     // of its texels in charts: gaps are most of the rest
static const double DENSITY_STEP = 1.004; // by which other orders must be better
static const double FULL_PAGES = 0.75;    // of all pages' texels in charts: no more cuts are made

typedef struct layout {
    alp_atlas *atlas;
    const uint32_t (*neighbours)[3];
    alpi_charts *charts;
    alpi_atlas_clock *clock;
    alpi_pack_rules rules;
    alpi_pack_item *items; // [chart_capacity]
    size_t item_capacity;
    alpi_pack_item *best; // [chart_capacity] as they lay at the highest density that fitted
    size_t best_capacity;
    uint64_t *bits; // the items' masks
    size_t bit_capacity;
    double density; // at which they are drawn
    uint32_t packings;
    uint64_t rows_tried; // of several pages
} layout;

static size_t mask_words(const alpi_pack_item *item)
{
    return (size_t)((item->width + 63) / 64) * item->height;
}

// --- what is packed ------------------------------------------------------------------------------

static alp_result draw_charts(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const layout *l = user;
    for (uint32_t c = begin; c < end; c++) {
        const alpi_chart *chart = &l->charts->charts[c];
        const alpi_frame frame = alpi_frame_of(chart, l->density);
        alpi_frame_draw(l->atlas, &frame, chart, l->charts->triangles,
                        l->bits + (l->items[c].mask - l->bits));
    }
    return ALP_OK;
}

/// Draws all charts at a density; *large: one is larger than a page, and nothing was drawn.
static alp_result make_items(layout *l, double density, bool *large)
{
    alp_context *context = l->atlas->context;
    ALP_TRY(alpi_grow(context, (void **)&l->items, &l->item_capacity, l->charts->count,
                      sizeof *l->items));
    size_t words = 0;
    *large = false;
    for (uint32_t c = 0; c < l->charts->count && !*large; c++) {
        const alpi_frame frame = alpi_frame_of(&l->charts->charts[c], density);
        l->items[c] = (alpi_pack_item){.width = frame.width, .height = frame.height};
        *large = frame.width > l->rules.size || frame.height > l->rules.size;
        words += mask_words(&l->items[c]);
    }
    if (*large) {
        return ALP_OK;
    }
    ALP_TRY(alpi_grow(context, (void **)&l->bits, &l->bit_capacity, words, sizeof *l->bits));
    memset(l->bits, 0, words * sizeof *l->bits);
    words = 0;
    for (uint32_t c = 0; c < l->charts->count; c++) {
        l->items[c].mask = l->bits + words;
        words += mask_words(&l->items[c]);
    }
    l->density = density;
    return alpi_parallel_for(context, l->charts->count, CHARTS_PER_RANGE, draw_charts, l, NULL);
}

// --- the density ---------------------------------------------------------------------------------

/// Packs into one page; what fits is kept as the best there is.
static alp_result try_density(layout *l, double density, bool *fits)
{
    ALP_TRY(alpi_atlas_tick(l->clock, "packing", l->packings++, PACKING_LIMIT));
    bool large;
    *fits = false;
    ALP_TRY(make_items(l, density, &large));
    if (!large) {
        ALP_TRY(alpi_pack_one_page(l->atlas->context, &l->rules, l->items, l->charts->count, fits));
    }
    if (*fits) {
        ALP_TRY(alpi_grow(l->atlas->context, (void **)&l->best, &l->best_capacity, l->charts->count,
                          sizeof *l->best));
        memcpy(l->best, l->items, l->charts->count * sizeof *l->best);
    }
    return ALP_OK;
}

/// What the density is sought by.
typedef struct extent {
    double area;       // of all charts, m²
    double half_round; // half of the way round their boxes, m
    double longest;    // side of a box, m
} extent;

static extent measure_charts(const layout *l)
{
    extent all = {0};
    for (uint32_t c = 0; c < l->charts->count; c++) {
        const alpi_chart *chart = &l->charts->charts[c];
        for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
            const float(*p)[2] = (const float(*)[2])l->atlas->corner_uvs[l->charts->triangles[i]];
            const double ax = (double)p[1][0] - (double)p[0][0];
            const double ay = (double)p[1][1] - (double)p[0][1];
            const double bx = (double)p[2][0] - (double)p[0][0];
            const double by = (double)p[2][1] - (double)p[0][1];
            all.area += 0.5 * fabs(ax * by - ay * bx);
        }
        all.half_round += chart->width + chart->height;
        all.longest = fmax(all.longest, fmax(chart->width, chart->height));
    }
    return all;
}

/// Texels per metre that no packing on one page exceeds.
static double most_density(const layout *l, const extent *all)
{
    const double size = l->rules.size;
    return fmin(size / sqrt(fmax(all->area, 1e-300)), size / fmax(all->longest, 1e-300));
}

/// Where to look first: charts with half of their gaps round them, d² area + d gap half_round +
/// count gap², fill most of the page.
static double likely_density(const layout *l, const extent *all)
{
    const double gap = l->rules.padding, size = l->rules.size;
    const double room = LIKELY_UTILISATION * size * size - l->charts->count * gap * gap;
    const double half = 0.5 * gap * all->half_round;
    const double area = fmax(all->area, 1e-300);
    return room > 0.0 ? (sqrt(half * half + area * room) - half) / area : 0.0;
}

/// The highest density that fits one page, to half a percent (with many charts, to one): bracketed,
/// then bisected.
/// 0 = none does, not even a texel for each chart.
static alp_result search_density(layout *l, double *density)
{
    const extent all = measure_charts(l);
    const double most = most_density(l, &all) * (1.0 + 1e-9);
    const double near = l->charts->count > MANY_CHARTS ? 1.01 : 1.005;
    double low = 0.0, high = most, step = 1.06;
    double next = fmin(likely_density(l, &all), 0.97 * most);
    bool fits = false;
    *density = 0.0;
    ALP_TRY(try_density(l, 0.0, &fits));
    if (!fits) {
        return ALP_OK;
    }
    ALP_TRY(try_density(l, most, &fits));
    if (fits) {
        *density = most;
        return ALP_OK;
    }
    next = next > 0.0 ? next : 0.5 * most;
    while (l->packings < PACKING_LIMIT && (low == 0.0 || high > near * low)) {
        ALP_TRY(try_density(l, next, &fits));
        low = fits ? next : low;
        high = fits ? high : next;
        if (low == 0.0 || high == most) { // faster when the estimate was far off
            next = fits ? fmin(low * step, sqrt(low * high)) : high / step;
            step *= step;
        } else {
            next = sqrt(low * high);
        }
    }
    *density = low > 0.0 ? low : fmin(high, 1.0 / all.longest); // there every chart is one texel
    return ALP_OK;
}

/// Rounds of other orders until all fits, or it does not get better.
static alp_result search_orders(layout *l, alpi_pack_search *search, uint32_t *rounds, bool *fits)
{
    const alpi_pack_variant *best = &search->variants[ALPI_PACK_VARIANTS];
    uint64_t least = UINT64_MAX;
    for (uint32_t stale = 0; *rounds > 0 && stale < STALE_ROUNDS && !*fits; --*rounds) {
        ALP_TRY(alpi_atlas_tick(l->clock, "packing", PACKING_LIMIT - 1, PACKING_LIMIT));
        ALP_TRY(alpi_pack_search_round(search, l->items, least == UINT64_MAX, fits));
        stale = best->left_texels < least ? 0 : stale + 1;
        least = best->left_texels;
    }
    return ALP_OK;
}

static alp_result raise_density(layout *l, alpi_pack_search *search, double *density)
{
    const extent all = measure_charts(l);
    const double most = most_density(l, &all), size = l->rules.size;
    uint32_t rounds = (uint32_t)fmin(MOST_ROUNDS, ROUND_TEXELS / (size * size));
    rounds = rounds * ROUND_CHARTS / (ROUND_CHARTS + l->charts->count);
    rounds = all.area * *density * *density > FULL_PAGE * size * size ? 0 : rounds;
    while (rounds > 0 && *density * DENSITY_STEP <= most) {
        bool large, fits = false;
        ALP_TRY(make_items(l, *density * DENSITY_STEP, &large));
        if (!large) {
            ALP_TRY(search_orders(l, search, &rounds, &fits));
        }
        if (!fits) {
            break;
        }
        *density *= DENSITY_STEP;
        memcpy(l->best, l->items, l->charts->count * sizeof *l->best);
    }
    return ALP_OK;
}

/// Denser yet by other orders, where charts are so few that the order decides.
static alp_result improve_density(layout *l, double *density)
{
    if (l->charts->count < 2 || l->charts->count > SEARCHED_CHARTS) {
        return ALP_OK;
    }
    alpi_pack_search search;
    alp_result result =
        alpi_pack_search_create(l->atlas->context, &l->rules, l->best, l->charts->count, &search);
    result = result == ALP_OK ? raise_density(l, &search, density) : result;
    alpi_pack_search_destroy(&search);
    return result;
}

// --- placing -------------------------------------------------------------------------------------

/// Metres → page coordinates.
static void place_chart(const layout *l, uint32_t c, double density)
{
    const alpi_chart *chart = &l->charts->charts[c];
    const alpi_pack_item *item = &l->items[c];
    const alpi_frame frame = alpi_frame_of(chart, density);
    const double size = l->rules.size;
    for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
        const uint32_t t = l->charts->triangles[i];
        for (int k = 0; k < 3; k++) {
            float *uv = l->atlas->corner_uvs[t][k];
            double p[2];
            alpi_frame_corner(&frame, uv, k, p);
            alpi_frame_turn(&frame, item->turns, p);
            uv[0] = (float)fmin(fmax((item->x + p[0]) / size, 0.0), 1.0);
            uv[1] = (float)fmin(fmax((item->y + p[1]) / size, 0.0), 1.0);
        }
        l->atlas->triangle_pages[t] = item->page;
    }
}

static void place_all(layout *l, double density)
{
    for (uint32_t c = 0; c < l->charts->count; c++) {
        place_chart(l, c, density);
    }
}

/// All charts on one page of one texel, one over the other.
static alp_result share_one_texel(layout *l, double longest)
{
    bool large;
    ALP_TRY(make_items(l, 0.0, &large));
    place_all(l, 1.0 / fmax(longest, 1e-300));
    l->atlas->info.pages = 1;
    return ALP_OK;
}

static alp_result pack_items(layout *l)
{
    alp_context *context = l->atlas->context;
    uint32_t *pages = &l->atlas->info.pages, *groups = NULL;
    if (l->charts->blend == NULL) {
        return alpi_pack(context, &l->rules, l->items, l->charts->count, ALPI_ATLAS_PAGE_LIMIT,
                         pages);
    }
    ALP_TRY(alpi_blend_groups(l->atlas, l->charts, l->items, &groups));
    const alp_result result = alpi_pack_groups(context, &l->rules, l->items, groups,
                                               l->charts->count, ALPI_ATLAS_PAGE_LIMIT, pages);
    alpi_release(context, groups);
    return result;
}

/// Into as many pages as it takes.
static alp_result pack_pages(layout *l, double density)
{
    bool large;
    ALP_TRY(alpi_atlas_tick(l->clock, "packing", PACKING_LIMIT, PACKING_LIMIT));
    ALP_TRY(make_items(l, density, &large));
    return pack_items(l);
}

/// As dense as one page allows.
static alp_result fill_page(layout *l)
{
    double density;
    ALP_TRY(search_density(l, &density));
    if (density > 0.0) {
        ALP_TRY(improve_density(l, &density));
        memcpy(l->items, l->best, l->charts->count * sizeof *l->items);
        l->atlas->info.pages = 1;
        place_all(l, density);
        return ALP_OK;
    }
    const extent all = measure_charts(l);
    if (l->rules.size == 1) {
        return share_one_texel(l, all.longest);
    }
    alpi_note(l->atlas->context, "atlas-pages", l->atlas->scene->name,
              "%u charts do not fit one page of %u texels: pages are added", l->charts->count,
              l->rules.size);
    ALP_TRY(pack_pages(l, most_density(l, &all)));
    place_all(l, most_density(l, &all));
    return ALP_OK;
}

// --- a given density -----------------------------------------------------------------------------

/// Charts as they are before they are cut.
typedef struct whole_charts {
    uint32_t count, triangle_count;
    alpi_chart *charts;
    uint32_t *triangles; // [triangle_count]
    float (*uvs)[3][2];  // [triangle_count] metres
} whole_charts;

static void whole_charts_destroy(alp_context *context, whole_charts *w)
{
    alpi_release(context, w->charts);
    alpi_release(context, w->triangles);
    alpi_release(context, w->uvs);
}

static alp_result whole_charts_keep(const layout *l, whole_charts *w)
{
    alp_context *context = l->atlas->context;
    w->count = l->charts->count;
    for (uint32_t c = 0; c < w->count; c++) {
        w->triangle_count += l->charts->charts[c].count;
    }
    ALPI_TRY_NEW(context, w->charts, w->count);
    ALPI_TRY_NEW(context, w->triangles, w->triangle_count);
    ALPI_TRY_NEW(context, w->uvs, w->triangle_count);
    memcpy(w->charts, l->charts->charts, w->count * sizeof *w->charts);
    memcpy(w->triangles, l->charts->triangles, w->triangle_count * sizeof *w->triangles);
    for (uint32_t i = 0; i < w->triangle_count; i++) {
        memcpy(w->uvs[i], l->atlas->corner_uvs[w->triangles[i]], sizeof *w->uvs);
    }
    return ALP_OK;
}

static void whole_charts_restore(const layout *l, const whole_charts *w)
{
    l->charts->count = w->count;
    memcpy(l->charts->charts, w->charts, w->count * sizeof *w->charts);
    memcpy(l->charts->triangles, w->triangles, w->triangle_count * sizeof *w->triangles);
    for (uint32_t i = 0; i < w->triangle_count; i++) {
        memcpy(l->atlas->corner_uvs[w->triangles[i]], w->uvs[i], sizeof *w->uvs);
    }
    for (uint32_t c = 0; c < w->count; c++) {
        const alpi_chart *chart = &w->charts[c];
        for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
            l->atlas->triangle_charts[w->triangles[i]] = c;
        }
    }
}

/// Texels of the side of a part of which `parts` lie side by side in a page, with gaps.
static uint32_t part_texels(const alpi_pack_rules *rules, uint32_t parts)
{
    const uint32_t cell = rules->mips > 0 ? 1u << (rules->mips - 1) : 1;
    const uint32_t gap = rules->mips > 0 && 2 * cell > rules->padding ? 2 * cell : rules->padding;
    const uint32_t gaps = (parts - 1) * gap;
    const uint32_t unit = parts == 1 ? 1 : rules->block > cell ? rules->block : cell;
    const uint32_t side = rules->size > gaps ? (rules->size - gaps) / parts / unit * unit : 0;
    return side > 0 ? side : 1;
}

/// Cuts what is larger than a part. Overlapping charts are only cut where they are larger than a
/// page, but then so that those that share triangles fit one together.
static alp_result cut_charts(layout *l, double density, uint32_t parts)
{
    alpi_cut_sides sides = {.page = alpi_part_side(l->rules.size, density), .texel = 1.0 / density};
    sides.part =
        alpi_part_side(part_texels(&l->rules, l->charts->blend != NULL ? 2 : parts), density);
    sides.limit = l->charts->blend != NULL ? sides.page : sides.part;
    return alpi_charts_cut(l->atlas, l->neighbours, &sides, l->charts);
}

/// Whether there is room to save a page, charts counted with half of the gaps round them.
static bool is_wasteful(const layout *l)
{
    uint64_t room = 0;
    for (uint32_t c = 0; c < l->charts->count; c++) {
        const alpi_pack_item *item = &l->items[c];
        room += l->rules.padding * ((uint64_t)item->width + item->height);
        for (size_t i = 0; i < mask_words(item); i++) {
            room += (uint64_t)__builtin_popcountll(item->mask[i]);
        }
    }
    const double page = (double)l->rules.size * l->rules.size, pages = l->atlas->info.pages;
    return (double)room < fmin(FULL_PAGES * pages, LIKELY_UTILISATION * (pages - 1.0)) * page;
}

/// One way to cut and to pack.
typedef struct attempt {
    uint32_t parts, charts, pages;
    bool by_middle;
} attempt;

/// @param former how many charts another attempt cut: as many are the same, and not packed again
static alp_result make_attempt(layout *l, double density, const whole_charts *whole,
                               uint32_t former, attempt *a)
{
    whole_charts_restore(l, whole);
    ALP_TRY(cut_charts(l, density, a->parts));
    if (l->charts->count != former) {
        l->rules.by_middle = a->by_middle;
        ALP_TRY(pack_pages(l, density));
        a->pages = l->atlas->info.pages;
    }
    a->charts = l->charts->count;
    return ALP_OK;
}

/// Cuts charts into ever smaller parts of a page, until the pages are well filled or it takes too
/// long, and takes the first attempt of those that need the fewest pages.
static alp_result pack_parts(layout *l, double density, const whole_charts *whole)
{
    const uint64_t words = (l->rules.size + 63) / 64;
    const uint32_t most = l->charts->blend != NULL ? 1 : 2 * MOST_PARTS;
    attempt last[2] = {{0}, {0}}, best = {.pages = UINT32_MAX};
    bool is_packed = false;
    l->rules.rows_tried = &l->rows_tried;
    for (uint32_t i = 0; i < most && l->rows_tried * words < MOST_WORDS; i++) {
        attempt *now = &last[i % 2];
        now->parts = 1 + i / 2;
        now->by_middle = i % 2 == 1;
        ALP_TRY(make_attempt(l, density, whole, now->charts, now));
        is_packed = now->pages < best.pages;
        best = is_packed ? *now : best;
        if (!is_wasteful(l)) {
            break;
        }
    }
    ALP_TRY(is_packed ? ALP_OK : make_attempt(l, density, whole, 0, &best));
    place_all(l, density);
    return ALP_OK;
}

static alp_result fill_pages(layout *l, double density)
{
    whole_charts whole = {0};
    ALP_TRY(alpi_charts_check(l->atlas, density, l->charts));
    alp_result result = whole_charts_keep(l, &whole);
    result = result == ALP_OK ? pack_parts(l, density, &whole) : result;
    whole_charts_destroy(l->atlas->context, &whole);
    return result;
}

static alp_result choose_and_place(layout *l)
{
    const double density = l->atlas->options.texels_per_metre;
    return density == 0.0 ? fill_page(l) : fill_pages(l, density);
}

alp_result alpi_layout(alp_atlas *atlas, const uint32_t (*neighbours)[3], alpi_charts *charts,
                       alpi_atlas_clock *clock)
{
    const alp_atlas_options *options = &atlas->options;
    layout l = {.atlas = atlas,
                .neighbours = neighbours,
                .charts = charts,
                .clock = clock,
                .rules = {.size = options->size,
                          .padding = options->padding,
                          .block = options->block,
                          .mips = options->mips}};
    alp_result result = choose_and_place(&l);
    alpi_release(atlas->context, l.items);
    alpi_release(atlas->context, l.best);
    alpi_release(atlas->context, l.bits);
    return result;
}
