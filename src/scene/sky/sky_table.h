// SPDX-License-Identifier: MIT
// An equirectangular table of radiance, looked up bilinearly and drawn from in proportion to its
// brightness.
#ifndef ALPI_SCENE_SKY_TABLE_H
#define ALPI_SCENE_SKY_TABLE_H

#include "base/context.h"
#include "base/vec.h"

/// A search among the cells of a row begins and ends in so many places of a table that stays in a
/// processor's cache; the cells of a picture do not.
enum { ALPI_SKY_GUIDES = 64 };

/// Cell (i, j) of the table lies between texel centres i and i + 1 (around) and j − 1 and j; rows 0
/// and `height` are the half rows at the poles, where the outermost texels go on unchanged.
typedef struct alpi_sky_table {
    uint32_t width, height;
    vec3 *pixels;       // [height][width], radiance, ≥ 0; row 0 is up
    double turn;        // in turns, [0, 1)
    double total;       // ∫ of what directions are drawn in proportion to, over the sphere
    double *rows;       // [height + 1] sums of the cells of rows 0…j, over `total`
    double *cells;      // [height + 1][width] sums within the row, over the row's
    uint32_t *guides;   // [height + 1][ALPI_SKY_GUIDES + 1] first sum of a row above k / GUIDES
    double *haversines; // [height + 2] sin²(θ/2) at the upper edge of row j
} alpi_sky_table;

/// Black, of a size; the caller fills `pixels`, then calls alpi_sky_table_finish.
/// @param turn radians about +Y, counter-clockwise seen from above
/// @return ALP_OK; OUT_OF_MEMORY. On failure too the caller releases.
alp_result alpi_sky_table_create(alp_context *context, uint32_t width, uint32_t height, float turn,
                                 alpi_sky_table *table);
/// Sums up; `total` is 0 when all is black, and nothing can be drawn then.
void alpi_sky_table_finish(alpi_sky_table *table);
void alpi_sky_table_release(alp_context *context, alpi_sky_table *table);

/// Direction of a place: whole numbers are texel centres.
vec3 alpi_sky_table_direction(const alpi_sky_table *table, double x, double y);
vec3 alpi_sky_table_radiance(const alpi_sky_table *table, vec3 direction);
/// The same of many, whose texels memory brings while others are located.
void alpi_sky_table_radiances(const alpi_sky_table *table, const vec3 *directions, uint32_t count,
                              vec3 *radiances);
vec3 alpi_sky_table_sample(const alpi_sky_table *table, vec2 u);
/// The same within one cell, and the share that it has of all that is drawn.
vec3 alpi_sky_table_in_cell(const alpi_sky_table *table, uint32_t column, uint32_t row, vec2 u);
double alpi_sky_table_cell_share(const alpi_sky_table *table, uint32_t column, uint32_t row);
float alpi_sky_table_density(const alpi_sky_table *table, vec3 direction);
/// ∫ radiance dω / 4π of the bilinear function, exactly.
vec3 alpi_sky_table_mean(const alpi_sky_table *table);

/// x in [0, 1] with density ∝ (1 − x) a + x b; a and b ≥ 0, not both 0.
static inline double alpi_sample_linear(double u, double a, double b)
{
    double divisor = a + sqrt((1.0 - u) * a * a + u * b * b);
    double x = divisor > 0.0 ? u * (a + b) / divisor : 0.0;
    return x < 1.0 ? x : 1.0;
}

/// What directions are drawn in proportion to. The mean of the channels and not their luminance:
/// each channel has its own noise, and none is more than three times as bright as the mean.
static inline double alpi_sky_brightness(vec3 radiance)
{
    return ((double)radiance.x + (double)radiance.y + (double)radiance.z) / 3.0;
}

#endif
