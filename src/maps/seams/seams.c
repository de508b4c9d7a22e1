// SPDX-License-Identifier: MIT
#include "maps/seams/seams.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/lookup.h"
#include "maps/seams/seam_edges.h"

#include <math.h>
#include <stdlib.h>

enum { SAMPLES_PER_TEXEL = 2, SAMPLES_PER_TICK = 1 << 12 };

// --- samples -------------------------------------------------------------------------------------

typedef struct builder {
    const alp_lightmap *lightmap;
    alpi_seams *seams;
    uint32_t *places; // [pixels of all pages] place in seams->pixels + 1; 0: none yet
    size_t sample_room, first_room, span_room, texel_room, weight_room, pixel_room;
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

static alp_result add_sample(builder *b, const alpi_seam_pair *pair, double share,
                             const float sizes[2])
{
    alpi_seams *s = b->seams;
    const alp_lightmap *l = b->lightmap;
    alpi_lookup sides[2];
    vec3 normals[2];
    for (int i = 0; i < 2; i++) {
        double at[2];
        const uint32_t triangle = pair->edges[i].half_edge / 3;
        point_on_edge(&pair->edges[i], pair->begins[i] + share * (pair->ends[i] - pair->begins[i]),
                      at);
        normals[i] = normal_at(l->scene, triangle, at);
        alpi_lookup_at(l, triangle, at[0], at[1], &sides[i]);
    }
    if (!((double)vec3_dot(normals[0], normals[1]) >= ALPI_SEAM_COSINE)) {
        return ALP_OK;
    }
    const uint32_t sample = s->sample_count;
    ALP_TRY(alpi_grow(s->context, (void **)&s->first, &b->first_room, (size_t)sample + 2,
                      sizeof *s->first));
    ALP_TRY(alpi_grow(s->context, (void **)&s->lengths, &b->sample_room, (size_t)sample + 1,
                      sizeof *s->lengths));
    ALP_TRY(alpi_grow(s->context, (void **)&s->spans, &b->span_room, (size_t)sample + 1,
                      sizeof *s->spans));
    const uint32_t begin = s->first[sample];
    s->first[sample + 1] = begin;
    if (begin > UINT32_MAX - 2 * ALPI_LOOKUP_LIMIT) {
        return alpi_fail(s->context, ALP_ERROR_LIMIT,
                         "%s: the samples along its seams are more than 2^32; use fewer texels",
                         l->scene->name);
    }
    ALP_TRY(add_side(b, begin, &sides[0], 1.0));
    ALP_TRY(add_side(b, begin, &sides[1], -1.0));
    if (!is_idle(s, begin, s->first[sample + 1])) {
        s->lengths[sample] = sizes[0];
        s->spans[sample] = sizes[1];
        s->length += (double)sizes[0];
        s->sample_count++;
    }
    return ALP_OK;
}

static alp_result add_pair(void *user, const alpi_seam_pair *pair)
{
    builder *b = user;
    const uint32_t before = b->seams->sample_count;
    const double texel = (double)fminf(pair->edges[0].texel, pair->edges[1].texel);
    const double texels = pair->length / texel;
    const double rounding = 1e-3, most = 1 << 20; // no page is as wide
    const uint32_t count =
        (uint32_t)fmin(fmax(ceil(SAMPLES_PER_TEXEL * texels - rounding), 1.0), most);
    const float sizes[2] = {(float)(pair->length / count), (float)(texels / count)};
    for (uint32_t i = 0; i < count; i++) {
        if (i % SAMPLES_PER_TICK == SAMPLES_PER_TICK - 1) {
            ALP_TRY(alpi_tick(b->seams->context, "seams", 0, 1));
        }
        ALP_TRY(add_sample(b, pair, (i + 0.5) / count, sizes));
    }
    b->seams->count += b->seams->sample_count > before ? 1 : 0;
    return ALP_OK;
}

/// Which texels of the footprints have a value of their own.
static alp_result find_owners(const builder *b)
{
    const alp_lightmap *l = b->lightmap;
    alpi_seams *s = b->seams;
    const size_t page_size = (size_t)l->width * l->height;
    ALPI_TRY_NEW(s->context, s->owners, s->pixel_count);
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        s->owners[i] = ALPI_NONE;
    }
    for (uint32_t t = 0; t < l->texels.count; t++) {
        const uint16_t *pixel = l->texels.pixels[t];
        const uint32_t place =
            b->places[l->texels.pages[t] * page_size + (size_t)pixel[1] * l->width + pixel[0]];
        if (place > 0 && l->states[t] != ALPI_TEXEL_OPEN) {
            s->owners[place - 1] = t;
        }
    }
    return ALP_OK;
}

static alp_result build(builder *b)
{
    const alp_lightmap *l = b->lightmap;
    alpi_seam_edges edges;
    ALP_TRY(alpi_seam_edges_create(l, &edges));
    b->places = ALPI_NEW(l->context, uint32_t, (size_t)l->page_count * l->height * l->width);
    alp_result result = b->places != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    if (result == ALP_OK) {
        result = alpi_grow(l->context, (void **)&b->seams->first, &b->first_room, 1,
                           sizeof *b->seams->first);
    }
    if (result == ALP_OK) {
        result = alpi_seam_pairs_visit(l->scene, &edges, add_pair, b);
    }
    if (result == ALP_OK) {
        result = find_owners(b);
    }
    alpi_release(l->context, b->places);
    alpi_seam_edges_destroy(&edges);
    return result;
}

alp_result alpi_seams_create(const alp_lightmap *lightmap, alpi_seams *seams)
{
    *seams = (alpi_seams){.context = lightmap->context};
    builder b = {.lightmap = lightmap, .seams = seams};
    const alp_result result = build(&b);
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
