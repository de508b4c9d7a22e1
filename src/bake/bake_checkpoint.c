// SPDX-License-Identifier: MIT
#include "bake/bake_checkpoint.h"

#include "bake/bake_memory.h"
#include "bake/checkpoint_settings.h"
#include "bake/settings.h"
#include "base/tiles/checkpoint.h"
#include "base/tiles/rank_calls.h"

#include <alpenglow/ranks.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SHARD_LIMIT = 1 << 16 };
static const alp_result INVALID = ALP_ERROR_INVALID_ARGUMENT;

alp_checkpoint_options alp_checkpoint_options_default(void)
{
    return (alp_checkpoint_options){.struct_size = sizeof(alp_checkpoint_options), .every = 10.0};
}

// --- refusals ------------------------------------------------------------------------------------

/// A shard's tiles may not decide what others trace.
static alp_result check_shard(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    const alp_checkpoint_options *c = &o->checkpoint;
    if (c->shard > c->shards || c->shards > SHARD_LIMIT || (c->shard == 0) != c->merge) {
        return alpi_fail(job->context, INVALID,
                         "bake: shard %u of %u; shards are counted from 1, and at most %d",
                         c->shard, c->shards, SHARD_LIMIT);
    }
    if (o->sampling.error > 0.0f || (alpi_bake_wants_light(o) && o->light.error > 0.0f)) {
        return alpi_fail(job->context, INVALID,
                         "bake: shards cannot reach an error together (--error, --quality); take "
                         "fixed --ao-samples or --samples, or ranks (alpenglow-mpi)");
    }
    if (o->sampling.accuracy != ALP_ADAPTIVE_OFF) {
        return alpi_fail(job->context, INVALID,
                         "bake: shards cannot interpolate between texels of others; add "
                         "--adaptive off");
    }
    if (o->atlas.mode == ALP_ATLAS_VERTEX) {
        return alpi_fail(job->context, INVALID, "bake: maps at vertices have no shards");
    }
    return ALP_OK;
}

alp_result alpi_bake_check_checkpoint(const alpi_bake_job *job)
{
    const alp_checkpoint_options *c = &job->options.checkpoint;
    if (c->struct_size != sizeof *c) {
        return alpi_fail(job->context, INVALID,
                         "bake: the options of the checkpoint are not from "
                         "alp_checkpoint_options_default()");
    }
    if (c->folder == NULL) {
        return c->shards == 0 ? ALP_OK
                              : alpi_fail(job->context, INVALID,
                                          "bake: a shard needs a folder for its tiles "
                                          "(--checkpoint DIR)");
    }
    if (!(c->every >= 0.1 && c->every <= 86400.0)) {
        return alpi_fail(job->context, INVALID,
                         "bake: a checkpoint every %g s; need 0.1 to 86400 s", c->every);
    }
    if (job->options.sampling.time_limit > 0.0) {
        return alpi_fail(job->context, INVALID,
                         "bake: a time limit and a checkpoint exclude each other: a resumed bake "
                         "could not give the same bits");
    }
    if (c->restart != NULL && strpbrk(c->restart, "\r\n") != NULL) {
        return alpi_fail(job->context, INVALID, "bake: the restart of a checkpoint is one line");
    }
    return c->shards > 0 || c->merge ? check_shard(job) : ALP_OK;
}

// --- progress ------------------------------------------------------------------------------------

/// Notes progress in the state, and passes it on.
static bool note_progress(void *user, const alp_progress *progress)
{
    alpi_bake_job *job = user;
    const alpi_tiles *tiles = alpi_context_tiles(job->context);
    if (tiles->checkpoint != NULL) {
        alpi_checkpoint_note_progress(tiles->checkpoint, progress->stage, progress->done,
                                      progress->total, progress->seconds_left);
    }
    return job->told.callback == NULL || job->told.callback(job->told.user, progress);
}

void alpi_bake_note_error(alp_context *context, double error)
{
    const alpi_tiles *tiles = alpi_context_tiles(context);
    if (tiles->checkpoint != NULL && isfinite(error)) {
        alpi_checkpoint_note_error(tiles->checkpoint, error);
    }
}

// --- ranks ---------------------------------------------------------------------------------------

/// Refuses options by which each rank would choose for itself.
static alp_result check_ranks(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    if (o->sampling.time_limit > 0.0 || o->sampling.keep_partial) {
        return alpi_fail(job->context, INVALID,
                         "bake: ranks have no time limit and keep no partial result; leave out "
                         "time_limit and keep_partial (--time-limit, --keep-partial)");
    }
    if (o->checkpoint.shards > 0) {
        return alpi_fail(job->context, INVALID,
                         "bake: shards and ranks exclude each other; run a shard, and the merge, "
                         "by the plain command, or leave out --shard");
    }
    return ALP_OK;
}

