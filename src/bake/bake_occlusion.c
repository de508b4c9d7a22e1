// SPDX-License-Identifier: MIT
// The occlusion stage of a bake: tracer → map → lightmap, and what the report says of it.
#include "bake/objects.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/texels/occlusion_map.h"
#include "maps/texels/stated_error.h"
#include "maps/texels/validity.h"

#include <math.h>
#include <stdio.h>

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

void alpi_bake_warn_of_darkness(const alpi_bake_job *job)
{
    if (job->report.ao_mean < 0.05 && !job->report.cut_off) {
        bool limited = isfinite(job->report.ao_distance);
        alpi_warn(job->context, "dark", job->scene->name, "the mean accessibility is %.1f %%: %s",
                  100.0 * job->report.ao_mean,
                  limited ? "nearly everything is closed within the distance limit; a shorter one "
                            "(--ao-distance) shows more"
                          : "a closed room is dark without a distance limit; give one "
                            "(--ao-distance auto, or metres)");
    }
}

static void warn_of_error(const alpi_bake_job *job, bool cut_off)
{
    const alp_bake_report *r = &job->report;
    const double wanted = (double)job->options.sampling.error;
    char error[32] = "unknown";
    if (isfinite(r->ao_relative_error)) {
        snprintf(error, sizeof error, "%.2g %%", 100.0 * r->ao_relative_error);
    }
    if (cut_off) {
        alpi_warn(job->context, "cut-off", job->scene->name,
                  "sampling ended before its time, after a round of %u rays a texel; the error is "
                  "%s, %llu texels have no value of their own, and another run gives other bits",
                  r->ao_samples, error, (unsigned long long)r->unknown);
    } else if (wanted > 0.0 && r->ao_relative_error > wanted) {
        alpi_warn(job->context, "error-not-reached", job->scene->name,
                  "the stated error is %.2g %% after %u rays a texel, wanted %.2g %%; allow more "
                  "rays (--ao-samples)",
                  100.0 * r->ao_relative_error, r->ao_samples, 100.0 * wanted);
    }
}

static alp_result fill_report(alpi_bake_job *job, const alpi_occlusion_map_report *map,
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
    r->cut_off = r->cut_off || map->cut_off;
    ALP_TRY(find_area_mean(lattice, &r->ao_mean));
    if (alpi_bake_wants_occlusion(job)) {
        alpi_bake_warn_of_darkness(job);
        warn_of_error(job, map->cut_off);
    }
    return ALP_OK;
}

/// Options of the map that are the same for all objects.
static alpi_occlusion_map_options map_options(const alpi_bake_job *job)
{
    const alp_sampling_options *s = &job->options.sampling;
    const bool shared = (job->options.maps & ALP_MAP_LIGHT) != 0 && alpi_bake_wants_occlusion(job);
    const double time = shared ? 0.5 * s->time_limit : s->time_limit; // light has the rest
    return (alpi_occlusion_map_options){
        .accuracy = s->accuracy,
        .error = s->error,
        .deadline = time > 0.0 ? job->sampling_began + time : HUGE_VAL,
        .keep_partial = s->keep_partial,
        .bent = job->bent,
        .progress = job->options.progress,
        .progress_user = job->options.progress_user,
    };
}

/// Texels of an object without those that take their value from elsewhere.
static alp_result drop(const alpi_bake_job *job, const alpi_object *object, uint32_t *order,
                       uint32_t *kept)
{
    const uint32_t per_tick = 1u << 16;
    *kept = 0;
    for (uint32_t i = 0; i < object->texel_count; i++) {
        const uint32_t t = object->texels[i];
        if (!job->validity.dropped[t]) {
            order[(*kept)++] = t;
        }
        if (i % per_tick == per_tick - 1) {
            ALP_TRY(alpi_tick(job->context, "validity", i, object->texel_count));
        }
    }
    return ALP_OK;
}

/// Asks the user, and the clock.
static bool is_in_time(void *user, const alp_progress *progress)
{
    const alpi_occlusion_map_options *o = user;
    if (o->progress != NULL && !o->progress(o->progress_user, progress)) {
        return false;
    }
    return alpi_seconds() < o->deadline;
}

/// Every texel is open where nobody asks for occlusion. Said last: light may use the values' room.
static void skip_occlusion(const uint32_t *order, uint32_t count, alpi_lattice *lattice,
                           alpi_occlusion_map_report *report)
{
    for (uint32_t i = 0; i < count; i++) {
        lattice->states[order[i]] = ALPI_TEXEL_TRACED;
        lattice->values[order[i]] = 1.0f;
    }
    *report =
        (alpi_occlusion_map_report){.traced = count, .relative = (double)NAN, .p99 = (double)NAN};
}

