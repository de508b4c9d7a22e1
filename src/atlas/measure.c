// SPDX-License-Identifier: MIT
// What an atlas holds: covered texels, how full its pages are, and which triangles share texels.
#include "atlas/stages.h"

#include "base/memory.h"

#include <math.h>

typedef struct tally {
    const alp_atlas *atlas;
    uint32_t page;     // of the last row
    uint64_t texels;   // covered
    uint64_t taken;    // covered or within `padding` texels of a covered one, in both directions
    uint32_t *end_row; // [width] rows of the page before this one are counted in `taken`
    bool *wide;        // [width] the row, widened by the padding
    bool *owns;        // [triangle_count] the receiver of some texel lies on it
} tally;

/// Marks the columns within `padding` of a covered one.
static void widen_row(tally *t, const alpi_row *row)
{
    uint32_t width = t->atlas->info.width, padding = t->atlas->options.padding;
    uint32_t done = 0; // columns before it are set
    for (uint32_t x = row->first; x <= row->last; x++) {
        if (row->cells[x].triangle != ALPI_NONE) {
            uint32_t begin = x > padding ? x - padding : 0;
            uint32_t end = x + padding + 1 < width ? x + padding + 1 : width;
            for (; done < begin; done++) {
                t->wide[done] = false;
            }
            for (; done < end; done++) {
                t->wide[done] = true;
            }
        }
    }
    for (; done < width; done++) {
        t->wide[done] = false;
    }
}

static alp_result count_row(void *user, const alpi_row *row)
{
    tally *t = user;
    uint32_t width = t->atlas->info.width, height = t->atlas->info.height;
    uint32_t padding = t->atlas->options.padding;
    if (row->page != t->page) {
        for (uint32_t x = 0; x < width; x++) {
            t->end_row[x] = 0;
        }
        t->page = row->page;
    }
    for (uint32_t x = row->first; x <= row->last; x++) {
        if (row->cells[x].triangle != ALPI_NONE) {
            t->texels++;
            t->owns[row->cells[x].triangle] = true;
        }
    }
    widen_row(t, row);
    uint32_t begin = row->y > padding ? row->y - padding : 0;
    uint32_t end = row->y + padding + 1 < height ? row->y + padding + 1 : height;
    for (uint32_t x = 0; x < width; x++) {
        if (t->wide[x]) {
            t->taken += end - (begin > t->end_row[x] ? begin : t->end_row[x]);
            t->end_row[x] = end;
        }
    }
    return ALP_OK;
}

/// √(texel area / world area) over the usable triangles.
static double mean_density(const alp_atlas *atlas)
{
    double area = 0.0;
    for (uint32_t t = 0; t < atlas->scene->triangle_count; t++) {
        const float(*p)[2] = (const float(*)[2])atlas->corner_uvs[t];
        if (atlas->scene->triangle_usable[t]) {
            double ax = (double)p[1][0] - (double)p[0][0], ay = (double)p[1][1] - (double)p[0][1];
            double bx = (double)p[2][0] - (double)p[0][0], by = (double)p[2][1] - (double)p[0][1];
            area += 0.5 * fabs(ax * by - ay * bx);
        }
    }
    return sqrt(area * atlas->info.width * atlas->info.height / atlas->scene->area);
}

static alp_result fill_tally(tally *t)
{
    const alp_atlas *atlas = t->atlas;
    ALPI_TRY_NEW(atlas->context, t->end_row, atlas->info.width);
    ALPI_TRY_NEW(atlas->context, t->wide, atlas->info.width);
    ALPI_TRY_NEW(atlas->context, t->owns, atlas->scene->triangle_count);
    return alpi_raster(atlas, 0, atlas->info.pages, count_row, t);
}

static void read_tally(alp_atlas *atlas, const tally *t)
{
    double room = (double)atlas->info.pages * atlas->info.width * atlas->info.height;
    atlas->info.texels = t->texels;
    atlas->info.utilisation =
        (double)(atlas->info.mode == ALP_ATLAS_KEEP ? t->texels : t->taken) / room;
    atlas->info.texels_per_metre = mean_density(atlas);
    atlas->info.shared_triangles = 0;
    for (uint32_t i = 0; i < atlas->scene->triangle_count; i++) {
        atlas->info.shared_triangles += atlas->scene->triangle_usable[i] && !t->owns[i];
    }
}

alp_result alpi_measure(alp_atlas *atlas)
{
    tally t = {.atlas = atlas};
    alp_result result = fill_tally(&t);
    if (result == ALP_OK) {
        read_tally(atlas, &t);
    }
    alpi_release(atlas->context, t.end_row);
    alpi_release(atlas->context, t.wide);
    alpi_release(atlas->context, t.owns);
    return result;
}
