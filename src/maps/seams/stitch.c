// SPDX-License-Identifier: MIT
#include "maps/seams/stitch.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/seams/jumps.h"

#include <math.h>
#include <string.h>

enum { STEP_LIMIT = 300, ROUNDS = 4 };
static const double RESIDUAL = 1e-6; // of the first: what is left is below what is stated
// Of texels with a value of their own, of gaps; and how much more than the mean errors may change.
static const double HOLD = 0.15, GAP_HOLD = 1e-4, HOLD_RANGE = 2.0;
static const double LEAST_AGREEMENT = 0.02; // of the faces inside a texel
static const double LEAST_ERROR = 0.002;    // of the mean: half of a step of eight bits

static float *pixel_of(const alp_lightmap *l, const alpi_seams *s, uint32_t i, float *const *pages)
{
    const size_t page_size = (size_t)l->width * l->height;
    return pages[s->pixels[i] / page_size] + 4 * (s->pixels[i] % page_size);
}

// --- how easily texels move ----------------------------------------------------------------------

static void find_errors(const alpi_stitch *stitch, const float *texel_errors,
                        float *const *error_pages)
{
    const alpi_seams *s = stitch->seams;
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        if (s->owners[i] == ALPI_NONE) {
            continue;
        }
        if (error_pages != NULL) {
            const float *e = pixel_of(stitch->lightmap, s, i, error_pages);
            stitch->errors[i] = sqrtf((e[0] * e[0] + e[1] * e[1] + e[2] * e[2]) / 3.0f);
        } else if (texel_errors != NULL) {
            stitch->errors[i] = texel_errors[s->owners[i]];
        }
    }
}

/// Mean of squared errors of the texels that have one.
static double find_variance(const alpi_stitch *stitch)
{
    const alpi_seams *s = stitch->seams;
    double sum = 0.0, count = 0.0;
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        if (s->owners[i] != ALPI_NONE) {
            sum += (double)stitch->errors[i] * (double)stitch->errors[i];
            count += 1.0;
        }
    }
    return count > 0.0 ? sum / count : 0.0;
}

/// How much the faces inside a texel agree on a normal, n the mean of theirs: 2 n² − 1, 1 where it
/// is flat and 0 where two halves stand at right angles.
static double find_agreement(const alp_lightmap *l, uint32_t texel)
{
    const alpi_texels *t = &l->texels;
    const vec3 none = {0.0f, 0.0f, 0.0f};
    vec3 mean = none;
    float begin = 0.0f;
    for (uint32_t i = t->piece_first[texel]; i < t->piece_first[texel + 1]; i++) {
        vec3 c[3];
        alpi_triangle_corners(l->scene, alpi_atlas_triangle(l->atlas, t->piece_triangles[i]), c);
        const vec3 normal = vec3_triangle_normal(c[0], c[1], c[2], none);
        mean = vec3_mad(mean, t->piece_ends[i] - begin, normal);
        begin = t->piece_ends[i];
    }
    const bool whole = t->piece_first[texel] == t->piece_first[texel + 1];
    return whole ? 1.0 : fmax(2.0 * (double)vec3_dot(mean, mean) - 1.0, LEAST_AGREEMENT);
}

static void find_holds(const alpi_stitch *stitch)
{
    const alpi_seams *s = stitch->seams;
    const double mean = find_variance(stitch);
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        double hold = GAP_HOLD;
        if (s->owners[i] != ALPI_NONE) {
            const double variance = (double)stitch->errors[i] * (double)stitch->errors[i];
            const double share = variance > 0.0 ? mean / variance : mean > 0.0 ? HOLD_RANGE : 1.0;
            hold = HOLD * (double)stitch->lightmap->texels.coverages[s->owners[i]] *
                   find_agreement(stitch->lightmap, s->owners[i]) *
                   fmin(fmax(share, 1.0 / HOLD_RANGE), HOLD_RANGE);
        }
        stitch->holds[i] = (float)hold;
    }
}

