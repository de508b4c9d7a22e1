// SPDX-License-Identifier: MIT
// The inner loop of projection, included once for each instruction set. Both add the same numbers
// in the same order: the same bits.
//
// The sums of a channel are nine vectors of eight, which stay in registers over several blocks. All
// three channels at once would need twenty-seven and spill.
#include "sh/sh_project.h"

#include <string.h>

enum { LANES = ALPI_CUBE_LANES, MOMENTS = ALPI_CUBE_MOMENTS, BATCH = 8 };
enum { SUMS = 3 * MOMENTS, PADDED_SUMS = 32 }; // whole groups of eight

typedef float eight __attribute__((vector_size(32)));

/// Four mirrored texels, added with the signs of even and odd functions of s and t.
typedef struct folded {
    eight even, odd_s, odd_t, odd;
} folded;

/// One row's texels of a block, by channel.
typedef struct texels {
    eight channel[3];
} texels;

#if defined(__AVX2__) && defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
#define SHUFFLED
#endif
#endif

#ifdef SHUFFLED // loops give many more instructions here
/// The values of each channel lie in eight different lanes of the three vectors, in a mixed order.
static inline void gather_channels(const float *rgb, texels *mixed)
{
    eight a, b, c;
    memcpy(&a, rgb, sizeof a);
    memcpy(&b, rgb + LANES, sizeof b);
    memcpy(&c, rgb + 2 * LANES, sizeof c);
    const eight red = __builtin_shufflevector(a, b, 0, 9, 2, 3, 12, 5, 6, 15);
    const eight green = __builtin_shufflevector(c, a, 0, 9, 2, 3, 12, 5, 6, 15);
    const eight blue = __builtin_shufflevector(b, c, 0, 9, 2, 3, 12, 5, 6, 15);
    mixed->channel[0] = __builtin_shufflevector(red, c, 0, 1, 10, 3, 4, 13, 6, 7);
    mixed->channel[1] = __builtin_shufflevector(green, b, 0, 1, 10, 3, 4, 13, 6, 7);
    mixed->channel[2] = __builtin_shufflevector(blue, a, 0, 1, 10, 3, 4, 13, 6, 7);
}

static inline void split(const float *rgb, texels *t)
{
    texels m;
    gather_channels(rgb, &m);
    const eight red = m.channel[0], green = m.channel[1], blue = m.channel[2];
    t->channel[0] = __builtin_shufflevector(red, red, 0, 3, 6, 1, 4, 7, 2, 5);
    t->channel[1] = __builtin_shufflevector(green, green, 1, 4, 7, 2, 5, 0, 3, 6);
    t->channel[2] = __builtin_shufflevector(blue, blue, 2, 5, 0, 3, 6, 1, 4, 7);
}

static inline void split_mirrored(const float *rgb, texels *t)
{
    texels m;
    gather_channels(rgb, &m);
    const eight red = m.channel[0], green = m.channel[1], blue = m.channel[2];
    t->channel[0] = __builtin_shufflevector(red, red, 5, 2, 7, 4, 1, 6, 3, 0);
    t->channel[1] = __builtin_shufflevector(green, green, 6, 3, 0, 5, 2, 7, 4, 1);
    t->channel[2] = __builtin_shufflevector(blue, blue, 7, 4, 1, 6, 3, 0, 5, 2);
}

static inline eight add_halves(eight a, eight b)
{
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11) +
           __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
}

static inline eight add_quarters(eight a, eight b)
{
    return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13) +
           __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
}

/// Adds the lanes of each of eight sums: ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7)).
static inline void add_lanes(const eight *s, float *totals)
{
    const eight a = add_quarters(add_halves(s[0], s[4]), add_halves(s[1], s[5]));
    const eight b = add_quarters(add_halves(s[2], s[6]), add_halves(s[3], s[7]));
    const eight all = __builtin_shufflevector(a, b, 0, 2, 8, 10, 4, 6, 12, 14) +
                      __builtin_shufflevector(a, b, 1, 3, 9, 11, 5, 7, 13, 15);
    memcpy(totals, &all, sizeof all);
}
#else
static inline void split(const float *rgb, texels *t)
{
    float channel[3][LANES];
    for (int i = 0; i < LANES; i++) {
        channel[0][i] = rgb[3 * i];
        channel[1][i] = rgb[3 * i + 1];
        channel[2][i] = rgb[3 * i + 2];
    }
    memcpy(t, channel, sizeof *t);
}

static inline void split_mirrored(const float *rgb, texels *t)
{
    float channel[3][LANES], mirrored[3][LANES];
    split(rgb, t);
    memcpy(channel, t, sizeof channel);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < LANES; i++) {
            mirrored[k][i] = channel[k][LANES - 1 - i];
        }
    }
    memcpy(t, mirrored, sizeof *t);
}

