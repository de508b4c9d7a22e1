// SPDX-License-Identifier: MIT
// A page as bits: where a shape has room, all columns of a row at a time. A stretch of n texels is
// blocked at x where any of the texels x … x + n − 1 is: the row's bits, moved over each other by
// doubling steps.
#include "atlas/pack.h"

#include "base/memory.h"

#include <string.h>

alp_result alpi_pack_page_create(alp_context *context, uint32_t size, alpi_pack_page *page)
{
    *page = (alpi_pack_page){.size = size, .words = (size + 63) / 64};
    ALPI_TRY_NEW(context, page->blocked, (size_t)size * page->words);
    ALPI_TRY_NEW(context, page->gaps, size);
    ALPI_TRY_NEW(context, page->open, page->words);
    ALPI_TRY_NEW(context, page->moved, page->words);
    page->free_texels = (uint64_t)size * size;
    for (uint32_t y = 0; y < size; y++) {
        page->gaps[y] = (uint16_t)size;
        if (size % 64 != 0) {
            page->blocked[(size_t)(y + 1) * page->words - 1] = UINT64_MAX << (size % 64);
        }
    }
    return ALP_OK;
}

void alpi_pack_page_destroy(alp_context *context, alpi_pack_page *page)
{
    alpi_release(context, page->blocked);
    alpi_release(context, page->gaps);
    alpi_release(context, page->open);
    alpi_release(context, page->moved);
}

// --- finding room --------------------------------------------------------------------------------

/// Words [first, end) of a row's bits moved down by `by`; beyond the row all is blocked.
static void move_down(const uint64_t *row, uint32_t words, uint32_t by, uint32_t first,
                      uint32_t end, uint64_t *out)
{
    const uint32_t whole = by / 64, bits = by % 64;
    for (uint32_t i = first; i < end; i++) {
        const uint64_t low = i + whole < words ? row[i + whole] : UINT64_MAX;
        const uint64_t high = i + whole + 1 < words ? row[i + whole + 1] : UINT64_MAX;
        out[i] = bits == 0 ? low : low >> bits | high << (64 - bits);
    }
}

/// Adds to each bit the one `by` above it, in place; beyond `end` all is blocked.
static void smear(uint64_t *moved, uint32_t by, uint32_t first, uint32_t end)
{
    const uint32_t whole = by / 64, bits = by % 64;
    uint32_t i = first;
    if (bits == 0) {
        for (; i + whole < end; i++) {
            moved[i] |= moved[i + whole];
        }
    } else {
        for (; i + whole + 1 < end; i++) {
            moved[i] |= moved[i + whole] >> bits | moved[i + whole + 1] << (64 - bits);
        }
        if (i + whole < end) {
            moved[i] |= moved[i + whole] >> bits | UINT64_MAX << (64 - bits);
            i++;
        }
    }
    for (; i < end; i++) {
        moved[i] = UINT64_MAX;
    }
}

/// Takes away the places at which a stretch of a row is blocked; `first` and `end` close in on the
/// words that have places left.
static void close_places(const alpi_pack_page *page, const uint64_t *row, const alpi_run *run,
                         uint32_t *first, uint32_t *end)
{
    const uint32_t length = (uint32_t)run->end - run->begin;
    // Places in words before `end` see no further than this.
    const uint32_t reach = *end + length / 64 + 2;
    const uint32_t stop = reach < page->words ? reach : page->words;
    uint64_t *moved = page->moved;
    move_down(row, page->words, run->begin, *first, stop, moved);
    for (uint32_t covered = 1, step; covered < length; covered += step) {
        step = covered < length - covered ? covered : length - covered;
        smear(moved, step, *first, stop);
    }
    for (uint32_t i = *first; i < *end; i++) {
        page->open[i] &= ~moved[i];
    }
    while (*first < *end && page->open[*first] == 0) {
        ++*first;
    }
    while (*first < *end && page->open[*end - 1] == 0) {
        --*end;
    }
}

/// The places 0 … last of a row are open.
static void open_places(const alpi_pack_page *page, uint32_t last, uint32_t *end)
{
    *end = last / 64 + 1;
    memset(page->open, 0xff, *end * sizeof *page->open);
    page->open[*end - 1] >>= 63 - last % 64;
}

