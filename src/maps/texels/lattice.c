// SPDX-License-Identifier: MIT
#include "maps/texels/lattice.h"

#include "base/memory.h"

#include <string.h>

enum {
    TEXELS_PER_RANGE = 1 << 12,
    TILE_WIDTH = 16,
    TILE_HEIGHT = 8,
    GROUP_WIDTH = 4,
    GROUP_HEIGHT = 2
};

// --- grid and order ------------------------------------------------------------------------------

uint32_t alpi_lattice_texel(const alpi_lattice *l, uint32_t page, int64_t x, int64_t y)
{
    if (x < 0 || y < 0 || x >= l->width || y >= l->height) {
        return ALPI_NONE;
    }
    return l->grid[alpi_lattice_pixel(l, page, (uint32_t)x, (uint32_t)y)];
}

uint32_t alpi_lattice_around(const alpi_lattice *l, uint32_t texel,
                             uint32_t around[ALPI_AROUND_LIMIT])
{
    const uint16_t *p = l->texels->pixels[texel];
    uint32_t count = 0;
    for (int k = 0; k < ALPI_AROUND_LIMIT; k++) {
        const int64_t x = (int64_t)p[0] + k % 3 - 1, y = (int64_t)p[1] + k / 3 - 1;
        const uint32_t t = alpi_lattice_texel(l, l->texels->pages[texel], x, y);
        if (t != ALPI_NONE) {
            around[count++] = t;
        }
    }
    return count;
}

static alp_result fill_grid(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_lattice *l = user;
    for (uint32_t t = begin; t < end; t++) {
        const uint16_t *p = l->texels->pixels[t];
        l->grid[alpi_lattice_pixel(l, l->texels->pages[t], p[0], p[1])] = t;
    }
    return ALP_OK;
}

/// Appends the texels of one group, row by row.
static void append_group(const alpi_lattice *l, uint32_t page, uint32_t x0, uint32_t y0,
                         uint32_t *count)
{
    for (uint32_t y = y0; y < y0 + GROUP_HEIGHT; y++) {
        for (uint32_t x = x0; x < x0 + GROUP_WIDTH; x++) {
            const uint32_t t = alpi_lattice_texel(l, page, x, y);
            if (t != ALPI_NONE) {
                l->order[(*count)++] = t;
            }
        }
    }
}

/// Sorts texels by chart, stably. Charts face different directions, and packets of rays in
/// different directions are slow.
static void sort_by_chart(const alpi_lattice *l, uint32_t first, uint32_t end)
{
    const uint32_t *charts = l->texels->charts;
    for (uint32_t i = first + 1; i < end; i++) {
        const uint32_t t = l->order[i];
        uint32_t at = i;
        for (; at > first && charts[l->order[at - 1]] > charts[t]; at--) {
            l->order[at] = l->order[at - 1];
        }
        l->order[at] = t;
    }
}

/// Rows of tiles, of all pages one after the other.
typedef struct tile_rows {
    const alpi_lattice *lattice;
    uint32_t rows;   // of each page
    uint32_t *first; // [pages × rows + 1] where the texels of each begin in the order
} tile_rows;

static alp_result count_rows(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const tile_rows *job = user;
    const alpi_lattice *l = job->lattice;
    for (uint32_t r = begin; r < end; r++) {
        const uint32_t y0 = r % job->rows * TILE_HEIGHT, left = l->height - y0;
        const uint32_t *texels = &l->grid[alpi_lattice_pixel(l, r / job->rows, 0, y0)];
        const size_t pixels = (size_t)l->width * (left < TILE_HEIGHT ? left : TILE_HEIGHT);
        uint32_t count = 0;
        for (size_t i = 0; i < pixels; i++) {
            count += texels[i] != ALPI_NONE ? 1 : 0;
        }
        job->first[r + 1] = count;
    }
    return ALP_OK;
}

