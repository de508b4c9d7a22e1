// SPDX-License-Identifier: MIT
#include "bake/light/light_error.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <string.h>

enum { TEXELS_PER_RANGE = 4096 };

/// Noise of the solution over the mean light, times √rays of a patch. Measured over other seeds of
/// the patches alone, with 32 rays, for the texels of the truth table: cornell .32 %, windows .23
/// %, teapot-room .19 %, atrium .61 %, zdm2 .22 %, living_room .04 %. This states .28 %.
static const double SOLVED_NOISE = 0.016;
/// The most of it, over bounced light: that of the atrium.
static const double MOST_OF_BOUNCED = 0.16;

static double sum_variances(const alpi_reference_value *v)
{
    return (double)v->variance[0] + (double)v->variance[1] + (double)v->variance[2];
}

static double sum_means(const alpi_reference_value *v)
{
    return (double)v->mean[0] + (double)v->mean[1] + (double)v->mean[2];
}

// --- the scale -----------------------------------------------------------------------------------

static void sum_emission(const void *user, uint32_t begin, uint32_t end,
                         double sums[ALPI_SUM_LIMIT])
{
    const alpi_light_bake *light = user;
    const alp_scene *scene = light->job->scene;
    const alpi_texels *texels = light->lattice->texels;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = light->order[i], triangle = texels->triangles[t];
        const float *b = texels->barycentrics[t];
        vec3 c[3];
        alpi_triangle_corners(scene, triangle, c);
        const vec3 up = {0.0f, 1.0f, 0.0f};
        const vec3 emission = alpi_surface_emission(scene, triangle, b[0], b[1],
                                                    vec3_triangle_normal(c[0], c[1], c[2], up));
        sums[0] += (double)vec3_dot(emission, emission);
    }
}

alp_result alpi_light_find_emission(alpi_light_bake *light)
{
    double sums[ALPI_SUM_LIMIT] = {0.0};
    ALP_TRY(alpi_parallel_sum(light->job->context, light->count, sum_emission, light, NULL, sums));
    light->emitted = ALPI_PI * sqrt(sums[0] / (3.0 * fmax((double)light->count, 1.0)));
    return ALP_OK;
}

// --- the stated error ----------------------------------------------------------------------------

typedef struct error_job {
    const alpi_reference_value *values;
    const uint32_t *order;
    float *errors; // [texels] out
} error_job;

/// Sums means and variances of the channels.
static void sum_errors(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const error_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const alpi_reference_value *v = &job->values[job->order[i]];
        const double square = sum_variances(v);
        sums[0] += sum_means(v);
        sums[1] += square;
        job->errors[job->order[i]] = (float)sqrt(square / 3.0);
    }
}

alp_result alpi_light_find_error(const alpi_light_bake *light, const alpi_reference_value *values,
                                 alpi_light_error *error)
{
    alp_context *context = light->job->context;
    double sums[ALPI_SUM_LIMIT] = {0.0}, p99 = 0.0;
    const error_job job = {values, light->order, ALPI_NEW(context, float, light->receivers->count)};
    if (job.errors == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = alpi_parallel_sum(context, light->count, sum_errors, &job, NULL, sums);
    if (result == ALP_OK) {
        result = alpi_percentile(context, job.errors, light->order, light->count, 0.99, &p99);
    }
    alpi_release(context, job.errors);
    const double all = 3.0 * fmax((double)light->count, 1.0), mean = sums[0] / all;
    const double scale = alpi_light_scale(light, mean);
    *error = (alpi_light_error){mean, scale, {(double)NAN, (double)NAN}};
    if (scale > 0.0) {
        error->over_scale.rms = sqrt(sums[1] / all) / scale;
        error->over_scale.p99 = p99 / scale;
    }
    return result;
}

// --- the solution --------------------------------------------------------------------------------

double alpi_light_solved_error(const alpi_radiosity *solution, double mean, double bounced,
                               double noise)
{
    const alpi_radiosity_options *o = &solution->options;
    const bool reads_patches =
        o->bounces > 1 || o->direct != o->lighting; // else direct light alone
    return reads_patches && mean > 0.0
               ? fmin(SOLVED_NOISE, MOST_OF_BOUNCED * bounced / mean) * noise
               : 0.0;
}

double alpi_light_solved_share(const alpi_light_rounds *r)
{
    const alpi_light_errors *e = &r->errors;
    return e->bounced_rms > 0.0 ? e->solved * e->map_scale / e->bounced_rms : 0.0;
}

// --- both kinds of light -------------------------------------------------------------------------

typedef struct join_job {
    const alpi_light_bake *light;
    const alpi_reference_value *direct; // NULL: neither that nor the sky's
    const float (*skies)[3];
    double share;
    alpi_reference_value *whole;
} join_job;

static alp_result join_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const join_job *j = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = j->light->order[i];
        alpi_reference_value v = j->light->values[t];
        for (int k = 0; k < 3; k++) {
            const float sky = j->skies != NULL ? j->skies[t][k] : 0.0f, bounced = v.mean[k] - sky;
            const double solved = j->share * (double)bounced;
            v.variance[k] += (float)(solved * solved);
            v.mean[k] = bounced + (j->direct != NULL ? j->direct[t].mean[k] + sky : 0.0f);
            v.variance[k] += j->direct != NULL ? j->direct[t].variance[k] : 0.0f;
        }
        j->whole[t] = v;
    }
    return ALP_OK;
}

