// SPDX-License-Identifier: MIT
// Dilation: a wave that starts at all covered texels at once and carries their values outwards, one
// step at a time, until the page is full. Linear in texels.
#include "maps/lightmap.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <assert.h>
#include <string.h>

// Texels between two questions whether to go on.
enum { TICK_INTERVAL = 1 << 16 };

typedef struct wave {
    float *page;
    uint32_t width, height;
    uint8_t *filled;
    uint32_t *queue; // texels in the order in which they were reached
    size_t count;
    size_t inner; // covered texels that reach nothing, and are not in it
} wave;

static void reach(wave *w, size_t from, size_t to)
{
    if (!w->filled[to]) {
        w->filled[to] = 1;
        memcpy(w->page + 4 * to, w->page + 4 * from, 3 * sizeof(float));
        w->queue[w->count++] = (uint32_t)to;
    }
}

static alp_result spread(wave *w, alp_context *context)
{
    for (size_t i = 0; i < w->count; i++) {
        if (i % TICK_INTERVAL == 0) {
            ALP_TRY(alpi_tick(context, "dilation", w->inner + i, (uint64_t)w->width * w->height));
        }
        size_t at = w->queue[i];
        uint32_t x = (uint32_t)(at % w->width), y = (uint32_t)(at / w->width);
        if (x > 0) {
            reach(w, at, at - 1);
        }
        if (x + 1 < w->width) {
            reach(w, at, at + 1);
        }
        if (y > 0) {
            reach(w, at, at - w->width);
        }
        if (y + 1 < w->height) {
            reach(w, at, at + w->width);
        }
    }
    return ALP_OK;
}

/// Marks what is covered, and lines up those of it that have an empty texel beside them: the others
/// reach nothing.
static alp_result start(wave *w, alp_context *context)
{
    const size_t width = w->width, count = width * w->height;
    for (size_t i = 0; i < count; i++) {
        w->filled[i] = w->page[4 * i + 3] > 0.0f;
    }
    for (size_t y = 0; y < w->height; y++) {
        const uint8_t *row = w->filled + y * width;
        const uint8_t *above = y > 0 ? row - width : row;
        const uint8_t *below = y + 1 < w->height ? row + width : row;
        for (size_t x = 0; x < width; x++) {
            const bool left = x == 0 || row[x - 1] != 0, right = x + 1 == width || row[x + 1] != 0;
            if (row[x] == 0) {
                continue;
            }
            if (left && right && above[x] != 0 && below[x] != 0) {
                w->inner++;
            } else {
                w->queue[w->count++] = (uint32_t)(y * width + x);
            }
        }
        ALP_TRY(alpi_tick(context, "dilation", 0, count));
    }
    return ALP_OK;
}

alp_result alpi_dilate(alp_context *context, float *page, uint32_t width, uint32_t height)
{
    assert(width > 0 && height > 0);
    const size_t count = (size_t)width * height;
    wave w = {.page = page, .width = width, .height = height};
    w.filled = ALPI_NEW(context, uint8_t, count);
    w.queue = ALPI_NEW(context, uint32_t, count);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (w.filled != NULL && w.queue != NULL) {
        result = start(&w, context);
        result = result == ALP_OK ? spread(&w, context) : result;
    }
    alpi_release(context, w.filled);
    alpi_release(context, w.queue);
    return result;
}
