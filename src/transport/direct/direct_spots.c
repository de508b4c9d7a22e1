// SPDX-License-Identifier: MIT
#include "transport/direct/direct_gather.h"

#include "scene/sky/sky.h"

#include <string.h>

enum { R = ALPI_DIRECT_REPLICATES, BLOCK = ALPI_LOOK_BLOCK, FOUR = 4 };
_Static_assert((int)BLOCK == FOUR * FOUR && (int)R == (int)ALPI_PACKET, "as the loops have it");
/// The slack is that of the points of one chunk; other points may have normals farther apart.
static const float MORE_SLACK = 1.25f;
/// Normals less apart are rounded: facets in one plane.
static const float FLAT = 1e-4f;

// --- choosing ------------------------------------------------------------------------------------

/// Weights of looks that follow each other.
static void weigh(const alpi_spot_choice *c, uint32_t first, float weights[restrict BLOCK])
{
    const float *x = &c->looks->direction[0][first], *y = &c->looks->direction[1][first];
    const float *z = &c->looks->direction[2][first];
    const vec3 n = c->normal;
    const float slack = c->slack;
    for (int i = 0; i < BLOCK; i++) {
        const float w = n.x * x[i] + n.y * y[i] + n.z * z[i] + slack;
        weights[i] = w > 0.0f ? w : 0.0f;
    }
}

/// The sum over a block, by fours.
static float sum_by_fours(const float terms[BLOCK])
{
    float fours[BLOCK / FOUR];
    for (uint32_t i = 0; i < BLOCK / FOUR; i++) {
        const float *t = &terms[i * FOUR];
        fours[i] = (t[0] + t[1]) + (t[2] + t[3]);
    }
    return (fours[0] + fours[1]) + (fours[2] + fours[3]);
}

/// Adds a block that the horizon runs through. @return the sum of its weights
static float add_parted(alpi_spot_choice *c, uint32_t block)
{
    float weights[BLOCK];
    weigh(c, block * BLOCK, weights);
    for (int k = 0; k < 3; k++) {
        float terms[BLOCK];
        for (uint32_t i = 0; i < BLOCK; i++) {
            terms[i] = weights[i] * c->looks->light[k][block * BLOCK + i];
        }
        c->open[k] += (double)sum_by_fours(terms);
    }
    return sum_by_fours(weights);
}

/// n · v of all blocks.
static void multiply(vec3 n, const float (*v)[ALPI_LOOK_BLOCKS], float *products)
{
    for (uint32_t b = 0; b < ALPI_LOOK_BLOCKS; b++) {
        products[b] = n.x * v[0][b] + n.y * v[1][b] + n.z * v[2][b];
    }
}

/// Sums over the blocks, of which few are parted by the horizon.
static void sum_blocks(alpi_spot_choice *c)
{
    const alpi_sky_looks *l = c->looks;
    float heights[ALPI_LOOK_BLOCKS], sums[ALPI_LOOK_BLOCKS], open[3][ALPI_LOOK_BLOCKS];
    multiply(c->normal, l->axis, heights);
    multiply(c->normal, l->sum, sums);
    const int channels = c->slack > 0.0f ? 0 : 3; // of E₀
    for (int k = 0; k < channels; k++) {
        multiply(c->normal, l->moment[k], open[k]);
    }
    for (uint32_t b = 0; b < ALPI_LOOK_BLOCKS; b++) {
        const float height = heights[b] + c->slack;
        if (height >= l->apart[b]) {
            c->total += (double)(sums[b] + (float)BLOCK * c->slack);
            for (int k = 0; k < channels; k++) {
                c->open[k] += (double)open[k][b];
            }
        } else if (height > -l->apart[b]) {
            c->total += (double)add_parted(c, b);
        }
        c->ends[b] = c->total;
    }
}

void alpi_spots_choose(const alpi_sky_looks *looks, vec3 normal, float slack,
                       alpi_spot_choice *choice)
{
    if (choice->looks == looks && choice->slack == slack && choice->normal.x == normal.x &&
        choice->normal.y == normal.y && choice->normal.z == normal.z) {
        return; // neighbours are often of one plane
    }
    choice->looks = looks;
    choice->normal = normal;
    choice->slack = slack;
    choice->total = 0.0;
    choice->weighed = ALPI_NONE;
    memset(choice->open, 0, sizeof choice->open);
    sum_blocks(choice);
}

