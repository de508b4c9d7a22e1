// SPDX-License-Identifier: MIT
// Stencils of the lattice, and the judge of what may be interpolated.
#include "maps/texels/lattice.h"
#include "maps/texels/validity.h"

#include <math.h>

enum { TEXELS_PER_RANGE = 1 << 12 };

// Across a larger angle, light changes at once: cos 16°. Texels that share their noise must be more
// alike: cos 8°.
static const float SMOOTH_COSINE = 0.96f, ALIKE_COSINE = 0.99f;

/// A texel, as the centre of its neighbourhood.
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

/// The texel (dx, dy) away, if it is known, in the same chart, and its normal within the angle.
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

/// The texel (dx, dy) away, if the centre may be interpolated from it; else ALPI_NONE.
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

/// The stencil in the middle of four; of two along a border if the other axis is missing.
static bool in_the_middle(const alpi_lattice *l, const centre *t, int h, alpi_stencil *s)
{
    const bool along_x = add_axis(l, t, h, 0, 0.5f, s);
    const bool along_y = (along_x || l->straight) && add_axis(l, t, 0, h, 0.5f, s);
    if (l->straight && along_x != along_y) {
        for (uint32_t i = 0; i < s->count; i++) {
            s->weights[i] *= 2.0f;
        }
        return true;
    }
    return along_x && along_y;
}

/// How the texels of a level lie to the texels of their stencils.
typedef enum level_kind { LEVEL_LATTICE, LEVEL_HALFWAY, LEVEL_MIDDLE } level_kind;

static const level_kind LEVEL_KINDS[ALPI_LATTICE_LEVELS] = {
    LEVEL_LATTICE, LEVEL_HALFWAY, LEVEL_MIDDLE, LEVEL_HALFWAY, LEVEL_HALFWAY, LEVEL_MIDDLE};

bool alpi_lattice_stencil(const alpi_lattice *lattice, uint32_t texel, alpi_stencil *stencil)
{
    const uint16_t *p = lattice->texels->pixels[texel];
    const uint32_t level = alpi_lattice_level(p);
    const level_kind kind = LEVEL_KINDS[level];
    const int h = (int)alpi_lattice_reach(level);
    stencil->count = 0;
    stencil->bend = 0.0f;
    bool whole = false;
    const centre c = find_centre(lattice, texel);
    if (kind == LEVEL_HALFWAY) {
        const bool across = (uint32_t)p[0] % (2 * (uint32_t)h) != 0;
        whole = add_axis(lattice, &c, across ? h : 0, across ? 0 : h, 1.0f, stencil);
        if (!whole && level == ALPI_LATTICE_LEVELS - 2 && lattice->straight) {
            whole = add_axis(lattice, &c, across ? 0 : 2 * h, across ? 2 * h : 0, 1.0f, stencil);
        }
    } else if (kind == LEVEL_MIDDLE) {
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

typedef struct stencil_job {
    const alpi_lattice *lattice;
    const uint32_t *order;
    uint32_t level;
    alpi_stencil_fn *body;
    void *user;
} stencil_job;

static alp_result run_stencils(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const stencil_job *job = user;
    const alpi_lattice *l = job->lattice;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = job->order[i];
        alpi_stencil stencil;
        if (l->states[t] == ALPI_TEXEL_INTERPOLATED &&
            alpi_lattice_level(l->texels->pixels[t]) == job->level &&
            alpi_lattice_stencil(l, t, &stencil)) {
            job->body(job->user, t, &stencil);
        }
    }
    return ALP_OK;
}

alp_result alpi_lattice_for_stencils(const alpi_lattice *lattice, const uint32_t *order,
                                     uint32_t count, alpi_stencil_fn *body, void *user,
                                     const alpi_task_progress *progress)
{
    stencil_job job = {.lattice = lattice, .order = order, .body = body, .user = user};
    for (job.level = 1; job.level < ALPI_LATTICE_LEVELS; job.level++) {
        ALP_TRY(alpi_parallel_for(lattice->context, count, TEXELS_PER_RANGE, run_stencils, &job,
                                  progress));
    }
    return ALP_OK;
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

static float noise_about(const alpi_lattice_judge *j, float value)
{
    return j->noise != NULL ? j->noise(j->user, value) : 1.0f;
}

/// Whether a texel may take the value of its stencil.
static bool is_smooth(const alpi_lattice_judge *j, uint32_t texel, const alpi_stencil *s)
{
    const bool near = j->proximity != NULL && j->proximity[texel] != ALPI_FAR;
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
            judge->marked[t] =
                alpi_lattice_kink(l, t) > judge->kink * noise_about(judge, l->values[t]);
        } else if (alpi_lattice_level(l->texels->pixels[t]) != judge->level || judge->marked[t]) {
            continue;
        } else if (alpi_lattice_stencil(l, t, &stencil) && is_smooth(judge, t, &stencil)) {
            l->states[t] = ALPI_TEXEL_INTERPOLATED;
            l->values[t] = alpi_lattice_interpolate(l, &stencil);
        } else {
            judge->marked[t] = 1;
        }
    }
}