/// Adds the lanes of each of eight sums, in the order of the other variant.
static inline void add_lanes(const eight *sums, float *totals)
{
    for (int i = 0; i < 8; i++) {
        const eight s = sums[i];
        totals[i] = ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
    }
}
#endif

/// Eight texels from both ends of a row. A last block that is not full is filled up with darkness.
static inline void read_row(const alpi_cube_rows *r, const float *row, uint32_t block, texels *left,
                            texels *right)
{
    const uint32_t first = block * LANES, count = r->half - first;
    if (count >= LANES) {
        split(row + 3 * (size_t)first, left);
        split_mirrored(row + 3 * (size_t)(r->size - LANES - first), right);
        return;
    }
    float ends[2][3 * LANES] = {{0.0f}};
    const float *from_left = row + 3 * (size_t)first;
    const float *from_right = row + 3 * (size_t)(r->size - first - count);
    float *last = ends[1] + 3 * (size_t)(LANES - count);
    for (uint32_t i = 0; i < 3 * count; i++) {
        ends[0][i] = from_left[i];
        last[i] = from_right[i];
    }
    split(ends[0], left);
    split_mirrored(ends[1], right);
}

static inline void fold(const alpi_cube_rows *r, const float *top, const float *bottom,
                        uint32_t block, folded *f)
{
    texels tops[2], bottoms[2];
    read_row(r, top, block, &tops[0], &tops[1]);
    read_row(r, bottom, block, &bottoms[0], &bottoms[1]);
    for (int k = 0; k < 3; k++) {
        const eight top_sum = tops[0].channel[k] + tops[1].channel[k];
        const eight top_change = tops[1].channel[k] - tops[0].channel[k];
        const eight bottom_sum = bottoms[0].channel[k] + bottoms[1].channel[k];
        const eight bottom_change = bottoms[1].channel[k] - bottoms[0].channel[k];
        f[(size_t)k * BATCH] = (folded){.even = top_sum + bottom_sum,
                                        .odd_s = top_change + bottom_change,
                                        .odd_t = bottom_sum - top_sum,
                                        .odd = bottom_change - top_change};
    }
}

/// @param begins the sums hold nothing yet
static inline void add_products(const folded *f, const eight *weights, uint32_t count, bool begins,
                                eight *sums)
{
    const eight none = {0.0f};
    eight s[MOMENTS];
    for (int i = 0; i < MOMENTS; i++) {
        s[i] = begins ? none : sums[i];
    }
    for (uint32_t i = 0; i < count; i++, f++, weights += MOMENTS) {
        s[0] += weights[0] * f->even;
        s[1] += weights[1] * f->even;
        s[2] += weights[2] * f->even;
        s[3] += weights[3] * f->even;
        s[4] += weights[4] * f->odd_s;
        s[5] += weights[5] * f->odd_s;
        s[6] += weights[6] * f->odd_t;
        s[7] += weights[7] * f->odd_t;
        s[8] += weights[8] * f->odd;
    }
    for (int i = 0; i < MOMENTS; i++) {
        sums[i] = s[i];
    }
}

void ALPI_VARIANT(alpi_cube_sum)(const alpi_cube_rows *rows, float moments[3][MOMENTS])
{
    eight sums[PADDED_SUMS];
    float totals[PADDED_SUMS];
    folded batch[3][BATCH];
    const eight *weights = (const eight *)rows->weights;
    const uint32_t count = rows->pairs * rows->blocks;
    const float *top = rows->top, *bottom = rows->bottom;
    uint32_t block = 0;
    for (int i = SUMS; i < PADDED_SUMS; i++) {
        sums[i] = (eight){0.0f};
    }
    for (uint32_t first = 0; first < count; first += BATCH) {
        const uint32_t few = count - first < BATCH ? count - first : BATCH;
        for (uint32_t i = 0; i < few; i++) {
            fold(rows, top, bottom, block, &batch[0][i]);
            if (++block == rows->blocks) {
                block = 0;
                top += rows->top_step;
                bottom += rows->bottom_step;
            }
        }
        for (int k = 0; k < 3; k++) {
            add_products(batch[k], weights + (size_t)first * MOMENTS, few, first == 0,
                         sums + (size_t)k * MOMENTS);
        }
    }
    for (int i = 0; i < PADDED_SUMS; i += LANES) {
        add_lanes(sums + i, totals + i);
    }
    for (int i = 0; i < SUMS; i++) {
        moments[i / MOMENTS][i % MOMENTS] = totals[i];
    }
}
