// SPDX-License-Identifier: MIT
// Skyline packing: each rectangle goes, as it is or turned, to the place where its upper side ends
// lowest, on the first page that has one.
// Based on: J. Jylänki. A Thousand Ways to Pack the Bin. 2010 (skyline, bottom-left).
#include "atlas/stages.h"

#include "base/memory.h"

#include <stdlib.h>

/// A page filled up to `y` from `x` to the next level's x.
typedef struct level {
    uint32_t x, y;
} level;

typedef struct page {
    level *levels;
    size_t count, capacity;
    uint64_t open_area;                 // above the skyline
    uint32_t failed_short, failed_long; // nothing of at least these sides fits
} page;

typedef struct packer {
    alp_context *context;
    uint32_t side, padding, page_limit;
    page *pages;
    size_t page_capacity;
    uint32_t page_count;
    bool quiet; // no message when the pages are full
} packer;

typedef struct place {
    uint32_t x, y, top;
    size_t level;
    bool turned, found;
} place;

typedef struct order_entry {
    uint32_t longer, shorter, item;
} order_entry;

static int compare_entries(const void *a, const void *b)
{
    const order_entry *p = a, *q = b;
    if (p->longer != q->longer) {
        return p->longer > q->longer ? -1 : 1;
    }
    if (p->shorter != q->shorter) {
        return p->shorter > q->shorter ? -1 : 1;
    }
    return p->item < q->item ? -1 : 1;
}

/// Improves `best` by places for width × height (padding included).
static void find_place(const packer *p, const page *on, uint32_t width, uint32_t height,
                       bool turned, place *best)
{
    for (size_t i = 0; i < on->count; i++) {
        uint32_t x = on->levels[i].x, y = 0;
        if (width > p->side - x) {
            break;
        }
        for (size_t j = i; j < on->count && on->levels[j].x < x + width; j++) {
            y = on->levels[j].y > y ? on->levels[j].y : y;
            if (best->found && y + height > best->top) {
                break;
            }
        }
        if (height > p->side - y) {
            continue;
        }
        if (!best->found || y + height < best->top) {
            *best = (place){x, y, y + height, i, turned, true};
        }
    }
}

/// Raises the skyline over [x, x + width) to `top`.
static alp_result raise_skyline(packer *p, page *on, const place *at, uint32_t width)
{
    ALP_TRY(alpi_grow(p->context, (void **)&on->levels, &on->capacity, on->count + 1,
                      sizeof *on->levels));
    size_t end = at->level; // first level that begins at or after the right side
    uint32_t right = at->x + width, last_y = 0;
    uint64_t covered = 0;
    while (end < on->count && on->levels[end].x < right) {
        uint32_t next = end + 1 < on->count ? on->levels[end + 1].x : p->side;
        uint32_t until = next < right ? next : right;
        covered += (uint64_t)(at->top - on->levels[end].y) * (until - on->levels[end].x);
        last_y = on->levels[end++].y;
    }
    on->open_area -= covered;
    bool rest = right < p->side && (end == on->count || on->levels[end].x > right);
    size_t added = rest ? 2 : 1, removed = end - at->level;
    size_t tail = on->count - end;
    level *levels = on->levels;
    if (added > removed) {
        for (size_t i = tail; i-- > 0;) {
            levels[end + i + 1] = levels[end + i];
        }
    } else {
        for (size_t i = 0; i < tail; i++) {
            levels[at->level + added + i] = levels[end + i];
        }
    }
    levels[at->level] = (level){at->x, at->top};
    if (rest) {
        levels[at->level + 1] = (level){right, last_y};
    }
    on->count = on->count + added - removed;
    return ALP_OK;
}

/// Joins levels of one height round level `at`.
static void merge_levels(page *on, size_t at)
{
    size_t from = at > 0 ? at - 1 : 0;
    for (int repeat = 0; repeat < 2; repeat++) {
        size_t next = from + 1;
        if (next < on->count && on->levels[from].y == on->levels[next].y) {
            for (size_t i = next; i + 1 < on->count; i++) {
                on->levels[i] = on->levels[i + 1];
            }
            on->count--;
        } else {
            from++;
        }
    }
}

