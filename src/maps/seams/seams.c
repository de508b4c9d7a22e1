// SPDX-License-Identifier: MIT
#include "maps/seams/seams.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/lookup.h"
#include "maps/seams/seam_edges.h"
#include "maps/seams/seam_sight.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES_PER_TEXEL = 2, SAMPLES_PER_TICK = 1 << 12, QUEUE = 1 << 10 };

// --- samples -------------------------------------------------------------------------------------

/// A place where two edges meet.
typedef struct candidate {
    uint32_t triangles[2];
    double at[2][2]; // weights of corners 1 and 2
    float sizes[2];  // metres and texels that it stands for
    uint32_t pair;
} candidate;

/// Candidates wait in a queue, so that their rays are traced many at a time.
typedef struct builder {
    const alp_lightmap *lightmap;
    const alpi_tracer *tracer;
    alpi_seams *seams;
    uint32_t *places; // [pixels of all pages] place in seams->pixels + 1; 0: none yet
    uint8_t *known;   // [pixels of all pages / 8 + 1] bits: a texel that is seen and has a value
    size_t sample_room, first_room, span_room, pair_room, triangle_room;
    size_t texel_room, weight_room, pixel_room;
    candidate *queue;   // [QUEUE]
    alpi_sight *sights; // [QUEUE]
    uint32_t queued, pairs, last_pair;
} builder;

/// A point of an edge: weights of corners 1 and 2 of its triangle.
static void point_on_edge(const alpi_seam_edge *edge, double share, double b[2])
{
    const uint32_t k = edge->half_edge % 3;
    double corners[3] = {0.0, 0.0, 0.0};
    corners[k] = 1.0 - share;
    corners[(k + 1) % 3] = share;
    b[0] = corners[1];
    b[1] = corners[2];
}

static vec3 normal_at(const alp_scene *scene, uint32_t triangle, const double b[2])
{
    const uint32_t *corner = scene->triangles[triangle];
    const vec3 zero = {0.0f, 0.0f, 0.0f};
    vec3 n = vec3_scale(vec3_load(scene->normals[corner[0]]), (float)(1.0 - b[0] - b[1]));
    n = vec3_mad(n, (float)b[0], vec3_load(scene->normals[corner[1]]));
    n = vec3_mad(n, (float)b[1], vec3_load(scene->normals[corner[2]]));
    return vec3_normalize_or(n, zero);
}

/// Adds what one side reads to the row that is being made, which began at `begin`.
static alp_result add_side(builder *b, uint32_t begin, const alpi_lookup *lookup, double sign)
{
    alpi_seams *s = b->seams;
    for (uint32_t i = 0; i < lookup->count; i++) {
        uint32_t *place = &b->places[lookup->texels[i]];
        if (*place == 0) {
            if (s->pixel_count == UINT32_MAX - 1) {
                return alpi_fail(s->context, ALP_ERROR_LIMIT,
                                 "%s: more than 2^32 texels lie at seams; use fewer texels",
                                 b->lightmap->scene->name);
            }
            ALP_TRY(alpi_grow(s->context, (void **)&s->pixels, &b->pixel_room,
                              (size_t)s->pixel_count + 1, sizeof *s->pixels));
            s->pixels[s->pixel_count++] = lookup->texels[i];
            *place = s->pixel_count;
        }
        uint32_t *end = &s->first[s->sample_count + 1], at = begin;
        while (at < *end && s->texels[at] != *place - 1) {
            at++;
        }
        if (at == *end) {
            ALP_TRY(alpi_grow(s->context, (void **)&s->texels, &b->texel_room, (size_t)at + 1,
                              sizeof *s->texels));
            ALP_TRY(alpi_grow(s->context, (void **)&s->weights, &b->weight_room, (size_t)at + 1,
                              sizeof *s->weights));
            s->texels[at] = *place - 1;
            s->weights[at] = 0.0f;
            ++*end;
        }
        s->weights[at] += (float)(sign * lookup->weights[i]);
    }
    return ALP_OK;
}

/// Whether both sides read the same.
static bool is_idle(const alpi_seams *s, uint32_t begin, uint32_t end)
{
    const float rounding = 1e-4f; // of coordinates, in texels
    for (uint32_t i = begin; i < end; i++) {
        if (fabsf(s->weights[i]) > rounding) {
            return false;
        }
    }
    return true;
}

