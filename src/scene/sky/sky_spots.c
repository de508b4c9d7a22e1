// SPDX-License-Identifier: MIT
#include "scene/sky/sky_spots.h"

#include "base/memory.h"
#include "base/random.h"

#include <float.h>
#include <stdlib.h>

// --- parting -------------------------------------------------------------------------------------

/// Mean square over squared mean of a table's brightness up to a level, by solid angle.
static double unevenness_below(const alpi_sky_table *t, double level)
{
    double sum = 0.0, squares = 0.0, all = 0.0;
    for (uint32_t y = 0; y < t->height; y++) {
        const double weight = sin((y + 0.5) * ALPI_PI / t->height);
        double row = 0.0, row_squares = 0.0;
        for (uint32_t x = 0; x < t->width; x++) {
            const double b = alpi_sky_brightness(t->pixels[(size_t)y * t->width + x]);
            const double soft = b < level ? b : level;
            row += soft;
            row_squares += soft * soft;
        }
        sum += weight * row;
        squares += weight * row_squares;
        all += weight * t->width;
    }
    return sum > 0.0 ? squares * all / (sum * sum) : 0.0;
}

/// What is black makes any sky uneven. A level that leaves the rest this much more uneven than if
/// it were even does, up to half of the sphere: rays hardly find what little is lit beyond.
static const double BESIDE_BLACK = 1.2, HALF_BLACK = 2.0;

