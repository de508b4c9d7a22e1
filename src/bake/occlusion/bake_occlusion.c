// SPDX-License-Identifier: MIT
// The stage of occlusion: gathers the objects one by one, joins their errors, finds the mean, and
// fills the report.
#include "bake/bake_stages.h"

#include "bake/gathering.h"
#include "bake/occlusion/occlusion_rounds.h"
#include "bake/settings.h"
#include "base/memory.h"
#include "base/tiles/tiles.h"
#include "maps/texels/relative_error.h"

#include <math.h>
#include <stdio.h>

// --- objects -------------------------------------------------------------------------------------

static alp_result trace_object(alpi_bake_job *job, const alpi_object *object,
                               const alpi_task_progress *progress, alpi_occlusion_report *report)
{
    alpi_gathering *g = &job->gathering;
    const alp_sampling_options *s = &job->options.sampling;
    ALP_TRY(alpi_gathering_open_object(job, object, progress));
    const alpi_receivers receivers = alpi_texels_receivers(&job->lightmap->texels);
    const alpi_occlusion_task task = {.setup = &g->setup,
                                      .receivers = &receivers,
                                      .order = object->valid,
                                      .count = object->valid_count,
                                      .proximity = g->validity.proximity,
                                      .lattice = &g->lattice,
                                      .errors = job->lightmap->errors,
                                      .bent = job->bent,
                                      .scratch = &g->scratch,
                                      .accuracy = s->accuracy,
                                      .error = s->error,
                                      .deadline = alpi_gathering_deadline(job),
                                      .keep_partial = s->keep_partial,
                                      .progress = progress->callback,
                                      .progress_user = progress->user};
    return alpi_occlusion_rounds(&task, report);
}

static void add_to_report(alp_bake_report *all, const alpi_occlusion_report *one)
{
    all->rays += one->rays;
    all->traced += one->traced;
    all->interpolated += one->interpolated;
    all->unknown += one->unknown;
    all->ao_samples = one->samples > all->ao_samples ? one->samples : all->ao_samples;
    all->ao_relative_error = one->relative;
    all->ao_p99_error = one->p99;
    all->cut_off = all->cut_off || one->cut_off;
}

/// Traces an object, unless one before it was cut off. An object that is cut off before its first
/// round stays unknown where others have values.
static alp_result add_object(alpi_bake_job *job, alpi_object *object,
                             const alpi_task_progress *progress)
{
    alp_bake_report *all = &job->report;
    alpi_occlusion_report one = {.unknown = object->texel_count};
    if (!all->cut_off) {
        const alp_result result = trace_object(job, object, progress, &one);
        const bool by_user = result == ALP_ERROR_CANCELLED && job->options.sampling.keep_partial;
        const bool by_clock = result == ALP_ERROR_LIMIT && one.cut_off; // not another limit
        if ((by_user || by_clock) && all->traced > 0) {
            one = (alpi_occlusion_report){.unknown = object->texel_count, .cut_off = true};
        } else {
            ALP_TRY(result);
        }
    }
    object->samples = one.samples;
    add_to_report(all, &one);
    return ALP_OK;
}

/// Finds the stated error of all objects together.
static alp_result join_errors(alpi_bake_job *job, const alpi_task_progress *progress)
{
    const alpi_lattice *l = &job->gathering.lattice;
    alpi_relative_error relative = {.rms = (double)NAN, .p99 = (double)NAN};
    if (!job->report.cut_off) { // else an object without its first round has no error
        ALP_TRY(alpi_find_relative_error(l, job->lightmap->errors, l->order, l->texels->count,
                                         progress, &relative));
    }
    job->report.ao_relative_error = relative.rms;
    job->report.ao_p99_error = relative.p99;
    return ALP_OK;
}

// --- the report ----------------------------------------------------------------------------------

static void sum_areas(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const alpi_lattice *l = user;
    for (uint32_t i = begin; i < end; i++) {
        if (l->states[i] != ALPI_TEXEL_OPEN) {
            sums[0] += (double)alpi_texels_area(l->texels, i) * (double)l->values[i];
            sums[1] += (double)alpi_texels_area(l->texels, i);
        }
    }
}

/// Mean over the surface: each texel of known value counts by its area.
static alp_result find_area_mean(const alpi_lattice *lattice, double *mean)
{
    double sums[ALPI_SUM_LIMIT];
    ALP_TRY(alpi_parallel_sum(lattice->context, lattice->texels->count, sum_areas, lattice, NULL,
                              sums));
    *mean = sums[1] > 0.0 ? sums[0] / sums[1] : 0.0;
    return ALP_OK;
}

static void warn_of_error(const alpi_bake_job *job)
{
    const alp_bake_report *r = &job->report;
    const double wanted = (double)job->options.sampling.error;
    char error[32] = "unknown";
    if (isfinite(r->ao_relative_error)) {
        snprintf(error, sizeof error, "%.2g %%", 100.0 * r->ao_relative_error);
    }
    if (r->cut_off) {
        alpi_warn(job->context, "cut-off", job->scene->name,
                  "sampling was cut off after a round of %u rays per texel; the error is %s, %llu "
                  "texels have no value of their own, and another run gives other bits",
                  r->ao_samples, error, (unsigned long long)r->unknown);
    } else if (wanted > 0.0 && r->ao_relative_error > wanted) {
        alpi_warn(job->context, "error-not-reached", job->scene->name,
                  "the stated error is %.2g %% after %u rays per texel, wanted %.2g %%; allow more "
                  "rays (--ao-samples)",
                  100.0 * r->ao_relative_error, r->ao_samples, 100.0 * wanted);
    }
}

// --- the stage -----------------------------------------------------------------------------------

alp_result alpi_bake_occlusion(alpi_bake_job *job)
{
    const uint32_t texels = job->lightmap->texels.count;
    const alpi_object_stage stage = {.name = "occlusion",
                                     .rays = (uint64_t)texels * job->options.occlusion.samples,
                                     .each = add_object,
                                     .join = join_errors};
    if (!alpi_bake_wants_occlusion(&job->options)) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(job->context, job->lightmap->errors, texels);
    if ((job->options.maps & ALP_MAP_BENT) != 0) {
        ALPI_TRY_NEW(job->context, job->bent, texels);
    }
    ALP_TRY(alpi_gathering_run(job, &stage));
    if (alpi_tiles_are_shards(job->context)) {
        return ALP_OK;
    }
    ALP_TRY(find_area_mean(&job->gathering.lattice, &job->report.ao_mean));
    alpi_bake_warn_of_darkness(job);
    warn_of_error(job);
    return ALP_OK;
}