static alp_result order_rows(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const tile_rows *job = user;
    const alpi_lattice *l = job->lattice;
    for (uint32_t r = begin; r < end; r++) {
        const uint32_t page = r / job->rows, ty = r % job->rows * TILE_HEIGHT;
        uint32_t count = job->first[r];
        for (uint32_t tx = 0; tx < l->width; tx += TILE_WIDTH) {
            const uint32_t first = count;
            for (uint32_t y = ty; y < ty + TILE_HEIGHT; y += GROUP_HEIGHT) {
                for (uint32_t x = tx; x < tx + TILE_WIDTH; x += GROUP_WIDTH) {
                    append_group(l, page, x, y, &count);
                }
            }
            sort_by_chart(l, first, count);
        }
    }
    return ALP_OK;
}

/// Orders texels by tiles of 16 × 8, in each by chart, then by groups of 4 × 2. So eight successive
/// texels form a group, and eight texels of the coarse lattice a tile.
static alp_result fill_order(const alpi_lattice *l)
{
    enum { ROWS_PER_RANGE = 4 };
    tile_rows job = {.lattice = l, .rows = (l->height + TILE_HEIGHT - 1) / TILE_HEIGHT};
    const uint32_t count = l->page_count * job.rows;
    ALPI_TRY_NEW(l->context, job.first, (size_t)count + 1);
    alp_result result =
        alpi_parallel_for(l->context, count, ROWS_PER_RANGE, count_rows, &job, NULL);
    for (uint32_t r = 0; r < count; r++) {
        job.first[r + 1] += job.first[r];
    }
    if (result == ALP_OK) {
        result = alpi_parallel_for(l->context, count, ROWS_PER_RANGE, order_rows, &job, NULL);
    }
    alpi_release(l->context, job.first);
    return result;
}

static alp_result create(alpi_lattice *l)
{
    const size_t pixels = (size_t)l->page_count * l->width * l->height;
    ALPI_TRY_NEW(l->context, l->grid, pixels);
    ALPI_TRY_NEW(l->context, l->order, l->texels->count);
    ALPI_TRY_NEW(l->context, l->states, l->texels->count);
    ALPI_TRY_NEW(l->context, l->values, l->texels->count);
    memset(l->grid, 0xff, pixels * sizeof *l->grid);
    ALP_TRY(alpi_parallel_for(l->context, l->texels->count, TEXELS_PER_RANGE, fill_grid, l, NULL));
    ALP_TRY(alpi_tick(l->context, "build", 0, 1));
    ALP_TRY(fill_order(l));
    return alpi_tick(l->context, "build", 0, 1);
}

alp_result alpi_lattice_create(const alp_atlas *atlas, const alpi_texels *texels,
                               alpi_lattice *lattice)
{
    *lattice = (alpi_lattice){.context = atlas->context,
                              .texels = texels,
                              .width = atlas->info.width,
                              .height = atlas->info.height,
                              .page_count = atlas->info.pages};
    alp_result result = create(lattice);
    if (result != ALP_OK) {
        alpi_lattice_destroy(lattice);
    }
    return result;
}

void alpi_lattice_destroy(alpi_lattice *lattice)
{
    alpi_release(lattice->context, lattice->grid);
    alpi_release(lattice->context, lattice->order);
    alpi_release(lattice->context, lattice->states);
    alpi_release(lattice->context, lattice->values);
    *lattice = (alpi_lattice){0};
}

// --- levels --------------------------------------------------------------------------------------

uint32_t alpi_lattice_level(const uint16_t pixel[2])
{
    static const uint8_t levels[ALPI_LATTICE_SPACING][ALPI_LATTICE_SPACING] = {
        {0, 3, 1, 3}, {3, 5, 4, 5}, {1, 4, 2, 4}, {3, 5, 4, 5}};
    return levels[pixel[1] % ALPI_LATTICE_SPACING][pixel[0] % ALPI_LATTICE_SPACING];
}

uint32_t alpi_lattice_reach(uint32_t level)
{
    return level <= 2 ? ALPI_LATTICE_SPACING / 2 : ALPI_LATTICE_SPACING / 4;
}

bool alpi_lattice_is_coarse(const uint16_t pixel[2])
{
    return pixel[0] % 2 == 0 && pixel[1] % 2 == 0;
}
