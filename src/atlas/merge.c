// SPDX-License-Identifier: MIT
// Neighbouring charts become one where a single unwrapping of both is good. In rounds: each takes
// the best pairs of charts that have no chart in common, tries them side by side, and merges those
// that come out well.
#include "atlas/merge.h"
#include "atlas/regions.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <stdlib.h>

// Charts that meet at a crease stay apart: light steps there, and a texel of both is of neither.
// Unless one of them has but a few texels, which look beyond its edges wherever it lies.
static const float CREASE = 0.6f; // radians
static const double TINY_TEXELS = 4.0;
// The box of a pair, with its padding, may be this much larger than both before: what is concave
// leaves room that others cannot use. And a chart of more than LARGE of the scene fills at least
// LARGE_FILL of its box: few large discs fill a page badly.
static const double BOX_GROWTH = 1.08, LARGE = 0.125, LARGE_FILL = 0.8;
// Who wants charts to be flatter than this gets them as they are projected.
static const float LEAST_ANGLE = 0.35f; // radians
// Share of a page that charts fill, about: to know how many texels a metre there will be.
static const double FILL = 0.7;
// What is unwrapped at once is bounded, and so is how often a triangle is: the whole is linear.
enum { TRIANGLE_LIMIT = 4096, ROUND_LIMIT = 24 };

/// Two charts that meet, a < b.
typedef struct pair {
    uint32_t a, b;
    double length, creased; // metres they share, and of these at creases
    double score;           // higher ones are tried first
    bool merges;            // out
    double width, height;   // out: of the box of both
} pair;

typedef struct facts {
    double area, outline; // m², m
    double width, height; // of its box, m
    bool busy, changed;   // in this round: in an attempt; in one that merged
} facts;

typedef struct merger {
    alp_atlas *atlas;
    const uint32_t (*neighbours)[3];
    alpi_charts *charts;
    double density;  // texels a metre, about
    facts *facts;    // [charts]
    uint32_t *slots; // [triangle_count] index in its chart
    pair *pairs, *attempts, *failed;
    size_t pair_count, pair_capacity, attempt_count, attempt_capacity;
    size_t failed_count, failed_capacity; // failed: by charts, none of which changed since
} merger;

// --- pairs ---------------------------------------------------------------------------------------

static int by_charts(const void *left, const void *right)
{
    const pair *p = left, *q = right;
    if (p->a != q->a) {
        return p->a < q->a ? -1 : 1;
    }
    if (p->b != q->b) {
        return p->b < q->b ? -1 : 1;
    }
    return (p->length > q->length) - (p->length < q->length); // sums in one order
}

static int by_score(const void *left, const void *right)
{
    const pair *p = left, *q = right;
    if (p->score != q->score) {
        return p->score > q->score ? -1 : 1;
    }
    return by_charts(left, right);
}

static double edge_length(const alp_scene *scene, uint32_t triangle, int k)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return (double)vec3_length(vec3_sub(c[(k + 1) % 3], c[k]));
}

/// Edges between charts of one node, then one pair for all between the same two.
static alp_result collect_pairs(merger *m)
{
    const alp_scene *scene = m->atlas->scene;
    const uint32_t *charts = m->atlas->triangle_charts;
    size_t count = 0;
    ALP_TRY(alpi_grow(scene->context, (void **)&m->pairs, &m->pair_capacity, 1, sizeof *m->pairs));
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        for (int k = 0; k < 3 && charts[t] != ALPI_NONE; k++) {
            const uint32_t across = m->neighbours[t][k];
            if (across == ALPI_NONE || charts[across] <= charts[t] || charts[across] == ALPI_NONE ||
                !alpi_share_node(scene, t, across)) {
                continue;
            }
            ALP_TRY(alpi_grow(scene->context, (void **)&m->pairs, &m->pair_capacity, count + 1,
                              sizeof *m->pairs));
            const double length = edge_length(scene, t, k);
            const bool crease = alpi_crease(scene, m->neighbours, t, k) > CREASE;
            m->pairs[count++] = (pair){.a = charts[t],
                                       .b = charts[across],
                                       .length = length,
                                       .creased = crease ? length : 0.0};
        }
    }
    qsort(m->pairs, count, sizeof *m->pairs, by_charts);
    m->pair_count = 0;
    for (size_t i = 0; i < count; i++) {
        const pair *p = &m->pairs[i];
        pair *last = m->pair_count > 0 ? &m->pairs[m->pair_count - 1] : NULL;
        if (last != NULL && last->a == p->a && last->b == p->b) {
            last->length += p->length;
            last->creased += p->creased;
        } else {
            m->pairs[m->pair_count++] = *p;
        }
    }
    return ALP_OK;
}

static bool is_tiny(const merger *m, uint32_t chart)
{
    return m->facts[chart].area * m->density * m->density < TINY_TEXELS;
}

static bool has_failed(const merger *m, const pair *p)
{
    size_t low = 0, high = m->failed_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const pair *f = &m->failed[middle];
        if (f->a == p->a && f->b == p->b) {
            return true;
        }
        if (f->a < p->a || (f->a == p->a && f->b < p->b)) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return false;
}

