// SPDX-License-Identifier: MIT
// An equirectangular table of radiance: look-up, density and drawing of directions.
//
// Radiance is bilinear in azimuth and polar angle θ. Directions are drawn from a function that is
// bilinear in azimuth and cosθ through the same texels: it can be inverted in closed form, it is 0
// only where the radiance is, and it follows the radiance within a factor of 2.
#include "scene/sky/sky_table.h"

#include "base/memory.h"

/// Where a direction lies in a cell.
typedef struct place {
    uint32_t x0, x1, y0, y1; // texels at the corners
    double across;           // [0, 1] from x0 to x1
    double down;             // [0, 1] from y0 to y1, in θ
} place;

static uint32_t upper_texel(uint32_t row)
{
    return row > 0 ? row - 1 : 0;
}

static uint32_t lower_texel(const alpi_sky_table *t, uint32_t row)
{
    return row < t->height ? row : t->height - 1;
}

static const vec3 *texel(const alpi_sky_table *t, uint32_t x, uint32_t y)
{
    return &t->pixels[(size_t)y * t->width + x];
}

static double brightness_at(const alpi_sky_table *t, uint32_t x, uint32_t y)
{
    return alpi_sky_brightness(*texel(t, x, y));
}

static double lerp(double a, double b, double t)
{
    return (1.0 - t) * a + t * b;
}

static double clamp_unit(double x)
{
    return x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x;
}

// --- making --------------------------------------------------------------------------------------

alp_result alpi_sky_table_create(alp_context *context, uint32_t width, uint32_t height, float turn,
                                 alpi_sky_table *table)
{
    *table = (alpi_sky_table){.width = width, .height = height};
    double turns = fmod((double)turn / (2.0 * ALPI_PI), 1.0);
    table->turn = turns < 0.0 ? turns + 1.0 : turns;
    ALPI_TRY_NEW(context, table->pixels, (size_t)width * height);
    ALPI_TRY_NEW(context, table->rows, (size_t)height + 1);
    ALPI_TRY_NEW(context, table->cells, (size_t)width * ((size_t)height + 1));
    ALPI_TRY_NEW(context, table->guides, ((size_t)height + 1) * (ALPI_SKY_GUIDES + 1));
    ALPI_TRY_NEW(context, table->haversines, (size_t)height + 2);
    for (uint32_t j = 1; j <= height; j++) {
        double s = sin((j - 0.5) * ALPI_PI / (2.0 * height));
        table->haversines[j] = s * s;
    }
    table->haversines[height + 1] = 1.0;
    return ALP_OK;
}

void alpi_sky_table_release(alp_context *context, alpi_sky_table *table)
{
    alpi_release(context, table->pixels);
    alpi_release(context, table->rows);
    alpi_release(context, table->cells);
    alpi_release(context, table->guides);
    alpi_release(context, table->haversines);
}

/// Sums of row j's cells, each the mean of its corners; the row's integral is returned.
static double sum_row(alpi_sky_table *t, uint32_t j)
{
    uint32_t y0 = upper_texel(j), y1 = lower_texel(t, j);
    double *cells = t->cells + (size_t)j * t->width;
    double sum = 0.0, left = brightness_at(t, 0, y0) + brightness_at(t, 0, y1);
    for (uint32_t i = 0; i < t->width; i++) {
        uint32_t next = i + 1 < t->width ? i + 1 : 0;
        double right = brightness_at(t, next, y0) + brightness_at(t, next, y1);
        sum += (left + right) / 4.0;
        cells[i] = sum;
        left = right;
    }
    for (uint32_t i = 0; sum > 0.0 && i < t->width; i++) {
        cells[i] /= sum; // the last becomes exactly 1
    }
    // A cell's solid angle: 2π/W of azimuth times the difference of cosθ, twice that of haversines.
    return sum * 4.0 * ALPI_PI / t->width * (t->haversines[j + 1] - t->haversines[j]);
}

/// The last guides lead to the last cell: nothing is drawn beyond it.
static void guide_row(alpi_sky_table *t, uint32_t j)
{
    const double *cells = t->cells + (size_t)j * t->width;
    uint32_t *guides = t->guides + (size_t)j * (ALPI_SKY_GUIDES + 1);
    uint32_t i = 0;
    for (uint32_t k = 0; k <= ALPI_SKY_GUIDES; k++) {
        while (i + 1 < t->width && cells[i] <= (double)k / ALPI_SKY_GUIDES) {
            i++;
        }
        guides[k] = i;
    }
}

