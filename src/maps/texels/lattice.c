// SPDX-License-Identifier: MIT
#include "maps/texels/lattice.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/texels/validity.h"

#include <math.h>
#include <string.h>

enum {
    TEXELS_PER_RANGE = 1 << 12,
    TILE_WIDTH = 16,
    TILE_HEIGHT = 8,
    BLOCK_WIDTH = 4,
    BLOCK_HEIGHT = 2
};

// Across a larger angle light changes at once: cos 16°. Texels that tell each other's noise must be
// more alike: cos 8°.
static const float SMOOTH_COSINE = 0.96f, ALIKE_COSINE = 0.99f;

// --- neighbourhood -------------------------------------------------------------------------------

uint32_t alpi_lattice_texel(const alpi_lattice *l, uint32_t page, int64_t x, int64_t y)
{
    if (x < 0 || y < 0 || x >= l->width || y >= l->height) {
        return ALPI_NONE;
    }
    return l->grid[alpi_lattice_pixel(l, page, (uint32_t)x, (uint32_t)y)];
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

/// Appends the texels of one rectangle, row by row.
static void append_block(const alpi_lattice *l, uint32_t page, uint32_t x0, uint32_t y0,
                         uint32_t *count)
{
    for (uint32_t y = y0; y < y0 + BLOCK_HEIGHT; y++) {
        for (uint32_t x = x0; x < x0 + BLOCK_WIDTH; x++) {
            const uint32_t t = alpi_lattice_texel(l, page, x, y);
            if (t != ALPI_NONE) {
                l->order[(*count)++] = t;
            }
        }
    }
}

/// Puts texels of one chart together and leaves their order: charts look in different directions,
/// and rays in different directions are slow company.
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
            for (uint32_t y = ty; y < ty + TILE_HEIGHT; y += BLOCK_HEIGHT) {
                for (uint32_t x = tx; x < tx + TILE_WIDTH; x += BLOCK_WIDTH) {
                    append_block(l, page, x, y, &count);
                }
            }
            sort_by_chart(l, first, count);
        }
    }
    return ALP_OK;
}

/// Tiles of 16 × 8 texels, in them chart by chart, blocks of 4 × 2: eight texels in a row of the
/// order are one block of the page, and eight of every fourth texel are one tile.
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

// --- passes --------------------------------------------------------------------------------------

uint32_t alpi_lattice_pass(const uint16_t pixel[2])
{
    static const uint8_t passes[ALPI_LATTICE_SPACING][ALPI_LATTICE_SPACING] = {
        {0, 3, 1, 3}, {3, 5, 4, 5}, {1, 4, 2, 4}, {3, 5, 4, 5}};
    return passes[pixel[1] % ALPI_LATTICE_SPACING][pixel[0] % ALPI_LATTICE_SPACING];
}

uint32_t alpi_lattice_reach(uint32_t pass)
{
    return pass <= 2 ? ALPI_LATTICE_SPACING / 2 : ALPI_LATTICE_SPACING / 4;
}

/// Ranges of an order that is split by passes.
typedef struct split {
    const alpi_lattice *lattice;
    const uint32_t *order;
    uint32_t count;
    uint32_t *by_pass;
    uint32_t (*at)[ALPI_LATTICE_PASSES]; // [ranges] texels of each pass; then where they go
} split;

static uint32_t range_end(const split *s, uint32_t range)
{
    const uint32_t left = s->count - range * TEXELS_PER_RANGE;
    return range * TEXELS_PER_RANGE + (left < TEXELS_PER_RANGE ? left : TEXELS_PER_RANGE);
}

static uint32_t pass_at(const split *s, uint32_t i)
{
    return alpi_lattice_pass(s->lattice->texels->pixels[s->order[i]]);
}

static alp_result count_passes(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const split *s = user;
    for (uint32_t r = begin; r < end; r++) {
        const uint32_t last = range_end(s, r);
        for (uint32_t i = r * TEXELS_PER_RANGE; i < last; i++) {
            s->at[r][pass_at(s, i)]++;
        }
    }
    return ALP_OK;
}

