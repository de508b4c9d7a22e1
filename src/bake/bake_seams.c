// SPDX-License-Identifier: MIT
// The stage that stitches: measures how far look-ups differ across the seams of the maps, and moves
// the values beside the seams.
#include "bake/bake_stages.h"

#include "bake/objects.h"
#include "base/tasks.h"
#include "maps/seams/stitch.h"

#include <math.h>

/// Reports all progress as that of one stage.
static bool tell_seams(void *user, const alp_progress *progress)
{
    const alpi_watch *watch = user;
    alp_progress told = *progress;
    told.stage = "seams";
    return watch->callback == NULL || watch->callback(watch->user, &told);
}

/// One map of the report.
typedef struct seam_map {
    float **pages; // NULL: there is none
    alp_seam_error *error;
} seam_map;

static alp_result measure(const alpi_bake_job *job, const alpi_seams *seams, const seam_map *map,
                          bool stitched)
{
    if (map->pages == NULL) {
        return ALP_OK;
    }
    alpi_seam_step step;
    ALP_TRY(alpi_seams_measure(job->lightmap, seams, map->pages, &step));
    const double mean = alpi_seams_map_mean(job->lightmap, map->pages);
    const double share = mean > 0.0 ? 1.0 / mean : (double)NAN;
    *(stitched ? &map->error->stitched_mean : &map->error->mean) = step.mean * share;
    *(stitched ? &map->error->stitched_p99 : &map->error->p99) = step.p99 * share;
    return ALP_OK;
}

static alp_result measure_all(alpi_bake_job *job, const alpi_seams *seams, bool stitched)
{
    const alp_lightmap *l = job->lightmap;
    alp_seam_report *r = &job->report.seams;
    const seam_map maps[] = {{l->pages, &r->ao},
                             {l->obscurance_pages, &r->obscurance},
                             {l->irradiance_pages, &r->light}};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        ALP_TRY(measure(job, seams, &maps[i], stitched));
    }
    return ALP_OK;
}

// --- stitching -----------------------------------------------------------------------------------

static const alpi_stitch_options of_shares = {.channels = 3, .low = 0.0f, .high = 1.0f},
                                 of_light = {.channels = 3, .low = 0.0f, .high = HUGE_VALF},
                                 of_parts = {.channels = 3,
                                             .low = 0.0f,
                                             .high = HUGE_VALF,
                                             .part = true},
                                 of_signed = {.channels = 3, .low = -HUGE_VALF, .high = HUGE_VALF},
                                 of_units = {
                                     .channels = 3, .low = -1.0f, .high = 1.0f, .unit = true};

static alp_result stitch_map(const alpi_stitch *stitch, const alpi_stitch_options *options,
                             float **pages, alp_seam_error *error)
{
    if (pages == NULL) {
        return ALP_OK;
    }
    alpi_stitch_change change;
    ALP_TRY(alpi_stitch_apply(stitch, options, pages, &change));
    if (error != NULL) {
        error->change_rms = change.rms;
        error->change_max = change.largest;
    }
    return ALP_OK;
}

static alp_result stitch_occlusion(alpi_bake_job *job, const alpi_seams *seams)
{
    const alp_lightmap *l = job->lightmap;
    if (l->pages == NULL) {
        return ALP_OK;
    }
    alpi_stitch stitch;
    ALP_TRY(alpi_stitch_create(l, seams, l->pages, l->errors, NULL, &stitch));
    alpi_stitch_options grey = of_shares;
    grey.channels = 1;
    alp_result result = stitch_map(&stitch, &grey, l->pages, &job->report.seams.ao);
    if (result == ALP_OK) {
        result = stitch_map(&stitch, &of_units, l->bent_pages, NULL);
    }
    alpi_stitch_destroy(&stitch);
    return result;
}

/// Coloured obscurance has no error of its own; it sends as many rays as occlusion.
static alp_result stitch_obscurance(alpi_bake_job *job, const alpi_seams *seams)
{
    const alp_lightmap *l = job->lightmap;
    if (l->obscurance_pages == NULL) {
        return ALP_OK;
    }
    alpi_stitch stitch;
    ALP_TRY(alpi_stitch_create(l, seams, l->obscurance_pages, l->errors, NULL, &stitch));
    const alp_result result =
        stitch_map(&stitch, &of_shares, l->obscurance_pages, &job->report.seams.obscurance);
    alpi_stitch_destroy(&stitch);
    return result;
}