void alpi_sky_table_finish(alpi_sky_table *table)
{
    double total = 0.0;
    for (uint32_t j = 0; j <= table->height; j++) {
        total += sum_row(table, j);
        guide_row(table, j);
        table->rows[j] = total;
    }
    for (uint32_t j = 0; total > 0.0 && j <= table->height; j++) {
        table->rows[j] /= total;
    }
    table->total = total;
}

// --- looking up ----------------------------------------------------------------------------------

/// floor(x) of what an int32_t holds: where the processor has no instruction for it, a call.
static inline double whole_below(double x)
{
    const double whole = (double)(int32_t)x;
    return whole > x ? whole - 1.0 : whole;
}

/// @param row out: of cells
static place locate(const alpi_sky_table *t, vec3 d, double radius, uint32_t *row)
{
    double around = (double)atan2f(d.x, -d.z) / (2.0 * ALPI_PI) + 0.5 + t->turn;
    double x = (around - whole_below(around)) * t->width - 0.5;
    double y = (double)atan2f((float)radius, d.y) / ALPI_PI * t->height - 0.5;
    double left = whole_below(x), up = whole_below(y);
    *row = up < 0.0 ? 0 : up >= t->height - 1.0 ? t->height : (uint32_t)up + 1;
    place p = {.y0 = upper_texel(*row), .y1 = lower_texel(t, *row), .across = x - left};
    p.x0 = left < 0.0 ? t->width - 1 : (uint32_t)left;
    p.x1 = p.x0 + 1 < t->width ? p.x0 + 1 : 0;
    p.down = clamp_unit(y - up);
    return p;
}

static double radius_of(vec3 d)
{
    return sqrt((double)d.x * (double)d.x + (double)d.z * (double)d.z);
}

/// Where a direction lies in cosθ in its row of cells, [0, 1].
static double find_down_cosine(const alpi_sky_table *t, vec3 d, double radius, uint32_t row)
{
    // sin²(θ/2) and cos²(θ/2), each from what does not cancel near its pole.
    double small = radius * radius / (2.0 * (1.0 + fabs((double)d.y)));
    const double *h = t->haversines;
    uint32_t mirror = t->height - row;
    return clamp_unit(d.y >= 0.0f ? (small - h[row]) / (h[row + 1] - h[row])
                                  : 1.0 - (small - h[mirror]) / (h[mirror + 1] - h[mirror]));
}

static vec3 radiance_at(const alpi_sky_table *table, const place *p)
{
    float s = (float)p->across, t = (float)p->down;
    vec3 top =
        vec3_mad(vec3_scale(*texel(table, p->x0, p->y0), 1.0f - s), s, *texel(table, p->x1, p->y0));
    vec3 bottom =
        vec3_mad(vec3_scale(*texel(table, p->x0, p->y1), 1.0f - s), s, *texel(table, p->x1, p->y1));
    return vec3_mad(vec3_scale(top, 1.0f - t), t, bottom);
}

vec3 alpi_sky_table_radiance(const alpi_sky_table *table, vec3 direction)
{
    uint32_t row;
    place p = locate(table, direction, radius_of(direction), &row);
    return radiance_at(table, &p);
}

void alpi_sky_table_radiances(const alpi_sky_table *table, const vec3 *directions, uint32_t count,
                              vec3 *radiances)
{
    enum { BATCH = 32 };
    place places[BATCH];
    uint32_t row;
    for (uint32_t first = 0; first < count; first += BATCH) {
        const uint32_t few = count - first < BATCH ? count - first : BATCH;
        for (uint32_t i = 0; i < few; i++) {
            const vec3 d = directions[first + i];
            places[i] = locate(table, d, radius_of(d), &row);
            __builtin_prefetch(texel(table, places[i].x0, places[i].y0));
            __builtin_prefetch(texel(table, places[i].x0, places[i].y1));
        }
        for (uint32_t i = 0; i < few; i++) {
            radiances[first + i] = radiance_at(table, &places[i]);
        }
    }
}

float alpi_sky_table_density(const alpi_sky_table *table, vec3 direction)
{
    uint32_t row;
    const double radius = radius_of(direction);
    place p = locate(table, direction, radius, &row);
    double top = lerp(brightness_at(table, p.x0, p.y0), brightness_at(table, p.x1, p.y0), p.across);
    double bottom =
        lerp(brightness_at(table, p.x0, p.y1), brightness_at(table, p.x1, p.y1), p.across);
    return (float)(lerp(top, bottom, find_down_cosine(table, direction, radius, row)) /
                   table->total);
}

// --- drawing -------------------------------------------------------------------------------------

