// SPDX-License-Identifier: MIT
#include "base/tiles/checkpoint.h"

#include "base/bytes.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/tiles/checkpoint_compare.h"
#include "base/tiles/tile_log.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/// Seconds from the first loop to the first write, if the interval is longer.
static const double FIRST_WRITE = 4.0;
enum {
    RECORD_BYTES = 4 << 20,   // of outputs in a record
    PENDING_BYTES = 64 << 20, // copied tiles are written before the interval ends
    PENDING_LIMIT = 1 << 28,  // a disk that takes nothing loses the copies
    STAGE_SIZE = 64,
    TEXTS = 4
};

struct alpi_checkpoint {
    alp_context *context;
    alpi_checkpoint_options options; // its texts lie in `texts`
    char *texts[TEXTS];              // owned
    char *state_path;
    int folder; // locked; −1: not
    uint64_t key;
    alpi_tile_log own;     // closed for a merge
    alpi_tile_log *others; // [other_count] logs of other processes
    size_t other_count;
    bool resumes;
    double opened, started; // alpi_seconds(); started: the first loop, 0 before
    pthread_t thread;
    bool has_thread;
    pthread_mutex_t lock; // guards all below
    pthread_cond_t wake;
    bool quit, hurry;
    const alpi_tile_loop *loop; // that runs; NULL between loops
    _Atomic uint8_t *states;    // of its tiles
    uint32_t number;
    uint64_t shape;
    alpi_bytes pending; // records that are not written
    char stage[STAGE_SIZE];
    uint64_t done, total, tiles;
    double left, error;
    int trouble; // errno of the last write, or 0
    bool warned;
};

// --- writing -------------------------------------------------------------------------------------

/// Copies finished tiles of the loop to records. Under the lock.
static void collect(alpi_checkpoint *c)
{
    const bool kept = c->loop != NULL && c->loop->marks == NULL && !c->loop->fills_cache;
    for (uint32_t from = 0; kept && from < alpi_tile_count(c->loop);) {
        static const alpi_tile_head room = {0};
        const size_t start = c->pending.size;
        alpi_bytes_add(&c->pending, &room, sizeof room);
        const uint32_t tiles = alpi_tile_pack(c->loop, c->states, 1u << ALPI_TILE_RAN, true, &from,
                                              RECORD_BYTES, &c->pending);
        if (tiles == 0) {
            c->pending.size = c->pending.failed ? 0 : start;
            break;
        }
        alpi_tile_log_seal(c->number, c->shape, start, &c->pending);
        c->tiles += tiles;
    }
    if (c->pending.failed) { // without memory, tiles are run again by a resumed process
        alpi_bytes_destroy(&c->pending);
        c->pending = alpi_bytes_create(c->context);
        c->trouble = ENOMEM;
    }
}

/// Puts bytes that could not be written before those that came since.
static void put_back(alpi_checkpoint *c, alpi_bytes *bytes)
{
    alpi_bytes_add(bytes, c->pending.bytes, c->pending.size);
    alpi_bytes_destroy(&c->pending);
    c->pending = *bytes;
    if (c->pending.failed || c->pending.size > PENDING_LIMIT) {
        alpi_bytes_destroy(&c->pending);
        c->pending = alpi_bytes_create(c->context);
    }
}

static alpi_checkpoint_state state_of(const alpi_checkpoint *c, const char *phase,
                                      char stage[STAGE_SIZE])
{
    memcpy(stage, c->stage, STAGE_SIZE);
    return (alpi_checkpoint_state){.phase = phase,
                                   .stage = stage,
                                   .done = c->done,
                                   .total = c->total,
                                   .seconds = alpi_seconds() - c->opened,
                                   .seconds_left = c->left,
                                   .error = c->error,
                                   .tiles = c->tiles,
                                   .written = (uint64_t)time(NULL),
                                   .shard = c->options.shard,
                                   .count = c->options.shards,
                                   .restart = c->options.restart,
                                   .settings = c->options.settings};
}