/// The highest level that leaves what is below it even; it is found to 1 %. 0: none does.
static double find_level(const alpi_sky_table *t, double unevenness)
{
    double low = HUGE_VAL, high = 0.0;
    for (size_t i = 0; i < (size_t)t->width * t->height; i++) {
        const double b = alpi_sky_brightness(t->pixels[i]);
        high = b > high ? b : high;
        low = b > 0.0 && b < low ? b : low;
    }
    const double least = unevenness_below(t, low);
    unevenness = fmax(unevenness, BESIDE_BLACK * fmin(least, HALF_BLACK));
    if (least > unevenness) {
        return 0.0;
    }
    if (unevenness_below(t, high) <= unevenness) {
        return high;
    }
    while (high > 1.01 * low) {
        const double middle = sqrt(low * high);
        if (unevenness_below(t, middle) <= unevenness) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

alp_result alpi_sky_spots_part(alp_context *context, const alpi_sky_table *table, double unevenness,
                               alpi_sky_table *soft, alpi_sky_table *spots)
{
    *soft = *spots = (alpi_sky_table){0};
    const double level = find_level(table, unevenness);
    ALP_TRY(alpi_sky_table_create(context, table->width, table->height, 0.0f, soft));
    ALP_TRY(alpi_sky_table_create(context, table->width, table->height, 0.0f, spots));
    soft->turn = spots->turn = table->turn;
    for (size_t i = 0; i < (size_t)table->width * table->height; i++) {
        const vec3 pixel = table->pixels[i];
        const double b = alpi_sky_brightness(pixel);
        soft->pixels[i] = b > level ? vec3_scale(pixel, (float)(level / b)) : pixel;
        spots->pixels[i] = b > level ? vec3_sub(pixel, soft->pixels[i]) : (vec3){0.0f, 0.0f, 0.0f};
    }
    alpi_sky_table_finish(soft);
    alpi_sky_table_finish(spots);
    return ALP_OK;
}

// --- looks ---------------------------------------------------------------------------------------

/// A cell of the table that is not black.
typedef struct lit_cell {
    uint64_t order; // along a curve through the table
    uint32_t column, row;
    double weight; // share of all light
} lit_cell;

/// Place along Hilbert's curve through the square of side 2^16 (D. Hilbert, 1891), found quadrant
/// by quadrant.
static uint64_t hilbert(uint32_t x, uint32_t y)
{
    uint64_t place = 0;
    for (uint32_t side = 1u << 15; side > 0; side /= 2) {
        const uint32_t right = (x & side) != 0, low = (y & side) != 0;
        place = 4 * place + ((3 * right) ^ low);
        if (low == 0) { // the curve enters this quadrant turned
            const uint32_t flipped_x = right != 0 ? ~x : x, flipped_y = right != 0 ? ~y : y;
            x = flipped_y;
            y = flipped_x;
        }
    }
    return place;
}

static int by_order(const void *a, const void *b)
{
    const uint64_t first = ((const lit_cell *)a)->order, second = ((const lit_cell *)b)->order;
    return first < second ? -1 : first > second;
}

static uint32_t list_cells(const alpi_sky_table *t, lit_cell *cells)
{
    uint32_t count = 0;
    for (uint32_t row = 0; row <= t->height; row++) {
        for (uint32_t column = 0; column < t->width; column++) {
            const double weight = alpi_sky_table_cell_share(t, column, row);
            if (weight > 0.0 && cells != NULL) {
                cells[count] = (lit_cell){hilbert(column, row), column, row, weight};
            }
            count += weight > 0.0;
        }
    }
    return count;
}

/// One look in each of as many equal shares of the light along the list.
static void draw_looks(const alpi_sky_table *t, const lit_cell *cells, uint32_t count,
                       alpi_sky_looks *looks)
{
    enum { SEED = 0x5b0f };
    double sum = 0.0, before = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        sum += cells[i].weight;
    }
    for (uint32_t k = 0, i = 0; k < ALPI_SKY_LOOKS; k++) {
        const double place = sum * (k + 0.5) / ALPI_SKY_LOOKS;
        while (i + 1 < count && before + cells[i].weight <= place) {
            before += cells[i++].weight;
        }
        const vec3 d =
            alpi_sky_table_in_cell(t, cells[i].column, cells[i].row, alpi_sample_2d(SEED, k));
        const vec3 radiance = alpi_sky_table_radiance(t, d);
        const float density = fmaxf(alpi_sky_table_density(t, d), FLT_MIN);
        const float direction[3] = {d.x, d.y, d.z}, seen[3] = {radiance.x, radiance.y, radiance.z};
        for (int c = 0; c < 3; c++) {
            looks->direction[c][k] = direction[c];
            looks->light[c][k] = seen[c] / (density * (float)ALPI_SKY_LOOKS);
        }
    }
}

static vec3 look_at(const alpi_sky_looks *l, uint32_t k)
{
    return (vec3){l->direction[0][k], l->direction[1][k], l->direction[2][k]};
}

/// What holds of the looks of a block together.
static void sum_block(alpi_sky_looks *l, uint32_t block)
{
    const float rounded = 1e-6f; // of the axis, and of a product with it
    const uint32_t first = block * ALPI_LOOK_BLOCK;
    double sum[3] = {0.0, 0.0, 0.0}, moment[3][3] = {{0.0}};
    for (uint32_t k = first; k < first + ALPI_LOOK_BLOCK; k++) {
        for (int i = 0; i < 3; i++) {
            sum[i] += (double)l->direction[i][k];
            for (int c = 0; c < 3; c++) {
                moment[c][i] += (double)l->light[c][k] * (double)l->direction[i][k];
            }
        }
    }
    const vec3 mean = {(float)sum[0], (float)sum[1], (float)sum[2]};
    const vec3 axis = vec3_normalize_or(mean, (vec3){0.0f, 0.0f, 0.0f});
    const float along[3] = {axis.x, axis.y, axis.z};
    for (int i = 0; i < 3; i++) {
        l->axis[i][block] = along[i];
        l->sum[i][block] = (float)sum[i];
        for (int c = 0; c < 3; c++) {
            l->moment[c][i][block] = (float)moment[c][i];
        }
    }
    float apart = 0.0f;
    for (uint32_t k = first; k < first + ALPI_LOOK_BLOCK; k++) {
        apart = fmaxf(apart, vec3_length(vec3_sub(look_at(l, k), axis)));
    }
    l->apart[block] = apart + rounded;
}

alp_result alpi_sky_spots_look(alp_context *context, const alpi_sky_table *table,
                               alpi_sky_looks **looks)
{
    const uint32_t count = list_cells(table, NULL);
    ALPI_TRY_NEW(context, *looks, 1);
    lit_cell *cells = ALPI_NEW(context, lit_cell, count);
    if (cells == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    list_cells(table, cells);
    qsort(cells, count, sizeof *cells, by_order);
    draw_looks(table, cells, count, *looks);
    for (uint32_t b = 0; b < ALPI_LOOK_BLOCKS; b++) {
        sum_block(*looks, b);
    }
    alpi_release(context, cells);
    return ALP_OK;
}