alp_result alpi_light_join(const alpi_light_bake *light, const alpi_radiosity *solution,
                           const float (*skies)[3], double share, alpi_reference_value *whole)
{
    const bool direct = light->job->options.light.direct != ALP_DIRECT_OFF;
    join_job job = {light, direct ? solution->direct : NULL, skies, share, whole};
    return alpi_parallel_for(light->job->context, light->count, TEXELS_PER_RANGE, join_range, &job,
                             NULL);
}

// --- rounds --------------------------------------------------------------------------------------

typedef struct some_texels {
    const alpi_light_rounds *rounds;
    const uint32_t *list;
} some_texels;

static void sum_direct(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const some_texels *some = user;
    for (uint32_t i = begin; i < end; i++) {
        const alpi_reference_value *d = &some->rounds->solution->direct[some->list[i]];
        for (int k = 0; k < 3; k++) {
            sums[0] += (double)d->mean[k];
            sums[1] += (double)d->variance[k];
        }
    }
}

static void sum_bounced(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const some_texels *some = user;
    const alpi_light_rounds *r = some->rounds;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t t = some->list[i];
        const alpi_reference_value *b = &r->light->values[t];
        for (int k = 0; k < 3; k++) {
            const double bounced =
                (double)b->mean[k] - (r->skies != NULL ? (double)r->skies[t][k] : 0.0);
            sums[0] += (double)b->mean[k];
            sums[1] += (double)b->variance[k];
            sums[2] += bounced * bounced;
            sums[3] += bounced;
        }
    }
}

alp_result alpi_light_measure(alpi_light_rounds *r, const uint32_t *list, uint32_t count)
{
    const alpi_light_bake *light = r->light;
    alp_context *context = light->job->context;
    const some_texels all = {r, light->order}, known = {r, list};
    double d[ALPI_SUM_LIMIT] = {0.0}, b[ALPI_SUM_LIMIT] = {0.0};
    ALP_TRY(alpi_parallel_sum(context, light->count, sum_direct, &all, NULL, d));
    ALP_TRY(alpi_parallel_sum(context, count, sum_bounced, &known, NULL, b));
    for (int k = 0; k < 4; k++) {
        d[k] /= 3.0 * fmax((double)light->count, 1.0);
        b[k] /= 3.0 * fmax((double)count, 1.0);
    }
    const double mean = d[0] + b[0];
    const bool direct = light->job->options.light.direct != ALP_DIRECT_OFF;
    const double scale = alpi_light_scale(light, mean);
    const double map_scale = alpi_light_scale(light, direct ? mean : b[3]);
    const double solved = r->fixed == NULL ? alpi_light_solved_error(r->solution, mean, sqrt(b[2]),
                                                                     r->errors.solved_noise)
                                           : 0.0;
    r->errors = (alpi_light_errors){
        .scale = scale,
        .map_scale = map_scale,
        .direct = scale > 0.0 ? sqrt(d[1]) / scale : 0.0,
        .bounced = map_scale > 0.0 ? sqrt(b[1]) / map_scale : 0.0,
        .bounced_rms = sqrt(b[2]),
        .solved = map_scale > 0.0 ? solved * mean / map_scale : 0.0,
        .solved_noise = r->errors.solved_noise,
        .map = {.over_scale = {(double)NAN, (double)NAN}},
    };
    return ALP_OK;
}

alp_result alpi_light_measure_map(alpi_light_rounds *r)
{
    ALP_TRY(alpi_light_join(r->light, r->solution, (const float(*)[3])r->skies,
                            alpi_light_solved_share(r), r->fresh.values));
    return alpi_light_find_error(r->light, r->fresh.values, &r->errors.map);
}