/// Appends finished tiles, then replaces the state. Takes the lock, but not while it writes.
static void write_out(alpi_checkpoint *c, const char *phase)
{
    char stage[STAGE_SIZE];
    pthread_mutex_lock(&c->lock);
    collect(c);
    alpi_bytes bytes = c->pending;
    c->pending = alpi_bytes_create(c->context);
    const alpi_checkpoint_state state = state_of(c, phase, stage);
    pthread_mutex_unlock(&c->lock);
    const bool logged = bytes.size == 0 || alpi_tile_log_append(&c->own, bytes.bytes, bytes.size);
    int why = logged ? 0 : errno;
    if (logged && !alpi_checkpoint_state_write(c->context, c->state_path, &state)) {
        why = errno;
    }
    pthread_mutex_lock(&c->lock);
    c->trouble = why;
    c->warned = c->warned && why != 0;
    if (logged) {
        alpi_bytes_destroy(&bytes);
    } else {
        put_back(c, &bytes);
    }
    pthread_mutex_unlock(&c->lock);
}

static struct timespec time_of(double seconds)
{
    struct timespec t = {.tv_sec = (time_t)seconds};
    t.tv_nsec = (long)(1e9 * (seconds - (double)t.tv_sec));
    return t;
}

static void *write_at_intervals(void *user)
{
    alpi_checkpoint *c = user;
    double next = c->started + fmin(FIRST_WRITE, c->options.every);
    pthread_mutex_lock(&c->lock);
    while (!c->quit) {
        const struct timespec until = time_of(next);
        const bool late = pthread_cond_timedwait(&c->wake, &c->lock, &until) == ETIMEDOUT;
        if ((late || c->hurry) && !c->quit) {
            c->hurry = false;
            pthread_mutex_unlock(&c->lock);
            write_out(c, "running");
            next = alpi_seconds() + c->options.every;
            pthread_mutex_lock(&c->lock);
        }
    }
    pthread_mutex_unlock(&c->lock);
    return NULL;
}

/// Warns of a disk that takes no tiles; once, until one is taken again. On the caller's thread.
static void warn_of_trouble(alpi_checkpoint *c)
{
    pthread_mutex_lock(&c->lock);
    const int why = c->warned ? 0 : c->trouble;
    c->warned = c->warned || why != 0;
    pthread_mutex_unlock(&c->lock);
    if (why != 0) {
        alpi_warn(c->context, "checkpoint-not-written", c->options.folder,
                  "the checkpoint could not be written (%s); the bake goes on and tries again "
                  "every %g s",
                  strerror(why), c->options.every);
    }
}

// --- loops ---------------------------------------------------------------------------------------

/// Copies the stored tiles of one record. @return tiles
static uint32_t read_record(alpi_checkpoint *c, const alpi_tile_log *log,
                            const alpi_tile_record *record, const alpi_tile_loop *loop,
                            _Atomic uint8_t *states)
{
    const size_t size = (size_t)record->head.size;
    uint8_t *bytes = ALPI_NEW(c->context, uint8_t, size);
    uint32_t tiles = 0;
    if (bytes != NULL && alpi_tile_log_read(log, record, bytes) &&
        alpi_tile_unpack(loop, bytes, size, states)) {
        tiles = 1;
    } else {
        alpi_warn(c->context, "checkpoint-damaged", log->path,
                  c->options.merging
                      ? "a record at byte %llu cannot be read; its shard may have to "
                        "run again"
                      : "a record at byte %llu cannot be read; its tiles are traced "
                        "again",
                  (unsigned long long)record->offset);
    }
    alpi_release(c->context, bytes);
    return tiles;
}

static uint32_t read_log(alpi_checkpoint *c, const alpi_tile_log *log, const alpi_tile_loop *loop,
                         uint32_t number, _Atomic uint8_t *states)
{
    uint32_t read = 0;
    const uint64_t shape = c->shape;
    for (size_t i = 0; i < log->count; i++) {
        const alpi_tile_head *head = &log->records[i].head;
        if (head->loop == number && head->shape == shape) {
            read += read_record(c, log, &log->records[i], loop, states);
        }
    }
    return read;
}