/// Index of the first sum above u, and u's place within it. Cells without weight are never found.
/// @param first of [first, first + count), which holds it
static uint32_t find_cell(const double *sums, uint32_t first, uint32_t count, double u,
                          double *rest)
{
    while (count > 1) { // without a branch that no processor could foresee
        const uint32_t half = count / 2;
        first += sums[first + half - 1] > u ? 0 : half;
        count -= half;
    }
    double below = first > 0 ? sums[first - 1] : 0.0;
    *rest = clamp_unit((u - below) / (sums[first] - below));
    return first;
}

static vec3 direction_at(const alpi_sky_table *t, double x, double haversine, double rest)
{
    double phi = 2.0 * ALPI_PI * ((x + 0.5) / t->width - 0.5 - t->turn);
    double sine = 2.0 * sqrt(haversine * rest);
    return (vec3){(float)(sine * sin(phi)), (float)(rest - haversine), (float)(-sine * cos(phi))};
}

vec3 alpi_sky_table_direction(const alpi_sky_table *table, double x, double y)
{
    double half = (y + 0.5) * ALPI_PI / (2.0 * table->height);
    return direction_at(table, x, sin(half) * sin(half), cos(half) * cos(half));
}

/// @param across, down places in [0, 1] of what the cell and its row are drawn with
static vec3 sample_cell(const alpi_sky_table *table, uint32_t x0, uint32_t row, double across,
                        double down)
{
    uint32_t x1 = x0 + 1 < table->width ? x0 + 1 : 0;
    uint32_t y0 = upper_texel(row), y1 = lower_texel(table, row);
    double a = brightness_at(table, x0, y0), b = brightness_at(table, x1, y0);
    double c = brightness_at(table, x0, y1), d = brightness_at(table, x1, y1);
    double t = alpi_sample_linear(down, a + b, c + d);
    double s = alpi_sample_linear(across, lerp(a, c, t), lerp(b, d, t));
    const double *h = table->haversines;
    uint32_t mirror = table->height - row;
    return direction_at(table, x0 + s, lerp(h[row], h[row + 1], t),
                        lerp(h[mirror + 1], h[mirror], t));
}

vec3 alpi_sky_table_sample(const alpi_sky_table *table, vec2 u)
{
    double across = 0.0, down = 0.0;
    uint32_t row = find_cell(table->rows, 0, table->height + 1, (double)u.y, &down);
    const double *cells = table->cells + (size_t)row * table->width;
    const uint32_t *guides = table->guides + (size_t)row * (ALPI_SKY_GUIDES + 1);
    const uint32_t k = (uint32_t)(u.x * (float)ALPI_SKY_GUIDES);
    const uint32_t last = guides[k + 1] - guides[k] + 1;
    uint32_t column = find_cell(cells, guides[k], last, (double)u.x, &across);
    return sample_cell(table, column, row, across, down);
}

vec3 alpi_sky_table_in_cell(const alpi_sky_table *table, uint32_t column, uint32_t row, vec2 u)
{
    return sample_cell(table, column, row, (double)u.x, (double)u.y);
}

double alpi_sky_table_cell_share(const alpi_sky_table *table, uint32_t column, uint32_t row)
{
    const double *cells = table->cells + (size_t)row * table->width;
    const double of_rows = table->rows[row] - (row > 0 ? table->rows[row - 1] : 0.0);
    return of_rows * (cells[column] - (column > 0 ? cells[column - 1] : 0.0));
}

// --- the mean ------------------------------------------------------------------------------------

/// ∫ sinθ over θ of the hat that row y's texels are looked up with: 1 at its centre, 0 at its
/// neighbours', 1 out to the poles.
static double row_weight(uint32_t y, uint32_t height)
{
    double step = ALPI_PI / height, center = (y + 0.5) * step;
    double before = center - step, after = center + step;
    double rise = y > 0 ? (sin(center) - sin(before)) / step - cos(center) : 1.0 - cos(center);
    double fall =
        y + 1 < height ? cos(center) - (sin(after) - sin(center)) / step : 1.0 + cos(center);
    return rise + fall;
}

vec3 alpi_sky_table_mean(const alpi_sky_table *table)
{
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t y = 0; y < table->height; y++) {
        double row[3] = {0.0, 0.0, 0.0};
        for (uint32_t x = 0; x < table->width; x++) {
            const vec3 *pixel = texel(table, x, y);
            row[0] += (double)pixel->x;
            row[1] += (double)pixel->y;
            row[2] += (double)pixel->z;
        }
        for (int k = 0; k < 3; k++) {
            sum[k] += row[k] * row_weight(y, table->height);
        }
    }
    double scale = 0.5 / table->width;
    return (vec3){(float)(sum[0] * scale), (float)(sum[1] * scale), (float)(sum[2] * scale)};
}