/// Copies the samples' lengths in texels; those of jumps become 0.
static alp_result find_spans(const alpi_stitch *stitch, float *const *pages)
{
    const alpi_seams *s = stitch->seams;
    uint8_t *jumps = ALPI_NEW(s->context, uint8_t, s->sample_count);
    alp_result result = jumps != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    if (result == ALP_OK) {
        result = alpi_jumps_find(stitch->lightmap, s, pages, stitch->errors,
                                 LEAST_ERROR * stitch->mean, jumps);
    }
    for (uint32_t i = 0; i < s->sample_count && result == ALP_OK; i++) {
        stitch->spans[i] = jumps[i] ? 0.0f : s->spans[i];
    }
    alpi_release(s->context, jumps);
    return result;
}

alp_result alpi_stitch_create(const alp_lightmap *lightmap, const alpi_seams *seams,
                              float *const *pages, const float *texel_errors,
                              float *const *error_pages, alpi_stitch *stitch)
{
    const double black = 1e-30; // nothing to agree on
    *stitch = (alpi_stitch){.lightmap = lightmap, .seams = seams};
    stitch->mean = fmax(alpi_seams_map_mean(lightmap, pages), black);
    stitch->errors = ALPI_NEW(seams->context, float, seams->pixel_count);
    stitch->holds = ALPI_NEW(seams->context, float, seams->pixel_count);
    stitch->spans = ALPI_NEW(seams->context, float, seams->sample_count);
    if (stitch->errors == NULL || stitch->holds == NULL || stitch->spans == NULL) {
        alpi_stitch_destroy(stitch);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    find_errors(stitch, texel_errors, error_pages);
    find_holds(stitch);
    const alp_result result = find_spans(stitch, pages);
    if (result != ALP_OK) {
        alpi_stitch_destroy(stitch);
    }
    return result;
}

void alpi_stitch_destroy(alpi_stitch *stitch)
{
    if (stitch->seams != NULL) {
        alpi_release(stitch->seams->context, stitch->errors);
        alpi_release(stitch->seams->context, stitch->holds);
        alpi_release(stitch->seams->context, stitch->spans);
    }
    *stitch = (alpi_stitch){0};
}

// --- the solution --------------------------------------------------------------------------------

/// One channel: changes of the texels, and what the method needs besides.
typedef struct solver {
    const alpi_stitch *stitch;
    double low, high;                                         // values stay within
    double *change, *residual, *direction, *image, *diagonal; // [pixel_count]
    uint8_t *bound; // [pixel_count] at an end of its range, and no unknown any more
} solver;

/// image = (Rᵀ L R + Λ) direction
static void apply_matrix(const solver *v)
{
    const alpi_seams *s = v->stitch->seams;
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        v->image[i] = (double)v->stitch->holds[i] * v->direction[i];
    }
    for (uint32_t i = 0; i < s->sample_count; i++) {
        double difference = 0.0;
        for (uint32_t k = s->first[i]; k < s->first[i + 1]; k++) {
            difference += (double)s->weights[k] * v->direction[s->texels[k]];
        }
        difference *= (double)v->stitch->spans[i];
        for (uint32_t k = s->first[i]; k < s->first[i + 1]; k++) {
            v->image[s->texels[k]] += (double)s->weights[k] * difference;
        }
    }
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        v->image[i] = v->bound[i] ? 0.0 : v->image[i];
    }
}

/// residual = −Rᵀ L R (x⁰ + change) − Λ change, and the diagonal of the matrix.
static void begin(const solver *v, float *const *pages, uint32_t channel)
{
    const alpi_seams *s = v->stitch->seams;
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        v->diagonal[i] = (double)v->stitch->holds[i];
        v->residual[i] = -(double)v->stitch->holds[i] * v->change[i];
    }
    for (uint32_t i = 0; i < s->sample_count; i++) {
        double d[3];
        alpi_seams_difference(v->stitch->lightmap, s, i, pages, d);
        for (uint32_t k = s->first[i]; k < s->first[i + 1]; k++) {
            d[channel] += (double)s->weights[k] * v->change[s->texels[k]];
        }
        const double span = (double)v->stitch->spans[i];
        for (uint32_t k = s->first[i]; k < s->first[i + 1]; k++) {
            const double weight = (double)s->weights[k];
            v->residual[s->texels[k]] -= span * weight * d[channel];
            v->diagonal[s->texels[k]] += span * weight * weight;
        }
    }
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        v->residual[i] = v->bound[i] ? 0.0 : v->residual[i];
    }
}

