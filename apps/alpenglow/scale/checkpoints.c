// SPDX-License-Identifier: MIT
#include "scale/checkpoints.h"

#include "printing/messages.h"

#include <errno.h>
#include <jansson.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SHARD_LIMIT = 1 << 16 };

// --- shards --------------------------------------------------------------------------------------

/// "I/N", or "slurm/N" whose I is the task of a job array.
static bool parse_shard(const char *text, uint32_t *shard, uint32_t *shards)
{
    const char *slash = strchr(text, '/'), *task = getenv("SLURM_ARRAY_TASK_ID");
    const bool slurm = strncmp(text, "slurm/", 6) == 0;
    char first[16] = "";
    uint64_t i = 0, n = 0;
    if (slash == NULL || (size_t)(slash - text) >= sizeof first) {
        return false;
    }
    memcpy(first, text, (size_t)(slash - text));
    const char *number = slurm ? task : first;
    if (number == NULL || number_parse_whole(number, &i) != NUMBER_OK ||
        number_parse_whole(slash + 1, &n) != NUMBER_OK || i < 1 || i > n || n > SHARD_LIMIT) {
        return false;
    }
    *shard = (uint32_t)i;
    *shards = (uint32_t)n;
    return true;
}

static int refuse_shard(const char *text)
{
    const char *task = getenv("SLURM_ARRAY_TASK_ID");
    uint64_t n = 0;
    if (strncmp(text, "slurm/", 6) != 0 || number_parse_whole(text + 6, &n) != NUMBER_OK || n < 1 ||
        n > SHARD_LIMIT) {
        return usage_error(COMMAND_BAKE,
                           "--shard %s: need I/N with I from 1 to N and N at most %d, or slurm/N",
                           text, SHARD_LIMIT);
    }
    if (task == NULL) {
        return usage_error(COMMAND_BAKE,
                           "--shard %s: SLURM_ARRAY_TASK_ID is not set; start it with "
                           "sbatch --array=1-%s",
                           text, text + 6);
    }
    return usage_error(COMMAND_BAKE,
                       "--shard %s: SLURM_ARRAY_TASK_ID is %s; start it with sbatch --array=1-%s",
                       text, task, text + 6);
}

static int read_shard(const command_line *a, alp_bake_options *o)
{
    const option_value *values = a->values;
    const char *text = values[OPTION_SHARD].text;
    alp_checkpoint_options *c = &o->checkpoint;
    const bool light = (o->maps & ALP_MAP_LIGHT) != 0;
    if (!a->merging && !parse_shard(text, &c->shard, &c->shards)) {
        return refuse_shard(text);
    }
    if (c->folder == NULL) {
        return usage_error(COMMAND_BAKE, "--shard: leaves its part in a folder; give "
                                         "--checkpoint DIR");
    }
    if (o->sampling.error > 0.0f || (light && o->light.error > 0.0f)) {
        return usage_error(COMMAND_BAKE, "--shard: cannot reach an error alone; give fixed "
                                         "--ao-samples N or --samples N, or use ranks: mpirun "
                                         "alpenglow-mpi bake");
    }
    if (values[OPTION_ADAPTIVE].given && o->sampling.accuracy != ALP_ADAPTIVE_OFF) {
        return usage_error(COMMAND_BAKE, "--shard: texels of a shard cannot be interpolated from "
                                         "those of others; leave out --adaptive");
    }
    o->sampling.accuracy = ALP_ADAPTIVE_OFF;
    return EXIT_DONE;
}

// --- restart -------------------------------------------------------------------------------------

/// {"folder": …, "words": […]} in one line.
static char *make_restart(const command_line *a)
{
    char folder[PATH_MAX];
    json_t *words = json_array();
    for (int i = 0; i < a->word_count; i++) {
        json_array_append_new(words, json_string(a->words[i])); // NULL, no UTF-8: left out
    }
    const bool whole =
        json_array_size(words) == (size_t)a->word_count && getcwd(folder, sizeof folder) != NULL;
    json_t *object = json_pack("{s:s, s:o}", "folder", whole ? folder : "", "words", words);
    char *text = whole && object != NULL ? json_dumps(object, JSON_COMPACT) : NULL;
    json_decref(object);
    return text;
}