static alp_result split_ranges(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const split *s = user;
    for (uint32_t r = begin; r < end; r++) {
        const uint32_t last = range_end(s, r);
        for (uint32_t i = r * TEXELS_PER_RANGE; i < last; i++) {
            s->by_pass[s->at[r][pass_at(s, i)]++] = s->order[i];
        }
    }
    return ALP_OK;
}

alp_result alpi_lattice_split(const alpi_lattice *lattice, const uint32_t *order, uint32_t count,
                              uint32_t *by_pass, uint32_t first[ALPI_LATTICE_PASSES + 1])
{
    split s = {.lattice = lattice, .order = order, .count = count, .by_pass = by_pass};
    const uint32_t ranges = count / TEXELS_PER_RANGE + (count % TEXELS_PER_RANGE > 0 ? 1 : 0);
    ALPI_TRY_NEW(lattice->context, s.at, ranges);
    alp_result result = alpi_parallel_for(lattice->context, ranges, 1, count_passes, &s, NULL);
    uint32_t sum = 0;
    for (uint32_t pass = 0; pass < ALPI_LATTICE_PASSES; pass++) {
        first[pass] = sum;
        for (uint32_t r = 0; r < ranges; r++) {
            const uint32_t begin = sum;
            sum += s.at[r][pass];
            s.at[r][pass] = begin;
        }
    }
    first[ALPI_LATTICE_PASSES] = sum;
    if (result == ALP_OK) {
        result = alpi_parallel_for(lattice->context, ranges, 1, split_ranges, &s, NULL);
    }
    alpi_release(lattice->context, s.at);
    return result;
}

/// A texel that looks at those around it.
typedef struct centre {
    const uint32_t *at; // its place in the grid
    int x, y;
    uint32_t chart;
    vec3 normal;
} centre;

static inline centre find_centre(const alpi_lattice *l, uint32_t t)
{
    const uint16_t *p = l->texels->pixels[t];
    return (centre){.at = &l->grid[alpi_lattice_pixel(l, l->texels->pages[t], p[0], p[1])],
                    .x = p[0],
                    .y = p[1],
                    .chart = l->texels->charts[t],
                    .normal = vec3_load(l->texels->normals[t])};
}

/// The texel (dx, dy) away, if it is known, of the chart of the centre, and turned at most so far.
static inline uint32_t find_turned(const alpi_lattice *l, const centre *c, int dx, int dy,
                                   float cosine)
{
    const int x = c->x + dx, y = c->y + dy;
    if (x < 0 || y < 0 || x >= (int)l->width || y >= (int)l->height) {
        return ALPI_NONE;
    }
    const uint32_t n = c->at[(ptrdiff_t)dy * (ptrdiff_t)l->width + dx];
    if (n == ALPI_NONE || l->states[n] == ALPI_TEXEL_OPEN || l->texels->charts[n] != c->chart) {
        return ALPI_NONE;
    }
    return vec3_dot(vec3_load(l->texels->normals[n]), c->normal) >= cosine ? n : ALPI_NONE;
}

/// The texel (dx, dy) away, if the centre may be interpolated from it.
static inline uint32_t neighbour(const alpi_lattice *l, const centre *c, int dx, int dy)
{
    return find_turned(l, c, dx, dy, SMOOTH_COSINE);
}

static void add_to_stencil(alpi_stencil *s, uint32_t texel, float weight)
{
    s->texels[s->count] = texel;
    s->weights[s->count++] = weight;
}