/// Stops texels that left their range at its end. @return whether there are any more of them
static bool stop_at_ends(const solver *v, float *const *pages, uint32_t channel)
{
    bool any = false;
    for (uint32_t i = 0; i < v->stitch->seams->pixel_count; i++) {
        const double old =
            (double)pixel_of(v->stitch->lightmap, v->stitch->seams, i, pages)[channel];
        const double low = v->low - old, high = v->high - old;
        if (!v->bound[i] && (v->change[i] < low || v->change[i] > high)) {
            v->change[i] = fmin(fmax(v->change[i], low), high);
            v->bound[i] = 1;
            any = true;
        }
    }
    return any;
}

/// Gives residual · (residual / diagonal).
static double find_norm(const solver *v)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < v->stitch->seams->pixel_count; i++) {
        sum += v->residual[i] * v->residual[i] / v->diagonal[i];
    }
    return sum;
}

/// direction = residual / diagonal + share · direction.
static void turn(const solver *v, double share)
{
    for (uint32_t i = 0; i < v->stitch->seams->pixel_count; i++) {
        v->direction[i] = v->residual[i] / v->diagonal[i] + share * v->direction[i];
    }
}

static alp_result iterate(const solver *v)
{
    const uint32_t count = v->stitch->seams->pixel_count;
    double norm = find_norm(v);
    const double enough = RESIDUAL * RESIDUAL * norm;
    turn(v, 0.0);
    for (int step = 0; step < STEP_LIMIT && norm > enough; step++) {
        if (!alpi_loop_goes_on(v->stitch->seams->context)) {
            return ALP_ERROR_CANCELLED;
        }
        apply_matrix(v);
        double curvature = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            curvature += v->direction[i] * v->image[i];
        }
        if (!(curvature > 0.0)) { // below what doubles hold
            break;
        }
        const double length = norm / curvature;
        for (uint32_t i = 0; i < count; i++) {
            v->change[i] += length * v->direction[i];
            v->residual[i] -= length * v->image[i];
        }
        const double next = find_norm(v);
        turn(v, next / norm);
        norm = next;
    }
    return ALP_OK;
}

static void release(const solver *v)
{
    alp_context *context = v->stitch->seams->context;
    alpi_release(context, v->change);
    alpi_release(context, v->residual);
    alpi_release(context, v->direction);
    alpi_release(context, v->image);
    alpi_release(context, v->diagonal);
    alpi_release(context, v->bound);
}

static alp_result reserve(solver *v)
{
    const alpi_seams *s = v->stitch->seams;
    ALPI_TRY_NEW(s->context, v->change, s->pixel_count);
    ALPI_TRY_NEW(s->context, v->residual, s->pixel_count);
    ALPI_TRY_NEW(s->context, v->direction, s->pixel_count);
    ALPI_TRY_NEW(s->context, v->image, s->pixel_count);
    ALPI_TRY_NEW(s->context, v->diagonal, s->pixel_count);
    ALPI_TRY_NEW(s->context, v->bound, s->pixel_count);
    return ALP_OK;
}

/// What is allowed, and not more than covered texels have at seams: those of gaps shall not become
/// brighter than anything is.
static void find_range(solver *v, const alpi_stitch_options *o, float *const *pages,
                       uint32_t channel)
{
    const alpi_seams *s = v->stitch->seams;
    double high = -HUGE_VAL;
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        if (s->owners[i] != ALPI_NONE && !o->part) {
            high = fmax(high, (double)pixel_of(v->stitch->lightmap, s, i, pages)[channel]);
        }
    }
    v->low = (double)o->low;
    v->high = high > v->low ? fmin(high, (double)o->high) : (double)o->high;
}