/// Tiny charts first; then those that share most of their outline.
static bool score(const merger *m, pair *p)
{
    const facts *a = &m->facts[p->a], *b = &m->facts[p->b];
    const bool tiny = is_tiny(m, p->a) || is_tiny(m, p->b);
    if (m->charts->charts[p->a].count + m->charts->charts[p->b].count > TRIANGLE_LIMIT ||
        (p->creased > 0.5 * p->length && !tiny) || has_failed(m, p)) {
        return false;
    }
    const double smooth = p->length - 0.5 * p->creased;
    p->score = (tiny ? 2.0 : 0.0) + smooth / fmax(fmin(a->outline, b->outline), 1e-300);
    return true;
}

/// The pairs to be tried in this round.
static alp_result choose_attempts(merger *m)
{
    alp_context *context = m->atlas->context;
    size_t kept = 0;
    for (size_t i = 0; i < m->pair_count; i++) {
        if (score(m, &m->pairs[i])) {
            m->pairs[kept++] = m->pairs[i];
        }
    }
    m->pair_count = kept; // a round after one without merges begins with these
    qsort(m->pairs, kept, sizeof *m->pairs, by_score);
    for (uint32_t c = 0; c < m->charts->count; c++) {
        m->facts[c].busy = m->facts[c].changed = false;
    }
    m->attempt_count = 0;
    ALP_TRY(alpi_grow(context, (void **)&m->attempts, &m->attempt_capacity, kept + 1,
                      sizeof *m->attempts));
    for (size_t i = 0; i < kept; i++) {
        const pair *p = &m->pairs[i];
        if (!m->facts[p->a].busy && !m->facts[p->b].busy) {
            m->facts[p->a].busy = m->facts[p->b].busy = true;
            m->attempts[m->attempt_count++] = *p;
        }
    }
    return ALP_OK;
}

// --- rounds --------------------------------------------------------------------------------------

/// Lists the triangles of every chart together again, in the order of the scene.
static void group(merger *m)
{
    const alp_atlas *atlas = m->atlas;
    alpi_charts *charts = m->charts;
    uint32_t first = 0;
    for (uint32_t c = 0; c < charts->count; c++) {
        charts->charts[c].first = first;
        first += charts->charts[c].count;
        charts->charts[c].count = 0;
    }
    for (uint32_t t = 0; t < atlas->scene->triangle_count; t++) {
        if (atlas->triangle_charts[t] != ALPI_NONE) {
            alpi_chart *chart = &charts->charts[atlas->triangle_charts[t]];
            m->slots[t] = chart->count++;
            charts->triangles[chart->first + m->slots[t]] = t;
        }
    }
}

/// What the box of both may have, by what the boxes of each have.
static void set_bounds(const merger *m, const pair *p, alpi_merge *merge)
{
    const facts *a = &m->facts[p->a], *b = &m->facts[p->b];
    const double margin = (1.0 + m->atlas->options.padding) / m->density;
    merge->margin = margin;
    merge->room = BOX_GROWTH * ((a->width + margin) * (a->height + margin) +
                                (b->width + margin) * (b->height + margin));
    merge->fill = a->area + b->area > LARGE * m->atlas->scene->area ? LARGE_FILL : 0.0;
}

static alp_result try_pair(const merger *m, pair *p, uint32_t *triangles)
{
    const alpi_chart *a = &m->charts->charts[p->a], *b = &m->charts->charts[p->b];
    for (uint32_t i = 0; i < a->count; i++) {
        triangles[i] = m->charts->triangles[a->first + i];
    }
    for (uint32_t i = 0; i < b->count; i++) {
        triangles[a->count + i] = m->charts->triangles[b->first + i];
    }
    alpi_merge merge = {.source = {.scene = m->atlas->scene,
                                   .neighbours = m->neighbours,
                                   .triangles = triangles,
                                   .charts = m->atlas->triangle_charts,
                                   .slots = m->slots,
                                   .pair = {p->a, p->b},
                                   .first_count = a->count,
                                   .count = a->count + b->count},
                        .first_count = a->count};
    set_bounds(m, p, &merge);
    ALP_TRY(alpi_merge_attempt(m->atlas, &merge));
    p->merges = merge.merges;
    p->width = merge.width;
    p->height = merge.height;
    return ALP_OK;
}

static alp_result try_pairs(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    merger *m = user;
    alp_context *context = m->atlas->context;
    uint32_t *triangles = ALPI_NEW(context, uint32_t, TRIANGLE_LIMIT);
    alp_result result = triangles == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    for (uint32_t i = begin; result == ALP_OK && i < end; i++) {
        result = try_pair(m, &m->attempts[i], triangles);
    }
    alpi_release(context, triangles);
    return result;
}

