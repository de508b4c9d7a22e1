// SPDX-License-Identifier: MIT
// The stage of receivers: which texels lie inside other geometry, and which are gathered at.
#include "bake/bake_stages.h"

#include "bake/gathering.h"
#include "base/tasks.h"

/// A user who is asked until a time.
typedef struct time_limit {
    const alpi_task_progress *progress;
    double deadline;
} time_limit;

static bool is_in_time(void *user, const alp_progress *progress)
{
    const time_limit *limit = user;
    const alpi_task_progress *told = limit->progress;
    if (told->callback != NULL && !told->callback(told->user, progress)) {
        return false;
    }
    return alpi_seconds() < limit->deadline;
}

/// Lists the texels of an object but for those that take their value from elsewhere.
static alp_result list_valid(alpi_bake_job *job, alpi_object *object)
{
    enum { TEXELS_PER_TICK = 1 << 16 };
    alpi_gathering *g = &job->gathering;
    uint32_t *valid = g->valid + g->valid_count, count = 0;
    for (uint32_t i = 0; i < object->texel_count; i++) {
        const uint32_t t = object->texels[i];
        if (!g->validity.dropped[t]) {
            valid[count++] = t;
        }
        if (i % TEXELS_PER_TICK == TEXELS_PER_TICK - 1) {
            ALP_TRY(alpi_tick(job->context, "validity", i, object->texel_count));
        }
    }
    object->valid = valid;
    object->valid_count = count;
    g->valid_count += count;
    return ALP_OK;
}

static alp_result find_valid(alpi_bake_job *job, alpi_object *object,
                             const alpi_task_progress *progress)
{
    alpi_gathering *g = &job->gathering;
    alpi_texels *texels = &job->lightmap->texels;
    ALP_TRY(alpi_gathering_open_object(job, object, progress));
    const alpi_receivers receivers = alpi_texels_receivers(texels);
    time_limit limit = {progress, alpi_gathering_deadline(job)};
    const alpi_task_progress until = {
        .callback = is_in_time, .user = &limit, .stage = progress->stage};
    const alp_result result =
        alpi_validity_find(&g->setup, &receivers, texels, &g->lattice, object->texels,
                           object->texel_count, &until, &g->validity);
    if (result == ALP_ERROR_CANCELLED && alpi_seconds() >= limit.deadline) {
        return alpi_fail(job->context, ALP_ERROR_LIMIT,
                         "the time limit ended before any texel had a value; allow more time");
    }
    ALP_TRY(result);
    job->report.rays += g->validity.rays;
    job->report.moved += g->validity.moved_count;
    job->report.dropped += g->validity.dropped_count;
    return list_valid(job, object);
}

alp_result alpi_bake_receivers(alpi_bake_job *job)
{
    ALP_TRY(alpi_bake_begin_stage(job, "build"));
    ALP_TRY(alpi_gathering_open(job));
    const alpi_object_stage stage = {
        .name = "validity", .rays = job->lightmap->texels.count, .each = find_valid};
    return alpi_gathering_run(job, &stage);
}