// --- the worst texels ----------------------------------------------------------------------------

/// Squared error of a texel at the limit, channels summed.
static double square_at(const alpi_light_error *error, double limit)
{
    return 3.0 * pow(limit * error->scale, 2.0);
}

/// Share of it above which a texel gets more: half the limit.
static const double NOISY = 0.25;
/// Share of a texel's squared error above which its bounced light gets more rays.
static const double BOUNCED = 0.25;

double alpi_light_tail(const alpi_light_whole *whole, const alpi_light_error *error, double limit,
                       alpi_light_noise *noise)
{
    const double above = square_at(error, limit);
    double all = 0.0, direct = 0.0, bounced = 0.0;
    uint32_t noisy = 0;
    for (uint32_t i = 0; i < whole->count; i++) {
        const uint32_t t = whole->order[i];
        const double square = sum_variances(&whole->values[t]);
        noisy += square > NOISY * above ? 1u : 0u;
        if (square > above) {
            all += square;
            direct += whole->direct != NULL ? sum_variances(&whole->direct[t]) : 0.0;
            bounced += sum_variances(&whole->bounced[t]);
        }
    }
    *noise = (alpi_light_noise){.noisy = (double)noisy / fmax((double)whole->count, 1.0)};
    if (!(all > 0.0)) {
        return 0.0;
    }
    noise->direct = error->over_scale.p99 * sqrt(direct / all);
    noise->bounced = error->over_scale.p99 * sqrt(bounced / all);
    return error->over_scale.p99 * sqrt(fmax(all - direct - bounced, 0.0) / all);
}

void alpi_light_find_worst(const alpi_light_whole *whole, const alpi_light_error *error,
                           uint32_t texels, double limit, const uint8_t *interpolated,
                           alpi_light_worst *worst)
{
    const double above = square_at(error, limit);
    uint32_t beyond = 0, beyond_interpolated = 0;
    memset(worst->marks, 0, texels);
    worst->count = 0;
    for (uint32_t i = 0; i < whole->count; i++) {
        const uint32_t t = whole->order[i];
        const double square = sum_variances(&whole->values[t]);
        const bool bounced = sum_variances(&whole->bounced[t]) > BOUNCED * square;
        worst->marks[t] = square > NOISY * above;
        if (worst->marks[t] != 0 && bounced) {
            worst->list[worst->count] = t;
            worst->count += interpolated[t] == 0;
        }
        beyond += square > above && bounced;
        beyond_interpolated += square > above && bounced && interpolated[t] != 0;
    }
    if (2 * beyond_interpolated > beyond) {
        worst->count = 0;
    }
}

// --- warnings ------------------------------------------------------------------------------------

void alpi_light_warn(const alpi_bake_job *job, const alpi_relative_error *error, bool cut_off,
                     uint32_t rays, uint32_t direct)
{
    const double wanted = (double)job->options.light.error;
    const double stated = isfinite(error->rms) ? error->rms : 0.0; // in the dark there is none
    if (cut_off) {
        alpi_warn(job->context, "cut-off", job->scene->name,
                  "light was cut off after %u rays per texel and %u samples of each light; the "
                  "stated error is %.2g %%, and another run gives other bits",
                  rays, direct, 100.0 * stated);
    } else if (wanted > 0.0 && job->report.light_bounded &&
               (error->rms > wanted || error->p99 > ALPI_P99_LIMIT * wanted)) {
        alpi_note(job->context, "ray-limit", job->scene->name,
                  "light ended by the limit of rays of a bake without --error: the stated error is "
                  "%.2g %%, of the worst texel in a hundred %.2g %%; --error %g goes on",
                  100.0 * stated, 100.0 * error->p99, 100.0 * wanted);
    } else if (wanted > 0.0 && error->rms > wanted) {
        alpi_warn(job->context, "error-not-reached", job->scene->name,
                  "the stated error of the light is %.2g %% after %u rays per texel and %u "
                  "samples of each light, wanted %.2g %%",
                  100.0 * error->rms, rays, direct, 100.0 * wanted);
    } else if (wanted > 0.0 && error->p99 > ALPI_P99_LIMIT * wanted) {
        alpi_warn(
            job->context, "error-not-reached", job->scene->name,
            "the stated error of the light is %.2g %%, as wanted, but one texel in a hundred has"
            " more than %.2g %% after up to %u rays per texel and up to %u samples of each "
            "light, wanted at most %.2g %%",
            100.0 * error->rms, 100.0 * error->p99, rays, direct, 100.0 * ALPI_P99_LIMIT * wanted);
    }
}
