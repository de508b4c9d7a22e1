// SPDX-License-Identifier: MIT
// Grouping texels into patches: a square of a page becomes one patch for each chart in it.
//
// Rows of squares are split in parallel. The texels of each row are counted first, so that each row
// writes its patches at known places; then the rows are joined and their patches numbered.
#include "maps/radiosity/patch_create.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <string.h>

/// A row of squares of a page, and its patches.
typedef struct square_row {
    uint32_t first;   // texels of the rows before
    uint32_t placed;  // texels before the next one to place
    uint32_t patches; // of this row
    uint32_t before;  // patches of the rows before
} square_row;

/// Texels of one square of a page that have light of their own.
typedef struct page_square {
    uint32_t count;
    uint32_t texels[ALPI_PATCH_TEXEL_LIMIT];
} page_square;

static void list_square(const alpi_patches *p, uint32_t page, uint32_t x0, uint32_t y0,
                        uint32_t side, page_square *s)
{
    s->count = 0;
    for (uint32_t y = y0; y < y0 + side; y++) {
        for (uint32_t x = x0; x < x0 + side; x++) {
            const uint32_t t = alpi_lattice_texel(p->lattice, page, x, y);
            if (t != ALPI_NONE && p->patch_of[t] != ALPI_NONE) {
                s->texels[s->count++] = t;
            }
        }
    }
}

/// Moves all texels of the first one's chart out of a square, into a new patch.
static void take_patch(const alpi_patches *p, page_square *s, square_row *row)
{
    const uint32_t chart = p->texels->charts[s->texels[0]], first = row->placed;
    uint32_t placed = first, left = 0;
    double area = 0.0;
    for (uint32_t i = 0; i < s->count; i++) {
        const uint32_t t = s->texels[i];
        if (p->texels->charts[t] != chart) {
            s->texels[left++] = t;
            continue;
        }
        area += (double)alpi_texels_area(p->texels, t);
        p->patch_of[t] = row->patches;
        p->patch_ends[placed] = (float)area;
        p->patch_texels[placed++] = t;
    }
    for (uint32_t i = first; i < placed; i++) {
        p->patch_ends[i] = area > 0.0 ? (float)((double)p->patch_ends[i] / area)
                                      : (float)(i - first + 1) / (float)(placed - first);
    }
    p->patch_ends[placed - 1] = 1.0f;
    p->patch_areas[row->first + row->patches] = area;
    p->patch_first[row->first + row->patches] = first;
    row->patches++;
    row->placed = placed;
    s->count = left;
}

/// Side of the patches of a square (patches.h). A texel that lies partly in a solid shows the light
/// of its other part, unlike its neighbours.
static uint32_t choose_side(const alpi_patches *p, const page_square *s)
{
    uint32_t side = ALPI_PATCH_SIDE;
    for (uint32_t i = 0; i < s->count && p->proximity != NULL; i++) {
        const uint32_t t = s->texels[i];
        if ((p->texels->valid != NULL && p->texels->valid[t] != 0) ||
            p->proximity[t] == ALPI_TOUCHING) {
            return 1;
        }
        side = p->proximity[t] == ALPI_FAR ? side : ALPI_PATCH_SIDE / 2;
    }
    return side;
}

/// Makes patches of one square of a page, or of smaller squares near other surfaces.
static void split_square(const alpi_patches *p, uint32_t page, uint32_t x0, uint32_t y0,
                         square_row *row)
{
    page_square s;
    list_square(p, page, x0, y0, ALPI_PATCH_SIDE, &s);
    const uint32_t side = choose_side(p, &s);
    for (uint32_t y = y0; y < y0 + ALPI_PATCH_SIDE; y += side) {
        for (uint32_t x = x0; x < x0 + ALPI_PATCH_SIDE; x += side) {
            list_square(p, page, x, y, side, &s);
            while (s.count > 0) {
                take_patch(p, &s, row);
            }
        }
    }
}