void restart_add(restart_words *words, const char *word)
{
    if (words->count == words->capacity) {
        words->capacity = 2 * words->capacity + 8;
        words->words =
            allocate_or_exit(words->words, (size_t)words->capacity * sizeof *words->words);
    }
    const size_t size = strlen(word) + 1;
    words->words[words->count] = allocate_or_exit(NULL, size);
    memcpy(words->words[words->count++], word, size);
}

bool restart_parse(const char *text, restart_words *words)
{
    json_t *object = json_loads(text, 0, NULL);
    const char *folder = json_string_value(json_object_get(object, "folder"));
    const json_t *list = json_object_get(object, "words");
    *words = (restart_words){.folder = NULL};
    for (size_t i = 0; i < json_array_size(list); i++) {
        const char *word = json_string_value(json_array_get(list, i));
        restart_add(words, word != NULL ? word : "");
    }
    if (folder != NULL) {
        const size_t size = strlen(folder) + 1;
        words->folder = allocate_or_exit(NULL, size);
        memcpy(words->folder, folder, size);
    }
    json_decref(object);
    return folder != NULL && words->count > 0;
}

void restart_release(restart_words *words)
{
    for (int i = 0; i < words->count; i++) {
        free(words->words[i]);
    }
    free(words->words);
    free(words->folder);
    *words = (restart_words){.folder = NULL};
}

// --- options -------------------------------------------------------------------------------------

int checkpoint_read(const command_line *a, alp_bake_options *o, char **restart)
{
    const option_value *values = a->values;
    alp_checkpoint_options *c = &o->checkpoint;
    *restart = NULL;
    c->folder = values[OPTION_CHECKPOINT].text;
    c->every = values[OPTION_CHECKPOINT_EVERY].real;
    if (c->folder == NULL && values[OPTION_CHECKPOINT_EVERY].given) {
        return usage_error(COMMAND_BAKE, "--checkpoint-every: needs --checkpoint DIR");
    }
    if (c->folder != NULL && o->sampling.time_limit > 0.0) {
        return usage_error(COMMAND_BAKE, "--time-limit: not with --checkpoint, whose bakes have "
                                         "the same bits after a stop; stop it with SIGTERM, or "
                                         "leave one of them out");
    }
    if (c->folder != NULL && values[OPTION_KEEP_PARTIAL].given) {
        return usage_error(COMMAND_BAKE, "--keep-partial: not with --checkpoint, which keeps the "
                                         "work itself; leave one of them out");
    }
    if (values[OPTION_SHARD].given) {
        const int code = read_shard(a, o);
        if (code != EXIT_DONE) {
            return code;
        }
    }
    if (a->merging) {
        c->merge = true;
        c->shard = 0;
        c->shards = a->merged_shards;
        c->folder = a->merged_folder;
        return EXIT_DONE;
    }
    if (c->folder != NULL) {
        *restart = make_restart(a);
        c->restart = *restart;
    }
    if (values[OPTION_SHARD].given && c->restart == NULL) {
        return usage_error(COMMAND_BAKE, "--shard: the merge runs this command again from this "
                                         "folder, and keeps both as UTF-8; rename the files or "
                                         "folders that are not UTF-8");
    }
    return EXIT_DONE;
}

// --- folders -------------------------------------------------------------------------------------

int checkpoint_run(const command_line *a,
                   int (*body)(const command_line *arguments, const alp_checkpoint_info *info))
{
    alp_context *context = NULL;
    alp_checkpoint_info *info = NULL;
    alp_result result = alp_context_create(NULL, &context);
    if (result != ALP_OK) {
        return failure(alp_result_name(result));
    }
    result = alp_checkpoint_read(context, a->operands[0], &info);
    const int code = result == ALP_OK ? body(a, info) : failure(alp_context_message(context));
    alp_checkpoint_info_destroy(info);
    alp_context_destroy(context);
    return code;
}
