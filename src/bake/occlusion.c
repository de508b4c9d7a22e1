// SPDX-License-Identifier: MIT
// The occlusion stage of a bake: tracer → map → lightmap, and what the report says of it.
#include "bake/job.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/occlusion_map.h"
#include "maps/validity.h"

#include <math.h>

/// Mean over the surface: each texel of known value counts by its area.
static double area_mean(const alpi_texels *texels, const alpi_lattice *lattice)
{
    double sum = 0.0, area = 0.0;
    for (uint32_t i = 0; i < texels->count; i++) {
        if (lattice->states[i] != ALPI_TEXEL_OPEN) {
            sum += (double)texels->areas[i] * (double)lattice->values[i];
            area += (double)texels->areas[i];
        }
    }
    return area > 0.0 ? sum / area : 0.0;
}

void alpi_bake_warn_of_darkness(const alpi_bake_job *job)
{
    if (job->report.ao_mean < 0.05) {
        bool limited = isfinite(job->report.ao_distance);
        alpi_warn(job->context, "dark", job->scene->name, "the mean accessibility is %.1f %%: %s",
                  100.0 * job->report.ao_mean,
                  limited ? "nearly everything is closed within the distance limit; a shorter one "
                            "(--ao-distance) shows more"
                          : "a closed room is dark without a distance limit; give one "
                            "(--ao-distance auto, or metres)");
    }
}

static void warn_of_error(const alpi_bake_job *job)
{
    const alp_bake_report *r = &job->report;
    const double wanted = (double)job->options.sampling.error;
    if (r->cut_off) {
        alpi_warn(job->context, "cut-off", job->scene->name,
                  "sampling ended before its time at %u rays a texel; the stated error is %.2g %%, "
                  "%llu texels have no value of their own, and another run gives other bits",
                  r->ao_samples, 100.0 * r->ao_relative_error, (unsigned long long)r->unknown);
    } else if (wanted > 0.0 && r->ao_relative_error > wanted) {
        alpi_warn(job->context, "error-not-reached", job->scene->name,
                  "the stated error is %.2g %% after %u rays a texel, wanted %.2g %%; allow more "
                  "rays (--ao-samples)",
                  100.0 * r->ao_relative_error, r->ao_samples, 100.0 * wanted);
    }
}

static void fill_report(alpi_bake_job *job, const alpi_occlusion_map_report *map,
                        const alpi_lattice *lattice)
{
    alp_bake_report *r = &job->report;
    r->rays += map->rays;
    r->ao_samples = map->samples;
    r->traced = map->traced;
    r->interpolated = map->interpolated;
    r->unknown = map->unknown;
    r->ao_relative_error = map->relative;
    r->ao_p99_error = map->p99;
    r->cut_off = map->cut_off;
    r->ao_mean = area_mean(&job->lightmap->texels, lattice);
    alpi_bake_warn_of_darkness(job);
    warn_of_error(job);
}

/// Texels in an order without those that take their value from elsewhere. @return how many
static uint32_t drop(const alpi_lattice *lattice, uint32_t count, const uint8_t *dropped,
                     uint32_t *order)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t t = lattice->order[i];
        if (!dropped[t]) {
            order[kept++] = t;
        }
    }
    return kept;
}

/// Looks for texels inside other geometry, then gathers the others.
static alp_result gather_valid(alpi_bake_job *job, const alpi_occlusion_setup *setup,
                               const alpi_receivers *receivers, alpi_occlusion_map_options *options,
                               alpi_lattice *lattice)
{
    alpi_texels *texels = &job->lightmap->texels;
    const alpi_task_progress progress = {
        .callback = job->options.progress, .user = job->options.progress_user, .stage = "validity"};
    alpi_validity validity;
    ALP_TRY(alpi_validity_create(setup, receivers, texels, lattice, lattice->order, texels->count,
                                 &progress, &validity));
    job->report.rays += validity.rays;
    job->report.moved = validity.moved_count;
    job->report.dropped = validity.dropped_count;
    options->near = validity.near;
    uint32_t *order = ALPI_NEW(job->context, uint32_t, texels->count);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    alpi_occlusion_map_report report;
    if (order != NULL) {
        const uint32_t count = drop(lattice, texels->count, validity.dropped, order);
        result = alpi_occlusion_map(setup, receivers, order, count, options, lattice,
                                    job->lightmap->errors, &report);
        if (result == ALP_OK) {
            result = alpi_bake_obscurance(job, setup, receivers, order, count, report.samples);
        }
    }
    alpi_release(job->context, order);
    alpi_validity_destroy(&validity);
    if (result == ALP_OK) {
        fill_report(job, &report, lattice);
    }
    return result;
}

static alp_result gather(alpi_bake_job *job, const alpi_tracer *tracer, alpi_lattice *lattice)
{
    const alp_sampling_options *s = &job->options.sampling;
    const alpi_texels *texels = &job->lightmap->texels;
    const alpi_receivers receivers = alpi_texels_receivers(texels);
    alpi_occlusion_map_options options = {
        .accuracy = s->accuracy,
        .error = s->error,
        .deadline = s->time_limit > 0.0 ? alpi_seconds() + s->time_limit : HUGE_VAL,
        .keep_partial = s->keep_partial,
        .bent = job->bent,
        .progress = job->options.progress,
        .progress_user = job->options.progress_user,
    };
    alpi_occlusion_setup setup;
    ALP_TRY(alpi_occlusion_prepare(job->scene, tracer, &job->options.occlusion, &setup));
    setup.bent = job->bent != NULL;
    job->report.ao_distance = setup.distance;
    alp_result result = gather_valid(job, &setup, &receivers, &options, lattice);
    alpi_occlusion_release(&setup);
    return result;
}

static alp_result store(alpi_bake_job *job, alpi_lattice *lattice)
{
    alp_lightmap *l = job->lightmap;
    for (uint32_t i = 0; i < l->texels.count; i++) {
        l->states[i] = lattice->states[i];
    }
    if (job->options.existing_ao == ALP_EXISTING_AO_MULTIPLY) {
        alpi_bake_multiply_existing(job, lattice->values);
    }
    ALP_TRY(alpi_lightmap_store(l, lattice->values));
    return alpi_bake_store_side_maps(job);
}

alp_result alpi_bake_occlusion(alpi_bake_job *job)
{
    ALP_TRY(alpi_bake_begin_stage(job, "build"));
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(job->scene, job->options.progress, job->options.progress_user,
                                  &tracer, &job->report.seconds_build));
    const double started = alpi_seconds();
    alpi_lattice lattice;
    ALP_TRY(alpi_lattice_create(job->lightmap->atlas, &job->lightmap->texels, &lattice));
    alp_result result = alpi_bake_begin_side_maps(job);
    result = result == ALP_OK ? gather(job, tracer, &lattice) : result;
    job->report.seconds_bake = alpi_seconds() - started;
    if (result == ALP_OK && job->report.cut_off) {
        job->options.progress = NULL; // asked again it would cancel what it wanted kept
        alpi_set_watch(job->context, (alpi_watch){0});
    }
    if (result == ALP_OK) {
        result = store(job, &lattice);
    }
    alpi_bake_end_side_maps(job);
    alpi_lattice_destroy(&lattice);
    return result;
}