/// Whether a side reads any texel that is seen and has a value of its own.
static bool is_known(const builder *b, const alpi_lookup *lookup)
{
    const double least = 1e-3; // of a weight
    for (uint32_t i = 0; i < lookup->count; i++) {
        const size_t at = lookup->texels[i];
        if (lookup->weights[i] > least && (b->known[at / 8] >> at % 8 & 1) != 0) {
            return true;
        }
    }
    return false;
}

static alp_result reserve_sample(builder *b)
{
    alpi_seams *s = b->seams;
    const uint32_t sample = s->sample_count;
    ALP_TRY(alpi_grow(s->context, (void **)&s->first, &b->first_room, (size_t)sample + 2,
                      sizeof *s->first));
    ALP_TRY(alpi_grow(s->context, (void **)&s->lengths, &b->sample_room, (size_t)sample + 1,
                      sizeof *s->lengths));
    ALP_TRY(alpi_grow(s->context, (void **)&s->spans, &b->span_room, (size_t)sample + 1,
                      sizeof *s->spans));
    ALP_TRY(alpi_grow(s->context, (void **)&s->pairs, &b->pair_room, (size_t)sample + 1,
                      sizeof *s->pairs));
    ALP_TRY(alpi_grow(s->context, (void **)&s->triangles, &b->triangle_room, (size_t)sample + 1,
                      sizeof *s->triangles));
    if (s->first[sample] > UINT32_MAX - 2 * ALPI_LOOKUP_LIMIT) {
        return alpi_fail(s->context, ALP_ERROR_LIMIT,
                         "%s: the samples along its seams are more than 2^32; use fewer texels",
                         b->lightmap->scene->name);
    }
    return ALP_OK;
}

static alp_result add_sample(builder *b, const candidate *c)
{
    alpi_seams *s = b->seams;
    alpi_lookup sides[2];
    for (int i = 0; i < 2; i++) {
        alpi_lookup_at(b->lightmap, c->triangles[i], c->at[i][0], c->at[i][1], &sides[i]);
        if (!is_known(b, &sides[i])) {
            return ALP_OK;
        }
    }
    ALP_TRY(reserve_sample(b));
    const uint32_t sample = s->sample_count, begin = s->first[sample];
    s->first[sample + 1] = begin;
    ALP_TRY(add_side(b, begin, &sides[0], 1.0));
    ALP_TRY(add_side(b, begin, &sides[1], -1.0));
    if (!is_idle(s, begin, s->first[sample + 1])) {
        s->lengths[sample] = c->sizes[0];
        s->spans[sample] = c->sizes[1];
        s->pairs[sample] = c->pair;
        memcpy(s->triangles[sample], c->triangles, sizeof c->triangles);
        s->length += (double)c->sizes[0];
        s->count += c->pair != b->last_pair ? 1 : 0;
        b->last_pair = c->pair;
        s->sample_count++;
    }
    return ALP_OK;
}

/// Adds the candidates of the queue whose sides see each other.
static alp_result empty_queue(builder *b)
{
    if (b->tracer != NULL && b->queued > 0) {
        ALP_TRY(alpi_sight_trace(b->tracer, b->seams->context, b->sights, b->queued));
    }
    for (uint32_t i = 0; i < b->queued; i++) {
        if (b->sights[i].blocked) {
            b->seams->blocked++;
        } else {
            ALP_TRY(add_sample(b, &b->queue[i]));
        }
    }
    b->queued = 0;
    return ALP_OK;
}

