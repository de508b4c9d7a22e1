// SPDX-License-Identifier: MIT
// Seams of the finished maps: how much look-ups differ across them, for the report.
#include "bake/job.h"

#include "base/tasks.h"
#include "maps/seams.h"

#include <math.h>

/// Tells the stages of what is used here as one.
static bool tell_seams(void *user, const alp_progress *progress)
{
    const alpi_watch *watch = user;
    alp_progress told = *progress;
    told.stage = "seams";
    return watch->callback == NULL || watch->callback(watch->user, &told);
}

static alp_result measure(const alpi_bake_job *job, const alpi_seams *seams, float *const *pages,
                          alp_seam_error *error)
{
    if (pages == NULL) {
        return ALP_OK;
    }
    alpi_seam_step step;
    ALP_TRY(alpi_seams_measure(job->lightmap, seams, pages, &step));
    const double mean = alpi_seams_map_mean(job->lightmap, pages);
    const double share = mean > 0.0 ? 1.0 / mean : (double)NAN;
    error->mean = step.mean * share;
    error->p99 = step.p99 * share;
    return ALP_OK;
}

static alp_result measure_all(alpi_bake_job *job)
{
    const alp_lightmap *l = job->lightmap;
    alp_seam_report *r = &job->report.seams;
    alpi_seams seams;
    ALP_TRY(alpi_seams_create(l, &seams));
    r->count = seams.count;
    r->length = seams.length;
    alp_result result = measure(job, &seams, l->pages, &r->ao);
    if (result == ALP_OK) {
        result = measure(job, &seams, l->obscurance_pages, &r->obscurance);
    }
    if (result == ALP_OK) {
        result = measure(job, &seams, l->irradiance_pages, &r->light);
    }
    alpi_seams_destroy(&seams);
    return result;
}

alp_result alpi_bake_seams(alpi_bake_job *job)
{
    alpi_watch own = alpi_set_watch(job->context, (alpi_watch){0});
    alpi_watch former = own;
    alpi_set_watch(job->context,
                   (alpi_watch){.callback = tell_seams, .user = &own, .last = own.last});
    const alp_result result = measure_all(job);
    alpi_set_watch(job->context, former);
    return result;
}
