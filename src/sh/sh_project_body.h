// SPDX-License-Identifier: MIT
// The inner loop of projection, included once for each instruction set. Both add the same numbers
// in the same order: the same bits.
//
// The sums of a channel are nine vectors of eight, which stay in registers over several blocks. All
// three channels at once would need twenty-seven and spill.
#include "sh/sh_project.h"

#include <string.h>

enum { LANES = ALPI_CUBE_LANES, MOMENTS = ALPI_CUBE_MOMENTS, BATCH = 8 };

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
static inline void split(const float *rgb, texels *t)
{
    eight a, b, c;
    memcpy(&a, rgb, sizeof a);
    memcpy(&b, rgb + LANES, sizeof b);
    memcpy(&c, rgb + 2 * LANES, sizeof c);
    const eight red = __builtin_shufflevector(a, b, 0, 3, 6, 9, 12, 15, -1, -1);
    const eight green = __builtin_shufflevector(a, b, 1, 4, 7, 10, 13, -1, -1, -1);
    const eight blue = __builtin_shufflevector(a, b, 2, 5, 8, 11, 14, -1, -1, -1);
    t->channel[0] = __builtin_shufflevector(red, c, 0, 1, 2, 3, 4, 5, 10, 13);
    t->channel[1] = __builtin_shufflevector(green, c, 0, 1, 2, 3, 4, 8, 11, 14);
    t->channel[2] = __builtin_shufflevector(blue, c, 0, 1, 2, 3, 4, 9, 12, 15);
}

static inline void split_mirrored(const float *rgb, texels *t)
{
    split(rgb, t);
    for (int k = 0; k < 3; k++) {
        const eight c = t->channel[k];
        t->channel[k] = __builtin_shufflevector(c, c, 7, 6, 5, 4, 3, 2, 1, 0);
    }
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
    float padded[3 * LANES] = {0.0f};
    memcpy(padded, row + 3 * (size_t)first, 3 * count * sizeof *row);
    split(padded, left);
    memset(padded, 0, sizeof padded);
    memcpy(padded + 3 * (size_t)(LANES - count), row + 3 * (size_t)(r->size - first - count),
           3 * count * sizeof *row);
    split_mirrored(padded, right);
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

static inline void add_products(const folded *f, const eight *weights, uint32_t count, eight *sums)
{
    eight s0 = sums[0], s1 = sums[1], s2 = sums[2], s3 = sums[3], s4 = sums[4], s5 = sums[5];
    eight s6 = sums[6], s7 = sums[7], s8 = sums[8];
    for (uint32_t i = 0; i < count; i++, f++, weights += MOMENTS) {
        s0 += weights[0] * f->even;
        s1 += weights[1] * f->even;
        s2 += weights[2] * f->even;
        s3 += weights[3] * f->even;
        s4 += weights[4] * f->odd_s;
        s5 += weights[5] * f->odd_s;
        s6 += weights[6] * f->odd_t;
        s7 += weights[7] * f->odd_t;
        s8 += weights[8] * f->odd;
    }
    sums[0] = s0, sums[1] = s1, sums[2] = s2, sums[3] = s3, sums[4] = s4, sums[5] = s5;
    sums[6] = s6, sums[7] = s7, sums[8] = s8;
}

static inline float sum_lanes(const eight *lanes)
{
    float a[LANES];
    memcpy(a, lanes, sizeof a);
    return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
}

void ALPI_VARIANT(alpi_cube_sum)(const alpi_cube_rows *rows, float moments[3][MOMENTS])
{
    eight sums[3][MOMENTS];
    folded batch[3][BATCH];
    const eight *weights = (const eight *)rows->weights;
    const uint32_t count = rows->pairs * rows->blocks;
    const float *top = rows->top, *bottom = rows->bottom;
    uint32_t block = 0;
    memset(sums, 0, sizeof sums);
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
            add_products(batch[k], weights + (size_t)first * MOMENTS, few, sums[k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < MOMENTS; i++) {
            moments[k][i] = sum_lanes(&sums[k][i]);
        }
    }
}