/// Makes one chart of each pair that came out well, and remembers the others.
static alp_result settle(merger *m, bool *merged)
{
    *merged = false;
    for (size_t i = 0; i < m->attempt_count; i++) {
        const pair *p = &m->attempts[i];
        if (p->merges) {
            alpi_chart *a = &m->charts->charts[p->a], *b = &m->charts->charts[p->b];
            for (uint32_t k = b->first; k < b->first + b->count; k++) {
                m->atlas->triangle_charts[m->charts->triangles[k]] = p->a;
            }
            a->count += b->count;
            b->count = 0;
            m->facts[p->a].area += m->facts[p->b].area;
            m->facts[p->a].outline += m->facts[p->b].outline - 2.0 * p->length;
            m->facts[p->a].width = p->width;
            m->facts[p->a].height = p->height;
            m->facts[p->a].changed = m->facts[p->b].changed = true;
            *merged = true;
        }
    }
    size_t kept = 0;
    for (size_t i = 0; i < m->failed_count; i++) {
        if (!m->facts[m->failed[i].a].changed && !m->facts[m->failed[i].b].changed) {
            m->failed[kept++] = m->failed[i];
        }
    }
    ALP_TRY(alpi_grow(m->atlas->context, (void **)&m->failed, &m->failed_capacity,
                      kept + m->attempt_count + 1, sizeof *m->failed));
    for (size_t i = 0; i < m->attempt_count; i++) {
        if (!m->attempts[i].merges) {
            m->failed[kept++] = m->attempts[i];
        }
    }
    m->failed_count = kept;
    qsort(m->failed, kept, sizeof *m->failed, by_charts);
    return ALP_OK;
}

static alp_result run_rounds(merger *m)
{
    alp_context *context = m->atlas->context;
    bool merged = true;
    for (uint32_t round = 0; round < ROUND_LIMIT; round++) {
        ALP_TRY(alpi_tick(context, "merging", round, ROUND_LIMIT));
        if (merged) {
            group(m);
            ALP_TRY(collect_pairs(m));
        }
        ALP_TRY(choose_attempts(m));
        if (m->attempt_count == 0) {
            break;
        }
        ALP_TRY(alpi_parallel_for(context, (uint32_t)m->attempt_count, 1, try_pairs, m, NULL));
        ALP_TRY(settle(m, &merged));
    }
    return ALP_OK;
}

// --- beginning and end ---------------------------------------------------------------------------

static alp_result begin(merger *m)
{
    const alp_scene *scene = m->atlas->scene;
    const alp_atlas_options *options = &m->atlas->options;
    ALPI_TRY_NEW(scene->context, m->facts, m->charts->count);
    ALPI_TRY_NEW(scene->context, m->slots, scene->triangle_count);
    m->density = options->texels_per_metre > 0.0
                     ? options->texels_per_metre
                     : (double)options->size * sqrt(FILL / fmax(scene->area, 1e-300));
    for (uint32_t c = 0; c < m->charts->count; c++) {
        m->facts[c].width = m->charts->charts[c].width;
        m->facts[c].height = m->charts->charts[c].height;
    }
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const uint32_t chart = m->atlas->triangle_charts[t];
        if (chart == ALPI_NONE) {
            continue;
        }
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        m->facts[chart].area += vec3_triangle_area(c[0], c[1], c[2]);
        for (int k = 0; k < 3; k++) {
            const uint32_t across = m->neighbours[t][k];
            if (across == ALPI_NONE || m->atlas->triangle_charts[across] != chart) {
                m->facts[chart].outline += edge_length(scene, t, k);
            }
        }
    }
    return ALP_OK;
}

/// Drops charts that went into others.
static alp_result close_ranks(merger *m)
{
    alpi_charts *charts = m->charts;
    uint32_t *numbers = ALPI_NEW(m->atlas->context, uint32_t, charts->count);
    if (numbers == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    uint32_t count = 0;
    for (uint32_t c = 0; c < charts->count; c++) {
        numbers[c] = count;
        if (charts->charts[c].count > 0) {
            charts->charts[count++] = charts->charts[c];
        }
    }
    charts->count = count;
    for (uint32_t t = 0; t < m->atlas->scene->triangle_count; t++) {
        uint32_t *chart = &m->atlas->triangle_charts[t];
        *chart = *chart == ALPI_NONE ? ALPI_NONE : numbers[*chart];
    }
    alpi_release(m->atlas->context, numbers);
    group(m);
    return ALP_OK;
}

alp_result alpi_charts_merge(alp_atlas *atlas, const uint32_t (*neighbours)[3], alpi_charts *charts)
{
    if (atlas->options.max_angle < LEAST_ANGLE) {
        return ALP_OK;
    }
    merger m = {.atlas = atlas, .neighbours = neighbours, .charts = charts};
    alp_result result = begin(&m);
    result = result == ALP_OK ? run_rounds(&m) : result;
    result = result == ALP_OK ? close_ranks(&m) : result;
    alpi_release(atlas->context, m.facts);
    alpi_release(atlas->context, m.slots);
    alpi_release(atlas->context, m.pairs);
    alpi_release(atlas->context, m.attempts);
    alpi_release(atlas->context, m.failed);
    return result == ALP_OK ? alpi_charts_turn(atlas, neighbours, charts) : result;
}