/// Along one axis, the four nearest at −3h, −h, h, 3h: cubic weights (−1, 9, 9, −1) / 16, or the
/// mean of the inner two where an outer one is missing or stencils are straight.
/// @return false: an inner one is missing
static bool add_axis(const alpi_lattice *l, const centre *t, int dx, int dy, float share,
                     alpi_stencil *s)
{
    const uint32_t a = neighbour(l, t, -dx, -dy), b = neighbour(l, t, dx, dy);
    if (a == ALPI_NONE || b == ALPI_NONE) {
        return false;
    }
    const uint32_t c = neighbour(l, t, -3 * dx, -3 * dy), d = neighbour(l, t, 3 * dx, 3 * dy);
    const bool cubic = c != ALPI_NONE && d != ALPI_NONE;
    const float inner = cubic && !l->straight ? 0.5625f : 0.5f;
    add_to_stencil(s, a, share * inner);
    add_to_stencil(s, b, share * inner);
    if (cubic && !l->straight) {
        add_to_stencil(s, c, share * -0.0625f);
        add_to_stencil(s, d, share * -0.0625f);
    }
    float bend = 0.25f * fabsf(l->values[a] - l->values[b]);
    if (cubic) {
        bend = 0.0625f * fabsf(l->values[a] + l->values[b] - l->values[c] - l->values[d]);
    }
    s->bend = bend > s->bend ? bend : s->bend;
    return true;
}

/// Difference between the largest and smallest of the nearest texels of a stencil.
static float find_spread(const alpi_lattice *l, const alpi_stencil *s)
{
    float low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < s->count; i++) {
        if (s->weights[i] > 0.0f) {
            const float value = l->values[s->texels[i]];
            low = value < low ? value : low;
            high = value > high ? value : high;
        }
    }
    return high - low;
}

/// In the middle of four; of the two along a border where the others are missing.
static bool in_the_middle(const alpi_lattice *l, const centre *t, int h, alpi_stencil *s)
{
    const bool along_x = add_axis(l, t, h, 0, 0.5f, s);
    const bool along_y = (along_x || l->along_borders) && add_axis(l, t, 0, h, 0.5f, s);
    if (l->along_borders && along_x != along_y) {
        for (uint32_t i = 0; i < s->count; i++) {
            s->weights[i] *= 2.0f;
        }
        return true;
    }
    return along_x && along_y;
}

/// How the texels of a pass lie to those they are interpolated from.
typedef enum pass_kind { PASS_LATTICE, PASS_HALFWAY, PASS_MIDDLE } pass_kind;

static const pass_kind PASS_KINDS[ALPI_LATTICE_PASSES] = {PASS_LATTICE, PASS_HALFWAY, PASS_MIDDLE,
                                                          PASS_HALFWAY, PASS_HALFWAY, PASS_MIDDLE};

bool alpi_lattice_stencil(const alpi_lattice *lattice, uint32_t texel, alpi_stencil *stencil)
{
    const uint16_t *p = lattice->texels->pixels[texel];
    const uint32_t pass = alpi_lattice_pass(p);
    const pass_kind kind = PASS_KINDS[pass];
    const int h = (int)alpi_lattice_reach(pass);
    stencil->count = 0;
    stencil->bend = 0.0f;
    bool whole = false;
    const centre c = find_centre(lattice, texel);
    if (kind == PASS_HALFWAY) {
        const bool across = (uint32_t)p[0] % (2 * (uint32_t)h) != 0;
        whole = add_axis(lattice, &c, across ? h : 0, across ? 0 : h, 1.0f, stencil);
        if (!whole && pass == ALPI_LATTICE_PASSES - 2 && lattice->along_borders) {
            whole = add_axis(lattice, &c, across ? 0 : 2 * h, across ? 2 * h : 0, 1.0f, stencil);
        }
    } else if (kind == PASS_MIDDLE) {
        whole = in_the_middle(lattice, &c, h, stencil);
    }
    stencil->spread = whole ? find_spread(lattice, stencil) : 0.0f;
    return whole;
}

float alpi_lattice_interpolate(const alpi_lattice *lattice, const alpi_stencil *stencil)
{
    float value = 0.0f;
    for (uint32_t i = 0; i < stencil->count; i++) {
        value += stencil->weights[i] * lattice->values[stencil->texels[i]];
    }
    return value;
}