/// Queues a place of a pair of edges, unless it is at a crease.
static alp_result queue_sample(builder *b, const alpi_seam_pair *pair, double share,
                               const float sizes[2])
{
    const alp_scene *scene = b->lightmap->scene;
    if (b->queued == QUEUE) {
        ALP_TRY(empty_queue(b));
    }
    candidate *c = &b->queue[b->queued];
    *c = (candidate){.sizes = {sizes[0], sizes[1]}, .pair = b->pairs};
    uint32_t half_edges[2];
    double shares[2];
    float texels[2];
    vec3 normals[2];
    for (int i = 0; i < 2; i++) {
        half_edges[i] = pair->edges[i].half_edge;
        texels[i] = pair->edges[i].texel;
        shares[i] = pair->begins[i] + share * (pair->ends[i] - pair->begins[i]);
        c->triangles[i] = half_edges[i] / 3;
        point_on_edge(&pair->edges[i], shares[i], c->at[i]);
        normals[i] = normal_at(scene, c->triangles[i], c->at[i]);
    }
    if ((double)vec3_dot(normals[0], normals[1]) >= ALPI_SEAM_COSINE) {
        b->sights[b->queued++] = b->tracer != NULL
                                     ? alpi_sight_aim(scene, half_edges, shares, texels)
                                     : (alpi_sight){.aimed = false};
    }
    return ALP_OK;
}

static alp_result add_pair(void *user, const alpi_seam_pair *pair)
{
    builder *b = user;
    const double texel = (double)fminf(pair->edges[0].texel, pair->edges[1].texel);
    const double texels = pair->length / texel;
    const double rounding = 1e-3, most = 1 << 20; // no page is as wide
    const uint32_t count =
        (uint32_t)fmin(fmax(ceil(SAMPLES_PER_TEXEL * texels - rounding), 1.0), most);
    const float sizes[2] = {(float)(pair->length / count), (float)(texels / count)};
    b->pairs++;
    for (uint32_t i = 0; i < count; i++) {
        if (i % SAMPLES_PER_TICK == SAMPLES_PER_TICK - 1) {
            ALP_TRY(alpi_tick(b->seams->context, "seams", 0, 1));
        }
        ALP_TRY(queue_sample(b, pair, (i + 0.5) / count, sizes));
    }
    return ALP_OK;
}

static size_t pixel_of(const alp_lightmap *l, uint32_t texel)
{
    const size_t page_size = (size_t)l->width * l->height;
    const uint16_t *pixel = l->texels.pixels[texel];
    return l->texels.pages[texel] * page_size + (size_t)pixel[1] * l->width + pixel[0];
}

static void mark_known(const builder *b)
{
    const alp_lightmap *l = b->lightmap;
    for (uint32_t t = 0; t < l->texels.count; t++) {
        const size_t at = pixel_of(l, t);
        if (l->states[t] != ALPI_TEXEL_OPEN && (l->texels.flags[t] & ALPI_TEXEL_HIDDEN) == 0) {
            b->known[at / 8] |= (uint8_t)(1u << at % 8);
        }
    }
}

/// Which texels of the footprints have a value of their own.
static alp_result find_owners(const builder *b)
{
    const alp_lightmap *l = b->lightmap;
    alpi_seams *s = b->seams;
    ALPI_TRY_NEW(s->context, s->owners, s->pixel_count);
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        s->owners[i] = ALPI_NONE;
    }
    for (uint32_t t = 0; t < l->texels.count; t++) {
        const uint32_t place = b->places[pixel_of(l, t)];
        if (place > 0 && l->states[t] != ALPI_TEXEL_OPEN) {
            s->owners[place - 1] = t;
        }
    }
    return ALP_OK;
}

static alp_result build(builder *b)
{
    const alp_lightmap *l = b->lightmap;
    const size_t pixels = (size_t)l->page_count * l->height * l->width;
    ALPI_TRY_NEW(l->context, b->places, pixels);
    ALPI_TRY_NEW(l->context, b->known, pixels / 8 + 1);
    ALPI_TRY_NEW(l->context, b->queue, QUEUE);
    ALPI_TRY_NEW(l->context, b->sights, QUEUE);
    mark_known(b);
    ALP_TRY(alpi_grow(l->context, (void **)&b->seams->first, &b->first_room, 1,
                      sizeof *b->seams->first));
    alpi_seam_edges edges;
    ALP_TRY(alpi_seam_edges_create(l, &edges));
    alp_result result = alpi_seam_pairs_visit(l->scene, &edges, add_pair, b);
    if (result == ALP_OK) {
        result = empty_queue(b);
    }
    alpi_seam_edges_destroy(&edges);
    return result == ALP_OK ? find_owners(b) : result;
}

