// SPDX-License-Identifier: MIT
// Charts in boxes of whole texels, and the texels of the box that they cover.
#include "atlas/frame.h"

#include "atlas/clip.h"

#include <math.h>

// A chart smaller than a texel has a texel of its own; it is drawn this large in it, so that its
// coordinates stay apart in 32-bit floats: the longer side and the shorter one, in texels.
static const double SMALLEST_LONGER_SIDE = 0.5;
static const double SMALLEST_SHORTER_SIDE = 1.0 / 16.0;

static uint32_t whole_texels(double side)
{
    return side <= 1.0 ? 1 : (uint32_t)fmin(ceil(side - 1e-5), 1e9);
}

alpi_frame alpi_frame_of(const alpi_chart *chart, double density)
{
    if (!(chart->width > 0.0 && chart->height > 0.0)) {
        return (alpi_frame){.width = 1, .height = 1, .point = true};
    }
    const double longer = fmax(chart->width, chart->height);
    const double scale = fmax(density, SMALLEST_LONGER_SIDE / longer);
    const double width = fmax(chart->width * scale, SMALLEST_SHORTER_SIDE);
    const double height = fmax(chart->height * scale, SMALLEST_SHORTER_SIDE);
    alpi_frame frame = {.width = whole_texels(width),
                        .height = whole_texels(height),
                        .scale = {width / chart->width, height / chart->height}};
    frame.rest[0] = 0.5 * (frame.width - width);
    frame.rest[1] = 0.5 * (frame.height - height);
    return frame;
}

void alpi_frame_corner(const alpi_frame *frame, const float uv[2], int corner, double p[2])
{
    static const double half[3][2] = {{0.25, 0.25}, {0.75, 0.25}, {0.5, 0.75}};
    for (int i = 0; i < 2; i++) {
        p[i] = frame->point ? half[corner][i] : frame->rest[i] + (double)uv[i] * frame->scale[i];
    }
}

void alpi_frame_turn(const alpi_frame *frame, uint32_t turns, double p[2])
{
    const double x = p[0], y = p[1];
    p[0] = turns == 0 ? x : turns == 1 ? frame->height - y : turns == 2 ? frame->width - x : y;
    p[1] = turns == 0 ? y : turns == 1 ? x : turns == 2 ? frame->height - y : frame->width - x;
}

// --- drawing -------------------------------------------------------------------------------------

/// The texels [first, end) of a side of the box that [low, high] reaches.
static void reached(double low, double high, uint32_t side, uint32_t *first, uint32_t *end)
{
    const double begin = alpi_greater(floor(low), 0.0);
    const double stop = alpi_lesser(floor(high) + 1.0, side);
    *first = (uint32_t)alpi_lesser(begin, side - 1.0);
    *end = stop > *first ? (uint32_t)stop : *first + 1;
}

/// Widens [low, high] by what of the line from a to b lies in rows [top, bottom].
static void take_edge(const double a[2], const double b[2], double top, double bottom, double *low,
                      double *high)
{
    double begin = 0.0, end = 1.0;
    if (a[1] == b[1]) {
        end = a[1] >= top && a[1] <= bottom ? end : -1.0;
    } else {
        const double from = (top - a[1]) / (b[1] - a[1]), to = (bottom - a[1]) / (b[1] - a[1]);
        begin = alpi_greater(alpi_lesser(from, to), 0.0);
        end = alpi_lesser(alpi_greater(from, to), 1.0);
    }
    if (begin <= end) {
        const double p = a[0] + begin * (b[0] - a[0]), q = a[0] + end * (b[0] - a[0]);
        *low = alpi_lesser(*low, alpi_lesser(p, q));
        *high = alpi_greater(*high, alpi_greater(p, q));
    }
}

static void set_bits(uint64_t *row, uint32_t begin, uint32_t end)
{
    for (uint32_t i = begin / 64; i <= (end - 1) / 64; i++) {
        uint64_t bits = i == begin / 64 ? UINT64_MAX << (begin % 64) : UINT64_MAX;
        bits &= i == (end - 1) / 64 ? UINT64_MAX >> (63 - (end - 1) % 64) : UINT64_MAX;
        row[i] |= bits;
    }
}

static void draw_triangle(const alpi_frame *frame, const double p[3][2], double slack,
                          uint64_t *mask)
{
    uint32_t first, end;
    reached(alpi_lesser(p[0][1], alpi_lesser(p[1][1], p[2][1])) - slack,
            alpi_greater(p[0][1], alpi_greater(p[1][1], p[2][1])) + slack, frame->height, &first,
            &end);
    for (uint32_t y = first; y < end; y++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int k = 0; k < 3; k++) {
            take_edge(p[k], p[k == 2 ? 0 : k + 1], y - slack, y + 1.0 + slack, &low, &high);
        }
        if (low <= high) {
            uint32_t begin, stop;
            reached(low - slack, high + slack, frame->width, &begin, &stop);
            set_bits(mask + (size_t)y * ((frame->width + 63) / 64), begin, stop);
        }
    }
}

void alpi_frame_draw(const alp_atlas *atlas, const alpi_frame *frame, const alpi_chart *chart,
                     const uint32_t *triangles, uint64_t *mask)
{
    // On the page, coordinates are 32-bit floats in [0, 1].
    const double slack = 0x1p-23 * atlas->options.size + 1e-7;
    if (frame->width == 1 && frame->height == 1) {
        mask[0] = 1;
        return;
    }
    for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
        double p[3][2];
        for (int k = 0; k < 3; k++) {
            alpi_frame_corner(frame, atlas->corner_uvs[triangles[i]][k], k, p[k]);
        }
        draw_triangle(frame, (const double(*)[2])p, slack, mask);
    }
}