static void start_thread(alpi_checkpoint *c)
{
    c->started = alpi_seconds();
    if (!c->options.merging) {
        c->has_thread = pthread_create(&c->thread, NULL, write_at_intervals, c) == 0;
    }
}

uint32_t alpi_checkpoint_begin_loop(alpi_checkpoint *checkpoint, const alpi_tile_loop *loop,
                                    uint32_t number, _Atomic uint8_t *states)
{
    alpi_checkpoint *c = checkpoint;
    uint32_t read = 0;
    c->shape = alpi_tiles_shape(c->context, loop);
    if (loop->marks == NULL && !loop->fills_cache) {
        read += read_log(c, &c->own, loop, number, states);
        for (size_t i = 0; i < c->other_count; i++) {
            read += read_log(c, &c->others[i], loop, number, states);
        }
    }
    if (!(c->started > 0.0)) {
        start_thread(c);
    }
    warn_of_trouble(c);
    pthread_mutex_lock(&c->lock);
    c->loop = loop;
    c->states = states;
    c->number = number;
    pthread_mutex_unlock(&c->lock);
    return read;
}

void alpi_checkpoint_end_loop(alpi_checkpoint *checkpoint)
{
    alpi_checkpoint *c = checkpoint;
    pthread_mutex_lock(&c->lock);
    if (!c->options.merging) {
        collect(c);
    }
    c->loop = NULL;
    c->states = NULL;
    if (c->pending.size > PENDING_BYTES) {
        c->hurry = true;
        pthread_cond_signal(&c->wake);
    }
    pthread_mutex_unlock(&c->lock);
    warn_of_trouble(c);
}

void alpi_checkpoint_note_progress(alpi_checkpoint *checkpoint, const char *stage, uint64_t done,
                                   uint64_t total, double seconds_left)
{
    alpi_checkpoint *c = checkpoint;
    pthread_mutex_lock(&c->lock);
    snprintf(c->stage, sizeof c->stage, "%s", stage != NULL ? stage : "");
    c->done = done;
    c->total = total;
    c->left = seconds_left;
    pthread_mutex_unlock(&c->lock);
    warn_of_trouble(c);
}

void alpi_checkpoint_note_error(alpi_checkpoint *checkpoint, double error)
{
    pthread_mutex_lock(&checkpoint->lock);
    checkpoint->error = error;
    pthread_mutex_unlock(&checkpoint->lock);
}

bool alpi_checkpoint_resumes(const alpi_checkpoint *checkpoint)
{
    return checkpoint->resumes;
}

// --- opening -------------------------------------------------------------------------------------

static bool is_of_this_run(const alpi_checkpoint *c, const char *name)
{
    static const char rank[] = "rank-";
    const size_t length = sizeof rank - 1;
    return strcmp(name, c->options.name) == 0 ||
           (strncmp(name, rank, length) == 0 &&
            strtoul(name + length, NULL, 10) < c->options.ranks);
}

/// Opens the log of another process for reading. One that cannot be read costs its tiles.
static alp_result open_other(alpi_checkpoint *c, const char *name)
{
    char *path = alpi_format(c->context, "%s/%s.tiles", c->options.folder, name);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alpi_tile_log log = {.file = -1};
    alp_result result = ALP_OK;
    if (access(path, F_OK) == 0) {
        result = alpi_tile_log_open(c->context, path, c->key, false, &log);
    }
    alpi_release(c->context, path);
    if (result == ALP_ERROR_OUT_OF_MEMORY) {
        return result;
    }
    if (log.context != NULL) {
        c->others[c->other_count++] = log;
    }
    return ALP_OK;
}