alp_result alpi_seams_create(const alp_lightmap *lightmap, const alpi_tracer *tracer,
                             alpi_seams *seams)
{
    *seams = (alpi_seams){.context = lightmap->context};
    builder b = {.lightmap = lightmap, .tracer = tracer, .seams = seams};
    const alp_result result = build(&b);
    alpi_release(lightmap->context, b.places);
    alpi_release(lightmap->context, b.known);
    alpi_release(lightmap->context, b.queue);
    alpi_release(lightmap->context, b.sights);
    if (result != ALP_OK) {
        alpi_seams_destroy(seams);
    }
    return result;
}

void alpi_seams_destroy(alpi_seams *seams)
{
    if (seams->context != NULL) {
        alpi_release(seams->context, seams->lengths);
        alpi_release(seams->context, seams->spans);
        alpi_release(seams->context, seams->pairs);
        alpi_release(seams->context, seams->triangles);
        alpi_release(seams->context, seams->first);
        alpi_release(seams->context, seams->texels);
        alpi_release(seams->context, seams->weights);
        alpi_release(seams->context, seams->pixels);
        alpi_release(seams->context, seams->owners);
    }
    *seams = (alpi_seams){0};
}

// --- how far apart the sides are -----------------------------------------------------------------

typedef struct step {
    float difference, length;
} step;

static int compare_steps(const void *a, const void *b)
{
    const step *x = a, *y = b;
    if (x->difference != y->difference) {
        return x->difference < y->difference ? -1 : 1;
    }
    return (x->length > y->length) - (x->length < y->length); // sums in one order
}

void alpi_seams_difference(const alp_lightmap *lightmap, const alpi_seams *seams, uint32_t sample,
                           float *const *pages, double difference[3])
{
    const size_t page_size = (size_t)lightmap->width * lightmap->height;
    difference[0] = difference[1] = difference[2] = 0.0;
    for (uint32_t i = seams->first[sample]; i < seams->first[sample + 1]; i++) {
        const size_t at = seams->pixels[seams->texels[i]];
        const float *value = pages[at / page_size] + 4 * (at % page_size);
        for (int k = 0; k < 3; k++) {
            difference[k] += (double)seams->weights[i] * (double)value[k];
        }
    }
}

alp_result alpi_seams_measure(const alp_lightmap *lightmap, const alpi_seams *seams,
                              float *const *pages, alpi_seam_step *error)
{
    *error = (alpi_seam_step){0.0, 0.0};
    step *steps = ALPI_NEW(seams->context, step, seams->sample_count);
    if (steps == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    double sum = 0.0, length = 0.0;
    for (uint32_t i = 0; i < seams->sample_count; i++) {
        double d[3];
        alpi_seams_difference(lightmap, seams, i, pages, d);
        const double difference = (fabs(d[0]) + fabs(d[1]) + fabs(d[2])) / 3.0;
        steps[i] = (step){(float)difference, seams->lengths[i]};
        sum += difference * (double)seams->lengths[i];
        length += (double)seams->lengths[i];
    }
    qsort(steps, seams->sample_count, sizeof *steps, compare_steps);
    double below = 0.0;
    for (uint32_t i = 0; i < seams->sample_count && below < 0.99 * length; i++) {
        below += (double)steps[i].length;
        error->p99 = (double)steps[i].difference;
    }
    error->mean = length > 0.0 ? sum / length : 0.0;
    alpi_release(seams->context, steps);
    return ALP_OK;
}

double alpi_seams_map_mean(const alp_lightmap *lightmap, float *const *pages)
{
    const alpi_texels *t = &lightmap->texels;
    double sum = 0.0, area = 0.0;
    for (uint32_t i = 0; i < t->count; i++) {
        if (lightmap->states[i] == ALPI_TEXEL_OPEN) {
            continue;
        }
        const size_t at = (size_t)t->pixels[i][1] * lightmap->width + t->pixels[i][0];
        const float *value = pages[t->pages[i]] + 4 * at;
        const double mean = ((double)value[0] + (double)value[1] + (double)value[2]) / 3.0;
        sum += (double)alpi_texels_area(t, i) * mean;
        area += (double)alpi_texels_area(t, i);
    }
    return area > 0.0 ? sum / area : 0.0;
}