/// Makes the parts of a sum add up to the stitched whole. All parts moved alike, unless one came to
/// an end of its range. The whole becomes their sum in their order.
static void add_up(float *const *parts, size_t count, float *whole)
{
    float sum = 0.0f, exact = 0.0f;
    for (size_t i = 0; i < count; i++) {
        sum += *parts[i];
    }
    if (!(sum > 0.0f)) { // all parts ended at zero
        sum = *parts[0] = *whole;
    }
    const float share = sum > 0.0f ? *whole / sum : 0.0f;
    for (size_t i = 0; i < count; i++) {
        *parts[i] *= share;
        exact += *parts[i];
    }
    *whole = exact;
}

/// Makes irradiance at a place the sum of its layers again, and of direct and bounced light.
static void add_up_light(const alp_lightmap *l, size_t page, size_t at)
{
    float *parts[ALPI_LAYER_LIMIT];
    for (size_t k = at; k < at + 3; k++) {
        float *whole = &l->irradiance_pages[page][k];
        for (uint32_t i = 0; i < l->layer_count; i++) {
            parts[i] = &l->layer_pages[i][page][k];
        }
        if (l->layer_count > 0) {
            add_up(parts, l->layer_count, whole);
        }
        if (l->direct_pages != NULL) {
            float copy = *whole; // within rounding
            parts[0] = &l->direct_pages[page][k];
            parts[1] = &l->bounced_pages[page][k];
            add_up(parts, 2, &copy);
        }
    }
}

static alp_result stitch_each(alpi_bake_job *job, const alpi_stitch *stitch)
{
    const alp_lightmap *l = job->lightmap;
    ALP_TRY(stitch_map(stitch, &of_light, l->irradiance_pages, &job->report.seams.light));
    ALP_TRY(stitch_map(stitch, &of_parts, l->direct_pages, NULL));
    ALP_TRY(stitch_map(stitch, &of_parts, l->bounced_pages, NULL));
    for (uint32_t i = 0; i < l->layer_count; i++) {
        ALP_TRY(stitch_map(stitch, &of_parts, l->layer_pages[i], NULL));
    }
    for (int i = 0; i < 4; i++) {
        ALP_TRY(stitch_map(stitch, &of_signed, l->sh_pages[i], NULL));
    }
    ALP_TRY(stitch_map(stitch, &of_units, l->direction_pages, NULL));
    const size_t page_size = (size_t)l->width * l->height;
    for (uint32_t i = 0; i < stitch->seams->pixel_count; i++) {
        const size_t at = stitch->seams->pixels[i];
        add_up_light(l, at / page_size, 4 * (at % page_size));
    }
    return ALP_OK;
}

/// Stitches all maps of light by one set of weights, so that they move alike.
static alp_result stitch_light(alpi_bake_job *job, const alpi_seams *seams)
{
    const alp_lightmap *l = job->lightmap;
    if (l->irradiance_pages == NULL) {
        return ALP_OK;
    }
    alpi_stitch stitch;
    ALP_TRY(alpi_stitch_create(l, seams, l->irradiance_pages, NULL, l->irradiance_error_pages,
                               &stitch));
    const alp_result result = stitch_each(job, &stitch);
    alpi_stitch_destroy(&stitch);
    return result;
}

// -------------------------------------------------------------------------------------------------

static alp_result measure_and_stitch(alpi_bake_job *job, const alpi_seams *seams)
{
    ALP_TRY(measure_all(job, seams, false));
    if (!job->options.stitch) {
        return ALP_OK;
    }
    job->report.seams.stitched = true;
    ALP_TRY(stitch_occlusion(job, seams));
    ALP_TRY(stitch_obscurance(job, seams));
    ALP_TRY(stitch_light(job, seams));
    return measure_all(job, seams, true);
}

static alp_result find_seams(alpi_bake_job *job)
{
    const alpi_watch *watch = alpi_context_watch(job->context);
    alpi_tracer *tracer, *owned;
    alpi_seams seams;
    ALP_TRY(alpi_bake_tracer(job, watch->callback, watch->user, &tracer, &owned));
    const alp_result found = alpi_seams_create(job->lightmap, tracer, &seams);
    alpi_tracer_destroy(owned);
    ALP_TRY(found);
    job->report.seams.count = seams.count;
    job->report.seams.length = seams.length;
    const alp_result result = measure_and_stitch(job, &seams);
    alpi_seams_destroy(&seams);
    return result;
}

alp_result alpi_bake_stitch(alpi_bake_job *job)
{
    const double started = alpi_seconds();
    alpi_watch own = alpi_set_watch(job->context, (alpi_watch){0});
    alpi_set_watch(job->context,
                   (alpi_watch){.callback = tell_seams, .user = &own, .last = own.last});
    job->stage = "seams";
    const alp_result result = find_seams(job);
    alpi_set_watch(job->context, own);
    job->report.seconds_seams = alpi_seconds() - started;
    return result;
}
