// SPDX-License-Identifier: MIT
// alpenglow merge: writes the result of a bake whose shards are complete. It runs the command of
// the shards again, which reads their tiles instead of tracing rays.
#include "commands/commands.h"
#include "printing/messages.h"
#include "scale/checkpoints.h"

#include <alpenglow/alpenglow.h>

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// The absolute form of a path that may not exist yet. The caller frees it.
static char *make_absolute(const char *path)
{
    char folder[PATH_MAX] = "";
    const bool is_absolute = path[0] == '/' || getcwd(folder, sizeof folder) == NULL;
    const size_t size = strlen(folder) + strlen(path) + 2;
    char *text = allocate_or_exit(NULL, size);
    snprintf(text, size, is_absolute ? "%s%s" : "%s/%s", is_absolute ? "" : folder, path);
    return text;
}

static bool is_asset(const char *path)
{
    static const char *const endings[] = {".glb", ".gltf", ".dae", ".obj", ".json", ".babylon"};
    const size_t length = strlen(path);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        const size_t end = strlen(endings[i]);
        if (length > end && strcmp(path + length - end, endings[i]) == 0) {
            return true;
        }
    }
    return false;
}

/// Adds what the merge itself was given: the output, -f, and how it reports.
static void add_own_words(const command_line *a, const char *output, restart_words *words)
{
    const option_value *values = a->values;
    if (output != NULL) {
        restart_add(words, is_asset(output) ? "-o" : "--maps-dir");
        restart_add(words, output);
    }
    if (values[OPTION_FORCE].given) {
        restart_add(words, "-f");
    }
    if (values[OPTION_QUIET].given) {
        restart_add(words, "-q");
    }
    if (values[OPTION_THREADS].given) {
        restart_add(words, "--threads");
        restart_add(words, values[OPTION_THREADS].text);
    }
}

static int run(const command_line *a, const alp_checkpoint_process *process)
{
    const char *out = a->values[OPTION_OUTPUT].text;
    restart_words words;
    command_line bake;
    if (!restart_parse(process->restart, &words)) {
        restart_release(&words);
        return failure("merge: the checkpoint does not keep its command; run the bake again with "
                       "names in UTF-8");
    }
    char *folder = make_absolute(a->operands[0]);
    char *output = out != NULL ? make_absolute(out) : NULL;
    add_own_words(a, output, &words);
    int code = EXIT_FAILED;
    if (chdir(words.folder) != 0) {
        fprintf(stderr, "alpenglow: merge: %s: the folder of the bake cannot be entered: %s\n",
                words.folder, strerror(errno));
    } else {
        code = arguments_parse(COMMAND_BAKE, words.count, words.words, &bake);
    }
    if (code == EXIT_DONE) {
        bake.merging = true;
        bake.merged_shards = process->shards;
        bake.merged_folder = folder;
        code = command_bake(&bake);
    }
    restart_release(&words);
    free(folder);
    free(output);
    return code;
}

/// Any shard tells the command: all of them have the same settings.
static int merge(const command_line *a, const alp_checkpoint_info *info)
{
    uint32_t count = 0;
    const alp_checkpoint_process *p = alp_checkpoint_processes(info, &count);
    for (uint32_t i = 0; i < count; i++) {
        if (p[i].shards > 0) {
            return run(a, &p[i]);
        }
    }
    return failure("merge: the folder keeps no shards; run the bake itself again, it goes on from "
                   "its checkpoint");
}

int command_merge(const command_line *a)
{
    alp_context *context = NULL;
    alp_checkpoint_info *info = NULL;
    alp_result result = alp_context_create(NULL, &context);
    if (result != ALP_OK) {
        return failure(alp_result_name(result));
    }
    result = alp_checkpoint_read(context, a->operands[0], &info);
    const int code = result == ALP_OK ? merge(a, info) : failure(alp_context_message(context));
    alp_checkpoint_info_destroy(info);
    alp_context_destroy(context);
    return code;
}