alp_result alpi_bake_begin_ranks(alpi_bake_job *job)
{
    bool began;
    if (alpi_context_ranks(job->context) == NULL) {
        return ALP_OK;
    }
    ALP_TRY(check_ranks(job));
    alpi_bytes settings = alpi_bake_settings(job);
    const alp_result result =
        settings.failed ? ALP_ERROR_OUT_OF_MEMORY
                        : alpi_ranks_begin(job->context, (const char *)settings.bytes, &began);
    alpi_bytes_destroy(&settings);
    return result == ALP_OK ? alpi_bake_share_budget(job) : result;
}

// --- opening and closing -------------------------------------------------------------------------

static alp_result open_files(alpi_bake_job *job, const char *settings)
{
    const alp_checkpoint_options *c = &job->options.checkpoint;
    const alp_ranks *ranks = alpi_context_ranks(job->context);
    char name[32] = "bake";
    if (c->shard > 0) {
        snprintf(name, sizeof name, "shard-%u", c->shard);
    } else if (ranks != NULL) {
        snprintf(name, sizeof name, "rank-%u", ranks->rank);
    }
    const alpi_checkpoint_options options = {.folder = c->folder,
                                             .name = name,
                                             .settings = settings,
                                             .restart = c->restart,
                                             .every = c->every,
                                             .shard = c->shard > 0 ? c->shard - 1 : 0,
                                             .shards = c->shards,
                                             .merging = c->merge,
                                             .rank = ranks != NULL ? ranks->rank : 0,
                                             .ranks = ranks != NULL ? ranks->count : 0};
    return alpi_checkpoint_open(job->context, &options,
                                &alpi_context_tiles(job->context)->checkpoint);
}

alp_result alpi_bake_open_checkpoint(alpi_bake_job *job)
{
    alpi_tiles *tiles = alpi_context_tiles(job->context);
    const alp_checkpoint_options *c = &job->options.checkpoint;
    *tiles = (alpi_tiles){.claims = tiles->claims, .together = tiles->together};
    if (c->folder == NULL) {
        return ALP_OK;
    }
    tiles->shards = c->shards;
    tiles->shard = c->shard > 0 ? c->shard - 1 : 0;
    tiles->merging = c->merge;
    ALPI_TRY_NEW(job->context, tiles->missing, c->shards);
    alpi_bytes settings = alpi_bake_settings(job);
    const alp_result result =
        settings.failed ? ALP_ERROR_OUT_OF_MEMORY : open_files(job, (const char *)settings.bytes);
    alpi_bytes_destroy(&settings);
    job->told = (alpi_watch){.callback = job->options.progress, .user = job->options.progress_user};
    job->options.progress = note_progress;
    job->options.progress_user = job;
    (void)alpi_set_watch(job->context, (alpi_watch){.callback = note_progress, .user = job});
    return result;
}

void alpi_bake_close_checkpoint(alpi_bake_job *job, bool complete)
{
    alpi_tiles *tiles = alpi_context_tiles(job->context);
    alpi_checkpoint_close(tiles->checkpoint, complete);
    alpi_release(job->context, tiles->missing);
    *tiles = (alpi_tiles){.claims = tiles->claims, .together = tiles->together};
}

// --- shards --------------------------------------------------------------------------------------

/// The last of the missing shards that follow each other from `first` on.
static uint32_t end_of_range(const bool *missing, uint32_t count, uint32_t first)
{
    uint32_t last = first;
    while (last + 1 < count && missing[last + 1]) {
        last++;
    }
    return last;
}

/// Lists shards as ranges, for the --array of a scheduler. A list that is too long ends in ", ..."
/// after a whole entry.
static void list_ranges(const bool *missing, uint32_t count, char *text, size_t room)
{
    static const char more[] = ", ...";
    size_t used = 0;
    if (room > 0) {
        text[0] = '\0';
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!missing[i]) {
            continue;
        }
        char entry[32];
        const uint32_t last = end_of_range(missing, count, i);
        const int length = snprintf(entry, sizeof entry, last > i ? "%s%u-%u" : "%s%u",
                                    used > 0 ? "," : "", i + 1, last + 1);
        if (used + (size_t)length + sizeof more > room) {
            snprintf(text + used, room - used, "%s", more);
            return;
        }
        memcpy(text + used, entry, (size_t)length + 1);
        used += (size_t)length;
        i = last;
    }
}