/// Looks for texels of an object that are inside other geometry, then gathers the others.
static alp_result gather_valid(alpi_bake_job *job, const alpi_object *object,
                               const alpi_occlusion_setup *setup,
                               alpi_occlusion_map_options options, alpi_lattice *lattice,
                               alpi_occlusion_map_report *report)
{
    alpi_texels *texels = &job->lightmap->texels;
    alpi_validity *validity = &job->validity;
    job->stage = "validity";
    const alpi_receivers receivers = alpi_texels_receivers(texels);
    const alpi_task_progress progress = {
        .callback = options.progress, .user = options.progress_user, .stage = "validity"};
    const alpi_task_progress until = {
        .callback = is_in_time, .user = &options, .stage = progress.stage};
    const alp_result looked = alpi_validity_look(setup, &receivers, texels, lattice, object->texels,
                                                 object->texel_count, &until, validity);
    if (looked == ALP_ERROR_CANCELLED && alpi_seconds() >= options.deadline) {
        report->cut_off = true;
        return alpi_fail(job->context, ALP_ERROR_LIMIT,
                         "the time limit ended before any texel had a value; allow more time");
    }
    ALP_TRY(looked);
    job->report.rays += validity->rays;
    job->report.moved += validity->moved_count;
    job->report.dropped += validity->dropped_count;
    options.near = validity->near;
    options.scratch = &job->scratch;
    uint32_t *order = ALPI_NEW(job->context, uint32_t, object->texel_count);
    uint32_t count = 0;
    alp_result result = order != NULL ? drop(job, object, order, &count) : ALP_ERROR_OUT_OF_MEMORY;
    if (result == ALP_OK) {
        const bool wanted = alpi_bake_wants_occlusion(job);
        if (wanted) {
            job->stage = "occlusion";
            result = alpi_occlusion_map(setup, &receivers, order, count, &options, lattice,
                                        job->lightmap->errors, report);
        }
        if (result == ALP_OK) {
            result = alpi_bake_obscurance(job, setup, &receivers, order, count, report->samples,
                                          &progress);
        }
        if (result == ALP_OK) {
            result = alpi_bake_irradiance(job, setup->tracer, &receivers, order, count, lattice,
                                          &progress);
        }
        if (result == ALP_OK && !wanted) {
            skip_occlusion(order, count, lattice, report);
        }
    }
    alpi_release(job->context, order);
    return result;
}

/// Gathers the texels of one object: with the tracer of what occludes it, to its distance limit.
static alp_result gather_object(alpi_bake_job *job, alpi_objects *objects,
                                const alpi_object *object,
                                const alpi_occlusion_map_options *options, alpi_lattice *lattice,
                                alpi_occlusion_map_report *report)
{
    const double started = alpi_seconds();
    alpi_tracer *tracer = NULL, *owned = NULL;
    ALP_TRY(alpi_object_tracer(job, objects, object, options->progress, options->progress_user,
                               &tracer, &owned));
    const bool wanted = alpi_bake_wants_occlusion(job);
    bool quick = false;
    if (wanted) {
        const double rays = (double)object->texel_count * job->options.occlusion.samples;
        const alp_result quickened =
            alpi_tracer_quicken(tracer, rays, options->progress, options->progress_user, &quick);
        if (quickened != ALP_OK) {
            alpi_tracer_destroy(owned);
            return quickened;
        }
    }
    job->report.seconds_build += alpi_seconds() - started;
    alp_occlusion_options occlusion = job->options.occlusion;
    occlusion.distance = object->distance;
    occlusion.samples = wanted ? occlusion.samples : 1; // else a sequence that nobody reads
    alpi_occlusion_setup setup;
    alp_result result = alpi_occlusion_prepare(job->scene, tracer, &occlusion, &setup);
    if (result == ALP_OK) {
        setup.bent = job->bent != NULL;
        alpi_occlusion_be_quick(&setup, quick);
        job->report.ao_distance = fmaxf(job->report.ao_distance, setup.distance);
        result = gather_valid(job, object, &setup, *options, lattice, report);
    }
    alpi_occlusion_release(&setup);
    alpi_tracer_destroy(owned);
    return result;
}

static void add_report(alpi_occlusion_map_report *all, const alpi_occlusion_map_report *one)
{
    all->rays += one->rays;
    all->traced += one->traced;
    all->interpolated += one->interpolated;
    all->unknown += one->unknown;
    all->samples = one->samples > all->samples ? one->samples : all->samples;
    all->relative = one->relative;
    all->p99 = one->p99;
    all->cut_off = all->cut_off || one->cut_off;
}

/// The stated error of all objects together.
static alp_result join_errors(const alpi_bake_job *job, const alpi_lattice *lattice,
                              alpi_part_progress *part, alpi_occlusion_map_report *all)
{
    const alpi_task_progress progress = {
        .callback = alpi_tell_part, .user = part, .stage = part->stage};
    part->begin = part->end;
    all->relative = all->p99 = (double)NAN;
    if (all->cut_off) { // an object without its first round has no error
        return ALP_OK;
    }
    alpi_relative_error relative;
    ALP_TRY(alpi_find_relative_error(lattice, job->lightmap->errors, lattice->order,
                                     lattice->texels->count, &progress, &relative));
    all->relative = relative.rms;
    all->p99 = relative.p99;
    return ALP_OK;
}