bool alpi_pack_page_find(const alpi_pack_page *page, const alpi_shape *shape, uint32_t y,
                         uint32_t *x)
{
    const alpi_run *runs = shape->runs;
    if (runs[0].end - runs[0].begin > page->gaps[y + runs[0].row]) {
        return false;
    }
    for (uint32_t i = 1; i < shape->run_count; i++) {
        if (runs[i].end - runs[i].begin > page->gaps[y + runs[i].row]) {
            return false;
        }
    }
    uint32_t first = 0, end;
    open_places(page, page->size - shape->width, &end);
    for (uint32_t i = 0; i < shape->run_count && first < end; i++) {
        close_places(page, page->blocked + (size_t)(y + runs[i].row) * page->words, &runs[i],
                     &first, &end);
    }
    if (first >= end) {
        return false;
    }
    *x = first * 64 + (uint32_t)__builtin_ctzll(page->open[first]);
    return true;
}

// --- taking it -----------------------------------------------------------------------------------

/// Blocks the columns [begin, end) of a row.
static void block(alpi_pack_page *page, uint32_t y, uint32_t begin, uint32_t end)
{
    uint64_t *row = page->blocked + (size_t)y * page->words;
    for (uint32_t i = begin / 64; i <= (end - 1) / 64; i++) {
        uint64_t bits = UINT64_MAX;
        bits &= i == begin / 64 ? UINT64_MAX << (begin % 64) : UINT64_MAX;
        bits &= i == (end - 1) / 64 ? UINT64_MAX >> (63 - (end - 1) % 64) : UINT64_MAX;
        page->free_texels -= (uint64_t)__builtin_popcountll(bits & ~row[i]);
        row[i] |= bits;
    }
}

/// The cells of side `cell` that hold [begin, end), and `gap` more on both sides, in texels.
static void widen(uint32_t begin, uint32_t end, uint32_t cell, uint32_t gap, uint32_t size,
                  uint32_t range[2])
{
    const uint32_t first = begin / cell, last = (end - 1) / cell + gap + 1;
    range[0] = first > gap ? (first - gap) * cell : 0;
    range[1] = last < size / cell + 1 && last * cell < size ? last * cell : size;
}

static void take_cells(alpi_pack_page *page, const alpi_shape *shape, uint32_t x, uint32_t y,
                       uint32_t cell, uint32_t gap)
{
    for (uint32_t i = 0; i < shape->run_count; i++) {
        const alpi_run *run = &shape->runs[i];
        uint32_t columns[2], rows[2];
        widen(x + run->begin, x + run->end, cell, gap, page->size, columns);
        widen(y + run->row, y + run->row + 1u, cell, gap, page->size, rows);
        for (uint32_t v = rows[0]; v < rows[1]; v++) {
            block(page, v, columns[0], columns[1]);
        }
    }
}

/// The longest stretch of zeros in a row.
static uint32_t longest_gap(const uint64_t *row, uint32_t words)
{
    uint32_t longest = 0, open = 0;
    for (uint32_t i = 0; i < words; i++) {
        uint64_t word = row[i];
        if (word == 0) {
            open += 64;
            continue;
        }
        uint32_t left = 64;
        while (word != 0) {
            const uint32_t zeros = (uint32_t)__builtin_ctzll(word);
            longest = open + zeros > longest ? open + zeros : longest;
            open = 0;
            word >>= zeros;
            left -= zeros;
            const uint32_t ones = word == UINT64_MAX ? 64 : (uint32_t)__builtin_ctzll(~word);
            left -= ones;
            word = ones < 64 ? word >> ones : 0;
        }
        open = left;
    }
    return open > longest ? open : longest;
}

void alpi_pack_page_take(alpi_pack_page *page, const alpi_shape *shape, uint32_t x, uint32_t y,
                         const alpi_pack_rules *rules)
{
    uint32_t reach = rules->padding;
    take_cells(page, shape, x, y, 1, rules->padding);
    if (rules->block > 1) {
        take_cells(page, shape, x, y, rules->block, 0);
        reach = rules->block > reach ? rules->block : reach;
    }
    if (rules->mips > 0) {
        const uint32_t half = 1u << (rules->mips - 1);
        take_cells(page, shape, x, y, half, 2);
        reach = 3 * half > reach ? 3 * half : reach;
    }
    const uint32_t end =
        y + shape->height + reach < page->size ? y + shape->height + reach : page->size;
    for (uint32_t v = y > reach ? y - reach : 0; v < end; v++) {
        page->gaps[v] = (uint16_t)longest_gap(page->blocked + (size_t)v * page->words, page->words);
    }
}