static bool any_missing(const alpi_tiles *tiles)
{
    bool any = false;
    for (uint32_t i = 0; i < tiles->shards; i++) {
        any = any || tiles->missing[i];
    }
    return any;
}

alp_result alpi_bake_end_shard(alpi_bake_job *job, bool *ends)
{
    char missing[600];
    const alpi_tiles *tiles = alpi_context_tiles(job->context);
    *ends = tiles->shards > 0 && !tiles->merging;
    job->report.shard_done = *ends;
    if (!tiles->merging || !any_missing(tiles)) {
        return ALP_OK;
    }
    list_ranges(tiles->missing, tiles->shards, missing, sizeof missing);
    return alpi_fail(job->context, ALP_ERROR_INVALID_DATA,
                     "%s: shards are missing or not complete; run them, then merge again: "
                     "--array=%s",
                     job->options.checkpoint.folder, missing);
}

// --- states --------------------------------------------------------------------------------------

struct alp_checkpoint_info {
    alp_context *context;
    alpi_checkpoint_list list;
    alp_checkpoint_process *processes; // [list.count]
};

static void fill_processes(alp_checkpoint_info *info, const char *folder)
{
    for (size_t i = 0; i < info->list.count; i++) {
        const alpi_checkpoint_state *s = &info->list.states[i];
        const bool is_killed = strcmp(s->phase, "running") == 0 &&
                               alpi_checkpoint_is_free(info->context, folder, info->list.names[i]);
        info->processes[i] = (alp_checkpoint_process){.name = info->list.names[i],
                                                      .phase = is_killed ? "killed" : s->phase,
                                                      .stage = s->stage,
                                                      .done = s->done,
                                                      .total = s->total,
                                                      .seconds = s->seconds,
                                                      .seconds_left = s->seconds_left,
                                                      .error = s->error,
                                                      .written = s->written,
                                                      .shard = s->count > 0 ? s->shard + 1 : 0,
                                                      .shards = s->count,
                                                      .restart = s->restart};
    }
}

alp_result alp_checkpoint_read(alp_context *context, const char *folder, alp_checkpoint_info **info)
{
    if (context == NULL || folder == NULL || info == NULL) {
        return INVALID;
    }
    *info = NULL;
    alp_checkpoint_info *made = ALPI_NEW(context, alp_checkpoint_info, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    made->context = context;
    alp_result result = alpi_checkpoint_list_states(context, folder, &made->list);
    if (result == ALP_OK && made->list.count == 0) {
        result = alpi_fail(context, ALP_ERROR_INVALID_DATA,
                           made->list.damaged > 0
                               ? "%s: the state of the checkpoint is damaged; run the bake again, "
                                 "which goes on from the tiles that can be read"
                               : "%s: there is no checkpoint; name the folder of a bake's "
                                 "--checkpoint",
                           folder);
    }
    if (result == ALP_OK) {
        made->processes = ALPI_NEW(context, alp_checkpoint_process, made->list.count);
        result = made->processes != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    }
    if (result != ALP_OK) {
        alp_checkpoint_info_destroy(made);
        return result;
    }
    fill_processes(made, folder);
    *info = made;
    return ALP_OK;
}

const alp_checkpoint_process *alp_checkpoint_processes(const alp_checkpoint_info *info,
                                                       uint32_t *count)
{
    *count = (uint32_t)info->list.count;
    return info->processes;
}

/// Marks the shards that have no complete state.
static void mark_missing(const alp_checkpoint_info *info, bool *missing, uint32_t shards)
{
    for (uint32_t i = 0; i < shards; i++) {
        missing[i] = true;
    }
    for (size_t i = 0; i < info->list.count; i++) {
        const alp_checkpoint_process *p = &info->processes[i];
        if (p->shard > 0 && p->shard <= shards && strcmp(p->phase, "complete") == 0) {
            missing[p->shard - 1] = false;
        }
    }
}

void alp_checkpoint_missing(const alp_checkpoint_info *info, char *text, size_t room)
{
    bool missing[SHARD_LIMIT];
    uint32_t shards = info->processes[0].shards;
    shards = shards <= SHARD_LIMIT ? shards : SHARD_LIMIT;
    mark_missing(info, missing, shards);
    list_ranges(missing, shards, text, room);
}

uint32_t alp_checkpoint_damaged(const alp_checkpoint_info *info)
{
    return (uint32_t)info->list.damaged;
}

void alp_checkpoint_info_destroy(alp_checkpoint_info *info)
{
    if (info == NULL) {
        return;
    }
    alp_context *context = info->context;
    alpi_checkpoint_list_clear(&info->list);
    alpi_release(context, info->processes);
    alpi_release(context, info);
}