/// Removes files of a process from the folder.
static void remove_files(const alpi_checkpoint *c, const char *name, bool state)
{
    static const char *const endings[] = {"tiles", "state.old", "state.new", "state"};
    for (size_t i = 0; i < (state ? 4 : 3); i++) {
        char *path = alpi_format(c->context, "%s/%s.%s", c->options.folder, name, endings[i]);
        if (path != NULL) {
            (void)unlink(path);
        }
        alpi_release(c->context, path);
    }
}

/// Whether the work of a process is done, and nothing reads it again. Shards wait for a merge.
static bool is_over(const alpi_checkpoint_state *state)
{
    return strcmp(state->phase, "complete") == 0 && state->count == 0;
}

/// Compares all states with this bake, and opens the logs that it reads. A folder of bakes that are
/// over is free.
static alp_result open_others(alpi_checkpoint *c, const alpi_checkpoint_list *list)
{
    ALPI_TRY_NEW(c->context, c->others, list->count);
    for (size_t i = 0; i < list->count; i++) {
        const alpi_checkpoint_state *s = &list->states[i];
        if (is_over(s) && c->options.shards == 0) {
            continue;
        }
        ALP_TRY(alpi_checkpoint_compare(c->context, c->options.folder, c->options.settings,
                                        s->settings));
        const bool wanted = c->options.shards == 0 || c->options.merging;
        if (wanted && strcmp(list->names[i], c->options.name) != 0) {
            ALP_TRY(open_other(c, list->names[i]));
        }
    }
    return ALP_OK;
}

/// Opens the log of this process.
static alp_result open_own(alpi_checkpoint *c)
{
    char *path = alpi_format(c->context, "%s/%s.tiles", c->options.folder, c->options.name);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result = alpi_tile_log_open(c->context, path, c->key, true, &c->own);
    alpi_release(c->context, path);
    return result;
}