typedef struct split_job {
    const alpi_patches *patches;
    uint32_t rows;   // of each page
    square_row *all; // [pages × rows]
} split_job;

/// Counts the texels of each row that have light of their own.
static alp_result count_rows(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const split_job *job = user;
    const alpi_patches *p = job->patches;
    const alpi_lattice *l = p->lattice;
    for (uint32_t r = begin; r < end; r++) {
        const uint32_t page = r / job->rows, y0 = r % job->rows * ALPI_PATCH_SIDE;
        const uint32_t rows = l->height - y0 < ALPI_PATCH_SIDE ? l->height - y0 : ALPI_PATCH_SIDE;
        const uint32_t *texels = &l->grid[alpi_lattice_pixel(l, page, 0, y0)];
        uint32_t count = 0;
        for (size_t i = 0; i < (size_t)l->width * rows; i++) {
            count += texels[i] != ALPI_NONE && p->patch_of[texels[i]] != ALPI_NONE ? 1 : 0;
        }
        job->all[r].placed = count;
    }
    return ALP_OK;
}

static alp_result split_rows(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const split_job *job = user;
    for (uint32_t r = begin; r < end; r++) {
        const uint32_t page = r / job->rows, y0 = r % job->rows * ALPI_PATCH_SIDE;
        for (uint32_t x = 0; x < job->patches->lattice->width; x += ALPI_PATCH_SIDE) {
            split_square(job->patches, page, x, y0, &job->all[r]);
        }
    }
    return ALP_OK;
}

/// Numbers the patches of each row among all.
static alp_result number_rows(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const split_job *job = user;
    const alpi_patches *p = job->patches;
    for (uint32_t r = begin; r < end; r++) {
        const square_row *row = &job->all[r];
        for (uint32_t i = row->first; i < row->placed; i++) {
            p->patch_of[p->patch_texels[i]] += row->before;
        }
    }
    return ALP_OK;
}

/// Closes the gaps between the patches of the rows.
static void join_rows(alpi_patches *p, uint32_t count, square_row *rows)
{
    for (uint32_t r = 0; r < count; r++) {
        const uint32_t first = rows[r].first, patches = rows[r].patches, to = p->patch_count;
        memmove(p->patch_first + to, p->patch_first + first, patches * sizeof *p->patch_first);
        memmove(p->patch_areas + to, p->patch_areas + first, patches * sizeof *p->patch_areas);
        rows[r].before = to;
        p->patch_count += patches;
    }
    p->patch_first[p->patch_count] = count > 0 ? rows[count - 1].placed : 0;
}

alp_result alpi_patches_split(alpi_patches *patches)
{
    alpi_patches *p = patches;
    enum { ROWS_PER_RANGE = 4 };
    const uint32_t rows = (p->lattice->height + ALPI_PATCH_SIDE - 1) / ALPI_PATCH_SIDE;
    const uint32_t count = p->lattice->page_count * rows;
    split_job job = {p, rows, ALPI_NEW(p->context, square_row, count)};
    if (job.all == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result =
        alpi_parallel_for(p->context, count, ROWS_PER_RANGE, count_rows, &job, NULL);
    for (uint32_t r = 0, first = 0; r < count && result == ALP_OK; r++) {
        const uint32_t texels = job.all[r].placed;
        job.all[r] = (square_row){.first = first, .placed = first};
        first += texels;
    }
    if (result == ALP_OK) {
        result = alpi_parallel_for(p->context, count, ROWS_PER_RANGE, split_rows, &job, NULL);
    }
    if (result == ALP_OK) {
        join_rows(p, count, job.all);
        result = alpi_parallel_for(p->context, count, ROWS_PER_RANGE, number_rows, &job, NULL);
    }
    result = result == ALP_OK ? alpi_tick(p->context, "light", 0, 1) : result;
    alpi_release(p->context, job.all);
    return result;
}