/// The first block that ends beyond a place, of those from `from` on up to one that does.
static uint32_t find_block(const alpi_spot_choice *c, double place, uint32_t from, uint32_t last)
{
    while (from < last) {
        const uint32_t middle = from + (last - from) / 2;
        const bool before = c->ends[middle] <= place;
        from = before ? middle + 1 : from;
        last = before ? last : middle;
    }
    return from;
}

static void weigh_block(alpi_spot_choice *c, uint32_t block)
{
    float sum = 0.0f;
    weigh(c, block * BLOCK, c->weights);
    for (uint32_t i = 0; i < BLOCK; i++) {
        sum += c->weights[i];
        c->look_ends[i] = sum;
    }
    c->weighed = block;
}

/// The look at a place in the block that was weighed last.
static uint32_t find_look(const alpi_spot_choice *c, float place)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i + 1 < BLOCK; i++) {
        found += c->look_ends[i] <= place;
    }
    while (!(c->weights[found] > 0.0f) && found > 0) { // rounding led past the last that has any
        found--;
    }
    return found;
}

alpi_spot_range alpi_spots_narrow(const alpi_spot_choice *choice, alpi_spot_range before, double to)
{
    const uint32_t last = find_block(choice, to, before.last, ALPI_LOOK_BLOCKS - 1);
    return (alpi_spot_range){before.last, last};
}

uint32_t alpi_spots_pick(alpi_spot_choice *choice, alpi_spot_range range, double place,
                         float *weight)
{
    const uint32_t block = find_block(choice, place, range.first, range.last);
    if (choice->weighed != block) { // draws that follow each other are often of one
        weigh_block(choice, block);
    }
    const double before = block > 0 ? choice->ends[block - 1] : 0.0;
    const uint32_t found = find_look(choice, (float)(place - before));
    *weight = choice->weights[found];
    return block * BLOCK + found;
}

// --- gathering -----------------------------------------------------------------------------------

/// Chooses by the points of the first chunk.
static void begin(alpi_direct_gather *g)
{
    const vec3 normal = g->points[0].shading_normal;
    float apart = 0.0f;
    for (uint32_t i = 1; i < g->count; i++) {
        apart = fmaxf(apart, vec3_length(vec3_sub(g->points[i].shading_normal, normal)));
    }
    alpi_spots_choose(alpi_sky_spot_looks(g->direct->sky), normal,
                      apart > FLAT ? MORE_SLACK * apart : 0.0f, &g->spots.choice);
    for (uint32_t r = 0; r < R; r++) { // those of a half at even distances too
        const uint32_t half = r / ALPI_DIRECT_HALF * ALPI_DIRECT_HALF;
        const double first = (double)alpi_direct_draw(g, ALPI_DIRECT_USE_SKY, half).x;
        g->spots.begins[r] = (first + (r - half)) / ALPI_DIRECT_HALF;
    }
    memset(g->spots.drawn, 0, sizeof g->spots.drawn);
    g->spots.range = (alpi_spot_range){0, 0};
    g->spots.found = (alpi_directional_found){.sums = {.width = g->horizon_width}};
}

/// Eight draws on their way, one of each replicate: light that each brings if it is free.
typedef struct spot_packet {
    float light[R][3];
    float cosines[R];
} spot_packet;

/// Aims the draws of all replicates within one of their even shares.
static void aim(alpi_direct_gather *g, uint32_t first, spot_packet *packet, alpi_rays *rays)
{
    alpi_spot_choice *c = &g->spots.choice;
    const uint32_t each = g->direct->samples / R, share = (g->first + first) / R;
    const double width = c->total / each;
    g->spots.range = alpi_spots_narrow(c, g->spots.range, (share + 1) * width);
    alpi_rays_clear(rays);
    for (uint32_t r = 0; r < R; r++) {
        const alpi_receiver_point *p = &g->points[first + r];
        const double place = (share + g->spots.begins[r]) * width;
        float weight;
        const uint32_t k = alpi_spots_pick(c, g->spots.range, place, &weight);
        const vec3 direction = {c->looks->direction[0][k], c->looks->direction[1][k],
                                c->looks->direction[2][k]};
        const float cosine = vec3_dot(direction, p->shading_normal);
        const bool counts = cosine > 0.0f && weight > 0.0f;
        const float factor = counts ? (float)c->total * (cosine / weight) : 0.0f;
        for (int i = 0; i < 3; i++) {
            packet->light[r][i] = c->looks->light[i][k] * factor;
            g->spots.drawn[r][i] += (double)packet->light[r][i];
        }
        packet->cosines[r] = cosine;
        alpi_rays_set(rays, (int)r, alpi_direct_start(p), direction, counts ? INFINITY : -INFINITY);
        g->rays += counts;
    }
}