uint32_t alpi_lattice_traced_around(const alpi_lattice *lattice, uint32_t texel,
                                    uint32_t around[ALPI_NEIGHBOUR_LIMIT])
{
    uint32_t count = 0;
    const centre c = find_centre(lattice, texel);
    for (int dy = -1; dy <= 1; dy++) {
        for (int dx = -1; dx <= 1; dx++) {
            const uint32_t n =
                dx == 0 && dy == 0 ? ALPI_NONE : find_turned(lattice, &c, dx, dy, ALIKE_COSINE);
            if (n != ALPI_NONE && lattice->states[n] == ALPI_TEXEL_TRACED) {
                around[count++] = n;
            }
        }
    }
    return count;
}

/// Whether any of the four beside a texel is traced, of whatever chart.
static bool is_beside_traced(const alpi_lattice *l, const centre *c)
{
    const ptrdiff_t width = (ptrdiff_t)l->width;
    const uint32_t beside[4] = {
        c->x > 0 ? c->at[-1] : ALPI_NONE, c->x + 1 < (int)l->width ? c->at[1] : ALPI_NONE,
        c->y > 0 ? c->at[-width] : ALPI_NONE, c->y + 1 < (int)l->height ? c->at[width] : ALPI_NONE};
    bool any = false;
    for (int i = 0; i < 4; i++) {
        any = any || (beside[i] != ALPI_NONE && l->states[beside[i]] == ALPI_TEXEL_TRACED);
    }
    return any;
}

float alpi_lattice_kink(const alpi_lattice *lattice, uint32_t texel)
{
    static const int around[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    const centre c = find_centre(lattice, texel);
    if (!is_beside_traced(lattice, &c)) {
        return 0.0f;
    }
    const float value = lattice->values[texel];
    float step = 0.0f, sum = 0.0f;
    uint32_t count = 0;
    bool traced = false;
    for (int i = 0; i < 4; i++) {
        const uint32_t n = neighbour(lattice, &c, around[i][0], around[i][1]);
        if (n == ALPI_NONE) {
            continue;
        }
        count++;
        sum += lattice->values[n];
        if (lattice->states[n] == ALPI_TEXEL_TRACED) {
            traced = true;
            const float to = fabsf(lattice->values[n] - value);
            step = to > step ? to : step;
        }
    }
    if (!traced) {
        return 0.0f;
    }
    return count == 4 ? fabsf(0.25f * sum - value) : 0.5f * step;
}

// --- the judge -----------------------------------------------------------------------------------

bool alpi_lattice_is_coarse(const uint16_t pixel[2])
{
    return pixel[0] % 2 == 0 && pixel[1] % 2 == 0;
}

static float noise_about(const alpi_lattice_judge *j, float level)
{
    return j->noise != NULL ? j->noise(j->user, level) : 1.0f;
}

/// Whether a texel may take the value of its stencil.
static bool is_smooth(const alpi_lattice_judge *j, uint32_t texel, const alpi_stencil *s)
{
    const bool near = j->near != NULL && j->near[texel] != ALPI_FAR;
    const float noise = noise_about(j, alpi_lattice_interpolate(j->lattice, s));
    return s->spread <= (near ? j->near_spread : 1.0f) * j->spread * noise &&
           s->bend <= (near ? j->near_bend : 1.0f) * j->bend * noise;
}

void alpi_lattice_judge_range(const alpi_lattice_judge *judge, uint32_t begin, uint32_t end)
{
    alpi_lattice *l = judge->lattice;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = judge->order[i];
        alpi_stencil stencil;
        if (l->states[t] == ALPI_TEXEL_TRACED) {
            continue;
        }
        if (judge->flood) {
            judge->wanted[t] =
                alpi_lattice_kink(l, t) > judge->kink * noise_about(judge, l->values[t]);
        } else if (alpi_lattice_pass(l->texels->pixels[t]) != judge->pass || judge->wanted[t]) {
            continue;
        } else if (alpi_lattice_stencil(l, t, &stencil) && is_smooth(judge, t, &stencil)) {
            l->states[t] = ALPI_TEXEL_INTERPOLATED;
            l->values[t] = alpi_lattice_interpolate(l, &stencil);
        } else {
            judge->wanted[t] = 1;
        }
    }
}