/// Several objects, one after the other; told as one stage. After a cut-off the others stay
/// unknown.
static alp_result gather_parts(alpi_bake_job *job, alpi_objects *objects, alpi_lattice *lattice,
                               alpi_part_progress *part, alpi_occlusion_map_report *all)
{
    const double texels = (double)job->lightmap->texels.count;
    alpi_occlusion_map_options options = map_options(job);
    options.progress = alpi_tell_part;
    options.progress_user = part;
    for (uint32_t i = 0; i < objects->count; i++) {
        const alpi_object *object = &objects->items[i];
        alpi_occlusion_map_report one = {.unknown = object->texel_count};
        part->begin = part->end;
        part->end += (double)object->texel_count / texels;
        if (!all->cut_off) {
            alp_result result = gather_object(job, objects, object, &options, lattice, &one);
            const bool by_user =
                result == ALP_ERROR_CANCELLED && job->options.sampling.keep_partial;
            const bool by_clock = result == ALP_ERROR_LIMIT && one.cut_off; // not another limit
            const bool stopped = by_user || by_clock;
            if (stopped && all->traced > 0) { // before its rays: others have theirs
                one = (alpi_occlusion_map_report){.unknown = object->texel_count, .cut_off = true};
            } else {
                ALP_TRY(result);
            }
        }
        add_report(all, &one);
    }
    return join_errors(job, lattice, part, all);
}

static alp_result gather_apart(alpi_bake_job *job, alpi_objects *objects, alpi_lattice *lattice,
                               alpi_occlusion_map_report *all)
{
    const double texels = (double)job->lightmap->texels.count;
    alpi_part_progress part = {.callback = job->options.progress,
                               .user = job->options.progress_user,
                               .stage = "occlusion",
                               .started = alpi_seconds(),
                               .rays = (uint64_t)(texels * job->options.occlusion.samples)};
    const alpi_watch former =
        alpi_set_watch(job->context, (alpi_watch){.callback = alpi_tell_part, .user = &part});
    alp_result result = gather_parts(job, objects, lattice, &part, all);
    alpi_set_watch(job->context, former);
    return result;
}

/// Arrays that all objects share: with arrays of its own for all texels, each of many objects would
/// cost as much as the page.
static alp_result gather_all(alpi_bake_job *job, alpi_objects *objects, alpi_lattice *lattice,
                             alpi_occlusion_map_report *all)
{
    const uint32_t texels = job->lightmap->texels.count;
    const bool vectors = job->bent != NULL || job->obscurance != NULL;
    ALP_TRY(alpi_scratch_create(job->context, texels, vectors, &job->scratch));
    alp_result result = alpi_validity_open(job->context, texels, &job->scratch, &job->validity);
    if (result == ALP_OK && objects->count == 1) {
        const alpi_occlusion_map_options options = map_options(job);
        result = gather_object(job, objects, &objects->items[0], &options, lattice, all);
    } else if (result == ALP_OK) {
        result = gather_apart(job, objects, lattice, all);
    }
    alpi_validity_destroy(&job->validity);
    alpi_scratch_destroy(&job->scratch);
    return result;
}

static alp_result gather(alpi_bake_job *job, alpi_lattice *lattice)
{
    alpi_objects objects;
    alpi_occlusion_map_report all = {0};
    ALP_TRY(alpi_objects_create(job, lattice->order, &objects));
    alp_result result = gather_all(job, &objects, lattice, &all);
    alpi_objects_destroy(&objects);
    ALP_TRY(result);
    return fill_report(job, &all, lattice);
}

static alp_result store(alpi_bake_job *job, alpi_lattice *lattice)
{
    alp_lightmap *l = job->lightmap;
    job->stage = "dilation";
    for (uint32_t i = 0; i < l->texels.count; i++) {
        l->states[i] = lattice->states[i];
    }
    if (job->options.existing_ao == ALP_EXISTING_AO_MULTIPLY) {
        alpi_bake_multiply_existing(job, lattice->values);
    }
    ALP_TRY(alpi_bake_store_side_maps(job));
    return alpi_bake_wants_occlusion(job) ? alpi_lightmap_store(l, lattice->values) : ALP_OK;
}

alp_result alpi_bake_occlusion(alpi_bake_job *job)
{
    ALP_TRY(alpi_bake_begin_stage(job, "build"));
    const double started = alpi_seconds();
    job->sampling_began = started;
    alpi_lattice lattice;
    ALP_TRY(alpi_lattice_create(job->lightmap->atlas, &job->lightmap->texels, &lattice));
    alp_result result = alpi_bake_begin_side_maps(job);
    result = result == ALP_OK ? gather(job, &lattice) : result;
    job->report.seconds_bake = alpi_seconds() - started - job->report.seconds_build;
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