typedef struct channels_job {
    solver solvers[3];
    float *const *pages;
} channels_job;

static alp_result solve(void *user, uint32_t first, uint32_t end, uint32_t worker)
{
    (void)worker;
    const channels_job *job = user;
    alp_result result = ALP_OK;
    for (uint32_t k = first; k < end && result == ALP_OK; k++) {
        const solver *v = &job->solvers[k];
        bool more = true;
        for (int round = 0; round < ROUNDS && more && result == ALP_OK; round++) {
            begin(v, job->pages, k);
            result = iterate(v);
            more = stop_at_ends(v, job->pages, k);
        }
    }
    return result;
}

// --- what becomes of the map ---------------------------------------------------------------------

/// The new value of a pixel.
static void move(const channels_job *job, const alpi_stitch_options *o, uint32_t i,
                 const float *pixel, float moved[3])
{
    for (uint32_t k = 0; k < 3; k++) {
        const solver *v = &job->solvers[k < o->channels ? k : 0];
        const float old = pixel[k < o->channels ? k : 0];
        moved[k] = (float)fmin(fmax((double)old + v->change[i], v->low), v->high);
    }
    if (o->unit) {
        const vec3 unit = vec3_normalize_or(vec3_load(moved), vec3_load(pixel));
        vec3_store(moved, unit);
    }
}

static void store(const alpi_stitch *stitch, const channels_job *job, const alpi_stitch_options *o,
                  float **pages, alpi_stitch_change *change)
{
    const alpi_seams *s = stitch->seams;
    double squares = 0.0, largest = 0.0, count = 0.0;
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        float *pixel = pixel_of(stitch->lightmap, s, i, pages), moved[3];
        double most = 0.0;
        for (uint32_t k = 0; k < o->channels; k++) {
            most = fmax(most, fabs(job->solvers[k].change[i]));
        }
        if (!(most > 0.0)) {
            continue; // its bits stay
        }
        move(job, o, i, pixel, moved);
        if (s->owners[i] != ALPI_NONE) {
            const double error = fmax((double)stitch->errors[i], LEAST_ERROR * stitch->mean);
            double square = 0.0;
            for (int k = 0; k < 3; k++) {
                const double d = ((double)moved[k] - (double)pixel[k]) / error;
                square += d * d / 3.0;
            }
            squares += square;
            largest = fmax(largest, sqrt(square));
            count += 1.0;
        }
        memcpy(pixel, moved, sizeof moved);
    }
    if (change != NULL) {
        *change = (alpi_stitch_change){count > 0.0 ? sqrt(squares / count) : 0.0, largest};
    }
}

alp_result alpi_stitch_apply(const alpi_stitch *stitch, const alpi_stitch_options *options,
                             float **pages, alpi_stitch_change *change)
{
    alp_context *context = stitch->seams->context;
    channels_job job = {.pages = pages};
    alp_result result = ALP_OK;
    for (uint32_t k = 0; k < options->channels; k++) {
        job.solvers[k].stitch = stitch;
    }
    for (uint32_t k = 0; k < options->channels && result == ALP_OK; k++) {
        find_range(&job.solvers[k], options, pages, k);
        result = reserve(&job.solvers[k]);
    }
    const alpi_watch *watch = alpi_context_watch(context);
    const alpi_task_progress progress = {
        .callback = watch->callback, .user = watch->user, .stage = "seams"};
    if (result == ALP_OK) {
        result = alpi_parallel_for(context, options->channels, 1, solve, &job, &progress);
    }
    if (result == ALP_OK) {
        store(stitch, &job, options, pages, change);
    }
    for (uint32_t k = 0; k < options->channels; k++) {
        release(&job.solvers[k]);
    }
    return result;
}
