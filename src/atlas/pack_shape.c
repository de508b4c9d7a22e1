// SPDX-License-Identifier: MIT
// What an item covers as stretches of rows, turned by quarters. Turned, never mirrored: the
// triangles of a chart keep their orientation.
#include "atlas/pack.h"

#include "base/memory.h"

#include <string.h>

static alp_result add_run(alpi_shapes *s, alpi_shape *shape, uint32_t row, uint32_t begin,
                          uint32_t end)
{
    ALP_TRY(alpi_grow(s->context, (void **)&shape->runs, &shape->capacity,
                      (size_t)shape->run_count + 1, sizeof *shape->runs));
    shape->runs[shape->run_count++] = (alpi_run){(uint16_t)row, (uint16_t)begin, (uint16_t)end};
    return ALP_OK;
}

/// The first column from `from` on whose bit is `set`, or `width`.
static uint32_t next_column(const uint64_t *row, uint32_t width, uint32_t from, bool set)
{
    while (from < width) {
        const uint64_t word = (set ? row[from / 64] : ~row[from / 64]) >> (from % 64);
        if (word != 0) {
            const uint32_t at = from + (uint32_t)__builtin_ctzll(word);
            return at < width ? at : width;
        }
        from = (from / 64 + 1) * 64;
    }
    return width;
}

/// The stretches of a mask, row by row.
static alp_result read_runs(alpi_shapes *s, const uint64_t *mask, alpi_shape *shape)
{
    const size_t words = (shape->width + 63) / 64;
    shape->run_count = 0;
    for (uint32_t y = 0; y < shape->height; y++) {
        const uint64_t *row = mask + y * words;
        uint32_t begin = next_column(row, shape->width, 0, true);
        while (begin < shape->width) {
            const uint32_t end = next_column(row, shape->width, begin, false);
            ALP_TRY(add_run(s, shape, y, begin, end));
            begin = next_column(row, shape->width, end, true);
        }
    }
    return ALP_OK;
}

static alp_result fill_runs(alpi_shapes *s, alpi_shape *shape)
{
    shape->run_count = 0;
    for (uint32_t y = 0; y < shape->height; y++) {
        ALP_TRY(add_run(s, shape, y, 0, shape->width));
    }
    return ALP_OK;
}

/// By a quarter: texel (x, y) goes to (height − 1 − y, x). A stretch becomes a column: its ends are
/// toggled, and what is toggled stays so from row to row.
static alp_result turn_quarter(alpi_shapes *s, const alpi_shape *from, alpi_shape *to)
{
    const size_t words = (from->height + 63) / 64, count = words * (from->width + 1u);
    ALP_TRY(alpi_grow(s->context, (void **)&s->bits, &s->bit_capacity, count, sizeof *s->bits));
    memset(s->bits, 0, count * sizeof *s->bits);
    for (uint32_t i = 0; i < from->run_count; i++) {
        const uint32_t column = from->height - 1 - from->runs[i].row;
        s->bits[from->runs[i].begin * words + column / 64] ^= (uint64_t)1 << (column % 64);
        s->bits[from->runs[i].end * words + column / 64] ^= (uint64_t)1 << (column % 64);
    }
    for (size_t i = words; i < count; i++) {
        s->bits[i] ^= s->bits[i - words];
    }
    to->width = from->height;
    to->height = from->width;
    return read_runs(s, s->bits, to);
}

static void measure_moments(alpi_shape *shape)
{
    shape->moment[0] = shape->moment[1] = 0;
    for (uint32_t i = 0; i < shape->run_count; i++) {
        const uint64_t begin = shape->runs[i].begin, end = shape->runs[i].end;
        shape->moment[0] += (end - begin) * (end + begin);
        shape->moment[1] += (end - begin) * (2 * (uint64_t)shape->runs[i].row + 1);
    }
}

/// By two quarters: the stretches in the opposite order.
static alp_result turn_half(alpi_shapes *s, const alpi_shape *from, alpi_shape *to)
{
    to->width = from->width;
    to->height = from->height;
    to->run_count = 0;
    for (uint32_t i = from->run_count; i-- > 0;) {
        const alpi_run *run = &from->runs[i];
        ALP_TRY(add_run(s, to, from->height - 1u - run->row, from->width - run->end,
                        from->width - run->begin));
    }
    return ALP_OK;
}

static bool looks_like(const alpi_shape *a, const alpi_shape *b)
{
    return a->width == b->width && a->height == b->height && a->run_count == b->run_count &&
           memcmp(a->runs, b->runs, a->run_count * sizeof *a->runs) == 0;
}

/// The longest stretch first, then the others so that the first of them are far apart and hit
/// different things: those in the middle, at the quarters, at the eighths …
static alp_result order_runs(alpi_shapes *s, alpi_shape *shape)
{
    const uint32_t count = shape->run_count;
    ALP_TRY(
        alpi_grow(s->context, (void **)&s->sorted, &s->sorted_capacity, count, sizeof *s->sorted));
    alpi_run *out = s->sorted, *runs = shape->runs;
    uint32_t step = 1, filled = 0, longest = 0;
    while (step < count) {
        step *= 2;
    }
    out[filled++] = runs[0];
    for (step /= 2; step > 0; step /= 2) {
        for (uint32_t i = step; i < count; i += 2 * step) {
            out[filled++] = runs[i];
        }
    }
    for (uint32_t i = 1; i < count; i++) {
        longest = out[i].end - out[i].begin > out[longest].end - out[longest].begin ? i : longest;
    }
    const alpi_run first = out[longest];
    out[longest] = out[0];
    out[0] = first;
    memcpy(runs, out, count * sizeof *runs);
    return ALP_OK;
}

alp_result alpi_shapes_make(alpi_shapes *s, const alpi_pack_item *item)
{
    alpi_shape *turned = s->turned;
    turned[0].width = item->width;
    turned[0].height = item->height;
    ALP_TRY(item->mask == NULL ? fill_runs(s, &turned[0]) : read_runs(s, item->mask, &turned[0]));
    s->texels = 0;
    for (uint32_t i = 0; i < turned[0].run_count; i++) {
        s->texels += (uint64_t)(turned[0].runs[i].end - turned[0].runs[i].begin);
    }
    ALP_TRY(turn_quarter(s, &turned[0], &turned[1]));
    ALP_TRY(turn_half(s, &turned[0], &turned[2]));
    ALP_TRY(turn_half(s, &turned[1], &turned[3]));
    s->differs[0] = true;
    s->differs[1] = !looks_like(&turned[1], &turned[0]);
    s->differs[2] = !looks_like(&turned[2], &turned[0]);
    s->differs[3] = !looks_like(&turned[3], &turned[1]) && !looks_like(&turned[3], &turned[0]);
    for (int i = 0; i < 4; i++) {
        measure_moments(&turned[i]);
        ALP_TRY(order_runs(s, &turned[i]));
    }
    return ALP_OK;
}

void alpi_shapes_destroy(alpi_shapes *s)
{
    for (int i = 0; i < 4; i++) {
        alpi_release(s->context, s->turned[i].runs);
    }
    alpi_release(s->context, s->bits);
    alpi_release(s->context, s->sorted);
}