/// Locks the folder until the process ends: a bake alone, shards and ranks together with their
/// like.
static alp_result lock_folder(alpi_checkpoint *c)
{
    const bool shared = c->options.shards > 0 || c->options.ranks > 0;
    c->folder = open(c->options.folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    return alpi_tile_log_lock(c->context, c->options.folder, c->folder, shared);
}

static void note_resumed(alpi_checkpoint *c, const alpi_checkpoint_list *list)
{
    size_t records = c->own.count, damaged = list->damaged + (c->own.damaged ? 1 : 0);
    for (size_t i = 0; i < c->other_count; i++) {
        records += c->others[i].count;
        damaged += c->others[i].damaged ? 1 : 0;
    }
    c->resumes = records > 0;
    if (damaged > 0) {
        alpi_warn(c->context, "checkpoint-damaged", c->options.folder,
                  "part of the checkpoint is damaged; the bake goes on from what was written "
                  "before it");
    }
    if (c->resumes && !c->options.merging) {
        alpi_note(c->context, "resumed", c->options.folder, "the bake goes on from its checkpoint");
    }
}

static alp_result open_files(alpi_checkpoint *c)
{
    alpi_checkpoint_list list;
    if (!c->options.merging) {
        ALP_TRY(alpi_folder_create(c->context, c->options.folder));
    }
    ALP_TRY(alpi_checkpoint_list_states(c->context, c->options.folder, &list));
    alp_result result = lock_folder(c);
    result = result == ALP_OK ? open_others(c, &list) : result;
    if (result == ALP_OK && !c->options.merging) {
        result = open_own(c);
    }
    if (result == ALP_OK) {
        note_resumed(c, &list);
    }
    alpi_checkpoint_list_clear(&list);
    return result;
}

static alp_result copy_options(alpi_checkpoint *c, const alpi_checkpoint_options *o)
{
    c->options = *o;
    const char **const copies[TEXTS] = {&c->options.folder, &c->options.name, &c->options.settings,
                                        &c->options.restart};
    c->options.restart = o->restart != NULL ? o->restart : "";
    for (int i = 0; i < TEXTS; i++) {
        c->texts[i] = alpi_copy_string(c->context, *copies[i]);
        *copies[i] = c->texts[i];
    }
    c->state_path = alpi_format(c->context, "%s/%s.state", o->folder, o->name);
    c->key = alpi_hash_bytes(ALPI_HASH_START, o->settings, strlen(o->settings));
    return c->options.folder != NULL && c->options.name != NULL && c->options.settings != NULL &&
                   c->options.restart != NULL && c->state_path != NULL
               ? ALP_OK
               : ALP_ERROR_OUT_OF_MEMORY;
}

static void release(alpi_checkpoint *c)
{
    alp_context *context = c->context;
    alpi_tile_log_close(&c->own);
    if (c->folder >= 0) {
        close(c->folder);
    }
    for (size_t i = 0; i < c->other_count; i++) {
        alpi_tile_log_close(&c->others[i]);
    }
    alpi_release(context, c->others);
    alpi_bytes_destroy(&c->pending);
    for (int i = 0; i < TEXTS; i++) {
        alpi_release(context, c->texts[i]);
    }
    alpi_release(context, c->state_path);
    pthread_mutex_destroy(&c->lock);
    pthread_cond_destroy(&c->wake);
    alpi_release(context, c);
}

alp_result alpi_checkpoint_open(alp_context *context, const alpi_checkpoint_options *options,
                                alpi_checkpoint **checkpoint)
{
    alpi_checkpoint *c = ALPI_NEW(context, alpi_checkpoint, 1);
    pthread_condattr_t steady;
    *checkpoint = NULL;
    if (c == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *c = (alpi_checkpoint){.context = context,
                           .own = {.file = -1},
                           .folder = -1,
                           .pending = alpi_bytes_create(context),
                           .opened = alpi_seconds(),
                           .left = -1.0,
                           .error = (double)NAN};
    pthread_mutex_init(&c->lock, NULL);
    pthread_condattr_init(&steady);
    pthread_condattr_setclock(&steady, CLOCK_MONOTONIC);
    pthread_cond_init(&c->wake, &steady);
    pthread_condattr_destroy(&steady);
    alp_result result = copy_options(c, options);
    result = result == ALP_OK ? open_files(c) : result;
    if (result != ALP_OK) {
        release(c);
        return result;
    }
    if (!options->merging) {
        write_out(c, "running"); // for status, and a kill before the first tiles
        warn_of_trouble(c);
    }
    *checkpoint = c;
    return ALP_OK;
}

// --- closing -------------------------------------------------------------------------------------

static void stop_thread(alpi_checkpoint *c)
{
    if (c->has_thread) {
        pthread_mutex_lock(&c->lock);
        c->quit = true;
        pthread_cond_signal(&c->wake);
        pthread_mutex_unlock(&c->lock);
        pthread_join(c->thread, NULL);
    }
}

/// Removes the tiles of a bake whose result is written, and files of processes that are gone.
static void remove_tiles(alpi_checkpoint *c)
{
    alpi_checkpoint_list list;
    remove_files(c, c->options.name, c->options.rank > 0);
    if (c->options.rank > 0 ||
        alpi_checkpoint_list_states(c->context, c->options.folder, &list) != ALP_OK) {
        return;
    }
    for (size_t i = 0; i < list.count; i++) {
        if (!is_of_this_run(c, list.names[i]) && list.states[i].count == 0) {
            remove_files(c, list.names[i], true);
        }
    }
    alpi_checkpoint_list_clear(&list);
}

void alpi_checkpoint_close(alpi_checkpoint *checkpoint, bool complete)
{
    alpi_checkpoint *c = checkpoint;
    if (c == NULL) {
        return;
    }
    stop_thread(c);
    const bool is_done = complete && c->options.shards == 0;
    if (is_done) { // nobody reads what was not written
        alpi_bytes_destroy(&c->pending);
        c->pending = alpi_bytes_create(c->context);
    }
    if (!c->options.merging) {
        write_out(c, complete ? "complete" : "stopped");
        warn_of_trouble(c);
    }
    if (is_done && !c->options.merging) {
        remove_tiles(c);
    }
    release(c);
}