static alp_result try_page(packer *p, page *on, alpi_pack_item *item, bool *done)
{
    uint32_t width = item->width + p->padding, height = item->height + p->padding;
    uint32_t shorter = width < height ? width : height, longer = width < height ? height : width;
    *done = false;
    if ((uint64_t)width * height > on->open_area ||
        (shorter >= on->failed_short && longer >= on->failed_long)) {
        return ALP_OK;
    }
    place at = {0};
    find_place(p, on, width, height, false, &at);
    if (width != height) {
        find_place(p, on, height, width, true, &at);
    }
    if (!at.found) {
        on->failed_short = shorter;
        on->failed_long = longer;
        return ALP_OK;
    }
    ALP_TRY(raise_skyline(p, on, &at, at.turned ? height : width));
    merge_levels(on, at.level);
    item->x = at.x;
    item->y = at.y;
    item->turned = at.turned;
    *done = true;
    return ALP_OK;
}

static alp_result add_page(packer *p)
{
    if (p->page_count == p->page_limit && p->quiet) {
        return ALP_ERROR_LIMIT;
    }
    if (p->page_count == p->page_limit) {
        return alpi_fail(p->context, ALP_ERROR_LIMIT,
                         "the charts need more than %u page%s of %u texels; use fewer texels per "
                         "metre, a larger size or less padding",
                         p->page_limit, p->page_limit == 1 ? "" : "s", p->side - p->padding);
    }
    ALP_TRY(alpi_grow(p->context, (void **)&p->pages, &p->page_capacity, (size_t)p->page_count + 1,
                      sizeof *p->pages));
    page *added = &p->pages[p->page_count];
    *added = (page){.open_area = (uint64_t)p->side * p->side,
                    .failed_short = UINT32_MAX,
                    .failed_long = UINT32_MAX};
    p->page_count++;
    ALP_TRY(alpi_grow(p->context, (void **)&added->levels, &added->capacity, 16,
                      sizeof *added->levels));
    added->levels[0] = (level){0, 0};
    added->count = 1;
    return ALP_OK;
}

static alp_result place_item(packer *p, alpi_pack_item *item)
{
    bool done = false;
    for (uint32_t i = 0; !done; i++) {
        if (i == p->page_count) {
            ALP_TRY(add_page(p));
        }
        ALP_TRY(try_page(p, &p->pages[i], item, &done));
        item->page = i;
    }
    return ALP_OK;
}

static alp_result place_all(packer *p, alpi_pack_item *items, uint32_t count, order_entry *order)
{
    uint32_t size = p->side - p->padding;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t w = items[i].width, h = items[i].height;
        if (w == 0 || h == 0 || w > size || h > size) {
            return alpi_fail(p->context, ALP_ERROR_LIMIT,
                             "a chart of %u x %u texels does not fit a page of %u texels", w, h,
                             size);
        }
        order[i] = (order_entry){w > h ? w : h, w > h ? h : w, i};
    }
    qsort(order, count, sizeof *order, compare_entries);
    for (uint32_t i = 0; i < count; i++) {
        ALP_TRY(place_item(p, &items[order[i].item]));
    }
    return ALP_OK;
}

static alp_result pack(packer *p, alpi_pack_item *items, uint32_t count)
{
    order_entry *order = ALPI_NEW(p->context, order_entry, count);
    alp_result result = order == NULL ? ALP_ERROR_OUT_OF_MEMORY : place_all(p, items, count, order);
    for (uint32_t i = 0; i < p->page_count; i++) {
        alpi_release(p->context, p->pages[i].levels);
    }
    alpi_release(p->context, p->pages);
    alpi_release(p->context, order);
    return result;
}

alp_result alpi_pack(alp_context *context, alpi_pack_item *items, uint32_t count, uint32_t size,
                     uint32_t padding, uint32_t page_limit, uint32_t *page_count)
{
    // An item carries its padding on two sides; the page is as much larger, so that the border
    // needs none.
    packer p = {
        .context = context, .side = size + padding, .padding = padding, .page_limit = page_limit};
    alp_result result = pack(&p, items, count);
    *page_count = p.page_count;
    return result;
}

alp_result alpi_pack_one_page(alp_context *context, alpi_pack_item *items, uint32_t count,
                              uint32_t size, uint32_t padding, bool *fits)
{
    packer p = {.context = context,
                .side = size + padding,
                .padding = padding,
                .page_limit = 1,
                .quiet = true};
    *fits = false;
    uint64_t area = 0, room = (uint64_t)p.side * p.side;
    for (uint32_t i = 0; i < count; i++) {
        area += (uint64_t)(items[i].width + padding) * (items[i].height + padding);
        if (items[i].width > size || items[i].height > size || area > room) {
            return ALP_OK;
        }
    }
    alp_result result = pack(&p, items, count);
    *fits = result == ALP_OK;
    return result == ALP_ERROR_LIMIT ? ALP_OK : result;
}
