// SPDX-License-Identifier: MIT
#include "bake/job.h"

#include <math.h>

alp_result alpi_bake_begin_stage(alpi_bake_job *job, const char *stage)
{
    job->stage = stage;
    alp_progress progress = {stage, 0, 1, 0.0, -1.0};
    if (job->options.progress != NULL &&
        !job->options.progress(job->options.progress_user, &progress)) {
        return alpi_fail(job->context, ALP_ERROR_CANCELLED, "cancelled");
    }
    return ALP_OK;
}

void alpi_bake_warn_of_darkness(const alpi_bake_job *job)
{
    if (job->report.ao_mean < 0.05 && !job->report.cut_off) {
        bool limited = isfinite(job->report.ao_distance);
        alpi_warn(job->context, "dark", job->scene->name, "the mean accessibility is %.1f %%: %s",
                  100.0 * job->report.ao_mean,
                  limited ? "nearly everything is closed within the distance limit; use a shorter "
                            "one (--ao-distance)"
                          : "a closed room is dark without a distance limit; give one "
                            "(--ao-distance auto, or metres)");
    }
}