/// Adds what arrives.
static void add_free(alpi_direct_gather *g, uint32_t first, const spot_packet *packet,
                     const alpi_rays *rays)
{
    for (uint32_t r = 0; r < R; r++) {
        if (rays->maximum[r] >= 0.0f) {
            const float *light = packet->light[r];
            const alpi_direct_arrival given = {
                .light = {light[0], light[1], light[2]},
                .part = (uint16_t)g->direct->sky_part,
                .replicate = (uint16_t)r,
                .way = {
                    .direction = {rays->direction_x[r], rays->direction_y[r], rays->direction_z[r]},
                    .normal = g->points[first + r].shading_normal,
                    .cosine = packet->cosines[r]}};
            alpi_direct_add(g, &given);
        }
    }
}

void alpi_direct_add_spots(alpi_direct_gather *g)
{
    const alpi_direct_options *o = &g->direct->options;
    const uint32_t packets = g->count / R;
    spot_packet given[ALPI_DIRECT_CHUNK / R];
    if (g->first == 0) {
        begin(g);
    }
    if (!(g->spots.choice.total > 0.0)) {
        return;
    }
    for (uint32_t k = 0; k < packets; k++) {
        aim(g, k * R, &given[k], &g->packets[k]);
    }
    alpi_trace_occluded(o->tracer, g->packets, packets, (1u << ALPI_PACKET) - 1u, o->filter,
                        ALPI_RAYS_PAIRED);
    alpi_directional_sums *others = g->by_direction;
    g->by_direction = others != NULL ? &g->spots.found.sums : NULL;
    for (uint32_t k = 0; k < packets; k++) {
        add_free(g, k * R, &given[k], &g->packets[k]);
    }
    g->by_direction = others;
}

/// Share of a channel's light that was free. A channel that few looks have may have been drawn too
/// seldom to tell: then all channels together have a say, as much as one draw.
static double find_ratio(const alpi_spot_gather *s, int channel, double draws, double (*sums)[3])
{
    double drawn[3] = {0.0, 0.0, 0.0}, free[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < 3 * R; i++) {
        drawn[i % 3] += s->drawn[i / 3][i % 3];
        free[i % 3] += sums[i / 3][i % 3];
    }
    const double expected = s->choice.open[channel] * draws;
    if (drawn[channel] >= 0.5 * expected && drawn[channel] > 0.0) {
        return free[channel] / drawn[channel];
    }
    const double all = drawn[0] + drawn[1] + drawn[2];
    const double together = all > 0.0 ? (free[0] + free[1] + free[2]) / all : 0.0;
    const double one = s->choice.open[channel];
    const double weight = drawn[channel] + one;
    return weight > 0.0 ? (free[channel] + one * together) / weight : 0.0;
}

/// Of a flat receiver: what there is, by what of it was free. Each replicate keeps what it found
/// apart from that, for the ratio has less noise than they.
/// @param each draws of a replicate
static void make_ratio(const alpi_spot_gather *s, double each, double (*sums)[3])
{
    double ratios[3];
    for (int k = 0; k < 3; k++) {
        ratios[k] = find_ratio(s, k, each * R, sums);
    }
    for (int k = 0; k < 3; k++) {
        double mean = 0.0;
        for (int r = 0; r < R; r++) {
            sums[r][k] -= ratios[k] * s->drawn[r][k];
            mean += sums[r][k] / R;
        }
        for (int r = 0; r < R; r++) {
            sums[r][k] += s->choice.open[k] * each * ratios[k] - mean;
        }
    }
}

void alpi_direct_finish_spots(alpi_direct_gather *g)
{
    alpi_spot_gather *s = &g->spots;
    double(*sums)[3] = g->sums[g->direct->sky_part];
    double light[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < 3 * R; i++) {
        s->found.irradiance[i % 3] += sums[i / 3][i % 3];
    }
    if (!(s->choice.slack > 0.0f)) {
        make_ratio(s, (double)g->direct->samples / R, sums);
    }
    for (int i = 0; i < 3 * R; i++) {
        light[i % 3] += sums[i / 3][i % 3];
    }
    if (g->by_direction != NULL) {
        alpi_directional_add_found(&s->found, light, g->by_direction);
    }
}
